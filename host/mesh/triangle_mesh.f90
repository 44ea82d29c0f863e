! SPDX-License-Identifier: MIT
!> Mesh of 6-node triangles with named regions and boundaries.
module triangle_mesh
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: mesh_t, group_of_t, NAME_LENGTH, find_group, add_group, nodes_of, sides_of, &
             triangles_beside

   integer, parameter :: NAME_LENGTH = 64

   !> A named set: elements of a region, or edges of a boundary, or single nodes.
   type :: group_of_t
      character(NAME_LENGTH) :: name = ''
      integer, allocatable :: elements(:)   !< Triangles.
      integer, allocatable :: edges(:, :)   !< (3, n) vertex, vertex, middle; the body lies on the left.
      integer, allocatable :: nodes(:)      !< Every node of the group, ascending.
   end type group_of_t

   type :: mesh_t
      real(wp), allocatable :: x(:, :)      !< (2, nodes): r and z, or x and y [m]
      integer, allocatable :: t6(:, :)      !< (6, elements)
      type(group_of_t), allocatable :: groups(:)
   end type mesh_t
contains
   !> Finds the place of a group, 0 if there is none of that name.
   pure integer function find_group(mesh, name) result(place)
      type(mesh_t), intent(in) :: mesh
      character(*), intent(in) :: name

      place = findloc(mesh%groups%name == name, .true., dim=1)
   end function find_group

   !> Adds a group of what is given, and lists its nodes.
   subroutine add_group(mesh, name, elements, edges, nodes)
      type(mesh_t), intent(inout) :: mesh
      character(*), intent(in) :: name
      integer, intent(in), optional :: elements(:), edges(:, :), nodes(:)   !< (n), (3, n), (n): see group_of_t.
      type(group_of_t) :: group
      logical :: member(size(mesh%x, 2))
      integer :: i

      group%name = name
      allocate (group%elements(0), group%edges(3, 0))
      if (present(elements)) group%elements = elements
      if (present(edges)) group%edges = edges
      member = .false.
      if (present(nodes)) member(nodes) = .true.
      member([mesh%t6(:, group%elements)]) = .true.
      member([group%edges]) = .true.
      group%nodes = pack([(i, i=1, size(member))], member)
      if (.not. allocated(mesh%groups)) allocate (mesh%groups(0))
      mesh%groups = [mesh%groups, group]
   end subroutine add_group

   !> Marks the nodes of some elements. (nodes)
   pure function nodes_of(mesh, elements) result(there)
      type(mesh_t), intent(in) :: mesh
      logical, intent(in) :: elements(:)
      logical :: there(size(mesh%x, 2))
      integer :: e

      there = .false.
      do e = 1, size(elements)
         if (elements(e)) there(mesh%t6(:, e)) = .true.
      end do
   end function nodes_of

   !> Lists the three sides of every triangle, as edges that have it on their left. (3, 3 elements)
   pure function sides_of(t6) result(sides)
      integer, intent(in) :: t6(:, :)   !< (6, elements)
      integer :: sides(3, 3*size(t6, 2))

      sides = reshape(t6([1, 2, 4, 2, 3, 5, 3, 1, 6], :), shape(sides))
   end function sides_of

   !> Triangles on the left and on the right of edges, 0: there is none. An edge is known by its middle node. (2, edges)
   pure function triangles_beside(t6, edges) result(beside)
      integer, intent(in) :: t6(:, :), edges(:, :)   !< (6, elements), (3, edges)
      integer :: beside(2, size(edges, 2))
      integer, allocatable :: both(:, :), begins(:)   !< Triangles at a middle node; where the side begins in the first.
      integer :: e, k, n

      n = max(maxval(t6), maxval(edges))
      allocate (both(2, n), begins(n), source=0)
      do e = 1, size(t6, 2)
         do k = 1, 3
            associate (middle => t6(k + 3, e))
               both(merge(1, 2, both(1, middle) == 0), middle) = e
               if (both(2, middle) == 0) begins(middle) = t6(k, e)
            end associate
         end do
      end do
      do k = 1, size(edges, 2)
         associate (middle => edges(3, k))
            beside(:, k) = both(merge([1, 2], [2, 1], begins(middle) == edges(1, k)), middle)
         end associate
      end do
   end function triangles_beside
end module triangle_mesh
