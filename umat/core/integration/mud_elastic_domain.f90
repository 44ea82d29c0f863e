! SPDX-License-Identifier: MIT
!> Elastic domain: a ball of radius rho in strain inside which sand is elastic (a play operator).
!>
!> d is the strain from the ball's centre, |d| <= rho. Inside, and while strain points inwards, only d moves. On the
!> sphere the centre is pulled along: d = rho nu, and of the strain rate a only (nu:a) nu loads, the rest is elastic.
!> For a constant a that is the tractrix: tan(phi/2) falls as exp(-|a| t/rho), phi the angle between nu and a. So an
!> increment is exact in two phases, whatever its size, and a large one is not cut into pieces.
module mud_elastic_domain
   use mud_kinds, only: wp
   use mud_tensor, only: ddot, norm
   implicit none (type, external)
   private
   public :: exit_share, loading_direction, find_tractrix, decay_at
contains
   !> Share of a strain increment after which the sphere is reached outwards; 1 if it is not.
   !> docs/theory/memory-rules.md section 4.2.
   pure real(wp) function exit_share(rho, d, increment) result(share)
      real(wp), intent(in) :: rho            !< radius [-], > 0
      real(wp), intent(in) :: d(6)           !< strain from the centre, inside [-]
      real(wp), intent(in) :: increment(6)   !< [-]
      real(wp) :: a, b, c, root

      share = 1.0_wp
      a = ddot(increment, increment)
      if (a <= 0.0_wp) return
      b = ddot(d, increment)
      c = min(ddot(d, d) - rho**2, 0.0_wp)
      root = sqrt(b**2 - a*c)
      ! both forms are the larger root of the quadratic; each is free of cancellation on its side
      if (b > 0.0_wp) then
         share = min(-c/(b + root), 1.0_wp)
      else
         share = min((root - b)/a, 1.0_wp)
      end if
   end function exit_share

   !> nu at a share `time` of a strain increment that begins at d on the sphere and points outwards. All [-]; rho > 0
   !> and an increment that is not 0 are not checked. Tractrix of docs/theory/memory-rules.md section 4.2.
   pure function loading_direction(rho, d, increment, time) result(nu)
      real(wp), intent(in) :: rho, d(6), increment(6), time
      real(wp) :: nu(6), length, cosine, decay, share, divisor

      nu = d/rho
      if (time <= 0.0_wp) return
      length = norm(increment)
      cosine = min(ddot(d, increment)/(rho*length), 1.0_wp)
      call find_tractrix(rho, length, cosine, time, decay, share, divisor)
      nu = (2.0_wp*decay*nu + (share/length)*increment)/divisor
   end function loading_direction

   !> The tractrix: nu is 2 q times its direction at the start and `share` times that of the increment, over a divisor,
   !> with the decay q of tan(phi/2) at a share `time` of an increment of a length. cosine is that of the angle at the
   !> start. All [-]. docs/theory/memory-rules.md section 4.2.
   pure subroutine find_tractrix(rho, length, cosine, time, decay, share, divisor)
      real(wp), intent(in) :: rho, length, cosine, time
      real(wp), intent(out) :: decay, share, divisor

      decay = decay_at(rho, length, time)
      divisor = 1.0_wp + cosine + (1.0_wp - cosine)*decay**2
      share = (1.0_wp - decay)*(1.0_wp + decay + cosine*(1.0_wp - decay))
   end subroutine find_tractrix

   !> Share of tan(phi/2) that is left at a share `time` of an increment of a length. All [-].
   !> docs/theory/memory-rules.md section 4.2.
   pure real(wp) function decay_at(rho, length, time) result(decay)
      real(wp), intent(in) :: rho, length, time

      decay = 1.0_wp
      if (time > 0.0_wp) decay = exp(-length*time/rho)
   end function decay_at
end module mud_elastic_domain
