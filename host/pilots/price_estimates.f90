! SPDX-License-Identifier: MIT
!> What accuracy costs: the errors of mesh, steps and Newton's method of every answer from a few runs, and from them the
!> error, time and memory of runs that were not made. docs/theory/host.md section 12.
module price_estimates
   use kinds, only: wp
   use history_distance, only: farthest
   use linear_system, only: T_CONTACT, T_FACTORISATION, T_SOLUTION
   use pilot_runs, only: pilot_t, PHASES
   use scene_goals, only: is_goal
   use unknown_fields, only: FIELDS, FIELD_NAMES, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: answer_t, quote_t, list_answers, distances, mesh_error, judge_meshes, observed_order, correlation, &
             quote, total_error, bound_of, is_certain, worst_answer
   public :: ASSUMED, CERTAIN, UNCERTAIN, NOT_CONVERGING, MASKED, STATE_WORDS

   real(wp), parameter :: NO_ANSWER = 0.02_wp        !< A smaller range, as a share of its kind's largest, is no answer.
   real(wp), parameter :: USUAL_ORDER = 1.5_wp       !< Of convergence in the size of cells: of two meshes.
   real(wp), parameter :: LEAST_ORDER = 1.0_wp, MOST_ORDER = 2.0_wp   !< Of three meshes.
   real(wp), parameter :: MOST_SEEN = 8.0_wp         !< No order is looked for beyond.
   integer, parameter :: HALVINGS = 50               !< Of the span in which an order is looked for: to rounding.
   real(wp), parameter :: WEAK_ORDER = 0.5_wp, NO_ORDER = 0.2_wp      !< Below: uncertain; does not converge.
   real(wp), parameter :: LIKE = 0.5_wp              !< Least correlation of two differences of one shape.
   real(wp), parameter :: LARGE = 0.02_wp            !< A difference that does not fall counts from here on.
   real(wp), parameter :: HIDDEN = 2.0_wp            !< A difference below so many errors of steps says nothing.

   !> How far the error of the mesh is known.
   integer, parameter :: ASSUMED = 1, CERTAIN = 2, UNCERTAIN = 3, NOT_CONVERGING = 4, MASKED = 5
   character(17), parameter :: STATE_WORDS(5) = [character(17) :: 'assumed', 'ok', 'uncertain', 'does not converge', &
                                                 'masked']

   !> An answer of a scene: its errors as shares of its range. Of the mesh: on the finest one that was run; of the steps
   !> and of Newton's method: as the scene asks for them.
   type :: answer_t
      character(72) :: name = ''
      integer :: point = 0, field = 0, force = 0   !< Places in the pilot.
      real(wp) :: range = 0.0_wp                   !< Largest change on the finest mesh [m, kPa, kN].
      real(wp) :: mesh = 0.0_wp, steps = 0.0_wp, newton = 0.0_wp   !< [-]
      real(wp) :: order = USUAL_ORDER              !< Of convergence [-].
      real(wp) :: apart = 0.0_wp                   !< Largest distance of two of the meshes that were compared [-].
      logical :: goal = .true.                     !< It must reach the accuracy.
      integer :: state = ASSUMED
   end type answer_t

   !> A run that could be made.
   type :: quote_t
      real(wp) :: mesh = 1.0_wp                    !< Times the cells of the scene along each axis.
      real(wp) :: fineness = 1.0_wp                !< Times the accuracy that the scene asks for, or its steps.
      real(wp) :: elements = 0.0_wp
      real(wp) :: error = 0.0_wp, error_of_mesh = 0.0_wp, error_of_steps = 0.0_wp, error_of_newton = 0.0_wp   !< [-]
      integer :: answer = 0                        !< The answer with the largest error.
      real(wp) :: seconds = 0.0_wp, megabytes = 0.0_wp
   end type quote_t
