! SPDX-License-Identifier: MIT
!> Stand-in for pFUnit where it is not installed: the assertions and the runner behind the .pf files.
module funit
   use, intrinsic :: iso_fortran_env, only: int32, int64, real64, output_unit
   implicit none (type, external)
   private
   public :: assertEqual, assertTrue, assertFalse, anyExceptions, SourceLocation
   public :: begin_test, end_test, end_suite

   !> Where an assertion stands.
   type :: SourceLocation
      character(len=64) :: file  !< name of the .pf file
      integer :: line            !< line of the annotation [-]
   end type SourceLocation

   !> Expected and actual of any rank up to 2; a scalar is expected of every element.
   interface assertEqual
      module procedure equal_real, equal_real_within, equal_integer, equal_long, equal_text
   end interface assertEqual

   !> Elements in array order.
   interface flat
      module procedure flat_real, flat_integer, flat_long
   end interface flat

   character(len=128) :: current = ''  !< the test that runs
   logical :: failing = .false.        !< it has failed
   integer :: n_passed = 0, n_failed = 0, n_matched = 0

contains

   !> Whether to run this test: all run unless names are given; `--list` prints the name instead.
   function begin_test(name) result(run)
      character(len=*), intent(in) :: name
      logical :: run
      character(len=128) :: argument
      integer :: i
      run = command_argument_count() == 0
      do i = 1, command_argument_count()
         call get_command_argument(i, argument)
         if (argument == '--list') write (output_unit, '(a)') name
         if (argument == name) run = .true.
      end do
      if (run) n_matched = n_matched + 1
      current = name
      failing = .false.
   end function begin_test

   !> Count the test that has run. Flushed, so that a later crash loses nothing.
   subroutine end_test()
      if (failing) then
         n_failed = n_failed + 1
      else
         n_passed = n_passed + 1
      end if
      flush (output_unit)
   end subroutine end_test

   !> Closing line and exit code.
   subroutine end_suite()
      character(len=128) :: argument
      call get_command_argument(1, argument)
      if (argument == '--list') stop
      if (n_matched < max(1, command_argument_count())) then
         write (output_unit, '(a)') 'FAILED no test of that name: see --list'
         n_failed = n_failed + 1
      end if
      write (output_unit, '(i0,a,i0,a)') n_passed, ' passed, ', n_failed, ' failed'
      flush (output_unit)
      if (n_failed > 0) stop 1, quiet=.true.
      stop 0, quiet=.true.
   end subroutine end_suite

   !> Whether the running test has failed; the annotations return then.
   logical function anyExceptions()
      anyExceptions = failing
   end function anyExceptions

   subroutine assertTrue(condition, message, location)
      logical, intent(in) :: condition
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      if (.not. condition) call complain('expected true', message, location)
   end subroutine assertTrue

   subroutine assertFalse(condition, message, location)
      logical, intent(in) :: condition
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      if (condition) call complain('expected false', message, location)
   end subroutine assertFalse

   subroutine equal_real(expected, actual, message, location)
      real(real64), intent(in) :: expected(..), actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      call equal_real_within(expected, actual, 0.0_real64, message, location)
   end subroutine equal_real

   subroutine equal_real_within(expected, actual, tolerance, message, location)
      real(real64), intent(in) :: expected(..), actual(..)
      real(real64), intent(in) :: tolerance  !< absolute
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      real(real64), allocatable :: e(:), a(:)
      character(len=200) :: text
      integer :: i
      if (.not. conformable(shape(expected), shape(actual), message, location)) return
      a = flat(actual)
      e = flat(expected)
      if (rank(expected) < rank(actual)) e = spread(e(1), 1, size(a))
      do i = 1, size(a)
         if (close_enough(e(i), a(i), tolerance)) cycle
         write (text, '(3(a,g0),a,i0)') 'expected ', e(i), ', actual ', a(i), ', tolerance ', tolerance, ', element ', i
         call complain(trim(text), message, location)
         return
      end do
   end subroutine equal_real_within

   subroutine equal_integer(expected, actual, message, location)
      integer(int32), intent(in) :: expected(..), actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      if (.not. conformable(shape(expected), shape(actual), message, location)) return
      call compare_long(flat(expected), flat(actual), message, location)
   end subroutine equal_integer

   subroutine equal_long(expected, actual, message, location)
      integer(int64), intent(in) :: expected(..), actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      if (.not. conformable(shape(expected), shape(actual), message, location)) return
      call compare_long(flat(expected), flat(actual), message, location)
   end subroutine equal_long

   !> `expected` has one element (of a scalar) or as many as `actual`.
   subroutine compare_long(expected, actual, message, location)
      integer(int64), intent(in) :: expected(:), actual(:)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      character(len=200) :: text
      integer :: i
      do i = 1, size(actual)
         if (expected(min(i, size(expected))) == actual(i)) cycle
         write (text, '(*(a,i0))') 'expected ', expected(min(i, size(expected))), ', actual ', actual(i), ', no. ', i
         call complain(trim(text), message, location)
         return
      end do
   end subroutine compare_long

   !> As pFUnit by default: blanks at either end do not count.
   subroutine equal_text(expected, actual, message, location)
      character(len=*), intent(in) :: expected, actual
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      if (adjustl(expected) == adjustl(actual)) return
      call complain('expected "' // trim(expected) // '", actual "' // trim(actual) // '"', message, location)
   end subroutine equal_text

   !> Never true of a NaN. By bits where a value is not finite, because comparing a NaN traps in the debug build.
   pure logical function close_enough(e, a, tolerance)
      real(real64), intent(in) :: e, a, tolerance
      integer(int64), parameter :: EXPONENT_BITS = int(z'7FF0000000000000', int64)
      integer(int64) :: e_bits, a_bits
      e_bits = transfer(e, e_bits)
      a_bits = transfer(a, a_bits)
      if (all(iand([e_bits, a_bits], EXPONENT_BITS) /= EXPONENT_BITS)) then
         close_enough = abs(a - e) <= tolerance
      else
         close_enough = e_bits == a_bits .and. ibclr(a_bits, 63) == EXPONENT_BITS
      end if
   end function close_enough

   !> Shapes agree, or the expected value is a scalar.
   logical function conformable(expected, actual, message, location)
      integer, intent(in) :: expected(:), actual(:)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      character(len=200) :: text
      conformable = size(expected) == 0 .and. size(actual) <= 2
      if (size(expected) == size(actual)) conformable = size(actual) <= 2 .and. all(expected == actual)
      if (conformable) return
      write (text, '(*(g0,:," "))') 'expected shape', expected, 'but actual shape', actual
      call complain(trim(text), message, location)
   end function conformable

   !> Report the failure and mark the running test as failed.
   subroutine complain(text, message, location)
      character(len=*), intent(in) :: text
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in) :: location
      failing = .true.
      write (output_unit, '(5a,i0,2a)', advance='no') 'FAILED ', trim(current), ' at ', trim(location%file), ':', &
         location%line, ': ', text
      if (present(message)) write (output_unit, '(a)', advance='no') '; ' // message
      write (output_unit, '()')
   end subroutine complain

   pure function flat_real(x) result(list)
      real(real64), intent(in) :: x(..)
      real(real64), allocatable :: list(:)
      select rank (x)
      rank (0); list = [x]
      rank (1); list = x
      rank (2); list = reshape(x, [size(x)])
      end select
   end function flat_real

   pure function flat_integer(x) result(list)
      integer(int32), intent(in) :: x(..)
      integer(int64), allocatable :: list(:)
      select rank (x)
      rank (0); list = [x]
      rank (1); list = x
      rank (2); list = reshape(x, [size(x)])
      end select
   end function flat_integer

   pure function flat_long(x) result(list)
      integer(int64), intent(in) :: x(..)
      integer(int64), allocatable :: list(:)
      select rank (x)
      rank (0); list = [x]
      rank (1); list = x
      rank (2); list = reshape(x, [size(x)])
      end select
   end function flat_long

end module funit
