! SPDX-License-Identifier: MIT
!> Derivative of one rate with respect to everything it depends on: state, memory, strain rate and suction rate.
!> The consistent tangent carries it through the substeps; nothing is evaluated twice and nothing is perturbed;
!> docs/theory/integration.md section 5.3.
!>
!> Directions stand side by side, in the first index of every array. What a rate depends on enters through a few
!> contractions; its change is then, component by component, a sum of the changes of strain rate and stress and of
!> a few fixed tensors, whatever lies in between. Loops over components stand inside those over directions: of those the
!> compiler then takes two at once.
module mud_sensitivity
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_linearise, only: linearised_t, linearise
   use mud_rates, only: rate_t
   use mud_tensor, only: IDENTITY, LANES, ddot, trace, deviator, contractions
   implicit none (type, external)
   private
   public :: changes_t, linearised_t, linearise, changes_of_rate, changes_of_drive, NRATES

   integer, parameter :: NRATES = 13   !< sigma'(6), z(6), plastic shear.

   !> How the arguments of a rate change beside stress, fabric and memory.
   type :: changes_t
      real(wp), dimension(LANES) :: e, p_c            !< [-, kPa]
      real(wp) :: d_strain(LANES, 6), d_pc(LANES)     !< of the strain rate that loads and the suction rate [-, kPa]
      real(wp) :: d_aside(LANES, 6)                   !< of the strain rate beside it that is elastic [-]
   end type changes_t

   !> What lies between the changes of a rate's arguments and those of its results.
   type :: lanes_t
      real(wp), dimension(LANES) :: mean, v          !< a third of the trace of stress; trace of the strain rate
      real(wp), dimension(LANES) :: p, share         !< of p', and over p'
      real(wp), dimension(LANES) :: k, g, f, psi, m_b, k_e, b, volumetric, dd, dh, beta, gamma
      real(wp), dimension(LANES) :: n_dr, h_dr, d_dr, gamma_dr   !< n:dr, and of the gradients along n
      real(wp), dimension(LANES) :: dy, a, b_turn    !< of gamma dn = y dt + beta dr + t dy - n a + r b
      real(wp), dimension(LANES) :: dl, flow         !< of L and of L D
   end type lanes_t
