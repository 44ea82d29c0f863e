! SPDX-License-Identifier: MIT
!> Cost of a run: unknowns of every field, the memory of its largest lists, and the time of its parts.
module run_cost
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   use run_state, only: run_t
   use solution, only: T_MATERIAL, T_ASSEMBLY, T_CONTACT, T_FACTORISATION, T_SOLUTION, T_REST
   use texts, only: short, whole
   use unknown_fields, only: AT_P_W, AT_P_C, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: size_of_run, print_cost

   real(wp), parameter :: MEGABYTE = 1.0e6_wp, OF_A_NUMBER = 8.0_wp   !< [bytes]
contains
   !> Says in a sentence how large a run is; factors are as large as the last ones made, 0 before a run. Memory is in
   !> MB of 1e6 bytes.
   function size_of_run(run) result(text)
      type(run_t), intent(in) :: run
      character(:), allocatable :: text
      real(wp) :: points   !< Numbers of their states.
      integer :: f

      associate (field => run%dofs%field)
         text = whole(run%dofs%n)//' unknowns ('//whole(count(field <= DISPLACEMENTS))//' displacements'
         do f = AT_P_W, AT_P_C
            if (any(field == f)) text = text//', '//whole(count(field == f))//trim(merge(' p_w', ' p_c', f == AT_P_W))
         end do
      end associate
      ! There is a state before the step and one after it.
      associate (s => run%state)
         points = 2.0_wp*(size(s%state) + size(s%stress) + size(s%e) + size(s%s) + size(s%s_rate))
      end associate
      text = text//'); state of the points '//megabytes(points)//', matrices of the elements '// &
             megabytes(1.0_wp*size(run%assembly%k))//', matrix '//megabytes(1.0_wp*size(run%pattern%col))
      if (run%system%sparse%entries > 0.0_wp) text = text//', its factors '//megabytes(run%system%sparse%entries)
      text = text//'.'
   end function size_of_run

   !> Says how much memory so many numbers take.
   function megabytes(numbers) result(text)
      real(wp), intent(in) :: numbers
      character(:), allocatable :: text

      text = short(numbers*OF_A_NUMBER/MEGABYTE)//' MB'
   end function megabytes

   !> Prints counters, memory and the time of every part of a run.
   subroutine print_cost(unit, run, total)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: total   !< Wall time since the program began [s].
      character(14), parameter :: PHASES(8) = [character(14) :: 'material', 'assembly', 'contact', 'factorisation', &
                                               'solution', 'rest of Newton', 'output', 'all else']
      real(wp) :: seconds(8)
      integer :: k

      seconds(:7) = [run%system%seconds([T_MATERIAL, T_ASSEMBLY, T_CONTACT, T_FACTORISATION, T_SOLUTION, T_REST]), &
                     run%seconds_output]
      seconds(8) = total - sum(seconds(:7))
      write (unit, '(a)') whole(run%steps)//' steps, '//whole(run%iterations)//' iterations, '// &
         whole(run%cuts)//' cuts, '//whole(run%rate_evaluations)//' rate evaluations of the material; in this run '// &
         whole(run%system%n_pass)//' passes over the elements, '//whole(run%system%sparse%n_numeric)// &
         ' factorisations ('//whole(nint(run%system%sparse%entries, int64))//' entries), '// &
         whole(run%system%sparse%n_solve)//' solutions by factors.'
      write (unit, '(a)') size_of_run(run)
      do k = 1, size(PHASES)
         write (unit, '(3x,a,f12.3,a,f6.1,a)') PHASES(k), seconds(k), ' s', 100*seconds(k)/total, ' %'
      end do
      write (unit, '(3x,a,f12.3,a)') 'in all        ', total, ' s'
   end subroutine print_cost
end module run_cost
