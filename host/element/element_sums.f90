! SPDX-License-Identifier: MIT
!> Sums over the quadrature points of an element: B^T response and B^T slope B. The unknowns are kept field by field,
!> all six nodes of a field side by side, so that the compiler takes several nodes at once.
module element_sums
   use kinds, only: wp
   use porous_balance, only: PLACES, RR, ZZ, TT, RZ, U, PW, PC, GW, GA
   use porous_domain, only: gauss_t
   implicit none (type, external)
   private
   public :: sums_t, rows_t, weighted_rows, add_forces, add_balances, add_tangent, residual_of, matrix_of, LAST_U

   integer, parameter :: NODES = 6
   integer, parameter :: U_R = 1, U_Z = 2, WATER = 3, SUCTION = 4   !< Fields of an element.
   integer, parameter :: FORCES = U + 2   !< Places of stress and force, before those of the fluids.
   integer, parameter :: LAST_U = 2*NODES   !< Displacements of an element, the first of its unknowns.

   !> Sums of the points of an element.
   type :: sums_t
      real(wp) :: r(NODES, 4)             !< Residual.
      real(wp) :: k(NODES, 4, NODES, 4)   !< Slopes of r: node and field of the row, node and field of the column.
   end type sums_t

   !> Rows of B at a point, times its weight [m3, m2].
   type :: rows_t
      real(wp), dimension(NODES) :: n, d_r, d_z, hoop   !< Rows of the displacements; hoop: n/r.
      real(wp), dimension(NODES) :: m, dm_r, dm_z       !< Rows of the pressures.
   end type rows_t
