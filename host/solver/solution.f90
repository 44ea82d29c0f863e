! SPDX-License-Identifier: MIT
!> Solution on which a step is taken: the domain and its unknowns, the matrix, what is prescribed, the states before
!> and after, the place in the stages, and how the step is taken.
module solution
   use kinds, only: wp
   use convergence, only: control_t, log_t
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use generalised_alpha, only: scheme_t
   use linear_system, only: system_t
   use porous_domain, only: domain_t, model_state_t
   use prescribed_values, only: constraint_t
   use sparsity_pattern, only: pattern_t
   implicit none (type, external)
   private
   public :: solution_t, stage_state_t

   !> Place in the stages, and the step size.
   type :: stage_state_t
      integer :: stage = 0                     !< Number of the stage under way; 0: before the first.
      integer :: step = 0                      !< Steps done in it.
      integer :: cuts = 0, good = 0            !< Cuts in force; accepted steps since the last cut or growth.
      real(wp) :: t_start = 0.0_wp             !< Time at its start [s].
      real(wp) :: nominal = 0.0_wp             !< Step without cuts [s].
      real(wp) :: factor = 1.0_wp              !< Share of it after cuts.
      real(wp), allocatable :: x_start(:, :)   !< Unknowns at its start, which some boundaries hold.
      !> (unknowns) What acted at once at the start and is applied evenly over the stage; not allocated: nothing [kN].
      real(wp), allocatable :: sudden(:)
   end type stage_state_t

   type :: solution_t
      type(domain_t), pointer :: domain => null()   !< Domain of the model; steps change the tolerance of its laws.
      type(dofs_t), pointer :: dofs => null()       !< Unknowns of the model.
      type(pattern_t) :: pattern               !< Pattern of the matrix; it grows with the contacts.
      type(assembly_t) :: assembly
      type(system_t) :: system
      type(constraint_t) :: constraint
      type(model_state_t) :: state, next             !< Before and after the step under way.
      type(stage_state_t) :: at
      ! The step under way, or the last one.
      type(scheme_t) :: scheme                 !< It has the length of the step, or of the attempt.
      type(control_t) :: newton                !< Limits of Newton's method.
      type(log_t) :: log                       !< Log of Newton's method.
   contains
      procedure :: choose
   end type solution_t
contains
   !> Holds or frees unknowns after an iteration of Newton's method. Here all stay as they are.
   subroutine choose(self, residual, changed)
      class(solution_t), intent(inout) :: self
      real(wp), intent(in) :: residual(:)   !< (unknowns) With minus sign and all rows kept [kN, m3/s].
      logical, intent(out) :: changed       !< An unknown was held or freed.

      changed = .false.
   end subroutine choose
end module solution
