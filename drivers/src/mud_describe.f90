!> Prints the library's tables: PROPS or STATEV as Markdown, the Abaqus blocks, a material namelist.
program mud_describe
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_char, c_null_char
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mud_interface, only: mud_count, mud_text, mud_bounds, mud_version, MUD_PROPS, MUD_STATEV, MUD_NAME, MUD_SYMBOL, &
      MUD_UNIT, MUD_ORIGIN, MUD_MEANING, MUD_INITIAL, MUD_ROTATION, MUD_EVOLUTION
   implicit none (type, external)
   character(16) :: what

   what = ''
   if (command_argument_count() > 0) call get_command_argument(1, what)
   select case (what)
   case ('props')
      call print_props()
   case ('statev')
      call print_statev()
   case ('abaqus')
      call print_abaqus()
   case ('namelist')
      call print_namelist()
   case ('-h', '--help')
      call print_usage(6)
   case default
      call print_usage(error_unit)
      stop 2, quiet=.true.
   end select
contains
   subroutine print_usage(unit)
      integer, intent(in) :: unit

      write (unit, '(a)') 'usage: mud_describe props|statev|abaqus|namelist', &
         '   props, statev   the tables of umat/README.md', &
         '   abaqus          *User material and *Depvar with the default values', &
         '   namelist        a &material group with every parameter, for mud_triax'
   end subroutine print_usage

   subroutine print_props()
      integer(c_int) :: i
      real(c_double) :: lower, upper, preset

      print '(a)', '| PROPS | name | symbol | unit | bounds | default | origin | meaning |', &
         '|---|---|---|---|---|---|---|---|'
      do i = 0, mud_count(MUD_PROPS) - 1
         if (mud_bounds(MUD_PROPS, i, lower, upper, preset) /= 0) cycle
         print '(a, i0, *(a))', '| ', i + 1, ' | `', text(MUD_PROPS, i, MUD_NAME), '` | ', text(MUD_PROPS, i, &
            MUD_SYMBOL), ' | ', &
            text(MUD_PROPS, i, MUD_UNIT), ' | ', number(lower), ' to ', number(upper), ' | ', number(preset), ' | ', &
            text(MUD_PROPS, i, MUD_ORIGIN), ' | ', text(MUD_PROPS, i, MUD_MEANING), ' |'
      end do
   end subroutine print_props

   subroutine print_statev()
      integer(c_int) :: i

      print '(a)', '| STATEV | name | symbol | unit | initially | rotates | evolves | origin | meaning |', &
         '|---|---|---|---|---|---|---|---|---|'
      do i = 0, mud_count(MUD_STATEV) - 1
         print '(a, i0, *(a))', '| ', i + 1, ' | `', text(MUD_STATEV, i, MUD_NAME), '` | ', text(MUD_STATEV, i, &
            MUD_SYMBOL), ' | ', text(MUD_STATEV, i, MUD_UNIT), ' | ', text(MUD_STATEV, i, MUD_INITIAL), ' | ', &
            text(MUD_STATEV, i, MUD_ROTATION), ' | ', text(MUD_STATEV, i, MUD_EVOLUTION), ' | ', &
            text(MUD_STATEV, i, MUD_ORIGIN), ' | ', text(MUD_STATEV, i, MUD_MEANING), ' |'
      end do
   end subroutine print_statev

   !> Eight values a line, as Abaqus reads them.
   subroutine print_abaqus()
      integer(c_int) :: i, n
      real(c_double) :: lower, upper, preset
      character(:), allocatable :: line

      n = mud_count(MUD_PROPS)
      print '(a, i0)', '*User material, constants=', n
      line = ''
      do i = 0, n - 1
         if (mud_bounds(MUD_PROPS, i, lower, upper, preset) /= 0) cycle
         line = line//number(preset)
         if (mod(i, 8) == 7 .or. i == n - 1) then
            print '(a)', line
            line = ''
         else
            line = line//', '
         end if
      end do
      n = mud_count(MUD_STATEV)
      print '(a)', '*Depvar'
      print '(i0, a)', n, ','
      do i = 0, n - 1
         print '(i0, *(a))', i + 1, ', ', text(MUD_STATEV, i, MUD_NAME), ', "', text(MUD_STATEV, i, MUD_MEANING), '"'
      end do
   end subroutine print_abaqus

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

   !> One text of the registry.
   function text(list, index, field) result(string)
      integer(c_int), intent(in) :: list, index, field
      character(:), allocatable :: string
      character(kind=c_char) :: buffer(256)

      string = ''
      if (mud_text(list, index, field, buffer, size(buffer, kind=c_int)) == 0) string = until_null(buffer)
   end function text

   function version() result(string)
      character(:), allocatable :: string
      character(kind=c_char) :: buffer(32)

      string = ''
      if (mud_version(buffer, size(buffer, kind=c_int)) == 0) string = until_null(buffer)
   end function version

   pure function until_null(buffer) result(string)
      character(kind=c_char), intent(in) :: buffer(:)
      character(:), allocatable :: string
      integer :: i

      string = ''
      do i = 1, size(buffer)
         if (buffer(i) == c_null_char) exit
         string = string//buffer(i)
      end do
   end function until_null

   !> The shortest of the usual ways to write a number.
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
      else
         write (buffer, '(es9.2)') value
         string = trim(adjustl(buffer))
      end if
   end function number
end program mud_describe
