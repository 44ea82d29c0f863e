!> The word that a run says when it has created energy: its answers may then be wrong by any factor, however well every
!> step has converged.
module energy_alarm
   use, intrinsic :: iso_fortran_env, only: error_unit
   use energy_ledger, only: ledger_t, ALARMING_SHARE
   use generalised_alpha, only: DYNAMIC
   use model_types, only: stage_t
   use texts, only: short
   implicit none (type, external)
   private
   public :: tell_creation
contains
   !> At the end of a dynamic stage, also of one that failed; on standard error, also where the run is quiet.
   subroutine tell_creation(stage, ledger)
      type(stage_t), intent(in) :: stage
      type(ledger_t), intent(in) :: ledger

      if (stage%kind /= DYNAMIC .or. ledger%most_created <= ALARMING_SHARE*ledger%largest_work) return
      write (error_unit, '(a)') 'mud_host: warning: stage '//trim(stage%name)//' has created energy: '// &
         short(ledger%most_created)//' kJ, '//short(100*ledger%most_created/ledger%largest_work)// &
         ' % of the largest work (column imbalance of ledger.csv). Do not trust its answers: shorten dt, or set '// &
         'rho_inf = 0 where a contact opens and closes.'
   end subroutine tell_creation
end module energy_alarm
