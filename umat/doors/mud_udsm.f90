! SPDX-License-Identifier: MIT
!> User-defined soil model as PLAXIS asks for it, with the symbols that gfortran would give: user_mod_, getparamcount_
!> and so on. One model, number 1. Components 11, 22, 33, 12, 23, 13, tension positive, engineering shear, effective
!> stress. Texts are Pascal's: a byte with the length, then the letters, into 256 bytes of the host. An increment cannot
!> be cut by such a host, so a hard one is taken in pieces.
module mud_udsm
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_null_char, c_associated, c_f_pointer
   use mud_door, only: ORDER, place_of, props_at, statev_at, fewest_props, prepare
   use mud_interface, only: mud_report, mud_blocks, mud_place, mud_prepared_size, mud_prepared_statev, &
      mud_increment_at, mud_refuse, mud_text, MUD_PROPS, MUD_STATEV, MUD_NAME, MUD_UNIT, MUD_OK, &
      MUD_NULL_ARGUMENT, MUD_BAD_OPTION, MUD_BAD_NSTATV, MUD_ON_ARGUMENT, MUD_ON_STATEV, MUD_TANGENT_NONE, &
      MUD_TANGENT_ELASTIC, MUD_IN_PIECES
   implicit none (type, external)
   private
   public :: user_mod, model_count, model_name, param_count, param_name, param_unit, state_count, state_name, state_unit

   integer, parameter :: wp = c_double
   integer, parameter :: BEGIN_STATE = 1, STRESSES = 2, STIFFNESS = 3, HOW_MANY = 4, ATTRIBUTES = 5, &
                         ELASTIC_STIFFNESS = 6
   integer(c_int), parameter :: TENSION_POINT = 2, HARDENING_POINT = 5   !< Values of IPL.
   !> Poisson's ratio by which undrained soil is given water [-]; 0.5 would be singular.
   real(wp), parameter :: UNDRAINED = 0.495_wp
   !> A mean stress below this share of an atmosphere is no initial stress: it comes later [-].
   real(wp), parameter :: NO_STRESS = 1.0e-6_wp
   integer, parameter :: LONGEST = 255

   !> Material and point of a call.
   type :: soil_t
      type(mud_place) :: place
      real(c_double), pointer, contiguous :: material(:) => null(), props(:) => null(), state(:) => null()
      real(wp) :: stress(6) = 0.0_wp, suction = 0.0_wp
   end type soil_t
