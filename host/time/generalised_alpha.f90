! SPDX-License-Identifier: MIT
!> Generalised-alpha with one spectral radius: Chung & Hulbert (1993) for accelerations, Jansen, Whiting & Hulbert
!> (2000) for first-order rates. Residuals are formed from values, displacement rates and pressures at 1 - alpha_f,
!> accelerations and first-order rates at their own levels.
!> docs/theory/host.md section 4.
module generalised_alpha
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: analysis_t, scheme_t, make_scheme, predict, advance_rates, rate_of
   public :: STATIC, QUASI_STATIC, DYNAMIC, is_flow

   type :: analysis_t
      logical :: has_rates = .false.               !< There are first-order rates, and so flow.
      logical :: has_inertia = .false.             !< There are accelerations.
   end type analysis_t

   type(analysis_t), parameter :: STATIC = analysis_t(.false., .false.)       !< Equilibrium alone, pressures held.
   type(analysis_t), parameter :: QUASI_STATIC = analysis_t(.true., .false.)  !< Flow and equilibrium.
   type(analysis_t), parameter :: DYNAMIC = analysis_t(.true., .true.)        !< Flow and motion.

   type, extends(analysis_t) :: scheme_t
      real(wp) :: dt = 1.0_wp
      real(wp) :: beta = 0.25_wp, gamma = 0.5_wp   !< Newmark's, for displacements of dynamic steps.
      real(wp) :: gamma_1 = 1.0_wp                 !< Weight of the new rate, for first-order rates.
      real(wp) :: l_f = 1.0_wp                     !< Level of values.
      real(wp) :: l_v = 1.0_wp                     !< Level of displacement rates.
      real(wp) :: l_a = 1.0_wp                     !< Level of accelerations.
      real(wp) :: l_p = 1.0_wp                     !< Level of pressure and saturation rates.
      real(wp) :: c_v = 0.0_wp, c_a = 0.0_wp, c_p = 0.0_wp   !< Slopes of those at their level against the new values.
   end type scheme_t
contains
   !> Whether an analysis has rates alone, no accelerations.
   elemental logical function is_flow(analysis)
      class(analysis_t), intent(in) :: analysis

      is_flow = analysis%has_rates .and. .not. analysis%has_inertia
   end function is_flow

   !> Finds the coefficients of a step of an analysis by Chung & Hulbert (1993) and Jansen et al. (2000):
   !> docs/theory/host.md section 4.1; section 4.2 has gamma_1.
   pure function make_scheme(analysis, rho_inf, dt, begins) result(scheme)
      class(analysis_t), intent(in) :: analysis
      real(wp), intent(in) :: rho_inf   !< 0 to 1
      real(wp), intent(in) :: dt        !< [s]
      logical, intent(in), optional :: begins   !< A flow begins: the rates before say nothing. Default: no.
      type(scheme_t) :: scheme

      scheme%has_rates = analysis%has_rates
      scheme%has_inertia = analysis%has_inertia
      scheme%dt = dt
      if (.not. scheme%has_rates) return
      scheme%l_f = 1/(1 + rho_inf)
      scheme%l_p = (3 - rho_inf)/(2*(1 + rho_inf))
      scheme%gamma_1 = 1/(1 + rho_inf)
      if (present(begins)) then
         if (begins) scheme%l_p = 1.0_wp
         if (begins) scheme%gamma_1 = 1.0_wp
      end if
      scheme%c_p = scheme%l_p/(scheme%gamma_1*dt)
      if (.not. scheme%has_inertia) then
         scheme%l_v = scheme%l_p
         scheme%c_v = scheme%c_p
         return
      end if
      scheme%l_v = scheme%l_f
      scheme%l_a = (2 - rho_inf)/(1 + rho_inf)
      scheme%gamma = 0.5_wp + scheme%l_a - scheme%l_f
      scheme%beta = 0.25_wp*(1 + scheme%l_a - scheme%l_f)**2
      scheme%c_v = scheme%l_v*scheme%gamma/(scheme%beta*dt)
      scheme%c_a = scheme%l_a/(scheme%beta*dt**2)
   end function make_scheme

   !> Makes a first guess of the new values: constant acceleration, constant pressure rates; or, with `no_predictor`, no
   !> change. docs/theory/host.md section 4.1.
   pure subroutine predict(scheme, no_predictor, x0, v0, a0, x1)
      type(scheme_t), intent(in) :: scheme
      logical, intent(in) :: no_predictor
      real(wp), intent(in) :: x0(:, :), v0(:, :), a0(:, :)   !< (FIELDS, nodes) [m, kPa], rates [1/s of it], (2, nodes)
                                                             !< [m/s2].
      real(wp), intent(out) :: x1(:, :)   !< Predicted values, in the shape of x0.

      x1 = x0
      if (no_predictor .or. .not. scheme%has_rates) return
      x1 = x0 + scheme%dt*v0
      if (scheme%has_inertia) x1(1:2, :) = x1(1:2, :) + 0.5_wp*scheme%dt**2*a0
   end subroutine predict

   !> Finds the new rates and accelerations that belong to new values. docs/theory/host.md sections 4.1 and 4.2; 0 in
   !> static steps. x, v: (FIELDS, nodes) [m, kPa] and [m/s, kPa/s]; a: (2, nodes) [m/s2], 0 in quasi-static steps.
   pure subroutine advance_rates(scheme, x0, v0, a0, x1, v1, a1)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: x0(:, :), v0(:, :), a0(:, :), x1(:, :)
      real(wp), intent(out) :: v1(:, :), a1(:, :)

      v1 = 0.0_wp
      a1 = 0.0_wp
      if (.not. scheme%has_rates) return
      v1 = rate_of(scheme, x0, v0, x1)
      if (.not. scheme%has_inertia) return
      associate (b => scheme%beta, g => scheme%gamma, dt => scheme%dt)
         a1 = (x1(1:2, :) - x0(1:2, :))/(b*dt**2) - v0(1:2, :)/(b*dt) - (0.5_wp/b - 1)*a0
         v1(1:2, :) = v0(1:2, :) + dt*((1 - g)*a0 + g*a1)
      end associate
   end subroutine advance_rates

   !> Finds the first-order rate at the end of the step. docs/theory/host.md section 4.2; 0 in static steps. x: values
   !> at the ends of the step, v0: rate at its start [unit of x per s].
   elemental real(wp) function rate_of(scheme, x0, v0, x1)
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: x0, v0, x1

      rate_of = 0.0_wp
      if (.not. scheme%has_rates) return
      rate_of = (x1 - x0)/(scheme%gamma_1*scheme%dt) - (1 - scheme%gamma_1)/scheme%gamma_1*v0
   end function rate_of

end module generalised_alpha
