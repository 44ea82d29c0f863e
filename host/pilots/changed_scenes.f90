! SPDX-License-Identifier: MIT
!> A scene read again with other steps or another mesh: what `--verify` and `--price` run.
!> docs/theory/host.md section 12.
module changed_scenes
   use kinds, only: wp
   use effect_pilots, only: reduce_scene, apply_effects
   use effect_types, only: effect_t
   use faults, only: fault_t
   use scene_accuracy, only: shorten_given_steps
   use scene_reader, only: read_scene
   use scene_types, only: scene_t
   implicit none (type, external)
   private
   public :: read_changed
contains
   !> The scene of a file, settled, with `fineness` times the accuracy of its controlled stages and given steps
   !> `fineness` times as long, on a mesh of its own; with the effects of a table where one was made. Faults: those of
   !> read_scene and reduce_scene.
   subroutine read_changed(file, asked, fineness, mesh, effects, scene, fault)
      character(*), intent(in) :: file
      real(wp), intent(in) :: asked      !< Accuracy of the controlled stages before the change [-]; 0: none.
      real(wp), intent(in) :: fineness   !< > 0
      real(wp), intent(in) :: mesh       !< Fineness of the mesh [-]; 0: as the scene says.
      type(effect_t), allocatable, intent(in) :: effects(:)
      type(scene_t), intent(out) :: scene
      type(fault_t), intent(inout) :: fault
      character(16) :: accuracy, cells

      accuracy = ''
      if (asked > 0.0_wp) write (accuracy, '(es12.5)') fineness*asked
      cells = ''
      if (mesh > 0.0_wp) write (cells, '(es12.5)') mesh
      call read_scene(file, scene, fault, trim(adjustl(accuracy)), trim(adjustl(cells)))
      if (fault%code == 0) call reduce_scene(scene, fault)
      if (fault%code == 0 .and. allocated(effects)) call apply_effects(effects, scene)
      if (fault%code == 0) call shorten_given_steps(scene%stages, fineness)
   end subroutine read_changed
end module changed_scenes
