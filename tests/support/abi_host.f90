! SPDX-License-Identifier: MIT
!> A host of umat_ as foreign programs are: everything by address, any address may be NULL.
module abi_host
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_char, c_loc, c_null_char, c_null_ptr
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_interface, only: mud_report, mud_blocks, mud_prepared_size, mud_prepare, mud_init, mud_update, &
      mud_message, MUD_TANGENT_ELASTIC, mud_default_props
   use mud_kinds, only: wp
   use mud_registry, only: NPROPS, NSTATV, NSTATV_BASE, P_HYSTERESIS, P_MEMORY_RULE, P_SCHEME, &
      P_X_0, P_X_REV, P_CAP_D, P_CAP_H, P_CUTOFF, RULE_CLASSIC, RULE_RETURN_POINT, SCHEME_OF_PAPER, S_LAYOUT, &
      S_VOID_RATIO, S_SATURATION, S_SUCTION
   use mud_tensor, only: is_finite
   use random_states, only: random_t, uniform, random_tensor
   implicit none (type, external)
   private
   public :: umat_call_t, call_umat, new_call, walked_call, take_rule, walk, random_strain, same_bits, untouched, &
             refusal, elastic_matrix, default_props, common_refusal, begin_once, update_once, prepared_of, &
             not_a_number, infinite, MARK, N_ARGUMENTS, UNIT_MATRIX, WITHOUT_GUARDS
   public :: A_STRESS, A_STATEV, A_DDSDDE, A_SCD, A_DSTRAN, A_PREDEF, A_DPRED, A_NDI, A_NTENS, A_NSTATV, A_PROPS, &
             A_NPROPS, A_DROT, A_PNEWDT, MANDATORY, TOUCHED, NO_CUT

   integer, parameter :: N_ARGUMENTS = 37
   integer(c_int), parameter :: LONG = 400           !< Bytes of a sentence.
   integer, parameter :: A_STRESS = 1, A_STATEV = 2, A_DDSDDE = 3, A_SCD = 6, A_DSTRAN = 12, A_PREDEF = 17, &
                         A_DPRED = 18, A_NDI = 20, A_NTENS = 22, A_NSTATV = 23, A_PROPS = 24, A_NPROPS = 25, &
                         A_DROT = 27, A_PNEWDT = 28
   !> The published model where a number of a memory rule is asked for: the next one after the rules.
   integer, parameter :: WITHOUT_GUARDS = RULE_RETURN_POINT + 1
   !> The arguments without which there is no answer.
   integer, parameter :: MANDATORY(7) = [A_STRESS, A_STATEV, A_DSTRAN, A_NTENS, A_NSTATV, A_PROPS, A_NPROPS]
   !> What `refusal` says if a failure wrote too much, asked for no cut.
   integer, parameter :: TOUCHED = 99, NO_CUT = 98
   real(wp), parameter :: MARK = 7.25_wp             !< Stands where nobody may write.
   real(wp), parameter :: UNIT_MATRIX(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1]*1.0_wp, [3, 3])

   !> Everything the host hands over; arrays are longer than they need to be and marked.
   type :: umat_call_t
      logical :: given(N_ARGUMENTS) = .true.   !< .false.: NULL
      real(c_double) :: stress(8) = MARK, statev(NSTATV + 4) = MARK, ddsdde(40) = MARK
      real(c_double) :: sse = MARK, spd = MARK, scd = 0.0_wp, rpl = MARK
      real(c_double) :: ddsddt(6) = MARK, drplde(6) = MARK, drpldt = MARK
      real(c_double) :: stran(6) = 0.0_wp, dstran(8) = 0.0_wp, time(2) = 0.0_wp, dtime = 0.0_wp
      real(c_double) :: temp = 20.0_wp, dtemp = 0.0_wp, predef(1) = 0.0_wp, dpred(1) = 0.0_wp
      character(kind=c_char, len=80) :: cmname = 'SAND'
      integer(c_int) :: ndi = 3, nshr = 3, ntens = 6, nstatv = NSTATV, nprops = NPROPS
      real(c_double) :: props(NPROPS + 1) = MARK, coords(3) = 0.0_wp, drot(3, 3) = UNIT_MATRIX
      real(c_double) :: pnewdt = 1.0_wp, celent = 1.0_wp, dfgrd0(3, 3) = UNIT_MATRIX, dfgrd1(3, 3) = UNIT_MATRIX
      integer(c_int) :: noel = 1, npt = 1, layer = 1, kspt = 1, kstep(4) = 1, kinc = 1
   end type umat_call_t

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
   !> PROPS of the paper with every default.
   function default_props() result(props)
      real(wp) :: props(NPROPS)

      if (mud_default_props(props, NPROPS) /= 0) error stop 'abi_host: no defaults'
   end function default_props

   subroutine call_umat(host)
      type(umat_call_t), intent(inout), target :: host
      type(c_ptr) :: a(N_ARGUMENTS)
      integer :: i

      a = [c_loc(host%stress), c_loc(host%statev), c_loc(host%ddsdde), c_loc(host%sse), c_loc(host%spd), &
           c_loc(host%scd), c_loc(host%rpl), c_loc(host%ddsddt), c_loc(host%drplde), c_loc(host%drpldt), &
           c_loc(host%stran), c_loc(host%dstran), c_loc(host%time), c_loc(host%dtime), c_loc(host%temp), &
           c_loc(host%dtemp), c_loc(host%predef), c_loc(host%dpred), c_loc(host%cmname), c_loc(host%ndi), &
           c_loc(host%nshr), c_loc(host%ntens), c_loc(host%nstatv), c_loc(host%props), c_loc(host%nprops), &
           c_loc(host%coords), c_loc(host%drot), c_loc(host%pnewdt), c_loc(host%celent), c_loc(host%dfgrd0), &
           c_loc(host%dfgrd1), c_loc(host%noel), c_loc(host%npt), c_loc(host%layer), c_loc(host%kspt), &
           c_loc(host%kstep), c_loc(host%kinc)]
      do i = 1, N_ARGUMENTS
         if (.not. host%given(i)) a(i) = c_null_ptr
      end do
      call umat(a(1), a(2), a(3), a(4), a(5), a(6), a(7), a(8), a(9), a(10), a(11), a(12), a(13), a(14), a(15), a(16), &
                a(17), a(18), a(19), a(20), a(21), a(22), a(23), a(24), a(25), a(26), a(27), a(28), a(29), a(30), &
                a(31), a(32), a(33), a(34), a(35), a(36), a(37))
   end subroutine call_umat

   !> A point of the default material under an isotropic stress of 100 kPa, STATEV zeroed as hosts do.
   type(umat_call_t) function new_call() result(host)
      host%props(1:NPROPS) = default_props()
      host%stress(1:6) = [-100.0_wp, -100.0_wp, -100.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
      host%statev(1:NSTATV) = 0.0_wp
   end function new_call

   !> A memory rule, or the published model: classic, its scheme and no guard.
   subroutine take_rule(host, rule)
      type(umat_call_t), intent(inout) :: host
      integer, intent(in) :: rule   !< 0 to WITHOUT_GUARDS.

      host%props(P_MEMORY_RULE) = real(merge(RULE_CLASSIC, rule, rule == WITHOUT_GUARDS), wp)
      if (rule /= WITHOUT_GUARDS) return
      host%props([P_X_0, P_X_REV, P_CAP_D, P_CAP_H, P_CUTOFF]) = 0.0_wp
      host%props(P_SCHEME) = real(SCHEME_OF_PAPER, wp)
   end subroutine take_rule

   !> The same after a general path of six components, at a suction [kPa]; ready for the next increment.
   type(umat_call_t) function walked_call(rule, suction) result(host)
      integer, intent(in), optional :: rule
      real(wp), intent(in), optional :: suction
      type(random_t) :: random

      host = new_call()
      if (present(rule)) call take_rule(host, rule)
      if (present(suction)) host%predef = suction
      call walk(host, random, 20, 2.0e-4_wp)
      host%dstran(1:6) = [-3.0e-4_wp, 1.0e-4_wp, 0.5e-4_wp, 2.0e-4_wp, -1.0e-4_wp, 1.5e-4_wp]
   end function walked_call

   !> Takes n random increments of a size, unloading and reloading as they come; refused ones are skipped.
   subroutine walk(host, random, n, size)
      type(umat_call_t), intent(inout) :: host
      type(random_t), intent(inout) :: random
      integer, intent(in) :: n
      real(wp), intent(in) :: size
      integer :: i

      do i = 1, n
         host%dstran(1:6) = random_strain(random, size)
         call call_umat(host)
      end do
      host%pnewdt = 1.0_wp
      host%scd = 0.0_wp
   end subroutine walk

   !> A strain increment, its volume held small so that a long walk stays in the range of void ratios.
   function random_strain(random, size) result(strain)
      type(random_t), intent(inout) :: random
      real(wp), intent(in) :: size
      real(wp) :: strain(6)

      strain = uniform(random, 0.1_wp, 1.0_wp)*size*random_tensor(random)
      strain(1:3) = strain(1:3) - 0.3_wp*sum(strain(1:3))
   end function random_strain

   logical function same_bits(a, b)
      real(wp), intent(in) :: a(:), b(:)

      same_bits = size(a) == size(b)
      if (same_bits) same_bits = all(transfer(a, [0_int64]) == transfer(b, [0_int64]))
   end function same_bits

   !> True if two calls hold the same bits everywhere but in PNEWDT and SCD.
   logical function untouched(a, b)
      type(umat_call_t), intent(in) :: a, b

      untouched = same_bits(a%stress, b%stress) .and. same_bits(a%statev, b%statev) &
                  .and. same_bits(a%ddsdde, b%ddsdde) .and. a%cmname == b%cmname &
                  .and. same_bits([a%sse, a%spd, a%rpl, a%drpldt, a%dtime, a%temp, a%dtemp, a%celent], &
                                  [b%sse, b%spd, b%rpl, b%drpldt, b%dtime, b%temp, b%dtemp, b%celent]) &
                  .and. same_bits([a%ddsddt, a%drplde, a%stran, a%dstran, a%time, a%predef, a%dpred, a%props], &
                                  [b%ddsddt, b%drplde, b%stran, b%dstran, b%time, b%predef, b%dpred, b%props]) &
                  .and. same_bits(a%coords, b%coords) &
                  .and. same_bits(reshape([a%drot, a%dfgrd0, a%dfgrd1], [27]), &
                                  reshape([b%drot, b%dfgrd0, b%dfgrd1], [27])) &
                  .and. all([a%ndi, a%nshr, a%ntens, a%nstatv, a%nprops, a%noel, a%npt, a%layer, a%kspt, a%kstep] &
                            == [b%ndi, b%nshr, b%ntens, b%nstatv, b%nprops, b%noel, b%npt, b%layer, b%kspt, b%kstep]) &
                  .and. a%kinc == b%kinc
   end function untouched

   !> Status of a call that is meant to fail, 0 if it does not; TOUCHED if it wrote more than PNEWDT, SCD and the
   !> elastic DDSDDE; NO_CUT if it left PNEWDT at 1 or wrote nonsense.
   integer function refusal(host) result(code)
      type(umat_call_t), intent(in) :: host
      type(umat_call_t) :: trial

      trial = host
      call call_umat(trial)
      code = nint(trial%scd)
      if (code == 0) return
      if (.not. same_bits(host%ddsdde, trial%ddsdde)) then
         if (.not. same_bits(elastic_matrix(host), trial%ddsdde)) code = TOUCHED
         trial%ddsdde = host%ddsdde
      end if
      if (.not. untouched(host, trial)) code = TOUCHED
      if (.not. (trial%pnewdt > 0.0_wp .and. trial%pnewdt < 1.0_wp)) code = NO_CUT
   end function refusal

   !> DDSDDE with the elastic matrix of the state that a host holds, by mud_update; as it is where there is none.
   function elastic_matrix(host) result(ddsdde)
      type(umat_call_t), intent(in) :: host
      real(wp) :: ddsdde(40), stress0(6), stress(6), statev(NSTATV), still(6), tangent(6, 6)
      integer :: n

      ddsdde = host%ddsdde
      n = host%ntens
      still = 0.0_wp
      stress0 = still
      stress0(1:n) = host%stress(1:n)
      if (update_once(host%props, host%nprops, stress0, host%statev, host%nstatv, still, host%statev(S_SUCTION), &
                      0.0_wp, MUD_TANGENT_ELASTIC, stress, statev, tangent) == 0) &
         ddsdde(1:n*n) = reshape(tangent(1:n, 1:n), [n*n])
   end function elastic_matrix

   !> The same through mud_update; what it may not write is marked.
   integer function update_refusal(host) result(code)
      type(umat_call_t), intent(in) :: host
      real(wp) :: stress(8), statev(NSTATV + 4), tangent(6, 6), blocks(6, 2), slope

      stress = MARK
      statev = MARK
      tangent = MARK
      blocks = MARK
      slope = MARK
      code = update_once(host%props, host%nprops, host%stress, host%statev, host%nstatv, host%dstran, host%predef(1), &
                         host%dpred(1), 2, stress, statev, tangent, blocks(:, 1), blocks(:, 2), slope)
      if (code == 0) return
      if (.not. same_bits([stress, statev, tangent, blocks, slope], spread(MARK, 1, 61 + NSTATV))) code = TOUCHED
   end function update_refusal

   !> The status if both doors refuse alike, else 0.
   integer function common_refusal(host) result(code)
      type(umat_call_t), intent(in) :: host

      code = refusal(host)
      if (update_refusal(host) /= code) code = 0
   end function common_refusal

   !> A prepared material; status that of mud_prepare.
   function prepared_of(props, n_props, code) result(material)
      integer(c_int), intent(in) :: n_props
      real(wp), intent(in) :: props(n_props)
      integer(c_int), intent(out), optional :: code
      real(wp) :: material(mud_prepared_size())
      character(kind=c_char) :: text(1)
      integer(c_int) :: status

      material = 0.0_wp
      status = mud_prepare(props, n_props, material, size(material), text, 0_c_int)
      if (present(code)) code = status
   end function prepared_of

   !> mud_init of a material that is prepared for this point alone.
   integer(c_int) function begin_once(props, n_props, stress, suction, void_ratio, statev, n_statev, text, len) &
      result(code)
      integer(c_int), intent(in) :: n_props, n_statev, len
      real(wp), intent(in) :: props(n_props), suction, void_ratio
      real(wp), intent(inout) :: stress(6), statev(n_statev)
      character(kind=c_char), intent(out) :: text(*)
      real(wp) :: material(mud_prepared_size())

      material = 0.0_wp
      code = mud_prepare(props, n_props, material, size(material), text, len)
      if (code == 0) code = mud_init(material, stress, suction, void_ratio, 0.0_wp, statev, n_statev, text, len)
   end function begin_once

   !> mud_update with what umat_ is given: a material that is prepared for this update alone, the suction of the host,
   !> and a state that never began begins here.
   integer(c_int) function update_once(props, n_props, stress0, statev0, n_statev, d_strain, suction, d_suction, &
           tangent, stress1, statev1, dsig_deps, dsig_dpc, dsw_deps, dsw_dpc, report, sentence) result(code)
      integer(c_int), intent(in) :: n_props, n_statev, tangent
      real(wp), intent(in) :: props(n_props), stress0(6), statev0(n_statev), d_strain(6), suction, d_suction
      real(wp), intent(inout) :: stress1(6), statev1(n_statev)
      real(wp), intent(inout), optional :: dsig_deps(6, 6), dsig_dpc(6), dsw_deps(6), dsw_dpc
      type(mud_report), intent(out), optional :: report
      character(*), intent(out), optional :: sentence   !< Of the library.
      real(wp) :: material(mud_prepared_size()), stress(6), statev(n_statev), preset
      type(mud_blocks) :: blocks
      logical :: began
      type(mud_report) :: of_update
      character(LONG, kind=c_char) :: text

      text = c_null_char
      material = 0.0_wp
      code = mud_prepare(props, n_props, material, size(material), text, LONG)
      stress = stress0
      statev = statev0
      if (code == 0 .and. n_statev >= NSTATV_BASE) then
         began = .true.
         if (is_finite(statev0(S_LAYOUT))) began = abs(statev0(S_LAYOUT)) > 0.0_wp
         if (.not. began) then
            preset = 0.0_wp
            if (n_props >= P_HYSTERESIS) preset = props(P_HYSTERESIS)*statev0(S_SATURATION)
            code = mud_init(material, stress, suction, statev0(S_VOID_RATIO), preset, statev, n_statev, text, LONG)
         else if (is_finite(suction) .and. is_finite(statev0(S_SUCTION))) then
            statev(S_SUCTION) = suction
         end if
      end if
      if (present(sentence)) sentence = text(:index(text, c_null_char) - 1)
      if (code /= 0) return
      code = mud_update(material, stress, statev, n_statev, d_strain, suction + d_suction, tangent, stress1, statev1, &
                        blocks, of_update)
      if (present(report)) report = of_update
      if (mud_message(of_update, text, LONG) < 0) error stop 'abi_host: no sentence'
      if (present(sentence)) sentence = text(:index(text, c_null_char) - 1)
      if (code /= 0) return
      if (present(dsig_deps) .and. tangent > 0) dsig_deps = blocks%dsig_deps
      if (present(dsig_dpc) .and. tangent > 0) dsig_dpc = blocks%dsig_dpc
      if (present(dsw_deps)) dsw_deps = blocks%dsw_deps
      if (present(dsw_dpc)) dsw_dpc = blocks%dsw_dpc
   end function update_once

   !> A quiet NaN. Made of bits: arithmetic that makes one traps in the debug build.
   pure real(wp) function not_a_number()
      not_a_number = transfer(int(z'7FF8000000000000', int64), 1.0_wp)
   end function not_a_number

   pure real(wp) function infinite()
      infinite = transfer(int(z'7FF0000000000000', int64), 1.0_wp)
   end function infinite
end module abi_host
