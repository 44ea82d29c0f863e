! SPDX-License-Identifier: MIT
!> Stiffness of points that have none. A point at the tension cut-off, or one that fails, may have no stiffness against
!> some strain, and a mesh of such points has a singular matrix although every body is supported. There the elastic
!> tangent is used instead; the residual, and so the solution, does not change.
!> docs/theory/host.md section 5.3.
module tangent_fallback
   use kinds, only: wp
   use material_point, only: material_t, response_t
   implicit none (type, external)
   private
   public :: replace_soft_tangents, NO_FALLBACK, OPEN_POINTS, SOFT_POINTS

   integer, parameter :: NO_FALLBACK = 0   !< The tangents of the material are used.
   integer, parameter :: OPEN_POINTS = 1   !< Elastic where the volumetric stiffness is almost zero.
   integer, parameter :: SOFT_POINTS = 2   !< Elastic where any strain has almost no stiffness, or gains energy.
   real(wp), parameter :: NEXT_TO_NOTHING = 1.0e-3_wp   !< Share of the elastic stiffness [-].
   integer, parameter :: PLANE = 4         !< Components rr, zz, tt, rz.
contains
   !> Replaces the tangents of a batch of points that are too soft. docs/theory/host.md section 5.3.
   subroutine replace_soft_tangents(law, level, n, state, suction, response, soft)
      class(material_t), intent(in) :: law
      integer, intent(in) :: level                 !< OPEN_POINTS or SOFT_POINTS
      integer, intent(in) :: n   !< Number of points.
      real(wp), intent(in) :: state(:, :)          !< (n_state or more, n) after the increment
      real(wp), intent(in) :: suction(:)           !< (n) after it [kPa]
      type(response_t), intent(inout) :: response
      logical, intent(out) :: soft(:)              !< (n or more) Points whose tangent was replaced.
      real(wp) :: elastic(6, 6)
      integer :: g

      soft = .false.
      do g = 1, n
         call law%elastic_tangent(response%stress(:, g), state(:, g), suction(g), elastic)
         if (level == OPEN_POINTS) then
            if (volume_stiffness(response%dsig_deps(:, :, g)) > NEXT_TO_NOTHING*volume_stiffness(elastic)) cycle
         else
            if (resists(response%dsig_deps(:, :, g) - NEXT_TO_NOTHING*elastic)) cycle
         end if
         response%dsig_deps(:, :, g) = elastic
         soft(g) = .true.
      end do
   end subroutine replace_soft_tangents

   !> Finds the mean stress per volumetric strain, times nine [kPa].
   pure real(wp) function volume_stiffness(tangent)
      real(wp), intent(in) :: tangent(6, 6)

      volume_stiffness = sum(tangent(1:3, 1:3))
   end function volume_stiffness

   !> Whether every strain in the plane meets a resistance: the symmetric part is positive definite (Cholesky).
   pure logical function resists(tangent)
      real(wp), intent(in) :: tangent(6, 6)
      real(wp) :: l(PLANE, PLANE)
      integer :: i, j

      l = 0.5_wp*(tangent(:PLANE, :PLANE) + transpose(tangent(:PLANE, :PLANE)))
      resists = .false.
      do j = 1, PLANE
         l(j, j) = l(j, j) - sum(l(j, :j - 1)**2)
         if (.not. l(j, j) > 0.0_wp) return
         l(j, j) = sqrt(l(j, j))
         do i = j + 1, PLANE
            l(i, j) = (l(i, j) - sum(l(i, :j - 1)*l(j, :j - 1)))/l(j, j)
         end do
      end do
      resists = .true.
   end function resists
end module tangent_fallback
