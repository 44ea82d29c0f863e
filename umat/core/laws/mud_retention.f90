! SPDX-License-Identifier: MIT
!> Water retention: how much of the pore space is water; docs/theory/material.md section 2.1. A retention is a curve, or
!> with hysteresis the branch that a phase of an increment follows (section 2.1.1); both are asked in one way.
!>
!> Hysteresis is here alone: the main curves and their branches, the turning points of a point, and its way along an
!> increment, where the modified suction x = p_c e^Omega turns and passes turning points. Void ratio and suction are
!> known beforehand at every pseudo-time, so all of that is: nothing depends on substeps.
module mud_retention
   use mud_kinds, only: wp
   use mud_registry, only: MAX_TURNS, P_P_AW, S_SATURATION
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_PROPS, MUD_BAD_STATE, ON_PROPS, ON_STATEV
   use mud_tensor, only: is_finite
   use mud_way, only: way_t, void_ratio_on, suction_on, SHORTEST_PHASE
   implicit none (type, external)
   private
   ! What the rest of the core asks, what it asks along an increment, and single branches.
   public :: retention_t, saturation_t, turns_t, NO_TURNS, saturation, curve_saturation, saturation_curvature, &
             change_with_turn, moves_with_turn, check_retention, prepare_retention, read_preset, check_preset, &
             check_saturation, begin_saturation, note_saturation, saturation_from
   public :: course_t, begin_course, list_kinks, take_branch, turn_around, end_course, slopes_of_suction, MAX_KINKS
   public :: path_t, begin_path, move_along, branch_of, begin_at_turn, saturation_after, keep_turns, log_suction, &
             NO_SUCTION, on_main_curve_t, on_main_curve, main_curve

   real(wp), parameter :: EULER = 2.7182818284590452_wp      !< exp(1)
   !> Logarithm beyond which exp(1) is lost in exp(1) + a, and a might overflow.
   real(wp), parameter :: LOG_LARGE = 200.0_wp
   real(wp), parameter :: LARGEST_LOG = 69.0_wp   !< ln of the largest ln(exp(1) + a) that is looked at [-].
   !> S_w this close to a main curve, as a share of S_max, is on it: rounding of S_w, which near S_max would be a large
   !> error of its suction [-].
   real(wp), parameter :: ON_CURVE = 8.0_wp*epsilon(1.0_wp)
   !> S_w of a branch this close to another one is beside it: what rounding of an offset makes of it where q is 1e-3, as
   !> a share of S_max [-].
   real(wp), parameter :: BESIDE = 1.0e-10_wp
   real(wp), parameter :: NO_SUCTION = -1.0e4_wp  !< ln(x/P_a) where there is none: below every number's.

   integer, parameter :: MAX_LEAST = 4   !< Largest number of least offsets of each direction; every set tried has none
                                         !< or one.
   real(wp), parameter :: PRESET_ROUNDING = 1.0e-6_wp   !< Rounding of a preset of six digits, as a share of S_max [-].
   !> Suctions at which the main curves are compared: from S_w = S_max but some 1e-8 to a million times P_a; ln(x/P_a)
   !> of both ends, the first with n. AS_MUCH: what rounding so close to S_max makes of ln P_aw [-].
   integer, parameter :: POINTS = 200
   real(wp), parameter :: WET_END = -18.0_wp, DRY_END = 14.0_wp, AS_MUCH = 1.0e-6_wp
   real(wp), parameter :: LARGEST_SCALE = 1.0e6_wp      !< Scale of a branch beyond which its loop is rounding [-].
   integer, parameter :: HALVINGS = 60   !< Number of halvings of an increment: more than a double can tell apart.
   integer, parameter :: HALVINGS_OF_LEAST = 50   !< Halvings of an interval in which there is a least offset.
   integer, parameter :: MAX_KINKS = 3*MAX_TURNS  !< Turning points to a turn and from it, and contacts.
   real(wp), parameter :: INSIDE = 1.0e-6_wp      !< A contact this close to an end of a way is that end [-].

   !> A scanning branch of S_w, docs/theory/material.md section 2.1.1: the suction y of a main curve at the same S_w
   !> follows y**q = x**q + offset**q. Suctions are ln(x/P_a).
   type :: branch_t
      logical :: dries
      real(wp) :: log_x, s_w   !< Where it begins [-].
      real(wp) :: log_offset   !< q ln(offset/P_a), NO_OFFSET: no offset [-].
      real(wp) :: share        !< Factor on its changes, so that it ends where its loop closes [-].
      logical :: straight      !< In ln x, of slope `share`: S_w hardly changes, and a scale would be rounding.
   end type branch_t

   !> Way of S_w along the last branch, which is limited by those that it left. docs/theory/material.md 2.1.1.
   type :: scanning_t
      logical :: acts
      integer :: n              !< Number of branches, at least 1; the last is the present one.
      type(branch_t) :: branches(MAX_TURNS)
      logical :: moves          !< The present branch begins at a turn inside the increment, and depends on that.
      real(wp) :: s_w_rate, offset_rate, share_rate   !< Derivatives with its ln x; not set otherwise [-].
   end type scanning_t

   !> Least offsets of branches that touch the opposite main curve from inside; first index 1 in wetting, 2 in drying.
   type :: least_t
      logical :: known
      integer :: n(2)
      real(wp) :: log_x(2, MAX_LEAST), log_offset(2, MAX_LEAST)
   end type least_t

   real(wp), parameter :: NO_OFFSET = -huge(1.0_wp)

   !> The parameters of the main curves, and the branch that is followed where that acts. Those of the wetting curve and
   !> of hysteresis are set with hysteresis; what the user leaves to others has their values.
   type :: retention_t
      logical :: hysteresis
      real(wp) :: s_max, s_min, p_a, omega, n_x, m_x
      real(wp) :: p_aw, n_w, m_w, b_d, b_w
      real(wp) :: log_wetting       !< ln(P_aw/P_a) [-].
      type(least_t) :: least
      type(scanning_t) :: scanning
   end type retention_t

   !> Degree of saturation and its slopes.
   type :: saturation_t
      real(wp) :: s_w      !< S_w [-]
      real(wp) :: ds_dpc   !< dS_w/dp_c at constant e [1/kPa]
      real(wp) :: ds_de    !< dS_w/de at constant p_c [-]
      real(wp) :: share    !< a/(exp(1) + a) of eq. (24), for the curvature; not of a branch [-]
      real(wp) :: log_sum  !< ln(exp(1) + a), likewise [-]
   end type saturation_t

   !> A curve of eq. (24).
   type :: main_curve_t
      real(wp) :: log_entry   !< ln(P/P_a), P its suction of eq. (24) [-]
      real(wp) :: n, m        !< Exponents of eq. (24) [-].
   end type main_curve_t

   !> A point of it.
   type :: on_main_curve_t
      real(wp) :: s_w, slope  !< S_w and dS_w/d ln x [-]
      real(wp) :: share, log_sum   !< Terms of eq. (24), as in saturation_t.
   end type on_main_curve_t

   !> Turns of the modified suction x = p_c e^Omega, and its present direction; without hysteresis without meaning.
   type :: turns_t
      logical :: dries             !< The present direction.
      integer :: depth             !< Number of turning points.
      real(wp) :: log_x(MAX_TURNS) !< ln(x/P_a) of each, the oldest first; beyond depth without meaning [-].
      real(wp) :: s_w(MAX_TURNS)   !< S_w of each, likewise [-].
   end type turns_t
   type(turns_t), parameter :: NO_TURNS = turns_t(.true., 0, 0.0_wp, 0.0_wp)

   !> Place of a point on its way between the main curves.
   type :: path_t
      real(wp) :: log_x, s_w   !< The present point [-].
      type(turns_t) :: turns
   end type path_t

   !> Way of S_w through an increment.
   type :: course_t
      real(wp) :: turn        !< Share of the increment after which x no longer rises, 1 if it does not turn [-].
      logical :: acts         !< False without hysteresis: the rest has no meaning then.
      real(wp) :: log_turn, log_end   !< ln(x/P_a) there and at the end [-].
      type(retention_t) :: material   !< Without a branch.
      type(path_t) :: path    !< Where x began to go the way that it goes: at the start, or at the turn.
      logical :: turned
      real(wp) :: slope       !< dS_w/d ln x where it turned, of the branch before [-].
      real(wp) :: with_increment(2)   !< d ln x there with suction step and volume [1/kPa, -].
   end type course_t

   !> A point of a branch: S_w with its first two derivatives by ln x, and those of S_w and slope by q ln offset [-].
   type :: along_t
      real(wp) :: s_w, slope, bend, with_offset, slope_with_offset
      integer :: curve   !< Number of the curve that is followed; it changes where S_w has a kink.
   end type along_t
   !> Numbers of the curve, and their period.
   integer, parameter :: FREE = 0, BESIDE_MAIN = 1, SLID = 2, NEXT_BRANCH = 3
