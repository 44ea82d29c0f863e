! SPDX-License-Identifier: MIT
!> Derivative of the time of an event inside an increment, from the event's function: with it the substep that ends
!> there changes its size.
module mud_event_time
   use mud_bounding_changes, only: change_of_psi, change_of_excess
   use mud_consistent, only: sensitivity_t, change_with_size, changes_along, changes_of_ratio, linearise_stage
   use mud_cutoff, only: MODE_HELD
   use mud_driving, only: driving_t
   use mud_event, only: event_changes_t, psi_at, NO_RATE, BY_RATE, BY_DRIVE, BY_VIRGIN_RATE, BY_SURFACE, &
      BY_MECHANISM, BY_MEMORY
   use mud_event_closes, only: closing_mode
   use mud_event_table, only: EVENTS, rate_at_end, slopes_of_event
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_kinds, only: wp
   use mud_linearise, only: linearised_t, changes_t
   use mud_mechanism_changes, only: changes_of_measure
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, p_follows
   use mud_sensitivity, only: changes_of_rate, changes_of_drive, changes_of_iso_drive
   use mud_state, only: counters_t
   use mud_tensor, only: DIRECTIONS, tensors_t, ANY_TENSORS
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: move_event

   !> An event whose function hardly changes along the path (relative to its change with the increment) has no definite
   !> time: it is taken as fixed [-].
   real(wp), parameter :: GRAZING = 1.0e-10_wp
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
      type(event_changes_t) :: c
      type(linearised_t) :: lin
      type(rate_t) :: w
      type(counters_t) :: uncounted
      type(tensors_t) :: r_in
      real(wp) :: with_size(NY), y(DIRECTIONS, NY), dt(DIRECTIONS), slopes(DIRECTIONS), e, time, dh, &
         short(DIRECTIONS), short_with_size
      integer :: j, mode

      time = trial%time + h
      mode = trial%mode
      if (mode == MODE_HELD) mode = closing_mode(inc)
      e = void_ratio_at(inc, time)
      call rate_at_end(par, inc, event, trial, h, w, uncounted)
      call change_with_size(par, inc, trial, h, with_size, short_with_size)
      short = sens%short
      short(BY_SIZE) = short_with_size
      y = sens%y
      y(BY_SIZE, :) = with_size
      r_in = sens%r_in
      r_in%of(BY_SIZE, :) = 0.0_wp
      dt = sens%shift
      dt(BY_SIZE) = 1.0_wp
      call changes_along(inc, mode, time, e, dt, sens%driving, changes)
      if (EVENTS(event)%looks_at /= NO_RATE) &
         call linearise_stage(par, inc, w, trial%y, time, e, changes%loading, .false., lin)
      call fill_changes(par, inc, event, trial, time, w, lin, y, r_in, short, sens%driving, changes, c)
      slopes = slopes_of_event(par, inc, event, trial, time, w, c)
      do j = 1, DIRECTIONS - 1
         if (abs(slopes(BY_SIZE)) <= GRAZING*abs(slopes(j))) cycle
         dh = -slopes(j)/slopes(BY_SIZE)
         sens%y(j, :) = sens%y(j, :) + dh*with_size
         sens%shift(j) = sens%shift(j) + dh
      end do
   end subroutine move_event

   !> Changes with which the function of an event changes, at a pseudo-time.
   pure subroutine fill_changes(par, inc, event, trial, time, w, lin, y, r_in, short, driving, changes, c)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time
      type(rate_t), intent(in) :: w            !< where the event depends on a rate
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)   !< changes of state
      type(tensors_t), intent(in) :: r_in         !< and memory
      real(wp), intent(in) :: short(DIRECTIONS)   !< and of what lacks to the memory of the isotropic mechanism
      type(driving_t), intent(in) :: driving
      type(changes_t), intent(in) :: changes
      type(event_changes_t), intent(inout) :: c

      c%y = y
      c%e = changes%e
      c%d_pc = changes%d_pc
      c%strain = driving%d_strain%of
      c%r = changes_of_ratio(par, trial%y(1:6), y)
      c%r_in = r_in%of
      associate (strain => driving%d_strain, centre => driving%from_centre)
         select case (EVENTS(event)%depends)
         case (BY_RATE, BY_DRIVE)
            call changes_of_rate(par, w, lin, .false., y, r_in, strain, centre, changes, .false., c%rates, c%n)
            if (EVENTS(event)%depends == BY_DRIVE) c%drive = changes_of_drive(w, lin, y, strain, centre, changes)
         case (BY_MECHANISM)
            call changes_of_rate(par, w, lin, .false., y, r_in, strain, centre, changes, .false., c%rates)
            c%mechanism = changes_of_iso_drive(par, w, lin, void_ratio_at(inc, time), y, strain, centre, changes, &
                                               c%rates)
         case (BY_VIRGIN_RATE)
            call changes_of_rate(par, w, lin, .false., y, tensors_t(c%r, ANY_TENSORS), strain, centre, changes, &
                                 .false., c%rates)
         case (BY_MEMORY)
            c%mechanism = short + changes_of_measure(par, inc, time, trial%y(1:6), y(:, 1:3), changes%e, changes%p_c, &
                                                     changes%scans, changes%turn)
         case (BY_SURFACE)
            call change_surface(par, inc, trial, time, changes, c)
         end select
      end associate
   end subroutine fill_changes

   !> Changes of the state parameter and of the excess over the bounding surface.
   pure subroutine change_surface(par, inc, trial, time, changes, c)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time
      type(changes_t), intent(in) :: changes
      type(event_changes_t), intent(inout) :: c
      real(wp) :: p, r(6), psi, e, p_c, dp, turn, dr(6)
      integer :: j

      call stress_ratio(par, trial%y(1:6), p, r)
      psi = psi_at(par, inc, time, p)
      e = void_ratio_at(inc, time)
      p_c = suction_at(inc, time)
      do j = 1, DIRECTIONS
         dp = 0.0_wp
         if (p_follows(par, trial%y(1:6))) dp = (c%y(j, 1) + c%y(j, 2) + c%y(j, 3))/3.0_wp
         turn = 0.0_wp
         if (changes%scans) turn = changes%turn(j)
         c%psi(j) = change_of_psi(par, inc%suction, e, p_c, p, changes%e(j), changes%p_c(j), dp, turn)
         dr = c%r(j, :)
         c%excess(j) = change_of_excess(par, psi, r, c%psi(j), dr)
      end do
   end subroutine change_surface
end module mud_event_time
