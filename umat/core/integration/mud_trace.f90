! SPDX-License-Identifier: MIT
!> A record of the substeps that an update tried, to find out why it failed.
module mud_trace
   use, intrinsic :: iso_c_binding, only: c_int, c_double
   use mud_kinds, only: wp
   use mud_retention, only: saturation_t, saturation
   use mud_state, only: counters_t, guard_count
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: substep_t, trace_t, record_substep, SUBSTEP_REJECTED, SUBSTEP_ACCEPTED, SUBSTEP_FAILED

   integer, parameter :: SUBSTEP_REJECTED = 0, SUBSTEP_ACCEPTED = 1
   integer, parameter :: SUBSTEP_FAILED = 2   !< The update ended here.

   !> struct mud_substep of mud.h; here the stress is compression positive.
   type, bind(c) :: substep_t
      integer(c_int) :: outcome, mode, jump, landed, n_rate, n_reset, n_guard, n_no_root
      real(c_double) :: time, size, error, void_ratio, saturation, suction, stress(6)
   end type substep_t

   !> The substeps from number `first` on, as many as there are rows; rows are the caller's.
   type :: trace_t
      integer :: first = 1
      integer :: attempts = 0   !< Substeps tried, recorded or not.
      type(substep_t), pointer :: rows(:) => null()
   end type trace_t
contains
   !> Records one attempt. Compression positive; an attempt without a row is only counted.
   pure subroutine record_substep(inc, trial, h, error, sigma, outcome, jump, landed, counters, trace)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h, error        !< Size, share of the increment, and its relative error [-].
      real(wp), intent(in) :: sigma(6)        !< Where it led [kPa].
      integer, intent(in) :: outcome, jump    !< SUBSTEP_*; JUMP_* of the memory at its start.
      logical, intent(in) :: landed           !< Shortened to end at an event.
      type(counters_t), intent(in) :: counters
      type(trace_t), intent(inout) :: trace
      type(saturation_t) :: sat
      real(wp) :: e, p_c
      integer :: row

      trace%attempts = trace%attempts + 1
      row = trace%attempts - trace%first + 1
      if (.not. associated(trace%rows) .or. row < 1) return
      if (row > size(trace%rows)) return
      e = void_ratio_at(inc, trial%time + h)
      p_c = suction_at(inc, trial%time + h)
      sat = saturation(inc%suction%retention_t, p_c, e)
      trace%rows(row) = substep_t(outcome, trial%mode, jump, merge(1, 0, landed), counters%rate, counters%reset, &
                                  guard_count(counters), counters%no_root, &
                                  trial%time, h, error, e, sat%s_w, p_c, sigma)
   end subroutine record_substep
end module mud_trace
