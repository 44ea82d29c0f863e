! SPDX-License-Identifier: MIT
!> State parameter and distance of a stress ratio from the bounding surface, with their changes.
module mud_bounding
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_bonding, only: bonding_t, bonding, bonding_with_offset, UNBONDED
   use mud_critical_state, only: critical_void_ratio, bounding_ratio, lode_slope, lode_factor
   use mud_rates, only: bounding_norm
   use mud_tensor, only: ddot, norm, square
   implicit none (type, external)
   private
   public :: state_parameter, change_of_state_parameter, change_of_bounding_ratio, excess, change_of_excess, limited, &
             change_of_limited
contains
   !> State parameter psi = e - e_c [-]. Been & Jefferies (1985), e_c of paper eq. (8); docs/theory/material.md section
   !> 3.2. Without `bonded` f is 1.
   pure real(wp) function state_parameter(par, bonded, e, p_c, p) result(psi)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      real(wp), intent(in) :: e, p_c, p   !< [-, kPa, kPa]

      psi = e - critical_void_ratio(par, factor_of(par, bonded, p_c, e), p)
   end function state_parameter

   !> Change of psi with void ratio, suction and mean stress, and with a scanning curve, q ln of its offset [-]. At e
   !> [-], p_c and p [kPa], for their changes de [-], dp_c and dp [kPa], d_offset [-]; derivative of
   !> docs/theory/material.md sections 2.1.1 and 3.2.
   pure real(wp) function change_of_state_parameter(par, bonded, e, p_c, p, de, dp_c, dp, d_offset) result(change)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      real(wp), intent(in) :: e, p_c, p, de, dp_c, dp
      real(wp), intent(in), optional :: d_offset
      type(bonding_t) :: bond
      real(wp) :: df, with_offset(3)

      bond = UNBONDED
      if (bonded) bond = bonding(par, p_c, e)
      df = bond%df_de*de + bond%df_dpc*dp_c
      if (bonded .and. par%scanning%between .and. present(d_offset)) then
         with_offset = bonding_with_offset(par, bond, p_c, e)
         df = df + with_offset(1)*d_offset
      end if
      change = de - critical_void_ratio(par, bond%f, p)*(df/bond%f - par%lambda*dp/(p + par%alpha_csl))
   end function change_of_state_parameter

   pure real(wp) function factor_of(par, bonded, p_c, e) result(f)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      real(wp), intent(in) :: p_c, e
      type(bonding_t) :: bond

      bond = UNBONDED
      if (bonded) bond = bonding(par, p_c, e)
      f = bond%f
   end function factor_of

   !> Change of M^b with psi [-]. m_b is that of psi, dpsi the change of psi [-]. Derivative of paper eq. (12), 0 for
   !> psi >= 0; the bound of the exponent is left out.
   pure real(wp) function change_of_bounding_ratio(par, psi, m_b, dpsi) result(change)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, m_b, dpsi

      change = merge(-par%n_b*m_b*dpsi, 0.0_wp, psi < 0.0_wp)
   end function change_of_bounding_ratio

   !> |r| over the norm of the bounding surface in its direction, minus 1 [-]. psi and r [-]; docs/theory/material.md
   !> section 3.3. -1 for r = 0.
   pure real(wp) function excess(par, psi, r)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6)
      real(wp) :: r_norm

      r_norm = norm(r)
      excess = r_norm/bounding_norm(par, r, r_norm, bounding_ratio(par, psi)) - 1.0_wp
   end function excess

   !> Its change with psi and r [-]. 0 for r = 0; derivative of docs/theory/material.md sections 3.3 and 3.4.
   pure real(wp) function change_of_excess(par, psi, r, dpsi, dr) result(change)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6), dpsi, dr(6)
      real(wp) :: r_norm, m_b, limit

      change = 0.0_wp
      r_norm = norm(r)
      if (r_norm <= 0.0_wp) return
      m_b = bounding_ratio(par, psi)
      limit = bounding_norm(par, r, r_norm, m_b)
      change = (ddot(r, dr)/r_norm &
                - r_norm/limit*change_of_limit(par, psi, m_b, r/r_norm, r_norm, dpsi, dr))/limit
   end function change_of_excess

   !> Change of the norm of the bounding surface in the direction u = r/|r| [-].
   pure real(wp) function change_of_limit(par, psi, m_b, u, r_norm, dpsi, dr) result(change)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, m_b, u(6), r_norm, dpsi, dr(6)
      real(wp) :: u2(6), g, turn(6)

      change = SQRT_2_3*change_of_bounding_ratio(par, psi, m_b, dpsi)
      if (.not. par%lode) return
      u2 = square(u)
      g = lode_factor(par, ddot(u2, u))
      turn = (dr - ddot(u, dr)*u)/r_norm
      change = g*change + SQRT_2_3*(m_b*lode_slope(par, g)*3.0_wp*ddot(u2, turn))
   end function change_of_limit

   !> A stress ratio, shortened to the bounding surface where it is beyond. psi, r and the result [-];
   !> docs/theory/material.md section 6.2.
   pure function limited(par, psi, r) result(r_limited)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6)
      real(wp) :: r_limited(6), beyond

      r_limited = r
      if (norm(r) <= 0.0_wp) return
      beyond = excess(par, psi, r)
      if (beyond > 0.0_wp) r_limited = r/(1.0_wp + beyond)
   end function limited

   !> Change of a stress ratio that is held on the bounding surface. psi, r, their changes and the result [-]; r is on
   !> the surface or beyond, which is not checked.
   pure function change_of_limited(par, psi, r, dpsi, dr) result(change)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: psi, r(6), dpsi, dr(6)
      real(wp) :: change(6), beyond

      beyond = excess(par, psi, r)
      change = (dr - (change_of_excess(par, psi, r, dpsi, dr)/(1.0_wp + beyond))*r)/(1.0_wp + beyond)
   end function change_of_limited
end module mud_bounding
