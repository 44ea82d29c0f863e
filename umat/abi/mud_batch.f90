! SPDX-License-Identifier: MIT
!> Many points of several materials: mud_init_points, mud_update_points and mud_saturation_points of mud.h.
module mud_batch
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer, c_loc
   use mud_host_increment, only: host_increment, kind_of, is_present, is_total
   use mud_kernel, only: report_t, output_t, kernel_begin, failed_report, copy_statev
   use mud_kinds, only: wp
   use mud_once, only: may_use_threads
   use mud_params, only: params_t
   use mud_prepared, only: prepared_t, find_materials
   use mud_refusals, only: place_t, remark_on_begun, remark_on_void_ratio
   use mud_registry, only: NSTATV, NSTATV_BASE, S_OPEN, S_SATURATION, S_SUCTION, S_VOID_RATIO
   use mud_retention, only: saturation_t, saturation, read_preset
   use mud_retention_point, only: state_saturation
   use mud_side_by_side, only: given_t, update_side_by_side
   use mud_state, only: statev_size, E_LOWER, E_UPPER
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_NSTATV, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, ON_STATEV, &
      ON_ARGUMENT
   use mud_tensor, only: is_finite
   use mud_to_host, only: number_at
   use mud_total, only: effective_stress, total_stress
   use mud_vector, only: WIDTH
   implicit none (type, external)
   private
   public :: c_init_points, c_update_points, c_saturation_points

   integer, parameter :: CHUNK = 2   !< Rows of WIDTH points a thread takes at a time: costs differ from point to point.
   integer, parameter :: SIDE_BY_SIDE = 64   !< MUD_LANES of mud.h.
   integer, parameter :: BEGIN = 1, UPDATE = 2, RETAIN = 3   !< Tasks, done for every point.

   !> struct mud_points of mud.h.
   type, bind(c) :: points_t
      integer(c_int) :: n, n_statev, tangent, threads
      type(c_ptr) :: list, material, stress0, statev0, dstrain, suction, void_ratio, saturation, stress1, statev1, &
                     dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, s_w, status, reports
   end type points_t

   !> struct mud_summary of mud.h.
   type, bind(c) :: summary_t
      integer(c_int) :: failed = 0, worst = -1, open = 0, tensile = 0, lifted = 0
      real(c_double) :: pnewdt = 1.0_wp, rates = 0.0_wp, substeps = 0.0_wp
      type(report_t) :: report
   end type summary_t

   !> Arrays of a call, shaped by its counts; those that the host left out are not associated.
   type :: arrays_t
      integer(c_int), pointer, contiguous :: list(:) => null(), material(:) => null(), codes(:) => null()
      real(c_double), pointer, contiguous :: stress0(:, :) => null(), statev0(:, :) => null(), strain(:, :) => null(), &
         suction(:) => null(), void_ratio(:) => null(), saturation(:) => null(), stress1(:, :) => null(), &
         statev1(:, :) => null(), c(:, :, :) => null(), c_pc(:, :) => null(), sw_e(:, :) => null(), &
         sw_pc(:) => null(), s_w(:) => null()
      type(report_t), pointer, contiguous :: reports(:) => null()
   end type arrays_t
   interface
      !> Brings so many bytes that will soon be read or written near.
      subroutine mud_fetch(first, bytes) bind(c, name='mud_fetch')
         import :: c_int, c_ptr
         type(c_ptr), value :: first
         integer(c_int), value :: bytes
      end subroutine mud_fetch
   end interface
