! SPDX-License-Identifier: MIT
!> Which effects a scene calls for: fields, inertia, relative acceleration, gravity. What the keys leave out is
!> derived: an effect is off only where a bound of what it does is below the scene's tolerance. Bounds use the stiffness
!> at the start; of a plastic material they keep a reserve (PLASTIC).
module effect_decisions
   use kinds, only: wp, PI
   use load_histories, only: pace_t, pace_of
   use effect_facts, only: facts_t, gather, judge, PLASTIC, ROUNDING
   use body_response, only: response_of, imbalance_of
   use linearised_body, only: linearised_body_t, prepare_body, support, mass_of_nodes, release_body
   use pore_effects, only: judge_suction, judge_water
   use effect_types, only: effect_t, OF_P_W, OF_P_C, OF_INERTIA, OF_SEEPAGE, OF_GRAVITY, UNBOUNDED, &
                         UNKNOWN
   use permeability_laws, only: relative_permeability, relative_t
   use generalised_alpha, only: STATIC, QUASI_STATIC, DYNAMIC
   use faults, only: fault_t
   use model_types, only: model_t
   use scene_types, only: acts_in
   use unknown_fields, only: AT_P_W, AT_P_C, DISPLACEMENTS
   use texts, only: short
   implicit none (type, external)
   private
   public :: derive_effects

