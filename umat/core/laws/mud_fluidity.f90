! SPDX-License-Identifier: MIT
!> Fluidity (ours, an option): shear at a vanishing mean stress leaves a soil that shears more easily there, and neither
!> contracts nor dilates as much for it; docs/theory/material.md section 4.11.
!>
!> A_0 and b_0 are multiplied by one factor: dilation per strain falls as the modulus does, so that paths of stress
!> stay what they are and strains grow.
module mud_fluidity
   use mud_kinds, only: wp
   use mud_params, only: params_t
   implicit none (type, external)
   private
   public :: fluidity_t, NOT_FLUID, fluidity_at, growth, growth_slopes, recovery

   !> Fluidity of a point and its factors in a rate.
   type :: fluidity_t
      real(wp) :: ell      !< fluidity [-]
      real(wp) :: weight   !< w, 1 at p' = 0 and 0 above p_ell [-]
      real(wp) :: factor   !< factor on A_0 and b_0 [-]
      real(wp) :: by_p, by_ell   !< d ln factor/dp' and /d ell [1/kPa, -]
      real(wp) :: weight_by_p    !< dw/dp' [1/kPa]
   end type fluidity_t
   !> The option off, or p' above its range.
   type(fluidity_t), parameter :: NOT_FLUID = fluidity_t(0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp)
contains
   !> Fluidity, its weight and factors with their slopes, of ell >= 0 [-] at p' > 0 [kPa], not checked.
   !> docs/theory/material.md section 4.11.
   pure function fluidity_at(par, ell, p) result(fluidity)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: ell, p
      type(fluidity_t) :: fluidity
      real(wp) :: below

      below = max(1.0_wp - p/par%p_ell, 0.0_wp)
      fluidity%ell = ell
      fluidity%weight = below*below
      fluidity%weight_by_p = -2.0_wp*below/par%p_ell
      fluidity%factor = 1.0_wp/(1.0_wp + fluidity%weight*ell)
      fluidity%by_p = -fluidity%factor*ell*fluidity%weight_by_p
      fluidity%by_ell = -fluidity%factor*fluidity%weight
   end function fluidity_at

   !> Growth of the fluidity per unit of L [-]. docs/theory/material.md section 4.11.
   pure real(wp) function growth(par, fluidity)
      type(params_t), intent(in) :: par
      type(fluidity_t), intent(in) :: fluidity

      growth = par%c_ell*fluidity%weight*(1.0_wp - fluidity%ell/par%ell_max)
   end function growth

   !> Slopes of the growth of the fluidity by p' and by the fluidity [1/kPa, -].
   pure function growth_slopes(par, fluidity) result(slopes)
      type(params_t), intent(in) :: par
      type(fluidity_t), intent(in) :: fluidity
      real(wp) :: slopes(2)

      slopes = par%c_ell*[fluidity%weight_by_p*(1.0_wp - fluidity%ell/par%ell_max), -fluidity%weight/par%ell_max]
   end function growth_slopes

   !> Share of the fluidity that a volumetric strain rate takes away, per unit of time; 0 where the volume grows [-].
   !> docs/theory/material.md section 4.11.
   pure real(wp) function recovery(par, d_v)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v

      recovery = par%r_ell*max(d_v, 0.0_wp)
   end function recovery
end module mud_fluidity
