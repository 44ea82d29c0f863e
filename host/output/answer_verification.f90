! SPDX-License-Identifier: MIT
!> Two runs of a scene compared: how far the histories of the named points lie apart.
!> docs/theory/host.md section 4.5.
module answer_verification
   use kinds, only: wp
   use csv, only: cells_of
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use files, only: read_whole
   use history_distance, only: farthest
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: history_t, read_history, differences, read_numbers, NAME_LENGTH

   integer, parameter :: NAME_LENGTH = 160         !< Characters of the name of a column.

   type :: history_t
      real(wp), allocatable :: time(:)             !< [s]
      real(wp), allocatable :: x(:, :, :)          !< (FIELDS, points, rows)
   end type history_t

contains
   !> The histories that a run has written. Fault EXIT_OUTPUT: histories.csv of the folder cannot be read.
   subroutine read_history(folder, points, columns, history, fault)
      character(*), intent(in) :: folder
      integer, intent(in) :: points, columns   !< Number of points, and of the columns of one.
      type(history_t), intent(out) :: history
      type(fault_t), intent(inout) :: fault
      character(NAME_LENGTH), allocatable :: names(:)
      real(wp), allocatable :: numbers(:, :)
      integer :: i

      call read_numbers(folder//'/histories.csv', names, numbers, fault)
      if (fault%code /= 0) return
      history%time = numbers(1, :)
      allocate (history%x(FIELDS, points, size(numbers, 2)))
      do i = 1, points
         history%x(:, i, :) = numbers(2 + (i - 1)*columns:1 + (i - 1)*columns + FIELDS, :)
      end do
   end subroutine read_history

   !> Names and numbers of a table that a run has written. Fault EXIT_OUTPUT: it cannot be read.
   subroutine read_numbers(path, names, numbers, fault, only)
      character(*), intent(in) :: path
      character(NAME_LENGTH), allocatable, intent(out) :: names(:)   !< (columns)
      real(wp), allocatable, intent(out) :: numbers(:, :)            !< (columns, rows) 0 where a field is empty.
      type(fault_t), intent(inout) :: fault
      character(*), intent(in), optional :: only(:)   !< The columns that are read, as far as they are there; else all.
      character(:), allocatable :: text
      integer, allocatable :: column(:)
      logical :: good
      integer :: first, last, row, rows, status, i, k

      call read_whole(path, text, good)
      if (good) good = index(text, new_line('a')) > 0
      if (good) then
         last = index(text, new_line('a'))
         call cells_of(text(:last - 1), names)
         status = 0
         column = [(i, i=1, size(names))]
         if (present(only)) column = pack(column, [(any(only == names(i)), i=1, size(names))])
         names = names(column)
         rows = 0
         do i = last + 1, len(text)
            if (text(i:i) == new_line('a')) rows = rows + 1
         end do
         allocate (numbers(size(column), rows), source=0.0_wp)
         do row = 1, rows
            first = last + 1
            k = 0
            do i = 1, size(column)
               ! To the field of the column: behind the comma, or the end of the row before.
               do while (k < column(i))
                  first = last + 1
                  last = last + scan(text(first:), ','//new_line('a'))
                  k = k + 1
               end do
               if (len_trim(text(first:last - 1)) > 0) read (text(first:last - 1), *, iostat=status) numbers(i, row)
               if (status /= 0) exit
            end do
            if (status /= 0) exit
            if (text(last:last) /= new_line('a')) last = last + index(text(last + 1:), new_line('a'))
         end do
         good = status == 0
      end if
      if (.not. good) call raise(fault, EXIT_OUTPUT, path//' cannot be read back for the comparison of the two runs.')
   end subroutine read_numbers

   !> Largest distance of two histories at the times of the first, straight lines between the rows of the second. [m,
   !> kPa] docs/theory/host.md section 4.5.
   pure function differences(one, two) result(apart)
      type(history_t), intent(in) :: one, two
      real(wp) :: apart(FIELDS, size(one%x, 2))
      integer :: i, f

      do i = 1, size(one%x, 2)
         do f = 1, FIELDS
            apart(f, i) = abs(farthest(one%time, one%x(f, i, :), two%time, two%x(f, i, :)))
         end do
      end do
   end function differences
end module answer_verification
