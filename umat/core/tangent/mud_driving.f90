! SPDX-License-Identifier: MIT
!> Derivatives of what drives an increment - strain, volume, suction - along the directions of the consistent tangent,
!> and of the pseudo-times at which its phases end.
module mud_driving
   use mud_kinds, only: wp
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_retention, only: slopes_of_suction
   use mud_tensor, only: DIRECTIONS, tensors_t, ZERO_TENSORS, ANY_TENSORS, strain_directions, contracted, ddot
   implicit none (type, external)
   private
   public :: driving_t, whole_increment, change_of_place, change_of_turn, change_of_passing, AT_REST

   !> Derivatives of what drives the increment along six engineering strains and the suction at the end of the
   !> increment, side by side. The eighth direction is idle: along it nothing changes.
   type :: driving_t
      type(tensors_t) :: d_strain              !< derivatives of the strain of the increment
      real(wp) :: d_v(DIRECTIONS)              !< derivatives of the volume of the increment
      real(wp) :: d_pc(DIRECTIONS)             !< derivatives of the suction step
      real(wp) :: exit(DIRECTIONS)   !< derivatives of the pseudo-time at which the strain leaves the elastic domain
      type(tensors_t) :: from_centre           !< derivatives of the strain from the centre of the elastic domain there
      logical :: scans                         !< The point is on a branch that depends on the increment ...
      real(wp) :: turn(DIRECTIONS)             !< ... by ln x of the turn where it begins; not set otherwise.
   end type driving_t

   !> Nothing drives.
   type(tensors_t), parameter :: NO_CHANGES = tensors_t(0.0_wp, ZERO_TENSORS)
   type(driving_t), parameter :: AT_REST = driving_t(NO_CHANGES, 0.0_wp, 0.0_wp, 0.0_wp, NO_CHANGES, .false., 0.0_wp)
contains
   !> The increment along the seven directions: unit engineering strains 1 to 6, unit suction step. Strains [-], suction
   !> in the unit of p_atm. docs/theory/memory-rules.md section 4.2.
   pure subroutine whole_increment(inc, driving)
      type(increment_t), intent(in) :: inc
      type(driving_t), intent(inout) :: driving
      integer :: i

      driving%d_strain = strain_directions()
      driving%d_v(1:3) = 1.0_wp
      driving%d_v(4:) = 0.0_wp
      driving%d_pc = 0.0_wp
      driving%d_pc(7) = 1.0_wp
      driving%exit = 0.0_wp
      driving%from_centre = NO_CHANGES
      driving%scans = .false.
      if (inc%exit <= 0.0_wp .or. inc%exit >= 1.0_wp) return
      ! where the strain leaves the domain |from_centre| stays rho_e
      driving%exit = -(inc%exit/ddot(inc%from_centre, inc%d_strain))*contracted(driving%d_strain, inc%from_centre)
      do i = 1, 6
         driving%from_centre%of(:, i) = inc%exit*driving%d_strain%of(:, i) + inc%d_strain(i)*driving%exit
      end do
      driving%from_centre%kind = ANY_TENSORS
   end subroutine whole_increment

   !> Derivatives of void ratio [-] and suction at a pseudo-time that itself changes by dt [-].
   pure subroutine change_of_place(inc, time, e, dt, driving, de, dp_c)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, e, dt(DIRECTIONS)   !< e: void ratio there
      type(driving_t), intent(in) :: driving
      real(wp), dimension(DIRECTIONS), intent(out) :: de, dp_c

      de = -(1.0_wp + e)*(time*driving%d_v + inc%d_v*dt)
      dp_c = time*driving%d_pc + inc%d_pc*dt
   end subroutine change_of_place

   !> Changes of the pseudo-time at which the modified suction p_c e^Omega has its maximum, where
   !> h = dp_c - p_c Omega d_v (1 + e)/e vanishes. time and Omega [-]; derivative of docs/theory/material.md section
   !> 2.1.1.
   pure function change_of_turn(inc, time, omega, driving) result(change)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, omega
      type(driving_t), intent(in) :: driving
      real(wp) :: change(DIRECTIONS), e, p_c, per_volume, slope

      e = void_ratio_at(inc, time)
      p_c = suction_at(inc, time)
      per_volume = (1.0_wp + e)/e
      ! dh/dt where h = 0
      slope = -omega*inc%d_v**2*p_c*per_volume*(omega*per_volume + 1.0_wp/e)
      change = driving%d_pc - omega*per_volume*(inc%d_v*time*driving%d_pc + p_c*driving%d_v) &
               - omega*p_c*inc%d_v*(1.0_wp + e)/e**2*time*driving%d_v
      change = -change/slope
   end function change_of_turn

   !> Changes of the pseudo-time at which ln x passes a turning point [-]. x moves there, which is not checked.
   !> docs/theory/material.md section 2.1.1.
   pure function change_of_passing(inc, time, omega, driving) result(change)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, omega
      type(driving_t), intent(in) :: driving
      real(wp) :: change(DIRECTIONS), slopes(2)

      slopes = slopes_of_suction(inc%way_t, time, omega)
      change = -time*(slopes(1)*driving%d_pc + slopes(2)*driving%d_v)/(slopes(1)*inc%d_pc + slopes(2)*inc%d_v)
   end function change_of_passing
end module mud_driving
