!> Embedded Runge-Kutta pairs and their step control. Knows no soil: vectors and rates only.
module mud_substep
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: scheme_t, SCHEMES, MAX_STAGES, stage_point, solution, error_vector, step_factor

   integer, parameter :: MAX_STAGES = 7
   real(wp), parameter :: SAFETY = 0.9_wp, SMALLEST_FACTOR = 0.1_wp, LARGEST_FACTOR = 2.0_wp

   !> An explicit pair with local extrapolation.
   type :: scheme_t
      integer :: stages
      integer :: order                            !< Of the solution; the estimate is one lower [-].
      logical :: first_same_as_last               !< The last stage is the rate at the solution.
      real(wp) :: a(MAX_STAGES, MAX_STAGES)       !< a(j, i): weight of rate j in stage i.
      real(wp) :: b(MAX_STAGES)                   !< Weights of the solution.
      real(wp) :: error(MAX_STAGES)               !< Weights of solution minus embedded solution.
      real(wp) :: node(MAX_STAGES)                !< Share of the step where a stage stands.
   end type scheme_t

   !> Modified Euler 2(1), the paper's scheme (Sloan, Abbo & Sheng 2001).
   type(scheme_t), parameter :: MODIFIED_EULER = scheme_t(2, 2, .false., &
      reshape([0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, &
      0, &
               0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]*1.0_wp, [MAX_STAGES, MAX_STAGES]), &
      [0.5_wp, 0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp], &
      [-0.5_wp, 0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp], &
      [0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp])

   type(scheme_t), parameter :: SCHEMES(1) = [MODIFIED_EULER]
contains
   !> Where stage i of a step h stands.
   pure subroutine stage_point(scheme, i, y0, rates, h, y)
      type(scheme_t), intent(in) :: scheme
      integer, intent(in) :: i
      real(wp), intent(in) :: y0(:), rates(:, :), h
      real(wp), intent(out) :: y(:)
      integer :: j

      y = y0
      do j = 1, i - 1
         if (abs(scheme%a(j, i)) > 0.0_wp) y = y + (h*scheme%a(j, i))*rates(:, j)
      end do
   end subroutine stage_point

   !> The solution of a step h.
   pure subroutine solution(scheme, y0, rates, h, y)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: y0(:), rates(:, :), h
      real(wp), intent(out) :: y(:)
      integer :: j

      y = y0
      do j = 1, scheme%stages
         y = y + (h*scheme%b(j))*rates(:, j)
      end do
   end subroutine solution

   !> Solution minus embedded solution of a step h.
   pure subroutine error_vector(scheme, rates, h, error)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: rates(:, :), h
      real(wp), intent(out) :: error(:)
      integer :: j

      error = 0.0_wp
      do j = 1, scheme%stages
         error = error + (h*scheme%error(j))*rates(:, j)
      end do
   end subroutine error_vector

   !> Factor on the step for an error of a tolerance; no growth right after a rejection.
   pure real(wp) function step_factor(scheme, error, tolerance, may_grow) result(factor)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: error, tolerance
      logical, intent(in) :: may_grow
      real(wp) :: ratio

      factor = LARGEST_FACTOR
      ratio = error/tolerance
      if (ratio > SAFETY**scheme%order/LARGEST_FACTOR**scheme%order) then
         if (scheme%order == 2) then
            factor = SAFETY/sqrt(ratio)
         else
            factor = SAFETY*ratio**(-1.0_wp/real(scheme%order, wp))
         end if
         factor = max(factor, SMALLEST_FACTOR)
      end if
      if (.not. may_grow) factor = min(factor, 1.0_wp)
   end function step_factor
end module mud_substep
