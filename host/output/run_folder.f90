! SPDX-License-Identifier: MIT
!> Observer that owns the folder of a run: one run at a time writes there, and a restart finds the run that it goes on
!> with. A run holds a lock on the file `lock`, which the system takes back when its process ends, however it does. The
!> file stays: were it removed, a run that has opened it would lock what the next one cannot see.
module run_folder
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_ptr, c_null_char, c_null_ptr, c_associated
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use field_files, only: check_mesh
   use files, only: make_folder
   use run_observer, only: observer_t, FITS, BEGINS, ENDS
   use run_state, only: run_t
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: folder_observer_t

   type, extends(observer_t) :: folder_observer_t
      type(c_ptr) :: lock = c_null_ptr   !< The locked file; null: there is none.
   contains
      procedure :: hear
   end type folder_observer_t

   character(*), parameter :: LOCK_FILE = 'lock'
   integer(c_int), parameter :: ALONE = 6, FREE = 8   !< Operations of flock: exclusive without waiting, unlock.

   interface
      type(c_ptr) function fopen(path, mode) bind(c)
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*), mode(*)
      end function fopen

      integer(c_int) function fileno(stream) bind(c)
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
      end function fileno

      integer(c_int) function flock(file, operation) bind(c)
         import :: c_int
         integer(c_int), value :: file, operation
      end function flock

      integer(c_int) function fclose(stream) bind(c)
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
      end function fclose
   end interface
contains
   !> Takes the folder, which a new run makes, and gives it free. Faults: EXIT_RESTART where it does not hold the run:
   !> its mesh is of another scene; EXIT_OUTPUT: another run writes to it.
   subroutine hear(self, event, run, fault)
      class(folder_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      integer(c_int) :: done

      select case (event)
      case (FITS)
         call check_mesh(self%folder, run%model%origin%fingerprint, fault)
      case (BEGINS)
         if (run%steps == 0) call make_folder(self%folder)
         call lock_folder(self%folder, self%lock, fault)
      case (ENDS)
         if (c_associated(self%lock)) done = fclose(self%lock)
      end select
   end subroutine hear

   !> Takes a folder. Fault EXIT_OUTPUT: another run writes to it, or this one cannot.
   subroutine lock_folder(folder, lock, fault)
      character(*), intent(in) :: folder
      type(c_ptr), intent(out) :: lock
      type(fault_t), intent(inout) :: fault
      integer(c_int) :: done

      lock = fopen(folder//'/'//LOCK_FILE//c_null_char, 'a'//c_null_char)   ! what there is stays
      if (.not. c_associated(lock)) then
         call raise(fault, EXIT_OUTPUT, folder//'/'//LOCK_FILE//' cannot be written, and without it nothing keeps '// &
                    'another run out of the folder: choose another --output.')
         return
      end if
      if (flock(fileno(lock), ALONE) == 0) return
      if (flock(fileno(lock), FREE) /= 0) then
         call print_warning('the file system of '//folder//' has no locks: nothing keeps another run out of the '// &
                            'folder.')
         return
      end if
      done = fclose(lock)
      lock = c_null_ptr
      call raise(fault, EXIT_OUTPUT, 'Another run writes its results to '//folder//' (it holds the file '''// &
                 LOCK_FILE//''' there): wait for its end, or choose another --output.')
   end subroutine lock_folder
end module run_folder
