!> Hardening: the kinematic mechanism's modulus and the isotropic mechanism's compliance.
module mud_hardening
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_bonding, only: bonding_t
   use mud_critical_state, only: compression_image
   implicit none (type, external)
   private
   public :: kinematic_modulus, isotropic_t, isotropic_hardening

   real(wp), parameter :: SMALLEST_VOID_TERM = 0.01_wp   !< Guard: 1 - c_h e >= it [-].
   real(wp), parameter :: SMALLEST_DELTA = 1.0e-8_wp     !< Below it |delta|^theta is a straight line through zero [-].
   real(wp), parameter :: SMALLEST_COUPLING = 0.1_wp     !< Guard: 1 + C >= it [-].

   !> Compliance of the isotropic mechanism: d eps_v^iso = < a dp'/p' + b dp_c >.
   type :: isotropic_t
      real(wp) :: a   !< [-]
      real(wp) :: b   !< [1/kPa]
   end type isotropic_t
contains
   !> b_0 = h x [-], the numerator of the hardening modulus h, paper eq. (13).
   pure real(wp) function kinematic_modulus(par, e, p) result(b_0)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, p

      b_0 = par%h_0*par%g_0*max(1.0_wp - par%c_h*e, SMALLEST_VOID_TERM)*sqrt(par%p_atm/p)
   end function kinematic_modulus

   !> Isotropic hardening, paper eqs (4), (6), (7) with the second term of (4) restored as the change of f at constant e
   !> (mended): on the compression line ln e = ln N_l - lambda ln p' + ln f.
   pure function isotropic_hardening(par, bond, e, p, kappa, eta2, weight) result(iso)
      type(params_t), intent(in) :: par
      type(bonding_t), intent(in) :: bond
      real(wp), intent(in) :: e       !< void ratio [-]
      real(wp), intent(in) :: p       !< p' [kPa]
      real(wp), intent(in) :: kappa   !< elastic swelling slope [-]
      real(wp), intent(in) :: eta2    !< eta squared [-]
      real(wp), intent(in) :: weight  !< w, the share of the mechanism that shear leaves (rebuilt) [-]
      type(isotropic_t) :: iso
      real(wp) :: delta, distance, power, c, share

      delta = 1.0_wp - p/compression_image(par, bond%f, e)*(1.0_wp + 2.0_wp*eta2/par%m_c**2)
      distance = abs(delta)
      if (distance > SMALLEST_DELTA) then
         power = distance**par%theta
      else
         power = distance*SMALLEST_DELTA**(par%theta - 1.0_wp)
      end if
      power = 1.0_wp - sign(power, delta)                      ! F
      c = -e*bond%df_de/bond%f*power
      share = weight*e/(1.0_wp + e)/max(1.0_wp + c, SMALLEST_COUPLING)
      iso%a = share*((par%lambda - kappa)*power - kappa*c)
      iso%b = -share*power*bond%df_dpc/bond%f
   end function isotropic_hardening
end module mud_hardening
