! SPDX-License-Identifier: MIT
!> Terms as they are built: their keys in a scene, and what they take of it. `term_registry` lists them.
module scene_term
   use faults, only: fault_t
   use key_table, only: key_table_t
   use model_types, only: model_t, term_t
   implicit none (type, external)
   private
   public :: scene_term_t

   type, abstract, extends(term_t) :: scene_term_t
   contains
      procedure, nopass :: declare
      procedure(build_i), deferred :: build
   end type scene_term_t

   abstract interface
      !> Takes what the term needs of its groups, and of a model whose mesh, regions and boundaries are known, and tells
      !> the model what it adds: actions, ground. Faults: what the scene asks of the term and cannot be.
      subroutine build_i(self, tables, model, there, fault)
         import :: scene_term_t, key_table_t, model_t, fault_t
         class(scene_term_t), intent(inout) :: self
         type(key_table_t), intent(inout) :: tables(:)   !< Every group of the scene that the term's keys stand in.
         type(model_t), intent(inout) :: model
         logical, intent(out) :: there   !< Whether the scene has it.
         type(fault_t), intent(inout) :: fault
      end subroutine build_i
   end interface
contains
   !> Lists the keys of the term in the group of a table.
   subroutine declare(k)
      type(key_table_t), intent(inout) :: k
   end subroutine declare
end module scene_term
