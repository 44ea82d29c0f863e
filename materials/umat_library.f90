! SPDX-License-Identifier: MIT
!> UMATs from shared libraries: the interface of Abaqus, and the loader of the system (POSIX).
module umat_library
   use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_char, c_int, c_size_t, c_double, c_null_char, &
                                          c_associated, c_f_procpointer
   use dynamic_loader, only: dlopen, dlsym, dlerror, RTLD_NOW
   use faults, only: fault_t, raise, EXIT_INPUT
   use texts, only: text_at
   implicit none (type, external)
   private
   public :: umat_i, load_umat, CMNAME_LENGTH

   integer, parameter :: CMNAME_LENGTH = 80

   abstract interface
      !> Calling convention of gfortran: every argument by its address, the length of CMNAME after the last one. Units
      !> are the UMAT's own; tension positive, engineering shear, NTENS components.
      subroutine umat_i(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, &
                        dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, &
                        drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc, &
                        cmname_length) bind(c)
         import :: c_double, c_int, c_char, c_size_t
         integer(c_int), intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
         real(c_double), intent(inout) :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, &
                                          ddsddt(ntens), drplde(ntens), drpldt, pnewdt
         real(c_double), intent(in) :: stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), &
                                       props(nprops), coords(3), drot(3, 3), celent, dfgrd0(3, 3), dfgrd1(3, 3)
         character(kind=c_char), intent(in) :: cmname(*)
         integer(c_size_t), value :: cmname_length
      end subroutine umat_i
   end interface
contains
   !> The procedure of a library, which stays loaded as long as the program runs. A fault (EXIT_INPUT), and a null
   !> pointer, where the library cannot be loaded or has no such symbol.
   subroutine load_umat(path, symbol, umat, fault)
      character(*), intent(in) :: path     !< Without a slash: looked up where the system keeps libraries.
      character(*), intent(in) :: symbol
      procedure(umat_i), pointer, intent(out) :: umat
      type(fault_t), intent(inout) :: fault
      type(c_ptr) :: handle
      type(c_funptr) :: found

      nullify (umat)
      handle = dlopen(path//c_null_char, RTLD_NOW)
      if (.not. c_associated(handle)) then
         call raise(fault, EXIT_INPUT, 'the library '//path//' cannot be loaded: '//loader_message()//'.')
         return
      end if
      found = dlsym(handle, symbol//c_null_char)
      if (.not. c_associated(found)) then
         call raise(fault, EXIT_INPUT, 'the library '//path//' has no symbol '//symbol//' ('//loader_message()// &
                    '); nm -D shows what it has.')
         return
      end if
      call c_f_procpointer(found, umat)
   end subroutine load_umat

   !> Message of the loader about its last failure.
   function loader_message() result(text)
      character(:), allocatable :: text
      type(c_ptr) :: message

      text = ''
      message = dlerror()
      if (c_associated(message)) text = text_at(message)
   end function loader_message
end module umat_library
