! SPDX-License-Identifier: MIT
!> Bonding: how far suction shifts the critical state line and the compression line.
!> docs/theory/material.md section 2.2.
module mud_bonding
   use mud_kinds, only: wp
   use mud_retention, only: retention_t, saturation_t, saturation, saturation_curvature, change_with_turn
   implicit none (type, external)
   private
   public :: suction_law_t, bonding_t, is_bonded, bonding, bonding_at, bonding_factor, bonding_curvature, &
             bonding_with_turn, UNBONDED

   !> The effects of suction on the soil, saturation and bonding.
   type, extends(retention_t) :: suction_law_t
      logical :: bonds             !< Bonding is on; in a phase of an increment: acts there.
      real(wp) :: b_1, b_2, p_atm
   end type suction_law_t

   !> The factor f(zeta) and its slopes.
   type :: bonding_t
      real(wp) :: f        !< f(zeta) [-]
      real(wp) :: df_dpc   !< df/dp_c at constant e [1/kPa]
      real(wp) :: df_de    !< df/de at constant p_c [-]
      ! on the way there, for the curvature
      type(saturation_t) :: sat            !< degree of saturation and its slopes
      real(wp) :: force_0, force_1, force_2   !< g of paper eq. (1) and its derivatives [-, 1/kPa, 1/kPa2]
      real(wp) :: slope                    !< df/d zeta [-]
   end type bonding_t

   !> Saturated, or the effect off.
   type(bonding_t), parameter :: UNBONDED = bonding_t(1.0_wp, 0.0_wp, 0.0_wp, &
      saturation_t(1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp), 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp)
   real(wp), parameter :: FORCE_A = 10.7_wp, FORCE_B = 2.4_wp   !< g = 1 + t/(A + B t), Borja (2004).
