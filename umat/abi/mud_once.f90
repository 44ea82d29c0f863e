! SPDX-License-Identifier: MIT
!> Memory of the library between calls: which messages have been printed, and which process has used threads. A message
!> of each kind goes to standard error once a process, whichever thread comes first. Nothing else reads the memory, so
!> no answer depends on it. Compiled with OpenMP for its atomic operations alone, which need no run-time library;
!> without OpenMP two threads that fail at the same instant may both print. A forked process inherits what was said
!> before; the ranks of MPI are processes of their own.
module mud_once
   use, intrinsic :: iso_c_binding, only: c_char, c_funloc, c_funptr, c_int, c_size_t
   use, intrinsic :: iso_fortran_env, only: int32
   implicit none (type, external)
   private
   public :: first_time, write_message, report_at_exit, environment_is, may_use_threads, KINDS

   integer, parameter :: BITS = 31, WORDS = 700   !< Bits of a word in use (the sign is left alone), and words.
   integer, parameter :: KINDS = WORDS*BITS       !< Sentences are numbered from 0 to KINDS - 1.
   character(*), parameter :: SILENCER = 'MUD_MESSAGES'
   integer(c_int), parameter :: STANDARD_ERROR = 2
   integer, parameter :: SPOILED = WORDS          !< Place of a number: how many increments were answered with NaN.
   integer, parameter :: THREADED = WORDS + 1     !< Place of the process that used threads, 0: none yet.
   !> One bit a kind, and behind them SPOILED and THREADED; see the head of the module.
   integer(int32) :: told(0:WORDS + 1) = 0

   interface
      !> The system's: one call for a whole line, so that the lines of threads and processes do not mix.
      integer(c_size_t) function c_write(file, text, n) bind(c, name='write')
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: file
         character(kind=c_char), intent(in) :: text(*)
         integer(c_size_t), value :: n
      end function c_write

      !> The system's: number of this process.
      integer(c_int) function c_getpid() bind(c, name='getpid')
         import :: c_int
      end function c_getpid

      !> C's: a procedure that the process calls when it ends.
      integer(c_int) function c_atexit(procedure_) bind(c, name='atexit')
         import :: c_funptr, c_int
         type(c_funptr), value :: procedure_
      end function c_atexit
   end interface
contains
   !> True for the first caller of a process that asks for this kind. False for a kind outside 0 to KINDS - 1.
   logical function first_time(kind)
      integer, intent(in) :: kind
      integer(int32) :: before
      integer :: word, bit

      first_time = .false.
      if (kind < 0 .or. kind >= KINDS) return
      word = kind/BITS
      bit = mod(kind, BITS)
      ! A look before the exchange: thousands of failures more do not fight for the word.
      !$omp atomic read
      before = told(word)
      if (btest(before, bit)) return
      !$omp atomic capture
      before = told(word)
      told(word) = ior(told(word), ishft(1_int32, bit))
      !$omp end atomic
      first_time = .not. btest(before, bit)
   end function first_time

   !> One line on standard error, unless the user has silenced the library. That it cannot be written is no failure.
   subroutine write_message(text)
      character(*), intent(in) :: text
      integer(c_size_t) :: length

      if (environment_is(SILENCER, 'off')) return
      length = len_trim(text) + 1
      length = c_write(STANDARD_ERROR, trim(text)//new_line(text), length)
   end subroutine write_message

   !> Counts an increment whose refusal the host sees as a NaN alone. The process tells their number when it ends, for a
   !> host that goes on with a NaN ends like one that has computed something: the first sentence is far above its last.
   subroutine report_at_exit()
      integer(int32) :: number
      integer(c_int) :: code

      !$omp atomic capture
      number = told(SPOILED)
      told(SPOILED) = told(SPOILED) + 1_int32
      !$omp end atomic
      if (number == 0) code = c_atexit(c_funloc(write_last_sentence))
   end subroutine report_at_exit

   !> The last sentence of a process.
   subroutine write_last_sentence() bind(c, name='')
      character(12) :: number

      write (number, '(i0)') told(SPOILED)
      call write_message('MUD: at the end of this process: refused increments whose stress was set to NaN: '// &
                 trim(number)//'. Unless the host has repeated them with smaller ones, its results from the first '// &
                 'of them on (see above) are no results')
   end subroutine write_last_sentence

   !> True if this process may use threads, as it is then taken to do. False in one that was forked from a process that
   !> used them: OpenMP would wait for ever for the threads, which stayed behind.
   logical function may_use_threads()
      integer(int32) :: before, here

      here = int(c_getpid(), int32)
      !$omp atomic read
      before = told(THREADED)
      may_use_threads = before == 0 .or. before == here
      if (before /= 0) return
      !$omp atomic write
      told(THREADED) = here
   end function may_use_threads

   !> True if an environment variable has this value. False where it is not set or longer than 32 characters.
   logical function environment_is(name, value)
      character(*), intent(in) :: name, value
      character(32) :: found
      integer :: length, code

      call get_environment_variable(name, found, length, code)
      environment_is = code == 0 .and. length == len(value) .and. found == value
   end function environment_is
end module mud_once
