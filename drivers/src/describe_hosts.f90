! SPDX-License-Identifier: MIT
!> A material as other programs read it: cards, JSON, XML and plain numbers. Every number is written with as many digits
!> as bring back its bits.
module describe_hosts
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: output_unit
   use describe_tables, only: number
   use faults, only: fault_t, raise, EXIT_INPUT
   use kinds, only: wp
   use library_tables, only: library_version, property_index, property_name, property_unit, statev_name, state_count, &
      table_text
   use mud_interface, only: mud_convert_props, MUD_STATEV, MUD_MEANING
   use namelists, only: group_t
   use parameter_groups, only: read_parameters, group_of_file
   use stress_units, only: stress_unit_t, unit_named, unit_of_atmosphere, in_unit, UNIT_NAMES
   use texts, only: joined, whole
   implicit none (type, external)
   private
   public :: named_material_t, read_material, shorten, print_host, HOSTS

   !> Words for the hosts, and what is printed.
   character(66), parameter :: HOSTS(2, 10) = reshape([character(66) :: &
      'abaqus', '*User material and *Depvar', &
      'calculix', '*MATERIAL cards with the behaviour of libMUD.so', &
      'kratos', 'MaterialParameters.json, by umat_ (shear_order is set to 1)', &
      'kratos-udsm', 'MaterialParameters.json, by user_mod_', &
      'ogs', 'constitutive_relation and parameters of a .prj, behaviour MUD', &
      'ogs-unsaturated', 'the same, behaviour MUD_StressSaturation', &
      'incrementaldriver', 'parameters.inp', &
      'incrementaldriver-start', 'initialconditions.inp at an isotropic stress of -100', &
      'udsm', 'number, name, unit and value of each PLAXIS parameter', &
      'plain', 'PROPS, a number a line'], [2, 10])
   !> Hosts that take PROPS without hysteresis, preloading and fluidity alone.
   character(*), parameter :: WITHOUT_HYSTERESIS(4) = [character(len(HOSTS)) :: 'ogs', 'ogs-unsaturated', 'udsm', &
      'kratos-udsm']
   integer, parameter :: A_LINE = 8          !< Numbers of a card.
   real(wp), parameter :: EXAMPLE_STRESS = -100.0_wp   !< [kPa]

   !> PROPS, their name, and the unit of their stresses.
   type :: named_material_t
      real(wp), allocatable :: props(:)
      character(200) :: title = ''
      character(500) :: doubt = ''   !< Warning of the library; blank: none.
      type(stress_unit_t) :: unit
   end type named_material_t
