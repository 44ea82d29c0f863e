! SPDX-License-Identifier: MIT
!> Contact of fixed geometry: which parts of the surfaces lie opposite each other, their normals and weights are those
!> of the start, so that gaps are linear in the displacements. For displacements that are small against the elements.
!> docs/theory/contact.md section 3.4.
module contact_fixed
   use kinds, only: wp
   use contact_geometry, only: contact_geometry_t, check_coordinates
   use contact_mortar, only: overlap_t, point_t, find_overlap, integration_point, unit_push, pair_gaps, hats, POINTS, &
                             POSITION, SHARE, END_POSITION, END_SHARE
   use contact_penalty, only: contact_result_t, new_result, find_whole, share_penalty, unknowns_of, add_column, &
                              make_room
   use contact_search, only: search_t, prepare_search, find_candidates
   use contact_types, only: contact_options_t, contact_status_t, contact_fail, is_finite, COMBINED_GAP, CONTACT_OK, &
                            CONTACT_NO_PROJECTION, CONTACT_NOT_OPPOSITE, CONTACT_NOT_FINITE
   implicit none (type, external)
   private
   public :: fixed_contact_t, fix_geometry, evaluate_fixed

   real(wp), parameter :: FAR = 4.0_wp   !< Search radius, where none is given, over the size of both surfaces [-].

   !> A gap times its weight that is linear in the displacements: q = q_0 - sum push du. Its pressure is
   !> eps max(0, -q/w), the forces on the nodes push times the pressure.
   type :: row_t
      real(wp) :: penalty = 0.0_wp              !< eps of this row [kN/m3]; 0: the gap is only reported.
      real(wp) :: q = 0.0_wp, weight = 0.0_wp   !< At the start: [m3] (plane: m2), [m2] (plane: m).
      integer, allocatable :: unknown(:)
      real(wp), allocatable :: push(:)          !< Force of a unit pressure [m2] (plane: m).
      integer :: node(3) = 1                    !< Slave nodes that report the pressure.
      real(wp) :: part(3) = 0.0_wp              !< How much of it each of them reports [-].
   end type row_t

   type :: fixed_contact_t
      type(row_t), allocatable :: rows(:)       !< First those of the slave's nodes, in their order.
      integer :: room = 0                       !< Triplets at most.
      integer :: pairs = 0
      real(wp), allocatable :: weight(:), whole(:)   !< (slave nodes) As of contact_result_t.
   end type fixed_contact_t
