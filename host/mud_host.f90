! SPDX-License-Identifier: MIT
!> mud_host SCENE.nml: coupled finite elements of unsaturated soil.
program mud_host
   use, intrinsic :: iso_fortran_env, only: error_unit
   use checkpoints, only: read_checkpoint
   use faults, only: fault_t
   use host_options, only: options_t, read_options
   use model_builder, only: build_model
   use model_types, only: model_t
   use process_settings, only: apply_process_settings
   use run_observer, only: observers_t
   use run_output, only: list_observers
   use run_setup, only: prepare_run
   use run_state, only: run_t
   use scene_reader, only: read_scene
   use scene_types, only: scene_t
   use start_report, only: report_start, report_restart
   use time_stepping, only: run_stages
   use wall_clock, only: clock
   implicit none (type, external)
   type(options_t) :: options
   type(scene_t) :: scene
   type(model_t), target :: model
   type(run_t) :: run
   type(observers_t) :: observers
   type(fault_t) :: fault
   double precision :: started

   call apply_process_settings()
   call read_options(options, fault)
   started = clock()
   if (fault%code == 0) call read_scene(options%scene, scene, fault, options%set)
   if (fault%code == 0) call build_model(scene, model, fault)
   if (fault%code == 0) call prepare_run(model, run, fault)
   if (fault%code == 0) call report_start(scene, run, options%quiet, options%verbose, options%only_check)
   if (fault%code == 0) call list_observers(options%folder, options%quiet, options%verbose, started, observers)
   if (fault%code == 0 .and. options%restart /= '') call read_checkpoint(options%restart, run, observers, fault)
   if (fault%code == 0 .and. options%only_check) then
      call report_restart(run, observers, options%restart, options%folder, options%quiet, fault)
   else if (fault%code == 0) then
      call run_stages(run, observers, fault)
   end if
   call leave()
contains
   !> Ends the program with the exit code of its fault.
   subroutine leave()
      ! A main program's variables are not freed at its end; a leak checker would report these.
      options = options_t()
      if (fault%code /= 0) then
         write (error_unit, '(a)') trim(fault%text)
         stop fault%code, quiet=.true.
      end if
      stop, quiet=.true.
   end subroutine leave
end program mud_host
