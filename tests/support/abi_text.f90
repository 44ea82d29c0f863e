! SPDX-License-Identifier: MIT
!> Texts of the C interface as Fortran has them.
module abi_text
   use, intrinsic :: iso_c_binding, only: c_char, c_null_char
   use mud_interface, only: mud_text, mud_message, mud_report, mud_status_text, mud_validate_props
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: text_of, validation, message_of, sentence_of, from_c, numbers_after, LONG, UNTERMINATED

   integer, parameter :: LONG = 400                          !< Room for every sentence [-].
   character(*), parameter :: UNTERMINATED = '(no end)'      !< Stands for a text without its terminator.
contains
   !> A field of a table's entry; what failed begins with '!'.
   function text_of(list, index, field) result(text)
      integer, intent(in) :: list, index, field
      character(LONG) :: text
      character(kind=c_char) :: buffer(LONG)

      buffer = 'x'
      text = '! no such entry'
      if (mud_text(list, index, field, buffer, LONG) == 0) text = from_c(buffer)
   end function text_of

   !> What validation says, with its code.
   subroutine validation(props, code, text)
      real(wp), intent(in) :: props(:)
      integer, intent(out) :: code
      character(LONG), intent(out) :: text
      character(kind=c_char) :: buffer(LONG)

      buffer = 'x'
      code = mud_validate_props(props, size(props), buffer, LONG)
      text = from_c(buffer)
   end subroutine validation

   function message_of(report) result(text)
      type(mud_report), intent(in) :: report
      character(LONG) :: text
      character(kind=c_char) :: buffer(LONG)

      buffer = 'x'
      text = '! no message'
      if (mud_message(report, buffer, LONG) == 0) text = from_c(buffer)
   end function message_of

   function sentence_of(code) result(text)
      integer, intent(in) :: code
      character(LONG) :: text
      character(kind=c_char) :: buffer(LONG)

      buffer = 'x'
      text = '! no sentence'
      if (mud_status_text(code, buffer, LONG) == 0) text = from_c(buffer)
   end function sentence_of

   pure function from_c(buffer) result(text)
      character(kind=c_char), intent(in) :: buffer(:)
      character(LONG) :: text
      integer :: i

      text = ''
      do i = 1, size(buffer)
         if (buffer(i) == c_null_char) return
         text(i:i) = buffer(i)
      end do
      text = UNTERMINATED
   end function from_c

   !> The two numbers of 'allowed A to B' in a sentence.
   subroutine numbers_after(text, lower, upper, found)
      character(*), intent(in) :: text
      real(wp), intent(out) :: lower, upper
      logical, intent(out) :: found
      character(*), parameter :: WORD = 'allowed '
      integer :: first, last, code

      lower = 0.0_wp
      upper = 0.0_wp
      first = index(text, WORD)
      last = index(text(max(first, 1):), ' to ') + max(first, 1) - 1
      found = first > 0 .and. last > first
      if (.not. found) return
      read (text(first + len(WORD):last - 1), *, iostat=code) lower
      found = code == 0
      if (.not. found) return
      first = last + len(' to ')
      last = first + scan(text(first:), ' ,:') - 2
      read (text(first:last), *, iostat=code) upper
      found = code == 0
   end subroutine numbers_after
end module abi_text
