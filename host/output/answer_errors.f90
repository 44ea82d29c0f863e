! SPDX-License-Identifier: MIT
!> The estimated error of every answer of a run, and what limited the steps where they are controlled.
!> docs/theory/host.md section 4.5.
module answer_errors
   use warnings, only: print_warning
   use kinds, only: wp
   use control_state, only: control_state_t, is_answer, LEAST_PRESSURE, LIMIT_NAMES, BY_LARGEST, BY_SMALLEST
   use csv, only: csv_t, new_csv, write_row, close_csv, quoted
   use exit_codes, only: EXIT_ACCURACY
   use faults, only: fault_t, raise
   use force_answers, only: force_answer_t
   use error_norms, only: PATH
   use generalised_alpha, only: DYNAMIC
   use model_types, only: accuracy_of, model_t
   use named_answers, only: is_prescribed
   use newton_errors, only: NEWTON_SHARE
   use price_estimates, only: answer_t, STATE_WORDS
   use scene_goals, only: is_goal
   use stress_tolerance, only: roughness
   use texts, only: short, whole
   use unknown_fields, only: FIELDS, FIELD_NAMES, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: worst_unknown, write_answers, print_answers, judge_answers

   real(wp), parameter :: NO_CHANGE = 1.0e-9_wp   !< Share of the field's largest change that is no change of an answer.
   !> Of an answer: the warning is given from here on. In dynamic stages the magnitudes of errors add up, to ten times
   !> the true one in long shaking.
   real(wp), parameter :: ALARMING_ERROR = 0.1_wp, ALARMING_IN_MOTION = 0.3_wp
   real(wp), parameter :: BEYOND = 3.0_wp            !< Or from this multiple of the accuracy that was asked for.
   character(18), parameter :: OF_ALL(DISPLACEMENTS:FIELDS) = [character(18) :: 'displacements', 'p_w', 'p_c']
   character(170), parameter :: UNSEEN(DISPLACEMENTS:FIELDS) = [character(170) :: &
      ', since loads or prescribed values act at once; the response of a material with a memory may depend on how '// &
      'they are applied. Give them a &history.', &
      ': right if the flow has come to rest at the end, else wrong; take more steps.', &
      ': right if the flow has come to rest at the end, else wrong; take more steps.']
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

   !> Largest estimate of an unknown that is judged, as a share of its change: of the named points, or where none is
   !> named of all nodes together.
   real(wp) function worst_unknown(model, control) result(worst)
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      real(wp) :: change, error
      integer :: i, f

      worst = 0.0_wp
      do f = 1, FIELDS
         do i = 1, size(model%points)
            if (estimate(model, control, i, f, change, error)) then
               if (is_answer(control, f, change)) worst = max(worst, error)
            end if
         end do
         if (size(model%points) == 0 .and. is_answer(control, f, control%scale(f))) &
            worst = max(worst, control%largest(f)/control%scale(f))
      end do
   end function worst_unknown

   !> Judges every answer, or the goals where the scene names them, by its own change, of the fields where no point is
   !> named: what steps and Newton's method leave of it. What changes by less than LEAST_SHARE of its field is no
   !> answer. A warning where Newton's method leaves more than a tenth of the accuracy. Given steps: a warning on
   !> standard error, also where the run is quiet, of the worst one beyond 10 % (30 % with dynamic stages). Controlled
   !> steps: fault EXIT_ACCURACY where the worst one is beyond three times what was asked for. docs/theory/host.md
   !> section 4.5.
   subroutine judge_answers(model, control, verified, forces, fault)
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      logical, intent(in) :: verified   !< The errors are differences to a finer run.
      type(force_answer_t), intent(in) :: forces(:)   !< As list_forces gives them.
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: SHORTER = &
         'Leave dt out (steps are then controlled by their error) or shorten it; --verify measures the error.'
      character(:), allocatable :: worst, measured
      real(wp) :: change, error, largest, asked, newton, of_worst
      integer :: i, f

      asked = accuracy_of(model)
      newton = 0.0_wp
      of_worst = 0.0_wp
      largest = ALARMING_ERROR
      if (any(model%stages%kind == DYNAMIC) .and. .not. verified) largest = ALARMING_IN_MOTION
      if (asked > 0.0_wp) largest = BEYOND*asked
      worst = ''
      do f = 1, FIELDS
         do i = 1, size(model%points)
            if (.not. estimate(model, control, i, f, change, error)) cycle
            if (.not. is_answer(control, f, change)) cycle
            call compare(trim(model%points(i)%name)//'.'//trim(FIELD_NAMES(f)), error, control%newton(f, i)/change)
         end do
         ! A second run measures named answers alone.
         if (size(model%points) > 0 .or. verified .and. size(forces) > 0) cycle
         if (f < DISPLACEMENTS .or. .not. control%scale(f) > 0.0_wp) cycle
         if (f > DISPLACEMENTS .and. .not. control%scale(f) > LEAST_PRESSURE) cycle
         call compare('the '//trim(OF_ALL(max(f, DISPLACEMENTS)))//' (root mean square of all nodes)', &
                      control%largest(f)/control%scale(f), 0.0_wp)
      end do
      do i = 1, size(forces)
         call compare(trim(forces(i)%name), forces(i)%error, 0.0_wp)
      end do
      if (asked > 0.0_wp .and. newton > NEWTON_SHARE*asked) call print_warning( &
         'Newton''s method leaves '//short(100*newton)//' % of an answer, more than a tenth of the accuracy of '// &
         short(100*asked)//' %: '//of_tolerance(model)//'.')
      if (worst == '') return
      measured = trim(merge('measured ', 'estimated', verified))//' error of '//worst//' is '//short(100*largest)// &
                 ' % of its largest change'
      if (asked > 0.0_wp) then
         call raise(fault, EXIT_ACCURACY, 'The accuracy is not met: the '//measured//', '//short(100*asked)// &
                    ' % was asked for. '//what_limited(control)//' The results are written. '//remedy(model, control, &
                    asked, largest, of_worst))
         return
      end if
      call print_warning('the steps in time are too long: the '//measured//'. '//SHORTER)
   contains
      subroutine compare(name, error, by_newton)
         character(*), intent(in) :: name
         real(wp), intent(in) :: error, by_newton   !< Shares of its change that steps and Newton's method leave [-].

         if (size(model%goals) > 0) then
            if (.not. is_goal(model%goals, name, .true.)) return
         end if
         newton = max(newton, by_newton)
         ! Where no accuracy is asked for, the steps alone are judged.
         if (error + merge(by_newton, 0.0_wp, asked > 0.0_wp) <= largest) return
         worst = name
         of_worst = by_newton
         largest = error + merge(by_newton, 0.0_wp, asked > 0.0_wp)
      end subroutine compare
   end subroutine judge_answers

   !> Share of a field that came in single steps, of which nothing tells; 0 where it is too small to matter. [-]
   pure real(wp) function unseen_share(model, control, field) result(share)
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      integer, intent(in) :: field

      share = control%unseen(field)/max(control%scale(field), tiny(1.0_wp))
      if (PATH*share <= minval(model%stages%accuracy)) share = 0.0_wp
   end function unseen_share

   !> The worst errors of the named points, by their sources, and what the first of them leaves out.
   function parts_of(model, control, verified) result(text)
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      logical, intent(in) :: verified   !< The errors of the steps are differences to another run.
      character(:), allocatable :: text, left_out
      real(wp) :: change, error, steps, newton
      integer :: i, f

      steps = 0.0_wp
      newton = 0.0_wp
      do f = 1, FIELDS
         do i = 1, size(model%points)
            if (.not. estimate(model, control, i, f, change, error)) cycle
            if (.not. is_answer(control, f, change)) cycle
            steps = max(steps, error)
            newton = max(newton, control%newton(f, i)/change)
         end do
      end do
      text = 'steps'
      if (size(model%points) > 0) text = text//' '//short(100*steps)//' %'
      if (verified) text = text//' (measured)'
      left_out = ''
      do f = DISPLACEMENTS, FIELDS
         if (unseen_share(model, control, f) > 0.0_wp) left_out = ' without what came in single steps'
      end do
      if (.not. verified) text = text//left_out
      if (size(model%points) > 0) text = text//', Newton''s method '//short(100*newton)//' %'
   end function parts_of

   !> What kept most steps short, in words.
   function what_limited(control) result(text)
      type(control_state_t), intent(in) :: control
      character(:), allocatable :: text
      integer :: i

      i = maxloc(control%limits, 1)
      text = 'Steps were kept short by: '//trim(LIMIT_NAMES(i))//' ('//whole(nint(control%limits(i)))//' of '// &
             whole(nint(sum(control%limits)))//'); '//whole(control%rejected)//' steps were repeated.'
   end function what_limited

   !> What to change in the scene: by what kept most steps short, or where Newton's method leaves most.
   function remedy(model, control, asked, found, by_newton) result(text)
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      real(wp), intent(in) :: asked, found   !< Accuracy, and the error of the worst answer [-].
      real(wp), intent(in) :: by_newton      !< What Newton's method leaves of that answer [-].
      character(:), allocatable :: text

      if (by_newton > 0.5_wp*found) then
         text = 'Newton''s method leaves '//short(100*by_newton)//' %: '//of_tolerance(model)//'.'
         return
      end if
      select case (maxloc(control%limits, 1))
      case (BY_LARGEST)
         text = 'Shorten dt_max, or ask for an accuracy of '
      case (BY_SMALLEST)
         text = 'Split the stage: no step is shorter than 1e-8 of it. Or ask for an accuracy of '
      case default
         text = 'Ask for an accuracy of '
      end select
      text = text//short(asked*asked/found)//'; --verify measures the error.'
   end function remedy

   !> What to do about an error of Newton's method.
   function of_tolerance(model) result(text)
      type(model_t), intent(in) :: model
      character(:), allocatable :: text

      text = 'give &stage a smaller tolerance'
      if (any(model%stages%controlled .and. .not. model%stages%open_tolerance)) text = &
         'leave tolerance of &stage out, or give a smaller one'
   end function of_tolerance

   !> answers.csv: largest change [m, kPa], estimated error of the steps and of Newton's method [-] of every answer, the
   !> latter empty for forces: docs/theory/host.md section 4.5; error of the mesh [-] of those that meshes were compared
   !> by, and how far it is known: section 12. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_answers(folder, model, control, forces, by_meshes, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      type(force_answer_t), intent(in) :: forces(:)   !< As list_forces gives them.
      type(answer_t), intent(in) :: by_meshes(:)      !< Empty: meshes were not compared.
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: table
      real(wp) :: change, error
      integer :: i, f

      call new_csv(folder//'/answers.csv', 'answer,largest_change,estimated_error,newton_error,mesh_error,'// &
                   'mesh_state', table, fault)
      do i = 1, size(model%points)
         do f = 1, FIELDS
            if (fault%code /= 0) exit
            if (.not. estimate(model, control, i, f, change, error)) cycle
            write (table%row, '(a,3(",",es14.6e3),a)') quoted(trim(model%points(i)%name)//'.'//trim(FIELD_NAMES(f))), &
               change, error, control%newton(f, i)/change, &
               of_mesh(trim(model%points(i)%name)//'.'//trim(FIELD_NAMES(f)))
            call write_row(table, fault)
         end do
      end do
      do i = 1, size(forces)
         if (fault%code /= 0) exit
         write (table%row, '(a,2(",",es14.6e3),",",a)') quoted(trim(forces(i)%name)), &
            forces(i)%change, forces(i)%error, of_mesh(trim(forces(i)%name))
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   contains
      !> The two last cells of a row.
      function of_mesh(name) result(cells)
         character(*), intent(in) :: name
         character(:), allocatable :: cells
         character(14) :: number
         integer :: k

         cells = ',,not estimated'
         do k = 1, size(by_meshes)
            if (by_meshes(k)%name /= name) cycle
            write (number, '(es14.6e3)') by_meshes(k)%mesh
            cells = ','//number//','//trim(STATE_WORDS(by_meshes(k)%state))
         end do
      end function of_mesh
   end subroutine write_answers

   !> The same in words, and what limited the steps.
   subroutine print_answers(unit, model, control, verified, forces)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      logical, intent(in) :: verified   !< The errors are differences to a run at a quarter of the accuracy.
      type(force_answer_t), intent(in) :: forces(:)   !< As list_forces gives them.
      real(wp) :: change, error, share
      integer :: i, f

      if (verified) write (unit, '(a)') 'Verified: errors are differences to the run at a quarter of the accuracy.'
      write (unit, '(a)') 'Answers: largest change, and estimated error of the history as a share of it, by steps '// &
         'in time and by Newton''s method:'
      do i = 1, size(model%points)
         do f = 1, FIELDS
            if (estimate(model, control, i, f, change, error)) write (unit, '(a)') '   '//trim(model%points(i)%name)// &
               '.'//trim(FIELD_NAMES(f))//': '//short(change)//trim(merge(' m  ', ' kPa', f <= DISPLACEMENTS))// &
               ', '//short(100*error)//' %, '//short(100*control%newton(f, i)/change)//' %'// &
               trim(merge('                              ', ' (too small: it is not judged)', &
                          is_answer(control, f, change)))
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
      do f = DISPLACEMENTS, FIELDS
         share = unseen_share(model, control, f)
         if (.not. share > 0.0_wp) cycle
         write (unit, '(a)') '   Not estimated: '//short(100*min(share, 1.0_wp))//' % of '//trim(OF_ALL(f))// &
            ' came in single steps'//trim(UNSEEN(f))
      end do
      if (any(model%stages%controlled)) write (unit, '(a)') '   '//what_limited(control)
      if (any(model%stages%kind == DYNAMIC) .and. .not. verified) write (unit, '(a)') '   Not seen: vibrations of '// &
         'fewer than about ten steps a period. The steps damp them; a shorter dt_max shows them.'
      if (any(model%stages%kind == DYNAMIC) .and. turns_at_once(model)) write (unit, '(a)') '   Not seen: jumps of '// &
         'the rates of soil without an elastic domain (rho_e = 0), at every turn of its strain, were it that of a '// &
         'vibration: answers change irregularly with the steps. The default of rho_e avoids them.'
      write (unit, '(a)') 'In these errors: '//parts_of(model, control, verified)//'; mesh not estimated: --price'// &
         trim(merge('; nor is the stress integration.', '.                               ', roughness( &
                    model%domain%regions) > 0.0_wp))
   end subroutine print_answers

   !> Whether a region has a material whose rates jump where its strain turns.
   pure logical function turns_at_once(model)
      type(model_t), intent(in) :: model
      integer :: i

      turns_at_once = .false.
      do i = 1, size(model%domain%regions)
         turns_at_once = turns_at_once .or. model%domain%regions(i)%law%turns_at_once
      end do
   end function turns_at_once
end module answer_errors
