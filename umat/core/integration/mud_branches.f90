! SPDX-License-Identifier: MIT
!> Hydraulic hysteresis along an increment: where the modified suction x = p_c e^Omega turns, and the scanning curve on
!> either side; docs/theory/material.md section 2.1.1. Void ratio and suction are known beforehand at every pseudo-time,
!> so both are exact: nothing here depends on substeps.
module mud_branches
   use mud_kinds, only: wp
   use mud_blocks, only: blocks_t
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_integration, only: integration_t
   use mud_params, only: params_t
   use mud_retention, only: saturation_t, saturation, change_of_offset, offset_with_turn
   use mud_scanning, only: branch_from, clipped, main_curve
   use mud_state, only: state_t, counters_t
   implicit none (type, external)
   private
   public :: course_t, begin_course, turn_around, end_course

   integer, parameter :: HALVINGS = 60            !< Of an increment: more than a double can tell apart.

   !> How S_w changes through an increment.
   type :: course_t
      real(wp) :: turn        !< Share of the increment after which x no longer rises, 1 if it does not turn [-].
      real(wp) :: s_w         !< At the start, between the main curves [-].
      logical :: at_rest      !< x does not change.
      type(params_t) :: branch   !< Parameters whose saturation is that of the present scanning curve.
      real(wp) :: change_pc, change_v   !< Of S_w at the end with suction step and volume, through the turn [1/kPa, -].
   end type course_t
contains
   !> Clips S_w of the state that an increment begins with and finds the first branch; a saturation that was clipped is
   !> counted. docs/theory/material.md section 2.1.1.
   pure subroutine begin_course(par, inc, state, counters, course)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(state_t), intent(inout) :: state
      type(counters_t), intent(inout) :: counters
      type(course_t), intent(out) :: course
      logical :: dries

      call clipped(par, inc%p_c0, inc%e0, state%s_w, counters%clip)
      course%s_w = state%s_w
      course%change_pc = 0.0_wp
      course%change_v = 0.0_wp
      course%at_rest = abs(inc%d_pc) <= 0.0_wp .and. abs(inc%d_v) <= 0.0_wp
      course%turn = turn_of_suction(par%omega, inc)
      dries = course%at_rest .or. rise(par%omega, inc, 0.0_wp) > 0.0_wp
      course%branch = branch_from(par, dries, inc%p_c0, inc%e0, state%s_w)
   end subroutine begin_course

   !> e^-Omega dx/dt [kPa], t the share of the increment.
   pure real(wp) function rise(omega, inc, time)
      real(wp), intent(in) :: omega, time
      type(increment_t), intent(in) :: inc
      real(wp) :: e

      e = void_ratio_at(inc, time)
      rise = inc%d_pc - max(suction_at(inc, time), 0.0_wp)*omega*inc%d_v*(1.0_wp + e)/e
   end function rise

   !> Where x turns: suction is linear, and where x is stationary it has a maximum (its second derivative is negative
   !> there), so there is one turn at most, from drying to wetting.
   pure real(wp) function turn_of_suction(omega, inc) result(turn)
      real(wp), intent(in) :: omega
      type(increment_t), intent(in) :: inc
      real(wp) :: before, middle
      integer :: i

      turn = 1.0_wp
      if (.not. (rise(omega, inc, 0.0_wp) > 0.0_wp .and. rise(omega, inc, 1.0_wp) < 0.0_wp)) return
      before = 0.0_wp
      do i = 1, HALVINGS
         middle = 0.5_wp*(before + turn)
         if (rise(omega, inc, middle) > 0.0_wp) then
            before = middle
         else
            turn = middle
         end if
      end do
   end function turn_of_suction

   !> The wetting branch behind a turn, how q ln of its offset changes with suction step and volume of the increment,
   !> and how S_w at the end does through that. x is stationary where it turns: the place of the turn does not matter.
   !> docs/theory/material.md section 2.1.1.
   pure subroutine turn_around(par, share, course, it)
      type(params_t), intent(in) :: par      !< Of the material.
      real(wp), intent(in) :: share          !< Where it turns [-].
      type(course_t), intent(inout) :: course
      type(integration_t), intent(inout) :: it
      type(saturation_t) :: before, finish
      type(params_t) :: turned
      real(wp) :: p_c, e, with_offset(3), with_turn(2)

      p_c = suction_at(it%inc, share)
      e = void_ratio_at(it%inc, share)
      before = saturation(course%branch, p_c, e)
      turned = branch_from(par, .false., p_c, e, before%s_w)
      with_turn = share*[1.0_wp/p_c, -par%omega*(1.0_wp + e)/e] &
                  *offset_with_turn(turned, before, saturation(turned, p_c, e), p_c, e)
      if (it%consistent) then
         it%sens%driving%scans = turned%scanning%between
         it%sens%driving%offset = with_turn(1)*it%sens%driving%d_pc + with_turn(2)*it%sens%driving%d_v
      end if
      course%branch = turned
      p_c = suction_at(it%inc, 1.0_wp)
      e = void_ratio_at(it%inc, 1.0_wp)
      finish = saturation(turned, p_c, e)
      with_offset = change_of_offset(turned, finish, p_c, e)
      course%change_pc = with_offset(1)*with_turn(1)
      course%change_v = with_offset(1)*with_turn(2)
   end subroutine turn_around

   !> S_w at the end, between the main curves, with the slopes of what it follows there. A saturation that was clipped
   !> is counted and has the slopes of the main curve. docs/theory/material.md section 2.1.1.
   pure subroutine end_course(par, course, state, counters, blocks)
      type(params_t), intent(in) :: par
      type(course_t), intent(in) :: course
      type(state_t), intent(inout) :: state      !< e, p_c and, along the branch, s_w are those of the end.
      type(counters_t), intent(inout) :: counters
      type(blocks_t), intent(inout) :: blocks
      type(saturation_t) :: curve
      real(wp) :: s_w
      integer :: count

      if (course%at_rest) state%s_w = course%s_w
      s_w = state%s_w
      count = 0
      call clipped(par, state%p_c, state%e, state%s_w, count)
      if (count == 0) then
         blocks%dsw_dpc = blocks%dsw_dpc + course%change_pc
         blocks%dsw_dev = blocks%dsw_dev + course%change_v
         return
      end if
      counters%clip = counters%clip + count
      curve = saturation(main_curve(par, state%s_w < s_w), state%p_c, state%e)
      blocks%dsw_dpc = curve%ds_dpc
      blocks%dsw_dev = -(1.0_wp + state%e)*curve%ds_de
   end subroutine end_course
end module mud_branches
