!> Consistent tangent: the derivative of the algorithm, carried through the accepted substeps. Sizes of substeps,
!> landings on events and the choice of branch are frozen; the jumps of memory and the share of an increment that is
!> inside the elastic nucleus are differentiated.
module mud_consistent
   use mud_kinds, only: wp
   use mud_increment, only: increment_t, trial_t, void_ratio_at, suction_at, loading_strain, change_of_loading_strain, &
      has_aside, NY, MODE_HELD
   use mud_nucleus, only: change_of_exit
   use mud_params, only: params_t
   use mud_rates, only: rate_t, stress_ratio, MODE_ORDINARY
   use mud_registry, only: RULE_THRESHOLD, RULE_REPOSITIONING, RULE_RESUME
   use mud_sensitivity, only: change_t, linearised_t, linearise, change_of_rate, changes_of_rate
   use mud_state, only: memory_t
   use mud_substep, only: MAX_STAGES, stage_point, solution
   use mud_tensor, only: trace, deviator
   implicit none (type, external)
   private
   public :: sensitivity_t, no_sensitivity, enter_nucleus, leave_nucleus, propagate, jump_of_memory, &
             JUMP_NONE, JUMP_RESEAT, JUMP_RESUME, JUMP_NEW

   integer, parameter :: DIRECTIONS = 7   !< Six engineering strains and the suction at the end of the increment.
   integer, parameter :: JUMP_NONE = 0, JUMP_RESEAT = 1, JUMP_RESUME = 2, JUMP_NEW = 3

   !> Derivatives of what drives the increment, or one of its phases, along the seven directions.
   type :: driving_t
      real(wp) :: d_strain(6, DIRECTIONS)    !< of its strain
      real(wp) :: d_v(DIRECTIONS)            !< of its volume
      real(wp) :: d_pc(DIRECTIONS)           !< of its suction step
      real(wp) :: e0(DIRECTIONS)             !< of ln(1 + e) at its start
      real(wp) :: p_c0(DIRECTIONS)           !< of its first suction
      real(wp) :: nucleus(6, DIRECTIONS)     !< of the strain from the nucleus' centre at its start
   end type driving_t

   !> Derivatives along the seven directions.
   type :: sensitivity_t
      real(wp) :: y(NY, DIRECTIONS)          !< of sigma', z and the plastic shear of the present process
      real(wp) :: r_in(6, DIRECTIONS)        !< of the memory
      real(wp) :: r_before(6, DIRECTIONS)    !< of the memory of the process before, or of the suspended one
      type(driving_t) :: driving
   end type sensitivity_t
