! SPDX-License-Identifier: MIT
!> Ctrl-C and the system's request to end (SIGINT, SIGTERM): the program is told, and ends where its results are whole.
!> A second one ends it at once.
module interrupts
   use, intrinsic :: iso_c_binding, only: c_int, c_funptr, c_funloc, c_null_funptr
   use files, only: signal
   implicit none (type, external)
   private
   public :: catch_interrupts, interrupted, EXIT_INTERRUPTED

   integer, parameter :: EXIT_INTERRUPTED = 130   !< Exit code of a run that SIGINT ends, as a shell tells it: 128 + 2.
   integer(c_int), parameter :: SIGINT = 2, SIGTERM = 15   !< POSIX
   logical, volatile :: seen = .false.
contains
   !> Catches interrupts from here on, for the whole process.
   subroutine catch_interrupts()
      type(c_funptr) :: before

      before = signal(SIGINT, c_funloc(note))
      before = signal(SIGTERM, c_funloc(note))
   end subroutine catch_interrupts

   !> Whether one has come.
   logical function interrupted()
      interrupted = seen
   end function interrupted

   !> Called by the system. SIG_DFL, which ends the program, is the null pointer.
   subroutine note(number) bind(c)
      integer(c_int), value :: number
      type(c_funptr) :: before

      seen = .true.
      before = signal(number, c_null_funptr)
   end subroutine note
end module interrupts
