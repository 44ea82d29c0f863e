! SPDX-License-Identifier: MIT
!> How large a run is: unknowns of every field, and the memory of its largest lists.
module run_size
   use kinds, only: wp
   use model_types, only: model_t
   use run_state, only: run_t
   use texts, only: short, whole
   use unknown_fields, only: AT_P_W, AT_P_C, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: size_of_run

   real(wp), parameter :: MEGABYTE = 1.0e6_wp, OF_A_NUMBER = 8.0_wp   !< [bytes]
contains
   !> One sentence; factors as large as the last ones made, 0 before a run. Memory in MB of
   !> 1e6 bytes.
   function size_of_run(model, run) result(text)
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      character(:), allocatable :: text
      integer :: f

      associate (field => model%dofs%field)
         text = whole(model%dofs%n)//' unknowns ('//whole(count(field <= DISPLACEMENTS))//' displacements'
         do f = AT_P_W, AT_P_C
            if (any(field == f)) text = text//', '//whole(count(field == f))//trim(merge(' p_w', ' p_c', f == AT_P_W))
         end do
      end associate
      text = text//'); state of the points '//megabytes(of_points(run))//', matrices of the elements '// &
             megabytes(1.0_wp*size(run%assembly%k))//', matrix '//megabytes(1.0_wp*size(run%pattern%col))
      if (run%system%sparse%entries > 0.0_wp) text = text//', its factors '//megabytes(run%system%sparse%entries)
      text = text//'.'
   end function size_of_run

   !> Numbers of the state of all points, before and after the step.
   pure real(wp) function of_points(run)
      type(run_t), intent(in) :: run

      of_points = 2.0_wp*(size(run%state%state) + size(run%state%stress) + size(run%state%e) + size(run%state%s) &
                          + size(run%state%s_rate))
   end function of_points

   !> So many numbers.
   function megabytes(numbers) result(text)
      real(wp), intent(in) :: numbers
      character(:), allocatable :: text

      text = short(numbers*OF_A_NUMBER/MEGABYTE)//' MB'
   end function megabytes
end module run_size
