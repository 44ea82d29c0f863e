! SPDX-License-Identifier: MIT
!> PROPS, starts and void ratios that are allowed but doubtful: a warning, never a refusal.
module mud_advice
   use mud_bonding, only: bonding_factor
   use mud_critical_state, only: compression_image
   use mud_elastic, only: STIFF_ABOVE
   use mud_kinds, only: wp
   use mud_messages, only: number
   use mud_params, only: params_t
   use mud_rates, only: stress_ratio
   use mud_registry, only: NPROPS, PROPERTIES, S_VOID_RATIO, S_SATURATION, S_SUCTION, S_GAP, S_OPEN
   use mud_tensor, only: ddot, trace
   use mud_units, only: doubt_t, unit_doubts, NDOUBTS, CREDIBLE_PRESSURE, LARGEST_STRESS
   implicit none (type, external)
   private
   public :: advice_on, doubts_on_start, advice_on_start, is_too_loose, advice_on_void_ratio, ADVICE_LENGTH, &
             START_DOUBTS, TOO_LOOSE, TENSION

   integer, parameter :: ADVICE_LENGTH = 640
   integer, parameter :: TENSION = 1, TOO_DEEP = 2, ABOVE_LINE = 3, TOO_LOOSE = 4   !< Doubts about a start.
   integer, parameter :: START_DOUBTS = 4   !< Number of doubts about a start.
   !> A mean stress of a start within this share of p_atm from zero is no tension, but rounding of a free surface [-].
   real(wp), parameter :: NEARLY_NOTHING = 0.01_wp
   !> 1 - delta of docs/theory/material.md section 3.5 beyond which a start is far above the compression line: it is 1
   !> on the line and 0 without stress, so that 2 is as far beyond the line as soil without stress is below it. There
   !> F = 2, twice the slope of the line. Compression leads to less: an oedometer to 1.58 (section 7.3) [-].
   real(wp), parameter :: FAR_ABOVE = 2.0_wp
contains
   !> Tells for every doubt about a start whether a point that began raises it. `stress` is effective as the host gave
   !> it, tension positive, in the unit of p_atm; STATEV as the start has filled it. A stress that is doubtful itself is
   !> not compared with the line.
   pure function doubts_on_start(par, stress, statev) result(raised)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6), statev(:)
      logical :: raised(START_DOUBTS)
      real(wp) :: p

      p = -trace(stress)/3.0_wp
      raised(TENSION) = p < -NEARLY_NOTHING*par%p_atm
      raised(TOO_DEEP) = p > credible_pressure_of(par)
      raised(ABOVE_LINE) = .false.
      if (par%isotropic .and. p > par%p_min .and. .not. raised(TOO_DEEP)) &
         raised(ABOVE_LINE) = crowding(par, stress, statev) > FAR_ABOVE
      raised(TOO_LOOSE) = is_too_loose(statev)
   end function doubts_on_start

   !> The sentence for one of these doubts, raised or not.
   pure function advice_on_start(par, stress, statev, doubt) result(text)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6), statev(:)
      integer, intent(in) :: doubt
      character(ADVICE_LENGTH) :: text
      real(wp) :: p, line

      p = -trace(stress)/3.0_wp
      text = 'the mean effective stress of the start is '//number(-p)
      select case (doubt)
      case (TENSION)
         text = trim(text)//', tension: tension is positive here, and sand bears none; give compression with the '// &
                'sign minus, as '//number(p)
      case (TOO_DEEP)
         text = trim(text)//', compression of more than 50 MPa, '//trim(number(credible_pressure_of(par)))// &
                ' in the unit of p_atm = '//trim(number(par%p_atm))//': grains crush there, which no parameter '// &
                'knows; give stresses in the unit of p_atm, or PROPS in that of the stresses'
      case (ABOVE_LINE)
         line = statev(S_VOID_RATIO)*crowding(par, stress, statev)**(-par%critical%lambda)
         text = 'the void ratio of the start is '//trim(number(statev(S_VOID_RATIO)))//', far above the '// &
                'compression line, which is at '//trim(number(line))//' for its stress: soil as '// &
                'loose as that bears less than half of a mean effective stress of '//trim(number(p))// &
                '. Give a smaller void ratio or stress, or check N_l and the unit of stress'
      case default
         text = 'the void ratio of the start is '//advice_on_void_ratio(statev)
      end select
   end function advice_on_start

   !> True if G of eq. (3) is past its zero: at the void ratio without the gap, of a point that bears stress.
   pure logical function is_too_loose(statev)
      real(wp), intent(in) :: statev(:)

      is_too_loose = statev(S_VOID_RATIO) - statev(S_GAP) >= STIFF_ABOVE .and. statev(S_OPEN) < 0.5_wp
   end function is_too_loose

   !> Sentence on the void ratio of a state beyond which the shear modulus grows again; it follows 'the void ratio is'.
   pure function advice_on_void_ratio(statev) result(text)
      real(wp), intent(in) :: statev(:)
      character(ADVICE_LENGTH/2) :: text

      text = trim(number(statev(S_VOID_RATIO) - statev(S_GAP)))//': the shear modulus of the model is 0 at '// &
             trim(number(STIFF_ABOVE))//' and grows again beyond, where it means nothing. Give a void ratio below '// &
             'that (e_0 of PROPS, or preset), and do not use results beyond'
   end function advice_on_void_ratio

   !> (p'/alpha_hat)(1 + 2 eta^2/M_c^2) of a start in compression [-]: 1 on the compression line, above it more.
   pure real(wp) function crowding(par, stress, statev)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6), statev(:)
      real(wp) :: p, r(6), f

      call stress_ratio(par, -stress, p, r)
      f = bonding_factor(par%suction, statev(S_SUCTION), statev(S_SATURATION))
      crowding = p/compression_image(par%critical, f, statev(S_VOID_RATIO)) &
                 *(1.0_wp + 3.0_wp*ddot(r, r)/par%critical%m_c**2)
   end function crowding

   !> Largest credible pressure, in the unit of p_atm.
   pure real(wp) function credible_pressure_of(par)
      type(params_t), intent(in) :: par

      credible_pressure_of = par%largest_stress*(CREDIBLE_PRESSURE/LARGEST_STRESS)
   end function credible_pressure_of

   !> Names the entries of allowed PROPS that suggest another unit of stress than p_atm does; empty if there are none.
   !> Stresses in the unit of p_atm; PROPS must have passed read_params. Usual ranges of mud_units.
   pure function advice_on(props) result(text)
      real(wp), intent(in) :: props(NPROPS)
      character(ADVICE_LENGTH) :: text
      type(doubt_t) :: doubts(NDOUBTS)
      integer :: i

      text = ''
      doubts = unit_doubts(props)
      do i = 1, NDOUBTS
         if (.not. doubts(i)%raised) cycle
         if (text == '') then
            text = 'warning: do all PROPS have the unit of stress of p_atm?'
         else
            text = trim(text)//';'
         end if
         text = trim(text)//' '//trim(PROPERTIES(doubts(i)%index)%name)//' '//trim(number(props(doubts(i)%index)))// &
                merge(' gives e = ', ' is        ', doubts(i)%void_ratio)
         text = trim(text)//' '//trim(number(doubts(i)%value))//merge(' at p'' = p_atm', ' p_atm        ', &
                                                                        doubts(i)%void_ratio)
         text = trim(text)//' (usual '//trim(number(doubts(i)%usual(1)))//' to '//trim(number(doubts(i)%usual(2)))//')'
      end do
   end function advice_on
end module mud_advice
