! SPDX-License-Identifier: MIT
!> Isotropic memory along a substep: the margin u to where compression was before, and whether it would rise;
!> docs/theory/material.md section 4.10.
module mud_isotropic_memory
   use mud_bonding, only: bonding_t, bonding
   use mud_elastic, only: bulk_modulus
   use mud_increment, only: increment_t, rate_of, void_ratio_at, suction_at
   use mud_kinds, only: wp
   use mud_margin, only: measure_t, measure, shear_share
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_state, only: counters_t
   use mud_substep, only: MAX_STAGES
   use mud_tensor, only: trace
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: drive_of_margin, turns_by_resting, margin_after, margins_at_stages, measure_at, contraction

   !> A drive this much smaller than that of the strain's length is none, and counts as loading: rounding, as in shear
   !> without a change of volume. An unloading is located where it is this far below zero [-].
   real(wp), parameter :: ROUNDING = 1.0e-10_wp
contains
   !> Rate at which the margin would rise from 0 at a pseudo-time, by the rate w there, per unit of pseudo-time [-];
   !> from 0 on the isotropic mechanism may act. Contraction by shear counts as if it did not lower p', and all of it is
   !> told by the rate without the mechanism: it does not depend on whether the mechanism acts. docs/theory/material.md
   !> section 4.10.
   pure real(wp) function drive_of_margin(par, inc, time, w) result(drive)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time
      type(rate_t), intent(in) :: w
      type(measure_t) :: m
      real(wp) :: e

      e = void_ratio_at(inc, time)
      m = measure(par%margin, w%bond, e, w%p, w%k)
      drive = (m%by_p*w%k - m%by_e*(1.0_wp + e))*(inc%d_v + w%swell) + m%by_pc*inc%d_pc &
              + ROUNDING*abs(m%by_p)*w%k*inc%length
   end function drive_of_margin

   !> Whether the stress ratio turns at y only because the isotropic mechanism rests: so little below its memory that a
   !> compression by the radius of the elastic domain would reach it, and with the mechanism it would not turn. Noise of
   !> a host is no reversal. docs/theory/material.md section 4.10.
   pure subroutine turns_by_resting(par, inc, trial, time, y, margin, counters, turns)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time, y(NY), margin
      type(counters_t), intent(inout) :: counters
      logical, intent(out) :: turns
      type(increment_t) :: acting
      type(rate_t) :: w

      turns = inc%rests
      if (turns) turns = -margin*trial%w(1)%p < sqrt(3.0_wp)*inc%rho*trial%w(1)%k
      if (.not. turns) return
      acting = inc
      acting%rests = .false.
      w = trial%w(1)
      call rate_of(par, acting, time, y, trial%r_in, trial%mode, w, counters)
      turns = w%x >= -par%x_rev
   end subroutine turns_by_resting

   !> Rate at which contraction by shear, or dilation, changes the margin at the virgin state, beside the measure [-].
   pure real(wp) function contraction(m, w, e) result(rate)
      type(measure_t), intent(in) :: m
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: e

      rate = m%by_p*w%k*max(w%l*w%d, 0.0_wp) - m%by_e*(1.0_wp + e)*max(-w%l*w%d, 0.0_wp)
   end function contraction

   !> The measure at a pseudo-time and a stress [kPa].
   pure function measure_at(par, inc, time, sigma) result(m)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, sigma(6)
      type(measure_t) :: m
      type(bonding_t) :: bond
      real(wp) :: e, p

      e = void_ratio_at(inc, time)
      p = max(trace(sigma)/3.0_wp, par%p_min)
      bond = bonding(inc%suction, suction_at(inc, time), e)
      m = measure(par%margin, bond, e, p, bulk_modulus(par%elastic, e, p))
   end function measure_at

   !> Margins at the stages of a substep h below the memory [-], and at what rates contraction adds to them. What it
   !> adds is integrated with the scheme, the measure is a function of the state.
   pure subroutine margins_at_stages(par, inc, trial, h, margin, rates, first)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      !> Margin and its rates at the stages; entries beyond them have no meaning.
      real(wp), intent(out) :: margin(MAX_STAGES), rates(MAX_STAGES)
      real(wp), intent(out) :: first   !< The measure where the substep begins [-].
      type(measure_t) :: m
      real(wp) :: e
      integer :: i, row

      margin = 0.0_wp
      rates = 0.0_wp
      first = 0.0_wp
      do i = 1, merge(1, inc%scheme%stages, trial%closed)
         e = void_ratio_at(inc, trial%time + inc%scheme%node(i)*h)
         m = measure(par%margin, trial%w(i)%bond, e, trial%w(i)%p, trial%w(i)%k)
         if (i == 1) first = m%value
         row = (i - 1)*(i - 2)/2
         margin(i) = trial%margin + m%value - first &
                     + h*dot_product(inc%scheme%a(row + 1:row + i - 1), rates(1:i - 1))
         rates(i) = shear_share(margin(i))*contraction(m, trial%w(i), e)
      end do
   end subroutine margins_at_stages

   !> The margin after a substep h below the memory, above 0 where it has been reached [-].
   !> docs/theory/material.md section 4.10.
   pure real(wp) function margin_after(par, inc, trial, h) result(margin)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      type(measure_t) :: last
      real(wp), dimension(MAX_STAGES) :: margins, rates
      real(wp) :: first

      call margins_at_stages(par, inc, trial, h, margins, rates, first)
      last = measure_at(par, inc, trial%time + h, trial%y(1:6))
      margin = trial%margin + last%value - first + h*dot_product(inc%scheme%b, rates)
   end function margin_after
end module mud_isotropic_memory
