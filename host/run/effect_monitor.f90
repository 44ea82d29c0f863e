! SPDX-License-Identifier: MIT
!> Monitors, after every accepted step, what the effects that are off would do, and says once when that crosses the
!> threshold. A few sums over nodes and points; nothing is asked of the material.
module effect_monitor
   use kinds, only: wp
   use effect_types, only: effect_t, OF_P_W, OF_P_C, OF_INERTIA, OF_SEEPAGE, OF_GRAVITY, UNBOUNDED, NEVER
   use energy_ledger, only: ledger_t
   use linearised_body, only: mass_of_nodes
   use model_types, only: model_t
   use unknown_fields, only: DISPLACEMENTS, AT_P_W
   use porous_domain, only: state_t
   use generalised_alpha, only: DYNAMIC
   use texts, only: short
   implicit none (type, external)
   private
   public :: monitor_t, begin_monitor, begin_stage_of_monitor, monitor_step, warning_of, MEMORIES

   integer, parameter :: MEMORIES = 4
   integer, parameter :: MOST_A = 1, MOST_V = 2, WORK = 3, LEAST_P = 4   !< Places in `memory`.
   real(wp), parameter :: UNDER_WAY = 0.1_wp   !< A step that brings less than this share of all work is well under way.

   type :: monitor_t
      type(effect_t), allocatable :: table(:)
      real(wp), allocatable :: mass(:), stress(:, :)   !< Of nodes [Mg]; at the start [kPa].
      real(wp) :: memory(MEMORIES) = 0.0_wp            !< Extremes so far, and the work up to the last step.
   end type monitor_t
