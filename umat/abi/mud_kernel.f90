! SPDX-License-Identifier: MIT
!> The only entry to the core: UMAT conventions (tension positive, engineering shear) outside, soil mechanics inside.
!> umat_ and mud_update both end here.
module mud_kernel
   use, intrinsic :: iso_c_binding, only: c_int, c_double
   use mud_bounding, only: limited
   use mud_integration, only: integration_t
   use mud_kinds, only: wp
   use mud_params, only: params_t, options_t
   use mud_point, only: update_point, LAST_RATE => TANGENT_CONTINUUM
   use mud_blocks, only: blocks_t
   use mud_start, only: initial_state
   use mud_rates, only: stress_ratio
   use mud_registry, only: NSTATV, NSTATV_BASE, VARIABLES, S_DSIGMA_DPC, S_N_RATE, S_N_TENSILE, S_DSW_DPC, &
      S_DSW_DEV, S_ELASTIC_DOMAIN, S_STACK, ENTRY_SIZE, S_TURNS
   use mud_retention, only: check_preset, check_retention, check_saturation
   use mud_state, only: state_t, counters_t, pack_state, unpack_state, statev_size, check_size
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_INPUT, MUD_BAD_OPTION, MUD_NOT_FINITE, ON_STRESS, &
      ON_STRAIN, ON_SUCTION, ON_ARGUMENT
   use mud_tensor, only: is_finite, within, all_finite, norm, rotate
   use mud_trace, only: trace_t
   implicit none (type, external)
   private
   public :: report_t, output_t, start_t, kernel_begin, kernel_point, kernel_tangent, &
      rotate_statev, failed_report, copy_statev, TANGENT_FROM_PROPS, ON_STRESS_RATIO
   public :: read_state, write_output, report_of, from_umat_strain

   integer, parameter :: TANGENT_FROM_PROPS = -1   !< Take the tangent kind from PROPS.
   integer, parameter :: ON_STRESS_RATIO = 7      !< Index of a status on stress: the ratio q/p', no component.
   integer, parameter :: LAST_TANGENT = 3          !< Largest tangent kind.
   real(wp), parameter :: SMALLEST_CUT = 0.1_wp, LARGEST_CUT = 0.5_wp   !< Range of the suggested PNEWDT [-].
   !> Strain by which kernel_tangent looks ahead [-]: the stress moves by about 1e-7 of itself, the slopes likewise.
   real(wp), parameter :: LOOK_AHEAD = 1.0e-10_wp
   !> Suction that counts like a strain of 1, in atmospheres: about the bulk modulus number of soil [-].
   real(wp), parameter :: STIFF = 1.0e3_wp
   !> Share that a change of suction has in a direction where only its sense counts: the slopes change as little [-].
   real(wp), parameter :: SENSE = 1.0e-6_wp
   !> A start may be beyond the bounding surface by this factor [-]: dense soil that softens is, by a few per cent.
   real(wp), parameter :: FARTHEST_START = 1.25_wp
   real(wp), parameter :: SQRT_3_2 = sqrt(1.5_wp)   !< From |r| to q/p' [-].

   !> struct mud_report of mud.h.
   type, bind(c) :: report_t
      integer(c_int) :: status, subject, index
      type(counters_t) :: counters
      real(c_double) :: value, lower, upper, reached, pnewdt
   end type report_t

   !> An increment of a point as kernel_point is given it; the suction at its start is that of statev.
   type :: start_t
      real(wp) :: stress(6), d_strain(6), d_suction
      real(wp), pointer, contiguous :: statev(:)
   end type start_t

   !> Results of a successful update, UMAT conventions.
   type :: output_t
      real(wp) :: stress(6), statev(NSTATV)
      integer :: n_statev   !< So many of statev are set.
      real(wp) :: dsig_deps(6, 6), dsig_dpc(6), dsw_deps(6), dsw_dpc
      logical :: has_tangent
   end type output_t
