! SPDX-License-Identifier: MIT
!> A term: a feature of the program with a place of its own. Its file has its keys, its building from the scene, its
!> part of a stage and of a step, and what it says when a step fails. A scene that does not ask for it has no object of
!> it. The run knows this type alone; `term_registry` lists the terms. Procedures that a term leaves out do nothing.
module term
   use kinds, only: wp
   use faults, only: fault_t
   use key_table, only: key_table_t
   use model_types, only: model_t
   use solution, only: solution_t
   implicit none (type, external)
   private
   public :: term_t, term_box_t

   type, abstract :: term_t
   contains
      procedure :: group
      procedure(declare_i), deferred, nopass :: declare
      procedure(build_i), deferred :: build
      procedure :: begin_stage, before_step, remark
   end type term_t

   !> An element of a list of terms.
   type :: term_box_t
      class(term_t), allocatable :: term
   end type term_box_t

   abstract interface
      !> Lists the keys that the term has in the group of a table, its own or another one.
      subroutine declare_i(k)
         import :: key_table_t
         type(key_table_t), intent(inout) :: k
      end subroutine declare_i

      !> Takes what the term needs of a model whose mesh and unknowns are known. Faults: what the scene asks of the term
      !> and cannot be.
      subroutine build_i(self, model, there, fault)
         import :: term_t, model_t, fault_t
         class(term_t), intent(inout) :: self
         type(model_t), intent(in) :: model
         logical, intent(out) :: there   !< Whether the scene has it.
         type(fault_t), intent(inout) :: fault
      end subroutine build_i
   end interface
contains
   !> Name of the group of a scene that is the term's own; empty: its keys stand in others.
   function group(self) result(name)
      class(term_t), intent(in) :: self
      character(:), allocatable :: name

      associate (unused => self)
      end associate
      name = ''
   end function group

   !> The start of the stage solution%at%stage, from solution%state; also where a run is taken up within the stage.
   subroutine begin_stage(self, model, begins, solution, fault)
      class(term_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      logical, intent(in) :: begins   !< Else the run is in the middle of it.
      type(solution_t), intent(inout) :: solution
      type(fault_t), intent(inout) :: fault

      associate (u1 => self, u2 => model, u3 => begins, u4 => solution, u5 => fault)
      end associate
   end subroutine begin_stage

   !> Before an attempt at a step of length dt from solution%state to solution%next.
   subroutine before_step(self, model, dt, solution, fault)
      class(term_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: dt   !< [s]
      type(solution_t), intent(inout) :: solution
      type(fault_t), intent(inout) :: fault

      associate (u1 => self, u2 => model, u3 => dt, u4 => solution, u5 => fault)
      end associate
   end subroutine before_step

   !> What the term may have to do with a step that fails: the end of a sentence, or nothing.
   function remark(self, model, time) result(text)
      class(term_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time   !< At the end of the step [s].
      character(:), allocatable :: text

      associate (u1 => self, u2 => model, u3 => time)
      end associate
      text = ''
   end function remark
end module term
