! SPDX-License-Identifier: MIT
!> One increment or one start as a C host asks for it, whatever function of mud.h it calls: to a suction, with effective
!> or total stress, with the slopes at its end or those of the present state.
module mud_host_increment
   use mud_kernel, only: report_t, output_t, kernel_point, kernel_tangent, failed_report
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_registry, only: S_LAYOUT, S_SATURATION, S_SUCTION
   use mud_status, only: fail, MUD_OK, MUD_BAD_OPTION, ON_ARGUMENT
   use mud_tensor, only: is_finite, within
   use mud_total, only: effective_stress, total_stress, total_blocks
   use mud_trace, only: trace_t
   implicit none (type, external)
   private
   public :: host_increment, host_stress, make_total, never_began, suction_change, kind_of, is_present, is_total

   integer, parameter :: TANGENT_PRESENT = 4   !< MUD_TANGENT_PRESENT of mud.h.
   integer, parameter :: WITH_TOTAL_STRESS = 16    !< MUD_TOTAL_STRESS of mud.h.
   !> A suction that differs from that of the state by rounding has not changed.
   real(wp), parameter :: SAME_SUCTION = 4.0_wp*epsilon(1.0_wp)
contains
   !> Kind of tangent among the options of a host, -1 where they are unknown.
   pure integer function kind_of(options)
      integer, intent(in) :: options

      kind_of = merge(options - WITH_TOTAL_STRESS, options, is_total(options))
      if (kind_of < 0 .or. kind_of > TANGENT_PRESENT) kind_of = -1
   end function kind_of

   !> True if the slopes of the present state are asked for, no update.
   pure logical function is_present(options)
      integer, intent(in) :: options

      is_present = kind_of(options) == TANGENT_PRESENT
   end function is_present

   !> True if stresses are total ones less air pressure.
   pure logical function is_total(options)
      integer, intent(in) :: options

      is_total = options >= WITH_TOTAL_STRESS
   end function is_total

   !> The increment of mud_update. Tension positive, engineering shear; stress as the options say and suction in the
   !> unit of p_atm. MUD_BAD_OPTION, else the codes of kernel_point.
   pure subroutine host_increment(par, stress, statev, d_strain, suction, options, output, report, trace)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6), d_strain(6)
      real(wp), intent(in), contiguous :: statev(:)   !< STATEV, at least the entries of a point without hysteresis.
      real(wp), intent(in) :: suction             !< At the end.
      integer, intent(in) :: options              !< A kind of tangent, perhaps with WITH_TOTAL_STRESS.
      type(output_t), intent(inout) :: output
      type(report_t), intent(out) :: report
      type(trace_t), intent(inout), optional :: trace
      real(wp) :: start(6), change

      if (kind_of(options) < 0) then
         report = failed_report(fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(options, wp)))
         return
      end if
      change = suction_change(statev(S_SUCTION), suction)
      start = host_stress(stress, statev, options)
      if (is_present(options)) then
         call kernel_tangent(par, start, statev, d_strain, statev(S_SUCTION), change, output, report)
      else
         call kernel_point(par, start, statev, d_strain, statev(S_SUCTION), change, kind_of(options), output, report, &
                           trace)
      end if
      if (report%status == MUD_OK .and. is_total(options)) call make_total(output)
   end subroutine host_increment

   !> Effective stress of a host's, both in its unit.
   pure function host_stress(stress, statev, options) result(start)
      real(wp), intent(in) :: stress(6)
      real(wp), intent(in), contiguous :: statev(:)
      integer, intent(in) :: options
      real(wp) :: start(6)

      start = stress
      if (is_total(options) .and. is_finite(statev(S_SUCTION)) .and. is_finite(statev(S_SATURATION))) &
         start = effective_stress(stress, statev(S_SATURATION), statev(S_SUCTION))
   end function host_stress

   !> Layout 0: no start has filled it. One that is not finite is refused elsewhere.
   pure logical function never_began(statev)
      real(wp), intent(in) :: statev(:)

      never_began = within(statev(S_LAYOUT), 0.0_wp)
   end function never_began

   !> Change of suction between two values; a value that is not finite passes through, for the kernel to refuse it.
   pure real(wp) function suction_change(from, to) result(change)
      real(wp), intent(in) :: from, to

      change = to
      if (.not. (is_finite(from) .and. is_finite(to))) return
      change = to - from
      if (abs(change) <= SAME_SUCTION*max(abs(from), abs(to))) change = 0.0_wp
   end function suction_change

   !> Results of an update as those of total stress less air pressure.
   pure subroutine make_total(output)
      type(output_t), intent(inout) :: output

      associate (s_w => output%statev(S_SATURATION), suction => output%statev(S_SUCTION))
         output%stress = total_stress(output%stress, s_w, suction)
         if (output%has_tangent) call total_blocks(s_w, suction, output%dsw_deps, output%dsw_dpc, output%dsig_deps, &
                                                   output%dsig_dpc)
      end associate
   end subroutine make_total
end module mud_host_increment
