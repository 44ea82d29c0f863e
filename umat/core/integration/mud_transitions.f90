! SPDX-License-Identifier: MIT
!> What happens between substeps: the mode of the coming one, reversals and returns of the memory, opening and closing
!> at p_min, and what an accepted substep leaves behind.
module mud_transitions
   use mud_kinds, only: wp
   use mud_bounding, only: excess
   use mud_consistent, only: sensitivity_t, jump_of_memory, JUMP_NONE, JUMP_REVERSAL, JUMP_RETURN, JUMP_NEW
   use mud_event_functions, only: elastic_rate, closing_mode, closing_rate, psi_at, LARGEST_EXCESS, EVENT_NONE, &
      EVENT_BOUNDS, EVENT_REVERSAL, EVENT_RETURN
   use mud_events, only: note_turning_point
   use mud_increment, only: increment_t, rate_of
   use mud_params, only: params_t
   use mud_rates, only: rate_t, stress_ratio, MODE_ORDINARY, MODE_ELASTIC
   use mud_registry, only: RULE_RETURN_POINT
   use mud_return_point, only: watched_process, beyond_target, resume_process
   use mud_reversal, only: new_memory, begin_process, accept_process
   use mud_state, only: memory_t, state_t, counters_t
   use mud_tensor, only: IDENTITY, ddot, trace, deviator
   use mud_trial, only: trial_t, MODE_HELD
   implicit none (type, external)
   private
   public :: begin_phase, begin_substep, accept_substep, rate_is_known, AT_LIMIT

   real(wp), parameter :: AT_LIMIT = 1.0e-9_wp               !< p' this close (relative) to p_min is at p_min [-].
