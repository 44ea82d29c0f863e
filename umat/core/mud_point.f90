! SPDX-License-Identifier: MIT
!> One increment at one integration point: substeps of rates, with the jumps of memory between them.
module mud_point
   use mud_kinds, only: wp
   use mud_blocks, only: blocks_t, elastic_blocks, continuum_blocks
   use mud_checks, only: check_increment
   use mud_consistent, only: sensitivity_t, no_sensitivity
   use mud_cutoff, only: lifted, soil_void_ratio
   use mud_elastic, only: bulk_modulus
   use mud_follow, only: follow_phase, follow_turn, follow_substep
   use mud_increment, only: increment_t, new_increment, take_phase, void_ratio_at, suction_at, end_in_domain
   use mud_integration, only: integration_t
   use mud_order, only: look_for_stiffness
   use mud_params, only: params_t
   use mud_phases, only: cut_t, list_cuts, MAX_CUTS
   use mud_retention, only: saturation_t, course_t, begin_course, take_branch, turn_around, end_course
   use mud_rates, only: stress_ratio
   use mud_start, only: finish_state, has_tension
   use mud_state, only: state_t, E_LOWER, E_UPPER, E_OPEN
   use mud_status, only: fail, MUD_OK, MUD_VOID_RATIO_LIMIT, ON_VOID_RATIO
   use mud_stiff_direction, only: make_implicit
   use mud_substepping, only: stepping_t, begin_phase, try_substep, end_substep, end_phase
   use mud_tensor, only: DIRECTIONS, all_within
   use mud_transitions, only: take_last_rate, begin_substep
   implicit none (type, external)
   private
   public :: begin_update, end_update, end_way, end_saturation, give_tangent
   public :: update_point, TANGENT_NONE, TANGENT_ELASTIC, TANGENT_CONTINUUM, TANGENT_CONSISTENT

   integer, parameter :: TANGENT_NONE = 0, TANGENT_ELASTIC = 1, TANGENT_CONTINUUM = 2, TANGENT_CONSISTENT = 3

