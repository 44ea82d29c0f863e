! SPDX-License-Identifier: MIT
!> Derivatives of what lacks to the memory of the isotropic mechanism where that rests; derivatives of
!> docs/theory/material.md section 4.10.
module mud_mechanism_changes
   use mud_bonding, only: bonding_t, bonding, bonding_curvature, bonding_with_turn
   use mud_driving, only: driving_t, change_of_place
   use mud_elastic, only: bulk_slope, BULK_EXPONENT
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_kinds, only: wp
   use mud_mechanism, only: measure_t, measure, measure_at, margins_at_stages, contraction, change_of_stiffness, &
      shear_share, DEPTH
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: p_follows
   use mud_state, only: state_t
   use mud_substep, only: MAX_STAGES
   use mud_tensor, only: DIRECTIONS
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: below_t, begin_below, follow_below, end_below, changes_at_memory, changes_of_measure

   !> The margin along the stages of a substep. What is carried from substep to substep are derivatives of the margin
   !> less its measure, which is a function of the state.
   type :: below_t
      logical :: follows   !< The mechanism rests, and its margin is followed; otherwise nothing else is set.
      real(wp) :: of_stages(DIRECTIONS, MAX_STAGES)   !< changes of what the stages add
      real(wp) :: margins(MAX_STAGES), rates(MAX_STAGES), start   !< see margins_at_stages
   end type below_t
contains
   !> A substep h begins, at whose end more than the stress is asked for, or not.
   pure subroutine begin_below(par, inc, trial, h, ends, below)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      logical, intent(in) :: ends
      type(below_t), intent(inout) :: below

      below%follows = inc%rests .and. .not. ends
      if (below%follows) call margins_at_stages(par, inc, trial, h, below%margins, below%rates, below%start)
   end subroutine begin_below

   !> Contribution of the rate of stage i over the whole substep: its time changes by dt, the size of that by dh [-].
   pure subroutine follow_below(par, inc, trial, h, i, point, time, dt, dh, short, driving, y, rate, below)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      integer, intent(in) :: i
      real(wp), intent(in) :: point(NY), time, dt(DIRECTIONS), dh(DIRECTIONS)
      real(wp), intent(in) :: short(DIRECTIONS)   !< derivatives where the substep begins
      type(driving_t), intent(in) :: driving
      real(wp), intent(in) :: y(DIRECTIONS, NY), rate(DIRECTIONS, NY)
      type(below_t), intent(inout) :: below
      real(wp), dimension(DIRECTIONS) :: de, dp_c, du
      integer :: j, row

      if (.not. below%follows) return
      row = (i - 1)*(i - 2)/2
      du = short
      do j = 1, i - 1
         du = du + inc%scheme%a(row + j)*below%of_stages(:, j)
      end do
      call change_of_place(inc, time, void_ratio_at(inc, time), dt, driving, de, dp_c)
      du = du + changes_of_measure(par, inc, time, point(1:6), y(:, 1:3), de, dp_c, driving%scans, driving%turn)
      below%of_stages(:, i) = h*changes_by_shear(par, inc, time, trial%w(i), below%margins(i), du, y(:, 1:3), de, &
                                                 dp_c, rate(:, 1:3), driving%d_v) + below%rates(i)*dh
   end subroutine follow_below

   !> The substep ends, whose solution is that of so many stages.
   pure subroutine end_below(inc, last, below, short)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: last
      type(below_t), intent(in) :: below
      real(wp), intent(inout) :: short(DIRECTIONS)
      integer :: i

      if (.not. below%follows) return
      do i = 1, last
         short = short + inc%scheme%b(i)*below%of_stages(:, i)
      end do
   end subroutine end_below

   !> Sets the derivatives where the mechanism is at its memory and has no margin: those of the measure.
   pure subroutine changes_at_memory(par, inc, state, time, shift, driving, y, short)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(state_t), intent(in) :: state
      real(wp), intent(in) :: time, shift(DIRECTIONS)   !< Where the next substep begins, and how that moves.
      type(driving_t), intent(in) :: driving
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      real(wp), intent(inout) :: short(DIRECTIONS)
      real(wp), dimension(DIRECTIONS) :: de, dp_c

      if (.not. (par%remembers .and. state%margin >= 0.0_wp)) return
      call change_of_place(inc, time, void_ratio_at(inc, time), shift, driving, de, dp_c)
      short = -changes_of_measure(par, inc, time, state%sigma, y(:, 1:3), de, dp_c, driving%scans, driving%turn)
   end subroutine changes_at_memory

   !> Changes of the measure at a pseudo-time and a stress [kPa] where stress, void ratio and suction change by
   !> y(:, 1:3) [kPa], de [-] and dp_c [kPa], and a branch of S_w by its turn. With those of a margin less its measure
   !> they are those of the margin.
   pure function changes_of_measure(par, inc, time, sigma, y, de, dp_c, scans, turn) result(change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, sigma(6), y(DIRECTIONS, 3), de(DIRECTIONS), dp_c(DIRECTIONS)
      logical, intent(in) :: scans
      real(wp), intent(in) :: turn(DIRECTIONS)   !< Read where it scans.
      real(wp) :: change(DIRECTIONS), with_turn(3), e, p_c
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
      real(wp), intent(in), dimension(DIRECTIONS) :: du, de, dp_c, d_v
      real(wp), intent(in), dimension(DIRECTIONS, 3) :: y, rates
      real(wp), dimension(DIRECTIONS) :: change, dp, dk, flow, df, df_e
      type(measure_t) :: m
      real(wp) :: e, curvature(3), on_flow

      e = void_ratio_at(inc, time)
      m = measure(par, w%bond, e, w%p, w%k)
      dp = (y(:, 1) + y(:, 2) + y(:, 3))/3.0_wp
      if (w%p <= par%p_min) dp = 0.0_wp
      dk = w%k*(BULK_EXPONENT/w%p*dp + bulk_slope(e)*de)
      flow = inc%d_v*dk + w%k*d_v - (rates(:, 1) + rates(:, 2) + rates(:, 3))/3.0_wp   ! of K L D
      on_flow = w%l*w%d
      if (on_flow > 0.0_wp) then
         change = m%by_p*flow + (change_of_stiffness(par, m, w%p)*w%k*on_flow)*dp
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
end module mud_mechanism_changes
