! SPDX-License-Identifier: MIT
!> The slots in which options act on rates and on the integrated vector. An option is a file of this folder, with its
!> places in the vector, its rates and their derivatives, and its lines here; what is off costs a question.
module mud_options
   use mud_fluidity, only: fluidity_t, Y_FLUIDITY, fluidity_at, growth, growth_changes, recovery, recovered, &
      recovered_changes, recovery_changes
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_preloading, only: bend_t => preloading_t, preloading_of, bend => preload, log_contraction, &
      note_contraction, contraction_error, jump_of_contraction, changes_of_contraction, NO_CONTRACTION, Y_LOG_CHI, &
      Y_CONTRACTION
   use mud_state, only: state_t, memory_t
   use mud_tensor, only: DIRECTIONS
   use mud_vector, only: NY, Y_OPTIONS, Y_SHEAR
   implicit none (type, external)
   private
   public :: of_options_t, live_numbers, new_numbers, begin_numbers, keep_numbers, error_of_numbers, &
             look_at_numbers, rates_of_numbers, add_volume_rates, move_numbers
   !> A bend of D and 1/h with (r - r_in):n, the same in every direction, is that of the one option that bends.
   public :: bend_t, bend_of, bend, bend_of_hardening, changes_of_bend
   public :: past_counts, take_past, forget_past, new_past, begin_past, interrupt_past, resume_past
   public :: past_changes_t, no_past_changes, begin_past_changes, keep_past_changes, jump_of_past
   public :: softens, changes_of_softening, changes_of_flow, changes_of_numbers, add_volume_changes, changes_of_moved

   !> Effects of the options on a rate; what is off is not set.
   type :: of_options_t
      type(fluidity_t) :: fluidity
      logical :: bends   !< D and 1/h are bent with (r - r_in):n: other processes have left contraction.
      real(wp) :: chi    !< Contraction of other processes, if so [-].
   end type of_options_t

   !> Derivatives of the numbers of the memory beside the vector.
   type :: past_changes_t
      real(wp) :: own(DIRECTIONS)    !< derivatives of the contraction of the present process
      real(wp) :: log_0(DIRECTIONS)  !< derivatives of ln chi' where the substep began
   end type past_changes_t
