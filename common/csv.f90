! SPDX-License-Identifier: MIT
!> Text tables, written through the C library, which reports a full disk; the Fortran runtime buffers formatted records
!> and does not report that writing them failed.
module csv
   use, intrinsic :: iso_c_binding, only: c_ptr, c_null_ptr, c_null_char, c_associated, c_size_t, c_long, c_loc
   use, intrinsic :: iso_fortran_env, only: int64
   use files, only: fopen, open_output, fwrite, fflush, fclose, fsync, fileno, truncate
   use faults, only: fault_t, raise, EXIT_OUTPUT, EXIT_RESTART
   implicit none (type, external)
   private
   public :: csv_t, open_csv, new_csv, check_csv, resume_csv, write_row, write_line, hand_over, flush_csv, close_csv
   public :: is_open, columns_of, quoted, NUMBERS

   character(*), parameter :: NUMBERS = '(*(es24.16e3,:,","))'   !< Format of a row of numbers.
   integer, parameter :: CELL = 25                               !< Characters of a number in such a row.

   type :: csv_t
      character(:), allocatable :: path
      character(:), allocatable :: row    !< The next row is composed here: room for every column.
      integer(int64) :: bytes = 0         !< Length so far; before `resume_csv`: what is to be kept.
      type(c_ptr) :: file = c_null_ptr
   end type csv_t
