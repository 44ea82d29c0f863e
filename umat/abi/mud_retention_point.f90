! SPDX-License-Identifier: MIT
!> The retention curve of a prepared material for a C host: mud_saturation and mud_state_saturation of mud.h.
module mud_retention_point
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_kinds, only: wp
   use mud_prepared, only: prepared_t, find_prepared
   use mud_params, only: params_t
   use mud_registry, only: NSTATV, S_LAYOUT, S_VOID_RATIO, S_SATURATION, S_SUCTION
   use mud_retention, only: saturation_t, saturation
   use mud_scanning, only: branch_from, clipped
   use mud_state, only: E_LOWER, E_UPPER
   use mud_status, only: mud_status_t, MUD_OK, MUD_BAD_INPUT, MUD_BAD_VOID_RATIO, MUD_BAD_NSTATV, MUD_BAD_STATE, &
      MUD_NULL_ARGUMENT
   use mud_tensor, only: is_finite
   use mud_to_host, only: put_real
   implicit none (type, external)
   private
   public :: mud_saturation, mud_state_saturation
contains
   !> Degree of saturation and its slopes, with hysteresis those of main drying; on an error nothing is written. Suction
   !> in the unit of p_atm, void ratio above 0 and S_w [-]; slopes [1/unit, -]. MUD_NOT_PREPARED, MUD_BAD_INPUT,
   !> MUD_BAD_VOID_RATIO. docs/theory/material.md section 2.1.
   integer(c_int) function mud_saturation(prepared, suction, void_ratio, s_w, ds_dpc, ds_de) &
      bind(c, name='mud_saturation')
      type(c_ptr), value :: prepared, s_w, ds_dpc, ds_de
      real(c_double), value :: suction, void_ratio
      type(prepared_t), pointer :: material
      type(saturation_t) :: sat
      type(mud_status_t) :: status

      call find_prepared(prepared, material, status)
      mud_saturation = status%code
      if (status%code /= MUD_OK) return
      mud_saturation = MUD_BAD_INPUT
      if (.not. is_finite(suction)) return
      mud_saturation = MUD_BAD_VOID_RATIO
      if (.not. is_finite(void_ratio)) return
      if (.not. void_ratio > 0.0_c_double) return
      mud_saturation = MUD_OK
      sat = saturation(material%par, suction, void_ratio)
      call put_real(sat%s_w, s_w)
      call put_real(sat%ds_dpc, ds_dpc)
      call put_real(sat%ds_de, ds_de)
   end function mud_saturation

   !> The same for a point with a past: its STATEV tells the void ratio (e_0 of the material before it began) and, with
   !> hysteresis, from which S_w at which suction it goes on. ds_dev is the slope against the volumetric strain, tension
   !> positive [-]. MUD_NOT_PREPARED, MUD_NULL_ARGUMENT, MUD_BAD_NSTATV, MUD_BAD_INPUT, MUD_BAD_STATE.
   !> docs/theory/material.md sections 2.1, 2.1.1.
   integer(c_int) function mud_state_saturation(prepared, statev, n_statev, suction, s_w, ds_dpc, ds_dev) &
      bind(c, name='mud_state_saturation')
      type(c_ptr), value :: prepared, statev, s_w, ds_dpc, ds_dev
      integer(c_int), value :: n_statev
      real(c_double), value :: suction
      type(prepared_t), pointer :: material
      real(c_double), pointer, contiguous :: state(:)
      type(saturation_t) :: sat
      type(mud_status_t) :: status
      real(wp) :: e

      call find_prepared(prepared, material, status)
      mud_state_saturation = status%code
      if (status%code /= MUD_OK) return
      mud_state_saturation = MUD_NULL_ARGUMENT
      if (.not. c_associated(statev)) return
      mud_state_saturation = MUD_BAD_NSTATV
      if (n_statev < NSTATV) return
      call c_f_pointer(statev, state, [NSTATV])
      mud_state_saturation = MUD_BAD_INPUT
      if (.not. is_finite(suction)) return
      mud_state_saturation = MUD_BAD_STATE
      if (.not. (is_finite(state(S_LAYOUT)) .and. is_finite(state(S_VOID_RATIO)))) return
      e = state(S_VOID_RATIO)
      if (abs(state(S_LAYOUT)) <= 0.0_wp .and. abs(e) <= 0.0_wp) e = material%par%e_0
      if (.not. (e > E_LOWER .and. e < E_UPPER)) return
      if (material%par%hysteresis .and. abs(state(S_LAYOUT)) > 0.0_wp) then
         mud_state_saturation = MUD_BAD_STATE
         if (.not. (is_finite(state(S_SATURATION)) .and. is_finite(state(S_SUCTION)))) return
         sat = scanned(material%par, state(S_SUCTION), e, state(S_SATURATION), suction)
      else
         sat = saturation(material%par, suction, e)
      end if
      mud_state_saturation = MUD_OK
      call put_real(sat%s_w, s_w)
      call put_real(sat%ds_dpc, ds_dpc)
      call put_real((1.0_wp + e)*sat%ds_de, ds_dev)
   end function mud_state_saturation

   !> Degree of saturation after a change of suction at constant void ratio.
   pure function scanned(par, from, e, s_w, to) result(sat)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: from, e, s_w, to   !< [kPa, -, -, kPa]
      type(saturation_t) :: sat
      real(wp) :: inside
      integer :: count

      inside = s_w
      count = 0
      call clipped(par, from, e, inside, count)
      sat = saturation(branch_from(par, to >= from, from, e, inside), to, e)
   end function scanned
end module mud_retention_point
