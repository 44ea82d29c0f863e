! SPDX-License-Identifier: MIT
!> Quadratic edges (nodes: start, end, middle; the body on the left, so that the outward normal points to the right) and
!> projections between them: of a point onto an edge, and along a given normal onto the edge opposite.
module contact_projection
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: edge_t, edge_of, shapes, shape_slopes, place, tangent, least_stretch
   public :: project_point, follow_normal, BEFORE, INSIDE, BEYOND, SAME_PLACE

   !> x(s) = middle + slope s + bend s**2, s in [-1, 1].
   type :: edge_t
      real(wp) :: middle(2) = 0.0_wp   !< [m]
      real(wp) :: slope(2) = 0.0_wp    !< [m]
      real(wp) :: bend(2) = 0.0_wp     !< [m]
   end type edge_t

   ! Where a foot lies.
   integer, parameter :: BEFORE = -1   !< The point lies before the start: s = -1.
   integer, parameter :: INSIDE = 0    !< Or at an end.
   integer, parameter :: BEYOND = 1    !< The point lies beyond the end: s = 1.

   !> Places on an edge that are not told apart: 1e-12 of its length, which is 2.
   real(wp), parameter :: SAME_PLACE = 2.0e-12_wp
   !> Bisection alone reaches the spacing of numbers from [-1, 1] in 53 halvings; Newton needs about 5 steps.
   integer, parameter :: MOST_STEPS = 64
   !> A step of two units in the last place of 1 is rounding, not progress.
   real(wp), parameter :: ROUNDING = 2.0_wp*epsilon(1.0_wp)
