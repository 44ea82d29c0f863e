! SPDX-License-Identifier: MIT
!> Springs and dashpots, which terms fill in: forces in proportion to displacements or velocities and outflow in
!> proportion to rates of pressures (docs/theory/host.md section 7.4), and springs with a dashpot between two unknowns
!> that push and, if they are to, pull (section 7.8). Without terms the lists are empty.
module springs
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use generalised_alpha, only: scheme_t
   use porous_domain, only: model_state_t
   use prescribed_values, only: spring_t
   use solution, only: solution_t
   use sparsity_pattern, only: entry_of
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: add_linear_forces, work_of_linear_forces, water_through_dashpots
   public :: add_springs, add_mean_of_springs
contains
   !> Adds forces and outflow at the levels of their rates or displacements, and the slopes. docs/theory/host.md section
   !> 7.4. Dashpots do nothing in steps that are not dynamic. The sums go into residual and scale [kN, m3/s] and the
   !> matrix, whose pattern must have their places.
   subroutine add_linear_forces(s, slopes)
      class(solution_t), intent(inout) :: s
      logical, intent(in) :: slopes
      real(wp) :: force, level, slope
      integer :: i, k, f, node, place

      do i = 1, size(s%constraint%linear)
         associate (one => s%constraint%linear(i), assembly => s%assembly, scheme => s%scheme, old => s%state, &
                    new => s%next)
            if (.not. one%acts .or. (one%by_rates .and. .not. scheme%has_inertia)) cycle
            do k = 1, size(one%row)
               f = s%dofs%field(one%column(k))
               node = s%dofs%node(one%column(k))
               if (one%by_rates) then
                  level = merge(scheme%l_v, scheme%l_p, f <= DISPLACEMENTS)
                  slope = merge(scheme%c_v, scheme%c_p, f <= DISPLACEMENTS)
                  force = one%value(k)*(old%v(f, node) + level*(new%v(f, node) - old%v(f, node)))
               else
                  slope = scheme%l_f
                  force = one%value(k)*(old%x(f, node) + scheme%l_f*(new%x(f, node) - old%x(f, node)))
               end if
               assembly%residual(one%row(k)) = assembly%residual(one%row(k)) + force
               assembly%scale(one%row(k)) = assembly%scale(one%row(k)) + abs(force)
               if (.not. slopes) cycle
               place = entry_of(s%pattern, one%row(k), one%column(k))
               assembly%values(place) = assembly%values(place) + slope*one%value(k)
            end do
         end associate
      end do
   end subroutine add_linear_forces

   !> Finds the energy that dashpots take out of a step, or springs store in it, by the mean at its ends, at given
   !> displacements [kJ]. docs/theory/host.md section 9. Outflow does no work.
   pure real(wp) function work_of_linear_forces(s, by_rates, change) result(work)
      class(solution_t), intent(in) :: s
      logical, intent(in) :: by_rates        !< Dashpots, else springs.
      real(wp), intent(in) :: change(:, :)   !< (2, nodes) [m]
      real(wp) :: mean
      integer :: i, k

      work = 0.0_wp
      do i = 1, size(s%constraint%linear)
         associate (one => s%constraint%linear(i), dofs => s%dofs, old => s%state, new => s%next)
            if (.not. one%acts .or. (one%by_rates .neqv. by_rates)) cycle
            do k = 1, size(one%row)
               associate (f => dofs%field(one%column(k)), node => dofs%node(one%column(k)), &
                          g => dofs%field(one%row(k)), at => dofs%node(one%row(k)))
                  if (f > DISPLACEMENTS) cycle
                  if (by_rates) then
                     work = work + 0.5_wp*one%value(k)*(old%v(f, node) + new%v(f, node))*change(g, at)
                  else
                     mean = 0.5_wp*(old%x(f, node) + new%x(f, node))
                     work = work + one%value(k)*mean*change(g, at)
                  end if
               end associate
            end do
         end associate
      end do
   end function work_of_linear_forces

   !> Sums the water that has left in a step through dashpots that act [m3], in proportion to the changes of the
   !> pressures. The row of p_w is that of both fluids, but for nodes whose air pressure is prescribed.
   pure real(wp) function water_through_dashpots(s) result(water)
      class(solution_t), intent(in) :: s
      real(wp) :: part
      integer :: i, k

      water = 0.0_wp
      do i = 1, size(s%constraint%linear)
         associate (one => s%constraint%linear(i), dofs => s%dofs)
            if (.not. one%acts .or. .not. one%by_rates) cycle
            do k = 1, size(one%row)
               associate (row => one%row(k), f => dofs%field(one%column(k)), node => dofs%node(one%column(k)))
                  part = one%value(k)*(s%next%x(f, node) - s%state%x(f, node))
                  if (dofs%field(row) == AT_P_W) then
                     water = water + part
                  else if (dofs%field(row) == AT_P_C .and. .not. s%constraint%air(dofs%node(row))) then
                     water = water - part
                  end if
               end associate
            end do
         end associate
      end do
   end function water_through_dashpots

   !> Adds the forces of springs that act at the levels of their displacements and velocities, and their slopes.
   subroutine add_springs(s, slopes)
      class(solution_t), intent(inout) :: s
      logical, intent(in) :: slopes
      integer :: i

      do i = 1, size(s%constraint%springs)
         if (s%constraint%springs(i)%acts) call add_spring(s%constraint%springs(i))
      end do
   contains
      subroutine add_spring(one)
         type(spring_t), intent(in) :: one
         real(wp) :: u0, u1, v0, v1, force, before, slope
         integer :: a, b, ends(2), signs(2)

         associate (scheme => s%scheme, assembly => s%assembly)
            call shortening(one, s%dofs, s%state, u0, v0)
            call shortening(one, s%dofs, s%next, u1, v1)
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
                  associate (value => assembly%values(entry_of(s%pattern, ends(a), ends(b))))
                     value = value + signs(a)*signs(b)*slope
                  end associate
               end do
            end do
         end associate
      end subroutine add_spring
   end subroutine add_springs

   !> Adds the mean of the forces of springs at both ends of a step, for the balance of energy.
   subroutine add_mean_of_springs(s, force)
      class(solution_t), intent(in) :: s
      real(wp), intent(inout) :: force(:)   !< (unknowns) [kN]
      real(wp) :: u, v, mean
      integer :: i

      do i = 1, size(s%constraint%springs)
         associate (one => s%constraint%springs(i))
            if (.not. one%acts) cycle
            call shortening(one, s%dofs, s%state, u, v)
            mean = force_at(one, s%scheme, u, v)
            call shortening(one, s%dofs, s%next, u, v)
            mean = 0.5_wp*(mean + force_at(one, s%scheme, u, v))
            force(one%upper) = force(one%upper) - mean
            force(one%lower) = force(one%lower) + mean
         end associate
      end do
   end subroutine add_mean_of_springs

   !> Finds by how much, and how fast, the ends have come nearer than the clearance [m, m/s].
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

   !> Finds the force between the ends, pushing positive; none where they are apart [kN].
   pure real(wp) function force_at(one, scheme, u, v) result(force)
      type(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< [m, m/s]

      force = 0.0_wp
      if (one%pulls .or. u > 0.0_wp) force = push(one, scheme, u, v)
   end function force_at

   !> Finds the force between ends that have met, pushing positive [kN].
   pure real(wp) function push(one, scheme, u, v) result(force)
      type(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< [m, m/s]

      force = one%stiffness*u
      if (scheme%has_inertia) force = force + one%damping*v
      if (.not. one%pulls) force = max(0.0_wp, force)
   end function push
end module springs
