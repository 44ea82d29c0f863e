! SPDX-License-Identifier: MIT
!> Observer that writes the tables of a run: histories of points, reactions of a stage, and nodes, points and contacts
!> at the end of a stage. Those with a row for every step are the ledger's.
module output_tables
   use archive, only: archive_t
   use contact_rows, only: contact_nodes
   use csv, only: csv_t, new_csv, check_csv, write_row, hand_over, close_csv, is_open, NUMBERS
   use faults, only: fault_t
   use given_pressures, only: set_middles
   use kinds, only: wp
   use model_types, only: model_t, point_t
   use named_points, only: values_at
   use reaction_rows, only: reaction_columns, reaction_row
   use run_observer, only: observer_t, FITS, BEGINS, TAKEN_OVER, STAGE_ENDS, ENDS
   use run_state, only: run_t
   use run_tables, only: open_table, exchange_table, write_table, columns_of
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_W
   implicit none (type, external)
   private
   public :: table_observer_t

   character(4), parameter :: COLUMNS(14) = [character(4) :: 'u_r', 'u_z', 'p_w', 'p_c', 'v_r', 'v_z', 'a_r', 'a_z', &
      's_rr', 's_zz', 's_tt', 's_rz', 'e', 'S_w']

   type, extends(observer_t) :: table_observer_t
      type(csv_t) :: history
      type(csv_t) :: reactions   !< Table of the stage under way, if it prescribes or loads anything.
   contains
      procedure :: exchange
      procedure :: hear
   end type table_observer_t
