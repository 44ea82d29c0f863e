!> The phases of an increment with an elastic domain.
module mud_phases
   use mud_kinds, only: wp
   use mud_consistent, only: sensitivity_t, enter_elastic_domain, leave_elastic_domain
   use mud_increment, only: increment_t, phase_of
   use mud_elastic_domain, only: exit_share, loading_direction
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
   !> An increment: with an elastic domain a phase inside it, then one that pulls it along; either may be empty. On
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
      whole%from_centre = state%from_centre
      if (norm(state%from_centre) > inc%rho) whole%from_centre = (inc%rho/norm(state%from_centre))*state%from_centre
      share = exit_share(inc%rho, whole%from_centre, inc%d_strain)
      if (share < WHOLE_PHASE) share = 0.0_wp
      if (1.0_wp - share < WHOLE_PHASE) share = 1.0_wp

      if (share > 0.0_wp) then
         inc = phase_of(whole, 0.0_wp, share)
         inc%inside = .true.
         if (consistent) call enter_elastic_domain(whole, share, sens)
         call integrate(par, inc, share*size, consistent, state, trial, sens, counters, reached, status, record)
         reached = share*reached
         if (status%code /= MUD_OK) return
      end if
      state%from_centre = whole%from_centre + share*whole%d_strain
      if (share < 1.0_wp) then
         inc = phase_of(whole, share, 1.0_wp)
         inc%from_centre = (inc%rho/norm(state%from_centre))*state%from_centre
         if (consistent) call leave_elastic_domain(whole, share, sens)
         call integrate(par, inc, (1.0_wp - share)*size, consistent, state, trial, sens, counters, reached, status, &
                        record)
         reached = share + (1.0_wp - share)*reached
         state%from_centre = inc%rho*loading_direction(inc%rho, inc%from_centre, inc%d_strain, 1.0_wp)
      end if
   end subroutine integrate_phases
end module mud_phases
