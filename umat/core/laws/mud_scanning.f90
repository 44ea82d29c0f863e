! SPDX-License-Identifier: MIT
!> Hydraulic hysteresis: S_w between a main drying and a main wetting curve; docs/theory/material.md section 2.1.1.
!> While the modified suction x = p_c e^Omega rises, or while it falls, S_w is a function of x alone, a scanning curve
!> in closed form. So a phase of an increment is integrated with a copy of the parameters that has this curve.
module mud_scanning
   use mud_kinds, only: wp
   use mud_params, only: params_t, NOT_SCANNING
   use mud_registry, only: P_P_AW, S_SATURATION
   use mud_retention, only: saturation_t, saturation, log_suction, LOG_LARGE, EULER
   use mud_status, only: mud_status_t, fail, MUD_BAD_PROPS, MUD_BAD_STATE, ON_PROPS, ON_STATEV
   use mud_tensor, only: is_finite
   implicit none (type, external)
   private
   public :: branch_from, main_curve, clipped, check_curves, check_saturation, preset_saturation

   !> S_w this close to a main curve, as a share of S_max, is on it: rounding of S_w, which near S_max would be a large
   !> error of the suction that belongs to it [-].
   real(wp), parameter :: ON_CURVE = 8.0_wp*epsilon(1.0_wp)
   real(wp), parameter :: LARGEST_LOG = 69.0_wp   !< ln of the largest ln(exp(1) + a) that is looked at [-].
   real(wp), parameter :: PRESET_ROUNDING = 1.0e-6_wp   !< Of a preset of six digits, as a share of S_max [-].
   !> Suctions at which check_curves compares: from S_w = S_max but some 1e-8 to a million times P_a; ln(x/P_a) of
   !> both ends, the first with n_x. AS_MUCH: what rounding so close to S_max makes of ln P_aw [-].
   integer, parameter :: POINTS = 200
   real(wp), parameter :: WET_END = -18.0_wp, DRY_END = 14.0_wp, AS_MUCH = 1.0e-6_wp
