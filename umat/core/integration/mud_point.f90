!> One increment at one integration point: substeps of rates, with the jumps of memory between them.
module mud_point
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_registry, only: RULE_AS_PUBLISHED
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_INPUT, MUD_BAD_VOID_RATIO, MUD_MINIMUM_STEP, &
      MUD_TOO_MANY_SUBSTEPS, MUD_NO_DIRECTION, MUD_VOID_RATIO_LIMIT, MUD_NOT_FINITE, MUD_INCREMENT_TOO_LARGE, &
      ON_STRESS, ON_STRAIN, ON_SUCTION, ON_VOID_RATIO
   use mud_tensor, only: IDENTITY, SHEAR_WEIGHT, ddot, trace, deviator, norm, outer_add, is_finite
   use mud_bonding, only: is_bonded
   use mud_elastic, only: bulk_modulus, shear_modulus
   use mud_retention, only: saturation_t, saturation
   use mud_rates, only: rate_t, stress_ratio, MODE_ORDINARY, MODE_ELASTIC
   use mud_reversal, only: new_memory, reseat, accept_process, turns_back, begin_way_back, leave_way_back, &
      way_back_distance, resume_process
   use mud_state, only: memory_t, state_t, counters_t, E_LOWER, E_UPPER
   use mud_nucleus, only: exit_share, loading_direction
   use mud_substep, only: SCHEMES, step_factor
   use mud_increment, only: increment_t, trial_t, void_ratio_at, suction_at, rate_of, take_step, error_norm, limited, &
      state_parameter, has_aside, beyond_bounding, NY, MODE_HELD, MODE_NUCLEUS
   use mud_consistent, only: sensitivity_t, no_sensitivity, enter_nucleus, leave_nucleus, propagate, jump_of_memory, &
      JUMP_NONE, JUMP_RESEAT, JUMP_RESUME, JUMP_NEW
   use mud_tangent, only: continuum_tangent, elastic_tangent
   use mud_trace, only: trace_t, record_substep, SUBSTEP_REJECTED, SUBSTEP_ACCEPTED, SUBSTEP_FAILED
   implicit none (type, external)
   private
   public :: blocks_t, initial_state, update_point, TANGENT_NONE, TANGENT_ELASTIC, TANGENT_CONTINUUM, TANGENT_CONSISTENT

   integer, parameter :: TANGENT_NONE = 0, TANGENT_ELASTIC = 1, TANGENT_CONTINUUM = 2, &
                         TANGENT_CONSISTENT = 3

   real(wp), parameter :: LARGEST_STRAIN = 1.0_wp            !< Larger increments are asked to be cut [-].
   real(wp), parameter :: LAST_SLIVER = 1.0e-9_wp            !< A rest of this share joins the substep before it [-].
   real(wp), parameter :: AT_LIMIT = 1.0e-9_wp               !< p' this close (relative) to p_min is at p_min [-].
   !> At a low stress an elastic strain of rho_e may be more than the whole strength: r may exceed the bounding surface
   !> by this share. Softening sand is some per cent beyond it and must be able to return where it came from [-].
   real(wp), parameter :: EXCESS = 0.2_wp
   real(wp), parameter :: WHOLE_PHASE = 1.0e-9_wp            !< A phase shorter than this share is left out [-].
   !> Width of the bracket of an event, share of increment [-].
   real(wp), parameter :: EVENT_TOLERANCE = 1.0e-13_wp
   integer, parameter :: MAX_EVENT_ITERATIONS = 100          !< Bisection alone needs about 45.

   !> An open point closes when p' would rise by this share of the elastic rate: opening and closing at the same rate
   !> would chatter where the two pull the stress ratio to opposite sides [-].
   real(wp), parameter :: CLOSING = 0.01_wp
   integer, parameter :: EVENT_OPENS = 1     !< p' falls to p_min.
   integer, parameter :: EVENT_ARRIVES = 2   !< An elastic way back reaches the turning point.
   integer, parameter :: EVENT_CLOSES = 3    !< p' would rise from p_min.
   integer, parameter :: EVENT_BOUNDS = 4    !< r exceeds the bounding surface inside the elastic nucleus.
   real(wp), parameter :: EVENT_RESIDUAL = 1.0e-13_wp        !< An event's function this small is zero [-].

   !> Tangent blocks, compression positive, with engineering shear strain.
   type :: blocks_t
      real(wp) :: dsig_deps(6, 6)   !< d sigma'/d eps [kPa]
      real(wp) :: dsig_dpc(6)       !< d sigma'/d p_c [-]
      real(wp) :: dsw_dev           !< d S_w/d eps_v [-]
      real(wp) :: dsw_dpc           !< d S_w/d p_c [1/kPa]
   end type blocks_t

