! SPDX-License-Identifier: MIT
!> Reads Gmsh 4.1 text meshes of 6-node triangles; physical groups become groups of the mesh: by their names, or,
!> without one, by their dimension and number, as curve_7 (point_, surface_). A mesh lies in the plane x, y or x, z.
module gmsh_reader
   use exit_codes, only: EXIT_MESH
   use kinds, only: wp
   use triangle_mesh, only: mesh_t, add_group, NAME_LENGTH
   use faults, only: fault_t, raise, at_line
   use texts, only: short, whole, mark_length
   implicit none (type, external)
   private
   public :: read_gmsh

   integer, parameter :: LINE3 = 8, TRIANGLE6 = 9, POINT = 15   !< Gmsh's element types.
   integer, parameter :: QUADRILATERALS(3) = [3, 10, 16]        !< With 4, 9 and 8 nodes.
   real(wp), parameter :: FLAT = 1.0e-9_wp      !< Share of the mesh that a coordinate which does not vary may vary by.
   integer, parameter :: LONGEST = 4096
   real(wp), parameter :: FARTHEST = 1.0e15_wp   !< [m] Areas and Jacobians of such coordinates are still numbers.

   !> Name of a physical group.
   type :: physical_t
      integer :: dimension = 0, tag = 0
      character(NAME_LENGTH) :: name = ''
   end type physical_t

   !> Physical tags of a geometric entity.
   type :: entity_t
      integer :: dimension = 0, tag = 0
      integer, allocatable :: physical(:)
   end type entity_t

   !> The elements of one block of $Elements.
   type :: block_t
      integer :: dimension = 0, entity = 0, kind = 0
      integer, allocatable :: nodes(:, :)
   end type block_t

   type :: reader_t
      character(:), allocatable :: file
      integer :: unit = 0, line = 0
      integer :: bytes = 0   !< Size of the file: what it announces beyond is not there.
      character(LONGEST) :: text = ''
   end type reader_t
