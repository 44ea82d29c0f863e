! SPDX-License-Identifier: MIT
!> How far two histories of one quantity lie apart whose times are not the same.
module history_distance
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: farthest, peak_difference

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

   !> Largest difference of the peaks of two histories, magnitudes, one for each time that the first is not 0. The
   !> second is looked at from the middle of the gap before to the middle of the gap after. A gap shorter than what is
   !> not 0 before it is none: a body that rattles is in contact. In the unit of the values.
   pure real(wp) function peak_difference(time, values, other_time, other_values) result(apart)
      real(wp), intent(in) :: time(:), values(:)               !< Ascending [s] (times)
      real(wp), intent(in) :: other_time(:), other_values(:)   !< As many each; times ascending [s].
      real(wp) :: from, until
      integer :: first, last, next

      apart = 0.0_wp
      first = next_contact(1)
      from = -huge(1.0_wp)
      do while (first <= size(time))
         last = end_of_contact(first)
         do
            next = next_contact(last + 1)
            if (next > size(time)) exit
            if (time(next) - time(last) > time(last) - time(first)) exit
            last = end_of_contact(next)
         end do
         until = huge(1.0_wp)
         if (next <= size(time)) until = 0.5_wp*(time(last) + time(next))
         apart = max(apart, abs(maxval(abs(values(first:last))) - maxval([0.0_wp, pack(abs(other_values), &
            other_time >= from .and. other_time < until)])))
         from = until
         first = next
      end do
   contains
      !> First row from a row on that is not 0; beyond the last if there is none.
      pure integer function next_contact(row)
         integer, intent(in) :: row

         do next_contact = row, size(values)
            if (abs(values(next_contact)) > 0.0_wp) return
         end do
      end function next_contact

      !> Last row of those from a row on that are not 0.
      pure integer function end_of_contact(row)
         integer, intent(in) :: row

         do end_of_contact = row, size(values) - 1
            if (.not. abs(values(end_of_contact + 1)) > 0.0_wp) return
         end do
      end function end_of_contact
   end function peak_difference
end module history_distance
