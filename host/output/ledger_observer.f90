! SPDX-License-Identifier: MIT
!> Observer that keeps the ledger of a run: it books every accepted step, writes the tables with a row for each,
!> ledger.csv and contact.csv, and ends a run that has created energy, whose results may be wrong by any factor although
!> every step has converged. docs/theory/host.md section 9.
module ledger_observer
   use archive, only: archive_t
   use contact_rows, only: contact_columns, contact_row
   use csv, only: csv_t, check_csv, write_row, hand_over, close_csv, is_open, NUMBERS
   use energy_ledger, only: ledger_t, exchange_ledger, book_step, book_creation, allowed_creation, &
                            kinetic_energy, imbalance, ALARMING_SHARE
   use exit_codes, only: EXIT_ENERGY
   use faults, only: fault_t, raise
   use kinds, only: wp
   use localisation, only: localisation_observer_t
   use run_observer, only: observer_t, FITS, BEGINS, STEP, TAKEN_OVER, STAGE_ENDS, ENDS
   use run_state, only: run_t
   use run_tables, only: open_table, exchange_table
   use texts, only: short
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: ledger_observer_t

   character(*), parameter :: COLUMNS = 'time,dt,stage,iterations,cuts,'// &
      'error_u_r,error_u_z,error_p_w,error_p_c,first_u_r,first_u_z,first_p_w,first_p_c,reduction,correction,'// &
      'rates,kinetic,skeleton,pores,gravity,loads,supports,seepage,damping,friction,imbalance,'// &
      'outflow,outflow_air,localised,step_error'
   character(*), parameter :: REMEDY = 'shorten dt, set rho_inf = 0 where a contact opens and closes, or '// &
      'measure = ''change'' where weight rests'
   !> Steps in which the work of a load that has just begun exceeds by far that of its first step: it grows with the
   !> third power of their number and faster. In its first step there is no other work to be compared with, and the
   !> scheme creates up to an eighth of that: docs/theory/host.md section 9.
   real(wp), parameter :: PATIENCE = 5.0_wp

   type, extends(observer_t) :: ledger_observer_t
      type(csv_t) :: table
      type(csv_t) :: contact   !< It is open if the scene has contacts or plates.
      type(localisation_observer_t) :: localisation   !< Hears what the ledger hears; its share is a column.
      type(ledger_t) :: ledger
   contains
      procedure :: exchange
      procedure :: hear
   end type ledger_observer_t
