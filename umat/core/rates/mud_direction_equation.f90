! SPDX-License-Identifier: MIT
!> The direction equation gamma n = t y + beta r: dilatancy and hardening in a direction, with the guards that bound
!> them, and how both depend on everything; docs/theory/material.md sections 4.2, 4.6 and 5. The only place of these
!> equations: the search for roots, the rate, the tangents and the sensitivities take them from here.
module mud_direction_equation
   use mud_branchless, only: positive, larger, smaller
   use mud_flow, only: dilatancy
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_options, only: bend_t, bend_of, bend, bend_of_hardening
   use mud_rate, only: moduli_t, rate_t
   implicit none (type, external)
   private
   public :: equation_t, equation_of, find_moduli, slopes_t, slopes_at

   real(wp), parameter :: NEGLIGIBLE = 1.0e-12_wp   !< Smaller divisors would only make a cap that never acts [-].
   real(wp), parameter :: NO_LIMIT = 1.0e100_wp     !< A cap that is off.

   !> Terms of the direction equation that are the same in every direction.
   type :: equation_t
      real(wp) :: two_g, k_e      !< 2 G, K_e [kPa]
      real(wp) :: two_thirds_p    !< [kPa]
      real(wp) :: a_0, per_b_0    !< A_0, 1/b_0 [-]
      real(wp) :: r_b_1, r_d_1    !< |r| on both surfaces in triaxial compression [-]
      real(wp) :: x_floor         !< x_0 [-]
      real(wp) :: most_d          !< D r:n of the contraction cap [-]
      real(wp) :: least_h         !< 2/3 p'/(1 - kappa_c) of the softening cap, 0: off [kPa]
      logical :: bends            !< An option bends D and 1/h with x; `with_x` is set then.
      type(bend_t) :: with_x
   end type equation_t

   !> Slopes of D by r:n, z:n, its surface, G and K_e, and of 1/h by these (with what D does to the softening cap), by
   !> x, its surface, p' at constant b_0 and b_0.
   type :: slopes_t
      real(wp) :: d_r, d_z, d_r_d, d_g, d_k
      real(wp) :: h_r, h_z, h_r_d, h_g, h_k, h_x, h_r_b, h_p, h_b_0
      !> D by x, and D and 1/h by ln q/x**2 of an option that bends with q; 0 without it.
      real(wp) :: d_x, d_q, h_q
      real(wp) :: d_ln, h_ln   !< both by ln of the factor with which an option softens, which q does not feel
   end type slopes_t
