! SPDX-License-Identifier: MIT
!> Where something acts on the ground of a stage: on which side of an edge that lies, and whether it is there.
!> docs/theory/host.md section 14.
module acting_places
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise
   use kinds, only: wp
   use model_types, only: model_t, action_t, SPACINGS
   use scene_parts, only: place_of, PRESCRIBED_OF_BODY
   use texts, only: place_text, whole
   use triangle_mesh, only: group_of_t, nodes_of, triangles_beside
   use unknown_fields, only: AT_U_R
   implicit none (type, external)
   private
   public :: facing_edges, acting_stages, ground_of, nodes_of_ground, given_in, are_in, are_on_axis, share_an_edge, &
             check_actions, location_of

   !> Side of an edge on which the ground is: what acts along its normal acts on that.
   integer, parameter :: ON_NONE = 0, ON_LEFT = 1, ON_RIGHT = 2, ON_BOTH = 3
   real(wp), parameter :: ON_AXIS = 1.0e-9_wp   !< Share of the largest radius that is none.
contains
   !> Elements that are part of the ground in a stage. (elements)
   pure function ground_of(model, number) result(present)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical :: present(size(model%domain%region_of))

      present = .true.
      if (allocated(model%ground)) present = model%ground(:, number)
   end function ground_of

   !> Edges of a group with the ground on their left that is present in the first of some stages; check_actions sees to
   !> the others. (3, edges)
   pure function facing_edges(model, group, in_stage) result(edges)
      type(model_t), intent(in) :: model
      integer, intent(in) :: group           !< Of the mesh.
      logical, intent(in) :: in_stage(:)     !< (stages) Whether something acts on it.
      integer, allocatable :: edges(:, :)
      integer, allocatable :: sides(:)
      integer :: s, k

      edges = model%domain%mesh%groups(group)%edges
      s = findloc(in_stage, .true., dim=1)
      if (s == 0) return
      sides = sides_with_ground(model, group, s)
      do k = 1, size(edges, 2)
         if (sides(k) == ON_RIGHT) edges(1:2, k) = edges([2, 1], k)
      end do
   end function facing_edges

   !> Whether something acts in a stage (stages): dashpots do in dynamic ones alone.
   pure function acting_stages(model, action) result(acting)
      type(model_t), intent(in) :: model
      type(action_t), intent(in) :: action
      logical :: acting(size(model%stages))

      acting = action%in_stage .and. (model%stages%has_inertia .or. .not. action%damps)
   end function acting_stages

   !> Finds on which sides of the edges of a group a stage has ground. (edges)
   pure function sides_with_ground(model, group, number) result(sides)
      type(model_t), intent(in) :: model
      integer, intent(in) :: group, number   !< Of the mesh; of the stage.
      integer :: sides(size(model%domain%mesh%groups(group)%edges, 2)), beside(2, size(sides))
      logical :: present(0:size(model%domain%region_of))

      present = [.false., ground_of(model, number)]
      beside = triangles_beside(model%domain%mesh%t6, model%domain%mesh%groups(group)%edges)
      sides = merge(ON_LEFT, ON_NONE, present(beside(1, :))) + merge(ON_RIGHT, ON_NONE, present(beside(2, :)))
   end function sides_with_ground

   !> Refuses what acts where it cannot: on nodes of no element, in a stage that lacks its ground, or along the normal
   !> of an edge that has ground on both sides, on none, or on another side than in a stage before. Fault EXIT_GROUP.
   subroutine check_actions(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      logical :: carried(size(model%domain%mesh%x, 2))
      integer :: i

      carried = .false.
      carried([model%domain%mesh%t6]) = .true.
      carried(model%domain%bodies) = .true.
      do i = 1, size(model%actions)
         if (model%actions(i)%group > 0 .and. fault%code == 0) call look(model%actions(i), &
            model%domain%mesh%groups(model%actions(i)%group), model%domain%mesh%x)
      end do
   contains
      subroutine look(item, group, x)
         type(action_t), intent(in) :: item
         type(group_of_t), intent(in) :: group
         real(wp), intent(in) :: x(:, :)   !< [m]
         logical :: there(size(carried)), acting(size(model%stages))
         character(:), allocatable :: wrong
         integer, dimension(size(group%edges, 2)) :: sides, before
         integer :: s, first, k

         if (.not. (all(carried(group%nodes)) .or. (item%supports .and. any(carried(group%nodes))))) then
            k = group%nodes(findloc(carried(group%nodes), .false., dim=1))
            call raise(fault, EXIT_GROUP, place_of(item)//whole(count(.not. carried(group%nodes)))//' of the '// &
                       whole(size(group%nodes))//' nodes of group '''//trim(group%name)//''' belong to no '// &
                       'element, the first at '//place_text(x(:, k))//': nothing acts there; embed the point or '// &
                       'curve in its surface in Gmsh, or name another group.')
            return
         end if
         first = 0
         acting = acting_stages(model, item)
         do s = 1, size(model%stages)
            if (.not. item%in_stage(s)) cycle
            wrong = ''
            there = nodes_of_ground(model, s)
            if (allocated(model%ground) .and. .not. item%supports .and. .not. all(there(group%nodes))) then
               wrong = ', part of which is no ground then (stages of &region); name the stages in which it acts.'
            else if (item%along_normal .and. acting(s)) then
               sides = sides_with_ground(model, item%group, s)
               if (first == 0) before = sides
               k = findloc((sides /= ON_LEFT .and. sides /= ON_RIGHT) .or. sides /= before, .true., dim=1)
               if (k > 0) wrong = ', whose edge at '//place_text(x(:, group%edges(3, k)))//' '// &
                                  misplaced(item, sides(k), first)
               if (first == 0) first = s
            end if
            if (wrong == '') cycle
            call raise(fault, EXIT_GROUP, place_of(item)//'this '//trim(item%what)//' acts in stage '''// &
                       trim(model%stages(s)%name)//''' on group '''//trim(group%name)//''''//wrong)
            return
         end do
      end subroutine look

      function misplaced(item, side, first) result(text)
         type(action_t), intent(in) :: item
         integer, intent(in) :: side, first   !< Side of the ground; first stage in which it acts.
         character(:), allocatable :: text

         if (any(side == [ON_LEFT, ON_RIGHT])) then
            text = 'has its ground on the other side than in stage '''//trim(model%stages(first)%name)// &
                   ''' then; give one '//trim(item%what)//' for each of the stages.'
            return
         end if
         text = 'has no ground on either side'
         if (side == ON_BOTH) text = 'has ground on both sides, and so no outside'
         text = text//' then; name the stages in which the ground lies on one side alone (stages of '// &
                trim(item%what)//' and of &region), or a group on the outside of the ground.'
      end function misplaced
   end subroutine check_actions

   !> Marks the nodes of elements that a stage has, and of plates.
   pure function nodes_of_ground(model, number) result(there)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical :: there(size(model%domain%mesh%x, 2))

      there = nodes_of(model%domain%mesh, ground_of(model, number))
      if (any(there)) there(model%domain%bodies) = .true.
   end function nodes_of_ground

   !> Marks the nodes of a group. (nodes)
   pure function are_in(model, group) result(inside)
      type(model_t), intent(in) :: model
      integer, intent(in) :: group   !< Of the mesh.
      logical :: inside(size(model%domain%mesh%x, 2))

      inside = .false.
      inside(model%domain%mesh%groups(group)%nodes) = .true.
   end function are_in

   !> Whether a group has all nodes of an edge of a boundary: one that only ends on it has not.
   pure logical function share_an_edge(model, boundary, group) result(shared)
      type(model_t), intent(in) :: model
      integer, intent(in) :: boundary, group   !< Of the mesh.
      integer :: e

      associate (edges => model%domain%mesh%groups(boundary)%edges, inside => are_in(model, group))
         shared = any([(all(inside(edges(:, e))), e=1, size(edges, 2))])
      end associate
   end function share_an_edge

   !> Marks the nodes that axial symmetry holds along r: nothing leaves the axis. (nodes)
   pure function are_on_axis(model) result(held)
      type(model_t), intent(in) :: model
      logical :: held(size(model%domain%mesh%x, 2))

      associate (r => model%domain%mesh%x(1, :))
         held = model%domain%axisymmetric .and. r <= ON_AXIS*maxval(r)
      end associate
   end function are_on_axis

   !> Marks what a &fix or the axis gives nodes in a stage, or from its start to its end: a limit gives nothing
   !> throughout. Rotations of bodies stand at PRESCRIBED_OF_BODY. (PRESCRIBED_OF_BODY, nodes)
   pure function given_in(model, number, throughout) result(given)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number                !< Of the stage.
      logical, intent(in), optional :: throughout
      logical :: given(PRESCRIBED_OF_BODY, size(model%domain%mesh%x, 2)), whole
      real(wp) :: finish, close   !< Of the stage [s], with what a sum of stages may miss it by.
      integer :: i

      given = .false.
      given(AT_U_R, :) = are_on_axis(model)
      whole = .false.
      if (present(throughout)) whole = throughout
      associate (stage => model%stages(number))
         finish = stage%start + stage%duration
         close = SPACINGS*spacing(finish)
         do i = 1, size(model%fixes)
            associate (fix => model%fixes(i))
               if (.not. fix%in_stage(number)) cycle
               if (whole .and. (fix%limits .or. fix%from > stage%start + close .or. fix%until < finish - close)) cycle
               given(merge(PRESCRIBED_OF_BODY, fix%field, fix%of_body), &
                     model%domain%mesh%groups(fix%group)%nodes) = .true.
            end associate
         end do
      end associate
   end function given_in

   !> Where a node is: the plate that it stands for, or an element and the point [m].
   function location_of(model, node) result(text)
      type(model_t), intent(in) :: model
      integer, intent(in) :: node
      character(:), allocatable :: text
      integer :: e, i

      associate (mesh => model%domain%mesh)
         i = findloc(model%plates%node, node, dim=1)
         if (i > 0) then
            text = 'plate '//trim(model%plates(i)%name)
         else
            e = findloc(any(mesh%t6 == node, dim=1), .true., dim=1)
            text = 'node '//whole(node)//' of element '//whole(e)//', '//place_text(mesh%x(:, node))
         end if
      end associate
   end function location_of
end module acting_places
