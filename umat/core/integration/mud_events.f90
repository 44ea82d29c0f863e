! SPDX-License-Identifier: MIT
!> Events inside a substep: where one happens, the substep is shortened to end just beyond it.
module mud_events
   use mud_cutoff, only: is_below, end_at_parting, is_parted
   use mud_error_control, only: changes_root
   use mud_event_functions, only: rate_at_end, place_of, backwards
   use mud_event_table, only: EVENTS, EVENT_NONE, EVENT_OPENS, EVENT_PARTS, EVENT_CLOSES, EVENT_MECHANISM, &
      EVENT_DILATES, EVENT_YIELD, EVENT_UNLOAD, EVENT_REVERSAL, EVENT_RETURN, EVENT_FORWARDS, EVENT_TURN
   use mud_increment, only: increment_t, rate_of, store_rate
   use mud_integration, only: integration_t
   use mud_isotropic_memory, only: drive_of_margin, turns_by_resting, margin_after
   use mud_kinds, only: wp
   use mud_landing, only: land_on
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_return_point, only: place_t, projection_on_chord, note_progress, note_farthest
   use mud_state, only: counters_t
   use mud_substep, only: LARGEST_FACTOR, cubic_point
   use mud_trial, only: trial_t, take_step
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: stop_at_event, note_turning_point

   real(wp), parameter :: PROBE_BELOW = 0.5_wp   !< A minimum below this share of x_rev above -x_rev is looked at [-].
   !> A kink is looked for where the error of a substep is above this share of the tolerance [-].
   real(wp), parameter :: SHARP_KINK = 0.01_wp
   !> A margin of the isotropic memory that a substep exceeds by less than this share of the tolerance, or a drive that
   !> leads as far below it, is not looked at [-].
   real(wp), parameter :: SMALL_MARGIN = 0.01_wp
   !> A drive of the isotropic mechanism this much smaller than at the end of a substep is where it switched before [-].
   real(wp), parameter :: AT_SWITCH = 1.0e-6_wp
