! SPDX-License-Identifier: MIT
!> Critical state line, state parameter, stress ratios that depend on it, Lode dependence, compression line;
!> docs/theory/material.md sections 3.2 to 3.5.
module mud_critical_state
   use mud_branchless, only: larger, smaller
   use mud_kinds, only: wp, SQRT_2_3, SQRT_6, NOTHING
   use mud_tensor, only: ddot, deviator, square
   implicit none (type, external)
   private
   public :: critical_t, critical_void_ratio, state_parameter, state_parameter_slopes, bounding_ratio, bounding_slope, &
             dilatancy_ratio, dilatancy_slope, lode_factor, lode_slope, lode_gradient, bounding_norm, compression_image

   !> |n psi| and |ln alpha_hat| are limited to these, to prevent overflow: only absurd parameters reach the limits [-].
   real(wp), parameter :: EXPONENT_LIMIT = 20.0_wp, IMAGE_LIMIT = 50.0_wp

   !> Parameters of the lines and of the stress ratios, as in mud_registry.
   type :: critical_t
      real(wp) :: n_c, lambda, alpha_csl, n_l, m_c, n_b, n_d
      real(wp) :: c           !< 1 without Lode dependence too: a circle [-].
      real(wp) :: c4          !< c**4, for the Lode function [-].
      real(wp) :: lode_bend   !< sqrt(6) (1 - c**4)/(8 c**4), for its slope [-].
   end type critical_t
contains
   !> e_c [-] at a mean effective stress [kPa] and a bonding factor [-], paper eq. (8). docs/theory/material.md section
   !> 3.2; p + alpha_csl > 0 is not checked.
   pure real(wp) function critical_void_ratio(par, f, p) result(e_c)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: f, p

      e_c = par%n_c*f*(p + par%alpha_csl)**(-par%lambda)
   end function critical_void_ratio

   !> State parameter psi = e - e_c [-] at a bonding factor f [-] and a mean effective stress [kPa]. Been & Jefferies
   !> (1985); docs/theory/material.md section 3.2.
   pure real(wp) function state_parameter(par, f, e, p) result(psi)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: f, e, p

      psi = e - critical_void_ratio(par, f, p)
   end function state_parameter

   !> Slopes of psi by f [-] and p [1/kPa]; that by e is 1.
   pure subroutine state_parameter_slopes(par, psi, f, e, p, by_f, by_p)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: psi, f, e, p
      real(wp), intent(out) :: by_f, by_p

      by_f = -(e - psi)/f
      by_p = par%lambda*(e - psi)/(p + par%alpha_csl)
   end subroutine state_parameter_slopes

   !> M^b [-] in triaxial compression at a state parameter [-], paper eq. (12). The exponent is kept within 0 and 20;
   !> docs/theory/material.md section 3.3.
   pure real(wp) function bounding_ratio(par, psi) result(m_b)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: psi

      m_b = par%m_c*exp(min(max(-par%n_b*psi, 0.0_wp), EXPONENT_LIMIT))
   end function bounding_ratio

   !> dM^b/dpsi [-] where M^b is m_b; 0 for psi >= 0, the upper bound of the exponent is left out.
   pure real(wp) function bounding_slope(par, psi, m_b) result(slope)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: psi, m_b

      slope = merge(-par%n_b*m_b, 0.0_wp, psi < 0.0_wp)
   end function bounding_slope

   !> M^d [-] in triaxial compression at a state parameter [-], paper eq. (10). The exponent is kept within -20 and 20;
   !> docs/theory/material.md section 3.3.
   pure real(wp) function dilatancy_ratio(par, psi) result(m_d)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: psi

      m_d = par%m_c*exp(min(max(par%n_d*psi, -EXPONENT_LIMIT), EXPONENT_LIMIT))
   end function dilatancy_ratio

   !> dM^d/dpsi [-] where M^d is m_d; the bounds of the exponent are left out.
   pure real(wp) function dilatancy_slope(par, m_d) result(slope)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: m_d

      slope = par%n_d*m_d
   end function dilatancy_slope

   !> Lode factor g [-] of a unit deviatoric direction with tr(n^3) = trace_cube: 1 in triaxial compression, c in
   !> extension. Rebuilt: the fourth-root form, convex for c >= 0.611. 1 where the Lode dependence is off, cos3t kept
   !> within -1 and 1; docs/theory/material.md section 3.4.
   pure real(wp) function lode_factor(par, trace_cube) result(g)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: trace_cube
      real(wp) :: cos_3t

      cos_3t = smaller(larger(SQRT_6*trace_cube, -1.0_wp), 1.0_wp)
      g = sqrt(sqrt(2.0_wp*par%c4/(1.0_wp + par%c4 - (1.0_wp - par%c4)*cos_3t)))
   end function lode_factor

   !> d g / d tr(n^3) [-]. With g**4 = 2 c**4/(1 + c**4 - (1 - c**4) cos3t) it is a power of g. 0 where the Lode
   !> dependence is off; docs/theory/material.md section 3.4.
   pure real(wp) function lode_slope(par, g) result(slope)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: g

      slope = par%lode_bend*g**5
   end function lode_slope

   !> g and dg/dr in the direction of a stress ratio r, r_norm = |r| [-]. The gradient is a deviator without a part
   !> along r; zeros where the Lode dependence is off, and without a direction (r = 0).
   pure subroutine lode_gradient(par, r, r_norm, g, g_r)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: r(6), r_norm
      real(wp), intent(out) :: g, g_r(6)
      real(wp) :: r2(6), cube

      g = 1.0_wp
      g_r = 0.0_wp
      if (r_norm <= NOTHING) return
      r2 = square(r)
      cube = ddot(r2, r)/r_norm**3
      g = lode_factor(par, cube)
      g_r = (3.0_wp*lode_slope(par, g))*(deviator(r2)/r_norm**3 - (cube/r_norm**2)*r)
   end subroutine lode_gradient

   !> Norm of the bounding stress ratio in the direction of r, sqrt(2/3) g(r/|r|) M^b [-]. r_norm = |r| and m_b = M^b
   !> [-]; without a direction (r = 0) g is 1. docs/theory/material.md sections 3.3, 3.4.
   pure real(wp) function bounding_norm(par, r, r_norm, m_b)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: r(6), r_norm, m_b
      real(wp) :: g

      g = lode_factor(par, ddot(square(r), r)/max(r_norm, NOTHING)**3)
      bounding_norm = SQRT_2_3*merge(g, 1.0_wp, r_norm > NOTHING)*m_b
   end function bounding_norm

   !> Image alpha_hat [kPa] of a void ratio on the compression line, paper eq. (7) with f corrected. Void ratio
   !> and f [-]; ln alpha_hat is kept within -50 and 50; docs/theory/material.md section 3.5.
   pure real(wp) function compression_image(par, f, e) result(alpha)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: f, e

      alpha = exp(min(max(log(par%n_l*f/e)/par%lambda, -IMAGE_LIMIT), IMAGE_LIMIT))
   end function compression_image
end module mud_critical_state
