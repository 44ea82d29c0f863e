! SPDX-License-Identifier: MIT
!> Checkpoints: the complete state of a run in one file, and a run from one. Every part of a run exchanges what it keeps
!> by itself.
module checkpoints
   use archive, only: archive_t, archive_kind_t, create_archive, open_archive, close_archive
   use run_state, only: run_t, exchange_run
   use output_tables, only: tables_t, flush_tables, exchange_tables
   use model_types, only: model_t
   use faults, only: fault_t, raise, EXIT_OUTPUT, EXIT_RESTART
   use namelists, only: group_t
   use texts, only: whole
   implicit none (type, external)
   private
   public :: write_checkpoint, read_checkpoint, CHECKPOINT

   character(*), parameter :: CHECKPOINT = 'checkpoint.h5'
   type(archive_kind_t), parameter :: KIND_OF_FILE = archive_kind_t('checkpoint of mud_host', '18', &
      CHECKPOINT//' of a run', &
      ' is an HDF5 file, but no checkpoint of mud_host; name the '//CHECKPOINT//' of a run.', &
      'Finish the run with the program that began it.')
   character(*), parameter :: DAMAGED = ' is damaged: an entry is missing, has another extent or a wrong '// &
                                        'checksum; use an older copy, or start anew.'
contains
   !> Writes the complete state of a run to checkpoint.h5 in the folder of the tables, in place of an older one. Fault
   !> EXIT_OUTPUT: a table or the checkpoint cannot be written.
   subroutine write_checkpoint(model, run, tables, fault)
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run   !< Stays as it is; a restart would restore it.
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault
      type(archive_t) :: archive
      logical :: good

      ! What the checkpoint counts on comes first.
      call flush_tables(tables, fault)
      if (fault%code /= 0) return
      call create_archive(tables%folder//'/'//CHECKPOINT, KIND_OF_FILE, archive)
      call exchange_scene(tables%folder, model, archive, fault)
      call exchange_run(model, run, archive)
      call exchange_tables(size(model%points), tables, archive)
      call close_archive(archive, good)
      if (.not. good) call raise(fault, EXIT_OUTPUT, tables%folder//'/'//CHECKPOINT//' cannot be written; is the '// &
                                 'disk full? The one before is untouched: make room and use --restart.')
   end subroutine write_checkpoint

   !> Puts a prepared run where the checkpoint was written. Fault EXIT_RESTART: no checkpoint, a damaged one,
   !> one of another version, or of another scene.
   subroutine read_checkpoint(path, model, run, tables, fault)
      character(*), intent(in) :: path
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault
      type(archive_t) :: archive
      logical :: good

      call open_archive(path, KIND_OF_FILE, archive, fault)
      if (fault%code /= 0) return
      call exchange_scene(path, model, archive, fault)
      if (fault%code == 0) call exchange_run(model, run, archive)
      if (fault%code == 0) call exchange_tables(size(model%points), tables, archive)
      call close_archive(archive, good)
      if (fault%code == 0 .and. .not. good) call raise(fault, EXIT_RESTART, path//DAMAGED)
      if (fault%code == 0) tables%stage = model%stages(run%at%stage)%name
   end subroutine read_checkpoint

   !> Exchanges what tells scenes apart. Fault EXIT_RESTART: the archive belongs to another scene, and the first group
   !> that differs is named; or it is damaged.
   subroutine exchange_scene(path, model, archive, fault)
      character(*), intent(in) :: path
      type(model_t), intent(in) :: model
      type(archive_t), intent(inout) :: archive
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: theirs(:)
      character(len(model%name)) :: scene
      character(len(model%fingerprint)) :: fingerprint
      character(:), allocatable :: there
      integer :: g, groups

      scene = model%name
      fingerprint = model%fingerprint
      allocate (theirs, source=model%hashes)
      call archive%exchange('scene', scene)
      call archive%exchange('fingerprint', fingerprint)
      call archive%exchange_allocatable('groups', theirs, '-', &
                                        'two numbers for every group of the scene, to find the one that differs')
      if (fingerprint == model%fingerprint) return
      if (.not. archive%is_intact() .or. .not. allocated(theirs)) then
         call raise(fault, EXIT_RESTART, path//DAMAGED)
         return
      end if
      groups = size(model%groups)
      do g = 1, min(groups, size(theirs)/2)
         if (any(model%hashes(2*g - 1:2*g) /= theirs(2*g - 1:2*g))) exit
      end do
      there = whole(size(theirs)/2)
      if (g > groups) then
         call different(whole(groups)//' groups are here, and '//there//' were in the scene of the checkpoint')
      else if (2*g > size(theirs)) then
         call different('the checkpoint has no '//named(model%groups(g))//', for its scene ended after '//there// &
                        ' groups')
      else
         call different(named(model%groups(g))//' is another group, or has another key, value or file, here than '// &
                        'in the checkpoint')
      end if
   contains
      subroutine different(text)
         character(*), intent(in) :: text

         call raise(fault, EXIT_RESTART, path//' belongs to another scene ('//trim(scene)// &
                    '): '//text//'. Groups, keys, values and files must be those of the run, but for threads, '// &
                    'goals and checkpoint_*; start a changed scene from its beginning.')
      end subroutine different

      function named(group) result(text)
         type(group_t), intent(in) :: group
         character(:), allocatable :: text

         text = '&'//trim(group%name)//' in line '//whole(group%line)
      end function named
   end subroutine exchange_scene
end module checkpoints
