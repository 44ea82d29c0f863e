! SPDX-License-Identifier: MIT
!> Derivative of one rate with respect to everything it depends on: state, memory, strain rate and suction rate.
!> The consistent tangent carries it through the substeps; nothing is evaluated twice and nothing is perturbed;
!> docs/theory/integration.md section 5.3.
module mud_sensitivity
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_linearise, only: linearised_t, linearise
   use mud_rates, only: rate_t
   use mud_tensor, only: IDENTITY, ddot, trace, deviator
   implicit none (type, external)
   private
   public :: change_t, linearised_t, linearise, change_of_rate, changes_of_rate, NRATES

   integer, parameter :: NRATES = 13   !< sigma'(6), z(6), plastic shear.
   integer, parameter :: WIDTH = 8     !< Directions worked on side by side: the seven of a tangent, and an even number.

   !> A direction in which the arguments of a rate change.
   type :: change_t
      real(wp) :: sigma(6), z(6), r_in(6)   !< [kPa, -, -]
      real(wp) :: e, p_c                    !< [-, kPa]
      real(wp) :: d_strain(6), d_pc         !< of the strain rate that loads and the suction rate [-, kPa]
      real(wp) :: d_aside(6)                !< of the strain rate beside it that is elastic [-]
   end type change_t

   !> Directions side by side: changes of a rate's arguments, what lies between, and its results.
   type :: lanes_t
      integer :: m                                   !< how many, an even number
      logical :: at_rest                             !< the state does not change, as in the first stage of an update
      real(wp), dimension(WIDTH, 6) :: sigma, z, r_in, strain, aside
      real(wp), dimension(WIDTH) :: e, p_c, d_pc
      real(wp), dimension(WIDTH) :: mean, v          !< a third of the trace of sigma; trace of strain
      real(wp), dimension(WIDTH) :: p, share         !< of p', and over p'
      real(wp), dimension(WIDTH) :: k, g, f, psi, m_b, k_e, b, volumetric, dd, dh, beta, gamma
      real(wp), dimension(WIDTH, 6) :: dr, d_e, dt   !< of r, G e and y t
      real(wp), dimension(WIDTH) :: on_t, on_n, on_r !< coefficients of gamma dn
      real(wp), dimension(WIDTH) :: n_part, p_part   !< parts of the stress rate along n and I
      real(wp), dimension(WIDTH) :: flow             !< of L D
      real(wp), dimension(WIDTH, 6) :: d_sigma, d_z, dn
      real(wp), dimension(WIDTH) :: d_eps_q
   end type lanes_t
