! SPDX-License-Identifier: MIT
!> One time step by Newton-Raphson with the exact tangent. One linear solve is one iteration.
!> Newton's method and the stress integration ask each other for accuracy: an error of Newton's method below the
!> tolerance of the stresses cannot be reached, since the substeps of a point change with its strain.
!> docs/theory/host.md section 5.
module newton_step
   use kinds, only: wp
   use wall_clock, only: clock, add_elapsed
   use convergence, only: measure, is_free, good_enough, note_stagnation, linear_tolerance, rounding_in, water_of, &
                          MOST_IN_VAIN
   use degrees_of_freedom, only: dofs_t, at_nodes, of_unknowns
   use equation_assembly, only: assemble, follow_slopes_first
   use tangent_fallback, only: NO_FALLBACK, SOFT_POINTS
   use carried_slopes, only: AS_BEFORE, BY_SLOPES
   use porous_domain, only: region_t
   use generalised_alpha, only: scheme_t, make_scheme, predict, advance_rates, STATIC
   use linear_system, only: solve_step, solve_anew, asked_for, update_contacts
   use prescribed_values, only: constraint_t, constrain, loads_of_water
   use sparse_factors, only: SOLVED, SINGULAR, NOT_FINITE
   use solution, only: solution_t, control_t, log_t, BY_FORCES, BY_CHANGE, T_ASSEMBLY, T_REST, T_MATERIAL, T_CONTACT
   use sparsity_pattern, only: entry_of
   use springs, only: add_springs, add_linear_forces
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_C
   implicit none (type, external)
   private
   public :: take_step, start_accelerations, unbalanced_forces, follow_newton, roughness
   public :: CONVERGED, NOT_CONVERGED, MATERIAL_FAILED, BODY_FREE, SOLVER_FAILED, CONTACT_FAILED, &
             EQUATIONS_LOST

   integer, parameter :: CONVERGED = 0, NOT_CONVERGED = 1, MATERIAL_FAILED = 2, BODY_FREE = 3, SOLVER_FAILED = 4, &
                         CONTACT_FAILED = 5, EQUATIONS_LOST = 6
   real(wp), parameter :: ROUNDING = 1.0e-12_wp   !< Share of all contributions: no residual to begin with is smaller.
   integer, parameter :: SCHEME_STAYS = 0
   real(wp), parameter :: LEAST = 1.0e-10_wp          !< No stress is integrated to less [-].
   real(wp), parameter :: STRESS_SHARE = 1.0e-3_wp    !< Share of an error to which the stresses of the next pass are
                                                      !< integrated.
   real(wp), parameter :: ROUNDINGS = 4.0_wp   !< Roundings of an unknown: old, predicted, corrected, and their
                                               !< difference.
   real(wp), parameter :: HOPELESS = 1.0e10_wp        !< Error beyond which no further iteration helps.
   integer, parameter :: MOST_SEARCHES = 12           !< Passes that look for balance along a correction: as many as a
                                                      !< step has iterations.
   real(wp), parameter :: LEFT = 0.1_wp               !< Share of the work at its begin that ends the search [-].

   !> The iterate of a step under way.
   type :: iterate_t
      real(wp), allocatable :: rhs(:), dx(:)   !< Residual with minus sign [kN, m3/s], correction [m, kPa]. (unknowns)
      real(wp), allocatable :: touched(:)      !< Forces of contacts before, where steps are measured by their change.
      real(wp) :: norm_0 = -1.0_wp             !< Norm of the first residual, or of the second where it is larger.
      real(wp) :: work = 0.0_wp                !< Work of the residual along the correction, at its begin [kN m].
      real(wp) :: begun = 0.0_wp               !< Norm that a reduction is a share of.
      real(wp) :: rounded(FIELDS) = 0.0_wp     !< Change of the balances by the rounding of the unknowns [kN, m3/s].
      real(wp) :: t0 = 0.0_wp                  !< Wall clock when the present part of the work began [s].
      logical :: with_slopes = .true.          !< The next pass makes the slopes too.
      logical :: guessed = .false.             !< The first iterate is a guess, not the state before.
      logical :: rough = .false.               !< Stresses are integrated less closely than the step asks for.
      logical :: done = .false., again = .false.   !< The step is solved; its equations are made again.
   end type iterate_t
