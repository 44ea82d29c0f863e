!> The retention curve of a prepared material for a C host: mud_saturation of mud.h.
module mud_retention_point
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double
   use mud_prepared, only: prepared_t, find_prepared
   use mud_retention, only: saturation_t, saturation
   use mud_status, only: mud_status_t, MUD_OK, MUD_BAD_INPUT, MUD_BAD_VOID_RATIO
   use mud_tensor, only: is_finite
   use mud_to_host, only: put_real
   implicit none (type, external)
   private
   public :: mud_saturation
contains
   !> Degree of saturation and its slopes; on an error nothing is written.
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
end module mud_retention_point
