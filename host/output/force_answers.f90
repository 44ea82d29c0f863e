! SPDX-License-Identifier: MIT
!> Forces of the supports and thrusts of the contacts as answers of a run: their largest changes and errors, estimated
!> or measured against a second run. docs/theory/host.md section 4.5.
module force_answers
   use kinds, only: wp
   use answer_verification, only: read_numbers, NAME_LENGTH
   use error_norms, only: constant_of_accelerations, constant_of_rates, kept_of_motion
   use faults, only: fault_t
   use force_errors, only: error_of_support, error_on_path, error_of_peaks, VALUES
   use generalised_alpha, only: make_scheme, scheme_t, STATIC, QUASI_STATIC, DYNAMIC
   use history_distance, only: farthest, peak_difference
   use model_types, only: model_t
   use output_tables, only: reactions_of
   use scene_types, only: stage_t
   use step_landings, only: is_break
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

   !> The steps of a run, as its ledger has them. (steps)
   type :: steps_t
      integer, allocatable :: stage(:)                     !< Its number.
      real(wp), allocatable :: time(:), dt(:)              !< At their ends, their lengths [s].
      real(wp), allocatable :: early(:)                    !< By how much forces hold before the end [s].
      real(wp), allocatable :: constant(:)                 !< C of the error of a step, 0: nothing estimates it [-].
      real(wp), allocatable :: kept(:)                     !< Share of earlier errors that a step leaves [-].
      real(wp), allocatable :: bend(:)                     !< By which the stiffness changes in it, static stages [-].
   end type steps_t
