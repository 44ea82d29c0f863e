! SPDX-License-Identifier: MIT
!> Contacts in the equations: current coordinates go to the kernels, their forces and slopes to the unknowns.
module contact_interfaces
   use archive, only: archive_t
   use texts, only: whole
   use kinds, only: wp
   use contact_friction, only: friction_state_t
   use contact_geometry, only: contact_geometry_t, contact_prepare
   use contact_penalty, only: contact_workspace_t, contact_result_t, new_workspace, new_result, contact_evaluate, &
                              slid_work
   use contact_response, only: nodal_forces_t, new_forces
   use contact_plate, only: gather_on_plate, force_on_plate, new_spring_result, evaluate_springs, lengths_of_nodes
   use plate_motion, only: plate_motion_t, plate_positions
   use contact_types, only: contact_options_t, contact_status_t, contact_message, has_friction, CONTACT_OK
   use degrees_of_freedom, only: dofs_t
   use unknown_fields, only: DISPLACEMENTS
   use sparsity_pattern, only: pattern_t, entry_of
   use surface_forces, only: surface_forces_t
   implicit none (type, external)
   private
   public :: contacts_t, contact_interface_t, surface_t, surface_of, shortest_edge, plate_link_t, new_interface, &
             tie_to_plate, plate_surface, tangential_tractions, probe_copy

   real(wp), parameter :: ROUNDINGS = 4.0_wp   !< Roundings of a displacement: of the node, and of its place by three
                                               !< unknowns.

   !> A boundary with numbers of its own.
   type :: surface_t
      integer, allocatable :: node(:)       !< Nodes of the surface in the mesh; a plate has none.
      integer, allocatable :: edges(:, :)   !< (3, edges)
      real(wp), allocatable :: x0(:, :)     !< (2, nodes) at the start [m]
   end type surface_t

   !> It moves the face of a contact by unknowns of the system.
   type :: plate_link_t
      class(plate_motion_t), allocatable :: motion    !< Not allocated: there is no plate.
      integer, allocatable :: field(:), node(:)       !< Fields and nodes that the unknowns of its motion are at.
   end type plate_link_t

   !> The interface of two surfaces that may come into contact, or of a boundary with the plate that it is tied to.
   type :: contact_interface_t
      type(contact_geometry_t) :: geometry
      type(contact_workspace_t) :: work
      type(contact_result_t) :: result      !< Outcome at the iterates of a step.
      type(contact_result_t) :: probe       !< Outcome at other displacements, independent of the step.
      type(friction_state_t), allocatable :: friction   !< State from which the step starts; not allocated: it has none.
      real(wp), allocatable :: slave_u(:, :), master_u(:, :)   !< (2, nodes) Displacements there [m].
      type(nodal_forces_t) :: on_plate      !< Forces where the master is a plate.
      type(plate_link_t) :: plate           !< Plate whose face is the master.
      real(wp), allocatable :: spring(:)    !< (slave nodes) Stiffness where they are tied to the plate [kN/m].
      type(surface_t) :: slave, master
      integer, allocatable :: unknown(:)    !< Unknown of the equations for every unknown of the kernel, or of slave and
                                            !< plate; 0: none.
      logical :: acts = .true.              !< In this stage.
      integer :: sealed = 0                 !< Slave nodes that are impervious in the step under way.
   end type contact_interface_t

   type, extends(surface_forces_t) :: contacts_t
      type(contact_interface_t), allocatable :: interfaces(:)   !< Contacts of the model, then what is tied to plates.
      type(contact_status_t) :: status      !< Status of the first interface that failed.
      integer :: corrections = 0            !< Corrections that the step had had at the last evaluation.
   contains
      procedure :: act, evaluate, missing, add, message, forces, find_closed, stretch
      procedure :: probe, begin_friction, accept_friction, exchange_friction
   end type contacts_t
