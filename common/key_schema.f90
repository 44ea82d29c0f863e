! SPDX-License-Identifier: MIT
!> Keys of input files, with kind, default, range or words, and meaning: checks, templates and help texts come from a
!> list of them, which key_table makes.
module key_schema
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: lower_case, short, whole, read_number, LENGTH
   use spelling, only: nearest_name
   use namelists, only: group_t, entry_t, find_entry
   implicit none (type, external)
   private
   public :: key_t, REQUIRED, NONE, UNBOUNDED, LONGEST_WORD
   public :: check_group, refuse_idle_keys, idle_reason, lacking, place_of, described, words_of
   public :: given, line_of, texts_of, numbers_of, get_text, get_number

   character(*), parameter :: NONE = '', REQUIRED = '*'   !< Defaults of a key that may be left out, or must be given.
   real(wp), parameter :: UNBOUNDED = 1.0e30_wp           !< A bound of this size is none.
   character, parameter :: BETWEEN = '|'                  !< Divides words.
   integer, parameter :: LONGEST_WORD = 32

   !> A key of a group. A text that fills its component may have been cut: a test keeps the last letter of each blank.
   type :: key_t
      character(12) :: group
      character(24) :: name
      character :: kind                  !< n number, i integer, t text, w one of the words; capital: a list of them
      character(14) :: preset            !< Default of the key, or REQUIRED or NONE.
      real(wp) :: lower, upper           !< Range of a number.
      character(320) :: meaning
      character(240) :: words = ''       !< Kinds w, W: the words, divided by |; n: words that stand for a number.
      character(8) :: unit = ''          !< Shown behind the range, where the meaning does not say it.
      integer :: values = 0              !< Number of values of a list, 0: any number.
      !> Conditions of its effect, between blanks: `key=word|word` another key has one of these words or none,
      !> `+key|key` one of other keys is given, `-key` it is not. Of a condition that begins with `:` the program knows
      !> whether it holds.
      character(96) :: acts = ''
      character(16) :: refers = ''       !< Kind t: the group whose name it gives; 'material' stands for all laws.
   end type key_t
