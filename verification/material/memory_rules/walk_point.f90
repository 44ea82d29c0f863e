! SPDX-License-Identifier: MIT
!> One point of soil under mixed control, through the library's public interface.
!> Compression positive, components 11, 22, 33, 12, 13, 23, engineering shear strain.
module walk_point
   use, intrinsic :: iso_c_binding, only: c_int, c_ptr, c_loc, c_null_ptr, c_null_char
   use mud_interface, only: mud_count, mud_index, mud_default_props, mud_prepared_size, mud_prepare, mud_init, mud_update, &
      mud_blocks, MUD_PROPS, MUD_STATEV, MUD_TANGENT_NONE, MUD_TANGENT_CONSISTENT
   use kinds, only: wp
   use dense, only: solve
   implicit none (type, external)
   private
   public :: point_t, control_t, prepare, set_property, start, lead_components, go, turn, state_of, states_of

   integer, parameter :: ROOM = 256                      !< For PROPS and STATEV; checked.
   integer, parameter :: MAX_ITERATIONS = 25, MAX_BACKTRACKS = 6, MAX_HALVINGS = 12
   real(wp), parameter :: STRESS_TOLERANCE = 1.0e-8_wp   !< Of a led stress, share of the mean stress [-].
   real(wp), parameter :: SMALLEST_SCALE = 1.0_wp        !< Of that mean stress [kPa].

   !> Six constraints strain(i, :) . d eps + stress(i, :) . sigma' = value.
   type :: control_t
      real(wp) :: strain(6, 6) = 0.0_wp, stress(6, 6) = 0.0_wp
      logical :: by_stress(6) = .false.
   end type control_t

   type :: point_t
      integer(c_int) :: nprops = 0, nstatev = 0
      real(wp) :: props(ROOM) = 0.0_wp, statev(ROOM) = 0.0_wp
      real(wp), allocatable :: material(:)   !< Prepared where the point starts.
      real(wp) :: stress(6) = 0.0_wp    !< sigma' [kPa]
      real(wp) :: strain(6) = 0.0_wp    !< Sum of the increments [-].
      real(wp) :: suction = 0.0_wp      !< [kPa]
      real(wp) :: goal(6) = 0.0_wp      !< Of each constraint led by a stress [kPa].
      real(wp) :: tangent(6, 6) = 0.0_wp
      logical :: tangent_known = .false.
      type(control_t) :: control
      integer :: halvings = 0           !< Increments cut after a failure.
      integer :: iterations = 0         !< Updates of the mixed control.
   end type point_t

   interface
      !> The Abaqus entry of the library, every argument by address.
      subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                      temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, &
                      pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc) bind(c, name='umat_')
         import :: c_ptr
         type(c_ptr), value :: stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                               time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                               nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc
      end subroutine umat
   end interface
