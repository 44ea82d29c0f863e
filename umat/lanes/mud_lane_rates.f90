! SPDX-License-Identifier: MIT
!> Rates of several points side by side: what lanes are given, and give. The loops over them are mud_lane_loops.
module mud_lane_rates
   use mud_bonding, only: UNBONDED
   use mud_increment, only: increment_t, count_rate, turns
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: is_certain, MODE_ORDINARY
   use mud_state, only: counters_t
   use mud_tensor, only: deviator, norm, trace
   use mud_vector, only: NY, Y_Z, Y_Z_END, WIDTH
   implicit none (type, external)
   private
   public :: lanes_t, take_increment, load_increment, ask, load_state, give_rate, number

   !> Rates side by side; names and units as in rate_t and conditions_t.
   type :: lanes_t
      ! given of the increment
      real(wp), dimension(WIDTH, 6) :: d_strain, from_centre
      real(wp), dimension(WIDTH) :: e0, d_v, p_c0, d_pc, rho, exit, bonds
      ! given of the place
      real(wp), dimension(WIDTH, 6) :: sigma, z, r_in, n
      real(wp), dimension(WIDTH) :: time, turns, acts, active, known
      ! conditions
      real(wp), dimension(WIDTH, 6) :: strain, aside
      real(wp), dimension(WIDTH) :: e, volume_from_centre
      real(wp), dimension(WIDTH) :: bond_f, bond_df_dpc, bond_df_de, s_w, ds_dpc, ds_de, sat_share, log_sum, force_0, &
                                    force_1, force_2, bond_slope
      ! the point
      real(wp), dimension(WIDTH, 6) :: r, r_moved
      real(wp), dimension(WIDTH) :: p, r_norm, k, g, psi, m_b, m_d, b_0, weight, crowding, approach, f, f_slope, c, &
                                    share, a, b
      ! the drive and its arc
      real(wp), dimension(WIDTH, 6) :: t, n_t, q
      real(wp), dimension(WIDTH, 0:3) :: cubic
      real(wp), dimension(WIDTH) :: k_e, b_rate, volumetric, t_norm, r_t, r_q, x_t, x_q, z_t, z_q
      ! the search
      real(wp), dimension(WIDTH) :: side, lower, upper, u, previous, done
      ! the root and the rates
      real(wp), dimension(WIDTH) :: r_n, x, z_n, lode, r_b, r_d, a_d, d, h_b, beta, gamma, floored, capped_d, &
                                    capped_h, y, l, d_p, d_eps_q, fails, drive, first_drive, swell
      real(wp), dimension(WIDTH, 6) :: d_sigma, d_z
      ! the end of an update
      real(wp), dimension(WIDTH) :: suction, ends_bonded
   end type lanes_t
