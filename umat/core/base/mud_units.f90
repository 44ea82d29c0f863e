! SPDX-License-Identifier: MIT
!> The unit of stress is the user's: PROPS that carry one, and every limit, follow p_atm. "Unit" below is the user's
!> unit of stress, given as how many of it make 1 kPa: 1 for kPa, 1000 for Pa, 0.001 for MPa, 0.145 for psi.
module mud_units
   use mud_kinds, only: wp
   use mud_registry, only: NPROPS, PROPERTIES, UNIT_STRESS, UNIT_STRESS_TO_LAMBDA, P_N_C, P_LAMBDA, P_ALPHA_CSL, &
      P_N_L, P_P_A, P_P_ATM, P_P_MIN
   use mud_tensor, only: is_finite
   implicit none (type, external)
   private
   public :: stress_unit, bounds_for, convert_props, given_or_share, doubt_t, NDOUBTS, unit_doubts
   public :: LARGEST_STRESS, LARGEST_SUCTION_STEP, SMALLEST_MINIMUM, CREDIBLE_PRESSURE, MINIMUM_DIVISOR, &
      THRESHOLD_DIVISOR

   real(wp), parameter :: LARGEST_STRESS = 1.0e9_wp         !< A stress or suction beyond it is an input error [kPa].
   !> Mean stress of a start up to which it is credible: beyond 50 MPa, 5 km of ground, grains crush [kPa].
   real(wp), parameter :: CREDIBLE_PRESSURE = 5.0e4_wp
   real(wp), parameter :: LARGEST_SUCTION_STEP = 1.0e7_wp   !< Larger steps are asked to be cut [kPa].
   real(wp), parameter :: SMALLEST_MINIMUM = 1.0e-9_wp      !< Least p_min and p_ell that may be given [kPa].
   real(wp), parameter :: MINIMUM_DIVISOR = 1000.0_wp       !< p_min = 0 means p_atm over this [-].
   real(wp), parameter :: THRESHOLD_DIVISOR = 3.3775_wp     !< p_ell = 0 means p_atm over this: 30 kPa [-].

   !> Usual ranges as shares of p_atm. Each is a factor of 1000 wide (void ratios: of 1000**0.37, the default lambda),
   !> so that a value in Pa, kPa or MPa beside a p_atm in another of them is outside, wherever in the range it belongs.
   !> P_a: coarse sand (0.3 kPa) to clayey silt (300 kPa); alpha_csl: 100 kPa to 100 MPa; p_min: around its default.
   real(wp), parameter :: USUAL_P_A(2) = [3.0e-3_wp, 3.0_wp], USUAL_ALPHA_CSL(2) = [1.0_wp, 1000.0_wp], &
                          USUAL_P_MIN(2) = [3.0e-5_wp, 3.0e-2_wp]
   !> Usual void ratios at p' = p_atm of the critical state line (silt and sand: 0.3 to 2.5) and the compression line.
   real(wp), parameter :: USUAL_E_C(2) = [0.24_wp, 3.1_wp], USUAL_E_L(2) = [1.0_wp, 13.0_wp]
   integer, parameter :: NDOUBTS = 5   !< Number of entries that are looked at.

   !> An entry of PROPS that suggests another unit than that of p_atm.
   type :: doubt_t
      logical :: raised = .false.
      integer :: index = 0               !< Place in PROPS.
      logical :: void_ratio = .false.    !< The number is the void ratio at p' = p_atm, else a share of p_atm.
      real(wp) :: value = 0.0_wp, usual(2) = 0.0_wp
   end type doubt_t
