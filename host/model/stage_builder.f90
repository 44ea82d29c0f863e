!> Stages of a scene, their words translated.
module stage_builder
   use convergence, only: BY_FORCES, BY_RESIDUAL, BY_CORRECTION
   use generalised_alpha, only: STATIC, QUASI_STATIC, DYNAMIC
   use model_types, only: stage_t
   use scene_types, only: scene_stage_t
   implicit none (type, external)
   private
   public :: stage_of

   ! Of the words of &stage analysis and measure.
   integer, parameter :: KIND_OF(*) = [STATIC, QUASI_STATIC, DYNAMIC]
   integer, parameter :: MEASURE_OF(*) = [BY_FORCES, BY_RESIDUAL, BY_CORRECTION]
contains
   pure function stage_of(given) result(stage)
      type(scene_stage_t), intent(in) :: given
      type(stage_t) :: stage

      stage%scene_stage_t = given
      stage%derived = given%analysis == 0
      ! A derived stage begins as the general one.
      stage%kind = DYNAMIC
      if (.not. stage%derived) stage%kind = KIND_OF(given%analysis)
      stage%measure = MEASURE_OF(given%measure_number)
   end function stage_of
end module stage_builder