contains
   !> Takes overlap, normals and weights from coordinates of the start. docs/theory/contact.md section 3.4. Surfaces at
   !> any distance are paired unless the options have a search radius. status: as of check_coordinates;
   !> CONTACT_NO_PROJECTION; CONTACT_NOT_OPPOSITE, nothing of the surfaces faces each other.
   pure subroutine fix_geometry(geometry, slave_x, master_x, fixed, status)
      type(contact_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: slave_x(:, :), master_x(:, :)   !< (2, nodes) at the start [m]
      type(fixed_contact_t), intent(out) :: fixed
      type(contact_status_t), intent(out) :: status
      type(contact_options_t) :: nodal, pointwise
      type(contact_result_t) :: at_start
      type(search_t) :: search
      type(overlap_t) :: overlap
      real(wp) :: weight(3), weighted_gap(3), d_weight(12, 3), d_weighted_gap(12, 3), push(12, 3), x(2, 6), radius
      real(wp) :: missed
      integer :: e, c, a, i, unknown(12)

      call check_coordinates(geometry, slave_x, master_x, status)
      if (status%code /= CONTACT_OK) return
      call share_penalty(geometry%options, nodal, pointwise)
      at_start = new_result(geometry)
      call find_whole(geometry, slave_x, at_start)
      allocate (fixed%rows(geometry%slave_nodes))
      fixed%rows%penalty = nodal%penalty
      do i = 1, geometry%slave_nodes
         fixed%rows(i)%node = i
         fixed%rows(i)%part(1) = 1.0_wp
         allocate (fixed%rows(i)%unknown(0), fixed%rows(i)%push(0))
      end do
      radius = geometry%options%search_radius
      if (.not. radius > 0.0_wp) radius = FAR*(maxval(slave_x) - minval(slave_x) + maxval(master_x) - minval(master_x) &
                                               + norm2(sum(slave_x, dim=2)/size(slave_x, 2) &
                                                       - sum(master_x, dim=2)/size(master_x, 2)))
      call prepare_search(search, size(geometry%slave_edges, 2), size(geometry%master_edges, 2))
      call find_candidates(search, slave_x, geometry%slave_edges, master_x, geometry%master_edges, radius)
      do e = 1, size(geometry%slave_edges, 2)
         do c = search%first(e), search%first(e + 1) - 1
            associate (slave => geometry%slave_edges(:, e), master => geometry%master_edges(:, search%candidate(c)))
               x(:, 1:3) = slave_x(:, slave)
               x(:, 4:6) = master_x(:, master)
               call find_overlap(x, geometry%free(master(1:2)), overlap)
               if (overlap%segments == 0) cycle
               call pair_gaps(x, overlap, geometry%options%axisymmetric, weight, weighted_gap, d_weight, &
                              d_weighted_gap, push, missed)
               unknown = unknowns_of(geometry, e, search%candidate(c))
               do a = 1, 3
                  if (missed > 0.0_wp) exit
                  fixed%rows(slave(a))%weight = fixed%rows(slave(a))%weight + weight(a)
                  fixed%rows(slave(a))%q = fixed%rows(slave(a))%q + weighted_gap(a)
                  call add_push(fixed%rows(slave(a)), unknown, push(:, a))
               end do
               if (pointwise%penalty > 0.0_wp .and. .not. missed > 0.0_wp) &
                  call add_points(x, overlap, pointwise, geometry%options%gap == COMBINED_GAP, slave, unknown, &
                                  fixed, missed)
            end associate
            if (missed > 0.0_wp) then
               status = contact_fail(CONTACT_NO_PROJECTION, e, .false., missed)
               return
            end if
            fixed%pairs = fixed%pairs + 1
         end do
      end do
      if (fixed%pairs == 0) status = contact_fail(CONTACT_NOT_OPPOSITE)
      fixed%whole = at_start%whole
      fixed%weight = fixed%rows(:geometry%slave_nodes)%weight
      do i = 1, size(fixed%rows)
         fixed%room = fixed%room + size(fixed%rows(i)%unknown)**2
         ! A point's pressure is shared out to the nodes whose hats it lies under.
         if (i > geometry%slave_nodes) fixed%rows(i)%part = fixed%rows(i)%part &
                                                           /max(fixed%weight(fixed%rows(i)%node), tiny(1.0_wp))
      end do
   end subroutine fix_geometry

   !> A row of its own for every integration point of a pair.
   pure subroutine add_points(x, overlap, options, at_ends, slave, unknown, fixed, missed)
      real(wp), intent(in) :: x(2, 6)
      type(overlap_t), intent(in) :: overlap
      type(contact_options_t), intent(in) :: options   !< Of the pointwise form.
      logical, intent(in) :: at_ends
      integer, intent(in) :: slave(3), unknown(12)
      type(fixed_contact_t), intent(inout) :: fixed
      real(wp), intent(out) :: missed
      type(row_t), allocatable :: more(:)
      type(point_t) :: p
      integer :: segment, k, n

      missed = 0.0_wp
      n = size(fixed%rows)
      allocate (more(n + POINTS*overlap%segments))
      more(:n) = fixed%rows
      do segment = 1, overlap%segments
         do k = 1, POINTS
            call integration_point(x, overlap, segment, merge(END_POSITION(k), POSITION(k), at_ends), &
                                   merge(END_SHARE(k), SHARE(k), at_ends), options%axisymmetric, p, missed)
            if (missed > 0.0_wp) return
            n = n + 1
            more(n)%penalty = options%penalty
            more(n)%q = p%area*p%phi
            more(n)%weight = p%area*p%length
            more(n)%node = slave
            more(n)%part = p%area*p%length*hats(p%s)
            allocate (more(n)%unknown(0), more(n)%push(0))
            call add_push(more(n), unknown, p%area*unit_push(p))
         end do
      end do
      call move_alloc(more, fixed%rows)
   end subroutine add_points

   pure subroutine add_push(row, unknown, push)
      type(row_t), intent(inout) :: row
      integer, intent(in) :: unknown(12)
      real(wp), intent(in) :: push(12)
      integer :: j, at

      do j = 1, 12
         if (.not. abs(push(j)) > 0.0_wp) cycle
         at = findloc(row%unknown, unknown(j), dim=1)
         if (at > 0) then
            row%push(at) = row%push(at) + push(j)
         else
            row%unknown = [row%unknown, unknown(j)]
            row%push = [row%push, push(j)]
         end if
      end do
   end subroutine add_push

   !> Everything at given displacements, as contact_evaluate has it. docs/theory/contact.md section 3.4. status:
   !> CONTACT_NOT_FINITE; result%active is then still that of the evaluation before.
   pure subroutine evaluate_fixed(geometry, fixed, slave_u, master_u, with_tangent, result, status)
      type(contact_geometry_t), intent(in) :: geometry
      type(fixed_contact_t), intent(in) :: fixed
      real(wp), intent(in) :: slave_u(:, :), master_u(:, :)   !< (2, nodes) from the start [m]
      logical, intent(in) :: with_tangent
      type(contact_result_t), intent(inout) :: result
      type(contact_status_t), intent(out) :: status
      real(wp) :: u(2*(size(slave_u, 2) + size(master_u, 2))), gap, pressure
      integer :: i, j, n

      n = 2*size(slave_u, 2)
      u(:n) = reshape(slave_u, [n])
      u(n + 1:) = reshape(master_u, [size(u) - n])
      i = findloc(is_finite(u), .false., dim=1)
      if (i > 0) then
         status = contact_fail(CONTACT_NOT_FINITE, merge(i + 1, i - n + 1, i <= n)/2, i > n)
         return
      end if
      result%force = 0.0_wp
      result%triplets = 0
      result%energy = 0.0_wp
      result%pressure = 0.0_wp
      result%gap = 0.0_wp
      result%weight = fixed%weight
      result%whole = fixed%whole
      result%pairs = fixed%pairs
      if (with_tangent) call make_room(result, fixed%room)
      do i = 1, size(fixed%rows)
         associate (row => fixed%rows(i))
            if (.not. row%weight > 0.0_wp) cycle
            gap = (row%q - dot_product(row%push, u(row%unknown)))/row%weight
            if (i <= geometry%slave_nodes) result%gap(i) = gap
            pressure = row%penalty*max(-gap, 0.0_wp)
            if (.not. pressure > 0.0_wp) cycle
            result%energy = result%energy + 0.5_wp*row%weight*pressure**2/row%penalty
            result%force(row%unknown) = result%force(row%unknown) + pressure*row%push
            do j = 1, 3
               result%pressure(row%node(j)) = result%pressure(row%node(j)) + row%part(j)*pressure
            end do
            if (.not. with_tangent) cycle
            do j = 1, size(row%push)
               call add_column(result, row%unknown, row%unknown(j), row%penalty/row%weight*row%push(j)*row%push)
            end do
         end associate
      end do
      result%changed = count(result%active .neqv. result%pressure > 0.0_wp)
      result%active = result%pressure > 0.0_wp
   end subroutine evaluate_fixed
end module contact_fixed
