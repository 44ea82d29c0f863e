! SPDX-License-Identifier: MIT
!> HDF5 files of the host, the only module that knows the HDF5 library: datasets with the attributes `unit` and
!> `description` and a checksum, texts as attributes of the file. A file is built in memory and written as a whole, so
!> that a full disk or a killed run leaves no half of one under its name.
module hdf5_file
   use, intrinsic :: iso_c_binding, only: c_ptr, c_loc
   use hdf5, only: hid_t, hsize_t, size_t, h5open_f, h5eset_auto_f, h5fcreate_f, h5fopen_f, h5fclose_f, &
                   h5pcreate_f, h5pclose_f, h5pset_fapl_core_f, h5pset_chunk_f, &
                   h5pset_libver_bounds_f, H5F_LIBVER_V110_F, &
                   h5pset_fletcher32_f, h5pset_obj_track_times_f, h5pset_create_inter_group_f, h5screate_f, &
                   h5screate_simple_f, h5sclose_f, h5dcreate_f, h5dopen_f, h5dwrite_f, h5dread_f, h5dclose_f, &
                   h5dget_space_f, h5sget_simple_extent_ndims_f, h5sget_simple_extent_dims_f, h5tcopy_f, &
                   h5tset_size_f, h5tclose_f, h5acreate_f, h5aopen_f, h5awrite_f, h5aread_f, h5aclose_f, &
                   H5F_ACC_TRUNC_F, H5F_ACC_RDONLY_F, H5P_FILE_ACCESS_F, H5P_FILE_CREATE_F, &
                   H5P_DATASET_CREATE_F, &
                   H5P_LINK_CREATE_F, H5S_SCALAR_F, H5T_NATIVE_DOUBLE, H5T_NATIVE_INTEGER, H5T_FORTRAN_S1
   use kinds, only: wp
   use files, only: name_part, remove_part, PART
   implicit none (type, external)
   private
   public :: h5_t, new_file, write_file, open_file, close_file, put, put_text, get, get_text, extents_of

   integer(size_t), parameter :: GROWTH = 1048576   !< Step by which a file in memory grows [bytes].
   integer, parameter :: TEXT_LENGTH = 64           !< Length of a text that is read back.

   type :: h5_t
      integer(hid_t) :: id = -1
      logical :: good = .true.   !< False after the first call that failed.
      character(:), allocatable :: path   !< Name of a new file; it is written beside it and then gets this name.
   end type h5_t

   !> A number, or an array of any size with one or two dimensions, as a dataset; its folders are made. An empty one is
   !> left out.
   !> file%good is false after a failure. `unit` is that of the values.
   interface put
      module procedure put_real, put_integer
   end interface put
