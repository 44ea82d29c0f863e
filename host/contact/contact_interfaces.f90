! SPDX-License-Identifier: MIT
!> Contacts in the equations: current coordinates go to the kernels, their forces and slopes to the unknowns. Without
!> contacts nothing is allocated and nothing is done.
module contact_interfaces
   use archive, only: archive_t
   use texts, only: whole
   use kinds, only: wp
   use contact_friction, only: friction_t, has_friction
   use contact_geometry, only: contact_geometry_t, contact_prepare
   use contact_penalty, only: contact_workspace_t, contact_result_t, contact_point_t, new_workspace, new_result, &
                              contact_evaluate, points_of, slid_work
   use contact_plate, only: plate_motion_t, plate_response_t, new_plate_response, plate_displacements, &
                            plate_positions, plate_slopes, gather_on_plate, force_on_plate
   use plate_springs, only: spring_geometry, new_spring_result, evaluate_springs, lengths_of_nodes
   use contact_types, only: contact_options_t, contact_status_t, CONTACT_OK
   use degrees_of_freedom, only: dofs_t, unknowns_of_body
   use unknown_fields, only: AT_U_Z, DISPLACEMENTS
   use sparsity_pattern, only: pattern_t, make_pattern, place_of
   implicit none (type, external)
   private
   public :: contacts_t, contact_interface_t, surface_t, surface_of, shortest_edge, plate_link_t, new_interface, &
             tie_to_plate, plate_surface
   public :: begin_friction, follow_turns, contacts_turn, accept_friction, tangential_traction
   public :: evaluate_contacts, probe_contacts, start_points, probe_interface, fit_pattern, add_contacts, &
             contact_forces, mean_contact_forces, rounding_of_ties, stretch_ties, exchange_contacts

   real(wp), parameter :: ROUNDINGS = 4.0_wp   !< Roundings of a displacement: of the node, and of its place by three
                                               !< unknowns.

   !> A boundary with numbers of its own.
   type :: surface_t
      integer, allocatable :: node(:)       !< Nodes of the surface in the mesh; a plate has none.
      integer, allocatable :: edges(:, :)   !< (3, edges)
      real(wp), allocatable :: x0(:, :)     !< (2, nodes) at the start [m]
   end type surface_t

   !> A plate in the unknowns.
   type :: plate_link_t
      integer :: node = 0   !< Node that carries the displacements; 0: there is no plate.
      integer :: turn = 0   !< Node whose u_z is the lever times the angle, of a plate that turns.
      type(plate_motion_t) :: motion
   end type plate_link_t

   !> The interface of two surfaces that may come into contact, or of a boundary with the plate that it is tied to.
   type :: contact_interface_t
      type(contact_geometry_t) :: geometry
      type(contact_workspace_t) :: work
      type(contact_result_t) :: result      !< Outcome at the iterates of a step.
      type(contact_result_t) :: probe       !< Outcome at other displacements, independent of the step.
      type(contact_point_t), allocatable :: point(:)   !< State of every slave node at the start of the step.
      logical :: rubs = .false.             !< The contact has friction.
      type(friction_t) :: friction          !< State of friction from which the step starts.
      real(wp), allocatable :: slave_u(:, :), master_u(:, :)   !< (2, nodes) Displacements there [m].
      type(plate_response_t) :: on_plate    !< Forces where the master is a plate.
      type(plate_link_t) :: plate           !< Plate whose face is the master.
      real(wp), allocatable :: spring(:)    !< (slave nodes) Stiffness where they are tied to the plate [kN/m].
      type(surface_t) :: slave, master
      integer, allocatable :: unknown(:)    !< Unknown of the equations for every unknown of the kernel, or of slave and
                                            !< plate; 0: none.
      logical :: acts = .true.              !< In this stage.
      ! Outcome of the last evaluation within a step.
      real(wp) :: thrust = 0.0_wp           !< Vertical force on the master, upwards [kN].
      real(wp) :: energy = 0.0_wp           !< Energy of the penalty [kJ].
      real(wp) :: area = 0.0_wp             !< Area of the active nodes [m2].
      integer :: active = 0
      integer :: sliding = 0                !< Nodes whose friction is at its limit.
      real(wp) :: drag = 0.0_wp             !< Friction on the master along the slave's tangent, summed up [kN].
      real(wp) :: rounding = 0.0_wp         !< Rounding of the forces of its springs [kN].
      integer :: sealed = 0                 !< Slave nodes that are impervious in the step under way.
   end type contact_interface_t

   type :: contacts_t
      type(contact_interface_t), allocatable :: interfaces(:)
      integer, allocatable :: extra(:, :)   !< (2, pairs) unknowns that contacts have brought together so far.
      type(contact_status_t) :: status      !< Status of the first interface that failed.
   end type contacts_t