contains
   !> Parameters of the phase that begins at (p_c, e, s_w) and dries or wets: their saturation is that along the
   !> scanning curve. s_w lies between the main curves. Without suction, or with s_w on the main curve, they are those
   !> of the main curve. Closed form of docs/theory/material.md section 2.1.1; nothing is refused.
   pure function branch_from(par, dries, p_c, e, s_w) result(branch)
      type(params_t), intent(in) :: par   !< Of the material.
      logical, intent(in) :: dries
      real(wp), intent(in) :: p_c, e, s_w   !< [kPa, -, -]
      type(params_t) :: branch
      type(saturation_t) :: main
      real(wp) :: log_x, log_y, growth

      branch = par
      if (.not. dries) then
         branch%p_a = par%p_aw
         branch%n_x = par%n_w
         branch%m_x = par%m_w
      end if
      branch%scanning = NOT_SCANNING
      if (p_c <= 0.0_wp) return
      main = saturation(branch, p_c, e)
      if (abs(s_w - main%s_w) <= ON_CURVE*par%s_max) return

      branch%scanning%q = merge(1.0_wp + par%b_d, 1.0_wp - par%b_w, dries)
      log_x = log_suction(branch, p_c, e)
      log_y = suction_on_curve(branch, s_w)
      growth = branch%scanning%q*(log_y - log_x)   ! offset**q = x**q (exp(growth) - 1)
      if (growth <= epsilon(growth)) return
      branch%scanning%between = .true.
      branch%scanning%log_offset = branch%scanning%q*log_x
      if (growth > LOG_LARGE) then
         branch%scanning%log_offset = branch%scanning%log_offset + growth
      else
         branch%scanning%log_offset = branch%scanning%log_offset + log(exp(growth) - 1.0_wp)
      end if
   end function branch_from

   !> ln(x/P_a) of the main curve in par at a degree of saturation.
   pure real(wp) function suction_on_curve(par, s_w) result(log_y)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: s_w
      real(wp) :: s_e, log_sum, a

      log_y = -LOG_LARGE/par%n_x
      s_e = (s_w - par%s_min)/(par%s_max - par%s_min)
      if (s_e >= 1.0_wp) return
      log_sum = exp(LARGEST_LOG)
      if (s_e > 0.0_wp) log_sum = exp(min(-log(s_e)/par%m_x, LARGEST_LOG))   ! ln(exp(1) + a)
      if (log_sum > LOG_LARGE) then
         log_y = log_sum/par%n_x
      else
         a = exp(log_sum) - EULER
         if (a > exp(-LOG_LARGE)) log_y = log(a)/par%n_x
      end if
   end function suction_on_curve

   !> Degrees of saturation of the main wetting and the main drying curve [-].
   pure function main_curves(par, p_c, e) result(bounds)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      real(wp) :: bounds(2)
      type(saturation_t) :: dry, wet

      dry = saturation(main_curve(par, .true.), p_c, e)
      wet = saturation(main_curve(par, .false.), p_c, e)
      bounds = [wet%s_w, dry%s_w]
   end function main_curves

   !> Parameters with which saturation is that of main drying, or of main wetting. docs/theory/material.md section
   !> 2.1.1.
   pure function main_curve(par, dries) result(curve)
      type(params_t), intent(in) :: par
      logical, intent(in) :: dries
      type(params_t) :: curve

      ! there is no scanning curve from zero suction
      curve = branch_from(par, dries, 0.0_wp, 1.0_wp, par%s_max)
   end function main_curve

   !> S_w between the main curves; count grows by one where it was not. At a suction [kPa] and a void ratio [-];
   !> docs/theory/material.md section 2.1.1.
   pure subroutine clipped(par, p_c, e, s_w, count)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      real(wp), intent(inout) :: s_w
      integer, intent(inout) :: count
      real(wp) :: bounds(2), inside

      bounds = main_curves(par, p_c, e)
      inside = max(min(s_w, bounds(2)), bounds(1))
      if (abs(inside - s_w) > ON_CURVE*par%s_max) count = count + 1
      s_w = inside
   end subroutine clipped

   !> S_w of a point that begins at a preset one of STATEV, which must lie between the main curves; 0: on the main
   !> drying curve. At a suction [kPa] and a void ratio [-]. One that is not finite, or outside by more than 1e-6 S_max,
   !> is MUD_BAD_STATE; a good one leaves status as it is.
   pure subroutine preset_saturation(par, p_c, e, s_w, status)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      real(wp), intent(inout) :: s_w
      type(mud_status_t), intent(inout) :: status
      real(wp) :: bounds(2)

      bounds = main_curves(par, p_c, e)
      if (is_finite(s_w)) then
         if (abs(s_w) <= 0.0_wp) s_w = bounds(2)
      end if
      call check_saturation(par, p_c, e, s_w, status)
      if (is_finite(s_w)) s_w = max(min(s_w, bounds(2)), bounds(1))
   end subroutine preset_saturation

   !> That S_w of a state lies between the main curves at its suction [kPa] and void ratio [-]. One that is not finite,
   !> or outside by more than 1e-6 S_max, is MUD_BAD_STATE; a good one leaves status as it is.
   pure subroutine check_saturation(par, p_c, e, s_w, status)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e, s_w
      type(mud_status_t), intent(inout) :: status
      real(wp) :: bounds(2), rounding

      bounds = main_curves(par, p_c, e)
      rounding = PRESET_ROUNDING*par%s_max
      if (is_finite(s_w)) then
         if (s_w >= bounds(1) - rounding .and. s_w <= bounds(2) + rounding) return
      end if
      status = fail(MUD_BAD_STATE, ON_STATEV, S_SATURATION, s_w, bounds(1), bounds(2))
   end subroutine check_saturation

   !> The main wetting curve nowhere above the main drying curve, beyond what bounds of single parameters say: the
   !> largest P_aw of which that is true at many suctions. A P_aw [kPa] above it is MUD_BAD_PROPS, with that limit;
   !> otherwise status stays as it is. docs/theory/material.md section 2.1.1.
   pure subroutine check_curves(par, status)
      type(params_t), intent(in) :: par
      type(mud_status_t), intent(inout) :: status
      type(params_t) :: wet
      type(saturation_t) :: dry
      real(wp) :: log_x, limit
      integer :: i

      wet = main_curve(par, .false.)
      limit = log(par%p_a)
      do i = 0, POINTS
         log_x = WET_END/par%n_x + (DRY_END - WET_END/par%n_x)*real(i, wp)/POINTS
         dry = saturation(par, par%p_a*exp(log_x), 1.0_wp)
         limit = min(limit, log(par%p_a) + log_x - suction_on_curve(wet, dry%s_w))
      end do
      if (log(par%p_aw) > limit + AS_MUCH) &
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_P_AW, par%p_aw, 0.0_wp, exp(limit))
   end subroutine check_curves
end module mud_scanning
