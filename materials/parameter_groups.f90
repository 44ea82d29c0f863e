! SPDX-License-Identifier: MIT
!> Parameters of MUD by name: a group, checked against the library's registry, fills PROPS.
module parameter_groups
   use, intrinsic :: iso_c_binding, only: c_null_char
   use kinds, only: wp
   use mud_interface, only: mud_default_props, mud_validate_props
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use files, only: beside
   use key_schema, only: key_t, check_group, get_number, NONE, UNBOUNDED
   use texts, only: lower_case, short, whole, read_number, word_place, from_c
   use namelists, only: group_t, read_groups, find_entry
   use library_tables, only: property_count, property_index, property_name, property_unit, property_meaning, &
                             property_option, option_words, range_for
   use stress_units, only: stress_unit_t, unit_of_atmosphere, in_unit
   implicit none (type, external)
   private
   public :: read_parameters, group_of_file

   integer, parameter :: BUFFER = 600
   character(*), parameter :: WARNING = 'warning: '   !< The library's sentence begins with it.
   !> Keys that are not parameters.
   character(9), parameter :: TEXT_KEYS(3) = [character(9) :: 'file', 'name', 'reference']
   !> Void ratios and stresses [unit of p_atm] of the tests behind a material: nor are these.
   character(12), parameter :: TESTED_KEYS(4) = [character(12) :: 'tested_e_min', 'tested_e_max', 'tested_p_min', &
                                                 'tested_p_max']
   !> Parameters that switch others on where they are above 0, and how many of these follow each.
   character(10), parameter :: SWITCHES(3) = [character(10) :: 'hysteresis', 'c_chi', 'c_ell']
   integer, parameter :: BEHIND(3) = [5, 2, 3]

