! SPDX-License-Identifier: MIT
!> Material parameters: from PROPS to named values, checked against the registry.
module mud_params
   use mud_bonding, only: suction_law_t
   use mud_critical_state, only: critical_t
   use mud_elastic, only: elastic_t
   use mud_flow, only: flow_t
   use mud_hardening, only: hardening_t
   use mud_kinds, only: wp, SQRT_6
   use mud_registry, only: NPROPS, NPROPS_BASE, NPROPS_WITHOUT_PRELOADING, &
      NPROPS_WITHOUT_FLUIDITY, PROPERTIES, KIND_REAL, &
      P_K_0, P_G_0, P_N_C, P_LAMBDA, P_ALPHA_CSL, P_N_L, P_THETA, P_M_C, P_C, P_N_B, P_N_D, P_A_0, P_H_0, &
      P_C_H, P_C_Z, P_Z_MAX, P_B_1, P_B_2, P_S_MAX, P_S_MIN, P_P_A, P_OMEGA, P_N_X, P_M_X, P_E_0, P_P_ATM, P_P_MIN, &
      P_BONDING, P_FABRIC, P_ISOTROPIC, P_LODE, P_MEMORY_RULE, P_EPS_HAT, P_J_EXP, P_X_0, P_X_REV, P_CAP_D, P_CAP_H, &
      P_CUTOFF, P_SCHEME, P_TOLERANCE, P_H_MIN, P_MAX_SUBSTEPS, P_TANGENT, P_RHO_E, P_HYSTERESIS, &
      P_P_AW, P_N_W, P_M_W, P_B_D, P_B_W, P_C_CHI, P_ZETA_CHI, P_S_CHI, P_C_ELL, P_ELL_MAX, P_P_ELL, P_R_ELL, &
      ISOTROPIC_NONE, ISOTROPIC_REMEMBERS
   use mud_retention, only: retention_t
   use mud_status, only: mud_status_t, fail, MUD_BAD_NPROPS, MUD_BAD_PROPS, ON_PROPS
   use mud_tensor, only: is_finite, all_finite
   use mud_units, only: stress_unit, bounds_for, given_or_share, LARGEST_STRESS, LARGEST_SUCTION_STEP, &
      SMALLEST_MINIMUM, MINIMUM_DIVISOR, THRESHOLD_DIVISOR
   implicit none (type, external)
   private
   public :: params_t, preloading_law_t, fluidity_law_t, read_params, completed, is_length, options_t, options_of, &
             check_bounds, default_props, NO_FLOOR, STRICTNESS

   real(wp), parameter :: NO_FLOOR = 1.0e-15_wp   !< The only floor of (r - r_in):n with the guard off [-].

   !> The share of the tolerance that the scheme automatic allows to substeps of third order: they are long, and their
   !> errors are what their estimate says, while those of modified Euler are smaller [-].
   real(wp), parameter :: STRICTNESS = 0.3_wp

   ! Side by side: an update checks them every time, and entries of PROPERTIES are several hundred bytes apart.
   real(wp), parameter :: LOWER(NPROPS) = PROPERTIES%lower, UPPER(NPROPS) = PROPERTIES%upper
   !> Switches, options and counts.
   integer, parameter :: WHOLE_ENTRIES(*) = pack(PROPERTIES%index, PROPERTIES%kind /= KIND_REAL)
   real(wp), parameter :: NEARLY_WHOLE = 1.0e-9_wp   !< A number this close to a whole one is it [-].

   real(wp), parameter :: WETTING_SHARE = 0.5_wp   !< P_aw of P_a where it is not given [-].

   !> Options with which a point has more numbers of STATEV.
   type :: options_t
      logical :: hysteresis   !< Hydraulic hysteresis.
      logical :: preloading   !< Cyclic preloading.
      logical :: fluid        !< Fluidity.
   end type options_t

   !> Parameters of cyclic preloading, as in mud_registry. Options stand above the laws: their types are here.
   type :: preloading_law_t
      real(wp) :: c_chi, zeta_chi, s_chi
   end type preloading_law_t

   !> Parameters of fluidity, as in mud_registry.
   type :: fluidity_law_t
      real(wp) :: c_ell, ell_max, p_ell, r_ell
   end type fluidity_law_t

   !> Parameters of one material; names and units as in mud_registry.
   type, extends(options_t) :: params_t
      type(elastic_t) :: elastic
      type(critical_t) :: critical
      type(flow_t) :: flow
      type(hardening_t) :: hardening
      type(suction_law_t) :: suction   !< Retention and bonding.
      real(wp) :: e_0, p_atm, p_min
      logical :: isotropic, cutoff
      logical :: remembers  !< The isotropic mechanism has a memory.
      !> Where the isotropic mechanism acted nearby a rate is tried with it first. Its memory asks for the rate without.
      logical :: guesses_mechanism
      integer :: memory_rule
      real(wp) :: eps_hat, j_exp
      real(wp) :: x_floor   !< Floor of (r - r_in):n, NO_FLOOR with the guard off [-].
      logical :: floored    !< The floor guard is on.
      real(wp) :: x_rev     !< Hysteresis of the reversal test, 0 with the guard off [-].
      real(wp) :: cap_d     !< Contraction cap, 0 with the guard off [-].
      real(wp) :: cap_h     !< Softening cap, 0 with the guard off [-].
      !> Some guard is on. Without any the model is the published one, which always goes on: reversals are tested where
      !> substeps begin, elastic rates replace missing directions, substeps of the minimum size are accepted.
      logical :: guarded
      integer :: scheme, tangent, max_substeps
      real(wp) :: tolerance, h_min
      !> Size of a substep of modified Euler over that of one of third order where both have the error that they may
      !> have, and the rates change by their own size within the same strain; docs/theory/integration.md section 2 [-].
      real(wp) :: second_share
      real(wp) :: rho_e     !< Radius of the elastic domain, 0: none [-].
      type(preloading_law_t) :: preload   !< Read with preloading.
      type(fluidity_law_t) :: fluidity    !< Read with fluidity.
      real(wp) :: largest_stress, largest_suction_step   !< Limits of input in the unit of p_atm.
   end type params_t
