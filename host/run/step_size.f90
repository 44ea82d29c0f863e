! SPDX-License-Identifier: MIT
!> Length of the steps of a stage: given, or chosen from the error of each step so that what the steps leave in all
!> stays below the accuracy asked for. The errors of given steps are estimated too. docs/theory/host.md section 4.5.
module step_size
   use kinds, only: wp
   use contact_interfaces, only: probe_contacts
   use control_state, only: new_control_state, BY_TIMES, BY_LARGEST, BY_SMALLEST, BY_GROWTH
   use error_norms, only: bent_share, keep_rates, shift_rates, local_errors, remember, forget, kept_of_motion, &
                          alternating_part, rms
   use generalised_alpha, only: scheme_t, make_scheme, STATIC, QUASI_STATIC, DYNAMIC
   use model_types, only: model_t
   use run_state, only: run_t
   use step_landings, only: next_time, end_of_given, is_break, begins_suddenly, changes_within, LAST_STEP, SHORTEST
   use step_control, only: new_controller, judge, LARGEST_FACTOR, MOST_REJECTIONS
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_U_R, AT_U_Z, AT_P_W, AT_P_C
   use scene_types, only: stage_t
   implicit none (type, external)
   private
   public :: begin_control, next_step, prepare_rates, judge_step, bend_of_step, shorten_step, keep_step, is_over

   integer, parameter :: SETTLED = 3              !< Steps after a sudden change until rates tell of the error again.
   real(wp), parameter :: START_UP_STEPS = 10.0_wp !< First steps in which changes are expected to grow yet.
   real(wp), parameter :: FIRST_SHARE = 0.04_wp   !< Of the span to the first break, times the root of the accuracy.
   real(wp), parameter :: FIRST_STATIC = 0.05_wp  !< Largest share of that span that a first static step takes.
   real(wp), parameter :: EVENT = 0.015_wp        !< Least share of what is left that a step may take: an impact or a
                                                  !< change of contact is not resolved for its own sake.
   real(wp), parameter :: GROWTH = 0.5_wp         !< Of the accuracy: of what it adds to the scale a step may err by.
   real(wp), parameter :: RESERVE = 0.1_wp        !< Share of the accuracy that is left when it has been used up.
   real(wp), parameter :: PRESSURE_SHARE = 0.3_wp !< The same of pressures in dynamic stages, of the accuracy: they
                                                  !< follow every impact and fade; three such steps use it up.
   real(wp), parameter :: PRESSURE_BUDGET = 2.0_wp   !< Times the accuracy that impacts may leave at a point in all.
   real(wp), parameter :: PRESSURE_RESERVE = 0.2_wp  !< Share that a step is allowed when they have left that.
   real(wp), parameter :: PRESSURE_END = 2.95_wp     !< Times the accuracy at which that share ends, below 3.
   real(wp), parameter :: LEAST_RESERVE = 0.1_wp  !< Part of that share that stays.
   real(wp), parameter :: PEAK = 1.57_wp          !< Of a sine over the mean of its magnitude.
   real(wp), parameter :: ROOT_SHARE = 0.25_wp    !< Share of its change by which the second step after a sudden load
                                                  !< is in error, since flow begins with the root of time.
   real(wp), parameter :: FIRST_TWO = 0.5_wp      !< The same of given steps, for the first two together.
   real(wp), parameter :: PLATE_SHARE = 0.01_wp   !< Of the way of a plate, as a least scale of the soil's.
   real(wp), parameter :: NAMED_SHARE = 0.01_wp   !< Of the change of its field, as a least change of a named answer.
   integer, parameter :: LANDING_REJECTIONS = 15  !< In a row, of a step with contacts that are not at the start.
   integer, parameter :: BISECTIONS = 40          !< Of the time at which a contact closes.
   real(wp), parameter :: FLOOR = 1.0e-9_wp       !< Share of the largest value of a field that is no change of it.
