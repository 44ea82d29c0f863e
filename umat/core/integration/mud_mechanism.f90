! SPDX-License-Identifier: MIT
!> When the isotropic mechanism acts. It acts wherever it is driven, or, with its memory (an option), from the place on
!> to which compression came before: the margin u to that place along a substep, and whether it would rise;
!> docs/theory/material.md section 4.10. The events of both ends are mud_event_yield and mud_event_unload.
module mud_mechanism
   use mud_bonding, only: bonding_t, bonding
   use mud_elastic, only: bulk_modulus, swelling_slope
   use mud_increment, only: increment_t, rate_of, void_ratio_at, suction_at
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_state, only: state_t, counters_t
   use mud_substep, only: MAX_STAGES
   use mud_tensor, only: trace
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: forget_compression, begin_mechanism, mechanism_ceases, keep_compression, turns_by_resting
   public :: reaches_memory, short_of_memory, leaves_memory, drive_to_memory
   ! for the tangent
   public :: measure_t, measure, measure_at, margins_at_stages, contraction, change_of_stiffness, shear_share, DEPTH

   !> A drive this much smaller than that of the strain's length is none, and counts as loading: rounding, as in shear
   !> without a change of volume. An unloading is located where it is this far below zero [-].
   real(wp), parameter :: ROUNDING = 1.0e-10_wp
   !> A margin that a substep exceeds by less than this share of the tolerance, or a drive that leads as far below it,
   !> is not looked at [-].
   real(wp), parameter :: SMALL_MARGIN = 0.01_wp
   real(wp), parameter :: DEPTH = 0.1_wp   !< u_0, over which contraction by shear ceases to count [-].

   !> Y, whose rate the drive of the isotropic mechanism is proportional to while the soil strains elastically.
   type :: measure_t
      real(wp) :: value                !< ln(p'/p_atm) - 3 kappa/lambda - ln(f)/lambda [-]
      real(wp) :: by_p, by_e, by_pc    !< slopes by p', e, p_c [1/kPa, -, 1/kPa]
      real(wp) :: kappa                !< [-]
   end type measure_t
contains
   !> A point without a memory, or at it: whatever compresses it drives the mechanism.
   pure subroutine forget_compression(state)
      type(state_t), intent(inout) :: state

      state%margin = 0.0_wp
   end subroutine forget_compression

   !> A substep begins: below what it remembers the mechanism rests. A rate that is known is that of what it did before.
   pure subroutine begin_mechanism(par, state, inc, trial, known)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state
      type(increment_t), intent(inout) :: inc
      type(trial_t), intent(inout) :: trial
      logical, intent(inout) :: known
      logical :: rests

      if (.not. par%remembers) return
      rests = state%margin < 0.0_wp
      if (rests .neqv. inc%rests) known = .false.
      inc%rests = rests
      trial%below = state%margin
   end subroutine begin_mechanism

   !> True where the mechanism is at its memory and compression ceases, by the rate w. docs/theory/material.md section
   !> 4.10.
   pure logical function mechanism_ceases(par, inc, time, w) result(ceases)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time
      type(rate_t), intent(in) :: w

      ceases = par%remembers .and. .not. inc%rests
      if (ceases) ceases = drive_to_memory(par, inc, time, w) < 0.0_wp
   end function mechanism_ceases

   !> The state keeps what a substep h leaves of its margin.
   pure subroutine keep_compression(par, inc, trial, h, state)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      type(state_t), intent(inout) :: state

      if (inc%rests) state%margin = min(margin_after(par, inc, trial, h), 0.0_wp)
   end subroutine keep_compression

   !> True of a substep h from below the memory to beyond it.
   pure logical function reaches_memory(par, inc, trial, h)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h

      reaches_memory = inc%rests
      if (reaches_memory) reaches_memory = margin_after(par, inc, trial, h) > SMALL_MARGIN*par%tolerance
   end function reaches_memory

   !> Margin to the memory at a pseudo-time, positive below it [-].
   pure real(wp) function short_of_memory(par, inc, trial, time) result(f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time

      f = -trial%below
      if (time > trial%time) f = -margin_after(par, inc, trial, time - trial%time)
   end function short_of_memory

   !> True of a substep h at the memory that leaves it.
   pure logical function leaves_memory(par, inc, trial, h)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h

      leaves_memory = par%remembers .and. .not. (inc%rests .or. trial%closed)
      if (.not. leaves_memory) return
      associate (w => trial%w(inc%scheme%stages))
         leaves_memory = h*drive_to_memory(par, inc, trial%time + h, w) < -SMALL_MARGIN*par%tolerance
      end associate
   end function leaves_memory

   !> The measure at a bonding, a void ratio [-], a mean effective stress [kPa] and the bulk modulus there [kPa].
   pure function measure(par, bond, e, p, k) result(m)
      type(params_t), intent(in) :: par
      type(bonding_t), intent(in) :: bond
      real(wp), intent(in) :: e, p, k
      type(measure_t) :: m
      real(wp) :: per_f

      m%kappa = swelling_slope(k, e, p)
      per_f = 1.0_wp/(par%critical%lambda*bond%f)
      m%value = log(p/par%p_atm) - 3.0_wp*m%kappa/par%critical%lambda - log(bond%f)/par%critical%lambda
      m%by_p = (1.0_wp - m%kappa/par%critical%lambda)/p
      m%by_e = -per_f*bond%df_de
      m%by_pc = -per_f*bond%df_dpc
   end function measure

   !> d by_p/dp' [1/kPa2]; kappa grows as the cubic root of p'.
   pure real(wp) function change_of_stiffness(par, m, p) result(slope)
      type(params_t), intent(in) :: par
      type(measure_t), intent(in) :: m
      real(wp), intent(in) :: p

      slope = -(m%by_p + m%kappa/(3.0_wp*par%critical%lambda*p))/p
   end function change_of_stiffness

   !> exp(u/u_0): what contraction by shear counts at a margin u [-].
   pure real(wp) function shear_share(u)
      real(wp), intent(in) :: u

      shear_share = exp(min(u, 0.0_wp)/DEPTH)
   end function shear_share

   !> Rate at which the margin would rise from 0 at a pseudo-time, by the rate w there, per unit of pseudo-time [-];
   !> from 0 on the isotropic mechanism may act. Contraction by shear counts as if it did not lower p', and all of it is
   !> told by the rate without the mechanism: it does not depend on whether the mechanism acts. docs/theory/material.md
   !> section 4.10.
   pure real(wp) function drive_to_memory(par, inc, time, w) result(drive)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time
      type(rate_t), intent(in) :: w
      type(measure_t) :: m
      real(wp) :: e

      e = void_ratio_at(inc, time)
      m = measure(par, w%bond, e, w%p, w%k)
      drive = (m%by_p*w%k - m%by_e*(1.0_wp + e))*(inc%d_v + w%swell) + m%by_pc*inc%d_pc &
              + ROUNDING*abs(m%by_p)*w%k*inc%length
   end function drive_to_memory

   !> Whether the stress ratio turns at y only because the isotropic mechanism rests: so little below its memory that a
   !> compression by the radius of the elastic domain would reach it, and with the mechanism it would not turn. Noise of
   !> a host is no reversal. docs/theory/material.md section 4.10.
   pure subroutine turns_by_resting(par, inc, trial, time, y, counters, turns)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time, y(NY)
      type(counters_t), intent(inout) :: counters
      logical, intent(out) :: turns
      type(increment_t) :: acting
      type(rate_t) :: w

      turns = inc%rests
      if (turns) turns = -trial%below*trial%w(1)%p < sqrt(3.0_wp)*inc%rho*trial%w(1)%k
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
      m = measure(par, bond, e, p, bulk_modulus(par%elastic, e, p))
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
         m = measure(par, trial%w(i)%bond, e, trial%w(i)%p, trial%w(i)%k)
         if (i == 1) first = m%value
         row = (i - 1)*(i - 2)/2
         margin(i) = trial%below + m%value - first &
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
      margin = trial%below + last%value - first + h*dot_product(inc%scheme%b, rates)
   end function margin_after
end module mud_mechanism
