! SPDX-License-Identifier: MIT
!> Warnings of mud_host: printed when they are due, and again at the end of a run, with those that the run gave before
!> the checkpoint that it was taken up from.
module warnings
   use, intrinsic :: iso_fortran_env, only: error_unit
   use archive, only: archive_t
   implicit none (type, external)
   private
   public :: print_warning, is_told, repeat_warnings, exchange_warnings

   type :: warning_t
      character(:), allocatable :: text
      character(:), allocatable :: once   !< Name of a warning that a run gives once; blank: it may come again.
   end type warning_t

   character, parameter :: LF = new_line('a')

   type(warning_t), allocatable :: told(:)   !< Warnings of the run so far, each text once.
contains
   !> Prints a line on standard error, in a quiet run as well; nothing where the run has given the warning of this name.
   subroutine print_warning(text, once)
      character(*), intent(in) :: text
      character(*), intent(in), optional :: once   !< Name of a warning that a run gives once.
      type(warning_t) :: one

      one = warning_t(trim(text), '')
      if (present(once)) one%once = once
      if (is_told(one%once)) return
      write (error_unit, '(a)') 'mud_host: warning: '//one%text
      call note(one)
   end subroutine print_warning

   !> Whether the run has given the warning of a name, before its checkpoint or since.
   logical function is_told(once)
      character(*), intent(in) :: once
      integer :: i

      is_told = .false.
      if (once == '' .or. .not. allocated(told)) return
      is_told = any([(told(i)%once == once, i=1, size(told))])
   end function is_told

   subroutine note(one)
      type(warning_t), intent(in) :: one
      integer :: i

      if (.not. allocated(told)) allocate (told(0))
      if (.not. any([(told(i)%text == one%text, i=1, size(told))])) told = [told, one]
   end subroutine note

   !> Prints all that were given, each once; nothing if there were none.
   subroutine repeat_warnings(unit)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      integer :: i

      if (.not. allocated(told)) return
      write (unit, '(a)') 'Warnings of this run:'
      do i = 1, size(told)
         write (unit, '(a)') '   '//told(i)%text
      end do
   end subroutine repeat_warnings

   !> Exchanges the warnings of a run with an archive; those that are restored stand before those that this process has
   !> given of the scene.
   subroutine exchange_warnings(archive)
      class(archive_t), intent(inout) :: archive
      type(warning_t), allocatable :: own(:)
      type(warning_t) :: one
      character(:), allocatable :: lines
      integer, allocatable :: codes(:)
      integer :: i

      if (allocated(told)) then
         lines = ''
         do i = 1, size(told)
            lines = lines//told(i)%once//LF//told(i)%text//LF
         end do
         codes = [(ichar(lines(i:i)), i=1, len(lines))]
      end if
      call archive%exchange_allocatable('warnings', codes, '-', &
                                        'characters of the warnings so far, of each its name and its text in a line')
      if (.not. archive%reading .or. .not. allocated(codes)) return
      if (any(codes < 0 .or. codes > 255)) then
         call archive%refuse()
         return
      end if
      allocate (own(0))
      if (allocated(told)) call move_alloc(told, own)
      lines = repeat(' ', size(codes))
      do i = 1, size(codes)
         lines(i:i) = char(codes(i))
      end do
      do while (lines /= '')
         call take_line(one%once)
         call take_line(one%text)
         call note(one)
      end do
      do i = 1, size(own)
         call note(own(i))
      end do
   contains
      !> Takes a line from the front of the rest.
      subroutine take_line(line)
         character(:), allocatable, intent(out) :: line
         integer :: n

         n = index(lines//LF, LF)
         line = lines(:n - 1)
         lines = lines(n + 1:)
      end subroutine take_line
   end subroutine exchange_warnings
end module warnings
