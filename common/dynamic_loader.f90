! SPDX-License-Identifier: MIT
!> The loader of the system (POSIX, dlfcn.h): libraries by their path, procedures of what is loaded by their name.
module dynamic_loader
   use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_char, c_int
   implicit none (type, external)
   private
   public :: dlopen, dlsym, dlerror, RTLD_NOW

   integer(c_int), parameter :: RTLD_NOW = 2   !< All symbols at once, so that one that is missing is told there.

   interface
      !> A null pointer where the library cannot be loaded; dlerror says why. path: closed by a null character.
      type(c_ptr) function dlopen(path, mode) bind(c)
         import :: c_ptr, c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
      end function dlopen

      !> A null pointer where there is no such procedure. handle: of dlopen, null for all that is loaded.
      type(c_funptr) function dlsym(handle, name) bind(c)
         import :: c_ptr, c_funptr, c_char
         type(c_ptr), value :: handle
         character(kind=c_char), intent(in) :: name(*)
      end function dlsym

      !> A text closed by a null character, or a null pointer.
      type(c_ptr) function dlerror() bind(c)
         import :: c_ptr
      end function dlerror
   end interface
end module dynamic_loader
