! SPDX-License-Identifier: MIT
!> Terms as they are built: their keys in a scene, and what they take of it. `term_registry` lists them.
module scene_term
   use faults, only: fault_t
   use key_table, only: key_table_t
   use model_types, only: model_t, term_t
   implicit none (type, external)
   private
   public :: scene_term_t

   !> Procedures that a term leaves out do nothing.
   type, abstract, extends(term_t) :: scene_term_t
      logical :: wanted = .false.   !< The scene asks for the term, which the model gets; set by either procedure.
   contains
      procedure :: build_group, build
   end type scene_term_t
contains
   !> Declares the keys that the term has in a group, and takes what it needs of them, and of a model whose mesh,
   !> regions and boundaries are known; with a table that only lists it ends after the keys. Tells the model what it
   !> adds: actions, ground. Faults: what the scene asks of the term and cannot be.
   subroutine build_group(self, k, number, model, fault)
      class(scene_term_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number   !< Of the group among those of its name.
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
   end subroutine build_group

   !> Does what is left to do after the groups. Faults are as those of build_group.
   subroutine build(self, model, fault)
      class(scene_term_t), intent(inout) :: self
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
   end subroutine build
end module scene_term
