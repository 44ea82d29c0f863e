! SPDX-License-Identifier: MIT
!> mud_host SCENE.nml: coupled finite elements of unsaturated soil.
program mud_host
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit, int64
   use arguments, only: option_t, read_command_line, option_given, option_value, option_values, WORD_LENGTH
   use checkpoints, only: read_checkpoint
   use contact_alarm, only: warn_of_overlap
   use contact_setup, only: contacts_act
   use initial_conditions, only: balance_t
   use wall_clock, only: clock
   use warnings, only: print_warning, WARNING_LENGTH
   use generalised_alpha, only: STATIC, DYNAMIC
   use model_builder, only: build_model
   use model_types, only: model_t
   use linear_system, only: T_MATERIAL, T_ASSEMBLY, T_CONTACT, T_FACTORISATION, T_SOLUTION, T_REST
   use output_tables, only: check_tables
   use process_settings, only: apply_process_settings
   use run_output, only: run_output_t
   use run_setup, only: prepare_run
   use run_size, only: size_of_run
   use run_state, only: run_t
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
   type(run_output_t) :: output
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
   if (fault%code == 0 .and. .not. quiet) call announce()
   if (fault%code == 0) call warn_of_scene()
   if (fault%code == 0 .and. only_check .and. restart /= '') then
      call check_restart()
   else if (fault%code == 0 .and. .not. only_check) then
      output%folder = folder
      output%quiet = quiet
      output%resume = restart /= ''
      if (output%resume) call read_checkpoint(restart, model, run, output%tables, fault)
      if (fault%code == 0) call run_stages(model, run, fault, output)
   end if
   if (verbose .and. run%steps > 0) call account()
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
      call read_checkpoint(restart, model, run, output%tables, fault)
      if (fault%code == 0) call check_tables(folder, model, output%tables, fault)
      if (fault%code /= 0 .or. quiet) return
      write (output_unit, '(a)') restart//' fits: stage '//trim(model%stages(run%at%stage)%name)// &
         ', step '//whole(run%at%step)//', time '//short(run%state%time)// &
         ' s; the run would go on in '//folder//'.'
   end subroutine check_restart

   subroutine announce()
      integer :: i

      write (output_unit, '(a)') trim(model%name)//': '//whole(size(model%domain%mesh%t6, 2))//' elements, '// &
         whole(size(model%domain%mesh%x, 2))//' nodes, '//whole(model%dofs%n)//' unknowns, '// &
         whole(size(run%pattern%col))//' entries, '//whole(model%domain%threads)//' threads.'
      if (verbose) write (output_unit, '(a)') size_of_run(model, run)
      do i = 1, size(model%stages)
         if (model%stages(i)%kind /= STATIC) write (output_unit, '(a)') 'Stage '//trim(model%stages(i)%name)//': '// &
            trim(merge('dynamic     ', 'quasi_static', model%stages(i)%kind == DYNAMIC))//', rho_inf '// &
            short(model%stages(i)%rho_inf)//'.'
         if (model%stages(i)%controlled) write (output_unit, '(a)') 'Stage '//trim(model%stages(i)%name)// &
            ': steps are controlled, tolerance '//short(model%stages(i)%step_tolerance)//'.'
      end do
   end subroutine announce

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
      call warn_of_overlap(model, 1, run%system%contacts, run%state%x)
   end subroutine warn_of_scene

   !> Time that each part of the run took.
   subroutine account()
      character(14), parameter :: PHASES(8) = [character(14) :: 'material', 'assembly', 'contact', 'factorisation', &
                                               'solution', 'rest of Newton', 'output', 'all else']
      double precision :: seconds(8), total
      integer :: k

      total = clock() - t0
      seconds(:7) = [run%system%seconds([T_MATERIAL, T_ASSEMBLY, T_CONTACT, T_FACTORISATION, T_SOLUTION, T_REST]), &
                     run%seconds_output]
      seconds(8) = total - sum(seconds(:7))
      write (output_unit, '(a)') whole(run%steps)//' steps, '//whole(run%iterations)//' iterations, '// &
         whole(run%cuts)//' cuts, '//whole(run%rate_evaluations)//' rate evaluations of the material; in this run '// &
         whole(run%system%n_pass)//' passes over the elements, '//whole(run%system%sparse%n_numeric)// &
         ' factorisations ('//whole(nint(run%system%sparse%entries, int64))//' entries), '// &
         whole(run%system%sparse%n_solve)//' solutions by factors.'
      write (output_unit, '(a)') size_of_run(model, run)
      do k = 1, size(PHASES)
         write (output_unit, '(3x,a,f12.3,a,f6.1,a)') PHASES(k), seconds(k), ' s', 100*seconds(k)/total, ' %'
      end do
      write (output_unit, '(3x,a,f12.3,a)') 'in all        ', total, ' s'
   end subroutine account
end program mud_host
