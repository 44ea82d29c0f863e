! SPDX-License-Identifier: MIT
!> State of an integration point, and its place in STATEV.
module mud_state
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_kinds, only: wp
   use mud_params, only: options_t
   use mud_registry, only: NSTATV, NSTATV_BASE, NSTATV_WITHOUT_PRELOADING, NSTATV_WITHOUT_FLUIDITY, &
      STATE_LAYOUT, S_LAYOUT, &
      S_VOID_RATIO, S_SATURATION, S_SUCTION, S_STATE_PARAMETER, S_EPS_Q_P, S_EPS_Q_P_TOTAL, S_X_BEFORE, S_X_RUNNING, &
      S_TARGET, S_INTERRUPTED, S_OPEN, S_LAST_STEP, S_FABRIC, S_MEMORY, S_MEMORY_BEFORE, S_DIRECTION, S_N_RATE, &
      S_N_SUBSTEP, S_N_REJECT, S_N_RESET, S_N_GUARD, S_N_NO_ROOT, S_N_MIN_STEP, S_N_OPEN, S_N_TENSILE, &
      S_ELASTIC_DOMAIN, S_GAP, S_STACK, ENTRY_SIZE, MAX_INTERRUPTED, S_TURNS, S_N_CLEARED, S_TURN, MAX_TURNS, S_CHI, &
      S_CHI_OWN, S_CHI_STACK, S_MARGIN, S_FLUIDITY
   use mud_retention, only: turns_t, NO_TURNS
   use mud_status, only: mud_status_t, fail, MUD_BAD_STATE, MUD_BAD_NSTATV, ON_STATEV
   use mud_tensor, only: is_finite, all_finite, all_within, all_zero
   implicit none (type, external)
   private
   public :: memory_t, interrupted_t, state_t, counters_t, guard_count, pack_state, unpack_state, &
             unpack_turns, statev_size, check_size, E_LOWER, E_UPPER, E_OPEN

   real(wp), parameter :: E_LOWER = 0.01_wp, E_UPPER = 5.0_wp   !< Range of the void ratio without a gap [-].
   real(wp), parameter :: E_OPEN = 1.0e4_wp   !< Largest void ratio with a gap [-].

   real(wp), parameter :: LARGEST_RATIO = 1.0e11_wp       !< A stress ratio beyond it is no state [-].
   real(wp), parameter :: LARGEST_FABRIC = 1.0e6_wp       !< Magnitude of the fabric; z_max is at most 1e3 [-].
   real(wp), parameter :: LARGEST_FROM_CENTRE = 1.0_wp    !< Strain from the elastic domain's centre; rho_e <= 0.01 [-].
   real(wp), parameter :: LARGEST_LOG_SUCTION = 1.0e3_wp  !< ln of a double [-].
   real(wp), parameter :: LARGEST_CONTRACTION = 1.0e6_wp  !< Contraction of all processes: strains of 1e9 increments of
                                                          !< 1e-3 [-].
   real(wp), parameter :: LARGEST_FLUIDITY = 1.0e4_wp     !< ell_max is at most that [-].
   real(wp), parameter :: LARGEST_MARGIN = 1.0e3_wp       !< ln of a double [-].
   real(wp), parameter :: LARGEST_DIRECTION = 1.01_wp     !< Components of a unit tensor [-].
   !> Range of some entries of STATEV that follow each other, the same for each.
   type :: range_t
      integer :: first, last
      real(wp) :: lower, upper
   end type range_t

   !> In the order in which they are told. Of the void ratio it depends on the gap: here it has the largest.
   type(range_t), parameter :: RANGES(*) = [ &
      range_t(S_LAYOUT, S_LAYOUT, real(STATE_LAYOUT, wp), real(STATE_LAYOUT, wp)), &
      range_t(S_GAP, S_GAP, 0.0_wp, E_OPEN - E_LOWER), &
      range_t(S_MARGIN, S_MARGIN, -LARGEST_MARGIN, 0.0_wp), &
      range_t(S_VOID_RATIO, S_VOID_RATIO, E_LOWER, E_UPPER + E_OPEN - E_LOWER), &
      range_t(S_SATURATION, S_SATURATION, 0.0_wp, 1.0_wp), &
      range_t(S_INTERRUPTED, S_INTERRUPTED, 0.0_wp, real(MAX_INTERRUPTED, wp)), &
      range_t(S_OPEN, S_OPEN, 0.0_wp, 1.0_wp), &
      range_t(S_LAST_STEP, S_LAST_STEP, 0.0_wp, huge(1.0_wp)), &
      range_t(S_EPS_Q_P, S_EPS_Q_P, 0.0_wp, huge(1.0_wp)), &
      range_t(S_TARGET, S_TARGET, -LARGEST_RATIO, LARGEST_RATIO), &
      range_t(S_X_BEFORE, S_X_BEFORE, -LARGEST_RATIO, LARGEST_RATIO), &
      range_t(S_X_RUNNING, S_X_RUNNING, -LARGEST_RATIO, LARGEST_RATIO), &
      range_t(S_FABRIC, S_FABRIC + 5, -LARGEST_FABRIC, LARGEST_FABRIC), &
      range_t(S_MEMORY, S_MEMORY + 5, -LARGEST_RATIO, LARGEST_RATIO), &
      range_t(S_MEMORY_BEFORE, S_MEMORY_BEFORE + 5, -LARGEST_RATIO, LARGEST_RATIO), &
      range_t(S_DIRECTION, S_DIRECTION + 5, -LARGEST_DIRECTION, LARGEST_DIRECTION), &
      range_t(S_ELASTIC_DOMAIN, S_ELASTIC_DOMAIN + 5, -LARGEST_FROM_CENTRE, LARGEST_FROM_CENTRE)]
   integer, parameter :: ALWAYS = S_STACK - 1   !< Entries ahead of the interrupted processes.
   !> Counts and flags of every point: numbers that are not whole are the average of two states. First and last of those
   !> that follow each other.
   integer, parameter :: WHOLE_FIRST(2) = [S_INTERRUPTED, S_N_RATE], WHOLE_LAST(2) = [S_OPEN, S_N_TENSILE]
   real(wp), parameter :: ALL_WHOLE = 1.0_wp/epsilon(1.0_wp)   !< From here on numbers have no fraction.

   !> A loading process that was interrupted (rule return_point).
   type :: interrupted_t
      real(wp) :: r_in(6)      !< memory of the process [-]
      real(wp) :: direction(6) !< direction in which it moved r [-]
      real(wp) :: target       !< r:direction where the process was left [-]
      real(wp) :: chi          !< contraction of the process (cyclic preloading) [-]
   end type interrupted_t

   !> Memory of the loading processes of a point.
   type :: memory_t
      real(wp) :: r_in(6)      !< stress ratio where the present process began
      real(wp) :: r_before(6)  !< memory of the process before (rule threshold)
      real(wp) :: direction(6) !< direction in which the present process moves r (rule return_point)
      real(wp) :: target       !< r:direction that the present process has reached
      real(wp) :: eps_q_p      !< plastic shear of the present process
      real(wp) :: x_before     !< J
      real(wp) :: x_running    !< (r - r_in):n of the last accepted rate with x >= 0
      real(wp) :: chi          !< contraction of all processes that preloads, 0 without cyclic preloading
      real(wp) :: chi_own      !< the share of the present process in it
      integer :: depth         !< Number of interrupted processes.
      type(interrupted_t) :: interrupted(MAX_INTERRUPTED)   !< The oldest first; beyond depth without meaning.
   end type memory_t

   type :: state_t
      real(wp) :: sigma(6)     !< sigma' [kPa], compression positive
      real(wp) :: z(6)         !< fabric [-]
      real(wp) :: e            !< void ratio, with the gap [-]
      real(wp) :: gap          !< part of it that is gap between grains that have parted [-]
      real(wp) :: margin       !< margin of the isotropic memory, u <= 0 [-]
      real(wp) :: fluidity     !< 0 without that option [-]
      real(wp) :: p_c          !< suction [kPa]
      real(wp) :: s_w          !< degree of saturation [-]
      real(wp) :: psi          !< state parameter [-]
      real(wp) :: eps_q_total  !< plastic shear of all processes [-]
      real(wp) :: last_step    !< size of the substep proposed last, in units of strain [-]
      real(wp) :: from_centre(6)   !< strain from the centre of the elastic domain [-]
      logical :: open          !< held by the tension cut-off
      type(memory_t) :: memory
      type(turns_t) :: turns
   end type state_t

   !> Counters of what an update did, as struct mud_report of mud.h has them.
   type, bind(c) :: counters_t
      integer(c_int) :: rate = 0, substep = 0, reject = 0, reset = 0, floor = 0, cap_d = 0, cap_h = 0, held_back = 0, &
                 iso_kept = 0, no_root = 0, min_step = 0, open = 0, tensile = 0, cleared = 0
   end type counters_t
