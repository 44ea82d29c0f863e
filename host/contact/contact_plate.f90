! SPDX-License-Identifier: MIT
!> A rigid plate as the master: forces and tangent on its face are gathered on the unknowns of its motion. So are those
!> of nodes that are tied to a plate which moves in its plane, by stiff springs along r and z between every node and
!> its place on the plate. docs/theory/contact.md section 4.
module contact_plate
   use kinds, only: wp
   use contact_geometry, only: contact_geometry_t
   use contact_penalty, only: contact_result_t, new_result
   use contact_response, only: nodal_forces_t, make_room, add_column
   use plate_motion, only: plate_motion_t
   implicit none (type, external)
   private
   public :: gather_on_plate, force_on_plate, new_spring_result, evaluate_springs, lengths_of_nodes
contains
   !> Sums the slope of the energy by the unknowns of the plate, minus the forces that contact exerts on it [kN].
   !> docs/theory/contact.md section 4.
   pure function force_on_plate(geometry, result, slopes) result(force)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_result_t), intent(in) :: result
      real(wp), intent(in) :: slopes(:, :)   !< Slopes of the motion of the plate.
      real(wp) :: force(size(slopes, 1))
      integer :: i, n

      n = 2*geometry%slave_nodes
      force = 0.0_wp
      do i = 1, size(slopes, 2)
         force = force + slopes(:, i)*result%force(n + i)
      end do
   end function force_on_plate

   !> Gathers an evaluation whose master is the face of the plate, over the unknowns 2 (node - 1) + direction of the
   !> slave's nodes, then those of the plate. docs/theory/contact.md section 4. What no unknown of the plate follows is
   !> left out.
   pure subroutine gather_on_plate(geometry, result, motion, x0, q, plate)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_result_t), intent(in) :: result
      class(plate_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) of the face, undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns of the motion) [m]
      type(nodal_forces_t), intent(inout) :: plate
      real(wp), dimension(2*geometry%slave_nodes, size(q)) :: right, below   ! The plate's columns and rows.
      real(wp) :: corner(size(q), size(q)), slopes(size(q), 2*size(x0, 2))
      integer :: k, i, j, n, own

      n = 2*geometry%slave_nodes
      own = size(q)
      slopes = motion%slopes(x0, q)
      plate%force(:n) = result%force(:n)
      plate%force(n + 1:) = force_on_plate(geometry, result, slopes)
      plate%size = abs(plate%force)
      plate%size(n + 1:) = 0.0_wp
      do i = 1, size(slopes, 2)
         plate%size(n + 1:) = plate%size(n + 1:) + abs(slopes(:, i)*result%force(n + i))
      end do
      right = 0.0_wp
      below = 0.0_wp
      plate%triplets = 0
      corner = 0.0_wp
      call make_room(plate, result%triplets + own*(2*n + own))
      do k = 1, result%triplets
         i = result%row(k)
         j = result%column(k)
         if (i <= n .and. j <= n) then
            call add_column(plate, [i], j, [result%value(k)])
         else if (i <= n) then
            right(i, :) = right(i, :) + result%value(k)*slopes(:, j - n)
         else if (j <= n) then
            below(j, :) = below(j, :) + result%value(k)*slopes(:, i - n)
         else
            corner = corner + result%value(k)*spread(slopes(:, i - n), 2, own)*spread(slopes(:, j - n), 1, own)
         end if
      end do
      corner = corner + motion%bending(x0, q, result%force(n + 1:))
      do j = 1, own
         do i = 1, n
            call add_column(plate, [i], n + j, [right(i, j)])
            call add_column(plate, [n + j], i, [below(i, j)])
         end do
         call add_column(plate, [(n + i, i=1, own)], n + j, corner(:, j))
      end do
   end subroutine gather_on_plate

   !> Makes an outcome of springs with the slopes, which are constant.
   pure function new_spring_result(geometry, stiffness) result(result)
      type(contact_geometry_t), intent(in) :: geometry   !< Every node has its place on the plate.
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

   !> Finds the forces and the energy of springs at displacements. docs/theory/contact.md section 4.
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

   !> Finds the share of every node in the length of a boundary, as its shape functions give it [m]. (nodes)
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
end module contact_plate
