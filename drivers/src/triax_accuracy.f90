! SPDX-License-Identifier: MIT
!> Increments and tolerance of the stress integration that give the histories of a test an accuracy.
!>
!> A point is cheap, so the error is measured: the test is run with halved increments, and with a quarter of the
!> tolerance, and what grows the error most is refined until the two differences, each times 4/3 (both errors fall by
!> four), are together what was asked for. What the case gives by hand stays; its error is measured all the same.
!> docs/theory/accuracy.md section 5.
module triax_accuracy
   use kinds, only: wp
   use faults, only: fault_t
   use texts, only: short, whole
   use stress_units, only: stress_unit_t, KILOPASCAL
   use triax_case, only: case_t
   use triax_columns, only: COLUMNS, columns_shown
   use triax_control, only: tally_t
   use triax_moments, only: moments_t, differences, ranges, forget_moments
   use triax_output, only: table_t, open_memory_table, add_note
   use triax_point, only: point_t
   use triax_progress, only: timer_t
   use triax_run, only: run_test
   implicit none (type, external)
   private
   public :: accuracy_t, reach_accuracy, verify_accuracy, note_accuracy, accuracy_lines, is_met, LINE_LENGTH

   integer, parameter :: LINE_LENGTH = 160
   real(wp), parameter :: TOLERANCE_SHARE = 0.01_wp      !< First tolerance as a share of the accuracy.
   real(wp), parameter :: LARGEST_TOLERANCE = 1.0e-4_wp, LEAST_TOLERANCE = 1.0e-12_wp
   real(wp), parameter :: TIGHT = 1.0e-3_wp              !< Below it the scheme of order 3 costs less.
   real(wp), parameter :: COARSE = 10.0_wp               !< First increments, times the default.
   integer, parameter :: MOST_REFINEMENTS = 12           !< Most refinements of increments, and of the tolerance:
                                                         !< increments of a four thousandth.
   real(wp), parameter :: OF_COARSE = 4.0_wp/3.0_wp      !< Error over the difference to a run with a quarter of it.
   real(wp), parameter :: NO_CHANGE = 1.0e-3_wp          !< Share of the largest change of its unit that is none.
   real(wp), parameter :: WELL_BELOW = 0.1_wp            !< Share of the accuracy below which an error is not refined.
   real(wp), parameter :: UNKNOWN = 1.0e6_wp             !< Error where a run does not come to its end.

   type :: accuracy_t
      real(wp) :: asked = 0.0_wp
      real(wp) :: by_increments = 0.0_wp, by_tolerance = 0.0_wp   !< Estimated errors of the worst answer [-].
      logical :: verified = .false.
      real(wp) :: change(size(COLUMNS)) = 0.0_wp   !< Largest change of every answer.
      real(wp) :: error(size(COLUMNS)) = 0.0_wp    !< Estimated error of every answer over its change; < 0: no answer.
      type(stress_unit_t) :: unit                  !< Unit of the changes of stresses.
      integer :: runs = 0, updates = 0             !< Cost of the choice.
   end type accuracy_t
