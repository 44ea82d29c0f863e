! SPDX-License-Identifier: MIT
!> Choice of the pair of the coming substep: with the scheme `automatic` modified Euler where one substep of it reaches
!> the end, otherwise the third order, linearly implicit where the rates are stiff; docs/theory/integration.md section
!> 2.
module mud_order
   use mud_cutoff, only: MODE_HELD
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rates, only: MODE_ORDINARY
   use mud_registry, only: SCHEME_AUTOMATIC
   use mud_relaxation, only: relaxation_speed
   use mud_substep, only: SECOND_ORDER, THIRD_ORDER, AS_SECOND_ORDER, step_factor
   use mud_trial, only: trial_t, error_norm
   implicit none (type, external)
   private
   public :: look_for_stiffness, choose_order, next_size, LAST_SLIVER

   !> A substep is linearly implicit where the stiff direction would relax by more than this in it, as a rate: explicit
   !> pairs are unstable from 2 to 3.3 on. It remains so down to less [-].
   real(wp), parameter :: STIFF = 1.5_wp, NO_LONGER_STIFF = 0.7_wp
   !> A rest of this share joins the substep before it. A size that should be the whole rest may miss it by rounding,
   !> which must not choose the order [-].
   real(wp), parameter :: LAST_SLIVER = 1.0e-9_wp
   real(wp), parameter :: FEW_SUBSTEPS = 4.0_wp   !< So many more are explicit even where they are stiff [-].
contains
   !> Whether stability alone would keep the explicit pairs of the coming substep short: then it is made linearly
   !> implicit, by mud_stiff_direction. Only the scheme automatic does. Shares of inc [-]. docs/theory/integration.md
   !> section 2.1.
   pure subroutine look_for_stiffness(par, rest, h, trial, found)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: rest, h     !< rest of the phase; the size that error control proposes
      type(trial_t), intent(inout) :: trial   !< with its first rate
      logical, intent(out) :: found
      real(wp) :: speed
      logical :: before

      found = .false.
      if (par%scheme /= SCHEME_AUTOMATIC) return
      before = trial%relaxation%speed > 0.0_wp
      speed = 0.0_wp
      if (trial%mode == MODE_ORDINARY) speed = relaxation_speed(trial%w(1))
      trial%relaxation%speed = 0.0_wp
      found = speed*h > merge(NO_LONGER_STIFF, STIFF, before) .and. (before .or. rest > FEW_SUBSTEPS*h)
   end subroutine look_for_stiffness

   !> The explicit pair of the coming attempt with the scheme automatic: modified Euler if one substep of it reaches the
   !> end, otherwise the third order. A linearly implicit substep stays what it is. rest and h are those of
   !> look_for_stiffness, h being a size of third order. docs/theory/integration.md section 2.
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
end module mud_order
