! SPDX-License-Identifier: MIT
!> The arc of directions n = cos(w) t/|t| + sin(w) q in the plane of t and r: what is linear in n, and tr(n^3), along
!> it; docs/theory/material.md section 4.6.
module mud_arc
   use mud_kinds, only: wp
   use mud_tensor, only: ddot, norm, square
   implicit none (type, external)
   private
   public :: arc_t, arc_through, trace_cube, trace_cube_slope

   !> Products of the two ends t/|t| and q of the arc with tensors [-].
   type :: arc_t
      real(wp) :: r_t, r_q      !< r
      real(wp) :: x_t, x_q      !< r - r_in
      real(wp) :: z_t, z_q      !< fabric
      real(wp) :: cubic(0:3)    !< coefficients of tr(n^3) by powers of sin(w)
   end type arc_t
contains
   !> Arc from the unit direction n_t towards r, whose other end is q. Where r is parallel to n_t, but for `rounding`, q
   !> and what belongs to it are zero. All arguments [-].
   pure subroutine arc_through(r, r_moved, z, n_t, rounding, arc, q)
      real(wp), intent(in) :: r(6), r_moved(6), z(6), n_t(6)   !< r_moved: r - r_in, z: fabric
      real(wp), intent(in) :: rounding
      type(arc_t), intent(out) :: arc
      real(wp), intent(out) :: q(6)
      real(wp) :: t2(6), q2(6)

      arc%r_t = ddot(r, n_t)
      arc%x_t = ddot(r_moved, n_t)
      q = r - arc%r_t*n_t
      arc%r_q = norm(q)
      arc%z_t = ddot(z, n_t)
      t2 = square(n_t)
      if (arc%r_q <= rounding) then
         arc%r_q = 0.0_wp
         arc%x_q = 0.0_wp
         arc%z_q = 0.0_wp
         q = 0.0_wp
         arc%cubic = [ddot(t2, n_t), 0.0_wp, 0.0_wp, 0.0_wp]
      else
         q = q/arc%r_q
         q2 = square(q)
         arc%x_q = ddot(r_moved, q)
         arc%z_q = ddot(z, q)
         arc%cubic = [ddot(t2, n_t), ddot(t2, q), ddot(q2, n_t), ddot(q2, q)]
      end if
   end subroutine arc_through

   !> tr(n^3) [-] where w has the cosine c and the sine s.
   pure real(wp) function trace_cube(arc, c, s)
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: c, s

      trace_cube = c*(c*(c*arc%cubic(0) + 3.0_wp*s*arc%cubic(1)) + 3.0_wp*s*s*arc%cubic(2)) + s*s*s*arc%cubic(3)
   end function trace_cube

   !> d tr(n^3)/dw [-].
   pure real(wp) function trace_cube_slope(arc, c, s) result(slope)
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: c, s

      slope = 3.0_wp*(c*c*(c*arc%cubic(1) - s*arc%cubic(0)) + 2.0_wp*c*s*(c*arc%cubic(2) - s*arc%cubic(1)) &
                      + s*s*(c*arc%cubic(3) - s*arc%cubic(2)))
   end function trace_cube_slope
end module mud_arc
