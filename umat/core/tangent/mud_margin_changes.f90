! SPDX-License-Identifier: MIT
!> Derivatives of the margin of the isotropic memory; derivatives of docs/theory/material.md section 4.10.
module mud_margin_changes
   use mud_bonding, only: bonding_t, bonding, bonding_curvature, bonding_with_turn
   use mud_elastic, only: bulk_slope, BULK_EXPONENT
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_isotropic_memory, only: measure_at, contraction
   use mud_kinds, only: wp
   use mud_margin, only: measure_t, measure, change_of_stiffness, shear_share, DEPTH
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: p_follows
   use mud_tensor, only: LANES
   implicit none (type, external)
   private
   public :: changes_of_measure, changes_by_shear
contains
   !> Changes of the measure where stress, void ratio and suction change by y(:, 1:3) [kPa], de [-] and dp_c [kPa], and
   !> a branch of S_w by its turn.
   pure function changes_of_measure(par, inc, time, sigma, y, de, dp_c, scans, turn) result(change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, sigma(6), y(LANES, 3), de(LANES), dp_c(LANES)
      logical, intent(in) :: scans
      real(wp), intent(in) :: turn(LANES)   !< Read where it scans.
      real(wp) :: change(LANES), with_turn(3), e, p_c
      type(measure_t) :: m
      type(bonding_t) :: bond

      m = measure_at(par, inc, time, sigma)
      change = m%by_e*de + m%by_pc*dp_c
      if (p_follows(par, sigma)) change = change + (m%by_p/3.0_wp)*(y(:, 1) + y(:, 2) + y(:, 3))
      if (.not. (inc%suction%bonds .and. scans)) return
      e = void_ratio_at(inc, time)
      p_c = suction_at(inc, time)
      bond = bonding(inc%suction, p_c, e)
      with_turn = bonding_with_turn(inc%suction, bond, p_c, e)
      change = change - (with_turn(1)/(par%critical%lambda*bond%f))*turn
   end function changes_of_measure

   !> Changes of the rate at which contraction adds to the margin, at a stage with rate w and a margin that changes by
   !> du, from the changes of stress, of void ratio and suction, of the rate of stress and of the volume.
   pure function changes_by_shear(par, inc, time, w, margin, du, y, de, dp_c, rates, d_v) result(change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, margin
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: du(LANES), y(LANES, 3), de(LANES), dp_c(LANES), rates(LANES, 3), d_v(LANES)
      real(wp), dimension(LANES) :: change, dp, dk, flow, df, df_e
      type(measure_t) :: m
      real(wp) :: e, curvature(3), on_flow

      e = void_ratio_at(inc, time)
      m = measure(par%margin, w%bond, e, w%p, w%k)
      dp = (y(:, 1) + y(:, 2) + y(:, 3))/3.0_wp
      if (w%p <= par%p_min) dp = 0.0_wp
      dk = w%k*(BULK_EXPONENT/w%p*dp + bulk_slope(e)*de)
      flow = inc%d_v*dk + w%k*d_v - (rates(:, 1) + rates(:, 2) + rates(:, 3))/3.0_wp   ! of K L D
      on_flow = w%l*w%d
      if (on_flow > 0.0_wp) then
         change = m%by_p*flow + (change_of_stiffness(par%margin, m, w%p)*w%k*on_flow)*dp
      else
         change = m%by_e*(1.0_wp + e)/w%k*(flow - on_flow*dk) + (m%by_e*on_flow)*de
         if (inc%suction%bonds) then
            curvature = bonding_curvature(inc%suction, w%bond, suction_at(inc, time), e)
            df = w%bond%df_de*de + w%bond%df_dpc*dp_c
            df_e = curvature(3)*de + curvature(2)*dp_c
            change = change - ((1.0_wp + e)*on_flow/(par%critical%lambda*w%bond%f))*(df_e - (w%bond%df_de/w%bond%f)*df)
         end if
      end if
      change = shear_share(margin)*(change + (contraction(m, w, e)/DEPTH)*du)
   end function changes_by_shear
end module mud_margin_changes
