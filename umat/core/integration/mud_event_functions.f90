! SPDX-License-Identifier: MIT
!> The functions whose zeros are events; docs/theory/integration.md section 4.2.
module mud_event_functions
   use mud_kinds, only: wp
   use mud_bounding, only: psi_of, excess
   use mud_critical_state, only: bounding_ratio
   use mud_cutoff, only: rate_without_past, height, closing_function
   use mud_event_table, only: EVENTS, EVENT_OPENS, EVENT_BOUNDS, EVENT_MECHANISM, EVENT_REVERSAL, EVENT_RETURN, &
      EVENT_TURN, EVENT_YIELD, EVENT_UNLOAD, EVENT_FORWARDS, EVENT_DILATES, RATE_THERE, RATE_IF_CLOSED
   use mud_increment, only: increment_t, void_ratio_at, suction_at, rate_of
   use mud_isotropic_memory, only: drive_of_margin, margin_after
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio
   use mud_return_point, only: place_t, place_at, projection_on_chord, beyond_target
   use mud_state, only: counters_t
   use mud_tensor, only: ddot, norm, deviator
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: event_function, rate_at_start, rate_at_end, place_of, elastic_rate, backwards, psi_at, &
             LARGEST_EXCESS

   !> Share by which r may exceed the bounding surface: at a low stress an elastic strain of rho_e may be more than the
   !> whole strength. Softening sand is some per cent beyond it and must be able to return where it came from [-].
   real(wp), parameter :: LARGEST_EXCESS = 0.2_wp
contains
   !> The rate that an event looks at where the trial's substep ends: that of the last stage if it stands there. Events
   !> that look at no rate leave w as it is. h is a share of inc [-]; units of w as in rate_t.
   !> docs/theory/integration.md section 4.2.
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
         if (inc%scheme%first_same_as_last) then
            w = trial%w(inc%scheme%stages)
         else
            call rate_of(par, inc, trial%time + h, trial%y, trial%r_in, trial%mode, w, counters)
         end if
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
      real(wp) :: p, r(6)

      select case (event)
      case (EVENT_OPENS)
         f = height(par, y(1:6))
      case (EVENT_BOUNDS)
         call stress_ratio(par, y(1:6), p, r)
         f = allowed_excess(par, inc, trial) - excess(par, psi_at(par, inc, time, p), r)
      case (EVENT_REVERSAL)
         f = w%x + par%x_rev
      case (EVENT_FORWARDS)
         f = backwards(w)
      case (EVENT_YIELD)
         f = -trial%margin
         if (time > trial%time) f = -margin_after(par, inc, trial, time - trial%time)
      case (EVENT_UNLOAD)
         f = drive_of_margin(par, inc, time, w)
      case (EVENT_MECHANISM)
         f = w%iso_drive/trial%w(1)%iso_drive
      case (EVENT_DILATES)
         f = w%d/trial%w(1)%d
      case (EVENT_TURN)
         f = projection_on_chord(par, place_of(par, inc, trial, w, y))
      case (EVENT_RETURN)
         call stress_ratio(par, y(1:6), p, r)
         f = -beyond_target(par, trial%process, r, bounding_ratio(par, psi_at(par, inc, time, p)))
      case default
         f = closing_function(inc, trial%openings, w)
      end select
   end function event_function

   !> The place of the trial's process at a state y and its rate w; units as in both.
   !> docs/theory/memory-rules.md section 3.2.
   pure function place_of(par, inc, trial, w, y) result(place)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: y(NY)
      type(place_t) :: place
      real(wp) :: p, r(6), t(6)

      call stress_ratio(par, y(1:6), p, r)
      t = elastic_rate(inc, w, r)
      place = place_at(par, trial%r_in, w%loading, r, w%n, t)
      ! of the size of the chord, as what it is compared with: the place could not be found otherwise
      if (abs(place%along) > 0.0_wp) place%along = place%along/norm(t)
   end function place_of

   !> p' times the rate of the stress ratio if the whole strain were elastic. The part of the strain across the elastic
   !> domain turns the direction of loading, not the process: the whole strain tells where it goes. r [-].
   !> docs/theory/memory-rules.md section 3.3.
   pure function elastic_rate(inc, w, r) result(t)
      type(increment_t), intent(in) :: inc
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: r(6)
      real(wp) :: t(6)   !< [stress]

      t = (2.0_wp*w%g)*deviator(inc%d_strain) - (w%k*inc%d_v)*r
   end function elastic_rate

   !> Speed at which r moves against the loading direction, times p' [stress]. Without a direction it is backwards.
   !> docs/theory/memory-rules.md section 1.2.
   pure real(wp) function backwards(w)
      type(rate_t), intent(in) :: w

      backwards = w%g
      if (w%loading) backwards = w%r_n*w%d_p - ddot(w%d_sigma, w%n)
   end function backwards

   !> Largest excess of r over the bounding surface in a substep inside the elastic domain: from farther outside it is
   !> the excess at the start.
   pure real(wp) function allowed_excess(par, inc, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp) :: p, r(6)

      call stress_ratio(par, trial%y0(1:6), p, r)
      allowed_excess = max(excess(par, psi_at(par, inc, trial%time, p), r), LARGEST_EXCESS)
   end function allowed_excess

   !> State parameter at a pseudo-time and a mean stress [-]. time is a share of inc [-], p in the unit of p_atm.
   !> docs/theory/material.md section 3.2.
   pure real(wp) function psi_at(par, inc, time, p)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, p

      psi_at = psi_of(par, inc%suction, void_ratio_at(inc, time), suction_at(inc, time), p)
   end function psi_at
end module mud_event_functions
