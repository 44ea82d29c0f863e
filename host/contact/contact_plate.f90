! SPDX-License-Identifier: MIT
!> A rigid plate as the master: its face follows one unknown, the vertical displacement, or three of a motion in the
!> plane, and forces and tangent on its face are gathered on them. docs/theory/contact.md section 4.
module contact_plate
   use kinds, only: wp
   use contact_geometry, only: contact_geometry_t
   use contact_penalty, only: contact_result_t
   implicit none (type, external)
   private
   public :: plate_motion_t, plate_response_t, new_plate_response, unknowns_of, plate_displacements, &
             plate_positions, plate_slopes, gather_on_plate, force_on_plate

   integer, parameter :: FIRST_ROOM = 1024   !< Triplets to begin with.
   integer, parameter :: TURN = 3            !< Number of unknowns of a motion in the plane.

   !> Motion of a plate: vertical, or in its plane: along both axes and turning, from r to z, about its centre.
   type :: plate_motion_t
      logical :: turns = .false.
      real(wp) :: center(2) = 0.0_wp   !< At the start [m].
      real(wp) :: lever = 1.0_wp       !< The unknown of the rotation is this times the angle [m].
   end type plate_motion_t

   !> Forces and tangent over the unknowns 2 (node - 1) + direction of the slave's nodes, then those of the plate.
   type :: plate_response_t
      real(wp), allocatable :: force(:)      !< [kN]
      real(wp), allocatable :: size(:)       !< Sum of the magnitudes that a force is made of [kN].
      integer :: triplets = 0                !< Number of triplets that are filled.
      integer, allocatable :: row(:)
      integer, allocatable :: column(:)
      real(wp), allocatable :: value(:)      !< d force/d displacement [kN/m]
      real(wp), allocatable, private :: right(:, :), below(:, :)   !< The plate's columns and rows.
   end type plate_response_t
