! SPDX-License-Identifier: MIT
!> Books an accepted step that is not yet taken over: energies, work, outflow, work of the contacts.
!> docs/theory/host.md section 9.
module step_booking
   use kinds, only: wp
   use wall_clock, only: clock, add_elapsed
   use contact_interfaces, only: mean_contact_forces, accept_friction
   use energy_ledger, only: book_step, book_creation, count_creation, imbalance
   use generalised_alpha, only: scheme_t, DYNAMIC
   use linear_system, only: T_CONTACT
   use model_types, only: model_t
   use run_state, only: run_t
   use springs, only: mean_forces_of_springs
   use water_balance, only: book_water
   implicit none (type, external)
   private
   public :: book_accepted_step
contains
   !> Adds a step to the ledger: energies, work, outflow, contacts. docs/theory/host.md section 9.
   subroutine book_accepted_step(model, scheme, run)
      type(model_t), intent(in) :: model
      type(scheme_t), intent(in) :: scheme
      type(run_t), intent(inout) :: run
      real(wp), allocatable :: contact_force(:)
      real(wp) :: t0, dissipated

      ! the velocities of a stage without inertia are no motion: each stage begins its own account
      if (run%at%step == 1 .and. run%steps > 1) run%ledger%open_0 = imbalance(run%ledger)
      t0 = clock()
      allocate (contact_force(0))
      if (allocated(run%system%contacts%interfaces)) then
         contact_force = mean_contact_forces(run%system%contacts, model%dofs, run%state%x, run%next%x)
         call add_elapsed(run%system%seconds(T_CONTACT), t0)
      end if
      if (allocated(run%constraint%springs)) call mean_forces_of_springs(run%constraint%springs, model%dofs, scheme, &
                                                                          run%state, run%next, contact_force)
      call book_step(model%domain, model%dofs, scheme, run%constraint, run%system%reaction, contact_force, run%state, &
                     run%next, run%damping_stress, run%ledger)
      call accept_friction(run%system%contacts, run%next%x, dissipated)
      run%ledger%friction = run%ledger%friction + dissipated
      call book_creation(scheme, model%stages(run%at%stage)%tolerance, model%dofs, run%assembly%scale, &
                         run%next%x - run%state%x, run%ledger)
      call book_water(model%dofs, scheme, run%constraint, run%system%reaction, run%water)
      if (scheme%kind == DYNAMIC) call count_creation(model%stages(run%at%stage)%created_energy, run%ledger)
   end subroutine book_accepted_step

end module step_booking
