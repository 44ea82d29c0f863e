! SPDX-License-Identifier: MIT
!> Checkpoints, the complete state of a run in one file, and a run from one. Every part of a run and every observer
!> exchanges what it keeps by itself.
module checkpoints
   use archive, only: archive_t
   use archive_file, only: archive_file_t, archive_kind_t, create_archive, open_archive, close_archive
   use run_state, only: run_t, exchange_run
   use run_observer, only: observers_t
   use wall_clock, only: clock, add_elapsed
   use warnings, only: exchange_warnings
   use interrupts, only: interrupted, EXIT_INTERRUPTED
   use kinds, only: wp
   use model_types, only: model_t
   use faults, only: fault_t, raise, EXIT_OUTPUT, EXIT_RESTART
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: keep_run, read_checkpoint

   character(*), parameter :: CHECKPOINT = 'checkpoint.h5'
   type(archive_kind_t), parameter :: KIND_OF_FILE = archive_kind_t('checkpoint of mud_host', '23', &
      CHECKPOINT//' of a run', &
      ' is an HDF5 file, but no checkpoint of mud_host; name the '//CHECKPOINT//' of a run.', &
      'Finish the run with the program that began it.')
   character(*), parameter :: DAMAGED = ' is damaged: an entry is missing, has another extent or a wrong '// &
                                        'checksum; use an older copy, or start anew.'
contains
   !> Writes a checkpoint of a run that has a folder where it is due, and ends a run that is interrupted. Answers do not
   !> depend on whether one is written. Faults: EXIT_OUTPUT, it cannot be written; EXIT_INTERRUPTED.
   subroutine keep_run(run, observers, fault)
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      real(wp) :: t0
      logical :: due

      if (.not. allocated(observers%folder)) return
      t0 = clock()
      due = interrupted()
      associate (steps => run%model%output%checkpoint_steps, seconds => run%model%output%checkpoint_seconds)
         if (steps > 0) due = due .or. mod(run%steps, steps) == 0
         if (seconds > 0.0_wp) due = t0 - run%kept >= seconds .or. due
      end associate
      if (due) then
         call write_checkpoint(observers%folder, run, observers, fault)
         run%kept = clock()
         call add_elapsed(run%seconds_output, t0)
      end if
      if (fault%code == 0 .and. interrupted() .and. &
          .not. (run%last .and. run%at%stage == size(run%model%stages))) call raise(fault, &
         EXIT_INTERRUPTED, 'Interrupted at '//short(run%state%time)//' s: the results up to there are complete; '// &
         '--restart '//observers%folder//'/'//CHECKPOINT//' goes on.')
   end subroutine keep_run

   !> Writes the complete state of a run to checkpoint.h5, in place of an older one. Fault EXIT_OUTPUT: a table or the
   !> checkpoint cannot be written.
   subroutine write_checkpoint(folder, run, observers, fault)
      character(*), intent(in) :: folder
      type(run_t), intent(inout) :: run   !< Stays as it is; a restart would restore it.
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      type(archive_file_t) :: archive
      logical :: good

      call create_archive(folder//'/'//CHECKPOINT, KIND_OF_FILE, archive)
      call exchange_scene(folder, run%model, archive, fault)
      call exchange_run(run, archive)
      call observers%exchange(archive)
      call exchange_warnings(archive)
      call close_archive(archive, good)
      if (.not. good) call raise(fault, EXIT_OUTPUT, folder//'/'//CHECKPOINT//' cannot be written; is the '// &
                                 'disk full? The one before is untouched: make room and use --restart.')
   end subroutine write_checkpoint

   !> Puts a prepared run and its observers where the checkpoint was written. Fault EXIT_RESTART: there
   !> is no checkpoint, or it is damaged, of another version, or of another scene.
   subroutine read_checkpoint(path, run, observers, fault)
      character(*), intent(in) :: path
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      type(fault_t), intent(inout) :: fault
      type(archive_file_t) :: archive
      logical :: good

      call open_archive(path, KIND_OF_FILE, archive, fault)
      if (fault%code /= 0) return
      call exchange_scene(path, run%model, archive, fault)
      if (fault%code == 0) call exchange_run(run, archive)
      if (fault%code == 0) call observers%exchange(archive)
      if (fault%code == 0) call exchange_warnings(archive)
      call close_archive(archive, good)
      if (fault%code == 0 .and. .not. good) call raise(fault, EXIT_RESTART, path//DAMAGED)
   end subroutine read_checkpoint

   !> Exchanges what tells scenes apart. Fault EXIT_RESTART: the archive belongs to another scene, and the first group
   !> that differs is named; or it is damaged.
   subroutine exchange_scene(path, model, archive, fault)
      character(*), intent(in) :: path
      type(model_t), intent(in) :: model
      class(archive_t), intent(inout) :: archive
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: theirs(:)
      character(len(model%origin%name)) :: scene
      character(len(model%origin%fingerprint)) :: fingerprint
      character(:), allocatable :: there
      integer :: g, groups

      scene = model%origin%name
      fingerprint = model%origin%fingerprint
      allocate (theirs, source=model%origin%hashes)
      call archive%exchange('scene', scene)
      call archive%exchange('fingerprint', fingerprint)
      call archive%exchange_allocatable('groups', theirs, '-', &
                                        'two numbers for every group of the scene, to find the one that differs')
      if (fingerprint == model%origin%fingerprint) return
      if (.not. archive%good .or. .not. allocated(theirs)) then
         call raise(fault, EXIT_RESTART, path//DAMAGED)
         return
      end if
      groups = size(model%origin%groups)
      do g = 1, min(groups, size(theirs)/2)
         if (any(model%origin%hashes(2*g - 1:2*g) /= theirs(2*g - 1:2*g))) exit
      end do
      there = whole(size(theirs)/2)
      if (g > groups) then
         call different(whole(groups)//' groups are here, and '//there//' were in the scene of the checkpoint')
      else if (2*g > size(theirs)) then
         call different('the checkpoint has no '//trim(model%origin%groups(g))//', for its scene ended after '// &
                        there//' groups')
      else
         call different(trim(model%origin%groups(g))//' is another group, or has another key, value or file, here '// &
                        'than in the checkpoint')
      end if
   contains
      subroutine different(text)
         character(*), intent(in) :: text

         call raise(fault, EXIT_RESTART, path//' belongs to another scene ('//trim(scene)// &
                    '): '//text//'. Groups, keys, values and files must be those of the run, but for threads, '// &
                    'goals and checkpoint_*; start a changed scene from its beginning.')
      end subroutine different
   end subroutine exchange_scene
end module checkpoints
