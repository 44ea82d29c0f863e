! SPDX-License-Identifier: MIT
!> Elastic domain: a ball of radius rho in strain inside which sand is elastic (a play operator).
!>
!> d is the strain from the ball's centre, |d| <= rho. Inside, and while strain points inwards, only d moves. On the
!> sphere the centre is pulled along: d = rho nu, and of the strain rate a only (nu:a) nu loads, the rest is elastic.
!> For a constant a that is the tractrix: tan(phi/2) falls as exp(-|a| t/rho), phi the angle between nu and a. So an
!> increment is exact in two phases, whatever its size, and a large one is not cut into pieces.
module mud_elastic_domain
   use mud_kinds, only: wp
   use mud_tensor, only: LANES, ddot, norm, tensors_t, contracted
   implicit none (type, external)
   private
   public :: turning_t, exit_share, changes_of_exit, loading_direction, turning_at, combination_t, &
             combination_of_turning, decay_at

   !> The direction nu at one pseudo-time.
   type :: turning_t
      real(wp) :: nu(6)
      real(wp) :: d(6)           !< strain from the centre at the start [-]
      real(wp) :: u(6), length   !< direction and size of the increment [-]
      real(wp) :: rho, time, cosine, decay, share, divisor   !< quantities of find_tractrix [-]
   end type turning_t

   !> Changes of nu as a sum: of_d times those of d, of_increment times those of the increment, and parts along d and u.
   type :: combination_t
      real(wp) :: of_d, of_increment
      real(wp), dimension(LANES) :: along_d, along_u
      ! contractions on the way there
      real(wp), dimension(LANES) :: length           !< changes of the increment along u [-]
      real(wp), dimension(LANES) :: d_on_u, increment_on_d
   end type combination_t
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

   !> Changes of that share with d and the increment. All [-]; the share is that of exit_share, below 1. Derivative of
   !> docs/theory/memory-rules.md section 4.2.
   pure function changes_of_exit(d, increment, share, d_changes, increment_changes) result(changes)
      real(wp), intent(in) :: d(6), increment(6), share
      type(tensors_t), intent(in) :: d_changes, increment_changes
      real(wp) :: changes(LANES), at_exit(6)

      at_exit = d + share*increment
      changes = -(contracted(d_changes, at_exit) + share*contracted(increment_changes, at_exit)) &
                /ddot(at_exit, increment)
   end function changes_of_exit

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

   !> nu at a pseudo-time, and what its changes share. Arguments as in loading_direction, all [-].
   !> docs/theory/memory-rules.md section 4.2.
   pure function turning_at(rho, d, increment, time) result(turning)
      real(wp), intent(in) :: rho, d(6), increment(6), time
      type(turning_t) :: turning

      turning%d = d
      turning%rho = rho
      turning%time = time
      turning%length = norm(increment)
      turning%u = increment/turning%length
      turning%cosine = min(ddot(d, turning%u)/rho, 1.0_wp)
      call find_tractrix(rho, turning%length, turning%cosine, time, turning%decay, turning%share, turning%divisor)
      turning%nu = (2.0_wp*turning%decay*(d/rho) + turning%share*turning%u)/turning%divisor
   end function turning_at

   !> Share of tan(phi/2) that is left at a share `time` of an increment of a length. All [-].
   !> docs/theory/memory-rules.md section 4.2.
   pure real(wp) function decay_at(rho, length, time) result(decay)
      real(wp), intent(in) :: rho, length, time

      decay = 1.0_wp
      if (time > 0.0_wp) decay = exp(-length*time/rho)
   end function decay_at

   !> Finds the parts of which the changes of nu with d, which stays on the sphere, and with the increment are made. All
   !> [-]. Derivative of docs/theory/memory-rules.md section 4.2.
   pure subroutine combination_of_turning(turning, d_changes, increment_changes, by)
      type(turning_t), intent(in) :: turning
      type(tensors_t), intent(in) :: d_changes, increment_changes
      type(combination_t), intent(inout) :: by
      real(wp) :: per_divisor, per_rho, per_length, d_u, decay_slope, divisor_cosine, divisor_decay, share_cosine, &
         share_decay, on_d, dcosine, ddecay, ddivisor, dshare
      integer :: j

      per_divisor = 1.0_wp/turning%divisor
      per_rho = 1.0_wp/turning%rho
      per_length = 1.0_wp/turning%length
      d_u = turning%cosine*turning%rho
      by%length = contracted(increment_changes, turning%u)
      by%d_on_u = contracted(d_changes, turning%u)
      by%increment_on_d = contracted(increment_changes, turning%d)
      associate (cosine => turning%cosine, decay => turning%decay)
         by%of_d = 2.0_wp*decay*per_rho*per_divisor
         by%of_increment = turning%share*per_length*per_divisor
         decay_slope = -decay*turning%time*per_rho
         divisor_cosine = 1.0_wp - decay**2
         divisor_decay = 2.0_wp*(1.0_wp - cosine)*decay
         share_cosine = (1.0_wp - decay)**2
         share_decay = -2.0_wp*(decay + cosine*(1.0_wp - decay))
         on_d = 2.0_wp*per_rho*per_divisor
         do j = 1, LANES
            dcosine = (by%d_on_u(j) + (by%increment_on_d(j) - d_u*by%length(j))*per_length)*per_rho
            ddecay = decay_slope*by%length(j)
            ddivisor = divisor_cosine*dcosine + divisor_decay*ddecay
            dshare = share_decay*ddecay + share_cosine*dcosine
            ! nu is a sum of d and u over a divisor
            by%along_d(j) = on_d*(ddecay - (decay*per_divisor)*ddivisor)
            by%along_u(j) = per_divisor*(dshare - (turning%share*per_divisor)*ddivisor) - by%of_increment*by%length(j)
         end do
      end associate
   end subroutine combination_of_turning
end module mud_elastic_domain
