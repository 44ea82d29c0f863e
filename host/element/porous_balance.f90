! SPDX-License-Identifier: MIT
!> The physics at one quadrature point: what the balances of momentum, water plus air, and air need, and its exact
!> derivative. Both are arrays over the same twelve places: strain rr, zz, tt, rz | displacement | p_w | p_c |
!> gradient of p_w | gradient of p_c, so that an element adds B^T response and B^T tangent B and knows no soil.
!> Signs: tension positive stress and strain, pressures positive in compression, outflow positive.
!> docs/theory/host.md sections 2 and 3.3.
module porous_balance
   use kinds, only: wp
   use material_point, only: response_t
   use porous_domain, only: domain_t, region_t, COUPLED, UNDRAINED
   use permeability_laws, only: relative_t, relative_permeability
   use retention_curves, only: saturation_t
   use generalised_alpha, only: scheme_t, rate_of
   implicit none (type, external)
   private
   public :: kinematics_t, point_state_t, point_response, PLACES, RR, ZZ, TT, RZ, U, PW, PC, GW, GA

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

   !> A point carries this from step to step, and the state variables of its law.
   type :: point_state_t
      real(wp) :: stress(6)      !< Effective [kPa].
      real(wp) :: e, s, s_rate   !< Void ratio, degree of saturation and its rate [1/s].
   end type point_state_t
