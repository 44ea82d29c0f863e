! SPDX-License-Identifier: MIT
!> The functions of mud.h. Here they are called c_NAME, for a compiler that meets an interface and a procedure of one
!> name in one file compares them, and a NULL has no interface.
module mud_c_api
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_associated, c_f_pointer
   use mud_kernel, only: report_t, failed_report
   use mud_advice, only: advice_on, ADVICE_LENGTH
   use mud_kinds, only: wp
   use mud_messages, only: status_text, report_text
   use mud_params, only: params_t, read_params, completed, is_length, check_bounds, default_props
   use mud_registry, only: OPTIONS, NPROPS, NSTATV, PROPERTIES, VARIABLES, property_index, property_meaning, &
      statev_index, statev_name, &
      statev_variable, numbered
   use mud_retention, only: check_retention
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_NPROPS, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, MUD_BAD_INPUT, &
      ON_ARGUMENT
   use mud_tensor, only: is_finite
   use mud_to_host, only: put, put_real
   use mud_units, only: bounds_for, convert_props
   implicit none (type, external)
   private
   public :: c_abi_version, c_version, c_count, c_index, c_text, c_option, c_bounds, c_bounds_for, &
             c_default_props, c_convert_props, c_validate_props, &
             c_status_text, c_message
   public :: ABI_VERSION, VERSION

   integer, parameter :: ABI_VERSION = 3
   character(*), parameter :: VERSION = '0.2.0'
   integer, parameter :: LIST_PROPS = 1, LIST_STATEV = 2
   integer, parameter :: FIELDS = 8, LONGEST = 200   !< Fields of an entry, and letters of one.
   real(wp), parameter :: SMALLEST_FACTOR = 1.0e-12_wp   !< Between two units of stress [-].
