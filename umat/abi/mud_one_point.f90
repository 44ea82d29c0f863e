! SPDX-License-Identifier: MIT
!> One increment at one point for a C host: mud_update and mud_update_prepared of mud.h.
module mud_one_point
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_kernel, only: report_t, output_t, kernel_point, failed_report, copy_statev
   use mud_kinds, only: wp
   use mud_params, only: params_t, read_params
   use mud_prepared, only: prepared_t, find_prepared
   use mud_registry, only: NSTATV
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, ON_ARGUMENT
   use mud_to_host, only: put_real
   implicit none (type, external)
   private
   public :: mud_update, mud_update_prepared
contains
   !> One increment as kernel_point has it, see mud.h: tension positive, engineering shear, stress in the unit of p_atm.
   !> Returns the status; on any failure only the report is written.
   integer(c_int) function mud_update(props, n_props, stress0, statev0, n_statev, dstrain, suction0, dsuction, &
           tangent, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report_out) bind(c, name='mud_update')
      type(c_ptr), value :: props, stress0, statev0, dstrain, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, &
                            dsw_dpc, report_out
      integer(c_int), value :: n_props, n_statev, tangent
      real(c_double), value :: suction0, dsuction
      real(c_double), pointer, contiguous :: props_in(:)
      type(params_t) :: par
      type(mud_status_t) :: status
      type(report_t) :: report

      call check_arguments(c_associated(props), stress0, statev0, dstrain, tangent, stress1, statev1, status)
      if (status%code == MUD_OK) then
         call c_f_pointer(props, props_in, [max(n_props, 0)])
         call read_params(props_in, par, status)
      end if
      if (status%code == MUD_OK) then
         call update(par, stress0, statev0, n_statev, dstrain, suction0, dsuction, tangent, stress1, statev1, &
                     dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report)
      else
         report = failed_report(status)
      end if
      call give_report(report, report_out)
      mud_update = report%status
   end function mud_update

   !> As mud_update for a prepared material; MUD_NOT_PREPARED where the storage is none.
   integer(c_int) function mud_update_prepared(prepared, stress0, statev0, n_statev, dstrain, suction0, dsuction, &
           tangent, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report_out) &
           bind(c, name='mud_update_prepared')
      type(c_ptr), value :: prepared, stress0, statev0, dstrain, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, &
                            dsw_dpc, report_out
      integer(c_int), value :: n_statev, tangent
      real(c_double), value :: suction0, dsuction
      type(prepared_t), pointer :: material
      type(mud_status_t) :: status
      type(report_t) :: report

      call check_arguments(c_associated(prepared), stress0, statev0, dstrain, tangent, stress1, statev1, status)
      if (status%code == MUD_OK) call find_prepared(prepared, material, status)
      if (status%code == MUD_OK) then
         call update(material%par, stress0, statev0, n_statev, dstrain, suction0, dsuction, tangent, stress1, statev1, &
                     dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report)
      else
         report = failed_report(status)
      end if
      call give_report(report, report_out)
      mud_update_prepared = report%status
   end function mud_update_prepared

   !> The increment of a checked material; outputs are written on success only, those given as NULL not at all.
   subroutine update(par, stress0, statev0, n_statev, dstrain, suction0, dsuction, tangent, stress1, statev1, &
                     dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report)
      type(params_t), intent(in) :: par
      type(c_ptr), intent(in) :: stress0, statev0, dstrain, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc
      integer(c_int), intent(in) :: n_statev, tangent
      real(c_double), intent(in) :: suction0, dsuction
      type(report_t), intent(out) :: report
      real(c_double), pointer, contiguous :: stress_in(:), statev_in(:), dstrain_in(:), array(:), matrix(:, :)
      type(output_t) :: output

      call c_f_pointer(stress0, stress_in, [6])
      call c_f_pointer(statev0, statev_in, [max(n_statev, 0)])
      call c_f_pointer(dstrain, dstrain_in, [6])
      call kernel_point(par, stress_in, statev_in, dstrain_in, suction0, dsuction, tangent, output, report)
      if (report%status /= MUD_OK) return

      call c_f_pointer(stress1, array, [6])
      array = output%stress
      call c_f_pointer(statev1, array, [NSTATV])
      call copy_statev(output%statev, array)
      if (output%has_tangent) then
         if (c_associated(dsig_deps)) then
            call c_f_pointer(dsig_deps, matrix, [6, 6])
            matrix = output%dsig_deps
         end if
         if (c_associated(dsig_dpc)) then
            call c_f_pointer(dsig_dpc, array, [6])
            array = output%dsig_dpc
         end if
      end if
      if (c_associated(dsw_deps)) then
         call c_f_pointer(dsw_deps, array, [6])
         array = output%dsw_deps
      end if
      call put_real(output%dsw_dpc, dsw_dpc)
   end subroutine update

   subroutine check_arguments(material_given, stress0, statev0, dstrain, tangent, stress1, statev1, status)
      logical, intent(in) :: material_given
      type(c_ptr), intent(in) :: stress0, statev0, dstrain, stress1, statev1
      integer(c_int), intent(in) :: tangent
      type(mud_status_t), intent(out) :: status

      if (.not. (material_given .and. c_associated(stress0) .and. c_associated(statev0) .and. c_associated(dstrain) &
                 .and. c_associated(stress1) .and. c_associated(statev1))) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      else if (tangent < 0) then
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(tangent, wp))
      end if
   end subroutine check_arguments

   subroutine give_report(report, report_out)
      type(report_t), intent(in) :: report
      type(c_ptr), intent(in) :: report_out
      type(report_t), pointer :: report_to

      if (.not. c_associated(report_out)) return
      call c_f_pointer(report_out, report_to)
      report_to = report
   end subroutine give_report
end module mud_one_point
