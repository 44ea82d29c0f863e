!> HDF5 files of the driver: the only place that knows the HDF5 library.
!> One dataset for each column, with the attributes `unit` and `description`; facts about the run are attributes of the
!> file. Compiled in place of without_hdf5/triax_hdf5.f90 where HDF5 with its Fortran interface is installed.
module triax_hdf5
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use hdf5, only: hid_t, hsize_t, size_t, h5open_f, h5close_f, h5eset_auto_f, h5fcreate_f, h5fclose_f, &
                   h5screate_f, h5screate_simple_f, h5sclose_f, h5dcreate_f, h5dwrite_f, h5dclose_f, h5tcopy_f, &
                   h5tset_size_f, h5tclose_f, h5acreate_f, h5awrite_f, h5aclose_f, H5F_ACC_TRUNC_F, H5S_SCALAR_F, &
                   H5T_NATIVE_DOUBLE, H5T_NATIVE_INTEGER, H5T_FORTRAN_S1
   use triax_table, only: column_t, attribute_t, TEXT_LENGTH
   implicit none (type, external)
   private
   public :: write_hdf5, HAS_HDF5

   logical, parameter :: HAS_HDF5 = .true.

contains
   subroutine write_hdf5(path, columns, values, attributes, problem)
      character(*), intent(in) :: path
      type(column_t), intent(in) :: columns(:)
      real(wp), intent(in) :: values(:, :)             !< columns, rows
      type(attribute_t), intent(in) :: attributes(:)
      character(TEXT_LENGTH), intent(out) :: problem   !< Blank on success.
      integer(hid_t) :: file, space, set
      integer(hsize_t) :: extent(1)
      integer :: i, status, worst

      problem = ''
      call h5open_f(status)
      worst = status
      call h5eset_auto_f(0, status)   ! no printing: faults come back as codes
      call h5fcreate_f(path, H5F_ACC_TRUNC_F, file, status)
      if (status < 0 .or. worst < 0) then
         problem = 'the HDF5 file cannot be made; choose another place with --output.'
         return
      end if
      do i = 1, size(attributes)
         call write_attribute(file, trim(attributes(i)%name), trim(attributes(i)%text), worst)
      end do
      extent = size(values, 2)
      call h5screate_simple_f(1, extent, space, status)
      worst = min(worst, status)
      do i = 1, size(columns)
         if (columns(i)%whole) then
            call h5dcreate_f(file, trim(columns(i)%name), H5T_NATIVE_INTEGER, space, set, status)
            worst = min(worst, status)
            call h5dwrite_f(set, H5T_NATIVE_INTEGER, nint(values(i, :)), extent, status)
         else
            call h5dcreate_f(file, trim(columns(i)%name), H5T_NATIVE_DOUBLE, space, set, status)
            worst = min(worst, status)
            call h5dwrite_f(set, H5T_NATIVE_DOUBLE, values(i, :), extent, status)
         end if
         worst = min(worst, status)
         call write_attribute(set, 'unit', trim(columns(i)%unit), worst)
         call write_attribute(set, 'description', trim(columns(i)%meaning), worst)
         call h5dclose_f(set, status)
         worst = min(worst, status)
      end do
      call h5sclose_f(space, status)
      call h5fclose_f(file, status)
      worst = min(worst, status)
      call h5close_f(status)
      if (worst < 0) problem = 'the HDF5 file is incomplete; is the disk full?'
   end subroutine write_hdf5

   !> A text attribute of a file or dataset.
   subroutine write_attribute(owner, name, text, worst)
      integer(hid_t), intent(in) :: owner
      character(*), intent(in) :: name, text
      integer, intent(inout) :: worst
      integer(hid_t) :: kind, space, attribute
      integer(hsize_t) :: extent(1)
      integer :: status

      extent = 1
      call h5tcopy_f(H5T_FORTRAN_S1, kind, status)
      worst = min(worst, status)
      call h5tset_size_f(kind, int(max(len(text), 1), size_t), status)
      call h5screate_f(H5S_SCALAR_F, space, status)
      call h5acreate_f(owner, name, kind, space, attribute, status)
      worst = min(worst, status)
      call h5awrite_f(attribute, kind, text, extent, status)
      worst = min(worst, status)
      call h5aclose_f(attribute, status)
      call h5sclose_f(space, status)
      call h5tclose_f(kind, status)
   end subroutine write_attribute
end module triax_hdf5
