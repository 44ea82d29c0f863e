! SPDX-License-Identifier: MIT
!> Event: p' of a held point would rise from p_min, and it closes; docs/theory/material.md sections 6.1, 6.3.
module mud_event_closes
   use mud_cutoff, only: is_parted
   use mud_elastic, only: bulk_slope
   use mud_event, only: event_t, event_changes_t, RATE_IF_CLOSED, BEYOND, BY_VIRGIN_RATE, HELD
   use mud_increment, only: increment_t, rate_of
   use mud_kinds, only: wp
   use mud_options, only: forget_past
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, MODE_ORDINARY, MODE_ELASTIC
   use mud_state, only: counters_t
   use mud_tensor, only: DIRECTIONS, contractions
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: CLOSES_AT, may_close, closing_mode, rate_without_past, closes, closing_function, slopes_of_closing

   type(event_t), parameter :: CLOSES_AT = event_t(HELD, RATE_IF_CLOSED, BEYOND, BY_VIRGIN_RATE)

   !> An open point closes when p' would rise by this share of the elastic rate: opening and closing at the same rate
   !> would chatter where the two pull the stress ratio to opposite sides [-].
   real(wp), parameter :: CLOSING = 0.01_wp
   !> Each time a point opens again in the same increment the share is that many times larger, up to a limit: where
   !> the rate without a past rises and that of the process that follows falls, it would open and close at every turn
   !> [-].
   real(wp), parameter :: CLOSING_GROWTH = 4.0_wp, LARGEST_CLOSING = 0.32_wp
contains
   !> True of a held substep h in which the grains do not part.
   pure logical function may_close(inc, trial, h)
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h

      may_close = .not. (is_parted(inc, trial%parts, trial%time) .or. is_parted(inc, trial%parts, trial%time + h))
   end function may_close

   !> Mode in which a held point would go on if it closed: inside the elastic domain without plastic dilatancy. One of
   !> MODE_ORDINARY and MODE_ELASTIC.
   pure integer function closing_mode(inc)
      type(increment_t), intent(in) :: inc

      closing_mode = merge(MODE_ELASTIC, MODE_ORDINARY, inc%inside)
   end function closing_mode

   !> The rate of a held point that closes: without a past. time is a share of inc [-], y as for rate_of.
   !> docs/theory/material.md section 6.3.
   pure subroutine rate_without_past(par, inc, time, y, w, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, y(NY)
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters
      real(wp) :: p, r(6), virgin(NY)

      call stress_ratio(par, y(1:6), p, r)
      virgin = y
      call forget_past(virgin)
      call rate_of(par, inc, time, virgin, r, closing_mode(inc), w, counters)
   end subroutine rate_without_past

   !> True where p' would rise from p_min by enough to close. docs/theory/material.md sections 6.1, 6.3.
   pure logical function closes(inc, openings, w)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings      !< number of times that p' has fallen to p_min in this increment or phase
      type(rate_t), intent(in) :: w        !< at p_min, without a past

      closes = .not. closing_rate(inc, openings, w) <= 0.0_wp   ! a rate that is not finite is not hidden
   end function closes

   !> Distance of an open point below the rate of p' at which it closes, as a share of the elastic rate [-]: it closes
   !> where that passes zero. docs/theory/integration.md section 4.2.
   pure real(wp) function closing_function(inc, openings, w)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings
      type(rate_t), intent(in) :: w        !< at p_min, without a past

      closing_function = -closing_rate(inc, openings, w)/elastic_length(inc, w)
   end function closing_function

   !> Changes of closing_rate, at a void ratio e [kPa]. Derivative of docs/theory/material.md sections 6.1, 6.3.
   pure function slopes_of_closing(inc, openings, w, e, c) result(slopes)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: e
      type(event_changes_t), intent(in) :: c
      real(wp), dimension(DIRECTIONS) :: slopes, of_length

      of_length = w%k*inc%length*bulk_slope(e)*c%e + sign(1.0_wp, inc%d_pc)*c%d_pc
      if (inc%length > 0.0_wp) of_length = of_length + (w%k/inc%length)*contractions(c%strain, inc%d_strain)
      slopes = (c%rates(:, 1) + c%rates(:, 2) + c%rates(:, 3))/3.0_wp - closing_share(openings)*of_length
   end function slopes_of_closing

   !> Distance of the rate of p' above the one at which an open point closes, positive if it closes [kPa].
   pure real(wp) function closing_rate(inc, openings, w)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: openings
      type(rate_t), intent(in) :: w

      closing_rate = w%d_p - closing_share(openings)*elastic_length(inc, w)
   end function closing_rate

   !> Share of the elastic rate at which an open point closes [-].
   pure real(wp) function closing_share(openings)
      integer, intent(in) :: openings

      closing_share = min(CLOSING*CLOSING_GROWTH**max(openings - 1, 0), LARGEST_CLOSING)
   end function closing_share

   !> Size of the elastic rate of p' [kPa].
   pure real(wp) function elastic_length(inc, w)
      type(increment_t), intent(in) :: inc
      type(rate_t), intent(in) :: w

      elastic_length = w%k*inc%length + abs(inc%d_pc)
   end function elastic_length
end module mud_event_closes
