! SPDX-License-Identifier: MIT
!> Derivatives of what drives an increment - strain, volume, suction - along the seven directions of the consistent
!> tangent, and how its parts share them: the part inside the elastic domain and the rest, the part without suction and
!> the rest.
module mud_driving
   use mud_kinds, only: wp
   use mud_elastic_domain, only: change_of_exit, change_of_direction
   use mud_increment, only: increment_t
   implicit none (type, external)
   private
   public :: driving_t, whole_increment, parts_at_exit, parts_without_suction, end_in_domain, DIRECTIONS, AT_REST

   integer, parameter :: DIRECTIONS = 7   !< Six engineering strains and the suction at the end of the increment.

   !> Derivatives of what drives the increment, or one of its parts, along the seven directions.
   type :: driving_t
      real(wp) :: d_strain(6, DIRECTIONS)      !< of its strain
      real(wp) :: d_v(DIRECTIONS)              !< of its volume
      real(wp) :: d_pc(DIRECTIONS)             !< of its suction step
      real(wp) :: e0(DIRECTIONS)               !< of ln(1 + e) at its start
      real(wp) :: p_c0(DIRECTIONS)             !< of its first suction
      real(wp) :: from_centre(6, DIRECTIONS)   !< of the strain from the centre of the elastic domain at its start
   end type driving_t

   !> Nothing drives.
   type(driving_t), parameter :: AT_REST = driving_t(0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp)
contains
   !> The increment along the seven directions: unit engineering strains 1 to 6, unit suction step.
   pure function whole_increment() result(driving)
      type(driving_t) :: driving
      integer :: j

      driving = AT_REST
      do j = 1, 6
         driving%d_strain(j, j) = merge(1.0_wp, 0.5_wp, j <= 3)
      end do
      driving%d_v(1:3) = 1.0_wp
      driving%d_pc(7) = 1.0_wp
   end function whole_increment

   !> Both parts of an increment whose strain from the centre of the elastic domain reaches the sphere at a share of it,
   !> which depends on the strain itself. A share of 0 or 1 does not.
   pure subroutine parts_at_exit(whole, share, driving, inside, rest)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share
      type(driving_t), intent(in) :: driving   !< of the whole
      type(driving_t), intent(out) :: inside, rest
      real(wp) :: change(DIRECTIONS)
      integer :: j

      change = 0.0_wp
      if (share > 0.0_wp .and. share < 1.0_wp) then
         do j = 1, DIRECTIONS
            change(j) = change_of_exit(whole%from_centre, whole%d_strain, share, driving%from_centre(:, j), &
                                       driving%d_strain(:, j))
         end do
      end if
      call split(whole, share, change, driving, inside, rest)
      do j = 1, DIRECTIONS
         rest%from_centre(:, j) = driving%from_centre(:, j) + inside%d_strain(:, j)
      end do
   end subroutine parts_at_exit

   !> Both parts of an increment whose suction passes zero at a share of it, which depends on the suction step.
   pure subroutine parts_without_suction(whole, share, driving, first, rest)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share
      type(driving_t), intent(in) :: driving
      type(driving_t), intent(out) :: first, rest

      call split(whole, share, -(driving%p_c0 + share*driving%d_pc)/whole%d_pc, driving, first, rest)
   end subroutine parts_without_suction

   !> Derivatives of share and 1 - share times the increment, the share changing by `change`.
   pure subroutine split(whole, share, change, driving, first, rest)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share, change(DIRECTIONS)
      type(driving_t), intent(in) :: driving
      type(driving_t), intent(out) :: first, rest
      integer :: j

      first = driving
      rest = driving
      do j = 1, DIRECTIONS
         first%d_strain(:, j) = share*driving%d_strain(:, j) + change(j)*whole%d_strain
         first%d_v(j) = share*driving%d_v(j) + change(j)*whole%d_v
         first%d_pc(j) = share*driving%d_pc(j) + change(j)*whole%d_pc
         rest%d_strain(:, j) = (1.0_wp - share)*driving%d_strain(:, j) - change(j)*whole%d_strain
         rest%d_v(j) = (1.0_wp - share)*driving%d_v(j) - change(j)*whole%d_v
         rest%d_pc(j) = (1.0_wp - share)*driving%d_pc(j) - change(j)*whole%d_pc
         rest%e0(j) = driving%e0(j) - first%d_v(j)
         rest%p_c0(j) = driving%p_c0(j) + first%d_pc(j)
      end do
   end subroutine split

   !> Derivatives of the strain from the centre of the elastic domain at the end of a part that began on the sphere.
   pure function end_in_domain(inc, driving) result(from_centre)
      type(increment_t), intent(in) :: inc
      type(driving_t), intent(in) :: driving
      real(wp) :: from_centre(6, DIRECTIONS)
      integer :: j

      do j = 1, DIRECTIONS
         from_centre(:, j) = inc%rho*change_of_direction(inc%rho, inc%from_centre, inc%d_strain, 1.0_wp, &
                                                         driving%from_centre(:, j), driving%d_strain(:, j))
      end do
   end function end_in_domain
end module mud_driving
