!> Amplitudes of loads and supports (&history of a scene): times and factors from its keys, or from a file
!> of its own with two numbers a line.
module scene_amplitudes
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use namelists, only: group_t
   use texts, only: whole, read_number
   use scene_keys, only: numbers_of, text_of, given
   use scene_types, only: scene_amplitude_t
   implicit none (type, external)
   private
   public :: read_amplitude

   integer, parameter :: LINE_LENGTH = 1024
contains
   subroutine read_amplitude(group, amplitude, fault)
      type(group_t), intent(in) :: group
      type(scene_amplitude_t), intent(out) :: amplitude
      type(fault_t), intent(inout) :: fault

      amplitude%name = text_of(group, 'name')
      if (given(group, 'file')) then
         call read_table(group, amplitude, fault)
      else
         amplitude%times = numbers_of(group, 'times')
         amplitude%values = numbers_of(group, 'values')
      end if
      if (fault%code /= 0) return
      if (size(amplitude%times) == 0 .or. size(amplitude%times) /= size(amplitude%values)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'history '//trim(amplitude%name)// &
                    ' needs as many values as times.')
      else if (any(amplitude%times(2:) <= amplitude%times(:size(amplitude%times) - 1))) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the times of history '// &
                    trim(amplitude%name)//' must ascend.')
      end if
   end subroutine read_amplitude

   !> A file of times and factors, two a line; comments as in a scene.
   subroutine read_table(group, amplitude, fault)
      type(group_t), intent(in) :: group
      type(scene_amplitude_t), intent(inout) :: amplitude
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: path
      character(LINE_LENGTH) :: line
      real(wp) :: pair(2)
      logical :: good(2)
      integer :: unit, status, n, last

      path = text_of(group, 'file')
      if (path(1:1) /= '/') path = group%file(:index(group%file, '/', back=.true.))//path
      amplitude%times = [real(wp) ::]
      amplitude%values = [real(wp) ::]
      open (newunit=unit, file=path, status='old', action='read', iostat=status)
      if (status /= 0) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//path//' cannot be read.')
         return
      end if
      n = 0
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
         line = adjustl(blank(line(:scan(line//'!', '!#') - 1)))
         if (line == '') cycle
         last = index(line, ' ')
         call read_number(line(:last), pair(1), good(1))
         call read_number(adjustl(line(last:)), pair(2), good(2))
         if (.not. all(good)) then
            call raise(fault, EXIT_INPUT, at_line(path, n)//'"'//trim(line(:min(60, len(line))))// &
                       '" is not a time and a factor, two finite numbers.')
            exit
         end if
         amplitude%times = [amplitude%times, pair(1)]
         amplitude%values = [amplitude%values, pair(2)]
      end do
      close (unit)
   end subroutine read_table

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
end module scene_amplitudes
