!> Derivative of one rate with respect to everything it depends on: state, memory, strain rate and suction rate.
!> The consistent tangent carries it through the substeps; nothing is evaluated twice and nothing is perturbed;
!> docs/theory/integration.md section 5.3.
module mud_sensitivity
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_bonding, only: bonding_t, bonding, bonding_curvature, UNBONDED
   use mud_critical_state, only: critical_void_ratio, lode_factor, lode_slope
   use mud_elastic, only: swelling_slope
   use mud_hardening, only: SMALLEST_VOID_TERM
   use mud_rates, only: rate_t
   use mud_tangent, only: gradients, inverse_of
   use mud_tensor, only: IDENTITY, ddot, trace, deviator, norm, square
   implicit none (type, external)
   private
   public :: change_t, linearised_t, linearise, change_of_rate

   !> A direction in which the arguments of a rate change.
   type :: change_t
      real(wp) :: sigma(6), z(6), r_in(6)   !< [kPa, -, -]
      real(wp) :: e, p_c                    !< [-, kPa]
      real(wp) :: d_strain(6), d_pc         !< of the strain rate that loads and the suction rate [-, kPa]
      real(wp) :: d_aside(6)                !< of the strain rate beside it that is elastic (nucleus) [-]
   end type change_t

   !> What all directions share.
   type :: linearised_t
      logical :: held_p                     !< p' is at its lower bound: it does not follow the stress.
      real(wp) :: e, p_c, d_v, d_pc, d_e(6), d_aside(6)
      logical :: beside                     !< There is an elastic strain rate beside (nucleus).
      type(bonding_t) :: bond
      real(wp) :: curvature(3)              !< of f [1/kPa2, 1/kPa, -]
      real(wp) :: e_c, kappa, r_norm
      real(wp) :: e_c_slope                 !< -d ln e_c/dp' [1/kPa]
      real(wp) :: k_slope, g_slope, b_slope !< d ln K/de, d ln G/de, d ln b_0/de [-]
      real(wp) :: per_p, per_f, per_b_0, per_gamma, per_y   !< Reciprocals of p', f, b_0, gamma, y.
      real(wp) :: r_cube_slope(6)           !< d tr(r^3/|r|^3)/dr
      real(wp) :: lode_r, lode_slope_r      !< Lode factor in the direction of r and its slope
      real(wp), dimension(6) :: h_n, d_n, beta_n, gamma_n
      real(wp) :: inverse(3, 3)
   end type linearised_t
