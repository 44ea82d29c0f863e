!> The phases of an increment with an elastic nucleus.
module mud_phases
   use mud_kinds, only: wp
   use mud_consistent, only: sensitivity_t, enter_nucleus, leave_nucleus
   use mud_increment, only: increment_t, phase_of
   use mud_nucleus, only: exit_share, loading_direction
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
   !> An increment: with an elastic nucleus a phase inside it, then one that pulls it along; either may be empty. On
   !> return inc is the phase that ended the increment.
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
      real(wp) :: share

      if (inc%rho <= 0.0_wp) then
         call integrate(par, inc, size, consistent, state, trial, sens, counters, reached, status, record)
         return
      end if
      whole = inc
      whole%nucleus = state%nucleus
      if (norm(state%nucleus) > inc%rho) whole%nucleus = (inc%rho/norm(state%nucleus))*state%nucleus
      share = exit_share(inc%rho, whole%nucleus, inc%d_strain)
      if (share < WHOLE_PHASE) share = 0.0_wp
      if (1.0_wp - share < WHOLE_PHASE) share = 1.0_wp

      if (share > 0.0_wp) then
         inc = phase_of(whole, 0.0_wp, share)
         inc%inside = .true.
         if (consistent) call enter_nucleus(whole, share, sens)
         call integrate(par, inc, share*size, consistent, state, trial, sens, counters, reached, status, record)
         reached = share*reached
         if (status%code /= MUD_OK) return
      end if
      state%nucleus = whole%nucleus + share*whole%d_strain
      if (share < 1.0_wp) then
         inc = phase_of(whole, share, 1.0_wp)
         inc%nucleus = (inc%rho/norm(state%nucleus))*state%nucleus
         if (consistent) call leave_nucleus(whole, share, sens)
         call integrate(par, inc, (1.0_wp - share)*size, consistent, state, trial, sens, counters, reached, status, &
                        record)
         reached = share + (1.0_wp - share)*reached
         state%nucleus = inc%rho*loading_direction(inc%rho, inc%nucleus, inc%d_strain, 1.0_wp)
      end if
   end subroutine integrate_phases
end module mud_phases
