! SPDX-License-Identifier: MIT
!> Event: r reaches the target of an interrupted process, which goes on; docs/theory/memory-rules.md section 3.4.
module mud_event_return
   use mud_critical_state, only: bounding_ratio, bounding_slope
   use mud_event, only: event_t, event_changes_t, NO_RATE, AT, BY_SURFACE, ORDINARY, psi_at
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rates, only: stress_ratio
   use mud_return_point, only: beyond_target, target_limit
   use mud_tensor, only: DIRECTIONS, contractions
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: RETURNS, return_function, slopes_of_return

   type(event_t), parameter :: RETURNS = event_t(ORDINARY, NO_RATE, AT, BY_SURFACE)
contains
   !> Distance of r before the target, at a pseudo-time and a vector there [-].
   pure real(wp) function return_function(par, inc, trial, time, y) result(f)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: time, y(NY)
      real(wp) :: p, r(6)

      call stress_ratio(par, y(1:6), p, r)
      f = -beyond_target(par, trial%process, r, bounding_ratio(par%critical, psi_at(par, inc, time, p)))
   end function return_function

   !> Changes of the distance beyond the target, at a state parameter [-].
   pure function slopes_of_return(par, trial, psi, c) result(slopes)
      type(params_t), intent(in) :: par
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: psi
      type(event_changes_t), intent(in) :: c
      real(wp) :: slopes(DIRECTIONS)
      real(wp) :: m_b, limit

      m_b = bounding_ratio(par%critical, psi)
      limit = target_limit(par, trial%process)
      slopes = contractions(c%r, trial%process%direction)
      ! where the bounding surface sets the target
      if (limit*m_b < trial%process%target) slopes = slopes - (limit*bounding_slope(par%critical, psi, m_b))*c%psi
   end function slopes_of_return
end module mud_event_return
