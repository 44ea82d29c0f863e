! SPDX-License-Identifier: MIT
!> What Newton's method leaves of every step, gathered for the named points. docs/theory/host.md section 4.5.
module newton_errors
   use kinds, only: wp
   use control_state, only: control_state_t
   use generalised_alpha, only: STATIC
   use model_types, only: model_t
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: gather_newton
contains
   !> After an accepted step. A static residual is answered by the next step: the largest counts; with inertia or flow
   !> what is left goes on, and magnitudes add up.
   pure subroutine gather_newton(model, kind, left, control)
      type(model_t), intent(in) :: model
      integer, intent(in) :: kind          !< STATIC, QUASI_STATIC, DYNAMIC
      real(wp), intent(in) :: left(:)      !< (unknowns) As of system_t [m, kPa].
      type(control_state_t), intent(inout) :: control
      integer :: i, f, k

      do i = 1, size(model%points)
         do f = 1, FIELDS
            k = model%dofs%of(f, model%points(i)%node)
            if (k == 0) cycle
            if (kind == STATIC) then
               control%newton(f, i) = max(control%newton(f, i), abs(left(k)))
            else
               control%newton(f, i) = control%newton(f, i) + abs(left(k))
            end if
         end do
      end do
   end subroutine gather_newton
end module newton_errors
