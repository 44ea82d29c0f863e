! SPDX-License-Identifier: MIT
!> Many points at once: mud_update_batch, mud_update_batch_prepared, mud_update_list and mud_tangent_list of mud.h.
module mud_batch
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_null_ptr, c_associated, c_f_pointer
   use mud_kernel, only: report_t, output_t, kernel_point, kernel_tangent
   use mud_kinds, only: wp
   use mud_params, only: params_t, read_params
   use mud_prepared, only: prepared_t, find_prepared
   use mud_registry, only: NSTATV, S_OPEN
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_NSTATV, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, ON_STATEV, &
      ON_ARGUMENT
   use mud_to_host, only: number_at, find_list
   implicit none (type, external)
   private
   public :: mud_update_batch, mud_update_batch_prepared, mud_update_list, mud_tangent_list

   integer, parameter :: CHUNK = 16   !< Points a thread takes at a time: costs differ from point to point.
   integer, parameter :: AHEAD = -1   !< In place of a tangent kind: slopes of the present state, no update.

   !> struct mud_summary of mud.h.
   type, bind(c) :: summary_t
      integer(c_int) :: failed = 0, first = -1, status = MUD_OK, open = 0, tensile = 0
      real(c_double) :: pnewdt = 1.0_wp, rates = 0.0_wp, substeps = 0.0_wp
   end type summary_t
