! SPDX-License-Identifier: MIT
!> Rates of several points side by side: loops over the procedures of one rate, which the compiler turns into vectors.
!> No equation is written here. Masks are numbers, 1 where true, because gfortran has no vectors of logicals.
!>
!> A lane that the loops cannot answer for certain - several roots, a mechanism that contradicts itself - says so.
module mud_lane_loops
   use, intrinsic :: iso_c_binding, only: c_ptr, c_f_pointer
   use mud_bonding, only: suction_law_t, bonding_t, bonding_at
   use mud_arc, only: arc_t, arc_through
   use mud_critical_state, only: state_parameter
   use mud_direction, only: angle_t, bracket_t, PARALLEL, MAX_ITERATIONS, ALONE, half_tangent, first_guess, vanishes, &
      narrow, is_narrow, advance, evaluate_direction, slope_of_residual, company_of
   use mud_direction_equation, only: equation_of
   use mud_elastic, only: elastic_moduli
   use mud_increment, only: increment_t, loading_strain, void_ratio_at, add_aside, end_of_pull
   use mud_kinds, only: wp
   use mud_lane_rates, only: lanes_t, load_increment, load_state, number
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: conditions_t, stress_ratio, evaluate_point, weight_at, hardening_at, find_drive, finish_rate, &
      MODE_ORDINARY
   use mud_retention, only: saturation_t, curve_saturation
   use mud_tensor, only: deviator, norm, trace
   use mud_vector, only: WIDTH
   implicit none (type, external)
   private
   public :: mud_find_rates, mud_find_ends