contains
   !> Direction equation of a rate whose state, moduli and choice of the isotropic mechanism are known; units as in
   !> rate_t.
   pure function equation_of(par, w) result(eq)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(equation_t) :: eq

      eq%two_g = 2.0_wp*w%g
      eq%k_e = w%k_e
      eq%two_thirds_p = 2.0_wp/3.0_wp*w%p
      eq%a_0 = w%a_0
      eq%per_b_0 = 1.0_wp/w%b_0
      eq%r_b_1 = SQRT_2_3*w%m_b
      eq%r_d_1 = SQRT_2_3*w%m_d
      eq%x_floor = par%x_floor
      eq%most_d = merge(par%cap_d*eq%two_g/eq%k_e, NO_LIMIT, par%cap_d > 0.0_wp)
      eq%least_h = merge(eq%two_thirds_p/(1.0_wp - par%cap_h), 0.0_wp, par%cap_h > 0.0_wp)
      eq%bends = w%own%bends
      if (eq%bends) eq%with_x = bend_of(par, w%own, w%m_d/w%m_b, w%a_0, w%b_0)
   end function equation_of

   !> D, 1/h, beta and gamma in a direction, and the guards that act there, from r:n, (r - r_in):n, A_d and |r| on both
   !> surfaces in m; docs/theory/material.md sections 4.2, 4.6, 5.2 to 5.4. Without branches: of several directions the
   !> compiler works on two at a time.
   pure subroutine find_moduli(eq, m)
      type(equation_t), intent(in) :: eq
      type(moduli_t), intent(inout) :: m
      real(wp) :: d, h_b, stiffness, limit   ! D and 1/h without the caps

      d = dilatancy(m%a_d, m%r_d, m%r_n)
      h_b = larger(m%x, eq%x_floor)*eq%per_b_0
      if (eq%bends) call bend(eq%with_x, larger(m%x, eq%x_floor), d, h_b, m%bent, m%bend_slope)
      m%d = smaller(d, eq%most_d/larger(m%r_n, NEGLIGIBLE))
      stiffness = eq%two_g - eq%k_e*m%d*m%r_n
      limit = eq%least_h*positive(m%r_n - m%r_b)/larger(stiffness, NEGLIGIBLE*eq%two_g)
      m%h_b = larger(limit*(0.5_wp + sign(0.5_wp, stiffness)), h_b)   ! exactly h_b where the cap does not act
      m%beta = eq%two_thirds_p + m%h_b*eq%k_e*m%d
      m%gamma = eq%two_thirds_p*m%r_b + eq%two_g*m%h_b
      m%floored = m%x < eq%x_floor
      m%capped_d = m%d < d
      m%capped_h = m%h_b > h_b
   end subroutine find_moduli

   !> Slopes of D and 1/h in a direction of the equation of w. Derivatives of find_moduli; A_d changes with z:n by
   !> docs/theory/material.md section 4.2.
   pure subroutine slopes_at(par, w, at, s)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w   !< Rate, of which state, moduli and choice of the isotropic mechanism are read.
      type(moduli_t), intent(in) :: at
      type(slopes_t), intent(out) :: s
      real(wp) :: stiffness, by_stiffness, f, per_x

      s%d_z = 0.0_wp
      s%d_x = 0.0_wp
      s%d_q = 0.0_wp
      s%h_q = 0.0_wp
      s%d_ln = merge(0.0_wp, at%d, at%capped_d)
      per_x = merge(0.0_wp, 1.0_wp/larger(at%x, NEGLIGIBLE), at%floored)
      s%d_r_d = 0.0_wp
      s%d_g = 0.0_wp
      s%d_k = 0.0_wp
      if (at%capped_d) then
         s%d_r = -at%d/at%r_n
         s%d_g = at%d/w%g
         s%d_k = -at%d/w%k_e
      else
         s%d_r = -at%a_d
         s%d_r_d = at%a_d
         if (at%z_n > 0.0_wp) s%d_z = par%flow%fabric*w%a_0*(at%r_d - at%r_n)
         if (w%own%bends .and. at%d > 0.0_wp) then
            f = at%bent
            s%d_r = f*s%d_r
            s%d_r_d = f*s%d_r_d
            s%d_z = f*s%d_z
            s%d_q = at%bend_slope*at%d
            s%d_x = 2.0_wp*s%d_q*per_x
         end if
      end if
      if (at%capped_h) then
         stiffness = 2.0_wp*w%g - w%k_e*at%d*at%r_n
         by_stiffness = at%h_b/stiffness
         s%h_r_b = -2.0_wp/3.0_wp*w%p/((1.0_wp - par%cap_h)*stiffness)
         s%h_r = -s%h_r_b + by_stiffness*w%k_e*(at%d + at%r_n*s%d_r)
         s%h_z = by_stiffness*w%k_e*at%r_n*s%d_z
         s%h_r_d = by_stiffness*w%k_e*at%r_n*s%d_r_d
         s%h_g = -by_stiffness*(2.0_wp - w%k_e*at%r_n*s%d_g)
         s%h_k = by_stiffness*at%r_n*(at%d + w%k_e*s%d_k)
         s%h_p = at%h_b/w%p
         s%h_x = by_stiffness*w%k_e*at%r_n*s%d_x
         s%h_q = by_stiffness*w%k_e*at%r_n*s%d_q
         s%h_ln = by_stiffness*w%k_e*at%r_n*s%d_ln
         s%h_b_0 = 0.0_wp
      else
         s%h_r_b = 0.0_wp
         s%h_r = 0.0_wp
         s%h_z = 0.0_wp
         s%h_r_d = 0.0_wp
         s%h_g = 0.0_wp
         s%h_k = 0.0_wp
         s%h_p = 0.0_wp
         s%h_x = merge(0.0_wp, 1.0_wp/w%b_0, at%floored)
         s%h_b_0 = -at%h_b/w%b_0
         s%h_ln = -at%h_b
         if (w%own%bends) then
            s%h_q = bend_of_hardening(par, at%bend_slope)*at%h_b
            s%h_x = (at%h_b + 2.0_wp*s%h_q)*per_x
         end if
      end if
   end subroutine slopes_at
end module mud_direction_equation
