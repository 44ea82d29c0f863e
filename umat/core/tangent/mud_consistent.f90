! SPDX-License-Identifier: MIT
!> Consistent tangent: the derivative of the algorithm, carried through the accepted substeps. The jumps of memory, the
!> share of an increment inside the elastic domain and the times of events (mud_event_time) are differentiated. Sizes
!> of substeps are frozen but for those that end at an event, for the last, which ends where the increment ends, and for
!> those that divide the rest: behind an event all substeps begin later by its shift. In the limit of small substeps
!> that is the saltation term (f_before - f_after) (x) dt/d increment; docs/theory/integration.md section 5.
module mud_consistent
   use mud_integration, only: JUMP_REVERSAL, JUMP_RETURN, JUMP_NEW
   use mud_kinds, only: wp
   use mud_loading, only: loading_t
   use mud_loading_changes, only: changes_of_loading_strain
   use mud_mechanism_changes, only: below_t, begin_below, follow_below, end_below
   use mud_cutoff, only: MODE_HELD
   use mud_driving, only: driving_t, whole_increment, change_of_place, AT_REST
   use mud_fading, only: fading_t, NO_FADING, begin_fading, change_of_left, add_changes_of_faded
   use mud_held, only: changes_through_hold
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_inside_changes, only: changes_inside
   use mud_options, only: live_numbers, add_volume_changes, past_changes_t, no_past_changes, &
      begin_past_changes, jump_of_past
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, p_follows, MODE_ORDINARY
   use mud_registry, only: RULE_THRESHOLD, RULE_REPOSITIONING, MAX_INTERRUPTED
   use mud_relaxation, only: relax
   use mud_reversal, only: interrupted_share
   use mud_sensitivity, only: changes_of_rate
   use mud_state, only: memory_t
   use mud_substep, only: MAX_STAGES, stage_point, solution
   use mud_tensor, only: DIRECTIONS, IDENTITY, contracted, tensors_t, ZERO_TENSORS, ANY_TENSORS
   use mud_transient, only: without_turn, half_way
   use mud_trial, only: trial_t
   use mud_linearise, only: linearised_t, linearise, changes_t
   use mud_vector, only: NY, Y_SHEAR
   implicit none (type, external)
   private
   public :: sensitivity_t, no_sensitivity, propagate, jump_of_memory, &
             changes_of_parting, change_with_size, changes_along, changes_of_ratio, &
             linearise_stage

   integer, parameter :: STRESS = 6   !< So many numbers of the vector are the stress, which stands first.

   !> Derivatives along the directions of driving_t.
   type :: sensitivity_t
      logical :: at_rest                     !< the state does not depend on the increment yet: y, r_in, shift are zero
      !> Derivatives of sigma', z, the plastic shear of the present process, and the numbers of options.
      real(wp) :: y(DIRECTIONS, NY)
      type(tensors_t) :: r_in                !< derivatives of the memory
      real(wp) :: r_before(DIRECTIONS, 6)    !< derivatives of the memory of the process before
      real(wp) :: shift(DIRECTIONS)          !< derivatives of the pseudo-time where the next substep begins
      real(wp) :: end_shift(DIRECTIONS)      !< derivatives of the pseudo-time where the phase ends
      real(wp) :: stretch(DIRECTIONS)        !< derivatives of the length of the phase, over that length
      !> Derivatives of the memories of interrupted processes; those up to number `settled` were there when the
      !> increment began.
      real(wp) :: interrupted(DIRECTIONS, 6, MAX_INTERRUPTED)
      integer :: settled
      type(past_changes_t) :: past           !< derivatives of what the memory says for options
      real(wp) :: short(DIRECTIONS)          !< derivatives of what lacks to the memory of the isotropic mechanism
      real(wp) :: parts(DIRECTIONS)          !< derivatives of the void ratio at which the grains of a held point part
      type(driving_t) :: driving
      type(fading_t) :: fading               !< derivatives of what fades of the rates, where that is known
   end type sensitivity_t
