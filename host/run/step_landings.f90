! SPDX-License-Identifier: MIT
!> Times that controlled steps end at: breaks of load histories, supports that come and go, output, end of the stage.
!> Given steps end early where they would jump over something. Controlled steps end where a contact closes, too: what
!> meets within a step leaves no error of its own size in it, since it is hardly stopped there.
!>
!> Of a load history of a few breaks every one counts; of a record of thousands only those matter that a straight line
!> over them would miss by more than a share of the accuracy. One rule serves both.
!> docs/theory/host.md section 4.5.
module step_landings
   use kinds, only: wp
   use boundary_conditions, only: load_at
   use degrees_of_freedom, only: of_unknowns
   use history_shapes, only: kinks_of
   use model_types, only: SPACINGS
   use run_state, only: run_t
   use scene_parts, only: amplitude_t, amplitude_at
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: next_time, end_of_given, closed_contacts, ends_at_closing, end_where_it_closes
   public :: is_break, begins_suddenly, changes_within, straight_until, LAST_STEP, SHORTEST, LEAST_SPACINGS

   real(wp), parameter :: LAST_STEP = 1.0e-6_wp   !< A rest of a span below this share of a step is rounding.
   real(wp), parameter :: SHORTEST = 1.0e-8_wp    !< Smallest step as a share of the stage.
   real(wp), parameter :: LEAST_SPACINGS = 16.0_wp   !< Spacings of numbers at a time: a shorter step is its rounding.
   real(wp), parameter :: CHORD_SHARE = 0.1_wp    !< Share of the accuracy that a straight line may leave out.
   real(wp), parameter :: SAME = 1.0e-9_wp        !< Relative difference that is none.
   integer, parameter :: BISECTIONS = 40     !< Bisections of the time at which a contact closes: 1e-12 of the step.
   !> A closing nearer than this share of the step that the error asks for is not landed on: the step may hold it.
   real(wp), parameter :: NEAREST = 0.015_wp
