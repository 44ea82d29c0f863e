! SPDX-License-Identifier: MIT
!> What a mesh may have that no element sees: loads on nodes of no element, and nodes at one place that nothing joins.
module mesh_look
   use kinds, only: wp
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise
   use warnings, only: print_warning
   use model_types, only: model_t, action_t
   use scene_parts, only: place_of
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: check_carried, look_at_slits

   real(wp), parameter :: SAME_PLACE = 1.0e-6_wp   !< Share of the extent of the mesh.
contains
   !> Fault EXIT_GROUP: something acts on a node of no element, or a support on such nodes alone.
   subroutine check_carried(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      logical :: carried(size(model%domain%mesh%x, 2))
      integer :: i

      carried = .false.
      carried(reshape(model%domain%mesh%t6, [size(model%domain%mesh%t6)])) = .true.
      carried(model%domain%bodies) = .true.
      do i = 1, size(model%actions)
         if (model%actions(i)%group > 0) call look(model%actions(i))
      end do
   contains
      subroutine look(item)
         type(action_t), intent(in) :: item
         integer :: k

         if (fault%code /= 0) return
         associate (mesh => model%domain%mesh, nodes => model%domain%mesh%groups(item%group)%nodes)
            if (all(carried(nodes)) .or. (item%supports .and. any(carried(nodes)))) return
            k = nodes(findloc(carried(nodes), .false., dim=1))
            call raise(fault, EXIT_GROUP, place_of(item)//whole(count(.not. carried(nodes)))//' of the '// &
                       whole(size(nodes))//' nodes of group '''//trim(mesh%groups(item%group)%name)// &
                       ''' belong to no element, the first at ('//short(mesh%x(1, k))//', '//short(mesh%x(2, k))// &
                       ') m: nothing acts there; embed the point or curve in its surface in Gmsh, or name another '// &
                       'group.')
         end associate
      end subroutine look
   end subroutine check_carried

   !> Warns of boundary nodes at one place that no contact, tie or plate joins.
   subroutine look_at_slits(model)
      type(model_t), intent(in) :: model
      integer, allocatable :: outer(:)
      real(wp) :: near
      integer :: i, k, pairs, first

      outer = pack([(i, i=1, size(model%domain%mesh%x, 2))], are_outside(model))
      pairs = 0
      first = 0
      associate (x => model%domain%mesh%x)
         near = SAME_PLACE*maxval([(maxval(x(i, outer)) - minval(x(i, outer)), i=1, 2)])
         do i = 2, size(outer)
            do k = 1, i - 1
               if (abs(x(1, outer(i)) - x(1, outer(k))) > near) cycle
               if (abs(x(2, outer(i)) - x(2, outer(k))) > near) cycle
               if (are_joined(model, outer(i), outer(k))) cycle
               if (first == 0) first = outer(i)
               pairs = pairs + 1
            end do
         end do
         if (pairs > 0) call print_warning('The mesh has '//whole(pairs)//' pairs of boundary nodes at one place '// &
            'that nothing joins, the first at ('//short(x(1, first))//', '//short(x(2, first))//') m: the ground '// &
            'is slit there. Merge them (Coherence in Gmsh, or gmsh.model.mesh.removeDuplicateNodes()), or give a '// &
            '&contact or &tie between the two sides.')
      end associate
   end subroutine look_at_slits

   !> Nodes on sides that one triangle alone has. (nodes)
   pure function are_outside(model) result(outside)
      type(model_t), intent(in) :: model
      logical :: outside(size(model%domain%mesh%x, 2))
      integer :: users(size(outside)), e, k

      users = 0
      outside = .false.
      associate (t6 => model%domain%mesh%t6)
         do e = 1, size(t6, 2)
            users(t6(4:6, e)) = users(t6(4:6, e)) + 1
         end do
         do e = 1, size(t6, 2)
            do k = 1, 3
               if (users(t6(k + 3, e)) == 1) outside(t6([k, mod(k, 3) + 1, k + 3], e)) = .true.
            end do
         end do
      end associate
   end function are_outside

   pure logical function are_joined(model, a, b)
      type(model_t), intent(in) :: model
      integer, intent(in) :: a, b   !< Nodes.
      integer :: i

      are_joined = .true.
      associate (groups => model%domain%mesh%groups)
         do i = 1, size(model%contacts)
            associate (slave => groups(model%contacts(i)%slave)%nodes, master => groups(model%contacts(i)%master)%nodes)
               if (any(slave == a) .and. any(master == b)) return
               if (any(slave == b) .and. any(master == a)) return
            end associate
         end do
         do i = 1, size(model%ties)
            associate (one => model%ties(i)%pairs(1, :), other => model%ties(i)%pairs(2, :))
               if (any((one == a .and. other == b) .or. (one == b .and. other == a))) return
            end associate
         end do
         do i = 1, size(model%plates)
            if (model%plates(i)%group == 0) cycle
            associate (nodes => groups(model%plates(i)%group)%nodes)
               if (any(nodes == a) .and. any(nodes == b)) return
            end associate
         end do
      end associate
      are_joined = .false.
   end function are_joined
end module mesh_look