contains
   !> Solves a step from solution%state to solution%next by its scheme; the latter is of use only after CONVERGED.
   !> docs/theory/host.md section 5. The outcome of its log says how it ends: CONVERGED; NOT_CONVERGED after
   !> max_iterations or beyond an error of 1e10; MATERIAL_FAILED or CONTACT_FAILED where these refuse the iterate (see
   !> assembly, contacts); BODY_FREE with a singular matrix; EQUATIONS_LOST where they are not finite; SOLVER_FAILED.
   subroutine take_step(solution)
      class(solution_t), intent(inout) :: solution
      type(iterate_t) :: at
      integer :: status

      call begin_iterate(solution, at)
      associate (s => solution, log => solution%log, system => solution%system)
         call begin_step(solution, at)
         if (log%outcome /= CONVERGED) return
         do
            call make_equations(solution, at)
            if (log%outcome /= CONVERGED) then
               if (.not. at%guessed .or. log%iterations > 0) return
               call drop_guess(solution, at)
               cycle
            end if
            call search_balance(solution, at)
            if (log%outcome /= CONVERGED) return
            call note_equations(solution, at)
            if (log%iterations > 0) then
               call judge_iterate(solution, at)
               if (at%done) exit
               if (log%outcome /= CONVERGED) return
               if (at%again) cycle
               ! The slopes at the present values, where the last pass left them out.
               if (.not. at%with_slopes) then
                  at%with_slopes = .true.
                  s%assembly%source = AS_BEFORE
                  call make_equations(solution, at)
                  if (log%outcome /= CONVERGED) return
               end if
            end if
            call constrain(solution%dofs, s%pattern, s%constraint, s%next%x, s%assembly%values, at%rhs)
            if (log%iterations == 0) call find_roundings(solution, at)
            ! Other measures may ask for more than a linear solution that is exact to a share of the forces.
            if (all(s%newton%measure /= [BY_FORCES, BY_CHANGE])) system%factored = .false.
            call solve_step(s, linear_tolerance(s%newton), at%rhs, at%dx, status)
            if (status == SINGULAR .and. s%assembly%fallback < SOFT_POINTS) then
               ! docs/theory/host.md section 5.3.
               s%assembly%fallback = s%assembly%fallback + 1
               system%factored = .false.
               at%with_slopes = .true.
               at%t0 = clock()
               cycle
            end if
            if (status /= SOLVED) then
               log%outcome = outcome_of(status)
               return
            end if
            call correct(solution, at)
         end do
         ! Those of iterates on the way, and of steps that fail, may be of any size.
         system%largest = max(system%largest, log%forces)
         system%first_error = maxval(log%first_error)
         s%assembly%slopes%known = .true.
         call add_elapsed(system%seconds(T_REST), at%t0)
      end associate
   end subroutine take_step

   !> Empties the log, and makes room for residual and correction.
   subroutine begin_iterate(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at

      allocate (at%rhs(solution%dofs%n), at%dx(solution%dofs%n), source=0.0_wp)
      solution%log = log_t()
      at%t0 = clock()
   end subroutine begin_iterate

   !> Sets a step at its first guess, and says how closely its passes are integrated.
   subroutine begin_step(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at

      associate (old => solution%state, new => solution%next, assembly => solution%assembly, &
                 system => solution%system, scheme => solution%scheme, control => solution%newton, log => solution%log)
         at%guessed = .not. control%no_predictor
         new%time = old%time + scheme%dt
         call begin_passes(control, solution)
         ! Laws that change over the step are its own.
         call follow_newton(control%tolerance, solution%domain%regions)
         at%rough = is_tight(solution%domain%regions) .and. .not. allocated(new%laws)
         if (at%rough) call follow_error(merge(system%first_error, huge(1.0_wp), assembly%source == BY_SLOPES), &
                                         solution, at)
         if (allocated(system%contacts) .and. assembly%with_change) then
            log%outcome = merge(CONVERGED, CONTACT_FAILED, system%contacts%forces(solution%dofs, old%x, at%touched))
            if (log%outcome /= CONVERGED) return
         end if
         call predict(scheme, control%no_predictor, old%x, old%v, old%a, new%x)
         call advance_rates(scheme, old%x, old%v, old%a, new%x, new%v, new%a)
      end associate
   end subroutine begin_step

   !> Begins a step again from what is known: a guess that is refused says nothing of the step.
   subroutine drop_guess(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at

      at%guessed = .false.
      solution%log%refused_guess = .true.
      solution%log%outcome = CONVERGED
      associate (old => solution%state, new => solution%next)
         new%x = old%x
         call advance_rates(solution%scheme, old%x, old%v, old%a, new%x, new%v, new%a)
      end associate
   end subroutine drop_guess

   !> Integrates the stresses of the next pass to a share of an error of Newton's method: the first passes cost less.
   !> docs/theory/host.md section 5.1.
   subroutine follow_error(error, solution, at)
      real(wp), intent(in) :: error   !< [-]
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at

      associate (tolerance => solution%newton%tolerance)
         at%rough = error > tolerance/STRESS_SHARE
         call follow_newton(merge(STRESS_SHARE*min(error, 1.0_wp), tolerance, at%rough), solution%domain%regions)
      end associate
   end subroutine follow_error

   !> Stresses are integrated to the tolerance of the material or to that of Newton's method, whichever
   !> is smaller. docs/theory/host.md section 5.1.
   subroutine follow_newton(tolerance, regions)
      real(wp), intent(in) :: tolerance   !< Newton's [-].
      type(region_t), intent(inout) :: regions(:)
      real(wp) :: wanted
      integer :: i

      do i = 1, size(regions)
         associate (law => regions(i)%law)
            if (.not. law%tolerance > 0.0_wp) cycle
            wanted = min(regions(i)%stress_tolerance, max(tolerance, LEAST))
            if (abs(wanted - law%tolerance) > epsilon(1.0_wp)*wanted) call law%integrate_to(wanted, SCHEME_STAYS)
         end associate
      end do
   end subroutine follow_newton

   !> Finds the largest tolerance of the stress integration, 0 without one [-]. docs/theory/host.md section 5.1.
   pure real(wp) function roughness(regions)
      type(region_t), intent(in) :: regions(:)
      integer :: i

      roughness = maxval([0.0_wp, (regions(i)%law%tolerance, i=1, size(regions))])
   end function roughness

   !> Whether stresses are integrated to less than the material has. docs/theory/host.md section 5.1.
   pure logical function is_tight(regions)
      type(region_t), intent(in) :: regions(:)
      integer :: i

      is_tight = any([(regions(i)%law%tolerance < 0.5_wp*regions(i)%stress_tolerance, i=1, size(regions))])
   end function is_tight

   !> Makes the equations of a scheme between both states, of contacts, elements and what acts beside them: the residual
   !> with minus sign in at%rhs, and its slopes where at%with_slopes asks for them. log%outcome: CONTACT_FAILED or
   !> MATERIAL_FAILED where these refuse the state, else CONVERGED.
   subroutine make_equations(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at
      real(wp) :: spent

      associate (old => solution%state, new => solution%next, assembly => solution%assembly, &
                 system => solution%system, scheme => solution%scheme, outcome => solution%log%outcome)
         outcome = CONVERGED
         spent = 0.0_wp
         call add_elapsed(system%seconds(T_REST), at%t0)
         ! At the old level no force of contacts follows the unknowns.
         if (.not. update_contacts(solution, old%x + scheme%l_f*(new%x - old%x), &
                                   at%with_slopes .and. scheme%l_f > 0.0_wp)) then
            outcome = CONTACT_FAILED
            return
         end if
         call add_elapsed(system%seconds(T_CONTACT), at%t0)
         call assemble(solution%domain, solution%dofs, solution%pattern, scheme, old, new, at%with_slopes, assembly)
         system%n_pass = system%n_pass + 1
         solution%log%rate_evaluations = solution%log%rate_evaluations + assembly%rate_evaluations
         call add_elapsed(spent, at%t0)
         system%seconds(T_MATERIAL) = system%seconds(T_MATERIAL) + spent*assembly%material
         system%seconds(T_ASSEMBLY) = system%seconds(T_ASSEMBLY) + spent*(1 - assembly%material)
         if (assembly%bad_element > 0) then
            outcome = MATERIAL_FAILED
            return
         end if
         call add_what_acts(solution, at)
      end associate
   end subroutine make_equations

   !> Notes what the equations of an iterate leave: reactions, and the forces that rounding leaves of ties.
   subroutine note_equations(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at

      associate (assembly => solution%assembly, system => solution%system)
         system%reaction = -at%rhs
         assembly%unresolved = at%rounded(1)
         ! Roundings of the unknowns are found once, of the first iterate, where a plate may not have moved yet.
         if (allocated(system%contacts)) assembly%unresolved = max(system%contacts%rounding, at%rounded(1))
         assembly%unresolved = assembly%unresolved/solution%newton%tolerance
         if (solution%log%iterations == 0) at%norm_0 = norm2(pack(at%rhs, is_free(solution)))
      end associate
   end subroutine note_equations

   !> Judges an iterate by the error of its residual: the step is done, its equations are made again with stresses as
   !> closely integrated as it asks for, it goes on, or log%outcome is NOT_CONVERGED.
   subroutine judge_iterate(solution, at)
      class(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at
      real(wp) :: norm
      logical :: unsettled, good

      at%again = .false.
      associate (constraint => solution%constraint, assembly => solution%assembly, system => solution%system, &
                 control => solution%newton, log => solution%log)
         call solution%choose(at%rhs, unsettled)
         if (allocated(system%contacts)) unsettled = unsettled .or. system%contacts%unsettled
         call measure(solution, at%rhs)
         norm = norm2(pack(at%rhs, is_free(solution)))
         ! A step that is driven by prescribed values alone begins with a residual that is almost zero.
         if (log%iterations == 1) then
            log%first_error = log%error
            at%norm_0 = max(at%norm_0, norm)
            log%balanced = at%norm_0 <= rounding_in(solution%scheme%has_inertia)*norm2(assembly%scale)
            at%begun = max(at%norm_0, ROUNDING*norm2(assembly%scale))
         end if
         log%reduction = norm/max(at%begun, tiny(1.0_wp))
         ! What is newly held or let go, or a contact that holds back, has not been solved for yet.
         if (.not. unsettled) then
            good = good_enough(control, log)
            at%done = good .and. .not. at%rough
            at%again = good .and. at%rough
            if (at%again) call follow_error(0.0_wp, solution, at)
            if (good) return
            call note_stagnation(control, log)
            at%done = log%stagnated
            if (at%done) return
            if (at%rough) call follow_error(merge(0.0_wp, maxval(log%error), log%since_best > 0), solution, at)
         end if
         ! docs/theory/host.md section 5.2.
         if (log%iterations >= control%max_iterations .or. log%since_best >= MOST_IN_VAIN .or. &
             .not. all(log%error < HOPELESS)) log%outcome = NOT_CONVERGED
      end associate
   end subroutine judge_iterate

   !> Finds what no residual of a step can be told from, before its first solution. A prescribed motion that strains
   !> nothing leaves the rounding of the forces that it asked for, and no other.
   subroutine find_roundings(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at

      associate (system => solution%system, assembly => solution%assembly, tolerance => solution%newton%tolerance)
         system%rounding = rounding_in(solution%scheme%has_inertia)/tolerance*asked_for(solution%dofs, at%rhs)
         system%rounding(AT_P_C) = max(system%rounding(AT_P_C), rounding_of_saturation(solution)/tolerance)
         at%rounded = rounding_of_unknowns(solution)
         system%rounding = max(system%rounding, at%rounded/tolerance)
         assembly%unresolved = max(assembly%unresolved, at%rounded(1)/tolerance)
      end associate
   end subroutine find_roundings

   !> Adds a linear solution to the iterate.
   subroutine correct(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at

      at%t0 = clock()
      solution%log%iterations = solution%log%iterations + 1
      associate (old => solution%state, new => solution%next, log => solution%log)
         log%before = log%changed
         at%work = work_along(solution, at)
         call add_correction(solution%dofs, at%dx, new%x, log%correction, log%changed)
         call advance_rates(solution%scheme, old%x, old%v, old%a, new%x, new%v, new%a)
      end associate
      at%with_slopes = .false.
   end subroutine correct

   !> Looks for balance along a correction that went too far, by regula falsi (Illinois rule): the residual behind it
   !> points back, with more work than it had at the begin, and the next correction might bring the iterate back to
   !> where it was. Only where displacements are what has the largest error. log%outcome: as of make_equations. The log
   !> keeps the whole correction: that a share of it is small says nothing of what is left elsewhere.
   !> docs/theory/host.md section 5.2.
   subroutine search_balance(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at
      real(wp) :: begun, low, high, place, before, work_low, work_high, work, share, largest(FIELDS)
      integer :: i, side

      begun = at%work
      at%work = 0.0_wp   ! a correction is searched once
      ! The first correction brings prescribed unknowns to their values.
      if (solution%log%iterations < 2 .or. .not. begun > 0.0_wp) return
      work = work_along(solution, at)
      if (work > -begun) return
      ! A contact that holds back has not been solved for yet.
      if (allocated(solution%system%contacts)) then
         if (solution%system%contacts%unsettled) return
      end if
      associate (old => solution%state, new => solution%next, log => solution%log)
         call measure(solution, at%rhs)
         if (log%worst_field > DISPLACEMENTS .or. log%error(log%worst_field) < solution%newton%tolerance) return
         low = 0.0_wp
         high = 1.0_wp
         work_low = begun
         work_high = work
         place = high
         side = 0
         do i = 1, MOST_SEARCHES
            before = place
            place = low + (high - low)*work_low/(work_low - work_high)
            ! What is held, or held anew, has its value after the whole correction.
            call add_correction(solution%dofs, merge(0.0_wp, (place - before)*at%dx, solution%constraint%fixed), &
                                new%x, share, largest)
            call advance_rates(solution%scheme, old%x, old%v, old%a, new%x, new%v, new%a)
            call make_equations(solution, at)
            if (log%outcome /= CONVERGED) return
            work = work_along(solution, at)
            if (abs(work) <= LEFT*begun) exit
            ! An end that stays counts half as much.
            if (work > 0.0_wp) then
               low = place
               work_low = work
               if (side > 0) work_high = work_high/2
               side = 1
            else
               high = place
               work_high = work
               if (side < 0) work_low = work_low/2
               side = -1
            end if
         end do
      end associate
   end subroutine search_balance

   !> Finds the work of the residual of the displacements along a correction [kN m].
   pure real(wp) function work_along(solution, at) result(work)
      type(solution_t), intent(in) :: solution
      type(iterate_t), intent(in) :: at

      work = sum(at%dx*at%rhs, mask=solution%dofs%field <= DISPLACEMENTS .and. .not. solution%constraint%fixed)
   end function work_along

   !> Names the outcome of a step whose equations were not solved.
   pure integer function outcome_of(status)
      integer, intent(in) :: status   !< As solve_step gives it.

      outcome_of = SOLVER_FAILED
      if (status == SINGULAR) outcome_of = BODY_FREE
      if (status == NOT_FINITE) outcome_of = EQUATIONS_LOST
   end function outcome_of

   !> Sets what the passes of a step over the elements are asked for.
   pure subroutine begin_passes(control, solution)
      type(control_t), intent(in) :: control
      type(solution_t), intent(inout) :: solution

      associate (assembly => solution%assembly)
         assembly%air = solution%constraint%air
         assembly%with_change = control%measure == BY_CHANGE
         assembly%rounding_share = merge(rounding_in(solution%scheme%has_inertia)/control%tolerance, 0.0_wp, &
                                         assembly%with_change)
         assembly%fallback = NO_FALLBACK
         call follow_slopes_first(assembly)
      end associate
   end subroutine begin_passes

   !> Estimates the error that the rounding of the degree of saturation at both ends of a step leaves of its rate, in
   !> the norm of the free balances of air [m3/s]. docs/theory/host.md section 5.1.
   pure real(wp) function rounding_of_saturation(solution) result(rounding)
      type(solution_t), intent(in) :: solution
      real(wp) :: pores(solution%dofs%n)
      integer :: e, g, i, p, at, n_p

      rounding = 0.0_wp
      if (.not. solution%domain%with_c .or. .not. solution%scheme%has_rates) return
      pores = 0.0_wp
      do e = 1, size(solution%domain%mesh%t6, 2)
         n_p = solution%domain%n_carriers(e)
         if (n_p == 0 .or. .not. solution%domain%regions(solution%domain%region_of(e))%with_c) cycle
         do i = 1, n_p
            at = solution%dofs%element(size(solution%domain%mesh%t6, 1)*DISPLACEMENTS + n_p + i, e)
            if (at == 0) cycle
            do g = 1, solution%domain%rule
               p = (e - 1)*solution%domain%rule + g
               associate (gp => solution%domain%gauss(g, e), ratio => solution%state%e(p))
                  pores(at) = pores(at) + gp%weight*abs(gp%m(i))*ratio/(1 + ratio)
               end associate
            end do
         end do
      end do
      rounding = epsilon(1.0_wp)/solution%scheme%dt*norm2(pack(pores, .not. solution%constraint%fixed))
   end function rounding_of_saturation

   !> Estimates the change of the balances by a rounding of every unknown from the matrix: norms over the free rows of
   !> every field. Inertia divides it by dt**2, a rate by dt, and a plate in free flight has no other forces. Those
   !> of displacements are in [kN], of pressures in [m3/s]. docs/theory/host.md section 5.1.
   pure function rounding_of_unknowns(solution) result(rounding)
      type(solution_t), intent(in) :: solution
      real(wp) :: rounding(FIELDS)
      real(wp) :: unknowns(solution%dofs%n), row
      integer :: i, place

      unknowns = of_unknowns(solution%dofs, solution%next%x)
      rounding = 0.0_wp
      do i = 1, solution%dofs%n
         if (solution%constraint%fixed(i)) cycle
         row = 0.0_wp
         do place = solution%pattern%row(i), solution%pattern%row(i + 1) - 1
            row = row + abs(solution%assembly%values(place)*unknowns(solution%pattern%col(place)))
         end do
         rounding(solution%dofs%field(i)) = rounding(solution%dofs%field(i)) + row**2
      end do
      rounding(:DISPLACEMENTS) = sum(rounding(:DISPLACEMENTS))
      rounding = ROUNDINGS*epsilon(1.0_wp)*sqrt(rounding)
   end function rounding_of_unknowns

   !> Adds rigid bodies, boundaries, contacts and loads to the elements; at%rhs becomes minus the residual.
   subroutine add_what_acts(solution, at)
      type(solution_t), intent(inout) :: solution
      type(iterate_t), intent(inout) :: at
      real(wp), allocatable :: without(:)   !< The residual without contacts.

      associate (assembly => solution%assembly, system => solution%system, constraint => solution%constraint, &
                 scheme => solution%scheme, rhs => at%rhs)
         call add_forces(at%with_slopes, solution)
         allocate (without(merge(solution%dofs%n, 0, allocated(at%touched))))
         if (allocated(at%touched)) without(:) = assembly%residual
         if (allocated(system%contacts)) then
            call add_elapsed(system%seconds(T_REST), at%t0)
            call system%contacts%add(solution%pattern, scheme%l_f, at%with_slopes .and. scheme%l_f > 0.0_wp, &
                                     assembly%residual, assembly%scale, assembly%values)
            call add_elapsed(system%seconds(T_CONTACT), at%t0)
         end if
         rhs = constraint%load_0 + scheme%l_f*(constraint%load_1 - constraint%load_0) - constraint%offset
         call loads_of_water(solution%dofs, constraint%air, rhs)
         assembly%scale = assembly%scale + abs(rhs)
         if (allocated(assembly%water)) assembly%water = assembly%water &
                                                         + abs(water_of(solution%dofs, constraint%air, rhs))
         if (assembly%with_change) then
            ! What the step changes of loads and contacts, beside that of the elements. An overlap that no solution has
            ! answered yet presses with the penalty alone, which balances nothing: no more counts than the force that is
            ! there now.
            if (allocated(at%touched)) assembly%change = assembly%change + &
               min(abs(assembly%residual - without), abs(assembly%residual - without - at%touched))
            where (solution%dofs%field <= DISPLACEMENTS)
               assembly%change = assembly%change + scheme%l_f*abs(constraint%load_1 - constraint%load_0 &
                                                                  - constraint%faded)
            elsewhere
               assembly%change = assembly%scale
            end where
         end if
         rhs = rhs - assembly%residual
      end associate
   end subroutine add_what_acts

   !> Solves for the accelerations that the loads and stresses of a state ask for, its displacements, velocities and
   !> pressures held: docs/theory/host.md section 4.1. They go into `a` of both states, which are equal [m/s2]. Outcomes
   !> are those of take_step, but for NOT_CONVERGED.
   subroutine start_accelerations(solution)
      type(solution_t), intent(inout) :: solution
      type(constraint_t) :: held
      type(iterate_t) :: at
      integer :: status

      associate (state => solution%state, work => solution%next, log => solution%log, &
                 constraint => solution%constraint, assembly => solution%assembly)
         ! Values and velocities at the old level, accelerations at the new one: the residual is linear in them.
         solution%scheme = scheme_t(has_rates=.true., has_inertia=.true., l_f=0.0_wp, l_v=0.0_wp, l_a=1.0_wp, &
                                    l_p=0.0_wp, c_v=0.0_wp, c_a=1.0_wp, c_p=0.0_wp)
         held = constraint
         held%fixed = constraint%fixed .or. solution%dofs%field > DISPLACEMENTS
         held%target = 0.0_wp
         if (allocated(constraint%acceleration)) held%target = constraint%acceleration
         held%air = .false.
         assembly%air = .false.
         state%a = 0.0_wp
         work%a = 0.0_wp
         call begin_iterate(solution, at)
         call make_equations(solution, at)
         if (log%outcome /= CONVERGED) return
         call constrain(solution%dofs, solution%pattern, held, 0.0_wp*state%x, assembly%values, at%rhs)
         call solve_anew(solution, spread(1.0_wp, 1, size(at%rhs)), 0.0_wp, at%rhs, at%dx, status)
         solution%system%factored = .false.
         if (status /= SOLVED) then
            log%outcome = outcome_of(status)
            return
         end if
         associate (a => at_nodes(solution%dofs, at%dx))
            state%a = a(:DISPLACEMENTS, :)
         end associate
         work%a = state%a
      end associate
   end subroutine start_accelerations

   !> Finds the forces on the free displacements that the loads of a state at rest leave without balance: those that act
   !> at once. docs/theory/host.md section 4.4. False where the material or a contact refuses the state.
   logical function unbalanced_forces(solution, forces) result(good)
      type(solution_t), intent(inout) :: solution   !< Both states are equal; load_0 are the loads, load_1 become them.
      real(wp), allocatable, intent(out) :: forces(:)   !< (unknowns) [kN]
      type(scheme_t) :: scheme
      type(iterate_t) :: at

      associate (constraint => solution%constraint)
         call begin_iterate(solution, at)
         at%with_slopes = .false.
         scheme = solution%scheme
         solution%scheme = make_scheme(STATIC, 1.0_wp, 1.0_wp)
         constraint%load_1 = constraint%load_0
         solution%assembly%slopes%known = .false.   ! the stresses that are there, not those of a step
         call begin_passes(control_t(), solution)
         call make_equations(solution, at)
         solution%scheme = scheme
         good = solution%log%outcome == CONVERGED
         forces = merge(0.0_wp, at%rhs, constraint%fixed .or. solution%dofs%field > DISPLACEMENTS)
      end associate
   end function unbalanced_forces

   !> Adds the inertia of rigid bodies, and the forces of terms.
   subroutine add_forces(slopes, solution)
      logical, intent(in) :: slopes
      type(solution_t), intent(inout) :: solution
      integer :: i, f, k, place
      real(wp) :: force

      associate (assembly => solution%assembly, constraint => solution%constraint, scheme => solution%scheme, &
                 old => solution%state, new => solution%next)
         do i = 1, solution%dofs%n
            if (.not. constraint%mass(i) > 0.0_wp) cycle
            f = solution%dofs%field(i)
            k = solution%dofs%node(i)
            force = constraint%mass(i)*(old%a(f, k) + scheme%l_a*(new%a(f, k) - old%a(f, k)))
            assembly%residual(i) = assembly%residual(i) + force
            assembly%scale(i) = assembly%scale(i) + abs(force)
            place = entry_of(solution%pattern, i, i)
            if (slopes) assembly%values(place) = assembly%values(place) + constraint%mass(i)*scheme%c_a
         end do
      end associate
      call add_springs(solution, slopes)
      call add_linear_forces(solution, slopes)
   end subroutine add_forces

   pure subroutine add_correction(dofs, dx, x, share, largest)
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: dx(:)
      real(wp), intent(inout) :: x(:, :)
      real(wp), intent(out) :: share             !< |dx|/|x| of the worst field [-].
      real(wp), intent(out) :: largest(FIELDS)   !< |dx| of every field [m, kPa].
      real(wp) :: change(FIELDS, size(x, 2)), total(FIELDS)

      change = at_nodes(dofs, dx)
      x = x + change
      largest = maxval(abs(change), dim=2)
      total = norm2(x, dim=2)
      share = maxval(sqrt(sum(change**2, dim=2))/max(total, tiny(1.0_wp)), mask=total > 0.0_wp)
      if (.not. any(total > 0.0_wp)) share = 0.0_wp
   end subroutine add_correction
end module newton_step
