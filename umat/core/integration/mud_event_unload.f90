! SPDX-License-Identifier: MIT
!> Event: compression ceases, and the isotropic mechanism remembers how far it came; docs/theory/material.md
!> section 4.10.
module mud_event_unload
   use mud_event, only: event_t, RATE_THERE, BEYOND, NOTHING, ORDINARY, ELASTIC, EXACT, EXACT_TRIALS
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_mechanism, only: leaves_memory
   use mud_params, only: params_t
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: UNLOAD, may_unload

   !> The function is drive_to_memory; rates are smooth there.
   type(event_t), parameter :: UNLOAD = &
      event_t(ORDINARY .or. ELASTIC, RATE_THERE, BEYOND, .false., NOTHING, EXACT, EXACT_TRIALS)
contains
   !> True of a substep h at the memory that leaves it.
   pure logical function may_unload(par, inc, trial, h)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h

      may_unload = leaves_memory(par, inc, trial, h)
   end function may_unload
end module mud_event_unload
