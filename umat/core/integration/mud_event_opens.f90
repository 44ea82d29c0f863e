! SPDX-License-Identifier: MIT
!> Event: p' falls to p_min; docs/theory/material.md section 6.1.
module mud_event_opens
   use mud_event, only: event_t, event_changes_t, NO_RATE, AT, BY_STATE, ORDINARY, ELASTIC, EXACT, EXACT_TRIALS
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_tensor, only: DIRECTIONS, trace
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: OPENS, height, height_rate, slopes_of_opening, opened

   type(event_t), parameter :: OPENS = &
      event_t(ORDINARY .or. ELASTIC, NO_RATE, AT, .true., BY_STATE, EXACT, EXACT_TRIALS)
contains
   !> Height of p' above p_min, as a share of p_min [-]: a point opens where it passes zero. sigma' in the unit of
   !> p_atm. docs/theory/integration.md section 4.2.
   pure real(wp) function height(par, sigma)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6)

      height = trace(sigma)/(3.0_wp*par%p_min) - 1.0_wp
   end function height

   !> Rate of the height of p' above p_min [-], per unit of pseudo-time.
   pure real(wp) function height_rate(par, w)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w

      height_rate = w%d_p/par%p_min
   end function height_rate

   !> Changes of the height of p' above p_min with those of the stress, times 3 p_min. In the unit of p_atm.
   pure function slopes_of_opening(c) result(slopes)
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(DIRECTIONS)

      slopes = c%y(:, 1) + c%y(:, 2) + c%y(:, 3)
   end function slopes_of_opening

   !> The point has opened once more.
   pure subroutine opened(trial)
      type(trial_t), intent(inout) :: trial

      trial%openings = trial%openings + 1
   end subroutine opened
end module mud_event_opens
