! SPDX-License-Identifier: MIT
!> One increment at one integration point: substeps of rates, with the jumps of memory between them.
module mud_point
   use mud_kinds, only: wp
   use mud_blocks, only: blocks_t, elastic_blocks, continuum_blocks
   use mud_branches, only: course_t, begin_course, end_course
   use mud_checks, only: check_increment
   use mud_consistent, only: no_sensitivity
   use mud_cutoff, only: lifted
   use mud_extent, only: extent_of
   use mud_increment, only: new_increment, void_ratio_at
   use mud_integration, only: integration_t
   use mud_params, only: params_t
   use mud_phases, only: integrate_phases
   use mud_start, only: finish_state, has_tension
   use mud_state, only: E_LOWER, E_UPPER, E_OPEN
   use mud_status, only: fail, MUD_OK, MUD_VOID_RATIO_LIMIT, ON_VOID_RATIO
   implicit none (type, external)
   private
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
      real(wp) :: with_turn(2), e, largest, p_c

      call check_increment(par, it%state, d_strain, d_pc, it%status)
      if (it%status%code /= MUD_OK) return
      call new_increment(par, it%state%e, it%state%p_c, it%state%from_centre, d_strain, d_pc, it%inc)
      largest = merge(E_OPEN, E_UPPER, it%state%gap > 0.0_wp)
      e = void_ratio_at(it%inc, 1.0_wp)
      if (e <= E_LOWER .or. e >= largest) then
         it%status = fail(MUD_VOID_RATIO_LIMIT, ON_VOID_RATIO, 0, e, E_LOWER, largest)
         return
      end if

      p_c = it%state%p_c + d_pc
      if (par%hysteresis) call begin_course(par, it%inc, it%state, it%counters, course)
      call begin(par, tangent, it)
      if (it%size > 0.0_wp) call integrate_phases(par, course, it)
      if (it%status%code /= MUD_OK) return
      it%reached = 1.0_wp
      it%state%e = e
      it%state%p_c = p_c
      with_turn = 0.0_wp
      if (par%hysteresis) call end_course(it%inc, course, it%state, with_turn)
      it%inc%suction%bonds = par%suction%bonds   ! the phases are over
      call finish_state(par, it%inc%suction, it%state, blocks)
      blocks%dsw_dpc = blocks%dsw_dpc + with_turn(1)
      blocks%dsw_dev = blocks%dsw_dev + with_turn(2)
      call fill_blocks(par, tangent, it, blocks)
      if (has_tension(it%state%sigma)) it%counters%tensile = 1
   end subroutine update_point

   !> A stress below its limit is lifted; nothing is integrated yet.
   pure subroutine begin(par, tangent, it)
      type(params_t), intent(in) :: par
      integer, intent(in) :: tangent
      type(integration_t), intent(inout) :: it

      associate (state => it%state)
         if (par%cutoff) state%sigma = lifted(par, it%inc%suction, state%sigma, state%e, state%p_c)
      end associate
      it%size = extent_of(par, it%inc, it%state)
      it%consistent = tangent == TANGENT_CONSISTENT .and. it%size > 0.0_wp
      if (it%consistent) call no_sensitivity(it%state%memory%depth, it%inc, it%sens)
   end subroutine begin

   !> The tangent that is asked for, at the end.
   pure subroutine fill_blocks(par, tangent, it, blocks)
      type(params_t), intent(in) :: par
      integer, intent(in) :: tangent
      type(integration_t), intent(in) :: it
      type(blocks_t), intent(inout) :: blocks

      if (it%consistent) then
         blocks%dsig_deps = transpose(it%sens%y(1:6, 1:6))
         blocks%dsig_dpc = it%sens%y(7, 1:6)
      else if (tangent == TANGENT_CONTINUUM .and. it%size > 0.0_wp) then
         call continuum_blocks(par, it%inc, it%trial, it%state, blocks)
      else if (tangent /= TANGENT_NONE) then
         call elastic_blocks(par, it%state, blocks)
      end if
   end subroutine fill_blocks
end module mud_point
