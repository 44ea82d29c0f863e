! SPDX-License-Identifier: MIT
!> Whether a tangent is elliptic in the plane: the determinant of its acoustic tensor for every normal of a band. Where
!> it is not positive, a linear solid with this tangent has solutions that jump across a band, and nothing in the
!> equations says how wide the band is. docs/theory/host.md section 16.
module acoustic_tensor
   use kinds, only: wp, PI
   implicit none (type, external)
   private
   public :: determinant_t, determinant_of, determinant_at, least_determinant, loses_ellipticity

   integer, parameter :: PLANE = 4         !< Components rr, zz, tt, rz.
   integer, parameter :: PAIRS = 16        !< Angles that are looked at, each with the one at right angles to it.
   real(wp), parameter :: SPACING = PI/(2*PAIRS)   !< Angle between them.
   integer :: i   ! Of the lists below.
   real(wp), parameter :: COS_2(PAIRS) = [(cos(2*SPACING*i), i=0, PAIRS - 1)], &
                          SIN_2(PAIRS) = [(sin(2*SPACING*i), i=0, PAIRS - 1)], &
                          COS_4(PAIRS) = [(cos(4*SPACING*i), i=0, PAIRS - 1)], &
                          SIN_4(PAIRS) = [(sin(4*SPACING*i), i=0, PAIRS - 1)]
   !> Share of the magnitudes of its terms: a determinant that small is rounding, of the solid whose determinant is zero
   !> (a fluid, a perfectly plastic solid without volume change in plane strain).
   real(wp), parameter :: ROUNDING = 1.0e-10_wp

   !> The determinant as a sum of waves over the angle of the normal, mean + c2 cos 2t + s2 sin 2t + c4 cos 4t + s4 sin
   !> 4t [kPa2]: the quartic in cos t and sin t, which is easier to differentiate so.
   type :: determinant_t
      real(wp) :: mean, c2, s2, c4, s4
   end type determinant_t
contains
   !> Finds the determinant of the acoustic tensor of a tangent; the hoop strain does not jump across a band.
   !> docs/theory/host.md section 16.
   pure type(determinant_t) function determinant_of(tangent) result(q)
      real(wp), intent(in) :: tangent(PLANE, PLANE)   !< d sigma'/d strain, engineering shear [kPa].
      real(wp) :: rr(3), rz(3), zr(3), zz(3)   !< Acoustic tensor: factors of cos2, cos sin, sin2.
      real(wp) :: a(0:4)                       !< Determinant: factors of cos4, cos3 sin, ..., sin4.

      associate (d => tangent)
         rr = [d(1, 1), d(1, 4) + d(4, 1), d(4, 4)]
         rz = [d(1, 4), d(1, 2) + d(4, 4), d(4, 2)]
         zr = [d(4, 1), d(2, 1) + d(4, 4), d(2, 4)]
         zz = [d(4, 4), d(2, 4) + d(4, 2), d(2, 2)]
      end associate
      a(0) = rr(1)*zz(1) - rz(1)*zr(1)
      a(1) = rr(1)*zz(2) + rr(2)*zz(1) - rz(1)*zr(2) - rz(2)*zr(1)
      a(2) = rr(1)*zz(3) + rr(2)*zz(2) + rr(3)*zz(1) - rz(1)*zr(3) - rz(2)*zr(2) - rz(3)*zr(1)
      a(3) = rr(2)*zz(3) + rr(3)*zz(2) - rz(2)*zr(3) - rz(3)*zr(2)
      a(4) = rr(3)*zz(3) - rz(3)*zr(3)
      q%mean = (3*a(0) + a(2) + 3*a(4))/8
      q%c2 = (a(0) - a(4))/2
      q%s2 = (a(1) + a(3))/4
      q%c4 = (a(0) - a(2) + a(4))/8
      q%s4 = (a(1) - a(3))/8
   end function determinant_of

   !> Evaluates the determinant for a normal [kPa2].
   elemental real(wp) function determinant_at(q, angle)
      type(determinant_t), intent(in) :: q
      real(wp), intent(in) :: angle   !< Angle of the normal from r towards z.

      determinant_at = q%mean + q%c2*cos(2*angle) + q%s2*sin(2*angle) + q%c4*cos(4*angle) + q%s4*sin(4*angle)
   end function determinant_at

   !> Whether the determinant is negative for some normal, by more than rounding. docs/theory/host.md section 16. Of
   !> almost every tangent the angles decide; the least value between them is looked for where they do not.
   pure logical function loses_ellipticity(q)
      type(determinant_t), intent(in) :: q
      real(wp) :: least, bound, angle

      bound = -ROUNDING*(abs(q%mean) + abs(q%c2) + abs(q%s2) + abs(q%c4) + abs(q%s4))
      least = minval(q%mean + q%c4*COS_4 + q%s4*SIN_4 - abs(q%c2*COS_2 + q%s2*SIN_2))
      loses_ellipticity = least < bound
      ! From a least value the determinant rises by at most half its largest curvature times the squared distance.
      if (loses_ellipticity) return
      if (least > 0.125_wp*SPACING**2*(4*hypot(q%c2, q%s2) + 16*hypot(q%c4, q%s4))) return
      call least_determinant(q, least, angle)
      loses_ellipticity = least < bound
   end function loses_ellipticity

   !> Finds the least determinant and its normal. docs/theory/host.md section 16. Each of the 32 angles with a smaller
   !> value than its neighbours is refined by Newton's method: there are two at most.
   pure subroutine least_determinant(q, least, angle)
      type(determinant_t), intent(in) :: q
      real(wp), intent(out) :: least   !< [kPa2]
      real(wp), intent(out) :: angle   !< Angle of the normal from r towards z, 0 to pi.
      real(wp) :: values(0:2*PAIRS - 1), t, value
      integer :: k

      values = determinant_at(q, [(SPACING*k, k=0, 2*PAIRS - 1)])
      angle = SPACING*(minloc(values, dim=1) - 1)
      least = minval(values)
      do k = 0, 2*PAIRS - 1
         if (values(k) > values(modulo(k - 1, 2*PAIRS)) .or. values(k) > values(modulo(k + 1, 2*PAIRS))) cycle
         t = lowest_near(q, SPACING*k)
         value = determinant_at(q, t)
         if (value >= least) cycle
         least = value
         angle = modulo(t, PI)
      end do
   end subroutine least_determinant

   !> Finds where the slope vanishes by Newton's method, within one spacing of the angle that it starts from.
   pure real(wp) function lowest_near(q, start) result(t)
      type(determinant_t), intent(in) :: q
      real(wp), intent(in) :: start
      integer, parameter :: MOST = 50   !< The search converges in five; by halves alone it takes 50.
      real(wp) :: slope, curvature, from, to, before
      integer :: n

      t = start
      from = start - SPACING
      to = start + SPACING
      do n = 1, MOST
         slope = 2*(q%s2*cos(2*t) - q%c2*sin(2*t)) + 4*(q%s4*cos(4*t) - q%c4*sin(4*t))
         if (.not. abs(slope) > 0.0_wp) exit
         curvature = -4*(q%c2*cos(2*t) + q%s2*sin(2*t)) - 16*(q%c4*cos(4*t) + q%s4*sin(4*t))
         if (slope > 0.0_wp) to = t
         if (slope < 0.0_wp) from = t
         before = t
         if (curvature*SPACING > abs(slope)) t = t - slope/curvature
         if (.not. (t > from .and. t < to)) t = 0.5_wp*(from + to)
         if (.not. abs(t - before) > epsilon(1.0_wp)) exit
      end do
   end function lowest_near
end module acoustic_tensor
