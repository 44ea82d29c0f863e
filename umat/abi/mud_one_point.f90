! SPDX-License-Identifier: MIT
!> One point for a C host: mud_init, mud_update, mud_increment_at and mud_trace_increment of mud.h.
module mud_one_point
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_advice, only: doubts_on_start, advice_on_start, ADVICE_LENGTH
   use mud_host_increment, only: host_increment, never_began, suction_change, is_present, is_total
   use mud_kernel, only: report_t, output_t, kernel_begin, kernel_point, kernel_tangent, failed_report, copy_statev
   use mud_kinds, only: wp
   use mud_messages, only: report_text
   use mud_pieces, only: update_in_pieces
   use mud_prepared, only: prepared_t, find_prepared, start_t, find_start
   use mud_refusals, only: place_t, place_at, begin_at, remark_on_begun, remark_on_end, remark_on_void_ratio, &
      save_if_asked
   use mud_registry, only: NSTATV, S_SATURATION, S_SUCTION
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, ON_ARGUMENT
   use mud_to_host, only: put
   use mud_trace, only: trace_t
   implicit none (type, external)
   private
   public :: c_init, c_update, c_increment_at, c_trace_increment

   integer, parameter :: IN_PIECES = 32   !< MUD_IN_PIECES of mud.h.

   !> struct mud_blocks of mud.h.
   type, bind(c) :: blocks_t
      real(c_double) :: dsig_deps(6, 6), dsig_dpc(6), dsw_deps(6), dsw_dpc, s_w
   end type blocks_t
