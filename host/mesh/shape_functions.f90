! SPDX-License-Identifier: MIT
!> Shape functions of 6-node and 3-node triangles and of 3-node edges, and quadrature rules.
!> Nodes as in Gmsh: vertices 1, 2, 3, then the middles of 1-2, 2-3, 3-1; an edge is vertex, vertex, middle.
module shape_functions
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: quadratic, linear, edge_quadratic, triangle_rule, edge_rule, RULES

   !> Numbers of points for which there is a rule, exact to degree 2, 4, 5, 6.
   integer, parameter :: RULES(4) = [3, 6, 7, 12]
contains
   !> Evaluates the six functions at (xi, eta) of the unit triangle, and their derivatives. The nodes are ordered as
   !> above; dn(1, :) is by xi, dn(2, :) by eta.
   pure subroutine quadratic(xi, eta, n, dn)
      real(wp), intent(in) :: xi, eta
      real(wp), intent(out) :: n(6), dn(2, 6)
      real(wp) :: l

      l = 1.0_wp - xi - eta
      n = [l*(2*l - 1), xi*(2*xi - 1), eta*(2*eta - 1), 4*l*xi, 4*xi*eta, 4*eta*l]
      dn(1, :) = [1 - 4*l, 4*xi - 1, 0.0_wp, 4*(l - xi), 4*eta, -4*eta]
      dn(2, :) = [1 - 4*l, 0.0_wp, 4*eta - 1, -4*xi, 4*xi, 4*(l - eta)]
   end subroutine quadratic

   !> Evaluates the three linear functions of the vertices, as `quadratic` does those of six nodes.
   pure subroutine linear(xi, eta, n, dn)
      real(wp), intent(in) :: xi, eta
      real(wp), intent(out) :: n(3), dn(2, 3)

      n = [1.0_wp - xi - eta, xi, eta]
      dn(1, :) = [-1.0_wp, 1.0_wp, 0.0_wp]
      dn(2, :) = [-1.0_wp, 0.0_wp, 1.0_wp]
   end subroutine linear

   !> Evaluates the functions of an edge, start, end, middle, where s goes from -1 to 1; dn is by s.
   pure subroutine edge_quadratic(s, n, dn)
      real(wp), intent(in) :: s
      real(wp), intent(out) :: n(3), dn(3)

      n = [0.5_wp*s*(s - 1), 0.5_wp*s*(s + 1), 1 - s*s]
      dn = [s - 0.5_wp, s + 0.5_wp, -2*s]
   end subroutine edge_quadratic

   !> Gives points (xi, eta) and weights, which add up to the area 1/2, by Strang & Fix (1973) and Dunavant (1985).
   !> docs/theory/host.md section 3.1.
   subroutine triangle_rule(count, points, weights)
      integer, intent(in) :: count   !< One of RULES.
      real(wp), intent(out) :: points(2, count), weights(count)
      real(wp), parameter :: ROOT = 3.87298334620741688518_wp   ! sqrt(15)
      integer :: used

      used = 0
      select case (count)
      case (3)
         call add_three_points(1.0_wp/6, 1.0_wp/3)
      case (6)
         call add_three_points(0.44594849091596488632_wp, 0.22338158967801146570_wp)
         call add_three_points(0.091576213509770743460_wp, 0.10995174365532186764_wp)
      case (7)
         points(:, 1) = 1.0_wp/3
         weights(1) = 0.1125_wp
         used = 1
         call add_three_points((6 + ROOT)/21, (155 + ROOT)/1200)
         call add_three_points((6 - ROOT)/21, (155 - ROOT)/1200)
      case default
         call add_three_points(0.24928674517091042129_wp, 0.11678627572637936603_wp)
         call add_three_points(0.063089014491502227340_wp, 0.050844906370206816921_wp)
         call six(0.053145049844816947353_wp, 0.31035245103378440542_wp, 0.082851075618373575194_wp)
      end select
   contains
      !> Adds the three points with two barycentric coordinates equal to a.
      subroutine add_three_points(a, weight)
         real(wp), intent(in) :: a, weight

         points(:, used + 1) = [a, a]
         points(:, used + 2) = [1 - 2*a, a]
         points(:, used + 3) = [a, 1 - 2*a]
         weights(used + 1:used + 3) = 0.5_wp*weight
         used = used + 3
      end subroutine add_three_points

      !> Adds the six permutations of (a, b, 1 - a - b).
      subroutine six(a, b, weight)
         real(wp), intent(in) :: a, b, weight
         real(wp) :: c

         c = 1 - a - b
         points(:, used + 1:used + 6) = reshape([a, b, b, a, b, c, c, b, a, c, c, a], [2, 6])
         weights(used + 1:used + 6) = 0.5_wp*weight
         used = used + 6
      end subroutine six
   end subroutine triangle_rule

   !> Gives the three points of Gauss and Legendre on (-1, 1), exact to degree 5.
   pure subroutine edge_rule(points, weights)
      real(wp), intent(out) :: points(3), weights(3)

      points = [-0.77459666924148337704_wp, 0.0_wp, 0.77459666924148337704_wp]
      weights = [5.0_wp, 8.0_wp, 5.0_wp]/9
   end subroutine edge_rule
end module shape_functions
