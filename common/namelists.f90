! SPDX-License-Identifier: MIT
!> Reads files of namelist groups: `&name`, then `key = value` as often as needed, then `/`. A text stands between
!> quotes of either kind; inside, the same quote is written twice.
!> A plain reader of its own instead of Fortran's namelist input, because the names of materials come from the
!> library's registry and because every refusal has to say the file, the line and the nearest name.
module namelists
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use files, only: read_whole
   use texts, only: lower_case, whole, mark_length, LENGTH, PATH_LENGTH
   implicit none (type, external)
   private
   public :: entry_t, group_t, read_groups, groups_of_text, find_entry, set_entry, set_values, MAX_VALUES

   integer, parameter :: MAX_VALUES = 1000   !< Longest list of values.
   integer, parameter :: LINE_LENGTH = 1024
   character(*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyz'
   character(*), parameter :: NAME_CHARACTERS = LETTERS//'0123456789_'
   character(*), parameter :: TAB = achar(9), RETURN = achar(13), NEW_LINE_ = achar(10)

   !> `key = values`.
   type :: entry_t
      character(LENGTH) :: key = ''        !< Key as written.
      integer :: line = 0
      integer :: count = 0                 !< Number of values.
      character(LENGTH), allocatable :: values(:)
   end type entry_t

   !> `&name ... /`.
   type :: group_t
      character(LENGTH) :: name = ''       !< In lower case.
      character(PATH_LENGTH) :: file = ''
      integer :: line = 0
      integer :: count = 0                 !< Number of entries.
      type(entry_t), allocatable :: entries(:)
   end type group_t

   !> A word that may turn out to be a key (if `=` follows) or a value.
   type :: word_t
      character(LENGTH) :: text = ''
      logical :: quoted = .false.
      logical :: present = .false.
      integer :: line = 0
   end type word_t

contains
   !> Reads all groups of a file, in their order. A file that cannot be read, or a mistake in it, is a fault
   !> (EXIT_INPUT) with file and line; groups is empty if it cannot be read.
   subroutine read_groups(file, groups, fault)
      character(*), intent(in) :: file
      type(group_t), allocatable, intent(out) :: groups(:)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: text
      logical :: good

      call read_whole(file, text, good)
      if (good) then
         call groups_of_text(text, file, groups, fault)
      else
         allocate (groups(0))
         call raise(fault, EXIT_INPUT, trim(file)//': cannot be read; does the file exist?')
      end if
   end subroutine read_groups

   !> Reads all groups of a text of several lines, in their order. A mistake is a fault (EXIT_INPUT) with file and line;
   !> groups has those before it. groups(:) may be empty.
   subroutine groups_of_text(text, file, groups, fault)
      character(*), intent(in) :: text
      character(*), intent(in) :: file   !< File named in errors; its folder is where relative paths begin.
      type(group_t), allocatable, intent(out) :: groups(:)
      type(fault_t), intent(inout) :: fault
      type(word_t) :: pending
      logical :: inside
      integer :: line, first, length

      allocate (groups(0))
      inside = .false.
      line = 0
      first = 1 + mark_length(text)
      do while (first <= len(text) .and. fault%code == 0)
         length = index(text(first:), NEW_LINE_) - 1
         if (length < 0) length = len(text) - first + 1
         line = line + 1
         call read_line(file, line, text(first:first + length - 1), groups, inside, pending, fault)
         first = first + length + 1
      end do
      if (inside) call check_closed(file, groups, fault)
   end subroutine groups_of_text

   subroutine check_closed(file, groups, fault)
      character(*), intent(in) :: file
      type(group_t), intent(in) :: groups(:)
      type(fault_t), intent(inout) :: fault

      if (fault%code /= 0) return   ! the first fault is the one that is told
      call raise(fault, EXIT_INPUT, at_line(file, groups(size(groups))%line)//'the group &'// &
                 trim(groups(size(groups))%name)//' is never closed; end it with a line "/".')
   end subroutine check_closed

   !> Splits a line into tokens and files them.
   subroutine read_line(file, line, text, groups, inside, pending, fault)
      character(*), intent(in) :: file, text
      integer, intent(in) :: line
      type(group_t), allocatable, intent(inout) :: groups(:)
      logical, intent(inout) :: inside
      type(word_t), intent(inout) :: pending
      type(fault_t), intent(inout) :: fault
      integer :: at, last

      if (len_trim(text) >= LINE_LENGTH) then
         call raise(fault, EXIT_INPUT, at_line(file, line)//'the line is longer than '//whole(LINE_LENGTH - 1)// &
                    ' characters; break it.')
         return
      end if
      at = 1
      do while (at <= len_trim(text) .and. fault%code == 0)
         select case (text(at:at))
         case (' ', ',', TAB, RETURN)
            at = at + 1
         case ('!')
            exit
         case ('&')
            last = at + verify(lower_case(text(at + 1:))//' ', NAME_CHARACTERS) - 1
            call open_group(file, line, lower_case(text(at + 1:last)), groups, inside, fault)
            at = last + 1
         case ('/')
            call close_group(file, line, groups, inside, pending, fault)
            at = at + 1
         case ('=')
            call open_entry(file, line, groups, inside, pending, fault)
            at = at + 1
         case ('''', '"')
            last = closing_quote(text, at)
            if (last > len(text)) then
               call raise(fault, EXIT_INPUT, at_line(file, line)//'a quoted text is not closed; add '//text(at:at)//'.')
            else
               call take_word(file, line, unquoted(text(at:last)), .true., groups, inside, pending, fault)
            end if
            at = last + 1
         case default
            last = at + scan(text(at:)//' ', ' ,=/!&''"'//TAB//RETURN) - 2
            call take_word(file, line, text(at:last), .false., groups, inside, pending, fault)
            at = last + 1
         end select
      end do
   end subroutine read_line

   !> Finds the place where the text that is quoted from `first` on ends; beyond the line if it does not. Two quotes do
   !> not end it.
   pure integer function closing_quote(text, first) result(last)
      character(*), intent(in) :: text
      integer, intent(in) :: first

      last = first + 1
      do while (last <= len(text))
         if (text(last:last) == text(first:first)) then
            if (text(last + 1:min(last + 1, len(text))) /= text(first:first)) return
            last = last + 1
         end if
         last = last + 1
      end do
   end function closing_quote

   !> Returns a quoted text without its quotes; two quotes inside are one.
   pure function unquoted(text)
      character(*), intent(in) :: text
      character(:), allocatable :: unquoted
      integer :: i

      unquoted = ''
      i = 2
      do while (i < len(text))
         unquoted = unquoted//text(i:i)
         i = i + merge(2, 1, text(i:i) == text(1:1))
      end do
   end function unquoted

   subroutine open_group(file, line, name, groups, inside, fault)
      character(*), intent(in) :: file, name
      integer, intent(in) :: line
      type(group_t), allocatable, intent(inout) :: groups(:)
      logical, intent(inout) :: inside
      type(fault_t), intent(inout) :: fault
      type(group_t) :: group

      if (inside) then
         call raise(fault, EXIT_INPUT, at_line(file, line)//'&'//name//' begins inside &'// &
                    trim(groups(size(groups))%name)//' of line '//whole(groups(size(groups))%line)// &
                    '; close that group with "/" first.')
         return
      end if
      group%name = name
      group%file = file
      group%line = line
      allocate (group%entries(0))
      groups = [groups, group]
      inside = .true.
   end subroutine open_group

   subroutine close_group(file, line, groups, inside, pending, fault)
      character(*), intent(in) :: file
      integer, intent(in) :: line
      type(group_t), intent(inout) :: groups(:)
      logical, intent(inout) :: inside
      type(word_t), intent(inout) :: pending
      type(fault_t), intent(inout) :: fault

      if (.not. inside) then
         call raise(fault, EXIT_INPUT, at_line(file, line)// &
                    '"/" closes a group, but none is open; quote texts with "/".')
         return
      end if
      call file_value(file, groups, pending, fault)
      if (fault%code == 0) call check_last_entry(file, groups(size(groups)), fault)
      inside = .false.
   end subroutine close_group

   !> `=`: the word before it is a key.
   subroutine open_entry(file, line, groups, inside, pending, fault)
      character(*), intent(in) :: file
      integer, intent(in) :: line
      type(group_t), intent(inout) :: groups(:)
      logical, intent(in) :: inside
      type(word_t), intent(inout) :: pending
      type(fault_t), intent(inout) :: fault
      type(entry_t) :: new
      integer :: n, earlier

      if (.not. (inside .and. pending%present) .or. pending%quoted) then
         call raise(fault, EXIT_INPUT, at_line(file, line)//'"=" without a name before it; write name = value.')
         return
      end if
      n = size(groups)
      call check_last_entry(file, groups(n), fault)
      if (fault%code /= 0) return
      earlier = find_entry(groups(n), pending%text)
      if (earlier > 0) then
         call raise(fault, EXIT_INPUT, at_line(file, pending%line)//trim(pending%text)//' is given twice in &'// &
                    trim(groups(n)%name)//', first in line '//whole(groups(n)%entries(earlier)%line)// &
                       '; keep one of them.')
         return
      end if
      new%key = pending%text
      new%line = pending%line
      allocate (new%values(0))
      groups(n)%entries = [groups(n)%entries, new]
      groups(n)%count = groups(n)%count + 1
      pending%present = .false.
   end subroutine open_entry

   !> A word: the one before it, if any, was a value.
   subroutine take_word(file, line, text, quoted, groups, inside, pending, fault)
      character(*), intent(in) :: file, text
      integer, intent(in) :: line
      logical, intent(in) :: quoted, inside
      type(group_t), intent(inout) :: groups(:)
      type(word_t), intent(inout) :: pending
      type(fault_t), intent(inout) :: fault

      if (.not. inside) then
         call raise(fault, EXIT_INPUT, at_line(file, line)//'"'//trim(text)// &
                    '" stands outside every group; put it between &name and "/", or make it a comment with "!".')
      else if (len(text) > LENGTH) then
         call raise(fault, EXIT_INPUT, at_line(file, line)//'a word is longer than '//whole(LENGTH)//' characters.')
      else
         call file_value(file, groups, pending, fault)
         pending = word_t(text, quoted, .true., line)
      end if
   end subroutine take_word

   !> Adds the pending word to the values of the last entry.
   subroutine file_value(file, groups, pending, fault)
      character(*), intent(in) :: file
      type(group_t), intent(inout) :: groups(:)
      type(word_t), intent(inout) :: pending
      type(fault_t), intent(inout) :: fault
      integer :: n, last

      if (.not. pending%present .or. fault%code /= 0) return
      pending%present = .false.
      n = size(groups)
      last = groups(n)%count
      if (last == 0) then
         call raise(fault, EXIT_INPUT, at_line(file, pending%line)//'"'//trim(pending%text)// &
                    '" has no name; write name = value.')
         return
      end if
      associate (item => groups(n)%entries(last))
         if (item%count == MAX_VALUES) then
            call raise(fault, EXIT_INPUT, at_line(file, pending%line)//trim(item%key)//' has more than '// &
                       whole(MAX_VALUES)//' values; is a "=" missing after '//trim(pending%text)//'?')
         else
            item%count = item%count + 1
            call append(item%values, pending%text)
         end if
      end associate
   end subroutine file_value

   pure subroutine append(values, value)
      character(LENGTH), allocatable, intent(inout) :: values(:)
      character(LENGTH), intent(in) :: value
      character(LENGTH), allocatable :: more(:)

      allocate (more(size(values) + 1))
      more(:size(values)) = values
      more(size(more)) = value
      call move_alloc(more, values)
   end subroutine append

   !> An entry that is complete has a value.
   subroutine check_last_entry(file, group, fault)
      character(*), intent(in) :: file
      type(group_t), intent(in) :: group
      type(fault_t), intent(inout) :: fault

      if (group%count == 0) return
      associate (item => group%entries(group%count))
         if (item%count == 0) then
            call raise(fault, EXIT_INPUT, at_line(file, item%line)//trim(item%key)// &
                       ' has no value; write one after "=" or remove the name.')
         end if
      end associate
   end subroutine check_last_entry

   !> Finds the place of a key among a group's entries, 0 if it is not there; case ignored, as in a namelist.
   pure integer function find_entry(group, key) result(place)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key

      do place = 1, group%count
         if (lower_case(group%entries(place)%key) == lower_case(key)) return
      end do
      place = 0
   end function find_entry

   !> Gives a key one value, in place of those that it had. A key that is new is added; its line is that of the group.
   pure subroutine set_entry(group, key, value)
      type(group_t), intent(inout) :: group
      character(*), intent(in) :: key, value
      character(LENGTH) :: values(1)

      values = value
      call set_values(group, key, values)
   end subroutine set_entry

   !> Sets a key of a group to a list of values, in place of its value.
   pure subroutine set_values(group, key, values)
      type(group_t), intent(inout) :: group
      character(*), intent(in) :: key
      character(LENGTH), intent(in) :: values(:)
      type(entry_t) :: entry

      entry%key = key
      entry%line = group%line
      entry%count = size(values)
      entry%values = values
      if (find_entry(group, key) > 0) then
         group%entries(find_entry(group, key)) = entry
      else
         group%entries = [group%entries(:group%count), entry]
         group%count = group%count + 1
      end if
   end subroutine set_values
end module namelists
