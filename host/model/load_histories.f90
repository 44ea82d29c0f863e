! SPDX-License-Identifier: MIT
!> The load histories of a model: everything that acts on it, and how fast: jumps, slopes and their changes in every
!> stage.
module load_histories
   use kinds, only: wp, PI
   use effect_types, only: UNBOUNDED
   use model_types, only: model_t, plate_t, factor_at, PRESCRIBED_P_A
   use scene_types, only: acts_in, LOAD_SHEAR_Z, LOAD_WATER, LOAD_AIR
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   use porous_domain, only: state_t
   use generalised_alpha, only: STATIC
   use namelists, only: LENGTH
   implicit none (type, external)
   private
   public :: load_history_t, pace_t, load_histories_of, pace_of, start_of, FORCE, MOTION, PRESSURE, FLOW

   integer, parameter :: FORCE = 1, MOTION = 2, PRESSURE = 3, FLOW = 4

   !> A load, a prescribed displacement or pressure, a force on a plate, an inflow.
   type :: load_history_t
      integer :: kind = FORCE
      integer :: field = 0             !< Of what is prescribed: u_r, u_z, p_w, p_c, p_a.
      integer :: group = 0, amplitude = 0
      integer :: load = 0, plate = 0   !< Number of the load or of the plate; 0: it is none.
      real(wp) :: value = 0.0_wp       !< Where it changes with z: the value of largest magnitude.
      real(wp) :: value_slope = 0.0_wp, base = 0.0_wp   !< Change with z, and value at z = 0.
      character(LENGTH), allocatable :: stages(:)
      logical :: held = .false.        !< At what it is when a stage begins.
      logical :: lasting = .true.      !< It does not come or go within a stage.
      real(wp) :: start = 0.0_wp       !< Before the first stage.
      real(wp) :: offset = 0.0_wp      !< Largest departure of a prescribed pressure from the initial one [kPa].
      real(wp) :: change = 0.0_wp      !< Largest departure from the start.
      real(wp) :: stress = 0.0_wp      !< That comes with a unit of it [kPa]; 0: not known.
   end type load_history_t

   !> A load history in a stage.
   type :: pace_t
      real(wp) :: jump = 0.0_wp        !< At the beginning.
      real(wp) :: bends = 0.0_wp       !< Sum of the changes of slope [1/s].
      real(wp) :: slope = 0.0_wp       !< The steepest [1/s].
   end type pace_t
