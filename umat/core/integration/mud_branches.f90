! SPDX-License-Identifier: MIT
!> Hydraulic hysteresis along an increment: where the modified suction x = p_c e^Omega turns and passes turning points,
!> and the branch in between; docs/theory/material.md section 2.1.1. Void ratio and suction are known beforehand at
!> every pseudo-time, so all of this is: nothing here depends on substeps.
module mud_branches
   use mud_kinds, only: wp
   use mud_increment, only: increment_t, void_ratio_at, suction_at, SHORTEST_PHASE
   use mud_params, only: params_t
   use mud_registry, only: MAX_TURNS
   use mud_retention, only: retention_t, saturation_t, change_with_turn, log_suction, curve_at
   use mud_scanning, only: path_t, move_along, list_passed, branch_of, begin_at_turn, saturation_after, &
                           keep_turns, find_least
   use mud_state, only: state_t, counters_t
   implicit none (type, external)
   private
   public :: course_t, slopes_of_suction, begin_course, list_kinks, take_branch, turn_around, end_course, MAX_KINKS

   integer, parameter :: HALVINGS = 60   !< Number of halvings of an increment: more than a double can tell apart.
   integer, parameter :: MAX_KINKS = 3*MAX_TURNS  !< Turning points to a turn and from it, and contacts.
   real(wp), parameter :: INSIDE = 1.0e-6_wp      !< A contact this close to an end of a way is that end [-].

   !> Way of S_w through an increment.
   type :: course_t
      real(wp) :: turn        !< Share of the increment after which x no longer rises, 1 if it does not turn [-].
      real(wp) :: log_turn, log_end   !< ln(x/P_a) there and at the end [-].
      type(retention_t) :: material   !< Without a branch.
      type(path_t) :: path    !< Where x began to go the way that it goes: at the start, or at the turn.
      logical :: turned
      real(wp) :: slope       !< dS_w/d ln x where it turned, of the branch before [-].
      real(wp) :: with_increment(2)   !< d ln x there with suction step and volume [1/kPa, -].
   end type course_t
