! SPDX-License-Identifier: MIT
!> Derivatives of what drives an increment - strain, volume, suction - along the directions of the consistent tangent,
!> and how its parts share them: the part inside the elastic domain and the rest, the part without suction and the rest,
!> the drying part and the wetting part.
module mud_driving
   use mud_kinds, only: wp
   use mud_elastic_domain, only: changes_of_exit, changes_of_turning, turning_at
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_tensor, only: DIRECTIONS => LANES, tensors_t, ZERO_TENSORS, UNIT_STRAINS, ANY_TENSORS
   implicit none (type, external)
   private
   public :: driving_t, whole_increment, parts_at_exit, parts_without_suction, parts_at_turn, end_in_domain, &
             DIRECTIONS, AT_REST

   !> Derivatives of what drives the increment, or one of its parts, along six engineering strains and the suction at
   !> the end of the increment, side by side. The eighth direction is idle: along it nothing changes.
   type :: driving_t
      type(tensors_t) :: d_strain              !< of its strain
      real(wp) :: d_v(DIRECTIONS)              !< of its volume
      real(wp) :: d_pc(DIRECTIONS)             !< of its suction step
      real(wp) :: e0(DIRECTIONS)               !< of ln(1 + e) at its start
      real(wp) :: p_c0(DIRECTIONS)             !< of its first suction
      type(tensors_t) :: from_centre           !< of the strain from the centre of the elastic domain at its start
      logical :: scans                         !< It is on a scanning curve that depends on the increment ...
      real(wp) :: offset(DIRECTIONS)           !< ... by q ln of its offset; not set otherwise.
   end type driving_t

   !> Nothing drives.
   type(tensors_t), parameter :: NO_CHANGES = tensors_t(0.0_wp, ZERO_TENSORS)
   type(driving_t), parameter :: AT_REST = driving_t(NO_CHANGES, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, NO_CHANGES, &
                                                  .false., 0.0_wp)
contains
   !> The increment along the seven directions: unit engineering strains 1 to 6, unit suction step. Strains [-], suction
   !> in the unit of p_atm.
   pure subroutine whole_increment(driving)
      type(driving_t), intent(inout) :: driving
      integer :: j

      driving%d_strain%of = 0.0_wp
      do j = 1, 6
         driving%d_strain%of(j, j) = merge(1.0_wp, 0.5_wp, j <= 3)
      end do
      driving%d_strain%kind = UNIT_STRAINS
      driving%d_v(1:3) = 1.0_wp
      driving%d_v(4:) = 0.0_wp
      driving%d_pc = 0.0_wp
      driving%d_pc(7) = 1.0_wp
      driving%e0 = 0.0_wp
      driving%p_c0 = 0.0_wp
      driving%from_centre = NO_CHANGES
      driving%scans = .false.
   end subroutine whole_increment

   !> Both parts of an increment whose strain from the centre of the elastic domain reaches the sphere at a share of it,
   !> which depends on the strain itself. A share of 0 or 1 does not. docs/theory/memory-rules.md section 4.2.
   pure subroutine parts_at_exit(whole, share, driving, inside, rest)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share
      type(driving_t), intent(in) :: driving   !< of the whole
      type(driving_t), intent(out) :: inside, rest
      real(wp) :: change(DIRECTIONS)

      change = 0.0_wp
      if (share > 0.0_wp .and. share < 1.0_wp) then
         change = changes_of_exit(whole%from_centre, whole%d_strain, share, driving%from_centre, driving%d_strain)
      end if
      call split(whole, share, change, driving, inside, rest)
      rest%from_centre%of = driving%from_centre%of + inside%d_strain%of
      rest%from_centre%kind = ANY_TENSORS
   end subroutine parts_at_exit

   !> Both parts of an increment whose suction passes zero at a share of it, which depends on the suction step.
   !> whole%d_pc is not 0, which is not checked. docs/theory/integration.md section 1.
   pure subroutine parts_without_suction(whole, share, driving, first, rest)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share
      type(driving_t), intent(in) :: driving
      type(driving_t), intent(out) :: first, rest

      call split(whole, share, -(driving%p_c0 + share*driving%d_pc)/whole%d_pc, driving, first, rest)
   end subroutine parts_without_suction

   !> Both parts of an increment whose modified suction p_c e^Omega has its maximum at a share of it, where
   !> h = dp_c - p_c Omega d_v (1 + e)/e vanishes. share and Omega [-]; derivative of docs/theory/material.md section
   !> 2.1.1.
   pure subroutine parts_at_turn(whole, share, omega, driving, first, rest)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share, omega
      type(driving_t), intent(in) :: driving
      type(driving_t), intent(out) :: first, rest
      real(wp) :: e, p_c, per_volume, slope, change(DIRECTIONS)

      e = void_ratio_at(whole, share)
      p_c = suction_at(whole, share)
      per_volume = (1.0_wp + e)/e
      ! dh/dt where h = 0
      slope = -omega*whole%d_v**2*p_c*per_volume*(omega*per_volume + 1.0_wp/e)
      change = driving%d_pc - omega*per_volume*(whole%d_v*(driving%p_c0 + share*driving%d_pc) + p_c*driving%d_v) &
               + omega*p_c*whole%d_v*(1.0_wp + e)/e**2*(driving%e0 - share*driving%d_v)
      call split(whole, share, -change/slope, driving, first, rest)
   end subroutine parts_at_turn

   !> Derivatives of share and 1 - share times the increment, the share changing by `change`.
   pure subroutine split(whole, share, change, driving, first, rest)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share, change(DIRECTIONS)
      type(driving_t), intent(in) :: driving
      type(driving_t), intent(out) :: first, rest
      integer :: i, j

      do j = 1, DIRECTIONS
         do i = 1, 6
            first%d_strain%of(j, i) = share*driving%d_strain%of(j, i) + whole%d_strain(i)*change(j)
            rest%d_strain%of(j, i) = (1.0_wp - share)*driving%d_strain%of(j, i) - whole%d_strain(i)*change(j)
         end do
      end do
      first%d_strain%kind = ANY_TENSORS
      rest%d_strain%kind = ANY_TENSORS
      first%d_v = share*driving%d_v + whole%d_v*change
      first%d_pc = share*driving%d_pc + whole%d_pc*change
      first%e0 = driving%e0
      first%p_c0 = driving%p_c0
      first%from_centre = driving%from_centre
      rest%d_v = (1.0_wp - share)*driving%d_v - whole%d_v*change
      rest%d_pc = (1.0_wp - share)*driving%d_pc - whole%d_pc*change
      rest%e0 = driving%e0 - first%d_v
      rest%p_c0 = driving%p_c0 + first%d_pc
      rest%from_centre = driving%from_centre
      first%scans = driving%scans
      rest%scans = driving%scans
      if (driving%scans) then
         first%offset = driving%offset
         rest%offset = driving%offset
      end if
   end subroutine split

   !> Derivatives of the strain from the centre of the elastic domain at the end of a part that began on the sphere. [-]
   !> per unit of the directions. docs/theory/memory-rules.md section 4.2.
   pure function end_in_domain(inc, driving) result(from_centre)
      type(increment_t), intent(in) :: inc
      type(driving_t), intent(in) :: driving
      type(tensors_t) :: from_centre

      from_centre%kind = ANY_TENSORS
      from_centre%of = inc%rho*changes_of_turning(turning_at(inc%rho, inc%from_centre, inc%d_strain, 1.0_wp), &
                                               driving%from_centre, driving%d_strain)
   end function end_in_domain
end module mud_driving
