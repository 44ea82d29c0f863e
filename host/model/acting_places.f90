! SPDX-License-Identifier: MIT
!> Where something acts on the ground of a stage: on which side of an edge that lies, and whether it is there.
!> docs/theory/host.md section 14.
module acting_places
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise
   use generalised_alpha, only: has_inertia
   use model_types, only: model_t, action_t
   use scene_parts, only: acts_in, place_of, NAME_LENGTH
   use texts, only: short
   implicit none (type, external)
   private
   public :: facing_edges, acting_stages, nodes_of_ground, check_sides, check_ground

   !> Side of an edge on which the ground is: what acts along its normal acts on that.
   integer, parameter :: ON_NONE = 0, ON_LEFT = 1, ON_RIGHT = 2, ON_BOTH = 3
contains
   !> Elements that are part of the ground in a stage. (elements)
   pure function ground_of(model, number) result(present)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical :: present(size(model%domain%region_of))

      present = .true.
      if (allocated(model%ground)) present = model%ground(:, number)
   end function ground_of

   !> Edges of a group with the ground on their left that is present in the first of some stages; check_sides sees to
   !> the others. (3, edges)
   pure function facing_edges(model, group, stages) result(edges)
      type(model_t), intent(in) :: model
      integer, intent(in) :: group              !< Of the mesh.
      character(*), intent(in) :: stages(:)     !< In which something acts on it; none: all.
      integer, allocatable :: edges(:, :)
      integer, allocatable :: sides(:)
      integer :: s, k

      edges = model%domain%mesh%groups(group)%edges
      s = findloc([(acts_in(stages, model%stages(s)%name), s=1, size(model%stages))], .true., dim=1)
      if (s == 0) return
      sides = sides_with_ground(model, group, s)
      do k = 1, size(edges, 2)
         if (sides(k) == ON_RIGHT) edges(1:2, k) = edges([2, 1], k)
      end do
   end function facing_edges

   !> Names of the stages in which something acts.
   pure function acting_stages(model, action) result(names)
      type(model_t), intent(in) :: model
      type(action_t), intent(in) :: action
      character(NAME_LENGTH), allocatable :: names(:)
      logical :: wanted(size(model%stages))
      integer :: s

      wanted = [((has_inertia(model%stages(s)%kind) .or. .not. action%damps) .and. &
                 acts_in(action%stages, model%stages(s)%name), s=1, size(wanted))]
      allocate (names(count(wanted)))
      names = pack(model%stages%name, wanted)
   end function acting_stages

   !> On which sides of the edges of a group a stage has ground. (edges)
   pure function sides_with_ground(model, group, number) result(sides)
      type(model_t), intent(in) :: model
      integer, intent(in) :: group, number   !< Of the mesh; of the stage.
      integer :: sides(size(model%domain%mesh%groups(group)%edges, 2))
      logical :: present(size(model%domain%region_of))
      logical, dimension(size(model%domain%mesh%x, 2)) :: wanted, left, right
      integer :: from(size(model%domain%mesh%x, 2))
      integer :: e, k

      present = ground_of(model, number)
      wanted = .false.
      left = .false.
      right = .false.
      associate (edges => model%domain%mesh%groups(group)%edges, t6 => model%domain%mesh%t6)
         wanted(edges(3, :)) = .true.
         do k = 1, size(sides)
            from(edges(3, k)) = edges(1, k)
         end do
         ! A side of a triangle is known by the node in its middle; its triangle lies on the left.
         do e = 1, size(t6, 2)
            if (.not. present(e)) cycle
            do k = 1, 3
               associate (middle => t6(k + 3, e))
                  if (.not. wanted(middle)) cycle
                  if (from(middle) == t6(k, e)) left(middle) = .true.
                  if (from(middle) /= t6(k, e)) right(middle) = .true.
               end associate
            end do
         end do
         sides = ON_NONE
         where (left(edges(3, :))) sides = ON_LEFT
         where (right(edges(3, :))) sides = sides + ON_RIGHT
      end associate
   end function sides_with_ground

   !> What acts along the normal of an edge needs ground on one side of it alone, and on the same one whenever it acts.
   !> Fault EXIT_GROUP: it acts where ground lies on both sides, on none, or changes.
   subroutine check_sides(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(model%actions)
         if (model%actions(i)%along_normal) call look(model%actions(i), acting_stages(model, model%actions(i)))
      end do
   contains
      subroutine look(item, stages)
         type(action_t), intent(in) :: item
         character(*), intent(in) :: stages(:)
         character(*), parameter :: WORDS(0:3) = [character(44) :: 'has no ground on either side', '', '', &
                                                  'has ground on both sides, and so no outside']
         character(:), allocatable :: wrong, remedy
         integer, dimension(size(model%domain%mesh%groups(item%group)%edges, 2)) :: sides, before
         integer :: s, first, k

         if (fault%code /= 0) return
         if (size(stages) == 0) return
         first = 0
         k = 0
         do s = 1, size(model%stages)
            if (.not. acts_in(stages, model%stages(s)%name)) cycle
            sides = sides_with_ground(model, item%group, s)
            if (first == 0) before = sides
            k = findloc((sides /= ON_LEFT .and. sides /= ON_RIGHT) .or. sides /= before, .true., dim=1)
            if (k > 0) exit
            if (first == 0) first = s
         end do
         if (k == 0) return
         if (any(sides(k) == [ON_LEFT, ON_RIGHT])) then
            wrong = 'has its ground on the other side than in stage '''//trim(model%stages(first)%name)//''''
            remedy = 'give one '//trim(item%what)//' for each of the stages.'
         else
            wrong = trim(WORDS(sides(k)))
            remedy = 'name the stages in which the ground lies on one side alone (stages of '//trim(item%what)// &
                     ' and of &region), or a group on the outside of the ground.'
         end if
         associate (mesh => model%domain%mesh)
            associate (x => mesh%x(:, mesh%groups(item%group)%edges(3, k)))
               call raise(fault, EXIT_GROUP, place_of(item)//'this '//trim(item%what)//' acts in stage '''// &
                          trim(model%stages(s)%name)//''' on group '''//trim(mesh%groups(item%group)%name)// &
                          ''', whose edge at ('//short(x(1))//', '//short(x(2))//') m '//wrong//' then; '//remedy)
            end associate
         end associate
      end subroutine look
   end subroutine check_sides

   !> Fault EXIT_GROUP: something acts in a stage on nodes that no present element has.
   subroutine check_ground(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      logical :: there(size(model%domain%mesh%x, 2))
      integer :: s, i

      if (.not. allocated(model%ground)) return
      do s = 1, size(model%stages)
         there = nodes_of_ground(model, s)
         do i = 1, size(model%actions)
            associate (item => model%actions(i), stage => model%stages(s)%name)
               if (fault%code /= 0 .or. item%group == 0 .or. item%supports) cycle
               if (.not. acts_in(item%stages, stage)) cycle
               associate (group => model%domain%mesh%groups(item%group))
                  if (.not. all(there(group%nodes))) call raise(fault, EXIT_GROUP, place_of(item)//'this '// &
                     trim(item%what)//' acts in stage '''//trim(stage)//''' on group '''//trim(group%name)// &
                     ''', part of which is no ground then (stages of &region); name the stages in which it acts.')
               end associate
            end associate
         end do
      end do
   end subroutine check_ground

   !> Nodes of elements that a stage has, and of plates.
   pure function nodes_of_ground(model, number) result(there)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical :: there(size(model%domain%mesh%x, 2)), present(size(model%domain%region_of))
      integer :: e

      there = .false.
      present = ground_of(model, number)
      do e = 1, size(present)
         if (present(e)) there(model%domain%mesh%t6(:, e)) = .true.
      end do
      if (any(there)) there(model%domain%bodies) = .true.
   end function nodes_of_ground
end module acting_places
