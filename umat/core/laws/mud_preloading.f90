! SPDX-License-Identifier: MIT
!> Cyclic preloading (ours, an option): contraction that other loading processes have left keeps the present one from
!> contracting, and stiffens it; docs/theory/material.md section 4.9.
!>
!> With q = w x**2/chi' and g = q/(1 + q), chi' the contraction of others, contraction is multiplied by f = g**2 and the
!> hardening 1/h by f**s.
module mud_preloading
   use mud_branchless, only: positive
   use mud_kinds, only: wp
   use mud_params, only: params_t
   implicit none (type, external)
   private
   public :: preloading_t, preloading_of, preload, log_contraction, NO_CONTRACTION

   !> ln of a contraction that has no effect: beside it any other sum is what it is without [-].
   real(wp), parameter :: NO_CONTRACTION = -600.0_wp

   !> Parts of cyclic preloading that are the same in every direction.
   type :: preloading_t
      real(wp) :: chi      !< chi' > 0, contraction of other processes [-]
      real(wp) :: virgin   !< w = 2 c_chi v/x**2, v what a virgin process contracts up to x [-]
      real(wp) :: s        !< [-]
   end type preloading_t
contains
   !> Cyclic preloading by the contraction chi of other processes, with ratio = M^d/M^b, A_0 and b_0 = h x > 0. All [-];
   !> nothing is checked. docs/theory/material.md section 4.9.
   pure function preloading_of(par, chi, ratio, a_0, b_0) result(preloading)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: chi, ratio, a_0, b_0
      type(preloading_t) :: preloading

      preloading%chi = chi
      preloading%virgin = 1.5_wp*par%c_chi*a_0*ratio/b_0
      preloading%s = par%s_chi
   end function preloading_of

   !> Lowers D and 1/h at (r - r_in):n = x, not below its floor, to what preloading leaves of them; f, and d ln f/d ln
   !> q: df/dx is slope f 2/x. All [-]; docs/theory/material.md section 4.9.
   pure subroutine preload(preloading, x, d, h_b, f, slope)
      type(preloading_t), intent(in) :: preloading
      real(wp), intent(in) :: x
      real(wp), intent(inout) :: d, h_b
      real(wp), intent(out) :: f, slope
      real(wp) :: q_chi, g

      q_chi = preloading%virgin*x*x   ! q chi'
      g = q_chi/(q_chi + preloading%chi)
      d = g*g*positive(d) - positive(-d)
      h_b = g**(2.0_wp*preloading%s)*h_b
      f = g*g
      slope = 2.0_wp*preloading%chi/(q_chi + preloading%chi)
   end subroutine preload

   !> ln of the contraction that other processes have left, of what all of them and the present one have [-].
   pure real(wp) function log_contraction(chi, chi_own) result(log_chi)
      real(wp), intent(in) :: chi, chi_own

      log_chi = NO_CONTRACTION
      if (chi - chi_own > exp(NO_CONTRACTION)) log_chi = log(chi - chi_own)
   end function log_contraction
end module mud_preloading
