! SPDX-License-Identifier: MIT
!> Fortran view of mud.h, for hosts: interfaces only, nothing of the library's inside. Compile it with your code.
!> Conventions, meanings and errors are those of mud.h; indices are those of C, from 0.
module mud_interface
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_null_ptr
   implicit none (type, external)
   private
   public :: mud_report, mud_blocks, mud_points, mud_summary, mud_substep, mud_place, mud_abi_version, mud_version, &
             mud_count, mud_index, mud_text, mud_option, mud_bounds, mud_bounds_for, mud_default_props, &
             mud_convert_props, mud_validate_props, mud_check_props, mud_prepared_size, mud_prepared_statev, &
             mud_prepared_lanes, mud_prepare, mud_saturation, mud_init, &
             mud_update, mud_init_points, mud_update_points, mud_saturation_points, mud_trace_increment, &
             mud_increment_at, mud_refuse, mud_save_increment, mud_status_text, mud_message
   public :: MUD_PROPS, MUD_STATEV, MUD_NAME, MUD_SYMBOL, MUD_UNIT, MUD_ORIGIN, MUD_MEANING, MUD_INITIAL, &
      MUD_ROTATION, MUD_EVOLUTION
   public :: MUD_SUBSTEP_REJECTED, MUD_SUBSTEP_ACCEPTED, MUD_SUBSTEP_FAILED, MUD_MODE_ORDINARY, MUD_MODE_ELASTIC, &
      MUD_MODE_HELD, MUD_JUMP_NONE, MUD_JUMP_REVERSAL, MUD_JUMP_RETURN, MUD_JUMP_NEW
   public :: MUD_TANGENT_NONE, MUD_TANGENT_ELASTIC, MUD_TANGENT_CONTINUUM, MUD_TANGENT_CONSISTENT, &
      MUD_TANGENT_PRESENT, MUD_TOTAL_STRESS, MUD_IN_PIECES, MUD_LANES
   public :: MUD_OK, MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_BAD_NTENS, MUD_BAD_PROPS, MUD_BAD_STATE, MUD_BAD_INPUT, &
      MUD_NULL_ARGUMENT, MUD_BAD_VOID_RATIO, MUD_BAD_OPTION, MUD_NOT_WRITTEN, MUD_NOT_PREPARED, MUD_MINIMUM_STEP, &
      MUD_TOO_MANY_SUBSTEPS, MUD_NO_DIRECTION, MUD_VOID_RATIO_LIMIT, MUD_NOT_FINITE, MUD_INCREMENT_TOO_LARGE
   public :: MUD_ON_NOTHING, MUD_ON_PROPS, MUD_ON_STATEV, MUD_ON_STRESS, MUD_ON_STRAIN, MUD_ON_SUCTION, &
      MUD_ON_VOID_RATIO, MUD_ON_ARGUMENT, MUD_ON_ROTATION

   integer(c_int), parameter :: MUD_OK = 0, MUD_BAD_NPROPS = -1, MUD_BAD_NSTATV = -2, MUD_BAD_NTENS = -3, &
      MUD_BAD_PROPS = -4, MUD_BAD_STATE = -5, MUD_BAD_INPUT = -6, MUD_NULL_ARGUMENT = -7, MUD_BAD_VOID_RATIO = -8, &
      MUD_BAD_OPTION = -9, MUD_NOT_WRITTEN = -10, MUD_NOT_PREPARED = -11, MUD_MINIMUM_STEP = 1, &
      MUD_TOO_MANY_SUBSTEPS = 2, MUD_NO_DIRECTION = 3, MUD_VOID_RATIO_LIMIT = 4, MUD_NOT_FINITE = 5, &
      MUD_INCREMENT_TOO_LARGE = 6
   integer(c_int), parameter :: MUD_ON_NOTHING = 0, MUD_ON_PROPS = 1, MUD_ON_STATEV = 2, MUD_ON_STRESS = 3, &
      MUD_ON_STRAIN = 4, MUD_ON_SUCTION = 5, MUD_ON_VOID_RATIO = 6, MUD_ON_ARGUMENT = 7, MUD_ON_ROTATION = 8
   integer(c_int), parameter :: MUD_PROPS = 1, MUD_STATEV = 2
   integer(c_int), parameter :: MUD_NAME = 1, MUD_SYMBOL = 2, MUD_UNIT = 3, MUD_ORIGIN = 4, MUD_MEANING = 5, &
      MUD_INITIAL = 6, MUD_ROTATION = 7, MUD_EVOLUTION = 8
   integer(c_int), parameter :: MUD_TANGENT_NONE = 0, MUD_TANGENT_ELASTIC = 1, MUD_TANGENT_CONTINUUM = 2, &
                                MUD_TANGENT_CONSISTENT = 3, MUD_TANGENT_PRESENT = 4, MUD_TOTAL_STRESS = 16, &
                                MUD_IN_PIECES = 32, MUD_LANES = 64

   integer(c_int), parameter :: MUD_SUBSTEP_REJECTED = 0, MUD_SUBSTEP_ACCEPTED = 1, MUD_SUBSTEP_FAILED = 2
   integer(c_int), parameter :: MUD_MODE_ORDINARY = 0, MUD_MODE_ELASTIC = 1, MUD_MODE_HELD = 2
   integer(c_int), parameter :: MUD_JUMP_NONE = 0, MUD_JUMP_REVERSAL = 1, MUD_JUMP_RETURN = 2, MUD_JUMP_NEW = 3

   !> struct mud_report of mud.h.
   type, bind(c) :: mud_report
      integer(c_int) :: status = MUD_OK, subject = MUD_ON_NOTHING, index = 0, n_rate = 0, n_substep = 0, &
                        n_reject = 0, n_reset = 0, n_floor = 0, n_cap_d = 0, n_cap_h = 0, n_hysteresis = 0, &
                        n_iso_kept = 0, n_no_root = 0, n_min_step = 0, n_open = 0, n_tensile = 0, n_turns_cleared = 0
      real(c_double) :: value = 0.0_c_double, lower = 0.0_c_double, upper = 0.0_c_double, reached = 0.0_c_double, &
                        pnewdt = 1.0_c_double
   end type mud_report

   !> struct mud_blocks of mud.h.
   type, bind(c) :: mud_blocks
      real(c_double) :: dsig_deps(6, 6), dsig_dpc(6), dsw_deps(6), dsw_dpc, s_w
   end type mud_blocks

   !> struct mud_points of mud.h: c_loc of your arrays, which are TARGETs; numbers of points and materials from 0.
   type, bind(c) :: mud_points
      integer(c_int) :: n = 0, nstatev = 0, tangent = MUD_TANGENT_NONE, threads = 0
      type(c_ptr) :: list = c_null_ptr, material = c_null_ptr, stress0 = c_null_ptr, statev0 = c_null_ptr, &
                     dstrain = c_null_ptr, suction = c_null_ptr, void_ratio = c_null_ptr, saturation = c_null_ptr, &
                     stress1 = c_null_ptr, statev1 = c_null_ptr, dsig_deps = c_null_ptr, dsig_dpc = c_null_ptr, &
                     dsw_deps = c_null_ptr, dsw_dpc = c_null_ptr, s_w = c_null_ptr, status = c_null_ptr, &
                     reports = c_null_ptr
   end type mud_points

   !> struct mud_summary of mud.h.
   type, bind(c) :: mud_summary
      integer(c_int) :: failed, worst, n_open, n_tensile, n_lifted
      real(c_double) :: pnewdt, n_rate, n_substep
      type(mud_report) :: report
   end type mud_summary

   !> struct mud_substep of mud.h.
   type, bind(c) :: mud_substep
      integer(c_int) :: outcome, mode, jump, landed, n_rate, n_reset, n_guard, n_no_root
      real(c_double) :: time, size, error, void_ratio, saturation, suction, stress(6)
   end type mud_substep

   !> struct mud_place of mud.h: c_loc of integers of C, or c_null_ptr.
   type, bind(c) :: mud_place
      character(kind=c_char) :: entry(24) = c_null_char
      type(c_ptr) :: step = c_null_ptr, increment = c_null_ptr, element = c_null_ptr, point = c_null_ptr
   end type mud_place

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

      integer(c_int) function mud_check_props(props, nprops, report) bind(c, name='mud_check_props')
         import :: c_int, c_double, mud_report
         integer(c_int), value :: nprops
         real(c_double), intent(in) :: props(nprops)
         type(mud_report), intent(out) :: report
      end function mud_check_props

      !> Doubles of a prepared material.
      pure integer(c_int) function mud_prepared_size() bind(c, name='mud_prepared_size')
         import :: c_int
      end function mud_prepared_size

      !> Numbers of STATEV that a point of a prepared material has; MUD_NOT_PREPARED.
      integer(c_int) function mud_prepared_statev(material) bind(c, name='mud_prepared_statev')
         import :: c_int, c_double
         real(c_double), intent(in) :: material(*)
      end function mud_prepared_statev

      !> 1 where MUD_LANES acts for a prepared material on this processor, else 0; MUD_NOT_PREPARED.
      integer(c_int) function mud_prepared_lanes(material) bind(c, name='mud_prepared_lanes')
         import :: c_int, c_double
         real(c_double), intent(in) :: material(*)
      end function mud_prepared_lanes

      integer(c_int) function mud_prepare(props, nprops, material, size_, text, len) bind(c, name='mud_prepare')
         import :: c_int, c_double, c_char
         integer(c_int), value :: nprops, size_, len
         real(c_double), intent(in) :: props(nprops)
         real(c_double), intent(inout) :: material(size_)
         character(kind=c_char), intent(out) :: text(*)
      end function mud_prepare

      integer(c_int) function mud_saturation(material, suction, void_ratio, s_w, ds_dpc, ds_de) &
         bind(c, name='mud_saturation')
         import :: c_int, c_double
         real(c_double), intent(in) :: material(*)
         real(c_double), value :: suction, void_ratio
         real(c_double), intent(inout), optional :: s_w, ds_dpc, ds_de
      end function mud_saturation

      integer(c_int) function mud_init(material, stress, suction, void_ratio, saturation, statev, nstatev, text, len) &
         bind(c, name='mud_init')
         import :: c_int, c_double, c_char
         integer(c_int), value :: nstatev, len
         real(c_double), intent(in) :: material(*)
         real(c_double), intent(inout) :: stress(6)
         real(c_double), value :: suction, void_ratio, saturation
         real(c_double), intent(inout) :: statev(nstatev)
         character(kind=c_char), intent(out) :: text(*)
      end function mud_init

      integer(c_int) function mud_update(material, stress0, statev0, nstatev, dstrain, suction, tangent, stress1, &
              statev1, blocks, report) bind(c, name='mud_update')
         import :: c_int, c_double, mud_blocks, mud_report
         integer(c_int), value :: nstatev, tangent
         real(c_double), intent(in) :: material(*), stress0(6), statev0(nstatev)
         real(c_double), intent(in), optional :: dstrain(6)
         real(c_double), value :: suction
         real(c_double), intent(inout), optional :: stress1(6), statev1(nstatev)
         type(mud_blocks), intent(inout), optional :: blocks
         type(mud_report), intent(out), optional :: report
      end function mud_update

      !> Materials one after another. Returns the number of failed points, or a negative code.
      integer(c_int) function mud_init_points(materials, nmaterials, points, summary) bind(c, name='mud_init_points')
         import :: c_int, c_double, mud_points, mud_summary
         real(c_double), intent(in) :: materials(*)
         integer(c_int), value :: nmaterials
         type(mud_points) :: points   ! no intent: a compiler may take what an IN points to for unchanged
         type(mud_summary), intent(out), optional :: summary
      end function mud_init_points

      integer(c_int) function mud_update_points(materials, nmaterials, points, summary) &
         bind(c, name='mud_update_points')
         import :: c_int, c_double, mud_points, mud_summary
         real(c_double), intent(in) :: materials(*)
         integer(c_int), value :: nmaterials
         type(mud_points) :: points   ! no intent: a compiler may take what an IN points to for unchanged
         type(mud_summary), intent(out), optional :: summary
      end function mud_update_points

      integer(c_int) function mud_saturation_points(materials, nmaterials, points, summary) &
         bind(c, name='mud_saturation_points')
         import :: c_int, c_double, mud_points, mud_summary
         real(c_double), intent(in) :: materials(*)
         integer(c_int), value :: nmaterials
         type(mud_points) :: points   ! no intent: a compiler may take what an IN points to for unchanged
         type(mud_summary), intent(out), optional :: summary
      end function mud_saturation_points

      integer(c_int) function mud_trace_increment(material, stress0, statev0, nstatev, dstrain, suction, tangent, &
              first, rows, nrows, attempts, report) bind(c, name='mud_trace_increment')
         import :: c_int, c_double, mud_report, mud_substep
         integer(c_int), value :: nstatev, tangent, first, nrows
         real(c_double), intent(in) :: material(*), stress0(6), statev0(nstatev), dstrain(6)
         real(c_double), value :: suction
         type(mud_substep), intent(inout) :: rows(nrows)
         integer(c_int), intent(out) :: attempts
         type(mud_report), intent(out), optional :: report
      end function mud_trace_increment

      integer(c_int) function mud_increment_at(place, material, stress0, statev0, nstatev, suction0, dstrain, suction, &
              tangent, stress1, statev1, blocks, report) bind(c, name='mud_increment_at')
         import :: c_int, c_double, mud_blocks, mud_place, mud_report
         type(mud_place), intent(in) :: place
         integer(c_int), value :: nstatev, tangent
         real(c_double), intent(in) :: material(*), stress0(6), statev0(nstatev)
         real(c_double), intent(in), optional :: dstrain(6)
         real(c_double), value :: suction0, suction
         real(c_double), intent(inout), optional :: stress1(6), statev1(nstatev)
         type(mud_blocks), intent(inout), optional :: blocks
         type(mud_report), intent(out), optional :: report
      end function mud_increment_at

      !> The consequence must end with c_null_char.
      integer(c_int) function mud_refuse(place, report, consequence, stress, n) bind(c, name='mud_refuse')
         import :: c_char, c_int, c_double, mud_place, mud_report
         type(mud_place), intent(in) :: place
         type(mud_report), intent(in) :: report
         character(kind=c_char), intent(in) :: consequence(*)
         real(c_double), intent(inout), optional :: stress(*)
         integer(c_int), value :: n
      end function mud_refuse

      !> The texts handed over must end with c_null_char.
      integer(c_int) function mud_save_increment(path, origin, material, stress0, statev0, nstatev, dstrain, suction, &
              tangent, text, len) bind(c, name='mud_save_increment')
         import :: c_int, c_double, c_char
         character(kind=c_char), intent(in) :: path(*), origin(*)
         integer(c_int), value :: nstatev, tangent, len
         real(c_double), intent(in) :: material(*), stress0(6), statev0(nstatev), dstrain(6)
         real(c_double), value :: suction
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
