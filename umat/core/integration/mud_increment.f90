!> One trial substep: rates along an increment, the scheme's stages, the error, the substep held by the tension cut-off.
module mud_increment
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_state, only: counters_t
   use mud_tensor, only: IDENTITY, ddot, trace, deviator, norm
   use mud_elastic, only: shear_modulus
   use mud_bonding, only: bonding_t, bonding, UNBONDED
   use mud_critical_state, only: critical_void_ratio, bounding_ratio
   use mud_rates, only: rate_t, rate_at, bounding_norm, MODE_ORDINARY, MODE_ELASTIC
   use mud_nucleus, only: loading_direction, change_of_direction
   use mud_substep, only: scheme_t, MAX_STAGES, stage_point, solution, error_vector
   implicit none (type, external)
   private
   public :: increment_t, trial_t, void_ratio_at, suction_at, rate_of, take_step, error_norm, limited, state_parameter
   public :: loading_strain, change_of_loading_strain, has_aside, beyond_bounding, NY, MODE_HELD, MODE_NUCLEUS

   integer, parameter :: MODE_HELD = 2   !< A substep held at p_min by the tension cut-off; see MODE_* of mud_rates.
   integer, parameter :: MODE_NUCLEUS = 3   !< A substep inside the elastic nucleus: MODE_ELASTIC, memory at rest.
   integer, parameter :: NY = 13         !< Length of the integrated vector: sigma'(6), z(6), plastic shear.
   !> A strain across the nucleus, whose part along nu is rounding of either sign, does not load: it would look like a
   !> reversal [-].
   real(wp), parameter :: ACROSS = 1.0e-12_wp
   real(wp), parameter :: PLASTIC_SHEAR_SCALE = 0.01_wp   !< Of the error norm [-].

   !> What stays the same through an update; with an elastic nucleus, through one of its phases.
   type :: increment_t
      real(wp) :: d_strain(6), d_pc, p_c0, e0, d_v
      logical :: bonded             !< Bonding is on and there is suction: decided once.
      logical :: inside             !< The phase inside the elastic nucleus.
      real(wp) :: rho               !< Radius of the nucleus, 0: none [-].
      real(wp) :: from, length      !< The phase's place in the update [-].
      real(wp) :: nucleus(6)        !< Strain from its centre at the start [-].
      type(scheme_t) :: scheme
   end type increment_t

   !> A trial substep from one point.
   type :: trial_t
      real(wp) :: rates(NY, MAX_STAGES)
      real(wp) :: y0(NY), y(NY)
      type(rate_t) :: w(MAX_STAGES) !< What each stage's rate went through; the first is that of the memory as it is.
      integer :: mode
      logical :: pressed            !< Inside the nucleus the bounding surface was met: ordinary rates from there on.
      real(wp) :: r_in(6)
      real(wp) :: time              !< Pseudo-time of y0 [-].
      real(wp) :: held_error        !< Error of a held substep's stress ratio [-].
   end type trial_t
