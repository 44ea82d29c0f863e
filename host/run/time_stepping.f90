! SPDX-License-Identifier: MIT
!> Runs the stages of a model: steps, and cuts with exact restoration. Observers are told what happens.
module time_stepping
   use kinds, only: wp
   use faults, only: fault_t
   use porous_domain, only: copy_state
   use run_observer, only: observers_t, FITS, BEGINS, STAGE_BEGINS, STEP, TAKEN_OVER, REPEATED, STAGE_ENDS, &
                           ENDS
   use run_state, only: run_t, enter_stage
   use solution, only: control_t
   use sparse_factors, only: release
   use newton_step, only: follow_newton, roughness
   use step_balance, only: balance_step
   use step_attempt, only: begin_stage, try_step
   use step_size, only: negligible_changes, next_step, keep_step, is_over
   use step_landings, only: LAST_STEP
   use unknown_fields, only: DISPLACEMENTS
   use wall_clock, only: clock
   implicit none (type, external)
   private
   public :: run_stages

   integer, parameter :: GOOD_STEPS = 2           !< Accepted steps in a row after which a cut step grows back.
   integer, parameter :: CUTS_IN_VAIN = 2         !< After so many a step with little air left gets more iterations.
   integer, parameter :: UNTIL_AIR_IS_GONE = 60   !< Halvings of a correction down to its rounding.
contains
   !> Runs all stages from where the run stands. docs/theory/host.md section 4. Faults are those of begin_stage,
   !> try_step and the observers; the first ends the run, and the observers are still told its end.
   subroutine run_stages(run, observers, fault)
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (run%steps > 0) call observers%tell(FITS, run, fault)
      call observers%tell(BEGINS, run, fault)
      run%kept = clock()
      do i = max(1, run%at%stage), size(run%model%stages)
         if (fault%code /= 0) exit
         call run_stage(i, run, observers, fault)
         run%complete = fault%code == 0
         call observers%tell(STAGE_ENDS, run, fault)
      end do
      call observers%tell(ENDS, run, fault)
      call release(run%system%sparse)
      run%system%analysed = .false.
   end subroutine run_stages

   !> Runs a stage to its end, from where the run stands in it.
   subroutine run_stage(number, run, observers, fault)
      integer, intent(in) :: number
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      logical :: begins, accepted

      begins = run%at%stage /= number
      call enter_stage(run, number)
      associate (stage => run%stage)
         run%newton = control_t(stage%tolerance, stage%max_iterations, stage%no_predictor, stage%measure)
      end associate
      if (begins) call observers%tell(STAGE_BEGINS, run, fault)
      call begin_stage(begins, run, fault)
      do while (fault%code == 0)
         if (is_over(run)) exit
         call follow_newton(run%newton%tolerance, run%domain%regions)
         run%newton%roughness = roughness(run%domain%regions)
         run%newton%negligible = negligible_changes(run)
         ! Corrections halve where the last air leaves, whatever the step: docs/theory/host.md section 5.1.
         run%newton%max_iterations = run%stage%max_iterations
         if (run%stage%controlled .and. run%domain%with_c .and. run%at%good == 0 .and. run%at%cuts >= CUTS_IN_VAIN) &
            run%newton%max_iterations = max(run%stage%max_iterations, UNTIL_AIR_IS_GONE)
         call try_step(next_step(run), run, accepted, fault)
         if (fault%code /= 0) return
         if (accepted) then
            call close_step(run, observers, fault)
         else
            call observers%tell(REPEATED, run, fault)
         end if
      end do
      if (fault%code /= 0) return
      if (run%stage%zero_displacements) call zero_displacements(run)
      call copy_state(run%state, run%next)
   end subroutine run_stage

   !> Shows an accepted step, takes it over, and lets a step that was cut grow back.
   subroutine close_step(run, observers, fault)
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: verdict
      integer :: i

      associate (at => run%at, stage => run%stage)
         run%last = at%t_start + stage%duration - run%next%time <= LAST_STEP*run%scheme%dt
         at%step = at%step + 1
         run%steps = run%steps + 1
         call balance_step(run)
         call observers%tell(STEP, run, verdict)
         run%dissipated = 0.0_wp
         do i = 1, size(run%terms)
            call run%terms(i)%term%accept(run%problem_t, run%dissipated)
         end do
         call keep_step(run)
         call copy_state(run%next, run%state)
         if (.not. stage%controlled) at%nominal = min(at%nominal*stage%dt_growth, max(stage%dt_max, stage%dt))
         at%good = at%good + 1
         if (at%good >= GOOD_STEPS .and. at%factor < 1.0_wp) then
            at%factor = min(1.0_wp, 2*at%factor)
            at%cuts = max(0, at%cuts - 1)
            at%good = 0
         end if
      end associate
      call observers%tell(TAKEN_OVER, run, fault)
      if (fault%code == 0 .and. associated(observers%keep)) call observers%keep(run, observers, fault)
      if (fault%code == 0) fault = verdict
   end subroutine close_step

   !> Counts displacements from here on, and lets everything rest. Plates with a face of their own, which come last,
   !> stay where they are. Ties keep the stretch of their springs.
   subroutine zero_displacements(run)
      type(run_t), intent(inout) :: run
      real(wp) :: stretched(DISPLACEMENTS, size(run%state%x, 2))
      integer :: i

      stretched = 0.0_wp
      if (allocated(run%system%contacts)) call run%system%contacts%stretch(run%state%x, stretched)
      run%state%x(:DISPLACEMENTS, :size(run%state%x, 2) - size(run%domain%bodies)) = 0.0_wp
      run%state%x(:DISPLACEMENTS, :) = run%state%x(:DISPLACEMENTS, :) + stretched
      do i = 1, size(run%model%plates)
         associate (plate => run%model%plates(i))
            if (plate%penalty > 0.0_wp) run%state%x(:DISPLACEMENTS, plate%coordinates%node) = 0.0_wp
         end associate
      end do
      run%state%v = 0.0_wp
      run%state%a = 0.0_wp
      run%state%s_rate = 0.0_wp
      run%state%outflow = 0.0_wp
   end subroutine zero_displacements
end module time_stepping
