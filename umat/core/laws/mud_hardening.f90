! SPDX-License-Identifier: MIT
!> Hardening: the kinematic mechanism's modulus and the isotropic mechanism's compliance; docs/theory/material.md
!> sections 3.5, 4.2 and 4.4.
module mud_hardening
   use mud_kinds, only: wp
   use mud_bonding, only: bonding_t
   use mud_critical_state, only: critical_t, compression_image
   implicit none (type, external)
   private
   public :: hardening_t, kinematic_modulus, kinematic_slope, KINEMATIC_EXPONENT, isotropic_t, &
             isotropic_hardening, NO_HARDENING, shear_weight, isotropic_slopes_t, isotropic_slopes, BY_P, BY_E, &
             BY_F, BY_F_E, BY_R, BY_R_B

   real(wp), parameter :: SMALLEST_VOID_TERM = 0.01_wp   !< Guard: 1 - c_h e >= it [-].
   !> Below it |delta|^theta, whose slope at zero is infinite, is an odd polynomial of the same value, slope and bend
   !> there: this slope is the rate at which states approach the compression line [-].
   real(wp), parameter :: SMALLEST_DELTA = 1.0e-4_wp
   real(wp), parameter :: SMALLEST_COUPLING = 0.1_wp     !< Guard: 1 + C >= it [-].

   real(wp), parameter :: KINEMATIC_EXPONENT = -0.5_wp   !< d ln b_0/d ln p' [-].

   !> Compliance of the isotropic mechanism: d eps_v^iso = < a dp'/p' + b dp_c >.
   type :: isotropic_t
      real(wp) :: a   !< [-]
      real(wp) :: b   !< [1/kPa]
      ! on the way there, for derivatives
      real(wp) :: weight     !< w [-]
      real(wp) :: crowding   !< (p'/alpha_hat)(1 + 2 eta^2/M^2) = 1 - delta [-]
      real(wp) :: approach   !< p'/alpha_hat [-]
      real(wp) :: f          !< F(delta) [-]
      real(wp) :: f_slope    !< dF/d delta [-]
      real(wp) :: c          !< C [-]
      real(wp) :: share      !< w e/(1 + e)/(1 + C) [-]
      logical :: floored     !< 1 + C is at its guard
   end type isotropic_t
   !> The mechanism off.
   type(isotropic_t), parameter :: NO_HARDENING = isotropic_t(0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      0.0_wp, 0.0_wp, .false.)

   !> Arguments of the slopes of the mechanism: ln p', e, ln f, df/de, half of |r|^2, and ln |r| on the bounding
   !> surface.
   integer, parameter :: BY_P = 1, BY_E = 2, BY_F = 3, BY_F_E = 4, BY_R = 5, BY_R_B = 6
   !> Slopes of the compliance.
   type :: isotropic_slopes_t
      real(wp) :: a(BY_P:BY_R_B)   !< slopes of a [-]
      real(wp) :: b(BY_P:BY_R_B)   !< slopes of b [1/kPa] ...
      real(wp) :: b_f_pc           !< ... and by df/dp_c [-]
   end type isotropic_slopes_t

   !> Parameters of both mechanisms, as in mud_registry.
   type :: hardening_t
      real(wp) :: stiffness   !< h_0 G_0 [-].
      real(wp) :: c_h, theta, p_atm
   end type hardening_t
contains
   !> b_0 = h x [-], the numerator of the hardening modulus h, paper eq. (13). e [-], p' > 0 [kPa], not checked; 1 - c_h
   !> e is at least 0.01. docs/theory/material.md section 4.2.
   pure real(wp) function kinematic_modulus(par, e, p) result(b_0)
      type(hardening_t), intent(in) :: par
      real(wp), intent(in) :: e, p

      b_0 = par%stiffness*max(1.0_wp - par%c_h*e, SMALLEST_VOID_TERM)*sqrt(par%p_atm/p)
   end function kinematic_modulus

   !> d ln b_0/de [-]; 0 at the guard.
   pure real(wp) function kinematic_slope(par, e) result(slope)
      type(hardening_t), intent(in) :: par
      real(wp), intent(in) :: e

      slope = 0.0_wp
      if (1.0_wp - par%c_h*e > SMALLEST_VOID_TERM) slope = -par%c_h/(1.0_wp - par%c_h*e)
   end function kinematic_slope

   !> Isotropic hardening, paper eqs (4), (6), (7) with the second term of (4) restored as the change of f at constant e
   !> (mended): on the compression line ln e = ln N_l - lambda ln p' + ln f. docs/theory/material.md sections 3.5 and
   !> 4.4; the arguments are not checked.
   pure function isotropic_hardening(par, lines, bond, e, p, kappa, eta2, weight) result(iso)
      type(hardening_t), intent(in) :: par
      type(critical_t), intent(in) :: lines
      type(bonding_t), intent(in) :: bond
      real(wp), intent(in) :: e       !< void ratio [-]
      real(wp), intent(in) :: p       !< p' [kPa]
      real(wp), intent(in) :: kappa   !< elastic swelling slope [-]
      real(wp), intent(in) :: eta2    !< eta squared [-]
      real(wp), intent(in) :: weight  !< w, the share of the mechanism that shear leaves (rebuilt) [-]
      type(isotropic_t) :: iso
      real(wp) :: delta

      iso%weight = weight
      iso%approach = p/compression_image(lines, bond%f, e)
      iso%crowding = iso%approach*(1.0_wp + 2.0_wp*eta2/lines%m_c**2)
      delta = 1.0_wp - iso%crowding
      call signed_power(par%theta, delta, iso%f, iso%f_slope)
      iso%f = 1.0_wp - iso%f
      iso%f_slope = -iso%f_slope
      iso%c = -e*bond%df_de/bond%f*iso%f
      iso%floored = 1.0_wp + iso%c < SMALLEST_COUPLING
      iso%share = weight*e/(1.0_wp + e)/max(1.0_wp + iso%c, SMALLEST_COUPLING)
      iso%a = iso%share*((lines%lambda - kappa)*iso%f - kappa*iso%c)
      iso%b = -iso%share*iso%f*bond%df_dpc/bond%f
   end function isotropic_hardening

   !> Slopes of the isotropic mechanism where it acts. Arguments as in isotropic_hardening, r_b as in shear_weight;
   !> kappa rises as the cubic root of p'.
   pure function isotropic_slopes(lines, bond, e, kappa, r_b, iso) result(slopes)
      type(critical_t), intent(in) :: lines
      type(bonding_t), intent(in) :: bond
      real(wp), intent(in) :: e, kappa, r_b
      type(isotropic_t), intent(in) :: iso
      type(isotropic_slopes_t) :: slopes
      real(wp), dimension(BY_P:BY_R_B) :: f, c, share
      real(wp) :: bonded_e, bonded_pc

      bonded_e = bond%df_de/bond%f
      bonded_pc = bond%df_dpc/bond%f
      f = 0.0_wp
      f(BY_P) = -iso%f_slope*iso%crowding
      f(BY_E) = f(BY_P)/(lines%lambda*e)
      f(BY_F) = -f(BY_P)/lines%lambda
      f(BY_R) = -iso%f_slope*iso%approach*6.0_wp/lines%m_c**2
      c = -e*bonded_e*f
      c(BY_E) = c(BY_E) - bonded_e*iso%f
      c(BY_F) = c(BY_F) + e*bonded_e*iso%f
      c(BY_F_E) = -e*iso%f/bond%f
      share = 0.0_wp
      if (.not. iso%floored) share = -(iso%share/(1.0_wp + iso%c))*c
      share(BY_E) = share(BY_E) + iso%share*(1.0_wp/e - 1.0_wp/(1.0_wp + e))
      share(BY_R) = share(BY_R) - iso%share/iso%weight*2.0_wp/r_b**2
      share(BY_R_B) = iso%share/iso%weight*2.0_wp*(1.0_wp - iso%weight)
      slopes%a = (iso%a/iso%share)*share + iso%share*((lines%lambda - kappa)*f - kappa*c)
      slopes%a(BY_P) = slopes%a(BY_P) - iso%share*kappa*(iso%f + iso%c)/3.0_wp
      slopes%b = -bonded_pc*(iso%f*share + iso%share*f)
      slopes%b(BY_F) = slopes%b(BY_F) + bonded_pc*iso%share*iso%f
      slopes%b_f_pc = -iso%share*iso%f/bond%f
   end function isotropic_slopes

   !> w, the share of the isotropic mechanism that shear leaves (rebuilt), of |r| and of that on the bounding surface in
   !> the direction of r. All [-]; docs/theory/material.md section 4.4.
   pure real(wp) function shear_weight(r_norm, r_b) result(weight)
      real(wp), intent(in) :: r_norm, r_b

      weight = max(1.0_wp - (r_norm/r_b)**2, 0.0_wp)
   end function shear_weight

   !> sgn(delta) |delta|^theta and its slope, smooth through zero.
   pure subroutine signed_power(theta, delta, power, slope)
      real(wp), intent(in) :: theta, delta
      real(wp), intent(out) :: power, slope
      real(wp) :: u2, first, third, fifth

      slope = max(abs(delta), SMALLEST_DELTA)**(theta - 1.0_wp)
      power = slope*delta
      if (abs(delta) >= SMALLEST_DELTA) then
         slope = theta*slope
      else
         u2 = (delta/SMALLEST_DELTA)**2
         fifth = (theta - 1.0_wp)*(theta - 3.0_wp)/8.0_wp
         third = (theta - 1.0_wp)*(5.0_wp - theta)/4.0_wp
         first = 1.0_wp - third - fifth
         power = power*(first + u2*(third + u2*fifth))
         slope = slope*(first + u2*(3.0_wp*third + u2*5.0_wp*fifth))
      end if
   end subroutine signed_power
end module mud_hardening