contains
   !> Lane j gets an increment.
   pure subroutine take_increment(j, inc, q)
      integer, intent(in) :: j
      type(increment_t), intent(in) :: inc
      type(lanes_t), intent(inout) :: q

      q%d_strain(j, :) = inc%d_strain
      q%from_centre(j, :) = inc%from_centre
      q%e0(j) = inc%e0
      q%d_v(j) = inc%d_v
      q%p_c0(j) = inc%p_c0
      q%d_pc(j) = inc%d_pc
      q%rho(j) = inc%rho
      q%exit(j) = inc%exit
      q%bonds(j) = number(inc%suction%bonds)
   end subroutine take_increment

   !> An increment with all that its void ratio, its strain that loads and its end are found of.
   pure subroutine load_increment(j, q, inc)
      integer, intent(in) :: j
      type(lanes_t), intent(in) :: q
      type(increment_t), intent(inout) :: inc

      inc%d_strain = q%d_strain(j, :)
      inc%from_centre = q%from_centre(j, :)
      inc%e0 = q%e0(j)
      inc%d_v = q%d_v(j)
      inc%exit = q%exit(j)
      inc%length = norm(inc%d_strain)
   end subroutine load_increment

   !> Lane j is asked for an ordinary rate of that increment, as rate_of is.
   pure subroutine ask(par, j, inc, time, y, r_in, q, near)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(increment_t), intent(in) :: inc   !< As take_increment had it, perhaps without its turn.
      real(wp), intent(in) :: time, y(NY), r_in(6)
      type(lanes_t), intent(inout) :: q
      type(rate_t), intent(in), optional :: near

      q%turns(j) = number(turns(inc, MODE_ORDINARY))
      q%acts(j) = number(.not. inc%rests)
      q%time(j) = time
      q%sigma(j, :) = y(1:6)
      q%z(j, :) = y(Y_Z:Y_Z_END)
      q%r_in(j, :) = r_in
      q%active(j) = 0.0_wp
      q%known(j) = 0.0_wp
      q%n(j, :) = 0.0_wp
      if (.not. present(near)) return
      q%known(j) = number(near%loading .and. .not. near%several)
      q%active(j) = number(near%iso_active .and. par%guesses_mechanism)
      q%n(j, :) = near%n
   end subroutine ask

   !> A mask [-]: 1 where true.
   pure elemental real(wp) function number(true)
      logical, intent(in) :: true

      number = merge(1.0_wp, 0.0_wp, true)
   end function number

   !> A rate with all that the direction equation reads.
   pure subroutine load_state(par, j, q, w)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(in) :: q
      type(rate_t), intent(out) :: w

      w%p = q%p(j)
      w%r = q%r(j, :)
      w%r_norm = q%r_norm(j)
      w%r_moved = q%r_moved(j, :)
      w%z = q%z(j, :)
      w%k = q%k(j)
      w%g = q%g(j)
      w%m_b = q%m_b(j)
      w%m_d = q%m_d(j)
      w%a_0 = par%flow%a_0
      w%b_0 = q%b_0(j)
      w%own%bends = .false.
      w%iso%a = q%a(j)
      w%iso%b = q%b(j)
      w%k_e = q%k_e(j)
      w%t_norm = q%t_norm(j)
   end subroutine load_state

   !> The rate of lane j as rate_of leaves it, if the lane knows.
   pure subroutine give_rate(par, j, with_mechanism, q, w, counters, known)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      logical, intent(in) :: with_mechanism   !< It acts in the rate nearby.
      type(lanes_t), intent(in) :: q
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters
      logical, intent(out) :: known
      real(wp) :: strain(6)

      known = q%fails(j) < 0.5_wp
      if (.not. known) return
      call load_state(par, j, q, w)
      w%bond = UNBONDED
      if (q%bonds(j) > 0.5_wp) then
         w%bond%f = q%bond_f(j)
         w%bond%df_dpc = q%bond_df_dpc(j)
         w%bond%df_de = q%bond_df_de(j)
         w%bond%sat%s_w = q%s_w(j)
         w%bond%sat%ds_dpc = q%ds_dpc(j)
         w%bond%sat%ds_de = q%ds_de(j)
         w%bond%sat%share = q%sat_share(j)
         w%bond%sat%log_sum = q%log_sum(j)
         w%bond%force_0 = q%force_0(j)
         w%bond%force_1 = q%force_1(j)
         w%bond%force_2 = q%force_2(j)
         w%bond%slope = q%bond_slope(j)
      end if
      w%psi = q%psi(j)
      w%iso%weight = q%weight(j)
      w%iso%crowding = q%crowding(j)
      w%iso%approach = q%approach(j)
      w%iso%f = q%f(j)
      w%iso%f_slope = q%f_slope(j)
      w%iso%c = q%c(j)
      w%iso%share = q%share(j)
      w%iso%floored = .false.
      w%loading = .true.
      w%iso_active = q%active(j) > 0.5_wp
      w%b_rate = q%b_rate(j)
      w%t = q%t(j, :)
      w%n = q%n(j, :)
      w%y = q%y(j)
      w%l = q%l(j)
      w%iso_kept = .false.
      w%no_root = .false.
      w%several = .false.
      w%r_n = q%r_n(j)
      w%x = q%x(j)
      w%z_n = q%z_n(j)
      w%lode = q%lode(j)
      w%r_b = q%r_b(j)
      w%r_d = q%r_d(j)
      w%a_d = q%a_d(j)
      w%d = q%d(j)
      w%h_b = q%h_b(j)
      w%beta = q%beta(j)
      w%gamma = q%gamma(j)
      w%floored = q%floored(j) > 0.5_wp
      w%capped_d = q%capped_d(j) > 0.5_wp
      w%capped_h = q%capped_h(j) > 0.5_wp
      w%d_p = q%d_p(j)
      w%d_eps_q = q%d_eps_q(j)
      w%d_sigma = q%d_sigma(j, :)
      w%d_z = q%d_z(j, :)
      w%d_own = 0.0_wp
      w%iso_drive = q%first_drive(j)
      w%swell = q%swell(j)
      if (with_mechanism .and. par%guesses_mechanism) then
         ! the sign of the drive without the mechanism is not known for certain: solved in its order
         strain = q%strain(j, :)
         known = w%iso_drive > 0.0_wp
         if (known) known = is_certain(par, trace(strain), deviator(strain), w)
      end if
      if (known) call count_rate(par, w, counters)
   end subroutine give_rate
end module mud_lane_rates
