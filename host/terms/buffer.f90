! SPDX-License-Identifier: MIT
!> A buffer between two plates, &buffer: a spring and a dashpot on which the upper one stands or falls.
!> docs/theory/host.md section 7.8.
module buffer
   use added_forces, only: added_forces_t, added_box_t
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use faults, only: fault_t, raise, EXIT_INPUT
   use generalised_alpha, only: scheme_t
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use linear_system, only: join_unknowns
   use model_types, only: model_t, problem_t
   use name_search, only: defined_name
   use texts, only: LENGTH
   use porous_domain, only: model_state_t
   use scene_parts, only: scene_item_t, place_of, acts_in
   use scene_term, only: scene_term_t
   use scene_types, only: item_of
   use sparsity_pattern, only: pattern_t, place_of_entry => place_of
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: buffer_t

   !> A spring with a dashpot between two unknowns, which pushes and, if it is to, pulls.
   type, extends(added_forces_t) :: spring_t
      logical :: pulls = .false.                 !< Else its ends may part.
      integer :: upper = 0, lower = 0            !< Unknowns of its ends.
      real(wp) :: stiffness = 0.0_wp             !< [kN/m]
      real(wp) :: damping = 0.0_wp               !< In dynamic steps [kN s/m].
      real(wp) :: clearance = 0.0_wp             !< Between the ends at the start [m].
   contains
      procedure :: add, add_means
   end type spring_t

   !> What a group of the scene says.
   type, extends(scene_item_t) :: given_t
      character(LENGTH) :: upper = '', lower = ''    !< Names of the plates.
      integer :: plates(2) = 0                       !< Places of the upper and the lower one.
      character(LENGTH), allocatable :: stages(:)
      type(spring_t) :: spring
      integer :: place = 0                           !< Place of the spring in the constraint.
   end type given_t

   type, extends(scene_term_t) :: buffer_t
      type(given_t), allocatable :: all(:)
   contains
      procedure :: build_group, begin_run, begin_stage
   end type buffer_t
