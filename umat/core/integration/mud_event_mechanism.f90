! SPDX-License-Identifier: MIT
!> Event: the isotropic mechanism begins or ends to act while suction changes; docs/theory/material.md section 4.4.
module mud_event_mechanism
   use mud_event, only: event_t, RATE_THERE, BEFORE, BY_MECHANISM, ORDINARY, SHARP_KINK, switches
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: MECHANISM, mechanism_may_switch

   !> The function is the drive of the mechanism over that at the start.
   type(event_t), parameter :: MECHANISM = event_t(ORDINARY, RATE_THERE, BEFORE, BY_MECHANISM)
contains
   !> True of a substep with an error that a kink may have made [-], and where the isotropic mechanism begins or ends to
   !> act. Its rates have a kink there, which is sharp while suction changes: a substep across it has an error that
   !> depends on where in it the kink lies, and Newton's method in a host sees that as noise.
   pure logical function mechanism_may_switch(par, inc, trial, error)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: error

      mechanism_may_switch = error > SHARP_KINK*par%tolerance .and. inc%suction%bonds .and. abs(inc%d_pc) > 0.0_wp
      if (mechanism_may_switch) &
         mechanism_may_switch = switches(trial%w(1)%iso_drive, trial%w(inc%scheme%stages)%iso_drive)
   end function mechanism_may_switch
end module mud_event_mechanism
