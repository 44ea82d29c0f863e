! SPDX-License-Identifier: MIT
!> Reads an increment that the library saved. The format is strict: every line in its place, with its name.
module replay_file
   use, intrinsic :: iso_fortran_env, only: wp => real64, iostat_end
   use, intrinsic :: iso_c_binding, only: c_int, c_null_char
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan, ieee_positive_inf, ieee_negative_inf
   use mud_interface, only: mud_abi_version, mud_count, mud_text, MUD_PROPS, MUD_STATEV, MUD_NAME
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: from_c, lower_case, read_number, whole
   implicit none (type, external)
   private
   public :: increment_t, read_increment

   integer, parameter :: FORMAT_VERSION = 1
   integer, parameter :: LONGEST_LINE = 600   !< The library writes at most 330 characters [-].
   integer, parameter :: LAST_TANGENT = 3
   character(2), parameter :: COMPONENT(6) = ['11', '22', '33', '12', '13', '23']

   !> The arguments of mud_update, in its conventions, and how the update ended when it was saved.
   type :: increment_t
      character(LONGEST_LINE) :: library = '', origin = ''
      integer(c_int) :: status = 0, n_rate = 0, n_substep = 0, n_reject = 0, tangent = 0
      real(wp) :: reached = 0.0_wp, suction = 0.0_wp, dsuction = 0.0_wp, stress(6) = 0.0_wp, dstrain(6) = 0.0_wp
      real(wp), allocatable :: props(:), statev(:)
   end type increment_t

   type :: source_t
      character(:), allocatable :: file
      integer :: unit = -1, line = 0
   end type source_t