contains
   !> What a trial holds before the first substep of an increment or phase. Its stress and rate are those of
   !> begin_substep.
   pure subroutine begin_phase(trial)
      type(trial_t), intent(inout) :: trial

      trial%pressed = .false.
      trial%relaxation%speed = 0.0_wp
      trial%openings = 0
   end subroutine begin_phase

   !> Decides what the coming substep is - ordinary, elastic or held by the tension cut-off - applies the memory rule,
   !> and leaves the first rate in the trial. docs/theory/integration.md section 1, docs/theory/memory-rules.md section
   !> 3.5, docs/theory/material.md section 6.
   pure subroutine begin_substep(par, inc, event, known, consistent, state, trial, sens, jump, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event       !< At which the substep before ended.
      logical, intent(in) :: known       !< The trial's last rate is that of this point; one held does not close.
      logical, intent(in) :: consistent  !< Derivatives are wanted.
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(sensitivity_t), intent(inout) :: sens
      integer, intent(out) :: jump       !< JUMP_*, the last one if there are several
      type(counters_t), intent(inout) :: counters
      real(wp) :: p, r(6), outwards

      jump = JUMP_NONE
      trial%watched = 0
      trial%advanced = .false.
      call stress_ratio(par, state%sigma, p, r)
      trial%mode = MODE_ORDINARY
      trial%r_in = state%memory%r_in
      if (state%open) then
         trial%mode = MODE_HELD
         if (known) return
         call try_to_close(par, inc, r, consistent, state, trial, sens, jump, counters)
         return
      end if

      ! beyond the surface by a landing, whichever way the strain leads: suction may move the surface
      if (event == EVENT_BOUNDS) trial%pressed = .true.
      if (inc%inside .and. .not. trial%pressed) then
         trial%mode = MODE_ELASTIC
         call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
         outwards = (2.0_wp*trial%w(1)%g)*ddot(inc%d_strain, r) - (trial%w(1)%k*inc%d_v)*ddot(r, r)
         if (outwards > 0.0_wp) trial%pressed = excess(par, psi_at(par, inc, trial%time, p), r) >= LARGEST_EXCESS
         if (trial%pressed) trial%mode = MODE_ORDINARY
      end if

      trial%advanced = .false.
      if (trial%mode == MODE_ORDINARY) then
         if (known) then
            trial%w(1) = trial%w(inc%scheme%stages)
         else
            call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
         end if
         call apply_memory_rule(par, inc, event, r, consistent, state, trial, sens, jump, counters)
         trial%advanced = state%memory%x_running > 0.0_wp .or. trial%w(1)%x > 0.0_wp
      end if

      if (par%cutoff .and. trial%w(1)%d_p <= 0.0_wp) then
         if (trace(state%sigma) <= 3.0_wp*par%p_min*(1.0_wp + AT_LIMIT)) then
            call try_to_close(par, inc, r, consistent, state, trial, sens, jump, counters)
         end if
      end if
   end subroutine begin_substep

   !> True after a substep whose last rate is the first of the next, or which is held and does not close at its end.
   !> docs/theory/integration.md section 2.
   pure logical function rate_is_known(inc, trial, event)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      integer, intent(in) :: event   !< At which it ended.

      rate_is_known = event == EVENT_NONE .and. &
                      (trial%mode == MODE_HELD .or. (trial%mode == MODE_ORDINARY .and. inc%scheme%first_same_as_last))
   end function rate_is_known

   !> Returns and reversals where an ordinary substep begins; the trial holds the rate of the memory that results.
   pure subroutine apply_memory_rule(par, inc, event, r, consistent, state, trial, sens, jump, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      real(wp), intent(in) :: r(6)
      logical, intent(in) :: consistent
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(sensitivity_t), intent(inout) :: sens
      integer, intent(inout) :: jump
      type(counters_t), intent(inout) :: counters
      type(memory_t) :: before
      type(rate_t) :: trigger
      real(wp) :: t(6)

      t = elastic_rate(inc, trial%w(1), r)
      if (par%memory_rule == RULE_RETURN_POINT) then
         call try_to_return(par, inc, event == EVENT_RETURN, r, t, consistent, state, trial, sens, jump, counters)
      end if
      if (.not. trial%w(1)%loading .or. trial%w(1)%x >= 0.0_wp) return
      if (trial%w(1)%x >= -par%x_rev .and. event /= EVENT_REVERSAL) then
         counters%hysteresis = counters%hysteresis + 1
         return
      end if
      counters%reset = counters%reset + 1
      jump = JUMP_REVERSAL
      trigger = trial%w(1)
      before = state%memory
      call begin_process(par, r, trigger%n, t, state%memory)
      if (consistent) call jump_of_memory(par, inc, jump, before, state%memory, trigger, trial, sens)
      trial%r_in = state%memory%r_in
      if (stays_floored(trigger, trial%r_in)) then
         trial%w(1)%r_moved = 0.0_wp
         trial%w(1)%x = 0.0_wp
      else
         call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
      end if
      if (par%memory_rule == RULE_RETURN_POINT) then
         call try_to_return(par, inc, .false., r, t, consistent, state, trial, sens, jump, counters)
      end if
   end subroutine apply_memory_rule

   !> True where a rate is also that of a process which begins where it stands: with r_in = r the floor acts in every
   !> direction, as it did in this one, and without a cap the equation of the floor has one root.
   pure logical function stays_floored(w, r_in)
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: r_in(6)

      stays_floored = w%floored .and. .not. (w%capped_d .or. w%capped_h) .and. all(abs(r_in - w%r) <= 0.0_wp)
   end function stays_floored

   !> Lets interrupted processes go on whose targets r has reached, and leaves the one to watch in the trial.
   pure subroutine try_to_return(par, inc, landed, r, t, consistent, state, trial, sens, jump, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      logical, intent(in) :: landed          !< On the target: rounding does not count.
      real(wp), intent(in) :: r(6), t(6)
      logical, intent(in) :: consistent
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(sensitivity_t), intent(inout) :: sens
      integer, intent(inout) :: jump
      type(counters_t), intent(inout) :: counters
      type(memory_t) :: before
      logical :: reached

      reached = landed
      do
         trial%watched = watched_process(state%memory, t)
         if (trial%watched == 0) return
         trial%process = state%memory%interrupted(trial%watched)
         if (.not. reached) reached = beyond_target(par, trial%process, r, trial%w(1)%m_b) >= 0.0_wp
         if (.not. reached) return
         jump = JUMP_RETURN
         before = state%memory
         call resume_process(trial%watched, r, t, state%memory)
         if (consistent) call jump_of_memory(par, inc, jump, before, state%memory, trial%w(1), trial, sens)
         trial%r_in = state%memory%r_in
         call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
         reached = .false.
      end do
   end subroutine try_to_return

   !> A point at p_min stays open while p' would not rise from there; it closes without memory of the gap. The trial
   !> holds the ordinary rate of a point without a past.
   pure subroutine try_to_close(par, inc, r, consistent, state, trial, sens, jump, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: r(6)
      logical, intent(in) :: consistent
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(sensitivity_t), intent(inout) :: sens
      integer, intent(inout) :: jump
      type(counters_t), intent(inout) :: counters
      type(memory_t) :: before

      trial%r_in = r
      trial%mode = closing_mode(inc)
      call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
      state%open = closing_rate(inc, trial, trial%w(1)) <= 0.0_wp
      trial%watched = 0
      if (state%open) then
         trial%mode = MODE_HELD
         return
      end if
      jump = JUMP_NEW
      before = state%memory
      state%memory = new_memory(r)
      if (consistent) call jump_of_memory(par, inc, jump, before, state%memory, trial%w(1), trial, sens)
   end subroutine try_to_close

   !> Takes over an accepted substep; state already has its void ratio and suction. With the tension cut-off on, a mean
   !> stress that landed below p_min is set to p_min. docs/theory/memory-rules.md section 3.2.
   pure subroutine accept_substep(par, inc, h, trial, state, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: h             !< size of the substep [-]
      type(trial_t), intent(in) :: trial
      type(state_t), intent(inout) :: state
      type(counters_t), intent(inout) :: counters

      counters%substep = counters%substep + 1
      state%sigma = trial%y(1:6)
      if (trial%mode == MODE_HELD) then
         counters%open = counters%open + 1
         return
      end if
      state%z = trial%y(7:12)
      state%eps_q_total = state%eps_q_total + trial%y(13)
      if (par%cutoff .and. trace(state%sigma) < 3.0_wp*par%p_min) then
         state%sigma = deviator(state%sigma) + par%p_min*IDENTITY
      end if
      if (trial%mode == MODE_ORDINARY) then
         associate (w => trial%w(latest_forwards(inc, trial)))
            call accept_process(w%loading, w%x, trial%y(13), state%memory)
         end associate
         if (par%memory_rule == RULE_RETURN_POINT) then
            call note_turning_point(par, inc, h, trial, state%memory, counters)
         end if
      end if
   end subroutine accept_substep

   !> The stage that tells how far a process has come: the last one of an ordinary substep, if it stands at its end and
   !> no turn lies in between, otherwise the first.
   pure integer function latest_forwards(inc, trial) result(stage)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial

      stage = 1
      if (.not. inc%scheme%first_same_as_last) return
      associate (last => trial%w(inc%scheme%stages))
         if (last%loading .and. last%x >= 0.0_wp) stage = inc%scheme%stages
      end associate
   end function latest_forwards
end module mud_transitions
