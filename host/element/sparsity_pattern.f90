! SPDX-License-Identifier: MIT
!> Sparsity pattern, row by row, and the list of element entries that add up to every place of it. The pattern is
!> symmetric and knows nothing of boundary conditions, so these may change while it stays.
module sparsity_pattern
   implicit none (type, external)
   private
   public :: pattern_t, make_pattern, place_of

   type :: pattern_t
      integer :: n = 0
      integer, allocatable :: row(:)      !< (n + 1) where every row begins
      integer, allocatable :: col(:)      !< Ascending in every row.
      integer, allocatable :: first(:)    !< (entries + 1) where the sources of every entry begin
      integer, allocatable :: source(:)   !< Place in the square matrices of the elements, one behind the other, from 1
      integer, allocatable :: place(:)    !< The other way round: the entry to which every place adds
      integer, allocatable :: before(:)   !< (elements + 1) Entries of these before those of an element.
      integer, allocatable :: r_first(:), r_source(:)   !< Places in r(m, elements) that the entries of the vector are
                                                        !< summed from.
   end type pattern_t
contains
   !> Pattern of elements given by their unknowns; `extra`: further pairs of unknowns that meet (contact).
   subroutine make_pattern(n, element, extra, pattern)
      integer, intent(in) :: n   !< Number of unknowns.
      integer, intent(in) :: element(:, :)   !< (m, elements) 0 behind the unknowns of an element.
      integer, intent(in) :: extra(:, :)   !< (2, pairs), each listed both ways round.
      type(pattern_t), intent(out) :: pattern
      integer, allocatable :: mark(:), where_is(:), users(:), start(:), list(:), count_of(:), more(:), partner(:)
      integer :: m, e, i, j, k, pass, used, a
      integer :: m_of(size(element, 2))

      m = size(element, 1)
      m_of = count(element > 0, dim=1)
      pattern%n = n
      allocate (pattern%before(size(m_of) + 1), source=0)
      do e = 1, size(m_of)
         pattern%before(e + 1) = pattern%before(e) + m_of(e)**2
      end do
      ! Elements of every unknown.
      call invert(n, element, start, list)
      call invert(n, extra(1:1, :), more, partner)
      allocate (mark(n), source=0)
      allocate (where_is(n), source=0)
      allocate (pattern%row(n + 1), source=1)
      do pass = 1, 2
         mark = 0
         used = 0
         do i = 1, n
            pattern%row(i) = used + 1
            do k = start(i), start(i + 1) - 1
               e = (list(k) - 1)/m + 1
               do a = 1, m_of(e)
                  j = element(a, e)
                  if (mark(j) == i) cycle
                  mark(j) = i
                  used = used + 1
                  if (pass == 2) pattern%col(used) = j
               end do
            end do
            ! What no element knows still has a diagonal.
            if (mark(i) /= i) then
               mark(i) = i
               used = used + 1
               if (pass == 2) pattern%col(used) = i
            end if
            do k = more(i), more(i + 1) - 1
               j = extra(2, partner(k))
               if (mark(j) == i) cycle
               mark(j) = i
               used = used + 1
               if (pass == 2) pattern%col(used) = j
            end do
            if (pass == 2) call sort(pattern%col(pattern%row(i):used))
         end do
         pattern%row(n + 1) = used + 1
         if (pass == 1) allocate (pattern%col(used))
      end do
      ! Sources of every entry.
      allocate (users(used + 1), source=0)
      do pass = 1, 2
         if (pass == 2) then
            allocate (pattern%first(used + 1), pattern%source(sum(users)))
            pattern%first(1) = 1
            do k = 1, used
               pattern%first(k + 1) = pattern%first(k) + users(k)
            end do
            allocate (count_of(used), source=0)
            allocate (pattern%place(sum(users)))
         end if
         do i = 1, n
            do k = pattern%row(i), pattern%row(i + 1) - 1
               where_is(pattern%col(k)) = k
            end do
            do k = start(i), start(i + 1) - 1
               e = (list(k) - 1)/m + 1
               a = list(k) - (e - 1)*m
               do j = 1, m_of(e)
                  associate (at => where_is(element(j, e)))
                     if (pass == 1) then
                        users(at) = users(at) + 1
                     else
                        pattern%source(pattern%first(at) + count_of(at)) = a + m_of(e)*(j - 1) + pattern%before(e)
                        pattern%place(a + m_of(e)*(j - 1) + pattern%before(e)) = at
                        count_of(at) = count_of(at) + 1
                     end if
                  end associate
               end do
            end do
         end do
      end do
      call move_alloc(start, pattern%r_first)
      call move_alloc(list, pattern%r_source)
   end subroutine make_pattern

   !> Lists for every unknown the places (in array order) where it occurs.
   pure subroutine invert(n, element, start, list)
      integer, intent(in) :: n, element(:, :)
      integer, allocatable, intent(out) :: start(:), list(:)
      integer, allocatable :: next(:)
      integer :: e, a, m

      m = size(element, 1)
      allocate (start(n + 1), source=0)
      do e = 1, size(element, 2)
         do a = 1, m
            if (element(a, e) == 0) cycle
            start(element(a, e) + 1) = start(element(a, e) + 1) + 1
         end do
      end do
      start(1) = 1
      do a = 1, n
         start(a + 1) = start(a) + start(a + 1)
      end do
      allocate (list(count(element > 0)))
      next = start(:n)
      do e = 1, size(element, 2)
         do a = 1, m
            if (element(a, e) == 0) cycle
            list(next(element(a, e))) = (e - 1)*m + a
            next(element(a, e)) = next(element(a, e)) + 1
         end do
      end do
   end subroutine invert

   !> Insertion sort: rows are short.
   pure subroutine sort(values)
      integer, intent(inout) :: values(:)
      integer :: i, j, value

      do i = 2, size(values)
         value = values(i)
         do j = i - 1, 1, -1
            if (values(j) <= value) exit
            values(j + 1) = values(j)
         end do
         values(j + 1) = value
      end do
   end subroutine sort

   !> Place of entry (i, j), 0 if the pattern has none. From 1, in pattern%col and in the values of the matrix.
   pure integer function place_of(pattern, i, j) result(place)
      type(pattern_t), intent(in) :: pattern
      integer, intent(in) :: i, j

      do place = pattern%row(i), pattern%row(i + 1) - 1
         if (pattern%col(place) == j) return
      end do
      place = 0
   end function place_of
end module sparsity_pattern
