! SPDX-License-Identifier: MIT
!> Mortar contact by penalty, with friction where it is asked for: weights, gaps, pressures and tractions of the slave
!> nodes, energy, nodal forces and the consistent tangent of both surfaces: docs/theory/contact.md sections 2, 3 and 9;
!> host/CONTACT.md has the limits.
module contact_penalty
   use contact_friction, only: friction_state_t, traction_t, pair_slips, traction_at, tangential_stiffness, &
                               touching_share
   use contact_geometry, only: contact_geometry_t, check_coordinates, edge_boxes, boxes_around, boxes_meet
   use contact_mortar, only: overlap_t, mortar_point_t, hat_sums_t, find_overlap, pair_points, pair_gaps, penetration, &
                             hats, POINTS, POSITION, SHARE, LARGEST_POINTS
   use contact_projection, only: edge_t, edge_of, place, tangent
   use contact_response, only: pair_response_t, nodal_forces_t, nodal_response, pointwise_response, new_forces, &
                               make_room, add_column
   use contact_types, only: TWO_PI, COMBINED_GAP, contact_options_t, contact_status_t, &
                            CONTACT_OK, CONTACT_NO_PROJECTION
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: contact_workspace_t, contact_result_t, new_workspace, new_result, contact_evaluate, slid_work

   !> Share of the penalty on the gap at points, where nodal gaps, those at points or both are penalised [-].
   !> docs/theory/contact.md section 2.4.
   real(wp), parameter :: SHARE_AT_POINTS(3) = [0.0_wp, 1.0_wp, 0.5_wp]

   !> A slave edge with a master edge opposite.
   type :: pair_t
      integer :: slave = 0, master = 0
      real(wp) :: x(2, 6) = 0.0_wp                   !< Local coordinates [m].
      type(overlap_t) :: overlap
      integer :: n = 0
      type(mortar_point_t) :: points(LARGEST_POINTS)   !< Integration points, the first n.
      type(hat_sums_t) :: weight, gap, slip          !< Gap and slip times the weight; the slip with friction.
      real(wp) :: push(12, 3) = 0.0_wp, drag(12, 3) = 0.0_wp   !< Forces of a unit pressure and traction at each node.
   end type pair_t

   !> Room for an evaluation; what it holds between two is of no meaning.
   type :: contact_workspace_t
      private
      integer, allocatable :: first_pair(:)     !< First pair of every slave edge.
      type(pair_t), allocatable :: pair(:)
      integer, allocatable :: position(:), touched(:)   !< Unknowns that a nodal gap depends on.
      real(wp), allocatable :: left(:), right(:)        !< Force of a unit dp_A, slope of p_A over -1.
      real(wp), allocatable :: load(:)                  !< int M_A p 2 pi r dGamma, pointwise form.
   end type contact_workspace_t

   !> Outcome of an evaluation.
   type, extends(nodal_forces_t) :: contact_result_t
      real(wp) :: energy = 0.0_wp               !< 1/2 eps sum_A w_A <-g_A>**2, or eq. (18) [kN m] (plane: kN)
      real(wp), allocatable :: weight(:)        !< w_A of the part opposite the master [m2] (plane: m)
      real(wp), allocatable :: whole(:)         !< w_A if everything were opposite: weight/whole is the coverage.
      real(wp), allocatable :: gap(:)           !< g_A, open > 0; 0 where w_A = 0 [m]
      real(wp), allocatable :: pressure(:)      !< p_A >= 0 [kPa]
      logical, allocatable :: active(:)         !< p_A > 0
      real(wp), allocatable :: slip(:)          !< Since the start of the step, with friction [m]
      real(wp), allocatable :: traction(:)      !< t_A, of the friction on the master along the slave's tangent [kPa]
      integer, allocatable :: side(:)           !< Way of sliding where the traction is at its limit: -1, 1; else 0.
      logical :: turns = .false.                !< A node slides the other way than at the iterate before: it is held.
      real(wp) :: unpressed = 0.0_wp            !< Deepest penetration without pressure, over its edge [-].
      real(wp) :: unpressed_at(2) = 0.0_wp      !< Middle of the edge with this penetration [m].
      integer :: pairs = 0                      !< Pairs of edges opposite each other.
   end type contact_result_t
