! SPDX-License-Identifier: MIT
!> Paths that the benchmarks walk along, through the doors of mud.h and through the rate itself.
module benchmark_walk
   use, intrinsic :: iso_c_binding, only: c_int, c_long, c_double, c_null_char, c_loc
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_bonding, only: suction_law_t, is_bonded, bonding
   use mud_interface, only: mud_default_props, mud_prepared_size, mud_prepare, mud_init, mud_update, &
      mud_update_points, mud_points, mud_blocks, mud_index, mud_count, mud_report, MUD_PROPS, &
      MUD_STATEV, MUD_TANGENT_NONE
   use mud_params, only: params_t, read_params
   use mud_preloading, only: NO_CONTRACTION
   use mud_rates, only: rate_at, conditions_t, MODE_ORDINARY
   use mud_rate, only: rate_t
   use mud_registry, only: NPROPS, NSTATV
   use mud_status, only: mud_status_t
   use mud_tensor, only: ddot, norm
   implicit none (type, external)
   private
   public :: wp, path_t, PATHS, path_named, tally_t, walk, walk_batch, evaluate_rates, met_rates_t, &
             meet_rates, evaluate_met_rates, number_of_updates

   integer, parameter :: wp = c_double, WORDS = max(NPROPS, NSTATV)   !< Room for PROPS and STATEV.
   real(wp), parameter :: RIGHT_ANGLE = acos(0.0_wp)
   real(wp), parameter :: LONGEST = 0.05_wp           !< A walk ends here [-] ...
   integer, parameter :: MOST_UPDATES = 500           !< ... or after so many updates.

   !> From an effective stress along a strain that turns from one direction to another. Tension positive.
   type :: path_t
      character(24) :: name
      real(wp) :: stress(6), void_ratio, suction
      real(wp) :: from(6), to(6)      !< engineering shear, for a strain of 1
      real(wp) :: d_suction           !< for a strain of 1 [kPa]
   end type path_t

   real(wp), parameter :: EQUAL(6) = [-1.0_wp, -1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   real(wp), parameter :: GENERAL(6) = [-130.0_wp, -90.0_wp, -80.0_wp, -12.0_wp, 9.0_wp, -6.0_wp]
   real(wp), parameter :: UNDRAINED(6) = [-1.0_wp, 0.5_wp, 0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   real(wp), parameter :: TURN_FROM(6) = [-1.0_wp, 0.4_wp, 0.5_wp, -0.6_wp, 0.4_wp, -0.3_wp]
   real(wp), parameter :: TURN_TO(6) = [0.2_wp, -0.5_wp, 0.2_wp, 1.0_wp, -0.8_wp, -0.6_wp]
   !> The dense undrained test and the unsaturated one of docs/theory/integration.md section 6.1; the same two states
   !> sheared in six components, the unsaturated one while it is wetted.
   type(path_t), parameter :: PATHS(4) = [ &
      path_t('saturated', 100.0_wp*EQUAL, 0.735_wp, 0.0_wp, UNDRAINED, UNDRAINED, 0.0_wp), &
      path_t('unsaturated', 20.0_wp*EQUAL, 0.8_wp, 100.0_wp, UNDRAINED, UNDRAINED, 0.0_wp), &
      path_t('saturated_turning', GENERAL, 0.735_wp, 0.0_wp, TURN_FROM, TURN_TO, 0.0_wp), &
      path_t('unsaturated_turning', GENERAL, 0.8_wp, 100.0_wp, TURN_FROM, TURN_TO, -500.0_wp)]

   !> What a walk took.
   type :: tally_t
      integer(int64) :: nanoseconds = 0
      integer :: rates = 0, updates = 0
   end type tally_t

   !> Arguments of a rate that a random walk has met.
   type :: met_rates_t
      type(params_t) :: par
      real(wp) :: stress(6), void_ratio, z(6), r_in(6), d_strain(6)
   end type met_rates_t
   integer, parameter :: MET = 400   !< So many of each kind.

   !> struct timespec and the clocks of POSIX, as Linux numbers them. A thread's own time does not run while another
   !> program has the processor; a batch is timed by the clock on the wall.
   type, bind(c) :: timespec_t
      integer(c_long) :: seconds, nanoseconds
   end type timespec_t
   integer(c_int), parameter :: ON_THE_WALL = 1, OF_THIS_THREAD = 3
   interface
      integer(c_int) function clock_gettime(clock, time) bind(c)
         import :: c_int, timespec_t
         integer(c_int), value :: clock
         type(timespec_t), intent(out) :: time
      end function clock_gettime
   end interface

   !> The last numbers of a rate's vector without cyclic preloading and fluidity.
   real(wp), parameter :: NO_EFFECTS(4) = [0.0_wp, NO_CONTRACTION, 0.0_wp, 0.0_wp]
contains
   !> A failure of the library here is a fault of the benchmark: it ends the program.
   type(path_t) function path_named(name) result(path)
      character(*), intent(in) :: name
      integer :: i

      do i = 1, size(PATHS)
         if (PATHS(i)%name /= name) cycle
         path = PATHS(i)
         return
      end do
      error stop 'benchmark: unknown path'
   end function path_named

   pure integer function number_of_updates(strain) result(n)
      real(wp), intent(in) :: strain   !< of one update [-]

      n = min(nint(LONGEST/strain), MOST_UPDATES)
   end function number_of_updates

   !> Strain of update i of n [-].
   pure function strain_of(path, i, n, strain) result(d_strain)
      type(path_t), intent(in) :: path
      integer, intent(in) :: i, n
      real(wp), intent(in) :: strain
      real(wp) :: d_strain(6), angle

      angle = RIGHT_ANGLE*real(i - 1, wp)/real(n, wp)
      d_strain = strain*(cos(angle)*path%from + sin(angle)*path%to)
      if (all(abs(path%from - path%to) <= 0.0_wp)) d_strain = strain*path%from
   end function strain_of

   subroutine start(path, scheme, tolerance, domain, props, n_props, material, stress, statev, n_statev, zero)
      type(path_t), intent(in) :: path
      integer, intent(in) :: scheme
      real(wp), intent(in) :: tolerance
      logical, intent(in) :: domain   !< With the elastic domain of the default material; otherwise without any.
      real(wp), intent(out) :: props(WORDS), material(:), stress(6), statev(WORDS)
      integer(c_int), intent(out) :: n_props, n_statev
      character(*), intent(in), optional :: zero   !< Name of a parameter that is 0.
      character :: text(1)
      integer(c_int) :: code

      n_props = mud_count(MUD_PROPS)
      n_statev = mud_count(MUD_STATEV)
      code = mud_default_props(props, n_props)
      props(mud_index(MUD_PROPS, 'scheme'//c_null_char) + 1) = real(scheme, wp)
      props(mud_index(MUD_PROPS, 'tolerance'//c_null_char) + 1) = tolerance
      if (.not. domain) props(mud_index(MUD_PROPS, 'rho_e'//c_null_char) + 1) = 0.0_wp
      if (present(zero)) then
         code = mud_index(MUD_PROPS, trim(zero)//c_null_char)
         if (code < 0 .and. zero /= '-' .and. zero /= '') error stop 'benchmark: there is no such parameter'
         if (code >= 0) props(code + 1) = 0.0_wp
      end if
      stress = path%stress
      statev = 0.0_wp
      code = mud_prepare(props, n_props, material, size(material, kind=c_int), text, 0_c_int)
      if (code == 0) code = mud_init(material, stress, path%suction, path%void_ratio, 0.0_wp, statev, n_statev, text, &
                                     0_c_int)
      if (code /= 0) error stop 'benchmark: a start is not accepted'
   end subroutine start

   !> One point along a path, timed from its first update to its last.
   subroutine walk(path, strain, scheme, tolerance, tangent, tally, domain, zero)
      type(path_t), intent(in) :: path
      real(wp), intent(in) :: strain, tolerance
      integer, intent(in) :: scheme, tangent
      type(tally_t), intent(out) :: tally
      logical, intent(in) :: domain     !< With the elastic domain of the default material; otherwise without any.
      character(*), intent(in), optional :: zero   !< Name of a parameter that is 0.
      real(wp) :: props(WORDS), stress(6), statev(WORDS), suction, d_suction, d_strain(6)
      real(wp) :: material(mud_prepared_size())
      real(wp), allocatable :: steps(:, :)
      type(mud_blocks) :: blocks
      type(mud_report) :: report
      integer(c_int) :: n_props, n_statev, code
      integer(int64) :: before, after
      integer :: i

      call start(path, scheme, tolerance, domain, props, n_props, material, stress, statev, n_statev, zero)
      tally%updates = number_of_updates(strain)
      allocate (steps(6, tally%updates))
      do i = 1, tally%updates
         steps(:, i) = strain_of(path, i, tally%updates, strain)
      end do
      suction = path%suction
      d_suction = strain*path%d_suction
      before = now(OF_THIS_THREAD)
      do i = 1, tally%updates
         d_strain = steps(:, i)
         suction = suction + d_suction
         code = mud_update(material, stress, statev, n_statev, d_strain, suction, int(tangent, c_int), stress, statev, &
                           blocks, report)
         if (code /= 0) error stop 'benchmark: an update failed'
         tally%rates = tally%rates + report%n_rate
      end do
      after = now(OF_THIS_THREAD)
      tally%nanoseconds = after - before
   end subroutine walk

   !> Many points side by side along a path, each from its own place on it.
   subroutine walk_batch(path, strain, scheme, tolerance, tangent, threads, points, tally)
      type(path_t), intent(in) :: path
      real(wp), intent(in) :: strain, tolerance
      integer, intent(in) :: scheme, tangent, threads, points
      type(tally_t), intent(out) :: tally
      real(wp), dimension(:, :), allocatable, target :: stress, statev, d_strain, c_pc, sw_e
      real(wp), allocatable, target :: c(:, :, :), suction(:), sw_pc(:)
      type(mud_report), allocatable, target :: reports(:)
      integer(c_int), allocatable, target :: status(:)
      type(mud_points) :: mesh
      real(wp) :: props(WORDS), material(mud_prepared_size()), one(6), state(WORDS)
      integer(c_int) :: n_props, n_statev, failed
      integer(int64) :: before, after
      integer :: i

      call start(path, scheme, tolerance, .true., props, n_props, material, one, state, n_statev)
      allocate (stress(6, points), statev(n_statev, points), d_strain(6, points), c(6, 6, points), c_pc(6, points), &
                sw_e(6, points), suction(points), sw_pc(points), reports(points), status(points))
      c = 0.0_wp
      c_pc = 0.0_wp
      sw_e = 0.0_wp
      sw_pc = 0.0_wp
      do i = 1, points
         stress(:, i) = one
         statev(:, i) = state(1:n_statev)
         d_strain(:, i) = 10.0_wp*strain*real(i, wp)/real(points, wp)*path%from
      end do
      suction = path%suction
      mesh = mud_points(n=int(points, c_int), nstatev=n_statev, tangent=int(tangent, c_int), &
         threads=int(threads, c_int), stress0=c_loc(stress), statev0=c_loc(statev), dstrain=c_loc(d_strain), &
         suction=c_loc(suction), stress1=c_loc(stress), statev1=c_loc(statev), dsig_deps=c_loc(c), &
         dsig_dpc=c_loc(c_pc), dsw_deps=c_loc(sw_e), dsw_dpc=c_loc(sw_pc), status=c_loc(status), &
         reports=c_loc(reports))
      ! the first call spreads the points along the path and wakes the threads
      failed = mud_update_points(material, 1_c_int, mesh)
      do i = 1, points
         d_strain(:, i) = strain_of(path, i, points, strain)
      end do
      suction = suction + strain*path%d_suction
      before = now(ON_THE_WALL)
      failed = failed + mud_update_points(material, 1_c_int, mesh)
      after = now(ON_THE_WALL)
      if (failed /= 0) error stop 'benchmark: a batch failed'
      tally = tally_t(after - before, sum(reports%n_rate), points)
   end subroutine walk_batch

   !> Single rates in a state some way along a path, in directions that differ by a little.
   subroutine evaluate_rates(path, evaluations, tally)
      type(path_t), intent(in) :: path
      integer, intent(in) :: evaluations
      type(tally_t), intent(out) :: tally
      real(wp) :: props(WORDS), material(mud_prepared_size()), stress(6), statev(WORDS), d_strain(6), d_pc, z(6), &
         r_in(6), checksum
      type(params_t) :: par
      type(conditions_t) :: at
      type(suction_law_t) :: law
      type(mud_status_t) :: status
      type(rate_t) :: w
      type(mud_report) :: report
      integer(c_int) :: n_props, n_statev, code
      integer(int64) :: before, after
      integer :: i, fabric, memory

      call start(path, 1, 1.0e-5_wp, .true., props, n_props, material, stress, statev, n_statev)
      d_strain = 1.0e-3_wp*path%from
      code = mud_update(material, stress, statev, n_statev, d_strain, path%suction, MUD_TANGENT_NONE, &
                        stress, statev, report=report)
      if (code /= 0) error stop 'benchmark: an update failed'
      call read_params(props(1:n_props), par, status)
      fabric = mud_index(MUD_STATEV, 'fabric_11'//c_null_char)
      memory = mud_index(MUD_STATEV, 'memory_11'//c_null_char)
      z = statev(fabric + 1:fabric + 6)
      r_in = statev(memory + 1:memory + 6)
      d_strain = -path%to*[1.0_wp, 1.0_wp, 1.0_wp, 0.5_wp, 0.5_wp, 0.5_wp]
      d_pc = path%d_suction
      law = par%suction
      law%bonds = is_bonded(law, path%suction)
      at = conditions_t(bond=bonding(law, path%suction, path%void_ratio), e=path%void_ratio, r_in=r_in)
      checksum = 0.0_wp
      before = now(OF_THIS_THREAD)
      do i = 1, evaluations
         d_strain(1) = d_strain(1)*(1.0_wp + 1.0e-6_wp)
         call rate_at(par, [-stress, z, NO_EFFECTS], at, d_strain, d_pc, MODE_ORDINARY, w)
         checksum = checksum + w%d_p
      end do
      after = now(OF_THIS_THREAD)
      if (.not. w%loading .or. .not. abs(checksum) > 0.0_wp) error stop 'benchmark: a rate is not plastic'
      tally = tally_t(after - before, evaluations, evaluations)
   end subroutine evaluate_rates

   !> Rates on saturated walks of random increments of 1e-3, compression positive. rates(:, 1) have one root of the
   !> direction equation for certain, of rates(:, 2) the arc crosses the floor or a cap: docs/theory/material.md 4.6.
   subroutine meet_rates(rates)
      type(met_rates_t), intent(out) :: rates(MET, 2)
      integer, parameter :: LENGTH = 40
      type(path_t) :: begin
      type(met_rates_t) :: one
      type(mud_status_t) :: status
      type(rate_t) :: w
      type(mud_report) :: report
      real(wp) :: props(WORDS), material(mud_prepared_size()), stress(6), statev(WORDS)
      integer(c_int) :: n_props, n_statev, code
      integer :: i, kind, count(2), fabric, memory, e
      integer(int64) :: seed

      fabric = mud_index(MUD_STATEV, 'fabric_11'//c_null_char)
      memory = mud_index(MUD_STATEV, 'memory_11'//c_null_char)
      e = mud_index(MUD_STATEV, 'void_ratio'//c_null_char) + 1
      n_statev = mud_count(MUD_STATEV)
      seed = 1
      count = 0
      i = 0
      do while (any(count < MET))
         if (mod(i, LENGTH) == 0) then
            begin = path_t('walk', 10.0_wp**(1.3_wp + 1.4_wp*share(seed))*EQUAL, 0.0_wp, 0.0_wp, UNDRAINED, UNDRAINED, &
                           0.0_wp)
            begin%void_ratio = 0.65_wp + 0.25_wp*share(seed)
            call start(begin, 1, 1.0e-5_wp, .false., props, n_props, material, stress, statev, n_statev)
            call read_params(props(1:n_props), one%par, status)
         end if
         i = i + 1
         one%stress = -stress
         one%void_ratio = statev(e)
         one%z = statev(fabric + 1:fabric + 6)
         one%r_in = statev(memory + 1:memory + 6)
         one%d_strain = random_strain(seed)
         call evaluate(one, w)
         kind = merge(2, 1, may_cross(one%par, w))
         if (w%loading .and. w%x >= 0.0_wp .and. count(kind) < MET) then
            count(kind) = count(kind) + 1
            rates(count(kind), kind) = one
         end if
         code = mud_update(material, stress, statev, n_statev, -one%d_strain*[1, 1, 1, 2, 2, 2], 0.0_wp, &
                           MUD_TANGENT_NONE, stress, statev, report=report)
         if (code /= 0) error stop 'benchmark: an update failed'
      end do
   end subroutine meet_rates

   !> True unless x is below the floor on the whole arc, or twice above it at both ends, and no cap acts.
   pure logical function may_cross(par, w)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp) :: n_t(6), q(6), x_t, x_q

      n_t = w%t/w%t_norm
      q = w%r - ddot(w%r, n_t)*n_t
      x_t = ddot(w%r_moved, n_t)
      x_q = ddot(w%r_moved, q)/max(norm(q), tiny(x_q))
      may_cross = w%capped_d .or. w%capped_h .or. &
                  .not. (x_t**2 + x_q**2 < par%x_floor**2 .or. min(x_t, w%x) > 2.0_wp*par%x_floor)
   end function may_cross

   subroutine evaluate(this, w)
      type(met_rates_t), intent(in) :: this
      type(rate_t), intent(inout) :: w

      call rate_at(this%par, [this%stress, this%z, NO_EFFECTS], &
                   conditions_t(e=this%void_ratio, r_in=this%r_in), &
                   this%d_strain, 0.0_wp, MODE_ORDINARY, w)
   end subroutine evaluate

   !> The rates of one kind, one after the other.
   subroutine evaluate_met_rates(rates, tally)
      type(met_rates_t), intent(in) :: rates(:)
      type(tally_t), intent(out) :: tally
      type(rate_t) :: w
      real(wp) :: checksum
      integer(int64) :: before
      integer :: i

      checksum = 0.0_wp
      before = now(OF_THIS_THREAD)
      do i = 1, size(rates)
         call evaluate(rates(i), w)
         checksum = checksum + abs(w%d_p)
      end do
      tally = tally_t(now(OF_THIS_THREAD) - before, size(rates), size(rates))
      if (.not. checksum > 0.0_wp) error stop 'benchmark: a rate is not plastic'
   end subroutine evaluate_met_rates

   !> A random strain of norm 1e-3, most of it deviatoric.
   function random_strain(seed) result(strain)
      integer(int64), intent(inout) :: seed
      real(wp) :: strain(6)
      integer :: i

      do i = 1, 6
         strain(i) = share(seed) - 0.5_wp
      end do
      strain(1:3) = strain(1:3) - 0.3_wp*sum(strain(1:3))
      strain = 1.0e-3_wp*strain/norm(strain)
   end function random_strain

   !> A random number in (0, 1): Park & Miller, Comm. ACM 31 (1988).
   real(wp) function share(seed)
      integer(int64), intent(inout) :: seed

      seed = mod(16807_int64*seed, 2147483647_int64)
      share = real(seed, wp)/2147483647.0_wp
   end function share

   integer(int64) function now(clock)
      integer(c_int), intent(in) :: clock
      type(timespec_t) :: time

      if (clock_gettime(clock, time) /= 0) error stop 'benchmark: no such clock'
      now = 1000000000_int64*time%seconds + time%nanoseconds
   end function now
end module benchmark_walk