contains
   !> The answers of a run: displacements and pressures of its points, forces of moving supports, without what is
   !> prescribed or hardly changes beside others of its kind. Goals are those that are named, hardly changing ones with
   !> them; where none is named displacements and pressures.
   subroutine list_answers(pilot, answers, goals)
      type(pilot_t), intent(in) :: pilot
      type(answer_t), allocatable, intent(out) :: answers(:)
      character(*), intent(in) :: goals(:)   !< Names; none: the usual ones.
      real(wp) :: range(FIELDS, size(pilot%names)), force_range(size(pilot%supports)), largest
      integer :: i, f

      allocate (answers(0))
      range = maxval(pilot%x, dim=3) - minval(pilot%x, dim=3)
      do f = 1, FIELDS
         if (.not. pilot%has(f)) range(f, :) = 0.0_wp
      end do
      do i = 1, size(pilot%names)
         do f = 1, FIELDS
            largest = maxval(range(DISPLACEMENTS + 1:, :))
            if (f <= DISPLACEMENTS) largest = maxval(range(:DISPLACEMENTS, :))
            call add(answer_t(trim(pilot%names(i))//'.'//trim(FIELD_NAMES(f)), i, f, 0, range(f, i)), &
                     pilot%prescribed(f, i), largest)
         end do
      end do
      force_range = maxval(pilot%force, dim=2) - minval(pilot%force, dim=2)
      do i = 1, size(pilot%supports)
         call add(answer_t(pilot%supports(i), 0, 0, i, force_range(i)), .false., maxval(force_range))
      end do
   contains
      subroutine add(answer, prescribed, largest)
         type(answer_t), intent(in) :: answer
         logical, intent(in) :: prescribed
         real(wp), intent(in) :: largest   !< Change of its kind.
         type(answer_t) :: one

         if (prescribed .or. .not. answer%range > 0.0_wp) return
         one = answer
         one%goal = is_goal(goals, answer%name, answer%force > 0)
         if (answer%range <= NO_ANSWER*largest .and. .not. (one%goal .and. size(goals) > 0)) return
         answers = [answers, one]
      end subroutine add
   end subroutine list_answers

   !> History of an answer: forces less their first value, so that weight hides no error.
   pure subroutine history_of(answer, pilot, time, values)
      type(answer_t), intent(in) :: answer
      type(pilot_t), intent(in) :: pilot
      real(wp), allocatable, intent(out) :: time(:), values(:)   !< [s], [m, kPa, kN]

      if (answer%force > 0) then
         time = pilot%force_time(2:)
         values = pilot%force(answer%force, 2:) - pilot%force(answer%force, 2)
      else
         time = pilot%time
         values = pilot%x(answer%field, answer%point, :)
      end if
   end subroutine history_of

   !> How far two runs lie apart, as shares of each answer's range; but not within the first step of a stage, where a
   !> load may act at once. [-] (answers)
   pure function distances(answers, one, two) result(apart)
      type(answer_t), intent(in) :: answers(:)
      type(pilot_t), intent(in) :: one, two
      real(wp) :: apart(size(answers))
      real(wp), allocatable :: time(:), values(:), other_time(:), other_values(:)
      integer :: i

      do i = 1, size(answers)
         call history_of(answers(i), one, time, values)
         call history_of(answers(i), two, other_time, other_values)
         associate (counts => counted(time, one, two))
            apart(i) = abs(farthest(pack(time, counts), pack(values, counts), other_time, other_values))/ &
                       answers(i)%range
         end associate
      end do
   end function distances

   !> Times beyond the first step of their stage in both runs.
   pure function counted(time, one, two) result(counts)
      real(wp), intent(in) :: time(:)
      type(pilot_t), intent(in) :: one, two
      logical :: counts(size(time))
      real(wp) :: start, first
      integer :: s

      counts = .true.
      start = one%time(1)
      do s = 1, size(one%ends)
         if (size(one%ends(s)%times) == 0 .or. size(two%ends(s)%times) == 0) cycle
         ! A stage of one step has nothing but its end.
         if (min(size(one%ends(s)%times), size(two%ends(s)%times)) > 1) then
            first = start + max(one%ends(s)%times(1), two%ends(s)%times(1))
            where (time > start .and. time < first*(1 - epsilon(first))) counts = .false.
         end if
         start = start + one%ends(s)%times(size(one%ends(s)%times))
      end do
   end function counted

   !> Error of the finer of two meshes from their distance: that of an order of convergence, the finer one `r` times as
   !> fine. [-]
   elemental real(wp) function mesh_error(distance, r, order)
      real(wp), intent(in) :: distance, r   !< [-], > 1
      real(wp), intent(in) :: order

      mesh_error = distance/(r**order - 1)
   end function mesh_error

   !> Order of convergence p from the distances of a coarse and a middle, and of the middle and a fine mesh: errors that
   !> fall with a power of the size of cells have coarse/fine = r_fine**p (r_coarse**p - 1)/(r_fine**p - 1), which grows
   !> with p. Within +-MOST_SEEN. [-] docs/theory/host.md section 12.
   elemental real(wp) function observed_order(coarse, fine, r_coarse, r_fine) result(order)
      real(wp), intent(in) :: coarse, fine   !< Distances [-].
      real(wp), intent(in) :: r_coarse       !< Of the middle mesh to the coarse one, > 1.
      real(wp), intent(in) :: r_fine         !< Of the fine mesh to the middle one, > 1.
      real(wp) :: low, high
      integer :: i

      low = -MOST_SEEN
      high = MOST_SEEN
      do i = 1, HALVINGS
         order = 0.5_wp*(low + high)
         if (coarse > fine*ratio_at(order)) then
            low = order
         else
            high = order
         end if
      end do
   contains
      elemental real(wp) function ratio_at(p)
         real(wp), intent(in) :: p   !< [-]

         ! By hyperbolic sines, which keep their digits where p vanishes.
         ratio_at = log(r_coarse)/log(r_fine)
         if (abs(p) > 0.0_wp) ratio_at = (r_coarse*r_fine)**(0.5_wp*p)*sinh(0.5_wp*p*log(r_coarse))/ &
                                         sinh(0.5_wp*p*log(r_fine))
      end function ratio_at
   end function observed_order

   !> Correlation over time of the differences of three runs: do they have one shape? [-1, 1]
   pure real(wp) function correlation(answer, coarse, middle, fine)
      type(answer_t), intent(in) :: answer
      type(pilot_t), intent(in) :: coarse, middle, fine
      real(wp), allocatable :: time(:), values(:), t(:), v(:), one(:), two(:)
      integer :: i

      call history_of(answer, middle, time, values)
      allocate (one(size(time)), two(size(time)))
      call history_of(answer, coarse, t, v)
      do i = 1, size(time)
         one(i) = farthest(time(i:i), values(i:i), t, v)
      end do
      call history_of(answer, fine, t, v)
      do i = 1, size(time)
         two(i) = -farthest(time(i:i), values(i:i), t, v)
      end do
      correlation = dot_product(one, two)/max(norm2(one)*norm2(two), tiny(1.0_wp))
   end function correlation

   !> Mesh error, order and state of each answer from two meshes, or three where the coarsest is given.
   subroutine judge_meshes(answers, middle, fine, r, coarse, r_coarse)
      type(answer_t), intent(inout) :: answers(:)
      type(pilot_t), intent(in) :: middle, fine
      real(wp), intent(in) :: r                        !< Of the fine mesh to the middle one, > 1.
      type(pilot_t), intent(in), optional :: coarse
      real(wp), intent(in), optional :: r_coarse       !< Of the middle mesh to the coarse one, > 1; with coarse.
      real(wp) :: last(size(answers)), before(size(answers)), order
      integer :: i

      last = distances(answers, middle, fine)
      before = 0.0_wp
      if (present(coarse)) before = distances(answers, coarse, middle)
      do i = 1, size(answers)
         associate (a => answers(i))
            a%state = ASSUMED
            a%order = USUAL_ORDER
            if (present(coarse)) then
               order = observed_order(before(i), last(i), r_coarse, r)
               a%order = max(LEAST_ORDER, min(MOST_ORDER, order))
               a%state = CERTAIN
               if (order < WEAK_ORDER) a%state = UNCERTAIN
               if (correlation(a, coarse, middle, fine) < LIKE) a%state = UNCERTAIN
               if (order < NO_ORDER .and. last(i) > LARGE) a%state = NOT_CONVERGING
            end if
            a%mesh = mesh_error(last(i), r, a%order)
            a%apart = max(last(i), before(i))
            if (last(i) < HIDDEN*(a%steps + a%newton)) a%state = MASKED
         end associate
      end do
   end subroutine judge_meshes

   !> A run of another mesh and accuracy: its error by that of the finest mesh that was run, its time and memory by
   !> phases. docs/theory/host.md section 12.
   pure function quote(answers, pilot, mesh, elements, finer, fineness, of_steps, of_meshes) result(q)
      type(answer_t), intent(in) :: answers(:)
      type(pilot_t), intent(in) :: pilot               !< On the finest mesh, with the accuracy of the scene.
      real(wp), intent(in) :: mesh, elements, fineness   !< See quote_t.
      real(wp), intent(in) :: finer                    !< Cells along an axis over those of the pilot [-].
      real(wp), intent(in) :: of_steps                 !< Iterations go with the accuracy to minus this [-].
      real(wp), intent(in) :: of_meshes                !< Iterations go with the elements to this [-].
      type(quote_t) :: q
      real(wp) :: exponents(PHASES), times, calls, total
      integer :: i

      exponents = 1.0_wp
      exponents(T_FACTORISATION) = 1.4_wp
      exponents(T_SOLUTION) = 1.15_wp
      exponents(T_CONTACT) = 0.5_wp
      times = elements/pilot%elements
      calls = fineness**(-of_steps)*times**of_meshes
      q%mesh = mesh
      q%fineness = fineness
      q%elements = elements
      q%seconds = sum(pilot%phases*times**exponents)*calls
      q%megabytes = pilot%megabytes(1)*times + pilot%megabytes(2)*times**exponents(T_SOLUTION)
      q%error = -1.0_wp
      do i = 1, size(answers)
         total = total_error(answers(i), finer, fineness)
         if (total <= q%error .or. .not. answers(i)%goal) cycle
         q%error = total
         q%error_of_mesh = answers(i)%mesh/finer**answers(i)%order
         q%error_of_steps = answers(i)%steps*fineness
         q%error_of_newton = answers(i)%newton
         q%answer = i
      end do
   end function quote

   !> What the total error on the finest mesh is held to be: where the order of convergence is not seen, with the
   !> largest distance of the meshes in place of the estimate. [-]
   elemental real(wp) function bound_of(answer)
      type(answer_t), intent(in) :: answer

      bound_of = total_error(answer, 1.0_wp, 1.0_wp)
      if (answer%state == UNCERTAIN) bound_of = max(answer%mesh, answer%apart) + answer%steps + answer%newton
   end function bound_of

   !> Whether three meshes have shown the error, or a bound of it.
   elemental logical function is_certain(answer)
      type(answer_t), intent(in) :: answer

      is_certain = answer%state == CERTAIN .or. answer%state == UNCERTAIN .or. answer%state == MASKED
   end function is_certain

   !> Place of the goal with the largest bound, first of those that no three meshes show; 0: there is no goal.
   pure integer function worst_answer(answers) result(worst)
      type(answer_t), intent(in) :: answers(:)
      integer :: i

      worst = 0
      do i = 1, size(answers)
         if (.not. answers(i)%goal) cycle
         if (worst > 0) then
            if (is_certain(answers(i)) .and. .not. is_certain(answers(worst))) cycle
            if ((is_certain(answers(i)) .eqv. is_certain(answers(worst))) .and. &
                bound_of(answers(i)) <= bound_of(answers(worst))) cycle
         end if
         worst = i
      end do
   end function worst_answer

   !> Sum of the errors of an answer on a mesh `finer` times as fine as that of its estimate. [-]
   elemental real(wp) function total_error(answer, finer, fineness)
      type(answer_t), intent(in) :: answer
      real(wp), intent(in) :: finer, fineness

      total_error = answer%mesh/finer**answer%order + answer%steps*fineness + answer%newton
   end function total_error
end module price_estimates
