!> A rigid body as the master: its nodes follow one unknown (vertical) or three (two displacements and a rotation, plane
!> strain only), and the contact's forces and tangent are gathered on them.
module contact_rigid
   use contact_penalty, only: contact_t
   use contact_types, only: wp
   implicit none (type, external)
   private
   public :: rigid_t, rigid_prepare, rigid_positions, rigid_gather

   !> The answer: unknowns 2 (node - 1) + direction of the slave's nodes, then those of the body.
   type :: rigid_t
      integer :: unknowns = 1                   !< 1 vertical, or 3: u_1, u_2 and the rotation, counter-clockwise
      real(wp) :: centre(2) = 0.0_wp            !< About which it turns, undisplaced [m].
      real(wp), allocatable :: x(:, :)          !< (2, nodes) undisplaced [m]
      real(wp), allocatable :: force(:)         !< Slave, then body [kN, kN m]
      integer :: triplets = 0
      integer, allocatable :: row(:)
      integer, allocatable :: column(:)
      real(wp), allocatable :: value(:)
      real(wp), allocatable, private :: right(:, :), below(:, :)   !< Slave rows of the body's columns, and the reverse.
   end type rigid_t
contains
   !> `unknowns` is 1 or 3; in axial symmetry only 1 makes sense.
   pure subroutine rigid_prepare(body, slave_nodes, x, centre, unknowns)
      type(rigid_t), intent(out) :: body
      integer, intent(in) :: slave_nodes, unknowns
      real(wp), intent(in) :: x(:, :), centre(2)

      body%unknowns = unknowns
      body%centre = centre
      allocate (body%x, source=x)
      allocate (body%force(2*slave_nodes + unknowns), source=0.0_wp)
      allocate (body%right(2*slave_nodes, unknowns), body%below(unknowns, 2*slave_nodes), source=0.0_wp)
      allocate (body%row(1024), body%column(1024), source=0)
      allocate (body%value(1024), source=0.0_wp)
   end subroutine rigid_prepare

   !> Where the body's nodes are: q is u_2, or u_1, u_2 and the angle.
   pure subroutine rigid_positions(body, q, x)
      type(rigid_t), intent(in) :: body
      real(wp), intent(in) :: q(:)
      real(wp), intent(out) :: x(:, :)   !< (2, nodes) [m]
      integer :: i

      if (body%unknowns == 1) then
         x(1, :) = body%x(1, :)
         x(2, :) = body%x(2, :) + q(1)
      else
         do i = 1, size(x, 2)
            associate (arm => body%x(:, i) - body%centre)
               x(:, i) = body%centre + q(1:2) + [cos(q(3))*arm(1) - sin(q(3))*arm(2), &
                                                 sin(q(3))*arm(1) + cos(q(3))*arm(2)]
            end associate
         end do
      end if
   end subroutine rigid_positions

   !> Gathers the last evaluation of a contact, whose master is this body at q, on the slave's unknowns and the body's.
   pure subroutine rigid_gather(body, contact, q, x)
      type(rigid_t), intent(inout) :: body
      type(contact_t), intent(in) :: contact
      real(wp), intent(in) :: q(:)
      real(wp), intent(in) :: x(:, :)   !< From rigid_positions.
      real(wp) :: block(3, 3), centre(2)
      real(wp) :: by_row(3), by_column(3)
      integer :: k, i, j, n, m

      n = 2*contact%slave_nodes
      m = body%unknowns
      centre = body%centre
      if (m == 3) centre = centre + q(1:2)
      body%force(:n) = contact%force(:n)
      body%force(n + 1:) = 0.0_wp
      block = 0.0_wp
      do i = 1, 2*contact%master_nodes
         by_row = turn(i)
         body%force(n + 1:) = body%force(n + 1:) + contact%force(n + i)*by_row(:m)
      end do
      if (m == 3) then
         ! A turning arm also bends inwards: the second derivative of a position by the angle is minus the arm.
         do i = 1, contact%master_nodes
            block(3, 3) = block(3, 3) - dot_product(contact%force(n + 2*i - 1:n + 2*i), x(:, i) - centre)
         end do
      end if

      body%right = 0.0_wp
      body%below = 0.0_wp
      body%triplets = 0
      call make_room(body, contact%triplets + 2*n*m + m*m)
      do k = 1, contact%triplets
         i = contact%row(k)
         j = contact%column(k)
         if (i > n) by_row = turn(i - n)
         if (j > n) by_column = turn(j - n)
         if (i <= n .and. j <= n) then
            call add(body, i, j, contact%value(k))
         else if (i <= n) then
            body%right(i, :) = body%right(i, :) + contact%value(k)*by_column(:m)
         else if (j <= n) then
            body%below(:, j) = body%below(:, j) + contact%value(k)*by_row(:m)
         else
            do j = 1, m
               block(:m, j) = block(:m, j) + contact%value(k)*by_row(:m)*by_column(j)
            end do
         end if
      end do
      do j = 1, m
         do i = 1, n
            call add(body, i, n + j, body%right(i, j))
            call add(body, n + j, i, body%below(j, i))
         end do
         do i = 1, m
            call add(body, n + i, n + j, block(i, j))
         end do
      end do
   contains
      !> How the body's unknowns move a coordinate of its nodes.
      pure function turn(unknown) result(c)
         integer, intent(in) :: unknown
         real(wp) :: c(3)
         integer :: node

         node = (unknown + 1)/2
         c = 0.0_wp
         if (m == 1) then
            if (mod(unknown, 2) == 0) c(1) = 1.0_wp
         else if (mod(unknown, 2) == 1) then
            c = [1.0_wp, 0.0_wp, centre(2) - x(2, node)]
         else
            c = [0.0_wp, 1.0_wp, x(1, node) - centre(1)]
         end if
      end function turn
   end subroutine rigid_gather

   pure subroutine add(body, row, column, value)
      type(rigid_t), intent(inout) :: body
      integer, intent(in) :: row, column
      real(wp), intent(in) :: value

      if (.not. abs(value) > 0.0_wp) return
      body%triplets = body%triplets + 1
      body%row(body%triplets) = row
      body%column(body%triplets) = column
      body%value(body%triplets) = value
   end subroutine add

   pure subroutine make_room(body, n)
      type(rigid_t), intent(inout) :: body
      integer, intent(in) :: n

      if (n <= size(body%row)) return
      deallocate (body%row, body%column, body%value)
      allocate (body%row(2*n), body%column(2*n), source=0)
      allocate (body%value(2*n), source=0.0_wp)
   end subroutine make_room
end module contact_rigid
