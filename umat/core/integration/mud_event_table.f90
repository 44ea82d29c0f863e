! SPDX-License-Identifier: MIT
!> The list of the events inside a substep, in the order in which they are looked for; each is a file, mud_event_NAME.
!> Jumps of the memory where the next substep begins are mud_transitions. docs/theory/integration.md section 4.2.
module mud_event_table
   use mud_cutoff, only: is_below
   use mud_event, only: event_t, event_changes_t, NO_RATE, RATE_THERE, RATE_IF_CLOSED, AT, NOBODY, NOTHING, &
      last_rate, psi_at, EVENT_NONE, EVENT_OPENS, EVENT_CLOSES, EVENT_BOUNDS, EVENT_MECHANISM, EVENT_REVERSAL, &
      EVENT_RETURN, EVENT_TURN, EVENT_PARTS, EVENT_DILATES, EVENT_YIELD, EVENT_UNLOAD, EVENT_FORWARDS
   use mud_event_bounds, only: BOUNDS, bounds_function
   use mud_event_closes, only: CLOSES_AT, may_close, rate_without_past, closing_function, slopes_of_closing
   use mud_event_dilates, only: DILATES, may_dilate
   use mud_event_forwards, only: FORWARDS, may_go_forwards, backwards, slopes_of_forwards
   use mud_event_mechanism, only: MECHANISM, mechanism_may_switch
   use mud_event_opens, only: OPENS, height
   use mud_event_parts, only: PARTS, end_at_parting
   use mud_event_return, only: RETURNS, return_function, slopes_of_return
   use mud_event_reversal, only: REVERSAL, look_for_reversal, slopes_of_reversal
   use mud_event_turn, only: TURN, place_of
   use mud_event_unload, only: UNLOAD
   use mud_event_yield, only: YIELD
   use mud_increment, only: increment_t, void_ratio_at
   use mud_kinds, only: wp
   use mud_mechanism, only: reaches_memory, short_of_memory, leaves_memory, drive_to_memory, forget_compression
   use mud_options, only: changes_of_flow
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio
   use mud_return_point, only: projection_on_chord
   use mud_state, only: state_t, counters_t
   use mud_tensor, only: DIRECTIONS
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: EVENTS, look_ahead, rate_at_start, rate_at_end, event_function, slopes_of_event, event_happened

   type(event_t), parameter :: NO_EVENT = event_t(NOBODY, NO_RATE, AT, NOTHING)
   !> In the order of EVENT_*.
   type(event_t), parameter :: EVENTS(EVENT_NONE:EVENT_TURN) = [ &
      NO_EVENT, OPENS, PARTS, CLOSES_AT, BOUNDS, MECHANISM, DILATES, YIELD, UNLOAD, REVERSAL, RETURNS, FORWARDS, &
      TURN]
