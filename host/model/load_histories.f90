!> What acts on a scene, and how fast: jumps, slopes and their changes in every stage.
module load_histories
   use kinds, only: wp, PI
   use model_types, only: model_t, factor_at, acts_in, P_A, UNBOUNDED
   use porous_domain, only: state_t
   use generalised_alpha, only: STATIC
   use namelists, only: LENGTH
   implicit none (type, external)
   private
   public :: action_t, pace_t, actions_of, pace_of, start_of, FORCE, MOTION, PRESSURE, FLOW

   integer, parameter :: FORCE = 1, MOTION = 2, PRESSURE = 3, FLOW = 4

   !> A load, a prescribed displacement or pressure, a force on a rigid body, an inflow.
   type :: action_t
      integer :: kind = FORCE
      integer :: field = 0             !< Of what is prescribed: u_r, u_z, p_w, p_c, p_a.
      integer :: group = 0, history = 0
      integer :: load = 0              !< Number of the load, of the rigid body or plate below zero, 0: neither.
      real(wp) :: value = 0.0_wp
      character(LENGTH), allocatable :: stages(:)
      logical :: held = .false.        !< At what it is when a stage begins.
      logical :: lasting = .true.      !< It does not come or go within a stage.
      real(wp) :: start = 0.0_wp       !< Before the first stage.
      real(wp) :: offset = 0.0_wp      !< Largest departure of a prescribed pressure from the initial one [kPa].
      real(wp) :: change = 0.0_wp      !< Largest departure from the start.
      real(wp) :: stress = 0.0_wp      !< That comes with a unit of it [kPa]; 0: not known.
   end type action_t

   !> An action in a stage.
   type :: pace_t
      real(wp) :: jump = 0.0_wp        !< At the beginning.
      real(wp) :: bends = 0.0_wp       !< Sum of the changes of slope [1/s].
      real(wp) :: slope = 0.0_wp       !< The steepest [1/s].
   end type pace_t