contains
   !> Begins a point, as kernel_begin: tension positive, stress and suction in the unit of p_atm, void ratio and
   !> saturation [-]. MUD_NULL_ARGUMENT, MUD_NOT_PREPARED, or the code of kernel_begin; on an error nothing but text is
   !> written. Text of a start that raises a doubt is a warning.
   integer(c_int) function c_init(storage, stress, suction, void_ratio, saturation, statev, n_statev, text, len) &
      bind(c, name='mud_init')
      type(c_ptr), value :: storage, stress, statev, text
      integer(c_int), value :: n_statev, len
      real(c_double), value :: suction, void_ratio, saturation
      integer :: doubt
      type(prepared_t), pointer :: material
      real(c_double), pointer, contiguous :: stress_in(:), statev_in(:)
      type(mud_status_t) :: status
      type(report_t) :: report
      character(ADVICE_LENGTH + 9) :: sentence
      real(wp) :: given(6)

      call find_prepared(storage, material, status)
      if (.not. (c_associated(stress) .and. c_associated(statev))) status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      if (status%code == MUD_OK) then
         call c_f_pointer(stress, stress_in, [6])
         call c_f_pointer(statev, statev_in, [max(n_statev, 0)])
         given = stress_in
         call kernel_begin(material%par, stress_in, suction, void_ratio, statev_in, report, saturation)
      else
         report = failed_report(status)
      end if
      c_init = report%status
      sentence = report_text(report)
      if (c_init == MUD_OK) then
         doubt = findloc(doubts_on_start(material%par, given, statev_in), .true., dim=1)
         if (doubt > 0) sentence = 'warning: '//advice_on_start(material%par, given, statev_in, doubt)
         call remark_on_begun(material%par, given, statev_in, place_t('mud_init'))
      end if
      call put(sentence, text, len)
   end function c_init

   !> One increment as host_increment has it, see mud.h: tension positive, engineering shear, stress in the unit of
   !> p_atm. Returns the status; on any failure only the report is written.
   integer(c_int) function c_update(storage, stress0, statev0, n_statev, dstrain, suction, tangent, stress1, &
           statev1, blocks, report_out) bind(c, name='mud_update')
      type(c_ptr), value :: storage, stress0, statev0, dstrain, stress1, statev1, blocks, report_out
      integer(c_int), value :: n_statev, tangent
      real(c_double), value :: suction
      type(start_t) :: start
      type(mud_status_t) :: status
      type(output_t) :: output
      type(report_t) :: report

      call find_start(storage, stress0, statev0, n_statev, dstrain, tangent, .not. is_present(tangent), start, status)
      if (.not. (is_present(tangent) .or. (c_associated(stress1) .and. c_associated(statev1)))) &
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      if (status%code == MUD_OK) then
         call host_increment(start%material%par, start%stress, start%statev, start%d_strain, suction, tangent, output, &
                             report)
         if (report%status == MUD_OK) then
            call remark_on_void_ratio(output%statev, place_t('mud_update'))
            if (.not. is_present(tangent)) call give_state(output, stress1, statev1)
            if (c_associated(blocks)) call give_blocks(output, blocks)
         end if
      else
         report = failed_report(status)
      end if
      call give_report(report, report_out)
      c_update = report%status
   end function c_update

   !> See mud.h. Units and codes as in c_update and kernel_begin; MUD_BAD_OPTION for total stress.
   integer(c_int) function c_increment_at(place_in, storage, stress0, statev0, n_statev, suction0, dstrain, suction, &
           tangent, stress1, statev1, blocks, report_out) bind(c, name='mud_increment_at')
      type(c_ptr), value :: place_in, storage, stress0, statev0, dstrain, stress1, statev1, blocks, report_out
      integer(c_int), value :: n_statev, tangent
      real(c_double), value :: suction0, suction
      type(start_t) :: start
      type(place_t) :: place
      type(mud_status_t) :: status
      type(output_t) :: output
      type(report_t) :: report
      integer :: kind
      logical :: updates, goes_on

      kind = merge(tangent - IN_PIECES, tangent, tangent >= IN_PIECES)
      updates = .not. is_present(kind)
      goes_on = c_associated(dstrain) .or. .not. updates
      call find_start(storage, stress0, statev0, n_statev, dstrain, kind, .false., start, status)
      if (is_total(kind)) status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(tangent, wp))
      if (updates .and. .not. (c_associated(stress1) .and. c_associated(statev1))) &
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      if (status%code == MUD_OK) then
         place = place_at(place_in)
         call begin_and_go_on(start, place, suction0, suction, kind, tangent >= IN_PIECES, goes_on, &
                              output, report)
      else
         report = failed_report(status)
      end if
      if (report%status == MUD_OK) then
         if (updates) call remark_on_end(output%stress, output%statev, place)
         if (updates) call give_state(output, stress1, statev1)
         if (goes_on .and. c_associated(blocks)) call give_blocks(output, blocks)
      end if
      call give_report(report, report_out)
      c_increment_at = report%status
   end function c_increment_at

   !> Begins a point that has no past, and integrates. Says what is doubtful about PROPS and the start and saves what is
   !> refused. Units and codes as in c_increment_at.
   subroutine begin_and_go_on(start, place, suction0, suction, kind, in_pieces, goes_on, output, report)
      type(start_t), intent(in) :: start
      type(place_t), intent(in) :: place
      real(wp), intent(in) :: suction0, suction
      integer, intent(in) :: kind                 !< A kind of tangent.
      logical, intent(in) :: in_pieces, goes_on   !< goes_on: false where the point only begins.
      type(output_t), intent(inout) :: output
      type(report_t), intent(out) :: report
      real(wp), target :: room(NSTATV)
      real(wp), pointer, contiguous :: statev(:)   ! of a length of its own it would be allocated at every point
      real(wp) :: stress(6), from, change

      report = failed_report(mud_status_t())
      stress = start%stress
      statev => room(:size(start%statev))
      statev = start%statev
      from = statev(S_SUCTION)
      if (never_began(statev)) then
         from = suction0
         call begin_at(start%material%par, start%material%props, stress, from, statev, place, report)
      end if
      change = suction_change(from, suction)
      if (.not. goes_on) then
         output%stress = stress
         output%n_statev = size(statev)
         output%statev(:size(statev)) = statev
      else if (report%status == MUD_OK .and. in_pieces) then
         call update_in_pieces(start%material%par, stress, statev, start%d_strain, from, change, kind, output, report)
      else if (report%status == MUD_OK .and. is_present(kind)) then
         call kernel_tangent(start%material%par, stress, statev, start%d_strain, from, change, output, report)
      else if (report%status == MUD_OK) then
         call kernel_point(start%material%par, stress, statev, start%d_strain, from, change, kind, output, report)
      end if
      if (report%status /= MUD_OK) call save_if_asked(start%material%props, stress, statev, start%d_strain, from, &
                                                      change, place, report)
   end subroutine begin_and_go_on

   !> Runs mud_update and reports every substep that it tries; see mud.h. Its rows have the stress tension positive.
   !> MUD_BAD_OPTION for first < 1, n_rows < 0 and slopes of the present state, else the status of the update.
   integer(c_int) function c_trace_increment(storage, stress0, statev0, n_statev, dstrain, suction, tangent, first, &
           rows, n_rows, attempts, report_out) bind(c, name='mud_trace_increment')
      type(c_ptr), value :: storage, stress0, statev0, dstrain, rows, attempts, report_out
      integer(c_int), value :: n_statev, tangent, first, n_rows
      real(c_double), value :: suction
      integer(c_int), pointer :: attempts_to
      type(start_t) :: start
      type(mud_status_t) :: status
      type(output_t) :: output
      type(report_t) :: report
      type(trace_t) :: trace
      integer :: i

      call find_start(storage, stress0, statev0, n_statev, dstrain, tangent, .true., start, status)
      if (status%code == MUD_OK .and. (first < 1 .or. n_rows < 0 .or. is_present(tangent))) &
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT)
      if (status%code == MUD_OK) then
         trace%first = first
         if (c_associated(rows)) call c_f_pointer(rows, trace%rows, [n_rows])
         call host_increment(start%material%par, start%stress, start%statev, start%d_strain, suction, tangent, output, &
                             report, trace)
      else
         report = failed_report(status)
      end if
      if (associated(trace%rows)) then
         do i = 1, min(trace%attempts - trace%first + 1, n_rows)
            trace%rows(i)%stress = 0.0_wp - trace%rows(i)%stress
         end do
      end if
      if (c_associated(attempts)) then
         call c_f_pointer(attempts, attempts_to)
         attempts_to = trace%attempts
      end if
      call give_report(report, report_out)
      c_trace_increment = report%status
   end function c_trace_increment

   subroutine give_state(output, stress1, statev1)
      type(output_t), intent(in) :: output
      type(c_ptr), intent(in) :: stress1, statev1
      real(c_double), pointer, contiguous :: array(:)

      call c_f_pointer(stress1, array, [6])
      array = output%stress
      call c_f_pointer(statev1, array, [output%n_statev])
      call copy_statev(output%n_statev, output%statev, array)
   end subroutine give_state

   !> The slopes against strain and suction of stress only where a tangent was asked for.
   subroutine give_blocks(output, blocks)
      type(output_t), intent(in) :: output
      type(c_ptr), intent(in) :: blocks
      type(blocks_t), pointer :: place

      call c_f_pointer(blocks, place)
      if (output%has_tangent) then
         place%dsig_deps = output%dsig_deps
         place%dsig_dpc = output%dsig_dpc
      end if
      place%dsw_deps = output%dsw_deps
      place%dsw_dpc = output%dsw_dpc
      place%s_w = output%statev(S_SATURATION)
   end subroutine give_blocks

   subroutine give_report(report, report_out)
      type(report_t), intent(in) :: report
      type(c_ptr), intent(in) :: report_out
      type(report_t), pointer :: report_to

      if (.not. c_associated(report_out)) return
      call c_f_pointer(report_out, report_to)
      report_to = report
   end subroutine give_report
end module mud_one_point