contains
   !> Reads a mesh; a fault names file, line, what is wrong and what is expected. x, y of Gmsh are r, z [m]. Fault
   !> EXIT_MESH: the file cannot be read, is no text of version 4.1, is damaged, or has no 6-node triangles.
   subroutine read_gmsh(file, mesh, fault)
      character(*), intent(in) :: file
      type(mesh_t), intent(out) :: mesh
      type(fault_t), intent(inout) :: fault
      type(reader_t) :: reader
      type(physical_t), allocatable :: names(:)
      type(entity_t), allocatable :: entities(:)
      type(block_t), allocatable :: blocks(:)
      integer, allocatable :: number_of(:)
      real(wp), allocatable :: xyz(:, :)
      integer :: status

      reader%file = file
      allocate (names(0), entities(0), blocks(0), number_of(0))
      open (newunit=reader%unit, file=file, status='old', action='read', iostat=status)
      if (status /= 0) then
         call raise(fault, EXIT_MESH, trim(file)//': the mesh file cannot be read; its path is relative to the scene.')
         return
      end if
      inquire (unit=reader%unit, size=reader%bytes)
      do while (fault%code == 0)
         read (reader%unit, '(a)', iostat=status) reader%text
         if (status /= 0) exit
         reader%line = reader%line + 1
         if (reader%line == 1) reader%text = reader%text(1 + mark_length(reader%text):)
         select case (trim(reader%text))
         case ('$MeshFormat')
            call read_format(reader, fault)
         case ('$PhysicalNames')
            call read_names(reader, names, fault)
         case ('$Entities')
            call read_entities(reader, entities, fault)
         case ('$PartitionedEntities')
            call wrong(reader, 'the mesh is partitioned', fault, 'mesh it again without -part and '// &
                       'Mesh.NbPartitions, or call gmsh.model.mesh.unpartition() in Python and write it')
         case ('$Nodes')
            call read_nodes(reader, xyz, number_of, fault)
         case ('$Elements')
            call read_elements(reader, number_of, blocks, fault)
         end select
      end do
      close (reader%unit)
      if (fault%code == 0 .and. .not. allocated(xyz)) call wrong(reader, 'there is no section $Nodes', fault)
      if (fault%code == 0) call find_plane(reader, xyz, mesh, fault)
      if (fault%code == 0) call name_others(entities, names)
      if (fault%code == 0) call collect_elements(reader, names, entities, blocks, mesh, fault)
   end subroutine read_gmsh

   !> Physical groups that the file gives no name are named by their dimension and number.
   subroutine name_others(entities, names)
      type(entity_t), intent(in) :: entities(:)
      type(physical_t), allocatable, intent(inout) :: names(:)
      character(7), parameter :: KINDS(0:3) = ['point  ', 'curve  ', 'surface', 'volume ']
      integer :: i, k, tag

      do i = 1, size(entities)
         do k = 1, size(entities(i)%physical)
            tag = abs(entities(i)%physical(k))
            if (any(names%dimension == entities(i)%dimension .and. names%tag == tag)) cycle
            names = [names, physical_t(entities(i)%dimension, tag, trim(KINDS(entities(i)%dimension))//'_'//whole(tag))]
         end do
      end do
   end subroutine name_others

   subroutine wrong(reader, what, fault, advice)
      type(reader_t), intent(in) :: reader
      character(*), intent(in) :: what
      type(fault_t), intent(inout) :: fault
      character(*), intent(in), optional :: advice
      character(:), allocatable :: remedy

      remedy = 'write the mesh with gmsh -2 -order 2 -format msh41'
      if (present(advice)) remedy = advice
      if (fault%code == 0) call raise(fault, EXIT_MESH, at_line(reader%file, reader%line)//what//'; '//remedy//'.')
   end subroutine wrong

   !> The plane of a mesh: x, y, or, where y does not vary and z does, x, z.
   subroutine find_plane(reader, xyz, mesh, fault)
      type(reader_t), intent(in) :: reader
      real(wp), intent(in) :: xyz(:, :)   !< (3, nodes) [m]
      type(mesh_t), intent(inout) :: mesh
      type(fault_t), intent(inout) :: fault
      real(wp) :: range(3)
      integer :: up

      range = 0.0_wp
      if (size(xyz, 2) > 0) range = maxval(xyz, dim=2) - minval(xyz, dim=2)
      up = 2
      if (range(2) <= FLAT*maxval(range)) up = 3
      if (range(5 - up) > FLAT*maxval(range) .or. range(1) <= FLAT*maxval(range)) then
         call raise(fault, EXIT_MESH, trim(reader%file)//': the mesh lies in no plane x, y or x, z: its nodes '// &
                    'extend '//short(range(1))//' m along x, '//short(range(2))//' along y, '//short(range(3))// &
                    ' along z; rotate it into one of them.')
         return
      end if
      mesh%x = xyz([1, up], :)
   end subroutine find_plane

   subroutine next(reader, fault)
      type(reader_t), intent(inout) :: reader
      type(fault_t), intent(inout) :: fault
      integer :: status

      read (reader%unit, '(a)', iostat=status) reader%text
      reader%line = reader%line + 1
      if (status /= 0) call wrong(reader, 'the file ends early', fault)
   end subroutine next

   !> The integers of the next line.
   subroutine integers(reader, values, fault)
      type(reader_t), intent(inout) :: reader
      integer, intent(out) :: values(:)
      type(fault_t), intent(inout) :: fault
      integer :: status

      values = 0
      call next(reader, fault)
      if (fault%code /= 0) return
      status = 1
      if (only_numbers(reader)) read (reader%text, *, iostat=status) values
      if (status /= 0) call wrong(reader, 'expected '//whole(size(values))//' integers', fault)
   end subroutine integers

   !> Whether the present line holds nothing but numbers: a slash or a star would end or repeat a list without an error.
   pure logical function only_numbers(reader)
      type(reader_t), intent(in) :: reader

      only_numbers = verify(trim(reader%text), '0123456789+-.eEdD '//achar(9)//achar(13)) == 0
   end function only_numbers

   !> A number of lines, or a largest tag, that the file announces: not below 0, and no more than it has bytes, so that
   !> a damaged number cannot ask for all memory.
   subroutine check_announced(reader, what, number, fault)
      type(reader_t), intent(in) :: reader
      character(*), intent(in) :: what
      integer, intent(in) :: number
      type(fault_t), intent(inout) :: fault

      if (number < 0 .or. number > reader%bytes) call wrong(reader, what//' is '//whole(number)// &
         ', allowed 0 to '//whole(reader%bytes)//', the bytes of the file', fault)
   end subroutine check_announced

   subroutine read_format(reader, fault)
      type(reader_t), intent(inout) :: reader
      type(fault_t), intent(inout) :: fault
      real(wp) :: version
      integer :: kind, status

      call next(reader, fault)
      read (reader%text, *, iostat=status) version, kind
      if (status /= 0) then
         call wrong(reader, 'the format cannot be read', fault)
      else if (abs(version - 4.1_wp) > 1.0e-6_wp .or. kind /= 0) then
         call wrong(reader, 'only text files of version 4.1 are understood', fault)
      end if
   end subroutine read_format

   subroutine read_names(reader, names, fault)
      type(reader_t), intent(inout) :: reader
      type(physical_t), allocatable, intent(inout) :: names(:)
      type(fault_t), intent(inout) :: fault
      type(physical_t) :: one
      integer :: head(1), i, status

      call integers(reader, head, fault)
      do i = 1, head(1)
         call next(reader, fault)
         if (fault%code /= 0) return
         read (reader%text, *, iostat=status) one%dimension, one%tag, one%name
         if (status /= 0) call wrong(reader, 'expected dimension, tag and "name"', fault)
         names = [names, one]
      end do
   end subroutine read_names

   subroutine read_entities(reader, entities, fault)
      type(reader_t), intent(inout) :: reader
      type(entity_t), allocatable, intent(inout) :: entities(:)
      type(fault_t), intent(inout) :: fault
      type(entity_t) :: one
      real(wp) :: box(6)
      integer :: counts(4), dimension, i, skip, tags, status

      call integers(reader, counts, fault)
      do dimension = 0, 3
         skip = merge(3, 6, dimension == 0)
         do i = 1, counts(dimension + 1)
            call next(reader, fault)
            if (fault%code /= 0) return
            one%dimension = dimension
            status = 1
            if (only_numbers(reader)) read (reader%text, *, iostat=status) one%tag, box(:skip), tags
            if (status == 0) call check_announced(reader, 'the number of physical groups of an entity', tags, fault)
            if (fault%code /= 0) return
            if (status == 0) then
               if (allocated(one%physical)) deallocate (one%physical)
               allocate (one%physical(tags))
               read (reader%text, *, iostat=status) one%tag, box(:skip), tags, one%physical
            end if
            if (status /= 0) call wrong(reader, 'an entity cannot be read', fault)
            entities = [entities, one]
         end do
      end do
   end subroutine read_entities

   subroutine read_nodes(reader, xyz, number_of, fault)
      type(reader_t), intent(inout) :: reader
      real(wp), allocatable, intent(inout) :: xyz(:, :)   !< (3, nodes) [m]
      integer, allocatable, intent(inout) :: number_of(:)   !< Tag to number.
      type(fault_t), intent(inout) :: fault
      integer :: head(4), block_head(4), b, i, used, status
      integer, allocatable :: tags(:)

      call integers(reader, head, fault)
      call check_announced(reader, 'the number of nodes', head(2), fault)
      call check_announced(reader, 'the largest node tag', head(4), fault)
      if (allocated(xyz)) call wrong(reader, 'there is a second section $Nodes', fault)
      if (fault%code /= 0) return
      allocate (xyz(3, head(2)), source=0.0_wp)
      deallocate (number_of)
      allocate (number_of(head(4)), source=0)
      used = 0
      do b = 1, head(1)
         call integers(reader, block_head, fault)
         if (fault%code == 0 .and. (block_head(4) < 0 .or. block_head(4) > head(2) - used)) &
            call wrong(reader, 'more nodes than announced', fault)
         if (fault%code /= 0) return
         if (allocated(tags)) deallocate (tags)
         allocate (tags(block_head(4)))
         do i = 1, size(tags)
            call integers(reader, tags(i:i), fault)
            if (fault%code == 0 .and. (tags(i) < 1 .or. tags(i) > head(4))) &
               call wrong(reader, 'a node tag is outside the announced range', fault)
         end do
         if (fault%code /= 0) return
         do i = 1, size(tags)
            call next(reader, fault)
            if (fault%code /= 0) return
            used = used + 1
            if (number_of(tags(i)) /= 0) call wrong(reader, 'node '//whole(tags(i))//' comes twice', fault)
            number_of(tags(i)) = used
            status = 1
            if (only_numbers(reader)) read (reader%text, *, iostat=status) xyz(:, used)
            if (status /= 0 .or. .not. all(abs(xyz(:, used)) <= FARTHEST)) &
               call wrong(reader, 'expected coordinates of at most '//short(FARTHEST)//' m', fault)
         end do
      end do
      if (used /= head(2)) call wrong(reader, 'fewer nodes than announced', fault)
   end subroutine read_nodes

   subroutine read_elements(reader, number_of, blocks, fault)
      type(reader_t), intent(inout) :: reader
      integer, intent(in) :: number_of(:)
      type(block_t), allocatable, intent(inout) :: blocks(:)
      type(fault_t), intent(inout) :: fault
      type(block_t) :: one
      integer :: head(4), block_head(4), b, i, n, used
      integer :: row(7)

      call integers(reader, head, fault)
      call check_announced(reader, 'the number of elements', head(2), fault)
      used = 0
      do b = 1, head(1)
         call integers(reader, block_head, fault)
         if (fault%code == 0 .and. (block_head(4) < 0 .or. block_head(4) > head(2) - used)) &
            call wrong(reader, 'more elements than announced', fault)
         if (fault%code /= 0) return
         used = used + block_head(4)
         select case (block_head(3))
         case (POINT)
            n = 1
         case (LINE3)
            n = 3
         case (TRIANGLE6)
            n = 6
         case default
            if (any(QUADRILATERALS == block_head(3))) call wrong(reader, 'the mesh has quadrilaterals', fault, &
               'mesh it without Recombine and Mesh.RecombineAll, or call setOrder(1), splitQuadrangles(), '// &
               'setOrder(2) of gmsh.model.mesh in Python and write it')
            call wrong(reader, 'elements of type '//whole(block_head(3))//' cannot be used: 6-node triangles and '// &
                       '3-node edges are', fault)
            return
         end select
         one%dimension = block_head(1)
         one%entity = block_head(2)
         one%kind = block_head(3)
         if (allocated(one%nodes)) deallocate (one%nodes)
         allocate (one%nodes(n, block_head(4)))
         do i = 1, block_head(4)
            call integers(reader, row(:n + 1), fault)
            if (fault%code /= 0) return
            if (any(row(2:n + 1) < 1 .or. row(2:n + 1) > size(number_of))) then
               call wrong(reader, 'an element refers to a node that does not exist', fault)
               return
            end if
            one%nodes(:, i) = number_of(row(2:n + 1))
            if (any(one%nodes(:, i) == 0)) call wrong(reader, 'an element refers to a node that does not exist', fault)
         end do
         blocks = [blocks, one]
      end do
      if (used /= head(2)) call wrong(reader, 'fewer elements than announced', fault)
      call next(reader, fault)
      if (fault%code == 0 .and. reader%text /= '$EndElements') &
         call wrong(reader, 'expected $EndElements after the last element', fault)
   end subroutine read_elements

   !> Collects triangles, turns clockwise ones, and makes a group of every physical name.
   subroutine collect_elements(reader, names, entities, blocks, mesh, fault)
      type(reader_t), intent(in) :: reader
      type(physical_t), intent(in) :: names(:)
      type(entity_t), intent(in) :: entities(:)
      type(block_t), intent(in) :: blocks(:)
      type(mesh_t), intent(inout) :: mesh
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: first(:), elements(:), edges(:, :), nodes(:)
      integer :: b, i, k, total

      total = 0
      allocate (first(size(blocks)), source=0)
      do b = 1, size(blocks)
         if (blocks(b)%kind /= TRIANGLE6) cycle
         first(b) = total + 1
         total = total + size(blocks(b)%nodes, 2)
      end do
      if (total == 0) then
         call wrong(reader, 'the mesh has no 6-node triangles', fault)
         return
      end if
      allocate (mesh%t6(6, total))
      do b = 1, size(blocks)
         do i = 1, size(blocks(b)%nodes, 2)
            if (blocks(b)%kind == TRIANGLE6) &
               mesh%t6(:, first(b) + i - 1) = counter_clockwise(mesh, blocks(b)%nodes(:, i))
         end do
      end do
      allocate (edges(3, 0))
      call add_group(mesh, 'all', [(i, i=1, total)], edges, [integer ::])
      do k = 1, size(names)
         ! Those of one name and dimension are one group.
         if (any(names(:k - 1)%name == names(k)%name .and. names(:k - 1)%dimension == names(k)%dimension)) cycle
         elements = [integer ::]
         nodes = [integer ::]
         edges = reshape([integer ::], [3, 0])
         do b = 1, size(blocks)
            if (.not. has_tag(blocks(b), names(k))) cycle
            select case (blocks(b)%kind)
            case (TRIANGLE6)
               elements = [elements, [(first(b) + i - 1, i=1, size(blocks(b)%nodes, 2))]]
            case (LINE3)
               edges = reshape([edges, blocks(b)%nodes], [3, size(edges, 2) + size(blocks(b)%nodes, 2)])
            case default
               nodes = [nodes, blocks(b)%nodes(1, :)]
            end select
         end do
         call orient(mesh, edges)
         if (names(k)%name /= 'all') then
            call add_group(mesh, trim(names(k)%name), elements, edges, nodes)
         else if (size(elements) < total) then
            call raise(fault, EXIT_MESH, trim(reader%file)//': a physical group is called ''all'' and has not all '// &
                       'triangles, which is what a scene calls so; give it another name.')
            return
         end if
      end do
   contains
      pure logical function has_tag(one, name)
         type(block_t), intent(in) :: one
         type(physical_t), intent(in) :: name
         integer :: e, n

         has_tag = .false.
         if (one%dimension /= name%dimension) return
         do e = 1, size(entities)
            if (entities(e)%dimension == one%dimension .and. entities(e)%tag == one%entity) &
               has_tag = any([(any(abs(entities(e)%physical) == names(n)%tag .and. names(n)%name == name%name .and. &
                                   names(n)%dimension == name%dimension), n=1, size(names))])
         end do
      end function has_tag
   end subroutine collect_elements

   pure function counter_clockwise(mesh, nodes) result(turned)
      type(mesh_t), intent(in) :: mesh
      integer, intent(in) :: nodes(6)
      integer :: turned(6)
      real(wp) :: a(2), b(2)

      a = mesh%x(:, nodes(2)) - mesh%x(:, nodes(1))
      b = mesh%x(:, nodes(3)) - mesh%x(:, nodes(1))
      turned = nodes
      if (a(1)*b(2) - a(2)*b(1) < 0.0_wp) turned = nodes([1, 3, 2, 6, 5, 4])
   end function counter_clockwise

   !> Turns edges so that their triangle lies on the left.
   subroutine orient(mesh, edges)
      type(mesh_t), intent(in) :: mesh
      integer, intent(inout) :: edges(:, :)
      integer, allocatable :: forward(:)
      integer :: e, k, side(3)

      ! forward(m): first vertex of the triangle side with middle node m, counter-clockwise.
      allocate (forward(size(mesh%x, 2)), source=0)
      do e = 1, size(mesh%t6, 2)
         do k = 1, 3
            side = mesh%t6([k, mod(k, 3) + 1, k + 3], e)
            if (forward(side(3)) == 0) forward(side(3)) = side(1)
         end do
      end do
      do k = 1, size(edges, 2)
         if (forward(edges(3, k)) == edges(2, k)) edges(1:2, k) = edges([2, 1], k)
      end do
   end subroutine orient
end module gmsh_reader
