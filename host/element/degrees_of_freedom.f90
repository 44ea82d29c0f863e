! SPDX-License-Identifier: MIT
!> Numbers of the unknowns: one per node and field that the scene has, shared where nodes move as one rigid body, and
!> room for unknowns that belong to no node.
module degrees_of_freedom
   use kinds, only: wp
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_U_R, AT_U_Z, AT_P_W, AT_P_C
   use element_equations, only: element_size
   use element_sums, only: LAST_U
   use porous_domain, only: domain_t
   implicit none (type, external)
   private
   public :: dofs_t, number_unknowns, tie_pairs, at_nodes, of_unknowns

   type :: dofs_t
      integer :: n = 0                        !< Unknowns.
      integer, allocatable :: of(:, :)        !< (FIELDS, nodes), 0: no such unknown.
      integer, allocatable :: element(:, :)   !< (most unknowns of an element, elements), 0 behind those it has.
      integer, allocatable :: field(:)        !< Field of every unknown.
      integer, allocatable :: node(:)         !< A node of every unknown.
   end type dofs_t
contains
   !> Numbers node by node, which keeps the fields of a node together. docs/theory/host.md sections 3.5, 7.3 and 7.6.
   subroutine number_unknowns(domain, ties, dofs)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: ties(:, :)   !< (FIELDS, nodes): node whose unknown this node shares, 0 or itself: its own.
      type(dofs_t), intent(out) :: dofs
      logical :: has(FIELDS, size(domain%mesh%x, 2))
      integer :: e, f, i, leader

      has = .false.
      has(:DISPLACEMENTS, [domain%mesh%t6]) = .true.
      do e = 1, size(domain%mesh%t6, 2)
         associate (carriers => domain%carriers(:domain%n_carriers(e), e), &
                    region => domain%regions(domain%region_of(e)))
            has(AT_P_W, carriers) = region%with_w
            has(AT_P_C, carriers) = region%with_c
         end associate
      end do
      if (allocated(domain%bodies)) has(AT_U_Z, domain%bodies) = .true.
      if (allocated(domain%bodies_along_r)) has(AT_U_R, domain%bodies_along_r) = .true.
      ! Tied nodes of two regions: where one has a pressure their common unknown is there.
      do i = 1, size(has, 2)
         do f = DISPLACEMENTS + 1, FIELDS
            if (ties(f, i) > 0) has(f, ties(f, i)) = has(f, ties(f, i)) .or. has(f, i)
         end do
      end do
      allocate (dofs%of(FIELDS, size(has, 2)), source=0)
      do i = 1, size(has, 2)
         do f = 1, FIELDS
            if (.not. has(f, i)) cycle
            leader = ties(f, i)
            if (leader /= 0 .and. leader /= i) cycle
            dofs%n = dofs%n + 1
            dofs%of(f, i) = dofs%n
         end do
      end do
      do i = 1, size(has, 2)
         do f = 1, FIELDS
            if (has(f, i) .and. dofs%of(f, i) == 0) dofs%of(f, i) = dofs%of(f, ties(f, i))
         end do
      end do
      allocate (dofs%field(dofs%n), dofs%node(dofs%n))
      do i = size(has, 2), 1, -1
         do f = 1, FIELDS
            if (dofs%of(f, i) == 0) cycle
            dofs%field(dofs%of(f, i)) = f
            dofs%node(dofs%of(f, i)) = i
         end do
      end do
      allocate (dofs%element(maxval([(element_size(domain, e), e=1, size(domain%mesh%t6, 2))]), &
                             size(domain%mesh%t6, 2)), source=0)
      do e = 1, size(domain%mesh%t6, 2)
         associate (node => domain%mesh%t6(:, e), n_p => domain%n_carriers(e), carriers => domain%carriers(:, e), &
                    region => domain%regions(domain%region_of(e)))
            dofs%element(:LAST_U, e) = reshape(dofs%of(:DISPLACEMENTS, node), [LAST_U])
            if (region%with_w) dofs%element(LAST_U + 1:LAST_U + n_p, e) = dofs%of(AT_P_W, carriers(:n_p))
            if (region%with_c) dofs%element(LAST_U + n_p + 1:LAST_U + 2*n_p, e) = dofs%of(AT_P_C, carriers(:n_p))
         end associate
      end do
   end subroutine number_unknowns

   !> Makes the nodes of every pair share their first unknowns, and those of the nodes that they are tied to already.
   !> docs/theory/host.md section 7.6.
   pure subroutine tie_pairs(pairs, fields_tied, ties)
      integer, intent(in) :: pairs(:, :), fields_tied   !< (2, n) nodes; number of fields.
      integer, intent(inout) :: ties(:, :)   !< Leaders of tied nodes, as of number_unknowns.
      integer :: f, k, leader, i, old(2)

      do k = 1, size(pairs, 2)
         do f = 1, fields_tied
            old = pairs(:, k)
            where (ties(f, pairs(:, k)) > 0) old = ties(f, pairs(:, k))
            leader = minval(old)
            do i = 1, 2
               where (ties(f, :) == old(i)) ties(f, :) = leader
               ties(f, old(i)) = leader
            end do
            ties(f, pairs(:, k)) = leader
         end do
      end do
   end subroutine tie_pairs

   !> Puts values of the unknowns at their nodes, 0 where a node has none. (FIELDS, nodes)
   pure function at_nodes(dofs, values) result(x)
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: values(:)   !< (unknowns)
      real(wp) :: x(FIELDS, size(dofs%of, 2))
      integer :: i, f

      x = 0.0_wp
      do i = 1, size(x, 2)
         do f = 1, FIELDS
            if (dofs%of(f, i) > 0) x(f, i) = values(dofs%of(f, i))
         end do
      end do
   end function at_nodes

   !> Takes the values of the unknowns from their nodes. (unknowns)
   pure function of_unknowns(dofs, x) result(values)
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes)
      real(wp) :: values(dofs%n)
      integer :: i

      values = [(x(dofs%field(i), dofs%node(i)), i=1, dofs%n)]
   end function of_unknowns
end module degrees_of_freedom
