! SPDX-License-Identifier: MIT
!> What the derivatives of one rate share, whatever the direction in which its arguments change.
module mud_linearise
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_bonding, only: bonding_t, bonding_curvature
   use mud_critical_state, only: lode_factor, lode_slope
   use mud_elastic, only: swelling_slope
   use mud_loading, only: loading_t
   use mud_hardening, only: SMALLEST_VOID_TERM
   use mud_rates, only: rate_t
   use mud_tangent, only: gradients, inverse_of
   use mud_tensor, only: ddot, trace, deviator, square
   implicit none (type, external)
   private
   public :: linearised_t, linearise

   !> What all directions share.
   type :: linearised_t
      logical :: held_p                     !< p' is at its lower bound: it does not follow the stress.
      real(wp) :: e, p_c, d_v, d_pc
      real(wp) :: aside_v                   !< Trace of the elastic strain rate beside (elastic domain pulled along).
      type(bonding_t) :: bond
      real(wp) :: curvature(3)              !< of f [1/kPa2, 1/kPa, -]
      real(wp) :: e_c, kappa, r_norm
      real(wp) :: e_c_slope                 !< -d ln e_c/dp' [1/kPa]
      real(wp) :: k_slope, g_slope, b_slope !< d ln K/de, d ln G/de, d ln b_0/de [-]
      real(wp) :: per_p, per_f, per_b_0, per_gamma, per_y   !< Reciprocals of p', f, b_0, gamma, y.
      real(wp) :: r_cube_slope(6)           !< d tr(r^3/|r|^3)/dr, a deviator
      real(wp) :: lode_r, lode_slope_r      !< Lode factor in the direction of r and its slope
      real(wp), dimension(6) :: h_n, d_n, gamma_n
      real(wp), dimension(4) :: on_t, on_r, on_e   !< n, h_n, d_n, gamma_n on t, r and the deviatoric strain rate
      real(wp) :: inverse(3, 3)
   end type linearised_t
contains
   !> Prepares the derivative of a rate w that was evaluated at (sigma, e, p_c) for the strain rate of loading and d_pc.
   !> sigma' and p_c [kPa], compression positive; e [-]; d_pc [kPa]. Of a rate that does not load the gradients and the
   !> inverse are not set. docs/theory/integration.md sections 5.2, 5.3.
   pure subroutine linearise(par, bonded, w, sigma, e, p_c, loading, d_pc, lin)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: sigma(6), e, p_c, d_pc
      type(loading_t), intent(in) :: loading
      type(linearised_t), intent(inout) :: lin
      real(wp) :: m(3, 3), r2(6), cube, traces(2)

      lin%held_p = trace(sigma) < 3.0_wp*par%p_min
      lin%e = e
      lin%p_c = p_c
      traces = [trace(loading%basis(:, 1)), trace(loading%basis(:, 2))]
      lin%d_v = loading%part(1)*traces(1) + loading%part(2)*traces(2)
      lin%aside_v = loading%whole(1)*traces(1) + loading%whole(2)*traces(2) - lin%d_v
      lin%d_pc = d_pc
      lin%bond = w%bond
      lin%curvature = 0.0_wp
      if (bonded) lin%curvature = bonding_curvature(par, w%bond, p_c, e)
      lin%e_c = e - w%psi
      lin%e_c_slope = par%lambda/(w%p + par%alpha_csl)
      lin%k_slope = 1.0_wp/(1.0_wp + e) - 1.0_wp/e
      lin%g_slope = -1.0_wp/(1.0_wp + e)
      ! At e = 2.97 the shear modulus and its slope are zero.
      if (abs(2.97_wp - e) > epsilon(e)) lin%g_slope = lin%g_slope - 2.0_wp/(2.97_wp - e)
      lin%b_slope = 0.0_wp
      if (1.0_wp - par%c_h*e > SMALLEST_VOID_TERM) lin%b_slope = -par%c_h/(1.0_wp - par%c_h*e)
      lin%per_p = 1.0_wp/w%p
      lin%per_f = 1.0_wp/lin%bond%f
      lin%per_b_0 = 1.0_wp/w%b_0
      if (w%iso_active) then
         lin%kappa = swelling_slope(w%k, e, w%p)
         lin%r_norm = w%r_norm
         lin%r_cube_slope = 0.0_wp
         lin%lode_r = 1.0_wp
         lin%lode_slope_r = 0.0_wp
         if (par%lode .and. lin%r_norm > 0.0_wp) then
            r2 = square(w%r)
            cube = ddot(r2, w%r)/lin%r_norm**3
            lin%lode_r = lode_factor(par, cube)
            lin%lode_slope_r = lode_slope(par, lin%lode_r)
            lin%r_cube_slope = 3.0_wp*(deviator(r2)/lin%r_norm**3 - (cube/lin%r_norm**2)*w%r)
         end if
      end if
      if (.not. w%loading) return
      call gradients(par, w, lin%h_n, lin%d_n, lin%gamma_n)
      lin%on_t = [ddot(w%n, w%t), ddot(lin%h_n, w%t), ddot(lin%d_n, w%t), ddot(lin%gamma_n, w%t)]
      lin%on_r = [w%r_n, ddot(lin%h_n, w%r), ddot(lin%d_n, w%r), ddot(lin%gamma_n, w%r)]
      lin%on_e = (lin%on_t + (w%k_e*(lin%d_v - w%b_rate))*lin%on_r)/(2.0_wp*w%g)   ! t = 2 G e - V r
      ! beta_n = K_e (D h_n + d_n/h)
      m(1, :) = [lin%on_t(1), -1.0_wp, w%r_n]
      m(2, :) = [lin%on_t(4), -w%gamma, lin%on_r(4)]
      m(3, :) = [w%k_e*(w%d*lin%on_t(2) + w%h_b*lin%on_t(3)), 0.0_wp, &
                 w%k_e*(w%d*lin%on_r(2) + w%h_b*lin%on_r(3)) - w%gamma]
      lin%inverse = inverse_of(m)
      lin%per_gamma = 1.0_wp/w%gamma
      lin%per_y = 1.0_wp/w%y
   end subroutine linearise
end module mud_linearise
