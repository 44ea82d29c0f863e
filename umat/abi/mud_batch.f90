!> Many points at once: mud_update_batch and mud_update_batch_prepared of mud.h.
module mud_batch
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_kernel, only: report_t, output_t, kernel_point, failed_report
   use mud_kinds, only: wp
   use mud_params, only: params_t, read_params
   use mud_prepared, only: prepared_t, find_prepared
   use mud_registry, only: NSTATV
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_NSTATV, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, ON_STATEV, &
      ON_ARGUMENT
   implicit none (type, external)
   private
   public :: mud_update_batch, mud_update_batch_prepared

   integer, parameter :: CHUNK = 16   !< Points a thread takes at a time: costs differ from point to point.
contains
   !> n points of one material over contiguous arrays, each point as in mud_update; see mud.h.
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
      if (status%code == MUD_OK) call update_points(par, n, stress0, statev0, n_statev, dstrain, suction0, dsuction, &
         tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, reports, &
         mud_update_batch)
   end function mud_update_batch

   !> The same for a prepared material.
   integer(c_int) function mud_update_batch_prepared(prepared, n, stress0, statev0, n_statev, dstrain, suction0, &
           dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, &
           reports) bind(c, name='mud_update_batch_prepared')
      type(c_ptr), value :: prepared, stress0, statev0, dstrain, suction0, dsuction, stress1, statev1, dsig_deps, &
                            dsig_dpc, dsw_deps, dsw_dpc, status_out, reports
      integer(c_int), value :: n, n_statev, tangent, threads
      type(prepared_t), pointer :: material
      type(mud_status_t) :: status

      status = fault_of(n, n_statev, tangent, c_associated(prepared), c_associated(stress0), c_associated(statev0), &
                        c_associated(dstrain), c_associated(stress1), c_associated(statev1), c_associated(status_out))
      if (status%code == MUD_OK) call find_prepared(prepared, material, status)
      mud_update_batch_prepared = status%code
      if (status%code == MUD_OK) call update_points(material%par, n, stress0, statev0, n_statev, dstrain, suction0, &
         dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, reports, &
         mud_update_batch_prepared)
   end function mud_update_batch_prepared

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
   subroutine update_points(par, n, stress0, statev0, n_statev, dstrain, suction0, dsuction, tangent, threads, &
                            stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status_out, reports, failed)
      type(params_t), intent(in) :: par
      type(c_ptr), intent(in) :: stress0, statev0, dstrain, suction0, dsuction, stress1, statev1, dsig_deps, dsig_dpc, &
                                 dsw_deps, dsw_dpc, status_out, reports
      integer(c_int), intent(in) :: n, n_statev, tangent, threads
      integer(c_int), intent(out) :: failed   !< How many points.
      real(c_double), pointer, contiguous :: s0(:, :), v0(:, :), de(:, :), pc0(:), dpc(:)
      real(c_double), pointer, contiguous :: s1(:, :), v1(:, :)
      real(c_double), pointer, contiguous :: c(:, :, :), c_pc(:, :), sw_e(:, :), sw_pc(:)
      type(report_t), pointer :: report_to(:)
      integer(c_int), pointer :: codes(:)
      type(output_t) :: output
      type(report_t) :: report
      integer :: i, failures, workers

      call c_f_pointer(stress0, s0, [6, n])
      call c_f_pointer(statev0, v0, [n_statev, n])
      call c_f_pointer(dstrain, de, [6, n])
      call c_f_pointer(stress1, s1, [6, n])
      call c_f_pointer(statev1, v1, [n_statev, n])
      call c_f_pointer(status_out, codes, [n])
      nullify (pc0, dpc, c, c_pc, sw_e, sw_pc, report_to)
      if (c_associated(suction0)) call c_f_pointer(suction0, pc0, [n])
      if (c_associated(dsuction)) call c_f_pointer(dsuction, dpc, [n])
      if (c_associated(dsig_deps)) call c_f_pointer(dsig_deps, c, [6, 6, n])
      if (c_associated(dsig_dpc)) call c_f_pointer(dsig_dpc, c_pc, [6, n])
      if (c_associated(dsw_deps)) call c_f_pointer(dsw_deps, sw_e, [6, n])
      if (c_associated(dsw_dpc)) call c_f_pointer(dsw_dpc, sw_pc, [n])
      if (c_associated(reports)) call c_f_pointer(reports, report_to, [n])

      failures = 0
      workers = thread_count(threads)
      !$omp parallel do schedule(dynamic, CHUNK) default(shared) private(i, output, report) reduction(+:failures) &
      !$omp num_threads(workers)
      do i = 1, n
         call kernel_point(par, s0(:, i), v0(:, i), de(:, i), suction_at(pc0, i), suction_at(dpc, i), tangent, output, &
                           report)
         codes(i) = report%status
         if (associated(report_to)) report_to(i) = report
         if (report%status /= MUD_OK) then
            failures = failures + 1
            cycle
         end if
         s1(:, i) = output%stress
         v1(1:NSTATV, i) = output%statev
         if (output%has_tangent) then
            if (associated(c)) c(:, :, i) = output%dsig_deps
            if (associated(c_pc)) c_pc(:, i) = output%dsig_dpc
         end if
         if (associated(sw_e)) sw_e(:, i) = output%dsw_deps
         if (associated(sw_pc)) sw_pc(i) = output%dsw_dpc
      end do
      !$omp end parallel do
      failed = int(failures, c_int)
   end subroutine update_points

   !> Entry of an optional array, 0 where it is not given.
   pure real(wp) function suction_at(array, i)
      real(c_double), pointer, contiguous, intent(in) :: array(:)
      integer, intent(in) :: i

      suction_at = 0.0_wp
      if (associated(array)) suction_at = array(i)
   end function suction_at

   !> The number asked for; 0 or less means what OpenMP would take.
   integer function thread_count(threads)
      !$ use omp_lib, only: omp_get_max_threads
      integer(c_int), intent(in) :: threads

      thread_count = max(threads, 1)
      !$ if (threads <= 0) thread_count = omp_get_max_threads()
   end function thread_count
end module mud_batch
