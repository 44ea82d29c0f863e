!> mud_host SCENE.nml: coupled finite elements of unsaturated soil.
program mud_host
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit, int64
   use host_clock, only: clock
   use host_effects_table, only: print_effects
   use host_keys, only: print_template
   use host_process, only: settle_process
   use host_read, only: read_scene
   use host_run, only: run_t, prepare_run, run_scene
   use host_scene, only: scene_t
   use io_files, only: limits_are_errors
   use triax_fault, only: fault_t, raise, EXIT_INPUT
   use triax_text, only: whole
   implicit none (type, external)
   character(*), parameter :: USAGE = 'usage: mud_host SCENE.nml [--output FOLDER] [--restart CHECKPOINT] '// &
                              '[--quiet] [--check] | --template'
   character(1024) :: word, file, folder, restart
   type(scene_t) :: scene
   type(run_t) :: run
   type(fault_t) :: fault
   logical :: quiet, only_check
   double precision :: t0
   integer :: i

   call limits_are_errors()
   call settle_process()
   file = ''
   folder = ''
   restart = ''
   quiet = .false.
   only_check = .false.
   i = 1
   do while (i <= command_argument_count())
      call get_command_argument(i, word)
      select case (word)
      case ('--template')
         call print_template(output_unit)
         stop
      case ('--help', '-h')
         write (output_unit, '(a)') USAGE
         stop
      case ('--quiet')
         quiet = .true.
      case ('--check')
         only_check = .true.
      case ('--output')
         i = i + 1
         call get_command_argument(i, folder)
         if (folder == '') call raise(fault, EXIT_INPUT, '--output needs a folder; '//USAGE)
      case ('--restart')
         i = i + 1
         call get_command_argument(i, restart)
         if (restart == '') call raise(fault, EXIT_INPUT, '--restart needs a checkpoint; '//USAGE)
      case default
         if (word(1:1) == '-' .or. file /= '') call raise(fault, EXIT_INPUT, trim(word)//' is not understood; '//USAGE)
         file = word
      end select
      i = i + 1
   end do
   if (file == '' .and. fault%code == 0) call raise(fault, EXIT_INPUT, 'No scene is given; '//USAGE)
   if (folder == '') folder = 'output'
   t0 = clock()
   if (fault%code == 0) call read_scene(trim(file), scene, fault)
   if (fault%code == 0) call prepare_run(scene, run, fault)
   if (fault%code == 0 .and. .not. quiet) call announce()
   if (fault%code == 0 .and. .not. only_check) then
      if (restart == '') then
         call run_scene(scene, trim(folder), quiet, run, fault)
      else
         call run_scene(scene, trim(folder), quiet, run, fault, trim(restart))
      end if
   end if
   if (.not. quiet .and. run%steps > 0) call account()
   if (fault%code /= 0) then
      write (error_unit, '(a)') trim(fault%text)
      stop fault%code, quiet=.true.
   end if
contains
   subroutine announce()
      write (output_unit, '(a)') trim(scene%name)//': '//whole(size(scene%model%mesh%t6, 2))//' elements, '// &
         whole(size(scene%model%mesh%x, 2))//' nodes, '//whole(run%dofs%n)//' unknowns, '// &
         whole(size(run%pattern%col))//' entries, '//whole(scene%model%threads)//' threads.'
      if (scene%effects%auto) call print_effects(output_unit, run%watch%table)
   end subroutine announce

   !> Where the time went.
   subroutine account()
      character(14), parameter :: PHASES(8) = [character(14) :: 'material', 'assembly', 'contact', 'factorisation', &
                                               'solution', 'rest of Newton', 'output', 'all else']
      double precision :: seconds(8), total
      integer :: k

      total = clock() - t0
      seconds(:7) = [run%system%seconds([5, 1, 6, 2, 3, 4]), run%seconds_output]
      seconds(8) = total - sum(seconds(:7))
      write (output_unit, '(a)') whole(run%steps)//' steps, '//whole(run%iterations)//' iterations, '// &
         whole(run%cuts)//' cuts, '//whole(run%effort)//' rate evaluations of the material; in this run '// &
         whole(run%system%n_pass)//' passes over the elements, '//whole(run%system%sparse%n_numeric)// &
         ' factorisations ('//whole(nint(run%system%sparse%entries, int64))//' entries), '// &
         whole(run%system%sparse%n_solve)//' solutions by factors.'
      do k = 1, size(PHASES)
         write (output_unit, '(3x,a,f12.3,a,f6.1,a)') PHASES(k), seconds(k), ' s', 100*seconds(k)/total, ' %'
      end do
      write (output_unit, '(3x,a,f12.3,a)') 'in all        ', total, ' s'
   end subroutine account
end program mud_host
