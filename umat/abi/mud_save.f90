! SPDX-License-Identifier: MIT
!> A failed increment as a case file, which mud_triax runs alone. The only place of the library that writes a
!> file, and only where it is asked to.
module mud_save
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_size_t, c_associated
   use mud_c_api, only: VERSION
   use mud_host_increment, only: host_increment, never_began, suction_change
   use mud_kernel, only: report_t, output_t
   use mud_kinds, only: wp
   use mud_messages, only: status_text, report_text
   use mud_params, only: options_of
   use mud_prepared, only: start_t, find_start
   use mud_registry, only: NPROPS, P_TANGENT, P_E_0, PROPERTIES, COMPONENTS, S_VOID_RATIO, &
      S_SATURATION, S_SUCTION, statev_name
   use mud_state, only: statev_size
   use mud_status, only: mud_status_t, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, MUD_NOT_WRITTEN
   use mud_tensor, only: within
   use mud_to_host, only: put, get
   implicit none (type, external)
   private
   public :: c_save_increment, write_increment, PATH_LENGTH

   integer, parameter :: PATH_LENGTH = 1024, ORIGIN_LENGTH = 200, PROBLEM_LENGTH = 300
   integer, parameter :: LAST_TANGENT = 3

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
   !> MUD_NULL_ARGUMENT, MUD_NOT_PREPARED, MUD_BAD_OPTION, MUD_BAD_NSTATV, MUD_NOT_WRITTEN.
   integer(c_int) function c_save_increment(path, origin, storage, stress0, statev0, n_statev, dstrain, suction, &
           tangent, text, len) bind(c, name='mud_save_increment')
      type(c_ptr), value :: path, origin, storage, stress0, statev0, dstrain, text
      integer(c_int), value :: n_statev, tangent, len
      real(c_double), value :: suction
      type(start_t) :: start
      type(mud_status_t) :: status
      type(report_t) :: report
      type(output_t) :: output
      character(PATH_LENGTH) :: name
      character(ORIGIN_LENGTH) :: whence
      character(PROBLEM_LENGTH) :: problem
      logical :: whole

      call find_start(storage, stress0, statev0, n_statev, dstrain, tangent, .true., start, status)
      c_save_increment = status%code
      if (tangent > LAST_TANGENT) c_save_increment = MUD_BAD_OPTION
      if (.not. c_associated(path)) c_save_increment = MUD_NULL_ARGUMENT
      call put(status_text(c_save_increment), text, len)
      if (c_save_increment /= MUD_OK) return

      call get(origin, whence, whole)
      call get(path, name, whole)
      problem = 'the name of the file is empty or too long'
      if (whole .and. name /= '') then
         associate (props => start%material%props, suction0 => start%statev(S_SUCTION))
            call host_increment(start%material%par, start%stress, start%statev, start%d_strain, suction, tangent, &
                                output, report)
            call write_increment(name, whence, props, start%stress, start%statev, start%d_strain, suction0, &
                                 suction_change(suction0, suction), tangent, report, .false., problem)
         end associate
      end if
      if (problem == '') return
      c_save_increment = MUD_NOT_WRITTEN
      call put(trim(problem)//': '//status_text(MUD_NOT_WRITTEN), text, len)
   end function c_save_increment

   !> Writes a new file or none: one of that name is never touched, one that cannot be finished is removed. props(:) of
   !> NPROPS, statev(:) with the numbers of a point; tension positive, engineering shear [-], stress and suction in the
   !> unit of p_atm.
   subroutine write_increment(path, origin, props, stress, statev, d_strain, suction, d_suction, tangent, report, &
                              begins, problem)
      character(*), intent(in) :: path, origin
      real(wp), intent(in), contiguous :: props(:)
      real(wp), intent(in) :: stress(6), statev(:), d_strain(6), suction, d_suction
      integer, intent(in) :: tangent
      type(report_t), intent(in) :: report
      logical, intent(in) :: begins          !< The caller begins points that have no past.
      character(*), intent(out) :: problem   !< Blank if the file is written.
      type(c_ptr) :: file
      real(wp) :: ratio
      character(80) :: digits
      logical :: good, taken
      integer :: i, n

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
      n = min(size(statev), statev_size(options_of(props)))
      call line('! An increment of MUD, for mud_triax: compression positive, engineering shear, stresses in the '// &
                'unit of p_atm.')
      call line('! Library '//VERSION//'. '//report_text(report))
      associate (of => report%counters)
         write (digits, '(*(i0, :, 1x))') report%status, of%substep, of%reject, of%rate
      end associate
      call line('! Status, substeps, rejected, rates, share reached: '//trim(digits)//' '//bits(report%reached))
      call line('&case')
      call line('   title = '''//trim(without_quotes(origin))//'''')
      call line('/')
      call line('&material')
      do i = 1, NPROPS
         if (i == P_TANGENT .and. tangent > 0) then
            call line('   '//trim(PROPERTIES(i)%name)//' = '//bits(real(tangent, wp)))
         else
            call line('   '//trim(PROPERTIES(i)%name)//' = '//bits(props(i)))
         end if
      end do
      call line('/')
      call line('&initial')
      call line('   suction = '//bits(suction))
      call line('   stress =')
      do i = 1, 6
         call line('      '//trim(bits(-stress(i)))//'   ! '//COMPONENTS(i))
      end do
      if (.not. (begins .and. never_began(statev))) then
         call line('   state_variables =')
         do i = 1, n
            call line('      '//trim(bits(statev(i)))//'   ! '//trim(statev_name(i)))
         end do
      else   ! The start was refused, and is made once more.
         ratio = statev(S_VOID_RATIO)
         if (within(ratio, 0.0_wp)) ratio = props(P_E_0)
         call line('   void_ratio = '//bits(ratio))
         if (.not. within(statev(S_SATURATION), 0.0_wp)) call line('   saturation = '//bits(statev(S_SATURATION)))
      end if
      call line('/')
      call line('&stage')
      call line('   control = ''linear''')
      call line('   increment = 1.0')
      do i = 1, 6
         digits = repeat('0 ', 6)
         digits(2*i - 1:2*i - 1) = '1'
         call line('   strain_'//achar(iachar('0') + i)//' = '//trim(digits))
         call line('   change_'//achar(iachar('0') + i)//' = '//trim(bits(-d_strain(i)))//'   ! '//COMPONENTS(i))
      end do
      call line('   d_suction = '//bits(d_suction))
      call line('/')

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
   end subroutine write_increment

   !> Seventeen digits: the same bits when they are read again. A minus zero loses its sign. At fixed length: gfortran
   !> keeps the length of an allocatable result between calls.
   pure function bits(value) result(text)
      real(wp), intent(in) :: value
      character(24) :: text

      write (text, '(es24.16e3)') value + 0.0_wp
      text = adjustl(text)
   end function bits

   !> A text that can stand between quotes.
   pure function without_quotes(text) result(clean)
      character(*), intent(in) :: text
      character(ORIGIN_LENGTH) :: clean
      integer :: i

      clean = text
      do i = 1, len(clean)
         if (clean(i:i) == '''') clean(i:i) = ' '
      end do
   end function without_quotes
end module mud_save
