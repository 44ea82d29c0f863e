! SPDX-License-Identifier: MIT
!> mud_host SCENE.nml: coupled finite elements of unsaturated soil.
program mud_host
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit, int64
   use arguments, only: option_t, read_command_line, option_given, option_value, WORD_LENGTH
   use answer_verification, only: history_t, read_history, differences
   use answer_errors, only: worst_unknown, write_answers, print_answers, judge_answers
   use changed_scenes, only: read_changed
   use checkpoints, only: read_checkpoint
   use initial_conditions, only: balance_t
   use kinds, only: wp
   use wall_clock, only: clock
   use warnings, only: print_warning
   use generalised_alpha, only: STATIC, DYNAMIC
   use effect_pilots, only: ask_effects, reduce_scene, apply_effects
   use effect_types, only: effect_t
   use effects_table, only: print_effects, print_pilots, write_effects, write_influences
   use level_output, only: level_output_t, folder_of_mesh
   use level_runs, only: level_run_t
   use level_store, only: read_levels
   use mesh_levels, only: refine_until
   use model_builder, only: build_model
   use model_types, only: accuracy_of, model_t
   use linear_system, only: T_MATERIAL, T_ASSEMBLY, T_CONTACT, T_FACTORISATION, T_SOLUTION, T_REST
   use output_tables, only: check_tables, COLUMNS_OF_A_POINT
   use pilot_budget, only: pilots_account_t
   use price_estimates, only: answer_t
   use price_table, only: print_price, print_errors, write_price
   use process_settings, only: apply_process_settings
   use run_output, only: run_output_t
   use run_setup, only: prepare_run
   use run_size, only: size_of_run
   use run_state, only: run_t
   use start_balance, only: find_imbalance
   use scene_keys, only: print_template
   use scene_price, only: family_t, price_t, price_scene, find_family
   use scene_reader, only: read_scene
   use scene_types, only: scene_t
   use scene_warnings, only: list_warnings
   use idle_keys, only: WARNING_LENGTH
   use time_stepping, only: run_stages
   use unknown_fields, only: DISPLACEMENTS
   use files, only: limits_are_errors, folder_of, make_folder
   use force_answers, only: force_answer_t, list_forces, measure_forces
   use faults, only: fault_t, raise, EXIT_INPUT
   use texts, only: short, whole
   implicit none (type, external)
   character(*), parameter :: USAGE = 'usage: mud_host SCENE.nml [options] | --template | --help'
   type(option_t) :: options(12) = [ &
      option_t('--help', letter='-h', answers=.true.), &
      option_t('--template', answers=.true.), &
      option_t('--quiet'), &
      option_t('--check'), &
      option_t('--output', 'a folder'), &
      option_t('--verify'), &
      option_t('--effects'), &
      option_t('--ablate'), &
      option_t('--price'), &
      option_t('--accuracy', 'a share, as 1e-2'), &
      option_t('--fineness', 'a factor, as 2'), &
      option_t('--restart', 'a checkpoint')]
   character(WORD_LENGTH) :: file
   character(:), allocatable :: folder, restart
   type(scene_t) :: scene
   type(model_t) :: model
   type(run_t) :: run
   type(run_output_t) :: output
   type(fault_t) :: fault
   type(pilots_account_t) :: pilots
   type(effect_t), allocatable :: effects(:)
   type(force_answer_t), allocatable :: forces(:)
   logical :: quiet, only_check, only_effects
   real(wp), parameter :: QUARTER_SHARE = 0.25_wp
   double precision :: t0

   call limits_are_errors()
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
   only_check = option_given(options, '--check')
   only_effects = option_given(options, '--effects') .or. option_given(options, '--ablate')
   restart = option_value(options, '--restart')
   folder = option_value(options, '--output')
   if (folder == '') then
      folder = 'output'
      if (restart /= '') folder = folder_of(restart)
   end if
   if (fault%code == 0 .and. option_given(options, '--verify') .and. restart /= '') call raise(fault, EXIT_INPUT, &
      '--verify repeats a whole run: leave --restart out.')
   t0 = clock()
   if (fault%code == 0) call read_scene(trim(file), scene, fault, option_value(options, '--accuracy'), &
                                         option_value(options, '--fineness'))
   if (fault%code == 0 .and. scene%refined .and. option_given(options, '--verify')) call raise(fault, EXIT_INPUT, &
      '--verify measures the error of the steps of one mesh; mesh = ''auto'' measures it itself: leave --verify out.')
   if (fault%code == 0) call find_effects()
   if (only_effects) call leave()
   if (fault%code == 0) call build_model(scene, model, fault)
   if (fault%code == 0) call prepare_run(model, run, fault)
   if (fault%code == 0 .and. .not. quiet) call announce()
   if (fault%code == 0) call warn_of_scene()
   if (option_given(options, '--price') .and. .not. only_check) then
      if (fault%code == 0) call find_price()
      call leave()
   end if
   if (scene%refined .and. .not. only_check) then
      if (fault%code == 0) call refine()
      call leave()
   end if
   if (fault%code == 0 .and. only_check .and. restart /= '') then
      call check_restart()
   else if (fault%code == 0 .and. .not. only_check) then
      output%folder = folder
      output%quiet = quiet
      output%resume = restart /= ''
      if (output%resume) call read_checkpoint(restart, model, run, output%tables, fault)
      if (fault%code == 0) call run_stages(model, run, fault, output)
      if (fault%code == 0 .and. allocated(run%control%x_first)) then
         call list_forces(folder, model, worst_unknown(model, run%control), &
                          maxval(run%assembly%scale, mask=model%dofs%field <= DISPLACEMENTS), forces, fault)
         if (fault%code == 0 .and. option_given(options, '--verify')) call verify()
         if (fault%code == 0) call write_answers(folder, model, run%control, forces, &
                                                  [answer_t ::], fault)
         if (fault%code == 0 .and. .not. quiet) call print_answers(output_unit, model, run%control, &
                                                                   option_given(options, '--verify'), forces)
         if (fault%code == 0) call judge_answers(model, run%control, option_given(options, '--verify'), forces, fault)
      end if
   end if
   if (.not. (quiet .or. only_check) .and. run%steps > 0) call account()
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

   !> Determines which effects the scene needs, where the scene leaves that open or the command line asks for it, and
   !> sets its keys.
   subroutine find_effects()
      if (only_effects .or. (scene%derive_effects .and. .not. only_check)) then
         call ask_effects(scene, option_given(options, '--ablate'), &
                          merge(huge(1.0d0), scene%effects_pilot_share, only_effects), quiet, effects, pilots, fault)
         if (fault%code /= 0) return
         if (.not. quiet) call print_pilots(output_unit, pilots)
         if (.not. quiet .or. only_effects) call print_effects(output_unit, effects, scene%derive_effects)
         if (only_effects) call make_folder(folder)
         if (only_effects) call write_effects(folder, effects, fault)
         if (only_effects) call write_influences(folder, effects, pilots, fault)
      end if
      call reduce_scene(scene, fault)
      if (only_effects .or. .not. allocated(effects) .or. fault%code /= 0) return
      scene%effects = effects
      call apply_effects(effects, scene)
   end subroutine find_effects

   !> What accuracy costs: runs of coarser meshes, and what follows from them for others.
   subroutine find_price()
      type(price_t) :: price

      call price_scene(trim(file), accuracy_of(model), effects, quiet, price, fault)
      if (fault%code /= 0) return
      call print_price(output_unit, price)
      call make_folder(folder)
      call write_price(folder, price, fault)
   end subroutine find_price

   !> Finer and finer meshes until the total error is what the scene asks for.
   subroutine refine()
      type(family_t) :: family
      type(level_output_t) :: runner
      type(price_t) :: price
      integer :: n

      if (restart /= '') call read_levels(restart, scene%fingerprint, price%made, fault)
      if (fault%code == 0) call find_family(trim(file), accuracy_of(model), effects, quiet, family, fault)
      if (fault%code /= 0) return
      runner%folder = folder
      runner%quiet = quiet
      runner%fingerprint = scene%fingerprint
      call refine_until(family, scene%accuracy, scene%budget, runner, price, fault)
      n = 0
      if (allocated(price%levels)) n = size(price%levels)
      if (quiet .or. n == 0 .or. .not. allocated(price%answers)) return
      call print_errors(output_unit, price)
      write (output_unit, '(a)') 'In these errors: mesh, steps, Newton''s method; not the stress integration. '// &
         'Results: '//folder_of_mesh(folder, n)//'; the meshes: '//folder//'/levels.csv. '// &
         whole(price%runs)//' runs, '//short(clock() - t0)//' s.'
   end subroutine refine

   subroutine print_help()
      character(*), parameter :: LINES(22) = [character(104) :: &
         'Solves the boundary-value problem of a scene. Units m, s, kPa, Mg; tension positive.', &
         '  --output FOLDER       folder of the results, made if missing; default: output, with --restart that of', &
         '                        the checkpoint', &
         '  --restart FILE        continues from a checkpoint of the same scene; with mesh = ''auto'' from its', &
         '                        levels.h5', &
         '  --accuracy A          relative error wanted in the histories of the points; in place of the key', &
         '                        accuracy of &scene', &
         '  --fineness F          F times the cells of the mesh along each axis, in place of the key fineness of', &
         '                        &mesh; one mesh, also where the scene says mesh = ''auto'' (which refines until', &
         '                        accuracy holds for the total error)', &
         '  --verify              repeats the run at a quarter of the accuracy, given steps a quarter as long, and', &
         '                        reports the difference as the error of points and forces; not with --restart', &
         '  --effects             runs coarse pilots of the scene, with every effect and without each; prints', &
         '                        what each changes in the results, writes effects.csv, and ends', &
         '  --ablate              the same with the full scene instead of pilots, and also with each effect', &
         '                        that the scene does not have', &
         '  --price               runs the scene on coarser meshes; prints what accuracy costs, the error of the', &
         '                        mesh included: error and time of meshes and accuracies, the cheapest way to', &
         '                        10, 3 and 1 %; writes price.csv and price_answers.csv, and ends', &
         '  --check               reads and checks scene and checkpoint, runs nothing', &
         '  --quiet               prints errors and warnings only', &
         '  --template            prints every group and key of a scene']
      integer :: k

      write (output_unit, '(a)') USAGE, (trim(LINES(k)), k=1, size(LINES))
      write (output_unit, '(a)') 'Exit code 20: an answer misses the accuracy asked for more than three times, or'
      write (output_unit, '(a)') 'with mesh = ''auto'' at all; results are written.', &
         'Exit codes: host/README.md, "Exit codes".'
   end subroutine print_help

   !> Whether the run could go on from the checkpoint, in its folder.
   subroutine check_restart()
      type(level_run_t), allocatable :: runs(:)

      if (scene%refined) then
         call read_levels(restart, scene%fingerprint, runs, fault)
         if (fault%code == 0 .and. .not. quiet) write (output_unit, '(a)') restart//' fits: '//whole(size(runs))// &
            ' runs; those that are missing would be made in '//folder//'.'
         return
      end if
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
      write (output_unit, '(a)') size_of_run(model, run)
      do i = 1, size(model%stages)
         if (model%stages(i)%kind /= STATIC) write (output_unit, '(a)') 'Stage '//trim(model%stages(i)%name)//': '// &
            trim(merge('dynamic     ', 'quasi_static', model%stages(i)%kind == DYNAMIC))//', rho_inf '// &
            short(model%stages(i)%rho_inf)//'.'
         if (model%stages(i)%controlled) write (output_unit, '(a)') 'Stage '//trim(model%stages(i)%name)// &
            ': steps are controlled by their error, accuracy '//short(100*model%stages(i)%accuracy)//' %.'
      end do
      if (scene%refined) write (output_unit, '(a)') 'mesh = ''auto'': finer meshes are run until the total error '// &
         'is '//short(100*scene%accuracy)//' %; the numbers above are of the mesh as it stands.'
      if (scene%derive_effects .and. only_check) write (output_unit, '(a)') 'effects = ''auto'': pilots find out '// &
         'what the keys leave open when the run begins; --effects shows it without a run.'
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
   end subroutine warn_of_scene

   !> The run again at a quarter of the accuracy, given steps a quarter as long, in a folder of its own: the difference
   !> takes the estimate's place.
   subroutine verify()
      type(scene_t) :: fine_scene
      type(model_t) :: fine_model
      type(run_t) :: fine_run
      type(run_output_t) :: fine_output
      type(history_t) :: one, two

      call read_changed(trim(file), accuracy_of(model), QUARTER_SHARE, scene%mesh%fineness, effects, fine_scene, fault)
      if (fault%code == 0) call build_model(fine_scene, fine_model, fault)
      if (fault%code == 0) call prepare_run(fine_model, fine_run, fault)
      if (fault%code /= 0) return
      fine_output%folder = folder//'/verify'
      fine_output%quiet = .true.
      call run_stages(fine_model, fine_run, fault, fine_output)
      if (fault%code == 0) call read_history(folder, size(model%points), COLUMNS_OF_A_POINT, one, fault)
      if (fault%code == 0) call read_history(folder//'/verify', size(model%points), COLUMNS_OF_A_POINT, two, fault)
      if (fault%code == 0) run%control%point_largest = differences(one, two)
      if (fault%code == 0) call measure_forces(folder, folder//'/verify', model, forces, fault)
   end subroutine verify

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
      if (pilots%runs > 0) write (output_unit, '(3x,a)') 'of these '//short(pilots%seconds)//' s for pilots, '// &
         short(100*pilots%seconds/max(total - pilots%seconds, tiny(1.0d0)))//' % of the rest.'
   end subroutine account
end program mud_host
