! SPDX-License-Identifier: MIT
!> Sparsity pattern, row by row, and the entry that every element entry adds to. The pattern is symmetric and knows
!> nothing of boundary conditions, so these may change while it stays.
module sparsity_pattern
   implicit none (type, external)
   private
   public :: pattern_t, make_pattern, entry_of

   type :: pattern_t
      integer :: n = 0
      integer, allocatable :: row(:)      !< (n + 1) where every row begins
      integer, allocatable :: col(:)      !< Ascending in every row.
      integer, allocatable :: before(:)   !< (elements + 1) Entries of the square matrices of the elements before one.
      integer, allocatable :: place(:)    !< The entry that every one of these adds to.
   end type pattern_t
contains
   !> Makes the pattern of elements given by their unknowns; `extra`: further pairs of unknowns that meet (contact).
   subroutine make_pattern(n, element, extra, pattern)
      integer, intent(in) :: n   !< Number of unknowns.
      integer, intent(in) :: element(:, :)   !< (m, elements) 0 behind the unknowns of an element.
      integer, intent(in) :: extra(:, :)   !< (2, pairs), each listed both ways round.
      type(pattern_t), intent(out) :: pattern
      integer, allocatable :: start(:), list(:), more(:), partner(:)   !< Places of every unknown in both lists.
      integer, allocatable :: where_is(:), col(:)   !< Entry of every column in the present row; columns so far.
      integer :: m_of(size(element, 2)), e, i, j, k, used

      m_of = count(element > 0, dim=1)
      pattern%n = n
      allocate (pattern%before(size(m_of) + 1), source=0)
      do e = 1, size(m_of)
         pattern%before(e + 1) = pattern%before(e) + m_of(e)**2
      end do
      call invert(n, element, start, list)
      call invert(n, extra(1:1, :), more, partner)
      allocate (where_is(n), source=0)
      allocate (pattern%row(n + 1), pattern%place(sum(m_of**2)))
      allocate (col(size(pattern%place) + n + size(extra, 2)))
      used = 0
      do i = 1, n
         pattern%row(i) = used + 1
         ! What no element knows still has a diagonal.
         call add_column(i)
         do k = start(i), start(i + 1) - 1
            e = (list(k) - 1)/size(element, 1) + 1
            do j = 1, m_of(e)
               call add_column(element(j, e))
            end do
         end do
         do k = more(i), more(i + 1) - 1
            call add_column(extra(2, partner(k)))
         end do
         call sort(col(pattern%row(i):used))
         do k = pattern%row(i), used
            where_is(col(k)) = k
         end do
         do k = start(i), start(i + 1) - 1
            e = (list(k) - 1)/size(element, 1) + 1
            associate (row_of_element => list(k) - (e - 1)*size(element, 1), before => pattern%before(e))
               do j = 1, m_of(e)
                  pattern%place(before + row_of_element + m_of(e)*(j - 1)) = where_is(element(j, e))
               end do
            end associate
         end do
      end do
      pattern%row(n + 1) = used + 1
      pattern%col = col(:used)
   contains
      !> Adds a column to the present row, unless it is there.
      subroutine add_column(column)
         integer, intent(in) :: column

         if (where_is(column) >= pattern%row(i)) return
         used = used + 1
         col(used) = column
         where_is(column) = used
      end subroutine add_column
   end subroutine make_pattern

   !> Lists for every unknown the places (in array order) where it occurs.
   pure subroutine invert(n, element, start, list)
      integer, intent(in) :: n, element(:, :)
      integer, allocatable, intent(out) :: start(:), list(:)   !< First place of every unknown in the list, and it.
      integer :: next(n), e, a

      allocate (start(n + 1), list(count(element > 0)))
      next = 0
      do e = 1, size(element, 2)
         do a = 1, size(element, 1)
            if (element(a, e) > 0) next(element(a, e)) = next(element(a, e)) + 1
         end do
      end do
      start(1) = 1
      do a = 1, n
         start(a + 1) = start(a) + next(a)
      end do
      next = start(:n)
      do e = 1, size(element, 2)
         do a = 1, size(element, 1)
            if (element(a, e) == 0) cycle
            list(next(element(a, e))) = (e - 1)*size(element, 1) + a
            next(element(a, e)) = next(element(a, e)) + 1
         end do
      end do
   end subroutine invert

   !> Sorts by insertion, since rows are short.
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

   !> Finds entry (i, j) in pattern%col and in the values of the matrix, counted from 1; 0 if the pattern has none.
   pure integer function entry_of(pattern, i, j) result(place)
      type(pattern_t), intent(in) :: pattern
      integer, intent(in) :: i, j

      do place = pattern%row(i), pattern%row(i + 1) - 1
         if (pattern%col(place) == j) return
      end do
      place = 0
   end function entry_of
end module sparsity_pattern