contains
   !> Degree of saturation at a suction [kPa] and a void ratio [-], paper eqs (23), (24). No suction: S_max, zero
   !> slopes. On a scanning branch that of docs/theory/material.md section 2.1.1. e > 0 is not checked.
   pure function saturation(self, p_c, e) result(sat)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat
      type(along_t) :: along

      if (self%scanning%acts .and. p_c > 0.0_wp) then
         along = along_branches(self, log_suction(self, p_c, e))
         sat = saturation_t(along%s_w, along%slope/p_c, along%slope*self%omega/e, 0.0_wp, 1.0_wp)
      else
         sat = curve_saturation(self, p_c, e)
      end if
   end function saturation

   !> Saturation without hysteresis.
   pure function curve_saturation(self, p_c, e) result(sat)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat
      type(on_main_curve_t) :: at

      sat = saturation_t(self%s_max, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp)
      if (p_c <= 0.0_wp) return
      at = on_main_curve(self, main_curve_t(0.0_wp, self%n_x, self%m_x), log_suction(self, p_c, e))
      sat%s_w = at%s_w
      sat%ds_dpc = at%slope/p_c
      sat%ds_de = at%slope*self%omega/e
      sat%share = at%share
      sat%log_sum = at%log_sum
   end function curve_saturation

   !> Finds beforehand what every increment would look for: the least offsets of the branches.
   pure subroutine prepare_retention(self)
      type(retention_t), intent(inout) :: self

      if (self%hysteresis) self%least = find_least(self)
   end subroutine prepare_retention

   !> Degree of saturation that STATEV sets for a start; 0, which says none, without hysteresis [-].
   pure real(wp) function read_preset(self, s_w)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: s_w

      read_preset = merge(s_w, 0.0_wp, self%hysteresis)
   end function read_preset

   !> Refuses a degree of saturation of the start without hysteresis: S_w is a function of suction and void ratio there,
   !> and another one would be lost in silence. MUD_BAD_STATE; a good one leaves status as it is.
   pure subroutine check_preset(self, preset, status)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: preset
      type(mud_status_t), intent(inout) :: status
      logical :: given

      if (self%hysteresis .or. status%code /= MUD_OK) return
      given = .not. is_finite(preset)
      if (.not. given) given = abs(preset) > 0.0_wp
      if (given) status = fail(MUD_BAD_STATE, ON_STATEV, S_SATURATION, preset, 0.0_wp, 0.0_wp)
   end subroutine check_preset

   !> S_w of a point that begins, its turning points and its branch, at a suction [kPa] and a void ratio [-]. What was
   !> preset is kept between the main curves; 0: on the main drying curve. Codes of check_saturation. Without hysteresis
   !> nothing is set: S_w follows from suction and void ratio.
   pure subroutine begin_saturation(self, p_c, e, s_w, turns, branch, status)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      real(wp), intent(inout) :: s_w
      type(turns_t), intent(inout) :: turns
      type(retention_t), intent(inout) :: branch
      type(mud_status_t), intent(inout) :: status
      type(path_t) :: path
      real(wp) :: bounds(2)

      if (.not. self%hysteresis) return
      bounds = main_curves(self, log_suction(self, p_c, e))
      if (is_finite(s_w)) then
         if (abs(s_w) <= 0.0_wp) s_w = bounds(2)
      end if
      call check_saturation(self, p_c, e, s_w, status)
      if (status%code /= MUD_OK) return
      s_w = max(min(s_w, bounds(2)), bounds(1))
      path = begin_path(self, log_suction(self, p_c, e), s_w)
      turns = path%turns
      branch = branch_of(self, path)
   end subroutine begin_saturation

   !> S_w of a state where it is a function of suction and void ratio; with hysteresis it is the state's own.
   pure subroutine note_saturation(self, sat, s_w)
      type(retention_t), intent(in) :: self
      type(saturation_t), intent(in) :: sat
      real(wp), intent(inout) :: s_w

      if (.not. self%hysteresis) s_w = sat%s_w
   end subroutine note_saturation

   !> Degree of saturation after a change of suction from p_c0 to p_c [kPa] at a void ratio [-], as the next update has
   !> it; with hysteresis from S_w and turning points of a state. MUD_BAD_STATE as of check_saturation.
   pure subroutine saturation_from(self, p_c0, e, s_w, turns, p_c, sat, status)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c0, e, s_w, p_c
      type(turns_t), intent(in) :: turns
      type(saturation_t), intent(inout) :: sat   !< Untouched where it is refused.
      type(mud_status_t), intent(inout) :: status
      type(path_t) :: path
      type(retention_t) :: branch
      logical :: cleared

      call check_saturation(self, p_c0, e, s_w, status)
      if (status%code /= MUD_OK) return
      if (.not. self%hysteresis) then
         sat = saturation(self, p_c, e)
         return
      end if
      path = path_t(log_suction(self, p_c0, e), s_w, turns)
      call keep_turns(self, path, cleared)
      call saturation_after(self, p_c, e, path, sat, branch)
   end subroutine saturation_from

   !> True of a branch that begins at a turn inside the increment: S_w depends on the place of that, see
   !> change_with_turn.
   pure logical function moves_with_turn(self)
      type(retention_t), intent(in) :: self

      moves_with_turn = self%scanning%moves
   end function moves_with_turn

   !> The main drying or the main wetting curve. docs/theory/material.md section 2.1.1.
   pure function main_curve(self, dries) result(curve)
      type(retention_t), intent(in) :: self   !< with hysteresis
      logical, intent(in) :: dries
      type(main_curve_t) :: curve

      if (dries) then
         curve = main_curve_t(0.0_wp, self%n_x, self%m_x)
      else
         curve = main_curve_t(self%log_wetting, self%n_w, self%m_w)
      end if
   end function main_curve

   !> Paper eq. (24) at ln(x/P_a) [-]: S_w, its slope, and what its second derivative takes.
   pure function on_main_curve(self, curve, log_x) result(at)
      type(retention_t), intent(in) :: self
      type(main_curve_t), intent(in) :: curve
      real(wp), intent(in) :: log_x
      type(on_main_curve_t) :: at
      real(wp) :: log_a, a, s_e

      at = on_main_curve_t(self%s_max, 0.0_wp, 0.0_wp, 1.0_wp)
      log_a = curve%n*(log_x - curve%log_entry)                 ! a = (x/P)^n
      if (log_a < -LOG_LARGE) return
      if (log_a > LOG_LARGE) then
         at%log_sum = log_a
         at%share = 1.0_wp                                      ! a/(exp(1) + a)
      else
         a = exp(log_a)
         at%log_sum = log(EULER + a)
         at%share = a/(EULER + a)
      end if
      s_e = (self%s_max - self%s_min)*at%log_sum**(-curve%m)
      at%s_w = self%s_min + s_e
      at%slope = -curve%m*s_e/at%log_sum*at%share*curve%n       ! dS_w/d ln x
   end function on_main_curve

   !> d2S_w/d(ln x)2 at a point of a main curve [-].
   pure real(wp) function bend_of(curve, at) result(bend)
      type(main_curve_t), intent(in) :: curve
      type(on_main_curve_t), intent(in) :: at

      bend = at%slope*curve%n*(1.0_wp - at%share*(1.0_wp + (curve%m + 1.0_wp)/at%log_sum))
   end function bend_of

   !> ln(x/P_a) of a main curve at a degree of saturation: eq. (24) the other way round [-].
   pure real(wp) function suction_on_curve(self, curve, s_w) result(log_y)
      type(retention_t), intent(in) :: self
      type(main_curve_t), intent(in) :: curve
      real(wp), intent(in) :: s_w
      real(wp) :: s_e, log_sum, a

      log_y = curve%log_entry - LOG_LARGE/curve%n
      s_e = (s_w - self%s_min)/(self%s_max - self%s_min)
      if (s_e >= 1.0_wp) return
      log_sum = exp(LARGEST_LOG)
      if (s_e > 0.0_wp) log_sum = exp(min(-log(s_e)/curve%m, LARGEST_LOG))   ! ln(exp(1) + a)
      if (log_sum > LOG_LARGE) then
         log_y = curve%log_entry + log_sum/curve%n
      else
         a = exp(log_sum) - EULER
         if (a > exp(-LOG_LARGE)) log_y = curve%log_entry + log(a)/curve%n
      end if
   end function suction_on_curve

   !> ln(p*/P_a), paper eq. (23). It is ln(p_c/P_a) + Omega ln e [-]; e > 0 is not checked. NO_SUCTION without suction.
   pure real(wp) function log_suction(self, p_c, e)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e   !< [kPa, -]

      log_suction = NO_SUCTION
      if (p_c <= 0.0_wp) return
      log_suction = log(p_c/self%p_a) + self%omega*log(e)
   end function log_suction

   !> q of y**q = x**q + offset**q. docs/theory/material.md section 2.1.1.
   pure real(wp) function power_of(self, dries) result(q)
      type(retention_t), intent(in) :: self
      logical, intent(in) :: dries

      q = merge(1.0_wp + self%b_d, 1.0_wp - self%b_w, dries)
   end function power_of

   !> A point of a branch that nothing limits but the main curves, at ln(x/P_a) [-]: the solution of its differential
   !> equation, which slides along the opposite main curve where that is flatter. docs/theory/material.md section 2.1.1.
   pure function along_raw_branch(self, branch, log_x) result(along)
      type(retention_t), intent(in) :: self
      type(branch_t), intent(in) :: branch
      real(wp), intent(in) :: log_x
      type(along_t) :: along
      type(main_curve_t) :: curve, opposite
      type(on_main_curve_t) :: at
      real(wp) :: log_offset, q, t, log_weight, weight, rest, bend
      integer :: i, way

      way = merge(2, 1, branch%dries)
      log_offset = branch%log_offset
      along%curve = FREE
      do i = 1, self%least%n(way)
         if ((self%least%log_x(way, i) - branch%log_x)*(self%least%log_x(way, i) - log_x) >= 0.0_wp) cycle
         if (self%least%log_offset(way, i) >= log_offset) cycle
         log_offset = self%least%log_offset(way, i)
         along%curve = SLID
      end do
      q = power_of(self, branch%dries)
      log_weight = 0.0_wp
      rest = 0.0_wp
      if (log_offset > 0.5_wp*NO_OFFSET) then
         t = log_offset - q*log_x
         if (t > LOG_LARGE) then
            log_weight = -t
            rest = 1.0_wp
         else
            log_weight = -log(1.0_wp + exp(t))
            rest = exp(t + log_weight)         ! 1 - weight without cancellation
         end if
      end if
      weight = exp(log_weight)                 ! d ln y/d ln x = (x/y)**q
      curve = main_curve(self, branch%dries)
      at = on_main_curve(self, curve, log_x - log_weight/q)
      bend = bend_of(curve, at)
      along%s_w = at%s_w
      along%slope = at%slope*weight
      along%bend = bend*weight**2 + at%slope*q*weight*rest
      along%with_offset = 0.0_wp
      along%slope_with_offset = 0.0_wp
      if (along%curve == FREE) then
         along%with_offset = at%slope*rest/q
         along%slope_with_offset = weight*rest*(bend/q - at%slope)
      end if
      opposite = main_curve(self, .not. branch%dries)
      at = on_main_curve(self, opposite, log_x)
      call limit(self, branch%dries, .true., along_t(at%s_w, at%slope, bend_of(opposite, at), 0.0_wp, 0.0_wp, &
                                                    BESIDE_MAIN), along)
   end function along_raw_branch

   !> A branch does not cross another one: drying stays above it, wetting below. Where it leaves it both are equal but
   !> for rounding; it is followed there with its own slope, unless that is steeper.
   pure subroutine limit(self, dries, begins, other, along)
      type(retention_t), intent(in) :: self
      logical, intent(in) :: dries
      logical, intent(in) :: begins   !< Where both are equal it leaves the other one; not where it arrives there.
      type(along_t), intent(in) :: other
      type(along_t), intent(inout) :: along
      real(wp) :: beyond, rounding, s_w
      logical :: acts

      beyond = merge(other%s_w - along%s_w, along%s_w - other%s_w, dries)
      rounding = ON_CURVE*self%s_max*(1.0_wp + 1.0_wp/abs(power_of(self, .false.)))
      acts = beyond > BESIDE*self%s_max .or. &
             (begins .and. beyond > -rounding .and. abs(along%slope) > abs(other%slope))
      s_w = along%s_w
      if (beyond > 0.0_wp) s_w = other%s_w
      if (acts) along = other
      along%s_w = s_w
   end subroutine limit

   !> A point of the present branch at ln(x/P_a) [-]: every branch is scaled so that it closes its loop, and limited by
   !> the one that it left, so that closed loops dissipate. docs/theory/material.md section 2.1.1.
   pure function along_branches(self, log_x) result(along)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: log_x
      type(along_t) :: along, left
      integer :: k

      along = along_raw_branch(self, self%scanning%branches(1), log_x)
      do k = 2, self%scanning%n
         left = along
         associate (branch => self%scanning%branches(k))
            if (branch%straight) then
               along = along_t(branch%s_w + branch%share*(log_x - branch%log_x), branch%share, 0.0_wp, 0.0_wp, &
                               0.0_wp, FREE)
            else
               along = along_raw_branch(self, branch, log_x)
               along%s_w = branch%s_w + branch%share*(along%s_w - branch%s_w)
               along%slope = branch%share*along%slope
               along%bend = branch%share*along%bend
            end if
            along%curve = along%curve + NEXT_BRANCH*(k - 1)
            call limit(self, branch%dries, &
                       abs(log_x - branch%log_x) < abs(log_x - self%scanning%branches(k - 1)%log_x), left, along)
         end associate
      end do
   end function along_branches

   !> Number of the curve that is followed at ln(x/P_a) [-]: another one where S_w has had a kink on the way.
   pure integer function curve_at(self, log_x)
      type(retention_t), intent(in) :: self   !< with a branch
      real(wp), intent(in) :: log_x
      type(along_t) :: along

      along = along_branches(self, log_x)
      curve_at = along%curve
   end function curve_at

   !> Second derivatives [d2S/dp_c2 (1/kPa2), d2S/dp_c de (1/kPa), d2S/de2 (-)] at the suction and void ratio of sat.
   !> sat is that of p_c [kPa] and e [-]; zeros without suction. Derivatives of paper eqs (23), (24) and of
   !> docs/theory/material.md section 2.1.1.
   pure function saturation_curvature(self, sat, p_c, e) result(curvature)
      type(retention_t), intent(in) :: self
      type(saturation_t), intent(in) :: sat
      real(wp), intent(in) :: p_c, e
      type(along_t) :: along
      real(wp) :: curvature(3), slope, bend

      curvature = 0.0_wp
      if (p_c <= 0.0_wp) return
      slope = sat%ds_dpc*p_c                                    ! dS_w/d ln p*
      if (self%scanning%acts) then
         along = along_branches(self, log_suction(self, p_c, e))
         bend = along%bend
      else
         bend = bend_of(main_curve_t(0.0_wp, self%n_x, self%m_x), &
                        on_main_curve_t(sat%s_w, slope, sat%share, sat%log_sum))
      end if
      ! one division after the other: the square of a tiny suction would be 0
      curvature = [(bend - slope)/p_c/p_c, bend*self%omega/p_c/e, (bend*self%omega - slope)*self%omega/e**2]
   end function saturation_curvature

   !> Derivatives [dS_w (-), d2S_w/dp_c (1/kPa), d2S_w/de (-)] with respect to ln x of the turn where the present branch
   !> begins, at a suction [kPa] and a void ratio [-]. Zeros where it does not move. docs/theory/material.md section
   !> 2.1.1.
   pure function change_with_turn(self, p_c, e) result(change)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(along_t) :: along
      real(wp) :: change(3), log_x

      change = 0.0_wp
      if (.not. self%scanning%moves .or. p_c <= 0.0_wp) return
      log_x = log_suction(self, p_c, e)
      along = along_branches(self, log_x)
      if (along%curve < NEXT_BRANCH*(self%scanning%n - 1)) return   ! it is limited by another one
      associate (scanning => self%scanning, branch => self%scanning%branches(self%scanning%n))
         along = along_raw_branch(self, branch, log_x)
         change(1) = (1.0_wp - branch%share)*scanning%s_w_rate + scanning%share_rate*(along%s_w - branch%s_w) &
                     + branch%share*scanning%offset_rate*along%with_offset
         change(2) = scanning%share_rate*along%slope + branch%share*scanning%offset_rate*along%slope_with_offset
      end associate
      change(3) = change(2)*self%omega/e
      change(2) = change(2)/p_c
   end function change_with_turn

   !> A point without a past at ln(x/P_a) and S_w [-]: it dries, and wets where it is on the main wetting curve.
   !> docs/theory/material.md section 2.1.1.
   pure function begin_path(self, log_x, s_w) result(path)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: log_x, s_w
      type(path_t) :: path
      real(wp) :: bounds(2)

      path = path_t(log_x, s_w, NO_TURNS)
      bounds = main_curves(self, log_x)
      path%turns%dries = abs(s_w - bounds(1)) > ON_CURVE*self%s_max .or. abs(s_w - bounds(2)) <= ON_CURVE*self%s_max
   end function begin_path

   !> The turning points with which a point moves to a suction: a reversal adds the present one, and what is passed on
   !> the way is forgotten with the loop that it closes. The present point is then where the branch that remains was
   !> joined. Nothing happens where it does not move. docs/theory/material.md section 2.1.1.
   pure subroutine move_along(self, to, path, passed, n)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: to   !< ln(x/P_a), NO_SUCTION where there is none [-].
      type(path_t), intent(inout) :: path
      !> ln(x/P_a) of the n turning points that are passed, in their order; beyond without meaning [-].
      real(wp), intent(out), optional :: passed(MAX_TURNS/2)
      integer, intent(out), optional :: n
      integer :: closed
      logical :: dries, moves

      closed = 0
      if (present(passed)) passed = 0.0_wp
      moves = abs(to - path%log_x) > 0.0_wp
      dries = to > path%log_x
      associate (turns => path%turns)
         if (moves .and. (dries .neqv. turns%dries)) then
            if (turns%depth == MAX_TURNS) turns%depth = turns%depth - 2   ! the smallest loop
            turns%depth = turns%depth + 1
            turns%log_x(turns%depth) = path%log_x
            turns%s_w(turns%depth) = path%s_w
            turns%dries = dries
         end if
         do while (moves .and. turns%depth >= 2)
            if (merge(to < turns%log_x(turns%depth - 1), to > turns%log_x(turns%depth - 1), dries)) exit
            turns%depth = turns%depth - 2
            path%log_x = turns%log_x(turns%depth + 1)
            path%s_w = turns%s_w(turns%depth + 1)
            closed = closed + 1
            if (present(passed)) passed(closed) = path%log_x
         end do
      end associate
      if (present(n)) n = closed
      if (to <= NO_SUCTION) path = path_t(NO_SUCTION, self%s_max, NO_TURNS)
   end subroutine move_along

   !> The retention along the branch of a point. Closed form of docs/theory/material.md section
   !> 2.1.1; nothing is refused.
   pure function branch_of(self, path) result(branch)
      type(retention_t), intent(in) :: self
      type(path_t), intent(in) :: path
      type(retention_t) :: branch
      type(branch_t) :: begun
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
         begun = raw_branch(self, dries, path%turns%log_x(k), path%turns%s_w(k))
         call close_loop(branch, path%turns%log_x(k - 1), path%turns%s_w(k - 1), begun)
         branch%scanning%branches(k) = begun
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

      branch = branch_t(dries, log_x, s_w, NO_OFFSET, 1.0_wp, .false.)
      curve = main_curve(self, dries)
      at = on_main_curve(self, curve, log_x)
      if (abs(s_w - at%s_w) <= ON_CURVE*self%s_max) return
      q = power_of(self, dries)
      growth = q*(suction_on_curve(self, curve, s_w) - log_x)   ! offset**q = x**q (exp(growth) - 1)
      if (growth <= epsilon(growth)) return
      if (growth < LOG_LARGE) growth = 0.5_wp*growth + log(2.0_wp*sinh(0.5_wp*growth))   ! without cancellation
      branch%log_offset = q*log_x + growth
   end function raw_branch

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
      real(wp) :: bounds(2)

      cleared = .false.
      if (path%log_x <= NO_SUCTION) then
         path = path_t(NO_SUCTION, self%s_max, NO_TURNS)
         return
      end if
      bounds = main_curves(self, path%log_x)
      path%s_w = max(min(path%s_w, bounds(2)), bounds(1))
      if (path%turns%depth == 0) return
      cleared = .not. are_nested(path)
      if (.not. cleared) then
         branch = branch_of(self, path)
         along = along_branches(branch, path%log_x)
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

   !> Degrees of saturation of the main wetting and the main drying curve at ln(x/P_a) [-].
   pure function main_curves(self, log_x) result(bounds)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: log_x
      real(wp) :: bounds(2)
      type(on_main_curve_t) :: dry, wet

      dry = on_main_curve(self, main_curve(self, .true.), log_x)
      wet = on_main_curve(self, main_curve(self, .false.), log_x)
      bounds = [wet%s_w, dry%s_w]
   end function main_curves

   !> Checks that S_w of a state with hysteresis lies between the main curves at its suction [kPa] and void ratio [-].
   !> One that is not finite, or outside by more than 1e-6 S_max, is MUD_BAD_STATE; a good one leaves status as it is.
   pure subroutine check_saturation(self, p_c, e, s_w, status)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e, s_w
      type(mud_status_t), intent(inout) :: status
      real(wp) :: bounds(2), rounding

      if (.not. self%hysteresis .or. status%code /= MUD_OK) return
      bounds = main_curves(self, log_suction(self, p_c, e))
      rounding = PRESET_ROUNDING*self%s_max
      if (is_finite(s_w)) then
         if (s_w >= bounds(1) - rounding .and. s_w <= bounds(2) + rounding) return
      end if
      status = fail(MUD_BAD_STATE, ON_STATEV, S_SATURATION, s_w, bounds(1), bounds(2))
   end subroutine check_saturation

   !> With hysteresis the main wetting curve is to be nowhere above the main drying curve, beyond what bounds of single
   !> parameters say: the largest P_aw of which that is true at many suctions. A P_aw [kPa] above it is MUD_BAD_PROPS,
   !> with that limit; otherwise status stays as it is. docs/theory/material.md section 2.1.1.
   pure subroutine check_retention(self, status)
      type(retention_t), intent(in) :: self
      type(mud_status_t), intent(inout) :: status
      type(main_curve_t) :: wet
      type(on_main_curve_t) :: dry
      real(wp) :: log_x, limit
      integer :: i

      if (status%code /= MUD_OK) return   ! a refused set has no retention
      if (.not. self%hysteresis) return
      wet = main_curve(self, .false.)
      limit = log(self%p_a)
      do i = 0, POINTS
         log_x = WET_END/self%n_x + (DRY_END - WET_END/self%n_x)*real(i, wp)/POINTS
         dry = on_main_curve(self, main_curve(self, .true.), log_x)
         limit = min(limit, log(self%p_aw) + log_x - suction_on_curve(self, wet, dry%s_w))
      end do
      if (log(self%p_aw) > limit + AS_MUCH) &
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_P_AW, self%p_aw, 0.0_wp, exp(limit))
   end subroutine check_retention

   !> The interior minima of the offset whose branch passes a point of the opposite main curve: a branch of a larger
   !> offset slides along that curve and leaves it there. None where both curves have the same exponents.
   !> docs/theory/material.md section 2.1.1.
   pure function find_least(self) result(least)
      type(retention_t), intent(in) :: self
      type(least_t) :: least
      real(wp) :: from, to, low, high, step
      integer :: way, i

      least = least_t(.true., 0, 0.0_wp, 0.0_wp)
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
         do k = 1, HALVINGS_OF_LEAST
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

   !> The turn of an increment, and the way of x to it. A state that is not on its branch loses its turning points,
   !> which is counted. docs/theory/material.md section 2.1.1.
   pure subroutine begin_course(self, way, s_w, turns, branch, cleared, course)
      type(retention_t), intent(in) :: self
      type(way_t), intent(in) :: way
      real(wp), intent(in) :: s_w
      type(turns_t), intent(in) :: turns
      type(retention_t), intent(inout) :: branch   !< It gets the branch at the start.
      integer, intent(inout) :: cleared
      type(course_t), intent(out) :: course
      logical :: lost

      course%acts = self%hysteresis
      course%turn = 1.0_wp
      if (.not. course%acts) return
      course%material = self
      if (.not. course%material%least%known) course%material%least = find_least(course%material)
      course%path = path_t(log_at(course%material, way, 0.0_wp), s_w, turns)
      call keep_turns(course%material, course%path, lost)
      if (lost) cleared = cleared + 1
      course%turned = .false.
      course%slope = 0.0_wp
      course%with_increment = 0.0_wp
      course%turn = turn_of_suction(course%material%omega, way)
      if (course%turn < SHORTEST_PHASE .or. course%turn > 1.0_wp - SHORTEST_PHASE) course%turn = 1.0_wp
      course%log_turn = log_at(course%material, way, course%turn)
      course%log_end = log_at(course%material, way, 1.0_wp)
      branch = branch_of(course%material, course%path)
   end subroutine begin_course

   !> ln(x/P_a) at a pseudo-time [-].
   pure real(wp) function log_at(material, way, time)
      type(retention_t), intent(in) :: material
      type(way_t), intent(in) :: way
      real(wp), intent(in) :: time

      log_at = log_suction(material, suction_on(way, time), void_ratio_on(way, time))
   end function log_at

   !> e^-Omega dx/dt [kPa], t the share of the increment.
   pure real(wp) function rise(omega, way, time)
      real(wp), intent(in) :: omega, time
      type(way_t), intent(in) :: way
      real(wp) :: e

      e = void_ratio_on(way, time)
      rise = way%d_pc - max(suction_on(way, time), 0.0_wp)*omega*way%d_v*(1.0_wp + e)/e
   end function rise

   !> Time at which x turns: suction is linear, and where x is stationary it has a maximum (its second derivative is
   !> negative there), so there is one turn at most, from drying to wetting.
   pure real(wp) function turn_of_suction(omega, way) result(turn)
      real(wp), intent(in) :: omega
      type(way_t), intent(in) :: way
      real(wp) :: before, middle
      integer :: i

      turn = 1.0_wp
      if (.not. (rise(omega, way, 0.0_wp) > 0.0_wp .and. rise(omega, way, 1.0_wp) < 0.0_wp)) return
      before = 0.0_wp
      do i = 1, HALVINGS
         middle = 0.5_wp*(before + turn)
         if (rise(omega, way, middle) > 0.0_wp) then
            before = middle
         else
            turn = middle
         end if
      end do
   end function turn_of_suction

   !> Pseudo-times at which S_w has a kink, n of them: x passes a turning point, or the branch meets a main curve or the
   !> branch that it left. All of them depend on x alone, so they are known beforehand, behind a turn too.
   !> docs/theory/material.md section 2.1.1.
   pure subroutine list_kinks(way, course, times, n)
      type(way_t), intent(in) :: way
      type(course_t), intent(in) :: course
      real(wp), intent(out) :: times(MAX_KINKS)   !< Times of the kinks; entries beyond n have no meaning [-].
      integer, intent(out) :: n
      type(retention_t) :: branch
      type(path_t) :: path
      type(saturation_t) :: sat

      n = 0
      if (.not. course%acts) return
      times = 0.0_wp
      path = course%path
      call list_on_way(way, course%material, path, 0.0_wp, course%turn, course%log_turn, times, n)
      if (course%turn >= 1.0_wp) return
      call saturation_after(course%material, suction_on(way, course%turn), void_ratio_on(way, course%turn), path, sat, &
                            branch)
      call list_on_way(way, course%material, path, course%turn, 1.0_wp, course%log_end, times, n)
   end subroutine list_kinks

   !> Lists the kinks on a way of x in one direction.
   pure subroutine list_on_way(way, material, start, from, to, log_to, times, n)
      type(way_t), intent(in) :: way
      type(retention_t), intent(in) :: material
      type(path_t), intent(in) :: start
      real(wp), intent(in) :: from, to, log_to   !< Pseudo-times of the way; ln x at its end [-].
      real(wp), intent(inout) :: times(MAX_KINKS)
      integer, intent(inout) :: n
      type(path_t) :: path
      real(wp) :: passed(MAX_TURNS/2), before, behind
      integer :: i, k

      path = start
      call move_along(material, log_to, path, passed, k)
      before = from
      do i = 1, k + 1
         behind = to
         if (i <= k) behind = time_of_passing(material, way, from, to, passed(i))
         call list_contacts(way, material, start, before, behind, times, n)
         if (i <= k) call add_time(behind, times, n)
         before = behind
      end do
   end subroutine list_on_way

   !> Lists the kinks between two turning points that are passed: places where another curve is followed.
   pure subroutine list_contacts(way, material, start, from, to, times, n)
      type(way_t), intent(in) :: way
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
      call move_along(material, log_at(material, way, 0.5_wp*(from + to)), path)
      branch = branch_of(material, path)
      before = from + INSIDE*(to - from)
      last = to - INSIDE*(to - from)
      if (min(suction_on(way, before), suction_on(way, last)) <= 0.0_wp) return
      curve = curve_at(branch, log_at(material, way, before))
      at_last = curve_at(branch, log_at(material, way, last))
      do k = 1, MAX_TURNS
         if (curve == at_last) return
         behind = last
         do i = 1, HALVINGS
            middle = 0.5_wp*(before + behind)
            if (curve_at(branch, log_at(material, way, middle)) == curve) then
               before = middle
            else
               behind = middle
            end if
         end do
         call add_time(behind, times, n)
         before = behind
         curve = curve_at(branch, log_at(material, way, before))
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
   pure real(wp) function time_of_passing(material, way, from, to, log_x) result(time)
      type(retention_t), intent(in) :: material
      type(way_t), intent(in) :: way
      real(wp), intent(in) :: from, to, log_x
      real(wp) :: before, middle
      logical :: dries
      integer :: i

      dries = log_at(material, way, to) > log_at(material, way, from)
      before = from
      time = to
      do i = 1, HALVINGS
         middle = 0.5_wp*(before + time)
         if (dries .eqv. log_at(material, way, middle) < log_x) then
            before = middle
         else
            time = middle
         end if
      end do
   end function time_of_passing

   !> The branch of the phase of an increment between two pseudo-times; its middle tells what x has passed.
   pure subroutine take_branch(course, way, from, to, branch)
      type(course_t), intent(in) :: course
      type(way_t), intent(in) :: way
      real(wp), intent(in) :: from, to
      type(retention_t), intent(inout) :: branch
      type(path_t) :: path

      if (.not. course%acts) return
      path = course%path
      call move_along(course%material, log_at(course%material, way, 0.5_wp*(from + to)), path)
      if (begins_at_turn(course, path)) then
         branch = begin_at_turn(course%material, path, course%slope)
      else
         branch = branch_of(course%material, path)
      end if
   end subroutine take_branch

   !> True if the present branch begins where the increment turned.
   pure logical function begins_at_turn(course, path)
      type(course_t), intent(in) :: course
      type(path_t), intent(in) :: path

      begins_at_turn = course%turned .and. path%turns%depth > 0
      if (begins_at_turn) begins_at_turn = abs(path%turns%log_x(path%turns%depth) - course%log_turn) <= 0.0_wp
   end function begins_at_turn

   !> Adds the turn of x to the path: the turning point goes with suction step and volume of the increment. x is
   !> stationary there: its place does not matter. docs/theory/material.md section 2.1.1.
   pure subroutine turn_around(way, course)
      type(way_t), intent(in) :: way
      type(course_t), intent(inout) :: course
      type(saturation_t) :: sat
      type(retention_t) :: branch
      real(wp) :: p_c

      p_c = suction_on(way, course%turn)
      call saturation_after(course%material, p_c, void_ratio_on(way, course%turn), course%path, sat, branch)
      course%slope = sat%ds_dpc*p_c
      course%turned = .true.
      course%with_increment = course%turn*slopes_of_suction(way, course%turn, course%material%omega)
   end subroutine turn_around

   !> Derivatives of ln x, x the modified suction p_c e^Omega, by suction [1/kPa] and volume [-]. Suction is positive
   !> there, which is not checked. docs/theory/material.md section 2.1.1.
   pure function slopes_of_suction(way, time, omega) result(slopes)
      type(way_t), intent(in) :: way
      real(wp), intent(in) :: time, omega
      real(wp) :: slopes(2), e

      e = void_ratio_on(way, time)
      slopes = [1.0_wp/suction_on(way, time), -omega*(1.0_wp + e)/e]
   end function slopes_of_suction

   !> S_w and turning points at the end, the branch there, and what the turn adds to the slopes of S_w.
   !> docs/theory/material.md section 2.1.1.
   pure subroutine end_course(way, course, s_w, turns, branch, with_turn)
      type(way_t), intent(in) :: way
      type(course_t), intent(in) :: course
      real(wp), intent(inout) :: s_w
      type(turns_t), intent(inout) :: turns
      type(retention_t), intent(inout) :: branch   !< It gets the branch at the end.
      real(wp), intent(out) :: with_turn(2)   !< By suction step and volume [1/kPa, -].
      type(saturation_t) :: sat
      type(path_t) :: path
      real(wp) :: p_c, e, change(3)

      with_turn = 0.0_wp
      if (.not. course%acts) return
      p_c = suction_on(way, 1.0_wp)
      e = void_ratio_on(way, 1.0_wp)
      path = course%path
      call saturation_after(course%material, p_c, e, path, sat, branch)
      s_w = path%s_w
      turns = path%turns
      if (.not. begins_at_turn(course, path)) return
      branch = begin_at_turn(course%material, path, course%slope)
      change = change_with_turn(branch, p_c, e)
      with_turn = change(1)*course%with_increment
   end subroutine end_course
end module mud_retention