contains
   !> Finds the next time that a step has to end at: a break of what acts, a support that comes or goes, a time of
   !> output, the end of the stage [s]. docs/theory/host.md section 4.5.
   real(wp) function next_time(run, reach) result(next)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: reach   !< No step goes farther than this from the present time [s].
      real(wp) :: now, close
      integer :: i

      now = run%state%time
      next = run%at%t_start + run%stage%duration
      close = LAST_STEP*min(run%stage%duration, max(run%control%controller%dt, SHORTEST*run%stage%duration))
      do i = 1, size(run%model%amplitudes)
         next = min(next, straight_until(run%model%amplitudes(i), now, close, min(next, now + reach), &
                                         CHORD_SHARE*run%stage%step_tolerance))
      end do
      associate (times => times_of_supports(run))
         next = min(next, minval(times, mask=times > now + close))
      end associate
      if (run%stage%output_dt > 0.0_wp) next = min(next, run%at%t_start &
         + run%stage%output_dt*(aint((now - run%at%t_start + close)/run%stage%output_dt) + 1))
   end function next_time

   !> Times at which supports of the stage come and go [s].
   pure function times_of_supports(run) result(times)
      type(run_t), intent(in) :: run
      real(wp), allocatable :: times(:)
      integer :: i

      associate (fixes => run%model%fixes)
         associate (acts => [(fixes(i)%in_stage(run%at%stage), i=1, size(fixes))])
            times = [pack(fixes%from, acts), pack(fixes%until, acts)]
         end associate
      end associate
   end function times_of_supports

   !> Finds the end of a given step: as late as it is asked for, unless it would jump over a kink of a history of known
   !> shape, a whole segment of another, or all the time in which a support acts; then where a controlled step would end
   !> [s]. docs/theory/host.md section 4.5.
   pure real(wp) function end_of_given(run, asked) result(until)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: asked   !< [s]
      real(wp) :: now, close
      integer :: i

      now = run%state%time
      until = asked
      ! Late in a run the sum of steps misses a time by more than a share of the step.
      close = max(LAST_STEP*(asked - now), (SPACINGS + run%at%step)*spacing(now))
      do i = 1, size(run%model%amplitudes)
         associate (h => run%model%amplitudes(i), t => run%model%amplitudes(i)%times)
            if (size(h%arcs) > 0) until = min(until, minval(t, mask=t > now + close .and. t < asked - close .and. &
                                                            kinks_of(t, h%values, h%arcs)))
            if (any(t(:size(t) - 1) >= now - close .and. t(2:) <= asked + close)) until = min(until, &
               straight_until(h, now, close, asked, CHORD_SHARE*run%stage%step_tolerance))
         end associate
      end do
      do i = 1, size(run%model%fixes)
         associate (fix => run%model%fixes(i))
            if (.not. fix%in_stage(run%at%stage)) cycle
            if (fix%from < now - close .or. fix%until > asked - close) cycle
            until = min(until, merge(fix%from, fix%until, fix%from > now + close))
         end associate
      end do
   end function end_of_given

   !> Finds the break of a history up to which a straight line from the present time leaves out no more than a share of
   !> its range: the one that the line to the horizon misses most, until no line misses one. Huge if there is none. [s]
   !> docs/theory/host.md section 4.5.
   pure real(wp) function straight_until(amplitude, now, close, horizon, share) result(until)
      type(amplitude_t), intent(in) :: amplitude
      real(wp), intent(in) :: now, close   !< Breaks nearer than `close` are the present time [s].
      real(wp), intent(in) :: horizon      !< [s]
      real(wp), intent(in) :: share        !< Share of the range [-].
      real(wp) :: line_end, start, slope, missed, most, allowed
      integer :: first, last, k, worst

      until = huge(1.0_wp)
      associate (t => amplitude%times, v => amplitude%values)
         first = count(t <= now + close) + 1
         last = count(t < horizon - close)
         allowed = share*(maxval(v) - minval(v))
         start = amplitude_at(amplitude, now)
         line_end = horizon
         do
            worst = 0
            most = allowed
            slope = (amplitude_at(amplitude, line_end) - start)/(line_end - now)
            do k = first, last
               missed = abs(v(k) - start - slope*(t(k) - now))
               if (.not. missed > most) cycle
               most = missed
               worst = k
            end do
            if (worst == 0) exit
            until = t(worst)
            line_end = until
            last = worst - 1
         end do
      end associate
   end function straight_until

   !> Whether something that acts breaks at the end of a step: a support comes or goes, or a history turns by more than
   !> a share of its range within a step like the last. The share is the accuracy of the stage: docs/theory/host.md
   !> section 4.5.
   pure logical function is_break(run)
      type(run_t), intent(in) :: run
      real(wp) :: turn
      integer :: i

      is_break = .false.
      associate (time => run%next%time, dt => run%scheme%dt, stage => run%stage)
         do i = 1, size(run%model%amplitudes)
            associate (h => run%model%amplitudes(i))
               ! Where two arcs of a wave meet nothing breaks.
               if (.not. any(abs(h%times - time) < LAST_STEP*dt .and. kinks_of(h%times, h%values, h%arcs))) cycle
               turn = amplitude_at(h, time + dt) - 2*amplitude_at(h, time) + amplitude_at(h, time - dt)
               is_break = is_break .or. abs(turn) > stage%step_tolerance*(maxval(h%values) - minval(h%values))
            end associate
         end do
         is_break = is_break .or. any(abs(times_of_supports(run) - time) < LAST_STEP*dt)
      end associate
   end function is_break

   !> Whether a load history changes or a support comes or goes between two times [s]. docs/theory/host.md section 4.5.
   pure logical function changes_within(run, from, until) result(changes)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: from, until
      real(wp) :: first
      integer :: i

      associate (times => times_of_supports(run))
         changes = any(times > from .and. times < until)
      end associate
      do i = 1, size(run%model%amplitudes)
         associate (h => run%model%amplitudes(i))
            first = amplitude_at(h, from)
            changes = changes .or. abs(amplitude_at(h, until) - first) > 0.0_wp .or. &
                      any(h%times > from .and. h%times < until .and. abs(h%values - first) > 0.0_wp)
         end associate
      end do
   end function changes_within

   !> Whether a flow may begin at once where a stage does: loads or prescribed values jump, or it is the first one and
   !> has weight or pressures that differ from node to node. docs/theory/host.md section 4.5.
   function begins_suddenly(run) result(at_once)
      type(run_t), intent(in) :: run   !< With what the stage prescribes at its start.
      logical :: at_once
      real(wp) :: load(run%dofs%n), before(run%dofs%n), largest(FIELDS)

      associate (x => run%state%x, c => run%constraint, number => run%at%stage)
         load = load_at(run%model, number, run%state%time)
         before = 0.0_wp
         if (number > 1) before = load_at(run%model, number - 1, run%state%time)
         at_once = norm2(load - before) > SAME*norm2(load)
         if (number == 1) at_once = at_once .or. abs(run%state%gravity) > 0.0_wp .or. &
            any(abs(x(AT_P_W:AT_P_C, :) - spread(x(AT_P_W:AT_P_C, 1), 2, size(x, 2))) > SAME*maxval(abs(x(AT_P_W:, :))))
         largest = maxval(abs(x), dim=2)
         at_once = at_once .or. any(c%fixed .and. &
                                    abs(c%target - of_unknowns(run%dofs, x)) > SAME*largest(run%dofs%field))
         at_once = at_once .or. any(c%air .and. abs(c%air_target - x(AT_P_W, :) - x(AT_P_C, :)) > &
                                                SAME*maxval(largest(AT_P_W:)))
      end associate
   end function begins_suddenly

   !> Gives 1 for every contact that is closed at given displacements, else 0; 0 too where these are refused.
   function closed_contacts(run, x) result(closed)
      type(run_t), intent(inout) :: run
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) [m]
      real(wp) :: closed(size(run%control%touching))
      logical :: are_closed(size(closed))

      if (size(closed) > 0) call run%system%contacts%find_closed(x, are_closed)
      closed = merge(1.0_wp, 0.0_wp, are_closed)
   end function closed_contacts

   !> Whether a step in which a contact closes ends there, or has been repeated so that it should. If not, the next
   !> attempt does.
   logical function ends_at_closing(run) result(ends)
      type(run_t), intent(inout) :: run

      associate (c => run%control, dt => run%scheme%dt)
         ends = c%located .or. dt <= SHORTEST*run%stage%duration
         if (ends) return
         call end_where_it_closes(run)
         ends = c%controller%dt >= dt*(1 - LAST_STEP)
         c%located = .not. ends
         if (.not. ends) c%rejected = c%rejected + 1
      end associate
   end function ends_at_closing

   !> Ends the next attempt where a contact closes, if that is shorter than what its error asks for. The time is looked
   !> for along the motion that keeps its accelerations: exact for bodies in free flight. Where that motion closes none
   !> the step stays as its error asks for.
   subroutine end_where_it_closes(run)
      type(run_t), intent(inout) :: run
      real(wp) :: open, shut, middle
      integer :: i

      open = 0.0_wp
      shut = run%scheme%dt
      if (.not. closes_after(shut)) return
      do i = 1, BISECTIONS
         middle = 0.5_wp*(open + shut)
         if (closes_after(middle)) then
            shut = middle
         else
            open = middle
         end if
      end do
      associate (dt_next => run%control%controller%dt)
         if (shut > NEAREST*dt_next) dt_next = min(dt_next, shut)
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
end module step_landings
