! SPDX-License-Identifier: MIT
!> Terms that the derivatives of one rate share, whatever the direction in which its arguments change, and changes of
!> what the rate takes from the point alone - moduli, state parameter, bounding ratio, isotropic mechanism - along
!> directions that stand side by side; docs/theory/integration.md section 5.3.
module mud_linearise
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_bonding, only: suction_law_t, bonding_curvature, bonding_with_turn
   use mud_critical_state, only: state_parameter_slopes, bounding_slope, lode_gradient
   use mud_elastic, only: bulk_slope, shear_slope, swelling_slope, centre_modulus, changed_centre_modulus, &
      BULK_EXPONENT, SHEAR_EXPONENT
   use mud_loading, only: loading_t
   use mud_hardening, only: kinematic_slope, isotropic_slopes_t, isotropic_slopes, BY_P, BY_E, BY_F, BY_F_E, BY_R, &
      BY_R_B
   use mud_rate, only: rate_t
   use mud_rates, only: p_follows
   use mud_retention, only: moves_with_turn
   use mud_tensor, only: DIRECTIONS, contractions, trace
   use mud_turn, only: turn_t, find_turn
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: linearised_t, linearise, changes_t, inner_changes_t, sum_t, NO_SUM, rest, change_point, along_ratio, &
             linearise_mechanism, changes_of_hardening

   !> Terms of a derivative of a rate that all directions share.
   type, extends(turn_t) :: linearised_t
      logical :: held_p                     !< p' is at its lower bound: it does not follow the stress.
      real(wp) :: d_v, whole_v, d_pc        !< Traces of the strain rate that loads and of the whole one; suction rate.
      real(wp) :: curvature(3)              !< curvatures of f [1/kPa2, 1/kPa, -]
      real(wp) :: with_turn(3)              !< slopes of f, df/dp_c, df/de by ln x of the branch's turn [-, 1/kPa, -]
      real(wp) :: psi_f, psi_p, m_b_psi     !< slopes of psi by f and p', of M^b by psi [-, 1/kPa, -]
      real(wp) :: k_slope, g_slope, b_slope !< d ln K/de, d ln G/de, d ln b_0/de [-]
      logical :: aside                      !< A part of the strain rate does not load.
      real(wp) :: g_centre                  !< Shear modulus of what does not [kPa] ...
      real(wp) :: g_centre_slopes(3)        !< ... and slopes by ln p', e, volume from the centre, if aside [kPa].
      real(wp) :: per_p, per_f, per_gamma, per_y   !< Reciprocals of p', f, gamma, y.
      real(wp) :: lode_r, lode_r_slope(6)   !< Lode factor in the direction of r and its gradient, a deviator ...
      type(isotropic_slopes_t) :: mechanism   !< ... and slopes of the isotropic mechanism, where it acts.
      real(wp) :: on_e(4)                   !< n, h_n, d_n, gamma_n on the deviatoric strain rate
   end type linearised_t

   !> Changes of the arguments of a rate beside stress, fabric and memory.
   type :: changes_t
      real(wp), dimension(DIRECTIONS) :: e, p_c, d_pc   !< changes of void ratio, suction and its rate [-, kPa, kPa]
      type(loading_t) :: loading                   !< changes of the strain rate that loads
      logical :: scans                             !< The branch changes with its turn; otherwise turn is not set.
      real(wp) :: turn(DIRECTIONS)                      !< changes of ln x of that turn [-]
   end type changes_t

   !> Changes of a tensor as a sum. Of those of the whole strain rate, of stress, and of what loads as far as it is not
   !> along fixed tensors, by factors; of the fixed tensors, n, r and the unit tensor by numbers that change.
   type :: sum_t
      real(wp) :: of_whole, of_loading, of_stress
      real(wp), dimension(DIRECTIONS) :: first, second, n, r, p
   end type sum_t
   type(sum_t), parameter :: NO_SUM = sum_t(0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp)

   !> Changes between those of a rate's arguments and those of its results.
   type :: inner_changes_t
      real(wp), dimension(DIRECTIONS) :: mean, v          !< a third of the trace of stress; trace of the strain rate
      real(wp), dimension(DIRECTIONS) :: p, share         !< changes of p', and over p'
      real(wp), dimension(DIRECTIONS) :: f, f_pc, f_e     !< changes of f, df/dp_c, df/de
      real(wp), dimension(DIRECTIONS) :: k, g, psi, m_b, k_e, b, volumetric, dd, dh, beta, gamma
      real(wp), dimension(DIRECTIONS) :: n_dr, h_dr, d_dr, gamma_dr   !< n:dr, and of the gradients along n
      real(wp), dimension(DIRECTIONS) :: dl, flow         !< changes of L and of L D
      type(sum_t) :: turn                            !< dn
   end type inner_changes_t