contains
   !> Makes a surface of the edges of a boundary.
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

   !> Finds the length of the shortest edge of a surface, between its ends [m].
   pure real(wp) function shortest_edge(surface) result(length)
      type(surface_t), intent(in) :: surface

      length = minval(norm2(surface%x0(:, surface%edges(2, :)) - surface%x0(:, surface%edges(1, :)), dim=1))
   end function shortest_edge

   !> Makes a surface of the straight edges between corners, with the body on their left.
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
      nodes = [slave%node, master%node]
      one%unknown = reshape(dofs%of(:DISPLACEMENTS, nodes), [DISPLACEMENTS*size(nodes)])
      if (has_friction(options)) then
         one%friction = friction_state_t(0*slave%x0, 0*master%x0, 0*one%result%gap, 0*one%result%gap, &
                                         0*one%result%side)
         one%slave_u = 0*slave%x0
         one%master_u = 0*master%x0
      end if
      if (allocated(plate%motion)) call link(dofs, one)
   end subroutine new_interface

   !> Ties a boundary to a plate by springs: docs/theory/contact.md section 4.
   subroutine tie_to_plate(dofs, boundary, plate, penalty, one)
      type(dofs_t), intent(in) :: dofs
      type(surface_t), intent(in) :: boundary
      type(plate_link_t), intent(in) :: plate
      real(wp), intent(in) :: penalty   !< Traction of a unit of distance [kN/m3].
      type(contact_interface_t), intent(out) :: one

      one%slave = boundary
      one%master = boundary
      one%plate = plate
      one%geometry = contact_geometry_t(slave_nodes=size(boundary%node), master_nodes=size(boundary%node))
      one%spring = penalty*lengths_of_nodes(boundary%edges, boundary%x0)
      one%result = new_spring_result(one%geometry, one%spring)
      one%probe = one%result
      one%unknown = reshape(dofs%of(:DISPLACEMENTS, boundary%node), [DISPLACEMENTS*size(boundary%node)])
      call link(dofs, one)
   end subroutine tie_to_plate

   !> Puts the unknowns of the plate beside those of the slave.
   subroutine link(dofs, one)
      type(dofs_t), intent(in) :: dofs
      type(contact_interface_t), intent(inout) :: one
      integer :: k

      associate (plate => one%plate)
         one%on_plate = new_forces(2*one%geometry%slave_nodes + size(plate%node))
         one%unknown = [one%unknown, (dofs%of(plate%field(k), plate%node(k)), k=1, size(plate%node))]
      end associate
   end subroutine link

   !> Returns the unknowns of a plate at given displacements, as plate_positions takes them [m].
   pure function motion_of(plate, x) result(q)
      type(plate_link_t), intent(in) :: plate
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      real(wp) :: q(size(plate%node))
      integer :: k

      q = [(x(plate%field(k), plate%node(k)), k=1, size(q))]
   end function motion_of

   subroutine act(self, acts)
      class(contacts_t), intent(inout) :: self
      logical, intent(in) :: acts(:)

      self%interfaces(:size(acts))%acts = acts
   end subroutine act

   !> Evaluates all contacts at given displacements; false if a kernel refuses them. docs/theory/contact.md sections 2
   !> to 4. A node that slid before the last correction does not slide the other way: section 9.
   logical function evaluate(self, x, corrections, with_slopes) result(good)
      class(contacts_t), intent(inout) :: self
      real(wp), intent(in) :: x(:, :)
      integer, intent(in) :: corrections
      logical, intent(in) :: with_slopes
      real(wp) :: rounding(size(self%interfaces))   !< Force of a relative change of 1 of what is subtracted [kN].
      integer :: i

      good = .true.
      self%active = 0
      rounding = 0.0_wp
      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (.not. t%acts) cycle
            if (allocated(t%friction)) then
               if (corrections == 0) t%friction%side = 0
               if (corrections > self%corrections) t%friction%side = t%result%side
            end if
            call probe_one(t, x, with_slopes, .false., self%status)
            good = self%status%code == CONTACT_OK
            if (.not. good) return
            if (allocated(t%plate%motion)) call gather_on_plate(t%geometry, t%result, t%plate%motion, &
                                                                 t%master%x0, motion_of(t%plate, x), t%on_plate)
            self%active = self%active + count(t%result%active)
            if (allocated(t%spring)) then
               rounding(i) = norm2(spread(t%spring, 1, DISPLACEMENTS)*x(:DISPLACEMENTS, t%slave%node))
            else
               ! Of gaps, which are differences of the places along the force.
               associate (along => abs(reshape(t%result%force(:size(t%slave%x0)), shape(t%slave%x0))))
                  rounding(i) = t%geometry%options%penalty*norm2(t%result%weight*sum(along*abs(t%slave%x0), 1) &
                                                                 /max(norm2(along, 1), tiny(1.0_wp)))
               end associate
            end if
         end associate
      end do
      self%corrections = corrections
      self%unsettled = any([(self%interfaces(i)%acts .and. self%interfaces(i)%result%turns, i=1, &
                             size(self%interfaces))])
      self%rounding = ROUNDINGS*epsilon(1.0_wp)*norm2(rounding)
   end function evaluate

   function message(self) result(text)
      class(contacts_t), intent(in) :: self
      character(:), allocatable :: text

      text = contact_message(self%status)
   end function message

   !> Evaluates the contacts without slopes, into `probe` of every interface that acts: the outcome of the last
   !> evaluation within a step stays.
   logical function probe(self, x) result(good)
      class(contacts_t), intent(inout) :: self
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      integer :: i

      good = .true.
      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (.not. t%acts) cycle
            call probe_one(t, x, .false., .true., self%status)
            good = self%status%code == CONTACT_OK
            if (.not. good) return
         end associate
      end do
   end function probe

   !> Probes a copy of contacts, for those who may not change the contacts of a run.
   subroutine probe_copy(contacts, x, copy, good)
      class(surface_forces_t), intent(in) :: contacts   !< Such of contacts_t.
      real(wp), intent(in) :: x(:, :)                   !< (FIELDS, nodes) Displacements first [m].
      type(contacts_t), intent(out) :: copy
      logical, intent(out) :: good

      select type (contacts)
      type is (contacts_t)
         copy = contacts
      end select
      good = copy%probe(x)
   end subroutine probe_copy

   !> Evaluates one contact, with the friction that its step starts from; aside, no node has slid before. status: as of
   !> contact_evaluate.
   subroutine probe_one(t, x, with_tangent, aside, status)
      type(contact_interface_t), intent(inout), target :: t
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      logical, intent(in) :: with_tangent
      logical, intent(in) :: aside      !< The outcome goes to t%probe, not to t%result.
      type(contact_status_t), intent(out) :: status
      type(contact_result_t), pointer :: outcome
      real(wp) :: at(2, size(t%master%x0, 2))

      outcome => t%result
      if (aside) outcome => t%probe
      if (allocated(t%spring)) then
         call evaluate_springs(t%spring, x(:DISPLACEMENTS, t%slave%node), displacements_of_master(t, x), outcome)
         status = contact_status_t()
         return
      end if
      if (allocated(t%friction)) then
         if (aside) t%friction%side = 0
         t%friction%slave_dx = x(:DISPLACEMENTS, t%slave%node) - t%slave_u
         t%friction%master_dx = displacements_of_master(t, x) - t%master_u
      end if
      if (allocated(t%plate%motion)) then
         at = plate_positions(t%plate%motion, t%master%x0, motion_of(t%plate, x))
      else
         at = t%master%x0 + x(:DISPLACEMENTS, t%master%node)
      end if
      call contact_evaluate(t%geometry, t%slave%x0 + x(:DISPLACEMENTS, t%slave%node), at, with_tangent, t%work, &
                            outcome, status, t%friction)
   end subroutine probe_one

   !> Returns the displacements of the nodes of the master, or of the face of the plate [m].
   pure function displacements_of_master(t, x) result(u)
      type(contact_interface_t), intent(in) :: t
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      real(wp) :: u(DISPLACEMENTS, size(t%master%x0, 2))

      if (allocated(t%plate%motion)) then
         u = t%plate%motion%displacements(t%master%x0, motion_of(t%plate, x))
      else
         u = x(:DISPLACEMENTS, t%master%node)
      end if
   end function displacements_of_master

   !> Sets the displacements and gaps that the friction of a step starts from; false if a kernel refuses them.
   !> docs/theory/contact.md section 9.
   logical function begin_friction(self, x) result(good)
      class(contacts_t), intent(inout) :: self
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) Displacements first [m].
      integer :: i

      good = .true.
      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (.not. allocated(t%friction)) cycle
            ! Where it does not act nothing is held.
            if (.not. t%acts) t%friction%traction = 0.0_wp
            if (.not. t%acts) cycle
            t%slave_u = x(:DISPLACEMENTS, t%slave%node)
            t%master_u = displacements_of_master(t, x)
            t%friction%gap = 0.0_wp
            call probe_one(t, x, .false., .true., self%status)
            good = self%status%code == CONTACT_OK
            if (.not. good) return
            t%friction%gap = t%probe%gap
         end associate
      end do
   end function begin_friction

   !> Takes the tractions at the end of an accepted step; what sliding has dissipated in it [kJ].
   !> docs/theory/contact.md section 9.
   subroutine accept_friction(self, x, dissipated)
      class(contacts_t), intent(inout) :: self
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) At the end of the step, displacements first [m].
      real(wp), intent(out) :: dissipated
      integer :: i

      dissipated = 0.0_wp
      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (.not. allocated(t%friction) .or. .not. t%acts) cycle
            call probe_one(t, x, .false., .true., self%status)
            ! What a step has ended with, no kernel refuses.
            if (self%status%code /= CONTACT_OK) cycle
            dissipated = dissipated + slid_work(t%geometry%options, t%friction, t%probe)
            t%friction%traction = t%probe%traction
         end associate
      end do
   end subroutine accept_friction

   !> Tractions of the slave nodes along the slave's tangent at the start of the step [kPa].
   pure function tangential_tractions(t) result(tractions)
      type(contact_interface_t), intent(in) :: t
      real(wp) :: tractions(size(t%probe%traction))

      tractions = 0.0_wp
      if (allocated(t%friction)) tractions = t%friction%traction
   end function tangential_tractions

   function missing(self, pattern) result(pairs)
      class(contacts_t), intent(in) :: self
      type(pattern_t), intent(in) :: pattern
      integer, allocatable :: pairs(:, :)
      integer :: n, i

      allocate (pairs(2, sum([(room(self%interfaces(i)), i=1, size(self%interfaces))])))
      n = 0
      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (.not. t%acts) cycle
            if (allocated(t%plate%motion)) then
               call list(t%unknown, t%on_plate)
            else
               call list(t%unknown, t%result)
            end if
         end associate
      end do
      pairs = pairs(:, :n)
   contains
      pure integer function room(t)
         type(contact_interface_t), intent(in) :: t

         room = t%result%triplets + t%on_plate%triplets
      end function room

      subroutine list(u, forces)
         integer, intent(in) :: u(:)
         class(nodal_forces_t), intent(in) :: forces
         integer :: pair(2), k

         do k = 1, forces%triplets
            pair = u([forces%row(k), forces%column(k)])
            if (any(pair == 0)) cycle
            if (entry_of(pattern, pair(1), pair(2)) > 0) cycle
            n = n + 1
            pairs(:, n) = pair
         end do
      end subroutine list
   end function missing

   !> docs/theory/contact.md section 3.
   subroutine add(self, pattern, share, with_slopes, residual, scale, values)
      class(contacts_t), intent(in) :: self
      type(pattern_t), intent(in) :: pattern
      real(wp), intent(in) :: share
      logical, intent(in) :: with_slopes
      real(wp), intent(inout) :: residual(:), scale(:), values(:)
      integer :: i

      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (.not. t%acts) cycle
            if (allocated(t%plate%motion)) then
               call add_one(t%unknown, t%on_plate)
            else
               call add_one(t%unknown, t%result)
            end if
         end associate
      end do
   contains
      subroutine add_one(u, forces)
         integer, intent(in) :: u(:)
         class(nodal_forces_t), intent(in) :: forces
         integer :: pair(2), k, place

         do k = 1, size(u)
            if (u(k) == 0) cycle
            residual(u(k)) = residual(u(k)) + forces%force(k)
            scale(u(k)) = scale(u(k)) + forces%size(k)
         end do
         if (.not. with_slopes) return
         do k = 1, forces%triplets
            pair = u([forces%row(k), forces%column(k)])
            if (any(pair == 0)) cycle
            place = entry_of(pattern, pair(1), pair(2))
            values(place) = values(place) + share*forces%value(k)
         end do
      end subroutine add_one
   end subroutine add

   subroutine stretch(self, x, stretched)
      class(contacts_t), intent(in) :: self
      real(wp), intent(in) :: x(:, :)
      real(wp), intent(out) :: stretched(:, :)
      integer :: i

      stretched = 0.0_wp
      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (allocated(t%spring)) stretched(:, t%slave%node) = x(:DISPLACEMENTS, t%slave%node) &
                                                                  - displacements_of_master(t, x)
         end associate
      end do
   end subroutine stretch

   subroutine find_closed(self, x, closed)
      class(contacts_t), intent(inout) :: self
      real(wp), intent(in) :: x(:, :)
      logical, intent(out) :: closed(:)
      integer :: i

      closed = .false.
      if (.not. self%probe(x)) return
      do i = 1, size(closed)
         associate (t => self%interfaces(i))
            if (t%acts) closed(i) = any(t%probe%active)
         end associate
      end do
   end subroutine find_closed

   logical function forces(self, dofs, x, force) result(good)
      class(contacts_t), intent(inout) :: self
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: x(:, :)
      real(wp), allocatable, intent(out) :: force(:)

      real(wp), allocatable :: f(:)
      integer :: c, k, n

      allocate (force(dofs%n), source=0.0_wp)
      good = self%probe(x)
      if (.not. good) return
      do c = 1, size(self%interfaces)
         associate (t => self%interfaces(c))
            if (.not. t%acts) cycle
            f = t%probe%force
            n = 2*t%geometry%slave_nodes
            if (allocated(t%plate%motion)) f = [f(:n), force_on_plate(t%geometry, t%probe, &
               t%plate%motion%slopes(t%master%x0, motion_of(t%plate, x)))]
            do k = 1, size(f)
               if (t%unknown(k) > 0) force(t%unknown(k)) = force(t%unknown(k)) + f(k)
            end do
         end associate
      end do
   end function forces

   !> Exchanges with an archive the tractions of friction, which contacts carry from step to step.
   subroutine exchange_friction(self, archive)
      class(contacts_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive
      integer :: i

      do i = 1, size(self%interfaces)
         associate (t => self%interfaces(i))
            if (allocated(t%friction)) call archive%exchange('friction_'//whole(i), t%friction%traction, 'kPa', &
               'traction of every slave node of a contact with friction')
         end associate
      end do
   end subroutine exchange_friction
end module contact_interfaces