contains
   !> Change of the rates of stress, fabric and plastic shear, and of the loading direction, along one direction.
   pure subroutine change_of_rate(par, w, lin, change, d_sigma, d_z, d_eps_q, dn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(change_t), intent(in) :: change
      real(wp), intent(out) :: d_sigma(6), d_z(6), d_eps_q, dn(6)
      real(wp) :: rates(NRATES, 1), turns(6, 1)

      call changes_of_rate(par, w, lin, 1, [change], rates, turns)
      d_sigma = rates(1:6, 1)
      d_z = rates(7:12, 1)
      d_eps_q = rates(13, 1)
      dn = turns(:, 1)
   end subroutine change_of_rate

   !> The same along n directions. Loops over directions stand inside, with a number of turns that the compiler does not
   !> know: it then lets two directions be worked on at once.
   pure subroutine changes_of_rate(par, w, lin, n, changes, rates, dn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      integer, intent(in) :: n
      type(change_t), intent(in) :: changes(n)
      real(wp), intent(out) :: rates(NRATES, n)       !< of sigma', z and plastic shear
      real(wp), intent(out), optional :: dn(6, n)
      type(lanes_t) :: x
      integer :: first, last, j

      do first = 1, n, WIDTH
         last = min(first + WIDTH - 1, n)
         call gather(lin, changes(first:last), x)
         if (x%at_rest) then
            call change_strain(w, x)
         else
            call change_point(par, w, lin, x)
         end if
         if (w%loading) then
            if (.not. x%at_rest) call change_moduli(par, w, lin, x)
            call turn_direction(par, w, lin, x)
         else
            call change_elastic(x)
         end if
         if (lin%beside) call add_aside(w, lin, x)
         do j = first, last
            rates(1:6, j) = x%d_sigma(j - first + 1, :)
            rates(7:12, j) = x%d_z(j - first + 1, :)
            rates(13, j) = x%d_eps_q(j - first + 1)
            if (present(dn)) dn(:, j) = x%dn(j - first + 1, :)
         end do
      end do
   end subroutine changes_of_rate

   !> Directions side by side, an even number of them.
   pure subroutine gather(lin, changes, x)
      type(linearised_t), intent(in) :: lin
      type(change_t), intent(in) :: changes(:)
      type(lanes_t), intent(inout) :: x
      integer :: j, from

      x%m = size(changes) + mod(size(changes), 2)
      x%at_rest = .true.
      do j = 1, size(changes)
         x%at_rest = sum(abs(changes(j)%sigma)) + sum(abs(changes(j)%z)) + sum(abs(changes(j)%r_in)) &
                     + abs(changes(j)%e) + abs(changes(j)%p_c) <= 0.0_wp
         if (.not. x%at_rest) exit
      end do
      do j = 1, x%m
         from = min(j, size(changes))
         x%strain(j, :) = changes(from)%d_strain
         x%d_pc(j) = changes(from)%d_pc
         if (lin%beside) x%aside(j, :) = changes(from)%d_aside
         if (x%at_rest) cycle
         x%sigma(j, :) = changes(from)%sigma
         x%z(j, :) = changes(from)%z
         x%r_in(j, :) = changes(from)%r_in
         x%e(j) = changes(from)%e
         x%p_c(j) = changes(from)%p_c
      end do
   end subroutine gather

   !> What change_point and change_moduli leave where only the strain rate and the suction rate change.
   pure subroutine change_strain(w, x)
      type(rate_t), intent(in) :: w
      type(lanes_t), intent(inout) :: x
      real(wp) :: b, y
      integer :: i, j

      b = 0.0_wp
      if (w%iso_active) b = w%iso%b
      y = 0.0_wp
      if (w%loading) y = w%y
      do j = 1, x%m
         x%v(j) = x%strain(j, 1) + x%strain(j, 2) + x%strain(j, 3)
         x%volumetric(j) = w%k_e*(x%v(j) - b*x%d_pc(j))
         x%k(j) = 0.0_wp
         x%g(j) = 0.0_wp
         x%k_e(j) = 0.0_wp
         x%dd(j) = 0.0_wp
         x%dh(j) = 0.0_wp
         x%beta(j) = 0.0_wp
         x%gamma(j) = 0.0_wp
      end do
      do i = 1, 6
         do j = 1, x%m
            x%d_e(j, i) = w%g*(x%strain(j, i) - (IDENTITY(i)/3.0_wp)*x%v(j))
            x%dt(j, i) = y*(2.0_wp*x%d_e(j, i) - w%r(i)*x%volumetric(j))
            x%z(j, i) = 0.0_wp
         end do
      end do
   end subroutine change_strain

   !> Changes of the point's scalars, of both moduli, of the stress ratio and of the elastic stress rate.
   pure subroutine change_point(par, w, lin, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(lanes_t), intent(inout) :: x
      real(wp) :: m_b_slope, follows
      integer :: i, j

      follows = merge(0.0_wp, 1.0_wp, lin%held_p)
      m_b_slope = merge(-par%n_b*w%m_b, 0.0_wp, w%psi < 0.0_wp)
      do j = 1, x%m
         x%mean(j) = (x%sigma(j, 1) + x%sigma(j, 2) + x%sigma(j, 3))/3.0_wp
         x%v(j) = x%strain(j, 1) + x%strain(j, 2) + x%strain(j, 3)
         x%p(j) = follows*x%mean(j)
         x%share(j) = x%p(j)*lin%per_p
         x%k(j) = w%k*(2.0_wp/3.0_wp*x%share(j) + x%e(j)*lin%k_slope)
         x%g(j) = w%g*(0.5_wp*x%share(j) + x%e(j)*lin%g_slope)
         x%f(j) = lin%bond%df_de*x%e(j) + lin%bond%df_dpc*x%p_c(j)
         x%psi(j) = x%e(j) - lin%e_c*(x%f(j)*lin%per_f - x%p(j)*lin%e_c_slope)
         x%m_b(j) = m_b_slope*x%psi(j)
         x%k_e(j) = x%k(j)
         x%b(j) = 0.0_wp
      end do
      do i = 1, 6
         do j = 1, x%m
            x%dr(j, i) = (x%sigma(j, i) - IDENTITY(i)*x%mean(j) - w%r(i)*x%p(j))*lin%per_p
         end do
      end do
      if (w%iso_active) call change_of_mechanism(par, w, lin, x)
      do j = 1, x%m
         x%volumetric(j) = (lin%d_v - w%b_rate)*x%k_e(j) + w%k_e*(x%v(j) - x%b(j))
      end do
      do i = 1, 6
         do j = 1, x%m
            x%d_e(j, i) = lin%d_e(i)*x%g(j) + w%g*(x%strain(j, i) - (IDENTITY(i)/3.0_wp)*x%v(j))
         end do
      end do
   end subroutine change_point

   !> Change of a rate without loading.
   pure subroutine change_elastic(x)
      type(lanes_t), intent(inout) :: x
      integer :: i, j

      do i = 1, 6
         do j = 1, x%m
            x%d_sigma(j, i) = 2.0_wp*x%d_e(j, i) + IDENTITY(i)*x%volumetric(j)
            x%d_z(j, i) = 0.0_wp
            x%dn(j, i) = 0.0_wp
         end do
      end do
      x%d_eps_q = 0.0_wp
   end subroutine change_elastic

   !> Changes of D, 1/h, beta, gamma and y t at the present direction.
   pure subroutine change_moduli(par, w, lin, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(lanes_t), intent(inout) :: x
      real(wp) :: dr_n, r_b, stiffness, dd, dh   ! of one direction
      real(wp) :: d_g, d_k, d_r, d_psi, d_z, h_share, h_e, h_r, h_in, h_stiffness, h_b, r_b_1, volumetric, at_rest
      integer :: i, j

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
      do j = 1, x%m
         dr_n = along(x%dr, j, w%n)
         r_b = r_b_1*x%m_b(j)
         dd = d_g*x%g(j) + d_k*x%k_e(j) + d_r*dr_n + d_psi*x%psi(j) + d_z*along(x%z, j, w%n)
         stiffness = 2.0_wp*x%g(j) - (w%d*w%r_n)*x%k_e(j) - w%k_e*(w%r_n*dd + w%d*dr_n)
         dh = h_share*x%share(j) + h_e*x%e(j) + h_r*dr_n + h_in*along(x%r_in, j, w%n) + h_stiffness*stiffness + h_b*r_b
         x%beta(j) = 2.0_wp/3.0_wp*x%p(j) + (w%k_e*w%d)*dh + w%h_b*(w%d*x%k_e(j) + w%k_e*dd)
         x%gamma(j) = 2.0_wp/3.0_wp*((r_b_1*w%m_b)*x%p(j) + w%p*r_b) + 2.0_wp*(w%h_b*x%g(j) + w%g*dh)
         x%dd(j) = dd
         x%dh(j) = dh
      end do

      volumetric = w%k_e*(lin%d_v - w%b_rate)
      do i = 1, 6
         do j = 1, x%m
            x%dt(j, i) = w%y*(2.0_wp*x%d_e(j, i) - w%r(i)*x%volumetric(j)) + (w%beta - w%y*volumetric)*x%dr(j, i)
         end do
      end do
   end subroutine change_moduli

   !> The direction's turn, gamma dn = y dt + beta dr + t dy - n dgamma + r dbeta, and the rates with it.
   pure subroutine turn_direction(par, w, lin, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(lanes_t), intent(inout) :: x
      real(wp) :: h_t, d_t, s_1, s_2, s_3, a, b, dy, dd, dh, dl, turn   ! of one direction
      real(wp) :: h_on_t, h_on_r, d_on_t, d_on_r, turning
      integer :: i, j

      h_on_t = ddot(lin%h_n, w%t)
      h_on_r = ddot(lin%h_n, w%r)
      d_on_t = ddot(lin%d_n, w%t)
      d_on_r = ddot(lin%d_n, w%r)
      do j = 1, x%m
         h_t = along(x%dt, j, lin%h_n)
         d_t = along(x%dt, j, lin%d_n)
         s_1 = -along(x%dt, j, w%n)
         s_2 = -along(x%dt, j, lin%gamma_n) - w%gamma*x%gamma(j)
         s_3 = -w%k_e*(w%d*h_t + w%h_b*d_t) - w%gamma*x%beta(j)          ! beta_n = K_e (D h_n + d_n/h)
         dy = lin%inverse(1, 1)*s_1 + lin%inverse(1, 2)*s_2 + lin%inverse(1, 3)*s_3
         a = lin%inverse(2, 1)*s_1 + lin%inverse(2, 2)*s_2 + lin%inverse(2, 3)*s_3
         b = lin%inverse(3, 1)*s_1 + lin%inverse(3, 2)*s_2 + lin%inverse(3, 3)*s_3
         dh = x%dh(j) + lin%per_gamma*(h_t + h_on_t*dy + h_on_r*b)
         dd = x%dd(j) + lin%per_gamma*(d_t + d_on_t*dy + d_on_r*b)
         dl = (dh - w%l*dy)*lin%per_y
         x%d_eps_q(j) = SQRT_2_3*dl
         x%on_t(j) = dy
         x%on_n(j) = -a
         x%on_r(j) = b
         x%n_part(j) = w%l*x%g(j) + w%g*dl
         x%flow(j) = w%d*dl + w%l*dd
         x%p_part(j) = x%volumetric(j) - (w%l*w%d)*x%k_e(j) - w%k_e*x%flow(j)
      end do
      do i = 1, 6
         do j = 1, x%m
            turn = lin%per_gamma*(x%dt(j, i) + w%t(i)*x%on_t(j) + w%n(i)*x%on_n(j) + w%r(i)*x%on_r(j))
            x%dn(j, i) = turn
            x%d_sigma(j, i) = 2.0_wp*(x%d_e(j, i) - w%n(i)*x%n_part(j) - (w%g*w%l)*turn) + IDENTITY(i)*x%p_part(j)
         end do
      end do
      if (.not. (par%fabric .and. w%d < 0.0_wp)) then
         x%d_z = 0.0_wp
         return
      end if
      turning = par%c_z*w%l*w%d
      do i = 1, 6
         do j = 1, x%m
            x%d_z(j, i) = (par%c_z*(par%z_max*w%n(i) + w%z(i)))*x%flow(j) + turning*(par%z_max*x%dn(j, i) + x%z(j, i))
         end do
      end do
   end subroutine turn_direction

   !> Contraction of one of several tensors side by side with a direction.
   pure real(wp) function along(tensors, j, direction)
      real(wp), intent(in) :: tensors(WIDTH, 6), direction(6)
      integer, intent(in) :: j

      along = direction(1)*tensors(j, 1) + direction(2)*tensors(j, 2) + direction(3)*tensors(j, 3) &
              + (2.0_wp*direction(4))*tensors(j, 4) + (2.0_wp*direction(5))*tensors(j, 5) &
              + (2.0_wp*direction(6))*tensors(j, 6)
   end function along

   !> Adds the change of what the elastic strain beside gives.
   pure subroutine add_aside(w, lin, x)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(lanes_t), intent(inout) :: x
      real(wp) :: d_aside(6), volume
      integer :: i, j

      d_aside = deviator(lin%d_aside)
      volume = trace(lin%d_aside)
      do j = 1, x%m
         x%v(j) = x%aside(j, 1) + x%aside(j, 2) + x%aside(j, 3)
         x%mean(j) = volume*x%k(j) + (w%k - 2.0_wp/3.0_wp*w%g)*x%v(j)
      end do
      do i = 1, 6
         do j = 1, x%m
            x%d_sigma(j, i) = x%d_sigma(j, i) + (2.0_wp*d_aside(i))*x%g(j) + (2.0_wp*w%g)*x%aside(j, i) &
                              + IDENTITY(i)*x%mean(j)
         end do
      end do
   end subroutine add_aside

   !> Change of K_e and of B while the isotropic mechanism acts.
   pure subroutine change_of_mechanism(par, w, lin, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(lanes_t), intent(inout) :: x
      real(wp) :: r_dr, weight, approach, crowding, f, f_bond, coupling, share, a, dk   ! of one direction
      real(wp) :: on_weight, by_norm, crowd_share, crowd_norm, e_share, per_coupling, per_a, per_k, softening, de, dpc
      real(wp) :: shared_e, shared_pc, per_f, coupled, per_weight, per_lambda, per_softening, per_e, per_m_b
      integer :: j

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
      do j = 1, x%m
         de = x%e(j)
         dpc = x%p_c(j)
         ! w = 1 - (|r|/R_b(r))^2; r_dr = |r| d|r|
         r_dr = along(x%dr, j, w%r)
         weight = on_weight*((lin%lode_slope_r/lin%lode_r)*along(x%dr, j, lin%r_cube_slope) + x%m_b(j)*per_m_b) &
                  - by_norm*r_dr
         f_bond = per_f*x%f(j)
         approach = w%iso%approach*(x%share(j) - (f_bond - de*per_e)*per_lambda)
         crowding = crowd_share*approach + crowd_norm*r_dr
         f = -w%iso%f_slope*crowding
         coupling = -(shared_e*w%iso%f)*de - (lin%e*shared_e)*(f - w%iso%f*f_bond) &
                    - (lin%e*per_f*w%iso%f)*(lin%curvature(3)*de + lin%curvature(2)*dpc)
         share = per_weight*weight + e_share*de - per_coupling*coupling
         a = per_a*share + w%iso%share*((par%lambda - lin%kappa)*f - lin%kappa*coupling - coupled*x%share(j))
         dk = x%k(j)*per_k
         x%k_e(j) = w%k_e*(dk - ((w%k*lin%per_p)*a + softening*(dk - x%share(j)))*per_softening)
         x%b(j) = w%iso%b*x%d_pc(j) - lin%d_pc*((w%iso%f*shared_pc)*share &
                                                + (w%iso%share*shared_pc)*(f - w%iso%f*f_bond) &
                                                + (w%iso%share*w%iso%f*per_f) &
                                                *(lin%curvature(2)*de + lin%curvature(1)*dpc))
      end do
   end subroutine change_of_mechanism
end module mud_sensitivity
