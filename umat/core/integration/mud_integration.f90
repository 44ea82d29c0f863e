! SPDX-License-Identifier: MIT
!> State of the integration of an increment on its way.
module mud_integration
   use mud_event, only: EVENT_NONE
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_kinds, only: wp
   use mud_rate, only: rate_t
   use mud_registry, only: MAX_INTERRUPTED
   use mud_retention, only: saturation_t, saturation
   use mud_state, only: state_t, memory_t, counters_t, guard_count
   use mud_status, only: mud_status_t
   use mud_trace, only: substep_t, trace_t
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: integration_t, jump_t, record, note_jump, JUMP_NONE, JUMP_REVERSAL, JUMP_RETURN, JUMP_NEW

   integer, parameter :: JUMP_NONE = 0
   integer, parameter :: JUMP_REVERSAL = 1   !< A new process begins.
   integer, parameter :: JUMP_RETURN = 2     !< An interrupted process goes on.
   integer, parameter :: JUMP_NEW = 3        !< The point leaves the tension cut-off: no past.
   !> Where a substep begins every process that is interrupted may go on, once more after one reversal, and the point
   !> may close.
   integer, parameter :: MAX_JUMPS = MAX_INTERRUPTED + 3

   !> A jump of the memory where a substep begins.
   type :: jump_t
      integer :: kind   !< JUMP_*
      type(memory_t) :: before, after
   end type jump_t

   !> An increment on its way.
   type :: integration_t
      type(increment_t) :: inc
      real(wp) :: size               !< Size of the increment, in units of strain [-].
      type(state_t) :: state         !< After the last accepted substep.
      type(trial_t) :: trial         !< The substep that is tried, or the last accepted one.
      integer :: jump = JUMP_NONE    !< JUMP_* of the memory at its start, the last one if there were several.
      integer :: event = EVENT_NONE  !< EVENT_* at which the last accepted substep ended.
      logical :: known = .false.     !< The last rate of the trial is the first of the next; one held does not close.
      integer :: n_jumps             !< Number of jumps of the memory at its start ...
      type(jump_t) :: jumps(MAX_JUMPS)   !< ... in their order, ...
      type(rate_t) :: trigger        !< ... and the rate that made the last one.
      type(counters_t) :: counters
      real(wp) :: reached = 0.0_wp   !< Pseudo-time of state [-].
      type(mud_status_t) :: status
      logical :: traced = .false.
      type(trace_t) :: trace
   end type integration_t
contains
   !> Records an attempt h, a share of the increment, with its relative error [-] and the stress to which it led; one
   !> without a row is only counted.
   pure subroutine record(h, error, sigma, outcome, it)
      real(wp), intent(in) :: h, error, sigma(6)
      integer, intent(in) :: outcome   !< SUBSTEP_*
      type(integration_t), intent(inout) :: it
      type(saturation_t) :: sat
      real(wp) :: time, e, p_c
      integer :: row

      if (.not. it%traced) return
      it%trace%attempts = it%trace%attempts + 1
      row = it%trace%attempts - it%trace%first + 1
      if (.not. associated(it%trace%rows) .or. row < 1) return
      if (row > size(it%trace%rows)) return
      time = it%trial%time
      e = void_ratio_at(it%inc, time + h)
      p_c = suction_at(it%inc, time + h)
      sat = saturation(it%inc%suction%retention_t, p_c, e)
      it%trace%rows(row) = substep_t(outcome, it%trial%mode, it%jump, merge(0, 1, it%event == EVENT_NONE), &
                                     it%counters%rate, it%counters%reset, guard_count(it%counters), &
                                     it%counters%no_root, time, h, error, e, sat%s_w, p_c, sigma)
   end subroutine record

   !> Notes a jump of the memory from `before` to what the state has now, which the trial's first rate makes.
   pure subroutine note_jump(kind, before, it)
      integer, intent(in) :: kind   !< JUMP_*, not JUMP_NONE
      type(memory_t), intent(in) :: before
      type(integration_t), intent(inout) :: it

      it%jump = kind
      it%n_jumps = it%n_jumps + 1
      it%jumps(it%n_jumps) = jump_t(kind, before, it%state%memory)
      it%trigger = it%trial%w(1)
   end subroutine note_jump
end module mud_integration
