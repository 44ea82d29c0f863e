! SPDX-License-Identifier: MIT
!> All increments of a test, to compare two runs of it: one whose increments are parts of those of the other.
module triax_moments
   use kinds, only: wp
   use triax_columns, only: COLUMNS
   implicit none (type, external)
   private
   public :: moments_t, note_moment, forget_moments, differences, ranges

   integer, parameter :: STAGE = 1, WAY = 2, STEP = 3, PLACES = 3
   integer, parameter :: ROOM = 256               !< Moments that there is room for at first.
   integer, parameter :: LAST = huge(0)           !< In place of the number of the last increment of a way.

   type :: moments_t
      integer :: n = 0
      integer, allocatable :: tags(:, :)          !< (PLACES, n or more) stage, way, increment of the way
      real(wp), allocatable :: values(:, :)       !< (columns, n or more)
   end type moments_t
contains
   !> Empties the record; its memory is kept.
   pure subroutine forget_moments(moments)
      type(moments_t), intent(inout) :: moments

      moments%n = 0
   end subroutine forget_moments

   !> Adds the columns (values) at the end of an increment, known by its tag; `ends_way` at the end of a path segment.
   pure subroutine note_moment(moments, tag, ends_way, values)
      type(moments_t), intent(inout) :: moments
      integer, intent(in) :: tag(PLACES)   !< Stage, way, increment of the way.
      logical, intent(in) :: ends_way
      real(wp), intent(in) :: values(:)   !< (columns)
      integer, allocatable :: tags(:, :)
      real(wp), allocatable :: more(:, :)

      if (.not. allocated(moments%tags)) then
         allocate (moments%tags(PLACES, ROOM), source=0)
         allocate (moments%values(size(COLUMNS), ROOM), source=0.0_wp)
      end if
      if (moments%n == size(moments%tags, 2)) then
         allocate (tags(PLACES, 2*moments%n), source=0)
         allocate (more(size(COLUMNS), 2*moments%n), source=0.0_wp)
         tags(:, :moments%n) = moments%tags
         more(:, :moments%n) = moments%values
         call move_alloc(tags, moments%tags)
         call move_alloc(more, moments%values)
      end if
      moments%n = moments%n + 1
      moments%tags(:, moments%n) = tag
      if (ends_way) moments%tags(STEP, moments%n) = LAST
      moments%values(:, moments%n) = values
   end subroutine note_moment

   !> Finds the largest difference of every column, at the increments of the coarse run that the fine one has too:
   !> `parts` of its make one. Ends of ways are compared with each other. Huge where a way of the one is not in the
   !> other. (columns), each in its unit. For docs/theory/accuracy.md section 5.
   pure function differences(coarse, fine, parts) result(apart)
      type(moments_t), intent(in) :: coarse, fine
      integer, intent(in) :: parts
      real(wp) :: apart(size(COLUMNS))
      integer :: i, j, wanted(PLACES)

      apart = 0.0_wp
      j = 1
      do i = 1, coarse%n
         wanted = coarse%tags(:, i)
         if (wanted(STEP) /= LAST) wanted(STEP) = parts*wanted(STEP)
         do while (j < fine%n .and. before(fine%tags(:, min(j, fine%n)), wanted))
            j = j + 1
         end do
         if (j > fine%n) exit
         if (all(fine%tags(:, j) == wanted)) apart = max(apart, abs(fine%values(:, j) - coarse%values(:, i)))
      end do
      if (coarse%n == 0 .or. fine%n == 0) then
         apart = huge(1.0_wp)
      else if (any(coarse%tags(:WAY, coarse%n) /= fine%tags(:WAY, fine%n))) then
         apart = huge(1.0_wp)
      end if
   end function differences

   !> Whether a moment comes before another.
   pure logical function before(one, other)
      integer, intent(in) :: one(PLACES), other(PLACES)
      integer :: k

      before = .false.
      do k = STAGE, STEP
         if (one(k) == other(k)) cycle
         before = one(k) < other(k)
         return
      end do
   end function before

   !> Finds the largest change of every column. (columns), each in its unit; 0 of an empty record.
   pure function ranges(moments) result(range)
      type(moments_t), intent(in) :: moments
      real(wp) :: range(size(COLUMNS))

      range = 0.0_wp
      if (moments%n > 0) range = maxval(moments%values(:, :moments%n), 2) - minval(moments%values(:, :moments%n), 2)
   end function ranges
end module triax_moments
