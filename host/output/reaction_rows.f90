! SPDX-License-Identifier: MIT
!> Reactions of supports, flow through prescribed pressures and thrust of loads, as rows of a table: one column for
!> every group and direction, whatever number of &fix or &load of a stage name it. What holds an unknown belongs to the
!> &fix that prescribes it, so that the columns add up to the whole. docs/theory/host.md section 9.1.
module reaction_rows
   use kinds, only: wp
   use boundary_conditions, only: prescribing_fixes, forces_of_supports
   use csv, only: quoted
   use model_types, only: model_t, factor_at
   use run_state, only: run_t
   use scene_parts, only: LOAD_WATER, LOAD_AIR
   use unknown_fields, only: DISPLACEMENTS, AT_U_R, AT_U_Z, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: reaction_columns, reaction_row

   integer, parameter :: SUFFIXES = 9
   character(10), parameter :: SUFFIX(SUFFIXES) = [character(10) :: 'force_r', 'force_z', 'outflow_w', 'outflow_a', &
                                                   'load_r', 'load_z', 'inflow_w', 'inflow_a', 'at_limit']
   integer, parameter :: OUT_W = 3, OUT_A = 4, LOAD_R = 5, LOAD_Z = 6, IN_W = 7, IN_A = 8, LIMIT = 9
