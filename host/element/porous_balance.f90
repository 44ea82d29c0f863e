! SPDX-License-Identifier: MIT
!> The physics at one quadrature point: what the balances of momentum, water plus air, and air need, and its exact
!> derivative. Both are arrays over the same twelve places: strain rr, zz, tt, rz | displacement | p_w | p_c |
!> gradient of p_w | gradient of p_c, so that an element adds B^T response and B^T tangent B and knows no soil.
!> Signs: tension positive stress and strain, pressures positive in compression, outflow positive.
!> docs/theory/host.md sections 2 and 3.3.
module porous_balance
   use kinds, only: wp
   use porous_domain, only: domain_t, region_t, COUPLED, UNDRAINED
   use permeability_laws, only: relative_t, relative_permeability
   use retention_curves, only: saturation_t
   use generalised_alpha, only: scheme_t, rate_of
   implicit none (type, external)
   private
   public :: kinematics_t, pore_t, skeleton_t, point_response, solid_response, PLACES, RR, ZZ, TT, RZ, U, PW, PC, &
             GW, GA

   integer, parameter :: PLACES = 12
   ! Places, or places before the first; the strain comes first.
   integer, parameter :: RR = 1, ZZ = 2, TT = 3, RZ = 4
   integer, parameter :: U = 4            !< Displacements are at U + 1, U + 2.
   integer, parameter :: PW = 7, PC = 8   !< Water pressure, suction.
   integer, parameter :: GW = 8, GA = 10  !< Gradients of p_w at GW + 1, GW + 2, of p_c at GA + 1, GA + 2.

   !> Strain, pressures, their gradients and rates at a point, from the nodes.
   type :: kinematics_t
      real(wp) :: strain(4)                     !< Increment of the step.
      real(wp) :: accel(2)                      !< At its level [m/s2].
      real(wp) :: gravity                       !< At the level of values [m/s2].
      real(wp) :: speed(2)                      !< At its level, where it may be damped [m/s].
      real(wp) :: velocity(2)                   !< Before, in dynamic stages [m/s].
      real(wp) :: rate(4)                       !< Rate of strain at the level of velocities [1/s].
      real(wp) :: div_v                         !< Rate of volume at its level [1/s].
      real(wp) :: w0, w1, c0, c1                !< p_w, p_c before and after [kPa].
      real(wp) :: w_dot, c_dot                  !< Rates of the pressures at their level [kPa/s].
      real(wp) :: grad_w(2), grad_c(2)          !< Gradients at the level of values [kPa/m].
      real(wp) :: source(4)
   end type kinematics_t

   !> The pores of a point: void ratio, saturation and its rate.
   type :: pore_t
      real(wp) :: e, s, s_rate
   end type pore_t

   !> Response of the material at the end of the step; slopes where they are asked for.
   type :: skeleton_t
      real(wp) :: stress(4)              !< Effective stress [kPa]
      real(wp) :: e, s                   !< Void ratio, degree of saturation [-]
      real(wp) :: tangent(4, 4)            !< d stress/d strain [kPa]
      real(wp) :: tangent_suction(4)       !< d stress/d suction [-]
      real(wp) :: ds_dev, ds_dpc         !< d S_w/d volume strain [-], d S_w/d suction [1/kPa]
   end type skeleton_t

   !> The mixture of a point at its levels, and the slopes of that.
   type :: mixture_t
      real(wp) :: n, n1              !< Porosity at the level of values and at the end of the step [-]
      real(wp) :: s                  !< Degree of saturation [-]
      real(wp) :: s_ev, s_pc         !< Slopes of s against volume strain [-] and suction [1/kPa]
      real(wp) :: p_w                !< [kPa]
      ! where there is air:
      real(wp) :: p_c                !< [kPa]
      real(wp) :: s_dot              !< Rate of the degree of saturation [1/s]
      real(wp) :: rate_ev, rate_pc   !< Slopes of s_dot, over that of the scheme.
      real(wp) :: k_a, d_k_a         !< Bulk modulus of the air [kPa] and its slope against p_a [-]
      real(wp) :: rho_a, d_rho_a     !< Density of the air [t/m3] and its slope against p_a.
      type(relative_t) :: rel        !< Relative permeabilities, where fluids flow.
   end type mixture_t
