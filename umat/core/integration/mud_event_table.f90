! SPDX-License-Identifier: MIT
!> The events inside a substep, a row each: whose substeps it concerns, which rate its function looks at, how it is
!> located. The functions are mud_event_functions, their derivatives mud_event_time; what an event leads to is
!> mud_transitions. docs/theory/integration.md section 4.2.
module mud_event_table
   use mud_cutoff, only: MODE_HELD
   use mud_kinds, only: wp
   use mud_rates, only: MODE_ORDINARY
   implicit none (type, external)
   private
   public :: event_t, EVENTS, NO_RATE, RATE_THERE, RATE_IF_CLOSED, BEFORE, AT, BEYOND
   public :: EVENT_NONE, EVENT_OPENS, EVENT_CLOSES, EVENT_BOUNDS, EVENT_MECHANISM, EVENT_REVERSAL, EVENT_RETURN, &
             EVENT_TURN, EVENT_PARTS, EVENT_YIELD, EVENT_UNLOAD, EVENT_FORWARDS, EVENT_DILATES

   ! in the order in which they are looked for
   integer, parameter :: EVENT_NONE = 0
   integer, parameter :: EVENT_OPENS = 1      !< p' falls to p_min.
   integer, parameter :: EVENT_PARTS = 2      !< The gap of a held point begins or ends: in closed form.
   integer, parameter :: EVENT_CLOSES = 3     !< p' would rise from p_min.
   integer, parameter :: EVENT_BOUNDS = 4     !< r exceeds the bounding surface inside the elastic domain.
   integer, parameter :: EVENT_MECHANISM = 5  !< The isotropic mechanism begins or ends to act while suction changes.
   integer, parameter :: EVENT_DILATES = 6    !< Contraction turns to dilation or back, with cyclic preloading.
   integer, parameter :: EVENT_YIELD = 7      !< Compression reaches what the isotropic mechanism remembers.
   integer, parameter :: EVENT_UNLOAD = 8     !< Compression ceases; the isotropic mechanism remembers how far it came.
   integer, parameter :: EVENT_REVERSAL = 9   !< (r - r_in):n falls to -x_rev.
   integer, parameter :: EVENT_RETURN = 10     !< r reaches the target of an interrupted process.
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

   type :: event_t
      logical :: concerns(MODE_ORDINARY:MODE_HELD)   !< Substeps that are ordinary, elastic, held.
      integer :: looks_at                            !< NO_RATE, RATE_THERE, RATE_IF_CLOSED
      integer :: side                                !< Where the substep ends: BEFORE, AT, BEYOND.
      logical :: moves      !< The time of the event counts in a derivative: rates are not smooth there.
      real(wp) :: residual  !< Share of its change below which the function is zero [-].
      integer :: trials     !< At most.
   end type event_t

   logical, parameter, dimension(MODE_ORDINARY:MODE_HELD) :: NOBODY = [.false., .false., .false.], &
      ORDINARY = [.true., .false., .false.], ELASTIC = [.false., .true., .false.], HELD = [.false., .false., .true.]

   type(event_t), parameter :: EVENTS(EVENT_NONE:EVENT_TURN) = [ &
      event_t(NOBODY, NO_RATE, AT, .false., EXACT, EXACT_TRIALS), &
      event_t(ORDINARY .or. ELASTIC, NO_RATE, AT, .true., EXACT, EXACT_TRIALS), &   ! opens
      event_t(HELD, NO_RATE, AT, .true., EXACT, EXACT_TRIALS), &                    ! parts, or the gap shuts
      event_t(HELD, RATE_IF_CLOSED, BEYOND, .true., EXACT, EXACT_TRIALS), &      ! closes
      event_t(ELASTIC, NO_RATE, AT, .true., EXACT, EXACT_TRIALS), &                 ! exceeds the bounding surface
      event_t(ORDINARY, RATE_THERE, BEFORE, .true., EXACT, EXACT_TRIALS), &         ! the isotropic mechanism switches
      event_t(ORDINARY, RATE_THERE, BEFORE, .true., EXACT, EXACT_TRIALS), &         ! contraction turns to dilation
      event_t(ORDINARY .or. ELASTIC, NO_RATE, BEYOND, .true., EXACT, EXACT_TRIALS), &     ! isotropic mechanism yields
      event_t(ORDINARY .or. ELASTIC, RATE_THERE, BEYOND, .false., EXACT, EXACT_TRIALS), & ! and unloads
      event_t(ORDINARY, RATE_THERE, AT, .true., EXACT, EXACT_TRIALS), &             ! reverses
      event_t(ORDINARY, NO_RATE, AT, .true., EXACT, EXACT_TRIALS), &                ! returns
      event_t(ORDINARY, RATE_THERE, AT, .true., EXACT, 8), &                        ! goes forwards
      event_t(NOBODY, RATE_THERE, AT, .false., NEARLY, FEW_TRIALS)]                 ! ceases to go forwards
end module mud_event_table
