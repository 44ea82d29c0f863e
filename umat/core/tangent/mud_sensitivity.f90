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
   use mud_linearise, only: linearised_t, changes_t, inner_changes_t, sum_t, NO_SUM, rest, change_point, along_ratio, &
      linearise_mechanism, changes_of_hardening
   use mud_rate, only: rate_t
   use mud_tensor, only: DIRECTIONS, tensors_t, contractions, contracted, traces, ZERO_TENSORS
   use mud_loading, only: loading_contracted, loading_traces, add_loading
   use mud_critical_state, only: dilatancy_slope
   use mud_hardening, only: KINEMATIC_EXPONENT
   use mud_options, only: live_numbers, changes_of_numbers, softens, changes_of_softening, changes_of_bend
   use mud_vector, only: NY, Y_Z, Y_Z_END, Y_SHEAR
   implicit none (type, external)
   private
   public :: changes_of_rate, changes_of_drive, changes_of_iso_drive

contains
   !> Changes of the rates of stress, fabric and plastic shear, and of the loading direction. Units of the results [kPa,
   !> -, -], of dn [-]; lin is that of w. docs/theory/integration.md section 5.3.
   pure subroutine changes_of_rate(par, w, lin, at_rest, y, r_in, strain, centre, changes, stress_only, rates, dn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      logical, intent(in) :: at_rest                  !< y, r_in and the changes of e and p_c are zero
      !> Changes of sigma', z, the numbers of options and, without effect, plastic shear [kPa, -, -].
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(tensors_t), intent(in) :: r_in             !< changes of the memory [-]
      type(tensors_t), intent(in) :: strain, centre   !< changes of strain rate and elastic domain [-]
      type(changes_t), intent(in) :: changes
      logical, intent(in) :: stress_only              !< rates of fabric and plastic shear are not asked for: zeros
      real(wp), intent(out) :: rates(DIRECTIONS, NY)   !< changes of the rates, as y
      real(wp), intent(out), optional :: dn(DIRECTIONS, 6)
      type(inner_changes_t) :: x

      x%v = loading_traces(changes%loading, strain, centre)
      if (at_rest) then
         call rest(w, changes, x)
      else
         call change_point(w, lin, y, changes, x)
      end if
      if (w%loading) then
         if (.not. at_rest) call change_moduli(par, w, lin, y, r_in, changes, x)
         call turn_direction(w, lin, strain, centre, changes, x)
      else
         x%turn = NO_SUM
         x%dl = 0.0_wp
         x%flow = 0.0_wp
      end if
      call fill_stress(w, lin, y, strain, centre, changes, x, rates(:, 1:6))
      rates(:, Y_Z:) = 0.0_wp
      if (w%loading .and. .not. stress_only) then
         rates(:, Y_SHEAR) = SQRT_2_3*x%dl
         if (live_numbers(par) > Y_SHEAR) call changes_of_numbers(par, w%l, w%d, w%own, x%dl, x%flow, x%p, y, rates)
         if (par%flow%fabric > 0.0_wp .and. w%d < 0.0_wp) then
            call fill_fabric(par, w, y, strain, centre, changes, x, rates(:, Y_Z:Y_Z_END))
         end if
      end if
      if (.not. present(dn)) return
      dn = 0.0_wp
      if (w%loading) call add_up(w, y, strain, centre, changes, x%turn, dn)
   end subroutine changes_of_rate

   !> Changes of n:t, t = 2 G e - V r the elastic rate of the stress ratio times p', for a rate that loads [kPa]. Part
   !> of docs/theory/integration.md section 4.3.
   pure function changes_of_drive(w, lin, y, strain, centre, changes) result(c)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)   !< changes of sigma', z and, without effect, plastic shear [kPa, -, -]
      type(tensors_t), intent(in) :: strain, centre   !< changes of strain rate and elastic domain [-]
      type(changes_t), intent(in) :: changes
      real(wp) :: c(DIRECTIONS)
      type(inner_changes_t) :: x

      x%v = loading_traces(changes%loading, strain, centre)
      call change_point(w, lin, y, changes, x)
      c = (2.0_wp*w%g)*loading_contracted(changes%loading, strain, centre, w%n) + (2.0_wp*lin%on_e(1))*x%g &
          - w%r_n*x%volumetric - (w%k_e*(lin%d_v - w%b_rate))*along_ratio(lin, y, x%p, w%n, w%r_n)
   end function changes_of_drive

   !> Changes of the drive A dp'/p' + B of the isotropic mechanism with those of the rate of stress, where it is 0:
   !> there it is that with the mechanism and that without, and so are its changes but for a positive factor. e is the
   !> void ratio there [-]. Part of docs/theory/integration.md section 4.3.
   pure function changes_of_iso_drive(par, w, lin, e, y, strain, centre, changes, rates) result(c)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: e
      real(wp), intent(in) :: y(DIRECTIONS, NY), rates(DIRECTIONS, NY)   !< as in changes_of_rate
      type(tensors_t), intent(in) :: strain, centre
      type(changes_t), intent(in) :: changes
      real(wp) :: c(DIRECTIONS)
      type(linearised_t) :: there
      type(inner_changes_t) :: x
      real(wp), dimension(DIRECTIONS) :: a, b, d_p
      real(wp) :: by_p

      there = lin
      call linearise_mechanism(par, w, e, there)
      x%v = loading_traces(changes%loading, strain, centre)
      call change_point(w, there, y, changes, x)
      call changes_of_hardening(w, there, y, changes, x, a, b)
      ! of the strain that loads alone
      d_p = (rates(:, 1) + rates(:, 2) + rates(:, 3))/3.0_wp - x%k*(lin%whole_v - lin%d_v) &
            - w%k*(traces(strain) - x%v)
      by_p = (w%d_p - w%k*(lin%whole_v - lin%d_v))*lin%per_p
      c = by_p*(a - w%iso%a*x%share) + (w%iso%a*lin%per_p)*d_p + lin%d_pc*b + w%iso%b*changes%d_pc
   end function changes_of_iso_drive

   !> Changes of D, 1/h, beta and gamma at the present direction, and how dr contracts with the gradients along n.
   pure subroutine change_moduli(par, w, lin, y, r_in, changes, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(tensors_t), intent(in) :: r_in
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(inout) :: x
      real(wp) :: n_dz(DIRECTIONS), q(DIRECTIONS), r_b, r_d_psi, r_b_m, per_p
      integer :: j

      r_b_m = SQRT_2_3*w%lode
      r_d_psi = r_b_m*dilatancy_slope(par%critical, w%m_d)
      x%n_dr = along_ratio(lin, y, x%p, w%n, lin%on_r(1))
      x%h_dr = along_ratio(lin, y, x%p, lin%h_n, lin%on_r(2))
      x%d_dr = along_ratio(lin, y, x%p, lin%d_n, lin%on_r(3))
      x%gamma_dr = along_ratio(lin, y, x%p, lin%gamma_n, lin%on_r(4))
      associate (s => lin%slopes)
         per_p = s%h_p*w%p + s%h_b_0*w%b_0*KINEMATIC_EXPONENT
         x%dd = s%d_g*x%g + s%d_k*x%k_e + s%d_r*x%n_dr + (s%d_r_d*r_d_psi)*x%psi
         x%dh = per_p*x%share + (s%h_b_0*w%b_0*lin%b_slope)*changes%e + s%h_g*x%g + s%h_k*x%k_e &
                + (s%h_r + s%h_x)*x%n_dr + (s%h_r_d*r_d_psi)*x%psi + (s%h_r_b*r_b_m)*x%m_b
         if (abs(s%d_z) > 0.0_wp) then
            n_dz = contractions(y(:, Y_Z:Y_Z_END), w%n)
            x%dd = x%dd + s%d_z*n_dz
            x%dh = x%dh + s%h_z*n_dz
         end if
         if (s%h_x > 0.0_wp .and. r_in%kind /= ZERO_TENSORS) x%dh = x%dh - s%h_x*contracted(r_in, w%n)
         if (softens(par)) then
            q = changes_of_softening(w%own, x%p, y)
            x%dd = x%dd + s%d_ln*q
            x%dh = x%dh + s%h_ln*q
         end if
         if (w%own%bends) then
            ! with M^d/M^b, b_0 and the numbers
            q = changes_of_bend((dilatancy_slope(par%critical, w%m_d)/w%m_d)*x%psi - x%m_b/w%m_b &
                                - KINEMATIC_EXPONENT*x%share - lin%b_slope*changes%e, y)
            x%dd = x%dd + s%d_q*q + s%d_x*x%n_dr
            x%dh = x%dh + s%h_q*q
            if (r_in%kind /= ZERO_TENSORS) x%dd = x%dd - s%d_x*contracted(r_in, w%n)
         end if
      end associate
      do j = 1, DIRECTIONS
         r_b = r_b_m*x%m_b(j)
         x%beta(j) = 2.0_wp/3.0_wp*x%p(j) + (w%k_e*w%d)*x%dh(j) + (w%h_b*w%d)*x%k_e(j) + (w%h_b*w%k_e)*x%dd(j)
         x%gamma(j) = 2.0_wp/3.0_wp*(w%r_b*x%p(j) + w%p*r_b) + (2.0_wp*w%h_b)*x%g(j) + (2.0_wp*w%g)*x%dh(j)
      end do
   end subroutine change_moduli

   !> The turn of the direction, gamma dn = y dt + beta dr + t dy - n dgamma + r dbeta, by its contractions: scalars dy,
   !> a, b of gamma dn = (y dt + beta dr) + t dy - n a + r b, and the changes of L and L D with them. With
   !> dt = 2 d(G e) - r dV - V dr and t = 2 G e - V r, e the deviatoric strain rate and V the elastic rate of p'.
   pure subroutine turn_direction(w, lin, strain, centre, changes, x)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      type(tensors_t), intent(in) :: strain, centre
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(inout) :: x
      real(wp), dimension(DIRECTIONS) :: n_e, h_e, d_e, gamma_e
      real(wp), dimension(4) :: on_g, on_v
      real(wp) :: elastic, on_e, on_dr, n_t, h_t, d_t, gamma_t, s_1, s_2, s_3, dy, dh, dd, a, b, e
      integer :: j

      elastic = w%k_e*(lin%d_v - w%b_rate)
      on_e = 2.0_wp*w%y*w%g
      on_dr = w%beta - w%y*elastic
      x%turn%of_whole = 0.0_wp
      x%turn%of_loading = on_e*lin%per_gamma
      x%turn%of_stress = lin%per_gamma*on_dr*lin%per_p
      n_e = loading_contracted(changes%loading, strain, centre, w%n)
      h_e = loading_contracted(changes%loading, strain, centre, lin%h_n)
      d_e = loading_contracted(changes%loading, strain, centre, lin%d_n)
      gamma_e = loading_contracted(changes%loading, strain, centre, lin%gamma_n)
      on_g = 2.0_wp*w%y*lin%on_e
      on_v = w%y*lin%on_r
      associate (loading => changes%loading)
         do j = 1, DIRECTIONS
            ! n, h_n, d_n, gamma_n : (y dt + beta dr)
            n_t = on_e*n_e(j) + on_g(1)*x%g(j) - on_v(1)*x%volumetric(j) + on_dr*x%n_dr(j)
            h_t = on_e*h_e(j) + on_g(2)*x%g(j) - on_v(2)*x%volumetric(j) + on_dr*x%h_dr(j)
            d_t = on_e*d_e(j) + on_g(3)*x%g(j) - on_v(3)*x%volumetric(j) + on_dr*x%d_dr(j)
            gamma_t = on_e*gamma_e(j) + on_g(4)*x%g(j) - on_v(4)*x%volumetric(j) + on_dr*x%gamma_dr(j)
            s_1 = -n_t
            s_2 = -gamma_t - w%gamma*x%gamma(j)
            s_3 = -(w%k_e*w%d)*h_t - (w%k_e*w%h_b)*d_t - w%gamma*x%beta(j)   ! beta_n = K_e (D h_n + d_n/h)
            dy = lin%inverse(1, 1)*s_1 + lin%inverse(1, 2)*s_2 + lin%inverse(1, 3)*s_3
            a = lin%inverse(2, 1)*s_1 + lin%inverse(2, 2)*s_2 + lin%inverse(2, 3)*s_3
            b = lin%inverse(3, 1)*s_1 + lin%inverse(3, 2)*s_2 + lin%inverse(3, 3)*s_3
            dh = x%dh(j) + lin%per_gamma*(h_t + lin%on_t(2)*dy + lin%on_r(2)*b)
            dd = x%dd(j) + lin%per_gamma*(d_t + lin%on_t(3)*dy + lin%on_r(3)*b)
            x%dl(j) = (dh - w%l*dy)*lin%per_y
            x%flow(j) = w%d*x%dl(j) + w%l*dd
            e = (2.0_wp*lin%per_gamma)*(w%y*x%g(j) + w%g*dy)
            x%turn%first(j) = loading%part(1)*e + x%turn%of_loading*loading%along(j, 1)
            x%turn%second(j) = loading%part(2)*e + x%turn%of_loading*loading%along(j, 2)
            x%turn%n(j) = -lin%per_gamma*a
            x%turn%r(j) = lin%per_gamma*(b - w%y*x%volumetric(j) - elastic*dy) - x%turn%of_stress*x%p(j)
            ! deviators
            x%turn%p(j) = -(x%turn%of_loading*x%v(j) + lin%d_v*e)*(1.0_wp/3.0_wp) - x%turn%of_stress*x%mean(j)
         end do
      end associate
   end subroutine turn_direction

   !> Changes of the rate of stress: d sigma' = 2 d(G_c e) + 2 d((G - G_c) e_l) - 2 G L dn - 2 n d(G L) + I dp', e the
   !> deviator of the whole strain rate, e_l that of what loads.
   pure subroutine fill_stress(w, lin, y, strain, centre, changes, x, rates)
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(tensors_t), intent(in) :: strain, centre
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(in) :: x
      real(wp), intent(out) :: rates(DIRECTIONS, 6)
      type(sum_t) :: s
      real(wp) :: drag, more, v(DIRECTIONS), dg_less
      integer :: j

      drag = -2.0_wp*w%g*w%l
      more = 2.0_wp*(w%g - lin%g_centre)
      v = traces(strain)
      s%of_whole = 2.0_wp*lin%g_centre
      s%of_loading = drag*x%turn%of_loading + more
      s%of_stress = drag*x%turn%of_stress
      associate (whole => changes%loading%whole, part => changes%loading%part, along => changes%loading%along)
         do j = 1, DIRECTIONS
            s%first(j) = drag*x%turn%first(j) + (2.0_wp*whole(1))*x%g(j) + more*along(j, 1)
            s%second(j) = drag*x%turn%second(j) + (2.0_wp*whole(2))*x%g(j) + more*along(j, 2)
            s%n(j) = drag*x%turn%n(j) - 2.0_wp*(w%l*x%g(j) + w%g*x%dl(j))
            s%r(j) = drag*x%turn%r(j)
            s%p(j) = drag*x%turn%p(j) + x%volumetric(j) - (w%l*w%d)*x%k_e(j) - w%k_e*x%flow(j) &
                     + (lin%whole_v - lin%d_v)*x%k(j) + w%k*(v(j) - x%v(j)) &
                     - (2.0_wp*(lin%whole_v*x%g(j) + lin%g_centre*v(j)) + more*x%v(j))*(1.0_wp/3.0_wp)
         end do   ! deviators
         if (lin%aside) then
            do j = 1, DIRECTIONS
               dg_less = 2.0_wp*(lin%g_centre_slopes(1)*x%share(j) + lin%g_centre_slopes(2)*changes%e(j) &
                                 + lin%g_centre_slopes(3)*changes%loading%of_volume(j) - x%g(j))
               s%first(j) = s%first(j) + (whole(1) - part(1))*dg_less
               s%second(j) = s%second(j) + (whole(2) - part(2))*dg_less
               s%p(j) = s%p(j) - ((lin%whole_v - lin%d_v)*dg_less)*(1.0_wp/3.0_wp)
            end do
         end if
      end associate
      call add_up(w, y, strain, centre, changes, s, rates)
   end subroutine fill_stress

   !> Changes of the rate of fabric: d z' = c_z (z_max n + z) d(L D) + c_z L D (z_max dn + dz).
   pure subroutine fill_fabric(par, w, y, strain, centre, changes, x, rates)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(tensors_t), intent(in) :: strain, centre
      type(changes_t), intent(in) :: changes
      type(inner_changes_t), intent(in) :: x
      real(wp), intent(out) :: rates(DIRECTIONS, 6)
      type(sum_t) :: s
      real(wp) :: turning, turned
      integer :: i, j

      turning = par%flow%c_z*w%l*w%d
      turned = turning*par%flow%z_max
      s%of_whole = 0.0_wp
      s%of_loading = turned*x%turn%of_loading
      s%of_stress = turned*x%turn%of_stress
      do j = 1, DIRECTIONS
         s%first(j) = turned*x%turn%first(j)
         s%second(j) = turned*x%turn%second(j)
         s%n(j) = turned*x%turn%n(j) + (par%flow%c_z*par%flow%z_max)*x%flow(j)
         s%r(j) = turned*x%turn%r(j)
         s%p(j) = turned*x%turn%p(j)
      end do
      call add_up(w, y, strain, centre, changes, s, rates)
      do j = 1, DIRECTIONS
         do i = 1, 6
            rates(j, i) = rates(j, i) + (par%flow%c_z*w%z(i))*x%flow(j) + turning*y(j, 6 + i)
         end do
      end do
   end subroutine fill_fabric

   !> The sum of what s says. strain and centre are the changes [-] that the loading refers to, y has those of stress.
   pure subroutine add_up(w, y, strain, centre, changes, s, total)
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: y(DIRECTIONS, NY)
      type(tensors_t), intent(in) :: strain, centre
      type(changes_t), intent(in) :: changes
      type(sum_t), intent(in) :: s
      real(wp), intent(out) :: total(DIRECTIONS, 6)
      integer :: i, j

      associate (loading => changes%loading, b => changes%loading%basis)
         do j = 1, DIRECTIONS
            do i = 1, 3
               total(j, i) = s%of_stress*y(j, i) + b(i, 1)*s%first(j) + b(i, 2)*s%second(j) + w%n(i)*s%n(j) &
                             + w%r(i)*s%r(j) + s%p(j)
            end do
            do i = 4, 6
               total(j, i) = s%of_stress*y(j, i) + b(i, 1)*s%first(j) + b(i, 2)*s%second(j) + w%n(i)*s%n(j) &
                             + w%r(i)*s%r(j)
            end do
         end do
         call add_loading(strain, centre, s%of_whole + s%of_loading*loading%of_strain, &
                          s%of_loading*loading%of_centre, total)
      end associate
   end subroutine add_up
end module mud_sensitivity
