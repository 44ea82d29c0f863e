! SPDX-License-Identifier: MIT
!> Error that a step makes by itself, from the rates at its ends and those before.
!>
!> Generalised-alpha stores rates that belong not to the ends of a step but to a moment D dt off, with D = l_f - l_a for
!> accelerations and l_f - l_p for first-order rates. Where a controlled step of a flow changes, the stored rates are
!> moved there first: so second order is kept. Given steps leave them where they are. Accelerations stay as they are:
!> what their change of place errs by is of third order, and to extrapolate them would multiply the jumps of a contact.
!>
!> The leading error of a step is C dt**3 times the third derivative, C = 1/12 + 3/8 D**2 for accelerations and
!> 1/12 + D**2 for first-order rates (the phase error and the error of the decay that the principal
!> root accumulates; a test holds both against the amplification matrix).
!> docs/theory/host.md section 4.5.
module error_norms
   use archive, only: archive_t
   use kinds, only: wp
   use generalised_alpha, only: scheme_t
   use porous_domain, only: model_state_t, OUTFLOWS
   use step_control, only: LARGEST_FACTOR
   use unknown_fields, only: FIELDS, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: rate_memory_t, new_memory, exchange_memory, shift_rates, restore_rates, local_errors, remember, &
             constant_of_accelerations, constant_of_rates

   real(wp), parameter :: BENT = 1.0_wp/12   !< Mean deviation of a bent path from the straight step, of dt**2 x''.

   !> Rates of a state: of the unknowns, of saturation, and the flows out of the ground, which move as rates do.
   type :: rates_t
      real(wp), allocatable :: v(:, :), s(:)   !< (FIELDS, nodes) [m/s, kPa/s], (points) [1/s]
      real(wp) :: outflow(OUTFLOWS) = 0.0_wp   !< [m3/s]
   end type rates_t

   !> Rates one step back.
   type :: rate_memory_t
      logical :: known = .false.   !< There are such rates, with nothing sudden since.
      real(wp) :: dt = 0.0_wp      !< Step from them to the present ones, which both belong to [s].
      type(rates_t) :: before
      !> The present ones as the last step left them, where they are `based`: attempts of different length move them
      !> from here.
      type(rates_t) :: base
      logical :: based = .false.
   end type rate_memory_t
