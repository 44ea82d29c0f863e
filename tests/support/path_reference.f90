! SPDX-License-Identifier: MIT
!> Tables of numbers in verification/material/reference of the source tree.
module path_reference
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: table_t, read_table

   integer, parameter :: LINE_LENGTH = 4000, MOST_ROWS = 2000

   !> One column of `value` per row of the file.
   type :: table_t
      integer :: rows = 0
      real(wp), allocatable :: value(:, :)
   end type table_t
contains
   !> Reads rows of numbers separated by commas, without lines that begin with #. The folder of the sources is in the
   !> environment variable MUD_SOURCE_DIR; a file that cannot be read stops the test program.
   function read_table(name, columns) result(table)
      character(*), intent(in) :: name
      integer, intent(in) :: columns
      type(table_t) :: table
      character(LINE_LENGTH) :: line, folder
      integer :: unit, status

      call get_environment_variable('MUD_SOURCE_DIR', folder)
      open (newunit=unit, file=trim(folder)//'/verification/material/reference/'//name, status='old', action='read', &
            iostat=status)
      if (status /= 0) error stop 'path_reference: a reference file is missing; is MUD_SOURCE_DIR set?'
      allocate (table%value(columns, MOST_ROWS))
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         if (line(1:1) == '#' .or. len_trim(line) == 0) cycle
         table%rows = table%rows + 1
         read (line, *) table%value(:, table%rows)
      end do
      close (unit)
   end function read_table
end module path_reference
