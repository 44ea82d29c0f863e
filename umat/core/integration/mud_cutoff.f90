! SPDX-License-Identifier: MIT
!> Tension cut-off: what happens at p_min. A point whose mean stress falls to p_min opens and is held there; it closes
!> where its mean stress would rise; a stress that begins below p_min is lifted.
!>
!> While a point is held p', fabric, memory and plastic shear rest. The stress ratio follows the strain elastically, but
!> not beyond the bounding surface, along which it slides. Were it frozen, an undrained path that gets here on its
!> contractive side could never leave, in whatever direction it is sheared. docs/theory/material.md section 6.
module mud_cutoff
   use mud_kinds, only: wp
   use mud_bonding, only: suction_law_t
   use mud_bounding, only: psi_of, limited
   use mud_critical_state, only: critical_void_ratio
   use mud_elastic, only: shear_modulus, STIFF_ABOVE
   use mud_increment, only: increment_t, void_ratio_at, suction_at, rate_of
   use mud_options, only: forget_past
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, MODE_ORDINARY, MODE_ELASTIC
   use mud_state, only: state_t, counters_t
   use mud_tensor, only: IDENTITY, trace, deviator, norm
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: MODE_HELD
   public :: lifted, is_below, landed, may_open, height, height_rate
   public :: parting, gap_at, is_parted, end_at_parting, soil_void_ratio, hold, slide
   public :: closing_mode, rate_without_past, closes, closing_function, closing_share

   integer, parameter :: MODE_HELD = 2   !< A substep held at p_min; see MODE_* of mud_rates.

   real(wp), parameter :: AT_LIMIT = 1.0e-9_wp      !< p' this close (relative) to p_min is at p_min [-].
   real(wp), parameter :: SHUT = 1.0e-13_wp         !< A gap below this share of the volume is rounding [-].
   !> An open point closes when p' would rise by this share of the elastic rate: opening and closing at the same rate
   !> would chatter where the two pull the stress ratio to opposite sides [-].
   real(wp), parameter :: CLOSING = 0.01_wp
   !> Each time a point opens again in the same increment the share is that many times larger, up to a limit: where
   !> the rate without a past rises and that of the process that follows falls, it would open and close at every turn
   !> [-].
   real(wp), parameter :: CLOSING_GROWTH = 4.0_wp, LARGEST_CLOSING = 0.32_wp