contains
   !> All of them, with the largest change of each.
   function actions_of(model, state) result(actions)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state   !< The initial one.
      type(action_t), allocatable :: actions(:)
      integer :: i, n

      allocate (actions(size(model%loads) + size(model%rigids) + size(model%plates) + size(model%fixes)))
      n = 0
      do i = 1, size(model%loads)
         n = n + 1
         associate (one => model%loads(i))
            select case (one%kind)
            case (4, 5)
               actions(n) = action_t(FLOW, group=one%group, history=one%history, load=i, value=one%value)
            case default
               actions(n) = action_t(FORCE, group=one%group, history=one%history, load=i, value=one%value, &
                                     stress=merge(1.0_wp, 0.0_wp, one%kind <= 3))
            end select
            actions(n)%stages = one%stages
         end associate
      end do
      do i = 1, size(model%rigids)
         n = n + 1
         associate (one => model%rigids(i))
            actions(n) = action_t(FORCE, group=one%group, history=one%history, load=-i, value=one%force, &
                                  stress=1/area_of(model, one%group))
            allocate (actions(n)%stages(0))
         end associate
      end do
      do i = 1, size(model%plates)
         n = n + 1
         associate (one => model%plates(i))
            actions(n) = action_t(FORCE, history=one%history, load=-size(model%rigids) - i, value=one%force, &
                                  stress=1/face_of(model, one%r))
            allocate (actions(n)%stages(0))
         end associate
      end do
      do i = 1, size(model%fixes)
         n = n + 1
         associate (one => model%fixes(i))
            actions(n) = action_t(merge(MOTION, PRESSURE, one%field <= 2), field=one%field, group=one%group, &
                                  history=one%history, value=one%value, held=one%hold, &
                                  lasting=one%from <= -huge(1.0_wp) .and. one%until >= huge(1.0_wp), &
                                  stress=merge(0.0_wp, 1.0_wp, one%field <= 2))
            actions(n)%stages = one%stages
         end associate
      end do
      do i = 1, size(actions)
         call measure(model, state, actions(i))
      end do
   end function actions_of

   !> Start, offset and change.
   subroutine measure(model, state, action)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      type(action_t), intent(inout) :: action
      real(wp), allocatable :: times(:)
      real(wp) :: there
      integer :: i, k, node

      if (action%held) return
      if (action%kind == FORCE .or. action%kind == PRESSURE) action%start = value_at(model, action, 1, 0.0_wp)
      do i = 1, size(model%stages)
         times = breaks_of(model, action, i)
         do k = 1, size(times)
            action%change = max(action%change, abs(value_at(model, action, i, times(k)) - action%start))
         end do
      end do
      if (action%kind /= PRESSURE) return
      do k = 1, size(model%domain%mesh%groups(action%group)%nodes)
         node = model%domain%mesh%groups(action%group)%nodes(k)
         there = state%x(min(action%field, 4), node)
         if (action%field == P_A) there = state%x(3, node) + state%x(4, node)
         action%offset = max(action%offset, abs(action%start - there))
      end do
      action%change = action%change + action%offset
   end subroutine measure

   !> Jump, bends and slope of an action in a stage. A support that comes or goes cannot be bounded.
   function pace_of(model, action, stage) result(pace)
      type(model_t), intent(in) :: model
      type(action_t), intent(in) :: action
      integer, intent(in) :: stage
      type(pace_t) :: pace
      real(wp), allocatable :: times(:)
      real(wp) :: slope, last, first
      logical :: acts, acted
      integer :: k

      acts = acts_in(action%stages, model%stages(stage)%name)
      acted = acts
      if (stage > 1) acted = acts_in(action%stages, model%stages(stage - 1)%name)
      if (action%kind == MOTION .or. action%kind == PRESSURE) then
         if (.not. action%lasting .or. (acted .neqv. acts)) pace%jump = UNBOUNDED
         if (.not. acts .or. .not. action%lasting .or. .not. acted .or. action%held) return
      end if
      times = breaks_of(model, action, stage)
      last = action%start
      if (stage > 1) then
         last = value_at(model, action, stage - 1, times(1))
         if (action%kind == MOTION .and. model%stages(stage - 1)%zero_displacements) last = 0.0_wp
      end if
      pace%jump = abs(value_at(model, action, stage, times(1)) - last)
      ! Prescribed pressures take hold where the pressures are free for the first time.
      if (action%kind == PRESSURE .and. all(model%stages(:stage - 1)%kind == STATIC)) &
         pace%jump = pace%jump + action%offset
      slope = 0.0_wp
      do k = 1, size(times) - 1
         first = slope
         slope = (value_at(model, action, stage, times(k + 1)) - value_at(model, action, stage, times(k))) &
                 /(times(k + 1) - times(k))
         pace%bends = pace%bends + abs(slope - first)
         pace%slope = max(pace%slope, abs(slope))
      end do
   end function pace_of

   !> Beginning and end of a stage, and the moments between them where the history bends.
   function breaks_of(model, action, stage) result(times)
      type(model_t), intent(in) :: model
      type(action_t), intent(in) :: action
      integer, intent(in) :: stage
      real(wp), allocatable :: times(:)
      real(wp) :: t0, t1

      t0 = start_of(model, stage)
      t1 = t0 + model%stages(stage)%duration
      times = [t0, t1]
      if (action%history == 0) return
      associate (t => model%histories(action%history)%times)
         times = [t0, pack(t, t > t0 .and. t < t1), t1]
      end associate
   end function breaks_of

   pure real(wp) function value_at(model, action, stage, time) result(value)
      type(model_t), intent(in) :: model
      type(action_t), intent(in) :: action
      integer, intent(in) :: stage
      real(wp), intent(in) :: time

      value = 0.0_wp
      if (acts_in(action%stages, model%stages(stage)%name)) value = action%value*factor_at(model, action%history, time)
   end function value_at

   pure real(wp) function start_of(model, stage)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage

      start_of = sum(model%stages(:stage - 1)%duration)
   end function start_of

   !> Area of a boundary [m2].
   pure real(wp) function area_of(model, group) result(area)
      type(model_t), intent(in) :: model
      integer, intent(in) :: group
      integer :: e

      area = 0.0_wp
      associate (x => model%domain%mesh%x, edges => model%domain%mesh%groups(group)%edges)
         do e = 1, size(edges, 2)
            area = area + norm2(x(:, edges(2, e)) - x(:, edges(1, e))) &
                   *merge(PI*(x(1, edges(1, e)) + x(1, edges(2, e))), 1.0_wp, model%domain%axisymmetric)
         end do
      end associate
      ! A body without edges: a force of no known stress.
      if (.not. area > 0.0_wp) area = huge(1.0_wp)
   end function area_of

   pure real(wp) function face_of(model, r)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: r(2)

      face_of = (r(2) - r(1))*merge(PI*(r(1) + r(2)), 1.0_wp, model%domain%axisymmetric)
   end function face_of
end module load_histories
