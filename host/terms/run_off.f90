! SPDX-License-Identifier: MIT
!> Water that runs off: seepage faces and rain, where a water pressure has an upper limit. It is held where it stands at
!> its limit and free where it lies below. Which side acts is decided unknown by unknown within Newton's method, as in
!> the primal-dual active set strategy. docs/theory/host.md section 7.7.
module run_off
   use kinds, only: wp
   use boundary_conditions, only: acts
   use convergence, only: RATE_SHARE
   use degrees_of_freedom, only: of_unknowns
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_table, only: key_table_t
   use model_types, only: model_t, problem_t, factor_at, factors_of, gravity_at, value_at, load_t, now_in
   use prescribed_values, only: is_released
   use scene_parts, only: place_of
   use scene_term, only: scene_term_t
   use sparsity_pattern, only: entry_of
   use texts, only: place_text, short
   use unknown_fields, only: AT_P_W, AT_P_C
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: run_off_t, begin_sides

   character(*), parameter :: NO_SUBTRACTION = 'initial_flow = ''subtract'' of &scene takes a flow away that a '// &
      'seepage face or rain has to see; start from water at rest, or let a stage find the flow (''drain'').'

   real(wp), parameter :: AT_LIMIT = 1.0e-6_wp    !< Share of the limit, and [kPa]: so near a step leaves what it holds.
   real(wp), parameter :: LEAST_REACTION = 0.01_wp   !< Share of Newton's tolerance, of the magnitudes in a balance:
                                                     !< less decides nothing.
   integer, parameter :: MOST_RELEASES = 3        !< In a step; then an unknown that alternates keeps its limit.

   type, extends(scene_term_t) :: run_off_t
      real(wp), allocatable :: ponding(:)   !< (loads) Depth of water that stays on the surface, of rain [m].
      integer, allocatable :: releases(:)   !< (unknowns) Number of times that they left their limit in this step.
      integer :: stuck = 0                  !< An unknown that keeps its limit although it should leave; 0: none.
   contains
      procedure :: build_group, build, before_step, limit, choose, accept
   end type run_off_t
