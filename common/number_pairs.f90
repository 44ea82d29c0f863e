! SPDX-License-Identifier: MIT
!> Files of two numbers a line, as a history or a measured curve; `!` or `#` begins a comment.
module number_pairs
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use files, only: beside
   use texts, only: whole, read_number, mark_length
   implicit none (type, external)
   private
   public :: read_pairs

   integer, parameter :: LINE_LENGTH = 1024
contains
   !> Reads both columns of a file; a relative path begins at the folder of the file that names it. first(:) and
   !> second(:) are as long as the file has pairs, in the units of the file. A fault (EXIT_INPUT), with file and line,
   !> where it cannot be read or a line is no pair.
   subroutine read_pairs(named, from_file, from_line, meaning, first, second, fault)
      character(*), intent(in) :: named       !< Path as it is written.
      character(*), intent(in) :: from_file   !< File that names it, and where.
      integer, intent(in) :: from_line
      character(*), intent(in) :: meaning     !< Meaning of the two numbers, as "a time and a factor".
      real(wp), allocatable, intent(out) :: first(:), second(:)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: path
      character(LINE_LENGTH) :: line
      real(wp), allocatable :: pairs(:, :), wider(:, :)
      logical :: good(2)
      integer :: unit, status, n, last, count

      path = beside(from_file, named)
      allocate (first(0), second(0), pairs(2, 64))
      open (newunit=unit, file=path, status='old', action='read', iostat=status)
      if (status /= 0) then
         call raise(fault, EXIT_INPUT, at_line(from_file, from_line)//path//' cannot be read.')
         return
      end if
      n = 0
      count = 0
      do
         read (unit, '(a)', iostat=status) line
         if (is_iostat_end(status)) exit
         n = n + 1
         if (status /= 0) then
            call raise(fault, EXIT_INPUT, at_line(path, n)//'cannot be read.')
            exit
         else if (len_trim(line) == LINE_LENGTH) then
            call raise(fault, EXIT_INPUT, at_line(path, n)//'the line is longer than '//whole(LINE_LENGTH - 1)// &
                       ' characters.')
            exit
         end if
         if (n == 1) line = line(1 + mark_length(line):)
         line = adjustl(blank(line(:scan(line//'!', '!#') - 1)))
         if (line == '') cycle
         last = index(line, ' ')
         if (count == size(pairs, 2)) then
            allocate (wider(2, 2*count))
            wider(:, :count) = pairs
            call move_alloc(wider, pairs)
         end if
         call read_number(line(:last), pairs(1, count + 1), good(1))
         call read_number(adjustl(line(last:)), pairs(2, count + 1), good(2))
         if (.not. all(good)) then
            call raise(fault, EXIT_INPUT, at_line(path, n)//'"'//trim(line(:min(60, len(line))))// &
                       '" is not '//meaning//', two finite numbers.')
            exit
         end if
         count = count + 1
      end do
      close (unit)
      first = pairs(1, :count)
      second = pairs(2, :count)
   end subroutine read_pairs

   !> Commas, tabs and returns divide as blanks do.
   pure function blank(text)
      character(*), intent(in) :: text
      character(len(text)) :: blank
      integer :: i

      blank = text
      do i = 1, len(text)
         if (scan(text(i:i), ','//achar(9)//achar(13)) > 0) blank(i:i) = ' '
      end do
   end function blank
end module number_pairs