contains
   !> Fills PROPS from a group. Its `file`, if any, is read first; the group's own values replace those. props has as
   !> many entries as the library, stresses in the unit of p_atm. A fault (EXIT_INPUT) names what is wrong with file and
   !> line. On a fault props(:) is of no use.
   subroutine read_parameters(group, props, title, doubt, fault, tested)
      type(group_t), intent(in) :: group
      real(wp), allocatable, intent(out) :: props(:)
      character(*), intent(out) :: title   !< Name of the material.
      character(*), intent(out) :: doubt   !< Warning of the library, with its place; blank: none.
      type(fault_t), intent(inout) :: fault
      real(wp), intent(inout), optional :: tested(4)   !< Ranges as TESTED_KEYS; what is not given stays.
      type(group_t) :: own
      character(:), allocatable :: path
      character(len(doubt)) :: doubt_of_file
      real(wp) :: ranges(4)
      integer :: place, i

      title = 'defaults of the library'
      doubt = ''
      ranges = [-huge(1.0_wp), huge(1.0_wp), -huge(1.0_wp), huge(1.0_wp)]
      if (present(tested)) ranges = tested
      allocate (props(property_count()))
      if (mud_default_props(props, size(props)) /= 0) then
         call raise(fault, EXIT_INPUT, 'The library refuses to fill its own defaults; program and '// &
                    'library do not match.')
         return
      end if
      place = find_entry(group, 'file')
      if (place > 0) then
         path = beside(trim(group%file), trim(group%entries(place)%values(1)))
         call group_of_file(path, own, fault)
         if (fault%code /= 0) then
            if (own%line == 0 .and. group%file /= '') &
               fault%text = at_line(group%file, group%entries(place)%line)//fault%text
         else if (find_entry(own, 'file') > 0) then
            call raise(fault, EXIT_INPUT, at_line(path, own%entries(find_entry(own, 'file'))%line)// &
                       'a material file cannot name another file; copy the values instead.')
         else
            call apply_group(own, props, title, doubt, ranges, fault)
         end if
         if (fault%code /= 0) return
      end if
      doubt_of_file = doubt
      call apply_group(group, props, title, doubt, ranges, fault)
      if (present(tested)) tested = ranges
      if (place == 0 .or. fault%code /= 0) return
      if (doubt == '') call look_behind_switches(own, props, doubt)
      do i = 1, group%count
         if (property_index(group%entries(i)%key) > 0) return
      end do
      doubt = doubt_of_file
   end subroutine read_parameters

   !> The group &material of a file. Fault EXIT_INPUT: the file cannot be read, or holds another group or more than one.
   subroutine group_of_file(file, group, fault)
      character(*), intent(in) :: file
      type(group_t), intent(out) :: group   !< Line 0: the file has none.
      type(fault_t), intent(inout) :: fault
      type(group_t), allocatable :: groups(:)

      call read_groups(file, groups, fault)
      if (size(groups) > 0) group = groups(1)
      if (fault%code /= 0) return
      if (size(groups) /= 1) then
         call raise(fault, EXIT_INPUT, trim(file)//': has '//whole(size(groups))// &
                    ' groups; a material file holds exactly one, &material.')
      else if (group%name /= 'material') then
         call raise(fault, EXIT_INPUT, at_line(file, group%line)//'the group is &'//trim(group%name)// &
                    '; a material file holds exactly one, &material.')
      end if
   end subroutine group_of_file

   subroutine apply_group(group, props, title, doubt, tested, fault)
      type(group_t), intent(in) :: group
      real(wp), intent(inout) :: props(:)
      character(*), intent(inout) :: title
      character(*), intent(out) :: doubt
      real(wp), intent(inout) :: tested(4)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: sentence
      character(BUFFER) :: text
      real(wp) :: value
      integer :: i, line, first, at, place
      logical :: allowed, found

      doubt = ''
      ! The unit of the limits is known when p_atm is, wherever it stands.
      place = property_index('p_atm')
      call get_number(group, 'p_atm', value, found)
      if (found) props(place) = value
      call check_group(keys_of_parameters(props, group%name(:12)), group, .false., fault)
      if (fault%code /= 0) return
      do i = 1, group%count
         associate (item => group%entries(i))
            place = property_index(item%key)
            if (place > 0) then
               call read_number(item%values(1), props(place), found)
               if (.not. found) call property_option(place, item%values(1), props(place), found)
            else if (lower_case(item%key) == 'name') then
               title = item%values(1)
            end if
         end associate
      end do
      do i = 1, size(TESTED_KEYS)
         call get_number(group, trim(TESTED_KEYS(i)), tested(i), found)
      end do

      if (tested(1) > tested(2) .or. tested(3) > tested(4)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'tested_e_min and tested_p_min are at most '// &
                    'tested_e_max and tested_p_max.')
         return
      end if

      text = c_null_char
      allowed = mud_validate_props(props, size(props), text, BUFFER) == 0
      sentence = from_c(text)
      if (allowed) call look_behind_switches(group, props, doubt)
      if (allowed .and. index(sentence, WARNING) /= 1) return
      line = group%line
      first = len(sentence) + 1
      do i = 1, group%count
         at = word_place(sentence, group%entries(i)%key)
         if (at == 0 .or. at > first) cycle
         first = at
         line = group%entries(i)%line
      end do
      if (allowed) then
         doubt = at_line(group%file, line)//sentence(len(WARNING) + 1:)
      else
         call raise(fault, EXIT_INPUT, at_line(group%file, line)//sentence)
      end if
   end subroutine apply_group

   !> Doubt about the first parameter of a group that was changed behind a switch that is off.
   subroutine look_behind_switches(group, props, doubt)
      type(group_t), intent(in) :: group
      real(wp), intent(in) :: props(:)
      character(*), intent(inout) :: doubt
      real(wp) :: defaults(size(props))
      integer :: i, k, at

      if (mud_default_props(defaults, size(defaults)) /= 0) return
      do i = 1, size(SWITCHES)
         at = property_index(trim(SWITCHES(i)))
         if (props(at) > 0.0_wp) cycle
         do k = at + 1, at + BEHIND(i)
            if (find_entry(group, property_name(k)) == 0 .or. abs(props(k) - defaults(k)) <= 0.0_wp) cycle
            doubt = at_line(group%file, group%entries(find_entry(group, property_name(k)))%line)// &
                    property_name(k)//' has no effect with '//trim(SWITCHES(i))//' = 0.'
            return
         end do
      end do
   end subroutine look_behind_switches

   !> Keys of a group of parameters, with their limits in the unit of stress that p_atm tells.
   function keys_of_parameters(props, group) result(keys)
      real(wp), intent(in) :: props(:)
      character(*), intent(in) :: group
      type(key_t), allocatable :: keys(:)
      character(*), parameter :: TESTED = 'range of void ratio [-] or stress of the tests behind the material'
      character(:), allocatable :: unit
      type(stress_unit_t) :: stress
      real(wp) :: lower, upper, preset
      integer :: i

      stress = unit_of_atmosphere(props(property_index('p_atm')))
      keys = [(key_t(group, TEXT_KEYS(i), 't', NONE, 0, 0, 'a text in quotes'), i=1, size(TEXT_KEYS)), &
              (key_t(group, TESTED_KEYS(i), 'n', NONE, 0, UNBOUNDED, TESTED), i=1, size(TESTED_KEYS))]
      do i = 1, property_count()
         call range_for(props, i, lower, upper, preset)
         unit = ''
         if (property_unit(i) /= '1') unit = in_unit(property_unit(i), stress)
         keys = [keys, key_t(group, property_name(i), 'n', short(preset), lower, upper, &
                             property_meaning(i)//'; default '//short(preset), option_words(i), unit)]
      end do
   end function keys_of_parameters
end module parameter_groups
