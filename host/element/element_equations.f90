! SPDX-License-Identifier: MIT
!> Residual and exact tangent of one element: B^T response and B^T slope B over its quadrature points.
module element_equations
   use wall_clock, only: clock, lap
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_W, AT_P_C
   use kinds, only: wp
   use material_point, only: response_t, report_t, MOST_POINTS
   use porous_domain, only: domain_t, region_t, state_t, gauss_t, mixture_density, given_pressures_at, COUPLED
   use porous_balance, only: kinematics_t, pore_t, skeleton_t, point_response, PLACES, RR, ZZ, TT, RZ, U, &
                             PW, PC, GW, GA
   use generalised_alpha, only: scheme_t, DYNAMIC
   use carried_slopes, only: slopes_t, keep_slopes, follow_slopes, same_again, BY_MATERIAL, BY_SLOPES
   use tangent_fallback, only: stiffen, NO_FALLBACK
   implicit none (type, external)
   private
   public :: element_t, compute_element, element_size, MAX_DOF, STRAIN_TOO_LARGE

   integer, parameter :: MAX_DOF = 24   !< 12 displacements (node by node), then p_w, then p_c.
   integer, parameter :: LAST_U = 12
   !> Of momentum a step: accelerations are differences of velocities that large, 1e-6 leaves room for their rounding.
   real(wp), parameter :: FLIGHT_SHARE = 1.0e-6_wp
   integer, parameter :: STRAIN_TOO_LARGE = 1000   !< Code of a strain beyond 1 in a step: no law is asked.

   type :: element_t
      real(wp) :: r(MAX_DOF) = 0.0_wp            !< Residual.
      real(wp) :: k(MAX_DOF, MAX_DOF) = 0.0_wp   !< d r / d new values.
      real(wp) :: stretch(MAX_DOF) = 0.0_wp      !< Sums of magnitudes, of volume balances those of strain rates and
                                                 !< fluxes, of momentum those of weight and of the rounding of inertia.
      integer :: source = BY_MATERIAL            !< What gives the response of the points, see carried_slopes.
      integer :: fallback = NO_FALLBACK          !< What replaces soft tangents, see tangent_fallback.
      integer :: replaced = 0                    !< Number of points whose tangent was replaced.
      logical :: with_change = .false.            !< Whether `change` is wanted.
      real(wp) :: change(MAX_DOF) = 0.0_wp       !< Displacements: what the step changes of r, inertia counted whole.
      type(report_t) :: bad                      !< Of the material, where a point failed.
      integer :: bad_point = 0                   !< Its number, 0: none.
      integer :: rate_evaluations = 0
      real(wp) :: seconds = 0.0_wp               !< In the material.
   end type element_t