contains
   !> The turn of an increment, and the way of x to it. A state that is not on its branch loses its turning points,
   !> which is counted. docs/theory/material.md section 2.1.1.
   pure subroutine begin_course(par, inc, state, counters, course)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc   !< It gets the branch at the start.
      type(state_t), intent(in) :: state
      type(counters_t), intent(inout) :: counters
      type(course_t), intent(out) :: course
      logical :: cleared

      course%material = par%suction%retention_t
      if (.not. course%material%least%known) course%material%least = find_least(course%material)
      course%path = path_t(log_at(course%material, inc, 0.0_wp), state%s_w, state%turns)
      call keep_turns(course%material, course%path, cleared)
      if (cleared) counters%cleared = counters%cleared + 1
      course%turned = .false.
      course%slope = 0.0_wp
      course%with_increment = 0.0_wp
      course%turn = turn_of_suction(course%material%omega, inc)
      if (course%turn < SHORTEST_PHASE .or. course%turn > 1.0_wp - SHORTEST_PHASE) course%turn = 1.0_wp
      course%log_turn = log_at(course%material, inc, course%turn)
      course%log_end = log_at(course%material, inc, 1.0_wp)
      inc%suction%retention_t = branch_of(course%material, course%path)
   end subroutine begin_course

   !> ln(x/P_a) at a pseudo-time [-].
   pure real(wp) function log_at(material, inc, time)
      type(retention_t), intent(in) :: material
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time

      log_at = log_suction(material, suction_at(inc, time), void_ratio_at(inc, time))
   end function log_at

   !> e^-Omega dx/dt [kPa], t the share of the increment.
   pure real(wp) function rise(omega, inc, time)
      real(wp), intent(in) :: omega, time
      type(increment_t), intent(in) :: inc
      real(wp) :: e

      e = void_ratio_at(inc, time)
      rise = inc%d_pc - max(suction_at(inc, time), 0.0_wp)*omega*inc%d_v*(1.0_wp + e)/e
   end function rise

   !> Time at which x turns: suction is linear, and where x is stationary it has a maximum (its second derivative is
   !> negative there), so there is one turn at most, from drying to wetting.
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

   !> Pseudo-times at which S_w has a kink, n of them: x passes a turning point, or the branch meets a main curve or the
   !> branch that it left. All of them depend on x alone, so they are known beforehand, behind a turn too.
   !> docs/theory/material.md section 2.1.1.
   pure subroutine list_kinks(inc, course, times, n)
      type(increment_t), intent(in) :: inc
      type(course_t), intent(in) :: course
      real(wp), intent(out) :: times(MAX_KINKS)   !< Times of the kinks; entries beyond n have no meaning [-].
      integer, intent(out) :: n
      type(retention_t) :: branch
      type(path_t) :: path
      type(saturation_t) :: sat

      n = 0
      times = 0.0_wp
      path = course%path
      call list_on_way(inc, course%material, path, 0.0_wp, course%turn, course%log_turn, times, n)
      if (course%turn >= 1.0_wp) return
      call saturation_after(course%material, suction_at(inc, course%turn), void_ratio_at(inc, course%turn), path, sat, &
                            branch)
      call list_on_way(inc, course%material, path, course%turn, 1.0_wp, course%log_end, times, n)
   end subroutine list_kinks

   !> Lists the kinks on a way of x in one direction.
   pure subroutine list_on_way(inc, material, start, from, to, log_to, times, n)
      type(increment_t), intent(in) :: inc
      type(retention_t), intent(in) :: material
      type(path_t), intent(in) :: start
      real(wp), intent(in) :: from, to, log_to   !< Pseudo-times of the way; ln x at its end [-].
      real(wp), intent(inout) :: times(MAX_KINKS)
      integer, intent(inout) :: n
      type(path_t) :: path
      real(wp) :: passed(MAX_TURNS/2), before, behind
      integer :: i, k

      path = start
      call list_passed(log_to, path, passed, k)
      before = from
      do i = 1, k + 1
         behind = to
         if (i <= k) behind = time_of_passing(material, inc, from, to, passed(i))
         call list_contacts(inc, material, start, before, behind, times, n)
         if (i <= k) call add_time(behind, times, n)
         before = behind
      end do
   end subroutine list_on_way

   !> Lists the kinks between two turning points that are passed: places where another curve is followed.
   pure subroutine list_contacts(inc, material, start, from, to, times, n)
      type(increment_t), intent(in) :: inc
      type(retention_t), intent(in) :: material
      type(path_t), intent(in) :: start
      real(wp), intent(in) :: from, to
      real(wp), intent(inout) :: times(MAX_KINKS)
      integer, intent(inout) :: n
      type(retention_t) :: branch
      type(path_t) :: path
      real(wp) :: before, behind, last, middle
      integer :: curve, at_last, i, k

      path = start
      call move_along(material, log_at(material, inc, 0.5_wp*(from + to)), path)
      branch = branch_of(material, path)
      before = from + INSIDE*(to - from)
      last = to - INSIDE*(to - from)
      if (min(suction_at(inc, before), suction_at(inc, last)) <= 0.0_wp) return
      curve = curve_at(branch, log_at(material, inc, before))
      at_last = curve_at(branch, log_at(material, inc, last))
      do k = 1, MAX_TURNS
         if (curve == at_last) return
         behind = last
         do i = 1, HALVINGS
            middle = 0.5_wp*(before + behind)
            if (curve_at(branch, log_at(material, inc, middle)) == curve) then
               before = middle
            else
               behind = middle
            end if
         end do
         call add_time(behind, times, n)
         before = behind
         curve = curve_at(branch, log_at(material, inc, before))
      end do
   end subroutine list_contacts

   pure subroutine add_time(time, times, n)
      real(wp), intent(in) :: time
      real(wp), intent(inout) :: times(MAX_KINKS)
      integer, intent(inout) :: n

      if (n == MAX_KINKS) return
      n = n + 1
      times(n) = time
   end subroutine add_time

   !> Pseudo-time in a range at which ln(x/P_a), which goes one way there, has a value [-].
   pure real(wp) function time_of_passing(material, inc, from, to, log_x) result(time)
      type(retention_t), intent(in) :: material
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: from, to, log_x
      real(wp) :: before, middle
      logical :: dries
      integer :: i

      dries = log_at(material, inc, to) > log_at(material, inc, from)
      before = from
      time = to
      do i = 1, HALVINGS
         middle = 0.5_wp*(before + time)
         if (dries .eqv. log_at(material, inc, middle) < log_x) then
            before = middle
         else
            time = middle
         end if
      end do
   end function time_of_passing

   !> The branch of the phase of an increment; its middle tells what x has passed.
   pure subroutine take_branch(course, inc)
      type(course_t), intent(in) :: course
      type(increment_t), intent(inout) :: inc

      call follow(log_at(course%material, inc, 0.5_wp*(inc%from + inc%to)), course, inc%suction%retention_t)
   end subroutine take_branch

   !> The branch on which x goes to a value [-].
   pure subroutine follow(log_x, course, branch)
      real(wp), intent(in) :: log_x
      type(course_t), intent(in) :: course
      type(retention_t), intent(out) :: branch
      type(path_t) :: path

      path = course%path
      call move_along(course%material, log_x, path)
      if (begins_at_turn(course, path)) then
         branch = begin_at_turn(course%material, path, course%slope)
      else
         branch = branch_of(course%material, path)
      end if
   end subroutine follow

   !> True if the present branch begins where the increment turned.
   pure logical function begins_at_turn(course, path)
      type(course_t), intent(in) :: course
      type(path_t), intent(in) :: path

      begins_at_turn = course%turned .and. path%turns%depth > 0
      if (begins_at_turn) begins_at_turn = abs(path%turns%log_x(path%turns%depth) - course%log_turn) <= 0.0_wp
   end function begins_at_turn

   !> Adds the turn of x to the path: the turning point goes with suction step and volume of the increment. x is
   !> stationary there: its place does not matter. docs/theory/material.md section 2.1.1.
   pure subroutine turn_around(inc, course)
      type(increment_t), intent(in) :: inc
      type(course_t), intent(inout) :: course
      type(saturation_t) :: sat
      type(retention_t) :: branch
      real(wp) :: p_c

      p_c = suction_at(inc, course%turn)
      call saturation_after(course%material, p_c, void_ratio_at(inc, course%turn), course%path, sat, branch)
      course%slope = sat%ds_dpc*p_c
      course%turned = .true.
      course%with_increment = course%turn*slopes_of_suction(inc, course%turn, course%material%omega)
   end subroutine turn_around

   !> Derivatives of ln x, x the modified suction p_c e^Omega, by suction [1/kPa] and volume [-]. Suction is positive
   !> there, which is not checked. docs/theory/material.md section 2.1.1.
   pure function slopes_of_suction(inc, time, omega) result(slopes)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, omega
      real(wp) :: slopes(2), e

      e = void_ratio_at(inc, time)
      slopes = [1.0_wp/suction_at(inc, time), -omega*(1.0_wp + e)/e]
   end function slopes_of_suction

   !> S_w and turning points at the end, the branch there, and what the turn adds to the slopes of S_w.
   !> docs/theory/material.md section 2.1.1.
   pure subroutine end_course(inc, course, state, with_turn)
      type(increment_t), intent(inout) :: inc   !< It gets the branch at the end.
      type(course_t), intent(in) :: course
      type(state_t), intent(inout) :: state
      real(wp), intent(out) :: with_turn(2)   !< By suction step and volume [1/kPa, -].
      type(saturation_t) :: sat
      type(retention_t) :: branch
      type(path_t) :: path
      real(wp) :: p_c, e, change(3)

      p_c = suction_at(inc, 1.0_wp)
      e = void_ratio_at(inc, 1.0_wp)
      path = course%path
      call saturation_after(course%material, p_c, e, path, sat, branch)
      state%s_w = path%s_w
      state%turns = path%turns
      with_turn = 0.0_wp
      inc%suction%retention_t = branch
      if (.not. begins_at_turn(course, path)) return
      inc%suction%retention_t = begin_at_turn(course%material, path, course%slope)
      change = change_with_turn(inc%suction%retention_t, p_c, e)
      with_turn = change(1)*course%with_increment
   end subroutine end_course
end module mud_branches