contains
   !> Opens a new file; its columns are named in `head`. A fault (EXIT_OUTPUT) where it cannot be written.
   subroutine new_csv(path, head, table, fault)
      character(*), intent(in) :: path, head
      type(csv_t), intent(out) :: table
      type(fault_t), intent(inout) :: fault

      call open_csv(path, columns_of(head), table, fault)
      if (fault%code == 0) call write_line(table, head, fault)
   end subroutine new_csv

   !> Opens a new, empty file; '-' is the standard output. A fault (EXIT_OUTPUT) where it cannot be made.
   subroutine open_csv(path, columns, table, fault)
      character(*), intent(in) :: path
      integer, intent(in) :: columns   !< For which a row has room.
      type(csv_t), intent(out) :: table
      type(fault_t), intent(inout) :: fault

      table%path = path
      allocate (character(CELL*columns) :: table%row)
      if (path == '-') then
         table%path = 'the standard output'
         table%file = open_output()
      else
         table%file = fopen(path//c_null_char, 'wb'//c_null_char)
      end if
      if (.not. is_open(table)) then
         call raise(fault, EXIT_OUTPUT, table%path//' cannot be written; does the folder exist, is the disk full?')
      end if
   end subroutine open_csv

   !> Counts the columns that the first line of a table names; a comma in quotes ends none.
   pure integer function columns_of(head)
      character(*), intent(in) :: head
      logical :: inside
      integer :: i

      columns_of = 1
      inside = .false.
      do i = 1, len(head)
         if (head(i:i) == '"') inside = .not. inside
         if (head(i:i) == ',' .and. .not. inside) columns_of = columns_of + 1
      end do
   end function columns_of

   !> Writes a text as a cell: in quotes where it has a comma or quotes, which are doubled.
   pure function quoted(text) result(cell)
      character(*), intent(in) :: text
      character(:), allocatable :: cell
      integer :: i

      cell = text
      if (scan(text, ',"') == 0) return
      cell = '"'
      do i = 1, len(text)
         cell = cell//text(i:i)
         if (text(i:i) == '"') cell = cell//'"'
      end do
      cell = cell//'"'
   end function quoted

   !> Whether the file of a table is open.
   pure logical function is_open(table)
      type(csv_t), intent(in) :: table

      is_open = c_associated(table%file)
   end function is_open

   !> Checks that the table of an interrupted run exists, is as long as at the checkpoint and can be written; changes
   !> nothing. Length in bytes; 0: there is none. What is wrong is a fault (EXIT_RESTART); an earlier one stays.
   subroutine check_csv(path, bytes, fault)
      character(*), intent(in) :: path
      integer(int64), intent(in) :: bytes
      type(fault_t), intent(inout) :: fault
      type(c_ptr) :: file
      logical :: good

      if (bytes == 0 .or. fault%code /= 0) return
      file = fopen(path//c_null_char, 'r+b'//c_null_char)
      good = c_associated(file)
      if (good) good = fclose(file) == 0
      if (good) good = size_of(path) >= bytes
      if (.not. good) call raise(fault, EXIT_RESTART, path//' is missing, shorter than at the checkpoint, '// &
                                 'or cannot be written; --output must name the folder of the interrupted run.')
   end subroutine check_csv

   !> Opens a table that was checked and cuts off what follows its first `table%bytes`. A fault (EXIT_OUTPUT) where that
   !> fails.
   subroutine resume_csv(path, head, table, fault)
      character(*), intent(in) :: path, head
      type(csv_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault
      logical :: good

      table%path = path
      if (allocated(table%row)) deallocate (table%row)
      allocate (character(CELL*columns_of(head)) :: table%row)
      good = truncate(path//c_null_char, int(table%bytes, c_long)) == 0
      if (good) table%file = fopen(path//c_null_char, 'ab'//c_null_char)
      if (good) good = is_open(table)
      if (.not. good) call raise_unwritten(table, fault)
   end subroutine resume_csv

   integer(int64) function size_of(path) result(bytes)
      character(*), intent(in) :: path

      inquire (file=path, size=bytes)
   end function size_of

   !> Writes the row that was composed in `table%row`, without the blanks at its end. As write_line.
   subroutine write_row(table, fault)
      type(csv_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault

      call put_text(table, table%row(:len_trim(table%row))//new_line('a'), fault)
   end subroutine write_row

   !> Writes a text as one line; a fault if it cannot be written. The fault is EXIT_OUTPUT; after an earlier one nothing
   !> is written.
   subroutine write_line(table, text, fault)
      type(csv_t), intent(inout) :: table
      character(*), intent(in) :: text
      type(fault_t), intent(inout) :: fault

      call put_text(table, text//new_line('a'), fault)
   end subroutine write_line

   subroutine put_text(table, text, fault)
      type(csv_t), intent(inout) :: table
      character(*), intent(in), target :: text
      type(fault_t), intent(inout) :: fault

      if (fault%code /= 0) return   ! the first fault is the one that is told
      if (fwrite(c_loc(text), 1_c_size_t, len(text, kind=c_size_t), table%file) == len(text, kind=c_size_t)) then
         table%bytes = table%bytes + len(text)
      else
         call raise_unwritten(table, fault)
      end if
   end subroutine put_text

   !> Hands what was written to the system: a program that is killed leaves whole rows. A fault (EXIT_OUTPUT) where that
   !> fails; a table that is not open is left alone.
   subroutine hand_over(table, fault)
      type(csv_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault

      if (.not. is_open(table) .or. fault%code /= 0) return
      if (fflush(table%file) /= 0) call raise_unwritten(table, fault)
   end subroutine hand_over

   !> Flushes what was written to the disk. A fault (EXIT_OUTPUT) where that fails; not of a pipe.
   subroutine flush_csv(table, fault)
      type(csv_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault

      if (fflush(table%file) /= 0) then
         call raise_unwritten(table, fault)
      else if (fsync(fileno(table%file)) /= 0) then
         ! What is no regular file, as a pipe, has no size and no place on a disk.
         if (size_of(table%path) >= table%bytes) call raise_unwritten(table, fault)
      end if
   end subroutine flush_csv

   !> Closes the table. A disk that is full for the last rows may be noticed only here. The fault is EXIT_OUTPUT, an
   !> earlier one stays; a table that is not open is left alone.
   subroutine close_csv(table, fault)
      type(csv_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault

      if (.not. is_open(table)) return
      if (fclose(table%file) /= 0 .and. fault%code == 0) call raise_unwritten(table, fault)
      table%file = c_null_ptr
   end subroutine close_csv

   subroutine raise_unwritten(table, fault)
      type(csv_t), intent(in) :: table
      type(fault_t), intent(inout) :: fault

      call raise(fault, EXIT_OUTPUT, table%path//' cannot be written; is the disk full?')
   end subroutine raise_unwritten
end module csv
