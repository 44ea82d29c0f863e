! SPDX-License-Identifier: MIT
!> Observer that shows the progress of a run in one line, rewritten in place on a terminal; nothing where the output is
!> a file.
module progress_line
   use, intrinsic :: iso_fortran_env, only: output_unit
   use faults, only: fault_t
   use run_observer, only: observer_t
   use run_state, only: run_t
   use wall_clock, only: clock
   use kinds, only: wp
   use files, only: to_terminal, terminal_width
   use texts, only: short, whole
   use scene_parts, only: stage_t
   implicit none (type, external)
   private
   public :: progress_observer_t, steps_left, span_of

   real(wp), parameter :: PERIOD = 0.5_wp                  !< Between two lines [s].
   real(wp), parameter :: MEMORY = 0.9_wp                  !< Share of the past in the mean time of a step.

   type, extends(observer_t) :: progress_observer_t
      integer :: standing = 0               !< Columns of the line that stands on the terminal.
      real(wp) :: last_line = -huge(1.0_wp) !< When it was written.
      real(wp) :: last_step = -1.0_wp
      real(wp) :: pace = 0.0_wp             !< Seconds a step, the last ones counting most.
   contains
      procedure :: taken_over
      procedure :: repeated
      procedure :: stage_ends
   end type progress_observer_t
contains
   !> Shows the step, the share of the stage and the time that is left.
   subroutine taken_over(self, run, fault)
      class(progress_observer_t), intent(inout) :: self
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: line
      real(wp) :: now, left
      logical :: known
      integer :: i

      if (.not. to_terminal()) return
      now = clock()
      if (self%last_step >= 0.0_wp) then
         if (self%pace > 0.0_wp) then
            self%pace = MEMORY*self%pace + (1 - MEMORY)*(now - self%last_step)
         else
            self%pace = now - self%last_step
         end if
      end if
      self%last_step = now
      ! The first step has no pace yet.
      if (.not. self%pace > 0.0_wp .or. now - self%last_line < PERIOD) return
      self%last_line = now
      associate (stage => run%stage, at => run%at)
         left = steps_left(stage, at%nominal*at%factor, at%t_start + stage%duration - run%state%time)
         ! Stages to come that choose their steps have not chosen them yet.
         known = .not. any(run%model%stages(at%stage + 1:)%controlled)
         do i = at%stage + 1, merge(size(run%model%stages), at%stage, known)
            left = left + steps_left(run%model%stages(i), run%model%stages(i)%dt, run%model%stages(i)%duration)
         end do
         line = 'Stage '//trim(stage%name)//': step '//whole(at%step)//', time '//short(run%state%time)//' s, '// &
                whole(nint(100*(run%state%time - at%t_start)/stage%duration))//' %; about '// &
                span_of(left*self%pace)//' left for '//trim(merge('all stages', 'this stage', known))
      end associate
      call write_line(line, self)
   end subroutine taken_over

   !> Shows an attempt that is not accepted, as often as that.
   subroutine repeated(self, run, fault)
      class(progress_observer_t), intent(inout) :: self
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      if (.not. to_terminal()) return
      if (clock() - self%last_line < PERIOD) return
      self%last_line = clock()
      call write_line('Stage '//trim(run%stage%name)//', time '//short(run%state%time)// &
                      ' s: a step of '//short(run%scheme%dt)//' s is repeated, cuts '//whole(run%cuts), self)
   end subroutine repeated

   !> Empties the line on the terminal, so that another can be written.
   subroutine stage_ends(self, run, fault)
      class(progress_observer_t), intent(inout) :: self
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      if (self%standing > 0) write (output_unit, '(a)', advance='no') achar(13)//repeat(' ', self%standing)//achar(13)
      self%standing = 0
   end subroutine stage_ends

   !> A line in the place of the one before, as long as the terminal is wide: one that wraps could not be taken back.
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

   !> Steps that the rest of a stage takes if none is cut: a geometric series up to the largest step.
   pure real(wp) function steps_left(stage, dt, time) result(steps)
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt, time   !< The next step; what is left [s].
      real(wp) :: largest, growing, covered

      if (time <= 0.0_wp) then
         steps = 0.0_wp
         return
      end if
      ! The second: as far as it could grow in the time that is left.
      largest = min(max(stage%dt_max, stage%dt), dt + stage%dt_growth*time)
      if (.not. stage%dt_growth > 1.0_wp .or. dt >= largest) then
         steps = time/dt
         return
      end if
      associate (g => stage%dt_growth)
         growing = log(largest/dt)/log(g)
         covered = dt*(largest/dt - 1)/(g - 1)
         if (covered < time) then
            steps = growing + (time - covered)/largest
         else
            steps = log(1 + time*(g - 1)/dt)/log(g)
         end if
      end associate
   end function steps_left

   !> A duration in hours, minutes or seconds, as text.
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