contains
   !> Multiplies the rows of B at a point by its weight.
   pure type(rows_t) function weighted_rows(gp) result(b)
      type(gauss_t), intent(in) :: gp

      b%d_r = gp%weight*gp%dn(:, 1)
      b%d_z = gp%weight*gp%dn(:, 2)
      b%hoop = gp%weight*gp%n_over_r
      b%n = gp%weight*gp%n
      b%m = gp%weight*gp%m
      b%dm_r = gp%weight*gp%dm(:, 1)
      b%dm_z = gp%weight*gp%dm(:, 2)
   end function weighted_rows

   !> Adds weight B^T response to the rows of the displacements; units of response are those of point_response.
   pure subroutine add_forces(b, response, r)
      type(rows_t), intent(in) :: b
      real(wp), intent(in) :: response(PLACES)
      real(wp), intent(inout) :: r(NODES, 4)

      r(:, U_R) = r(:, U_R) + (b%d_r*response(RR) + b%hoop*response(TT) + b%d_z*response(RZ) + b%n*response(U + 1))
      r(:, U_Z) = r(:, U_Z) + (b%d_z*response(ZZ) + b%d_r*response(RZ) + b%n*response(U + 2))
   end subroutine add_forces

   !> Adds weight B^T response to the rows of the pressures.
   pure subroutine add_balances(b, fields, response, r)
      type(rows_t), intent(in) :: b
      integer, intent(in) :: fields           !< Number of fields of the element: 2, 3 or 4.
      real(wp), intent(in) :: response(PLACES)
      real(wp), intent(inout) :: r(NODES, 4)

      if (fields < WATER) return
      r(:, WATER) = r(:, WATER) + (b%m*response(PW) + b%dm_r*response(GW + 1) + b%dm_z*response(GW + 2))
      if (fields < SUCTION) return
      r(:, SUCTION) = r(:, SUCTION) + (b%m*response(PC) + b%dm_r*response(GA + 1) + b%dm_z*response(GA + 2))
   end subroutine add_balances

   !> Adds weight B^T tangent B to k. Of the strain a force per volume and the balances know the change of volume alone,
   !> and a gradient of pressure changes the fluxes alone (docs/theory/host.md section 3.3): nothing goes to the rest.
   pure subroutine add_tangent(gp, b, fields, tangent, k)
      type(gauss_t), intent(in) :: gp
      type(rows_t), intent(in) :: b
      integer, intent(in) :: fields
      real(wp), intent(in) :: tangent(PLACES, PLACES)
      real(wp), intent(inout) :: k(NODES, 4, NODES, 4)
      real(wp) :: part(PLACES)
      integer :: j

      do j = 1, NODES
         part(RR:RZ) = gp%dn(j, 1)*tangent(RR:RZ, RR) + gp%n_over_r(j)*tangent(RR:RZ, TT) &
                       + gp%dn(j, 2)*tangent(RR:RZ, RZ)
         part(U + 1:FORCES) = (gp%dn(j, 1) + gp%n_over_r(j))*tangent(U + 1:FORCES, RR) &
                              + gp%n(j)*tangent(U + 1:FORCES, U + 1)
         call add_forces(b, part, k(:, :, j, U_R))
         part(RR:RZ) = gp%dn(j, 2)*tangent(RR:RZ, ZZ) + gp%dn(j, 1)*tangent(RR:RZ, RZ)
         part(U + 1:FORCES) = gp%dn(j, 2)*tangent(U + 1:FORCES, RR) + gp%n(j)*tangent(U + 1:FORCES, U + 2)
         call add_forces(b, part, k(:, :, j, U_Z))
      end do
      if (fields < WATER) return
      call add_balances_of_displacements(gp, b, fields, tangent, k)
      call add_tangent_of_pressure(gp, b, fields, PW, GW, tangent, k(:, :, :, WATER))
      if (fields >= SUCTION) call add_tangent_of_pressure(gp, b, fields, PC, GA, tangent, k(:, :, :, SUCTION))
   end subroutine add_tangent

   !> Adds the rows of the pressures in the columns of the displacements: by the change of volume, and by the
   !> acceleration where it drives seepage. What these do to the balances is the same at every node.
   pure subroutine add_balances_of_displacements(gp, b, fields, tangent, k)
      type(gauss_t), intent(in) :: gp
      type(rows_t), intent(in) :: b
      integer, intent(in) :: fields
      real(wp), intent(in) :: tangent(PLACES, PLACES)
      real(wp), intent(inout) :: k(NODES, 4, NODES, 4)
      real(wp), dimension(NODES, 4) :: volume, accel_r, accel_z
      integer :: j, f

      volume = 0.0_wp
      accel_r = 0.0_wp
      accel_z = 0.0_wp
      call add_balances(b, fields, tangent(:, RR), volume)
      call add_balances(b, fields, tangent(:, U + 1), accel_r)
      call add_balances(b, fields, tangent(:, U + 2), accel_z)
      do j = 1, NODES
         do f = WATER, fields
            k(:, f, j, U_R) = k(:, f, j, U_R) + ((gp%dn(j, 1) + gp%n_over_r(j))*volume(:, f) + gp%n(j)*accel_r(:, f))
            k(:, f, j, U_Z) = k(:, f, j, U_Z) + (gp%dn(j, 2)*volume(:, f) + gp%n(j)*accel_z(:, f))
         end do
      end do
   end subroutine add_balances_of_displacements

   !> Adds the columns of a pressure. Its gradient changes no force: what its value does to them is alike at all nodes.
   pure subroutine add_tangent_of_pressure(gp, b, fields, value, gradient, tangent, k)
      type(gauss_t), intent(in) :: gp
      type(rows_t), intent(in) :: b
      integer, intent(in) :: fields, value, gradient   !< Place of the value, place before its gradient.
      real(wp), intent(in) :: tangent(PLACES, PLACES)
      real(wp), intent(inout) :: k(NODES, 4, NODES)
      real(wp) :: forces(NODES, 4), part(PLACES)
      integer :: j

      forces = 0.0_wp
      call add_forces(b, tangent(:, value), forces)
      do j = 1, NODES
         k(:, U_R, j) = k(:, U_R, j) + gp%m(j)*forces(:, U_R)
         k(:, U_Z, j) = k(:, U_Z, j) + gp%m(j)*forces(:, U_Z)
         part(PW:PC) = gp%m(j)*tangent(PW:PC, value)
         part(PC + 1:) = gp%m(j)*tangent(PC + 1:, value) + gp%dm(j, 1)*tangent(PC + 1:, gradient + 1) &
                         + gp%dm(j, 2)*tangent(PC + 1:, gradient + 2)
         call add_balances(b, fields, part, k(:, :, j))
      end do
   end subroutine add_tangent_of_pressure

   !> Puts the residual in the order of the element's unknowns: displacements node by node, then the n_p values of a
   !> pressure after those of the other.
   pure subroutine residual_of(r, fields, n_p, ordered)
      real(wp), intent(in) :: r(NODES, 4)
      integer, intent(in) :: fields, n_p
      real(wp), intent(inout) :: ordered(:)   !< (unknowns or more)
      integer :: i, f

      do i = 1, NODES
         ordered(2*i - 1) = r(i, U_R)
         ordered(2*i) = r(i, U_Z)
      end do
      do f = WATER, fields
         do i = 1, n_p
            ordered(LAST_U + (f - WATER)*n_p + i) = r(i, f)
         end do
      end do
   end subroutine residual_of

   !> Puts the matrix in that order.
   pure subroutine matrix_of(k, fields, n_p, ordered)
      real(wp), intent(in) :: k(NODES, 4, NODES, 4)
      integer, intent(in) :: fields, n_p
      real(wp), intent(inout) :: ordered(:, :)   !< (unknowns or more, likewise)
      integer :: j, f

      do j = 1, NODES
         call residual_of(k(:, :, j, U_R), fields, n_p, ordered(:, 2*j - 1))
         call residual_of(k(:, :, j, U_Z), fields, n_p, ordered(:, 2*j))
      end do
      do f = WATER, fields
         do j = 1, n_p
            call residual_of(k(:, :, j, f), fields, n_p, ordered(:, LAST_U + (f - WATER)*n_p + j))
         end do
      end do
   end subroutine matrix_of
end module element_sums
