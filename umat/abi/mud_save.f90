! SPDX-License-Identifier: MIT
!> A failed increment as a small text file, which mud_replay runs alone. The only place of the library that writes a
!> file, and only where it is asked to.
module mud_save
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_size_t, c_associated, &
      c_f_pointer
   use mud_c_api, only: ABI_VERSION, VERSION
   use mud_kernel, only: report_t, output_t, kernel_update
   use mud_kinds, only: wp
   use mud_messages, only: status_text, report_text
   use mud_params, only: completed, is_length
   use mud_registry, only: NPROPS, NSTATV, PROPERTIES, statev_name
   use mud_status, only: MUD_OK, MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, MUD_NOT_WRITTEN
   use mud_to_host, only: put
   implicit none (type, external)
   private
   public :: mud_save_increment, write_increment, PATH_LENGTH

   integer, parameter :: FORMAT_VERSION = 1
   integer, parameter :: PATH_LENGTH = 1024, ORIGIN_LENGTH = 200, PROBLEM_LENGTH = 300
   integer, parameter :: LAST_TANGENT = 3
   character(2), parameter :: COMPONENT(6) = ['11', '22', '33', '12', '13', '23']

   ! C's streams: gfortran's own do not report a full disk, and leave the unit behind when it is.
   interface
      type(c_ptr) function c_fopen(path, mode) bind(c, name='fopen')
         import :: c_ptr, c_char
         character(kind=c_char), intent(in) :: path(*), mode(*)
      end function c_fopen

      integer(c_size_t) function c_fwrite(text, size, n, file) bind(c, name='fwrite')
         import :: c_ptr, c_char, c_size_t
         character(kind=c_char), intent(in) :: text(*)
         integer(c_size_t), value :: size, n
         type(c_ptr), value :: file
      end function c_fwrite

      integer(c_int) function c_fclose(file) bind(c, name='fclose')
         import :: c_ptr, c_int
         type(c_ptr), value :: file
      end function c_fclose

      integer(c_int) function c_remove(path) bind(c, name='remove')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function c_remove
   end interface
