! SPDX-License-Identifier: MIT
!> Words and numbers: reading and writing.
module texts
   use, intrinsic :: iso_fortran_env, only: int32, int64
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_null_char, c_ptr, c_size_t
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_overflow, ieee_get_halting_mode, &
                                             ieee_set_halting_mode, ieee_set_flag
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: lower_case, short, whole, place_text, read_number, from_c, text_at, joined, word_place, mark_length, &
             shell_word, LENGTH, PATH_LENGTH

   integer, parameter :: LENGTH = 256        !< Longest key or value of a text that is read.
   integer, parameter :: PATH_LENGTH = 1024  !< Longest path of a file that is read, as of a word of a command line.

   !> An integer as text.
   interface whole
      module procedure whole_32, whole_64
   end interface whole

   interface
      integer(c_size_t) function strlen(text) bind(c)
         import :: c_size_t, c_ptr
         type(c_ptr), value :: text
      end function strlen
   end interface
contains
   !> Returns the text with ASCII letters in lower case.
   elemental function lower_case(text) result(lower)
      character(*), intent(in) :: text
      character(len(text)) :: lower
      integer :: i

      lower = text
      do i = 1, len(text)
         if (lge(text(i:i), 'A') .and. lle(text(i:i), 'Z')) lower(i:i) = achar(iachar(text(i:i)) + 32)
      end do
   end function lower_case

   !> Characters of the byte-order mark that a text begins with (UTF-8, as some editors write it): 3, or 0 without one.
   pure integer function mark_length(text)
      character(*), intent(in) :: text
      character(3), parameter :: MARK = char(239)//char(187)//char(191)

      mark_length = 0
      if (index(text, MARK) == 1) mark_length = len(MARK)
   end function mark_length

   !> Joins words, without the blanks behind them, and a text between each two.
   pure function joined(words, between) result(line)
      character(*), intent(in) :: words(:), between
      character(:), allocatable :: line
      integer :: i

      line = ''
      do i = 1, size(words)
         if (i > 1) line = line//between
         line = line//trim(words(i))
      end do
   end function joined

   !> Finds the first place in a text of a word that no letter, digit or underscore continues, 0 if there is none; case
   !> ignored.
   pure integer function word_place(text, word)
      character(*), intent(in) :: text, word
      character(*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyz0123456789_'
      character(len(text) + 2) :: padded
      integer :: next, last

      padded = ' '//lower_case(text)//' '
      word_place = 0
      if (len_trim(word) == 0) return
      do
         next = index(padded(word_place + 1:), lower_case(trim(word)))
         if (next == 0) exit
         word_place = word_place + next
         last = word_place + len_trim(word)
         if (scan(padded(word_place - 1:word_place - 1)//padded(last:last), LETTERS) == 0) exit
      end do
      word_place = merge(0, word_place - 1, next == 0)
   end function word_place

   !> Writes a number with six significant digits and nothing superfluous. Without a unit; 'not finite' for NaN and
   !> infinity.
   pure function short(value, digits) result(text)
      real(wp), intent(in) :: value
      integer, intent(in), optional :: digits   !< So many significant ones instead.
      character(:), allocatable :: text
      character(40) :: number
      integer :: mark, n, places

      n = 6
      if (present(digits)) n = digits
      if (.not. ieee_is_finite(value)) then
         text = 'not finite'
      else if (abs(value) <= 0.0_wp) then
         text = '0'
      else if (abs(value) >= 1.0e-3_wp .and. abs(value) < 0.9999995e6_wp) then
         places = n - 1 - floor(log10(abs(value)))
         if (places >= 0) then
            write (number, '(f0.'//whole(places)//')') value
         else
            write (number, '(f0.0)') anint(value/10.0_wp**(-places))*10.0_wp**(-places)
         end if
         text = without_zeros(trim(number))
         if (text(1:1) == '.') text = '0'//text
         if (text(1:1) == '-' .and. text(2:2) == '.') text = '-0'//text(2:)
      else
         write (number, '(es'//whole(n + 7)//'.'//whole(n - 1)//'e3)') value
         number = adjustl(number)
         mark = index(number, 'E')
         text = without_zeros(number(:mark - 1))//'e'
         if (number(mark + 1:mark + 1) == '-') text = text//'-'
         text = text//trim(adjustl(number(mark + 2 + verify(number(mark + 2:mark + 3)//'1', '0') - 1:)))
      end if
   end function short

   !> Writes a place in the plane, as "(0.5, 2) m".
   pure function place_text(x) result(text)
      real(wp), intent(in) :: x(2)   !< [m]
      character(:), allocatable :: text

      text = '('//short(x(1))//', '//short(x(2))//') m'
   end function place_text

   pure function without_zeros(digits) result(text)
      character(*), intent(in) :: digits
      character(:), allocatable :: text
      integer :: last

      last = len(digits)
      if (index(digits, '.') > 0) then
         last = verify(digits, '0', back=.true.)
         if (digits(last:last) == '.') last = last - 1
      end if
      text = digits(:last)
   end function without_zeros

   pure function whole_32(value) result(text)
      integer(int32), intent(in) :: value
      character(:), allocatable :: text

      text = whole_64(int(value, int64))
   end function whole_32

   pure function whole_64(value) result(text)
      integer(int64), intent(in) :: value
      character(:), allocatable :: text
      character(20) :: digits

      write (digits, '(i0)') value
      text = trim(digits)
   end function whole_64

   !> A path, without trailing blanks, as a word that a shell takes: between ' if it has more than letters, figures and
   !> marks without a meaning there. Letters beyond ASCII have none.
   pure function shell_word(path) result(word)
      character(*), intent(in) :: path
      character(:), allocatable :: word
      integer :: i

      word = trim(path)
      if (word /= '' .and. scan(word, ' !"#$&''()*;<=>?[\]^`{|}~'//achar(9)//achar(10)) == 0) return
      word = ''
      do i = 1, len_trim(path)
         if (path(i:i) == '''') then
            word = word//'''\'''''
         else
            word = word//path(i:i)
         end if
      end do
      word = ''''//word//''''
   end function shell_word

   !> Reads a decimal number; anything that is not entirely one ('1.2.3', '1e999', 'nan') is refused. value is then 0
   !> and good false.
   pure subroutine read_number(text, value, good)
      character(*), intent(in) :: text
      real(wp), intent(out) :: value
      logical, intent(out) :: good
      logical :: halting
      integer :: problem

      value = 0.0_wp
      good = looks_like_number(trim(text))
      if (.not. good) return
      ! A number too large is refused here; builds that stop at an overflow shall not stop in the runtime's reader.
      call ieee_get_halting_mode(ieee_overflow, halting)
      call ieee_set_halting_mode(ieee_overflow, .false.)
      read (text, *, iostat=problem) value
      call ieee_set_flag(ieee_overflow, .false.)
      call ieee_set_halting_mode(ieee_overflow, halting)
      good = problem == 0
      if (good) good = ieee_is_finite(value)
      if (.not. good) value = 0.0_wp
   end subroutine read_number

   !> [sign] digits [. digits] [e [sign] digits], at least one digit before the exponent.
   pure logical function looks_like_number(text)
      character(*), intent(in) :: text
      integer :: mark, start

      looks_like_number = .false.
      if (len(text) == 0) return
      mark = scan(text, 'eEdD')
      if (mark == 0) mark = len(text) + 1
      if (mark < len(text) + 1) then
         start = mark + 1
         if (start > len(text)) return
         if (scan(text(start:start), '+-') > 0) start = start + 1
         if (start > len(text)) return
         if (verify(text(start:), '0123456789') > 0) return
      end if
      start = 1
      if (scan(text(1:1), '+-') > 0) start = 2
      if (start > mark - 1) return
      if (scan(text(start:mark - 1), '0123456789') == 0) return
      if (verify(text(start:mark - 1), '0123456789.') > 0) return
      looks_like_number = index(text(start:mark - 1), '.') == index(text(start:mark - 1), '.', back=.true.)
   end function looks_like_number

   !> Returns the text of a C buffer, up to its terminating null. Without one, up to the last character that is not
   !> blank.
   pure function from_c(buffer) result(text)
      character(*), intent(in) :: buffer
      character(:), allocatable :: text
      integer :: last

      last = index(buffer, c_null_char) - 1
      if (last < 0) last = len_trim(buffer)
      text = buffer(:last)
   end function from_c

   !> Returns a text of C, without its null. The pointer is not NULL.
   function text_at(place) result(text)
      type(c_ptr), intent(in) :: place
      character(:), allocatable :: text
      character(kind=c_char), pointer :: letters(:)
      integer :: i

      call c_f_pointer(place, letters, [strlen(place)])
      allocate (character(size(letters)) :: text)
      do i = 1, size(letters)
         text(i:i) = letters(i)
      end do
   end function text_at
end module texts
