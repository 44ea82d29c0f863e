! SPDX-License-Identifier: MIT
!> Warnings of mud_host: printed when they are due, and again at the end of a run.
module warnings
   use, intrinsic :: iso_fortran_env, only: error_unit
   implicit none (type, external)
   private
   public :: print_warning, repeat_warnings

   type :: text_t
      character(:), allocatable :: text
   end type text_t

   type(text_t), allocatable :: printed(:)   !< By this process.
contains
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
