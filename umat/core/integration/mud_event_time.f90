! SPDX-License-Identifier: MIT
!> Derivative of the time of an event inside an increment, from the event's function: with it the substep that ends
!> there changes its size.
module mud_event_time
   use mud_kinds, only: wp
   use mud_bounding, only: change_of_state_parameter, change_of_bounding_ratio, change_of_excess
   use mud_consistent, only: sensitivity_t, change_with_size, change_along, change_of_ratio, linearise_stage
   use mud_critical_state, only: bounding_ratio
   use mud_driving, only: DIRECTIONS, AT_REST
   use mud_events, only: EVENT_OPENS, EVENT_BOUNDS, EVENT_REVERSAL, EVENT_RETURN, closing_mode, &
      change_of_closing_rate, psi_at
   use mud_increment, only: increment_t, void_ratio_at, suction_at, rate_of, turning_t, turning_of, NY
   use mud_params, only: params_t
   use mud_rates, only: rate_t, stress_ratio
   use mud_return_point, only: target_limit, is_limited
   use mud_sensitivity, only: change_t, linearised_t, change_of_rate
   use mud_state, only: counters_t
   use mud_tensor, only: ddot, trace
   use mud_trial, only: trial_t, MODE_HELD
   implicit none (type, external)
   private
   public :: move_event

   !> An event whose function hardly changes along the path (relative to its change with the increment) has no definite
   !> time: it is taken as fixed [-].
   real(wp), parameter :: GRAZING = 1.0e-10_wp
contains
   !> A substep has ended at an event: adds the derivative of its time to the derivatives at a fixed size.
   pure subroutine move_event(par, inc, event, trial, h, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event             !< EVENT_*, not EVENT_NONE
      type(trial_t), intent(in) :: trial       !< the substep
      real(wp), intent(in) :: h                !< its size
      type(sensitivity_t), intent(inout) :: sens
      type(change_t) :: change
      type(linearised_t) :: lin
      type(rate_t) :: w
      type(counters_t) :: uncounted
      type(turning_t) :: turning
      real(wp) :: with_size(NY), no_strain(6), no_memory(6), e, time, slope, slope_with_size, dh
      integer :: j, mode

      time = trial%time + h
      mode = trial%mode
      if (event == EVENT_REVERSAL) then
         call rate_of(par, inc, time, trial%y, trial%r_in, mode, w, uncounted)
         call linearise_stage(par, inc, mode, w, trial%y, time, void_ratio_at(inc, time), lin)
      else if (mode == MODE_HELD) then
         mode = closing_mode(inc)
         call rate_without_past(par, inc, time, trial%y, w)
         call linearise_stage(par, inc, mode, w, trial%y, time, void_ratio_at(inc, time), lin)
      end if

      e = void_ratio_at(inc, time)
      turning = turning_of(inc, mode, time)
      no_strain = 0.0_wp
      no_memory = 0.0_wp
      call change_with_size(par, inc, trial, h, with_size)
      call change_along(inc, mode, 1, time, e, turning, 1.0_wp, with_size, no_memory, AT_REST, change)
      slope_with_size = slope_of_event(par, inc, event, trial, time, w, lin, change, no_strain)
      do j = 1, DIRECTIONS
         call change_along(inc, mode, j, time, e, turning, sens%shift(j), sens%y(:, j), sens%r_in(:, j), sens%driving, &
                           change)
         slope = slope_of_event(par, inc, event, trial, time, w, lin, change, sens%driving%d_strain(:, j))
         if (abs(slope_with_size) <= GRAZING*abs(slope)) cycle
         dh = -slope/slope_with_size
         sens%y(:, j) = sens%y(:, j) + dh*with_size
         sens%shift(j) = sens%shift(j) + dh
      end do
   end subroutine move_event

   !> The rate that decides whether a held point closes.
   pure subroutine rate_without_past(par, inc, time, y, w)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, y(NY)
      type(rate_t), intent(inout) :: w
      type(counters_t) :: uncounted
      real(wp) :: p, r(6)

      call stress_ratio(par, y(1:6), p, r)
      call rate_of(par, inc, time, y, r, closing_mode(inc), w, uncounted)
   end subroutine rate_without_past

   !> Change of the event's function, where it is zero; its scale does not matter.
   pure real(wp) function slope_of_event(par, inc, event, trial, time, w, lin, change, strain_change) result(slope)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time
      type(rate_t), intent(in) :: w            !< where the event hangs on a rate
      type(linearised_t), intent(in) :: lin
      type(change_t), intent(in) :: change
      real(wp), intent(in) :: strain_change(6) !< of the whole strain
      type(change_t) :: moved
      real(wp) :: p, r(6), dp, dr(6), dpsi, psi, m_b, d_sigma(6), d_z(6), d_eps_q, dn(6)

      slope = 0.0_wp
      call stress_ratio(par, trial%y(1:6), p, r)
      dr = change_of_ratio(par, trial%y(1:6), change%sigma)
      select case (event)
      case (EVENT_OPENS)
         slope = trace(change%sigma)
      case (EVENT_REVERSAL)
         call change_of_rate(par, w, lin, change, d_sigma, d_z, d_eps_q, dn)
         slope = ddot(dr - change%r_in, w%n) + ddot(r - trial%r_in, dn)
      case (EVENT_BOUNDS, EVENT_RETURN)
         psi = psi_at(par, inc, time, p)
         dp = merge(trace(change%sigma)/3.0_wp, 0.0_wp, trace(trial%y(1:6)) >= 3.0_wp*par%p_min)
         dpsi = change_of_state_parameter(par, inc%bonded, void_ratio_at(inc, time), suction_at(inc, time), p, &
                                          change%e, change%p_c, dp)
         if (event == EVENT_BOUNDS) then
            slope = change_of_excess(par, psi, r, dpsi, dr)
         else
            m_b = bounding_ratio(par, psi)
            slope = ddot(dr, trial%process%direction)
            if (is_limited(par, trial%process, m_b)) then
               slope = slope - target_limit(par, trial%process)*change_of_bounding_ratio(par, psi, m_b, dpsi)
            end if
         end if
      case default
         moved = change
         moved%r_in = dr
         call change_of_rate(par, w, lin, moved, d_sigma, d_z, d_eps_q, dn)
         slope = change_of_closing_rate(inc, trial, w, lin%e, trace(d_sigma)/3.0_wp, change%e, strain_change, &
                                        change%d_pc)
      end select
   end function slope_of_event
end module mud_event_time
