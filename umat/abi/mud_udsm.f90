! SPDX-License-Identifier: MIT
!> User-defined soil model as PLAXIS asks for it, with the symbols that gfortran would give: user_mod_, getparamcount_
!> and so on. One model, number 1. Components 11, 22, 33, 12, 23, 13, tension positive, engineering shear, effective
!> stress. Texts are Pascal's: a byte with the length, then the letters, into 256 bytes of the host. An increment cannot
!> be cut by such a host, so a hard one is taken in pieces.
module mud_udsm
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_associated, c_f_pointer
   use mud_arguments, only: has_past
   use mud_kernel, only: report_t, output_t, kernel_point, kernel_init, failed_report
   use mud_kinds, only: wp
   use mud_params, only: params_t, read_params, completed
   use mud_pieces, only: update_in_pieces
   use mud_refusals, only: place_t, say_refusal, remark_on_props, remark_on_start, remark_on_end, save_if_asked
   use mud_registry, only: NPROPS_BASE, &
      NSTATV => NSTATV_BASE, PROPERTIES, VARIABLES, statev_name, statev_variable, &
      S_LAYOUT, S_VOID_RATIO, S_SUCTION, S_OPEN, S_EPS_Q_P_TOTAL
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_OPTION, ON_ARGUMENT
   use mud_tensor, only: is_finite
   implicit none (type, external)
   private
   public :: user_mod, model_count, model_name, param_count, param_name, param_unit, state_count, state_name, state_unit

   integer, parameter :: ORDER(6) = [1, 2, 3, 4, 6, 5]   !< Order of the host's components; its own inverse.
   integer, parameter :: ELASTIC = 1                     !< Tangent kind.
   integer, parameter :: BEGIN_STATE = 1, STRESSES = 2, STIFFNESS = 3, HOW_MANY = 4, ATTRIBUTES = 5, &
                         ELASTIC_STIFFNESS = 6
   integer(c_int), parameter :: TENSION_POINT = 2, HARDENING_POINT = 5   !< Values of IPL.
   !> Poisson's ratio by which undrained soil is given water [-]; 0.5 would be singular.
   real(wp), parameter :: UNDRAINED = 0.495_wp
   !> A mean stress below this share of an atmosphere is no initial stress: it comes later [-].
   real(wp), parameter :: NO_STRESS = 1.0e-6_wp
   integer, parameter :: LONGEST = 255

