!> mud_host SCENE.nml: coupled finite elements of unsaturated soil.
program mud_host
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use host_keys, only: print_template
   use host_read, only: read_scene
   use host_run, only: run_t, prepare_run, run_scene
   use host_scene, only: scene_t
   use newton, only: clock
   use triax_fault, only: fault_t, raise, EXIT_INPUT
   use triax_text, only: whole
   implicit none (type, external)
   character(*), parameter :: USAGE = 'usage: mud_host SCENE.nml [--output FOLDER] [--quiet] [--check] | --template'
   character(1024) :: word, file, folder
   type(scene_t) :: scene
   type(run_t) :: run
   type(fault_t) :: fault
   logical :: quiet, only_check
   double precision :: t0
   integer :: i

   file = ''
   folder = ''
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
   if (fault%code == 0 .and. .not. only_check) call run_scene(scene, trim(folder), quiet, run, fault)
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
   end subroutine announce

   !> Where the time went.
   subroutine account()
      write (output_unit, '(a)') whole(run%steps)//' steps, '//whole(run%iterations)//' iterations, '// &
         whole(run%cuts)//' cuts, '//whole(run%system%n_pass)//' passes over the elements.'
      write (output_unit, '(a,5(f9.3,a))') 'Seconds: elements', run%system%seconds(1), ', factorisation', &
         run%system%seconds(2), ', solution', run%system%seconds(3), ', rest of Newton', run%system%seconds(4), &
         ', in all', clock() - t0, '.'
   end subroutine account
end program mud_host
