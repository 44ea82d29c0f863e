! SPDX-License-Identifier: MIT
!> The substeps of a phase: their sizes, and what an attempt leaves.
module mud_substepping
   use mud_kinds, only: wp
   use mud_error_control, only: control_t, judge_attempt, proposal
   use mud_event, only: EVENT_NONE
   use mud_events, only: stop_at_event
   use mud_increment, only: increment_t, void_ratio_at, suction_at, direction_at
   use mud_integration, only: integration_t, record
   use mud_landing, only: EVENT_TOLERANCE
   use mud_order, only: choose_order, next_size, LAST_SLIVER
   use mud_params, only: params_t
   use mud_registry, only: SCHEME_AUTOMATIC
   use mud_status, only: fail, MUD_MINIMUM_STEP, MUD_TOO_MANY_SUBSTEPS, MUD_NO_DIRECTION, MUD_NOT_FINITE, &
      ON_STRESS, MUD_OK
   use mud_rates, only: MODE_ORDINARY
   use mud_tensor, only: ddot, is_finite, all_finite
   use mud_trace, only: SUBSTEP_REJECTED, SUBSTEP_ACCEPTED, SUBSTEP_FAILED
   use mud_transient, only: find_transient
   use mud_transitions, only: accept_substep, rate_is_known
   use mud_trial, only: take_step, error_norm
   implicit none (type, external)
   private
   public :: stepping_t, begin_phase, try_substep, plan_attempt, judge, end_substep, end_phase

   !> Steps of a phase: sizes are shares of the increment, with the scheme automatic those of third order [-].
   type :: stepping_t
      real(wp) :: h          !< Size of the next attempt; after an accepted one that of the next substep.
      real(wp) :: planned    !< Before the phase cut it short, in units of strain, 0: none.
      real(wp) :: error      !< Error of the last attempt.
      real(wp) :: factor     !< Factor on the size that this error allows.
      logical :: may_grow    !< No attempt at this substep was rejected.
      logical :: turns       !< The elastic domain turns sharply: third order.
      logical :: divides     !< Sizes divided the rest before the last piece without length.
      integer :: elastic     !< Substeps without a direction so far.
      type(control_t) :: control
   end type stepping_t

   !> Part of a substep below which what an event leaves of it has no length [-]; where a process begins by drifting
   !> back, rounding of the place where it begins leaves some.
   real(wp), parameter :: NO_LENGTH = 1.0e-6_wp, NO_DRIFT = 1.0e-3_wp
   !> Turn of the domain, some degrees, from which on the higher order follows it: it is a transient that modified Euler
   !> pays for with many substeps, and whose errors add up along turning paths [-].
   real(wp), parameter :: SHARP = 1.0e-3_wp
   !> The rest of a phase is divided into a whole number of pieces up to FEW, beyond into a power of the FEW-th root of
   !> 2. A piece may be STRETCHED times as long as error control proposes, whose margin is a tenth [-].
   real(wp), parameter :: FEW = 6.0_wp, STRETCHED = 1.06_wp
   !> First substep where the domain turns sharply, share of its radius: a divisor of few round increments. It is
   !> longer, in inverse proportion to the angle, below NARROW, the root of 1 minus its cosine: what the fading parts of
   !> the rates leave is of the angle's third power [-].
   real(wp), parameter :: TURN_PIECE = 0.7_wp, NARROW = 0.12_wp