contains
   !> Exchanges the lengths of the tables.
   subroutine exchange(self, archive)
      class(table_observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call exchange_table('histories', self%history, archive)
      call exchange_table('reactions', self%reactions, archive)
   end subroutine exchange

   !> Opens the tables, writes the rows of steps, and the tables of a stage at its end; after a failure too, for what
   !> was computed. Faults: EXIT_RESTART, a table is missing or too short; EXIT_OUTPUT, a file cannot be written.
   subroutine hear(self, event, run, fault)
      class(table_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      select case (event)
      case (FITS)
         call check_csv(self%folder//'/histories.csv', self%history%bytes, fault)
         call check_csv(reactions_of(self%folder, run%stage%name), self%reactions%bytes, fault)
      case (BEGINS)
         call open_table(self%folder//'/histories.csv', history_columns(run%model), self%history, fault)
         if (fault%code /= 0 .or. run%steps > 0) return
         call write_points(self%folder, run%model, fault)
         if (fault%code == 0) call write_history(self%history, run, fault)
      case (TAKEN_OVER)
         call write_rows(self, run, fault)
      case (STAGE_ENDS)
         call close_csv(self%reactions, fault)
         self%reactions%bytes = 0
         call write_fields(self%folder//'/', run, trim(run%stage%name)//'.csv', fault)
         if (allocated(run%system%contacts)) call write_table(self%folder//'/contact_'//trim(run%stage%name)//'.csv', &
            'contact,r,z,weight,coverage,gap,pressure,shear', contact_nodes(run), fault)
      case (ENDS)
         call close_csv(self%history, fault)
         call close_csv(self%reactions, fault)
      end select
   end subroutine hear

   !> Writes the rows of a step that are due. Fault EXIT_OUTPUT: a file cannot be written.
   subroutine write_rows(self, run, fault)
      class(table_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      if (mod(run%at%step, run%stage%every) == 0 .or. run%last) then
         call write_history(self%history, run, fault)
         if (fault%code == 0) call write_reactions(self, run, fault)
      end if
      call hand_over(self%history, fault)
      call hand_over(self%reactions, fault)
   end subroutine write_rows

   pure function history_columns(model) result(head)
      type(model_t), intent(in) :: model
      character(:), allocatable :: head
      integer :: i

      head = 'time'
      do i = 1, size(model%output%points)
         head = head//columns_of(model%output%points(i)%name, COLUMNS)
      end do
   end function history_columns

   !> Writes a row of histories.csv: time and the columns of every named point. Units are [s, m, kPa, m/s, m/s2, kPa,
   !> -, -]; tension is positive. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_history(table, run, fault)
      type(csv_t), intent(inout) :: table
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i

      associate (points => run%model%output%points)
         if (size(points) == 0) return
         write (table%row, NUMBERS) run%state%time, (values(points(i)), i=1, size(points))
      end associate
      call write_row(table, fault)
   contains
      pure function values(point)
         type(point_t), intent(in) :: point
         real(wp) :: values(size(COLUMNS))

         associate (state => run%state)
            values = [values_at(point, state%x), values_at(point, state%v(:DISPLACEMENTS, :)), &
                      values_at(point, state%a(:DISPLACEMENTS, :)), &
                      state%stress(1:4, point%gauss), state%e(point%gauss), state%s(point%gauss)]
         end associate
      end function values
   end subroutine write_history

   !> Writes a row of reactions_STAGE.csv after a step. The file belongs to the stage: it begins with its first row, or
   !> goes on where it was at the checkpoint. reaction_row has the units. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_reactions(self, run, fault)
      type(table_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: head

      if (.not. is_open(self%reactions)) then
         head = reaction_columns(run)
         if (head == '') return
         call open_table(reactions_of(self%folder, run%stage%name), head, self%reactions, fault)
         if (fault%code /= 0) return
      end if
      write (self%reactions%row, NUMBERS) reaction_row(run)
      call write_row(self%reactions, fault)
   end subroutine write_reactions

   !> Names the table of reactions of a stage.
   pure function reactions_of(folder, stage) result(path)
      character(*), intent(in) :: folder, stage
      character(:), allocatable :: path

      path = folder//'/reactions_'//trim(stage)//'.csv'
   end function reactions_of

   !> Writes nodes_STAGE.csv and points_STAGE.csv. Units are [m, kPa, m/s], weights in [m3]; tension is positive.
   !> Fault EXIT_OUTPUT: they cannot be written.
   subroutine write_fields(folder, run, name, fault)
      character(*), intent(in) :: folder, name   !< Beginning and end of the paths.
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      real(wp) :: x(FIELDS, size(run%state%x, 2))
      integer :: i, e, g

      associate (state => run%state, mesh => run%domain%mesh, gauss => run%domain%gauss, n => run%domain%rule)
         x = state%x
         call set_middles(run%domain, x(AT_P_W:, :))
         call write_table(folder//'nodes_'//name, 'r,z,u_r,u_z,p_w,p_c,v_r,v_z', &
                          reshape([(mesh%x(:, i), x(:, i), state%v(:DISPLACEMENTS, i), i=1, size(x, 2))], &
                                  [8, size(x, 2)]), fault)
         call write_table(folder//'points_'//name, 'r,z,weight,s_rr,s_zz,s_tt,s_rz,e,S_w', &
                          reshape([((gauss(g, e)%x, gauss(g, e)%weight, state%stress(1:4, (e - 1)*n + g), &
                                     state%e((e - 1)*n + g), state%s((e - 1)*n + g), g=1, n), e=1, size(gauss, 2))], &
                                  [9, size(gauss)]), fault)
      end associate
   end subroutine write_fields

   !> Writes points.csv: the place of every point of the scene, and that of its stresses, the nearest quadrature point,
   !> both at the start [m]. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_points(folder, model, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: table
      integer :: i

      if (size(model%output%points) == 0) return
      call new_csv(folder//'/points.csv', 'name,r,z,stress_r,stress_z', table, fault)
      do i = 1, size(model%output%points)
         if (fault%code /= 0) exit
         associate (one => model%output%points(i), rule => model%domain%rule)
            write (table%row, '(a,",",*(es24.16e3,:,","))') trim(one%name), one%x, &
               model%domain%gauss(mod(one%gauss - 1, rule) + 1, (one%gauss - 1)/rule + 1)%x
         end associate
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   end subroutine write_points
end module output_tables
