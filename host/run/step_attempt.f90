! SPDX-License-Identifier: MIT
!> The start of a stage, and one attempt at a step: what it prescribes, its solution, and the size of the next attempt.
!> docs/theory/host.md section 4.4.
module step_attempt
   use kinds, only: wp
   use faults, only: fault_t
   use boundary_conditions, only: constrain_step, complete_constraint, follow_accelerations, starting_accelerations, &
                                  load_at
   use model_types, only: gravity_at, share_over
   use newton_step, only: take_step, start_accelerations, unbalanced_forces, &
                          CONVERGED, MATERIAL_FAILED, BODY_FREE, SOLVER_FAILED
   use porous_domain, only: copy_state
   use run_state, only: run_t
   use step_failure, only: explain_failure, explain_short_step, LEAST_OF_STAGE
   use step_landings, only: LEAST_SPACINGS
   use step_size, only: begin_control, begin_attempt, judge_step, shorten_step
   use solution, only: stage_state_t
   implicit none (type, external)
   private
   public :: begin_stage, try_step

   integer, parameter :: CUTS_IN_VAIN = 2   !< At the start of a static stage, until what acts at once is spread.
contains
   !> Sets a run at the start of a stage that it has entered: terms, prescribed values, control of the steps, first
   !> accelerations. docs/theory/host.md section 4.1. Faults: those of terms and set_step and, for the accelerations,
   !> explain_failure.
   subroutine begin_stage(begins, run, fault)
      logical, intent(in) :: begins   !< Else the run is taken up in the middle of its stage: the terms alone begin.
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i

      associate (stage => run%stage)
         if (begins) run%at = stage_state_t(stage=run%at%stage, t_start=run%state%time, nominal=stage%dt, &
                                            x_start=run%state%x)
         do i = 1, size(run%terms)
            if (fault%code == 0) call run%terms(i)%term%begin_stage(begins, run%problem_t, fault)
         end do
         if (fault%code /= 0 .or. .not. begins) return
         run%system%factored = .false.
         run%assembly%slopes%known = .false.
         call set_step(0.0_wp, run, fault)
         if (fault%code /= 0) return
         call begin_control(run)
         if (stage%has_inertia .and. stage%solve_start) call first_accelerations(run, fault)
      end associate
   end subroutine begin_stage

   !> Tries a step from run%state to run%next; where it fails the next step is smaller, or the fault says why there is
   !> none. docs/theory/host.md section 4.4. Faults: those of set_step; that of explain_failure where no cut is left,
   !> the linear solver failed, or the matrix is singular by no soft point.
   subroutine try_step(dt, run, accepted, fault)
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(inout) :: run
      logical, intent(out) :: accepted   !< False also where its error is too large.
      type(fault_t), intent(inout) :: fault
      real(wp), allocatable :: a0(:, :)
      real(wp) :: share
      logical :: lost
      integer :: i

      accepted = .false.
      if (dt < shortest_step(run)) then
         call explain_short_step(run, dt, fault)
         return
      end if
      run%next%gravity = gravity_at(run%model, run%state%time + dt)
      call set_step(dt, run, fault)
      if (fault%code /= 0) return
      call begin_attempt(dt, run)
      if (any(run%model%fixes%acceleration)) call follow_accelerations(run%problem_t)
      call take_step(run)
      if (run%log%refused_guess .and. run%at%step == 0) then
         ! The accelerations of the start are none that so long a step can follow: it begins without them.
         a0 = run%state%a
         run%state%a = 0.0_wp
         call take_step(run)
         if (run%log%outcome /= CONVERGED) run%state%a = a0
      end if
      run%iterations = run%iterations + run%log%iterations
      run%rate_evaluations = run%rate_evaluations + run%log%rate_evaluations
      accepted = run%log%outcome == CONVERGED
      if (accepted) then
         call judge_step(run, accepted)
         if (.not. accepted) run%assembly%slopes%known = .false.
         do i = 1, size(run%terms)
            call run%terms(i)%term%complete(run%problem_t)
         end do
         return
      end if
      associate (at => run%at, outcome => run%log%outcome)
         run%cuts = run%cuts + 1
         at%cuts = at%cuts + 1
         at%good = 0
         run%system%factored = .false.
         ! A shorter step helps a singular matrix only where it is points of the material that resist with nothing, or a
         ! contact that an iterate has opened.
         lost = outcome == BODY_FREE .and. run%assembly%replaced == 0
         if (at%step > 0) lost = lost .and. .not. any([(run%model%contacts(i)%in_stage(at%stage), &
                                                        i=1, size(run%model%contacts))])
         share = merge(min(run%assembly%bad%factor, 0.5_wp), 0.5_wp, outcome == MATERIAL_FAILED)
         if (at%cuts > run%stage%cuts .or. outcome == SOLVER_FAILED .or. share*dt < shortest_step(run) .or. lost) then
            call explain_failure(run, dt, fault)
            return
         end if
         if (.not. run%stage%has_rates .and. at%step == 0 .and. at%cuts == CUTS_IN_VAIN) &
            call spread_sudden_loads(run)
         ! Nothing of the failed step is kept: the next attempt starts from run%state alone.
         at%factor = at%factor*share
         call shorten_step(run)
      end associate
   end subroutine try_step

   !> Loads that act at once are the same in a shorter step: from here on they are applied evenly over the stage.
   !> docs/theory/host.md section 4.4.
   subroutine spread_sudden_loads(run)
      type(run_t), intent(inout) :: run
      real(wp), allocatable :: forces(:)

      call copy_state(run%state, run%next)
      run%next%gravity = gravity_at(run%model, run%state%time)
      if (unbalanced_forces(run%solution_t, forces)) &
         call move_alloc(forces, run%at%sudden)
   end subroutine spread_sudden_loads

   !> Shorter steps do not come to an end, or do not move the time [s].
   pure real(wp) function shortest_step(run) result(dt)
      type(run_t), intent(in) :: run

      dt = max(LEAST_OF_STAGE*run%stage%duration, LEAST_SPACINGS*spacing(run%state%time))
   end function shortest_step

   !> Sets loads and prescribed unknowns of a step from the state that it starts from, of the scene and of its terms.
   !> Its length is 0 where a stage begins.
   subroutine set_step(dt, run, fault)
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i

      associate (c => run%constraint, until => run%state%time + dt)
         c%load_0 = load_at(run%model, run%at%stage, run%state%time)
         c%load_1 = load_at(run%model, run%at%stage, until)
         do i = 1, size(run%terms)
            if (fault%code == 0) call run%terms(i)%term%before_step(dt, run%problem_t, fault)
         end do
         if (fault%code /= 0) return
         c%faded = 0.0_wp
         if (allocated(run%at%sudden)) then
            c%faded = (share_over(run, until) - share_over(run, run%state%time))*run%at%sudden
            c%load_0 = c%load_0 - (1 - share_over(run, run%state%time))*run%at%sudden
            c%load_1 = c%load_1 - (1 - share_over(run, until))*run%at%sudden
         end if
      end associate
      call constrain_step(run%state%time + dt, run%problem_t)
      do i = 1, size(run%terms)
         call run%terms(i)%term%prescribe(run%state%time + dt, run%problem_t)
      end do
      call complete_constraint(run%problem_t)
      do i = 1, size(run%terms)
         call run%terms(i)%term%limit(run%state%time + dt, run%problem_t)
      end do
   end subroutine set_step

   subroutine first_accelerations(run, fault)
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      if (any(run%model%fixes%acceleration)) call starting_accelerations(run%problem_t)
      call start_accelerations(run%solution_t)
      if (run%log%outcome /= CONVERGED) call explain_failure(run, 0.0_wp, fault)
   end subroutine first_accelerations
end module step_attempt
