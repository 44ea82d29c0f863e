! SPDX-License-Identifier: MIT
!> Warnings of mud_host: printed when they are due, and again at the end of a run.
module warnings
   use, intrinsic :: iso_fortran_env, only: error_unit
   implicit none (type, external)
   private
   public :: add_warning, print_warning, repeat_warnings, WARNING_LENGTH

   integer, parameter :: WARNING_LENGTH = 500

   type :: text_t
      character(:), allocatable :: text
   end type text_t

   type(text_t), allocatable :: printed(:)   !< By this process.
contains
   !> Adds a text to a list.
   subroutine add_warning(text, list)
      character(*), intent(in) :: text
      character(WARNING_LENGTH), allocatable, intent(inout) :: list(:)   !< List that grows by one. (warnings)
      character(WARNING_LENGTH), allocatable :: more(:)
      integer :: n

      n = 0
      if (allocated(list)) n = size(list)
      allocate (more(n + 1))
      if (n > 0) more(:n) = list
      more(n + 1) = text
      call move_alloc(more, list)
   end subroutine add_warning

   !> A line on standard error, which a quiet run prints as well.
   subroutine print_warning(text)
      character(*), intent(in) :: text
      type(text_t) :: one

      write (error_unit, '(a)') 'mud_host: warning: '//trim(text)
      if (.not. allocated(printed)) allocate (printed(0))
      one%text = trim(text)
      printed = [printed, one]
   end subroutine print_warning

   !> All that were printed, each once; nothing if there were none.
   subroutine repeat_warnings(unit)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      integer :: i, k

      if (.not. allocated(printed)) return
      write (unit, '(a)') 'Warnings of this run:'
      do i = 1, size(printed)
         if (any([(printed(k)%text == printed(i)%text, k=1, i - 1)])) cycle
         write (unit, '(a)') '   '//printed(i)%text
      end do
   end subroutine repeat_warnings
end module warnings
