! SPDX-License-Identifier: MIT
!> Forces of the supports and thrusts of the contacts as answers of a run: their largest changes and errors, estimated
!> or measured against a second run. docs/theory/host.md section 4.5.
module force_answers
   use kinds, only: wp
   use answer_verification, only: read_numbers, NAME_LENGTH
   use control_state, only: control_state_t
   use faults, only: fault_t
   use history_distance, only: farthest, peaks_apart
   use model_types, only: model_t
   use output_tables, only: reactions_of
   use unknown_fields, only: AT_U_R
   implicit none (type, external)
   private
   public :: force_answer_t, list_forces, measure_forces

   real(wp), parameter :: NO_FORCE = 1.0e-3_wp   !< Share of the largest change of a force of the stage that is none.
   real(wp), parameter :: ROUNDING = 1.0e-9_wp   !< Share of the largest force of a node that is none.
   integer, parameter :: TIME_OF_FORCES = 2      !< Column of a table of reactions.
   integer, parameter :: TIME = 1                !< Column of contact.csv.
   character(*), parameter :: FORCES_R = '.force_r', FORCES_Z = '.force_z', THRUST = '.thrust'

   type :: force_answer_t
      character(NAME_LENGTH) :: name = ''        !< "stage: group.force_z", "contact.thrust".
      real(wp) :: change = 0.0_wp                !< Largest one [kN].
      real(wp) :: error = 0.0_wp                 !< Share of it [-].
      integer :: stage = 0                       !< Number of the stage; 0: a contact, in the whole run.
      character(NAME_LENGTH) :: column = ''      !< In its table.
   end type force_answer_t
contains
   !> Forces of the supports of every stage and thrusts of the contacts, with their estimated errors. A support is taken
   !> to be as wrong as the worst of the unknowns, `worst`; a thrust, where its own estimate is larger, as that.
   !> docs/theory/host.md section 4.5. What changes by no more than the rounding of the largest force of a node, or by a
   !> thousandth of the largest force of its stage, is none; nor is that of an axis of symmetry. Fault EXIT_OUTPUT: a
   !> table cannot be read.
   subroutine list_forces(folder, model, control, worst, force_of_node, forces, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(control_state_t), intent(in) :: control
      real(wp), intent(in) :: worst   !< Error as a share of the change [-].
      real(wp), intent(in) :: force_of_node   !< Sum of the magnitudes of its elements, the largest [kN].
      type(force_answer_t), allocatable, intent(out) :: forces(:)
      type(fault_t), intent(inout) :: fault
      character(NAME_LENGTH), allocatable :: names(:)
      real(wp), allocatable :: numbers(:, :), change(:)
      logical :: there
      integer :: i, k

      allocate (forces(0))
      do i = 1, size(model%stages)
         inquire (file=reactions_of(folder, model%stages(i)%name), exist=there)
         if (.not. there) cycle
         call read_numbers(reactions_of(folder, model%stages(i)%name), names, numbers, fault)
         if (fault%code /= 0) return
         if (size(numbers, 2) < 2) cycle
         change = maxval(numbers, dim=2) - minval(numbers, dim=2)
         where (.not. (index(names, FORCES_R) > 0 .or. index(names, FORCES_Z) > 0)) change = 0.0_wp
         do k = 1, size(names)
            if (.not. change(k) > max(ROUNDING*force_of_node, NO_FORCE*maxval(change))) cycle
            if (is_of_axis(model, trim(names(k)))) cycle
            forces = [forces, force_answer_t(trim(model%stages(i)%name)//': '//names(k), change(k), worst, i, names(k))]
         end do
      end do
      do k = 1, size(control%thrust)
         associate (memory => control%thrust(k))
            if (.not. memory%high - memory%low > ROUNDING*force_of_node) cycle
            forces = [forces, force_answer_t(trim(model%contacts(k)%name)//THRUST, memory%high - memory%low, &
                                             max(worst, memory%largest/(memory%high - memory%low)), 0, &
                                             trim(model%contacts(k)%name)//THRUST)]
         end associate
      end do
   end subroutine list_forces

   !> Whether a column is the radial force of an axis of symmetry: no support, but the form of the equations there.
   pure logical function is_of_axis(model, column)
      type(model_t), intent(in) :: model
      character(*), intent(in) :: column
      integer :: i

      is_of_axis = .false.
      if (.not. model%domain%axisymmetric) return
      do i = 1, size(model%domain%mesh%groups)
         associate (group => model%domain%mesh%groups(i))
            if (trim(group%name)//FORCES_R == column) &
               is_of_axis = .not. any(model%domain%mesh%x(AT_U_R, group%nodes) > 0.0_wp)
         end associate
      end do
   end function is_of_axis

   !> Takes the largest distance to a second run of the scene as the error of every force: of a support at the times
   !> that its forces hold for, of a thrust at its peaks. Fault EXIT_OUTPUT: a table cannot be read.
   subroutine measure_forces(folder, other_folder, model, forces, fault)
      character(*), intent(in) :: folder, other_folder
      type(model_t), intent(in) :: model
      type(force_answer_t), intent(inout) :: forces(:)
      type(fault_t), intent(inout) :: fault
      real(wp), allocatable :: one(:, :), two(:, :)   !< Time and force of every row.
      integer :: i

      do i = 1, size(forces)
         call read_force(folder, model, forces(i), one, fault)
         if (fault%code == 0) call read_force(other_folder, model, forces(i), two, fault)
         if (fault%code /= 0) return
         if (forces(i)%stage > 0) then
            forces(i)%error = abs(farthest(one(1, :), one(2, :), two(1, :), two(2, :)))/forces(i)%change
         else
            forces(i)%error = peaks_apart(one(1, :), one(2, :), two(1, :), two(2, :))/forces(i)%change
         end if
      end do
   end subroutine measure_forces

   !> Time and value of a force in every row of its table. Fault EXIT_OUTPUT: it cannot be read.
   subroutine read_force(folder, model, force, rows, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(force_answer_t), intent(in) :: force
      real(wp), allocatable, intent(out) :: rows(:, :)
      type(fault_t), intent(inout) :: fault
      character(NAME_LENGTH), allocatable :: names(:)
      real(wp), allocatable :: numbers(:, :)

      allocate (rows(2, 0))
      if (force%stage > 0) then
         call read_numbers(reactions_of(folder, model%stages(force%stage)%name), names, numbers, fault)
      else
         call read_numbers(folder//'/contact.csv', names, numbers, fault)
      end if
      if (fault%code /= 0) return
      rows = numbers([merge(TIME_OF_FORCES, TIME, force%stage > 0), findloc(names, force%column, dim=1)], :)
   end subroutine read_force
end module force_answers