contains
   !> Rate at a vector of the integration and a pseudo-time; void ratio and suction follow from the latter exactly.
   pure subroutine rate_of(par, inc, time, y, r_in, mode, w, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, y(NY), r_in(6)
      integer, intent(in) :: mode
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters
      real(wp) :: loading(6), aside(6)

      if (has_aside(inc, mode)) then
         call loading_strain(inc, mode, time, loading, aside)
         call rate_at(par, inc%bonded, y(1:6), void_ratio_at(inc, time), suction_at(inc, time), y(7:12), r_in, &
                      loading, inc%d_pc, merge(MODE_ELASTIC, mode, mode == MODE_NUCLEUS), w)
         w%d_p = w%d_p + w%k*trace(aside)
         w%d_sigma = w%d_sigma + 2.0_wp*w%g*deviator(aside) + (w%k*trace(aside))*IDENTITY
      else
         call rate_at(par, inc%bonded, y(1:6), void_ratio_at(inc, time), suction_at(inc, time), y(7:12), r_in, &
                      inc%d_strain, inc%d_pc, mode, w)
      end if
      counters%rate = counters%rate + 1
      if (w%floored .and. par%floored) counters%floor = counters%floor + 1
      if (w%capped_d) counters%cap_d = counters%cap_d + 1
      if (w%capped_h) counters%cap_h = counters%cap_h + 1
      if (w%iso_kept) counters%iso_kept = counters%iso_kept + 1
      if (w%no_root) counters%no_root = counters%no_root + 1
   end subroutine rate_of

   !> True if a part of the strain is elastic: all of it inside the nucleus, some where the nucleus is pulled along.
   pure logical function has_aside(inc, mode)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode

      has_aside = mode == MODE_NUCLEUS .or. (inc%rho > 0.0_wp .and. .not. inc%inside .and. mode == MODE_ORDINARY)
   end function has_aside

   !> The part of the strain rate that loads, along nu, and the elastic rest.
   pure subroutine loading_strain(inc, mode, time, loading, aside)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      real(wp), intent(in) :: time
      real(wp), intent(out) :: loading(6), aside(6)
      real(wp) :: nu(6), along

      loading = 0.0_wp
      if (mode /= MODE_NUCLEUS) then
         nu = loading_direction(inc%rho, inc%nucleus, inc%d_strain, time)
         along = ddot(nu, inc%d_strain)
         if (along > ACROSS*norm(inc%d_strain)) loading = along*nu
      end if
      aside = inc%d_strain - loading
   end subroutine loading_strain

   !> Change of both parts with the strain rate and the nucleus at the start.
   pure subroutine change_of_loading_strain(inc, mode, time, strain_change, nucleus_change, loading, aside)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      real(wp), intent(in) :: time, strain_change(6), nucleus_change(6)
      real(wp), intent(out) :: loading(6), aside(6)
      real(wp) :: nu(6), change(6)

      loading = 0.0_wp
      if (mode /= MODE_NUCLEUS) then
         nu = loading_direction(inc%rho, inc%nucleus, inc%d_strain, time)
         change = change_of_direction(inc%rho, inc%nucleus, inc%d_strain, time, nucleus_change, strain_change)
         loading = (ddot(change, inc%d_strain) + ddot(nu, strain_change))*nu + ddot(nu, inc%d_strain)*change
      end if
      aside = strain_change - loading
   end subroutine change_of_loading_strain

   !> |r| over that of the bounding surface, minus 1.
   pure real(wp) function beyond_bounding(par, inc, time, p, r)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, p, r(6)
      real(wp) :: r_norm, psi

      r_norm = norm(r)
      psi = state_parameter(par, inc%bonded, void_ratio_at(inc, time), suction_at(inc, time), p)
      beyond_bounding = r_norm/bounding_norm(par, r, r_norm, bounding_ratio(par, psi)) - 1.0_wp
   end function beyond_bounding

   !> One trial substep from the first rate that the trial holds.
   pure subroutine take_step(par, inc, h, trial, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      real(wp) :: y(NY)
      integer :: i

      if (trial%mode == MODE_HELD) then
         call hold(par, inc, h, trial)
         return
      end if
      call store_rate(trial%w(1), trial%rates(:, 1))
      do i = 2, inc%scheme%stages
         call stage_point(inc%scheme, i, trial%y0, trial%rates, h, y)
         call rate_of(par, inc, trial%time + inc%scheme%node(i)*h, y, trial%r_in, trial%mode, trial%w(i), &
                      counters)
         call store_rate(trial%w(i), trial%rates(:, i))
      end do
      call solution(inc%scheme, trial%y0, trial%rates, h, trial%y)
   end subroutine take_step

   !> A substep at p_min: p', fabric, memory and plastic shear stay. The stress ratio follows the strain elastically,
   !> but not beyond the bounding surface, along which it slides (two half steps, the error against the whole one). Were
   !> it frozen, an undrained path that gets here on its contractive side could never leave, in whatever direction it is
   !> sheared.
   pure subroutine hold(par, inc, h, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: h
      type(trial_t), intent(inout) :: trial
      real(wp) :: whole(6), half(6)

      half = deviator(trial%y0(1:6))/par%p_min
      whole = slide(par, inc, half, trial%time, h)
      half = slide(par, inc, half, trial%time, 0.5_wp*h)
      half = slide(par, inc, half, trial%time + 0.5_wp*h, 0.5_wp*h)
      trial%y = trial%y0
      trial%y(1:6) = par%p_min*(half + IDENTITY)
      trial%held_error = norm(half - whole)
   end subroutine hold

   !> Stress ratio after an elastic step and back to the bounding surface.
   pure function slide(par, inc, r0, time, h) result(r)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: r0(6), time, h
      real(wp) :: r(6), e

      e = void_ratio_at(inc, time + h)
      r = r0 + deviator((2.0_wp*shear_modulus(par, e, par%p_min)/par%p_min*h)*inc%d_strain)
      r = limited(par, inc%bonded, e, suction_at(inc, time + h), par%p_min, r)
   end function slide

   pure subroutine store_rate(w, dy)
      type(rate_t), intent(in) :: w
      real(wp), intent(out) :: dy(NY)

      dy(1:6) = w%d_sigma
      dy(7:12) = w%d_z
      dy(13) = w%d_eps_q
   end subroutine store_rate

   !> Relative error of a trial substep; the void ratio is exact.
   pure real(wp) function error_norm(par, scheme, trial, h) result(error)
      type(params_t), intent(in) :: par
      type(scheme_t), intent(in) :: scheme
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      real(wp) :: delta(NY)

      if (trial%mode == MODE_HELD) then
         error = trial%held_error
         return
      end if
      call error_vector(scheme, trial%rates, h, delta)
      error = max(norm(delta(1:6))/max(norm(trial%y(1:6)), par%p_min), norm(delta(7:12))/par%z_max, &
                  abs(delta(13))/PLASTIC_SHEAR_SCALE)
   end function error_norm

   !> Void ratio at a pseudo-time: 1 + e falls as exp(-eps_v), exactly.
   pure real(wp) function void_ratio_at(inc, time) result(e)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time

      e = inc%e0
      if (abs(inc%d_v) > 0.0_wp) e = (1.0_wp + e)*exp(-inc%d_v*time) - 1.0_wp
   end function void_ratio_at

   !> Suction at a pseudo-time [kPa].
   pure real(wp) function suction_at(inc, time) result(p_c)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time

      p_c = inc%p_c0 + time*inc%d_pc
   end function suction_at

   !> A stress ratio, shortened to the bounding surface where it is beyond.
   pure function limited(par, bonded, e, p_c, p, r) result(r_limited)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      real(wp), intent(in) :: e, p_c, p, r(6)
      real(wp) :: r_limited(6), r_norm, limit

      r_limited = r
      r_norm = norm(r)
      if (r_norm <= 0.0_wp) return
      limit = bounding_norm(par, r, r_norm, bounding_ratio(par, state_parameter(par, bonded, e, p_c, p)))
      if (r_norm > limit) r_limited = (limit/r_norm)*r
   end function limited

   pure real(wp) function state_parameter(par, bonded, e, p_c, p) result(psi)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      real(wp), intent(in) :: e, p_c, p
      type(bonding_t) :: bond

      bond = UNBONDED
      if (bonded) bond = bonding(par, p_c, e)
      psi = e - critical_void_ratio(par, bond%f, p)
   end function state_parameter
end module mud_increment