contains
   !> All of them, with the largest change of each.
   function load_histories_of(model, state) result(histories)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state   !< The initial one.
      type(load_history_t), allocatable :: histories(:)
      integer :: i, n

      allocate (histories(size(model%loads) + size(model%plates) + size(model%fixes)))
      n = 0
      do i = 1, size(model%loads)
         n = n + 1
         associate (one => model%loads(i))
            select case (one%kind)
            case (LOAD_WATER, LOAD_AIR)
               histories(n) = load_history_t(FLOW, group=one%group, amplitude=one%amplitude, load=i, value=one%value)
            case default
               histories(n) = load_history_t(FORCE, group=one%group, amplitude=one%amplitude, load=i, value=one%value, &
                                     stress=merge(1.0_wp, 0.0_wp, one%kind <= LOAD_SHEAR_Z))
            end select
            histories(n)%stages = one%stages
            call spread_over(model, one%value_slope, one%datum, histories(n))
         end associate
      end do
      do i = 1, size(model%plates)
         n = n + 1
         associate (one => model%plates(i))
            histories(n) = load_history_t(FORCE, amplitude=one%amplitude, plate=i, value=one%force, &
                                  stress=1/face_of(model, one))
            allocate (histories(n)%stages(0))
         end associate
      end do
      do i = 1, size(model%fixes)
         n = n + 1
         associate (one => model%fixes(i))
            histories(n) = load_history_t(merge(MOTION, PRESSURE, one%field <= DISPLACEMENTS), field=one%field, &
                                  group=one%group, &
                                  amplitude=one%amplitude, value=one%value, held=one%hold, &
                                  lasting=one%from <= -huge(1.0_wp) .and. one%until >= huge(1.0_wp), &
                                  stress=merge(0.0_wp, 1.0_wp, one%field <= DISPLACEMENTS))
            histories(n)%stages = one%stages
            call spread_over(model, one%value_slope, one%datum, histories(n))
         end associate
      end do
      do i = 1, size(histories)
         call measure(model, state, histories(i))
      end do
   end function load_histories_of

   !> A value that changes with z counts by its largest magnitude in the group.
   pure subroutine spread_over(model, slope, datum, history)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: slope, datum
      type(load_history_t), intent(inout) :: history
      real(wp), allocatable :: values(:)

      if (.not. abs(slope) > 0.0_wp) return
      history%value_slope = slope
      history%base = history%value - slope*datum
      values = history%base + slope*model%domain%mesh%x(2, model%domain%mesh%groups(history%group)%nodes)
      history%value = values(maxloc(abs(values), 1))
   end subroutine spread_over

   !> Start, offset and change.
   subroutine measure(model, state, history)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      type(load_history_t), intent(inout) :: history
      real(wp), allocatable :: times(:)
      real(wp) :: here, there
      integer :: i, k, node

      if (history%held) return
      if (history%kind == FORCE .or. history%kind == PRESSURE) history%start = value_at(model, history, 1, 0.0_wp)
      do i = 1, size(model%stages)
         times = breaks_of(model, history, i)
         do k = 1, size(times)
            history%change = max(history%change, abs(value_at(model, history, i, times(k)) - history%start))
         end do
      end do
      if (history%kind /= PRESSURE) return
      do k = 1, size(model%domain%mesh%groups(history%group)%nodes)
         node = model%domain%mesh%groups(history%group)%nodes(k)
         there = state%x(min(history%field, AT_P_C), node)
         if (history%field == PRESCRIBED_P_A) there = state%x(AT_P_W, node) + state%x(AT_P_C, node)
         here = history%start
         if (abs(history%value_slope) > 0.0_wp .and. acts_in(history%stages, model%stages(1)%name)) &
            here = (history%base + history%value_slope*model%domain%mesh%x(2, node)) &
                   *factor_at(model, history%amplitude, 0.0_wp)
         history%offset = max(history%offset, abs(here - there))
      end do
      history%change = history%change + history%offset
   end subroutine measure

   !> Jump, bends and slope of a load history in a stage. A support that comes or goes cannot be bounded.
   function pace_of(model, history, stage) result(pace)
      type(model_t), intent(in) :: model
      type(load_history_t), intent(in) :: history
      integer, intent(in) :: stage
      type(pace_t) :: pace
      real(wp), allocatable :: times(:)
      real(wp) :: slope, last, first
      logical :: acts, acted
      integer :: k

      acts = acts_in(history%stages, model%stages(stage)%name)
      acted = acts
      if (stage > 1) acted = acts_in(history%stages, model%stages(stage - 1)%name)
      if (history%kind == MOTION .or. history%kind == PRESSURE) then
         if (.not. history%lasting .or. (acted .neqv. acts)) pace%jump = UNBOUNDED
         if (.not. acts .or. .not. history%lasting .or. .not. acted .or. history%held) return
      end if
      times = breaks_of(model, history, stage)
      last = history%start
      if (stage > 1) then
         last = value_at(model, history, stage - 1, times(1))
         if (history%kind == MOTION .and. model%stages(stage - 1)%zero_displacements) last = 0.0_wp
      end if
      pace%jump = abs(value_at(model, history, stage, times(1)) - last)
      ! Prescribed pressures take hold where the pressures are free for the first time.
      if (history%kind == PRESSURE .and. all(model%stages(:stage - 1)%kind == STATIC)) &
         pace%jump = pace%jump + history%offset
      slope = 0.0_wp
      do k = 1, size(times) - 1
         first = slope
         slope = (value_at(model, history, stage, times(k + 1)) - value_at(model, history, stage, times(k))) &
                 /(times(k + 1) - times(k))
         pace%bends = pace%bends + abs(slope - first)
         pace%slope = max(pace%slope, abs(slope))
      end do
   end function pace_of

   !> Beginning and end of a stage, and the moments between them where the amplitude bends.
   function breaks_of(model, history, stage) result(times)
      type(model_t), intent(in) :: model
      type(load_history_t), intent(in) :: history
      integer, intent(in) :: stage
      real(wp), allocatable :: times(:)
      real(wp) :: t0, t1

      t0 = start_of(model, stage)
      t1 = t0 + model%stages(stage)%duration
      times = [t0, t1]
      if (history%amplitude == 0) return
      associate (t => model%amplitudes(history%amplitude)%times)
         times = [t0, pack(t, t > t0 .and. t < t1), t1]
      end associate
   end function breaks_of

   pure real(wp) function value_at(model, history, stage, time) result(value)
      type(model_t), intent(in) :: model
      type(load_history_t), intent(in) :: history
      integer, intent(in) :: stage
      real(wp), intent(in) :: time

      value = 0.0_wp
      if (acts_in(history%stages, model%stages(stage)%name)) value = history%value*factor_at(model, &
         history%amplitude, time)
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

   !> Area of a plate's face, or of the boundary that it is joined to [m2].
   pure real(wp) function face_of(model, plate)
      type(model_t), intent(in) :: model
      type(plate_t), intent(in) :: plate

      if (plate%group > 0) then
         face_of = area_of(model, plate%group)
      else
         associate (r => plate%r)
            face_of = (r(2) - r(1))*merge(PI*(r(1) + r(2)), 1.0_wp, model%domain%axisymmetric)
         end associate
      end if
   end function face_of
end module load_histories
