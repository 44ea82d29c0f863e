! SPDX-License-Identifier: MIT
!> Results: rows of a CSV file, or of a table in memory.
module triax_output
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   use library_tables, only: library_version
   use material_point, only: remark_t
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use texts, only: joined, short, lower_case
   use triax_case, only: case_t
   use triax_columns, only: COLUMNS, columns_shown, values_of
   use triax_stage_run, only: stage_run_t
   use stress_units, only: stress_unit_t
   use csv, only: csv_t, open_csv, write_line, close_csv
   use triax_point, only: soil_t, point_t
   implicit none (type, external)
   private
   public :: table_t, open_table, open_memory_table, write_row, add_note, close_table

   !> An output file, or a table in memory.
   type :: table_t
      type(csv_t) :: csv
      logical :: to_screen = .false.   !< The file is the standard output.
      logical :: keeps = .false.       !< The table is in memory.
      logical :: closed = .true.
      integer, allocatable :: shown(:)      !< Numbers of the columns that are written.
      integer :: rows = 0
      type(stress_unit_t) :: unit
      character(:), allocatable :: path
      real(wp), allocatable :: kept(:, :)   !< rows (room for more), columns
      character(:), allocatable :: remarks  !< Facts of a table in memory, a line each.
   end type table_t

contains
   !> Opens the file and writes its header. Fault EXIT_OUTPUT: it cannot be written, or its name asks for HDF5.
   subroutine open_table(path, test, table, fault)
      character(*), intent(in) :: path   !< '-' is the standard output.
      type(case_t), intent(in) :: test
      type(table_t), intent(out) :: table
      type(fault_t), intent(inout) :: fault

      table%path = path
      table%shown = columns_shown(test%soil, test%stages)
      table%to_screen = path == '-'
      if (ends_in(path, '.h5') .or. ends_in(path, '.hdf5')) then
         call raise(fault, EXIT_OUTPUT, path//': mud_triax writes CSV, no HDF5; name a file that ends in .csv. '// &
                    'drivers/README.md, Columns, has a line of Python that converts it.')
      else
         call open_csv(path, size(table%shown), table%csv, fault)
      end if
      if (fault%code /= 0) return
      table%closed = .false.
      call header(test, table, fault)
   end subroutine open_table

   !> Opens a table that stays in memory. Raises no fault.
   subroutine open_memory_table(test, table, fault)
      type(case_t), intent(in) :: test
      type(table_t), intent(out) :: table
      type(fault_t), intent(inout) :: fault

      table%path = ''
      table%shown = columns_shown(test%soil, test%stages)
      table%remarks = ''
      table%keeps = .true.
      allocate (table%kept(0, size(table%shown)))
      table%closed = .false.
      call header(test, table, fault)
   end subroutine open_memory_table

   pure logical function ends_in(path, ending)
      character(*), intent(in) :: path, ending

      ends_in = .false.
      if (len(path) > len(ending)) ends_in = lower_case(path(len(path) - len(ending) + 1:)) == ending
   end function ends_in

   subroutine header(test, table, fault)
      type(case_t), intent(in) :: test
      type(table_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault
      type(remark_t), allocatable :: remarks(:)
      character(:), allocatable :: unit
      integer :: i

      table%unit = test%soil%law%unit
      unit = trim(table%unit%name)
      call remark(table, 'case', trim(test%name), fault)
      if (len_trim(test%title) > 0) call remark(table, 'title', trim(test%title), fault)
      call remark(table, 'material', trim(test%material), fault)
      call test%soil%law%remarks(remarks)
      do i = 1, size(remarks)
         call remark(table, trim(remarks(i)%name), trim(remarks(i)%text), fault)
      end do
      if (test%soil%law%doubt /= '') call remark(table, 'warning', trim(test%soil%law%doubt), fault)
      call remark(table, 'library', 'MUD '//library_version(), fault)
      call remark(table, 'conventions', 'compression positive; stresses are effective ['//unit//'], suction and u '// &
                  '['//unit//'], strains and the rest [-]; control_error may be up to '// &
                  short(test%control_tolerance), fault)
      if (.not. table%keeps) call write_line(table%csv, joined(COLUMNS(table%shown)%name, ','), fault)
   end subroutine header

   !> Adds a fact about the run as a comment line. Fault EXIT_OUTPUT: the file cannot be written.
   subroutine remark(table, name, text, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: name, text
      type(fault_t), intent(inout) :: fault

      if (table%keeps) then
         table%remarks = table%remarks//name//': '//text//new_line('a')
      else
         call write_line(table%csv, '# '//name//': '//text, fault)
      end if
   end subroutine remark

   !> Writes how a stage ended, behind its rows. Fault EXIT_OUTPUT: the file cannot be written.
   subroutine add_note(table, text, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: text   !< "name: sentence"
      type(fault_t), intent(inout) :: fault

      call remark(table, text(:index(text, ':') - 1), text(index(text, ':') + 2:), fault)
   end subroutine add_note

   !> Adds the row of a point after an increment of stage number `stage`. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_row(table, soil, point, run, error, stage, fault)
      type(table_t), intent(inout) :: table
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      type(stage_run_t), intent(in) :: run
      real(wp), intent(in) :: error      !< Largest of what is held since the row before, relative.
      integer, intent(in) :: stage
      type(fault_t), intent(inout) :: fault
      real(wp) :: values(size(COLUMNS))
      character(:), allocatable :: text
      integer :: i

      values = values_of(soil, point, run, error, stage)
      table%rows = table%rows + 1
      if (table%keeps) then
         call keep(table, values(table%shown))
         return
      end if
      text = ''
      do i = 1, size(table%shown)
         if (i > 1) text = text//','
         text = text//value_text(values(table%shown(i)), COLUMNS(table%shown(i))%whole)
      end do
      call write_line(table%csv, text, fault)
   end subroutine write_row

   !> Adds a row to those that are kept; their room doubles when it is full.
   subroutine keep(table, values)
      type(table_t), intent(inout) :: table
      real(wp), intent(in) :: values(:)
      real(wp), allocatable :: more(:, :)

      if (table%rows > size(table%kept, 1)) then
         allocate (more(max(256, 2*table%rows), size(table%shown)), source=0.0_wp)
         more(:table%rows - 1, :) = table%kept(:table%rows - 1, :)
         call move_alloc(more, table%kept)
      end if
      table%kept(table%rows, :) = values
   end subroutine keep

   !> All 16 digits, or a count.
   pure function value_text(value, whole_number) result(text)
      real(wp), intent(in) :: value
      logical, intent(in) :: whole_number
      character(:), allocatable :: text
      character(24) :: digits

      if (whole_number) then
         write (digits, '(i0)') nint(value, int64)
      else
         write (digits, '(es23.15e3)') value
      end if
      text = trim(adjustl(digits))
   end function value_text

   !> Closes the file; a run that stopped early says so in a last comment line, so that a short file explains itself.
   !> Fault EXIT_OUTPUT: it cannot be written; an earlier fault stays.
   subroutine close_table(table, stopped, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: stopped   !< Why, empty if it did not.
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: last

      if (table%closed) return
      table%closed = .true.
      if (len(stopped) > 0) call remark(table, 'stopped', stopped, last)
      if (.not. table%keeps) call close_csv(table%csv, last)
      if (fault%code == 0) fault = last
   end subroutine close_table
end module triax_output
