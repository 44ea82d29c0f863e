! SPDX-License-Identifier: MIT
!> Derivative of the time of an event inside an increment, from the event's function: with it the substep that ends
!> there changes its size.
module mud_event_time
   use mud_kinds, only: wp
   use mud_bounding_changes, only: change_of_psi, change_of_excess
   use mud_consistent, only: sensitivity_t, change_with_size, changes_along, changes_of_ratio, linearise_stage
   use mud_critical_state, only: bounding_ratio, bounding_slope
   use mud_cutoff, only: closing_mode, rate_without_past, MODE_HELD
   use mud_driving, only: driving_t, DIRECTIONS
   use mud_error_control, only: changes_root
   use mud_event_functions, only: psi_at
   use mud_event_table, only: EVENTS, EVENT_OPENS, EVENT_PARTS, EVENT_BOUNDS, EVENT_REVERSAL, EVENT_RETURN, &
      EVENT_YIELD, EVENT_MECHANISM, EVENT_FORWARDS, NO_RATE, RATE_THERE, RATE_IF_CLOSED
   use mud_held, only: changes_of_height, change_of_closing_rate
   use mud_increment, only: increment_t, void_ratio_at, suction_at, rate_of
   use mud_margin_changes, only: changes_of_measure
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, p_follows
   use mud_return_point, only: target_limit, is_limited
   use mud_sensitivity, only: changes_of_rate, changes_of_drive, changes_of_iso_drive
   use mud_state, only: counters_t
   use mud_tensor, only: ddot, trace, contractions, tensors_t, ANY_TENSORS
   use mud_trial, only: trial_t
   use mud_linearise, only: linearised_t, changes_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: move_event

   !> An event whose function hardly changes along the path (relative to its change with the increment) has no definite
   !> time: it is taken as fixed [-].
   real(wp), parameter :: GRAZING = 1.0e-10_wp
   !> A reversal beyond which (r - r_in):n is farther from -x_rev than this share of its change may have been jumped
   !> over: where it can be found it is to 1e-12, but in substeps as short as h_min [-].
   real(wp), parameter :: FOUND = 1.0e-6_wp
   integer, parameter :: BY_SIZE = DIRECTIONS   !< The idle direction serves as that of the substep's size.
