! SPDX-License-Identifier: MIT
!> State of a run: everything that one step hands to the next.
module run_state
   use, intrinsic :: iso_fortran_env, only: int64
   use archive, only: archive_t
   use kinds, only: wp
   use control_state, only: control_state_t, new_control_state, exchange_control
   use start_findings, only: tension_t
   use model_types, only: problem_t, term_box_t, gravity_at
   use porous_domain, only: copy_state, exchange_state
   use solution, only: stage_state_t
   use sparsity_pattern, only: make_pattern
   use texts, only: short
   implicit none (type, external)
   private
   public :: run_t, news_t, exchange_run, enter_stage, now_in

   !> News for observers, beside what the run computes with.
   type :: news_t
      logical :: last = .false.            !< The stage ends with the step that was accepted.
      logical :: complete = .false.        !< A stage that ends has come to its end; else a fault has ended the run.
      real(wp) :: localised = 0.0_wp       !< Share of the shear work without ellipticity [-], set by its observer.
      real(wp) :: contact_work = 0.0_wp    !< Work done on contacts so far [kJ], set by the ledger, which stands first.
   end type news_t

   type, extends(problem_t) :: run_t
      type(term_box_t), allocatable :: terms(:)   !< Terms of the model, with what they keep from step to step.
      type(tension_t) :: tension               !< Tension in the initial state, for a warning.
      type(control_state_t) :: control         !< Control of the time step, in stages that choose it.
      integer :: steps = 0, iterations = 0, cuts = 0
      integer(int64) :: rate_evaluations = 0   !< Rate evaluations of the material.
      real(wp) :: dissipated = 0.0_wp          !< Energy that terms dissipated in the last accepted step [kJ].
      real(wp) :: seconds_output = 0.0_wp      !< Wall time of the observers.
      type(news_t) :: news
   end type run_t
contains
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

   !> Where a run is at the end of the step under way, for a warning.
   function now_in(run) result(text)
      type(run_t), intent(in) :: run
      character(:), allocatable :: text

      text = 'stage '//trim(run%stage%name)//', time '//short(run%next%time)//' s: '
   end function now_in

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
      if (archive%reading) run%control = new_control_state(size(run%state%x, 2), size(run%state%s_rate), &
                                                           size(run%model%contacts))
      call exchange_control(run%control, archive)
      if (allocated(run%system%contacts)) call exchange_pairs(run%dofs%n, run%system%extra, archive)
      if (.not. archive%reading .or. .not. archive%good) return
      run%stage => run%model%stages(run%at%stage)
      run%state%gravity = gravity_at(run%model, run%state%time)
      call copy_state(run%state, run%next)
      if (.not. allocated(run%system%extra)) return
      call make_pattern(run%dofs%n, run%dofs%element, run%system%extra, run%pattern)
      deallocate (run%assembly%values)
      allocate (run%assembly%values(size(run%pattern%col)), source=0.0_wp)
   end subroutine exchange_run

   !> Pairs of unknowns that surfaces have brought together: the ordering of the matrix depends on them.
   subroutine exchange_pairs(unknowns, extra, archive)
      integer, intent(in) :: unknowns
      integer, allocatable, intent(inout) :: extra(:, :)   !< (2, pairs)
      class(archive_t), intent(inout) :: archive
      integer, allocatable :: pairs(:)

      if (allocated(extra)) pairs = reshape(extra, [size(extra)])
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
