! SPDX-License-Identifier: MIT
!> The stiff direction at the start of a substep: the slope of the loading index there; docs/theory/integration.md
!> section 2.1.
module mud_stiff_direction
   use mud_consistent, only: linearise_stage
   use mud_increment, only: increment_t, void_ratio_at
   use mud_kinds, only: wp, SQRT_2_3
   use mud_linearise, only: linearised_t, changes_t
   use mud_loading_changes, only: changes_of_loading_strain
   use mud_options, only: rates_of_numbers
   use mud_params, only: params_t
   use mud_relaxation, only: new_relaxation
   use mud_sensitivity, only: changes_of_rate
   use mud_substep, only: LINEARLY_IMPLICIT
   use mud_tensor, only: DIRECTIONS, tensors_t, ZERO_TENSORS
   use mud_trial, only: trial_t
   use mud_vector, only: NY, Y_SHEAR, N_OPTIONS
   implicit none (type, external)
   private
   public :: make_implicit

   type(tensors_t), parameter :: REST = tensors_t(0.0_wp, ZERO_TENSORS)
contains
   !> Makes the coming substep linearly implicit, from its first rate. Units as in trial_t. docs/theory/integration.md
   !> section 2.1.
   pure subroutine make_implicit(par, inc, trial)
      type(params_t), intent(in) :: par
      type(increment_t), intent(inout) :: inc
      type(trial_t), intent(inout) :: trial
      type(linearised_t) :: lin
      type(changes_t) :: changes
      real(wp) :: y(DIRECTIONS, NY), rates(DIRECTIONS, NY), unmoved(DIRECTIONS), own(N_OPTIONS)
      integer :: j

      ! the strain rate is held
      unmoved = 0.0_wp
      changes%e = 0.0_wp
      changes%p_c = 0.0_wp
      changes%d_pc = 0.0_wp
      changes%scans = .false.
      call changes_of_loading_strain(inc, trial%mode, trial%time, REST, REST, unmoved, changes%loading)
      call linearise_stage(par, inc, trial%w(1), trial%y0, trial%time, void_ratio_at(inc, trial%time), &
                           changes%loading, .false., lin)
      y = 0.0_wp
      do j = 1, 6
         y(j, j) = 1.0_wp
      end do
      call changes_of_rate(par, trial%w(1), lin, .false., y, REST, REST, REST, changes, .false., rates)
      call rates_of_numbers(par, 1.0_wp, trial%w(1)%d, trial%w(1)%own, own)
      trial%relaxation = new_relaxation(trial%w(1), rates(1:6, Y_SHEAR)/SQRT_2_3, own)
      if (trial%relaxation%speed > 0.0_wp) inc%scheme = LINEARLY_IMPLICIT
   end subroutine make_implicit
end module mud_stiff_direction
