! SPDX-License-Identifier: MIT
!> Chooses the length of the next time step from the error of the last ones: a PI controller with rejection and a
!> deadband (Gustafsson 1991; Soderlind 2003). It knows no equations: it is given ratios of error to allowance.
!> docs/theory/host.md section 4.5.
module step_control
   use archive, only: archive_t
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: controller_t, new_controller, exchange_controller, judge, LARGEST_FACTOR

   real(wp), parameter :: REJECTED_ABOVE = 1.2_wp   !< Ratio of error to allowance beyond which a step is repeated.
   real(wp), parameter :: LARGEST_FACTOR = 2.0_wp, SMALLEST_FACTOR = 0.2_wp
   integer, parameter :: MOST_REJECTIONS = 10       !< In a row: 0.2**10 is as good as nothing.
   real(wp), parameter :: SAFETY = 0.9_wp           !< Share that is taken of the step that the error asks for.
   !> A longer step that gains less than this is not taken: the factors of the matrix serve equal steps.
   real(wp), parameter :: DEADBAND = 1.2_wp
   real(wp), parameter :: ORDER = 3.0_wp            !< A step of second order errs by its third power.
   real(wp), parameter :: INTEGRAL = 0.7_wp/ORDER, PROPORTIONAL = 0.4_wp/ORDER
   real(wp), parameter :: LEAST_RATIO = 1.0e-10_wp  !< Smaller ratios are no errors.

   type :: controller_t
      real(wp) :: dt = 0.0_wp           !< Next step [s].
      real(wp) :: last_ratio = 1.0_wp   !< Ratio of error to allowance of the last accepted step.
      integer :: rejections = 0         !< In a row, of the step under way.
      logical :: held = .false.         !< The last attempt was rejected: no growth.
   end type controller_t
contains
   !> Makes a controller before its first step.
   pure function new_controller(dt) result(controller)
      real(wp), intent(in) :: dt   !< First step [s].
      type(controller_t) :: controller

      controller%dt = dt
   end function new_controller

   !> Exchanges a controller between two steps with an archive.
   subroutine exchange_controller(controller, archive)
      type(controller_t), intent(inout) :: controller
      class(archive_t), intent(inout) :: archive

      call archive%exchange('dt', controller%dt, 's', 'next step')
      call archive%exchange('last_ratio', controller%last_ratio, '-', &
                            'error over allowance of the last accepted step')
      call archive%exchange('held', controller%held, 'the last attempt was rejected: the next step is no longer')
   end subroutine exchange_controller

   !> Whether a step stands, and the length of the next attempt. A ratio below zero says that nothing is known of the
   !> error: the step stands and the next is no longer. The controller is by Gustafsson (1991) and Soderlind (2003):
   !> docs/theory/host.md section 4.5.
   pure subroutine judge(controller, dt, ratio, accepted)
      type(controller_t), intent(inout) :: controller
      real(wp), intent(in) :: dt   !< Step that was tried; shorter than asked where it had to end at a given time [s].
      real(wp), intent(in) :: ratio   !< Error of the step over what is allowed [-].
      logical, intent(out) :: accepted   !< Whether the step stands; also after the most rejections in a row.
      real(wp) :: factor, r

      ! Where something begins out of rest nothing is there yet to compare its error with.
      accepted = .not. ratio > REJECTED_ABOVE .or. controller%rejections >= MOST_REJECTIONS
      if (.not. accepted) then
         controller%rejections = controller%rejections + 1
         controller%dt = dt*max(SMALLEST_FACTOR, min(SAFETY, SAFETY*ratio**(-1/ORDER)))
         controller%held = .true.
         return
      end if
      controller%rejections = 0
      if (ratio < 0.0_wp) then
         controller%last_ratio = 1.0_wp
         controller%held = .false.
         return
      end if
      r = max(ratio, LEAST_RATIO)
      factor = SAFETY*r**(-INTEGRAL)*(controller%last_ratio/r)**PROPORTIONAL
      controller%last_ratio = r
      factor = max(SMALLEST_FACTOR, min(LARGEST_FACTOR, factor))
      if (factor > 1.0_wp) then
         if (factor < DEADBAND .or. controller%held) factor = 1.0_wp
         ! A step that was cut short by a given time says nothing against the length that was asked for.
         controller%dt = max(controller%dt, dt*factor)
      else if (ratio > 1.0_wp .and. .not. controller%held) then
         controller%dt = min(controller%dt, dt*factor)
      end if
      controller%held = .false.
   end subroutine judge
end module step_control