contains
   !> Decides, makes the model what was decided, and keeps the table in it.
   subroutine derive_effects(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(linearised_body_t) :: body
      type(facts_t) :: facts
      type(effect_t) :: water, suction, seepage, gravity
      type(effect_t), allocatable :: inertia(:)
      integer :: i

      allocate (inertia(size(model%stages)))
      call prepare_body(model, body, fault)
      if (fault%code == 0) then
         call gather(model, body, facts)
         gravity = effect_t(OF_GRAVITY, name='gravity', by_hand=model%effect_options%gravity_by_hand, unit='kPa')
         call judge_gravity(model, body, facts, gravity)
         if (.not. gravity%on .and. model%domain%gravity > 0.0_wp) then
            model%domain%gravity = 0.0_wp
            call release_body(model, body)
            call prepare_body(model, body, fault)
         end if
      end if
      if (fault%code /= 0) then
         call release_body(model, body)
         return
      end if
      do i = 1, size(model%stages)
         inertia(i) = effect_t(OF_INERTIA, i, 'inertia in '//model%stages(i)%name, &
                               by_hand=.not. model%stages(i)%derived, threshold=facts%tolerance)
         call judge_inertia(model, i, body, facts, inertia(i))
         if (model%stages(i)%derived) model%stages(i)%kind = merge(DYNAMIC, QUASI_STATIC, inertia(i)%on)
      end do
      suction = effect_t(OF_P_C, name='field p_c', by_hand=model%effect_options%fields_by_hand, unit='kPa')
      call cost_of(body, AT_P_C, suction)
      call judge_suction(model, body, facts, suction)
      water = effect_t(OF_P_W, name='field p_w', by_hand=model%effect_options%fields_by_hand, threshold=facts%tolerance)
      call cost_of(body, AT_P_W, water)
      call judge_water(model, body, facts, suction%on, water)
      call release_body(model, body)
      call keep_fields(water%on, suction%on, model)
      seepage = effect_t(OF_SEEPAGE, name='relative acceleration', unit='rad/s', &
                         by_hand=model%effect_options%seepage_by_hand)
      call judge_seepage(model, facts, seepage)
      model%domain%seepage_inertia = seepage%on
      model%effects = [water, suction, inertia, seepage, gravity]
   end subroutine derive_effects

   !> Weight against the smallest stress that matters: that of the loads, the mean stress a plastic material begins
   !> with, the suction.
   subroutine judge_gravity(model, body, facts, effect)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      type(facts_t), intent(in) :: facts
      type(effect_t), intent(inout) :: effect
      real(wp) :: least

      least = facts%acting
      if (facts%plastic) least = merge(min(least, facts%p_min), facts%p_min, least > 0.0_wp)
      if (model%domain%with_c) least = min(least, minval(abs(body%state%x(AT_P_C, :)), mask=body%dofs%of(AT_P_C, &
         :) > 0))
      effect%threshold = facts%tolerance*least
      effect%scale = facts%weight
      call judge(effect, facts%weight, 'height rho g against '//short(least)//' kPa that act', &
                 model%domain%gravity > 0.0_wp)
      if (any(model%plates%heavy) .or. any(model%initials%geostatic)) then
         if (.not. effect%by_hand) effect%on = .true.
         effect%why = 'the scene asks for weight: geostatic stress or a heavy plate'
      else if (effect%on .and. .not. effect%by_hand) then
         effect%why = trim(effect%why)//'; acts from the start'
      end if
      ! The weight is certain: above the threshold there is nothing left to see.
      effect%monitored = .not. effect%on .and. facts%weight <= effect%threshold
   end subroutine judge_gravity

   !> The vibration that quasi-static steps leave out, as a share of the response: a jump leaves all of it, a bend of a
   !> load by ds leaves ds/omega of it, whatever comes after; omega is the slowest free vibration.
   subroutine judge_inertia(model, stage, body, facts, effect)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage
      type(linearised_body_t), intent(inout) :: body
      type(facts_t), intent(inout) :: facts
      type(effect_t), intent(inout) :: effect
      type(pace_t) :: pace
      real(wp) :: energy, carried, share, squares, omega, loose, seepage, bend
      character(:), allocatable :: why
      integer :: i

      seepage = 0.0_wp
      if (all(model%stages(:stage - 1)%kind == STATIC)) seepage = seepage_at_start(model, body)
      associate (now => model%stages(stage))
         if (.not. now%derived .and. now%kind == STATIC) then
            effect%why = 'static: a way to equilibrium, given by hand'
            return
         end if
         call support(model, stage, body)
         facts%held = facts%held .and. body%omega > 0.0_wp
         omega = body%omega/merge(sqrt(PLASTIC), 1.0_wp, facts%plastic)
         why = 'free vibrations from '//short(body%omega)//' rad/s'
         if (facts%plastic) why = why//', bound with '//short(omega)
         squares = 0.0_wp
         share = 0.0_wp
         do i = 1, size(facts%histories)
            associate (a => facts%histories(i))
               pace = pace_of(model, a, stage)
               call response_of(model, a, body, energy, carried)
               squares = squares + energy**2
               if (pace%jump >= UNBOUNDED) then
                  facts%jump(stage) = UNBOUNDED
                  why = 'not bounded: a support comes or goes'
               end if
               if (.not. a%change > 0.0_wp) cycle
               facts%jump(stage) = max(facts%jump(stage), pace%jump/a%change)
               facts%pace(stage) = max(facts%pace(stage), pace%slope/a%change)
               facts%bends(stage) = max(facts%bends(stage), pace%bends/a%change)
               if (omega > 0.0_wp) share = max(share, min(UNBOUNDED, (pace%jump + pace%bends/omega)/a%change*carried))
            end associate
         end do
         if (stage == 1) then
            loose = imbalance_of(model, stage, body)
            squares = squares + loose**2
            if (loose > 0.0_wp) facts%loose = loose/sqrt(squares)
            if (facts%loose > facts%tolerance) why = why//'; forces without balance'
            share = min(UNBOUNDED, share + facts%loose)
         end if
         if (facts%jump(stage) > facts%tolerance .and. facts%jump(stage) < UNBOUNDED) why = why//'; a jump'
         share = max(share, facts%jump(stage))
         effect%scale = sqrt(squares)
         if (seepage > 0.0_wp) then
            bend = 2*seepage*sqrt(sum(mass_of_nodes(model, body%state)))
            if (bend > facts%tolerance*effect%scale) why = why//'; fluids begin to flow'
            share = min(UNBOUNDED, share + min(UNBOUNDED, bend/max(effect%scale, bend/UNBOUNDED)))
         end if
         ! What has no bound.
         if (any([(acts_in(model%contacts(i)%stages, now%name), i=1, size(model%contacts))])) then
            why = 'not bounded: contact'
            share = UNBOUNDED
         else if (any(model%domain%regions%damping > 0.0_wp)) then
            why = 'not bounded: a damping is given'
            share = UNBOUNDED
         else if (.not. omega > 0.0_wp) then
            why = 'not bounded: nothing holds the body, or it has no stiffness'
            share = UNBOUNDED
         else if (stage == 1 .and. any(abs(body%state%v(:DISPLACEMENTS, :)) > 0.0_wp)) then
            why = 'not bounded: it moves at the start'
            share = UNBOUNDED
         else if (stage > 1) then
            if (model%stages(stage - 1)%kind == DYNAMIC) then
               why = 'not bounded: the stage before is dynamic'
               share = UNBOUNDED
            end if
         end if
         call judge(effect, share, why, now%kind == DYNAMIC)
         effect%monitored = .not. effect%on
         ! The fastest that the loads bring; a jump brings all that the steps can carry.
         facts%omega(stage) = 0.5_wp*PI*facts%pace(stage)
         if (facts%jump(stage) > facts%tolerance .or. (stage == 1 .and. facts%loose > facts%tolerance) &
             .or. share >= UNBOUNDED) facts%omega(stage) = PI/now%dt
         facts%bends(stage) = max(facts%bends(stage), facts%omega(stage))
         if (omega > 0.0_wp) facts%slow(stage) = effect%scale/body%omega
      end associate
   end subroutine judge_inertia

   !> How fast the pore fluids begin to flow by themselves [m/s]. The skeleton follows them no faster.
   real(wp) function seepage_at_start(model, body) result(fastest)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      type(relative_t) :: rel
      real(wp) :: drive(2), weight(2), k
      integer :: e, g

      fastest = 0.0_wp
      if (.not. model%domain%with_w .or. model%subtract_flow) return
      associate (m => model%domain, x => body%state%x)
         do e = 1, size(m%mesh%t6, 2)
            associate (law => m%permeabilities(m%regions(m%region_of(e))%permeability), node => m%mesh%t6(:m%n_p, e))
               do g = 1, m%rule
                  rel = relative_permeability(law, body%state%s((e - 1)*m%rule + g))
                  drive = matmul(m%gauss(g, e)%dm(:, :m%n_p), x(AT_P_W, node))
                  weight = [0.0_wp, m%fluids%rho_w*m%gravity]
                  k = beyond_rounding(drive, weight)*rel%w/m%fluids%eta_w
                  if (m%with_c) then
                     drive = drive + matmul(m%gauss(g, e)%dm(:, :m%n_p), x(AT_P_C, node))
                     weight = [0.0_wp, m%fluids%rho_a*m%gravity]
                     k = k + beyond_rounding(drive, weight)*rel%a/m%fluids%eta_a
                  end if
                  fastest = max(fastest, law%intrinsic*k)
               end do
            end associate
         end do
      end associate
   contains
      pure real(wp) function beyond_rounding(a, b)
         real(wp), intent(in) :: a(2), b(2)

         beyond_rounding = norm2(a + b)
         if (beyond_rounding <= ROUNDING*(norm2(a) + norm2(b))) beyond_rounding = 0.0_wp
      end function beyond_rounding
   end function seepage_at_start

   !> A motion with omega it changes by the share omega k rho_w/(n eta_w), and of what the loads move no more than the
   !> share bends/omega goes with omega: together bends k rho_w/(n eta_w), whatever omega. In unsaturated soil, and
   !> where the water is not stiff enough, it would make waves grow: it stays off, and the frequency of the loads is
   !> held against the limit of the u-p form itself.
   subroutine judge_seepage(model, facts, effect)
      type(model_t), intent(in) :: model
      type(facts_t), intent(in) :: facts
      type(effect_t), intent(inout) :: effect
      real(wp) :: limit, n
      logical :: stable
      integer :: i

      if (.not. model%domain%with_w .or. .not. any(model%stages%kind == DYNAMIC)) then
         effect%why = 'no stage has both accelerations and pore water'
         effect%threshold = UNKNOWN
         if (effect%by_hand) effect%on = model%domain%seepage_inertia
         return
      end if
      limit = huge(1.0_wp)
      stable = .not. model%domain%with_c
      associate (m => model%domain)
         do i = 1, size(m%regions)
            n = m%regions(i)%void_ratio/(1 + m%regions(i)%void_ratio)
            limit = min(limit, n*m%fluids%eta_w/(m%permeabilities(m%regions(i)%permeability)%intrinsic &
                                                 *max(m%fluids%rho_w, ROUNDING)))
            stable = stable .and. m%fluids%k_w/n*((1 - n)*(m%regions(i)%rho_s - m%fluids%rho_w)) > &
                     m%fluids%rho_w*facts%m_max
         end do
         effect%threshold = merge(facts%tolerance, 1.0_wp, stable)*limit
         if (stable) then
            call judge(effect, maxval(facts%bends, mask=model%stages%kind == DYNAMIC), &
                       'bends of the loads; u-p is doubtful above '//short(limit), m%seepage_inertia)
            effect%scale = minval(facts%slow, mask=model%stages%kind == DYNAMIC)
         else
            call judge(effect, maxval(facts%omega, mask=model%stages%kind == DYNAMIC), &
                       'frequency of the loads; u-p is doubtful above its threshold', m%seepage_inertia)
            effect%scale = 0.0_wp
            effect%why = trim(effect%why)//'; unstable here'
            effect%on = effect%on .and. effect%by_hand
         end if
      end associate
      effect%monitored = .not. effect%on
   end subroutine judge_seepage

   !> Unknowns of a field, and entries of the matrix in their rows and columns.
   pure subroutine cost_of(body, field, effect)
      type(linearised_body_t), intent(in) :: body
      integer, intent(in) :: field
      type(effect_t), intent(inout) :: effect
      integer :: i

      effect%unknowns = count(body%dofs%field == field)
      do i = 1, body%dofs%n
         associate (columns => body%pattern%col(body%pattern%row(i):body%pattern%row(i + 1) - 1))
            effect%entries = effect%entries + merge(size(columns), count(body%dofs%field(columns) == field), &
                                                    body%dofs%field(i) == field)
         end associate
      end do
   end subroutine cost_of

   !> Takes the boundary conditions of dropped fields out of the scene; a field with inflow is never dropped. Without
   !> pore water there is nothing to consolidate.
   subroutine keep_fields(water, suction, model)
      logical, intent(in) :: water, suction
      type(model_t), intent(inout) :: model

      model%domain%with_w = water
      model%domain%with_c = suction
      model%fixes = pack(model%fixes, &
         model%fixes%field <= DISPLACEMENTS .or. (model%fixes%field == AT_P_W .and. water) .or. suction)
      if (.not. water) then
         where (model%stages%derived .and. model%stages%kind == QUASI_STATIC) model%stages%kind = STATIC
      end if
   end subroutine keep_fields
end module effect_decisions
