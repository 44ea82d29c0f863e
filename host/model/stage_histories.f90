! SPDX-License-Identifier: MIT
!> Histories whose times count from stages: they are placed in the time of the run, anew at the start of each of these
!> stages. docs/theory/host.md section 7.2.
module stage_histories
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use model_types, only: model_t
   use scene_parts, only: amplitude_t, place_of
   use texts, only: short
   implicit none (type, external)
   private
   public :: place_histories

   real(wp), parameter :: ROUNDING = 1.0e-9_wp   !< Of a time, relative to the length of a history.
contains
   !> Stages are known. Fault EXIT_INPUT: a history lasts beyond the start of the stage that it
   !> begins anew in, or would jump there.
   subroutine place_histories(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(model%amplitudes)
         if (fault%code == 0 .and. size(model%amplitudes(i)%stages) > 0) call place(model, model%amplitudes(i), fault)
      end do
   end subroutine place_histories

   subroutine place(model, h, fault)
      type(model_t), intent(in) :: model
      type(amplitude_t), intent(inout) :: h
      type(fault_t), intent(inout) :: fault
      logical :: named(size(model%stages))
      real(wp), allocatable :: times(:), values(:)
      integer, allocatable :: arcs(:)
      real(wp) :: start, length
      integer :: i, s, n

      named = [(any(h%stages == model%stages(s)%name), s=1, size(named))]
      n = size(h%times)
      if (count(named) > 1 .and. abs(h%values(n) - h%values(1)) > 0.0_wp) then
         call raise(fault, EXIT_INPUT, place_of(h)//'history '''//trim(h%name)//''' begins anew in several stages, '// &
                    'with the factor '//short(h%values(1))//' after '//short(h%values(n))//': it would jump. Let '// &
                    'it end with the factor that it begins with, or name one stage.')
         return
      end if
      length = h%times(n) - h%times(1)
      allocate (times(0), values(0), arcs(0))
      do s = 1, size(named)
         if (.not. named(s)) cycle
         start = sum(model%stages(:s - 1)%duration)
         i = size(times)
         if (i == 0) then
            times = start + h%times
            values = h%values
            arcs = h%arcs
         else if (start + h%times(1) < times(i) - ROUNDING*length) then
            call raise(fault, EXIT_INPUT, place_of(h)//'history '''//trim(h%name)//''' lasts up to '// &
                       short(times(i))//' s, and begins anew at '//short(start + h%times(1))//' s with stage '// &
                       trim(model%stages(s)%name)//': shorten it, or lengthen the stage before.')
            return
         else if (start + h%times(1) <= times(i) + ROUNDING*length) then
            times = [times, start + h%times(2:)]
            values = [values, h%values(2:)]
            arcs = [arcs, h%arcs]
         else
            times = [times, start + h%times]
            values = [values, h%values]
            arcs = [arcs, spread(0, 1, min(1, size(h%arcs))), h%arcs]
         end if
      end do
      call move_alloc(times, h%times)
      call move_alloc(values, h%values)
      call move_alloc(arcs, h%arcs)
   end subroutine place
end module stage_histories