contains
   !> See mud.h. The increment is run once more, so that the file says how it ends. Returns MUD_OK whatever that end is;
   !> MUD_NULL_ARGUMENT, MUD_BAD_OPTION, MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_NOT_WRITTEN.
   integer(c_int) function mud_save_increment(path, origin, props, n_props, stress0, statev0, n_statev, dstrain, &
           suction0, dsuction, tangent, text, len) bind(c, name='mud_save_increment')
      type(c_ptr), value :: path, origin, props, stress0, statev0, dstrain, text
      integer(c_int), value :: n_props, n_statev, tangent, len
      real(c_double), value :: suction0, dsuction
      real(c_double), pointer, contiguous :: props_in(:), stress_in(:), statev_in(:), dstrain_in(:)
      type(report_t) :: report
      type(output_t) :: output
      character(PATH_LENGTH) :: name
      character(ORIGIN_LENGTH) :: whence
      character(PROBLEM_LENGTH) :: problem
      logical :: whole

      mud_save_increment = MUD_OK
      if (n_statev < NSTATV) mud_save_increment = MUD_BAD_NSTATV
      if (.not. is_length(n_props)) mud_save_increment = MUD_BAD_NPROPS
      if (tangent < 0 .or. tangent > LAST_TANGENT) mud_save_increment = MUD_BAD_OPTION
      if (.not. (c_associated(path) .and. c_associated(props) .and. c_associated(stress0) .and. &
                 c_associated(statev0) .and. c_associated(dstrain))) mud_save_increment = MUD_NULL_ARGUMENT
      call put(status_text(mud_save_increment), text, len)
      if (mud_save_increment /= MUD_OK) return

      call c_f_pointer(props, props_in, [n_props])
      call c_f_pointer(stress0, stress_in, [6])
      call c_f_pointer(statev0, statev_in, [NSTATV])
      call c_f_pointer(dstrain, dstrain_in, [6])
      call get(origin, whence, whole)
      call get(path, name, whole)
      problem = 'the name of the file is empty or too long'
      if (whole .and. name /= '') then
         call kernel_update(props_in, stress_in, statev_in, dstrain_in, suction0, dsuction, tangent, output, report)
         call write_increment(name, whence, completed(props_in), stress_in, statev_in, dstrain_in, suction0, dsuction, &
                              tangent, report, problem)
      end if
      if (problem == '') return
      mud_save_increment = MUD_NOT_WRITTEN
      call put(trim(problem)//': '//status_text(MUD_NOT_WRITTEN), text, len)
   end function mud_save_increment

   !> Writes a new file or none: one of that name is never touched, one that cannot be finished is removed. props(:) of
   !> NPROPS, statev(:) of at least NSTATV; tension positive, engineering shear [-], stress and suction in the unit of
   !> p_atm.
   subroutine write_increment(path, origin, props, stress, statev, d_strain, suction, d_suction, tangent, report, &
                              problem)
      character(*), intent(in) :: path, origin
      real(wp), intent(in) :: props(:), stress(6), statev(:), d_strain(6), suction, d_suction
      integer, intent(in) :: tangent
      type(report_t), intent(in) :: report
      character(*), intent(out) :: problem   !< Blank if the file is written.
      type(c_ptr) :: file
      logical :: good, taken
      integer :: i

      ! "x": a file that exists, were it made by another thread a moment ago, is an error.
      file = c_fopen(trim(path)//c_null_char, 'wx'//c_null_char)
      good = c_associated(file)
      if (.not. good) then
         inquire (file=path, exist=taken)
         problem = 'the file cannot be made'
         if (taken) problem = 'there is a file of that name'
         return
      end if
      problem = ''
      call line('# An increment of MUD as of mud.h (tension positive, engineering shear); mud_replay runs it.')
      call count_line('format', FORMAT_VERSION)
      call line('library '//VERSION)
      call count_line('abi', ABI_VERSION)
      call line('origin '//origin)
      call line('# '//report_text(report))
      call count_line('status', report%status)
      call count_line('n_rate', report%n_rate)
      call count_line('n_substep', report%n_substep)
      call count_line('n_reject', report%n_reject)
      call real_line('reached', report%reached)
      call count_line('tangent', tangent)
      call real_line('suction', suction)
      call real_line('dsuction', d_suction)
      do i = 1, 6
         call real_line('stress_'//COMPONENT(i), stress(i))
      end do
      do i = 1, 6
         call real_line('dstrain_'//COMPONENT(i), d_strain(i))
      end do
      call count_line('props', NPROPS)
      do i = 1, NPROPS
         call real_line(PROPERTIES(i)%name, props(i))
      end do
      call count_line('statev', NSTATV)
      do i = 1, NSTATV
         call real_line(statev_name(i), statev(i))
      end do
      call line('end')

      if (c_fclose(file) == 0 .and. good) return
      problem = 'the file could not be finished; is the disk full?'
      i = c_remove(trim(path)//c_null_char)
   contains
      !> One line, as long as nothing has gone wrong.
      subroutine line(text)
         character(*), intent(in) :: text
         integer(c_size_t) :: n

         if (.not. good) return
         n = len_trim(text) + 1
         good = c_fwrite(trim(text)//new_line(text), 1_c_size_t, n, file) == n
      end subroutine line

      subroutine count_line(name, value)
         character(*), intent(in) :: name
         integer, intent(in) :: value
         character(12) :: digits

         write (digits, '(i0)') value
         call line(name//' '//digits)
      end subroutine count_line

      !> Seventeen digits: the same bits when they are read again.
      subroutine real_line(name, value)
         character(*), intent(in) :: name
         real(wp), intent(in) :: value
         character(24) :: digits

         write (digits, '(es24.16e3)') value
         call line(trim(name)//' '//adjustl(digits))
      end subroutine real_line
   end subroutine write_increment

   !> A C string; `whole` if it fits. What is not printable becomes a blank: a line must stay a line.
   subroutine get(string, text, whole)
      type(c_ptr), intent(in) :: string
      character(*), intent(out) :: text
      logical, intent(out) :: whole
      character(kind=c_char), pointer :: letters(:)
      integer :: i

      text = ''
      whole = .true.
      if (.not. c_associated(string)) return
      call c_f_pointer(string, letters, [len(text) + 1])
      do i = 1, len(text) + 1
         if (letters(i) == c_null_char) return
         if (i > len(text)) exit
         text(i:i) = merge(letters(i), ' ', iachar(letters(i)) >= 32)
      end do
      whole = .false.
   end subroutine get
end module mud_save
