! SPDX-License-Identifier: MIT
!> Events inside a substep: where one happens, the substep is shortened to end just beyond it.
module mud_events
   use mud_kinds, only: wp
   use mud_bounding, only: state_parameter, excess
   use mud_critical_state, only: bounding_ratio
   use mud_increment, only: increment_t, void_ratio_at, suction_at, rate_of, NY
   use mud_params, only: params_t
   use mud_rates, only: rate_t, stress_ratio, MODE_ORDINARY, MODE_ELASTIC
   use mud_registry, only: RULE_AS_PUBLISHED
   use mud_return_point, only: place_t, place_at, forwardness, note_progress, note_farthest, beyond_target
   use mud_state, only: memory_t, counters_t
   use mud_substep, only: LARGEST_FACTOR
   use mud_tensor, only: ddot, trace, norm, deviator
   use mud_trial, only: trial_t, take_step, MODE_HELD
   implicit none (type, external)
   private
   public :: stop_at_event, note_turning_point, elastic_rate, closing_mode, closing_rate, change_of_closing_rate, &
             psi_at, EVENT_TOLERANCE, LARGEST_EXCESS
   public :: EVENT_NONE, EVENT_OPENS, EVENT_CLOSES, EVENT_BOUNDS, EVENT_REVERSAL, EVENT_RETURN, EVENT_MECHANISM

   integer, parameter :: EVENT_NONE = 0
   integer, parameter :: EVENT_OPENS = 1      !< p' falls to p_min.
   integer, parameter :: EVENT_CLOSES = 2     !< p' would rise from p_min.
   integer, parameter :: EVENT_BOUNDS = 3     !< r exceeds the bounding surface inside the elastic domain.
   integer, parameter :: EVENT_REVERSAL = 4   !< (r - r_in):n falls to -x_rev.
   integer, parameter :: EVENT_RETURN = 5     !< r reaches the target of an interrupted process.
   integer, parameter :: EVENT_MECHANISM = 6  !< The isotropic mechanism begins or ends to act while suction changes.

   integer, parameter :: EVENT_TURN = 7       !< A process ceases to go forwards; its substep goes on.

   !> An open point closes when p' would rise by this share of the elastic rate: opening and closing at the same rate
   !> would chatter where the two pull the stress ratio to opposite sides [-].
   real(wp), parameter :: CLOSING = 0.01_wp
   !> Each time a point opens again in the same increment the share is that many times larger, up to a limit: where
   !> the rate without a past rises and that of the process that follows falls, it would open and close at every turn
   !> [-].
   real(wp), parameter :: CLOSING_GROWTH = 2.0_wp, LARGEST_CLOSING = 0.32_wp
   !> At a low stress an elastic strain of rho_e may be more than the whole strength: r may exceed the bounding surface
   !> by this share. Softening sand is some per cent beyond it and must be able to return where it came from [-].
   real(wp), parameter :: LARGEST_EXCESS = 0.2_wp
   !> Width of the bracket of an event, share of increment [-].
   real(wp), parameter :: EVENT_TOLERANCE = 1.0e-13_wp
   !> An event's function is zero below this share of its change over the substep: far enough above rounding that
   !> rounding does not decide how many trials are made; and below rounding [-].
   real(wp), parameter :: EVENT_RESIDUAL = 1.0e-12_wp, ROUNDING = 4.0e-16_wp
   real(wp), parameter :: PROBE_BELOW = 0.5_wp   !< A minimum below this share of x_rev above -x_rev is looked at [-].
   !> A kink is looked for where the error of a substep is above this share of the tolerance [-].
   real(wp), parameter :: SHARP_KINK = 0.01_wp
   !> A drive of the isotropic mechanism this much smaller than at the end of a substep is where it switched before [-].
   real(wp), parameter :: AT_SWITCH = 1.0e-6_wp
   !> A function this small at the start, as a share of its change, is zero there but for where the event before was
   !> found: false position would creep away from it [-].
   real(wp), parameter :: AT_START = 1.0e-6_wp
   !> A function that has no zero by then jumps there, as (r - r_in):n does from one direction to another: bisection.
   integer, parameter :: SMOOTH_ITERATIONS = 16
   integer, parameter :: MAX_EVENT_ITERATIONS = 100          !< Bisection alone needs about 45.
   !> It jumps where over a bracket that is shorter by this factor it still changes by more than that share of what it
   !> did: bisection, and a bracket that is wider, share of increment, because each trial is a substep. Only where the
   !> direction turns to its opposite does the convergence of a host's Newton method depend on the place [-].
   real(wp), parameter :: SHORT = 0.25_wp, JUMP = 0.5_wp, JUMP_TOLERANCE = 1.0e-10_wp, OPPOSITE = -0.9_wp
   !> A turning point ends no substep and need not be as exact; where the direction jumps, it is found to a thousandth
   !> of the substep.
   real(wp), parameter :: TURN_RESIDUAL = 1.0e-6_wp
   integer, parameter :: TURN_ITERATIONS = 10
