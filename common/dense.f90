! SPDX-License-Identifier: MIT
!> Small dense systems; the only module that knows LAPACK.
module dense
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: solve, outer

   !> A pivot below this share of its row, after rows were scaled to 1, is rounding.
   real(wp), parameter :: SINGULAR = 1.0e-13_wp

   interface
      pure subroutine dgetrf(m, n, a, lda, ipiv, info)
         import :: wp
         integer, intent(in) :: m, n, lda
         real(wp), intent(inout) :: a(lda, *)
         integer, intent(out) :: ipiv(*), info
      end subroutine dgetrf

      pure subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: wp
         character, intent(in) :: trans
         integer, intent(in) :: n, nrhs, lda, ldb, ipiv(*)
         real(wp), intent(in) :: a(lda, *)
         real(wp), intent(inout) :: b(ldb, *)
         integer, intent(out) :: info
      end subroutine dgetrs
   end interface
contains
   !> Solves a square system: LU factors of the matrix whose rows are scaled to 1, with partial pivoting. `good` is
   !> false, and x is zero, for a matrix that is singular or not finite. matrix(n, n), right(n); x in the unit of right
   !> over that of the matrix. LAPACK's dgetrf and dgetrs; a pivot of a scaled row below 1e-13 counts as zero.
   pure subroutine solve(matrix, right, x, good)
      real(wp), intent(in) :: matrix(:, :), right(:)
      real(wp), intent(out) :: x(size(right))
      logical, intent(out) :: good
      real(wp) :: factors(size(right), size(right)), b(size(right), 1), scale
      integer :: pivots(size(right)), i, n, info

      n = size(right)
      x = 0.0_wp
      do i = 1, n
         scale = maxval(abs(matrix(i, :)))
         good = scale > 0.0_wp .and. scale <= huge(scale)
         if (.not. good) return
         factors(i, :) = matrix(i, :)/scale
         b(i, 1) = right(i)/scale
      end do
      call dgetrf(n, n, factors, n, pivots, info)
      good = info == 0
      do i = 1, n
         ! Not the other way round: a pivot that is not a number is no good either.
         good = good .and. abs(factors(i, i)) > SINGULAR
      end do
      if (.not. good) return
      call dgetrs('N', n, 1, factors, n, pivots, b, n, info)
      x = b(:, 1)
   end subroutine solve

   !> Makes the outer product a b^T. product(i, j) = a(i) b(j), in the product of their units.
   pure function outer(a, b) result(product)
      real(wp), intent(in) :: a(:), b(:)
      real(wp) :: product(size(a), size(b))
      integer :: j

      do j = 1, size(b)
         product(:, j) = a*b(j)
      end do
   end function outer
end module dense
