! SPDX-License-Identifier: MIT
!> Parts of the ground that join or leave between stages: which elements a stage has, what those that left held up, and
!> unknowns that no element has. docs/theory/host.md section 14.
module ground_stages
   use kinds, only: wp
   use boundary_loads, only: load_at
   use degrees_of_freedom, only: dofs_t
   use element_equations, only: element_t, compute_element, element_size
   use carried_slopes, only: slopes_t
   use exit_codes, only: EXIT_MATERIAL
   use faults, only: fault_t, raise
   use generalised_alpha, only: make_scheme, STATIC
   use model_types, only: model_t, gravity_at
   use porous_domain, only: state_t, copy_state
   use prescribed_values, only: constraint_t
   use run_state, only: run_t
   use scene_types, only: stage_t
   use staged_ground, only: ground_of
   use texts, only: whole
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: change_ground, growth_at, acting_load, fix_absent_unknowns
contains
   !> The elements of a stage, which join with it and which leave, and the forces that those held up; also where a run
   !> is taken up within the stage, from run%at%x_start. docs/theory/host.md section 14. Fault EXIT_MATERIAL: the
   !> material of an element that leaves refuses its own state at rest.
   subroutine change_ground(model, number, begins, run, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number        !< Of the stage.
      logical, intent(in) :: begins        !< Else the run is in the middle of it.
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      logical :: before(size(model%domain%region_of))
      integer :: i, f

      if (.not. allocated(run%state%present)) return
      before = ground_of(model, max(1, number - 1))
      associate (state => run%state)
         state%present = ground_of(model, number)
         state%joins = state%present .and. .not. before
         call find_held_up(model, state%present .or. .not. before, run, fault)
         if (fault%code /= 0) return
         call mark_absent(model%dofs, state%present, run%at%absent)
      end associate
      if (begins) then
         do i = 1, model%dofs%n
            if (.not. run%at%absent(i)) cycle
            f = model%dofs%field(i)
            run%state%v(f, model%dofs%node(i)) = 0.0_wp
            if (f <= DISPLACEMENTS) run%state%a(f, model%dofs%node(i)) = 0.0_wp
         end do
      end if
      run%state%growth = growth_at(model%stages(number), run, run%state%time)
      call copy_state(run%state, run%next)
   end subroutine change_ground

   !> What the elements that leave hold up on the nodes around them: their internal forces and weight where the stage
   !> begins. Their points stand still, so that a run that is taken up finds the same.
   subroutine find_held_up(model, stays, run, fault)
      type(model_t), intent(in) :: model
      logical, intent(in) :: stays(:)      !< (elements) Or has not been there.
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(state_t) :: at_start, same
      type(slopes_t) :: slopes
      type(element_t) :: out
      integer :: e, i, at

      run%at%held_up = [(0.0_wp, i=1, model%dofs%n)]
      if (all(stays)) return
      at_start = run%state
      at_start%x = run%at%x_start
      at_start%v = 0.0_wp
      at_start%a = 0.0_wp
      at_start%joins = .false.
      at_start%gravity = gravity_at(model, run%at%t_start)
      same = at_start
      ! Laws that change with time are those of the start of the stage.
      if (allocated(run%next%laws)) same%laws = run%next%laws
      do e = 1, size(stays)
         if (stays(e)) cycle
         call compute_element(model%domain, e, make_scheme(STATIC, 1.0_wp, 1.0_wp), at_start, same, .false., slopes, &
                              out)
         if (out%bad_point > 0) then
            call raise(fault, EXIT_MATERIAL, 'The material of element '//whole(e)//', which leaves, refuses its '// &
                       'own state at rest.')
            return
         end if
         do i = 1, element_size(model%domain, e)
            at = model%dofs%element(i, e)
            if (at == 0) cycle
            if (model%dofs%field(at) <= DISPLACEMENTS) run%at%held_up(at) = run%at%held_up(at) + out%r(i)
         end do
      end do
   end subroutine find_held_up

   !> Unknowns that elements have, but none that is present.
   pure subroutine mark_absent(dofs, present, absent)
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: present(:)   !< (elements)
      logical, allocatable, intent(out) :: absent(:)
      integer :: e, i, pass

      allocate (absent(dofs%n), source=.false.)
      do pass = 1, 2
         do e = 1, size(present)
            if (present(e) .neqv. pass == 2) cycle
            do i = 1, size(dofs%element, 1)
               if (dofs%element(i, e) > 0) absent(dofs%element(i, e)) = pass == 1
            end do
         end do
      end do
   end subroutine mark_absent

   !> Share of a stage that is over: of the weight of what joins. [-]
   pure real(wp) function growth_at(stage, run, time) result(share)
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: time   !< [s]

      share = min(1.0_wp, max(0.0_wp, (time - run%at%t_start)/stage%duration))
   end function growth_at

   !> Loads at a time, without what is left of the forces that hold up and of sudden loads that are applied evenly: both
   !> fade over the stage. (unknowns) [kN, m3/s]
   function acting_load(model, stage, run, time) result(load)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: time   !< [s]
      real(wp), allocatable :: load(:)

      load = load_at(model, stage, model%dofs, time)
      if (allocated(run%at%held_up)) load = load - (1 - growth_at(stage, run, time))*run%at%held_up
      if (allocated(run%at%sudden)) load = load - (1 - growth_at(stage, run, time))*run%at%sudden
   end function acting_load

   !> Unknowns that no present element has stay as they are.
   pure subroutine fix_absent_unknowns(dofs, run, constraint)
      type(dofs_t), intent(in) :: dofs
      type(run_t), intent(in) :: run
      type(constraint_t), intent(inout) :: constraint
      integer :: i

      if (.not. allocated(run%at%absent)) return
      do i = 1, dofs%n
         if (.not. run%at%absent(i)) cycle
         constraint%fixed(i) = .true.
         constraint%limited(i) = .false.
         constraint%target(i) = run%state%x(dofs%field(i), dofs%node(i))
         if (dofs%field(i) > DISPLACEMENTS) constraint%air(dofs%node(i)) = .false.
      end do
   end subroutine fix_absent_unknowns
end module ground_stages
