! SPDX-License-Identifier: MIT
!> Forces and stiffness of one pair of edges, with the nodal pressures given; what follows from their change is added
!> where the nodes are known (contact_penalty).
!>
!> The energy of a pair is int q(phi, L, s) 2 pi r ds with phi = gap |t| and L = |t|:
!>   nodal gaps      q = sum_A M_A (a_A phi + b_A L), a_A = eps g_A = -p_A, b_A = -1/2 eps g_A**2, both held;
!>   pointwise gaps  q = 1/2 eps phi**2/L where phi < 0, that is 1/2 eps g**2 |t|.
!> In both the pressure at a point is -dq/dphi.
!> docs/theory/contact.md section 3.
module contact_response
   use contact_mortar, only: overlap_t, point_t, integration_point, hats, hat_slopes, POINTS, POSITION, SHARE, &
                             END_POSITION, END_SHARE, LARGEST_SEGMENTS
   use contact_projection, only: edge_t, edge_of, shapes, shape_slopes, place, tangent, SHAPE_BENDS
   use contact_types, only: wp, TWO_PI, contact_options_t, NODAL_GAP, PRESSURE_WORK
   implicit none (type, external)
   private
   public :: response_t, pair_response

   !> The density and its derivatives; those that are not listed vanish.
   type :: density_t
      real(wp) :: q = 0.0_wp
      real(wp) :: phi = 0.0_wp, length = 0.0_wp, s = 0.0_wp
      real(wp) :: phi_phi = 0.0_wp, phi_length = 0.0_wp, length_length = 0.0_wp
      real(wp) :: phi_s = 0.0_wp, length_s = 0.0_wp
   end type density_t

   !> What a pair adds, in local coordinates.
   type :: response_t
      real(wp) :: force(12) = 0.0_wp           !< Slope of the energy, or of the pressure's work [kN]
      real(wp) :: stiffness(12, 12) = 0.0_wp   !< d force/d coordinates [kN/m]
      real(wp) :: energy = 0.0_wp              !< Pointwise form only [kN m]
      real(wp) :: load(3) = 0.0_wp             !< Pointwise form only: int M_A p 2 pi r dGamma [kN]
   end type response_t

   ! The fields a density depends on, in one list: x_s (1, 2), t (3, 4), x_m (5, 6), s (7).
   integer, parameter :: FIELDS = 7