contains
   !> Shortens an accepted substep so that it lands where the first event happens that concerns it: each is looked for
   !> in what those before it have left. h is a share of inc [-]; it stays where there is no event.
   !> docs/theory/integration.md sections 4.1, 4.2.
   pure subroutine stop_at_event(par, error, h, it)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: error        !< error of the substep [-]
      real(wp), intent(inout) :: h
      type(integration_t), intent(inout) :: it
      integer :: i
      logical :: possible

      it%event = EVENT_NONE
      do i = 1, ubound(EVENTS, 1)
         if (.not. EVENTS(i)%concerns(it%trial%mode)) cycle
         call look_ahead(par, i, error, h, it, possible)
         if (.not. possible) cycle
         if (i == EVENT_PARTS) then
            it%event = i
            call take_step(par, it%inc, h, it%trial, it%counters)
         else
            call land_on(par, it%inc, i, error, h, it%trial, it%counters, it%event)
         end if
      end do
   end subroutine stop_at_event

   !> Whether an event is possible in a substep, for what its function costs. Arguments as in stop_at_event.
   pure subroutine look_ahead(par, event, error, h, it, possible)
      type(params_t), intent(in) :: par
      integer, intent(in) :: event
      real(wp), intent(in) :: error
      real(wp), intent(inout) :: h
      type(integration_t), intent(inout) :: it
      logical, intent(out) :: possible
      logical :: rests
      real(wp) :: reversal

      possible = .true.
      associate (inc => it%inc, trial => it%trial)
         select case (event)
         case (EVENT_OPENS)
            possible = is_below(par, trial%y(1:6))
         case (EVENT_PARTS)
            call end_at_parting(inc, trial%parts, trial%time, h, possible)
         case (EVENT_CLOSES)
            possible = .not. (is_parted(inc, trial%parts, trial%time) .or. is_parted(inc, trial%parts, trial%time + h))
         case (EVENT_MECHANISM)
            if (error > SHARP_KINK*par%tolerance) then
               possible = mechanism_switches(inc, trial)
            else
               possible = .false.
            end if
         case (EVENT_DILATES)
            possible = trial%w(1)%preloaded .and. error > SHARP_KINK*par%tolerance
            if (possible) possible = switches(trial%w(1)%d, trial%w(inc%scheme%stages)%d)
         case (EVENT_YIELD)
            possible = inc%rests
            if (possible) possible = margin_after(par, inc, trial, h) > SMALL_MARGIN*par%tolerance
         case (EVENT_UNLOAD)
            possible = par%remembers .and. .not. (inc%rests .or. trial%closed)
            if (.not. possible) return
            associate (w => trial%w(inc%scheme%stages))
               possible = h*drive_of_margin(par, inc, trial%time + h, w) < -SMALL_MARGIN*par%tolerance
            end associate
         case (EVENT_REVERSAL)
            possible = may_reverse(par, inc, trial)
            if (.not. possible) return
            call turns_by_resting(par, inc, trial, trial%time + h, trial%y, trial%margin, it%counters, rests)
            if (rests) possible = .false.
            if (rests) return
            reversal = h
            call find_reversal(par, inc, trial, it%counters, reversal, possible)
            if (.not. possible .or. reversal >= h) return
            h = reversal
            call take_step(par, inc, h, trial, it%counters)
         case (EVENT_RETURN)
            possible = trial%watched > 0
         case (EVENT_FORWARDS)
            possible = trial%drifts
            if (possible) possible = inc%scheme%first_same_as_last .or. &
                                     backwards(trial%w(inc%scheme%stages)) <= 0.0_wp
         end select
      end associate
   end subroutine look_ahead

   !> True where the isotropic mechanism begins or ends to act inside the substep. Its rates have a kink there, which is
   !> sharp while suction changes: a substep across it has an error that depends on where in it the kink lies, and
   !> Newton's method in a host sees that as noise.
   pure logical function mechanism_switches(inc, trial)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial

      mechanism_switches = inc%suction%bonds .and. abs(inc%d_pc) > 0.0_wp
      if (mechanism_switches) &
         mechanism_switches = switches(trial%w(1)%iso_drive, trial%w(inc%scheme%stages)%iso_drive)
   end function mechanism_switches

   !> True where a number changes its sign in a substep that does not begin there.
   pure logical function switches(first, last)
      real(wp), intent(in) :: first, last

      switches = first*last < 0.0_wp .and. abs(first) > AT_SWITCH*abs(last)
   end function switches

   !> True where a reversal inside the substep is possible: (r - r_in):n is beyond -x_rev at its last stage, or would be
   !> if it went on at twice the rate with which the substep begins. A parabola that comes back falls a quarter as far.
   !> Where it stays between 0 and -x_rev, as in soil that hardly moves, nothing is looked for. A process that drifts
   !> backwards from its beginning (softening outside the bounding surface) is not looked at: there the floor makes the
   !> rates independent of the memory, and it is enough to take the beginning along, or to begin anew where a substep
   !> begins. Without any guard the latter is so everywhere.
   pure logical function may_reverse(par, inc, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp) :: fall

      may_reverse = par%guarded .and. trial%advanced .and. trial%w(1)%loading .and. trial%w(1)%x >= -par%x_rev
      if (may_reverse) then
         associate (first => trial%w(1), second => trial%w(2), last => trial%w(inc%scheme%stages))
            fall = 0.0_wp
            if (second%loading) fall = LARGEST_FACTOR*(first%x - second%x)/inc%scheme%node(2)
            may_reverse = last%loading .and. (last%x < -par%x_rev .or. first%x + par%x_rev < fall)
         end associate
      end if
   end function may_reverse

   !> Whether (r - r_in):n passes -x_rev in the substep. Where it comes back h is shortened to a place beyond the
   !> reversal: its minimum, by a parabola through the start, the middle and the end. For the middle the cubic through
   !> both ends is good enough, unless the direction jumps in between; then a stage is beyond -x_rev, or nothing is.
   pure subroutine find_reversal(par, inc, trial, counters, h, reverses)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      type(counters_t), intent(inout) :: counters
      real(wp), intent(inout) :: h
      logical, intent(out) :: reverses
      type(trial_t) :: probe
      type(rate_t) :: w
      real(wp) :: x_start, x_middle, x_end, slope, bend, lowest, y(NY), rates(NY, 2)

      x_start = trial%w(1)%x + par%x_rev
      w = trial%w(1)
      call rate_at_end(par, inc, EVENT_REVERSAL, trial, h, w, counters)
      x_end = w%x + par%x_rev
      reverses = x_end < 0.0_wp
      if (reverses) return
      probe = trial
      if (changes_root(trial%w(1:inc%scheme%stages))) then
         if (all(trial%w(1:inc%scheme%stages)%x >= -par%x_rev)) return
         call take_step(par, inc, 0.5_wp*h, probe, counters)
         call rate_at_end(par, inc, EVENT_REVERSAL, probe, 0.5_wp*h, w, counters)
      else
         call store_rate(trial%w(1), rates(:, 1))
         call store_rate(w, rates(:, 2))
         y = cubic_point(h, 0.5_wp, trial%y0, rates(:, 1), trial%y, rates(:, 2))
         call rate_of(par, inc, trial%time + 0.5_wp*h, y, trial%r_in, trial%mode, w, counters)
      end if
      x_middle = w%x + par%x_rev
      slope = 4.0_wp*x_middle - 3.0_wp*x_start - x_end
      bend = 2.0_wp*(x_start + x_end - 2.0_wp*x_middle)
      if (bend <= 0.0_wp) return
      lowest = -0.5_wp*slope/bend
      if (lowest <= 0.0_wp .or. lowest >= 1.0_wp) return
      if (x_start + lowest*(slope + lowest*bend) > PROBE_BELOW*par%x_rev) return
      call take_step(par, inc, lowest*h, probe, counters)
      call rate_at_end(par, inc, EVENT_REVERSAL, probe, lowest*h, w, counters)
      reverses = w%x < -par%x_rev
      if (reverses) h = lowest*h
   end subroutine find_reversal

   !> The direction and target of the present process after an accepted substep: where it goes forwards last, at the end
   !> or where it ceases to. That place belongs to the path, while the end of the last substep of which it is true would
   !> depend on the sizes of substeps. A process that begins where the substep does, and drifts backwards, has not gone
   !> forwards. h is a share of inc [-]. docs/theory/memory-rules.md section 3.2, docs/theory/integration.md section
   !> 4.2.
   pure subroutine note_turning_point(par, h, it)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: h
      type(integration_t), intent(inout) :: it
      type(place_t) :: place
      type(trial_t) :: probe
      type(rate_t) :: w
      real(wp) :: size
      integer :: landed

      associate (inc => it%inc, trial => it%trial, memory => it%state%memory)
         place = place_of(par, inc, trial, trial%w(inc%scheme%stages), trial%y)
         if (projection_on_chord(par, place) >= 0.0_wp) then
            call note_progress(place, memory)
            return
         end if
         if (projection_on_chord(par, place_of(par, inc, trial, trial%w(1), trial%y0)) > 0.0_wp) then
            probe = trial
            size = h
            call land_on(par, inc, EVENT_TURN, par%tolerance, size, probe, it%counters, landed)
            call rate_of(par, inc, trial%time + size, probe%y, trial%r_in, trial%mode, w, it%counters)
            call note_progress(place_of(par, inc, trial, w, probe%y), memory)
         end if
         call note_farthest(place%r, memory)
      end associate
   end subroutine note_turning_point
end module mud_events
