! SPDX-License-Identifier: MIT
!> Linearly implicit stages for the one stiff direction of the rates; docs/theory/integration.md section 2.1.
!>
!> Near the bounding surface the loading index L = t:n/(h (gamma - beta r:n)) relaxes towards the value that keeps the
!> stress ratio on the surface, the faster the smaller (r - r_in):n. What the stress does to L and what L does to the
!> rates is a dyad, the stiff part of the Jacobian.
module mud_relaxation
   use mud_kinds, only: wp, SQRT_2_3
   use mud_rate, only: rate_t
   use mud_substep, only: IMPLICIT_DIAGONAL, IMPLICIT_WEIGHTS
   use mud_tensor, only: IDENTITY
   use mud_vector, only: NY, Y_Z, Y_Z_END, Y_SHEAR, Y_OPTIONS, N_OPTIONS
   implicit none (type, external)
   private
   public :: relaxation_t, relaxation_speed, new_relaxation, relax

   !> The dyad flow (x) slope, and how fast L relaxes.
   type :: relaxation_t
      real(wp) :: speed      !< minus slope.flow, per unit of pseudo-time; 0: the substep is explicit [-]
      real(wp) :: flow(NY)   !< d rates/dL
      real(wp) :: slope(6)   !< dL/d sigma' by components [1/kPa]
   end type relaxation_t
contains
   !> Speed at which L relaxes per unit of pseudo-time, as far as it depends on r:n alone: near the bounding surface by
   !> a few per cent. 0 where nothing loads, or where the softening cap keeps L constant [-]. docs/theory/integration.md
   !> section 2.1.
   pure real(wp) function relaxation_speed(w) result(speed)
      type(rate_t), intent(in) :: w

      speed = 0.0_wp
      if (w%loading .and. .not. w%capped_h) then
         speed = 2.0_wp/3.0_wp*w%l*(2.0_wp*w%g - w%k_e*w%d*w%r_n)/(w%gamma - w%beta*w%r_n)
      end if
   end function relaxation_speed

   !> The dyad of a rate that loads, from the slope of its L. slope is dL/d sigma' by components [1/kPa], own
   !> are the rates of the numbers of options per L [-]; L > 0 is not checked. docs/theory/integration.md section 2.1.
   pure function new_relaxation(w, slope, own) result(relaxation)
      type(rate_t), intent(in) :: w
      real(wp), intent(in) :: slope(6), own(N_OPTIONS)
      type(relaxation_t) :: relaxation

      relaxation%slope = slope
      relaxation%flow(1:6) = -2.0_wp*w%g*w%n - (w%k_e*w%d)*IDENTITY
      relaxation%flow(Y_Z:Y_Z_END) = w%d_z/w%l
      relaxation%flow(Y_SHEAR) = SQRT_2_3
      relaxation%flow(Y_OPTIONS:) = own
      relaxation%speed = max(-dot_product(slope, relaxation%flow(1:6)), 0.0_wp)
   end function new_relaxation

   !> Turns the last of some rates, explicit, into that of a linearly implicit stage of a substep h: it solves
   !> (1 - g h J) k_i = f_i + h J sum_j g_ij k_j with the dyad J by one scalar. What holds for rates holds for their
   !> derivatives, the dyad being held. rates(NY, stages so far), h a share of the increment [-].
   !> docs/theory/integration.md section 2.1, after Rang & Angermann (2005).
   pure subroutine relax(relaxation, h, rates)
      type(relaxation_t), intent(in) :: relaxation
      real(wp), intent(in) :: h
      real(wp), intent(inout) :: rates(:, :)   !< rates of the stages so far
      real(wp) :: change
      integer :: i, j

      i = size(rates, 2)
      change = IMPLICIT_DIAGONAL*dot_product(relaxation%slope, rates(1:6, i))
      do j = 1, i - 1
         change = change + IMPLICIT_WEIGHTS((i - 1)*(i - 2)/2 + j)*dot_product(relaxation%slope, rates(1:6, j))
      end do
      change = h*change/(1.0_wp + IMPLICIT_DIAGONAL*h*relaxation%speed)
      rates(:, i) = rates(:, i) + change*relaxation%flow
   end subroutine relax
end module mud_relaxation
