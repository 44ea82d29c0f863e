! SPDX-License-Identifier: MIT
!> Event: r exceeds the bounding surface inside the elastic domain; docs/theory/memory-rules.md section 4.3.
module mud_event_bounds
   use mud_bounding, only: excess
   use mud_event, only: event_t, NO_RATE, AT, BY_SURFACE, ELASTIC, psi_at
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rates, only: stress_ratio
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: BOUNDS, LARGEST_EXCESS, bounds_function

   type(event_t), parameter :: BOUNDS = event_t(ELASTIC, NO_RATE, AT, BY_SURFACE)

   !> Share by which r may exceed the bounding surface: at a low stress an elastic strain of rho_e may be more than the
   !> whole strength. Softening sand is some per cent beyond it and must be able to return where it came from [-].
   real(wp), parameter :: LARGEST_EXCESS = 0.2_wp
contains
   !> Distance of r from its largest excess over the bounding surface, at a pseudo-time and a vector there [-].
   pure real(wp) function bounds_function(par, inc, trial, time, y) result(f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time, y(NY)
      real(wp) :: p, r(6)

      call stress_ratio(par, y(1:6), p, r)
      f = allowed_excess(par, inc, trial) - excess(par%critical, psi_at(par, inc, time, p), r)
   end function bounds_function

   !> Largest excess of r over the bounding surface in a substep inside the elastic domain: from farther outside it is
   !> the excess at the start.
   pure real(wp) function allowed_excess(par, inc, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp) :: p, r(6)

      call stress_ratio(par, trial%y0(1:6), p, r)
      allowed_excess = max(excess(par%critical, psi_at(par, inc, trial%time, p), r), LARGEST_EXCESS)
   end function allowed_excess
end module mud_event_bounds
