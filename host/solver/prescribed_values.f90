! SPDX-License-Identifier: MIT
!> Values that a step prescribes, and the rows of the equations that say so: docs/theory/host.md section 7.1. Which
!> unknowns are held may change within Newton's method.
module prescribed_values
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use sparsity_pattern, only: pattern_t, entry_of
   use unknown_fields, only: AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: constraint_t, linear_forces_t, spring_t, is_released, constrain, loads_of_water

   !> Dashpots or springs of a term: forces in proportion to velocities or displacements, outflow to rates of pressures.
   type :: linear_forces_t
      logical :: acts = .false.                  !< The forces act in the step under way.
      logical :: by_rates = .true.               !< Else they act against displacements.
      integer, allocatable :: row(:), column(:)  !< Unknowns of an entry, which elements bring together.
      real(wp), allocatable :: value(:)          !< Force over velocity [kN s/m] or displacement [kN/m]; outflow over
                                                 !< rate [m3/kPa].
   end type linear_forces_t

   !> A spring with a dashpot between two unknowns.
   type :: spring_t
      logical :: acts = .false.                  !< The force acts in the step under way.
      logical :: pulls = .false.                 !< Else its ends may part.
      integer :: upper = 0, lower = 0            !< Unknowns of its ends.
      real(wp) :: stiffness = 0.0_wp             !< [kN/m]
      real(wp) :: damping = 0.0_wp               !< In dynamic steps [kN s/m].
      real(wp) :: clearance = 0.0_wp             !< Between the ends at the start [m].
   end type spring_t

   !> Prescribed unknowns and loads of a step.
   type :: constraint_t
      logical, allocatable :: fixed(:)        !< Unknowns
      real(wp), allocatable :: target(:)      !< values of the unknowns that are fixed, at the end of the step
      logical, allocatable :: released(:, :)  !< (fixes, nodes) Where no &fix acts in this step; not allocated: nowhere.
      real(wp), allocatable :: faded(:)       !< Change of load_0 to load_1 by what acted at once and is spread over the
                                              !< stage [kN]. (unknowns)
      logical, allocatable :: air(:)          !< Nodes with a prescribed air pressure: of tied ones the first
      real(wp), allocatable :: air_target(:)
      integer, allocatable :: limited_by(:)   !< Group of the mesh whose upper limit an unknown has; 0: none. Its target
                                              !< is the limit, and `fixed` says whether it stands there.
      real(wp), allocatable :: offered_0(:), offered_1(:)   !< Inflows in the loads below of which limits may refuse a
                                                            !< part, before and after [m3/s].
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
