! SPDX-License-Identifier: MIT
!> Many points begin, and the stresses of many points: mud_init_batch, mud_effective_stress, mud_total_stress and
!> mud_total_blocks of mud.h.
module mud_batch_start
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_kernel, only: report_t, kernel_begin
   use mud_kinds, only: wp
   use mud_prepared, only: prepared_t, find_prepared
   use mud_registry, only: NSTATV
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_BAD_NSTATV, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, ON_STATEV, &
      ON_ARGUMENT
   use mud_tensor, only: is_finite
   use mud_to_host, only: number_at, find_list
   use mud_total, only: effective_stress, total_stress, total_blocks
   implicit none (type, external)
   private
   public :: mud_init_batch, mud_effective_stress, mud_total_stress, mud_total_blocks

contains
   !> Fills STATEV of n points. A point that fails keeps its stress and STATEV. Tension positive, stress and suction in
   !> the unit of p_atm, void ratio [-]. Returns the number of failed points, their codes are in status_out, or a
   !> negative code where nothing was done; see mud.h.
   integer(c_int) function mud_init_batch(prepared, n, points, stress, suction, void_ratio, statev, n_statev, lifted, &
           status_out) bind(c, name='mud_init_batch')
      type(c_ptr), value :: prepared, points, stress, suction, void_ratio, statev, lifted, status_out
      integer(c_int), value :: n, n_statev
      type(prepared_t), pointer :: material
      type(mud_status_t) :: status
      type(report_t) :: report
      integer(c_int), pointer, contiguous :: list(:), codes(:), raised(:)
      real(c_double), pointer, contiguous :: s(:, :), v(:, :), pc(:), e(:)
      real(wp) :: before(6)
      integer :: i, j, extent

      if (.not. (c_associated(stress) .and. c_associated(statev) .and. c_associated(status_out))) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      else if (n_statev < NSTATV) then
         status = fail(MUD_BAD_NSTATV, ON_STATEV)
      else if (n < 0) then
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT)
      else
         call find_prepared(prepared, material, status)
      end if
      if (status%code == MUD_OK) call find_list(points, n, list, extent, status)
      mud_init_batch = status%code
      if (status%code /= MUD_OK) return
      call c_f_pointer(stress, s, [6, extent])
      call c_f_pointer(statev, v, [int(n_statev), extent])
      call c_f_pointer(status_out, codes, [extent])
      nullify (raised, pc, e)
      if (c_associated(lifted)) call c_f_pointer(lifted, raised, [extent])
      if (c_associated(suction)) call c_f_pointer(suction, pc, [extent])
      if (c_associated(void_ratio)) call c_f_pointer(void_ratio, e, [extent])
      do i = 1, n
         j = i
         if (associated(list)) j = list(i) + 1
         before = s(:, j)
         call kernel_begin(material%par, s(:, j), number_at(pc, j), number_at(e, j), v(:, j), report)
         codes(j) = report%status
         if (report%status /= MUD_OK) mud_init_batch = mud_init_batch + 1
         if (associated(raised)) raised(j) = merge(1, 0, report%status == MUD_OK .and. is_lifted(before, s(:, j)))
      end do
   end function mud_init_batch

   !> True of a stress that was changed. A NaN is not compared, for it would trap; it is refused before.
   pure logical function is_lifted(before, after)
      real(wp), intent(in) :: before(6), after(6)

      is_lifted = .false.
      if (all(is_finite(before))) is_lifted = any(abs(after - before) > 0.0_wp)
   end function is_lifted

   !> sigma' = sigma + (p_a - S_w p_c) I of n points; effective may be total. Tension positive, one unit of stress for
   !> all, S_w [-]; MUD_BAD_OPTION for n < 0, MUD_NULL_ARGUMENT. docs/theory/material.md section 1.1.
   integer(c_int) function mud_effective_stress(n, total, air_pressure, s_w, suction, effective) &
      bind(c, name='mud_effective_stress')
      integer(c_int), value :: n
      type(c_ptr), value :: total, air_pressure, s_w, suction, effective
      real(c_double), pointer, contiguous :: from(:, :), into(:, :), air(:), sw(:), pc(:)
      integer :: i

      call find_stresses(n, total, air_pressure, s_w, suction, effective, from, into, air, sw, pc, mud_effective_stress)
      if (mud_effective_stress /= MUD_OK) return
      do i = 1, n
         into(:, i) = effective_stress(from(:, i), number_at(air, i), sw(i), pc(i))
      end do
   end function mud_effective_stress

   !> sigma = sigma' - (p_a - S_w p_c) I of n points; total may be effective. Tension positive, one unit of stress for
   !> all, S_w [-]; MUD_BAD_OPTION for n < 0, MUD_NULL_ARGUMENT. docs/theory/material.md section 1.1.
   integer(c_int) function mud_total_stress(n, effective, air_pressure, s_w, suction, total) &
      bind(c, name='mud_total_stress')
      integer(c_int), value :: n
      type(c_ptr), value :: effective, air_pressure, s_w, suction, total
      real(c_double), pointer, contiguous :: from(:, :), into(:, :), air(:), sw(:), pc(:)
      integer :: i

      call find_stresses(n, effective, air_pressure, s_w, suction, total, from, into, air, sw, pc, mud_total_stress)
      if (mud_total_stress /= MUD_OK) return
      do i = 1, n
         into(:, i) = total_stress(from(:, i), number_at(air, i), sw(i), pc(i))
      end do
   end function mud_total_stress

   subroutine find_stresses(n, given, air_pressure, s_w, suction, wanted, from, into, air, sw, pc, code)
      integer(c_int), intent(in) :: n
      type(c_ptr), intent(in) :: given, air_pressure, s_w, suction, wanted
      real(c_double), pointer, contiguous, intent(out) :: from(:, :), into(:, :), air(:), sw(:), pc(:)
      integer(c_int), intent(out) :: code

      nullify (from, into, air, sw, pc)
      code = MUD_BAD_OPTION
      if (n < 0) return
      code = MUD_NULL_ARGUMENT
      if (.not. (c_associated(given) .and. c_associated(s_w) .and. c_associated(suction) .and. c_associated(wanted))) &
         return
      code = MUD_OK
      call c_f_pointer(given, from, [6, int(n)])
      call c_f_pointer(wanted, into, [6, int(n)])
      call c_f_pointer(s_w, sw, [n])
      call c_f_pointer(suction, pc, [n])
      if (c_associated(air_pressure)) call c_f_pointer(air_pressure, air, [n])
   end subroutine find_stresses

   !> Slopes of effective stress become those of total stress, in place; either may be NULL. Units as in total_blocks of
   !> mud_total; MUD_BAD_OPTION for n < 0, MUD_NULL_ARGUMENT where S_w, suction or the slopes of S_w are missing.
   integer(c_int) function mud_total_blocks(n, s_w, suction, dsw_deps, dsw_dpc, dsig_deps, dsig_dpc) &
      bind(c, name='mud_total_blocks')
      integer(c_int), value :: n
      type(c_ptr), value :: s_w, suction, dsw_deps, dsw_dpc, dsig_deps, dsig_dpc
      real(c_double), pointer, contiguous :: sw(:), pc(:), sw_e(:, :), sw_pc(:), c(:, :, :), c_pc(:, :)
      real(wp) :: matrix(6, 6), column(6)
      integer :: i

      mud_total_blocks = MUD_BAD_OPTION
      if (n < 0) return
      mud_total_blocks = MUD_NULL_ARGUMENT
      if (.not. (c_associated(s_w) .and. c_associated(suction) .and. c_associated(dsw_deps) &
                 .and. c_associated(dsw_dpc))) return
      mud_total_blocks = MUD_OK
      nullify (c, c_pc)
      call c_f_pointer(s_w, sw, [n])
      call c_f_pointer(suction, pc, [n])
      call c_f_pointer(dsw_deps, sw_e, [6, int(n)])
      call c_f_pointer(dsw_dpc, sw_pc, [n])
      if (c_associated(dsig_deps)) call c_f_pointer(dsig_deps, c, [6, 6, int(n)])
      if (c_associated(dsig_dpc)) call c_f_pointer(dsig_dpc, c_pc, [6, int(n)])
      matrix = 0.0_wp
      column = 0.0_wp
      do i = 1, n
         if (associated(c)) matrix = c(:, :, i)
         if (associated(c_pc)) column = c_pc(:, i)
         call total_blocks(sw(i), pc(i), sw_e(:, i), sw_pc(i), matrix, column)
         if (associated(c)) c(:, :, i) = matrix
         if (associated(c_pc)) c_pc(:, i) = column
      end do
   end function mud_total_blocks
end module mud_batch_start