contains
   !> A stage begins: scales, and the first step where steps are controlled. docs/theory/host.md section 4.5.
   subroutine begin_control(model, stage, run)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(inout) :: run
      integer :: rejected

      associate (c => run%control)
         if (.not. allocated(c%x_first)) then
            c = new_control_state(size(run%state%x, 2), size(run%state%s_rate), size(model%points), &
                                  size(model%contacts))
         else if (model%stages(run%at%stage - 1)%zero_displacements) then
            ! Displacements count anew: what was seen of them is of no answer.
            rejected = c%rejected
            c = new_control_state(size(run%state%x, 2), size(run%state%s_rate), size(model%points), &
                                  size(model%contacts))
            c%rejected = rejected
         end if
         c%x_first = run%state%x
         c%damped_0 = run%ledger%damping
         c%motion = 0.0_wp
         c%touching = closed_contacts(run, run%state%x)
         call sudden(run%state%time, run)
         if (.not. stage%controlled) return
         c%controller = new_controller(first_step(model, stage, run))
         c%start_up = START_UP_STEPS*c%controller%dt
         ! What moves already and meets something errs in the first step as in any later one.
         if (stage%kind == DYNAMIC .and. any(abs(run%state%v(:DISPLACEMENTS, :)) > 0.0_wp)) c%start_up = 0.0_wp
      end associate
   end subroutine begin_control

   !> First step: that of the scene, or a share of the span to the first break of what acts.
   real(wp) function first_step(model, stage, run) result(dt)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      real(wp) :: span

      span = next_time(model, stage, run, stage%duration) - run%state%time
      ! Nothing tells of the error of the first step of a flow: that of the scene may be shorter than what the accuracy
      ! asks for, or the whole stage, not between.
      if (stage%dt > 0.0_wp .and. .not. (stage%kind == QUASI_STATIC .and. stage%dt < span)) then
         dt = min(stage%dt, stage%dt_max)
         return
      end if
      select case (stage%kind)
      case (STATIC)
         ! The answer of a material with a memory depends on the way there; nothing tells of the error of a single step.
         dt = span
         if (depends_on_path(model) .and. changes_within(model, run%state%time, run%state%time + stage%duration)) &
            dt = span*min(FIRST_STATIC, max(stage%accuracy, SHORTEST))
      case (QUASI_STATIC)
         ! What a load leaves at once flows off with the root of time. Where nothing is sudden a step that short would
         ! drown what it changes in rounding.
         dt = span*min(0.01_wp, max(merge(stage%accuracy**2, stage%accuracy, begins_suddenly(model, run)), SHORTEST))
      case default
         ! Nothing is there yet to compare its error with, and what it leaves is carried on by the soil's memory.
         dt = span*FIRST_SHARE*sqrt(stage%accuracy)
      end select
      if (stage%dt > 0.0_wp) dt = min(dt, stage%dt)
      dt = min(dt, stage%dt_max)
   end function first_step

   !> Whether a material of the model has a memory: its stress is no function of its strain.
   pure logical function depends_on_path(model)
      type(model_t), intent(in) :: model
      integer :: i

      depends_on_path = .false.
      do i = 1, size(model%domain%regions)
         depends_on_path = depends_on_path .or. .not. model%domain%regions(i)%law%has_energy
      end do
   end function depends_on_path

   subroutine sudden(time, run)
      real(wp), intent(in) :: time
      type(run_t), intent(inout) :: run

      run%control%t_sudden = time
      run%control%fresh = 0
      call forget(run%control%memory)
   end subroutine sudden

   !> Whether a stage has come to its end. Up to rounding.
   pure logical function is_over(stage, run)
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run

      is_over = is_over_at(stage, run, run%state%time)
   end function is_over

   pure logical function is_over_at(stage, run, time)
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: time   !< [s]
      real(wp) :: rounding

      rounding = LAST_STEP*run%at%nominal*run%at%factor
      if (stage%controlled) rounding = max(LAST_STEP*SHORTEST*stage%duration, 4*spacing(time))
      is_over_at = run%at%t_start + stage%duration - time <= rounding
   end function is_over_at

   !> Length of the next attempt [s]. docs/theory/host.md sections 4.4 and 4.5.
   real(wp) function next_step(model, stage, run) result(dt)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      real(wp) :: left

      dt = run%at%nominal*run%at%factor
      left = run%at%t_start + stage%duration - run%state%time
      if (.not. stage%controlled) then
         if (allocated(stage%ends)) dt = min(left, run%at%factor*(next_end(stage, run) - run%state%time))
         if (dt > left*(1 - LAST_STEP)) dt = left
         if (.not. allocated(stage%ends)) dt = end_of_given(model, stage, run%state%time, run%state%time + dt) &
                                               - run%state%time
         return
      end if
      dt = min(run%control%controller%dt, stage%dt_max)
      left = next_time(model, stage, run, 2*dt) - run%state%time
      if (dt > left*(1 - LAST_STEP)) then
         dt = left
      else if (2*dt > left) then
         ! Two equal steps rather than a long one and a sliver.
         dt = 0.5_wp*left
      end if
   end function next_step

   !> The next of the times that the steps of a pilot end at [s].
   pure real(wp) function next_end(stage, run)
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run

      next_end = run%at%t_start + stage%duration
      associate (ends => run%at%t_start + stage%ends)
         next_end = min(next_end, minval(ends, mask=ends > run%state%time + LAST_STEP*run%at%nominal))
      end associate
   end function next_end

   !> Before an attempt: rates of the present state where the step expects them. docs/theory/host.md section 4.5; where
   !> steps are given they stay.
   subroutine prepare_rates(stage, dt, run)
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(inout) :: run

      if (.not. stage%controlled) then
         run%control%memory%moves = .false.
         call keep_rates(run%control%memory, run%state%v, run%state%s_rate)
         return
      end if
      call shift_rates(make_scheme(stage%kind, stage%rho_inf, dt), run%control%memory, run%state%v, &
                       run%state%s_rate)
   end subroutine prepare_rates

   !> After a solution: whether its error lets it stand; the length of the next attempt follows from it.
   !> docs/theory/host.md section 4.5. Where steps are given every one stands, and its error is added up.
   subroutine judge_step(model, stage, dt, foreseen, run, accepted)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      logical, intent(in) :: foreseen   !< The balances were met within rounding before any correction.
      type(run_t), intent(inout) :: run
      logical, intent(out) :: accepted
      real(wp), dimension(FIELDS, size(run%state%x, 2)) :: error, all, ripple
      real(wp) :: norm(FIELDS), elapsed
      real(wp), allocatable :: touching(:)
      logical :: known(FIELDS), changes
      integer :: bodies

      call estimate_error(model, stage, dt, run, error, known)
      bodies = size(run%state%x, 2) - size(model%domain%bodies)
      ! What is met before any correction is at rest, or goes on as foreseen: the rest is rounding, whatever the step.
      if (stage%controlled .and. foreseen) error = 0.0_wp
      elapsed = run%next%time - run%control%t_sudden
      allocate (touching, source=run%control%touching)
      if (stage%kind == DYNAMIC) touching = closed_contacts(run, run%next%x)
      changes = any(abs(touching - run%control%touching) > 0.5_wp)
      all = error
      call take_ripple_out(stage, dt, changes, run, error, ripple)
      norm = field_norms(error(:, :bodies))
      accepted = .true.
      if (stage%controlled .and. any(touching > run%control%touching)) accepted = ends_at_closing(stage, dt, run)
      if (.not. accepted) return
      if (stage%controlled) call weigh_error(model, stage, dt, elapsed, error, ripple, norm, known, changes, &
                                              run, accepted)
      if (.not. accepted) then
         if (any(touching > run%control%touching)) call end_where_it_closes(dt, run)
         return
      end if
      run%control%touching = touching
      run%control%located = .false.
      associate (c => run%control, change => field_norms(run%next%x(:, :bodies) - run%state%x(:, :bodies)))
         if (.not. (known(AT_U_R) .or. stage%kind == QUASI_STATIC .and. c%fresh == 1) .and. depends_on_path(model)) &
            c%unseen(:DISPLACEMENTS) = c%unseen(:DISPLACEMENTS) + change(:DISPLACEMENTS)
         ! Where a flow is at rest at the end of its only step it is right, and else it is not: nothing tells.
         if (stage%kind == QUASI_STATIC .and. c%fresh == 0 .and. is_over_at(stage, run, run%next%time)) &
            c%unseen(DISPLACEMENTS + 1:) = c%unseen(DISPLACEMENTS + 1:) + change(DISPLACEMENTS + 1:)
      end associate
      call gather(model, stage, error, ripple, norm, elapsed - dt, elapsed, run)
      run%control%error_before = all
   end subroutine judge_step

   !> Parts the errors of a step of a motion: what they have in common with those of the step before, and what
   !> alternates with them. That are waves too fast for the steps: they are wrong by two amplitudes at most, however
   !> long they last. docs/theory/host.md section 4.5.
   pure subroutine take_ripple_out(stage, dt, changes, run, error, ripple)
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      logical, intent(in) :: changes   !< A contact closes or opens in the step: an event, and no wave.
      type(run_t), intent(in) :: run
      real(wp), intent(inout) :: error(:, :)   !< (FIELDS, nodes) of the step; what lasts of it [m, kPa].
      real(wp), intent(out) :: ripple(:, :)    !< (FIELDS, nodes) what alternates [m, kPa].
      real(wp) :: longer

      ripple = 0.0_wp
      associate (c => run%control)
         if (stage%kind /= DYNAMIC .or. changes .or. c%fresh == 0 .or. .not. c%memory%dt > 0.0_wp) return
         ! The same jump of accelerations errs by the square of the step, one of rates by the step.
         longer = dt/c%memory%dt
         ripple(:DISPLACEMENTS, :) = alternating_part(error(:DISPLACEMENTS, :), &
                                                       longer**2*c%error_before(:DISPLACEMENTS, :))
         if (c%memory%known) &
            ripple(DISPLACEMENTS + 1:, :) = alternating_part(error(DISPLACEMENTS + 1:, :), &
                                                             longer*c%error_before(DISPLACEMENTS + 1:, :))
      end associate
      error = error - ripple
   end subroutine take_ripple_out

   !> 1 for every contact that is closed at given displacements, else 0; 0 too where a kernel refuses them.
   function closed_contacts(run, x) result(closed)
      type(run_t), intent(inout) :: run
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) [m]
      real(wp) :: closed(size(run%control%touching))
      integer :: i

      closed = 0.0_wp
      if (size(closed) == 0) return
      if (.not. probe_contacts(run%system%contacts, x)) return
      do i = 1, size(closed)
         associate (t => run%system%contacts%interfaces(i))
            if (t%acts) closed(i) = merge(1.0_wp, 0.0_wp, any(t%probe%active))
         end associate
      end do
   end function closed_contacts

   !> Whether a step in which a contact closes ends there, or has been repeated so that it should. If not, the next
   !> attempt does: what meets within a step leaves no error of its own size in it, since it is hardly stopped.
   logical function ends_at_closing(stage, dt, run) result(ends)
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< That was tried [s].
      type(run_t), intent(inout) :: run

      associate (c => run%control)
         ends = c%located .or. dt <= SHORTEST*stage%duration
         if (ends) return
         call end_where_it_closes(dt, run)
         ends = c%controller%dt >= dt*(1 - LAST_STEP)
         c%located = .not. ends
         if (.not. ends) c%rejected = c%rejected + 1
      end associate
   end function ends_at_closing

   !> The next attempt ends where a contact closes, if that is shorter than what its error asks for. The time is looked
   !> for along the motion that keeps its accelerations: exact for bodies in free flight. Where that motion closes none
   !> the step stays as its error asks for.
   subroutine end_where_it_closes(dt, run)
      real(wp), intent(in) :: dt   !< That was tried [s].
      type(run_t), intent(inout) :: run
      real(wp) :: open, shut, middle
      integer :: i

      open = 0.0_wp
      shut = dt
      if (.not. closes_after(shut)) return
      do i = 1, BISECTIONS
         middle = 0.5_wp*(open + shut)
         if (closes_after(middle)) then
            shut = middle
         else
            open = middle
         end if
      end do
      ! Much nearer than what the error asks for: such a step may hold the closing as well.
      associate (dt_next => run%control%controller%dt)
         if (shut > EVENT*dt_next) dt_next = min(dt_next, shut)
      end associate
   contains
      logical function closes_after(time)
         real(wp), intent(in) :: time   !< [s]
         real(wp) :: x(FIELDS, size(run%state%x, 2))

         x = run%state%x + time*run%state%v
         x(:DISPLACEMENTS, :) = x(:DISPLACEMENTS, :) + 0.5_wp*time**2*run%state%a
         closes_after = any(closed_contacts(run, x) > run%control%touching)
      end function closes_after
   end subroutine end_where_it_closes

   !> Errors of all unknowns in the step under way, and of which fields they are known.
   subroutine estimate_error(model, stage, dt, run, error, known)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(in) :: run
      real(wp), intent(out) :: error(:, :)   !< (FIELDS, nodes) [m, kPa]; 0 where not known.
      logical, intent(out) :: known(FIELDS)
      integer :: kind

      associate (c => run%control)
         kind = kind_of_error(model, stage)
         call local_errors(make_scheme(kind, stage%rho_inf, dt), c%memory, run%state%x, run%state%v, run%state%a, &
                           run%next%x, run%next%v, run%next%a, error, known)
         if (kind == DYNAMIC) error = PEAK*error
         if (kind == QUASI_STATIC .and. c%fresh == 1) then
            if (stage%controlled) then
               error = ROOT_SHARE*begun_with_root(dt, run)
            else
               ! Given steps need not be short here: what the first one left is told by the second.
               error = FIRST_TWO*(run%next%x - run%state%x)
            end if
         end if
         if (stage%controlled .or. kind /= STATIC .or. depends_on_path(model)) return
         ! Without a memory and without a flow the answer does not depend on the steps.
         error = 0.0_wp
         known = .true.
      end associate
   end subroutine estimate_error

   !> Of the changes in the second of two equal steps since a sudden change: those of a flow that begins with the root
   !> of time. Of such a flow the steps change by D and (sqrt(2) - 1) D, so that the rate falls in the second by sqrt(2)
   !> times what it adds. What goes on as in the first step, as under a load that begins to grow, is none.
   !> docs/theory/host.md section 4.5.
   pure function begun_with_root(dt, run) result(change)
      real(wp), intent(in) :: dt   !< Of the second step [s].
      type(run_t), intent(in) :: run
      real(wp) :: change(FIELDS, size(run%state%x, 2))   !< [m, kPa]
      real(wp) :: norms(FIELDS), turns(FIELDS)
      integer :: f

      change = run%next%x - run%state%x
      norms = field_norms(change)
      turns = field_norms(dt*(run%next%v - run%state%v))/sqrt(2.0_wp)
      do f = 1, FIELDS
         if (turns(f) < norms(f)) change(f, :) = change(f, :)*turns(f)/norms(f)
      end do
   end function begun_with_root

   !> Share by which the rate of the unknowns changes in a static step that is accepted and not yet kept; 0 where it is
   !> not known, and where the answer does not depend on the steps [-].
   pure real(wp) function bend_of_step(model, stage, dt, run) result(bend)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(in) :: run

      bend = 0.0_wp
      if (stage%kind == STATIC .and. depends_on_path(model)) &
         bend = bent_share(run%control%memory, dt, run%state%x, run%next%x)
   end function bend_of_step

   !> Whose errors the steps of a stage make: a quasi-static stage without pressures is static. Controlled steps of it
   !> are chosen as those of a flow all the same.
   pure integer function kind_of_error(model, stage) result(kind)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage

      kind = stage%kind
      if (kind == QUASI_STATIC .and. .not. stage%controlled .and. .not. any(model%dofs%field > DISPLACEMENTS)) &
         kind = STATIC
   end function kind_of_error

   !> Whether the error of a controlled step lets it stand, the length of the next attempt, and what limits it.
   subroutine weigh_error(model, stage, dt, elapsed, error, ripple, norm, known, changes, run, accepted)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt, elapsed    !< Step, and the time since the last sudden change at its end [s].
      real(wp), intent(in) :: error(:, :)    !< (FIELDS, nodes) [m, kPa]
      real(wp), intent(in) :: ripple(:, :)   !< (FIELDS, nodes) what alternates [m, kPa]
      real(wp), intent(in) :: norm(FIELDS)   !< Of the errors [m, kPa].
      logical, intent(in) :: known(FIELDS)
      logical, intent(in) :: changes         !< A contact closes or opens in the step.
      type(run_t), intent(inout) :: run
      logical, intent(out) :: accepted
      real(wp) :: share(FIELDS), ratios(FIELDS), allowed(FIELDS), ratio, asked, left
      integer :: bodies, by

      associate (c => run%control)
         bodies = size(run%state%x, 2) - size(model%domain%bodies)
         share = max(dt/elapsed, EVENT)
         left = 1.0_wp
         if (stage%kind == DYNAMIC) then
            left = what_is_left(model, stage, run)
            share(:DISPLACEMENTS) = max(left*dt/(run%at%t_start + stage%duration - run%state%time), EVENT*left**2)
            ! Pressures follow every knock of a contact; such errors do not add up.
            share(DISPLACEMENTS + 1:) = max(dt/elapsed, PRESSURE_SHARE)
         end if
         allowed = share
         ! Early errors are small beside what displacements grow to.
         if (stage%kind == DYNAMIC) allowed(:DISPLACEMENTS) = max(allowed(:DISPLACEMENTS), &
                                                                  GROWTH*added_share(run, bodies))
         ratios = norm/(allowed*scales(run, bodies))
         ratios = max(ratios, ratios_of_points(model, stage, run, error, share, dt/elapsed, bodies))
         if (stage%kind == DYNAMIC) then
            ! Ripples last, but do not add up: the whole accuracy is theirs.
            share = 1.0_wp
            share(:DISPLACEMENTS) = left
            ratios = max(ratios, field_norms(ripple(:, :bodies))/(share*scales(run, bodies)))
            ratios = max(ratios, ratios_of_points(model, stage, run, ripple, share, 1.0_wp, bodies))
         end if
         if (stage%kind == DYNAMIC) ratios(AT_U_Z) = max(ratios(AT_U_Z), ratio_of_plates(model, stage, dt, run, error, &
            changes)/allowed(AT_U_Z))
         ratios = ratios/(stage%accuracy*max(1.0_wp, c%start_up/elapsed)**2)
         ratio = maxval(ratios, mask=known)
         if (.not. any(known)) ratio = -1.0_wp
         asked = c%controller%dt
         if (dt <= SHORTEST*stage%duration) ratio = min(ratio, 1.0_wp)
         ! A start from rest gives nothing to compare with; a landing does.
         c%controller%most_rejections = merge(LANDING_REJECTIONS, MOST_REJECTIONS, changes .or. &
            stage%kind == DYNAMIC .and. size(model%contacts) > 0 .and. c%fresh >= SETTLED)
         call judge(c%controller, dt, ratio, accepted)
         c%controller%dt = max(c%controller%dt, SHORTEST*stage%duration)
         if (.not. accepted) then
            c%rejected = c%rejected + 1
            return
         end if
         if (.not. any(known)) c%controller%dt = asked
         if (dt < asked*(1 - LAST_STEP) .and. dt < stage%dt_max) then
            by = BY_TIMES
         else if (dt >= stage%dt_max) then
            by = BY_LARGEST
         else if (dt <= SHORTEST*stage%duration) then
            by = BY_SMALLEST
         else if (c%controller%dt > asked .or. ratio < 0.0_wp) then
            by = BY_GROWTH
         else
            by = maxloc([maxval(ratios(:DISPLACEMENTS)), ratios(AT_P_W), ratios(AT_P_C)], 1)
         end if
         c%limits(by) = c%limits(by) + 1
      end associate
   end subroutine weigh_error

   !> Errors at the named points over what is allowed of their own changes, the worst of every field; 1: allowed is the
   !> whole change. No less is asked for than that of a point that changes by a share of its field.
   pure function ratios_of_points(model, stage, run, error, share, fading, bodies) result(ratios)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: error(:, :), share(:)   !< (FIELDS, nodes) [m, kPa]; (FIELDS) of the accuracy.
      real(wp), intent(in) :: fading   !< Share of earlier errors of pressures that fades in the step [-].
      integer, intent(in) :: bodies
      real(wp) :: ratios(FIELDS), before(FIELDS), now(FIELDS), least(FIELDS), allowed
      integer :: i, f

      ratios = 0.0_wp
      least = NAMED_SHARE*scales(run, bodies)
      associate (c => run%control)
         do i = 1, size(model%points)
            associate (x => run%next%x(:, model%points(i)%node), x0 => run%state%x(:, model%points(i)%node), &
                       e => abs(error(:, model%points(i)%node)))
               before = max(ranges(c%low(:, i), c%high(:, i)), least)
               now = max(ranges(min(c%low(:, i), x0, x), max(c%high(:, i), x0, x)), least)
               do f = 1, FIELDS
                  allowed = share(f)
                  if (stage%kind == DYNAMIC) then
                     if (f > DISPLACEMENTS) then
                        allowed = max(fading, allowed*pressure_left((abs(c%point_gathered(f, i)) &
                                                     + c%point_ripple(f, i))/(stage%accuracy*now(f))))
                     else
                        allowed = max(allowed, GROWTH*(1 - before(f)/now(f)))
                     end if
                  end if
                  ratios(f) = max(ratios(f), e(f)/(allowed*now(f)))
               end do
            end associate
         end do
      end associate
   end function ratios_of_points

   !> What impacts that have left errors of a pressure, `used` times the accuracy, leave to a step: less as they use the
   !> budget up, then a reserve, and a tenth of it where the promise of the accuracy is broken: what has been left is
   !> not taken back by steps however short, and the run tells of it at its end.
   pure real(wp) function pressure_left(used) result(left)
      real(wp), intent(in) :: used   !< [-]

      left = max(1 - used/PRESSURE_BUDGET, PRESSURE_RESERVE*min(1.0_wp, max(LEAST_RESERVE, 10*(PRESSURE_END - used))))
   end function pressure_left

   !> Changes of the fields at a point; of a displacement the larger one of its components. 0 before the first step.
   pure function ranges(low, high)
      real(wp), intent(in) :: low(:), high(:)   !< (FIELDS) smallest and largest values [m, kPa].
      real(wp) :: ranges(FIELDS)

      ranges = 0.0_wp
      where (high > low) ranges = high - low
      ranges(:DISPLACEMENTS) = maxval(ranges(:DISPLACEMENTS))
   end function ranges

   !> Error of the way of the plates over the scale of the displacements. Where a plate has met the ground its vibration
   !> on the penalty is no answer: what the stiffness of the penalty takes of the error in a step is left out, but in
   !> the step in which it meets or leaves the ground.
   pure real(wp) function ratio_of_plates(model, stage, dt, run, error, changes) result(ratio)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: error(:, :)   !< (FIELDS, nodes) [m, kPa]
      logical, intent(in) :: changes
      type(scheme_t) :: scheme
      real(wp) :: scale(FIELDS), way
      integer :: i, bodies

      ratio = 0.0_wp
      bodies = size(run%state%x, 2) - size(model%domain%bodies)
      scheme = make_scheme(stage%kind, stage%rho_inf, dt)
      scale = scales(run, bodies)
      way = max(scale(AT_U_Z), maxval(abs(run%next%x(AT_U_Z, :bodies) - run%control%x_first(AT_U_Z, :bodies))))
      do i = 1, size(model%plates)
         if (model%plates(i)%node <= bodies) cycle
         associate (plate => model%plates(i))
            ratio = max(ratio, abs(error(AT_U_Z, plate%node))/(way*softened(plate%node, plate%mass, .not. changes)))
            if (.not. plate%turns) cycle
            ! A face that turns about its middle presses as a third of its area at its ends does.
            ratio = max(ratio, abs(error(AT_U_R, plate%node))/(way*softened(plate%node, plate%mass, .false.)), &
                        abs(error(AT_U_Z, plate%turn_node))/(way*softened(plate%node, 3*plate%inertia/plate%lever**2, &
                                                                                  .not. changes)))
         end associate
      end do
   contains
      !> What the springs of a tie, and if they count the penalties of contacts, divide the error of a step by.
      pure real(wp) function softened(node, mass, with_penalties)
         integer, intent(in) :: node      !< Of the plate.
         real(wp), intent(in) :: mass     !< [Mg]
         logical, intent(in) :: with_penalties
         real(wp) :: stiffness
         integer :: k

         softened = 1.0_wp
         if (.not. mass > 0.0_wp .or. .not. allocated(run%system%contacts%interfaces)) return
         do k = 1, size(run%system%contacts%interfaces)
            associate (t => run%system%contacts%interfaces(k))
               if (.not. t%acts .or. t%plate%node /= node) cycle
               if (allocated(t%spring)) then
                  stiffness = sum(t%spring)
               else
                  if (.not. with_penalties) cycle
                  stiffness = model%contacts(k)%options%penalty*t%area
               end if
               softened = softened*(1 + scheme%l_f/scheme%c_a*stiffness/mass)
            end associate
         end do
      end function softened
   end function ratio_of_plates

   !> Errors of displacements without a flow stay and add up. So what the steps so far have left of the accuracy is
   !> spread over the stages to come, and in a stage over its time: share of the accuracy for this stage's rest.
   pure real(wp) function what_is_left(model, stage, run) result(left)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      real(wp) :: used, change(FIELDS)
      integer :: i

      associate (c => run%control)
         used = 0.0_wp
         do i = 1, size(model%points)
            change = max(ranges(c%low(:, i), c%high(:, i)), NAMED_SHARE*c%scale, tiny(1.0_wp))
            used = max(used, maxval(abs(c%point_gathered(:DISPLACEMENTS, i))/change(:DISPLACEMENTS)))
         end do
         if (.not. used > 0.0_wp) used = maxval(c%gathered(:DISPLACEMENTS)/max(c%scale(:DISPLACEMENTS), tiny(1.0_wp)))
      end associate
      left = max(1.0_wp - used/stage%accuracy, RESERVE)
   end function what_is_left

   !> What the step under way adds to the scale of the displacements, as a share of it.
   pure real(wp) function added_share(run, bodies) result(share)
      type(run_t), intent(in) :: run
      integer, intent(in) :: bodies
      real(wp) :: now(FIELDS)

      now = scales(run, bodies)
      share = maxval(1 - run%control%scale(:DISPLACEMENTS)/now(:DISPLACEMENTS))
   end function added_share

   !> Displacements count as one field.
   pure function field_norms(values) result(norms)
      real(wp), intent(in) :: values(:, :)
      real(wp) :: norms(FIELDS)

      norms(:DISPLACEMENTS) = rms(values(:DISPLACEMENTS, :))
      norms(AT_P_W) = rms(values(AT_P_W:AT_P_W, :))
      norms(AT_P_C) = rms(values(AT_P_C:AT_P_C, :))
   end function field_norms

   !> Largest changes of the fields, that of the step under way among them; not below a share of their values.
   pure function scales(run, bodies) result(s)
      type(run_t), intent(in) :: run
      integer, intent(in) :: bodies
      real(wp) :: s(FIELDS)

      associate (c => run%control)
         s = max(c%scale, field_norms(run%next%x(:, :bodies) - c%x_first(:, :bodies)), &
                 FLOOR*field_norms(run%next%x(:, :bodies)), tiny(1.0_wp)**0.25_wp)
         ! What a falling plate has yet to do to the soil is of the size of its own way.
         if (size(run%next%x, 2) > bodies) s(:DISPLACEMENTS) = max(s(:DISPLACEMENTS), &
            PLATE_SHARE*maxval(abs(run%next%x(:DISPLACEMENTS, bodies + 1:) - c%x_first(:DISPLACEMENTS, bodies + 1:))))
      end associate
   end function scales

   !> Adds the errors of an accepted step up: those of a flow fade as its memory does, in proportion to the time since
   !> the last sudden change; those of a vibration or of a path stay.
   subroutine gather(model, stage, error, ripple, norm, before, after, run)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: error(:, :), ripple(:, :)   !< (FIELDS, nodes) what lasts, what alternates [m, kPa].
      real(wp), intent(in) :: norm(:), before, after   !< Of what lasts; times since the last sudden change [s].
      type(run_t), intent(inout) :: run
      real(wp) :: kept(FIELDS)
      integer :: i, node

      kept = 1.0_wp
      if (stage%kind == QUASI_STATIC) kept = before/after
      associate (c => run%control)
         if (stage%kind == DYNAMIC) then
            c%motion = c%motion + (after - before)*run%ledger%kinetic
            kept(:DISPLACEMENTS) = kept_of_motion(after - before, run%ledger%damping - c%damped_0, c%motion)
            kept(DISPLACEMENTS + 1:) = min(kept(AT_U_R), before/after)
         end if
         c%scale = scales(run, size(run%state%x, 2) - size(model%domain%bodies))
         c%gathered = kept*c%gathered + norm
         c%ripple = max(kept*c%ripple, field_norms(ripple(:, :size(ripple, 2) - size(model%domain%bodies))))
         c%largest = max(c%largest, c%gathered + c%ripple)
         do i = 1, size(model%points)
            node = model%points(i)%node
            c%point_gathered(:, i) = kept*c%point_gathered(:, i)
            ! Motion may answer an error in its own time, and paths keep it: magnitudes add up. What flows answers by
            ! fading alone: errors of opposite sign cancel.
            if (stage%kind == QUASI_STATIC) then
               c%point_gathered(:, i) = c%point_gathered(:, i) + error(:, node)
            else
               c%point_gathered(:, i) = abs(c%point_gathered(:, i)) + abs(error(:, node))
            end if
            c%point_ripple(:, i) = max(kept*c%point_ripple(:, i), abs(ripple(:, node)))
            c%point_largest(:, i) = max(c%point_largest(:, i), abs(c%point_gathered(:, i)) + c%point_ripple(:, i))
            c%low(:, i) = min(c%low(:, i), run%state%x(:, node), run%next%x(:, node))
            c%high(:, i) = max(c%high(:, i), run%state%x(:, node), run%next%x(:, node))
         end do
      end associate
   end subroutine gather

   !> After an attempt that failed: the share of it that is tried next becomes the step. docs/theory/host.md section
   !> 4.4; nothing where steps are given.
   subroutine shorten_step(stage, dt, run)
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(inout) :: run

      if (.not. stage%controlled) return
      run%control%controller%dt = dt*run%at%factor
      run%control%controller%held = .true.
      if (run%control%memory%based) then
         run%state%v = run%control%memory%base_rate
         run%state%s_rate = run%control%memory%base_s_rate
      end if
      ! The rate of a static step before holds still; a flow may have failed where something begins.
      if (stage%kind /= STATIC) call forget(run%control%memory)
      run%at%factor = 1.0_wp
   end subroutine shorten_step

   !> After an accepted step, before it is taken over: rates for the next estimate, and what ends with the step.
   !> docs/theory/host.md section 4.5. Where steps are given their length does not follow.
   subroutine keep_step(model, stage, dt, run)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(inout) :: run
      type(scheme_t) :: scheme
      logical :: breaks

      scheme = make_scheme(kind_of_error(model, stage), stage%rho_inf, dt)
      breaks = stage%kind /= DYNAMIC .and. is_break(model, stage, run%next%time, dt)
      associate (c => run%control)
         call remember(scheme, c%memory, run%state%x, run%next%x, run%state%v, run%state%s_rate)
         c%fresh = c%fresh + 1
         ! A first static step may have taken at once what acts from the start: its rate is none.
         if (c%fresh < merge(2, SETTLED, stage%kind == STATIC)) c%memory%known = .false.
         if (breaks) call sudden(run%next%time, run)
         if (.not. stage%controlled) return
         run%at%cuts = max(0, run%at%cuts - 1)
         run%at%nominal = c%controller%dt
         if (breaks) then
            c%controller%dt = min(c%controller%dt, max(dt*stage%accuracy, SHORTEST*stage%duration*LARGEST_FACTOR))
            c%start_up = START_UP_STEPS*c%controller%dt
         end if
      end associate
   end subroutine keep_step
end module step_size
