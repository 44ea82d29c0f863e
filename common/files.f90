! SPDX-License-Identifier: MIT
!> Files that are written completely or not at all, and other calls of the system (POSIX) that Fortran lacks.
module files
   use, intrinsic :: iso_c_binding, only: c_int, c_int8_t, c_size_t, c_long, c_short, c_char, c_ptr, c_null_char, &
                                          c_associated, c_loc, c_funptr, c_null_funptr, c_intptr_t
   use, intrinsic :: iso_fortran_env, only: output_unit
   implicit none (type, external)
   private
   public :: write_whole, name_part, remove_part, PART, read_whole, bytes_of, make_folder, folder_of, beside, &
             to_terminal, terminal_width, limits_are_errors
   public :: fopen, open_output, fwrite, fflush, fileno, fclose, fsync, truncate, signal

   character(*), parameter :: PART = '.part'   !< Ends the name of a file that is being written.

   interface
      !> Opens a file; a null pointer where it cannot be opened. path and mode end with a null character.
      type(c_ptr) function fopen(path, mode) bind(c)
         import :: c_ptr, c_char
         character(kind=c_char), intent(in) :: path(*), mode(*)
      end function fopen

      !> Writes count items of size bytes; how many were written, fewer after a failure.
      integer(c_size_t) function fwrite(data, size, count, file) bind(c)
         import :: c_ptr, c_size_t
         type(c_ptr), value :: data, file
         integer(c_size_t), value :: size, count
      end function fwrite

      integer(c_size_t) function fread(data, size, count, file) bind(c)
         import :: c_ptr, c_size_t
         type(c_ptr), value :: data, file
         integer(c_size_t), value :: size, count
      end function fread

      integer(c_int) function ferror(file) bind(c)
         import :: c_ptr, c_int
         type(c_ptr), value :: file
      end function ferror

      !> Hands what is buffered to the system; 0, or not 0 after a failure.
      integer(c_int) function fflush(file) bind(c)
         import :: c_ptr, c_int
         type(c_ptr), value :: file
      end function fflush

      !> Returns the descriptor of an open file, -1 after a failure.
      integer(c_int) function fileno(file) bind(c)
         import :: c_ptr, c_int
         type(c_ptr), value :: file
      end function fileno

      !> Closes a file; 0, or not 0 where its last bytes could not be written.
      integer(c_int) function fclose(file) bind(c)
         import :: c_ptr, c_int
         type(c_ptr), value :: file
      end function fclose

      !> Waits until a file is on the disk; 0, or -1 after a failure.
      integer(c_int) function fsync(descriptor) bind(c)
         import :: c_int
         integer(c_int), value :: descriptor
      end function fsync

      integer(c_int) function c_rename(from, to) bind(c, name='rename')
         import :: c_int, c_char
         character(kind=c_char), intent(in) :: from(*), to(*)
      end function c_rename

      integer(c_int) function c_remove(path) bind(c, name='remove')
         import :: c_int, c_char
         character(kind=c_char), intent(in) :: path(*)
      end function c_remove

      !> Cuts a file to a length in bytes; 0, or -1 after a failure. path ends with a null character.
      integer(c_int) function truncate(path, length) bind(c)
         import :: c_int, c_char, c_long
         character(kind=c_char), intent(in) :: path(*)
         integer(c_long), value :: length
      end function truncate

      integer(c_int) function mkdir(path, mode) bind(c)
         import :: c_int, c_char
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
      end function mkdir

      !> Sets what a signal of the system does, and returns what it did before.
      type(c_funptr) function signal(number, action) bind(c)
         import :: c_int, c_funptr
         integer(c_int), value :: number
         type(c_funptr), value :: action
      end function signal

      type(c_ptr) function fdopen(descriptor, mode) bind(c)
         import :: c_ptr, c_int, c_char
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: mode(*)
      end function fdopen

      integer(c_int) function dup(descriptor) bind(c)
         import :: c_int
         integer(c_int), value :: descriptor
      end function dup

      integer(c_int) function isatty(descriptor) bind(c)
         import :: c_int
         integer(c_int), value :: descriptor
      end function isatty

      !> Asks for rows, columns and pixels of a terminal; -1 where the system knows the request by another number.
      integer(c_int) function ioctl(descriptor, request, sizes) bind(c)
         import :: c_int, c_long, c_short
         integer(c_int), value :: descriptor
         integer(c_long), value :: request
         integer(c_short), intent(inout) :: sizes(4)
      end function ioctl
   end interface
