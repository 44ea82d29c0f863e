! SPDX-License-Identifier: MIT
!> Output: histories at points, the ledger, and the fields at the end of every stage and in between.
module output_tables
   use archive, only: archive_t
   use kinds, only: wp
   use reaction_rows, only: reaction_columns, reaction_row
   use contact_rows, only: contact_columns, contact_row, contact_nodes
   use energy_ledger, only: ledger_t, imbalance
   use field_files, only: frames_t, write_mesh, check_mesh, all_pressures
   use model_types, only: model_t
   use named_points, only: unknowns_at, motion_at
   use contact_interfaces, only: contacts_t
   use porous_domain, only: state_t, domain_t
   use files, only: make_folder
   use effect_indicators, only: indicator_columns
   use csv, only: csv_t, new_csv, check_csv, resume_csv, write_row, hand_over, flush_csv, close_csv, is_open, &
                       NUMBERS
   use run_observer, only: step_report_t
   use run_state, only: run_t
   use run_summary, only: peaks_t, new_peaks, exchange_peaks
   use scene_types, only: point_t, NAME_LENGTH, FINGERPRINT_LENGTH
   use faults, only: fault_t
   use unknown_fields, only: FIELDS, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: tables_t, open_tables, check_tables, write_history, write_ledger, write_contacts, write_fields, &
             write_points, hand_over_tables
   public :: write_contact_nodes, write_reactions, close_reactions, close_tables, flush_tables, exchange_tables

   character(4), parameter :: COLUMNS(14) = [character(4) :: 'u_r', 'u_z', 'p_w', 'p_c', 'v_r', 'v_z', 'a_r', 'a_z', &
      's_rr', 's_zz', 's_tt', 's_rz', 'e', 'S_w']
   character(*), parameter :: LEDGER_COLUMNS = 'time,dt,stage,iterations,'// &
      'error_u_r,error_u_z,error_p_w,error_p_c,first_u_r,first_u_z,first_p_w,first_p_c,reduction,correction,'// &
      'rates,kinetic,skeleton,pores,gravity,loads,supports,seepage,damping,friction,imbalance,'// &
      'outflow,outflow_air,step_error,'

   type :: tables_t
      character(:), allocatable :: folder
      type(csv_t) :: history, ledger, contact   !< The last is open if the scene has contacts or plates.
      type(csv_t) :: reactions                  !< Of the stage under way, if it prescribes or loads anything.
      type(frames_t) :: frames
      type(peaks_t) :: peaks                    !< Of the named points, for the end of the run.
      character(FINGERPRINT_LENGTH) :: origin = ''   !< Fingerprint of the scene that began the run.
      character(NAME_LENGTH) :: stage = ''           !< Stage that was under way at the checkpoint.
   end type tables_t
