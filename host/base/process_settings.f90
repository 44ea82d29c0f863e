! SPDX-License-Identifier: MIT
!> Settings that the process asks of the system and its libraries. A file that reaches its limit is an error of the
!> write; an interrupt is noticed, not obeyed at once. The fronts of a factorisation are too small to be worth threads
!> of the BLAS; memory that every factorisation needs anew is kept; threads that have nothing to do wait asleep, since
!> one thread works for long between the parallel parts of a step. Libraries without a setting run unchanged.
module process_settings
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_funptr, c_loc, c_ptr, c_null_ptr, c_null_char, &
                                          c_associated, c_f_procpointer
   use dynamic_loader, only: dlsym
   use files, only: limits_are_errors
   use interrupts, only: catch_interrupts
   use omp_lib, only: omp_get_max_threads
   implicit none (type, external)
   private
   public :: apply_process_settings

   integer(c_int), parameter :: TRIM_THRESHOLD = -1, MMAP_THRESHOLD = -3   !< Numbers of mallopt (malloc.h of glibc).
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

   interface
      integer(c_int) function setenv(name, value, overwrite) bind(c)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: name(*), value(*)
         integer(c_int), value :: overwrite
      end function setenv

      integer(c_int) function execvp(file, words) bind(c)
         import :: c_char, c_int, c_ptr
         character(kind=c_char), intent(in) :: file(*)
         type(c_ptr), intent(in) :: words(*)   !< The last one is null.
      end function execvp
   end interface
contains
   !> Applies the settings, once at the start of the program. A setting that the libraries do not know is left out
   !> without a message.
   subroutine apply_process_settings()
      procedure(set_threads), pointer :: threads
      procedure(set_memory), pointer :: memory
      type(c_funptr) :: found
      integer(c_int) :: done

      call limits_are_errors()
      call catch_interrupts()
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
      call wait_asleep()
   end subroutine apply_process_settings

   !> Begins the program anew with the policy of waiting in its environment, which OpenMP reads before the first
   !> statement and takes from nowhere else. A policy that the user has set stays; one thread waits for nobody. Where
   !> the program cannot be begun anew it goes on.
   subroutine wait_asleep()
      character(kind=c_char), allocatable, target :: words(:)
      type(c_ptr), allocatable :: starts(:)
      integer, allocatable :: first(:)
      character(:), allocatable :: word
      integer :: i, length, status

      call get_environment_variable('OMP_WAIT_POLICY', status=status)
      if (status /= 1) return
      if (omp_get_max_threads() == 1) return
      if (setenv('OMP_WAIT_POLICY'//c_null_char, 'passive'//c_null_char, 1_c_int) /= 0) return
      allocate (words(0), first(0))
      do i = 0, command_argument_count()
         call get_command_argument(i, length=length)
         allocate (character(length) :: word)
         call get_command_argument(i, word)
         first = [first, size(words) + 1]
         words = [character(kind=c_char) :: words, transfer(word, words), c_null_char]
         deallocate (word)
      end do
      allocate (starts(size(first) + 1))
      starts(:) = c_null_ptr
      do i = 1, size(first)
         starts(i) = c_loc(words(first(i)))
      end do
      status = execvp(words, starts)
   end subroutine wait_asleep
end module process_settings
