! SPDX-License-Identifier: MIT
!> The retention curve of a prepared material for a C host: mud_saturation of mud.h, and the same of a state.
module mud_retention_point
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double
   use mud_kinds, only: wp
   use mud_prepared, only: prepared_t, find_prepared
   use mud_params, only: params_t
   use mud_registry, only: STATE_LAYOUT, S_LAYOUT, S_VOID_RATIO, S_GAP, S_SATURATION, S_SUCTION
   use mud_retention, only: saturation_t, saturation, saturation_from, turns_t
   use mud_state, only: unpack_turns, E_LOWER, E_UPPER
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_INPUT, MUD_BAD_VOID_RATIO, MUD_BAD_STATE, ON_STATEV, &
      ON_SUCTION
   use mud_tensor, only: is_finite
   use mud_to_host, only: put_real
   implicit none (type, external)
   private
   public :: c_saturation, state_saturation
contains
   !> Degree of saturation and its slopes, with hysteresis those of main drying; on an error nothing is written. Suction
   !> in the unit of p_atm, void ratio above 0 and S_w [-]; slopes [1/unit, -]. MUD_NOT_PREPARED, MUD_BAD_INPUT,
   !> MUD_BAD_VOID_RATIO. docs/theory/material.md section 2.1.
   integer(c_int) function c_saturation(prepared, suction, void_ratio, s_w, ds_dpc, ds_de) &
      bind(c, name='mud_saturation')
      type(c_ptr), value :: prepared, s_w, ds_dpc, ds_de
      real(c_double), value :: suction, void_ratio
      type(prepared_t), pointer :: material
      type(saturation_t) :: sat
      type(mud_status_t) :: status

      call find_prepared(prepared, material, status)
      c_saturation = status%code
      if (status%code /= MUD_OK) return
      c_saturation = MUD_BAD_INPUT
      if (.not. is_finite(suction)) return
      c_saturation = MUD_BAD_VOID_RATIO
      if (.not. is_finite(void_ratio)) return
      if (.not. void_ratio > 0.0_c_double) return
      c_saturation = MUD_OK
      sat = saturation(material%par%suction%retention_t, suction, void_ratio)
      call put_real(sat%s_w, s_w)
      call put_real(sat%ds_dpc, ds_dpc)
      call put_real(sat%ds_de, ds_de)
   end function c_saturation

   !> Degree of saturation of a point with a past: its STATEV tells the void ratio and, with hysteresis, from which S_w
   !> at which suction it goes on. The slope is that against void ratio [-]. MUD_BAD_INPUT, MUD_BAD_STATE.
   !> docs/theory/material.md sections 2.1, 2.1.1.
   pure subroutine state_saturation(par, statev, suction, sat, status)
      type(params_t), intent(in) :: par
      real(wp), intent(in), contiguous :: statev(:)
      real(wp), intent(in) :: suction
      type(saturation_t), intent(inout) :: sat   !< Untouched where it is refused.
      type(mud_status_t), intent(out) :: status
      integer, parameter :: READ(5) = [S_LAYOUT, S_VOID_RATIO, S_GAP, S_SATURATION, S_SUCTION]
      type(turns_t) :: turns
      integer :: i

      if (.not. is_finite(suction)) then
         status = fail(MUD_BAD_INPUT, ON_SUCTION, 0, suction, -huge(1.0_wp), huge(1.0_wp))
         return
      end if
      i = findloc(is_finite(statev(READ)), .false., dim=1)
      if (i > 0) then
         status = fail(MUD_BAD_STATE, ON_STATEV, READ(i), statev(READ(i)), -huge(1.0_wp), huge(1.0_wp))
      else if (abs(statev(S_LAYOUT) - STATE_LAYOUT) > 0.0_wp) then
         status = fail(MUD_BAD_STATE, ON_STATEV, S_LAYOUT, statev(S_LAYOUT), real(STATE_LAYOUT, wp), &
                       real(STATE_LAYOUT, wp))
      else if (statev(S_VOID_RATIO) <= E_LOWER .or. statev(S_VOID_RATIO) >= E_UPPER + statev(S_GAP)) then
         status = fail(MUD_BAD_STATE, ON_STATEV, S_VOID_RATIO, statev(S_VOID_RATIO), E_LOWER, &
                       E_UPPER + statev(S_GAP))
      else
         call unpack_turns(statev, par%options_t, turns, status)
         if (status%code == MUD_OK) call saturation_from(par%suction%retention_t, statev(S_SUCTION), &
                                                         statev(S_VOID_RATIO), statev(S_SATURATION), turns, suction, &
                                                         sat, status)
      end if
   end subroutine state_saturation
end module mud_retention_point
