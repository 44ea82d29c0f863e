! SPDX-License-Identifier: MIT
!> Symmetric second-order tensors as six components 11, 22, 33, 12, 13, 23 with TENSOR shear (not engineering).
!> Every contraction of the core goes through this module, for each shear component stands for two.
module mud_tensor
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: IDENTITY, SHEAR_WEIGHT, ddot, trace, deviator, norm, square, is_finite, within, all_finite, all_within, &
             all_zero, &
             outer_add, outer_sum, rotate, DIRECTIONS, contractions, tensors_t, contracted, traces, ZERO_TENSORS, &
             UNIT_STRAINS, ANY_TENSORS, strain_directions

   !> Directions of a derivative that are worked on side by side: six strains, the suction and an idle one, for an even
   !> number the compiler takes two at a time.
   integer, parameter :: DIRECTIONS = 8
   integer, parameter :: ZERO_TENSORS = 0   !< All are zero.
   integer, parameter :: UNIT_STRAINS = 1   !< The first six are unit engineering strains, the others zero.
   integer, parameter :: ANY_TENSORS = 2    !< Nothing is known of them.

   !> Tensors side by side, such as the changes of a strain along some directions, and what spares a contraction.
   type :: tensors_t
      real(wp) :: of(DIRECTIONS, 6)
      integer :: kind
   end type tensors_t

   real(wp), parameter :: IDENTITY(6) = [1.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   !> Number of places at which a stored component stands in the 3 x 3 matrix.
   real(wp), parameter :: SHEAR_WEIGHT(6) = [1.0_wp, 1.0_wp, 1.0_wp, 2.0_wp, 2.0_wp, 2.0_wp]
   integer(int64), parameter :: EXPONENT_BITS = int(z'7FF0000000000000', int64)   !< All set: NaN or infinity.
   !> All bits but the sign's: as whole numbers they are ordered as magnitudes are, and what is not finite is largest.
   integer(int64), parameter :: MAGNITUDE = huge(0_int64), LARGEST = transfer(huge(1.0_wp), 0_int64)
contains
   !> Unit engineering strains as tensors, one a direction [-].
   pure function strain_directions() result(unit)
      type(tensors_t) :: unit
      integer :: j

      unit%of = 0.0_wp
      do j = 1, 6
         unit%of(j, j) = merge(1.0_wp, 0.5_wp, j <= 3)
      end do
      unit%kind = UNIT_STRAINS
   end function strain_directions

   !> Full contraction a:b. In the unit of a times that of b.
   pure real(wp) function ddot(a, b)
      real(wp), intent(in) :: a(6), b(6)

      ddot = a(1)*b(1) + a(2)*b(2) + a(3)*b(3) + 2.0_wp*(a(4)*b(4) + a(5)*b(5) + a(6)*b(6))
   end function ddot

   !> Contractions of tensors side by side with one. Number i is tensors(i, :) : a, in the unit of the tensors times
   !> that of a.
   pure function contractions(tensors, a) result(c)
      real(wp), intent(in) :: tensors(DIRECTIONS, 6), a(6)
      real(wp) :: c(DIRECTIONS)

      c = a(1)*tensors(:, 1) + a(2)*tensors(:, 2) + a(3)*tensors(:, 3) &
          + (2.0_wp*a(4))*tensors(:, 4) + (2.0_wp*a(5))*tensors(:, 5) + (2.0_wp*a(6))*tensors(:, 6)
   end function contractions

   !> Contraction of tensors of a known kind with a tensor a. In the unit of the tensors times that of a.
   pure function contracted(tensors, a) result(c)
      type(tensors_t), intent(in) :: tensors
      real(wp), intent(in) :: a(6)
      real(wp) :: c(DIRECTIONS)

      select case (tensors%kind)
      case (ZERO_TENSORS)
         c = 0.0_wp
      case (UNIT_STRAINS)
         c(1:6) = a
         c(7:) = 0.0_wp
      case default
         c = contractions(tensors%of, a)
      end select
   end function contracted

   !> Traces of tensors side by side, in their unit.
   pure function traces(tensors) result(c)
      type(tensors_t), intent(in) :: tensors
      real(wp) :: c(DIRECTIONS)

      select case (tensors%kind)
      case (ZERO_TENSORS)
         c = 0.0_wp
      case (UNIT_STRAINS)
         c(1:3) = 1.0_wp
         c(4:) = 0.0_wp
      case default
         c = tensors%of(:, 1) + tensors%of(:, 2) + tensors%of(:, 3)
      end select
   end function traces

   !> Trace of a, in its unit.
   pure real(wp) function trace(a)
      real(wp), intent(in) :: a(6)

      trace = a(1) + a(2) + a(3)
   end function trace

   !> Deviator of a, a - tr(a)/3 I, in the unit of a.
   pure function deviator(a) result(s)
      real(wp), intent(in) :: a(6)
      real(wp) :: s(6), mean

      mean = trace(a)/3.0_wp
      s = a
      s(1:3) = s(1:3) - mean
   end function deviator

   !> Frobenius norm, the square root of a:a, in the unit of a.
   pure real(wp) function norm(a)
      real(wp), intent(in) :: a(6)

      norm = sqrt(ddot(a, a))
   end function norm

   !> Matrix square a.a of a symmetric tensor; ddot(square(a), b) = tr(a a b). In the unit of a squared.
   pure function square(a) result(c)
      real(wp), intent(in) :: a(6)
      real(wp) :: c(6)

      c(1) = a(1)*a(1) + a(4)*a(4) + a(5)*a(5)
      c(2) = a(4)*a(4) + a(2)*a(2) + a(6)*a(6)
      c(3) = a(5)*a(5) + a(6)*a(6) + a(3)*a(3)
      c(4) = a(4)*(a(1) + a(2)) + a(5)*a(6)
      c(5) = a(5)*(a(1) + a(3)) + a(4)*a(6)
      c(6) = a(6)*(a(2) + a(3)) + a(4)*a(5)
   end function square

   !> True if x is neither NaN nor infinite. Looks at the exponent's bits: it never traps, and costs nothing, while a
   !> procedure that uses ieee_arithmetic saves and restores the whole floating-point environment.
   pure elemental logical function is_finite(x)
      real(wp), intent(in) :: x

      is_finite = iand(transfer(x, 0_int64), EXPONENT_BITS) /= EXPONENT_BITS
   end function is_finite

   !> Finite and of magnitude up to a limit, both in one unit. A NaN is not compared: a comparison would trap.
   pure logical function within(value, limit)
      real(wp), intent(in) :: value, limit

      within = is_finite(value)
      if (within) within = abs(value) <= limit
   end function within

   !> True if every number is finite, without a branch for each. x(:) of any size; true of none.
   pure logical function all_finite(x)
      real(wp), intent(in), contiguous :: x(:)
      integer(int64) :: marks
      integer :: i

      marks = 0
      do i = 1, size(x)
         marks = ior(marks, LARGEST - iand(transfer(x(i), 0_int64), MAGNITUDE))
      end do
      all_finite = marks >= 0
   end function all_finite

   !> True if every number is finite and of a magnitude up to its limit, without a branch for each. Nothing is compared
   !> as a number: it never traps. limits are finite and not negative, in the unit of x.
   pure logical function all_within(n, x, limits)
      integer, intent(in) :: n
      real(wp), intent(in) :: x(n), limits(n)
      integer(int64) :: marks
      integer :: i

      marks = 0
      do i = 1, n
         marks = ior(marks, transfer(limits(i), 0_int64) - iand(transfer(x(i), 0_int64), MAGNITUDE))
      end do
      all_within = marks >= 0
   end function all_within

   !> True if every number is +0, without a branch for each. x(:) of any size; true of none.
   pure logical function all_zero(x)
      real(wp), intent(in), contiguous :: x(:)
      integer(int64) :: marks
      integer :: i

      marks = 0
      do i = 1, size(x)
         marks = ior(marks, transfer(x(i), 0_int64))
      end do
      all_zero = marks == 0
   end function all_zero

   !> c <- c + a (x) b for a map from ENGINEERING strain to stress: the factor two of b:eps and the one of
   !> gamma = 2 eps cancel, so plain products of components are right. c is in the unit of a times that of b.
   pure subroutine outer_add(a, b, c)
      real(wp), intent(in) :: a(6), b(6)
      real(wp), intent(inout) :: c(6, 6)
      integer :: j

      do j = 1, 6
         c(:, j) = c(:, j) + a*b(j)
      end do
   end subroutine outer_add

   !> c = a (x) b + d (x) e, of the same kind. c is in the unit of a times that of b.
   pure subroutine outer_sum(a, b, d, e, c)
      real(wp), intent(in) :: a(6), b(6), d(6), e(6)
      real(wp), intent(out) :: c(6, 6)
      integer :: j

      do j = 1, 6
         c(:, j) = a*b(j) + d*e(j)
      end do
   end subroutine outer_sum

   !> R a R^T for a rotation matrix R(3,3). b is in the unit of a; that r is a rotation is not checked.
   pure function rotate(a, r) result(b)
      real(wp), intent(in) :: a(6), r(3, 3)
      real(wp) :: b(6), full(3, 3)

      full(:, 1) = [a(1), a(4), a(5)]
      full(:, 2) = [a(4), a(2), a(6)]
      full(:, 3) = [a(5), a(6), a(3)]
      full = matmul(r, matmul(full, transpose(r)))
      b = [full(1, 1), full(2, 2), full(3, 3), full(1, 2), full(1, 3), full(2, 3)]
   end function rotate
end module mud_tensor
