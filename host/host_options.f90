! SPDX-License-Identifier: MIT
!> Options of mud_host: what the command line asks of a run.
module host_options
   use, intrinsic :: iso_fortran_env, only: output_unit
   use arguments, only: option_t, read_command_line, option_given, option_value, option_values, WORD_LENGTH
   use faults, only: fault_t, raise, EXIT_INPUT
   use files, only: folder_of
   use scene_keys, only: print_template
   use texts, only: shell_word
   implicit none (type, external)
   private
   public :: options_t, read_options

   character(*), parameter :: USAGE = 'usage: mud_host SCENE.nml [options] | --template | --help'

   type :: options_t
      character(:), allocatable :: scene             !< File of the scene.
      character(:), allocatable :: folder            !< Folder of the results.
      character(:), allocatable :: restart           !< Checkpoint to go on from; blank: none.
      character(WORD_LENGTH), allocatable :: set(:)  !< Keys and their values in place of those of the scene.
      logical :: quiet = .false.                     !< Errors and warnings only are printed.
      logical :: verbose = .false.                   !< Memory, times and counters of the run are printed.
      logical :: only_check = .false.                !< Nothing is run.
   end type options_t
contains
   !> Reads the command line; one that only asks for a text gets it, and the program ends. Fault EXIT_INPUT: a mistake
   !> in the command line.
   subroutine read_options(options, fault)
      type(options_t), intent(out) :: options
      type(fault_t), intent(inout) :: fault
      type(option_t) :: words(11) = [ &
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
      character(WORD_LENGTH) :: scene

      call read_command_line(words, 'scene', USAGE, scene, fault)
      if (fault%code /= 0) return
      if (option_given(words, '--template')) then
         call print_template(output_unit)
         stop
      else if (option_given(words, '--help')) then
         call print_help()
         stop
      else if (option_given(words, '--accuracy')) then
         call raise(fault, EXIT_INPUT, '--accuracy is no option of a run: --step-tolerance sets the local '// &
                    'tolerance of its steps; "mud_study accuracy '//shell_word(scene)//' --accuracy '// &
                    option_value(words, '--accuracy')//'" measures the errors of the answers.')
         return
      end if
      options%scene = trim(scene)
      options%restart = option_value(words, '--restart')
      options%folder = option_value(words, '--output')
      if (options%folder == '') then
         options%folder = 'output'
         if (options%restart /= '') options%folder = folder_of(options%restart)
      end if
      options%set = option_values(words, '--set')
      call set('scene.step_tolerance', option_value(words, '--step-tolerance'))
      call set('mesh.fineness', option_value(words, '--fineness'))
      options%quiet = option_given(words, '--quiet')
      options%verbose = option_given(words, '--verbose')
      options%only_check = option_given(words, '--check')
   contains
      subroutine set(key, value)
         character(*), intent(in) :: key, value   !< No value: the key stays.

         if (value /= '') options%set = [character(WORD_LENGTH) :: options%set, key//'='//value]
      end subroutine set
   end subroutine read_options

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
end module host_options
