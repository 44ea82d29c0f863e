! SPDX-License-Identifier: MIT
!> Runs a scene without files and words, and keeps what its answers did.
!> docs/theory/host.md section 11.
module pilot_runs
   use kinds, only: wp
   use effect_monitor, only: indicator_of, mass_of_nodes
   use effect_types, only: effect_t, EFFECTS, OF_FLOW
   use faults, only: fault_t, raise, EXIT_INPUT
   use generalised_alpha, only: scheme_t, make_scheme
   use linear_system, only: T_MATERIAL, T_ASSEMBLY, T_CONTACT, T_FACTORISATION, T_SOLUTION, T_REST
   use model_builder, only: build_model
   use model_types, only: model_t
   use named_answers, only: is_prescribed
   use moving_supports, only: find_moving, forces_of_moving
   use porous_domain, only: state_t, copy_state
   use run_observer, only: run_observer_t, step_report_t
   use run_setup, only: prepare_run
   use run_size, only: memory_of
   use run_state, only: run_t
   use scene_types, only: scene_t
   use texts, only: short
   use time_stepping, only: run_stages
   use unknown_fields, only: FIELDS
   use wall_clock, only: clock
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: pilot_t, stage_ends_t, run_pilot, run_observed_pilot, PHASES

   integer, parameter :: NODES_WITHOUT_POINTS = 50    !< Answers of a scene that names no points.
   ! A pass over an element with its share of the solution, on a usual processor: measured, rounded [s].
   real(wp), parameter :: OF_ELASTIC = 3.0e-5_wp, OF_PLASTIC = 1.0e-4_wp

   integer, parameter :: PHASES = size([T_MATERIAL, T_ASSEMBLY, T_CONTACT, T_FACTORISATION, T_SOLUTION, T_REST]) + 1

   type :: stage_ends_t
      real(wp), allocatable :: times(:)               !< Ends of the steps, from the start of the stage [s].
   end type stage_ends_t

   !> What a pilot has shown.
   type :: pilot_t
      logical :: done = .false.
      logical :: cut_off = .false.                    !< It took all work, or all time, that it may.
      integer :: code = 0                             !< Of the fault where it is not done, and why.
      character(200) :: why = ''
      integer :: elements = 0, unknowns = 0, steps = 0
      real(wp) :: seconds = 0.0_wp, processor = 0.0_wp   !< By the clock; of the processor, all threads.
      real(wp) :: work = 0.0_wp                       !< By the passes over its elements [s].
      real(wp) :: stress = 0.0_wp                     !< Largest change of an effective stress [kPa].
      logical :: has(FIELDS) = .false.
      logical, allocatable :: prescribed(:, :)        !< (FIELDS, points) Throughout: no answers.
      character(72), allocatable :: names(:)          !< Of the points.
      real(wp), allocatable :: time(:), x(:, :, :)    !< [s], (FIELDS, points, times) [m, kPa]
      character(72), allocatable :: supports(:)       !< Those that move, with the direction.
      real(wp), allocatable :: force(:, :)            !< (supports, times) [kN]
      real(wp), allocatable :: force_time(:)          !< To which they belong, within the steps [s].
      real(wp), allocatable :: indicators(:, :)       !< Largest, (see indicator_place, stages).
      type(stage_ends_t), allocatable :: ends(:)      !< Of the stages.
      real(wp), allocatable :: rho_inf(:)             !< Of the stages.
      real(wp) :: phases(PHASES) = 0.0_wp             !< Wall time by T_... of linear_system, then of all else [s].
      integer :: iterations = 0, cuts = 0
      real(wp) :: megabytes(2) = 0.0_wp               !< Lists over points, elements and unknowns; factors.
   end type pilot_t

   type, extends(run_observer_t) :: watcher_t
      type(pilot_t) :: seen
      type(state_t) :: first, before
      real(wp), allocatable :: mass(:)
      integer, allocatable :: nodes(:)
      integer, allocatable :: moving(:)               !< Supports of which the force is kept, places in model%fixes.
      integer :: rows = 0
      real(wp) :: of_pass = 0.0_wp, most_work = huge(1.0_wp), most_seconds = huge(1.0_wp), began = 0.0_wp   !< [s]
      class(run_observer_t), pointer :: also => null()   !< It sees what the watcher sees.
   contains
      procedure :: run_begins
      procedure :: step_done
      procedure :: stage_done
      procedure :: run_ends
      procedure :: warn
   end type watcher_t
