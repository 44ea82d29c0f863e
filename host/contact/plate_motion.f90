! SPDX-License-Identifier: MIT
!> The motion of a rigid plate: its face follows a few unknowns. docs/theory/contact.md section 4.
module plate_motion
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: plate_motion_t, plate_positions

   !> Motion of a plate: vertical, by one unknown. Types that extend it have more, of which the first is that one.
   type :: plate_motion_t
   contains
      procedure :: displacements, slopes, bending
   end type plate_motion_t
contains
   !> Moves the nodes of the face. docs/theory/contact.md section 4.
   pure function displacements(self, x0, q) result(u)
      class(plate_motion_t), intent(in) :: self
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns of the motion) [m]
      real(wp) :: u(2, size(x0, 2))

      u(1, :) = 0.0_wp
      u(2, :) = q(1)
   end function displacements

   !> Differentiates the coordinates 2 (node - 1) + direction of the face by the unknowns of the motion [-].
   pure function slopes(self, x0, q)
      class(plate_motion_t), intent(in) :: self
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns of the motion) [m]
      real(wp) :: slopes(size(q), 2*size(x0, 2))

      slopes = 0.0_wp
      slopes(1, 2::2) = 1.0_wp
   end function slopes

   !> Finds the tangent of forces on the face by slopes that change with the motion [kN/m].
   pure function bending(self, x0, q, force)
      class(plate_motion_t), intent(in) :: self
      real(wp), intent(in) :: x0(:, :)    !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: q(:)        !< (unknowns of the motion) [m]
      real(wp), intent(in) :: force(:)    !< On the coordinates of the face [kN].
      real(wp) :: bending(size(q), size(q))

      bending = 0.0_wp
   end function bending

   !> Finds where the nodes of the face have moved to. docs/theory/contact.md section 4.
   pure function plate_positions(motion, x0, q) result(x)
      class(plate_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :)   !< (2, nodes) undisplaced [m]
      real(wp), intent(in) :: q(:)       !< (unknowns of the motion) [m]
      real(wp) :: x(2, size(x0, 2))

      x = x0 + motion%displacements(x0, q)
   end function plate_positions
end module plate_motion
