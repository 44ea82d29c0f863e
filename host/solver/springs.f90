! SPDX-License-Identifier: MIT
!> Springs with a dashpot between two unknowns, which push and, if they are to, pull: terms fill them, without them the
!> list is empty. docs/theory/host.md section 7.8.
module springs
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use generalised_alpha, only: scheme_t
   use porous_domain, only: model_state_t
   use sparsity_pattern, only: pattern_t, place_of
   implicit none (type, external)
   private
   public :: spring_t, add_spring, add_mean_of_spring

   type :: spring_t
      logical :: acts = .false.                  !< The force acts in the step under way.
      logical :: pulls = .false.                 !< Else its ends may part.
      integer :: upper = 0, lower = 0            !< Unknowns of its ends.
      real(wp) :: stiffness = 0.0_wp             !< [kN/m]
      real(wp) :: damping = 0.0_wp               !< In dynamic steps [kN s/m].
      real(wp) :: clearance = 0.0_wp             !< Between the ends at the start [m].
   end type spring_t
contains
   !> Adds forces at the levels of their displacements and velocities, and the slopes.
   subroutine add_spring(one, dofs, pattern, scheme, old, new, slopes, assembly)
      type(spring_t), intent(in) :: one
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: old, new
      logical, intent(in) :: slopes
      type(assembly_t), intent(inout) :: assembly
      real(wp) :: u0, u1, v0, v1, force, before, slope
      integer :: a, b, ends(2), signs(2)

      call shortening(one, dofs, old, u0, v0)
      call shortening(one, dofs, new, u1, v1)
      force = 0.0_wp
      if (may_push(one, scheme, u0, v0)) force = push(one, scheme, u0 + scheme%l_f*(u1 - u0), &
                                                       v0 + scheme%l_v*(v1 - v0))
      before = force_at(one, scheme, u0, v0)
      ends = [one%upper, one%lower]
      signs = [-1, 1]
      assembly%residual(ends) = assembly%residual(ends) + signs*force
      assembly%scale(ends) = assembly%scale(ends) + abs(force)
      if (assembly%with_change) assembly%change(ends) = assembly%change(ends) + abs(force - before)
      if (.not. slopes .or. .not. (abs(force) > 0.0_wp .or. one%pulls)) return
      slope = one%stiffness*scheme%l_f
      if (scheme%has_inertia) slope = slope + one%damping*scheme%c_v
      do a = 1, 2
         do b = 1, 2
            associate (value => assembly%values(place_of(pattern, ends(a), ends(b))))
               value = value + signs(a)*signs(b)*slope
            end associate
         end do
      end do
   end subroutine add_spring

   !> Adds the mean of the force at both ends of a step, for the balance of energy.
   subroutine add_mean_of_spring(one, dofs, scheme, old, new, force)
      type(spring_t), intent(in) :: one
      type(dofs_t), intent(in) :: dofs
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: old, new
      real(wp), intent(inout) :: force(:)
      real(wp) :: u, v, mean

      call shortening(one, dofs, old, u, v)
      mean = force_at(one, scheme, u, v)
      call shortening(one, dofs, new, u, v)
      mean = 0.5_wp*(mean + force_at(one, scheme, u, v))
      force(one%upper) = force(one%upper) - mean
      force(one%lower) = force(one%lower) + mean
   end subroutine add_mean_of_spring

   !> By how much, and how fast, the ends have come nearer than the clearance [m, m/s].
   pure subroutine shortening(one, dofs, state, u, v)
      type(spring_t), intent(in) :: one
      type(dofs_t), intent(in) :: dofs
      type(model_state_t), intent(in) :: state
      real(wp), intent(out) :: u, v

      associate (f => dofs%field(one%upper), g => dofs%field(one%lower), a => dofs%node(one%upper), &
                 b => dofs%node(one%lower))
         u = state%x(g, b) - state%x(f, a) - one%clearance
         v = state%v(g, b) - state%v(f, a)
      end associate
   end subroutine shortening

   !> Whether a step that begins so may bring ends together. A dashpot that came and went with an iterate would let no
   !> iteration end: so that is known before, where one acts.
   pure logical function may_push(one, scheme, u, v)
      type(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< At the start of the step [m, m/s].

      may_push = one%pulls .or. .not. one%damping > 0.0_wp .or. .not. scheme%has_inertia .or. u > 0.0_wp
      ! The accelerations of a start belong to no step.
      if (.not. may_push .and. scheme%l_f > 0.0_wp) may_push = u + scheme%dt*v > 0.0_wp
   end function may_push

   !> Force between the ends, pushing positive; none where they are apart [kN].
   pure real(wp) function force_at(one, scheme, u, v) result(force)
      type(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< [m, m/s]

      force = 0.0_wp
      if (one%pulls .or. u > 0.0_wp) force = push(one, scheme, u, v)
   end function force_at

   !> Force between ends that have met, pushing positive [kN].
   pure real(wp) function push(one, scheme, u, v) result(force)
      type(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< [m, m/s]

      force = one%stiffness*u
      if (scheme%has_inertia) force = force + one%damping*v
      if (.not. one%pulls) force = max(0.0_wp, force)
   end function push
end module springs