contains
   !> n points of one material over contiguous arrays, each point as in mud_update; see mud.h. Tension positive,
   !> engineering shear, stress in the unit of p_atm. Returns the number of failed points, their codes are in
   !> status_out, or a negative code where nothing was done: MUD_NULL_ARGUMENT, MUD_BAD_NSTATV, MUD_BAD_OPTION (n or
   !> tangent below 0) or that of read_params.
   integer(c_int) function mud_update_batch(props, n_props, n, stress0, statev0, n_statev, dstrain, suction0, &
           dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, &
           reports) bind(c, name='mud_update_batch')
      type(c_ptr), value :: props, stress0, statev0, dstrain, suction0, dsuction, stress1, statev1, dsig_deps, &
                            dsig_dpc, dsw_deps, dsw_dpc, status_out, reports
      integer(c_int), value :: n_props, n, n_statev, tangent, threads
      real(c_double), pointer, contiguous :: props_in(:)
      type(params_t) :: par
      type(mud_status_t) :: status

      status = fault_of(n, n_statev, tangent, c_associated(props), c_associated(stress0), c_associated(statev0), &
                        c_associated(dstrain), c_associated(stress1), c_associated(statev1), c_associated(status_out))
      if (status%code == MUD_OK) then
         call c_f_pointer(props, props_in, [max(n_props, 0)])
         call read_params(props_in, par, status)
      end if
      mud_update_batch = status%code
      if (status%code == MUD_OK) call update_points(par, n, c_null_ptr, stress0, statev0, n_statev, dstrain, &
         suction0, dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, &
         reports, c_null_ptr, mud_update_batch)
   end function mud_update_batch

   !> The same for a prepared material. MUD_NOT_PREPARED where the storage is no material.
   integer(c_int) function mud_update_batch_prepared(prepared, n, stress0, statev0, n_statev, dstrain, suction0, &
           dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, &
           reports) bind(c, name='mud_update_batch_prepared')
      type(c_ptr), value :: prepared, stress0, statev0, dstrain, suction0, dsuction, stress1, statev1, dsig_deps, &
                            dsig_dpc, dsw_deps, dsw_dpc, status_out, reports
      integer(c_int), value :: n, n_statev, tangent, threads

      mud_update_batch_prepared = mud_update_list(prepared, n, c_null_ptr, stress0, statev0, n_statev, dstrain, &
         suction0, dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, &
         reports, c_null_ptr)
   end function mud_update_batch_prepared

   !> The same for the points of a list, with a summary. MUD_NOT_PREPARED where the storage is no material,
   !> MUD_BAD_OPTION for a negative number in the list.
   integer(c_int) function mud_update_list(prepared, n, points, stress0, statev0, n_statev, dstrain, suction0, &
           dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, &
           reports, summary) bind(c, name='mud_update_list')
      type(c_ptr), value :: prepared, points, stress0, statev0, dstrain, suction0, dsuction, stress1, statev1, &
                            dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, reports, summary
      integer(c_int), value :: n, n_statev, tangent, threads
      type(prepared_t), pointer :: material
      type(mud_status_t) :: status

      status = fault_of(n, n_statev, tangent, c_associated(prepared), c_associated(stress0), c_associated(statev0), &
                        c_associated(dstrain), c_associated(stress1), c_associated(statev1), c_associated(status_out))
      if (status%code == MUD_OK) call find_prepared(prepared, material, status)
      mud_update_list = status%code
      if (status%code == MUD_OK) call update_points(material%par, n, points, stress0, statev0, n_statev, dstrain, &
         suction0, dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, &
         reports, summary, mud_update_list)
   end function mud_update_list

   !> Slopes with which the points of a list go on; see kernel_tangent. d sigma'/d strain in the unit of p_atm
   !> (engineering shear), d sigma'/d p_c [-], d S_w/d strain [-], d S_w/d p_c [1/unit]. Returns as mud_update_list.
   integer(c_int) function mud_tangent_list(prepared, n, points, stress, statev, n_statev, direction, suction, &
           dsuction, threads, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, summary) &
           bind(c, name='mud_tangent_list')
      type(c_ptr), value :: prepared, points, stress, statev, direction, suction, dsuction, dsig_deps, dsig_dpc, &
                            dsw_deps, dsw_dpc, status_out, summary
      integer(c_int), value :: n, n_statev, threads
      type(prepared_t), pointer :: material
      type(mud_status_t) :: status

      status = fault_of(n, n_statev, 0, c_associated(prepared), c_associated(stress), c_associated(statev), .true., &
                        .true., .true., c_associated(status_out))
      if (status%code == MUD_OK) call find_prepared(prepared, material, status)
      mud_tangent_list = status%code
      if (status%code == MUD_OK) call update_points(material%par, n, points, stress, statev, n_statev, direction, &
         suction, dsuction, AHEAD, threads, c_null_ptr, c_null_ptr, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, &
         status_out, c_null_ptr, summary, mud_tangent_list)
   end function mud_tangent_list

   !> What is wrong with the arguments of a batch; the pointers are those that must be given.
   pure function fault_of(n, n_statev, tangent, material, stress0, statev0, dstrain, stress1, statev1, status_out) &
      result(status)
      integer(c_int), intent(in) :: n, n_statev, tangent
      logical, intent(in) :: material, stress0, statev0, dstrain, stress1, statev1, status_out
      type(mud_status_t) :: status

      if (.not. (material .and. stress0 .and. statev0 .and. dstrain .and. stress1 .and. statev1 .and. status_out)) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      else if (n_statev < NSTATV) then
         status = fail(MUD_BAD_NSTATV, ON_STATEV)
      else if (n < 0 .or. tangent < 0) then
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT)
      end if
   end function fault_of

   !> The points of checked arguments. A point that fails leaves its own outputs untouched and the others alone. Bitwise
   !> independent of the number of threads, for no point sees another.
   subroutine update_points(par, n, points, stress0, statev0, n_statev, dstrain, suction0, dsuction, tangent, threads, &
                            stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, reports, summary, &
                            outcome)
      type(params_t), intent(in) :: par
      type(c_ptr), intent(in) :: points, stress0, statev0, dstrain, suction0, dsuction, stress1, statev1, dsig_deps, &
                                 dsig_dpc, dsw_deps, dsw_dpc, status_out, reports, summary
      integer(c_int), intent(in) :: n, n_statev, tangent, threads
      integer(c_int), intent(out) :: outcome   !< How many points failed, or a code below 0.
      real(c_double), pointer, contiguous :: s0(:, :), v0(:, :), de(:, :), pc0(:), dpc(:)
      real(c_double), pointer, contiguous :: s1(:, :), v1(:, :)
      real(c_double), pointer, contiguous :: c(:, :, :), c_pc(:, :), sw_e(:, :), sw_pc(:)
      type(report_t), pointer :: report_to(:)
      integer(c_int), pointer, contiguous :: codes(:), list(:)
      type(mud_status_t) :: status
      type(output_t) :: output
      type(report_t) :: report
      real(wp) :: still(6), pnewdt, rates, substeps
      integer :: i, j, extent, failures, workers, first, opened, tensile, code_of_first

      call find_list(points, n, list, extent, status)
      outcome = status%code
      if (status%code /= MUD_OK) return
      call c_f_pointer(stress0, s0, [6, extent])
      call c_f_pointer(statev0, v0, [int(n_statev), extent])
      call c_f_pointer(status_out, codes, [extent])
      nullify (de, s1, v1, pc0, dpc, c, c_pc, sw_e, sw_pc, report_to)
      if (c_associated(dstrain)) call c_f_pointer(dstrain, de, [6, extent])
      if (c_associated(stress1)) call c_f_pointer(stress1, s1, [6, extent])
      if (c_associated(statev1)) call c_f_pointer(statev1, v1, [int(n_statev), extent])
      if (c_associated(suction0)) call c_f_pointer(suction0, pc0, [extent])
      if (c_associated(dsuction)) call c_f_pointer(dsuction, dpc, [extent])
      if (c_associated(dsig_deps)) call c_f_pointer(dsig_deps, c, [6, 6, extent])
      if (c_associated(dsig_dpc)) call c_f_pointer(dsig_dpc, c_pc, [6, extent])
      if (c_associated(dsw_deps)) call c_f_pointer(dsw_deps, sw_e, [6, extent])
      if (c_associated(dsw_dpc)) call c_f_pointer(dsw_dpc, sw_pc, [extent])
      if (c_associated(reports)) call c_f_pointer(reports, report_to, [extent])

      still = 0.0_wp
      failures = 0
      opened = 0
      tensile = 0
      first = huge(first)
      pnewdt = 1.0_wp
      rates = 0.0_wp
      substeps = 0.0_wp
      workers = thread_count(threads)
      !$omp parallel do schedule(dynamic, CHUNK) default(shared) private(i, j, output, report) num_threads(workers) &
      !$omp reduction(+:failures, opened, tensile, rates, substeps) reduction(min:pnewdt, first)
      do i = 1, n
         j = i
         if (associated(list)) j = list(i) + 1
         if (tangent /= AHEAD) then
            call kernel_point(par, s0(:, j), v0(:, j), de(:, j), number_at(pc0, j), number_at(dpc, j), tangent, &
                              output, report)
         else if (associated(de)) then
            call kernel_tangent(par, s0(:, j), v0(:, j), de(:, j), number_at(pc0, j), number_at(dpc, j), output, report)
         else
            call kernel_tangent(par, s0(:, j), v0(:, j), still, number_at(pc0, j), number_at(dpc, j), output, report)
         end if
         codes(j) = report%status
         if (associated(report_to)) report_to(j) = report
         pnewdt = min(pnewdt, report%pnewdt)
         rates = rates + report%n_rate
         substeps = substeps + report%n_substep
         if (report%status /= MUD_OK) then
            failures = failures + 1
            first = min(first, j - 1)
            cycle
         end if
         if (output%statev(S_OPEN) > 0.5_wp) opened = opened + 1
         tensile = tensile + report%n_tensile
         if (associated(s1)) s1(:, j) = output%stress
         if (associated(v1)) v1(1:NSTATV, j) = output%statev
         if (output%has_tangent) then
            if (associated(c)) c(:, :, j) = output%dsig_deps
            if (associated(c_pc)) c_pc(:, j) = output%dsig_dpc
         end if
         if (associated(sw_e)) sw_e(:, j) = output%dsw_deps
         if (associated(sw_pc)) sw_pc(j) = output%dsw_dpc
      end do
      !$omp end parallel do
      outcome = int(failures, c_int)
      if (c_associated(summary)) then
         code_of_first = MUD_OK
         if (failures == 0) first = -1
         if (failures > 0) code_of_first = codes(first + 1)
         call give_summary(summary, summary_t(failures, first, code_of_first, opened, tensile, pnewdt, rates, substeps))
      end if
   end subroutine update_points

   subroutine give_summary(summary, value)
      type(c_ptr), intent(in) :: summary
      type(summary_t), intent(in) :: value
      type(summary_t), pointer :: place

      call c_f_pointer(summary, place)
      place = value
   end subroutine give_summary

   !> The number asked for; 0 or less means what OpenMP would take.
   integer function thread_count(threads)
      !$ use omp_lib, only: omp_get_max_threads
      integer(c_int), intent(in) :: threads

      thread_count = max(threads, 1)
      !$ if (threads <= 0) thread_count = omp_get_max_threads()
   end function thread_count
end module mud_batch
