! SPDX-License-Identifier: MIT
!> The list of observers of a run. A new one needs a line here.
module run_output
   use alarms, only: alarms_t
   use checkpoints, only: keep_run
   use cycles_alarm, only: cycles_alarm_t
   use field_files, only: field_observer_t
   use kinds, only: wp
   use ledger_observer, only: ledger_observer_t
   use output_tables, only: table_observer_t
   use progress_line, only: progress_observer_t
   use run_folder, only: folder_observer_t
   use run_observer, only: observers_t
   use run_summary, only: summary_observer_t
   use water_balance, only: water_alarm_t
   implicit none (type, external)
   private
   public :: list_observers
contains
   !> Lists the observers of a run in the order in which they are told.
   subroutine list_observers(folder, quiet, verbose, started, observers)
      character(*), intent(in) :: folder   !< Folder of the results.
      logical, intent(in) :: quiet         !< Errors and warnings only are printed.
      logical, intent(in) :: verbose       !< Memory, times and counters are printed.
      real(wp), intent(in) :: started      !< When the program began, on the wall clock [s].
      type(observers_t), intent(out) :: observers

      observers%folder = folder
      observers%keep => keep_run
      call observers%add(folder_observer_t())
      if (.not. quiet) call observers%add(progress_observer_t())
      call observers%add(alarms_t())
      call observers%add(cycles_alarm_t())
      call observers%add(ledger_observer_t())
      call observers%add(water_alarm_t())
      call observers%add(table_observer_t())
      call observers%add(field_observer_t())
      call observers%add(summary_observer_t(quiet=quiet, verbose=verbose, started=started))
   end subroutine list_observers
end module run_output