contains
   !> Evaluates the shape functions of an edge at s in [-1, 1]: start, end, middle.
   pure function shapes(s) result(n)
      real(wp), intent(in) :: s   !< In [-1, 1].
      real(wp) :: n(3)

      n = [-0.5_wp*s*(1.0_wp - s), 0.5_wp*s*(1.0_wp + s), (1.0_wp - s)*(1.0_wp + s)]
   end function shapes

   !> Differentiates the shape functions of an edge by s.
   pure function shape_slopes(s) result(dn)
      real(wp), intent(in) :: s   !< In [-1, 1].
      real(wp) :: dn(3)

      dn = [s - 0.5_wp, s + 0.5_wp, -2.0_wp*s]
   end function shape_slopes

   !> Fits the polynomial of an edge through three nodes.
   pure function edge_of(x) result(edge)
      real(wp), intent(in) :: x(2, 3)   !< Start, end, middle [m].
      type(edge_t) :: edge

      edge%middle = x(:, 3)
      edge%slope = 0.5_wp*(x(:, 2) - x(:, 1))
      edge%bend = 0.5_wp*((x(:, 1) - x(:, 3)) + (x(:, 2) - x(:, 3)))
   end function edge_of

   !> Finds the coordinates of the point s of an edge [m].
   pure function place(edge, s) result(x)
      type(edge_t), intent(in) :: edge
      real(wp), intent(in) :: s   !< In [-1, 1].
      real(wp) :: x(2)

      x = edge%middle + s*(edge%slope + s*edge%bend)
   end function place

   !> Differentiates the point of an edge by s, without scaling the tangent to unit length [m].
   pure function tangent(edge, s) result(t)
      type(edge_t), intent(in) :: edge
      real(wp), intent(in) :: s   !< In [-1, 1].
      real(wp) :: t(2)

      t = edge%slope + 2.0_wp*s*edge%bend
   end function tangent

   !> Finds the length of the shortest tangent over half the chord: 1 for a straight edge with its node in the middle, 0
   !> where it folds back on itself or a middle node at the quarter makes an end singular. A point has -1. A curved edge
   !> may lean as much as it likes against its chord, as soil beside a plate that has sunk into it does. [-]
   pure real(wp) function least_stretch(edge)
      type(edge_t), intent(in) :: edge
      real(wp) :: slope, bend, s

      slope = norm2(edge%slope)
      least_stretch = -1.0_wp
      if (.not. slope > 0.0_wp) return
      ! |t|**2 = |slope|**2 + 4 s slope.bend + 4 s**2 |bend|**2 is least at this s.
      bend = norm2(edge%bend)
      s = 0.0_wp
      if (bend > 0.0_wp) s = -0.5_wp*dot_product(edge%slope, edge%bend/bend)/bend
      least_stretch = norm2(tangent(edge, min(max(s, -1.0_wp), 1.0_wp)))/slope
   end function least_stretch

   !> Finds the foot of a point on an edge, (point - x(s)).t(s) = 0. It is one where the point is nearer than the edge's
   !> centre of curvature, then the left side falls with s. docs/theory/contact.md section 2.1.
   pure subroutine project_point(edge, point, s, where_it_is)
      type(edge_t), intent(in) :: edge
      real(wp), intent(in) :: point(2)   !< [m]
      real(wp), intent(out) :: s   !< In [-1, 1].
      integer, intent(out) :: where_it_is   !< BEFORE, INSIDE or BEYOND.
      real(wp) :: from(2)

      from = point - edge%middle
      call falling_root([dot_product(from, edge%slope), &
                         2.0_wp*dot_product(from, edge%bend) - dot_product(edge%slope, edge%slope), &
                         -3.0_wp*dot_product(edge%slope, edge%bend), &
                         -2.0_wp*dot_product(edge%bend, edge%bend)], s, where_it_is)
   end subroutine project_point

   !> Finds where the line through `point` perpendicular to `t` meets an edge that runs against t: (x(s) - point).t = 0.
   !> docs/theory/contact.md section 2.1.
   pure subroutine follow_normal(edge, point, t, s, where_it_is)
      type(edge_t), intent(in) :: edge
      real(wp), intent(in) :: point(2), t(2)   !< [m]
      real(wp), intent(out) :: s   !< In [-1, 1].
      integer, intent(out) :: where_it_is   !< BEFORE, INSIDE or BEYOND.

      call falling_root([dot_product(edge%middle - point, t), dot_product(edge%slope, t), &
                         dot_product(edge%bend, t), 0.0_wp], s, where_it_is)
   end subroutine follow_normal

   !> Finds the root in [-1, 1] of a cubic that falls through it: Newton's method, and bisection where a step leaves the
   !> bracket or does not halve it, so that it always ends.
   pure subroutine falling_root(k, s, where_it_is)
      real(wp), intent(in) :: k(0:3)   !< k0 + k1 s + k2 s**2 + k3 s**3
      real(wp), intent(out) :: s
      integer, intent(out) :: where_it_is
      real(wp) :: lower, upper, value, slope, step, last
      integer :: i
      logical :: found

      ! At either end, the value there by the slope there is how far the root lies inside, to first order.
      s = -1.0_wp
      call look_at_end((k(0) + k(2)) - (k(1) + k(3)), k(1) - 2.0_wp*k(2) + 3.0_wp*k(3), BEFORE, where_it_is, found)
      if (found) return
      s = 1.0_wp
      call look_at_end(-((k(0) + k(2)) + (k(1) + k(3))), k(1) + 2.0_wp*k(2) + 3.0_wp*k(3), BEYOND, where_it_is, found)
      if (found) return
      where_it_is = INSIDE
      lower = -1.0_wp
      upper = 1.0_wp
      s = 0.0_wp
      last = 2.0_wp
      do i = 1, MOST_STEPS
         value = k(0) + s*(k(1) + s*(k(2) + s*k(3)))
         if (value > 0.0_wp) then
            lower = s
         else if (value < 0.0_wp) then
            upper = s
         else
            return
         end if
         slope = k(1) + s*(2.0_wp*k(2) + s*3.0_wp*k(3))
         if (abs(value) <= ROUNDING*abs(slope)) then
            s = min(max(s - value/slope, lower), upper)
            return
         end if
         step = 0.5_wp*(lower + upper) - s
         ! The comparison without a division: no overflow where the slope is almost zero.
         if (slope < 0.0_wp) then
            if (abs(value) <= 0.5_wp*last*abs(slope)) then
               if (s - value/slope >= lower .and. s - value/slope <= upper) step = -value/slope
            end if
         end if
         s = s + step
         last = abs(step)
      end do
   end subroutine falling_root

   !> Whether the root is this end (INSIDE) or outside it.
   pure subroutine look_at_end(inwards, slope, outside, where_it_is, found)
      real(wp), intent(in) :: inwards, slope   !< > 0 if the root lies further in; slope of the cubic.
      integer, intent(in) :: outside
      integer, intent(out) :: where_it_is
      logical, intent(out) :: found

      where_it_is = INSIDE
      if (inwards < -SAME_PLACE*abs(slope)) where_it_is = outside
      found = inwards <= SAME_PLACE*abs(slope)
   end subroutine look_at_end
end module contact_projection
