! SPDX-License-Identifier: MIT
!> The terms of the program. A new term is one new file and one line in `list_terms`.
module term_registry
   use absorbing, only: absorbing_t
   use buffer, only: buffer_t
   use contact_drainage, only: contact_drainage_t
   use drained_regions, only: drained_regions_t
   use faults, only: fault_t
   use friction, only: friction_t
   use key_table, only: key_table_t
   use model_types, only: model_t, term_box_t
   use namelists, only: group_t
   use plane_plates, only: plane_plates_t
   use run_off, only: run_off_t
   use scene_term, only: scene_term_t
   use scene_types, only: scene_t, groups_named
   use staging, only: staging_t
   use strength, only: strength_t
   use viscosity, only: viscosity_t
   implicit none (type, external)
   private
   public :: with_own_groups, declare_keys, build_terms

   integer, parameter :: GROUP_LENGTH = 12

   !> A place of the list.
   type :: registered_t
      character(GROUP_LENGTH) :: group   !< That its keys stand in, its own or another one.
      class(scene_term_t), allocatable :: term
   end type registered_t
contains
   !> Lists all of them, unbuilt, in the order in which they act.
   subroutine list_terms(list)
      type(registered_t), allocatable, intent(out) :: list(:)

      allocate (list(0))
      call add('plate', plane_plates_t())
      call add('strength', strength_t())
      call add('region', staging_t())
      call add('absorbing', absorbing_t())
      call add('contact', contact_drainage_t())
      call add('region', drained_regions_t())
      call add('load', run_off_t())
      call add('contact', friction_t())
      call add('buffer', buffer_t())
      call add('region', viscosity_t())
   contains
      subroutine add(group, one)
         character(*), intent(in) :: group
         class(scene_term_t), intent(in) :: one
         type(registered_t) :: box

         box%group = group
         allocate (box%term, source=one)
         list = [list, box]
      end subroutine add
   end subroutine list_terms

   !> Lists names of groups of a scene, those of others and those that belong to terms alone.
   function with_own_groups(others) result(names)
      character(GROUP_LENGTH), intent(in) :: others(:)
      character(GROUP_LENGTH), allocatable :: names(:)
      type(registered_t), allocatable :: list(:)
      integer :: i

      call list_terms(list)
      names = others
      do i = 1, size(list)
         if (all(names /= list(i)%group)) names = [names, list(i)%group]
      end do
   end function with_own_groups

   !> Lists the keys that terms have in the group of a table.
   subroutine declare_keys(k, nothing, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: nothing
      type(fault_t), intent(inout) :: fault
      type(registered_t), allocatable :: list(:)
      integer :: i

      call list_terms(list)
      do i = 1, size(list)
         if (list(i)%group == k%group%name) call list(i)%term%build_group(k, 0, nothing, fault)
      end do
   end subroutine declare_keys

   !> Gives a model the terms that its scene asks for. Faults are theirs.
   subroutine build_terms(scene, model, fault)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(registered_t), allocatable :: list(:)
      integer :: i

      call list_terms(list)
      allocate (model%terms(0))
      do i = 1, size(list)
         if (fault%code == 0) call build_term(list(i), scene, model, fault)
      end do
   end subroutine build_terms

   subroutine build_term(registered, scene, model, fault)
      type(registered_t), intent(inout) :: registered
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(group_t), allocatable :: groups(:)
      type(key_table_t) :: table
      type(term_box_t) :: box
      integer :: i

      allocate (groups, source=groups_named(scene, trim(registered%group)))
      do i = 1, size(groups)
         table%group = groups(i)
         if (fault%code == 0) call registered%term%build_group(table, i, model, fault)
      end do
      if (fault%code == 0) call registered%term%build(model, fault)
      if (fault%code /= 0 .or. .not. registered%term%wanted) return
      allocate (box%term, source=registered%term)
      model%terms = [model%terms, box]
   end subroutine build_term
end module term_registry
