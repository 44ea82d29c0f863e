! SPDX-License-Identifier: MIT
!> Turns of what goes to and fro.
module turns
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: follow
contains
   !> Follows a quantity: it turns where it comes back by more than the least swing from the farthest that it came.
   elemental subroutine follow(now, least, farthest, sense, turned)
      real(wp), intent(in) :: now
      real(wp), intent(in) :: least            !< In the unit of the quantity, >= 0.
      real(wp), intent(inout) :: farthest      !< The farthest since it turned last.
      integer, intent(inout) :: sense          !< Way that it goes, 1 or -1; 0: it has not moved by the least swing.
      integer, intent(inout) :: turned         !< Number of its turns so far.

      if (sense*(now - farthest) <= 0.0_wp) then
         if (abs(now - farthest) <= least) return
         if (sense /= 0) turned = turned + 1
         sense = merge(1, -1, now > farthest)
      end if
      farthest = now
   end subroutine follow
end module turns
