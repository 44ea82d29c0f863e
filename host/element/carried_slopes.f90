! SPDX-License-Identifier: MIT
!> Slopes of the material that outlive the pass which found them. The first pass of a step follows them from the state
!> before the step, and a matrix that is wanted after a residual is formed with them: neither asks the material.
!> docs/theory/host.md section 5.4.
module carried_slopes
   use archive, only: archive_t
   use kinds, only: wp
   use material_point, only: response_t, swollen
   implicit none (type, external)
   private
   public :: slopes_t, new_slopes, keep_slopes, follow_slopes, kept_response, exchange_slopes
   public :: BY_MATERIAL, BY_SLOPES, AS_BEFORE

   ! What gives the response of the points in a pass over the elements.
   integer, parameter :: BY_MATERIAL = 0   !< The material.
   integer, parameter :: BY_SLOPES = 1     !< The kept slopes, from the state before the step.
   integer, parameter :: AS_BEFORE = 2     !< The material's response in the last pass, at the same unknowns.
   integer, parameter :: PLANE = 4         !< Components rr, zz, tt, rz.

   type :: slopes_t
      logical :: known = .false.             !< The slopes are those of the state where the next step begins.
      real(wp), allocatable :: strain(:, :, :)   !< (4, 4, points) d sigma'/d strain [kPa]
      real(wp), allocatable :: suction(:, :)     !< (4, points) d sigma'/d p_c [-]
      real(wp), allocatable :: water(:, :)       !< (2, points) d S_w/d volume strain [-], d S_w/d p_c [1/kPa]
   end type slopes_t
contains
   !> Makes room for the slopes of all points of a mesh; none are known yet.
   pure function new_slopes(points) result(slopes)
      integer, intent(in) :: points   !< Number of points.
      type(slopes_t) :: slopes

      allocate (slopes%strain(PLANE, PLANE, points), slopes%suction(PLANE, points), slopes%water(2, points), &
                source=0.0_wp)
   end function new_slopes

   !> Keeps the slopes of the points from `first` on.
   pure subroutine keep_slopes(n, first, answer, slopes)
      integer, intent(in) :: n, first   !< Number of points; the first of them in the mesh.
      type(response_t), intent(in) :: answer   !< With tangent.
      type(slopes_t), intent(inout) :: slopes

      associate (last => first + n - 1)
         slopes%strain(:, :, first:last) = answer%dsig_deps(:PLANE, :PLANE, :n)
         slopes%suction(:, first:last) = answer%dsig_dpc(:PLANE, :n)
         slopes%water(1, first:last) = answer%dsw_dev(:n)
         slopes%water(2, first:last) = answer%dsw_dpc(:n)
      end associate
   end subroutine keep_slopes

   !> Exchanges the slopes with an archive: the next step begins with them.
   subroutine exchange_slopes(slopes, archive)
      type(slopes_t), intent(inout) :: slopes
      class(archive_t), intent(inout) :: archive
      real(wp) :: strain(PLANE**2, size(slopes%strain, 3))

      strain = reshape(slopes%strain, shape(strain))
      call archive%enter('slopes')
      call archive%exchange('known', slopes%known, 'whether the next step begins with slopes of the material')
      if (slopes%known) then
         call archive%exchange('strain', strain, 'kPa', 'd effective stress/d strain of the points')
         call archive%exchange('suction', slopes%suction, '-', 'd effective stress/d suction of the points')
         call archive%exchange('water', slopes%water, '-, 1/kPa', 'd S_w/d volume strain and d S_w/d suction')
      end if
      call archive%leave('slopes')
      slopes%strain = reshape(strain, shape(slopes%strain))
   end subroutine exchange_slopes

   !> Takes the answer that straight lines along the slopes give; the void ratio is exact. docs/theory/host.md section
   !> 5.4; the void ratio: section 3.2; S_w is kept between 0 and 1. n points of the mesh from `first` on.
   pure subroutine follow_slopes(n, first, slopes, stress, e, s_w, strain, d_suction, answer)
      integer, intent(in) :: n, first
      type(slopes_t), intent(in) :: slopes
      real(wp), intent(in) :: stress(:, :), e(:), s_w(:)        !< Stress, void ratio and saturation of these points
                                                                !< before the step. (6, n) [kPa], (n), (n) [-].
      real(wp), intent(in) :: strain(:, :), d_suction(:)        !< Increments of the step. (6, n) [-], (n) [kPa].
      type(response_t), intent(inout) :: answer
      real(wp) :: volume
      integer :: g

      do g = 1, n
         associate (p => first + g - 1)
            volume = sum(strain(1:3, g))
            answer%stress(:, g) = stress(:, g)
            answer%stress(:PLANE, g) = stress(:PLANE, g) + matmul(slopes%strain(:, :, p), strain(:PLANE, g)) &
                                       + slopes%suction(:, p)*d_suction(g)
            answer%void_ratio(g) = swollen(e(g), volume)
            answer%s_w(g) = max(0.0_wp, min(1.0_wp, s_w(g) + slopes%water(1, p)*volume &
                                            + slopes%water(2, p)*d_suction(g)))
         end associate
      end do
      call give_slopes(n, first, slopes, answer)
   end subroutine follow_slopes

   !> Takes the answer that a pass by the material left in the state at the end of the step, with the slopes it kept.
   !> docs/theory/host.md section 5.4. n points of the mesh from `first` on.
   pure subroutine kept_response(n, first, slopes, stress, e, s_w, answer)
      integer, intent(in) :: n, first
      type(slopes_t), intent(in) :: slopes
      real(wp), intent(in) :: stress(:, :), e(:), s_w(:)   !< (6, n) [kPa], (n), (n) [-].
      type(response_t), intent(inout) :: answer

      answer%stress(:, :n) = stress
      answer%void_ratio(:n) = e
      answer%s_w(:n) = s_w
      call give_slopes(n, first, slopes, answer)
   end subroutine kept_response

   pure subroutine give_slopes(n, first, slopes, answer)
      integer, intent(in) :: n, first
      type(slopes_t), intent(in) :: slopes
      type(response_t), intent(inout) :: answer

      associate (last => first + n - 1)
         answer%dsig_deps(:PLANE, :PLANE, :n) = slopes%strain(:, :, first:last)
         answer%dsig_dpc(:PLANE, :n) = slopes%suction(:, first:last)
         answer%dsw_dev(:n) = slopes%water(1, first:last)
         answer%dsw_dpc(:n) = slopes%water(2, first:last)
      end associate
   end subroutine give_slopes
end module carried_slopes
