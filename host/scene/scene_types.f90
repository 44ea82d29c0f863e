! SPDX-License-Identifier: MIT
!> A scene as its file says it: its groups, every key checked. Each group is read where the model is built of it
!> (scene_keys lists who does), which resolves its names.
module scene_types
   use namelists, only: group_t
   use scene_parts, only: origin_t, scene_item_t
   use texts, only: LENGTH
   implicit none (type, external)
   private
   public :: scene_t, item_of, groups_named

   type :: scene_t
      type(origin_t) :: origin
      type(group_t), allocatable :: as_read(:)
      type(group_t), allocatable :: groups(:)        !< The same without the effects that `without` takes out.
      character(LENGTH), allocatable :: absent(:)    !< Effects of `without` that the scene did not have.
   end type scene_t
contains
   !> Where a group stands.
   pure function item_of(group) result(item)
      type(group_t), intent(in) :: group
      type(scene_item_t) :: item

      item = scene_item_t(group%file, group%line)
   end function item_of

   !> Groups of a name that a model is built of.
   pure function groups_named(scene, name) result(groups)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: name
      type(group_t), allocatable :: groups(:)

      groups = pack(scene%groups, scene%groups%name == name)
   end function groups_named
end module scene_types
