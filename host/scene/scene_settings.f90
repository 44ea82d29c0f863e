! SPDX-License-Identifier: MIT
!> Keys of a scene that are set from outside, as by the command line: GROUP.KEY=VALUE.
module scene_settings
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: texts_of
   use namelists, only: group_t, groups_of_text, set_values
   use spelling, only: nearest_name
   use texts, only: lower_case, whole, LENGTH
   implicit none (type, external)
   private
   public :: apply_settings

   character(*), parameter :: FORM = 'write GROUP.KEY=VALUE, as mesh.fineness=2; of groups that occur '// &
      'several times GROUP[2].KEY=VALUE sets the second, GROUP[sand].KEY=VALUE the one with this name, '// &
      'GROUP.KEY=VALUE all.'
contains
   !> Sets keys as if the scene said so, in the order of the list; they are checked with the others. Fault EXIT_INPUT: a
   !> setting cannot be read, or the scene has no such group.
   subroutine apply_settings(settings, groups, fault)
      character(*), intent(in) :: settings(:)     !< As 'stage.duration=2', values of a list divided by commas.
      type(group_t), intent(inout) :: groups(:)   !< (groups of the scene)
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(settings)
         if (fault%code == 0) call apply(trim(settings(i)))
      end do
   contains
      subroutine apply(setting)
         character(*), intent(in) :: setting
         character(:), allocatable :: name, which, key
         type(group_t), allocatable :: parsed(:)
         logical :: chosen(size(groups))
         integer :: equals, point, g

         equals = index(setting, '=')
         point = index(setting(:max(equals, 1)), '.', back=.true.)
         if (point < 2 .or. equals < point + 2 .or. equals == len(setting)) then
            call raise(fault, EXIT_INPUT, 'The setting '//setting//' cannot be read; '//FORM)
            return
         end if
         name = lower_case(setting(:point - 1))
         which = ''
         if (index(name, '[') > 1 .and. setting(point - 1:point - 1) == ']') then
            which = setting(index(name, '[') + 1:point - 2)
            name = name(:index(name, '[') - 1)
         end if
         key = setting(point + 1:equals - 1)
         chosen = groups%name == name
         if (.not. any(chosen)) then
            call raise(fault, EXIT_INPUT, 'The setting '//setting//': the scene has no group &'//name// &
                       '; the nearest that it has is &'//trim(groups(nearest_name(name, groups%name))%name)//'.')
            return
         end if
         if (which /= '') chosen = chosen .and. is_meant(which, chosen)
         if (.not. any(chosen)) then
            call raise(fault, EXIT_INPUT, 'The setting '//setting//': the scene has '//whole(count(groups%name == &
                       name))//' &'//name//', none of them is '//which//'; '//FORM)
            return
         end if
         call groups_of_text('&'//name//' '//key//' = '//quoted(setting(equals + 1:))//' /', &
                             'The setting '//setting, parsed, fault)
         if (fault%code == 0 .and. (size(parsed) /= 1 .or. parsed(1)%count /= 1)) call raise(fault, EXIT_INPUT, &
            'The setting '//setting//' holds more than one key; '//FORM)
         if (fault%code /= 0) return
         do g = 1, size(groups)
            if (chosen(g)) call set_values(groups(g), key, parsed(1)%entries(1)%values)
         end do
      end subroutine apply

      !> Groups with this number among their kind, or with this name.
      function is_meant(which, kind) result(meant)
         character(*), intent(in) :: which
         logical, intent(in) :: kind(:)
         logical :: meant(size(kind))
         character(LENGTH), allocatable :: names(:)
         integer :: g

         do g = 1, size(kind)
            names = texts_of(groups(g), 'name')
            meant(g) = which == whole(count(kind(:g)))
            if (size(names) == 1) meant(g) = meant(g) .or. names(1) == which
         end do
      end function is_meant
   end subroutine apply_settings

   !> Puts values between commas in quotes, each without the blanks around it, so that a path needs none. A text that
   !> has quotes stays.
   pure function quoted(values) result(text)
      character(*), intent(in) :: values
      character(:), allocatable :: text
      integer :: first, last

      text = values
      if (scan(values, '''"') > 0) return
      text = ''
      first = 1
      do while (first <= len(values) + 1)
         last = first + index(values(first:)//',', ',') - 2
         text = text//''','''//trim(adjustl(values(first:last)))
         first = last + 2
      end do
      text = text(3:)//''''
   end function quoted
end module scene_settings
