! SPDX-License-Identifier: MIT
!> Event: compression ceases, and the isotropic mechanism remembers how far it came; docs/theory/material.md
!> section 4.10.
module mud_event_unload
   use mud_event, only: event_t, RATE_THERE, BEYOND, NOTHING, ORDINARY, ELASTIC, EXACT, EXACT_TRIALS
   use mud_event_yield, only: SMALL_MARGIN
   use mud_increment, only: increment_t
   use mud_isotropic_memory, only: drive_of_margin
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: UNLOAD, may_unload

   !> The function is drive_of_margin; rates are smooth there.
   type(event_t), parameter :: UNLOAD = &
      event_t(ORDINARY .or. ELASTIC, RATE_THERE, BEYOND, .false., NOTHING, EXACT, EXACT_TRIALS)
contains
   !> True of a substep h at the memory that leaves it.
   pure logical function may_unload(par, inc, trial, h)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h

      may_unload = par%remembers .and. .not. (inc%rests .or. trial%closed)
      if (.not. may_unload) return
      associate (w => trial%w(inc%scheme%stages))
         may_unload = h*drive_of_margin(par, inc, trial%time + h, w) < -SMALL_MARGIN*par%tolerance
      end associate
   end function may_unload
end module mud_event_unload
