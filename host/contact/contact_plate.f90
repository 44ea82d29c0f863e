! SPDX-License-Identifier: MIT
!> A rigid plate as the master: its face follows one unknown, the vertical displacement, and the contact's forces and
!> tangent are gathered on it. docs/theory/contact.md section 4.
module contact_plate
   use kinds, only: wp
   use contact_geometry, only: contact_geometry_t
   use contact_penalty, only: contact_result_t
   implicit none (type, external)
   private
   public :: plate_response_t, new_plate_response, plate_positions, gather_on_plate, force_on_plate

   integer, parameter :: FIRST_ROOM = 1024   !< Triplets to begin with.

   !> Forces and tangent over the unknowns 2 (node - 1) + direction of the slave's nodes, then that of the plate.
   type :: plate_response_t
      real(wp), allocatable :: force(:)      !< [kN]
      integer :: triplets = 0                !< How many are filled.
      integer, allocatable :: row(:)
      integer, allocatable :: column(:)
      real(wp), allocatable :: value(:)      !< d force/d displacement [kN/m]
      real(wp), allocatable, private :: right(:), below(:)   !< The plate's column and row.
   end type plate_response_t
contains
   !> Room for the forces and the tangent of a plate, sized for the slave of a geometry.
   pure function new_plate_response(geometry) result(plate)
      type(contact_geometry_t), intent(in) :: geometry
      type(plate_response_t) :: plate

      allocate (plate%force(2*geometry%slave_nodes + 1), source=0.0_wp)
      allocate (plate%right(2*geometry%slave_nodes), plate%below(2*geometry%slave_nodes), source=0.0_wp)
      allocate (plate%row(FIRST_ROOM), plate%column(FIRST_ROOM), source=0)
      allocate (plate%value(FIRST_ROOM), source=0.0_wp)
   end function new_plate_response

   !> Nodes of the face at a vertical displacement. docs/theory/contact.md section 4.
   pure function plate_positions(x0, u_z) result(x)
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: u_z        !< [m]
      real(wp) :: x(2, size(x0, 2))

      x(1, :) = x0(1, :)
      x(2, :) = x0(2, :) + u_z
   end function plate_positions

   !> Slope of the energy against the plate's displacement: minus the force that contact exerts on it, upwards [kN].
   !> docs/theory/contact.md section 4.
   pure real(wp) function force_on_plate(geometry, result) result(force)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_result_t), intent(in) :: result
      integer :: i

      force = 0.0_wp
      do i = 2*geometry%slave_nodes + 2, size(result%force), 2
         force = force + result%force(i)
      end do
   end function force_on_plate

   !> Gathers an evaluation whose master is the face of the plate. docs/theory/contact.md section 4. Forces of the
   !> master along r are left out: the plate has no such unknown.
   pure subroutine gather_on_plate(geometry, result, plate)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_result_t), intent(in) :: result
      type(plate_response_t), intent(inout) :: plate
      real(wp) :: corner
      integer :: k, i, j, n

      n = 2*geometry%slave_nodes
      plate%force(:n) = result%force(:n)
      plate%force(n + 1) = force_on_plate(geometry, result)
      plate%right = 0.0_wp
      plate%below = 0.0_wp
      plate%triplets = 0
      corner = 0.0_wp
      call make_room(plate, result%triplets + 2*n + 1)
      do k = 1, result%triplets
         i = result%row(k)
         j = result%column(k)
         if (i <= n .and. j <= n) then
            call add(plate, i, j, result%value(k))
         else if (i <= n) then
            if (is_vertical(j)) plate%right(i) = plate%right(i) + result%value(k)
         else if (j <= n) then
            if (is_vertical(i)) plate%below(j) = plate%below(j) + result%value(k)
         else if (is_vertical(i) .and. is_vertical(j)) then
            corner = corner + result%value(k)
         end if
      end do
      do i = 1, n
         call add(plate, i, n + 1, plate%right(i))
         call add(plate, n + 1, i, plate%below(i))
      end do
      call add(plate, n + 1, n + 1, corner)
   end subroutine gather_on_plate

   !> Unknowns are numbered 2 (node - 1) + direction.
   pure logical function is_vertical(unknown)
      integer, intent(in) :: unknown

      is_vertical = mod(unknown, 2) == 0
   end function is_vertical

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
