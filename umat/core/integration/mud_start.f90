! SPDX-License-Identifier: MIT
!> The initial state of a point, and what follows from a state: degree of saturation, state parameter, tension.
module mud_start
   use mud_kinds, only: wp
   use mud_bonding, only: suction_law_t, bonding_t, is_bonded, bonding, UNBONDED
   use mud_checks, only: check_stress
   use mud_critical_state, only: state_parameter
   use mud_cutoff, only: lifted, soil_void_ratio
   use mud_mechanism, only: forget_compression
   use mud_options, only: new_numbers
   use mud_params, only: params_t
   use mud_rates, only: stress_ratio
   use mud_retention, only: saturation_t, saturation, begin_saturation, note_saturation
   use mud_reversal, only: new_memory
   use mud_state, only: state_t, E_LOWER, E_UPPER
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_VOID_RATIO, ON_VOID_RATIO
   use mud_tensor, only: trace, is_finite
   implicit none (type, external)
   private
   public :: initial_state, finish_state, has_tension

contains
   !> State of a point that starts at a stress, a void ratio and a suction without a past. A mean stress below p_min is
   !> lifted to p_min, its stress ratio limited to the bounding surface. MUD_BAD_INPUT for stress and suction,
   !> MUD_BAD_VOID_RATIO outside (0.01, 5), MUD_BAD_STATE for the preset; the state is then of no use.
   !> docs/theory/material.md section 1.4.
   pure subroutine initial_state(par, sigma, e, p_c, state, status, preset)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), e, p_c   !< [kPa, -, kPa], compression positive
      type(state_t), intent(out) :: state
      type(mud_status_t), intent(out) :: status
      real(wp), intent(in), optional :: preset   !< S_w, see begin_saturation [-].
      type(suction_law_t) :: law
      type(saturation_t) :: sat
      real(wp) :: p, r(6)
      logical :: credible

      call check_stress(par, sigma, p_c, status)
      if (status%code /= MUD_OK) return
      credible = is_finite(e)
      if (credible) credible = e > E_LOWER .and. e < E_UPPER
      if (.not. credible) then
         status = fail(MUD_BAD_VOID_RATIO, ON_VOID_RATIO, 0, e, E_LOWER, E_UPPER)
         return
      end if
      state%e = e
      state%gap = 0.0_wp
      call new_numbers(state)
      call forget_compression(state)
      state%p_c = p_c
      state%z = 0.0_wp
      state%from_centre = 0.0_wp
      state%eps_q_total = 0.0_wp
      state%last_step = 0.0_wp
      state%open = .false.
      law = par%suction
      state%s_w = 0.0_wp
      if (present(preset)) state%s_w = preset
      call begin_saturation(par%suction%retention_t, p_c, e, state%s_w, state%turns, law%retention_t, status)
      if (status%code /= MUD_OK) return
      state%sigma = lifted(par, law, sigma, e, p_c)
      call finish_state(par, law, state, sat)
      call stress_ratio(par, state%sigma, p, r)
      state%memory = new_memory(r)
   end subroutine initial_state

   !> Saturation and state parameter of a state, and the saturation with its slopes, on the branch that it is on.
   !> S_w and psi [-]; docs/theory/material.md sections 2.1, 3.2.
   pure subroutine finish_state(par, law, state, sat)
      type(params_t), intent(in) :: par
      type(suction_law_t), intent(in) :: law   !< with the branch of the state
      type(state_t), intent(inout) :: state
      type(saturation_t), intent(out) :: sat
      type(bonding_t) :: bond

      bond = UNBONDED
      if (is_bonded(law, state%p_c)) then
         bond = bonding(law, state%p_c, state%e)
         sat = bond%sat
      else
         sat = saturation(law%retention_t, state%p_c, state%e)
      end if
      if (state%gap > 0.0_wp .and. is_bonded(law, state%p_c)) bond = bonding(law, state%p_c, soil_void_ratio(state))
      state%psi = state_parameter(par%critical, bond%f, soil_void_ratio(state), &
                                  max(trace(state%sigma)/3.0_wp, par%p_min))
      call note_saturation(law%retention_t, sat, state%s_w)
   end subroutine finish_state

   !> True if a principal stress is negative (tensile): Sylvester's criterion fails. s is an effective stress,
   !> compression positive, in any unit. docs/theory/material.md section 6.5.
   pure logical function has_tension(s)
      real(wp), intent(in) :: s(6)
      real(wp) :: minor

      minor = s(1)*s(2) - s(4)*s(4)
      has_tension = s(1) < 0.0_wp .or. minor < 0.0_wp .or. &
                    s(3)*minor + 2.0_wp*s(4)*s(5)*s(6) - s(1)*s(6)*s(6) - s(2)*s(5)*s(5) < 0.0_wp
   end function has_tension
end module mud_start
