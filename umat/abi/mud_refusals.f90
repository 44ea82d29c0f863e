! SPDX-License-Identifier: MIT
!> Reports a refusal of umat_: a message on standard error, once a process for each distinct failure, a request for a
!> cut in PNEWDT or, where the host gives no PNEWDT, a STRESS of NaN that stops the solver. mud_refuse of mud.h does so
!> for entries written on that file.
module mud_refusals
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_null_ptr, c_associated, &
      c_f_pointer
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_advice, only: advice_on, doubts_on_start, advice_on_start, is_too_loose, advice_on_void_ratio, &
      ADVICE_LENGTH, START_DOUBTS, TOO_LOOSE
   use mud_arguments, only: suction_t, integer_at, SUCTION_CONTRADICTS, ARGUMENT_NAMES
   use mud_kernel, only: report_t, kernel_begin
   use mud_kinds, only: wp
   use mud_messages, only: report_text, failure_name, number, MESSAGE_LENGTH
   use mud_once, only: first_time, write_message, report_at_exit, environment_is
   use mud_params, only: params_t
   use mud_registry, only: NPROPS, P_TANGENT, S_VOID_RATIO, S_SATURATION
   use mud_retention, only: read_preset
   use mud_save, only: write_increment, PATH_LENGTH
   use mud_status, only: MUD_OK, MUD_NULL_ARGUMENT, MUD_NOT_WRITTEN
   use mud_tensor, only: is_finite
   use mud_to_host, only: get
   implicit none (type, external)
   private
   public :: place_t, place_at, c_refuse, refuse, begin_at, remark_on_suction, remark_on_begun, remark_on_end, &
             remark_on_void_ratio, remark_on_late_start, remark_on_rotation, remark_on_green_strain, save_if_asked

   integer, parameter :: DOOR_LENGTH = 23

   !> struct mud_place of mud.h.
   type, bind(c) :: given_place_t
      character(kind=c_char) :: entry(DOOR_LENGTH + 1)
      type(c_ptr) :: step, increment, element, point
   end type given_place_t

   !> KSTEP, KINC, NOEL and NPT of the host; each may be NULL.
   type :: place_t
      character(DOOR_LENGTH) :: door = 'umat_'   !< Name of the entry that was called.
      type(c_ptr) :: step = c_null_ptr, increment = c_null_ptr, element = c_null_ptr, point = c_null_ptr
   end type place_t

   !> A failed increment is saved here, if the environment names a folder.
   character(*), parameter :: SAVE_VARIABLE = 'MUD_SAVE_FAILED'
   !> Variable of the environment that says what a refusal does where PNEWDT is NULL; `keep` leaves STRESS as it is.
   character(*), parameter :: KEEP_VARIABLE = 'MUD_NO_PNEWDT'
   !> A PNEWDT below it is memory that was never set, no request of another point [-].
   real(wp), parameter :: SMALLEST_REQUEST = 1.0e-6_wp
   integer, parameter :: SENTENCE_LENGTH = 2*MESSAGE_LENGTH + 300
   character(*), parameter :: CLOSING = ' (said once a process; MUD_MESSAGES=off silences)'
   ! Kinds of sentences: a status code, what it is about, and the entry of that array.
   integer, parameter :: SUBJECTS = 9, ENTRIES = 128, CODES = 17
   integer, parameter :: FIRST_REMARK = CODES*SUBJECTS*ENTRIES   !< Remarks follow the failures.
   integer, parameter :: NOT_SAVED = FIRST_REMARK, ON_PROPS_UNITS = FIRST_REMARK + 3, ON_PRESSURE = FIRST_REMARK + 4, &
                         ON_LATE_START = FIRST_REMARK + 5, ON_TURN = FIRST_REMARK + 6, ON_GREEN = FIRST_REMARK + 7, &
                         BEFORE_STARTS = FIRST_REMARK + 7   !< The doubts about a start follow it.