contains
   !> The rates of all lanes, lanes_t, of a material, params_t.
   subroutine mud_find_rates(material, lanes) bind(c)
      type(c_ptr), value :: material, lanes
      type(params_t), pointer :: par
      type(lanes_t), pointer :: q

      call c_f_pointer(material, par)
      call c_f_pointer(lanes, q)
      call find_rates(par, q)
   end subroutine mud_find_rates

   !> The ends of the updates of all lanes, likewise.
   subroutine mud_find_ends(material, lanes) bind(c)
      type(c_ptr), value :: material, lanes
      type(params_t), pointer :: par
      type(lanes_t), pointer :: q

      call c_f_pointer(material, par)
      call c_f_pointer(lanes, q)
      call find_ends(par, q)
   end subroutine mud_find_ends

   !> State parameter, saturation, elastic moduli and strain from the centre of the elastic domain where updates end.
   subroutine find_ends(par, q)
      type(params_t), intent(in) :: par
      type(lanes_t), intent(inout) :: q
      type(suction_law_t) :: law
      integer :: j

      law = par%suction
      if (any(max(q%suction, q%ends_bonded) > 0.0_wp)) then
         !$omp simd
         do j = 1, WIDTH
            call find_saturation(law, j, q)
         end do
      else
         call find_saturation(law, 1, q)   ! all are the same
         q%s_w = q%s_w(1)
         q%ds_dpc = q%ds_dpc(1)
         q%ds_de = q%ds_de(1)
         q%bond_f = q%bond_f(1)
      end if
      !$omp simd
      do j = 1, WIDTH
         call find_end(par, j, q)
      end do
   end subroutine find_ends

   !> Saturation and bonding where an update ends.
   pure subroutine find_saturation(law, j, q)
      type(suction_law_t), intent(in) :: law
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(saturation_t) :: sat
      type(bonding_t) :: bond

      sat = curve_saturation(law%retention_t, q%suction(j), q%e(j))
      bond = bonding_at(law, sat, q%suction(j))
      q%s_w(j) = sat%s_w
      q%ds_dpc(j) = sat%ds_dpc
      q%ds_de(j) = sat%ds_de
      q%bond_f(j) = merge(bond%f, 1.0_wp, q%ends_bonded(j) > 0.5_wp)
   end subroutine find_saturation

   !> State parameter, strain from the centre of the elastic domain and elastic moduli where an update ends.
   pure subroutine find_end(par, j, q)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(increment_t) :: inc
      real(wp) :: sigma(6), from_centre(6), p, r(6), pulls

      sigma = q%sigma(j, :)
      call stress_ratio(par, sigma, p, r)
      q%psi(j) = state_parameter(par%critical, q%bond_f(j), q%e(j), p)
      call load_increment(j, q, inc)
      pulls = number(q%exit(j) < 1.0_wp)
      inc%rho = merge(q%rho(j), 1.0_wp, pulls > 0.5_wp)
      from_centre = end_of_pull(inc)
      from_centre = merge(from_centre, q%strain(j, :), pulls > 0.5_wp)
      q%strain(j, :) = from_centre
      call elastic_moduli(par%elastic, q%e(j), p, trace(from_centre), q%k(j), q%g(j))
   end subroutine find_end

   !> The rates of all lanes.
   subroutine find_rates(par, q)
      type(params_t), intent(in) :: par
      type(lanes_t), intent(inout) :: q
      type(suction_law_t) :: law
      real(wp) :: known(WIDTH), n(WIDTH, 6), again(WIDTH)
      integer :: j, pass

      !$omp simd
      do j = 1, WIDTH
         call find_strain(j, q)
      end do
      q%bond_f = 1.0_wp
      q%bond_df_dpc = 0.0_wp
      q%bond_df_de = 0.0_wp
      if (any(q%bonds > 0.5_wp)) then
         law = par%suction   ! of a local variable the compiler knows that it may be read without asking
         !$omp simd
         do j = 1, WIDTH
            call find_bonding(law, j, q)
         end do
      end if
      !$omp simd
      do j = 1, WIDTH
         call find_state(par, j, q)
      end do
      known = q%known
      n = q%n
      do pass = 1, 2   ! one call: of two the compiler makes copies that round in their own ways
         call solve(par, q)
         if (pass == 2) exit
         q%first_drive = q%drive
         q%swell = max(-q%l*q%d, 0.0_wp)
         again = number(q%drive > 0.0_wp .and. q%active < 0.5_wp)
         if (all(again < 0.5_wp)) exit
         q%active = max(q%active, again)
         ! the others find again what they found, from where they began: no lane depends on those beside it
         q%known = merge(1.0_wp, known, again > 0.5_wp)
         do j = 1, 6
            q%n(:, j) = merge(q%n(:, j), n(:, j), again > 0.5_wp)
         end do
      end do
      q%fails = max(q%fails, number(q%active > 0.5_wp .and. q%drive < 0.0_wp))
      if (all(q%turns < 0.5_wp)) return
      !$omp simd
      do j = 1, WIDTH
         call add_rest(par, j, q)
      end do
   end subroutine find_rates

   !> Void ratio, and how the strain loads.
   pure subroutine find_strain(j, q)
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(increment_t) :: inc
      real(wp) :: loading(6), aside(6), from_centre

      call load_increment(j, q, inc)
      inc%rho = merge(q%rho(j), 1.0_wp, q%turns(j) > 0.5_wp)
      call loading_strain(inc, MODE_ORDINARY, q%time(j), loading, aside, from_centre)
      q%strain(j, :) = merge(loading, inc%d_strain, q%turns(j) > 0.5_wp)
      q%aside(j, :) = aside
      q%volume_from_centre(j) = from_centre
      q%e(j) = void_ratio_at(inc, q%time(j))
   end subroutine find_strain

   !> Bonding where it acts.
   pure subroutine find_bonding(law, j, q)
      type(suction_law_t), intent(in) :: law
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(bonding_t) :: bond
      real(wp) :: p_c

      p_c = q%p_c0(j) + q%time(j)*q%d_pc(j)
      bond = bonding_at(law, curve_saturation(law%retention_t, p_c, q%e(j)), p_c)
      q%bond_f(j) = merge(bond%f, 1.0_wp, q%bonds(j) > 0.5_wp)
      q%bond_df_dpc(j) = merge(bond%df_dpc, 0.0_wp, q%bonds(j) > 0.5_wp)
      q%bond_df_de(j) = merge(bond%df_de, 0.0_wp, q%bonds(j) > 0.5_wp)
      q%s_w(j) = bond%sat%s_w
      q%ds_dpc(j) = bond%sat%ds_dpc
      q%ds_de(j) = bond%sat%ds_de
      q%sat_share(j) = bond%sat%share
      q%log_sum(j) = bond%sat%log_sum
      q%force_0(j) = bond%force_0
      q%force_1(j) = bond%force_1
      q%force_2(j) = bond%force_2
      q%bond_slope(j) = bond%slope
   end subroutine find_bonding

   !> The elastic rest of a strain that turns.
   pure subroutine add_rest(par, j, q)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(rate_t) :: w
      real(wp) :: aside(6)

      w%k = q%k(j)
      w%d_p = q%d_p(j)
      w%d_sigma = q%d_sigma(j, :)
      aside = q%aside(j, :)
      call add_aside(par, q%e(j), aside, q%volume_from_centre(j), w)
      q%d_p(j) = merge(w%d_p, q%d_p(j), q%turns(j) > 0.5_wp)
      q%d_sigma(j, :) = merge(w%d_sigma, q%d_sigma(j, :), q%turns(j) > 0.5_wp)
   end subroutine add_rest

   !> All that depends on the state alone.
   pure subroutine find_state(par, j, q)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(conditions_t) :: at
      type(rate_t) :: w

      at%e = q%e(j)
      at%r_in = q%r_in(j, :)
      at%bond%f = q%bond_f(j)
      at%bond%df_dpc = q%bond_df_dpc(j)
      at%bond%df_de = q%bond_df_de(j)
      call evaluate_point(par, at, q%sigma(j, :), q%z(j, :), w)
      w%iso = hardening_at(par, at%e, q%acts(j)*weight_at(par, w), w)
      q%r(j, :) = w%r
      q%r_moved(j, :) = w%r_moved
      q%p(j) = w%p
      q%r_norm(j) = w%r_norm
      q%k(j) = w%k
      q%g(j) = w%g
      q%psi(j) = w%psi
      q%m_b(j) = w%m_b
      q%m_d(j) = w%m_d
      q%b_0(j) = w%b_0
      q%a(j) = w%iso%a
      q%b(j) = w%iso%b
      q%weight(j) = w%iso%weight
      q%crowding(j) = w%iso%crowding
      q%approach(j) = w%iso%approach
      q%f(j) = w%iso%f
      q%f_slope(j) = w%iso%f_slope
      q%c(j) = w%iso%c
      q%share(j) = w%iso%share
   end subroutine find_state

   !> Loading indices and directions with the isotropic mechanism where it is active.
   subroutine solve(par, q)
      type(params_t), intent(in) :: par
      type(lanes_t), intent(inout) :: q
      integer :: j, iteration

      !$omp simd
      do j = 1, WIDTH
         call begin_search(par, j, q)
      end do
      do iteration = 1, MAX_ITERATIONS
         !$omp simd
         do j = 1, WIDTH
            call try_angle(par, j, q)
         end do
         if (all(q%done > 0.5_wp)) exit
      end do
      !$omp simd
      do j = 1, WIDTH
         call take_root(par, j, q)
      end do
   end subroutine solve

   !> The drive, the arc, the side of the root and a first guess.
   pure subroutine begin_search(par, j, q)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(rate_t) :: w
      type(arc_t) :: arc
      type(angle_t) :: at
      real(wp) :: volumetric, strain(6), n(6), n_t(6), other(6), side, guess
      logical :: shears

      call load_state(par, j, q, w)
      strain = q%strain(j, :)
      call find_drive(trace(strain), deviator(strain), norm(strain), q%d_pc(j), q%active(j) > 0.5_wp, w, volumetric, &
                      shears)
      n_t = w%t/w%t_norm
      call arc_through(w%r, w%r_moved, w%z, n_t, PARALLEL*max(w%r_norm, 1.0e-3_wp), arc, other)
      call evaluate_direction(par, equation_of(par, w), arc, 0.0_wp, w%moduli_t, at)
      side = sign(1.0_wp, w%beta)
      n = q%n(j, :)
      guess = merge(side*half_tangent(n, n_t, other), -1.0_wp, q%known(j) > 0.5_wp)
      q%u(j) = merge(guess, first_guess(arc, w), guess > 0.0_wp .and. guess < 1.0_wp)
      q%side(j) = side
      q%lower(j) = 0.0_wp
      q%upper(j) = 1.0_wp
      q%previous(j) = 1.0_wp
      q%fails(j) = number(.not. shears)
      q%k_e(j) = w%k_e
      q%b_rate(j) = w%b_rate
      q%volumetric(j) = volumetric
      q%t(j, :) = w%t
      q%t_norm(j) = w%t_norm
      q%n_t(j, :) = n_t
      q%q(j, :) = other
      q%r_t(j) = arc%r_t
      q%r_q(j) = arc%r_q
      q%x_t(j) = arc%x_t
      q%x_q(j) = arc%x_q
      q%z_t(j) = arc%z_t
      q%z_q(j) = arc%z_q
      q%cubic(j, :) = arc%cubic
   end subroutine begin_search

   !> One iteration of Newton's method; a lane that is done stays.
   pure subroutine try_angle(par, j, q)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(rate_t) :: w
      type(arc_t) :: arc
      type(angle_t) :: at
      type(bracket_t) :: bracket
      real(wp) :: done

      call load_state(par, j, q, w)
      call load_arc(j, q, arc)
      bracket = bracket_t(q%lower(j), q%upper(j), q%u(j), q%previous(j))
      call evaluate_direction(par, equation_of(par, w), arc, q%side(j)*bracket%u, w%moduli_t, at)
      call narrow(q%side(j), at, bracket)
      done = max(number(vanishes(at)), number(is_narrow(bracket)))
      call advance(q%side(j)*at%residual, slope_of_residual(par, arc, w, at), bracket)
      q%lower(j) = bracket%lower
      q%upper(j) = bracket%upper
      q%previous(j) = bracket%previous
      q%u(j) = merge(q%u(j), bracket%u, done > 0.5_wp)
      q%done(j) = done
   end subroutine try_angle

   !> The rates at the root.
   pure subroutine take_root(par, j, q)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(inout) :: q
      type(rate_t) :: w
      type(arc_t) :: arc
      type(angle_t) :: at
      real(wp) :: alone, strain(6)

      call load_state(par, j, q, w)
      call load_arc(j, q, arc)
      call evaluate_direction(par, equation_of(par, w), arc, q%side(j)*q%u(j), w%moduli_t, at)
      alone = real(company_of(par, arc, q%side(j), at, w), wp)
      w%n = at%cosine*q%n_t(j, :) + at%sine*q%q(j, :)
      w%y = at%admissible/w%t_norm
      w%l = w%h_b/w%y
      w%d_p = q%volumetric(j) - w%k_e*w%l*w%d
      strain = q%strain(j, :)
      call finish_rate(par, deviator(strain), w)
      q%fails(j) = max(q%fails(j), number(alone < 0.5_wp), number(w%y <= 0.0_wp))
      q%drive(j) = w%iso%a*w%d_p/w%p + merge(q%b_rate(j), w%iso%b*q%d_pc(j), q%active(j) > 0.5_wp)
      q%n(j, :) = w%n
      q%known(j) = 1.0_wp
      q%r_n(j) = w%r_n
      q%x(j) = w%x
      q%z_n(j) = w%z_n
      q%lode(j) = w%lode
      q%r_b(j) = w%r_b
      q%r_d(j) = w%r_d
      q%a_d(j) = w%a_d
      q%d(j) = w%d
      q%h_b(j) = w%h_b
      q%beta(j) = w%beta
      q%gamma(j) = w%gamma
      q%floored(j) = number(w%floored)
      q%capped_d(j) = number(w%capped_d)
      q%capped_h(j) = number(w%capped_h)
      q%y(j) = w%y
      q%l(j) = w%l
      q%d_p(j) = w%d_p
      q%d_eps_q(j) = w%d_eps_q
      q%d_sigma(j, :) = w%d_sigma
      q%d_z(j, :) = w%d_z
   end subroutine take_root

   pure subroutine load_arc(j, q, arc)
      integer, intent(in) :: j
      type(lanes_t), intent(in) :: q
      type(arc_t), intent(out) :: arc

      arc%r_t = q%r_t(j)
      arc%r_q = q%r_q(j)
      arc%x_t = q%x_t(j)
      arc%x_q = q%x_q(j)
      arc%z_t = q%z_t(j)
      arc%z_q = q%z_q(j)
      arc%cubic = q%cubic(j, :)
   end subroutine load_arc
end module mud_lane_loops
