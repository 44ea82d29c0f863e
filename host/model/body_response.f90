! SPDX-License-Identifier: MIT
!> How the linearised body answers to what acts on it: strain energy under a load history, and under the forces that
!> nothing balances at the start.
module body_response
   use kinds, only: wp
   use boundary_loads, only: load_at
   use effect_types, only: UNBOUNDED
   use linearised_body, only: linearised_body_t, mass_times
   use load_histories, only: load_history_t, start_of, FORCE, MOTION
   use model_types, only: model_t
   use sparse_factors, only: backsolve, times
   use unknown_fields, only: DISPLACEMENTS, AT_U_Z
   implicit none (type, external)
   private
   public :: response_of, imbalance_of

   real(wp), parameter :: NO_STRAIN = 1.0e-6_wp       !< Below it a motion carries the body along as a whole.

contains
   !> Square root of twice the strain energy under the largest change of a load history, and how much of the response to
   !> a prescribed motion is carried along without strain: at least 1, and the bound of its vibration grows with it.
   subroutine response_of(model, history, body, energy, carried)
      type(model_t), intent(in) :: model
      type(load_history_t), intent(in) :: history
      type(linearised_body_t), intent(inout) :: body
      real(wp), intent(out) :: energy, carried   !< [kJ**(1/2)], [-]
      real(wp) :: b(body%dofs%n), x(body%dofs%n), y(body%dofs%n)
      integer :: k, at, status

      energy = 0.0_wp
      carried = 1.0_wp
      if (.not. body%omega > 0.0_wp .or. .not. history%change > 0.0_wp) return
      b = 0.0_wp
      if (history%kind == FORCE .and. history%load > 0) then
         associate (load => model%loads(history%load))
            b = load%shape
            ! Of a load that changes with z: its distribution, with 1 where it is largest.
            if (allocated(load%rise)) b = (load%value*load%shape + load%value_slope*load%rise)/history%value
         end associate
         b = merge(b, 0.0_wp, body%free)
         call backsolve(body%sparse, body%held, b, x, status)
         energy = sqrt(max(dot_product(x, b), 0.0_wp))*history%change
      else if (history%kind == FORCE) then
         at = body%dofs%of(AT_U_Z, model%plates(history%plate)%node)
         if (body%free(at)) b(at) = 1.0_wp
         call backsolve(body%sparse, body%held, b, x, status)
         energy = sqrt(max(dot_product(x, b), 0.0_wp))*history%change
      else if (history%kind == MOTION) then
         x = 0.0_wp
         do k = 1, size(model%domain%mesh%groups(history%group)%nodes)
            at = body%dofs%of(history%field, model%domain%mesh%groups(history%group)%nodes(k))
            if (at > 0) x(at) = 1.0_wp
         end do
         call times(body%sparse, body%matrix, x, y)
         b = merge(-y, 0.0_wp, body%free)
         call backsolve(body%sparse, body%held, b, y, status)
         x = x + merge(y, 0.0_wp, body%free)
         where (body%dofs%field > DISPLACEMENTS) x = 0.0_wp
         call times(body%sparse, body%matrix, x, y)
         energy = sqrt(max(dot_product(x, y), 0.0_wp))
         b = mass_times(model, body, x)
         carried = body%omega*sqrt(dot_product(x, b))
         carried = merge(UNBOUNDED, max(1.0_wp, carried/max(energy, NO_STRAIN*carried)), energy <= NO_STRAIN*carried)
         energy = energy*history%change
      end if
   end subroutine response_of

   !> The same of the forces that nothing balances when a stage begins with the initial state.
   real(wp) function imbalance_of(model, stage, body) result(energy)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage
      type(linearised_body_t), intent(inout) :: body
      real(wp), parameter :: ROUNDING = 1.0e-9_wp
      real(wp) :: b(body%dofs%n), x(body%dofs%n), y(body%dofs%n)
      integer :: status

      energy = 0.0_wp
      if (.not. body%omega > 0.0_wp) return
      b = load_at(model, model%stages(stage), body%dofs, start_of(model, stage))
      y = merge(abs(b) + body%assembly%scale, 0.0_wp, body%free)
      b = merge(b - body%assembly%residual, 0.0_wp, body%free)
      if (norm2(b) <= ROUNDING*norm2(y)) return
      call backsolve(body%sparse, body%held, b, x, status)
      energy = sqrt(max(dot_product(x, b), 0.0_wp))
   end function imbalance_of
end module body_response
