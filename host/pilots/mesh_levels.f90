! SPDX-License-Identifier: MIT
!> A scene on finer and finer meshes until the total error of its goals is below the accuracy that is asked for.
!> docs/theory/host.md section 12.
module mesh_levels
   use, intrinsic :: iso_fortran_env, only: output_unit
   use error_words, only: percent, rounded
   use exit_codes, only: EXIT_ACCURACY
   use faults, only: fault_t, raise
   use kinds, only: wp
   use level_runs, only: level_runner_t
   use price_estimates, only: quote_t, is_certain, bound_of, worst_answer, STATE_WORDS, &
                              NOT_CONVERGING
   use scene_price, only: family_t, price_t, begin_price, repeat_first_meshes, add_level, quotes_of
   use scene_refinement, only: finest_of
   use texts, only: short, whole
   use wall_clock, only: clock
   implicit none (type, external)
   private
   public :: level_reporter_t, refine_until, words_of_error

   real(wp), parameter :: OF_STEPS = 1.0_wp/3, OF_NEWTON = 0.1_wp   !< Shares of the accuracy that they may take.
   real(wp), parameter :: SHORTER = 0.25_wp, TIGHTER = 0.01_wp
   integer, parameter :: MOST_SHORTENINGS = 2
   real(wp), parameter :: MOST_QUOTES = 3.0_wp   !< With a budget a run is ended after so many times its quote.
   integer, parameter :: MOST_AHEAD = 6          !< Meshes that a forecast counts.

   !> Makes the runs, and is told what is known after each.
   type, abstract, extends(level_runner_t) :: level_reporter_t
   contains
      procedure(judged_i), deferred :: judged
   end type level_reporter_t

   abstract interface
      !> After a run: all runs that were made, and the errors of the answers on the finest mesh.
      subroutine judged_i(self, price, fault)
         import :: level_reporter_t, price_t, fault_t
         class(level_reporter_t), intent(inout) :: self
         type(price_t), intent(in) :: price   !< Its answers are not allocated before the second mesh.
         type(fault_t), intent(inout) :: fault
      end subroutine judged_i
   end interface
