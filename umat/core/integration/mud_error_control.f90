! SPDX-License-Identifier: MIT
!> Error that a substep may have, and the size of the next attempt; docs/theory/integration.md sections 3, 3.1.
module mud_error_control
   use mud_cutoff, only: MODE_HELD
   use mud_increment, only: increment_t
   use mud_kinds, only: wp
   use mud_params, only: params_t, STRICTNESS
   use mud_rate, only: rate_t
   use mud_rates, only: MODE_ORDINARY
   use mud_registry, only: SCHEME_AUTOMATIC
   use mud_substep, only: step_factor, THIRD_ORDER, SAFETY, SMALLEST_FACTOR, LARGEST_FACTOR
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: control_t, judge_attempt, proposal, changes_root

   !> Across a kink of the rates the estimate of third order misses a part of the error: this share of the tolerance
   !> again, but not below LEAST_ACROSS, where substeps would become shorter than their minimum [-].
   real(wp), parameter :: ACROSS_KINK = 0.3_wp, LEAST_ACROSS = 1.0e-11_wp
   !> An error that has fallen by less than this power of the size is that of a jump of the rates: of a smooth substep
   !> the power is the order, at least 2, and so it is across a kink [-].
   real(wp), parameter :: FIRST_ORDER = 1.5_wp
   !> So many jumps of an increment or phase are resolved to the tolerance. From then on the rates chatter between two
   !> roots of the direction equation, and each further jump doubles the tolerance of substeps with several roots, up to
   !> a limit [-].
   integer, parameter :: RESOLVED_JUMPS = 1
   real(wp), parameter :: GROWTH = 2.0_wp, LARGEST_GROWTH = 32.0_wp

   !> Knowledge of the attempts of an increment or phase.
   type :: control_t
      !> Error and size of the attempt before at this substep, 0: none; h a share of the increment [-].
      real(wp) :: error = 0.0_wp, h = 0.0_wp
      integer :: jumps = 0   !< attempts so far whose error was that of a jump
   end type control_t
contains
   !> The error that an attempt may have, and the factor on its size for the next one. h is a share of inc, all [-]. A
   !> jump inside a substep leaves an error that falls as its size does, whatever the order of the scheme.
   !> docs/theory/integration.md sections 3, 3.1.
   pure subroutine judge_attempt(par, inc, trial, h, error, may_grow, control, tolerance, factor)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(trial_t), intent(in) :: trial          !< after the attempt
      real(wp), intent(in) :: h, error
      logical, intent(in) :: may_grow             !< no attempt at this substep was rejected
      type(control_t), intent(inout) :: control
      real(wp), intent(out) :: tolerance, factor
      logical :: jump, changes, kink

      jump = .false.
      changes = .false.
      kink = .false.
      if (trial%mode /= MODE_HELD .and. .not. trial%closed) &
         call compare_stages(trial%w(1:inc%scheme%stages), changes, kink)
      changes = changes .and. trial%mode == MODE_ORDINARY .and. par%guarded
      if (.not. may_grow) jump = error > control%error*(h/control%h)**FIRST_ORDER
      if (jump .and. changes) control%jumps = control%jumps + 1
      control%error = error
      control%h = h

      tolerance = par%tolerance
      if (par%scheme == SCHEME_AUTOMATIC .and. inc%scheme%order == THIRD_ORDER%order .and. &
          trial%mode /= MODE_HELD .and. trial%relaxation%speed <= 0.0_wp) then
         tolerance = STRICTNESS*tolerance
         if (kink .and. .not. changes) &
            tolerance = max(ACROSS_KINK*tolerance, min(tolerance, LEAST_ACROSS))
      end if
      if (changes .and. control%jumps > RESOLVED_JUMPS) &
         tolerance = tolerance*min(GROWTH**min(control%jumps - RESOLVED_JUMPS, 100), LARGEST_GROWTH)
      factor = step_factor(inc%scheme, error, tolerance, may_grow)
      if (jump .and. error > tolerance) factor = max(SAFETY*tolerance/error, SMALLEST_FACTOR)
   end subroutine judge_attempt

   !> The first substep of the next increment, in units of strain, 0: all of it. The last substep ends where the
   !> increment does: where its error let it grow as far as a substep may, it says nothing against the step that was
   !> planned, and nothing at all where none was. A higher order's estimate sees less of what a long first step hides:
   !> its steps grow from what was taken. docs/theory/integration.md section 3.
   pure real(wp) function proposal(inc, planned, grown, factor)
      type(increment_t), intent(in) :: inc   !< With the scheme of its last substep.
      real(wp), intent(in) :: planned   !< Before the increment cut it short; 0: none [-]
      real(wp), intent(in) :: grown     !< By the last substep and its error [-]
      real(wp), intent(in) :: factor    !< Factor of that growth [-]

      proposal = grown
      if (factor < LARGEST_FACTOR .or. inc%scheme%order >= THIRD_ORDER%order) return
      proposal = max(planned, grown)
      if (planned <= 0.0_wp) proposal = 0.0_wp
   end function proposal

   !> Whether stages of a substep are at different roots of the direction equation, of which several are possible only
   !> between floor, cap and neither, and whether they stand on different sides of a kink of the rates: the floor, a
   !> cap, the isotropic mechanism. Stages as rate_t has them. docs/theory/integration.md section 3.1.
   pure subroutine compare_stages(w, several_roots, kink)
      type(rate_t), intent(in) :: w(:)
      logical, intent(out) :: several_roots, kink
      logical :: several, guard, mechanism
      integer :: i

      several = .false.
      guard = .false.
      mechanism = .false.
      do i = 1, size(w)
         several = several .or. w(i)%several
         guard = guard .or. (w(i)%floored .neqv. w(1)%floored) .or. (w(i)%capped_h .neqv. w(1)%capped_h) .or. &
                 (w(i)%capped_d .neqv. w(1)%capped_d)
         mechanism = mechanism .or. (w(i)%iso_active .neqv. w(1)%iso_active)
      end do
      several_roots = several .and. guard
      kink = guard .or. mechanism
   end subroutine compare_stages

   !> True where stages of a substep are at different roots of the direction equation. As in compare_stages.
   !> docs/theory/integration.md section 3.1.
   pure logical function changes_root(w)
      type(rate_t), intent(in) :: w(:)
      logical :: kink

      call compare_stages(w, changes_root, kink)
   end function changes_root
end module mud_error_control
