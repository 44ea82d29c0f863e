! SPDX-License-Identifier: MIT
!> The phases of an increment: with and without suction, inside an elastic domain and beyond it.
module mud_phases
   use mud_kinds, only: wp
   use mud_bonding, only: is_bonded
   use mud_consistent, only: sensitivity_t
   use mud_driving, only: driving_t, parts_at_exit, parts_without_suction, end_in_domain
   use mud_elastic_domain, only: exit_share, loading_direction
   use mud_increment, only: increment_t, take_phase
   use mud_params, only: params_t
   use mud_state, only: state_t, counters_t
   use mud_status, only: mud_status_t, MUD_OK
   use mud_substepping, only: integrate
   use mud_tensor, only: norm
   use mud_trace, only: trace_t
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: integrate_phases

   real(wp), parameter :: WHOLE_PHASE = 1.0e-9_wp            !< A phase shorter than this share is left out [-].

contains
   !> An increment. Where suction passes zero it is taken in two parts: bonding begins or ends there. On return inc is
   !> the phase that ended the increment. size in units of strain and reached, the share integrated [-]. Errors are
   !> those of integrate; state is then that of the last accepted substep. docs/theory/integration.md section 1.
   pure subroutine integrate_phases(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc
      real(wp), intent(in) :: size
      logical, intent(in) :: consistent
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(sensitivity_t), intent(inout) :: sens
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: reached
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      type(increment_t) :: whole
      type(driving_t) :: first, rest
      real(wp) :: share

      share = share_without_suction(par, inc)
      if (share >= 1.0_wp) then
         call integrate_part(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
         return
      end if
      whole = inc
      if (consistent) call parts_without_suction(whole, share, sens%driving, first, rest)
      call take_phase(whole, 0.0_wp, share, inc)
      inc%bonded = is_bonded(par, whole%p_c0)
      if (consistent) sens%driving = first
      call integrate_part(par, inc, share*size, consistent, state, trial, sens, counters, reached, status, record)
      reached = share*reached
      if (status%code /= MUD_OK) return
      if (consistent) rest%from_centre = sens%driving%from_centre
      call take_phase(whole, share, 1.0_wp, inc)
      inc%p_c0 = 0.0_wp
      inc%bonded = is_bonded(par, inc%d_pc)
      if (consistent) sens%driving = rest
      call integrate_part(par, inc, (1.0_wp - share)*size, consistent, state, trial, sens, counters, reached, status, &
                          record)
      reached = share + (1.0_wp - share)*reached
   end subroutine integrate_phases

   !> Share of an increment after which its suction passes zero, 1 if it does not.
   pure real(wp) function share_without_suction(par, inc) result(share)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc

      share = 1.0_wp
      if (.not. par%bonding .or. abs(inc%p_c0) <= 0.0_wp) return
      if ((inc%p_c0 > 0.0_wp) .eqv. (inc%p_c0 + inc%d_pc >= 0.0_wp)) return
      share = -inc%p_c0/inc%d_pc
      if (share < WHOLE_PHASE .or. 1.0_wp - share < WHOLE_PHASE) share = 1.0_wp
   end function share_without_suction

   !> A part of an increment, or all of it: with an elastic domain a phase inside it, then one that pulls it along;
   !> either may be empty. On return the derivatives of the strain from the centre are those at the end.
   pure subroutine integrate_part(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc
      real(wp), intent(in) :: size
      logical, intent(in) :: consistent
      type(state_t), intent(inout) :: state
      type(trial_t), intent(inout) :: trial
      type(sensitivity_t), intent(inout) :: sens
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: reached
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      type(increment_t) :: whole
      type(driving_t) :: inside, rest
      real(wp) :: share
      logical :: divided   !< Derivatives are wanted, and there are two parts.

      if (inc%rho <= 0.0_wp) then
         call integrate(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
         return
      end if
      whole = inc
      whole%from_centre = state%from_centre
      if (norm(state%from_centre) > inc%rho) whole%from_centre = (inc%rho/norm(state%from_centre))*state%from_centre
      share = exit_share(inc%rho, whole%from_centre, inc%d_strain)
      if (share < WHOLE_PHASE) share = 0.0_wp
      if (1.0_wp - share < WHOLE_PHASE) share = 1.0_wp
      divided = consistent .and. share > 0.0_wp
      if (divided) call parts_at_exit(whole, share, sens%driving, inside, rest)

      if (share > 0.0_wp) then
         call take_phase(whole, 0.0_wp, share, inc)
         inc%inside = .true.
         if (consistent) sens%driving = inside
         call integrate(par, inc, share*size, consistent, state, trial, sens, counters, reached, status, record)
         reached = share*reached
         if (status%code /= MUD_OK) return
      end if
      state%from_centre = whole%from_centre + share*whole%d_strain
      if (divided) sens%driving%from_centre = rest%from_centre
      if (share < 1.0_wp) then
         call take_phase(whole, share, 1.0_wp, inc)
         inc%from_centre = (inc%rho/norm(state%from_centre))*state%from_centre
         if (divided) sens%driving = rest
         call integrate(par, inc, (1.0_wp - share)*size, consistent, state, trial, sens, counters, reached, status, &
                        record)
         reached = share + (1.0_wp - share)*reached
         state%from_centre = inc%rho*loading_direction(inc%rho, inc%from_centre, inc%d_strain, 1.0_wp)
         if (consistent .and. whole%length < 1.0_wp) sens%driving%from_centre = end_in_domain(inc, sens%driving)
      end if
   end subroutine integrate_part
end module mud_phases
