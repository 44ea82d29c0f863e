! SPDX-License-Identifier: MIT
!> Changes of the excess of a state over the bounding surface; derivatives of docs/theory/material.md sections 3.2 to
!> 3.4.
module mud_bounding_changes
   use mud_bonding, only: suction_law_t, bonding_t, bonding, bonding_with_turn
   use mud_bounding, only: excess
   use mud_critical_state, only: state_parameter, state_parameter_slopes, bounding_ratio, bounding_slope, lode_gradient
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_retention, only: moves_with_turn
   use mud_tensor, only: ddot, norm
   implicit none (type, external)
   private
   public :: change_of_psi, change_of_excess, change_of_limited
contains
   !> Change of the state parameter with void ratio, suction and mean stress, and with ln x of the turn of a branch [-].
   !> At e [-], p_c and p [kPa], for their changes de [-], dp_c and dp [kPa], d_turn [-]; derivative of
   !> docs/theory/material.md sections 2.1.1 and 3.2.
   pure real(wp) function change_of_psi(par, law, e, p_c, p, de, dp_c, dp, d_turn) result(change)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      real(wp), intent(in) :: e, p_c, p, de, dp_c, dp
      real(wp), intent(in), optional :: d_turn
      type(bonding_t) :: bond
      real(wp) :: df, with_turn(3), by_f, by_p

      bond = bonding(law, p_c, e)
      df = bond%df_de*de + bond%df_dpc*dp_c
      if (law%bonds .and. moves_with_turn(law%retention_t) .and. present(d_turn)) then
         with_turn = bonding_with_turn(law, bond, p_c, e)
         df = df + with_turn(1)*d_turn
      end if
      call state_parameter_slopes(par%critical, state_parameter(par%critical, bond%f, e, p), bond%f, e, p, by_f, by_p)
      change = de + by_f*df + by_p*dp
   end function change_of_psi

   !> Change of the excess over the bounding surface with psi and r [-]. 0 for r = 0; derivative of
   !> docs/theory/material.md sections 3.3 and 3.4.
   pure real(wp) function change_of_excess(par, psi, r, dpsi, dr) result(change)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6), dpsi, dr(6)
      real(wp) :: r_norm, m_b, limit, d_limit, g, g_r(6)

      change = 0.0_wp
      r_norm = norm(r)
      if (r_norm <= 0.0_wp) return
      m_b = bounding_ratio(par%critical, psi)
      call lode_gradient(par%critical, r, r_norm, g, g_r)
      limit = SQRT_2_3*g*m_b
      d_limit = SQRT_2_3*(g*bounding_slope(par%critical, psi, m_b)*dpsi + m_b*ddot(g_r, dr))
      change = (ddot(r, dr)/r_norm - r_norm/limit*d_limit)/limit
   end function change_of_excess

   !> Change of a stress ratio that is held on the bounding surface. psi, r, their changes and the result [-]; r is on
   !> the surface or beyond, which is not checked.
   pure function change_of_limited(par, psi, r, dpsi, dr) result(change)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6), dpsi, dr(6)
      real(wp) :: change(6), beyond

      beyond = excess(par%critical, psi, r)
      change = (dr - (change_of_excess(par, psi, r, dpsi, dr)/(1.0_wp + beyond))*r)/(1.0_wp + beyond)
   end function change_of_limited
end module mud_bounding_changes
