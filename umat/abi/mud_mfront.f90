! SPDX-License-Identifier: MIT
!> The generic interface of MFront, API version 1: the functions that MGIS looks up as BEHAVIOUR_HYPOTHESIS. Their
!> description (names, types, counts) is written by umat/tables/mud_write_tables.f90. Sign and order of components are
!> those of MUD; symmetric tensors are in Mandel's notation (shear times square root of 2), matrices row by row.
module mud_mfront
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_arguments, only: has_past
   use mud_kernel, only: report_t, output_t, kernel_point, kernel_tangent, failed_report
   use mud_kinds, only: wp
   use mud_messages, only: report_text
   use mud_params, only: params_t, read_params, completed
   use mud_refusals, only: place_t, say_refusal, remark_on_props, remark_on_start, remark_on_end, save_if_asked
   use mud_registry, only: NPROPS_BASE, NSTATV => NSTATV_BASE, &
      S_VOID_RATIO, S_SATURATION, S_SUCTION
   use mud_retention, only: saturation_t, saturation
   use mud_state, only: E_LOWER, E_UPPER
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_STATE, MUD_BAD_INPUT, MUD_BAD_OPTION, &
      ON_ARGUMENT, ON_STATEV, ON_SUCTION
   use mud_tensor, only: is_finite
   use mud_to_host, only: put
   use mud_total, only: effective_stress, total_stress, total_blocks
   implicit none (type, external)
   private
   public :: mechanical_3d, mechanical_plane, mechanical_axial, mechanical_generalised, mechanical_1d, unsaturated_3d, &
             unsaturated_plane, unsaturated_axial, unsaturated_generalised, unsaturated_1d

   integer(c_int), parameter :: FAILED = -1, RELIABLE = 1     !< Outcomes that MGIS understands.
   integer(c_int), parameter :: MESSAGE_ROOM = 512            !< Characters behind error_message.
   real(wp), parameter :: SHEAR = sqrt(2.0_wp)                !< Mandel's factor.
   real(wp), parameter :: MANDEL(6) = [1.0_wp, 1.0_wp, 1.0_wp, SHEAR, SHEAR, SHEAR]
   real(wp), parameter :: WITH_SPEED_OF_SOUND = 50.0_wp       !< K(1) above it asks for the speed of sound too.
   character(*), parameter :: DOOR = 'MFront'                 !< Name of the interface in sentences.
   integer, parameter :: NONE = 0, ELASTIC = 1, CONTINUUM = 2, CONSISTENT = 3
   !> S_w of a state may differ from that of its suction by this, what a text of seven digits leaves [-].
   real(wp), parameter :: SAME_SATURATION = 1.0e-6_wp

   !> A state of a point as MGIS hands it over, in its order.
   type, bind(c) :: state_view_t
      type(c_ptr) :: gradients, forces, mass_density, material_properties, internal_state_variables, stored_energy, &
                     dissipated_energy, external_state_variables
   end type state_view_t

   !> A point.
   type, bind(c) :: view_t
      type(c_ptr) :: error_message
      real(c_double) :: dt
      type(c_ptr) :: k, rdt, speed_of_sound
      type(state_view_t) :: s0, s1
   end type view_t

   !> Arrays of a point.
   type :: point_t
      real(c_double), pointer, contiguous :: gradient0(:), gradient1(:), force0(:), force1(:), props(:), state0(:), &
                                             state1(:), k(:)
   end type point_t
