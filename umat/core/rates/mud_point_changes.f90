! SPDX-License-Identifier: MIT
!> Changes of what a rate takes from the point alone - moduli, state parameter, bounding ratio, isotropic mechanism -
!> along the directions of a derivative, which stand side by side; docs/theory/integration.md section 5.3.
module mud_point_changes
   use mud_elastic, only: BULK_EXPONENT, SHEAR_EXPONENT
   use mud_kinds, only: wp
   use mud_linearise, only: linearised_t
   use mud_loading, only: loading_t
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_tensor, only: LANES, contractions
   implicit none (type, external)
   private
   public :: changes_t, lanes_t, rest, change_point, along_ratio, NRATES

   integer, parameter :: NRATES = 15   !< sigma'(6), z(6), plastic shear, ln chi', contraction.

   !> How the arguments of a rate change beside stress, fabric and memory.
   type :: changes_t
      real(wp), dimension(LANES) :: e, p_c, d_pc   !< of void ratio, suction and its rate [-, kPa, kPa]
      type(loading_t) :: loading                   !< of the strain rate that loads
      logical :: scans                             !< Its branch changes with its turn; otherwise turn is not set.
      real(wp) :: turn(LANES)                      !< of ln x of that turn [-]
   end type changes_t

   !> What lies between the changes of a rate's arguments and those of its results.
   type :: lanes_t
      real(wp), dimension(LANES) :: mean, v          !< a third of the trace of stress; trace of the strain rate
      real(wp), dimension(LANES) :: p, share         !< of p', and over p'
      real(wp), dimension(LANES) :: f, f_pc, f_e     !< of f, df/dp_c, df/de
      real(wp), dimension(LANES) :: k, g, psi, m_b, k_e, b, volumetric, dd, dh, beta, gamma
      real(wp), dimension(LANES) :: n_dr, h_dr, d_dr, gamma_dr   !< n:dr, and of the gradients along n
      real(wp), dimension(LANES) :: dl, flow         !< of L and of L D
      !> The turn dn by tensors: strain rate and stress by factors; e, n, r and the unit tensor.
      real(wp) :: turn_strain, turn_stress
      real(wp), dimension(LANES) :: turn_e, turn_n, turn_r, turn_p
   end type lanes_t
