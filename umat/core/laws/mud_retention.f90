! SPDX-License-Identifier: MIT
!> Water retention: how much of the pore space is water; docs/theory/material.md section 2.1. A retention is a curve, or
!> with hysteresis the branch that a phase of an increment follows, which mud_scanning makes; both answer alike.
module mud_retention
   use mud_kinds, only: wp
   use mud_registry, only: MAX_TURNS
   implicit none (type, external)
   private
   public :: retention_t, branch_t, scanning_t, least_t, NO_BRANCH, NO_OFFSET, MAX_LEAST
   public :: saturation_t, saturation, saturation_curvature, change_with_turn, log_suction, NO_SUCTION
   public :: main_curve_t, main_curve, on_main_curve_t, on_main_curve, bend_of, suction_on_curve, power_of, &
             along_t, along_raw_branch, follow_branches, curve_at, ON_CURVE

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
   type(branch_t), parameter :: NO_BRANCH = branch_t(.true., 0.0_wp, 0.0_wp, NO_OFFSET, 1.0_wp, .false.)

   !> The parameters of the main curves, and the branch that is followed where that acts. Those of the wetting curve and
   !> of hysteresis are set with hysteresis; what the user leaves to others has their values.
   type :: retention_t
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
      type(on_main_curve_t) :: at
      type(along_t) :: along
      logical :: limited

      sat = saturation_t(self%s_max, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp)
      if (p_c <= 0.0_wp) return
      if (self%scanning%acts) then
         call follow_branches(self, log_suction(self, p_c, e), along, limited)
         sat%s_w = along%s_w
         sat%ds_dpc = along%slope/p_c
         sat%ds_de = along%slope*self%omega/e
         return
      end if
      at = on_main_curve(self, main_curve_t(0.0_wp, self%n_x, self%m_x), log_suction(self, p_c, e))
      sat%s_w = at%s_w
      sat%ds_dpc = at%slope/p_c
      sat%ds_de = at%slope*self%omega/e
      sat%share = at%share
      sat%log_sum = at%log_sum
   end function saturation

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
      log_suction = log(p_c/self%p_a)
      if (self%omega > 0.0_wp) log_suction = log_suction + self%omega*log(e)
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
   pure subroutine limit(self, dries, begins, other, along, limited)
      type(retention_t), intent(in) :: self
      logical, intent(in) :: dries
      logical, intent(in) :: begins   !< Where both are equal it leaves the other one; not where it arrives there.
      type(along_t), intent(in) :: other
      type(along_t), intent(inout) :: along
      logical, intent(out), optional :: limited   !< The other one is followed.
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
      if (present(limited)) limited = acts
   end subroutine limit

   !> A point of the present branch at ln(x/P_a) [-]: every branch is scaled so that it closes its loop, and limited by
   !> the one that it left, so that closed loops dissipate. docs/theory/material.md section 2.1.1.
   pure subroutine follow_branches(self, log_x, along, limited)
      type(retention_t), intent(in) :: self
      real(wp), intent(in) :: log_x
      type(along_t), intent(out) :: along
      logical, intent(out) :: limited   !< The last branch is not the one that is followed.
      type(along_t) :: left
      integer :: k

      along = along_raw_branch(self, self%scanning%branches(1), log_x)
      limited = .false.
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
                       abs(log_x - branch%log_x) < abs(log_x - self%scanning%branches(k - 1)%log_x), &
                       left, along, limited)
         end associate
      end do
   end subroutine follow_branches

   !> Number of the curve that is followed at ln(x/P_a) [-]: another one where S_w has had a kink on the way.
   pure integer function curve_at(self, log_x)
      type(retention_t), intent(in) :: self   !< with a branch
      real(wp), intent(in) :: log_x
      type(along_t) :: along
      logical :: limited

      call follow_branches(self, log_x, along, limited)
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
      logical :: limited

      curvature = 0.0_wp
      if (p_c <= 0.0_wp) return
      slope = sat%ds_dpc*p_c                                    ! dS_w/d ln p*
      if (self%scanning%acts) then
         call follow_branches(self, log_suction(self, p_c, e), along, limited)
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
      logical :: limited

      change = 0.0_wp
      if (.not. self%scanning%moves .or. p_c <= 0.0_wp) return
      log_x = log_suction(self, p_c, e)
      call follow_branches(self, log_x, along, limited)
      if (limited) return
      associate (scanning => self%scanning, branch => self%scanning%branches(self%scanning%n))
         along = along_raw_branch(self, branch, log_x)
         change(1) = (1.0_wp - branch%share)*scanning%s_w_rate + scanning%share_rate*(along%s_w - branch%s_w) &
                     + branch%share*scanning%offset_rate*along%with_offset
         change(2) = scanning%share_rate*along%slope + branch%share*scanning%offset_rate*along%slope_with_offset
      end associate
      change(3) = change(2)*self%omega/e
      change(2) = change(2)/p_c
   end function change_with_turn
end module mud_retention
