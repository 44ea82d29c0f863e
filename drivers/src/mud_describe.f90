! SPDX-License-Identifier: MIT
!> Prints the library's tables, and a material as another program reads it.
program mud_describe
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use arguments, only: option_t, read_command_line, option_given, option_value, WORD_LENGTH
   use describe_hosts, only: named_material_t, read_material, shorten, print_host, HOSTS
   use describe_tables, only: print_props, print_statev, print_namelist
   use faults, only: fault_t, raise, EXIT_INPUT
   implicit none (type, external)
   character(*), parameter :: USAGE = 'usage: mud_describe props|statev|namelist, or mud_describe HOST '// &
      '[material.nml] [--unit kPa|Pa|MPa|psi|bar]; mud_describe --help names the hosts'

   type(option_t) :: options(2) = [option_t('--help', letter='-h', answers=.true.), &
                                   option_t('--unit', takes='a unit of stress')]
   character(WORD_LENGTH) :: word, file
   type(fault_t) :: fault

   call read_command_line(options, 'table or host', USAGE, word, fault, second=file)
   if (fault%code == 0) call describe()
   if (fault%code /= 0) then
      write (error_unit, '(a)') 'mud_describe: '//trim(fault%text)
      stop fault%code, quiet=.true.
   end if
contains
   subroutine describe()
      type(named_material_t) :: material
      logical :: a_table

      if (option_given(options, '--help')) then
         call print_help()
         return
      end if
      a_table = any(['props   ', 'statev  ', 'namelist'] == word)
      if (.not. a_table .and. .not. any(HOSTS(1, :) == word)) then
         call raise(fault, EXIT_INPUT, 'There is no table and no host '//trim(word)//'; '//USAGE//'.')
      else if (a_table .and. (file /= '' .or. option_given(options, '--unit'))) then
         call raise(fault, EXIT_INPUT, 'The table '//trim(word)//' is that of the library: no material, no unit; '// &
                    USAGE//'.')
      else if (word == 'props') then
         call print_props()
      else if (word == 'statev') then
         call print_statev()
      else if (word == 'namelist') then
         call print_namelist()
      else
         call read_material(trim(file), trim(option_value(options, '--unit')), material, fault)
         if (fault%code == 0 .and. material%doubt /= '') &
            write (error_unit, '(a)') 'mud_describe: warning: '//trim(material%doubt)
         if (fault%code == 0) call shorten(trim(word), material, fault)
         if (fault%code == 0) call print_host(trim(word), material)
      end if
   end subroutine describe

   subroutine print_help()
      integer :: i

      write (output_unit, '(a)') 'usage: mud_describe TABLE', &
         '       mud_describe HOST [material.nml] [--unit UNIT]', '', &
         'Tables of the library:', &
         '   props, statev             as in umat/README.md', &
         '   namelist                  a &material group with every parameter at its default', '', &
         'A material (without a file: the defaults of the library) as another program reads it:'
      write (output_unit, '(3x, a26, a)') (HOSTS(1, i), trim(HOSTS(2, i)), i=1, size(HOSTS, 2))
      write (output_unit, '(a)') '', '--unit kPa, Pa, MPa, psi or bar: what is printed; the unit of a file is that '// &
         'of its p_atm'
   end subroutine print_help
end program mud_describe