contains
   !> Replaces a file atomically: a reader finds either the complete old file or the complete new one. The new file gets
   !> the name only after its data are on the disk. On failure the old file stays. good is false then. bytes(:) of any
   !> size.
   subroutine write_whole(path, bytes, good)
      character(*), intent(in) :: path
      integer(c_int8_t), intent(in), contiguous, target :: bytes(:)
      logical, intent(out) :: good
      character(:), allocatable :: temporary
      type(c_ptr) :: file

      temporary = path//PART//c_null_char
      file = fopen(temporary, 'wb'//c_null_char)
      good = c_associated(file)
      if (.not. good) return
      good = fwrite(c_loc(bytes), 1_c_size_t, size(bytes, kind=c_size_t), file) == size(bytes, kind=c_size_t)
      if (good) good = fflush(file) == 0
      if (good) good = fsync(fileno(file)) == 0
      if (fclose(file) /= 0) good = .false.
      if (good) good = c_rename(temporary, path//c_null_char) == 0
      if (good) then
         call settle_file(folder_of(path))
      else
         call remove_part(path)
      end if
   end subroutine write_whole

   !> Gives a file that was written under path//PART its name, once it is on the disk. good is false if that fails.
   subroutine name_part(path, good)
      character(*), intent(in) :: path
      logical, intent(out) :: good
      type(c_ptr) :: file

      file = fopen(path//PART//c_null_char, 'rb'//c_null_char)
      good = c_associated(file)
      if (.not. good) return
      good = fsync(fileno(file)) == 0
      if (fclose(file) /= 0) good = .false.
      if (good) good = c_rename(path//PART//c_null_char, path//c_null_char) == 0
      if (good) call settle_file(folder_of(path))
   end subroutine name_part

   !> Removes path//PART, if it is there.
   subroutine remove_part(path)
      character(*), intent(in) :: path
      integer(c_int) :: status

      status = c_remove(path//PART//c_null_char)
   end subroutine remove_part

   !> Reads a whole file as text. Not by a Fortran unit: two threads that read one file would be refused. good is false,
   !> and text is what was read, where that fails.
   subroutine read_whole(path, text, good)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: text
      logical, intent(out) :: good
      integer(c_size_t), parameter :: FIRST_ROOM = 65536
      character(:), allocatable, target :: room
      character(:), allocatable :: larger
      integer(c_size_t) :: filled, got
      type(c_ptr) :: file

      text = ''
      file = fopen(trim(path)//c_null_char, 'rb'//c_null_char)
      good = c_associated(file)
      if (.not. good) return
      allocate (character(FIRST_ROOM) :: room)
      filled = 0
      do
         got = fread(c_loc(room(filled + 1:filled + 1)), 1_c_size_t, len(room, c_size_t) - filled, file)
         filled = filled + got
         if (filled < len(room, c_size_t)) exit
         ! The room doubles: a long file is not copied for each of its pieces.
         allocate (character(2*filled) :: larger)
         larger(:filled) = room
         call move_alloc(larger, room)
      end do
      text = room(:filled)
      good = ferror(file) == 0
      if (fclose(file) /= 0) good = .false.
   end subroutine read_whole

   !> Opens the standard output as a file of its own: to close it leaves the standard output open. A null pointer where
   !> that fails.
   type(c_ptr) function open_output()
      flush (output_unit)
      open_output = fdopen(dup(1_c_int), 'wb'//c_null_char)
   end function open_output

   !> Returns the folder of a path without its closing slash, '.' if the path has none.
   pure function folder_of(path) result(folder)
      character(*), intent(in) :: path
      character(:), allocatable :: folder

      integer :: slash

      folder = '.'
      slash = index(path, '/', back=.true.)
      if (slash > 0) folder = path(:max(1, slash - 1))
   end function folder_of

   !> Finds the path of a file that another file names: a relative one begins at the folder of that.
   pure function beside(file, named) result(path)
      character(*), intent(in) :: file, named
      character(:), allocatable :: path

      path = named
      if (index(named, '/') /= 1) path = file(:index(file, '/', back=.true.))//named
   end function beside

   !> Makes a folder and those above it; whether it is there then shows with the first file. Nothing is reported.
   subroutine make_folder(path)
      character(*), intent(in) :: path
      integer(c_int), parameter :: OPEN_TO_ALL = int(o'777', c_int)   ! less the umask
      integer(c_int) :: status
      integer :: i

      do i = 2, len(path)
         if (path(i:i) == '/') status = mkdir(path(:i - 1)//c_null_char, OPEN_TO_ALL)
      end do
      status = mkdir(path//c_null_char, OPEN_TO_ALL)
   end subroutine make_folder

   !> Asks the system to flush a file or a folder to the disk. A failure of this request is ignored.
   subroutine settle_file(path)
      character(*), intent(in) :: path
      type(c_ptr) :: file
      integer(c_int) :: status

      file = fopen(path//c_null_char, 'r'//c_null_char)
      if (.not. c_associated(file)) return
      status = fsync(fileno(file))
      status = fclose(file)
   end subroutine settle_file

   !> Returns the characters of a text as bytes.
   pure function bytes_of(text) result(bytes)
      character(*), intent(in) :: text
      integer(c_int8_t) :: bytes(len(text))

      bytes = transfer(text, bytes)
   end function bytes_of

   !> A file that reaches the limit of its size (ulimit) shall be an error like a full disk, not the end of the program.
   !> Of the system's signal SIGXFSZ, for the whole process; nothing is reported.
   subroutine limits_are_errors()
      integer(c_int), parameter :: SIGXFSZ = 25                 ! Linux, BSD, macOS
      integer(c_intptr_t), parameter :: IGNORE = 1_c_intptr_t   ! SIG_IGN
      type(c_funptr) :: before

      before = signal(SIGXFSZ, transfer(IGNORE, c_null_funptr))
   end subroutine limits_are_errors

   !> Whether standard output is a terminal.
   logical function to_terminal()
      to_terminal = isatty(1_c_int) == 1
   end function to_terminal

   !> Counts columns of the terminal that standard output is; 80 where the system does not say.
   integer function terminal_width() result(width)
      integer(c_long), parameter :: TIOCGWINSZ = int(z'5413', c_long)   ! Linux
      integer(c_short) :: sizes(4)

      width = 80
      sizes = 0
      if (ioctl(1_c_int, TIOCGWINSZ, sizes) == 0 .and. sizes(2) > 0) width = int(sizes(2))
   end function terminal_width
end module files
