! SPDX-License-Identifier: MIT
!> State of a run: everything that one step hands to the next.
module run_state
   use, intrinsic :: iso_fortran_env, only: int64
   use archive, only: archive_t
   use carried_slopes, only: exchange_slopes
   use kinds, only: wp
   use error_norms, only: rate_memory_t, new_memory, exchange_memory
   use linear_system, only: exchange_factors, join_unknowns
   use start_findings, only: tension_t
   use model_types, only: problem_t, term_box_t, gravity_at
   use porous_domain, only: copy_state, exchange_state
   use solution, only: stage_state_t
   use step_control, only: controller_t, exchange_controller
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: run_t, exchange_run, enter_stage, reset_control
   public :: LIMITS, LIMIT_NAMES, BY_TIMES, BY_LARGEST, BY_SMALLEST, BY_GROWTH

   !> Limits that keep a step from being longer: the first three in the order of the fields.
   integer, parameter :: LIMITS = 7, BY_TIMES = 4, BY_LARGEST = 5, BY_SMALLEST = 6, BY_GROWTH = 7
   character(30), parameter :: LIMIT_NAMES(LIMITS) = [character(30) :: 'error of the displacements', 'error of p_w', &
      'error of p_c', 'times that steps end at', 'dt_max', 'smallest step', 'growth of the step']

   !> Control of the time step: its memory from one step to the next, and what it has seen so far.
   type :: control_state_t
      type(controller_t) :: controller
      type(rate_memory_t) :: memory
      real(wp) :: t_sudden = 0.0_wp              !< Time of the last sudden change [s].
      integer :: fresh = 0                       !< Accepted steps since then.
      real(wp) :: start_up = 0.0_wp              !< Span in which changes are expected to grow yet [s].
      integer :: rejected = 0                    !< Steps repeated because of their error, in the whole run.
      real(wp) :: error = 0.0_wp                 !< Error of the last controlled step over the change of its field [-].
      real(wp) :: scale(FIELDS) = 0.0_wp         !< Largest change of the fields in the run [m, kPa].
      real(wp) :: limits(LIMITS) = 0.0_wp        !< Steps by what kept them short.
      logical :: located = .false.               !< The attempt before was repeated to end where a contact closes.
      real(wp), allocatable :: touching(:)       !< 1: the contact was closed at the start of the step, else 0.
      real(wp), allocatable :: x_first(:, :)     !< Unknowns at the start of the stage.
   end type control_state_t

   type, extends(problem_t) :: run_t
      type(term_box_t), allocatable :: terms(:)   !< Terms of the model, with what they keep from step to step.
      type(tension_t) :: tension               !< Tension in the initial state, for a warning.
      type(control_state_t) :: control         !< Control of the time step, in stages that choose it.
      integer :: steps = 0, iterations = 0, cuts = 0
      integer(int64) :: rate_evaluations = 0   !< Rate evaluations of the material.
      logical :: last = .false.                !< The stage ends with the step that was accepted.
      logical :: complete = .false.            !< A stage that ends has come to its end; else a fault has ended the run.
      !> Mean forces of contacts and of the springs of terms over the accepted step [kN]. (unknowns)
      real(wp), allocatable :: mean_force(:)
      real(wp) :: dissipated = 0.0_wp          !< Energy that terms dissipated in the last accepted step [kJ].
      real(wp) :: seconds_output = 0.0_wp      !< Wall time of observers and checkpoints.
      real(wp) :: kept = 0.0_wp                !< When the last checkpoint was written, on the wall clock [s].
   contains
      procedure :: choose
   end type run_t