contains
   !> State of a point that starts at a stress, a void ratio and a suction without a past. A mean stress below p_min is
   !> lifted to p_min, its stress ratio limited to the bounding surface.
   pure subroutine initial_state(par, sigma, e, p_c, state, status)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), e, p_c   !< [kPa, -, kPa], compression positive
      type(state_t), intent(out) :: state
      type(mud_status_t), intent(out) :: status
      real(wp) :: p, r(6)

      call check_stress(par, sigma, p_c, status)
      if (status%code /= MUD_OK) return
      if (.not. is_finite(e)) then
         status = fail(MUD_BAD_VOID_RATIO, ON_VOID_RATIO, 0, e, E_LOWER, E_UPPER)
         return
      end if
      if (e <= E_LOWER .or. e >= E_UPPER) then
         status = fail(MUD_BAD_VOID_RATIO, ON_VOID_RATIO, 0, e, E_LOWER, E_UPPER)
         return
      end if
      state%sigma = sigma
      state%e = e
      state%p_c = p_c
      state%z = 0.0_wp
      state%nucleus = 0.0_wp
      state%eps_q_total = 0.0_wp
      state%last_step = 0.0_wp
      state%open = .false.
      call lift_to_limit(par, is_bonded(par, p_c), state)
      call stress_ratio(par, state%sigma, p, r)
      state%memory = new_memory(r)
      call finish_state(par, state)
   end subroutine initial_state

   !> Integrates d_strain and d_pc. On failure state1 and blocks are undefined and state0 is what it was.
   pure subroutine update_point(par, state0, d_strain, d_pc, tangent, state1, blocks, counters, reached, status, &
                                record)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state0
      real(wp), intent(in) :: d_strain(6)         !< tensor shear, compression positive [-]
      real(wp), intent(in) :: d_pc                !< [kPa]
      integer, intent(in) :: tangent              !< TANGENT_*
      type(state_t), intent(inout) :: state1
      type(blocks_t), intent(inout) :: blocks     !< untouched for TANGENT_NONE, but for the S_w blocks
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: reached            !< share of the increment integrated [-]
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      type(increment_t) :: inc
      type(trial_t) :: trial
      type(sensitivity_t) :: sens
      real(wp) :: size, k, g, p, r(6)
      logical :: consistent

      reached = 0.0_wp
      call check_increment(par, state0, d_strain, d_pc, status)
      if (status%code /= MUD_OK) return
      inc%d_strain = d_strain
      inc%d_pc = d_pc
      inc%p_c0 = state0%p_c
      inc%e0 = state0%e
      inc%d_v = trace(d_strain)
      inc%bonded = is_bonded(par, max(state0%p_c, state0%p_c + d_pc))
      inc%scheme = SCHEMES(par%scheme)
      inc%rho = par%rho_e
      inc%inside = .false.
      inc%from = 0.0_wp
      inc%length = 1.0_wp
      if (void_ratio_at(inc, 1.0_wp) <= E_LOWER .or. void_ratio_at(inc, 1.0_wp) >= E_UPPER) then
         status = fail(MUD_VOID_RATIO_LIMIT, ON_VOID_RATIO, 0, void_ratio_at(inc, 1.0_wp), E_LOWER, E_UPPER)
         return
      end if

      state1 = state0
      if (par%cutoff) call lift_to_limit(par, inc%bonded, state1)
      call stress_ratio(par, state1%sigma, p, r)
      k = bulk_modulus(par, state1%e, p)
      size = norm(d_strain) + abs(d_pc)/k
      consistent = tangent == TANGENT_CONSISTENT .and. size > 0.0_wp
      if (consistent) sens = no_sensitivity()
      if (size > 0.0_wp) then
         if (par%rho_e > 0.0_wp) then
            call integrate_phases(par, inc, size, consistent, state1, trial, sens, counters, reached, status, record)
         else
            call integrate(par, inc, size, consistent, state1, trial, sens, counters, reached, status, record)
         end if
      end if
      if (status%code /= MUD_OK) return
      reached = 1.0_wp
      state1%e = void_ratio_at(inc, 1.0_wp)
      state1%p_c = state0%p_c + d_pc
      call finish_state(par, state1, blocks)
      if (has_tension(state1%sigma)) counters%tensile = 1

      select case (tangent)
      case (TANGENT_NONE)
         continue
      case (TANGENT_CONTINUUM, TANGENT_CONSISTENT)
         if (consistent) then
            blocks%dsig_deps = sens%y(1:6, 1:6)
            blocks%dsig_dpc = sens%y(1:6, 7)
            return
         end if
         if (size > 0.0_wp) then
            blocks%dsig_deps = 0.0_wp   ! an open point has no stiffness
            blocks%dsig_dpc = 0.0_wp
            if (trial%mode /= MODE_HELD) then
               call continuum_tangent(par, trial%w(inc%scheme%stages), blocks%dsig_deps, blocks%dsig_dpc)
               if (has_aside(inc, trial%mode)) then
                  call project(inc, trial%mode, trial%w(inc%scheme%stages), blocks%dsig_deps)
               end if
            end if
            return
         end if
         blocks%dsig_deps = elastic_tangent(k, shear_modulus(par, state1%e, p))
         blocks%dsig_dpc = 0.0_wp
      case default
         call stress_ratio(par, state1%sigma, p, r)
         k = bulk_modulus(par, state1%e, p)
         g = shear_modulus(par, state1%e, p)
         blocks%dsig_deps = elastic_tangent(k, g)
         blocks%dsig_dpc = 0.0_wp
      end select
   end subroutine update_point

   !> An increment with an elastic nucleus: a phase inside it, then one that pulls it along; either may be empty. On
   !> return inc is the phase that ended the increment.
   pure subroutine integrate_phases(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc
      real(wp), intent(in) :: size
      logical, intent(in) :: consistent
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(sensitivity_t), intent(inout) :: sens
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: reached
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      type(increment_t) :: whole
      real(wp) :: share

      whole = inc
      whole%nucleus = state%nucleus
      if (norm(state%nucleus) > inc%rho) whole%nucleus = (inc%rho/norm(state%nucleus))*state%nucleus
      share = exit_share(inc%rho, whole%nucleus, inc%d_strain)
      if (share < WHOLE_PHASE) share = 0.0_wp
      if (1.0_wp - share < WHOLE_PHASE) share = 1.0_wp

      if (share > 0.0_wp) then
         inc = phase(whole, 0.0_wp, share)
         inc%inside = .true.
         if (consistent) call enter_nucleus(whole, share, sens)
         call integrate(par, inc, share*size, consistent, state, trial, sens, counters, reached, status, record)
         reached = share*reached
         if (status%code /= MUD_OK) return
      end if
      state%nucleus = whole%nucleus + share*whole%d_strain
      if (share < 1.0_wp) then
         inc = phase(whole, share, 1.0_wp)
         inc%nucleus = (inc%rho/norm(state%nucleus))*state%nucleus
         if (consistent) call leave_nucleus(whole, share, sens)
         call integrate(par, inc, (1.0_wp - share)*size, consistent, state, trial, sens, counters, reached, status, &
                        record)
         reached = share + (1.0_wp - share)*reached
         state%nucleus = inc%rho*loading_direction(inc%rho, inc%nucleus, inc%d_strain, 1.0_wp)
      end if
   end subroutine integrate_phases

   !> The part of an increment between two pseudo-times as an increment of its own.
   pure function phase(whole, from, to) result(inc)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: from, to
      type(increment_t) :: inc

      inc = whole
      inc%from = from
      inc%length = to - from
      inc%d_strain = (to - from)*whole%d_strain
      inc%d_v = (to - from)*whole%d_v
      inc%d_pc = (to - from)*whole%d_pc
      inc%e0 = void_ratio_at(whole, from)
      inc%p_c0 = suction_at(whole, from)
   end function phase

   !> Tangent of a rate of which only the strain along nu loads (inside the nucleus none does), the rest being elastic.
   pure subroutine project(inc, mode, w, c)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      type(rate_t), intent(in) :: w
      real(wp), intent(inout) :: c(6, 6)
      real(wp) :: nu(6), along(6), elastic(6, 6)

      elastic = elastic_tangent(w%k, w%g)
      along = 0.0_wp
      nu = 0.0_wp
      if (mode /= MODE_NUCLEUS) then
         nu = loading_direction(inc%rho, inc%nucleus, inc%d_strain, 1.0_wp)
         along = matmul(c - elastic, SHEAR_WEIGHT*nu)
      end if
      c = elastic
      call outer_add(along, nu, c)
   end subroutine project

   !> The loop over substeps.
   pure subroutine integrate(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: size                !< of the increment, in units of strain [-]
      logical, intent(in) :: consistent           !< derivatives are wanted
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial       !< the last accepted substep
      type(sensitivity_t), intent(inout) :: sens
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: reached
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      real(wp) :: time, h, h_taken, error, factor, p, r(6)
      type(memory_t) :: before
      type(rate_t) :: trigger
      integer :: elastic_substeps, jump
      logical :: may_grow, crossed, known

      time = 0.0_wp
      h = 1.0_wp
      ! an elastic phase goes in one step if it can, and leaves the remembered step to the next plastic one
      if (state%last_step > 0.0_wp .and. state%last_step < size .and. .not. inc%inside) h = state%last_step/size
      may_grow = .true.
      elastic_substeps = 0
      known = .false.
      trial%pressed = .false.
      substeps: do while (time < 1.0_wp)
         reached = time
         trial%time = time
         trial%y0(1:6) = state%sigma
         trial%y0(7:12) = state%z
         trial%y0(13) = 0.0_wp
         if (consistent) before = state%memory
         call begin_substep(par, inc, known, state, trial, trigger, jump, counters)
         if (consistent .and. jump /= JUMP_NONE) then
            call jump_of_memory(par, inc, jump, before, state%memory, trigger, trial, sens)
         end if
         attempts: do
            if (counters%substep + counters%reject >= par%max_substeps) then
               status = fail(MUD_TOO_MANY_SUBSTEPS, value=real(par%max_substeps, wp))
               return
            end if
            h = max(h, par%h_min)
            h_taken = h
            if (time + h*(1.0_wp + LAST_SLIVER) >= 1.0_wp) h_taken = 1.0_wp - time
            call take_step(par, inc, h_taken, trial, counters)
            error = error_norm(par, inc%scheme, trial, h_taken)
            if (.not. all(is_finite(trial%y)) .or. .not. is_finite(error)) then
               status = fail(MUD_NOT_FINITE, ON_STRESS)
               call record_substep(par, inc, trial, h_taken, error, trial%y(1:6), SUBSTEP_FAILED, jump, .false., &
                                   counters, record)
               return
            end if
            factor = step_factor(inc%scheme, error, par%tolerance, may_grow)
            if (error <= par%tolerance) exit attempts
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
         end do attempts
         may_grow = .true.

         h = h_taken*factor
         call stop_at_event(par, inc, state%memory, h_taken, trial, counters, crossed)
         if (trial%w(1)%no_root) elastic_substeps = elastic_substeps + 1
         if (elastic_substeps > 1 .and. par%memory_rule /= RULE_AS_PUBLISHED) then
            status = fail(MUD_NO_DIRECTION)
            call record_substep(par, inc, trial, h_taken, error, trial%y(1:6), SUBSTEP_FAILED, jump, crossed, &
                                counters, record)
            return
         end if
         time = time + h_taken
         if (1.0_wp - time < EVENT_TOLERANCE) time = 1.0_wp
         state%e = void_ratio_at(inc, time)
         state%p_c = suction_at(inc, time)
         if (consistent) call propagate(par, inc, trial, h_taken, sens)
         call accept_substep(par, trial, state, counters)
         call record_substep(par, inc, trial, h_taken, error, state%sigma, SUBSTEP_ACCEPTED, jump, crossed, &
                             counters, record)
         known = inc%scheme%first_same_as_last .and. trial%mode == MODE_ORDINARY .and. .not. crossed
         if (crossed .and. trial%mode == MODE_ELASTIC) then
            call stress_ratio(par, state%sigma, p, r)
            if (way_back_distance(state%memory, r) >= 0.0_wp) then
               call resume_process(state%memory)
               sens%r_in = sens%r_before
            end if
         end if
      end do substeps
      if (.not. inc%inside) state%last_step = h*size
      reached = 1.0_wp
   end subroutine integrate

   !> Decides what the coming substep is - ordinary, elastic way back or held by the tension cut-off - applies the
   !> memory rule, and leaves the first rate in the trial.
   pure subroutine begin_substep(par, inc, known, state, trial, trigger, jump, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      logical, intent(in) :: known   !< The trial's last rate is that of this point.
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(rate_t), intent(inout) :: trigger   !< The rate that made the memory jump.
      integer, intent(out) :: jump             !< JUMP_*
      type(counters_t), intent(inout) :: counters
      real(wp) :: p, r(6), outwards

      jump = JUMP_NONE
      call stress_ratio(par, state%sigma, p, r)
      trial%mode = MODE_ORDINARY
      trial%r_in = state%memory%r_in
      if (state%open) then
         call try_to_close(par, inc, r, state, trial, counters)
         if (.not. state%open) jump = JUMP_NEW
         return
      end if

      if (inc%inside .and. .not. trial%pressed) then
         trial%mode = MODE_NUCLEUS
         call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
         outwards = (2.0_wp*trial%w(1)%g)*ddot(inc%d_strain, r) - (trial%w(1)%k*inc%d_v)*ddot(r, r)
         if (outwards > 0.0_wp) trial%pressed = beyond_bounding(par, inc, trial%time, p, r) >= EXCESS
         if (trial%pressed) trial%mode = MODE_ORDINARY
      end if

      if (state%memory%suspended .and. trial%mode == MODE_ORDINARY) then
         trial%mode = MODE_ELASTIC
         call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
         if (turns_back(state%memory, trial%w(1)%t)) then
            if (way_back_distance(state%memory, r) < 0.0_wp) then
               call begin_way_back(state%memory, r)
            else
               call resume_process(state%memory)
               jump = JUMP_RESUME
               trial%mode = MODE_ORDINARY
            end if
         else
            trial%mode = MODE_ORDINARY
         end if
      end if

      trial%r_in = state%memory%r_in
      if (trial%mode == MODE_ORDINARY) then
         if (known) then
            trial%w(1) = trial%w(inc%scheme%stages)
         else
            call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
         end if
         if (trial%w(1)%loading .and. trial%w(1)%x < 0.0_wp) then
            if (trial%w(1)%x < -par%x_rev) then
               counters%reseat = counters%reseat + 1
               jump = JUMP_RESEAT
               trigger = trial%w(1)
               call reseat(par, r, trial%w(1)%n, trial%w(1)%t, state%memory)
               trial%r_in = state%memory%r_in
               call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
            else
               counters%hysteresis = counters%hysteresis + 1
            end if
         end if
      end if

      if (par%cutoff .and. trial%w(1)%d_p <= 0.0_wp) then
         if (trace(state%sigma) <= 3.0_wp*par%p_min*(1.0_wp + AT_LIMIT)) then
            call try_to_close(par, inc, r, state, trial, counters)
            if (.not. state%open) jump = JUMP_NEW
         end if
      end if
   end subroutine begin_substep

   !> A point at p_min stays open while p' would not rise from there; it closes without memory of the gap. The trial
   !> holds the ordinary rate of a point without a past.
   pure subroutine try_to_close(par, inc, r, state, trial, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: r(6)
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters

      trial%r_in = r
      trial%mode = MODE_ORDINARY
      call rate_of(par, inc, trial%time, trial%y0, trial%r_in, trial%mode, trial%w(1), counters)
      state%open = rise(inc, trial%w(1)) <= CLOSING
      if (state%open) then
         trial%mode = MODE_HELD
      else
         state%memory = new_memory(r)
      end if
   end subroutine try_to_close

   !> Rate of p' as a share of what the increment could do elastically [-].
   pure real(wp) function rise(inc, w)
      type(increment_t), intent(in) :: inc
      type(rate_t), intent(in) :: w

      rise = w%d_p/(w%k*norm(inc%d_strain) + abs(inc%d_pc))
   end function rise

   !> Takes over an accepted substep; state already has its void ratio and suction.
   pure subroutine accept_substep(par, trial, state, counters)
      type(params_t), intent(in) :: par
      type(trial_t), intent(in) :: trial
      type(state_t), intent(inout) :: state
      type(counters_t), intent(inout) :: counters
      real(wp) :: p, r(6)

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
      if (trial%mode == MODE_ELASTIC) then
         call stress_ratio(par, state%sigma, p, r)
         call leave_way_back(state%memory, r)
      else if (trial%mode /= MODE_NUCLEUS) then
         call accept_process(par, trial%w(1)%loading, trial%w(1)%x, trial%w(1)%n, trial%y(13), state%memory)
      end if
   end subroutine accept_substep

   !> Shortens an accepted substep so that it lands where p' reaches p_min, where an elastic way back arrives, where a
   !> held point would close, or where r would go too far inside the nucleus.
   pure subroutine stop_at_event(par, inc, memory, h, trial, counters, crossed)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(memory_t), intent(in) :: memory
      real(wp), intent(inout) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      logical, intent(out) :: crossed      !< the last event looked for in this mode happened

      crossed = .false.
      select case (trial%mode)
      case (MODE_HELD)
         call land_on(par, inc, EVENT_CLOSES, memory, h, trial, counters, crossed)
      case (MODE_ELASTIC, MODE_NUCLEUS)
         if (par%cutoff) call land_on(par, inc, EVENT_OPENS, memory, h, trial, counters, crossed)
         call land_on(par, inc, merge(EVENT_ARRIVES, EVENT_BOUNDS, trial%mode == MODE_ELASTIC), memory, h, trial, &
                      counters, crossed)
      case default
         if (par%cutoff) call land_on(par, inc, EVENT_OPENS, memory, h, trial, counters, crossed)
      end select
   end subroutine stop_at_event

   !> Finds the end of the substep where the event's function turns negative (Illinois' variant of false position), and
   !> leaves the trial there, just beyond.
   pure subroutine land_on(par, inc, event, memory, h, trial, counters, crossed)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(memory_t), intent(in) :: memory
      real(wp), intent(inout) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      logical, intent(out) :: crossed
      real(wp) :: low, high, f_low, f_high, f, h_trial
      integer :: iteration

      call event_function(par, inc, event, memory, trial, trial%time + h, trial%y, counters, f_high)
      crossed = f_high < 0.0_wp
      if (.not. crossed) return
      call event_function(par, inc, event, memory, trial, trial%time, trial%y0, counters, f_low)
      low = 0.0_wp
      high = h
      h_trial = h
      do iteration = 1, MAX_EVENT_ITERATIONS
         if (high - low <= EVENT_TOLERANCE .or. high <= par%h_min) exit
         if (f_low > 0.0_wp) then
            h_trial = low + (high - low)*f_low/(f_low - f_high)
            h_trial = min(max(h_trial, low + 0.01_wp*(high - low)), high - 0.01_wp*(high - low))
         else
            h_trial = 0.5_wp*(low + high)
         end if
         call take_step(par, inc, h_trial, trial, counters)
         call event_function(par, inc, event, memory, trial, trial%time + h_trial, trial%y, counters, f)
         if (f < 0.0_wp) then
            if (f_low > 0.0_wp .and. high < h) f_low = 0.5_wp*f_low
            high = h_trial
            f_high = f
            if (f > -EVENT_RESIDUAL) exit
         else
            f_high = 0.5_wp*f_high
            low = h_trial
            f_low = f
         end if
      end do
      if (abs(h_trial - high) > 0.0_wp) call take_step(par, inc, high, trial, counters)
      h = high
   end subroutine land_on

   !> Function of an event, dimensionless, negative beyond it.
   pure subroutine event_function(par, inc, event, memory, trial, time, y, counters, f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: event
      type(memory_t), intent(in) :: memory
      type(trial_t), intent(in) :: trial       !< where the substep began
      real(wp), intent(in) :: time, y(NY)
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: f
      type(rate_t) :: w
      real(wp) :: p, r(6)

      select case (event)
      case (EVENT_OPENS)
         f = trace(y(1:6))/(3.0_wp*par%p_min) - 1.0_wp
      case (EVENT_ARRIVES)
         call stress_ratio(par, y(1:6), p, r)
         f = -way_back_distance(memory, r)
      case (EVENT_BOUNDS)
         ! from farther outside it is the ratio at the start that must not be exceeded
         call stress_ratio(par, trial%y0(1:6), p, r)
         f = max(beyond_bounding(par, inc, trial%time, p, r), EXCESS)
         call stress_ratio(par, y(1:6), p, r)
         f = f - beyond_bounding(par, inc, time, p, r)
      case default
         call stress_ratio(par, y(1:6), p, r)
         call rate_of(par, inc, time, y, r, MODE_ORDINARY, w, counters)
         f = CLOSING - rise(inc, w)
      end select
   end subroutine event_function

   !> Mean stress below p_min, as at a free surface: p_min, with a stress ratio on or inside the bounding surface.
   pure subroutine lift_to_limit(par, bonded, state)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      type(state_t), intent(inout) :: state

      if (trace(state%sigma) >= 3.0_wp*par%p_min*(1.0_wp - AT_LIMIT)) return
      state%sigma = par%p_min*(limited(par, bonded, state%e, state%p_c, par%p_min, deviator(state%sigma)/par%p_min) &
                               + IDENTITY)
   end subroutine lift_to_limit

   !> Saturation and state parameter of a state, and the saturation's slopes.
   pure subroutine finish_state(par, state, blocks)
      type(params_t), intent(in) :: par
      type(state_t), intent(inout) :: state
      type(blocks_t), intent(inout), optional :: blocks
      type(saturation_t) :: sat

      sat = saturation(par, state%p_c, state%e)
      state%s_w = sat%s_w
      state%psi = state_parameter(par, is_bonded(par, state%p_c), state%e, state%p_c, &
                                  max(trace(state%sigma)/3.0_wp, par%p_min))
      if (.not. present(blocks)) return
      blocks%dsw_dpc = sat%ds_dpc
      blocks%dsw_dev = -(1.0_wp + state%e)*sat%ds_de
   end subroutine finish_state

   !> True if a principal stress is negative (tensile): Sylvester's criterion fails.
   pure logical function has_tension(s)
      real(wp), intent(in) :: s(6)
      real(wp) :: minor

      minor = s(1)*s(2) - s(4)*s(4)
      has_tension = s(1) < 0.0_wp .or. minor < 0.0_wp .or. &
                    s(3)*minor + 2.0_wp*s(4)*s(5)*s(6) - s(1)*s(6)*s(6) - s(2)*s(5)*s(5) < 0.0_wp
   end function has_tension

   pure subroutine check_stress(par, sigma, p_c, status)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), p_c
      type(mud_status_t), intent(out) :: status
      integer :: i

      do i = 1, 6
         if (within(sigma(i), par%largest_stress)) cycle
         status = fail(MUD_BAD_INPUT, ON_STRESS, i, sigma(i), -par%largest_stress, par%largest_stress)
         return
      end do
      if (.not. within(p_c, par%largest_stress)) then
         status = fail(MUD_BAD_INPUT, ON_SUCTION, 0, p_c, -par%largest_stress, par%largest_stress)
      end if
   end subroutine check_stress

   pure subroutine check_increment(par, state, d_strain, d_pc, status)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state
      real(wp), intent(in) :: d_strain(6), d_pc
      type(mud_status_t), intent(out) :: status
      integer :: i

      call check_stress(par, state%sigma, state%p_c, status)
      if (status%code /= MUD_OK) return
      do i = 1, 6
         if (within(d_strain(i), LARGEST_STRAIN)) cycle
         status = fail(merge(MUD_INCREMENT_TOO_LARGE, MUD_BAD_INPUT, is_finite(d_strain(i))), ON_STRAIN, i, &
                       d_strain(i), -LARGEST_STRAIN, LARGEST_STRAIN)
         return
      end do
      if (.not. within(d_pc, par%largest_suction_step)) then
         status = fail(merge(MUD_INCREMENT_TOO_LARGE, MUD_BAD_INPUT, is_finite(d_pc)), ON_SUCTION, 0, d_pc, &
                       -par%largest_suction_step, par%largest_suction_step)
      end if
   end subroutine check_increment

   !> Finite and of magnitude up to a limit. A NaN is not compared: a comparison would trap.
   pure logical function within(value, limit)
      real(wp), intent(in) :: value, limit

      within = is_finite(value)
      if (within) within = abs(value) <= limit
   end function within
end module mud_point
