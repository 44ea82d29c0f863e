! SPDX-License-Identifier: MIT
!> Runs the stages of a model: steps, cuts with exact restoration, ledger; an observer sees every step.
module time_stepping
   use warnings, only: print_warning
   use kinds, only: wp
   use wall_clock, only: clock, add_elapsed
   use faults, only: fault_t
   use contact_interfaces, only: stretch_ties
   use contact_setup, only: contacts_act
   use convergence, only: control_t, log_t
   use generalised_alpha, only: scheme_t
   use model_types, only: model_t
   use porous_domain, only: copy_state, take_over
   use effect_indicators, only: indicators_of
   use run_observer, only: run_observer_t, step_report_t
   use run_state, only: run_t
   use sparse_factors, only: release
   use stress_tolerance, only: follow_newton, roughness
   use step_attempt, only: begin_stage, try_step
   use step_size, only: negligible_changes, next_step, scheme_of, keep_step, is_over
   use step_landings, only: LAST_STEP
   use step_booking, only: book_accepted_step
   use energy_alarm, only: check_creation, warn_of_created_energy
   use ground_stages, only: change_ground
   use contact_alarm, only: warn_of_penetration, warn_of_overlap
   use pressure_alarm, only: warn_of_oscillation, warn_lost_pressure, warn_of_inflow, warn_of_dry_ground
   use unknown_fields, only: DISPLACEMENTS
   use water_balance, only: warn_of_missing_water
   use scene_types, only: stage_t
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: run_stages

   integer, parameter :: GOOD_STEPS = 2           !< Accepted steps in a row after which a cut step grows back.
