!> One time step by Newton-Raphson with the exact tangent. One linear solve is one iteration; the error of a field is
!> |R_f| over the largest of |sum of the magnitudes of the elements' contributions|, 1e-6 of its largest value so far,
!> and a floor, over the free unknowns; a rigid body counts by itself too. The floor of a volume balance is 1e-4 of the
!> strain rates and of the parts of the fluxes in it: where nothing flows, or nothing can, the balance of every element
!> is nothing but rounding.
!> docs/theory/host.md section 5.
module newton_step
   use wall_clock, only: clock, lap
   use unknown_fields, only: FIELDS
   use kinds, only: wp
   use equation_assembly, only: assembly_t, assemble
   use contact_interfaces, only: contacts_t, evaluate_contacts, fit_pattern, add_contacts
   use degrees_of_freedom, only: dofs_t
   use porous_domain, only: domain_t, state_t
   use sparsity_pattern, only: pattern_t, place_of
   use conjugate_residuals, only: solve_by_factors, INACCURATE
   use sparse_factors, only: sparse_t, analyse, factorise, SOLVED, SINGULAR
   use generalised_alpha, only: scheme_t, predict, advance_rates, DYNAMIC
   implicit none (type, external)
   private
   public :: constraint_t, control_t, log_t, system_t, take_step, start_accelerations
   public :: BY_FORCES, BY_RESIDUAL, BY_CORRECTION
   public :: T_ASSEMBLY, T_FACTORISATION, T_SOLUTION, T_REST, T_MATERIAL, T_CONTACT
   public :: CONVERGED, NOT_CONVERGED, MATERIAL_FAILED, BODY_FREE, SOLVER_FAILED, CONTACT_FAILED

   integer, parameter :: CONVERGED = 0, NOT_CONVERGED = 1, MATERIAL_FAILED = 2, BODY_FREE = 3, SOLVER_FAILED = 4, &
                         CONTACT_FAILED = 5
   integer, parameter :: BY_FORCES = 1       !< The errors of the fields, see above;
   integer, parameter :: BY_RESIDUAL = 2     !< |R|/|R_0| of all unknowns together, whatever their units,
                                             !< or |R|/|R_1| where R_1 is larger;
   integer, parameter :: BY_CORRECTION = 3   !< |dx|/|x| of the worst field.
   integer, parameter :: TIMERS = 6, T_ASSEMBLY = 1, T_FACTORISATION = 2, T_SOLUTION = 3, T_REST = 4, T_MATERIAL = 5, &
                         T_CONTACT = 6
   real(wp), parameter :: HISTORY_SHARE = 1.0e-6_wp   !< Share of the largest scale so far that still counts.
   real(wp), parameter :: RATE_SHARE = 1.0e-4_wp      !< Of strain rates and parts of fluxes, see above.
   real(wp), parameter :: ROUNDING = 1.0e-12_wp       !< Of all contributions: no residual to begin with is smaller.
   real(wp), parameter :: ABSOLUTE_FLOOR = 1.0e-12_wp   !< [kN] or [m3/s]: nothing smaller is a force.
   real(wp), parameter :: LINEAR_SHARE = 1.0e-5_wp    !< Share of Newton's tolerance left to the linear solution.
   integer, parameter :: MOST_STEPS = 6               !< Of the linear solution with factors of an earlier matrix;
   integer, parameter :: WORN_STEPS = 5               !< after so many the next matrix is factorised again.
   real(wp), parameter :: HOPELESS = 1.0e10_wp        !< Error beyond which no further iteration helps.

   !> Prescribed unknowns and loads of a step.
   type :: constraint_t
      logical, allocatable :: fixed(:)        !< Unknowns
      real(wp), allocatable :: target(:)      !< their values at the end of the step
      logical, allocatable :: air(:)          !< Nodes with a prescribed air pressure
      real(wp), allocatable :: air_target(:)
      real(wp), allocatable :: load_0(:), load_1(:)   !< Loads before and after.
      real(wp), allocatable :: offset(:)      !< Flow of the initial state that is subtracted.
      real(wp), allocatable :: mass(:)        !< Of rigid bodies [Mg].
   end type constraint_t

   type :: control_t
      real(wp) :: tolerance = 1.0e-3_wp
      integer :: max_iterations = 12
      logical :: no_predictor = .false.              !< Predict no change.
      integer :: measure = BY_FORCES          !< What has to fall below the tolerance.
   end type control_t

   !> What a step did.
   type :: log_t
      integer :: outcome = CONVERGED
      integer :: iterations = 0
      real(wp) :: error(FIELDS) = 0.0_wp, first_error(FIELDS) = 0.0_wp
      real(wp) :: reduction = 0.0_wp          !< |R| over the larger of |R_0| and |R_1|.
      real(wp) :: correction = 0.0_wp         !< |dx|/|x|, the worst field.
      integer :: worst_field = 0, worst_unknown = 0
      integer :: rate_evaluations = 0                   !< Rate evaluations of the material.
   end type log_t

   type :: system_t
      type(sparse_t) :: sparse
      type(contacts_t) :: contacts
      logical :: analysed = .false.
      logical :: reuse = .true.               !< Factors may serve later matrices.
      logical :: factored = .false.           !< There are factors worth trying.
      logical, allocatable :: fixed(:), air(:)   !< What was fixed when they were made,
      integer :: active = 0                   !< and how many nodes were in contact.
      logical :: reassemble_tangent = .false.    !< In every iteration: the last step needed several.
      real(wp) :: largest(FIELDS) = 0.0_wp    !< Largest scale of every field so far.
      real(wp), allocatable :: reaction(:)    !< Residual with the constrained rows kept.
      real(wp) :: seconds(TIMERS) = 0.0_wp    !< Wall time, by T_...
      integer :: n_pass = 0
   end type system_t
