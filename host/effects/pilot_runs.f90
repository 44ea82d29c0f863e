! SPDX-License-Identifier: MIT
!> Runs a scene without files and words, and keeps what its answers did; compares two such runs.
!> docs/theory/host.md section 11.
module pilot_runs
   use, intrinsic :: iso_fortran_env, only: output_unit
   use kinds, only: wp
   use effect_monitor, only: indicator_of, mass_of_nodes
   use effect_types, only: effect_t, EFFECTS, OF_FLOW
   use faults, only: fault_t, raise, EXIT_INPUT
   use history_distance, only: farthest
   use model_builder, only: build_model
   use model_types, only: model_t
   use porous_domain, only: state_t, copy_state
   use run_observer, only: run_observer_t, step_report_t
   use run_setup, only: prepare_run
   use run_state, only: run_t
   use scene_types, only: scene_t
   use time_stepping, only: run_stages
   use unknown_fields, only: FIELDS, FIELD_NAMES, DISPLACEMENTS, AT_P_W, AT_P_C
   use wall_clock, only: clock
   implicit none (type, external)
   private
   public :: pilot_t, stage_ends_t, run_pilot, difference_t, difference, influence_t

   integer, parameter :: NODES_WITHOUT_POINTS = 50    !< Answers of a scene that names no points.
   integer, parameter :: MOST_TIMES_THE_STEPS = 5     !< Of the whole scene's pilot, that another one may take.
   real(wp), parameter :: NO_ANSWER = 1.0e-4_wp       !< A smaller range, as share of its kind's largest, is no answer.
   real(wp), parameter :: NO_PRESSURE = 1.0e-3_wp     !< The same of a pressure, as a share of the stresses' change.

   character(7), parameter :: FORCES(DISPLACEMENTS) = ['force_r', 'force_z']

   type :: stage_ends_t
      real(wp), allocatable :: times(:)               !< Ends of the steps, from the start of the stage [s].
   end type stage_ends_t

   !> What a pilot has shown.
   type :: pilot_t
      logical :: done = .false.
      character(200) :: why = ''                      !< Where it is not done.
      integer :: elements = 0, unknowns = 0, steps = 0
      real(wp) :: seconds = 0.0_wp, processor = 0.0_wp   !< By the clock; of the processor, all threads.
      real(wp) :: stress = 0.0_wp                     !< Largest change of an effective stress [kPa].
      logical :: has(FIELDS) = .false.
      character(72), allocatable :: names(:)          !< Of the points.
      real(wp), allocatable :: time(:), x(:, :, :)    !< [s], (FIELDS, points, times) [m, kPa]
      character(72), allocatable :: supports(:)       !< Those that move, with the direction.
      real(wp), allocatable :: force(:, :)            !< (supports, times) [kN]
      real(wp), allocatable :: indicators(:, :)       !< Largest, (see indicator_place, stages).
      type(stage_ends_t), allocatable :: ends(:)      !< Of the stages.
      real(wp), allocatable :: rho_inf(:)             !< Of the stages.
   end type pilot_t

   type, extends(run_observer_t) :: watcher_t
      type(pilot_t) :: seen
      type(state_t) :: first, before
      real(wp), allocatable :: mass(:)
      integer, allocatable :: nodes(:)
      integer, allocatable :: moving(:)               !< Supports of which the force is kept, places in model%fixes.
      integer :: rows = 0
      integer :: most_steps = huge(1)
   contains
      procedure :: run_begins
      procedure :: step_done
      procedure :: stage_done
      procedure :: run_ends
      procedure :: warn
   end type watcher_t

   !> How far two runs lie apart.
   type :: difference_t
      real(wp) :: share = 0.0_wp                      !< Distance as a share of the answer's range [-].
      real(wp) :: change = 0.0_wp                     !< Second run less first, where they differ most [m, kPa, kN].
      character(72) :: answer = ''
   end type difference_t

   !> What an effect changes in one answer.
   type :: influence_t
      integer :: effect = 0                           !< Row of the table of effects.
      character(72) :: answer = ''
      real(wp) :: range = 0.0_wp                      !< What the share is of [m, kPa, kN].
      real(wp) :: change = 0.0_wp                     !< Second run less first, where they differ most [m, kPa, kN].
      real(wp) :: share = 0.0_wp                      !< [-]
   end type influence_t