contains
   !> Effective stress, 3D: one answer to K(1), strain to stress in Mandel's notation, stress in the unit of p_atm.
   !> Returns 1, or -1 with the message and the factor on the time step alone written.
   integer(c_int) function mechanical_3d(view) bind(c, name='MUD_Tridimensional')
      type(view_t), intent(inout) :: view

      mechanical_3d = integrate(view, 6, .false.)
   end function mechanical_3d

   !> Integrates a point in plane strain as mechanical_3d does: four components 11, 22, 33, 12.
   integer(c_int) function mechanical_plane(view) bind(c, name='MUD_PlaneStrain')
      type(view_t), intent(inout) :: view

      mechanical_plane = integrate(view, 4, .false.)
   end function mechanical_plane

   !> Integrates a point in axial symmetry as mechanical_3d does: four components.
   integer(c_int) function mechanical_axial(view) bind(c, name='MUD_Axisymmetrical')
      type(view_t), intent(inout) :: view

      mechanical_axial = integrate(view, 4, .false.)
   end function mechanical_axial

   !> Integrates a point in generalised plane strain as mechanical_3d does: four components.
   integer(c_int) function mechanical_generalised(view) bind(c, name='MUD_GeneralisedPlaneStrain')
      type(view_t), intent(inout) :: view

      mechanical_generalised = integrate(view, 4, .false.)
   end function mechanical_generalised

   !> Integrates a point in axial symmetry in one dimension as mechanical_3d does: three direct components.
   integer(c_int) function mechanical_1d(view) bind(c, name='MUD_AxisymmetricalGeneralisedPlaneStrain')
      type(view_t), intent(inout) :: view

      mechanical_1d = integrate(view, 3, .false.)
   end function mechanical_1d

   !> Total stress (air pressure 0, unit of p_atm) and S_w [-] from strain and suction, 3D; returns as mechanical_3d.
   !> Stress by docs/theory/material.md section 1.1.
   integer(c_int) function unsaturated_3d(view) bind(c, name='MUD_StressSaturation_Tridimensional')
      type(view_t), intent(inout) :: view

      unsaturated_3d = integrate(view, 6, .true.)
   end function unsaturated_3d

   !> Integrates a point in plane strain as unsaturated_3d does: four components 11, 22, 33, 12.
   integer(c_int) function unsaturated_plane(view) bind(c, name='MUD_StressSaturation_PlaneStrain')
      type(view_t), intent(inout) :: view

      unsaturated_plane = integrate(view, 4, .true.)
   end function unsaturated_plane

   !> Integrates a point in axial symmetry as unsaturated_3d does: four components.
   integer(c_int) function unsaturated_axial(view) bind(c, name='MUD_StressSaturation_Axisymmetrical')
      type(view_t), intent(inout) :: view

      unsaturated_axial = integrate(view, 4, .true.)
   end function unsaturated_axial

   !> Integrates a point in generalised plane strain as unsaturated_3d does: four components.
   integer(c_int) function unsaturated_generalised(view) bind(c, name='MUD_StressSaturation_GeneralisedPlaneStrain')
      type(view_t), intent(inout) :: view

      unsaturated_generalised = integrate(view, 4, .true.)
   end function unsaturated_generalised

   !> Integrates a point in axial symmetry in one dimension as unsaturated_3d does: three direct components.
   integer(c_int) function unsaturated_1d(view) bind(c, name= &
                                                     'MUD_StressSaturation_AxisymmetricalGeneralisedPlaneStrain')
      type(view_t), intent(inout) :: view

      unsaturated_1d = integrate(view, 3, .true.)
   end function unsaturated_1d

   !> Does what the host asks for in K(1): below -0.5 a tangent of the present state alone, otherwise an update. On
   !> failure the message and the time-step factor are written and nothing else.
   integer(c_int) function integrate(view, n, unsaturated) result(outcome)
      type(view_t), intent(inout) :: view
      integer, intent(in) :: n              !< Components of a tensor: 6, 4 or 3.
      logical, intent(in) :: unsaturated
      type(point_t) :: point
      type(params_t) :: par
      type(mud_status_t) :: status
      type(report_t) :: report
      real(c_double), pointer :: factor

      call find_arrays(view, merge(n + 1, n, unsaturated), point, status)
      if (status%code == MUD_OK) call read_params(point%props, par, status)
      if (status%code == MUD_OK) then
         call answer(view, par, n, unsaturated, point, report)
      else
         report = failed_report(status)
      end if
      outcome = RELIABLE
      if (report%status == MUD_OK) return
      outcome = FAILED
      call put('MUD: '//report_text(report), view%error_message, MESSAGE_ROOM)
      call say_refusal(report, place_t(DOOR), '')   ! hosts drop the message
      if (.not. c_associated(view%rdt)) return
      call c_f_pointer(view%rdt, factor)
      factor = min(factor, report%pnewdt)
   end function integrate

   subroutine answer(view, par, n, unsaturated, point, report)
      type(view_t), intent(in) :: view
      type(params_t), intent(in) :: par
      integer, intent(in) :: n
      logical, intent(in) :: unsaturated
      type(point_t), intent(in) :: point
      type(report_t), intent(out) :: report
      type(output_t) :: output
      real(wp) :: stress(6), strain(6), suction(2), request
      logical :: speed, predicts

      request = point%k(1)
      if (.not. is_finite(request)) then
         report = failed_report(fail(MUD_BAD_OPTION, ON_ARGUMENT))
         return
      end if
      speed = request > WITH_SPEED_OF_SOUND
      if (speed) request = request - 2.0_wp*WITH_SPEED_OF_SOUND
      predicts = request < -0.5_wp
      stress = 0.0_wp
      strain = 0.0_wp
      stress(1:n) = point%force0(1:n)/MANDEL(1:n)
      strain(1:n) = (point%gradient1(1:n) - point%gradient0(1:n))*MANDEL(1:n)   ! engineering shear
      suction = point%state0(S_SUCTION)
      if (unsaturated) call start_unsaturated(par, point, n, stress, suction, report)
      if (unsaturated) then
         if (report%status /= MUD_OK) return
      end if
      call remark_on_start(par, stress, point%state0, suction(1), place_t(DOOR))
      if (predicts) then
         if (request < -1.5_wp) then
            call kernel_tangent(par, stress, point%state0, strain, suction(1), suction(2) - suction(1), output, report)
         else
            call kernel_point(par, stress, point%state0, 0.0_wp*MANDEL, suction(1), 0.0_wp, ELASTIC, output, report)
         end if
      else
         call kernel_point(par, stress, point%state0, strain, suction(1), suction(2) - suction(1), kind_of(request), &
                           output, report)
      end if
      if (report%status /= MUD_OK) then
         call save_if_asked(completed(point%props), stress, point%state0, strain, suction(1), suction(2) - suction(1), &
                            place_t(DOOR), report)
         return
      end if
      if (.not. has_past(point%state0)) call remark_on_props(completed(point%props), place_t(DOOR))
      if (.not. predicts) then
         call remark_on_end(output%stress, output%statev, place_t(DOOR))
         point%state1(1:NSTATV) = output%statev(:NSTATV)
         stress = output%stress
         if (unsaturated) stress = total_stress(stress, 0.0_wp, output%statev(S_SATURATION), suction(2))
         point%force1(1:n) = stress(1:n)*MANDEL(1:n)
         if (unsaturated) point%force1(n + 1) = output%statev(S_SATURATION)
      end if
      ! A prediction has the slopes of the present state, so its suction is the present one.
      if (output%has_tangent) call write_blocks(view, n, unsaturated, merge(suction(1), suction(2), predicts), output)
      if (speed) call write_speed_of_sound(view, par, output)
   end subroutine answer

   !> Tangent kind of the library for a request of MGIS; it has no secant.
   pure integer function kind_of(request)
      real(wp), intent(in) :: request

      kind_of = CONSISTENT
      if (request < 0.5_wp) then
         kind_of = NONE
      else if (request < 1.5_wp) then
         kind_of = ELASTIC
      else if (request < 3.5_wp) then
         kind_of = CONTINUUM
      end if
   end function kind_of

   !> Total stress at the start becomes effective stress. The suction is that of the state where it has a past, for the
   !> degree of saturation may not jump between two increments; otherwise that of the host's liquid pressure. Air is at
   !> pressure 0. MUD_BAD_STATE where S_w of the state is not that of its suction: the stress would jump with it.
   subroutine start_unsaturated(par, point, n, stress, suction, report)
      type(params_t), intent(in) :: par
      type(point_t), intent(in) :: point
      integer, intent(in) :: n
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(out) :: suction(2)   !< At the start and at the end [kPa].
      type(report_t), intent(out) :: report
      type(saturation_t) :: sat
      type(mud_status_t) :: status
      real(wp) :: e
      logical :: past

      suction = -[point%gradient0(n + 1), point%gradient1(n + 1)]
      if (.not. all(is_finite(suction))) status = fail(MUD_BAD_INPUT, ON_SUCTION)
      if (status%code == MUD_OK .and. all(is_finite(point%state0))) then
         past = has_past(point%state0)
         if (past) suction(1) = point%state0(S_SUCTION)
         e = point%state0(S_VOID_RATIO)
         if (e <= E_LOWER .or. e >= E_UPPER) e = par%e_0   ! none is given; a wrong one is refused by the update
         sat = saturation(par%suction%retention_t, suction(1), e)
         if (past .and. abs(point%state0(S_SATURATION) - sat%s_w) > SAME_SATURATION) &
            status = fail(MUD_BAD_STATE, ON_STATEV, S_SATURATION, point%state0(S_SATURATION), &
                          sat%s_w - SAME_SATURATION, sat%s_w + SAME_SATURATION)
         stress = effective_stress(stress, 0.0_wp, sat%s_w, suction(1))
      end if
      report = failed_report(status)
   end subroutine start_unsaturated

   !> The blocks one after the other, each row by row: a row is a component of the force.
   subroutine write_blocks(view, n, unsaturated, suction, output)
      type(view_t), intent(in) :: view
      integer, intent(in) :: n
      logical, intent(in) :: unsaturated
      real(wp), intent(in) :: suction
      type(output_t), intent(inout) :: output
      real(c_double), pointer, contiguous :: k(:)
      integer :: i

      call c_f_pointer(view%k, k, [merge((n + 1)**2, n*n, unsaturated)])
      if (unsaturated) call total_blocks(output%statev(S_SATURATION), suction, output%dsw_deps, output%dsw_dpc, &
                                         output%dsig_deps, output%dsig_dpc)
      do i = 1, n
         k(n*(i - 1) + 1:n*i) = MANDEL(i)*output%dsig_deps(i, 1:n)*MANDEL(1:n)
      end do
      if (.not. unsaturated) return
      k(n*n + 1:n*n + n) = -output%dsig_dpc(1:n)*MANDEL(1:n)
      k(n*n + n + 1:n*n + 2*n) = output%dsw_deps(1:n)*MANDEL(1:n)
      k((n + 1)**2) = -output%dsw_dpc
   end subroutine write_blocks

   !> Writes the speed of the elastic pressure wave where the host gives a density.
   subroutine write_speed_of_sound(view, par, output)
      type(view_t), intent(in) :: view
      type(params_t), intent(in) :: par
      type(output_t), intent(in) :: output
      type(output_t) :: still
      type(report_t) :: report
      real(c_double), pointer :: density, speed
      real(wp) :: none(6)

      if (.not. (c_associated(view%speed_of_sound) .and. c_associated(view%s1%mass_density))) return
      call c_f_pointer(view%s1%mass_density, density)
      call c_f_pointer(view%speed_of_sound, speed)
      if (.not. is_finite(density)) return
      if (.not. density > 0.0_wp) return
      none = 0.0_wp
      call kernel_point(par, output%stress, output%statev, none, output%statev(S_SUCTION), 0.0_wp, ELASTIC, still, &
                        report)
      if (report%status == MUD_OK) speed = sqrt(still%dsig_deps(1, 1)/density)
   end subroutine write_speed_of_sound

   !> Every array that the behaviour reads or writes must be there.
   subroutine find_arrays(view, n_forces, point, status)
      type(view_t), intent(in) :: view
      integer, intent(in) :: n_forces
      type(point_t), intent(out) :: point
      type(mud_status_t), intent(out) :: status

      if (.not. all([c_associated(view%k), c_associated(view%s0%gradients), c_associated(view%s1%gradients), &
                     c_associated(view%s0%forces), c_associated(view%s1%forces), &
                     c_associated(view%s1%material_properties), c_associated(view%s0%internal_state_variables), &
                     c_associated(view%s1%internal_state_variables)])) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
         return
      end if
      call c_f_pointer(view%k, point%k, [1])
      call c_f_pointer(view%s0%gradients, point%gradient0, [n_forces])
      call c_f_pointer(view%s1%gradients, point%gradient1, [n_forces])
      call c_f_pointer(view%s0%forces, point%force0, [n_forces])
      call c_f_pointer(view%s1%forces, point%force1, [n_forces])
      call c_f_pointer(view%s1%material_properties, point%props, [NPROPS_BASE])
      call c_f_pointer(view%s0%internal_state_variables, point%state0, [NSTATV])
      call c_f_pointer(view%s1%internal_state_variables, point%state1, [NSTATV])
   end subroutine find_arrays
end module mud_mfront
