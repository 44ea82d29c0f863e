!> Contacts in the equations: current coordinates go to the kernels, their forces and slopes to the unknowns. Without
!> contacts nothing is allocated and nothing is done.
module contact_interfaces
   use kinds, only: wp
   use contact_penalty, only: contact_t, contact_prepare, contact_evaluate
   use contact_rigid, only: rigid_t, rigid_prepare, rigid_positions, rigid_gather
   use contact_types, only: contact_options_t, contact_status_t, CONTACT_OK
   use degrees_of_freedom, only: dofs_t
   use sparsity_pattern, only: pattern_t, make_pattern, place_of
   implicit none (type, external)
   private
   public :: contacts_t, contact_interface_t, surface_t, surface_of, new_interface, plate_surface
   public :: evaluate_contacts, fit_pattern, add_contacts, work_of_contacts

   !> A boundary with numbers of its own.
   type :: surface_t
      integer, allocatable :: node(:)       !< Its nodes in the mesh; of a plate none.
      integer, allocatable :: edges(:, :)   !< (3, edges)
      real(wp), allocatable :: x0(:, :)     !< (2, nodes) at the start [m]
   end type surface_t

   !> The interface of two surfaces that may touch.
   type :: contact_interface_t
      type(contact_t) :: kernel
      type(rigid_t) :: body                 !< Where the master is a plate,
      integer :: plate = 0                  !< whose node this is.
      type(surface_t) :: slave, master
      integer, allocatable :: unknown(:)    !< Of every unknown of the kernel (or body), 0: none.
      logical :: acts = .true.              !< In this stage.
      ! Outcome of the last evaluation within a step.
      real(wp) :: thrust = 0.0_wp           !< Vertical force on the master, upwards [kN].
      real(wp) :: energy = 0.0_wp           !< Of the penalty [kJ].
      real(wp) :: area = 0.0_wp             !< Of the active nodes [m2].
      integer :: active = 0
      integer :: sealed = 0                 !< Slave nodes that are impervious in the step under way.
   end type contact_interface_t

   type :: contacts_t
      type(contact_interface_t), allocatable :: interfaces(:)
      integer, allocatable :: extra(:, :)   !< (2, pairs) unknowns that contacts have brought together so far.
      type(contact_status_t) :: status      !< Of the first that failed.
   end type contacts_t
