! SPDX-License-Identifier: MIT
!> The generic interface of MFront, API version 1. The functions that MGIS looks up as BEHAVIOUR_HYPOTHESIS, which call
!> `integrate`, and their description (names, types, counts) are written by umat/tables/mud_write_tables.f90. Sign and
!> order of components are those of MUD; symmetric tensors are in Mandel's notation (shear times square root of 2),
!> matrices row by row.
module mud_mfront
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_associated, c_f_pointer
   use mud_door, only: place_of, props_at, statev_at, fewest_props, has_past, prepare
   use mud_interface, only: mud_report, mud_blocks, mud_place, mud_prepared_size, mud_prepared_statev, mud_saturation, &
      mud_increment_at, mud_refuse, mud_message, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_STATE, MUD_BAD_OPTION, &
      MUD_ON_ARGUMENT, MUD_ON_STATEV, MUD_TANGENT_NONE, MUD_TANGENT_ELASTIC, MUD_TANGENT_CONTINUUM, &
      MUD_TANGENT_CONSISTENT, MUD_TANGENT_PRESENT
   implicit none (type, external)
   private
   public :: integrate

   integer, parameter :: wp = c_double
   integer(c_int), parameter :: FAILED = -1, RELIABLE = 1     !< Outcomes that MGIS understands.
   integer(c_int), parameter :: MESSAGE_ROOM = 512            !< Characters behind error_message.
   real(wp), parameter :: SHEAR = sqrt(2.0_wp)                !< Mandel's factor.
   real(wp), parameter :: MANDEL(6) = [1.0_wp, 1.0_wp, 1.0_wp, SHEAR, SHEAR, SHEAR]
   real(wp), parameter :: WITH_SPEED_OF_SOUND = 50.0_wp       !< K(1) above it asks for the speed of sound too.
   !> S_w of a state may differ from that of its suction by this, what a text of seven digits leaves [-].
   real(wp), parameter :: SAME_SATURATION = 1.0e-6_wp
   real(wp), parameter :: SMALLEST_CUT = 0.1_wp   !< Factor on the time step where nothing was tried [-].

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
   !> Does what the host asks for in K(1): below -0.5 a tangent of the present state alone, otherwise an update. Stress
   !> in the unit of p_atm, in Mandel's notation: effective, or total (air pressure 0, docs/theory/material.md section
   !> 1.1) beside S_w [-]. Returns 1, or -1: then only the message and the factor on the time step are written.
   integer(c_int) function integrate(view, n, unsaturated) result(outcome) bind(c, name='mud_behaviour')
      type(view_t), intent(inout) :: view
      integer(c_int), value :: n             !< Components of a tensor: 6, 4 (11, 22, 33, 12) or 3.
      integer(c_int), value :: unsaturated   !< 0: effective stress.
      type(point_t) :: point
      type(mud_report) :: report
      real(c_double) :: material(mud_prepared_size())
      real(c_double), pointer :: factor
      integer(c_int) :: code

      call find_arrays(view, merge(n + 1, n, unsaturated /= 0), point, report)
      if (report%status == MUD_OK) call prepare(point%props, material, report)
      if (report%status == MUD_OK) then
         call c_f_pointer(view%s0%internal_state_variables, point%state0, [mud_prepared_statev(material)])
         call c_f_pointer(view%s1%internal_state_variables, point%state1, [mud_prepared_statev(material)])
         call answer(view, material, n, unsaturated /= 0, point, report)
      end if
      outcome = RELIABLE
      if (report%status == MUD_OK) return
      outcome = FAILED
      call give_message(report, view%error_message)
      code = mud_refuse(place_of('MFront'), report, c_null_char, n=0_c_int)   ! hosts drop the message
      if (.not. c_associated(view%rdt)) return
      call c_f_pointer(view%rdt, factor)
      factor = min(factor, report%pnewdt)
   end function integrate

   !> The sentence of a refusal, where the host has a buffer for it.
   subroutine give_message(report, buffer)
      type(mud_report), intent(in) :: report
      type(c_ptr), intent(in) :: buffer
      character(*), parameter :: BEFORE = 'MUD: '
      character(kind=c_char), pointer, contiguous :: letters(:)
      integer(c_int) :: code

      if (.not. c_associated(buffer)) return
      call c_f_pointer(buffer, letters, [MESSAGE_ROOM])
      letters(:len(BEFORE)) = transfer(BEFORE, letters)
      code = mud_message(report, letters(len(BEFORE) + 1:), MESSAGE_ROOM - len(BEFORE))
   end subroutine give_message

   subroutine answer(view, material, n, unsaturated, point, report)
      type(view_t), intent(in) :: view
      real(c_double), intent(in) :: material(:)
      integer, intent(in) :: n
      logical, intent(in) :: unsaturated
      type(point_t), intent(in) :: point
      type(mud_report), intent(out) :: report
      type(mud_blocks) :: blocks
      type(mud_place) :: place
      real(wp) :: start(6), stress(6), strain(6), state(size(point%state0)), suction(2), request
      logical :: speed, predicts
      integer(c_int) :: code
      integer :: kind

      request = point%k(1)
      if (.not. ieee_is_finite(request)) then
         report = mud_report(MUD_BAD_OPTION, MUD_ON_ARGUMENT, pnewdt=SMALLEST_CUT)
         return
      end if
      speed = request > WITH_SPEED_OF_SOUND
      if (speed) request = request - 2.0_wp*WITH_SPEED_OF_SOUND
      predicts = request < -0.5_wp
      kind = kind_of(request)
      start = 0.0_wp
      strain = 0.0_wp
      start(1:n) = point%force0(1:n)/MANDEL(1:n)
      strain(1:n) = (point%gradient1(1:n) - point%gradient0(1:n))*MANDEL(1:n)   ! engineering shear
      suction = point%state0(statev_at('suction'))
      if (unsaturated) call start_unsaturated(material, point, n, start, suction, report)
      if (report%status /= MUD_OK) return
      if (kind == MUD_TANGENT_ELASTIC .and. predicts) then
         strain = 0.0_wp
         suction(2) = suction(1)
      end if
      place = place_of('MFront')
      stress = start
      state = point%state0
      code = mud_increment_at(place, material, start, point%state0, size(state), suction(1), strain, suction(2), kind, &
                              stress, state, blocks, report)
      if (code /= MUD_OK) return
      if (speed) call write_speed_of_sound(view, material, stress, state, merge(suction(1), suction(2), predicts))
      if (.not. predicts) then
         point%state1 = state
         if (unsaturated) stress(1:3) = stress(1:3) + blocks%s_w*suction(2)
         point%force1(1:n) = stress(1:n)*MANDEL(1:n)
         if (unsaturated) point%force1(n + 1) = blocks%s_w
      end if
      ! A prediction has the slopes of the present state, so its suction is the present one.
      if (kind /= MUD_TANGENT_NONE) call write_blocks(view, n, unsaturated, merge(suction(1), suction(2), predicts), &
                                                      blocks)
   end subroutine answer

   !> Tangent kind of the library for a request of MGIS; it has no secant.
   pure integer function kind_of(request)
      real(wp), intent(in) :: request

      if (request < -1.5_wp) then
         kind_of = MUD_TANGENT_PRESENT
      else if (request < -0.5_wp) then
         kind_of = MUD_TANGENT_ELASTIC
      else if (request < 0.5_wp) then
         kind_of = MUD_TANGENT_NONE
      else if (request < 1.5_wp) then
         kind_of = MUD_TANGENT_ELASTIC
      else if (request < 3.5_wp) then
         kind_of = MUD_TANGENT_CONTINUUM
      else
         kind_of = MUD_TANGENT_CONSISTENT
      end if
   end function kind_of

   !> Total stress at the start becomes effective stress, docs/theory/material.md section 1.1, where it has numbers; the
   !> update refuses others. The suction is that of the state where it has a past, for the degree of saturation may
   !> not jump between two increments; otherwise that of the host's liquid pressure. Air is at pressure 0. MUD_BAD_STATE
   !> where S_w of the state is not that of its suction: the stress would jump with it.
   subroutine start_unsaturated(material, point, n, stress, suction, report)
      real(c_double), intent(in) :: material(:)
      type(point_t), intent(in) :: point
      integer, intent(in) :: n
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(inout) :: suction(2)   !< At the start and at the end [kPa].
      type(mud_report), intent(inout) :: report
      real(wp) :: e, s_w, given
      logical :: past

      past = has_past(point%state0(statev_at('layout')))
      if (.not. past) suction(1) = -point%gradient0(n + 1)
      suction(2) = -point%gradient1(n + 1)
      e = point%state0(statev_at('void_ratio'))
      if (.not. past .and. ieee_is_finite(e)) then
         if (abs(e) <= 0.0_wp) e = point%props(props_at('e_0'))
      end if
      if (mud_saturation(material, suction(1), e, s_w) /= MUD_OK) return
      given = point%state0(statev_at('saturation'))
      if (past .and. ieee_is_finite(given)) then
         if (abs(given - s_w) > SAME_SATURATION) report = mud_report(MUD_BAD_STATE, MUD_ON_STATEV, &
            statev_at('saturation'), value=given, lower=s_w - SAME_SATURATION, upper=s_w + SAME_SATURATION, &
            pnewdt=SMALLEST_CUT)
      end if
      stress(1:3) = stress(1:3) - s_w*suction(1)
   end subroutine start_unsaturated

   !> The blocks one after the other, each row by row: a row is a component of the force.
   subroutine write_blocks(view, n, unsaturated, suction, blocks)
      type(view_t), intent(in) :: view
      integer, intent(in) :: n
      logical, intent(in) :: unsaturated
      real(wp), intent(in) :: suction
      type(mud_blocks), intent(inout) :: blocks   !< Given for effective stress, returned for total stress.
      real(c_double), pointer, contiguous :: k(:)
      integer :: i

      call c_f_pointer(view%k, k, [merge((n + 1)**2, n*n, unsaturated)])
      if (unsaturated) then
         do i = 1, 3
            blocks%dsig_deps(i, :) = blocks%dsig_deps(i, :) + suction*blocks%dsw_deps
         end do
         blocks%dsig_dpc(1:3) = blocks%dsig_dpc(1:3) + (blocks%s_w + suction*blocks%dsw_dpc)
      end if
      do i = 1, n
         k(n*(i - 1) + 1:n*i) = MANDEL(i)*blocks%dsig_deps(i, 1:n)*MANDEL(1:n)
      end do
      if (.not. unsaturated) return
      k(n*n + 1:n*n + n) = -blocks%dsig_dpc(1:n)*MANDEL(1:n)
      k(n*n + n + 1:n*n + 2*n) = blocks%dsw_deps(1:n)*MANDEL(1:n)
      k((n + 1)**2) = -blocks%dsw_dpc
   end subroutine write_blocks

   !> Writes the speed of the elastic pressure wave where the host gives a density.
   subroutine write_speed_of_sound(view, material, stress, state, suction)
      type(view_t), intent(in) :: view
      real(c_double), intent(in) :: material(:), stress(6), state(:), suction
      type(mud_blocks) :: blocks
      real(c_double), pointer :: density, speed
      real(wp) :: none(6), same(6), unmoved(size(state))

      if (.not. (c_associated(view%speed_of_sound) .and. c_associated(view%s1%mass_density))) return
      call c_f_pointer(view%s1%mass_density, density)
      call c_f_pointer(view%speed_of_sound, speed)
      if (.not. ieee_is_finite(density)) return
      if (.not. density > 0.0_wp) return
      none = 0.0_wp
      if (mud_increment_at(place_of('MFront'), material, stress, state, size(state), suction, none, suction, &
                           MUD_TANGENT_ELASTIC, same, unmoved, blocks) == MUD_OK) &
         speed = sqrt(blocks%dsig_deps(1, 1)/density)
   end subroutine write_speed_of_sound

   !> Every array that the behaviour reads or writes must be there.
   subroutine find_arrays(view, n_forces, point, report)
      type(view_t), intent(in) :: view
      integer, intent(in) :: n_forces
      type(point_t), intent(out) :: point
      type(mud_report), intent(out) :: report

      if (.not. all([c_associated(view%k), c_associated(view%s0%gradients), c_associated(view%s1%gradients), &
                     c_associated(view%s0%forces), c_associated(view%s1%forces), &
                     c_associated(view%s1%material_properties), c_associated(view%s0%internal_state_variables), &
                     c_associated(view%s1%internal_state_variables)])) then
         report = mud_report(MUD_NULL_ARGUMENT, MUD_ON_ARGUMENT, pnewdt=SMALLEST_CUT)
         return
      end if
      call c_f_pointer(view%k, point%k, [1])
      call c_f_pointer(view%s0%gradients, point%gradient0, [n_forces])
      call c_f_pointer(view%s1%gradients, point%gradient1, [n_forces])
      call c_f_pointer(view%s0%forces, point%force0, [n_forces])
      call c_f_pointer(view%s1%forces, point%force1, [n_forces])
      call c_f_pointer(view%s1%material_properties, point%props, [fewest_props()])
   end subroutine find_arrays
end module mud_mfront
