! SPDX-License-Identifier: MIT
!> Event: a process ceases to go forwards; its substep goes on, and the place is noted (mud_events);
!> docs/theory/memory-rules.md section 3.2.
module mud_event_turn
   use mud_event, only: event_t, RATE_THERE, AT, NOTHING, NOBODY, NEARLY, FEW_TRIALS, elastic_rate
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio
   use mud_return_point, only: place_t, place_at
   use mud_tensor, only: norm
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: TURN, place_of

   !> The function is projection_on_chord.
   type(event_t), parameter :: TURN = event_t(NOBODY, RATE_THERE, AT, NOTHING, NEARLY, FEW_TRIALS)
contains
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
end module mud_event_turn
