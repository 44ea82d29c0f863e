! SPDX-License-Identifier: MIT
!> Faults: an exit code and a sentence that says what is wrong, where, the value, the allowed range and the remedy.
module faults
   implicit none (type, external)
   private
   public :: fault_t, raise, at_line
   public :: EXIT_INPUT, EXIT_RUN, EXIT_OUTPUT, EXIT_RESTART

   integer, parameter :: EXIT_INPUT = 2   !< Command line, case, scene or material refused; nothing was written.
   integer, parameter :: EXIT_RUN = 3     !< The material or the control gave up; what was computed is kept.
   integer, parameter :: EXIT_OUTPUT = 4  !< The output could not be written.
   integer, parameter :: EXIT_RESTART = 17   !< A checkpoint or its files: damaged, of another scene or version.

   !> Outcome of a step; `code` 0 is success.
   type :: fault_t
      integer :: code = 0
      character(1000) :: text = ''
   end type fault_t

contains
   !> Sets the exit code and the message of a fault; the message is complete: what, where, value, allowed range, remedy.
   !> code is one of EXIT_*; an earlier fault is replaced.
   subroutine raise(fault, code, text)
      type(fault_t), intent(inout) :: fault
      integer, intent(in) :: code
      character(*), intent(in) :: text

      fault%code = code
      fault%text = text
   end subroutine raise

   !> Says "file:line: ", the place in front of a sentence.
   pure function at_line(file, line) result(place)
      character(*), intent(in) :: file
      integer, intent(in) :: line
      character(:), allocatable :: place
      character(12) :: digits

      write (digits, '(i0)') line
      place = trim(file)//':'//trim(digits)//': '
   end function at_line
end module faults
