! SPDX-License-Identifier: MIT
!> Transitions between substeps: the mode of the coming one, reversals and returns of the memory, opening and closing at
!> p_min, and what an accepted substep leaves behind.
module mud_transitions
   use mud_kinds, only: wp
   use mud_bounding, only: excess
   use mud_cutoff, only: landed, may_open, parting, gap_at, MODE_HELD
   use mud_event, only: elastic_rate, psi_at, EVENT_NONE, EVENT_REVERSAL, EVENT_RETURN, EVENT_FORWARDS
   use mud_event_bounds, only: LARGEST_EXCESS
   use mud_event_closes, only: closing_mode, closes
   use mud_event_forwards, only: backwards
   use mud_event_table, only: event_happened
   use mud_events, only: note_turning_point
   use mud_increment, only: rate_of
   use mud_integration, only: integration_t, note_jump, JUMP_NONE, JUMP_REVERSAL, JUMP_RETURN, JUMP_NEW
   use mud_mechanism, only: forget_compression, begin_mechanism, mechanism_ceases, keep_compression, turns_by_resting
   use mud_options, only: begin_numbers, take_past, forget_past, past_counts, keep_numbers
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, MODE_ORDINARY, MODE_ELASTIC
   use mud_registry, only: RULE_RETURN_POINT
   use mud_return_point, only: watched_process, beyond_target, resume_process
   use mud_reversal, only: new_memory, begin_process, accept_process, drag_process, drags_memory
   use mud_state, only: memory_t
   use mud_tensor, only: ddot, norm
   use mud_vector, only: Y_Z, Y_Z_END, Y_SHEAR
   implicit none (type, external)
   private
   public :: take_last_rate, begin_substep, accept_substep, rate_is_known

