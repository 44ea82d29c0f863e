! SPDX-License-Identifier: MIT
!> Event: contraction turns to dilation or back, where an option makes that a kink of the rates; docs/theory/material.md
!> section 4.9.
module mud_event_dilates
   use mud_event, only: event_t, RATE_THERE, BEFORE, BY_RATE, ORDINARY, SHARP_KINK, switches
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: DILATES, may_dilate

   !> The function is D over that at the start.
   type(event_t), parameter :: DILATES = event_t(ORDINARY, RATE_THERE, BEFORE, BY_RATE)
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
end module mud_event_dilates
