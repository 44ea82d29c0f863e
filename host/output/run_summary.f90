! SPDX-License-Identifier: MIT
!> Observer that says what came of a run: the largest value of every answer, the steps and what kept them
!> short, the warnings again, and that errors are not known to it.
module run_summary
   use, intrinsic :: iso_fortran_env, only: output_unit
   use archive, only: archive_t
   use faults, only: fault_t
   use kinds, only: wp
   use named_points, only: values_at
   use porous_domain, only: UNDRAINED
   use run_cost, only: print_cost
   use run_observer, only: observer_t, BEGINS, TAKEN_OVER, STAGE_ENDS, ENDS
   use run_state, only: run_t, LIMITS, LIMIT_NAMES
   use texts, only: shell_word, short, whole
   use unknown_fields, only: FIELDS, FIELD_NAMES, DISPLACEMENTS
   use wall_clock, only: clock
   use warnings, only: repeat_warnings
   implicit none (type, external)
   private
   public :: summary_observer_t

   integer, parameter :: DIGITS_SAID = 3   !< Digits of a value; a time has as many as tell it from the step before.

   real(wp), parameter :: NOISE = 1.0e-10_wp   !< Share of the largest displacement or pressure that is rounding.

   type, extends(observer_t) :: summary_observer_t
      logical :: quiet = .false.         !< Nothing is said of the answers.
      logical :: verbose = .false.       !< Memory, times and counters are printed.
      real(wp) :: started = 0.0_wp       !< When the program began, on the wall clock [s].
      !> Largest magnitudes of the unknowns at the named points so far, with their signs, when, and the step to it.
      real(wp), allocatable :: peak(:, :), time(:, :), dt(:, :)   !< (FIELDS, points) [m, kPa], [s], [s]
   contains
      procedure :: exchange
      procedure :: hear
   end type summary_observer_t
contains
   !> Exchanges the largest values so far.
   subroutine exchange(self, archive)
      class(summary_observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call archive%exchange_allocatable('peaks_value', self%peak, 'm, kPa', &
                                        'largest unknowns of the named points so far')
      call archive%exchange_allocatable('peaks_time', self%time, 's', 'times of these values')
      call archive%exchange_allocatable('peaks_dt', self%dt, 's', 'steps that led to these values')
   end subroutine exchange

   !> Notes the largest values, which are zero before the first step, and says how a stage went that has come to its
   !> end, what came of the run, and what it has cost.
   subroutine hear(self, event, run, fault)
      class(summary_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      select case (event)
      case (BEGINS)
         if (run%steps > 0) return
         associate (points => size(run%model%output%points))
            allocate (self%peak(FIELDS, points), self%time(FIELDS, points), self%dt(FIELDS, points), source=0.0_wp)
         end associate
      case (TAKEN_OVER)
         call note_peaks(self, run)
      case (STAGE_ENDS)
         if (run%complete .and. .not. self%quiet) write (output_unit, '(a)') 'Stage '//trim(run%stage%name)// &
            ': '//counted(run%at%step, 'step')//', time '//short(run%state%time)//' s, '// &
            counted(run%iterations, 'linear solve')//' and '//counted(run%cuts, 'cut')//' so far.'
      case (ENDS)
         if (run%steps == 0) return
         if (.not. self%quiet) call print_summary(self, output_unit, run)
         if (self%verbose) call print_cost(output_unit, run, clock() - self%started)
      end select
   end subroutine hear

   !> Notes the largest values.
   subroutine note_peaks(self, run)
      class(summary_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      real(wp) :: x(FIELDS)
      integer :: i

      do i = 1, size(run%model%output%points)
         x = values_at(run%model%output%points(i), run%state%x)
         where (abs(x) > abs(self%peak(:, i)))
            self%time(:, i) = run%state%time
            self%dt(:, i) = run%scheme%dt
            self%peak(:, i) = x
         end where
      end do
   end subroutine note_peaks

   !> Writes the summary; nothing of answers that no step has changed, of steps where all are given.
   subroutine print_summary(self, unit, run)
      class(summary_observer_t), intent(in) :: self
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(run_t), intent(in) :: run
      character(:), allocatable :: text
      real(wp) :: most(2)
      logical :: follows
      integer :: i, f

      most = [maxval([0.0_wp, abs(self%peak(:DISPLACEMENTS, :))]), &
              maxval([0.0_wp, abs(self%peak(DISPLACEMENTS + 1:, :))])]
      do i = 1, size(run%model%output%points)
         associate (point => run%model%output%points(i), m => run%domain)
            ! Pressures of an undrained region are no unknowns of its nodes: they follow from strains.
            follows = m%regions(m%region_of((point%gauss - 1)/m%rule + 1))%drainage == UNDRAINED
            do f = 1, FIELDS
               if (.not. abs(self%peak(f, i)) > NOISE*most(merge(1, 2, f <= DISPLACEMENTS))) cycle
               if (all(run%dofs%of(f, point%nodes) == 0) .and. .not. (follows .and. f > DISPLACEMENTS)) cycle
               write (unit, '(a)') trim(point%name)//'.'//trim(FIELD_NAMES(f))//' '// &
                  with_unit(self%peak(f, i), trim(merge('m  ', 'kPa', f <= DISPLACEMENTS)))//' at '// &
                  with_unit(self%time(f, i), 's', self%dt(f, i))
            end do
         end associate
      end do
      text = counted(run%steps, 'step')
      associate (c => run%control)
         if (any(run%model%stages%controlled)) then
            text = text//', '//counted(c%rejected, 'repetition')//' because of an error; kept short by'
            do i = 1, LIMITS
               if (c%limits(i) > 0.0_wp) text = text//' '//trim(LIMIT_NAMES(i))//' ('//whole(nint(c%limits(i)))//'),'
            end do
            text = text(:len(text) - 1)
         end if
      end associate
      write (unit, '(a)') text//'.'
      call repeat_warnings(unit)
      write (unit, '(a)') 'The errors of these answers are not known; "mud_study accuracy '// &
         shell_word(run%model%origin%file)//'" measures them.'
   end subroutine print_summary

   !> Says a value in the multiple of its unit that a reader would choose: metres and seconds also in thousandths and
   !> millionths. Of three digits, or as many as resolve a part of it.
   pure function with_unit(value, unit, part) result(text)
      real(wp), intent(in) :: value   !< [m], [s] or another unit.
      character(*), intent(in) :: unit
      real(wp), intent(in), optional :: part   !< In the same unit; > 0.
      character(:), allocatable :: text
      integer :: digits

      digits = DIGITS_SAID
      if (present(part)) digits = min(precision(value), max(digits, 1 + order(value) - order(part)))
      if (unit == 'kPa' .or. abs(value) >= 0.1_wp .or. .not. abs(value) > 0.0_wp) then
         text = short(value, digits)//' '//unit
      else if (abs(value) >= 1.0e-4_wp) then
         text = short(1.0e3_wp*value, digits)//' m'//unit
      else
         text = short(1.0e6_wp*value, digits)//' u'//unit
      end if
   end function with_unit

   !> Finds the power of ten of the first digit of a number; that of zero is 0.
   pure integer function order(value)
      real(wp), intent(in) :: value

      order = 0
      if (abs(value) > 0.0_wp) order = floor(log10(abs(value)))
   end function order

   !> Counts things, as in "1 step" and "2 steps".
   pure function counted(number, noun) result(text)
      integer, intent(in) :: number
      character(*), intent(in) :: noun
      character(:), allocatable :: text

      text = whole(number)//' '//noun//trim(merge(' ', 's', number == 1))
   end function counted
end module run_summary
