! SPDX-License-Identifier: MIT
!> Increments of several points side by side: they go from rate to rate together, and the rates are found side by side.
!> Every decision is that of one point alone, made by the same procedures.
module mud_lanes
   use, intrinsic :: iso_c_binding, only: c_ptr, c_loc
   use mud_blocks, only: blocks_t, elastic_blocks, blocks_of_moduli
   use mud_bonding, only: is_bonded
   use mud_consistent, only: sensitivity_t, no_sensitivity
   use mud_event, only: EVENT_NONE
   use mud_follow, only: follow_phase, follow_substep
   use mud_increment, only: increment_t, rate_of, take_phase, end_in_domain
   use mud_integration, only: integration_t
   use mud_kinds, only: wp
   use mud_lane_rates, only: lanes_t, take_increment, ask, give_rate, number
   use mud_mechanism, only: begin_mechanism
   use mud_order, only: look_for_stiffness
   use mud_params, only: params_t
   use mud_phases, only: cut_t, list_cuts, MAX_CUTS
   use mud_point, only: update_point, begin_update, end_update, end_way, end_saturation, give_tangent, &
      TANGENT_NONE, TANGENT_CONSISTENT
   use mud_rate, only: rate_t
   use mud_rates, only: MODE_ORDINARY
   use mud_registry, only: NSTATV_BASE
   use mud_retention, only: course_t, saturation_t
   use mud_start, only: finish_state
   use mud_state, only: state_t, counters_t, statev_size
   use mud_status, only: MUD_OK
   use mud_stiff_direction, only: make_implicit
   use mud_substepping, only: stepping_t, begin_phase, try_substep, plan_attempt, judge, end_substep, end_phase
   use mud_transient, only: begin_transient, take_far, take_half, half_way, without_turn
   use mud_transitions, only: take_last_rate, begin_substep
   use mud_trial, only: begin_stage, end_stage, end_stages
   use mud_vector, only: NY, Y_Z, Y_Z_END, WIDTH
   implicit none (type, external)
   private
   public :: fits_lanes, update_side_by_side

   interface
      subroutine mud_find_rates(material, lanes) bind(c)
         import :: c_ptr
         type(c_ptr), value :: material, lanes
      end subroutine mud_find_rates

      subroutine mud_find_ends(material, lanes) bind(c)
         import :: c_ptr
         type(c_ptr), value :: material, lanes
      end subroutine mud_find_ends
   end interface

   !> A point on its way, beside its integration.
   type :: point_t
      logical :: together      !< It is one of those that go side by side ...
      logical :: tries         !< ... and its attempt is made side by side.
      logical :: ended
      logical :: asks          !< It waits for a rate.
      integer :: phases, phase
      integer :: depth         !< Number of interrupted processes where the increment began.
      logical :: goes_on       !< The first substep did not end the update.
      real(wp) :: h, time
      type(cut_t) :: cuts(MAX_CUTS)
      type(stepping_t) :: step
      type(sensitivity_t) :: sens   !< Complete where the update goes on; otherwise derivatives of the stress alone.
   end type point_t