contains
   !> The last rate of the substep before is the first of the coming one, if that is known.
   pure subroutine take_last_rate(it)
      type(integration_t), intent(inout) :: it

      if (it%known .and. it%trial%mode == MODE_ORDINARY) it%trial%w(1) = it%trial%w(it%inc%scheme%stages)
   end subroutine take_last_rate

   !> Decides what the coming substep is - ordinary, elastic or held by the tension cut-off - applies the memory rule,
   !> and leaves the first rate in the trial, where it stands already if it is known. docs/theory/integration.md section
   !> 1, docs/theory/memory-rules.md section 3.5, docs/theory/material.md section 6.
   pure subroutine begin_substep(par, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it
      real(wp) :: p, r(6)
      logical :: dragged

      dragged = it%trial%drifts
      call take_state(par, it)
      call stress_ratio(par, it%state%sigma, p, r)
      if (it%state%open) then
         call try_to_close(par, r, it)
         return
      end if
      if (it%inc%inside .and. .not. it%trial%pressed) call begin_elastic(par, p, r, it)
      if (it%trial%mode == MODE_ORDINARY) call begin_ordinary(par, r, dragged, it)
      if (mechanism_ceases(par, it%inc, it%trial%time, it%trial%w(1))) then
         it%inc%rests = .true.
         call first_rate(par, it)
      end if
      if (may_open(par, it%state%sigma, it%trial%w(1)%d_p)) call try_to_close(par, r, it)
      if (it%trial%mode == MODE_ORDINARY .and. it%trial%w(1)%loading .and. .not. it%trial%advanced) then
         if (drags_memory(par)) it%trial%drifts = backwards(it%trial%w(1)) > 0.0_wp
      end if
      it%trial%divides = it%trial%divides .or. it%trial%drifts .or. it%jump == JUMP_NEW
      if (it%jump /= JUMP_NONE .or. it%trial%mode /= MODE_ORDINARY) then
         it%trial%transient%sought = .false.
         it%trial%transient%known = .false.
      end if
   end subroutine begin_substep

   !> The trial begins where the state is, as an ordinary substep without a jump.
   pure subroutine take_state(par, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it

      it%trial%time = it%reached
      it%trial%y0(1:6) = it%state%sigma
      it%trial%y0(Y_Z:Y_Z_END) = it%state%z
      it%trial%y0(Y_SHEAR) = 0.0_wp
      call begin_numbers(it%state, it%trial%y0)
      it%trial%e = it%state%e
      call begin_mechanism(par, it%state, it%inc, it%trial, it%known)
      it%jump = JUMP_NONE
      it%n_jumps = 0
      it%trial%watched = 0
      it%trial%advanced = .false.
      it%trial%drifts = .false.
      it%trial%mode = MODE_ORDINARY
      call take_memory(par, it)
   end subroutine take_state

   !> Inside the elastic domain a substep is elastic, unless it would leave the bounding surface: from there on the
   !> phase is ordinary.
   pure subroutine begin_elastic(par, p, r, it)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p, r(6)
      type(integration_t), intent(inout) :: it
      real(wp) :: outwards

      it%trial%mode = MODE_ELASTIC
      call first_rate(par, it)
      outwards = (2.0_wp*it%trial%w(1)%g)*ddot(it%inc%d_strain, r) - (it%trial%w(1)%k*it%inc%d_v)*ddot(r, r)
      if (outwards > 0.0_wp) it%trial%pressed = &
         excess(par%critical, psi_at(par, it%inc, it%trial%time, p), r) >= LARGEST_EXCESS
      if (it%trial%pressed) it%trial%mode = MODE_ORDINARY
   end subroutine begin_elastic

   !> The first rate of an ordinary substep, of the memory that the rule leaves there.
   pure subroutine begin_ordinary(par, r, dragged, it)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: r(6)
      logical, intent(in) :: dragged   !< The process took its beginning along in the substep before.
      type(integration_t), intent(inout) :: it

      if (.not. it%known) then
         call first_rate(par, it)
      else if (dragged) then
         call rate_at_beginning(par, it)
      end if
      call apply_memory_rule(par, r, it)
      it%trial%advanced = it%state%memory%x_running > 0.0_wp .or. it%trial%w(1)%x > 0.0_wp .or. &
                          it%event == EVENT_FORWARDS
   end subroutine begin_ordinary

   !> The trial begins with the memory that the point has.
   pure subroutine take_memory(par, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it

      it%trial%r_in = it%state%memory%r_in
      call take_past(par, it%state%memory, it%trial%y0, it%trial%past)
   end subroutine take_memory

   !> The rate where the coming substep begins, of its mode and memory.
   pure subroutine first_rate(par, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it

      call rate_of(par, it%inc, it%trial%time, it%trial%y0, it%trial%r_in, it%trial%mode, it%trial%w(1), it%counters)
   end subroutine first_rate

   !> True after a substep whose last rate is the first of the next, or which is held and does not close at its end.
   !> docs/theory/integration.md section 2.
   pure logical function rate_is_known(it)
      type(integration_t), intent(in) :: it

      rate_is_known = it%event == EVENT_NONE .and. &
                      (it%trial%mode == MODE_HELD .or. &
                       (it%trial%mode == MODE_ORDINARY .and. it%inc%scheme%first_same_as_last))
   end function rate_is_known

   !> Returns and reversals where an ordinary substep begins; the trial holds the rate of the memory that results.
   pure subroutine apply_memory_rule(par, r, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it
      real(wp), intent(in) :: r(6)
      type(memory_t) :: before
      real(wp) :: t(6)
      logical :: noise

      t = elastic_rate(it%inc, it%trial%w(1), r)
      call try_to_return(par, it%event == EVENT_RETURN, r, t, it)
      if (.not. it%trial%w(1)%loading) return
      if (it%event /= EVENT_FORWARDS) then
         if (it%trial%w(1)%x >= 0.0_wp) return
         noise = it%trial%w(1)%x >= -par%x_rev .and. it%event /= EVENT_REVERSAL
         ! At a place that was located x is -x_rev but for rounding: there it was asked at the end of the substep.
         if (.not. noise .and. it%event /= EVENT_REVERSAL) call turns_by_resting( &
            par, it%inc, it%trial, it%trial%time, it%trial%y0, it%counters, noise)
         if (noise) then
            it%counters%held_back = it%counters%held_back + 1
            return
         end if
      end if
      it%counters%reset = it%counters%reset + 1
      before = it%state%memory
      call begin_process(par, r, it%trial%w(1)%n, t, it%state%memory)
      call note_jump(JUMP_REVERSAL, before, it)
      call take_memory(par, it)
      call rate_at_beginning(par, it)
      call try_to_return(par, .false., r, t, it)
   end subroutine apply_memory_rule

   !> The rate where a process begins that the trial has taken over, from that of the memory before, which it holds.
   pure subroutine rate_at_beginning(par, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it

      if (stays_floored(par, it%trial%w(1), it%trial%r_in) .and. .not. past_counts(par)) then
         it%trial%w(1)%r_moved = 0.0_wp
         it%trial%w(1)%x = 0.0_wp
      else
         call first_rate(par, it)
      end if
   end subroutine rate_at_beginning

   !> True where a rate is also that of a process which begins where it stands: with r_in = r the floor acts in every
   !> direction, as it did in this one. So it did in all if r has moved by less than the floor; otherwise the equation
   !> of the floor has one root where no cap acts.
   pure logical function stays_floored(par, w, r_in)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: r_in(6)

      stays_floored = w%floored .and. all(abs(r_in - w%r) <= 0.0_wp)
      if (stays_floored .and. (w%capped_d .or. w%capped_h)) stays_floored = norm(w%r_moved) < par%x_floor
   end function stays_floored

   !> Lets interrupted processes go on whose targets r has reached, and leaves the one to watch in the trial.
   pure subroutine try_to_return(par, landed, r, t, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it
      logical, intent(in) :: landed          !< On the target: rounding does not count.
      real(wp), intent(in) :: r(6), t(6)
      type(memory_t) :: before
      logical :: reached

      if (par%memory_rule /= RULE_RETURN_POINT) return
      reached = landed
      do
         it%trial%watched = watched_process(it%state%memory, t)
         if (it%trial%watched == 0) return
         it%trial%process = it%state%memory%interrupted(it%trial%watched)
         if (.not. reached) reached = beyond_target(par, it%trial%process, r, it%trial%w(1)%m_b) >= 0.0_wp
         if (.not. reached) return
         before = it%state%memory
         call resume_process(it%trial%watched, r, t, it%state%memory)
         call note_jump(JUMP_RETURN, before, it)
         call take_memory(par, it)
         call first_rate(par, it)
         reached = .false.
      end do
   end subroutine try_to_return

   !> A point at p_min stays open while its grains are parted or p' would not rise from there; it closes without memory
   !> of the gap. The trial holds the ordinary rate of a point without a past.
   pure subroutine try_to_close(par, r, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it
      real(wp), intent(in) :: r(6)
      type(memory_t) :: before

      it%trial%watched = 0
      it%inc%rests = .false.
      call forget_compression(it%state)
      if (it%state%open .and. (it%known .or. it%state%gap > 0.0_wp)) then
         it%trial%w(1)%no_root = .false.
      else
         it%trial%r_in = r
         call forget_past(it%trial%y0)
         it%trial%mode = closing_mode(it%inc)
         call first_rate(par, it)
         it%state%open = .not. closes(it%inc, it%trial%openings, it%trial%w(1))
      end if
      if (it%state%open) then
         it%trial%mode = MODE_HELD
         it%trial%parts = parting(par, it%state)
         return
      end if
      before = it%state%memory
      it%state%memory = new_memory(r)
      call take_past(par, it%state%memory, it%trial%y0, it%trial%past)
      call note_jump(JUMP_NEW, before, it)
   end subroutine try_to_close

   !> Takes over an accepted substep; state already has its void ratio and suction. With the tension cut-off on, a mean
   !> stress that landed below p_min is set to p_min. docs/theory/memory-rules.md section 3.2.
   pure subroutine accept_substep(par, h, it)
      type(params_t), intent(in) :: par
      type(integration_t), intent(inout) :: it
      real(wp), intent(in) :: h             !< size of the substep [-]
      real(wp) :: p, r(6)

      it%counters%substep = it%counters%substep + 1
      it%state%sigma = it%trial%y(1:6)
      if (it%trial%mode == MODE_HELD) then
         it%counters%open = it%counters%open + 1
         it%state%gap = gap_at(it%state%e, it%trial%parts)
         return
      end if
      it%state%z = it%trial%y(Y_Z:Y_Z_END)
      it%state%eps_q_total = it%state%eps_q_total + it%trial%y(Y_SHEAR)
      call keep_numbers(par, it%trial%y0, it%trial%y, it%state)
      call keep_compression(par, it%inc, it%trial, h, it%state)
      it%state%sigma = landed(par, it%state%sigma)
      call event_happened(it%event, it%trial, it%state)
      if (it%trial%drifts) then
         call stress_ratio(par, it%state%sigma, p, r)
         call drag_process(r, it%trial%y(Y_SHEAR), it%state%memory)
      else if (it%trial%mode == MODE_ORDINARY) then
         associate (w => it%trial%w(latest_forwards(it)))
            call accept_process(w%loading, w%x, it%trial%y(Y_SHEAR), it%state%memory)
         end associate
         if (par%memory_rule == RULE_RETURN_POINT) then
            call note_turning_point(par, h, it)
         end if
      end if
   end subroutine accept_substep

   !> The stage that tells how far a process has come: the last one of an ordinary substep, if it stands at its end and
   !> no turn lies in between, otherwise the first.
   pure integer function latest_forwards(it) result(stage)
      type(integration_t), intent(in) :: it

      stage = 1
      if (.not. it%inc%scheme%first_same_as_last) return
      associate (last => it%trial%w(it%inc%scheme%stages))
         if (last%loading .and. last%x >= 0.0_wp) stage = it%inc%scheme%stages
      end associate
   end function latest_forwards
end module mud_transitions