contains
   !> Meshes until every goal has a total error of at most `wanted`. Faults: those of begin_price and of the reporter;
   !> EXIT_ACCURACY where it is not reached: what stands in the way, and what was reached.
   subroutine refine_until(family, wanted, budget, runner, price, fault)
      type(family_t), intent(inout) :: family
      real(wp), intent(in) :: wanted   !< Total error [-].
      real(wp), intent(in) :: budget   !< Wall time [s].
      class(level_reporter_t), intent(inout) :: runner
      type(price_t), intent(inout) :: price   !< New, or with runs that were made.
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: failed
      type(quote_t) :: next(1)
      character(:), allocatable :: obstacle
      real(wp) :: began, finer, most
      integer :: stuck, before

      began = clock()
      call begin_price(family, price, fault, runner)
      if (fault%code == 0) call share_out()
      if (fault%code == 0) call runner%judged(price, fault)
      stuck = 0
      before = 0
      obstacle = ''
      do while (fault%code == 0)
         if (is_reached(price, wanted)) exit
         associate (worst => worst_answer(price%answers))
            if (price%answers(worst)%state == NOT_CONVERGING .and. worst == before) stuck = stuck + 1
            before = worst
            if (stuck > 1) obstacle = trim(price%answers(worst)%name)//' does not converge with the mesh, as an '// &
               'answer where the solution is singular; name other goals by the key goals of &scene.'
         end associate
         finer = 2*price%levels(size(price%levels))%mesh
         if (obstacle == '' .and. finer > finest_of(family%base%mesh)) obstacle = 'No finer mesh can be made.'
         if (obstacle /= '') exit
         next = quotes_of(family, price, finer, [1.0_wp], fault)
         if (fault%code /= 0) exit
         most = huge(1.0_wp)
         if (budget < huge(1.0_wp)) then
            most = MOST_QUOTES*next(1)%seconds
            if (next(1)%seconds > budget - (clock() - began)) then
               obstacle = 'The next mesh, of '//whole(nint(next(1)%elements))//' elements, would take about '// &
                          rounded(next(1)%seconds)//' s (error '//percent(next(1)%error)//'); the budget leaves '// &
                          rounded(max(0.0_wp, budget - (clock() - began)))//' s. It is not begun.'
               exit
            end if
         end if
         if (.not. family%quiet) write (output_unit, '(a)') forecast(family, price, next(1), wanted)
         failed = fault_t()
         call add_level(family, finer, most, price, failed, runner)
         if (failed%code /= 0) then
            obstacle = trim(failed%text)
            exit
         end if
         call runner%judged(price, fault)
      end do
      if (fault%code /= 0) return
      if (obstacle /= '') then
         call raise(fault, EXIT_ACCURACY, 'The accuracy is not reached: '//words_of_error(price)//', '// &
                    percent(wanted)//' was asked for. '//obstacle)
      else if (.not. family%quiet) then
         write (output_unit, '(a)') 'The accuracy is reached: '//words_of_error(price)//', '//percent(wanted)// &
            ' was asked for.'
      end if
   contains
      !> Shorter steps, and a tighter Newton's method, where they would take too much of the accuracy.
      subroutine share_out()
         real(wp) :: steps, newton
         integer :: k

         steps = maxval(price%answers%steps, mask=price%answers%goal)
         newton = maxval(price%answers%newton, mask=price%answers%goal)
         do k = 1, MOST_SHORTENINGS
            if (price%fineness*steps > OF_STEPS*wanted) price%fineness = SHORTER*price%fineness
         end do
         if (newton > OF_NEWTON*wanted) price%newton = TIGHTER
         if (.not. (price%fineness < 1.0_wp .or. price%newton < 1.0_wp)) return
         if (.not. family%quiet) write (output_unit, '(a)') '   Steps err by '//percent(steps)// &
            ', Newton''s method by '//percent(newton)//': meshes are run with '// &
            short(price%fineness)//' times the steps and '//short(price%newton)//' times the tolerance.'
         price%answers%steps = price%fineness*price%answers%steps
         price%answers%newton = price%newton*price%answers%newton
         call repeat_first_meshes(family, price, fault, runner)
      end subroutine share_out
   end subroutine refine_until

   !> Whether every goal is within the accuracy, by at least three meshes: two that agree may do so by chance.
   pure logical function is_reached(price, wanted)
      type(price_t), intent(in) :: price
      real(wp), intent(in) :: wanted

      associate (answers => price%answers)
         is_reached = size(price%levels) > 2 .and. all(.not. answers%goal .or. (is_certain(answers) .and. &
                                                                                bound_of(answers) <= wanted))
      end associate
   end function is_reached

   !> The next mesh, and what is left after it.
   function forecast(family, price, next, wanted) result(text)
      type(family_t), intent(in) :: family
      type(price_t), intent(in) :: price
      type(quote_t), intent(in) :: next
      real(wp), intent(in) :: wanted
      character(:), allocatable :: text
      type(quote_t) :: further(1)
      type(fault_t) :: fault
      real(wp) :: seconds, mesh
      integer :: k

      text = 'Mesh '//whole(size(price%levels) + 1)//': '//whole(nint(next%elements))//' elements, about '// &
             rounded(next%seconds)//' s, '//rounded(next%megabytes)//' MB, error '// &
             percent(next%error)//' expected'
      if (next%error <= wanted) then
         text = text//'.'
         return
      end if
      seconds = next%seconds
      mesh = next%mesh
      do k = 1, MOST_AHEAD
         mesh = 2*mesh
         if (mesh > finest_of(family%base%mesh)) exit
         further = quotes_of(family, price, mesh, [1.0_wp], fault)
         if (fault%code /= 0) exit
         seconds = seconds + further(1)%seconds
         if (further(1)%error > wanted) cycle
         text = text//'; '//percent(wanted)//' is expected '//whole(k)//' meshes later, in all in about '// &
                rounded(seconds)//' s.'
         return
      end do
      text = text//'; '//percent(wanted)//' is not in sight.'
   end function forecast

   !> The worst goal: total error and its parts.
   function words_of_error(price) result(text)
      type(price_t), intent(in) :: price
      character(:), allocatable :: text

      associate (a => price%answers(worst_answer(price%answers)), n => size(price%levels))
         text = 'on mesh '//whole(n)//' ('//short(price%levels(n)%mesh)//' times the cells, '// &
                whole(price%levels(n)%pilot%elements)//' elements) the total error of '//trim(a%name)//' is '// &
                percent(bound_of(a))//' (mesh '//percent(bound_of(a) - a%steps - a%newton)//', '// &
                trim(STATE_WORDS(a%state))//'; steps '//percent(a%steps)//'; Newton''s method '//percent(a%newton)//')'
      end associate
   end function words_of_error
end module mesh_levels
