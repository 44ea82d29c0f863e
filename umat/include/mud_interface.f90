! SPDX-License-Identifier: MIT
!> Fortran view of mud.h, for hosts: interfaces only, nothing of the library's inside. Compile it with your code.
!> Conventions, meanings and errors are those of mud.h; indices are those of C, from 0.
module mud_interface
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_char
   implicit none (type, external)
   private
   public :: mud_report, mud_abi_version, mud_version, mud_count, mud_index, mud_text, mud_option, mud_bounds, &
             mud_bounds_for, mud_default_props, mud_convert_props, mud_validate_props, mud_init_state, &
             mud_update, mud_update_batch, mud_status_text, mud_message, mud_substep, mud_trace_increment, &
             mud_save_increment, mud_prepared_size, mud_prepare, mud_update_prepared, mud_update_batch_prepared, &
             mud_saturation, mud_state_saturation, mud_summary, mud_init_batch, mud_update_list, mud_tangent_list, &
             mud_effective_stress, mud_total_stress, mud_total_blocks
   public :: MUD_PROPS, MUD_STATEV, MUD_NAME, MUD_SYMBOL, MUD_UNIT, MUD_ORIGIN, MUD_MEANING, MUD_INITIAL, &
      MUD_ROTATION, MUD_EVOLUTION
   public :: MUD_SUBSTEP_REJECTED, MUD_SUBSTEP_ACCEPTED, MUD_SUBSTEP_FAILED, MUD_MODE_ORDINARY, MUD_MODE_ELASTIC, &
      MUD_MODE_HELD, MUD_JUMP_NONE, MUD_JUMP_REVERSAL, MUD_JUMP_RETURN, MUD_JUMP_NEW
   public :: MUD_TANGENT_NONE, MUD_TANGENT_ELASTIC, MUD_TANGENT_CONTINUUM, MUD_TANGENT_CONSISTENT

   integer(c_int), parameter :: MUD_PROPS = 1, MUD_STATEV = 2
   integer(c_int), parameter :: MUD_NAME = 1, MUD_SYMBOL = 2, MUD_UNIT = 3, MUD_ORIGIN = 4, MUD_MEANING = 5, &
      MUD_INITIAL = 6, MUD_ROTATION = 7, MUD_EVOLUTION = 8
   integer(c_int), parameter :: MUD_TANGENT_NONE = 0, MUD_TANGENT_ELASTIC = 1, MUD_TANGENT_CONTINUUM = 2, &
                                MUD_TANGENT_CONSISTENT = 3

   integer(c_int), parameter :: MUD_SUBSTEP_REJECTED = 0, MUD_SUBSTEP_ACCEPTED = 1, MUD_SUBSTEP_FAILED = 2
   integer(c_int), parameter :: MUD_MODE_ORDINARY = 0, MUD_MODE_ELASTIC = 1, MUD_MODE_HELD = 2
   integer(c_int), parameter :: MUD_JUMP_NONE = 0, MUD_JUMP_REVERSAL = 1, MUD_JUMP_RETURN = 2, MUD_JUMP_NEW = 3

   !> struct mud_report of mud.h.
   type, bind(c) :: mud_report
      integer(c_int) :: status, subject, index, n_rate, n_substep, n_reject, n_reset, n_floor, n_cap_d, n_cap_h, &
                        n_hysteresis, n_iso_kept, n_no_root, n_min_step, n_open, n_tensile
      real(c_double) :: value, lower, upper, reached, pnewdt
   end type mud_report

   !> struct mud_substep of mud.h.
   type, bind(c) :: mud_substep
      integer(c_int) :: outcome, mode, jump, landed, n_rate, n_reset, n_guard, n_no_root
      real(c_double) :: time, size, error, void_ratio, saturation, suction, stress(6)
   end type mud_substep

   !> struct mud_summary of mud.h.
   type, bind(c) :: mud_summary
      integer(c_int) :: failed, first, status, n_open, n_tensile
      real(c_double) :: pnewdt, n_rate, n_substep
   end type mud_summary

   interface
      integer(c_int) function mud_abi_version() bind(c, name='mud_abi_version')
         import :: c_int
      end function mud_abi_version

      integer(c_int) function mud_version(text, len) bind(c, name='mud_version')
         import :: c_int, c_char
         character(kind=c_char), intent(out) :: text(*)
         integer(c_int), value :: len
      end function mud_version

      integer(c_int) function mud_count(list) bind(c, name='mud_count')
         import :: c_int
         integer(c_int), value :: list
      end function mud_count

      !> The name must end with c_null_char.
      integer(c_int) function mud_index(list, name) bind(c, name='mud_index')
         import :: c_int, c_char
         integer(c_int), value :: list
         character(kind=c_char), intent(in) :: name(*)
      end function mud_index

      integer(c_int) function mud_text(list, index, field, text, len) bind(c, name='mud_text')
         import :: c_int, c_char
         integer(c_int), value :: list, index, field, len
         character(kind=c_char), intent(out) :: text(*)
      end function mud_text

      integer(c_int) function mud_option(index, number, value, word, len) bind(c, name='mud_option')
         import :: c_int, c_double, c_char
         integer(c_int), value :: index, number, len
         real(c_double), intent(inout) :: value
         character(kind=c_char), intent(inout) :: word(*)
      end function mud_option

      integer(c_int) function mud_bounds(list, index, lower, upper, preset) bind(c, name='mud_bounds')
         import :: c_int, c_double
         integer(c_int), value :: list, index
         real(c_double), intent(out) :: lower, upper, preset
      end function mud_bounds

      integer(c_int) function mud_bounds_for(props, nprops, index, lower, upper, preset) bind(c, name='mud_bounds_for')
         import :: c_int, c_double
         integer(c_int), value :: nprops, index
         real(c_double), intent(in) :: props(nprops)
         real(c_double), intent(out) :: lower, upper, preset
      end function mud_bounds_for

      integer(c_int) function mud_default_props(props, nprops) bind(c, name='mud_default_props')
         import :: c_int, c_double
         integer(c_int), value :: nprops
         real(c_double), intent(out) :: props(nprops)
      end function mud_default_props

      integer(c_int) function mud_convert_props(props, nprops, factor) bind(c, name='mud_convert_props')
         import :: c_int, c_double
         integer(c_int), value :: nprops
         real(c_double), intent(inout) :: props(nprops)
         real(c_double), value :: factor
      end function mud_convert_props

      integer(c_int) function mud_validate_props(props, nprops, text, len) bind(c, name='mud_validate_props')
         import :: c_int, c_double, c_char
         integer(c_int), value :: nprops, len
         real(c_double), intent(in) :: props(nprops)
         character(kind=c_char), intent(out) :: text(*)
      end function mud_validate_props

      integer(c_int) function mud_init_state(props, nprops, stress, suction, void_ratio, statev, nstatev, text, len) &
         bind(c, name='mud_init_state')
         import :: c_int, c_double, c_char
         integer(c_int), value :: nprops, nstatev, len
         real(c_double), intent(in) :: props(nprops)
         real(c_double), intent(inout) :: stress(6)
         real(c_double), value :: suction, void_ratio
         real(c_double), intent(inout) :: statev(nstatev)
         character(kind=c_char), intent(out) :: text(*)
      end function mud_init_state

      integer(c_int) function mud_update(props, nprops, stress0, statev0, nstatev, dstrain, suction0, dsuction, &
              tangent, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report) bind(c, name='mud_update')
         import :: c_int, c_double, mud_report
         integer(c_int), value :: nprops, nstatev, tangent
         real(c_double), intent(in) :: props(nprops), stress0(6), statev0(nstatev), dstrain(6)
         real(c_double), value :: suction0, dsuction
         real(c_double), intent(inout) :: stress1(6), statev1(nstatev)
         real(c_double), intent(inout), optional :: dsig_deps(6, 6), dsig_dpc(6), dsw_deps(6), dsw_dpc
         type(mud_report), intent(out), optional :: report
      end function mud_update

      !> n points at once: the number of failed ones, or a negative code.
      integer(c_int) function mud_update_batch(props, nprops, n, stress0, statev0, nstatev, dstrain, suction0, &
              dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status, &
              reports) bind(c, name='mud_update_batch')
         import :: c_int, c_double, mud_report
         integer(c_int), value :: nprops, n, nstatev, tangent, threads
         real(c_double), intent(in) :: props(nprops), stress0(6, n), statev0(nstatev, n), dstrain(6, n)
         real(c_double), intent(in), optional :: suction0(n), dsuction(n)
         real(c_double), intent(inout) :: stress1(6, n), statev1(nstatev, n)
         real(c_double), intent(inout), optional :: dsig_deps(6, 6, n), dsig_dpc(6, n), dsw_deps(6, n), dsw_dpc(n)
         integer(c_int), intent(out) :: status(n)
         type(mud_report), intent(out), optional :: reports(n)
      end function mud_update_batch

      !> Doubles of a prepared material.
      pure integer(c_int) function mud_prepared_size() bind(c, name='mud_prepared_size')
         import :: c_int
      end function mud_prepared_size

      integer(c_int) function mud_prepare(props, nprops, prepared, size_, text, len) bind(c, name='mud_prepare')
         import :: c_int, c_double, c_char
         integer(c_int), value :: nprops, size_, len
         real(c_double), intent(in) :: props(nprops)
         real(c_double), intent(inout) :: prepared(size_)
         character(kind=c_char), intent(out) :: text(*)
      end function mud_prepare

      integer(c_int) function mud_update_prepared(prepared, stress0, statev0, nstatev, dstrain, suction0, dsuction, &
              tangent, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report) &
              bind(c, name='mud_update_prepared')
         import :: c_int, c_double, mud_report
         integer(c_int), value :: nstatev, tangent
         real(c_double), intent(in) :: prepared(*), stress0(6), statev0(nstatev), dstrain(6)
         real(c_double), value :: suction0, dsuction
         real(c_double), intent(inout) :: stress1(6), statev1(nstatev)
         real(c_double), intent(inout), optional :: dsig_deps(6, 6), dsig_dpc(6), dsw_deps(6), dsw_dpc
         type(mud_report), intent(out), optional :: report
      end function mud_update_prepared

      integer(c_int) function mud_update_batch_prepared(prepared, n, stress0, statev0, nstatev, dstrain, suction0, &
              dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status, &
              reports) bind(c, name='mud_update_batch_prepared')
         import :: c_int, c_double, mud_report
         integer(c_int), value :: n, nstatev, tangent, threads
         real(c_double), intent(in) :: prepared(*), stress0(6, n), statev0(nstatev, n), dstrain(6, n)
         real(c_double), intent(in), optional :: suction0(n), dsuction(n)
         real(c_double), intent(inout) :: stress1(6, n), statev1(nstatev, n)
         real(c_double), intent(inout), optional :: dsig_deps(6, 6, n), dsig_dpc(6, n), dsw_deps(6, n), dsw_dpc(n)
         integer(c_int), intent(out) :: status(n)
         type(mud_report), intent(out), optional :: reports(n)
      end function mud_update_batch_prepared

      integer(c_int) function mud_saturation(prepared, suction, void_ratio, s_w, ds_dpc, ds_de) &
         bind(c, name='mud_saturation')
         import :: c_int, c_double
         real(c_double), intent(in) :: prepared(*)
         real(c_double), value :: suction, void_ratio
         real(c_double), intent(inout), optional :: s_w, ds_dpc, ds_de
      end function mud_saturation

      integer(c_int) function mud_state_saturation(prepared, statev, nstatev, suction, s_w, ds_dpc, ds_dev) &
         bind(c, name='mud_state_saturation')
         import :: c_int, c_double
         integer(c_int), value :: nstatev
         real(c_double), intent(in) :: prepared(*), statev(nstatev)
         real(c_double), value :: suction
         real(c_double), intent(inout), optional :: s_w, ds_dpc, ds_dev
      end function mud_state_saturation

      !> Numbers of points are those of C, from 0; arrays are those of all points.
      integer(c_int) function mud_init_batch(prepared, n, points, stress, suction, void_ratio, statev, nstatev, &
              lifted, status) bind(c, name='mud_init_batch')
         import :: c_int, c_double
         integer(c_int), value :: n, nstatev
         integer(c_int), intent(in), optional :: points(n)
         real(c_double), intent(in) :: prepared(*)
         real(c_double), intent(in), optional :: suction(*), void_ratio(*)
         real(c_double), intent(inout) :: stress(6, *), statev(nstatev, *)
         integer(c_int), intent(inout), optional :: lifted(*)
         integer(c_int), intent(inout) :: status(*)
      end function mud_init_batch

      integer(c_int) function mud_update_list(prepared, n, points, stress0, statev0, nstatev, dstrain, suction0, &
              dsuction, tangent, threads, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status, &
              reports, summary) bind(c, name='mud_update_list')
         import :: c_int, c_double, mud_report, mud_summary
         integer(c_int), value :: n, nstatev, tangent, threads
         integer(c_int), intent(in), optional :: points(n)
         real(c_double), intent(in) :: prepared(*), stress0(6, *), statev0(nstatev, *), dstrain(6, *)
         real(c_double), intent(in), optional :: suction0(*), dsuction(*)
         real(c_double), intent(inout) :: stress1(6, *), statev1(nstatev, *)
         real(c_double), intent(inout), optional :: dsig_deps(6, 6, *), dsig_dpc(6, *), dsw_deps(6, *), dsw_dpc(*)
         integer(c_int), intent(inout) :: status(*)
         type(mud_report), intent(inout), optional :: reports(*)
         type(mud_summary), intent(out), optional :: summary
      end function mud_update_list

      integer(c_int) function mud_tangent_list(prepared, n, points, stress, statev, nstatev, direction, suction, &
              dsuction, threads, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, status, summary) &
              bind(c, name='mud_tangent_list')
         import :: c_int, c_double, mud_summary
         integer(c_int), value :: n, nstatev, threads
         integer(c_int), intent(in), optional :: points(n)
         real(c_double), intent(in) :: prepared(*), stress(6, *), statev(nstatev, *)
         real(c_double), intent(in), optional :: direction(6, *), suction(*), dsuction(*)
         real(c_double), intent(inout), optional :: dsig_deps(6, 6, *), dsig_dpc(6, *), dsw_deps(6, *), dsw_dpc(*)
         integer(c_int), intent(inout) :: status(*)
         type(mud_summary), intent(out), optional :: summary
      end function mud_tangent_list

      integer(c_int) function mud_effective_stress(n, total, air_pressure, s_w, suction, effective) &
         bind(c, name='mud_effective_stress')
         import :: c_int, c_double
         integer(c_int), value :: n
         real(c_double), intent(in) :: total(6, n), s_w(n), suction(n)
         real(c_double), intent(in), optional :: air_pressure(n)
         real(c_double), intent(inout) :: effective(6, n)
      end function mud_effective_stress

      integer(c_int) function mud_total_stress(n, effective, air_pressure, s_w, suction, total) &
         bind(c, name='mud_total_stress')
         import :: c_int, c_double
         integer(c_int), value :: n
         real(c_double), intent(in) :: effective(6, n), s_w(n), suction(n)
         real(c_double), intent(in), optional :: air_pressure(n)
         real(c_double), intent(inout) :: total(6, n)
      end function mud_total_stress

      integer(c_int) function mud_total_blocks(n, s_w, suction, dsw_deps, dsw_dpc, dsig_deps, dsig_dpc) &
         bind(c, name='mud_total_blocks')
         import :: c_int, c_double
         integer(c_int), value :: n
         real(c_double), intent(in) :: s_w(n), suction(n), dsw_deps(6, n), dsw_dpc(n)
         real(c_double), intent(inout), optional :: dsig_deps(6, 6, n), dsig_dpc(6, n)
      end function mud_total_blocks

      integer(c_int) function mud_trace_increment(props, nprops, stress0, statev0, nstatev, dstrain, suction0, &
              dsuction, tangent, first, rows, nrows, attempts, report) bind(c, name='mud_trace_increment')
         import :: c_int, c_double, mud_report, mud_substep
         integer(c_int), value :: nprops, nstatev, tangent, first, nrows
         real(c_double), intent(in) :: props(nprops), stress0(6), statev0(nstatev), dstrain(6)
         real(c_double), value :: suction0, dsuction
         type(mud_substep), intent(inout) :: rows(nrows)
         integer(c_int), intent(out) :: attempts
         type(mud_report), intent(out), optional :: report
      end function mud_trace_increment

      !> The texts handed over must end with c_null_char.
      integer(c_int) function mud_save_increment(path, origin, props, nprops, stress0, statev0, nstatev, dstrain, &
              suction0, dsuction, tangent, text, len) bind(c, name='mud_save_increment')
         import :: c_int, c_double, c_char
         character(kind=c_char), intent(in) :: path(*), origin(*)
         integer(c_int), value :: nprops, nstatev, tangent, len
         real(c_double), intent(in) :: props(nprops), stress0(6), statev0(nstatev), dstrain(6)
         real(c_double), value :: suction0, dsuction
         character(kind=c_char), intent(out) :: text(*)
      end function mud_save_increment

      integer(c_int) function mud_status_text(code, text, len) bind(c, name='mud_status_text')
         import :: c_int, c_char
         integer(c_int), value :: code, len
         character(kind=c_char), intent(out) :: text(*)
      end function mud_status_text

      integer(c_int) function mud_message(report, text, len) bind(c, name='mud_message')
         import :: c_int, c_char, mud_report
         type(mud_report), intent(in) :: report
         integer(c_int), value :: len
         character(kind=c_char), intent(out) :: text(*)
      end function mud_message
   end interface
end module mud_interface
