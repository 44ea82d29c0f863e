!> Output: histories at points, the ledger, and the fields at the end of every stage and in between.
module host_output
   use host_kinds, only: wp, EXIT_RESTART
   use host_contact, only: contact_columns, contact_row, contact_nodes
   use host_energy, only: ledger_t, imbalance
   use host_results, only: frames_t, write_mesh, write_frame, all_pressures
   use host_scene, only: scene_t
   use fe_contact, only: contacts_t
   use fe_model, only: state_t, model_t
   use io_files, only: cut_file, settle_file
   use newton, only: log_t
   use triax_fault, only: fault_t, raise, EXIT_OUTPUT
   implicit none (type, external)
   private
   public :: output_t, open_output, write_history, write_ledger, write_contacts, write_fields, write_touching
   public :: close_output, settle_output, write_frame

   character(*), parameter :: NUMBER = '(*(es24.16e3,:,","))'

   character(4), parameter :: COLUMNS(13) = [character(4) :: 'u_r', 'u_z', 'p_w', 'p_c', 'v_r', 'v_z', 'a_z', 's_rr', &
      's_zz', 's_tt', 's_rz', 'e', 'S_w']

   type :: output_t
      character(:), allocatable :: folder
      integer :: history = 0, ledger = 0, contact = 0   !< Units; 0: no such file.
      integer :: history_bytes = 0, ledger_bytes = 0, contact_bytes = 0   !< Lengths at the last checkpoint.
      type(frames_t) :: frames
   end type output_t
