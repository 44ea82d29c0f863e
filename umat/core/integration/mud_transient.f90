! SPDX-License-Identifier: MIT
!> Parts that the turn of the elastic domain adds to the rates: two, which fade as exp(-k t) and exp(-2 k t), k =
!> |a|/rho, faster than anything else changes. A pair integrates what is left of the rates, the parts are integrated
!> exactly. Whatever the parts are, the order of the pair stays; docs/theory/integration.md section 2.2.
module mud_transient
   use mud_increment, only: increment_t, rate_of, store_rate, direction_at, has_elastic_part, STRAIGHT
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: MODE_ORDINARY
   use mud_state, only: counters_t
   use mud_tensor, only: norm
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: transient_t, find_transient, begin_transient, take_far, take_half, &
             without_turn, half_way, split, take_fading, add_faded

   !> Rates that fade, per unit of pseudo-time.
   type :: transient_t
      logical :: sought = .false.   !< The parts were looked for ...
      logical :: known = .false.    !< ... and found.
      integer :: terms              !< 0: the strain does not turn, nothing fades but what changes of it would; 1, 2.
      real(wp) :: since             !< Pseudo-time from which they fade [-].
      real(wp) :: speed             !< k [-]
      real(wp) :: across            !< Twice the sine of half the angle of the turn [-].
      real(wp) :: parts(NY, 2)
      type(rate_t) :: far, half     !< Rates from the same start without the turn; half-way, where there are two terms.
   end type transient_t

   real(wp), parameter :: LN_2 = log(2.0_wp)   !< k t at which the first part has fallen to a half [-].
   !> Shorter attempts, as shares of the radius, follow the turn as it is, and so does a last piece that ends before the
   !> turn is half-way [-].
   real(wp), parameter :: LONG = 0.3_wp
   !> The second part, of the second power of the angle, is left out where the stress that the centre lags behind moves
   !> by less than this share of the tolerance [-].
   real(wp), parameter :: ONE_TERM = 0.1_wp
   !> 1 minus the cosine of the angle, 60 degrees, beyond which two parts do not describe the turn [-].
   real(wp), parameter :: LARGEST = 0.5_wp
contains
   !> Looks for the parts at the start of an attempt h that is ordinary, from its first rate. time and h are shares of
   !> inc [-]. docs/theory/integration.md section 2.2.
   pure subroutine find_transient(par, inc, time, h, y0, r_in, first, transient, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, h, y0(NY), r_in(6)
      type(rate_t), intent(in) :: first
      type(transient_t), intent(inout) :: transient
      type(counters_t), intent(inout) :: counters
      logical :: more

      call begin_transient(inc, time, h, first, transient, more)
      if (.not. more) return
      call rate_of(par, without_turn(inc), time, y0, r_in, MODE_ORDINARY, transient%far, counters, first)
      call take_far(par, inc, y0, first, transient, more)
      if (.not. more) return
      call rate_of(par, inc, half_way(transient), y0, r_in, MODE_ORDINARY, transient%half, counters, first)
      call take_half(first, transient)
   end subroutine find_transient

   !> Whether there are parts; more: the rate `far` is needed for them.
   pure subroutine begin_transient(inc, time, h, first, transient, more)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, h
      type(rate_t), intent(in) :: first
      type(transient_t), intent(inout) :: transient
      logical, intent(out) :: more
      real(wp) :: length

      more = .false.
      if (transient%sought .or. .not. has_elastic_part(inc, MODE_ORDINARY) .or. .not. first%loading) return
      length = inc%length
      if (length*h < LONG*inc%rho .or. length*(inc%to - time) < LN_2*inc%rho) return
      transient%across = 0.0_wp
      if (.not. inc%straight) transient%across = norm(direction_at(inc, time) - inc%d_strain/length)
      if (0.5_wp*transient%across**2 > LARGEST) return
      transient%sought = .true.
      transient%known = .true.
      transient%since = time
      transient%speed = length/inc%rho
      transient%parts = 0.0_wp
      transient%terms = 0
      more = transient%across >= STRAIGHT
   end subroutine begin_transient

   !> One part, from the rate `far`; more: the rate `half` is needed for a second one.
   pure subroutine take_far(par, inc, y0, first, transient, more)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: y0(NY)
      type(rate_t), intent(in) :: first
      type(transient_t), intent(inout) :: transient
      logical, intent(out) :: more
      real(wp) :: now(NY), far(NY)

      transient%known = transient%far%loading
      call store_rate(first, now)
      call store_rate(transient%far, far)
      transient%terms = 1
      transient%parts(:, 1) = now - far
      more = 2.0_wp*first%g*inc%rho*transient%across**2 >= ONE_TERM*par%tolerance*norm(y0(1:6))
   end subroutine take_far

   !> Two parts, from the rate `half` too.
   pure subroutine take_half(first, transient)
      type(rate_t), intent(in) :: first
      type(transient_t), intent(inout) :: transient
      real(wp) :: now(NY), far(NY), half(NY)

      call store_rate(first, now)
      call store_rate(transient%far, far)
      transient%known = transient%known .and. transient%half%loading
      call store_rate(transient%half, half)
      transient%terms = 2
      call split(now, far, half, transient%parts(:, 1), transient%parts(:, 2))
   end subroutine take_half

   !> The increment whose whole strain loads.
   pure function without_turn(inc) result(straight)
      type(increment_t), intent(in) :: inc
      type(increment_t) :: straight

      straight = inc
      straight%rho = 0.0_wp
   end function without_turn

   !> The pseudo-time half-way through the turn [-].
   pure real(wp) function half_way(transient)
      type(transient_t), intent(in) :: transient

      half_way = transient%since + LN_2/transient%speed
   end function half_way

   !> Both parts from what rates are now, when the turn is over, and half-way: those of a polynomial in exp(-k t).
   pure elemental subroutine split(now, far, half, first, second)
      real(wp), intent(in) :: now, far, half
      real(wp), intent(out) :: first, second

      second = 2.0_wp*(now + far - 2.0_wp*half)
      first = now - far - second
   end subroutine split

   !> Takes from a rate at a pseudo-time [-] what fades of it. rate as the integrated vector, per unit of pseudo-time.
   !> docs/theory/integration.md section 2.2.
   pure subroutine take_fading(transient, time, rate)
      type(transient_t), intent(in) :: transient
      real(wp), intent(in) :: time
      real(wp), intent(inout) :: rate(NY)
      real(wp) :: left

      if (transient%terms == 0) return
      left = exp(-transient%speed*(time - transient%since))
      rate = rate - left*(transient%parts(:, 1) + left*transient%parts(:, 2))
   end subroutine take_fading

   !> Adds to a vector what fades between two pseudo-times [-]. y as the integrated vector.
   !> docs/theory/integration.md section 2.2.
   pure subroutine add_faded(transient, from, to, y)
      type(transient_t), intent(in) :: transient
      real(wp), intent(in) :: from, to
      real(wp), intent(inout) :: y(NY)
      real(wp) :: before, after

      if (transient%terms == 0) return
      before = exp(-transient%speed*(from - transient%since))
      after = exp(-transient%speed*(to - transient%since))
      y = y + ((before - after)/transient%speed) &
          *(transient%parts(:, 1) + (0.5_wp*(before + after))*transient%parts(:, 2))
   end subroutine add_faded
end module mud_transient
