! SPDX-License-Identifier: MIT
!> Prints the progress of a run on the screen, and the summary at its end.
module triax_progress
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use kinds, only: wp
   use library_tables, only: library_version
   use material_point, only: state_index
   use texts, only: short, whole
   use triax_case, only: case_t
   use triax_control, only: tally_t
   use triax_output, only: table_t
   use triax_point, only: point_t, void_ratio, saturation, state_value, mean_stress, deviator_stress, &
                          volumetric_strain, AXIAL
   use wall_clock, only: clock
   implicit none (type, external)
   private
   public :: timer_t, progress_is_due, show_progress, show_summary

   real(wp), parameter :: FIRST_PROGRESS = 2.0_wp   !< Runs shorter than this show none [s].

   !> Wall-clock time of a run.
   type :: timer_t
      real(wp) :: start = 0.0_wp
      real(wp) :: next = FIRST_PROGRESS
      logical :: shown = .false.   !< Progress is wanted.
   end type timer_t

contains
   !> A line on the error output after 2 s, and then each time the run has become half as long again.
   subroutine show_progress(timer, share, what)
      type(timer_t), intent(inout) :: timer
      real(wp), intent(in) :: share   !< Share of the work that is done so far. [-], > 0.
      character(*), intent(in) :: what
      real(wp) :: seconds

      seconds = clock() - timer%start
      timer%next = seconds + max(2.0_wp, 0.5_wp*seconds)
      write (error_unit, '(a)') 'mud_triax: '//what//', '//whole(nint(100.0_wp*share))//' % after '// &
         whole(nint(seconds))//' s, about '//whole(nint(seconds*(1.0_wp - share)/share))//' s left'
   end subroutine show_progress

   !> Whether it is time for a line. Asked after every increment, before the line is put together.
   logical function progress_is_due(timer, share)
      type(timer_t), intent(in) :: timer
      real(wp), intent(in) :: share   !< Share of the work that is done so far [-].

      progress_is_due = .false.
      if (timer%shown .and. share > 0.0_wp) progress_is_due = clock() - timer%start >= timer%next
   end function progress_is_due

   !> Shows where the test ended and what it cost. On the standard output; nothing where the table goes there.
   subroutine show_summary(test, table, point, tally, timer)
      type(case_t), intent(in) :: test
      type(table_t), intent(in) :: table
      type(point_t), intent(in) :: point
      type(tally_t), intent(in) :: tally
      type(timer_t), intent(in) :: timer
      character(:), allocatable :: guards, name
      integer :: i

      if (table%to_screen) return
      name = ' '//trim(test%soil%law%unit%name)
      associate (soil => test%soil)
         write (output_unit, '(a)') trim(test%name)//' ('//trim(test%material)//', MUD '//library_version()//')'
         write (output_unit, '(a)') '   end        eps_a '//short(point%strain(AXIAL))//', eps_v '// &
            short(volumetric_strain(point))//', p'' '//short(mean_stress(point))//name//', q '// &
            short(deviator_stress(point))//name//', e '//short(void_ratio(soil, point))//', S_w '// &
            short(saturation(soil, point))//psi()
         write (output_unit, '(a)') '   work       '//whole(tally%increments)//' increments'// &
            counted(', ', tally%cuts, ' cuts')//', '//whole(tally%updates)//' updates'// &
            counter('n_substep', ' substeps')//counter('n_reject', ' rejected')// &
            counter('n_rate', ' rates')//counter('n_reset', ' resets')//'; '// &
            short(real(nint(100.0_wp*(clock() - timer%start)), wp)/100.0_wp)//' s'
         guards = ''
         do i = 1, soil%law%n_guards
            guards = guards//counted(', '//trim(soil%law%guard_names(i))//' ', tally%guards(i), '')
         end do
         if (guards /= '') write (output_unit, '(a)') '   guards     '//guards(3:)
         if (tally%solved > 0) then
            write (output_unit, '(a)') '   control    prescribed stresses are met within '//short(tally%worst)// &
               ' of their value (allowed '//short(tally%tolerance)//')'
         end if
         if (tally%refusal /= '') write (output_unit, '(a)') '   refused    the first refused update: '// &
            trim(tally%refusal)
         if (tally%saved) write (output_unit, '(a)') '   saved      '//trim(tally%save_to)// &
            ', a case file of that update'
         write (output_unit, '(a)') '   output     '//table%path//', '//whole(table%rows)//' rows'
      end associate
   contains
      !> A counter of the state, behind a comma; nothing where it is 0 or the law has none.
      function counter(name, after) result(text)
         character(*), intent(in) :: name, after
         character(:), allocatable :: text
         real(wp) :: value

         text = ''
         value = state_value(test%soil, point, name)
         if (value > 0.0_wp) text = ', '//short(value)//after
      end function counter

      !> A count between two texts; nothing where it is 0.
      function counted(before, number, after) result(text)
         character(*), intent(in) :: before, after
         integer, intent(in) :: number
         character(:), allocatable :: text

         text = ''
         if (number > 0) text = before//whole(number)//after
      end function counted

      !> The state parameter, where the law has one.
      function psi() result(text)
         character(:), allocatable :: text

         text = ''
         if (state_index(test%soil%law, 'state_parameter') > 0) &
            text = ', psi '//short(state_value(test%soil, point, 'state_parameter'))
      end function psi
   end subroutine show_summary
end module triax_progress
