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
   implicit none (type, external)
   private
   public :: rate_memory_t, new_memory, exchange_memory, shift_rates, local_errors, remember, forget, &
             constant_of_accelerations, constant_of_rates, rms

   real(wp), parameter :: LONGEST = 2.0_wp   !< Times the last step: no rate is carried over a longer one.
   real(wp), parameter :: BENT = 1.0_wp/12   !< Mean deviation of a bent path from the straight step, of dt**2 x''.

   !> Rates one step back.
   type :: rate_memory_t
      logical :: known = .false.            !< There are such rates, with nothing sudden since.
      real(wp) :: dt = 0.0_wp               !< Step from them to the present ones, which both belong to [s].
      real(wp), allocatable :: rate(:, :)   !< (fields, nodes)
      real(wp), allocatable :: s_rate(:)    !< (points)
      real(wp) :: outflow(2) = 0.0_wp
      ! The present ones as the last step left them; attempts of different length move them from here.
      logical :: based = .false.
      real(wp), allocatable :: base_rate(:, :), base_s_rate(:)
      real(wp) :: base_outflow(2) = 0.0_wp
   end type rate_memory_t
contains
   !> Memory without rates of earlier steps.
   pure function new_memory(fields, nodes, points) result(memory)
      integer, intent(in) :: fields, nodes, points   !< Extents of its arrays.
      type(rate_memory_t) :: memory

      allocate (memory%rate(fields, nodes), memory%s_rate(points), source=0.0_wp)
      allocate (memory%base_rate(fields, nodes), memory%base_s_rate(points), source=0.0_wp)
   end function new_memory

   !> Exchanges a memory, made by new_memory, with an archive.
   subroutine exchange_memory(memory, archive)
      type(rate_memory_t), intent(inout) :: memory
      class(archive_t), intent(inout) :: archive

      call archive%exchange('rates_known', memory%known, &
                            'rates of the step before are known, with nothing sudden since')
      call archive%exchange('rates_dt', memory%dt, 's', 'step from those rates to the present ones')
      call archive%exchange('rate', memory%rate, 'm/s, kPa/s', 'rates of the unknowns one step back')
      call archive%exchange('s_rate', memory%s_rate, '1/s', 'rates of saturation one step back')
      call archive%exchange('outflow', memory%outflow, 'm3/s', 'flows out of the ground one step back')
   end subroutine exchange_memory

   !> C of the leading error of a step for accelerations [-]. 1/12 + 3/8 (l_a - l_f)**2: docs/theory/host.md section
   !> 4.5; for rho_inf = 1 Zienkiewicz & Xie (1991).
   pure real(wp) function constant_of_accelerations(scheme) result(c)
      type(scheme_t), intent(in) :: scheme

      c = 1.0_wp/12 + 0.375_wp*(scheme%l_a - scheme%l_f)**2
   end function constant_of_accelerations

   !> C of the leading error of a step for first-order rates [-]. 1/12 + (l_p - l_f)**2: docs/theory/host.md section
   !> 4.5.
   pure real(wp) function constant_of_rates(scheme) result(c)
      type(scheme_t), intent(in) :: scheme

      c = 1.0_wp/12 + (scheme%l_p - scheme%l_f)**2
   end function constant_of_rates

   !> Moves the rates of the present state to where a step of another length expects them. docs/theory/host.md section
   !> 4.5. Rates stay in static steps and where none are known from before; in dynamic steps those of the displacements
   !> stay.
   pure subroutine shift_rates(scheme, memory, v, s_rate, outflow)
      type(scheme_t), intent(in) :: scheme   !< Scheme of the step to come.
      type(rate_memory_t), intent(inout) :: memory
      real(wp), intent(inout) :: v(:, :), s_rate(:)   !< (fields, nodes) rates [m/s, kPa/s]; (points) rate of S_w [1/s].
      real(wp), intent(inout) :: outflow(:)   !< Flows out of the ground, which move as rates do [m3/s].
      real(wp) :: share
      integer :: first

      if (.not. memory%based) then
         memory%base_rate = v
         memory%base_s_rate = s_rate
         memory%base_outflow = outflow
         memory%based = .true.
      end if
      if (.not. scheme%has_rates .or. .not. memory%known) return
      first = merge(3, 1, scheme%has_inertia)
      share = (scheme%l_f - scheme%l_p)*(min(scheme%dt, LONGEST*memory%dt) - memory%dt)/memory%dt
      v(first:, :) = memory%base_rate(first:, :) + share*(memory%base_rate(first:, :) - memory%rate(first:, :))
      s_rate = memory%base_s_rate + share*(memory%base_s_rate - memory%s_rate)
      outflow = memory%base_outflow + share*(memory%base_outflow - memory%outflow)
   end subroutine shift_rates

   !> Errors of all unknowns in a step from x0 to x1; `known` says of which fields. docs/theory/host.md section 4.5. x,
   !> v: (FIELDS, nodes) values and rates [m, kPa, per s]; a: (2, nodes) accelerations [m/s2]; at the start (0) and the
   !> end (1) of the step.
   pure subroutine local_errors(scheme, memory, x0, v0, a0, x1, v1, a1, error, known)
      type(scheme_t), intent(in) :: scheme
      type(rate_memory_t), intent(in) :: memory
      real(wp), intent(in) :: x0(:, :), v0(:, :), a0(:, :), x1(:, :), v1(:, :), a1(:, :)
      real(wp), intent(out) :: error(:, :)   !< (FIELDS, nodes) [m, kPa]; 0 where not known.
      logical, intent(out) :: known(:)   !< (FIELDS)
      real(wp) :: off
      integer :: first

      error = 0.0_wp
      known = memory%known
      associate (dt => scheme%dt)
         if (.not. scheme%has_rates) then
            if (memory%known) error = static_error((x1 - x0)/dt, memory%rate, dt, memory%dt)
            return
         end if
         first = 1
         if (scheme%has_inertia) then
            first = 3
            known(1:2) = .true.
            error(1:2, :) = constant_of_accelerations(scheme)*dt**2*(a1 - a0)
         end if
         if (.not. memory%known) return
         off = scheme%l_f - scheme%l_p
         error(first:, :) = constant_of_rates(scheme)*dt**3*((v1(first:, :) - v0(first:, :))/dt &
                            - (memory%base_rate(first:, :) - memory%rate(first:, :))/memory%dt) &
                            /(0.5_wp*(dt + memory%dt) + off*(min(dt, LONGEST*memory%dt) - memory%dt))
      end associate
   end subroutine local_errors

   !> Error of a static step [unit of the rate times s]: its ends are in equilibrium, and within it the material follows
   !> a straight path instead of a bent one: the bend, dt**2/12 of its second derivative in the mean, as far as the
   !> stiffness changes along it, which is the share by which the rate does. docs/theory/host.md section 4.5.
   pure function static_error(rate, rate_before, dt, dt_before) result(error)
      real(wp), intent(in) :: rate(:, :), rate_before(:, :)   !< (fields, nodes) of this step and of the last one.
      real(wp), intent(in) :: dt, dt_before                   !< Lengths of both steps [s].
      real(wp) :: error(size(rate, 1), size(rate, 2)), share

      error = (rate - rate_before)/(0.5_wp*(dt + dt_before))
      share = min(1.0_wp, dt*norm2(error)/max(norm2(rate), norm2(rate_before), tiny(1.0_wp)))
      error = BENT*share*dt**2*error
   end function static_error

   !> Keeps the rates of the start of an accepted step. x: (fields, nodes) values at both ends of the step [m, kPa]; v0:
   !> their rates at its start [1/s of it]; s_rate: (points) rate of S_w there [1/s]; outflow: flows out of the ground
   !> there [m3/s]. In static steps the rates are those of the straight step.
   pure subroutine remember(scheme, memory, x0, x1, v0, s_rate, outflow)
      type(scheme_t), intent(in) :: scheme
      type(rate_memory_t), intent(inout) :: memory
      real(wp), intent(in) :: x0(:, :), x1(:, :), v0(:, :), s_rate(:), outflow(:)

      memory%rate = v0
      if (.not. scheme%has_rates) memory%rate = (x1 - x0)/scheme%dt
      memory%s_rate = s_rate
      memory%outflow = outflow
      memory%dt = scheme%dt
      memory%based = .false.
      memory%known = .true.
   end subroutine remember

   !> Something sudden: the rates before say nothing of those to come.
   pure subroutine forget(memory)
      type(rate_memory_t), intent(inout) :: memory

      memory%known = .false.
   end subroutine forget

   !> Root mean square over the nodes. values: (components, nodes); the squares of all components are added up.
   pure real(wp) function rms(values)
      real(wp), intent(in) :: values(:, :)

      rms = sqrt(sum(values**2)/max(1, size(values, 2)))
   end function rms
end module error_norms
