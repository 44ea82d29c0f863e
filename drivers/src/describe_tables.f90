! SPDX-License-Identifier: MIT
!> Tables of the library as Markdown, and a namelist with every parameter.
module describe_tables
   use, intrinsic :: iso_c_binding, only: c_int, c_double
   use library_tables, only: library_version, property_count, property_name, property_unit, property_meaning, &
      property_range, statev_name, table_text
   use mud_interface, only: mud_count, MUD_PROPS, MUD_STATEV, MUD_SYMBOL, MUD_UNIT, MUD_ORIGIN, MUD_MEANING, &
      MUD_INITIAL, MUD_ROTATION, MUD_EVOLUTION
   use texts, only: whole
   implicit none (type, external)
   private
   public :: print_props, print_statev, print_namelist, number

   character, parameter :: BACKSLASH = achar(92)
contains
   !> Prints the parameters of the library as a table in Markdown.
   subroutine print_props()
      integer(c_int) :: i
      real(c_double) :: lower, upper, preset

      print '(a)', '| PROPS | name | symbol | unit | bounds | default | origin | meaning |', &
         '|---|---|---|---|---|---|---|---|'
      do i = 1, property_count()
         call property_range(i, lower, upper, preset)
         print '(a)', '| '//whole(i)//' | `'//property_name(i)//'` |'//cells(MUD_PROPS, i, [MUD_SYMBOL, MUD_UNIT])// &
            ' '//number(lower)//' to '//number(upper)//' | '//number(preset)//' |'// &
            cells(MUD_PROPS, i, [MUD_ORIGIN, MUD_MEANING])
      end do
   end subroutine print_props

   !> Prints the state variables of the library as a table in Markdown, and their number.
   subroutine print_statev()
      integer(c_int) :: i

      print '(a)', '| STATEV | name | symbol | unit | initially | rotates | evolves | origin | meaning |', &
         '|---|---|---|---|---|---|---|---|---|'
      do i = 1, mud_count(MUD_STATEV)
         print '(a)', '| '//whole(i)//' | `'//statev_name(i)//'` |'//cells(MUD_STATEV, i, [MUD_SYMBOL, MUD_UNIT, &
            MUD_INITIAL, MUD_ROTATION, MUD_EVOLUTION, MUD_ORIGIN, MUD_MEANING])
      end do
   end subroutine print_statev

   !> Prints a group &material with every parameter at its default.
   subroutine print_namelist()
      integer(c_int) :: i
      real(c_double) :: lower, upper, preset

      print '(3a)', '! every parameter of MUD ', library_version(), ' at its default'
      print '(a)', '&material'
      do i = 1, property_count()
         call property_range(i, lower, upper, preset)
         print '(*(a))', '   ', property_name(i), ' = ', number(preset), '   ! [', property_unit(i), '] ', &
            number(lower), ' to ', number(upper), ': ', property_meaning(i)
      end do
      print '(a)', '/'
   end subroutine print_namelist

   !> Texts of an entry as cells of a table, which end at a bar.
   function cells(list, place, fields) result(line)
      integer(c_int), intent(in) :: list, place, fields(:)
      character(:), allocatable :: line, plain
      integer :: k, i

      line = ''
      do k = 1, size(fields)
         plain = table_text(list, place, fields(k))
         line = line//' '
         do i = 1, len(plain)
            if (plain(i:i) == '|') line = line//BACKSLASH
            line = line//plain(i:i)
         end do
         line = line//' |'
      end do
   end function cells

   !> Finds the shortest of the usual ways to write a number. Large and small ones with three digits, others with six
   !> decimals at most.
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
