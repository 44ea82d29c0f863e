!> Sentences for status codes: what, where, value, allowed range, remedy.
module mud_messages
   use mud_kinds, only: wp
   use mud_registry, only: NPROPS, NSTATV, PROPERTIES, KIND_REAL, statev_name
   use mud_status, only: MUD_OK, MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_BAD_NTENS, MUD_BAD_PROPS, MUD_BAD_STATE, &
      MUD_BAD_INPUT, MUD_NULL_ARGUMENT, MUD_BAD_VOID_RATIO, MUD_BAD_OPTION, MUD_MINIMUM_STEP, MUD_TOO_MANY_SUBSTEPS, &
      MUD_NO_DIRECTION, MUD_VOID_RATIO_LIMIT, MUD_NOT_FINITE, MUD_INCREMENT_TOO_LARGE, MUD_NOT_WRITTEN, &
      ON_STRESS, ON_STRAIN, ON_SUCTION
   use mud_kernel, only: report_t
   use mud_tensor, only: is_finite
   implicit none (type, external)
   private
   public :: status_text, report_text, MESSAGE_LENGTH

   integer, parameter :: MESSAGE_LENGTH = 320
   character(2), parameter :: COMPONENT(6) = ['11', '22', '33', '12', '13', '23']
contains
   !> What a code means and what to do.
   pure function status_text(code) result(text)
      integer, intent(in) :: code
      character(MESSAGE_LENGTH) :: text

      select case (code)
      case (MUD_OK)
         text = 'no error'
      case (MUD_BAD_NPROPS)
         text = 'wrong number of PROPS: give every entry, mud_count tells how many'
      case (MUD_BAD_NSTATV)
         text = 'too few STATEV: reserve at least mud_count(MUD_STATEV) per point (Abaqus: *Depvar)'
      case (MUD_BAD_NTENS)
         text = 'NTENS must be 6 (solid) or 4 (plane strain, axisymmetric) with three direct components'
      case (MUD_BAD_PROPS)
         text = 'a material parameter is not finite or out of its range'
      case (MUD_BAD_STATE)
         text = 'a state variable is not finite or impossible: was STATEV zeroed before the first call and kept since?'
      case (MUD_BAD_INPUT)
         text = 'stress, strain, suction or DROT is not finite, absurdly large or no rotation: look at the host'
      case (MUD_NULL_ARGUMENT)
         text = 'a pointer that must be given is NULL'
      case (MUD_BAD_VOID_RATIO)
         text = 'the initial void ratio is out of its range: mend e_0 of PROPS or the preset in STATEV'
      case (MUD_BAD_OPTION)
         text = 'no such list, field, index or tangent kind'
      case (MUD_NOT_WRITTEN)
         text = 'the file could not be written: choose a new name in a folder that exists, on a disk with room'
      case (MUD_MINIMUM_STEP)
         text = 'the substep fell to its minimum: cut the increment, or loosen the tolerance'
      case (MUD_TOO_MANY_SUBSTEPS)
         text = 'too many substeps: cut the increment, or raise max_substeps'
      case (MUD_NO_DIRECTION)
         text = 'no admissible loading direction, again: cut the increment, or switch the guards x_0, cap_d, cap_h on'
      case (MUD_VOID_RATIO_LIMIT)
         text = 'the increment would drive the void ratio out of its range: cut it, or mend the strain'
      case (MUD_NOT_FINITE)
         text = 'the result is not finite: cut the increment'
      case (MUD_INCREMENT_TOO_LARGE)
         text = 'the increment is too large: cut it'
      case default
         text = 'unknown status code'
      end select
   end function status_text

   !> The same with the place, the value and the allowed range that a report carries.
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
         if (PROPERTIES(report%index)%kind /= KIND_REAL) text = trim(text)//', whole numbers only'
         text = trim(text)//' (default '//trim(number(PROPERTIES(report%index)%default))//'): '// &
                PROPERTIES(report%index)%meaning
      case (MUD_BAD_STATE)
         if (report%index < 1 .or. report%index > NSTATV) return
         text = 'state variable '//trim(statev_name(report%index))//' (STATEV '//trim(whole(report%index))//') is '// &
                trim(number(report%value))//trim(span(lower, upper))// &
                ': was STATEV zeroed before the first call and kept since?'
      case (MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_BAD_NTENS)
         text = trim(text)//'; given '//trim(number(report%value))//', needed '//trim(lower)
      case (MUD_BAD_VOID_RATIO)
         text = 'void ratio '//trim(number(report%value))//trim(span(lower, upper))// &
                ': mend e_0 of PROPS or the preset in STATEV'
      case (MUD_BAD_INPUT, MUD_INCREMENT_TOO_LARGE)
         if (report%subject == ON_STRESS .or. report%subject == ON_STRAIN .or. report%subject == ON_SUCTION) then
            text = trim(quantity(report))//' is '//trim(number(report%value))//trim(span(lower, upper))//': '//text
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

   pure function quantity(report) result(text)
      type(report_t), intent(in) :: report
      character(32) :: text

      select case (report%subject)
      case (ON_STRESS)
         text = 'stress'
      case (ON_STRAIN)
         text = 'strain increment'
      case default
         text = 'suction or its increment'
      end select
      if (report%index >= 1 .and. report%index <= 6) text = trim(text)//' '//COMPONENT(report%index)
   end function quantity

   !> Texts of fixed length: gfortran keeps the length of deferred-length results in static storage, which threads
   !> share.
   pure function span(lower, upper) result(text)
      character(*), intent(in) :: lower, upper
      character(48) :: text

      text = ', allowed '//trim(lower)//' to '//trim(upper)
   end function span

   !> A number as a person would write it.
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
