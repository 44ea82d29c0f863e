!> Continuous rates of the zero-elastic-range model at a frozen memory. Smooth: jumps live in mud_reversal.
!>
!> The stress ratio r is the back-stress. With t = 2G d e_dev - r K_e (d eps_v - B) the loading direction n obeys
!> gamma n = t y + beta r, y = 1/(L h), so it lies in the plane of t and r and one angle decides it:
!> docs/theory/material.md section 4, guards section 5. The angle, phi there, is w here.
module mud_rates
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_tensor, only: IDENTITY, ddot, trace, deviator, norm, square
   use mud_elastic, only: bulk_modulus, shear_modulus, swelling_slope
   use mud_bonding, only: bonding_t, bonding, UNBONDED
   use mud_critical_state, only: critical_void_ratio, bounding_ratio, dilatancy_ratio, lode_factor, lode_slope
   use mud_flow, only: dilatancy_factor, dilatancy, fabric_rate
   use mud_hardening, only: kinematic_modulus, isotropic_t, isotropic_hardening, NO_HARDENING
   implicit none (type, external)
   private
   public :: rate_t, rate_at, stress_ratio, bounding_norm, MODE_ORDINARY, MODE_ELASTIC

   integer, parameter :: MODE_ORDINARY = 0   !< Both mechanisms act.
   integer, parameter :: MODE_ELASTIC = 1    !< L = 0: the elastic way back of the rule resume.

   !> |t| below this share of its terms is rounding. The terms are measured by the whole strain and by a stress ratio of
   !> at least SMALLEST_RATIO: where both deviators are rounding themselves, as in isotropic compression, theirs would
   !> not do.
   real(wp), parameter :: PURE_VOLUMETRIC = 1.0e-14_wp, SMALLEST_RATIO = 1.0e-3_wp
   real(wp), parameter :: PARALLEL = 1.0e-13_wp          !< r normal to t below this share of r is rounding [-].
   real(wp), parameter :: ROOT_TOLERANCE = 1.0e-14_wp    !< Of the direction equation, share of its terms [-].
   integer, parameter :: MAX_ITERATIONS = 80             !< Bisection alone needs 53.
   integer, parameter :: SCAN = 64                       !< Points of the scan for roots where a bracket is not certain.

   !> One rate and everything it went through, as mud_tangent needs it. Per unit of the pseudo-time of d_strain, d_pc.
   type :: rate_t
      ! the point
      real(wp) :: p                !< p' >= p_min [kPa]
      real(wp) :: r(6)             !< stress ratio [-]
      real(wp) :: r_moved(6)       !< r - r_in [-]
      real(wp) :: z(6)             !< fabric [-]
      real(wp) :: k, g             !< elastic moduli K, G [kPa]
      real(wp) :: psi              !< state parameter [-]
      real(wp) :: m_b, m_d         !< M^b, M^d in triaxial compression [-]
      real(wp) :: b_0              !< h x [-]
      type(isotropic_t) :: iso     !< isotropic mechanism
      ! the direction
      logical :: loading           !< L >= 0 was solved for; false: elastic
      logical :: iso_active        !< the isotropic mechanism acts
      real(wp) :: k_e              !< K, or K/(1 + K A/p') [kPa]
      real(wp) :: b_rate           !< B [-]
      real(wp) :: t(6), t_norm     !< t [kPa]
      real(wp) :: n(6)             !< loading direction [-]
      real(wp) :: y                !< 1/(L h) [-]
      real(wp) :: l                !< loading index L [-]
      real(wp) :: h_b              !< 1/h [-]
      real(wp) :: x                !< (r - r_in):n, not floored [-]
      real(wp) :: lode, lode_slope !< g [-] and dg/d tr(n^3)
      real(wp) :: r_n, z_n         !< r:n, z:n [-]
      real(wp) :: a_d, d           !< A_d, D [-]
      real(wp) :: beta, gamma      !< coefficients of the direction equation [kPa]
      ! guards
      logical :: floored, capped_d, capped_h, iso_kept, no_root
      ! the result
      real(wp) :: d_p              !< rate of p' [kPa]
      real(wp) :: d_sigma(6)       !< [kPa]
      real(wp) :: d_z(6)           !< [-]
      real(wp) :: d_eps_q          !< plastic shear, sqrt(2/3) L [-]
   end type rate_t

   !> Everything along the arc n = cos(w) t/|t| + sin(w) q is a polynomial in cos(w), sin(w) with these coefficients.
   type :: arc_t
      real(wp) :: r_t, r_q, x_t, x_q, z_t, z_q, cubic(0:3)
   end type arc_t

   !> The direction equation at one angle.
   type :: trial_t
      real(wp) :: cosine, sine      !< of the angle w
      real(wp) :: residual          !< gamma sin(w) - beta r:q [kPa]
      real(wp) :: scale             !< gamma + |beta| r:q [kPa]
      real(wp) :: admissible        !< y |t|, positive if admissible [kPa]
   end type trial_t
contains
   !> Stress ratio r = s/p' and p' >= p_min of a stress [kPa].
   pure subroutine stress_ratio(par, sigma, p, r)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6)
      real(wp), intent(out) :: p, r(6)

      p = max(trace(sigma)/3.0_wp, par%p_min)
      r = deviator(sigma)/p
   end subroutine stress_ratio

   !> Norm of the bounding stress ratio in the direction of r, sqrt(2/3) g(r/|r|) M^b [-].
   pure real(wp) function bounding_norm(par, r, r_norm, m_b)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: r(6), r_norm, m_b
      real(wp) :: g

      g = 1.0_wp
      if (r_norm > 0.0_wp) g = lode_factor(par, ddot(square(r), r)/r_norm**3)
      bounding_norm = SQRT_2_3*g*m_b
   end function bounding_norm

   !> Rates of stress, fabric and plastic shear for a strain rate and a suction rate.
   pure subroutine rate_at(par, bonded, sigma, e, p_c, z, r_in, d_strain, d_pc, mode, w)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded             !< Suction bonding acts in this update.
      real(wp), intent(in) :: sigma(6)          !< sigma' [kPa]
      real(wp), intent(in) :: e                 !< void ratio [-]
      real(wp), intent(in) :: p_c               !< suction [kPa]
      real(wp), intent(in) :: z(6), r_in(6)     !< fabric, memory [-]
      real(wp), intent(in) :: d_strain(6)       !< strain rate [-]
      real(wp), intent(in) :: d_pc              !< suction rate [kPa]
      integer, intent(in) :: mode               !< MODE_*
      type(rate_t), intent(inout) :: w          !< All of it is set.
      real(wp) :: d_v, d_e(6), d_norm

      d_v = trace(d_strain)
      d_e = deviator(d_strain)
      d_norm = norm(d_strain)
      call evaluate_point(par, bonded, sigma, e, p_c, z, r_in, w)

      w%iso_kept = .false.
      w%iso_active = .false.
      w%k_e = w%k
      w%b_rate = 0.0_wp
      call load(par, d_v, d_e, d_norm, mode, w)
      if (w%iso%a*w%d_p/w%p + w%iso%b*d_pc > 0.0_wp) then
         w%iso_active = .true.
         w%k_e = w%k/(1.0_wp + w%k*w%iso%a/w%p)
         w%b_rate = w%iso%b*d_pc
         call load(par, d_v, d_e, d_norm, mode, w)
         if (w%iso%a*w%d_p/w%p + w%b_rate < 0.0_wp) then
            w%iso_kept = .true.
            w%iso_active = .false.
            w%k_e = w%k
            w%b_rate = 0.0_wp
            call load(par, d_v, d_e, d_norm, mode, w)
         end if
      end if

      w%d_sigma = 2.0_wp*w%g*(d_e - w%l*w%n) + w%d_p*IDENTITY
      w%d_z = fabric_rate(par, w%l, w%d, w%n, z)
      w%d_eps_q = SQRT_2_3*w%l
   end subroutine rate_at

   !> What depends on the state alone.
   pure subroutine evaluate_point(par, bonded, sigma, e, p_c, z, r_in, w)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      real(wp), intent(in) :: sigma(6), e, p_c, z(6), r_in(6)
      type(rate_t), intent(inout) :: w
      type(bonding_t) :: bond
      real(wp) :: r_norm, weight

      call stress_ratio(par, sigma, w%p, w%r)
      w%r_moved = w%r - r_in
      w%z = z
      w%k = bulk_modulus(par, e, w%p)
      w%g = shear_modulus(par, e, w%p)
      if (bonded) then
         bond = bonding(par, p_c, e)
      else
         bond = UNBONDED
      end if
      w%psi = e - critical_void_ratio(par, bond%f, w%p)
      w%m_b = bounding_ratio(par, w%psi)
      w%m_d = dilatancy_ratio(par, w%psi)
      w%b_0 = kinematic_modulus(par, e, w%p)
      w%iso = NO_HARDENING
      if (par%isotropic) then
         r_norm = norm(w%r)
         weight = max(1.0_wp - (r_norm/bounding_norm(par, w%r, r_norm, w%m_b))**2, 0.0_wp)
         if (weight > 0.0_wp) then
            w%iso = isotropic_hardening(par, bond, e, w%p, swelling_slope(w%k, e, w%p), 1.5_wp*r_norm**2, weight)
         end if
      end if
   end subroutine evaluate_point

   !> Loading index, direction and rate of p' for the present choice of the isotropic mechanism (k_e, b_rate).
   pure subroutine load(par, d_v, d_e, d_norm, mode, w)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v, d_e(6), d_norm   !< volumetric and deviatoric strain rate, norm of the whole [-]
      integer, intent(in) :: mode
      type(rate_t), intent(inout) :: w
      real(wp) :: volumetric, terms

      volumetric = w%k_e*(d_v - w%b_rate)
      w%t = 2.0_wp*w%g*d_e - w%r*volumetric
      w%t_norm = norm(w%t)
      w%no_root = .false.
      w%loading = .false.
      terms = 2.0_wp*w%g*d_norm + max(norm(w%r), SMALLEST_RATIO)*abs(volumetric)
      if (mode /= MODE_ELASTIC .and. w%t_norm > PURE_VOLUMETRIC*terms) call find_direction(par, w)
      if (.not. w%loading) then
         w%n = 0.0_wp
         w%l = 0.0_wp
         w%d = 0.0_wp
         w%x = 0.0_wp
         w%floored = .false.
         w%capped_d = .false.
         w%capped_h = .false.
      end if
      w%d_p = volumetric - w%k_e*w%l*w%d
   end subroutine load

   !> The unit direction n and what hangs on it. Leaves w%loading false and sets w%no_root where none is admissible.
   pure subroutine find_direction(par, w)
      type(params_t), intent(in) :: par
      type(rate_t), intent(inout) :: w
      type(arc_t) :: arc
      type(trial_t) :: at
      real(wp) :: n_t(6), q(6), t2(6), q2(6), tau
      logical :: found

      n_t = w%t/w%t_norm
      arc%r_t = ddot(w%r, n_t)
      q = w%r - arc%r_t*n_t
      arc%r_q = norm(q)
      arc%x_t = ddot(w%r_moved, n_t)
      arc%z_t = ddot(w%z, n_t)
      t2 = square(n_t)
      arc%cubic(0) = ddot(t2, n_t)
      if (arc%r_q <= PARALLEL*max(norm(w%r), 1.0e-3_wp)) then
         arc%r_q = 0.0_wp
         arc%x_q = 0.0_wp
         arc%z_q = 0.0_wp
         arc%cubic(1:3) = 0.0_wp
         w%n = n_t
         call evaluate_direction(par, arc, 0.0_wp, w, at)
         found = at%admissible > 0.0_wp
      else
         q = q/arc%r_q
         q2 = square(q)
         arc%x_q = ddot(w%r_moved, q)
         arc%z_q = ddot(w%z, q)
         arc%cubic(1) = ddot(t2, q)
         arc%cubic(2) = ddot(q2, n_t)
         arc%cubic(3) = ddot(q2, q)
         call find_angle(par, arc, w, tau, at, found)
         w%n = at%cosine*n_t + at%sine*q
      end if
      w%loading = found
      w%no_root = .not. found
      if (.not. found) return
      w%lode_slope = lode_slope(par, w%lode)
      w%y = at%admissible/w%t_norm
      w%l = w%h_b/w%y
   end subroutine find_direction

   !> The admissible root of the direction equation with the smallest |w| on the side where it lies. An angle is known
   !> by the tangent of its half, tau: its cosine and sine then cost a division.
   !>
   !> In units of that side the residual begins negative at w = 0. With every guard on it ends positive at a right
   !> angle, so a bracketed Newton iteration cannot fail. Where the floor or a cap acts, and with guards off, several
   !> roots or none are possible: there the arc is scanned for the first change of sign.
   pure subroutine find_angle(par, arc, w, tau, at, found)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      type(rate_t), intent(inout) :: w
      real(wp), intent(out) :: tau      !< with the sign of w
      type(trial_t), intent(out) :: at
      logical, intent(out) :: found
      real(wp) :: side, low, high, last, start
      logical :: guarded, crossed

      call evaluate_direction(par, arc, 0.0_wp, w, at)
      side = sign(1.0_wp, w%beta)
      guarded = par%floored .and. par%cap_d > 0.0_wp .and. par%cap_h > 0.0_wp
      last = 1.0_wp
      found = .false.
      if (guarded) then
         start = min(abs(w%beta)*arc%r_q/w%gamma, 1.0_wp)      ! sine of the angle if gamma and beta did not change
         start = start/(1.0_wp + sqrt(1.0_wp - start*start))
         call newton(par, arc, side, 0.0_wp, 1.0_wp, start, w, tau, at)
         found = at%admissible > 0.0_wp
         last = abs(tau)
         if (found) then
            if (single_root(par, arc, w)) return
            call scan_arc(par, arc, side, last, SCAN - 1, w, low, high, crossed)
            if (.not. crossed) then
               call evaluate_direction(par, arc, tau, w, at)
               return
            end if
         end if
      end if
      if (.not. found) then
         call scan_arc(par, arc, side, last, SCAN, w, low, high, found)
         if (.not. found) return
      end if
      call newton(par, arc, side, low, high, 0.5_wp*(low + high), w, tau, at)
      found = at%admissible > 0.0_wp
   end subroutine find_angle

   !> Newton's method kept inside a bracket (tau without sign, `side` gives it) whose low end has a negative residual
   !> and whose high end a positive one. Leaves w and at evaluated at the angle it returns.
   pure subroutine newton(par, arc, side, from, to, first, w, tau, at)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: side, from, to, first
      type(rate_t), intent(inout) :: w
      real(wp), intent(out) :: tau
      type(trial_t), intent(out) :: at
      real(wp) :: lower, upper, u, slope, step, previous
      integer :: iteration

      lower = from
      upper = to
      u = first
      previous = to - from
      do iteration = 1, MAX_ITERATIONS
         tau = side*u
         call evaluate_direction(par, arc, tau, w, at)
         if (abs(at%residual) <= ROOT_TOLERANCE*at%scale) return
         if (side*at%residual < 0.0_wp) then
            lower = u
         else
            upper = u
         end if
         if (upper - lower <= 2.0_wp*epsilon(u)*upper) return
         slope = slope_of_residual(par, arc, w, at)*2.0_wp/(1.0_wp + u*u)
         step = 2.0_wp*previous
         if (slope > 0.0_wp) step = -side*at%residual/slope
         if (abs(step) > 0.5_wp*previous .or. u + step <= lower .or. u + step >= upper) then
            step = 0.5_wp*(lower + upper) - u
            previous = upper - lower
         else
            previous = abs(step)
         end if
         u = u + step
      end do
   end subroutine newton

   !> False where a root earlier than the one that w holds is possible: a cap, or a change between the floor and a
   !> small (r - r_in):n, bends the residual back. (200,000 random states against a scan of 2048 points: three misses,
   !> under the softening cap; without the scan 169.)
   pure logical function single_root(par, arc, w)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      type(rate_t), intent(in) :: w
      logical :: always_floored, never_near

      ! On less than a right angle x cannot become positive between two negative ends.
      always_floored = arc%x_t**2 + arc%x_q**2 < par%x_floor**2 .or. max(arc%x_t, w%x) < 0.0_wp
      never_near = min(arc%x_t, w%x) > 2.0_wp*par%x_floor
      single_root = .not. (w%capped_h .or. w%capped_d) .and. (always_floored .or. never_near)
   end function single_root

   !> The first of `points` of the SCAN intervals up to `last` at whose end the residual has become positive at an
   !> admissible angle.
   pure subroutine scan_arc(par, arc, side, last, points, w, lower, upper, crossed)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: side, last
      integer, intent(in) :: points
      type(rate_t), intent(inout) :: w
      real(wp), intent(out) :: lower, upper   !< tau of the interval's ends
      logical, intent(out) :: crossed
      type(trial_t) :: at
      integer :: i

      lower = 0.0_wp
      crossed = .false.
      do i = 1, points
         upper = last*(real(i, wp)/real(SCAN, wp))
         call evaluate_direction(par, arc, side*upper, w, at)
         crossed = side*at%residual >= -ROOT_TOLERANCE*at%scale .and. at%admissible > 0.0_wp
         if (crossed) return
         lower = upper
      end do
   end subroutine scan_arc

   !> The direction equation at the angle whose half has the tangent tau, with the guards that bound hardening and
   !> dilatancy.
   pure subroutine evaluate_direction(par, arc, tau, w, at)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: tau
      type(rate_t), intent(inout) :: w
      type(trial_t), intent(out) :: at
      real(wp) :: c, s, trace_cube, r_b, limit

      at%cosine = 2.0_wp/(1.0_wp + tau*tau) - 1.0_wp
      at%sine = tau*(1.0_wp + at%cosine)
      c = at%cosine
      s = at%sine
      w%r_n = c*arc%r_t + s*arc%r_q
      w%x = c*arc%x_t + s*arc%x_q
      w%z_n = c*arc%z_t + s*arc%z_q
      trace_cube = c*(c*(c*arc%cubic(0) + 3.0_wp*s*arc%cubic(1)) + 3.0_wp*s*s*arc%cubic(2)) + s*s*s*arc%cubic(3)
      w%lode = lode_factor(par, trace_cube)

      w%a_d = dilatancy_factor(par, w%z_n)
      w%d = dilatancy(w%a_d, w%lode, w%m_d, w%r_n)
      w%capped_d = .false.
      if (par%cap_d > 0.0_wp .and. w%r_n > 0.0_wp) then
         limit = par%cap_d*2.0_wp*w%g/(w%k_e*w%r_n)
         w%capped_d = w%d > limit
         if (w%capped_d) w%d = limit
      end if

      w%floored = w%x < par%x_floor
      w%h_b = max(w%x, par%x_floor)/w%b_0
      r_b = SQRT_2_3*w%lode*w%m_b
      w%capped_h = .false.
      if (par%cap_h > 0.0_wp .and. w%r_n > r_b) then
         limit = softening_limit(par, w)
         w%capped_h = w%h_b < limit
         if (w%capped_h) w%h_b = limit
      end if

      w%beta = 2.0_wp/3.0_wp*w%p + w%h_b*w%k_e*w%d
      w%gamma = 2.0_wp/3.0_wp*w%p*r_b + 2.0_wp*w%g*w%h_b
      at%residual = w%gamma*s - w%beta*arc%r_q
      at%scale = w%gamma + abs(w%beta)*arc%r_q
      at%admissible = w%gamma*c - w%beta*arc%r_t
   end subroutine evaluate_direction

   !> Least 1/h of the softening cap [-]; 0 where it does not apply.
   pure real(wp) function softening_limit(par, w) result(limit)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp) :: stiffness

      limit = 0.0_wp
      stiffness = 2.0_wp*w%g - w%k_e*w%d*w%r_n
      if (stiffness > 0.0_wp) then
         limit = 2.0_wp/3.0_wp*w%p/((1.0_wp - par%cap_h)*stiffness)*(w%r_n - SQRT_2_3*w%lode*w%m_b)
      end if
   end function softening_limit

   !> Derivative of the residual with respect to the angle, where it was evaluated [kPa].
   pure real(wp) function slope_of_residual(par, arc, w, at) result(slope)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      type(rate_t), intent(in) :: w
      type(trial_t), intent(in) :: at
      real(wp) :: c, s, dr, dx, dg, da, dd, dh, dr_b, stiffness, d_stiffness, d_beta, d_gamma

      c = at%cosine
      s = at%sine
      dr = c*arc%r_q - s*arc%r_t
      dx = c*arc%x_q - s*arc%x_t
      dg = lode_slope(par, w%lode)*3.0_wp*(c*c*(c*arc%cubic(1) - s*arc%cubic(0)) &
                                           + 2.0_wp*c*s*(c*arc%cubic(2) - s*arc%cubic(1)) &
                                           + s*s*(c*arc%cubic(3) - s*arc%cubic(2)))
      if (w%capped_d) then
         dd = -w%d/w%r_n*dr
      else
         da = 0.0_wp
         if (par%fabric .and. w%z_n > 0.0_wp) da = par%a_0*(c*arc%z_q - s*arc%z_t)
         dd = da*(SQRT_2_3*w%lode*w%m_d - w%r_n) + w%a_d*(SQRT_2_3*w%m_d*dg - dr)
      end if
      dr_b = SQRT_2_3*w%m_b*dg
      if (w%capped_h) then
         stiffness = 2.0_wp*w%g - w%k_e*w%d*w%r_n
         d_stiffness = -w%k_e*(dd*w%r_n + w%d*dr)
         dh = 2.0_wp/3.0_wp*w%p/((1.0_wp - par%cap_h)*stiffness)*(dr - dr_b) - w%h_b*d_stiffness/stiffness
      else
         dh = merge(0.0_wp, dx/w%b_0, w%floored)
      end if
      d_beta = w%k_e*(dh*w%d + w%h_b*dd)
      d_gamma = 2.0_wp/3.0_wp*w%p*dr_b + 2.0_wp*w%g*dh
      slope = d_gamma*s + w%gamma*c - d_beta*arc%r_q
   end function slope_of_residual
end module mud_rates