contains
   !> Names the columns of a stage's table; empty where the stage prescribes and loads nothing. docs/theory/host.md
   !> section 9.1.
   function reaction_columns(run) result(head)
      type(run_t), intent(in) :: run
      character(:), allocatable :: head
      integer, allocatable :: list(:, :)
      integer :: i

      call list_columns(run%model, run%at%stage, list)
      head = ''
      if (size(list, 2) > 0) head = 'time,time_of_forces'
      do i = 1, size(list, 2)
         head = head//','//quoted(name_of(list(1, i), list(2, i)))
      end do
   contains
      !> Names a group and what is told of it; the group of a coordinate by its plate and its load.
      function name_of(group, kind) result(name)
         integer, intent(in) :: group, kind
         character(:), allocatable :: name
         integer :: i, k

         name = trim(run%domain%mesh%groups(group)%name)//'.'//trim(SUFFIX(kind))
         do i = 1, size(run%model%plates)
            associate (plate => run%model%plates(i))
               k = findloc(plate%coordinates%group, group, dim=1)
               if (k == 0) cycle
               name = trim(plate%name)//'.'//trim(plate%coordinates(k)%names(4))
               if (kind == LOAD_Z) name = trim(plate%name)//'.load_'//trim(plate%coordinates(k)%names(1))
            end associate
         end do
      end function name_of
   end function reaction_columns

   !> Lists group and suffix (2, columns), in the order in which the scene names them.
   subroutine list_columns(model, stage, list)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Number of the stage.
      integer, allocatable, intent(out) :: list(:, :)
      integer :: i

      allocate (list(2, 0))
      do i = 1, size(model%fixes)
         associate (fix => model%fixes(i))
            if (.not. fix%in_stage(stage)) cycle
            if (fix%field <= DISPLACEMENTS) then
               call add(fix%group, fix%field)
            else
               call add(fix%group, OUT_W)
               if (model%domain%with_c) call add(fix%group, OUT_A)
               if (fix%limits) call add(fix%group, LIMIT)
            end if
         end associate
      end do
      do i = 1, size(model%loads)
         associate (load => model%loads(i))
            if (.not. load%in_stage(stage)) cycle
            if (load%of_body) then
               call add(load%group, LOAD_Z)
               cycle
            end if
            select case (load%kind)
            case (LOAD_WATER)
               call add(load%group, IN_W)
               if (.not. load%limits) cycle
               call add(load%group, OUT_W)
               if (model%domain%with_c) call add(load%group, OUT_A)
               call add(load%group, LIMIT)
            case (LOAD_AIR)
               call add(load%group, IN_A)
            case default
               call add(load%group, LOAD_R)
               call add(load%group, LOAD_Z)
            end select
         end associate
      end do
   contains
      subroutine add(group, kind)
         integer, intent(in) :: group, kind

         if (any(list(1, :) == group .and. list(2, :) == kind)) return
         list = reshape([list, group, kind], [2, size(list, 2) + 1])
      end subroutine add
   end subroutine list_columns

   !> Makes the row after a step: times [s], forces [kN] and flows [m3/s] in the order of reaction_columns. Forces hold
   !> where the step is in balance, at the level of its values: docs/theory/host.md section 9.1.
   function reaction_row(run) result(row)
      type(run_t), intent(in) :: run   !< After a step that was taken over.
      real(wp), allocatable :: row(:)
      integer, allocatable :: list(:, :)
      real(wp), allocatable :: sums(:, :)
      integer :: i, k

      call list_columns(run%model, run%at%stage, list)
      allocate (sums(SUFFIXES, size(run%domain%mesh%groups)), source=0.0_wp)
      call add_reactions()
      call add_loads()
      do i = 1, size(run%model%plates)
         do k = 1, size(run%model%plates(i)%coordinates)
            associate (one => run%model%plates(i)%coordinates(k))
               if (one%group > 0) sums(:, one%group) = one%unit*sums(:, one%group)
            end associate
         end do
      end do
      row = [run%state%time, run%state%time - (1 - run%scheme%l_f)*run%scheme%dt, &
             (sums(list(2, i), list(1, i)), i=1, size(list, 2))]
   contains
      subroutine add_reactions()
         integer :: by(run%dofs%n), air_by(size(run%domain%mesh%x, 2)), at, i, k, group(2)
         real(wp) :: w, a

         call prescribing_fixes(run%problem_t, run%state%time, by, air_by)
         sums(:DISPLACEMENTS, :) = forces_of_supports(run%model, by, run%system%reaction)
         associate (dofs => run%dofs, constraint => run%constraint, reaction => run%system%reaction)
            if (.not. run%scheme%has_rates .or. .not. run%domain%with_w) return
            do at = 1, dofs%n
               if (dofs%field(at) /= AT_P_W) cycle
               i = dofs%node(at)
               w = reaction(at)
               a = 0.0_wp
               k = by(at)
               if (run%domain%with_c) then
                  a = reaction(dofs%of(AT_P_C, i))
                  k = max(k, by(dofs%of(AT_P_C, i)))
                  ! The first balance is that of both fluids; where the air pressure is given, that of the water.
                  if (.not. constraint%air(i)) w = w - a
               end if
               group = 0
               if (k > 0) group = run%model%fixes(k)%group
               if (constraint%limited_by(at) > 0) then
                  group = constraint%limited_by(at)
                  if (constraint%fixed(at)) sums(LIMIT, group(1)) = sums(LIMIT, group(1)) + 1
                  ! What a free node's balance leaves is Newton's, and no flow.
                  if (.not. constraint%fixed(at)) w = 0.0_wp
               end if
               ! What p_a asks for is air: beside it the water is that of another &fix, or of a drained region.
               if (air_by(i) > 0) group(2) = run%model%fixes(air_by(i))%group
               if (group(1) > 0) sums(OUT_W, group(1)) = sums(OUT_W, group(1)) - w
               if (group(2) > 0) sums(OUT_A, group(2)) = sums(OUT_A, group(2)) - a
            end do
         end associate
      end subroutine add_reactions

      subroutine add_loads()
         real(wp) :: factor
         integer :: i

         do i = 1, size(run%model%loads)
            associate (load => run%model%loads(i), field => run%dofs%field)
               if (.not. load%in_stage(run%at%stage)) cycle
               factor = factor_at(run%model, load%amplitude, run%state%time - run%scheme%dt)
               factor = factor + run%scheme%l_f*(factor_at(run%model, load%amplitude, run%state%time) - factor)
               associate (sum_of => sums(:, load%group))
                  select case (load%kind)
                  case (LOAD_WATER)
                     sum_of(IN_W) = sum_of(IN_W) + factor*sum(load%vector, mask=field == AT_P_W)
                  case (LOAD_AIR)
                     sum_of(IN_A) = sum_of(IN_A) + factor*sum(load%vector, mask=field == AT_P_C)
                  case default
                     sum_of(LOAD_R) = sum_of(LOAD_R) + factor*sum(load%vector, mask=field == AT_U_R)
                     sum_of(LOAD_Z) = sum_of(LOAD_Z) + factor*sum(load%vector, mask=field == AT_U_Z)
                  end select
               end associate
            end associate
         end do
      end subroutine add_loads
   end function reaction_row
end module reaction_rows
