! SPDX-License-Identifier: MIT
!> Length of the steps of a stage: given, or chosen so that the error that a step makes by itself stays below a
!> tolerance, as an integrator of differential equations does. What the steps leave together is not known to a run.
!> docs/theory/host.md section 4.5.
module step_size
   use kinds, only: wp
   use error_norms, only: shift_rates, restore_rates, local_errors, remember
   use generalised_alpha, only: make_scheme, is_flow
   use run_state, only: run_t, reset_control, BY_TIMES, BY_LARGEST, BY_SMALLEST, BY_GROWTH
   use step_landings, only: next_time, end_of_given, is_break, begins_suddenly, changes_within, closed_contacts, &
                            ends_at_closing, end_where_it_closes, LAST_STEP, SHORTEST, LEAST_SPACINGS
   use step_control, only: new_controller, judge, LARGEST_FACTOR
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: begin_control, negligible_changes, next_step, begin_attempt, judge_step, shorten_step, keep_step, is_over

   !> A step of length dt errs by its third power, n of them by n dt**3: together by the tolerance a where each errs by
   !> a**(3/2), if the change as a whole is as smooth as a step.
   real(wp), parameter :: LOCAL = 1.5_wp
   integer, parameter :: SETTLED = 3              !< Steps after a sudden change until three rates tell of the error.
   real(wp), parameter :: START_UP_STEPS = 10.0_wp !< A change that grows with the square of time is in the first of
                                                  !< so many steps a hundredth of what it is in the last.
   real(wp), parameter :: FIRST = 0.01_wp         !< Largest first step, a share of the span: with the root of time a
                                                  !< tenth of all flows off in it.
   real(wp), parameter :: PLATE_SHARE = 0.01_wp   !< A plate moves the ground by a hundredth of its way at least: until
                                                  !< they meet there is no other change to compare an error with.
   real(wp), parameter :: NEWTON_SHARE = 0.1_wp   !< Share of the error of a step that is left to Newton's method: in a
                                                  !< sum of squares a hundredth.
   real(wp), parameter :: FLOOR = 1.0e-9_wp       !< Share of the largest value of a field that is no change of it: less
                                                  !< than its rounding times the condition of a matrix, 1e-16 times 1e7.
