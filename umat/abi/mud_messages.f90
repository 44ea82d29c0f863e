! SPDX-License-Identifier: MIT
!> Sentences for status codes: what, where, value, allowed range, remedy.
module mud_messages
   use mud_kinds, only: wp
   use mud_registry, only: NPROPS, NSTATV, PROPERTIES, KIND_REAL, COMPONENTS, S_LAYOUT, property_meaning, statev_name
   use mud_status, only: MUD_OK, MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_BAD_NTENS, MUD_BAD_PROPS, MUD_BAD_STATE, &
      MUD_BAD_INPUT, MUD_NULL_ARGUMENT, MUD_BAD_VOID_RATIO, MUD_BAD_OPTION, MUD_MINIMUM_STEP, MUD_TOO_MANY_SUBSTEPS, &
      MUD_NO_DIRECTION, MUD_VOID_RATIO_LIMIT, MUD_NOT_FINITE, MUD_INCREMENT_TOO_LARGE, MUD_NOT_WRITTEN, &
      MUD_NOT_PREPARED, ON_PROPS, ON_STATEV, ON_STRESS, ON_STRAIN, ON_SUCTION, ON_ROTATION
   use mud_kernel, only: report_t, ON_STRESS_RATIO
   use mud_tensor, only: is_finite, within
   implicit none (type, external)
   private
   public :: status_text, report_text, failure_name, number, MESSAGE_LENGTH

   integer, parameter :: MESSAGE_LENGTH = 320

   !> Every code: its name in that of a file, and a sentence that says what it means and what to do.
   type :: code_t
      integer :: code
      character(20) :: name
      character(112) :: text
   end type code_t
   type(code_t), parameter :: CODES(*) = [ &
      code_t(MUD_OK, 'ok', 'no error'), &
      code_t(MUD_BAD_NPROPS, 'bad_nprops', &
         'wrong number of PROPS: give every entry; mud_count returns how many there are'), &
      code_t(MUD_BAD_NSTATV, 'bad_nstatv', &
         'too few STATEV per point (Abaqus: *Depvar; PLAXIS: task 4 tells how many)'), &
      code_t(MUD_BAD_NTENS, 'bad_ntens', &
         'NTENS must be 6 (solid) or 4 (plane strain, axisymmetric) with three direct components'), &
      code_t(MUD_BAD_PROPS, 'bad_props', 'a material parameter is not finite or out of its range'), &
      code_t(MUD_BAD_STATE, 'bad_state', &
         'a state variable is not finite or impossible: was STATEV zeroed before the first call and kept since?'), &
      code_t(MUD_BAD_INPUT, 'bad_input', &
         'stress, strain, suction or DROT is not finite, too large or no rotation: check what the host passes'), &
      code_t(MUD_NULL_ARGUMENT, 'null_argument', 'a required pointer is NULL'), &
      code_t(MUD_BAD_VOID_RATIO, 'bad_void_ratio', &
         'the initial void ratio is out of its range: correct e_0 of PROPS or the preset in STATEV'), &
      code_t(MUD_BAD_OPTION, 'bad_option', 'unknown list, field, index or kind of tangent'), &
      code_t(MUD_NOT_WRITTEN, 'not_written', &
         'the file could not be written: choose a new name in a folder that exists, on a disk with room'), &
      code_t(MUD_NOT_PREPARED, 'not_prepared', &
         'no prepared material: call mud_prepare of this library on mud_prepared_size() doubles'), &
      code_t(MUD_MINIMUM_STEP, 'minimum_step', &
         'the substep fell to its minimum: cut the increment, or loosen the tolerance'), &
      code_t(MUD_TOO_MANY_SUBSTEPS, 'too_many_substeps', &
         'too many substeps: cut the increment, or raise max_substeps'), &
      code_t(MUD_NO_DIRECTION, 'no_direction', &
         'no admissible loading direction: cut the increment, or switch the guards x_0, cap_d, cap_h on'), &
      code_t(MUD_VOID_RATIO_LIMIT, 'void_ratio_limit', &
         'the increment would drive the void ratio out of its range: cut it, or correct the strain'), &
      code_t(MUD_NOT_FINITE, 'not_finite', 'the result is not finite: cut the increment'), &
      code_t(MUD_INCREMENT_TOO_LARGE, 'increment_too_large', 'the increment is too large: cut it')]
