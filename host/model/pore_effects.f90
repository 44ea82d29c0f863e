! SPDX-License-Identifier: MIT
!> Whether a scene calls for the fields of the pores: suction and pore water pressure.
module pore_effects
   use kinds, only: wp, PI
   use load_histories, only: FORCE, MOTION, PRESSURE, FLOW
   use effect_facts, only: facts_t, judge, ROUNDING
   use linearised_body, only: linearised_body_t
   use effect_types, only: effect_t, UNBOUNDED, UNKNOWN
   use model_types, only: model_t, PRESCRIBED_P_A
   use scene_types, only: acts_in, LOAD_WATER, LOAD_AIR
   use unknown_fields, only: AT_P_W, AT_P_C, DISPLACEMENTS
   use permeability_laws, only: relative_permeability, relative_t
   use material_point, only: material_t, saturation_t
   use retention_curves, only: saturated_t
   use generalised_alpha, only: DYNAMIC
   use texts, only: short
   implicit none (type, external)
   private
   public :: judge_suction, judge_water

   real(wp), parameter :: OVERSHOOT = 2.0_wp    !< A pore pressure may fall by so many times the loads' changes.
contains
   !> The largest suction that may arise against that at which the air in the pores begins to count: where it adds
   !> a share `tolerance` to the compressibility of soil and water.
   subroutine judge_suction(model, body, facts, effect)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      type(facts_t), intent(in) :: facts
      type(effect_t), intent(inout) :: effect
      character(64) :: why
      real(wp) :: suction
      logical :: full
      integer :: i

      if (.not. model%domain%with_c) then
         effect%threshold = facts%tolerance*facts%acting
         effect%why = 'no region has a retention law'
         if (effect%by_hand) effect%why = 'no such field'
         effect%monitored = model%domain%with_w
         return
      end if
      effect%threshold = harmless_suction(model, facts)
      ! What would be lost with p_c even in saturated soil: air that flows in, and p_w as a difference of two others.
      full = .not. (facts%plastic .or. any(model%loads%kind == LOAD_AIR) .or. prescribe_water())
      do i = 1, size(model%domain%regions)
         full = full .and. is_saturated(model%domain%regions(i)%law)
      end do
      if (full) then
         call judge(effect, 0.0_wp, 'saturated by its law, and no stiffness depends on suction', .true.)
         return
      end if
      call look_for_bound()
      if (why /= '') then
         call judge(effect, UNBOUNDED, 'not bounded: '//why, .true.)
      else
         suction = largest_suction(model, body, facts)
         call judge(effect, max(suction, 0.0_wp), 'largest suction from pressures, weight and loads', .true.)
      end if
      effect%monitored = .not. effect%on
   contains
      pure logical function prescribe_water()
         prescribe_water = any(facts%histories%field == AT_P_C) .and. any(facts%histories%field == PRESCRIBED_P_A)
      end function prescribe_water

      !> Why nothing says how far the water pressure may fall; empty if something does.
      subroutine look_for_bound()
         integer :: k

         why = ''
         associate (a => facts%histories)
            if (any(a%kind == FORCE .and. a%change > 0.0_wp .and. .not. a%stress > 0.0_wp)) why = 'forces on nodes'
            if (any(a%kind == MOTION .and. (a%change > 0.0_wp .or. .not. a%lasting))) why = 'boundaries that move'
            if (any(abs(body%state%v(:DISPLACEMENTS, :)) > 0.0_wp)) why = 'it moves at the start'
            if (prescribe_water()) why = 'p_c and p_a prescribe p_w'
            do k = 1, size(model%loads)
               if (model%loads(k)%kind == LOAD_AIR) why = 'inflow of air'
               if (model%loads(k)%kind == LOAD_WATER .and. (model%loads(k)%value < 0.0_wp .or. &
                   abs(model%loads(k)%value_slope) > 0.0_wp)) why = 'outflow of water'
               if (model%loads(k)%kind /= LOAD_WATER .or. model%loads(k)%amplitude == 0) cycle
               if (any(model%amplitudes(model%loads(k)%amplitude)%values < 0.0_wp)) why = 'outflow of water'
            end do
            if (facts%loose > facts%tolerance) why = 'forces without balance'
            if (.not. facts%held) why = 'nothing holds the body, or it has no stiffness'
            if (size(model%contacts) > 0) why = 'contact'
            if (facts%plastic) why = 'dilatancy of a plastic material'
         end associate
      end subroutine look_for_bound
   end subroutine judge_suction

   !> Whether a region is saturated by definition. A law with a retention of its own is not.
   pure logical function is_saturated(law)
      class(material_t), intent(in) :: law

      is_saturated = .false.
      if (.not. allocated(law%curve)) return
      select type (curve => law%curve)
      type is (saturated_t)
         is_saturated = .true.
      end select
   end function is_saturated

   !> p_a at its highest less p_w at its lowest. Flow alone leaves the potential of the water within its initial and
   !> prescribed values; loads may lower p_w by OVERSHOOT times their changes.
   real(wp) function largest_suction(model, body, facts) result(suction)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      type(facts_t), intent(in) :: facts
      real(wp) :: lowest, air, fall, unit_weight
      integer :: i
      logical :: told

      associate (m => model%domain, x => body%state%x, has => body%dofs%of(AT_P_W, :) > 0)
         unit_weight = m%fluids%rho_w*m%gravity
         lowest = minval(x(AT_P_W, :) + unit_weight*m%mesh%x(2, :), mask=has)
         suction = maxval(x(AT_P_C, :), mask=has)
         ! A scene that says nothing of suction has its air at the atmosphere.
         told = any(abs(model%initials%p_c) > 0.0_wp .or. abs(model%initials%p_c_slope) > 0.0_wp) .or. &
                any(facts%histories%kind == PRESSURE .and. facts%histories%field >= AT_P_C)
         air = 0.0_wp
         if (told) air = maxval(x(AT_P_W, :) + x(AT_P_C, :), mask=has)
         fall = 0.0_wp
         do i = 1, size(facts%histories)
            associate (a => facts%histories(i))
               if (a%kind == FORCE) then
                  fall = fall + a%stress*a%change
               else if (a%kind == PRESSURE .and. .not. a%held) then
                  if (a%field == AT_P_W) lowest = min(lowest, a%start - a%change + unit_weight* &
                                                 minval(m%mesh%x(2, m%mesh%groups(a%group)%nodes)))
                  if (a%field == AT_P_C) suction = max(suction, a%start + a%change)
                  if (a%field == PRESCRIBED_P_A) air = max(air, a%start + a%change)
               end if
            end associate
         end do
         suction = max(suction, air - (lowest - unit_weight*facts%high(2) - OVERSHOOT*fall))
      end associate
   end function largest_suction

   !> Up to it n |dS/dp_c| + n (1 - S)/K_a stays below tolerance (1/M + n/K_w) in every region.
   real(wp) function harmless_suction(model, facts) result(suction)
      type(model_t), intent(in) :: model
      type(facts_t), intent(in) :: facts
      real(wp), parameter :: FINEST = 1.0e-6_wp, RATIO = 1.1_wp
      integer, parameter :: STEPS = 200
      type(saturation_t) :: sat
      real(wp) :: p_c, n, k_a
      integer :: i, k

      suction = huge(1.0_wp)
      associate (m => model%domain)
         k_a = merge(m%fluids%p_ref, m%fluids%k_a, m%fluids%ideal_gas)
         do i = 1, size(m%regions)
            n = m%regions(i)%void_ratio/(1 + m%regions(i)%void_ratio)
            do k = 0, STEPS
               p_c = FINEST*RATIO**k
               sat = m%regions(i)%law%retention(p_c, m%regions(i)%void_ratio)
               if (n*abs(sat%ds_dpc) + n*(1 - sat%s)/k_a > facts%tolerance*(1/max(facts%m_max, ROUNDING) &
                                                                            + n/m%fluids%k_w)) exit
            end do
            suction = min(suction, merge(p_c/RATIO, 0.0_wp, k > 0))
         end do
      end associate
   end function harmless_suction

   !> The pore pressure that loads raise before it drains, as a share of them: the jumps, and the fastest slope times
   !> the time of consolidation. Only a rectangle with a whole side at p_w = 0 has a bound on the drainage path; the
   !> water must matter neither by its weight nor by its inertia.
   subroutine judge_water(model, body, facts, suction, effect)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      type(facts_t), intent(in) :: facts
      logical, intent(in) :: suction   !< p_c is on.
      type(effect_t), intent(inout) :: effect
      real(wp) :: path, time, share, conductivity

      if (.not. model%domain%with_w) then
         effect%why = 'no region has a permeability'
         effect%threshold = UNKNOWN
         if (effect%by_hand) effect%why = 'no such field'
         return
      end if
      path = drainage_path(model, body, facts)
      conductivity = least_conductivity(model)
      share = UNBOUNDED
      if (suction .and. .not. effect%by_hand) then
         effect%why = 'p_c needs it'
      else if (model%domain%gravity > 0.0_wp .or. any(model%stages%kind == DYNAMIC)) then
         effect%why = 'not bounded: weight or inertia of the water'
      else if (any(abs(body%state%x(AT_P_W, :)) > 0.0_wp) .or. &
               any(facts%histories%kind == PRESSURE .and. facts%histories%field == AT_P_W .and. &
                   (facts%histories%change > 0.0_wp .or. abs(facts%histories%start) > 0.0_wp)) .or. &
               any(facts%histories%kind == FLOW)) then
         effect%why = 'pore pressures or flows are given'
      else if (size(model%contacts) > 0 .or. &
               any(facts%histories%kind == MOTION .and. facts%histories%change > 0.0_wp)) then
         effect%why = 'not bounded: contact, or boundaries that move'
      else if (path >= UNBOUNDED) then
         effect%why = 'not bounded: no rectangle with a whole side at p_w = 0'
      else if (.not. (facts%m_min > 0.0_wp .and. facts%held)) then
         effect%why = 'not bounded: nothing holds the body, or it has no stiffness'
      else
         time = path**2/conductivity*(1/facts%m_min + 1/model%domain%fluids%k_w)
         share = max(maxval(facts%jump), facts%loose) + maxval(facts%pace)*time
         effect%why = 'undrained share; consolidation takes '//short(time)//' s'
         effect%scale = path**2/(2*conductivity)/max(facts%acting, ROUNDING)
      end if
      call judge(effect, share, trim(effect%why), .true.)
      effect%monitored = .not. effect%on
   end subroutine judge_water

   !> Distance from a wholly drained side to the opposite one.
   real(wp) function drainage_path(model, body, facts) result(path)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      type(facts_t), intent(in) :: facts
      logical :: open(size(model%domain%mesh%x, 2))
      real(wp) :: area, wide(2)
      integer :: i, k, e, g

      path = UNBOUNDED
      wide = facts%high - facts%low
      associate (m => model%domain)
         area = 0.0_wp
         do e = 1, size(m%mesh%t6, 2)
            do g = 1, m%rule
               area = area + m%gauss(g, e)%weight/merge(2*PI*m%gauss(g, e)%x(1), 1.0_wp, m%axisymmetric)
            end do
         end do
         if (abs(area - product(wide)) > ROUNDING*area) return
         open = .false.
         do i = 1, size(facts%histories)
            associate (a => facts%histories(i))
               if (a%kind /= PRESSURE .or. .not. a%lasting .or. a%held) cycle
               if (a%field == AT_P_W .and. all([(acts_in(a%stages, model%stages(k)%name), k=1, size(model%stages))])) &
                  open(m%mesh%groups(a%group)%nodes) = .true.
            end associate
         end do
         do i = 1, 2
            if (all(open .or. body%dofs%of(AT_P_W, :) == 0 .or. m%mesh%x(i, :) < facts%high(i) - ROUNDING*wide(i))) &
               path = min(path, wide(i))
            ! Towards a hole on the axis the flow converges.
            if (i == 1 .and. m%axisymmetric) cycle
            if (all(open .or. body%dofs%of(AT_P_W, :) == 0 .or. m%mesh%x(i, :) > facts%low(i) + ROUNDING*wide(i))) &
               path = min(path, wide(i))
         end do
      end associate
   end function drainage_path

   !> Permeability over viscosity of the tightest region, saturated [m2/(kPa s)].
   real(wp) function least_conductivity(model) result(least)
      type(model_t), intent(in) :: model
      type(relative_t) :: rel
      integer :: i

      least = huge(1.0_wp)
      do i = 1, size(model%domain%regions)
         associate (law => model%domain%permeabilities(model%domain%regions(i)%permeability))
            rel = relative_permeability(law, 1.0_wp)
            least = min(least, law%intrinsic*rel%w/model%domain%fluids%eta_w)
         end associate
      end do
   end function least_conductivity
end module pore_effects