contains
   !> Prepares the derivative of a rate w that was evaluated at (sigma, e, p_c) for (d_strain, d_pc), with an elastic
   !> strain rate d_aside beside it.
   pure subroutine linearise(par, bonded, w, sigma, e, p_c, d_strain, d_pc, lin, d_aside)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: sigma(6), e, p_c, d_strain(6), d_pc
      type(linearised_t), intent(inout) :: lin
      real(wp), intent(in), optional :: d_aside(6)
      real(wp) :: m(3, 3), r2(6), cube

      lin%held_p = trace(sigma) < 3.0_wp*par%p_min
      lin%e = e
      lin%p_c = p_c
      lin%d_v = trace(d_strain)
      lin%d_pc = d_pc
      lin%d_e = deviator(d_strain)
      lin%beside = present(d_aside)
      if (present(d_aside)) lin%d_aside = d_aside
      lin%bond = UNBONDED
      lin%curvature = 0.0_wp
      if (bonded) then
         lin%bond = bonding(par, p_c, e)
         lin%curvature = bonding_curvature(par, p_c, e)
      end if
      lin%e_c = e - w%psi
      lin%e_c_slope = par%lambda/(w%p + par%alpha_csl)
      lin%k_slope = 1.0_wp/(1.0_wp + e) - 1.0_wp/e
      lin%g_slope = -1.0_wp/(1.0_wp + e)
      ! At e = 2.97 the shear modulus and its slope are zero.
      if (abs(2.97_wp - e) > epsilon(e)) lin%g_slope = lin%g_slope - 2.0_wp/(2.97_wp - e)
      lin%b_slope = 0.0_wp
      if (1.0_wp - par%c_h*e > SMALLEST_VOID_TERM) lin%b_slope = -par%c_h/(1.0_wp - par%c_h*e)
      lin%per_p = 1.0_wp/w%p
      lin%per_f = 1.0_wp/lin%bond%f
      lin%per_b_0 = 1.0_wp/w%b_0
      if (w%iso_active) then
         lin%kappa = swelling_slope(w%k, e, w%p)
         lin%r_norm = norm(w%r)
         lin%r_cube_slope = 0.0_wp
         lin%lode_r = 1.0_wp
         lin%lode_slope_r = 0.0_wp
         if (lin%r_norm > 0.0_wp) then
            r2 = square(w%r)
            cube = ddot(r2, w%r)/lin%r_norm**3
            lin%lode_r = lode_factor(par, cube)
            lin%lode_slope_r = lode_slope(par, lin%lode_r)
            lin%r_cube_slope = 3.0_wp*(r2/lin%r_norm**3 - (cube/lin%r_norm**2)*w%r)
         end if
      end if
      if (.not. w%loading) return
      call gradients(par, w, lin%h_n, lin%d_n, lin%beta_n, lin%gamma_n)
      m(1, :) = [ddot(w%t, w%n), -1.0_wp, w%r_n]
      m(2, :) = [ddot(lin%gamma_n, w%t), -w%gamma, ddot(lin%gamma_n, w%r)]
      m(3, :) = [ddot(lin%beta_n, w%t), 0.0_wp, ddot(lin%beta_n, w%r) - w%gamma]
      lin%inverse = inverse_of(m)
      lin%per_gamma = 1.0_wp/w%gamma
      lin%per_y = 1.0_wp/w%y
   end subroutine linearise

   !> Change of the rates of stress, fabric and plastic shear, and of the loading direction.
   pure subroutine change_of_rate(par, w, lin, change, d_sigma, d_z, d_eps_q, dn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(change_t), intent(in) :: change
      real(wp), intent(out) :: d_sigma(6), d_z(6), d_eps_q, dn(6)
      real(wp) :: dp, dr(6), dt(6), dk, dg, df, dpsi, dm_b, dm_d, db_0, dk_e, db, dv, volumetric, dvolumetric
      real(wp) :: dx, drn, dr_b, dd, dh, dstiffness, stiffness, reach, dbeta, dgamma, dy, dl, s(3), a, b
      real(wp) :: d_e(6), share

      ! the point
      dp = merge(0.0_wp, trace(change%sigma)/3.0_wp, lin%held_p)
      share = dp*lin%per_p
      dr = (deviator(change%sigma) - dp*w%r)*lin%per_p
      dk = w%k*(2.0_wp/3.0_wp*share + change%e*lin%k_slope)
      dg = w%g*(0.5_wp*share + change%e*lin%g_slope)
      df = lin%bond%df_de*change%e + lin%bond%df_dpc*change%p_c
      dpsi = change%e - lin%e_c*(df*lin%per_f - dp*lin%e_c_slope)
      dm_b = merge(-par%n_b*w%m_b*dpsi, 0.0_wp, w%psi < 0.0_wp)
      dm_d = par%n_d*w%m_d*dpsi
      db_0 = w%b_0*(lin%b_slope*change%e - 0.5_wp*share)

      ! the isotropic mechanism and the trial stress
      dk_e = dk
      db = 0.0_wp
      if (w%iso_active) call change_of_mechanism(par, w, lin, change, dp, dr, dk, df, dm_b, dk_e, db)
      dv = trace(change%d_strain)
      volumetric = w%k_e*(lin%d_v - w%b_rate)
      dvolumetric = dk_e*(lin%d_v - w%b_rate) + w%k_e*(dv - db)
      d_e = dg*lin%d_e + w%g*deviator(change%d_strain)
      dt = 2.0_wp*d_e - volumetric*dr - dvolumetric*w%r

      if (.not. w%loading) then
         dn = 0.0_wp
         d_z = 0.0_wp
         d_eps_q = 0.0_wp
         d_sigma = 2.0_wp*d_e + dvolumetric*IDENTITY
         if (lin%beside) call add_aside(w, lin, change, dk, dg, d_sigma)
         return
      end if

      ! everything at the present direction
      drn = ddot(dr, w%n)
      dr_b = SQRT_2_3*w%lode*dm_b
      if (w%capped_d) then
         dd = w%d*(dg/w%g - dk_e/w%k_e - drn/w%r_n)
      else
         dd = w%a_d*(SQRT_2_3*w%lode*dm_d - drn)
         ! With A_0 = 0 there is no dilatancy that fabric could change.
         if (par%fabric .and. w%z_n > 0.0_wp .and. w%a_d > 0.0_wp) dd = dd + par%a_0*ddot(change%z, w%n)*w%d/w%a_d
      end if
      stiffness = 2.0_wp*w%g - w%k_e*w%d*w%r_n
      dstiffness = 2.0_wp*dg - dk_e*w%d*w%r_n - w%k_e*(dd*w%r_n + w%d*drn)
      if (w%capped_h) then
         reach = 2.0_wp/3.0_wp*w%p/((1.0_wp - par%cap_h)*stiffness)
         dh = w%h_b*(share - dstiffness/stiffness) + reach*(drn - dr_b)
      else
         dx = merge(0.0_wp, drn - ddot(change%r_in, w%n), w%floored)
         dh = (dx - w%h_b*db_0)*lin%per_b_0
      end if
      dbeta = 2.0_wp/3.0_wp*dp + dh*w%k_e*w%d + w%h_b*(dk_e*w%d + w%k_e*dd)
      dgamma = 2.0_wp/3.0_wp*(dp*SQRT_2_3*w%lode*w%m_b + w%p*dr_b) + 2.0_wp*(dg*w%h_b + w%g*dh)

      ! the direction turns: gamma dn = y dt + beta dr + t dy - n dgamma + r dbeta
      dt = w%y*dt + w%beta*dr
      s = [-ddot(w%n, dt), -ddot(lin%gamma_n, dt) - w%gamma*dgamma, -ddot(lin%beta_n, dt) - w%gamma*dbeta]
      dy = lin%inverse(1, 1)*s(1) + lin%inverse(1, 2)*s(2) + lin%inverse(1, 3)*s(3)
      a = lin%inverse(2, 1)*s(1) + lin%inverse(2, 2)*s(2) + lin%inverse(2, 3)*s(3)
      b = lin%inverse(3, 1)*s(1) + lin%inverse(3, 2)*s(2) + lin%inverse(3, 3)*s(3)
      dn = (dt + dy*w%t - a*w%n + b*w%r)*lin%per_gamma
      dh = dh + ddot(lin%h_n, dn)
      dd = dd + ddot(lin%d_n, dn)
      dl = (dh - w%l*dy)*lin%per_y

      d_sigma = 2.0_wp*(d_e - (dg*w%l + w%g*dl)*w%n - (w%g*w%l)*dn) &
                + (dvolumetric - dk_e*w%l*w%d - w%k_e*(dl*w%d + w%l*dd))*IDENTITY
      if (lin%beside) call add_aside(w, lin, change, dk, dg, d_sigma)
      d_eps_q = SQRT_2_3*dl
      d_z = 0.0_wp
      if (par%fabric .and. w%d < 0.0_wp) then
         d_z = par%c_z*((dl*w%d + w%l*dd)*(par%z_max*w%n + w%z) + w%l*w%d*(par%z_max*dn + change%z))
      end if
   end subroutine change_of_rate

   !> Adds the change of what the elastic strain beside gives.
   pure subroutine add_aside(w, lin, change, dk, dg, d_sigma)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(change_t), intent(in) :: change
      real(wp), intent(in) :: dk, dg
      real(wp), intent(inout) :: d_sigma(6)

      d_sigma = d_sigma + 2.0_wp*(dg*deviator(lin%d_aside) + w%g*deviator(change%d_aside)) &
                + (dk*trace(lin%d_aside) + w%k*trace(change%d_aside))*IDENTITY
   end subroutine add_aside

   !> Change of K_e and of B while the isotropic mechanism acts.
   pure subroutine change_of_mechanism(par, w, lin, change, dp, dr, dk, df, dm_b, dk_e, db)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(change_t), intent(in) :: change
      real(wp), intent(in) :: dp, dr(6), dk, df, dm_b
      real(wp), intent(out) :: dk_e, db
      real(wp) :: dweight, dr_norm, dapproach, dcrowding, df_f, dc, dshare, da, softening, shared

      ! w = 1 - (|r|/R_b(r))^2
      dr_norm = 0.0_wp
      if (lin%r_norm > 0.0_wp) dr_norm = ddot(w%r, dr)/lin%r_norm
      dweight = 2.0_wp*(1.0_wp - w%iso%weight)*(lin%lode_slope_r/lin%lode_r*ddot(lin%r_cube_slope, dr) + dm_b/w%m_b)
      dweight = dweight - 3.0_wp*lin%r_norm*dr_norm/(lin%lode_r*w%m_b)**2

      dapproach = w%iso%approach*(dp/w%p - (df/lin%bond%f - change%e/lin%e)/par%lambda)
      dcrowding = dapproach*(1.0_wp + 3.0_wp*(lin%r_norm/par%m_c)**2) &
                  + w%iso%approach*6.0_wp*lin%r_norm*dr_norm/par%m_c**2
      df_f = -w%iso%f_slope*dcrowding
      shared = lin%bond%df_de/lin%bond%f
      dc = -change%e*shared*w%iso%f - lin%e*shared*(df_f - w%iso%f*df/lin%bond%f) &
           - lin%e/lin%bond%f*w%iso%f*(lin%curvature(3)*change%e + lin%curvature(2)*change%p_c)
      dshare = w%iso%share*(dweight/w%iso%weight + change%e*(1.0_wp/lin%e - 1.0_wp/(1.0_wp + lin%e)))
      if (.not. w%iso%floored) dshare = dshare - w%iso%share*dc/(1.0_wp + w%iso%c)
      da = dshare/w%iso%share*w%iso%a + w%iso%share*((par%lambda - lin%kappa)*df_f - lin%kappa*dc &
                                                     - lin%kappa*dp/(3.0_wp*w%p)*(w%iso%f + w%iso%c))
      softening = w%k*w%iso%a/w%p
      dk_e = w%k_e*(dk/w%k - (w%k*da/w%p + softening*(dk/w%k - dp/w%p))/(1.0_wp + softening))

      shared = lin%bond%df_dpc/lin%bond%f
      db = -(dshare*w%iso%f*shared + w%iso%share*df_f*shared - w%iso%share*w%iso%f*shared*df/lin%bond%f &
             + w%iso%share*w%iso%f/lin%bond%f*(lin%curvature(2)*change%e + lin%curvature(1)*change%p_c))
      db = db*lin%d_pc + w%iso%b*change%d_pc
   end subroutine change_of_mechanism
end module mud_sensitivity
