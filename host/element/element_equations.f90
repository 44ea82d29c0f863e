! SPDX-License-Identifier: MIT
!> Residual and exact tangent of an element: B^T response and B^T slope B over its quadrature points. The material
!> updates the points of several elements together.
module element_equations
   use wall_clock, only: clock, add_elapsed
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   use kinds, only: wp
   use material_point, only: material_t, response_t, batch_report_t, MOST_POINTS
   use element_sums, only: sums_t, rows_t, weighted_rows, add_forces, add_balances, add_tangent, residual_of, &
                           matrix_of, LAST_U
   use porous_domain, only: domain_t, region_t, model_state_t, gauss_t, mixture_density, given_pressures_at, &
                            gravity_on, law_of, COUPLED
   use porous_balance, only: kinematics_t, point_state_t, point_response, PLACES, RR, TT, RZ, U
   use generalised_alpha, only: scheme_t
   use carried_slopes, only: slopes_t, keep_slopes, follow_slopes, kept_response, BY_MATERIAL, BY_SLOPES
   use tangent_fallback, only: replace_soft_tangents, NO_FALLBACK
   implicit none (type, external)
   private
   public :: element_t, element_block_t, points_t, update_block, add_element, element_size, STRAIN_TOO_LARGE

   integer, parameter :: MAX_DOF = 24   !< 12 displacements (node by node), then p_w, then p_c.
   !> Share of the momentum of a step that is a floor of the forces: accelerations are differences of velocities that
   !> large, 1e-6 leaves room for their rounding.
   real(wp), parameter :: FLIGHT_SHARE = 1.0e-6_wp
   integer, parameter :: STRAIN_TOO_LARGE = 1000   !< Code of a strain beyond 1 in a step: no law is asked.

   type :: element_t
      real(wp) :: r(MAX_DOF) = 0.0_wp            !< Residual.
      real(wp) :: k(MAX_DOF, MAX_DOF) = 0.0_wp   !< d r / d new values.
      !> Sums of magnitudes: of volume balances those of strain rates and fluxes, in the rows of p_c those of the water
      !> alone; of momentum those of weight and of the rounding of inertia.
      real(wp) :: stretch(MAX_DOF) = 0.0_wp
      logical :: with_change = .false.            !< Whether `change` is wanted.
      real(wp) :: change(MAX_DOF) = 0.0_wp       !< Displacements: what the step changes of r, inertia counted whole.
   end type element_t

   !> Elements whose points the material updates together.
   type :: element_block_t
      integer :: first = 1, last = 1        !< Numbers of the elements, of one region.
      integer :: source = BY_MATERIAL       !< Source of the response, see carried_slopes.
      integer :: fallback = NO_FALLBACK     !< Kind of replacement of soft tangents, see tangent_fallback.
      logical :: soft(MOST_POINTS) = .false.   !< Whether the tangent of a point was replaced.
      type(batch_report_t) :: report        !< Report of the material; its code is not 0 where a point failed.
      real(wp) :: seconds = 0.0_wp          !< In the material.
   end type element_block_t

   !> Points of a block, element by element. No component has a default: it would be paid for with the whole of the
   !> type.
   type :: points_t
      type(kinematics_t) :: k(MOST_POINTS)
      type(response_t) :: response
   end type points_t