contains
   !> Finds the response of a point of a region, its tangent where it is asked for, and its state at the end of the
   !> step. docs/theory/host.md sections 2, 3.3 and 3.4. response: stress [kPa], force per volume [kN/m3], sources of
   !> volume [1/s], fluxes [m/s]. In static steps, in drained and in dry regions the places of the fluids are 0;
   !> pressures act in the stress in any case.
   subroutine point_response(domain, region, scheme, k, material, point, old, new, with_tangent, response, tangent, &
                             drift)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      type(kinematics_t), intent(in) :: k
      type(response_t), intent(in) :: material   !< Answer for a batch of points; with slopes for a tangent.
      integer, intent(in) :: point           !< Place of the point in it.
      type(point_state_t), intent(in) :: old
      type(point_state_t), intent(out) :: new
      logical, intent(in) :: with_tangent
      real(wp), intent(out) :: response(PLACES), tangent(PLACES, PLACES)   !< The tangent where it is asked for.
      real(wp), intent(out) :: drift(2, 2)   !< Magnitudes of parts of the fluxes: both fluids, water [m/s].
      real(wp) :: l                          !< Level of values.
      real(wp) :: n, n1                      !< Porosity at the level of values and at the end of the step [-].
      real(wp) :: s, s_ev, s_pc              !< Degree of saturation, slopes against volume strain and suction [1/kPa].
      real(wp) :: p_w, p_c                   !< At the level of values [kPa].
      real(wp) :: s_dot, rate_ev, rate_pc    !< Rate of s [1/s], its slopes over that of the scheme.
      real(wp) :: k_a, d_k_a                 !< Bulk modulus of the air [kPa] and its slope against p_a [-].
      real(wp) :: rho_a, d_rho_a             !< Density of the air [t/m3] and its slope against p_a.
      type(relative_t) :: rel                !< Relative permeabilities, where fluids flow.

      l = scheme%l_f
      call fill_pores()
      response = 0.0_wp
      if (with_tangent) tangent = 0.0_wp
      drift = 0.0_wp
      call add_momentum()
      if (.not. region%with_w .or. .not. scheme%has_rates) return
      if (region%drainage /= COUPLED .and. region%drainage /= UNDRAINED) return
      if (region%drainage == COUPLED) rel = relative_permeability(domain%permeabilities(region%permeability), s)
      call add_water()
      if (region%with_c) call add_air()
      response(PW) = response(PW) - k%source(3)
   contains
      !> Sets void ratio and saturation at the end of the step, and the mixture at its levels: saturated where the scene
      !> has no suction.
      subroutine fill_pores()
         new = point_state_t(material%stress(:, point), material%void_ratio(point), 1.0_wp, 0.0_wp)
         n1 = new%e/(1 + new%e)
         n = old%e/(1 + old%e)
         n = n + l*(n1 - n)
         p_w = k%w0 + l*(k%w1 - k%w0)
         s = 1.0_wp
         s_ev = 0.0_wp
         s_pc = 0.0_wp
         if (region%with_c) call fill_with_air()
      end subroutine fill_pores

      !> Sets the share of the pores that is water, and the air in the rest.
      subroutine fill_with_air()
         type(saturation_t) :: before, after

         new%s = material%s_w(point)
         if (with_tangent) then
            s_ev = l*material%dsw_dev(point)
            s_pc = l*material%dsw_dpc(point)
            rate_ev = material%dsw_dev(point)
            rate_pc = material%dsw_dpc(point)
         end if
         if (domain%full_rate) then
            new%s_rate = rate_of(scheme, old%s, old%s_rate, new%s)
         else
            before = region%law%retention(k%c0, old%e)
            after = region%law%retention(k%c1, old%e)
            new%s_rate = rate_of(scheme, before%s, old%s_rate, after%s)
            rate_pc = after%ds_dpc
            rate_ev = 0.0_wp
         end if
         s = old%s + l*(new%s - old%s)
         s_dot = old%s_rate + scheme%l_p*(new%s_rate - old%s_rate)
         p_c = k%c0 + l*(k%c1 - k%c0)
         k_a = domain%fluids%k_a
         rho_a = domain%fluids%rho_a
         d_k_a = 0.0_wp
         d_rho_a = 0.0_wp
         if (.not. domain%fluids%ideal_gas) return
         k_a = domain%fluids%p_ref + (p_w + p_c)
         d_k_a = 1.0_wp
         d_rho_a = domain%fluids%rho_a/domain%fluids%p_ref
         rho_a = d_rho_a*k_a
      end subroutine fill_with_air

      !> Adds what is in the momentum of the mixture: total stress, inertia, weight.
      subroutine add_momentum()
         real(wp) :: rho, rho_n, rho_s, accel(2), l_s, inertia
         logical :: resists_rate
         integer :: i

         ! The stress of damping in proportion to the stiffness is a share of the increment; static stages have no time.
         l_s = l
         if (region%stiffness_damping > 0.0_wp .and. scheme%has_inertia .and. scheme%c_v > 0.0_wp) &
            l_s = l_s + region%stiffness_damping/scheme%dt
         resists_rate = allocated(region%against_rate) .and. scheme%has_rates
         rho_n = -region%rho_s
         rho_s = 0.0_wp
         response(1:4) = old%stress(1:4) + l_s*(new%stress(1:4) - old%stress(1:4))
         if (resists_rate) response(1:4) = response(1:4) + matmul(region%against_rate, k%rate)
         if (region%with_c) then
            response(1:3) = response(1:3) - (p_w + (1 - s)*p_c)
            rho_n = s*domain%fluids%rho_w - region%rho_s + (1 - s)*rho_a
            rho_s = n*(domain%fluids%rho_w - rho_a)
         else if (region%with_w) then
            response(1:3) = response(1:3) - p_w
            rho_n = s*domain%fluids%rho_w - region%rho_s
         end if
         rho = region%rho_s + n*rho_n
         accel = k%accel + region%damping*k%speed
         accel(2) = accel(2) + k%gravity
         response(U + 1:U + 2) = rho*accel - k%source(1:2)
         if (.not. with_tangent) return
         tangent(1:4, 1:4) = l_s*material%dsig_deps(1:4, 1:4, point)
         if (resists_rate) tangent(1:4, 1:4) = tangent(1:4, 1:4) + scheme%c_v*region%against_rate
         inertia = scheme%c_a
         if (scheme%has_inertia) inertia = inertia + region%damping*scheme%c_v
         tangent(U + 1, U + 1) = rho*inertia
         tangent(U + 2, U + 2) = tangent(U + 1, U + 1)
         do i = 1, 3
            tangent(U + 1:U + 2, i) = accel*(rho_n*l*(1 - n1) + rho_s*s_ev)
         end do
         if (region%with_w) tangent(1:3, PW) = -l
         if (.not. region%with_c) return
         tangent(1:3, 1:3) = tangent(1:3, 1:3) + p_c*s_ev
         tangent(1:4, PC) = l_s*material%dsig_dpc(1:4, point)
         tangent(1:3, PC) = tangent(1:3, PC) - (1 - s)*l + p_c*s_pc
         tangent(U + 1:U + 2, PC) = accel*(rho_s*s_pc + n*(1 - s)*d_rho_a*l)
         tangent(U + 1:U + 2, PW) = accel*n*(1 - s)*d_rho_a*l
      end subroutine add_momentum

      !> Adds the water, in the sum of the balances.
      subroutine add_water()
         real(wp) :: drive(2), body(2), kappa, d_kappa, inverse

         inverse = 1/domain%fluids%k_w
         response(PW) = n*s*inverse*k%w_dot + k%div_v
         if (with_tangent) then
            tangent(PW, 1:3) = s*inverse*k%w_dot*l*(1 - n1) + n*inverse*k%w_dot*s_ev + scheme%c_v
            tangent(PW, PW) = n*s*inverse*scheme%c_p
            tangent(PW, PC) = n*inverse*k%w_dot*s_pc
         end if
         if (region%drainage /= COUPLED) return
         body = body_force(domain, k)
         kappa = domain%permeabilities(region%permeability)%intrinsic/domain%fluids%eta_w
         d_kappa = kappa*rel%dw
         kappa = kappa*rel%w
         drive = k%grad_w + domain%fluids%rho_w*body
         response(GW + 1:GW + 2) = kappa*drive
         drift(:, 2) = kappa*(abs(k%grad_w) + domain%fluids%rho_w*abs(body))
         drift(:, 1) = drift(:, 2)
         if (.not. with_tangent) return
         call add_flux_slopes(GW, kappa, d_kappa, domain%fluids%rho_w, drive)
         tangent(GW + 1, GW + 1) = kappa*l
         tangent(GW + 2, GW + 2) = kappa*l
      end subroutine add_water

      !> Adds the air, in both sums: free, and dissolved in the water, with which it flows.
      subroutine add_air()
         real(wp) :: drive(2), body(2), dissolved(2), kappa, d_kappa, a_dot, room, stored, d_stored, filling
         integer :: i

         a_dot = k%w_dot + k%c_dot
         body = body_force(domain, k)
         associate (h => domain%fluids%henry)
            room = 1 - (1 - h)*s
            stored = n*room/k_a*a_dot
            response(PW) = response(PW) + stored + h*(n*s_dot + s*k%div_v)
            response(PC) = stored - (1 - h)*n*s_dot + room*k%div_v - k%source(4)
            dissolved = h*response(GW + 1:GW + 2)
            drift(:, 1) = (1 + h)*drift(:, 1)
            kappa = 0.0_wp
            d_kappa = 0.0_wp
            if (region%drainage == COUPLED) then
               kappa = domain%permeabilities(region%permeability)%intrinsic/domain%fluids%eta_a
               d_kappa = kappa*rel%da
               kappa = kappa*rel%a
            end if
            drive = k%grad_w + k%grad_c + rho_a*body
            response(GA + 1:GA + 2) = kappa*drive + dissolved
            drift(:, 1) = drift(:, 1) + kappa*(abs(k%grad_w + k%grad_c) + rho_a*abs(body))
            response(GW + 1:GW + 2) = response(GW + 1:GW + 2) + response(GA + 1:GA + 2)
            if (.not. with_tangent) return
            d_stored = n*room/k_a*(scheme%c_p - a_dot*d_k_a*l/k_a)
            tangent(PC, 1:3) = room/k_a*a_dot*l*(1 - n1) - (1 - h)*n/k_a*a_dot*s_ev
            tangent(PC, PW) = d_stored
            tangent(PC, PC) = d_stored - (1 - h)*n/k_a*a_dot*s_pc
            tangent(PW, 1:8) = tangent(PW, 1:8) + tangent(PC, 1:8)
            ! Of the rate of what the water fills: it takes this room from the free air, and dissolves its share h.
            filling = s_dot*l*(1 - n1) + n*scheme%c_p*rate_ev + k%div_v*s_ev + s*scheme%c_v
            tangent(PW, 1:3) = tangent(PW, 1:3) + h*filling
            tangent(PC, 1:3) = tangent(PC, 1:3) - (1 - h)*filling + scheme%c_v
            filling = n*scheme%c_p*rate_pc + k%div_v*s_pc
            tangent(PW, PC) = tangent(PW, PC) + h*filling
            tangent(PC, PC) = tangent(PC, PC) - (1 - h)*filling
            call add_flux_slopes(GA, kappa, d_kappa, rho_a, drive)
            do i = 1, 2
               tangent(GA + i, [GW + i, GA + i]) = kappa*l
            end do
            tangent(GA + 1:GA + 2, PW) = tangent(GA + 1:GA + 2, PW) + kappa*d_rho_a*l*body
            tangent(GA + 1:GA + 2, PC) = tangent(GA + 1:GA + 2, PC) + kappa*d_rho_a*l*body
            tangent(GA + 1:GA + 2, :) = tangent(GA + 1:GA + 2, :) + h*tangent(GW + 1:GW + 2, :)
            tangent(GW + 1:GW + 2, :) = tangent(GW + 1:GW + 2, :) + tangent(GA + 1:GA + 2, :)
         end associate
      end subroutine add_air

      !> Adds the slopes of a flux by saturation and displacement.
      subroutine add_flux_slopes(place, kappa, d_kappa, density, drive)
         integer, intent(in) :: place
         real(wp), intent(in) :: kappa, d_kappa, density, drive(2)
         integer :: i

         do i = 1, 2
            tangent(place + i, 1:3) = d_kappa*drive(i)*s_ev
            tangent(place + i, PC) = d_kappa*drive(i)*s_pc
            if (domain%seepage_inertia) tangent(place + i, U + i) = kappa*density*scheme%c_a
         end do
      end subroutine add_flux_slopes
   end subroutine point_response

   !> Finds the acceleration that drives seepage beside the gradient: weight, and inertia if the scene wants it [m/s2].
   pure function body_force(domain, k) result(b)
      type(domain_t), intent(in) :: domain
      type(kinematics_t), intent(in) :: k
      real(wp) :: b(2)

      b = 0.0_wp
      if (domain%seepage_inertia) b = k%accel
      b(2) = b(2) + k%gravity
   end function body_force
end module porous_balance