contains
   !> A stress whose mean is below p_min, as at a free surface: p_min, with a stress ratio on or inside the bounding
   !> surface. sigma' and p_c in the unit of p_atm, compression positive, e [-]. docs/theory/material.md section 1.4.
   pure function lifted(par, law, sigma, e, p_c)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      real(wp), intent(in) :: sigma(6), e, p_c
      real(wp) :: lifted(6)

      lifted = sigma
      if (trace(sigma) >= 3.0_wp*par%p_min*(1.0_wp - AT_LIMIT)) return
      lifted = par%p_min*(IDENTITY + limited(par, psi_of(par, law, e, p_c, par%p_min), deviator(sigma)/par%p_min))
   end function lifted

   !> True where the cut-off does not let a mean stress be. sigma' in the unit of p_atm. docs/theory/material.md section
   !> 6.1.
   pure logical function is_below(par, sigma)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6)

      is_below = par%cutoff .and. trace(sigma) < 3.0_wp*par%p_min
   end function is_below

   !> The stress with which a substep ends: a mean that landed below p_min is set to p_min. In the unit of p_atm.
   !> docs/theory/material.md section 6.1.
   pure function landed(par, sigma)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6)
      real(wp) :: landed(6)

      landed = sigma
      if (is_below(par, sigma)) landed = deviator(sigma) + par%p_min*IDENTITY
   end function landed

   !> True where p' is at p_min and would fall: whether the point opens is what closes tells. sigma' and the rate of p'
   !> in the unit of p_atm. docs/theory/material.md section 6.1.
   pure logical function may_open(par, sigma, d_p)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), d_p

      may_open = par%cutoff .and. d_p <= 0.0_wp
      if (may_open) may_open = trace(sigma) <= 3.0_wp*par%p_min*(1.0_wp + AT_LIMIT)
   end function may_open

   !> Height of p' above p_min, as a share of p_min [-]: a point opens where it passes zero. sigma' in the unit of
   !> p_atm. docs/theory/integration.md section 4.2.
   pure real(wp) function height(par, sigma)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6)

      height = trace(sigma)/(3.0_wp*par%p_min) - 1.0_wp
   end function height

   !> Rate of the height of p' above p_min [-], per unit of pseudo-time.
   pure real(wp) function height_rate(par, w)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w

      height_rate = w%d_p/par%p_min
   end function height_rate

   !> Void ratio at which the soil of a point that is held from here on is at its loosest; beyond, its grains part [-].
   !> The hardening of the soil vanishes at 1/c_h, its shear modulus at STIFF_ABOVE; the critical state is a state of
   !> soil, and so is where the point is, if it has no gap yet. docs/theory/material.md section 6.4.
   pure real(wp) function parting(par, state)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state

      if (state%gap > 0.0_wp) then
         parting = state%e - state%gap
      else
         parting = max(critical_void_ratio(par, 1.0_wp, par%p_min), 1.0_wp/max(par%c_h, tiny(1.0_wp)))
         parting = max(min(parting, STIFF_ABOVE), state%e)
      end if
   end function parting

   !> Gap of a held point, and void ratio of its soil: both make up its void ratio e. [-]
   pure real(wp) function gap_at(e, parts)
      real(wp), intent(in) :: e, parts   !< parts: that of parting

      gap_at = max(e - parts, 0.0_wp)
      if (gap_at < SHUT*(1.0_wp + e)) gap_at = 0.0_wp
   end function gap_at

   !> Void ratio of the soil of a point [-]. docs/theory/material.md section 6.4.
   pure real(wp) function soil_void_ratio(state)
      type(state_t), intent(in) :: state

      soil_void_ratio = state%e - state%gap
   end function soil_void_ratio

   !> True where the grains of a held point are parted at a pseudo-time, a share of inc [-].
   pure logical function is_parted(inc, parts, time)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, time   !< parts: that of parting

      is_parted = void_ratio_at(inc, time) - parts > SHUT*(1.0_wp + parts)
   end function is_parted

   !> Ends a held substep h, which begins at a pseudo-time, where its gap begins or ends; shares of inc [-]. h stays
   !> where the gap does neither. docs/theory/integration.md section 4.2.
   pure subroutine end_at_parting(inc, parts, time, h, ends)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, time   !< parts: that of parting
      real(wp), intent(inout) :: h
      logical, intent(out) :: ends
      real(wp) :: before, after

      before = void_ratio_at(inc, time) - parts
      after = void_ratio_at(inc, time + h) - parts
      ends = before*after < 0.0_wp .and. min(abs(before), abs(after)) > SHUT*(1.0_wp + parts)
      if (ends) h = log((1.0_wp + inc%e0)/(1.0_wp + parts))/inc%d_v - time
   end subroutine end_at_parting

   !> A held substep h, which begins at a pseudo-time: two half steps. sigma' in the unit of p_atm. The error is that of
   !> the stress ratio, against the whole step [-]. time and h are shares of inc. docs/theory/material.md section 6.2.
   pure subroutine hold(par, inc, parts, time, h, sigma, error)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, time, h   !< parts: parting
      real(wp), intent(inout) :: sigma(6)
      real(wp), intent(out) :: error
      real(wp) :: whole(6), half(6)

      half = deviator(sigma)/par%p_min
      whole = slide(par, inc, parts, half, time, h)
      half = slide(par, inc, parts, half, time, 0.5_wp*h)
      half = slide(par, inc, parts, half, time + 0.5_wp*h, 0.5_wp*h)
      sigma = par%p_min*(half + IDENTITY)
      error = norm(half - whole)
   end subroutine hold

   !> Mode in which a held point would go on if it closed: inside the elastic domain without plastic dilatancy. One of
   !> MODE_ORDINARY and MODE_ELASTIC.
   pure integer function closing_mode(inc)
      type(increment_t), intent(in) :: inc

      closing_mode = merge(MODE_ELASTIC, MODE_ORDINARY, inc%inside)
   end function closing_mode

   !> The rate of a held point that closes: without a past. time is a share of inc [-], y as for rate_of.
   !> docs/theory/material.md section 6.3.
   pure subroutine rate_without_past(par, inc, time, y, w, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, y(NY)
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters
      real(wp) :: p, r(6), virgin(NY)

      call stress_ratio(par, y(1:6), p, r)
      virgin = y
      call forget_past(virgin)
      call rate_of(par, inc, time, virgin, r, closing_mode(inc), w, counters)
   end subroutine rate_without_past

   !> True where p' would rise from p_min by enough to close. docs/theory/material.md sections 6.1, 6.3.
   pure logical function closes(inc, openings, w)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings      !< number of times that p' has fallen to p_min in this increment or phase
      type(rate_t), intent(in) :: w        !< at p_min, without a past

      closes = .not. closing_rate(inc, openings, w) <= 0.0_wp   ! a rate that is not finite is not hidden
   end function closes

   !> Distance of an open point below the rate of p' at which it closes, as a share of the elastic rate [-]: it closes
   !> where that passes zero. docs/theory/integration.md section 4.2.
   pure real(wp) function closing_function(inc, openings, w)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings
      type(rate_t), intent(in) :: w        !< at p_min, without a past

      closing_function = -closing_rate(inc, openings, w)/elastic_length(inc, w)
   end function closing_function

   !> Distance of the rate of p' above the one at which an open point closes, positive if it closes [kPa].
   pure real(wp) function closing_rate(inc, openings, w)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings
      type(rate_t), intent(in) :: w

      closing_rate = w%d_p - closing_share(openings)*elastic_length(inc, w)
   end function closing_rate

   !> Share of the elastic rate at which an open point closes [-].
   pure real(wp) function closing_share(openings)
      integer, intent(in) :: openings

      closing_share = min(CLOSING*CLOSING_GROWTH**max(openings - 1, 0), LARGEST_CLOSING)
   end function closing_share

   !> Size of the elastic rate of p' [kPa].
   pure real(wp) function elastic_length(inc, w)
      type(increment_t), intent(in) :: inc
      type(rate_t), intent(in) :: w

      elastic_length = w%k*inc%length + abs(inc%d_pc)
   end function elastic_length

   !> Stress ratio of a held point after a step h that begins at r0 at a pseudo-time. r0, r, time and h [-], the last
   !> two shares of inc. docs/theory/material.md section 6.2.
   pure function slide(par, inc, parts, r0, time, h) result(r)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, r0(6), time, h
      real(wp) :: r(6), e

      e = min(void_ratio_at(inc, time + h), parts)
      r = r0 + deviator((2.0_wp*shear_modulus(par, e, par%p_min)/par%p_min*h)*inc%d_strain)
      r = limited(par, psi_of(par, inc%suction, e, suction_at(inc, time + h), par%p_min), r)
   end function slide
end module mud_cutoff
