!> Small dense systems.
module triax_linear
   use, intrinsic :: iso_fortran_env, only: wp => real64
   implicit none (type, external)
   private
   public :: solve, outer

   !> A pivot below this share of its row, after rows were scaled to 1, is rounding.
   real(wp), parameter :: SINGULAR = 1.0e-13_wp
contains
   !> Gauss elimination with row scaling and pivots; `good` is false for a singular matrix.
   pure subroutine solve(matrix, right, x, good)
      real(wp), intent(in) :: matrix(:, :), right(:)
      real(wp), intent(out) :: x(size(right))
      logical, intent(out) :: good
      real(wp) :: a(size(right), size(right) + 1), row(size(right) + 1), scale
      integer :: i, j, pivot, n

      n = size(right)
      x = 0.0_wp
      do i = 1, n
         scale = maxval(abs(matrix(i, :)))
         good = scale > 0.0_wp
         if (.not. good) return
         a(i, :n) = matrix(i, :)/scale
         a(i, n + 1) = right(i)/scale
      end do
      do j = 1, n
         pivot = j - 1 + maxloc(abs(a(j:, j)), dim=1)
         good = abs(a(pivot, j)) > SINGULAR
         if (.not. good) return
         row = a(pivot, :)
         a(pivot, :) = a(j, :)
         a(j, :) = row/row(j)
         do i = j + 1, n
            a(i, :) = a(i, :) - a(i, j)*a(j, :)
         end do
      end do
      do i = n, 1, -1
         x(i) = a(i, n + 1) - dot_product(a(i, i + 1:n), x(i + 1:))
      end do
   end subroutine solve

   pure function outer(a, b) result(product)
      real(wp), intent(in) :: a(:), b(:)
      real(wp) :: product(size(a), size(b))
      integer :: j

      do j = 1, size(b)
         product(:, j) = a*b(j)
      end do
   end function outer
end module triax_linear
