!> Results: rows of a CSV file, progress of long runs, and the summary at the end.
module triax_output
   use, intrinsic :: iso_fortran_env, only: wp => real64, int64, output_unit, error_unit
   use triax_fault, only: fault_t, raise, EXIT_OUTPUT
   use triax_text, only: short, whole
   use triax_case, only: case_t
   use triax_control, only: tally_t, CONTROL_TOLERANCE
   use triax_point, only: soil_t, point_t, library_version, property_count, property_name, property_range, &
      state_value, &
                          mean_stress, deviator_stress, radial_stress, axial_strain, radial_strain, volumetric_strain, &
                          AXIAL
   implicit none (type, external)
   private
   public :: table_t, clock_t, open_table, write_row, close_table, start_clock, show_progress, show_summary

   character(*), &
      parameter :: COLUMNS = 'eps_a,eps_v,p_eff,q,e,s_w,n_substep,n_reseat,sigma_a,sigma_r,eps_r,suction,u,psi,'// &
                              'n_rate,n_reject,n_guard,control_error,stage'
   character(*), parameter :: TENSOR_COLUMNS = ',sig_11,sig_22,sig_33,sig_12,sig_13,sig_23,eps_11,eps_22,eps_33,'// &
                              'gamma_12,gamma_13,gamma_23'
   real(wp), parameter :: FIRST_PROGRESS = 2.0_wp   !< Runs shorter than this show none [s].

   !> An output file; `to_screen` if it is the standard output.
   type :: table_t
      integer :: unit = -1
      logical :: to_screen = .false.
      logical :: tensors = .false.   !< Six components of stress and strain in every row.
      integer :: rows = 0
      integer(int64) :: bytes = 0
      character(256) :: path = ''
   end type table_t

   !> Wall-clock time of a run.
   type :: clock_t
      integer(int64) :: start = 0
      real(wp) :: next = FIRST_PROGRESS
   end type clock_t

