! SPDX-License-Identifier: MIT
!> Whether the coming substep is explicit or linearly implicit; docs/theory/integration.md section 2.1.
module mud_stiffness
   use mud_consistent, only: linearise_stage
   use mud_increment, only: increment_t, void_ratio_at, turning_t, turning_of, changes_of_loading_strain
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_rates, only: MODE_ORDINARY
   use mud_registry, only: RULE_AS_PUBLISHED
   use mud_relaxation, only: relaxation_t, relaxation_speed, new_relaxation
   use mud_sensitivity, only: changes_t, linearised_t, changes_of_rate, NRATES
   use mud_substep, only: SCHEMES, HIGHER_ORDER, LINEARLY_IMPLICIT
   use mud_tensor, only: LANES, tensors_t, ZERO_TENSORS
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: choose_stepping, raise_order

   !> A substep is linearly implicit where the stiff direction would relax by more than this in it, as a rate: explicit
   !> pairs are unstable from 2 to 3.3 on. It remains so down to less [-].
   real(wp), parameter :: STIFF = 1.5_wp, NO_LONGER_STIFF = 0.7_wp
   type(tensors_t), parameter :: REST = tensors_t(0.0_wp, ZERO_TENSORS)
   real(wp), parameter :: FEW_SUBSTEPS = 4.0_wp   !< So many more are explicit even where they are stiff [-].
contains
   !> Makes the coming substep linearly implicit where stability alone would keep explicit ones short, and explicit
   !> again where it would not. The rule as_published keeps its scheme. Shares of inc [-]. docs/theory/integration.md
   !> section 2.1.
   pure subroutine choose_stepping(par, rest, h, inc, trial)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: rest, h     !< what is left; the size that error control proposes
      type(increment_t), intent(inout) :: inc
      type(trial_t), intent(inout) :: trial   !< with its first rate
      real(wp) :: speed
      logical :: before

      before = trial%relaxation%speed > 0.0_wp
      speed = 0.0_wp
      if (trial%mode == MODE_ORDINARY .and. par%memory_rule /= RULE_AS_PUBLISHED) speed = relaxation_speed(trial%w(1))
      trial%relaxation%speed = 0.0_wp
      if (speed*h > merge(NO_LONGER_STIFF, STIFF, before) .and. (before .or. rest > FEW_SUBSTEPS*h)) then
         call find_relaxation(par, inc, trial)
         if (trial%relaxation%speed > 0.0_wp) inc%scheme = LINEARLY_IMPLICIT
      end if
      if (before .and. trial%relaxation%speed <= 0.0_wp) then
         inc%scheme = SCHEMES(par%scheme)
         call raise_order(par, inc)
      end if
   end subroutine choose_stepping

   !> The stiff direction at the start of a substep.
   pure subroutine find_relaxation(par, inc, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(inout) :: trial
      type(linearised_t) :: lin
      type(changes_t) :: changes
      type(turning_t) :: turning
      real(wp) :: y(LANES, NRATES), rates(LANES, NRATES), unmoved(LANES)
      integer :: j

      turning = turning_of(inc, trial%mode, trial%time)
      ! the strain rate is held
      unmoved = 0.0_wp
      changes%e = 0.0_wp
      changes%p_c = 0.0_wp
      changes%d_pc = 0.0_wp
      changes%scans = .false.
      call changes_of_loading_strain(inc, trial%mode, turning, REST, REST, unmoved, changes%loading)
      call linearise_stage(par, inc, trial%w(1), trial%y0, trial%time, void_ratio_at(inc, trial%time), &
                           changes%loading, lin)
      y = 0.0_wp
      do j = 1, 6
         y(j, j) = 1.0_wp
      end do
      call changes_of_rate(par, trial%w(1), lin, .false., y, REST, REST, REST, changes, .false., rates)
      trial%relaxation = new_relaxation(trial%w(1), rates(1:6, 13)/SQRT_2_3)
   end subroutine find_relaxation

   !> Modified Euler becomes the higher order for the rest of the increment or phase; the rule as_published keeps it.
   !> docs/theory/integration.md section 2.
   pure subroutine raise_order(par, inc)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc

      if (inc%scheme%order < HIGHER_ORDER%order .and. par%memory_rule /= RULE_AS_PUBLISHED) inc%scheme = HIGHER_ORDER
   end subroutine raise_order
end module mud_stiffness