contains
   !> All stages, from where the run stands. docs/theory/host.md section 4. Faults: those of begin_stage, try_step,
   !> check_creation and the observer; the first ends the run, and the observer is still told.
   subroutine run_stages(model, run, fault, observer)
      type(model_t), intent(inout) :: model   !< The laws follow the tolerance of the stages.
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      class(run_observer_t), intent(inout), optional :: observer
      type(fault_t) :: last
      real(wp) :: t0
      integer :: i

      t0 = clock()
      if (present(observer)) call observer%run_begins(model, run, fault)
      if (fault%code /= 0) return
      call add_elapsed(run%seconds_output, t0)
      do i = max(1, run%at%stage), size(model%stages)
         call run_stage(model, i, run, fault, observer)
         if (warns(observer)) call warn_of_created_energy(model%stages(i), run%ledger)
         if (warns(observer) .and. model%domain%full_rate) call warn_of_missing_water(model%stages(i), &
            run%ledger%water, run%ledger%outflow - run%ledger%outflow_air)
         t0 = clock()
         ! Also after a failure, which is reported, not what its last output may meet.
         last = fault_t()
         if (present(observer)) call observer%stage_done(model, run, i, fault%code == 0, last)
         if (fault%code == 0) fault = last
         call add_elapsed(run%seconds_output, t0)
         if (fault%code /= 0) exit
      end do
      last = fault_t()
      if (present(observer)) call observer%run_ends(model, run, last)
      if (fault%code == 0) fault = last
      call release(run%system%sparse)
      run%system%analysed = .false.
   end subroutine run_stages

   subroutine run_stage(model, number, run, fault, observer)
      type(model_t), intent(inout) :: model
      integer, intent(in) :: number
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      class(run_observer_t), intent(inout), optional :: observer
      type(control_t) :: control
      type(log_t) :: log
      real(wp) :: dt
      real(wp) :: stretched(DISPLACEMENTS, size(run%state%x, 2))
      integer :: i
      logical :: accepted, warned

      associate (stage => model%stages(number), at => run%at)
         control = control_t(stage%tolerance, stage%max_iterations, stage%no_predictor, stage%measure)
         warned = .false.
         ! A run that is taken up again is in the middle of its stage.
         call contacts_act(model, stage, run%system%contacts)
         if (at%stage == number) then
            call change_ground(model, number, .false., run, fault)
         else
            if (warns(observer)) call warn_of_overlap(model, number, run%system%contacts, run%state%x)
            call begin_stage(model, number, run, fault)
         end if
         if (fault%code /= 0) return
         do
            if (is_over(stage, run)) exit
            call follow_newton(control%tolerance, model%domain%regions)
            control%roughness = roughness(model%domain%regions)
            control%negligible = negligible_changes(stage, run)
            dt = next_step(model, stage, run)
            call try_step(model, stage, control, dt, run, log, accepted, fault)
            if (fault%code == 0 .and. accepted) then
               if (warns(observer) .and. at%step == 0 .and. allocated(at%sudden)) call warn_of_sudden_loads(stage)
               if (warns(observer)) call warn_stagnation(stage, control, run%next%time, log, warned)
               call close_step(model, number, dt, log, run, fault, observer)
            end if
            if (fault%code == 0 .and. .not. accepted .and. present(observer)) call observer%warn('Stage '// &
               trim(stage%name)//', time '//short(run%state%time)//' s: a step of '//short(dt)//' s is repeated, '// &
               'cuts '//whole(run%cuts), passing=.true.)
            if (fault%code /= 0) return
         end do
         if (stage%zero_displacements) then
            ! Plates with a face of their own, which come last, stay where they are. Ties keep the stretch of their
            ! springs.
            call stretch_ties(run%system%contacts, run%state%x, stretched)
            run%state%x(:DISPLACEMENTS, :size(run%state%x, 2) - size(model%domain%bodies)) = 0.0_wp
            run%state%x(:DISPLACEMENTS, :) = run%state%x(:DISPLACEMENTS, :) + stretched
            do i = 1, size(model%plates)
               if (model%plates(i)%turns .and. model%plates(i)%group > 0) &
                  run%state%x(:DISPLACEMENTS, [model%plates(i)%node, model%plates(i)%turn_node]) = 0.0_wp
            end do
            run%state%v = 0.0_wp
            run%state%a = 0.0_wp
            run%state%s_rate = 0.0_wp
            if (allocated(run%damping_stress)) run%damping_stress = 0.0_wp
         end if
         call copy_state(run%state, run%next)
      end associate
   end subroutine run_stage

   !> Books an accepted step, takes it over and shows it.
   subroutine close_step(model, number, dt, log, run, fault, observer)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number
      real(wp), intent(in) :: dt
      type(log_t), intent(in) :: log
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      class(run_observer_t), intent(inout), optional :: observer
      type(scheme_t) :: scheme
      type(step_report_t) :: report
      real(wp) :: t0
      logical :: checkpoint

      associate (stage => model%stages(number), at => run%at)
         scheme = scheme_of(stage, run, dt)
         at%step = at%step + 1
         run%steps = run%steps + 1
         if (warns(observer)) call warn_of_penetration(model, run%next%time, run%system%contacts)
         if (warns(observer)) call warn_of_oscillation(model, stage, run%next, run%lines, run%told_oscillation)
         if (warns(observer)) call warn_lost_pressure(model, run%next, run%told_pressure)
         if (warns(observer)) call warn_of_inflow(model, stage, run%next%time, run%constraint%drinks, run%told_inflow)
         if (warns(observer)) call warn_of_dry_ground(model, stage, run%next, run%told_dry)
         call book_accepted_step(model, scheme, run)
         report = step_report_t(number, dt, run%control%error, &
                                indicators_of(model, number, dt, run%constraint%mass, run%state, run%next), &
                                at%t_start + stage%duration - run%next%time <= LAST_STEP*dt, log)
         call keep_step(model, stage, dt, run)
         call take_over(run%next, run%state)
         if (.not. stage%controlled) at%nominal = min(at%nominal*stage%dt_growth, max(stage%dt_max, stage%dt))
         at%good = at%good + 1
         if (at%good >= GOOD_STEPS .and. at%factor < 1.0_wp) then
            at%factor = min(1.0_wp, 2*at%factor)
            at%cuts = max(0, at%cuts - 1)
            at%good = 0
         end if
      end associate
      if (present(observer)) then
         t0 = clock()
         call observer%step_done(model, run, report, checkpoint, fault)
         ! A run that is taken up here has no factors and no slopes.
         if (checkpoint) run%system%factored = .false.
         if (checkpoint) run%assembly%slopes%known = .false.
         call add_elapsed(run%seconds_output, t0)
      end if
      call check_creation(model%stages(number), run%state%time, report%last, run%ledger, fault)
   end subroutine close_step

   !> That loads of a stage are applied in another way than the scene says, on standard error, also where the run is
   !> quiet. docs/theory/host.md section 4.4.
   subroutine warn_of_sudden_loads(stage)
      type(stage_t), intent(in) :: stage

      call print_warning('stage '//trim(stage%name)//': its loads act at once and the '// &
         'first step did not converge: they are applied evenly over the stage. A material with a '// &
         'memory may answer otherwise than at once; give the loads a &history to say how they grow.')
   end subroutine warn_of_sudden_loads

   !> After an accepted step whose error stagnated: once a stage, on standard error, also where the run is quiet.
   !> docs/theory/host.md section 5.1. Raises no fault.
   subroutine warn_stagnation(stage, control, time, log, told)
      type(stage_t), intent(in) :: stage
      type(control_t), intent(in) :: control
      real(wp), intent(in) :: time   !< [s]
      type(log_t), intent(in) :: log
      logical, intent(inout) :: told

      if (told .or. .not. log%stagnated) return
      told = .true.
      call print_warning('stage '//trim(stage%name)//', time '//short(time)// &
         ' s: Newton''s method stays at an error of '//short(maxval(log%error))//' and cannot reach its tolerance '// &
         'of '//short(control%tolerance)//', because stresses are integrated to '//short(control%roughness)// &
         '. The step is accepted. Give &stage a tolerance above the error reached, or the material a smaller one.')
   end subroutine warn_stagnation

   !> Whether there is an observer that may print warnings.
   logical function warns(observer)
      class(run_observer_t), intent(in), optional :: observer

      warns = .false.
      if (present(observer)) warns = .not. observer%silent
   end function warns
end module time_stepping
