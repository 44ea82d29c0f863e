!> Runs the stages of a scene: steps, cuts with exact restoration, ledger, output.
module host_run
   use host_kinds, only: FIELD_NAMES, EXIT_CONVERGENCE, EXIT_MATERIAL, EXIT_FREE_BODY, EXIT_SOLVER
   use kinds, only: wp
   use host_checkpoint, only: write_checkpoint, read_checkpoint
   use wall_clock, only: clock, lap
   use host_contact, only: prepare_contacts, seat_plates, contacts_act
   use host_course, only: run_t, course_t
   use host_drainage, only: prepare_drainage, freeze_drainage
   use host_effects, only: derive_effects
   use host_effects_table, only: write_effects
   use host_energy, only: book_step, kinetic_energy
   use host_initial, only: initial_state
   use host_loads, only: shape_loads, ties_of, load_at, constrain_step, new_constraint
   use host_output, only: output_t, open_output, write_history, write_ledger, write_contacts, write_fields, &
                          write_touching, write_frame, close_output
   use host_progress, only: progress_t, show_progress, clear_progress
   use host_scene, only: scene_t, stage_t, effect_t, NEVER
   use host_watch, only: begin_watch, begin_swing, watch_step, warning_of
   use contact_types, only: contact_message
   use fe_assembly, only: make_assembly, assemble
   use fe_contact, only: work_of_contacts
   use fe_dofs, only: number_unknowns
   use fe_material, only: TOO_LARGE
   use fe_model, only: copy_state
   use fe_pattern, only: make_pattern
   use hdf5_file, only: HAS_HDF5
   use newton, only: control_t, log_t, take_step, start_accelerations, BY_RESIDUAL, BY_CORRECTION, &
                     CONVERGED, MATERIAL_FAILED, BODY_FREE, SOLVER_FAILED, CONTACT_FAILED
   use solve_sparse, only: release
   use time_galpha, only: scheme_t, make_scheme, step_error, DYNAMIC
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
   subroutine prepare_run(scene, run, fault)
      type(scene_t), intent(inout) :: scene
      type(run_t), intent(out) :: run
      type(fault_t), intent(inout) :: fault
      type(effect_t), allocatable :: table(:)

      if (scene%model%threads == 0) then
         scene%model%threads = 1
         !$ scene%model%threads = omp_get_max_threads()
      end if
      if (scene%effects%auto) call derive_effects(scene, table, fault)
      if (fault%code /= 0) return
      run%system%reuse = scene%reuse_factors
      run%system%sparse%ordering = scene%ordering
      call number_unknowns(scene%model, ties_of(scene), run%dofs)
      call make_pattern(run%dofs%n, run%dofs%element, reshape([integer ::], [2, 0]), run%pattern)
      call make_assembly(scene%model, run%dofs, run%pattern, run%assembly)
      call shape_loads(scene, run%dofs)
      run%constraint = new_constraint(scene, run%dofs)
      call initial_state(scene, run%state, fault)
      if (fault%code == 0) call prepare_contacts(scene, run%dofs, run%system%contacts, fault)
      if (fault%code == 0) call prepare_drainage(scene, run%drainage, fault)
      if (fault%code == 0) call seat_plates(scene, run%system%contacts, run%state)
      run%next = run%state
      if (fault%code == 0 .and. scene%effects%auto) call begin_watch(scene, table, run%state, run%watch)
      if (fault%code == 0 .and. scene%subtract_flow) call keep_flow(scene, run, fault)
   end subroutine prepare_run

   !> The flow of the initial state, to be subtracted from then on.
   subroutine keep_flow(scene, run, fault)
      type(scene_t), intent(in) :: scene
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(scheme_t) :: scheme

      scheme = make_scheme(DYNAMIC, 1.0_wp, 1.0_wp)
      call assemble(scene%model, run%dofs, run%pattern, scheme, run%state, run%next, .false., run%assembly)
      if (run%assembly%bad_element > 0) then
         call raise(fault, EXIT_MATERIAL, 'The initial state is refused by the material of element '// &
                    whole(run%assembly%bad_element)//'.')
         return
      end if
      where (run%dofs%field >= 3) run%constraint%offset = -run%assembly%residual
      call copy_state(run%state, run%next)
   end subroutine keep_flow

   !> All stages; what was computed before a failure is on disk.
   subroutine run_scene(scene, folder, quiet, run, fault, restart)
      type(scene_t), intent(inout) :: scene
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

      if (.not. HAS_HDF5 .and. (scene%checkpoint_steps > 0 .or. scene%checkpoint_seconds > 0.0_wp)) then
         call raise(fault, EXIT_INPUT, 'This mud_host was built without HDF5: it writes no checkpoints; leave '// &
                    'checkpoint_steps and checkpoint_seconds out, or install HDF5 and build anew.')
         return
      end if
      t0 = clock()
      if (present(restart)) call read_checkpoint(restart, scene, run, output, fault)
      if (fault%code == 0 .and. folder /= '') call open_output(folder, scene, present(restart), output, fault)
      if (fault%code /= 0) return
      if (folder /= '' .and. scene%effects%auto) call write_effects(folder, run%watch%table, fault)
      if (folder /= '' .and. run%steps == 0) then
         call write_history(output, scene, run%state, fault)
         call write_frame(folder, scene%model, run%state, output%frames, fault)
         if (fault%code /= 0) return
      end if
      call lap(run%seconds_output, t0)
      progress%quiet = quiet
      progress%last_checkpoint = t0
      do i = max(1, run%course%stage), size(scene%stages)
         call run_stage(scene, i, folder /= '', quiet, output, progress, run, fault)
         call clear_progress(progress)
         t0 = clock()
         ! Also after a failure, which is reported, not what its last output may meet.
         last = fault_t()
         if (folder /= '') call write_fields(output, scene%model, trim(scene%stages(i)%name), run%state, last)
         if (folder /= '' .and. last%code == 0) &
            call write_touching(output, scene, run%system%contacts, trim(scene%stages(i)%name), run%state, last)
         if (folder /= '' .and. last%code == 0) &
            call write_frame(folder, scene%model, run%state, output%frames, last)
         if (fault%code == 0) fault = last
         call lap(run%seconds_output, t0)
         if (fault%code /= 0) exit
      end do
      last = fault_t()
      if (folder /= '') call close_output(output, last)
      if (fault%code == 0) fault = last
      if (scene%effects%auto) call end_watch(scene, folder, quiet, run, fault)
      call release(run%system%sparse)
      run%system%analysed = .false.
   end subroutine run_scene

   !> What was seen of the effects that are off.
   subroutine end_watch(scene, folder, quiet, run, fault)
      type(scene_t), intent(in) :: scene
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
         if (run%watch%table(i)%crossed > NEVER) write (*, '(a)') '   '//warning_of(scene, run%watch%table(i))
      end do
   end subroutine end_watch

   !> Watches a step that is accepted but not yet taken over, and warns.
   subroutine look_at_effects(scene, number, dt, quiet, progress, run)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: number
      real(wp), intent(in) :: dt
      logical, intent(in) :: quiet
      type(progress_t), intent(inout) :: progress
      type(run_t), intent(inout) :: run
      logical :: news(size(run%watch%table))
      integer :: i

      call watch_step(scene, number, run%dofs, dt, run%course%t_start + scene%stages(number)%duration - run%next%time &
                      <= LAST_STEP*dt, run%ledger, run%state, run%next, run%watch, news)
      if (quiet) return
      do i = 1, size(news)
         if (.not. news(i)) cycle
         call clear_progress(progress)
         write (*, '(a)') warning_of(scene, run%watch%table(i))
      end do
   end subroutine look_at_effects

   subroutine run_stage(scene, number, with_files, quiet, output, progress, run, fault)
      type(scene_t), intent(in) :: scene
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

      associate (stage => scene%stages(number), course => run%course)
         control = control_t(stage%tolerance, stage%max_iterations, stage%still, stage%measure)
         ! A run that is taken up again is in the middle of its stage.
         call contacts_act(scene, stage, run%system%contacts)
         if (course%stage /= number) call begin_stage(scene, number, run, fault)
         if (fault%code /= 0) return
         do
            left = course%t_start + stage%duration - run%state%time
            dt = course%nominal*course%factor
            if (left <= LAST_STEP*dt) exit
            if (dt > left*(1 - LAST_STEP)) dt = left
            scheme = make_scheme(stage%kind, stage%rho_inf, dt)
            run%constraint%load_0 = load_at(scene, stage, run%dofs, run%state%time)
            run%constraint%load_1 = load_at(scene, stage, run%dofs, run%state%time + dt)
            call prescribe(scene, stage, run%state%time + dt, run, fault)
            if (fault%code /= 0) return
            call take_step(scene%model, run%dofs, run%pattern, scheme, run%constraint, control, run%state, run%next, &
                           run%assembly, run%system, log)
            run%iterations = run%iterations + log%iterations
            run%effort = run%effort + log%effort
            if (log%outcome /= CONVERGED) then
               run%cuts = run%cuts + 1
               course%cuts = course%cuts + 1
               course%good = 0
               run%system%factored = .false.
               if (course%cuts > stage%cuts .or. log%outcome == BODY_FREE .or. log%outcome == SOLVER_FAILED) then
                  call explain(scene, stage, run, log, run%state%time + dt, dt, fault)
                  return
               end if
               ! Nothing of the failed step is kept: the next attempt starts from run%state alone.
               course%factor = course%factor*merge(min(run%assembly%bad%factor, 0.5_wp), 0.5_wp, &
                                                   log%outcome == MATERIAL_FAILED)
               cycle
            end if
            course%step = course%step + 1
            run%steps = run%steps + 1
            call book_step(scene%model, run%dofs, scheme, run%constraint, run%system%reaction, run%state, run%next, &
                           run%ledger)
            if (allocated(run%system%contacts%touch)) then
               t0 = clock()
               run%ledger%contact = run%ledger%contact &
                  + work_of_contacts(run%system%contacts, run%dofs, run%state%x, run%next%x)
               call lap(run%system%seconds(6), t0)
            end if
            estimate = step_error(scheme, run%state%x, run%state%a, run%next%x, run%next%a)
            if (scene%effects%auto) call look_at_effects(scene, number, dt, quiet, progress, run)
            call copy_state(run%next, run%state)
            course%nominal = min(course%nominal*stage%dt_growth, max(stage%dt_max, stage%dt))
            course%good = course%good + 1
            if (course%good >= GOOD_STEPS .and. course%factor < 1.0_wp) then
               course%factor = min(1.0_wp, 2*course%factor)
               course%cuts = max(0, course%cuts - 1)
               course%good = 0
            end if
            t0 = clock()
            if (with_files) call write_step(scene, number, dt, log, estimate, output, progress, run, fault)
            call lap(run%seconds_output, t0)
            if (fault%code /= 0) return
            call show_progress(scene, run, progress)
         end do
         if (stage%zero_displacements) then
            run%state%x(1:2, :size(run%state%x, 2) - size(scene%model%bodies)) = 0.0_wp   ! Plates stay where they are.
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

   subroutine begin_stage(scene, number, run, fault)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: number
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      associate (stage => scene%stages(number))
         run%course = course_t(stage=number, t_start=run%state%time, nominal=stage%dt, x_start=run%state%x)
         call prescribe(scene, stage, run%state%time, run, fault)
         if (fault%code /= 0) return
         run%system%factored = .false.
         call begin_swing(run%watch)
         if (stage%kind == DYNAMIC .and. stage%solve_start) call first_accelerations(scene, stage, run, fault)
         if (fault%code /= 0) return
         run%ledger%kinetic_0 = run%ledger%kinetic_0 + kinetic_energy(scene%model, run%dofs, run%constraint%mass, &
                                                                      run%state) - run%ledger%kinetic
      end associate
   end subroutine begin_stage

   !> Prescribed unknowns of a step that ends at a time, from the state that it starts from.
   subroutine prescribe(scene, stage, time, run, fault)
      type(scene_t), intent(in) :: scene
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: time
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      call freeze_drainage(scene, run%drainage, run%system%contacts, run%state%x, fault)
      if (fault%code /= 0) return
      call constrain_step(scene, stage, run%dofs, run%drainage, time, run%course%x_start, run%constraint)
   end subroutine prescribe

   !> What is written after an accepted step.
   subroutine write_step(scene, number, dt, log, estimate, output, progress, run, fault)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: number
      real(wp), intent(in) :: dt, estimate
      type(log_t), intent(in) :: log
      type(output_t), intent(inout) :: output
      type(progress_t), intent(inout) :: progress
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      logical :: last, due

      associate (stage => scene%stages(number), course => run%course)
         last = course%t_start + stage%duration - run%state%time <= LAST_STEP*dt
         call write_ledger(output, run%state%time, dt, number, log, run%ledger, estimate, fault)
         call write_contacts(output, scene, run%system%contacts, dt, run%state, run%ledger%contact, fault)
         if (mod(course%step, stage%every) == 0 .or. last) call write_history(output, scene, run%state, fault)
         if (fault%code /= 0) return
         if (stage%fields > 0 .and. .not. last) then
            if (mod(course%step, stage%fields) == 0) &
               call write_frame(output%folder, scene%model, run%state, output%frames, fault)
         end if
         due = .false.
         if (scene%checkpoint_steps > 0) due = mod(run%steps, scene%checkpoint_steps) == 0
         if (scene%checkpoint_seconds > 0.0_wp) &
            due = clock() - progress%last_checkpoint >= scene%checkpoint_seconds .or. due
         if (.not. due .or. fault%code /= 0) return
         call write_checkpoint(scene, run, output, fault)
         progress%last_checkpoint = clock()
         ! A run that is taken up here has no factors.
         run%system%factored = .false.
      end associate
   end subroutine write_step

   subroutine first_accelerations(scene, stage, run, fault)
      type(scene_t), intent(in) :: scene
      type(stage_t), intent(in) :: stage
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(log_t) :: log

      run%constraint%load_0 = load_at(scene, stage, run%dofs, run%state%time)
      call start_accelerations(scene%model, run%dofs, run%pattern, run%constraint, run%state, run%next, run%assembly, &
                               run%system, log)
      if (log%outcome /= CONVERGED) call explain(scene, stage, run, log, run%state%time, 0.0_wp, fault)
   end subroutine first_accelerations

   !> Why a step failed for good.
   subroutine explain(scene, stage, run, log, time, dt, fault)
      type(scene_t), intent(in) :: scene
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      type(log_t), intent(in) :: log
      real(wp), intent(in) :: time, dt
      type(fault_t), intent(inout) :: fault
      character(600) :: text
      character(:), allocatable :: place
      integer :: e, node

      place = 'Stage '//trim(stage%name)//', time '//short(time)//' s, step '//short(dt)//' s: '
      associate (m => scene%model)
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
                       '), worst at '//place_of(scene, node)//'; use a smaller dt, more cuts or a better tangent.')
         end select
      end associate
   end subroutine explain

   !> Where a node is: the plate that it stands for, or an element and the point [m].
   function place_of(scene, node) result(text)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: node
      character(:), allocatable :: text
      integer :: e, i

      associate (mesh => scene%model%mesh)
         i = findloc(scene%plates%node, node, dim=1)
         if (i > 0) then
            text = 'plate '//trim(scene%plates(i)%name)
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
end module host_run
