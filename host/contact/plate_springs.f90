! SPDX-License-Identifier: MIT
!> Nodes that are tied to a rigid plate which moves in its plane: stiff springs in both directions between every node
!> and its place on the plate, gathered on the plate as contact is. docs/theory/contact.md section 4.
module plate_springs
   use kinds, only: wp
   use contact_geometry, only: contact_geometry_t
   use contact_penalty, only: contact_result_t, new_result
   implicit none (type, external)
   private
   public :: spring_geometry, new_spring_result, evaluate_springs, lengths_of_nodes
contains
   !> Numbers of nodes: each has its place on the plate.
   pure function spring_geometry(nodes) result(geometry)
      integer, intent(in) :: nodes
      type(contact_geometry_t) :: geometry

      geometry%slave_nodes = nodes
      geometry%master_nodes = nodes
   end function spring_geometry

   !> An outcome with the slopes, which are constant.
   pure function new_spring_result(geometry, stiffness) result(result)
      type(contact_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: stiffness(:)   !< (nodes) [kN/m]
      type(contact_result_t) :: result
      integer :: i, at, n

      result = new_result(geometry)
      n = 2*geometry%slave_nodes
      deallocate (result%row, result%column, result%value)
      result%triplets = 4*n
      allocate (result%row(4*n), result%column(4*n), result%value(4*n))
      do i = 1, n
         at = 4*(i - 1)
         result%row(at + 1:at + 4) = [i, i, n + i, n + i]
         result%column(at + 1:at + 4) = [i, n + i, i, n + i]
         result%value(at + 1:at + 4) = stiffness((i + 1)/2)*[1.0_wp, -1.0_wp, -1.0_wp, 1.0_wp]
      end do
   end function new_spring_result

   !> Forces and energy at displacements. docs/theory/contact.md section 4.
   pure subroutine evaluate_springs(stiffness, u, of_plate, result)
      real(wp), intent(in) :: stiffness(:)            !< (nodes) [kN/m]
      real(wp), intent(in) :: u(:, :), of_plate(:, :)   !< (2, nodes) of the nodes, and of their places on the plate [m]
      type(contact_result_t), intent(inout) :: result
      real(wp) :: pull(2*size(u, 2))

      pull = reshape(spread(stiffness, 1, 2)*(u - of_plate), [size(pull)])
      result%force(:size(pull)) = pull
      result%force(size(pull) + 1:) = -pull
      result%energy = 0.5_wp*dot_product(pull, reshape(u - of_plate, [size(pull)]))
   end subroutine evaluate_springs

   !> Share of every node in the length of a boundary, as its shape functions give it [m]. (nodes)
   pure function lengths_of_nodes(edges, x) result(lengths)
      integer, intent(in) :: edges(:, :)   !< (3, edges) start, end, middle.
      real(wp), intent(in) :: x(:, :)      !< (2, nodes) [m]
      real(wp) :: lengths(size(x, 2))
      integer :: e

      lengths = 0.0_wp
      do e = 1, size(edges, 2)
         associate (node => edges(:, e))
            lengths(node) = lengths(node) + norm2(x(:, node(2)) - x(:, node(1)))*[1, 1, 4]/6.0_wp
         end associate
      end do
   end function lengths_of_nodes
end module plate_springs
