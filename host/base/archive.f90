! SPDX-License-Identifier: MIT
!> Archive of a run: every part of a run names what it keeps in one procedure, which writes the values to a file or
!> restores them from it. The part's procedure does not ask which: `call archive%exchange('dt', dt, 's', 'next step')`.
!> An entry that is missing, or is not what the part expects, makes the archive damaged; the values stay as they are.
!> What kind of file it is, its extension knows.
module archive
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: archive_t

   real(wp), parameter :: LARGEST_WHOLE = 2.0_wp**53   !< Whole numbers are stored as real ones, exact up to here.

   type, abstract :: archive_t
      logical :: reading = .false.          !< Values are restored, not written.
      logical :: good = .true.              !< Every exchange so far has succeeded.
      character(:), allocatable :: within   !< Stands before the names of a part's values.
   contains
      !> One value or list, of the extent that it has, with its unit and meaning; a text has neither. Whole numbers may
      !> have a range.
      generic :: exchange => exchange_reals, exchange_whole, exchange_long, exchange_wholes, exchange_flag, &
                             exchange_text
      !> A list that need not be allocated, with its extent.
      generic :: exchange_allocatable => exchange_real_list, exchange_real_table, exchange_whole_list
      procedure :: enter, leave, refuse
      procedure(move_values_i), deferred :: move_values
      procedure(move_text_i), deferred :: move_text
      procedure(find_extents_i), deferred :: find_extents
      procedure, private :: exchange_reals, exchange_whole, exchange_long, exchange_wholes, exchange_flag, exchange_text
      procedure, private :: exchange_real_list, exchange_real_table, exchange_whole_list
   end type archive_t

   abstract interface
      !> Writes a number, list or table, or restores it where the archive has one of its extent; else the archive is
      !> damaged.
      subroutine move_values_i(self, name, values, unit, meaning)
         import :: archive_t, wp
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name, unit, meaning
         real(wp), intent(inout), contiguous :: values(..)
      end subroutine move_values_i

      !> Writes a text, or restores it; one that the archive does not have is blank.
      subroutine move_text_i(self, name, text)
         import :: archive_t
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name
         character(*), intent(inout) :: text
      end subroutine move_text_i

      !> Extents of a list or table of the archive; 0 where it has no such dimension, or is not there.
      function find_extents_i(self, name) result(extents)
         import :: archive_t
         class(archive_t), intent(in) :: self
         character(*), intent(in) :: name
         integer :: extents(2)
      end function find_extents_i
   end interface