contains
   !> Begins a stage: scales, and the first step where steps are controlled. docs/theory/host.md section 4.5.
   subroutine begin_control(run)
      type(run_t), intent(inout) :: run
      logical :: anew

      associate (c => run%control)
         anew = .not. allocated(c%x_first)
         if (.not. anew) anew = run%model%stages(run%at%stage - 1)%zero_displacements
         if (anew) call reset_control(run)
         c%x_first = run%state%x
         c%touching = closed_contacts(run, run%state%x)
         call sudden(run%state%time, run)
         if (.not. run%stage%controlled) return
         c%controller = new_controller(first_step(run))
         c%start_up = START_UP_STEPS*c%controller%dt
         ! What moves already and meets something errs in the first step as in any later one.
         if (run%stage%has_inertia .and. any(abs(run%state%v(:DISPLACEMENTS, :)) > 0.0_wp)) c%start_up = 0.0_wp
      end associate
   end subroutine begin_control

   !> Chooses the first step: that of the scene, or a share of the span to the first break of what acts.
   real(wp) function first_step(run) result(dt)
      type(run_t), intent(in) :: run
      real(wp) :: span, share

      span = next_time(run, run%stage%duration) - run%state%time
      ! Nothing tells of the error of the first step of a flow: that of the scene may be shorter than what the tolerance
      ! asks for, or the whole stage, not between.
      if (run%stage%dt > 0.0_wp .and. .not. (is_flow(run%stage) .and. run%stage%dt < span)) then
         dt = min(run%stage%dt, run%stage%dt_max)
         return
      end if
      dt = span
      if (run%stage%has_rates .or. (depends_on_path(run) .and. changes_within(run, run%state%time, &
                                                           run%state%time + run%stage%duration))) then
         ! What a load leaves at once flows off with the root of time. Where nothing is sudden a step that short would
         ! drown what it changes in rounding.
         share = run%stage%step_tolerance
         if (is_flow(run%stage)) share = merge(share**2, share, begins_suddenly(run))
         dt = span*min(FIRST, max(share, SHORTEST))
      end if
      if (run%stage%dt > 0.0_wp) dt = min(dt, run%stage%dt)
      dt = min(dt, run%stage%dt_max)
   end function first_step

   !> Whether a material of the model has a memory: its stress is no function of its strain.
   pure logical function depends_on_path(run)
      type(run_t), intent(in) :: run
      integer :: i

      depends_on_path = .not. all([(run%domain%regions(i)%law%has_energy, i=1, size(run%domain%regions))])
   end function depends_on_path

   subroutine sudden(time, run)
      real(wp), intent(in) :: time
      type(run_t), intent(inout) :: run

      run%control%t_sudden = time
      run%control%fresh = 0
      run%control%memory%known = .false.
   end subroutine sudden

   !> Whether a stage has come to its end, up to rounding.
   pure logical function is_over(run)
      type(run_t), intent(in) :: run
      real(wp) :: rounding

      rounding = LAST_STEP*run%at%nominal*run%at%factor
      if (run%stage%controlled) rounding = max(LAST_STEP*SHORTEST*run%stage%duration, 4*spacing(run%state%time))
      is_over = run%at%t_start + run%stage%duration - run%state%time <= rounding
   end function is_over

   !> Chooses the length of the next attempt [s]. docs/theory/host.md sections 4.4 and 4.5.
   real(wp) function next_step(run) result(dt)
      type(run_t), intent(in) :: run
      real(wp) :: left

      dt = run%at%nominal*run%at%factor
      left = run%at%t_start + run%stage%duration - run%state%time
      if (.not. run%stage%controlled) then
         if (allocated(run%stage%ends)) dt = min(left, run%at%factor*(next_end(run) - run%state%time))
         if (left - dt < max(LAST_STEP*left, LEAST_SPACINGS*spacing(run%state%time))) dt = left
         if (.not. allocated(run%stage%ends)) dt = end_of_given(run, run%state%time + dt) - run%state%time
         return
      end if
      dt = min(run%control%controller%dt, run%stage%dt_max)
      left = next_time(run, 2*dt) - run%state%time
      if (dt > left*(1 - LAST_STEP)) then
         dt = left
      else if (2*dt > left) then
         ! Two equal steps rather than a long one and a sliver.
         dt = 0.5_wp*left
      end if
   end function next_step

   !> Finds changes of the pressures in a controlled step that its error hides; 0: none is [m, kPa]. docs/theory/host.md
   !> section 5.1.
   pure function negligible_changes(run) result(changes)
      type(run_t), intent(in) :: run
      real(wp) :: changes(FIELDS)

      changes = 0.0_wp
      if (run%stage%controlled) changes(DISPLACEMENTS + 1:) = NEWTON_SHARE*run%stage%step_tolerance**LOCAL &
                                                          *run%control%scale(DISPLACEMENTS + 1:)
   end function negligible_changes

   !> Finds the next of the times that given steps end at [s].
   pure real(wp) function next_end(run)
      type(run_t), intent(in) :: run

      next_end = run%at%t_start + run%stage%duration
      associate (ends => run%at%t_start + run%stage%ends)
         next_end = min(next_end, minval(ends, mask=ends > run%state%time + LAST_STEP*run%at%nominal))
      end associate
   end function next_end

   !> Sets the scheme of an attempt and, where steps are controlled, moves the rates of the present state to where it
   !> expects them: docs/theory/host.md section 4.5. Where a flow begins the rates before would take a share of what
   !> flows in that step out of the balances: docs/theory/host.md section 4.2.
   subroutine begin_attempt(dt, run)
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(inout) :: run
      logical :: begins

      begins = run%at%step == 0 .or. (run%stage%controlled .and. run%control%fresh == 0)
      run%scheme = make_scheme(run%stage, run%stage%rho_inf, dt, is_flow(run%stage) .and. begins)
      if (run%stage%controlled) call shift_rates(run%scheme, run%control%memory, run%state)
   end subroutine begin_attempt

   !> Decides after a solution whether its error lets it stand; the length of the next attempt follows from it.
   !> docs/theory/host.md section 4.5. Where steps are given every one stands.
   subroutine judge_step(run, accepted)
      type(run_t), intent(inout) :: run
      logical, intent(out) :: accepted
      real(wp) :: error(FIELDS, size(run%state%x, 2)), touching(size(run%control%touching))
      logical :: known(FIELDS), closes

      accepted = .true.
      associate (c => run%control)
         c%error = 0.0_wp
         if (run%stage%controlled) then
            touching = c%touching
            if (run%stage%has_inertia) touching = closed_contacts(run, run%next%x)
            closes = any(touching > c%touching)
            if (closes) accepted = ends_at_closing(run)
            if (.not. accepted) return
            call estimate_error(run, error, known)
            ! What is met before any correction is at rest, or goes on as foreseen: the rest is rounding.
            if (run%log%balanced) error = 0.0_wp
            call weigh_error(error, known, run, accepted)
            if (closes .and. .not. accepted) call end_where_it_closes(run)
            if (.not. accepted) return
            c%touching = touching
            c%located = .false.
         end if
         c%scale = scales(run, size(run%state%x, 2) - size(run%domain%bodies))
      end associate
   end subroutine judge_step

   !> Errors of all unknowns in the step under way, and of which fields they are known.
   subroutine estimate_error(run, error, known)
      type(run_t), intent(in) :: run
      real(wp), intent(out) :: error(:, :)   !< (FIELDS, nodes) [m, kPa]; 0 where not known.
      logical, intent(out) :: known(FIELDS)

      associate (c => run%control)
         if (.not. run%stage%has_rates .and. .not. depends_on_path(run)) then
            ! Without a memory and without a flow the answer does not depend on the steps.
            error = 0.0_wp
            known = .true.
            return
         end if
         call local_errors(run%scheme, c%memory, run%state, run%next, error, known)
         ! Saturated soil holds no air and has no suction: its number follows no balance that holds it, and rings.
         where (run%state%x(AT_P_C, :) < 0.0_wp .and. run%next%x(AT_P_C, :) < 0.0_wp) error(AT_P_C, :) = 0.0_wp
      end associate
   end subroutine estimate_error

   !> Whether the error of a controlled step lets it stand, the length of the next attempt, and what limits it: the
   !> largest error of a field over its largest change, against the local tolerance.
   subroutine weigh_error(error, known, run, accepted)
      real(wp), intent(in) :: error(:, :)    !< (FIELDS, nodes) [m, kPa]
      logical, intent(in) :: known(FIELDS)
      type(run_t), intent(inout) :: run
      logical, intent(out) :: accepted
      real(wp) :: shares(FIELDS), ratio, asked
      integer :: bodies, by

      associate (c => run%control, dt => run%scheme%dt)
         bodies = size(run%state%x, 2) - size(run%domain%bodies)
         shares = field_norms(error(:, :bodies))
         shares(:DISPLACEMENTS) = max(shares(:DISPLACEMENTS), maxval(abs(error(:DISPLACEMENTS, bodies + 1:))))
         shares = shares/scales(run, bodies)
         c%error = maxval(shares, mask=known)
         ratio = -1.0_wp
         if (any(known)) ratio = c%error/(run%stage%step_tolerance**LOCAL &
                                          *max(1.0_wp, c%start_up/(run%next%time - c%t_sudden))**2)
         c%error = max(c%error, 0.0_wp)
         asked = c%controller%dt
         if (dt <= SHORTEST*run%stage%duration) ratio = min(ratio, 1.0_wp)
         call judge(c%controller, dt, ratio, accepted)
         c%controller%dt = max(c%controller%dt, SHORTEST*run%stage%duration)
         if (.not. accepted) then
            c%rejected = c%rejected + 1
            return
         end if
         if (.not. any(known)) c%controller%dt = asked
         by = maxloc([maxval(shares(:DISPLACEMENTS)), shares(AT_P_W), shares(AT_P_C)], 1)
         if (c%controller%dt > asked .or. ratio < 0.0_wp) by = BY_GROWTH
         if (dt <= SHORTEST*run%stage%duration) by = BY_SMALLEST
         if (dt < asked*(1 - LAST_STEP)) by = BY_TIMES
         if (dt >= run%stage%dt_max) by = BY_LARGEST
         c%limits(by) = c%limits(by) + 1
      end associate
   end subroutine weigh_error

   !> Takes the root mean square over the nodes; displacements count as one field.
   pure function field_norms(values) result(norms)
      real(wp), intent(in) :: values(:, :)   !< (FIELDS, nodes)
      real(wp) :: norms(FIELDS)

      norms = sum(values**2, dim=2)
      norms(:DISPLACEMENTS) = sum(values(:DISPLACEMENTS, :)**2)
      norms = sqrt(norms/max(1, size(values, 2)))
   end function field_norms

   !> Finds the largest changes of the fields, that of the step under way among them; not below a share of their values.
   pure function scales(run, bodies) result(s)
      type(run_t), intent(in) :: run
      integer, intent(in) :: bodies
      real(wp) :: s(FIELDS)

      associate (c => run%control)
         s = max(c%scale, field_norms(run%next%x(:, :bodies) - c%x_first(:, :bodies)), &
                 FLOOR*field_norms(run%next%x(:, :bodies)), tiny(1.0_wp)**0.25_wp)
         s(:DISPLACEMENTS) = max(s(:DISPLACEMENTS), PLATE_SHARE*maxval(abs( &
            run%next%x(:DISPLACEMENTS, bodies + 1:) - c%x_first(:DISPLACEMENTS, bodies + 1:))))
      end associate
   end function scales

   !> Shortens the step after an attempt that failed: the share of it that is tried next becomes the step.
   !> docs/theory/host.md section 4.4; nothing where steps are given.
   subroutine shorten_step(run)
      type(run_t), intent(inout) :: run

      if (.not. run%stage%controlled) return
      run%control%controller%dt = run%scheme%dt*run%at%factor
      run%control%controller%held = .true.
      call restore_rates(run%control%memory, run%state)
      ! The rate of a static step before holds still; a flow may have failed where something begins.
      if (run%stage%has_rates) run%control%memory%known = .false.
      run%at%factor = 1.0_wp
      run%at%nominal = run%control%controller%dt
   end subroutine shorten_step

   !> Keeps, of an accepted step that is not yet taken over, rates for the next estimate, and what ends with the step.
   !> docs/theory/host.md section 4.5. Where steps are given their length does not follow.
   subroutine keep_step(run)
      type(run_t), intent(inout) :: run
      logical :: breaks

      if (.not. run%stage%controlled) return
      breaks = .not. run%stage%has_inertia .and. is_break(run)
      associate (c => run%control, dt => run%scheme%dt, stage => run%stage)
         call remember(run%scheme, c%memory, run%state, run%next)
         c%fresh = c%fresh + 1
         ! A first static step may have taken at once what acts from the start: its rate is none.
         if (c%fresh < merge(2, SETTLED, .not. stage%has_rates)) c%memory%known = .false.
         run%at%cuts = max(0, run%at%cuts - 1)
         if (breaks) then
            call sudden(run%next%time, run)
            c%controller%dt = min(c%controller%dt, max(dt*stage%step_tolerance, SHORTEST*stage%duration*LARGEST_FACTOR))
            c%start_up = START_UP_STEPS*c%controller%dt
         end if
         run%at%nominal = c%controller%dt
      end associate
   end subroutine keep_step
end module step_size
