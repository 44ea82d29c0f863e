! SPDX-License-Identifier: MIT
!> Forces in proportion to velocities, as of dashpots, or to displacements, as of springs, and outflow in proportion to
!> rates of pressures. Terms fill them; without them the list is empty.
!> docs/theory/host.md section 7.4.
module linear_forces
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use generalised_alpha, only: scheme_t
   use porous_domain, only: model_state_t
   use sparsity_pattern, only: pattern_t, place_of
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: linear_forces_t, add_linear_forces, work_of_linear_forces, water_through_dashpots

   type :: linear_forces_t
      logical :: acts = .false.                  !< The forces act in the step under way.
      logical :: by_rates = .true.               !< Else they act against displacements.
      integer, allocatable :: row(:), column(:)  !< Unknowns of an entry, which elements bring together.
      real(wp), allocatable :: value(:)          !< Force over velocity [kN s/m] or displacement [kN/m]; outflow over
                                                 !< rate [m3/kPa].
   end type linear_forces_t
contains
   !> Adds forces and outflow at the levels of their rates or displacements, and the slopes. docs/theory/host.md section
   !> 7.4. Dashpots do nothing in steps that are not dynamic. The sums go into residual and scale [kN, m3/s] and the
   !> matrix, whose pattern must have their places.
   subroutine add_linear_forces(list, dofs, pattern, scheme, old, new, slopes, assembly)
      type(linear_forces_t), intent(in) :: list(:)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: old, new
      logical, intent(in) :: slopes
      type(assembly_t), intent(inout) :: assembly
      real(wp) :: force, level, slope
      integer :: i, k, f, node, place

      do i = 1, size(list)
         if (.not. list(i)%acts .or. (list(i)%by_rates .and. .not. scheme%has_inertia)) cycle
         associate (row => list(i)%row, column => list(i)%column, value => list(i)%value)
            do k = 1, size(row)
               f = dofs%field(column(k))
               node = dofs%node(column(k))
               if (list(i)%by_rates) then
                  level = merge(scheme%l_v, scheme%l_p, f <= DISPLACEMENTS)
                  slope = merge(scheme%c_v, scheme%c_p, f <= DISPLACEMENTS)
                  force = value(k)*(old%v(f, node) + level*(new%v(f, node) - old%v(f, node)))
               else
                  slope = scheme%l_f
                  force = value(k)*(old%x(f, node) + scheme%l_f*(new%x(f, node) - old%x(f, node)))
               end if
               assembly%residual(row(k)) = assembly%residual(row(k)) + force
               assembly%scale(row(k)) = assembly%scale(row(k)) + abs(force)
               if (.not. slopes) cycle
               place = place_of(pattern, row(k), column(k))
               assembly%values(place) = assembly%values(place) + slope*value(k)
            end do
         end associate
      end do
   end subroutine add_linear_forces

   !> Energy that dashpots take out of a step, or springs store in it, by the mean at its ends, at given displacements
   !> [kJ]. docs/theory/host.md section 9. Outflow does no work.
   pure real(wp) function work_of_linear_forces(list, by_rates, dofs, old, new, change) result(work)
      type(linear_forces_t), intent(in) :: list(:)
      logical, intent(in) :: by_rates   !< Dashpots, else springs.
      type(dofs_t), intent(in) :: dofs
      type(model_state_t), intent(in) :: old, new
      real(wp), intent(in) :: change(:, :)   !< (2, nodes) [m]
      real(wp) :: mean
      integer :: i, k

      work = 0.0_wp
      do i = 1, size(list)
         if (.not. list(i)%acts .or. (list(i)%by_rates .neqv. by_rates)) cycle
         do k = 1, size(list(i)%row)
            associate (f => dofs%field(list(i)%column(k)), node => dofs%node(list(i)%column(k)), &
                       g => dofs%field(list(i)%row(k)), at => dofs%node(list(i)%row(k)))
               if (f > DISPLACEMENTS) cycle
               if (by_rates) then
                  work = work + 0.5_wp*list(i)%value(k)*(old%v(f, node) + new%v(f, node))*change(g, at)
               else
                  mean = 0.5_wp*(old%x(f, node) + new%x(f, node))
                  work = work + list(i)%value(k)*mean*change(g, at)
               end if
            end associate
         end do
      end do
   end function work_of_linear_forces

   !> Water that has left in a step through dashpots that act [m3], in proportion to the changes of the pressures. The
   !> row of p_w is that of both fluids, but for nodes whose air pressure is prescribed.
   pure real(wp) function water_through_dashpots(list, dofs, air, change) result(water)
      type(linear_forces_t), intent(in) :: list(:)
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: air(:)             !< (nodes) The air pressure is prescribed.
      real(wp), intent(in) :: change(:, :)      !< (FIELDS, nodes) Changes of the unknowns [m, kPa].
      integer :: i, k

      water = 0.0_wp
      do i = 1, size(list)
         if (.not. list(i)%acts .or. .not. list(i)%by_rates) cycle
         do k = 1, size(list(i)%row)
            associate (column => list(i)%column(k), row => list(i)%row(k), value => list(i)%value(k))
               if (dofs%field(row) == AT_P_W) then
                  water = water + value*change(dofs%field(column), dofs%node(column))
               else if (dofs%field(row) == AT_P_C .and. .not. air(dofs%node(row))) then
                  water = water - value*change(dofs%field(column), dofs%node(column))
               end if
            end associate
         end do
      end do
   end function water_through_dashpots
end module linear_forces
