! SPDX-License-Identifier: MIT
!> The loop over substeps of an increment, or of one of its phases.
module mud_substepping
   use mud_kinds, only: wp
   use mud_consistent, only: sensitivity_t, propagate
   use mud_event_time, only: move_event
   use mud_error_control, only: control_t, judge_attempt, proposal
   use mud_events, only: stop_at_event, EVENT_TOLERANCE, EVENT_NONE, EVENT_OPENS, EVENT_MECHANISM
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_params, only: params_t
   use mud_registry, only: RULE_AS_PUBLISHED
   use mud_state, only: state_t, counters_t
   use mud_status, only: mud_status_t, fail, MUD_MINIMUM_STEP, MUD_TOO_MANY_SUBSTEPS, MUD_NO_DIRECTION, &
      MUD_NOT_FINITE, ON_STRESS
   use mud_stiffness, only: choose_stepping, raise_order
   use mud_tensor, only: ddot, norm, is_finite, all_finite
   use mud_trace, only: trace_t, record_substep, SUBSTEP_REJECTED, SUBSTEP_ACCEPTED, SUBSTEP_FAILED
   use mud_transitions, only: begin_phase, begin_substep, accept_substep, rate_is_known
   use mud_trial, only: trial_t, take_step, error_norm
   implicit none (type, external)
   private
   public :: integrate

   real(wp), parameter :: ALIGNED = 1.0e-8_wp                !< Cosine this close to 1 is no turn [-].
   !> From this on, some degrees, a turn of the domain is followed by the higher order: it is a transient that modified
   !> Euler pays for with many substeps, and whose errors add up along turning paths [-].
   real(wp), parameter :: SHARP = 1.0e-3_wp
   !> First substep where the domain turns, share of its radius: a divisor of few round increments [-].
   real(wp), parameter :: TURN_PIECE = 0.7_wp
   !> Modified Euler hands over to a higher order where more substeps than these are ahead: two rates each [-].
   real(wp), parameter :: MANY_SUBSTEPS = 50.0_wp
   real(wp), parameter :: LAST_SLIVER = 1.0e-9_wp            !< A rest of this share joins the substep before it [-].
