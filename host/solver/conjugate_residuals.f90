! SPDX-License-Identifier: MIT
!> Linear systems by factors that may belong to an earlier matrix: generalised conjugate residuals (Eisenstat, Elman,
!> Schultz 1983; the iterates are those of GMRES) with the factors as preconditioner. With the factors of the matrix
!> itself the first step is the direct solution, the second an iterative refinement.
!> docs/theory/host.md section 6.
module conjugate_residuals
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use kinds, only: wp
   use sparse_factors, only: sparse_t, backsolve, times, SOLVED
   implicit none (type, external)
   private
   public :: solve_by_factors, INACCURATE, NOT_FINITE

   integer, parameter :: INACCURATE = 3       !< The steps allowed did not reach the target.
   integer, parameter :: NOT_FINITE = 4       !< Numbers of the equations are not, or overflow.
   real(wp), parameter :: ROUNDING = 1.0e-14_wp   !< Share of the right side that no step gets below.
contains
   !> x with |W (b - A x)| <= target, W = diag(weight), in at most `most` steps. After INACCURATE x is the best found;
   !> after another it is of no use. Eisenstat, Elman, Schultz (1983): docs/theory/host.md section 6.
   subroutine solve_by_factors(sparse, values, b, weight, target, most, x, steps, status)
      type(sparse_t), intent(inout) :: sparse
      real(wp), intent(in) :: values(:), b(:), weight(:)   !< (entries) of A; (n); (n), > 0.
      real(wp), intent(in) :: target
      integer, intent(in) :: most
      real(wp), intent(out) :: x(:)   !< (n)
      integer, intent(out) :: steps, status   !< Steps taken; SOLVED, INACCURATE, NOT_FINITE or as of backsolve.
      real(wp) :: z(size(b), most), w(size(b), most), r(size(b)), share, enough, left
      integer :: j

      x = 0.0_wp
      r = weight*b
      left = norm2(r)
      enough = max(target, ROUNDING*left)
      steps = 0
      status = merge(SOLVED, NOT_FINITE, ieee_is_finite(left))
      if (status /= SOLVED) return
      do while (left > enough .and. steps < most)
         steps = steps + 1
         associate (k => steps)
            call backsolve(sparse, values, r/weight, z(:, k), status)
            if (status /= SOLVED) return
            call times(sparse, values, z(:, k), w(:, k))
            w(:, k) = weight*w(:, k)
            do j = 1, k - 1
               share = dot_product(w(:, j), w(:, k))
               w(:, k) = w(:, k) - share*w(:, j)
               z(:, k) = z(:, k) - share*z(:, j)
            end do
            share = norm2(w(:, k))
            if (.not. (ieee_is_finite(share) .and. share > 0.0_wp)) then
               status = NOT_FINITE
               return
            end if
            w(:, k) = w(:, k)/share
            z(:, k) = z(:, k)/share
            share = dot_product(w(:, k), r)
            x = x + share*z(:, k)
            r = r - share*w(:, k)
            left = norm2(r)
         end associate
      end do
      if (left > enough) status = INACCURATE
   end subroutine solve_by_factors
end module conjugate_residuals