contains
   !> New files; or, after a restart, those of the run as they were at its checkpoint. Fault EXIT_OUTPUT: a file cannot
   !> be written; EXIT_RESTART: as of check_tables.
   subroutine open_tables(folder, model, resume, tables, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      logical, intent(in) :: resume
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault

      tables%folder = folder
      if (resume) then
         call check_tables(folder, model, tables, fault)
      else
         call make_folder(folder)
         tables%frames = frames_t([real(wp) ::])
         tables%peaks = new_peaks(size(model%points))
         tables%origin = model%fingerprint
      end if
      call open_one('histories.csv', history_columns(model), tables%history)
      call open_one('ledger.csv', LEDGER_COLUMNS//indicator_columns(model), tables%ledger)
      if (has_contact_table(model)) call open_one('contact.csv', contact_columns(model), tables%contact)
      if (fault%code == 0 .and. .not. resume) &
         call write_mesh(folder, trim(model%name), model%fingerprint, model%domain, fault)
   contains
      subroutine open_one(name, head, table)
         character(*), intent(in) :: name, head
         type(csv_t), intent(inout) :: table

         if (fault%code /= 0) return
         if (resume) then
            call resume_csv(folder//'/'//name, head, table, fault)
         else
            call new_csv(folder//'/'//name, head, table, fault)
         end if
      end subroutine open_one
   end subroutine open_tables

   !> Exchanges with an archive how far the files of a run reach.
   subroutine exchange_tables(points, tables, archive)
      integer, intent(in) :: points   !< Named points of the scene.
      type(tables_t), intent(inout) :: tables
      type(archive_t), intent(inout) :: archive

      call archive%exchange('origin', tables%origin)
      call archive%exchange('histories_bytes', tables%history%bytes, '-', 'bytes of histories.csv')
      call archive%exchange('ledger_bytes', tables%ledger%bytes, '-', 'bytes of ledger.csv')
      call archive%exchange('contact_bytes', tables%contact%bytes, '-', 'bytes of contact.csv')
      call archive%exchange('reactions_bytes', tables%reactions%bytes, '-', &
                            'bytes of the table of reactions of the stage')
      call archive%exchange_allocatable('frames', tables%frames%times, 's', 'times of the fields written so far')
      if (.not. allocated(tables%frames%times)) call archive%refuse()
      if (archive%reading) tables%peaks = new_peaks(points)
      call exchange_peaks(tables%peaks, archive)
   end subroutine exchange_tables

   !> Refuses a folder that does not hold the run of a checkpoint; changes nothing. Fault EXIT_RESTART: its mesh is of
   !> another scene, or a table is missing, too short or cannot be written.
   subroutine check_tables(folder, model, tables, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(tables_t), intent(in) :: tables
      type(fault_t), intent(inout) :: fault

      call check_mesh(folder, tables%origin, fault)
      if (fault%code == 0) call check_csv(folder//'/histories.csv', tables%history%bytes, fault)
      if (fault%code == 0) call check_csv(folder//'/ledger.csv', tables%ledger%bytes, fault)
      if (fault%code == 0 .and. has_contact_table(model)) &
         call check_csv(folder//'/contact.csv', tables%contact%bytes, fault)
      if (fault%code == 0 .and. tables%reactions%bytes > 0) call check_csv(reactions_of(folder, &
                                                                           tables%stage), tables%reactions%bytes, fault)
   end subroutine check_tables

   pure logical function has_contact_table(model)
      type(model_t), intent(in) :: model

      has_contact_table = size(model%contacts) + size(model%plates) > 0
   end function has_contact_table

   pure function history_columns(model) result(head)
      type(model_t), intent(in) :: model
      character(:), allocatable :: head
      integer :: i, k

      head = 'time'
      do i = 1, size(model%points)
         do k = 1, size(COLUMNS)
            head = head//','//trim(model%points(i)%name)//'.'//trim(COLUMNS(k))
         end do
      end do
   end function history_columns

   !> After the rows of a step. Fault EXIT_OUTPUT: a disk is full.
   subroutine hand_over_tables(tables, fault)
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault

      call hand_over(tables%history, fault)
      call hand_over(tables%ledger, fault)
      call hand_over(tables%contact, fault)
      call hand_over(tables%reactions, fault)
   end subroutine hand_over_tables

   !> Brings the tables to the disk. Fault EXIT_OUTPUT where that fails.
   subroutine flush_tables(tables, fault)
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault

      call flush_csv(tables%history, fault)
      if (fault%code == 0) call flush_csv(tables%ledger, fault)
      if (fault%code == 0 .and. is_open(tables%contact)) call flush_csv(tables%contact, fault)
      if (fault%code == 0 .and. is_open(tables%reactions)) call flush_csv(tables%reactions, fault)
   end subroutine flush_tables

   !> A row of histories.csv: time and the columns of every named point. Units [s, m, kPa, m/s, m/s2, kPa, -, -],
   !> stresses tension positive. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_history(tables, model, state, fault)
      type(tables_t), intent(inout) :: tables
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (size(model%points) == 0) return
      write (tables%history%row, NUMBERS) state%time, (values(model%points(i)), i=1, size(model%points))
      call write_row(tables%history, fault)
   contains
      pure function values(point)
         type(point_t), intent(in) :: point
         real(wp) :: values(size(COLUMNS))

         values = [unknowns_at(point, state%x), motion_at(point, state%v), motion_at(point, state%a), &
                   state%stress(1:4, point%gauss), state%e(point%gauss), state%s(point%gauss)]
      end function values
   end subroutine write_history

   !> A row of reactions_STAGE.csv after a step. The file belongs to the stage: it begins with its first row, or goes on
   !> where it was at the checkpoint. Units: see reaction_row. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_reactions(tables, model, run, dt, fault)
      type(tables_t), intent(inout) :: tables
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: dt   !< [s]
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: head, path

      associate (stage => model%stages(run%at%stage))
         if (.not. is_open(tables%reactions)) then
            head = reaction_columns(model, stage)
            if (head == '') return
            path = reactions_of(tables%folder, stage%name)
            if (tables%reactions%bytes > 0) then
               call resume_csv(path, head, tables%reactions, fault)
            else
               call new_csv(path, head, tables%reactions, fault)
            end if
            if (fault%code /= 0) return
         end if
         write (tables%reactions%row, NUMBERS) reaction_row(model, stage, run%drainage, run%constraint, &
                                                            run%system%reaction, run%state%time, dt)
         call write_row(tables%reactions, fault)
      end associate
   end subroutine write_reactions

   !> Path of the table of reactions of a stage.
   pure function reactions_of(folder, stage) result(path)
      character(*), intent(in) :: folder, stage
      character(:), allocatable :: path

      path = folder//'/reactions_'//trim(stage)//'.csv'
   end function reactions_of

   !> Ends the table of a stage. Fault EXIT_OUTPUT where that fails.
   subroutine close_reactions(tables, fault)
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault

      call close_csv(tables%reactions, fault)
      tables%reactions%bytes = 0
   end subroutine close_reactions

   !> A row of ledger.csv after a step that ends at a time [s]. Works [kJ], outflow [m3]: docs/theory/host.md section 9.
   !> Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_ledger(tables, time, report, ledger, fault)
      type(tables_t), intent(inout) :: tables
      real(wp), intent(in) :: time
      type(step_report_t), intent(in) :: report
      type(ledger_t), intent(in) :: ledger
      type(fault_t), intent(inout) :: fault

      associate (log => report%log)
         write (tables%ledger%row, '(2(es24.16e3,","),i0,",",i0,",",*(es14.6e3,:,","))') time, report%dt, &
            report%stage, log%iterations, log%error, log%first_error, log%reduction, log%correction, &
            real(log%rate_evaluations, wp), ledger%kinetic, ledger%skeleton, ledger%pores, ledger%gravity, &
            ledger%loads, ledger%supports, ledger%seepage, ledger%damping, ledger%friction, imbalance(ledger), &
            ledger%outflow, ledger%outflow_air, report%error, report%indicators
      end associate
      call write_row(tables%ledger, fault)
   end subroutine write_ledger

   !> A row of contact.csv after a step; nothing without contacts and plates. Units: see contact_row. Fault EXIT_OUTPUT:
   !> it cannot be written.
   subroutine write_contacts(tables, model, contacts, dt, state, work, fault)
      type(tables_t), intent(inout) :: tables
      type(model_t), intent(in) :: model
      type(contacts_t), intent(in) :: contacts
      real(wp), intent(in) :: dt, work   !< Step, and work done on the penalty so far [s, kJ].
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault

      if (.not. is_open(tables%contact)) return
      write (tables%contact%row, NUMBERS) contact_row(model, contacts, dt, state, work)
      call write_row(tables%contact, fault)
   end subroutine write_contacts

   !> nodes_STAGE.csv and points_STAGE.csv. Units [m, kPa, m/s], weight [m3], stresses tension positive. Fault
   !> EXIT_OUTPUT: they cannot be written.
   subroutine write_fields(folder, domain, stage, state, fault)
      character(*), intent(in) :: folder
      type(domain_t), intent(in) :: domain
      character(*), intent(in) :: stage   !< Its name.
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault
      real(wp) :: x(FIELDS, size(state%x, 2))
      type(csv_t) :: table
      integer :: i, e, g, p

      call all_pressures(domain, state, x)
      call new_csv(folder//'/nodes_'//stage//'.csv', 'r,z,u_r,u_z,p_w,p_c,v_r,v_z', table, fault)
      do i = 1, size(state%x, 2)
         if (fault%code /= 0) exit
         write (table%row, NUMBERS) domain%mesh%x(:, i), x(:, i), state%v(:DISPLACEMENTS, i)
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
      if (fault%code /= 0) return
      call new_csv(folder//'/points_'//stage//'.csv', 'r,z,weight,s_rr,s_zz,s_tt,s_rz,e,S_w', table, fault)
      do e = 1, size(domain%mesh%t6, 2)
         do g = 1, domain%rule
            if (fault%code /= 0) exit
            p = (e - 1)*domain%rule + g
            write (table%row, NUMBERS) domain%gauss(g, e)%x, domain%gauss(g, e)%weight, state%stress(1:4, p), &
               state%e(p), state%s(p)
            call write_row(table, fault)
         end do
      end do
      call close_csv(table, fault)
   end subroutine write_fields

   !> points.csv: the place of every point of the scene, and that of its stresses, the nearest quadrature point, both at
   !> the start [m]. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_points(folder, model, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: table
      integer :: i

      if (size(model%points) == 0) return
      call new_csv(folder//'/points.csv', 'name,r,z,stress_r,stress_z', table, fault)
      do i = 1, size(model%points)
         if (fault%code /= 0) exit
         associate (one => model%points(i), rule => model%domain%rule)
            write (table%row, '(a,",",*(es24.16e3,:,","))') trim(one%name), one%x, &
               model%domain%gauss(mod(one%gauss - 1, rule) + 1, (one%gauss - 1)/rule + 1)%x
         end associate
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   end subroutine write_points

   !> contact_STAGE.csv: slave nodes of the contacts that act in the stage. Units: see contact_nodes. Fault EXIT_OUTPUT:
   !> it cannot be written.
   subroutine write_contact_nodes(folder, model, contacts, stage, state, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(contacts_t), intent(in) :: contacts
      character(*), intent(in) :: stage   !< Its name.
      type(state_t), intent(in) :: state
      type(fault_t), intent(inout) :: fault
      real(wp), allocatable :: values(:, :)
      type(csv_t) :: table
      integer :: i

      if (.not. allocated(contacts%interfaces)) return
      call contact_nodes(model, contacts, state, values)
      call new_csv(folder//'/contact_'//stage//'.csv', 'contact,r,z,weight,coverage,gap,pressure,shear', table, &
                     fault)
      do i = 1, size(values, 2)
         if (fault%code /= 0) exit
         write (table%row, NUMBERS) values(:, i)
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   end subroutine write_contact_nodes

   !> Closes all tables; the first that fails is reported. Fault EXIT_OUTPUT: a disk is full.
   subroutine close_tables(tables, fault)
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault

      call close_csv(tables%history, fault)
      call close_csv(tables%ledger, fault)
      call close_csv(tables%contact, fault)
      call close_csv(tables%reactions, fault)
   end subroutine close_tables
end module output_tables
