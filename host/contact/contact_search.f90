! SPDX-License-Identifier: MIT
!> Search for the master edges that may lie opposite a slave edge: boxes around the edges, sorted into the cells of a
!> grid, so that the work grows with the number of edges and not with its square. Cells are kept in a hashed list, so
!> that their number does not matter; two cells that share a place in it cost one comparison.
module contact_search
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: search_t, prepare_search, find_candidates, edge_boxes, boxes_meet

   !> Room for the search and its answer: the candidates of slave edge i are candidate(first(i) : first(i + 1) - 1),
   !> each once.
   type :: search_t
      integer, allocatable :: first(:)       !< (slave edges + 1)
      integer, allocatable :: candidate(:)   !< Master edges; more room than is used.
      integer :: checks = 0                  !< Pairs of boxes compared in the last search.
      integer, allocatable, private :: place_first(:)  !< Where the entries of a place begin.
      integer, allocatable, private :: entry(:)        !< Master edges, place after place.
      integer, allocatable, private :: seen_by(:)      !< The last slave edge that looked at a master edge.
      real(wp), allocatable, private :: slave_box(:, :), master_box(:, :)
   end type search_t

   !> The grid: cell (i, j) from 0 at the lower corner of the master.
   type :: grid_t
      real(wp) :: whole(4) = 0.0_wp    !< Box of the master [m].
      real(wp) :: side = 1.0_wp        !< [m]
   end type grid_t

   integer, parameter :: PLACES_PER_EDGE = 4
   integer, parameter :: CELLS_PER_EDGE = 6           !< Most cells an edge may touch on average.
   real(wp), parameter :: MOST_CELLS = 1.0e6_wp       !< In one direction: cell numbers stay well inside an integer.
