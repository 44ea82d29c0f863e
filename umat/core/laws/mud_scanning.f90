! SPDX-License-Identifier: MIT
!> Hydraulic hysteresis: S_w between a main drying and a main wetting curve, with the points where suction turned;
!> docs/theory/material.md section 2.1.1. While the modified suction x = p_c e^Omega rises, or while it falls, between
!> two turning points that it passes, S_w is a function of x alone. So a phase of an increment is integrated with the
!> retention that has this function. Suctions are ln(x/P_a) here.
module mud_scanning
   use mud_kinds, only: wp
   use mud_registry, only: P_P_AW, S_SATURATION, MAX_TURNS
   use mud_retention, only: retention_t, branch_t, least_t, MAX_LEAST, NO_BRANCH, NO_OFFSET, saturation_t, &
      saturation, along_t, along_raw_branch, follow_branches, main_curve_t, main_curve, on_main_curve_t, &
      on_main_curve, suction_on_curve, power_of, log_suction, NO_SUCTION, ON_CURVE
   use mud_state, only: turns_t, NO_TURNS
   use mud_status, only: mud_status_t, fail, MUD_BAD_PROPS, MUD_BAD_STATE, ON_PROPS, ON_STATEV
   use mud_tensor, only: is_finite
   implicit none (type, external)
   private
   public :: path_t, begin_path, move_along, list_passed, branch_of, saturation_after, keep_turns, begin_at_turn, &
             find_least, check_curves, check_saturation, preset_saturation

   real(wp), parameter :: PRESET_ROUNDING = 1.0e-6_wp   !< Rounding of a preset of six digits, as a share of S_max [-].
   !> Suctions at which the main curves are compared: from S_w = S_max but some 1e-8 to a million times P_a; ln(x/P_a)
   !> of both ends, the first with n. AS_MUCH: what rounding so close to S_max makes of ln P_aw [-].
   integer, parameter :: POINTS = 200
   real(wp), parameter :: WET_END = -18.0_wp, DRY_END = 14.0_wp, AS_MUCH = 1.0e-6_wp
   integer, parameter :: HALVINGS = 50
   real(wp), parameter :: LARGEST_SCALE = 1.0e6_wp      !< Scale of a branch beyond which its loop is rounding [-].

   !> Place of a point on its way between the main curves.
   type :: path_t
      real(wp) :: log_x, s_w   !< The present point [-].
      type(turns_t) :: turns
   end type path_t
