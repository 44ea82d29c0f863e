! SPDX-License-Identifier: MIT
!> Two surfaces that may come into contact: their edges, once per mesh, whether given coordinates will do, and boxes
!> around edges, of which those that meet may lie opposite each other. docs/theory/contact.md section 2.
module contact_geometry
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use contact_projection, only: edge_of, least_stretch
   use contact_types, only: contact_options_t, contact_status_t, CONTACT_OK, CONTACT_BAD_EDGE, CONTACT_NOT_FINITE, &
                            CONTACT_BAD_RADIUS, CONTACT_DISTORTED_EDGE
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: contact_geometry_t, contact_prepare, check_coordinates, edge_boxes, boxes_around, boxes_meet

   !> A tangent of this share of half the chord is none: rounding of a fold leaves 1e-8, the root of 1e-16.
   real(wp), parameter :: LEAST_STRETCH_LENGTH = 1.0e-6_wp

   !> Two surfaces that may meet, prepared once. Unknowns are numbered 2 (node - 1) + direction, first the slave's
   !> nodes, then the master's.
   type :: contact_geometry_t
      integer :: slave_nodes = 0, master_nodes = 0
      type(contact_options_t) :: options
      integer, allocatable :: slave_edges(:, :), master_edges(:, :)
      integer, allocatable :: edges_of(:, :)    !< (2, slave nodes), 0 if there is none
      logical, allocatable :: free(:)           !< (master nodes) in one edge only: the surface ends there.
   end type contact_geometry_t
contains
   !> Prepares two surfaces: (3, edges) node numbers of each in the order start, end, middle, the body on the
   !> left. docs/theory/contact.md section 2. status: CONTACT_OK; CONTACT_BAD_EDGE, a node that does not
   !> exist, is in more than two edges, or in two and the middle of one.
   pure subroutine contact_prepare(geometry, slave_nodes, slave_edges, master_nodes, master_edges, options, status)
      type(contact_geometry_t), intent(out) :: geometry
      integer, intent(in) :: slave_nodes, master_nodes   !< Numbers of nodes of both surfaces.
      integer, intent(in) :: slave_edges(:, :), master_edges(:, :)   !< (3, edges)
      type(contact_options_t), intent(in) :: options
      type(contact_status_t), intent(out) :: status
      integer, allocatable :: edges_of(:, :)

      call list_edges(slave_edges, slave_nodes, .false., geometry%edges_of, status)
      if (status%code /= CONTACT_OK) return
      call list_edges(master_edges, master_nodes, .true., edges_of, status)
      if (status%code /= CONTACT_OK) return
      geometry%options = options
      geometry%slave_nodes = slave_nodes
      geometry%master_nodes = master_nodes
      geometry%slave_edges = slave_edges
      geometry%master_edges = master_edges
      geometry%free = edges_of(2, :) == 0
   end subroutine contact_prepare

   !> Lists the edges of every node: at most two, of a middle node one.
   pure subroutine list_edges(edges, nodes, master, edges_of, status)
      integer, intent(in) :: edges(:, :), nodes
      logical, intent(in) :: master
      integer, allocatable, intent(out) :: edges_of(:, :)
      type(contact_status_t), intent(out) :: status
      integer :: e, i, node
      logical :: good

      allocate (edges_of(2, max(nodes, 0)), source=0)
      do e = 1, size(edges, 2)
         do i = 1, 3
            node = edges(i, e)
            ! A middle node fills both places, so that nobody else may have it.
            good = node >= 1 .and. node <= nodes
            if (good) good = edges_of(2, node) == 0 .and. (i < 3 .or. edges_of(1, node) == 0)
            if (.not. good) then
               status = contact_status_t(CONTACT_BAD_EDGE, e, master, real(node, wp))
               return
            end if
            if (i == 3 .or. edges_of(1, node) > 0) edges_of(2, node) = e
            if (edges_of(1, node) == 0) edges_of(1, node) = e
         end do
      end do
      do e = 1, size(edges, 2)
         edges_of(2, edges(3, e)) = 0
      end do
   end subroutine list_edges

   !> Refuses present coordinates (2, nodes) [m] of both surfaces that are not finite, of
   !> slave nodes left of the axis, or whose edges are folded: status CONTACT_OK, or the first that is wrong.
   !> CONTACT_NOT_FINITE; CONTACT_DISTORTED_EDGE; CONTACT_BAD_RADIUS, a slave node at r < 0 in axial
   !> symmetry.
   pure subroutine check_coordinates(geometry, slave_x, master_x, status)
      type(contact_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: slave_x(:, :), master_x(:, :)   !< (2, nodes) [m]
      type(contact_status_t), intent(out) :: status
      real(wp) :: rounding   !< A support that holds a node on the axis may leave so much [m].
      integer :: i

      call check_surface(slave_x, geometry%slave_edges, .false., status)
      if (status%code /= CONTACT_OK) return
      call check_surface(master_x, geometry%master_edges, .true., status)
      if (status%code /= CONTACT_OK .or. .not. geometry%options%axisymmetric) return
      rounding = epsilon(1.0_wp)*maxval(abs(slave_x))
      i = findloc(slave_x(1, :) >= -rounding, .false., dim=1)
      if (i > 0) status = contact_status_t(CONTACT_BAD_RADIUS, i, .false., slave_x(1, i))
   end subroutine check_coordinates

   pure subroutine check_surface(x, edges, master, status)
      real(wp), intent(in) :: x(:, :)
      integer, intent(in) :: edges(:, :)
      logical, intent(in) :: master
      type(contact_status_t), intent(inout) :: status
      real(wp) :: stretch
      integer :: i

      i = findloc(all(ieee_is_finite(x), dim=1), .false., dim=1)
      if (i > 0) status = contact_status_t(CONTACT_NOT_FINITE, i, master)
      if (i > 0) return
      do i = 1, size(edges, 2)
         stretch = least_stretch(edge_of(x(:, edges(:, i))))
         if (stretch > LEAST_STRETCH_LENGTH) cycle
         status = contact_status_t(CONTACT_DISTORTED_EDGE, i, master, stretch)
         return
      end do
   end subroutine check_surface

   !> Boxes of edges, widened by a search radius; with 0 each by its own length, so that a long edge elsewhere makes
   !> nothing of the others' neighbourhood. Every pair of boxes is compared: edges of a boundary are about as many as
   !> the root of the triangles of its mesh, so that all comparisons together cost less than a hundredth of a pass over
   !> these.
   pure subroutine boxes_around(x, edges, search_radius, box)
      real(wp), intent(in) :: x(:, :)         !< (2, nodes) [m]
      integer, intent(in) :: edges(:, :)      !< (3, edges) start, end, middle.
      real(wp), intent(in) :: search_radius   !< [m], >= 0
      real(wp), intent(out) :: box(:, :)      !< (4, edges) [m]
      real(wp) :: near
      integer :: e

      call edge_boxes(x, edges, box)
      near = search_radius
      do e = 1, size(edges, 2)
         if (.not. search_radius > 0.0_wp) near = norm2(x(:, edges(2, e)) - x(:, edges(1, e)))
         box(:, e) = box(:, e) + near*[-1, -1, 1, 1]
      end do
   end subroutine boxes_around

   !> Finds the box of the control polygon of every edge, which holds the curve: lower r, lower z, upper r, upper z.
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
end module contact_geometry
