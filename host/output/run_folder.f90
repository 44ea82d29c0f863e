! SPDX-License-Identifier: MIT
!> Observer that owns the folder of a run: one run at a time writes there, and a restart finds the run that it goes on
!> with. The file `running` holds the number of the process that writes, and its host. That of a process of this host
!> that has ended without removing it is taken over.
module run_folder
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_size_t
   use archive, only: archive_t
   use faults, only: fault_t, raise, EXIT_OUTPUT
   use field_files, only: check_mesh
   use files, only: make_folder
   use run_observer, only: observer_t, FITS, BEGINS, ENDS
   use run_state, only: run_t
   use scene_parts, only: FINGERPRINT_LENGTH
   use texts, only: from_c, whole
   implicit none (type, external)
   private
   public :: folder_observer_t

   type, extends(observer_t) :: folder_observer_t
      character(FINGERPRINT_LENGTH) :: origin = ''   !< Fingerprint of the scene that began the run.
      logical :: taken = .false.                     !< The file LOCK is ours.
   contains
      procedure :: exchange
      procedure :: hear
   end type folder_observer_t
   character(*), parameter :: LOCK = 'running'
   integer, parameter :: ATTEMPTS = 2   !< The second after the file of a dead process is removed.
   integer, parameter :: NAME_LENGTH = 256   !< Longest name of a host.

   interface
      integer(c_int) function getpid() bind(c)
         import :: c_int
      end function getpid

      !> Group of a process, also of another user; -1: there is no such process.
      integer(c_int) function getpgid(process) bind(c)
         import :: c_int
         integer(c_int), value :: process
      end function getpgid

      !> The name of this host, ended by a zero; 0 if it is known.
      integer(c_int) function gethostname(name, length) bind(c)
         import :: c_char, c_int, c_size_t
         character(kind=c_char), intent(out) :: name(*)
         integer(c_size_t), value :: length
      end function gethostname
   end interface
contains
   !> Exchanges the fingerprint of the scene that began the run.
   subroutine exchange(self, archive)
      class(folder_observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call archive%exchange('origin', self%origin)
   end subroutine exchange

   !> Takes the folder, which a new run makes, and gives it free. Faults: EXIT_RESTART where it does not hold the run:
   !> its mesh is of another scene; EXIT_OUTPUT: another run writes to it.
   subroutine hear(self, event, run, fault)
      class(folder_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault

      select case (event)
      case (FITS)
         call check_mesh(self%folder, self%origin, fault)
      case (BEGINS)
         if (run%steps == 0) then
            self%origin = run%model%origin%fingerprint
            call make_folder(self%folder)
         end if
         call lock_folder(self%folder, self%taken, fault)
      case (ENDS)
         if (self%taken) call remove_lock(self%folder)
      end select
   end subroutine hear

   !> Takes a folder; nothing is done where there is none. Fault EXIT_OUTPUT: another run writes to it.
   subroutine lock_folder(folder, taken, fault)
      character(*), intent(in) :: folder
      logical, intent(out) :: taken
      type(fault_t), intent(inout) :: fault
      character(NAME_LENGTH) :: host
      integer :: unit, status, i
      integer(c_int) :: owner

      taken = .false.
      do i = 1, ATTEMPTS
         open (newunit=unit, file=folder//'/'//LOCK, status='new', action='write', iostat=status)
         taken = status == 0
         if (taken) then
            write (unit, '(i0,1x,a)') getpid(), this_host()
            close (unit)
            return
         end if
         call read_lock(folder, owner, host, status)
         if (status > 0) return   ! A folder that cannot be written to is told with its first table.
         if (status == 0) then
            if (lives(owner, host)) then
               call raise(fault, EXIT_OUTPUT, 'Process '//whole(int(owner))//' of '//trim(host)//' writes its '// &
                          'results to '//folder//' (its file '''//LOCK//''' says so): wait for its end, or choose '// &
                          'another --output. If that process is no run of mud_host any more, remove the file.')
               return
            end if
         end if
         call remove_lock(folder)
      end do
   end subroutine lock_folder

   !> Whether another process may still write. Of another host nothing is known; a number may come again, as ours.
   logical function lives(owner, host)
      integer(c_int), intent(in) :: owner
      character(*), intent(in) :: host
      character(:), allocatable :: here
      integer(c_int) :: own, group

      here = this_host()
      own = getpid()
      group = getpgid(owner)
      lives = host /= here .or. (owner > 0 .and. group >= 0 .and. owner /= own)
   end function lives

   !> The name of this host.
   function this_host() result(host)
      character(:), allocatable :: host
      character(NAME_LENGTH, c_char) :: name

      host = 'localhost'
      name = ''
      if (gethostname(name, int(NAME_LENGTH - 1, c_size_t)) /= 0) return
      if (from_c(name) /= '') host = trim(from_c(name))
   end function this_host

   !> Reads the file. status: 0; below 0 where it says nothing, as that of a process that was killed while it wrote;
   !> above 0 where it cannot be read.
   subroutine read_lock(folder, owner, host, status)
      character(*), intent(in) :: folder
      integer(c_int), intent(out) :: owner
      character(*), intent(out) :: host
      integer, intent(out) :: status
      integer :: unit, problem

      owner = 0
      host = ''
      open (newunit=unit, file=folder//'/'//LOCK, status='old', action='read', iostat=status)
      if (status /= 0) return
      read (unit, *, iostat=problem) owner, host
      close (unit)
      if (problem /= 0) status = -1
   end subroutine read_lock

   subroutine remove_lock(folder)
      character(*), intent(in) :: folder
      integer :: unit, status

      open (newunit=unit, file=folder//'/'//LOCK, status='old', iostat=status)
      if (status == 0) close (unit, status='delete', iostat=status)
   end subroutine remove_lock
end module run_folder
