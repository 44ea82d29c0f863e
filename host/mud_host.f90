! SPDX-License-Identifier: MIT
!> mud_host SCENE.nml: coupled finite elements of unsaturated soil.
program mud_host
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use arguments, only: option_t, read_command_line, option_given, option_value, option_values, WORD_LENGTH
   use checkpoints, only: read_checkpoint
   use contact_alarm, only: contact_alarm_t
   use contact_setup, only: contacts_act
   use initial_conditions, only: balance_t
   use wall_clock, only: clock
   use warnings, only: print_warning, WARNING_LENGTH
   use model_builder, only: build_model
   use model_types, only: model_t
   use process_settings, only: apply_process_settings
   use run_observer, only: observers_t
   use run_output, only: list_observers
   use run_setup, only: prepare_run
   use run_state, only: run_t
   use run_summary, only: announce
   use start_balance, only: find_imbalance
   use scene_keys, only: print_template
   use scene_reader, only: read_scene
   use scene_types, only: scene_t
   use scene_warnings, only: list_warnings
   use time_stepping, only: run_stages
   use files, only: limits_are_errors, folder_of
   use interrupts, only: catch_interrupts
   use faults, only: fault_t, raise, EXIT_INPUT
   use texts, only: short, whole
   implicit none (type, external)
   character(*), parameter :: USAGE = 'usage: mud_host SCENE.nml [options] | --template | --help'
   type(option_t) :: options(11) = [ &
      option_t('--help', letter='-h', answers=.true.), &
      option_t('--template', answers=.true.), &
      option_t('--quiet'), &
      option_t('--verbose'), &
      option_t('--check'), &
      option_t('--output', 'a folder'), &
      option_t('--step-tolerance', 'a share, as 1e-2'), &
      option_t('--accuracy', 'a share, as 1e-2'), &
      option_t('--set', 'a key and its value, as stage.cuts=9'), &
      option_t('--fineness', 'a factor, as 2'), &
      option_t('--restart', 'a checkpoint')]
   character(WORD_LENGTH) :: file
   character(:), allocatable :: folder, restart
   type(scene_t) :: scene
   type(model_t) :: model
   type(run_t) :: run
   type(observers_t) :: observers
   type(contact_alarm_t) :: contacts
   type(fault_t) :: fault
   logical :: quiet, verbose, only_check
   double precision :: t0

   call limits_are_errors()
   call catch_interrupts()
   call apply_process_settings()
   call read_command_line(options, 'scene', USAGE, file, fault)
   if (fault%code == 0 .and. option_given(options, '--template')) then
      call print_template(output_unit)
      stop
   else if (fault%code == 0 .and. option_given(options, '--help')) then
      call print_help()
      stop
   end if
   quiet = option_given(options, '--quiet')
   verbose = option_given(options, '--verbose')
   only_check = option_given(options, '--check')
   restart = option_value(options, '--restart')
   folder = option_value(options, '--output')
   if (folder == '') then
      folder = 'output'
      if (restart /= '') folder = folder_of(restart)
   end if
   if (fault%code == 0 .and. option_given(options, '--accuracy')) call raise(fault, EXIT_INPUT, &
      '--accuracy is no option of a run: --step-tolerance sets the local tolerance of its steps; '// &
      '"mud_study accuracy '// &
      trim(file)//' --accuracy '//option_value(options, '--accuracy')//'" measures the errors of the answers.')
   t0 = clock()
   if (fault%code == 0) call read_scene(trim(file), scene, fault, option_value(options, '--step-tolerance'), &
                                         option_value(options, '--fineness'), option_values(options, '--set'))
   if (fault%code == 0) call build_model(scene, model, fault)
   if (fault%code == 0) call prepare_run(model, run, fault)
   if (fault%code == 0 .and. .not. quiet) call announce(model, run, verbose)
   if (fault%code == 0) call warn_of_scene()
   call list_observers(folder, quiet, verbose, t0, observers)
   if (fault%code == 0 .and. restart /= '') call read_checkpoint(restart, model, run, observers, fault)
   if (fault%code == 0 .and. .not. only_check) then
      call run_stages(model, run, fault, observers)
   else if (fault%code == 0 .and. restart /= '') then
      call check_restart()
   end if
   call leave()
contains
   !> Ends the program.
   subroutine leave()
      ! A main program's variables are not freed at its end; a leak checker would report these two.
      deallocate (folder, restart)
      if (fault%code /= 0) then
         write (error_unit, '(a)') trim(fault%text)
         stop fault%code, quiet=.true.
      end if
      stop, quiet=.true.
   end subroutine leave

   subroutine print_help()
      character(*), parameter :: LINES(15) = [character(105) :: &
         'Solves the boundary-value problem of a scene. Units m, s, kPa, Mg; tension positive.', &
         '  --output FOLDER       folder of the results, made if missing; default: output, with --restart that of', &
         '                        the checkpoint', &
         '  --restart FILE        continues from a checkpoint of the same scene', &
         '  --step-tolerance A    local tolerance of controlled steps, in place of the key step_tolerance of &scene', &
         '  --fineness F          F times the cells of the mesh along each axis, in place of the key fineness of', &
         '                        &mesh', &
         '  --set GROUP.KEY=VALUE sets a key of the scene, in place of its value; may be repeated. A list is', &
         '                        divided by commas. Of groups that occur several times fix[2].value=1 sets the', &
         '                        second, elastic[soil].young=2e4 the one with this name, stage.cuts=9 all', &
         '  --check               reads and checks scene and checkpoint, runs nothing', &
         '  --quiet               prints errors and warnings only', &
         '  --verbose             prints memory, times of the parts of the run and counters as well', &
         '  --template            prints every group and key of a scene', &
         'What steps and mesh err by is not known to a run: "mud_study accuracy SCENE" measures it.']
      integer :: k

      write (output_unit, '(a)') USAGE, (trim(LINES(k)), k=1, size(LINES))
      write (output_unit, '(a)') 'Exit codes: host/OUTPUT.md, "Exit codes".'
   end subroutine print_help

   !> Whether the run could go on from the checkpoint, in its folder.
   subroutine check_restart()
      call observers%check_fit(model, run, fault)
      if (fault%code /= 0 .or. quiet) return
      write (output_unit, '(a)') restart//' fits: stage '//trim(model%stages(run%at%stage)%name)// &
         ', step '//whole(run%at%step)//', time '//short(run%state%time)// &
         ' s; the run would go on in '//folder//'.'
   end subroutine check_restart

   subroutine warn_of_scene()
      character(WARNING_LENGTH), allocatable :: doubts(:)
      type(balance_t) :: balance
      integer :: i

      call find_imbalance(model, run, balance)
      if (.not. quiet .and. balance%known) write (output_unit, '(a)') 'Start: at most '//short(balance%stress)// &
         ' kPa without balance, at ('//short(balance%x(1))//', '//short(balance%x(2))//') m; the stress there is '// &
         short(balance%there)//' kPa.'
      call list_warnings(scene, model, run%tension, balance, doubts)
      do i = 1, size(doubts)
         call print_warning(doubts(i))
      end do
      if (.not. only_check) return
      ! A run says it where the stage begins.
      call contacts_act(model, model%stages(1), run%system%contacts)
      call contacts%stage_begins(model, run, 1)
   end subroutine warn_of_scene
end program mud_host
