! SPDX-License-Identifier: MIT
!> An event inside a substep: a row and a file each, mud_event_NAME. The file has its procedures: where it may happen,
!> its function, how this changes, what follows; what is one expression stands in the list of events, mud_event_table.
!> docs/theory/integration.md section 4.2.
module mud_event
   use mud_bounding, only: psi_of
   use mud_cutoff, only: MODE_HELD
   use mud_increment, only: increment_t, void_ratio_at, suction_at, rate_of
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: MODE_ORDINARY
   use mud_state, only: counters_t
   use mud_tensor, only: DIRECTIONS, deviator
   use mud_trial, only: trial_t
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: event_t, event_changes_t, NO_RATE, RATE_THERE, RATE_IF_CLOSED, BEFORE, AT, BEYOND, NOBODY, ORDINARY, &
             ELASTIC, HELD, NEARLY, FEW_TRIALS, SHARP_KINK, last_rate, switches, elastic_rate, &
             psi_at
   public :: NOTHING, BY_STATE, BY_RATE, BY_DRIVE, BY_VIRGIN_RATE, BY_SURFACE, BY_MECHANISM, BY_MEMORY
   public :: EVENT_NONE, EVENT_OPENS, EVENT_CLOSES, EVENT_BOUNDS, EVENT_MECHANISM, EVENT_REVERSAL, EVENT_RETURN, &
             EVENT_TURN, EVENT_PARTS, EVENT_DILATES, EVENT_YIELD, EVENT_UNLOAD, EVENT_FORWARDS

   ! in the order in which they are looked for
   integer, parameter :: EVENT_NONE = 0
   integer, parameter :: EVENT_OPENS = 1      !< p' falls to p_min.
   integer, parameter :: EVENT_PARTS = 2      !< The gap of a held point begins or ends: in closed form.
   integer, parameter :: EVENT_CLOSES = 3     !< p' would rise from p_min.
   integer, parameter :: EVENT_BOUNDS = 4     !< r exceeds the bounding surface inside the elastic domain.
   integer, parameter :: EVENT_MECHANISM = 5  !< The isotropic mechanism begins or ends to act while suction changes.
   integer, parameter :: EVENT_DILATES = 6    !< Contraction turns to dilation or back, where that is a kink.
   integer, parameter :: EVENT_YIELD = 7      !< Compression reaches what the isotropic mechanism remembers.
   integer, parameter :: EVENT_UNLOAD = 8     !< Compression ceases; the isotropic mechanism remembers how far it came.
   integer, parameter :: EVENT_REVERSAL = 9   !< (r - r_in):n falls to -x_rev.
   integer, parameter :: EVENT_RETURN = 10    !< r reaches the target of an interrupted process.
   integer, parameter :: EVENT_FORWARDS = 11  !< A process that drifts back from its beginning goes forwards.
   integer, parameter :: EVENT_TURN = 12      !< A process ceases to go forwards; its substep goes on.

   integer, parameter :: NO_RATE = 0          !< The function looks at the state alone.
   integer, parameter :: RATE_THERE = 1       !< The function looks at the rate there.
   integer, parameter :: RATE_IF_CLOSED = 2   !< The function looks at the rate of a held point that closes, without a
                                              !< past.

   integer, parameter :: BEFORE = -1   !< A substep ends on its own side: its derivatives are those of that side.
   integer, parameter :: AT = 0        !< A substep may end on either side, within rounding.
   integer, parameter :: BEYOND = 1    !< A substep must end beyond the event, or that would not happen.

   !> A function is zero below this share of its change over the substep: far enough above rounding that rounding does
   !> not decide how many trials are made [-].
   real(wp), parameter :: EXACT = 1.0e-12_wp
   integer, parameter :: EXACT_TRIALS = 100   !< Bisection alone needs about 45.
   !> A turning point ends no substep and need not be as exact [-].
   real(wp), parameter :: NEARLY = 1.0e-6_wp
   integer, parameter :: FEW_TRIALS = 10

   integer, parameter :: NOTHING = 0          !< The time does not count in a derivative: rates are smooth there.
   integer, parameter :: BY_STATE = 1         !< State, void ratio, stress ratio: they are known for all below, too.
   integer, parameter :: BY_RATE = 2          !< The rate there and its direction.
   integer, parameter :: BY_DRIVE = 3         !< These, and the drive n:t of the stress ratio.
   integer, parameter :: BY_VIRGIN_RATE = 4   !< The rate there, whose memory is the stress ratio.
   integer, parameter :: BY_SURFACE = 5       !< State parameter, and excess over the bounding surface.
   integer, parameter :: BY_MECHANISM = 6     !< The drive of the isotropic mechanism.
   integer, parameter :: BY_MEMORY = 7        !< The way to the memory of the isotropic mechanism.

   !> A kink is looked for where the error of a substep is above this share of the tolerance [-].
   real(wp), parameter :: SHARP_KINK = 0.01_wp
   !> A number that switches and is this much smaller than at the end of a substep is where it switched before [-].
   real(wp), parameter :: AT_SWITCH = 1.0e-6_wp

   type :: event_t
      logical :: concerns(MODE_ORDINARY:MODE_HELD)   !< Substeps that are ordinary, elastic, held.
      integer :: looks_at                            !< NO_RATE, RATE_THERE, RATE_IF_CLOSED
      integer :: side                                !< Where the substep ends: BEFORE, AT, BEYOND.
      integer :: depends    !< BY_*: what its function, and so its time, changes with; NOTHING: the time does not count.
      real(wp) :: residual = EXACT       !< Share of its change below which the function is zero [-].
      integer :: trials = EXACT_TRIALS   !< At most.
   end type event_t

   !> Changes where an event is, along directions side by side; what its function does not change with is not set.
   type :: event_changes_t
      real(wp) :: y(DIRECTIONS, NY), rates(DIRECTIONS, NY)   !< changes of the integrated vector, of its rates
      !> changes of stress ratio, memory, direction, strain step
      real(wp), dimension(DIRECTIONS, 6) :: r, r_in, n, strain
      real(wp), dimension(DIRECTIONS) :: e, d_pc, psi, excess, mechanism, drive   !< changes of void ratio, ...
   end type event_changes_t

   logical, parameter, dimension(MODE_ORDINARY:MODE_HELD) :: NOBODY = [.false., .false., .false.], &
      ORDINARY = [.true., .false., .false.], ELASTIC = [.false., .true., .false.], HELD = [.false., .false., .true.]
