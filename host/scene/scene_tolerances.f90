! SPDX-License-Identifier: MIT
!> What the tolerance of the steps asks of the keys that a scene leaves out: steps, Newton's method, stress integration.
!> What the scene sets by hand stays. docs/theory/host.md section 4.5.
module scene_tolerances
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use namelists, only: group_t, set_entry
   use key_schema, only: given
   use scene_parts, only: stage_t
   implicit none (type, external)
   private
   public :: ask_steps, ask_stress

   real(wp), parameter :: DEFAULT_TOLERANCE = 1.0e-3_wp  !< Of stages without dt in scenes that give none.
   real(wp), parameter :: NEWTON_SHARE = 0.1_wp          !< Newton's tolerance as a share of the steps'.
   real(wp), parameter :: NEWTON_LARGEST = 1.0e-4_wp     !< Its bound: the residuals of all steps add up.
   real(wp), parameter :: STRESS_SHARE = 0.1_wp          !< Tolerance of MUD's stress integration, likewise.
   real(wp), parameter :: STRESS_LEAST = 1.0e-10_wp, STRESS_LARGEST = 1.0e-3_wp   !< Its bounds.
   real(wp), parameter :: TIGHT = 1.0e-3_wp              !< Below it the scheme of order 3 costs less.
contains
   !> Steps and tolerance of a stage. docs/theory/host.md section 4.5. Fault EXIT_INPUT: steps = "given" without dt.
   subroutine ask_steps(group, tolerance, by_error, stage, fault)
      type(group_t), intent(in) :: group
      real(wp), intent(in) :: tolerance  !< Of the scene; 0: not given.
      logical, intent(in) :: by_error    !< The key steps says it.
      type(stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault

      stage%step_tolerance = tolerance
      if (.not. tolerance > 0.0_wp) stage%step_tolerance = DEFAULT_TOLERANCE
      stage%controlled = tolerance > 0.0_wp .or. .not. given(group, 'dt')
      if (given(group, 'steps')) stage%controlled = by_error
      if (.not. (given(group, 'dt') .or. stage%controlled)) call raise(fault, EXIT_INPUT, at_line(group%file, &
         group%line)//'&stage with steps = ''given'' needs dt [s].')
      if (stage%controlled .and. .not. given(group, 'tolerance')) &
         stage%tolerance = min(NEWTON_LARGEST, NEWTON_SHARE*stage%step_tolerance)
   end subroutine ask_steps

   !> Tolerance and scheme of MUD. docs/theory/host.md section 4.5; nothing for other laws.
   subroutine ask_stress(tolerance, group)
      real(wp), intent(in) :: tolerance   !< Of the scene [-]; 0: nothing.
      type(group_t), intent(inout) :: group
      character(16) :: text

      if (.not. tolerance > 0.0_wp .or. group%name /= 'mud') return
      if (.not. given(group, 'tolerance')) then
         write (text, '(es10.3)') min(STRESS_LARGEST, max(STRESS_LEAST, STRESS_SHARE*tolerance))
         call set_entry(group, 'tolerance', trim(adjustl(text)))
      end if
      if (.not. given(group, 'scheme') .and. tolerance < TIGHT) call set_entry(group, 'scheme', '2')
   end subroutine ask_stress
end module scene_tolerances
