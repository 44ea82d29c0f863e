! SPDX-License-Identifier: MIT
!> The estimated error of every answer of a run whose steps are controlled, and what limited the steps.
!> docs/theory/host.md section 4.5.
module answer_errors
   use kinds, only: wp
   use answer_verification, only: force_error_t
   use control_state, only: control_state_t, LIMIT_NAMES
   use csv, only: csv_t, new_csv, write_row, close_csv
   use faults, only: fault_t
   use error_norms, only: PATH
   use model_types, only: model_t
   use scene_types, only: acts_in
   use texts, only: short, whole
   use unknown_fields, only: FIELDS, FIELD_NAMES, DISPLACEMENTS, AT_U_R
   implicit none (type, external)
   private
   public :: write_answers, print_answers

   real(wp), parameter :: NO_CHANGE = 1.0e-9_wp   !< Share of the field's largest change that is no change of an answer.
   character(18), parameter :: OF_ALL(DISPLACEMENTS:FIELDS) = [character(18) :: 'displacements', 'p_w', 'p_c']
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
      if (estimate) estimate = .not. is_prescribed(model, model%points(point)%node, field)
      if (.not. estimate) return
      change = control%high(field, point) - control%low(field, point)
      scale = control%scale(field)
      estimate = change > NO_CHANGE*scale .and. change > 0.0_wp
      if (estimate) error = control%point_largest(field, point)/change
   end function estimate

   !> Whether every stage with controlled steps prescribes an unknown throughout: then it is no answer.
   pure logical function is_prescribed(model, node, field) result(prescribed)
      type(model_t), intent(in) :: model
      integer, intent(in) :: node, field
      logical :: held
      integer :: i, k

      prescribed = .true.
      do i = 1, size(model%stages)
         if (.not. model%stages(i)%controlled) cycle
         held = .false.
         do k = 1, size(model%fixes)
            associate (fix => model%fixes(k))
               if (fix%field /= field .or. .not. acts_in(fix%stages, model%stages(i)%name)) cycle
               if (fix%from > -huge(1.0_wp) .or. fix%until < huge(1.0_wp)) cycle
               held = held .or. any(model%domain%mesh%groups(fix%group)%nodes == node)
            end associate
         end do
         prescribed = prescribed .and. held
      end do
   end function is_prescribed

   !> answers.csv: largest change [m, kPa] and estimated error [-] of every answer: docs/theory/host.md section 4.5.
   !> Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_answers(folder, model, control, forces, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      type(force_error_t), intent(in) :: forces(:)   !< As compare_forces gives them; none without a second run.
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
      do i = 1, size(forces)
         if (fault%code /= 0) exit
         write (table%row, '(a,2(",",es14.6e3))') trim(forces(i)%name), forces(i)%change, forces(i)%error
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   end subroutine write_answers

   !> The same in words, and what limited the steps.
   subroutine print_answers(unit, model, control, verified, forces)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      logical, intent(in) :: verified   !< The errors are differences to a run at a quarter of the accuracy.
      type(force_error_t), intent(in) :: forces(:)   !< As compare_forces gives them.
      real(wp) :: change, error, share
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
      do i = 1, size(forces)
         write (unit, '(a)') '   '//trim(forces(i)%name)//': '//short(forces(i)%change)//' kN, '// &
            short(100*forces(i)%error)//' %'
      end do
      do f = DISPLACEMENTS, FIELDS
         if (verified) exit
         if (control%largest(f) > 0.0_wp .and. control%scale(f) > 0.0_wp) write (unit, '(a)') '   all nodes, '// &
            trim(OF_ALL(f))//', root mean square: '//short(control%scale(f))// &
            trim(merge(' m  ', ' kPa', f <= DISPLACEMENTS))//', '//short(100*control%largest(f)/control%scale(f))//' %'
      end do
      share = control%unseen/max(control%scale(AT_U_R), tiny(1.0_wp))
      if (PATH*share > minval(model%stages%accuracy, mask=model%stages%controlled)) write (unit, '(a)') &
         '   Not estimated: '//short(100*min(share, 1.0_wp))//' % of the displacements came in single steps, '// &
         'since loads or prescribed values act at once; the response of a material with a memory may depend on how '// &
         'they are applied. Give them a &history.'
      i = maxloc(control%limits, 1)
      write (unit, '(a)') '   Steps were kept short by: '//trim(LIMIT_NAMES(i))//' ('// &
         whole(nint(control%limits(i)))//' of '//whole(nint(sum(control%limits)))//'); '// &
         whole(control%rejected)//' steps were repeated.'
   end subroutine print_answers
end module answer_errors
