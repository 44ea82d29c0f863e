! SPDX-License-Identifier: MIT
!> One increment at one integration point: substeps of rates, with the jumps of memory between them.
module mud_point
   use mud_kinds, only: wp
   use mud_blocks, only: blocks_t, elastic_blocks, continuum_blocks
   use mud_branches, only: course_t, begin_course, integrate_course, end_course
   use mud_checks, only: check_increment
   use mud_consistent, only: sensitivity_t, no_sensitivity
   use mud_extent, only: extent_of
   use mud_increment, only: increment_t, new_increment, void_ratio_at
   use mud_params, only: params_t
   use mud_phases, only: integrate_phases
   use mud_start, only: initial_state, lift_to_limit, finish_state, has_tension
   use mud_state, only: state_t, counters_t, E_LOWER, E_UPPER
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_VOID_RATIO_LIMIT, ON_VOID_RATIO
   use mud_trace, only: trace_t
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: blocks_t, initial_state, update_point, TANGENT_NONE, TANGENT_ELASTIC, TANGENT_CONTINUUM, TANGENT_CONSISTENT

   integer, parameter :: TANGENT_NONE = 0, TANGENT_ELASTIC = 1, TANGENT_CONTINUUM = 2, TANGENT_CONSISTENT = 3

contains
   !> Integrates d_strain and d_pc. On failure state1 and blocks are undefined and state0 is what it was. MUD_BAD_INPUT,
   !> MUD_INCREMENT_TOO_LARGE and MUD_VOID_RATIO_LIMIT refuse the increment beforehand, MUD_TOO_MANY_SUBSTEPS,
   !> MUD_MINIMUM_STEP, MUD_NOT_FINITE and MUD_NO_DIRECTION end it. docs/theory/integration.md section 1.
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

      reached = 0.0_wp
      call check_increment(par, state0, d_strain, d_pc, status)
      if (status%code /= MUD_OK) return
      call new_increment(par, state0%e, state0%p_c, d_strain, d_pc, inc)
      if (void_ratio_at(inc, 1.0_wp) <= E_LOWER .or. void_ratio_at(inc, 1.0_wp) >= E_UPPER) then
         status = fail(MUD_VOID_RATIO_LIMIT, ON_VOID_RATIO, 0, void_ratio_at(inc, 1.0_wp), E_LOWER, E_UPPER)
         return
      end if

      state1 = state0
      if (par%hysteresis) then
         call update_between_curves(par, inc, tangent, state1, blocks, counters, reached, status, record)
      else
         call update_on_curve(par, inc, tangent, state1, blocks, counters, reached, status, record)
      end if
      if (status%code /= MUD_OK) return
      reached = 1.0_wp
      if (has_tension(state1%sigma)) counters%tensile = 1
   end subroutine update_point

   !> S_w a function of suction and void ratio.
   pure subroutine update_on_curve(par, inc, tangent, state1, blocks, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc
      integer, intent(in) :: tangent
      type(state_t), intent(inout) :: state1
      type(blocks_t), intent(inout) :: blocks
      type(counters_t), intent(inout) :: counters
      real(wp), intent(inout) :: reached
      type(mud_status_t), intent(inout) :: status
      type(trace_t), intent(inout), optional :: record
      type(trial_t) :: trial
      type(sensitivity_t) :: sens
      real(wp) :: size, p_c1
      logical :: consistent

      p_c1 = state1%p_c + inc%d_pc
      call begin(par, inc, tangent, state1, size, consistent, sens)
      if (size > 0.0_wp) then
         call integrate_phases(par, inc, size, consistent, state1, trial, sens, counters, reached, status, record)
      end if
      if (status%code /= MUD_OK) return
      state1%e = void_ratio_at(inc, 1.0_wp)
      state1%p_c = p_c1
      call finish_state(par, state1, blocks)
      call fill_blocks(par, inc, tangent, size, consistent, trial, sens, state1, blocks)
   end subroutine update_on_curve

   !> S_w a state between two curves (hydraulic hysteresis).
   pure subroutine update_between_curves(par, inc, tangent, state1, blocks, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc
      integer, intent(in) :: tangent
      type(state_t), intent(inout) :: state1
      type(blocks_t), intent(inout) :: blocks
      type(counters_t), intent(inout) :: counters
      real(wp), intent(inout) :: reached
      type(mud_status_t), intent(inout) :: status
      type(trace_t), intent(inout), optional :: record
      type(trial_t) :: trial
      type(sensitivity_t) :: sens
      type(params_t) :: branch
      type(course_t) :: course
      real(wp) :: size, p_c1
      logical :: consistent

      p_c1 = state1%p_c + inc%d_pc
      call begin_course(par, inc, state1, counters, course, branch)
      call begin(branch, inc, tangent, state1, size, consistent, sens)
      if (size > 0.0_wp) then
         call integrate_course(par, course, inc, size, consistent, branch, state1, trial, sens, counters, reached, &
                               status, record)
      end if
      if (status%code /= MUD_OK) return
      state1%e = void_ratio_at(inc, 1.0_wp)
      state1%p_c = p_c1
      call finish_state(branch, state1, blocks)
      call end_course(par, course, state1, counters, blocks)
      call fill_blocks(branch, inc, tangent, size, consistent, trial, sens, state1, blocks)
   end subroutine update_between_curves

   !> A stress below its limit is lifted; size is that of the increment, in units of strain [-].
   pure subroutine begin(par, inc, tangent, state1, size, consistent, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: tangent
      type(state_t), intent(inout) :: state1
      real(wp), intent(out) :: size
      logical, intent(out) :: consistent   !< Derivatives are wanted, and there is something to derive.
      type(sensitivity_t), intent(inout) :: sens

      if (par%cutoff) call lift_to_limit(par, inc%bonded, state1)
      size = extent_of(par, inc, state1)
      consistent = tangent == TANGENT_CONSISTENT .and. size > 0.0_wp
      if (consistent) call no_sensitivity(state1%memory%depth, sens)
   end subroutine begin

   !> The tangent that is asked for, at the end.
   pure subroutine fill_blocks(par, inc, tangent, size, consistent, trial, sens, state1, blocks)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc   !< the phase that ended the increment
      integer, intent(in) :: tangent
      real(wp), intent(in) :: size
      logical, intent(in) :: consistent
      type(trial_t), intent(in) :: trial
      type(sensitivity_t), intent(in) :: sens
      type(state_t), intent(in) :: state1
      type(blocks_t), intent(inout) :: blocks

      if (consistent) then
         blocks%dsig_deps = transpose(sens%y(1:6, 1:6))
         blocks%dsig_dpc = sens%y(7, 1:6)
      else if (tangent == TANGENT_CONTINUUM .and. size > 0.0_wp) then
         call continuum_blocks(par, inc, trial, state1, blocks)
      else if (tangent /= TANGENT_NONE) then
         call elastic_blocks(par, state1, blocks)
      end if
   end subroutine fill_blocks
end module mud_point