contains
   !> Makes a memory that has no rates of earlier steps.
   pure function new_memory(nodes, points) result(memory)
      integer, intent(in) :: nodes, points
      type(rate_memory_t) :: memory

      allocate (memory%before%v(FIELDS, nodes), memory%before%s(points), source=0.0_wp)
   end function new_memory

   !> Exchanges a memory, made by new_memory, with an archive.
   subroutine exchange_memory(memory, archive)
      type(rate_memory_t), intent(inout) :: memory
      class(archive_t), intent(inout) :: archive

      call archive%exchange('rates_known', memory%known, &
                            'rates of the step before are known, with nothing sudden since')
      call archive%exchange('rates_dt', memory%dt, 's', 'step from those rates to the present ones')
      call archive%exchange('rate', memory%before%v, 'm/s, kPa/s', 'rates of the unknowns one step back')
      call archive%exchange('s_rate', memory%before%s, '1/s', 'rates of saturation one step back')
      call archive%exchange('outflow', memory%before%outflow, 'm3/s', 'flows out of the ground one step back')
   end subroutine exchange_memory

   !> Finds C of the leading error of a step for accelerations [-], 1/12 + 3/8 (l_a - l_f)**2: docs/theory/host.md
   !> section 4.5. For rho_inf = 1 it is that of Zienkiewicz & Xie (1991).
   pure real(wp) function constant_of_accelerations(scheme) result(c)
      type(scheme_t), intent(in) :: scheme

      c = 1.0_wp/12 + 0.375_wp*(scheme%l_a - scheme%l_f)**2
   end function constant_of_accelerations

   !> Finds C of the leading error of a step for first-order rates [-], 1/12 + (l_p - l_f)**2: docs/theory/host.md
   !> section 4.5.
   pure real(wp) function constant_of_rates(scheme) result(c)
      type(scheme_t), intent(in) :: scheme

      c = 1.0_wp/12 + (scheme%l_p - scheme%l_f)**2
   end function constant_of_rates

   !> Moves the rates of the present state to where a step of another length expects them. docs/theory/host.md section
   !> 4.5. No rate is carried over a longer step than the control lets one grow to. Rates stay in static steps and where
   !> none are known from before; in dynamic steps those of the displacements stay.
   pure subroutine shift_rates(scheme, memory, state)
      type(scheme_t), intent(in) :: scheme   !< Scheme of the step to come.
      type(rate_memory_t), intent(inout) :: memory
      type(model_state_t), intent(inout) :: state
      real(wp) :: share
      integer :: first

      if (.not. memory%based) memory%base = rates_t(state%v, state%s_rate, state%outflow)
      memory%based = .true.
      if (.not. scheme%has_rates .or. .not. memory%known) return
      associate (base => memory%base, before => memory%before)
         first = merge(DISPLACEMENTS + 1, 1, scheme%has_inertia)
         share = (scheme%l_f - scheme%l_p)*(min(scheme%dt, LARGEST_FACTOR*memory%dt) - memory%dt)/memory%dt
         state%v(first:, :) = base%v(first:, :) + share*(base%v(first:, :) - before%v(first:, :))
         state%s_rate = base%s + share*(base%s - before%s)
         state%outflow = base%outflow + share*(base%outflow - before%outflow)
      end associate
   end subroutine shift_rates

   !> Moves the rates of the present state back to where the last step left them.
   pure subroutine restore_rates(memory, state)
      type(rate_memory_t), intent(in) :: memory
      type(model_state_t), intent(inout) :: state

      if (.not. memory%based) return
      state%v = memory%base%v
      state%s_rate = memory%base%s
      state%outflow = memory%base%outflow
   end subroutine restore_rates

   !> Errors of all unknowns in a step; `known` says of which fields. docs/theory/host.md section 4.5.
   pure subroutine local_errors(scheme, memory, old, new, error, known)
      type(scheme_t), intent(in) :: scheme
      type(rate_memory_t), intent(in) :: memory
      type(model_state_t), intent(in) :: old, new   !< Before and after the step.
      real(wp), intent(out) :: error(:, :)   !< (FIELDS, nodes) [m, kPa]; 0 where not known.
      logical, intent(out) :: known(:)   !< (FIELDS)
      real(wp) :: off
      integer :: first

      error = 0.0_wp
      known = memory%known
      associate (dt => scheme%dt, base => memory%base%v, before => memory%before%v)
         if (.not. scheme%has_rates) then
            if (memory%known) error = static_error((new%x - old%x)/dt, before, dt, memory%dt)
            return
         end if
         first = 1
         if (scheme%has_inertia) then
            first = DISPLACEMENTS + 1
            known(:DISPLACEMENTS) = .true.
            error(:DISPLACEMENTS, :) = constant_of_accelerations(scheme)*dt**2*(new%a - old%a)
         end if
         if (.not. memory%known) return
         off = scheme%l_f - scheme%l_p
         error(first:, :) = constant_of_rates(scheme)*dt**3*((new%v(first:, :) - old%v(first:, :))/dt &
                            - (base(first:, :) - before(first:, :))/memory%dt) &
                            /(0.5_wp*(dt + memory%dt) + off*(min(dt, LARGEST_FACTOR*memory%dt) - memory%dt))
      end associate
   end subroutine local_errors

   !> Estimates the error of a static step [unit of the rate times s]: its ends are in equilibrium, and within it the
   !> material follows a straight path instead of a bent one: the bend, dt**2/12 of its second derivative in the mean,
   !> as far as the stiffness changes along it, which is the share by which the rate does. docs/theory/host.md section
   !> 4.5.
   pure function static_error(rate, rate_before, dt, dt_before) result(error)
      real(wp), intent(in) :: rate(:, :), rate_before(:, :)   !< (fields, nodes) of this step and of the last one.
      real(wp), intent(in) :: dt, dt_before                   !< Lengths of both steps [s].
      real(wp) :: error(size(rate, 1), size(rate, 2)), share

      error = (rate - rate_before)/(0.5_wp*(dt + dt_before))
      share = min(1.0_wp, dt*norm2(error)/max(norm2(rate), norm2(rate_before), tiny(1.0_wp)))
      error = BENT*share*dt**2*error
   end function static_error

   !> Keeps the rates of the start of an accepted step; of a static one they are those of the straight step.
   pure subroutine remember(scheme, memory, old, new)
      type(scheme_t), intent(in) :: scheme
      type(rate_memory_t), intent(inout) :: memory
      type(model_state_t), intent(in) :: old, new   !< Before and after the step.

      memory%before = rates_t(old%v, old%s_rate, old%outflow)
      if (.not. scheme%has_rates) memory%before%v = (new%x - old%x)/scheme%dt
      memory%dt = scheme%dt
      memory%based = .false.
      memory%known = .true.
   end subroutine remember
end module error_norms
