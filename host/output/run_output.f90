! SPDX-License-Identifier: MIT
!> Output during a run: tables, fields, checkpoints, the progress line and warnings.
module run_output
   use, intrinsic :: iso_fortran_env, only: output_unit
   use kinds, only: wp
   use wall_clock, only: clock
   use faults, only: fault_t, raise
   use folder_lock, only: lock_folder, unlock_folder
   use interrupts, only: interrupted, EXIT_INTERRUPTED
   use texts, only: short
   use checkpoints, only: write_checkpoint, CHECKPOINT
   use warnings, only: print_warning
   use field_files, only: write_frame
   use model_types, only: model_t
   use output_tables, only: tables_t, open_tables, write_history, write_ledger, write_contacts, write_fields, &
                            write_points, &
                            write_contact_nodes, write_reactions, close_reactions, close_tables, hand_over_tables
   use progress_line, only: progress_t, show_progress, show_line, clear_progress
   use run_observer, only: run_observer_t, step_report_t
   use run_state, only: run_t
   use run_summary, only: note_peaks, print_summary, counted
   implicit none (type, external)
   private
   public :: run_output_t

   real(wp), parameter :: PICTURES = 50.0_wp   !< Fields of a stage with controlled steps, if no key says when.
   real(wp), parameter :: ON_TIME = 1.0e-6_wp   !< Distance from a time of output, share of output_dt, that is rounding.

   type, extends(run_observer_t) :: run_output_t
      character(:), allocatable :: folder
      logical :: quiet = .false.
      logical :: resume = .false.               !< The run goes on from a checkpoint.
      type(tables_t) :: tables
      type(progress_t) :: progress
      real(wp) :: last_checkpoint = 0.0_wp      !< When it was written.
   contains
      procedure :: run_begins
      procedure :: step_done
      procedure :: stage_done
      procedure :: run_ends
      procedure :: warn
   end type run_output_t
