! SPDX-License-Identifier: MIT
!> Errors of forces from their histories. What errs in the motion by C dt**3 times the third derivative (error_norms)
!> errs by the same in whatever depends on it linearly: the reaction of a support, the thrust of a contact; the
!> derivative is that of the force itself. docs/theory/host.md section 4.5.
module force_errors
   use kinds, only: wp
   use error_norms, only: bent_error
   implicit none (type, external)
   private
   public :: error_of_support, error_on_path, error_of_peaks, VALUES

   integer, parameter :: VALUES = 4   !< That a third derivative needs.
contains
   !> Largest error of a force in its history [kN]: in a motion magnitudes add up, in a flow errors with their signs;
   !> both fade. What alternates from step to step are waves too fast for the steps: the derivative is the mean of two
   !> steps. The first three steps of a stage, and of a flow behind what is sudden, have no estimate.
   !> docs/theory/host.md section 4.5.
   pure real(wp) function error_of_support(time, dt, constant, kept, force, flows) result(largest)
      real(wp), intent(in) :: time(:)       !< That the forces hold for, ascending [s]. (steps)
      real(wp), intent(in) :: dt(:)         !< Lengths of the steps [s]. (steps)
      real(wp), intent(in) :: constant(:)   !< C of the error of a step, 0: nothing estimates it [-]. (steps)
      real(wp), intent(in) :: kept(:)       !< Share of earlier errors that a step leaves [-]. (steps)
      real(wp), intent(in) :: force(:)      !< [kN] (steps)
      logical, intent(in) :: flows          !< A flow, else a motion.
      real(wp) :: error, sum, third, before
      integer :: i

      largest = 0.0_wp
      sum = 0.0_wp
      before = 0.0_wp
      do i = VALUES, size(time)
         third = 0.0_wp
         if (constant(i) > 0.0_wp) third = third_derivative(time(i - VALUES + 1:i), force(i - VALUES + 1:i))
         error = constant(i)*dt(i)**3*0.5_wp*(third + before)
         if (.not. flows) error = abs(error)
         sum = kept(i)*sum + error
         largest = max(largest, abs(sum))
         before = third
      end do
   end function error_of_support

   !> Largest error of a force in a static stage [kN]: what its steps leave out of the bend of its own history, as far
   !> as the stiffness changes in them; magnitudes add up. A force that follows from what acts by equilibrium has no
   !> bend of its own, and no error. docs/theory/host.md section 4.5.
   pure real(wp) function error_on_path(time, dt, bend, force) result(sum)
      real(wp), intent(in) :: time(:), dt(:)   !< Ends of the steps and their lengths [s]. (steps)
      real(wp), intent(in) :: bend(:)          !< Share by which the stiffness changes in a step, 0: not known. (steps)
      real(wp), intent(in) :: force(:)         !< [kN] (steps)
      integer :: i

      sum = 0.0_wp
      do i = 3, size(time)
         sum = sum + abs(bent_error(bend(i), (force(i) - force(i - 1))/(time(i) - time(i - 1)), &
                                    (force(i - 1) - force(i - 2))/(time(i - 1) - time(i - 2)), dt(i), dt(i - 1)))
      end do
   end function error_on_path

   !> Largest error of the peaks of a thrust [kN], a peak for each time that the contact is closed. A shift of phase is
   !> no error of a peak: errors count with their signs, from the time that the contact closes to its peak. What
   !> vibrates behind the peak, the body on its contact, is no answer. A peak among the first three values has no
   !> estimate of its own. docs/theory/host.md section 4.5.
   pure real(wp) function error_of_peaks(time, dt, constant, kept, force, unknown) result(largest)
      real(wp), intent(in) :: time(:), dt(:), constant(:), kept(:)   !< As of error_of_support. (steps)
      real(wp), intent(in) :: force(:)   !< 0 where the contact is open [kN]. (steps)
      real(wp), intent(in) :: unknown    !< Error of a peak without an estimate, as a share of it [-].
      real(wp) :: sum, third, before, peak, at_peak
      logical :: estimated
      integer :: i, first

      largest = 0.0_wp
      first = 0
      do i = 1, size(time)
         if (.not. abs(force(i)) > 0.0_wp) then
            first = 0
            cycle
         end if
         if (first == 0) then
            first = i
            sum = 0.0_wp
            before = 0.0_wp
            peak = 0.0_wp
            at_peak = 0.0_wp
            estimated = .false.
         end if
         if (i - first >= VALUES - 1) then
            third = third_derivative(time(i - VALUES + 1:i), abs(force(i - VALUES + 1:i)))
            sum = kept(i)*sum + constant(i)*dt(i)**3*0.5_wp*(third + before)
            before = third
         end if
         if (abs(force(i)) >= peak) then
            peak = abs(force(i))
            if (i - first < VALUES - 1) then
               at_peak = unknown*peak
            else if (estimated) then
               at_peak = max(at_peak, abs(sum))
            else
               at_peak = abs(sum)
               estimated = .true.
            end if
         end if
         ! The contact opens, or the history ends.
         if (i == size(time)) then
            largest = max(largest, at_peak)
         else if (.not. abs(force(i + 1)) > 0.0_wp) then
            largest = max(largest, at_peak)
         end if
      end do
   end function error_of_peaks

   !> Between the two middle ones of four values: the change of the second derivative [kN/s3].
   pure real(wp) function third_derivative(t, f)
      real(wp), intent(in) :: t(VALUES), f(VALUES)   !< [s], [kN]
      real(wp) :: first(VALUES - 1), second(VALUES - 2)

      first = (f(2:) - f(:VALUES - 1))/(t(2:) - t(:VALUES - 1))
      second = (first(2:) - first(:VALUES - 2))/(0.5_wp*(t(3:) - t(:VALUES - 2)))
      third_derivative = (second(2) - second(1))/(t(3) - t(2))
   end function third_derivative
end module force_errors
