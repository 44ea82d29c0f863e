!> A small linear system and the rotation of a tensor.
module walk_linear
   use, intrinsic :: iso_c_binding, only: c_double
   implicit none (type, external)
   private
   public :: wp, solve, rotated

   integer, parameter :: wp = c_double
contains
   !> Solves m x = b in place by elimination with row exchange.
   pure subroutine solve(m, b, singular)
      real(wp), intent(inout) :: m(6, 6), b(6)
      logical, intent(out) :: singular
      real(wp) :: row(6), value
      integer :: i, j, pivot

      singular = .true.
      do i = 1, 6
         pivot = i - 1 + maxloc(abs(m(i:6, i)), 1)
         if (abs(m(pivot, i)) <= 0.0_wp) return
         row = m(i, :)
         m(i, :) = m(pivot, :)
         m(pivot, :) = row
         value = b(i)
         b(i) = b(pivot)
         b(pivot) = value
         do j = i + 1, 6
            value = m(j, i)/m(i, i)
            m(j, :) = m(j, :) - value*m(i, :)
            b(j) = b(j) - value*b(i)
         end do
      end do
      do i = 6, 1, -1
         b(i) = (b(i) - dot_product(m(i, i + 1:6), b(i + 1:6)))/m(i, i)
      end do
      singular = .false.
   end subroutine solve

   !> R a R^T of a symmetric tensor with components 11, 22, 33, 12, 13, 23.
   pure function rotated(tensor, rotation) result(turned)
      real(wp), intent(in) :: tensor(6), rotation(3, 3)
      real(wp) :: turned(6), a(3, 3)

      a = reshape(tensor([1, 4, 5, 4, 2, 6, 5, 6, 3]), [3, 3])
      a = matmul(rotation, matmul(a, transpose(rotation)))
      turned = [a(1, 1), a(2, 2), a(3, 3), a(1, 2), a(1, 3), a(2, 3)]
   end function rotated
end module walk_linear