contains
   !> Makes room for so many edges.
   pure subroutine prepare_search(search, slaves, masters)
      type(search_t), intent(out) :: search
      integer, intent(in) :: slaves, masters   !< Numbers of edges of both surfaces.

      allocate (search%place_first(PLACES_PER_EDGE*max(masters, 1) + 3), search%seen_by(masters))
      allocate (search%first(slaves + 1), search%candidate(4*(slaves + masters)), search%entry(8*masters))
      allocate (search%slave_box(4, slaves), search%master_box(4, masters))
   end subroutine prepare_search

   !> Candidates of every slave edge: the master edges whose boxes come within `search_radius` of its own; with 0,
   !> within its own length, so that a long edge elsewhere makes nothing of the others' neighbourhood.
   pure subroutine find_candidates(search, slave_x, slave_edges, master_x, master_edges, search_radius)
      type(search_t), intent(inout) :: search
      real(wp), intent(in) :: slave_x(:, :), master_x(:, :)           !< (2, nodes) [m]
      integer, intent(in) :: slave_edges(:, :), master_edges(:, :)    !< (3, edges)
      real(wp), intent(in) :: search_radius                                   !< [m], >= 0
      type(grid_t) :: grid
      real(wp) :: near
      integer :: i, j, k, e, place, cells(4), found

      call edge_boxes(slave_x, slave_edges, search%slave_box)
      near = search_radius
      do e = 1, size(slave_edges, 2)
         if (.not. search_radius > 0.0_wp) near = norm2(slave_x(:, slave_edges(2, e)) - slave_x(:, slave_edges(1, e)))
         search%slave_box(1:2, e) = search%slave_box(1:2, e) - near
         search%slave_box(3:4, e) = search%slave_box(3:4, e) + near
      end do
      call edge_boxes(master_x, master_edges, search%master_box)
      grid = grid_for(search%master_box, search%slave_box)
      call sort_into_places(search, grid)

      search%seen_by = 0
      search%checks = 0
      found = 0
      do e = 1, size(slave_edges, 2)
         search%first(e) = found + 1
         if (.not. boxes_meet(search%slave_box(:, e), grid%whole)) cycle
         cells = cells_of(grid, search%slave_box(:, e))
         do j = cells(2), cells(4)
            do i = cells(1), cells(3)
               place = place_of(i, j, size(search%place_first) - 3)
               do k = search%place_first(place), search%place_first(place + 1) - 1
                  associate (master => search%entry(k))
                     if (search%seen_by(master) == e) cycle
                     search%seen_by(master) = e
                     search%checks = search%checks + 1
                     if (.not. boxes_meet(search%slave_box(:, e), search%master_box(:, master))) cycle
                     found = found + 1
                     if (found > size(search%candidate)) call grow(search%candidate)
                     search%candidate(found) = master
                  end associate
               end do
            end do
         end do
      end do
      search%first(size(slave_edges, 2) + 1) = found + 1
   end subroutine find_candidates

   !> Box of the control polygon, which holds the curve: lower r, lower z, upper r, upper z.
   pure subroutine edge_boxes(x, edges, box)
      real(wp), intent(in) :: x(:, :)   !< (2, nodes) [m]
      integer, intent(in) :: edges(:, :)   !< (3, edges) start, end, middle.
      real(wp), intent(out) :: box(:, :)   !< (4, edges) [m]
      real(wp) :: a(2), b(2), control(2)
      integer :: e

      do e = 1, size(edges, 2)
         a = x(:, edges(1, e))
         b = x(:, edges(2, e))
         control = 2.0_wp*x(:, edges(3, e)) - 0.5_wp*(a + b)
         box(1:2, e) = min(a, b, control)
         box(3:4, e) = max(a, b, control)
      end do
   end subroutine edge_boxes

   !> Whether two boxes (lower r, lower z, upper r, upper z) have a point in common.
   pure logical function boxes_meet(a, b)
      real(wp), intent(in) :: a(4), b(4)   !< [m]

      boxes_meet = all(a(1:2) <= b(3:4)) .and. all(b(1:2) <= a(3:4))
   end function boxes_meet

   !> Cells as large as a box on average; larger where a few large boxes would lie over too many of them.
   pure function grid_for(box, others) result(grid)
      real(wp), intent(in) :: box(:, :), others(:, :)
      type(grid_t) :: grid
      real(wp) :: mean
      integer :: i
      integer(int64) :: touched

      grid%whole(1:2) = minval(box(1:2, :), dim=2)
      grid%whole(3:4) = maxval(box(3:4, :), dim=2)
      mean = (sum(maxval(box(3:4, :) - box(1:2, :), dim=1)) + &
              sum(maxval(others(3:4, :) - others(1:2, :), dim=1)))/(size(box, 2) + size(others, 2))
      grid%side = max(mean, maxval(grid%whole(3:4) - grid%whole(1:2))/MOST_CELLS, tiny(mean))
      do
         touched = 0
         do i = 1, size(box, 2)
            touched = touched + number_of(cells_of(grid, box(:, i)))
         end do
         do i = 1, size(others, 2)
            touched = touched + number_of(cells_of(grid, others(:, i)))
         end do
         ! It ends: with cells as large as the master every box touches at most four.
         if (touched <= CELLS_PER_EDGE*(size(box, 2, int64) + size(others, 2, int64))) exit
         grid%side = 2.0_wp*grid%side
      end do
   contains
      pure integer(int64) function number_of(cells)
         integer, intent(in) :: cells(4)

         number_of = int(cells(3) - cells(1) + 1, int64)*(cells(4) - cells(2) + 1)
      end function number_of
   end function grid_for

   !> First and last cell of a box in both directions, within the master's.
   pure function cells_of(grid, box) result(cells)
      type(grid_t), intent(in) :: grid
      real(wp), intent(in) :: box(4)
      integer :: cells(4)

      cells(1:2) = int((min(max(box(1:2), grid%whole(1:2)), grid%whole(3:4)) - grid%whole(1:2))/grid%side)
      cells(3:4) = int((min(max(box(3:4), grid%whole(1:2)), grid%whole(3:4)) - grid%whole(1:2))/grid%side)
   end function cells_of

   !> Place of a cell in the list, from 1: two large primes spread the cells of a line and of a block.
   pure integer function place_of(i, j, places)
      integer, intent(in) :: i, j, places

      place_of = 1 + int(modulo(ieor(73856093_int64*i, 19349663_int64*j), int(places, int64)))
   end function place_of

   !> Counts, then fills: the entries of place p are entry(place_first(p) : place_first(p + 1) - 1).
   pure subroutine sort_into_places(search, grid)
      type(search_t), intent(inout) :: search
      type(grid_t), intent(in) :: grid
      integer :: i, j, e, place, places, pass, cells(4)

      places = size(search%place_first) - 3
      search%place_first = 0
      do pass = 1, 2
         do e = 1, size(search%master_box, 2)
            cells = cells_of(grid, search%master_box(:, e))
            do j = cells(2), cells(4)
               do i = cells(1), cells(3)
                  place = place_of(i, j, places)
                  ! Pass 1 counts place p at p + 2; pass 2 moves the start of p, kept at p + 1, to its end.
                  if (pass == 2) search%entry(search%place_first(place + 1)) = e
                  search%place_first(place + 3 - pass) = search%place_first(place + 3 - pass) + 1
               end do
            end do
         end do
         if (pass == 2) exit
         search%place_first(1:2) = 1
         do place = 3, places + 2
            search%place_first(place) = search%place_first(place) + search%place_first(place - 1)
         end do
         do while (search%place_first(places + 2) - 1 > size(search%entry))
            call grow(search%entry)
         end do
      end do
   end subroutine sort_into_places

   !> Doubles the room of a list.
   pure subroutine grow(list)
      integer, allocatable, intent(inout) :: list(:)
      integer, allocatable :: larger(:)

      allocate (larger(2*size(list)))
      larger(:size(list)) = list
      call move_alloc(larger, list)
   end subroutine grow
end module contact_search
