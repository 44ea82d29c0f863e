! SPDX-License-Identifier: MIT
!> Mortar integration between one slave edge and one master edge: the part of the slave edge that lies opposite, its
!> segments and integration points with their derivatives, and what they add to the weights and gaps of the nodes.
!>
!> A slave point x_s(s) with tangent t = dx_s/ds and normal nu = (t_2, -t_1) lies opposite the master point x_m(m) on
!> its normal: (x_m - x_s).t = 0. With y = x_m - x_s the gap is y.nu/|t| (open > 0), so gap ds = y.nu: no root in it.
!> Local coordinates: (2, 6), slave start, end, middle, master start, end, middle; derivatives follow them in that order
!> as 12 numbers. Everything that moves with the coordinates is in the derivatives: ends of segments, points, normals,
!> lengths, radii.
!> docs/theory/contact.md section 2.
module contact_mortar
   use contact_projection, only: edge_t, edge_of, shapes, shape_slopes, place, tangent, project_point, follow_normal, &
                                 INSIDE, BEFORE, BEYOND, SAME_PLACE
   use contact_types, only: TWO_PI
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: overlap_t, mortar_point_t, hat_sums_t, find_overlap, integration_point, pair_points, pair_gaps, &
             add_under_hats, add_unit_forces, penetration, hats, hat_slopes, forces_on_nodes
   public :: POINTS, POSITION, SHARE, LARGEST_POINTS

   integer, parameter :: POINTS = 4   !< Gauss points of a segment.
   real(wp), parameter :: POSITION(POINTS) = [-0.861136311594052575224_wp, -0.339981043584856264803_wp, &
                                              0.339981043584856264803_wp, 0.861136311594052575224_wp]
   real(wp), parameter :: SHARE(POINTS) = [0.347854845137453857373_wp, 0.652145154862546142627_wp, &
                                           0.652145154862546142627_wp, 0.347854845137453857373_wp]
   !> Lobatto's rule, which looks at both ends of a segment: a corner lies there.
   real(wp), parameter :: END_POSITION(POINTS) = [-1.0_wp, -0.447213595499957939282_wp, &
                                                  0.447213595499957939282_wp, 1.0_wp]
   real(wp), parameter :: END_SHARE(POINTS) = [1.0_wp, 5.0_wp, 5.0_wp, 1.0_wp]/6.0_wp
   integer, parameter :: LARGEST_SEGMENTS = 3   !< Two ends, and the two middle nodes between them.
   integer, parameter :: LARGEST_POINTS = LARGEST_SEGMENTS*POINTS   !< Most points of a pair.
   !> Cosine of the steepest master edge that a slave edge sees: beyond 78 degrees nothing is pressed any more.
   real(wp), parameter :: LEAST_FACING = 0.2_wp
   !> A ray may miss the edge it must hit by so much of its length: rounding of an end next to a short segment.
   real(wp), parameter :: MISS = 1.0e-6_wp

   !> The part of a slave edge opposite a master edge, cut into segments from end(i) to end(i + 1).
   type :: overlap_t
      integer :: segments = 0
      real(wp) :: end(LARGEST_SEGMENTS + 1) = 0.0_wp             !< Ascending, on the slave edge [-].
      integer :: follows(LARGEST_SEGMENTS + 1) = 0               !< Master node (1 to 3) whose foot it is; 0: fixed
      real(wp) :: d_end(12, LARGEST_SEGMENTS + 1) = 0.0_wp       !< [1/m]
   end type overlap_t

   !> An integration point with first derivatives by the local coordinates (d_...).
   type :: mortar_point_t
      real(wp) :: s = 0.0_wp, m = 0.0_wp          !< Place on the slave and the master edge [-].
      real(wp) :: ns(3) = 0.0_wp, dns(3) = 0.0_wp !< Slave shape functions and slopes [-].
      real(wp) :: nm(3) = 0.0_wp, dnm(3) = 0.0_wp !< Master shape functions and slopes [-].
      real(wp) :: x(2) = 0.0_wp                   !< Slave point [m].
      real(wp) :: y(2) = 0.0_wp                   !< From the slave point to the master point [m].
      real(wp) :: t(2) = 0.0_wp                   !< Slave tangent dx_s/ds [m].
      real(wp) :: t_bend(2) = 0.0_wp              !< dt/ds [m]
      real(wp) :: tm(2) = 0.0_wp                  !< Master tangent dx_m/dm [m].
      real(wp) :: slip = 0.0_wp                   !< tm.t, < 0 [m2]
      real(wp) :: area = 0.0_wp                   !< Weight of the rule times half the segment times 2 pi r [m or 1]
      real(wp) :: ring = 1.0_wp, d_ring(12) = 0.0_wp    !< 2 pi r [m], or 1.
      real(wp) :: span = 0.0_wp, d_span(12) = 0.0_wp    !< Length of the segment on the edge [-].
      real(wp) :: phi = 0.0_wp, d_phi(12) = 0.0_wp      !< y.nu = gap |t| [m2]
      real(wp) :: length = 0.0_wp, d_length(12) = 0.0_wp !< |t| [m]
      real(wp) :: d_area(12) = 0.0_wp
      real(wp) :: d_s(12) = 0.0_wp, d_m(12) = 0.0_wp
      real(wp) :: d_xs(2, 12) = 0.0_wp, d_t(2, 12) = 0.0_wp, d_xm(2, 12) = 0.0_wp
   end type mortar_point_t

   !> Integrals of a quantity under the hats of the three nodes of a slave edge, and their slopes by the local
   !> coordinates.
   type :: hat_sums_t
      real(wp) :: value(3) = 0.0_wp, slope(12, 3) = 0.0_wp
   end type hat_sums_t
