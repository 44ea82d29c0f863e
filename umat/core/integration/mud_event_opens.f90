! SPDX-License-Identifier: MIT
!> Event: p' falls to p_min; docs/theory/material.md section 6.1.
module mud_event_opens
   use mud_event, only: event_t, NO_RATE, AT, BY_STATE, ORDINARY, ELASTIC
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_tensor, only: trace
   implicit none (type, external)
   private
   public :: OPENS, height

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
end module mud_event_opens
