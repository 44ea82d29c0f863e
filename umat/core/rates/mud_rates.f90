! SPDX-License-Identifier: MIT
!> Continuous rates of the zero-elastic-range model at a frozen memory. Smooth: jumps live in mud_reversal.
!>
!> The stress ratio r is the back-stress. With t = 2G d e_dev - r K_e (d eps_v - B) the loading direction n obeys
!> gamma n = t y + beta r, y = 1/(L h), found by mud_direction: docs/theory/material.md section 4.
module mud_rates
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_tensor, only: IDENTITY, ddot, trace, deviator, norm
   use mud_elastic, only: bulk_modulus, shear_modulus, swelling_slope
   use mud_bonding, only: bonding_t, UNBONDED
   use mud_critical_state, only: state_parameter, bounding_ratio, dilatancy_ratio, bounding_norm
   use mud_direction, only: find_direction
   use mud_flow, only: fabric_rate
   use mud_hardening, only: kinematic_modulus, isotropic_t, isotropic_hardening, shear_weight, NO_HARDENING
   use mud_options, only: look_at_numbers, rates_of_numbers
   use mud_rate, only: rate_t
   use mud_vector, only: NY, Y_Z, Y_Z_END
   implicit none (type, external)
   private
   public :: rate_at, conditions_t, stress_ratio, p_follows, MODE_ORDINARY, MODE_ELASTIC
   public :: evaluate_point, weight_at, hardening_at, find_drive, finish_rate, is_certain   ! for several points

   integer, parameter :: MODE_ORDINARY = 0   !< Both mechanisms act.
   integer, parameter :: MODE_ELASTIC = 1    !< L = 0: inside the elastic domain.

   !> |t| below this share of its terms is rounding. The terms are measured by the whole strain and by a stress ratio of
   !> at least SMALLEST_RATIO: where both deviators are rounding themselves, as in isotropic compression, theirs would
   !> not do.
   real(wp), parameter :: PURE_VOLUMETRIC = 1.0e-14_wp, SMALLEST_RATIO = 1.0e-3_wp

   !> The point at which a rate is asked for, without the numbers that are integrated.
   type :: conditions_t
      logical :: rests = .false.    !< The isotropic mechanism is below its memory.
      type(bonding_t) :: bond = UNBONDED   !< effect of the suction
      real(wp) :: e                 !< void ratio [-]
      real(wp) :: r_in(6)           !< memory [-]
   end type conditions_t
