! SPDX-License-Identifier: MIT
!> Where the named points of a scene lie: in which element, and with which weights of its nodes. No point is moved to a
!> node: so every mesh of a scene tells of the same places.
module named_points
   use kinds, only: wp
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise
   use porous_domain, only: domain_t
   use model_types, only: point_t
   use shape_functions, only: quadratic, linear
   use texts, only: place_text
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: find_point, values_at

   real(wp), parameter :: SAME_PLACE = 1.0e-9_wp   !< Share of the mesh: a point nearer to a node is there.
   real(wp), parameter :: EQUALLY_NEAR = 1.0e-6_wp !< Share of a distance that is rounding of coordinates.
   real(wp), parameter :: SETTLED = 1.0e-10_wp     !< Local coordinates are known to this.
   !> A point outside the mesh by less than this share of an element takes the values that the element continues to: its
   !> coordinates may have been rounded, or stand for a side that is bent.
   real(wp), parameter :: ROUNDED = 0.05_wp
   !> Local coordinates of the nodes of a triangle.
   real(wp), parameter :: PLACES(2, 6) = reshape([0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 0.5_wp, 0.0_wp, &
                                                  0.5_wp, 0.5_wp, 0.0_wp, 0.5_wp], [2, 6])
   integer, parameter :: MOST_ITERATIONS = 20      !< For the local coordinates in an element with bent sides.
contains
   !> Finds the nodes, weights and nearest quadrature point of a point. Fault EXIT_GROUP: it lies outside the mesh.
   subroutine find_point(m, point, fault)
      type(domain_t), intent(in) :: m
      type(point_t), intent(inout) :: point
      type(fault_t), intent(inout) :: fault
      real(wp) :: distance(size(m%mesh%x, 2)), place(2), local(2), dn(2, 6), dn_linear(2, 3), within, most
      logical :: in_ground(size(distance))
      integer :: e, g, i, node, k

      associate (mesh => m%mesh)
         in_ground = .false.
         in_ground([mesh%t6]) = .true.
         distance = [(norm2(mesh%x(:, i) - point%x), i=1, size(distance))]
         node = minloc(distance, 1, mask=in_ground)
         e = 0
         most = -ROUNDED
         if (distance(node) <= SAME_PLACE*maxval(abs(mesh%x - spread(mesh%x(:, node), 2, size(mesh%x, 2))))) then
            e = findloc(any(mesh%t6 == node, dim=1), .true., dim=1)
            local = PLACES(:, findloc(mesh%t6(:, e), node, dim=1))
         else
            do k = 1, size(mesh%t6, 2)
               call find_local(mesh%x(:, mesh%t6(:, k)), point%x, place, within)
               if (within <= most) cycle
               e = k
               local = place
               most = within
               if (within >= 0.0_wp) exit
            end do
         end if
         if (e == 0) then
            call raise(fault, EXIT_GROUP, '&point '//trim(point%name)//': '//place_text(point%x)// &
                       ' lies outside the mesh; the nearest node is at '//place_text(mesh%x(:, node))//'.')
            return
         end if
         point%nodes = mesh%t6(:, e)
         call quadratic(local(1), local(2), point%weights, dn)
         point%pressure_weights = point%weights
         if (m%n_p == 3) then
            point%pressure_weights = 0.0_wp
            call linear(local(1), local(2), point%pressure_weights(:3), dn_linear)
         end if
         ! Around a node several are equally near, and rounding is not to choose: the first of them.
         associate (far => [((norm2(m%gauss(g, e)%x - point%x), g=1, m%rule), e=1, size(mesh%t6, 2))])
            point%gauss = findloc(far <= (1 + EQUALLY_NEAR)*minval(far), .true., dim=1)
         end associate
      end associate
   end subroutine find_point

   !> Finds local coordinates of a place by Newton's method, and the least of its area coordinates: negative outside.
   pure subroutine find_local(x, place, local, within)
      real(wp), intent(in) :: x(2, 6), place(2)   !< Nodes [m]; [m].
      real(wp), intent(out) :: local(2)           !< xi, eta
      real(wp), intent(out) :: within             !< -1: far away.
      real(wp) :: n(6), dn(2, 6), j(2, 2), det, left(2), size_of, step(2)
      integer :: k

      local = 1.0_wp/3
      within = -1.0_wp
      size_of = maxval(maxval(x, dim=2) - minval(x, dim=2))
      ! A bent side leaves the box of its nodes by less than the element.
      if (any(place < minval(x, dim=2) - size_of) .or. any(place > maxval(x, dim=2) + size_of)) return
      do k = 1, MOST_ITERATIONS
         call quadratic(local(1), local(2), n, dn)
         j = matmul(x, transpose(dn))
         det = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
         if (.not. abs(det) > epsilon(1.0_wp)*size_of**2) return
         left = place - matmul(x, n)
         step = [j(2, 2)*left(1) - j(1, 2)*left(2), j(1, 1)*left(2) - j(2, 1)*left(1)]/det
         if (any(abs(step) > 10.0_wp)) return
         local = local + step
         if (all(abs(step) < SETTLED)) then
            within = min(local(1), local(2), 1 - sum(local))
            return
         end if
      end do
   end subroutine find_local

   !> Interpolates at a point what the nodes have: of displacements or their rates, and of pressures, if there are any.
   pure function values_at(point, x) result(values)
      type(point_t), intent(in) :: point
      real(wp), intent(in) :: x(:, :)   !< (DISPLACEMENTS or FIELDS, nodes)
      real(wp) :: values(size(x, 1))
      integer :: k

      values = 0.0_wp
      do k = 1, size(point%nodes)
         associate (of_node => x(:, point%nodes(k)))
            values(:DISPLACEMENTS) = values(:DISPLACEMENTS) + point%weights(k)*of_node(:DISPLACEMENTS)
            values(DISPLACEMENTS + 1:) = values(DISPLACEMENTS + 1:) &
                                         + point%pressure_weights(k)*of_node(DISPLACEMENTS + 1:)
         end associate
      end do
   end function values_at
end module named_points
