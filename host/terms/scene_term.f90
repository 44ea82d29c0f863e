! SPDX-License-Identifier: MIT
!> Terms as they are built: their keys in a scene, and what they take of it. `term_registry` lists them.
module scene_term
   use faults, only: fault_t
   use key_table, only: key_table_t
   use model_types, only: model_t, term_t
   use scene_types, only: scene_t
   implicit none (type, external)
   private
   public :: scene_term_t

   type, abstract, extends(term_t) :: scene_term_t
   contains
      procedure(declare_i), deferred, nopass :: declare
      procedure(build_i), deferred :: build
      procedure :: group
   end type scene_term_t

   abstract interface
      !> Lists the keys that the term has in the group of a table, its own or another one.
      subroutine declare_i(k)
         import :: key_table_t
         type(key_table_t), intent(inout) :: k
      end subroutine declare_i

      !> Takes what the term needs of a scene, and of a model whose mesh, regions and boundaries are known, and tells
      !> the model what it adds: actions, ground. Faults: what the scene asks of the term and cannot be.
      subroutine build_i(self, scene, model, there, fault)
         import :: scene_term_t, scene_t, model_t, fault_t
         class(scene_term_t), intent(inout) :: self
         type(scene_t), intent(in) :: scene
         type(model_t), intent(inout) :: model
         logical, intent(out) :: there   !< Whether the scene has it.
         type(fault_t), intent(inout) :: fault
      end subroutine build_i
   end interface
contains
   !> Name of the group of a scene that is the term's own; empty: its keys stand in others.
   function group(self) result(name)
      class(scene_term_t), intent(in) :: self
      character(:), allocatable :: name

      name = ''
   end function group
end module scene_term
