! SPDX-License-Identifier: MIT
!> The time integration of the stages that holds where the scene leaves it open.
module stage_builder
   use kinds, only: wp
   use convergence, only: measure_in
   use generalised_alpha, only: has_inertia, is_flow
   use model_types, only: model_t
   use scene_parts, only: acts_in
   implicit none (type, external)
   private
   public :: choose_schemes

   real(wp), parameter :: SMOOTH = 0.8_wp     !< rho_inf of a stage without contact.
   real(wp), parameter :: OPENING = 0.0_wp    !< With contact: no energy is gained where a penalty opens and closes
                                              !< (docs/theory/host.md section 4.1).
contains
   !> rho_inf and the measure of Newton's error of the stages that the scene leaves them open in. docs/theory/host.md
   !> sections 4.1 and 5.1.
   pure subroutine choose_schemes(model)
      type(model_t), intent(inout) :: model
      logical :: touching
      integer :: i, k

      do i = 1, size(model%stages)
         associate (stage => model%stages(i))
            touching = .false.
            do k = 1, size(model%contacts)
               touching = touching .or. acts_in(model%contacts(k)%stages, stage%name)
            end do
            stage%measure = measure_in(stage%measure, has_inertia(stage%kind), touching)
            if (stage%rho_inf >= 0.0_wp) cycle
            stage%rho_inf = SMOOTH
            if (has_inertia(stage%kind) .and. touching) stage%rho_inf = OPENING
            ! What the steps of a flow do not resolve, and forces that nothing balances at its start, are to go at once:
            ! with rho_inf they fade as rho_inf to the power of the steps.
            if (is_flow(stage%kind)) stage%rho_inf = OPENING
         end associate
      end do
   end subroutine choose_schemes
end module stage_builder
