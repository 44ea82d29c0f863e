! SPDX-License-Identifier: MIT
!> The UMAT: Abaqus' signature, symbol umat_, every argument a C pointer that some host leaves NULL.
module mud_umat
   use, intrinsic :: iso_c_binding, only: c_ptr, c_double, c_associated, c_f_pointer
   use mud_arguments, only: check_arguments, has_past, rotates, read_rotation, turns_unread, begins_late, &
      is_green_strain, suction_t, read_suction, component_order, integer_at, SUCTION_AS_GIVEN
   use mud_kernel, only: report_t, output_t, kernel_point, rotate_statev, failed_report, TANGENT_FROM_PROPS
   use mud_kinds, only: wp
   use mud_refusals, only: place_t, refuse, remark_on_suction, remark_on_props, remark_on_start, remark_on_end, &
      remark_on_late_start, remark_on_rotation, remark_on_green_strain, save_if_asked
   use mud_params, only: params_t, read_params, options_of, completed, is_length
   use mud_registry, only: NSTATV, NSTATV_WITHOUT_HYSTERESIS, S_SUCTION
   use mud_state, only: statev_size
   use mud_status, only: mud_status_t, MUD_OK
   implicit none (type, external)
   private
   public :: umat

   integer, parameter :: ELASTIC = 1   !< Tangent kind.