contains
   !> Numbers of a point in STATEV.
   pure integer function statev_size(options) result(n)
      type(options_t), intent(in) :: options

      n = merge(NSTATV_WITHOUT_PRELOADING, NSTATV_BASE, options%hysteresis)
      if (options%preloading) n = NSTATV_WITHOUT_FLUIDITY
      if (options%fluid) n = NSTATV
   end function statev_size

   !> Refuses fewer numbers of STATEV than a point has: MUD_BAD_NSTATV. Enough of them leave status as it is.
   pure subroutine check_size(n, options, status)
      integer, intent(in) :: n
      type(options_t), intent(in) :: options
      type(mud_status_t), intent(inout) :: status

      if (n < statev_size(options)) &
         status = fail(MUD_BAD_NSTATV, ON_STATEV, 0, real(n, wp), real(statev_size(options), wp), huge(1.0_wp))
   end subroutine check_size

   !> Reads a state from an initialised STATEV; the stress is set by the caller. statev(:) has at least the numbers of
   !> statev_size, else MUD_BAD_NSTATV; units as in mud_registry, tensors with the sign of the core. MUD_BAD_STATE names
   !> the first entry that is not finite, out of its range, or a count that is not whole (its value is then within the
   !> range of the status); the state is then of no use.
   pure subroutine unpack_state(statev, options, state, status)
      real(wp), intent(in), contiguous :: statev(:)
      type(options_t), intent(in) :: options
      type(state_t), intent(inout) :: state
      type(mud_status_t), intent(out) :: status
      integer :: used

      call check_size(size(statev), options, status)
      if (status%code /= 0) return
      used = ALWAYS + ENTRY_SIZE*stored_processes(statev)
      ! beyond the interrupted processes there are zeros
      if (.not. (is_sound(statev) .and. all_finite(statev(ALWAYS + 1:used)) .and. &
                 all_zero(statev(used + 1:NSTATV_BASE)))) call find_fault(statev, status)
      if (status%code /= 0) return
      call unpack_stack(statev, state%memory, status)
      call unpack_turns(statev, options, state%turns, status)
      call unpack_contraction(statev, options%preloading, state%memory, status)
      state%fluidity = 0.0_wp
      if (options%fluid) call require(statev, S_FLUIDITY, 0.0_wp, LARGEST_FLUIDITY, status)
      if (status%code /= 0) return
      if (options%fluid) state%fluidity = statev(S_FLUIDITY)

      state%e = statev(S_VOID_RATIO)
      state%gap = statev(S_GAP)
      state%margin = statev(S_MARGIN)
      state%s_w = statev(S_SATURATION)
      state%p_c = statev(S_SUCTION)
      state%psi = statev(S_STATE_PARAMETER)
      state%eps_q_total = statev(S_EPS_Q_P_TOTAL)
      state%last_step = statev(S_LAST_STEP)
      state%open = statev(S_OPEN) > 0.5_wp
      state%z = statev(S_FABRIC:S_FABRIC + 5)
      state%from_centre = statev(S_ELASTIC_DOMAIN:S_ELASTIC_DOMAIN + 5)
      state%memory%r_in = statev(S_MEMORY:S_MEMORY + 5)
      state%memory%r_before = statev(S_MEMORY_BEFORE:S_MEMORY_BEFORE + 5)
      state%memory%direction = statev(S_DIRECTION:S_DIRECTION + 5)
      state%memory%target = statev(S_TARGET)
      state%memory%eps_q_p = statev(S_EPS_Q_P)
      state%memory%x_before = statev(S_X_BEFORE)
      state%memory%x_running = statev(S_X_RUNNING)
   end subroutine unpack_state

   !> True where all is well with the entries of every point; not always where it is. Without a branch for each.
   pure logical function is_sound(statev)
      real(wp), intent(in) :: statev(ALWAYS)
      integer(int64) :: fractions
      integer :: i, k
      !> RANGES entry by entry, side by side; -huge and huge of an entry that has none.
      real(wp), parameter :: LOWER(ALWAYS) = [(maxval(RANGES%lower, RANGES%first <= i .and. i <= RANGES%last), &
         i=1, ALWAYS)]
      real(wp), parameter :: UPPER(ALWAYS) = [(minval(RANGES%upper, RANGES%first <= i .and. i <= RANGES%last), &
         i=1, ALWAYS)]
      real(wp), parameter :: LIMITS(ALWAYS) = max(abs(LOWER), abs(UPPER))
      !> Entries of which not only the magnitude has a limit.
      integer, parameter :: ONE_SIDED(*) = pack([(i, i=1, ALWAYS)], abs(LOWER + UPPER) > 0.0_wp)

      is_sound = all_within(ALWAYS, statev, LIMITS)
      if (.not. is_sound) return   ! what is not a number is not compared
      fractions = 0
      do k = 1, size(WHOLE_FIRST)
         do i = WHOLE_FIRST(k), WHOLE_LAST(k)
            fractions = ior(fractions, transfer(abs(rounding(abs(statev(i)))), 0_int64))
         end do
      end do
      is_sound = fractions == 0 .and. statev(S_VOID_RATIO) <= largest_void_ratio(statev)
      do k = 1, size(ONE_SIDED)
         i = ONE_SIDED(k)
         is_sound = is_sound .and. statev(i) >= LOWER(i) .and. statev(i) <= UPPER(i)
      end do
   end function is_sound

   !> Rounding of a finite number x >= 0 to a whole one: 0 only if it is whole, and always so below ALL_WHOLE. Rounds
   !> without a call.
   pure real(wp) function rounding(x)
      real(wp), intent(in) :: x

      rounding = ((x + ALL_WHOLE) - ALL_WHOLE) - x
   end function rounding

   !> The first entry with a fault is kept in the status, which is that of unpack_state; a sound state leaves it.
   pure subroutine find_fault(statev, status)
      real(wp), intent(in), contiguous :: statev(:)
      type(mud_status_t), intent(inout) :: status
      integer :: i, k

      i = findloc(is_finite(statev(1:NSTATV_BASE)), .false., dim=1)
      if (i > 0) then
         status = fail(MUD_BAD_STATE, ON_STATEV, i, statev(i), -huge(1.0_wp), huge(1.0_wp))
         return
      end if
      do k = 1, size(RANGES)
         do i = RANGES(k)%first, RANGES(k)%last
            call require(statev, i, RANGES(k)%lower, &
                         merge(largest_void_ratio(statev), RANGES(k)%upper, i == S_VOID_RATIO), status)
         end do
      end do
      do k = 1, size(WHOLE_FIRST)
         do i = WHOLE_FIRST(k), WHOLE_LAST(k)
            call require_whole(statev, i, status)
         end do
      end do
   end subroutine find_fault

   !> Largest void ratio of a point with the gap that it has [-].
   pure real(wp) function largest_void_ratio(statev)
      real(wp), intent(in) :: statev(ALWAYS)

      largest_void_ratio = E_UPPER + statev(S_GAP)
   end function largest_void_ratio

   !> Reads the interrupted processes; places beyond their number are not looked at.
   pure subroutine unpack_stack(statev, memory, status)
      real(wp), intent(in), contiguous :: statev(:)
      type(memory_t), intent(inout) :: memory
      type(mud_status_t), intent(inout) :: status
      integer :: k, first

      memory%depth = stored_processes(statev)
      do k = 1, memory%depth
         first = S_STACK + ENTRY_SIZE*(k - 1)
         call require_tensor(statev, first, LARGEST_RATIO, status)
         call require_tensor(statev, first + 6, LARGEST_DIRECTION, status)
         call require(statev, first + 12, -LARGEST_RATIO, LARGEST_RATIO, status)
         memory%interrupted(k)%r_in = statev(first:first + 5)
         memory%interrupted(k)%direction = statev(first + 6:first + 11)
         memory%interrupted(k)%target = statev(first + 12)
      end do
   end subroutine unpack_stack

   !> Reads the contraction of the processes of cyclic preloading; of a stack that is read. Nothing is 0 without it.
   pure subroutine unpack_contraction(statev, preloading, memory, status)
      real(wp), intent(in) :: statev(:)
      logical, intent(in) :: preloading
      type(memory_t), intent(inout) :: memory
      type(mud_status_t), intent(inout) :: status
      integer :: k

      memory%chi = 0.0_wp
      memory%chi_own = 0.0_wp
      memory%interrupted%chi = 0.0_wp
      if (.not. preloading .or. status%code /= 0) return
      do k = S_CHI, S_CHI_STACK - 1 + memory%depth
         call require(statev, k, 0.0_wp, LARGEST_CONTRACTION, status)
      end do
      if (status%code /= 0) return
      memory%chi = statev(S_CHI)
      memory%chi_own = statev(S_CHI_OWN)
      memory%interrupted(:memory%depth)%chi = statev(S_CHI_STACK:S_CHI_STACK - 1 + memory%depth)
   end subroutine unpack_contraction

   !> Writes the contraction of the processes; unused places become zero.
   pure subroutine pack_contraction(memory, statev)
      type(memory_t), intent(in) :: memory
      real(wp), intent(inout) :: statev(:)

      statev(S_CHI) = memory%chi
      statev(S_CHI_OWN) = memory%chi_own
      statev(S_CHI_STACK:NSTATV_WITHOUT_FLUIDITY) = 0.0_wp
      statev(S_CHI_STACK:S_CHI_STACK - 1 + memory%depth) = memory%interrupted(:memory%depth)%chi
   end subroutine pack_contraction

   !> Reads the turning points of suction, with hysteresis; places beyond their number are not looked at. No number, of
   !> a state that had no hysteresis: none.
   pure subroutine unpack_turns(statev, options, turns, status)
      real(wp), intent(in) :: statev(:)
      type(options_t), intent(in) :: options
      type(turns_t), intent(inout) :: turns
      type(mud_status_t), intent(inout) :: status
      integer :: k, i

      if (.not. options%hysteresis) return
      i = findloc(is_finite(statev(S_TURNS:NSTATV_WITHOUT_PRELOADING)), .false., dim=1)
      if (i > 0 .and. status%code == 0) &
         status = fail(MUD_BAD_STATE, ON_STATEV, S_TURNS - 1 + i, statev(S_TURNS - 1 + i), -huge(1.0_wp), huge(1.0_wp))
      if (status%code /= 0) return
      call require(statev, S_TURNS, -real(1 + MAX_TURNS, wp), real(1 + MAX_TURNS, wp), status)
      call require_whole(statev, S_TURNS, status)
      call require_whole(statev, S_N_CLEARED, status)
      turns = NO_TURNS
      if (status%code /= 0) return
      turns%dries = statev(S_TURNS) >= 0.0_wp
      turns%depth = max(nint(abs(statev(S_TURNS))) - 1, 0)
      do k = 1, turns%depth
         call require(statev, S_TURN + 2*k - 2, -LARGEST_LOG_SUCTION, LARGEST_LOG_SUCTION, status)
         call require(statev, S_TURN + 2*k - 1, 0.0_wp, 1.0_wp, status)
         turns%log_x(k) = statev(S_TURN + 2*k - 2)
         turns%s_w(k) = statev(S_TURN + 2*k - 1)
      end do
   end subroutine unpack_turns

   !> Writes the turning points; unused places become zero.
   pure subroutine pack_turns(turns, statev)
      type(turns_t), intent(in) :: turns
      real(wp), intent(inout) :: statev(:)
      integer :: k

      statev(S_TURNS) = real(merge(1, -1, turns%dries)*(1 + turns%depth), wp)
      statev(S_TURN:NSTATV_WITHOUT_PRELOADING) = 0.0_wp
      do k = 1, turns%depth
         statev(S_TURN + 2*k - 2) = turns%log_x(k)
         statev(S_TURN + 2*k - 1) = turns%s_w(k)
      end do
   end subroutine pack_turns

   !> Writes the interrupted processes; unused places become zero.
   pure subroutine pack_stack(memory, statev)
      type(memory_t), intent(in) :: memory
      real(wp), intent(inout) :: statev(:)
      integer :: k, first

      statev(S_INTERRUPTED) = real(memory%depth, wp)
      statev(S_STACK:S_STACK + ENTRY_SIZE*MAX_INTERRUPTED - 1) = 0.0_wp
      do k = 1, memory%depth
         first = S_STACK + ENTRY_SIZE*(k - 1)
         statev(first:first + 5) = memory%interrupted(k)%r_in
         statev(first + 6:first + 11) = memory%interrupted(k)%direction
         statev(first + 12) = memory%interrupted(k)%target
      end do
   end subroutine pack_stack

   !> Keeps the first entry that is out of its range.
   pure subroutine require(statev, entry, lower, upper, status)
      real(wp), intent(in) :: statev(:)
      integer, intent(in) :: entry
      real(wp), intent(in) :: lower, upper
      type(mud_status_t), intent(inout) :: status

      if (status%code /= 0) return
      if (statev(entry) >= lower .and. statev(entry) <= upper) return   ! and never where it is not a number
      status = fail(MUD_BAD_STATE, ON_STATEV, entry, statev(entry), lower, upper)
   end subroutine require

   !> Requires that a finite number of STATEV is whole; the status names the range that holds it.
   pure subroutine require_whole(statev, entry, status)
      real(wp), intent(in) :: statev(:)
      integer, intent(in) :: entry
      type(mud_status_t), intent(inout) :: status

      if (status%code /= 0) return
      if (abs(statev(entry)) >= ALL_WHOLE) return
      if (abs(rounding(abs(statev(entry)))) <= 0.0_wp) return
      status = fail(MUD_BAD_STATE, ON_STATEV, entry, statev(entry), -huge(1.0_wp), huge(1.0_wp))
   end subroutine require_whole

   !> Requires that the six components of a tensor of STATEV are finite and of a magnitude up to a limit.
   pure subroutine require_tensor(statev, first, limit, status)
      real(wp), intent(in), contiguous :: statev(:)
      integer, intent(in) :: first   !< Entry of the first.
      real(wp), intent(in) :: limit
      type(mud_status_t), intent(inout) :: status
      integer :: i
      logical :: within

      within = .true.
      do i = first, first + 5
         within = within .and. abs(statev(i)) <= limit
      end do
      if (within) return
      do i = first, first + 5
         call require(statev, i, -limit, limit, status)
      end do
   end subroutine require_tensor

   !> Number of interrupted processes in STATEV; 0 where that is no such number.
   pure integer function stored_processes(statev) result(n)
      real(wp), intent(in) :: statev(:)

      n = 0
      if (.not. is_finite(statev(S_INTERRUPTED))) return
      if (statev(S_INTERRUPTED) > 0.0_wp .and. statev(S_INTERRUPTED) <= real(MAX_INTERRUPTED, wp)) &
         n = nint(statev(S_INTERRUPTED))
   end function stored_processes

   !> Writes a state and the sums of the counters to STATEV; the tangent outputs are the caller's. statev(:) has at
   !> least the numbers of statev_size, which is not checked; units as in mud_registry, tensors with the sign of the
   !> core.
   pure subroutine pack_state(state, options, counters, statev)
      type(state_t), intent(in) :: state
      type(options_t), intent(in) :: options
      type(counters_t), intent(in) :: counters
      real(wp), intent(inout) :: statev(:)   !< Holds the totals so far.

      statev(S_LAYOUT) = real(STATE_LAYOUT, wp)
      statev(S_VOID_RATIO) = state%e
      statev(S_GAP) = state%gap
      statev(S_MARGIN) = state%margin
      statev(S_SATURATION) = state%s_w
      statev(S_SUCTION) = state%p_c
      statev(S_STATE_PARAMETER) = state%psi
      statev(S_EPS_Q_P_TOTAL) = state%eps_q_total
      statev(S_LAST_STEP) = state%last_step
      statev(S_OPEN) = merge(1.0_wp, 0.0_wp, state%open)
      statev(S_FABRIC:S_FABRIC + 5) = state%z
      statev(S_ELASTIC_DOMAIN:S_ELASTIC_DOMAIN + 5) = state%from_centre
      statev(S_MEMORY:S_MEMORY + 5) = state%memory%r_in
      statev(S_MEMORY_BEFORE:S_MEMORY_BEFORE + 5) = state%memory%r_before
      statev(S_DIRECTION:S_DIRECTION + 5) = state%memory%direction
      statev(S_TARGET) = state%memory%target
      statev(S_EPS_Q_P) = state%memory%eps_q_p
      statev(S_X_BEFORE) = state%memory%x_before
      statev(S_X_RUNNING) = state%memory%x_running
      call pack_stack(state%memory, statev)

      statev(S_N_RATE) = statev(S_N_RATE) + counters%rate
      statev(S_N_SUBSTEP) = statev(S_N_SUBSTEP) + counters%substep
      statev(S_N_REJECT) = statev(S_N_REJECT) + counters%reject
      statev(S_N_RESET) = statev(S_N_RESET) + counters%reset
      statev(S_N_GUARD) = statev(S_N_GUARD) + guard_count(counters)
      statev(S_N_NO_ROOT) = statev(S_N_NO_ROOT) + counters%no_root
      statev(S_N_MIN_STEP) = statev(S_N_MIN_STEP) + counters%min_step
      statev(S_N_OPEN) = statev(S_N_OPEN) + counters%open
      statev(S_N_TENSILE) = statev(S_N_TENSILE) + counters%tensile
      if (options%preloading) call pack_contraction(state%memory, statev)
      if (options%fluid) statev(S_FLUIDITY) = state%fluidity
      if (.not. options%hysteresis) return
      call pack_turns(state%turns, statev)
      statev(S_N_CLEARED) = statev(S_N_CLEARED) + counters%cleared
   end subroutine pack_state

   !> Number of times that a guard acted: floor, caps, hysteresis of the reversal test, the isotropic mechanism that
   !> contradicts itself.
   pure integer function guard_count(counters)
      type(counters_t), intent(in) :: counters

      guard_count = counters%floor + counters%cap_d + counters%cap_h + counters%held_back + counters%iso_kept
   end function guard_count
end module mud_state