contains
   !> True if bonding acts at suctions up to p_c [kPa]: with S_max < 1 it does so without suction too.
   !> docs/theory/material.md section 2.2.
   pure logical function is_bonded(self, p_c)
      type(suction_law_t), intent(in) :: self
      real(wp), intent(in) :: p_c

      is_bonded = self%bonds .and. (p_c > 0.0_wp .or. self%s_max < 1.0_wp)
   end function is_bonded

   !> f(zeta) at a suction [kPa] and a void ratio [-]: paper eq. (1) for zeta, eq. (5) restored for f (mended; Gallipoli
   !> et al. 2003), so that f(0) = 1. e > 0 is not checked; without suction the force of the menisci is 1. UNBONDED
   !> where the law does not bond.
   pure function bonding(self, p_c, e) result(bond)
      type(suction_law_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(bonding_t) :: bond

      bond = UNBONDED
      if (self%bonds) bond = bonding_at(self, saturation(self%retention_t, p_c, e), p_c)
   end function bonding

   !> Bonding where it acts, at a suction [kPa] and the saturation that belongs to it.
   pure function bonding_at(self, sat, p_c) result(bond)
      type(suction_law_t), intent(in) :: self
      type(saturation_t), intent(in) :: sat
      real(wp), intent(in) :: p_c
      type(bonding_t) :: bond
      real(wp) :: force(0:2), zeta, growth

      bond%sat = sat
      force = meniscus_force(self, p_c)
      zeta = (1.0_wp - bond%sat%s_w)*force(0)
      growth = exp(self%b_2*zeta)
      bond%slope = self%b_1*self%b_2*growth
      bond%f = 1.0_wp - self%b_1*(1.0_wp - growth)
      bond%df_dpc = bond%slope*((1.0_wp - bond%sat%s_w)*force(1) - bond%sat%ds_dpc*force(0))
      bond%df_de = -bond%slope*bond%sat%ds_de*force(0)
      bond%force_0 = force(0)
      bond%force_1 = force(1)
      bond%force_2 = force(2)
   end function bonding_at

   !> f(zeta) at a suction [kPa] and a degree of saturation [-], whichever branch led to it; 1 where bonding does not
   !> act. docs/theory/material.md section 2.2.
   pure real(wp) function bonding_factor(self, p_c, s_w) result(f)
      type(suction_law_t), intent(in) :: self
      real(wp), intent(in) :: p_c, s_w
      real(wp) :: force(0:2)

      f = 1.0_wp
      if (.not. is_bonded(self, p_c)) return
      force = meniscus_force(self, p_c)
      f = 1.0_wp - self%b_1*(1.0_wp - exp(self%b_2*(1.0_wp - s_w)*force(0)))
   end function bonding_factor

   !> Second derivatives [d2f/dp_c2 (1/kPa2), d2f/dp_c de (1/kPa), d2f/de2 (-)] at the suction and void ratio of bond.
   !> Derivatives of docs/theory/material.md sections 2.1 and 2.2; bond is that of p_c [kPa] and e [-].
   pure function bonding_curvature(self, bond, p_c, e) result(curvature)
      type(suction_law_t), intent(in) :: self
      type(bonding_t), intent(in) :: bond
      real(wp), intent(in) :: p_c, e
      real(wp) :: curvature(3), zeta_pc, zeta_e, s(3)

      s = saturation_curvature(self%retention_t, bond%sat, p_c, e)
      zeta_pc = (1.0_wp - bond%sat%s_w)*bond%force_1 - bond%sat%ds_dpc*bond%force_0
      zeta_e = -bond%sat%ds_de*bond%force_0
      curvature(1) = (1.0_wp - bond%sat%s_w)*bond%force_2 - 2.0_wp*bond%sat%ds_dpc*bond%force_1 - s(1)*bond%force_0
      curvature(2) = -bond%sat%ds_de*bond%force_1 - s(2)*bond%force_0
      curvature(3) = -s(3)*bond%force_0
      curvature = bond%slope*(curvature + self%b_2*[zeta_pc**2, zeta_pc*zeta_e, zeta_e**2])
   end function bonding_curvature

   !> Derivatives [df (-), d2f/dp_c (1/kPa), d2f/de (-)] with respect to ln x of the turn where a branch begins, at the
   !> suction and void ratio of bond. Zeros where it does not move; bond is that of p_c [kPa] and e [-].
   !> docs/theory/material.md sections 2.1.1 and 2.2.
   pure function bonding_with_turn(self, bond, p_c, e) result(change)
      type(suction_law_t), intent(in) :: self
      type(bonding_t), intent(in) :: bond
      real(wp), intent(in) :: p_c, e
      real(wp) :: change(3), s(3), zeta(3), zeta_pc, zeta_e

      s = change_with_turn(self%retention_t, p_c, e)
      zeta_pc = (1.0_wp - bond%sat%s_w)*bond%force_1 - bond%sat%ds_dpc*bond%force_0
      zeta_e = -bond%sat%ds_de*bond%force_0
      zeta = -s*bond%force_0
      zeta(2) = zeta(2) - s(1)*bond%force_1
      change = bond%slope*(zeta + self%b_2*zeta(1)*[0.0_wp, zeta_pc, zeta_e])
   end function bonding_with_turn

   !> g of paper eq. (1) and its first two derivatives with respect to suction [-, 1/kPa, 1/kPa2].
   pure function meniscus_force(self, p_c) result(force)
      type(suction_law_t), intent(in) :: self
      real(wp), intent(in) :: p_c
      real(wp) :: force(0:2), t, divisor

      force = [1.0_wp, 0.0_wp, 0.0_wp]
      if (p_c <= 0.0_wp) return
      t = p_c/self%p_atm
      divisor = FORCE_A + FORCE_B*t
      force(0) = 1.0_wp + t/divisor
      force(1) = FORCE_A/(divisor**2*self%p_atm)
      force(2) = -2.0_wp*FORCE_B*force(1)/(divisor*self%p_atm)
   end function meniscus_force
end module mud_bonding
