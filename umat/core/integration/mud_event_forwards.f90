! SPDX-License-Identifier: MIT
!> Event: a process that drifts back from its beginning goes forwards; docs/theory/memory-rules.md section 1.2.
module mud_event_forwards
   use mud_event, only: event_t, event_changes_t, RATE_THERE, AT, BY_RATE, ORDINARY
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_rate, only: rate_t
   use mud_tensor, only: DIRECTIONS, contractions, ddot
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: FORWARDS, may_go_forwards, backwards, slopes_of_forwards

   !> The function is `backwards`.
   type(event_t), parameter :: FORWARDS = event_t(ORDINARY, RATE_THERE, AT, BY_RATE, trials=8)
contains
   !> True of a substep that begins backwards and may end forwards.
   pure logical function may_go_forwards(inc, trial) result(may)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial

      may = trial%drifts
      if (may) may = inc%scheme%first_same_as_last .or. backwards(trial%w(inc%scheme%stages)) <= 0.0_wp
   end function may_go_forwards

   !> Speed at which r moves against the loading direction, times p' [stress]. Without a direction it is backwards.
   !> docs/theory/memory-rules.md section 1.2.
   pure real(wp) function backwards(w)
      type(rate_t), intent(in) :: w

      backwards = w%g
      if (w%loading) backwards = w%r_n*w%d_p - ddot(w%d_sigma, w%n)
   end function backwards

   !> Changes of dr:n times p', at a stress ratio r [stress].
   pure function slopes_of_forwards(w, r, c) result(slopes)
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: r(6)
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(DIRECTIONS)

      slopes = contractions(c%rates(:, 1:6), w%n) + contractions(c%n, w%d_sigma - w%d_p*r) &
               - w%d_p*contractions(c%r, w%n) - (w%r_n/3.0_wp)*(c%rates(:, 1) + c%rates(:, 2) + c%rates(:, 3))
   end function slopes_of_forwards
end module mud_event_forwards
