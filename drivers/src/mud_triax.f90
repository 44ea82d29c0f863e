!> Element tests on the MUD model: drained and undrained triaxial tests, compression, strain and suction paths.
program mud_triax
   use, intrinsic :: iso_fortran_env, only: wp => real64, output_unit, error_unit
   use faults, only: fault_t, raise, EXIT_INPUT, EXIT_OUTPUT
   use texts, only: whole
   use triax_case, only: case_t, read_case
   use triax_stage, only: CONTROL_NAMES
   use triax_point, only: point_t, library_version
   use triax_control, only: tally_t
   use triax_course, only: course_t, begin_stage, next_increment, share_done
   use triax_output, only: table_t, clock_t, open_table, write_row, add_note, close_table, start_clock, show_progress, &
      show_summary
   use triax_help, only: print_help, print_template
   implicit none (type, external)

   integer, parameter :: PATH_LENGTH = 256

   character(PATH_LENGTH) :: case_file, output_file, save_file
   type(fault_t) :: fault
   logical :: quiet, residuals, done

   call read_arguments(done)
   if (fault%code == 0 .and. .not. done) call run(trim(case_file))
   if (fault%code /= 0) then
      write (error_unit, '(a)') 'mud_triax: '//trim(fault%text)
      stop fault%code, quiet=.true.
   end if

contains
   !> Fills case_file, output_file, save_file and quiet; `answered` if the call only asked for a text.
   subroutine read_arguments(answered)
      logical, intent(out) :: answered
      character(PATH_LENGTH) :: word
      integer :: i, status

      case_file = ''
      output_file = ''
      save_file = ''
      quiet = .false.
      residuals = .false.
      answered = .true.
      i = 0
      do while (i < command_argument_count())
         i = i + 1
         call get_command_argument(i, word, status=status)
         if (status /= 0) then
            call raise(fault, EXIT_INPUT, 'An argument is longer than '//whole(PATH_LENGTH)//' characters.')
            return
         end if
         select case (word)
         case ('--help', '-h')
            call print_help()
            return
         case ('--version')
            write (output_unit, '(a)') 'mud_triax, MUD library '//library_version()
            return
         case ('--template')
            call print_template()
            return
         case ('--quiet', '-q')
            quiet = .true.
         case ('--residuals')
            residuals = .true.
         case ('--output', '-o')
            i = i + 1
            call get_command_argument(i, output_file, status=status)
            if (status /= 0 .or. len_trim(output_file) == 0) then
               call raise(fault, EXIT_INPUT, '--output needs the name of a file (shorter than '//whole(PATH_LENGTH)// &
                          ' characters).')
               return
            end if
         case ('--save-failed')
            i = i + 1
            call get_command_argument(i, save_file, status=status)
            if (status /= 0 .or. len_trim(save_file) == 0) then
               call raise(fault, EXIT_INPUT, '--save-failed needs the name of a new file (shorter than '// &
                          whole(PATH_LENGTH)//' characters).')
               return
            end if
         case default
            if (word(1:1) == '-') then
               call raise(fault, EXIT_INPUT, 'There is no option '//trim(word)//'; see mud_triax --help.')
               return
            else if (len_trim(case_file) > 0) then
               call raise(fault, EXIT_INPUT, 'One case at a time: '//trim(case_file)//' or '//trim(word)//'?')
               return
            end if
            case_file = word
         end select
      end do
      answered = .false.
      if (len_trim(case_file) == 0) call raise(fault, EXIT_INPUT, 'No case file is named; see mud_triax --help.')
   end subroutine read_arguments

   subroutine run(file)
      character(*), intent(in) :: file
      type(case_t) :: test
      type(table_t) :: table
      type(clock_t) :: clock
      type(point_t) :: point
      type(course_t) :: course
      type(tally_t) :: tally
      type(fault_t) :: ending
      real(wp) :: pressure
      integer :: i, increments
      logical :: taken

      call read_case(file, test, fault)
      if (fault%code /= 0) return
      if (len_trim(output_file) == 0) output_file = trim(test%name)//'.csv'
      taken = .false.
      if (len_trim(save_file) > 0) inquire (file=save_file, exist=taken)
      if (taken) then
         call raise(fault, EXIT_OUTPUT, '--save-failed '//trim(save_file)//': there is a file of that name, and '// &
                    'it is not overwritten; remove it or choose another name.')
         return
      end if
      call open_table(trim(output_file), test, table, fault)
      if (fault%code /= 0) return

      tally%residuals = residuals
      tally%save_to = save_file
      if (residuals) write (output_unit, '(a)') 'increment,iteration,error'
      call start_clock(clock)
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
               if (.not. quiet) call show_progress(clock, (real(i - 1, wp) + share_done(course))/ &
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
      if (.not. quiet) call show_summary(test, table, point, tally, increments, clock)
   end subroutine run

   !> ", cycle 3", or nothing.
   pure function in_cycle(course) result(text)
      type(course_t), intent(in) :: course
      character(:), allocatable :: text

      text = ''
      if (course%cycle > 0) text = ', cycle '//whole(course%cycle)
   end function in_cycle
end program mud_triax
