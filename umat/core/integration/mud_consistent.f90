! SPDX-License-Identifier: MIT
!> Consistent tangent: the derivative of the algorithm, carried through the accepted substeps. The jumps of memory, the
!> share of an increment inside the elastic domain and the times of events (mud_event_time) are differentiated. Sizes
!> of substeps are frozen but for those that end at an event and for the last, which ends where the increment ends:
!> behind an event all substeps begin later by its shift. In the limit of small substeps that is the saltation term
!> (f_before - f_after) (x) dt/d increment; docs/theory/integration.md section 5.
module mud_consistent
   use mud_kinds, only: wp
   use mud_cutoff, only: slide, change_of_slide
   use mud_driving, only: driving_t, whole_increment, DIRECTIONS, AT_REST
   use mud_increment, only: increment_t, void_ratio_at, suction_at, loading_strain, change_of_loading_strain, &
      turn_of_loading_strain, turning_t, turning_of, has_aside, NY
   use mud_params, only: params_t
   use mud_rates, only: rate_t, stress_ratio, MODE_ORDINARY
   use mud_registry, only: RULE_THRESHOLD, RULE_REPOSITIONING, RULE_RETURN_POINT, MAX_INTERRUPTED
   use mud_relaxation, only: relax
   use mud_reversal, only: interrupted_share
   use mud_sensitivity, only: change_t, linearised_t, linearise, change_of_rate, changes_of_rate
   use mud_state, only: memory_t
   use mud_substep, only: MAX_STAGES, stage_point, solution
   use mud_tensor, only: trace, deviator
   use mud_trial, only: trial_t, MODE_HELD
   implicit none (type, external)
   private
   public :: sensitivity_t, no_sensitivity, propagate, jump_of_memory, change_with_size, change_along, &
             change_of_ratio, linearise_stage, JUMP_NONE, JUMP_REVERSAL, JUMP_RETURN, JUMP_NEW

   integer, parameter :: JUMP_NONE = 0
   integer, parameter :: JUMP_REVERSAL = 1   !< A new process begins.
   integer, parameter :: JUMP_RETURN = 2     !< An interrupted process goes on.
   integer, parameter :: JUMP_NEW = 3        !< The tension cut-off let go: no past.

   !> Derivatives along the seven directions.
   type :: sensitivity_t
      real(wp) :: y(NY, DIRECTIONS)          !< of sigma', z and the plastic shear of the present process
      real(wp) :: r_in(6, DIRECTIONS)        !< of the memory
      real(wp) :: r_before(6, DIRECTIONS)    !< of the memory of the process before
      real(wp) :: shift(DIRECTIONS)          !< of the pseudo-time where the next substep begins
      !> Of the memories of interrupted processes; those up to number `settled` were there when the increment began.
      real(wp) :: interrupted(6, DIRECTIONS, MAX_INTERRUPTED)
      integer :: settled
      type(driving_t) :: driving
   end type sensitivity_t
