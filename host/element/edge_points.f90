! SPDX-License-Identifier: MIT
!> The integration points of an edge of the mesh, for everything that acts on a boundary: docs/theory/host.md section
!> 3.1.
module edge_points
   use kinds, only: wp, PI
   use porous_domain, only: domain_t
   use shape_functions, only: edge_quadratic, edge_rule
   implicit none (type, external)
   private
   public :: edge_point_t, points_of_edge, PER_EDGE

   integer, parameter :: PER_EDGE = 3

   type :: edge_point_t
      real(wp) :: n(3) = 0.0_wp, m(3) = 0.0_wp   !< Shape functions of displacements and of pressures [-].
      real(wp) :: x(2) = 0.0_wp                  !< Place [m].
      real(wp) :: tangent(2) = 0.0_wp            !< dx/ds; turned right it is the outward normal times its length [m].
      real(wp) :: ring = 0.0_wp                  !< Weight of the rule, times 2 pi r in axisymmetry [- or m].
      real(wp) :: area = 0.0_wp                  !< ring |tangent| [m or m2]
   end type edge_point_t
contains
   !> The body lies on the left of the edge.
   pure function points_of_edge(domain, edge) result(points)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: edge(3)   !< Nodes: start, end, middle.
      type(edge_point_t) :: points(PER_EDGE)
      real(wp) :: s(PER_EDGE), weights(PER_EDGE), dn(3)
      integer :: g

      call edge_rule(s, weights)
      do g = 1, PER_EDGE
         associate (p => points(g))
            call edge_quadratic(s(g), p%n, dn)
            p%m = p%n
            if (domain%n_p == 3) p%m = [0.5_wp*(1 - s(g)), 0.5_wp*(1 + s(g)), 0.0_wp]
            p%x = matmul(domain%mesh%x(:, edge), p%n)
            p%tangent = matmul(domain%mesh%x(:, edge), dn)
            p%ring = weights(g)
            if (domain%axisymmetric) p%ring = p%ring*2*PI*p%x(1)
            p%area = p%ring*norm2(p%tangent)
         end associate
      end do
   end function points_of_edge
end module edge_points
