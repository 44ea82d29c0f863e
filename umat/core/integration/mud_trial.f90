! SPDX-License-Identifier: MIT
!> One trial substep: the scheme's stages and the error, or a step held by the tension cut-off.
module mud_trial
   use mud_kinds, only: wp
   use mud_cutoff, only: hold, MODE_HELD
   use mud_increment, only: increment_t, rate_of, store_rate
   use mud_inside_domain, only: has_closed_form, move_inside
   use mud_options, only: error_of_numbers
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_relaxation, only: relaxation_t, relax
   use mud_state, only: counters_t, interrupted_t
   use mud_substep, only: scheme_t, MAX_STAGES, stage_point, solution, error_vector
   use mud_tensor, only: norm
   use mud_transient, only: transient_t, take_fading, add_faded
   use mud_vector, only: NY, Y_Z, Y_Z_END, Y_SHEAR
   implicit none (type, external)
   private
   public :: trial_t, take_step, begin_stage, end_stage, end_stages, error_norm

   real(wp), parameter :: PLASTIC_SHEAR_SCALE = 0.01_wp   !< Scale of the plastic shear in the error norm [-].
   !> Errors of stresses below this share of p_atm count as if the stress were that large: 1e-5 of 0.1 kPa is nothing
   !> that a host could see, and costs thousands of rates an update [-].
   real(wp), parameter :: SMALL_STRESS = 0.01_wp

   !> A trial substep from one point.
   type :: trial_t
      real(wp) :: rates(NY, MAX_STAGES)
      real(wp) :: y0(NY), y(NY)
      real(wp) :: points(NY, 2:MAX_STAGES)   !< Where the stages beyond the first stand.
      type(rate_t) :: w(MAX_STAGES) !< Rates of the stages with all intermediate results; the first is that of the
                                    !< memory as it is.
      integer :: mode
      logical :: closed             !< Inside the domain, in closed form: of its stages only the first is set.
      logical :: pressed            !< The bounding surface was met inside the elastic domain: ordinary rates follow.
      real(wp) :: r_in(6)
      real(wp) :: time              !< Pseudo-time of y0 [-].
      logical :: advanced           !< The present process has had (r - r_in):n > 0: a reversal would end it.
      integer :: openings           !< Number of times that p' has fallen to p_min in this increment or phase.
      logical :: divides            !< A point was released or a process has drifted in this increment: the sizes of its
                                    !< substeps divide the rest.
      logical :: drifts             !< The present process has not gone forwards yet, drifts backwards, and takes its
                                    !< beginning along.
      type(relaxation_t) :: relaxation   !< Stiff direction of the rates, of speed 0 where the substep is explicit.
      type(transient_t) :: transient     !< Parts of the rates that fade; those in w are without them.
      real(wp) :: parts             !< Void ratio at which the grains of a held point part [-].
      real(wp) :: held_error        !< Error of a held substep's stress ratio [-].
      real(wp) :: e                 !< Void ratio at y0 [-].
      real(wp) :: past              !< A number of the memory beside y0, for options [-].
      real(wp) :: below             !< Margin of y0 to the memory of the isotropic mechanism; read where that rests [-].
      integer :: watched            !< The interrupted process whose target is looked for, 0: none.
      type(interrupted_t) :: process   !< The interrupted process of that number.
   end type trial_t
contains
   !> One trial substep from the first rate that the trial holds. h is a share of inc [-]. What is not finite stays in
   !> trial%y: it is looked at by integrate. docs/theory/integration.md section 2, held docs/theory/material.md section
   !> 6.2.
   pure subroutine take_step(par, inc, h, trial, counters)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: h
      type(trial_t), intent(inout) :: trial
      type(counters_t), intent(inout) :: counters
      real(wp) :: time
      integer :: i

      if (trial%mode == MODE_HELD) then
         trial%y = trial%y0
         call hold(par, inc, trial%parts, trial%time, h, trial%y(1:6), trial%held_error)
         trial%closed = .false.
         return
      end if
      trial%closed = has_closed_form(par, inc, trial%mode, trial%time, h, trial%y0(1:6))
      if (trial%closed) then
         trial%y = trial%y0
         call move_inside(par, inc, trial%time, h, trial%y)
         return
      end if
      call end_stage(1, trial%time, h, trial)
      do i = 2, inc%scheme%stages
         call begin_stage(inc, i, h, trial, time)
         call rate_of(par, inc, time, trial%points(:, i), trial%r_in, trial%mode, trial%w(i), counters, trial%w(1))
         call end_stage(i, time, h, trial)
      end do
      call end_stages(inc, h, trial)
   end subroutine take_step

   !> Place and time of a stage of a substep h.
   pure subroutine begin_stage(inc, i, h, trial, time)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: i
      real(wp), intent(in) :: h
      type(trial_t), intent(inout) :: trial
      real(wp), intent(out) :: time

      time = trial%time + inc%scheme%node(i)*h
      call stage_point(inc%scheme, i, trial%y0, trial%rates, h, trial%points(:, i))
      if (trial%transient%known) call add_faded(trial%transient, trial%time, time, trial%points(:, i))
   end subroutine begin_stage

   !> The rate of a stage is known.
   pure subroutine end_stage(i, time, h, trial)
      integer, intent(in) :: i
      real(wp), intent(in) :: time, h
      type(trial_t), intent(inout) :: trial

      call store_rate(trial%w(i), trial%rates(:, i))
      if (trial%transient%known) call take_fading(trial%transient, time, trial%rates(:, i))
      if (trial%relaxation%speed > 0.0_wp) call relax(trial%relaxation, h, trial%rates(:, 1:i))
   end subroutine end_stage

   !> The solution of a substep h, all of whose stages are known.
   pure subroutine end_stages(inc, h, trial)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: h
      type(trial_t), intent(inout) :: trial

      call solution(inc%scheme, trial%y0, trial%rates, h, trial%y)
      if (trial%transient%known) call add_faded(trial%transient, trial%time, trial%time + h, trial%y)
   end subroutine end_stages

   !> Relative error of a trial substep; the void ratio is exact. A held point's is that of its stress, p_min times its
   !> stress ratio. [-]; h is the size of the trial, a share of its increment. docs/theory/integration.md section 3.
   pure real(wp) function error_norm(par, scheme, trial, h) result(error)
      type(params_t), intent(in) :: par
      type(scheme_t), intent(in) :: scheme
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: h
      real(wp) :: delta(NY), smallest

      smallest = max(par%p_min, SMALL_STRESS*par%p_atm)
      if (trial%mode == MODE_HELD) then
         error = trial%held_error*par%p_min/smallest
         return
      end if
      error = 0.0_wp
      if (trial%closed) return
      call error_vector(scheme, trial%rates, h, delta)
      error = max(norm(delta(1:6))/max(norm(trial%y(1:6)), smallest), norm(delta(Y_Z:Y_Z_END))/par%flow%z_max, &
                  abs(delta(Y_SHEAR))/PLASTIC_SHEAR_SCALE, error_of_numbers(par, trial%y, delta, trial%w(1)%own%bends))
   end function error_norm
end module mud_trial
