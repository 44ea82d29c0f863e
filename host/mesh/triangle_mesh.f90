! SPDX-License-Identifier: MIT
!> Mesh of 6-node triangles with named regions and boundaries.
module triangle_mesh
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: mesh_t, group_of_t, NAME_LENGTH, find_group, add_group

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
   !> Place of a group, 0 if there is none of that name.
   pure integer function find_group(mesh, name) result(place)
      type(mesh_t), intent(in) :: mesh
      character(*), intent(in) :: name

      do place = 1, size(mesh%groups)
         if (mesh%groups(place)%name == name) return
      end do
      place = 0
   end function find_group

   !> Adds a group and lists its nodes.
   subroutine add_group(mesh, name, elements, edges, nodes)
      type(mesh_t), intent(inout) :: mesh
      character(*), intent(in) :: name
      integer, intent(in) :: elements(:), edges(:, :), nodes(:)   !< (n), (3, n), (n): see group_of_t.
      type(group_of_t) :: group
      logical, allocatable :: member(:)
      integer :: i

      allocate (member(size(mesh%x, 2)), source=.false.)
      do i = 1, size(elements)
         member(mesh%t6(:, elements(i))) = .true.
      end do
      do i = 1, size(edges, 2)
         member(edges(:, i)) = .true.
      end do
      member(nodes) = .true.
      group%name = name
      group%elements = elements
      group%edges = edges
      group%nodes = pack([(i, i=1, size(member))], member)
      if (.not. allocated(mesh%groups)) allocate (mesh%groups(0))
      mesh%groups = [mesh%groups, group]
   end subroutine add_group
end module triangle_mesh