contains
   !> Runs a scene whose keys are settled. A failure is told in the pilot. docs/theory/host.md section 11.
   subroutine run_pilot(scene, most_work, pilot, most_seconds)
      type(scene_t), intent(in) :: scene
      real(wp), intent(in) :: most_work   !< That the pilot may take [s].
      type(pilot_t), intent(out) :: pilot
      real(wp), intent(in), optional :: most_seconds   !< Wall time that it may take [s].
      type(model_t) :: model
      type(run_t) :: run

      call run_observed_pilot(scene, most_work, model, run, pilot, most_seconds)
   end subroutine run_pilot

   !> The same, and keeps the model and the run, which another observer may see.
   subroutine run_observed_pilot(scene, most_work, model, run, pilot, most_seconds, also)
      type(scene_t), intent(in) :: scene
      real(wp), intent(in) :: most_work   !< That it may take [s].
      type(model_t), intent(out) :: model
      type(run_t), intent(out) :: run
      type(pilot_t), intent(out) :: pilot
      real(wp), intent(in), optional :: most_seconds   !< Wall time that it may take [s].
      class(run_observer_t), intent(inout), target, optional :: also
      type(watcher_t) :: watcher
      type(fault_t) :: fault
      real(wp) :: p0, p1

      call cpu_time(p0)
      watcher%began = clock()
      watcher%silent = .true.
      watcher%most_work = most_work
      if (present(most_seconds)) watcher%most_seconds = most_seconds
      if (present(also)) then
         watcher%silent = also%silent
         watcher%also => also
      end if
      call build_model(scene, model, fault)
      if (fault%code == 0) call prepare_run(model, run, fault)
      if (fault%code == 0) call run_stages(model, run, fault, watcher)
      pilot = watcher%seen
      pilot%done = fault%code == 0
      pilot%code = fault%code
      pilot%work = watcher%of_pass*(run%iterations + run%steps)
      pilot%why = fault%text(:len(pilot%why))
      pilot%seconds = clock() - watcher%began
      pilot%cut_off = .not. pilot%done .and. (pilot%work > most_work .or. pilot%seconds > watcher%most_seconds)
      call cpu_time(p1)
      pilot%processor = p1 - p0
      if (allocated(model%stages)) pilot%rho_inf = model%stages%rho_inf
      if (.not. allocated(model%dofs%of)) return
      pilot%elements = size(model%domain%mesh%t6, 2)
      pilot%unknowns = model%dofs%n
      pilot%has = any(model%dofs%of(:FIELDS, :) > 0, dim=2)
      pilot%phases(:PHASES - 1) = run%system%seconds
      pilot%phases(PHASES) = pilot%seconds - sum(run%system%seconds)
      pilot%iterations = run%iterations
      pilot%cuts = run%cuts
      pilot%megabytes = memory_of(run)
   end subroutine run_observed_pilot

   !> Chooses the nodes whose answers are kept, and keeps their values at the start. Raises no fault.
   subroutine run_begins(self, model, run, fault)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i, k, n

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
      do i = 1, size(model%domain%region_of)
         self%of_pass = self%of_pass + merge(OF_ELASTIC, OF_PLASTIC, &
                                             model%domain%regions(model%domain%region_of(i))%law%has_energy)
      end do
      self%mass = mass_of_nodes(model, run%state)
      self%first = run%state
      self%before = run%state
      allocate (self%seen%indicators(EFFECTS + size(model%domain%regions), size(model%stages)), source=0.0_wp)
      allocate (self%seen%ends(size(model%stages)))
      do i = 1, size(model%stages)
         allocate (self%seen%ends(i)%times(0))
      end do
      allocate (self%seen%prescribed(FIELDS, size(self%nodes)))
      do i = 1, size(self%nodes)
         self%seen%prescribed(:, i) = [(is_prescribed(model, self%nodes(i), k), k=1, FIELDS)]
      end do
      call find_moving(model, self%moving, self%seen%supports)
      if (associated(self%also)) call self%also%run_begins(model, run, fault)
      n = size(self%moving)
      allocate (self%seen%time(1), self%seen%x(FIELDS, size(self%nodes), 1), self%seen%force(n, 1))
      self%seen%force = 0.0_wp
      self%seen%force_time = [run%state%time]
      call keep(self, model, run, 0.0_wp)
   end subroutine run_begins

   !> A row of the histories. Before the first step no force is known: it gets that of the first.
   subroutine keep(self, model, run, dt)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: dt   !< Of the step [s].
      type(scheme_t) :: scheme
      real(wp), allocatable :: time(:), force_time(:), x(:, :, :), force(:, :)

      if (self%rows == size(self%seen%time)) then
         allocate (time(2*self%rows), x(FIELDS, size(self%nodes), 2*self%rows), force(size(self%moving), 2*self%rows))
         time(:self%rows) = self%seen%time
         x(:, :, :self%rows) = self%seen%x
         force(:, :self%rows) = self%seen%force
         call move_alloc(time, self%seen%time)
         call move_alloc(x, self%seen%x)
         call move_alloc(force, self%seen%force)
         allocate (force_time(2*self%rows))
         force_time(:self%rows) = self%seen%force_time
         call move_alloc(force_time, self%seen%force_time)
      end if
      self%rows = self%rows + 1
      self%seen%time(self%rows) = run%state%time
      self%seen%x(:, :, self%rows) = run%state%x(:FIELDS, self%nodes)
      if (self%rows == 1) return
      scheme = make_scheme(model%stages(run%at%stage)%kind, model%stages(run%at%stage)%rho_inf, dt)
      self%seen%force_time(self%rows) = run%state%time - (1 - scheme%l_f)*dt
      if (size(self%moving) > 0) self%seen%force(:, self%rows) = forces_of_moving(model, run, self%moving)
      if (self%rows == 2) self%seen%force(:, 1) = self%seen%force(:, 2)
   end subroutine keep

   !> Keeps answers, indicators and the end of the step. Fault EXIT_INPUT: more than most_work or
   !> most_seconds; those of the observer beside it.
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
      call keep(self, model, run, report%dt)
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
      if (associated(self%also)) call self%also%step_done(model, run, report, checkpoint, fault)
      if (self%of_pass*(run%iterations + run%steps) > self%most_work) call raise(fault, EXIT_INPUT, &
         'its pilot takes many times as many steps')
      if (clock() - self%began > self%most_seconds) call raise(fault, EXIT_INPUT, 'it takes more than '// &
                                                              short(self%most_seconds)//' s')
   end subroutine step_done

   !> Takes over displacements that the end of the stage has set to zero. Raises no fault.
   subroutine stage_done(self, model, run, stage, complete, fault)
      class(watcher_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      integer, intent(in) :: stage
      logical, intent(in) :: complete
      type(fault_t), intent(inout) :: fault

      if (associated(self%also)) call self%also%stage_done(model, run, stage, complete, fault)
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

      if (associated(self%also)) call self%also%run_ends(model, run, fault)
      if (fault%code /= 0 .or. size(model%stages) == 0) return
      self%seen%steps = run%steps
      self%seen%time = self%seen%time(:self%rows)
      self%seen%x = self%seen%x(:, :, :self%rows)
      self%seen%force = self%seen%force(:, :self%rows)
      self%seen%force_time = self%seen%force_time(:self%rows)
   end subroutine run_ends

   !> Prints a text, unless the watcher is silent.
   subroutine warn(self, text, passing)
      class(watcher_t), intent(inout) :: self
      character(*), intent(in) :: text
      logical, intent(in), optional :: passing

      if (associated(self%also)) then
         call self%also%warn(text, passing)
         return
      end if
      if (present(passing)) return
      ! The run itself warns where it is needed.
      if (.not. self%silent) call print_warning(text)
   end subroutine warn
end module pilot_runs
