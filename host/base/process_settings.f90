! SPDX-License-Identifier: MIT
!> Settings of the libraries of the process: the fronts of a factorisation are too small to be worth threads of the
!> BLAS, and memory that every factorisation needs anew is kept. Both settings are optional: a BLAS or C library without
!> them runs unchanged.
module process_settings
   use, intrinsic :: iso_c_binding, only: c_int, c_funptr, c_null_ptr, c_null_char, c_associated, c_f_procpointer
   use dynamic_loader, only: dlsym
   implicit none (type, external)
   private
   public :: apply_process_settings

   !> Numbers of settings of mallopt (malloc.h of glibc).
   integer(c_int), parameter :: TRIM_THRESHOLD = -1, MMAP_THRESHOLD = -3
   integer(c_int), parameter :: KEPT = 2**30, LARGEST = 2**25              !< [bytes] The largest glibc takes: 32 MiB.

   abstract interface
      subroutine set_threads(number) bind(c)
         import :: c_int
         integer(c_int), value :: number
      end subroutine set_threads

      integer(c_int) function set_memory(parameter, value) bind(c)
         import :: c_int
         integer(c_int), value :: parameter, value
      end function set_memory
   end interface
contains
   !> Applies the settings, once at the start of the program. A setting that the libraries do not know is left out
   !> without a message.
   subroutine apply_process_settings()
      procedure(set_threads), pointer :: threads
      procedure(set_memory), pointer :: memory
      type(c_funptr) :: found
      integer(c_int) :: done

      found = dlsym(c_null_ptr, 'openblas_set_num_threads'//c_null_char)
      if (c_associated(found)) then
         call c_f_procpointer(found, threads)
         call threads(1_c_int)
      end if
      found = dlsym(c_null_ptr, 'mallopt'//c_null_char)
      if (c_associated(found)) then
         call c_f_procpointer(found, memory)
         done = memory(TRIM_THRESHOLD, KEPT)
         done = memory(MMAP_THRESHOLD, LARGEST)
      end if
   end subroutine apply_process_settings
end module process_settings