contains
   !> At the start of an increment nothing depends on it yet.
   pure subroutine no_sensitivity(depth, sens)
      integer, intent(in) :: depth           !< number of interrupted processes
      type(sensitivity_t), intent(inout) :: sens

      sens%y = 0.0_wp
      sens%r_in = 0.0_wp
      sens%r_before = 0.0_wp
      sens%shift = 0.0_wp
      sens%settled = depth
      sens%driving = whole_increment()
   end subroutine no_sensitivity

   !> Carries the derivatives through an accepted substep h at whose end the pseudo-time is fixed (the last one of an
   !> increment or a phase) or not.
   pure subroutine propagate(par, inc, trial, h, last, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      logical, intent(in) :: last
      type(sensitivity_t), intent(inout) :: sens
      real(wp) :: dh(DIRECTIONS)

      dh = 0.0_wp
      if (last) dh = -sens%shift
      call through_substep(par, inc, trial, h, sens%shift, dh, sens%r_in, sens%driving, sens%y)
      if (last) sens%shift = 0.0_wp
   end subroutine propagate

   !> Derivative of the end of a substep with respect to its size.
   pure subroutine change_with_size(par, inc, trial, h, change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      real(wp), intent(out) :: change(NY)
      real(wp) :: r_in(6, 1), y(NY, 1)

      r_in = 0.0_wp
      y = 0.0_wp
      call through_substep(par, inc, trial, h, [0.0_wp], [1.0_wp], r_in, AT_REST, y)
      change = y(:, 1)
   end subroutine change_with_size

   !> Derivatives across a substep along any number of directions: its start moves by `shift` in pseudo-time, its size
   !> changes by dh.
   pure subroutine through_substep(par, inc, trial, h, shift, dh, r_in, driving, y)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      real(wp), intent(in), contiguous :: shift(:), dh(:), r_in(:, :)
      type(driving_t), intent(in) :: driving
      real(wp), intent(inout), contiguous :: y(:, :)

      if (trial%mode == MODE_HELD) then
         call through_held(par, inc, trial, h, shift, dh, driving, y)
      else
         call through_stages(par, inc, trial, h, size(shift), shift, dh, r_in, driving, y)
      end if
   end subroutine through_substep

   !> Derivatives of the stress ratio of a held point, whose p' rests: two half steps.
   pure subroutine through_held(par, inc, trial, h, shift, dh, driving, y)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h, shift(:), dh(:)
      type(driving_t), intent(in) :: driving
      real(wp), intent(inout) :: y(:, :)
      real(wp) :: r0(6), r_half(6), dr(6), strain(6), de, dp_c, half, middle
      integer :: j

      half = 0.5_wp*h
      middle = trial%time + half
      r0 = deviator(trial%y0(1:6))/par%p_min
      r_half = slide(par, inc, r0, trial%time, half)
      do j = 1, size(shift)
         strain = driving%d_strain(:, j) + (dh(j)/h)*inc%d_strain
         call change_of_place(inc, j, middle, void_ratio_at(inc, middle), shift(j) + 0.5_wp*dh(j), driving, de, dp_c)
         dr = change_of_slide(par, inc, r0, trial%time, half, deviator(y(1:6, j))/par%p_min, strain, de, dp_c)
         call change_of_place(inc, j, trial%time + h, void_ratio_at(inc, trial%time + h), shift(j) + dh(j), driving, &
                              de, dp_c)
         y(1:6, j) = par%p_min*change_of_slide(par, inc, r_half, middle, half, dr, strain, de, dp_c)
      end do
   end subroutine through_held

   !> Derivatives of void ratio and suction at a pseudo-time that itself changes by dt.
   pure subroutine change_of_place(inc, j, time, e, dt, driving, de, dp_c)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: j
      real(wp), intent(in) :: time, e, dt   !< e: void ratio there
      type(driving_t), intent(in) :: driving
      real(wp), intent(out) :: de, dp_c

      de = (1.0_wp + e)*(driving%e0(j) - time*driving%d_v(j) - dt*inc%d_v)
      dp_c = driving%p_c0(j) + time*driving%d_pc(j) + dt*inc%d_pc
   end subroutine change_of_place

   !> The scheme applied to all directions as one long vector.
   pure subroutine through_stages(par, inc, trial, h, n, shift, dh, r_in, driving, y1)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      integer, intent(in) :: n               !< number of directions
      real(wp), intent(in) :: h, shift(n), dh(n), r_in(6, n)
      type(driving_t), intent(in) :: driving
      real(wp), intent(inout) :: y1(NY*n)
      real(wp) :: rates(NY*DIRECTIONS, MAX_STAGES), y0(NY*DIRECTIONS), y(NY*DIRECTIONS), point(NY), dt(DIRECTIONS)
      integer :: i, j, last, size

      ! the last stage of such a pair serves the error estimate and the next substep, not the solution
      last = inc%scheme%stages
      if (inc%scheme%first_same_as_last) last = last - 1
      size = NY*n
      y0(:size) = y1
      y(:size) = y1
      point = trial%y0
      do i = 1, last
         if (i > 1) then
            call stage_point(inc%scheme, i, y0(:size), rates(:size, :), h, y(:size))
            call stage_point(inc%scheme, i, trial%y0, trial%rates, h, point)
         end if
         dt(:n) = shift + inc%scheme%node(i)*dh
         call change_of_stage(par, inc, trial%mode, trial%w(i), point, trial%time + inc%scheme%node(i)*h, n, &
                              dt, r_in, driving, y, rates(:, i))
         do j = 1, n
            if (abs(dh(j)) > 0.0_wp) then
               rates(NY*(j - 1) + 1:NY*j, i) = rates(NY*(j - 1) + 1:NY*j, i) + (dh(j)/h)*trial%rates(:, i)
            end if
            if (trial%relaxation%speed > 0.0_wp) call relax(trial%relaxation, h, rates(NY*(j - 1) + 1:NY*j, 1:i))
         end do
      end do
      call solution(inc%scheme, y0(:size), rates(:size, :), h, y1)
   end subroutine through_stages

   !> Derivatives of one stage's rates; its pseudo-time changes by dt.
   pure subroutine change_of_stage(par, inc, mode, w, point, time, n, dt, r_in, driving, y, rates)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode, n
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: point(NY), time, dt(n), r_in(6, n), y(NY, n)
      type(driving_t), intent(in) :: driving
      real(wp), intent(out) :: rates(NY, n)
      type(linearised_t) :: lin
      type(change_t) :: changes(DIRECTIONS)
      type(turning_t) :: turning
      real(wp) :: e
      integer :: j

      e = void_ratio_at(inc, time)
      turning = turning_of(inc, mode, time)
      call linearise_stage(par, inc, mode, w, point, time, e, lin)
      do j = 1, n
         call change_along(inc, mode, j, time, e, turning, dt(j), y(:, j), r_in(:, j), driving, changes(j))
      end do
      call changes_of_rate(par, w, lin, n, changes, rates)
   end subroutine change_of_stage

   !> Prepares the derivative of the rate w of a stage, at a point of the integrated vector, a pseudo-time and a void
   !> ratio.
   pure subroutine linearise_stage(par, inc, mode, w, point, time, e, lin)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: point(NY), time, e
      type(linearised_t), intent(inout) :: lin
      real(wp) :: loading(6), aside(6)

      if (has_aside(inc, mode)) then
         call loading_strain(inc, mode, time, loading, aside)
         call linearise(par, inc%bonded, w, point(1:6), e, suction_at(inc, time), loading, inc%d_pc, lin, aside)
      else
         call linearise(par, inc%bonded, w, point(1:6), e, suction_at(inc, time), inc%d_strain, inc%d_pc, lin)
      end if
   end subroutine linearise_stage

   !> How the arguments of a rate change along a direction, at a pseudo-time that itself changes by dt.
   pure subroutine change_along(inc, mode, j, time, e, turning, dt, y, r_in, driving, change)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode, j
      type(turning_t), intent(in) :: turning   !< of the elastic domain there
      real(wp), intent(in) :: time, e, dt, y(NY), r_in(6)
      type(driving_t), intent(in) :: driving
      type(change_t), intent(inout) :: change
      real(wp) :: turn(6)

      change%sigma = y(1:6)
      change%z = y(7:12)
      change%r_in = r_in
      change%d_strain = driving%d_strain(:, j)
      change%d_pc = driving%d_pc(j)
      call change_of_place(inc, j, time, e, dt, driving, change%e, change%p_c)
      if (.not. has_aside(inc, mode)) return
      call change_of_loading_strain(inc, mode, turning, driving%d_strain(:, j), driving%from_centre(:, j), &
                                    change%d_strain, change%d_aside)
      if (abs(dt) > 0.0_wp) then
         turn = dt*turn_of_loading_strain(inc, mode, time)
         change%d_strain = change%d_strain + turn
         change%d_aside = change%d_aside - turn
      end if
   end subroutine change_along

   !> Change of the stress ratio with the stress.
   pure function change_of_ratio(par, sigma, d_sigma) result(dr)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), d_sigma(6)
      real(wp) :: dr(6), p, r(6)

      call stress_ratio(par, sigma, p, r)
      dr = deviator(d_sigma)/p
      if (trace(sigma) >= 3.0_wp*par%p_min) dr = dr - (trace(d_sigma)/(3.0_wp*p))*r
   end function change_of_ratio

   !> Derivatives of the memory across its jump at the start of a substep; `before` is the memory ahead of it and
   !> `trigger` the rate that made it jump.
   pure subroutine jump_of_memory(par, inc, jump, before, after, trigger, trial, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: jump
      type(memory_t), intent(in) :: before, after
      type(rate_t), intent(in) :: trigger
      type(trial_t), intent(in) :: trial
      type(sensitivity_t), intent(inout) :: sens
      real(wp) :: p, r(6), dr(6), old_r_in(6)
      integer :: j

      if (jump == JUMP_RETURN) then
         ! of the two memories the softer one was taken
         if (any(abs(after%r_in - before%r_in) > 0.0_wp)) then
            sens%r_in = 0.0_wp
            if (after%depth >= sens%settled) sens%r_in = sens%interrupted(:, :, after%depth + 1)
         end if
         sens%settled = min(sens%settled, after%depth)
         sens%y(13, :) = 0.0_wp
         return
      end if
      if (jump == JUMP_REVERSAL .and. after%depth /= before%depth) then
         sens%interrupted(:, :, after%depth) = sens%r_in
         sens%settled = min(sens%settled, after%depth - 1)
      end if
      if (jump == JUMP_NEW) sens%settled = 0
      if (jump == JUMP_REVERSAL .and. par%memory_rule == RULE_REPOSITIONING) then
         call reposition(par, inc, before, trigger, trial, sens)
         return
      end if
      call stress_ratio(par, trial%y0(1:6), p, r)
      do j = 1, DIRECTIONS
         dr = change_of_ratio(par, trial%y0(1:6), sens%y(1:6, j))
         old_r_in = sens%r_in(:, j)
         sens%r_in(:, j) = dr
         if (jump == JUMP_REVERSAL .and. par%memory_rule == RULE_THRESHOLD) then
            ! a fall-back left r_in at r
            if (any(abs(after%r_in - r) > 0.0_wp)) then
               sens%r_in(:, j) = change_of_threshold(par, before, r, dr, sens%r_before(:, j), sens%y(13, j))
            end if
         end if
         sens%r_before(:, j) = old_r_in
         if (jump == JUMP_NEW) sens%r_before(:, j) = dr
      end do
      sens%y(13, :) = 0.0_wp
   end subroutine jump_of_memory

   !> Change of r_in = r + m (r_before - r), rule threshold.
   pure function change_of_threshold(par, before, r, dr, dr_before, d_eps_q) result(change)
      type(params_t), intent(in) :: par
      type(memory_t), intent(in) :: before
      real(wp), intent(in) :: r(6), dr(6), dr_before(6), d_eps_q
      real(wp) :: change(6), m

      m = interrupted_share(par, before%eps_q_p)
      change = (1.0_wp - m)*dr + m*dr_before + (share_slope(par, before%eps_q_p)*d_eps_q)*(before%r_before - r)
   end function change_of_threshold

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
      type(change_t) :: change
      type(turning_t) :: turning
      real(wp) :: m, dm, dn(6), d_sigma(6), d_z(6), d_eps_q, e
      integer :: j

      m = interrupted_share(par, before%eps_q_p)
      e = void_ratio_at(inc, trial%time)
      turning = turning_of(inc, MODE_ORDINARY, trial%time)
      call linearise_stage(par, inc, MODE_ORDINARY, trigger, trial%y0, trial%time, e, lin)
      do j = 1, DIRECTIONS
         call change_along(inc, MODE_ORDINARY, j, trial%time, e, turning, sens%shift(j), sens%y(:, j), &
                           sens%r_in(:, j), sens%driving, change)
         call change_of_rate(par, trigger, lin, change, d_sigma, d_z, d_eps_q, dn)
         dm = share_slope(par, before%eps_q_p)*sens%y(13, j)
         sens%r_before(:, j) = sens%r_in(:, j)
         sens%r_in(:, j) = change_of_ratio(par, trial%y0(1:6), sens%y(1:6, j)) - before%x_before*(m*dn + dm*trigger%n)
         sens%y(13, j) = 0.0_wp
      end do
   end subroutine reposition
end module mud_consistent