contains
   !> Opens the file and writes its header.
   subroutine open_table(path, test, tensors, table, fault)
      character(*), intent(in) :: path   !< '-' is the standard output.
      type(case_t), intent(in) :: test
      logical, intent(in) :: tensors
      type(table_t), intent(out) :: table
      type(fault_t), intent(inout) :: fault
      character(256) :: problem
      integer :: status

      table%path = path
      table%tensors = tensors
      table%to_screen = path == '-'
      if (table%to_screen) then
         table%unit = output_unit
      else
         open (newunit=table%unit, file=path, status='replace', action='write', form='formatted', iostat=status, &
               iomsg=problem)
         if (status /= 0) then
            table%unit = -1
            call raise(fault, EXIT_OUTPUT, trim(path)//': cannot be written ('//trim(problem)// &
                       '); choose another place with --output.')
            return
         end if
      end if
      call header(test, table, fault)
   end subroutine open_table

   subroutine header(test, table, fault)
      type(case_t), intent(in) :: test
      type(table_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault
      real(wp) :: lower, upper, preset
      character(:), allocatable :: names
      integer :: i

      call line(table, '# case: '//trim(test%name), fault)
      if (len_trim(test%title) > 0) call line(table, '# title: '//trim(test%title), fault)
      call line(table, '# material: '//trim(test%material), fault)
      do i = 1, property_count()
         call property_range(i, lower, upper, preset)
         if (abs(test%soil%props(i) - preset) > 0.0_wp) then
            call line(table, '# not the default: '//property_name(i)//' = '//short(test%soil%props(i))//' (default '// &
                      short(preset)//')', fault)
         end if
      end do
      call line(table, '# library: MUD '//library_version(), fault)
      call line(table, '# conventions: compression positive; stresses are effective [kPa], suction and u [kPa], '// &
                'strains and the rest [-]', fault)
      call line(table, '# u: excess pore pressure at constant total radial stress; n_...: totals since the start; '// &
                'control_error: of the held stress, largest since the row before, relative, allowed '// &
                short(CONTROL_TOLERANCE), fault)
      names = COLUMNS
      if (table%tensors) names = names//TENSOR_COLUMNS
      call line(table, names, fault)
   end subroutine header

   subroutine write_row(table, soil, point, pressure, error, stage, fault)
      type(table_t), intent(inout) :: table
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      real(wp), intent(in) :: pressure   !< Excess pore pressure [kPa].
      real(wp), intent(in) :: error      !< Largest of a held stress since the row before, relative.
      integer, intent(in) :: stage
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: text

      text = real_text(axial_strain(point))//real_text(volumetric_strain(point))//real_text(mean_stress(point))// &
             real_text(deviator_stress(point))//real_text(state_value(point, soil%i_void_ratio))// &
             real_text(state_value(point, soil%i_saturation))//count_text(soil%i_n_substep)// &
                count_text(soil%i_n_reseat)// &
             real_text(point%stress(AXIAL))//real_text(radial_stress(point))//real_text(radial_strain(point))// &
             real_text(point%suction)//real_text(pressure)//real_text(state_value(point, soil%i_state_parameter))// &
             count_text(soil%i_n_rate)//count_text(soil%i_n_reject)//count_text(soil%i_n_guard)//real_text(error)// &
             whole(stage)
      if (table%tensors) text = text//tensor_text(point%stress)//tensor_text(point%strain)
      call line(table, text, fault)
      table%rows = table%rows + 1
   contains
      function count_text(place) result(word)
         integer, intent(in) :: place
         character(:), allocatable :: word
         character(24) :: digits

         write (digits, '(i0)') nint(state_value(point, place), int64)
         word = trim(digits)//','
      end function count_text
   end subroutine write_row

   !> All 16 digits, and the comma behind.
   pure function real_text(value) result(text)
      real(wp), intent(in) :: value
      character(:), allocatable :: text
      character(24) :: digits

      write (digits, '(es23.15e3)') value
      text = trim(adjustl(digits))//','
   end function real_text

   pure function tensor_text(tensor) result(text)
      real(wp), intent(in) :: tensor(6)
      character(:), allocatable :: text, word
      integer :: i

      text = ''
      do i = 1, 6
         word = real_text(tensor(i))
         text = text//','//word(:len(word) - 1)
      end do
   end function tensor_text

   subroutine line(table, text, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: text
      type(fault_t), intent(inout) :: fault
      character(256) :: problem
      integer :: status

      if (fault%code == EXIT_OUTPUT) return
      write (table%unit, '(a)', iostat=status, iomsg=problem) text
      table%bytes = table%bytes + len(text) + 1
      if (status /= 0) then
         call raise(fault, EXIT_OUTPUT, trim(table%path)//': cannot be written ('//trim(problem)// &
                    '); is the disk full?')
      end if
   end subroutine line

   !> Closes the file; a run that stopped early says so in a last comment line, so that a short file explains itself.
   subroutine close_table(table, stopped, fault)
      type(table_t), intent(inout) :: table
      character(*), intent(in) :: stopped   !< Why, empty if it did not.
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: last
      integer(int64) :: size_on_disk
      integer :: status

      if (table%unit == -1) return
      if (len(stopped) > 0) call line(table, '# stopped: '//stopped, last)
      if (.not. table%to_screen) then
         close (table%unit, iostat=status)
         ! gfortran's buffered output does not report a full disk: compare what should be there with what is.
         inquire (file=table%path, size=size_on_disk)
         if ((status /= 0 .or. size_on_disk < table%bytes) .and. index(table%path, '/dev/') /= 1 .and. &
             fault%code == 0) then
            call raise(fault, EXIT_OUTPUT, trim(table%path)//': is incomplete; is the disk full?')
         end if
      end if
      table%unit = -1
   end subroutine close_table

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
            write (output_unit, '(a)') '   control    held stress within '//short(tally%worst)// &
               ' of its value (allowed '// &
               short(CONTROL_TOLERANCE)//')'
         end if
         if (tally%saved) write (output_unit, '(a)') '   saved      '//trim(tally%save_to)// &
            ', the first refused update, for mud_replay'
         write (output_unit, '(a)') '   output     '//trim(table%path)//', '//whole(table%rows)//' rows'
      end associate
   contains
      function count_of(place) result(word)
         integer, intent(in) :: place
         character(:), allocatable :: word

         word = whole(nint(state_value(point, place)))
      end function count_of
   end subroutine show_summary
end module triax_output
