!> MUD through its public interface: mud_update, or umat_ itself as a foreign code would call it.
module fe_mud
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_char, c_null_char, c_ptr, c_loc
   use mud_interface, only: mud_report, mud_init_state, mud_update, mud_status_text, mud_index, MUD_STATEV, &
                            MUD_TANGENT_NONE, MUD_PROPS
   use kinds, only: wp
   use fe_material, only: material_t, answer_t
   use texts, only: from_c
   implicit none (type, external)
   private
   public :: mud_t, make_mud

   integer, parameter :: BUFFER = 600
   integer, parameter :: PLANE(4) = [1, 2, 3, 4]

   type, extends(material_t) :: mud_t
      real(wp), allocatable :: props(:)
      logical :: by_umat = .false.
      integer :: tangent = 0                              !< Kind of tangent, of PROPS.
      integer :: i_dsigma = 0, i_n_rate = 0, i_e_0 = 0    !< Places in STATEV and PROPS, from 1.
   contains
      procedure :: start
      procedure :: update
      procedure :: explain
      procedure :: initial_void_ratio
   end type mud_t

   interface
      subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                      temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, &
                      pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc) bind(c, name='umat_')
         import :: c_ptr
         type(c_ptr), value :: stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                               time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                               nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc
      end subroutine umat
   end interface
