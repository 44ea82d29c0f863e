! SPDX-License-Identifier: MIT
!> A buffer between two plates, &buffer: a spring and a dashpot on which the upper one stands or falls.
!> docs/theory/host.md section 7.8.
module buffer
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use linear_system, only: join_unknowns
   use model_types, only: model_t, problem_t
   use name_search, only: defined_name, read_stages
   use prescribed_values, only: spring_t
   use texts, only: LENGTH
   use scene_parts, only: scene_item_t, place_of
   use scene_term, only: scene_term_t
   use scene_types, only: item_of
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: buffer_t

   !> What a group of the scene says.
   type, extends(scene_item_t) :: given_t
      character(LENGTH) :: upper = '', lower = ''    !< Names of the plates.
      integer :: plates(2) = 0                       !< Places of the upper and the lower one.
      logical, allocatable :: in_stage(:)            !< (stages) Whether it acts in it.
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
      call read_stages(k, model, one%in_stage)
      if (k%lists) return
      one%scene_item_t = item_of(k%group)
      one%plates(1) = defined_name('upper', one%upper, model%plates%name, place_of(one), fault)
      if (fault%code == 0) one%plates(2) = defined_name('lower', one%lower, model%plates%name, place_of(one), fault)
      if (fault%code /= 0) return
      if (one%upper == one%lower) call raise(fault, EXIT_INPUT, place_of(one)//'upper and lower are both '''// &
         trim(one%upper)//'''; name the two plates that the buffer lies between.')
      i = findloc(one%in_stage .and. model%stages%zero_displacements, .true., dim=1)
      if (i > 0 .and. any(model%plates(one%plates)%group > 0) .and. fault%code == 0) &
         call raise(fault, EXIT_INPUT, place_of(one)//'stage '''//trim(model%stages(i)%name)// &
                    ''' zeroes its displacements, also of a plate that is joined to a boundary, which would '// &
                    'change the force of the buffer; name the stages of the buffer.')
      model%plates(one%plates(2))%on_buffer = .true.
      if (.not. allocated(self%all)) allocate (self%all(0))
      self%all = [self%all, one]
      self%wanted = .true.
   end subroutine build_group

   !> Springs between the unknowns of the plates, which meet in the matrix from now on.
   subroutine begin_run(self, problem, fault)
      class(buffer_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      integer :: pairs(2, size(self%all)), i

      do i = 1, size(self%all)
         associate (spring => self%all(i)%spring)
            spring%upper = problem%dofs%of(AT_U_Z, problem%model%plates(self%all(i)%plates(1))%node)
            spring%lower = problem%dofs%of(AT_U_Z, problem%model%plates(self%all(i)%plates(2))%node)
            pairs(:, i) = [spring%upper, spring%lower]
            problem%constraint%springs = [problem%constraint%springs, spring]
            self%all(i)%place = size(problem%constraint%springs)
         end associate
      end do
      call join_unknowns(problem, pairs)
   end subroutine begin_run

   subroutine begin_stage(self, begins, problem, fault)
      class(buffer_t), intent(inout) :: self
      logical, intent(in) :: begins
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(self%all)
         associate (one => self%all(i))
            problem%constraint%springs(one%place)%acts = one%in_stage(problem%at%stage)
         end associate
      end do
   end subroutine begin_stage
end module buffer