contains
   !> The rate at the end of a substep h of the trial, a share of inc [-]: that of the last stage if it stands there.
   pure subroutine last_rate(par, inc, trial, h, w, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      type(rate_t), intent(inout) :: w
      type(counters_t), intent(inout) :: counters

      if (inc%scheme%first_same_as_last) then
         w = trial%w(inc%scheme%stages)
      else
         call rate_of(par, inc, trial%time + h, trial%y, trial%r_in, trial%mode, w, counters)
      end if
   end subroutine last_rate

   !> True where a number changes its sign in a substep that does not begin there.
   pure logical function switches(first, last)
      real(wp), intent(in) :: first, last

      switches = first*last < 0.0_wp .and. abs(first) > AT_SWITCH*abs(last)
   end function switches

   !> p' times the rate of the stress ratio if the whole strain were elastic. The part of the strain across the elastic
   !> domain turns the direction of loading, not the process: the whole strain tells where it goes. r [-].
   !> docs/theory/memory-rules.md section 3.3.
   pure function elastic_rate(inc, w, r) result(t)
      type(increment_t), intent(in) :: inc
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: r(6)
      real(wp) :: t(6)   !< [stress]

      t = (2.0_wp*w%g)*deviator(inc%d_strain) - (w%k*inc%d_v)*r
   end function elastic_rate

   !> State parameter at a pseudo-time and a mean stress [-]. time is a share of inc [-], p in the unit of p_atm.
   !> docs/theory/material.md section 3.2.
   pure real(wp) function psi_at(par, inc, time, p)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, p

      psi_at = psi_of(par%critical, inc%suction, void_ratio_at(inc, time), suction_at(inc, time), p)
   end function psi_at
end module mud_event
