! SPDX-License-Identifier: MIT
!> Embedded Runge-Kutta pairs and their step control. Knows no soil: vectors and rates only;
!> docs/theory/integration.md sections 2 and 3.
module mud_substep
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: scheme_t, SCHEMES, SECOND_ORDER, THIRD_ORDER, AS_SECOND_ORDER, LINEARLY_IMPLICIT, &
             IMPLICIT_WEIGHTS, IMPLICIT_DIAGONAL, MAX_STAGES, &
             LARGEST_FACTOR, SMALLEST_FACTOR, SAFETY, stage_point, solution, error_vector, &
             step_factor, cubic_point

   integer, parameter :: MAX_STAGES = 7
   integer, parameter :: TRIANGLE = MAX_STAGES*(MAX_STAGES - 1)/2
   real(wp), parameter :: SAFETY = 0.9_wp, SMALLEST_FACTOR = 0.1_wp
   real(wp), parameter :: LARGEST_FACTOR = 2.0_wp   !< On a step, from one to the next [-].

   !> An explicit pair with local extrapolation.
   type :: scheme_t
      integer :: stages
      integer :: order                  !< Order of the solution; the estimate is one lower [-].
      logical :: first_same_as_last     !< The last stage is the rate at the solution.
      real(wp) :: a(TRIANGLE)           !< Strict lower triangle row by row: weights of the earlier rates in a stage.
      real(wp) :: b(MAX_STAGES)         !< Weights of the solution.
      real(wp) :: error(MAX_STAGES)     !< Weights of solution minus embedded solution.
      real(wp) :: node(MAX_STAGES)      !< Share of the step where a stage stands.
   end type scheme_t

   real(wp), parameter :: ZERO(TRIANGLE) = 0.0_wp

   !> Modified Euler 2(1), the paper's scheme (Sloan, Abbo & Sheng 2001).
   type(scheme_t), parameter :: MODIFIED_EULER = scheme_t(2, 2, .false., &
      [1.0_wp, ZERO(2:)], &
      [0.5_wp, 0.5_wp, ZERO(3:7)], &
      [-0.5_wp, 0.5_wp, ZERO(3:7)], &
      [0.0_wp, 1.0_wp, ZERO(3:7)])

   !> Bogacki & Shampine 3(2), Appl. Math. Lett. 2 (1989).
   type(scheme_t), parameter :: BOGACKI_SHAMPINE = scheme_t(4, 3, .true., &
      [1.0_wp/2, 0.0_wp, 3.0_wp/4, 2.0_wp/9, 1.0_wp/3, 4.0_wp/9, ZERO(7:)], &
      [2.0_wp/9, 1.0_wp/3, 4.0_wp/9, ZERO(4:7)], &
      [-5.0_wp/72, 1.0_wp/12, 1.0_wp/9, -1.0_wp/8, ZERO(5:7)], &
      [0.0_wp, 1.0_wp/2, 3.0_wp/4, 1.0_wp, ZERO(5:7)])

   !> Dormand & Prince 5(4), J. Comput. Appl. Math. 6 (1980).
   type(scheme_t), parameter :: DORMAND_PRINCE = scheme_t(7, 5, .true., &
      [1.0_wp/5, &
       3.0_wp/40, 9.0_wp/40, &
       44.0_wp/45, -56.0_wp/15, 32.0_wp/9, &
       19372.0_wp/6561, -25360.0_wp/2187, 64448.0_wp/6561, -212.0_wp/729, &
       9017.0_wp/3168, -355.0_wp/33, 46732.0_wp/5247, 49.0_wp/176, -5103.0_wp/18656, &
       35.0_wp/384, 0.0_wp, 500.0_wp/1113, 125.0_wp/192, -2187.0_wp/6784, 11.0_wp/84], &
      [35.0_wp/384, 0.0_wp, 500.0_wp/1113, 125.0_wp/192, -2187.0_wp/6784, 11.0_wp/84, 0.0_wp], &
      [71.0_wp/57600, 0.0_wp, -71.0_wp/16695, 71.0_wp/1920, -17253.0_wp/339200, 22.0_wp/525, -1.0_wp/40], &
      [0.0_wp, 1.0_wp/5, 3.0_wp/10, 4.0_wp/5, 8.0_wp/9, 1.0_wp, 1.0_wp])

   type(scheme_t), parameter :: SCHEMES(3) = [MODIFIED_EULER, BOGACKI_SHAMPINE, DORMAND_PRINCE]
   !> The pairs of the scheme `automatic`. Steps of the third order grow with the third root of the tolerance, and it is
   !> the most stable of the three for its rates.
   type(scheme_t), parameter :: SECOND_ORDER = MODIFIED_EULER, THIRD_ORDER = BOGACKI_SHAMPINE
   !> The error that modified Euler would have, from the stages of a substep of third order: its first and its last.
   type(scheme_t), parameter :: AS_SECOND_ORDER = scheme_t(4, 2, .true., BOGACKI_SHAMPINE%a, BOGACKI_SHAMPINE%b, &
      [-0.5_wp, 0.0_wp, 0.0_wp, 0.5_wp, ZERO(5:7)], BOGACKI_SHAMPINE%node)

   !> Rosenbrock-W 3(2), ROS34PW2 of Rang & Angermann, BIT 45 (2005): of order 3 whatever matrix stands for the
   !> Jacobian, and L-stable where it is the Jacobian. Its rates are those of explicit stages, changed by
   !> mud_relaxation's dyad with the weights below.
   type(scheme_t), parameter :: LINEARLY_IMPLICIT = scheme_t(4, 3, .false., &
      [8.7173304301691801e-1_wp, 8.4457060015369423e-1_wp, -1.1299064236484185e-1_wp, 0.0_wp, 0.0_wp, 1.0_wp, &
       ZERO(7:)], &
      [2.4212380706095346e-1_wp, -1.2232505839045147_wp, 1.5452602553351020_wp, 4.3586652150845900e-1_wp, ZERO(5:7)], &
      [-1.3598522439724023e-1_wp, -1.1272082916920915_wp, 1.0452602553351020_wp, 2.1793326075422950e-1_wp, &
       ZERO(5:7)], &
      [0.0_wp, 8.7173304301691801e-1_wp, 7.3157995778885238e-1_wp, 1.0_wp, ZERO(5:7)])
   !> Weights of the earlier rates that the Jacobian multiplies, strict lower triangle row by row, and of the own one.
   real(wp), parameter :: IMPLICIT_WEIGHTS(6) = [-8.7173304301691801e-1_wp, -9.0338057013044082e-1_wp, &
      5.4180672388095326e-2_wp, 2.4212380706095346e-1_wp, -1.2232505839045147_wp, 5.4526025533510214e-1_wp]
   real(wp), parameter :: IMPLICIT_DIAGONAL = 4.3586652150845900e-1_wp
