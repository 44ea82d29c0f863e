!> Prints the library's tables: PROPS or STATEV as Markdown, the Abaqus blocks, a material namelist.
program mud_describe
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_null_char
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use mud_interface, only: mud_count, mud_text, mud_bounds, mud_version, MUD_PROPS, MUD_STATEV, MUD_NAME, MUD_SYMBOL, &
      MUD_UNIT, MUD_ORIGIN, MUD_MEANING, MUD_INITIAL, MUD_ROTATION, MUD_EVOLUTION
   use arguments, only: option_t, read_command_line, option_given, WORD_LENGTH
   use faults, only: fault_t, raise, EXIT_INPUT
   use texts, only: from_c
   implicit none (type, external)
   character(*), parameter :: USAGE = 'usage: mud_describe props|statev|abaqus|namelist'
   integer, parameter :: BUFFER = 256

   type(option_t) :: options(1) = [option_t('--help', letter='-h', answers=.true.)]
   character(WORD_LENGTH) :: table
   type(fault_t) :: fault

   call read_command_line(options, 'table', USAGE, table, fault)
   if (fault%code == 0 .and. option_given(options, '--help')) then
      call print_help()
   else if (fault%code == 0) then
      select case (table)
      case ('props')
         call print_props()
      case ('statev')
         call print_statev()
      case ('abaqus')
         call print_abaqus()
      case ('namelist')
         call print_namelist()
      case default
         call raise(fault, EXIT_INPUT, 'There is no table '//trim(table)//'; '//USAGE//'.')
      end select
   end if
   if (fault%code /= 0) then
      write (error_unit, '(a)') 'mud_describe: '//trim(fault%text)
      stop fault%code, quiet=.true.
   end if
contains
   subroutine print_help()
      write (output_unit, '(a)') USAGE, &
         '   props, statev   the tables of umat/README.md', &
         '   abaqus          *User material and *Depvar with the default values', &
         '   namelist        a &material group with every parameter, for mud_triax'
   end subroutine print_help

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
      character(BUFFER) :: raw

      raw = c_null_char
      if (mud_text(list, index, field, raw, BUFFER) < 0) raw = c_null_char
      string = from_c(raw)
   end function text

   function version() result(string)
      character(:), allocatable :: string
      character(BUFFER) :: raw

      raw = c_null_char
      if (mud_version(raw, BUFFER) < 0) raw = c_null_char
      string = from_c(raw)
   end function version

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
