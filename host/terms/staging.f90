! SPDX-License-Identifier: MIT
!> Parts of the ground that join or leave between stages, the key stages of &region: which elements a stage has, what
!> those that left held up, and unknowns that no element has. docs/theory/host.md section 14.
module staging
   use kinds, only: wp
   use acting_places, only: nodes_of_ground
   use degrees_of_freedom, only: dofs_t, of_unknowns
   use equation_assembly, only: assembly_t, make_assembly, assemble
   use exit_codes, only: EXIT_MATERIAL
   use faults, only: fault_t, raise, EXIT_INPUT
   use generalised_alpha, only: make_scheme, STATIC
   use key_table, only: key_table_t
   use model_types, only: model_t, problem_t, gravity_at, share_over
   use name_search, only: read_stages
   use porous_domain, only: model_state_t, copy_state
   use scene_parts, only: place_of
   use scene_term, only: scene_term_t
   use texts, only: whole
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: staging_t

   type, extends(scene_term_t) :: staging_t
      real(wp), allocatable :: held_up(:)   !< (unknowns) Forces at the start of what leaves with this stage [kN].
      logical, allocatable :: absent(:)     !< (unknowns) No present element has them.
   contains
      procedure :: build_group, build, begin_run, begin_stage, before_step, prescribe
   end type staging_t
