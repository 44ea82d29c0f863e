! SPDX-License-Identifier: MIT
!> Observers of a run: tables, fields, checkpoints, ledger, alarms and progress extend `observer_t` and stand in a list.
!> The run tells the list what happens and knows none of them; each keeps what it needs, and exchanges with a
!> checkpoint what a restart needs. An observer changes nothing that the run computes with.
module run_observer
   use archive, only: archive_t
   use convergence, only: control_t, log_t
   use faults, only: fault_t
   use generalised_alpha, only: scheme_t
   use kinds, only: wp
   use model_types, only: model_t
   use run_state, only: run_t
   use wall_clock, only: clock, add_elapsed
   implicit none (type, external)
   private
   public :: observer_t, observers_t, slot_t, accepted_step_t

   !> An accepted step.
   type :: accepted_step_t
      integer :: stage = 0                 !< Number of the stage.
      type(scheme_t) :: scheme             !< It has the length of the step.
      type(control_t) :: control           !< Limits of Newton's method in it.
      type(log_t) :: log                   !< Log of Newton's method.
      real(wp) :: error = 0.0_wp           !< Estimate of a controlled step's own, share of the change of its field [-].
      logical :: last = .false.            !< The stage ends with it.
      real(wp) :: localised = 0.0_wp       !< Share of the shear work without ellipticity [-], set by its observer.
      real(wp) :: contact_work = 0.0_wp    !< Work done on contacts so far [kJ], set by the ledger, which stands first.
   end type accepted_step_t

   !> All procedures do nothing unless an observer has its own. A fault ends the run.
   type, abstract :: observer_t
      character(:), allocatable :: folder   !< Folder of the results; not allocated: no file is written.
   contains
      procedure :: exchange       !< With a checkpoint.
      procedure :: fits           !< Before a restart; changes nothing, and refuses what its files do not fit.
      procedure :: begins         !< Before the first step; run%steps > 0 in a restart.
      procedure :: stage_begins   !< Before a stage is prepared; its contacts act.
      procedure :: step           !< After an accepted step: run%state before it, run%next after it.
      procedure :: taken_over     !< Afterwards: run%state after it.
      procedure :: repeated       !< After an attempt that is not accepted.
      procedure :: stage_ends     !< Also where a fault has ended the run within it: not complete.
      procedure :: ends           !< After the last step, also where the run has failed.
   end type observer_t

   !> A place of the list.
   type :: slot_t
      class(observer_t), allocatable :: observer
   end type slot_t

   !> The list of observers, which are told in its order.
   type :: observers_t
      character(:), allocatable :: folder   !< Folder of the results, for observers that are added.
      type(slot_t), allocatable :: list(:)
   contains
      procedure :: add
      procedure :: exchange_all
      procedure :: check_fit
      procedure :: begin_run
      procedure :: begin_stage
      procedure :: see_step
      procedure :: see_taken_over
      procedure :: see_repeated
      procedure :: end_stage
      procedure :: end_run
   end type observers_t