contains
   !> True of a material whose rates the lanes know.
   pure logical function fits_lanes(par)
      type(params_t), intent(in), target :: par

      fits_lanes = par%isotropic .and. par%floored .and. min(par%cap_d, par%cap_h) > 0.0_wp .and. &
                   statev_size(par%options_t) <= NSTATV_BASE   ! no option adds a number to the state
   end function fits_lanes

   !> update_point for each of n points.
   subroutine update_side_by_side(par, n, d_strain, d_pc, tangent, it, blocks)
      type(params_t), intent(in), target :: par
      integer, intent(in) :: n
      real(wp), intent(in) :: d_strain(6, WIDTH), d_pc(WIDTH)
      integer, intent(in) :: tangent
      type(integration_t), intent(inout) :: it(WIDTH)
      type(blocks_t), intent(inout) :: blocks(WIDTH)
      type(point_t) :: of(WIDTH)
      type(lanes_t), target :: q
      type(course_t) :: course   !< No material that fits has hysteresis: one serves every point.
      integer :: j
      logical :: follows, ends(WIDTH)

      follows = tangent == TANGENT_CONSISTENT
      call empty(par, q)
      of%together = .false.
      do j = 1, n
         if (it(j)%status%code /= MUD_OK) cycle
         call begin_update(par, d_strain(:, j), d_pc(j), it(j), course)
         if (it(j)%status%code /= MUD_OK) cycle
         of(j)%phases = 0
         of(j)%phase = 1
         if (it(j)%size > 0.0_wp) call list_cuts(par, it(j)%inc, course, of(j)%cuts, of(j)%phases)
         of(j)%together = of(j)%phases > 0
         if (.not. of(j)%together) then
            call end_update(par, tangent, .false., course, it(j), of(j)%sens, blocks(j))
            cycle
         end if
         of(j)%depth = it(j)%state%memory%depth
         of(j)%goes_on = .false.
         call next_phase(par, follows, it(j), of(j))
      end do
      do while (any(of(1:n)%together))
         call take_substeps(par, n, follows, it, of, q)
         ends = .false.
         do j = 1, n
            if (.not. of(j)%together) cycle
            if (it(j)%status%code /= MUD_OK) of(j)%together = .false.
            if (.not. of(j)%together .or. it(j)%reached < it(j)%inc%to) cycle
            call end_phase(of(j)%step, it(j))
            if (of(j)%phase < of(j)%phases) then
               of(j)%phase = of(j)%phase + 1
               call next_phase(par, follows, it(j), of(j))
               cycle
            end if
            of(j)%together = .false.
            ends(j) = .true.
         end do
         if (any(ends)) call end_updates(par, ends, tangent, course, it, of, blocks, q)
      end do
   end subroutine update_side_by_side

   !> end_update and the tangents of the points that are at their ends.
   subroutine end_updates(par, ends, tangent, course, it, of, blocks, q)
      type(params_t), intent(in), target :: par
      logical, intent(in) :: ends(WIDTH)
      integer, intent(in) :: tangent
      type(course_t), intent(in) :: course
      type(integration_t), intent(inout) :: it(WIDTH)
      type(point_t), intent(in) :: of(WIDTH)
      type(blocks_t), intent(inout) :: blocks(WIDTH)
      type(lanes_t), intent(inout), target :: q
      type(saturation_t) :: sat
      real(wp) :: with_turn(2)
      integer :: j

      do j = 1, WIDTH
         if (.not. ends(j)) cycle
         call end_way(par, course, it(j), with_turn)
         call take_end(par, j, it(j)%inc, it(j)%state, q)
      end do
      call mud_find_ends(c_loc(par), c_loc(q))
      with_turn = 0.0_wp   ! no hysteresis
      do j = 1, WIDTH
         if (.not. ends(j)) cycle
         call give_end(par, j, q, it(j)%state, sat)
         if (it(j)%state%gap > 0.0_wp) then
            call finish_state(par, it(j)%inc%suction, it(j)%state, sat)
            if (tangent /= TANGENT_NONE) call elastic_blocks(par, it(j)%state, blocks(j))
         else if (tangent /= TANGENT_NONE) then
            call blocks_of_moduli(q%k(j), q%g(j), blocks(j))
         end if
         call end_saturation(sat, with_turn, it(j), blocks(j))
         call give_tangent(par, tangent, .true., it(j), of(j)%sens, blocks(j))
      end do
   end subroutine end_updates

   !> Lane j is asked for what finish_state finds of a state without a gap where its increment ends, for the elastic
   !> moduli and the strain from the centre of the elastic domain.
   pure subroutine take_end(par, j, inc, state, q)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(increment_t), intent(in) :: inc   !< As take_increment had it.
      type(state_t), intent(in) :: state
      type(lanes_t), intent(inout) :: q

      q%sigma(j, :) = state%sigma
      q%e(j) = state%e
      q%suction(j) = state%p_c
      q%ends_bonded(j) = number(is_bonded(par%suction, state%p_c))
      if (inc%exit < 1.0_wp) return   ! the lane finds the strain from the centre
      q%strain(j, :) = 0.0_wp
      if (inc%rho > 0.0_wp) q%strain(j, :) = end_in_domain(inc)
   end subroutine take_end

   !> A state gets its end from lane j.
   pure subroutine give_end(par, j, q, state, sat)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(lanes_t), intent(in) :: q
      type(state_t), intent(inout) :: state
      type(saturation_t), intent(out) :: sat

      sat%s_w = q%s_w(j)
      sat%ds_dpc = q%ds_dpc(j)
      sat%ds_de = q%ds_de(j)
      state%s_w = sat%s_w
      state%psi = q%psi(j)
      if (par%rho_e > 0.0_wp) state%from_centre = q%strain(j, :)
   end subroutine give_end

   pure subroutine next_phase(par, follows, it, of)
      type(params_t), intent(in), target :: par
      logical, intent(in) :: follows
      type(integration_t), intent(inout) :: it
      type(point_t), intent(inout) :: of

      call take_phase(par, it%reached, of%cuts(of%phase)%time, it%inc)
      call begin_phase(par, of%step, it)
      if (follows .and. of%goes_on) call follow_phase(par, it%inc, of%cuts(of%phase), of%sens)
   end subroutine next_phase

   !> Derivatives follow a substep of a point. Most updates have one substep: then they stay in `near`, which the
   !> processor has near when the next point uses it.
   pure subroutine follow(par, it, of, near)
      type(params_t), intent(in) :: par
      type(integration_t), intent(in) :: it
      type(point_t), intent(inout) :: of
      type(sensitivity_t), intent(inout) :: near

      if (of%goes_on) then
         call follow_substep(par, it, of%h, of%sens)
         return
      end if
      call no_sensitivity(of%depth, it%inc, near)
      call follow_phase(par, it%inc, of%cuts(1), near)
      call follow_substep(par, it, of%h, near)
      of%goes_on = of%phase < of%phases .or. it%reached < it%inc%to
      if (of%goes_on) then
         of%sens = near
      else
         of%sens%y(:, 1:6) = near%y(:, 1:6)
      end if
   end subroutine follow

   !> One substep of every point that is not at its end.
   subroutine take_substeps(par, n, follows, it, of, q)
      type(params_t), intent(in), target :: par
      integer, intent(in) :: n
      logical, intent(in) :: follows
      type(integration_t), intent(inout) :: it(WIDTH)
      type(point_t), intent(inout) :: of(WIDTH)
      type(lanes_t), intent(inout), target :: q
      type(sensitivity_t) :: near
      real(wp) :: y(NY)
      integer :: i, j, stages
      logical :: stiff

      y = 0.0_wp
      do j = 1, n
         of(j)%asks = .false.
         if (.not. of(j)%together) cycle
         call take_last_rate(it(j))
         call begin_mechanism(par, it(j)%state, it(j)%inc, it(j)%trial, it(j)%known)
         call take_increment(j, it(j)%inc, q)
         ! rates of one point placed an event, and they alone are sure to be on the same side of it
         of(j)%asks = .not. (it(j)%known .or. it(j)%state%open .or. it(j)%inc%inside .or. it(j)%trial%drifts .or. &
                             it(j)%event /= EVENT_NONE)
         if (.not. of(j)%asks) cycle
         y(1:6) = it(j)%state%sigma
         y(Y_Z:Y_Z_END) = it(j)%state%z
         call ask(par, j, it(j)%inc, it(j)%reached, y, it(j)%state%memory%r_in, q)
      end do
      if (any(of(1:n)%asks)) then
         call find_rates(par, q)
         do j = 1, n
            if (of(j)%asks) call give_rate(par, j, .false., q, it(j)%trial%w(1), it(j)%counters, it(j)%known)
         end do
      end if
      do j = 1, n
         of(j)%tries = .false.
         if (.not. of(j)%together) cycle
         call begin_substep(par, it(j))
         call look_for_stiffness(par, it(j)%inc%to - it(j)%reached, max(of(j)%step%h, par%h_min), it(j)%trial, stiff)
         if (stiff) call make_implicit(par, it(j)%inc, it(j)%trial)
         of(j)%tries = it(j)%trial%mode == MODE_ORDINARY .and. it(j)%trial%relaxation%speed <= 0.0_wp
         if (.not. of(j)%tries) then
            call try_substep(par, of(j)%step, of(j)%h, it(j))
            cycle
         end if
         call plan_attempt(par, of(j)%step, of(j)%h, it(j))
         of(j)%tries = it(j)%status%code == MUD_OK
      end do
      call find_transients(par, n, it, of, q)
      stages = 0
      do j = 1, n
         if (.not. of(j)%tries) cycle
         it(j)%trial%closed = .false.
         call end_stage(1, it(j)%trial%time, of(j)%h, it(j)%trial)
         stages = max(stages, it(j)%inc%scheme%stages)
      end do
      do i = 2, stages
         do j = 1, n
            of(j)%asks = of(j)%tries
            if (of(j)%asks) of(j)%asks = i <= it(j)%inc%scheme%stages
            if (.not. of(j)%asks) cycle
            call begin_stage(it(j)%inc, i, of(j)%h, it(j)%trial, of(j)%time)
            call ask(par, j, it(j)%inc, of(j)%time, it(j)%trial%points(:, i), it(j)%trial%r_in, q, it(j)%trial%w(1))
         end do
         call find_rates(par, q)
         do j = 1, n
            if (.not. of(j)%asks) cycle
            call answer(par, j, it(j)%inc, of(j)%time, it(j)%trial%points(:, i), it(j)%trial%r_in, q, &
                        it(j)%trial%w(1), it(j)%trial%w(i), it(j)%counters)
            call end_stage(i, of(j)%time, of(j)%h, it(j)%trial)
         end do
      end do
      do j = 1, n
         if (of(j)%tries) then
            call end_stages(it(j)%inc, of(j)%h, it(j)%trial)
            call judge(par, of(j)%h, of(j)%step, it(j), of(j)%ended)
            if (.not. of(j)%ended) call try_substep(par, of(j)%step, of(j)%h, it(j))
         end if
         if (.not. of(j)%together .or. it(j)%status%code /= MUD_OK) cycle
         call end_substep(par, of(j)%step, of(j)%h, it(j))
      end do
      if (.not. follows) return
      ! A loop of its own: the instructions of both together do not fit into the memory that is nearest.
      do j = 1, n
         if (of(j)%together .and. it(j)%status%code == MUD_OK) call follow(par, it(j), of(j), near)
      end do
   end subroutine take_substeps

   !> Parts that fade, as find_transient has them.
   subroutine find_transients(par, n, it, of, q)
      type(params_t), intent(in), target :: par
      integer, intent(in) :: n
      type(integration_t), intent(inout) :: it(WIDTH)
      type(point_t), intent(inout) :: of(WIDTH)
      type(lanes_t), intent(inout) :: q
      integer :: j

      do j = 1, n
         of(j)%asks = .false.
         if (.not. of(j)%tries) cycle
         associate (trial => it(j)%trial)
            call begin_transient(it(j)%inc, trial%time, of(j)%h, trial%w(1), trial%transient, of(j)%asks)
            if (of(j)%asks) call ask(par, j, without_turn(it(j)%inc), trial%time, trial%y0, trial%r_in, q, trial%w(1))
         end associate
      end do
      if (.not. any(of(1:n)%asks)) return
      call find_rates(par, q)
      do j = 1, n
         if (.not. of(j)%asks) cycle
         associate (trial => it(j)%trial)
            call answer(par, j, without_turn(it(j)%inc), trial%time, trial%y0, trial%r_in, q, trial%w(1), &
                        trial%transient%far, it(j)%counters)
            call take_far(par, it(j)%inc, trial%y0, trial%w(1), trial%transient, of(j)%asks)
            if (of(j)%asks) call ask(par, j, it(j)%inc, half_way(trial%transient), trial%y0, trial%r_in, q, trial%w(1))
         end associate
      end do
      if (.not. any(of(1:n)%asks)) return
      call find_rates(par, q)
      do j = 1, n
         if (.not. of(j)%asks) cycle
         associate (trial => it(j)%trial)
            call answer(par, j, it(j)%inc, half_way(trial%transient), trial%y0, trial%r_in, q, trial%w(1), &
                        trial%transient%half, it(j)%counters)
            call take_half(trial%w(1), trial%transient)
         end associate
      end do
   end subroutine find_transients

   !> The rate that lane j was asked for; where it does not know, that of one point alone.
   pure subroutine answer(par, j, inc, time, y, r_in, q, near, w, counters)
      type(params_t), intent(in) :: par
      integer, intent(in) :: j
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, y(NY), r_in(6)
      type(lanes_t), intent(in) :: q
      type(rate_t), intent(in) :: near
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters
      logical :: known

      call give_rate(par, j, near%iso_active, q, w, counters, known)
      if (.not. known) call rate_of(par, inc, time, y, r_in, MODE_ORDINARY, w, counters, near)
   end subroutine answer

   !> The rates of all lanes.
   subroutine find_rates(par, q)
      type(params_t), intent(in), target :: par
      type(lanes_t), intent(inout), target :: q

      call mud_find_rates(c_loc(par), c_loc(q))
   end subroutine find_rates

   !> Lanes without a point have one that makes no trouble.
   pure subroutine empty(par, q)
      type(params_t), intent(in) :: par
      type(lanes_t), intent(out) :: q
      type(increment_t) :: inc
      real(wp), parameter :: AXIAL(6) = [2.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
      real(wp) :: y(NY)
      integer :: j

      inc%d_strain = 1.0e-5_wp*AXIAL
      inc%from_centre = 0.0_wp
      inc%e0 = 0.7_wp
      inc%d_v = 0.0_wp
      inc%p_c0 = 0.0_wp
      inc%d_pc = 0.0_wp
      inc%rho = 0.0_wp
      inc%exit = 1.0_wp
      inc%suction%bonds = .false.
      inc%rests = .false.
      inc%inside = .false.
      y = 0.0_wp
      y(1:6) = AXIAL
      do j = 1, WIDTH
         call take_increment(j, inc, q)
         call ask(par, j, inc, 0.0_wp, y, 0.0_wp*AXIAL, q)
      end do
      q%strain = 0.0_wp
      q%e = inc%e0
      q%suction = 0.0_wp
      q%ends_bonded = 0.0_wp
   end subroutine empty
end module mud_lanes
