! SPDX-License-Identifier: MIT
!> A scene made cheap for a pilot: fewer cells between the same breaks, longer steps. docs/theory/host.md section 11.
module pilot_scenes
   use kinds, only: wp
   use scene_types, only: scene_t
   implicit none (type, external)
   private
   public :: coarsen_scene, can_coarsen

   integer, parameter :: LEAST_STEPS = 20                !< Of a stage whose dt is given.
   real(wp), parameter :: LEAST_ACCURACY = 0.3_wp        !< Of steps that are controlled [-].
contains
   !> Whether the mesh is built in and has more than one cell between two breaks.
   pure logical function can_coarsen(scene)
      type(scene_t), intent(in) :: scene

      can_coarsen = scene%mesh%mesh_file == '' .and. (any(scene%mesh%r_cells > 1) .or. any(scene%mesh%z_cells > 1))
   end function can_coarsen

   !> `cells` times as long cells, `steps` times as long steps, as far as at least LEAST_STEPS are left of a stage, or
   !> `steps` times the accuracy of those that are controlled. Long steps must not make a contact gain energy.
   pure subroutine coarsen_scene(cells, steps, scene)
      integer, intent(in) :: cells, steps   !< Factors, at least 1.
      type(scene_t), intent(inout) :: scene
      real(wp) :: times
      integer :: i

      if (scene%mesh%mesh_file == '') then
         call coarsen(cells, scene%mesh%r_cells, scene%mesh%r_ratio)
         call coarsen(cells, scene%mesh%z_cells, scene%mesh%z_ratio)
      end if
      do i = 1, size(scene%stages)
         associate (stage => scene%stages(i))
            ! A bad pilot shows in its own error.
            stage%created_energy = huge(1.0_wp)
            if (stage%controlled) then
               stage%accuracy = max(stage%accuracy, min(steps*stage%accuracy, LEAST_ACCURACY))
               stage%output_dt = 0.0_wp
            else
               times = max(1.0_wp, min(real(steps, wp), stage%duration/(stage%dt*LEAST_STEPS)))
               stage%dt = times*stage%dt
               if (stage%dt_max < huge(1.0_wp)) stage%dt_max = times*stage%dt_max
               if (times > 1.0_wp .and. size(scene%contacts) > 0) stage%rho_inf = 0.0_wp
            end if
         end associate
      end do
   end subroutine coarsen_scene

   !> Fewer cells of the same grading from end to end.
   pure subroutine coarsen(times, cells, ratio)
      integer, intent(in) :: times
      integer, intent(inout) :: cells(:)
      real(wp), intent(inout) :: ratio(:)
      integer :: fewer(size(cells))

      fewer = (cells + times - 1)/times
      ratio = ratio**(real(cells, wp)/fewer)
      cells = fewer
   end subroutine coarsen
end module pilot_scenes