contains
   !> A substep has ended at an event: adds the derivative of its time to the derivatives at a fixed size.
   !> docs/theory/integration.md section 4.3. Where the event only grazes, its time is taken as fixed.
   pure subroutine move_event(par, inc, event, trial, h, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event             !< EVENT_*, not EVENT_NONE
      type(trial_t), intent(in) :: trial       !< the substep
      real(wp), intent(in) :: h                !< size of the substep [-]
      type(sensitivity_t), intent(inout) :: sens
      type(changes_t) :: changes
      type(linearised_t) :: lin
      type(rate_t) :: w
      type(counters_t) :: uncounted
      type(tensors_t) :: r_in
      real(wp) :: with_size(NY), y(DIRECTIONS, NY), dt(DIRECTIONS), slopes(DIRECTIONS), e, time, dh, &
         margin(DIRECTIONS), margin_with_size
      integer :: j, mode

      time = trial%time + h
      mode = trial%mode
      if (mode == MODE_HELD) mode = closing_mode(inc)
      e = void_ratio_at(inc, time)
      select case (EVENTS(event)%looks_at)
      case (RATE_THERE)
         call rate_of(par, inc, time, trial%y, trial%r_in, mode, w, uncounted)
      case (RATE_IF_CLOSED)
         call rate_without_past(par, inc, time, trial%y, w, uncounted)
      end select
      call change_with_size(par, inc, trial, h, with_size, margin_with_size)
      margin = sens%margin
      margin(BY_SIZE) = margin_with_size
      y = sens%y
      y(BY_SIZE, :) = with_size
      r_in = sens%r_in
      r_in%of(BY_SIZE, :) = 0.0_wp
      dt = sens%shift
      dt(BY_SIZE) = 1.0_wp
      call changes_along(inc, mode, time, e, dt, sens%driving, changes)
      if (EVENTS(event)%looks_at /= NO_RATE) &
         call linearise_stage(par, inc, w, trial%y, time, e, changes%loading, lin)
      slopes = slopes_of_event(par, inc, event, trial, time, w, lin, y, r_in, margin, sens%driving, changes)
      do j = 1, DIRECTIONS - 1
         if (abs(slopes(BY_SIZE)) <= GRAZING*abs(slopes(j))) cycle
         dh = -slopes(j)/slopes(BY_SIZE)
         sens%y(j, :) = sens%y(j, :) + dh*with_size
         sens%shift(j) = sens%shift(j) + dh
      end do
   end subroutine move_event

   !> Changes of the event's function, where it is zero; its scale does not matter.
   pure function slopes_of_event(par, inc, event, trial, time, w, lin, y, r_in, margin, driving, changes) &
      result(slopes)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time
      type(rate_t), intent(in) :: w            !< where the event depends on a rate
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)   !< changes of state
      type(tensors_t), intent(in) :: r_in         !< and memory
      real(wp), intent(in) :: margin(DIRECTIONS)  !< and of the isotropic memory's margin less its measure
      type(driving_t), intent(in) :: driving
      type(changes_t), intent(in) :: changes
      real(wp) :: slopes(DIRECTIONS), rates(DIRECTIONS, NY), dn(DIRECTIONS, 6), dr(DIRECTIONS, 6), p, r(6)
      real(wp) :: y_j(NY), dr_j(6), strain_j(6), turn(DIRECTIONS)
      integer :: j

      call stress_ratio(par, trial%y(1:6), p, r)
      dr = changes_of_ratio(par, trial%y(1:6), y)
      select case (event)
      case (EVENT_OPENS)
         slopes = changes_of_height(y)
      case (EVENT_PARTS)
         slopes = changes%e
      case (EVENT_REVERSAL)
         if (jumps(par, trial, w)) then
            slopes = changes_of_drive(w, lin, y, driving%d_strain, driving%from_centre, changes)
         else
            call changes_of_rate(par, w, lin, .false., y, r_in, driving%d_strain, driving%from_centre, changes, &
                                 .false., rates, dn)
            slopes = contractions(dr - r_in%of, w%n) + contractions(dn, r - trial%r_in)
         end if
      case (EVENT_MECHANISM)
         call changes_of_rate(par, w, lin, .false., y, r_in, driving%d_strain, driving%from_centre, changes, .false., &
                              rates)
         slopes = changes_of_iso_drive(par, w, lin, void_ratio_at(inc, time), y, driving%d_strain, &
                                       driving%from_centre, changes, rates)
      case (EVENT_YIELD)
         slopes = margin + changes_of_measure(par, inc, time, trial%y(1:6), y(:, 1:3), changes%e, changes%p_c, &
                                              changes%scans, changes%turn)
      case (EVENT_FORWARDS)
         call changes_of_rate(par, w, lin, .false., y, r_in, driving%d_strain, driving%from_centre, changes, .false., &
                              rates, dn)
         slopes = contractions(rates(:, 1:6), w%n) + contractions(dn, w%d_sigma - w%d_p*r) &
                  - w%d_p*contractions(dr, w%n) - (w%r_n/3.0_wp)*(rates(:, 1) + rates(:, 2) + rates(:, 3))
      case (EVENT_BOUNDS, EVENT_RETURN)
         turn = 0.0_wp
         if (changes%scans) turn = changes%turn
         do j = 1, DIRECTIONS
            ! copies: a row that is passed as it is may be packed into memory of its own
            y_j = y(j, :)
            dr_j = dr(j, :)
            slopes(j) = slope_at_surface(par, inc, event, trial, time, y_j, dr_j, changes%e(j), changes%p_c(j), &
                                        turn(j))
         end do
      case default
         call changes_of_rate(par, w, lin, .false., y, tensors_t(dr, ANY_TENSORS), driving%d_strain, &
                              driving%from_centre, changes, .false., rates)
         do j = 1, DIRECTIONS
            strain_j = driving%d_strain%of(j, :)
            slopes(j) = change_of_closing_rate(inc, trial%openings, w, void_ratio_at(inc, time), &
                                               (rates(j, 1) + rates(j, 2) + rates(j, 3))/3.0_wp, &
                                               changes%e(j), strain_j, changes%d_pc(j))
         end do
      end select
   end function slopes_of_event

   !> True where (r - r_in):n passes -x_rev in a jump: t and r have one direction only, as in triaxial states, t passes
   !> zero, and n becomes its opposite (or the root changes). The time of such a reversal is that of t, along n, at
   !> zero. A place that is known to h_min alone may be as far beyond -x_rev without a jump.
   pure logical function jumps(par, trial, w)
      type(params_t), intent(in) :: par
      type(trial_t), intent(in) :: trial
      type(rate_t), intent(in) :: w      !< at the event

      jumps = -(w%x + par%x_rev) > FOUND*(abs(trial%w(1)%x) + par%x_rev)
      if (jumps) jumps = ddot(trial%w(1)%n, w%n) < 0.0_wp .or. changes_root([trial%w(1), w])
   end function jumps

   !> Slope of an event function that depends on the bounding surface, along one direction.
   pure real(wp) function slope_at_surface(par, inc, event, trial, time, y, dr, de, dp_c, d_turn) result(slope)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time, y(NY), dr(6), de, dp_c, d_turn
      real(wp) :: p, r(6), psi, dp, dpsi, m_b

      call stress_ratio(par, trial%y(1:6), p, r)
      psi = psi_at(par, inc, time, p)
      dp = merge(trace(y(1:6))/3.0_wp, 0.0_wp, p_follows(par, trial%y(1:6)))
      dpsi = change_of_psi(par, inc%suction, void_ratio_at(inc, time), suction_at(inc, time), p, de, &
                                       dp_c, dp, d_turn)
      if (event == EVENT_BOUNDS) then
         slope = change_of_excess(par, psi, r, dpsi, dr)
      else
         m_b = bounding_ratio(par, psi)
         slope = ddot(dr, trial%process%direction)
         if (is_limited(par, trial%process, m_b)) then
            slope = slope - target_limit(par, trial%process)*bounding_slope(par, psi, m_b)*dpsi
         end if
      end if
   end function slope_at_surface
end module mud_event_time
