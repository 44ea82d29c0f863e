! SPDX-License-Identifier: MIT
!> Critical state line, state parameter, stress ratios that depend on it, Lode dependence, compression line;
!> docs/theory/material.md sections 3.2 to 3.5.
module mud_critical_state
   use mud_kinds, only: wp, SQRT_6
   use mud_params, only: params_t
   implicit none (type, external)
   private
   public :: critical_void_ratio, bounding_ratio, dilatancy_ratio, lode_factor, lode_slope, compression_image

   !> |n psi| and |ln alpha_hat| are limited to these, to prevent overflow: only absurd parameters reach the limits [-].
   real(wp), parameter :: EXPONENT_LIMIT = 20.0_wp, IMAGE_LIMIT = 50.0_wp
contains
   !> e_c [-] at a mean effective stress [kPa] and a bonding factor [-], paper eq. (8). docs/theory/material.md section
   !> 3.2; p + alpha_csl > 0 is not checked.
   pure real(wp) function critical_void_ratio(par, f, p) result(e_c)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: f, p

      e_c = par%n_c*f*(p + par%alpha_csl)**(-par%lambda)
   end function critical_void_ratio

   !> M^b [-] in triaxial compression at a state parameter [-], paper eq. (12). The exponent is kept within 0 and 20;
   !> docs/theory/material.md section 3.3.
   pure real(wp) function bounding_ratio(par, psi) result(m_b)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi

      m_b = par%m_c*exp(min(max(-par%n_b*psi, 0.0_wp), EXPONENT_LIMIT))
   end function bounding_ratio

   !> M^d [-] in triaxial compression at a state parameter [-], paper eq. (10). The exponent is kept within -20 and 20;
   !> docs/theory/material.md section 3.3.
   pure real(wp) function dilatancy_ratio(par, psi) result(m_d)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi

      m_d = par%m_c*exp(min(max(par%n_d*psi, -EXPONENT_LIMIT), EXPONENT_LIMIT))
   end function dilatancy_ratio

   !> Lode factor g [-] of a unit deviatoric direction with tr(n^3) = trace_cube: 1 in triaxial compression, c in
   !> extension. Rebuilt: the fourth-root form, convex for c >= 0.611. 1 where the Lode dependence is off, cos3t kept
   !> within -1 and 1; docs/theory/material.md section 3.4.
   pure real(wp) function lode_factor(par, trace_cube) result(g)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: trace_cube
      real(wp) :: cos_3t

      g = 1.0_wp
      if (.not. par%lode) return
      cos_3t = min(max(SQRT_6*trace_cube, -1.0_wp), 1.0_wp)
      g = sqrt(sqrt(2.0_wp*par%c4/(1.0_wp + par%c4 - (1.0_wp - par%c4)*cos_3t)))
   end function lode_factor

   !> d g / d tr(n^3) [-]. With g**4 = 2 c**4/(1 + c**4 - (1 - c**4) cos3t) it is a power of g. 0 where the Lode
   !> dependence is off; docs/theory/material.md section 3.4.
   pure real(wp) function lode_slope(par, g) result(slope)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: g

      slope = 0.0_wp
      if (par%lode) slope = par%lode_bend*g**5
   end function lode_slope

   !> Image alpha_hat [kPa] of a void ratio on the compression line, paper eq. (7) with f corrected. Void ratio
   !> and f [-]; ln alpha_hat is kept within -50 and 50; docs/theory/material.md section 3.5.
   pure real(wp) function compression_image(par, f, e) result(alpha)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: f, e

      alpha = exp(min(max(log(par%n_l*f/e)/par%lambda, -IMAGE_LIMIT), IMAGE_LIMIT))
   end function compression_image
end module mud_critical_state
