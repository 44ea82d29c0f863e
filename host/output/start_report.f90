! SPDX-License-Identifier: MIT
!> Sentences before a run begins: its size and stages, how far its start is from balance, what of the scene may
!> not be meant, and where a checkpoint would take it up.
module start_report
   use, intrinsic :: iso_fortran_env, only: output_unit
   use contact_alarm, only: warn_of_overlaps
   use faults, only: fault_t
   use start_findings, only: balance_t
   use run_cost, only: size_of_run
   use run_observer, only: observers_t, FITS
   use run_state, only: run_t, enter_stage
   use scene_types, only: scene_t
   use scene_warnings, only: warn_of_scene
   use start_balance, only: find_imbalance
   use texts, only: place_text, short, whole
   implicit none (type, external)
   private
   public :: report_start, report_restart
contains
   !> Says what is going to run, and warns of the scene, which a quiet run does as well. `only_check`: nothing runs, and
   !> the overlaps that a run tells where its first stage begins are told here.
   subroutine report_start(scene, run, quiet, verbose, only_check)
      type(scene_t), intent(in) :: scene
      type(run_t), intent(inout) :: run   !< The contacts are probed.
      logical, intent(in) :: quiet, verbose, only_check
      type(balance_t) :: balance

      if (.not. quiet) call announce(run, verbose)
      call find_imbalance(run, balance)
      if (.not. quiet .and. balance%known) write (output_unit, '(a)') 'Start: at most '//short(balance%stress)// &
         ' kPa without balance, at '//place_text(balance%x)//'; the stress there is '//short(balance%there)//' kPa.'
      call warn_of_scene(scene, run%model, run%tension, balance)
      if (.not. only_check) return
      call enter_stage(run, 1)
      call warn_of_overlaps(run)
   end subroutine report_start

   !> Says what is going to run.
   subroutine announce(run, verbose)
      type(run_t), intent(in) :: run
      logical, intent(in) :: verbose   !< With its memory.
      integer :: i

      associate (mesh => run%domain%mesh)
         write (output_unit, '(a)') trim(run%model%origin%name)//': '//whole(size(mesh%t6, 2))//' elements, '// &
            whole(size(mesh%x, 2))//' nodes, '//whole(run%dofs%n)//' unknowns, '// &
            whole(size(run%pattern%col))//' entries, '//whole(run%domain%threads)//' threads.'
      end associate
      if (verbose) write (output_unit, '(a)') size_of_run(run)
      do i = 1, size(run%model%stages)
         associate (stage => run%model%stages(i))
            if (stage%has_rates) write (output_unit, '(a)') 'Stage '//trim(stage%name)//': '// &
               trim(merge('dynamic     ', 'quasi_static', stage%has_inertia))//', rho_inf '// &
               short(stage%rho_inf)//'.'
            if (stage%controlled) write (output_unit, '(a)') 'Stage '//trim(stage%name)// &
               ': steps are controlled, tolerance '//short(stage%step_tolerance)//'.'
         end associate
      end do
   end subroutine announce

   !> Says where a run would go on that a checkpoint has put in place. Faults: those of observers whose files do not
   !> fit.
   subroutine report_restart(run, observers, restart, folder, quiet, fault)
      type(run_t), intent(inout) :: run
      type(observers_t), intent(inout) :: observers
      character(*), intent(in) :: restart, folder   !< Path of the checkpoint, empty: none; folder of the results.
      logical, intent(in) :: quiet
      type(fault_t), intent(inout) :: fault

      if (restart == '') return
      call observers%tell(FITS, run, fault)
      if (fault%code /= 0 .or. quiet) return
      write (output_unit, '(a)') restart//' fits: stage '//trim(run%stage%name)// &
         ', step '//whole(run%at%step)//', time '//short(run%state%time)// &
         ' s; the run would go on in '//folder//'.'
   end subroutine report_restart
end module start_report
