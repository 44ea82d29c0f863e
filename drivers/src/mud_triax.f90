! SPDX-License-Identifier: MIT
!> Element tests on the MUD model: drained and undrained triaxial tests, compression, strain and suction paths.
program mud_triax
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use faults, only: fault_t, raise, EXIT_INPUT, EXIT_OUTPUT
   use kinds, only: wp
   use material_point, only: PRESSURE_LOST, CYCLES_UNTRUSTED, MANY_REVERSALS, range_t, untested
   use arguments, only: option_t, read_command_line, option_given, option_value, WORD_LENGTH
   use triax_accuracy, only: accuracy_t, reach_accuracy, verify_accuracy, note_accuracy, accuracy_lines, is_met, &
                             LINE_LENGTH
   use triax_case, only: case_t, read_case
   use library_tables, only: library_version
   use material_folder, only: material_path
   use texts, only: short, whole
   use triax_point, only: point_t, void_ratio, mean_stress
   use triax_control, only: tally_t
   use triax_output, only: table_t, open_table
   use triax_progress, only: timer_t, show_summary
   use triax_run, only: run_test
   use triax_help, only: print_help, print_template
   use wall_clock, only: clock
   implicit none (type, external)

   type(option_t) :: options(10) = [ &
      option_t('--help', letter='-h', answers=.true.), &
      option_t('--version', answers=.true.), &
      option_t('--template', answers=.true.), &
      option_t('--quiet', letter='-q'), &
      option_t('--residuals'), &
      option_t('--output', 'the name of a file', '-o'), &
      option_t('--material', 'the name of a material'), &
      option_t('--accuracy', 'a share, as 1e-2'), &
      option_t('--verify'), &
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
   !> Warns of a case that begins outside what its material was fitted to.
   subroutine warn_of_use(test)
      type(case_t), intent(in) :: test
      character(:), allocatable :: text
      real(wp) :: e, p

      e = void_ratio(test%soil, test%start)
      p = mean_stress(test%start)
      text = untested(test%soil%law, range_t(e, e), range_t(p, p))
      if (text /= '') write (error_unit, '(a)') 'mud_triax: warning: the material '''//trim(test%material)// &
         ''' begins outside what it was fitted to: '//text//'.'
   end subroutine warn_of_use

   subroutine run(file)
      character(*), intent(in) :: file
      type(case_t) :: test
      type(table_t) :: table
      type(timer_t) :: timer
      type(point_t) :: point
      type(tally_t) :: tally
      character(:), allocatable :: output_file, save_file, material_file
      type(accuracy_t) :: answer
      logical :: taken, quiet

      material_file = ''
      if (option_given(options, '--material')) &
         call material_path(option_value(options, '--material'), material_file, fault)
      if (fault%code == 0) call read_case(file, material_file, option_value(options, '--accuracy'), &
                                          test, fault)
      if (fault%code /= 0) return
      if (test%soil%law%doubt /= '') write (error_unit, '(a)') 'mud_triax: warning: '//trim(test%soil%law%doubt)
      call warn_of_use(test)
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
      if (option_given(options, '--verify') .and. .not. test%accuracy > 0.0_wp) then
         call raise(fault, EXIT_INPUT, '--verify measures what an accuracy has given: ask for one, with accuracy '// &
                    'of &case or --accuracy.')
         return
      end if
      call open_table(output_file, test, table, fault)
      if (fault%code /= 0) return

      tally%residuals = option_given(options, '--residuals')
      tally%save_to = save_file
      if (test%accuracy > 0.0_wp) call reach_accuracy(test, answer)
      if (option_given(options, '--verify')) call verify_accuracy(test, answer)
      if (test%accuracy > 0.0_wp) call note_accuracy(answer, table, fault)
      if (tally%residuals) write (output_unit, '(a)') 'increment,iteration,error'
      timer = timer_t(start=clock(), shown=.not. quiet)
      call run_test(test, table, tally, timer, point, fault)
      if (test%soil%law%unguarded .and. tally%least_pressure < 0.0_wp) write (error_unit, '(a)') &
         'mud_triax: warning: the mean effective stress p'' fell to '//short(tally%least_pressure)//' '// &
         trim(test%soil%law%unit%name)//': '//PRESSURE_LOST
      if (test%soil%law%overcounts_cycles .and. tally%reversals > MANY_REVERSALS) write (error_unit, '(a)') &
         'mud_triax: warning: the load has turned '//whole(tally%reversals)//' times: '//CYCLES_UNTRUSTED
      if (.not. quiet) call show_summary(test, table, point, tally, timer)
      if (fault%code == 0 .and. test%accuracy > 0.0_wp) call show_accuracy(answer, quiet .or. table%to_screen)
   end subroutine run

   !> Prints the estimates, and a warning, also where the run is quiet, where they are beyond what was asked for.
   subroutine show_accuracy(answer, quiet)
      type(accuracy_t), intent(in) :: answer
      logical, intent(in) :: quiet
      character(LINE_LENGTH), allocatable :: lines(:)
      integer :: i

      allocate (lines(0))
      lines = accuracy_lines(answer)
      do i = 1, merge(0, size(lines), quiet)
         write (output_unit, '(a)') merge('   accuracy   ', '              ', i == 1)//trim(lines(i))
      end do
      if (.not. is_met(answer)) write (error_unit, '(a)') 'mud_triax: warning: the accuracy is not reached; what '// &
         'limits it is '//trim(merge('the increments                 ', 'the tolerance of the stresses  ', &
         answer%by_increments >= answer%by_tolerance))//' (given by hand, or not to be refined further).'
   end subroutine show_accuracy
end program mud_triax
