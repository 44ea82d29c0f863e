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
   use mud_bounding, only: psi_of, change_of_psi, excess, change_of_excess, limited, &
      change_of_limited
   use mud_critical_state, only: critical_void_ratio
   use mud_driving, only: driving_t, change_of_place, DIRECTIONS
   use mud_elastic, only: bulk_slope, shear_modulus, shear_slope, STIFF_ABOVE
   use mud_increment, only: increment_t, void_ratio_at, suction_at, rate_of
   use mud_params, only: params_t
   use mud_preloading, only: NO_CONTRACTION
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, MODE_ORDINARY, MODE_ELASTIC
   use mud_state, only: state_t, counters_t
   use mud_tensor, only: IDENTITY, ddot, trace, deviator, norm
   use mud_vector, only: NY, Y_LOG_CHI
   implicit none (type, external)
   private
   public :: MODE_HELD
   public :: lifted, is_below, landed, may_open, height, changes_of_height, height_rate
   public :: parting, gap_at, is_parted, end_at_parting, soil_void_ratio, hold, changes_through_hold, held_tangent
   public :: closing_mode, rate_without_past, closes, closing_function, change_of_closing_rate

   integer, parameter :: MODE_HELD = 2   !< A substep held at p_min; see MODE_* of mud_rates.

   real(wp), parameter :: AT_LIMIT = 1.0e-9_wp      !< p' this close (relative) to p_min is at p_min [-].
   real(wp), parameter :: SHUT = 1.0e-13_wp         !< A gap below this share of the volume is rounding [-].
   real(wp), parameter :: ON_SURFACE = 1.0e-12_wp   !< r this close (relative) to the bounding surface is on it [-].
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

   !> Changes of the height of p' above p_min with those of the stress, times 3 p_min. In the unit of p_atm.
   pure function changes_of_height(y) result(changes)
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      real(wp) :: changes(DIRECTIONS)

      changes = y(:, 1) + y(:, 2) + y(:, 3)
   end function changes_of_height

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

   !> Derivatives of the stress through that substep: its start moves by `shift` in pseudo-time, its size changes by dh.
   !> sigma' and y(:, 1:6) in the unit of p_atm. Derivative of docs/theory/material.md section 6.2.
   pure subroutine changes_through_hold(par, inc, parts, dparts, sigma, time, h, shift, dh, driving, y)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: sigma(6)   !< where it begins
      real(wp), intent(in) :: parts, dparts(DIRECTIONS)   !< parting and its changes
      real(wp), intent(in) :: time, h, shift(DIRECTIONS), dh(DIRECTIONS)
      type(driving_t), intent(in) :: driving
      real(wp), intent(inout) :: y(DIRECTIONS, NY)
      real(wp), dimension(DIRECTIONS) :: de_half, dp_c_half, de, dp_c, turn
      real(wp) :: r0(6), r_half(6), dr(6), strain(6), half, middle
      integer :: j

      half = 0.5_wp*h
      middle = time + half
      r0 = deviator(sigma)/par%p_min
      r_half = slide(par, inc, parts, r0, time, half)
      call change_of_place(inc, middle, void_ratio_at(inc, middle), shift + 0.5_wp*dh, driving, de_half, dp_c_half)
      call change_of_place(inc, time + h, void_ratio_at(inc, time + h), shift + dh, driving, de, dp_c)
      if (void_ratio_at(inc, middle) > parts) de_half = dparts
      if (void_ratio_at(inc, time + h) > parts) de = dparts
      turn = 0.0_wp
      if (driving%scans) turn = driving%turn
      do j = 1, DIRECTIONS
         strain = driving%d_strain%of(j, :) + (dh(j)/h)*inc%d_strain
         dr = y(j, 1:6)
         dr = change_of_slide(par, inc, parts, r0, time, half, deviator(dr)/par%p_min, strain, de_half(j), &
                              dp_c_half(j), turn(j))
         y(j, 1:6) = par%p_min*change_of_slide(par, inc, parts, r_half, middle, half, dr, strain, de(j), dp_c(j), &
                                               turn(j))
      end do
   end subroutine changes_through_hold

   !> Tangent of a held point: p' rests, the stress ratio moves. In the unit of p_atm, with engineering shear strain;
   !> against suction [-]. The state is that of the end of inc. docs/theory/integration.md section 5.4.
   pure subroutine held_tangent(par, inc, state, dsig_deps, dsig_dpc)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(state_t), intent(in) :: state
      real(wp), intent(out) :: dsig_deps(6, 6), dsig_dpc(6)
      real(wp) :: unit(6), r(6), e, follows
      integer :: j
      logical :: sliding

      e = soil_void_ratio(state)
      follows = merge(0.0_wp, 1.0_wp, state%gap > 0.0_wp)
      r = deviator(state%sigma)/par%p_min
      sliding = slides(par, inc%suction, e, state%p_c, r, follows, inc%d_strain, inc%d_pc)
      do j = 1, 6
         unit = 0.0_wp
         unit(j) = merge(1.0_wp, 0.5_wp, j <= 3)
         dsig_deps(:, j) = par%p_min*held_rate(par, inc%suction, e, state%p_c, r, follows, sliding, unit, 0.0_wp)
      end do
      unit = 0.0_wp
      dsig_dpc = par%p_min*held_rate(par, inc%suction, e, state%p_c, r, follows, sliding, unit, 1.0_wp)
   end subroutine held_tangent

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
      virgin(Y_LOG_CHI) = NO_CONTRACTION
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

   !> Change of closing_rate with the rate of p', the void ratio, the strain and the suction step [kPa]. e, de and
   !> d_strain [-], d_rate and d_pc [kPa]; e is the void ratio at the place. Derivative of docs/theory/material.md
   !> sections 6.1, 6.3.
   pure real(wp) function change_of_closing_rate(inc, openings, w, e, d_rate, de, d_strain, d_pc) result(change)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: e, d_rate, de, d_strain(6), d_pc
      real(wp) :: length

      length = inc%length
      change = w%k*length*de*bulk_slope(e) + sign(1.0_wp, inc%d_pc)*d_pc
      if (length > 0.0_wp) change = change + w%k*ddot(inc%d_strain, d_strain)/length
      change = d_rate - closing_share(openings)*change
   end function change_of_closing_rate

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

   !> Change of that stress ratio with r0, with the increment's strain, with void ratio and suction at the end and with
   !> a branch, of ln x of its turn. All [-] but dp_c [kPa]; time and h are shares of inc. Derivative of
   !> docs/theory/material.md section 6.2.
   pure function change_of_slide(par, inc, parts, r0, time, h, dr0, d_strain, de, dp_c, d_turn) result(change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: parts, r0(6), time, h, dr0(6), d_strain(6), de, dp_c, d_turn
      real(wp) :: change(6), r(6), e, p_c, stiffness, psi, dpsi

      e = min(void_ratio_at(inc, time + h), parts)
      p_c = suction_at(inc, time + h)
      stiffness = 2.0_wp*shear_modulus(par, e, par%p_min)/par%p_min*h
      r = r0 + deviator(stiffness*inc%d_strain)
      change = dr0 + deviator(stiffness*d_strain) + deviator((stiffness*shear_slope(e)*de)*inc%d_strain)
      psi = psi_of(par, inc%suction, e, p_c, par%p_min)
      if (norm(r) <= 0.0_wp) return
      if (excess(par, psi, r) <= 0.0_wp) return
      dpsi = change_of_psi(par, inc%suction, e, p_c, par%p_min, de, dp_c, 0.0_wp, d_turn)
      change = change_of_limited(par, psi, r, dpsi, change)
   end function change_of_slide

   !> True where the stress ratio of a held point is on the bounding surface and an elastic rate would leave it.
   !> docs/theory/material.md section 6.2, to 1e-12 of the surface.
   pure logical function slides(par, law, e, p_c, r, follows, d_strain, d_pc)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      real(wp), intent(in) :: e, p_c, r(6), d_strain(6), d_pc   !< [-, kPa, -, -, kPa]; e: of the soil
      real(wp), intent(in) :: follows   !< 0 where the gap takes the change of volume, otherwise 1
      real(wp) :: psi, dpsi

      slides = .false.
      if (norm(r) <= 0.0_wp) return
      psi = psi_of(par, law, e, p_c, par%p_min)
      if (excess(par, psi, r) < -ON_SURFACE) return
      dpsi = change_of_psi(par, law, e, p_c, par%p_min, -follows*(1.0_wp + e)*trace(d_strain), d_pc, 0.0_wp)
      slides = change_of_excess(par, psi, r, dpsi, held_rate(par, law, e, p_c, r, follows, .false., d_strain, &
                                                                d_pc)) > 0.0_wp
   end function slides

   !> Rate of the stress ratio of a held point for a strain rate and a suction rate, linear in both: elastic, or along
   !> the bounding surface. [-], per unit of pseudo-time. docs/theory/material.md section 6.2,
   !> docs/theory/integration.md section 5.4.
   pure function held_rate(par, law, e, p_c, r, follows, sliding, d_strain, d_pc) result(rate)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law
      logical, intent(in) :: sliding
      real(wp), intent(in) :: e, p_c, r(6), d_strain(6), d_pc   !< [-, kPa, -, -, kPa]; e: of the soil
      real(wp), intent(in) :: follows   !< 0 where the gap takes the change of volume, otherwise 1
      real(wp) :: rate(6), psi, dpsi

      rate = deviator((2.0_wp*shear_modulus(par, e, par%p_min)/par%p_min)*d_strain)
      if (.not. sliding) return
      psi = psi_of(par, law, e, p_c, par%p_min)
      dpsi = change_of_psi(par, law, e, p_c, par%p_min, -follows*(1.0_wp + e)*trace(d_strain), d_pc, 0.0_wp)
      rate = change_of_limited(par, psi, r, dpsi, rate)
   end function held_rate
end module mud_cutoff
