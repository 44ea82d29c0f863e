! SPDX-License-Identifier: MIT
!> Dashpots on a boundary: forces in proportion to velocities, and outflow in proportion to the rates of the pressures,
!> through which waves leave the mesh. Without them nothing is allocated and nothing is done.
!> docs/theory/host.md section 7.4.
module dashpots
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use generalised_alpha, only: scheme_t
   use porous_domain, only: state_t
   use sparsity_pattern, only: pattern_t, place_of
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: dashpots_t, add_dashpots, work_of_dashpots, water_through_dashpots

   type :: dashpots_t
      logical :: acts = .false.                  !< In the step under way.
      integer, allocatable :: row(:), column(:)  !< Unknowns of an entry.
      real(wp), allocatable :: value(:)          !< Entry: force over velocity [kN s/m], outflow over rate [m3/kPa].
   end type dashpots_t
contains
   !> Adds forces and outflow at the levels of their rates, and the slopes. docs/theory/host.md section 7.4. Nothing in
   !> steps that are not dynamic. Into residual and scale [kN, m3/s] and the matrix, whose pattern must have their
   !> places.
   subroutine add_dashpots(list, dofs, pattern, scheme, old, new, slopes, assembly)
      type(dashpots_t), intent(in) :: list(:)   !< (dashpots)
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(scheme_t), intent(in) :: scheme
      type(state_t), intent(in) :: old, new
      logical, intent(in) :: slopes
      type(assembly_t), intent(inout) :: assembly
      real(wp) :: force, level, slope
      integer :: i, k, f, node, place

      if (.not. scheme%has_inertia) return
      do i = 1, size(list)
         if (.not. list(i)%acts) cycle
         associate (row => list(i)%row, column => list(i)%column, value => list(i)%value)
            do k = 1, size(row)
               f = dofs%field(column(k))
               node = dofs%node(column(k))
               level = merge(scheme%l_v, scheme%l_p, f <= DISPLACEMENTS)
               slope = merge(scheme%c_v, scheme%c_p, f <= DISPLACEMENTS)
               force = value(k)*(old%v(f, node) + level*(new%v(f, node) - old%v(f, node)))
               assembly%residual(row(k)) = assembly%residual(row(k)) + force
               assembly%scale(row(k)) = assembly%scale(row(k)) + abs(force)
               if (.not. slopes) cycle
               place = place_of(pattern, row(k), column(k))
               assembly%values(place) = assembly%values(place) + slope*value(k)
            end do
         end associate
      end do
   end subroutine add_dashpots

   !> Work that the acting dashpots take out of a step, by the mean of the velocities at its ends, at given
   !> displacements [kJ]. docs/theory/host.md section 9. Their outflow does no work.
   pure real(wp) function work_of_dashpots(list, dofs, old, new, change) result(work)
      type(dashpots_t), intent(in) :: list(:)   !< (dashpots)
      type(dofs_t), intent(in) :: dofs
      type(state_t), intent(in) :: old, new
      real(wp), intent(in) :: change(:, :)   !< (2, nodes) [m]
      integer :: i, k

      work = 0.0_wp
      do i = 1, size(list)
         if (.not. list(i)%acts) cycle
         do k = 1, size(list(i)%row)
            associate (f => dofs%field(list(i)%column(k)), node => dofs%node(list(i)%column(k)), &
                       g => dofs%field(list(i)%row(k)), at => dofs%node(list(i)%row(k)))
               if (f > DISPLACEMENTS) cycle
               work = work + 0.5_wp*list(i)%value(k)*(old%v(f, node) + new%v(f, node))*change(g, at)
            end associate
         end do
      end do
   end function work_of_dashpots

   !> Water that has left in a step through those that act [m3], in proportion to the changes of the pressures. The row
   !> of p_w is that of both fluids, but for nodes whose air pressure is prescribed.
   pure real(wp) function water_through_dashpots(list, dofs, air, change) result(water)
      type(dashpots_t), intent(in) :: list(:)   !< (boundaries with dashpots)
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: air(:)             !< (nodes) The air pressure is prescribed.
      real(wp), intent(in) :: change(:, :)      !< (FIELDS, nodes) Of the unknowns [m, kPa].
      integer :: i, k

      water = 0.0_wp
      do i = 1, size(list)
         if (.not. list(i)%acts) cycle
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
end module dashpots