contains
   !> Reads a saved increment; a fault names file, line, what was found and what is expected. Fault EXIT_INPUT: the file
   !> cannot be read, is no saved increment, or is of another version of the library. Stresses and suction: in the unit
   !> of p_atm; stress and strain: tension positive.
   subroutine read_increment(file, increment, fault)
      character(*), intent(in) :: file
      type(increment_t), intent(out) :: increment
      type(fault_t), intent(inout) :: fault
      type(source_t) :: source
      character(256) :: problem
      character(LONGEST_LINE) :: word
      integer(c_int) :: version, abi
      integer :: code, i

      source%file = file
      open (newunit=source%unit, file=file, status='old', action='read', form='formatted', iostat=code, iomsg=problem)
      if (code /= 0) then
         call raise(fault, EXIT_INPUT, file//': cannot be read ('//trim(problem)//').')
         return
      end if
      call take_count(source, 'format', -huge(1), huge(1), version, fault)
      if (fault%code == 0 .and. version /= FORMAT_VERSION) then
         call complain(source, 'format '//whole(int(version))//', this program reads format '//whole(FORMAT_VERSION)// &
                       '; replay it with the mud_replay of the library that wrote it.', fault)
      end if
      call take(source, 'library', increment%library, fault)
      call take_count(source, 'abi', -huge(1), huge(1), version, fault)
      abi = mud_abi_version()
      if (fault%code == 0 .and. version /= abi) then
         call complain(source, 'written with ABI '//whole(int(version))//' (MUD '//trim(increment%library)// &
                       '), this library has ABI '//whole(int(abi))// &
                       '; replay it with the mud_replay of the library that wrote it.', fault)
      end if
      call take(source, 'origin', increment%origin, fault, may_be_blank=.true.)
      call take_count(source, 'status', -huge(1), huge(1), increment%status, fault)
      call take_count(source, 'n_rate', 0, huge(1), increment%n_rate, fault)
      call take_count(source, 'n_substep', 0, huge(1), increment%n_substep, fault)
      call take_count(source, 'n_reject', 0, huge(1), increment%n_reject, fault)
      call take_real(source, 'reached', increment%reached, fault)
      call take_count(source, 'tangent', 0, LAST_TANGENT, increment%tangent, fault)
      call take_real(source, 'suction', increment%suction, fault)
      call take_real(source, 'dsuction', increment%dsuction, fault)
      do i = 1, 6
         call take_real(source, 'stress_'//COMPONENT(i), increment%stress(i), fault)
      end do
      do i = 1, 6
         call take_real(source, 'dstrain_'//COMPONENT(i), increment%dstrain(i), fault)
      end do
      call take_list(source, 'props', MUD_PROPS, increment%props, fault)
      call take_list(source, 'statev', MUD_STATEV, increment%statev, fault)
      call take(source, 'end', word, fault, may_be_blank=.true.)
      if (fault%code == 0) then
         call next_line(source, word, code)
         if (code == 0) call complain(source, 'text after `end`; remove it.', fault)
      end if
      close (source%unit, iostat=code)
   end subroutine read_increment

   !> The library's list under its names, as many as it has.
   subroutine take_list(source, key, list, values, fault)
      type(source_t), intent(inout) :: source
      character(*), intent(in) :: key
      integer(c_int), intent(in) :: list
      real(wp), allocatable, intent(out) :: values(:)
      type(fault_t), intent(inout) :: fault
      character(64) :: name
      integer(c_int) :: count, i

      allocate (values(mud_count(list)))
      call take_count(source, key, 0, huge(1), count, fault)
      if (fault%code == 0 .and. count /= size(values)) then
         call complain(source, whole(int(count))//' entries of '//key//', this library has '//whole(size(values))// &
                       '; replay it with the mud_replay of the library that wrote it.', fault)
      end if
      do i = 1, size(values, kind=c_int)
         name = c_null_char
         if (mud_text(list, i - 1, MUD_NAME, name, len(name, kind=c_int)) < 0) name = '?'//c_null_char
         call take_real(source, from_c(name), values(i), fault)
      end do
   end subroutine take_list

   subroutine take_real(source, key, value, fault)
      type(source_t), intent(inout) :: source
      character(*), intent(in) :: key
      real(wp), intent(out) :: value
      type(fault_t), intent(inout) :: fault
      character(LONGEST_LINE) :: word
      logical :: good

      value = 0.0_wp
      call take(source, key, word, fault)
      if (fault%code /= 0) return
      call read_number(word, value, good)
      if (good) return
      ! A host may have handed over anything, and that is what has to be replayed.
      select case (lower_case(word))
      case ('nan')
         value = ieee_value(value, ieee_quiet_nan)
      case ('infinity')
         value = ieee_value(value, ieee_positive_inf)
      case ('-infinity')
         value = ieee_value(value, ieee_negative_inf)
      case default
         call complain(source, '`'//key//'` needs a number (or NaN, Infinity, -Infinity), found `'//trim(word)//'`.', &
                       fault)
      end select
   end subroutine take_real

   subroutine take_count(source, key, lower, upper, value, fault)
      type(source_t), intent(inout) :: source
      character(*), intent(in) :: key
      integer, intent(in) :: lower, upper
      integer(c_int), intent(out) :: value
      type(fault_t), intent(inout) :: fault
      character(LONGEST_LINE) :: word
      integer :: code

      value = 0
      call take(source, key, word, fault)
      if (fault%code /= 0) return
      code = verify(trim(word), '-0123456789')
      if (code == 0) read (word, *, iostat=code) value
      if (code /= 0) then
         call complain(source, '`'//key//'` needs an integer, found `'//trim(word)//'`.', fault)
      else if (value < lower .or. value > upper) then
         call complain(source, '`'//key//'` is '//whole(int(value))//', allowed '//whole(lower)//' to '// &
                       whole(upper)//'.', fault)
      end if
   end subroutine take_count

   !> The rest of the next line, which must begin with the key. Does nothing after a fault.
   subroutine take(source, key, value, fault, may_be_blank)
      type(source_t), intent(inout) :: source
      character(*), intent(in) :: key
      character(LONGEST_LINE), intent(out) :: value
      type(fault_t), intent(inout) :: fault
      logical, intent(in), optional :: may_be_blank
      character(LONGEST_LINE) :: text
      integer :: code, gap

      value = ''
      if (fault%code /= 0) return
      call next_line(source, text, code)
      if (code == iostat_end) then
         call complain(source, 'the file ends where `'//key//'` is expected; it is truncated.', fault)
      else if (code /= 0) then
         call complain(source, 'the line cannot be read; this is no saved increment.', fault)
      else
         gap = index(text, ' ')
         if (text(:gap - 1) /= key) then
            call complain(source, '`'//key//'` is expected here, found `'//text(:min(gap - 1, 60))//'`.', fault)
            if (key == 'format') fault%text = trim(fault%text)//' This is no saved increment of MUD.'
            return
         end if
         value = adjustl(text(gap:))
         if (value == '' .and. .not. present(may_be_blank)) then
            call complain(source, '`'//key//'` has no value.', fault)
         end if
      end if
   end subroutine take

   !> The next line that is neither blank nor a comment; code is iostat's, positive for a line that is too long.
   subroutine next_line(source, text, code)
      type(source_t), intent(inout) :: source
      character(LONGEST_LINE), intent(out) :: text
      integer, intent(out) :: code
      character(LONGEST_LINE + 1) :: raw
      integer :: i

      text = ''
      do
         source%line = source%line + 1
         read (source%unit, '(a)', iostat=code) raw
         if (code /= 0) return
         do i = 1, len(raw)
            if (iachar(raw(i:i)) < 32) raw(i:i) = ' '   ! tabs and the carriage returns of other systems
         end do
         raw = adjustl(raw)
         if (raw == '' .or. raw(1:1) == '#') cycle
         if (raw(LONGEST_LINE + 1:) /= '') code = 1
         text = raw(:LONGEST_LINE)
         if (text(LONGEST_LINE:) /= '') code = 1
         return
      end do
   end subroutine next_line

   subroutine complain(source, text, fault)
      type(source_t), intent(in) :: source
      character(*), intent(in) :: text
      type(fault_t), intent(inout) :: fault

      call raise(fault, EXIT_INPUT, at_line(source%file, source%line)//text)
   end subroutine complain
end module replay_file