contains
   !> Number of entries of the integrated vector that may change: those of options that are off stand last. Y_SHEAR
   !> where no option has any.
   pure integer function live_numbers(par) result(n)
      type(params_t), intent(in) :: par

      n = Y_SHEAR
      if (par%preloading) n = Y_CONTRACTION
      if (par%fluid) n = Y_FLUIDITY
   end function live_numbers

   !> Numbers of a point without a past [-].
   pure subroutine new_numbers(state)
      type(state_t), intent(inout) :: state

      state%fluidity = 0.0_wp
   end subroutine new_numbers

   !> Numbers of the vector where a substep begins, but for what the memory says [-].
   pure subroutine begin_numbers(state, y)
      type(state_t), intent(in) :: state
      real(wp), intent(inout) :: y(NY)

      y(Y_OPTIONS:) = 0.0_wp
      y(Y_FLUIDITY) = state%fluidity
   end subroutine begin_numbers

   !> Numbers of the vector that the memory says, where a process begins or goes on, and what it says beside [-].
   pure subroutine take_past(par, memory, y, own)
      type(params_t), intent(in) :: par
      type(memory_t), intent(in) :: memory
      real(wp), intent(inout) :: y(NY)
      real(wp), intent(out) :: own

      own = memory%chi_own
      if (par%preloading) y(Y_LOG_CHI) = log_contraction(memory%chi, memory%chi_own)
   end subroutine take_past

   !> True where the rate of a process that begins depends on those before it.
   pure logical function past_counts(par)
      type(params_t), intent(in) :: par

      past_counts = par%preloading
   end function past_counts

   !> The numbers of a memory without a past, of a process that begins, is interrupted last, or goes on as number k [-].
   pure subroutine new_past(memory)
      type(memory_t), intent(inout) :: memory

      memory%chi = 0.0_wp
      memory%chi_own = 0.0_wp
   end subroutine new_past

   !> See new_past.
   pure subroutine begin_past(memory)
      type(memory_t), intent(inout) :: memory

      memory%chi_own = 0.0_wp
   end subroutine begin_past

   !> See new_past.
   pure subroutine interrupt_past(memory)
      type(memory_t), intent(inout) :: memory

      memory%interrupted(memory%depth)%chi = memory%chi_own
   end subroutine interrupt_past

   !> See new_past.
   pure subroutine resume_past(k, memory)
      integer, intent(in) :: k
      type(memory_t), intent(inout) :: memory

      memory%chi_own = min(memory%interrupted(k)%chi, memory%chi)
   end subroutine resume_past

   !> Derivatives of a past that does not depend on the increment yet.
   pure subroutine no_past_changes(past)
      type(past_changes_t), intent(inout) :: past

      past%own = 0.0_wp
   end subroutine no_past_changes

   !> A substep begins: its derivatives are those of its own changes.
   pure subroutine begin_past_changes(y, past)
      real(wp), intent(inout) :: y(DIRECTIONS, NY)
      type(past_changes_t), intent(inout) :: past

      past%log_0 = y(:, Y_LOG_CHI)
      y(:, Y_CONTRACTION) = 0.0_wp
   end subroutine begin_past_changes

   !> Derivatives of what a substep from y0 to y1 leaves; own is that of take_past.
   pure subroutine keep_past_changes(par, y0, y1, own, y, past)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: y0(NY), y1(NY), own, y(DIRECTIONS, NY)
      type(past_changes_t), intent(inout) :: past

      if (par%preloading) past%own = changes_of_contraction(y0(Y_LOG_CHI), y1(Y_LOG_CHI), own, past%own, past%log_0, y)
   end subroutine keep_past_changes

   !> Derivatives across a jump of the memory, in which a process begins, resumes, or all is forgotten.
   pure subroutine jump_of_past(par, begins, resumes, before, after, y, past)
      type(params_t), intent(in) :: par
      logical, intent(in) :: begins, resumes
      type(memory_t), intent(in) :: before, after
      real(wp), intent(inout) :: y(DIRECTIONS, NY)
      type(past_changes_t), intent(inout) :: past

      if (par%preloading) call jump_of_contraction(begins, resumes, before, after, past%own, y(:, Y_LOG_CHI))
   end subroutine jump_of_past

   !> Numbers of the vector of a point without a past [-].
   pure subroutine forget_past(y)
      real(wp), intent(inout) :: y(NY)

      y(Y_LOG_CHI) = NO_CONTRACTION
   end subroutine forget_past

   !> The state keeps what a substep from y0 to y leaves.
   pure subroutine keep_numbers(par, y0, y, state)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: y0(NY), y(NY)
      type(state_t), intent(inout) :: state

      ! a scheme's weights may leave rounding of either sign
      if (par%fluid) state%fluidity = min(max(y(Y_FLUIDITY), 0.0_wp), par%fluidity%ell_max)
      if (par%preloading) call note_contraction(y(Y_LOG_CHI) - y0(Y_LOG_CHI), y(Y_CONTRACTION), state%memory)
   end subroutine keep_numbers

   !> Error of a substep to y with the error vector delta, as a number beside the tolerance [-].
   !> docs/theory/integration.md section 3.
   pure real(wp) function error_of_numbers(par, y, delta, bends) result(error)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: y(NY), delta(NY)
      logical, intent(in) :: bends   !< at the first rate: in first loading nothing follows the contraction

      error = 0.0_wp
      if (par%fluid) error = abs(delta(Y_FLUIDITY))/(1.0_wp + y(Y_FLUIDITY))
      if (bends) error = max(error, contraction_error(delta(Y_LOG_CHI), delta(Y_CONTRACTION)))
   end function error_of_numbers

   !> Effects at a mean stress [kPa]; A_0 and b_0 are lowered. docs/theory/material.md sections 4.9, 4.11.
   pure subroutine look_at_numbers(par, y, p, a_0, b_0, own)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: y(NY), p
      real(wp), intent(inout) :: a_0, b_0
      type(of_options_t), intent(inout) :: own

      own%bends = .false.
      if (par%preloading) own%bends = y(Y_LOG_CHI) > NO_CONTRACTION
      if (own%bends) own%chi = exp(y(Y_LOG_CHI))
      if (.not. par%fluid) return
      own%fluidity = fluidity_at(par%fluidity, y(Y_FLUIDITY), p)
      a_0 = own%fluidity%factor*a_0
      b_0 = own%fluidity%factor*b_0
   end subroutine look_at_numbers

   !> The bend of a rate that bends, with ratio = M^d/M^b, A_0 and b_0 [-]. docs/theory/material.md section 4.9.
   pure function bend_of(par, own, ratio, a_0, b_0) result(with_x)
      type(params_t), intent(in) :: par
      type(of_options_t), intent(in) :: own
      real(wp), intent(in) :: ratio, a_0, b_0
      type(bend_t) :: with_x

      with_x = preloading_of(par%preload, own%chi, ratio, a_0, b_0)
   end function bend_of

   !> d ln(1/h)/d ln q of that slope [-].
   pure real(wp) function bend_of_hardening(par, slope)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: slope

      bend_of_hardening = par%preload%s_chi*slope
   end function bend_of_hardening

   !> Changes of ln q at constant x with those of ln(M^d/(M^b b_0)) and the vector [-].
   pure function changes_of_bend(of_terms, y) result(changes)
      real(wp), intent(in) :: of_terms(DIRECTIONS), y(DIRECTIONS, NY)
      real(wp) :: changes(DIRECTIONS)

      changes = of_terms - y(:, Y_LOG_CHI)
   end function changes_of_bend

   !> True where an option lowers A_0 and b_0.
   pure logical function softens(par)
      type(params_t), intent(in) :: par

      softens = par%fluid
   end function softens

   !> Changes of ln of the factor on A_0 and b_0, where they are lowered, with p' [kPa] and the vector [-].
   pure function changes_of_softening(own, dp, y) result(changes)
      type(of_options_t), intent(in) :: own
      real(wp), intent(in) :: dp(DIRECTIONS), y(DIRECTIONS, NY)
      real(wp) :: changes(DIRECTIONS)

      changes = own%fluidity%by_p*dp + own%fluidity%by_ell*y(:, Y_FLUIDITY)
   end function changes_of_softening

   !> Rates of the numbers by a loading index L and a dilatancy D [-]. docs/theory/material.md sections 4.9, 4.11.
   pure subroutine rates_of_numbers(par, l, d, own, rates)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: l, d
      type(of_options_t), intent(in) :: own
      real(wp), intent(out) :: rates(Y_OPTIONS:NY)

      rates = 0.0_wp
      if (par%fluid) rates(Y_FLUIDITY) = l*growth(par%fluidity, own%fluidity)
      if (.not. par%preloading) return
      if (d < 0.0_wp) then
         rates(Y_LOG_CHI) = par%preload%zeta_chi*l*d
      else
         rates(Y_CONTRACTION) = l*d
      end if
   end subroutine rates_of_numbers

   !> Changes of these rates with L, L D, p' [kPa] and the vector.
   pure subroutine changes_of_numbers(par, l, d, own, dl, flow, dp, y, rates)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: l, d
      type(of_options_t), intent(in) :: own
      real(wp), intent(in) :: dl(DIRECTIONS), flow(DIRECTIONS), dp(DIRECTIONS), y(DIRECTIONS, NY)
      real(wp), intent(inout) :: rates(DIRECTIONS, NY)   !< rates of the options are set where they act

      if (par%preloading) then
         if (d < 0.0_wp) then
            rates(:, Y_LOG_CHI) = par%preload%zeta_chi*flow
         else
            rates(:, Y_CONTRACTION) = flow
         end if
      end if
      if (par%fluid) rates(:, Y_FLUIDITY) = growth_changes(par%fluidity, own%fluidity, l, dl, dp, y)
   end subroutine changes_of_numbers

   !> Changes of L D times a number, from those of the rates, where contraction or dilation is a rate of an option.
   pure function changes_of_flow(d, rates) result(changes)
      real(wp), intent(in) :: d, rates(DIRECTIONS, NY)
      real(wp) :: changes(DIRECTIONS)

      changes = rates(:, Y_CONTRACTION)
      if (d < 0.0_wp) changes = rates(:, Y_LOG_CHI)
   end function changes_of_flow

   !> Adds the rates by a change of volume d_v, without shear [-]. docs/theory/material.md section 4.11.
   pure subroutine add_volume_rates(par, d_v, y, rates)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v, y(NY)
      real(wp), intent(inout) :: rates(Y_OPTIONS:NY)

      if (par%fluid) rates(Y_FLUIDITY) = rates(Y_FLUIDITY) - recovery(par%fluidity, d_v)*y(Y_FLUIDITY)
   end subroutine add_volume_rates

   !> Adds the changes of these rates at a point of the vector; d_v changes by dv [-].
   pure subroutine add_volume_changes(par, d_v, point, y, dv, rates)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v, point(NY), y(DIRECTIONS, NY), dv(DIRECTIONS)
      real(wp), intent(inout) :: rates(DIRECTIONS, NY)

      if (par%fluid) &
         rates(:, Y_FLUIDITY) = rates(:, Y_FLUIDITY) - recovery_changes(par%fluidity, d_v, point(Y_FLUIDITY), y, dv)
   end subroutine add_volume_changes

   !> Moves the numbers over a share h of a change of volume d_v without shear [-]. docs/theory/memory-rules.md
   !> section 4.3.
   pure subroutine move_numbers(par, d_v, h, y)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v, h
      real(wp), intent(inout) :: y(NY)

      if (par%fluid) y(Y_FLUIDITY) = recovered(par%fluidity, d_v, h, y(Y_FLUIDITY))
   end subroutine move_numbers

   !> Changes over that way, which begins at y0; h changes by dh, d_v by dv [-].
   pure subroutine changes_of_moved(par, d_v, h, y0, dh, dv, y)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: d_v, h, y0(NY), dh(DIRECTIONS), dv(DIRECTIONS)
      real(wp), intent(inout) :: y(DIRECTIONS, NY)

      if (par%fluid) y(:, Y_FLUIDITY) = recovered_changes(par%fluidity, d_v, h, y0(Y_FLUIDITY), y, dh, dv)
   end subroutine changes_of_moved
end module mud_options
