! SPDX-License-Identifier: MIT
!> What the decisions about the effects of a scene share: stiffness, extent, weight, what acts, and how fast.
module effect_facts
   use kinds, only: wp
   use load_histories, only: load_history_t, load_histories_of, FORCE, MOTION
   use linearised_body, only: linearised_body_t
   use effect_types, only: effect_t, UNBOUNDED
   use model_types, only: model_t
   use unknown_fields, only: AT_P_C
   use material_point, only: response_t, report_t
   implicit none (type, external)
   private
   public :: facts_t, gather, judge, PLASTIC, ROUNDING

   real(wp), parameter :: EARTH = 9.81_wp       !< [m/s2] For the weight where gravity is off.
   real(wp), parameter :: PLASTIC = 100.0_wp    !< A plastic material may become so many times softer.
   real(wp), parameter :: ROUNDING = 1.0e-9_wp  !< Relative.

   !> What the decisions share.
   type :: facts_t
      type(load_history_t), allocatable :: histories(:)
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
   !> Stiffness, extent, weight, stresses.
   subroutine gather(model, body, facts)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      type(facts_t), intent(inout) :: facts
      type(response_t) :: response
      type(report_t) :: report
      real(wp) :: n, p_c, slope(3), no_strain(6, 1), new(model%domain%n_state, 1)
      integer :: e, g, i, p

      facts%tolerance = model%effect_options%tolerance
      facts%m_min = huge(1.0_wp)
      facts%p_min = huge(1.0_wp)
      no_strain = 0.0_wp
      associate (m => model%domain, s => body%state)
         facts%low = [(minval(m%mesh%x(i, reshape(m%mesh%t6, [size(m%mesh%t6)]))), i=1, 2)]
         facts%high = [(maxval(m%mesh%x(i, reshape(m%mesh%t6, [size(m%mesh%t6)]))), i=1, 2)]
         do e = 1, size(m%mesh%t6, 2)
            associate (region => m%regions(m%region_of(e)), law => m%regions(m%region_of(e))%law)
               do g = 1, m%rule
                  p = (e - 1)*m%rule + g
                  n = s%e(p)/(1 + s%e(p))
                  facts%rho = max(facts%rho, (1 - n)*region%rho_s + merge(n*m%fluids%rho_w, 0.0_wp, m%with_w))
                  p_c = dot_product(m%gauss(g, e)%m(:m%n_p), s%x(AT_P_C, m%mesh%t6(:m%n_p, e)))
                  call law%update(1, s%stress(:, p:p), s%state(:, p:p), no_strain, [p_c], [0.0_wp], .true., &
                                  response, new, report)
                  slope = [(response%dsig_deps(i, i, 1), i=1, 3)]
                  if (report%code /= 0) slope = 0.0_wp
                  facts%m_min = min(facts%m_min, minval(slope))
                  facts%m_max = max(facts%m_max, maxval(slope))
                  if (law%has_energy) cycle
                  facts%plastic = .true.
                  facts%p_min = min(facts%p_min, max(0.0_wp, -sum(s%stress(1:3, p))/3))
               end do
            end associate
         end do
         facts%m_min = max(facts%m_min, 0.0_wp)
         if (facts%plastic) facts%m_min = facts%m_min/PLASTIC
         facts%weight = facts%rho*merge(m%gravity, EARTH, m%gravity > 0.0_wp)*(facts%high(2) - facts%low(2))
      end associate
      facts%histories = load_histories_of(model, body%state)
      do i = 1, size(facts%histories)
         associate (a => facts%histories(i))
            ! A motion strains the body by no less on the average.
            if (a%kind == MOTION) a%stress = facts%m_min/maxval(facts%high - facts%low)
            facts%acting = max(facts%acting, a%stress*a%change)
         end associate
      end do
      if (.not. facts%acting > 0.0_wp) &
         facts%acting = maxval([0.0_wp, facts%histories%stress*abs(facts%histories%start)], &
                                                             mask=[.true., facts%histories%kind == FORCE])
      i = size(model%stages)
      allocate (facts%jump(i), facts%pace(i), facts%bends(i), facts%omega(i), facts%slow(i), source=0.0_wp)
   end subroutine gather

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
end module effect_facts