contains
   subroutine begin_monitor(model, state, monitor)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      type(monitor_t), intent(out) :: monitor
      integer :: i

      monitor%table = model%effects
      monitor%mass = mass_of_nodes(model, state)
      do i = 1, size(model%plates)
         monitor%mass(model%plates(i)%node) = monitor%mass(model%plates(i)%node) + model%plates(i)%mass
      end do
      monitor%stress = state%stress
      monitor%memory(LEAST_P) = huge(1.0_wp)
   end subroutine begin_monitor

   !> A stage begins: its own extremes of motion.
   pure subroutine begin_stage_of_monitor(monitor)
      type(monitor_t), intent(inout) :: monitor

      monitor%memory([MOST_A, MOST_V]) = 0.0_wp
   end subroutine begin_stage_of_monitor

   !> Indicators of a step; `news` marks those that cross their threshold with it.
   subroutine monitor_step(model, stage, dt, last, ledger, old, new, monitor, news)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage
      real(wp), intent(in) :: dt
      logical, intent(in) :: last          !< The stage ends with it.
      type(ledger_t), intent(in) :: ledger
      type(state_t), intent(in) :: old, new
      type(monitor_t), intent(inout) :: monitor
      logical, intent(out) :: news(:)
      real(wp) :: value, limit
      integer :: i

      news = .false.
      do i = 1, size(monitor%table)
         associate (t => monitor%table(i))
            if (.not. t%monitored .or. (t%kind == OF_INERTIA .and. t%stage /= stage)) cycle
            limit = t%threshold
            value = 0.0_wp
            select case (t%kind)
            case (OF_P_C)
               value = maxval(-new%x(AT_P_W, :), mask=model%dofs%of(AT_P_W, :) > 0)
               ! Newton's tolerance lets the pressures wander.
               limit = max(limit, model%stages(stage)%tolerance*maxval(abs(new%x(AT_P_W, :))))
            case (OF_P_W)
               value = t%scale*maxval(abs(new%e - old%e)/(1 + new%e))/dt
            case (OF_INERTIA)
               value = motion_share(t%scale)
            case (OF_SEEPAGE)
               if (model%stages(stage)%kind == DYNAMIC) value = frequency(t%scale)
            case (OF_GRAVITY)
               value = weight_share(t)
            end select
            t%largest = max(t%largest, value)
            if (.not. value > limit .or. t%crossed > NEVER) cycle
            t%crossed = new%time
            news(i) = .true.
         end associate
      end do
      monitor%memory(WORK) = max(monitor%memory(WORK), work_of(ledger))
   contains
      !> Speed of a motion without inertia, as the vibration that it would leave: its kinetic energy against the strain
      !> energy that the loads are expected to bring, or the work done where nothing can be expected.
      real(wp) function motion_share(expected) result(share)
         real(wp), intent(in) :: expected   !< [kJ**(1/2)]
         real(wp) :: speed, all_work

         share = 0.0_wp
         speed = sqrt(sum(monitor%mass*sum(((new%x(:DISPLACEMENTS, :) - old%x(:DISPLACEMENTS, :))/dt)**2, dim=1)))
         all_work = work_of(ledger)
         if (all_work - monitor%memory(WORK) > UNDER_WAY*all_work) all_work = 0.0_wp
         all_work = max(expected, sqrt(2*all_work))
         if (all_work > 0.0_wp) share = min(speed/all_work, UNBOUNDED)
      end function motion_share

      !> Speed against that of the slowest vibration with the expected energy, times its frequency; where nothing can be
      !> expected the largest acceleration over the largest speed, once the speed has passed a maximum.
      real(wp) function frequency(slow)
         real(wp), intent(in) :: slow   !< [kJ**(1/2) s]
         real(wp) :: v

         frequency = 0.0_wp
         v = sqrt(sum(monitor%mass*sum(new%v(:DISPLACEMENTS, :)**2, dim=1)))
         monitor%memory(MOST_A) = max(monitor%memory(MOST_A), sqrt(sum(monitor%mass*sum(new%a**2, dim=1))))
         if (slow > 0.0_wp) then
            frequency = min(v/slow, UNBOUNDED)
         else if (v < monitor%memory(MOST_V)) then
            frequency = min(monitor%memory(MOST_A)/monitor%memory(MOST_V), UNBOUNDED)
         end if
         monitor%memory(MOST_V) = max(monitor%memory(MOST_V), v)
      end function frequency

      !> The weight against the stresses that there are: at the end of a stage the largest change of stress, and always
      !> the least mean stress of a plastic material.
      real(wp) function weight_share(effect) result(value)
         type(effect_t), intent(in) :: effect
         real(wp) :: seen
         integer :: e

         associate (m => model%domain)
            do e = 1, size(m%mesh%t6, 2)
               if (m%regions(m%region_of(e))%law%has_energy) cycle
               associate (stress => new%stress(1:3, (e - 1)*m%rule + 1:e*m%rule))
                  monitor%memory(LEAST_P) = min(monitor%memory(LEAST_P), max(0.0_wp, minval(-sum(stress, dim=1)/3)))
               end associate
            end do
         end associate
         seen = monitor%memory(LEAST_P)
         if (last) seen = min(seen, maxval(abs(new%stress - monitor%stress)))
         value = 0.0_wp
         if (seen < huge(1.0_wp)) value = min(effect%scale/max(seen, tiny(1.0_wp)*effect%scale), UNBOUNDED) &
                                          *effect%threshold/model%effect_options%tolerance
      end function weight_share
   end subroutine monitor_step

   pure real(wp) function work_of(ledger)
      type(ledger_t), intent(in) :: ledger

      work_of = abs(ledger%loads + ledger%supports + ledger%gravity)
   end function work_of

   !> What crossed, when, and what to set.
   function warning_of(model, effect) result(text)
      type(model_t), intent(in) :: model
      type(effect_t), intent(in) :: effect
      character(:), allocatable :: text

      select case (effect%kind)
      case (OF_P_C)
         text = 'suction in saturated soil without p_c'
      case (OF_P_W)
         text = 'pore pressure left by drainage, as a share of the loads'
      case (OF_INERTIA)
         text = 'vibration left out, as a share of the response'
      case (OF_SEEPAGE)
         text = 'frequency of the motion'
      case default
         text = 'weight against the stresses that there are'
      end select
      text = 'Warning: '//trim(effect%name)//' is off, but at '//short(effect%crossed)//' s '//text// &
             ' rose above '//short(effect%threshold)//merge(' '//effect%unit, '         ', effect%unit /= '-')
      text = trim(text)//' (largest so far '//short(effect%largest)//'); '
      select case (effect%kind)
      case (OF_P_C)
         text = text//'give the regions a retention and set fields = ''u-p_w-p_c'' in &scene.'
      case (OF_P_W)
         text = text//'set fields = ''u-p_w'' in &scene.'
      case (OF_INERTIA)
         text = text//'set analysis = ''dynamic'' in &stage '//trim(model%stages(effect%stage)%name)//'.'
      case (OF_SEEPAGE)
         text = text//'set seepage_inertia = ''yes'' in &scene if the soil is saturated; else the u-p form is doubtful.'
      case default
         text = text//'set gravity = 9.81 in &scene.'
      end select
   end function warning_of
end module effect_monitor
