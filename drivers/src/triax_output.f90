!> Results: rows of a CSV or HDF5 file, progress of long runs, and the summary at the end.
module triax_output
   use, intrinsic :: iso_fortran_env, only: wp => real64, int64, output_unit, error_unit
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use texts, only: short, whole, lower_case
   use triax_case, only: case_t
   use triax_stage, only: general_control
   use triax_control, only: tally_t, CONTROL_TOLERANCE
   use triax_course, only: course_t
   use csv, only: csv_t, open_csv, write_line, close_csv
   use files, only: can_be_written
   use hdf5_file, only: HAS_HDF5, h5_t, new_file, write_file, put, put_text
   use triax_point, only: soil_t, point_t, library_version, property_count, property_name, property_range, &
                          state_value, mean_stress, deviator_stress, radial_stress, axial_strain, radial_strain, &
                          volumetric_strain, AXIAL
   implicit none (type, external)
   private
   public :: table_t, clock_t, open_table, write_row, add_note, close_table, start_clock, show_progress, show_summary

   !> A column of the results.
   type :: column_t
      character(16) :: name
      character(8) :: unit
      character(120) :: meaning
      logical :: whole = .false.   !< Counts.
   end type column_t

   integer, parameter :: PLAIN = 21   !< Columns of every table; the others are components of tensors.
   type(column_t), parameter :: COLUMNS(*) = [ &
      column_t('eps_a', '1', 'axial strain, natural'), &
      column_t('eps_v', '1', 'volumetric strain, natural'), &
      column_t('p_eff', 'kPa', 'mean effective stress'), &
      column_t('q', 'kPa', 'sigma_a - sigma_r, negative in extension'), &
      column_t('e', '1', 'void ratio'), &
      column_t('s_w', '1', 'degree of saturation'), &
      column_t('n_substep', '1', 'accepted substeps since the start', .true.), &
      column_t('n_reseat', '1', 're-seats of the memory since the start', .true.), &
      column_t('sigma_a', 'kPa', 'axial effective stress'), &
      column_t('sigma_r', 'kPa', 'radial effective stress'), &
      column_t('eps_r', '1', 'radial strain, natural'), &
      column_t('suction', 'kPa', 'p_a - p_w'), &
      column_t('u', 'kPa', &
               'excess pore pressure, saturated sample of constant volume, total radial stress held (shear: axial)'), &
      column_t('psi', '1', 'state parameter'), &
      column_t('n_rate', '1', 'rate evaluations since the start', .true.), &
      column_t('n_reject', '1', 'rejected substeps since the start', .true.), &
      column_t('n_guard', '1', 'rates in which a guard acted, since the start', .true.), &
      column_t('control_error', '1', 'largest error of what is held since the row before, relative'), &
      column_t('stage', '1', 'stage, 0 is the start', .true.), &
      column_t('cycle', '1', 'cycle of the stage, 0: none', .true.), &
      column_t('r_u', '1', 'pore pressure of the stage over the effective confining stress at its start'), &
      column_t('sig_11', 'kPa', 'effective stress'), column_t('sig_22', 'kPa', 'effective stress'), &
      column_t('sig_33', 'kPa', 'effective stress'), column_t('sig_12', 'kPa', 'effective stress'), &
      column_t('sig_13', 'kPa', 'effective stress'), column_t('sig_23', 'kPa', 'effective stress'), &
      column_t('eps_11', '1', 'strain, natural'), column_t('eps_22', '1', 'strain, natural'), &
      column_t('eps_33', '1', 'strain, natural'), column_t('gamma_12', '1', 'engineering shear strain'), &
      column_t('gamma_13', '1', 'engineering shear strain'), column_t('gamma_23', '1', 'engineering shear strain')]
   real(wp), parameter :: FIRST_PROGRESS = 2.0_wp   !< Runs shorter than this show none [s].

   !> An output file; `to_screen` if it is the standard output.
   type :: table_t
      type(csv_t) :: csv
      type(h5_t) :: h5
      logical :: to_screen = .false.
      logical :: hdf5 = .false.      !< Rows are kept and written when the table is closed.
      logical :: closed = .true.
      integer :: columns = PLAIN     !< More where components of stress and strain are wanted.
      integer :: rows = 0
      character(:), allocatable :: path
      real(wp), allocatable :: kept(:, :)   !< rows, columns
   end type table_t

   !> Wall-clock time of a run.
   type :: clock_t
      integer(int64) :: start = 0
      real(wp) :: next = FIRST_PROGRESS
   end type clock_t

