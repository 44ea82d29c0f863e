! SPDX-License-Identifier: MIT
!> Supports that move a body, and their forces, which are answers of a scene. docs/theory/host.md section 11.
module moving_supports
   use kinds, only: wp
   use boundary_conditions, only: prescribing_fixes, forces_of_supports
   use model_types, only: model_t
   use run_state, only: run_t
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: find_moving, forces_of_moving

   character(7), parameter :: FORCES(DISPLACEMENTS) = ['force_r', 'force_z']
contains
   !> Supports that move a body: where a displacement is prescribed, the answer is the force.
   pure subroutine find_moving(model, moving, names)
      type(model_t), intent(in) :: model
      integer, allocatable, intent(out) :: moving(:)          !< Places in model%fixes.
      character(72), allocatable, intent(out) :: names(:)     !< As the columns of reactions_STAGE.csv.
      integer :: i

      allocate (moving(0))
      do i = 1, size(model%fixes)
         associate (fix => model%fixes(i))
            if (fix%field > DISPLACEMENTS .or. fix%acceleration .or. fix%turns) cycle
            if (abs(fix%value) + abs(fix%value_slope) <= 0.0_wp) cycle
            ! One answer, though several stages move it.
            if (any(model%fixes(moving)%group == fix%group .and. model%fixes(moving)%field == fix%field)) cycle
            moving = [moving, i]
         end associate
      end do
      allocate (names(size(moving)))
      do i = 1, size(moving)
         associate (fix => model%fixes(moving(i)))
            names(i) = trim(model%domain%mesh%groups(fix%group)%name)//'.'//trim(FORCES(fix%field))
         end associate
      end do
   end subroutine find_moving

   !> Their forces at the end of a step [kN], as in the columns of their names.
   function forces_of_moving(model, run, moving) result(force)
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      integer, intent(in) :: moving(:)   !< Of find_moving.
      real(wp) :: force(size(moving))
      real(wp) :: all(DISPLACEMENTS, size(model%domain%mesh%groups))
      integer :: by(model%dofs%n), air_by(size(model%domain%mesh%x, 2)), i

      call prescribing_fixes(model, model%stages(run%at%stage), model%dofs, run%drainage, run%state%time, by, air_by)
      all = forces_of_supports(model, by, run%system%reaction)
      do i = 1, size(moving)
         force(i) = all(model%fixes(moving(i))%field, model%fixes(moving(i))%group)
      end do
   end function forces_of_moving
end module moving_supports
