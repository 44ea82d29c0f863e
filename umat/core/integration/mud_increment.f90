! SPDX-License-Identifier: MIT
!> Rates along an increment, or along one of its phases: void ratio, suction and the strain that loads at a pseudo-time.
module mud_increment
   use mud_kinds, only: wp, NOTHING
   use mud_params, only: params_t
   use mud_state, only: counters_t
   use mud_tensor, only: ddot, trace, norm
   use mud_bonding, only: suction_law_t, is_bonded, bonding
   use mud_elastic, only: centre_modulus
   use mud_options, only: add_volume_rates
   use mud_rate, only: rate_t
   use mud_rates, only: rate_at, conditions_t, MODE_ORDINARY, MODE_ELASTIC
   use mud_elastic_domain, only: loading_direction, exit_share
   use mud_substep, only: scheme_t, SCHEMES
   use mud_vector, only: NY, Y_Z, Y_Z_END, Y_SHEAR, Y_OPTIONS
   use mud_way, only: way_t, void_ratio_on, suction_on, SHORTEST_PHASE
   implicit none (type, external)
   private
   public :: turns, add_aside, count_rate
   public :: increment_t, new_increment, take_phase, end_in_domain, end_of_pull, volume_from_centre, direction_at, &
             void_ratio_at, suction_at, rate_of, store_rate, loading_strain, has_elastic_part, since_centre, STRAIGHT

   !> A strain across the elastic domain, whose part along nu is rounding of either sign, does not load: it would look
   !> like a reversal [-].
   real(wp), parameter :: ACROSS = 1.0e-12_wp
   !> A strain this close to nu does not turn it: what that moves is rounding [-].
   real(wp), parameter :: STRAIGHT = 1.0e-10_wp

   !> An increment, and the phase of it that is being integrated.
   type, extends(way_t) :: increment_t
      real(wp) :: d_strain(6)
      real(wp) :: length            !< Norm of the strain [-].
      real(wp) :: rho               !< Radius of the elastic domain, 0: none [-].
      real(wp) :: exit              !< Where the strain leaves the elastic domain, 1: it does not [-].
      real(wp) :: from_centre(6)    !< Strain from its centre, there or, if it stays inside, at the start [-].
      logical :: straight           !< From there on all of the strain loads: it leads along nu.
      ! the phase
      real(wp) :: from, to          !< Begin and end of the phase in the increment [-].
      type(suction_law_t) :: suction   !< The law of the phase: with its branch, and bonding where that acts.
      logical :: inside             !< The phase is inside the elastic domain.
      type(scheme_t) :: scheme      !< Pair of the substep.
      logical :: rests              !< The isotropic mechanism is below its memory in the substep.
   end type increment_t
