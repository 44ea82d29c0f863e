! SPDX-License-Identifier: MIT
!> Runs the stages of a model: steps, and cuts with exact restoration. Observers are told what happens.
module time_stepping
   use kinds, only: wp
   use faults, only: fault_t
   use convergence, only: control_t
   use model_types, only: model_t
   use porous_domain, only: copy_state, take_over
   use run_observer, only: observers_t, FITS, BEGINS, STAGE_BEGINS, STEP, TAKEN_OVER, REPEATED, STAGE_ENDS, &
                           ENDS
   use run_state, only: run_t, act_contacts
   use scene_parts, only: stage_t
   use sparse_factors, only: release
   use stress_tolerance, only: follow_newton, roughness
   use step_attempt, only: begin_stage, resume_stage, try_step
   use step_size, only: negligible_changes, next_step, keep_step, is_over
   use step_landings, only: LAST_STEP
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: run_stages

   integer, parameter :: GOOD_STEPS = 2           !< Accepted steps in a row after which a cut step grows back.
contains
   !> Runs all stages from where the run stands. docs/theory/host.md section 4. Faults are those of begin_stage,
   !> try_step and the observers; the first ends the run, and the observers are still told its end.
   subroutine run_stages(model, run, observers, fault)
      type(model_t), intent(inout) :: model   !< The laws follow the tolerance of the stages.
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (run%steps > 0) call observers%tell(FITS, model, run, fault)
      call observers%tell(BEGINS, model, run, fault)
      do i = max(1, run%at%stage), size(model%stages)
         if (fault%code /= 0) exit
         call run_stage(model, i, run, observers, fault)
         run%news%complete = fault%code == 0
         call observers%tell(STAGE_ENDS, model, run, fault)
      end do
      call observers%tell(ENDS, model, run, fault)
      call release(run%system%sparse)
      run%system%analysed = .false.
   end subroutine run_stages

   !> Runs a stage to its end, from where the run stands in it.
   subroutine run_stage(model, number, run, observers, fault)
      type(model_t), intent(inout) :: model
      integer, intent(in) :: number
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      real(wp) :: dt
      logical :: accepted

      associate (stage => model%stages(number))
         run%newton = control_t(stage%tolerance, stage%max_iterations, stage%no_predictor, stage%measure)
         call act_contacts(model, stage, run%system%contacts)
         ! A run that is taken up again is in the middle of its stage.
         if (run%at%stage == number) then
            call resume_stage(model, run, fault)
         else
            run%at%stage = number
            call observers%tell(STAGE_BEGINS, model, run, fault)
            call begin_stage(model, number, run, fault)
         end if
         do while (fault%code == 0)
            if (is_over(stage, run)) exit
            call follow_newton(run%newton%tolerance, model%domain%regions)
            run%newton%roughness = roughness(model%domain%regions)
            run%newton%negligible = negligible_changes(stage, run)
            dt = next_step(model, stage, run)
            call try_step(model, stage, dt, run, accepted, fault)
            if (fault%code /= 0) return
            if (accepted) then
               call close_step(model, stage, run, observers, fault)
            else
               call observers%tell(REPEATED, model, run, fault)
            end if
         end do
         if (fault%code /= 0) return
         if (stage%zero_displacements) call zero_displacements(model, run)
         call copy_state(run%state, run%next)
      end associate
   end subroutine run_stage

   !> Shows an accepted step, takes it over, and lets a step that was cut grow back.
   subroutine close_step(model, stage, run, observers, fault)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: verdict
      integer :: i

      associate (at => run%at)
         run%news%last = at%t_start + stage%duration - run%next%time <= LAST_STEP*run%scheme%dt
         at%step = at%step + 1
         run%steps = run%steps + 1
         call observers%tell(STEP, model, run, verdict)
         run%dissipated = 0.0_wp
         do i = 1, size(run%terms)
            call run%terms(i)%term%accept(run%solution_t, run%dissipated)
         end do
         call keep_step(model, stage, run)
         call take_over(run%next, run%state)
         if (.not. stage%controlled) at%nominal = min(at%nominal*stage%dt_growth, max(stage%dt_max, stage%dt))
         at%good = at%good + 1
         if (at%good >= GOOD_STEPS .and. at%factor < 1.0_wp) then
            at%factor = min(1.0_wp, 2*at%factor)
            at%cuts = max(0, at%cuts - 1)
            at%good = 0
         end if
      end associate
      call observers%tell(TAKEN_OVER, model, run, fault)
      if (fault%code == 0) fault = verdict
   end subroutine close_step

   !> Counts displacements from here on, and lets everything rest. Plates with a face of their own, which come last,
   !> stay where they are. Ties keep the stretch of their springs.
   subroutine zero_displacements(model, run)
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      real(wp) :: stretched(DISPLACEMENTS, size(run%state%x, 2))
      integer :: i

      stretched = 0.0_wp
      if (allocated(run%system%contacts)) call run%system%contacts%stretch(run%state%x, stretched)
      run%state%x(:DISPLACEMENTS, :size(run%state%x, 2) - size(model%domain%bodies)) = 0.0_wp
      run%state%x(:DISPLACEMENTS, :) = run%state%x(:DISPLACEMENTS, :) + stretched
      do i = 1, size(model%plates)
         if (model%plates(i)%penalty > 0.0_wp) run%state%x(:DISPLACEMENTS, model%plates(i)%coordinates%node) = 0.0_wp
      end do
      run%state%v = 0.0_wp
      run%state%a = 0.0_wp
      run%state%s_rate = 0.0_wp
      run%state%outflow = 0.0_wp
   end subroutine zero_displacements
end module time_stepping
