! SPDX-License-Identifier: MIT
!> Forces that surfaces exert on each other or on rigid bodies, as the solver and the steps know them: they depend on
!> the displacements alone and bring unknowns together that no element joins. A model without them has no object.
module surface_forces
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use sparsity_pattern, only: pattern_t
   implicit none (type, external)
   private
   public :: surface_forces_t

   type, abstract :: surface_forces_t
      ! Outcome of the last evaluation.
      integer :: active = 0              !< Nodes that are in contact.
      logical :: unsettled = .false.     !< Part of what the iterate asks for is held back: it is no solution yet.
      real(wp) :: rounding = 0.0_wp      !< Rounding of small differences of large displacements, times stiffness [kN].
   contains
      procedure(act_i), deferred :: act
      procedure(evaluate_i), deferred :: evaluate
      procedure(missing_i), deferred :: missing
      procedure(add_i), deferred :: add
      procedure(message_i), deferred :: message
      procedure(forces_i), deferred :: forces
      procedure(find_closed_i), deferred :: find_closed
      procedure(stretch_i), deferred :: stretch
   end type surface_forces_t

   abstract interface
      !> Sets which contacts of the model act from now on; what is tied always does.
      subroutine act_i(self, acts)
         import :: surface_forces_t
         class(surface_forces_t), intent(inout) :: self
         logical, intent(in) :: acts(:)   !< (contacts)
      end subroutine act_i

      !> Evaluates forces, and their slopes if they are wanted; false where the displacements are refused. Forces may
      !> depend on the evaluations before the last correction of the step.
      logical function evaluate_i(self, x, corrections, with_slopes) result(good)
         import :: surface_forces_t, wp
         class(surface_forces_t), intent(inout) :: self
         real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) At the level l_f; displacements first [m].
         integer, intent(in) :: corrections   !< Corrections of Newton's method that the step has had.
         logical, intent(in) :: with_slopes
      end function evaluate_i

      !> Pairs of unknowns of the slopes of the last evaluation that a pattern has no place for. (2, pairs)
      function missing_i(self, pattern) result(pairs)
         import :: surface_forces_t, pattern_t
         class(surface_forces_t), intent(in) :: self
         type(pattern_t), intent(in) :: pattern
         integer, allocatable :: pairs(:, :)
      end function missing_i

      !> Adds the last evaluation; `share` is the slope of the evaluated displacements against the new ones.
      subroutine add_i(self, pattern, share, with_slopes, residual, scale, values)
         import :: surface_forces_t, pattern_t, wp
         class(surface_forces_t), intent(in) :: self
         type(pattern_t), intent(in) :: pattern
         real(wp), intent(in) :: share   !< l_f [-]
         logical, intent(in) :: with_slopes
         real(wp), intent(inout) :: residual(:), scale(:), values(:)   !< (unknowns) [kN], twice; (entries).
      end subroutine add_i

      !> Says why the last displacements were refused.
      function message_i(self) result(text)
         import :: surface_forces_t
         class(surface_forces_t), intent(in) :: self
         character(:), allocatable :: text
      end function message_i

      !> Finds the forces at given displacements, to be added to the internal ones; false where these are refused. The
      !> outcome of the last evaluation stays.
      logical function forces_i(self, dofs, x, force) result(good)
         import :: surface_forces_t, dofs_t, wp
         class(surface_forces_t), intent(inout) :: self
         type(dofs_t), intent(in) :: dofs
         real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
         real(wp), allocatable, intent(out) :: force(:)   !< Force on every unknown [kN]. (unknowns)
      end function forces_i

      !> Finds the contacts of the model that are closed at given displacements; none where these are refused. The
      !> outcome of the last evaluation stays.
      subroutine find_closed_i(self, x, closed)
         import :: surface_forces_t, wp
         class(surface_forces_t), intent(inout) :: self
         real(wp), intent(in) :: x(:, :)      !< (FIELDS, nodes) Displacements first [m].
         logical, intent(out) :: closed(:)    !< (contacts)
      end subroutine find_closed_i

      !> Distances of tied nodes from their places on plates, which pull; 0 elsewhere [m].
      subroutine stretch_i(self, x, stretched)
         import :: surface_forces_t, wp
         class(surface_forces_t), intent(in) :: self
         real(wp), intent(in) :: x(:, :)             !< (FIELDS, nodes) Displacements first [m].
         real(wp), intent(out) :: stretched(:, :)    !< (DISPLACEMENTS, nodes)
      end subroutine stretch_i
   end interface
end module surface_forces
