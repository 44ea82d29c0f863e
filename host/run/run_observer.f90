! SPDX-License-Identifier: MIT
!> Observer of a run: output, progress and checkpoints extend this type, so that the run itself writes nothing.
module run_observer
   use kinds, only: wp
   use faults, only: fault_t
   use model_types, only: model_t
   use convergence, only: log_t
   use run_state, only: run_t
   implicit none (type, external)
   private
   public :: run_observer_t, step_report_t

   !> An accepted step.
   type :: step_report_t
      integer :: stage = 0                 !< Number of the stage.
      real(wp) :: dt = 0.0_wp              !< [s]
      real(wp) :: error = 0.0_wp           !< Estimate of a controlled step's own, share of the change of its field [-].
      real(wp), allocatable :: indicators(:)   !< Of effect_indicators.
      logical :: last = .false.            !< The stage ends with it.
      type(log_t) :: log
   end type step_report_t

   type, abstract :: run_observer_t
      logical :: silent = .false.          !< Nothing is said of what is seen, not even on standard error.
   contains
      procedure(run_i), deferred :: run_begins
      procedure(step_i), deferred :: step_done
      procedure(stage_i), deferred :: stage_done   !< Also after a failure.
      procedure(run_i), deferred :: run_ends       !< Also after a failure.
      procedure(warn_i), deferred :: warn
   end type run_observer_t

   abstract interface
      !> Before the first step; after the last one, also where the run has failed.
      subroutine run_i(self, model, run, fault)
         import :: run_observer_t, model_t, run_t, fault_t
         class(run_observer_t), intent(inout) :: self
         type(model_t), intent(in) :: model
         type(run_t), intent(in) :: run
         type(fault_t), intent(inout) :: fault
      end subroutine run_i

      !> `checkpoint`: the run could be taken up from here, where there are no factors of an earlier matrix. Called
      !> after an accepted step; a fault ends the run.
      subroutine step_i(self, model, run, report, checkpoint, fault)
         import :: run_observer_t, model_t, run_t, step_report_t, fault_t
         class(run_observer_t), intent(inout) :: self
         type(model_t), intent(in) :: model
         type(run_t), intent(inout) :: run    !< Only to be kept: what a checkpoint writes it could also restore.
         type(step_report_t), intent(in) :: report
         logical, intent(out) :: checkpoint   !< For the run.
         type(fault_t), intent(inout) :: fault
      end subroutine step_i

      !> After a stage; `complete`: it has come to its end. A fault ends the run, where none has ended it already.
      subroutine stage_i(self, model, run, stage, complete, fault)
         import :: run_observer_t, model_t, run_t, fault_t
         class(run_observer_t), intent(inout) :: self
         type(model_t), intent(in) :: model
         type(run_t), intent(in) :: run
         integer, intent(in) :: stage   !< Its number.
         logical, intent(in) :: complete
         type(fault_t), intent(inout) :: fault
      end subroutine stage_i

      !> Takes a warning, or a line that counts only while somebody watches the run.
      subroutine warn_i(self, text, passing)
         import :: run_observer_t
         class(run_observer_t), intent(inout) :: self
         character(*), intent(in) :: text
         logical, intent(in), optional :: passing   !< True: such a line.
      end subroutine warn_i
   end interface
end module run_observer
