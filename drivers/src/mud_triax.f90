!> Element tests on the MUD model: drained and undrained triaxial tests, compression, strain and suction paths.
program mud_triax
   use, intrinsic :: iso_fortran_env, only: wp => real64, output_unit, error_unit
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use texts, only: whole
   use arguments, only: option_t, read_command_line, option_given, option_value, WORD_LENGTH
   use triax_case, only: case_t, read_case
   use triax_stage, only: CONTROL_NAMES
   use library_tables, only: library_version
   use triax_point, only: point_t
   use triax_control, only: tally_t
   use triax_course, only: course_t, begin_stage, next_increment, share_done
   use triax_output, only: table_t, open_table, write_row, add_note, close_table
   use triax_progress, only: timer_t, start_timer, show_progress, show_summary
   use triax_help, only: print_help, print_template
   implicit none (type, external)

   type(option_t) :: options(7) = [ &
      option_t('--help', letter='-h', answers=.true.), &
      option_t('--version', answers=.true.), &
      option_t('--template', answers=.true.), &
      option_t('--quiet', letter='-q'), &
      option_t('--residuals'), &
      option_t('--output', 'the name of a file', '-o'), &
      option_t('--save-failed', 'the name of a new file')]
   character(WORD_LENGTH) :: case_file
   type(fault_t) :: fault

   call read_command_line(options, 'case file', 'see mud_triax --help', case_file, fault)
   if (fault%code /= 0) then
      continue
   else if (option_given(options, '--help')) then
      call print_help()
   else if (option_given(options, '--version')) then
      write (output_unit, '(a)') 'mud_triax, MUD library '//library_version()
   else if (option_given(options, '--template')) then
      call print_template()
   else
      call run(trim(case_file))
   end if
   if (fault%code /= 0) then
      write (error_unit, '(a)') 'mud_triax: '//trim(fault%text)
      stop fault%code, quiet=.true.
   end if

contains
   subroutine run(file)
      character(*), intent(in) :: file
      type(case_t) :: test
      type(table_t) :: table
      type(timer_t) :: timer
      type(point_t) :: point
      type(course_t) :: course
      type(tally_t) :: tally
      type(fault_t) :: ending
      real(wp) :: pressure
      integer :: i, increments
      character(:), allocatable :: output_file, save_file
      logical :: taken, quiet

      call read_case(file, test, fault)
      if (fault%code /= 0) return
      quiet = option_given(options, '--quiet')
      output_file = option_value(options, '--output')
      if (output_file == '') output_file = trim(test%name)//'.csv'
      save_file = option_value(options, '--save-failed')
      taken = .false.
      if (save_file /= '') inquire (file=save_file, exist=taken)
      if (taken) then
         call raise(fault, EXIT_OUTPUT, '--save-failed '//save_file//': there is a file of that name, and '// &
                    'it is not overwritten; remove it or choose another name.')
         return
      end if
      call open_table(output_file, test, table, fault)
      if (fault%code /= 0) return

      tally%residuals = option_given(options, '--residuals')
      tally%save_to = save_file
      if (tally%residuals) write (output_unit, '(a)') 'increment,iteration,error'
      call start_timer(timer)
      point = test%start
      pressure = 0.0_wp
      increments = 0
      call write_row(table, test%soil, point, course, 0.0_wp, 0, fault)
      stages: do i = 1, size(test%stages)
         associate (stage => test%stages(i))
            call begin_stage(test%soil, stage, point, pressure, course, fault)
            if (fault%code /= 0) exit stages
            do while (.not. course%finished)
               call next_increment(test%soil, stage, course, point, tally, fault)
               if (fault%code /= 0) exit stages
               increments = increments + 1
               if (course%row) then
                  call write_row(table, test%soil, point, course, tally%error, i, fault)
                  tally%error = 0.0_wp
                  if (fault%code /= 0) exit stages
               end if
               if (.not. quiet) call show_progress(timer, (real(i - 1, wp) + share_done(course))/ &
                                                   real(size(test%stages), wp), 'stage '//whole(i)//' of '// &
                                                   whole(size(test%stages))//' ('// &
                                                   trim(CONTROL_NAMES(stage%control))//')'//in_cycle(course))
            end do
            pressure = course%pressure
            if (len_trim(course%note) > 0) call add_note(table, 'stage '//whole(i)//': '//trim(course%note), fault)
         end associate
      end do stages

      if (fault%code /= 0) then
         fault%text = trim(test%name)//', stage '//whole(i)//': '//fault%text
         call close_table(table, trim(fault%text), ending)
      else
         call close_table(table, '', fault)
      end if
      if (.not. quiet) call show_summary(test, table, point, tally, increments, timer)
   end subroutine run

   !> ", cycle 3", or nothing.
   pure function in_cycle(course) result(text)
      type(course_t), intent(in) :: course
      character(:), allocatable :: text

      text = ''
      if (course%cycle > 0) text = ', cycle '//whole(course%cycle)
   end function in_cycle
end program mud_triax
