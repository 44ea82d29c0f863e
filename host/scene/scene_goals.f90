! SPDX-License-Identifier: MIT
!> Which answers are the goals of a scene: those that its accuracy is for.
module scene_goals
   use faults, only: fault_t, raise, EXIT_INPUT
   use scene_types, only: scene_t
   use unknown_fields, only: FIELDS, FIELD_NAMES
   implicit none (type, external)
   private
   public :: is_goal, check_goals

   character(*), parameter :: STAGE_ENDS = ': '   !< In names of answers as "impact: plate.force_z".
contains
   !> Whether an answer is a goal; where none is named displacements and pressures are. The stage of a force need not be
   !> named.
   pure logical function is_goal(goals, answer, force)
      character(*), intent(in) :: goals(:), answer
      logical, intent(in) :: force   !< The answer is the force of a support or a thrust.

      is_goal = .not. force
      if (size(goals) > 0) is_goal = any(goals == answer) .or. any(goals == of_any_stage(answer))
   end function is_goal

   pure function of_any_stage(answer) result(name)
      character(*), intent(in) :: answer
      character(:), allocatable :: name
      integer :: at

      at = index(answer, STAGE_ENDS)
      name = answer
      if (at > 0) name = answer(at + len(STAGE_ENDS):)
   end function of_any_stage

   !> Fault EXIT_INPUT: a goal is neither an unknown of a named point nor has the name of a force.
   subroutine check_goals(scene, fault)
      type(scene_t), intent(in) :: scene
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: FORCES(3) = [character(8) :: '.force_r', '.force_z', '.thrust']
      character(:), allocatable :: goal
      integer :: g, i, f
      logical :: known

      do g = 1, size(scene%goals)
         goal = trim(scene%goals(g))
         known = .false.
         do i = 1, size(FORCES)
            known = known .or. index(goal, trim(FORCES(i)), back=.true.) > 1
         end do
         do i = 1, size(scene%points)
            do f = 1, FIELDS
               known = known .or. goal == trim(scene%points(i)%name)//'.'//trim(FIELD_NAMES(f))
            end do
         end do
         if (.not. known) call raise(fault, EXIT_INPUT, trim(scene%file)//': goals: there is no answer '''//goal// &
            '''; answers are POINT.FIELD of a named &point with u_r, u_z, p_w or p_c, as ''top.u_z'', forces '// &
            'GROUP.force_r and GROUP.force_z of supports, and CONTACT.thrust.')
      end do
   end subroutine check_goals
end module scene_goals