contains
   !> Stress ratio r = s/p' and p' >= p_min of a stress [kPa]. Compression positive; r [-], p' in the unit of sigma.
   !> docs/theory/material.md section 1.2.
   pure subroutine stress_ratio(par, sigma, p, r)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6)
      real(wp), intent(out) :: p, r(6)

      p = max(trace(sigma)/3.0_wp, par%p_min)
      r = deviator(sigma)/p
   end subroutine stress_ratio

   !> True where p' is the mean of a stress, not its lower bound. sigma' in the unit of p_atm. docs/theory/material.md
   !> section 1.2.
   pure logical function p_follows(par, sigma)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6)

      p_follows = trace(sigma) >= 3.0_wp*par%p_min
   end function p_follows

   !> Rates of stress, fabric and plastic shear for a strain rate and a suction rate. Compression positive, tensor
   !> shear. docs/theory/material.md sections 4 and 5; nothing is refused, w%no_root tells that no direction was found
   !> and the rate is elastic.
   pure subroutine rate_at(par, y, at, d_strain, d_pc, mode, w, near)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: y(NY)             !< integrated vector [kPa, -]
      type(conditions_t), intent(in) :: at
      real(wp), intent(in) :: d_strain(6)       !< strain rate [-]
      real(wp), intent(in) :: d_pc              !< suction rate [kPa]
      integer, intent(in) :: mode               !< MODE_*
      type(rate_t), intent(inout) :: w          !< All of it is set.
      type(rate_t), intent(in), optional :: near   !< A rate of nearly the same state: its direction is where to begin.
      real(wp) :: d_v, d_e(6), d_norm, weight

      d_v = trace(d_strain)
      d_e = deviator(d_strain)
      d_norm = norm(d_strain)
      call evaluate_point(par, at, y(1:6), y(Y_Z:Y_Z_END), w)
      call look_at_numbers(par, y, w%p, w%a_0, w%b_0, w%own)
      w%iso = NO_HARDENING
      if (par%isotropic .and. .not. at%rests) then
         weight = weight_at(par, w)
         if (weight > 0.0_wp) w%iso = hardening_at(par, at%e, weight, w)
      end if

      call start_direction(near, w)
      w%iso_kept = .false.
      w%iso_drive = -1.0_wp
      if (present(near)) then
         if (near%iso_active .and. par%guesses_mechanism) then
            call load(par, d_v, d_e, d_norm, d_pc, mode, .true., w)
            if (is_certain(par, d_v, d_e, w)) w%iso_drive = w%iso%a*w%d_p/w%p + w%b_rate
            if (w%iso_drive <= 0.0_wp) call start_direction(near, w)
         end if
      end if
      if (w%iso_drive <= 0.0_wp) then
         call load(par, d_v, d_e, d_norm, d_pc, mode, .false., w)
         w%swell = max(-w%l*w%d, 0.0_wp)
         w%iso_drive = w%iso%a*w%d_p/w%p + w%iso%b*d_pc
         if (w%iso_drive > 0.0_wp) then
            call load(par, d_v, d_e, d_norm, d_pc, mode, .true., w)
            w%iso_kept = w%iso%a*w%d_p/w%p + w%b_rate < 0.0_wp
            if (w%iso_kept) call load(par, d_v, d_e, d_norm, d_pc, mode, .false., w)
         end if
      end if

      call finish_rate(par, d_e, w)
      call rates_of_numbers(par, w%l, w%d, w%own, w%d_own)
   end subroutine rate_at

   !> The direction of a rate of nearly the same state is where to begin.
   pure subroutine start_direction(near, w)
      type(rate_t), intent(in), optional :: near
      type(rate_t), intent(inout) :: w

      w%loading = .false.
      if (.not. present(near)) return
      w%loading = near%loading .and. .not. near%several   ! of several roots the first counts
      w%n = near%n
   end subroutine start_direction

   !> True where the sign of the drive of the isotropic mechanism, which acts, would be the same if it did not: where
   !> the drive vanishes both have the same solution, so that between them it vanishes nowhere as long as there is one
   !> root and no cap, which depends on K_e, and x does not pass its floor between either t and the root.
   !> docs/theory/material.md section 4.5.
   pure logical function is_certain(par, d_v, d_e, w)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v, d_e(6)
      type(rate_t), intent(in) :: w
      real(wp) :: t(6)

      is_certain = .not. (w%several .or. w%no_root .or. w%capped_d .or. w%capped_h)
      if (.not. (is_certain .and. w%loading)) return
      t = 2.0_wp*w%g*d_e - (w%k*d_v)*w%r
      is_certain = (ddot(w%r_moved, w%t) < par%x_floor*w%t_norm .eqv. w%floored) .and. &
                   (ddot(w%r_moved, t) < par%x_floor*norm(t) .eqv. w%floored)
   end function is_certain

   !> Evaluates the parts of a rate that depend on the state alone.
   pure subroutine evaluate_point(par, at, sigma, z, w)
      type(params_t), intent(in) :: par
      type(conditions_t), intent(in) :: at
      real(wp), intent(in) :: sigma(6), z(6)
      type(rate_t), intent(inout) :: w

      call stress_ratio(par, sigma, w%p, w%r)
      w%r_norm = norm(w%r)
      w%r_moved = w%r - at%r_in
      w%z = z
      w%k = bulk_modulus(par%elastic, at%e, w%p)
      w%g = shear_modulus(par%elastic, at%e, w%p)
      w%bond = at%bond
      w%psi = state_parameter(par%critical, w%bond%f, at%e, w%p)
      w%m_b = bounding_ratio(par%critical, w%psi)
      w%m_d = dilatancy_ratio(par%critical, w%psi)
      w%a_0 = par%flow%a_0
      w%b_0 = kinematic_modulus(par%hardening, at%e, w%p)
   end subroutine evaluate_point

   !> Share of the isotropic mechanism that shear leaves at a point that is evaluated [-].
   pure real(wp) function weight_at(par, w) result(weight)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w

      weight = shear_weight(w%r_norm, bounding_norm(par%critical, w%r, w%r_norm, w%m_b))
   end function weight_at

   !> The isotropic mechanism there, at a void ratio [-].
   pure function hardening_at(par, e, weight, w) result(iso)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, weight
      type(rate_t), intent(in) :: w
      type(isotropic_t) :: iso

      iso = isotropic_hardening(par%hardening, par%critical, w%bond, e, w%p, swelling_slope(w%k, e, w%p), &
                                1.5_wp*w%r_norm**2, weight)
   end function hardening_at

   !> Loading index, direction and rate of p' with or without the isotropic mechanism.
   pure subroutine load(par, d_v, d_e, d_norm, d_pc, mode, active, w)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v, d_e(6), d_norm   !< volumetric and deviatoric strain rate, norm of the whole [-]
      real(wp), intent(in) :: d_pc                  !< suction rate [kPa]
      integer, intent(in) :: mode
      logical, intent(in) :: active      !< The isotropic mechanism acts.
      type(rate_t), intent(inout) :: w   !< w%loading: w%n is the direction for another choice
      real(wp) :: volumetric
      logical :: known, shears

      call find_drive(d_v, d_e, d_norm, d_pc, active, w, volumetric, shears)
      w%no_root = .false.
      w%several = .false.
      known = w%loading
      w%loading = .false.
      if (mode /= MODE_ELASTIC .and. shears) call find_direction(par, known, w)
      if (.not. w%loading) then
         w%n = 0.0_wp
         w%l = 0.0_wp
         w%d = 0.0_wp
         w%x = 0.0_wp
         w%floored = .false.
         w%capped_d = .false.
         w%capped_h = .false.
      end if
      w%d_p = volumetric - w%k_e*w%l*w%d
   end subroutine load

   !> t with or without the isotropic mechanism, and the rate of p' without shear.
   pure subroutine find_drive(d_v, d_e, d_norm, d_pc, active, w, volumetric, shears)
      real(wp), intent(in) :: d_v, d_e(6), d_norm, d_pc   !< as in load
      logical, intent(in) :: active
      type(rate_t), intent(inout) :: w
      real(wp), intent(out) :: volumetric   !< [kPa]
      logical, intent(out) :: shears        !< t is no rounding

      w%iso_active = active
      if (active) then
         w%k_e = w%k/(1.0_wp + w%k*w%iso%a/w%p)
         w%b_rate = w%iso%b*d_pc
      else
         w%k_e = w%k
         w%b_rate = 0.0_wp
      end if
      volumetric = w%k_e*(d_v - w%b_rate)
      w%t = 2.0_wp*w%g*d_e - w%r*volumetric
      w%t_norm = norm(w%t)
      shears = w%t_norm > PURE_VOLUMETRIC*(2.0_wp*w%g*d_norm + max(w%r_norm, SMALLEST_RATIO)*abs(volumetric))
   end subroutine find_drive

   !> The rates by a loading index and a direction; of p' they are known.
   pure subroutine finish_rate(par, d_e, w)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_e(6)   !< as in load
      type(rate_t), intent(inout) :: w

      w%d_sigma = 2.0_wp*w%g*(d_e - w%l*w%n) + w%d_p*IDENTITY
      w%d_z = fabric_rate(par%flow, w%l, w%d, w%n, w%z)
      w%d_eps_q = SQRT_2_3*w%l
   end subroutine finish_rate
end module mud_rates
