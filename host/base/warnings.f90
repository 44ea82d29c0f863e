! SPDX-License-Identifier: MIT
!> Warnings of mud_host.
module warnings
   use, intrinsic :: iso_fortran_env, only: error_unit
   implicit none (type, external)
   private
   public :: print_warning

contains

   !> A line on standard error, which a quiet run prints as well.
   subroutine print_warning(text)
      character(*), intent(in) :: text

      write (error_unit, '(a)') 'mud_host: warning: '//trim(text)
   end subroutine print_warning
end module warnings
