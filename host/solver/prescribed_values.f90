! SPDX-License-Identifier: MIT
!> Values that a step prescribes, and the rows of the equations that say so: docs/theory/host.md section 7.1. An unknown
!> may have an upper limit: it is held where it stands there and free where it lies below. Which side acts is decided
!> unknown by unknown within Newton's method, as in the primal-dual active set strategy: section 7.7.
module prescribed_values
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use sparsity_pattern, only: pattern_t, entry_of
   use springs, only: spring_t, linear_forces_t
   use unknown_fields, only: AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: constraint_t, is_released, constrain, begin_sides, choose_sides, loads_of_water

   real(wp), parameter :: AT_LIMIT = 1.0e-6_wp    !< Share of the limit, and [kPa]: so near a step leaves what it holds.
   real(wp), parameter :: LEAST_REACTION = 0.01_wp   !< Share of Newton's tolerance, of the magnitudes in a balance:
                                                     !< less decides nothing.
   integer, parameter :: MOST_RELEASES = 3        !< In a step; then an unknown that alternates keeps its limit.

   !> Prescribed unknowns and loads of a step.
   type :: constraint_t
      logical, allocatable :: fixed(:)        !< Unknowns
      real(wp), allocatable :: target(:)      !< values of the unknowns that are fixed, at the end of the step
      logical, allocatable :: released(:, :)  !< (fixes, nodes) Where no &fix acts in this step; not allocated: nowhere.
      logical, allocatable :: air(:)          !< Nodes with a prescribed air pressure
      real(wp), allocatable :: air_target(:)
      ! Where an unknown has a limit the target is that, and `fixed` says whether it stands there.
      logical, allocatable :: limited(:)      !< Unknowns with a limit.
      integer, allocatable :: limited_by(:)   !< The group of the mesh that their reaction belongs to.
      integer, allocatable :: releases(:)     !< Number of times that they left their limit in this step.
      integer :: stuck = 0                    !< One that keeps its limit although it should leave, 0: none.
      real(wp), allocatable :: rain_0(:), rain_1(:)   !< Rain in the loads below, before and after [m3/s].
      real(wp), allocatable :: load_0(:), load_1(:)   !< Loads before and after.
      real(wp), allocatable :: offset(:)      !< Flow of the initial state that is subtracted, forces that hold ground.
      type(linear_forces_t), allocatable :: linear(:)   !< Dashpots and springs of terms.
      type(spring_t), allocatable :: springs(:)         !< Springs of terms whose ends may part.
      real(wp), allocatable :: acceleration(:)   !< Prescribed ones where a stage begins, if there are any.
      real(wp), allocatable :: mass(:)        !< Masses of rigid bodies [Mg].
      integer, allocatable :: body(:)         !< Number of the rigid body of an unknown; 0: none.
   end type constraint_t
contains
   !> Whether a &fix has no effect at a node in this step.
   pure logical function is_released(constraint, fix, node)
      type(constraint_t), intent(in) :: constraint
      integer, intent(in) :: fix, node   !< Numbers.

      is_released = .false.
      if (allocated(constraint%released)) is_released = constraint%released(fix, node)
   end function is_released

   !> Rows of prescribed unknowns say what is missing of their value; the diagonal keeps its size. docs/theory/host.md
   !> section 7.1.
   subroutine constrain(dofs, pattern, constraint, x, values, rhs)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(constraint_t), intent(in) :: constraint
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) [m, kPa]
      real(wp), intent(inout) :: values(:), rhs(:)   !< (entries) of the matrix; (unknowns).
      real(wp) :: size_of
      integer :: i, k

      do i = 1, dofs%n
         if (.not. constraint%fixed(i)) cycle
         call clear(i, size_of)
         values(entry_of(pattern, i, i)) = size_of
         rhs(i) = size_of*(constraint%target(i) - x(dofs%field(i), dofs%node(i)))
      end do
      do k = 1, size(constraint%air)
         if (.not. constraint%air(k)) cycle
         i = dofs%of(AT_P_C, k)
         if (constraint%fixed(i)) cycle
         call clear(i, size_of)
         values(entry_of(pattern, i, i)) = size_of
         values(entry_of(pattern, i, dofs%of(AT_P_W, k))) = size_of
         rhs(i) = size_of*(constraint%air_target(k) - x(AT_P_W, k) - x(AT_P_C, k))
      end do
   contains
      !> Empties a row; its diagonal is returned, or 1 if there is nothing on it.
      subroutine clear(row, diagonal)
         integer, intent(in) :: row
         real(wp), intent(out) :: diagonal

         diagonal = abs(values(entry_of(pattern, row, row)))
         if (.not. diagonal > 0.0_wp) diagonal = 1.0_wp
         diagonal = set_exponent(1.0_wp, exponent(diagonal))   ! Steady, for the sake of factors that are used again.
         values(pattern%row(row):pattern%row(row + 1) - 1) = 0.0_wp
      end subroutine clear
   end subroutine constrain

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

   !> The sides after an iteration. An unknown is held where r + c (x - limit) > 0, r the reaction that its limit asks
   !> for and c the slope of its balance, and free elsewhere; what is smaller than the balance is known to leaves it as
   !> it is. One that was released too often keeps its limit and is noted in constraint%stuck.
   pure subroutine choose_sides(dofs, pattern, values, x, reaction, magnitudes, tolerance, constraint, changed)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      real(wp), intent(in) :: values(:)     !< (entries) The matrix.
      real(wp), intent(in) :: x(:, :)       !< (FIELDS, nodes) [m, kPa]
      real(wp), intent(in) :: reaction(:)   !< (unknowns) What the balance with all rows kept leaves [kN, m3/s].
      real(wp), intent(in) :: magnitudes(:)   !< (unknowns) Magnitudes of all that is in it [kN, m3/s].
      real(wp), intent(in) :: tolerance     !< Newton's [-].
      type(constraint_t), intent(inout) :: constraint
      logical, intent(out) :: changed
      real(wp) :: side, least
      integer :: i

      changed = .false.
      constraint%stuck = 0
      do i = 1, dofs%n
         if (.not. constraint%limited(i)) cycle
         side = reaction(i) &
                + abs(values(entry_of(pattern, i, i)))*(x(dofs%field(i), dofs%node(i)) - constraint%target(i))
         least = LEAST_REACTION*tolerance*magnitudes(i)
         if (constraint%fixed(i) .and. side < -least) then
            if (constraint%releases(i) >= MOST_RELEASES) then
               constraint%stuck = i
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

   !> Replaces the loads of the first balance by those of the water where the air pressure is prescribed.
   !> docs/theory/host.md sections 2.3 and 7.1.
   pure subroutine loads_of_water(dofs, air, load)
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: air(:)   !< (nodes) Whether the air pressure is prescribed.
      real(wp), intent(inout) :: load(:)   !< (unknowns) [kN, m3/s]
      integer :: i

      do i = 1, size(air)
         if (air(i)) load(dofs%of(AT_P_W, i)) = load(dofs%of(AT_P_W, i)) - load(dofs%of(AT_P_C, i))
      end do
   end subroutine loads_of_water
end module prescribed_values
