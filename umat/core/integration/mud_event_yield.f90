! SPDX-License-Identifier: MIT
!> Event: compression reaches what the isotropic mechanism remembers; docs/theory/material.md section 4.10.
module mud_event_yield
   use mud_event, only: event_t, event_changes_t, NO_RATE, BEYOND, BY_MEMORY, ORDINARY, ELASTIC, EXACT, EXACT_TRIALS
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_mechanism, only: reaches_memory, short_of_memory, forget_compression
   use mud_params, only: params_t
   use mud_state, only: state_t
   use mud_tensor, only: DIRECTIONS
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: YIELD, may_yield, yield_function, slopes_of_yield, yielded

   type(event_t), parameter :: YIELD = &
      event_t(ORDINARY .or. ELASTIC, NO_RATE, BEYOND, .true., BY_MEMORY, EXACT, EXACT_TRIALS)
contains
   !> True of a substep h from below the memory to beyond it.
   pure logical function may_yield(par, inc, trial, h)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h

      may_yield = reaches_memory(par, inc, trial, h)
   end function may_yield

   !> Margin to the memory at a pseudo-time [-].
   pure real(wp) function yield_function(par, inc, trial, time) result(f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time

      f = short_of_memory(par, inc, trial, time)
   end function yield_function

   !> Changes of the margin to the memory [-].
   pure function slopes_of_yield(c) result(slopes)
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(DIRECTIONS)

      slopes = c%mechanism
   end function slopes_of_yield

   !> The point is at its memory.
   pure subroutine yielded(state)
      type(state_t), intent(inout) :: state

      call forget_compression(state)
   end subroutine yielded
end module mud_event_yield
