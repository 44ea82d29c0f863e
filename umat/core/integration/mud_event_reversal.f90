! SPDX-License-Identifier: MIT
!> Event: (r - r_in):n falls to -x_rev, and a new process begins; docs/theory/memory-rules.md section 1.2.
module mud_event_reversal
   use mud_error_control, only: changes_root
   use mud_event, only: event_t, event_changes_t, RATE_THERE, AT, BY_DRIVE, ORDINARY, last_rate
   use mud_increment, only: increment_t, rate_of, store_rate
   use mud_kinds, only: wp
   use mud_mechanism, only: turns_by_resting
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_state, only: counters_t
   use mud_substep, only: LARGEST_FACTOR, cubic_point
   use mud_tensor, only: DIRECTIONS, contractions, ddot
   use mud_trial, only: trial_t, take_step
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: REVERSAL, look_for_reversal, slopes_of_reversal

   !> The function is (r - r_in):n + x_rev.
   type(event_t), parameter :: REVERSAL = event_t(ORDINARY, RATE_THERE, AT, BY_DRIVE)

   real(wp), parameter :: PROBE_BELOW = 0.5_wp   !< A minimum below this share of x_rev above -x_rev is looked at [-].
   !> A reversal beyond which (r - r_in):n is farther from -x_rev than this share of its change may have been jumped
   !> over: where it can be found it is to 1e-12, but in substeps as short as h_min [-].
   real(wp), parameter :: FOUND = 1.0e-6_wp
contains
   !> Whether a reversal is possible in a substep h; where the path comes back h is shortened, and the trial with it.
   pure subroutine look_for_reversal(par, inc, h, trial, counters, possible)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(inout) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      logical, intent(out) :: possible
      logical :: rests
      real(wp) :: shorter

      possible = may_reverse(par, inc, trial)
      if (.not. possible) return
      call turns_by_resting(par, inc, trial, trial%time + h, trial%y, counters, rests)
      possible = .not. rests
      if (rests) return
      shorter = h
      call find_reversal(par, inc, trial, counters, shorter, possible)
      if (.not. possible .or. shorter >= h) return
      h = shorter
      call take_step(par, inc, h, trial, counters)
   end subroutine look_for_reversal

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
      call last_rate(par, inc, trial, h, w, counters)
      x_end = w%x + par%x_rev
      reverses = x_end < 0.0_wp
      if (reverses) return
      probe = trial
      if (changes_root(trial%w(1:inc%scheme%stages))) then
         if (all(trial%w(1:inc%scheme%stages)%x >= -par%x_rev)) return
         call take_step(par, inc, 0.5_wp*h, probe, counters)
         call last_rate(par, inc, probe, 0.5_wp*h, w, counters)
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
      call last_rate(par, inc, probe, lowest*h, w, counters)
      reverses = w%x < -par%x_rev
      if (reverses) h = lowest*h
   end subroutine find_reversal

   !> Changes of (r - r_in):n, at a stress ratio r, or where n jumps those of its drive.
   pure function slopes_of_reversal(par, trial, w, r, c) result(slopes)
      type(params_t), intent(in) :: par
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: r(6)
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(DIRECTIONS)

      if (jumps(par, trial, w)) then
         slopes = c%drive
      else
         slopes = contractions(c%r - c%r_in, w%n) + contractions(c%n, r - trial%r_in)
      end if
   end function slopes_of_reversal

   !> True where (r - r_in):n passes -x_rev in a jump: t and r have one direction only, as in triaxial states, t passes
   !> zero, and n becomes its opposite (or the root changes). The time of such a reversal is that of t, along n, at
   !> zero. A place that is known to h_min alone may be as far beyond -x_rev without a jump.
   pure logical function jumps(par, trial, w)
      type(params_t), intent(in) :: par
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(in) :: w      !< at the event

      jumps = -(w%x + par%x_rev) > FOUND*(abs(trial%w(1)%x) + par%x_rev)
      if (jumps) jumps = ddot(trial%w(1)%n, w%n) < 0.0_wp .or. changes_root([trial%w(1), w])
   end function jumps
end module mud_event_reversal
