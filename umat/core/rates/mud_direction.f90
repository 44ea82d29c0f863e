! SPDX-License-Identifier: MIT
!> The loading direction of a rate: the root of one scalar equation on an arc.
!>
!> gamma n = t y + beta r, y = 1/(L h), so that n lies in the plane of t and r and one angle decides it:
!> docs/theory/material.md section 4.6. The angle, phi there, is w here. The equation is that of
!> mud_direction_equation; here its roots are looked for.
module mud_direction
   use mud_arc, only: arc_t, arc_through, trace_cube, trace_cube_slope
   use mud_branchless, only: smaller
   use mud_critical_state, only: lode_factor, lode_slope
   use mud_direction_equation, only: equation_t, equation_of, find_moduli, slopes_t, slopes_at
   use mud_flow, only: dilatancy_factor
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_rate, only: moduli_t, rate_t
   use mud_tensor, only: ddot
   implicit none (type, external)
   private
   public :: find_direction
   public :: angle_t, bracket_t, PARALLEL, MAX_ITERATIONS, ALONE, half_tangent, first_guess, vanishes, narrow, &
             is_narrow, advance, evaluate_direction, slope_of_residual, company_of   ! for several points at a time

   real(wp), parameter :: PARALLEL = 1.0e-13_wp          !< r normal to t below this share of r is rounding [-].
   real(wp), parameter :: ROOT_TOLERANCE = 1.0e-14_wp    !< Tolerance of the direction equation, share of its terms [-].
   integer, parameter :: MAX_ITERATIONS = 80             !< Bisection alone needs 53.
   integer, parameter :: POINTS = 8   !< Points of the scan for roots where a bracket is not certain: looked at
                                      !< together.
   real(wp), parameter :: NOT_FAR = 0.5_wp   !< Cosine up to which a rising x excludes roots [-].
   !> Share of the floor below which the change of x up to the root makes the residual straight: r is nearly along t. In
   !> triaxial tests of a host r leaves t by rounding alone, and so would decide what follows [-].
   real(wp), parameter :: NEARLY_ALONG = 1.0e-6_wp
   integer, parameter :: ALONE = 1, SEVERAL = 0, UNKNOWN = -1   !< Roots on an arc: one, perhaps more; it is to be seen.

   !> An interval of the arc with a root, and where Newton's method is in it; tau without its sign.
   type :: bracket_t
      real(wp) :: lower, upper
      real(wp) :: u               !< angle that is tried
      real(wp) :: previous        !< length of the last step
   end type bracket_t

   !> The direction equation at one angle.
   type :: angle_t
      real(wp) :: cosine, sine      !< cosine and sine of the angle w
      real(wp) :: residual          !< gamma sin(w) - beta r:q [kPa]
      real(wp) :: scale             !< gamma + |beta| r:q [kPa]
      real(wp) :: admissible        !< y |t|, positive if admissible [kPa]
   end type angle_t
