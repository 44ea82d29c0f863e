! SPDX-License-Identifier: MIT
!> Fluidity (ours, an option): shear at a vanishing mean stress leaves a soil that shears more easily there, and neither
!> contracts nor dilates as much for it; docs/theory/material.md section 4.11.
!>
!> A_0 and b_0 are multiplied by one factor: dilation per strain falls as the modulus does, so that paths of stress
!> stay what they are and strains grow.
module mud_fluidity
   use mud_kinds, only: wp
   use mud_params, only: fluidity_law_t
   use mud_tensor, only: DIRECTIONS
   use mud_vector, only: NY, Y_OPTIONS
   implicit none (type, external)
   private
   public :: fluidity_t, Y_FLUIDITY, fluidity_at, growth, growth_changes, recovery, recovered, recovered_changes, &
             recovery_changes

   integer, parameter :: Y_FLUIDITY = Y_OPTIONS + 2   !< fluidity [-]

   !> Fluidity of a point and its factors in a rate.
   type :: fluidity_t
      real(wp) :: ell      !< fluidity [-]
      real(wp) :: weight   !< w, 1 at p' = 0 and 0 above p_ell [-]
      real(wp) :: factor   !< factor on A_0 and b_0 [-]
      real(wp) :: by_p, by_ell   !< d ln factor/dp' and /d ell [1/kPa, -]
      real(wp) :: weight_by_p    !< dw/dp' [1/kPa]
   end type fluidity_t
contains
   !> Fluidity, its weight and factors with their slopes, of ell >= 0 [-] at p' > 0 [kPa], not checked.
   !> docs/theory/material.md section 4.11.
   pure function fluidity_at(par, ell, p) result(fluidity)
      type(fluidity_law_t), intent(in) :: par
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
      type(fluidity_law_t), intent(in) :: par
      type(fluidity_t), intent(in) :: fluidity

      growth = par%c_ell*fluidity%weight*(1.0_wp - fluidity%ell/par%ell_max)
   end function growth

   !> Changes of the rate of growth L times growth, with L, p' [kPa] and the integrated vector.
   pure function growth_changes(par, fluidity, l, dl, dp, y) result(changes)
      type(fluidity_law_t), intent(in) :: par
      type(fluidity_t), intent(in) :: fluidity
      real(wp), intent(in) :: l, dl(DIRECTIONS), dp(DIRECTIONS), y(DIRECTIONS, NY)
      real(wp) :: changes(DIRECTIONS), slopes(2)

      slopes = par%c_ell*[fluidity%weight_by_p*(1.0_wp - fluidity%ell/par%ell_max), -fluidity%weight/par%ell_max]
      changes = growth(par, fluidity)*dl + l*(slopes(1)*dp + slopes(2)*y(:, Y_FLUIDITY))
   end function growth_changes

   !> Share of the fluidity that a volumetric strain rate takes away, per unit of time; 0 where the volume grows [-].
   !> docs/theory/material.md section 4.11.
   pure real(wp) function recovery(par, d_v)
      type(fluidity_law_t), intent(in) :: par
      real(wp), intent(in) :: d_v

      recovery = par%r_ell*max(d_v, 0.0_wp)
   end function recovery

   !> Changes of the rate at which a volumetric strain rate d_v takes fluidity away, of ell, with the integrated vector
   !> and d_v.
   pure function recovery_changes(par, d_v, ell, y, dv) result(changes)
      type(fluidity_law_t), intent(in) :: par
      real(wp), intent(in) :: d_v, ell, y(DIRECTIONS, NY), dv(DIRECTIONS)
      real(wp) :: changes(DIRECTIONS)

      changes = 0.0_wp
      if (d_v > 0.0_wp) changes = recovery(par, d_v)*y(:, Y_FLUIDITY) + (par%r_ell*ell)*dv
   end function recovery_changes

   !> Fluidity that is left after a share h of a volumetric strain d_v without shear [-].
   pure real(wp) function recovered(par, d_v, h, ell)
      type(fluidity_law_t), intent(in) :: par
      real(wp), intent(in) :: d_v, h, ell

      recovered = ell*exp(-h*recovery(par, d_v))
   end function recovered

   !> Changes of that with the integrated vector, with h and d_v [-].
   pure function recovered_changes(par, d_v, h, ell, y, dh, dv) result(changes)
      type(fluidity_law_t), intent(in) :: par
      real(wp), intent(in) :: d_v, h, ell, y(DIRECTIONS, NY), dh(DIRECTIONS), dv(DIRECTIONS)
      real(wp) :: changes(DIRECTIONS)

      changes = exp(-h*recovery(par, d_v))*(y(:, Y_FLUIDITY) - (ell*recovery(par, d_v))*dh)
      if (d_v > 0.0_wp) changes = changes - (ell*h*par%r_ell*exp(-h*recovery(par, d_v)))*dv
   end function recovered_changes
end module mud_fluidity