contains
   !> A point without a past at ln(x/P_a) and S_w [-]: it dries, and wets where it is on the main wetting curve.
   !> docs/theory/material.md section 2.1.1.
   pure function begin_path(self, log_x, s_w) result(path)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: log_x, s_w
      type(path_t) :: path
      type(on_main_curve_t) :: dry, wet

      path = path_t(log_x, s_w, NO_TURNS)
      dry = on_main_curve(self, main_curve(self, .true.), log_x)
      wet = on_main_curve(self, main_curve(self, .false.), log_x)
      path%turns%dries = abs(s_w - wet%s_w) > ON_CURVE*self%s_max .or. abs(s_w - dry%s_w) <= ON_CURVE*self%s_max
   end function begin_path

   !> The turning points with which a point moves to a suction: a reversal adds the present one, and what is passed on
   !> the way is forgotten with the loop that it closes. The present point is then where the branch that remains was
   !> joined. Nothing happens where it does not move. docs/theory/material.md section 2.1.1.
   pure subroutine move_along(self, to, path)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: to   !< ln(x/P_a), NO_SUCTION where there is none [-].
      type(path_t), intent(inout) :: path

      integer :: n
      real(wp) :: passed(MAX_TURNS/2)

      call list_passed(to, path, passed, n)
      if (to <= NO_SUCTION) path = path_t(NO_SUCTION, self%s_max, NO_TURNS)
   end subroutine move_along

   !> Moves a path along and lists the suctions of the n turning points that are passed, in their order; without suction
   !> they are kept.
   pure subroutine list_passed(to, path, passed, n)
      real(wp), intent(in) :: to
      type(path_t), intent(inout) :: path
      real(wp), intent(out) :: passed(MAX_TURNS/2)   !< ln(x/P_a); beyond n without meaning [-].
      integer, intent(out) :: n
      logical :: dries

      n = 0
      passed = 0.0_wp
      if (abs(to - path%log_x) <= 0.0_wp) return
      dries = to > path%log_x
      associate (turns => path%turns)
         if (dries .neqv. turns%dries) then
            if (turns%depth == MAX_TURNS) turns%depth = turns%depth - 2   ! the smallest loop
            turns%depth = turns%depth + 1
            turns%log_x(turns%depth) = path%log_x
            turns%s_w(turns%depth) = path%s_w
            turns%dries = dries
         end if
         do while (turns%depth >= 2)
            if (merge(to < turns%log_x(turns%depth - 1), to > turns%log_x(turns%depth - 1), dries)) exit
            turns%depth = turns%depth - 2
            path%log_x = turns%log_x(turns%depth + 1)
            path%s_w = turns%s_w(turns%depth + 1)
            n = n + 1
            passed(n) = path%log_x
         end do
      end associate
   end subroutine list_passed

   !> The retention along the branch of a point. Closed form of docs/theory/material.md section
   !> 2.1.1; nothing is refused.
   pure function branch_of(self, path) result(branch)
      type(retention_t), intent(in) :: self
      type(path_t), intent(in) :: path
      type(retention_t) :: branch
      integer :: k
      logical :: dries

      branch = self
      if (.not. branch%least%known) branch%least = find_least(self)
      branch%scanning%acts = .true.
      branch%scanning%moves = .false.
      branch%scanning%n = max(path%turns%depth, 1)
      if (path%turns%depth == 0) then
         branch%scanning%branches(1) = raw_branch(self, path%turns%dries, path%log_x, path%s_w)
         return
      end if
      dries = path%turns%dries .eqv. mod(path%turns%depth, 2) == 1
      branch%scanning%branches(1) = raw_branch(self, dries, path%turns%log_x(1), path%turns%s_w(1))
      do k = 2, path%turns%depth
         dries = .not. dries
         branch%scanning%branches(k) = raw_branch(self, dries, path%turns%log_x(k), path%turns%s_w(k))
         call close_loop(branch, path%turns%log_x(k - 1), path%turns%s_w(k - 1), branch%scanning%branches(k))
      end do
   end function branch_of

   !> The branch that begins at a point between the main curves and ends on the one that it approaches.
   pure function raw_branch(self, dries, log_x, s_w) result(branch)
      type(retention_t), intent(in) :: self
      logical, intent(in) :: dries
      real(wp), intent(in) :: log_x, s_w
      type(branch_t) :: branch
      type(main_curve_t) :: curve
      type(on_main_curve_t) :: at
      real(wp) :: q, growth

      branch = NO_BRANCH
      branch%dries = dries
      branch%log_x = log_x
      branch%s_w = s_w
      curve = main_curve(self, dries)
      at = on_main_curve(self, curve, log_x)
      if (abs(s_w - at%s_w) <= ON_CURVE*self%s_max) return
      q = power_of(self, dries)
      growth = q*(suction_on_curve(self, curve, s_w) - log_x)   ! offset**q = x**q (exp(growth) - 1)
      if (growth > epsilon(growth)) branch%log_offset = q*log_x + log_of_growth(growth)
   end function raw_branch

   !> ln(exp(growth) - 1) without cancellation.
   pure real(wp) function log_of_growth(growth)
      real(wp), intent(in) :: growth   !< > 0
      real(wp), parameter :: LARGE = 200.0_wp

      log_of_growth = growth
      if (growth < LARGE) log_of_growth = 0.5_wp*growth + log(2.0_wp*sinh(0.5_wp*growth))
   end function log_of_growth

   !> Scales a branch so that it passes the turning point where its loop closes.
   pure subroutine close_loop(self, log_x, s_w, branch)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: log_x, s_w
      type(branch_t), intent(inout) :: branch
      type(along_t) :: raw

      raw = along_raw_branch(self, branch, log_x)
      branch%straight = abs(raw%s_w - branch%s_w) <= 0.0_wp .or. &
                        abs(s_w - branch%s_w) > LARGEST_SCALE*abs(raw%s_w - branch%s_w)
      if (.not. branch%straight) then
         branch%share = (s_w - branch%s_w)/(raw%s_w - branch%s_w)
      else if (abs(log_x - branch%log_x) > 0.0_wp) then
         branch%share = (s_w - branch%s_w)/(log_x - branch%log_x)
      else
         branch%share = 0.0_wp
      end if
   end subroutine close_loop

   !> The branch of a point that has just turned, with its derivatives by ln x of the turn: S_w there goes with the
   !> branch before it. docs/theory/material.md section 2.1.1.
   pure function begin_at_turn(self, path, slope) result(branch)
      type(retention_t), intent(in) :: self
      type(path_t), intent(in) :: path    !< Path whose last turning point is the turn.
      real(wp), intent(in) :: slope       !< dS_w/d ln x of the branch before, there [-].
      type(retention_t) :: branch
      type(along_t) :: here, target
      real(wp) :: way, rise

      branch = branch_of(self, path)
      associate (scanning => branch%scanning, last => branch%scanning%branches(branch%scanning%n))
         scanning%moves = .true.
         scanning%s_w_rate = slope
         scanning%share_rate = 0.0_wp
         scanning%offset_rate = 0.0_wp
         if (last%straight) then
            scanning%moves = .false.      ! no water moves
         else if (last%log_offset > 0.5_wp*NO_OFFSET) then
            here = along_raw_branch(branch, last, last%log_x)
            ! S_w(y(x, c)) stays that of the turn: dS/d ln c is with_offset, dS/d ln x the slope
            if (abs(here%with_offset) > 0.0_wp) scanning%offset_rate = (slope - here%slope)/here%with_offset
         end if
         if (scanning%n > 1 .and. scanning%moves) then
            target = along_raw_branch(branch, last, path%turns%log_x(scanning%n - 1))
            way = path%turns%s_w(scanning%n - 1) - last%s_w
            rise = target%s_w - last%s_w
            scanning%share_rate = (-slope - last%share*(target%with_offset*scanning%offset_rate - slope))/rise
         end if
      end associate
   end function begin_at_turn

   !> Degree of saturation after the modified suction went one way from a state to a suction [kPa] and a void ratio [-],
   !> and the branch there. The one answer to every question for S_w. docs/theory/material.md section 2.1.1.
   pure subroutine saturation_after(self, p_c, e, path, sat, branch)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(path_t), intent(inout) :: path   !< Path of the state; on return that of the end.
      type(saturation_t), intent(inout) :: sat
      type(retention_t), intent(out) :: branch
      real(wp) :: log_x, s_w
      logical :: rests

      log_x = log_suction(self, p_c, e)
      s_w = path%s_w
      rests = abs(log_x - path%log_x) <= 0.0_wp
      call move_along(self, log_x, path)
      branch = branch_of(self, path)
      sat = saturation(branch, p_c, e)
      if (rests) sat%s_w = s_w
      path%log_x = log_x
      path%s_w = sat%s_w
   end subroutine saturation_after

   !> A state's S_w, set between the main curves, and its turning points if S_w is on their branch. Otherwise they are
   !> cleared. docs/theory/material.md section 2.1.1.
   pure subroutine keep_turns(self, path, cleared)
      type(retention_t), intent(in) :: self
      type(path_t), intent(inout) :: path
      logical, intent(out) :: cleared
      type(retention_t) :: branch
      type(along_t) :: along
      logical :: limited

      cleared = .false.
      if (path%log_x <= NO_SUCTION) then
         path = path_t(NO_SUCTION, self%s_max, NO_TURNS)
         return
      end if
      path%s_w = between(self, path%log_x, path%s_w)
      if (path%turns%depth == 0) return
      cleared = .not. are_nested(path)
      if (.not. cleared) then
         branch = branch_of(self, path)
         call follow_branches(branch, path%log_x, along, limited)
         cleared = abs(along%s_w - path%s_w) > PRESET_ROUNDING*self%s_max
      end if
      if (cleared) path = begin_path(self, path%log_x, path%s_w)
   end subroutine keep_turns

   !> Every turning point inside the loop of the two before it, and the present point likewise.
   pure logical function are_nested(path)
      type(path_t), intent(in) :: path
      real(wp) :: log_x(0:path%turns%depth + 1), way
      integer :: k, n

      n = path%turns%depth
      log_x(1:n) = path%turns%log_x(:n)
      log_x(n + 1) = path%log_x
      are_nested = .true.
      do k = 1, n
         way = merge(1.0_wp, -1.0_wp, path%turns%dries .eqv. mod(n - k, 2) == 0)
         are_nested = are_nested .and. way*(log_x(k + 1) - log_x(k)) >= 0.0_wp
         if (k > 1) are_nested = are_nested .and. way*(log_x(k - 1) - log_x(k + 1)) >= 0.0_wp
      end do
   end function are_nested

   !> S_w between the main curves at ln(x/P_a) [-].
   pure real(wp) function between(self, log_x, s_w)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: log_x, s_w
      type(on_main_curve_t) :: dry, wet

      dry = on_main_curve(self, main_curve(self, .true.), log_x)
      wet = on_main_curve(self, main_curve(self, .false.), log_x)
      between = max(min(s_w, dry%s_w), wet%s_w)
   end function between

   !> Degrees of saturation of the main wetting and the main drying curve [-].
   pure function main_curves(self, p_c, e) result(bounds)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      real(wp) :: bounds(2), log_x
      type(on_main_curve_t) :: dry, wet

      log_x = log_suction(self, p_c, e)
      dry = on_main_curve(self, main_curve(self, .true.), log_x)
      wet = on_main_curve(self, main_curve(self, .false.), log_x)
      bounds = [wet%s_w, dry%s_w]
   end function main_curves

   !> S_w of a point that begins at a preset one of STATEV, which must lie between the main curves; 0: on the main
   !> drying curve. At a suction [kPa] and a void ratio [-]. One that is not finite, or outside by more than 1e-6 S_max,
   !> is MUD_BAD_STATE; a good one leaves status as it is.
   pure subroutine preset_saturation(self, p_c, e, s_w, status)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      real(wp), intent(inout) :: s_w
      type(mud_status_t), intent(inout) :: status
      real(wp) :: bounds(2)

      bounds = main_curves(self, p_c, e)
      if (is_finite(s_w)) then
         if (abs(s_w) <= 0.0_wp) s_w = bounds(2)
      end if
      call check_saturation(self, p_c, e, s_w, status)
      if (is_finite(s_w)) s_w = max(min(s_w, bounds(2)), bounds(1))
   end subroutine preset_saturation

   !> Checks that S_w of a state lies between the main curves at its suction [kPa] and void ratio [-]. One that is not
   !> finite, or outside by more than 1e-6 S_max, is MUD_BAD_STATE; a good one leaves status as it is.
   pure subroutine check_saturation(self, p_c, e, s_w, status)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e, s_w
      type(mud_status_t), intent(inout) :: status
      real(wp) :: bounds(2), rounding

      bounds = main_curves(self, p_c, e)
      rounding = PRESET_ROUNDING*self%s_max
      if (is_finite(s_w)) then
         if (s_w >= bounds(1) - rounding .and. s_w <= bounds(2) + rounding) return
      end if
      status = fail(MUD_BAD_STATE, ON_STATEV, S_SATURATION, s_w, bounds(1), bounds(2))
   end subroutine check_saturation

   !> The main wetting curve nowhere above the main drying curve, beyond what bounds of single parameters say: the
   !> largest P_aw of which that is true at many suctions. A P_aw [kPa] above it is MUD_BAD_PROPS, with that limit;
   !> otherwise status stays as it is. docs/theory/material.md section 2.1.1.
   pure subroutine check_curves(self, status)
      type(retention_t), intent(in) :: self
      type(mud_status_t), intent(inout) :: status
      type(main_curve_t) :: wet
      type(on_main_curve_t) :: dry
      real(wp) :: log_x, limit
      integer :: i

      wet = main_curve(self, .false.)
      limit = log(self%p_a)
      do i = 0, POINTS
         log_x = WET_END/self%n_x + (DRY_END - WET_END/self%n_x)*real(i, wp)/POINTS
         dry = on_main_curve(self, main_curve(self, .true.), log_x)
         limit = min(limit, log(self%p_aw) + log_x - suction_on_curve(self, wet, dry%s_w))
      end do
      if (log(self%p_aw) > limit + AS_MUCH) &
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_P_AW, self%p_aw, 0.0_wp, exp(limit))
   end subroutine check_curves

   !> The interior minima of the offset whose branch passes a point of the opposite main curve: a branch of a larger
   !> offset slides along that curve and leaves it there. None where both curves have the same exponents.
   !> docs/theory/material.md section 2.1.1.
   pure function find_least(self) result(least)
      type(retention_t), intent(in) :: self
      type(least_t) :: least
      real(wp) :: from, to, low, high, step
      integer :: way, i

      least%known = .true.
      least%n = 0
      least%log_x = 0.0_wp
      least%log_offset = 0.0_wp
      if (abs(self%n_w - self%n_x) <= 0.0_wp .and. abs(self%m_w - self%m_x) <= 0.0_wp) return
      from = WET_END/self%n_w + min(self%log_wetting, 0.0_wp)
      step = (DRY_END - from)/POINTS
      do way = 1, 2
         low = rise_of_offset(self, way == 2, from)
         do i = 1, POINTS
            to = from + i*step
            high = rise_of_offset(self, way == 2, to)
            if (low < 0.0_wp .and. high >= 0.0_wp .and. least%n(way) < MAX_LEAST) call add_least(way, to - step, to)
            low = high
         end do
      end do
   contains
      pure subroutine add_least(way, before, behind)
         integer, intent(in) :: way
         real(wp), intent(in) :: before, behind
         type(on_main_curve_t) :: at
         type(branch_t) :: branch
         real(wp) :: a, b, middle
         integer :: k

         a = before
         b = behind
         do k = 1, HALVINGS
            middle = 0.5_wp*(a + b)
            if (rise_of_offset(self, way == 2, middle) < 0.0_wp) then
               a = middle
            else
               b = middle
            end if
         end do
         at = on_main_curve(self, main_curve(self, way == 1), b)
         branch = raw_branch(self, way == 2, b, at%s_w)
         least%n(way) = least%n(way) + 1
         least%log_x(way, least%n(way)) = b
         least%log_offset(way, least%n(way)) = branch%log_offset
      end subroutine add_least
   end function find_least

   !> Number with the sign of d ln offset/d ln x along the opposite main curve: q (d ln y/d ln x - (x/y)^q), with y of
   !> the main curve at the same S_w. 0 where no water moves.
   pure real(wp) function rise_of_offset(self, dries, log_x) result(rise)
      type(retention_t), intent(in) :: self
      logical, intent(in) :: dries
      real(wp), intent(in) :: log_x
      type(main_curve_t) :: curve
      type(on_main_curve_t) :: opposite, at
      real(wp) :: log_y, q

      rise = 0.0_wp
      curve = main_curve(self, dries)
      opposite = on_main_curve(self, main_curve(self, .not. dries), log_x)
      log_y = suction_on_curve(self, curve, opposite%s_w)
      at = on_main_curve(self, curve, log_y)
      if (abs(at%slope) <= 0.0_wp) return
      q = power_of(self, dries)
      rise = q*(opposite%slope/at%slope - exp(min(q*(log_x - log_y), 0.0_wp)))
   end function rise_of_offset
end module mud_scanning
