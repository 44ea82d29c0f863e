! SPDX-License-Identifier: MIT
!> The price of accuracy of a scene: a few cheap runs, from which error, time and memory of others follow.
!> docs/theory/host.md section 12.
module scene_price
   use, intrinsic :: iso_fortran_env, only: output_unit
   use changed_scenes, only: read_changed
   use effect_types, only: effect_t
   use faults, only: fault_t, raise, EXIT_INPUT
   use kinds, only: wp
   use pilot_runs, only: pilot_t, run_pilot
   use price_estimates, only: answer_t, quote_t, list_answers, distances, judge_meshes, quote
   use scene_refinement, only: refinement, cells_allow, elements_at
   use scene_types, only: scene_t
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: price_t, price_scene

   !> Fineness of meshes and steps in the table, times those of the scene.
   real(wp), parameter :: MESHES(5) = [0.25_wp, 0.5_wp, 1.0_wp, 2.0_wp, 4.0_wp]
   real(wp), parameter :: STEPS(5) = [4.0_wp, 2.0_wp, 1.0_wp, 0.5_wp, 0.25_wp]
   real(wp), parameter :: QUARTER = 0.25_wp, OF_A_QUARTER = 4.0_wp/3   !< Error of first order, of a pair (A, A/4).
   real(wp), parameter :: TIGHT_NEWTON = 0.01_wp
   real(wp), parameter :: MANY_CUTS = 0.1_wp       !< Of the steps: a mesh on which more are cut is in trouble.
   real(wp), parameter :: MOST_OF_STEPS = 2.0_wp, MOST_OF_MESHES = 0.5_wp   !< Exponents of iterations.

   type :: price_t
      type(answer_t), allocatable :: answers(:)
      type(quote_t), allocatable :: quotes(:)       !< Meshes slowest, accuracy fastest.
      real(wp) :: mesh = 0.0_wp                     !< The finest that was run, times the cells of the scene.
      integer :: meshes_run = 2, runs = 0
      real(wp) :: asked = 0.0_wp                    !< Accuracy of the controlled stages [-]; 0: all steps are given.
      real(wp) :: seconds = 0.0_wp                  !< Of the pilots.
      logical :: troubled = .false.                 !< Many steps were cut.
   end type price_t
