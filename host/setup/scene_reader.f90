! SPDX-License-Identifier: MIT
!> Reads a scene: groups in any order, every key checked against the list of keys, before a model is built of them.
module scene_reader
   use faults, only: fault_t
   use namelists, only: group_t, read_groups
   use scene_fingerprint, only: origin_of
   use scene_keys, only: check_keys, check_counts
   use effect_switches, only: remove_effects
   use scene_names, only: check_names
   use scene_settings, only: apply_settings
   use scene_types, only: scene_t
   implicit none (type, external)
   private
   public :: read_scene
contains
   !> Reads and checks a scene; a fault names file, line, value, range and the nearest name. Fault EXIT_INPUT: the file
   !> cannot be read, or a group, key or value is refused; EXIT_GROUP: a stage that nobody defines.
   subroutine read_scene(file, scene, fault, settings)
      character(*), intent(in) :: file
      type(scene_t), intent(out) :: scene
      type(fault_t), intent(inout) :: fault
      character(*), intent(in), optional :: settings(:)   !< Keys in place of those of the scene, as GROUP.KEY=VALUE.
      type(group_t), allocatable :: groups(:)

      call read_groups(file, groups, fault)
      if (present(settings) .and. fault%code == 0) call apply_settings(settings, groups, fault)
      if (fault%code == 0) call check_keys(groups, fault)
      if (fault%code == 0) call check_names(groups, fault)
      if (fault%code == 0) call check_counts(file, groups, fault)
      if (fault%code /= 0) return
      scene%origin = origin_of(file, groups)
      call move_alloc(groups, scene%as_read)
      call remove_effects(scene, fault)
   end subroutine read_scene
end module scene_reader