contains
   !> Shortens an accepted substep so that it lands where the first event happens that its mode knows. h is a share of
   !> inc [-]; it stays where there is no event. docs/theory/integration.md sections 4.1, 4.2.
   pure subroutine stop_at_event(par, inc, error, h, trial, counters, event)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: error        !< of the substep [-]
      real(wp), intent(inout) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      integer, intent(out) :: event        !< EVENT_* at the end of the substep
      real(wp) :: reversal
      logical :: reverses

      event = EVENT_NONE
      if (trial%mode == MODE_HELD) then
         call land_on(par, inc, EVENT_CLOSES, h, trial, counters, event)
         return
      end if
      if (par%cutoff) then
         if (trace(trial%y(1:6)) < 3.0_wp*par%p_min) call land_on(par, inc, EVENT_OPENS, h, trial, counters, event)
      end if
      if (trial%mode == MODE_ELASTIC) then
         call land_on(par, inc, EVENT_BOUNDS, h, trial, counters, event)
         return
      end if
      if (error > SHARP_KINK*par%tolerance) then
         if (mechanism_switches(inc, trial)) call land_on(par, inc, EVENT_MECHANISM, h, trial, counters, event)
      end if
      if (may_reverse(par, inc, trial)) then
         reversal = h
         call find_reversal(par, inc, trial, counters, reversal, reverses)
         if (reverses) then
            if (reversal < h) then
               h = reversal
               call take_step(par, inc, h, trial, counters)
            end if
            call land_on(par, inc, EVENT_REVERSAL, h, trial, counters, event)
         end if
      end if
      if (trial%watched > 0) call land_on(par, inc, EVENT_RETURN, h, trial, counters, event)
   end subroutine stop_at_event

   !> True where the isotropic mechanism begins or ends to act inside the substep. Its rates have a kink there, which is
   !> sharp while suction changes: a substep across it has an error that depends on where in it the kink lies, and
   !> Newton's method in a host sees that as noise.
   pure logical function mechanism_switches(inc, trial)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial

      mechanism_switches = inc%bonded .and. abs(inc%d_pc) > 0.0_wp
      if (.not. mechanism_switches) return
      associate (first => trial%w(1)%iso_drive, last => trial%w(inc%scheme%stages)%iso_drive)
         mechanism_switches = first*last < 0.0_wp .and. abs(first) > AT_SWITCH*abs(last)
      end associate
   end function mechanism_switches

   !> True where a reversal inside the substep is possible: (r - r_in):n is beyond -x_rev at its last stage, or would be
   !> if it went on at twice the rate with which the substep begins. A parabola that comes back falls a quarter as far.
   !> Where it stays between 0 and -x_rev, as in soil that hardly moves, nothing is looked for. A process that drifts
   !> backwards from its beginning (softening outside the bounding surface) is not looked at: there the floor makes the
   !> rates independent of the memory, and it is enough to begin anew where a substep begins. The rule as_published
   !> tests there and nowhere else.
   pure logical function may_reverse(par, inc, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp) :: fall

      may_reverse = par%memory_rule /= RULE_AS_PUBLISHED .and. trial%advanced .and. trial%w(1)%loading .and. &
                    trial%w(1)%x >= -par%x_rev
      if (may_reverse) then
         associate (first => trial%w(1), second => trial%w(2), last => trial%w(inc%scheme%stages))
            fall = 0.0_wp
            if (second%loading) fall = LARGEST_FACTOR*(first%x - second%x)/inc%scheme%node(2)
            may_reverse = last%loading .and. (last%x < -par%x_rev .or. first%x + par%x_rev < fall)
         end associate
      end if
   end function may_reverse

   !> Whether (r - r_in):n passes -x_rev in the substep. Where it comes back h is shortened to a place beyond the
   !> reversal: its minimum, by a parabola through the start, the middle and the end.
   pure subroutine find_reversal(par, inc, trial, counters, h, reverses)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      type(counters_t), intent(inout) :: counters
      real(wp), intent(inout) :: h
      logical, intent(out) :: reverses
      type(trial_t) :: probe
      real(wp) :: x_start, x_middle, x_end, slope, bend, lowest

      x_start = trial%w(1)%x + par%x_rev
      call event_function(par, inc, EVENT_REVERSAL, trial, trial%time + h, trial%y, counters, x_end)
      reverses = x_end < 0.0_wp
      if (reverses) return
      probe = trial
      call take_step(par, inc, 0.5_wp*h, probe, counters)
      call event_function(par, inc, EVENT_REVERSAL, probe, probe%time + 0.5_wp*h, probe%y, counters, x_middle)
      slope = 4.0_wp*x_middle - 3.0_wp*x_start - x_end
      bend = 2.0_wp*(x_start + x_end - 2.0_wp*x_middle)
      if (bend <= 0.0_wp) return
      lowest = -0.5_wp*slope/bend
      if (lowest <= 0.0_wp .or. lowest >= 1.0_wp) return
      if (x_start + lowest*(slope + lowest*bend) > PROBE_BELOW*par%x_rev) return
      call take_step(par, inc, lowest*h, probe, counters)
      call event_function(par, inc, EVENT_REVERSAL, probe, probe%time + lowest*h, probe%y, counters, x_middle)
      reverses = x_middle < 0.0_wp
      if (reverses) h = lowest*h
   end subroutine find_reversal

   !> The direction and target of the present process after an accepted substep: where it goes forwards last, at the end
   !> or where it ceases to. That place belongs to the path, while the end of the last substep of which it is true would
   !> depend on the sizes of substeps. A process that begins where the substep does, and drifts backwards, has not gone
   !> forwards. h is a share of inc [-]. docs/theory/memory-rules.md section 3.2, docs/theory/integration.md section
   !> 4.2.
   pure subroutine note_turning_point(par, inc, h, trial, memory, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: h
      type(trial_t), intent(in) :: trial
      type(memory_t), intent(inout) :: memory
      type(counters_t), intent(inout) :: counters
      type(place_t) :: place
      type(trial_t) :: probe
      type(rate_t) :: w
      real(wp) :: size
      integer :: landed

      place = place_of(par, inc, trial, trial%w(inc%scheme%stages), trial%y)
      if (forwardness(par, place) >= 0.0_wp) then
         call note_progress(place, memory)
         return
      end if
      if (forwardness(par, place_of(par, inc, trial, trial%w(1), trial%y0)) > 0.0_wp) then
         probe = trial
         size = h
         call land_on(par, inc, EVENT_TURN, size, probe, counters, landed)
         call rate_of(par, inc, trial%time + size, probe%y, trial%r_in, trial%mode, w, counters)
         call note_progress(place_of(par, inc, trial, w, probe%y), memory)
      end if
      call note_farthest(place%r, memory)
   end subroutine note_turning_point

   !> The place of the trial's process at a rate.
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
   !> Finds the end of the substep where the event's function turns negative (false position as Anderson and Bjoerck
   !> accelerate it), and leaves the trial there, just beyond or, at a kink, just before. A point that has just closed
   !> begins with p' = p_min and rises: there the function over the size is looked at, which has no root at the start.
   pure subroutine land_on(par, inc, event, h, trial, counters, landed)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      real(wp), intent(inout) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      integer, intent(inout) :: landed     !< becomes the event if it happens
      real(wp) :: low, high, f_low, f_high, f, h_trial, width, zero, before, value_low, value_high, change, narrow
      integer :: iteration, side, most
      logical :: divided, jumps

      call event_function(par, inc, event, trial, trial%time + h, trial%y, counters, f_high)
      if (f_high >= 0.0_wp) return
      landed = event
      call event_function(par, inc, event, trial, trial%time, trial%y0, counters, f_low)
      most = merge(TURN_ITERATIONS, MAX_EVENT_ITERATIONS, event == EVENT_TURN)
      zero = max(merge(TURN_RESIDUAL, EVENT_RESIDUAL, event == EVENT_TURN)*(f_low - f_high), ROUNDING)
      before = 0.0_wp
      if (event == EVENT_MECHANISM) then
         ! The last stage stands at a kink. Whatever the rounding, it must be on the side of its substep: its
         ! derivatives are those of that side.
         zero = 0.5_wp*zero
         before = zero
         f_low = f_low - before
         f_high = f_high - before
      end if
      divided = event == EVENT_OPENS .and. f_low <= AT_START*(f_low - f_high) .and. trial%w(1)%d_p > 0.0_wp
      if (divided) then
         f_low = trial%w(1)%d_p/par%p_min
         f_high = f_high/h
         zero = max(EVENT_RESIDUAL*(f_low - f_high), ROUNDING/h)
      end if
      low = 0.0_wp
      high = h
      h_trial = h
      side = 0
      width = h
      value_low = f_low
      value_high = f_high
      change = f_low - f_high
      jumps = .false.
      narrow = JUMP_TOLERANCE
      if (trial%mode /= MODE_HELD) then   ! a held point has no stages
         if (ddot(trial%w(1)%n, trial%w(inc%scheme%stages)%n) < OPPOSITE) narrow = EVENT_TOLERANCE
      end if
      do iteration = 1, most
         if (high - low <= merge(narrow, EVENT_TOLERANCE, jumps) .or. high <= par%h_min) exit
         h_trial = 0.5_wp*(low + high)
         if (.not. jumps .and. (f_low > 0.0_wp .or. low > 0.0_wp) .and. iteration <= SMOOTH_ITERATIONS .and. &
             (mod(iteration, 4) > 0 .or. high - low < 0.5_wp*width)) then
            h_trial = low + (high - low)*f_low/(f_low - f_high)
            h_trial = min(max(h_trial, low + 0.5_wp*EVENT_TOLERANCE), high - 0.5_wp*EVENT_TOLERANCE)
         end if
         if (mod(iteration, 4) == 0) then
            jumps = high - low <= SHORT*width .and. value_low - value_high > JUMP*change
            width = high - low
            change = value_low - value_high
         end if
         call take_step(par, inc, h_trial, trial, counters)
         call event_function(par, inc, event, trial, trial%time + h_trial, trial%y, counters, f)
         if (divided) f = f/h_trial
         f = f - before
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
            ! at the event but for rounding; a held point must be beyond it, or it would not close
            if (f < zero .and. event /= EVENT_CLOSES) high = low
         end if
         if (f_high > -zero) exit
      end do
      if (abs(h_trial - high) > 0.0_wp) call take_step(par, inc, high, trial, counters)
      h = high
   end subroutine land_on

   !> What Anderson and Bjoerck's false position leaves of the value at the end of the bracket that rests, after a new
   !> value on the other side.
   pure real(wp) function remaining(new, old)
      real(wp), intent(in) :: new, old

      remaining = 0.5_wp
      if (abs(new) < abs(old)) remaining = 1.0_wp - new/old
   end function remaining

   !> Function of an event, dimensionless, negative beyond it.
   pure subroutine event_function(par, inc, event, trial, time, y, counters, f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial       !< where the substep began
      real(wp), intent(in) :: time, y(NY)
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: f
      type(rate_t) :: w
      real(wp) :: p, r(6)

      call stress_ratio(par, y(1:6), p, r)
      select case (event)
      case (EVENT_OPENS)
         f = trace(y(1:6))/(3.0_wp*par%p_min) - 1.0_wp
      case (EVENT_BOUNDS)
         f = allowed_excess(par, inc, trial) - excess(par, psi_at(par, inc, time, p), r)
      case (EVENT_REVERSAL)
         call rate_of(par, inc, time, y, trial%r_in, trial%mode, w, counters)
         f = w%x + par%x_rev
      case (EVENT_MECHANISM)
         call rate_of(par, inc, time, y, trial%r_in, trial%mode, w, counters)
         f = w%iso_drive/trial%w(1)%iso_drive
      case (EVENT_TURN)
         call rate_of(par, inc, time, y, trial%r_in, trial%mode, w, counters)
         f = forwardness(par, place_of(par, inc, trial, w, y))
      case (EVENT_RETURN)
         f = -beyond_target(par, trial%process, r, bounding_ratio(par, psi_at(par, inc, time, p)))
      case default
         call rate_of(par, inc, time, y, r, closing_mode(inc), w, counters)
         f = -closing_rate(inc, trial, w)/(w%k*norm(inc%d_strain) + abs(inc%d_pc))
      end select
   end subroutine event_function

   !> How a held point would go on if it closed: inside the elastic domain without plastic dilatancy. One of
   !> MODE_ORDINARY and MODE_ELASTIC.
   pure integer function closing_mode(inc)
      type(increment_t), intent(in) :: inc

      closing_mode = merge(MODE_ELASTIC, MODE_ORDINARY, inc%inside)
   end function closing_mode

   !> Share of the elastic rate at which an open point closes [-].
   pure real(wp) function closing_share(trial)
      type(trial_t), intent(in) :: trial

      closing_share = min(CLOSING*CLOSING_GROWTH**max(trial%openings - 1, 0), LARGEST_CLOSING)
   end function closing_share

   !> How far the rate of p' is above the one at which an open point closes, positive if it closes [kPa].
   !> docs/theory/material.md sections 6.1, 6.3.
   pure real(wp) function closing_rate(inc, trial, w)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(in) :: w        !< at p_min, without a past

      closing_rate = w%d_p - closing_share(trial)*(w%k*norm(inc%d_strain) + abs(inc%d_pc))
   end function closing_rate

   !> Its change with the rate of p', the void ratio, the strain and the suction step [kPa]. e, de and d_strain [-],
   !> d_rate and d_pc [kPa]; e is the void ratio at the place. Derivative of docs/theory/material.md sections 6.1, 6.3.
   pure real(wp) function change_of_closing_rate(inc, trial, w, e, d_rate, de, d_strain, d_pc) result(change)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: e, d_rate, de, d_strain(6), d_pc
      real(wp) :: length

      length = norm(inc%d_strain)
      change = w%k*length*de*(1.0_wp/(1.0_wp + e) - 1.0_wp/e) + sign(1.0_wp, inc%d_pc)*d_pc
      if (length > 0.0_wp) change = change + w%k*ddot(inc%d_strain, d_strain)/length
      change = d_rate - closing_share(trial)*change
   end function change_of_closing_rate

   !> How far r may be beyond the bounding surface in a substep inside the elastic domain: from farther outside it is
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

      psi_at = state_parameter(par, inc%bonded, void_ratio_at(inc, time), suction_at(inc, time), p)
   end function psi_at
end module mud_events