contains
   !> Forces of the supports of every stage and thrusts of the contacts, with the errors that their histories tell.
   !> Where these tell nothing, in static stages of a few steps and where not every step is written, a force is taken to
   !> be as wrong as the worst of the unknowns, `worst`. docs/theory/host.md section 4.5. What changes by no more
   !> than the rounding of the largest force of a node, in static stages by no more than Newton's method leaves of it,
   !> or by a thousandth of the largest force of its stage, is none;
   !> nor is that of an axis of symmetry. Fault EXIT_OUTPUT: a table cannot be read.
   subroutine list_forces(folder, model, worst, force_of_node, forces, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: worst   !< Error as a share of the change [-].
      real(wp), intent(in) :: force_of_node   !< Sum of the magnitudes of its elements, the largest [kN].
      type(force_answer_t), allocatable, intent(out) :: forces(:)
      type(fault_t), intent(inout) :: fault
      character(NAME_LENGTH), allocatable :: names(:)
      real(wp), allocatable :: numbers(:, :), change(:)
      type(steps_t) :: steps
      character(NAME_LENGTH) :: thrusts(size(model%contacts))
      logical :: there
      integer :: i, k

      allocate (forces(0))
      call read_steps(folder, model, steps, fault)
      if (fault%code /= 0) return
      do i = 1, size(model%stages)
         inquire (file=reactions_of(folder, model%stages(i)%name), exist=there)
         if (.not. there) cycle
         call read_numbers(reactions_of(folder, model%stages(i)%name), names, numbers, fault)
         if (fault%code /= 0) return
         if (size(numbers, 2) < 2) cycle
         change = maxval(numbers, dim=2) - minval(numbers, dim=2)
         where (.not. (index(names, FORCES_R) > 0 .or. index(names, FORCES_Z) > 0)) change = 0.0_wp
         do k = 1, size(names)
            if (.not. change(k) > max(least(model%stages(i))*force_of_node, NO_FORCE*maxval(change))) cycle
            if (is_of_axis(model, trim(names(k)))) cycle
            forces = [forces, force_answer_t(trim(model%stages(i)%name)//': '//names(k), change(k), &
                                             support(i, numbers(TIME_OF_FORCES, :), numbers(k, :), change(k)), i, &
                                             names(k))]
         end do
      end do
      if (size(model%contacts) == 0) return
      do k = 1, size(thrusts)
         thrusts(k) = trim(model%contacts(k)%name)//THRUST
      end do
      call read_numbers(folder//'/contact.csv', names, numbers, fault, thrusts)
      if (fault%code /= 0) return
      do k = 1, size(thrusts)
         i = findloc(names, thrusts(k), dim=1)
         if (i == 0 .or. size(numbers, 2) == 0) cycle
         associate (thrust => numbers(i, :), range => maxval(numbers(i, :)) - minval(numbers(i, :)))
            if (.not. range > ROUNDING*force_of_node) cycle
            forces = [forces, force_answer_t(thrusts(k), range, peaks(thrust, range), 0, thrusts(k))]
         end associate
      end do
   contains
      !> Share of the largest force of a node that is none: rounding, in static stages what Newton's method leaves.
      pure real(wp) function least(stage)
         type(stage_t), intent(in) :: stage

         least = ROUNDING
         if (stage%kind == STATIC) least = max(least, stage%tolerance)
      end function least

      !> Error of the force of a support in a stage, as a share of its change.
      pure real(wp) function support(stage, times, force, change) result(error)
         integer, intent(in) :: stage
         real(wp), intent(in) :: times(:), force(:), change   !< [s], [kN] (rows); [kN]
         logical :: here(size(steps%stage))

         here = steps%stage == stage
         error = worst
         if (count(here) /= size(times)) return
         if (model%stages(stage)%kind == STATIC) then
            if (any(here .and. steps%bend > 0.0_wp)) &
               error = error_on_path(times, pack(steps%dt, here), pack(steps%bend, here), force)/change
            return
         end if
         if (.not. any(here .and. steps%constant > 0.0_wp)) return
         error = error_of_support(times, pack(steps%dt, here), pack(steps%constant, here), pack(steps%kept, here), &
                                  force, model%stages(stage)%kind == QUASI_STATIC)/change
      end function support

      !> Error of the peaks of a thrust in stages with inertia, as a share of its change.
      pure real(wp) function peaks(thrust, change) result(error)
         real(wp), intent(in) :: thrust(:), change   !< [kN] (rows); [kN]
         logical :: moves(size(steps%stage))

         error = worst
         moves = model%stages(steps%stage)%kind == DYNAMIC
         if (size(moves) /= size(thrust) .or. .not. any(moves)) return
         error = error_of_peaks(steps%time - steps%early, steps%dt, steps%constant, steps%kept, &
                                merge(thrust, 0.0_wp, moves), worst)/change
      end function peaks
   end subroutine list_forces

   !> The steps of a run by its ledger, with what fades of errors in each: as docs/theory/host.md section 4.5 says of
   !> the unknowns. Fault EXIT_OUTPUT: the ledger cannot be read.
   subroutine read_steps(folder, model, steps, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(steps_t), intent(out) :: steps
      type(fault_t), intent(inout) :: fault
      character(NAME_LENGTH), allocatable :: names(:)
      real(wp), allocatable :: numbers(:, :), kinetic(:), damping(:)
      type(scheme_t) :: scheme
      real(wp) :: since, motion, damped
      logical :: breaks
      integer :: i, fresh

      call read_numbers(folder//'/ledger.csv', names, numbers, fault, &
                        [character(NAME_LENGTH) :: 'stage', 'time', 'dt', 'kinetic', 'damping', 'bend'])
      if (fault%code /= 0) return
      steps%stage = nint(column('stage'))
      steps%time = column('time')
      steps%dt = column('dt')
      steps%bend = column('bend')
      kinetic = column('kinetic')
      damping = column('damping')
      allocate (steps%early, steps%constant, steps%kept, mold=steps%dt)
      damped = 0.0_wp
      do i = 1, size(steps%stage)
         associate (stage => model%stages(steps%stage(i)), dt => steps%dt(i))
            if (i == 1 .or. steps%stage(max(1, i - 1)) /= steps%stage(i)) then
               since = 0.0_wp
               motion = 0.0_wp
               fresh = 0
               if (i > 1) damped = damping(i - 1)
            end if
            since = since + dt
            fresh = fresh + 1
            scheme = make_scheme(stage%kind, stage%rho_inf, dt)
            steps%early(i) = (1 - scheme%l_f)*dt
            steps%constant(i) = 0.0_wp
            steps%kept(i) = 1.0_wp
            if (stage%kind == DYNAMIC) then
               steps%constant(i) = constant_of_accelerations(scheme)
               motion = motion + dt*kinetic(i)
               steps%kept(i) = kept_of_motion(dt, damping(i) - damped, motion)
            else if (stage%kind == QUASI_STATIC .and. (model%domain%with_w .or. model%domain%with_c)) then
               if (fresh >= VALUES) steps%constant(i) = constant_of_rates(scheme)
               steps%kept(i) = (since - dt)/since
               ! What is sudden begins a flow anew: forces before it tell nothing of those after it.
               breaks = is_break(model, stage, steps%time(i), dt)
               if (breaks) since = 0.0_wp
               if (breaks) fresh = 0
            end if
         end associate
      end do
   contains
      function column(name) result(values)
         character(*), intent(in) :: name
         real(wp), allocatable :: values(:)

         values = numbers(findloc(names, name, dim=1), :)
      end function column
   end subroutine read_steps

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
            forces(i)%error = peak_difference(one(1, :), one(2, :), two(1, :), two(2, :))/forces(i)%change
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
