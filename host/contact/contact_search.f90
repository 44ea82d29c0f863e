! SPDX-License-Identifier: MIT
!> Search for the master edges that may lie opposite a slave edge, by boxes around the edges. Every pair of boxes is
!> compared: edges of a boundary are about as many as the root of the triangles of its mesh, so that all comparisons
!> together cost less than a hundredth of a pass over these.
module contact_search
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: search_t, find_candidates, edge_boxes, boxes_meet

   !> The candidates of slave edge i are candidate(first(i) : first(i + 1) - 1), each once.
   type :: search_t
      integer, allocatable :: first(:)       !< (slave edges + 1)
      integer, allocatable :: candidate(:)   !< Master edges; more room than is used.
   end type search_t
contains
   !> Candidates of every slave edge: the master edges whose boxes come within `search_radius` of its own; with 0,
   !> within its own length, so that a long edge elsewhere makes nothing of the others' neighbourhood.
   pure subroutine find_candidates(search, slave_x, slave_edges, master_x, master_edges, search_radius)
      type(search_t), intent(out) :: search
      real(wp), intent(in) :: slave_x(:, :), master_x(:, :)           !< (2, nodes) [m]
      integer, intent(in) :: slave_edges(:, :), master_edges(:, :)    !< (3, edges)
      real(wp), intent(in) :: search_radius                           !< [m], >= 0
      real(wp) :: slaves(4, size(slave_edges, 2)), masters(4, size(master_edges, 2)), near
      integer :: e, i, found

      allocate (search%first(size(slaves, 2) + 1), search%candidate(4*(size(slaves, 2) + size(masters, 2))))
      call edge_boxes(slave_x, slave_edges, slaves)
      call edge_boxes(master_x, master_edges, masters)
      near = search_radius
      found = 0
      do e = 1, size(slaves, 2)
         search%first(e) = found + 1
         if (.not. search_radius > 0.0_wp) near = norm2(slave_x(:, slave_edges(2, e)) - slave_x(:, slave_edges(1, e)))
         slaves(:, e) = slaves(:, e) + near*[-1, -1, 1, 1]
         do i = 1, size(masters, 2)
            if (.not. boxes_meet(slaves(:, e), masters(:, i))) cycle
            found = found + 1
            if (found > size(search%candidate)) search%candidate = [search%candidate, spread(0, 1, found)]
            search%candidate(found) = i
         end do
      end do
      search%first(size(slaves, 2) + 1) = found + 1
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
end module contact_search
