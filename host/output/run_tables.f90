! SPDX-License-Identifier: MIT
!> Tables of a run: such that a restart goes on with, row by row, and such that are written as a whole.
module run_tables
   use archive, only: archive_t
   use csv, only: csv_t, new_csv, resume_csv, flush_csv, close_csv, write_row, is_open, NUMBERS
   use faults, only: fault_t
   use kinds, only: wp
   use texts, only: joined
   implicit none (type, external)
   private
   public :: open_table, exchange_table, write_table, columns_of
contains
   !> Opens a new table; or, after a restart, the one of the run as it was at its checkpoint, if it had a row. Fault
   !> EXIT_OUTPUT: it cannot be written.
   subroutine open_table(path, head, table, fault)
      character(*), intent(in) :: path, head
      type(csv_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault

      if (fault%code /= 0) return
      if (table%bytes > 0) then
         call resume_csv(path, head, table, fault)
      else
         call new_csv(path, head, table, fault)
      end if
   end subroutine open_table

   !> Exchanges the length of a table with a checkpoint, which counts on what it has brought to the disk.
   subroutine exchange_table(name, table, archive)
      character(*), intent(in) :: name
      type(csv_t), intent(inout) :: table
      class(archive_t), intent(inout) :: archive
      type(fault_t) :: fault

      if (.not. archive%reading .and. is_open(table)) call flush_csv(table, fault)
      if (fault%code /= 0) call archive%refuse()
      call archive%exchange(name//'_bytes', table%bytes, '-', 'bytes of the table '//name)
   end subroutine exchange_table

   !> Writes a table as a whole, unless there is a fault already. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_table(path, head, values, fault)
      character(*), intent(in) :: path, head
      real(wp), intent(in) :: values(:, :)   !< (columns, rows)
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: table
      integer :: i

      if (fault%code /= 0) return
      call new_csv(path, head, table, fault)
      do i = 1, size(values, 2)
         if (fault%code /= 0) exit
         write (table%row, NUMBERS) values(:, i)
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   end subroutine write_table

   !> Names the columns of one thing, as ",NAME.PART,NAME.PART": they stand behind others.
   pure function columns_of(name, parts) result(columns)
      character(*), intent(in) :: name, parts(:)
      character(:), allocatable :: columns

      columns = ','//trim(name)//'.'//joined(parts, ','//trim(name)//'.')
   end function columns_of
end module run_tables
