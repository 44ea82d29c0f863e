!> Which effects a scene calls for: fields, inertia, relative acceleration, gravity. What the keys leave out is
!> derived: an effect is off only where a bound of what it does is below the scene's tolerance. Bounds use the stiffness
!> at the start; of a plastic material they keep a reserve (PLASTIC).
module host_effects
   use host_kinds, only: wp, PI
   use host_actions, only: action_t, pace_t, actions_of, pace_of, FORCE, MOTION, PRESSURE, FLOW
   use host_modes, only: trial_t, prepare_trial, support, response_of, imbalance_of, mass_of_nodes, end_trial
   use host_scene, only: scene_t, effect_t, acts_in, P_A, OF_P_W, OF_P_C, OF_INERTIA, OF_SEEPAGE, OF_GRAVITY, &
                         UNBOUNDED, UNKNOWN, NEVER
   use fe_material, only: answer_t
   use fe_permeability, only: relative_permeability, relative_t
   use fe_retention, only: saturated_t, saturation_t
   use time_galpha, only: STATIC, QUASI_STATIC, DYNAMIC
   use triax_fault, only: fault_t, raise, EXIT_OUTPUT
   use triax_text, only: short, whole
   implicit none (type, external)
   private
   public :: derive_effects, print_effects, write_effects

   real(wp), parameter :: EARTH = 9.81_wp       !< [m/s2] For the weight where gravity is off.
   real(wp), parameter :: PLASTIC = 100.0_wp    !< A plastic material may become so many times softer.
   real(wp), parameter :: OVERSHOOT = 2.0_wp    !< A pore pressure may fall by so many times the loads' changes.
   real(wp), parameter :: ROUNDING = 1.0e-9_wp  !< Relative.

   !> What the decisions share.
   type :: facts_t
      type(action_t), allocatable :: actions(:)
      real(wp) :: tolerance = 0.01_wp
      logical :: plastic = .false.
      real(wp) :: m_min = 0.0_wp, m_max = 0.0_wp   !< Constrained modulus at the start [kPa]
      real(wp) :: p_min = 0.0_wp                   !< Least mean effective stress of plastic materials [kPa]
      real(wp) :: low(2) = 0.0_wp, high(2) = 0.0_wp   !< Extent of the body [m]
      real(wp) :: weight = 0.0_wp                  !< Of a column of its height [kPa]
      real(wp) :: rho = 0.0_wp                     !< Largest density [Mg/m3]
      real(wp) :: acting = 0.0_wp                  !< Largest stress that acts [kPa]
      real(wp) :: loose = 0.0_wp                   !< Share of the first stage's response to forces without balance.
      logical :: held = .true.                     !< By its supports, in every stage.
      ! Of every stage: largest jump [-], fastest load [1/s], most bends of one [rad/s], its frequency if it were part
      ! of a wave [rad/s], and how long a quarter of the slowest vibration would last per speed [kJ**(1/2) s].
      real(wp), allocatable :: jump(:), pace(:), bends(:), omega(:), slow(:)
   end type facts_t
