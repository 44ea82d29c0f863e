! SPDX-License-Identifier: MIT
!> Checks that an increment is finite and of a credible size. A NaN is never compared: a comparison would trap.
module mud_checks
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_state, only: state_t
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_INPUT, MUD_INCREMENT_TOO_LARGE, ON_STRESS, &
      ON_STRAIN, ON_SUCTION
   use mud_tensor, only: is_finite, within, all_within
   implicit none (type, external)
   private
   public :: check_stress, check_increment

   real(wp), parameter :: LARGEST_STRAIN = 1.0_wp            !< Larger increments are asked to be cut [-].
contains
   !> Stress and suction, or the first component that is no stress. In the unit of p_atm; one that is not finite, or
   !> beyond 1e9 kPa in that unit, is MUD_BAD_INPUT.
   pure subroutine check_stress(par, sigma, p_c, status)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), p_c
      type(mud_status_t), intent(out) :: status
      integer :: i

      do i = 1, 6
         if (within(sigma(i), par%largest_stress)) cycle
         status = fail(MUD_BAD_INPUT, ON_STRESS, i, sigma(i), -par%largest_stress, par%largest_stress)
         return
      end do
      if (.not. within(p_c, par%largest_stress)) then
         status = fail(MUD_BAD_INPUT, ON_SUCTION, 0, p_c, -par%largest_stress, par%largest_stress)
      end if
   end subroutine check_stress

   !> Checks a state, its strain increment and its suction step. Strain [-], suction step in the unit of p_atm. What is
   !> not finite is MUD_BAD_INPUT; a strain component beyond 1 or a suction step beyond 1e7 kPa in that unit is
   !> MUD_INCREMENT_TOO_LARGE.
   pure subroutine check_increment(par, state, d_strain, d_pc, status)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state
      real(wp), intent(in) :: d_strain(6), d_pc
      type(mud_status_t), intent(out) :: status
      integer :: i

      if (is_credible(par, state, d_strain, d_pc)) return
      call check_stress(par, state%sigma, state%p_c, status)
      if (status%code /= MUD_OK) return
      do i = 1, 6
         if (within(d_strain(i), LARGEST_STRAIN)) cycle
         status = fail(merge(MUD_INCREMENT_TOO_LARGE, MUD_BAD_INPUT, is_finite(d_strain(i))), ON_STRAIN, i, &
                       d_strain(i), -LARGEST_STRAIN, LARGEST_STRAIN)
         return
      end do
      if (.not. within(d_pc, par%largest_suction_step)) then
         status = fail(merge(MUD_INCREMENT_TOO_LARGE, MUD_BAD_INPUT, is_finite(d_pc)), ON_SUCTION, 0, d_pc, &
                       -par%largest_suction_step, par%largest_suction_step)
      end if
   end subroutine check_increment

   !> True where check_increment finds nothing, without a branch for each number.
   pure logical function is_credible(par, state, d_strain, d_pc)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state
      real(wp), intent(in) :: d_strain(6), d_pc
      real(wp) :: stresses(6), strains(6)

      stresses = par%largest_stress
      strains = LARGEST_STRAIN
      is_credible = all_within(6, state%sigma, stresses) .and. all_within(6, d_strain, strains) .and. &
                    within(state%p_c, par%largest_stress) .and. within(d_pc, par%largest_suction_step)
   end function is_credible
end module mud_checks
