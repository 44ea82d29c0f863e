! SPDX-License-Identifier: MIT
!> Observer that shows the progress of a run in one line, rewritten in place on a terminal; nothing where the output is
!> a file.
module progress_line
   use, intrinsic :: iso_fortran_env, only: output_unit
   use faults, only: fault_t
   use run_observer, only: observer_t, TAKEN_OVER, REPEATED, STAGE_ENDS
   use run_state, only: run_t
   use wall_clock, only: clock
   use kinds, only: wp
   use files, only: to_terminal, terminal_width
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: progress_observer_t, span_of

   real(wp), parameter :: PERIOD = 0.5_wp   !< Between two lines [s].

   type, extends(observer_t) :: progress_observer_t
      integer :: standing = 0               !< Columns of the line that stands on the terminal.
      real(wp) :: last_line = -huge(1.0_wp) !< When it was written.
      integer :: stage = 0                  !< Stage that the next two belong to.
      real(wp) :: begun = 0.0_wp            !< When its first step ended that was seen, on the wall clock [s].
      real(wp) :: from = 0.0_wp             !< Time of the run at the end of that step [s].
   contains
      procedure :: hear
   end type progress_observer_t
contains
   !> Shows steps, attempts that are not accepted, as often as steps, and empties the line at the end of a stage, so
   !> that another can be written.
   subroutine hear(self, event, run, fault)
      class(progress_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      if (.not. to_terminal()) return
      select case (event)
      case (TAKEN_OVER)
         call show_step(self, run)
      case (REPEATED)
         if (clock() - self%last_line < PERIOD) return
         self%last_line = clock()
         call write_line('Stage '//trim(run%stage%name)//', time '//short(run%state%time)// &
                         ' s: a step of '//short(run%scheme%dt)//' s is repeated, cuts '//whole(run%cuts), self)
      case (STAGE_ENDS)
         if (self%standing > 0) write (output_unit, '(a)', advance='no') &
            achar(13)//repeat(' ', self%standing)//achar(13)
         self%standing = 0
      end select
   end subroutine hear

   !> Shows the step, the share of the stage and the time that the stage takes yet if it goes on as so far.
   subroutine show_step(self, run)
      class(progress_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      real(wp) :: now

      now = clock()
      if (self%stage /= run%at%stage) then
         ! The first step has no pace yet.
         self%stage = run%at%stage
         self%begun = now
         self%from = run%state%time
      else if (now - self%last_line >= PERIOD) then
         self%last_line = now
         associate (at => run%at, time => run%state%time, duration => run%stage%duration)
            call write_line('Stage '//trim(run%stage%name)//': step '//whole(at%step)//', time '//short(time)// &
               ' s, '//whole(nint(100*(time - at%t_start)/duration))//' %; about '//span_of((now - self%begun) &
               *(at%t_start + duration - time)/(time - self%from))//' left for this stage', self)
         end associate
      end if
   end subroutine show_step

   !> Replaces the line before by one as long as the terminal is wide: one that wraps could not be taken back.
   subroutine write_line(text, progress)
      character(*), intent(in) :: text
      class(progress_observer_t), intent(inout) :: progress
      integer :: columns

      columns = min(len(text), max(1, terminal_width() - 1))
      write (output_unit, '(a)', advance='no') achar(13)//text(:columns)// &
         repeat(' ', max(0, progress%standing - columns))
      progress%standing = columns
      flush (output_unit)
   end subroutine write_line

   !> Says a duration in hours, minutes or seconds.
   pure function span_of(seconds) result(text)
      real(wp), intent(in) :: seconds   !< [s]
      character(:), allocatable :: text
      integer :: s

      s = nint(min(seconds, 1.0e9_wp))
      if (s < 100) then
         text = whole(s)//' s'
      else if (s < 6000) then
         text = whole(s/60)//' min '//whole(mod(s, 60))//' s'
      else
         text = whole(s/3600)//' h '//whole(mod(s, 3600)/60)//' min'
      end if
   end function span_of
end module progress_line
