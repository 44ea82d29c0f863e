! SPDX-License-Identifier: MIT
!> Event: the gap of a held point begins or ends, at a place in closed form; docs/theory/material.md section 6.4.
module mud_event_parts
   use mud_cutoff, only: SHUT
   use mud_event, only: event_t, NO_RATE, AT, BY_STATE, HELD
   use mud_increment, only: increment_t, void_ratio_at
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: PARTS, end_at_parting

   !> The function is the void ratio.
   type(event_t), parameter :: PARTS = event_t(HELD, NO_RATE, AT, BY_STATE)
contains
   !> Ends a held substep h, which begins at a pseudo-time, where its gap begins or ends; shares of inc [-]. h stays
   !> where the gap does neither. docs/theory/integration.md section 4.2.
   pure subroutine end_at_parting(inc, parts, time, h, ends)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, time   !< parts: that of parting
      real(wp), intent(inout) :: h
      logical, intent(out) :: ends
      real(wp) :: before, after

      before = void_ratio_at(inc, time) - parts
      after = void_ratio_at(inc, time + h) - parts
      ends = before*after < 0.0_wp .and. min(abs(before), abs(after)) > SHUT*(1.0_wp + parts)
      if (ends) h = log((1.0_wp + inc%e0)/(1.0_wp + parts))/inc%d_v - time
   end subroutine end_at_parting
end module mud_event_parts