contains
   !> Refuses an unknown group and, in a known one, unknown keys, values of the wrong kind, number or range, and a
   !> missing key. Faults are EXIT_INPUT with file and line; ranges in the unit of the key. keys(:) are those of all
   !> groups that the program knows.
   subroutine check_group(keys, group, open, fault)
      type(key_t), intent(in) :: keys(:)
      type(group_t), intent(in) :: group
      logical, intent(in) :: open         !< Unknown keys are left to somebody else.
      type(fault_t), intent(inout) :: fault
      integer :: k

      if (.not. any(keys%group == group%name)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'there is no group &'//trim(group%name)// &
                    '; the nearest is &'//trim(keys(nearest_name(group%name, keys%group))%group)//'.')
         return
      end if
      call check_entries(keys, group, open, fault)
      if (fault%code /= 0) return
      do k = 1, size(keys)
         if (keys(k)%group /= group%name .or. keys(k)%preset /= REQUIRED) cycle
         if (given(group, keys(k)%name)) cycle
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&'//trim(group%name)//' needs '// &
                    trim(keys(k)%name)//' ('//described(keys(k))//').')
         return
      end do
   end subroutine check_group

   subroutine check_entries(keys, group, open, fault)
      type(key_t), intent(in) :: keys(:)
      type(group_t), intent(in) :: group
      logical, intent(in) :: open
      type(fault_t), intent(inout) :: fault
      integer :: i, k

      do i = 1, group%count
         associate (item => group%entries(i))
            k = place_of(keys, group%name, item%key)
            if (k > 0) then
               call check_values(group%file, item, keys(k), fault)
            else if (.not. open) then
               k = nearest_name(item%key, keys%name, keys%group == group%name)
               call raise(fault, EXIT_INPUT, at_line(group%file, item%line)//'&'//trim(group%name)//' has no key '// &
                          trim(item%key)//'; the nearest is '//trim(keys(k)%name)//' ('//described(keys(k))//').')
            end if
         end associate
         if (fault%code /= 0) return
      end do
   end subroutine check_entries

   !> Refuses a key that has no effect because of another one. Fault EXIT_INPUT, at the first.
   subroutine refuse_idle_keys(keys, group, fault)
      type(key_t), intent(in) :: keys(:)     !< Every key of the group.
      type(group_t), intent(in) :: group     !< It passed check_group.
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: why
      integer :: i, k

      do i = 1, group%count
         k = place_of(keys, group%name, group%entries(i)%key)
         if (k == 0) cycle
         why = idle_reason(keys, keys(k), group)
         if (why /= '') call raise(fault, EXIT_INPUT, at_line(group%file, group%entries(i)%line)// &
                                   trim(keys(k)%name)//' has no effect'//why//'; remove it.')
         if (fault%code /= 0) return
      end do
   end subroutine refuse_idle_keys

   !> Says why a key of a group has no effect beside the other keys, as the end of a sentence: " without cycle_by";
   !> empty if it has one. Conditions that begin with `:` are left to the program.
   pure function idle_reason(keys, key, group) result(why)
      type(key_t), intent(in) :: keys(:), key
      type(group_t), intent(in) :: group
      character(:), allocatable :: why
      character(:), allocatable :: rest, condition, other, word
      character(LENGTH) :: text
      integer :: at

      why = ''
      word = ''
      rest = trim(key%acts)
      do while (rest /= '' .and. why == '')
         at = index(rest//' ', ' ')
         condition = rest(:at - 1)
         rest = adjustl(rest(at:))
         other = condition(2:)
         select case (condition(1:1))
         case ('+')
            why = lacking(group, other)
         case ('-')
            if (given(group, other)) why = ' beside '//other
         case (':')
         case default
            at = index(condition, '=')
            other = condition(:at - 1)
            text = keys(place_of(keys, group%name, other))%preset   ! unless the group gives it
            call get_text(group, other, text)
            word = lower_case(trim(text))
            if (word == '' .or. is_word(condition(at + 1:), word)) cycle
            why = ' with '//other//' = '''//word//''''//own_keys(keys, group%name, other, word)
         end select
      end do
   end function idle_reason

   !> Says " without a or b" where a group gives none of some keys, divided by |; else empty.
   pure function lacking(group, names) result(why)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: names
      character(:), allocatable :: why
      character(:), allocatable :: rest
      integer :: at

      why = ''
      rest = names
      do while (rest /= '')
         at = index(rest//BETWEEN, BETWEEN)
         why = why//trim(merge(' without', ' or     ', why == ''))//' '//rest(:at - 1)
         if (given(group, rest(:at - 1))) exit
         rest = rest(at + 1:)
      end do
      if (rest /= '') why = ''
   end function lacking

   !> ", which takes eps_a_end, q_end": the keys that act with a word of another key and not with every one.
   pure function own_keys(keys, group, other, word) result(list)
      type(key_t), intent(in) :: keys(:)
      character(*), intent(in) :: group, other, word
      character(:), allocatable :: list
      character(len(keys%acts)) :: words
      integer :: k

      list = ''
      do k = 1, size(keys)
         if (keys(k)%group /= group .or. index(keys(k)%acts, other//'=') /= 1) cycle
         words = keys(k)%acts(len(other) + 2:)
         if (is_word(words(:index(words, ' ') - 1), word)) list = list//', '//trim(keys(k)%name)
      end do
      if (list /= '') list = ', which takes'//list(2:)
   end function own_keys

   subroutine check_values(file, item, key, fault)
      character(*), intent(in) :: file
      type(entry_t), intent(in) :: item
      type(key_t), intent(in) :: key
      type(fault_t), intent(inout) :: fault
      real(wp) :: value
      integer :: wanted, i
      logical :: good, integral

      wanted = key%values
      if (scan(key%kind, 'nitw') > 0) wanted = 1
      if (wanted > 0 .and. item%count /= wanted) then
         call raise(fault, EXIT_INPUT, at_line(file, item%line)//trim(key%name)//' takes '//whole(wanted)// &
                    trim(merge(' value ', ' values', wanted == 1))//', '//whole(item%count)// &
                    trim(merge(' is ', ' are', item%count == 1))//' given ('//described(key)// &
                    ')'//trim(merge('; is a "=" missing?', '.                  ', item%count > wanted)))
         return
      end if
      integral = scan(key%kind, 'iI') > 0
      do i = 1, item%count
         select case (key%kind)
         case ('n', 'N', 'i', 'I')
            call read_number(item%values(i), value, good)
            if (good .and. integral) good = abs(value - anint(value)) <= 0.0_wp
            if (.not. good .and. key%words /= '') then
               if (.not. is_word(key%words, item%values(i))) call refuse('is neither a number nor one of its words')
            else if (.not. good) then
               call refuse('is not '//trim(merge('an integer', 'a number  ', integral)))
            else if (value < key%lower .or. value > key%upper) then
               call refuse('is outside its range')
            end if
         case ('w', 'W')
            if (.not. is_word(key%words, item%values(i))) call refuse('is not one of its words')
         end select
         if (fault%code /= 0) return
      end do
   contains
      subroutine refuse(why)
         character(*), intent(in) :: why

         call raise(fault, EXIT_INPUT, at_line(file, item%line)//trim(key%name)//' = '//trim(item%values(i))//' '// &
                    why//' ('//described(key)//').')
      end subroutine refuse
   end subroutine check_values

   !> Whether a word, case ignored, is one of those that | divides.
   pure logical function is_word(words, word)
      character(*), intent(in) :: words, word

      is_word = index(BETWEEN//trim(words)//BETWEEN, BETWEEN//lower_case(trim(word))//BETWEEN) > 0
   end function is_word

   !> Lists the words of a key, one by one, in words(:). It is empty where the key takes none.
   pure function words_of(key) result(words)
      type(key_t), intent(in) :: key
      character(LONGEST_WORD), allocatable :: words(:)
      integer :: first, last

      allocate (words(0))
      if (key%words == '') return
      first = 1
      do
         last = first + index(trim(key%words(first:))//BETWEEN, BETWEEN) - 2
         words = [character(LONGEST_WORD) :: words, key%words(first:last)]
         first = last + 2
         if (first > len_trim(key%words)) exit
      end do
   end function words_of

   !> Finds the place of a key among the keys, case ignored, 0 if there is none of that name. keys(:) of any size.
   pure integer function place_of(keys, group, name) result(place)
      type(key_t), intent(in) :: keys(:)
      character(*), intent(in) :: group, name

      do place = 1, size(keys)
         if (keys(place)%group == group .and. lower_case(keys(place)%name) == lower_case(name)) return
      end do
      place = 0
   end function place_of

   !> Says "from 0.01 to 5: void ratio", the range in the unit of the key.
   pure function described(key) result(text)
      type(key_t), intent(in) :: key
      character(:), allocatable :: text

      text = ''
      if (scan(key%kind, 'nNiI') > 0) then
         if (key%lower > -UNBOUNDED) text = 'from '//short(key%lower)//' '
         if (key%upper < UNBOUNDED) text = text//trim(merge('to   ', 'up to', key%lower > -UNBOUNDED))//' '// &
                                           short(key%upper)//' '
         if (key%unit /= '') text = text//trim(key%unit)//' '
      end if
      if (scan(key%kind, 'wW') > 0) text = trim(key%words)//' '
      if (text /= '') text = trim(text)//': '
      text = text//trim(key%meaning)
   end function described

   !> Whether a group gives a key.
   pure logical function given(group, name)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name

      given = find_entry(group, name) > 0
   end function given

   !> Finds the line of a key, or of its group where the key is not given.
   pure integer function line_of(group, name) result(line)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name

      line = group%line
      if (given(group, name)) line = group%entries(find_entry(group, name))%line
   end function line_of

   !> Texts of a list; empty if it is not given. texts(:) has as many entries as the list has values.
   function texts_of(group, name) result(texts)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      character(LENGTH), allocatable :: texts(:)
      integer :: place

      allocate (texts(0))
      place = find_entry(group, name)
      if (place > 0) texts = group%entries(place)%values(:group%entries(place)%count)
   end function texts_of

   !> Numbers of a list; empty if it is not given. In the unit of the key; they must have passed check_group.
   function numbers_of(group, name) result(values)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      real(wp), allocatable :: values(:)
      integer :: i, place
      logical :: good

      place = find_entry(group, name)
      if (place == 0) then
         allocate (values(0))
         return
      end if
      allocate (values(group%entries(place)%count))
      do i = 1, size(values)
         call read_number(group%entries(place)%values(i), values(i), good)
      end do
   end function numbers_of

   !> Takes a text; `value` stays where the group has none.
   pure subroutine get_text(group, name, value)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      character(LENGTH), intent(inout) :: value
      integer :: place

      place = find_entry(group, name)
      if (place > 0) value = group%entries(place)%values(1)
   end subroutine get_text

   !> Takes a number that was checked; `value` stays where the group has none. In the unit of the key; found tells
   !> whether the group has it.
   subroutine get_number(group, name, value, found)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      real(wp), intent(inout) :: value
      logical, intent(out) :: found
      integer :: place

      place = find_entry(group, name)
      found = place > 0
      if (found) call read_number(group%entries(place)%values(1), value, found)
   end subroutine get_number
end module key_schema
