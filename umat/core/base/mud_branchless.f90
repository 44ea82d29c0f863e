! SPDX-License-Identifier: MIT
!> Comparisons without a branch: what the compiler can work on at several places at once, and the same digits where it
!> does not.
module mud_branchless
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: positive, larger, smaller
contains
   !> max(a, 0).
   pure real(wp) function positive(a)
      real(wp), intent(in) :: a

      positive = 0.5_wp*(a + abs(a))
   end function positive

   !> max(a, b), where the rounding of b does not matter if a is the larger one by far.
   pure real(wp) function larger(a, b)
      real(wp), intent(in) :: a, b

      larger = b + positive(a - b)
   end function larger

   !> min(a, b), likewise.
   pure real(wp) function smaller(a, b)
      real(wp), intent(in) :: a, b

      smaller = a - positive(a - b)
   end function smaller
end module mud_branchless