contains
   !> Runs a scene whose keys are settled. A failure is told in the pilot. docs/theory/host.md section 11.
   subroutine run_pilot(scene, most_steps, pilot)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: most_steps   !< Of a pilot that may take MOST_TIMES_THE_STEPS times as many; 0: any number.
      type(pilot_t), intent(out) :: pilot
      type(model_t) :: model
      type(run_t) :: run
      type(watcher_t) :: watcher
      type(fault_t) :: fault
      real(wp) :: t0, p0, p1

      t0 = clock()
      call cpu_time(p0)
      watcher%silent = .true.
      if (most_steps > 0) watcher%most_steps = MOST_TIMES_THE_STEPS*most_steps
      call build_model(scene, model, fault)
      if (fault%code == 0) call prepare_run(model, run, fault)
      if (fault%code == 0) call run_stages(model, run, fault, watcher)
      pilot = watcher%seen
      pilot%done = fault%code == 0
      pilot%why = fault%text(:len(pilot%why))
      pilot%seconds = clock() - t0
      call cpu_time(p1)
      pilot%processor = p1 - p0
      if (allocated(model%stages)) pilot%rho_inf = model%stages%rho_inf
      if (.not. allocated(model%dofs%of)) return
      pilot%elements = size(model%domain%mesh%t6, 2)
      pilot%unknowns = model%dofs%n
      pilot%has = any(model%dofs%of(:FIELDS, :) > 0, dim=2)
   end subroutine run_pilot

   !> Chooses the nodes whose answers are kept, and keeps their values at the start. Raises no fault.
   subroutine run_begins(self, model, run, fault)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i, n

      if (fault%code /= 0) return
      n = size(model%domain%mesh%x, 2)
      if (size(model%points) > 0) then
         self%nodes = model%points%node
         self%seen%names = model%points%name
      else
         self%nodes = [(1 + (i - 1)*(n - 1)/(min(n, NODES_WITHOUT_POINTS) - 1), i=1, min(n, NODES_WITHOUT_POINTS))]
         allocate (self%seen%names(size(self%nodes)))
         do i = 1, size(self%nodes)
            write (self%seen%names(i), '(a,i0)') 'node', self%nodes(i)
         end do
      end if
      self%mass = mass_of_nodes(model, run%state)
      self%first = run%state
      self%before = run%state
      allocate (self%seen%indicators(EFFECTS + size(model%domain%regions), size(model%stages)), source=0.0_wp)
      allocate (self%seen%ends(size(model%stages)))
      do i = 1, size(model%stages)
         allocate (self%seen%ends(i)%times(0))
      end do
      call find_moving(model, self%moving, self%seen%supports)
      n = size(self%moving)
      allocate (self%seen%time(1), self%seen%x(FIELDS, size(self%nodes), 1), self%seen%force(n, 1))
      self%seen%force = 0.0_wp
      call keep(self, model, run)
   end subroutine run_begins

   !> Supports that move a body: where a displacement is prescribed, the answer is the force.
   pure subroutine find_moving(model, moving, names)
      type(model_t), intent(in) :: model
      integer, allocatable, intent(out) :: moving(:)          !< Places in model%fixes.
      character(72), allocatable, intent(out) :: names(:)     !< As the columns of reactions_STAGE.csv.
      integer :: i

      allocate (moving(0))
      do i = 1, size(model%fixes)
         associate (fix => model%fixes(i))
            if (fix%field > DISPLACEMENTS .or. fix%acceleration) cycle
            if (abs(fix%value) + abs(fix%value_slope) <= 0.0_wp) cycle
            ! One answer, though several stages move it.
            if (any(model%fixes(moving)%group == fix%group .and. model%fixes(moving)%field == fix%field)) cycle
            moving = [moving, i]
         end associate
      end do
      allocate (names(size(moving)))
      do i = 1, size(moving)
         associate (fix => model%fixes(moving(i)))
            names(i) = trim(model%domain%mesh%groups(fix%group)%name)//'.'//trim(FORCES(fix%field))
         end associate
      end do
   end subroutine find_moving

   !> A row of the histories. Before the first step no force is known: it gets that of the first.
   subroutine keep(self, model, run)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      real(wp), allocatable :: time(:), x(:, :, :), force(:, :)
      integer :: i

      if (self%rows == size(self%seen%time)) then
         allocate (time(2*self%rows), x(FIELDS, size(self%nodes), 2*self%rows), force(size(self%moving), 2*self%rows))
         time(:self%rows) = self%seen%time
         x(:, :, :self%rows) = self%seen%x
         force(:, :self%rows) = self%seen%force
         call move_alloc(time, self%seen%time)
         call move_alloc(x, self%seen%x)
         call move_alloc(force, self%seen%force)
      end if
      self%rows = self%rows + 1
      self%seen%time(self%rows) = run%state%time
      self%seen%x(:, :, self%rows) = run%state%x(:FIELDS, self%nodes)
      if (self%rows == 1) return
      do i = 1, size(self%moving)
         associate (fix => model%fixes(self%moving(i)))
            associate (at => model%dofs%of(fix%field, model%domain%mesh%groups(fix%group)%nodes))
               self%seen%force(i, self%rows) = sum(run%system%reaction(pack(at, at > 0)))
            end associate
         end associate
      end do
      if (self%rows == 2) self%seen%force(:, 1) = self%seen%force(:, 2)
   end subroutine keep

   !> Keeps answers, indicators and the end of the step. Fault EXIT_INPUT: more than most_steps.
   subroutine step_done(self, model, run, report, checkpoint, fault)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(step_report_t), intent(in) :: report
      logical, intent(out) :: checkpoint
      type(fault_t), intent(inout) :: fault
      type(effect_t) :: effect
      integer :: k

      checkpoint = .false.
      call keep(self, model, run)
      self%seen%stress = max(self%seen%stress, maxval(abs(run%state%stress - self%first%stress)))
      associate (s => report%stage)
         do k = 1, size(self%seen%indicators, 1)
            effect = effect_t(kind=min(k, OF_FLOW), stage=s, region=max(0, k - EFFECTS))
            self%seen%indicators(k, s) = max(self%seen%indicators(k, s), &
               indicator_of(effect, model, s, report%dt, self%mass, self%before, run%state))
         end do
         self%seen%ends(s)%times = [self%seen%ends(s)%times, run%state%time - run%at%t_start]
      end associate
      call copy_state(run%state, self%before)
      if (run%steps > self%most_steps) call raise(fault, EXIT_INPUT, 'its pilot takes many times as many steps')
   end subroutine step_done

   !> Takes over displacements that the end of the stage has set to zero. Raises no fault.
   subroutine stage_done(self, model, run, stage, complete, fault)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      integer, intent(in) :: stage
      logical, intent(in) :: complete
      type(fault_t), intent(inout) :: fault

      if (fault%code /= 0 .or. .not. complete) return
      ! Displacements may have been set to zero, and accelerations with them.
      if (model%stages(stage)%zero_displacements) call copy_state(run%state, self%before)
   end subroutine stage_done

   !> Cuts the histories to the rows that are filled. Raises no fault.
   subroutine run_ends(self, model, run, fault)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      if (fault%code /= 0 .or. size(model%stages) == 0) return
      self%seen%steps = run%steps
      self%seen%time = self%seen%time(:self%rows)
      self%seen%x = self%seen%x(:, :, :self%rows)
      self%seen%force = self%seen%force(:, :self%rows)
   end subroutine run_ends

   !> Prints a text, unless the watcher is silent.
   subroutine warn(self, text)
      class(watcher_t), intent(inout) :: self
      character(*), intent(in) :: text

      ! The run itself warns where it is needed.
      if (.not. self%silent) write (output_unit, '(a)') text
   end subroutine warn

   !> How far the answers of two runs of one mesh lie apart, as shares of the range of each answer in the first; a field
   !> that one of them lacks is measured by its change against the largest change of an effective stress.
   !> docs/theory/host.md section 11. The force of a support that moves is an answer too. `worst` is the answer that
   !> differs most; `influences` lists all answers that either run has.
   subroutine difference(one, two, worst, influences)
      type(pilot_t), intent(in) :: one, two
      type(difference_t), intent(out) :: worst
      type(influence_t), allocatable, intent(out), optional :: influences(:)   !< (answers)
      type(influence_t) :: all(FIELDS*size(one%names) + size(one%supports))
      real(wp) :: range(FIELDS, size(one%names)), force_range(size(one%supports)), largest(2), scale, apart, change
      integer :: f, i, of, n

      n = 0
      range = maxval(one%x, dim=3) - minval(one%x, dim=3)
      largest = [maxval(range(:DISPLACEMENTS, :)), maxval(range(DISPLACEMENTS + 1:, :))]
      largest(2) = max(largest(2), NO_PRESSURE/NO_ANSWER*one%stress)
      do i = 1, size(one%names)
         do f = 1, FIELDS
            of = merge(1, 2, f <= DISPLACEMENTS)
            if (one%has(f) .and. two%has(f)) then
               if (range(f, i) <= NO_ANSWER*largest(of)) cycle
               scale = range(f, i)
               change = farthest(one%time, one%x(f, i, :), two%time, two%x(f, i, :))
            else if (one%has(f)) then
               call lost(one, f, i, change, scale)
            else if (two%has(f)) then
               call lost(two, f, i, change, scale)
            else
               cycle
            end if
            call compare(trim(one%names(i))//'.'//trim(FIELD_NAMES(f)))
         end do
      end do
      force_range = maxval(one%force, dim=2) - minval(one%force, dim=2)
      do i = 1, size(one%supports)
         if (force_range(i) <= NO_ANSWER*maxval(force_range)) cycle
         scale = force_range(i)
         change = farthest(one%time, one%force(i, :), two%time, two%force(i, :))
         call compare(trim(one%supports(i)))
      end do
      if (present(influences)) influences = all(:n)
   contains
      subroutine compare(answer)
         character(*), intent(in) :: answer

         apart = abs(change)/max(scale, tiny(1.0_wp)/epsilon(1.0_wp))
         n = n + 1
         all(n) = influence_t(0, answer, scale, change, apart)
         if (apart > worst%share) worst = difference_t(apart, change, all(n)%answer)
      end subroutine compare
   end subroutine difference

   !> A pressure that is no unknown any more: its change; of suction that beyond zero alone.
   pure subroutine lost(run, field, point, change, scale)
      type(pilot_t), intent(in) :: run
      integer, intent(in) :: field, point
      real(wp), intent(out) :: change, scale   !< [kPa]

      scale = run%stress
      change = 0.0_wp
      if (field == AT_P_W) change = -(maxval(run%x(field, point, :)) - minval(run%x(field, point, :)))
      if (field == AT_P_C) change = -(maxval(max(0.0_wp, run%x(field, point, :))) &
                                      - minval(max(0.0_wp, run%x(field, point, :))))
   end subroutine lost
end module pilot_runs
