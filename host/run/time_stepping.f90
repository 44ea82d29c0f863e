!> Runs the stages of a scene: steps, cuts with exact restoration, ledger, output.
module time_stepping
   use exit_codes, only: EXIT_CONVERGENCE, EXIT_MATERIAL, EXIT_FREE_BODY, EXIT_SOLVER
   use unknown_fields, only: FIELD_NAMES
   use kinds, only: wp
   use checkpoints, only: write_checkpoint, read_checkpoint
   use wall_clock, only: clock, lap
   use host_contact, only: prepare_contacts, seat_plates, contacts_act
   use run_state, only: run_t, course_t
   use contact_drainage, only: prepare_drainage, freeze_drainage
   use effect_decisions, only: derive_effects
   use effects_table, only: write_effects
   use energy_ledger, only: book_step, kinetic_energy
   use initial_conditions, only: initial_state
   use boundary_loads, only: shape_loads, ties_of, load_at, constrain_step, new_constraint
   use output_tables, only: output_t, open_output, write_history, write_ledger, write_contacts, write_fields, &
                          write_touching, write_frame, close_output
   use progress_line, only: progress_t, show_progress, clear_progress
   use model_types, only: model_t, stage_t, effect_t, NEVER
   use effect_monitor, only: begin_watch, begin_swing, watch_step, warning_of
   use contact_types, only: contact_message
   use equation_assembly, only: make_assembly, assemble
   use contact_interfaces, only: work_of_contacts
   use degrees_of_freedom, only: number_unknowns
   use fe_material, only: TOO_LARGE
   use porous_domain, only: copy_state
   use sparsity_pattern, only: make_pattern
   use hdf5_file, only: HAS_HDF5
   use newton_step, only: control_t, log_t, take_step, start_accelerations, BY_RESIDUAL, BY_CORRECTION, &
                     CONVERGED, MATERIAL_FAILED, BODY_FREE, SOLVER_FAILED, CONTACT_FAILED
   use sparse_factors, only: release
   use generalised_alpha, only: scheme_t, make_scheme, step_error, DYNAMIC
   use faults, only: fault_t, raise, EXIT_INPUT
   use texts, only: short, whole
   !$ use omp_lib, only: omp_get_max_threads
   implicit none (type, external)
   private
   public :: run_t, prepare_run, run_scene

   real(wp), parameter :: LAST_STEP = 1.0e-6_wp   !< A rest of a stage below this share of a step is rounding.
   integer, parameter :: GOOD_STEPS = 2           !< Accepted steps in a row after which a cut step grows back.