contains
   !> Surface of the edges of a boundary.
   function surface_of(edges, x) result(surface)
      integer, intent(in) :: edges(:, :)   !< (3, edges) nodes of the mesh: start, end, middle
      real(wp), intent(in) :: x(:, :)      !< (2, nodes) At the start [m].
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

   !> Length of the shortest edge of a surface, between its ends [m].
   pure real(wp) function shortest_edge(surface) result(length)
      type(surface_t), intent(in) :: surface

      length = minval(norm2(surface%x0(:, surface%edges(2, :)) - surface%x0(:, surface%edges(1, :)), dim=1))
   end function shortest_edge

   !> The straight edges between corners, body on the left.
   pure function plate_surface(corners) result(surface)
      real(wp), intent(in) :: corners(:, :)   !< (2, corners) [m]
      type(surface_t) :: surface
      integer :: i, n

      n = size(corners, 2)
      allocate (surface%node(0), surface%edges(3, n - 1), surface%x0(2, 2*n - 1))
      surface%x0(:, :n) = corners
      do i = 1, n - 1
         surface%x0(:, n + i) = 0.5_wp*(corners(:, i) + corners(:, i + 1))
         surface%edges(:, i) = [i, i + 1, n + i]
      end do
   end function plate_surface

   !> Prepares the interface of a slave and a master surface; the status says what is wrong with surfaces or options.
   !> status: as of contact_prepare.
   subroutine new_interface(dofs, slave, master, plate, options, one, status)
      type(dofs_t), intent(in) :: dofs
      type(surface_t), intent(in) :: slave, master
      type(plate_link_t), intent(in) :: plate   !< Plate whose face is the master, if it is one.
      type(contact_options_t), intent(in) :: options
      type(contact_interface_t), intent(out) :: one
      type(contact_status_t), intent(out) :: status
      integer, allocatable :: nodes(:)

      one%slave = slave
      one%master = master
      one%plate = plate
      call contact_prepare(one%geometry, size(slave%x0, 2), slave%edges, size(master%x0, 2), master%edges, options, &
                           status)
      if (status%code /= CONTACT_OK) return
      one%work = new_workspace(one%geometry)
      one%result = new_result(one%geometry)
      one%probe = new_result(one%geometry)
      one%point = points_of(one%probe)
      nodes = [slave%node, master%node]
      one%unknown = reshape(dofs%of(:DISPLACEMENTS, nodes), [DISPLACEMENTS*size(nodes)])
      one%rubs = has_friction(options)
      if (one%rubs) then
         one%friction = friction_t(0*slave%x0, 0*master%x0, 0*one%result%gap, 0*one%result%gap, &
                                   0*one%result%side)
         one%slave_u = 0*slave%x0
         one%master_u = 0*master%x0
      end if
      if (plate%node > 0) call link(dofs, one)
   end subroutine new_interface

   !> Ties a boundary to a plate that turns: docs/theory/contact.md section 4.
   subroutine tie_to_plate(dofs, boundary, plate, penalty, one)
      type(dofs_t), intent(in) :: dofs
      type(surface_t), intent(in) :: boundary
      type(plate_link_t), intent(in) :: plate
      real(wp), intent(in) :: penalty   !< Traction of a unit of distance [kN/m3].
      type(contact_interface_t), intent(out) :: one

      one%slave = boundary
      one%master = boundary
      one%plate = plate
      one%geometry = spring_geometry(size(boundary%node))
      one%spring = penalty*lengths_of_nodes(boundary%edges, boundary%x0)
      one%result = new_spring_result(one%geometry, one%spring)
      one%probe = one%result
      one%point = points_of(one%probe)
      one%unknown = reshape(dofs%of(:DISPLACEMENTS, boundary%node), [DISPLACEMENTS*size(boundary%node)])
      call link(dofs, one)
   end subroutine tie_to_plate

   !> The unknowns of the plate beside those of the slave.
   subroutine link(dofs, one)
      type(dofs_t), intent(in) :: dofs
      type(contact_interface_t), intent(inout) :: one

      one%on_plate = new_plate_response(one%geometry, one%plate%motion)
      if (one%plate%motion%turns) then
         one%unknown = [one%unknown, unknowns_of_body(dofs, one%plate%node, one%plate%turn)]
      else
         one%unknown = [one%unknown, dofs%of(AT_U_Z, one%plate%node)]
      end if
   end subroutine link

   !> Unknowns of a plate at given displacements, as of plate_positions [m].
   pure function motion_of(plate, x) result(q)
      type(plate_link_t), intent(in) :: plate
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      real(wp), allocatable :: q(:)

      if (plate%motion%turns) then
         q = [x(:DISPLACEMENTS, plate%node), x(AT_U_Z, plate%turn)]
      else
         q = [x(AT_U_Z, plate%node)]
      end if
   end function motion_of

   !> Everything at given displacements; false if a kernel refuses them. contacts%status then says why.
   !> docs/theory/contact.md sections 2 to 4.
   logical function evaluate_contacts(contacts, x, with_tangent) result(good)
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) At the level l_f; displacements first [m].
      logical, intent(in) :: with_tangent   !< Slopes too.
      integer :: i

      good = .true.
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            t%active = 0
            t%thrust = 0.0_wp
            t%energy = 0.0_wp
            t%area = 0.0_wp
            t%sliding = 0
            t%drag = 0.0_wp
            if (.not. t%acts) cycle
            call probe_one(t, x, with_tangent, t%result, contacts%status)
            good = contacts%status%code == CONTACT_OK
            if (.not. good) return
            if (t%plate%node > 0) call gather_on_plate(t%geometry, t%result, t%plate%motion, t%master%x0, &
                                                       motion_of(t%plate, x), t%on_plate)
            t%active = count(t%result%active)
            t%thrust = sum(t%result%force(2:2*t%geometry%slave_nodes:2))
            t%energy = t%result%energy
            if (allocated(t%spring)) t%rounding = ROUNDINGS*epsilon(1.0_wp)*norm2(spread(t%spring, 1, DISPLACEMENTS) &
                                                                              *x(:DISPLACEMENTS, t%slave%node))
            t%area = sum(t%result%weight, mask=t%result%active)
            t%sliding = count(t%result%side /= 0)
            t%drag = dot_product(t%result%weight, t%result%traction)
         end associate
      end do
   end function evaluate_contacts

   !> Evaluates the contacts without slopes, into `probe` of every interface that acts: the outcome of the last
   !> evaluation within a step stays.
   logical function probe_contacts(contacts, x) result(good)
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      integer :: i

      good = .true.
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%acts) cycle
            call probe_one(t, x, .false., t%probe, contacts%status)
            good = contacts%status%code == CONTACT_OK
            if (.not. good) return
         end associate
      end do
   end function probe_contacts

   !> One of them, with the friction that its step starts from. status: as of contact_evaluate.
   subroutine probe_one(t, x, with_tangent, result, status)
      type(contact_interface_t), intent(inout) :: t
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      logical, intent(in) :: with_tangent
      type(contact_result_t), intent(inout) :: result
      type(contact_status_t), intent(out) :: status

      if (allocated(t%spring)) then
         call evaluate_springs(t%spring, x(:DISPLACEMENTS, t%slave%node), displacements_of_master(t, x), result)
         status = contact_status_t()
      else if (t%rubs) then
         t%friction%slave_dx = x(:DISPLACEMENTS, t%slave%node) - t%slave_u
         t%friction%master_dx = displacements_of_master(t, x) - t%master_u
         call probe_interface(t%geometry, t%slave, t%master, t%plate, x, with_tangent, t%work, result, status, &
                              t%friction)
      else
         call probe_interface(t%geometry, t%slave, t%master, t%plate, x, with_tangent, t%work, result, status)
      end if
   end subroutine probe_one

   !> Displacements of the nodes of the master, or of the face of the plate [m].
   pure function displacements_of_master(t, x) result(u)
      type(contact_interface_t), intent(in) :: t
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      real(wp) :: u(DISPLACEMENTS, size(t%master%x0, 2))

      if (t%plate%node > 0) then
         u = plate_displacements(t%plate%motion, t%master%x0, motion_of(t%plate, x))
      else
         u = x(:DISPLACEMENTS, t%master%node)
      end if
   end function displacements_of_master

   !> Sets the displacements and gaps that the friction of a step starts from; false if a kernel refuses them.
   !> docs/theory/contact.md section 9.
   logical function begin_friction(contacts, x) result(good)
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      integer :: i

      good = .true.
      if (.not. allocated(contacts%interfaces)) return
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%rubs) cycle
            ! Where it does not act nothing is held.
            if (.not. t%acts) t%friction%traction = 0.0_wp
            if (.not. t%acts) cycle
            t%slave_u = x(:DISPLACEMENTS, t%slave%node)
            t%master_u = displacements_of_master(t, x)
            t%friction%gap = 0.0_wp
            call probe_one(t, x, .false., t%probe, contacts%status)
            good = contacts%status%code == CONTACT_OK
            if (.not. good) return
            t%friction%gap = t%probe%gap
         end associate
      end do
   end function begin_friction

   !> Notes before a correction which way the nodes slide now, so that none turns with it from one way to the other. At
   !> the start and the end of a step (`fresh`) no node has a way. docs/theory/contact.md section 9.
   subroutine follow_turns(contacts, fresh)
      type(contacts_t), intent(inout) :: contacts
      logical, intent(in) :: fresh
      integer :: i

      if (.not. allocated(contacts%interfaces)) return
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (t%rubs) t%friction%side = merge(0, t%result%side, fresh)
         end associate
      end do
   end subroutine follow_turns

   !> Whether a node was held at the last evaluation, because it turned from sliding one way to sliding the other.
   pure logical function contacts_turn(contacts) result(turns)
      type(contacts_t), intent(in) :: contacts
      integer :: i

      turns = .false.
      if (.not. allocated(contacts%interfaces)) return
      turns = any([(contacts%interfaces(i)%acts .and. contacts%interfaces(i)%result%turns, &
                    i=1, size(contacts%interfaces))])
   end function contacts_turn

   !> Takes the tractions at the end of an accepted step; what sliding has dissipated in it [kJ].
   !> docs/theory/contact.md section 9.
   subroutine accept_friction(contacts, x, dissipated)
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) At the end of the step, displacements first [m].
      real(wp), intent(out) :: dissipated
      integer :: i

      dissipated = 0.0_wp
      if (.not. allocated(contacts%interfaces)) return
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%rubs .or. .not. t%acts) cycle
            call probe_one(t, x, .false., t%probe, contacts%status)
            ! What a step has ended with, no kernel refuses.
            if (contacts%status%code /= CONTACT_OK) cycle
            dissipated = dissipated + slid_work(t%geometry%options, t%friction, t%probe)
            t%friction%traction = t%probe%traction
         end associate
      end do
   end subroutine accept_friction

   !> Traction of a slave node along the slave's tangent at the start of the step [kPa].
   pure real(wp) function tangential_traction(t, node) result(traction)
      type(contact_interface_t), intent(in) :: t
      integer, intent(in) :: node   !< Number of the node on the slave.

      traction = 0.0_wp
      if (t%rubs) traction = t%friction%traction(node)
   end function tangential_traction

   !> Sets the states of the contact points at the displacements at the start of a step; false if a kernel refuses them.
   !> docs/theory/contact.md section 5. A step that is cut, and a restart, find the same states.
   logical function start_points(contacts, x) result(good)
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      integer :: i

      good = probe_contacts(contacts, x)
      if (.not. good) return
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (t%acts) t%point = points_of(t%probe)
         end associate
      end do
   end function start_points

   !> One pair of surfaces at given displacements. status: as of contact_evaluate.
   subroutine probe_interface(geometry, slave, master, plate, x, with_tangent, work, result, status, friction)
      type(contact_geometry_t), intent(in) :: geometry
      type(surface_t), intent(in) :: slave, master
      type(plate_link_t), intent(in) :: plate   !< Plate whose face is the master, if it is one.
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      logical, intent(in) :: with_tangent
      type(contact_workspace_t), intent(inout) :: work
      type(contact_result_t), intent(inout) :: result
      type(contact_status_t), intent(out) :: status
      type(friction_t), intent(in), optional :: friction
      real(wp) :: at(2, size(master%x0, 2))

      if (plate%node > 0) then
         at = plate_positions(plate%motion, master%x0, motion_of(plate, x))
      else
         at = master%x0 + x(:DISPLACEMENTS, master%node)
      end if
      call contact_evaluate(geometry, slave%x0 + x(:DISPLACEMENTS, slave%node), at, with_tangent, work, result, &
                            status, friction)
   end subroutine probe_interface

   !> Makes the pattern hold the slopes of the last evaluation. It grows only: a contact that opens leaves it alone.
   subroutine fit_pattern(contacts, dofs, pattern, changed)
      type(contacts_t), intent(inout) :: contacts
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(inout) :: pattern
      logical, intent(out) :: changed   !< Whether the pattern has grown.
      integer, allocatable :: missing(:, :)
      integer :: n, i

      allocate (missing(2, sum([(room(contacts%interfaces(i)), i=1, size(contacts%interfaces))])))
      n = 0
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%acts) cycle
            if (t%plate%node > 0) then
               call list(t%on_plate%row(:t%on_plate%triplets), t%on_plate%column(:t%on_plate%triplets))
            else
               call list(t%result%row(:t%result%triplets), t%result%column(:t%result%triplets))
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

         room = t%result%triplets + t%on_plate%triplets
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
   !> docs/theory/contact.md section 3.
   subroutine add_contacts(contacts, pattern, share, with_tangent, residual, scale, values)
      type(contacts_t), intent(in) :: contacts
      type(pattern_t), intent(in) :: pattern
      real(wp), intent(in) :: share   !< l_f [-]
      logical, intent(in) :: with_tangent
      real(wp), intent(inout) :: residual(:), scale(:), values(:)   !< (unknowns) [kN], twice; (entries).
      integer :: i

      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%acts) cycle
            if (t%plate%node > 0) then
               call add(t%unknown, t%on_plate%force, t%on_plate%size, t%on_plate%row(:t%on_plate%triplets), &
                        t%on_plate%column, t%on_plate%value)
            else
               call add(t%unknown, t%result%force, abs(t%result%force), t%result%row(:t%result%triplets), &
                        t%result%column, t%result%value)
            end if
         end associate
      end do
   contains
      subroutine add(u, force, sizes, row, column, value)
         integer, intent(in) :: u(:), row(:), column(:)
         real(wp), intent(in) :: force(:), sizes(:), value(:)
         integer :: k, place

         do k = 1, size(u)
            if (u(k) == 0) cycle
            residual(u(k)) = residual(u(k)) + force(k)
            scale(u(k)) = scale(u(k)) + sizes(k)
         end do
         if (.not. with_tangent) return
         do k = 1, size(row)
            if (u(row(k)) == 0 .or. u(column(k)) == 0) cycle
            place = place_of(pattern, u(row(k)), u(column(k)))
            values(place) = values(place) + share*value(k)
         end do
      end subroutine add
   end subroutine add_contacts

   !> Distances of tied nodes from their places on plates, which pull; 0 elsewhere [m]. (DISPLACEMENTS, nodes)
   pure subroutine stretch_ties(contacts, x, stretched)
      type(contacts_t), intent(in) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      real(wp), intent(out) :: stretched(:, :)
      integer :: i

      stretched = 0.0_wp
      if (.not. allocated(contacts%interfaces)) return
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (allocated(t%spring)) stretched(:, t%slave%node) = x(:DISPLACEMENTS, t%slave%node) &
                                                                  - displacements_of_master(t, x)
         end associate
      end do
   end subroutine stretch_ties

   !> Rounding of the forces between boundaries and the plates that they are tied to: small differences of large
   !> displacements, times stiff springs [kN].
   pure real(wp) function rounding_of_ties(contacts) result(rounding)
      type(contacts_t), intent(in) :: contacts
      integer :: i

      rounding = 0.0_wp
      if (allocated(contacts%interfaces)) &
         rounding = norm2([(contacts%interfaces(i)%rounding, i=1, size(contacts%interfaces))])
   end function rounding_of_ties

   !> Mean of the forces of the contacts at two sets of displacements, to be added to the internal ones; zero if a
   !> kernel refuses them. The outcome of the last evaluation within the step stays.
   function mean_contact_forces(contacts, dofs, x0, x1) result(force)
      type(contacts_t), intent(inout) :: contacts
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: x0(:, :), x1(:, :)   !< (FIELDS, nodes) [m]
      real(wp) :: force(dofs%n)                    !< Force on every unknown [kN].
      real(wp), allocatable :: before(:), after(:)

      force = 0.0_wp
      if (.not. contact_forces(contacts, dofs, x0, before)) return
      if (.not. contact_forces(contacts, dofs, x1, after)) return
      force = 0.5_wp*(before + after)
   end function mean_contact_forces

   !> Forces of the contacts at given displacements, to be added to the internal ones; false if a kernel refuses them.
   !> The outcome of the last evaluation within the step stays.
   logical function contact_forces(contacts, dofs, x, force) result(good)
      type(contacts_t), intent(inout) :: contacts
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      real(wp), allocatable, intent(out) :: force(:)   !< Force on every unknown [kN]. (unknowns)

      allocate (force(dofs%n), source=0.0_wp)
      good = probe_contacts(contacts, x)
      if (good) call gather_probes()
   contains
      subroutine gather_probes()
         integer :: c, n

         do c = 1, size(contacts%interfaces)
            associate (t => contacts%interfaces(c))
               if (.not. t%acts) cycle
               if (t%plate%node > 0) then
                  n = 2*t%geometry%slave_nodes
                  call gather(t%unknown(:n), t%probe%force(:n))
                  call gather(t%unknown(n + 1:), force_on_plate(t%geometry, t%probe, &
                     plate_slopes(t%plate%motion, t%master%x0, motion_of(t%plate, x))))
               else
                  call gather(t%unknown, t%probe%force)
               end if
            end associate
         end do
      end subroutine gather_probes

      subroutine gather(u, f)
         integer, intent(in) :: u(:)
         real(wp), intent(in) :: f(:)
         integer :: k

         do k = 1, size(u)
            if (u(k) > 0) force(u(k)) = force(u(k)) + f(k)
         end do
      end subroutine gather
   end function contact_forces

   !> Exchanges with an archive what contacts carry from step to step: tractions of friction, and the pairs of unknowns
   !> that they have brought together, on which the ordering of the matrix depends.
   subroutine exchange_contacts(dofs, contacts, archive)
      type(dofs_t), intent(in) :: dofs
      type(contacts_t), intent(inout) :: contacts
      type(archive_t), intent(inout) :: archive
      integer, allocatable :: pairs(:)
      integer :: i

      if (.not. allocated(contacts%interfaces)) return
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (t%rubs) call archive%exchange('friction_'//whole(i), t%friction%traction, 'kPa', &
                                              'traction of every slave node of a contact with friction')
         end associate
      end do
      if (allocated(contacts%extra)) pairs = reshape(contacts%extra, [size(contacts%extra)])
      call archive%exchange_allocatable('pairs', pairs, '-', &
                                        'pairs of unknowns that contacts brought into the matrix')
      if (.not. archive%reading .or. .not. allocated(pairs)) return
      if (any(pairs < 1 .or. pairs > dofs%n) .or. mod(size(pairs), 2) /= 0) then
         call archive%refuse()
      else
         contacts%extra = reshape(pairs, [2, size(pairs)/2])
      end if
   end subroutine exchange_contacts
end module contact_interfaces
