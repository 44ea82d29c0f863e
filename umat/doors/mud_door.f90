! SPDX-License-Identifier: MIT
!> Doors are entries whose names other programs prescribe, written on mud.h alone. Here is what they share.
module mud_door
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_char, c_double, c_int, c_null_char, c_ptr
   use mud_interface, only: mud_place, mud_report, mud_check_props, mud_index, mud_prepare, MUD_OK, MUD_PROPS, &
      MUD_STATEV
   implicit none (type, external)
   private
   public :: ORDER, place_of, props_at, statev_at, fewest_props, has_past, prepare

   !> Order of the components 11, 22, 33, 12, 23, 13, as Abaqus/Explicit and PLAXIS have them; its own inverse.
   integer, parameter :: ORDER(6) = [1, 2, 3, 4, 6, 5]
contains
   !> Place of an increment in sentences. A pointer is NULL where the host does not say it.
   type(mud_place) function place_of(door, step, increment, element, point) result(place)
      character(*), intent(in) :: door   !< A name of 23 letters at most.
      type(c_ptr), intent(in), optional :: step, increment, element, point

      place%entry(:len(door)) = transfer(door, place%entry)
      if (present(step)) place%step = step
      if (present(increment)) place%increment = increment
      if (present(element)) place%element = element
      if (present(point)) place%point = point
   end function place_of

   !> Number of a name in PROPS, from 1.
   integer function props_at(name)
      character(*), intent(in) :: name

      props_at = mud_index(MUD_PROPS, name//c_null_char) + 1
   end function props_at

   !> Number of a name in STATEV, from 1.
   integer function statev_at(name)
      character(*), intent(in) :: name

      statev_at = mud_index(MUD_STATEV, name//c_null_char) + 1
   end function statev_at

   !> Number of PROPS of a material without hysteresis.
   integer function fewest_props()
      fewest_props = props_at('hysteresis') - 1
   end function fewest_props

   !> True of a STATEV that has been initialised, by its entry `layout`. One that is not finite is no past.
   pure logical function has_past(layout)
      real(c_double), intent(in) :: layout

      has_past = ieee_is_finite(layout)
      if (has_past) has_past = abs(layout) > 0.0_c_double
   end function has_past

   !> Prepares a material; the report says what is wrong with PROPS. material(:) of mud_prepared_size().
   subroutine prepare(props, material, report)
      real(c_double), intent(in), contiguous :: props(:)
      real(c_double), intent(inout), contiguous :: material(:)
      type(mud_report), intent(out) :: report
      character(kind=c_char) :: text(1)
      integer(c_int) :: code

      code = mud_prepare(props, size(props), material, size(material), text, 0_c_int)
      if (code /= MUD_OK) code = mud_check_props(props, size(props), report)
   end subroutine prepare
end module mud_door