contains
   !> Forces (12) and, if wanted, stiffness (12, 12) of a pair of edges in local coordinates; `missed` is the largest
   !> share of the master edge by which a normal misses it. docs/theory/contact.md section 3. Where `missed` > 0 the
   !> response is of no use.
   pure subroutine pair_response(x, overlap, options, at_ends, pressure, with_stiffness, response, missed)
      real(wp), intent(in) :: x(2, 6)                   !< Local coordinates as in contact_mortar [m].
      type(overlap_t), intent(in) :: overlap
      type(contact_options_t), intent(in) :: options    !< Of the nodal or the pointwise form.
      logical, intent(in) :: at_ends                    !< Points at the ends of segments too.
      real(wp), intent(in) :: pressure(3)               !< Of the slave nodes [kPa]; not used by the pointwise form.
      logical, intent(in) :: with_stiffness
      type(response_t), intent(out) :: response
      real(wp), intent(out) :: missed   !< [-]
      type(point_t) :: p
      type(density_t) :: density
      real(wp) :: end_force(LARGEST_SEGMENTS + 1), position_of(POINTS), share_of(POINTS)
      integer :: segment, k

      end_force = 0.0_wp
      missed = 0.0_wp
      position_of = merge(END_POSITION, POSITION, at_ends)
      share_of = merge(END_SHARE, SHARE, at_ends)
      do segment = 1, overlap%segments
         do k = 1, POINTS
            call integration_point(x, overlap, segment, position_of(k), share_of(k), options%axisymmetric, p, missed)
            if (missed > 0.0_wp) return
            call find_density(options, pressure, p, density)
            if (options%gap /= NODAL_GAP) then
               if (p%phi >= 0.0_wp) cycle
               response%energy = response%energy + p%area*density%q
               response%load = response%load - p%area*p%length*hats(p%s)*density%phi
            end if
            if (options%variation == PRESSURE_WORK) then
               call add_work(p, density, with_stiffness, response)
            else
               call add_slope(p, density, share_of(k), merge(TWO_PI, 0.0_wp, options%axisymmetric), position_of(k), &
                              with_stiffness, response, end_force(segment:segment + 1))
            end if
         end do
      end do
      if (options%variation == PRESSURE_WORK .or. .not. with_stiffness) return
      do k = 1, overlap%segments + 1
         if (overlap%follows(k) > 0) call add_end(x, overlap, k, end_force(k), response)
      end do
   end subroutine pair_response

   pure subroutine find_density(options, pressure, p, density)
      type(contact_options_t), intent(in) :: options
      real(wp), intent(in) :: pressure(3)
      type(point_t), intent(in) :: p
      type(density_t), intent(out) :: density
      real(wp) :: m(3), dm(3), b(3), ratio

      if (options%gap == NODAL_GAP) then
         m = hats(p%s)
         dm = hat_slopes(p%s)
         b = -0.5_wp*pressure**2/options%penalty
         density%phi = -dot_product(m, pressure)
         density%length = dot_product(m, b)
         density%phi_s = -dot_product(dm, pressure)
         density%length_s = dot_product(dm, b)
         density%q = density%phi*p%phi + density%length*p%length
         density%s = density%phi_s*p%phi + density%length_s*p%length
      else
         ratio = p%phi/p%length
         density%q = 0.5_wp*options%penalty*p%phi*ratio
         density%phi = options%penalty*ratio
         density%length = -0.5_wp*options%penalty*ratio**2
         density%phi_phi = options%penalty/p%length
         density%phi_length = -options%penalty*ratio/p%length
         density%length_length = options%penalty*ratio**2/p%length
      end if
   end subroutine find_density

   !> The pressure -dq/dphi acts along the slave's normal at both points: the forces of a pair of points cancel and lie
   !> on one line, so that momentum and its moment are kept exactly.
   pure subroutine add_work(p, density, with_stiffness, response)
      type(point_t), intent(in) :: p
      type(density_t), intent(in) :: density
      logical, intent(in) :: with_stiffness
      type(response_t), intent(inout) :: response
      real(wp) :: push(12), d_load(12), load, nu(2), d_nu(12)
      integer :: i, c

      nu = [p%t(2), -p%t(1)]
      load = -p%area*density%phi
      do i = 1, 3
         push(2*i - 1:2*i) = p%ns(i)*nu
         push(2*i + 5:2*i + 6) = -p%nm(i)*nu
      end do
      response%force = response%force + load*push
      if (.not. with_stiffness) return
      d_load = -density%phi*p%d_area &
               - p%area*(density%phi_phi*p%d_phi + density%phi_length*p%d_length + density%phi_s*p%d_s)
      call add_product(response%stiffness, push, d_load)
      do c = 1, 2
         d_nu = p%d_t(2, :)
         if (c == 2) d_nu = -p%d_t(1, :)
         do i = 1, 3
            response%stiffness(2*i - 2 + c, :) = response%stiffness(2*i - 2 + c, :) &
                                                 + load*(p%ns(i)*d_nu + nu(c)*p%dns(i)*p%d_s)
            response%stiffness(2*i + 4 + c, :) = response%stiffness(2*i + 4 + c, :) &
                                                 - load*(p%nm(i)*d_nu + nu(c)*p%dnm(i)*p%d_m)
         end do
      end do
   end subroutine add_work

   !> First and second derivative of share/2 span 2 pi r q at a point. The place m on the master edge and the ends of
   !> the segment follow from conditions: y.t = 0 joins with a multiplier mu such that m is free to move (stationary);
   !> how much the ends are pulled is collected for add_end. With that their second derivatives are not needed.
   pure subroutine add_slope(p, density, weight, ring_slope, zeta, with_stiffness, response, end_force)
      type(point_t), intent(in) :: p
      type(density_t), intent(in) :: density
      real(wp), intent(in) :: weight, ring_slope, zeta
      logical, intent(in) :: with_stiffness
      type(response_t), intent(inout) :: response
      real(wp), intent(inout) :: end_force(2)
      real(wp) :: f(FIELDS), ff(FIELDS, FIELDS), q_f(FIELDS), phi_f(FIELDS), length_f(FIELDS), ring_f(FIELDS)
      real(wp) :: slopes(FIELDS, 12), d_psi(12), half, mu, by_s
      integer :: i

      half = 0.5_wp*weight
      phi_f = [-p%t(2), p%t(1), -p%y(2), p%y(1), p%t(2), -p%t(1), 0.0_wp]
      length_f = 0.0_wp
      length_f(3:4) = p%t/p%length
      ring_f = 0.0_wp
      ring_f(1) = ring_slope
      q_f = density%phi*phi_f + density%length*length_f
      q_f(7) = density%s
      f = p%ring*q_f + density%q*ring_f
      slopes(1:2, :) = p%d_xs
      slopes(3:4, :) = p%d_t
      slopes(5:6, :) = p%d_xm
      slopes(7, :) = p%d_s
      d_psi = matmul(f, slopes)
      response%force = response%force + half*(p%ring*density%q*p%d_span + p%span*d_psi)
      if (.not. with_stiffness) return

      ff = 0.0_wp
      ff(1:2, 3:4) = reshape([0.0_wp, 1.0_wp, -1.0_wp, 0.0_wp], [2, 2])*density%phi
      ff(3:4, 5:6) = reshape([0.0_wp, 1.0_wp, -1.0_wp, 0.0_wp], [2, 2])*density%phi
      ff(:, 7) = density%phi_s*phi_f + density%length_s*length_f
      ff = ff + transpose(ff)
      do i = 3, 4
         ff(i, 3:4) = ff(i, 3:4) - density%length*length_f(i)*length_f(3:4)/p%length
         ff(i, i) = ff(i, i) + density%length/p%length
      end do
      call add_product(ff, phi_f, density%phi_phi*phi_f + density%phi_length*length_f)
      call add_product(ff, length_f, density%phi_length*phi_f + density%length_length*length_f)
      ff = p%ring*ff
      call add_product(ff, ring_f, q_f)
      call add_product(ff, q_f, ring_f)

      f = half*p%span*f
      ff = half*p%span*ff
      mu = -dot_product(f(5:6), p%tm)/p%slip
      call add_condition(p%y, p%t, mu, f, ff)
      by_s = dot_product(f(1:2), p%t) + dot_product(f(3:4), p%t_bend) + f(7)
      end_force = end_force + half*p%ring*density%q*[-1.0_wp, 1.0_wp] &
                  + by_s*[0.5_wp*(1.0_wp - zeta), 0.5_wp*(1.0_wp + zeta)]
      call add_product(response%stiffness, half*p%d_span, d_psi)
      call add_product(response%stiffness, d_psi, half*p%d_span)
      call add_fields(f, ff, slopes, p%dns, p%t_bend, p%d_s, response%stiffness)
      call add_bending(f(5:6), p%dnm, p%tm_bend, p%d_m, 6, response%stiffness)
   end subroutine add_slope

   !> The end of a segment is the foot of a master node: (x_j - x(s)).t(s) = 0 with the multiplier that balances its
   !> end_force.
   pure subroutine add_end(x, overlap, k, end_force, response)
      real(wp), intent(in) :: x(2, 6), end_force
      type(overlap_t), intent(in) :: overlap
      integer, intent(in) :: k
      type(response_t), intent(inout) :: response
      type(edge_t) :: slave
      real(wp) :: f(FIELDS), ff(FIELDS, FIELDS), slopes(FIELDS, 12), y(2), t(2), bend(2), s
      integer :: i, j

      slave = edge_of(x(:, 1:3))
      j = overlap%follows(k)
      s = overlap%end(k)
      y = x(:, 3 + j) - place(slave, s)
      t = tangent(slave, s)
      bend = 2.0_wp*slave%bend
      f = 0.0_wp
      ff = 0.0_wp
      call add_condition(y, t, end_force/(dot_product(t, t) - dot_product(y, bend)), f, ff)
      slopes = 0.0_wp
      do i = 1, 2
         slopes(i, :) = t(i)*overlap%d_end(:, k)
         slopes(2 + i, :) = bend(i)*overlap%d_end(:, k)
         slopes(i, i:4 + i:2) = slopes(i, i:4 + i:2) + shapes(s)
         slopes(2 + i, i:4 + i:2) = slopes(2 + i, i:4 + i:2) + shape_slopes(s)
         slopes(4 + i, 4 + i + 2*j) = 1.0_wp
      end do
      call add_fields(f, ff, slopes, shape_slopes(s), bend, overlap%d_end(:, k), response%stiffness)
   end subroutine add_end

   !> Adds mu (x_m - x_s).t to what is derived.
   pure subroutine add_condition(y, t, mu, f, ff)
      real(wp), intent(in) :: y(2), t(2), mu
      real(wp), intent(inout) :: f(FIELDS), ff(FIELDS, FIELDS)
      integer :: i

      f(1:2) = f(1:2) - mu*t
      f(3:4) = f(3:4) + mu*y
      f(5:6) = f(5:6) + mu*t
      do i = 1, 2
         ff(i, i + 2) = ff(i, i + 2) - mu
         ff(i + 2, i) = ff(i + 2, i) - mu
         ff(i + 2, i + 4) = ff(i + 2, i + 4) + mu
         ff(i + 4, i + 2) = ff(i + 4, i + 2) + mu
      end do
   end subroutine add_condition

   !> Second derivative through the fields: their slopes with ff, and f with the curvature of x_s and t in the
   !> coordinates and s.
   pure subroutine add_fields(f, ff, slopes, dns, t_bend, d_s, stiffness)
      real(wp), intent(in) :: f(FIELDS), ff(FIELDS, FIELDS), slopes(FIELDS, 12), dns(3), t_bend(2), d_s(12)
      real(wp), intent(inout) :: stiffness(12, 12)

      stiffness = stiffness + matmul(transpose(slopes), matmul(ff, slopes))
      call add_bending(f(1:2), dns, t_bend, d_s, 0, stiffness)
      call add_bending(f(3:4), SHAPE_BENDS, [0.0_wp, 0.0_wp], d_s, 0, stiffness)
   end subroutine add_fields

   !> f . (second derivative of sum_i N_i(s) x_i) without that of s itself.
   pure subroutine add_bending(f, dn, bend, d_s, offset, stiffness)
      real(wp), intent(in) :: f(2), dn(3), bend(2), d_s(12)
      integer, intent(in) :: offset
      real(wp), intent(inout) :: stiffness(12, 12)
      real(wp) :: v(12)
      integer :: i

      v = 0.5_wp*dot_product(f, bend)*d_s
      do i = 1, 3
         v(offset + 2*i - 1:offset + 2*i) = v(offset + 2*i - 1:offset + 2*i) + dn(i)*f
      end do
      call add_product(stiffness, v, d_s)
      call add_product(stiffness, d_s, v)
   end subroutine add_bending

   !> a := a + b c^T
   pure subroutine add_product(a, b, c)
      real(wp), intent(inout) :: a(:, :)
      real(wp), intent(in) :: b(:), c(:)
      integer :: j

      do j = 1, size(c)
         a(:, j) = a(:, j) + c(j)*b
      end do
   end subroutine add_product
end module contact_response
