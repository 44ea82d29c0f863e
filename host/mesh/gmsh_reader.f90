! SPDX-License-Identifier: MIT
!> Reads Gmsh 4.1 text meshes of 6-node triangles; physical groups become groups of the mesh: by their names, or,
!> without one, by their dimension and number, as curve_7 (point_, surface_). A mesh lies in the plane x, y or x, z.
module gmsh_reader
   use exit_codes, only: EXIT_MESH
   use kinds, only: wp
   use triangle_mesh, only: mesh_t, add_group, triangles_beside, NAME_LENGTH
   use faults, only: fault_t, raise, at_line
   use texts, only: short, whole, mark_length
   implicit none (type, external)
   private
   public :: read_gmsh

   integer, parameter :: LINE3 = 8, TRIANGLE6 = 9, POINT = 15   !< Gmsh's element types.
   integer, parameter :: KINDS(3) = [POINT, LINE3, TRIANGLE6], NODES_OF(3) = [1, 3, 6]
   integer, parameter :: QUADRILATERALS(3) = [3, 10, 16]        !< With 4, 9 and 8 nodes.
   real(wp), parameter :: FLAT = 1.0e-9_wp      !< Share of the mesh that a coordinate which does not vary may vary by.
   integer, parameter :: LONGEST = 4096
   real(wp), parameter :: FARTHEST = 1.0e15_wp   !< [m] Areas and Jacobians of such coordinates are still numbers.

   !> A physical group: its name, or that a geometric entity belongs to it.
   type :: physical_t
      integer :: dimension = 0, tag = 0, entity = 0
      character(NAME_LENGTH) :: name = ''
   end type physical_t

   !> The elements of one block of $Elements.
   type :: block_t
      integer :: dimension = 0, entity = 0, kind = 0
      integer, allocatable :: nodes(:, :)
   end type block_t

   !> A mesh file and what has been read of it.
   type :: reader_t
      character(:), allocatable :: file
      integer :: unit = 0, line = 0
      integer :: bytes = 0   !< Size of the file: what it announces beyond is not there.
      character(LONGEST) :: text = ''   !< The present line.
      type(fault_t) :: fault   !< The first.
      type(physical_t), allocatable :: names(:), members(:)
      real(wp), allocatable :: xyz(:, :)      !< (3, nodes) [m]
      integer, allocatable :: number_of(:)    !< Tag to number of a node.
      type(block_t), allocatable :: blocks(:)
   end type reader_t
