! SPDX-License-Identifier: MIT
!> Observer that owns the folder of a run: one run at a time writes there, and a restart finds the run that it goes on
!> with.
module run_folder
   use archive, only: archive_t
   use faults, only: fault_t
   use field_files, only: check_mesh
   use folder_lock, only: lock_folder, unlock_folder
   use model_types, only: model_t
   use run_observer, only: observer_t
   use run_state, only: run_t
   use scene_parts, only: FINGERPRINT_LENGTH
   implicit none (type, external)
   private
   public :: folder_observer_t

   type, extends(observer_t) :: folder_observer_t
      character(FINGERPRINT_LENGTH) :: origin = ''   !< Fingerprint of the scene that began the run.
   contains
      procedure :: exchange
      procedure :: fits
      procedure :: begins
      procedure :: ends
   end type folder_observer_t
contains
   !> Exchanges the fingerprint of the scene that began the run.
   subroutine exchange(self, archive)
      class(folder_observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call archive%exchange('origin', self%origin)
   end subroutine exchange

   !> Refuses a folder that does not hold the run. Fault EXIT_RESTART: its mesh is of another scene.
   subroutine fits(self, model, run, fault)
      class(folder_observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      call check_mesh(self%folder, self%origin, fault)
   end subroutine fits

   !> Takes the folder, which a new run makes. Fault EXIT_OUTPUT: another run writes to it.
   subroutine begins(self, model, run, fault)
      class(folder_observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      if (run%steps == 0) self%origin = model%origin%fingerprint
      call lock_folder(self%folder, run%steps == 0, fault)
   end subroutine begins

   !> Gives the folder free.
   subroutine ends(self, model, run, fault)
      class(folder_observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      call unlock_folder(self%folder)
   end subroutine ends
end module run_folder
