! SPDX-License-Identifier: MIT
!> Stages of a scene, their words translated, and the time integration that holds where the scene leaves it open.
module stage_builder
   use kinds, only: wp
   use convergence, only: BY_FORCES, BY_RESIDUAL, BY_CORRECTION, BY_CHANGE, BY_STAGE, measure_in
   use generalised_alpha, only: STATIC, QUASI_STATIC, DYNAMIC
   use model_types, only: model_t, stage_t
   use scene_types, only: scene_stage_t, acts_in
   implicit none (type, external)
   private
   public :: build_stage, choose_schemes

   ! Of the words of &stage analysis and measure.
   integer, parameter :: KIND_OF(*) = [STATIC, QUASI_STATIC, DYNAMIC]
   integer, parameter :: MEASURE_OF(*) = [BY_FORCES, BY_RESIDUAL, BY_CORRECTION, BY_CHANGE, BY_STAGE]
   real(wp), parameter :: SMOOTH = 0.8_wp     !< rho_inf of a stage without contact.
   real(wp), parameter :: OPENING = 0.0_wp    !< With contact: no energy is gained where a penalty opens and closes
                                              !< (docs/theory/host.md section 4.1).
contains
   !> A subroutine, because gfortran 12 loses what a function result in a list of values has allocated.
   pure subroutine build_stage(given, stage)
      type(scene_stage_t), intent(in) :: given
      type(stage_t), intent(out) :: stage

      stage%scene_stage_t = given
      stage%kind = KIND_OF(given%analysis)
      stage%measure = MEASURE_OF(given%measure_number)
   end subroutine build_stage

   !> rho_inf and the measure of Newton's error of the stages that the scene leaves them open in. docs/theory/host.md
   !> sections 4.1, 5.1 and, of quasi-static stages, 11.
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
            stage%measure = measure_in(stage%measure, stage%kind, touching)
            if (stage%rho_inf >= 0.0_wp) cycle
            stage%rho_inf = SMOOTH
            if (stage%kind == DYNAMIC .and. touching) stage%rho_inf = OPENING
            ! What the steps of a flow do not resolve, and forces that nothing balances at its start, are to go at once:
            ! with rho_inf they fade as rho_inf to the power of the steps.
            if (stage%kind == QUASI_STATIC) stage%rho_inf = OPENING
         end associate
      end do
   end subroutine choose_schemes
end module stage_builder
