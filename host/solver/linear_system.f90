! SPDX-License-Identifier: MIT
!> The linear system of an iteration: contacts in its pattern, factors that are kept while they serve, and where the
!> time goes. docs/theory/host.md section 6.
module linear_system
   use kinds, only: wp
   use wall_clock, only: clock, add_elapsed
   use convergence, only: field_scales, water_scale, water_of, body_scale, is_body
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use prescribed_values, only: constraint_t
   use sparse_factors, only: sparse_t, analyse, factorise, solve_by_factors, SOLVED, INACCURATE
   use sparsity_pattern, only: pattern_t, make_pattern
   use surface_forces, only: surface_forces_t
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_W
   implicit none (type, external)
   private
   public :: system_t, solve_step, asked_for, update_contacts, join_unknowns, MOST_STEPS
   public :: T_ASSEMBLY, T_FACTORISATION, T_SOLUTION, T_REST, T_MATERIAL, T_CONTACT

   integer, parameter :: TIMERS = 6, T_ASSEMBLY = 1, T_FACTORISATION = 2, T_SOLUTION = 3, T_REST = 4, T_MATERIAL = 5, &
                         T_CONTACT = 6
   !> [kN] or [m3/s]: a field in which nothing acts yet is not refined to less.
   real(wp), parameter :: LEAST_SCALE = 1.0e-12_wp
   integer, parameter :: MOST_STEPS = 6               !< Most steps of a solution with factors of an earlier matrix.
   integer, parameter :: WORN_STEPS = 5               !< After so many steps the next matrix is factorised again.

   type :: system_t
      type(sparse_t) :: sparse
      class(surface_forces_t), allocatable :: contacts   !< Not allocated: the model has none.
      integer, allocatable :: extra(:, :)     !< (2, pairs) unknowns that surfaces and springs have brought together so
                                              !< far, each listed both ways round.
      logical :: analysed = .false.
      logical :: reuse = .true.               !< Factors may serve later matrices.
      logical :: factored = .false.           !< There are factors worth trying.
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
contains
   !> Solves to a tolerance, a small share of Newton's: by the factors of an earlier matrix as long as these serve and
   !> nothing has been fixed, released or come into contact, otherwise by new ones. docs/theory/host.md section 6.
   !> status: SOLVED; SINGULAR or FAILED as of factorise; NOT_FINITE as of solve_by_factors.
   subroutine solve_step(dofs, pattern, constraint, assembly, tolerance, rhs, system, dx, status)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(constraint_t), intent(in) :: constraint
      type(assembly_t), intent(in) :: assembly
      real(wp), intent(in) :: tolerance   !< Tolerance of the errors of the fields [-]; 0: what rounding leaves.
      real(wp), intent(in) :: rhs(:)   !< (unknowns) [kN, m3/s]
      type(system_t), intent(inout) :: system
      real(wp), intent(out) :: dx(:)   !< (unknowns) [m, kPa]
      integer, intent(out) :: status
      real(wp) :: weight(dofs%n), scales(FIELDS), t0
      integer :: steps, active, i

      t0 = clock()
      scales = max(field_scales(dofs, constraint, assembly, system%largest), LEAST_SCALE)
      ! What a step changes is not known before its first solution: the forces that it asks for tell.
      if (assembly%with_change) scales = max(scales, asked_for(dofs, rhs))
      if (allocated(assembly%water)) scales(AT_P_W:) = min(scales(AT_P_W:), max(LEAST_SCALE, &
         water_scale(dofs, constraint, assembly, system%largest), norm2(water_of(dofs, constraint%air, rhs))))
      weight = 1/scales(dofs%field)
      do i = 1, dofs%n
         if (is_body(constraint, i)) weight(i) = 1/max(body_scale(constraint, assembly, system%largest, i), LEAST_SCALE)
      end do
      active = 0
      if (allocated(system%contacts)) active = system%contacts%active
      if (system%factored) system%factored = system%reuse .and. active == system%active &
         .and. all(constraint%fixed .eqv. system%fixed) .and. all(constraint%air .eqv. system%air)
      if (system%factored) then
         call solve_by_factors(system%sparse, assembly%values, rhs, weight, tolerance, MOST_STEPS, dx, &
                               steps, status)
         call add_elapsed(system%seconds(T_SOLUTION), t0)
         system%factored = status == SOLVED .and. steps < WORN_STEPS
         if (status == SOLVED) return
      end if
      if (.not. system%analysed) then
         call analyse(system%sparse, pattern%row, pattern%col, status)
         system%analysed = .true.
      end if
      call factorise(system%sparse, assembly%values, status)
      call add_elapsed(system%seconds(T_FACTORISATION), t0)
      system%factored = status == SOLVED
      if (status /= SOLVED) return
      system%fixed = constraint%fixed
      system%air = constraint%air
      system%active = active
      call solve_by_factors(system%sparse, assembly%values, rhs, weight, tolerance, MOST_STEPS, dx, &
                            steps, status)
      ! What rounding leaves is Newton's to judge.
      if (status == INACCURATE) status = SOLVED
      call add_elapsed(system%seconds(T_SOLUTION), t0)
   end subroutine solve_step

   !> Finds the magnitude of the right side of every field, rows of prescribed values included; that of the
   !> displacements is one. docs/theory/host.md section 5.1.
   pure function asked_for(dofs, rhs) result(magnitude)
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: rhs(:)   !< (unknowns) [kN, m3/s]
      real(wp) :: magnitude(FIELDS)
      integer :: f

      do f = 1, FIELDS
         magnitude(f) = norm2(pack(rhs, dofs%field == f))
      end do
      magnitude(:DISPLACEMENTS) = norm2(magnitude(:DISPLACEMENTS))
   end function asked_for

   !> Contacts at given displacements, and room for them in the matrix; false if they refuse these. The pattern grows
   !> only: a contact that opens leaves it alone.
   logical function update_contacts(system, dofs, pattern, x, corrections, slopes, assembly) result(good)
      type(system_t), intent(inout) :: system
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(inout) :: pattern
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) [m, kPa]
      integer, intent(in) :: corrections   !< Corrections that the step has had.
      logical, intent(in) :: slopes
      type(assembly_t), intent(inout) :: assembly
      integer, allocatable :: missing(:, :)

      good = .true.
      if (.not. allocated(system%contacts)) return
      good = system%contacts%evaluate(x, corrections, slopes)
      if (.not. good .or. .not. slopes) return
      missing = system%contacts%missing(pattern)
      if (size(missing) > 0) call join_unknowns(dofs, missing, system, pattern, assembly)
   end function update_contacts

   !> Makes room in the matrix for pairs of unknowns that meet from now on.
   subroutine join_unknowns(dofs, pairs, system, pattern, assembly)
      type(dofs_t), intent(in) :: dofs
      integer, intent(in) :: pairs(:, :)   !< (2, pairs), each listed one way round.
      type(system_t), intent(inout) :: system
      type(pattern_t), intent(inout) :: pattern
      type(assembly_t), intent(inout) :: assembly

      if (.not. allocated(system%extra)) allocate (system%extra(2, 0))
      system%extra = reshape([system%extra, pairs, pairs(2:1:-1, :)], [2, size(system%extra, 2) + 2*size(pairs, 2)])
      call make_pattern(dofs%n, dofs%element, system%extra, pattern)
      if (allocated(assembly%values)) deallocate (assembly%values)
      allocate (assembly%values(size(pattern%col)), source=0.0_wp)
      system%analysed = .false.
      system%factored = .false.
   end subroutine join_unknowns
end module linear_system