contains
   !> Initialises a point. stress and statev are written on success only. Tension positive, stress and suction in the
   !> unit of p_atm, void ratio [-]. A stress of zero means p_min. statev(:) has the numbers of statev_size, else
   !> MUD_BAD_NSTATV; otherwise the codes of check_preset, check_retention, initial_state and check_strength.
   pure subroutine kernel_begin(par, stress, suction, void_ratio, statev, report, saturation)
      type(params_t), intent(in) :: par
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(in) :: suction, void_ratio   !< Void ratio 0: e_0.
      real(wp), intent(inout) :: statev(:)
      type(report_t), intent(out) :: report
      real(wp), intent(in) :: saturation   !< 0: on the main drying curve [-].
      type(state_t) :: state
      type(mud_status_t) :: status
      real(wp) :: e
      integer :: n

      n = statev_size(par%options_t)
      call check_size(size(statev), par%options_t, status)
      call check_preset(par%suction%retention_t, saturation, status)
      e = void_ratio
      if (within(e, 0.0_wp)) e = par%e_0
      if (status%code == MUD_OK) call check_retention(par%suction%retention_t, status)
      if (status%code == MUD_OK) call initial_state(par, -stress, e, suction, state, status, saturation)
      if (status%code == MUD_OK) call check_strength(par, state, status)
      report = failed_report(status)
      if (status%code /= MUD_OK) return
      stress = to_umat_stress(state%sigma)
      statev(1:n) = 0.0_wp
      call pack_state(state, par%options_t, counters_t(), statev)
   end subroutine kernel_begin

   !> One increment. Tension positive; statev(:) has the numbers of statev_size, else MUD_BAD_NSTATV.
   !> MUD_BAD_OPTION for an unknown tangent, codes of unpack_state and update_point. On failure output is undefined.
   pure subroutine kernel_point(par, stress, statev, d_strain, suction, d_suction, tangent, output, report, trace)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6)       !< sigma' [kPa]
      real(wp), intent(in), contiguous :: statev(:)   !< STATEV of a point that has begun.
      real(wp), intent(in) :: d_strain(6)     !< Engineering shear [-].
      real(wp), intent(in) :: suction, d_suction   !< [kPa]
      integer, intent(in) :: tangent          !< TANGENT_* of mud_point or TANGENT_FROM_PROPS.
      type(output_t), intent(inout) :: output
      type(report_t), intent(out) :: report
      type(trace_t), intent(inout), optional :: trace   !< Stress compression positive as the core has it.
      type(integration_t) :: it
      type(blocks_t) :: blocks
      integer :: kind

      kind = tangent
      if (kind == TANGENT_FROM_PROPS) kind = par%tangent
      call read_state(par, stress, statev, suction, it%state, output%statev, it%status)
      if (it%status%code == MUD_OK .and. (kind < 0 .or. kind > LAST_TANGENT)) then
         it%status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(tangent, wp), 0.0_wp, real(LAST_TANGENT, wp))
      end if
      if (it%status%code == MUD_OK) then
         if (present(trace)) then
            it%traced = .true.
            it%trace = trace
         end if
         call update_point(par, from_umat_strain(d_strain), d_suction, kind, it, blocks)
         if (present(trace)) trace = it%trace
      end if
      if (it%status%code == MUD_OK) call write_output(par%options_t, it%state, blocks, it%counters, kind > 0, output, &
                                                     it%status)
      report = report_of(it%status, it%counters, it%reached)
   end subroutine kernel_point

   !> Slopes with which a state goes on in a direction of strain and suction of any length. No strain: that in which the
   !> state strained last, as far as its elastic domain remembers it; of the suction only the sense counts then, for how
   !> fast it changes against a remembered strain nobody said. Only the blocks of output mean something. Tension
   !> positive, stress in the unit of p_atm. MUD_BAD_INPUT for a direction that is not
   !> finite, else the codes of kernel_point. docs/theory/integration.md sections 5.2 and 5.4.
   pure subroutine kernel_tangent(par, stress, statev, direction, suction, d_suction, output, report)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6)
      real(wp), intent(in), contiguous :: statev(:)
      real(wp), intent(in) :: direction(6)         !< Engineering shear [-].
      real(wp), intent(in) :: suction, d_suction   !< [kPa]
      type(output_t), intent(inout) :: output
      type(report_t), intent(out) :: report
      real(wp) :: ahead(6), suction_ahead, length
      integer :: i

      i = findloc(is_finite(direction), .false., dim=1)
      if (i > 0) then
         report = failed_report(fail(MUD_BAD_INPUT, ON_STRAIN, i, direction(i), -1.0_wp, 1.0_wp))
         return
      end if
      if (.not. is_finite(d_suction)) then
         report = failed_report(fail(MUD_BAD_INPUT, ON_SUCTION, 0, d_suction, -huge(1.0_wp), huge(1.0_wp)))
         return
      end if
      ahead = direction
      suction_ahead = d_suction
      if (maxval(abs(direction)) <= 0.0_wp .and. size(statev) >= NSTATV_BASE) then
         ahead = statev(S_ELASTIC_DOMAIN:S_ELASTIC_DOMAIN + 5)*[-1.0_wp, -1.0_wp, -1.0_wp, -2.0_wp, -2.0_wp, -2.0_wp]
         if (.not. all(is_finite(ahead))) ahead = 0.0_wp   ! said by the update
         if (abs(d_suction) > 0.0_wp .and. maxval(abs(ahead)) > 0.0_wp) &
            suction_ahead = sign(SENSE*STIFF*par%p_atm*maxval(abs(ahead)), d_suction)
      end if
      length = max(maxval(abs(ahead)), abs(suction_ahead)/(STIFF*par%p_atm))
      if (length > 0.0_wp) then
         ahead = ahead/length*LOOK_AHEAD
         suction_ahead = suction_ahead/length*LOOK_AHEAD
      end if
      call kernel_point(par, stress, statev, ahead, suction, suction_ahead, LAST_RATE, output, report)
   end subroutine kernel_tangent

   !> Rotates every tensor of STATEV by DROT, as Abaqus asks for. That drot is a rotation is not checked; statev(:) has
   !> at least the numbers without hysteresis.
   pure subroutine rotate_statev(drot, statev)
      real(wp), intent(in) :: drot(3, 3)
      real(wp), intent(inout) :: statev(:)
      integer :: i, j, first

      do i = 1, size(VARIABLES)
         if (.not. VARIABLES(i)%rotates) cycle
         do j = 0, VARIABLES(i)%copies - 1
            first = VARIABLES(i)%first + j*VARIABLES(i)%stride
            statev(first:first + 5) = rotate(statev(first:first + 5), drot)
         end do
      end do
   end subroutine rotate_statev

   !> Report of a call that failed before it began. Nothing was integrated: reached is 0.
   pure function failed_report(status) result(report)
      type(mud_status_t), intent(in) :: status
      type(report_t) :: report

      report = report_of(status, counters_t(), 0.0_wp)
   end function failed_report

   !> State at the start of an increment.
   pure subroutine read_state(par, stress, statev, suction, state, packed, status)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6), suction
      real(wp), intent(in), contiguous :: statev(:)
      type(state_t), intent(inout) :: state
      real(wp), intent(inout) :: packed(NSTATV)   !< Totals so far.
      type(mud_status_t), intent(out) :: status

      call unpack_state(statev, par%options_t, state, status)
      if (status%code /= MUD_OK) return
      call check_saturation(par%suction%retention_t, state%p_c, state%e, state%s_w, status)
      call keep_totals(statev_size(par%options_t), statev, packed)
      state%sigma = -stress
      state%p_c = suction
   end subroutine read_state

   !> Copies the entries of STATEV that pack_state does not write: totals of the counters, and numbers of options that
   !> are off.
   pure subroutine keep_totals(n, from, to)
      integer, intent(in) :: n   !< Number of entries of STATEV, as of statev_size.
      real(wp), intent(in), contiguous :: from(:)
      real(wp), intent(inout), contiguous :: to(:)

      to(S_N_RATE:S_N_TENSILE) = from(S_N_RATE:S_N_TENSILE)
      if (n > NSTATV_BASE) to(S_TURNS:n) = from(S_TURNS:n)
   end subroutine keep_totals

   !> The numbers of a point, most at once: their count is known. Units as in mud_registry; from and to have the n
   !> numbers of statev_size, and what is behind them stays.
   pure subroutine copy_statev(n, from, to)
      integer, intent(in) :: n
      real(wp), intent(in), contiguous :: from(:)
      real(wp), intent(inout), contiguous :: to(:)

      to(1:NSTATV_BASE) = from(1:NSTATV_BASE)
      if (n > NSTATV_BASE) to(S_TURNS:n) = from(S_TURNS:n)
   end subroutine copy_statev

   !> A start far beyond the bounding surface, which no loading reaches: MUD_BAD_INPUT with q/p' and the largest that is
   !> taken in its direction. docs/theory/material.md section 1.4.
   pure subroutine check_strength(par, state, status)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state
      type(mud_status_t), intent(inout) :: status
      real(wp) :: p, r(6), largest

      call stress_ratio(par, state%sigma, p, r)
      largest = FARTHEST_START*norm(limited(par%critical, state%psi, r))
      if (norm(r) > largest) status = fail(MUD_BAD_INPUT, ON_STRESS, ON_STRESS_RATIO, SQRT_3_2*norm(r), 0.0_wp, &
                                           SQRT_3_2*largest)
   end subroutine check_strength

   !> Writes the core's results in UMAT conventions; a result that is not finite is a failure.
   pure subroutine write_output(options, state, blocks, counters, has_tangent, output, status)
      type(options_t), intent(in) :: options
      type(state_t), intent(in) :: state
      type(blocks_t), intent(in) :: blocks
      type(counters_t), intent(in) :: counters
      logical, intent(in) :: has_tangent
      type(output_t), intent(inout) :: output
      type(mud_status_t), intent(out) :: status
      integer :: used
      logical :: finite

      output%has_tangent = has_tangent
      output%stress = to_umat_stress(state%sigma)
      call pack_state(state, options, counters, output%statev)
      output%n_statev = statev_size(options)
      output%dsw_deps = 0.0_wp
      output%dsw_deps(1:3) = -blocks%dsw_dev
      output%dsw_dpc = blocks%dsw_dpc
      output%statev(S_DSW_DPC) = blocks%dsw_dpc
      output%statev(S_DSW_DEV) = -blocks%dsw_dev
      if (has_tangent) then
         output%dsig_deps = blocks%dsig_deps
         output%dsig_dpc = to_umat_stress(blocks%dsig_dpc)
         output%statev(S_DSIGMA_DPC:S_DSIGMA_DPC + 5) = output%dsig_dpc
      else
         output%statev(S_DSIGMA_DPC:S_DSIGMA_DPC + 5) = 0.0_wp
      end if
      ! beyond the interrupted processes there are zeros
      used = S_STACK - 1 + ENTRY_SIZE*state%memory%depth
      finite = are_finite(6, output%stress) .and. are_finite(S_STACK - 1, output%statev)
      if (finite .and. used >= S_STACK) finite = all_finite(output%statev(S_STACK:used))
      if (finite .and. has_tangent) finite = are_finite(36, output%dsig_deps)
      if (.not. finite) status = fail(MUD_NOT_FINITE, ON_STRESS)
   end subroutine write_output

   !> all_finite of the first n numbers of an array of any rank.
   pure logical function are_finite(n, x)
      integer, intent(in) :: n
      real(wp), intent(in) :: x(n)

      are_finite = all_finite(x)
   end function are_finite

   !> Compression positive to tension positive; minus zero would only confuse.
   pure function to_umat_stress(sigma) result(stress)
      real(wp), intent(in) :: sigma(6)
      real(wp) :: stress(6)

      stress = 0.0_wp - sigma
   end function to_umat_stress

   !> Tension positive engineering strain to compression positive tensor strain.
   pure function from_umat_strain(d_strain) result(eps)
      real(wp), intent(in) :: d_strain(6)
      real(wp) :: eps(6)
      integer :: i

      ! A NaN passes through: the core refuses it.
      do i = 1, 6
         eps(i) = d_strain(i)
         if (is_finite(eps(i))) eps(i) = -eps(i)*merge(1.0_wp, 0.5_wp, i <= 3)
      end do
   end function from_umat_strain

   !> The offending value as the host gave it: the core's signs are the other way round, its shear strain is half.
   pure real(wp) function host_value(status)
      type(mud_status_t), intent(in) :: status

      host_value = status%value
      if (.not. is_finite(host_value) .or. status%index < 1) return
      if (status%subject == ON_STRESS .and. status%index <= 6) host_value = -host_value
      if (status%subject == ON_STRAIN) host_value = -host_value*host_factor(status)
   end function host_value

   !> 2 for an engineering shear strain, else 1.
   pure real(wp) function host_factor(status)
      type(mud_status_t), intent(in) :: status

      host_factor = merge(2.0_wp, 1.0_wp, status%subject == ON_STRAIN .and. status%index > 3)
   end function host_factor

   !> Report of an update that so many counters count.
   pure function report_of(status, counters, reached) result(report)
      type(mud_status_t), intent(in) :: status
      type(counters_t), intent(in) :: counters
      real(wp), intent(in) :: reached
      type(report_t) :: report

      report%status = status%code
      report%subject = status%subject
      report%index = status%index
      report%value = host_value(status)
      report%lower = status%lower*host_factor(status)
      report%upper = status%upper*host_factor(status)
      report%counters = counters
      report%reached = reached
      report%pnewdt = 1.0_wp
      if (status%code /= MUD_OK) report%pnewdt = min(max(reached, SMALLEST_CUT), LARGEST_CUT)
   end function report_of
end module mud_kernel