contains
   !> At the start of an increment nothing depends on it yet.
   pure function no_sensitivity() result(sens)
      type(sensitivity_t) :: sens

      sens%y = 0.0_wp
      sens%r_in = 0.0_wp
      sens%r_before = 0.0_wp
      sens%driving = whole_increment()
   end function no_sensitivity

   pure function whole_increment() result(driving)
      type(driving_t) :: driving
      integer :: j

      driving%d_strain = 0.0_wp
      do j = 1, 6
         driving%d_strain(j, j) = merge(1.0_wp, 0.5_wp, j <= 3)
      end do
      driving%d_v = [1.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
      driving%d_pc = [0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp]
      driving%e0 = 0.0_wp
      driving%p_c0 = 0.0_wp
      driving%nucleus = 0.0_wp
   end function whole_increment

   !> The share of the increment inside the nucleus: it depends on the strain itself.
   pure subroutine enter_nucleus(whole, share, sens)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share
      type(sensitivity_t), intent(inout) :: sens

      call scale_driving(whole, share, 1.0_wp, sens%driving)
   end subroutine enter_nucleus

   !> The rest of the increment.
   pure subroutine leave_nucleus(whole, share, sens)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share
      type(sensitivity_t), intent(inout) :: sens
      type(driving_t) :: inside
      integer :: j

      inside = whole_increment()
      call scale_driving(whole, share, 1.0_wp, inside)
      sens%driving = whole_increment()
      call scale_driving(whole, share, -1.0_wp, sens%driving)
      do j = 1, DIRECTIONS
         sens%driving%nucleus(:, j) = inside%d_strain(:, j)
         sens%driving%e0(j) = -inside%d_v(j)
         sens%driving%p_c0(j) = inside%d_pc(j)
      end do
   end subroutine leave_nucleus

   !> Derivatives of share (side +1) or 1 - share (side -1) times the increment.
   pure subroutine scale_driving(whole, share, side, driving)
      type(increment_t), intent(in) :: whole
      real(wp), intent(in) :: share, side
      type(driving_t), intent(inout) :: driving
      real(wp), parameter :: AT_REST(6) = 0.0_wp
      real(wp) :: length, change
      integer :: j

      length = merge(share, 1.0_wp - share, side > 0.0_wp)
      do j = 1, DIRECTIONS
         change = 0.0_wp
         if (share > 0.0_wp .and. share < 1.0_wp) then
            change = side*change_of_exit(whole%nucleus, whole%d_strain, share, AT_REST, driving%d_strain(:, j))
         end if
         driving%d_strain(:, j) = length*driving%d_strain(:, j) + change*whole%d_strain
         driving%d_v(j) = length*driving%d_v(j) + change*whole%d_v
         driving%d_pc(j) = length*driving%d_pc(j) + change*whole%d_pc
      end do
   end subroutine scale_driving

   !> Carries the derivatives through an accepted substep h.
   pure subroutine propagate(par, inc, trial, h, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      type(sensitivity_t), intent(inout) :: sens

      if (trial%mode == MODE_HELD) then
         sens%y(1:6, :) = 0.0_wp   ! an open point has no stiffness
      else
         call through_stages(par, inc, trial, h, sens%r_in, sens%driving, sens%y)
      end if
   end subroutine propagate

   !> The scheme applied to all directions as one long vector.
   pure subroutine through_stages(par, inc, trial, h, r_in, driving, y1)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h, r_in(6, DIRECTIONS)
      type(driving_t), intent(in) :: driving
      real(wp), intent(inout) :: y1(NY*DIRECTIONS)
      real(wp) :: rates(NY*DIRECTIONS, MAX_STAGES), y0(NY*DIRECTIONS), y(NY*DIRECTIONS), point(NY)
      integer :: i, last

      ! the last stage of such a pair serves the error estimate and the next substep, not the solution
      last = inc%scheme%stages
      if (inc%scheme%first_same_as_last) last = last - 1
      y0 = y1
      y = y0
      point = trial%y0
      do i = 1, last
         if (i > 1) then
            call stage_point(inc%scheme, i, y0, rates, h, y)
            call stage_point(inc%scheme, i, trial%y0, trial%rates, h, point)
         end if
         call change_of_stage(par, inc, trial%mode, trial%w(i), point, trial%time + inc%scheme%node(i)*h, r_in, &
                              driving, y, rates(:, i))
      end do
      call solution(inc%scheme, y0, rates, h, y1)
   end subroutine through_stages

   !> Derivatives of one stage's rates.
   pure subroutine change_of_stage(par, inc, mode, w, point, time, r_in, driving, y, rates)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: point(NY), time, r_in(6, DIRECTIONS), y(NY, DIRECTIONS)
      type(driving_t), intent(in) :: driving
      real(wp), intent(out) :: rates(NY, DIRECTIONS)
      type(linearised_t) :: lin
      type(change_t) :: changes(DIRECTIONS)
      real(wp) :: e
      integer :: j

      e = void_ratio_at(inc, time)
      call linearise_stage(par, inc, mode, w, point, time, e, lin)
      do j = 1, DIRECTIONS
         call direction(inc, mode, j, time, e, y(:, j), r_in(:, j), driving, changes(j))
      end do
      call changes_of_rate(par, w, lin, DIRECTIONS, changes, rates)
   end subroutine change_of_stage

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

   !> How the arguments of a rate change along a direction.
   pure subroutine direction(inc, mode, j, time, e, y, r_in, driving, change)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode, j
      real(wp), intent(in) :: time, e, y(NY), r_in(6)
      type(driving_t), intent(in) :: driving
      type(change_t), intent(inout) :: change

      change%sigma = y(1:6)
      change%z = y(7:12)
      change%r_in = r_in
      change%d_strain = driving%d_strain(:, j)
      change%e = (1.0_wp + e)*(driving%e0(j) - time*driving%d_v(j))
      change%d_pc = driving%d_pc(j)
      change%p_c = driving%p_c0(j) + time*driving%d_pc(j)
      if (has_aside(inc, mode)) then
         call change_of_loading_strain(inc, mode, time, driving%d_strain(:, j), driving%nucleus(:, j), &
                                       change%d_strain, change%d_aside)
      end if
   end subroutine direction

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
      type(linearised_t) :: lin
      type(change_t) :: change
      real(wp) :: p, r(6), dr(6), dn(6), d_sigma(6), d_z(6), d_eps_q, m, dm, e, old_r_in(6), new_r_in(6)
      integer :: j
      logical :: held_p, inner

      if (jump == JUMP_RESUME) then
         sens%r_in = sens%r_before
         return
      end if
      call stress_ratio(par, trial%y0(1:6), p, r)
      e = void_ratio_at(inc, trial%time)
      held_p = trace(trial%y0(1:6)) < 3.0_wp*par%p_min
      if (jump == JUMP_RESEAT .and. par%memory_rule == RULE_REPOSITIONING) then
         call linearise_stage(par, inc, MODE_ORDINARY, trigger, trial%y0, trial%time, e, lin)
      end if
      ! a re-seat while a process is suspended leaves its memory and the plastic shear since the turn (rule resume)
      inner = jump == JUMP_RESEAT .and. par%memory_rule == RULE_RESUME .and. before%suspended
      m = 0.0_wp
      if (before%eps_q_p < par%eps_hat) m = 1.0_wp - (before%eps_q_p/par%eps_hat)**par%j_exp
      do j = 1, DIRECTIONS
         dr = deviator(sens%y(1:6, j))/p
         if (.not. held_p) dr = dr - (trace(sens%y(1:6, j))/(3.0_wp*p))*r
         dm = 0.0_wp
         if (m > 0.0_wp .and. before%eps_q_p > 0.0_wp) dm = -par%j_exp*(1.0_wp - m)/before%eps_q_p*sens%y(13, j)
         old_r_in = sens%r_in(:, j)
         new_r_in = dr
         if (jump == JUMP_RESEAT) then
            select case (par%memory_rule)
            case (RULE_THRESHOLD)
               ! a fall-back left r_in at r
               if (any(abs(after%r_in - r) > 0.0_wp)) then
                  new_r_in = (1.0_wp - m)*dr + m*sens%r_before(:, j) + dm*(before%r_before - r)
               end if
            case (RULE_REPOSITIONING)
               call direction(inc, MODE_ORDINARY, j, trial%time, e, sens%y(:, j), old_r_in, sens%driving, change)
               call change_of_rate(par, trigger, lin, change, d_sigma, d_z, d_eps_q, dn)
               new_r_in = dr - before%x_before*(m*dn + dm*trigger%n)
            end select
         end if
         sens%r_in(:, j) = new_r_in
         if (inner) cycle
         sens%r_before(:, j) = merge(dr, old_r_in, jump == JUMP_NEW)
         sens%y(13, j) = 0.0_wp
      end do
   end subroutine jump_of_memory
end module mud_consistent
