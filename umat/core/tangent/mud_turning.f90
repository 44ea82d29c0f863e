! SPDX-License-Identifier: MIT
!> Changes of the direction nu of the elastic domain; derivatives of docs/theory/memory-rules.md section 4.2.
module mud_turning
   use mud_elastic_domain, only: find_tractrix
   use mud_kinds, only: wp
   use mud_tensor, only: DIRECTIONS, ddot, norm, tensors_t, contracted
   implicit none (type, external)
   private
   public :: turning_t, turning_at, combination_t, combination_of_turning

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
      real(wp), dimension(DIRECTIONS) :: along_d, along_u
      ! contractions on the way there
      real(wp), dimension(DIRECTIONS) :: length           !< changes of the increment along u [-]
      real(wp), dimension(DIRECTIONS) :: d_on_u, increment_on_d
   end type combination_t
contains
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
         do j = 1, DIRECTIONS
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
end module mud_turning
