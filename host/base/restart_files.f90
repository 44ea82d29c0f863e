! SPDX-License-Identifier: MIT
!> Files from which a run goes on: who wrote them, and which are refused.
module restart_files
   use faults, only: fault_t, raise, EXIT_RESTART
   use hdf5_file, only: h5_t, open_file, close_file, put_text, get_text
   use library_version, only: library
   implicit none (type, external)
   private
   public :: restart_kind_t, put_origin, open_restart

   !> A kind of file, and what is said of others.
   type :: restart_kind_t
      character(24) :: kind      !< Kind as it stands in the file.
      character(4) :: format     !< Grows with every change of what is stored.
      character(50) :: name      !< Noun for the file that a user should name.
      character(160) :: other    !< Behind the path of a file of another kind.
      character(60) :: remedy    !< For a file of another version.
   end type restart_kind_t
contains
   !> Kind, format and library of a new file.
   subroutine put_origin(file, kind)
      type(h5_t), intent(inout) :: file
      type(restart_kind_t), intent(in) :: kind

      call put_text(file, 'kind', trim(kind%kind))
      call put_text(file, 'format', trim(kind%format))
      call put_text(file, 'library', library())
   end subroutine put_origin

   !> Opens a file to read. Fault EXIT_RESTART, and the file is closed: no such file, a truncated one, one of
   !> another kind or of another version of program or library.
   subroutine open_restart(path, kind, file, fault)
      character(*), intent(in) :: path
      type(restart_kind_t), intent(in) :: kind
      type(h5_t), intent(inout) :: file
      type(fault_t), intent(inout) :: fault
      character(64) :: format, theirs, here

      call open_file(path, file)
      if (.not. file%good) then
         call raise(fault, EXIT_RESTART, path//' is missing, no HDF5 file, or truncated; name the '// &
                    trim(kind%name)//'.')
         return
      end if
      format = get_text(file, 'format')
      theirs = get_text(file, 'library')
      here = library()
      if (get_text(file, 'kind') /= kind%kind) then
         call raise(fault, EXIT_RESTART, path//trim(kind%other))
      else if (format /= kind%format .or. theirs /= here) then
         call raise(fault, EXIT_RESTART, path//' was written by another version: format '//trim(format)// &
                    ', library '//trim(theirs)//'; this one has format '//trim(kind%format)//', library '// &
                    trim(here)//'. '//trim(kind%remedy))
      end if
      if (fault%code /= 0) call close_file(file)
   end subroutine open_restart
end module restart_files