contains
   !> The parameters of Tables 2 and 3 with every default of the registry. Stresses in kPa; units as in mud_registry.
   pure function default_props() result(props)
      real(wp) :: props(NPROPS)

      props = PROPERTIES%default
   end function default_props

   !> True of a number of PROPS that is taken: all of them, or those ahead of fluidity, preloading or hysteresis.
   pure logical function is_length(n)
      integer, intent(in) :: n

      is_length = any(n == [NPROPS, NPROPS_WITHOUT_FLUIDITY, NPROPS_WITHOUT_PRELOADING, NPROPS_BASE])
   end function is_length

   !> Options that PROPS, of any length and not yet checked, switch on.
   pure type(options_t) function options_of(props) result(options)
      real(wp), intent(in) :: props(:)

      options = options_t(.false., .false., .false.)
      if (size(props) < NPROPS_WITHOUT_PRELOADING) return
      if (is_finite(props(P_HYSTERESIS))) options%hysteresis = props(P_HYSTERESIS) > 0.5_wp
      if (size(props) < NPROPS_WITHOUT_FLUIDITY) return
      if (is_finite(props(P_C_CHI))) options%preloading = props(P_C_CHI) > 0.0_wp
      if (size(props) < NPROPS) return
      if (is_finite(props(P_C_ELL))) options%fluid = props(P_C_ELL) > 0.0_wp
   end function options_of

   !> PROPS of an allowed length in full. The size of given(:) is one that is_length takes, which is not checked; what
   !> is left out is the default of the registry.
   pure function completed(given) result(props)
      real(wp), intent(in) :: given(:)
      real(wp) :: props(NPROPS)

      props(:size(given)) = given
      props(size(given) + 1:) = PROPERTIES(size(given) + 1:)%default
   end function completed

   !> Checks PROPS and names its values. On an error params is undefined and status names the first bad entry. props(:)
   !> has a number of entries that is_length takes, in the unit of p_atm, else MUD_BAD_NPROPS; a value that is not
   !> allowed is MUD_BAD_PROPS.
   pure subroutine read_params(props, params, status)
      real(wp), intent(in), contiguous :: props(:)
      type(params_t), intent(out) :: params
      type(mud_status_t), intent(out) :: status

      if (size(props) == NPROPS) then
         call read_all(props, params, status)
      else if (is_length(size(props))) then
         call read_all(completed(props), params, status)
      else
         status = fail(MUD_BAD_NPROPS, ON_PROPS, 0, real(size(props), wp), real(NPROPS_BASE, wp), &
                       real(NPROPS, wp))
      end if
   end subroutine read_params

   pure subroutine read_all(props, params, status)
      real(wp), intent(in) :: props(NPROPS)
      type(params_t), intent(out) :: params
      type(mud_status_t), intent(out) :: status

      call check_props(props, status)
      if (status%code /= 0) return

      params%critical%n_c = props(P_N_C)
      params%critical%lambda = props(P_LAMBDA)
      params%critical%alpha_csl = props(P_ALPHA_CSL)
      params%critical%n_l = props(P_N_L)
      params%critical%m_c = props(P_M_C)
      params%critical%c = props(P_C)
      params%critical%n_b = props(P_N_B)
      params%critical%n_d = props(P_N_D)
      params%suction%b_1 = props(P_B_1)
      params%suction%b_2 = props(P_B_2)
      params%suction%s_max = props(P_S_MAX)
      params%suction%s_min = props(P_S_MIN)
      params%suction%p_a = props(P_P_A)
      params%suction%omega = props(P_OMEGA)
      params%suction%n_x = props(P_N_X)
      params%suction%m_x = props(P_M_X)
      params%e_0 = props(P_E_0)
      params%p_atm = props(P_P_ATM)
      params%suction%p_atm = params%p_atm
      params%p_min = given_or_share(props, P_P_MIN, MINIMUM_DIVISOR)
      params%elastic = elastic_t(k_0=props(P_K_0), g_0=props(P_G_0), p_atm=props(P_P_ATM), p_min=params%p_min)
      params%flow = flow_t(a_0=props(P_A_0), c_z=props(P_C_Z), z_max=props(P_Z_MAX), &
                           fabric=real(whole(props(P_FABRIC)), wp))
      params%hardening = hardening_t(stiffness=props(P_H_0)*props(P_G_0), c_h=props(P_C_H), theta=props(P_THETA), &
                                     p_atm=props(P_P_ATM))
      params%largest_stress = LARGEST_STRESS*stress_unit(props)
      params%largest_suction_step = LARGEST_SUCTION_STEP*stress_unit(props)
      params%suction%bonds = whole(props(P_BONDING)) == 1
      params%isotropic = whole(props(P_ISOTROPIC)) /= ISOTROPIC_NONE
      params%remembers = whole(props(P_ISOTROPIC)) == ISOTROPIC_REMEMBERS
      params%guesses_mechanism = .not. params%remembers
      if (whole(props(P_LODE)) == 0) params%critical%c = 1.0_wp
      params%memory_rule = whole(props(P_MEMORY_RULE))
      params%eps_hat = props(P_EPS_HAT)
      params%j_exp = props(P_J_EXP)
      params%scheme = whole(props(P_SCHEME))
      params%tolerance = props(P_TOLERANCE)
      params%second_share = min(sqrt(params%tolerance)*(STRICTNESS*params%tolerance)**(-1.0_wp/3.0_wp), 1.0_wp)
      params%h_min = props(P_H_MIN)
      params%max_substeps = whole(props(P_MAX_SUBSTEPS))
      params%tangent = whole(props(P_TANGENT))
      params%rho_e = props(P_RHO_E)
      params%hysteresis = whole(props(P_HYSTERESIS)) == 1
      params%suction%hysteresis = params%hysteresis
      params%suction%scanning%acts = .false.
      params%suction%scanning%moves = .false.
      if (params%hysteresis) call read_wetting(props, params%suction%retention_t)
      params%preloading = props(P_C_CHI) > 0.0_wp
      if (params%preloading) &
         params%preload = preloading_law_t(c_chi=props(P_C_CHI), zeta_chi=props(P_ZETA_CHI), s_chi=props(P_S_CHI))
      params%fluid = props(P_C_ELL) > 0.0_wp
      if (params%fluid) params%fluidity = fluidity_law_t(c_ell=props(P_C_ELL), ell_max=props(P_ELL_MAX), &
                                                         p_ell=given_or_share(props, P_P_ELL, THRESHOLD_DIVISOR), &
                                                         r_ell=props(P_R_ELL))
      params%critical%c4 = params%critical%c**4
      params%critical%lode_bend = SQRT_6*(1.0_wp - params%critical%c4)/(8.0_wp*params%critical%c4)

      params%floored = props(P_X_0) > 0.0_wp
      params%x_floor = merge(props(P_X_0), NO_FLOOR, params%floored)
      params%x_rev = props(P_X_REV)
      params%cap_d = props(P_CAP_D)
      params%cap_h = props(P_CAP_H)
      params%cutoff = whole(props(P_CUTOFF)) == 1
      params%guarded = params%floored .or. params%cutoff .or. &
                       max(params%x_rev, params%cap_d, params%cap_h) > 0.0_wp
   end subroutine read_all

   !> The main wetting curve; what is zero follows the drying curve.
   pure subroutine read_wetting(props, retention)
      real(wp), intent(in) :: props(NPROPS)
      type(retention_t), intent(inout) :: retention

      retention%p_aw = props(P_P_AW)
      if (retention%p_aw <= 0.0_wp) retention%p_aw = WETTING_SHARE*retention%p_a
      retention%n_w = props(P_N_W)
      if (retention%n_w <= 0.0_wp) retention%n_w = retention%n_x
      retention%m_w = props(P_M_W)
      if (retention%m_w <= 0.0_wp) retention%m_w = retention%m_x
      retention%b_d = props(P_B_D)
      retention%b_w = props(P_B_W)
      retention%log_wetting = log(retention%p_aw/retention%p_a)
      retention%least%known = .false.
   end subroutine read_wetting

   !> Names the first entry that is not finite, out of its bounds or not the integer it should be. What stands behind
   !> hysteresis, c_chi or c_ell is read, and looked at, where it is on.
   pure subroutine check_props(props, status)
      real(wp), intent(in) :: props(NPROPS)
      type(mud_status_t), intent(out) :: status
      real(wp) :: unit

      unit = stress_unit(props)
      if (all_finite(props(:P_HYSTERESIS)) .and. is_finite(props(P_C_CHI)) .and. is_finite(props(P_C_ELL)) .and. &
          abs(unit - 1.0_wp) <= 0.0_wp) then
         if (no_fault(props(:P_HYSTERESIS)) .and. props(P_HYSTERESIS) < 0.5_wp .and. &
             all(abs(props([P_C_CHI, P_C_ELL])) <= 0.0_wp)) return
      end if
      call check_bounds(props, 1, P_HYSTERESIS, status)
      if (status%code /= 0) return
      if (whole(props(P_HYSTERESIS)) == 1) call check_bounds(props, P_HYSTERESIS + 1, P_C_CHI - 1, status)
      call check_bounds(props, P_C_CHI, P_C_CHI, status)
      if (status%code /= 0) return
      if (props(P_C_CHI) > 0.0_wp) call check_bounds(props, P_C_CHI + 1, P_C_ELL - 1, status)
      call check_bounds(props, P_C_ELL, P_C_ELL, status)
      if (status%code /= 0) return
      if (props(P_C_ELL) > 0.0_wp) call check_bounds(props, P_C_ELL + 1, NPROPS, status)
      if (status%code /= 0) return
      if (props(P_P_MIN) > 0.0_wp .and. props(P_P_MIN) < SMALLEST_MINIMUM*unit) then
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_P_MIN, props(P_P_MIN), SMALLEST_MINIMUM*unit, UPPER(P_P_MIN)*unit)
      else if (props(P_C_ELL) > 0.0_wp .and. props(P_P_ELL) > 0.0_wp .and. props(P_P_ELL) < SMALLEST_MINIMUM*unit) then
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_P_ELL, props(P_P_ELL), SMALLEST_MINIMUM*unit, UPPER(P_P_ELL)*unit)
      else if (props(P_S_MIN) >= props(P_S_MAX)) then
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_S_MIN, props(P_S_MIN), 0.0_wp, props(P_S_MAX))
      else if (whole(props(P_HYSTERESIS)) == 1) then
         call check_wetting(props, status)
      end if
   end subroutine check_props

   !> Names the first of some entries that is not finite, out of its bounds or not the integer it should be.
   !> Stresses in the unit of p_atm. status becomes MUD_BAD_PROPS with entry, value and range, and stays as it is where
   !> all are good, or where it is bad.
   pure subroutine check_bounds(props, first, last, status)
      real(wp), intent(in) :: props(NPROPS)
      integer, intent(in) :: first, last
      type(mud_status_t), intent(inout) :: status
      real(wp) :: low(NPROPS), high(NPROPS)
      integer :: i

      if (status%code /= 0) return
      call bounds_for(props, low, high)
      do i = first, last
         if (acceptable(i, props(i), low(i), high(i))) cycle
         status = fail(MUD_BAD_PROPS, ON_PROPS, i, props(i), low(i), high(i))
         return
      end do
   end subroutine check_bounds

   !> Checks that the main wetting curve is below the main drying curve at small and at large suctions. In between it
   !> takes more than a comparison: see check_retention of mud_retention.
   pure subroutine check_wetting(props, status)
      real(wp), intent(in) :: props(NPROPS)
      type(mud_status_t), intent(inout) :: status

      if (props(P_P_AW) > props(P_P_A)) then
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_P_AW, props(P_P_AW), 0.0_wp, props(P_P_A))
      else if (props(P_N_W) > 0.0_wp .and. (props(P_N_W) < 1.0_wp .or. props(P_N_W) > props(P_N_X))) then
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_N_W, props(P_N_W), 1.0_wp, props(P_N_X))
      else if (props(P_M_W) > 0.0_wp .and. props(P_M_W) < props(P_M_X)) then
         status = fail(MUD_BAD_PROPS, ON_PROPS, P_M_W, props(P_M_W), props(P_M_X), UPPER(P_M_W))
      end if
   end subroutine check_wetting

   !> Whether finite PROPS in kPa, up to hysteresis, are within their ranges, without a branch per entry: updates with
   !> good PROPS end here.
   pure logical function no_fault(props)
      real(wp), intent(in) :: props(P_HYSTERESIS)

      no_fault = .not. any(props < LOWER(:P_HYSTERESIS) .or. props > UPPER(:P_HYSTERESIS))
      if (no_fault) no_fault = all(abs(props(WHOLE_ENTRIES) - whole(props(WHOLE_ENTRIES))) < NEARLY_WHOLE) .and. &
                               props(P_S_MIN) < props(P_S_MAX) .and. &
                               (props(P_P_MIN) <= 0.0_wp .or. props(P_P_MIN) >= SMALLEST_MINIMUM)
   end function no_fault

   !> The integer nearest to a number that is not negative: nint without a call.
   pure elemental integer function whole(value)
      real(wp), intent(in) :: value

      whole = int(value + 0.5_wp)
   end function whole

   !> Finite, within the bounds and, for switches, options and counts, an integer.
   pure logical function acceptable(i, value, low, high)
      integer, intent(in) :: i
      real(wp), intent(in) :: value, low, high

      acceptable = is_finite(value)
      if (.not. acceptable) return
      acceptable = value >= low .and. value <= high
      if (acceptable .and. any(i == WHOLE_ENTRIES)) acceptable = abs(value - anint(value)) < NEARLY_WHOLE
   end function acceptable
end module mud_params
