! SPDX-License-Identifier: MIT
!> Cyclic preloading (ours, an option): contraction that other loading processes have left keeps the present one from
!> contracting, and stiffens it; docs/theory/material.md section 4.9.
!>
!> With q = w x**2/chi' and g = q/(1 + q), chi' the contraction of others, contraction is multiplied by f = g**2 and the
!> hardening 1/h by f**s.
module mud_preloading
   use mud_branchless, only: positive
   use mud_kinds, only: wp
   use mud_params, only: preloading_law_t
   use mud_state, only: memory_t
   use mud_tensor, only: DIRECTIONS
   use mud_vector, only: NY, Y_OPTIONS
   implicit none (type, external)
   private
   public :: preloading_t, preloading_of, preload, log_contraction, note_contraction, contraction_error, &
             changes_of_contraction, jump_of_contraction, NO_CONTRACTION, Y_LOG_CHI, Y_CONTRACTION

   integer, parameter :: Y_LOG_CHI = Y_OPTIONS           !< ln of the contraction that other processes left [-]
   integer, parameter :: Y_CONTRACTION = Y_OPTIONS + 1   !< contraction since the substep began [-]
   real(wp), parameter :: CONTRACTION_SCALE = 0.01_wp    !< Scale of the contraction in the error norm [-].

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
      type(preloading_law_t), intent(in) :: par
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

   !> Books an accepted substep with a plastic contraction of `grown` by which ln chi' has changed by `lost`. What is
   !> contraction of the present process comes before what dilation takes from all, or after: where D changes its sign
   !> both are small. All [-]; docs/theory/material.md section 4.9.
   pure subroutine note_contraction(lost, grown, memory)
      real(wp), intent(in) :: lost, grown
      type(memory_t), intent(inout) :: memory
      real(wp) :: kept, more

      kept = exp(min(lost, 0.0_wp))
      more = max(grown, 0.0_wp)   ! where nothing contracts the weights of a scheme may leave rounding of either sign
      memory%chi = memory%chi*kept + more
      memory%chi_own = min(memory%chi_own*kept + more, memory%chi)
   end subroutine note_contraction

   !> Error of ln chi' and of the contraction beside the tolerance [-].
   pure real(wp) function contraction_error(log_chi, contraction) result(error)
      real(wp), intent(in) :: log_chi, contraction

      error = max(abs(log_chi), abs(contraction)/CONTRACTION_SCALE)
   end function contraction_error

   !> Derivatives of what a substep from log_chi0 to log_chi leaves of the contraction of the present process.
   !> Derivative of note_contraction.
   pure function changes_of_contraction(log_chi0, log_chi, own, d_own, d_log_chi0, y) result(changes)
      real(wp), intent(in) :: log_chi0, log_chi
      real(wp), intent(in) :: own                           !< before it [-]
      real(wp), intent(in) :: d_own(DIRECTIONS), d_log_chi0(DIRECTIONS)   !< derivatives before it
      real(wp), intent(in) :: y(DIRECTIONS, NY)                  !< derivatives of the vector at its end
      real(wp) :: changes(DIRECTIONS)

      changes = exp(min(log_chi - log_chi0, 0.0_wp))*(d_own + own*(y(:, Y_LOG_CHI) - d_log_chi0)) + y(:, Y_CONTRACTION)
   end function changes_of_contraction

   !> Derivatives of the contraction across a jump of the memory from `before` to `after`: a process begins, resumes, or
   !> all is forgotten. One that is interrupted and resumed within the increment resumes with what it had then: nearly
   !> always it began before the increment.
   pure subroutine jump_of_contraction(begins, resumes, before, after, own, log_chi)
      logical, intent(in) :: begins, resumes
      type(memory_t), intent(in) :: before, after
      real(wp), intent(inout) :: own(DIRECTIONS), log_chi(DIRECTIONS)
      real(wp) :: all(DIRECTIONS), others

      others = before%chi - before%chi_own
      all = own + others*log_chi
      own = 0.0_wp
      if (resumes) then
         if (before%interrupted(after%depth + 1)%chi >= before%chi) own = all
      else if (.not. begins) then
         all = 0.0_wp
      end if
      log_chi = 0.0_wp
      others = after%chi - after%chi_own
      if (others > exp(NO_CONTRACTION)) log_chi = (all - own)/others
   end subroutine jump_of_contraction
end module mud_preloading