contains
   !> The phase of it%inc begins. docs/theory/integration.md section 1.
   pure subroutine begin_phase(par, step, it)
      type(params_t), intent(in) :: par
      type(stepping_t), intent(out) :: step
      type(integration_t), intent(inout) :: it

      it%known = .false.
      it%event = EVENT_NONE
      it%trial%pressed = .false.
      it%trial%relaxation%speed = 0.0_wp
      it%trial%transient%sought = .false.
      it%trial%transient%known = .false.
      it%trial%openings = 0
      it%trial%drifts = .false.
      step = first_step(par, it)
   end subroutine begin_phase

   !> Attempts at a substep that has begun until one has an error that is allowed. Errors in it%status:
   !> MUD_TOO_MANY_SUBSTEPS, MUD_MINIMUM_STEP, MUD_NOT_FINITE; the state is then that of its start.
   !> docs/theory/integration.md sections 2, 3.
   pure subroutine try_substep(par, step, h, it)
      type(params_t), intent(in) :: par
      type(stepping_t), intent(inout) :: step
      real(wp), intent(out) :: h               !< size of the last one, a share of the increment [-]
      type(integration_t), intent(inout) :: it
      logical :: ended

      ended = .false.
      do while (.not. ended)
         call plan_attempt(par, step, h, it)
         if (it%status%code /= MUD_OK) return
         if (it%trial%relaxation%speed > 0.0_wp) then
            it%trial%transient%known = .false.
         else if (it%trial%mode == MODE_ORDINARY) then
            call find_transient(par, it%inc, it%trial%time, h, it%trial%y0, it%trial%r_in, it%trial%w(1), &
                                it%trial%transient, it%counters)
         end if
         call take_step(par, it%inc, h, it%trial, it%counters)
         call judge(par, h, step, it, ended)
      end do
   end subroutine try_substep

   !> Size h and pair of an attempt.
   pure subroutine plan_attempt(par, step, h, it)
      type(params_t), intent(in) :: par
      type(stepping_t), intent(inout) :: step
      real(wp), intent(out) :: h
      type(integration_t), intent(inout) :: it
      real(wp) :: rest

      rest = it%inc%to - it%trial%time
      it%event = EVENT_NONE
      h = min(step%h, rest)
      if (it%counters%substep + it%counters%reject >= par%max_substeps) then
         it%status = fail(MUD_TOO_MANY_SUBSTEPS, value=real(par%max_substeps, wp))
         return
      end if
      step%h = max(step%h, par%h_min)
      call choose_order(par, rest, step%h, merge(0.0_wp, par%second_share, step%turns), it%inc, it%trial)
      h = step%h
      if (it%trial%divides .and. h < rest) h = max(rest/number_of_pieces(rest/h), par%h_min)
      if (h*(1.0_wp + LAST_SLIVER) >= rest) h = rest
   end subroutine plan_attempt

   !> Whether an attempt h was the last one: its error is allowed, or it failed.
   pure subroutine judge(par, h, step, it, ended)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: h
      type(stepping_t), intent(inout) :: step
      type(integration_t), intent(inout) :: it
      logical, intent(out) :: ended
      real(wp) :: tolerance

      ended = .true.
      step%error = error_norm(par, it%inc%scheme, it%trial, h)
      if (.not. all_finite(it%trial%y) .or. .not. is_finite(step%error)) then
         it%status = fail(MUD_NOT_FINITE, ON_STRESS)
         call record(h, step%error, it%trial%y(1:6), SUBSTEP_FAILED, it)
         return
      end if
      call judge_attempt(par, it%inc, it%trial, h, step%error, step%may_grow, step%control, tolerance, step%factor)
      if (step%error <= tolerance) return
      if (min(step%h, h) <= par%h_min*(1.0_wp + LAST_SLIVER)) then
         if (par%guarded) then
            it%status = fail(MUD_MINIMUM_STEP, value=step%error, lower=0.0_wp, upper=par%tolerance)
            call record(h, step%error, it%trial%y(1:6), SUBSTEP_FAILED, it)
         else
            it%counters%min_step = it%counters%min_step + 1
            step%factor = 1.0_wp
         end if
         return
      end if
      ended = .false.
      it%counters%reject = it%counters%reject + 1
      call record(h, step%error, it%trial%y(1:6), SUBSTEP_REJECTED, it)
      step%may_grow = .false.
      step%h = next_size(par, it%inc, it%trial, h, min(step%factor, 0.9_wp), .false.)
      step%planned = step%h*it%size
   end subroutine judge

   !> Number of pieces of the rest of a phase for the number n that error control proposes [-]. It is one of few, so
   !> that a small change of the increment does not change the sizes of its substeps, as shares of the rest: the
   !> consistent tangent freezes these, and where errors grow from substep to substep that would show.
   !> docs/theory/integration.md section 3.
   pure real(wp) function number_of_pieces(n) result(pieces)
      real(wp), intent(in) :: n

      if (n <= FEW) then
         pieces = real(ceiling(n/STRETCHED), wp)
      else
         pieces = 2.0_wp**(real(nint(FEW*log(n)/log(2.0_wp)), wp)/FEW)
      end if
   end function number_of_pieces

   !> Ends a substep h at the first event in it, and takes it over. MUD_NO_DIRECTION in it%status: the second without a
   !> direction in a phase; the state is then that of its start. docs/theory/integration.md sections 2 to 4.
   pure subroutine end_substep(par, step, h, it)
      type(params_t), intent(in) :: par
      type(stepping_t), intent(inout) :: step
      real(wp), intent(inout) :: h             !< size, a share of the increment [-]
      type(integration_t), intent(inout) :: it
      real(wp) :: time, whole, tried

      whole = h
      tried = step%h
      step%may_grow = .true.
      step%h = next_size(par, it%inc, it%trial, h, step%factor, h >= it%inc%to - it%inc%from)
      call stop_at_event(par, step%error, h, it)
      ! Rounding decides whether the event that ended the substep before is met again, and whether a process that begins
      ! there drifts first: such a piece has no length, and the substep after it is as long as it would be without.
      if (h >= merge(NO_DRIFT, NO_LENGTH, it%trial%drifts)*whole) then
         step%divides = it%trial%divides
      else
         step%h = min(step%h, tried)
         if (it%trial%drifts) it%trial%divides = step%divides
      end if
      if (it%trial%w(1)%no_root) step%elastic = step%elastic + 1
      if (step%elastic > 1 .and. par%guarded) then
         it%status = fail(MUD_NO_DIRECTION)
         call record(h, step%error, it%trial%y(1:6), SUBSTEP_FAILED, it)
         return
      end if
      time = it%trial%time + h
      if (it%inc%to - time < EVENT_TOLERANCE) time = it%inc%to
      if (time < it%inc%to) step%planned = step%h*it%size
      it%reached = time
      it%state%e = void_ratio_at(it%inc, time)
      it%state%p_c = suction_at(it%inc, time)
      call accept_substep(par, h, it)
      call record(h, step%error, it%state%sigma, SUBSTEP_ACCEPTED, it)
      it%known = rate_is_known(it)
   end subroutine end_substep

   !> The phase of it%inc is over: the state keeps the size of substeps. docs/theory/integration.md section 3.
   pure subroutine end_phase(step, it)
      type(stepping_t), intent(in) :: step
      type(integration_t), intent(inout) :: it

      if (.not. it%inc%inside) it%state%last_step = proposal(it%inc, step%planned, step%h*it%size, step%factor)
   end subroutine end_phase

   !> The steps with which a phase begins.
   pure function first_step(par, it) result(step)
      type(params_t), intent(in) :: par
      type(integration_t), intent(in) :: it
      type(stepping_t) :: step
      real(wp) :: length, turn, share, pieces, piece

      length = it%inc%to - it%inc%from
      turn = turn_of(it%inc)
      step%turns = turn > SHARP
      step%may_grow = .true.
      step%divides = it%trial%divides
      step%elastic = 0
      step%planned = it%state%last_step
      ! of the pair that is tried first
      share = merge(par%second_share, 1.0_wp, par%scheme == SCHEME_AUTOMATIC .and. .not. step%turns)
      step%h = length/share
      ! an elastic phase goes in one step if it can, and leaves the remembered step to the next plastic one
      if (it%state%last_step > 0.0_wp .and. .not. it%inc%inside) step%h = min(step%h, it%state%last_step/it%size)
      ! a whole number of pieces, so that a small change of the strain does not change their size
      if (step%turns) then
         piece = TURN_PIECE*it%inc%rho*max(NARROW/sqrt(turn), 1.0_wp)
         pieces = real(ceiling(min(length*it%inc%length/piece, 1.0e6_wp)), wp)
         step%h = min(step%h, length/(share*pieces))
      end if
   end function first_step

   !> Turn of the elastic domain in the phase, 1 minus its cosine with the strain: the transient lasts about a radius of
   !> strain.
   pure real(wp) function turn_of(inc)
      type(increment_t), intent(in) :: inc
      real(wp) :: length

      turn_of = 0.0_wp
      if (inc%rho <= 0.0_wp .or. inc%inside .or. inc%straight) return
      length = inc%length
      if (length > 0.0_wp) turn_of = 1.0_wp - ddot(direction_at(inc, inc%from), inc%d_strain)/length
   end function turn_of
end module mud_substepping