contains
   !> Whether an event is possible in a substep h, for what its function costs; h is a share of inc [-], and error that
   !> of the substep. Where a reversal or a parting is not at the end h is shortened. docs/theory/integration.md
   !> section 4.2.
   pure subroutine look_ahead(par, inc, event, error, h, trial, counters, possible)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      real(wp), intent(in) :: error
      real(wp), intent(inout) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      logical, intent(out) :: possible

      possible = .true.
      select case (event)
      case (EVENT_OPENS)
         possible = is_below(par, trial%y(1:6))
      case (EVENT_PARTS)
         call end_at_parting(inc, trial%parts, trial%time, h, possible)
      case (EVENT_CLOSES)
         possible = may_close(inc, trial, h)
      case (EVENT_MECHANISM)
         possible = mechanism_may_switch(par, inc, trial, error)
      case (EVENT_DILATES)
         possible = may_dilate(par, inc, trial, error)
      case (EVENT_YIELD)
         possible = reaches_memory(par, inc, trial, h)
      case (EVENT_UNLOAD)
         possible = leaves_memory(par, inc, trial, h)
      case (EVENT_REVERSAL)
         call look_for_reversal(par, inc, h, trial, counters, possible)
      case (EVENT_RETURN)
         possible = trial%watched > 0
      case (EVENT_FORWARDS)
         possible = may_go_forwards(inc, trial)
      end select
   end subroutine look_ahead

   !> The rate that an event looks at where the trial's substep h ends. Events that look at no rate leave w as it is. h
   !> is a share of inc [-]; units of w as in rate_t. docs/theory/integration.md section 4.2.
   pure subroutine rate_at_end(par, inc, event, trial, h, w, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters

      select case (EVENTS(event)%looks_at)
      case (RATE_THERE)
         call last_rate(par, inc, trial, h, w, counters)
      case (RATE_IF_CLOSED)
         call rate_without_past(par, inc, trial%time + h, trial%y, w, counters)
      end select
   end subroutine rate_at_end

   !> The rate that an event looks at where the trial's substep begins.
   pure subroutine rate_at_start(par, inc, event, trial, w, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters

      select case (EVENTS(event)%looks_at)
      case (RATE_THERE)
         w = trial%w(1)
      case (RATE_IF_CLOSED)
         call rate_without_past(par, inc, trial%time, trial%y0, w, counters)
      end select
   end subroutine rate_at_start

   !> Function of an event, dimensionless, negative beyond it. time is a share of inc [-]; y and w are state and rate
   !> there, w only for the events that rate_at_end knows. docs/theory/integration.md section 4.2.
   pure real(wp) function event_function(par, inc, event, trial, time, y, w) result(f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial       !< where the substep began
      real(wp), intent(in) :: time, y(NY)
      type(rate_t), intent(in) :: w

      select case (event)
      case (EVENT_OPENS)
         f = height(par, y(1:6))
      case (EVENT_BOUNDS)
         f = bounds_function(par, inc, trial, time, y)
      case (EVENT_REVERSAL)
         f = w%x + par%x_rev
      case (EVENT_FORWARDS)
         f = backwards(w)
      case (EVENT_YIELD)
         f = short_of_memory(par, inc, trial, time)
      case (EVENT_UNLOAD)
         f = drive_to_memory(par, inc, time, w)
      case (EVENT_MECHANISM)
         f = w%iso_drive/trial%w(1)%iso_drive
      case (EVENT_DILATES)
         f = w%d/trial%w(1)%d
      case (EVENT_TURN)
         f = projection_on_chord(par, place_of(par, inc, trial, w, y))
      case (EVENT_RETURN)
         f = return_function(par, inc, trial, time, y)
      case default
         f = closing_function(inc, trial%openings, w)
      end select
   end function event_function

   !> Changes of the function of an event whose time counts, where it is zero; its scale does not matter. time is a
   !> share of inc [-], the trial has the state there. docs/theory/integration.md section 4.3.
   pure function slopes_of_event(par, inc, event, trial, time, w, c) result(slopes)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time
      type(rate_t), intent(in) :: w            !< where the event depends on a rate
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(DIRECTIONS)
      real(wp) :: p, r(6)

      call stress_ratio(par, trial%y(1:6), p, r)
      select case (event)
      case (EVENT_OPENS)
         slopes = c%y(:, 1) + c%y(:, 2) + c%y(:, 3)
      case (EVENT_PARTS)
         slopes = c%e
      case (EVENT_BOUNDS)
         slopes = c%excess
      case (EVENT_MECHANISM, EVENT_YIELD)
         slopes = c%mechanism
      case (EVENT_DILATES)
         slopes = changes_of_flow(w%d, c%rates)   ! of L D, which are those of D where it is 0, times a number
      case (EVENT_REVERSAL)
         slopes = slopes_of_reversal(par, trial, w, r, c)
      case (EVENT_RETURN)
         slopes = slopes_of_return(par, trial, psi_at(par, inc, time, p), c)
      case (EVENT_FORWARDS)
         slopes = slopes_of_forwards(w, r, c)
      case default
         slopes = slopes_of_closing(inc, trial%openings, w, void_ratio_at(inc, time), c)
      end select
   end function slopes_of_event

   !> An event has happened at the end of a substep that is taken over. Jumps of the memory come later.
   pure subroutine event_happened(event, trial, state)
      integer, intent(in) :: event
      type(trial_t), intent(inout) :: trial
      type(state_t), intent(inout) :: state

      select case (event)
      case (EVENT_OPENS)
         trial%openings = trial%openings + 1
      case (EVENT_BOUNDS)
         trial%pressed = .true.   ! ordinary rates follow, whichever way the strain leads: suction may move the surface
      case (EVENT_YIELD)
         call forget_compression(state)
      end select
   end subroutine event_happened
end module mud_event_table
