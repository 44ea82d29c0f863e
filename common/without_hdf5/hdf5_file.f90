! SPDX-License-Identifier: MIT
!> Replaces ../hdf5_file.f90 where HDF5 is not installed: every call fails; callers check HAS_HDF5 before they call.
module hdf5_file
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: HAS_HDF5, h5_t, new_file, write_file, open_file, close_file, put, put_text, get, get_text, extent_of

   logical, parameter :: HAS_HDF5 = .false.

   type :: h5_t
      logical :: good = .false.
   end type h5_t

   interface put
      module procedure put_real, put_real_2, put_integer, put_integer_2
   end interface put

   interface get
      module procedure get_real, get_real_2, get_integer
   end interface get
contains
   !> Fails, file%good is false: there is no HDF5.
   subroutine new_file(file, path, guarded)
      type(h5_t), intent(out) :: file
      character(*), intent(in) :: path
      logical, intent(in), optional :: guarded

      file%good = present(guarded) .and. len(path) < 0
   end subroutine new_file

   !> Fails, good is false: there is no HDF5.
   subroutine write_file(file, good)
      type(h5_t), intent(inout) :: file
      logical, intent(out) :: good

      good = file%good
   end subroutine write_file

   !> Fails, file%good is false: there is no HDF5.
   subroutine open_file(path, file)
      character(*), intent(in) :: path
      type(h5_t), intent(out) :: file

      file%good = len(path) < 0
   end subroutine open_file

   !> Nothing is open without HDF5.
   subroutine close_file(file)
      type(h5_t), intent(inout) :: file

      file%good = .false.
   end subroutine close_file

   subroutine put_real(file, name, values, unit, meaning)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, unit, meaning
      real(wp), intent(in) :: values(:)

      file%good = len(name) + len(unit) + len(meaning) + size(values) < 0
   end subroutine put_real

   subroutine put_real_2(file, name, values, unit, meaning)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, unit, meaning
      real(wp), intent(in) :: values(:, :)

      file%good = len(name) + len(unit) + len(meaning) + size(values) < 0
   end subroutine put_real_2

   subroutine put_integer(file, name, values, unit, meaning)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, unit, meaning
      integer, intent(in) :: values(:)

      file%good = len(name) + len(unit) + len(meaning) + size(values) < 0
   end subroutine put_integer

   subroutine put_integer_2(file, name, values, unit, meaning)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, unit, meaning
      integer, intent(in) :: values(:, :)

      file%good = len(name) + len(unit) + len(meaning) + size(values) < 0
   end subroutine put_integer_2

   !> Fails, file%good is false: there is no HDF5.
   subroutine put_text(file, name, text)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, text

      file%good = len(name) + len(text) < 0
   end subroutine put_text

   !> Blank: there is no HDF5.
   function get_text(file, name) result(text)
      type(h5_t), intent(in) :: file
      character(*), intent(in) :: name
      character(64) :: text

      text = ''
      if (file%good) text = name
   end function get_text

   !> Zero: there is no HDF5.
   integer function extent_of(file, name)
      type(h5_t), intent(in) :: file
      character(*), intent(in) :: name

      extent_of = merge(len(name), 0, file%good)
   end function extent_of

   subroutine get_real(file, name, values)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name
      real(wp), intent(inout) :: values(:)

      values = 0.0_wp
      file%good = len(name) < 0
   end subroutine get_real

   subroutine get_real_2(file, name, values)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name
      real(wp), intent(inout) :: values(:, :)

      values = 0.0_wp
      file%good = len(name) < 0
   end subroutine get_real_2

   subroutine get_integer(file, name, values)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name
      integer, intent(inout) :: values(:)

      values = 0
      file%good = len(name) < 0
   end subroutine get_integer
end module hdf5_file
