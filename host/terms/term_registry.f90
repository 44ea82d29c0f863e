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
   use plane_plates, only: plane_plates_t
   use run_off, only: run_off_t
   use scene_term, only: scene_term_t
   use scene_types, only: scene_t
   use staging, only: staging_t
   use strength, only: strength_t
   use viscosity, only: viscosity_t
   implicit none (type, external)
   private
   public :: own_groups, declare_keys, build_terms

   integer, parameter :: GROUP_LENGTH = 12

   !> A place of the list.
   type :: registered_t
      class(scene_term_t), allocatable :: term
   end type registered_t
contains
   !> All of them, unbuilt, in the order in which they act.
   subroutine list_terms(list)
      type(registered_t), allocatable, intent(out) :: list(:)

      allocate (list(0))
      call add(plane_plates_t())
      call add(strength_t())
      call add(staging_t())
      call add(absorbing_t())
      call add(contact_drainage_t())
      call add(drained_regions_t())
      call add(run_off_t())
      call add(friction_t())
      call add(buffer_t())
      call add(viscosity_t())
   contains
      subroutine add(one)
         class(scene_term_t), intent(in) :: one
         type(registered_t) :: box

         allocate (box%term, source=one)
         list = [list, box]
      end subroutine add
   end subroutine list_terms

   !> Names of the groups of a scene that belong to terms.
   function own_groups() result(names)
      character(GROUP_LENGTH), allocatable :: names(:)
      type(registered_t), allocatable :: list(:)
      integer :: i

      call list_terms(list)
      allocate (names(0))
      do i = 1, size(list)
         if (list(i)%term%group() /= '') names = [character(GROUP_LENGTH) :: names, list(i)%term%group()]
      end do
   end function own_groups

   !> Lists the keys that terms have in the group of a table.
   subroutine declare_keys(k)
      type(key_table_t), intent(inout) :: k
      type(registered_t), allocatable :: list(:)
      integer :: i

      call list_terms(list)
      do i = 1, size(list)
         call list(i)%term%declare(k)
      end do
   end subroutine declare_keys

   !> Gives a model the terms that its scene asks for. Faults: theirs.
   subroutine build_terms(scene, model, fault)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(registered_t), allocatable :: list(:)
      type(term_box_t) :: box
      logical :: there
      integer :: i

      call list_terms(list)
      allocate (model%terms(0))
      do i = 1, size(list)
         call list(i)%term%build(scene, model, there, fault)
         if (fault%code /= 0) return
         if (.not. there) cycle
         if (allocated(box%term)) deallocate (box%term)
         allocate (box%term, source=list(i)%term)
         model%terms = [model%terms, box]
      end do
   end subroutine build_terms
end module term_registry