contains
   !> Sentence that says what a code means and what to do. An unknown code has a sentence too.
   pure function status_text(code) result(text)
      integer, intent(in) :: code
      character(MESSAGE_LENGTH) :: text
      integer :: place

      place = findloc(CODES%code, code, dim=1)
      text = 'unknown status code'
      if (place > 0) text = CODES(place)%text
   end function status_text

   !> Sentence of the code of a report, with the place, the value and the allowed range. Values in the unit that the
   !> report has; nothing is refused.
   pure function report_text(report) result(text)
      type(report_t), intent(in) :: report
      character(MESSAGE_LENGTH) :: text
      character(16) :: lower, upper

      text = status_text(report%status)
      lower = number(report%lower)
      upper = number(report%upper)
      select case (report%status)
      case (MUD_BAD_PROPS)
         if (report%index < 1 .or. report%index > NPROPS) return
         text = 'parameter '//trim(PROPERTIES(report%index)%name)//' (PROPS '//trim(whole(report%index))//') is '// &
                trim(number(report%value))//', allowed '//trim(lower)//' to '//trim(upper)
         if (PROPERTIES(report%index)%kind /= KIND_REAL) text = trim(text)//', integers only'
         text = trim(text)//' (default '//trim(number(default_like(report)))//'): '//property_meaning(report%index)
      case (MUD_BAD_STATE)
         if (report%index < 1 .or. report%index > NSTATV) return
         text = 'state variable '//trim(statev_name(report%index))//' (STATEV '//trim(whole(report%index))//') is '// &
                trim(number(report%value))
         if (within_range(report)) then
            text = trim(text)//', but it is a count and whole: numbers of two states were averaged or '// &
                   'interpolated, which makes no state; keep STATEV of every point as the last update wrote them'
            return
         end if
         text = trim(text)//trim(span(lower, upper))//': '
         if (report%index == S_LAYOUT .and. within(report%value, 0.0_wp)) then
            text = trim(text)//' mud_init or mud_init_points begins a point'
         else
            text = trim(text)//' was STATEV zeroed before the first call and kept since?'
         end if
      case (MUD_BAD_NPROPS, MUD_BAD_NSTATV)
         text = trim(text)//'; given '//trim(number(report%value))//', needed '//trim(lower)
         ! Without and with the entries of hysteresis.
         if (report%status == MUD_BAD_NPROPS .and. report%upper > report%lower) text = trim(text)//' or '//upper
      case (MUD_BAD_NTENS)
         ! Its range is 4 to 6, that of NDI is 3 alone.
         text = trim(merge('NDI  ', 'NTENS', report%upper <= report%lower))//' is '//trim(number(report%value))// &
                ': '//text
      case (MUD_BAD_VOID_RATIO)
         text = 'void ratio '//trim(number(report%value))//trim(span(lower, upper))// &
                ': correct e_0 of PROPS or the preset in STATEV'
      case (MUD_BAD_INPUT, MUD_INCREMENT_TOO_LARGE)
         if (report%subject == ON_STRESS .or. report%subject == ON_STRAIN .or. report%subject == ON_SUCTION) then
            if (report%status == MUD_BAD_INPUT) text = 'check what the host passes'
            if (report%subject == ON_STRESS .and. report%index == ON_STRESS_RATIO) text = 'the point begins far '// &
               'beyond the bounding surface: give a smaller deviator, or a smaller void ratio'
            text = trim(quantity(report))//' is '//trim(number(report%value))//trim(span(lower, upper))//': '//text
         else if (report%subject == ON_ROTATION) then
            text = rotation_text(report)
         end if
      case (MUD_VOID_RATIO_LIMIT)
         text = trim(text)//'; it would become '//trim(number(report%value))//span(lower, upper)
      case (MUD_MINIMUM_STEP)
         text = trim(text)//'; error '//trim(number(report%value))//' against tolerance '//trim(upper)//', reached '// &
                trim(number(100.0_wp*report%reached))//' % of the increment'
      case (MUD_TOO_MANY_SUBSTEPS)
         text = trim(text)//' ('//trim(number(report%value))//'); reached '//trim(number(100.0_wp*report%reached))// &
                ' % of the increment'
      end select
   end function report_text

   !> Part of a sentence that says what is wrong with DROT. Entries count by columns; 0 stands for all, 10 for the
   !> determinant.
   pure function rotation_text(report) result(text)
      type(report_t), intent(in) :: report
      character(MESSAGE_LENGTH) :: text

      select case (report%index)
      case (1:9)
         text = 'DROT('//trim(whole(mod(report%index - 1, 3) + 1))//', '//trim(whole((report%index + 2)/3))//') is '
      case (10)
         text = 'the determinant of DROT is'
      case default
         text = 'the largest entry of DROT times its transpose minus the unit matrix is'
      end select
      text = trim(text)//' '//trim(number(report%value))//trim(span(number(report%lower), number(report%upper)))// &
             ': DROT must be the rotation of the increment, or NULL or zero for none'
   end function rotation_text

   !> A name for this kind of failure, fit for a file: the code in words, with the parameter, state variable or
   !> component. An unknown code has a name too.
   pure function failure_name(report) result(name)
      type(report_t), intent(in) :: report
      character(60) :: name
      integer :: place

      place = findloc(CODES%code, report%status, dim=1)
      name = 'status_'//whole(report%status)
      if (place > 0) name = CODES(place)%name
      select case (report%subject)
      case (ON_PROPS)
         if (report%index >= 1 .and. report%index <= NPROPS) name = trim(name)//'_'//PROPERTIES(report%index)%name
      case (ON_STATEV)
         if (report%index >= 1 .and. report%index <= NSTATV) name = trim(name)//'_'//statev_name(report%index)
      case (ON_STRESS)
         name = trim(name)//'_stress'//component_suffix(report%index)
      case (ON_STRAIN)
         name = trim(name)//'_strain'//component_suffix(report%index)
      case (ON_SUCTION)
         name = trim(name)//'_suction'
      end select
   end function failure_name

   pure function component_suffix(index) result(suffix)
      integer, intent(in) :: index
      character(3) :: suffix

      suffix = ''
      if (index >= 1 .and. index <= 6) suffix = '_'//COMPONENTS(index)
   end function component_suffix

   !> Default of a parameter in the unit of the bounds that the report carries.
   pure real(wp) function default_like(report) result(default)
      type(report_t), intent(in) :: report

      associate (entry => PROPERTIES(report%index))
         default = entry%default
         if (entry%unit /= '1') default = default*(report%upper/entry%upper)
      end associate
   end function default_like

   pure function quantity(report) result(text)
      type(report_t), intent(in) :: report
      character(32) :: text

      select case (report%subject)
      case (ON_STRESS)
         text = 'stress'
         if (report%index == ON_STRESS_RATIO) text = 'initial stress ratio q/p'''
      case (ON_STRAIN)
         text = 'strain increment'
      case default
         text = 'suction or its increment'
      end select
      if (report%index >= 1 .and. report%index <= 6) text = trim(text)//' '//COMPONENTS(report%index)
   end function quantity

   !> True of a count that is refused because it is not whole. A NaN is not compared, for it would trap.
   pure logical function within_range(report)
      type(report_t), intent(in) :: report

      within_range = is_finite(report%value)
      if (within_range) within_range = report%value > report%lower .and. report%value < report%upper
   end function within_range

   !> Texts of fixed length: gfortran keeps the length of deferred-length results in static storage, which threads
   !> share.
   pure function span(lower, upper) result(text)
      character(*), intent(in) :: lower, upper
      character(48) :: text

      text = ', allowed '//trim(lower)//' to '//trim(upper)
   end function span

   !> A number as a person would write it. Without a unit; 'not finite' for NaN and infinity, 'infinity' for a bound
   !> that is none.
   pure function number(value) result(text)
      real(wp), intent(in) :: value
      character(16) :: text

      if (.not. is_finite(value)) then
         text = 'not finite'
      else if (abs(value) >= 0.5_wp*huge(value)) then
         text = merge('infinity ', '-infinity', value > 0.0_wp)
      else if (abs(value - anint(value)) <= 0.0_wp .and. abs(value) < 1.0e6_wp) then
         write (text, '(i0)') nint(value)
      else if (abs(value) >= 1.0e-3_wp .and. abs(value) < 1.0e6_wp) then
         write (text, '(f0.6)') value
         if (text(1:1) == '.') text = '0'//text(:15)
         if (text(1:2) == '-.') text = '-0'//text(2:15)
      else if (abs(value) >= 1.0e100_wp .or. (abs(value) < 1.0e-99_wp .and. abs(value) > 0.0_wp)) then
         write (text, '(es13.5e3)') value   ! two digits of exponent would leave no room for its letter
         text = adjustl(text)
      else
         write (text, '(es12.5)') value
         text = adjustl(text)
      end if
   end function number

   pure function whole(value) result(text)
      integer, intent(in) :: value
      character(12) :: text

      write (text, '(i0)') value
   end function whole
end module mud_messages
