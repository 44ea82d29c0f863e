! SPDX-License-Identifier: MIT
!> Vectors of the loads at a factor of 1, and the nodes that move together: made once, from the mesh.
module load_shapes
   use acting_places, only: facing_edges
   use degrees_of_freedom, only: tie_pairs
   use given_pressures, only: edges_with_flow
   use kinds, only: wp
   use model_types, only: model_t, load_t, value_at
   use porous_domain, only: edge_point_t, points_of_edge, PER_EDGE
   use scene_parts, only: LOAD_PRESSURE, LOAD_SHEAR_R, LOAD_SHEAR_Z, LOAD_WATER, LOAD_AIR, LOAD_FORCE_R
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_U_R, AT_U_Z, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: integrate_loads, ties_of
contains
   !> Finds nodes that plates make move together: those of the boundaries that share their u_z. And those of &tie.
   !> (FIELDS, nodes), as number_unknowns takes them: docs/theory/host.md sections 7.3 and 7.6.
   function ties_of(model) result(ties)
      type(model_t), intent(in) :: model
      integer, allocatable :: ties(:, :)
      integer :: i

      allocate (ties(FIELDS, size(model%domain%mesh%x, 2)), source=0)
      do i = 1, size(model%plates)
         if (model%plates(i)%group == 0 .or. model%plates(i)%penalty > 0.0_wp) cycle
         associate (nodes => model%domain%mesh%groups(model%plates(i)%group)%nodes)
            ties(AT_U_Z, nodes) = minval(nodes)
         end associate
      end do
      do i = 1, size(model%ties)
         call tie_pairs(model%ties(i)%pairs, merge(FIELDS, DISPLACEMENTS, model%ties(i)%pressures), ties)
      end do
   end function ties_of

   !> Vectors of all loads. docs/theory/host.md section 7.2.
   subroutine integrate_loads(model)
      type(model_t), intent(inout) :: model
      integer :: i

      do i = 1, size(model%loads)
         model%loads(i)%vector = vector_of(model, model%loads(i))
      end do
   end subroutine integrate_loads

   !> Integrates a load at a factor of 1. (unknowns) [kN, m3/s]
   function vector_of(model, load) result(vector)
      type(model_t), intent(in) :: model
      type(load_t), intent(in) :: load
      real(wp) :: vector(model%dofs%n)
      logical :: acts(size(model%domain%mesh%groups(load%group)%edges, 2))
      integer, allocatable :: edges(:, :)
      integer :: e, k, f

      vector = 0.0_wp
      associate (group => model%domain%mesh%groups(load%group))
         if (load%kind < LOAD_FORCE_R) then
            acts = .true.
            if (load%flows) acts = edges_with_flow(model%domain, load%group)
            edges = facing_edges(model, load%group, load%in_stage)
            do e = 1, size(edges, 2)
               if (.not. acts(e)) cycle
               call add_edge(model, edges(:, e), load, vector)
            end do
         else
            f = merge(AT_U_R, AT_U_Z, load%kind == LOAD_FORCE_R)
            do k = 1, size(group%nodes)
               associate (at => model%dofs%of(f, group%nodes(k)))
                  if (at > 0) vector(at) = vector(at) + value_at(load, model%domain%mesh%x(2, group%nodes(k)))
               end associate
            end do
         end if
      end associate
   end function vector_of

   !> Adds a load on an edge; its body lies on the left, so that the outward normal is the tangent turned right.
   subroutine add_edge(model, edge, load, vector)
      type(model_t), intent(in) :: model
      integer, intent(in) :: edge(3)
      type(load_t), intent(in) :: load
      real(wp), intent(inout) :: vector(:)
      type(edge_point_t) :: points(PER_EDGE)
      real(wp) :: along(FIELDS), extent   !< What a value acts on: shares of the extent of the point [m or m2].
      real(wp) :: value
      integer :: g, i, f

      points = points_of_edge(model%domain, edge)
      do g = 1, PER_EDGE
         associate (n => points(g)%n, m => points(g)%m, tangent => points(g)%tangent, area => points(g)%area, &
                    ring => points(g)%ring)
            along = 0.0_wp
            value = value_at(load, points(g)%x(2))
            extent = merge(ring, area, load%kind == LOAD_PRESSURE .or. load%falls)
            select case (load%kind)
            case (LOAD_PRESSURE)
               along(AT_U_R:AT_U_Z) = [-tangent(2), tangent(1)]
            case (LOAD_SHEAR_R)
               along(AT_U_R) = 1.0_wp
            case (LOAD_SHEAR_Z)
               along(AT_U_Z) = 1.0_wp
            case (LOAD_WATER)
               along(AT_P_W) = merge(max(0.0_wp, -tangent(1)), 1.0_wp, load%falls)
            case (LOAD_AIR)
               along(AT_P_W:AT_P_C) = 1.0_wp
            end select
            do i = 1, 3
               do f = 1, FIELDS
                  associate (at => model%dofs%of(f, edge(i)))
                     if (at > 0) vector(at) = vector(at) + merge(n(i), m(i), f <= DISPLACEMENTS)*along(f)*extent*value
                  end associate
               end do
            end do
         end associate
      end do
   end subroutine add_edge
end module load_shapes
