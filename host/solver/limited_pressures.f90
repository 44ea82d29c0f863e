! SPDX-License-Identifier: MIT
!> Water pressures with a limit: on a seepage face, and under rain, water runs off where the pressure stands at its
!> limit and is free where it lies below. Which side acts is decided node by node within Newton's method.
!> docs/theory/host.md section 7.7.
module limited_pressures
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use prescribed_values, only: constraint_t
   use sparsity_pattern, only: pattern_t, place_of
   implicit none (type, external)
   private
   public :: begin_sides, choose_sides

   real(wp), parameter :: AT_LIMIT = 1.0e-6_wp    !< Share of the limit, and [kPa]: so near a step leaves what it holds.
   real(wp), parameter :: FLOW_SHARE = 0.01_wp    !< Share of Newton's tolerance, of a node's flows: less decides
                                                  !< nothing.
   integer, parameter :: MOST_RELEASES = 3        !< In a step; then a node that alternates keeps its limit.
contains
   !> The sides at the start of a step follow from the pressures there, so that a step that is cut, and a restart, begin
   !> alike.
   pure subroutine begin_sides(dofs, x, constraint)
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) at the start of the step [m, kPa]
      type(constraint_t), intent(inout) :: constraint
      integer :: i

      constraint%releases = 0
      do i = 1, dofs%n
         if (.not. constraint%limited(i)) cycle
         associate (limit => constraint%target(i))
            constraint%fixed(i) = x(dofs%field(i), dofs%node(i)) > limit - AT_LIMIT*(1 + abs(limit))
         end associate
      end do
   end subroutine begin_sides

   !> The sides after an iteration. A node is held where r + c (p - limit) > 0, r the run-off [m3/s] and c the slope of
   !> its balance, and free elsewhere; what is smaller than the flows are known to leaves it as it is. A node that was
   !> released too often keeps its limit and is noted in constraint%drinks.
   pure subroutine choose_sides(dofs, pattern, values, x, run_off, flows, tolerance, constraint, changed)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      real(wp), intent(in) :: values(:)     !< (entries) The matrix.
      real(wp), intent(in) :: x(:, :)       !< (FIELDS, nodes) [m, kPa]
      real(wp), intent(in) :: run_off(:)    !< (unknowns) What the balance with all rows kept leaves [m3/s].
      real(wp), intent(in) :: flows(:)      !< (unknowns) Magnitudes of all that is in it [m3/s].
      real(wp), intent(in) :: tolerance     !< Newton's [-].
      type(constraint_t), intent(inout) :: constraint
      logical, intent(out) :: changed
      real(wp) :: side, least
      integer :: i

      changed = .false.
      constraint%drinks = 0
      do i = 1, dofs%n
         if (.not. constraint%limited(i)) cycle
         side = run_off(i) &
                + abs(values(place_of(pattern, i, i)))*(x(dofs%field(i), dofs%node(i)) - constraint%target(i))
         least = FLOW_SHARE*tolerance*flows(i)
         if (constraint%fixed(i) .and. side < -least) then
            if (constraint%releases(i) >= MOST_RELEASES) then
               constraint%drinks = i
               cycle
            end if
            constraint%fixed(i) = .false.
            constraint%releases(i) = constraint%releases(i) + 1
            changed = .true.
         else if (.not. constraint%fixed(i) .and. side > least) then
            constraint%fixed(i) = .true.
            changed = .true.
         end if
      end do
   end subroutine choose_sides
end module limited_pressures
