! SPDX-License-Identifier: MIT
!> Solution on which a step is taken: the domain and its unknowns, the matrix, what is prescribed, the states before
!> and after, the place in the stages, and how the step is taken.
module solution
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use generalised_alpha, only: scheme_t
   use porous_domain, only: domain_t, model_state_t
   use prescribed_values, only: constraint_t
   use sparse_factors, only: sparse_t
   use sparsity_pattern, only: pattern_t
   use surface_forces, only: surface_forces_t
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: solution_t, stage_state_t, system_t, control_t, log_t
   public :: BY_FORCES, BY_RESIDUAL, BY_CORRECTION, BY_CHANGE, BY_STAGE
   public :: T_ASSEMBLY, T_FACTORISATION, T_SOLUTION, T_REST, T_MATERIAL, T_CONTACT

   ! Measures of the error that ends Newton's method, in the order of the words of &stage.
   integer, parameter :: BY_FORCES = 1       !< The errors of the fields, see convergence.
   integer, parameter :: BY_RESIDUAL = 2     !< |R|/|R_0| of all unknowns together, whatever their units, or
                                             !< |R|/|R_1| where R_1 is larger.
   integer, parameter :: BY_CORRECTION = 3   !< |dx|/|x| of the worst field.
   integer, parameter :: BY_CHANGE = 4       !< The errors of the fields against what the step changes.
   integer, parameter :: BY_STAGE = 5        !< By forces in dynamic stages with contact, by change in others.
   integer, parameter :: TIMERS = 6, T_ASSEMBLY = 1, T_FACTORISATION = 2, T_SOLUTION = 3, T_REST = 4, T_MATERIAL = 5, &
                         T_CONTACT = 6

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

   !> Limits of Newton's method.
   type :: control_t
      real(wp) :: tolerance = 1.0e-3_wp
      integer :: max_iterations = 12
      logical :: no_predictor = .false.              !< Predict no change.
      integer :: measure = BY_FORCES          !< Measure of the error that has to fall below the tolerance.
      real(wp) :: roughness = 0.0_wp          !< Tolerance of the stress integration, the largest of the regions [-].
      !> Changes of pressures that the errors of the steps hide; 0: none, as of the displacements [m, kPa].
      real(wp) :: negligible(FIELDS) = 0.0_wp
   end type control_t

   !> Log of the iterations of a step.
   type :: log_t
      integer :: outcome = 0                  !< One of the outcomes of newton_step; 0: converged.
      integer :: iterations = 0
      real(wp) :: error(FIELDS) = 0.0_wp, first_error(FIELDS) = 0.0_wp
      !> Error of the balance of water, where air is an unknown; that of p_w is no smaller.
      real(wp) :: water = 0.0_wp
      real(wp) :: reduction = 0.0_wp          !< |R| over the larger of |R_0| and |R_1|.
      real(wp) :: correction = 0.0_wp         !< |dx|/|x|, the worst field.
      real(wp) :: changed(FIELDS) = 0.0_wp    !< Largest |dx| of every field in the last correction [m, kPa].
      real(wp) :: before(FIELDS) = 0.0_wp     !< Largest |dx| of every field in the correction before it; 0: there was
                                              !< none.
      logical :: balanced = .false.           !< The residual begins and ends at the rounding of the forces.
      integer :: worst_field = 0, worst_unknown = 0
      real(wp) :: scales(FIELDS) = 0.0_wp     !< Scales that the errors are shares of [kN, m3/s].
      real(wp) :: forces(FIELDS) = 0.0_wp     !< Magnitudes of all contributions, in the norm of a field [kN, m3/s].
      integer :: rate_evaluations = 0                   !< Rate evaluations of the material.
      logical :: refused_guess = .false.      !< The first guess was refused, the step began at the unchanged state.
      real(wp) :: best_error = huge(1.0_wp)             !< Smallest error so far that was progress [-].
      integer :: since_best = 0                         !< Iterations since then.
      real(wp) :: forces_over_scale = 1.0_wp   !< Forces of the worst field over what its error is measured by.
      logical :: stagnated = .false.                    !< Accepted at what the stress integration lets Newton reach.
   end type log_t

   !> The linear system, and what is kept of it from step to step.
   type :: system_t
      type(sparse_t) :: sparse
      class(surface_forces_t), allocatable :: contacts   !< Not allocated: the model has none.
      integer, allocatable :: extra(:, :)     !< (2, pairs) unknowns that surfaces and springs have brought together so
                                              !< far, each listed both ways round.
      logical :: analysed = .false.
      logical :: reuse = .true.               !< Factors may serve later matrices.
      logical :: factored = .false.           !< There are factors worth trying.
      real(wp), allocatable :: made_of(:)     !< (entries) Values of the matrix that the factors belong to.
      logical, allocatable :: fixed(:), air(:)   !< Unknowns and air pressures that were fixed when the factors were
                                                 !< made.
      integer :: active = 0                   !< Nodes in contact when the factors were made.
      real(wp) :: largest(FIELDS) = 0.0_wp    !< Largest scale of every field so far.
      real(wp) :: rounding(FIELDS) = 0.0_wp   !< Least scale of the present step, see convergence.
      real(wp) :: first_error = 0.0_wp        !< Error of the last step after its first correction, see convergence.
      real(wp), allocatable :: reaction(:)    !< Residual with the constrained rows kept.
      real(wp) :: seconds(TIMERS) = 0.0_wp    !< Wall time, by T_...
      integer :: n_pass = 0
   end type system_t

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