contains
   !> Changes of the rates of stress, fabric and plastic shear, and of the loading direction. Units of the results [kPa,
   !> -, -], of dn [-]; lin is that of w. docs/theory/integration.md section 5.3.
   pure subroutine changes_of_rate(par, w, lin, at_rest, y, r_in, changes, rates, dn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      logical, intent(in) :: at_rest                  !< y, r_in and the changes of e and p_c are zero
      real(wp), intent(in) :: y(LANES, NRATES)        !< of sigma', z and, without effect, plastic shear [kPa, -, -]
      real(wp), intent(in) :: r_in(LANES, 6)          !< of the memory [-]
      type(changes_t), intent(in) :: changes
      real(wp), intent(out) :: rates(LANES, NRATES)   !< of sigma', z and plastic shear
      real(wp), intent(out), optional :: dn(LANES, 6)
      type(lanes_t) :: x

      x%v = changes%d_strain(:, 1) + changes%d_strain(:, 2) + changes%d_strain(:, 3)
      if (at_rest) then
         call rest(w, changes, x)
      else
         call change_point(par, w, lin, y, changes, x)
      end if
      if (w%loading) then
         if (.not. at_rest) call change_moduli(par, w, lin, y, r_in, changes, x)
         call turn_direction(w, lin, changes, x)
         call fill_rates(par, w, lin, y, changes, x, rates, dn)
      else
         call elastic_rates(w, lin, changes, x, rates)
         if (present(dn)) dn = 0.0_wp
      end if
      if (lin%beside) call add_aside(w, lin, changes, x, rates(:, 1:6))
   end subroutine changes_of_rate

   !> Changes of n:t, t = 2 G e - V r the elastic rate of the stress ratio times p', for a rate that loads [kPa]. Part
   !> of docs/theory/integration.md section 4.3.
   pure function changes_of_drive(par, w, lin, y, changes) result(c)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES)        !< of sigma', z and, without effect, plastic shear [kPa, -, -]
      type(changes_t), intent(in) :: changes
      real(wp) :: c(LANES)
      type(lanes_t) :: x

      x%v = changes%d_strain(:, 1) + changes%d_strain(:, 2) + changes%d_strain(:, 3)
      call change_point(par, w, lin, y, changes, x)
      c = (2.0_wp*w%g)*contractions(changes%d_strain, deviator(w%n)) + (2.0_wp*ddot(w%n, lin%d_e))*x%g &
          - w%r_n*x%volumetric - (w%k_e*(lin%d_v - w%b_rate))*along_ratio(w, lin, y, x%p, w%n)
   end function changes_of_drive

   !> What change_point leaves where only the strain rate and the suction rate change.
   pure subroutine rest(w, changes, x)
      type(rate_t), intent(in) :: w
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp) :: b

      b = 0.0_wp
      if (w%iso_active) b = w%iso%b
      x%mean = 0.0_wp
      x%p = 0.0_wp
      x%k = 0.0_wp
      x%g = 0.0_wp
      x%k_e = 0.0_wp
      x%beta = 0.0_wp
      x%gamma = 0.0_wp
      x%dd = 0.0_wp
      x%dh = 0.0_wp
      x%n_dr = 0.0_wp
      x%h_dr = 0.0_wp
      x%d_dr = 0.0_wp
      x%gamma_dr = 0.0_wp
      x%volumetric = w%k_e*(x%v - b*changes%d_pc)
   end subroutine rest

   !> Changes of the point's scalars and of both moduli.
   pure subroutine change_point(par, w, lin, y, changes, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES)
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp) :: m_b_slope, follows

      follows = merge(0.0_wp, 1.0_wp, lin%held_p)
      m_b_slope = merge(-par%n_b*w%m_b, 0.0_wp, w%psi < 0.0_wp)
      x%mean = (y(:, 1) + y(:, 2) + y(:, 3))/3.0_wp
      x%p = follows*x%mean
      x%share = x%p*lin%per_p
      x%k = w%k*(2.0_wp/3.0_wp*x%share + changes%e*lin%k_slope)
      x%g = w%g*(0.5_wp*x%share + changes%e*lin%g_slope)
      x%f = lin%bond%df_de*changes%e + lin%bond%df_dpc*changes%p_c
      x%psi = changes%e - lin%e_c*(x%f*lin%per_f - x%p*lin%e_c_slope)
      x%m_b = m_b_slope*x%psi
      if (w%iso_active) then
         call change_of_mechanism(par, w, lin, y, changes, x)
      else
         x%k_e = x%k
         x%b = 0.0_wp
      end if
      x%volumetric = (lin%d_v - w%b_rate)*x%k_e + w%k_e*(x%v - x%b)
   end subroutine change_point

   !> a:dr of the change of the stress ratio, which is a deviator.
   pure function along_ratio(w, lin, y, p, a) result(c)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES), p(LANES), a(6)
      real(wp) :: c(LANES), s(6)

      s = deviator(a)
      c = lin%per_p*(contractions(y(:, 1:6), s) - ddot(s, w%r)*p)
   end function along_ratio

   !> Changes of the rates where nothing loads.
   pure subroutine elastic_rates(w, lin, changes, x, rates)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(in) :: x
      real(wp), intent(out) :: rates(LANES, NRATES)
      integer :: i, j

      do j = 1, LANES
         do i = 1, 6
            rates(j, i) = (2.0_wp*w%g)*(changes%d_strain(j, i) - (IDENTITY(i)/3.0_wp)*x%v(j)) &
                          + (2.0_wp*lin%d_e(i))*x%g(j) + IDENTITY(i)*x%volumetric(j)
         end do
      end do
      rates(:, 7:13) = 0.0_wp
   end subroutine elastic_rates

   !> Changes of D, 1/h, beta and gamma at the present direction, and how dr contracts with the gradients along n.
   pure subroutine change_moduli(par, w, lin, y, r_in, changes, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES), r_in(LANES, 6)
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp), dimension(LANES) :: r_b, stiffness
      real(wp) :: d_g, d_k, d_r, d_psi, d_z, h_share, h_e, h_r, h_in, h_stiffness, h_b, r_b_1, at_rest

      ! D and 1/h: coefficients of what they depend on
      d_g = 0.0_wp
      d_k = 0.0_wp
      d_psi = 0.0_wp
      d_z = 0.0_wp
      if (w%capped_d) then
         d_g = w%d/w%g
         d_k = -w%d/w%k_e
         d_r = -w%d/w%r_n
      else
         d_psi = w%a_d*SQRT_2_3*w%lode*par%n_d*w%m_d
         d_r = -w%a_d
         if (par%fabric .and. w%z_n > 0.0_wp) d_z = par%a_0*w%d/w%a_d
      end if
      h_e = 0.0_wp
      h_in = 0.0_wp
      h_stiffness = 0.0_wp
      h_b = 0.0_wp
      if (w%capped_h) then
         at_rest = 2.0_wp*w%g - w%k_e*w%d*w%r_n
         h_share = w%h_b
         h_stiffness = -w%h_b/at_rest
         h_r = 2.0_wp/3.0_wp*w%p/((1.0_wp - par%cap_h)*at_rest)
         h_b = -h_r
      else
         h_share = 0.5_wp*w%h_b
         h_e = -w%h_b*lin%b_slope
         h_r = merge(0.0_wp, lin%per_b_0, w%floored)
         h_in = -h_r
      end if
      r_b_1 = SQRT_2_3*w%lode
      x%n_dr = along_ratio(w, lin, y, x%p, w%n)
      x%h_dr = along_ratio(w, lin, y, x%p, lin%h_n)
      x%d_dr = along_ratio(w, lin, y, x%p, lin%d_n)
      x%gamma_dr = along_ratio(w, lin, y, x%p, lin%gamma_n)
      r_b = r_b_1*x%m_b
      x%dd = d_g*x%g + d_k*x%k_e + d_r*x%n_dr + d_psi*x%psi
      if (abs(d_z) > 0.0_wp) x%dd = x%dd + d_z*contractions(y(:, 7:12), w%n)
      x%dh = h_share*x%share + h_e*changes%e + h_r*x%n_dr
      if (abs(h_in) > 0.0_wp) x%dh = x%dh + h_in*contractions(r_in, w%n)
      if (w%capped_h) then
         stiffness = 2.0_wp*x%g - (w%d*w%r_n)*x%k_e - w%k_e*(w%r_n*x%dd + w%d*x%n_dr)
         x%dh = x%dh + h_stiffness*stiffness + h_b*r_b
      end if
      x%beta = 2.0_wp/3.0_wp*x%p + (w%k_e*w%d)*x%dh + w%h_b*(w%d*x%k_e + w%k_e*x%dd)
      x%gamma = 2.0_wp/3.0_wp*((r_b_1*w%m_b)*x%p + w%p*r_b) + 2.0_wp*(w%h_b*x%g + w%g*x%dh)
   end subroutine change_moduli

   !> The turn of the direction, gamma dn = y dt + beta dr + t dy - n dgamma + r dbeta, by its contractions: scalars dy,
   !> a, b of gamma dn = (y dt + beta dr) + t dy - n a + r b, and the changes of L and L D with them.
   pure subroutine turn_direction(w, lin, changes, x)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp), dimension(LANES) :: h_t, d_t, s_1, s_2, s_3
      real(wp) :: h_on_t, h_on_r, d_on_t, d_on_r

      h_on_t = ddot(lin%h_n, w%t)
      h_on_r = ddot(lin%h_n, w%r)
      d_on_t = ddot(lin%d_n, w%t)
      d_on_r = ddot(lin%d_n, w%r)
      h_t = along_turn(w, lin, changes, x, lin%h_n, x%h_dr)
      d_t = along_turn(w, lin, changes, x, lin%d_n, x%d_dr)
      s_1 = -along_turn(w, lin, changes, x, w%n, x%n_dr)
      s_2 = -along_turn(w, lin, changes, x, lin%gamma_n, x%gamma_dr) - w%gamma*x%gamma
      s_3 = -w%k_e*(w%d*h_t + w%h_b*d_t) - w%gamma*x%beta          ! beta_n = K_e (D h_n + d_n/h)
      x%dy = lin%inverse(1, 1)*s_1 + lin%inverse(1, 2)*s_2 + lin%inverse(1, 3)*s_3
      x%a = lin%inverse(2, 1)*s_1 + lin%inverse(2, 2)*s_2 + lin%inverse(2, 3)*s_3
      x%b_turn = lin%inverse(3, 1)*s_1 + lin%inverse(3, 2)*s_2 + lin%inverse(3, 3)*s_3
      x%dh = x%dh + lin%per_gamma*(h_t + h_on_t*x%dy + h_on_r*x%b_turn)
      x%dd = x%dd + lin%per_gamma*(d_t + d_on_t*x%dy + d_on_r*x%b_turn)
      x%dl = (x%dh - w%l*x%dy)*lin%per_y
      x%flow = w%d*x%dl + w%l*x%dd
   end subroutine turn_direction

   !> a:(y dt + beta dr), a deviator.
   pure function along_turn(w, lin, changes, x, a, a_dr) result(c)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(in) :: x
      real(wp), intent(in) :: a(6), a_dr(LANES)
      real(wp) :: c(LANES), s(6)

      s = deviator(a)
      c = (2.0_wp*w%y*w%g)*contractions(changes%d_strain, s) + (2.0_wp*w%y*ddot(s, lin%d_e))*x%g &
          - (w%y*ddot(s, w%r))*x%volumetric + (w%beta - w%y*w%k_e*(lin%d_v - w%b_rate))*a_dr
   end function along_turn

   !> Changes of the rates where something loads. With dt = 2 d(G e) - r dV - V dr and t = 2 G e - V r, e the deviatoric
   !> strain rate and V the elastic rate of p', everything is a sum of the changes of strain rate and stress, of e, n, r
   !> and of the unit tensor.
   pure subroutine fill_rates(par, w, lin, y, changes, x, rates, dn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES)
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(in) :: x
      real(wp), intent(out) :: rates(LANES, NRATES)
      real(wp), intent(out), optional :: dn(LANES, 6)
      real(wp), dimension(LANES) :: on_e, on_n, on_r, on_z, on_p, turn_e, turn_n, turn_r, turn_p
      real(wp) :: volumetric, drag, strain_1, stress_1, turn_strain, turn_stress, turning, turned, on_dr
      integer :: i, j

      volumetric = w%k_e*(lin%d_v - w%b_rate)
      on_dr = lin%per_gamma*(w%beta - w%y*volumetric)
      turn_strain = 2.0_wp*w%y*w%g*lin%per_gamma
      turn_stress = on_dr*lin%per_p
      turn_e = (2.0_wp*lin%per_gamma)*(w%y*x%g + w%g*x%dy)
      turn_n = -lin%per_gamma*x%a
      turn_r = lin%per_gamma*(x%b_turn - w%y*x%volumetric - volumetric*x%dy) - turn_stress*x%p
      turn_p = -(turn_strain/3.0_wp)*x%v - turn_stress*x%mean
      if (present(dn)) then
         do j = 1, LANES
            do i = 1, 6
               dn(j, i) = turn_strain*changes%d_strain(j, i) + turn_stress*y(j, i) + lin%d_e(i)*turn_e(j) &
                          + w%n(i)*turn_n(j) + w%r(i)*turn_r(j) + IDENTITY(i)*turn_p(j)
            end do
         end do
      end if

      ! d sigma' = 2 d(G e) - 2 G L dn - 2 n d(G L) + I dp'
      drag = 2.0_wp*w%g*w%l
      strain_1 = 2.0_wp*w%g - drag*turn_strain
      stress_1 = -drag*turn_stress
      on_e = 2.0_wp*x%g - drag*turn_e
      on_n = -drag*turn_n - 2.0_wp*(w%l*x%g + w%g*x%dl)
      on_r = -drag*turn_r
      on_p = x%volumetric - (w%l*w%d)*x%k_e - w%k_e*x%flow - drag*turn_p - (2.0_wp/3.0_wp*w%g)*x%v
      do j = 1, LANES
         do i = 1, 3
            rates(j, i) = strain_1*changes%d_strain(j, i) + stress_1*y(j, i) + lin%d_e(i)*on_e(j) + w%n(i)*on_n(j) &
                          + w%r(i)*on_r(j) + on_p(j)
         end do
         do i = 4, 6
            rates(j, i) = strain_1*changes%d_strain(j, i) + stress_1*y(j, i) + lin%d_e(i)*on_e(j) + w%n(i)*on_n(j) &
                          + w%r(i)*on_r(j)
         end do
         rates(j, 13) = SQRT_2_3*x%dl(j)
      end do
      if (.not. (par%fabric .and. w%d < 0.0_wp)) then
         rates(:, 7:12) = 0.0_wp
         return
      end if

      ! d z' = c_z (z_max n + z) d(L D) + c_z L D (z_max dn + dz)
      turning = par%c_z*w%l*w%d
      turned = turning*par%z_max
      strain_1 = turned*turn_strain
      stress_1 = turned*turn_stress
      on_e = turned*turn_e
      on_z = par%c_z*x%flow
      on_n = turned*turn_n + par%z_max*on_z
      on_r = turned*turn_r
      on_p = turned*turn_p
      do j = 1, LANES
         do i = 1, 6
            rates(j, 6 + i) = strain_1*changes%d_strain(j, i) + stress_1*y(j, i) + lin%d_e(i)*on_e(j) + w%n(i)*on_n(j) &
                              + w%r(i)*on_r(j) + w%z(i)*on_z(j) + turning*y(j, 6 + i) + IDENTITY(i)*on_p(j)
         end do
      end do
   end subroutine fill_rates

   !> Adds the change of what the elastic strain beside gives.
   pure subroutine add_aside(w, lin, changes, x, d_sigma)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(in) :: x
      real(wp), intent(inout) :: d_sigma(LANES, 6)
      real(wp) :: e(6), on_p(LANES)
      integer :: i, j

      e = deviator(lin%d_aside)
      on_p = trace(lin%d_aside)*x%k &
             + (w%k - 2.0_wp/3.0_wp*w%g)*(changes%d_aside(:, 1) + changes%d_aside(:, 2) + changes%d_aside(:, 3))
      do j = 1, LANES
         do i = 1, 6
            d_sigma(j, i) = d_sigma(j, i) + (2.0_wp*e(i))*x%g(j) + (2.0_wp*w%g)*changes%d_aside(j, i) &
                            + IDENTITY(i)*on_p(j)
         end do
      end do
   end subroutine add_aside

   !> Change of K_e and of B while the isotropic mechanism acts.
   pure subroutine change_of_mechanism(par, w, lin, y, changes, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(LANES, NRATES)
      type(changes_t), intent(in) :: changes
      type(lanes_t), intent(inout) :: x
      real(wp), dimension(LANES) :: r_dr, cube_dr, weight, approach, crowding, f, f_bond, coupling, share, a, dk
      real(wp) :: on_weight, by_norm, crowd_share, crowd_norm, e_share, per_coupling, per_a, per_k, softening
      real(wp) :: shared_e, shared_pc, per_f, coupled, per_weight, per_lambda, per_softening, per_e, per_m_b

      per_f = lin%per_f
      per_lambda = 1.0_wp/par%lambda
      per_weight = w%iso%share/w%iso%weight
      on_weight = 2.0_wp*(1.0_wp - w%iso%weight)
      by_norm = 3.0_wp/(lin%lode_r*w%m_b)**2
      crowd_share = 1.0_wp + 3.0_wp*(lin%r_norm/par%m_c)**2
      crowd_norm = w%iso%approach*6.0_wp/par%m_c**2
      shared_e = lin%bond%df_de*per_f
      shared_pc = lin%bond%df_dpc*per_f
      e_share = w%iso%share*(1.0_wp/lin%e - 1.0_wp/(1.0_wp + lin%e))
      per_coupling = merge(0.0_wp, w%iso%share/(1.0_wp + w%iso%c), w%iso%floored)
      per_a = w%iso%a/w%iso%share
      per_k = 1.0_wp/w%k
      softening = w%k*w%iso%a*lin%per_p
      per_softening = 1.0_wp/(1.0_wp + softening)
      per_e = 1.0_wp/lin%e
      per_m_b = 1.0_wp/w%m_b
      coupled = lin%kappa*(w%iso%f + w%iso%c)/3.0_wp
      r_dr = along_ratio(w, lin, y, x%p, w%r)
      cube_dr = along_ratio(w, lin, y, x%p, lin%r_cube_slope)
      associate (de => changes%e, dpc => changes%p_c)
         ! w = 1 - (|r|/R_b(r))^2; r_dr = |r| d|r|
         weight = on_weight*((lin%lode_slope_r/lin%lode_r)*cube_dr + x%m_b*per_m_b) - by_norm*r_dr
         f_bond = per_f*x%f
         approach = w%iso%approach*(x%share - (f_bond - de*per_e)*per_lambda)
         crowding = crowd_share*approach + crowd_norm*r_dr
         f = -w%iso%f_slope*crowding
         coupling = -(shared_e*w%iso%f)*de - (lin%e*shared_e)*(f - w%iso%f*f_bond) &
                    - (lin%e*per_f*w%iso%f)*(lin%curvature(3)*de + lin%curvature(2)*dpc)
         share = per_weight*weight + e_share*de - per_coupling*coupling
         a = per_a*share + w%iso%share*((par%lambda - lin%kappa)*f - lin%kappa*coupling - coupled*x%share)
         dk = x%k*per_k
         x%k_e = w%k_e*(dk - ((w%k*lin%per_p)*a + softening*(dk - x%share))*per_softening)
         x%b = w%iso%b*changes%d_pc - lin%d_pc*((w%iso%f*shared_pc)*share &
                                                + (w%iso%share*shared_pc)*(f - w%iso%f*f_bond) &
                                                + (w%iso%share*w%iso%f*per_f) &
                                                *(lin%curvature(2)*de + lin%curvature(1)*dpc))
      end associate
   end subroutine change_of_mechanism
end module mud_sensitivity
