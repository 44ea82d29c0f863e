! SPDX-License-Identifier: MIT
!> Water retention: how much of the pore space is water; docs/theory/material.md section 2.1. With hysteresis the
!> parameters are those of a phase of an increment: see mud_scanning.
module mud_retention
   use mud_kinds, only: wp
   use mud_params, only: params_t, scanning_t
   implicit none (type, external)
   private
   public :: saturation_t, saturation, saturation_curvature, scanning_weight, log_suction, LOG_LARGE, EULER

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

   !> d ln y/d ln x = (x/y)**q of a scanning curve, 1 on a main curve [-]. docs/theory/material.md section 2.1.1; the
   !> signs are not checked.
   pure real(wp) function scanning_weight(par, p_c, e) result(weight)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e   !< [kPa, -], p_c > 0
      real(wp) :: log_x

      weight = 1.0_wp
      if (.not. par%scanning%between) return
      log_x = log_suction(par, p_c, e)
      call to_main_curve(par%scanning, log_x, weight)
   end function scanning_weight

   !> From the suction on a scanning curve to that of the main curve at the same S_w, both as ln(x/P_a).
   pure subroutine to_main_curve(scanning, log_x, weight)
      type(scanning_t), intent(in) :: scanning
      real(wp), intent(inout) :: log_x
      real(wp), intent(out) :: weight   !< See scanning_weight.
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
      real(wp) :: curvature(3), slope, bend, weight

      curvature = 0.0_wp
      if (p_c <= 0.0_wp) return
      slope = sat%ds_dpc*p_c                                    ! dS_w/d ln p*
      bend = slope*par%n_x*(1.0_wp - sat%share*(1.0_wp + (par%m_x + 1.0_wp)/sat%log_sum))
      if (par%scanning%between) then
         weight = scanning_weight(par, p_c, e)
         bend = bend*weight + slope*par%scanning%q*(1.0_wp - weight)
      end if
      curvature = [(bend - slope)/p_c**2, bend*par%omega/(p_c*e), (bend*par%omega - slope)*par%omega/e**2]
   end function saturation_curvature
end module mud_retention