contains
   !> Unknowns of a motion: u_z; or u_r, u_z of the centre and the lever times the angle.
   pure integer function unknowns_of(motion)
      type(plate_motion_t), intent(in) :: motion

      unknowns_of = merge(TURN, 1, motion%turns)
   end function unknowns_of

   !> Room for the forces and the tangent of a plate, sized for the slave of a geometry.
   pure function new_plate_response(geometry, motion) result(plate)
      type(contact_geometry_t), intent(in) :: geometry
      type(plate_motion_t), intent(in) :: motion
      type(plate_response_t) :: plate
      integer :: n, own

      n = 2*geometry%slave_nodes
      own = unknowns_of(motion)
      allocate (plate%force(n + own), plate%size(n + own), source=0.0_wp)
      allocate (plate%right(n, own), plate%below(n, own), source=0.0_wp)
      allocate (plate%row(FIRST_ROOM), plate%column(FIRST_ROOM), source=0)
      allocate (plate%value(FIRST_ROOM), source=0.0_wp)
   end function new_plate_response

   !> Nodes of the face where the plate has moved to; rotations are exact. docs/theory/contact.md section 4.
   pure function plate_positions(motion, x0, q) result(x)
      type(plate_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns_of) [m]
      real(wp) :: x(2, size(x0, 2))

      x = x0 + plate_displacements(motion, x0, q)
   end function plate_positions

   !> Displacements of the nodes of the face; rotations are exact, and small ones do not vanish beside coordinates.
   !> docs/theory/contact.md section 4.
   pure function plate_displacements(motion, x0, q) result(u)
      type(plate_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns_of) [m]
      real(wp) :: u(2, size(x0, 2)), arm(2), less, s
      integer :: i

      if (.not. motion%turns) then
         u(1, :) = 0.0_wp
         u(2, :) = q(1)
         return
      end if
      s = sin(q(TURN)/motion%lever)
      less = 2*sin(0.5_wp*q(TURN)/motion%lever)**2   ! 1 - cos
      do i = 1, size(x0, 2)
         arm = x0(:, i) - motion%center
         u(:, i) = q(:2) + [-less*arm(1) - s*arm(2), s*arm(1) - less*arm(2)]
      end do
   end function plate_displacements

   !> Slopes of the coordinates 2 (node - 1) + direction of the face against the unknowns of the plate [-].
   !> docs/theory/contact.md section 4.
   pure function plate_slopes(motion, x0, q) result(slopes)
      type(plate_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns_of) [m]
      real(wp) :: slopes(unknowns_of(motion), 2*size(x0, 2)), arms(2, size(x0, 2))
      integer :: i

      slopes = 0.0_wp
      if (.not. motion%turns) then
         slopes(1, 2::2) = 1.0_wp
         return
      end if
      arms = turned_arms(motion, x0, q)
      slopes(1, 1::2) = 1.0_wp
      slopes(2, 2::2) = 1.0_wp
      do i = 1, size(x0, 2)
         slopes(TURN, 2*i - 1:2*i) = [-arms(2, i), arms(1, i)]/motion%lever
      end do
   end function plate_slopes

   !> Arms from the centre to the nodes of the face, where they are now (2, nodes) [m].
   pure function turned_arms(motion, x0, q) result(arms)
      type(plate_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :), q(:)
      real(wp) :: arms(2, size(x0, 2))

      arms = plate_positions(motion, x0, q) - spread(motion%center + q(:2), 2, size(x0, 2))
   end function turned_arms

   !> Slope of the energy against the unknowns of the plate: minus the forces that contact exerts on it [kN].
   !> docs/theory/contact.md section 4.
   pure function force_on_plate(geometry, result, slopes) result(force)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_result_t), intent(in) :: result
      real(wp), intent(in) :: slopes(:, :)   !< Slopes of the positions, as of plate_slopes.
      real(wp) :: force(size(slopes, 1))
      integer :: i, n

      n = 2*geometry%slave_nodes
      force = 0.0_wp
      do i = 1, size(slopes, 2)
         force = force + slopes(:, i)*result%force(n + i)
      end do
   end function force_on_plate

   !> Gathers an evaluation whose master is the face of the plate. docs/theory/contact.md section 4. What no unknown of
   !> the plate follows is left out.
   pure subroutine gather_on_plate(geometry, result, motion, x0, q, plate)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_result_t), intent(in) :: result
      type(plate_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) of the face, undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns_of) [m]
      type(plate_response_t), intent(inout) :: plate
      real(wp) :: corner(size(q), size(q)), slopes(size(q), 2*size(x0, 2))
      integer :: k, i, j, n, own

      n = 2*geometry%slave_nodes
      own = size(q)
      slopes = plate_slopes(motion, x0, q)
      plate%force(:n) = result%force(:n)
      plate%force(n + 1:) = force_on_plate(geometry, result, slopes)
      plate%size = abs(plate%force)
      plate%size(n + 1:) = 0.0_wp
      do i = 1, size(slopes, 2)
         plate%size(n + 1:) = plate%size(n + 1:) + abs(slopes(:, i)*result%force(n + i))
      end do
      plate%right = 0.0_wp
      plate%below = 0.0_wp
      plate%triplets = 0
      corner = 0.0_wp
      call make_room(plate, result%triplets + own*(2*n + own))
      do k = 1, result%triplets
         i = result%row(k)
         j = result%column(k)
         if (i <= n .and. j <= n) then
            call add(plate, i, j, result%value(k))
         else if (i <= n) then
            plate%right(i, :) = plate%right(i, :) + result%value(k)*slopes(:, j - n)
         else if (j <= n) then
            plate%below(j, :) = plate%below(j, :) + result%value(k)*slopes(:, i - n)
         else
            corner = corner + result%value(k)*spread(slopes(:, i - n), 2, own)*spread(slopes(:, j - n), 1, own)
         end if
      end do
      if (motion%turns) corner(TURN, TURN) = corner(TURN, TURN) + bending()
      do j = 1, own
         do i = 1, n
            call add(plate, i, n + j, plate%right(i, j))
            call add(plate, n + j, i, plate%below(i, j))
         end do
         do i = 1, own
            call add(plate, n + i, n + j, corner(i, j))
         end do
      end do
   contains
      !> Forces turn about the centre as their arms do: a face turns on a circle.
      pure real(wp) function bending()
         real(wp) :: arms(2, size(x0, 2))

         arms = turned_arms(motion, x0, q)
         bending = -dot_product(result%force(n + 1:), reshape(arms, [size(arms)]))/motion%lever**2
      end function bending
   end subroutine gather_on_plate

   !> One entry of the tangent; an exact zero is left out.
   pure subroutine add(plate, row, column, value)
      type(plate_response_t), intent(inout) :: plate
      integer, intent(in) :: row, column
      real(wp), intent(in) :: value

      if (.not. abs(value) > 0.0_wp) return
      plate%triplets = plate%triplets + 1
      plate%row(plate%triplets) = row
      plate%column(plate%triplets) = column
      plate%value(plate%triplets) = value
   end subroutine add

   pure subroutine make_room(plate, n)
      type(plate_response_t), intent(inout) :: plate
      integer, intent(in) :: n

      if (n <= size(plate%row)) return
      deallocate (plate%row, plate%column, plate%value)
      allocate (plate%row(2*n), plate%column(2*n), source=0)
      allocate (plate%value(2*n), source=0.0_wp)
   end subroutine make_room
end module contact_plate