contains
   !> The hats are piecewise linear on the halves of a slave edge: start, end, middle. docs/theory/contact.md section
   !> 2.3.
   pure function hats(s) result(m)
      real(wp), intent(in) :: s   !< In [-1, 1].
      real(wp) :: m(3)

      m = [max(-s, 0.0_wp), max(s, 0.0_wp), 1.0_wp - abs(s)]
   end function hats

   !> Differentiates the hat functions by s; a point never lies on the middle node, where segments end [-].
   pure function hat_slopes(s) result(dm)
      real(wp), intent(in) :: s   !< In [-1, 1].
      real(wp) :: dm(3)

      if (s < 0.0_wp) then
         dm = [-1.0_wp, 0.0_wp, 1.0_wp]
      else
         dm = [0.0_wp, 1.0_wp, -1.0_wp]
      end if
   end function hat_slopes

   !> Finds the segments of a slave edge opposite a master edge. The bodies face each other, so the master edge runs
   !> against the slave edge: its end has the first foot. Segments end at the feet of the master's three nodes and at
   !> the slave's. None where they do not face each other within 78 degrees. docs/theory/contact.md section 2.2.
   pure subroutine find_overlap(x, free, overlap)
      real(wp), intent(in) :: x(2, 6)          !< Local coordinates [m].
      logical, intent(in) :: free(2)           !< The master's surface ends at the start, the end of its edge.
      type(overlap_t), intent(out) :: overlap
      type(edge_t) :: slave
      real(wp) :: chord_s(2), chord_m(2), foot(3), lower, upper, s
      integer :: where_it_is(3), node(2), j

      chord_s = x(:, 2) - x(:, 1)
      chord_m = x(:, 5) - x(:, 4)
      if (dot_product(chord_s, chord_m) > -LEAST_FACING*norm2(chord_s)*norm2(chord_m)) return
      slave = edge_of(x(:, 1:3))
      do j = 1, 3
         call project_point(slave, x(:, 3 + j), foot(j), where_it_is(j))
      end do
      if (where_it_is(2) == BEYOND .or. where_it_is(1) == BEFORE) return
      lower = foot(2)
      upper = foot(1)
      if (upper - lower <= SAME_PLACE) return

      ! A cut next to another end is left out: a segment without length still moves, it must not be there at all.
      node = merge([3, 0], [0, 3], foot(3) < 0.0_wp)
      overlap%segments = 1
      overlap%end(1) = lower
      do j = 1, 2
         s = merge(foot(3), 0.0_wp, node(j) == 3)
         if (node(j) == 3 .and. (where_it_is(3) /= INSIDE .or. abs(s) <= SAME_PLACE)) cycle
         if (.not. (s - lower > SAME_PLACE .and. upper - s > SAME_PLACE)) cycle
         overlap%segments = overlap%segments + 1
         overlap%end(overlap%segments) = s
         overlap%follows(overlap%segments) = node(j)
      end do
      overlap%end(overlap%segments + 1) = upper
      ! On a vertex of the slave the next pair goes on where this one ends, and their changes cancel; where the master
      ! itself ends nobody goes on.
      overlap%follows(1) = merge(2, 0, where_it_is(2) == INSIDE .and. (free(2) .or. lower > -1.0_wp))
      overlap%follows(overlap%segments + 1) = merge(1, 0, where_it_is(1) == INSIDE .and. (free(1) .or. upper < 1.0_wp))
      do j = 1, overlap%segments + 1
         if (overlap%follows(j) > 0) overlap%d_end(:, j) = end_slope(x, slave, overlap%follows(j), overlap%end(j))
      end do
   end subroutine find_overlap

   !> Differentiates the foot s of master node j, where (x_j - x(s)).t(s) = 0, by the 12 local coordinates [1/m]:
   !> docs/theory/contact.md section 3.2.
   pure function end_slope(x, slave, j, s) result(d_s)
      real(wp), intent(in) :: x(2, 6), s   !< Local coordinates [m], place in [-1, 1].
      type(edge_t), intent(in) :: slave
      integer, intent(in) :: j   !< 1 to 3.
      real(wp) :: d_s(12), y(2), t(2), n(3), dn(3)
      integer :: i

      y = x(:, 3 + j) - place(slave, s)
      t = tangent(slave, s)
      n = shapes(s)
      dn = shape_slopes(s)
      d_s = 0.0_wp
      do i = 1, 3
         d_s(2*i - 1:2*i) = dn(i)*y - n(i)*t
      end do
      d_s(2*j + 5:2*j + 6) = t
      d_s = d_s/(dot_product(t, t) - 2.0_wp*dot_product(y, slave%bend))
   end function end_slope

   !> Makes a point of a segment. `missed`: by how much of the master edge's length the normal misses it, 0 if it hits.
   !> Where it misses, the rest of p is not filled. docs/theory/contact.md sections 2.1, 2.2 and 3.2.
   pure subroutine integration_point(x, overlap, segment, position, share, axisymmetric, p, missed)
      real(wp), intent(in) :: x(2, 6)   !< Local coordinates [m].
      type(overlap_t), intent(in) :: overlap
      integer, intent(in) :: segment
      real(wp), intent(in) :: position, share   !< Place of the point in [-1, 1], and its part of 2.
      logical, intent(in) :: axisymmetric
      type(mortar_point_t), intent(out) :: p
      real(wp), intent(out) :: missed   !< [-]
      type(edge_t) :: slave, master
      real(wp) :: a, b
      integer :: i, where_it_is

      slave = edge_of(x(:, 1:3))
      master = edge_of(x(:, 4:6))
      a = 0.5_wp*(1.0_wp - position)
      b = 0.5_wp*(1.0_wp + position)
      p%s = a*overlap%end(segment) + b*overlap%end(segment + 1)
      p%span = overlap%end(segment + 1) - overlap%end(segment)
      p%x = place(slave, p%s)
      p%t = tangent(slave, p%s)
      call follow_normal(master, p%x, p%t, p%m, where_it_is)
      p%y = place(master, p%m) - p%x
      p%tm = tangent(master, p%m)
      p%slip = dot_product(p%tm, p%t)
      missed = 0.0_wp
      if (where_it_is /= INSIDE) missed = abs(dot_product(p%y, p%t))/(norm2(p%t)*norm2(master%slope))
      if (missed < MISS) missed = 0.0_wp
      ! A normal that only touches the edge hits it nowhere.
      if (p%slip >= -MISS*norm2(p%t)*norm2(master%slope)) missed = max(missed, 1.0_wp)
      if (missed > 0.0_wp) return

      p%ns = shapes(p%s)
      p%dns = shape_slopes(p%s)
      p%nm = shapes(p%m)
      p%dnm = shape_slopes(p%m)
      p%t_bend = 2.0_wp*slave%bend
      p%phi = p%y(1)*p%t(2) - p%y(2)*p%t(1)
      p%length = norm2(p%t)
      if (axisymmetric) p%ring = TWO_PI*p%x(1)
      p%area = 0.5_wp*share*p%span*p%ring

      p%d_s = a*overlap%d_end(:, segment) + b*overlap%d_end(:, segment + 1)
      p%d_span = overlap%d_end(:, segment + 1) - overlap%d_end(:, segment)
      ! y.t = 0 stays true.
      p%d_m = (dot_product(p%y, p%t_bend) - dot_product(p%t, p%t))*p%d_s
      do i = 1, 3
         p%d_m(2*i - 1:2*i) = p%d_m(2*i - 1:2*i) + p%dns(i)*p%y - p%ns(i)*p%t
         p%d_m(2*i + 5:2*i + 6) = p%d_m(2*i + 5:2*i + 6) + p%nm(i)*p%t
      end do
      p%d_m = -p%d_m/p%slip
      do i = 1, 2
         p%d_xs(i, :) = p%t(i)*p%d_s
         p%d_t(i, :) = p%t_bend(i)*p%d_s
         p%d_xm(i, :) = p%tm(i)*p%d_m
         p%d_xs(i, i:4 + i:2) = p%d_xs(i, i:4 + i:2) + p%ns
         p%d_t(i, i:4 + i:2) = p%d_t(i, i:4 + i:2) + p%dns
         p%d_xm(i, 6 + i:10 + i:2) = p%d_xm(i, 6 + i:10 + i:2) + p%nm
      end do
      p%d_phi = p%t(2)*(p%d_xm(1, :) - p%d_xs(1, :)) - p%t(1)*(p%d_xm(2, :) - p%d_xs(2, :)) &
                + p%y(1)*p%d_t(2, :) - p%y(2)*p%d_t(1, :)
      p%d_length = (p%t(1)*p%d_t(1, :) + p%t(2)*p%d_t(2, :))/p%length
      if (axisymmetric) p%d_ring = TWO_PI*p%d_xs(1, :)
      p%d_area = 0.5_wp*share*(p%ring*p%d_span + p%span*p%d_ring)
   end subroutine integration_point

   !> Makes the integration points of a pair of edges. `missed` as of integration_point: the first n - 1 points hit, and
   !> all of them where it is 0. docs/theory/contact.md section 2.2.
   pure subroutine pair_points(x, overlap, at_ends, axisymmetric, p, n, missed)
      real(wp), intent(in) :: x(2, 6)   !< Local coordinates [m].
      type(overlap_t), intent(in) :: overlap
      logical, intent(in) :: at_ends, axisymmetric   !< at_ends: points at the ends of segments too.
      type(mortar_point_t), intent(inout) :: p(LARGEST_POINTS)
      integer, intent(out) :: n   !< Points that are filled.
      real(wp), intent(out) :: missed   !< [-]
      integer :: segment, k

      n = 0
      missed = 0.0_wp
      do segment = 1, overlap%segments
         do k = 1, POINTS
            n = n + 1
            call integration_point(x, overlap, segment, merge(END_POSITION(k), POSITION(k), at_ends), &
                                   merge(END_SHARE(k), SHARE(k), at_ends), axisymmetric, p(n), missed)
            if (missed > 0.0_wp) return
         end do
      end do
   end subroutine pair_points

   !> Sums weights int M 2 pi r dGamma of a pair of edges at the three slave nodes [m2] (plane: m), times gaps [m3]
   !> (plane: m2), and push(:, A) = int M_A (nu N_s, -nu N_m) 2 pi r ds, the nodal forces of a unit pressure at node A.
   !> docs/theory/contact.md section 2.3.
   pure subroutine pair_gaps(points, weight, gap, push)
      type(mortar_point_t), intent(in) :: points(:)
      type(hat_sums_t), intent(out) :: weight, gap
      real(wp), intent(out) :: push(12, 3)
      integer :: k

      push = 0.0_wp
      do k = 1, size(points)
         associate (p => points(k))
            call add_under_hats(p, p%length, p%d_length, weight)
            call add_under_hats(p, p%phi, p%d_phi, gap)
            call add_unit_forces(p, forces_on_nodes(p, [p%t(2), -p%t(1)]), push)
         end associate
      end do
   end subroutine pair_gaps

   !> Adds a point to the integrals of a quantity, which is given times the length of the tangent.
   pure subroutine add_under_hats(p, value, slope, sums)
      type(mortar_point_t), intent(in) :: p
      real(wp), intent(in) :: value, slope(12)
      type(hat_sums_t), intent(inout) :: sums
      real(wp) :: m(3), dm(3)
      integer :: a

      m = hats(p%s)
      dm = hat_slopes(p%s)
      do a = 1, 3
         if (m(a) <= 0.0_wp) cycle
         sums%value(a) = sums%value(a) + p%area*m(a)*value
         sums%slope(:, a) = sums%slope(:, a) + (m(a)*p%d_area + p%area*dm(a)*p%d_s)*value + p%area*m(a)*slope
      end do
   end subroutine add_under_hats

   !> Adds what a point has of the nodal forces of a unit pressure or traction at each slave node.
   pure subroutine add_unit_forces(p, of_point, forces)
      type(mortar_point_t), intent(in) :: p
      real(wp), intent(in) :: of_point(12)   !< As of forces_on_nodes [m].
      real(wp), intent(inout) :: forces(12, 3)
      real(wp) :: m(3)
      integer :: a

      m = hats(p%s)
      do a = 1, 3
         forces(:, a) = forces(:, a) + p%area*m(a)*of_point
      end do
   end subroutine add_unit_forces

   !> Finds the forces on the nodes of a pair, slave first, of a unit force along a direction that pushes the surfaces
   !> apart at a point. docs/theory/contact.md sections 2.3 and 9.
   pure function forces_on_nodes(p, along) result(force)
      type(mortar_point_t), intent(in) :: p
      real(wp), intent(in) :: along(2)   !< As long as the slave's tangent [m].
      real(wp) :: force(12)
      integer :: i

      do i = 1, 3
         force(2*i - 1:2*i) = p%ns(i)*along
         force(2*i + 5:2*i + 6) = -p%nm(i)*along
      end do
   end function forces_on_nodes

   !> Finds the deepest penetration of a pair of edges [m], 0 if it is open: at the ends of the segments too, where
   !> corners are. docs/theory/contact.md sections 2.1 and 2.4.
   pure real(wp) function penetration(x, overlap) result(depth)
      real(wp), intent(in) :: x(2, 6)   !< Local coordinates [m].
      type(overlap_t), intent(in) :: overlap
      type(mortar_point_t) :: p
      real(wp) :: missed
      integer :: segment, k

      depth = 0.0_wp
      do segment = 1, overlap%segments
         do k = 1, POINTS
            call integration_point(x, overlap, segment, END_POSITION(k), END_SHARE(k), .false., p, missed)
            if (.not. missed > 0.0_wp) depth = max(depth, -p%phi/p%length)
         end do
      end do
   end function penetration
end module contact_mortar
