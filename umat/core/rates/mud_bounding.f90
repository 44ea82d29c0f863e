! SPDX-License-Identifier: MIT
!> Excess of a state over the bounding surface, for events and the tension cut-off.
module mud_bounding
   use mud_kinds, only: wp
   use mud_bonding, only: suction_law_t, bonding_t, bonding
   use mud_critical_state, only: critical_t, state_parameter, bounding_ratio, bounding_norm
   use mud_tensor, only: norm
   implicit none (type, external)
   private
   public :: psi_of, excess, limited
contains
   !> State parameter of a state [-]. docs/theory/material.md section 3.2.
   pure real(wp) function psi_of(par, law, e, p_c, p) result(psi)
      type(critical_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      real(wp), intent(in) :: e, p_c, p   !< [-, kPa, kPa]
      type(bonding_t) :: bond

      bond = bonding(law, p_c, e)
      psi = state_parameter(par, bond%f, e, p)
   end function psi_of

   !> |r| over the norm of the bounding surface in its direction, minus 1 [-]. psi and r [-]; docs/theory/material.md
   !> section 3.3. -1 for r = 0.
   pure real(wp) function excess(par, psi, r)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6)
      real(wp) :: r_norm

      r_norm = norm(r)
      excess = r_norm/bounding_norm(par, r, r_norm, bounding_ratio(par, psi)) - 1.0_wp
   end function excess

   !> A stress ratio, shortened to the bounding surface where it is beyond. psi, r and the result [-];
   !> docs/theory/material.md section 6.2.
   pure function limited(par, psi, r) result(r_limited)
      type(critical_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6)
      real(wp) :: r_limited(6), beyond

      r_limited = r
      if (norm(r) <= 0.0_wp) return
      beyond = excess(par, psi, r)
      if (beyond > 0.0_wp) r_limited = r/(1.0_wp + beyond)
   end function limited
end module mud_bounding
