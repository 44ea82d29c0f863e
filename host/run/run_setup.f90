! SPDX-License-Identifier: MIT
!> The start of a run: matrix pattern, initial state, contacts, absorbing boundaries, the flow that is to be subtracted.
module run_setup
   use kinds, only: wp
   use faults, only: fault_t
   use absorbing_boundaries, only: prepare_absorbers
   use boundary_conditions, only: new_constraint
   use contact_drainage, only: prepare_drainage
   use contact_setup, only: prepare_contacts, place_heavy_plates
   use equation_assembly, only: make_assembly
   use held_ground, only: keep_flow
   use initial_conditions, only: initial_state
   use model_types, only: model_t
   use run_state, only: run_t
   use sparsity_pattern, only: make_pattern
   use term_registry, only: build_terms
   implicit none (type, external)
   private
   public :: prepare_run
contains
   !> A run at its start; a fault where the initial state is refused. Faults: those of initial_state, prepare_contacts,
   !> prepare_drainage, prepare_absorbers and keep_flow.
   subroutine prepare_run(model, run, fault)
      type(model_t), intent(in) :: model
      type(run_t), intent(out) :: run
      type(fault_t), intent(inout) :: fault

      call build_terms(model, run%terms, fault)
      if (fault%code /= 0) return
      run%system%reuse = model%reuse_factors
      run%system%sparse%ordering = model%ordering
      call make_pattern(model%dofs%n, model%dofs%element, reshape([integer ::], [2, 0]), run%pattern)
      call make_assembly(model%domain, model%dofs, run%pattern, run%assembly)
      run%constraint = new_constraint(model, model%dofs)
      call initial_state(model, run%state, fault, run%tension)
      if (fault%code == 0) call prepare_contacts(model, run%system%contacts, fault)
      if (fault%code == 0) call prepare_drainage(model, run%drainage, fault)
      if (fault%code == 0) call place_heavy_plates(model, run%system%contacts, run%state)
      if (fault%code == 0) call prepare_absorbers(model, run%state, run%constraint%dashpots, fault)
      run%next = run%state
      if (any(model%domain%regions%stiffness_damping > 0.0_wp)) &
         allocate (run%damping_stress(4, size(run%state%stress, 2)), source=0.0_wp)
      if (fault%code == 0 .and. model%subtract_flow) call keep_flow(model, run, fault)
   end subroutine prepare_run
end module run_setup
