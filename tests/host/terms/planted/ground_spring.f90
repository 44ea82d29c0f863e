! SPDX-License-Identifier: MIT
!> Springs to ground, &spring: every node of a group is held by k times its displacement, in both directions. A term of
!> one file and one line of the registry, which a test gives to mud_host.
module ground_spring
   use kinds, only: wp
   use faults, only: fault_t
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use prescribed_values, only: linear_forces_t
   use model_types, only: model_t, problem_t, action_t
   use name_search, only: mesh_group, read_stages
   use texts, only: LENGTH
   use scene_parts, only: place_of
   use scene_term, only: scene_term_t
   use scene_types, only: item_of
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: ground_spring_t

   character(*), parameter :: NAME = 'spring'

   type, extends(action_t) :: spring_t
      real(wp) :: stiffness = 0.0_wp   !< Force over displacement of a node [kN/m].
      integer :: place = 0             !< Place of the spring in the constraint.
   end type spring_t

   type, extends(scene_term_t) :: ground_spring_t
      type(spring_t), allocatable :: springs(:)
   contains
      procedure :: build_group, begin_run, before_step
   end type ground_spring_t
contains
   !> Fault EXIT_GROUP: a group that is not defined.
   subroutine build_group(self, k, number, model, fault)
      class(ground_spring_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(spring_t) :: spring
      character(LENGTH) :: boundary

      boundary = ''
      call k%text('group', boundary, 'nodes that the springs hold', REQUIRED)
      call k%number('stiffness', spring%stiffness, 0.0_wp, UNBOUNDED, 'force on a node over its displacement [kN/m]', &
                    REQUIRED)
      call read_stages(k, model, spring%in_stage)
      if (k%lists) return
      spring%scene_item_t = item_of(k%group)
      spring%what = '&'//NAME
      spring%group = mesh_group(model%domain%mesh, boundary, place_of(spring), fault)
      if (fault%code /= 0) return
      model%actions = [model%actions, spring%action_t]
      if (.not. allocated(self%springs)) allocate (self%springs(0))
      self%springs = [self%springs, spring]
      self%wanted = .true.
   end subroutine build_group

   !> An entry on the diagonal for every displacement. Raises no fault.
   subroutine begin_run(self, problem, fault)
      class(ground_spring_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      type(linear_forces_t) :: force
      integer, allocatable :: at(:)
      integer :: i

      allocate (at(0))
      do i = 1, size(self%springs)
         associate (nodes => problem%model%domain%mesh%groups(self%springs(i)%group)%nodes)
            at = pack(problem%model%dofs%of(:DISPLACEMENTS, nodes), problem%model%dofs%of(:DISPLACEMENTS, nodes) > 0)
         end associate
         ! A variable, since gfortran leaks components of a constructor within an array.
         force = linear_forces_t(.false., .false., at, at, spread(self%springs(i)%stiffness, 1, size(at)))
         problem%constraint%linear = [problem%constraint%linear, force]
         self%springs(i)%place = size(problem%constraint%linear)
      end do
   end subroutine begin_run

   !> Raises no fault.
   subroutine before_step(self, dt, problem, fault)
      class(ground_spring_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(self%springs)
         problem%constraint%linear(self%springs(i)%place)%acts = self%springs(i)%in_stage(problem%at%stage)
      end do
   end subroutine before_step
end module ground_spring