contains
   !> Prepares the derivative of a rate w that was evaluated at (sigma, e, p_c) for the strain rate of loading and d_pc.
   !> sigma' and p_c [kPa], compression positive; e [-]; d_pc [kPa]. Of a rate that does not load the gradients and the
   !> inverse are not set. docs/theory/integration.md sections 5.2, 5.3.
   pure subroutine linearise(par, law, w, sigma, e, p_c, loading, d_pc, at_rest, lin)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law   !< in the phase
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: sigma(6), e, p_c, d_pc
      type(loading_t), intent(in) :: loading
      logical, intent(in) :: at_rest   !< The state does not change: slopes by it are not set.
      type(linearised_t), intent(inout) :: lin
      real(wp) :: traces(2)

      traces = [trace(loading%basis(:, 1)), trace(loading%basis(:, 2))]
      lin%d_v = loading%part(1)*traces(1) + loading%part(2)*traces(2)
      lin%whole_v = loading%whole(1)*traces(1) + loading%whole(2)*traces(2)
      lin%d_pc = d_pc
      lin%aside = loading%aside
      lin%g_centre = w%g
      if (loading%aside) then
         call changed_centre_modulus(par%elastic, e, w%k, loading%from_centre, lin%g_centre, lin%g_centre_slopes)
      else if (loading%beside) then
         lin%g_centre = centre_modulus(par%elastic, e, w%k, loading%from_centre)
      end if
      lin%per_p = 1.0_wp/w%p
      if (.not. at_rest) call linearise_state(par, law, w, sigma, e, p_c, lin)
      if (.not. w%loading) return
      call find_turn(par, w, lin%turn_t)
      lin%on_e = (lin%on_t + (w%k_e*(lin%d_v - w%b_rate))*lin%on_r)/(2.0_wp*w%g)   ! t = 2 G e - V r
      lin%per_gamma = 1.0_wp/w%gamma
      lin%per_y = 1.0_wp/w%y
   end subroutine linearise

   !> Sets what the changes of the state alone need.
   pure subroutine linearise_state(par, law, w, sigma, e, p_c, lin)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: sigma(6), e, p_c
      type(linearised_t), intent(inout) :: lin

      lin%held_p = .not. p_follows(par, sigma)
      lin%curvature = 0.0_wp
      lin%with_turn = 0.0_wp
      if (law%bonds) then
         lin%curvature = bonding_curvature(law, w%bond, p_c, e)
         if (moves_with_turn(law%retention_t)) lin%with_turn = bonding_with_turn(law, w%bond, p_c, e)
      end if
      call state_parameter_slopes(par%critical, w%psi, w%bond%f, e, w%p, lin%psi_f, lin%psi_p)
      lin%m_b_psi = bounding_slope(par%critical, w%psi, w%m_b)
      lin%k_slope = bulk_slope(e)
      lin%g_slope = shear_slope(e)
      lin%b_slope = kinematic_slope(par%hardening, e)
      lin%per_f = 1.0_wp/w%bond%f
      if (w%iso_active) call linearise_mechanism(par, w, e, lin)
   end subroutine linearise_state

   !> Sets the part of a linearisation that has the isotropic mechanism, which acts or would.
   !> docs/theory/integration.md section 5.3.
   pure subroutine linearise_mechanism(par, w, e, lin)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: e
      type(linearised_t), intent(inout) :: lin

      call lode_gradient(par%critical, w%r, w%r_norm, lin%lode_r, lin%lode_r_slope)
      lin%mechanism = isotropic_slopes(par%critical, w%bond, e, swelling_slope(w%k, e, w%p), &
                                       SQRT_2_3*lin%lode_r*w%m_b, w%iso)
   end subroutine linearise_mechanism

   !> Sets the changes that change_point leaves where only the strain rate and the suction rate change. Units as in
   !> change_point.
   pure subroutine rest(w, changes, x)
      type(rate_t), intent(in) :: w
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(inout) :: x
      real(wp) :: b

      b = 0.0_wp
      if (w%iso_active) b = w%iso%b
      x%mean = 0.0_wp
      x%p = 0.0_wp
      x%share = 0.0_wp
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
   pure subroutine change_point(w, lin, y, changes, x)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(inout) :: x
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
      do j = 1, DIRECTIONS
         x%p(j) = follows*x%mean(j)
         x%share(j) = x%p(j)*lin%per_p
         x%k(j) = w%k*(BULK_EXPONENT*x%share(j) + changes%e(j)*lin%k_slope)
         x%g(j) = w%g*(SHEAR_EXPONENT*x%share(j) + changes%e(j)*lin%g_slope)
         x%psi(j) = changes%e(j) + lin%psi_f*x%f(j) + lin%psi_p*x%p(j)
         x%m_b(j) = lin%m_b_psi*x%psi(j)
      end do
      if (w%iso_active) then
         call change_of_mechanism(w, lin, y, changes, x)
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
      real(wp), intent(in) :: y(DIRECTIONS, NY), p(DIRECTIONS), a(6), a_on_r
      real(wp) :: c(DIRECTIONS)

      c = lin%per_p*(contractions(y(:, 1:6), a) - a_on_r*p)
   end function along_ratio

   !> Changes of A and of B per suction of the isotropic mechanism, in the units of both.
   pure subroutine changes_of_hardening(w, lin, y, changes, x, a, b)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(in) :: x
      real(wp), dimension(DIRECTIONS), intent(out) :: a, b
      real(wp), dimension(DIRECTIONS) :: r_dr, r_b
      real(wp) :: f
      integer :: j

      r_dr = along_ratio(lin, y, x%p, w%r, w%r_norm**2)
      r_b = (lin%per_p/lin%lode_r)*contractions(y(:, 1:6), lin%lode_r_slope) + x%m_b/w%m_b   ! no part along r
      associate (of => lin%mechanism)
         do j = 1, DIRECTIONS
            f = lin%per_f*x%f(j)
            a(j) = of%a(BY_P)*x%share(j) + of%a(BY_E)*changes%e(j) + of%a(BY_F)*f + of%a(BY_F_E)*x%f_e(j) &
                + of%a(BY_R)*r_dr(j) + of%a(BY_R_B)*r_b(j)
            b(j) = of%b(BY_P)*x%share(j) + of%b(BY_E)*changes%e(j) + of%b(BY_F)*f + of%b(BY_F_E)*x%f_e(j) &
                + of%b(BY_R)*r_dr(j) + of%b(BY_R_B)*r_b(j) + of%b_f_pc*x%f_pc(j)
         end do
      end associate
   end subroutine changes_of_hardening

   !> Change of K_e and of B while the isotropic mechanism acts.
   pure subroutine change_of_mechanism(w, lin, y, changes, x)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(inout) :: x
      real(wp), dimension(DIRECTIONS) :: a, b
      real(wp) :: k_a, softening, per_softening, dk
      integer :: j

      k_a = w%k*lin%per_p
      softening = k_a*w%iso%a
      per_softening = 1.0_wp/(1.0_wp + softening)
      call changes_of_hardening(w, lin, y, changes, x, a, b)
      do j = 1, DIRECTIONS
         dk = x%k(j)/w%k
         x%k_e(j) = w%k_e*(dk - (k_a*a(j) + softening*(dk - x%share(j)))*per_softening)
         x%b(j) = w%iso%b*changes%d_pc(j) + lin%d_pc*b(j)
      end do
   end subroutine change_of_mechanism
end module mud_linearise
