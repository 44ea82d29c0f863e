! SPDX-License-Identifier: MIT
!> Changes of a point held by the tension cut-off; derivatives of docs/theory/material.md section 6.
module mud_held
   use mud_bonding, only: suction_law_t
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
      real(wp) :: unit(6), r(6), e, follows
      integer :: j
      logical :: sliding

      e = soil_void_ratio(state)
      follows = merge(0.0_wp, 1.0_wp, state%gap > 0.0_wp)
      r = deviator(state%sigma)/par%p_min
      sliding = slides(par, inc%suction, e, state%p_c, r, follows, inc%d_strain, inc%d_pc)
      do j = 1, 6
         unit = 0.0_wp
         unit(j) = merge(1.0_wp, 0.5_wp, j <= 3)
         dsig_deps(:, j) = par%p_min*held_rate(par, inc%suction, e, state%p_c, r, follows, sliding, unit, 0.0_wp)
      end do
      unit = 0.0_wp
      dsig_dpc = par%p_min*held_rate(par, inc%suction, e, state%p_c, r, follows, sliding, unit, 1.0_wp)
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

   !> True where the stress ratio of a held point is on the bounding surface and an elastic rate would leave it.
   !> docs/theory/material.md section 6.2, to 1e-12 of the surface.
   pure logical function slides(par, law, e, p_c, r, follows, d_strain, d_pc)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      real(wp), intent(in) :: e, p_c, r(6), d_strain(6), d_pc   !< [-, kPa, -, -, kPa]; e: of the soil
      real(wp), intent(in) :: follows   !< 0 where the gap takes the change of volume, otherwise 1
      real(wp) :: psi, dpsi

      slides = .false.
      if (norm(r) <= 0.0_wp) return
      psi = psi_of(par%critical, law, e, p_c, par%p_min)
      if (excess(par%critical, psi, r) < -ON_SURFACE) return
      dpsi = change_of_psi(par, law, e, p_c, par%p_min, -follows*(1.0_wp + e)*trace(d_strain), d_pc, 0.0_wp)
      slides = change_of_excess(par, psi, r, dpsi, held_rate(par, law, e, p_c, r, follows, .false., d_strain, &
                                                                d_pc)) > 0.0_wp
   end function slides

   !> Rate of the stress ratio of a held point for a strain rate and a suction rate, linear in both: elastic, or along
   !> the bounding surface. [-], per unit of pseudo-time. docs/theory/material.md section 6.2,
   !> docs/theory/integration.md section 5.4.
   pure function held_rate(par, law, e, p_c, r, follows, sliding, d_strain, d_pc) result(rate)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      logical, intent(in) :: sliding
      real(wp), intent(in) :: e, p_c, r(6), d_strain(6), d_pc   !< [-, kPa, -, -, kPa]; e: of the soil
      real(wp), intent(in) :: follows   !< 0 where the gap takes the change of volume, otherwise 1
      real(wp) :: rate(6), psi, dpsi

      rate = deviator((2.0_wp*shear_modulus(par%elastic, e, par%p_min)/par%p_min)*d_strain)
      if (.not. sliding) return
      psi = psi_of(par%critical, law, e, p_c, par%p_min)
      dpsi = change_of_psi(par, law, e, p_c, par%p_min, -follows*(1.0_wp + e)*trace(d_strain), d_pc, 0.0_wp)
      rate = change_of_limited(par, psi, r, dpsi, rate)
   end function held_rate
end module mud_held
