! SPDX-License-Identifier: MIT
!> A buffer between two plates, &buffer: a spring and a dashpot on which the upper one stands or falls.
!> docs/theory/host.md section 7.8.
module buffer
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use linear_system, only: join_unknowns
   use model_types, only: model_t
   use name_search, only: defined_name, check_stages
   use namelists, only: group_t
   use texts, only: LENGTH
   use scene_parts, only: scene_item_t, place_of, acts_in
   use scene_term, only: scene_term_t
   use scene_types, only: scene_t, item_of, groups_named
   use solution, only: solution_t
   use springs, only: spring_t
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: buffer_t

   character(*), parameter :: NAME = 'buffer'

   !> What a group of the scene says.
   type, extends(scene_item_t) :: given_t
      character(LENGTH) :: upper = '', lower = ''    !< Plates.
      character(LENGTH), allocatable :: stages(:)
      type(spring_t) :: spring
   end type given_t

   type, extends(scene_term_t) :: buffer_t
      type(given_t), allocatable :: all(:)
      integer, allocatable :: plates(:, :)           !< (2, buffers) Upper and lower ones.
   contains
      procedure, nopass :: declare
      procedure :: group, build, begin_run, begin_stage
   end type buffer_t
contains
   function group(self) result(name_of_group)
      class(buffer_t), intent(in) :: self
      character(:), allocatable :: name_of_group

      name_of_group = NAME
   end function group

   subroutine declare(k)
      type(key_table_t), intent(inout) :: k
      type(given_t) :: nothing

      if (k%group%name == NAME) call take(k, nothing)
   end subroutine declare

   subroutine take(k, one)
      type(key_table_t), intent(inout) :: k
      type(given_t), intent(inout) :: one

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
   end subroutine take

   !> Fault EXIT_GROUP: a plate or stage that is not defined. EXIT_INPUT: one plate at both ends.
   subroutine build(self, scene, model, there, fault)
      class(buffer_t), intent(inout) :: self
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      logical, intent(out) :: there
      type(fault_t), intent(inout) :: fault
      type(group_t), allocatable :: groups(:)
      type(key_table_t) :: table
      integer :: i

      allocate (groups, source=groups_named(scene, NAME))
      there = size(groups) > 0
      allocate (self%all(size(groups)), self%plates(2, size(groups)))
      do i = 1, size(groups)
         associate (one => self%all(i))
            one%scene_item_t = item_of(groups(i))
            table%group = groups(i)
            call take(table, one)
            self%plates(1, i) = defined_name('upper', one%upper, model%plates%name, place_of(one), fault)
            if (fault%code == 0) &
               self%plates(2, i) = defined_name('lower', one%lower, model%plates%name, place_of(one), fault)
            call check_stages(model%stages%name, one%scene_item_t, one%stages, fault)
            if (fault%code /= 0) return
            if (one%upper == one%lower) call raise(fault, EXIT_INPUT, place_of(one)//'upper and lower are both '''// &
               trim(one%upper)//'''; name the two plates that the buffer lies between.')
         end associate
      end do
   end subroutine build

   !> Springs between the unknowns of the plates, which meet in the matrix from now on.
   subroutine begin_run(self, model, solution, fault)
      class(buffer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(solution_t), intent(inout) :: solution
      type(fault_t), intent(inout) :: fault
      integer :: pairs(2, size(self%all)), i

      do i = 1, size(self%all)
         associate (spring => self%all(i)%spring)
            spring%upper = model%dofs%of(AT_U_Z, model%plates(self%plates(1, i))%node)
            spring%lower = model%dofs%of(AT_U_Z, model%plates(self%plates(2, i))%node)
            pairs(:, i) = [spring%upper, spring%lower]
         end associate
      end do
      solution%constraint%springs = self%all%spring
      call join_unknowns(model%dofs, pairs, solution%system, solution%pattern, solution%assembly)
   end subroutine begin_run

   subroutine begin_stage(self, model, begins, solution, fault)
      class(buffer_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      logical, intent(in) :: begins
      type(solution_t), intent(inout) :: solution
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(self%all)
         solution%constraint%springs(i)%acts = acts_in(self%all(i)%stages, model%stages(solution%at%stage)%name)
      end do
   end subroutine begin_stage
end module buffer
