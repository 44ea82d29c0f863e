! SPDX-License-Identifier: MIT
!> Ends a run that has created energy: its results may then be wrong by any factor, although every step has
!> converged. docs/theory/host.md section 9.
module energy_alarm
   use warnings, only: print_warning
   use kinds, only: wp
   use energy_ledger, only: ledger_t, allowed_creation, ALARMING_SHARE
   use exit_codes, only: EXIT_ENERGY
   use faults, only: fault_t, raise
   use generalised_alpha, only: DYNAMIC
   use texts, only: short
   use scene_types, only: stage_t
   implicit none (type, external)
   private
   public :: check_creation, warn_of_created_energy

   character(*), parameter :: REMEDY = 'shorten dt, set rho_inf = 0 where a contact opens and closes, or '// &
      'measure = ''change'' where weight rests'
   !> Steps in which the work of a load that has just begun exceeds by far that of its first step: it grows with the
   !> third power of their number and faster.
   real(wp), parameter :: PATIENCE = 5.0_wp
contains
   !> After every booked step: a fault where a dynamic stage has created more than it may, in PATIENCE steps in a row or
   !> in its last one. Fault EXIT_ENERGY. docs/theory/host.md section 9.
   subroutine check_creation(stage, time, is_last, ledger, fault)
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: time   !< At the end of the step [s].
      logical, intent(in) :: is_last   !< The step is the last of the stage.
      type(ledger_t), intent(in) :: ledger
      type(fault_t), intent(inout) :: fault

      if (stage%kind /= DYNAMIC .or. fault%code /= 0) return
      if (ledger%overdue < merge(1.0_wp, PATIENCE, is_last)) return
      call raise(fault, EXIT_ENERGY, 'Stage '//trim(stage%name)//', time '//short(time)//' s: the run has created '// &
                 amount(ledger)//', allowed '//short(100*stage%created_energy)//' %. Its results may be wrong by '// &
                 'any factor: '//REMEDY//'; created_energy of &stage allows more.')
   end subroutine check_creation

   !> At the end of a dynamic stage that may create much: the warning, on standard error, also where the run is quiet.
   !> From ALARMING_SHARE of the largest work on; nothing beyond what check_creation refuses.
   subroutine warn_of_created_energy(stage, ledger)
      type(stage_t), intent(in) :: stage
      type(ledger_t), intent(in) :: ledger

      if (stage%kind /= DYNAMIC .or. ledger%most_created <= allowed_creation(ALARMING_SHARE, ledger)) return
      if (ledger%most_created > allowed_creation(stage%created_energy, ledger)) return
      call print_warning('stage '//trim(stage%name)//' has created '//amount(ledger)// &
         '. Do not use its results: '//REMEDY//'.')
   end subroutine warn_of_created_energy

   !> Energy in kJ and as a share.
   function amount(ledger) result(text)
      type(ledger_t), intent(in) :: ledger
      character(:), allocatable :: text

      text = short(ledger%most_created)//' kJ of energy, '//short(100*ledger%most_created/max(ledger%largest_work, &
             tiny(1.0_wp)))//' % of the largest work (column imbalance of ledger.csv)'
   end function amount
end module energy_alarm
