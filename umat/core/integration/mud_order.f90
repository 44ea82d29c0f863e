! SPDX-License-Identifier: MIT
!> Choice of the pair of the coming substep: with the scheme `automatic` modified Euler where one substep of it reaches
!> the end, otherwise the third order, linearly implicit where the rates are stiff; docs/theory/integration.md section
!> 2.
module mud_order
   use mud_consistent, only: linearise_stage
   use mud_cutoff, only: MODE_HELD
   use mud_increment, only: increment_t, void_ratio_at, changes_of_loading_strain
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_rates, only: MODE_ORDINARY
   use mud_registry, only: SCHEME_AUTOMATIC
   use mud_fluidity, only: growth
   use mud_relaxation, only: relaxation_speed, new_relaxation
   use mud_sensitivity, only: changes_of_rate
   use mud_substep, only: SECOND_ORDER, THIRD_ORDER, AS_SECOND_ORDER, LINEARLY_IMPLICIT, step_factor
   use mud_tensor, only: LANES, tensors_t, ZERO_TENSORS
   use mud_trial, only: trial_t, error_norm
   use mud_linearise, only: linearised_t, changes_t
   use mud_vector, only: NY, Y_SHEAR
   implicit none (type, external)
   private
   public :: choose_stepping, choose_order, next_size, LAST_SLIVER

   !> A substep is linearly implicit where the stiff direction would relax by more than this in it, as a rate: explicit
   !> pairs are unstable from 2 to 3.3 on. It remains so down to less [-].
   real(wp), parameter :: STIFF = 1.5_wp, NO_LONGER_STIFF = 0.7_wp
   type(tensors_t), parameter :: REST = tensors_t(0.0_wp, ZERO_TENSORS)
   !> A rest of this share joins the substep before it. A size that should be the whole rest may miss it by rounding,
   !> which must not choose the order [-].
   real(wp), parameter :: LAST_SLIVER = 1.0e-9_wp
   real(wp), parameter :: FEW_SUBSTEPS = 4.0_wp   !< So many more are explicit even where they are stiff [-].
contains
   !> Makes the coming substep linearly implicit where stability alone would keep explicit ones short. Only the scheme
   !> automatic does. Shares of inc [-]. docs/theory/integration.md section 2.1.
   pure subroutine choose_stepping(par, rest, h, inc, trial)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: rest, h     !< rest of the phase; the size that error control proposes
      type(increment_t), intent(inout) :: inc
      type(trial_t), intent(inout) :: trial   !< with its first rate
      real(wp) :: speed
      logical :: before

      if (par%scheme /= SCHEME_AUTOMATIC) return
      before = trial%relaxation%speed > 0.0_wp
      speed = 0.0_wp
      if (trial%mode == MODE_ORDINARY) speed = relaxation_speed(trial%w(1))
      trial%relaxation%speed = 0.0_wp
      if (speed*h > merge(NO_LONGER_STIFF, STIFF, before) .and. (before .or. rest > FEW_SUBSTEPS*h)) then
         call find_relaxation(par, inc, trial)
         if (trial%relaxation%speed > 0.0_wp) inc%scheme = LINEARLY_IMPLICIT
      end if
   end subroutine choose_stepping

   !> The explicit pair of the coming attempt with the scheme automatic: modified Euler if one substep of it reaches the
   !> end, otherwise the third order. A linearly implicit substep stays what it is. rest and h as in choose_stepping, h
   !> being a size of third order. docs/theory/integration.md section 2.
   pure subroutine choose_order(par, rest, h, share, inc, trial)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: rest, h
      real(wp), intent(in) :: share     !< par%second_share, 0: third order whatever the size [-]
      type(increment_t), intent(inout) :: inc
      type(trial_t), intent(in) :: trial

      if (par%scheme /= SCHEME_AUTOMATIC .or. trial%relaxation%speed > 0.0_wp) return
      if (share*h*(1.0_wp + LAST_SLIVER) >= rest) then
         if (inc%scheme%order /= SECOND_ORDER%order) inc%scheme = SECOND_ORDER
      else if (.not. inc%scheme%first_same_as_last) then
         inc%scheme = THIRD_ORDER
      end if
   end subroutine choose_order

   !> The size that an attempt h proposes for the next, as one of third order with the scheme automatic. Where one
   !> substep of third order did a whole increment or phase, and modified Euler would have done, it is the size that
   !> pair would propose. Shares of inc [-].
   pure real(wp) function next_size(par, inc, trial, h, factor, whole) result(size)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h, factor
      logical, intent(in) :: whole     !< h was accepted and is all of inc
      real(wp) :: error

      size = h*factor
      if (par%scheme /= SCHEME_AUTOMATIC .or. trial%mode == MODE_HELD .or. trial%closed) return
      if (inc%scheme%order == SECOND_ORDER%order) then
         size = size/par%second_share
      else if (whole .and. inc%scheme%first_same_as_last) then
         error = error_norm(par, AS_SECOND_ORDER, trial, h)
         size = max(size, step_factor(AS_SECOND_ORDER, error, par%tolerance, .true.)*h/par%second_share)
      end if
   end function next_size

   !> The stiff direction at the start of a substep.
   pure subroutine find_relaxation(par, inc, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(inout) :: trial
      type(linearised_t) :: lin
      type(changes_t) :: changes
      real(wp) :: y(LANES, NY), rates(LANES, NY), unmoved(LANES), of_fluidity
      integer :: j

      ! the strain rate is held
      unmoved = 0.0_wp
      changes%e = 0.0_wp
      changes%p_c = 0.0_wp
      changes%d_pc = 0.0_wp
      changes%scans = .false.
      call changes_of_loading_strain(inc, trial%mode, trial%time, REST, REST, unmoved, changes%loading)
      call linearise_stage(par, inc, trial%w(1), trial%y0, trial%time, void_ratio_at(inc, trial%time), &
                           changes%loading, lin)
      y = 0.0_wp
      do j = 1, 6
         y(j, j) = 1.0_wp
      end do
      call changes_of_rate(par, trial%w(1), lin, .false., y, REST, REST, REST, changes, .false., rates)
      of_fluidity = 0.0_wp
      if (par%fluid) of_fluidity = growth(par, trial%w(1)%fluid)
      trial%relaxation = new_relaxation(trial%w(1), rates(1:6, Y_SHEAR)/SQRT_2_3, of_fluidity)
   end subroutine find_relaxation
end module mud_order
