! SPDX-License-Identifier: MIT
!> Event: contraction turns to dilation or back, where an option makes that a kink of the rates; docs/theory/material.md
!> section 4.9.
module mud_event_dilates
   use mud_event, only: event_t, event_changes_t, RATE_THERE, BEFORE, BY_RATE, ORDINARY, EXACT, EXACT_TRIALS, &
      SHARP_KINK, switches
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_options, only: changes_of_flow
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_tensor, only: DIRECTIONS
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: DILATES, may_dilate, dilation_function, slopes_of_dilation

   type(event_t), parameter :: DILATES = event_t(ORDINARY, RATE_THERE, BEFORE, .true., BY_RATE, EXACT, EXACT_TRIALS)
contains
   !> True of a substep with an error that a kink may have made, and a kink [-].
   pure logical function may_dilate(par, inc, trial, error) result(may)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: error

      may = trial%w(1)%own%bends .and. error > SHARP_KINK*par%tolerance
      if (may) may = switches(trial%w(1)%d, trial%w(inc%scheme%stages)%d)
   end function may_dilate

   !> D over that at the start [-].
   pure real(wp) function dilation_function(trial, w)
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(in) :: w

      dilation_function = w%d/trial%w(1)%d
   end function dilation_function

   !> Changes of L D, which are those of D where it is 0, times a number.
   pure function slopes_of_dilation(w, c) result(slopes)
      type(rate_t), intent(in) :: w
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(DIRECTIONS)

      slopes = changes_of_flow(w%d, c%rates)
   end function slopes_of_dilation
end module mud_event_dilates