contains
   !> Fills STATEV of points that begin. Tension positive, stress and suction in the unit of p_atm, void ratio [-].
   !> Returns the number of failed points, or a negative code where nothing was done; see run.
   integer(c_int) function c_init_points(materials, n_materials, points, summary) bind(c, name='mud_init_points')
      type(c_ptr), value :: materials, points, summary
      integer(c_int), value :: n_materials

      c_init_points = run(BEGIN, materials, n_materials, points, summary)
   end function c_init_points

   !> One increment of every point, or the slopes of its present state, as host_increment has it. Returns as
   !> mud_init_points.
   integer(c_int) function c_update_points(materials, n_materials, points, summary) bind(c, name='mud_update_points')
      type(c_ptr), value :: materials, points, summary
      integer(c_int), value :: n_materials

      c_update_points = run(UPDATE, materials, n_materials, points, summary)
   end function c_update_points

   !> Degree of saturation of every point at another suction, as state_saturation has it. Returns as mud_init_points.
   integer(c_int) function c_saturation_points(materials, n_materials, points, summary) &
      bind(c, name='mud_saturation_points')
      type(c_ptr), value :: materials, points, summary
      integer(c_int), value :: n_materials

      c_saturation_points = run(RETAIN, materials, n_materials, points, summary)
   end function c_saturation_points

   !> A task for every point. MUD_NULL_ARGUMENT, MUD_NOT_PREPARED, MUD_BAD_NSTATV, MUD_BAD_OPTION (counts, kind of
   !> tangent, numbers of points or materials) before anything is done. A point that fails leaves its own outputs
   !> untouched and the others alone; bitwise independent of the number of threads, for no point sees another.
   integer(c_int) function run(task, materials, n_materials, points, summary)
      integer, intent(in) :: task
      type(c_ptr), intent(in) :: materials, points, summary
      integer(c_int), intent(in) :: n_materials
      type(prepared_t), pointer, contiguous :: material(:)
      type(points_t), pointer :: at_host
      type(points_t) :: given
      type(arrays_t) :: arrays
      type(mud_status_t) :: status
      type(summary_t) :: total
      type(summary_t), pointer :: place
      type(output_t) :: output(WIDTH)
      type(report_t) :: report(WIDTH)
      integer :: first, i, j(WIDTH), k(WIDTH), n
      logical :: raised, lanes, done(WIDTH)
      !$omp declare reduction (join : summary_t : add(omp_in, omp_out)) initializer (omp_priv = no_points())

      lanes = .false.
      call find_materials(materials, n_materials, material, status)
      if (.not. c_associated(points)) status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      if (status%code == MUD_OK) then
         call c_f_pointer(points, at_host)
         given = at_host
         lanes = iand(given%tangent, SIDE_BY_SIDE) /= 0 .and. given%tangent > 0
         if (lanes) given%tangent = given%tangent - SIDE_BY_SIDE
         lanes = lanes .and. task == UPDATE .and. .not. is_present(given%tangent)
         status = fault_of(task, given)
         if (status%code == MUD_OK .and. given%n > 0) call find_arrays(task, given, int(n_materials), arrays, status)
      end if
      run = status%code
      if (status%code /= MUD_OK) return

      total = no_points()
      !$omp parallel do schedule(dynamic, CHUNK) default(shared) private(i, j, k, n, output, report, raised, done) &
      !$omp num_threads(thread_count(given%threads, given%n)) reduction(join:total)
      do first = 1, given%n, WIDTH
         n = min(WIDTH, given%n - first + 1)
         do i = 1, n
            j(i) = first - 1 + i
            if (associated(arrays%list)) j(i) = arrays%list(j(i)) + 1
            k(i) = 1
            if (associated(arrays%material)) k(i) = arrays%material(j(i)) + 1
         end do
         done = .false.
         if (lanes) call fetch(arrays, j(:n), min(first - 1 + WIDTH, given%n - n))
         if (lanes) call update_together(material, arrays, j(:n), k(:n), given%tangent, output, report, done)
         do i = 1, n
            raised = .false.
            select case (task)
            case (BEGIN)
               call begin_point(material(k(i))%par, arrays, j(i), is_total(given%tangent), raised, report(i))
            case (UPDATE)
               if (.not. done(i)) call update_point(material(k(i))%par, arrays, j(i), given%tangent, output(i), &
                                                    report(i))
               if (report(i)%status == MUD_OK) call give_results(arrays, j(i), output(i))
            case default
               call retain_point(material(k(i))%par, arrays, j(i), report(i))
            end select
            if (associated(arrays%codes)) arrays%codes(j(i)) = report(i)%status
            if (associated(arrays%reports)) arrays%reports(j(i)) = report(i)
            call add(of_point(report(i), j(i) - 1, raised), total)
            if (task == UPDATE .and. report(i)%status == MUD_OK) then
               if (output(i)%statev(S_OPEN) > 0.5_wp) total%open = total%open + 1
            end if
         end do
      end do
      !$omp end parallel do
      run = total%failed
      if (.not. c_associated(summary)) return
      call c_f_pointer(summary, place)
      place = total
   end function run

   !> Status of the counts and the kind of tangent of a call, and of an array that the task needs and that is missing;
   !> no points need none.
   pure function fault_of(task, given) result(status)
      integer, intent(in) :: task
      type(points_t), intent(in) :: given
      type(mud_status_t) :: status
      logical :: complete

      select case (task)
      case (BEGIN)
         complete = c_associated(given%stress0) .and. c_associated(given%stress1) .and. c_associated(given%statev1)
      case (UPDATE)
         complete = c_associated(given%stress0) .and. c_associated(given%statev0)
         if (.not. is_present(given%tangent)) complete = complete .and. c_associated(given%dstrain) &
            .and. c_associated(given%stress1) .and. c_associated(given%statev1)
      case default
         complete = c_associated(given%statev0)
      end select
      if (given%n /= 0 .and. .not. complete) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      else if (given%n_statev < NSTATV_BASE) then
         status = fail(MUD_BAD_NSTATV, ON_STATEV)
      else if (given%n < 0 .or. kind_of(given%tangent) < 0) then
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT)
      end if
   end function fault_of

   !> The arrays, as long as the largest number in the list needs. MUD_BAD_OPTION for a number below 0, and for a
   !> material that is not there.
   subroutine find_arrays(task, given, n_materials, arrays, status)
      integer, intent(in) :: task, n_materials
      type(points_t), intent(in) :: given
      type(arrays_t), intent(out) :: arrays
      type(mud_status_t), intent(out) :: status
      integer :: n, m, i, k
      logical :: writes

      n = given%n
      m = given%n_statev
      if (c_associated(given%list)) then
         call c_f_pointer(given%list, arrays%list, [given%n])
         n = maxval(arrays%list) + 1
         i = min(0, minval(arrays%list))
         if (i < 0) status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(i, wp), 0.0_wp, huge(1.0_wp))
         if (status%code /= MUD_OK) return
      end if
      if (c_associated(given%material)) then
         call c_f_pointer(given%material, arrays%material, [n])
         do i = 1, given%n
            k = i
            if (associated(arrays%list)) k = arrays%list(i) + 1
            if (arrays%material(k) >= 0 .and. arrays%material(k) < n_materials) cycle
            status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(arrays%material(k), wp), 0.0_wp, &
                          real(n_materials - 1, wp))
            return
         end do
      end if
      writes = task == BEGIN .or. (task == UPDATE .and. .not. is_present(given%tangent))
      if (c_associated(given%stress0)) call c_f_pointer(given%stress0, arrays%stress0, [6, n])
      if (c_associated(given%statev0)) call c_f_pointer(given%statev0, arrays%statev0, [m, n])
      if (c_associated(given%dstrain)) call c_f_pointer(given%dstrain, arrays%strain, [6, n])
      if (c_associated(given%suction)) call c_f_pointer(given%suction, arrays%suction, [n])
      if (c_associated(given%void_ratio)) call c_f_pointer(given%void_ratio, arrays%void_ratio, [n])
      if (c_associated(given%saturation)) call c_f_pointer(given%saturation, arrays%saturation, [n])
      if (writes) call c_f_pointer(given%stress1, arrays%stress1, [6, n])
      if (writes) call c_f_pointer(given%statev1, arrays%statev1, [m, n])
      if (c_associated(given%dsig_deps)) call c_f_pointer(given%dsig_deps, arrays%c, [6, 6, n])
      if (c_associated(given%dsig_dpc)) call c_f_pointer(given%dsig_dpc, arrays%c_pc, [6, n])
      if (c_associated(given%dsw_deps)) call c_f_pointer(given%dsw_deps, arrays%sw_e, [6, n])
      if (c_associated(given%dsw_dpc)) call c_f_pointer(given%dsw_dpc, arrays%sw_pc, [n])
      if (c_associated(given%s_w)) call c_f_pointer(given%s_w, arrays%s_w, [n])
      if (c_associated(given%status)) call c_f_pointer(given%status, arrays%codes, [n])
      if (c_associated(given%reports)) call c_f_pointer(given%reports, arrays%reports, [n])
   end subroutine find_arrays

   !> A start of point j; raised tells that its mean stress was lifted to p_min.
   subroutine begin_point(par, arrays, j, total, raised, report)
      type(params_t), intent(in) :: par
      type(arrays_t), intent(in) :: arrays
      integer, intent(in) :: j
      logical, intent(in) :: total   !< Stress is total stress less air pressure.
      logical, intent(out) :: raised
      type(report_t), intent(out) :: report
      real(wp) :: stress(6), begun(6), statev(NSTATV), suction, e, preset
      integer(c_int), target :: number
      integer :: n

      raised = .false.
      suction = number_at(arrays%suction, j)
      e = number_at(arrays%void_ratio, j)
      preset = number_at(arrays%saturation, j)
      begun = arrays%stress0(:, j)
      if (total) begun = effective_stress(begun, first_saturation(par, suction, e, preset), suction)
      stress = begun
      n = min(size(arrays%statev1, 1), NSTATV)
      call kernel_begin(par, begun, suction, e, statev(:n), report, preset)
      if (report%status /= MUD_OK) return
      n = min(n, statev_size(par%options_t))
      raised = any(abs(begun - stress) > 0.0_wp)
      number = j - 1
      call remark_on_begun(par, stress, statev(:n), place_t('mud_init_points', point=c_loc(number)))
      if (total) begun = total_stress(begun, statev(S_SATURATION), suction)
      arrays%stress1(:, j) = begun
      arrays%statev1(1:n, j) = statev(1:n)
      if (associated(arrays%s_w)) arrays%s_w(j) = statev(S_SATURATION)
   end subroutine begin_point

   !> S_w with which a point will begin; 0 where kernel_begin refuses its numbers.
   pure real(wp) function first_saturation(par, suction, void_ratio, preset) result(s_w)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: suction, void_ratio, preset
      type(saturation_t) :: sat
      real(wp) :: e, given

      s_w = 0.0_wp
      if (.not. (is_finite(suction) .and. is_finite(void_ratio) .and. is_finite(preset))) return
      e = void_ratio
      if (abs(e) <= 0.0_wp) e = par%e_0
      if (e <= E_LOWER .or. e >= E_UPPER) return
      sat = saturation(par%suction%retention_t, suction, e)
      s_w = sat%s_w
      given = read_preset(par%suction%retention_t, preset)
      if (given > 0.0_wp) s_w = given
   end function first_saturation

   !> Brings near what the points j will write, and as many behind the number `before` of the call will read.
   subroutine fetch(arrays, j, before)
      type(arrays_t), intent(in) :: arrays
      integer, intent(in) :: j(:), before
      integer :: i, next

      do i = 1, size(j)
         next = before + i
         if (associated(arrays%list)) next = arrays%list(next) + 1
         call mud_fetch(c_loc(arrays%statev0(1, next)), 8*size(arrays%statev0, 1))
         call mud_fetch(c_loc(arrays%statev1(1, j(i))), 8*size(arrays%statev1, 1))
         if (associated(arrays%c)) call mud_fetch(c_loc(arrays%c(1, 1, j(i))), 8*36)
      end do
   end subroutine fetch

   !> Increments of the points j of materials k side by side, those of a row with one material together; done tells
   !> which need no other answer.
   subroutine update_together(material, arrays, j, k, tangent, output, report, done)
      type(prepared_t), intent(in), contiguous :: material(:)
      type(arrays_t), intent(in) :: arrays
      integer, intent(in) :: j(:), k(:)
      integer(c_int), intent(in) :: tangent
      type(output_t), intent(inout) :: output(WIDTH)
      type(report_t), intent(inout) :: report(WIDTH)
      logical, intent(inout) :: done(WIDTH)
      type(given_t) :: given(WIDTH)
      integer :: i, first

      first = 1
      do i = 1, size(j)
         given(i) = increment_of(arrays, j(i))
         if (i < size(j)) then
            if (k(i + 1) == k(first)) cycle
         end if
         call update_side_by_side(material(k(first))%par, given(first:i), tangent, output(first:i), report(first:i), &
                                  done(first:i))
         first = i + 1
      end do
   end subroutine update_together

   !> An increment of point j as the arrays have it.
   type(given_t) function increment_of(arrays, j) result(given)
      type(arrays_t), intent(in) :: arrays
      integer, intent(in) :: j

      given%stress = arrays%stress0(:, j)
      given%statev => arrays%statev0(:, j)
      given%d_strain = 0.0_wp
      if (associated(arrays%strain)) given%d_strain = arrays%strain(:, j)
      given%suction = given%statev(S_SUCTION)
      if (associated(arrays%suction)) given%suction = arrays%suction(j)
   end function increment_of

   !> An increment of point j.
   subroutine update_point(par, arrays, j, tangent, output, report)
      type(params_t), intent(in) :: par
      type(arrays_t), intent(in) :: arrays
      integer, intent(in) :: j
      integer(c_int), intent(in) :: tangent
      type(output_t), intent(inout) :: output
      type(report_t), intent(out) :: report
      type(given_t) :: given

      given = increment_of(arrays, j)
      call host_increment(par, given%stress, given%statev, given%d_strain, given%suction, int(tangent), output, report)
   end subroutine update_point

   !> Results of point j to their places.
   subroutine give_results(arrays, j, output)
      type(arrays_t), intent(in) :: arrays
      integer, intent(in) :: j
      type(output_t), intent(in) :: output
      integer(c_int), target :: number

      number = j - 1
      call remark_on_void_ratio(output%statev, place_t('mud_update_points', point=c_loc(number)))
      if (associated(arrays%stress1)) call give(6, output%stress, arrays%stress1(:, j))
      if (associated(arrays%statev1)) call copy_statev(output%n_statev, output%statev, arrays%statev1(:, j))
      if (output%has_tangent) then
         if (associated(arrays%c)) call give(36, output%dsig_deps, arrays%c(:, :, j))
         if (associated(arrays%c_pc)) call give(6, output%dsig_dpc, arrays%c_pc(:, j))
      end if
      if (associated(arrays%sw_e)) call give(6, output%dsw_deps, arrays%sw_e(:, j))
      if (associated(arrays%sw_pc)) arrays%sw_pc(j) = output%dsw_dpc
      if (associated(arrays%s_w)) arrays%s_w(j) = output%statev(S_SATURATION)
   end subroutine give_results

   !> Numbers to their place, most at once where their count is known.
   pure subroutine give(n, from, to)
      integer, intent(in) :: n
      real(wp), intent(in) :: from(n)
      real(wp), intent(out) :: to(n)

      to = from
   end subroutine give

   !> S_w and its slopes of point j at another suction.
   subroutine retain_point(par, arrays, j, report)
      type(params_t), intent(in) :: par
      type(arrays_t), intent(in) :: arrays
      integer, intent(in) :: j
      type(report_t), intent(out) :: report
      type(saturation_t) :: sat
      type(mud_status_t) :: status
      real(wp) :: suction

      suction = arrays%statev0(S_SUCTION, j)
      if (associated(arrays%suction)) suction = arrays%suction(j)
      call state_saturation(par, arrays%statev0(:, j), suction, sat, status)
      report = failed_report(status)
      if (status%code /= MUD_OK) return
      if (associated(arrays%s_w)) arrays%s_w(j) = sat%s_w
      if (associated(arrays%sw_pc)) arrays%sw_pc(j) = sat%ds_dpc
      if (associated(arrays%sw_e)) arrays%sw_e(:, j) = [1.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]* &
                                                       (1.0_wp + arrays%statev0(S_VOID_RATIO, j))*sat%ds_de
   end subroutine retain_point

   pure function no_points() result(none)
      type(summary_t) :: none

      none = summary_t(report=failed_report(mud_status_t()))
   end function no_points

   !> Summary of one point; whether the point is open is told by its state.
   pure function of_point(report, number, raised) result(one)
      type(report_t), intent(in) :: report
      integer, intent(in) :: number   !< From 0.
      logical, intent(in) :: raised   !< The point began, with its mean stress lifted.
      type(summary_t) :: one

      one = summary_t(pnewdt=report%pnewdt, rates=real(report%counters%rate, wp), &
                      substeps=real(report%counters%substep, wp), report=report)
      if (raised) one%lifted = 1
      if (report%status == MUD_OK) then
         one%tensile = report%counters%tensile
      else
         one%failed = 1
         one%worst = number
      end if
   end function of_point

   !> One summary into another, in any order: the worst is the point that got least far, of equals the smallest number.
   pure subroutine add(one, total)
      type(summary_t), intent(in) :: one
      type(summary_t), intent(inout) :: total
      logical :: worse

      worse = one%failed > 0
      if (worse .and. total%failed > 0) worse = one%report%reached < total%report%reached .or. &
         (.not. one%report%reached > total%report%reached .and. one%worst < total%worst)
      if (worse) then
         total%worst = one%worst
         total%report = one%report
      end if
      total%failed = total%failed + one%failed
      total%open = total%open + one%open
      total%tensile = total%tensile + one%tensile
      total%lifted = total%lifted + one%lifted
      total%pnewdt = min(total%pnewdt, one%pnewdt)
      total%rates = total%rates + one%rates
      total%substeps = total%substeps + one%substeps
   end subroutine add

   !> The number asked for, at most one a point and MOST_THREADS: a process ends where the system gives it no more. 0 or
   !> less means what OpenMP would take. 1 in a process that may not use threads.
   integer function thread_count(threads, points)
      !$ use omp_lib, only: omp_get_max_threads
      integer(c_int), intent(in) :: threads, points
      integer, parameter :: MOST_THREADS = 1024

      thread_count = max(min(threads, points, MOST_THREADS), 1)
      !$ if (threads <= 0) thread_count = omp_get_max_threads()
      if (thread_count > 1) then
         if (.not. may_use_threads()) thread_count = 1
      end if
   end function thread_count
end module mud_batch
