! SPDX-License-Identifier: MIT
!> The tables of the MUD library: its parameters and state variables with their names, units and ranges.
module library_tables
   use, intrinsic :: iso_c_binding, only: c_int, c_null_char
   use kinds, only: wp
   use mud_interface, only: mud_version, mud_count, mud_prepared_size, mud_prepared_statev, mud_prepare, &
                            mud_index, mud_text, mud_option, mud_bounds, mud_bounds_for, &
                            MUD_PROPS, &
                            MUD_STATEV, MUD_NAME, MUD_UNIT, MUD_ORIGIN, MUD_MEANING
   use texts, only: from_c, lower_case
   implicit none (type, external)
   private
   public :: library_version, property_count, property_index, property_name, property_unit, property_origin, &
             property_meaning, table_text, property_option, option_words, property_range, range_for, state_count, &
             statev_index, statev_name

   integer, parameter :: BUFFER = 600
contains
   !> Version of the library. 'unknown' where the library does not answer.
   function library_version() result(version)
      character(:), allocatable :: version
      character(BUFFER) :: text
      integer(c_int) :: code

      text = c_null_char
      code = mud_version(text, BUFFER)
      version = from_c(text)
      if (code < 0) version = 'unknown'
   end function library_version

   !> Number of entries of PROPS.
   integer function property_count()
      property_count = mud_count(MUD_PROPS)
   end function property_count

   !> Number of entries of STATEV.
   integer function state_count(props)
      real(wp), intent(in) :: props(:)   !< All of them, checked.
      real(wp) :: prepared(mud_prepared_size())
      character(1) :: text(1)

      state_count = mud_count(MUD_STATEV)
      if (mud_prepare(props, size(props), prepared, size(prepared), text(1), 0) == 0) &
         state_count = mud_prepared_statev(prepared)
   end function state_count

   !> Place of a parameter in PROPS, from 1; 0 if there is none of that name.
   integer function property_index(name)
      character(*), intent(in) :: name

      property_index = mud_index(MUD_PROPS, trim(name)//c_null_char) + 1
   end function property_index

   !> Place of a state variable in STATEV, from 1; 0 if there is none of that name.
   integer function statev_index(name)
      character(*), intent(in) :: name

      statev_index = mud_index(MUD_STATEV, trim(name)//c_null_char) + 1
   end function statev_index

   !> Name of the entry of PROPS at a place from 1. Empty where there is none.
   function property_name(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = table_text(MUD_PROPS, place, MUD_NAME)
   end function property_name

   !> Unit of the entry of PROPS at a place from 1. Empty where there is none.
   function property_unit(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = table_text(MUD_PROPS, place, MUD_UNIT)
   end function property_unit

   !> Origin of the entry of PROPS at a place from 1: paper, mended, rebuilt, numerical or ours. Empty where there is
   !> none.
   function property_origin(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = table_text(MUD_PROPS, place, MUD_ORIGIN)
   end function property_origin

   !> Meaning of the entry of PROPS at a place from 1. Empty where there is none.
   function property_meaning(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = table_text(MUD_PROPS, place, MUD_MEANING)
   end function property_meaning

   !> Name of the entry of STATEV at a place from 1. Empty where there is none.
   function statev_name(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = table_text(MUD_STATEV, place, MUD_NAME)
   end function statev_name

   !> A text about an entry: list MUD_PROPS or MUD_STATEV, place from 1, field MUD_NAME ... Empty where there is none.
   function table_text(list, place, field) result(text)
      integer(c_int), intent(in) :: list, field
      integer, intent(in) :: place
      character(:), allocatable :: text
      character(BUFFER) :: raw

      raw = c_null_char
      if (mud_text(list, place - 1, field, raw, BUFFER) < 0) raw = c_null_char
      text = from_c(raw)
   end function table_text

   !> The value of a parameter that a word stands for; `good` is false if it knows no such word. Case is ignored. The
   !> place is from 1; value is 0 where good is false.
   subroutine property_option(place, word, value, good)
      integer, intent(in) :: place
      character(*), intent(in) :: word
      real(wp), intent(out) :: value
      logical, intent(out) :: good
      character(BUFFER) :: raw
      integer(c_int) :: number

      good = .false.
      value = 0.0_wp
      raw = c_null_char
      number = 0
      do while (mud_option(place - 1, number, value, raw, BUFFER) == 0)
         good = lower_case(from_c(raw)) == lower_case(trim(word))
         if (good) return
         number = number + 1
      end do
      value = 0.0_wp
   end subroutine property_option

   !> The words that stand for values of a parameter, divided by |; empty where there are none.
   function option_words(place) result(words)
      integer, intent(in) :: place   !< From 1.
      character(:), allocatable :: words
      character(BUFFER) :: raw
      real(wp) :: value
      integer(c_int) :: number

      words = ''
      raw = c_null_char
      number = 0
      do while (mud_option(place - 1, number, value, raw, BUFFER) == 0)
         words = words//lower_case(from_c(raw))//'|'
         number = number + 1
      end do
      words = words(:max(0, len(words) - 1))
   end function option_words

   !> Bounds and default of a parameter, in kPa; zeros if there is none of that place. The place is from 1; units as
   !> property_unit says.
   subroutine property_range(place, lower, upper, preset)
      integer, intent(in) :: place
      real(wp), intent(out) :: lower, upper, preset

      if (mud_bounds(MUD_PROPS, place - 1, lower, upper, preset) < 0) then
         lower = 0.0_wp
         upper = 0.0_wp
         preset = 0.0_wp
      end if
   end subroutine property_range

   !> Bounds and preset of an entry of PROPS in the unit of stress that the p_atm of given PROPS tells. props(:) has as
   !> many entries as the library takes; where it refuses them, those of property_range.
   subroutine range_for(props, place, lower, upper, preset)
      real(wp), intent(in) :: props(:)
      integer, intent(in) :: place
      real(wp), intent(out) :: lower, upper, preset

      if (mud_bounds_for(props, size(props), place - 1, lower, upper, preset) < 0) &
         call property_range(place, lower, upper, preset)
   end subroutine range_for
end module library_tables
