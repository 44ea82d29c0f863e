! SPDX-License-Identifier: MIT
!> The start of a run: matrix pattern, initial state, contacts, terms, the flow that is to be subtracted.
module run_setup
   use kinds, only: wp
   use faults, only: fault_t, raise
   use boundary_conditions, only: new_constraint
   use contact_setup, only: prepare_contacts, place_heavy_plates
   use equation_assembly, only: make_assembly, assemble
   use exit_codes, only: EXIT_MATERIAL
   use generalised_alpha, only: make_scheme, DYNAMIC
   use initial_conditions, only: initial_state
   use model_types, only: model_t
   use run_state, only: run_t
   use sparsity_pattern, only: make_pattern
   use texts, only: whole
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: prepare_run
contains
   !> Makes a run at its start. Faults are those of initial_state, which may refuse the state, of prepare_contacts,
   !> keep_flow and the terms.
   subroutine prepare_run(model, run, fault)
      type(model_t), intent(inout), target :: model   !< It stays as long as the run, which sets tolerances of its laws.
      type(run_t), intent(out) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i

      run%model => model
      run%domain => model%domain
      run%dofs => model%dofs
      run%system%reuse = model%reuse_factors
      allocate (run%system%extra(2, 0))
      call make_pattern(model%dofs%n, model%dofs%element, run%system%extra, run%pattern)
      call make_assembly(model%domain, model%dofs, run%pattern, run%assembly)
      run%constraint = new_constraint(model)
      call initial_state(model, run%state, fault, run%tension)
      if (fault%code == 0) call prepare_contacts(model, run%system%contacts, fault)
      if (fault%code == 0) call place_heavy_plates(model, run%state)
      run%terms = model%terms
      do i = 1, size(run%terms)
         if (fault%code == 0) call run%terms(i)%term%begin_run(run%problem_t, fault)
      end do
      run%next = run%state
      if (fault%code == 0 .and. model%subtract_flow) call keep_flow(run, fault)
   end subroutine prepare_run

   !> Keeps the flow of the initial state, to be subtracted from then on. docs/theory/host.md section 8. Fault
   !> EXIT_MATERIAL: a material refuses the initial state.
   subroutine keep_flow(run, fault)
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      call assemble(run%domain, run%dofs, run%pattern, make_scheme(DYNAMIC, 1.0_wp, 1.0_wp), run%state, &
                    run%next, .false., run%assembly)
      if (run%assembly%bad_element > 0) then
         call raise(fault, EXIT_MATERIAL, 'The initial state is refused by the material of element '// &
                    whole(run%assembly%bad_element)//'.')
         return
      end if
      where (run%dofs%field > DISPLACEMENTS) run%constraint%offset = -run%assembly%residual
      run%next = run%state
   end subroutine keep_flow
end module run_setup