contains
   !> The loop over substeps. On return inc has the scheme of the last one. reached is 1, or after an error the share of
   !> inc before the substep that failed [-]. Errors: MUD_TOO_MANY_SUBSTEPS, MUD_MINIMUM_STEP, MUD_NOT_FINITE,
   !> MUD_NO_DIRECTION; state is then that of the last accepted substep. docs/theory/integration.md sections 1 to 4.
   pure subroutine integrate(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc
      real(wp), intent(in) :: size                !< of the increment, in units of strain [-]
      logical, intent(in) :: consistent           !< derivatives are wanted
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial       !< the last accepted substep
      type(sensitivity_t), intent(inout) :: sens
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: reached
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      real(wp) :: time, h, h_taken, planned, error, factor, tolerance, turn
      integer :: elastic_substeps, jump, event
      type(control_t) :: control
      logical :: may_grow, known

      time = 0.0_wp
      turn = turn_of(inc)
      h = first_step(inc, state, size, turn > ALIGNED)
      planned = state%last_step
      if (turn > SHARP) call raise_order(par, inc)
      may_grow = .true.
      elastic_substeps = 0
      known = .false.
      event = EVENT_NONE
      call begin_phase(trial)
      substeps: do while (time < 1.0_wp)
         reached = time
         trial%time = time
         trial%y0(1:6) = state%sigma
         trial%y0(7:12) = state%z
         trial%y0(13) = 0.0_wp
         call begin_substep(par, inc, event, known, consistent, state, trial, sens, jump, counters)
         call choose_stepping(par, 1.0_wp - time, max(h, par%h_min), inc, trial)
         attempts: do
            if (counters%substep + counters%reject >= par%max_substeps) then
               status = fail(MUD_TOO_MANY_SUBSTEPS, value=real(par%max_substeps, wp))
               return
            end if
            h = max(h, par%h_min)
            if (MANY_SUBSTEPS*h < 1.0_wp - time) call raise_order(par, inc)
            h_taken = h
            if (time + h*(1.0_wp + LAST_SLIVER) >= 1.0_wp) h_taken = 1.0_wp - time
            call take_step(par, inc, h_taken, trial, counters)
            error = error_norm(par, inc%scheme, trial, h_taken)
            if (.not. all_finite(trial%y) .or. .not. is_finite(error)) then
               status = fail(MUD_NOT_FINITE, ON_STRESS)
               call record_substep(par, inc, trial, h_taken, error, trial%y(1:6), SUBSTEP_FAILED, jump, .false., &
                                   counters, record)
               return
            end if
            call judge_attempt(par, inc, trial, h_taken, error, may_grow, control, tolerance, factor)
            if (error <= tolerance) exit attempts
            if (min(h, h_taken) <= par%h_min*(1.0_wp + LAST_SLIVER)) then
               if (.not. par%accept_minimum) then
                  status = fail(MUD_MINIMUM_STEP, value=error, lower=0.0_wp, upper=par%tolerance)
                  call record_substep(par, inc, trial, h_taken, error, trial%y(1:6), SUBSTEP_FAILED, jump, .false., &
                                      counters, record)
                  return
               end if
               counters%min_step = counters%min_step + 1
               factor = 1.0_wp
               exit attempts
            end if
            counters%reject = counters%reject + 1
            call record_substep(par, inc, trial, h_taken, error, trial%y(1:6), SUBSTEP_REJECTED, jump, .false., &
                                counters, record)
            may_grow = .false.
            h = h_taken*min(factor, 0.9_wp)
            planned = h*size
         end do attempts
         may_grow = .true.

         h = h_taken*factor
         call stop_at_event(par, inc, error, h_taken, trial, counters, event)
         if (event == EVENT_OPENS) trial%openings = trial%openings + 1
         if (trial%w(1)%no_root) elastic_substeps = elastic_substeps + 1
         if (elastic_substeps > 1 .and. par%memory_rule /= RULE_AS_PUBLISHED) then
            status = fail(MUD_NO_DIRECTION)
            call record_substep(par, inc, trial, h_taken, error, trial%y(1:6), SUBSTEP_FAILED, jump, &
                                event /= EVENT_NONE, counters, record)
            return
         end if
         time = time + h_taken
         if (1.0_wp - time < EVENT_TOLERANCE) time = 1.0_wp
         if (time < 1.0_wp) planned = h*size
         state%e = void_ratio_at(inc, time)
         state%p_c = suction_at(inc, time)
         if (consistent) then
            call propagate(par, inc, trial, h_taken, time >= 1.0_wp, sens)
            ! where the mechanism switches the rates are continuous: when that happens does not matter
            if (event /= EVENT_NONE .and. event /= EVENT_MECHANISM .and. time < 1.0_wp) then
               call move_event(par, inc, event, trial, h_taken, sens)
            end if
         end if
         call accept_substep(par, inc, h_taken, trial, state, counters)
         call record_substep(par, inc, trial, h_taken, error, state%sigma, SUBSTEP_ACCEPTED, jump, &
                             event /= EVENT_NONE, counters, record)
         known = rate_is_known(inc, trial, event)
      end do substeps
      if (.not. inc%inside) state%last_step = proposal(inc, planned, h*size, factor)
      reached = 1.0_wp
   end subroutine integrate

   !> The first substep as a share of the increment or phase [-].
   pure real(wp) function first_step(inc, state, size, turns)
      type(increment_t), intent(in) :: inc
      type(state_t), intent(in) :: state
      real(wp), intent(in) :: size    !< of the increment, in units of strain [-]
      logical, intent(in) :: turns    !< The elastic domain turns.

      first_step = 1.0_wp
      ! an elastic phase goes in one step if it can, and leaves the remembered step to the next plastic one
      if (state%last_step > 0.0_wp .and. state%last_step < size .and. .not. inc%inside) &
         first_step = state%last_step/size
      ! a whole number of pieces, so that a small change of the strain does not change their size
      if (turns) then
         first_step = min(first_step, 1.0_wp/real(ceiling(min(norm(inc%d_strain)/(TURN_PIECE*inc%rho), 1.0e6_wp)), wp))
      end if
   end function first_step

   !> How far the elastic domain turns from its start on, 1 minus its cosine with the strain: the transient lasts about
   !> a radius of strain.
   pure real(wp) function turn_of(inc)
      type(increment_t), intent(in) :: inc
      real(wp) :: whole

      turn_of = 0.0_wp
      if (inc%rho <= 0.0_wp .or. inc%inside) return
      whole = inc%rho*norm(inc%d_strain)
      if (whole > 0.0_wp) turn_of = 1.0_wp - ddot(inc%from_centre, inc%d_strain)/whole
   end function turn_of
end module mud_substepping
