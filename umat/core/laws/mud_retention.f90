! SPDX-License-Identifier: MIT
!> Water retention: how much of the pore space is water; docs/theory/material.md section 2.1. With hysteresis the
!> parameters are those of a phase of an increment: see mud_scanning.
module mud_retention
   use mud_kinds, only: wp
   use mud_params, only: params_t, scanning_t
   implicit none (type, external)
   private
   public :: saturation_t, saturation, saturation_curvature, change_of_offset, offset_with_turn, log_suction, &
             LOG_LARGE, EULER

   real(wp), parameter :: EULER = 2.7182818284590452_wp      !< exp(1)
   !> Beyond it exp(1) is lost in exp(1) + a, and a might overflow.
   real(wp), parameter :: LOG_LARGE = 200.0_wp

   !> Degree of saturation and its slopes.
   type :: saturation_t
      real(wp) :: s_w      !< S_w [-]
      real(wp) :: ds_dpc   !< dS_w/dp_c at constant e [1/kPa]
      real(wp) :: ds_de    !< dS_w/de at constant p_c [-]
      real(wp) :: share    !< a/(exp(1) + a) of eq. (24), for the curvature [-]
      real(wp) :: log_sum  !< ln(exp(1) + a), likewise [-]
   end type saturation_t
contains
   !> Degree of saturation at a suction [kPa] and a void ratio [-], paper eqs (23), (24). No suction: S_max, zero
   !> slopes. On a scanning branch that of docs/theory/material.md section 2.1.1. e > 0 is not checked.
   pure function saturation(par, p_c, e) result(sat)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat
      real(wp) :: log_x, log_a, a, share, log_sum, s_e, slope, weight

      sat = saturation_t(par%s_max, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp)
      if (p_c <= 0.0_wp) return
      log_x = log_suction(par, p_c, e)
      if (par%scanning%between) call to_main_curve(par%scanning, log_x, weight)
      log_a = par%n_x*log_x                                     ! a = (p*/P_a)^n
      if (log_a < -LOG_LARGE) return
      if (log_a > LOG_LARGE) then
         log_sum = log_a
         share = 1.0_wp                                         ! a/(exp(1) + a)
      else
         a = exp(log_a)
         log_sum = log(EULER + a)
         share = a/(EULER + a)
      end if
      s_e = (par%s_max - par%s_min)*log_sum**(-par%m_x)
      sat%s_w = par%s_min + s_e
      slope = -par%m_x*s_e/log_sum*share*par%n_x                ! dS_w/d ln p*
      if (par%scanning%between) slope = slope*weight
      sat%ds_dpc = slope/p_c
      sat%ds_de = slope*par%omega/e
      sat%share = share
      sat%log_sum = log_sum
   end function saturation

   !> ln(p*/P_a), paper eq. (23). It is ln(p_c/P_a) + Omega ln e [-]; the signs are not checked.
   pure real(wp) function log_suction(par, p_c, e)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e   !< [kPa, -], p_c > 0

      log_suction = log(p_c/par%p_a)
      if (par%omega > 0.0_wp) log_suction = log_suction + par%omega*log(e)
   end function log_suction

   !> weight = d ln y/d ln x = (x/y)**q of a scanning curve, and 1 - weight without cancellation.
   pure subroutine scanning_weights(par, p_c, e, weight, rest)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e   !< p_c > 0
      real(wp), intent(out) :: weight, rest
      real(wp) :: log_x, t

      log_x = log_suction(par, p_c, e)
      t = par%scanning%log_offset - par%scanning%q*log_x
      call to_main_curve(par%scanning, log_x, weight)
      rest = 1.0_wp
      if (t < LOG_LARGE) rest = exp(t)*weight
   end subroutine scanning_weights

   !> From the suction on a scanning curve to that of the main curve at the same S_w, both as ln(x/P_a).
   pure subroutine to_main_curve(scanning, log_x, weight)
      type(scanning_t), intent(in) :: scanning
      real(wp), intent(inout) :: log_x
      real(wp), intent(out) :: weight   !< d ln y/d ln x [-]
      real(wp) :: t, log_weight

      t = scanning%log_offset - scanning%q*log_x
      if (t > LOG_LARGE) then
         log_weight = -t
      else
         log_weight = -log(1.0_wp + exp(t))
      end if
      weight = exp(log_weight)
      log_x = log_x - log_weight/scanning%q
   end subroutine to_main_curve

   !> Second derivatives [d2S/dp_c2 (1/kPa2), d2S/dp_c de (1/kPa), d2S/de2 (-)] at the suction and void ratio of sat.
   !> sat is that of p_c [kPa] and e [-]; zeros without suction. Derivatives of paper eqs (23), (24) and of
   !> docs/theory/material.md section 2.1.1.
   pure function saturation_curvature(par, sat, p_c, e) result(curvature)
      type(params_t), intent(in) :: par
      type(saturation_t), intent(in) :: sat
      real(wp), intent(in) :: p_c, e
      real(wp) :: curvature(3), slope, bend, weight, rest

      curvature = 0.0_wp
      if (p_c <= 0.0_wp) return
      slope = sat%ds_dpc*p_c                                    ! dS_w/d ln p*
      bend = slope*par%n_x*(1.0_wp - sat%share*(1.0_wp + (par%m_x + 1.0_wp)/sat%log_sum))
      if (par%scanning%between) then
         call scanning_weights(par, p_c, e, weight, rest)
         bend = bend*weight + slope*par%scanning%q*rest
      end if
      ! one division after the other: the square of a tiny suction would be 0
      curvature = [(bend - slope)/p_c/p_c, bend*par%omega/p_c/e, (bend*par%omega - slope)*par%omega/e**2]
   end function saturation_curvature

   !> Derivatives [dS_w (-), d2S_w/dp_c (1/kPa), d2S_w/de (-)] with respect to q ln offset of a scanning curve, at the
   !> suction and void ratio of sat. sat is that of p_c [kPa] and e [-]; zeros without suction and on a main curve.
   !> docs/theory/material.md section 2.1.1.
   pure function change_of_offset(par, sat, p_c, e) result(change)
      type(params_t), intent(in) :: par
      type(saturation_t), intent(in) :: sat
      real(wp), intent(in) :: p_c, e
      real(wp) :: change(3), slope, weight, rest

      change = 0.0_wp
      if (.not. par%scanning%between .or. p_c <= 0.0_wp) return
      call scanning_weights(par, p_c, e, weight, rest)
      slope = slope_of_main_curve(par, sat)
      change(1) = slope*rest/par%scanning%q
      change(2) = weight*rest*(bend_of_main_curve(par, sat, slope)/par%scanning%q - slope)   ! with ln x
      change(3) = change(2)*par%omega/e
      change(2) = change(2)/p_c
   end function change_of_offset

   !> dS_w/d ln y of the main curve, at the S_w of sat.
   pure real(wp) function slope_of_main_curve(par, sat) result(slope)
      type(params_t), intent(in) :: par
      type(saturation_t), intent(in) :: sat

      slope = -par%m_x*(sat%s_w - par%s_min)/sat%log_sum*sat%share*par%n_x
   end function slope_of_main_curve

   !> d2S_w/d(ln y)2, likewise.
   pure real(wp) function bend_of_main_curve(par, sat, slope) result(bend)
      type(params_t), intent(in) :: par
      type(saturation_t), intent(in) :: sat
      real(wp), intent(in) :: slope

      bend = slope*par%n_x*(1.0_wp - sat%share*(1.0_wp + (par%m_x + 1.0_wp)/sat%log_sum))
   end function bend_of_main_curve

   !> d(q ln offset)/d ln x of the wetting curve in par that leaves a drying curve at p_c [kPa] and e [-], where
   !> y**q = x**q + offset**q and S_w(y) changes along the drying curve. dries is the saturation on that, sat on the
   !> wetting curve; 0 where no water moves. docs/theory/material.md section 2.1.1.
   pure real(wp) function offset_with_turn(par, dries, sat, p_c, e) result(change)
      type(params_t), intent(in) :: par
      type(saturation_t), intent(in) :: dries, sat
      real(wp), intent(in) :: p_c, e
      real(wp) :: slope, weight, rest

      change = 0.0_wp
      if (.not. par%scanning%between) return
      slope = slope_of_main_curve(par, sat)
      if (abs(slope) <= 0.0_wp) return
      call scanning_weights(par, p_c, e, weight, rest)
      change = par%scanning%q*(dries%ds_dpc*p_c/slope - weight)/rest
   end function offset_with_turn
end module mud_retention