contains
   !> Makes an empty file, which is in memory until write_file. `guarded`: in the format of HDF5 1.10, which has
   !> checksums over its structure too, the place of every dataset included; what reads it must not be older. file%good
   !> is false after a failure, of this call or any later one.
   subroutine new_file(file, path, guarded)
      type(h5_t), intent(out) :: file
      character(*), intent(in) :: path
      logical, intent(in), optional :: guarded
      integer(hid_t) :: access, creation
      integer :: s(6)

      file%path = path
      call begin(file)
      s = 0
      call h5pcreate_f(H5P_FILE_CREATE_F, creation, s(1))
      call h5pset_obj_track_times_f(creation, .false., s(2))   ! of the root group, in the later format
      call h5pcreate_f(H5P_FILE_ACCESS_F, access, s(3))
      call h5pset_fapl_core_f(access, GROWTH, .true., s(4))
      if (present(guarded)) then
         if (guarded) call h5pset_libver_bounds_f(access, H5F_LIBVER_V110_F, H5F_LIBVER_V110_F, s(5))
      end if
      call h5fcreate_f(path//PART, H5F_ACC_TRUNC_F, file%id, s(6), creation, access)
      call note(file, s)
      call h5pclose_f(creation, s(1))
      call h5pclose_f(access, s(2))
   end subroutine new_file

   !> Writes a file from memory to the disk and closes it. good is false where this call or one before it failed; a file
   !> of that name then stays.
   subroutine write_file(file, good)
      type(h5_t), intent(inout) :: file
      logical, intent(out) :: good
      integer :: status

      call h5fclose_f(file%id, status)
      call note(file, [status])
      file%id = -1
      good = file%good
      if (good) call name_part(file%path, good)
      if (.not. good) call remove_part(file%path)
   end subroutine write_file

   !> Opens an existing file for reading; not good if it is missing, no HDF5 file or truncated. file%good says so.
   subroutine open_file(path, file)
      character(*), intent(in) :: path
      type(h5_t), intent(out) :: file
      integer :: status

      call begin(file)
      call h5fopen_f(path, H5F_ACC_RDONLY_F, file%id, status)
      call note(file, [status])
   end subroutine open_file

   !> Closes a file that was opened for reading.
   subroutine close_file(file)
      type(h5_t), intent(inout) :: file
      integer :: status

      call h5fclose_f(file%id, status)
      file%id = -1
   end subroutine close_file

   subroutine begin(file)
      type(h5_t), intent(inout) :: file
      integer :: status

      call h5open_f(status)
      call note(file, [status])
      call h5eset_auto_f(0, status)   ! no printing: faults come back as codes
   end subroutine begin

   subroutine note(file, status)
      type(h5_t), intent(inout) :: file
      integer, intent(in) :: status(:)   !< Outcomes of calls, negative where one failed.

      if (any(status < 0)) file%good = .false.
   end subroutine note

   subroutine put_real(file, name, values, unit, meaning)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, unit, meaning
      real(wp), intent(in), contiguous, target :: values(..)

      if (size(values) > 0) call put_raw(file, name, H5T_NATIVE_DOUBLE, shape(values), c_loc(values), unit, meaning)
   end subroutine put_real

   subroutine put_integer(file, name, values, unit, meaning)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, unit, meaning
      integer, intent(in), contiguous, target :: values(..)

      if (size(values) > 0) call put_raw(file, name, H5T_NATIVE_INTEGER, shape(values), c_loc(values), unit, meaning)
   end subroutine put_integer

   !> Writes one chunk with a checksum and no time stamps, so that equal results are equal files.
   subroutine put_raw(file, name, kind, extent, values, unit, meaning)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, unit, meaning
      integer(hid_t), intent(in) :: kind
      integer, intent(in) :: extent(:)   !< None: a number, which is stored as a list of one.
      type(c_ptr), intent(in) :: values
      integer(hid_t) :: space, layout, links, set
      integer(hsize_t) :: dims(max(1, size(extent)))
      integer :: s(10)

      dims = 1
      dims(:size(extent)) = extent
      call h5screate_simple_f(size(dims), dims, space, s(1))
      call h5pcreate_f(H5P_DATASET_CREATE_F, layout, s(2))
      call h5pset_obj_track_times_f(layout, .false., s(3))
      call h5pset_chunk_f(layout, size(dims), dims, s(4))
      call h5pset_fletcher32_f(layout, s(5))
      call h5pcreate_f(H5P_LINK_CREATE_F, links, s(6))
      call h5pset_create_inter_group_f(links, 1, s(7))
      call h5dcreate_f(file%id, name, kind, space, set, s(8), dcpl_id=layout, lcpl_id=links)
      call h5dwrite_f(set, kind, values, s(9))
      call put_attribute(file, set, 'unit', unit)
      call put_attribute(file, set, 'description', meaning)
      call h5dclose_f(set, s(10))
      call note(file, s)
      call h5pclose_f(links, s(1))
      call h5pclose_f(layout, s(2))
      call h5sclose_f(space, s(3))
   end subroutine put_raw

   !> Writes a fact about the whole file. file%good is false after a failure.
   subroutine put_text(file, name, text)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name, text

      call put_attribute(file, file%id, name, text)
   end subroutine put_text

   subroutine put_attribute(file, owner, name, text)
      type(h5_t), intent(inout) :: file
      integer(hid_t), intent(in) :: owner
      character(*), intent(in) :: name, text
      integer(hid_t) :: kind, space, attribute
      integer(hsize_t) :: extent(1)
      integer :: s(5)

      extent = 1
      call h5tcopy_f(H5T_FORTRAN_S1, kind, s(1))
      call h5tset_size_f(kind, int(max(len(text), 1), size_t), s(2))
      call h5screate_f(H5S_SCALAR_F, space, s(3))
      call h5acreate_f(owner, name, kind, space, attribute, s(4))
      call h5awrite_f(attribute, kind, text, extent, s(5))
      call note(file, s)
      call h5aclose_f(attribute, s(1))
      call h5sclose_f(space, s(2))
      call h5tclose_f(kind, s(3))
   end subroutine put_attribute

   !> Reads a text of the file, blank if it has none of that name. Cut to TEXT_LENGTH characters.
   function get_text(file, name) result(text)
      type(h5_t), intent(in) :: file
      character(*), intent(in) :: name
      character(TEXT_LENGTH) :: text
      integer(hid_t) :: kind, attribute
      integer(hsize_t) :: extent(1)
      integer :: status

      text = ''
      extent = 1
      call h5aopen_f(file%id, name, attribute, status)
      if (status < 0) return
      call h5tcopy_f(H5T_FORTRAN_S1, kind, status)
      call h5tset_size_f(kind, int(TEXT_LENGTH, size_t), status)
      call h5aread_f(attribute, kind, text, extent, status)
      if (status < 0) text = ''
      call h5tclose_f(kind, status)
      call h5aclose_f(attribute, status)
   end function get_text

   !> Extents of a list or table; 0 where it has no such dimension, or the file does not contain it.
   function extents_of(file, name) result(dims)
      type(h5_t), intent(in) :: file
      character(*), intent(in) :: name
      integer :: dims(2)
      integer(hid_t) :: set
      integer(hsize_t) :: found(2)
      integer :: status, rank

      dims = 0
      call h5dopen_f(file%id, name, set, status)
      if (status < 0) return
      call extent_of_set(set, rank, found)
      dims = int(min(found, int(huge(0), hsize_t)))
      call h5dclose_f(set, status)
   end function extents_of

   subroutine extent_of_set(set, rank, dims)
      integer(hid_t), intent(in) :: set
      integer, intent(out) :: rank
      integer(hsize_t), intent(out) :: dims(2)
      integer(hid_t) :: space
      integer(hsize_t) :: found(2), largest(2)
      integer :: status

      dims = 0
      found = 0
      call h5dget_space_f(set, space, status)
      call h5sget_simple_extent_ndims_f(space, rank, status)
      if (rank == 1 .or. rank == 2) then
         call h5sget_simple_extent_dims_f(space, found(:rank), largest(:rank), status)
         dims(:rank) = found(:rank)
      end if
      call h5sclose_f(space, status)
   end subroutine extent_of_set

   !> Reads a dataset, of real numbers or integers, into an array, which must have its extent, else file%good is false
   !> and the values stay. An empty array is not read.
   subroutine get(file, name, values)
      type(h5_t), intent(inout) :: file
      character(*), intent(in) :: name
      real(wp), intent(inout), contiguous, target :: values(..)
      integer(hid_t) :: set
      integer(hsize_t) :: dims(2)
      integer :: status, rank
      type(c_ptr) :: place

      if (size(values) == 0) return
      call h5dopen_f(file%id, name, set, status)
      call note(file, [status])
      if (status < 0) return
      call extent_of_set(set, rank, dims)
      associate (extent => shape(values))
         if (rank /= max(1, size(extent))) then
            file%good = .false.
         else if (any(dims(:size(extent)) /= extent) .or. (size(extent) == 0 .and. dims(1) /= 1)) then
            file%good = .false.
         else
            place = c_loc(values)
            call h5dread_f(set, H5T_NATIVE_DOUBLE, place, status)
            call note(file, [status])
         end if
      end associate
      call h5dclose_f(set, status)
   end subroutine get
end module hdf5_file
