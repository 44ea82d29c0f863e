! SPDX-License-Identifier: MIT
!> Events inside a substep: where one happens, the substep is shortened to end just beyond it.
module mud_events
   use mud_event, only: EVENT_NONE, EVENT_PARTS, EVENT_TURN
   use mud_event_table, only: EVENTS, look_ahead
   use mud_event_turn, only: place_of
   use mud_increment, only: rate_of
   use mud_integration, only: integration_t
   use mud_kinds, only: wp
   use mud_landing, only: land_on
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_return_point, only: place_t, projection_on_chord, note_progress, note_farthest
   use mud_trial, only: trial_t, take_step
   implicit none (type, external)
   private
   public :: stop_at_event, note_turning_point
contains
   !> Shortens an accepted substep so that it lands where the first event happens that concerns it: each is looked for
   !> in what those before it have left. h is a share of inc [-]; it stays where there is no event.
   !> docs/theory/integration.md sections 4.1, 4.2.
   pure subroutine stop_at_event(par, error, h, it)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: error        !< error of the substep [-]
      real(wp), intent(inout) :: h
      type(integration_t), intent(inout) :: it
      integer :: i
      logical :: possible

      it%event = EVENT_NONE
      !GCC$ UNROLL 12
      do i = 1, ubound(EVENTS, 1)
         if (.not. EVENTS(i)%concerns(it%trial%mode)) cycle
         call look_ahead(par, it%inc, i, error, h, it%trial, it%counters, possible)
         if (.not. possible) cycle
         if (i == EVENT_PARTS) then
            it%event = i
            call take_step(par, it%inc, h, it%trial, it%counters)
         else
            call land_on(par, it%inc, i, error, h, it%trial, it%counters, it%event)
         end if
      end do
   end subroutine stop_at_event

   !> The direction and target of the present process after an accepted substep: where it goes forwards last, at the end
   !> or where it ceases to. That place belongs to the path, while the end of the last substep of which it is true would
   !> depend on the sizes of substeps. A process that begins where the substep does, and drifts backwards, has not gone
   !> forwards. h is a share of inc [-]. docs/theory/memory-rules.md section 3.2, docs/theory/integration.md section
   !> 4.2.
   pure subroutine note_turning_point(par, h, it)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: h
      type(integration_t), intent(inout) :: it
      type(place_t) :: place
      type(trial_t) :: probe
      type(rate_t) :: w
      real(wp) :: size
      integer :: landed

      associate (inc => it%inc, trial => it%trial, memory => it%state%memory)
         place = place_of(par, inc, trial, trial%w(inc%scheme%stages), trial%y)
         if (projection_on_chord(par, place) >= 0.0_wp) then
            call note_progress(place, memory)
            return
         end if
         if (projection_on_chord(par, place_of(par, inc, trial, trial%w(1), trial%y0)) > 0.0_wp) then
            probe = trial
            size = h
            call land_on(par, inc, EVENT_TURN, par%tolerance, size, probe, it%counters, landed)
            call rate_of(par, inc, trial%time + size, probe%y, trial%r_in, trial%mode, w, it%counters)
            call note_progress(place_of(par, inc, trial, w, probe%y), memory)
         end if
         call note_farthest(place%r, memory)
      end associate
   end subroutine note_turning_point
end module mud_events
