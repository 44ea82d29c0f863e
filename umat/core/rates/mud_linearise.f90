! SPDX-License-Identifier: MIT
!> What the derivatives of one rate share, whatever the direction in which its arguments change.
module mud_linearise
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_bonding, only: bonding_curvature, bonding_with_turn
   use mud_critical_state, only: state_parameter_slopes, bounding_slope, lode_gradient
   use mud_direction_equation, only: slopes_t, slopes_at, gradients
   use mud_elastic, only: bulk_slope, shear_slope, swelling_slope
   use mud_loading, only: loading_t
   use mud_hardening, only: kinematic_slope
   use mud_rate, only: rate_t
   use mud_rates, only: p_follows
   use mud_tensor, only: ddot, trace
   implicit none (type, external)
   private
   public :: linearised_t, linearise, inverse_of

   !> What all directions share.
   type :: linearised_t
      logical :: held_p                     !< p' is at its lower bound: it does not follow the stress.
      real(wp) :: e, d_v, d_pc
      real(wp) :: aside_v                   !< Trace of the elastic strain rate beside (elastic domain pulled along).
      real(wp) :: curvature(3)              !< of f [1/kPa2, 1/kPa, -]
      real(wp) :: with_turn(3)              !< of f, df/dp_c, df/de with ln x of the branch's turn [-, 1/kPa, -]
      real(wp) :: psi_f, psi_p, m_b_psi     !< slopes of psi by f and p', of M^b by psi [-, 1/kPa, -]
      real(wp) :: kappa
      real(wp) :: k_slope, g_slope, b_slope !< d ln K/de, d ln G/de, d ln b_0/de [-]
      real(wp) :: per_p, per_f, per_gamma, per_y   !< Reciprocals of p', f, gamma, y.
      real(wp) :: lode_r, lode_r_slope(6)   !< Lode factor in the direction of r and its gradient, a deviator
      type(slopes_t) :: slopes
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
      real(wp) :: m(3, 3), traces(2)

      lin%held_p = .not. p_follows(par, sigma)
      lin%e = e
      traces = [trace(loading%basis(:, 1)), trace(loading%basis(:, 2))]
      lin%d_v = loading%part(1)*traces(1) + loading%part(2)*traces(2)
      lin%aside_v = loading%whole(1)*traces(1) + loading%whole(2)*traces(2) - lin%d_v
      lin%d_pc = d_pc
      lin%curvature = 0.0_wp
      lin%with_turn = 0.0_wp
      if (bonded) then
         lin%curvature = bonding_curvature(par, w%bond, p_c, e)
         if (par%scanning%moves) lin%with_turn = bonding_with_turn(par, w%bond, p_c, e)
      end if
      call state_parameter_slopes(par, w%psi, w%bond%f, e, w%p, lin%psi_f, lin%psi_p)
      lin%m_b_psi = bounding_slope(par, w%psi, w%m_b)
      lin%k_slope = bulk_slope(e)
      lin%g_slope = shear_slope(e)
      lin%b_slope = kinematic_slope(par, e)
      lin%per_p = 1.0_wp/w%p
      lin%per_f = 1.0_wp/w%bond%f
      if (w%iso_active) then
         lin%kappa = swelling_slope(w%k, e, w%p)
         lin%lode_r = 1.0_wp
         lin%lode_r_slope = 0.0_wp
         if (w%r_norm > 0.0_wp) call lode_gradient(par, w%r, w%r_norm, lin%lode_r, lin%lode_r_slope)
      end if
      if (.not. w%loading) return
      call slopes_at(par, w, lin%slopes)
      call gradients(par, w, lin%slopes, lin%h_n, lin%d_n, lin%gamma_n)
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

   !> Inverse of a 3 x 3 matrix by cofactors. That m is regular is not checked.
   pure function inverse_of(m) result(inverse)
      real(wp), intent(in) :: m(3, 3)
      real(wp) :: inverse(3, 3)

      inverse(1, 1) = m(2, 2)*m(3, 3) - m(2, 3)*m(3, 2)
      inverse(1, 2) = m(1, 3)*m(3, 2) - m(1, 2)*m(3, 3)
      inverse(1, 3) = m(1, 2)*m(2, 3) - m(1, 3)*m(2, 2)
      inverse(2, 1) = m(2, 3)*m(3, 1) - m(2, 1)*m(3, 3)
      inverse(2, 2) = m(1, 1)*m(3, 3) - m(1, 3)*m(3, 1)
      inverse(2, 3) = m(1, 3)*m(2, 1) - m(1, 1)*m(2, 3)
      inverse(3, 1) = m(2, 1)*m(3, 2) - m(2, 2)*m(3, 1)
      inverse(3, 2) = m(1, 2)*m(3, 1) - m(1, 1)*m(3, 2)
      inverse(3, 3) = m(1, 1)*m(2, 2) - m(1, 2)*m(2, 1)
      inverse = inverse/(m(1, 1)*inverse(1, 1) + m(1, 2)*inverse(2, 1) + m(1, 3)*inverse(3, 1))
   end function inverse_of
end module mud_linearise
