! SPDX-License-Identifier: MIT
!> State of a run: everything that one step hands to the next.
module run_state
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   use contact_drainage, only: drainage_t
   use control_state, only: control_state_t
   use energy_ledger, only: ledger_t
   use equation_assembly, only: assembly_t
   use initial_conditions, only: tension_t
   use linear_system, only: system_t
   use prescribed_values, only: constraint_t
   use porous_domain, only: state_t
   use pressure_alarm, only: lines_t
   use sparsity_pattern, only: pattern_t
   implicit none (type, external)
   private
   public :: run_t, stage_state_t

   !> Place in the stages, and the step size.
   type :: stage_state_t
      integer :: stage = 0                     !< Number of the stage under way; 0: before the first.
      integer :: step = 0                      !< Steps done in it.
      integer :: cuts = 0, good = 0            !< Cuts in force; accepted steps since the last cut or growth.
      real(wp) :: t_start = 0.0_wp             !< Time at its start [s].
      real(wp) :: nominal = 0.0_wp             !< Step without cuts [s].
      real(wp) :: factor = 1.0_wp              !< Share of it after cuts.
      real(wp), allocatable :: x_start(:, :)   !< Unknowns at its start, which some boundaries hold.
      ! Where parts of the ground join or leave, else not allocated.
      real(wp), allocatable :: held_up(:)      !< (unknowns) Forces at the start of what leaves with this stage [kN].
      logical, allocatable :: absent(:)        !< (unknowns) No present element has them.
      !> (unknowns) What acted at once at the start and is applied evenly over the stage; not allocated: nothing [kN].
      real(wp), allocatable :: sudden(:)
   end type stage_state_t

   type :: run_t
      type(pattern_t) :: pattern               !< Of the matrix; it grows with the contacts.
      type(assembly_t) :: assembly
      type(system_t) :: system
      type(constraint_t) :: constraint
      type(drainage_t) :: drainage
      type(state_t) :: state, next             !< Before and after the step under way.
      type(ledger_t) :: ledger
      !> (4, points) Stress of the damping in proportion to the stiffness, for the ledger; where a region has it [kPa].
      real(wp), allocatable :: damping_stress(:, :)
      type(stage_state_t) :: at
      type(tension_t) :: tension               !< Of the initial state, for a warning.
      type(control_state_t) :: control         !< Of the time step, in stages that choose it.
      integer :: steps = 0, iterations = 0, cuts = 0
      integer(int64) :: rate_evaluations = 0   !< Of the material.
      ! Warnings that are said once.
      type(lines_t) :: lines                   !< Of the mesh, for the first of them.
      logical :: told_oscillation = .false., told_pressure = .false., told_inflow = .false., told_dry = .false.
      real(wp) :: seconds_output = 0.0_wp      !< Wall time.
   end type run_t
end module run_state
