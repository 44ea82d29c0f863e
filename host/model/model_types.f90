! SPDX-License-Identifier: MIT
!> A model: mesh, unknowns, materials, loads, supports, plates and contacts of a scene, its names resolved to places,
!> and its terms. A model is built once (model_builder); a run reads it and changes nothing in it.
!>
!> A term is a feature of the program with a place of its own. Its file has its keys, its building from the scene, its
!> part of a stage, of a step and of a checkpoint, and what it says when a step fails. A scene that does not ask for it
!> has no object of it. Model and run know the type term_t alone; `term_registry` lists the terms. Procedures that a
!> term leaves out do nothing.
module model_types
   use archive, only: archive_t
   use degrees_of_freedom, only: dofs_t
   use faults, only: fault_t
   use key_table, only: key_table_t
   use kinds, only: wp
   use namelists, only: LENGTH
   use porous_domain, only: domain_t
   use scene_types, only: scene_t, scene_item_t, amplitude_at
   use solution, only: solution_t
   implicit none (type, external)
   private
   public :: model_t, action_t, term_t, term_box_t, factor_at, gravity_at

   real(wp), parameter :: ALWAYS = -huge(1.0_wp)

   !> Something that acts on a group of the mesh, for checks and warnings that ask no more of it.
   type, extends(scene_item_t) :: action_t
      character(10) :: what = ''                     !< Its group of the scene, as '&load'.
      integer :: group = 0, amplitude = 0            !< Of the mesh, 0: a face of its own; 0 is 1 throughout.
      character(LENGTH), allocatable :: stages(:)    !< In which it acts; none: all.
      real(wp) :: from = ALWAYS                      !< Not before this time [s].
      logical :: supports = .false.                  !< It prescribes values: where there is no ground it does nothing.
      logical :: along_normal = .false.              !< It needs ground on one side of its edges alone.
      logical :: bears = .false.                     !< It presses on the ground, or holds it.
      logical :: damps = .false.                     !< By dashpots: in dynamic stages alone, and it carries no weight.
   end type action_t

   !> The scene with the places of what it names, and what is made of it.
   type, extends(scene_t) :: model_t
      type(domain_t) :: domain
      type(dofs_t) :: dofs
      integer :: gravity_amplitude = 0
      type(action_t), allocatable :: actions(:)
      logical, allocatable :: ground(:, :)           !< (elements, stages) What a stage has; not allocated: all.
      type(term_box_t), allocatable :: terms(:)      !< Those that the scene has, in the order of their registry.
   end type model_t

   type, abstract :: term_t
   contains
      procedure(declare_i), deferred, nopass :: declare
      procedure(build_i), deferred :: build
      procedure :: group, begin_run, begin_stage, before_step, prescribe, accept, exchange, remark
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

      !> Takes what the term needs of a model whose mesh, regions and boundaries are known, and tells the model what it
      !> adds: actions, ground. Faults: what the scene asks of the term and cannot be.
      subroutine build_i(self, model, there, fault)
         import :: term_t, model_t, fault_t
         class(term_t), intent(inout) :: self
         type(model_t), intent(inout) :: model
         logical, intent(out) :: there   !< Whether the scene has it.
         type(fault_t), intent(inout) :: fault
      end subroutine build_i
   end interface
contains
   !> Factor of an amplitude at a time; amplitude 0 is 1 throughout. [-]
   pure real(wp) function factor_at(model, amplitude, time) result(factor)
      type(model_t), intent(in) :: model
      integer, intent(in) :: amplitude
      real(wp), intent(in) :: time   !< [s]

      factor = 1.0_wp
      if (amplitude > 0) factor = amplitude_at(model%amplitudes(amplitude), time)
   end function factor_at

   !> Gravity at a time, towards -z [m/s2].
   pure real(wp) function gravity_at(model, time)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time   !< [s]

      gravity_at = factor_at(model, model%gravity_amplitude, time)*model%domain%gravity
   end function gravity_at

   !> Name of the group of a scene that is the term's own; empty: its keys stand in others.
   function group(self) result(name)
      class(term_t), intent(in) :: self
      character(:), allocatable :: name

      associate (unused => self)
      end associate
      name = ''
   end function group

   !> The start of a run, with its initial state.
   subroutine begin_run(self, model, solution, fault)
      class(term_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(solution_t), intent(inout) :: solution
      type(fault_t), intent(inout) :: fault

      associate (u1 => self, u2 => model, u3 => solution, u4 => fault)
      end associate
   end subroutine begin_run

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

   !> Before an attempt at a step of length dt from solution%state to solution%next; of length 0 where a stage begins.
   !> solution%constraint has the loads of the scene and of terms before this one in the registry.
   subroutine before_step(self, model, dt, solution, fault)
      class(term_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: dt   !< [s]
      type(solution_t), intent(inout) :: solution
      type(fault_t), intent(inout) :: fault

      associate (u1 => self, u2 => model, u3 => dt, u4 => solution, u5 => fault)
      end associate
   end subroutine before_step

   !> Behind the supports of the scene: values at the end of the step that the term prescribes or limits.
   subroutine prescribe(self, model, time, solution)
      class(term_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time   !< At the end of the step [s].
      type(solution_t), intent(inout) :: solution

      associate (u1 => self, u2 => model, u3 => time, u4 => solution)
      end associate
   end subroutine prescribe

   !> After an accepted step, booked and not yet taken over. Energies [kJ] of the step grow by what the term dissipated.
   subroutine accept(self, solution, dissipated)
      class(term_t), intent(inout) :: self
      type(solution_t), intent(inout) :: solution
      real(wp), intent(inout) :: dissipated   !< [kJ]

      associate (u1 => self, u2 => solution, u3 => dissipated)
      end associate
   end subroutine accept

   !> What the term keeps from step to step, and does not find again from the scene.
   subroutine exchange(self, solution, archive)
      class(term_t), intent(inout) :: self
      type(solution_t), intent(inout) :: solution
      type(archive_t), intent(inout) :: archive

      associate (u1 => self, u2 => solution, u3 => archive)
      end associate
   end subroutine exchange

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
end module model_types
