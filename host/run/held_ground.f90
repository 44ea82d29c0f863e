! SPDX-License-Identifier: MIT
!> The ground behind an absorbing boundary at rest: when the boundary begins to act, the forces that it held before
!> stay, so that only what departs from that state leaves as a wave; and the flow of the initial state, where it is to
!> be kept up. docs/theory/host.md sections 7.4 and 8.
module held_ground
   use kinds, only: wp
   use absorbing_boundaries, only: absorber_acts, switch_absorbers, add_incoming
   use ground_stages, only: acting_load
   use equation_assembly, only: assemble
   use exit_codes, only: EXIT_MATERIAL
   use faults, only: fault_t, raise
   use generalised_alpha, only: make_scheme, STATIC, DYNAMIC
   use model_types, only: model_t
   use porous_domain, only: copy_state
   use run_state, only: run_t
   use texts, only: whole
   use unknown_fields, only: DISPLACEMENTS
   use scene_types, only: stage_t
   implicit none (type, external)
   private
   public :: hold_ground, set_incoming_waves, keep_flow
contains
   !> Sets the forces on boundaries that act in a stage and did not in the one before, and frees them of those that no
   !> longer act. docs/theory/host.md section 7.4. Fault EXIT_MATERIAL: a material refuses its own state at rest.
   subroutine hold_ground(model, number, run, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number      !< Of the stage that begins.
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      logical :: now(size(model%absorbers)), before(size(model%absorbers))
      real(wp), allocatable :: missing(:)
      integer :: i

      now = [(absorber_acts(model%absorbers(i), model%stages(number)), i=1, size(now))]
      before = .false.
      if (number > 1) before = [(absorber_acts(model%absorbers(i), model%stages(number - 1)), i=1, size(now))]
      do i = 1, size(now)
         if (before(i) .and. .not. now(i)) where (run%constraint%dashpots(i)%held) run%constraint%offset = 0.0_wp
      end do
      if (.not. any(now .and. .not. before)) return
      call copy_state(run%state, run%next)
      run%next%v = 0.0_wp
      run%next%a = 0.0_wp
      run%assembly%air = .false.
      call assemble(model%domain, model%dofs, run%pattern, make_scheme(STATIC, 1.0_wp, 1.0_wp), run%state, run%next, &
                    .false., run%assembly)
      if (run%assembly%bad_element > 0) then
         call raise(fault, EXIT_MATERIAL, 'Stage '//trim(model%stages(number)%name)//': the material of element '// &
                    whole(run%assembly%bad_element)//' refuses its own state at rest.')
         return
      end if
      missing = acting_load(model, model%stages(number), run, run%state%time) - run%assembly%residual
      do i = 1, size(now)
         if (now(i) .and. .not. before(i)) where (run%constraint%dashpots(i)%held) run%constraint%offset = missing
      end do
      call copy_state(run%state, run%next)
   end subroutine hold_ground

   !> Which boundaries act in a step, and the forces of the waves that come in at its ends. docs/theory/host.md section
   !> 7.4.
   subroutine set_incoming_waves(model, stage, dt, run)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: dt   !< [s]
      type(run_t), intent(inout) :: run

      associate (c => run%constraint)
         call switch_absorbers(model, stage, c%dashpots)
         call add_incoming(model, stage, c%dashpots, run%state%time, c%load_0)
         call add_incoming(model, stage, c%dashpots, run%state%time + dt, c%load_1)
      end associate
   end subroutine set_incoming_waves

   !> The flow of the initial state, to be subtracted from then on. docs/theory/host.md section 8. Fault EXIT_MATERIAL:
   !> a material refuses the initial state.
   subroutine keep_flow(model, run, fault)
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      call assemble(model%domain, model%dofs, run%pattern, make_scheme(DYNAMIC, 1.0_wp, 1.0_wp), run%state, run%next, &
                    .false., run%assembly)
      if (run%assembly%bad_element > 0) then
         call raise(fault, EXIT_MATERIAL, 'The initial state is refused by the material of element '// &
                    whole(run%assembly%bad_element)//'.')
         return
      end if
      where (model%dofs%field > DISPLACEMENTS) run%constraint%offset = -run%assembly%residual
      run%next = run%state
   end subroutine keep_flow
end module held_ground