contains
   !> Place of stage i of a step h. y0(n), y(n), rates(n, i - 1 or more) per unit of time; h in that unit. Butcher's
   !> form; docs/theory/integration.md section 2.
   pure subroutine stage_point(scheme, i, y0, rates, h, y)
      type(scheme_t), intent(in) :: scheme
      integer, intent(in) :: i
      real(wp), intent(in), contiguous :: y0(:), rates(:, :)
      real(wp), intent(in) :: h
      real(wp), intent(out), contiguous :: y(:)

      call combine(size(y), size(rates, 1), i - 1, scheme%a((i - 1)*(i - 2)/2 + 1:i*(i - 1)/2), y0, rates, h, y)
   end subroutine stage_point

   !> The solution of a step h. y0(n), y(n), rates(n or more, stages or more) per unit of time; h in that unit.
   !> docs/theory/integration.md section 2.
   pure subroutine solution(scheme, y0, rates, h, y)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in), contiguous :: y0(:), rates(:, :)
      real(wp), intent(in) :: h
      real(wp), intent(out), contiguous :: y(:)

      call combine(size(y), size(rates, 1), scheme%stages, scheme%b(1:scheme%stages), y0, rates, h, y)
   end subroutine solution

   !> Solution minus embedded solution of a step h. error(n), n at most 21, rates(n, stages or more) per unit of time; h
   !> in that unit. docs/theory/integration.md section 3.
   pure subroutine error_vector(scheme, rates, h, error)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in), contiguous :: rates(:, :)
      real(wp), intent(in) :: h
      real(wp), intent(out), contiguous :: error(:)

      call combine(size(error), size(rates, 1), scheme%stages, scheme%error(1:scheme%stages), ZERO(1:size(error)), &
                   rates, h, error)
   end subroutine error_vector

   !> The state at a share of a step h, by the cubic that has the states and rates of both its ends (Hermite's
   !> interpolation). y of any length, rates per unit of time; h in that unit, share [-]. docs/theory/integration.md
   !> section 4.1.
   pure function cubic_point(h, share, y0, rate0, y1, rate1) result(y)
      real(wp), intent(in) :: h, share, y0(:), rate0(:), y1(:), rate1(:)
      real(wp) :: y(size(y0))

      y = y0 + share*(y1 - y0) &
          + share*(share - 1.0_wp)*((1.0_wp - 2.0_wp*share)*(y1 - y0) + (share - 1.0_wp)*h*rate0 + share*h*rate1)
   end function cubic_point

   !> y = y0 + h times the weighted sum of the first rates.
   pure subroutine combine(n, leading, stages, weights, y0, rates, h, y)
      integer, intent(in) :: n, leading, stages
      real(wp), intent(in) :: weights(stages), y0(n), rates(leading, stages), h
      real(wp), intent(out) :: y(n)
      integer :: i, j

      if (stages == 0) then
         y = y0
      else if (stages == 1) then
         do i = 1, n
            y(i) = y0(i) + (h*weights(1))*rates(i, 1)
         end do
      else if (stages == 2) then
         do i = 1, n
            y(i) = y0(i) + (h*weights(1))*rates(i, 1) + (h*weights(2))*rates(i, 2)
         end do
      else
         do i = 1, n
            y(i) = y0(i) + (h*weights(1))*rates(i, 1) + (h*weights(2))*rates(i, 2) + (h*weights(3))*rates(i, 3)
         end do
         do j = 4, stages
            if (abs(weights(j)) > 0.0_wp) y = y + (h*weights(j))*rates(1:n, j)
         end do
      end if
   end subroutine combine

   !> Factor on the step for an error of a tolerance; no growth right after a rejection. error and tolerance in the same
   !> unit, tolerance > 0; the factor [-] is from 0.1 to 2. docs/theory/integration.md section 3.
   pure real(wp) function step_factor(scheme, error, tolerance, may_grow) result(factor)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: error, tolerance
      logical, intent(in) :: may_grow
      real(wp) :: ratio

      factor = LARGEST_FACTOR
      ratio = error/tolerance
      if (ratio > (SAFETY/LARGEST_FACTOR)**scheme%order) then
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