contains
   !> Response of a point of a region with water, its tangent where it is asked for, and its pores at the end of the
   !> step. docs/theory/host.md sections 2, 3.3 and 3.4. response: stress [kPa], force per volume [kN/m3], sources of
   !> volume [1/s], fluxes [m/s]. In static steps and in drained regions the places of the fluids are 0; pressures act
   !> in the stress in any case.
   subroutine point_response(domain, region, scheme, k, stress0, skeleton, old, new, with_tangent, response, tangent, &
                             drift)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      real(wp), intent(in) :: stress0(6)     !< Effective stress before the step.
      type(skeleton_t), intent(in) :: skeleton
      type(pore_t), intent(in) :: old
      type(pore_t), intent(out) :: new
      logical, intent(in) :: with_tangent
      real(wp), intent(out) :: response(PLACES), tangent(PLACES, PLACES)   !< The tangent where it is asked for.
      real(wp), intent(out) :: drift(2, 2)   !< Magnitudes of parts of the fluxes: both fluids, water [m/s].
      type(mixture_t) :: mix

      call fill_pores(domain, region, scheme, k, skeleton, old, new, mix)
      if (with_tangent) tangent = 0.0_wp
      drift = 0.0_wp
      call add_momentum(domain, region, scheme, k, stress0, skeleton, mix, with_tangent, response, tangent)
      if (.not. scheme%has_rates) return
      if (region%drainage /= COUPLED .and. region%drainage /= UNDRAINED) return
      if (region%drainage == COUPLED) &
         mix%rel = relative_permeability(domain%permeabilities(region%permeability), mix%s)
      call add_water(domain, region, scheme, k, mix, with_tangent, response, tangent, drift(:, 2))
      drift(:, 1) = drift(:, 2)
      if (region%with_c) call add_air(domain, region, scheme, k, mix, with_tangent, response, tangent, drift(:, 1))
      response(PW) = response(PW) - k%source(3)
   end subroutine point_response

   !> Response of a point of a region without water, where nothing is spent on the places of the fluids.
   !> docs/theory/host.md sections 2 and 3.3.
   pure subroutine solid_response(region, scheme, k, stress0, skeleton, e_old, with_tangent, response, tangent)
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      real(wp), intent(in) :: stress0(6)     !< Effective stress before the step.
      type(skeleton_t), intent(in) :: skeleton
      real(wp), intent(in) :: e_old          !< Void ratio before the step [-].
      logical, intent(in) :: with_tangent
      real(wp), intent(out) :: response(PLACES)              !< Response, as of point_response.
      real(wp), intent(inout) :: tangent(PLACES, PLACES)     !< Written at stress and force, where it is asked for.
      real(wp) :: n, n1, rho, accel(2), l_s
      integer :: i

      n1 = skeleton%e/(1 + skeleton%e)
      n = e_old/(1 + e_old)
      n = n + scheme%l_f*(n1 - n)
      rho = region%rho_s - n*region%rho_s
      l_s = level_of_stress(region, scheme)
      accel = k%accel + region%damping*k%speed
      accel(2) = accel(2) + k%gravity
      response = 0.0_wp
      response(1:4) = stress0(1:4) + l_s*(skeleton%stress - stress0(1:4))
      response(U + 1:U + 2) = rho*accel - k%source(1:2)
      if (resists_rate(region, scheme)) response(1:4) = response(1:4) + matmul(region%against_rate, k%rate)
      if (.not. with_tangent) return
      tangent(:U + 2, :U + 2) = 0.0_wp
      tangent(1:4, 1:4) = l_s*skeleton%tangent
      if (resists_rate(region, scheme)) tangent(1:4, 1:4) = tangent(1:4, 1:4) + scheme%c_v*region%against_rate
      tangent(U + 1, U + 1) = rho*slope_of_inertia(region, scheme)
      tangent(U + 2, U + 2) = tangent(U + 1, U + 1)
      do i = 1, 3
         tangent(U + 1:U + 2, i) = -accel*(region%rho_s*scheme%l_f*(1 - n1))
      end do
   end subroutine solid_response

   !> Share of the effective stress's increment over the step that acts: with the stress of damping, which is in
   !> proportion to its rate.
   pure real(wp) function level_of_stress(region, scheme) result(level)
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme

      level = scheme%l_f
      if (region%stiffness_damping > 0.0_wp .and. scheme%has_inertia .and. scheme%c_v > 0.0_wp) &
         level = level + region%stiffness_damping/scheme%dt
   end function level_of_stress

   !> Whether a stress of the rate of strain acts: static stages have no time.
   pure logical function resists_rate(region, scheme)
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme

      resists_rate = allocated(region%against_rate) .and. scheme%has_rates
   end function resists_rate

   !> Slope of accelerations and damping against the new displacements [1/s2].
   pure real(wp) function slope_of_inertia(region, scheme) result(slope)
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme

      slope = scheme%c_a
      if (scheme%has_inertia) slope = slope + region%damping*scheme%c_v
   end function slope_of_inertia

   !> Void ratio and saturation at the end of the step, and the mixture at its levels: saturated where the scene has no
   !> suction.
   subroutine fill_pores(domain, region, scheme, k, skeleton, old, new, mix)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      type(skeleton_t), intent(in) :: skeleton
      type(pore_t), intent(in) :: old
      type(pore_t), intent(out) :: new
      type(mixture_t), intent(out) :: mix

      new = pore_t(skeleton%e, 1.0_wp, 0.0_wp)
      mix%n1 = new%e/(1 + new%e)
      mix%n = old%e/(1 + old%e)
      mix%n = mix%n + scheme%l_f*(mix%n1 - mix%n)
      mix%p_w = k%w0 + scheme%l_f*(k%w1 - k%w0)
      mix%s = 1.0_wp
      mix%s_ev = 0.0_wp
      mix%s_pc = 0.0_wp
      if (region%with_c) call fill_with_air(domain, region, scheme, k, skeleton, old, new, mix)
   end subroutine fill_pores

   !> Sets the share of the pores that is water, and the air in the rest.
   subroutine fill_with_air(domain, region, scheme, k, skeleton, old, new, mix)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      type(skeleton_t), intent(in) :: skeleton
      type(pore_t), intent(in) :: old
      type(pore_t), intent(inout) :: new
      type(mixture_t), intent(inout) :: mix
      type(saturation_t) :: before, after
      real(wp) :: l

      l = scheme%l_f
      new%s = skeleton%s
      mix%s_ev = l*skeleton%ds_dev
      mix%s_pc = l*skeleton%ds_dpc
      if (domain%full_rate) then
         new%s_rate = rate_of(scheme, old%s, old%s_rate, new%s)
         mix%rate_pc = skeleton%ds_dpc
         mix%rate_ev = skeleton%ds_dev
      else
         before = region%law%retention(k%c0, old%e)
         after = region%law%retention(k%c1, old%e)
         new%s_rate = rate_of(scheme, before%s, old%s_rate, after%s)
         mix%rate_pc = after%ds_dpc
         mix%rate_ev = 0.0_wp
      end if
      mix%s = old%s + l*(new%s - old%s)
      mix%s_dot = old%s_rate + scheme%l_p*(new%s_rate - old%s_rate)
      mix%p_c = k%c0 + l*(k%c1 - k%c0)
      call air(domain, mix%p_w + mix%p_c, mix%k_a, mix%d_k_a, mix%rho_a, mix%d_rho_a)
   end subroutine fill_with_air

   !> Momentum of the mixture: total stress, inertia, weight.
   pure subroutine add_momentum(domain, region, scheme, k, stress0, skeleton, mix, with_tangent, response, tangent)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      real(wp), intent(in) :: stress0(6)
      type(skeleton_t), intent(in) :: skeleton
      type(mixture_t), intent(in) :: mix
      logical, intent(in) :: with_tangent
      real(wp), intent(out) :: response(PLACES)
      real(wp), intent(inout) :: tangent(PLACES, PLACES)
      real(wp) :: pressure, rho, rho_n, rho_s, accel(2), l, l_s
      integer :: i

      l = scheme%l_f
      l_s = level_of_stress(region, scheme)
      associate (n => mix%n, s => mix%s, fluids => domain%fluids)
         pressure = mix%p_w
         rho_n = s*fluids%rho_w - region%rho_s
         rho_s = 0.0_wp
         if (region%with_c) then
            pressure = pressure + (1 - s)*mix%p_c
            rho_n = rho_n + (1 - s)*mix%rho_a
            rho_s = n*(fluids%rho_w - mix%rho_a)
         end if
         rho = region%rho_s + n*rho_n
         accel = k%accel + region%damping*k%speed
         accel(2) = accel(2) + k%gravity
         response = 0.0_wp
         response(1:4) = stress0(1:4) + l_s*(skeleton%stress - stress0(1:4))
         if (resists_rate(region, scheme)) response(1:4) = response(1:4) + matmul(region%against_rate, k%rate)
         response(1:3) = response(1:3) - pressure
         response(U + 1:U + 2) = rho*accel - k%source(1:2)
         if (.not. with_tangent) return
         tangent(1:4, 1:4) = l_s*skeleton%tangent
         if (resists_rate(region, scheme)) tangent(1:4, 1:4) = tangent(1:4, 1:4) + scheme%c_v*region%against_rate
         tangent(1:3, PW) = -l
         tangent(U + 1, U + 1) = rho*slope_of_inertia(region, scheme)
         tangent(U + 2, U + 2) = tangent(U + 1, U + 1)
         do i = 1, 3
            tangent(U + 1:U + 2, i) = accel*(rho_n*l*(1 - mix%n1) + rho_s*mix%s_ev)
         end do
         if (.not. region%with_c) return
         tangent(1:3, 1:3) = tangent(1:3, 1:3) + mix%p_c*mix%s_ev
         tangent(1:4, PC) = l_s*skeleton%tangent_suction
         tangent(1:3, PC) = tangent(1:3, PC) - (1 - s)*l + mix%p_c*mix%s_pc
         tangent(U + 1:U + 2, PC) = accel*(rho_s*mix%s_pc + n*(1 - s)*mix%d_rho_a*l)
         tangent(U + 1:U + 2, PW) = accel*n*(1 - s)*mix%d_rho_a*l
      end associate
   end subroutine add_momentum

   !> Water, in the sum of the balances.
   subroutine add_water(domain, region, scheme, k, mix, with_tangent, response, tangent, drift)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      type(mixture_t), intent(in) :: mix
      logical, intent(in) :: with_tangent
      real(wp), intent(inout) :: response(PLACES), tangent(PLACES, PLACES)
      real(wp), intent(out) :: drift(2)
      real(wp) :: drive(2), body(2), kappa, d_kappa, inverse, l

      l = scheme%l_f
      inverse = 1/domain%fluids%k_w
      response(PW) = mix%n*mix%s*inverse*k%w_dot + k%div_v
      if (with_tangent) then
         tangent(PW, 1:3) = mix%s*inverse*k%w_dot*l*(1 - mix%n1) + mix%n*inverse*k%w_dot*mix%s_ev + scheme%c_v
         tangent(PW, PW) = mix%n*mix%s*inverse*scheme%c_p
         tangent(PW, PC) = mix%n*inverse*k%w_dot*mix%s_pc
      end if
      drift = 0.0_wp
      if (region%drainage /= COUPLED) return
      body = body_force(domain, k)
      kappa = domain%permeabilities(region%permeability)%intrinsic/domain%fluids%eta_w
      d_kappa = kappa*mix%rel%dw
      kappa = kappa*mix%rel%w
      drive = k%grad_w + domain%fluids%rho_w*body
      response(GW + 1:GW + 2) = kappa*drive
      drift = kappa*(abs(k%grad_w) + domain%fluids%rho_w*abs(body))
      if (.not. with_tangent) return
      call add_flux_slopes(domain, scheme, mix, GW, kappa, d_kappa, domain%fluids%rho_w, drive, tangent)
      tangent(GW + 1, GW + 1) = kappa*l
      tangent(GW + 2, GW + 2) = kappa*l
   end subroutine add_water

   !> Air, in both sums: free, and dissolved in the water, with which it flows.
   subroutine add_air(domain, region, scheme, k, mix, with_tangent, response, tangent, drift)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      type(mixture_t), intent(in) :: mix
      logical, intent(in) :: with_tangent
      real(wp), intent(inout) :: response(PLACES), tangent(PLACES, PLACES), drift(2)
      real(wp) :: drive(2), body(2), dissolved(2), kappa, d_kappa, a_dot, room, stored, d_stored, filling(4), l
      integer :: i

      l = scheme%l_f
      a_dot = k%w_dot + k%c_dot
      body = body_force(domain, k)
      associate (n => mix%n, s => mix%s, k_a => mix%k_a, h => domain%fluids%henry)
         room = 1 - (1 - h)*s
         stored = n*room/k_a*a_dot
         response(PW) = response(PW) + stored + h*(n*mix%s_dot + s*k%div_v)
         response(PC) = stored - (1 - h)*n*mix%s_dot + room*k%div_v - k%source(4)
         dissolved = h*response(GW + 1:GW + 2)
         drift = (1 + h)*drift
         kappa = 0.0_wp
         d_kappa = 0.0_wp
         if (region%drainage == COUPLED) then
            kappa = domain%permeabilities(region%permeability)%intrinsic/domain%fluids%eta_a
            d_kappa = kappa*mix%rel%da
            kappa = kappa*mix%rel%a
         end if
         drive = k%grad_w + k%grad_c + mix%rho_a*body
         response(GA + 1:GA + 2) = kappa*drive + dissolved
         drift = drift + kappa*(abs(k%grad_w + k%grad_c) + mix%rho_a*abs(body))
         response(GW + 1:GW + 2) = response(GW + 1:GW + 2) + response(GA + 1:GA + 2)
         if (.not. with_tangent) return
         d_stored = n*room/k_a*(scheme%c_p - a_dot*mix%d_k_a*l/k_a)
         tangent(PC, 1:3) = room/k_a*a_dot*l*(1 - mix%n1) - (1 - h)*n/k_a*a_dot*mix%s_ev
         tangent(PC, PW) = d_stored
         tangent(PC, PC) = d_stored - (1 - h)*n/k_a*a_dot*mix%s_pc
         tangent(PW, 1:8) = tangent(PW, 1:8) + tangent(PC, 1:8)
         ! Of the rate of what the water fills: it takes this room from the free air, and dissolves its share h.
         filling(1:3) = mix%s_dot*l*(1 - mix%n1) + n*scheme%c_p*mix%rate_ev + k%div_v*mix%s_ev + s*scheme%c_v
         filling(4) = n*scheme%c_p*mix%rate_pc + k%div_v*mix%s_pc
         tangent(PW, [1, 2, 3, PC]) = tangent(PW, [1, 2, 3, PC]) + h*filling
         tangent(PC, [1, 2, 3, PC]) = tangent(PC, [1, 2, 3, PC]) - (1 - h)*filling
         tangent(PC, 1:3) = tangent(PC, 1:3) + scheme%c_v
         call add_flux_slopes(domain, scheme, mix, GA, kappa, d_kappa, mix%rho_a, drive, tangent)
         do i = 1, 2
            tangent(GA + i, [GW + i, GA + i]) = kappa*l
         end do
         tangent(GA + 1:GA + 2, PW) = tangent(GA + 1:GA + 2, PW) + kappa*mix%d_rho_a*l*body
         tangent(GA + 1:GA + 2, PC) = tangent(GA + 1:GA + 2, PC) + kappa*mix%d_rho_a*l*body
         tangent(GA + 1:GA + 2, :) = tangent(GA + 1:GA + 2, :) + h*tangent(GW + 1:GW + 2, :)
         tangent(GW + 1:GW + 2, :) = tangent(GW + 1:GW + 2, :) + tangent(GA + 1:GA + 2, :)
      end associate
   end subroutine add_air

   !> Acceleration that drives seepage beside the gradient: weight, and inertia if the scene wants it [m/s2].
   pure function body_force(domain, k) result(b)
      type(domain_t), intent(in) :: domain
      type(kinematics_t), intent(in) :: k
      real(wp) :: b(2)

      b = 0.0_wp
      if (domain%seepage_inertia) b = k%accel
      b(2) = b(2) + k%gravity
   end function body_force

   !> Slopes of a flux against saturation and displacement.
   pure subroutine add_flux_slopes(domain, scheme, mix, place, kappa, d_kappa, density, drive, tangent)
      type(domain_t), intent(in) :: domain
      type(scheme_t), intent(in) :: scheme
      type(mixture_t), intent(in) :: mix
      integer, intent(in) :: place
      real(wp), intent(in) :: kappa, d_kappa, density, drive(2)
      real(wp), intent(inout) :: tangent(PLACES, PLACES)
      integer :: i

      do i = 1, 2
         tangent(place + i, 1:3) = d_kappa*drive(i)*mix%s_ev
         tangent(place + i, PC) = d_kappa*drive(i)*mix%s_pc
         if (domain%seepage_inertia) tangent(place + i, U + i) = kappa*density*scheme%c_a
      end do
   end subroutine add_flux_slopes

   !> Bulk modulus and density of the air and their slopes against p_a.
   pure subroutine air(domain, p_a, k_a, d_k_a, rho_a, d_rho_a)
      type(domain_t), intent(in) :: domain
      real(wp), intent(in) :: p_a
      real(wp), intent(out) :: k_a, d_k_a, rho_a, d_rho_a

      k_a = domain%fluids%k_a
      rho_a = domain%fluids%rho_a
      d_k_a = 0.0_wp
      d_rho_a = 0.0_wp
      if (.not. domain%fluids%ideal_gas) return
      k_a = domain%fluids%p_ref + p_a
      d_k_a = 1.0_wp
      d_rho_a = domain%fluids%rho_a/domain%fluids%p_ref
      rho_a = d_rho_a*k_a
   end subroutine air
end module porous_balance