contains
   !> Surface of the edges of a boundary.
   function surface_of(edges, x) result(surface)
      integer, intent(in) :: edges(:, :)   !< (3, edges) nodes of the mesh: start, end, middle
      real(wp), intent(in) :: x(:, :)      !< (2, nodes)
      type(surface_t) :: surface
      integer, allocatable :: place(:)
      integer :: i

      allocate (place(size(x, 2)), source=0)
      do i = 1, size(edges, 2)
         place(edges(:, i)) = 1
      end do
      surface%node = pack([(i, i=1, size(place))], place > 0)
      place(surface%node) = [(i, i=1, size(surface%node))]
      surface%edges = reshape(place(reshape(edges, [size(edges)])), shape(edges))
      surface%x0 = x(:, surface%node)
   end function surface_of

   !> A flat face of one edge, body on the left.
   pure function plate_surface(r, z, up) result(surface)
      real(wp), intent(in) :: r(2), z
      logical, intent(in) :: up
      type(surface_t) :: surface

      allocate (surface%node(0))
      surface%edges = reshape([1, 2, 3], [3, 1])
      surface%x0 = reshape([r(1), z, r(2), z, 0.5_wp*sum(r), z], [2, 3])
      if (up) surface%x0 = surface%x0(:, [2, 1, 3])
   end function plate_surface

   subroutine new_interface(dofs, slave, master, plate, options, interface_, status)
      type(dofs_t), intent(in) :: dofs
      type(surface_t), intent(in) :: slave, master
      integer, intent(in) :: plate   !< Node of the plate that the master is the face of, or 0.
      type(contact_options_t), intent(in) :: options
      type(contact_interface_t), intent(out) :: interface_
      type(contact_status_t), intent(out) :: status
      integer, allocatable :: nodes(:)

      interface_%slave = slave
      interface_%master = master
      interface_%plate = plate
      call contact_prepare(interface_%kernel, size(slave%x0, 2), slave%edges, size(master%x0, 2), master%edges, &
                           options, status)
      if (status%code /= CONTACT_OK) return
      nodes = [slave%node, master%node]
      interface_%unknown = reshape(dofs%of(1:2, nodes), [2*size(nodes)])
      if (plate == 0) return
      call rigid_prepare(interface_%body, size(slave%node), master%x0, [0.0_wp, 0.0_wp], 1)
      interface_%unknown = [interface_%unknown, dofs%of(2, plate)]
   end subroutine new_interface

   !> Everything at given displacements; false if a kernel refuses them.
   logical function evaluate_contacts(contacts, x, with_slope) result(good)
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes)
      logical, intent(in) :: with_slope
      real(wp), allocatable :: master(:, :)
      integer :: i

      good = .true.
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            t%active = 0
            t%thrust = 0.0_wp
            t%energy = 0.0_wp
            t%area = 0.0_wp
            if (.not. t%acts) cycle
            allocate (master, mold=t%master%x0)
            if (t%plate > 0) then
               call rigid_positions(t%body, x(2:2, t%plate), master)
            else
               master = t%master%x0 + x(1:2, t%master%node)
            end if
            call contact_evaluate(t%kernel, t%slave%x0 + x(1:2, t%slave%node), master, with_slope, contacts%status)
            good = contacts%status%code == CONTACT_OK
            if (.not. good) return
            if (t%plate > 0) call rigid_gather(t%body, t%kernel, x(2:2, t%plate), master)
            deallocate (master)
            t%active = count(t%kernel%active)
            t%thrust = sum(t%kernel%force(2:2*t%kernel%slave_nodes:2))
            t%energy = t%kernel%energy
            t%area = sum(t%kernel%weight, mask=t%kernel%active)
         end associate
      end do
   end function evaluate_contacts

   !> Makes the pattern hold the slopes of the last evaluation. It grows only: a contact that opens leaves it alone.
   subroutine fit_pattern(contacts, dofs, pattern, changed)
      type(contacts_t), intent(inout) :: contacts
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(inout) :: pattern
      logical, intent(out) :: changed
      integer, allocatable :: missing(:, :)
      integer :: n, i

      allocate (missing(2, sum([(room(contacts%interfaces(i)), i=1, size(contacts%interfaces))])))
      n = 0
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%acts) cycle
            if (t%plate > 0) then
               call list(t%body%row(:t%body%triplets), t%body%column(:t%body%triplets))
            else
               call list(t%kernel%row(:t%kernel%triplets), t%kernel%column(:t%kernel%triplets))
            end if
         end associate
      end do
      changed = n > 0
      if (.not. changed) return
      if (.not. allocated(contacts%extra)) allocate (contacts%extra(2, 0))
      contacts%extra = reshape([contacts%extra, missing(:, :n), missing(2:1:-1, :n)], &
                               [2, size(contacts%extra, 2) + 2*n])
      call make_pattern(dofs%n, dofs%element, contacts%extra, pattern)
   contains
      pure integer function room(t)
         type(contact_interface_t), intent(in) :: t

         room = t%kernel%triplets + t%body%triplets
      end function room

      subroutine list(row, column)
         integer, intent(in) :: row(:), column(:)
         integer :: k

         associate (u => contacts%interfaces(i)%unknown)
            do k = 1, size(row)
               if (u(row(k)) == 0 .or. u(column(k)) == 0) cycle
               if (place_of(pattern, u(row(k)), u(column(k))) > 0) cycle
               n = n + 1
               missing(:, n) = [u(row(k)), u(column(k))]
            end do
         end associate
      end subroutine list
   end subroutine fit_pattern

   !> Adds the last evaluation; `share` is the slope of the evaluated displacements against the new ones.
   subroutine add_contacts(contacts, pattern, share, with_slope, residual, scale, values)
      type(contacts_t), intent(in) :: contacts
      type(pattern_t), intent(in) :: pattern
      real(wp), intent(in) :: share
      logical, intent(in) :: with_slope
      real(wp), intent(inout) :: residual(:), scale(:), values(:)
      integer :: i

      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%acts) cycle
            if (t%plate > 0) then
               call add(t%unknown, t%body%force, t%body%row(:t%body%triplets), t%body%column, t%body%value)
            else
               call add(t%unknown, t%kernel%force, t%kernel%row(:t%kernel%triplets), t%kernel%column, t%kernel%value)
            end if
         end associate
      end do
   contains
      subroutine add(u, force, row, column, value)
         integer, intent(in) :: u(:), row(:), column(:)
         real(wp), intent(in) :: force(:), value(:)
         integer :: k, place

         do k = 1, size(u)
            if (u(k) == 0) cycle
            residual(u(k)) = residual(u(k)) + force(k)
            scale(u(k)) = scale(u(k)) + abs(force(k))
         end do
         if (.not. with_slope) return
         do k = 1, size(row)
            if (u(row(k)) == 0 .or. u(column(k)) == 0) cycle
            place = place_of(pattern, u(row(k)), u(column(k)))
            values(place) = values(place) + share*value(k)
         end do
      end subroutine add
   end subroutine add_contacts

   !> Work done on the penalty between two sets of displacements, by the mean of the forces [kJ]. The outcome of the
   !> last evaluation within the step stays.
   real(wp) function work_of_contacts(contacts, dofs, x0, x1) result(work)
      type(contacts_t), intent(in) :: contacts
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: x0(:, :), x1(:, :)
      type(contacts_t) :: probe
      real(wp), allocatable :: force(:)
      integer :: i, n

      probe = contacts
      allocate (force(dofs%n), source=0.0_wp)
      work = 0.0_wp
      do n = 1, 2
         if (n == 1) then
            if (.not. evaluate_contacts(probe, x0, .false.)) return
         else
            if (.not. evaluate_contacts(probe, x1, .false.)) return
         end if
         do i = 1, size(probe%interfaces)
            if (.not. probe%interfaces(i)%acts) cycle
            if (probe%interfaces(i)%plate > 0) then
               call gather(probe%interfaces(i)%unknown, probe%interfaces(i)%body%force)
            else
               call gather(probe%interfaces(i)%unknown, probe%interfaces(i)%kernel%force)
            end if
         end do
      end do
      do i = 1, dofs%n
         if (dofs%field(i) > 2) cycle
         work = work + 0.5_wp*force(i)*(x1(dofs%field(i), dofs%node(i)) - x0(dofs%field(i), dofs%node(i)))
      end do
   contains
      subroutine gather(u, f)
         integer, intent(in) :: u(:)
         real(wp), intent(in) :: f(:)
         integer :: k

         do k = 1, size(u)
            if (u(k) > 0) force(u(k)) = force(u(k)) + f(k)
         end do
      end subroutine gather
   end function work_of_contacts
end module contact_interfaces
