! SPDX-License-Identifier: MIT
!> Which BLAS and LAPACK the process has loaded, from the dynamic linker at run time; an empty text where the linker
!> does not know.
module blas_in_use
   use, intrinsic :: iso_c_binding, only: c_int, c_char, c_ptr, c_funptr, c_null_ptr, c_null_char, c_associated, &
                                          c_f_procpointer, c_f_pointer
   use dynamic_loader, only: dlsym
   implicit none (type, external)
   private
   public :: blas_t, find_blas

   integer, parameter :: LONGEST_PATH = 4096

   type :: blas_t
      character(:), allocatable :: name        !< Product and version, "reference", or empty: not known.
      character(:), allocatable :: blas_file   !< Library that holds dgemm; empty: not known.
      character(:), allocatable :: lapack_file !< Library that holds dgetrf; empty: not loaded or not known.
      logical :: slow = .false.                !< The reference implementation.
   end type blas_t

   !> Dl_info of dlfcn.h.
   type, bind(c) :: dl_info_t
      type(c_ptr) :: file = c_null_ptr, base = c_null_ptr, symbol = c_null_ptr, address = c_null_ptr
   end type dl_info_t

   abstract interface
      function text_i() bind(c) result(text)
         import :: c_ptr
         type(c_ptr) :: text
      end function text_i

      integer(c_int) function dladdr_i(address, info) bind(c)
         import :: c_funptr, c_int, dl_info_t
         type(c_funptr), value :: address
         type(dl_info_t), intent(out) :: info
      end function dladdr_i

      function realpath_i(path, resolved) bind(c) result(text)
         import :: c_ptr, c_char
         type(c_ptr), value :: path
         character(kind=c_char), intent(out) :: resolved(*)
         type(c_ptr) :: text
      end function realpath_i
   end interface
contains
   !> Name and file of the BLAS and the file of the LAPACK in use; empty texts where they are not known. Raises no
   !> fault.
   function find_blas() result(found)
      type(blas_t) :: found
      ! Symbols that betray a product.
      character(24), parameter :: SIGNS(*) = [character(24) :: 'bli_info_get_version_str', 'MKL_Get_Version', &
                                              'mkl_get_version', 'ATL_buildinfo']
      character(5), parameter :: PRODUCTS(*) = [character(5) :: 'BLIS', 'MKL', 'MKL', 'ATLAS']
      logical :: there
      integer :: i

      found%blas_file = file_of('dgemm_')
      found%lapack_file = file_of('dgetrf_')
      found%name = words_of('openblas_get_config')
      if (found%name == '') then
         do i = 1, size(SIGNS)
            there = c_associated(dlsym(c_null_ptr, trim(SIGNS(i))//c_null_char))
            if (there .and. found%name == '') found%name = trim(PRODUCTS(i))
         end do
      end if
      ! Some builds hide all but the BLAS itself.
      if (found%name == '' .and. index(found%blas_file, 'blis') > 0) found%name = 'BLIS'
      if (found%name == 'BLIS') found%name = trim('BLIS '//words_of('bli_info_get_version_str'))
      if (found%name == '' .and. is_reference(found%blas_file)) found%name = 'reference'
      found%slow = found%name == 'reference'
   end function find_blas

   !> The plain libblas, not one that an optimised package put in its place under a folder of its own.
   pure logical function is_reference(file)
      character(*), intent(in) :: file
      character(*), parameter :: OTHERS(*) = [character(10) :: 'openblas', 'blis', 'atlas', 'mkl', 'armpl', 'essl', &
                                              'Accelerate']
      integer :: i

      is_reference = index(file, 'libblas.') > 0 .or. index(file, 'librefblas') > 0
      do i = 1, size(OTHERS)
         if (index(file, trim(OTHERS(i))) > 0) is_reference = .false.
      end do
   end function is_reference

   !> The text that a function without arguments returns; empty if there is no such function.
   function words_of(symbol) result(text)
      character(*), intent(in) :: symbol
      character(:), allocatable :: text
      procedure(text_i), pointer :: ask
      type(c_funptr) :: found

      text = ''
      found = dlsym(c_null_ptr, symbol//c_null_char)
      if (.not. c_associated(found)) return
      call c_f_procpointer(found, ask)
      text = text_at(ask())
   end function words_of

   !> The file that defines a symbol, links followed.
   function file_of(symbol) result(file)
      character(*), intent(in) :: symbol
      character(:), allocatable :: file
      procedure(dladdr_i), pointer :: look
      procedure(realpath_i), pointer :: follow
      character(kind=c_char) :: resolved(LONGEST_PATH)
      type(dl_info_t) :: info
      type(c_funptr) :: address, tool
      integer :: i

      file = ''
      address = dlsym(c_null_ptr, symbol//c_null_char)
      tool = dlsym(c_null_ptr, 'dladdr'//c_null_char)
      if (.not. (c_associated(address) .and. c_associated(tool))) return
      call c_f_procpointer(tool, look)
      if (look(address, info) == 0) return
      file = text_at(info%file)
      tool = dlsym(c_null_ptr, 'realpath'//c_null_char)
      if (.not. c_associated(tool) .or. file == '') return
      call c_f_procpointer(tool, follow)
      resolved = c_null_char
      if (.not. c_associated(follow(info%file, resolved))) return
      file = ''
      do i = 1, findloc(resolved, c_null_char, dim=1) - 1
         file = file//resolved(i)
      end do
   end function file_of

   !> A text of C.
   function text_at(place) result(text)
      type(c_ptr), intent(in) :: place
      character(:), allocatable :: text
      character(kind=c_char), pointer :: raw(:)
      integer :: i

      text = ''
      if (.not. c_associated(place)) return
      call c_f_pointer(place, raw, [LONGEST_PATH])
      do i = 1, LONGEST_PATH
         if (raw(i) == c_null_char) exit
         text = text//raw(i)
      end do
      text = trim(text)
   end function text_at
end module blas_in_use
