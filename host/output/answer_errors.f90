! SPDX-License-Identifier: MIT
!> The estimated error of every answer of a run whose steps are controlled, and what limited the steps.
!> docs/theory/host.md section 4.5.
module answer_errors
   use kinds, only: wp
   use control_state, only: control_state_t, LIMIT_NAMES
   use csv, only: csv_t, new_csv, write_row, close_csv
   use faults, only: fault_t
   use model_types, only: model_t
   use texts, only: short, whole
   use unknown_fields, only: FIELDS, FIELD_NAMES, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: write_answers, print_answers

   real(wp), parameter :: NO_CHANGE = 1.0e-9_wp   !< Share of the field's largest change that is no change of an answer.
contains
   !> Largest change of a field at a named point, and its estimated error as a share of it; false where nothing happens.
   logical function estimate(model, control, point, field, change, error)
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      integer, intent(in) :: point, field
      real(wp), intent(out) :: change, error   !< [m or kPa, -]
      real(wp) :: scale

      change = 0.0_wp
      error = 0.0_wp
      estimate = model%dofs%of(field, model%points(point)%node) > 0
      if (.not. estimate) return
      change = control%high(field, point) - control%low(field, point)
      scale = control%scale(field)
      estimate = change > NO_CHANGE*scale .and. change > 0.0_wp
      if (estimate) error = control%point_largest(field, point)/change
   end function estimate

   !> answers.csv: largest change [m, kPa] and estimated error [-] of every answer: docs/theory/host.md section 4.5.
   !> Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_answers(folder, model, control, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: table
      real(wp) :: change, error
      integer :: i, f

      call new_csv(folder//'/answers.csv', 'answer,largest_change,estimated_error', table, fault)
      do i = 1, size(model%points)
         do f = 1, FIELDS
            if (fault%code /= 0) exit
            if (.not. estimate(model, control, i, f, change, error)) cycle
            write (table%row, '(a,2(",",es14.6e3))') trim(model%points(i)%name)//'.'//trim(FIELD_NAMES(f)), change, &
               error
            call write_row(table, fault)
         end do
      end do
      call close_csv(table, fault)
   end subroutine write_answers

   !> The same in words, and what limited the steps.
   subroutine print_answers(unit, model, control, verified)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      logical, intent(in) :: verified   !< The errors are differences to a run at a quarter of the accuracy.
      real(wp) :: change, error
      integer :: i, f

      if (verified) write (unit, '(a)') 'Verified: errors are differences to the run at a quarter of the accuracy.'
      write (unit, '(a)') 'Answers: largest change, and estimated error of the history as a share of it (steps in '// &
         'time alone; the mesh is not in it):'
      do i = 1, size(model%points)
         do f = 1, FIELDS
            if (estimate(model, control, i, f, change, error)) write (unit, '(a)') '   '//trim(model%points(i)%name)// &
               '.'//trim(FIELD_NAMES(f))//': '//short(change)//trim(merge(' m  ', ' kPa', f <= DISPLACEMENTS))// &
               ', '//short(100*error)//' %'
         end do
      end do
      i = maxloc(control%limits, 1)
      write (unit, '(a)') '   Steps were kept short by: '//trim(LIMIT_NAMES(i))//' ('// &
         whole(nint(control%limits(i)))//' of '//whole(nint(sum(control%limits)))//'); '// &
         whole(control%rejected)//' steps were repeated.'
   end subroutine print_answers
end module answer_errors