contains
   !> Unknowns of an element.
   pure integer function element_size(domain, element)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element   !< Its number.

      associate (region => domain%regions(domain%region_of(element)))
         element_size = LAST_U + domain%n_carriers(element)*count([region%with_w, region%with_c])
      end associate
   end function element_size

   !> Writes r (and k where `with_tangent`), and the point data of `new`. docs/theory/host.md sections 3.3 and 3.4. r:
   !> [kN], balances of volume [m3/s]. Where a strain of the step is beyond 1 or the material refuses, out%bad_point > 0
   !> and out%bad says why; the rest of `out` is then of no use.
   subroutine compute_element(domain, element, scheme, old, new, with_tangent, slopes, out)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element
      type(scheme_t), intent(in) :: scheme
      type(state_t), intent(in) :: old
      type(state_t), intent(inout) :: new
      logical, intent(in) :: with_tangent
      type(slopes_t), intent(inout) :: slopes   !< Those of its points are read or written.
      type(element_t), intent(inout) :: out
      type(response_t) :: material
      type(kinematics_t) :: k(MOST_POINTS)
      real(wp), dimension(MOST_POINTS) :: suction, d_suction
      real(wp) :: strain(6, MOST_POINTS)
      integer :: g, n

      out%r = 0.0_wp
      out%stretch = 0.0_wp
      if (out%with_change) out%change = 0.0_wp
      out%k = 0.0_wp
      out%bad_point = 0
      out%replaced = 0
      out%rate_evaluations = 0
      out%seconds = 0.0_wp
      call look_at_nodes(domain, element, scheme, old, new, k)
      do g = 1, domain%rule
         ! Also where it is not a number.
         if (all(abs(k(g)%strain) <= 1.0_wp)) cycle
         out%bad = report_t(code=STRAIN_TOO_LARGE)
         out%bad_point = g
         return
      end do
      n = domain%rule
      do g = 1, n
         strain(1:4, g) = k(g)%strain
         strain(5:6, g) = 0.0_wp
         suction(g) = k(g)%c0
         d_suction(g) = k(g)%c1 - k(g)%c0
      end do
      call ask_points(domain, element, old, new, strain, suction, d_suction, with_tangent, slopes, material, out)
      if (out%bad_point > 0) return
      call add_points(domain, element, scheme, k, material, old, new, with_tangent, out)
   end subroutine compute_element

   !> Stress, saturation and void ratio at the points of an element, and their slopes.
   subroutine ask_points(domain, element, old, new, strain, suction, d_suction, with_tangent, slopes, material, out)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element
      type(state_t), intent(in), target :: old
      type(state_t), intent(inout), target :: new
      real(wp), intent(in) :: strain(6, MOST_POINTS), suction(MOST_POINTS), d_suction(MOST_POINTS)
      logical, intent(in) :: with_tangent
      type(slopes_t), intent(inout) :: slopes
      type(response_t), intent(inout) :: material
      type(element_t), intent(inout) :: out
      type(report_t) :: report
      real(wp), pointer, contiguous :: before(:, :), after(:, :)   !< (n_state, points) of the law
      real(wp) :: t0
      integer :: n, first, last, n_state

      n = domain%rule
      first = (element - 1)*n + 1
      last = element*n
      if (out%source == BY_SLOPES) then
         call follow_slopes(n, first, slopes, old%stress(:, first:last), old%e(first:last), old%s(first:last), strain, &
                            d_suction, material)
         return
      else if (out%source /= BY_MATERIAL) then
         call same_again(n, first, slopes, new%stress(:, first:last), new%e(first:last), new%s(first:last), material)
         return
      end if
      n_state = domain%regions(domain%region_of(element))%law%n_state
      associate (from => domain%before_state(element) + 1, to => domain%before_state(element + 1))
         before(1:n_state, 1:n) => old%state(from:to)
         after(1:n_state, 1:n) => new%state(from:to)
      end associate
      t0 = clock()
      call domain%regions(domain%region_of(element))%law%update(n, old%stress(:, first:last), before, strain, suction, &
         d_suction, with_tangent .or. slopes%kept, material, after, report)
      call lap(out%seconds, t0)
      out%rate_evaluations = report%n_rate
      if (report%code /= 0) then
         out%bad = report
         out%bad_point = report%point
         return
      end if
      if (slopes%kept) call keep_slopes(n, first, material, slopes)
      if (with_tangent .and. out%fallback /= NO_FALLBACK) &
         call stiffen(domain%regions(domain%region_of(element))%law, out%fallback, n, after, &
                      suction(:n) + d_suction(:n), material, out%replaced)
   end subroutine ask_points

   !> What the nodes say about the points of an element.
   subroutine look_at_nodes(domain, element, scheme, old, new, k)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element
      type(scheme_t), intent(in) :: scheme
      type(state_t), intent(in) :: old, new
      type(kinematics_t), intent(inout) :: k(:)   !< As many as points, or more.
      real(wp) :: x0(FIELDS, 6), x1(FIELDS, 6), v(FIELDS, 6), a(2, 6)
      integer :: g, node(6), n_p

      node = domain%mesh%t6(:, element)
      x0 = old%x(:, node)
      x1 = new%x(:, node)
      a = 0.0_wp
      if (scheme%kind == DYNAMIC) a = old%a(:, node) + scheme%l_a*(new%a(:, node) - old%a(:, node))
      v(:DISPLACEMENTS, :) = old%v(:DISPLACEMENTS, node) &
         + scheme%l_v*(new%v(:DISPLACEMENTS, node) - old%v(:DISPLACEMENTS, node))
      n_p = domain%n_carriers(element)
      v(AT_P_W:, :) = 0.0_wp
      if (n_p > 0) v(AT_P_W:, :) = old%v(AT_P_W:, node) + scheme%l_p*(new%v(AT_P_W:, node) - old%v(AT_P_W:, node))
      if (domain%center(element) > 0) then
         associate (center => domain%center(element))
            x0(AT_P_W:, 1) = old%x(AT_P_W:, center)
            x1(AT_P_W:, 1) = new%x(AT_P_W:, center)
            v(AT_P_W:, 1) = old%v(AT_P_W:, center) + scheme%l_p*(new%v(AT_P_W:, center) - old%v(AT_P_W:, center))
         end associate
      end if
      do g = 1, domain%rule
         associate (gp => domain%gauss(g, element), region => domain%regions(domain%region_of(element)))
            call look(gp, n_p, region%with_c, scheme, x0, x1, v, a, k(g))
            if (region%drainage /= COUPLED) call add_given(given_pressures_at(domain, element, g), k(g))
            k(g)%speed = 0.0_wp
            if (scheme%kind == DYNAMIC) k(g)%velocity = matmul(old%v(:DISPLACEMENTS, node), gp%n)
            if (region%damping > 0.0_wp .and. scheme%kind == DYNAMIC) k(g)%speed = matmul(v(:DISPLACEMENTS, :), gp%n)
            k(g)%source = 0.0_wp
            if (associated(domain%source)) &
               k(g)%source = domain%source(gp%x, old%time + scheme%l_f*(new%time - old%time))
         end associate
      end do
   end subroutine look_at_nodes

   !> The balances at the points, added up over the element.
   subroutine add_points(domain, element, scheme, k, material, old, new, with_tangent, out)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k(:)
      type(response_t), intent(in) :: material
      type(state_t), intent(in) :: old
      type(state_t), intent(inout) :: new
      logical, intent(in) :: with_tangent
      type(element_t), intent(inout) :: out
      type(skeleton_t) :: skeleton
      type(pore_t) :: pore
      real(wp) :: response(PLACES), tangent(PLACES, PLACES), part(PLACES, MAX_DOF), rate, drift(2)
      integer :: g, p, n, n_p

      n = element_size(domain, element)
      n_p = domain%n_carriers(element)
      do g = 1, domain%rule
         p = (element - 1)*domain%rule + g
         skeleton%stress = material%stress(1:4, g)
         skeleton%e = material%void_ratio(g)
         skeleton%s = material%s_w(g)
         if (with_tangent) then
            skeleton%tangent = material%dsig_deps(1:4, 1:4, g)
            skeleton%tangent_suction = material%dsig_dpc(1:4, g)
            skeleton%ds_dev = material%dsw_dev(g)
            skeleton%ds_dpc = material%dsw_dpc(g)
         else
            skeleton%ds_dev = 0.0_wp
            skeleton%ds_dpc = 0.0_wp
         end if
         associate (gp => domain%gauss(g, element), region => domain%regions(domain%region_of(element)))
            call point_response(domain, region, scheme, k(g), old%stress(:, p), skeleton, &
                                pore_t(old%e(p), old%s(p), old%s_rate(p)), pore, with_tangent, response, tangent, drift)
            new%stress(:, p) = material%stress(:, g)
            new%e(p) = pore%e
            new%s(p) = pore%s
            new%s_rate(p) = pore%s_rate
            call gather(gp, n_p, n, gp%weight, response, out%r)
            if (out%with_change) call gather(gp, n_p, LAST_U, gp%weight, &
               change_of(domain, region, k(g), old%stress(:, p), pore_t(old%e(p), old%s(p), old%s_rate(p)), response), &
               out%change)
            rate = sum(abs(scheme%c_v*k(g)%strain(1:3)))*gp%weight
            if (scheme%kind == DYNAMIC) call add_flight(domain, region, k(g), scheme, skeleton, gp, out%stretch)
            associate (stretch => out%stretch(LAST_U + 1:LAST_U + n_p))
               stretch = stretch + rate*abs(gp%m(:n_p)) + gp%weight*matmul(drift, abs(gp%dm(:, :n_p)))
            end associate
            if (.not. with_tangent) cycle
            call times_b(gp, n_p, n, tangent, part)
            call add_transposed(gp, n_p, n, part, out%k)
         end associate
      end do
      if (n > LAST_U + n_p) out%stretch(LAST_U + n_p + 1:n) = out%stretch(LAST_U + 1:LAST_U + n_p)
   end subroutine add_points

   !> A body in flight: its inertia is its weight and nothing is left that a residual could be small against.
   pure subroutine add_flight(domain, region, k, scheme, skeleton, gp, stretch)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(kinematics_t), intent(in) :: k
      type(scheme_t), intent(in) :: scheme
      type(skeleton_t), intent(in) :: skeleton
      type(gauss_t), intent(in) :: gp
      real(wp), intent(inout) :: stretch(:)
      real(wp) :: force

      force = mixture_density(domain, region, skeleton%e/(1 + skeleton%e), skeleton%s) &
              *(domain%gravity + FLIGHT_SHARE*norm2(k%velocity)/scheme%dt)
      stretch(1:LAST_U:2) = stretch(1:LAST_U:2) + gp%weight*force*abs(gp%n)
      stretch(2:LAST_U:2) = stretch(2:LAST_U:2) + gp%weight*force*abs(gp%n)
   end subroutine add_flight

   !> What a step changes of the total stress and of the weight at a point; inertia, sources and damping count whole.
   pure function change_of(domain, region, k, stress0, old, response) result(change)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(kinematics_t), intent(in) :: k
      real(wp), intent(in) :: stress0(6)           !< Effective stress before the step [kPa].
      type(pore_t), intent(in) :: old
      real(wp), intent(in) :: response(PLACES)
      real(wp) :: change(PLACES), pressure

      change = 0.0_wp
      pressure = k%w0 + (1 - old%s)*k%c0
      change(RR:RZ) = response(RR:RZ) - stress0(:4)
      change(RR:TT) = change(RR:TT) + pressure
      change(U + 1:U + 2) = response(U + 1:U + 2)
      change(U + 2) = change(U + 2) - mixture_density(domain, region, old%e/(1 + old%e), old%s)*domain%gravity
   end function change_of

   !> What the nodes say about a point.
   pure subroutine look(gp, n_p, with_c, scheme, x0, x1, v, a, k)
      type(gauss_t), intent(in) :: gp
      integer, intent(in) :: n_p
      logical, intent(in) :: with_c   !< Else the suction of the carriers is 0, and nothing is spent on it.
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: x0(FIELDS, 6), x1(FIELDS, 6), v(FIELDS, 6), a(2, 6)
      type(kinematics_t), intent(inout) :: k
      real(wp) :: du(2, 6), x(2, 6)

      du = x1(:DISPLACEMENTS, :) - x0(:DISPLACEMENTS, :)
      k%strain = [dot_product(gp%dn(1, :), du(1, :)), dot_product(gp%dn(2, :), du(2, :)), &
                  dot_product(gp%n_over_r, du(1, :)), &
                  dot_product(gp%dn(2, :), du(1, :)) + dot_product(gp%dn(1, :), du(2, :))]
      k%div_v = dot_product(gp%dn(1, :), v(1, :)) + dot_product(gp%dn(2, :), v(2, :)) &
                + dot_product(gp%n_over_r, v(1, :))
      k%accel = 0.0_wp
      if (scheme%kind == DYNAMIC) k%accel = matmul(a, gp%n)
      k%w0 = 0.0_wp
      k%w1 = 0.0_wp
      k%c0 = 0.0_wp
      k%c1 = 0.0_wp
      k%w_dot = 0.0_wp
      k%c_dot = 0.0_wp
      k%grad_w = 0.0_wp
      k%grad_c = 0.0_wp
      if (n_p == 0) return
      x = x0(AT_P_W:, :) + scheme%l_f*(x1(AT_P_W:, :) - x0(AT_P_W:, :))
      k%w0 = dot_product(gp%m(:n_p), x0(AT_P_W, :n_p))
      k%w1 = dot_product(gp%m(:n_p), x1(AT_P_W, :n_p))
      k%w_dot = dot_product(gp%m(:n_p), v(AT_P_W, :n_p))
      k%grad_w = matmul(gp%dm(:, :n_p), x(1, :n_p))
      if (.not. with_c) return
      k%c0 = dot_product(gp%m(:n_p), x0(AT_P_C, :n_p))
      k%c1 = dot_product(gp%m(:n_p), x1(AT_P_C, :n_p))
      k%c_dot = dot_product(gp%m(:n_p), v(AT_P_C, :n_p))
      k%grad_c = matmul(gp%dm(:, :n_p), x(2, :n_p))
   end subroutine look

   !> Pressures that no unknown carries.
   pure subroutine add_given(p, k)
      real(wp), intent(in) :: p(2)   !< p_w, p_c [kPa]
      type(kinematics_t), intent(inout) :: k

      k%w0 = k%w0 + p(1)
      k%w1 = k%w1 + p(1)
      k%c0 = k%c0 + p(2)
      k%c1 = k%c1 + p(2)
   end subroutine add_given

   !> r = r + weight B^T response.
   pure subroutine gather(gp, n_p, n, weight, response, r)
      type(gauss_t), intent(in) :: gp
      integer, intent(in) :: n_p, n
      real(wp), intent(in) :: weight, response(PLACES)
      real(wp), intent(inout) :: r(MAX_DOF)
      integer :: i, at

      do i = 1, 6
         r(2*i - 1) = r(2*i - 1) + weight*(gp%dn(1, i)*response(RR) + gp%n_over_r(i)*response(TT) &
                                           + gp%dn(2, i)*response(RZ) + gp%n(i)*response(U + 1))
         r(2*i) = r(2*i) + weight*(gp%dn(2, i)*response(ZZ) + gp%dn(1, i)*response(RZ) + gp%n(i)*response(U + 2))
      end do
      do i = 1, n_p
         at = LAST_U + i
         if (at <= n) r(at) = r(at) + weight*(gp%m(i)*response(PW) + gp%dm(1, i)*response(GW + 1) &
                                              + gp%dm(2, i)*response(GW + 2))
         at = at + n_p
         if (at <= n) r(at) = r(at) + weight*(gp%m(i)*response(PC) + gp%dm(1, i)*response(GA + 1) &
                                              + gp%dm(2, i)*response(GA + 2))
      end do
   end subroutine gather

   !> part = slope B.
   pure subroutine times_b(gp, n_p, n, tangent, part)
      type(gauss_t), intent(in) :: gp
      integer, intent(in) :: n_p, n
      real(wp), intent(in) :: tangent(PLACES, PLACES)
      real(wp), intent(out) :: part(PLACES, MAX_DOF)
      integer :: i, p, at

      if (n_p == 0) then   ! those of the pressures are not read
         do i = 1, 6
            do p = RR, U + 2
               part(p, 2*i - 1) = gp%dn(1, i)*tangent(p, RR) + gp%n_over_r(i)*tangent(p, TT) &
                                  + gp%dn(2, i)*tangent(p, RZ) + gp%n(i)*tangent(p, U + 1)
               part(p, 2*i) = gp%dn(2, i)*tangent(p, ZZ) + gp%dn(1, i)*tangent(p, RZ) + gp%n(i)*tangent(p, U + 2)
            end do
         end do
         return
      end if
      do i = 1, 6
         part(:, 2*i - 1) = gp%dn(1, i)*tangent(:, RR) + gp%n_over_r(i)*tangent(:, TT) + gp%dn(2, i)*tangent(:, RZ) &
                            + gp%n(i)*tangent(:, U + 1)
         part(:, 2*i) = gp%dn(2, i)*tangent(:, ZZ) + gp%dn(1, i)*tangent(:, RZ) + gp%n(i)*tangent(:, U + 2)
      end do
      do i = 1, n_p
         at = LAST_U + i
         if (at <= n) part(:, at) = gp%m(i)*tangent(:, PW) + gp%dm(1, i)*tangent(:, GW + 1) &
                                    + gp%dm(2, i)*tangent(:, GW + 2)
         at = at + n_p
         if (at <= n) part(:, at) = gp%m(i)*tangent(:, PC) + gp%dm(1, i)*tangent(:, GA + 1) &
                                    + gp%dm(2, i)*tangent(:, GA + 2)
      end do
   end subroutine times_b

   !> k = k + weight B^T part.
   pure subroutine add_transposed(gp, n_p, n, part, k)
      type(gauss_t), intent(in) :: gp
      integer, intent(in) :: n_p, n
      real(wp), intent(in) :: part(PLACES, MAX_DOF)
      real(wp), intent(inout) :: k(MAX_DOF, MAX_DOF)
      integer :: j

      do j = 1, n
         call gather(gp, n_p, n, gp%weight, part(:, j), k(:, j))
      end do
   end subroutine add_transposed
end module element_equations
