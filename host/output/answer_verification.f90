! SPDX-License-Identifier: MIT
!> Two runs of a scene compared: how far the histories of the named points lie apart. docs/theory/host.md section 4.5.
module answer_verification
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use history_distance, only: farthest
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: history_t, read_history, differences

   integer, parameter :: NUMBER_LENGTH = 26        !< Characters that a number and its comma take at most.

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
      character(NUMBER_LENGTH*(1 + columns*points)) :: line
      real(wp) :: numbers(1 + columns*points)
      integer :: unit, status, rows, pass, i

      open (newunit=unit, file=folder//'/histories.csv', status='old', action='read', iostat=status)
      do pass = 1, 2
         if (status /= 0) exit
         rewind (unit)
         read (unit, '(a)', iostat=status)
         rows = 0
         do while (status == 0)
            read (unit, '(a)', iostat=status) line
            if (status /= 0) exit
            rows = rows + 1
            if (pass == 1) cycle
            read (line, *, iostat=status) numbers
            if (status /= 0) exit
            history%time(rows) = numbers(1)
            do i = 1, points
               history%x(:, i, rows) = numbers(2 + (i - 1)*columns:1 + (i - 1)*columns + FIELDS)
            end do
         end do
         ! The end of the file is what a pass comes to.
         if (status < 0) status = 0
         if (pass == 1 .and. status == 0) allocate (history%time(rows), history%x(FIELDS, points, rows))
      end do
      if (status /= 0 .or. .not. allocated(history%time)) call raise(fault, EXIT_OUTPUT, folder//'/histories.csv '// &
         'cannot be read back for the comparison of the two runs.')
   end subroutine read_history

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