contains
   !> Decides, and makes the scene what was decided.
   subroutine derive_effects(scene, table, fault)
      type(scene_t), intent(inout) :: scene
      type(effect_t), allocatable, intent(out) :: table(:)
      type(fault_t), intent(inout) :: fault
      type(trial_t) :: trial
      type(facts_t) :: facts
      type(effect_t) :: p_w, p_c, seepage, gravity
      type(effect_t), allocatable :: inertia(:)
      integer :: i

      allocate (inertia(size(scene%stages)))
      call prepare_trial(scene, trial, fault)
      if (fault%code == 0) then
         call gather(scene, trial, facts)
         gravity = effect_t(OF_GRAVITY, name='gravity', by_hand=scene%effects%gravity_by_hand, unit='kPa')
         call judge_gravity(scene, trial, facts, gravity)
         if (.not. gravity%on .and. scene%model%gravity > 0.0_wp) then
            scene%model%gravity = 0.0_wp
            call end_trial(scene, trial)
            call prepare_trial(scene, trial, fault)
         end if
      end if
      if (fault%code /= 0) then
         call end_trial(scene, trial)
         return
      end if
      do i = 1, size(scene%stages)
         inertia(i) = effect_t(OF_INERTIA, i, 'inertia in '//scene%stages(i)%name, &
                               by_hand=.not. scene%stages(i)%derived, threshold=facts%tolerance)
         call judge_inertia(scene, i, trial, facts, inertia(i))
         if (scene%stages(i)%derived) scene%stages(i)%kind = merge(DYNAMIC, QUASI_STATIC, inertia(i)%on)
      end do
      p_c = effect_t(OF_P_C, name='field p_c', by_hand=scene%effects%fields_by_hand, unit='kPa')
      call cost_of(trial, 4, p_c)
      call judge_suction(scene, trial, facts, p_c)
      p_w = effect_t(OF_P_W, name='field p_w', by_hand=scene%effects%fields_by_hand, threshold=facts%tolerance)
      call cost_of(trial, 3, p_w)
      call judge_water(scene, trial, facts, p_c%on, p_w)
      call end_trial(scene, trial)
      call keep_fields(p_w%on, p_c%on, scene)
      seepage = effect_t(OF_SEEPAGE, name='relative acceleration', by_hand=scene%effects%seepage_by_hand, unit='rad/s')
      call judge_seepage(scene, facts, seepage)
      scene%model%seepage_inertia = seepage%on
      table = [p_w, p_c, inertia, seepage, gravity]
   end subroutine derive_effects

   !> On where it is not below its threshold, unless it is set by hand.
   pure subroutine judge(effect, estimate, why, hand)
      type(effect_t), intent(inout) :: effect
      real(wp), intent(in) :: estimate
      character(*), intent(in) :: why
      logical, intent(in) :: hand   !< What the hand says.

      effect%estimate = min(estimate, UNBOUNDED)
      effect%why = why
      effect%on = estimate > effect%threshold
      if (effect%by_hand) effect%on = hand
   end subroutine judge

   !> Stiffness, extent, weight, stresses.
   subroutine gather(scene, trial, facts)
      type(scene_t), intent(in) :: scene
      type(trial_t), intent(in) :: trial
      type(facts_t), intent(inout) :: facts
      type(answer_t) :: answer
      real(wp) :: n, still(6), new(scene%model%n_state)
      integer :: e, g, i, p

      facts%tolerance = scene%effects%tolerance
      facts%m_min = huge(1.0_wp)
      facts%p_min = huge(1.0_wp)
      still = 0.0_wp
      associate (m => scene%model, s => trial%state)
         facts%low = [(minval(m%mesh%x(i, reshape(m%mesh%t6, [size(m%mesh%t6)]))), i=1, 2)]
         facts%high = [(maxval(m%mesh%x(i, reshape(m%mesh%t6, [size(m%mesh%t6)]))), i=1, 2)]
         do e = 1, size(m%mesh%t6, 2)
            associate (region => m%regions(m%region_of(e)), law => m%materials(m%regions(m%region_of(e))%material)%law)
               do g = 1, m%rule
                  p = (e - 1)*m%rule + g
                  n = s%e(p)/(1 + s%e(p))
                  facts%rho = max(facts%rho, (1 - n)*region%rho_s + merge(n*m%fluids%rho_w, 0.0_wp, m%with_w))
                  call law%update(s%stress(:, p), s%state(:law%n_state, p), still, &
                                  dot_product(m%gauss(g, e)%m(:m%n_p), s%x(4, m%mesh%t6(:m%n_p, e))), 0.0_wp, .true., &
                                  answer, new(:law%n_state))
                  if (answer%code /= 0) answer%slope = 0.0_wp
                  facts%m_min = min(facts%m_min, minval([(answer%slope(i, i), i=1, 3)]))
                  facts%m_max = max(facts%m_max, maxval([(answer%slope(i, i), i=1, 3)]))
                  if (law%stored) cycle
                  facts%plastic = .true.
                  facts%p_min = min(facts%p_min, max(0.0_wp, -sum(s%stress(1:3, p))/3))
               end do
            end associate
         end do
         facts%m_min = max(facts%m_min, 0.0_wp)
         if (facts%plastic) facts%m_min = facts%m_min/PLASTIC
         facts%weight = facts%rho*merge(m%gravity, EARTH, m%gravity > 0.0_wp)*(facts%high(2) - facts%low(2))
      end associate
      facts%actions = actions_of(scene, trial%state)
      do i = 1, size(facts%actions)
         associate (a => facts%actions(i))
            ! A motion strains the body by no less on the average.
            if (a%kind == MOTION) a%stress = facts%m_min/maxval(facts%high - facts%low)
            facts%acting = max(facts%acting, a%stress*a%change)
         end associate
      end do
      if (.not. facts%acting > 0.0_wp) facts%acting = maxval([0.0_wp, facts%actions%stress*abs(facts%actions%start)], &
                                                             mask=[.true., facts%actions%kind == FORCE])
      i = size(scene%stages)
      allocate (facts%jump(i), facts%pace(i), facts%bends(i), facts%omega(i), facts%slow(i), source=0.0_wp)
   end subroutine gather

   !> Weight against the smallest stress that matters: that of the loads, the mean stress a plastic material begins
   !> with, the suction.
   subroutine judge_gravity(scene, trial, facts, effect)
      type(scene_t), intent(in) :: scene
      type(trial_t), intent(in) :: trial
      type(facts_t), intent(in) :: facts
      type(effect_t), intent(inout) :: effect
      real(wp) :: least

      least = facts%acting
      if (facts%plastic) least = merge(min(least, facts%p_min), facts%p_min, least > 0.0_wp)
      if (scene%model%with_c) least = min(least, minval(abs(trial%state%x(4, :)), mask=trial%dofs%of(4, :) > 0))
      effect%threshold = facts%tolerance*least
      effect%scale = facts%weight
      call judge(effect, facts%weight, 'height rho g against '//short(least)//' kPa that act', &
                 scene%model%gravity > 0.0_wp)
      if (any(scene%plates%heavy) .or. any(scene%initials%geostatic)) then
         if (.not. effect%by_hand) effect%on = .true.
         effect%why = 'the scene asks for weight: geostatic stress or a heavy plate'
      else if (effect%on .and. .not. effect%by_hand) then
         effect%why = trim(effect%why)//'; acts from the start'
      end if
      ! The weight is certain: above the threshold there is nothing left to see.
      effect%watched = .not. effect%on .and. facts%weight <= effect%threshold
   end subroutine judge_gravity

   !> The vibration that quasi-static steps leave out, as a share of the response: a jump leaves all of it, a bend of a
   !> load by ds leaves ds/omega of it, whatever comes after; omega is the slowest free vibration.
   subroutine judge_inertia(scene, stage, trial, facts, effect)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: stage
      type(trial_t), intent(inout) :: trial
      type(facts_t), intent(inout) :: facts
      type(effect_t), intent(inout) :: effect
      type(pace_t) :: pace
      real(wp) :: energy, carried, share, squares, omega, loose, seepage, bend
      character(:), allocatable :: why
      integer :: i

      seepage = 0.0_wp
      if (all(scene%stages(:stage - 1)%kind == STATIC)) seepage = seepage_at_start(scene, trial)
      associate (now => scene%stages(stage))
         if (.not. now%derived .and. now%kind == STATIC) then
            effect%why = 'static: a way to equilibrium, given by hand'
            return
         end if
         call support(scene, stage, trial)
         facts%held = facts%held .and. trial%omega > 0.0_wp
         omega = trial%omega/merge(sqrt(PLASTIC), 1.0_wp, facts%plastic)
         why = 'free vibrations from '//short(trial%omega)//' rad/s'
         if (facts%plastic) why = why//', bound with '//short(omega)
         squares = 0.0_wp
         share = 0.0_wp
         do i = 1, size(facts%actions)
            associate (a => facts%actions(i))
               pace = pace_of(scene, a, stage)
               call response_of(scene, a, trial, energy, carried)
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
            loose = imbalance_of(scene, stage, trial)
            squares = squares + loose**2
            if (loose > 0.0_wp) facts%loose = loose/sqrt(squares)
            if (facts%loose > facts%tolerance) why = why//'; forces without balance'
            share = min(UNBOUNDED, share + facts%loose)
         end if
         if (facts%jump(stage) > facts%tolerance .and. facts%jump(stage) < UNBOUNDED) why = why//'; a jump'
         share = max(share, facts%jump(stage))
         effect%scale = sqrt(squares)
         if (seepage > 0.0_wp) then
            bend = 2*seepage*sqrt(sum(mass_of_nodes(scene, trial%state)))
            if (bend > facts%tolerance*effect%scale) why = why//'; fluids begin to flow'
            share = min(UNBOUNDED, share + min(UNBOUNDED, bend/max(effect%scale, bend/UNBOUNDED)))
         end if
         ! What has no bound.
         if (any([(acts_in(scene%contacts(i)%stages, now%name), i=1, size(scene%contacts))])) then
            why = 'not bounded: contact'
            share = UNBOUNDED
         else if (.not. omega > 0.0_wp) then
            why = 'not bounded: nothing holds the body, or it has no stiffness'
            share = UNBOUNDED
         else if (stage == 1 .and. any(abs(trial%state%v(1:2, :)) > 0.0_wp)) then
            why = 'not bounded: it moves at the start'
            share = UNBOUNDED
         else if (stage > 1) then
            if (scene%stages(stage - 1)%kind == DYNAMIC) then
               why = 'not bounded: the stage before is dynamic'
               share = UNBOUNDED
            end if
         end if
         call judge(effect, share, why, now%kind == DYNAMIC)
         effect%watched = .not. effect%on
         ! The fastest that the loads bring; a jump brings all that the steps can carry.
         facts%omega(stage) = 0.5_wp*PI*facts%pace(stage)
         if (facts%jump(stage) > facts%tolerance .or. (stage == 1 .and. facts%loose > facts%tolerance) &
             .or. share >= UNBOUNDED) facts%omega(stage) = PI/now%dt
         facts%bends(stage) = max(facts%bends(stage), facts%omega(stage))
         if (omega > 0.0_wp) facts%slow(stage) = effect%scale/trial%omega
      end associate
   end subroutine judge_inertia

   !> How fast the pore fluids begin to flow by themselves [m/s]. The skeleton follows them no faster.
   real(wp) function seepage_at_start(scene, trial) result(fastest)
      type(scene_t), intent(in) :: scene
      type(trial_t), intent(in) :: trial
      type(relative_t) :: rel
      real(wp) :: drive(2), weight(2), k
      integer :: e, g

      fastest = 0.0_wp
      if (.not. scene%model%with_w .or. scene%subtract_flow) return
      associate (m => scene%model, x => trial%state%x)
         do e = 1, size(m%mesh%t6, 2)
            associate (law => m%permeabilities(m%regions(m%region_of(e))%permeability), node => m%mesh%t6(:m%n_p, e))
               do g = 1, m%rule
                  rel = relative_permeability(law, trial%state%s((e - 1)*m%rule + g))
                  drive = matmul(m%gauss(g, e)%dm(:, :m%n_p), x(3, node))
                  weight = [0.0_wp, m%fluids%rho_w*m%gravity]
                  k = beyond_rounding(drive, weight)*rel%w/m%fluids%eta_w
                  if (m%with_c) then
                     drive = drive + matmul(m%gauss(g, e)%dm(:, :m%n_p), x(4, node))
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

   !> The largest suction that may arise against that at which the air in the pores begins to count: where it adds
   !> a share `tolerance` to the compressibility of soil and water.
   subroutine judge_suction(scene, trial, facts, effect)
      type(scene_t), intent(in) :: scene
      type(trial_t), intent(in) :: trial
      type(facts_t), intent(in) :: facts
      type(effect_t), intent(inout) :: effect
      character(64) :: why
      real(wp) :: suction
      logical :: full
      integer :: i

      if (.not. scene%model%with_c) then
         effect%threshold = facts%tolerance*facts%acting
         effect%why = 'no region has a retention law'
         if (effect%by_hand) effect%why = 'no such field'
         effect%watched = scene%model%with_w
         return
      end if
      effect%threshold = harmless_suction(scene, facts)
      full = .not. facts%plastic
      do i = 1, size(scene%model%regions)
         select type (law => scene%model%retentions(scene%model%regions(i)%retention)%law)
         type is (saturated_t)
         class default
            full = .false.
         end select
      end do
      if (full) then
         call judge(effect, 0.0_wp, 'saturated by its law, and no stiffness depends on suction', .true.)
         return
      end if
      call look_for_bound()
      if (why /= '') then
         call judge(effect, UNBOUNDED, 'not bounded: '//why, .true.)
      else
         suction = largest_suction(scene, trial, facts)
         call judge(effect, max(suction, 0.0_wp), 'largest suction from pressures, weight and loads', .true.)
      end if
      effect%watched = .not. effect%on
   contains
      !> Why nothing says how far the water pressure may fall; empty if something does.
      subroutine look_for_bound()
         integer :: k

         why = ''
         associate (a => facts%actions)
            if (any(a%kind == FORCE .and. a%change > 0.0_wp .and. .not. a%stress > 0.0_wp)) why = 'forces on nodes'
            if (any(a%kind == MOTION .and. (a%change > 0.0_wp .or. .not. a%lasting))) why = 'boundaries that move'
            if (any(abs(trial%state%v(1:2, :)) > 0.0_wp)) why = 'it moves at the start'
            if (any(a%kind == PRESSURE .and. a%field == 4) .and. any(a%field == P_A)) why = 'p_c and p_a prescribe p_w'
            do k = 1, size(scene%loads)
               if (scene%loads(k)%kind == 5) why = 'inflow of air'
               if (scene%loads(k)%kind == 4 .and. scene%loads(k)%value < 0.0_wp) why = 'outflow of water'
               if (scene%loads(k)%kind /= 4 .or. scene%loads(k)%history == 0) cycle
               if (any(scene%histories(scene%loads(k)%history)%values < 0.0_wp)) why = 'outflow of water'
            end do
            if (facts%loose > facts%tolerance) why = 'forces without balance'
            if (.not. facts%held) why = 'nothing holds the body, or it has no stiffness'
            if (size(scene%contacts) > 0) why = 'contact'
            if (facts%plastic) why = 'dilatancy of a plastic material'
         end associate
      end subroutine look_for_bound
   end subroutine judge_suction

   !> p_a at its highest less p_w at its lowest. Flow alone leaves the potential of the water within its initial and
   !> prescribed values; loads may lower p_w by OVERSHOOT times their changes.
   real(wp) function largest_suction(scene, trial, facts) result(suction)
      type(scene_t), intent(in) :: scene
      type(trial_t), intent(in) :: trial
      type(facts_t), intent(in) :: facts
      real(wp) :: lowest, air, fall, unit_weight
      integer :: i
      logical :: told

      associate (m => scene%model, x => trial%state%x, has => trial%dofs%of(3, :) > 0)
         unit_weight = m%fluids%rho_w*m%gravity
         lowest = minval(x(3, :) + unit_weight*m%mesh%x(2, :), mask=has)
         suction = maxval(x(4, :), mask=has)
         ! A scene that says nothing of suction has its air at the atmosphere.
         told = any(abs(scene%initials%p_c) > 0.0_wp .or. abs(scene%initials%p_c_slope) > 0.0_wp) .or. &
                any(facts%actions%kind == PRESSURE .and. facts%actions%field >= 4)
         air = 0.0_wp
         if (told) air = maxval(x(3, :) + x(4, :), mask=has)
         fall = 0.0_wp
         do i = 1, size(facts%actions)
            associate (a => facts%actions(i))
               if (a%kind == FORCE) then
                  fall = fall + a%stress*a%change
               else if (a%kind == PRESSURE .and. .not. a%held) then
                  if (a%field == 3) lowest = min(lowest, a%start - a%change + unit_weight* &
                                                 minval(m%mesh%x(2, m%mesh%groups(a%group)%nodes)))
                  if (a%field == 4) suction = max(suction, a%start + a%change)
                  if (a%field == P_A) air = max(air, a%start + a%change)
               end if
            end associate
         end do
         suction = max(suction, air - (lowest - unit_weight*facts%high(2) - OVERSHOOT*fall))
      end associate
   end function largest_suction

   !> Up to it n |dS/dp_c| + n (1 - S)/K_a stays below tolerance (1/M + n/K_w) in every region.
   real(wp) function harmless_suction(scene, facts) result(suction)
      type(scene_t), intent(in) :: scene
      type(facts_t), intent(in) :: facts
      real(wp), parameter :: FINEST = 1.0e-6_wp, RATIO = 1.1_wp
      integer, parameter :: STEPS = 200
      type(saturation_t) :: sat
      real(wp) :: p_c, n, k_a
      integer :: i, k

      suction = huge(1.0_wp)
      associate (m => scene%model)
         k_a = merge(m%fluids%p_ref, m%fluids%k_a, m%fluids%ideal_gas)
         do i = 1, size(m%regions)
            n = m%regions(i)%void_ratio/(1 + m%regions(i)%void_ratio)
            do k = 0, STEPS
               p_c = FINEST*RATIO**k
               sat = m%retentions(m%regions(i)%retention)%law%at(p_c, m%regions(i)%void_ratio)
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
   subroutine judge_water(scene, trial, facts, suction, effect)
      type(scene_t), intent(in) :: scene
      type(trial_t), intent(in) :: trial
      type(facts_t), intent(in) :: facts
      logical, intent(in) :: suction   !< p_c is on.
      type(effect_t), intent(inout) :: effect
      real(wp) :: path, time, share, conductivity

      if (.not. scene%model%with_w) then
         effect%why = 'no region has a permeability'
         effect%threshold = UNKNOWN
         if (effect%by_hand) effect%why = 'no such field'
         return
      end if
      path = drainage_path(scene, trial, facts)
      conductivity = least_conductivity(scene)
      share = UNBOUNDED
      if (suction .and. .not. effect%by_hand) then
         effect%why = 'p_c needs it'
      else if (scene%model%gravity > 0.0_wp .or. any(scene%stages%kind == DYNAMIC)) then
         effect%why = 'not bounded: weight or inertia of the water'
      else if (any(abs(trial%state%x(3, :)) > 0.0_wp) .or. &
               any(facts%actions%kind == PRESSURE .and. facts%actions%field == 3 .and. &
                   (facts%actions%change > 0.0_wp .or. abs(facts%actions%start) > 0.0_wp)) .or. &
               any(facts%actions%kind == FLOW)) then
         effect%why = 'pore pressures or flows are given'
      else if (path >= UNBOUNDED) then
         effect%why = 'not bounded: no rectangle with a whole side at p_w = 0'
      else if (.not. (facts%m_min > 0.0_wp .and. facts%held)) then
         effect%why = 'not bounded: nothing holds the body, or it has no stiffness'
      else
         time = path**2/conductivity*(1/facts%m_min + 1/scene%model%fluids%k_w)
         share = max(maxval(facts%jump), facts%loose) + maxval(facts%pace)*time
         effect%why = 'undrained share; consolidation takes '//short(time)//' s'
         effect%scale = path**2/(2*conductivity)/max(facts%acting, ROUNDING)
      end if
      call judge(effect, share, trim(effect%why), .true.)
      effect%watched = .not. effect%on
   end subroutine judge_water

   !> Distance from a wholly drained side to the opposite one.
   real(wp) function drainage_path(scene, trial, facts) result(path)
      type(scene_t), intent(in) :: scene
      type(trial_t), intent(in) :: trial
      type(facts_t), intent(in) :: facts
      logical :: open(size(scene%model%mesh%x, 2))
      real(wp) :: area, wide(2)
      integer :: i, k, e, g

      path = UNBOUNDED
      wide = facts%high - facts%low
      associate (m => scene%model)
         area = 0.0_wp
         do e = 1, size(m%mesh%t6, 2)
            do g = 1, m%rule
               area = area + m%gauss(g, e)%weight/merge(2*PI*m%gauss(g, e)%x(1), 1.0_wp, m%axisymmetric)
            end do
         end do
         if (abs(area - product(wide)) > ROUNDING*area) return
         open = .false.
         do i = 1, size(facts%actions)
            associate (a => facts%actions(i))
               if (a%kind /= PRESSURE .or. .not. a%lasting .or. a%held) cycle
               if (a%field == 3 .and. all([(acts_in(a%stages, scene%stages(k)%name), k=1, size(scene%stages))])) &
                  open(m%mesh%groups(a%group)%nodes) = .true.
            end associate
         end do
         do i = 1, 2
            if (all(open .or. trial%dofs%of(3, :) == 0 .or. m%mesh%x(i, :) < facts%high(i) - ROUNDING*wide(i))) &
               path = min(path, wide(i))
            ! Towards a hole on the axis the flow converges.
            if (i == 1 .and. m%axisymmetric) cycle
            if (all(open .or. trial%dofs%of(3, :) == 0 .or. m%mesh%x(i, :) > facts%low(i) + ROUNDING*wide(i))) &
               path = min(path, wide(i))
         end do
      end associate
   end function drainage_path

   !> Permeability over viscosity of the tightest region, saturated [m2/(kPa s)].
   real(wp) function least_conductivity(scene) result(least)
      type(scene_t), intent(in) :: scene
      type(relative_t) :: rel
      integer :: i

      least = huge(1.0_wp)
      do i = 1, size(scene%model%regions)
         associate (law => scene%model%permeabilities(scene%model%regions(i)%permeability))
            rel = relative_permeability(law, 1.0_wp)
            least = min(least, law%intrinsic*rel%w/scene%model%fluids%eta_w)
         end associate
      end do
   end function least_conductivity

   !> What moves with omega it changes by the share omega k rho_w/(n eta_w), and of what the loads move at omega there
   !> is no more than the share bends/omega: together bends k rho_w/(n eta_w), whatever omega. In unsaturated soil, and
   !> where the water is not stiff enough, it would make waves grow: it stays off, and the frequency of the loads is
   !> held against the limit of the u-p form itself.
   subroutine judge_seepage(scene, facts, effect)
      type(scene_t), intent(in) :: scene
      type(facts_t), intent(in) :: facts
      type(effect_t), intent(inout) :: effect
      real(wp) :: limit, n
      logical :: stable
      integer :: i

      if (.not. scene%model%with_w .or. .not. any(scene%stages%kind == DYNAMIC)) then
         effect%why = 'no stage has both accelerations and pore water'
         effect%threshold = UNKNOWN
         if (effect%by_hand) effect%on = scene%model%seepage_inertia
         return
      end if
      limit = huge(1.0_wp)
      stable = .not. scene%model%with_c
      associate (m => scene%model)
         do i = 1, size(m%regions)
            n = m%regions(i)%void_ratio/(1 + m%regions(i)%void_ratio)
            limit = min(limit, n*m%fluids%eta_w/(m%permeabilities(m%regions(i)%permeability)%intrinsic &
                                                 *max(m%fluids%rho_w, ROUNDING)))
            stable = stable .and. m%fluids%k_w/n*((1 - n)*(m%regions(i)%rho_s - m%fluids%rho_w)) > &
                     m%fluids%rho_w*facts%m_max
         end do
         effect%threshold = merge(facts%tolerance, 1.0_wp, stable)*limit
         if (stable) then
            call judge(effect, maxval(facts%bends, mask=scene%stages%kind == DYNAMIC), &
                       'bends of the loads; u-p is doubtful above '//short(limit), m%seepage_inertia)
            effect%scale = minval(facts%slow, mask=scene%stages%kind == DYNAMIC)
         else
            call judge(effect, maxval(facts%omega, mask=scene%stages%kind == DYNAMIC), &
                       'frequency of the loads; u-p is doubtful above its threshold', m%seepage_inertia)
            effect%scale = 0.0_wp
            effect%why = trim(effect%why)//'; unstable here'
            effect%on = effect%on .and. effect%by_hand
         end if
      end associate
      effect%watched = .not. effect%on
   end subroutine judge_seepage

   !> Unknowns of a field, and entries of the matrix in their rows and columns.
   pure subroutine cost_of(trial, field, effect)
      type(trial_t), intent(in) :: trial
      integer, intent(in) :: field
      type(effect_t), intent(inout) :: effect
      integer :: i

      effect%unknowns = count(trial%dofs%field == field)
      do i = 1, trial%dofs%n
         associate (columns => trial%pattern%col(trial%pattern%row(i):trial%pattern%row(i + 1) - 1))
            effect%entries = effect%entries + merge(size(columns), count(trial%dofs%field(columns) == field), &
                                                    trial%dofs%field(i) == field)
         end associate
      end do
   end subroutine cost_of

   !> Takes what belongs to a dropped field out of the scene. Without pore water there is nothing to consolidate.
   subroutine keep_fields(water, suction, scene)
      logical, intent(in) :: water, suction
      type(scene_t), intent(inout) :: scene

      scene%model%with_w = water
      scene%model%with_c = suction
      scene%fixes = pack(scene%fixes, scene%fixes%field <= 2 .or. (scene%fixes%field == 3 .and. water) .or. suction)
      scene%loads = pack(scene%loads, (scene%loads%kind /= 4 .or. water) .and. (scene%loads%kind /= 5 .or. suction))
      if (.not. water) then
         where (scene%stages%derived .and. scene%stages%kind == QUASI_STATIC) scene%stages%kind = STATIC
      end if
   end subroutine keep_fields

   !> The table for people.
   subroutine print_effects(unit, table)
      integer, intent(in) :: unit
      type(effect_t), intent(in) :: table(:)
      character(8) :: cells(2)
      logical :: doubtful
      integer :: i

      doubtful = .false.
      write (unit, '(2a)') 'effect                       is   by    estimate         threshold        ', &
         'unknowns entries because'
      do i = 1, size(table)
         associate (t => table(i))
            doubtful = doubtful .or. exceeds(t)
            cells = [character(8) :: whole(t%unknowns), whole(t%entries)]
            write (unit, '(a28,1x,a4,1x,a5,1x,2a17,2(a8,1x),a)') t%name, state_of(t), by(t), &
               with_unit(t%estimate, t%unit), with_unit(t%threshold, t%unit), cells, trim(t%why)
         end associate
      end do
      if (doubtful) write (unit, '(a)') 'off!: off although its estimate is above the threshold.'
   contains
      pure function with_unit(value, name) result(text)
         real(wp), intent(in) :: value
         character(*), intent(in) :: name
         character(17) :: text

         text = number(value)
         if (text /= '-' .and. value < UNBOUNDED .and. name /= '-') text = trim(text)//' '//name
      end function with_unit
   end subroutine print_effects

   pure logical function exceeds(effect)
      type(effect_t), intent(in) :: effect

      exceeds = .not. effect%on .and. effect%estimate > effect%threshold
   end function exceeds

   pure function state_of(effect) result(text)
      type(effect_t), intent(in) :: effect
      character(4) :: text

      text = merge('off!', merge('on  ', 'off ', effect%on), exceeds(effect))
   end function state_of

   pure function by(effect) result(text)
      type(effect_t), intent(in) :: effect
      character(5) :: text

      text = merge('hand ', 'scene', effect%by_hand)
   end function by

   pure function number(value) result(text)
      real(wp), intent(in) :: value
      character(17) :: text

      if (value >= UNBOUNDED) then
         text = 'not bounded'
      else if (value <= UNKNOWN) then
         text = '-'
      else
         text = short(value)
      end if
   end function number

   !> effects.csv: the table, and what the run has shown of the effects that are off.
   subroutine write_effects(folder, table, fault)
      character(*), intent(in) :: folder
      type(effect_t), intent(in) :: table(:)
      type(fault_t), intent(inout) :: fault
      character(32) :: seen
      integer :: unit, i, status

      open (newunit=unit, file=folder//'/effects.csv', status='replace', action='write', recl=100000, iostat=status)
      if (status == 0) write (unit, '(a)', iostat=status) &
         'effect,on,by,estimate,unit,threshold,unknowns,entries,largest_seen,crossed_at,because'
      do i = 1, size(table)
         associate (t => table(i))
            seen = ','
            if (t%watched) seen = short(t%largest)//','
            if (t%crossed > NEVER) seen = trim(seen)//short(t%crossed)
            if (status == 0) write (unit, '(a)', iostat=status) trim(t%name)//','//trim(state_of(t))//','// &
               trim(by(t))//','//trim(number(t%estimate))//','//trim(t%unit)//','//trim(number(t%threshold))//','// &
               whole(t%unknowns)//','//whole(t%entries)//','//trim(seen)//',"'//trim(t%why)//'"'
         end associate
      end do
      if (status == 0) close (unit, iostat=status)
      if (status /= 0) call raise(fault, EXIT_OUTPUT, folder//'/effects.csv cannot be written; does the folder '// &
                                  'exist, is there space?')
   end subroutine write_effects
end module host_effects