contains
   !> Opens the files; a new run writes its start. Faults of open_tables and write_frame.
   subroutine run_begins(self, model, run, fault)
      class(run_output_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      self%progress%quiet = self%quiet
      self%last_checkpoint = clock()
      call lock_folder(self%folder, .not. self%resume, fault)
      if (fault%code /= 0) return
      call open_tables(self%folder, model, self%resume, self%tables, fault)
      if (fault%code /= 0) call unlock_folder(self%folder)
      if (fault%code /= 0 .or. run%steps > 0) return
      call write_points(self%folder, model, fault)
      if (fault%code == 0) call write_history(self%tables, model, run%state, fault)
      if (fault%code == 0) call write_frame(self%folder, model%domain, run%state, self%tables%frames, fault)
   end subroutine run_begins

   !> Tables, fields and a checkpoint where they are due, and the progress line. Fault EXIT_OUTPUT: a file cannot be
   !> written.
   subroutine step_done(self, model, run, report, checkpoint, fault)
      class(run_output_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(step_report_t), intent(in) :: report
      logical, intent(out) :: checkpoint
      type(fault_t), intent(inout) :: fault

      checkpoint = .false.
      call note_peaks(model, run%state, report%dt, self%tables%peaks)
      associate (stage => model%stages(report%stage), step => run%at%step)
         call write_ledger(self%tables, run%state%time, report, run%ledger, fault)
         call write_contacts(self%tables, model, run%system%contacts, report%dt, run%state, run%ledger%contact, fault)
         if (mod(step, stage%every) == 0 .or. report%last) then
            call write_history(self%tables, model, run%state, fault)
            if (fault%code == 0) call write_reactions(self%tables, model, run, report%dt, fault)
         end if
         call hand_over_tables(self%tables, fault)
         if (fault%code /= 0) return
         if (stage%output_dt > 0.0_wp .and. .not. report%last) then
            if (abs((run%state%time - run%at%t_start)/stage%output_dt - anint((run%state%time - run%at%t_start) &
                /stage%output_dt)) < ON_TIME) call write_frame(self%folder, model%domain, run%state, &
                                                               self%tables%frames, fault)
         else if (stage%fields > 0 .and. .not. report%last) then
            if (mod(step, stage%fields) == 0) &
               call write_frame(self%folder, model%domain, run%state, self%tables%frames, fault)
         else if (stage%controlled .and. stage%film .and. .not. report%last) then
            if (picture_of(run%state%time - run%at%t_start) > picture_of(run%state%time - report%dt - run%at%t_start)) &
               call write_frame(self%folder, model%domain, run%state, self%tables%frames, fault)
         end if
      end associate
      if (fault%code /= 0) return
      if (model%checkpoint_steps > 0) checkpoint = mod(run%steps, model%checkpoint_steps) == 0
      if (model%checkpoint_seconds > 0.0_wp) &
         checkpoint = clock() - self%last_checkpoint >= model%checkpoint_seconds .or. checkpoint
      if (interrupted()) checkpoint = .true.
      if (checkpoint) then
         call write_checkpoint(model, run, self%tables, fault)
         self%last_checkpoint = clock()
         if (fault%code /= 0) return
      end if
      if (interrupted() .and. .not. (report%last .and. report%stage == size(model%stages))) then
         call tell_interruption(self, run, fault)
         return
      end if
      call show_progress(model, run, self%progress)
   contains
      !> Number of the last picture up to a time since the start of the stage.
      pure integer function picture_of(time)
         real(wp), intent(in) :: time   !< [s]

         picture_of = floor(PICTURES*(time/model%stages(report%stage)%duration)*(1 + ON_TIME))
      end function picture_of
   end subroutine step_done

   !> Ends a run that is interrupted. Fault EXIT_INTERRUPTED.
   subroutine tell_interruption(self, run, fault)
      class(run_output_t), intent(in) :: self
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      call raise(fault, EXIT_INTERRUPTED, 'Interrupted at '//short(run%state%time)//' s: the results up to there '// &
                 'are complete; --restart '//self%folder//'/'//CHECKPOINT//' goes on.')
   end subroutine tell_interruption

   !> The end of a stage; after a failure too, for what was computed. Fault EXIT_OUTPUT: a file cannot be written.
   subroutine stage_done(self, model, run, stage, complete, fault)
      class(run_output_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      integer, intent(in) :: stage   !< Its number.
      logical, intent(in) :: complete
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: name

      call clear_progress(self%progress)
      name = trim(model%stages(stage)%name)
      if (complete .and. .not. self%quiet) write (output_unit, '(a)') 'Stage '//name//': '// &
         counted(run%at%step, 'step')//', time '//short(run%state%time)//' s, '// &
         counted(run%iterations, 'linear solve')//' and '// &
         counted(run%cuts, 'cut')//' so far.'
      call close_reactions(self%tables, fault)
      call write_fields(self%folder, model%domain, name, run%state, fault)
      if (fault%code == 0) call write_contact_nodes(self%folder, model, run%system%contacts, name, run%state, fault)
      if (fault%code == 0) call write_frame(self%folder, model%domain, run%state, self%tables%frames, fault)
   end subroutine stage_done

   !> Closes the files and says what came of it. Fault EXIT_OUTPUT: a file cannot be written.
   subroutine run_ends(self, model, run, fault)
      class(run_output_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      call close_tables(self%tables, fault)
      call unlock_folder(self%folder)
      if (.not. self%quiet) call print_summary(output_unit, model, run, self%tables%peaks)
   end subroutine run_ends

   !> Prints a warning; a text that passes takes the place of the progress line, unless the run is quiet.
   subroutine warn(self, text, passing)
      class(run_output_t), intent(inout) :: self
      character(*), intent(in) :: text
      logical, intent(in), optional :: passing

      if (present(passing)) then
         if (.not. self%quiet) call show_line(text, self%progress)
         return
      end if
      call clear_progress(self%progress)
      call print_warning(text)
   end subroutine warn
end module run_output
