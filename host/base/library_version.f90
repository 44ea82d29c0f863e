! SPDX-License-Identifier: MIT
!> Version of the library that the program is linked with, for files that belong to it.
module library_version
   use, intrinsic :: iso_c_binding, only: c_char, c_null_char
   use mud_interface, only: mud_version
   use texts, only: from_c
   implicit none (type, external)
   private
   public :: library
contains
   !> Version of the library, empty if it does not tell it.
   function library() result(text)
      character(64) :: text
      character(kind=c_char, len=64) :: raw

      raw = c_null_char
      text = ''
      if (mud_version(raw, len(raw)) >= 0) text = from_c(raw)
   end function library
end module library_version