contains
   !> Makes room for evaluations of prepared surfaces.
   pure function new_workspace(geometry) result(work)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_workspace_t) :: work
      integer :: unknowns, slaves, masters

      unknowns = 2*(geometry%slave_nodes + geometry%master_nodes)
      slaves = size(geometry%slave_edges, 2)
      masters = size(geometry%master_edges, 2)
      allocate (work%first_pair(slaves + 1), source=1)
      allocate (work%pair(slaves + masters))
      allocate (work%position(unknowns), work%touched(unknowns), source=0)
      allocate (work%left(unknowns), work%right(unknowns), work%load(geometry%slave_nodes), source=0.0_wp)
   end function new_workspace

   !> Makes a result in which nothing is in contact.
   pure function new_result(geometry) result(result)
      type(contact_geometry_t), intent(in) :: geometry
      type(contact_result_t) :: result

      result%nodal_forces_t = new_forces(2*(geometry%slave_nodes + geometry%master_nodes))
      associate (n => geometry%slave_nodes)
         allocate (result%weight(n), result%whole(n), result%gap(n), result%pressure(n), result%slip(n), &
                   result%traction(n), source=0.0_wp)
         allocate (result%active(n), source=.false.)
         allocate (result%side(n), source=0)
      end associate
   end function new_result

   !> Evaluates everything for current coordinates. If the status is not CONTACT_OK the answer is of no use.
   !> docs/theory/contact.md sections 2 and 3, paper eqs (17), (18).
   !> status: as of check_coordinates; CONTACT_NO_PROJECTION where a normal of the slave misses the master edge
   !> opposite.
   pure subroutine contact_evaluate(geometry, slave_x, master_x, with_tangent, work, result, status, friction)
      type(contact_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: slave_x(:, :), master_x(:, :)   !< (2, nodes): r and z, or x and y [m]
      logical, intent(in) :: with_tangent
      type(contact_workspace_t), intent(inout) :: work
      type(contact_result_t), intent(inout) :: result
      type(contact_status_t), intent(out) :: status
      type(friction_state_t), intent(in), optional :: friction   !< Needed where the options have friction.

      result%force = 0.0_wp
      result%triplets = 0
      result%energy = 0.0_wp
      result%pairs = 0
      call check_coordinates(geometry, slave_x, master_x, status)
      if (status%code /= CONTACT_OK) return
      if (size(geometry%slave_edges) == 0 .or. size(geometry%master_edges) == 0) return

      call find_whole(geometry, slave_x, result)
      call find_gaps(geometry, slave_x, master_x, work, result, status)
      if (status%code /= CONTACT_OK) return
      call respond(geometry, with_tangent, work, result, status)
      if (status%code /= CONTACT_OK) return
      if (present(friction)) call add_friction(geometry, with_tangent, friction, work, result)
      result%active = result%pressure > 0.0_wp
      result%size = abs(result%force)
   end subroutine contact_evaluate

   !> Sets result%whole, the weights of the whole slave edges. The hats bend at the middle node, so both halves are
   !> integrated. docs/theory/contact.md section 2.3.
   pure subroutine find_whole(geometry, slave_x, result)
      type(contact_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: slave_x(:, :)   !< (2, nodes) [m]
      type(contact_result_t), intent(inout) :: result
      type(edge_t) :: edge
      real(wp) :: s, ring, x(2)
      integer :: e, k, side

      result%whole = 0.0_wp
      do e = 1, size(geometry%slave_edges, 2)
         associate (nodes => geometry%slave_edges(:, e))
            edge = edge_of(slave_x(:, nodes))
            do side = -1, 1, 2
               do k = 1, POINTS
                  s = 0.5_wp*(POSITION(k) + side)
                  x = place(edge, s)
                  ring = merge(TWO_PI*x(1), 1.0_wp, geometry%options%axisymmetric)
                  ! Half the Gauss weight for half the edge, whose length is 2.
                  result%whole(nodes) = result%whole(nodes) + 0.5_wp*SHARE(k)*ring*norm2(tangent(edge, s))*hats(s)
               end do
            end do
         end associate
      end do
   end subroutine find_whole

   !> Finds the edges opposite each other, and from them the weights and gaps of the slave nodes.
   pure subroutine find_gaps(geometry, slave_x, master_x, work, result, status)
      type(contact_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: slave_x(:, :), master_x(:, :)
      type(contact_workspace_t), intent(inout) :: work
      type(contact_result_t), intent(inout) :: result
      type(contact_status_t), intent(out) :: status
      real(wp) :: slaves(4, size(geometry%slave_edges, 2)), masters(4, size(geometry%master_edges, 2))
      real(wp) :: missed
      integer :: e, master, n

      call boxes_around(slave_x, geometry%slave_edges, geometry%options%search_radius, slaves)
      call edge_boxes(master_x, geometry%master_edges, masters)
      result%weight = 0.0_wp
      result%gap = 0.0_wp
      n = 0
      do e = 1, size(geometry%slave_edges, 2)
         work%first_pair(e) = n + 1
         do master = 1, size(masters, 2)
            if (.not. boxes_meet(slaves(:, e), masters(:, master))) cycle
            if (n == size(work%pair)) call grow_pairs(work%pair)
            associate (pair => work%pair(n + 1))
               pair%x = of_edges(geometry, e, master, slave_x, master_x)
               call find_overlap(pair%x, geometry%free(geometry%master_edges(1:2, master)), pair%overlap)
               if (pair%overlap%segments == 0) cycle
               n = n + 1
               pair%slave = e
               pair%master = master
               call pair_points(pair%x, pair%overlap, .false., geometry%options%axisymmetric, pair%points, pair%n, &
                                missed)
               if (missed > 0.0_wp) then
                  status = contact_status_t(CONTACT_NO_PROJECTION, e, .false., missed)
                  return
               end if
               call pair_gaps(pair%points(:pair%n), pair%weight, pair%gap, pair%push)
               associate (nodes => geometry%slave_edges(:, e))
                  result%weight(nodes) = result%weight(nodes) + pair%weight%value
                  result%gap(nodes) = result%gap(nodes) + pair%gap%value
               end associate
            end associate
         end do
      end do
      work%first_pair(e) = n + 1
      result%pairs = n
      where (result%weight > 0.0_wp)
         result%gap = result%gap/result%weight
      elsewhere
         result%gap = 0.0_wp
      end where
   end subroutine find_gaps

   !> Finds pressures, energy, forces and tangent from the gaps.
   pure subroutine respond(geometry, with_tangent, work, result, status)
      type(contact_geometry_t), intent(in) :: geometry
      logical, intent(in) :: with_tangent
      type(contact_workspace_t), intent(inout) :: work
      type(contact_result_t), intent(inout) :: result
      type(contact_status_t), intent(out) :: status
      type(pair_response_t) :: response
      real(wp) :: at_points, at_nodes, energy
      real(wp) :: depth   !< Penetration that no pressure answers, over its edge [-].
      logical :: pressed
      integer :: i

      result%pressure = 0.0_wp
      result%unpressed = 0.0_wp
      work%load = 0.0_wp
      at_points = SHARE_AT_POINTS(geometry%options%gap)*geometry%options%penalty
      at_nodes = geometry%options%penalty - at_points
      if (at_nodes > 0.0_wp) then
         result%pressure = at_nodes*max(-result%gap, 0.0_wp)
         result%energy = sum(0.5_wp*result%weight*result%pressure**2)/at_nodes
      end if
      do i = 1, result%pairs
         associate (pair => work%pair(i), nodes => geometry%slave_edges(:, work%pair(i)%slave))
            energy = result%energy
            pressed = any(result%pressure(nodes) > 0.0_wp)
            if (pressed) then
               call nodal_response(pair%points(:pair%n), .false., result%pressure(nodes), with_tangent, response)
               call add_response(unknowns_of(geometry, pair%slave, pair%master), response, with_tangent, result)
            end if
            if (at_points > 0.0_wp) &
               call press_points(geometry, at_points, pair, with_tangent, work%load, result, status)
            if (status%code /= CONTACT_OK) return
            ! Combined gaps press wherever they look, and they look at the ends.
            if (pressed .or. result%energy > energy .or. geometry%options%gap == COMBINED_GAP) cycle
            depth = penetration(pair%x, pair%overlap)/norm2(pair%x(:, 2) - pair%x(:, 1))
            if (depth <= result%unpressed) cycle
            result%unpressed = depth
            result%unpressed_at = pair%x(:, 3)
         end associate
      end do
      if (with_tangent) then
         do i = 1, geometry%slave_nodes
            if (result%pressure(i) > 0.0_wp) call add_node(geometry, i, work, result, -at_nodes)
         end do
      end if
      if (at_points > 0.0_wp) then
         where (result%weight > 0.0_wp) result%pressure = result%pressure + work%load/result%weight
      end if
   end subroutine respond

   !> Adds friction: slips and tractions of the slave nodes, their forces and tangent. docs/theory/contact.md section 9.
   pure subroutine add_friction(geometry, with_tangent, friction, work, result)
      type(contact_geometry_t), intent(in) :: geometry
      logical, intent(in) :: with_tangent
      type(friction_state_t), intent(in) :: friction
      type(contact_workspace_t), intent(inout) :: work
      type(contact_result_t), intent(inout) :: result
      type(traction_t) :: t(geometry%slave_nodes)
      type(pair_response_t) :: response
      real(wp) :: dx(2, 6)
      integer :: i

      result%slip = 0.0_wp
      do i = 1, result%pairs
         associate (pair => work%pair(i), nodes => geometry%slave_edges(:, work%pair(i)%slave))
            dx = of_edges(geometry, pair%slave, pair%master, friction%slave_dx, friction%master_dx)
            call pair_slips(pair%points(:pair%n), dx, pair%slip, pair%drag)
            result%slip(nodes) = result%slip(nodes) + pair%slip%value
         end associate
      end do
      where (result%weight > 0.0_wp) result%slip = result%slip/result%weight
      do i = 1, geometry%slave_nodes
         t(i) = traction_at(geometry%options, friction%traction(i), friction%gap(i), result%gap(i), result%slip(i), &
                            friction%side(i))
      end do
      result%traction = t%value
      result%side = t%side
      result%turns = any(t%turns)
      do i = 1, result%pairs
         associate (pair => work%pair(i))
            if (.not. any(abs(result%traction(geometry%slave_edges(:, pair%slave))) > 0.0_wp)) cycle
            call nodal_response(pair%points(:pair%n), .true., result%traction(geometry%slave_edges(:, pair%slave)), &
                                with_tangent, response)
            call add_response(unknowns_of(geometry, pair%slave, pair%master), response, with_tangent, result)
         end associate
      end do
      if (.not. with_tangent) return
      do i = 1, geometry%slave_nodes
         if (result%gap(i) < 0.0_wp) call add_node(geometry, i, work, result, t(i)%by_gap, t(i)%by_slip)
      end do
   end subroutine add_friction

   !> Sums what sliding has dissipated from the start of a step to an evaluation [kN m]: traction times the slip that is
   !> not the penalty's. Never negative: sliding has the sign of its traction. docs/theory/contact.md section 9.
   pure real(wp) function slid_work(options, friction, result) result(total)
      type(contact_options_t), intent(in) :: options
      type(friction_state_t), intent(in) :: friction
      type(contact_result_t), intent(in) :: result
      real(wp) :: stiffness, slip, before
      integer :: i

      stiffness = tangential_stiffness(options)
      total = 0.0_wp
      do i = 1, size(result%traction)
         if (result%side(i) == 0) cycle
         before = merge(0.0_wp, friction%traction(i), friction%gap(i) > 0.0_wp)
         slip = touching_share(friction%gap(i), result%gap(i))*result%slip(i)
         total = total + result%weight(i)*result%traction(i)*(slip - (result%traction(i) - before)/stiffness)
      end do
   end function slid_work

   !> Adds the parts of a pair that the gap at its points gives to forces, energy and tangent.
   pure subroutine press_points(geometry, penalty, pair, with_tangent, load, result, status)
      type(contact_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: penalty                  !< [kN/m3]
      type(pair_t), intent(in) :: pair
      logical, intent(in) :: with_tangent
      real(wp), intent(inout) :: load(:)               !< int M_A p 2 pi r dGamma [kN]
      type(contact_result_t), intent(inout) :: result
      type(contact_status_t), intent(inout) :: status
      type(pair_response_t) :: response
      type(mortar_point_t) :: ends(LARGEST_POINTS)
      real(wp) :: missed
      integer :: n

      associate (nodes => geometry%slave_edges(:, pair%slave))
         if (geometry%options%gap == COMBINED_GAP) then
            ! A corner lies at the end of a segment, where the rule of the pressures does not look.
            call pair_points(pair%x, pair%overlap, .true., geometry%options%axisymmetric, ends, n, missed)
            if (missed > 0.0_wp) then
               status = contact_status_t(CONTACT_NO_PROJECTION, pair%slave, .false., missed)
               return
            end if
            call pointwise_response(ends(:n), penalty, with_tangent, response)
         else
            call pointwise_response(pair%points(:pair%n), penalty, with_tangent, response)
         end if
         result%energy = result%energy + response%energy
         load(nodes) = load(nodes) + response%load
         call add_response(unknowns_of(geometry, pair%slave, pair%master), response, &
                           with_tangent .and. .not. response%energy <= 0.0_wp, result)
      end associate
   end subroutine press_points

   !> Adds the forces of a pair, and its stiffness where the tangent is wanted.
   pure subroutine add_response(unknown, response, with_tangent, result)
      integer, intent(in) :: unknown(12)   !< Numbers of the unknowns, as of unknowns_of.
      type(pair_response_t), intent(in) :: response
      logical, intent(in) :: with_tangent
      type(contact_result_t), intent(inout) :: result
      integer :: j

      result%force(unknown) = result%force(unknown) + response%force
      if (.not. with_tangent) return
      call make_room(result, size(response%stiffness))
      do j = 1, 12
         call add_column(result, unknown, unknown(j), response%stiffness(:, j))
      end do
   end subroutine add_response

   !> Adds the change of a nodal pressure to the tangent, dp_A = by_gap dg_A times what a unit of p_A pushes; with
   !> by_slip that of a nodal traction, dt_A = by_gap dg_A + by_slip ds_A times what a unit of t_A drags. Over all
   !> unknowns that the gap depends on.
   pure subroutine add_node(geometry, node, work, result, by_gap, by_slip)
      type(contact_geometry_t), intent(in) :: geometry
      integer, intent(in) :: node
      type(contact_workspace_t), intent(inout) :: work
      type(contact_result_t), intent(inout) :: result
      real(wp), intent(in) :: by_gap   !< [kN/m3]
      real(wp), intent(in), optional :: by_slip   !< [kN/m3]
      integer :: unknown(12), side, edge, i, j, a, n

      n = 0
      do side = 1, 2
         edge = geometry%edges_of(side, node)
         if (edge == 0) cycle
         a = findloc(geometry%slave_edges(:, edge), node, dim=1)
         do i = work%first_pair(edge), work%first_pair(edge + 1) - 1
            unknown = unknowns_of(geometry, edge, work%pair(i)%master)
            do j = 1, 12
               if (work%position(unknown(j)) > 0) cycle
               n = n + 1
               work%position(unknown(j)) = n
               work%touched(n) = unknown(j)
               work%left(n) = 0.0_wp
               work%right(n) = 0.0_wp
            end do
            associate (pair => work%pair(i), at => work%position(unknown))
               work%right(at) = work%right(at) &
                                + by_gap*(pair%gap%slope(:, a) - result%gap(node)*pair%weight%slope(:, a))
               if (present(by_slip)) then
                  work%right(at) = work%right(at) &
                                   + by_slip*(pair%slip%slope(:, a) - result%slip(node)*pair%weight%slope(:, a))
                  work%left(at) = work%left(at) + pair%drag(:, a)
               else
                  work%left(at) = work%left(at) + pair%push(:, a)
               end if
            end associate
         end do
      end do
      call make_room(result, n*n)
      do j = 1, n
         work%position(work%touched(j)) = 0
         call add_column(result, work%touched(:n), work%touched(j), work%right(j)/result%weight(node)*work%left(:n))
      end do
   end subroutine add_node

   !> Numbers of the displacements of a pair of edges: first those of the slave's nodes, then those of the master's.
   pure function unknowns_of(geometry, slave, master) result(unknown)
      type(contact_geometry_t), intent(in) :: geometry
      integer, intent(in) :: slave, master   !< Numbers of the edges.
      integer :: unknown(12)

      unknown(1:5:2) = 2*geometry%slave_edges(:, slave) - 1
      unknown(7:11:2) = 2*(geometry%slave_nodes + geometry%master_edges(:, master)) - 1
      unknown(2:12:2) = unknown(1:11:2) + 1
   end function unknowns_of

   !> Gathers values at the nodes of a pair of edges, those of the slave first.
   pure function of_edges(geometry, slave, master, of_slave, of_master) result(of_pair)
      type(contact_geometry_t), intent(in) :: geometry
      integer, intent(in) :: slave, master                     !< Numbers of the edges.
      real(wp), intent(in) :: of_slave(:, :), of_master(:, :)  !< (2, nodes)
      real(wp) :: of_pair(2, 6)

      of_pair(:, 1:3) = of_slave(:, geometry%slave_edges(:, slave))
      of_pair(:, 4:6) = of_master(:, geometry%master_edges(:, master))
   end function of_edges

   pure subroutine grow_pairs(pair)
      type(pair_t), allocatable, intent(inout) :: pair(:)
      type(pair_t), allocatable :: larger(:)

      allocate (larger(2*size(pair) + 1))
      larger(:size(pair)) = pair
      call move_alloc(larger, pair)
   end subroutine grow_pairs
end module contact_penalty
