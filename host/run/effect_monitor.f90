! SPDX-License-Identifier: MIT
!> Monitors, after every accepted step, what the pilots could not see: an indicator of every effect that they removed,
!> against the largest value that it had in the pilot without the effect. A few sums over nodes and points; nothing is
!> asked of the material. docs/theory/host.md section 11.
module effect_monitor
   use kinds, only: wp
   use effect_types, only: effect_t, OF_P_W, OF_P_C, OF_INERTIA, OF_SEEPAGE, OF_GRAVITY, OF_FLOW, NEVER
   use model_types, only: model_t
   use unknown_fields, only: DISPLACEMENTS, AT_P_W
   use porous_domain, only: state_t, mixture_density, is_present
   use generalised_alpha, only: DYNAMIC
   use texts, only: short
   implicit none (type, external)
   private
   public :: monitor_t, begin_monitor, monitor_step, indicator_of, mass_of_nodes, is_watched, warning_of

   type :: monitor_t
      type(effect_t), allocatable :: table(:)
      real(wp), allocatable :: mass(:)         !< Of nodes [Mg].
   end type monitor_t
contains
   !> Starts to monitor the effects of a model that are off.
   subroutine begin_monitor(model, state, monitor)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      type(monitor_t), intent(out) :: monitor

      monitor%table = model%effects
      monitor%mass = mass_of_nodes(model, state)
   end subroutine begin_monitor

   !> Mass of the soil and of the plates, shared out to nodes [Mg]. Of every element an equal part to each of its six
   !> nodes; of a plate all to its own. For indicator_of.
   function mass_of_nodes(model, state) result(mass)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      real(wp) :: mass(size(model%domain%mesh%x, 2)), part
      integer :: e, g, p, i

      mass = 0.0_wp
      associate (m => model%domain)
         do e = 1, size(m%mesh%t6, 2)
            do g = 1, m%rule
               p = (e - 1)*m%rule + g
               part = m%gauss(g, e)%weight/6*mixture_density(m, m%regions(m%region_of(e)), &
                      state%e(p)/(1 + state%e(p)), state%s(p))
               mass(m%mesh%t6(:, e)) = mass(m%mesh%t6(:, e)) + part
            end do
         end do
      end associate
      do i = 1, size(model%plates)
         mass(model%plates(i)%node) = mass(model%plates(i)%node) + model%plates(i)%mass
         if (model%plates(i)%turns) mass(model%plates(i)%turn_node) = model%plates(i)%inertia/model%plates(i)%lever**2
      end do
   end function mass_of_nodes

   !> Whether an effect leaves a trace in a run without it.
   pure logical function is_watched(kind)
      integer, intent(in) :: kind   !< One of OF_...

      is_watched = any([OF_INERTIA, OF_SEEPAGE, OF_P_W, OF_P_C, OF_GRAVITY, OF_FLOW] == kind)
   end function is_watched

   !> Indicators of a step; `news` marks those that pass their limit with it. docs/theory/host.md section 11.
   subroutine monitor_step(model, stage, dt, old, new, monitor, news)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Its number.
      real(wp), intent(in) :: dt   !< [s]
      type(state_t), intent(in) :: old, new
      type(monitor_t), intent(inout) :: monitor
      logical, intent(out) :: news(:)   !< (rows of the table)
      real(wp) :: value
      integer :: i

      news = .false.
      do i = 1, size(monitor%table)
         associate (t => monitor%table(i))
            if (t%limit < 0.0_wp) cycle
            value = indicator_of(t, model, stage, dt, monitor%mass, old, new)
            t%largest = max(t%largest, value)
            if (.not. value > t%limit .or. t%crossed > NEVER) cycle
            t%crossed = new%time
            news(i) = .true.
         end associate
      end do
   end subroutine monitor_step

   !> What an effect would act on, in a step without it: of inertia the speed [kJ**(1/2)], of the relative acceleration
   !> the acceleration [m/s2], of p_w the rate of volume [1/s], of flow that in its region, of p_c the tension of the
   !> water [kPa], of gravity the inverse of the least mean effective stress of a material that yields [1/kPa].
   !> docs/theory/host.md section 11. 0 of effects that leave no trace.
   real(wp) function indicator_of(effect, model, stage, dt, mass, old, new) result(value)
      type(effect_t), intent(in) :: effect   !< Its kind, and the stage of an inertia or the region of a flow.
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Number of the present one.
      real(wp), intent(in) :: dt, mass(:)   !< [s]; (nodes) [Mg], of mass_of_nodes.
      type(state_t), intent(in) :: old, new
      real(wp) :: least
      integer :: e

      value = 0.0_wp
      select case (effect%kind)
      case (OF_INERTIA)
         if (effect%stage == stage) value = &
            sqrt(sum(mass*sum(((new%x(:DISPLACEMENTS, :) - old%x(:DISPLACEMENTS, :))/dt)**2, dim=1)))
      case (OF_SEEPAGE)
         if (model%stages(stage)%kind == DYNAMIC) value = sqrt(maxval(sum(new%a**2, dim=1)))
      case (OF_P_W)
         value = maxval(abs(new%e - old%e)/(1 + new%e))/dt
      case (OF_FLOW)
         associate (m => model%domain)
            do e = 1, size(m%region_of)
               if (m%region_of(e) /= effect%region) cycle
               associate (one => old%e((e - 1)*m%rule + 1:e*m%rule), two => new%e((e - 1)*m%rule + 1:e*m%rule))
                  value = max(value, maxval(abs(two - one)/(1 + two))/dt)
               end associate
            end do
         end associate
      case (OF_P_C)
         value = max(0.0_wp, maxval(-new%x(AT_P_W, :), mask=model%dofs%of(AT_P_W, :) > 0))
      case (OF_GRAVITY)
         least = huge(1.0_wp)
         associate (m => model%domain)
            do e = 1, size(m%mesh%t6, 2)
               if (m%regions(m%region_of(e))%law%has_energy .or. .not. is_present(new, e)) cycle
               least = min(least, minval(-sum(new%stress(1:3, (e - 1)*m%rule + 1:e*m%rule), dim=1)/3))
            end do
         end associate
         if (least < huge(1.0_wp)) value = 1/max(least, tiny(1.0_wp)/epsilon(1.0_wp))
      end select
   end function indicator_of

   !> What passed its limit, when, and what to set.
   function warning_of(effect) result(text)
      type(effect_t), intent(in) :: effect
      character(:), allocatable :: text

      select case (effect%kind)
      case (OF_P_C)
         text = 'the tension of the water [kPa]'
      case (OF_P_W, OF_FLOW)
         text = 'the rate of volume of the soil [1/s]'
      case (OF_INERTIA)
         text = 'the speed of the motion [root of kJ]'
      case (OF_SEEPAGE)
         text = 'the acceleration [m/s2]'
      case default
         text = 'the inverse of the least mean stress [1/kPa]'
      end select
      text = trim(effect%name)//' is off, as its pilot has found, but at '//short(effect%crossed)//' s '//text// &
             ' rose to '//short(effect%largest)//', above '//short(effect%limit)//', which is what the pilot can '// &
             'vouch for; '
      select case (effect%kind)
      case (OF_P_C)
         text = text//'set fields = ''u-p_w-p_c'' in &scene.'
      case (OF_P_W)
         text = text//'set fields = ''u-p_w'' in &scene.'
      case (OF_FLOW)
         text = text//'set drainage = ''coupled'' in that &region.'
      case (OF_INERTIA)
         text = text//'set analysis = ''dynamic'' in &stage.'
      case (OF_SEEPAGE)
         text = text//'set seepage_inertia = ''yes'' in &scene if the soil is saturated; else the u-p form is doubtful.'
      case default
         text = text//'set gravity = 9.81 in &scene.'
      end select
   end function warning_of
end module effect_monitor