contains
   !> Unknowns, pattern, loads and initial state.
   subroutine prepare_run(model, run, fault)
      type(model_t), intent(inout) :: model
      type(run_t), intent(out) :: run
      type(fault_t), intent(inout) :: fault
      type(effect_t), allocatable :: table(:)

      if (model%domain%threads == 0) then
         model%domain%threads = 1
         !$ model%domain%threads = omp_get_max_threads()
      end if
      if (model%effects%auto) call derive_effects(model, table, fault)
      if (fault%code /= 0) return
      run%system%reuse = model%reuse_factors
      run%system%sparse%ordering = model%ordering
      call number_unknowns(model%domain, ties_of(model), run%dofs)
      call make_pattern(run%dofs%n, run%dofs%element, reshape([integer ::], [2, 0]), run%pattern)
      call make_assembly(model%domain, run%dofs, run%pattern, run%assembly)
      call shape_loads(model, run%dofs)
      run%constraint = new_constraint(model, run%dofs)
      call initial_state(model, run%state, fault)
      if (fault%code == 0) call prepare_contacts(model, run%dofs, run%system%contacts, fault)
      if (fault%code == 0) call prepare_drainage(model, run%drainage, fault)
      if (fault%code == 0) call seat_plates(model, run%system%contacts, run%state)
      run%next = run%state
      if (fault%code == 0 .and. model%effects%auto) call begin_watch(model, table, run%state, run%watch)
      if (fault%code == 0 .and. model%subtract_flow) call keep_flow(model, run, fault)
   end subroutine prepare_run

   !> The flow of the initial state, to be subtracted from then on.
   subroutine keep_flow(model, run, fault)
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(scheme_t) :: scheme

      scheme = make_scheme(DYNAMIC, 1.0_wp, 1.0_wp)
      call assemble(model%domain, run%dofs, run%pattern, scheme, run%state, run%next, .false., run%assembly)
      if (run%assembly%bad_element > 0) then
         call raise(fault, EXIT_MATERIAL, 'The initial state is refused by the material of element '// &
                    whole(run%assembly%bad_element)//'.')
         return
      end if
      where (run%dofs%field >= 3) run%constraint%offset = -run%assembly%residual
      call copy_state(run%state, run%next)
   end subroutine keep_flow

   !> All stages; what was computed before a failure is on disk.
   subroutine run_scene(model, folder, quiet, run, fault, restart)
      type(model_t), intent(inout) :: model
      character(*), intent(in) :: folder   !< Empty: no files.
      logical, intent(in) :: quiet
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      character(*), intent(in), optional :: restart   !< A checkpoint to go on from.
      type(output_t) :: output
      type(progress_t) :: progress
      type(fault_t) :: last
      real(wp) :: t0
      integer :: i

      if (.not. HAS_HDF5 .and. (model%checkpoint_steps > 0 .or. model%checkpoint_seconds > 0.0_wp)) then
         call raise(fault, EXIT_INPUT, 'This mud_host was built without HDF5: it writes no checkpoints; leave '// &
                    'checkpoint_steps and checkpoint_seconds out, or install HDF5 and build anew.')
         return
      end if
      t0 = clock()
      if (present(restart)) call read_checkpoint(restart, model, run, output, fault)
      if (fault%code == 0 .and. folder /= '') call open_output(folder, model, present(restart), output, fault)
      if (fault%code /= 0) return
      if (folder /= '' .and. model%effects%auto) call write_effects(folder, run%watch%table, fault)
      if (folder /= '' .and. run%steps == 0) then
         call write_history(output, model, run%state, fault)
         call write_frame(folder, model%domain, run%state, output%frames, fault)
         if (fault%code /= 0) return
      end if
      call lap(run%seconds_output, t0)
      progress%quiet = quiet
      progress%last_checkpoint = t0
      do i = max(1, run%course%stage), size(model%stages)
         call run_stage(model, i, folder /= '', quiet, output, progress, run, fault)
         call clear_progress(progress)
         t0 = clock()
         ! Also after a failure, which is reported, not what its last output may meet.
         last = fault_t()
         if (folder /= '') call write_fields(output, model%domain, trim(model%stages(i)%name), run%state, last)
         if (folder /= '' .and. last%code == 0) &
            call write_touching(output, model, run%system%contacts, trim(model%stages(i)%name), run%state, last)
         if (folder /= '' .and. last%code == 0) &
            call write_frame(folder, model%domain, run%state, output%frames, last)
         if (fault%code == 0) fault = last
         call lap(run%seconds_output, t0)
         if (fault%code /= 0) exit
      end do
      last = fault_t()
      if (folder /= '') call close_output(output, last)
      if (fault%code == 0) fault = last
      if (model%effects%auto) call end_watch(model, folder, quiet, run, fault)
      call release(run%system%sparse)
      run%system%analysed = .false.
   end subroutine run_scene

   !> What was seen of the effects that are off.
   subroutine end_watch(model, folder, quiet, run, fault)
      type(model_t), intent(in) :: model
      character(*), intent(in) :: folder
      logical, intent(in) :: quiet
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: last
      integer :: i

      if (folder /= '') call write_effects(folder, run%watch%table, last)
      if (fault%code == 0) fault = last
      if (quiet .or. .not. any(run%watch%table%crossed > NEVER)) return
      write (*, '(a)') 'Effects that are off and crossed their thresholds in this run:'
      do i = 1, size(run%watch%table)
         if (run%watch%table(i)%crossed > NEVER) write (*, '(a)') '   '//warning_of(model, run%watch%table(i))
      end do
   end subroutine end_watch

   !> Watches a step that is accepted but not yet taken over, and warns.
   subroutine look_at_effects(model, number, dt, quiet, progress, run)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number
      real(wp), intent(in) :: dt
      logical, intent(in) :: quiet
      type(progress_t), intent(inout) :: progress
      type(run_t), intent(inout) :: run
      logical :: news(size(run%watch%table))
      integer :: i

      call watch_step(model, number, run%dofs, dt, run%course%t_start + model%stages(number)%duration - run%next%time &
                      <= LAST_STEP*dt, run%ledger, run%state, run%next, run%watch, news)
      if (quiet) return
      do i = 1, size(news)
         if (.not. news(i)) cycle
         call clear_progress(progress)
         write (*, '(a)') warning_of(model, run%watch%table(i))
      end do
   end subroutine look_at_effects

   subroutine run_stage(model, number, with_files, quiet, output, progress, run, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number
      logical, intent(in) :: with_files, quiet
      type(output_t), intent(inout) :: output
      type(progress_t), intent(inout) :: progress
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(control_t) :: control
      type(scheme_t) :: scheme
      type(log_t) :: log
      real(wp) :: dt, left, estimate, t0

      associate (stage => model%stages(number), course => run%course)
         control = control_t(stage%tolerance, stage%max_iterations, stage%still, stage%measure)
         ! A run that is taken up again is in the middle of its stage.
         call contacts_act(model, stage, run%system%contacts)
         if (course%stage /= number) call begin_stage(model, number, run, fault)
         if (fault%code /= 0) return
         do
            left = course%t_start + stage%duration - run%state%time
            dt = course%nominal*course%factor
            if (left <= LAST_STEP*dt) exit
            if (dt > left*(1 - LAST_STEP)) dt = left
            scheme = make_scheme(stage%kind, stage%rho_inf, dt)
            run%constraint%load_0 = load_at(model, stage, run%dofs, run%state%time)
            run%constraint%load_1 = load_at(model, stage, run%dofs, run%state%time + dt)
            call prescribe(model, stage, run%state%time + dt, run, fault)
            if (fault%code /= 0) return
            call take_step(model%domain, run%dofs, run%pattern, scheme, run%constraint, control, run%state, run%next, &
                           run%assembly, run%system, log)
            run%iterations = run%iterations + log%iterations
            run%effort = run%effort + log%effort
            if (log%outcome /= CONVERGED) then
               run%cuts = run%cuts + 1
               course%cuts = course%cuts + 1
               course%good = 0
               run%system%factored = .false.
               if (course%cuts > stage%cuts .or. log%outcome == BODY_FREE .or. log%outcome == SOLVER_FAILED) then
                  call explain(model, stage, run, log, run%state%time + dt, dt, fault)
                  return
               end if
               ! Nothing of the failed step is kept: the next attempt starts from run%state alone.
               course%factor = course%factor*merge(min(run%assembly%bad%factor, 0.5_wp), 0.5_wp, &
                                                   log%outcome == MATERIAL_FAILED)
               cycle
            end if
            course%step = course%step + 1
            run%steps = run%steps + 1
            call book_step(model%domain, run%dofs, scheme, run%constraint, run%system%reaction, run%state, run%next, &
                           run%ledger)
            if (allocated(run%system%contacts%touch)) then
               t0 = clock()
               run%ledger%contact = run%ledger%contact &
                  + work_of_contacts(run%system%contacts, run%dofs, run%state%x, run%next%x)
               call lap(run%system%seconds(6), t0)
            end if
            estimate = step_error(scheme, run%state%x, run%state%a, run%next%x, run%next%a)
            if (model%effects%auto) call look_at_effects(model, number, dt, quiet, progress, run)
            call copy_state(run%next, run%state)
            course%nominal = min(course%nominal*stage%dt_growth, max(stage%dt_max, stage%dt))
            course%good = course%good + 1
            if (course%good >= GOOD_STEPS .and. course%factor < 1.0_wp) then
               course%factor = min(1.0_wp, 2*course%factor)
               course%cuts = max(0, course%cuts - 1)
               course%good = 0
            end if
            t0 = clock()
            if (with_files) call write_step(model, number, dt, log, estimate, output, progress, run, fault)
            call lap(run%seconds_output, t0)
            if (fault%code /= 0) return
            call show_progress(model, run, progress)
         end do
         if (stage%zero_displacements) then
            run%state%x(1:2, :size(run%state%x, 2) - size(model%domain%bodies)) = 0.0_wp   ! Plates stay where they are.
            run%state%v = 0.0_wp
            run%state%a = 0.0_wp
            run%state%s_rate = 0.0_wp
         end if
         call copy_state(run%state, run%next)
         call clear_progress(progress)
         if (.not. quiet) write (*, '(a)') 'Stage '//trim(stage%name)//': '//whole(course%step)//' steps, time '// &
            short(run%state%time)//' s, '//whole(run%iterations)//' linear solves and '// &
            whole(run%cuts)//' cuts so far.'
      end associate
   end subroutine run_stage

   subroutine begin_stage(model, number, run, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      associate (stage => model%stages(number))
         run%course = course_t(stage=number, t_start=run%state%time, nominal=stage%dt, x_start=run%state%x)
         call prescribe(model, stage, run%state%time, run, fault)
         if (fault%code /= 0) return
         run%system%factored = .false.
         call begin_swing(run%watch)
         if (stage%kind == DYNAMIC .and. stage%solve_start) call first_accelerations(model, stage, run, fault)
         if (fault%code /= 0) return
         run%ledger%kinetic_0 = run%ledger%kinetic_0 + kinetic_energy(model%domain, run%dofs, run%constraint%mass, &
                                                                      run%state) - run%ledger%kinetic
      end associate
   end subroutine begin_stage

   !> Prescribed unknowns of a step that ends at a time, from the state that it starts from.
   subroutine prescribe(model, stage, time, run, fault)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: time
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      call freeze_drainage(model, run%drainage, run%system%contacts, run%state%x, fault)
      if (fault%code /= 0) return
      call constrain_step(model, stage, run%dofs, run%drainage, time, run%course%x_start, run%constraint)
   end subroutine prescribe

   !> What is written after an accepted step.
   subroutine write_step(model, number, dt, log, estimate, output, progress, run, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number
      real(wp), intent(in) :: dt, estimate
      type(log_t), intent(in) :: log
      type(output_t), intent(inout) :: output
      type(progress_t), intent(inout) :: progress
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      logical :: last, due

      associate (stage => model%stages(number), course => run%course)
         last = course%t_start + stage%duration - run%state%time <= LAST_STEP*dt
         call write_ledger(output, run%state%time, dt, number, log, run%ledger, estimate, fault)
         call write_contacts(output, model, run%system%contacts, dt, run%state, run%ledger%contact, fault)
         if (mod(course%step, stage%every) == 0 .or. last) call write_history(output, model, run%state, fault)
         if (fault%code /= 0) return
         if (stage%fields > 0 .and. .not. last) then
            if (mod(course%step, stage%fields) == 0) &
               call write_frame(output%folder, model%domain, run%state, output%frames, fault)
         end if
         due = .false.
         if (model%checkpoint_steps > 0) due = mod(run%steps, model%checkpoint_steps) == 0
         if (model%checkpoint_seconds > 0.0_wp) &
            due = clock() - progress%last_checkpoint >= model%checkpoint_seconds .or. due
         if (.not. due .or. fault%code /= 0) return
         call write_checkpoint(model, run, output, fault)
         progress%last_checkpoint = clock()
         ! A run that is taken up here has no factors.
         run%system%factored = .false.
      end associate
   end subroutine write_step

   subroutine first_accelerations(model, stage, run, fault)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(log_t) :: log

      run%constraint%load_0 = load_at(model, stage, run%dofs, run%state%time)
      call start_accelerations(model%domain, run%dofs, run%pattern, run%constraint, run%state, run%next, run%assembly, &
                               run%system, log)
      if (log%outcome /= CONVERGED) call explain(model, stage, run, log, run%state%time, 0.0_wp, fault)
   end subroutine first_accelerations

   !> Why a step failed for good.
   subroutine explain(model, stage, run, log, time, dt, fault)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      type(log_t), intent(in) :: log
      real(wp), intent(in) :: time, dt
      type(fault_t), intent(inout) :: fault
      character(600) :: text
      character(:), allocatable :: place
      integer :: e, node

      place = 'Stage '//trim(stage%name)//', time '//short(time)//' s, step '//short(dt)//' s: '
      associate (m => model%domain)
         select case (log%outcome)
         case (MATERIAL_FAILED)
            e = run%assembly%bad_element
            if (run%assembly%bad%code == TOO_LARGE) then
               text = 'a strain of the step is beyond 1; the iteration went astray or the step is far too long.'
            else
               call m%materials(m%regions(m%region_of(e))%material)%law%explain(run%assembly%bad, text)
            end if
            call raise(fault, EXIT_MATERIAL, place//'the material of element '//whole(e)//', point '// &
                       whole(run%assembly%bad_point)//', refuses: '//trim(text))
         case (CONTACT_FAILED)
            call contact_message(run%system%contacts%status, text)
            call raise(fault, EXIT_CONVERGENCE, place//trim(text)//'.')
         case (BODY_FREE)
            call raise(fault, EXIT_FREE_BODY, place//'the equations are singular: a body can move or a pressure is '// &
                       'undetermined; add a &fix, or look for a region without stiffness or a plate without contact.')
         case (SOLVER_FAILED)
            call raise(fault, EXIT_SOLVER, place//'the linear solver failed; is there enough memory for '// &
                       whole(run%dofs%n)//' unknowns?')
         case default
            node = 1
            if (log%worst_unknown > 0) node = run%dofs%node(log%worst_unknown)
            call raise(fault, EXIT_CONVERGENCE, place//'no convergence after '//whole(log%iterations)// &
                       ' iterations; '//what_is_left(stage, log)//' (allowed '//short(stage%tolerance)// &
                       '), worst at '//place_of(model, node)//'; use a smaller dt, more cuts or a better tangent.')
         end select
      end associate
   end subroutine explain

   !> Where a node is: the plate that it stands for, or an element and the point [m].
   function place_of(model, node) result(text)
      type(model_t), intent(in) :: model
      integer, intent(in) :: node
      character(:), allocatable :: text
      integer :: e, i

      associate (mesh => model%domain%mesh)
         i = findloc(model%plates%node, node, dim=1)
         if (i > 0) then
            text = 'plate '//trim(model%plates(i)%name)
         else
            e = findloc(any(mesh%t6 == node, dim=1), .true., dim=1)
            text = 'node '//whole(node)//' of element '//whole(e)//', ('//short(mesh%x(1, node))//', '// &
                   short(mesh%x(2, node))//') m'
         end if
      end associate
   end function place_of

   !> What was to fall below the tolerance, and where it stands.
   function what_is_left(stage, log) result(text)
      type(stage_t), intent(in) :: stage
      type(log_t), intent(in) :: log
      character(:), allocatable :: text

      select case (stage%measure)
      case (BY_RESIDUAL)
         text = '|R|/|R_0| '//short(log%reduction)
      case (BY_CORRECTION)
         text = '|dx|/|x| '//short(log%correction)
      case default
         text = 'error of '//FIELD_NAMES(max(1, log%worst_field))//' '//short(log%error(max(1, log%worst_field)))
      end select
   end function what_is_left
end module time_stepping
