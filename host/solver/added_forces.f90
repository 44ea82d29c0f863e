! SPDX-License-Identifier: MIT
!> Forces that a term adds to the equations by a law of its own, beside elements and surfaces. A model without them has
!> none. Forces in proportion to values or rates are linear_forces.
module added_forces
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use generalised_alpha, only: scheme_t
   use porous_domain, only: model_state_t
   use sparsity_pattern, only: pattern_t
   implicit none (type, external)
   private
   public :: added_forces_t, added_box_t

   type, abstract :: added_forces_t
      logical :: acts = .false.   !< The forces act in the step under way.
   contains
      procedure(add_i), deferred :: add
      procedure(add_means_i), deferred :: add_means
   end type added_forces_t

   !> An element of a list of forces.
   type :: added_box_t
      class(added_forces_t), allocatable :: it
   end type added_box_t

   abstract interface
      !> Adds the forces at the levels of a scheme to residual, scale and change [kN], and the slopes, if they are
      !> wanted, to the matrix, whose pattern must have their places.
      subroutine add_i(self, dofs, pattern, scheme, old, new, slopes, assembly)
         import :: added_forces_t, dofs_t, pattern_t, scheme_t, model_state_t, assembly_t
         class(added_forces_t), intent(in) :: self
         type(dofs_t), intent(in) :: dofs
         type(pattern_t), intent(in) :: pattern
         type(scheme_t), intent(in) :: scheme
         type(model_state_t), intent(in) :: old, new
         logical, intent(in) :: slopes
         type(assembly_t), intent(inout) :: assembly
      end subroutine add_i

      !> Adds the means of the forces at both ends of a step, for the balance of energy.
      subroutine add_means_i(self, dofs, scheme, old, new, force)
         import :: added_forces_t, dofs_t, scheme_t, model_state_t, wp
         class(added_forces_t), intent(in) :: self
         type(dofs_t), intent(in) :: dofs
         type(scheme_t), intent(in) :: scheme
         type(model_state_t), intent(in) :: old, new
         real(wp), intent(inout) :: force(:)   !< (unknowns) [kN]
      end subroutine add_means_i
   end interface
end module added_forces
