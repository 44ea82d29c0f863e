! SPDX-License-Identifier: MIT
!> Texts and numbers into memory of a C host and out of it.
module mud_to_host
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_associated, c_f_pointer
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: put, get, put_real, number_at
contains
   !> Text into a C buffer of `length` bytes, cut to fit, terminated. Nothing where it is NULL or has no room.
   subroutine put(text, buffer, length)
      character(*), intent(in) :: text
      type(c_ptr), intent(in) :: buffer
      integer(c_int), intent(in) :: length
      character(kind=c_char), pointer :: letters(:)
      integer :: i, n

      if (.not. c_associated(buffer) .or. length < 1) return
      call c_f_pointer(buffer, letters, [length])
      n = min(len_trim(text), length - 1)
      do i = 1, n
         letters(i) = text(i:i)
      end do
      letters(n + 1) = c_null_char
   end subroutine put

   !> Writes a number to where a pointer of the host points; nothing where it is NULL.
   subroutine put_real(value, target_)
      real(wp), intent(in) :: value
      type(c_ptr), intent(in) :: target_
      real(c_double), pointer :: place

      if (.not. c_associated(target_)) return
      call c_f_pointer(target_, place)
      place = value
   end subroutine put_real

   !> Entry of an optional array, 0 where it is not given. i from 1, not checked. array(:) has i entries or more.
   pure real(wp) function number_at(array, i)
      real(c_double), pointer, contiguous, intent(in) :: array(:)
      integer, intent(in) :: i

      number_at = 0.0_wp
      if (associated(array)) number_at = array(i)
   end function number_at

   !> A C string; `whole` if it fits. What is not printable becomes a blank: a line must stay a line.
   subroutine get(string, text, whole)
      type(c_ptr), intent(in) :: string
      character(*), intent(out) :: text
      logical, intent(out) :: whole
      character(kind=c_char), pointer :: letters(:)
      integer :: i

      text = ''
      whole = .true.
      if (.not. c_associated(string)) return
      call c_f_pointer(string, letters, [len(text) + 1])
      do i = 1, len(text) + 1
         if (letters(i) == c_null_char) return
         if (i > len(text)) exit
         text(i:i) = merge(letters(i), ' ', iachar(letters(i)) >= 32)
      end do
      whole = .false.
   end subroutine get
end module mud_to_host
