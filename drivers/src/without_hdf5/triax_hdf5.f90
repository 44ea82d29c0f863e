!> Stands in for the HDF5 output where the HDF5 library is not installed: it says so.
module triax_hdf5
   use, intrinsic :: iso_fortran_env, only: wp => real64
   implicit none (type, external)
   private
   public :: column_t, attribute_t, write_hdf5, TEXT_LENGTH

   integer, parameter :: TEXT_LENGTH = 1000

   !> A column of the results.
   type :: column_t
      character(16) :: name
      character(8) :: unit
      character(120) :: meaning
      logical :: whole = .false.   !< Counts.
   end type column_t

   !> A fact about the run.
   type :: attribute_t
      character(64) :: name = ''
      character(TEXT_LENGTH) :: text = ''
   end type attribute_t

contains
   subroutine write_hdf5(path, columns, values, attributes, problem)
      character(*), intent(in) :: path
      type(column_t), intent(in) :: columns(:)
      real(wp), intent(in) :: values(:, :)             !< columns, rows
      type(attribute_t), intent(in) :: attributes(:)
      character(TEXT_LENGTH), intent(out) :: problem   !< Blank on success.

      problem = 'this mud_triax was built without HDF5 (install libhdf5-dev and build again), so '//trim(path)// &
                ' stays empty; choose a .csv file.'
      if (size(columns) /= size(values, 1) .or. size(attributes) < 0) problem = 'rows do not fit their columns.'
   end subroutine write_hdf5
end module triax_hdf5