contains
   !> Counts the unknowns of an element.
   pure integer function element_size(domain, element)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element   !< Number of the element.

      associate (region => domain%regions(domain%region_of(element)))
         element_size = LAST_U + domain%n_carriers(element)*count([region%with_w, region%with_c])
      end associate
   end function element_size

   !> Finds stress, saturation and void ratio at the points of the elements of a block, and their slopes; the state
   !> variables of `new`. Where a strain of the step is beyond 1 or the material refuses, block%report says why; the
   !> response is then of no use.
   subroutine update_block(domain, scheme, old, new, with_tangent, slopes, block, points)
      type(domain_t), intent(in), target :: domain
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in), target :: old
      type(model_state_t), intent(inout), target :: new
      logical, intent(in) :: with_tangent
      type(slopes_t), intent(inout) :: slopes   !< Slopes of all points; those of the block are read or written.
      type(element_block_t), intent(inout) :: block
      type(points_t), intent(inout) :: points
      real(wp), dimension(MOST_POINTS) :: suction, d_suction
      real(wp) :: strain(6, MOST_POINTS)
      real(wp), pointer, contiguous :: before(:, :), after(:, :)   !< (n_state, points) of the law
      class(material_t), pointer :: law
      real(wp) :: t0
      integer :: e, first, g, last, n

      block%report = batch_report_t()
      block%soft = .false.
      block%seconds = 0.0_wp
      n = 0
      do e = block%first, block%last
         call look_at_nodes(domain, e, scheme, old, new, points%k(n + 1:))
         n = n + domain%rule
      end do
      do g = 1, n
         associate (k => points%k(g))
            strain(1:4, g) = k%strain
            strain(5:6, g) = 0.0_wp
            suction(g) = k%c0
            d_suction(g) = k%c1 - k%c0
            ! Also where it is not a number.
            if (all(abs(k%strain) <= 1.0_wp)) cycle
         end associate
         block%report = batch_report_t(code=STRAIN_TOO_LARGE, point=g)
         return
      end do
      first = (block%first - 1)*domain%rule + 1
      last = block%last*domain%rule
      if (block%source == BY_SLOPES) then
         call follow_slopes(n, first, slopes, old%stress(:, first:last), old%e(first:last), old%s(first:last), strain, &
                            d_suction, points%response)
         return
      else if (block%source /= BY_MATERIAL) then
         call kept_response(n, first, slopes, new%stress(:, first:last), new%e(first:last), new%s(first:last), &
                            points%response)
         return
      end if
      law => law_of(domain, new, domain%region_of(block%first))
      associate (from => domain%before_state(block%first) + 1, to => domain%before_state(block%last + 1))
         before(1:law%n_state, 1:n) => old%state(from:to)
         after(1:law%n_state, 1:n) => new%state(from:to)
      end associate
      t0 = clock()
      call law%update(n, old%stress(:, first:last), before, strain, suction, d_suction, &
                      with_tangent .or. allocated(slopes%strain), points%response, after, block%report)
      call add_elapsed(block%seconds, t0)
      if (block%report%code /= 0) return
      if (allocated(slopes%strain)) call keep_slopes(n, first, points%response, slopes)
      if (with_tangent .and. block%fallback /= NO_FALLBACK) call replace_soft_tangents(law, block%fallback, n, &
         after, suction(:n) + d_suction(:n), points%response, block%soft)
   end subroutine update_block

   !> Evaluates strains, pressures and their rates at the points of an element from the values at its nodes.
   subroutine look_at_nodes(domain, element, scheme, old, new, k)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: old, new
      type(kinematics_t), intent(inout) :: k(:)   !< Kinematics of the points, as many as the element has or more.
      real(wp), dimension(DISPLACEMENTS, 6) :: du, v0, v, a   !< Increment [m], velocity before and at its level [m/s],
                                                              !< acceleration at its level [m/s2].
      real(wp), dimension(6, 2) :: p0, p1, rate   !< p_w, p_c before and after [kPa], their rates [kPa/s].
      real(wp) :: gravity, given(2)
      integer :: g

      gravity = gravity_on(old, element) + scheme%l_f*(gravity_on(new, element) - gravity_on(old, element))
      call gather()
      do g = 1, domain%rule
         associate (gp => domain%gauss(g, element), region => domain%regions(domain%region_of(element)))
            call look(gp, region%with_c, k(g))
            if (region%drainage /= COUPLED) then
               ! Pressures that no unknown carries.
               given = given_pressures_at(domain, element, g)
               k(g)%w0 = k(g)%w0 + given(1)
               k(g)%w1 = k(g)%w1 + given(1)
               k(g)%c0 = k(g)%c0 + given(2)
               k(g)%c1 = k(g)%c1 + given(2)
            end if
            k(g)%gravity = gravity
            k(g)%speed = 0.0_wp
            if (scheme%has_inertia) k(g)%velocity = matmul(v0, gp%n)
            if (region%damping > 0.0_wp .and. scheme%has_inertia) k(g)%speed = matmul(v, gp%n)
            k(g)%source = 0.0_wp
            if (associated(domain%source)) &
               k(g)%source = domain%source(gp%x, old%time + scheme%l_f*(new%time - old%time))
         end associate
      end do
   contains
      !> Gathers the values at the nodes; in an undrained element its center carries the pressures.
      subroutine gather()
         real(wp) :: p_dot(6)
         integer :: node(6), carrier(6), f

         node = domain%mesh%t6(:, element)
         du = new%x(:DISPLACEMENTS, node) - old%x(:DISPLACEMENTS, node)
         if (scheme%has_inertia) a = old%a(:, node) + scheme%l_a*(new%a(:, node) - old%a(:, node))
         v0 = old%v(:DISPLACEMENTS, node)
         v = v0 + scheme%l_v*(new%v(:DISPLACEMENTS, node) - v0)
         if (domain%n_carriers(element) == 0) return
         carrier = node
         if (domain%center(element) > 0) carrier(1) = domain%center(element)
         do f = AT_P_W, merge(AT_P_C, AT_P_W, domain%with_c)
            p0(:, f - DISPLACEMENTS) = old%x(f, carrier)
            p1(:, f - DISPLACEMENTS) = new%x(f, carrier)
            p_dot = old%v(f, carrier)
            rate(:, f - DISPLACEMENTS) = p_dot + scheme%l_p*(new%v(f, carrier) - p_dot)
         end do
      end subroutine gather

      !> Evaluates strain, pressures and their rates at a point. Without suction nothing is spent on it.
      subroutine look(gp, with_c, k)
         type(gauss_t), intent(in) :: gp
         logical, intent(in) :: with_c   !< Whether the carriers have a suction; else it is 0.
         type(kinematics_t), intent(inout) :: k
         real(wp) :: slopes(DISPLACEMENTS, DISPLACEMENTS), hoop, rates(4)
         integer :: i

         slopes = 0.0_wp
         hoop = 0.0_wp
         rates = 0.0_wp
         do i = 1, 6
            slopes(:, 1) = slopes(:, 1) + gp%dn(i, 1)*du(:, i)
            slopes(:, 2) = slopes(:, 2) + gp%dn(i, 2)*du(:, i)
            hoop = hoop + gp%n_over_r(i)*du(1, i)
            rates = rates + [gp%dn(i, 1)*v(1, i), gp%dn(i, 2)*v(2, i), gp%n_over_r(i)*v(1, i), &
                             gp%dn(i, 2)*v(1, i) + gp%dn(i, 1)*v(2, i)]
         end do
         k%strain = [slopes(1, 1), slopes(2, 2), hoop, slopes(1, 2) + slopes(2, 1)]
         k%rate = rates
         k%div_v = sum(rates(:3))
         k%accel = 0.0_wp
         if (scheme%has_inertia) then
            do i = 1, 6
               k%accel = k%accel + a(:, i)*gp%n(i)
            end do
         end if
         k%w0 = 0.0_wp
         k%w1 = 0.0_wp
         k%c0 = 0.0_wp
         k%c1 = 0.0_wp
         k%w_dot = 0.0_wp
         k%c_dot = 0.0_wp
         k%grad_w = 0.0_wp
         k%grad_c = 0.0_wp
         if (domain%n_carriers(element) == 0) return
         call look_at_pressure(gp, 1, k%w0, k%w1, k%w_dot, k%grad_w)
         if (with_c) call look_at_pressure(gp, 2, k%c0, k%c1, k%c_dot, k%grad_c)
      end subroutine look

      !> Evaluates a pressure before and after, its rate and its gradient at the level of values.
      subroutine look_at_pressure(gp, which, before, after, p_dot, gradient)
         type(gauss_t), intent(in) :: gp
         integer, intent(in) :: which   !< 1: p_w, 2: p_c.
         real(wp), intent(out) :: before, after, p_dot, gradient(2)
         real(wp) :: p(6)

         p = p0(:, which) + scheme%l_f*(p1(:, which) - p0(:, which))
         before = dot_product(gp%m, p0(:, which))
         after = dot_product(gp%m, p1(:, which))
         p_dot = dot_product(gp%m, rate(:, which))
         gradient = [dot_product(gp%dm(:, 1), p), dot_product(gp%dm(:, 2), p)]
      end subroutine look_at_pressure
   end subroutine look_at_nodes

   !> Writes r (and k where `with_tangent`) of an element of a block that was updated, and the point data of `new`.
   !> docs/theory/host.md sections 3.3 and 3.4. r: [kN], balances of volume [m3/s].
   subroutine add_element(domain, element, scheme, block, points, old, new, with_tangent, out)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element
      type(scheme_t), intent(in) :: scheme
      type(element_block_t), intent(in) :: block
      type(points_t), intent(in) :: points
      type(model_state_t), intent(in) :: old
      type(model_state_t), intent(inout) :: new
      logical, intent(in) :: with_tangent
      type(element_t), intent(inout) :: out
      type(point_state_t) :: before, after
      type(sums_t) :: sums
      type(rows_t) :: rows
      real(wp) :: response(PLACES), tangent(PLACES, PLACES), change(6, 4), rate, drift(2, 2)
      integer :: g, i, p, q, n, n_p, n_fields

      n = element_size(domain, element)
      n_p = domain%n_carriers(element)
      n_fields = DISPLACEMENTS
      if (n_p > 0) n_fields = DISPLACEMENTS + (n - LAST_U)/n_p
      sums%r = 0.0_wp
      if (with_tangent) sums%k = 0.0_wp
      out%stretch = 0.0_wp
      if (out%with_change) change = 0.0_wp
      do g = 1, domain%rule
         p = (element - 1)*domain%rule + g
         q = (element - block%first)*domain%rule + g
         associate (gp => domain%gauss(g, element), k => points%k(q), &
                    region => domain%regions(domain%region_of(element)))
            before = point_state_t(old%stress(:, p), old%e(p), old%s(p), old%s_rate(p))
            call point_response(domain, region, scheme, k, points%response, q, before, after, with_tangent, response, &
                                tangent, drift)
            new%stress(:, p) = after%stress
            new%e(p) = after%e
            if (region%with_w) then
               new%s(p) = after%s
               new%s_rate(p) = after%s_rate
               rate = sum(abs(scheme%c_v*k%strain(1:3)))*gp%weight
               do i = 1, n_p
                  out%stretch([LAST_U + i, LAST_U + n_p + i]) = out%stretch([LAST_U + i, LAST_U + n_p + i]) &
                     + rate*abs(gp%m(i)) + gp%weight*matmul(abs(gp%dm(i, :)), drift)
               end do
            end if
            rows = weighted_rows(gp)
            call add_forces(rows, response, sums%r)
            call add_balances(rows, n_fields, response, sums%r)
            if (out%with_change) call add_forces(rows, change_of(domain, region, k, gravity_on(old, element), before, &
                                                                 response), change)
            if (scheme%has_inertia) call add_flight_scale(domain, region, k, scheme, after, gp, out%stretch)
            if (with_tangent) call add_tangent(gp, rows, n_fields, tangent, sums%k)
         end associate
      end do
      out%r(n + 1:) = 0.0_wp
      call residual_of(sums%r, n_fields, n_p, out%r)
      if (out%with_change) call residual_of(change, DISPLACEMENTS, n_p, out%change)
      if (with_tangent) call matrix_of(sums%k, n_fields, n_p, out%k)
   end subroutine add_element

   !> Scales a body in flight: its inertia is its weight and nothing is left that a residual could be small against.
   pure subroutine add_flight_scale(domain, region, k, scheme, after, gp, stretch)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(kinematics_t), intent(in) :: k
      type(scheme_t), intent(in) :: scheme
      type(point_state_t), intent(in) :: after   !< At the end of the step.
      type(gauss_t), intent(in) :: gp
      real(wp), intent(inout) :: stretch(:)
      real(wp) :: force, part
      integer :: i

      force = mixture_density(domain, region, after%e/(1 + after%e), after%s) &
              *(k%gravity + FLIGHT_SHARE*norm2(k%velocity)/scheme%dt)
      do i = 1, size(gp%n)
         part = gp%weight*force*abs(gp%n(i))
         stretch(2*i - 1) = stretch(2*i - 1) + part
         stretch(2*i) = stretch(2*i) + part
      end do
   end subroutine add_flight_scale

   !> Finds how total stress and weight change at a point in a step; inertia, sources and damping count whole.
   pure function change_of(domain, region, k, gravity0, before, response) result(change)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(kinematics_t), intent(in) :: k
      real(wp), intent(in) :: gravity0             !< Before the step [m/s2].
      type(point_state_t), intent(in) :: before
      real(wp), intent(in) :: response(PLACES)
      real(wp) :: change(PLACES)

      change = 0.0_wp
      change(RR:RZ) = response(RR:RZ) - before%stress(:4)
      if (region%with_w) change(RR:TT) = change(RR:TT) + (k%w0 + (1 - before%s)*k%c0)
      change(U + 1:U + 2) = response(U + 1:U + 2)
      change(U + 2) = change(U + 2) - mixture_density(domain, region, before%e/(1 + before%e), before%s)*gravity0
   end function change_of
end module element_equations