contains
   !> Integrates d_strain and d_pc from it%state, which is then at the end; counters and reached are of the update.
   !> it%traced, it%trace: the record that is wanted. On failure, it%status, state and blocks are undefined.
   !> MUD_BAD_INPUT, MUD_INCREMENT_TOO_LARGE and MUD_VOID_RATIO_LIMIT refuse the increment beforehand,
   !> MUD_TOO_MANY_SUBSTEPS, MUD_MINIMUM_STEP, MUD_NOT_FINITE and MUD_NO_DIRECTION end it. docs/theory/integration.md
   !> section 1.
   pure subroutine update_point(par, d_strain, d_pc, tangent, it, blocks)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_strain(6)         !< tensor shear, compression positive [-]
      real(wp), intent(in) :: d_pc                !< [kPa]
      integer, intent(in) :: tangent              !< TANGENT_*
      type(integration_t), intent(inout) :: it    !< new but for its state and what is to be traced
      type(blocks_t), intent(inout) :: blocks     !< untouched for TANGENT_NONE, but for the S_w blocks
      type(course_t) :: course
      type(cut_t) :: cuts(MAX_CUTS)
      type(stepping_t) :: step
      type(sensitivity_t) :: sens
      real(wp) :: h
      integer :: i, n
      logical :: follows, stiff

      call begin_update(par, d_strain, d_pc, it, course)
      if (it%status%code /= MUD_OK) return
      n = 0
      if (it%size > 0.0_wp) call list_cuts(par, it%inc, course, cuts, n)
      follows = tangent == TANGENT_CONSISTENT .and. n > 0
      if (follows) call no_sensitivity(it%state%memory%depth, it%inc, sens)
      do i = 1, n
         call take_phase(par, it%reached, cuts(i)%time, it%inc)
         call take_branch(course, it%inc%way_t, it%inc%from, it%inc%to, it%inc%suction%retention_t)
         call begin_phase(par, step, it)
         if (follows) call follow_phase(par, it%inc, cuts(i), sens)
         do while (it%reached < it%inc%to)
            call take_last_rate(it)
            call begin_substep(par, it)
            call look_for_stiffness(par, it%inc%to - it%reached, max(step%h, par%h_min), it%trial, stiff)
            if (stiff) call make_implicit(par, it%inc, it%trial)
            call try_substep(par, step, h, it)
            if (it%status%code /= MUD_OK) return
            call end_substep(par, step, h, it)
            if (it%status%code /= MUD_OK) return
            if (follows) call follow_substep(par, it, h, sens)
         end do
         call end_phase(step, it)
         if (.not. cuts(i)%turns) cycle
         call turn_around(it%inc%way_t, course)
         if (follows) call follow_turn(course%with_increment, sens)
      end do
      call end_update(par, tangent, n > 0, course, it, sens, blocks)
   end subroutine update_point

   !> The tangent of an update that is over.
   pure subroutine give_tangent(par, tangent, moved, it, sens, blocks)
      type(params_t), intent(in) :: par
      integer, intent(in) :: tangent
      logical, intent(in) :: moved               !< There was an increment.
      type(integration_t), intent(in) :: it
      type(sensitivity_t), intent(in) :: sens    !< followed for a consistent one
      type(blocks_t), intent(inout) :: blocks   !< the elastic ones
      logical :: slope

      if (tangent == TANGENT_NONE) return
      slope = tangent == TANGENT_CONSISTENT .and. moved
      if (slope) slope = is_slope(sens%y, blocks%dsig_deps(1, 1))   ! of an isotropic stiffness the largest
      if (slope) then
         blocks%dsig_deps = transpose(sens%y(1:6, 1:6))
         blocks%dsig_dpc = sens%y(7, 1:6)
      else if (tangent >= TANGENT_CONTINUUM .and. moved) then
         call continuum_blocks(par, it%inc, it%trial, it%state, blocks)
      end if
   end subroutine give_tangent

   !> Whether derivatives of the stress are slopes: those of explicit substeps at the limit of their stability grow from
   !> one to the next, up to 1e108 kPa, while error control keeps the stress. docs/theory/integration.md section 5.3.
   pure logical function is_slope(y, stiffness)
      real(wp), intent(in) :: y(DIRECTIONS, 6) !< By strain [kPa], by suction [-], and along the idle direction.
      real(wp), intent(in) :: stiffness   !< Largest elastic one [kPa].
      real(wp), parameter :: STEEPEST = 1.0e4_wp   !< The stress of an increment changes the stiffness by less.
      real(wp) :: largest(DIRECTIONS, 6)

      largest(1:6, :) = STEEPEST*stiffness
      largest(7, :) = STEEPEST
      largest(8:, :) = huge(1.0_wp)
      is_slope = all_within(size(y), y, largest)
   end function is_slope

   !> Checks the increment, and lifts a stress below its limit; nothing is integrated yet.
   pure subroutine begin_update(par, d_strain, d_pc, it, course)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_strain(6), d_pc
      type(integration_t), intent(inout) :: it
      type(course_t), intent(out) :: course
      real(wp) :: e, largest

      call check_increment(par, it%state, d_strain, d_pc, it%status)
      if (it%status%code /= MUD_OK) return
      call new_increment(par, it%state%e, it%state%p_c, it%state%from_centre, d_strain, d_pc, it%inc)
      largest = merge(E_OPEN, E_UPPER, it%state%gap > 0.0_wp)
      e = void_ratio_at(it%inc, 1.0_wp)
      if (e <= E_LOWER .or. e >= largest) then
         it%status = fail(MUD_VOID_RATIO_LIMIT, ON_VOID_RATIO, 0, e, E_LOWER, largest)
         return
      end if
      associate (state => it%state)
         call begin_course(par%suction%retention_t, it%inc%way_t, state%s_w, state%turns, it%inc%suction%retention_t, &
                           it%counters%cleared, course)
         if (par%cutoff) state%sigma = lifted(par, it%inc%suction, state%sigma, state%e, state%p_c)
      end associate
      it%size = extent_of(par, it%inc, it%state)
      it%trial%divides = .false.
   end subroutine begin_update

   !> The state at the end of the increment, the slopes of its S_w, and the tangent.
   pure subroutine end_update(par, tangent, moved, course, it, sens, blocks)
      type(params_t), intent(in) :: par
      integer, intent(in) :: tangent
      logical, intent(in) :: moved   !< as give_tangent has it
      type(course_t), intent(in) :: course
      type(integration_t), intent(inout) :: it
      type(sensitivity_t), intent(in) :: sens
      type(blocks_t), intent(inout) :: blocks
      type(saturation_t) :: sat
      real(wp) :: with_turn(2)

      call end_way(par, course, it, with_turn)
      if (it%size > 0.0_wp .and. it%inc%rho > 0.0_wp) it%state%from_centre = end_in_domain(it%inc)
      call finish_state(par, it%inc%suction, it%state, sat)
      call end_saturation(sat, with_turn, it, blocks)
      if (tangent == TANGENT_NONE) return
      call elastic_blocks(par, it%state, blocks)
      call give_tangent(par, tangent, moved, it, sens, blocks)
   end subroutine end_update

   !> Void ratio and suction at the end of the increment, and the branch of S_w.
   pure subroutine end_way(par, course, it, with_turn)
      type(params_t), intent(in) :: par
      type(course_t), intent(in) :: course
      type(integration_t), intent(inout) :: it
      real(wp), intent(out) :: with_turn(2)   !< as end_course has it

      it%reached = 1.0_wp
      it%state%e = void_ratio_at(it%inc, 1.0_wp)
      it%state%p_c = suction_at(it%inc, 1.0_wp)
      call end_course(it%inc%way_t, course, it%state%s_w, it%state%turns, it%inc%suction%retention_t, with_turn)
      it%inc%suction%bonds = par%suction%bonds   ! the phases are over
   end subroutine end_way

   !> The slopes of S_w at the end of the increment, where it has the saturation sat.
   pure subroutine end_saturation(sat, with_turn, it, blocks)
      type(saturation_t), intent(in) :: sat
      real(wp), intent(in) :: with_turn(2)
      type(integration_t), intent(inout) :: it
      type(blocks_t), intent(inout) :: blocks

      blocks%dsw_dpc = sat%ds_dpc + with_turn(1)
      blocks%dsw_dev = -(1.0_wp + it%state%e)*sat%ds_de + with_turn(2)
      if (has_tension(it%state%sigma)) it%counters%tensile = 1
   end subroutine end_saturation

   !> Size of an increment in units of strain [-]: suction counts with the bulk modulus. docs/theory/integration.md
   !> section 3.
   pure real(wp) function extent_of(par, inc, state) result(size)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(state_t), intent(in) :: state
      real(wp) :: p, r(6)

      size = inc%length
      if (abs(inc%d_pc) <= 0.0_wp) return
      call stress_ratio(par, state%sigma, p, r)
      size = size + abs(inc%d_pc)/bulk_modulus(par%elastic, soil_void_ratio(state), p)
   end function extent_of
end module mud_point
