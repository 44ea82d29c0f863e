!> Bonding: how far suction shifts the critical state line and the compression line.
module mud_bonding
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_retention, only: saturation_t, saturation
   implicit none (type, external)
   private
   public :: bonding_t, bonding, UNBONDED

   !> The factor f(zeta) and its slopes.
   type :: bonding_t
      real(wp) :: f        !< f(zeta) [-]
      real(wp) :: df_dpc   !< df/dp_c at constant e [1/kPa]
      real(wp) :: df_de    !< df/de at constant p_c [-]
   end type bonding_t

   type(bonding_t), parameter :: UNBONDED = bonding_t(1.0_wp, 0.0_wp, 0.0_wp)   !< Saturated, or the effect off.
contains
   !> f(zeta) at a suction [kPa] and a void ratio [-]: paper eq. (1) for zeta, eq. (5) restored for f (mended;
   !> Gallipoli et al. 2003), so that f(0) = 1.
   pure function bonding(par, p_c, e) result(bond)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      type(bonding_t) :: bond
      type(saturation_t) :: sat
      real(wp) :: t, divisor, force, dforce, zeta, growth, slope

      sat = saturation(par, p_c, e)
      t = max(p_c, 0.0_wp)/par%p_atm
      divisor = 10.7_wp + 2.4_wp*t
      force = 1.0_wp + t/divisor
      dforce = merge(10.7_wp/(divisor*divisor*par%p_atm), 0.0_wp, p_c > 0.0_wp)
      zeta = (1.0_wp - sat%s_w)*force
      growth = exp(par%b_2*zeta)
      slope = par%b_1*par%b_2*growth
      bond%f = 1.0_wp - par%b_1*(1.0_wp - growth)
      bond%df_dpc = slope*((1.0_wp - sat%s_w)*dforce - sat%ds_dpc*force)
      bond%df_de = -slope*sat%ds_de*force
   end function bonding
end module mud_bonding
