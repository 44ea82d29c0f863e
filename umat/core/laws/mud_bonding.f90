!> Bonding: how far suction shifts the critical state line and the compression line.
!> docs/theory/material.md section 2.2.
module mud_bonding
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_retention, only: saturation_t, saturation, saturation_curvature
   implicit none (type, external)
   private
   public :: bonding_t, is_bonded, bonding, bonding_curvature, UNBONDED

   !> The factor f(zeta) and its slopes.
   type :: bonding_t
      real(wp) :: f        !< f(zeta) [-]
      real(wp) :: df_dpc   !< df/dp_c at constant e [1/kPa]
      real(wp) :: df_de    !< df/de at constant p_c [-]
   end type bonding_t

   type(bonding_t), parameter :: UNBONDED = bonding_t(1.0_wp, 0.0_wp, 0.0_wp)   !< Saturated, or the effect off.
   real(wp), parameter :: FORCE_A = 10.7_wp, FORCE_B = 2.4_wp   !< g = 1 + t/(A + B t), Borja (2004).
contains
   !> True if bonding acts at suctions up to p_c [kPa]: with S_max < 1 it does so without suction too.
   pure logical function is_bonded(par, p_c)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c

      is_bonded = par%bonding .and. (p_c > 0.0_wp .or. par%s_max < 1.0_wp)
   end function is_bonded

   !> f(zeta) at a suction [kPa] and a void ratio [-]: paper eq. (1) for zeta, eq. (5) restored for f (mended; Gallipoli
   !> et al. 2003), so that f(0) = 1.
   pure function bonding(par, p_c, e) result(bond)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      type(bonding_t) :: bond
      type(saturation_t) :: sat
      real(wp) :: force(0:2), zeta, growth, slope

      sat = saturation(par, p_c, e)
      force = meniscus_force(par, p_c)
      zeta = (1.0_wp - sat%s_w)*force(0)
      growth = exp(par%b_2*zeta)
      slope = par%b_1*par%b_2*growth
      bond%f = 1.0_wp - par%b_1*(1.0_wp - growth)
      bond%df_dpc = slope*((1.0_wp - sat%s_w)*force(1) - sat%ds_dpc*force(0))
      bond%df_de = -slope*sat%ds_de*force(0)
   end function bonding

   !> Second derivatives [d2f/dp_c2 (1/kPa2), d2f/dp_c de (1/kPa), d2f/de2 (-)].
   pure function bonding_curvature(par, p_c, e) result(curvature)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      real(wp) :: curvature(3), force(0:2), slope, zeta_pc, zeta_e, s(3)
      type(saturation_t) :: sat

      sat = saturation(par, p_c, e)
      s = saturation_curvature(par, sat, p_c, e)
      force = meniscus_force(par, p_c)
      slope = par%b_1*par%b_2*exp(par%b_2*(1.0_wp - sat%s_w)*force(0))
      zeta_pc = (1.0_wp - sat%s_w)*force(1) - sat%ds_dpc*force(0)
      zeta_e = -sat%ds_de*force(0)
      curvature(1) = (1.0_wp - sat%s_w)*force(2) - 2.0_wp*sat%ds_dpc*force(1) - s(1)*force(0)
      curvature(2) = -sat%ds_de*force(1) - s(2)*force(0)
      curvature(3) = -s(3)*force(0)
      curvature = slope*(curvature + par%b_2*[zeta_pc**2, zeta_pc*zeta_e, zeta_e**2])
   end function bonding_curvature

   !> g of paper eq. (1) and its first two derivatives with respect to suction [-, 1/kPa, 1/kPa2].
   pure function meniscus_force(par, p_c) result(force)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c
      real(wp) :: force(0:2), t, divisor

      force = [1.0_wp, 0.0_wp, 0.0_wp]
      if (p_c <= 0.0_wp) return
      t = p_c/par%p_atm
      divisor = FORCE_A + FORCE_B*t
      force(0) = 1.0_wp + t/divisor
      force(1) = FORCE_A/(divisor**2*par%p_atm)
      force(2) = -2.0_wp*FORCE_B*force(1)/(divisor*par%p_atm)
   end function meniscus_force
end module mud_bonding
