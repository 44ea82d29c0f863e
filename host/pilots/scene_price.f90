! SPDX-License-Identifier: MIT
!> The price of accuracy of a scene: a few cheap runs, from which error, time and memory of others follow; and meshes of
!> one family, each added to those before. docs/theory/host.md section 12.
module scene_price
   use, intrinsic :: iso_fortran_env, only: output_unit
   use changed_scenes, only: read_changed
   use effect_types, only: effect_t
   use faults, only: fault_t, raise, EXIT_INPUT
   use kinds, only: wp
   use level_runs, only: level_key_t, level_run_t, level_runner_t
   use pilot_runs, only: pilot_t, run_pilot
   use price_estimates, only: answer_t, quote_t, list_answers, distances, judge_meshes, quote
   use scene_refinement, only: refinement, cells_allow, elements_at
   use scene_types, only: scene_t, scene_mesh_t
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: family_t, price_t, price_scene, find_family, begin_price, repeat_first_meshes, add_level, quotes_of

   !> Fineness of meshes and steps in the table, times those of the scene.
   real(wp), parameter :: MESHES(5) = [0.25_wp, 0.5_wp, 1.0_wp, 2.0_wp, 4.0_wp]
   real(wp), parameter :: STEPS(5) = [4.0_wp, 2.0_wp, 1.0_wp, 0.5_wp, 0.25_wp]
   real(wp), parameter :: QUARTER = 0.25_wp, OF_A_QUARTER = 4.0_wp/3   !< Error of first order, of a pair (A, A/4).
   real(wp), parameter :: TIGHT_NEWTON = 0.01_wp
   real(wp), parameter :: MANY_CUTS = 0.1_wp       !< Of the steps: a mesh on which more are cut is in trouble.
   real(wp), parameter :: MOST_OF_STEPS = 2.0_wp, MOST_OF_MESHES = 0.5_wp   !< Exponents of iterations.
   real(wp), parameter :: UNTIL_DONE = huge(1.0_wp)

   !> A scene of which meshes are made.
   type :: family_t
      character(:), allocatable :: file
      real(wp) :: asked = 0.0_wp                    !< Accuracy of the controlled stages [-]; 0: all steps are given.
      type(effect_t), allocatable :: effects(:)     !< Not allocated: no pilots chose them.
      logical :: quiet = .false.
      type(scene_t) :: base
      real(wp) :: coarsest = 0.25_wp                !< Fineness of the first mesh; each is twice as fine as the last.
   end type family_t

   type :: price_t
      type(answer_t), allocatable :: answers(:)
      type(quote_t), allocatable :: quotes(:)       !< Meshes slowest, accuracy fastest.
      type(level_run_t), allocatable :: levels(:)   !< The meshes that were run, the finest last.
      type(scene_mesh_t), allocatable :: meshes(:)
      type(level_run_t), allocatable :: made(:)     !< All runs, pilots with them, in their order.
      integer :: runs = 0
      real(wp) :: asked = 0.0_wp                    !< Accuracy of the controlled stages [-]; 0: all steps are given.
      real(wp) :: fineness = 1.0_wp, newton = 1.0_wp   !< Times steps and Newton's tolerance of the scene, all levels.
      real(wp) :: of_steps = 0.0_wp, of_meshes = 0.0_wp   !< Exponents of iterations.
      real(wp) :: seconds = 0.0_wp                  !< Of all runs.
      logical :: troubled = .false.                 !< Many steps were cut.
   end type price_t