contains
   !> Sets increments, tolerance and scheme of a test that asks for an accuracy, and estimates the errors.
   !> docs/theory/accuracy.md section 5. Raises no fault: a run that does not come to its end has the error UNKNOWN.
   subroutine reach_accuracy(test, answer)
      type(case_t), intent(inout) :: test
      type(accuracy_t), intent(out) :: answer
      type(moments_t) :: here, finer, tighter
      logical :: free_increments, free_tolerance
      real(wp) :: off_increments(size(COLUMNS)), off_tolerance(size(COLUMNS))
      integer :: refinements, tightenings, scheme

      answer%asked = test%accuracy
      answer%unit = test%soil%law%unit
      scheme = merge(2, 1, test%accuracy < TIGHT)
      associate (law => test%soil%law, stages => test%stages)
         free_increments = .not. all(stages%given_increment)
         free_tolerance = law%tolerance > 0.0_wp .and. .not. law%given_tolerance
         where (.not. stages%given_increment)
            stages%increment = min(stages%interval, COARSE*stages%increment)
            stages%suction_increment = min(stages%suction_interval, COARSE*stages%suction_increment)
         end where
         if (free_tolerance) call law%integrate_to(min(LARGEST_TOLERANCE, max(LEAST_TOLERANCE, &
                                                   TOLERANCE_SHARE*test%accuracy)), scheme)
         refinements = 0
         tightenings = 0
         call try(test, 1, 1.0_wp, scheme, here, answer)
         do
            call try(test, 2, 1.0_wp, scheme, finer, answer)
            off_increments = OF_COARSE*differences(here, finer, 2)
            off_tolerance = 0.0_wp
            if (law%tolerance > 0.0_wp) then
               call try(test, 1, 0.25_wp, scheme, tighter, answer)
               off_tolerance = OF_COARSE*differences(here, tighter, 1)
            end if
            call estimate(test, finer, off_increments, off_tolerance, answer)
            if (is_met(answer)) exit
            if (free_increments .and. refinements < MOST_REFINEMENTS .and. &
                (answer%by_increments > 0.5_wp*answer%asked .or. .not. free_tolerance)) then
               refinements = refinements + 1
               where (.not. stages%given_increment) stages%parts = 2*stages%parts
            else if (free_tolerance .and. tightenings < MOST_REFINEMENTS .and. &
                     0.25_wp*law%tolerance > LEAST_TOLERANCE .and. &
                     answer%by_tolerance > WELL_BELOW*answer%asked) then
               tightenings = tightenings + 1
               call law%integrate_to(0.25_wp*law%tolerance, scheme)
               here = tighter
               cycle
            else
               exit
            end if
            here = finer
            ! Where the increments of some stages are given, the finer run is another one.
            if (any(stages%given_increment)) call try(test, 1, 1.0_wp, scheme, here, answer)
         end do
      end associate
   end subroutine reach_accuracy

   !> The test again with a quarter of the increments and a sixteenth of the tolerance: the difference takes
   !> the place of the estimate. docs/theory/accuracy.md section 5.
   subroutine verify_accuracy(test, answer)
      type(case_t), intent(inout) :: test
      type(accuracy_t), intent(inout) :: answer
      type(moments_t) :: here, finer
      integer :: scheme

      scheme = merge(2, 1, test%accuracy < TIGHT)
      call try(test, 1, 1.0_wp, scheme, here, answer)
      call try(test, 4, 1.0_wp/16, scheme, finer, answer)
      call estimate(test, finer, differences(here, finer, 4), spread(0.0_wp, 1, size(COLUMNS)), answer)
      answer%verified = .true.
   end subroutine verify_accuracy

   !> A run with all increments in so many parts more and another tolerance; the test is as it was.
   subroutine try(test, parts, share, scheme, moments, answer)
      type(case_t), intent(inout) :: test
      integer, intent(in) :: parts
      real(wp), intent(in) :: share   !< Share of the tolerance.
      integer, intent(in) :: scheme
      type(moments_t), intent(inout) :: moments
      type(accuracy_t), intent(inout) :: answer
      type(table_t) :: table
      type(tally_t) :: tally
      type(timer_t) :: timer
      type(point_t) :: point
      type(fault_t) :: fault
      real(wp) :: tolerance

      call forget_moments(moments)
      tolerance = test%soil%law%tolerance
      test%stages%parts = parts*test%stages%parts
      if (share < 1.0_wp) call test%soil%law%integrate_to(max(LEAST_TOLERANCE, share*tolerance), scheme)
      call open_memory_table(test, table, fault)
      call run_test(test, table, tally, timer, point, fault, moments)
      ! A run that stopped says nothing: the coarser ones must be refined, and the last one tells its fault.
      if (fault%code /= 0) call forget_moments(moments)
      test%stages%parts = test%stages%parts/parts
      if (share < 1.0_wp) call test%soil%law%integrate_to(tolerance, scheme)
      answer%runs = answer%runs + 1
      answer%updates = answer%updates + tally%updates
   end subroutine try

   !> Errors of the columns that are answers, and of the worst one by its origin.
   subroutine estimate(test, moments, off_increments, off_tolerance, answer)
      type(case_t), intent(in) :: test
      type(moments_t), intent(in) :: moments
      real(wp), intent(in) :: off_increments(:), off_tolerance(:)
      type(accuracy_t), intent(inout) :: answer
      logical :: counts(size(COLUMNS))
      real(wp) :: largest
      integer :: i

      answer%change = ranges(moments)
      answer%error = -1.0_wp
      answer%by_increments = 0.0_wp
      answer%by_tolerance = 0.0_wp
      counts = .false.
      counts(columns_shown(test%soil, test%stages)) = .true.
      counts = counts .and. .not. COLUMNS%whole .and. COLUMNS%name /= 'control_error'
      if (moments%n == 0) then
         answer%by_increments = UNKNOWN
         return
      end if
      do i = 1, size(COLUMNS)
         largest = maxval(answer%change, mask=counts .and. COLUMNS%unit == COLUMNS(i)%unit)
         if (.not. counts(i) .or. answer%change(i) <= NO_CHANGE*largest) cycle
         answer%error(i) = min(UNKNOWN, (off_increments(i) + off_tolerance(i))/answer%change(i))
         answer%by_increments = max(answer%by_increments, min(UNKNOWN, off_increments(i)/answer%change(i)))
         answer%by_tolerance = max(answer%by_tolerance, min(UNKNOWN, off_tolerance(i)/answer%change(i)))
      end do
   end subroutine estimate

   !> Whether what was asked for is met by the estimate.
   pure logical function is_met(answer)
      type(accuracy_t), intent(in) :: answer

      is_met = answer%by_increments < UNKNOWN .and. maxval(answer%error) <= answer%asked
   end function is_met

   !> Into the head of the results: what was asked for and what is estimated. Fault EXIT_OUTPUT: the file cannot be
   !> written.
   subroutine note_accuracy(answer, table, fault)
      type(accuracy_t), intent(in) :: answer
      type(table_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault
      character(LINE_LENGTH), allocatable :: lines(:)
      integer :: i

      allocate (lines(0))   ! or gfortran believes the assignment to read it
      lines = accuracy_lines(answer)
      do i = 1, size(lines)
         call add_note(table, 'accuracy: '//trim(lines(i)), fault)
      end do
   end subroutine note_accuracy

   !> Lines with the accuracy that was asked for, the estimate of every answer and what limits it. (answers + 2) Errors
   !> in %, changes in the unit of their column.
   pure function accuracy_lines(answer) result(lines)
      type(accuracy_t), intent(in) :: answer
      character(LINE_LENGTH), allocatable :: lines(:)
      integer :: i, n

      allocate (lines(count(answer%error >= 0.0_wp) + 2))
      lines = ''
      lines(1) = 'asked '//short(100*answer%asked)//' %, '//trim(merge('verified ', 'estimated', answer%verified))// &
                 ' (largest error over largest change):'
      n = 1
      do i = 1, size(COLUMNS)
         if (answer%error(i) < 0.0_wp) cycle
         n = n + 1
         lines(n) = trim(COLUMNS(i)%name)//' '//short(100*answer%error(i))//' % of '//short(answer%change(i))// &
                    trim(merge(' '//answer%unit%name, '      ', COLUMNS(i)%unit == KILOPASCAL%name))
      end do
      if (answer%verified) then
         lines(n + 1) = 'difference to a run with a quarter of the increments and a sixteenth of the tolerance'
      else
         lines(n + 1) = 'increments '//short(100*answer%by_increments)//' %, stress tolerance '// &
                        short(100*answer%by_tolerance)//' %'
      end if
      lines(n + 1) = trim(lines(n + 1))//'; '//whole(answer%runs)//' runs, '//whole(answer%updates)//' updates'
   end function accuracy_lines
end module triax_accuracy