contains
   !> Exchanges with a checkpoint what the observer needs to go on after a restart.
   subroutine exchange(self, archive)
      class(observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive
   end subroutine exchange

   !> Refuses a restart that the observer's files do not fit; changes nothing. Faults are those of the observer.
   subroutine fits(self, model, run, fault)
      class(observer_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
   end subroutine fits

   !> Prepares the observer for the first step of this process. Faults are those of the observer.
   subroutine begins(self, model, run, fault)
      class(observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
   end subroutine begins

   !> Looks at the run before a stage is prepared; contacts may be probed.
   subroutine stage_begins(self, model, run, number)
      class(observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      integer, intent(in) :: number   !< Number of the stage.
   end subroutine stage_begins

   !> Looks at an accepted step that is not yet taken over; contacts may be probed. A fault ends the run once all have
   !> seen the step taken over.
   subroutine step(self, model, run, done, fault)
      class(observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(accepted_step_t), intent(inout) :: done
      type(fault_t), intent(inout) :: fault
   end subroutine step

   !> Looks at an accepted step that is taken over. A checkpoint exchanges the run and the observers before it in the
   !> list, and takes the factors from the run, which a restart does not have. Faults are those of the observer.
   subroutine taken_over(self, model, run, done, earlier, fault)
      class(observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(accepted_step_t), intent(in) :: done
      type(slot_t), intent(inout) :: earlier(:)   !< Observers before this one.
      type(fault_t), intent(inout) :: fault
   end subroutine taken_over

   !> Looks at a run whose last attempt at a step was not accepted.
   subroutine repeated(self, model, run, dt)
      class(observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: dt   !< Length of the attempt [s].
   end subroutine repeated

   !> Looks at a run at the end of the stage run%at%stage. Faults are those of the observer.
   subroutine stage_ends(self, model, run, complete, fault)
      class(observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      logical, intent(in) :: complete   !< The stage has come to its end.
      type(fault_t), intent(inout) :: fault
   end subroutine stage_ends

   !> Ends the work of the observer. Faults are those of the observer.
   subroutine ends(self, model, run, fault)
      class(observer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
   end subroutine ends

   !> Puts an observer at the end of the list.
   subroutine add(self, observer)
      class(observers_t), intent(inout) :: self
      class(observer_t), intent(in) :: observer
      type(slot_t), allocatable :: longer(:)
      integer :: i, n

      n = 0
      if (allocated(self%list)) n = size(self%list)
      allocate (longer(n + 1))
      do i = 1, n
         call move_alloc(self%list(i)%observer, longer(i)%observer)
      end do
      allocate (longer(n + 1)%observer, source=observer)
      if (allocated(self%folder)) longer(n + 1)%observer%folder = self%folder
      call move_alloc(longer, self%list)
   end subroutine add

   !> Exchanges with an archive what observers keep.
   subroutine exchange_all(self, archive)
      class(observers_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive
      integer :: i

      do i = 1, size(self%list)
         call self%list(i)%observer%exchange(archive)
      end do
   end subroutine exchange_all

   !> Whether a restart fits what every observer has written; changes nothing. Faults are those of the observers.
   subroutine check_fit(self, model, run, fault)
      class(observers_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(self%list)
         if (fault%code == 0) call self%list(i)%observer%fits(model, run, fault)
      end do
   end subroutine check_fit

   !> Tells all that the run begins. Where one raises a fault the run does not begin: those before it are told its end.
   subroutine begin_run(self, model, run, fault)
      class(observers_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: other
      real(wp) :: t0
      integer :: i, k

      t0 = clock()
      if (.not. allocated(self%list)) allocate (self%list(0))
      if (run%steps > 0) call self%check_fit(model, run, fault)
      if (fault%code /= 0) return
      do i = 1, size(self%list)
         call self%list(i)%observer%begins(model, run, fault)
         if (fault%code == 0) cycle
         do k = i - 1, 1, -1
            call self%list(k)%observer%ends(model, run, other)
         end do
         return
      end do
      call add_elapsed(run%seconds_output, t0)
   end subroutine begin_run

   !> Tells all that a stage begins.
   subroutine begin_stage(self, model, run, number)
      class(observers_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      integer, intent(in) :: number   !< Number of the stage.
      integer :: i

      do i = 1, size(self%list)
         call self%list(i)%observer%stage_begins(model, run, number)
      end do
   end subroutine begin_stage

   !> Shows all an accepted step that is not yet taken over. A fault ends the run after see_taken_over: the
   !> first one.
   subroutine see_step(self, model, run, done, fault)
      class(observers_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(accepted_step_t), intent(inout) :: done
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: one
      integer :: i

      do i = 1, size(self%list)
         one = fault_t()
         call self%list(i)%observer%step(model, run, done, one)
         if (fault%code == 0) fault = one
      end do
   end subroutine see_step

   !> Shows an accepted step that is taken over, up to the first fault: after a row that cannot be written there is no
   !> checkpoint.
   subroutine see_taken_over(self, model, run, done, fault)
      class(observers_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(accepted_step_t), intent(in) :: done
      type(fault_t), intent(inout) :: fault
      real(wp) :: t0
      integer :: i

      t0 = clock()
      do i = 1, size(self%list)
         if (fault%code == 0) call self%list(i)%observer%taken_over(model, run, done, self%list(:i - 1), fault)
      end do
      call add_elapsed(run%seconds_output, t0)
   end subroutine see_taken_over

   !> Tells all that an attempt at a step of length dt [s] was not accepted.
   subroutine see_repeated(self, model, run, dt)
      class(observers_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: dt
      integer :: i

      do i = 1, size(self%list)
         call self%list(i)%observer%repeated(model, run, dt)
      end do
   end subroutine see_repeated

   !> Tells all that a stage has ended, or the run within it where there is a fault already, which then stays.
   subroutine end_stage(self, model, run, fault)
      class(observers_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: one
      logical :: complete
      real(wp) :: t0
      integer :: i

      t0 = clock()
      complete = fault%code == 0
      do i = 1, size(self%list)
         one = fault_t()
         call self%list(i)%observer%stage_ends(model, run, complete, one)
         if (fault%code == 0) fault = one
      end do
      call add_elapsed(run%seconds_output, t0)
   end subroutine end_stage

   !> Tells all that the run has ended, in the reverse order; a fault that there is already stays.
   subroutine end_run(self, model, run, fault)
      class(observers_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: one
      integer :: i

      do i = size(self%list), 1, -1
         one = fault_t()
         call self%list(i)%observer%ends(model, run, one)
         if (fault%code == 0) fault = one
      end do
   end subroutine end_run
end module run_observer
