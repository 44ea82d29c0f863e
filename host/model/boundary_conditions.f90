! SPDX-License-Identifier: MIT
!> What acts in a step: prescribed displacements, pore pressures and air pressures at its end, loads at a moment, and
!> the masses of plates.
module boundary_conditions
   use acting_places, only: are_on_axis
   use degrees_of_freedom, only: of_unknowns
   use kinds, only: wp
   use generalised_alpha, only: scheme_t, make_scheme
   use model_types, only: model_t, problem_t, factor_at, gravity_at, value_at, fix_t, plate_t, unknowns_of, SPACINGS
   use prescribed_values, only: constraint_t, is_released
   use scene_parts, only: PRESCRIBED_P_A
   use unknown_fields, only: AT_U_R, AT_P_W, AT_P_C, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: new_constraint, constrain_step, complete_constraint, acts, follow_accelerations, &
             starting_accelerations, prescribing_fixes, forces_of_supports
   public :: load_at, plate_loads

   real(wp), parameter :: ROUNDING = 1.0e-6_wp    !< Share of a step by which a sum of steps may miss a time.
contains
   !> Makes a constraint that prescribes and loads nothing; plates have their mass. Extents: see constraint_t.
   function new_constraint(model) result(constraint)
      type(model_t), intent(in) :: model
      type(constraint_t) :: constraint
      integer :: i

      associate (n => model%dofs%n, nodes => size(model%domain%mesh%x, 2))
         allocate (constraint%fixed(n), source=.false.)
         allocate (constraint%limited_by(n), constraint%body(n), source=0)
         allocate (constraint%air(nodes), source=.false.)
         allocate (constraint%target(n), constraint%load_0(n), constraint%load_1(n), constraint%faded(n), &
                   constraint%offered_0(n), constraint%offered_1(n), constraint%offset(n), constraint%mass(n), &
                   source=0.0_wp)
         allocate (constraint%air_target(nodes), source=0.0_wp)
      end associate
      allocate (constraint%linear(0), constraint%springs(0))
      do i = 1, size(model%plates)
         ! Plates whose boundaries a &tie joins have one unknown.
         associate (of => model%plates(i)%coordinates, at => unknowns_of(model%plates(i), model%dofs))
            constraint%mass(at) = constraint%mass(at) + of%mass/of%unit**2
            constraint%body(at) = i
         end associate
      end do
   end function new_constraint

   !> Sets the prescribed values at the end of a step; some unknowns are held at what they were at the start of the
   !> stage. docs/theory/host.md sections 3.5 and 7.1. Accelerations: see follow_accelerations.
   subroutine constrain_step(time, problem)
      real(wp), intent(in) :: time   !< At its end [s].
      type(problem_t), intent(inout) :: problem
      integer :: by(problem%model%dofs%n), air_by(size(problem%model%domain%mesh%x, 2)), i
      real(wp) :: factors(size(problem%model%fixes))

      call prescribing_fixes(problem, time, by, air_by)
      associate (z => problem%model%domain%mesh%x(2, :), model => problem%model, dofs => problem%model%dofs, &
                 constraint => problem%constraint, x_start => problem%at%x_start, &
                 on_axis => are_on_axis(problem%model))
         factors = [(factor_at(model, model%fixes(i)%amplitude, time), i=1, size(factors))]
         constraint%fixed = by > 0
         constraint%air = air_by > 0
         do i = 1, size(by)
            if (by(i) == 0) cycle
            associate (fix => model%fixes(by(i)))
               constraint%target(i) = value_at(fix, z(dofs%node(i)))*factors(by(i))
               if (fix%hold) constraint%target(i) = x_start(fix%field, dofs%node(i))
            end associate
         end do
         do i = 1, size(by)
            if (by(i) > 0 .or. dofs%field(i) /= AT_U_R .or. .not. on_axis(dofs%node(i))) cycle
            constraint%fixed(i) = .true.
            constraint%target(i) = 0.0_wp
         end do
         do i = 1, size(air_by)
            if (air_by(i) == 0) cycle
            associate (fix => model%fixes(air_by(i)))
               constraint%air_target(i) = value_at(fix, z(i))*factors(air_by(i))
               if (fix%hold) constraint%air_target(i) = x_start(AT_P_W, i) + x_start(AT_P_C, i)
            end associate
         end do
      end associate
   end subroutine constrain_step

   !> Completes what follows from the prescribed values of supports and terms.
   subroutine complete_constraint(problem)
      type(problem_t), intent(inout) :: problem
      integer :: node

      associate (dofs => problem%model%dofs, constraint => problem%constraint)
         ! Air pressure and one of the others: then the third is known too.
         do node = 1, size(constraint%air)
            if (.not. constraint%air(node)) cycle
            associate (w => dofs%of(AT_P_W, node), c => dofs%of(AT_P_C, node))
               if (constraint%fixed(c)) then
                  constraint%target(w) = constraint%air_target(node) - constraint%target(c)
               else if (constraint%fixed(w)) then
                  constraint%target(c) = constraint%air_target(node) - constraint%target(w)
               else
                  cycle
               end if
               constraint%fixed([w, c]) = .true.
               constraint%air(node) = .false.
            end associate
         end do
         if (problem%stage%has_rates) return
         where (dofs%field > DISPLACEMENTS)
            constraint%fixed = .true.
            constraint%target = of_unknowns(dofs, problem%at%x_start)
         end where
         constraint%air = .false.
      end associate
   end subroutine complete_constraint

   !> Displacements at the end of a step whose accelerations are prescribed: those that the scheme gives them, so that
   !> inertia is exact and free of the ringing that a prescribed displacement has. Accelerations of the scheme belong to
   !> the time (gamma - 1/2) dt before the end of the step. docs/theory/host.md section 7.5.
   subroutine follow_accelerations(problem)
      type(problem_t), intent(inout) :: problem
      integer :: by(problem%model%dofs%n), air_by(size(problem%model%domain%mesh%x, 2)), i
      real(wp) :: a

      associate (model => problem%model, scheme => problem%scheme, dt => problem%scheme%dt, state => problem%state)
         call prescribing_fixes(problem, state%time + dt, by, air_by)
         do i = 1, size(by)
            if (by(i) == 0) cycle
            associate (fix => model%fixes(by(i)), f => model%dofs%field(i), node => model%dofs%node(i), &
                       target => problem%constraint%target(i))
               if (.not. fix%acceleration) cycle
               target = state%x(f, node)
               if (.not. scheme%has_inertia) cycle
               a = acceleration_at(model, fix, node, scheme, state%time + dt)
               target = state%x(f, node) + dt*state%v(f, node) &
                        + dt**2*((0.5_wp - scheme%beta)*state%a(f, node) + scheme%beta*a)
            end associate
         end do
      end associate
   end subroutine follow_accelerations

   !> Accelerations that prescribed ones have when a stage begins; 0 elsewhere. docs/theory/host.md section 7.5.
   subroutine starting_accelerations(problem)
      type(problem_t), intent(inout) :: problem
      type(scheme_t) :: scheme
      integer :: by(problem%model%dofs%n), air_by(size(problem%model%domain%mesh%x, 2)), i

      scheme = make_scheme(problem%stage, problem%stage%rho_inf, problem%stage%dt)
      call prescribing_fixes(problem, problem%state%time + scheme%dt, by, air_by)
      problem%constraint%acceleration = [(0.0_wp, i=1, size(by))]
      do i = 1, size(by)
         if (by(i) == 0) cycle
         associate (fix => problem%model%fixes(by(i)))
            if (fix%acceleration) problem%constraint%acceleration(i) = &
               acceleration_at(problem%model, fix, problem%model%dofs%node(i), scheme, problem%state%time)
         end associate
      end do
   end subroutine starting_accelerations

   !> Prescribes the acceleration of a node at the moment that the scheme asks for [m/s2].
   pure real(wp) function acceleration_at(model, fix, node, scheme, time) result(a)
      type(model_t), intent(in) :: model
      type(fix_t), intent(in) :: fix
      integer, intent(in) :: node
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: time

      a = value_at(fix, model%domain%mesh%x(2, node)) &
          *factor_at(model, fix%amplitude, time + (0.5_wp - scheme%gamma)*scheme%dt)
   end function acceleration_at

   !> Whether a &fix acts in a step. Times that are sums, 0.1 s and 0.2 s, are those of the scene, 0.3 s.
   pure logical function acts(fix, problem, time)
      type(fix_t), intent(in) :: fix
      type(problem_t), intent(in) :: problem
      real(wp), intent(in) :: time   !< At the end of the step.
      real(wp) :: rounding_of_time

      rounding_of_time = max((SPACINGS + problem%at%step)*spacing(time), ROUNDING*problem%at%nominal*problem%at%factor)
      acts = fix%in_stage(problem%at%stage) .and. time > fix%from + rounding_of_time .and. &
             time <= fix%until + rounding_of_time
   end function acts

   !> Finds the number of the &fix that prescribes every unknown, and of that which prescribes the air pressure of every
   !> node; 0: none. The last one counts.
   subroutine prescribing_fixes(problem, time, by, air_by)
      type(problem_t), intent(in) :: problem
      real(wp), intent(in) :: time   !< At the end of a step [s].
      integer, intent(out) :: by(:), air_by(:)   !< (unknowns), (nodes)
      integer :: i, k, node, at

      by = 0
      air_by = 0
      do i = 1, size(problem%model%fixes)
         associate (fix => problem%model%fixes(i), groups => problem%model%domain%mesh%groups)
            if (.not. acts(fix, problem, time) .or. fix%limits) cycle
            do k = 1, size(groups(fix%group)%nodes)
               node = groups(fix%group)%nodes(k)
               if (is_released(problem%constraint, i, node)) cycle
               at = problem%model%dofs%of(min(fix%field, AT_P_C), node)
               if (at == 0) cycle
               if (fix%field == PRESCRIBED_P_A) air_by(problem%model%dofs%node(at)) = i
               if (fix%field /= PRESCRIBED_P_A) by(at) = i
            end do
         end associate
      end do
   end subroutine prescribing_fixes

   !> Sums the forces that hold displacements, group by group [kN]: an unknown's belongs to the group of the &fix that
   !> prescribes it. docs/theory/host.md section 9.1.
   pure function forces_of_supports(model, by, reaction) result(force)
      type(model_t), intent(in) :: model
      integer, intent(in) :: by(:)          !< (unknowns) Of prescribing_fixes.
      real(wp), intent(in) :: reaction(:)   !< (unknowns) Residual with every row kept.
      real(wp) :: force(DISPLACEMENTS, size(model%domain%mesh%groups))
      integer :: i

      force = 0.0_wp
      do i = 1, size(by)
         if (by(i) == 0 .or. model%dofs%field(i) > DISPLACEMENTS) cycle
         associate (total => force(model%dofs%field(i), model%fixes(by(i))%group))
            total = total + reaction(i)
         end associate
      end do
   end function forces_of_supports

   !> Sums the loads of a stage at a time. (unknowns) Forces of loads and plates [kN], inflows [m3/s]:
   !> docs/theory/host.md sections 7.2 and 7.3.
   function load_at(model, stage, time) result(load)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Number of the stage.
      real(wp), intent(in) :: time   !< [s]
      real(wp), allocatable :: load(:)
      integer :: i

      allocate (load(model%dofs%n), source=0.0_wp)
      do i = 1, size(model%loads)
         associate (one => model%loads(i))
            if (one%in_stage(stage)) load = load + factor_at(model, one%amplitude, time)*one%vector
         end associate
      end do
      do i = 1, size(model%plates)
         associate (one => model%plates(i))
            associate (at => unknowns_of(one, model%dofs))
               load(at) = load(at) + plate_loads(model, one, time)/one%coordinates%unit
            end associate
         end associate
      end do
   end function load_at

   !> Sums the loads on the coordinates of a plate, its weight among them: first the force upwards [kN].
   !> docs/theory/host.md section 7.3.
   pure function plate_loads(model, plate, time) result(loads)
      type(model_t), intent(in) :: model
      type(plate_t), intent(in) :: plate
      real(wp), intent(in) :: time   !< [s]
      real(wp) :: loads(size(plate%coordinates))

      loads = factor_at(model, plate%amplitude, time)*plate%coordinates%load
      if (plate%heavy) loads(1) = loads(1) - plate%mass*gravity_at(model, time)
   end function plate_loads
end module boundary_conditions