contains
   !> The price of a scene. Faults: those of read_changed; EXIT_INPUT where nothing can be compared, or a pilot fails.
   subroutine price_scene(file, asked, effects, quiet, price, fault)
      character(*), intent(in) :: file
      real(wp), intent(in) :: asked   !< Accuracy of the controlled stages [-]; 0: all steps are given.
      type(effect_t), allocatable, intent(in) :: effects(:)
      logical, intent(in) :: quiet
      type(price_t), intent(out) :: price
      type(fault_t), intent(inout) :: fault
      type(pilot_t) :: coarse, middle, shorter, tighter, fine
      type(scene_t) :: base, scenes(3)
      real(wp) :: mesh(3), of_steps, of_meshes
      integer :: i, finest
      type(quote_t) :: next(1)

      price%asked = asked
      call read_changed(file, asked, 1.0_wp, 1.0_wp, effects, base, fault)
      if (fault%code /= 0) return
      if (size(base%points) == 0) then
         call raise(fault, EXIT_INPUT, file//': --price compares the histories of points on several meshes; give '// &
                    'the scene a &point.')
         return
      end if
      mesh = [0.5_wp, 1.0_wp, 2.0_wp]
      if (cells_allow(base%mesh)) mesh = 0.5_wp*mesh
      if (base%mesh%mesh_file /= '') mesh = 2*mesh
      call first_pair()
      call pilot(2, QUARTER, 1.0_wp, shorter)
      call pilot(2, 1.0_wp, TIGHT_NEWTON, tighter)
      if (fault%code /= 0) return
      price%mesh = mesh(2)
      call list_answers(middle, price%answers)
      price%answers%steps = OF_A_QUARTER*distances(price%answers, middle, shorter)
      price%answers%newton = distances(price%answers, middle, tighter)
      call judge_meshes(price%answers, coarse, middle, refinement(scenes(1)%mesh, scenes(2)%mesh))
      of_steps = exponent_of(shorter, middle, 1/QUARTER, MOST_OF_STEPS)
      of_meshes = exponent_of(middle, coarse, real(middle%elements, wp)/coarse%elements, MOST_OF_MESHES)
      ! A third mesh where it doubles the time at most: it shows the order of convergence.
      finest = 2
      next = quotes_of(mesh(3), [1.0_wp])
      if (next(1)%seconds <= price%seconds) then
         call pilot(3, 1.0_wp, 1.0_wp, fine)
         if (fault%code /= 0) return
         price%mesh = mesh(3)
         price%meshes_run = 3
         call judge_meshes(price%answers, middle, fine, refinement(scenes(2)%mesh, scenes(3)%mesh), coarse)
         of_meshes = exponent_of(fine, middle, real(fine%elements, wp)/middle%elements, MOST_OF_MESHES)
         middle = fine
         finest = 3
      end if
      allocate (price%quotes(0))
      do i = 1, size(MESHES)
         if (MESHES(i) < mesh(1)) cycle
         price%quotes = [price%quotes, quotes_of(MESHES(i), STEPS)]
      end do
   contains
      !> The two coarsest meshes that differ and on which the scene runs, none coarser than that of the scene.
      subroutine first_pair()
         do
            call pilot(1, 1.0_wp, 1.0_wp, coarse)
            call pilot(2, 1.0_wp, 1.0_wp, middle)
            if (fault%code == 0 .and. .not. refinement(scenes(1)%mesh, scenes(2)%mesh) > 1.0_wp) call raise(fault, &
               EXIT_INPUT, file//': two meshes of --price have the same cells.')
            if (fault%code == 0 .or. mesh(1) >= 1.0_wp) exit
            if (.not. quiet) write (output_unit, '(a)') '   '//trim(fault%text)//' Finer meshes are taken.'
            fault = fault_t()
            mesh = 2*mesh
         end do
      end subroutine first_pair

      !> What runs on a mesh would cost, by the finest that was made.
      function quotes_of(wanted, fineness) result(quotes)
         real(wp), intent(in) :: wanted, fineness(:)   !< Of the mesh; of the steps of each run.
         type(quote_t) :: quotes(size(fineness))
         type(scene_t) :: other
         real(wp) :: elements, finer
         integer :: k

         call read_changed(file, asked, 1.0_wp, wanted, effects, other, fault)
         elements = middle%elements*elements_at(wanted, base%mesh)/elements_at(mesh(finest), base%mesh)
         finer = refinement(scenes(finest)%mesh, other%mesh)
         do k = 1, size(fineness)
            quotes(k) = quote(price%answers, middle, wanted, elements, finer, fineness(k), of_steps, of_meshes)
         end do
      end function quotes_of

      !> One run, and a line about it.
      subroutine pilot(number, fineness, newton, run)
         integer, intent(in) :: number             !< Of the mesh.
         real(wp), intent(in) :: fineness, newton  !< Times steps and Newton's tolerance of the scene.
         type(pilot_t), intent(out) :: run

         if (fault%code /= 0) return
         associate (scene => scenes(number))
            call read_changed(file, asked, fineness, mesh(number), effects, scene, fault)
            if (fault%code /= 0) return
            scene%stages%tolerance = newton*scene%stages%tolerance
            call run_pilot(scene, huge(1.0_wp), run)
         end associate
         price%runs = price%runs + 1
         price%seconds = price%seconds + run%seconds
         price%troubled = price%troubled .or. run%cuts > MANY_CUTS*run%steps
         if (.not. run%done) then
            call raise(fault, EXIT_INPUT, file//': --price: the run on '//short(mesh(number))//' times the cells, '// &
                       short(fineness)//' times the steps and '//short(newton)//' times Newton''s tolerance fails: '// &
                       trim(run%why))
         else if (.not. quiet) then
            write (output_unit, '(a)') '   pilot '//whole(price%runs)//': '//whole(run%elements)// &
               ' elements, steps times '//short(fineness)//', Newton''s tolerance times '//short(newton)//': '// &
               whole(run%steps)//' steps, '//whole(run%iterations)//' iterations, '//whole(run%cuts)//' cuts, '// &
               short(run%seconds)//' s'
         end if
      end subroutine pilot
   end subroutine price_scene

   !> How the iterations of two runs grow with something that grew so many times; 0 to `most`. [-]
   pure real(wp) function exponent_of(dear, cheap, times, most)
      type(pilot_t), intent(in) :: dear, cheap
      real(wp), intent(in) :: times, most

      exponent_of = max(0.0_wp, min(most, log(real(dear%iterations, wp)/max(1, cheap%iterations))/log(times)))
   end function exponent_of
end module scene_price
