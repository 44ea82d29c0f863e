! SPDX-License-Identifier: MIT
!> The library of materials: parameter sets by name, for mud_triax --material.
module material_folder
   use, intrinsic :: iso_c_binding, only: c_char, c_size_t, c_null_char
   use faults, only: fault_t, raise, EXIT_INPUT
   implicit none (type, external)
   private
   public :: material_path

   integer, parameter :: PATH_LENGTH = 1024
   character(*), parameter :: VARIABLE = 'MUD_MATERIALS'   !< Environment variable that names the folder.
   !> Places of the folder, from that of the program: in a build tree, and installed.
   character(*), parameter :: PLACES(2) = [character(24) :: 'materials/', '../share/mud/materials/']

   interface
      !> POSIX; returns how long the target is.
      integer(c_size_t) function readlink(path, target, room) bind(c)
         import :: c_char, c_size_t
         character(kind=c_char), intent(in) :: path(*)
         character(kind=c_char), intent(out) :: target(*)
         integer(c_size_t), value :: room
      end function readlink
   end interface
contains
   !> File of a material: `word` itself where it is a path (it has a slash or ends in .nml), otherwise word.nml of the
   !> library's folder. A word that is neither raises a fault that says where it was looked for. Fault EXIT_INPUT.
   subroutine material_path(word, path, fault)
      character(*), intent(in) :: word
      character(:), allocatable, intent(out) :: path
      type(fault_t), intent(inout) :: fault
      character(PATH_LENGTH) :: folder
      character(:), allocatable :: searched
      integer :: i, status
      logical :: there

      path = trim(word)
      if (index(word, '/') > 0 .or. index(trim(word)//' ', '.nml ') > 0) return
      call get_environment_variable(VARIABLE, folder, status=status)
      if (status == 0 .and. folder /= '') then
         searched = trim(folder)
         path = trim(folder)//'/'//trim(word)//'.nml'
         inquire (file=path, exist=there)
         if (there) return
      else
         searched = ''
         do i = 1, size(PLACES)
            path = program_folder()//trim(PLACES(i))//trim(word)//'.nml'
            inquire (file=path, exist=there)
            if (there) return
            if (i > 1) searched = searched//' or '
            searched = searched//program_folder()//trim(PLACES(i))
         end do
      end if
      call raise(fault, EXIT_INPUT, '--material '//trim(word)//': there is no '//trim(word)//'.nml in '//searched// &
                 '; look there for the names, name a file with its .nml, or name the folder with '//VARIABLE//'.')
   end subroutine material_path

   !> Folder of this program with its closing slash: from the location of its file, or from how it was called.
   function program_folder() result(folder)
      character(:), allocatable :: folder
      character(kind=c_char) :: target(PATH_LENGTH)
      character(PATH_LENGTH) :: called
      integer :: length, i

      length = int(readlink('/proc/self/exe'//c_null_char, target, int(PATH_LENGTH, c_size_t)))
      if (length > 0 .and. length < PATH_LENGTH) then
         allocate (character(length) :: folder)
         do i = 1, length
            folder(i:i) = target(i)
         end do
      else
         call get_command_argument(0, called)
         folder = trim(called)
      end if
      folder = folder(:index(folder, '/', back=.true.))
   end function program_folder
end module material_folder