contains
   !> Puts the name of a part before the names that follow, up to `leave`.
   subroutine enter(self, part)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: part

      self%within = self%within//part//'_'
   end subroutine enter

   !> Ends the part that was entered last.
   subroutine leave(self, part)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: part

      self%within = self%within(:len(self%within) - len(part) - 1)
   end subroutine leave

   !> Declares the archive damaged, for values that a part cannot have written.
   pure subroutine refuse(self)
      class(archive_t), intent(inout) :: self

      self%good = .false.
   end subroutine refuse

   !> Exchanges a number, a list or a table.
   subroutine exchange_reals(self, name, values, unit, meaning)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(wp), intent(inout), contiguous :: values(..)

      call self%move_values(self%within//name, values, unit, meaning)
   end subroutine exchange_reals

   !> Exchanges whole numbers. The archive is damaged where one is no whole number or lies outside the range.
   subroutine exchange_numbers(self, name, numbers, unit, meaning, least, most)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      integer(int64), intent(inout) :: numbers(:)
      real(wp), intent(in) :: least, most
      real(wp) :: values(size(numbers))

      values = real(numbers, wp)
      call self%exchange_reals(name, values, unit, meaning)
      if (.not. self%reading) return
      ! A comparison with what is no number may end the program.
      if (.not. all(ieee_is_finite(values))) then
         call self%refuse()
      else if (any(values < least .or. values > most .or. abs(values - anint(values)) > 0.0_wp)) then
         call self%refuse()
      else
         numbers = nint(values, int64)
      end if
   end subroutine exchange_numbers

   subroutine exchange_whole(self, name, value, unit, meaning, least, most)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      integer, intent(inout) :: value
      integer, intent(in), optional :: least, most   !< Range, ends included; else all that an integer can be.
      integer(int64) :: numbers(1)
      integer :: range(2)

      range = [-huge(0), huge(0)]
      if (present(least)) range(1) = least
      if (present(most)) range(2) = most
      numbers = value
      call exchange_numbers(self, name, numbers, unit, meaning, real(range(1), wp), real(range(2), wp))
      value = int(numbers(1))
   end subroutine exchange_whole

   !> Exchanges a count that may pass 2**31 and is never below 0.
   subroutine exchange_long(self, name, value, unit, meaning)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      integer(int64), intent(inout) :: value
      integer(int64) :: numbers(1)

      numbers = value
      call exchange_numbers(self, name, numbers, unit, meaning, 0.0_wp, LARGEST_WHOLE)
      value = numbers(1)
   end subroutine exchange_long

   subroutine exchange_wholes(self, name, values, unit, meaning)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      integer, intent(inout) :: values(:)
      integer(int64) :: numbers(size(values))

      numbers = values
      call exchange_numbers(self, name, numbers, unit, meaning, -real(huge(0), wp), real(huge(0), wp))
      values = int(numbers)
   end subroutine exchange_wholes

   subroutine exchange_flag(self, name, value, meaning)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      logical, intent(inout) :: value
      integer :: number

      number = merge(1, 0, value)
      call self%exchange_whole(name, number, '-', meaning, 0, 1)
      value = number == 1
   end subroutine exchange_flag

   !> Exchanges up to 64 characters; a text that the file does not have is blank.
   subroutine exchange_text(self, name, text)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name
      character(*), intent(inout) :: text

      call self%move_text(self%within//name, text)
   end subroutine exchange_text

   !> Exchanges extents of a list that need not be allocated: those of the part, or those of the file, which must be the
   !> true ones. -1: not allocated.
   subroutine exchange_extents(self, name, extents)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(inout) :: extents(:)
      integer :: found(2)

      call self%exchange_wholes(name//'_extent', extents, '-', 'extent of '//name//'; -1: there is none')
      if (.not. self%reading) return
      found = self%find_extents(self%within//name)
      if (all(extents > 0) .and. any(found(:size(extents)) /= extents)) call self%refuse()
      if (any(extents < 0) .and. any(extents /= -1)) call self%refuse()
      if (.not. self%good) extents = -1
   end subroutine exchange_extents

   subroutine exchange_real_list(self, name, values, unit, meaning)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(wp), allocatable, intent(inout) :: values(:)
      integer :: extents(1)

      extents = -1
      if (allocated(values)) extents = shape(values)
      call exchange_extents(self, name, extents)
      if (self%reading .and. allocated(values)) deallocate (values)
      if (self%reading .and. extents(1) >= 0) allocate (values(extents(1)))
      if (allocated(values)) call self%exchange_reals(name, values, unit, meaning)
   end subroutine exchange_real_list

   subroutine exchange_real_table(self, name, values, unit, meaning)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(wp), allocatable, intent(inout) :: values(:, :)
      integer :: extents(2)

      extents = -1
      if (allocated(values)) extents = shape(values)
      call exchange_extents(self, name, extents)
      if (self%reading .and. allocated(values)) deallocate (values)
      if (self%reading .and. extents(1) >= 0) allocate (values(extents(1), extents(2)))
      if (allocated(values)) call self%exchange_reals(name, values, unit, meaning)
   end subroutine exchange_real_table

   subroutine exchange_whole_list(self, name, values, unit, meaning)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      integer, allocatable, intent(inout) :: values(:)
      integer :: extents(1)

      extents = -1
      if (allocated(values)) extents = shape(values)
      call exchange_extents(self, name, extents)
      if (self%reading .and. allocated(values)) deallocate (values)
      if (self%reading .and. extents(1) >= 0) allocate (values(extents(1)), source=0)
      if (allocated(values)) call self%exchange_wholes(name, values, unit, meaning)
   end subroutine exchange_whole_list
end module archive
