! SPDX-License-Identifier: MIT
!> How far two histories of one quantity lie apart whose times are not the same.
module history_distance
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: farthest

contains
   !> The second less the first, where they are farthest apart at the times of the first: straight lines between the
   !> times of the second, constant outside them. 0 where the second has fewer than two. In the unit of the values.
   pure real(wp) function farthest(time, values, other_time, other_values) result(apart)
      real(wp), intent(in) :: time(:), values(:)               !< Ascending [s] (times)
      real(wp), intent(in) :: other_time(:), other_values(:)   !< As many each; times ascending [s].
      real(wp) :: share, here
      integer :: i, k

      apart = 0.0_wp
      if (size(other_time) < 2) return
      k = 1
      do i = 1, size(time)
         do while (k < size(other_time) - 1 .and. other_time(k + 1) < time(i))
            k = k + 1
         end do
         share = 0.0_wp
         if (other_time(k + 1) > other_time(k)) share = (time(i) - other_time(k))/(other_time(k + 1) - other_time(k))
         share = max(0.0_wp, min(1.0_wp, share))
         here = other_values(k) + share*(other_values(k + 1) - other_values(k)) - values(i)
         if (abs(here) > abs(apart)) apart = here
      end do
   end function farthest
end module history_distance
