! SPDX-License-Identifier: MIT
!> Error of a force that follows the motion: the thrust of a contact. What errs in the motion by C dt**3 times the third
!> derivative (error_norms) errs by the same in whatever depends on it linearly; the derivative is that of the force
!> itself. What is judged is the peak of the thrust, once for each time that the contact is closed: what vibrates behind
!> it, the body on its contact, is no answer. docs/theory/host.md section 4.5.
module force_errors
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: force_memory_t, force_error, remember_force, FORCE_NUMBERS, numbers_of_force, take_force

   integer, parameter :: BACK = 3                          !< Values that a third derivative needs besides the new one.
   integer, parameter :: FORCE_NUMBERS = 2*BACK + 8     !< Of a memory in a checkpoint.

   type :: force_memory_t
      integer :: known = 0              !< Values since the contact closed, the newest last.
      real(wp) :: time(BACK) = 0.0_wp, force(BACK) = 0.0_wp   !< [s], [kN]
      real(wp) :: third = 0.0_wp        !< The last third derivative [kN/s3].
      real(wp) :: low = huge(1.0_wp), high = -huge(1.0_wp)    !< In the whole run [kN].
      real(wp) :: gathered = 0.0_wp     !< Error since the contact closed [kN].
      real(wp) :: peak = 0.0_wp         !< Magnitude of the force since the contact closed, the largest [kN].
      real(wp) :: at_peak = 0.0_wp      !< Error there [kN].
      real(wp) :: largest = 0.0_wp      !< The largest error of a peak so far [kN].
   end type force_memory_t
contains
   !> Error of a step that ends with a force at a time; 0 where too few values are known. Accelerations that alternate
   !> from step to step are those of waves too fast for the steps: the derivative is the mean of two steps.
   !> docs/theory/host.md section 4.5.
   pure real(wp) function force_error(memory, constant, dt, time, force) result(error)
      type(force_memory_t), intent(in) :: memory
      real(wp), intent(in) :: constant      !< C of the error of a step [-].
      real(wp), intent(in) :: dt            !< [s]
      real(wp), intent(in) :: time, force   !< That the force holds for [s], [kN].

      error = 0.0_wp
      if (.not. complete(memory, force)) return
      error = constant*dt**3*0.5_wp*abs(third_derivative(memory, time, force) + memory%third)
   end function force_error

   pure logical function complete(memory, force)
      type(force_memory_t), intent(in) :: memory
      real(wp), intent(in) :: force

      complete = memory%known >= BACK .and. abs(force) > 0.0_wp
   end function complete

   !> Between the two middle ones of four values: the change of the second derivative [kN/s3].
   pure real(wp) function third_derivative(memory, time, force)
      type(force_memory_t), intent(in) :: memory
      real(wp), intent(in) :: time, force
      real(wp) :: t(BACK + 1), f(BACK + 1), first(BACK), second(BACK - 1)

      t = [memory%time, time]
      f = [memory%force, force]
      first = (f(2:) - f(:BACK))/(t(2:) - t(:BACK))
      second = (first(2:) - first(:BACK - 1))/(0.5_wp*(t(3:) - t(:BACK - 1)))
      third_derivative = (second(2) - second(1))/(t(3) - t(2))
   end function third_derivative

   !> Adds the error of an accepted step up, and keeps its force; nothing of them where the contact is open.
   pure subroutine remember_force(memory, error, kept, time, force)
      type(force_memory_t), intent(inout) :: memory
      real(wp), intent(in) :: error         !< Of force_error [kN].
      real(wp), intent(in) :: kept          !< Share of earlier errors that has not faded [-].
      real(wp), intent(in) :: time, force   !< [s], [kN]

      memory%low = min(memory%low, force)
      memory%high = max(memory%high, force)
      if (.not. abs(force) > 0.0_wp) then
         memory%known = 0
         memory%third = 0.0_wp
         memory%gathered = 0.0_wp
         memory%peak = 0.0_wp
         memory%at_peak = 0.0_wp
         return
      end if
      if (complete(memory, force)) memory%third = third_derivative(memory, time, force)
      memory%gathered = kept*memory%gathered + error
      if (abs(force) >= memory%peak) then
         memory%peak = abs(force)
         memory%at_peak = memory%gathered
         memory%largest = max(memory%largest, memory%at_peak)
      end if
      memory%time = [memory%time(2:), time]
      memory%force = [memory%force(2:), force]
      memory%known = min(memory%known + 1, BACK)
   end subroutine remember_force

   !> For a checkpoint, in the order that take_force reads.
   pure function numbers_of_force(memory) result(list)
      type(force_memory_t), intent(in) :: memory
      real(wp) :: list(FORCE_NUMBERS)

      list = [real(memory%known, wp), memory%time, memory%force, memory%third, memory%low, memory%high, &
              memory%gathered, memory%peak, memory%at_peak, memory%largest]
   end function numbers_of_force

   !> The memory again.
   pure subroutine take_force(list, memory)
      real(wp), intent(in) :: list(FORCE_NUMBERS)
      type(force_memory_t), intent(inout) :: memory

      memory = force_memory_t(nint(list(1)), list(2:BACK + 1), list(BACK + 2:2*BACK + 1), list(2*BACK + 2), &
                              list(2*BACK + 3), list(2*BACK + 4), list(2*BACK + 5), list(2*BACK + 6), &
                              list(2*BACK + 7), list(2*BACK + 8))
   end subroutine take_force
end module force_errors
