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
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_params, only: params_t
   use mud_state, only: state_t
   use mud_tensor, only: IDENTITY, trace, deviator, norm
   implicit none (type, external)
   private
   public :: MODE_HELD, SHUT, lifted, is_below, landed, may_open, parting, gap_at, is_parted, soil_void_ratio, hold, &
             slide

   integer, parameter :: MODE_HELD = 2   !< A substep held at p_min; see MODE_* of mud_rates.

   real(wp), parameter :: AT_LIMIT = 1.0e-9_wp      !< p' this close (relative) to p_min is at p_min [-].
   real(wp), parameter :: SHUT = 1.0e-13_wp         !< A gap below this share of the volume is rounding [-].
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
      lifted = par%p_min*(IDENTITY + limited(par%critical, psi_of(par%critical, law, e, p_c, par%p_min), &
                                             deviator(sigma)/par%p_min))
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

   !> Void ratio at which the soil of a point that is held from here on is at its loosest; beyond, its grains part [-].
   !> The hardening of the soil vanishes at 1/c_h, its shear modulus at STIFF_ABOVE; the critical state is a state of
   !> soil, and so is where the point is, if it has no gap yet. docs/theory/material.md section 6.4.
   pure real(wp) function parting(par, state)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state

      if (state%gap > 0.0_wp) then
         parting = state%e - state%gap
      else
         parting = max(critical_void_ratio(par%critical, 1.0_wp, par%p_min), &
                       1.0_wp/max(par%hardening%c_h, tiny(1.0_wp)))
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

   !> Stress ratio of a held point after a step h that begins at r0 at a pseudo-time. r0, r, time and h [-], the last
   !> two shares of inc. docs/theory/material.md section 6.2.
   pure function slide(par, inc, parts, r0, time, h) result(r)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, r0(6), time, h
      real(wp) :: r(6), e

      e = min(void_ratio_at(inc, time + h), parts)
      r = r0 + deviator((2.0_wp*shear_modulus(par%elastic, e, par%p_min)/par%p_min*h)*inc%d_strain)
      r = limited(par%critical, psi_of(par%critical, inc%suction, e, suction_at(inc, time + h), par%p_min), r)
   end function slide
end module mud_cutoff
