! SPDX-License-Identifier: MIT
!> The command line of a program: a list of options, and words that are none.
module arguments
   use faults, only: fault_t, raise, EXIT_INPUT
   use spelling, only: nearest_name
   use texts, only: whole
   implicit none (type, external)
   private
   public :: option_t, read_command_line, parse_words, option_given, option_value, option_values, WORD_LENGTH

   integer, parameter :: WORD_LENGTH = 1024   !< Longest word of a command line.

   !> An option, and what the command line says about it.
   type :: option_t
      character(20) :: name             !< With its dashes.
      character(40) :: takes = ''       !< Noun for its value in a message, as 'a folder'; blank: it takes none.
      character(2) :: letter = ''       !< Short form.
      logical :: answers = .false.      !< Only asks for a text, as --help: what follows is not read.
      logical :: given = .false.
      character(WORD_LENGTH) :: value = ''                   !< The last one.
      character(WORD_LENGTH), allocatable :: values(:)       !< All of them, in their order.
   end type option_t
contains
   !> The command line of this program; see parse_words. A word that is too long is a fault (EXIT_INPUT). options(:) are
   !> all that the program knows, any number.
   subroutine read_command_line(options, subject, hint, operand, fault, second)
      type(option_t), intent(inout) :: options(:)
      character(*), intent(in) :: subject, hint
      character(WORD_LENGTH), intent(out) :: operand
      type(fault_t), intent(inout) :: fault
      character(WORD_LENGTH), intent(out), optional :: second
      character(WORD_LENGTH) :: words(command_argument_count())
      integer :: i, status

      operand = ''
      do i = 1, size(words)
         call get_command_argument(i, words(i), status=status)
         if (status /= 0) then
            call raise(fault, EXIT_INPUT, 'Argument '//whole(i)//' is longer than '//whole(WORD_LENGTH)//' characters.')
            return
         end if
      end do
      call parse_words(words, options, subject, hint, operand, fault, second)
   end subroutine read_command_line

   !> Sorts words into options with their values and one operand. The operand is required unless an option only prints a
   !> text; where `second` is present, a second operand may follow. Mistakes are faults (EXIT_INPUT) that name the word
   !> and the nearest option. words(:) and options(:) of any size; an option that is met is marked in options.
   subroutine parse_words(words, options, subject, hint, operand, fault, second)
      character(*), intent(in) :: words(:)
      type(option_t), intent(inout) :: options(:)
      character(*), intent(in) :: subject    !< Noun for the operand, as 'case'.
      character(*), intent(in) :: hint       !< Advice after a mistake, as 'see mud_triax --help'.
      character(*), intent(out) :: operand
      type(fault_t), intent(inout) :: fault
      character(*), intent(out), optional :: second   !< Blank if there is none.
      integer :: i, k

      operand = ''
      if (present(second)) second = ''
      i = 0
      do while (i < size(words))
         i = i + 1
         if (words(i) == '') then
            call raise(fault, EXIT_INPUT, 'Argument '//whole(i)//' is empty; '//hint//'.')
            return
         else if (.not. looks_like_option(words(i))) then
            if (present(second) .and. operand /= '') then
               if (second == '') then
                  second = words(i)
                  cycle
               end if
            end if
            if (operand /= '') then
               call raise(fault, EXIT_INPUT, 'One '//subject//' at a time: '//trim(operand)//' or '//trim(words(i))// &
                          '? ('//hint//')')
               return
            end if
            operand = words(i)
            cycle
         end if
         k = place_of(options, words(i))
         if (k == 0) then
            k = nearest_name(words(i), options%name)
            call raise(fault, EXIT_INPUT, 'There is no option '//trim(words(i))//'; the nearest is '// &
                       trim(options(k)%name)//'; '//hint//'.')
            return
         end if
         options(k)%given = .true.
         if (options(k)%answers) return
         if (options(k)%takes == '') cycle
         i = i + 1
         if (i <= size(words)) options(k)%value = words(i)
         ! A word that looks like an option is no value: the value was forgotten.
         if (options(k)%value == '' .or. looks_like_option(options(k)%value)) then
            call raise(fault, EXIT_INPUT, trim(options(k)%name)//' needs '//trim(options(k)%takes)//'; '//hint//'.')
            return
         end if
         call append(options(k)%value, options(k)%values)
      end do
      if (operand == '') call raise(fault, EXIT_INPUT, 'No '//subject//' is named; '//hint//'.')
   end subroutine parse_words

   pure subroutine append(value, values)
      character(WORD_LENGTH), intent(in) :: value
      character(WORD_LENGTH), allocatable, intent(inout) :: values(:)
      character(WORD_LENGTH), allocatable :: more(:)
      integer :: n

      n = 0
      if (allocated(values)) n = size(values)
      allocate (more(n + 1))
      if (n > 0) more(:n) = values
      more(n + 1) = value
      call move_alloc(more, values)
   end subroutine append

   !> A dash and more; the dash alone is a name, that of the standard output.
   pure logical function looks_like_option(word)
      character(*), intent(in) :: word

      looks_like_option = .false.
      if (len_trim(word) > 1) looks_like_option = word(1:1) == '-'
   end function looks_like_option

   pure integer function place_of(options, word) result(place)
      type(option_t), intent(in) :: options(:)
      character(*), intent(in) :: word

      do place = 1, size(options)
         if (word == options(place)%name .or. (word == options(place)%letter .and. word /= '')) return
      end do
      place = 0
   end function place_of

   !> Whether the command line has the option of this name. The name must be one of options(:).
   pure logical function option_given(options, name)
      type(option_t), intent(in) :: options(:)
      character(*), intent(in) :: name

      option_given = options(place_of(options, name))%given
   end function option_given

   !> Finds the value of an option, blank if it is not given. The name must be one of options(:).
   pure function option_value(options, name) result(value)
      type(option_t), intent(in) :: options(:)
      character(*), intent(in) :: name
      character(:), allocatable :: value

      value = trim(options(place_of(options, name))%value)
   end function option_value

   !> Finds the values of an option that may be given several times, in their order; none if it is not given. The name
   !> must be one of options(:).
   pure function option_values(options, name) result(values)
      type(option_t), intent(in) :: options(:)
      character(*), intent(in) :: name
      character(WORD_LENGTH), allocatable :: values(:)

      allocate (values(0))
      if (allocated(options(place_of(options, name))%values)) values = options(place_of(options, name))%values
   end function option_values
end module arguments