contains
   !> Reads a mesh; a fault names file, line, what is wrong and what is expected. x, y of Gmsh are r, z [m]. Fault
   !> EXIT_MESH: the file cannot be read, is no text of version 4.1, is damaged, or has no 6-node triangles.
   subroutine read_gmsh(file, mesh, fault)
      character(*), intent(in) :: file
      type(mesh_t), intent(out) :: mesh
      type(fault_t), intent(inout) :: fault
      type(reader_t) :: g
      integer :: status

      g%file = file
      allocate (g%names(0), g%members(0), g%blocks(0), g%number_of(0))
      open (newunit=g%unit, file=file, status='old', action='read', iostat=status)
      if (status /= 0) then
         call raise(fault, EXIT_MESH, trim(file)//': the mesh file cannot be read; its path is relative to the scene.')
         return
      end if
      inquire (unit=g%unit, size=g%bytes)
      do while (g%fault%code == 0)
         read (g%unit, '(a)', iostat=status) g%text
         if (status /= 0) exit
         g%line = g%line + 1
         if (g%line == 1) g%text = g%text(1 + mark_length(g%text):)
         select case (trim(g%text))
         case ('$MeshFormat')
            call read_format(g)
         case ('$PhysicalNames')
            call read_names(g)
         case ('$Entities')
            call read_entities(g)
         case ('$PartitionedEntities')
            call wrong(g, 'the mesh is partitioned', 'mesh it again without -part and Mesh.NbPartitions, or call '// &
                       'gmsh.model.mesh.unpartition() in Python and write it')
         case ('$Nodes')
            call read_nodes(g)
         case ('$Elements')
            call read_elements(g)
         end select
      end do
      close (g%unit)
      if (.not. allocated(g%xyz)) call wrong(g, 'there is no section $Nodes')
      if (g%fault%code == 0) call find_plane(g, mesh)
      if (g%fault%code == 0) call collect_elements(g, mesh)
      if (g%fault%code /= 0) fault = g%fault
   end subroutine read_gmsh

   subroutine wrong(g, what, advice)
      type(reader_t), intent(inout) :: g
      character(*), intent(in) :: what
      character(*), intent(in), optional :: advice
      character(:), allocatable :: remedy

      remedy = 'write the mesh with gmsh -2 -order 2 -format msh41'
      if (present(advice)) remedy = advice
      if (g%fault%code == 0) call raise(g%fault, EXIT_MESH, at_line(g%file, g%line)//what//'; '//remedy//'.')
   end subroutine wrong

   !> Finds the plane of a mesh: x, y, or, where y does not vary and z does, x, z.
   subroutine find_plane(g, mesh)
      type(reader_t), intent(inout) :: g
      type(mesh_t), intent(inout) :: mesh
      real(wp) :: range(3)
      integer :: up

      range = 0.0_wp
      if (size(g%xyz, 2) > 0) range = maxval(g%xyz, dim=2) - minval(g%xyz, dim=2)
      up = 2
      if (range(2) <= FLAT*maxval(range)) up = 3
      if (range(5 - up) > FLAT*maxval(range) .or. range(1) <= FLAT*maxval(range)) then
         call raise(g%fault, EXIT_MESH, trim(g%file)//': the mesh lies in no plane x, y or x, z: its nodes extend '// &
                    short(range(1))//' m along x, '//short(range(2))//' along y, '//short(range(3))//' along z; '// &
                    'rotate it into one of them.')
         return
      end if
      mesh%x = g%xyz([1, up], :)
   end subroutine find_plane

   subroutine next(g)
      type(reader_t), intent(inout) :: g
      integer :: status

      read (g%unit, '(a)', iostat=status) g%text
      g%line = g%line + 1
      if (status /= 0) call wrong(g, 'the file ends early')
   end subroutine next

   !> Reads the integers of the next line.
   subroutine integers(g, values)
      type(reader_t), intent(inout) :: g
      integer, intent(out) :: values(:)
      integer :: status

      values = 0
      call next(g)
      status = 1
      if (only_numbers(g)) read (g%text, *, iostat=status) values
      if (status /= 0) call wrong(g, 'expected '//whole(size(values))//' integers')
   end subroutine integers

   !> Whether the present line holds nothing but numbers: a slash or a star would end or repeat a list without an error.
   pure logical function only_numbers(g)
      type(reader_t), intent(in) :: g

      only_numbers = verify(trim(g%text), '0123456789+-.eEdD '//achar(9)//achar(13)) == 0
   end function only_numbers

   !> Reads a number of lines, or a largest tag, that the file announces: not below 0, and no more than it has bytes, so
   !> that a damaged number cannot ask for all memory.
   subroutine check_announced(g, what, number)
      type(reader_t), intent(inout) :: g
      character(*), intent(in) :: what
      integer, intent(in) :: number

      if (number < 0 .or. number > g%bytes) call wrong(g, what//' is '//whole(number)//', allowed 0 to '// &
                                                       whole(g%bytes)//', the bytes of the file')
   end subroutine check_announced

   subroutine read_format(g)
      type(reader_t), intent(inout) :: g
      real(wp) :: version
      integer :: kind, status

      call next(g)
      read (g%text, *, iostat=status) version, kind
      if (status /= 0) then
         call wrong(g, 'the format cannot be read')
      else if (abs(version - 4.1_wp) > 1.0e-6_wp .or. kind /= 0) then
         call wrong(g, 'only text files of version 4.1 are understood')
      end if
   end subroutine read_format

   subroutine read_names(g)
      type(reader_t), intent(inout) :: g
      type(physical_t) :: one
      integer :: head(1), i, status

      call integers(g, head)
      do i = 1, head(1)
         call next(g)
         read (g%text, *, iostat=status) one%dimension, one%tag, one%name
         if (status /= 0) call wrong(g, 'expected dimension, tag and "name"')
         if (g%fault%code /= 0) return
         g%names = [g%names, one]
      end do
   end subroutine read_names

   !> Lists the entities that belong to physical groups.
   subroutine read_entities(g)
      type(reader_t), intent(inout) :: g
      integer, allocatable :: physical(:)
      real(wp) :: box(6)
      integer :: counts(4), dimension, entity, i, k, skip, tags, status

      call integers(g, counts)
      do dimension = 0, 3
         skip = merge(3, 6, dimension == 0)
         do i = 1, counts(dimension + 1)
            call next(g)
            status = 1
            if (only_numbers(g)) read (g%text, *, iostat=status) entity, box(:skip), tags
            if (status == 0) call check_announced(g, 'the number of physical groups of an entity', tags)
            if (g%fault%code /= 0) return
            if (status == 0) then
               physical = spread(0, 1, tags)
               read (g%text, *, iostat=status) entity, box(:skip), tags, physical
            end if
            if (status /= 0) call wrong(g, 'an entity cannot be read')
            if (status /= 0) return
            g%members = [g%members, (physical_t(dimension, abs(physical(k)), entity), k=1, tags)]
         end do
      end do
   end subroutine read_entities

   subroutine read_nodes(g)
      type(reader_t), intent(inout) :: g
      integer :: head(4), block_head(4), b, i, used, status
      integer, allocatable :: tags(:)

      call integers(g, head)
      call check_announced(g, 'the number of nodes', head(2))
      call check_announced(g, 'the largest node tag', head(4))
      if (allocated(g%xyz)) call wrong(g, 'there is a second section $Nodes')
      if (g%fault%code /= 0) return
      allocate (g%xyz(3, head(2)), source=0.0_wp)
      g%number_of = spread(0, 1, head(4))
      used = 0
      do b = 1, head(1)
         call integers(g, block_head)
         if (block_head(4) < 0 .or. block_head(4) > head(2) - used) call wrong(g, 'more nodes than announced')
         if (g%fault%code /= 0) return
         tags = spread(0, 1, block_head(4))
         do i = 1, size(tags)
            call integers(g, tags(i:i))
            if (tags(i) < 1 .or. tags(i) > head(4)) call wrong(g, 'a node tag is outside the announced range')
            if (g%fault%code /= 0) return
         end do
         do i = 1, size(tags)
            call next(g)
            used = used + 1
            if (g%number_of(tags(i)) /= 0) call wrong(g, 'node '//whole(tags(i))//' comes twice')
            g%number_of(tags(i)) = used
            status = 1
            if (only_numbers(g)) read (g%text, *, iostat=status) g%xyz(:, used)
            if (status /= 0 .or. .not. all(abs(g%xyz(:, used)) <= FARTHEST)) &
               call wrong(g, 'expected coordinates of at most '//short(FARTHEST)//' m')
            if (g%fault%code /= 0) return
         end do
      end do
      if (used /= head(2)) call wrong(g, 'fewer nodes than announced')
   end subroutine read_nodes

   subroutine read_elements(g)
      type(reader_t), intent(inout) :: g
      type(block_t) :: one
      integer :: head(4), block_head(4), row(7), b, i, n, used

      call integers(g, head)
      call check_announced(g, 'the number of elements', head(2))
      used = 0
      do b = 1, head(1)
         call integers(g, block_head)
         if (block_head(4) < 0 .or. block_head(4) > head(2) - used) call wrong(g, 'more elements than announced')
         if (any(QUADRILATERALS == block_head(3))) call wrong(g, 'the mesh has quadrilaterals', &
            'mesh it without Recombine and Mesh.RecombineAll, or call setOrder(1), splitQuadrangles(), setOrder(2) '// &
            'of gmsh.model.mesh in Python and write it')
         i = findloc(KINDS, block_head(3), dim=1)
         if (i == 0) call wrong(g, 'elements of type '//whole(block_head(3))//' cannot be used: 6-node triangles '// &
                                'and 3-node edges are')
         if (g%fault%code /= 0) return
         n = NODES_OF(i)
         used = used + block_head(4)
         one = block_t(block_head(1), block_head(2), block_head(3), reshape([integer ::], [n, block_head(4)], [0]))
         do i = 1, block_head(4)
            call integers(g, row(:n + 1))
            if (any(row(2:n + 1) < 1 .or. row(2:n + 1) > size(g%number_of))) then
               call wrong(g, 'an element refers to a node that does not exist')
            else
               one%nodes(:, i) = g%number_of(row(2:n + 1))
               if (any(one%nodes(:, i) == 0)) call wrong(g, 'an element refers to a node that does not exist')
            end if
            if (g%fault%code /= 0) return
         end do
         g%blocks = [g%blocks, one]
      end do
      if (used /= head(2)) call wrong(g, 'fewer elements than announced')
      call next(g)
      if (g%text /= '$EndElements') call wrong(g, 'expected $EndElements after the last element')
   end subroutine read_elements

   !> Collects triangles, turns clockwise ones, and makes a group of every physical name; groups that the file gives no
   !> name are named by their dimension and number.
   subroutine collect_elements(g, mesh)
      type(reader_t), intent(inout) :: g
      type(mesh_t), intent(inout) :: mesh
      character(7), parameter :: WORDS(0:3) = ['point  ', 'curve  ', 'surface', 'volume ']
      integer, allocatable :: elements(:), edges(:, :), nodes(:), t6(:, :)
      integer :: first(size(g%blocks)), b, i, k

      allocate (t6(6, 0))
      do b = 1, size(g%blocks)
         first(b) = size(t6, 2)
         if (g%blocks(b)%kind == TRIANGLE6) t6 = reshape([t6, g%blocks(b)%nodes], [6, first(b) + &
                                                                                  size(g%blocks(b)%nodes, 2)])
      end do
      if (size(t6, 2) == 0) then
         call wrong(g, 'the mesh has no 6-node triangles')
         return
      end if
      do i = 1, size(t6, 2)
         t6(:, i) = counter_clockwise(mesh, t6(:, i))
      end do
      mesh%t6 = t6
      call add_group(mesh, 'all', [(i, i=1, size(t6, 2))])
      do i = 1, size(g%members)
         associate (one => g%members(i))
            if (any(g%names%dimension == one%dimension .and. g%names%tag == one%tag)) cycle
            g%names = [g%names, physical_t(one%dimension, one%tag, 0, trim(WORDS(one%dimension))//'_'//whole(one%tag))]
         end associate
      end do
      do k = 1, size(g%names)
         associate (name => g%names(k))
            ! Those of one name and dimension are one group.
            if (any(same(g%names(:k - 1), name))) cycle
            elements = [integer ::]
            nodes = [integer ::]
            edges = reshape([integer ::], [3, 0])
            do b = 1, size(g%blocks)
               if (.not. belongs(g%blocks(b), pack(g%names%tag, same(g%names, name)), name%dimension)) cycle
               associate (of_block => g%blocks(b)%nodes)
                  select case (g%blocks(b)%kind)
                  case (TRIANGLE6)
                     elements = [elements, [(first(b) + i, i=1, size(of_block, 2))]]
                  case (LINE3)
                     edges = reshape([edges, of_block], [3, size(edges, 2) + size(of_block, 2)])
                  case default
                     nodes = [nodes, of_block(1, :)]
                  end select
               end associate
            end do
            edges = oriented(mesh, edges)
            if (name%name /= 'all') then
               call add_group(mesh, trim(name%name), elements, edges, nodes)
            else if (size(elements) < size(t6, 2)) then
               call raise(g%fault, EXIT_MESH, trim(g%file)//': a physical group is called ''all'' and has not all '// &
                          'triangles, which is what a scene calls so; give it another name.')
               return
            end if
         end associate
      end do
   contains
      elemental logical function same(a, b)
         type(physical_t), intent(in) :: a, b

         same = a%name == b%name .and. a%dimension == b%dimension
      end function same

      !> Whether the entity of a block is a member of a group with one of these tags.
      pure logical function belongs(one, tags, dimension)
         type(block_t), intent(in) :: one
         integer, intent(in) :: tags(:), dimension
         integer :: m

         belongs = one%dimension == dimension .and. &
                   any([(g%members(m)%dimension == dimension .and. g%members(m)%entity == one%entity .and. &
                         any(tags == g%members(m)%tag), m=1, size(g%members))])
      end function belongs
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

   !> Lists the edges of a group once, with their triangle on the left, of two the first one. Curves that lie on each
   !> other have the same edges.
   function oriented(mesh, edges) result(once)
      type(mesh_t), intent(in) :: mesh
      integer, intent(in) :: edges(:, :)
      integer, allocatable :: once(:, :)
      logical :: known(size(mesh%x, 2)), is_new(size(edges, 2))
      integer :: k

      known = .false.
      once = edges
      associate (beside => triangles_beside(mesh%t6, edges))
         do k = 1, size(edges, 2)
            is_new(k) = .not. known(edges(3, k))
            known(edges(3, k)) = .true.
            if (beside(2, k) > 0 .and. (beside(1, k) == 0 .or. beside(2, k) < beside(1, k))) &
               once(1:2, k) = edges([2, 1], k)
         end do
      end associate
      once = once(:, pack([(k, k=1, size(edges, 2))], is_new))
   end function oriented
end module gmsh_reader