contains
   !> Suction is PREDEF(1), its increment DPRED(1); STRESS is Bishop's effective stress. On failure only PNEWDT (a
   !> factor below 1), SCD (the status code) and an elastic DDSDDE are written; where PNEWDT is NULL, STRESS becomes NaN
   !> instead, so that no host goes on with the old one. See umat/README.md for PROPS, STATEV and the pitfalls. Tension
   !> positive, engineering shear, STRESS, DDSDDE and suction in the unit of p_atm. Codes of check_arguments,
   !> read_rotation, read_params and kernel_point.
   subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                   temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv_, props, nprops, coords, drot, &
                   pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc) bind(c, name='umat_')
      type(c_ptr), value :: stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, &
                            dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv_, props, nprops, &
                            coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc
      type(report_t) :: report
      type(mud_status_t) :: status
      type(place_t) :: place

      place = place_t(step=kstep, increment=kinc, element=noel, point=npt)
      call check_arguments(stress, statev, dstran, ndi, ntens, nstatv_, props, nprops, status)
      if (status%code == MUD_OK) then
         call look_at_host(statev, stran, dstran, time, dtime, drot, pnewdt, dfgrd1, place)
         call update(stress, statev, ddsdde, dstran, integer_at(ntens), integer_at(nstatv_), props, &
                     integer_at(nprops), predef, dpred, drot, pnewdt, place, report)
      else
         report = failed_report(status)
      end if
      if (report%status /= MUD_OK) call refuse(report, place, stress, ntens, pnewdt, scd)

      ! What the model does not use.
      associate (a => [c_associated(sse), c_associated(spd), c_associated(rpl), c_associated(ddsddt), &
                       c_associated(drplde), c_associated(drpldt), c_associated(temp), c_associated(dtemp), &
                       c_associated(cmname), c_associated(nshr), c_associated(coords), c_associated(celent), &
                       c_associated(dfgrd0), c_associated(layer), c_associated(kspt)])
      end associate
   end subroutine umat

   !> Says once a process what a host gives that is read otherwise than it may be meant; changes nothing.
   subroutine look_at_host(statev, stran, dstran, time, dtime, drot, pnewdt, dfgrd1, place)
      type(c_ptr), intent(in) :: statev, stran, dstran, time, dtime, drot, pnewdt, dfgrd1
      type(place_t), intent(in) :: place
      real(c_double), pointer, contiguous :: state(:), times(:)

      call c_f_pointer(statev, state, [NSTATV_WITHOUT_HYSTERESIS])
      if (begins_late(has_past(state), time, dtime, pnewdt)) then
         call c_f_pointer(time, times, [2])
         call remark_on_late_start(times(2), place)
      end if
      if (turns_unread(drot, pnewdt)) call remark_on_rotation(place)
      if (is_green_strain(stran, dstran, dfgrd1, pnewdt)) call remark_on_green_strain(place)
   end subroutine look_at_host

   !> The update itself, once the arguments are known to be there.
   subroutine update(stress, statev, ddsdde, dstran, ntens, n_statev, props, n_props, predef, dpred, drot, pnewdt, &
                     place, report)
      type(c_ptr), intent(in) :: stress, statev, ddsdde, dstran, props, predef, dpred, drot, pnewdt
      integer, intent(in) :: ntens, n_statev, n_props
      type(place_t), intent(in) :: place
      type(report_t), intent(out) :: report
      type(output_t) :: output
      real(c_double), pointer, contiguous :: stress_in(:), statev_in(:), dstran_in(:), props_in(:), tangent_out(:, :)
      real(wp) :: stress6(6), dstran6(6), statev0(NSTATV), rotation(3, 3)
      type(params_t) :: par
      type(mud_status_t) :: status
      type(suction_t) :: suction
      integer :: order(6), n

      call c_f_pointer(stress, stress_in, [ntens])
      call c_f_pointer(statev, statev_in, [n_statev])
      call c_f_pointer(dstran, dstran_in, [ntens])
      call c_f_pointer(props, props_in, [n_props])
      stress6 = 0.0_wp
      dstran6 = 0.0_wp
      stress6(1:ntens) = stress_in
      dstran6(1:ntens) = dstran_in
      order = component_order(props_in)
      stress6 = stress6(order)
      dstran6 = dstran6(order)
      n = min(n_statev, statev_size(options_of(props_in)))
      statev0(1:n) = statev_in(1:n)
      call read_rotation(drot, has_past(statev0(:n)), pnewdt, rotation, status)
      if (status%code /= MUD_OK) then
         report = failed_report(status)
         call give_elastic(props_in, stress6, statev0(:n), order(1:ntens), pnewdt, ddsdde)
         return
      end if
      if (rotates(rotation, statev0(:n))) call rotate_statev(rotation, statev0(:n))

      suction = read_suction(predef, dpred, pnewdt, statev0(:n), props_in)
      if (suction%reading /= SUCTION_AS_GIVEN) call remark_on_suction(suction, place)

      call read_params(props_in, par, status)
      if (status%code == MUD_OK) then
         call remark_on_start(par, stress6, statev0(:n), suction%start, place)
         call kernel_point(par, stress6, statev0(:n), dstran6, suction%start, suction%change, TANGENT_FROM_PROPS, &
                           output, report)
      else
         report = failed_report(status)
      end if
      if (report%status /= MUD_OK) then
         if (is_length(n_props)) then
            call save_if_asked(completed(props_in), stress6, statev0(:n), dstran6, suction%start, suction%change, &
                               place, report)
         end if
         call give_elastic(props_in, stress6, statev0(:n), order(1:ntens), pnewdt, ddsdde)
         return
      end if
      if (.not. has_past(statev0(:n))) call remark_on_props(completed(props_in), place)
      call remark_on_end(output%stress, output%statev, place)
      output%stress = output%stress(order)
      stress_in = output%stress(1:ntens)
      statev_in(1:output%n_statev) = output%statev(1:output%n_statev)
      if (output%has_tangent .and. c_associated(ddsdde)) then
         call c_f_pointer(ddsdde, tangent_out, [ntens, ntens])
         tangent_out = output%dsig_deps(order(1:ntens), order(1:ntens))
      end if
   end subroutine update

   !> The elastic DDSDDE of the state before an increment that is refused: hosts that are asked for a cut may factorise
   !> the matrix first, as CalculiX does. DDSDDE stays where PNEWDT is NULL, where PROPS ask for no tangent, and where
   !> PROPS, stress or state are so wrong that they have no stiffness. Stress and state as the update has them.
   subroutine give_elastic(props, stress, statev, order, pnewdt, ddsdde)
      real(wp), intent(in), contiguous :: props(:)
      real(wp), intent(in) :: stress(6)
      real(wp), intent(in), contiguous :: statev(:)
      integer, intent(in) :: order(:)   !< Order of the host's components, NTENS of them.
      type(c_ptr), intent(in) :: pnewdt, ddsdde
      type(output_t) :: output
      type(report_t) :: report
      real(c_double), pointer, contiguous :: tangent_out(:, :)
      type(params_t) :: par
      type(mud_status_t) :: status
      real(wp) :: still(6)

      if (.not. (c_associated(pnewdt) .and. c_associated(ddsdde))) return
      call read_params(props, par, status)
      if (status%code /= MUD_OK .or. par%tangent < ELASTIC) return
      still = 0.0_wp
      call kernel_point(par, stress, statev, still, statev(S_SUCTION), 0.0_wp, ELASTIC, output, report)
      if (report%status /= MUD_OK) return
      call c_f_pointer(ddsdde, tangent_out, [size(order), size(order)])
      tangent_out = output%dsig_deps(order, order)
   end subroutine give_elastic
end module mud_umat
