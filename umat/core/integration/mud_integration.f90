! SPDX-License-Identifier: MIT
!> State of the integration of an increment on its way.
module mud_integration
   use mud_consistent, only: sensitivity_t, JUMP_NONE
   use mud_event_table, only: EVENT_NONE
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_state, only: state_t, counters_t
   use mud_status, only: mud_status_t
   use mud_trace, only: trace_t, record_substep
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: integration_t, record

   !> An increment on its way.
   type :: integration_t
      type(increment_t) :: inc
      real(wp) :: size               !< Size of the increment, in units of strain [-].
      type(state_t) :: state         !< After the last accepted substep.
      type(trial_t) :: trial         !< The substep that is tried, or the last accepted one.
      integer :: jump = JUMP_NONE    !< JUMP_* of the memory at its start, the last one if there were several.
      integer :: event = EVENT_NONE  !< EVENT_* at which the last accepted substep ended.
      logical :: known = .false.     !< The last rate of the trial is the first of the next; one held does not close.
      logical :: consistent          !< Derivatives are wanted, and there is something to derive.
      type(sensitivity_t) :: sens
      type(counters_t) :: counters
      real(wp) :: reached = 0.0_wp   !< Pseudo-time of state [-].
      type(mud_status_t) :: status
      logical :: traced = .false.
      type(trace_t) :: trace
   end type integration_t
contains
   !> Records an attempt h, a share of the increment, with its relative error [-] and the stress to which it led.
   pure subroutine record(h, error, sigma, outcome, it)
      real(wp), intent(in) :: h, error, sigma(6)
      integer, intent(in) :: outcome   !< SUBSTEP_*
      type(integration_t), intent(inout) :: it

      if (it%traced) call record_substep(it%inc, it%trial, h, error, sigma, outcome, it%jump, &
                                         it%event /= EVENT_NONE, it%counters, it%trace)
   end subroutine record
end module mud_integration
