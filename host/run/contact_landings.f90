! SPDX-License-Identifier: MIT
!> Controlled steps end where a contact closes: what meets within a step leaves no error of its own size in it, since it
!> is hardly stopped there. docs/theory/host.md section 4.5.
module contact_landings
   use kinds, only: wp
   use run_state, only: run_t
   use step_landings, only: LAST_STEP, SHORTEST
   use unknown_fields, only: FIELDS, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: closed_contacts, ends_at_closing, end_where_it_closes

   integer, parameter :: BISECTIONS = 40     !< Bisections of the time at which a contact closes: 1e-12 of the step.
   !> A closing nearer than this share of the step that the error asks for is not landed on: the step may hold it.
   real(wp), parameter :: NEAREST = 0.015_wp
contains
   !> 1 for every contact that is closed at given displacements, else 0; 0 too where these are refused.
   function closed_contacts(run, x) result(closed)
      type(run_t), intent(inout) :: run
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) [m]
      real(wp) :: closed(size(run%control%touching))
      logical :: are_closed(size(closed))

      if (size(closed) > 0) call run%system%contacts%find_closed(x, are_closed)
      closed = merge(1.0_wp, 0.0_wp, are_closed)
   end function closed_contacts

   !> Whether a step in which a contact closes ends there, or has been repeated so that it should. If not, the next
   !> attempt does.
   logical function ends_at_closing(run) result(ends)
      type(run_t), intent(inout) :: run

      associate (c => run%control, dt => run%scheme%dt)
         ends = c%located .or. dt <= SHORTEST*run%stage%duration
         if (ends) return
         call end_where_it_closes(run)
         ends = c%controller%dt >= dt*(1 - LAST_STEP)
         c%located = .not. ends
         if (.not. ends) c%rejected = c%rejected + 1
      end associate
   end function ends_at_closing

   !> The next attempt ends where a contact closes, if that is shorter than what its error asks for. The time is looked
   !> for along the motion that keeps its accelerations: exact for bodies in free flight. Where that motion closes none
   !> the step stays as its error asks for.
   subroutine end_where_it_closes(run)
      type(run_t), intent(inout) :: run
      real(wp) :: open, shut, middle
      integer :: i

      open = 0.0_wp
      shut = run%scheme%dt
      if (.not. closes_after(shut)) return
      do i = 1, BISECTIONS
         middle = 0.5_wp*(open + shut)
         if (closes_after(middle)) then
            shut = middle
         else
            open = middle
         end if
      end do
      associate (dt_next => run%control%controller%dt)
         if (shut > NEAREST*dt_next) dt_next = min(dt_next, shut)
      end associate
   contains
      logical function closes_after(time)
         real(wp), intent(in) :: time   !< [s]
         real(wp) :: x(FIELDS, size(run%state%x, 2))

         x = run%state%x + time*run%state%v
         x(:DISPLACEMENTS, :) = x(:DISPLACEMENTS, :) + 0.5_wp*time**2*run%state%a
         closes_after = any(closed_contacts(run, x) > run%control%touching)
      end function closes_after
   end subroutine end_where_it_closes
end module contact_landings