contains
   !> What change_point leaves where only the strain rate and the suction rate change. Units as in change_point.
   pure subroutine rest(w, changes, x)
      type(rate_t), intent(in) :: w
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp) :: b

      b = 0.0_wp
      if (w%iso_active) b = w%iso%b
      x%mean = 0.0_wp
      x%p = 0.0_wp
      x%k = 0.0_wp
      x%g = 0.0_wp
      x%k_e = 0.0_wp
      x%beta = 0.0_wp
      x%gamma = 0.0_wp
      x%dd = 0.0_wp
      x%dh = 0.0_wp
      x%n_dr = 0.0_wp
      x%h_dr = 0.0_wp
      x%d_dr = 0.0_wp
      x%gamma_dr = 0.0_wp
      x%volumetric = w%k_e*(x%v - b*changes%d_pc)
   end subroutine rest

   !> Changes of the point's scalars and of both moduli, for changes of sigma' in y [kPa] and those in changes. w is the
   !> rate at the point, lin that of w; units of x as those of w.
   pure subroutine change_point(par, w, lin, y, changes, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES)
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp) :: follows
      integer :: j

      follows = merge(0.0_wp, 1.0_wp, lin%held_p)
      x%mean = (y(:, 1) + y(:, 2) + y(:, 3))/3.0_wp
      x%f = w%bond%df_de*changes%e + w%bond%df_dpc*changes%p_c
      x%f_e = lin%curvature(3)*changes%e + lin%curvature(2)*changes%p_c
      x%f_pc = lin%curvature(2)*changes%e + lin%curvature(1)*changes%p_c
      if (changes%scans) then   ! a branch that moves changes S_w, and f with it
         x%f = x%f + lin%with_turn(1)*changes%turn
         x%f_pc = x%f_pc + lin%with_turn(2)*changes%turn
         x%f_e = x%f_e + lin%with_turn(3)*changes%turn
      end if
      do j = 1, LANES
         x%p(j) = follows*x%mean(j)
         x%share(j) = x%p(j)*lin%per_p
         x%k(j) = w%k*(BULK_EXPONENT*x%share(j) + changes%e(j)*lin%k_slope)
         x%g(j) = w%g*(SHEAR_EXPONENT*x%share(j) + changes%e(j)*lin%g_slope)
         x%psi(j) = changes%e(j) + lin%psi_f*x%f(j) + lin%psi_p*x%p(j)
         x%m_b(j) = lin%m_b_psi*x%psi(j)
      end do
      if (w%iso_active) then
         call change_of_mechanism(par, w, lin, y, changes, x)
      else
         x%k_e = x%k
         x%b = 0.0_wp
      end if
      x%volumetric = (lin%d_v - w%b_rate)*x%k_e + w%k_e*(x%v - x%b)
   end subroutine change_point

   !> a:dr of the change of the stress ratio, for a deviator a, in the unit of a. y and p, the change of p', [kPa];
   !> a_on_r is a:r.
   pure function along_ratio(lin, y, p, a, a_on_r) result(c)
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES), p(LANES), a(6), a_on_r
      real(wp) :: c(LANES)

      c = lin%per_p*(contractions(y(:, 1:6), a) - a_on_r*p)
   end function along_ratio

   !> Change of K_e and of B while the isotropic mechanism acts.
   pure subroutine change_of_mechanism(par, w, lin, y, changes, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES)
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp), dimension(LANES) :: r_dr, cube_dr
      real(wp) :: weight, approach, f, f_bond, coupling, share, a, dk, de
      real(wp) :: per_lambda, on_weight, by_norm, crowd_share, crowd_norm, e_share, per_coupling, per_a, k_a, &
         softening, per_softening, per_e_lambda, bonded_e, bonded_pc, swelling
      integer :: j

      per_lambda = 1.0_wp/par%lambda
      on_weight = 2.0_wp*(1.0_wp - w%iso%weight)
      by_norm = 3.0_wp/(lin%lode_r*w%m_b)**2
      crowd_share = 1.0_wp + 3.0_wp*(w%r_norm/par%m_c)**2
      crowd_norm = w%iso%approach*6.0_wp/par%m_c**2
      e_share = w%iso%share*(1.0_wp/lin%e - 1.0_wp/(1.0_wp + lin%e))
      per_coupling = merge(0.0_wp, w%iso%share/(1.0_wp + w%iso%c), w%iso%floored)
      per_a = w%iso%a/w%iso%share
      k_a = w%k*lin%per_p
      softening = k_a*w%iso%a
      per_softening = 1.0_wp/(1.0_wp + softening)
      per_e_lambda = per_lambda/lin%e
      bonded_e = w%bond%df_de*lin%per_f
      bonded_pc = w%bond%df_dpc*lin%per_f
      swelling = lin%kappa*(w%iso%f + w%iso%c)/3.0_wp   ! kappa falls as p'/K
      r_dr = along_ratio(lin, y, x%p, w%r, w%r_norm**2)
      cube_dr = (lin%per_p/lin%lode_r)*contractions(y(:, 1:6), lin%lode_r_slope)   ! it has no part along r
      do j = 1, LANES
         de = changes%e(j)
         ! w = 1 - (|r|/R_b(r))^2; r_dr = |r| d|r|
         weight = on_weight*(cube_dr(j) + x%m_b(j)/w%m_b) - by_norm*r_dr(j)
         f_bond = lin%per_f*x%f(j)
         approach = w%iso%approach*(x%share(j) - f_bond*per_lambda + de*per_e_lambda)
         f = -w%iso%f_slope*(crowd_share*approach + crowd_norm*r_dr(j))
         coupling = -(bonded_e*w%iso%f)*de - (lin%e*bonded_e)*(f - w%iso%f*f_bond) &
                    - (lin%e*lin%per_f*w%iso%f)*x%f_e(j)
         share = w%iso%share/w%iso%weight*weight + e_share*de - per_coupling*coupling
         a = per_a*share + w%iso%share*((par%lambda - lin%kappa)*f - lin%kappa*coupling - swelling*x%share(j))
         dk = x%k(j)/w%k
         x%k_e(j) = w%k_e*(dk - (k_a*a + softening*(dk - x%share(j)))*per_softening)
         x%b(j) = w%iso%b*changes%d_pc(j) &
                  - lin%d_pc*((w%iso%f*bonded_pc)*share + (w%iso%share*bonded_pc)*(f - w%iso%f*f_bond) &
                              + (w%iso%share*w%iso%f*lin%per_f)*x%f_pc(j))
      end do
   end subroutine change_of_mechanism
end module mud_point_changes
