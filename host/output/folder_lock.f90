! SPDX-License-Identifier: MIT
!> One run a folder: the file `running` holds the number of the process that writes there. That of a process that has
!> ended without removing it is taken over.
module folder_lock
   use, intrinsic :: iso_c_binding, only: c_int
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use files, only: make_folder
   use texts, only: whole
   implicit none (type, external)
   private
   public :: lock_folder, unlock_folder

   character(*), parameter :: LOCK = 'running'
   integer, parameter :: ATTEMPTS = 2   !< The second after the file of a dead process is removed.

   interface
      integer(c_int) function getpid() bind(c)
         import :: c_int
      end function getpid

      !> With signal 0: 0 if the process lives and is ours, else -1.
      integer(c_int) function kill(process, signal) bind(c)
         import :: c_int
         integer(c_int), value :: process, signal
      end function kill
   end interface
contains
   !> Takes a folder; nothing is done where there is none. Fault EXIT_OUTPUT: another run writes to it.
   subroutine lock_folder(folder, make, fault)
      character(*), intent(in) :: folder
      logical, intent(in) :: make   !< The folder.
      type(fault_t), intent(inout) :: fault
      integer :: unit, status, i
      integer(c_int) :: owner

      if (make) call make_folder(folder)
      do i = 1, ATTEMPTS
         open (newunit=unit, file=folder//'/'//LOCK, status='new', action='write', iostat=status)
         if (status == 0) then
            write (unit, '(i0)') getpid()
            close (unit)
            return
         end if
         open (newunit=unit, file=folder//'/'//LOCK, status='old', action='read', iostat=status)
         if (status /= 0) return   ! A folder that cannot be written to is told with its first table.
         read (unit, *, iostat=status) owner
         close (unit)
         if (status == 0) then
            if (kill(owner, 0_c_int) == 0) then
               call raise(fault, EXIT_OUTPUT, 'Process '//whole(int(owner))//' writes its results to '//folder// &
                          ' (its file '''//LOCK//''' says so): wait for its end, or choose another --output.')
               return
            end if
         end if
         call remove_lock(folder)
      end do
   end subroutine lock_folder

   !> Gives the folder free, if it is ours.
   subroutine unlock_folder(folder)
      character(*), intent(in) :: folder
      integer :: unit, status
      integer(c_int) :: owner

      open (newunit=unit, file=folder//'/'//LOCK, status='old', action='read', iostat=status)
      if (status /= 0) return
      read (unit, *, iostat=status) owner
      close (unit)
      if (status /= 0) return
      if (owner == getpid()) call remove_lock(folder)
   end subroutine unlock_folder

   subroutine remove_lock(folder)
      character(*), intent(in) :: folder
      integer :: unit, status

      open (newunit=unit, file=folder//'/'//LOCK, status='old', iostat=status)
      if (status == 0) close (unit, status='delete', iostat=status)
   end subroutine remove_lock
end module folder_lock