contains
   !> Lets the terms hold or free unknowns after an iteration of Newton's method.
   subroutine choose(self, residual, changed)
      class(run_t), intent(inout) :: self
      real(wp), intent(in) :: residual(:)
      logical, intent(out) :: changed
      integer :: i

      changed = .false.
      do i = 1, size(self%terms)
         call self%terms(i)%term%choose(self%problem_t, residual, changed)
      end do
   end subroutine choose

   !> Takes a run to a stage, and sets which contacts act in it.
   subroutine enter_stage(run, number)
      type(run_t), intent(inout) :: run
      integer, intent(in) :: number
      integer :: i

      run%at%stage = number
      run%stage => run%model%stages(number)
      if (allocated(run%system%contacts)) call run%system%contacts%act( &
         [(run%model%contacts(i)%in_stage(number), i=1, size(run%model%contacts))])
   end subroutine enter_stage

   !> Sets the control of a run to that of no step; what it has counted goes on.
   pure subroutine reset_control(run)
      type(run_t), intent(inout) :: run
      type(control_state_t) :: control

      control%rejected = run%control%rejected
      control%limits = run%control%limits
      control%memory = new_memory(size(run%state%x, 2), size(run%state%s_rate))
      allocate (control%x_first(FIELDS, size(run%state%x, 2)), source=0.0_wp)
      allocate (control%touching(size(run%model%contacts)), source=0.0_wp)
      run%control = control
   end subroutine reset_control

   !> Exchanges a prepared run with an archive, between two steps. What is restored goes on to the last digit: loads,
   !> supports and the flow that is subtracted follow from the scene, and the ordering of the equations from their
   !> pattern.
   subroutine exchange_run(run, archive)
      type(run_t), intent(inout) :: run
      class(archive_t), intent(inout) :: archive
      integer :: i

      call exchange_stage_state(size(run%model%stages), run%at, archive)
      call archive%exchange('steps', run%steps, '-', 'steps', least=1)
      call archive%exchange('iterations', run%iterations, '-', 'linear solves', least=0)
      call archive%exchange('cuts', run%cuts, '-', 'cuts', least=0)
      call archive%exchange('rate_evaluations', run%rate_evaluations, '-', 'rate evaluations of the material')
      call exchange_state(run%domain, run%state, archive)
      call archive%exchange('largest', run%system%largest, 'kN', 'largest scale of every field')
      do i = 1, size(run%terms)
         call run%terms(i)%term%exchange(run%problem_t, archive)
      end do
      if (archive%reading) call reset_control(run)
      call exchange_control(run%control, archive)
      if (allocated(run%system%contacts)) call exchange_pairs(run%dofs%n, run%system%extra, archive)
      if (archive%reading .and. archive%good) call join_unknowns(run, reshape([integer ::], [2, 0]))
      call exchange_slopes(run%assembly%slopes, archive)
      call exchange_factors(run, archive)
      if (.not. archive%reading .or. .not. archive%good) return
      run%stage => run%model%stages(run%at%stage)
      run%state%gravity = gravity_at(run%model, run%state%time)
      call copy_state(run%state, run%next)
   end subroutine exchange_run

   !> Exchanges a control, made by reset_control, with an archive.
   subroutine exchange_control(control, archive)
      type(control_state_t), intent(inout) :: control
      class(archive_t), intent(inout) :: archive

      call archive%enter('control')
      call exchange_controller(control%controller, archive)
      call exchange_memory(control%memory, archive)
      call archive%exchange('t_sudden', control%t_sudden, 's', 'time of the last sudden change')
      call archive%exchange('fresh', control%fresh, '-', 'accepted steps since then', least=0)
      call archive%exchange('start_up', control%start_up, 's', 'span in which changes are expected to grow yet')
      call archive%exchange('rejected', control%rejected, '-', &
                            'steps repeated because of their error, in the whole run', least=0)
      call archive%exchange('scale', control%scale, 'm, kPa', 'largest change of every field in the run')
      call archive%exchange('limits', control%limits, '-', 'steps by what kept them short')
      call archive%exchange('touching', control%touching, '-', 'whether a contact was closed at the start of the step')
      call archive%exchange('x_first', control%x_first, 'm, kPa', 'unknowns at the start of the stage')
      call archive%leave('control')
   end subroutine exchange_control

   !> Pairs of unknowns that surfaces have brought together: the ordering of the matrix depends on them.
   subroutine exchange_pairs(unknowns, extra, archive)
      integer, intent(in) :: unknowns
      integer, allocatable, intent(inout) :: extra(:, :)   !< (2, pairs)
      class(archive_t), intent(inout) :: archive
      integer, allocatable :: pairs(:)

      pairs = reshape(extra, [size(extra)])
      call archive%exchange_allocatable('pairs', pairs, '-', &
                                        'pairs of unknowns that contacts brought into the matrix')
      if (.not. archive%reading .or. .not. allocated(pairs)) return
      if (any(pairs < 1 .or. pairs > unknowns) .or. mod(size(pairs), 2) /= 0) then
         call archive%refuse()
      else
         extra = reshape(pairs, [2, size(pairs)/2])
      end if
   end subroutine exchange_pairs

   subroutine exchange_stage_state(stages, at, archive)
      integer, intent(in) :: stages
      type(stage_state_t), intent(inout) :: at
      class(archive_t), intent(inout) :: archive

      call archive%enter('stage')
      call archive%exchange('number', at%stage, '-', 'number of the stage', least=1, most=stages)
      call archive%exchange('step', at%step, '-', 'steps done in the stage', least=0)
      call archive%exchange('cuts_in_force', at%cuts, '-', 'cuts in force', least=0)
      call archive%exchange('good', at%good, '-', 'accepted steps since the last cut or growth', least=0)
      call archive%exchange('t_start', at%t_start, 's', 'start of the stage')
      call archive%exchange('nominal', at%nominal, 's', 'step without cuts')
      call archive%exchange('factor', at%factor, '-', 'share of the step without cuts')
      call archive%exchange_allocatable('x_start', at%x_start, 'm, kPa', 'unknowns at the start of the stage')
      call archive%exchange_allocatable('sudden', at%sudden, 'kN', &
         'what acted at once at the start of the stage and is applied evenly over it')
      call archive%leave('stage')
   end subroutine exchange_stage_state
end module run_state
