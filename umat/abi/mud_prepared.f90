! SPDX-License-Identifier: MIT
!> A material checked once, in storage of the caller, for any number of points and updates: mud_prepare of mud.h.
module mud_prepared
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_host_increment, only: kind_of
   use mud_kernel, only: report_t, failed_report
   use mud_kinds, only: wp
   use mud_messages, only: report_text
   use mud_params, only: params_t, read_params, completed
   use mud_registry, only: NPROPS
   use mud_retention, only: check_retention, prepare_retention
   use mud_state, only: statev_size, check_size
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_NULL_ARGUMENT, MUD_NOT_PREPARED, MUD_BAD_OPTION, ON_ARGUMENT
   use mud_to_host, only: put
   implicit none (type, external)
   private
   public :: prepared_t, find_prepared, find_materials, start_t, find_start
   public :: c_prepared_size, c_prepared_statev, c_prepare, c_check_props

   !> Contents of the caller's storage. The marks at both ends tell it from storage that was never prepared, was
   !> prepared by a library with other parameters, or was written over at an edge.
   type :: prepared_t
      integer(int64) :: head = 0
      type(params_t) :: par
      real(wp) :: props(NPROPS)   !< PROPS that the parameters were read from.
      integer(int64) :: tail = 0
   end type prepared_t

   !> Material, state and strain that the pointers of a host lead to.
   type :: start_t
      type(prepared_t), pointer :: material
      real(c_double), pointer, contiguous :: stress(:), statev(:)
      real(wp) :: d_strain(6) = 0.0_wp
   end type start_t

   integer(int64), parameter :: MARK = int(z'4D55447072657061', int64)   !< "MUDprepa"
   real(wp), parameter :: BITS_OF_A_DOUBLE = storage_size(1.0_wp)
