! SPDX-License-Identifier: MIT
!> Which ground a stage has, on which side of an edge it lies, and what a scene may ask where parts of it join or leave
!> between stages. docs/theory/host.md section 14.
module staged_ground
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise, EXIT_INPUT
   use generalised_alpha, only: DYNAMIC
   use model_types, only: model_t
   use scene_types, only: acts_in, place_of, scene_item_t, NAME_LENGTH, LOAD_PRESSURE, LOAD_RAIN
   use texts, only: short
   implicit none (type, external)
   private
   public :: is_staged, ground_of, facing_edges, dynamic_stages, check_sides, check_staged_ground

   !> Side of an edge on which the ground is: what acts along its normal acts on that.
   integer, parameter :: ON_NONE = 0, ON_LEFT = 1, ON_RIGHT = 2, ON_BOTH = 3
contains
   !> Whether parts of the ground join or leave.
   pure logical function is_staged(model)
      type(model_t), intent(in) :: model
      integer :: i

      is_staged = .false.
      do i = 1, size(model%regions)
         is_staged = is_staged .or. size(model%regions(i)%stages) > 0
      end do
   end function is_staged

   !> Elements that are part of the ground in a stage. (elements)
   pure function ground_of(model, number) result(present)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical :: present(size(model%domain%region_of)), there(size(model%regions))
      integer :: i

      there = [(acts_in(model%regions(i)%stages, model%stages(number)%name), i=1, size(there))]
      present = there(model%domain%region_of)
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
      do s = 1, size(model%stages)
         if (acts_in(stages, model%stages(s)%name)) exit
      end do
      if (s > size(model%stages)) return
      sides = sides_with_ground(model, group, s)
      do k = 1, size(edges, 2)
         if (sides(k) == ON_RIGHT) edges(1:2, k) = edges([2, 1], k)
      end do
   end function facing_edges

   !> The dynamic ones of some stages: in others no absorbing boundary acts.
   pure function dynamic_stages(model, stages) result(names)
      type(model_t), intent(in) :: model
      character(*), intent(in) :: stages(:)   !< None: all.
      character(NAME_LENGTH), allocatable :: names(:)
      logical :: wanted(size(model%stages))
      integer :: s

      wanted = [(model%stages(s)%kind == DYNAMIC .and. acts_in(stages, model%stages(s)%name), s=1, size(wanted))]
      allocate (names(count(wanted)))
      names = pack(model%stages%name, wanted)
   end function dynamic_stages

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
   !> Fault EXIT_GROUP: a pressure, rain, contact or absorbing boundary acts where it lies on both sides, on none, or
   !> changes.
   subroutine check_sides(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(model%loads)
         associate (load => model%loads(i))
            if (any(load%kind == [LOAD_PRESSURE, LOAD_RAIN])) &
               call look(load%scene_item_t, '&load', load%stages, load%group)
         end associate
      end do
      do i = 1, size(model%contacts)
         associate (contact => model%contacts(i))
            call look(contact%scene_item_t, '&contact', contact%stages, contact%slave)
            if (contact%plate == 0) call look(contact%scene_item_t, '&contact', contact%stages, contact%master)
         end associate
      end do
      do i = 1, size(model%absorbers)
         associate (absorber => model%absorbers(i))
            call look(absorber%scene_item_t, '&absorbing', dynamic_stages(model, absorber%stages), absorber%group)
         end associate
      end do
   contains
      subroutine look(item, what, stages, group)
         class(scene_item_t), intent(in) :: item
         character(*), intent(in) :: what, stages(:)
         integer, intent(in) :: group
         character(*), parameter :: WORDS(0:3) = [character(44) :: 'has no ground on either side', '', '', &
                                                  'has ground on both sides, and so no outside']
         character(:), allocatable :: wrong, remedy
         integer, dimension(size(model%domain%mesh%groups(group)%edges, 2)) :: sides, before
         integer :: s, first, k

         if (fault%code /= 0) return
         if (what == '&absorbing' .and. size(stages) == 0) return
         first = 0
         k = 0
         do s = 1, size(model%stages)
            if (.not. acts_in(stages, model%stages(s)%name)) cycle
            sides = sides_with_ground(model, group, s)
            if (first == 0) before = sides
            k = findloc((sides /= ON_LEFT .and. sides /= ON_RIGHT) .or. sides /= before, .true., dim=1)
            if (k > 0) exit
            if (first == 0) first = s
         end do
         if (k == 0) return
         if (any(sides(k) == [ON_LEFT, ON_RIGHT])) then
            wrong = 'has its ground on the other side than in stage '''//trim(model%stages(first)%name)//''''
            remedy = 'give one '//what//' for each of the stages.'
         else
            wrong = trim(WORDS(sides(k)))
            remedy = 'name the stages in which the ground lies on one side alone (stages of '//what// &
                     ' and of &region), or a group on the outside of the ground.'
         end if
         associate (mesh => model%domain%mesh)
            associate (x => mesh%x(:, mesh%groups(group)%edges(3, k)))
               call raise(fault, EXIT_GROUP, place_of(item)//'this '//what//' acts in stage '''// &
                          trim(model%stages(s)%name)//''' on group '''//trim(mesh%groups(group)%name)// &
                          ''', whose edge at ('//short(x(1))//', '//short(x(2))//') m '//wrong//' then; '//remedy)
            end associate
         end associate
      end subroutine look
   end subroutine check_sides

   !> Fault EXIT_INPUT: ground that is not there from the start with a stress of its own, or the flow of a start that
   !> lacks it; a stage without ground; EXIT_GROUP: a load, contact, absorbing boundary or rigid body that acts in a
   !> stage on nodes that no present element has.
   subroutine check_staged_ground(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      logical :: there(size(model%domain%mesh%x, 2))
      integer :: s, i

      if (fault%code /= 0) return
      if (.not. is_staged(model)) return
      if (model%subtract_flow) then
         call raise(fault, EXIT_INPUT, trim(model%file)//': initial_flow = ''subtract'' of &scene keeps the flow '// &
                    'of the ground at the start, but regions join or leave (stages of &region); leave one of them out.')
         return
      end if
      do s = 1, size(model%stages)
         if (fault%code /= 0) return
         call mark_nodes(model, s, there)
         if (.not. any(there)) call raise(fault, EXIT_INPUT, trim(model%file)//': no &region is part of the ground '// &
                                          'in stage '''//trim(model%stages(s)%name)//'''.')
         do i = 1, size(model%loads)
            associate (load => model%loads(i))
               call look(load%scene_item_t, '&load', load%stages, load%group)
            end associate
         end do
         do i = 1, size(model%absorbers)
            associate (absorber => model%absorbers(i))
               call look(absorber%scene_item_t, '&absorbing', absorber%stages, absorber%group)
            end associate
         end do
         do i = 1, size(model%plates)
            associate (plate => model%plates(i))
               call look(plate%scene_item_t, '&plate', [character(1) ::], plate%group)
            end associate
         end do
         do i = 1, size(model%contacts)
            associate (contact => model%contacts(i))
               call look(contact%scene_item_t, '&contact', contact%stages, contact%slave)
               call look(contact%scene_item_t, '&contact', contact%stages, contact%master)
            end associate
         end do
      end do
      if (fault%code == 0) call check_start(model, fault)
   contains
      !> Whether all nodes of a group are there where something acts on it.
      subroutine look(item, what, stages, group)
         class(scene_item_t), intent(in) :: item
         character(*), intent(in) :: what, stages(:)
         integer, intent(in) :: group   !< 0: a plate with a face of its own.

         if (fault%code /= 0 .or. group == 0) return
         if (.not. acts_in(stages, model%stages(s)%name)) return
         if (all(there(model%domain%mesh%groups(group)%nodes))) return
         call raise(fault, EXIT_GROUP, place_of(item)//'this '//what//' acts in stage '''// &
                    trim(model%stages(s)%name)//''' on group '''//trim(model%domain%mesh%groups(group)%name)// &
                    ''', part of which is no ground then (stages of &region); name the stages in which it acts.')
      end subroutine look
   end subroutine check_staged_ground

   !> New ground comes without stress.
   subroutine check_start(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i, k, region

      do i = 1, size(model%initials)
         associate (initial => model%initials(i))
            if (.not. (initial%geostatic .or. initial%uniform)) cycle
            do k = 1, size(model%domain%region_of)
               region = model%domain%region_of(k)
               if (acts_in(model%regions(region)%stages, model%stages(1)%name)) cycle
               if (.not. any(model%domain%mesh%groups(initial%group)%elements == k)) cycle
               call raise(fault, EXIT_INPUT, place_of(initial)//'this stress covers the &region with group '''// &
                          trim(model%regions(region)%group_name)//''', which joins in a later stage and comes '// &
                          'without stress; name the group of the ground that is there from the start.')
               return
            end do
         end associate
      end do
   end subroutine check_start

   !> Nodes of elements that a stage has, and of plates.
   subroutine mark_nodes(model, number, there)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical, intent(out) :: there(:)
      logical :: present(size(model%domain%region_of))
      integer :: e

      there = .false.
      present = ground_of(model, number)
      do e = 1, size(present)
         if (present(e)) there(model%domain%mesh%t6(:, e)) = .true.
      end do
      if (any(there)) there(model%domain%bodies) = .true.
   end subroutine mark_nodes
end module staged_ground
