! SPDX-License-Identifier: MIT
!> Keys that are written once: every statement names a key, the value that it sets, its range and its meaning. The same
!> statements list the keys (for checks, templates and messages) and read a group. The default of a key is what its
!> value was before; a default outside of the range is none. A reader declares all its keys first; with a table that
!> only lists it ends there.
module key_table
   use kinds, only: wp
   use key_schema, only: key_t, NONE, REQUIRED, LONGEST_WORD, described, get_text, get_number, lacking, numbers_of, &
                         place_of, texts_of, words_of
   use namelists, only: group_t
   use texts, only: lower_case, short, whole_text => whole, LENGTH
   implicit none (type, external)
   private
   public :: key_table_t, reading, listing

   type :: key_table_t
      type(group_t) :: group                  !< Group that is read.
      logical :: lists = .false.              !< The keys are wanted; there is no group to read.
      type(key_t), allocatable :: keys(:)     !< Declared so far; not allocated: they are not kept.
      character(5) :: stress = 'kPa'          !< Unit in which the group gives stresses.
      real(wp) :: per_kpa = 1.0_wp            !< Number of this unit that makes a kPa.
   contains
      procedure :: given, number, whole, word, flag, text, numbers, wholes, texts, about
      procedure, private :: list
   end type key_table_t

   ! Of every procedure: `acts` says when the key has an effect, see key_t; REQUIRED: it must be given. Where there is a
   ! `unit`, it is kPa, in which the range is said: it is converted to the unit of the group.
