! SPDX-License-Identifier: MIT
!> Changes of a point held by the tension cut-off; derivatives of docs/theory/material.md section 6.
module mud_held
   use mud_bounding, only: psi_of, excess
   use mud_bounding_changes, only: change_of_psi, change_of_excess, change_of_limited
   use mud_cutoff, only: slide, soil_void_ratio
   use mud_driving, only: driving_t, change_of_place
   use mud_elastic, only: shear_modulus, shear_slope
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_state, only: state_t
   use mud_tensor, only: DIRECTIONS, trace, deviator, norm
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: changes_through_hold, held_tangent

   real(wp), parameter :: ON_SURFACE = 1.0e-12_wp   !< r this close (relative) to the bounding surface is on it [-].
contains
   !> Derivatives of the stress through that substep: its start moves by `shift` in pseudo-time, its size changes by dh.
   !> sigma' and y(:, 1:6) in the unit of p_atm. Derivative of docs/theory/material.md section 6.2.
   pure subroutine changes_through_hold(par, inc, parts, dparts, sigma, time, h, shift, dh, driving, y)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: sigma(6)   !< where it begins
      real(wp), intent(in) :: parts, dparts(DIRECTIONS)   !< parting and its changes
      real(wp), intent(in) :: time, h, shift(DIRECTIONS), dh(DIRECTIONS)
      type(driving_t), intent(in) :: driving
      real(wp), intent(inout) :: y(DIRECTIONS, NY)
      real(wp), dimension(DIRECTIONS) :: de_half, dp_c_half, de, dp_c, turn
      real(wp) :: r0(6), r_half(6), dr(6), strain(6), half, middle
      integer :: j

      half = 0.5_wp*h
      middle = time + half
      r0 = deviator(sigma)/par%p_min
      r_half = slide(par, inc, parts, r0, time, half)
      call change_of_place(inc, middle, void_ratio_at(inc, middle), shift + 0.5_wp*dh, driving, de_half, dp_c_half)
      call change_of_place(inc, time + h, void_ratio_at(inc, time + h), shift + dh, driving, de, dp_c)
      if (void_ratio_at(inc, middle) > parts) de_half = dparts
      if (void_ratio_at(inc, time + h) > parts) de = dparts
      turn = 0.0_wp
      if (driving%scans) turn = driving%turn
      do j = 1, DIRECTIONS
         strain = driving%d_strain%of(j, :) + (dh(j)/h)*inc%d_strain
         dr = y(j, 1:6)
         dr = change_of_slide(par, inc, parts, r0, time, half, deviator(dr)/par%p_min, strain, de_half(j), &
                              dp_c_half(j), turn(j))
         y(j, 1:6) = par%p_min*change_of_slide(par, inc, parts, r_half, middle, half, dr, strain, de(j), dp_c(j), &
                                               turn(j))
      end do
   end subroutine changes_through_hold

   !> Tangent of a held point: p' rests, the stress ratio moves. In the unit of p_atm, with engineering shear strain;
   !> against suction [-]. The state is that of the end of inc. docs/theory/integration.md section 5.4.
   pure subroutine held_tangent(par, inc, state, dsig_deps, dsig_dpc)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(state_t), intent(in) :: state
      real(wp), intent(out) :: dsig_deps(6, 6), dsig_dpc(6)
      real(wp) :: unit(6), r(6), e, psi
      integer :: j
      logical :: at_surface, slides

      e = soil_void_ratio(state)
      r = deviator(state%sigma)/par%p_min
      psi = psi_of(par%critical, inc%suction, e, state%p_c, par%p_min)
      at_surface = norm(r) > 0.0_wp
      if (at_surface) at_surface = excess(par%critical, psi, r) >= -ON_SURFACE
      slides = .false.
      ! where an elastic rate would leave the surface
      if (at_surface) slides = change_of_excess(par, psi, r, rate_of_psi(inc%d_strain, inc%d_pc), &
                                                rate(inc%d_strain, inc%d_pc)) > 0.0_wp
      do j = 1, 6
         unit = 0.0_wp
         unit(j) = merge(1.0_wp, 0.5_wp, j <= 3)
         dsig_deps(:, j) = par%p_min*rate(unit, 0.0_wp)
      end do
      unit = 0.0_wp
      dsig_dpc = par%p_min*rate(unit, 1.0_wp)
   contains
      !> Rate of the stress ratio for a strain rate and a suction rate, linear in both: elastic, or along the bounding
      !> surface [-]. docs/theory/material.md section 6.2.
      pure function rate(d_strain, d_pc)
         real(wp), intent(in) :: d_strain(6), d_pc
         real(wp) :: rate(6)

         rate = deviator((2.0_wp*shear_modulus(par%elastic, e, par%p_min)/par%p_min)*d_strain)
         if (slides) rate = change_of_limited(par, psi, r, rate_of_psi(d_strain, d_pc), rate)
      end function rate

      !> Rate of the state parameter [-]. Where there is a gap it takes the change of volume.
      pure real(wp) function rate_of_psi(d_strain, d_pc)
         real(wp), intent(in) :: d_strain(6), d_pc

         rate_of_psi = change_of_psi(par, inc%suction, e, state%p_c, par%p_min, &
                                     merge(0.0_wp, -(1.0_wp + e)*trace(d_strain), state%gap > 0.0_wp), d_pc, 0.0_wp)
      end function rate_of_psi
   end subroutine held_tangent

   !> Change of that stress ratio with r0, with the increment's strain, with void ratio and suction at the end and with
   !> a branch, of ln x of its turn. All [-] but dp_c [kPa]; time and h are shares of inc. Derivative of
   !> docs/theory/material.md section 6.2.
   pure function change_of_slide(par, inc, parts, r0, time, h, dr0, d_strain, de, dp_c, d_turn) result(change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, r0(6), time, h, dr0(6), d_strain(6), de, dp_c, d_turn
      real(wp) :: change(6), r(6), e, p_c, stiffness, psi, dpsi

      e = min(void_ratio_at(inc, time + h), parts)
      p_c = suction_at(inc, time + h)
      stiffness = 2.0_wp*shear_modulus(par%elastic, e, par%p_min)/par%p_min*h
      r = r0 + deviator(stiffness*inc%d_strain)
      change = dr0 + deviator(stiffness*d_strain) + deviator((stiffness*shear_slope(e)*de)*inc%d_strain)
      psi = psi_of(par%critical, inc%suction, e, p_c, par%p_min)
      if (norm(r) <= 0.0_wp) return
      if (excess(par%critical, psi, r) <= 0.0_wp) return
      dpsi = change_of_psi(par, inc%suction, e, p_c, par%p_min, de, dp_c, 0.0_wp, d_turn)
      change = change_of_limited(par, psi, r, dpsi, change)
   end function change_of_slide
end module mud_held
