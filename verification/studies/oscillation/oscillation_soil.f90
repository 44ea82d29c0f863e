! SPDX-License-Identifier: MIT
!> One point of soil under mixed control, through the library's public interface. Compression positive, tensor shear.
module oscillation_soil
   use, intrinsic :: iso_c_binding, only: c_int, c_null_char
   use kinds, only: wp
   use dense, only: solve
   use mud_interface, only: mud_report, mud_count, mud_index, mud_default_props, mud_prepared_size, mud_prepare, &
      mud_init, mud_update, mud_blocks, MUD_PROPS, MUD_STATEV, MUD_TANGENT_NONE, MUD_TANGENT_CONSISTENT
   implicit none (type, external)
   private
   public :: soil_t, new_soil, step_soil, total, void_ratio

   integer, parameter :: ROOM = 128                 !< For PROPS and STATEV; checked.
   integer, parameter :: MAX_ITERATIONS = 30, MAX_HALVINGS = 12
   real(wp), parameter :: STRESS_TOLERANCE = 1.0e-9_wp   !< Of a held stress, share of the mean stress [-].

   type :: soil_t
      integer :: nprops, nstatev
      real(wp) :: props(ROOM), statev(ROOM)
      real(wp), allocatable :: material(:)   !< Prepared.
      real(wp) :: stress(6)         !< sigma' of the UMAT convention [kPa]
      real(wp) :: suction           !< [kPa]
      real(wp) :: tangent(6, 6)     !< d stress/d engineering strain of the last update [kPa]
      logical :: held(6)            !< Components whose stress is held.
      real(wp) :: target(6)         !< Their stress [kPa].
      integer :: halvings = 0       !< Increments cut after a failure.
      integer :: iterations = 0     !< Updates of the mixed control.
   end type soil_t
contains
   !> A point at an isotropic stress; names and values change entries of the default material.
   subroutine new_soil(names, values, p, e, suction, held, soil)
      character(*), intent(in) :: names(:)
      real(wp), intent(in) :: values(:), p, e, suction
      logical, intent(in) :: held(6)
      type(soil_t), intent(out) :: soil
      character(400) :: text
      integer :: i, place

      soil%nprops = mud_count(MUD_PROPS)
      soil%nstatev = mud_count(MUD_STATEV)
      if (max(soil%nprops, soil%nstatev) > ROOM) error stop 'oscillation_soil: ROOM is too small'
      if (mud_default_props(soil%props, soil%nprops) /= 0) error stop 'oscillation_soil: no defaults'
      do i = 1, size(names)
         place = mud_index(MUD_PROPS, trim(names(i))//c_null_char) + 1
         if (place < 1) error stop 'oscillation_soil: the library has no such parameter'
         soil%props(place) = values(i)
      end do
      allocate (soil%material(mud_prepared_size()))
      if (mud_prepare(soil%props, soil%nprops, soil%material, size(soil%material), text, len(text)) /= 0) then
         print '(a)', text(:index(text, c_null_char) - 1)
         error stop 1
      end if
      soil%stress = [-p, -p, -p, 0.0_wp, 0.0_wp, 0.0_wp]
      soil%suction = suction
      soil%statev = 0.0_wp
      if (mud_init(soil%material, soil%stress, suction, e, 0.0_wp, soil%statev, soil%nstatev, text, len(text)) /= 0) &
         error stop 'oscillation_soil: the start is not accepted'
      soil%held = held
      soil%target = soil%stress
      soil%tangent = 0.0_wp
   end subroutine new_soil

   !> Advances by a strain (of the components that are not held). A failed increment is halved; `failed` if that is of
   !> no use.
   subroutine step_soil(soil, strain, failed)
      type(soil_t), intent(inout) :: soil
      real(wp), intent(in) :: strain(6)
      logical, intent(out) :: failed
      real(wp) :: engineering(6), done, share
      integer :: halvings

      engineering = -strain
      engineering(4:6) = 2.0_wp*engineering(4:6)
      done = 0.0_wp
      share = 1.0_wp
      halvings = 0
      do while (1.0_wp - done > 1.0e-12_wp)
         share = min(share, 1.0_wp - done)
         if (any(soil%held)) then
            call mixed_step(soil, share*engineering, failed)
         else
            call plain_step(soil, share*engineering, failed)
         end if
         if (failed) then
            halvings = halvings + 1
            soil%halvings = soil%halvings + 1
            if (halvings > MAX_HALVINGS) return
            share = 0.5_wp*share
         else
            done = done + share
         end if
      end do
      failed = .false.
   end subroutine step_soil

   subroutine plain_step(soil, strain, failed)
      type(soil_t), intent(inout) :: soil
      real(wp), intent(in) :: strain(6)
      logical, intent(out) :: failed
      integer(c_int) :: code

      code = mud_update(soil%material, soil%stress, soil%statev, soil%nstatev, strain, soil%suction, &
                        MUD_TANGENT_NONE, soil%stress, soil%statev)
      failed = code /= 0
   end subroutine plain_step

   !> Newton's method for the strain of the held components.
   subroutine mixed_step(soil, strain, failed)
      type(soil_t), intent(inout) :: soil
      real(wp), intent(in) :: strain(6)
      logical, intent(out) :: failed
      real(wp) :: trial(6), stress(6), statev(ROOM), tangent(6, 6), residual(6), matrix(6, 6), change(6), last
      logical :: good
      integer :: iteration, i
      integer(c_int) :: code
      type(mud_blocks) :: blocks

      trial = merge(0.0_wp, strain, soil%held)
      last = huge(1.0_wp)
      failed = .true.
      do iteration = 1, MAX_ITERATIONS
         soil%iterations = soil%iterations + 1
         code = mud_update(soil%material, soil%stress, soil%statev, soil%nstatev, trial, soil%suction, &
                           MUD_TANGENT_CONSISTENT, stress, statev, blocks)
         if (code /= 0) return
         tangent = blocks%dsig_deps
         residual = merge(soil%target - stress, 0.0_wp, soil%held)
         if (maxval(abs(residual)) <= STRESS_TOLERANCE*abs(sum(soil%target(1:3)))) then
            soil%stress = stress
            soil%statev = statev
            soil%tangent = tangent
            failed = .false.
            return
         end if
         matrix = tangent
         do i = 1, 6
            if (soil%held(i)) cycle
            matrix(i, :) = 0.0_wp
            matrix(:, i) = 0.0_wp
            matrix(i, i) = 1.0_wp
         end do
         call solve(matrix, residual, change, good)
         if (.not. good) return
         ! A correction that hardly shrank is taken by half.
         if (maxval(abs(change)) > 0.5_wp*last .and. iteration > 6) change = 0.5_wp*change
         last = maxval(abs(change))
         trial = trial + change
      end do
   end subroutine mixed_step

   !> A total of STATEV, by its name.
   real(wp) function total(soil, name)
      type(soil_t), intent(in) :: soil
      character(*), intent(in) :: name

      total = soil%statev(mud_index(MUD_STATEV, name//c_null_char) + 1)
   end function total

   real(wp) function void_ratio(soil)
      type(soil_t), intent(in) :: soil

      void_ratio = total(soil, 'void_ratio')
   end function void_ratio
end module oscillation_soil