contains
   !> Answers a host whose increment is refused. STATEV stays as it is. Pointers may be NULL; the report
   !> has a status other than MUD_OK.
   subroutine refuse(report, place, stress, ntens, pnewdt, scd)
      type(report_t), intent(in) :: report
      type(place_t), intent(in) :: place
      type(c_ptr), intent(in) :: stress, ntens, pnewdt, scd
      real(c_double), pointer :: code
      logical :: stops

      stops = .false.
      if (c_associated(pnewdt)) then
         call ask_for_a_cut(report, pnewdt)
      else if (c_associated(stress)) then
         call stop_host(stress, integer_at(ntens), stops)
      end if
      if (c_associated(scd)) then
         call c_f_pointer(scd, code)
         code = real(report%status, c_double)
      end if
      if (c_associated(pnewdt)) then
         call say_refusal(report, place, '')
      else if (stops) then
         call say_refusal(report, place, '. PNEWDT is NULL, so STRESS is NaN to stop the analysis '// &
                          '(MUD_NO_PNEWDT=keep leaves it)')
      else
         call say_refusal(report, place, '. PNEWDT is NULL: the host cannot know, and what it computes from here '// &
                          'is wrong')
      end if
   end subroutine refuse

   !> Place of an increment in the words of mud.h; NULL: an entry without a name.
   type(place_t) function place_at(pointer) result(place)
      type(c_ptr), intent(in) :: pointer
      type(given_place_t), pointer :: given
      integer :: i

      place%door = 'mud_increment_at'
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, given)
      place%door = ''
      do i = 1, DOOR_LENGTH
         if (given%entry(i) == c_null_char) exit
         place%door(i:i) = given%entry(i)
      end do
      place%step = given%step
      place%increment = given%increment
      place%element = given%element
      place%point = given%point
   end function place_at

   !> See mud.h. Returns the status of the report, MUD_NULL_ARGUMENT without one.
   integer(c_int) function c_refuse(place, report_in, consequence, stress, n) bind(c, name='mud_refuse')
      type(c_ptr), value :: place, report_in, consequence, stress
      integer(c_int), value :: n
      type(report_t), pointer :: report
      character(MESSAGE_LENGTH) :: text
      logical :: whole, stops

      c_refuse = MUD_NULL_ARGUMENT
      if (.not. c_associated(report_in)) return
      call c_f_pointer(report_in, report)
      c_refuse = report%status
      call get(consequence, text, whole)
      if (c_associated(stress) .and. n > 0) then
         call stop_host(stress, n, stops)
         text = trim(text)//merge('. Its stress is NaN, to stop the analysis                          ', &
                                  '. The old stress is kept: what the host computes from here is wrong', stops)
      end if
      call say_refusal(report, place_at(place), trim(text))
   end function c_refuse

   !> PNEWDT is written only to ask for a cut, and never raised: another point may have asked for a smaller one. Hosts
   !> that enter with 0 or less, or with nothing, have no request yet.
   subroutine ask_for_a_cut(report, pnewdt)
      type(report_t), intent(in) :: report
      type(c_ptr), intent(in) :: pnewdt
      real(c_double), pointer :: factor

      call c_f_pointer(pnewdt, factor)
      if (is_finite(factor)) then
         if (factor >= SMALLEST_REQUEST .and. factor <= report%pnewdt) return
      end if
      factor = report%pnewdt
   end subroutine ask_for_a_cut

   !> Sets the stress to NaN: without PNEWDT a host would continue with the old stress, and a NaN stops it. The stress
   !> stays where the user wants that.
   subroutine stop_host(stress, ntens, stops)
      type(c_ptr), intent(in) :: stress
      integer, intent(in) :: ntens   !< NTENS as the host gives it; it may be what is wrong.
      logical, intent(out) :: stops
      real(c_double), pointer, contiguous :: components(:)

      stops = .not. environment_is(KEEP_VARIABLE, 'keep')
      if (.not. stops) return
      call c_f_pointer(stress, components, [min(max(ntens, 1), 6)])
      components = transfer(int(z'7FF8000000000000', int64), 1.0_wp)
      call report_at_exit()
   end subroutine stop_host

   pure integer function kind_of(report)
      type(report_t), intent(in) :: report

      kind_of = (min(max(report%status - MUD_NOT_WRITTEN, 0), CODES - 1)*SUBJECTS &
                 + min(max(report%subject, 0), SUBJECTS - 1))*ENTRIES + min(max(report%index, 0), ENTRIES - 1)
   end function kind_of

   !> Why an increment was refused and what becomes of it: the first time that this failure is met. Values in the unit
   !> that the report has.
   subroutine say_refusal(report, place, consequence)
      type(report_t), intent(in) :: report
      type(place_t), intent(in) :: place
      character(*), intent(in) :: consequence   !< Follows the message.
      character(SENTENCE_LENGTH) :: text
      character(12) :: code

      if (.not. first_time(kind_of(report))) return
      write (code, '(i0)') report%status
      text = 'MUD: '//trim(place%door)//' refused the increment at '//trim(place_text(place))//', status '// &
             trim(code)//': '//report_text(report)
      if (report%status == MUD_NULL_ARGUMENT .and. report%index >= 1 .and. report%index <= size(ARGUMENT_NAMES)) then
         text = trim(text)//': '//ARGUMENT_NAMES(report%index)
      end if
      call write_message(trim(text)//consequence//CLOSING)
   end subroutine say_refusal

   !> Says that the suction of STATEV was taken instead of PREDEF. In the unit of p_atm, once a process for each
   !> reading.
   subroutine remark_on_suction(suction, place)
      type(suction_t), intent(in) :: suction
      type(place_t), intent(in) :: place
      character(SENTENCE_LENGTH) :: text

      if (.not. first_time(FIRST_REMARK + suction%reading)) return
      if (suction%reading == SUCTION_CONTRADICTS) then
         text = 'the suction PREDEF(1) is '//trim(number(suction%predef))//' at the start of the increment, but '// &
                'STATEV holds '//trim(number(suction%start))//' from the end of the one before: the increment runs '// &
                'from there to PREDEF(1) + DPRED(1) = '//trim(number(suction%start + suction%change))// &
                '. Does the host pass the suction at the end of the increment, or was STATEV not kept?'
      else
         text = 'PREDEF(1) is '//trim(number(suction%predef))//', but a host that enters with PNEWDT = -1, as '// &
                'CalculiX does, leaves PREDEF and DPRED unset: they are not read, and the suction of STATEV, '// &
                trim(number(suction%start))//', holds. Preset it there; a host that does set PREDEF must enter '// &
                'with another PNEWDT, such as 1'
      end if
      call remark(text, place)
   end subroutine remark_on_suction

   !> Says that a point begins anew in the midst of the analysis. time: TIME(2) of the host.
   subroutine remark_on_late_start(time, place)
      real(wp), intent(in) :: time
      type(place_t), intent(in) :: place

      if (.not. first_time(ON_LATE_START)) return
      call remark('STATEV is not initialised (layout 0) though the increment begins at TIME(2) = '// &
                  trim(number(time))//', so the point begins anew, with its present stress and without a past. '// &
                  'That is right for an element that is activated now. After a restart it means that the host has '// &
                  'lost STATEV, as CalculiX does with *RESTART, and what it computes from here is wrong: compute '// &
                  'all steps in one run', place)
   end subroutine remark_on_late_start

   !> Says that DROT is not read.
   subroutine remark_on_rotation(place)
      type(place_t), intent(in) :: place

      if (.not. first_time(ON_TURN)) return
      call remark('DROT is a rotation, but it is not read: a host that enters with PNEWDT = -1, as CalculiX does, '// &
                  'keeps stress and strain in axes that do not turn. A host whose axes turn must enter with '// &
                  'another PNEWDT, such as 1', place)
   end subroutine remark_on_rotation

   !> Says that the strain is Green's.
   subroutine remark_on_green_strain(place)
      type(place_t), intent(in) :: place

      if (.not. first_time(ON_GREEN)) return
      call remark('STRAN is Green''s strain of DFGRD1, as CalculiX gives it with NLGEOM to a material of the name '// &
                  '@ABAQUS_..., but MUD takes logarithmic strain: what the host computes with large strains is '// &
                  'wrong. Name the material @ABAQUSNL_... (linked statically: ABAQUSNL_...), or leave NLGEOM out', &
                  place)
   end subroutine remark_on_green_strain

   !> One line of a remark; the caller has asked whether it is new.
   subroutine remark(text, place)
      character(*), intent(in) :: text
      type(place_t), intent(in) :: place

      call write_message('MUD: remark of '//trim(place%door)//' at '//trim(place_text(place))//': '//trim(text)// &
                         CLOSING)
   end subroutine remark

   !> Begins a point without a past, and says what is doubtful about it and about PROPS, the warning of
   !> mud_validate_props: hosts do not ask for that. Arguments, units and codes as in kernel_begin; STATEV presets the
   !> void ratio and, with hysteresis, the saturation.
   subroutine begin_at(par, props, stress, suction, statev, place, report)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: props(NPROPS), suction
      real(wp), intent(inout) :: stress(6), statev(:)
      type(place_t), intent(in) :: place
      type(report_t), intent(out) :: report
      character(ADVICE_LENGTH) :: advice
      real(wp) :: given(6)

      given = stress
      call kernel_begin(par, stress, suction, (statev(S_VOID_RATIO)), statev, report, &
                        read_preset(par%suction%retention_t, statev(S_SATURATION)))
      if (report%status /= MUD_OK) return
      call remark_on_begun(par, given, statev, place)
      advice = advice_on(props)
      if (advice == '') return
      if (first_time(ON_PROPS_UNITS)) call remark(advice, place)
   end subroutine begin_at

   !> Says once a process what is doubtful about a point that began: arguments of doubts_on_start.
   subroutine remark_on_begun(par, stress, statev, place)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6), statev(:)
      type(place_t), intent(in) :: place
      logical :: raised(START_DOUBTS)
      integer :: i

      raised = doubts_on_start(par, stress, statev)
      do i = 1, START_DOUBTS
         if (.not. raised(i)) cycle
         if (first_time(BEFORE_STARTS + i)) call remark(advice_on_start(par, stress, statev, i), place)
      end do
   end subroutine remark_on_begun

   !> Says that the void ratio of an update that passed is where the model has no meaning, as at a start.
   subroutine remark_on_void_ratio(statev, place)
      real(wp), intent(in) :: statev(:)
      type(place_t), intent(in) :: place

      if (.not. is_too_loose(statev)) return
      if (first_time(BEFORE_STARTS + TOO_LOOSE)) call remark('the void ratio has come to '// &
                                                             advice_on_void_ratio(statev), place)
   end subroutine remark_on_void_ratio

   !> Says where the state after an update that passed has no meaning: p' below zero, which the tension cut-off
   !> prevents where it is on, or its void ratio.
   subroutine remark_on_end(stress, statev, place)
      real(wp), intent(in) :: stress(6), statev(:)   !< Effective stress, tension positive, in the unit of p_atm.
      type(place_t), intent(in) :: place

      if (.not. all(is_finite(stress))) return   ! as vumat_ leaves a refused point
      if (sum(stress(1:3)) > 0.0_wp) then
         if (first_time(ON_PRESSURE)) call remark('the mean effective stress p'' is '// &
            trim(number(-sum(stress(1:3))/3.0_wp))//'. The model has no meaning below 0, and its tension cut-off '// &
            'is off: do not use the results from here on; set cutoff = 1', place)
      end if
      call remark_on_void_ratio(statev, place)
   end subroutine remark_on_end

   !> Place of an increment in the analysis, as far as the host says it.
   function place_text(place) result(text)
      type(place_t), intent(in) :: place
      character(100) :: text

      text = ''
      call add('element', place%element)
      call add('point', place%point)
      call add('step', place%step)
      call add('increment', place%increment)
      if (text == '') text = 'a place that the host does not name'
   contains
      subroutine add(name, value)
         character(*), intent(in) :: name
         type(c_ptr), intent(in) :: value
         character(12) :: digits

         if (.not. c_associated(value)) return
         write (digits, '(i0)') integer_at(value)
         if (text /= '') text = trim(text)//','
         text = trim(text)//' '//name//' '//digits
         text = adjustl(text)
      end subroutine add
   end function place_text

   !> Saves a failed increment, if the user has named a folder, under a name that belongs to this failure: one file of
   !> each, whichever thread or process meets it first. That nothing could be written is said and changes nothing.
   !> Tension positive, engineering shear [-], stress and suction in the unit of p_atm.
   subroutine save_if_asked(props, stress, statev, d_strain, suction, d_suction, place, report)
      real(wp), intent(in) :: props(NPROPS), stress(6), statev(:), d_strain(6), suction, d_suction
      type(place_t), intent(in) :: place
      type(report_t), intent(in) :: report
      character(PATH_LENGTH) :: folder, path
      character(200) :: problem
      integer :: length, code, tangent
      logical :: taken

      call get_environment_variable(SAVE_VARIABLE, folder, length, code)
      if (length == 0) return
      if (code /= 0 .or. length > PATH_LENGTH - 80) then
         call remark_on_saving('the name of the folder is too long')
         return
      end if
      path = folder(:length)//'/mud_failed_'//trim(failure_name(report))//'.nml'
      inquire (file=path, exist=taken)
      if (taken) return
      tangent = 0   ! where PROPS have none, they fail before it matters
      if (is_finite(props(P_TANGENT))) tangent = nint(min(max(props(P_TANGENT), 0.0_wp), 3.0_wp))
      call write_increment(path, trim(place%door)//', '//place_text(place), props, stress, statev, d_strain, suction, &
                           d_suction, tangent, report, .true., problem)
      if (problem == '') return
      inquire (file=path, exist=taken)   ! by another thread or process, a moment ago
      if (.not. taken) call remark_on_saving(trim(problem)//', '//path)
   contains
      subroutine remark_on_saving(text)
         character(*), intent(in) :: text

         if (first_time(NOT_SAVED)) then
            call write_message('MUD: umat_ could not save a failed increment in the folder that MUD_SAVE_FAILED '// &
                               'names: '//trim(text)//'. Name a folder that exists, on a disk with room'//CLOSING)
         end if
      end subroutine remark_on_saving
   end subroutine save_if_asked
end module mud_refusals