contains
   !> Rate at a vector of the integration and a pseudo-time; void ratio and suction follow from the latter exactly. time
   !> and r_in [-], y [kPa, -, ...] for sigma', z and the rest; units of w as in rate_t. Guards that act are counted,
   !> nothing is refused. docs/theory/integration.md section 1.
   pure subroutine rate_of(par, inc, time, y, r_in, mode, w, counters, near)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, y(NY), r_in(6)
      integer, intent(in) :: mode
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters
      type(rate_t), intent(in), optional :: near   !< Rate nearby, as rate_at has it.
      type(conditions_t) :: at
      real(wp) :: loading(6), aside(6), from_centre, e

      e = void_ratio_at(inc, time)
      if (inc%suction%bonds) at%bond = bonding(inc%suction, suction_at(inc, time), e)
      at%rests = inc%rests
      at%e = e
      at%r_in = r_in
      if (turns(inc, mode)) then
         call loading_strain(inc, mode, time, loading, aside, from_centre)
         call rate_at(par, y, at, loading, inc%d_pc, mode, w, near)
         call add_aside(par, e, aside, from_centre, w)
      else
         call rate_at(par, y, at, inc%d_strain, inc%d_pc, mode, w, near)
      end if
      call add_volume_rates(par, inc%d_v, y, w%d_own)
      call count_rate(par, w, counters)
   end subroutine rate_of

   !> True if not all of the strain loads.
   pure logical function turns(inc, mode)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode

      turns = has_elastic_part(inc, mode) .and. .not. (inc%straight .and. mode == MODE_ORDINARY)
   end function turns

   !> Adds to a rate at a void ratio e the elastic one of the strain that does not load; from_centre of loading_strain.
   pure subroutine add_aside(par, e, aside, from_centre, w)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, aside(6), from_centre
      type(rate_t), intent(inout) :: w
      real(wp) :: g, volume

      g = 2.0_wp*centre_modulus(par%elastic, e, w%k, from_centre)
      volume = trace(aside)
      w%d_p = w%d_p + w%k*volume
      w%d_sigma = w%d_sigma + g*aside
      w%d_sigma(1:3) = w%d_sigma(1:3) + (w%k - g/3.0_wp)*volume
   end subroutine add_aside

   !> Counts a rate and the guards that act in it.
   pure subroutine count_rate(par, w, counters)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(counters_t), intent(inout) :: counters

      counters%rate = counters%rate + 1
      if (w%floored .and. par%floored) counters%floor = counters%floor + 1
      if (w%capped_d) counters%cap_d = counters%cap_d + 1
      if (w%capped_h) counters%cap_h = counters%cap_h + 1
      if (w%iso_kept) counters%iso_kept = counters%iso_kept + 1
      if (w%no_root) counters%no_root = counters%no_root + 1
   end subroutine count_rate

   !> A rate as one of the integrated vector. sigma' [kPa], the others [-], per unit of pseudo-time.
   pure subroutine store_rate(w, dy)
      type(rate_t), intent(in) :: w
      real(wp), intent(out) :: dy(NY)

      dy(1:6) = w%d_sigma
      dy(Y_Z:Y_Z_END) = w%d_z
      dy(Y_SHEAR) = w%d_eps_q
      dy(Y_OPTIONS:) = w%d_own
   end subroutine store_rate

   !> True if a part of the strain is elastic: all of it inside the elastic domain, some where that is pulled.
   !> docs/theory/memory-rules.md section 4.1.
   pure logical function has_elastic_part(inc, mode)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode

      has_elastic_part = mode == MODE_ELASTIC .or. (inc%rho > 0.0_wp .and. .not. inc%inside .and. mode == MODE_ORDINARY)
   end function has_elastic_part

   !> The part of the strain rate that loads, along nu, and the elastic rest; the volumetric strain from the centre of
   !> the domain. All [-]; docs/theory/memory-rules.md section 4.1.
   pure subroutine loading_strain(inc, mode, time, loading, aside, from_centre)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      real(wp), intent(in) :: time
      real(wp), intent(out) :: loading(6), aside(6), from_centre
      real(wp) :: nu(6), along

      loading = 0.0_wp
      if (mode == MODE_ELASTIC) then
         aside = inc%d_strain
         from_centre = volume_from_centre(inc, time)
      else
         nu = direction_at(inc, time)
         along = ddot(nu, inc%d_strain)
         if (along > ACROSS*inc%length) loading = along*nu
         aside = inc%d_strain - loading
         from_centre = inc%rho*trace(nu)
      end if
   end subroutine loading_strain

   !> Share of the strain to add to inc%from_centre at a pseudo-time inside the domain [-].
   pure real(wp) function since_centre(inc, time)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time

      since_centre = time
      if (inc%exit < 1.0_wp) since_centre = time - inc%exit
   end function since_centre

   !> Volumetric strain from the centre at a pseudo-time inside the domain [-]. docs/theory/memory-rules.md section 4.3.
   pure real(wp) function volume_from_centre(inc, time)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time

      volume_from_centre = trace(inc%from_centre) + since_centre(inc, time)*inc%d_v
   end function volume_from_centre

   !> An increment of a point with void ratio e, suction p_c and a strain from_centre of the elastic domain. e and
   !> strain [-], tensor shear, compression positive; p_c and d_pc in the unit of p_atm. A change below NOTHING is none.
   !> The phase is not set, nothing is checked. docs/theory/integration.md section 1, docs/theory/memory-rules.md 4.2.
   pure subroutine new_increment(par, e, p_c, from_centre, strain, suction_step, inc)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, p_c, from_centre(6), strain(6), suction_step
      type(increment_t), intent(out) :: inc
      real(wp) :: d_strain(6), length

      d_strain = without_nothing(strain)
      inc%d_strain = d_strain
      inc%d_pc = without_nothing(suction_step)
      inc%p_c0 = p_c
      inc%e0 = e
      inc%d_v = trace(d_strain)
      inc%length = norm(d_strain)
      inc%scheme = SCHEMES(max(par%scheme, 1))   ! automatic: chosen for every attempt
      inc%rests = .false.
      inc%suction = par%suction
      inc%rho = par%rho_e
      inc%exit = 1.0_wp
      inc%from_centre = 0.0_wp
      inc%straight = .false.
      if (inc%rho <= 0.0_wp) return
      inc%from_centre = without_nothing(from_centre)
      length = norm(inc%from_centre)
      if (length > inc%rho) inc%from_centre = (inc%rho/length)*inc%from_centre
      inc%exit = exit_share(inc%rho, inc%from_centre, d_strain)
      if (inc%exit < SHORTEST_PHASE) inc%exit = 0.0_wp
      if (1.0_wp - inc%exit < SHORTEST_PHASE) then
         inc%exit = 1.0_wp
      else
         inc%from_centre = inc%from_centre + inc%exit*d_strain
         inc%from_centre = (inc%rho/norm(inc%from_centre))*inc%from_centre
         ! twice the sine of half the angle
         inc%straight = norm(inc%from_centre/inc%rho - d_strain/inc%length) < STRAIGHT
      end if
   end subroutine new_increment

   !> A number, or 0 where its square would not be one [-].
   pure elemental real(wp) function without_nothing(x)
      real(wp), intent(in) :: x

      without_nothing = merge(x, 0.0_wp, abs(x) > NOTHING)
   end function without_nothing

   !> The phase of an increment between two pseudo-times [-]: nothing changes its kind in between.
   pure subroutine take_phase(par, from, to, inc)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: from, to
      type(increment_t), intent(inout) :: inc

      inc%from = from
      inc%to = to
      inc%inside = inc%rho > 0.0_wp .and. 0.5_wp*(from + to) < inc%exit
      inc%suction%bonds = is_bonded(par%suction, suction_at(inc, 0.5_wp*(from + to)))
   end subroutine take_phase

   !> Strain from the centre of the elastic domain at the end of an increment [-]. docs/theory/memory-rules.md section
   !> 4.2.
   pure function end_in_domain(inc) result(from_centre)
      type(increment_t), intent(in) :: inc
      real(wp) :: from_centre(6)

      if (inc%exit < 1.0_wp) then
         from_centre = end_of_pull(inc)
      else
         from_centre = inc%from_centre + inc%d_strain
      end if
   end function end_in_domain

   !> The strain there where the increment leaves the domain, which it pulls along [-].
   pure function end_of_pull(inc) result(from_centre)
      type(increment_t), intent(in) :: inc
      real(wp) :: from_centre(6)

      from_centre = inc%rho*direction_at(inc, 1.0_wp)
   end function end_of_pull

   !> nu at a pseudo-time beyond the exit [-]. docs/theory/memory-rules.md section 4.2.
   pure function direction_at(inc, time) result(nu)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time
      real(wp) :: nu(6)

      nu = loading_direction(inc%rho, inc%from_centre, inc%d_strain, time - inc%exit)
   end function direction_at

   !> Void ratio at a pseudo-time. time is a share of inc, the result [-].
   pure real(wp) function void_ratio_at(inc, time) result(e)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time

      e = void_ratio_on(inc%way_t, time)
   end function void_ratio_at

   !> Suction at a pseudo-time [kPa]. time is a share of inc [-].
   pure real(wp) function suction_at(inc, time) result(p_c)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time

      p_c = suction_on(inc%way_t, time)
   end function suction_at
end module mud_increment