contains
   !> Makes a table that reads a group and keeps its keys.
   pure type(key_table_t) function reading(group) result(table)
      type(group_t), intent(in) :: group

      table%group = group
      allocate (table%keys(0))
   end function reading

   !> Makes a table that lists the keys of a group.
   pure type(key_table_t) function listing(name) result(table)
      character(*), intent(in) :: name

      table%group%name = name
      table%lists = .true.
      allocate (table%keys(0), table%group%entries(0))
   end function listing

   !> Whether the group gives a key, or one of several, divided by |.
   pure logical function given(self, names)
      class(key_table_t), intent(in) :: self
      character(*), intent(in) :: names

      given = lacking(self%group, names) == ''
   end function given

   !> Says range and meaning of a key that was declared, of a table that keeps its keys.
   pure function about(self, name) result(sentence)
      class(key_table_t), intent(in) :: self
      character(*), intent(in) :: name
      character(:), allocatable :: sentence

      sentence = described(self%keys(place_of(self%keys, self%group%name, name)))
   end function about

   subroutine list(self, key, acts, unit)
      class(key_table_t), intent(inout) :: self
      type(key_t), intent(in) :: key
      character(*), intent(in), optional :: acts, unit
      type(key_t) :: listed

      if (.not. allocated(self%keys)) return
      listed = key
      listed%group = self%group%name(:len(listed%group))
      if (present(unit)) then
         listed%unit = self%stress
         listed%lower = listed%lower*self%per_kpa
         listed%upper = listed%upper*self%per_kpa
      end if
      if (present(acts)) then
         if (acts == REQUIRED) listed%preset = REQUIRED
         if (acts /= REQUIRED) listed%acts = acts
      end if
      self%keys = [self%keys, listed]
   end subroutine list

   !> `shown` is how the default is written, where that is not the shortest way.
   subroutine number(self, name, value, lower, upper, meaning, acts, unit, shown)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      real(wp), intent(inout) :: value
      real(wp), intent(in) :: lower, upper
      character(*), intent(in), optional :: acts, unit, shown
      character(14) :: preset
      logical :: found

      preset = NONE
      if (value >= lower .and. value <= upper) preset = short(value)
      if (present(shown)) preset = shown
      call self%list(key_t('', name, 'n', preset, lower, upper, meaning), acts, unit)
      call get_number(self%group, name, value, found)
   end subroutine number

   !> Declares an integer.
   subroutine whole(self, name, value, lower, upper, meaning, acts)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      integer, intent(inout) :: value
      integer, intent(in) :: lower, upper
      character(*), intent(in), optional :: acts
      real(wp) :: found_value
      logical :: found

      call self%list(key_t('', name, 'i', whole_text(value), lower, upper, meaning), acts)
      call get_number(self%group, name, found_value, found)
      if (found) value = nint(found_value)
   end subroutine whole

   !> Declares the number of a word among those of the key, from 1; 0: none.
   subroutine word(self, name, value, words, meaning, acts)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, words, meaning
      integer, intent(inout) :: value
      character(*), intent(in), optional :: acts
      character(LENGTH) :: chosen
      character(LONGEST_WORD), allocatable :: all_words(:)
      type(key_t) :: key

      key = key_t('', name, 'w', NONE, 0, 0, meaning, words)
      allocate (all_words, source=words_of(key))
      if (value > 0) key%preset = all_words(value)(:len(key%preset))
      call self%list(key, acts)
      chosen = ''
      call get_text(self%group, name, chosen)
      if (self%given(name)) value = findloc(all_words, lower_case(chosen), dim=1)
   end subroutine word

   !> Whether one of two words, `yes`, is chosen.
   subroutine flag(self, name, value, words, yes, meaning, acts)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, words, yes, meaning
      logical, intent(inout) :: value
      character(*), intent(in), optional :: acts
      integer :: number_of_word

      ! The first or the second.
      number_of_word = merge(1, 2, value .eqv. index(words, yes//'|') == 1)
      call self%word(name, number_of_word, words, meaning, acts)
      value = (number_of_word == 1) .eqv. index(words, yes//'|') == 1
   end subroutine flag

   !> `refers`: the group whose name it gives, see key_t.
   subroutine text(self, name, value, meaning, acts, refers)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout) :: value
      character(*), intent(in), optional :: acts, refers
      character(LENGTH) :: found
      type(key_t) :: key

      key = key_t('', name, 't', value, 0, 0, meaning)
      if (present(refers)) key%refers = refers
      call self%list(key, acts)
      found = value
      call get_text(self%group, name, found)
      value = found
   end subroutine text

   !> Declares a list of numbers, empty where it is not given.
   subroutine numbers(self, name, values, lower, upper, meaning, acts, unit, count)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      real(wp), allocatable, intent(out) :: values(:)   !< (numbers)
      real(wp), intent(in) :: lower, upper
      character(*), intent(in), optional :: acts, unit
      integer, intent(in), optional :: count   !< So many; default: any number.
      type(key_t) :: key

      key = key_t('', name, 'N', NONE, lower, upper, meaning)
      if (present(count)) key%values = count
      call self%list(key, acts, unit)
      values = numbers_of(self%group, name)
   end subroutine numbers

   !> Declares a list of integers, empty where it is not given.
   subroutine wholes(self, name, values, lower, upper, meaning, acts)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      integer, allocatable, intent(out) :: values(:)   !< (numbers)
      integer, intent(in) :: lower, upper
      character(*), intent(in), optional :: acts

      call self%list(key_t('', name, 'I', NONE, lower, upper, meaning), acts)
      values = nint(numbers_of(self%group, name))
   end subroutine wholes

   !> Declares a list of texts, empty where it is not given; with `words` each is one of these.
   subroutine texts(self, name, values, meaning, acts, words)
      class(key_table_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(LENGTH), allocatable, intent(out) :: values(:)   !< (texts)
      character(*), intent(in), optional :: acts, words

      if (present(words)) then
         call self%list(key_t('', name, 'W', NONE, 0, 0, meaning, words), acts)
         values = lower_case(texts_of(self%group, name))
      else
         call self%list(key_t('', name, 'T', NONE, 0, 0, meaning), acts)
         values = texts_of(self%group, name)
      end if
   end subroutine texts
end module key_table