contains
   !> Opens the file and writes its header.
   subroutine open_table(path, test, table, fault)
      character(*), intent(in) :: path   !< '-' is the standard output.
      type(case_t), intent(in) :: test
      type(table_t), intent(out) :: table
      type(fault_t), intent(inout) :: fault

      table%path = path
      if (any(general_control(test%stages%control))) table%columns = size(COLUMNS)
      table%to_screen = path == '-'
      table%hdf5 = ends_in(path, '.h5') .or. ends_in(path, '.hdf5')
      if (table%hdf5 .and. .not. HAS_HDF5) then
         call raise(fault, EXIT_OUTPUT, path//': this mud_triax was built without HDF5; choose a .csv '// &
                    'file, or install libhdf5-dev and build again.')
      else if (table%hdf5) then
         ! The file is written at the end; this says now whether it can be.
         if (can_be_written(path)) then
            call new_file(table%h5)
            allocate (table%kept(0, table%columns))
         else
            call raise(fault, EXIT_OUTPUT, path//' cannot be written; choose another place with --output.')
         end if
      else
         call open_csv(path, table%columns, table%csv, fault)
      end if
      if (fault%code /= 0) return
      table%closed = .false.
      call header(test, table, fault)
   end subroutine open_table

   pure logical function ends_in(path, ending)
      character(*), intent(in) :: path, ending

      ends_in = .false.
      if (len(path) > len(ending)) ends_in = lower_case(path(len(path) - len(ending) + 1:)) == ending
   end function ends_in

   subroutine header(test, table, fault)
      type(case_t), intent(in) :: test
      type(table_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault
      real(wp) :: lower, upper, preset
      character(:), allocatable :: names
      integer :: i

      call remark(table, 'case', trim(test%name), fault)
      if (len_trim(test%title) > 0) call remark(table, 'title', trim(test%title), fault)
      call remark(table, 'material', trim(test%material), fault)
      do i = 1, property_count()
         call property_range(i, lower, upper, preset)
         if (abs(test%soil%props(i) - preset) > 0.0_wp) then
            call remark(table, 'not the default: '//property_name(i), short(test%soil%props(i))//' (default '// &
                        short(preset)//')', fault)
         end if
      end do
      call remark(table, 'library', 'MUD '//library_version(), fault)
      call remark(table, 'conventions', 'compression positive; stresses are effective [kPa], suction and u [kPa], '// &
                  'strains and the rest [-]; control_error may be up to '//short(CONTROL_TOLERANCE), fault)
      names = trim(COLUMNS(1)%name)
      do i = 2, table%columns
         names = names//','//trim(COLUMNS(i)%name)
      end do
      if (.not. table%hdf5) call write_line(table%csv, names, fault)
   end subroutine header

   !> A fact about the run: a comment line, or an attribute of the HDF5 file.
   subroutine remark(table, name, text, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: name, text
      type(fault_t), intent(inout) :: fault

      if (table%hdf5) then
         call put_text(table%h5, name, text)
      else
         call write_line(table%csv, '# '//name//': '//text, fault)
      end if
   end subroutine remark

   !> How a stage ended, behind its rows.
   subroutine add_note(table, text, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: text
      type(fault_t), intent(inout) :: fault

      call remark(table, text(:index(text, ':') - 1), text(index(text, ':') + 2:), fault)
   end subroutine add_note

   subroutine write_row(table, soil, point, course, error, stage, fault)
      type(table_t), intent(inout) :: table
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      type(course_t), intent(in) :: course
      real(wp), intent(in) :: error      !< Largest of what is held since the row before, relative.
      integer, intent(in) :: stage
      type(fault_t), intent(inout) :: fault
      real(wp) :: values(size(COLUMNS))
      character(:), allocatable :: text
      integer :: i

      values = [axial_strain(point), volumetric_strain(point), mean_stress(point), deviator_stress(point), &
                state_value(point, soil%i_void_ratio), state_value(point, soil%i_saturation), &
                state_value(point, soil%i_n_substep), state_value(point, soil%i_n_reseat), point%stress(AXIAL), &
                radial_stress(point), radial_strain(point), point%suction, course%pressure, &
                state_value(point, soil%i_state_parameter), state_value(point, soil%i_n_rate), &
                state_value(point, soil%i_n_reject), state_value(point, soil%i_n_guard), error, real(stage, wp), &
                real(course%cycle, wp), course%r_u, point%stress, point%strain]
      table%rows = table%rows + 1
      if (table%hdf5) then
         call keep(table, values)
         return
      end if
      text = ''
      do i = 1, table%columns
         text = text//value_text(values(i), COLUMNS(i)%whole)
         if (i < table%columns) text = text//','
      end do
      call write_line(table%csv, text, fault)
   end subroutine write_row

   !> Adds a row to those that are kept; their room doubles when it is full.
   subroutine keep(table, values)
      type(table_t), intent(inout) :: table
      real(wp), intent(in) :: values(:)
      real(wp), allocatable :: more(:, :)

      if (table%rows > size(table%kept, 1)) then
         allocate (more(max(256, 2*table%rows), table%columns), source=0.0_wp)
         more(:table%rows - 1, :) = table%kept(:table%rows - 1, :)
         call move_alloc(more, table%kept)
      end if
      table%kept(table%rows, :) = values(:table%columns)
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
   subroutine close_table(table, stopped, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: stopped   !< Why, empty if it did not.
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: last
      integer :: i
      logical :: good

      if (table%closed) return
      table%closed = .true.
      if (len(stopped) > 0) call remark(table, 'stopped', stopped, last)
      if (.not. table%hdf5) then
         call close_csv(table%csv, last)
      else
         do i = 1, table%columns
            call put_column(table%h5, COLUMNS(i), table%kept(:table%rows, i))
         end do
         call write_file(table%h5, table%path, good)
         if (.not. good) call raise(last, EXIT_OUTPUT, table%path//' cannot be written; is the disk full?')
      end if
      if (fault%code == 0) fault = last
   end subroutine close_table

   subroutine put_column(file, column, values)
      type(h5_t), intent(inout) :: file
      type(column_t), intent(in) :: column
      real(wp), intent(in) :: values(:)

      if (column%whole) then
         call put(file, trim(column%name), nint(values), trim(column%unit), trim(column%meaning))
      else
         call put(file, trim(column%name), values, trim(column%unit), trim(column%meaning))
      end if
   end subroutine put_column

   subroutine start_clock(clock)
      type(clock_t), intent(out) :: clock

      call system_clock(clock%start)
   end subroutine start_clock

   real(wp) function elapsed(clock)
      type(clock_t), intent(in) :: clock
      integer(int64) :: now, rate

      call system_clock(now, rate)
      elapsed = real(now - clock%start, wp)/real(rate, wp)
   end function elapsed

   !> A line on the error output after 2 s, and then each time the run has become half as long again.
   subroutine show_progress(clock, share, what)
      type(clock_t), intent(inout) :: clock
      real(wp), intent(in) :: share   !< Of the work, done so far.
      character(*), intent(in) :: what
      real(wp) :: seconds

      seconds = elapsed(clock)
      if (seconds < clock%next .or. share <= 0.0_wp) return
      clock%next = seconds + max(2.0_wp, 0.5_wp*seconds)
      write (error_unit, '(a)') 'mud_triax: '//what//', '//whole(nint(100.0_wp*share))//' % after '// &
         whole(nint(seconds))//' s, about '//whole(nint(seconds*(1.0_wp - share)/share))//' s left'
   end subroutine show_progress

   !> Where the test ended and what it cost.
   subroutine show_summary(test, table, point, tally, increments, clock)
      type(case_t), intent(in) :: test
      type(table_t), intent(in) :: table
      type(point_t), intent(in) :: point
      type(tally_t), intent(in) :: tally
      integer, intent(in) :: increments
      type(clock_t), intent(in) :: clock

      if (table%to_screen) return
      associate (soil => test%soil)
         write (output_unit, '(a)') trim(test%name)//' ('//trim(test%material)//', MUD '//library_version()//')'
         write (output_unit, '(a)') '   end        eps_a '//short(axial_strain(point))//', eps_v '// &
            short(volumetric_strain(point))//', p'' '//short(mean_stress(point))//' kPa, q '// &
            short(deviator_stress(point))//' kPa, e '//short(state_value(point, soil%i_void_ratio))//', S_w '// &
            short(state_value(point, soil%i_saturation))//', psi '//short(state_value(point, soil%i_state_parameter))
         write (output_unit, '(a)') '   work       '//whole(increments)//' increments ('//whole(tally%cuts)// &
            ' cuts), '// &
            whole(tally%updates)//' updates; '//count_of(soil%i_n_substep)//' substeps, '//count_of(soil%i_n_reject)// &
            ' rejected, '//count_of(soil%i_n_rate)//' rates, '//count_of(soil%i_n_reseat)//' re-seats; '// &
            short(real(nint(100.0_wp*elapsed(clock)), wp)/100.0_wp)//' s'
         write (output_unit, '(a)') '   guards     floor '//whole(tally%n_floor)//', contraction cap '// &
            whole(tally%n_cap_d)// &
            ', softening cap '//whole(tally%n_cap_h)//', hysteresis '//whole(tally%n_hysteresis)// &
            ', isotropic kept off '//whole(tally%n_iso_kept)//', no direction '//whole(tally%n_no_root)// &
            ', minimum step '//whole(tally%n_min_step)//', cut-off '//whole(tally%n_open)//', tensile '// &
            whole(tally%n_tensile)
         if (tally%solved > 0) then
            write (output_unit, '(a)') '   control    what is held is met within '//short(tally%worst)// &
               ' of its value (allowed '// &
               short(CONTROL_TOLERANCE)//')'
         end if
         if (tally%saved) write (output_unit, '(a)') '   saved      '//trim(tally%save_to)// &
            ', the first refused update, for mud_replay'
         write (output_unit, '(a)') '   output     '//table%path//', '//whole(table%rows)//' rows'
      end associate
   contains
      function count_of(place) result(word)
         integer, intent(in) :: place
         character(:), allocatable :: word

         word = whole(nint(state_value(point, place)))
      end function count_of
   end subroutine show_summary
end module triax_output
