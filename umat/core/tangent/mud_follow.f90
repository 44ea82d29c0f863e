! SPDX-License-Identifier: MIT
!> The derivatives of the consistent tangent follow an update: they read what it left of a phase, a turn of suction, a
!> substep, and nothing of theirs goes back; docs/theory/integration.md section 5.3.
module mud_follow
   use mud_consistent, only: sensitivity_t, propagate, changes_of_parting, &
      changes_of_ratio, jump_of_memory
   use mud_cutoff, only: MODE_HELD
   use mud_driving, only: change_of_turn, change_of_passing
   use mud_event, only: NOTHING
   use mud_event_table, only: EVENTS
   use mud_event_time, only: move_event
   use mud_increment, only: increment_t
   use mud_integration, only: integration_t
   use mud_kinds, only: wp
   use mud_mechanism_changes, only: changes_at_memory
   use mud_options, only: keep_past_changes
   use mud_params, only: params_t
   use mud_phases, only: cut_t, CUT_TURN, CUT_NO_SUCTION, CUT_EXIT, CUT_KINK
   use mud_retention, only: moves_with_turn
   use mud_tensor, only: DIRECTIONS, tensors_t, ANY_TENSORS
   implicit none (type, external)
   private
   public :: follow_phase, follow_turn, follow_substep
contains
   !> The phase of inc begins, which ends at a cut. docs/theory/integration.md sections 1, 5.3.
   pure subroutine follow_phase(par, inc, cut, sens)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(cut_t), intent(in) :: cut
      type(sensitivity_t), intent(inout) :: sens

      sens%driving%scans = moves_with_turn(inc%suction%retention_t)
      sens%end_shift = change_of_cut(par, inc, cut, sens)
      sens%stretch = (sens%end_shift - sens%shift)/(inc%to - inc%from)   ! substeps stretch with the phase
   end subroutine follow_phase

   !> Suction has turned: ln x of the turn goes with suction step and volume [1/kPa, -]. docs/theory/material.md section
   !> 2.1.1.
   pure subroutine follow_turn(with_increment, sens)
      real(wp), intent(in) :: with_increment(2)
      type(sensitivity_t), intent(inout) :: sens

      sens%driving%turn = with_increment(1)*sens%driving%d_pc + with_increment(2)*sens%driving%d_v
   end subroutine follow_turn

   !> Derivatives of the pseudo-time of a cut [-].
   pure function change_of_cut(par, inc, cut, sens) result(change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(cut_t), intent(in) :: cut
      type(sensitivity_t), intent(in) :: sens
      real(wp) :: change(DIRECTIONS)

      select case (cut%kind)
      case (CUT_TURN)
         change = change_of_turn(inc, cut%time, par%suction%omega, sens%driving)
      case (CUT_KINK)
         change = change_of_passing(inc, cut%time, par%suction%omega, sens%driving)
      case (CUT_NO_SUCTION)
         change = -(cut%time/inc%d_pc)*sens%driving%d_pc
      case (CUT_EXIT)
         change = sens%driving%exit
      case default
         change = 0.0_wp
      end select
   end function change_of_cut

   !> A substep h, a share of the increment, was taken over, jumps of the memory at its start and the event at its end
   !> included. docs/theory/integration.md sections 4.3, 5.3.
   pure subroutine follow_substep(par, it, h, sens)
      type(params_t), intent(in) :: par
      type(integration_t), intent(in) :: it
      real(wp), intent(in) :: h
      type(sensitivity_t), intent(inout) :: sens
      integer :: i

      associate (trial => it%trial)
         do i = 1, it%n_jumps
            call jump_of_memory(par, it%inc, it%jumps(i)%kind, it%jumps(i)%before, it%jumps(i)%after, it%trigger, &
                                trial, sens)
         end do
         if (trial%mode == MODE_HELD) then
            if (trial%e <= trial%parts) call changes_of_parting(it%inc, trial, sens)   ! it began without a gap
         end if
         call propagate(par, it%inc, trial, h, it%reached >= it%inc%to, sens)
         if (EVENTS(it%event)%depends /= NOTHING .and. it%reached < it%inc%to) &
            call move_event(par, it%inc, it%event, trial, h, sens)
         if (trial%mode /= MODE_HELD) call keep_past_changes(par, trial%y0, trial%y, trial%past, sens%y, sens%past)
         if (trial%drifts) sens%r_in = tensors_t(changes_of_ratio(par, it%state%sigma, sens%y), ANY_TENSORS)
      end associate
      if (it%reached < 1.0_wp) &   ! at the end of the increment only the stress is asked for
         call changes_at_memory(par, it%inc, it%state, it%reached, sens%shift, sens%driving, sens%y, sens%short)
   end subroutine follow_substep
end module mud_follow