contains
   !> Fault EXIT_GROUP: a plate that is not defined. EXIT_INPUT: one plate at both ends.
   subroutine build_group(self, k, number, model, fault)
      class(buffer_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(given_t) :: one
      integer :: i

      call k%text('upper', one%upper, 'name of the &plate above: a mass that falls or stands', REQUIRED)
      call k%text('lower', one%lower, 'name of the &plate below it', REQUIRED)
      call k%number('stiffness', one%spring%stiffness, 0.0_wp, UNBOUNDED, 'force of a unit of shortening [kN/m]', &
                    REQUIRED)
      call k%number('damping', one%spring%damping, 0.0_wp, UNBOUNDED, &
                    'force of a unit of its velocity, in dynamic stages [kN s/m]')
      call k%number('clearance', one%spring%clearance, 0.0_wp, UNBOUNDED, &
                    'way of the upper plate to the end of the spring at the start [m]', 'tension=no')
      call k%flag('tension', one%spring%pulls, 'no|yes', 'yes', 'yes: the plates are joined; no: they may part')
      call k%texts('stages', one%stages, 'names of stages; default: all')
      if (k%lists) return
      one%scene_item_t = item_of(k%group)
      one%plates(1) = defined_name('upper', one%upper, model%plates%name, place_of(one), fault)
      if (fault%code == 0) one%plates(2) = defined_name('lower', one%lower, model%plates%name, place_of(one), fault)
      if (fault%code /= 0) return
      if (one%upper == one%lower) call raise(fault, EXIT_INPUT, place_of(one)//'upper and lower are both '''// &
         trim(one%upper)//'''; name the two plates that the buffer lies between.')
      do i = 1, size(model%stages)
         if (fault%code /= 0 .or. all(model%plates(one%plates)%group == 0)) exit
         if (model%stages(i)%zero_displacements .and. acts_in(one%stages, model%stages(i)%name)) &
            call raise(fault, EXIT_INPUT, place_of(one)//'stage '''//trim(model%stages(i)%name)// &
                       ''' zeroes its displacements, also of a plate that is joined to a boundary, which would '// &
                       'change the force of the buffer; name the stages of the buffer.')
      end do
      if (.not. allocated(self%all)) allocate (self%all(0))
      self%all = [self%all, one]
      self%wanted = .true.
   end subroutine build_group

   !> Springs between the unknowns of the plates, which meet in the matrix from now on.
   subroutine begin_run(self, problem, fault)
      class(buffer_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      type(added_box_t) :: box
      integer :: pairs(2, size(self%all)), i

      do i = 1, size(self%all)
         associate (spring => self%all(i)%spring)
            spring%upper = problem%model%dofs%of(AT_U_Z, problem%model%plates(self%all(i)%plates(1))%node)
            spring%lower = problem%model%dofs%of(AT_U_Z, problem%model%plates(self%all(i)%plates(2))%node)
            pairs(:, i) = [spring%upper, spring%lower]
            box%it = spring
            problem%constraint%added = [problem%constraint%added, box]
            self%all(i)%place = size(problem%constraint%added)
         end associate
      end do
      call join_unknowns(problem%model%dofs, pairs, problem%system, problem%pattern, problem%assembly)
   end subroutine begin_run

   subroutine begin_stage(self, begins, problem, fault)
      class(buffer_t), intent(inout) :: self
      logical, intent(in) :: begins
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(self%all)
         associate (one => self%all(i))
            problem%constraint%added(one%place)%it%acts = acts_in(one%stages, problem%stage%name)
         end associate
      end do
   end subroutine begin_stage

   !> Adds forces at the levels of their displacements and velocities, and the slopes. docs/theory/host.md section 7.8.
   subroutine add(self, dofs, pattern, scheme, old, new, slopes, assembly)
      class(spring_t), intent(in) :: self
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: old, new
      logical, intent(in) :: slopes
      type(assembly_t), intent(inout) :: assembly
      real(wp) :: u0, u1, v0, v1, force, before, slope
      integer :: a, b, ends(2), signs(2)

      call shortening(self, dofs, old, u0, v0)
      call shortening(self, dofs, new, u1, v1)
      force = 0.0_wp
      if (may_push(self, scheme, u0, v0)) force = push(self, scheme, u0 + scheme%l_f*(u1 - u0), &
                                                       v0 + scheme%l_v*(v1 - v0))
      before = force_at(self, scheme, u0, v0)
      ends = [self%upper, self%lower]
      signs = [-1, 1]
      assembly%residual(ends) = assembly%residual(ends) + signs*force
      assembly%scale(ends) = assembly%scale(ends) + abs(force)
      if (assembly%with_change) assembly%change(ends) = assembly%change(ends) + abs(force - before)
      if (.not. slopes .or. .not. (abs(force) > 0.0_wp .or. self%pulls)) return
      slope = self%stiffness*scheme%l_f
      if (scheme%has_inertia) slope = slope + self%damping*scheme%c_v
      do a = 1, 2
         do b = 1, 2
            associate (value => assembly%values(place_of_entry(pattern, ends(a), ends(b))))
               value = value + signs(a)*signs(b)*slope
            end associate
         end do
      end do
   end subroutine add

   subroutine add_means(self, dofs, scheme, old, new, force)
      class(spring_t), intent(in) :: self
      type(dofs_t), intent(in) :: dofs
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: old, new
      real(wp), intent(inout) :: force(:)
      real(wp) :: u, v, mean

      call shortening(self, dofs, old, u, v)
      mean = force_at(self, scheme, u, v)
      call shortening(self, dofs, new, u, v)
      mean = 0.5_wp*(mean + force_at(self, scheme, u, v))
      force(self%upper) = force(self%upper) - mean
      force(self%lower) = force(self%lower) + mean
   end subroutine add_means

   !> By how much, and how fast, the ends have come nearer than the clearance [m, m/s].
   pure subroutine shortening(one, dofs, state, u, v)
      class(spring_t), intent(in) :: one
      type(dofs_t), intent(in) :: dofs
      type(model_state_t), intent(in) :: state
      real(wp), intent(out) :: u, v

      associate (f => dofs%field(one%upper), g => dofs%field(one%lower), a => dofs%node(one%upper), &
                 b => dofs%node(one%lower))
         u = state%x(g, b) - state%x(f, a) - one%clearance
         v = state%v(g, b) - state%v(f, a)
      end associate
   end subroutine shortening

   !> Whether a step that begins so may bring ends together. A dashpot that came and went with an iterate would let no
   !> iteration end: so that is known before, where one acts.
   pure logical function may_push(one, scheme, u, v)
      class(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< At the start of the step [m, m/s].

      may_push = one%pulls .or. .not. one%damping > 0.0_wp .or. .not. scheme%has_inertia .or. u > 0.0_wp
      ! The accelerations of a start belong to no step.
      if (.not. may_push .and. scheme%l_f > 0.0_wp) may_push = u + scheme%dt*v > 0.0_wp
   end function may_push

   !> Force between the ends, pushing positive; none where they are apart [kN].
   pure real(wp) function force_at(one, scheme, u, v) result(force)
      class(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< [m, m/s]

      force = 0.0_wp
      if (one%pulls .or. u > 0.0_wp) force = push(one, scheme, u, v)
   end function force_at

   !> Force between ends that have met, pushing positive [kN].
   pure real(wp) function push(one, scheme, u, v) result(force)
      class(spring_t), intent(in) :: one
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: u, v   !< [m, m/s]

      force = one%stiffness*u
      if (scheme%has_inertia) force = force + one%damping*v
      if (.not. one%pulls) force = max(0.0_wp, force)
   end function push
end module buffer
