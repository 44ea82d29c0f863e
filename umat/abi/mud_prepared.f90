! SPDX-License-Identifier: MIT
!> A material checked and named once, in storage of the caller, for any number of updates: mud_prepare of mud.h.
module mud_prepared
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_kernel, only: failed_report
   use mud_kinds, only: wp
   use mud_messages, only: report_text
   use mud_params, only: params_t, read_params
   use mud_scanning, only: check_curves
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_NULL_ARGUMENT, MUD_NOT_PREPARED, ON_ARGUMENT
   use mud_to_host, only: put
   implicit none (type, external)
   private
   public :: prepared_t, find_prepared, mud_prepared_size, mud_prepare

   !> What the caller's storage holds. The marks at both ends tell it from storage that was never prepared, was prepared
   !> by a library with other parameters, or was written over at an edge.
   type :: prepared_t
      integer(int64) :: head = 0
      type(params_t) :: par
      integer(int64) :: tail = 0
   end type prepared_t

   integer(int64), parameter :: MARK = int(z'4D55447072657061', int64)   !< "MUDprepa"
   real(wp), parameter :: BITS_OF_A_DOUBLE = storage_size(1.0_wp)
contains
   !> How many doubles the storage of a prepared material takes.
   pure integer(c_int) function mud_prepared_size() bind(c, name='mud_prepared_size')
      type(prepared_t) :: material

      mud_prepared_size = ceiling(storage_size(material)/BITS_OF_A_DOUBLE, c_int)
   end function mud_prepared_size

   !> Checks PROPS and writes the material; on an error the storage is no prepared material. MUD_NULL_ARGUMENT,
   !> MUD_NOT_PREPARED where size_ (doubles) is too small, else the codes of read_params and check_curves; text says
   !> which. Stresses in the unit of p_atm.
   integer(c_int) function mud_prepare(props, n_props, prepared, size_, text, len) bind(c, name='mud_prepare')
      type(c_ptr), value :: props, prepared, text
      integer(c_int), value :: n_props, size_, len
      real(c_double), pointer, contiguous :: values(:)
      type(prepared_t), pointer :: material
      type(params_t) :: par
      type(mud_status_t) :: status

      if (.not. (c_associated(props) .and. c_associated(prepared))) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      else if (size_ < mud_prepared_size()) then
         status = fail(MUD_NOT_PREPARED, ON_ARGUMENT, 0, real(size_, wp), real(mud_prepared_size(), wp), huge(1.0_wp))
      else
         call c_f_pointer(props, values, [max(n_props, 0)])
         call c_f_pointer(prepared, material)
         call read_params(values, par, status)
         if (status%code == MUD_OK .and. par%hysteresis) call check_curves(par, status)
         material%head = 0
         material%tail = 0
         if (status%code == MUD_OK) then
            material%par = par
            material%head = mark_of()
            material%tail = not(mark_of())
         end if
      end if
      mud_prepare = status%code
      call put(report_text(failed_report(status)), text, len)
   end function mud_prepare

   !> The material behind a pointer, or why there is none. MUD_NULL_ARGUMENT, or MUD_NOT_PREPARED where no mud_prepare
   !> of this library filled it.
   subroutine find_prepared(prepared, material, status)
      type(c_ptr), intent(in) :: prepared
      type(prepared_t), pointer, intent(out) :: material
      type(mud_status_t), intent(out) :: status

      nullify (material)
      if (.not. c_associated(prepared)) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
         return
      end if
      call c_f_pointer(prepared, material)
      if (material%head /= mark_of() .or. material%tail /= not(mark_of())) status = fail(MUD_NOT_PREPARED, ON_ARGUMENT)
   end subroutine find_prepared

   !> Of this library: another number of parameters is another mark.
   pure integer(int64) function mark_of()
      mark_of = MARK + int(mud_prepared_size(), int64)
   end function mark_of
end module mud_prepared
