! SPDX-License-Identifier: MIT
!> Sparse solution by the factors of UMFPACK, the only module that knows it. Rows are given to it as columns of the
!> transpose. The factors may belong to an earlier matrix: generalised conjugate residuals (Eisenstat, Elman, Schultz
!> 1983; the iterates are those of GMRES) have them as preconditioner. With the factors of the matrix itself the first
!> step is the direct solution, the second an iterative refinement. docs/theory/host.md section 6.
module sparse_factors
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_ptr, c_null_ptr, c_associated
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: sparse_t, analyse, factorise, solve_by_factors, times, release
   public :: SOLVED, SINGULAR, FAILED, INACCURATE, NOT_FINITE, RCOND_SINGULAR

   integer, parameter :: SOLVED = 0, SINGULAR = 1, FAILED = 2
   integer, parameter :: INACCURATE = 3       !< The steps allowed did not reach the target.
   integer, parameter :: NOT_FINITE = 4       !< Numbers of the equations are not, or overflow.
   real(wp), parameter :: ROUNDING = 1.0e-14_wp   !< Share of the right side that no step gets below.
   ! Places in UMFPACK's arrays (umfpack.h), from 1 here.
   integer, parameter :: CONTROLS = 20, INFOS = 90, CONTROL_STRATEGY = 6, CONTROL_REFINEMENT = 8, &
                         CONTROL_ORDERING = 11, INFO_RCOND = 68, INFO_LNZ = 44, INFO_UNZ = 45
   real(c_double), parameter :: AMD = 1.0_c_double, METIS = 3.0_c_double
   !> Unknowns beyond which METIS saves more in the factors than its ordering costs: docs/theory/host.md section 6.
   integer, parameter :: MANY = 10000
   real(c_double), parameter :: STRATEGY_SYMMETRIC = 3.0_c_double
   integer(c_int), parameter :: TRANSPOSED = 1, WARNING_SINGULAR = 1
   !> Ratio of the smallest to the largest pivot below which a pivot is rounding: a body that nothing holds gives 1e-15,
   !> the scenes of the verification 1e-8 and more [-].
   real(wp), parameter :: RCOND_SINGULAR = 1.0e-13_wp

   type :: sparse_t
      real(c_double) :: control(CONTROLS) = 0.0_c_double, info(INFOS) = 0.0_c_double
      integer(c_int), allocatable :: start(:), index(:)   !< The pattern, from 0.
      type(c_ptr) :: symbolic = c_null_ptr, numeric = c_null_ptr
      integer :: n_numeric = 0, n_solve = 0
      real(wp) :: entries = 0.0_wp                        !< In the factors.
   end type sparse_t

   interface
      subroutine umfpack_di_defaults(control) bind(c)
         import :: c_double
         real(c_double), intent(out) :: control(*)
      end subroutine umfpack_di_defaults

      integer(c_int) function umfpack_di_symbolic(n_row, n_col, ap, ai, ax, symbolic, control, info) bind(c)
         import :: c_int, c_double, c_ptr
         integer(c_int), value :: n_row, n_col
         integer(c_int), intent(in) :: ap(*), ai(*)
         type(c_ptr), value :: ax
         type(c_ptr), intent(out) :: symbolic
         real(c_double), intent(in) :: control(*)
         real(c_double), intent(out) :: info(*)
      end function umfpack_di_symbolic

      integer(c_int) function umfpack_di_numeric(ap, ai, ax, symbolic, numeric, control, info) bind(c)
         import :: c_int, c_double, c_ptr
         integer(c_int), intent(in) :: ap(*), ai(*)
         real(c_double), intent(in) :: ax(*)
         type(c_ptr), value :: symbolic
         type(c_ptr), intent(out) :: numeric
         real(c_double), intent(in) :: control(*)
         real(c_double), intent(out) :: info(*)
      end function umfpack_di_numeric

      integer(c_int) function umfpack_di_solve(sys, ap, ai, ax, x, b, numeric, control, info) bind(c)
         import :: c_int, c_double, c_ptr
         integer(c_int), value :: sys
         integer(c_int), intent(in) :: ap(*), ai(*)
         real(c_double), intent(in) :: ax(*), b(*)
         real(c_double), intent(out) :: x(*)
         type(c_ptr), value :: numeric
         real(c_double), intent(in) :: control(*)
         real(c_double), intent(out) :: info(*)
      end function umfpack_di_solve

      subroutine umfpack_di_free_symbolic(symbolic) bind(c)
         import :: c_ptr
         type(c_ptr), intent(inout) :: symbolic
      end subroutine umfpack_di_free_symbolic

      subroutine umfpack_di_free_numeric(numeric) bind(c)
         import :: c_ptr
         type(c_ptr), intent(inout) :: numeric
      end subroutine umfpack_di_free_numeric
   end interface