contains
   !> Version of the C interface, MUD_ABI_VERSION of mud.h.
   pure integer(c_int) function c_abi_version() bind(c, name='mud_abi_version')
      c_abi_version = ABI_VERSION
   end function c_abi_version

   !> Version of the library as text; always MUD_OK.
   integer(c_int) function c_version(text, len) bind(c, name='mud_version')
      type(c_ptr), value :: text
      integer(c_int), value :: len

      call put(VERSION, text, len)
      c_version = MUD_OK
   end function c_version

   !> Number of entries of PROPS or STATEV; MUD_BAD_OPTION for another list.
   pure integer(c_int) function c_count(list) bind(c, name='mud_count')
      integer(c_int), intent(in), value :: list

      select case (list)
      case (LIST_PROPS)
         c_count = NPROPS
      case (LIST_STATEV)
         c_count = NSTATV
      case default
         c_count = MUD_BAD_OPTION
      end select
   end function c_count

   !> Index of a name from 0, case ignored; -1 where there is no such name or list, or no name.
   integer(c_int) function c_index(list, name) bind(c, name='mud_index')
      integer(c_int), value :: list
      type(c_ptr), value :: name
      character(kind=c_char), pointer :: letters(:)
      character(64) :: word
      integer :: i

      c_index = -1
      if (.not. c_associated(name)) return
      call c_f_pointer(name, letters, [len(word) + 1])
      word = ''
      do i = 1, len(word) + 1
         if (letters(i) == c_null_char) exit
         if (i > len(word)) return
         word(i:i) = letters(i)
      end do
      if (list == LIST_PROPS) c_index = property_index(word) - 1
      if (list == LIST_STATEV) c_index = statev_index(word) - 1
   end function c_index

   !> A field of an entry, index from 0; MUD_BAD_OPTION for a list, index or field that is unknown. Fields of STATEV
   !> alone are empty for PROPS.
   integer(c_int) function c_text(list, index, field, text, len) bind(c, name='mud_text')
      integer(c_int), value :: list, index, field, len
      type(c_ptr), value :: text
      character(LONGEST) :: fields_(FIELDS)   ! MUD_NAME, MUD_SYMBOL, ... of mud.h

      c_text = MUD_BAD_OPTION
      if (index < 0 .or. index >= c_count(list) .or. field < 1 .or. field > FIELDS) return
      fields_ = ''
      if (list == LIST_PROPS) then
         associate (entry => PROPERTIES(index + 1))
            fields_(:5) = [character(LONGEST) :: entry%name, entry%symbol, entry%unit, entry%origin, &
                           property_meaning(index + 1)]
         end associate
      else
         associate (entry => VARIABLES(statev_variable(index + 1)))
            fields_ = [character(LONGEST) :: statev_name(index + 1), numbered(entry%symbol, index + 1), entry%unit, &
                       entry%origin, numbered(entry%meaning, index + 1), entry%initial, &
                       merge('DROT', 'no  ', entry%rotates), entry%evolution]
         end associate
      end if
      call put(fields_(field), text, len)
      c_text = MUD_OK
   end function c_text

   !> The number-th value, from 0, of a parameter that takes words, and its word. MUD_BAD_OPTION where there is none.
   !> index from 0, value [-].
   integer(c_int) function c_option(index, number, value, word, len) bind(c, name='mud_option')
      integer(c_int), value :: index, number, len
      type(c_ptr), value :: value, word
      integer :: i, found

      c_option = MUD_BAD_OPTION
      found = -1
      do i = 1, size(OPTIONS)
         if (OPTIONS(i)%property /= index + 1) cycle
         found = found + 1
         if (found /= number) cycle
         call put_real(real(OPTIONS(i)%value, wp), value)
         call put(OPTIONS(i)%word, word, len)
         c_option = MUD_OK
         return
      end do
   end function c_option

   !> Bounds and default of a parameter where p_atm is an atmosphere in kPa; state variables have none. index from 0;
   !> units as MUD_UNIT says, stresses in kPa. MUD_BAD_OPTION for state variables and an unknown index.
   integer(c_int) function c_bounds(list, index, lower, upper, preset) bind(c, name='mud_bounds')
      integer(c_int), value :: list, index
      type(c_ptr), value :: lower, upper, preset

      c_bounds = MUD_BAD_OPTION
      if (list /= LIST_PROPS .or. index < 0 .or. index >= NPROPS) return
      call put_real(PROPERTIES(index + 1)%lower, lower)
      call put_real(PROPERTIES(index + 1)%upper, upper)
      call put_real(PROPERTIES(index + 1)%default, preset)
      c_bounds = MUD_OK
   end function c_bounds

   !> Bounds and preset of an entry of PROPS in the unit of stress of a set of PROPS. MUD_NULL_ARGUMENT without props,
   !> MUD_BAD_NPROPS, MUD_BAD_OPTION for an unknown index; PROPS are not checked.
   integer(c_int) function c_bounds_for(props, n_props, index, lower, upper, preset) bind(c, name='mud_bounds_for')
      type(c_ptr), value :: props, lower, upper, preset
      integer(c_int), value :: n_props, index
      real(c_double), pointer, contiguous :: values(:)
      real(wp) :: low(NPROPS), high(NPROPS), default(NPROPS)

      c_bounds_for = MUD_NULL_ARGUMENT
      if (.not. c_associated(props)) return
      c_bounds_for = MUD_BAD_NPROPS
      if (.not. is_length(n_props)) return
      c_bounds_for = MUD_BAD_OPTION
      if (index < 0 .or. index >= NPROPS) return
      call c_f_pointer(props, values, [n_props])
      call bounds_for(completed(values), low, high, default)
      call put_real(low(index + 1), lower)
      call put_real(high(index + 1), upper)
      call put_real(default(index + 1), preset)
      c_bounds_for = MUD_OK
   end function c_bounds_for

   !> Converts the PROPS of a material to another unit of stress, of which `factor` make one of the present. On an error
   !> PROPS are untouched: MUD_NULL_ARGUMENT, MUD_BAD_INPUT for a factor outside 1e-12 to 1e12, else what read_params
   !> says of the PROPS before or after.
   integer(c_int) function c_convert_props(props, n_props, factor) bind(c, name='mud_convert_props')
      type(c_ptr), value :: props
      integer(c_int), value :: n_props
      real(c_double), value :: factor
      real(c_double), pointer, contiguous :: values(:)
      real(wp) :: converted(NPROPS)
      type(params_t) :: par
      type(mud_status_t) :: status

      c_convert_props = MUD_NULL_ARGUMENT
      if (.not. c_associated(props)) return
      c_convert_props = MUD_BAD_INPUT
      if (.not. is_finite(factor)) return
      if (factor < SMALLEST_FACTOR .or. factor > 1.0_wp/SMALLEST_FACTOR) return
      call c_f_pointer(props, values, [max(n_props, 0)])
      call read_params(values, par, status)
      if (status%code == MUD_OK) then
         converted = convert_props(completed(values), factor)
         call read_params(converted, par, status)
         if (status%code == MUD_OK) values = converted(:size(values))
      end if
      c_convert_props = status%code
   end function c_convert_props

   !> Every default of the registry, stresses in kPa. MUD_NULL_ARGUMENT, or MUD_BAD_NPROPS for a wrong number.
   integer(c_int) function c_default_props(props, n_props) bind(c, name='mud_default_props')
      type(c_ptr), value :: props
      integer(c_int), value :: n_props
      real(c_double), pointer, contiguous :: values(:)
      real(wp) :: full(NPROPS)

      c_default_props = MUD_NULL_ARGUMENT
      if (.not. c_associated(props)) return
      c_default_props = MUD_BAD_NPROPS
      if (.not. is_length(n_props)) return
      call c_f_pointer(props, values, [n_props])
      full = default_props()
      values = full(:n_props)
      c_default_props = MUD_OK
   end function c_default_props

   !> Status of PROPS in the unit of p_atm and a sentence: the first fault, 'no error', or a warning where units seem
   !> mixed. Codes of read_params and check_retention, MUD_NULL_ARGUMENT.
   integer(c_int) function c_validate_props(props, n_props, text, len) bind(c, name='mud_validate_props')
      type(c_ptr), value :: props, text
      integer(c_int), value :: n_props, len
      real(c_double), pointer, contiguous :: values(:)
      type(params_t) :: par
      type(mud_status_t) :: status
      character(ADVICE_LENGTH) :: advice

      if (c_associated(props)) then
         call c_f_pointer(props, values, [max(n_props, 0)])
         call read_params(values, par, status)
         if (status%code == MUD_OK) call check_bounds(completed(values), 1, NPROPS, status)
         call check_retention(par%suction%retention_t, status)
      else
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      end if
      c_validate_props = status%code
      advice = ''
      if (status%code == MUD_OK) advice = advice_on(completed(values))
      if (advice == '') advice = report_text(failed_report(status))
      call put(advice, text, len)
   end function c_validate_props

   !> A sentence for a code, also for one that is unknown; always MUD_OK.
   integer(c_int) function c_status_text(code, text, len) bind(c, name='mud_status_text')
      integer(c_int), value :: code, len
      type(c_ptr), value :: text

      call put(status_text(code), text, len)
      c_status_text = MUD_OK
   end function c_status_text

   !> A sentence for a report; MUD_NULL_ARGUMENT without one.
   integer(c_int) function c_message(report_in, text, len) bind(c, name='mud_message')
      type(c_ptr), value :: report_in, text
      integer(c_int), value :: len
      type(report_t), pointer :: report

      c_message = MUD_NULL_ARGUMENT
      if (.not. c_associated(report_in)) return
      call c_f_pointer(report_in, report)
      call put(report_text(report), text, len)
      c_message = MUD_OK
   end function c_message
end module mud_c_api