contains
   !> The price of a scene. Faults: those of find_family and begin_price.
   subroutine price_scene(file, asked, effects, quiet, price, fault)
      character(*), intent(in) :: file
      real(wp), intent(in) :: asked   !< Accuracy of the controlled stages [-]; 0: all steps are given.
      type(effect_t), allocatable, intent(in) :: effects(:)
      logical, intent(in) :: quiet
      type(price_t), intent(out) :: price
      type(fault_t), intent(inout) :: fault
      type(family_t) :: family
      type(quote_t) :: next(1)
      real(wp) :: third
      integer :: i

      call find_family(file, asked, effects, quiet, family, fault)
      if (fault%code == 0) call begin_price(family, price, fault)
      if (fault%code /= 0) return
      ! A third mesh where it doubles the time at most: it shows the order of convergence.
      third = 2*price%levels(2)%mesh
      next = quotes_of(family, price, third, [1.0_wp], fault)
      if (fault%code == 0 .and. next(1)%seconds <= price%seconds) call add_level(family, third, UNTIL_DONE, price, &
                                                                                 fault)
      if (fault%code /= 0) return
      allocate (price%quotes(0))
      do i = 1, size(MESHES)
         if (MESHES(i) < price%levels(1)%mesh) cycle
         price%quotes = [price%quotes, quotes_of(family, price, MESHES(i), STEPS, fault)]
      end do
   end subroutine price_scene

   !> Reads a scene whose meshes are to be compared. Faults: those of read_changed; EXIT_INPUT where nothing can be
   !> compared.
   subroutine find_family(file, asked, effects, quiet, family, fault)
      character(*), intent(in) :: file
      real(wp), intent(in) :: asked   !< Accuracy of the controlled stages [-]; 0: all steps are given.
      type(effect_t), allocatable, intent(in) :: effects(:)
      logical, intent(in) :: quiet
      type(family_t), intent(out) :: family
      type(fault_t), intent(inout) :: fault
      integer :: thrust

      family%file = file
      family%asked = asked
      if (allocated(effects)) family%effects = effects
      family%quiet = quiet
      call read_changed(file, asked, 1.0_wp, 1.0_wp, family%effects, family%base, fault)
      if (fault%code /= 0) return
      if (size(family%base%points) == 0) then
         call raise(fault, EXIT_INPUT, file//': the histories of points are compared on several meshes; give '// &
                    'the scene a &point.')
         return
      end if
      thrust = findloc(index(family%base%goals, '.thrust') > 0, .true., dim=1)
      if (thrust > 0) then
         call raise(fault, EXIT_INPUT, file//': goals: '''//trim(family%base%goals(thrust))//''': meshes are not '// &
                    'compared by the peaks of a thrust; name displacements or pressures of points, or forces of '// &
                    'supports, as ''top.u_z'' or ''bottom.force_z''.')
         return
      end if
      family%coarsest = 0.5_wp
      if (cells_allow(family%base%mesh)) family%coarsest = 0.25_wp
      if (family%base%mesh%mesh_file /= '') family%coarsest = 1.0_wp
   end subroutine find_family

   !> Two meshes, and on the second shorter steps and a tighter Newton's method: the errors of all answers. Faults:
   !> those of read_changed and of the runs; EXIT_INPUT where meshes have the same cells, or a goal is no answer.
   subroutine begin_price(family, price, fault, runner)
      type(family_t), intent(inout) :: family
      type(price_t), intent(inout) :: price   !< New, or with runs that were made.
      type(fault_t), intent(inout) :: fault
      class(level_runner_t), intent(inout), optional :: runner   !< On meshes; none: without files and words.
      type(pilot_t) :: shorter, tighter

      price%asked = family%asked
      if (.not. allocated(price%made)) allocate (price%made(0))
      call first_pair()
      if (fault%code /= 0) return
      associate (mesh => price%levels(2)%mesh, middle => price%levels(2)%pilot)
         call run_pilot_of(level_key_t(mesh, QUARTER, 1.0_wp), shorter)
         if (fault%code == 0) call run_pilot_of(level_key_t(mesh, 1.0_wp, TIGHT_NEWTON), tighter)
         if (fault%code /= 0) return
         call list_answers(middle, price%answers, family%base%goals)
         price%answers%steps = OF_A_QUARTER*distances(price%answers, middle, shorter)
         price%answers%newton = distances(price%answers, middle, tighter)
         price%of_steps = exponent_of(shorter, middle, 1/QUARTER, MOST_OF_STEPS)
      end associate
      call check_goals_are_answers(family, price, fault)
      if (fault%code == 0) call judge_last(price)
   contains
      !> The two coarsest meshes that differ and on which the scene runs, none coarser than that of the scene.
      subroutine first_pair()
         do
            call repeat_first_meshes(family, price, fault, runner)
            if (fault%code == 0 .or. family%coarsest >= 1.0_wp) exit
            if (.not. family%quiet) write (output_unit, '(a)') '   '//trim(fault%text)//' Finer meshes are taken.'
            fault = fault_t()
            family%coarsest = 2*family%coarsest
         end do
      end subroutine first_pair

      subroutine run_pilot_of(key, pilot)
         type(level_key_t), intent(in) :: key
         type(pilot_t), intent(out) :: pilot
         type(scene_t) :: scene

         call read_level(family, key, scene, fault)
         if (fault%code == 0) call one_run(family, key, scene, UNTIL_DONE, price, pilot, fault)
      end subroutine run_pilot_of
   end subroutine begin_price

   !> The first two meshes anew, with the steps and Newton's tolerance that the price names. Faults: those of add_level.
   subroutine repeat_first_meshes(family, price, fault, runner)
      type(family_t), intent(in) :: family
      type(price_t), intent(inout) :: price
      type(fault_t), intent(inout) :: fault
      class(level_runner_t), intent(inout), optional :: runner

      if (allocated(price%levels)) deallocate (price%levels, price%meshes)
      allocate (price%levels(0), price%meshes(0))
      call add_level(family, family%coarsest, UNTIL_DONE, price, fault, runner)
      if (fault%code == 0) call add_level(family, 2*family%coarsest, UNTIL_DONE, price, fault, runner)
   end subroutine repeat_first_meshes

   !> A run on the next mesh, and the errors of the answers, where they are listed, by all meshes. Faults: those of
   !> read_changed and of the run, which then is none of the levels; EXIT_INPUT: it has the same cells.
   subroutine add_level(family, mesh, most_seconds, price, fault, runner)
      type(family_t), intent(in) :: family
      real(wp), intent(in) :: mesh           !< Fineness.
      real(wp), intent(in) :: most_seconds   !< Wall time that it may take [s].
      type(price_t), intent(inout) :: price
      type(fault_t), intent(inout) :: fault
      class(level_runner_t), intent(inout), optional :: runner
      type(level_run_t) :: level
      type(scene_t) :: scene
      integer :: n

      n = size(price%levels)
      level%level_key_t = level_key_t(mesh, price%fineness, price%newton, n + 1)
      call read_level(family, level%level_key_t, scene, fault)
      if (fault%code /= 0) return
      if (n > 0) then
         if (.not. refinement(price%meshes(n), scene%mesh) > 1.0_wp) call raise(fault, EXIT_INPUT, family%file// &
            ': two meshes have the same cells.')
      end if
      call one_run(family, level%level_key_t, scene, most_seconds, price, level%pilot, fault, runner)
      if (fault%code /= 0) return
      price%levels = [price%levels, level]
      price%meshes = [price%meshes, scene%mesh]
      if (n == 0) return
      price%of_meshes = exponent_of(level%pilot, price%levels(n)%pilot, &
         real(level%pilot%elements, wp)/price%levels(n)%pilot%elements, MOST_OF_MESHES)
      if (allocated(price%answers)) call judge_last(price)
   end subroutine add_level

   !> Errors of the meshes by the last two of them, or three.
   subroutine judge_last(price)
      type(price_t), intent(inout) :: price
      integer :: n
      real(wp) :: r

      n = size(price%levels)
      r = refinement(price%meshes(n - 1), price%meshes(n))
      associate (levels => price%levels)
         if (n == 2) then
            call judge_meshes(price%answers, levels(1)%pilot, levels(2)%pilot, r)
         else
            call judge_meshes(price%answers, levels(n - 1)%pilot, levels(n)%pilot, r, levels(n - 2)%pilot, &
                              refinement(price%meshes(n - 2), price%meshes(n - 1)))
         end if
      end associate
   end subroutine judge_last

   !> Fault EXIT_INPUT: a goal is none of the answers that meshes are compared by, or there is no goal.
   subroutine check_goals_are_answers(family, price, fault)
      type(family_t), intent(in) :: family
      type(price_t), intent(in) :: price
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: there
      integer :: i

      there = ''
      do i = 1, size(price%answers)
         there = there//' '//trim(price%answers(i)%name)
      end do
      do i = 1, size(family%base%goals)
         if (.not. any(price%answers%name == family%base%goals(i))) call raise(fault, EXIT_INPUT, family%file// &
            ': goals: '''//trim(family%base%goals(i))//''' is prescribed, does not change, or is no answer that '// &
            'meshes are compared by; those are:'//there//'.')
      end do
      if (fault%code == 0 .and. .not. any(price%answers%goal)) call raise(fault, EXIT_INPUT, family%file// &
         ': no displacement and no pressure of a point changes; name answers by the key goals of '// &
         '&scene. There are:'//there//'.')
   end subroutine check_goals_are_answers

   !> What runs on a mesh would cost, by the finest that was made, with steps that are so many times as fine.
   function quotes_of(family, price, wanted, fineness, fault) result(quotes)
      type(family_t), intent(in) :: family
      type(price_t), intent(in) :: price
      real(wp), intent(in) :: wanted, fineness(:)   !< Of the mesh; of the steps of each run.
      type(fault_t), intent(inout) :: fault
      type(quote_t) :: quotes(size(fineness))
      type(scene_t) :: other
      real(wp) :: elements, finer
      integer :: k, n

      n = size(price%levels)
      call read_changed(family%file, family%asked, 1.0_wp, wanted, family%effects, other, fault)
      if (fault%code /= 0) return
      associate (finest => price%levels(n)%pilot, mesh => family%base%mesh)
         elements = finest%elements*elements_at(wanted, mesh)/elements_at(price%levels(n)%mesh, mesh)
         finer = refinement(price%meshes(n), other%mesh)
         do k = 1, size(fineness)
            quotes(k) = quote(price%answers, finest, wanted, elements, finer, fineness(k), price%of_steps, &
                              price%of_meshes)
         end do
      end associate
   end function quotes_of

   !> The scene of a run. Faults: those of read_changed.
   subroutine read_level(family, key, scene, fault)
      type(family_t), intent(in) :: family
      type(level_key_t), intent(in) :: key
      type(scene_t), intent(out) :: scene
      type(fault_t), intent(inout) :: fault

      call read_changed(family%file, family%asked, key%fineness, key%mesh, family%effects, scene, fault)
      if (fault%code == 0) scene%stages%tolerance = key%newton*scene%stages%tolerance
   end subroutine read_level

   !> One run, unless it was made, and a line about it. Fault of the run.
   subroutine one_run(family, wanted, scene, most_seconds, price, pilot, fault, runner)
      type(family_t), intent(in) :: family
      type(level_key_t), intent(in) :: wanted
      type(scene_t), intent(in) :: scene        !< Of this run.
      real(wp), intent(in) :: most_seconds      !< [s]
      type(price_t), intent(inout) :: price
      type(pilot_t), intent(out) :: pilot
      type(fault_t), intent(inout) :: fault
      class(level_runner_t), intent(inout), optional :: runner
      integer :: i

      if (fault%code /= 0) return
      do i = 1, size(price%made)
         if (is_same(price%made(i)%level_key_t, wanted)) exit
      end do
      if (i <= size(price%made)) then
         pilot = price%made(i)%pilot
      else
         if (present(runner)) then
            call runner%run(scene, wanted%level, most_seconds, pilot)
         else
            call run_pilot(scene, UNTIL_DONE, pilot, most_seconds)
         end if
         price%seconds = price%seconds + pilot%seconds
      end if
      price%runs = price%runs + 1
      price%troubled = price%troubled .or. pilot%cuts > MANY_CUTS*pilot%steps
      if (.not. pilot%done) then
         call raise(fault, pilot%code, family%file//': the run on '//short(wanted%mesh)//' times the cells, '// &
                    short(wanted%fineness)//' times the steps and '//short(wanted%newton)// &
                    ' times Newton''s tolerance fails: '//trim(pilot%why))
         return
      end if
      if (.not. family%quiet) write (output_unit, '(a)') '   run '//whole(price%runs)//': '//whole(pilot%elements)// &
         ' elements, steps times '//short(wanted%fineness)//', Newton''s tolerance times '//short(wanted%newton)// &
         ': '//whole(pilot%steps)//' steps, '//whole(pilot%iterations)//' iterations, '//whole(pilot%cuts)// &
         ' cuts, '//short(pilot%seconds)//' s'
      if (i <= size(price%made)) return
      call keep_run(wanted, pilot, price%made)
   end subroutine one_run

   !> Adds a run to the list of those that were made.
   pure subroutine keep_run(key, pilot, made)
      type(level_key_t), intent(in) :: key
      type(pilot_t), intent(in) :: pilot
      type(level_run_t), allocatable, intent(inout) :: made(:)
      type(level_run_t), allocatable :: longer(:)
      integer :: n

      n = size(made)
      allocate (longer(n + 1))
      longer(:n) = made
      longer(n + 1)%level_key_t = key
      longer(n + 1)%pilot = pilot
      call move_alloc(longer, made)
   end subroutine keep_run

   !> Whether two runs change the same.
   pure logical function is_same(one, two)
      type(level_key_t), intent(in) :: one, two

      is_same = one%level == two%level .and. &
                maxval(abs([one%mesh - two%mesh, one%fineness - two%fineness, one%newton - two%newton])) <= 0.0_wp
   end function is_same

   !> How the iterations of two runs grow with something that grew so many times; 0 to `most`. [-]
   pure real(wp) function exponent_of(dear, cheap, times, most)
      type(pilot_t), intent(in) :: dear, cheap
      real(wp), intent(in) :: times, most

      exponent_of = max(0.0_wp, min(most, log(real(dear%iterations, wp)/max(1, cheap%iterations))/log(times)))
   end function exponent_of
end module scene_price
