! SPDX-License-Identifier: MIT
!> An accepted step is completed by what its equations say beside the unknowns: flows out of the ground, and the mean
!> forces of contacts and of the springs of terms. docs/theory/host.md section 9.
module step_balance
   use kinds, only: wp
   use porous_domain, only: OUTFLOWS
   use run_state, only: run_t
   use solution, only: T_CONTACT
   use springs, only: add_mean_of_springs
   use unknown_fields, only: AT_P_W, AT_P_C
   use wall_clock, only: clock, add_elapsed
   implicit none (type, external)
   private
   public :: balance_step, mean_outflow
contains
   !> Completes an accepted step that is not yet taken over.
   subroutine balance_step(run)
      type(run_t), intent(inout) :: run

      call find_outflow(run)
      call find_mean_forces(run)
   end subroutine balance_step

   !> Finds the flow out through prescribed pressures and past limits at the end of a step, less what is offered to
   !> these: what they refuse never entered.
   subroutine find_outflow(run)
      type(run_t), intent(inout) :: run
      real(wp) :: flow(OUTFLOWS)
      integer :: i

      associate (dofs => run%dofs, scheme => run%scheme, constraint => run%constraint, &
                 reaction => run%system%reaction, before => run%state%outflow)
         run%next%outflow = 0.0_wp
         if (.not. scheme%has_rates) return
         flow = [-sum(constraint%offered_0 + scheme%l_f*(constraint%offered_1 - constraint%offered_0)), 0.0_wp]
         do i = 1, dofs%n
            if (dofs%field(i) == AT_P_W .and. constraint%fixed(i)) flow(1) = flow(1) - reaction(i)
            if (dofs%field(i) /= AT_P_C) cycle
            if (constraint%fixed(i)) flow(2) = flow(2) - reaction(i)
            if (constraint%air(dofs%node(i))) flow = flow - reaction(i)
         end do
         run%next%outflow = before + (flow - before)/scheme%l_p
      end associate
   end subroutine find_outflow

   !> Finds the mean flow out over a step [m3/s]: that of the rate of what is stored, so that what has left is what is
   !> missing inside, whatever the steps.
   pure function mean_outflow(run) result(mean)
      type(run_t), intent(in) :: run
      real(wp) :: mean(OUTFLOWS)

      mean = run%state%outflow + run%scheme%gamma_1*(run%next%outflow - run%state%outflow)
   end function mean_outflow

   !> Finds the mean of the forces of contacts and springs at the ends of a step, to be added to the internal ones;
   !> those of the contacts are zero where the displacements are refused.
   subroutine find_mean_forces(run)
      type(run_t), intent(inout) :: run
      real(wp), allocatable :: before(:), after(:)
      real(wp) :: t0

      run%mean_force = spread(0.0_wp, 1, run%dofs%n)
      if (allocated(run%system%contacts)) then
         t0 = clock()
         if (run%system%contacts%forces(run%dofs, run%state%x, before)) then
            if (run%system%contacts%forces(run%dofs, run%next%x, after)) run%mean_force = 0.5_wp*(before + after)
         end if
         call add_elapsed(run%system%seconds(T_CONTACT), t0)
      end if
      call add_mean_of_springs(run, run%mean_force)
   end subroutine find_mean_forces
end module step_balance
