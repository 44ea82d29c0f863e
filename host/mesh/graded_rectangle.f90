! SPDX-License-Identifier: MIT
!> Built-in mesh: a rectangle of blocks, each cut into cells whose size grows in a constant ratio, two triangles a cell.
!> Boundaries left, right, bottom, top; the pieces between two breaks are top_1, top_2, ... (right_1 from the bottom).
!> Regions: all, and block_I_J (I along r, J along z). Where blocks meet: interface_r_I_J between block_I_J and the next
!> one along r, interface_z_I_J between it and the next one along z; the lines of all J, or I: interface_r_I,
!> interface_z_J.
module graded_rectangle
   use kinds, only: wp
   use texts, only: whole
   use triangle_mesh, only: mesh_t, add_group
   implicit none (type, external)
   private
   public :: graded_mesh, blocks_t

   !> Breaks along an axis, cells between them, and the ratios of their sizes.
   type :: blocks_t
      real(wp), allocatable :: breaks(:)   !< (pieces + 1) Ascending [m].
      integer, allocatable :: cells(:)     !< (pieces)
      real(wp), allocatable :: ratio(:)    !< (pieces) Size of a cell over that of the one before it, > 0.
   end type blocks_t
contains
   !> Coordinates of the cell ends between breaks [m]. (cells + 1)
   pure function graded_axis(blocks) result(x)
      type(blocks_t), intent(in) :: blocks
      real(wp) :: x(sum(blocks%cells) + 1), upto
      integer :: i, k, at

      at = 1
      associate (breaks => blocks%breaks, ratio => blocks%ratio)
         x(1) = breaks(1)
         do i = 1, size(blocks%cells)
            upto = 0.0_wp
            do k = 1, blocks%cells(i)
               upto = upto + ratio(i)**(k - 1)
               x(at + k) = upto
            end do
            x(at + 1:at + blocks%cells(i)) = breaks(i) + (breaks(i + 1) - breaks(i))*x(at + 1:at + blocks%cells(i))/upto
            at = at + blocks%cells(i)
            x(at) = breaks(i + 1)
         end do
      end associate
   end function graded_axis

   !> Meshes a rectangle by its blocks along r and z.
   subroutine graded_mesh(r_blocks, z_blocks, mesh)
      type(blocks_t), intent(in) :: r_blocks, z_blocks
      type(mesh_t), intent(out) :: mesh
      real(wp), allocatable :: r(:), z(:)
      integer, allocatable :: r_piece(:), z_piece(:)
      integer :: nr, nz, i, j, k

      r = graded_axis(r_blocks)
      z = graded_axis(z_blocks)
      nr = size(r) - 1
      nz = size(z) - 1
      r_piece = [((i, k=1, r_blocks%cells(i)), i=1, size(r_blocks%cells))]
      z_piece = [((i, k=1, z_blocks%cells(i)), i=1, size(z_blocks%cells))]
      allocate (mesh%x(2, (2*nr + 1)*(2*nz + 1)), mesh%t6(6, 2*nr*nz))
      do j = 0, 2*nz
         do i = 0, 2*nr
            mesh%x(:, node(i, j)) = [middle(r, i), middle(z, j)]
         end do
      end do
      do j = 1, nz
         do i = 1, nr
            k = 2*((j - 1)*nr + i) - 1
            associate (a => 2*i - 2, b => 2*j - 2)
               ! Diagonals alternate, so that the mesh prefers no direction; both corners of a body get two triangles.
               if (mod(i + j, 2) == 0) then
                  mesh%t6(:, k) = [node(a, b), node(a + 2, b), node(a + 2, b + 2), &
                                   node(a + 1, b), node(a + 2, b + 1), node(a + 1, b + 1)]
                  mesh%t6(:, k + 1) = [node(a, b), node(a + 2, b + 2), node(a, b + 2), &
                                       node(a + 1, b + 1), node(a + 1, b + 2), node(a, b + 1)]
               else
                  mesh%t6(:, k) = [node(a, b), node(a + 2, b), node(a, b + 2), &
                                   node(a + 1, b), node(a + 1, b + 1), node(a, b + 1)]
                  mesh%t6(:, k + 1) = [node(a + 2, b), node(a + 2, b + 2), node(a, b + 2), &
                                       node(a + 2, b + 1), node(a + 1, b + 2), node(a + 1, b + 1)]
               end if
            end associate
         end do
      end do
      call add_regions()
      call add_sides()
      call add_interfaces()
   contains
      pure integer function node(i, j)
         integer, intent(in) :: i, j

         node = j*(2*nr + 1) + i + 1
      end function node

      !> Returns coordinate number i of an axis with its middles, counted from 0.
      pure real(wp) function middle(ends, i)
         real(wp), intent(in) :: ends(:)
         integer, intent(in) :: i

         if (mod(i, 2) == 0) then
            middle = ends(i/2 + 1)
         else
            middle = 0.5_wp*(ends(i/2 + 1) + ends(i/2 + 2))
         end if
      end function middle

      subroutine add_regions()
         integer :: cell(2*nr*nz)
         logical :: inside(2*nr*nz)
         integer :: p, q, c

         cell = [(c, c=1, 2*nr*nz)]
         call add_group(mesh, 'all', cell)
         do q = 1, size(z_blocks%cells)
            do p = 1, size(r_blocks%cells)
               inside = [(r_piece(mod((c - 1)/2, nr) + 1) == p .and. z_piece((c - 1)/2/nr + 1) == q, c=1, 2*nr*nz)]
               call add_group(mesh, 'block_'//whole(p)//'_'//whole(q), pack(cell, inside))
            end do
         end do
      end subroutine add_regions

      subroutine add_sides()
         integer :: c

         call add_side('bottom', '', reshape([(node(2*c - 2, 0), node(2*c, 0), node(2*c - 1, 0), c=1, nr)], &
                                         [3, nr]), r_piece)
         call add_side('right', '', reshape([(node(2*nr, 2*c - 2), node(2*nr, 2*c), node(2*nr, 2*c - 1), c=1, nz)], &
                                        [3, nz]), z_piece)
         call add_side('top', '', reshape([(node(2*c, 2*nz), node(2*c - 2, 2*nz), node(2*c - 1, 2*nz), c=1, nr)], &
                                      [3, nr]), r_piece)
         call add_side('left', '', reshape([(node(0, 2*c), node(0, 2*c - 2), node(0, 2*c - 1), c=1, nz)], &
                                           [3, nz]), z_piece)
      end subroutine add_sides

      !> Edges between blocks, the block before on their left: what acts on them takes its side from the ground.
      subroutine add_interfaces()
         integer :: i, j, c

         do i = 1, nr - 1
            if (r_piece(i) == r_piece(i + 1)) cycle
            call add_side('interface_r_'//whole(r_piece(i)), '', &
                          reshape([(node(2*i, 2*c - 2), node(2*i, 2*c), node(2*i, 2*c - 1), c=1, nz)], &
                                  [3, nz]), z_piece)
         end do
         do j = 1, nz - 1
            if (z_piece(j) == z_piece(j + 1)) cycle
            call add_side('interface_z', '_'//whole(z_piece(j)), &
                          reshape([(node(2*c, 2*j), node(2*c - 2, 2*j), node(2*c - 1, 2*j), c=1, nr)], &
                                  [3, nr]), r_piece)
         end do
      end subroutine add_interfaces

      !> Adds a boundary and its pieces, whose numbers stand before the end of its name.
      subroutine add_side(name, ending, edges, piece)
         character(*), intent(in) :: name, ending
         integer, intent(in) :: edges(:, :), piece(:)
         integer :: p, c

         call add_group(mesh, name//ending, edges=edges)
         do p = 1, maxval(piece)
            call add_group(mesh, name//'_'//whole(p)//ending, edges=edges(:, pack([(c, c=1, size(piece))], piece == p)))
         end do
      end subroutine add_side
   end subroutine graded_mesh
end module graded_rectangle