contains
   !> Orders the equations once per pattern and by the pattern alone: a run that is taken up again finds the same one.
   !> docs/theory/host.md section 6. Earlier factors are freed. status: SOLVED or FAILED.
   subroutine analyse(sparse, row, col, status)
      type(sparse_t), intent(inout) :: sparse
      integer, intent(in) :: row(:), col(:)   !< From 1. row: (n + 1), col: (entries), as of pattern_t.
      integer, intent(out) :: status

      call release(sparse)
      sparse%start = row - 1
      sparse%index = col - 1
      call umfpack_di_defaults(sparse%control)
      sparse%control(CONTROL_STRATEGY) = STRATEGY_SYMMETRIC
      sparse%control(CONTROL_REFINEMENT) = 0.0_c_double
      sparse%control(CONTROL_ORDERING) = merge(METIS, AMD, size(row) - 1 > MANY)
      status = merge(SOLVED, FAILED, umfpack_di_symbolic(size(row) - 1, size(row) - 1, sparse%start, sparse%index, &
                                                         c_null_ptr, sparse%symbolic, sparse%control, sparse%info) == 0)
   end subroutine analyse

   !> Factorises the matrix with these values; status is SOLVED, SINGULAR or FAILED. SINGULAR: a pivot is 0 or the
   !> smallest is below 1e-13 of the largest (docs/theory/host.md section 6); FAILED: any other refusal of UMFPACK, as
   !> by lack of memory. To be called after analyse.
   subroutine factorise(sparse, values, status)
      type(sparse_t), intent(inout) :: sparse
      real(wp), intent(in) :: values(:)   !< (entries)
      integer, intent(out) :: status
      integer(c_int) :: code

      if (c_associated(sparse%numeric)) call umfpack_di_free_numeric(sparse%numeric)
      code = umfpack_di_numeric(sparse%start, sparse%index, values, sparse%symbolic, sparse%numeric, &
                                sparse%control, sparse%info)
      status = SOLVED
      if (code == WARNING_SINGULAR) then
         status = SINGULAR
      else if (code /= 0) then
         status = FAILED
      else if (sparse%info(INFO_RCOND) < RCOND_SINGULAR) then
         status = SINGULAR
      end if
      sparse%entries = sparse%info(INFO_LNZ) + sparse%info(INFO_UNZ)
      sparse%n_numeric = sparse%n_numeric + 1
   end subroutine factorise

   !> Finds x with |W (b - A x)| <= target, W = diag(weight), in at most `most` steps. After INACCURATE x is the best
   !> found; after another it is of no use.
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

   !> Solves by the factors as they are; `values` is not looked at. status: SOLVED or FAILED. To be called after
   !> factorise.
   subroutine backsolve(sparse, values, b, x, status)
      type(sparse_t), intent(inout) :: sparse
      real(wp), intent(in) :: values(:), b(:)   !< (entries); (n).
      real(wp), intent(out) :: x(:)   !< (n)
      integer, intent(out) :: status

      status = merge(SOLVED, FAILED, umfpack_di_solve(TRANSPOSED, sparse%start, sparse%index, values, x, b, &
                                                      sparse%numeric, sparse%control, sparse%info) == 0)
      sparse%n_solve = sparse%n_solve + 1
   end subroutine backsolve

   !> Multiplies: y = A x.
   pure subroutine times(sparse, values, x, y)
      type(sparse_t), intent(in) :: sparse
      real(wp), intent(in) :: values(:), x(:)   !< (entries) of A; (n).
      real(wp), intent(out) :: y(:)   !< (n)
      real(wp) :: total
      integer :: i, k

      do i = 1, size(y)
         total = 0.0_wp
         do k = sparse%start(i) + 1, sparse%start(i + 1)
            total = total + values(k)*x(sparse%index(k) + 1)
         end do
         y(i) = total
      end do
   end subroutine times

   !> Frees the ordering and the factors.
   subroutine release(sparse)
      type(sparse_t), intent(inout) :: sparse

      if (c_associated(sparse%numeric)) call umfpack_di_free_numeric(sparse%numeric)
      if (c_associated(sparse%symbolic)) call umfpack_di_free_symbolic(sparse%symbolic)
      sparse%numeric = c_null_ptr
      sparse%symbolic = c_null_ptr
   end subroutine release
end module sparse_factors