contains
   !> Exchanges ledger, localisation and the lengths of the tables.
   subroutine exchange(self, archive)
      class(ledger_observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call exchange_ledger(self%ledger, archive)
      call self%localisation%exchange(archive)
      call exchange_table('ledger', self%table, archive)
      call exchange_table('contact', self%contact, archive)
   end subroutine exchange

   !> Books every step and writes its rows. Faults: EXIT_RESTART, a table is missing or too short; EXIT_OUTPUT, it
   !> cannot be written; those of book.
   subroutine hear(self, event, run, fault)
      class(ledger_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      call self%localisation%hear(event, run, fault)
      select case (event)
      case (FITS)
         call check_csv(self%folder//'/ledger.csv', self%table%bytes, fault)
         call check_csv(self%folder//'/contact.csv', self%contact%bytes, fault)
      case (BEGINS)
         if (run%steps == 0 .and. any(run%domain%regions%stiffness_damping > 0.0_wp)) &
            allocate (self%ledger%damping_stress(4, size(run%state%stress, 2)), source=0.0_wp)
         if (.not. allocated(self%folder)) return
         call open_table(self%folder//'/ledger.csv', COLUMNS, self%table, fault)
         if (size(run%model%contacts) + size(run%model%plates) > 0) &
            call open_table(self%folder//'/contact.csv', contact_columns(run%model), self%contact, fault)
      case (STEP)
         call book(self, run, fault)
      case (TAKEN_OVER)
         call write_step(self, run, fault)
      case (STAGE_ENDS)
         call look_at_creation(self, run)
      case (ENDS)
         call close_csv(self%table, fault)
         call close_csv(self%contact, fault)
      end select
   end subroutine hear

   !> Books a step: energies, work, outflow, contacts; and ends a run that creates energy: in PATIENCE steps in a row
   !> more than the stage may, or in its last one. docs/theory/host.md section 9. Fault EXIT_ENERGY.
   subroutine book(self, run, fault)
      class(ledger_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      associate (ledger => self%ledger, stage => run%stage)
         if (run%at%step == 1) then
            ledger%kinetic_0 = ledger%kinetic_0 + kinetic_energy(run, run%state) - ledger%kinetic
            ! The velocities of a stage without inertia are no motion: each stage begins its own account.
            if (run%steps > 1) ledger%open_0 = imbalance(ledger)
         end if
         call book_step(run, ledger)
         call book_creation(run, ledger)
         if (.not. stage%has_inertia) return
         ledger%overdue = merge(ledger%overdue + 1, 0.0_wp, &
                                ledger%most_created > allowed_creation(stage%created_energy, ledger))
         if (ledger%overdue < merge(1.0_wp, PATIENCE, run%last)) return
         call raise(fault, EXIT_ENERGY, 'Stage '//trim(stage%name)//', time '//short(run%next%time)// &
                    ' s: the run has created '//amount(ledger)//', allowed '//short(100*stage%created_energy)// &
                    ' %. Its results may be wrong by any factor: '//REMEDY//'; created_energy of &stage allows more.')
      end associate
   end subroutine book

   !> Writes the rows of a step. Works [kJ], outflow [m3]: docs/theory/host.md section 9. Fault EXIT_OUTPUT: they cannot
   !> be written.
   subroutine write_step(self, run, fault)
      class(ledger_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      self%ledger%dissipated = self%ledger%dissipated + run%dissipated
      if (.not. is_open(self%table)) return
      associate (log => run%log, ledger => self%ledger)
         write (self%table%row, '(2(es24.16e3,","),3(i0,","),*(es14.6e3,:,","))') run%state%time, &
            run%scheme%dt, run%at%stage, log%iterations, run%cuts, log%error, log%first_error, log%reduction, &
            log%correction, real(log%rate_evaluations, wp), ledger%kinetic, ledger%skeleton, ledger%pores, &
            ledger%gravity, ledger%loads, ledger%supports, ledger%seepage, ledger%damping, ledger%dissipated, &
            imbalance(ledger), ledger%outflow, ledger%outflow_air, self%localisation%share, run%control%error
      end associate
      call write_row(self%table, fault)
      call hand_over(self%table, fault)
      if (.not. is_open(self%contact)) return
      write (self%contact%row, NUMBERS) contact_row(run, self%ledger%contact)
      call write_row(self%contact, fault)
      call hand_over(self%contact, fault)
   end subroutine write_step

   !> Warns at the end of a dynamic stage that has created much, on standard error, also where the run is quiet. From
   !> ALARMING_SHARE of the largest work on; nothing beyond what has ended the run.
   subroutine look_at_creation(self, run)
      class(ledger_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run

      associate (stage => run%stage, ledger => self%ledger)
         if (stage%zero_displacements .and. allocated(ledger%damping_stress)) ledger%damping_stress = 0.0_wp
         if (.not. stage%has_inertia .or. ledger%most_created <= allowed_creation(ALARMING_SHARE, ledger)) return
         if (ledger%most_created > allowed_creation(stage%created_energy, ledger)) return
         call print_warning('stage '//trim(stage%name)//' has created '//amount(ledger)// &
            '. Do not use its results: '//REMEDY//'.')
      end associate
   end subroutine look_at_creation

   !> Says an energy in kJ and as a share.
   function amount(ledger) result(text)
      type(ledger_t), intent(in) :: ledger
      character(:), allocatable :: text

      text = short(ledger%most_created)//' kJ of energy, '//short(100*ledger%most_created/max(ledger%largest_work, &
             tiny(1.0_wp)))//' % of the largest work (column imbalance of ledger.csv)'
   end function amount
end module ledger_observer
