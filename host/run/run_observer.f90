! SPDX-License-Identifier: MIT
!> Observers of a run: tables, fields, ledger, alarms and progress extend `observer_t` and stand in a list.
!> The run tells the list what happens and knows none of them; each keeps what it needs, and exchanges with a
!> checkpoint what a restart needs. An observer reads the run and changes nothing of it.
module run_observer
   use archive, only: archive_t
   use faults, only: fault_t
   use kinds, only: wp
   use run_state, only: run_t
   use wall_clock, only: clock, add_elapsed
   implicit none (type, external)
   private
   public :: observer_t, observers_t
   public :: FITS, BEGINS, STAGE_BEGINS, STEP, TAKEN_OVER, REPEATED, STAGE_ENDS, ENDS

   ! Events that observers are told.
   integer, parameter :: FITS = 1           !< Before a restart: refuse what your files do not fit.
   integer, parameter :: BEGINS = 2         !< Before the first step; run%steps > 0 in a restart.
   integer, parameter :: STAGE_BEGINS = 3   !< Before the stage run%at%stage is prepared; its contacts act.
   integer, parameter :: STEP = 4           !< After an accepted step: run%state before it, run%next after it. A fault
                                            !< ends the run once all have seen the step taken over.
   integer, parameter :: TAKEN_OVER = 5     !< Afterwards: run%state after it.
   integer, parameter :: REPEATED = 6       !< After an attempt that is not accepted.
   integer, parameter :: STAGE_ENDS = 7     !< Also where a fault has ended the run within the stage.
   integer, parameter :: ENDS = 8           !< After the last step, also where the run has failed.
   !> The first fault keeps those that follow from hearing of it: after a row that cannot be written there is no
   !> checkpoint.
   integer, parameter :: UP_TO_A_FAULT(*) = [FITS, BEGINS, TAKEN_OVER]
   integer, parameter :: TIMED(*) = [BEGINS, TAKEN_OVER, STAGE_ENDS]   !< Events whose time is that of output.

   !> A fault of an observer ends the run.
   type, abstract :: observer_t
      character(:), allocatable :: folder   !< Folder of the results; not allocated: no file is written.
   contains
      procedure :: exchange                 !< With a checkpoint; nothing unless an observer has its own.
      procedure(hear_i), deferred :: hear
   end type observer_t

   abstract interface
      !> Does what the observer has to do at an event. Faults are those of the observer.
      subroutine hear_i(self, event, run, fault)
         import :: observer_t, run_t, fault_t
         class(observer_t), intent(inout) :: self
         integer, intent(in) :: event
         type(run_t), intent(in) :: run
         type(fault_t), intent(inout) :: fault
      end subroutine hear_i
   end interface

   !> A place of the list.
   type :: slot_t
      class(observer_t), allocatable :: observer
   end type slot_t

   !> The list of observers, which are told in its order, of the end in the reverse order.
   type :: observers_t
      character(:), allocatable :: folder   !< Folder of the results, for observers that are added.
      type(slot_t), allocatable :: list(:)
      integer :: begun = 0                  !< Number of those that have begun: these are told the end.
      procedure(keep_i), pointer, nopass :: keep => null()   !< Keeps the run with what all of them keep.
   contains
      procedure :: add
      procedure :: tell
      procedure :: exchange => exchange_all
   end type observers_t

   abstract interface
      !> Keeps a run after a step where that is due, so that another run can go on from there. Faults are those of the
      !> keeper.
      subroutine keep_i(run, observers, fault)
         import :: run_t, observers_t, fault_t
         type(run_t), intent(inout) :: run
         type(observers_t), intent(inout) :: observers
         type(fault_t), intent(inout) :: fault
      end subroutine keep_i
   end interface
contains
   !> Exchanges with a checkpoint what the observer needs to go on after a restart.
   subroutine exchange(self, archive)
      class(observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive
   end subroutine exchange

   !> Exchanges with a checkpoint what every observer keeps.
   subroutine exchange_all(self, archive)
      class(observers_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive
      integer :: i

      do i = 1, size(self%list)
         call self%list(i)%observer%exchange(archive)
      end do
   end subroutine exchange_all

   !> Puts an observer at the end of the list.
   subroutine add(self, observer)
      class(observers_t), intent(inout) :: self
      class(observer_t), intent(in) :: observer
      type(slot_t) :: slot

      allocate (slot%observer, source=observer)
      if (allocated(self%folder)) slot%observer%folder = self%folder
      if (.not. allocated(self%list)) allocate (self%list(0))
      self%list = [self%list, slot]
   end subroutine add

   !> Tells the observers an event. The first fault counts, and one that there is already stays.
   subroutine tell(self, event, run, fault)
      class(observers_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(inout) :: run   !< The time that observers take is added.
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: one
      real(wp) :: t0
      integer :: i, k

      if (.not. allocated(self%list)) return
      t0 = clock()
      do i = 1, merge(self%begun, size(self%list), event == ENDS)
         if (fault%code /= 0 .and. any(event == UP_TO_A_FAULT)) exit
         k = merge(self%begun + 1 - i, i, event == ENDS)
         one = fault_t()
         call self%list(k)%observer%hear(event, run, one)
         if (fault%code == 0) fault = one
         if (event == BEGINS .and. fault%code == 0) self%begun = k
      end do
      if (any(event == TIMED)) call add_elapsed(run%seconds_output, t0)
   end subroutine tell
end module run_observer