contains
   !> Notes which elements of a region the stages have. Raises no fault.
   subroutine build_group(self, k, number, model, fault)
      class(staging_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      logical, allocatable :: in_stage(:)
      integer :: s

      call read_stages(k, model, in_stage, 'stages in which it is part of the ground; default: all')
      if (k%lists .or. .not. k%given('stages')) return
      if (.not. allocated(model%ground)) &
         allocate (model%ground(size(model%domain%region_of), size(model%stages)), source=.true.)
      do s = 1, size(model%stages)
         if (.not. in_stage(s)) model%ground(:, s) = model%ground(:, s) .and. model%domain%region_of /= number
      end do
   end subroutine build_group

   !> Fault EXIT_INPUT: ground that is not there from the start with a stress of its own, or the flow of a start that
   !> lacks it; a stage without ground.
   subroutine build(self, model, fault)
      class(staging_t), intent(inout) :: self
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: s

      self%wanted = allocated(model%ground)
      if (.not. self%wanted) return
      if (model%subtract_flow) then
         call raise(fault, EXIT_INPUT, trim(model%origin%file)//': initial_flow = ''subtract'' of &scene keeps the '// &
                    'flow of the ground at the start, but regions join or leave (stages of &region); leave one '// &
                    'of them out.')
         return
      end if
      do s = 1, size(model%stages)
         if (.not. any(nodes_of_ground(model, s)) .and. fault%code == 0) call raise(fault, EXIT_INPUT, &
            trim(model%origin%file)//': no &region is part of the ground in stage '''// &
            trim(model%stages(s)%name)//'''.')
      end do
      if (fault%code == 0) call check_start(model, fault)
   end subroutine build

   !> New ground comes without stress.
   subroutine check_start(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i, k

      do i = 1, size(model%initials)
         associate (initial => model%initials(i))
            if (.not. (initial%geostatic .or. initial%uniform)) cycle
            do k = 1, size(model%domain%region_of)
               if (model%ground(k, 1)) cycle
               if (.not. any(model%domain%mesh%groups(initial%group)%elements == k)) cycle
               call raise(fault, EXIT_INPUT, place_of(initial)//'this stress covers the &region with group '''// &
                          trim(model%regions(model%domain%region_of(k))%group_name)//''', which joins in a later '// &
                          'stage and comes without stress; name the group of the ground that is there from the start.')
               return
            end do
         end associate
      end do
   end subroutine check_start

   !> Sets the elements of the first stage, of which none joins.
   subroutine begin_run(self, problem, fault)
      class(staging_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault

      problem%state%present = problem%model%ground(:, 1)
      problem%state%joins = spread(.false., 1, size(problem%state%present))
   end subroutine begin_run

   !> Sets the elements of a stage, which join with it and which leave, and the forces that those held up; where a run
   !> is taken up within the stage, from the unknowns at its start. docs/theory/host.md section 14. Fault EXIT_MATERIAL:
   !> the material of an element that leaves refuses its own state at rest.
   subroutine begin_stage(self, begins, problem, fault)
      class(staging_t), intent(inout) :: self
      logical, intent(in) :: begins
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      integer :: i, f

      associate (state => problem%state, before => problem%model%ground(:, max(1, problem%at%stage - 1)))
         state%present = problem%model%ground(:, problem%at%stage)
         state%joins = state%present .and. .not. before
         call find_held_up(self, state%present .or. .not. before, problem, fault)
         if (fault%code /= 0) return
         call mark_absent(problem%dofs, state%present, self%absent)
         do i = 1, merge(problem%dofs%n, 0, begins)
            if (.not. self%absent(i)) cycle
            f = problem%dofs%field(i)
            state%v(f, problem%dofs%node(i)) = 0.0_wp
            if (f <= DISPLACEMENTS) state%a(f, problem%dofs%node(i)) = 0.0_wp
         end do
         state%growth = share_over(problem, state%time)
         call copy_state(state, problem%next)
      end associate
   end subroutine begin_stage

   !> Finds what the elements that leave hold up on the nodes around them: their internal forces and weight where the
   !> stage begins. Their points stand still, so that a run that is taken up finds the same.
   subroutine find_held_up(self, stays, problem, fault)
      class(staging_t), intent(inout) :: self
      logical, intent(in) :: stays(:)      !< (elements) Or has not been there.
      type(problem_t), intent(in) :: problem
      type(fault_t), intent(inout) :: fault
      type(model_state_t) :: at_start, same
      type(assembly_t) :: assembly
      integer :: i

      self%held_up = [(0.0_wp, i=1, problem%dofs%n)]
      if (all(stays)) return
      at_start = problem%state
      at_start%x = problem%at%x_start
      at_start%v = 0.0_wp
      at_start%a = 0.0_wp
      at_start%present = .not. stays
      at_start%joins = .false.
      at_start%gravity = gravity_at(problem%model, problem%at%t_start)
      same = at_start
      ! Laws that change with time are those of the start of the stage.
      if (allocated(problem%next%laws)) same%laws = problem%next%laws
      call make_assembly(problem%domain, problem%dofs, problem%pattern, assembly)
      call assemble(problem%domain, problem%dofs, problem%pattern, make_scheme(STATIC, 1.0_wp, 1.0_wp), at_start, &
                    same, .false., assembly)
      if (assembly%bad_element > 0) call raise(fault, EXIT_MATERIAL, 'The material of element '// &
         whole(assembly%bad_element)//', which leaves, refuses its own state at rest.')
      where (problem%dofs%field <= DISPLACEMENTS) self%held_up = assembly%residual
   end subroutine find_held_up

   !> Marks unknowns that elements have, but none that is present.
   pure subroutine mark_absent(dofs, present, absent)
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: present(:)   !< (elements)
      logical, allocatable, intent(out) :: absent(:)

      allocate (absent(dofs%n), source=.false.)
      associate (own => dofs%element, there => spread(present, 1, size(dofs%element, 1)))
         absent(pack(own, own > 0)) = .true.
         absent(pack(own, own > 0 .and. there)) = .false.
      end associate
   end subroutine mark_absent

   !> What is left of the forces that hold up fades over the stage, and the weight of what joins grows.
   subroutine before_step(self, dt, problem, fault)
      class(staging_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault

      associate (c => problem%constraint, now => problem%state%time)
         c%load_0 = c%load_0 - (1 - share_over(problem, now))*self%held_up
         c%load_1 = c%load_1 - (1 - share_over(problem, now + dt))*self%held_up
         problem%next%growth = share_over(problem, now + dt)
      end associate
   end subroutine before_step

   !> Unknowns that no present element has stay as they are.
   subroutine prescribe(self, time, problem)
      class(staging_t), intent(in) :: self
      real(wp), intent(in) :: time
      type(problem_t), intent(inout) :: problem

      associate (c => problem%constraint, dofs => problem%dofs)
         where (self%absent)
            c%fixed = .true.
            c%target = of_unknowns(dofs, problem%state%x)
         end where
         c%air(pack(dofs%node, self%absent .and. dofs%field > DISPLACEMENTS)) = .false.
      end associate
   end subroutine prescribe
end module staging