contains
   !> Reads the pond of a load that is rain. Raises no fault.
   subroutine build_group(self, k, number, model, fault)
      class(run_off_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      real(wp) :: ponding

      ponding = 0.0_wp
      call k%number('ponding', ponding, 0.0_wp, 1000.0_wp, &
                    'rain: depth of water that the surface holds before the rest runs off [m]', 'kind=rain')
      if (k%lists) return
      if (.not. allocated(self%ponding)) allocate (self%ponding(size(model%loads)), source=0.0_wp)
      if (model%loads(number)%limits) self%ponding(number) = ponding
   end subroutine build_group

   !> Checks seepage faces and rain of a model. Fault EXIT_INPUT: keys contradict each other, rain is drawn up, or a
   !> pond has no weight.
   subroutine build(self, model, fault)
      class(run_off_t), intent(inout) :: self
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      self%wanted = any(model%fixes%limits) .or. any(model%loads%limits)
      do i = 1, size(model%fixes)
         associate (fix => model%fixes(i))
            if (.not. fix%limits .or. fault%code /= 0) cycle
            if (fix%field /= AT_P_W .or. fix%hold) then
               call raise(fault, EXIT_INPUT, place_of(fix)//'kind = ''seepage'' needs field = ''p_w'', and not '// &
                          'hold = ''yes'': its value is the largest p_w, 0 where the face is open to the air.')
            else if (model%subtract_flow) then
               call raise(fault, EXIT_INPUT, place_of(fix)//NO_SUBTRACTION)
            end if
         end associate
      end do
      do i = 1, size(model%loads)
         associate (load => model%loads(i))
            if (.not. load%limits .or. fault%code /= 0) cycle
            call check_rain(model, load, self%ponding(i), fault)
         end associate
      end do
   end subroutine build

   !> Rain falls, it is not drawn up; and its pond has a pressure by its weight.
   subroutine check_rain(model, load, ponding, fault)
      type(model_t), intent(in) :: model
      type(load_t), intent(in) :: load
      real(wp), intent(in) :: ponding   !< Depth of water that stays on the surface [m].
      type(fault_t), intent(inout) :: fault
      real(wp) :: least

      least = minval(load%value*factors_of(model, load%amplitude))
      if (least < 0.0_wp .or. abs(load%value_slope) > 0.0_wp) then
         call raise(fault, EXIT_INPUT, place_of(load)//'rain has a value times its history of 0 or more, and no '// &
                    'value_slope; here it becomes '//short(least)//' m/s. For evaporation give a kind = ''water'' '// &
                    'with a negative value, which acts whatever the suction.')
      else if (ponding > 0.0_wp .and. .not. model%domain%gravity > 0.0_wp) then
         call raise(fault, EXIT_INPUT, place_of(load)//'ponding = '//short(ponding)//' m: without gravity in '// &
                    '&scene the pond has no pressure; set gravity, or leave ponding out.')
      else if (model%subtract_flow) then
         call raise(fault, EXIT_INPUT, place_of(load)//NO_SUBTRACTION)
      end if
   end subroutine check_rain

   !> Notes the rain among the loads at both ends of the step, of which a limit may refuse a part.
   subroutine before_step(self, dt, problem, fault)
      class(run_off_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault

      problem%constraint%offered_0 = rain_at(problem, problem%state%time)
      problem%constraint%offered_1 = rain_at(problem, problem%state%time + dt)
   end subroutine before_step

   !> Sums the rain of the stage at a time, before what runs off [m3/s]. (unknowns) docs/theory/host.md section 7.7.
   pure function rain_at(problem, time) result(rain)
      type(problem_t), intent(in) :: problem
      real(wp), intent(in) :: time   !< [s]
      real(wp) :: rain(problem%dofs%n)
      integer :: i

      rain = 0.0_wp
      do i = 1, size(problem%model%loads)
         associate (one => problem%model%loads(i))
            if (one%limits .and. one%in_stage(problem%at%stage)) &
               rain = rain + factor_at(problem%model, one%amplitude, time)*one%vector
         end associate
      end do
   end function rain_at

   !> Sets the largest water pressures of seepage faces, and under rain those of its pond; of several the smallest
   !> counts, whose group has the run-off. What is prescribed has no limit. docs/theory/host.md section 7.7.
   subroutine limit(self, time, problem)
      class(run_off_t), intent(inout) :: self
      real(wp), intent(in) :: time
      type(problem_t), intent(inout) :: problem
      integer :: i, k

      problem%constraint%limited_by = 0
      associate (model => problem%model, groups => problem%domain%mesh%groups, stage => problem%at%stage)
         do i = 1, merge(size(model%fixes), 0, problem%stage%has_rates)
            associate (fix => model%fixes(i), nodes => groups(model%fixes(i)%group)%nodes)
               if (.not. fix%limits .or. .not. acts(fix, problem, time)) cycle
               do k = 1, size(nodes)
                  if (is_released(problem%constraint, i, nodes(k))) cycle
                  ! The water outside presses where it stands; above it there is air.
                  call limit_node(problem, nodes(k), fix%group, max(0.0_wp, &
                     value_at(fix, model%domain%mesh%x(2, nodes(k)))*factor_at(model, fix%amplitude, time)))
               end do
            end associate
         end do
         do i = 1, merge(size(model%loads), 0, problem%stage%has_rates)
            associate (load => model%loads(i), nodes => groups(model%loads(i)%group)%nodes)
               if (.not. load%limits .or. .not. load%in_stage(stage)) cycle
               do k = 1, size(nodes)
                  call limit_node(problem, nodes(k), load%group, &
                                  model%domain%fluids%rho_w*gravity_at(model, time)*self%ponding(i))
               end do
            end associate
         end do
      end associate
      call begin_sides(self, problem)
   end subroutine limit

   !> Limits the water pressure of a node, where it has one that is not prescribed; the air there is that outside.
   pure subroutine limit_node(problem, node, group, value)
      type(problem_t), intent(inout) :: problem
      integer, intent(in) :: node, group
      real(wp), intent(in) :: value   !< [kPa]

      associate (c => problem%constraint, w => problem%dofs%of(AT_P_W, node), p_c => problem%dofs%of(AT_P_C, node))
         if (w == 0) return
         if (c%fixed(w) .or. (c%limited_by(w) > 0 .and. c%target(w) <= value)) return
         c%target(w) = value
         c%limited_by(w) = group
         if (p_c == 0) return
         associate (first => problem%dofs%node(p_c))
            if (c%fixed(p_c) .or. c%air(first)) return
            c%air(first) = .true.
            c%air_target(first) = 0.0_wp
         end associate
      end associate
   end subroutine limit_node

   !> The sides at the start of a step follow from the pressures there, so that a step that is cut, and a restart, begin
   !> alike.
   pure subroutine begin_sides(self, problem)
      class(run_off_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem

      self%releases = spread(0, 1, problem%dofs%n)
      associate (c => problem%constraint)
         where (c%limited_by > 0) &
            c%fixed = of_unknowns(problem%dofs, problem%state%x) > c%target - AT_LIMIT*(1 + abs(c%target))
      end associate
   end subroutine begin_sides

   !> Chooses the sides after an iteration. An unknown is held where r + c (x - limit) > 0, with the reaction r that its
   !> limit asks for and the slope c of its balance, and free elsewhere; what is smaller than the balance is known to
   !> leaves it as it is. One that was released too often keeps its limit and is noted.
   subroutine choose(self, problem, residual, changed)
      class(run_off_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      real(wp), intent(in) :: residual(:)
      logical, intent(inout) :: changed
      real(wp) :: side, slope, least
      integer :: i, parts

      self%stuck = 0
      associate (c => problem%constraint, pattern => problem%pattern, values => problem%assembly%values)
         do i = 1, problem%dofs%n
            if (c%limited_by(i) == 0) cycle
            associate (node => problem%dofs%node(i))
               slope = values(entry_of(pattern, i, i))
               ! The air keeps its pressure there: what p_w gains the suction loses, and the pores fill.
               if (c%air(node)) slope = slope - values(entry_of(pattern, i, problem%dofs%of(AT_P_C, node)))
               side = residual(i) + abs(slope)*(problem%next%x(problem%dofs%field(i), node) - c%target(i))
            end associate
            ! Water at rest has no flows but their rounding: the parts that cancel are the measure there.
            parts = problem%dofs%of(AT_P_C, problem%dofs%node(i))
            if (parts == 0) parts = i
            least = LEAST_REACTION*problem%newton%tolerance*max(problem%assembly%scale(i), &
                                                                RATE_SHARE*problem%assembly%floor(parts))
            if (c%fixed(i) .and. side < -least) then
               if (self%releases(i) >= MOST_RELEASES) then
                  self%stuck = i
                  cycle
               end if
               c%fixed(i) = .false.
               self%releases(i) = self%releases(i) + 1
               changed = .true.
            else if (.not. c%fixed(i) .and. side > least) then
               c%fixed(i) = .true.
               changed = .true.
            end if
         end do
      end associate
   end subroutine choose

   !> Warns of a node that lets water in, once a run. docs/theory/host.md section 7.7.
   subroutine accept(self, problem, dissipated)
      class(run_off_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      real(wp), intent(inout) :: dissipated

      if (self%stuck == 0) return
      associate (x => problem%domain%mesh%x(:, problem%dofs%node(self%stuck)))
         call print_warning(now_in(problem)//'the node at '//place_text(x)//' of a seepage '// &
            'face, or under rain, left its limit three times within the step, and keeps it although water enters '// &
            'there. Shorten the steps or refine the mesh there.', once='inflow at a limit')
      end associate
   end subroutine accept
end module run_off
