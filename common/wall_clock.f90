! SPDX-License-Identifier: MIT
!> Wall time.
module wall_clock
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: clock, add_elapsed
contains
   !> Seconds since an arbitrary moment.
   real(wp) function clock()
      integer(int64) :: ticks, rate

      call system_clock(ticks, rate)
      clock = real(ticks, wp)/real(rate, wp)
   end function clock

   !> Adds the time since t0 to a total and sets t0 to the present. Both in seconds, of clock.
   subroutine add_elapsed(total, t0)
      real(wp), intent(inout) :: total, t0
      real(wp) :: now

      now = clock()
      total = total + now - t0
      t0 = now
   end subroutine add_elapsed
end module wall_clock