contains
   !> Sets the derivatives at the start of an increment, where nothing depends on it yet. docs/theory/integration.md
   !> section 5.3.
   pure subroutine no_sensitivity(depth, inc, sens)
      integer, intent(in) :: depth           !< number of interrupted processes
      type(increment_t), intent(in) :: inc
      type(sensitivity_t), intent(inout) :: sens

      sens%at_rest = .true.
      sens%y = 0.0_wp
      sens%r_in%of = 0.0_wp
      sens%r_in%kind = ZERO_TENSORS
      sens%r_before = 0.0_wp
      call no_past_changes(sens%past)
      sens%shift = 0.0_wp
      sens%parts = 0.0_wp
      sens%short = 0.0_wp
      sens%settled = depth
      call whole_increment(inc, sens%driving)
   end subroutine no_sensitivity

   !> Carries the derivatives through an accepted substep h, a share of inc [-], the last one of a phase or not.
   !> docs/theory/integration.md section 5.3.
   pure subroutine propagate(par, inc, trial, h, last, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      logical, intent(in) :: last
      type(sensitivity_t), intent(inout) :: sens
      real(wp) :: dh(DIRECTIONS), rates(DIRECTIONS, NY, MAX_STAGES)
      logical :: ends
      integer :: live

      call begin_past_changes(sens%y, sens%past)
      if (trial%divides .or. last) then
         dh = (h/(inc%to - trial%time))*(sens%end_shift - sens%shift)
      else
         dh = h*sens%stretch
      end if
      if (trial%mode == MODE_HELD) then
         call changes_through_hold(par, inc, trial%parts, sens%parts, trial%y0(1:6), trial%time, h, sens%shift, dh, &
                                   sens%driving, sens%y)
      else if (trial%closed) then
         call changes_inside(par, inc, trial%y0, trial%time, h, sens%shift, dh, sens%driving, sens%y)
      else
         ends = last .and. inc%to >= 1.0_wp
         live = live_of_substep(par, inc, trial, ends)
         call change_of_stage(par, inc, trial%mode, trial%w(1), trial%y0, trial%time, sens%at_rest, live == STRESS, &
                              sens%shift, sens%r_in, sens%driving, sens%y, rates(:, :, 1))
         if (trial%transient%known) then
            if (trial%transient%since >= trial%time) &
               call change_of_transient(par, inc, trial, live == STRESS, rates(:, :, 1), sens)
         end if
         call through_stages(par, inc, trial, h, ends, live, sens%shift, dh, sens%r_in, sens%driving, sens%fading, &
                             rates, sens%y, sens%short)
      end if
      sens%at_rest = .false.
      sens%shift = sens%shift + dh
   end subroutine propagate

   !> Derivative of the end of a substep with respect to its size. Per unit of h, a share of inc; [kPa, -, -] for
   !> sigma', z and plastic shear. docs/theory/integration.md section 4.3.
   pure subroutine change_with_size(par, inc, trial, h, change, of_short)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      real(wp), intent(out) :: change(NY)
      real(wp), intent(out) :: of_short   !< Derivative of what lacks to the memory of the mechanism, see below_t [-].
      real(wp), dimension(DIRECTIONS) :: none, one, short
      real(wp) :: rates(DIRECTIONS, NY, MAX_STAGES), y(DIRECTIONS, NY)

      none = 0.0_wp
      one = 1.0_wp
      short = 0.0_wp
      rates(:, :, 1) = 0.0_wp
      y = 0.0_wp
      if (trial%mode == MODE_HELD) then
         call changes_through_hold(par, inc, trial%parts, none, trial%y0(1:6), trial%time, h, none, one, AT_REST, y)
      else if (trial%closed) then
         call changes_inside(par, inc, trial%y0, trial%time, h, none, one, AT_REST, y)
      else
         call through_stages(par, inc, trial, h, .false., live_numbers(par), none, one, AT_REST%d_strain, AT_REST, &
                             NO_FADING, rates, y, short)
      end if
      change = y(1, :)
      of_short = short(1)
   end subroutine change_with_size

   !> The scheme applied to all directions as one long vector, from the changes of its first rate: its start moves by
   !> `shift` in pseudo-time, its size changes by dh.
   pure subroutine through_stages(par, inc, trial, h, ends, live, shift, dh, r_in, driving, fading, rates, y1, short)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h, shift(DIRECTIONS), dh(DIRECTIONS)
      type(tensors_t), intent(in) :: r_in
      logical, intent(in) :: ends   !< Only the stress at the end is asked for ...
      integer, intent(in) :: live   !< ... for which so many numbers of the stages are needed.
      type(driving_t), intent(in) :: driving
      type(fading_t), intent(in) :: fading
      real(wp), intent(inout) :: rates(DIRECTIONS*NY, MAX_STAGES)   !< The first is given.
      real(wp), intent(inout) :: y1(DIRECTIONS*NY)
      real(wp), intent(inout) :: short(DIRECTIONS)   !< Derivatives of what lacks to the memory, see below_t.
      real(wp) :: y(DIRECTIONS*NY), time, dt(DIRECTIONS), left(MAX_STAGES + 1), d_left(DIRECTIONS, MAX_STAGES + 1)
      type(below_t) :: below
      integer :: i, last, row, asked, n
      logical :: moves

      last = last_of_solution(inc)
      moves = any(abs(dh) > 0.0_wp)
      call begin_below(par, inc, trial, h, ends, below)
      call follow_below(par, inc, trial, h, 1, trial%y0, trial%time, shift, dh, short, driving, y1, rates(:, 1), below)
      n = DIRECTIONS*live
      if (trial%transient%known) &
         call change_of_left(trial%transient, fading, trial%time, shift, left(1), d_left(:, 1))
      call finish_stage(trial, h, 1, live, moves, dh, rates)
      do i = 2, last
         call stage_point(inc%scheme, i, y1(1:n), rates, h, y(1:n))
         time = trial%time + inc%scheme%node(i)*h
         dt = shift + inc%scheme%node(i)*dh
         row = (i - 1)*(i - 2)/2
         associate (weights => inc%scheme%a(row + 1:row + i - 1))
            if (trial%transient%known) then
               call change_of_left(trial%transient, fading, time, dt, left(i), d_left(:, i))
               call add_changes_of_faded(trial%transient, fading, i - 1, h, weights, left, d_left, live, y(1:n))
            end if
            call change_of_stage(par, inc, trial%mode, trial%w(i), trial%points(:, i), time, .false., &
                                 live == STRESS .or. (ends .and. i == last), dt, r_in, driving, y, rates(:, i))
         end associate
         call follow_below(par, inc, trial, h, i, trial%points(:, i), time, dt, dh, short, driving, y, rates(:, i), &
                           below)
         call finish_stage(trial, h, i, live, moves, dh, rates)
      end do
      asked = live
      if (ends) asked = STRESS
      n = DIRECTIONS*asked
      y(1:n) = y1(1:n)
      associate (weights => inc%scheme%b(1:last))
         call solution(inc%scheme, y(1:n), rates, h, y1(1:n))
         if (trial%transient%known) then
            call change_of_left(trial%transient, fading, trial%time + h, shift + dh, left(last + 1), &
                                d_left(:, last + 1))
            call add_changes_of_faded(trial%transient, fading, last, h, weights, left, d_left, asked, y1(1:n))
         end if
      end associate
      call end_below(inc, last, below, short)
   end subroutine through_stages

   !> Number of stages of which the solution is made: the last one of some pairs serves the error estimate and the next
   !> substep.
   pure integer function last_of_solution(inc) result(last)
      type(increment_t), intent(in) :: inc

      last = inc%scheme%stages
      if (inc%scheme%first_same_as_last) last = last - 1
   end function last_of_solution

   !> Numbers of the vector that a substep needs: only the stress, which stands first, where the increment ends and no
   !> later stage has z:n > 0, by which alone fabric acts.
   pure integer function live_of_substep(par, inc, trial, ends) result(live)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      logical, intent(in) :: ends
      integer :: i

      live = live_numbers(par)
      if (.not. ends .or. live > Y_SHEAR .or. trial%relaxation%speed > 0.0_wp) return
      do i = 2, last_of_solution(inc)
         if (trial%w(i)%loading) then
            if (trial%w(i)%z_n > 0.0_wp) return
         end if
      end do
      live = STRESS
   end function live_of_substep

   !> Derivatives of what fades of the rates from the start of this substep on, whose first rate changes by now. Where
   !> the strain does not turn yet, what a turn would add fades too: by the first power of its angle as exp(-k t).
   pure subroutine change_of_transient(par, inc, trial, stress_only, now, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      logical, intent(in) :: stress_only
      real(wp), intent(in) :: now(DIRECTIONS, NY)
      type(sensitivity_t), intent(inout) :: sens
      real(wp), dimension(DIRECTIONS, NY) :: far, half
      real(wp) :: speed(DIRECTIONS)

      speed = contracted(sens%driving%d_strain, inc%d_strain)/(inc%length*inc%rho)
      associate (transient => trial%transient, at_rest => sens%at_rest, shift => sens%shift)
         if (transient%terms == 0) then
            call change_of_stage(par, without_turn(inc), MODE_ORDINARY, trial%w(1), trial%y0, trial%time, at_rest, &
                                 stress_only, shift, sens%r_in, sens%driving, sens%y, far)
         else
            call change_of_stage(par, without_turn(inc), MODE_ORDINARY, transient%far, trial%y0, trial%time, at_rest, &
                                 stress_only, shift, sens%r_in, sens%driving, sens%y, far)
         end if
         if (transient%terms < 2) then
            call begin_fading(now, far, speed, shift, sens%fading)
            return
         end if
         call change_of_stage(par, inc, MODE_ORDINARY, transient%half, trial%y0, half_way(transient), at_rest, &
                              stress_only, shift - ((half_way(transient) - trial%time)/transient%speed)*speed, &
                              sens%r_in, sens%driving, sens%y, half)
         call begin_fading(now, far, speed, shift, sens%fading, half)
      end associate
   end subroutine change_of_transient

   !> Adds to the derivatives of stage i those by the size of the substep, which changes by dh, and by the stiff
   !> direction.
   pure subroutine finish_stage(trial, h, i, live, moves, dh, rates)
      type(trial_t), intent(in) :: trial
      integer, intent(in) :: i, live   !< live: numbers that may change
      logical, intent(in) :: moves     !< dh is not zero
      real(wp), intent(in) :: h, dh(DIRECTIONS)
      real(wp), intent(inout) :: rates(DIRECTIONS, NY, MAX_STAGES)
      real(wp) :: along_one(NY, MAX_STAGES)
      integer :: j, k

      if (moves) then
         do k = 1, live
            rates(:, k, i) = rates(:, k, i) + (trial%rates(k, i)/h)*dh
         end do
      end if
      if (trial%relaxation%speed <= 0.0_wp) return
      along_one(live + 1:, 1:i) = 0.0_wp
      do j = 1, DIRECTIONS
         along_one(1:live, 1:i) = rates(j, 1:live, 1:i)
         call relax(trial%relaxation, h, along_one(:, 1:i))
         rates(j, 1:live, i) = along_one(1:live, i)
      end do
   end subroutine finish_stage

   !> Derivatives of one stage's rates; its pseudo-time changes by dt.
   pure subroutine change_of_stage(par, inc, mode, w, point, time, at_rest, stress_only, dt, r_in, driving, y, rates)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      type(rate_t), intent(in) :: w
      logical, intent(in) :: at_rest, stress_only
      real(wp), intent(in) :: point(NY), time, dt(DIRECTIONS), y(DIRECTIONS, NY)
      type(tensors_t), intent(in) :: r_in
      type(driving_t), intent(in) :: driving
      real(wp), intent(out) :: rates(DIRECTIONS, NY)
      type(linearised_t) :: lin
      type(changes_t) :: changes
      real(wp) :: e
      logical :: rests

      e = void_ratio_at(inc, time)
      call changes_along(inc, mode, time, e, dt, driving, changes)
      rests = at_rest .and. time <= 0.0_wp   ! behind the start of the increment void ratio and suction have changes
      call linearise_stage(par, inc, w, point, time, e, changes%loading, rests, lin)
      call changes_of_rate(par, w, lin, rests, y, r_in, driving%d_strain, driving%from_centre, &
                           changes, stress_only, rates)
      if (.not. stress_only) call add_volume_changes(par, inc%d_v, point, y, driving%d_v, rates)
   end subroutine change_of_stage

   !> Prepares the derivative of the rate w of a stage, at a point of the integrated vector, a pseudo-time and a void
   !> ratio. point has sigma' [kPa], z and plastic shear [-]; time is a share of inc, e the void ratio [-].
   !> docs/theory/integration.md section 5.3.
   pure subroutine linearise_stage(par, inc, w, point, time, e, loading, at_rest, lin)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: point(NY), time, e
      type(loading_t), intent(in) :: loading   !< loading part of the strain rate there
      logical, intent(in) :: at_rest
      type(linearised_t), intent(inout) :: lin

      call linearise(par, inc%suction, w, point(1:6), e, suction_at(inc, time), loading, inc%d_pc, at_rest, lin)
   end subroutine linearise_stage

   !> Changes of the arguments of a rate, beside stress, fabric and memory, at a pseudo-time that itself changes by dt.
   !> time and dt are shares of inc, e is the void ratio [-]; units of the changes as in changes_t.
   pure subroutine changes_along(inc, mode, time, e, dt, driving, changes)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      real(wp), intent(in) :: time, e, dt(DIRECTIONS)
      type(driving_t), intent(in) :: driving
      type(changes_t), intent(inout) :: changes   !< all of it is set

      changes%d_pc = driving%d_pc
      changes%scans = driving%scans
      if (driving%scans) changes%turn = driving%turn
      call change_of_place(inc, time, e, dt, driving, changes%e, changes%p_c)
      call changes_of_loading_strain(inc, mode, time, driving%d_strain, driving%from_centre, dt - driving%exit, &
                                     changes%loading)
   end subroutine changes_along

   !> Changes of the void ratio at which the grains of a point part that has no gap: where that is its void ratio, it
   !> changes with it. docs/theory/material.md section 6.4.
   pure subroutine changes_of_parting(inc, trial, sens)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial     !< held
      type(sensitivity_t), intent(inout) :: sens
      real(wp) :: dp_c(DIRECTIONS)

      sens%parts = 0.0_wp
      if (trial%e < trial%parts) return
      call change_of_place(inc, trial%time, trial%e, sens%shift, sens%driving, sens%parts, dp_c)
   end subroutine changes_of_parting

   !> Changes of the stress ratio with the stress. sigma and y(:, 1:6) [kPa], dr [-]. Where p' is held at p_min its
   !> change is left out. Derivative of docs/theory/material.md section 1.2.
   pure function changes_of_ratio(par, sigma, y) result(dr)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), y(DIRECTIONS, NY)
      real(wp) :: dr(DIRECTIONS, 6), p, r(6), mean(DIRECTIONS)
      integer :: i

      call stress_ratio(par, sigma, p, r)
      mean = (y(:, 1) + y(:, 2) + y(:, 3))/3.0_wp
      do i = 1, 6
         dr(:, i) = (y(:, i) - IDENTITY(i)*mean)/p
         if (p_follows(par, sigma)) dr(:, i) = dr(:, i) - (r(i)/p)*mean
      end do
   end function changes_of_ratio

   !> Derivatives of the memory across its jump at the start of a substep; `before` is the memory ahead of it and
   !> `trigger` the rate that made it jump. jump is one of JUMP_*, not JUMP_NONE. docs/theory/integration.md sections
   !> 4.3, 5.3; rules of docs/theory/memory-rules.md section 2.
   pure subroutine jump_of_memory(par, inc, jump, before, after, trigger, trial, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: jump
      type(memory_t), intent(in) :: before, after
      type(rate_t), intent(in) :: trigger
      type(trial_t), intent(in) :: trial
      type(sensitivity_t), intent(inout) :: sens
      real(wp) :: p, r(6), dr(DIRECTIONS, 6), old_r_in(DIRECTIONS, 6), m
      integer :: i

      sens%at_rest = .false.
      sens%r_in%kind = ANY_TENSORS
      call jump_of_past(par, jump == JUMP_REVERSAL, jump == JUMP_RETURN, before, after, sens%y, sens%past)
      if (jump == JUMP_RETURN) then
         ! of the two memories the softer one was taken
         if (any(abs(after%r_in - before%r_in) > 0.0_wp)) then
            sens%r_in%of = 0.0_wp
            if (after%depth >= sens%settled) sens%r_in%of = sens%interrupted(:, :, after%depth + 1)
         end if
         sens%settled = min(sens%settled, after%depth)
         sens%y(:, Y_SHEAR) = 0.0_wp
         return
      end if
      if (jump == JUMP_REVERSAL .and. after%depth /= before%depth) then
         sens%interrupted(:, :, after%depth) = sens%r_in%of
         sens%settled = min(sens%settled, after%depth - 1)
      end if
      if (jump == JUMP_NEW) sens%settled = 0
      if (jump == JUMP_REVERSAL .and. par%memory_rule == RULE_REPOSITIONING) then
         call reposition(par, inc, before, trigger, trial, sens)
         return
      end if
      call stress_ratio(par, trial%y0(1:6), p, r)
      dr = changes_of_ratio(par, trial%y0(1:6), sens%y)
      old_r_in = sens%r_in%of
      sens%r_in%of = dr
      ! of r_in = r + m (r_before - r); a fall-back left r_in at r
      if (jump == JUMP_REVERSAL .and. par%memory_rule == RULE_THRESHOLD .and. any(abs(after%r_in - r) > 0.0_wp)) then
         m = interrupted_share(par, before%eps_q_p)
         do i = 1, 6
            sens%r_in%of(:, i) = (1.0_wp - m)*dr(:, i) + m*sens%r_before(:, i) &
               + (share_slope(par, before%eps_q_p)*sens%y(:, Y_SHEAR))*(before%r_before(i) - r(i))
         end do
      end if
      sens%r_before = old_r_in
      if (jump == JUMP_NEW) sens%r_before = dr
      sens%y(:, Y_SHEAR) = 0.0_wp
   end subroutine jump_of_memory

   !> dm/d eps_q^p of paper eq. (16) [-].
   pure real(wp) function share_slope(par, eps_q_p) result(slope)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: eps_q_p
      real(wp) :: m

      slope = 0.0_wp
      m = interrupted_share(par, eps_q_p)
      if (m > 0.0_wp .and. eps_q_p > 0.0_wp) slope = -par%j_exp*(1.0_wp - m)/eps_q_p
   end function share_slope

   !> Derivatives of r_in = r - m J n, rule repositioning.
   pure subroutine reposition(par, inc, before, trigger, trial, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(memory_t), intent(in) :: before
      type(rate_t), intent(in) :: trigger
      type(trial_t), intent(in) :: trial
      type(sensitivity_t), intent(inout) :: sens
      type(linearised_t) :: lin
      type(changes_t) :: changes
      real(wp) :: rates(DIRECTIONS, NY), dn(DIRECTIONS, 6), dr(DIRECTIONS, 6), m, e
      integer :: i

      m = interrupted_share(par, before%eps_q_p)
      e = void_ratio_at(inc, trial%time)
      call changes_along(inc, MODE_ORDINARY, trial%time, e, sens%shift, sens%driving, changes)
      call linearise_stage(par, inc, trigger, trial%y0, trial%time, e, changes%loading, .false., lin)
      call changes_of_rate(par, trigger, lin, .false., sens%y, sens%r_in, sens%driving%d_strain, &
                           sens%driving%from_centre, changes, .false., rates, dn)
      dr = changes_of_ratio(par, trial%y0(1:6), sens%y)
      sens%r_before = sens%r_in%of
      do i = 1, 6
         sens%r_in%of(:, i) = dr(:, i) - before%x_before &
                              *(m*dn(:, i) + (share_slope(par, before%eps_q_p)*trigger%n(i))*sens%y(:, Y_SHEAR))
      end do
      sens%y(:, Y_SHEAR) = 0.0_wp
   end subroutine reposition
end module mud_consistent
