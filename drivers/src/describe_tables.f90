! SPDX-License-Identifier: MIT
!> Tables of the library as Markdown, and a namelist with every parameter.
module describe_tables
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_null_char
   use mud_interface, only: mud_count, mud_text, mud_bounds, mud_version, MUD_PROPS, MUD_STATEV, MUD_NAME, MUD_SYMBOL, &
      MUD_UNIT, MUD_ORIGIN, MUD_MEANING, MUD_INITIAL, MUD_ROTATION, MUD_EVOLUTION
   use texts, only: from_c
   implicit none (type, external)
   private
   public :: print_props, print_statev, print_namelist, text, version, number

   integer, parameter :: BUFFER = 256
   character, parameter :: BACKSLASH = achar(92)
contains
   !> Prints the parameters of the library as a table in Markdown.
   subroutine print_props()
      integer(c_int) :: i
      real(c_double) :: lower, upper, preset

      print '(a)', '| PROPS | name | symbol | unit | bounds | default | origin | meaning |', &
         '|---|---|---|---|---|---|---|---|'
      do i = 0, mud_count(MUD_PROPS) - 1
         if (mud_bounds(MUD_PROPS, i, lower, upper, preset) /= 0) cycle
         print '(a, i0, *(a))', '| ', i + 1, ' | `', text(MUD_PROPS, i, MUD_NAME), '` | ', cell(MUD_PROPS, i, &
            MUD_SYMBOL), ' | ', &
            cell(MUD_PROPS, i, MUD_UNIT), ' | ', number(lower), ' to ', number(upper), ' | ', number(preset), ' | ', &
            cell(MUD_PROPS, i, MUD_ORIGIN), ' | ', cell(MUD_PROPS, i, MUD_MEANING), ' |'
      end do
   end subroutine print_props

   !> Prints the state variables of the library as a table in Markdown, and their number.
   subroutine print_statev()
      integer(c_int) :: i

      print '(a)', '| STATEV | name | symbol | unit | initially | rotates | evolves | origin | meaning |', &
         '|---|---|---|---|---|---|---|---|---|'
      do i = 0, mud_count(MUD_STATEV) - 1
         print '(a, i0, *(a))', '| ', i + 1, ' | `', text(MUD_STATEV, i, MUD_NAME), '` | ', cell(MUD_STATEV, i, &
            MUD_SYMBOL), ' | ', cell(MUD_STATEV, i, MUD_UNIT), ' | ', cell(MUD_STATEV, i, MUD_INITIAL), ' | ', &
            cell(MUD_STATEV, i, MUD_ROTATION), ' | ', cell(MUD_STATEV, i, MUD_EVOLUTION), ' | ', &
            cell(MUD_STATEV, i, MUD_ORIGIN), ' | ', cell(MUD_STATEV, i, MUD_MEANING), ' |'
      end do
   end subroutine print_statev

   !> Prints a group &material with every parameter at its default.
   subroutine print_namelist()
      integer(c_int) :: i
      real(c_double) :: lower, upper, preset

      print '(3a)', '! every parameter of MUD ', version(), ' at its default'
      print '(a)', '&material'
      do i = 0, mud_count(MUD_PROPS) - 1
         if (mud_bounds(MUD_PROPS, i, lower, upper, preset) /= 0) cycle
         print '(*(a))', '   ', text(MUD_PROPS, i, MUD_NAME), ' = ', number(preset), '   ! [', text(MUD_PROPS, i, &
            MUD_UNIT), '] ', &
            number(lower), ' to ', number(upper), ': ', text(MUD_PROPS, i, MUD_MEANING)
      end do
      print '(a)', '/'
   end subroutine print_namelist

   !> One text of the registry. Empty where there is none.
   function text(list, index, field) result(string)
      integer(c_int), intent(in) :: list, index, field   !< MUD_PROPS or MUD_STATEV; from 0; MUD_NAME ...
      character(:), allocatable :: string
      character(BUFFER) :: raw

      raw = c_null_char
      if (mud_text(list, index, field, raw, BUFFER) < 0) raw = c_null_char
      string = from_c(raw)
   end function text

   !> Text of an entry as a cell of a table, whose cells end at a bar.
   function cell(list, index, field) result(string)
      integer(c_int), intent(in) :: list, index, field
      character(:), allocatable :: string, plain
      integer :: i

      plain = text(list, index, field)
      string = ''
      do i = 1, len(plain)
         if (plain(i:i) == '|') string = string//BACKSLASH
         string = string//plain(i:i)
      end do
   end function cell

   !> Version of the library.
   function version() result(string)
      character(:), allocatable :: string
      character(BUFFER) :: raw

      raw = c_null_char
      if (mud_version(raw, BUFFER) < 0) raw = c_null_char
      string = from_c(raw)
   end function version

   !> The shortest of the usual ways to write a number. Large and small ones with three digits, others with six decimals
   !> at most.
   pure function number(value) result(string)
      real(c_double), intent(in) :: value
      character(:), allocatable :: string
      character(24) :: buffer
      integer :: last

      if (abs(value - anint(value)) <= 0.0_c_double .and. abs(value) < 1.0e5_c_double) then
         write (buffer, '(i0)') nint(value)
         string = trim(buffer)//'.0'
      else if (abs(value) >= 1.0e-3_c_double .and. abs(value) < 1.0e5_c_double) then
         write (buffer, '(f0.6)') value
         last = verify(buffer, '0 ', back=.true.)
         string = buffer(:last)
         if (string(1:1) == '.') string = '0'//string
         if (index(string, '-.') == 1) string = '-0'//string(2:)
      else
         write (buffer, '(es9.2)') value
         string = trim(adjustl(buffer))
      end if
   end function number
end module describe_tables
