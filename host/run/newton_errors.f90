! SPDX-License-Identifier: MIT
!> What Newton's method leaves of every step, gathered for the named points, and the tolerance that follows it.
!> docs/theory/host.md section 4.5.
module newton_errors
   use kinds, only: wp
   use control_state, only: control_state_t, is_answer
   use generalised_alpha, only: STATIC
   use model_types, only: model_t
   use named_answers, only: is_prescribed
   use scene_goals, only: is_goal
   use scene_types, only: stage_t
   use unknown_fields, only: FIELDS, FIELD_NAMES
   implicit none (type, external)
   private
   public :: gather_newton, newton_tolerance, NEWTON_SHARE

   real(wp), parameter :: NEWTON_SHARE = 0.1_wp   !< Of the accuracy: more should Newton's method not leave.
   !> A tolerance that the scene leaves open is TIGHTER where these parts of that share are used up.
   real(wp), parameter :: USED_UP(3) = [0.5_wp, 0.75_wp, 0.875_wp], TIGHTER = 0.1_wp
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

   !> Tolerance of the next step [-]. Where the scene leaves it open, what Newton's method has left of the answers makes
   !> it smaller: a function of what a checkpoint holds. Steps that are being cut have the tolerance of the stage.
   pure real(wp) function newton_tolerance(model, stage, control, cutting) result(tolerance)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(control_state_t), intent(in) :: control
      logical, intent(in) :: cutting

      tolerance = stage%tolerance
      if (stage%open_tolerance .and. .not. cutting) tolerance = &
         tolerance*TIGHTER**count(largest_share(model, control) > USED_UP*NEWTON_SHARE*stage%accuracy)
   end function newton_tolerance

   !> What Newton's method has left of an answer, as a share of its change so far: the largest of the named points. [-]
   pure real(wp) function largest_share(model, control)
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      real(wp) :: change
      integer :: i, f

      largest_share = 0.0_wp
      do i = 1, size(model%points)
         do f = 1, FIELDS
            if (model%dofs%of(f, model%points(i)%node) == 0) cycle
            if (is_prescribed(model, model%points(i)%node, f)) cycle
            if (size(model%goals) > 0) then
               if (.not. is_goal(model%goals, trim(model%points(i)%name)//'.'//trim(FIELD_NAMES(f)), .false.)) cycle
            end if
            if (control%high(f, i) < control%low(f, i)) cycle   ! No step yet.
            change = control%high(f, i) - control%low(f, i)
            if (is_answer(control, f, change)) largest_share = max(largest_share, control%newton(f, i)/change)
         end do
      end do
   end function largest_share
end module newton_errors
