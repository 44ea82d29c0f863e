!> Stands in for the HDF5 output where the HDF5 library is not installed: nothing asks it to write.
module triax_hdf5
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use triax_table, only: column_t, attribute_t, TEXT_LENGTH
   implicit none (type, external)
   private
   public :: write_hdf5, HAS_HDF5

   logical, parameter :: HAS_HDF5 = .false.

contains
   subroutine write_hdf5(path, columns, values, attributes, problem)
      character(*), intent(in) :: path
      type(column_t), intent(in) :: columns(:)
      real(wp), intent(in) :: values(:, :)             !< columns, rows
      type(attribute_t), intent(in) :: attributes(:)
      character(TEXT_LENGTH), intent(out) :: problem   !< Blank on success.

      write (problem, '(a, i0, a)') 'this mud_triax was built without HDF5: '//trim(path)//' lacks its ', &
         size(columns) + size(values) + size(attributes), ' entries.'
   end subroutine write_hdf5
end module triax_hdf5
