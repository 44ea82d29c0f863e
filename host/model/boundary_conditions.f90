! SPDX-License-Identifier: MIT
!> What a step prescribes: displacements, pore pressures and air pressures at its end, and the masses of plates.
module boundary_conditions
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use generalised_alpha, only: scheme_t, has_rates
   use limited_pressures, only: begin_sides
   use model_types, only: model_t, factor_at, fix_t, unknowns_of
   use porous_domain, only: model_state_t
   use prescribed_values, only: constraint_t, is_released
   use scene_parts, only: acts_in, stage_t, PRESCRIBED_P_A
   use unknown_fields, only: AT_P_W, AT_P_C, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: new_constraint, constrain_step, complete_constraint, acts, value_of, follow_accelerations, &
             starting_accelerations, prescribing_fixes, forces_of_supports

   real(wp), parameter :: ROUNDING = 1.0e-12_wp   !< Of a time, relative.
contains
   !> Nothing prescribed, nothing loaded; plates have their mass. Extents: see constraint_t.
   function new_constraint(model) result(constraint)
      type(model_t), intent(in) :: model
      type(constraint_t) :: constraint
      integer :: i

      associate (n => model%dofs%n, nodes => size(model%domain%mesh%x, 2))
         allocate (constraint%fixed(n), constraint%limited(n), source=.false.)
         allocate (constraint%limited_by(n), constraint%releases(n), constraint%body(n), source=0)
         allocate (constraint%air(nodes), source=.false.)
         allocate (constraint%target(n), constraint%load_0(n), constraint%load_1(n), constraint%rain_0(n), &
                   constraint%rain_1(n), constraint%offset(n), constraint%mass(n), source=0.0_wp)
         allocate (constraint%air_target(nodes), source=0.0_wp)
      end associate
      allocate (constraint%linear(0), constraint%added(0))
      do i = 1, size(model%plates)
         ! Plates whose boundaries a &tie joins have one unknown.
         associate (of => model%plates(i)%coordinates, at => unknowns_of(model%plates(i), model%dofs))
            constraint%mass(at) = constraint%mass(at) + of%mass/of%unit**2
            constraint%body(at) = i
         end associate
      end do
   end function new_constraint

   !> Prescribed values at the end of a step; x_start: unknowns at the start of the stage, which some are held at.
   !> docs/theory/host.md sections 3.5, 7.1 and 7.7. Accelerations: see follow_accelerations.
   subroutine constrain_step(model, stage, time, x_start, constraint)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: time, x_start(:, :)   !< At its end [s]; (FIELDS, nodes) [m, kPa].
      type(constraint_t), intent(inout) :: constraint
      integer :: by(model%dofs%n), air_by(size(model%domain%mesh%x, 2)), i
      real(wp) :: factors(size(model%fixes))

      call prescribing_fixes(model, stage, constraint, time, by, air_by)
      factors = [(factor_at(model, model%fixes(i)%amplitude, time), i=1, size(factors))]
      constraint%fixed = by > 0
      constraint%air = air_by > 0
      constraint%limited = .false.
      associate (z => model%domain%mesh%x(2, :), dofs => model%dofs)
         do i = 1, size(by)
            if (by(i) == 0) cycle
            associate (fix => model%fixes(by(i)))
               constraint%target(i) = value_of(fix, z(dofs%node(i)), factors(by(i)))
               if (fix%hold) constraint%target(i) = x_start(fix%field, dofs%node(i))
            end associate
         end do
         do i = 1, size(air_by)
            if (air_by(i) == 0) cycle
            associate (fix => model%fixes(air_by(i)))
               constraint%air_target(i) = value_of(fix, z(i), factors(air_by(i)))
               if (fix%hold) constraint%air_target(i) = x_start(AT_P_W, i) + x_start(AT_P_C, i)
            end associate
         end do
      end associate
   end subroutine constrain_step

   !> What follows from the prescribed values of supports and terms. Pressures with a limit begin on that side of it on
   !> which they stand at the start of the step.
   subroutine complete_constraint(stage, dofs, x_start, x, constraint)
      type(stage_t), intent(in) :: stage
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: x_start(:, :), x(:, :)   !< (FIELDS, nodes) At the starts of stage and step [m, kPa].
      type(constraint_t), intent(inout) :: constraint
      integer :: i, node

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
      call begin_sides(dofs, x, constraint)
      if (has_rates(stage%kind)) return
      do i = 1, dofs%n
         if (dofs%field(i) <= DISPLACEMENTS) cycle
         constraint%fixed(i) = .true.
         constraint%target(i) = x_start(dofs%field(i), dofs%node(i))
      end do
      constraint%air = .false.
   end subroutine complete_constraint

   !> Value of a &fix at a height z, its history the factor.
   pure real(wp) function value_of(fix, z, factor) result(value)
      type(fix_t), intent(in) :: fix
      real(wp), intent(in) :: z, factor   !< [m, -]

      value = (fix%value + fix%value_slope*(z - fix%datum))*factor
   end function value_of

   !> Displacements at the end of a step whose accelerations are prescribed: those that the scheme gives them, so that
   !> inertia is exact and free of the ringing that a prescribed displacement has. Accelerations of the scheme belong to
   !> the time (gamma - 1/2) dt before the end of the step. docs/theory/host.md section 7.5.
   subroutine follow_accelerations(model, stage, scheme, state, constraint)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: state   !< Before the step.
      type(constraint_t), intent(inout) :: constraint
      integer :: by(model%dofs%n), air_by(size(model%domain%mesh%x, 2)), i
      real(wp) :: a

      call prescribing_fixes(model, stage, constraint, state%time + scheme%dt, by, air_by)
      do i = 1, size(by)
         if (by(i) == 0) cycle
         associate (fix => model%fixes(by(i)), f => model%dofs%field(i), node => model%dofs%node(i), dt => scheme%dt)
            if (.not. fix%acceleration) cycle
            constraint%target(i) = state%x(f, node)
            if (.not. scheme%has_inertia) cycle
            a = acceleration_at(model, fix, node, scheme, state%time + dt)
            constraint%target(i) = state%x(f, node) + dt*state%v(f, node) &
                                   + dt**2*((0.5_wp - scheme%beta)*state%a(f, node) + scheme%beta*a)
         end associate
      end do
   end subroutine follow_accelerations

   !> Accelerations that prescribed ones have when a stage begins; 0 elsewhere. docs/theory/host.md section 7.5.
   subroutine starting_accelerations(model, stage, scheme, time, constraint)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(scheme_t), intent(in) :: scheme   !< Of the first step.
      real(wp), intent(in) :: time   !< [s]
      type(constraint_t), intent(inout) :: constraint
      integer :: by(model%dofs%n), air_by(size(model%domain%mesh%x, 2)), i

      call prescribing_fixes(model, stage, constraint, time + scheme%dt, by, air_by)
      constraint%acceleration = [(0.0_wp, i=1, size(by))]
      do i = 1, size(by)
         if (by(i) == 0) cycle
         associate (fix => model%fixes(by(i)))
            if (fix%acceleration) constraint%acceleration(i) = &
               acceleration_at(model, fix, model%dofs%node(i), scheme, time)
         end associate
      end do
   end subroutine starting_accelerations

   !> Of a node at a moment of the scheme [m/s2].
   pure real(wp) function acceleration_at(model, fix, node, scheme, time) result(a)
      type(model_t), intent(in) :: model
      type(fix_t), intent(in) :: fix
      integer, intent(in) :: node
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: time

      a = value_of(fix, model%domain%mesh%x(2, node), &
                   factor_at(model, fix%amplitude, time + (0.5_wp - scheme%gamma)*scheme%dt))
   end function acceleration_at

   !> Whether a &fix acts in a step.
   pure logical function acts(fix, stage, time)
      type(fix_t), intent(in) :: fix
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: time   !< At the end of the step.

      acts = acts_in(fix%stages, stage%name) .and. time > fix%from .and. time <= fix%until + ROUNDING*abs(time)
   end function acts

   !> Number of the &fix that prescribes every unknown, and of that which prescribes the air pressure of every node; 0:
   !> none. The last one counts.
   subroutine prescribing_fixes(model, stage, constraint, time, by, air_by)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(constraint_t), intent(in) :: constraint
      real(wp), intent(in) :: time   !< At the end of a step [s].
      integer, intent(out) :: by(:), air_by(:)   !< (unknowns), (nodes)
      integer :: i, k, node, at

      by = 0
      air_by = 0
      do i = 1, size(model%fixes)
         associate (fix => model%fixes(i))
            if (.not. acts(fix, stage, time) .or. fix%limits) cycle
            do k = 1, size(model%domain%mesh%groups(fix%group)%nodes)
               node = model%domain%mesh%groups(fix%group)%nodes(k)
               if (is_released(constraint, i, node)) cycle
               at = model%dofs%of(min(fix%field, AT_P_C), node)
               if (at == 0) cycle
               if (fix%field == PRESCRIBED_P_A) air_by(node) = i
               if (fix%field /= PRESCRIBED_P_A) by(at) = i
            end do
         end associate
      end do
   end subroutine prescribing_fixes

   !> Forces that hold displacements, group by group [kN]: an unknown's belongs to the group of the &fix that prescribes
   !> it. docs/theory/host.md section 9.1.
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
end module boundary_conditions