contains
   !> Number of doubles that the storage of a prepared material takes.
   pure integer(c_int) function c_prepared_size() bind(c, name='mud_prepared_size')
      type(prepared_t) :: material

      c_prepared_size = ceiling(storage_size(material)/BITS_OF_A_DOUBLE, c_int)
   end function c_prepared_size

   !> Numbers of STATEV that a point of a prepared material has: those of hysteresis only with it. MUD_NULL_ARGUMENT,
   !> MUD_NOT_PREPARED.
   integer(c_int) function c_prepared_statev(storage) bind(c, name='mud_prepared_statev')
      type(c_ptr), value :: storage
      type(prepared_t), pointer :: material
      type(mud_status_t) :: status

      call find_prepared(storage, material, status)
      c_prepared_statev = status%code
      if (status%code == MUD_OK) c_prepared_statev = statev_size(material%par%options_t)
   end function c_prepared_statev

   !> Checks PROPS and writes the material; on an error the storage is no prepared material. MUD_NULL_ARGUMENT,
   !> MUD_NOT_PREPARED where size_ (doubles) is too small, else the codes of read_params and check_retention; text says
   !> which. Stresses in the unit of p_atm.
   integer(c_int) function c_prepare(props, n_props, storage, size_, text, len) bind(c, name='mud_prepare')
      type(c_ptr), value :: props, storage, text
      integer(c_int), value :: n_props, size_, len
      real(c_double), pointer, contiguous :: values(:)
      type(prepared_t), pointer :: material
      type(params_t) :: par
      type(mud_status_t) :: status

      if (.not. (c_associated(props) .and. c_associated(storage))) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      else if (size_ < c_prepared_size()) then
         status = fail(MUD_NOT_PREPARED, ON_ARGUMENT, 0, real(size_, wp), real(c_prepared_size(), wp), huge(1.0_wp))
      else
         call c_f_pointer(props, values, [max(n_props, 0)])
         call c_f_pointer(storage, material)
         call read_material(values, par, status)
         if (status%code == MUD_OK) call prepare_retention(par%suction%retention_t)
         material%head = 0
         material%tail = 0
         if (status%code == MUD_OK) then
            material%par = par
            material%props = completed(values)
            material%head = mark_of()
            material%tail = not(mark_of())
         end if
      end if
      c_prepare = status%code
      call put(report_text(failed_report(status)), text, len)
   end function c_prepare

   !> Code of c_prepare for PROPS, and a report of their first fault. MUD_NULL_ARGUMENT, codes of read_material.
   integer(c_int) function c_check_props(props, n_props, report_out) bind(c, name='mud_check_props')
      type(c_ptr), value :: props, report_out
      integer(c_int), value :: n_props
      real(c_double), pointer, contiguous :: values(:)
      type(report_t), pointer :: report
      type(params_t) :: par
      type(mud_status_t) :: status

      if (c_associated(props)) then
         call c_f_pointer(props, values, [max(n_props, 0)])
         call read_material(values, par, status)
      else
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      end if
      c_check_props = status%code
      if (.not. c_associated(report_out)) return
      call c_f_pointer(report_out, report)
      report = failed_report(status)
   end function c_check_props

   !> Reads PROPS and checks the retention curves: codes of read_params and check_retention.
   pure subroutine read_material(values, par, status)
      real(wp), intent(in), contiguous :: values(:)
      type(params_t), intent(out) :: par
      type(mud_status_t), intent(out) :: status

      call read_params(values, par, status)
      call check_retention(par%suction%retention_t, status)
   end subroutine read_material

   !> The material behind a pointer, or why there is none: codes of find_materials.
   subroutine find_prepared(storage, material, status)
      type(c_ptr), intent(in) :: storage
      type(prepared_t), pointer, intent(out) :: material
      type(mud_status_t), intent(out) :: status
      type(prepared_t), pointer, contiguous :: materials(:)

      nullify (material)
      call find_materials(storage, 1_c_int, materials, status)
      if (status%code == MUD_OK) material => materials(1)
   end subroutine find_prepared

   !> Materials one after another, n of them. MUD_NULL_ARGUMENT, MUD_BAD_OPTION for n < 1, MUD_NOT_PREPARED where no
   !> mud_prepare of this library filled one.
   subroutine find_materials(storage, n, materials, status)
      type(c_ptr), intent(in) :: storage
      integer(c_int), intent(in) :: n
      type(prepared_t), pointer, contiguous, intent(out) :: materials(:)
      type(mud_status_t), intent(out) :: status

      nullify (materials)
      if (.not. c_associated(storage)) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      else if (n < 1) then
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT)
      else
         call c_f_pointer(storage, materials, [n])
         if (any(materials%head /= mark_of() .or. materials%tail /= not(mark_of()))) &
            status = fail(MUD_NOT_PREPARED, ON_ARGUMENT)
      end if
   end subroutine find_materials

   !> Finds the material, state and strain of an increment, or why it cannot begin: MUD_NULL_ARGUMENT, MUD_BAD_OPTION,
   !> MUD_NOT_PREPARED, MUD_BAD_NSTATV.
   subroutine find_start(storage, stress0, statev0, n_statev, dstrain, tangent, needs_strain, start, status)
      type(c_ptr), intent(in) :: storage, stress0, statev0, dstrain
      integer(c_int), intent(in) :: n_statev, tangent
      logical, intent(in) :: needs_strain   !< Without it a NULL strain is none.
      type(start_t), intent(out) :: start
      type(mud_status_t), intent(out) :: status
      real(c_double), pointer, contiguous :: strain(:)

      call find_prepared(storage, start%material, status)
      if (.not. (c_associated(stress0) .and. c_associated(statev0) .and. &
                 (c_associated(dstrain) .or. .not. needs_strain))) status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      if (status%code == MUD_OK .and. kind_of(tangent) < 0) &
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(tangent, wp))
      if (status%code /= MUD_OK) return
      call check_size(n_statev, start%material%par%options_t, status)
      if (status%code /= MUD_OK) return
      call c_f_pointer(stress0, start%stress, [6])
      call c_f_pointer(statev0, start%statev, [statev_size(start%material%par%options_t)])
      if (.not. c_associated(dstrain)) return
      call c_f_pointer(dstrain, strain, [6])
      start%d_strain = strain
   end subroutine find_start

   !> Mark of this library in a storage; a library with another number of parameters has another one.
   pure integer(int64) function mark_of()
      mark_of = MARK + int(c_prepared_size(), int64)
   end function mark_of
end module mud_prepared