contains
   !> IDTASK 1 initial state variables into STVAR0, 2 stresses, 3 stiffness, 4 number of state variables, 5 kind of
   !> stiffness, 6 elastic stiffness. IABORT 1 where a task fails; a sentence says why. Stress and stiffness in the unit
   !> of p_atm, tension positive. PROPS without those of hysteresis. Codes as in kernel_point, besides MUD_BAD_OPTION
   !> for an unknown task or model, MUD_NULL_ARGUMENT and MUD_BAD_NSTATV.
   subroutine user_mod(idtask, imod, isundr, istep, iter, iel, int, x, y, z, time0, dtime, props, sig0, swp0, stvar0, &
                       deps, d, bulkw, sig, swp, stvar, ipl, nstat, nonsym, istrsdep, itimedep, itang, iprjdir, &
                       iprjlen, iabort) bind(c, name='user_mod_')
      integer(c_int), intent(in) :: idtask, imod, isundr
      type(c_ptr), value :: istep, iter, iel, int, x, y, z, time0, dtime, props, sig0, swp0, stvar0, deps, d, sig, &
                            swp, stvar, ipl, iprjdir, iprjlen
      real(c_double), intent(inout) :: bulkw
      integer(c_int), intent(inout) :: nstat, nonsym, istrsdep, itimedep, itang, iabort
      type(soil_t) :: soil
      type(mud_report) :: report
      real(c_double), target :: material(mud_prepared_size())
      integer(c_int) :: code

      iabort = 0
      soil%place = place_of('user_mod_', istep, iter, iel, int)
      soil%material => material
      call check(idtask, imod, nstat, props, sig0, stvar0, soil, report)
      if (report%status == MUD_OK) then
         select case (idtask)
         case (BEGIN_STATE)
            call initialise(soil, report)
         case (STRESSES)
            call stresses_of(soil, isundr, swp0, deps, bulkw, sig, swp, stvar, ipl, report)
         case (STIFFNESS, ELASTIC_STIFFNESS)
            call stiffness_of(soil, idtask, isundr, deps, d, bulkw, report)
         case (HOW_MANY)
            call state_count(imod, nstat)
         case (ATTRIBUTES)
            nonsym = 1
            istrsdep = 1
            itimedep = 0
            itang = 1
         end select
      end if
      if (report%status /= MUD_OK) then
         iabort = 1
         code = mud_refuse(soil%place, report, '. IABORT is 1'//c_null_char, n=0_c_int)
      end if

      ! What the model does not use.
      associate (a => [c_associated(x), c_associated(y), c_associated(z), c_associated(time0), c_associated(dtime), &
                       c_associated(iprjdir), c_associated(iprjlen)])
      end associate
   end subroutine user_mod

   !> The task is known, the model is 1, PROPS are good, and STVAR0 has room, where the host says how much (NSTAT above
   !> 0). Tasks 4 and 5 need no arrays.
   subroutine check(idtask, imod, nstat, props, sig0, stvar0, soil, report)
      integer(c_int), intent(in) :: idtask, imod, nstat
      type(c_ptr), intent(in) :: props, sig0, stvar0
      type(soil_t), intent(inout) :: soil
      type(mud_report), intent(out) :: report

      if (idtask < BEGIN_STATE .or. idtask > ELASTIC_STIFFNESS) then
         report = mud_report(MUD_BAD_OPTION, MUD_ON_ARGUMENT, value=real(idtask, wp))
      else if (imod /= 1) then
         report = mud_report(MUD_BAD_OPTION, MUD_ON_ARGUMENT, value=real(imod, wp))
      else if (idtask /= HOW_MANY .and. idtask /= ATTRIBUTES) then
         if (c_associated(props) .and. c_associated(sig0) .and. c_associated(stvar0)) then
            call c_f_pointer(props, soil%props, [fewest_props()])
            call prepare(soil%props, soil%material, report)
            if (report%status /= MUD_OK) return
            soil%stress = read_six(sig0)
            call c_f_pointer(stvar0, soil%state, [mud_prepared_statev(soil%material)])
            if (nstat > 0 .and. nstat < size(soil%state)) then
               report = mud_report(MUD_BAD_NSTATV, MUD_ON_STATEV, value=real(nstat, wp), &
                                   lower=real(size(soil%state), wp), upper=huge(1.0_wp))
               return
            end if
            soil%suction = soil%state(statev_at('suction'))
         else
            report = mud_report(MUD_NULL_ARGUMENT, MUD_ON_ARGUMENT)
         end if
      end if
   end subroutine check

   !> A state that has begun stays. Without a stress (hosts ask before they know it) the first update begins it.
   subroutine initialise(soil, report)
      type(soil_t), intent(inout) :: soil
      type(mud_report), intent(inout) :: report
      real(wp) :: lifted(6), begun(size(soil%state))
      integer(c_int) :: code

      if (.not. all(ieee_is_finite(soil%stress))) return   ! said by the update
      if (abs(sum(soil%stress(1:3))) <= 3.0_wp*NO_STRESS*soil%props(props_at('p_atm'))) return
      code = mud_increment_at(soil%place, soil%material, soil%stress, soil%state, size(soil%state), soil%suction, &
                              suction=soil%suction, tangent=MUD_TANGENT_NONE, stress1=lifted, statev1=begun, &
                              report=report)
      if (code == MUD_OK) soil%state = begun
   end subroutine initialise

   !> SIG, STVAR, SWP and IPL at the end of the increment; on failure all four stay. Suction is that of the state.
   subroutine stresses_of(soil, isundr, swp0, deps, bulkw, sig, swp, stvar, ipl, report)
      type(soil_t), intent(in) :: soil
      integer(c_int), intent(in) :: isundr
      type(c_ptr), intent(in) :: swp0, deps, sig, swp, stvar, ipl
      real(c_double), intent(in) :: bulkw
      type(mud_report), intent(inout) :: report
      real(c_double), pointer, contiguous :: state(:), host(:)
      real(c_double), pointer :: pore0, pore
      integer(c_int), pointer :: plastic
      real(wp) :: strain(6), stress(6), sheared
      integer(c_int) :: code
      integer :: total

      if (.not. (c_associated(deps) .and. c_associated(sig) .and. c_associated(stvar))) then
         report = mud_report(MUD_NULL_ARGUMENT, MUD_ON_ARGUMENT)
         return
      end if
      strain = read_six(deps)
      total = statev_at('eps_q_p_total')
      sheared = soil%state(total)
      call c_f_pointer(stvar, state, [size(soil%state)])
      code = mud_increment_at(soil%place, soil%material, soil%stress, soil%state, size(soil%state), soil%suction, &
                              strain, soil%suction, MUD_TANGENT_NONE + MUD_IN_PIECES, stress, state, report=report)
      if (code /= MUD_OK) return
      if (c_associated(ipl)) then
         call c_f_pointer(ipl, plastic)
         plastic = 0
         if (state(total) > sheared) plastic = HARDENING_POINT
         if (state(statev_at('open')) > 0.5_wp) plastic = TENSION_POINT
      end if
      call c_f_pointer(sig, host, [6])
      host = stress(ORDER)
      if (.not. (c_associated(swp0) .and. c_associated(swp))) return
      call c_f_pointer(swp0, pore0)
      call c_f_pointer(swp, pore)
      pore = pore0
      if (isundr == 1) pore = pore0 + bulkw*sum(strain(1:3))
   end subroutine stresses_of

   !> D by columns: that of the increment as `tangent` of PROPS says (elastic where it says none, or where the increment
   !> fails, which task 2 reports), or elastic. Undrained soil is given the bulk modulus of its water.
   subroutine stiffness_of(soil, idtask, isundr, deps, d, bulkw, report)
      type(soil_t), intent(in) :: soil
      integer(c_int), intent(in) :: idtask, isundr
      type(c_ptr), intent(in) :: deps, d
      real(c_double), intent(inout) :: bulkw
      type(mud_report), intent(inout) :: report
      type(mud_blocks) :: slopes, at_rest
      real(c_double), pointer, contiguous :: matrix(:, :)
      real(wp) :: still(6), stress(6), state(size(soil%state)), bulk, shear
      integer(c_int) :: code
      integer :: kind

      if (.not. c_associated(d)) then
         report = mud_report(MUD_NULL_ARGUMENT, MUD_ON_ARGUMENT)
         return
      end if
      still = 0.0_wp
      code = mud_increment_at(soil%place, soil%material, soil%stress, soil%state, size(soil%state), soil%suction, &
                              still, soil%suction, MUD_TANGENT_ELASTIC, stress, state, at_rest, report)
      if (code /= MUD_OK) return
      if (isundr == 1) then
         bulk = (at_rest%dsig_deps(1, 1) + 2.0_wp*at_rest%dsig_deps(1, 2))/3.0_wp
         shear = at_rest%dsig_deps(4, 4)
         bulkw = max(2.0_wp*shear*(1.0_wp + UNDRAINED)/(3.0_wp*(1.0_wp - 2.0_wp*UNDRAINED)) - bulk, 0.0_wp)
      end if
      kind = nint(soil%props(props_at('tangent')))
      slopes = at_rest
      ! On failure the slopes stay.
      if (idtask == STIFFNESS .and. kind >= MUD_TANGENT_ELASTIC .and. c_associated(deps)) &
         code = mud_increment_at(soil%place, soil%material, soil%stress, soil%state, size(soil%state), soil%suction, &
                                 read_six(deps), soil%suction, kind + MUD_IN_PIECES, stress, state, slopes)
      call c_f_pointer(d, matrix, [6, 6])
      matrix = slopes%dsig_deps(ORDER, ORDER)
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

      n = merge(fewest_props(), 0, imod == 1)
   end subroutine param_count

   !> Name of parameter i from 1, empty if there is none.
   subroutine param_name(imod, i, name) bind(c, name='getparamname_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: name(*)

      call put_pascal(text_of(imod, MUD_PROPS, i, MUD_NAME), name)
   end subroutine param_name

   !> Unit of parameter i from 1 in the letters of PLAXIS, empty if there is none.
   subroutine param_unit(imod, i, unit) bind(c, name='getparamunit_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: unit(*)

      call put_pascal(unit_word(text_of(imod, MUD_PROPS, i, MUD_UNIT)), unit)
   end subroutine param_unit

   !> Number of state variables of a model, 0 if imod is not 1.
   subroutine state_count(imod, n) bind(c, name='getstatevarcount_')
      integer(c_int), intent(in) :: imod
      integer(c_int), intent(out) :: n

      n = merge(statev_at('turns') - 1, 0, imod == 1)   ! without those of hysteresis
   end subroutine state_count

   !> Name of state variable i from 1, empty if there is none.
   subroutine state_name(imod, i, name) bind(c, name='getstatevarname_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: name(*)

      call put_pascal(text_of(imod, MUD_STATEV, i, MUD_NAME), name)
   end subroutine state_name

   !> Unit of state variable i from 1 in the letters of PLAXIS, empty if there is none.
   subroutine state_unit(imod, i, unit) bind(c, name='getstatevarunit_')
      integer(c_int), intent(in) :: imod, i
      character(kind=c_char), intent(inout) :: unit(*)

      call put_pascal(unit_word(text_of(imod, MUD_STATEV, i, MUD_UNIT)), unit)
   end subroutine state_unit

   !> Field of an entry of PROPS or STATEV, empty if a model without hysteresis does not have it.
   function text_of(imod, list, i, field) result(text)
      integer(c_int), intent(in) :: imod, list, i, field
      character(LONGEST) :: text
      character(kind=c_char) :: letters(LONGEST + 1)
      integer(c_int) :: n
      integer :: k

      text = ''
      call param_count(imod, n)
      if (list == MUD_STATEV) call state_count(imod, n)
      if (i < 1 .or. i > n) return
      if (mud_text(list, i - 1, field, letters, size(letters)) /= MUD_OK) return
      do k = 1, LONGEST
         if (letters(k) == c_null_char) return
         text(k:k) = letters(k)
      end do
   end function text_of

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
