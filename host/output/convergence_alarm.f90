! SPDX-License-Identifier: MIT
!> Warnings of steps that Newton's method accepts in another way than the scene says: loads that act at once and are
!> applied evenly, and an error that stays above the tolerance.
module convergence_alarm
   use faults, only: fault_t
   use run_observer, only: observer_t, STEP
   use run_state, only: run_t, now_in
   use texts, only: short
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: convergence_alarm_t

   type, extends(observer_t) :: convergence_alarm_t
      integer :: told = 0   !< Stage whose stagnation has been told.
   contains
      procedure :: hear
   end type convergence_alarm_t
contains
   !> Tells of both once a stage, on standard error, also where the run is quiet. docs/theory/host.md sections 4.4 and
   !> 5.1.
   subroutine hear(self, event, run, fault)
      class(convergence_alarm_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      if (event /= STEP) return
      if (run%at%step == 1 .and. allocated(run%at%sudden)) &
         call print_warning('stage '//trim(run%stage%name)//': its loads act at once and the '// &
            'first step did not converge: they are applied evenly over the stage. A material with a '// &
            'memory may answer otherwise than at once; give the loads a &history to say how they grow.')
      if (self%told == run%at%stage .or. .not. run%log%stagnated) return
      self%told = run%at%stage
      call print_warning(now_in(run)//'Newton''s method stays at an error of '//short(maxval(run%log%error))// &
         ' and cannot reach its tolerance of '//short(run%newton%tolerance)//', because stresses are integrated to '// &
         short(run%newton%roughness)//'. The step is accepted. Give &stage a tolerance above the error reached, or '// &
         'the material a smaller one.')
   end subroutine hear
end module convergence_alarm