contains
   !> The default material, no state yet.
   subroutine prepare(point)
      type(point_t), intent(out) :: point

      point%nprops = mud_count(MUD_PROPS)
      point%nstatev = mud_count(MUD_STATEV)
      if (max(point%nprops, point%nstatev) > ROOM) error stop 'mud_walk: ROOM is too small for PROPS or STATEV'
      if (mud_default_props(point%props, point%nprops) /= 0) error stop 'mud_walk: the library gives no default props'
   end subroutine prepare

   subroutine set_property(point, name, value)
      type(point_t), intent(inout) :: point
      character(*), intent(in) :: name
      real(wp), intent(in) :: value
      integer :: place

      place = mud_index(MUD_PROPS, trim(name)//c_null_char) + 1
      if (place < 1) then
         print '(a)', 'mud_walk: the library has no parameter '//trim(name)
         error stop 1
      end if
      point%props(place) = value
   end subroutine set_property

   !> The first state, from an effective stress [kPa], a suction [kPa] and a void ratio.
   subroutine start(point, stress, suction, void_ratio)
      type(point_t), intent(inout) :: point
      real(wp), intent(in) :: stress(6), suction, void_ratio
      character(400) :: text
      real(wp) :: sigma(6)

      if (.not. allocated(point%material)) allocate (point%material(mud_prepared_size()))
      if (mud_prepare(point%props, point%nprops, point%material, size(point%material), text, len(text)) /= 0) &
         call give_up(text)
      sigma = -stress
      if (mud_init(point%material, sigma, suction, void_ratio, 0.0_wp, point%statev, point%nstatev, text, len(text)) &
          /= 0) call give_up(text)
      point%stress = -sigma
      point%suction = suction
      call lead_components(point, spread(.false., 1, 6))
   end subroutine start

   subroutine give_up(text)
      character(*), intent(in) :: text

      print '(a)', 'mud_walk: '//text(:index(text, c_null_char) - 1)
      error stop 1
   end subroutine give_up

   !> Each component is led by its strain or by its stress.
   pure subroutine lead_components(point, by_stress)
      type(point_t), intent(inout) :: point
      logical, intent(in) :: by_stress(6)
      integer :: i

      point%control = control_t(by_stress=by_stress)
      do i = 1, 6
         if (by_stress(i)) then
            point%control%stress(i, i) = 1.0_wp
         else
            point%control%strain(i, i) = 1.0_wp
         end if
      end do
      point%goal = matmul(point%control%stress, point%stress)
   end subroutine lead_components

   !> n equal increments of the led strains, stresses and suction.
   subroutine go(point, n, change, d_suction, failed)
      type(point_t), intent(inout) :: point
      integer, intent(in) :: n
      real(wp), intent(in) :: change(6), d_suction
      logical, intent(out) :: failed
      real(wp) :: first(6)
      integer :: i

      ! goals count from the first one, so that errors of the control do not add up
      first = point%goal
      do i = 1, n
         point%goal = first + i*change
         call advance(point, merge(point%goal, change, point%control%by_stress), d_suction, failed)
         if (failed) return
      end do
   end subroutine go

   !> One increment. One that fails is halved; `failed` if that is of no use, with the point where it came to.
   subroutine advance(point, goal, d_suction, failed)
      type(point_t), intent(inout) :: point
      real(wp), intent(in) :: goal(6), d_suction
      logical, intent(out) :: failed
      real(wp) :: done, share, from(6), values(6)
      integer :: halvings

      from = matmul(point%control%stress, point%stress)
      done = 0.0_wp
      share = 1.0_wp
      halvings = 0
      do while (1.0_wp - done > 1.0e-12_wp)
         share = min(share, 1.0_wp - done)
         values = merge(from + (done + share)*(goal - from), share*goal, point%control%by_stress)
         if (any(point%control%by_stress)) then
            call mixed_step(point, values, share*d_suction, failed)
         else
            call plain_step(point, values, share*d_suction, failed)
         end if
         if (failed) then
            halvings = halvings + 1
            point%halvings = point%halvings + 1
            if (halvings > MAX_HALVINGS) return
            share = 0.5_wp*share
         else
            done = done + share
         end if
      end do
      failed = .false.
   end subroutine advance

   subroutine plain_step(point, strain, d_suction, failed)
      type(point_t), intent(inout) :: point
      real(wp), intent(in) :: strain(6), d_suction
      logical, intent(out) :: failed
      real(wp) :: stress(6)

      failed = mud_update(point%material, -point%stress, point%statev, point%nstatev, -strain, &
                          point%suction + d_suction, MUD_TANGENT_NONE, stress, point%statev) /= 0
      if (failed) return
      point%stress = -stress
      point%strain = point%strain + strain
      point%suction = point%suction + d_suction
   end subroutine plain_step

   !> Newton's method with backtracking for the strain that meets the constraints.
   subroutine mixed_step(point, values, d_suction, failed)
      type(point_t), intent(inout) :: point
      real(wp), intent(in) :: values(6), d_suction
      logical, intent(out) :: failed
      type(control_t) :: control
      real(wp) :: trial(6), change(6), stress(6), statev(ROOM), tangent(6, 6), residual(6), matrix(6, 6), error, last
      real(wp) :: allowed
      type(mud_blocks) :: blocks
      integer :: iteration, backtracks
      logical :: good

      control = point%control
      allowed = STRESS_TOLERANCE*max(abs(sum(point%stress(1:3)))/3.0_wp, SMALLEST_SCALE)
      trial = merge(0.0_wp, values, control%by_stress)
      if (point%tangent_known) then
         residual = values - merge(matmul(control%stress, point%stress), 0.0_wp, control%by_stress)
         matrix = control%strain + matmul(control%stress, point%tangent)
         call solve(matrix, residual, change, good)
         if (good) trial = change
      end if
      failed = .true.
      last = huge(1.0_wp)
      change = 0.0_wp
      backtracks = 0
      do iteration = 1, MAX_ITERATIONS
         point%iterations = point%iterations + 1
         if (mud_update(point%material, -point%stress, point%statev, point%nstatev, -trial, &
                        point%suction + d_suction, MUD_TANGENT_CONSISTENT, stress, statev, blocks) /= 0) return
         tangent = blocks%dsig_deps
         stress = -stress
         residual = values - matmul(control%strain, trial) - matmul(control%stress, stress)
         error = maxval(abs(residual), control%by_stress)
         if (error <= allowed) then
            point%stress = stress
            point%statev = statev
            point%strain = point%strain + trial
            point%suction = point%suction + d_suction
            point%tangent = tangent
            point%tangent_known = .true.
            failed = .false.
            return
         end if
         if (error > last .and. backtracks < MAX_BACKTRACKS) then
            backtracks = backtracks + 1
            change = 0.5_wp*change
            trial = trial - change
            cycle
         end if
         backtracks = 0
         last = error
         matrix = control%strain + matmul(control%stress, tangent)
         call solve(matrix, residual, change, good)
         if (.not. good) return
         trial = trial + change
      end do
   end subroutine mixed_step

   !> A rigid rotation of the point: the host turns the stress, umat_ the state by DROT.
   subroutine turn(point, rotation, failed)
      type(point_t), intent(inout), target :: point
      real(wp), intent(in) :: rotation(3, 3)
      logical, intent(out) :: failed
      real(wp), target :: stress(6), nothing(6), ddsdde(6, 6), drot(3, 3), pnewdt, predef, dpred
      integer(c_int), target :: six, nstatev, nprops

      stress = -rotated(point%stress, rotation)
      nothing = 0.0_wp
      ddsdde = 0.0_wp
      drot = rotation
      pnewdt = 1.0_wp
      predef = point%suction
      dpred = 0.0_wp
      six = 6
      nstatev = point%nstatev
      nprops = point%nprops
      call umat(c_loc(stress), c_loc(point%statev), c_loc(ddsdde), c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, &
                c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_loc(nothing), c_null_ptr, c_null_ptr, c_null_ptr, &
                c_null_ptr, c_loc(predef), c_loc(dpred), c_null_ptr, c_null_ptr, c_null_ptr, c_loc(six), &
                c_loc(nstatev), c_loc(point%props), c_loc(nprops), c_null_ptr, c_loc(drot), c_loc(pnewdt), &
                c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, &
                c_null_ptr)
      failed = pnewdt < 1.0_wp
      point%stress = -stress
      point%tangent_known = .false.
   end subroutine turn

   !> An entry of STATEV, by its name.
   real(wp) function state_of(point, name)
      type(point_t), intent(in) :: point
      character(*), intent(in) :: name

      state_of = point%statev(mud_index(MUD_STATEV, name//c_null_char) + 1)
   end function state_of

   !> n entries of STATEV from a name on.
   function states_of(point, name, n) result(values)
      type(point_t), intent(in) :: point
      character(*), intent(in) :: name
      integer, intent(in) :: n
      real(wp) :: values(n)
      integer :: place

      place = mud_index(MUD_STATEV, name//c_null_char) + 1
      if (place < 1) error stop 'mud_walk: the library has no such state variable'
      values = point%statev(place:place + n - 1)
   end function states_of

   !> R a R^T of a symmetric tensor with components 11, 22, 33, 12, 13, 23.
   pure function rotated(tensor, rotation) result(turned)
      real(wp), intent(in) :: tensor(6), rotation(3, 3)
      real(wp) :: turned(6), a(3, 3)

      a = reshape(tensor([1, 4, 5, 4, 2, 6, 5, 6, 3]), [3, 3])
      a = matmul(rotation, matmul(a, transpose(rotation)))
      turned = [a(1, 1), a(2, 2), a(3, 3), a(1, 2), a(1, 3), a(2, 3)]
   end function rotated
end module walk_point