contains
   !> The user's unit, from p_atm; 1 where p_atm itself is out of its bounds. It is p_atm over the default p_atm of
   !> 101.325 kPa [user's units in a kPa].
   pure real(wp) function stress_unit(props) result(unit)
      real(wp), intent(in) :: props(NPROPS)

      unit = 1.0_wp
      if (is_allowed(props, P_P_ATM)) unit = props(P_P_ATM)/PROPERTIES(P_P_ATM)%default
   end function stress_unit

   !> Bounds and defaults of every entry in the user's unit; p_atm has its own bounds, its default is an atmosphere. N_c
   !> and N_l go with the unit to the power of lambda. Nothing is refused.
   pure subroutine bounds_for(props, lower, upper, default)
      real(wp), intent(in) :: props(NPROPS)   !< PROPS, of which p_atm and lambda count.
      real(wp), intent(out) :: lower(NPROPS), upper(NPROPS)
      real(wp), intent(out), optional :: default(NPROPS)
      real(wp) :: factors(NPROPS)

      factors = factors_for(stress_unit(props), props)
      if (present(default)) default = PROPERTIES%default*factors
      factors(P_P_ATM) = 1.0_wp
      lower = PROPERTIES%lower*factors
      upper = PROPERTIES%upper*factors
   end subroutine bounds_for

   !> PROPS of a material in another unit of stress, of which `unit` make one of the present unit. Entries with the unit
   !> of stress are multiplied by it, N_c and N_l by its power lambda (docs/theory/material.md sections 3.2, 3.5).
   !> Neither argument is checked.
   pure function convert_props(props, unit) result(converted)
      real(wp), intent(in) :: props(NPROPS), unit
      real(wp) :: converted(NPROPS)

      converted = props*factors_for(unit, props)
   end function convert_props

   !> Factors on the entries of PROPS in another unit of stress: unit**lambda on N_c and N_l, for e_c = N_c (p' +
   !> alpha_csl)**-lambda.
   pure function factors_for(unit, props) result(factors)
      real(wp), intent(in) :: unit, props(NPROPS)
      real(wp) :: factors(NPROPS), power

      factors = 1.0_wp
      if (abs(unit - 1.0_wp) <= 0.0_wp) return
      power = 1.0_wp
      if (is_allowed(props, P_LAMBDA)) power = unit**props(P_LAMBDA)
      where (PROPERTIES%unit == UNIT_STRESS) factors = unit
      where (PROPERTIES%unit == UNIT_STRESS_TO_LAMBDA) factors = power
   end function factors_for

   !> Within its own bounds. A NaN is not compared: a comparison would trap.
   pure logical function is_allowed(props, i)
      real(wp), intent(in) :: props(NPROPS)
      integer, intent(in) :: i

      is_allowed = is_finite(props(i))
      if (is_allowed) is_allowed = props(i) >= PROPERTIES(i)%lower .and. props(i) <= PROPERTIES(i)%upper
   end function is_allowed

   !> p_min or p_ell [user's unit]: a forgotten one, not above 0, is p_atm over a divisor; docs/theory/material.md
   !> sections 6, 4.11. PROPS are not checked.
   pure real(wp) function given_or_share(props, entry, divisor) result(p)
      real(wp), intent(in) :: props(NPROPS), divisor
      integer, intent(in) :: entry

      p = props(entry)
      if (p <= 0.0_wp) p = props(P_P_ATM)/divisor
   end function given_or_share

   !> Entries of allowed PROPS that look as if p_atm had another unit. Zeros (no shift, p_min by default) have no unit.
   !> PROPS must have passed read_params; a doubt that is not raised says nothing.
   pure function unit_doubts(props) result(doubts)
      real(wp), intent(in) :: props(NPROPS)
      type(doubt_t) :: doubts(NDOUBTS)
      real(wp) :: p_atm
      integer :: i

      p_atm = props(P_P_ATM)
      doubts(1) = doubt_t(.true., P_P_A, .false., props(P_P_A)/p_atm, USUAL_P_A)
      doubts(2) = doubt_t(props(P_ALPHA_CSL) > 0.0_wp, P_ALPHA_CSL, .false., props(P_ALPHA_CSL)/p_atm, &
                          USUAL_ALPHA_CSL)
      doubts(3) = doubt_t(props(P_P_MIN) > 0.0_wp, P_P_MIN, .false., props(P_P_MIN)/p_atm, USUAL_P_MIN)
      doubts(4) = doubt_t(.true., P_N_C, .true., &
                          props(P_N_C)*(p_atm + props(P_ALPHA_CSL))**(-props(P_LAMBDA)), USUAL_E_C)
      doubts(5) = doubt_t(.true., P_N_L, .true., props(P_N_L)*p_atm**(-props(P_LAMBDA)), USUAL_E_L)
      do i = 1, NDOUBTS
         doubts(i)%raised = doubts(i)%raised .and. (doubts(i)%value < doubts(i)%usual(1) .or. &
                                                    doubts(i)%value > doubts(i)%usual(2))
      end do
   end function unit_doubts
end module mud_units