contains
   !> The &material group of a file (blank: the library's defaults), in its own or in another unit of stress. Fault
   !> EXIT_INPUT: the file cannot be read, holds another group or more than one, the unit is unknown, or the library
   !> refuses a value.
   subroutine read_material(file, unit, material, fault)
      character(*), intent(in) :: file, unit   !< Unit blank: that of the file, which p_atm tells.
      type(named_material_t), intent(out) :: material
      type(fault_t), intent(inout) :: fault
      type(group_t) :: group
      type(stress_unit_t) :: wanted

      allocate (group%entries(0))
      if (file /= '') call group_of_file(file, group, fault)
      if (fault%code == 0) call read_parameters(group, material%props, material%title, material%doubt, fault)
      if (fault%code /= 0) return
      material%unit = unit_of_atmosphere(material%props(property_index('p_atm')))
      if (unit == '') return
      wanted = unit_named(unit)
      if (.not. wanted%factor > 0.0_wp) then
         call raise(fault, EXIT_INPUT, 'There is no unit '//trim(unit)//'; one of '//joined(UNIT_NAMES, ', ')//'.')
      else if (mud_convert_props(material%props, size(material%props), wanted%factor/material%unit%factor) /= 0) then
         call raise(fault, EXIT_INPUT, 'The library refuses the material in '//trim(unit)//'.')
      else
         material%unit = wanted
      end if
   end subroutine read_material

   !> Leaves out what stands behind hysteresis, c_chi or c_ell where these are off: every host takes PROPS without it,
   !> and hosts that name PROPS one by one (MFront) or have room for 50 (PLAXIS) take no others. Fault EXIT_INPUT: one
   !> is on, and the host takes none.
   subroutine shorten(host, material, fault)
      character(*), intent(in) :: host
      type(named_material_t), intent(inout) :: material
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: SWITCHES(3) = [character(10) :: 'hysteresis', 'c_chi', 'c_ell']
      character(*), parameter :: WORDS(3) = [character(15) :: 'hysteresis is 1', 'c_chi is on', 'c_ell is on']
      integer :: i, kept
      logical :: on

      kept = 0
      do i = size(SWITCHES), 1, -1
         on = material%props(property_index(trim(SWITCHES(i)))) > 0.0_wp
         if (on .and. any(WITHOUT_HYSTERESIS == host)) then
            call raise(fault, EXIT_INPUT, trim(WORDS(i))//', and '//trim(host)// &
                       ' takes PROPS without it; set it to 0.')
            return
         end if
         if (on .and. kept == 0) kept = size(material%props)
         if (.not. on .and. kept == 0) then
            material%props = material%props(:property_index(trim(SWITCHES(i))) - 1)
         end if
      end do
   end subroutine shorten

   !> Prints what a host reads. The word is one of HOSTS. Numbers in the unit of the material.
   subroutine print_host(host, material)
      character(*), intent(in) :: host
      type(named_material_t), intent(in) :: material
      integer :: i

      select case (host)
      case ('abaqus')
         call print_abaqus(material)
      case ('calculix')
         call print_calculix(material)
      case ('kratos')
         call print_kratos(material, .false.)
      case ('kratos-udsm')
         call print_kratos(material, .true.)
      case ('ogs')
         call print_ogs(material, 'MUD')
      case ('ogs-unsaturated')
         call print_ogs(material, 'MUD_StressSaturation')
      case ('incrementaldriver', 'plain')
         ! what follows # in the first line is a remark
         if (host /= 'plain') write (output_unit, '(a)') 'MUD # '//headline(material), whole(size(material%props))
         write (output_unit, '(a)') (exact(material%props(i)), i=1, size(material%props))
      case ('incrementaldriver-start')
         call print_driver_start(material)
      case ('udsm')
         call print_udsm(material)
      end select
   end subroutine print_host

   !> Writes eight values a line, as Abaqus reads them, and the state variables with their names.
   subroutine print_abaqus(material)
      type(named_material_t), intent(in) :: material
      integer(c_int) :: i

      write (output_unit, '(2a)') '*User material, constants=', whole(size(material%props))
      call print_cards(material%props, '', '')
      write (output_unit, '(a)') '*Depvar'
      write (output_unit, '(2a)') whole(state_count(material%props)), ','
      do i = 1, state_count(material%props)
         write (output_unit, '(*(a))') whole(i), ', ', statev_name(i), ', "', table_text(MUD_STATEV, i, MUD_MEANING), &
            '"'
      end do
   end subroutine print_abaqus

   subroutine print_calculix(material)
      type(named_material_t), intent(in) :: material

      write (output_unit, '(a)') '** '//headline(material)
      write (output_unit, '(a)') '** @: CalculiX loads libMUD.so, a copy of libmud.so on LD_LIBRARY_PATH. Static:', &
         '** NAME=ABAQUS_MUD. Initial stress: *INITIAL CONDITIONS, TYPE=STRESS; void ratio and suction of a point:', &
         '** TYPE=SOLUTION, state variables 2 and 4, the others 0. Its reader ends after one point where there are', &
         '** more than six: a card for every point, two lines long (six entries, then 0.). Warnings can be ignored.', &
         '*MATERIAL, NAME=@ABAQUS_MUD'
      write (output_unit, '(2a)') '*USER MATERIAL, CONSTANTS=', whole(size(material%props))
      call print_cards(material%props, '', '')
      write (output_unit, '(a)') '*DEPVAR', whole(state_count(material%props))
   end subroutine print_calculix

   !> Writes one entry of "properties", with the Variables that carry the soil.
   subroutine print_kratos(material, by_udsm)
      type(named_material_t), intent(in) :: material
      logical, intent(in) :: by_udsm
      real(wp) :: props(size(material%props))
      real(wp), allocatable :: state(:)

      props = material%props
      if (.not. by_udsm) props(property_index('shear_order')) = 1.0_wp
      allocate (state(state_count(material%props)), source=0.0_wp)
      write (output_unit, '(a)') '{"properties": [{', '   "model_part_name": "PorousDomain.Soil",', &
         '   "properties_id": 1,', '   "Material": {'
      write (output_unit, '(3a)') '      "constitutive_law": {"name": "SmallStrain', merge('UDSM', 'UMAT', by_udsm), &
         '3DLaw"},'
      write (output_unit, '(a)') '      "Variables": {', '         "UDSM_NAME": "libmud.so",'
      if (by_udsm) write (output_unit, '(a)') '         "UDSM_NUMBER": 1,'
      write (output_unit, '(a)') '         "IS_FORTRAN_UDSM": true,', '         "UMAT_PARAMETERS": ['
      call print_cards(props, repeat(' ', 12), ',')
      if (by_udsm) then
         write (output_unit, '(a)') '         ]'
      else
         write (output_unit, '(a)') '         ],', '         "STATE_VARIABLES": ['
         call print_cards(state, repeat(' ', 12), ',')
         write (output_unit, '(a)') '         ]'
      end if
      write (output_unit, '(a)') '      },', '      "Tables": {}', '   }', '}]}'
   end subroutine print_kratos

   !> Writes two pieces of a .prj: into <process>, and into <parameters>.
   subroutine print_ogs(material, behaviour)
      type(named_material_t), intent(in) :: material
      character(*), intent(in) :: behaviour
      integer :: i

      write (output_unit, '(a)') '<!-- '//headline(material)//' -->', '<!-- into <process> -->', &
         '<constitutive_relation>', '    <type>MFront</type>', '    <library>libmud.so</library>', &
         '    <behaviour>'//behaviour//'</behaviour>', '    <material_properties>'
      do i = 1, size(material%props)
         write (output_unit, '(5a)') '        <material_property name="', property_name(i), '" parameter="mud_', &
            property_name(i), '"/>'
      end do
      write (output_unit, '(a)') '    </material_properties>', '</constitutive_relation>', '<!-- into <parameters> -->'
      do i = 1, size(material%props)
         write (output_unit, '(5a)') '<parameter><name>mud_', property_name(i), '</name><type>Constant</type><value>', &
            exact(material%props(i)), '</value></parameter>'
      end do
   end subroutine print_ogs

   !> Stress of six components, then STATEV with the void ratio of the material.
   subroutine print_driver_start(material)
      type(named_material_t), intent(in) :: material
      real(wp) :: stress
      integer :: i

      stress = EXAMPLE_STRESS*material%unit%factor
      write (output_unit, '(a)') '6', (exact(stress), i=1, 3), '0.0', '0.0', '0.0', whole(state_count(material%props))
      do i = 1, state_count(material%props)
         if (statev_name(i) == 'void_ratio') then
            write (output_unit, '(a)') exact(material%props(property_index('e_0')))
         else
            write (output_unit, '(a)') '0.0'
         end if
      end do
   end subroutine print_driver_start

   subroutine print_udsm(material)
      type(named_material_t), intent(in) :: material
      character(:), allocatable :: unit
      integer :: i

      write (output_unit, '(a)') headline(material)
      do i = 1, size(material%props)
         unit = in_unit(property_unit(i), material%unit)
         if (unit == '1') unit = '-'
         write (output_unit, '(a, t6, a, t24, a, t36, a)') whole(i), property_name(i), unit, exact(material%props(i))
      end do
   end subroutine print_udsm

   !> Writes numbers, eight a line.
   subroutine print_cards(values, indent, ends)
      real(wp), intent(in) :: values(:)
      character(*), intent(in) :: indent, ends   !< Before a line; behind one that another follows.
      character(:), allocatable :: line
      integer :: i

      line = indent
      do i = 1, size(values)
         line = line//exact(values(i))
         if (i == size(values)) then
            write (output_unit, '(a)') line
         else if (mod(i, A_LINE) == 0) then
            write (output_unit, '(a)') line//ends
            line = indent
         else
            line = line//', '
         end if
      end do
   end subroutine print_cards

   !> Writes name and origin of a material, on a line.
   function headline(material) result(line)
      type(named_material_t), intent(in) :: material
      character(:), allocatable :: line

      line = 'MUD '//library_version()//', '//trim(material%title)//', stresses in '//trim(material%unit%name)
   end function headline

   !> Writes a value in as few digits as read back to the same bits: as `number` writes it where that is enough, else in
   !> up to 17 of them.
   function exact(value) result(string)
      real(wp), intent(in) :: value
      character(:), allocatable :: string
      character(24) :: buffer
      character(10) :: form
      real(wp) :: back
      integer :: digits, status

      string = number(value)
      read (string, *, iostat=status) back
      if (status == 0 .and. abs(back - value) <= 0.0_wp) return
      do digits = 2, 16
         write (form, '(a, i0, a)') '(es24.', digits, ')'
         write (buffer, form) value
         read (buffer, *, iostat=status) back
         if (status == 0 .and. abs(back - value) <= 0.0_wp) exit
      end do
      string = trim(adjustl(buffer))
   end function exact
end module describe_hosts