contains
   !> From `old` to `new` over scheme%dt; `new` is of use only after CONVERGED.
   subroutine take_step(domain, dofs, pattern, scheme, constraint, control, old, new, assembly, system, log)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(inout) :: pattern   !< Grows with the contacts.
      type(scheme_t), intent(in) :: scheme
      type(constraint_t), intent(in) :: constraint
      type(control_t), intent(in) :: control
      type(state_t), intent(in) :: old
      type(state_t), intent(inout) :: new
      type(assembly_t), intent(inout) :: assembly
      type(system_t), intent(inout) :: system
      type(log_t), intent(out) :: log
      real(wp), allocatable :: rhs(:), dx(:)
      real(wp) :: norm, norm_0, t0
      integer :: status
      logical :: with_slope

      t0 = clock()
      allocate (rhs(dofs%n), dx(dofs%n))
      new%time = old%time + scheme%dt
      assembly%air = constraint%air
      call predict(scheme, control%no_predictor, old%x, old%v, old%a, new%x)
      call advance_rates(scheme, old%x, old%v, old%a, new%x, new%v, new%a)
      norm_0 = -1.0_wp
      with_slope = .true.
      do
         if (.not. pass(with_slope)) return
         if (log%iterations > 0) then
            call measure(dofs, constraint, assembly, rhs, system%largest, log)
            if (log%iterations == 1) log%first_error = log%error
            norm = norm2(pack(rhs, .not. constraint%fixed))
            ! Driven by prescribed values alone, a step begins without any to speak of.
            if (log%iterations == 1) norm_0 = max(norm_0, norm, ROUNDING*norm2(assembly%scale))
            log%reduction = norm/max(norm_0, tiny(1.0_wp))
            if (good_enough(control, log)) exit
            if (log%iterations >= control%max_iterations .or. .not. all(log%error < HOPELESS)) then
               log%outcome = NOT_CONVERGED
               system%reassemble_tangent = .true.
               return
            end if
            ! The slopes at the present values, where the last pass left them out.
            if (.not. with_slope) then
               if (.not. pass(.true.)) return
            end if
         else
            norm_0 = norm2(pack(rhs, .not. constraint%fixed))
         end if
         call constrain(dofs, pattern, constraint, new%x, assembly%values, rhs)
         ! Other measures may ask for more than a linear solution that is exact to a share of the forces.
         if (control%measure /= BY_FORCES) system%factored = .false.
         call solve_step(dofs, pattern, constraint, assembly, merge(control%tolerance, 0.0_wp, &
                         control%measure == BY_FORCES), rhs, system, dx, status)
         if (status /= SOLVED) then
            log%outcome = merge(BODY_FREE, SOLVER_FAILED, status == SINGULAR)
            return
         end if
         t0 = clock()
         log%iterations = log%iterations + 1
         call add_correction(dofs, dx, new%x, log%correction)
         call advance_rates(scheme, old%x, old%v, old%a, new%x, new%v, new%a)
         with_slope = system%reassemble_tangent
      end do
      system%reassemble_tangent = log%iterations > 1
      call lap(system%seconds(T_REST), t0)
   contains
      !> Residual, with minus sign in rhs, and slopes; false if the material refuses.
      logical function pass(slopes)
         logical, intent(in) :: slopes
         real(wp) :: spent

         spent = 0.0_wp
         call lap(system%seconds(T_REST), t0)
         pass = look_at_contacts(system, dofs, pattern, old%x + scheme%l_f*(new%x - old%x), slopes, assembly)
         if (.not. pass) log%outcome = CONTACT_FAILED
         if (.not. pass) return
         call lap(system%seconds(T_CONTACT), t0)
         call assemble(domain, dofs, pattern, scheme, old, new, slopes, assembly)
         system%n_pass = system%n_pass + 1
         log%rate_evaluations = log%rate_evaluations + assembly%rate_evaluations
         pass = assembly%bad_element == 0
         call lap(spent, t0)
         system%seconds(T_MATERIAL) = system%seconds(T_MATERIAL) + spent*assembly%material
         system%seconds(T_ASSEMBLY) = system%seconds(T_ASSEMBLY) + spent*(1 - assembly%material)
         if (.not. pass) then
            log%outcome = MATERIAL_FAILED
            return
         end if
         call add_bodies(dofs, pattern, scheme, constraint, old, new, slopes, assembly)
         if (allocated(system%contacts%interfaces)) then
            call lap(system%seconds(T_REST), t0)
            call add_contacts(system%contacts, pattern, scheme%l_f, slopes, assembly%residual, assembly%scale, &
                              assembly%values)
            call lap(system%seconds(T_CONTACT), t0)
         end if
         rhs = constraint%load_0 + scheme%l_f*(constraint%load_1 - constraint%load_0) - constraint%offset
         call loads_of_water(dofs, constraint%air, rhs)
         assembly%scale = assembly%scale + abs(rhs)
         rhs = rhs - assembly%residual
         system%reaction = -rhs
      end function pass
   end subroutine take_step

   !> Whether the iteration may end.
   pure logical function good_enough(control, log)
      type(control_t), intent(in) :: control
      type(log_t), intent(in) :: log

      select case (control%measure)
      case (BY_RESIDUAL)
         good_enough = log%reduction < control%tolerance
      case (BY_CORRECTION)
         good_enough = log%correction < control%tolerance
      case default
         good_enough = all(log%error < control%tolerance)
      end select
   end function good_enough

   !> Solution to a small share of Newton's tolerance: by the factors of an earlier matrix as long as these serve and
   !> nothing has come to be fixed, let go or touched, else by new ones.
   subroutine solve_step(dofs, pattern, constraint, assembly, tolerance, rhs, system, dx, status)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(constraint_t), intent(in) :: constraint
      type(assembly_t), intent(in) :: assembly
      real(wp), intent(in) :: tolerance
      real(wp), intent(in) :: rhs(:)
      type(system_t), intent(inout) :: system
      real(wp), intent(out) :: dx(:)
      integer, intent(out) :: status
      real(wp) :: weight(dofs%n), scales(FIELDS), t0
      integer :: steps, active, i

      t0 = clock()
      scales = field_scales(dofs, constraint, assembly, system%largest)
      weight = 1/scales(dofs%field)
      do i = 1, dofs%n
         if (is_body(constraint, i)) weight(i) = 1/body_scale(assembly, system%largest, i)
      end do
      active = 0
      if (allocated(system%contacts%interfaces)) active = sum(system%contacts%interfaces%active)
      if (system%factored) system%factored = system%reuse .and. active == system%active &
         .and. all(constraint%fixed .eqv. system%fixed) .and. all(constraint%air .eqv. system%air)
      if (system%factored) then
         call solve_by_factors(system%sparse, assembly%values, rhs, weight, LINEAR_SHARE*tolerance, MOST_STEPS, dx, &
                               steps, status)
         call lap(system%seconds(T_SOLUTION), t0)
         system%factored = status == SOLVED .and. steps < WORN_STEPS
         if (status == SOLVED) return
      end if
      if (.not. system%analysed) then
         call analyse(system%sparse, pattern%row, pattern%col, status)
         system%analysed = .true.
      end if
      call factorise(system%sparse, assembly%values, status)
      call lap(system%seconds(T_FACTORISATION), t0)
      system%factored = status == SOLVED
      if (status /= SOLVED) return
      system%fixed = constraint%fixed
      system%air = constraint%air
      system%active = active
      call solve_by_factors(system%sparse, assembly%values, rhs, weight, LINEAR_SHARE*tolerance, MOST_STEPS, dx, &
                            steps, status)
      ! What rounding leaves is Newton's to judge.
      if (status == INACCURATE) status = SOLVED
      call lap(system%seconds(T_SOLUTION), t0)
   end subroutine solve_step

   !> Accelerations that the loads and stresses of a state ask for, its displacements, velocities and pressures held.
   subroutine start_accelerations(domain, dofs, pattern, constraint, state, work, assembly, system, log)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(inout) :: pattern
      type(constraint_t), intent(in) :: constraint
      type(state_t), intent(inout) :: state
      type(state_t), intent(inout) :: work       !< Equal to state.
      type(assembly_t), intent(inout) :: assembly
      type(system_t), intent(inout) :: system
      type(log_t), intent(out) :: log
      type(constraint_t) :: held
      type(scheme_t) :: scheme
      real(wp), allocatable :: rhs(:), dx(:)
      integer :: status, i, f, steps

      ! Values and velocities at the old level, accelerations at the new one: the residual is linear in them.
      scheme = scheme_t(kind=DYNAMIC, l_f=0.0_wp, l_v=0.0_wp, l_a=1.0_wp, l_p=0.0_wp, c_v=0.0_wp, c_a=1.0_wp, &
                        c_p=0.0_wp)
      held = constraint
      held%fixed = constraint%fixed .or. dofs%field >= 3
      held%target = 0.0_wp
      held%air = .false.
      assembly%air = .false.
      state%a = 0.0_wp
      work%a = 0.0_wp
      allocate (rhs(dofs%n), dx(dofs%n))
      if (.not. look_at_contacts(system, dofs, pattern, state%x, .false., assembly)) then
         log%outcome = CONTACT_FAILED
         return
      end if
      call assemble(domain, dofs, pattern, scheme, state, work, .true., assembly)
      if (assembly%bad_element > 0) then
         log%outcome = MATERIAL_FAILED
         return
      end if
      call add_bodies(dofs, pattern, scheme, held, state, work, .true., assembly)
      if (allocated(system%contacts%interfaces)) call add_contacts(system%contacts, pattern, 0.0_wp, .false., &
                                                    assembly%residual, assembly%scale, assembly%values)
      rhs = held%load_0 - held%offset - assembly%residual
      call constrain(dofs, pattern, held, 0.0_wp*state%x, assembly%values, rhs)
      if (.not. system%analysed) call analyse(system%sparse, pattern%row, pattern%col, status)
      system%analysed = .true.
      call factorise(system%sparse, assembly%values, status)
      system%factored = .false.
      if (status == SOLVED) call solve_by_factors(system%sparse, assembly%values, rhs, 1 + 0*rhs, 0.0_wp, MOST_STEPS, &
                                                  dx, steps, status)
      if (status == INACCURATE) status = SOLVED
      if (status /= SOLVED) then
         log%outcome = merge(BODY_FREE, SOLVER_FAILED, status == SINGULAR)
         return
      end if
      do i = 1, size(state%a, 2)
         do f = 1, 2
            if (dofs%of(f, i) > 0) state%a(f, i) = dx(dofs%of(f, i))
         end do
      end do
      work%a = state%a
   end subroutine start_accelerations

   !> Contacts at given displacements, and room for them in the matrix; false if their kernels refuse.
   logical function look_at_contacts(system, dofs, pattern, x, slopes, assembly) result(good)
      type(system_t), intent(inout) :: system
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(inout) :: pattern
      real(wp), intent(in) :: x(:, :)
      logical, intent(in) :: slopes
      type(assembly_t), intent(inout) :: assembly
      logical :: changed

      good = .true.
      if (.not. allocated(system%contacts%interfaces)) return
      good = evaluate_contacts(system%contacts, x, slopes)
      if (.not. good .or. .not. slopes) return
      call fit_pattern(system%contacts, dofs, pattern, changed)
      if (.not. changed) return
      deallocate (assembly%values)
      allocate (assembly%values(size(pattern%col)), source=0.0_wp)
      system%analysed = .false.
      system%factored = .false.
   end function look_at_contacts

   !> Inertia of rigid bodies.
   subroutine add_bodies(dofs, pattern, scheme, constraint, old, new, slopes, assembly)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(scheme_t), intent(in) :: scheme
      type(constraint_t), intent(in) :: constraint
      type(state_t), intent(in) :: old, new
      logical, intent(in) :: slopes
      type(assembly_t), intent(inout) :: assembly
      integer :: i, f, k, place
      real(wp) :: force

      do i = 1, dofs%n
         if (.not. constraint%mass(i) > 0.0_wp) cycle
         f = dofs%field(i)
         k = dofs%node(i)
         force = constraint%mass(i)*(old%a(f, k) + scheme%l_a*(new%a(f, k) - old%a(f, k)))
         assembly%residual(i) = assembly%residual(i) + force
         assembly%scale(i) = assembly%scale(i) + abs(force)
         place = place_of(pattern, i, i)
         if (slopes) assembly%values(place) = assembly%values(place) + constraint%mass(i)*scheme%c_a
      end do
   end subroutine add_bodies

   !> Where the air pressure is prescribed the first balance is that of the water: so are its loads.
   pure subroutine loads_of_water(dofs, air, load)
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: air(:)
      real(wp), intent(inout) :: load(:)
      integer :: i

      do i = 1, size(air)
         if (air(i)) load(dofs%of(3, i)) = load(dofs%of(3, i)) - load(dofs%of(4, i))
      end do
   end subroutine loads_of_water

   !> What a residual of a field is small against; rows of prescribed unknowns do not count.
   pure function field_scales(dofs, constraint, assembly, largest) result(scales)
      type(dofs_t), intent(in) :: dofs
      type(constraint_t), intent(in) :: constraint
      type(assembly_t), intent(in) :: assembly
      real(wp), intent(in) :: largest(FIELDS)   !< That of every field so far.
      real(wp) :: scales(FIELDS)
      real(wp) :: s(FIELDS), floor(FIELDS)

      call add_scales(dofs, constraint, assembly, s, floor)
      scales = max(sqrt(s), HISTORY_SHARE*largest, sqrt(floor), ABSOLUTE_FLOOR)
   end function field_scales

   pure subroutine add_scales(dofs, constraint, assembly, s, floor)
      type(dofs_t), intent(in) :: dofs
      type(constraint_t), intent(in) :: constraint
      type(assembly_t), intent(in) :: assembly
      real(wp), intent(out) :: s(FIELDS), floor(FIELDS)
      integer :: i, f

      s = 0.0_wp
      floor = 0.0_wp
      do i = 1, dofs%n
         f = dofs%field(i)
         if (.not. counts(dofs, constraint, i)) cycle
         s(f) = s(f) + assembly%scale(i)**2
         floor(f) = floor(f) + (RATE_SHARE*assembly%floor(i))**2
      end do
      ! The displacements are one field: a component without forces is no measure of its own.
      s(1:2) = sum(s(1:2))
   end subroutine add_scales

   !> A rigid body that moves is measured by the forces on it: in the sum of its field it would be lost.
   pure logical function is_body(constraint, i)
      type(constraint_t), intent(in) :: constraint
      integer, intent(in) :: i

      is_body = constraint%mass(i) > 0.0_wp .and. .not. constraint%fixed(i)
   end function is_body

   pure real(wp) function body_scale(assembly, largest, i)
      type(assembly_t), intent(in) :: assembly
      real(wp), intent(in) :: largest(FIELDS)
      integer, intent(in) :: i

      body_scale = max(assembly%scale(i), HISTORY_SHARE*largest(2), ABSOLUTE_FLOOR)
   end function body_scale

   pure logical function counts(dofs, constraint, i)
      type(dofs_t), intent(in) :: dofs
      type(constraint_t), intent(in) :: constraint
      integer, intent(in) :: i

      counts = .not. constraint%fixed(i)
      if (counts .and. dofs%field(i) == 4) counts = .not. constraint%air(dofs%node(i))
   end function counts

   !> Errors of the fields.
   pure subroutine measure(dofs, constraint, assembly, rhs, largest, log)
      type(dofs_t), intent(in) :: dofs
      type(constraint_t), intent(in) :: constraint
      type(assembly_t), intent(in) :: assembly
      real(wp), intent(in) :: rhs(:)
      real(wp), intent(inout) :: largest(FIELDS)
      type(log_t), intent(inout) :: log
      real(wp) :: r(FIELDS), s(FIELDS), floor(FIELDS), worst
      integer :: i

      r = 0.0_wp
      do i = 1, dofs%n
         if (counts(dofs, constraint, i)) r(dofs%field(i)) = r(dofs%field(i)) + rhs(i)**2
      end do
      r(1:2) = sum(r(1:2))
      call add_scales(dofs, constraint, assembly, s, floor)
      largest = max(largest, sqrt(s))
      log%error = sqrt(r)/field_scales(dofs, constraint, assembly, largest)
      do i = 1, dofs%n
         if (is_body(constraint, i)) log%error(2) = max(log%error(2), abs(rhs(i))/body_scale(assembly, largest, i))
      end do
      log%worst_field = maxloc(log%error, 1)
      log%worst_unknown = 0
      worst = -1.0_wp
      do i = 1, dofs%n
         if (dofs%field(i) /= log%worst_field .or. constraint%fixed(i)) cycle
         if (abs(rhs(i)) > worst) then
            worst = abs(rhs(i))
            log%worst_unknown = i
         end if
      end do
   end subroutine measure

   !> Rows of prescribed unknowns say what is missing of their value; the diagonal keeps its size.
   subroutine constrain(dofs, pattern, constraint, x, values, rhs)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(constraint_t), intent(in) :: constraint
      real(wp), intent(in) :: x(:, :)
      real(wp), intent(inout) :: values(:), rhs(:)
      real(wp) :: size_of
      integer :: i, k

      do i = 1, dofs%n
         if (.not. constraint%fixed(i)) cycle
         call clear(i, size_of)
         values(place_of(pattern, i, i)) = size_of
         rhs(i) = size_of*(constraint%target(i) - x(dofs%field(i), dofs%node(i)))
      end do
      do k = 1, size(constraint%air)
         if (.not. constraint%air(k)) cycle
         i = dofs%of(4, k)
         if (constraint%fixed(i)) cycle
         call clear(i, size_of)
         values(place_of(pattern, i, i)) = size_of
         values(place_of(pattern, i, dofs%of(3, k))) = size_of
         rhs(i) = size_of*(constraint%air_target(k) - x(3, k) - x(4, k))
      end do
   contains
      !> Empties a row; its diagonal is returned, or 1 if there is nothing on it.
      subroutine clear(row, diagonal)
         integer, intent(in) :: row
         real(wp), intent(out) :: diagonal

         diagonal = abs(values(place_of(pattern, row, row)))
         if (.not. diagonal > 0.0_wp) diagonal = 1.0_wp
         diagonal = set_exponent(1.0_wp, exponent(diagonal))   ! Steady, for the sake of factors that are used again.
         values(pattern%row(row):pattern%row(row + 1) - 1) = 0.0_wp
      end subroutine clear
   end subroutine constrain

   pure subroutine add_correction(dofs, dx, x, share)
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: dx(:)
      real(wp), intent(inout) :: x(:, :)
      real(wp), intent(out) :: share
      real(wp) :: change(FIELDS), total(FIELDS)
      integer :: f, i

      change = 0.0_wp
      do i = 1, size(x, 2)
         do f = 1, FIELDS
            if (dofs%of(f, i) == 0) cycle
            x(f, i) = x(f, i) + dx(dofs%of(f, i))
            change(f) = change(f) + dx(dofs%of(f, i))**2
         end do
      end do
      total = norm2(x, dim=2)
      share = maxval(sqrt(change)/max(total, tiny(1.0_wp)), mask=total > 0.0_wp)
      if (.not. any(total > 0.0_wp)) share = 0.0_wp
   end subroutine add_correction
end module newton_step
