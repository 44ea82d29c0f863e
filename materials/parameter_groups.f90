! SPDX-License-Identifier: MIT
!> Parameters of MUD by name: a group, checked against the library's registry, fills PROPS.
module parameter_groups
   use, intrinsic :: iso_c_binding, only: c_null_char
   use kinds, only: wp
   use mud_interface, only: mud_default_props, mud_validate_props
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: lower_case, short, whole, read_number, word_place, from_c, LENGTH
   use namelists, only: group_t, entry_t, read_groups, find_entry
   use spelling, only: nearest_name
   use library_tables, only: property_count, property_index, property_name, property_unit, property_meaning, &
                             property_option, range_for
   use stress_units, only: unit_of_atmosphere, in_unit
   implicit none (type, external)
   private
   public :: read_parameters

   integer, parameter :: BUFFER = 600
   character(*), parameter :: WARNING = 'warning: '   !< The library's sentence begins with it.
   !> Keys that are not parameters.
   character(9), parameter :: TEXT_KEYS(3) = [character(9) :: 'file', 'name', 'reference']
   !> Void ratios and stresses [unit of p_atm] of the tests behind a material: nor are these.
   character(12), parameter :: TESTED_KEYS(4) = [character(12) :: 'tested_e_min', 'tested_e_max', 'tested_p_min', &
                                                 'tested_p_max']

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
      type(group_t), allocatable :: groups(:)
      character(:), allocatable :: path
      character(len(doubt)) :: doubt_of_file
      real(wp) :: ranges(4)
      integer :: place

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
         path = trim(group%entries(place)%values(1))
         if (path(1:1) /= '/') path = folder_of(group%file)//path
         call read_groups(path, groups, fault)
         if (fault%code /= 0) then
            if (size(groups) == 0) fault%text = at_line(group%file, group%entries(place)%line)//fault%text
            return
         end if
         if (size(groups) /= 1) then
            call raise(fault, EXIT_INPUT, path//': has '//whole(size(groups))// &
                       ' groups; a material file holds exactly one, &material.')
         else if (groups(1)%name /= 'material') then
            call raise(fault, EXIT_INPUT, at_line(path, groups(1)%line)//'the group is &'//trim(groups(1)%name)// &
                       '; a material file holds exactly one, &material.')
         else if (find_entry(groups(1), 'file') > 0) then
            call raise(fault, EXIT_INPUT, at_line(path, groups(1)%entries(find_entry(groups(1), 'file'))%line)// &
                       'a material file cannot name another file; copy the values instead.')
         else
            call apply_group(groups(1), props, title, doubt, ranges, fault)
         end if
         if (fault%code /= 0) return
      end if
      doubt_of_file = doubt
      call apply_group(group, props, title, doubt, ranges, fault)
      if (present(tested)) tested = ranges
      if (place > 0 .and. .not. has_parameters(group)) doubt = doubt_of_file
   end subroutine read_parameters

   !> Whether a group has entries beside its texts.
   pure logical function has_parameters(group) result(has)
      type(group_t), intent(in) :: group
      integer :: i

      has = .false.
      do i = 1, group%count
         has = has .or. .not. (any(TEXT_KEYS == lower_case(group%entries(i)%key)) .or. &
                               any(TESTED_KEYS == lower_case(group%entries(i)%key)))
      end do
   end function has_parameters

   !> Folder of a file, with its closing slash; empty if the file is in the present one.
   pure function folder_of(file) result(folder)
      character(*), intent(in) :: file
      character(:), allocatable :: folder

      folder = file(:index(file, '/', back=.true.))
   end function folder_of

   subroutine apply_group(group, props, title, doubt, tested, fault)
      type(group_t), intent(in) :: group
      real(wp), intent(inout) :: props(:)
      character(*), intent(inout) :: title
      character(*), intent(out) :: doubt
      real(wp), intent(inout) :: tested(4)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: sentence
      character(BUFFER) :: text
      integer :: i, line, first, at
      logical :: allowed

      doubt = ''
      do i = 1, group%count
         associate (item => group%entries(i))
            if (any(TEXT_KEYS == lower_case(item%key))) then
               if (item%count /= 1) then
                  call raise(fault, EXIT_INPUT, at_line(group%file, item%line)//trim(item%key)// &
                             ' is one text; put it in quotes.')
               else if (lower_case(item%key) == 'name') then
                  title = item%values(1)
               end if
            else if (any(TESTED_KEYS == lower_case(item%key))) then
               call set_tested(group%file, item, tested, fault)
            else
               call set_property(group%file, item, props, fault)
            end if
         end associate
         if (fault%code /= 0) return
      end do

      if (tested(1) > tested(2) .or. tested(3) > tested(4)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'tested_e_min and tested_p_min are at most '// &
                    'tested_e_max and tested_p_max.')
         return
      end if

      ! the unit of the limits is known when p_atm is, which may stand behind them
      do i = 1, group%count
         call check_range(group%file, group%entries(i), props, fault)
         if (fault%code /= 0) return
      end do

      text = c_null_char
      allowed = mud_validate_props(props, size(props), text, BUFFER) == 0
      sentence = from_c(text)
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

   subroutine set_tested(file, item, tested, fault)
      character(*), intent(in) :: file
      type(entry_t), intent(in) :: item
      real(wp), intent(inout) :: tested(4)
      type(fault_t), intent(inout) :: fault
      real(wp) :: value
      logical :: good

      good = item%count == 1
      if (good) call read_number(item%values(1), value, good)
      if (good) good = value >= 0.0_wp
      if (good) tested(findloc(TESTED_KEYS, lower_case(item%key), dim=1)) = value
      if (.not. good) call raise(fault, EXIT_INPUT, at_line(file, item%line)//trim(item%key)//' is one number of 0 '// &
                                 'or more: the range of void ratio [-] or stress of the tests behind the material.')
   end subroutine set_tested

   subroutine set_property(file, item, props, fault)
      character(*), intent(in) :: file
      type(entry_t), intent(in) :: item
      real(wp), intent(inout) :: props(:)
      type(fault_t), intent(inout) :: fault
      real(wp) :: value
      integer :: place, near
      logical :: good

      place = property_index(item%key)
      if (place < 1) then
         near = nearest_property(item%key)
         call raise(fault, EXIT_INPUT, at_line(file, item%line)//'there is no parameter '//trim(item%key)// &
                    '; the nearest is '// &
                    property_name(near)//' ('//described_range(near, props)//').')
         return
      end if
      if (item%count /= 1) then
         call raise(fault, EXIT_INPUT, at_line(file, item%line)//property_name(place)//' takes one value, '// &
                    whole(item%count)//' are given ('//described_range(place, props)//').')
         return
      end if
      call read_number(item%values(1), value, good)
      if (.not. good) call property_option(place, item%values(1), value, good)
      if (.not. good) then
         call raise(fault, EXIT_INPUT, at_line(file, item%line)//property_name(place)//' = '//trim(item%values(1))// &
                    ' is neither a number nor one of its words ('//described_range(place, props)//').')
         return
      end if
      props(place) = value
   end subroutine set_property

   !> Refuses a parameter outside its range in the unit of p_atm.
   subroutine check_range(file, item, props, fault)
      character(*), intent(in) :: file
      type(entry_t), intent(in) :: item
      real(wp), intent(in) :: props(:)
      type(fault_t), intent(inout) :: fault
      real(wp) :: lower, upper, preset
      integer :: place

      place = property_index(item%key)
      if (place < 1) return
      call range_for(props, place, lower, upper, preset)
      if (props(place) < lower .or. props(place) > upper) &
         call raise(fault, EXIT_INPUT, at_line(file, item%line)//property_name(place)//' = '//trim(item%values(1))// &
                    ' is outside its range ('//described_range(place, props)//').')
   end subroutine check_range

   !> "from 0.001 to 10000, default 12: kinematic hardening constant, eq. (13)"
   function described_range(place, props) result(text)
      integer, intent(in) :: place
      real(wp), intent(in) :: props(:)   !< PROPS, of which p_atm tells the unit.
      character(:), allocatable :: text
      real(wp) :: lower, upper, preset

      call range_for(props, place, lower, upper, preset)
      text = 'from '//short(lower)//' to '//short(upper)
      if (property_unit(place) /= '1') text = text//' '//in_unit(property_unit(place), &
                                                         unit_of_atmosphere(props(property_index('p_atm'))))
      text = text//', default '//short(preset)//': '//property_meaning(place)
   end function described_range

   !> Place of the parameter whose name looks most like a word.
   integer function nearest_property(word) result(best)
      character(*), intent(in) :: word
      character(LENGTH), allocatable :: names(:)
      integer :: i

      allocate (names(property_count()))
      do i = 1, size(names)
         names(i) = property_name(i)
      end do
      best = nearest_name(word, names)
   end function nearest_property
end module parameter_groups
