! SPDX-License-Identifier: MIT
!> Archives of runs as HDF5 files, one file an archive.
module archive_file
   use archive, only: archive_t
   use faults, only: fault_t, raise, EXIT_RESTART
   use hdf5_file, only: h5_t, new_file, write_file, open_file, close_file, put, put_text, get, get_text, extents_of
   use kinds, only: wp
   use library_tables, only: library_version
   implicit none (type, external)
   private
   public :: archive_file_t, archive_kind_t, create_archive, open_archive, close_archive

   !> A kind of archive, and what is said of files of other kinds.
   type :: archive_kind_t
      character(24) :: kind      !< As it stands in the file.
      character(4) :: format     !< Grows with every change of what is stored.
      character(50) :: name      !< The file that a user should name.
      character(160) :: other    !< Stands behind the path of a file of another kind.
      character(60) :: remedy    !< Advice for a file of another version.
   end type archive_kind_t

   type, extends(archive_t) :: archive_file_t
      private
      type(h5_t) :: file
   contains
      procedure :: move_values, move_text, find_extents
   end type archive_file_t
contains
   !> Begins an archive that is written; its file gets its name when it is closed.
   subroutine create_archive(path, kind, archive)
      character(*), intent(in) :: path
      type(archive_kind_t), intent(in) :: kind
      type(archive_file_t), intent(out) :: archive

      archive%within = ''
      call new_file(archive%file, path, guarded=.true.)
      call put_text(archive%file, 'kind', trim(kind%kind))
      call put_text(archive%file, 'format', trim(kind%format))
      call put_text(archive%file, 'library', library_version())
   end subroutine create_archive

   !> Opens an archive to read. Fault EXIT_RESTART, and the file is closed: no such file, a truncated one, one of
   !> another kind or of another version of program or library.
   subroutine open_archive(path, kind, archive, fault)
      character(*), intent(in) :: path
      type(archive_kind_t), intent(in) :: kind
      type(archive_file_t), intent(out) :: archive
      type(fault_t), intent(inout) :: fault
      character(64) :: format, theirs, here

      archive%reading = .true.
      archive%within = ''
      call open_file(path, archive%file)
      if (.not. archive%file%good) then
         call raise(fault, EXIT_RESTART, path//' is missing, no HDF5 file, or truncated; name the '// &
                    trim(kind%name)//'.')
         return
      end if
      format = get_text(archive%file, 'format')
      theirs = get_text(archive%file, 'library')
      here = library_version()
      if (get_text(archive%file, 'kind') /= kind%kind) then
         call raise(fault, EXIT_RESTART, path//trim(kind%other))
      else if (format /= kind%format .or. theirs /= here) then
         call raise(fault, EXIT_RESTART, path//' was written by another version: format '//trim(format)// &
                    ', library '//trim(theirs)//'; this one has format '//trim(kind%format)//', library '// &
                    trim(here)//'. '//trim(kind%remedy))
      end if
      if (fault%code /= 0) call close_file(archive%file)
   end subroutine open_archive

   !> Ends an archive. good is false where it is damaged, or cannot be written; an older file of its name then stays.
   subroutine close_archive(archive, good)
      type(archive_file_t), intent(inout) :: archive
      logical, intent(out) :: good

      good = archive%good
      if (archive%reading) then
         call close_file(archive%file)
      else
         call write_file(archive%file, good)
      end if
   end subroutine close_archive

   subroutine move_values(self, name, values, unit, meaning)
      class(archive_file_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(wp), intent(inout), contiguous :: values(..)

      if (self%reading) then
         call get(self%file, name, values)
      else
         call put(self%file, name, values, unit, meaning)
      end if
      self%good = self%good .and. self%file%good
   end subroutine move_values

   subroutine move_text(self, name, text)
      class(archive_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      character(*), intent(inout) :: text

      if (self%reading) then
         text = get_text(self%file, name)
      else
         call put_text(self%file, name, trim(text))
      end if
   end subroutine move_text

   function find_extents(self, name) result(extents)
      class(archive_file_t), intent(in) :: self
      character(*), intent(in) :: name
      integer :: extents(2)

      extents = extents_of(self%file, name)
   end function find_extents
end module archive_file
