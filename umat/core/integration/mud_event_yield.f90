! SPDX-License-Identifier: MIT
!> Event: compression reaches what the isotropic mechanism remembers; docs/theory/material.md section 4.10.
module mud_event_yield
   use mud_event, only: event_t, event_changes_t, NO_RATE, BEYOND, BY_MARGIN, ORDINARY, ELASTIC, EXACT, EXACT_TRIALS
   use mud_increment, only: increment_t
   use mud_isotropic_memory, only: margin_after
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_state, only: state_t
   use mud_tensor, only: LANES
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: YIELD, SMALL_MARGIN, may_yield, yield_function, slopes_of_yield, yielded

   type(event_t), parameter :: YIELD = &
      event_t(ORDINARY .or. ELASTIC, NO_RATE, BEYOND, .true., BY_MARGIN, EXACT, EXACT_TRIALS)

   !> A margin of the isotropic memory that a substep exceeds by less than this share of the tolerance, or a drive that
   !> leads as far below it, is not looked at [-].
   real(wp), parameter :: SMALL_MARGIN = 0.01_wp
contains
   !> True of a substep h from below the memory to beyond it.
   pure logical function may_yield(par, inc, trial, h)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h

      may_yield = inc%rests
      if (may_yield) may_yield = margin_after(par, inc, trial, h) > SMALL_MARGIN*par%tolerance
   end function may_yield

   !> Margin to the memory at a pseudo-time [-].
   pure real(wp) function yield_function(par, inc, trial, time) result(f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time

      f = -trial%margin
      if (time > trial%time) f = -margin_after(par, inc, trial, time - trial%time)
   end function yield_function

   !> Changes of the margin [-].
   pure function slopes_of_yield(c) result(slopes)
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(LANES)

      slopes = c%margin
   end function slopes_of_yield

   !> The point is at its memory.
   pure subroutine yielded(state)
      type(state_t), intent(inout) :: state

      state%margin = 0.0_wp
   end subroutine yielded
end module mud_event_yield
