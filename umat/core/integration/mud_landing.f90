! SPDX-License-Identifier: MIT
!> Shortens a substep so that it ends at the event inside it; docs/theory/integration.md section 4.1.
module mud_landing
   use mud_event, only: EVENT_OPENS, BEFORE, BEYOND
   use mud_event_table, only: EVENTS, event_function, rate_at_start, rate_at_end
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: MODE_ORDINARY
   use mud_state, only: counters_t
   use mud_tensor, only: ddot
   use mud_trial, only: trial_t, take_step
   implicit none (type, external)
   private
   public :: land_on, EVENT_TOLERANCE

   !> Width of the bracket of an event, share of increment [-].
   real(wp), parameter :: EVENT_TOLERANCE = 1.0e-13_wp
   real(wp), parameter :: ROUNDING = 4.0e-16_wp   !< A function is zero below it, too [-].
   !> A function this small at the start, as a share of its change, is zero there but for where the event before was
   !> found: false position would creep away from it [-].
   real(wp), parameter :: AT_START = 1.0e-6_wp
   !> A function that has no zero by then jumps there, as (r - r_in):n does from one direction to another: bisection.
   integer, parameter :: SMOOTH_ITERATIONS = 16
   !> Criterion of a jump: after some trials and over a bracket shorter than SHORT of the substep the function still
   !> changes by more than JUMP of its change over the whole; then bisection. Only where the direction turns to its
   !> opposite does the convergence of a host's Newton method depend on the place; elsewhere the error of the stress
   !> bounds the bracket [-].
   real(wp), parameter :: SHORT = 0.25_wp, JUMP = 0.5_wp, OPPOSITE = -0.9_wp
   integer, parameter :: TRIALS = 3
   !> A jump in a substep leaves an error of a tenth to a twentieth of its change of the stress. This share of the
   !> substep that has the error of the tolerance is a tenth of the tolerance, then [-].
   real(wp), parameter :: JUMP_SHARE = 0.01_wp
contains
   !> Finds the end of the substep where the event's function turns negative (false position as Anderson and Bjoerck
   !> accelerate it), and leaves the trial there, just beyond or, at a kink, just before. A point that has just closed
   !> begins with p' = p_min and rises: there the function over the size is looked at, which has no root at the start.
   !> h is a share of inc [-]; it and landed stay where the function is not negative at the end.
   !> docs/theory/integration.md section 4.1.
   pure subroutine land_on(par, inc, event, error, h, trial, counters, landed)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      real(wp), intent(in) :: error        !< error of the substep [-]
      real(wp), intent(inout) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      integer, intent(inout) :: landed     !< becomes the event if it happens
      type(rate_t) :: w
      real(wp) :: low, high, f_low, f_high, f, h_trial, width, zero, ahead, value_low, value_high, change, narrow
      integer :: iteration, side
      logical :: divided, bisects, jumps

      call rate_at_end(par, inc, event, trial, h, w, counters)
      f_high = event_function(par, inc, event, trial, trial%time + h, trial%y, w)
      if (f_high >= 0.0_wp) return
      landed = event
      call rate_at_start(par, inc, event, trial, w, counters)
      f_low = event_function(par, inc, event, trial, trial%time, trial%y0, w)
      zero = max(max(EVENTS(event)%residual, EVENT_TOLERANCE/h)*(f_low - f_high), ROUNDING)
      ahead = 0.0_wp
      if (EVENTS(event)%side == BEFORE) then   ! whatever the rounding
         zero = 0.5_wp*zero
         ahead = zero
         f_low = f_low - ahead
         f_high = f_high - ahead
      end if
      divided = event == EVENT_OPENS .and. f_low <= AT_START*(f_low - f_high) .and. trial%w(1)%d_p > 0.0_wp
      if (divided) then
         f_low = trial%w(1)%d_p/par%p_min   ! the rate of the height
         f_high = f_high/h
         zero = max(max(EVENTS(event)%residual, EVENT_TOLERANCE/h)*(f_low - f_high), ROUNDING/h)
      end if
      low = 0.0_wp
      high = h
      h_trial = h
      side = 0
      width = h
      value_low = f_low
      value_high = f_high
      change = f_low - f_high
      bisects = .false.
      jumps = .false.
      narrow = jump_width(inc, h, error/par%tolerance, trial)
      do iteration = 1, EVENTS(event)%trials
         if (high - low <= merge(narrow, EVENT_TOLERANCE, jumps) .or. high <= par%h_min) exit
         if (iteration > TRIALS) then
            bisects = value_low - value_high > JUMP*change
            jumps = bisects .and. high - low <= SHORT*h
         end if
         h_trial = 0.5_wp*(low + high)
         if (.not. bisects .and. (f_low > 0.0_wp .or. low > 0.0_wp) .and. iteration <= SMOOTH_ITERATIONS .and. &
             (mod(iteration, 4) > 0 .or. high - low < 0.5_wp*width)) then
            h_trial = low + (high - low)*f_low/(f_low - f_high)
            h_trial = min(max(h_trial, low + 0.5_wp*EVENT_TOLERANCE), high - 0.5_wp*EVENT_TOLERANCE)
         end if
         if (mod(iteration, 4) == 0) width = high - low
         call take_step(par, inc, h_trial, trial, counters)
         call rate_at_end(par, inc, event, trial, h_trial, w, counters)
         f = event_function(par, inc, event, trial, trial%time + h_trial, trial%y, w)
         if (divided) f = f/h_trial
         f = f - ahead
         if (f < 0.0_wp) then
            if (side < 0) f_low = f_low*remaining(f, f_high)
            high = h_trial
            f_high = f
            value_high = f
            side = -1
         else
            if (side > 0) f_high = f_high*remaining(f, f_low)
            low = h_trial
            f_low = f
            value_low = f
            side = 1
            ! at the event but for rounding
            if (f < zero .and. EVENTS(event)%side /= BEYOND) high = low
         end if
         if (f_high > -zero) exit
      end do
      if (abs(h_trial - high) > 0.0_wp) call take_step(par, inc, high, trial, counters)
      h = high
   end subroutine land_on

   !> Largest length of the bracket of a jump, share of inc [-].
   pure real(wp) function jump_width(inc, h, error, trial) result(width)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: h, error   !< size of the substep, and its error in tolerances [-]
      type(trial_t), intent(in) :: trial

      width = JUMP_SHARE*h/max(error, 1.0_wp)
      if (trial%mode == MODE_ORDINARY) then   ! others have no direction
         if (ddot(trial%w(1)%n, trial%w(inc%scheme%stages)%n) < OPPOSITE) width = 0.0_wp
      end if
      width = max(width, EVENT_TOLERANCE)
   end function jump_width

   !> Factor by which Anderson and Bjoerck's false position lowers the value at the end of the bracket that rests, after
   !> a new value on the other side.
   pure real(wp) function remaining(new, old)
      real(wp), intent(in) :: new, old

      remaining = 0.5_wp
      if (abs(new) < abs(old)) remaining = 1.0_wp - new/old
   end function remaining
end module mud_landing
