! SPDX-License-Identifier: MIT
!> Event: p' falls to p_min; docs/theory/material.md section 6.1.
module mud_event_opens
   use mud_event, only: event_t, NO_RATE, AT, BY_STATE, ORDINARY, ELASTIC
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_tensor, only: trace
   implicit none (type, external)
   private
   public :: OPENS, height, height_rate

   !> The function is the height.
   type(event_t), parameter :: OPENS = event_t(ORDINARY .or. ELASTIC, NO_RATE, AT, BY_STATE)
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
end module mud_event_opens
