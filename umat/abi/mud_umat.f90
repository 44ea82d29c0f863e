! SPDX-License-Identifier: MIT
!> The UMAT: Abaqus' signature, symbol umat_, every argument a C pointer that some host leaves NULL.
module mud_umat
   use, intrinsic :: iso_c_binding, only: c_ptr, c_double, c_associated, c_f_pointer
   use mud_arguments, only: check_arguments, rotates, read_rotation, turns_unread, begins_late, &
      is_green_strain, suction_t, read_suction, component_order, integer_at, SUCTION_AS_GIVEN
   use mud_host_increment, only: never_began
   use mud_kernel, only: report_t, output_t, kernel_point, rotate_statev, failed_report, TANGENT_FROM_PROPS
   use mud_kinds, only: wp
   use mud_refusals, only: place_t, refuse, begin_at, remark_on_suction, remark_on_end, &
      remark_on_late_start, remark_on_rotation, remark_on_green_strain, save_if_asked
   use mud_params, only: params_t, read_params, options_of, completed, is_length
   use mud_registry, only: NSTATV, NSTATV_BASE, S_SUCTION
   use mud_state, only: statev_size
   use mud_status, only: mud_status_t, MUD_OK
   implicit none (type, external)
   private
   public :: umat

   integer, parameter :: ELASTIC = 1   !< Tangent kind.

   !> A call as the kernel takes it.
   type :: call_t
      real(wp), pointer, contiguous :: props(:) => null()   !< The host's; null before they are there.
      logical :: is_read = .false.                          !< All of it is known but for par.
      real(wp) :: stress(6), dstran(6)                      !< in the order of the kernel
      real(wp) :: statev(NSTATV)
      integer :: n, ntens, order(6)                         !< n: so many numbers of statev
      type(suction_t) :: suction
      type(params_t) :: par
   end type call_t
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
      type(call_t) :: given
      type(output_t) :: output
      type(report_t) :: report
      type(mud_status_t) :: status
      type(place_t) :: place

      place = place_t(step=kstep, increment=kinc, element=noel, point=npt)
      call check_arguments(stress, statev, dstran, ndi, ntens, nstatv_, props, nprops, status)
      if (status%code == MUD_OK) then
         call look_at_host(statev, stran, dstran, time, dtime, drot, pnewdt, dfgrd1, place)
         call read_call(stress, statev, dstran, integer_at(ntens), integer_at(nstatv_), props, integer_at(nprops), &
                        predef, dpred, drot, pnewdt, place, given, status)
      end if
      report = failed_report(status)
      if (report%status == MUD_OK) then
         if (never_began(given%statev)) call begin_at(given%par, completed(given%props), given%stress, &
                                                      given%suction%start, given%statev(:given%n), place, report)
      end if
      if (report%status == MUD_OK) &
         call kernel_point(given%par, given%stress, given%statev(:given%n), given%dstran, given%suction%start, &
                           given%suction%change, TANGENT_FROM_PROPS, output, report)
      if (report%status == MUD_OK) then
         call give_results(given, output, stress, statev, ddsdde, place)
      else
         if (associated(given%props)) call give_elastic(given, pnewdt, ddsdde, place, report)
         call refuse(report, place, stress, ntens, pnewdt, scd)
      end if

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

      call c_f_pointer(statev, state, [NSTATV_BASE])
      if (begins_late(.not. never_began(state), time, dtime, pnewdt)) then
         call c_f_pointer(time, times, [2])
         call remark_on_late_start(times(2), place)
      end if
      if (turns_unread(drot, pnewdt)) call remark_on_rotation(place)
      if (is_green_strain(stran, dstran, dfgrd1, pnewdt)) call remark_on_green_strain(place)
   end subroutine look_at_host

   !> Reads a call whose arguments are known to be there. Codes of read_rotation and read_params.
   subroutine read_call(stress, statev, dstran, ntens, n_statev, props, n_props, predef, dpred, drot, pnewdt, place, &
                        given, status)
      type(c_ptr), intent(in) :: stress, statev, dstran, props, predef, dpred, drot, pnewdt
      integer, intent(in) :: ntens, n_statev, n_props
      type(place_t), intent(in) :: place
      type(call_t), intent(inout) :: given
      type(mud_status_t), intent(out) :: status
      real(c_double), pointer, contiguous :: stress_in(:), statev_in(:), dstran_in(:)
      real(wp) :: rotation(3, 3)

      call c_f_pointer(stress, stress_in, [ntens])
      call c_f_pointer(statev, statev_in, [n_statev])
      call c_f_pointer(dstran, dstran_in, [ntens])
      call c_f_pointer(props, given%props, [n_props])
      given%ntens = ntens
      given%stress = 0.0_wp
      given%dstran = 0.0_wp
      given%stress(1:ntens) = stress_in
      given%dstran(1:ntens) = dstran_in
      given%order = component_order(given%props)
      given%stress = given%stress(given%order)
      given%dstran = given%dstran(given%order)
      given%n = min(n_statev, statev_size(options_of(given%props)))
      associate (state => given%statev(:given%n))
         state = statev_in(1:given%n)
         call read_rotation(drot, .not. never_began(state), pnewdt, rotation, status)
         if (status%code /= MUD_OK) return
         if (rotates(rotation, state)) call rotate_statev(rotation, state)
         given%suction = read_suction(predef, dpred, pnewdt, state, given%props)
         if (given%suction%reading /= SUCTION_AS_GIVEN) call remark_on_suction(given%suction, place)
         given%is_read = .true.
         call read_params(given%props, given%par, status)
      end associate
   end subroutine read_call

   !> Gives the results of an update back to the host.
   subroutine give_results(given, output, stress, statev, ddsdde, place)
      type(call_t), intent(in) :: given
      type(output_t), intent(inout) :: output   !< The stress gets the order of the host.
      type(c_ptr), intent(in) :: stress, statev, ddsdde
      type(place_t), intent(in) :: place
      real(c_double), pointer, contiguous :: stress_out(:), statev_out(:), tangent_out(:, :)

      call c_f_pointer(stress, stress_out, [given%ntens])
      call c_f_pointer(statev, statev_out, [output%n_statev])
      call remark_on_end(output%stress, output%statev, place)
      output%stress = output%stress(given%order)
      stress_out = output%stress(1:given%ntens)
      statev_out = output%statev(1:output%n_statev)
      if (.not. (output%has_tangent .and. c_associated(ddsdde))) return
      call c_f_pointer(ddsdde, tangent_out, [given%ntens, given%ntens])
      associate (order => given%order(1:given%ntens))
         tangent_out = output%dsig_deps(order, order)
      end associate
   end subroutine give_results

   !> An increment that is refused: it is saved where that is asked for, and DDSDDE is the elastic one of the state
   !> before. Hosts that are asked for a cut may factorise the matrix first, as CalculiX does. DDSDDE stays where PNEWDT
   !> is NULL, where PROPS ask for no tangent, and where PROPS, stress or state are so wrong that it has no stiffness.
   subroutine give_elastic(given, pnewdt, ddsdde, place, report)
      type(call_t), intent(inout) :: given
      type(c_ptr), intent(in) :: pnewdt, ddsdde
      type(place_t), intent(in) :: place
      type(report_t), intent(in) :: report
      type(output_t) :: output
      type(report_t) :: answer
      real(c_double), pointer, contiguous :: tangent_out(:, :)
      type(mud_status_t) :: status
      real(wp) :: still(6)

      associate (state => given%statev(:given%n))
         if (given%is_read .and. is_length(size(given%props))) &
            call save_if_asked(completed(given%props), given%stress, state, given%dstran, given%suction%start, &
                               given%suction%change, place, report)
         if (.not. (c_associated(pnewdt) .and. c_associated(ddsdde))) return
         call read_params(given%props, given%par, status)
         if (status%code /= MUD_OK .or. given%par%tangent < ELASTIC) return
         still = 0.0_wp
         call kernel_point(given%par, given%stress, state, still, state(S_SUCTION), 0.0_wp, ELASTIC, output, answer)
      end associate
      if (answer%status /= MUD_OK) return
      call c_f_pointer(ddsdde, tangent_out, [given%ntens, given%ntens])
      associate (order => given%order(1:given%ntens))
         tangent_out = output%dsig_deps(order, order)
      end associate
   end subroutine give_elastic
end module mud_umat