contains
   !> The unit direction n and what depends on it. Leaves w%loading false and sets w%no_root where none is admissible.
   !> On entry w has r, r - r_in, z, moduli and t > 0 of the rate, units as in rate_t. docs/theory/material.md sections
   !> 4.6, 5.
   !>
   !> Wanted is the admissible root of the direction equation with the smallest |w| on the side where it lies. An angle
   !> is known by the tangent of its half, tau: its cosine and sine then cost a division. In units of that side the
   !> residual begins negative at w = 0. With every guard on it ends positive at a right angle, so a bracketed Newton
   !> iteration cannot fail. Where the floor or a cap acts, and with guards off, several roots or none are possible.
   pure subroutine find_direction(par, known, w)
      type(params_t), intent(in) :: par
      logical, intent(in) :: known          !< w%n is the direction for nearly the same t: a start of the iteration.
      type(rate_t), intent(inout) :: w
      type(arc_t) :: arc
      type(equation_t) :: eq
      type(angle_t) :: at
      real(wp) :: n_t(6), q(6), side, start, tau, low, high
      logical :: guarded, found, crossed

      n_t = w%t/w%t_norm
      call arc_through(w%r, w%r_moved, w%z, n_t, PARALLEL*max(w%r_norm, 1.0e-3_wp), arc, q)
      eq = equation_of(par, w)
      if (arc%r_q <= 0.0_wp) then
         w%n = n_t
         call evaluate_direction(par, eq, arc, 0.0_wp, w%moduli_t, at)
         found = at%admissible > 0.0_wp
      else
         start = -1.0_wp
         if (known) start = half_tangent(w%n, n_t, q)
         guarded = par%floored .and. par%cap_d > 0.0_wp .and. par%cap_h > 0.0_wp
         call find_side(par, eq, arc, guarded, start, w, side, at)
         w%several = .not. guarded
         tau = 1.0_wp
         found = .false.
         if (guarded) then
            call newton(par, eq, arc, side, 0.0_wp, 1.0_wp, start, w, tau, at)
            found = at%admissible > 0.0_wp
            if (found) w%several = .not. single_root(par, eq, arc, side, at, w)
         end if
         if (w%several .or. .not. found) then
            ! a first change of sign up to |tau|, a root already found or the end of the arc
            call scan_arc(par, eq, arc, side, abs(tau), found, low, high, crossed)
            if (crossed) then
               call newton(par, eq, arc, side, low, high, 0.5_wp*(low + high), w, tau, at)
               found = at%admissible > 0.0_wp
            end if
         end if
         w%n = at%cosine*n_t + at%sine*q
      end if
      w%loading = found
      w%no_root = .not. found
      if (.not. found) return
      w%y = at%admissible/w%t_norm
      w%l = w%h_b/w%y
   end subroutine find_direction

   !> The side of the arc on which the root lies, and where the iteration starts.
   pure subroutine find_side(par, eq, arc, guarded, start, w, side, at)
      type(params_t), intent(in) :: par
      type(equation_t), intent(in) :: eq
      type(arc_t), intent(in) :: arc
      logical, intent(in) :: guarded
      real(wp), intent(inout) :: start   !< tau of a guess; then without sign, of a right angle at most
      type(rate_t), intent(inout) :: w
      real(wp), intent(out) :: side
      type(angle_t), intent(inout) :: at
      logical :: known

      ! Where r along t is below the dilatancy surface of every Lode angle D is not negative there, and beta positive.
      known = guarded .and. start > 0.0_wp .and. start < 1.0_wp .and. &
              arc%r_t <= min(par%critical%c, 1.0_wp)*eq%r_d_1
      side = 1.0_wp
      if (.not. known) then
         call evaluate_direction(par, eq, arc, 0.0_wp, w%moduli_t, at)
         side = sign(1.0_wp, w%beta)
      end if
      start = side*start
      if (guarded .and. (start <= 0.0_wp .or. start >= 1.0_wp)) start = first_guess(arc, w)
   end subroutine find_side

   !> tau of a direction n on the arc from n_t to q; -1 of one against n_t, which has no half angle.
   pure real(wp) function half_tangent(n, n_t, q) result(tau)
      real(wp), intent(in) :: n(6), n_t(6), q(6)

      tau = -1.0_wp
      if (ddot(n, n_t) > -0.9_wp) tau = ddot(n, q)/(1.0_wp + ddot(n, n_t))
   end function half_tangent

   !> |tau| of the root if gamma and beta were what they are at w = 0.
   pure real(wp) function first_guess(arc, w) result(tau)
      type(arc_t), intent(in) :: arc
      type(rate_t), intent(in) :: w
      real(wp) :: sine

      sine = min(abs(w%beta)*arc%r_q/w%gamma, 1.0_wp)
      tau = sine/(1.0_wp + sqrt(1.0_wp - sine*sine))
   end function first_guess

   !> Newton's method kept inside a bracket (tau without sign, `side` gives it) whose low end has a negative residual
   !> and whose high end a positive one. Leaves w and at evaluated at the angle it returns.
   pure subroutine newton(par, eq, arc, side, from, to, first, w, tau, at)
      type(params_t), intent(in) :: par
      type(equation_t), intent(in) :: eq
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: side, from, to, first
      type(rate_t), intent(inout) :: w
      real(wp), intent(out) :: tau
      type(angle_t), intent(out) :: at
      type(bracket_t) :: bracket
      integer :: iteration

      bracket = bracket_t(from, to, first, to - from)
      do iteration = 1, MAX_ITERATIONS
         tau = side*bracket%u
         call evaluate_direction(par, eq, arc, tau, w%moduli_t, at)
         if (vanishes(at)) return
         call narrow(side, at, bracket)
         if (is_narrow(bracket)) return
         call advance(side*at%residual, slope_of_residual(par, arc, w, at), bracket)
      end do
   end subroutine newton

   !> True where the residual is rounding.
   pure logical function vanishes(at)
      type(angle_t), intent(in) :: at

      vanishes = abs(at%residual) <= ROOT_TOLERANCE*at%scale
   end function vanishes

   !> True of a bracket that rounding does not divide.
   pure logical function is_narrow(b)
      type(bracket_t), intent(in) :: b

      is_narrow = b%upper - b%lower <= 2.0_wp*epsilon(b%u)*b%upper
   end function is_narrow

   !> Takes the angle that was tried as an end of the bracket.
   pure subroutine narrow(side, at, b)
      real(wp), intent(in) :: side
      type(angle_t), intent(in) :: at
      type(bracket_t), intent(inout) :: b

      if (side*at%residual < 0.0_wp) then
         b%lower = b%u
      else
         b%upper = b%u
      end if
   end subroutine narrow

   !> The next angle to try: Newton's, or the middle where that leads out of the bracket or is no shorter by half.
   pure subroutine advance(residual, by_angle, b)
      real(wp), intent(in) :: residual, by_angle   !< [kPa]: in units of the side; its slope by the angle, with a sign
      type(bracket_t), intent(inout) :: b
      real(wp) :: slope, step

      slope = by_angle*2.0_wp/(1.0_wp + b%u*b%u)
      step = 2.0_wp*b%previous
      if (slope > 0.0_wp) step = -residual/slope
      if (abs(step) > 0.5_wp*b%previous .or. b%u + step <= b%lower .or. b%u + step >= b%upper) then
         step = 0.5_wp*(b%lower + b%upper) - b%u
         b%previous = b%upper - b%lower
      else
         b%previous = abs(step)
      end if
      b%u = b%u + step
   end subroutine advance

   !> False where a root before that of w and at is possible: a cap, or a change between the floor and a small x, bends
   !> the residual back. Where x rises up to the root only the floor's equation can have one, before x passes the floor:
   !> the residual there tells (the roots of 2,400,000 random states of six kinds are those of scans of all such arcs).
   pure logical function single_root(par, eq, arc, side, at, w)
      type(params_t), intent(in) :: par
      type(equation_t), intent(in) :: eq
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: side
      type(angle_t), intent(in) :: at
      type(rate_t), intent(in) :: w
      type(moduli_t) :: passing
      type(angle_t) :: there
      real(wp) :: x_q
      integer :: company

      company = company_of(par, arc, side, at, w)
      single_root = company == ALONE
      if (company /= UNKNOWN) return
      x_q = side*arc%x_q
      passing = w%moduli_t
      call evaluate_direction(par, eq, arc, side*(par%x_floor - arc%x_t) &
                              /(x_q + sqrt(max(arc%x_t**2 + x_q**2 - par%x_floor**2, 0.0_wp))), passing, there)
      single_root = side*there%residual < 0.0_wp .and. .not. (passing%capped_h .or. passing%capped_d)
   end function single_root

   !> ALONE, SEVERAL or UNKNOWN: what is known at t and at a root tells that there is no other, or that there may be, or
   !> the residual where x passes its floor decides.
   pure integer function company_of(par, arc, side, at, w) result(company)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: side
      type(angle_t), intent(in) :: at
      type(rate_t), intent(in) :: w
      real(wp) :: reach2

      reach2 = arc%x_t**2 + arc%x_q**2
      company = ALONE
      if (max(arc%r_q, abs(at%sine))*sqrt(reach2) <= NEARLY_ALONG*par%x_floor) return
      company = SEVERAL
      if (w%capped_h .or. w%capped_d) return
      company = ALONE
      ! always floored: on less than a right angle x cannot become positive between two negative ends
      if (reach2 < par%x_floor**2 .or. max(arc%x_t, w%x) < 0.0_wp) return
      company = SEVERAL
      if (w%own%bends) return   ! an option that bends D and 1/h with x bends the residual wherever x changes
      company = ALONE
      if (min(arc%x_t, w%x) > 2.0_wp*par%x_floor) return   ! never near the floor
      company = SEVERAL
      if (at%cosine < NOT_FAR .or. at%cosine*side*arc%x_q < abs(at%sine)*arc%x_t) return
      company = merge(ALONE, UNKNOWN, w%floored .or. arc%x_t >= par%x_floor)
   end function company_of

   !> The first interval of the arc up to tau = `last` (a root already known, or an end) in which the residual becomes
   !> positive at an admissible angle. Some points inside are looked at together; an interval between them is looked at
   !> again, more closely, where the chords beside it, prolonged, meet zero in it: a residual that bends once between
   !> two points cannot rise above both of them. (240,000 random states: the same roots as with a scan of 64 points, all
   !> but one of them those of a scan of 2048.)
   pure subroutine scan_arc(par, eq, arc, side, last, is_root, lower, upper, crossed)
      type(params_t), intent(in) :: par
      type(equation_t), intent(in) :: eq
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: side, last
      logical, intent(in) :: is_root
      real(wp), intent(out) :: lower, upper       !< tau of the interval's ends, without sign
      logical, intent(out) :: crossed
      type(moduli_t) :: m
      type(angle_t) :: at
      real(wp) :: f(-1:POINTS + 2), above(POINTS), fine(POINTS), above_fine(POINTS), step, reach, from
      integer :: i, j, intervals

      crossed = .false.
      lower = 0.0_wp
      upper = last
      intervals = POINTS
      if (is_root) intervals = POINTS + 1   ! the known root itself is no crossing
      step = last/intervals
      call residuals(par, eq, arc, side, 0.0_wp, step, f(1:POINTS), above)
      call evaluate_direction(par, eq, arc, 0.0_wp, m, at)
      f(-1:0) = side*at%residual
      f(POINTS + 1:) = merge(0.0_wp, f(POINTS), is_root)
      do i = 0, intervals - 1
         from = i*step
         reach = max(2.0_wp*f(i) - f(i - 1), 2.0_wp*f(i + 1) - f(i + 2), f(i), f(i + 1))
         if (i == POINTS) then
            reach = 1.5_wp*f(i) - 0.5_wp*f(i - 1)
         else
            reach = max(reach, above(i + 1))
         end if
         if (reach < 0.0_wp) cycle
         call residuals(par, eq, arc, side, from, step/(POINTS + 1), fine, above_fine)
         do j = 1, POINTS
            if (above_fine(j) < 0.0_wp) cycle
            crossed = .true.
            lower = from + (j - 1)*(step/(POINTS + 1))
            upper = from + j*(step/(POINTS + 1))
            return
         end do
         if (i == POINTS) return
         crossed = above(i + 1) >= 0.0_wp
         if (.not. crossed) cycle
         lower = from + POINTS*(step/(POINTS + 1))
         upper = from + step
         return
      end do
   end subroutine scan_arc

   !> The residual in units of its side, and a number that is not negative where it is positive at an admissible angle,
   !> at equal steps of tau from `from` on: the same equation as in evaluate_direction, of all points together.
   pure subroutine residuals(par, eq, arc, side, from, step, f, above)
      type(params_t), intent(in) :: par
      type(equation_t), intent(in) :: eq
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: side, from, step
      real(wp), intent(out) :: f(POINTS), above(POINTS)
      real(wp), dimension(POINTS) :: c, s, lode, a_d
      type(moduli_t) :: m
      real(wp) :: tau
      integer :: i

      do i = 1, POINTS
         tau = side*(from + i*step)
         c(i) = 2.0_wp/(1.0_wp + tau*tau) - 1.0_wp
         s(i) = tau*(1.0_wp + c(i))
      end do
      do i = 1, POINTS
         lode(i) = lode_factor(par%critical, trace_cube(arc, c(i), s(i)))
         a_d(i) = dilatancy_factor(par%flow, eq%a_0, c(i)*arc%z_t + s(i)*arc%z_q)
      end do
      do i = 1, POINTS
         m%r_n = c(i)*arc%r_t + s(i)*arc%r_q
         m%x = c(i)*arc%x_t + s(i)*arc%x_q
         m%a_d = a_d(i)
         m%r_b = eq%r_b_1*lode(i)
         m%r_d = eq%r_d_1*lode(i)
         call find_moduli(eq, m)
         f(i) = side*(m%gamma*s(i) - m%beta*arc%r_q)
         above(i) = smaller(f(i) + ROOT_TOLERANCE*(m%gamma + abs(m%beta)*arc%r_q), m%gamma*c(i) - m%beta*arc%r_t)
      end do
   end subroutine residuals

   !> The direction equation at the angle whose half has the tangent tau.
   pure subroutine evaluate_direction(par, eq, arc, tau, m, at)
      type(params_t), intent(in) :: par
      type(equation_t), intent(in) :: eq
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: tau
      type(moduli_t), intent(inout) :: m
      type(angle_t), intent(out) :: at

      at%cosine = 2.0_wp/(1.0_wp + tau*tau) - 1.0_wp
      at%sine = tau*(1.0_wp + at%cosine)
      m%r_n = at%cosine*arc%r_t + at%sine*arc%r_q
      m%x = at%cosine*arc%x_t + at%sine*arc%x_q
      m%z_n = at%cosine*arc%z_t + at%sine*arc%z_q
      m%a_d = dilatancy_factor(par%flow, eq%a_0, m%z_n)
      m%lode = lode_factor(par%critical, trace_cube(arc, at%cosine, at%sine))
      m%r_b = eq%r_b_1*m%lode
      m%r_d = eq%r_d_1*m%lode
      call find_moduli(eq, m)
      at%residual = m%gamma*at%sine - m%beta*arc%r_q
      at%scale = m%gamma + abs(m%beta)*arc%r_q
      at%admissible = m%gamma*at%cosine - m%beta*arc%r_t
   end subroutine evaluate_direction

   !> Derivative of the residual with respect to the angle, where it was evaluated [kPa].
   pure real(wp) function slope_of_residual(par, arc, w, at) result(slope)
      type(params_t), intent(in) :: par
      type(arc_t), intent(in) :: arc
      type(rate_t), intent(in) :: w
      type(angle_t), intent(in) :: at
      type(slopes_t) :: s
      real(wp) :: dr, dx, dz, d_lode, dd, dh, d_beta, d_gamma

      call slopes_at(par, w, w%moduli_t, s)
      dr = at%cosine*arc%r_q - at%sine*arc%r_t
      dx = at%cosine*arc%x_q - at%sine*arc%x_t
      dz = at%cosine*arc%z_q - at%sine*arc%z_t
      d_lode = SQRT_2_3*lode_slope(par%critical, w%lode)*trace_cube_slope(arc, at%cosine, at%sine)
      dd = s%d_r*dr + s%d_z*dz + s%d_r_d*w%m_d*d_lode
      if (w%own%bends) dd = dd + s%d_x*dx
      dh = s%h_r*dr + s%h_z*dz + s%h_x*dx + (s%h_r_d*w%m_d + s%h_r_b*w%m_b)*d_lode
      d_beta = w%k_e*(dh*w%d + w%h_b*dd)
      d_gamma = 2.0_wp/3.0_wp*w%p*w%m_b*d_lode + 2.0_wp*w%g*dh
      slope = d_gamma*at%sine + w%gamma*at%cosine - d_beta*arc%r_q
   end function slope_of_residual
end module mud_direction
