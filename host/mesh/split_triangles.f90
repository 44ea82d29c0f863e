! SPDX-License-Identifier: MIT
!> A mesh with every triangle split into four of half its size, on the quadratic map of its nodes: curved sides stay
!> curved, groups keep their names, and every node of the mesh is a corner of the finer one.
module split_triangles
   use kinds, only: wp
   use shape_functions, only: quadratic
   use triangle_mesh, only: mesh_t, add_group
   implicit none (type, external)
   private
   public :: split_mesh

   integer, parameter :: SIDES(3, 3) = reshape([1, 2, 4, 2, 3, 5, 3, 1, 6], [3, 3])   !< Corner, corner, middle.
   !> Places of the three nodes inside a triangle: middles of the sides of the innermost of the four.
   real(wp), parameter :: INNER(2, 3) = reshape([0.25_wp, 0.25_wp, 0.5_wp, 0.25_wp, 0.25_wp, 0.5_wp], [2, 3])
contains
   !> Makes four triangles of one, and two edges of one. Raises no fault.
   subroutine split_mesh(mesh, finer)
      type(mesh_t), intent(in) :: mesh
      type(mesh_t), intent(out) :: finer
      integer, allocatable :: quarters(:, :)   !< (2, nodes) Beside a middle; first that of the lower corner.
      real(wp), allocatable :: x(:, :)
      real(wp) :: shape(6), slopes(2, 6)
      integer :: c(6), q(2, 3), m(3), e, k, n

      n = size(mesh%x, 2)
      allocate (x(2, n + 9*size(mesh%t6, 2)), quarters(2, n), finer%t6(6, 4*size(mesh%t6, 2)))
      x(:, :n) = mesh%x
      quarters = 0
      do e = 1, size(mesh%t6, 2)
         c = mesh%t6(:, e)
         do k = 1, 3
            call find_quarters(c(SIDES(:, k)), q(:, k))
         end do
         do k = 1, 3
            n = n + 1
            call quadratic(INNER(1, k), INNER(2, k), shape, slopes)
            x(:, n) = matmul(mesh%x(:, c), shape)
            m(k) = n
         end do
         finer%t6(:, 4*e - 3) = [c(1), c(4), c(6), q(1, 1), m(1), q(2, 3)]
         finer%t6(:, 4*e - 2) = [c(4), c(2), c(5), q(2, 1), q(1, 2), m(2)]
         finer%t6(:, 4*e - 1) = [c(6), c(5), c(3), m(3), q(2, 2), q(1, 3)]
         finer%t6(:, 4*e) = [c(4), c(5), c(6), m(2), m(3), m(1)]
      end do
      finer%x = x(:, :n)
      do k = 1, size(mesh%groups)
         call split_group(k)
      end do
   contains
      !> Finds the nodes at a quarter and at three quarters of a side, made when the side is seen first.
      subroutine find_quarters(side, nodes)
         integer, intent(in) :: side(3)
         integer, intent(out) :: nodes(2)

         if (quarters(1, side(3)) == 0) then
            quarters(:, side(3)) = [n + 1, n + 2]
            x(:, n + 1) = quarter_of(minval(side(:2)), side(3), maxval(side(:2)))
            x(:, n + 2) = quarter_of(maxval(side(:2)), side(3), minval(side(:2)))
            n = n + 2
         end if
         nodes = quarters(:, side(3))
         if (side(1) > side(2)) nodes = nodes([2, 1])
      end subroutine find_quarters

      !> Finds the place on a side a quarter of the way from its first node.
      pure function quarter_of(first, middle, last) result(place)
         integer, intent(in) :: first, middle, last
         real(wp) :: place(2)

         place = 0.375_wp*mesh%x(:, first) + 0.75_wp*mesh%x(:, middle) - 0.125_wp*mesh%x(:, last)
      end function quarter_of

      subroutine split_group(number)
         integer, intent(in) :: number
         integer, allocatable :: elements(:), edges(:, :)
         integer :: i

         associate (group => mesh%groups(number))
            allocate (elements(4*size(group%elements)), edges(3, 2*size(group%edges, 2)))
            do i = 1, size(group%elements)
               elements(4*i - 3:4*i) = 4*group%elements(i) - [3, 2, 1, 0]
            end do
            do i = 1, size(group%edges, 2)
               associate (side => group%edges(:, i))
                  call find_quarters(side, q(:, 1))
                  edges(:, 2*i - 1) = [side(1), side(3), q(1, 1)]
                  edges(:, 2*i) = [side(3), side(2), q(2, 1)]
               end associate
            end do
            call add_group(finer, trim(group%name), elements, edges, group%nodes)
         end associate
      end subroutine split_group
   end subroutine split_mesh
end module split_triangles
