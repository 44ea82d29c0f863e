! SPDX-License-Identifier: MIT
!> Water that runs off: seepage faces and rain, where a water pressure has a limit. Which side of it acts is decided
!> within Newton's method (prescribed_values). docs/theory/host.md section 7.7.
module run_off
   use kinds, only: wp
   use boundary_conditions, only: acts, force_of
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_table, only: key_table_t
   use model_types, only: model_t, problem_t, factor_at, factors_of, gravity_at, value_at, load_t
   use prescribed_values, only: is_released
   use scene_parts, only: place_of, LOAD_RAIN
   use scene_term, only: scene_term_t
   use texts, only: short
   use unknown_fields, only: AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: run_off_t

   character(*), parameter :: NO_SUBTRACTION = 'initial_flow = ''subtract'' of &scene takes a flow away that a '// &
      'seepage face or rain has to see; start from water at rest, or let a stage find the flow (''drain'').'

   type, extends(scene_term_t) :: run_off_t
      real(wp), allocatable :: ponding(:)   !< (loads) Depth of water that stays on the surface, of rain [m].
   contains
      procedure :: build_group, build, before_step, prescribe
   end type run_off_t
contains
   !> The pond of a load that is rain. Raises no fault.
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
      if (model%loads(number)%kind == LOAD_RAIN) self%ponding(number) = ponding
   end subroutine build_group

   !> Seepage faces and rain of a model. Fault EXIT_INPUT: keys that contradict each other, rain that is drawn up, or a
   !> pond without weight.
   subroutine build(self, model, fault)
      class(run_off_t), intent(inout) :: self
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      self%wanted = any(model%fixes%limits) .or. any(model%loads%kind == LOAD_RAIN)
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
            if (load%kind /= LOAD_RAIN .or. fault%code /= 0) cycle
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

   !> The rain among the loads, at both ends of the step.
   subroutine before_step(self, dt, problem, fault)
      class(run_off_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault

      problem%constraint%rain_0 = rain_at(problem, problem%state%time)
      problem%constraint%rain_1 = rain_at(problem, problem%state%time + dt)
   end subroutine before_step

   !> The rain of the stage at a time, before what runs off [m3/s]. (unknowns) docs/theory/host.md section 7.7.
   pure function rain_at(problem, time) result(rain)
      type(problem_t), intent(in) :: problem
      real(wp), intent(in) :: time   !< [s]
      real(wp) :: rain(problem%dofs%n)
      integer :: i

      rain = 0.0_wp
      do i = 1, size(problem%model%loads)
         associate (one => problem%model%loads(i))
            if (one%kind == LOAD_RAIN .and. one%in_stage(problem%at%stage)) &
               rain = rain + force_of(one, factor_at(problem%model, one%amplitude, time))
         end associate
      end do
   end function rain_at

   !> Largest water pressures of seepage faces, and under rain those of its pond; of several the smallest, whose group
   !> has the run-off. What another &fix gives has no limit. The air of such a face is that outside.
   !> docs/theory/host.md section 7.7.
   subroutine prescribe(self, time, problem)
      class(run_off_t), intent(in) :: self
      real(wp), intent(in) :: time
      type(problem_t), intent(inout) :: problem
      integer :: i, k

      if (.not. problem%stage%has_rates) return
      associate (model => problem%model, groups => problem%domain%mesh%groups, stage => problem%at%stage)
         do i = 1, size(model%fixes)
            associate (fix => model%fixes(i), nodes => groups(model%fixes(i)%group)%nodes)
               if (.not. fix%limits .or. .not. acts(fix, problem, time)) cycle
               do k = 1, size(nodes)
                  ! The water outside, where it stands, else the air.
                  if (.not. is_released(problem%constraint, i, nodes(k))) call limit(nodes(k), max(0.0_wp, &
                     value_at(fix, model%domain%mesh%x(2, nodes(k)))*factor_at(model, fix%amplitude, time)), fix%group)
               end do
            end associate
         end do
         do i = 1, size(model%loads)
            associate (load => model%loads(i), nodes => groups(model%loads(i)%group)%nodes)
               if (load%kind /= LOAD_RAIN .or. .not. load%in_stage(stage)) cycle
               do k = 1, size(nodes)
                  call limit(nodes(k), model%domain%fluids%rho_w*gravity_at(model, time)*self%ponding(i), load%group)
               end do
            end associate
         end do
      end associate
   contains
      subroutine limit(node, value, group)
         integer, intent(in) :: node, group
         real(wp), intent(in) :: value   !< [kPa]

         associate (dofs => problem%dofs, c => problem%constraint)
            associate (at => dofs%of(AT_P_W, node))
               if (at == 0) return
               if (c%fixed(at)) return
               if (c%limited(at) .and. c%target(at) <= value) return
               c%limited(at) = .true.
               c%target(at) = value
               c%limited_by(at) = group
            end associate
            associate (at => dofs%of(AT_P_C, node))
               if (at == 0 .or. c%air(node)) return
               if (c%fixed(at)) return
            end associate
            c%air(node) = .true.
            c%air_target(node) = 0.0_wp
         end associate
      end subroutine limit
   end subroutine prescribe
end module run_off
