! SPDX-License-Identifier: MIT
!> Histories of known shape: pairs of a time and a factor at quarters of a wave, joined by arcs of a sine or by straight
!> lines. Between the pairs the arcs are exact. docs/theory/host.md section 7.2.
module history_shapes
   use kinds, only: wp, PI
   implicit none (type, external)
   private
   public :: pairs_of_shape, arc_at, kinks_of, slope_beside
   public :: SHAPE_WORDS, TABLE

   ! Words of the key `kind` of &history, and their numbers.
   character(*), parameter :: SHAPE_WORDS = 'table|sine|half_sine|haversine|triangle'
   integer, parameter :: TABLE = 1, SINE = 2, HALF_SINE = 3, HAVERSINE = 4

   ! Ways from a pair to the next.
   integer, parameter :: STRAIGHT = 0
   integer, parameter :: RISING = 1     !< Level at its start, steepest at its end.
   integer, parameter :: LEVELLING = 2  !< Steepest at its start, level at its end.
   real(wp), parameter :: SAME = 1.0e-9_wp   !< Difference of two slopes, of the larger one, that is rounding.
contains
   !> Pairs of a shape that is repeated, and the way from each to the next. One repetition lasts a period and begins and
   !> ends with the factor 0. docs/theory/host.md section 7.2.
   pure subroutine pairs_of_shape(shape, start, period, repeats, times, values, arcs)
      integer, intent(in) :: shape             !< Number of a word of SHAPE_WORDS, no table.
      real(wp), intent(in) :: start, period    !< [s]
      integer, intent(in) :: repeats
      real(wp), allocatable, intent(out) :: times(:), values(:)   !< [s], [-] (pairs)
      integer, allocatable, intent(out) :: arcs(:)                !< (pairs - 1)
      real(wp), allocatable :: once(:)
      integer, allocatable :: ways(:)
      integer :: i, n

      select case (shape)
      case (SINE)
         once = [0, 1, 0, -1]
         ways = [LEVELLING, RISING, LEVELLING, RISING]
      case (HALF_SINE)
         once = [0, 1]
         ways = [LEVELLING, RISING]
      case (HAVERSINE)
         once = [0.0_wp, 0.5_wp, 1.0_wp, 0.5_wp]
         ways = [RISING, LEVELLING, RISING, LEVELLING]
      case default
         once = [0, 1]
         ways = [STRAIGHT, STRAIGHT]
      end select
      n = size(once)
      times = [(start + i*(period/n), i=0, n*repeats)]
      values = [(once, i=1, repeats), 0.0_wp]
      arcs = [(ways, i=1, repeats)]
   end subroutine pairs_of_shape

   !> Finds the share of the way from a pair to the next, at a share of the time between them [-].
   pure real(wp) function arc_at(arc, x) result(share)
      integer, intent(in) :: arc
      real(wp), intent(in) :: x

      select case (arc)
      case (RISING)
         share = 1 - cos(0.5_wp*PI*x)
      case (LEVELLING)
         share = sin(0.5_wp*PI*x)
      case default
         share = x
      end select
   end function arc_at

   !> Finds the slope of a history just before (`side` = -1) or after (+1) a pair [1/s]; 0 beyond the ends.
   pure real(wp) function slope_beside(times, values, arcs, pair, side) result(slope)
      real(wp), intent(in) :: times(:), values(:)   !< [s], [-] (pairs)
      integer, intent(in) :: arcs(:)                !< (pairs - 1), or none: all straight.
      integer, intent(in) :: pair, side
      integer :: low

      slope = 0.0_wp
      low = merge(pair - 1, pair, side < 0)
      if (low < 1 .or. low >= size(times)) return
      slope = (values(low + 1) - values(low))/(times(low + 1) - times(low))
      if (size(arcs) == 0) return
      if (arcs(low) == STRAIGHT) return
      slope = merge(0.5_wp*PI*slope, 0.0_wp, (arcs(low) == RISING) .eqv. (side < 0))
   end function slope_beside

   !> Marks the pairs at which the slope of a history jumps. (pairs)
   pure function kinks_of(times, values, arcs) result(kinks)
      real(wp), intent(in) :: times(:), values(:)   !< [s], [-] (pairs)
      integer, intent(in) :: arcs(:)                !< (pairs - 1), or none: all straight.
      logical :: kinks(size(times))
      real(wp) :: before, after
      integer :: i

      do i = 1, size(times)
         before = slope_beside(times, values, arcs, i, -1)
         after = slope_beside(times, values, arcs, i, 1)
         kinks(i) = abs(after - before) > SAME*max(abs(after), abs(before))
      end do
   end function kinks_of
end module history_shapes