contains
   !> IDTASK 1 initial state variables into STVAR0, 2 stresses, 3 stiffness, 4 number of state variables, 5 kind of
   !> stiffness, 6 elastic stiffness. IABORT 1 where a task fails; a sentence says why. Stress and stiffness in the unit
   !> of p_atm, tension positive. PROPS without those of hysteresis. Codes as in kernel_point, besides MUD_BAD_OPTION
   !> for an unknown task or model and MUD_NULL_ARGUMENT.
   subroutine user_mod(idtask, imod, isundr, istep, iter, iel, int, x, y, z, time0, dtime, props, sig0, swp0, stvar0, &
                       deps, d, bulkw, sig, swp, stvar, ipl, nstat, nonsym, istrsdep, itimedep, itang, iprjdir, &
                       iprjlen, iabort) bind(c, name='user_mod_')
      integer(c_int), intent(in) :: idtask, imod, isundr
      type(c_ptr), value :: istep, iter, iel, int, x, y, z, time0, dtime, props, sig0, swp0, stvar0, deps, d, sig, &
                            swp, stvar, ipl, iprjdir, iprjlen
      real(c_double), intent(inout) :: bulkw
      integer(c_int), intent(inout) :: nstat, nonsym, istrsdep, itimedep, itang, iabort
      type(report_t) :: report
      type(params_t) :: par
      type(place_t) :: place

      iabort = 0
      place = place_t('user_mod_', istep, iter, iel, int)
      call check(idtask, imod, props, sig0, stvar0, par, report)
      if (report%status == MUD_OK) then
         select case (idtask)
         case (BEGIN_STATE)
            call initialise(par, props, sig0, stvar0, place, report)
         case (STRESSES)
            call stresses_of(par, isundr, props, sig0, swp0, stvar0, deps, bulkw, sig, swp, stvar, ipl, place, report)
         case (STIFFNESS, ELASTIC_STIFFNESS)
            call stiffness_of(par, idtask, isundr, sig0, stvar0, deps, d, bulkw, report)
         case (HOW_MANY)
            nstat = NSTATV
         case (ATTRIBUTES)
            nonsym = 1
            istrsdep = 1
            itimedep = 0
            itang = 1
         end select
      end if
      if (report%status /= MUD_OK) then
         iabort = 1
         call say_refusal(report, place, '. IABORT is 1')
      end if

      ! What the model does not use.
      associate (a => [c_associated(x), c_associated(y), c_associated(z), c_associated(time0), c_associated(dtime), &
                       c_associated(iprjdir), c_associated(iprjlen)])
      end associate
   end subroutine user_mod

   !> The task is known, the model is 1, PROPS are good. Tasks 4 and 5 need no arrays.
   subroutine check(idtask, imod, props, sig0, stvar0, par, report)
      integer(c_int), intent(in) :: idtask, imod
      type(c_ptr), intent(in) :: props, sig0, stvar0
      type(params_t), intent(out) :: par
      type(report_t), intent(out) :: report
      real(c_double), pointer, contiguous :: values(:)
      type(mud_status_t) :: status

      if (idtask < BEGIN_STATE .or. idtask > ELASTIC_STIFFNESS) then
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(idtask, wp))
      else if (imod /= 1) then
         status = fail(MUD_BAD_OPTION, ON_ARGUMENT, 0, real(imod, wp))
      else if (idtask /= HOW_MANY .and. idtask /= ATTRIBUTES) then
         if (c_associated(props) .and. c_associated(sig0) .and. c_associated(stvar0)) then
            call c_f_pointer(props, values, [NPROPS_BASE])
            call read_params(values, par, status)
         else
            status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
         end if
      end if
      report = failed_report(status)
   end subroutine check

   !> A state that has begun stays. Without a stress (hosts ask before they know it) the first update begins it.
   subroutine initialise(par, props, sig0, stvar0, place, report)
      type(params_t), intent(in) :: par
      type(c_ptr), intent(in) :: props, sig0, stvar0
      type(place_t), intent(in) :: place
      type(report_t), intent(inout) :: report
      real(c_double), pointer, contiguous :: values(:), state(:)
      real(wp) :: stress(6)

      call c_f_pointer(props, values, [NPROPS_BASE])
      call remark_on_props(completed(values), place)
      stress = read_six(sig0)
      if (.not. all(is_finite(stress))) return   ! said by the update
      if (abs(sum(stress(1:3))) <= 3.0_wp*NO_STRESS*par%p_atm) return
      call c_f_pointer(stvar0, state, [NSTATV])
      if (.not. is_finite(state(S_LAYOUT))) return
      if (abs(state(S_LAYOUT)) > 0.0_wp) return
      call remark_on_start(par, stress, state, state(S_SUCTION), place)
      call kernel_init(values, stress, state(S_SUCTION), state(S_VOID_RATIO), state, report)
   end subroutine initialise

   !> SIG, STVAR, SWP and IPL at the end of the increment; on failure all four stay. Suction is that of the state.
   subroutine stresses_of(par, isundr, props, sig0, swp0, stvar0, deps, bulkw, sig, swp, stvar, ipl, place, report)
      type(params_t), intent(in) :: par
      integer(c_int), intent(in) :: isundr
      type(c_ptr), intent(in) :: props, sig0, swp0, stvar0, deps, sig, swp, stvar, ipl
      real(c_double), intent(in) :: bulkw
      type(place_t), intent(in) :: place
      type(report_t), intent(inout) :: report
      type(output_t) :: output
      real(c_double), pointer, contiguous :: values(:), state0(:), state1(:), stress(:)
      real(c_double), pointer :: pore0, pore
      integer(c_int), pointer :: plastic
      real(wp) :: stress0(6), strain(6)

      if (.not. (c_associated(deps) .and. c_associated(sig) .and. c_associated(stvar))) then
         report = failed_report(fail(MUD_NULL_ARGUMENT, ON_ARGUMENT))
         return
      end if
      stress0 = read_six(sig0)
      strain = read_six(deps)
      call c_f_pointer(stvar0, state0, [NSTATV])
      call remark_on_start(par, stress0, state0, state0(S_SUCTION), place)
      call update_in_pieces(par, stress0, state0, strain, state0(S_SUCTION), 0.0_wp, 0, output, report)
      if (report%status /= MUD_OK) then
         call c_f_pointer(props, values, [NPROPS_BASE])
         call save_if_asked(completed(values), stress0, state0, strain, state0(S_SUCTION), 0.0_wp, place, report)
         return
      end if
      call c_f_pointer(props, values, [NPROPS_BASE])
      if (.not. has_past(state0)) call remark_on_props(completed(values), place)
      call remark_on_end(output%stress, output%statev, place)
      if (c_associated(ipl)) then
         call c_f_pointer(ipl, plastic)
         plastic = 0
         if (output%statev(S_EPS_Q_P_TOTAL) > state0(S_EPS_Q_P_TOTAL)) plastic = HARDENING_POINT
         if (output%statev(S_OPEN) > 0.5_wp) plastic = TENSION_POINT
      end if
      call c_f_pointer(sig, stress, [6])
      stress = output%stress(ORDER)
      call c_f_pointer(stvar, state1, [NSTATV])
      state1 = output%statev(:NSTATV)
      if (.not. (c_associated(swp0) .and. c_associated(swp))) return
      call c_f_pointer(swp0, pore0)
      call c_f_pointer(swp, pore)
      pore = pore0
      if (isundr == 1) pore = pore0 + bulkw*sum(strain(1:3))
   end subroutine stresses_of

   !> D by columns: that of the increment as `tangent` of PROPS says (elastic where it says none, or where the increment
   !> fails, which task 2 reports), or elastic. Undrained soil is given the bulk modulus of its water.
   subroutine stiffness_of(par, idtask, isundr, sig0, stvar0, deps, d, bulkw, report)
      type(params_t), intent(in) :: par
      integer(c_int), intent(in) :: idtask, isundr
      type(c_ptr), intent(in) :: sig0, stvar0, deps, d
      real(c_double), intent(inout) :: bulkw
      type(report_t), intent(inout) :: report
      type(output_t) :: output, at_rest
      real(c_double), pointer, contiguous :: state0(:), matrix(:, :)
      real(wp) :: stress0(6), still(6), bulk, shear
      logical :: as_elastic

      if (.not. c_associated(d)) then
         report = failed_report(fail(MUD_NULL_ARGUMENT, ON_ARGUMENT))
         return
      end if
      stress0 = read_six(sig0)
      still = 0.0_wp
      call c_f_pointer(stvar0, state0, [NSTATV])
      call kernel_point(par, stress0, state0, still, state0(S_SUCTION), 0.0_wp, ELASTIC, at_rest, report)
      if (report%status /= MUD_OK) return
      if (isundr == 1) then
         bulk = (at_rest%dsig_deps(1, 1) + 2.0_wp*at_rest%dsig_deps(1, 2))/3.0_wp
         shear = at_rest%dsig_deps(4, 4)
         bulkw = max(2.0_wp*shear*(1.0_wp + UNDRAINED)/(3.0_wp*(1.0_wp - 2.0_wp*UNDRAINED)) - bulk, 0.0_wp)
      end if
      call c_f_pointer(d, matrix, [6, 6])
      as_elastic = idtask == ELASTIC_STIFFNESS .or. par%tangent < ELASTIC .or. .not. c_associated(deps)
      if (.not. as_elastic) then
         call update_in_pieces(par, stress0, state0, read_six(deps), state0(S_SUCTION), 0.0_wp, par%tangent, output, &
                               report)
         as_elastic = report%status /= MUD_OK
         report = failed_report(mud_status_t())
      end if
      if (as_elastic) then
         matrix = at_rest%dsig_deps(ORDER, ORDER)
      else
         matrix = output%dsig_deps(ORDER, ORDER)
      end if
   end subroutine stiffness_of

   !> Number of models: 1.
   subroutine model_count(n) bind(c, name='getmodelcount_')
      integer(c_int), intent(out) :: n

      n = 1
   end subroutine model_count

   !> Name of a model, empty if imod is not 1.
   subroutine model_name(imod, name) bind(c, name='getmodelname_')
      integer(c_int), intent(in) :: imod
      character(kind=c_char), intent(inout), target :: name(*)

      if (imod == 1) call put_pascal('MUD', name)
      if (imod /= 1) call put_pascal('', name)
   end subroutine model_name

   !> Number of parameters of a model, 0 if imod is not 1.
   subroutine param_count(imod, n) bind(c, name='getparamcount_')
      integer(c_int), intent(in) :: imod
      integer(c_int), intent(out) :: n

      n = merge(NPROPS_BASE, 0, imod == 1)
   end subroutine param_count

   !> Name of parameter i from 1, empty if there is none.
   subroutine param_name(imod, i, name) bind(c, name='getparamname_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: name(*)

      call put_pascal('', name)
      if (known(imod, i, NPROPS_BASE)) call put_pascal(PROPERTIES(i)%name, name)
   end subroutine param_name

   !> Unit of parameter i from 1 in the letters of PLAXIS, empty if there is none.
   subroutine param_unit(imod, i, unit) bind(c, name='getparamunit_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: unit(*)

      call put_pascal('', unit)
      if (known(imod, i, NPROPS_BASE)) call put_pascal(unit_word(PROPERTIES(i)%unit), unit)
   end subroutine param_unit

   !> Number of state variables of a model, 0 if imod is not 1.
   subroutine state_count(imod, n) bind(c, name='getstatevarcount_')
      integer(c_int), intent(in) :: imod
      integer(c_int), intent(out) :: n

      n = merge(NSTATV, 0, imod == 1)
   end subroutine state_count

   !> Name of state variable i from 1, empty if there is none.
   subroutine state_name(imod, i, name) bind(c, name='getstatevarname_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: name(*)

      call put_pascal('', name)
      if (known(imod, i, NSTATV)) call put_pascal(statev_name(i), name)
   end subroutine state_name

   !> Unit of state variable i from 1 in the letters of PLAXIS, empty if there is none.
   subroutine state_unit(imod, i, unit) bind(c, name='getstatevarunit_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: unit(*)

      call put_pascal('', unit)
      if (known(imod, i, NSTATV)) call put_pascal(unit_word(VARIABLES(statev_variable(i))%unit), unit)
   end subroutine state_unit

   pure logical function known(imod, i, n)
      integer(c_int), intent(in) :: imod, i
      integer, intent(in) :: n

      known = imod == 1 .and. i >= 1 .and. i <= n
   end function known

   !> Units in the letters that PLAXIS replaces by those of the project: F force, L length; - for none.
   pure function unit_word(unit) result(word)
      character(*), intent(in) :: unit
      character(20) :: word

      select case (unit)
      case ('1')
         word = '-'
      case ('kPa')
         word = 'F/L^2#'
      case ('1/kPa')
         word = 'L^2/F#'
      case default
         word = unit
      end select
   end function unit_word

   !> Length in a byte, then the letters; nothing behind them.
   subroutine put_pascal(text, buffer)
      character(*), intent(in) :: text
      character(kind=c_char), intent(inout) :: buffer(*)
      integer :: i, n

      n = min(len_trim(text), LONGEST)
      buffer(1) = achar(n, c_char)
      do i = 1, n
         buffer(i + 1) = text(i:i)
      end do
   end subroutine put_pascal

   !> Six components of the host in the order of MUD.
   function read_six(pointer) result(six)
      type(c_ptr), intent(in) :: pointer
      real(wp) :: six(6)
      real(c_double), pointer, contiguous :: given(:)

      call c_f_pointer(pointer, given, [6])
      six = given(ORDER)
   end function read_six
end module mud_udsm
