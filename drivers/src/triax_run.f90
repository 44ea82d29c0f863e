! SPDX-License-Identifier: MIT
!> Runs a test: its stages one after the other, a row of the table where a stage calls for one.
module triax_run
   use faults, only: fault_t
   use kinds, only: wp
   use texts, only: whole
   use triax_case, only: case_t
   use triax_columns, only: values_of
   use triax_control, only: tally_t
   use triax_stage_run, only: stage_run_t, begin_stage, next_increment, share_done
   use triax_moments, only: moments_t, note_moment
   use triax_output, only: table_t, write_row, add_note, close_table
   use triax_point, only: point_t
   use triax_progress, only: timer_t, progress_is_due, show_progress
   use triax_stage, only: CONTROL_NAMES, keeps_volume
   use turns, only: follow
   implicit none (type, external)
   private
   public :: run_test

   !> An effective stress turns where it comes back by this share of the largest one: controls hold stresses far better,
   !> and what is less leaves nothing behind [-].
   real(wp), parameter :: LEAST_SWING = 1.0e-3_wp
contains
   !> Runs a test from its start to its end, or to where it stops: rows so far are kept, and the table is closed.
   !> Faults: those of begin_stage, next_increment and of the table, with test and stage before their text.
   subroutine run_test(test, table, tally, timer, point, fault, moments)
      type(case_t), intent(in) :: test
      type(table_t), intent(inout) :: table   !< Open.
      type(tally_t), intent(inout) :: tally
      type(timer_t), intent(inout) :: timer
      type(point_t), intent(out) :: point     !< The sample at the end.
      type(fault_t), intent(inout) :: fault
      type(moments_t), intent(inout), optional :: moments   !< Every increment, for comparisons.
      type(stage_run_t) :: run
      type(fault_t) :: ending
      real(wp) :: pressure, share, farthest(6)
      integer :: i, way, k, sense(6), turned(6)

      tally%tolerance = test%control_tolerance
      tally%max_updates = test%max_updates
      point = test%start
      farthest = point%stress
      sense = 0
      turned = 0
      pressure = 0.0_wp
      call write_row(table, test%soil, point, run, 0.0_wp, 0, fault)
      stages: do i = 1, size(test%stages)
         associate (stage => test%stages(i))
            call begin_stage(test%soil, stage, point, pressure, run, fault)
            if (fault%code == 0 .and. run%finished) &   ! it has no length: its end is where it begins
               call write_row(table, test%soil, point, run, 0.0_wp, i, fault)
            if (fault%code /= 0) exit stages
            do while (.not. run%finished)
               way = run%way
               k = run%k + 1
               call next_increment(test%soil, stage, run, point, tally, fault)
               if (fault%code /= 0) exit stages
               tally%increments = tally%increments + 1
               if (keeps_volume(stage%control)) then
                  farthest = point%stress
               else
                  call follow(point%stress, LEAST_SWING*maxval(abs(point%stress)), farthest, sense, turned)
               end if
               tally%reversals = maxval(turned)
               if (present(moments)) call note_moment(moments, [i, way, k], run%finished .or. run%way /= way, &
                                                      values_of(test%soil, point, run, 0.0_wp, i))
               if (run%row) then
                  call write_row(table, test%soil, point, run, tally%error, i, fault)
                  tally%error = 0.0_wp
                  if (fault%code /= 0) exit stages
               end if
               share = (real(i - 1, wp) + share_done(run))/real(size(test%stages), wp)
               if (progress_is_due(timer, share)) call show_progress(timer, share, &
                  'stage '//whole(i)//' of '//whole(size(test%stages))//' ('// &
                  trim(CONTROL_NAMES(stage%control))//')'//in_cycle(run))
            end do
            pressure = run%pressure
            if (len_trim(run%note) > 0) call add_note(table, 'stage '//whole(i)//': '//trim(run%note), fault)
         end associate
      end do stages

      if (fault%code /= 0) then
         fault%text = trim(test%name)//', stage '//whole(i)//': '//fault%text
         call close_table(table, trim(fault%text), ending)
      else
         call close_table(table, '', fault)
      end if
   end subroutine run_test

   !> ", cycle 3", or nothing.
   pure function in_cycle(run) result(text)
      type(stage_run_t), intent(in) :: run
      character(:), allocatable :: text

      text = ''
      if (run%cycle > 0) text = ', cycle '//whole(run%cycle)
   end function in_cycle
end module triax_run