contains
   !> New files; or, after a restart, those of the run as they were at its checkpoint.
   subroutine open_output(folder, scene, resume, output, fault)
      character(*), intent(in) :: folder
      type(scene_t), intent(in) :: scene
      logical, intent(in) :: resume
      type(output_t), intent(inout) :: output
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: head
      integer :: i, k, status

      output%folder = folder
      if (resume) then
         call reopen(folder//'/histories.csv', output%history_bytes, output%history, fault)
         if (fault%code == 0) call reopen(folder//'/ledger.csv', output%ledger_bytes, output%ledger, fault)
         if (fault%code == 0 .and. touches(scene)) &
            call reopen(folder//'/contact.csv', output%contact_bytes, output%contact, fault)
         return
      end if
      call execute_command_line('mkdir -p '''//folder//'''', exitstat=status)
      output%frames = frames_t([real(wp) ::])
      head = 'time'
      do i = 1, size(scene%points)
         do k = 1, size(COLUMNS)
            head = head//','//trim(scene%points(i)%name)//'.'//trim(COLUMNS(k))
         end do
      end do
      call open_file(folder//'/histories.csv', head, output%history, fault)
      if (fault%code == 0) call open_file(folder//'/ledger.csv', 'time,dt,stage,iterations,'// &
         'error_u_r,error_u_z,error_p_w,error_p_c,first_u_r,first_u_z,first_p_w,first_p_c,reduction,correction,'// &
            'rates,kinetic,skeleton,pores,gravity,'// &
            'loads,supports,seepage,damping,imbalance,outflow,outflow_air,step_error', output%ledger, fault)
      if (fault%code == 0 .and. touches(scene)) &
         call open_file(folder//'/contact.csv', contact_columns(scene), output%contact, fault)
      if (fault%code == 0) call write_mesh(folder, trim(scene%name), scene%model, fault)
   end subroutine open_output

   pure logical function touches(scene)
      type(scene_t), intent(in) :: scene

      touches = size(scene%contacts) + size(scene%plates) > 0
   end function touches

   !> A table of the interrupted run, without the rows after the checkpoint.
   subroutine reopen(path, bytes, unit, fault)
      character(*), intent(in) :: path
      integer, intent(in) :: bytes
      integer, intent(out) :: unit
      type(fault_t), intent(inout) :: fault
      integer :: status

      unit = 0
      status = 1
      if (cut_file(path, bytes)) open (newunit=unit, file=path, status='old', position='append', action='write', &
                                       recl=100000, iostat=status)
      if (status /= 0) call raise(fault, EXIT_RESTART, path//' is not there, shorter than at the checkpoint, '// &
                                  'or cannot be written; --output must name the folder of the interrupted run.')
   end subroutine reopen

   !> Brings the tables to the disk and notes how long they are.
   subroutine settle_output(output, fault)
      type(output_t), intent(inout) :: output
      type(fault_t), intent(inout) :: fault

      call settle(output%folder//'/histories.csv', output%history, output%history_bytes, fault)
      if (fault%code == 0) call settle(output%folder//'/ledger.csv', output%ledger, output%ledger_bytes, fault)
      if (fault%code == 0 .and. output%contact /= 0) &
         call settle(output%folder//'/contact.csv', output%contact, output%contact_bytes, fault)
   end subroutine settle_output

   subroutine settle(path, unit, bytes, fault)
      character(*), intent(in) :: path
      integer, intent(in) :: unit
      integer, intent(out) :: bytes
      type(fault_t), intent(inout) :: fault
      integer :: status

      flush (unit, iostat=status)
      if (status /= 0) call raise(fault, EXIT_OUTPUT, path//' cannot be written; is the disk full?')
      call settle_file(path)
      inquire (unit=unit, size=bytes)
   end subroutine settle

   subroutine open_file(path, head, unit, fault)
      character(*), intent(in) :: path, head
      integer, intent(out) :: unit
      type(fault_t), intent(inout) :: fault
      integer :: status

      open (newunit=unit, file=path, status='replace', action='write', recl=100000, iostat=status)
      if (status == 0) write (unit, '(a)', iostat=status) head
      if (status /= 0) call raise(fault, EXIT_OUTPUT, path//' cannot be written; does the folder exist, '// &
                                  'is there space?')
   end subroutine open_file

   subroutine write_history(output, scene, state, fault)
      type(output_t), intent(in) :: output
      type(scene_t), intent(in) :: scene
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault
      integer :: i, status

      if (size(scene%points) == 0) return
      write (output%history, NUMBER, iostat=status) state%time, (values(scene%points(i)%node, scene%points(i)%gauss), &
                                                                 i=1, size(scene%points))
      if (status /= 0) call raise(fault, EXIT_OUTPUT, 'histories.csv cannot be written; is the disk full?')
   contains
      pure function values(k, p)
         integer, intent(in) :: k, p
         real(wp) :: values(size(COLUMNS))

         values = [state%x(:, k), state%v(1:2, k), state%a(2, k), state%stress(1:4, p), state%e(p), state%s(p)]
      end function values
   end subroutine write_history

   subroutine write_ledger(output, time, dt, stage, log, ledger, step_error, fault)
      type(output_t), intent(in) :: output
      real(wp), intent(in) :: time, dt, step_error
      integer, intent(in) :: stage
      type(log_t), intent(in) :: log
      type(ledger_t), intent(in) :: ledger
      type(fault_t), intent(inout) :: fault
      integer :: status

      write (output%ledger, '(2(es24.16e3,","),i0,",",i0,",",*(es14.6e3,:,","))', iostat=status) time, dt, stage, &
         log%iterations, log%error, log%first_error, log%reduction, log%correction, real(log%effort, wp), &
         ledger%kinetic, ledger%skeleton, ledger%pores, ledger%gravity, ledger%loads, ledger%supports, ledger%seepage, &
         ledger%damping, imbalance(ledger), ledger%outflow, ledger%outflow_air, step_error
      if (status /= 0) call raise(fault, EXIT_OUTPUT, 'ledger.csv cannot be written; is the disk full?')
   end subroutine write_ledger

   subroutine write_contacts(output, scene, contacts, dt, state, work, fault)
      type(output_t), intent(in) :: output
      type(scene_t), intent(in) :: scene
      type(contacts_t), intent(in) :: contacts
      real(wp), intent(in) :: dt, work   !< Step, and work done on the penalty so far [s, kJ].
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault
      integer :: status

      if (output%contact == 0) return
      write (output%contact, NUMBER, iostat=status) contact_row(scene, contacts, dt, state, work)
      if (status /= 0) call raise(fault, EXIT_OUTPUT, 'contact.csv cannot be written; is the disk full?')
   end subroutine write_contacts

   !> nodes_STAGE.csv and points_STAGE.csv.
   subroutine write_fields(output, model, stage, state, fault)
      type(output_t), intent(in) :: output
      type(model_t), intent(in) :: model
      character(*), intent(in) :: stage
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault
      real(wp) :: x(4, size(state%x, 2))
      integer :: unit, i, e, g, p, status

      call all_pressures(model, state, x)
      status = 0
      call open_file(output%folder//'/nodes_'//stage//'.csv', 'r,z,u_r,u_z,p_w,p_c,v_r,v_z', unit, fault)
      if (fault%code /= 0) return
      do i = 1, size(state%x, 2)
         if (status == 0) write (unit, NUMBER, iostat=status) model%mesh%x(:, i), x(:, i), state%v(1:2, i)
      end do
      close (unit)
      call open_file(output%folder//'/points_'//stage//'.csv', 'r,z,weight,s_rr,s_zz,s_tt,s_rz,e,S_w', unit, fault)
      if (fault%code /= 0) return
      do e = 1, size(model%mesh%t6, 2)
         do g = 1, model%rule
            p = (e - 1)*model%rule + g
            if (status == 0) write (unit, NUMBER, iostat=status) model%gauss(g, e)%x, model%gauss(g, e)%weight, &
               state%stress(1:4, p), state%e(p), state%s(p)
         end do
      end do
      close (unit)
      if (status /= 0) call raise(fault, EXIT_OUTPUT, 'The fields cannot be written; is the disk full?')
   end subroutine write_fields

   !> contact_STAGE.csv: slave nodes of the contacts that act in the stage.
   subroutine write_touching(output, scene, contacts, stage, state, fault)
      type(output_t), intent(in) :: output
      type(scene_t), intent(in) :: scene
      type(contacts_t), intent(in) :: contacts
      character(*), intent(in) :: stage
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault
      real(wp), allocatable :: table(:, :)
      integer :: unit, i, status

      if (.not. allocated(contacts%touch)) return
      call contact_nodes(scene, contacts, state, table)
      call open_file(output%folder//'/contact_'//stage//'.csv', 'contact,r,z,weight,coverage,gap,pressure', unit, fault)
      if (fault%code /= 0) return
      status = 0
      do i = 1, size(table, 2)
         if (status == 0) write (unit, NUMBER, iostat=status) table(:, i)
      end do
      close (unit)
      if (status /= 0) call raise(fault, EXIT_OUTPUT, 'contact_'//stage//'.csv cannot be written; is the disk full?')
   end subroutine write_touching

   subroutine close_output(output)
      type(output_t), intent(inout) :: output

      close (output%history)
      close (output%ledger)
      if (output%contact /= 0) close (output%contact)
   end subroutine close_output
end module host_output
