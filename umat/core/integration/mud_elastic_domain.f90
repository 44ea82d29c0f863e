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
   public :: turning_t, exit_share, change_of_exit, loading_direction, change_of_direction, turning_at, &
             change_of_turning

   !> The direction nu at one pseudo-time.
   type :: turning_t
      real(wp) :: nu(6)
      ! for its changes: nu is dividend over divisor
      real(wp) :: dividend(6)
      real(wp) :: d(6)           !< strain from the centre at the start [-]
      real(wp) :: u(6), length   !< direction and size of the increment [-]
      real(wp) :: rho, time, cosine, decay, share, divisor
   end type turning_t
contains
   !> Share of a strain increment after which the sphere is reached outwards; 1 if it is not.
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

   !> Change of that share with d and the increment.
   pure real(wp) function change_of_exit(d, increment, share, d_change, increment_change) result(change)
      real(wp), intent(in) :: d(6), increment(6), share, d_change(6), increment_change(6)
      real(wp) :: at_exit(6)

      at_exit = d + share*increment
      change = -ddot(at_exit, d_change + share*increment_change)/ddot(at_exit, increment)
   end function change_of_exit

   !> nu at a share `time` of a strain increment that begins at d on the sphere and points outwards.
   pure function loading_direction(rho, d, increment, time) result(nu)
      real(wp), intent(in) :: rho, d(6), increment(6), time
      real(wp) :: nu(6), length, cosine, decay, divisor

      length = norm(increment)
      cosine = min(ddot(d, increment)/(rho*length), 1.0_wp)
      decay = exp(-length*time/rho)
      divisor = 1.0_wp + cosine + (1.0_wp - cosine)*decay**2
      nu = (2.0_wp*decay*(d/rho) &
            + ((1.0_wp - decay)*(1.0_wp + decay + cosine*(1.0_wp - decay))/length)*increment)/divisor
   end function loading_direction

   !> Change of nu with d (which stays on the sphere) and the increment.
   pure function change_of_direction(rho, d, increment, time, d_change, increment_change) result(change)
      real(wp), intent(in) :: rho, d(6), increment(6), time, d_change(6), increment_change(6)
      real(wp) :: change(6)

      change = change_of_turning(turning_at(rho, d, increment, time), d_change, increment_change)
   end function change_of_direction

   !> nu at a pseudo-time, and what its changes share.
   pure function turning_at(rho, d, increment, time) result(turning)
      real(wp), intent(in) :: rho, d(6), increment(6), time
      type(turning_t) :: turning

      turning%nu = loading_direction(rho, d, increment, time)
      turning%d = d
      turning%rho = rho
      turning%time = time
      turning%length = norm(increment)
      turning%u = increment/turning%length
      turning%cosine = min(ddot(d, turning%u)/rho, 1.0_wp)
      turning%decay = exp(-turning%length*time/rho)
      associate (cosine => turning%cosine, decay => turning%decay)
         turning%divisor = 1.0_wp + cosine + (1.0_wp - cosine)*decay**2
         turning%share = (1.0_wp - decay)*(1.0_wp + decay + cosine*(1.0_wp - decay))
         turning%dividend = 2.0_wp*decay*(d/rho) + turning%share*turning%u
      end associate
   end function turning_at

   !> Its change.
   pure function change_of_turning(turning, d_change, increment_change) result(change)
      type(turning_t), intent(in) :: turning
      real(wp), intent(in) :: d_change(6), increment_change(6)
      real(wp) :: change(6), du(6), dlength, dcosine, ddecay, ddivisor, dshare

      associate (d => turning%d, u => turning%u, cosine => turning%cosine, decay => turning%decay)
         dlength = ddot(u, increment_change)
         du = (increment_change - dlength*u)/turning%length
         dcosine = (ddot(d_change, u) + ddot(d, du))/turning%rho
         ddecay = -decay*dlength*turning%time/turning%rho
         ddivisor = dcosine*(1.0_wp - decay**2) + 2.0_wp*(1.0_wp - cosine)*decay*ddecay
         dshare = -2.0_wp*ddecay*(decay + cosine*(1.0_wp - decay)) + dcosine*(1.0_wp - decay)**2
         change = (2.0_wp*(ddecay*d + decay*d_change)/turning%rho + dshare*u + turning%share*du &
                   - (ddivisor/turning%divisor)*turning%dividend)/turning%divisor
      end associate
   end function change_of_turning
end module mud_elastic_domain