contains
   !> The law for a checked set of parameters.
   subroutine make_mud(props, n_state, by_umat, law)
      real(wp), intent(in) :: props(:)
      integer, intent(in) :: n_state
      logical, intent(in) :: by_umat
      type(mud_t), intent(out) :: law

      law%props = props
      law%n_state = n_state
      law%by_umat = by_umat
      law%tangent = nint(props(mud_index(MUD_PROPS, 'tangent'//c_null_char) + 1))
      law%i_e_0 = mud_index(MUD_PROPS, 'e_0'//c_null_char) + 1
      law%i_dsigma = mud_index(MUD_STATEV, 'dsigma_dpc_11'//c_null_char) + 1
      law%i_n_rate = mud_index(MUD_STATEV, 'n_rate'//c_null_char) + 1
   end subroutine make_mud

   subroutine start(self, stress, suction, void_ratio, state, text)
      class(mud_t), intent(in) :: self
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(in) :: suction, void_ratio
      real(wp), intent(inout) :: state(:)
      character(*), intent(out) :: text
      character(kind=c_char, len=BUFFER) :: raw

      raw = c_null_char
      text = ''
      state = 0.0_wp
      if (mud_init_state(self%props, size(self%props), stress, suction, void_ratio, state, size(state), raw, BUFFER) &
          /= 0) text = from_c(raw)
   end subroutine start

   subroutine update(self, stress, state, strain, suction, d_suction, with_slope, answer, new_state)
      class(mud_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), state(:), strain(6), suction, d_suction
      logical, intent(in) :: with_slope
      type(answer_t), intent(out) :: answer
      real(wp), intent(inout) :: new_state(:)
      real(wp) :: slope(6, 6), slope_suction(6)
      type(mud_report) :: report

      if (self%by_umat) then
         call update_by_umat(self, stress, state, strain, suction, d_suction, answer, new_state)
         return
      end if
      answer%stress = stress
      if (with_slope) then
         slope = 0.0_wp
         slope_suction = 0.0_wp
         answer%code = mud_update(self%props, size(self%props), stress, state, size(state), strain, suction, &
                                  d_suction, self%tangent, answer%stress, new_state, dsig_deps=slope, &
                                  dsig_dpc=slope_suction, report=report)
         answer%slope = slope(PLANE, PLANE)
         answer%slope_suction = slope_suction(PLANE)
      else
         answer%code = mud_update(self%props, size(self%props), stress, state, size(state), strain, suction, &
                                  d_suction, MUD_TANGENT_NONE, answer%stress, new_state, report=report)
      end if
      answer%factor = report%pnewdt
      answer%rate_evaluations = report%n_rate
   end subroutine update

   !> NTENS 4, as an axisymmetric element of a foreign code has it; the slope against suction comes in STATEV.
   subroutine update_by_umat(self, stress, state, strain, suction, d_suction, answer, new_state)
      class(mud_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), state(:), strain(6), suction, d_suction
      type(answer_t), intent(out) :: answer
      real(wp), intent(inout) :: new_state(:)
      real(c_double), target :: stress4(4), statev(self%n_state), ddsdde(4, 4), strain4(4), total(4), time(2), dtime, &
                                predef(1), dpred(1), props(size(self%props)), coords(3), drot(3, 3), pnewdt, celent, &
                                unit(3, 3), sse, spd, scd, rpl, ddsddt(4), drplde(4), drpldt, temp, dtemp
      integer(c_int), target :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
      character(kind=c_char, len=80), target :: name
      real(wp) :: rate_evaluations

      stress4 = stress(PLANE)
      statev = state
      ddsdde = 0.0_wp
      strain4 = strain(PLANE)
      predef = suction
      dpred = d_suction
      props = self%props
      drot = 0.0_wp
      drot(1, 1) = 1.0_wp
      drot(2, 2) = 1.0_wp
      drot(3, 3) = 1.0_wp
      unit = drot
      total = 0.0_wp
      time = 0.0_wp
      dtime = 1.0_wp
      coords = 0.0_wp
      pnewdt = 1.0_wp
      celent = 1.0_wp
      sse = 0.0_wp
      spd = 0.0_wp
      scd = 0.0_wp
      rpl = 0.0_wp
      ddsddt = 0.0_wp
      drplde = 0.0_wp
      drpldt = 0.0_wp
      temp = 0.0_wp
      dtemp = 0.0_wp
      ndi = 3
      nshr = 1
      ntens = 4
      nstatv = size(statev)
      nprops = size(props)
      noel = 1
      npt = 1
      layer = 1
      kspt = 1
      kstep = 1
      kinc = 1
      name = 'MUD'
      call umat(c_loc(stress4), c_loc(statev), c_loc(ddsdde), c_loc(sse), c_loc(spd), c_loc(scd), c_loc(rpl), &
                c_loc(ddsddt), c_loc(drplde), c_loc(drpldt), c_loc(total), c_loc(strain4), c_loc(time), c_loc(dtime), &
                c_loc(temp), c_loc(dtemp), c_loc(predef), c_loc(dpred), c_loc(name), c_loc(ndi), c_loc(nshr), &
                c_loc(ntens), c_loc(nstatv), c_loc(props), c_loc(nprops), c_loc(coords), c_loc(drot), c_loc(pnewdt), &
                c_loc(celent), c_loc(unit), c_loc(unit), c_loc(noel), c_loc(npt), c_loc(layer), c_loc(kspt), &
                c_loc(kstep), c_loc(kinc))
      answer%code = nint(scd)
      answer%factor = pnewdt
      if (answer%code /= 0) return
      answer%stress(PLANE) = stress4
      answer%slope = ddsdde
      answer%slope_suction = statev(self%i_dsigma:self%i_dsigma + 3)
      rate_evaluations = statev(self%i_n_rate) - state(self%i_n_rate)
      answer%rate_evaluations = nint(rate_evaluations)
      new_state = statev
   end subroutine update_by_umat

   subroutine explain(self, answer, text)
      class(mud_t), intent(in) :: self
      type(answer_t), intent(in) :: answer
      character(*), intent(out) :: text
      character(kind=c_char, len=BUFFER) :: raw

      raw = c_null_char
      if (mud_status_text(int(answer%code, c_int), raw, BUFFER) < 0) raw = c_null_char
      text = from_c(raw)
      if (self%by_umat) text = 'umat_: '//text
   end subroutine explain

   pure real(wp) function initial_void_ratio(self)
      class(mud_t), intent(in) :: self

      initial_void_ratio = self%props(self%i_e_0)
   end function initial_void_ratio
end module fe_mud
