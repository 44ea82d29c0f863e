! SPDX-License-Identifier: MIT
!> The price of accuracy, printed and as files.
module price_table
   use csv, only: csv_t, new_csv, write_row, close_csv, quoted
   use faults, only: fault_t
   use kinds, only: wp
   use error_words, only: percent, rounded
   use price_estimates, only: quote_t, STATE_WORDS, MASKED
   use scene_price, only: price_t
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: print_price, print_errors, write_price

   real(wp), parameter :: TARGETS(3) = [0.1_wp, 0.03_wp, 0.01_wp]
   !> Range of a quote, one mesh ahead: time and error.
   real(wp), parameter :: TIME_LOW = 0.5_wp, TIME_HIGH = 3.0_wp, ERROR_RANGE = 3.0_wp
contains
   !> Errors of the answers on the finest mesh, by their sources.
   subroutine print_errors(unit, price)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(price_t), intent(in) :: price
      integer :: i

      write (unit, '(a)') 'Errors of the histories as shares of their largest change, on '// &
         short(price%levels(size(price%levels))%mesh)//' times the cells of the scene:'
      write (unit, '(3x,a,t26,4a12,4x,a)') 'answer', 'mesh', 'steps', 'Newton', 'order', 'mesh error is'
      do i = 1, size(price%answers)
         associate (a => price%answers(i))
            write (unit, '(3x,a,t26,3a12,f12.2,4x,a)') trim(a%name), percent(a%mesh), percent(a%steps), &
               percent(a%newton), a%order, trim(STATE_WORDS(a%state))// &
               trim(merge(' by the error of the steps', repeat(' ', 26), a%state == MASKED))// &
               trim(merge(repeat(' ', 9), ', no goal', a%goal))
         end associate
      end do
   end subroutine print_errors

   !> Errors of the answers, the table mesh by accuracy, the cheapest way to 10, 3 and 1 %.
   subroutine print_price(unit, price)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(price_t), intent(in) :: price
      integer :: i, k, best

      call print_errors(unit, price)
      write (unit, '(a)') 'Total error of the worst answer, and time of the run [s] (error within a factor of '// &
         'three, time from half to three times):'
      write (unit, '(3x,a)') head()
      k = 1
      do while (k <= size(price%quotes))
         write (unit, '(3x,a)') row(k)
         k = next_mesh(k)
      end do
      do i = 1, size(TARGETS)
         best = cheapest(price%quotes, TARGETS(i))
         if (best == 0) then
            write (unit, '(3x,a)') percent(TARGETS(i))//': none of these runs'
         else
            write (unit, '(3x,a)') percent(TARGETS(i))//': '//in_words(price%quotes(best))
         end if
      end do
      if (size(price%levels) == 2) write (unit, '(3x,a)') 'The order of convergence is assumed: a third mesh costs '// &
         'more than all pilots.'
      if (price%troubled) write (unit, '(3x,a)') 'Pilots cut more than a tenth of their steps: finer meshes may '// &
         'cost many times their quote.'
      write (unit, '(3x,a)') whole(price%runs)//' pilots in '//short(price%seconds)//' s. Stress integration and '// &
         'what the scene leaves out are not in the errors.'
   contains
      function head() result(line)
         character(:), allocatable :: line
         character(20) :: cell
         integer :: n

         line = merge('elements, accuracy  ', 'elements, dt times  ', price%asked > 0.0_wp)
         do n = 1, next_mesh(1) - 1
            cell = short(price%quotes(n)%fineness*merge(price%asked, 1.0_wp, price%asked > 0.0_wp))
            line = line//adjustr(cell)
         end do
      end function head

      function row(first) result(line)
         integer, intent(in) :: first
         character(:), allocatable :: line
         character(20) :: cell
         integer :: n

         cell = whole(nint(price%quotes(first)%elements))
         line = cell
         do n = first, next_mesh(first) - 1
            cell = percent(price%quotes(n)%error)//' '//rounded(price%quotes(n)%seconds)//' s'
            if (is_scene(price%quotes(n))) cell = '['//trim(cell)//']'
            line = line//adjustr(cell)
         end do
      end function row

      integer function next_mesh(first) result(n)
         integer, intent(in) :: first

         n = first
         do while (n <= size(price%quotes))
            if (abs(price%quotes(n)%mesh - price%quotes(first)%mesh) > 0.0_wp) exit
            n = n + 1
         end do
      end function next_mesh

      function in_words(q) result(text)
         type(quote_t), intent(in) :: q
         character(:), allocatable :: text

         text = short(q%mesh)//' times the cells ('//whole(nint(q%elements))//' elements), '
         if (price%asked > 0.0_wp) then
            text = text//'accuracy '//short(q%fineness*price%asked)
         else
            text = text//'dt times '//short(q%fineness)
         end if
         text = text//': '//rounded(q%seconds)//' s, '//rounded(q%megabytes)//' MB, error '//percent(q%error)
      end function in_words
   end subroutine print_price

   !> Whether a run is the scene as it stands.
   elemental logical function is_scene(q)
      type(quote_t), intent(in) :: q

      is_scene = abs(q%mesh - 1) < epsilon(1.0_wp) .and. abs(q%fineness - 1) < epsilon(1.0_wp)
   end function is_scene

   !> Place of the fastest run with an error of at most `target` [-]; 0: there is none.
   pure integer function cheapest(quotes, target)
      type(quote_t), intent(in) :: quotes(:)
      real(wp), intent(in) :: target
      integer :: k

      cheapest = 0
      do k = 1, size(quotes)
         if (quotes(k)%error > target) cycle
         if (cheapest > 0) then
            if (quotes(k)%seconds >= quotes(cheapest)%seconds) cycle
         end if
         cheapest = k
      end do
   end function cheapest

   !> price.csv: a row a run that could be made; price_answers.csv: the errors of each answer on the finest mesh that
   !> was run. docs/theory/host.md section 12. Fault EXIT_OUTPUT: they cannot be written.
   subroutine write_price(folder, price, fault)
      character(*), intent(in) :: folder
      type(price_t), intent(in) :: price
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: table
      integer :: k

      call new_csv(folder//'/price.csv', 'mesh,steps,accuracy,elements,error,mesh_error,steps_error,newton_error,'// &
                   'error_low,error_high,seconds,seconds_low,seconds_high,megabytes,is_scene,answer', table, fault)
      do k = 1, size(price%quotes)
         if (fault%code /= 0) exit
         associate (q => price%quotes(k))
            write (table%row, '(14(es14.6e3,","),i0,",",a)') q%mesh, q%fineness, q%fineness*price%asked, q%elements, &
               q%error, q%error_of_mesh, q%error_of_steps, q%error_of_newton, q%error/ERROR_RANGE, &
               q%error*ERROR_RANGE, q%seconds, q%seconds*TIME_LOW, q%seconds*TIME_HIGH, q%megabytes, &
               merge(1, 0, is_scene(q)), quoted(trim(price%answers(max(1, q%answer))%name))
         end associate
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
      if (fault%code /= 0) return
      call new_csv(folder//'/price_answers.csv', 'answer,mesh,range,mesh_error,steps_error,newton_error,order,state', &
                   table, fault)
      do k = 1, size(price%answers)
         if (fault%code /= 0) exit
         associate (a => price%answers(k))
            write (table%row, '(a,",",6(es14.6e3,","),a)') quoted(trim(a%name)), &
               price%levels(size(price%levels))%mesh, a%range, a%mesh, a%steps, &
               a%newton, a%order, trim(STATE_WORDS(a%state))
         end associate
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   end subroutine write_price
end module price_table
