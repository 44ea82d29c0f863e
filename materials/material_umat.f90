! SPDX-License-Identifier: MIT
!> A law of others: any UMAT from a shared library, beside a retention curve unless its STATEV holds the saturation.
!> Suction goes to it as PREDEF(1) and DPRED(1). The law must be rate-independent: a point has no time, so each update
!> is one unit of it, and TIME counts the updates.
module material_umat
   use, intrinsic :: iso_c_binding, only: c_int, c_size_t
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use files, only: folder_of
   use key_schema, only: line_of, REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use material_point, only: material_t, response_t, batch_report_t, remark_t, retention_by_curve, swollen, NAME_LENGTH
   use retention_curves, only: saturation_t
   use texts, only: whole, short, LENGTH
   use umat_library, only: umat_i, load_umat, CMNAME_LENGTH
   implicit none (type, external)
   private
   public :: umat_t, new_umat, UMAT_REFUSES, UMAT_NOT_FINITE

   !> Codes of a failure.
   integer, parameter :: UMAT_REFUSES = 1      !< The UMAT set PNEWDT below 1.
   integer, parameter :: UMAT_NOT_FINITE = 2   !< The stress or DDSDDE of the UMAT is not finite.
   real(wp), parameter :: HALF = 0.5_wp, SMALLEST_FACTOR = 0.05_wp

   integer, parameter :: ABAQUS(6) = [1, 2, 3, 4, 5, 6]   !< Shear 12, 13, 23.
   integer, parameter :: KRATOS(6) = [1, 2, 3, 4, 6, 5]   !< Shear 12, 23, 13.
   real(wp), parameter :: UNIT(3, 3) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, &
                                                0.0_wp, 0.0_wp, 1.0_wp], [3, 3])
   real(wp), parameter :: SAME_S_W = 1.0e-4_wp   !< Two degrees of saturation of a start that agree [-].
   real(wp), parameter :: STEP = 1.0_wp          !< DTIME of an update.
   integer, parameter :: MOST = 10000            !< STATEV that a law may have.
   integer, parameter :: OWN = 9                 !< Number of state variables after those of the UMAT.
   integer, parameter :: OWN_STRAIN = 0          !< Place before the six strains since the start, after the UMAT's.
   integer, parameter :: OWN_COUNT = 7, OWN_E = 8, OWN_S_W = 9   !< Places: updates, void ratio, saturation.

   type, extends(material_t) :: umat_t
      procedure(umat_i), pointer, nopass :: umat => null()
      character(CMNAME_LENGTH) :: title = ''
      character(256) :: library = '', symbol = ''
      real(wp), allocatable :: props(:)
      integer :: n_statv = 0, components = 6
      integer :: order(6) = ABAQUS
      logical :: total = .false.
      integer :: void_ratio_at = 0, saturation_at = 0, saturation_slopes_at = 0, suction_slope_at = 0
   contains
      procedure :: initial_state
      procedure :: retention
      procedure :: update
      procedure :: message
      procedure :: remarks
      procedure :: find_varying
      procedure :: change_over_step
   end type umat_t
contains
   !> The law of a group. title stays as it is; stresses in the unit of the UMAT. A fault (EXIT_INPUT) where values
   !> contradict each other or the library cannot be loaded; the law is then of no use.
   subroutine new_umat(k, law, title, fault)
      type(key_table_t), intent(inout) :: k
      class(material_t), allocatable, intent(out) :: law
      character(*), intent(inout) :: title
      type(fault_t), intent(inout) :: fault
      type(umat_t) :: umat

      call fill_umat(k, title, umat, fault)
      allocate (law, source=umat)
   end subroutine new_umat

   subroutine fill_umat(k, title, law, fault)
      type(key_table_t), intent(inout) :: k
      character(*), intent(in) :: title
      type(umat_t), intent(out) :: law
      type(fault_t), intent(inout) :: fault
      character(LENGTH), allocatable :: names(:)
      logical :: as_kratos
      integer :: i

      law%title = title
      law%symbol = 'umat_'
      as_kratos = .false.
      call k%text('library', law%library, 'shared library: path relative to this file, or a name that the system '// &
                  'finds', REQUIRED)
      call k%text('symbol', law%symbol, 'symbol of the UMAT in the library')
      call k%numbers('props', law%props, -UNBOUNDED, UNBOUNDED, 'PROPS, in their order')
      call k%whole('nstatv', law%n_statv, 0, MOST, 'number of STATEV; they start as zeros')
      call k%texts('state_names', names, 'names of STATEV, in their order')
      call k%flag('shear_order', as_kratos, 'abaqus|kratos', 'kratos', 'abaqus: 12, 13, 23; kratos: 12, 23, 13')
      call k%flag('stress', law%total, 'effective|total', 'total', &
                  'stress that the UMAT knows; total: less the air pressure, sigma'' + S_w p_c')
      call k%whole('components', law%components, 4, 6, 'NTENS: 6, or 4 for a UMAT of axisymmetry and plane strain')
      call k%flag('tangent', law%exact_tangent, 'approximate|consistent', 'consistent', &
                  'consistent: DDSDDE is the derivative of the update itself')
      call k%whole('void_ratio_at', law%void_ratio_at, 0, MOST, &
                   'place in STATEV of the void ratio; 0: kept outside STATEV')
      call k%whole('saturation_at', law%saturation_at, 0, MOST, &
                   'place in STATEV of S_w; 0: from the retention curve')
      call k%whole('saturation_slopes_at', law%saturation_slopes_at, 0, MOST, &
                   'with saturation_at: place of dS_w/dp_c, before that of dS_w/d eps_v (expansion positive)')
      call k%whole('suction_slope_at', law%suction_slope_at, 0, MOST, &
                   'place in STATEV of the first of NTENS d STRESS/d p_c; 0: none')
      if (k%lists) return
      if (as_kratos) law%order = KRATOS
      law%has_retention = law%saturation_at > 0
      law%saturation_is_state = law%has_retention
      if (law%components == 5) call refuse('components', 'is 4 or 6.')
      call check_place('void_ratio_at', law%void_ratio_at, 1)
      call check_place('saturation_at', law%saturation_at, 1)
      call check_place('saturation_slopes_at', law%saturation_slopes_at, 2)
      call check_place('suction_slope_at', law%suction_slope_at, law%components)
      if (size(names) > law%n_statv) call refuse('state_names', 'are more than nstatv = '//whole(law%n_statv)//'.')
      if (fault%code /= 0) return

      law%n_state = law%n_statv + OWN
      law%place_e = law%n_statv + OWN_E
      law%place_s_w = law%n_statv + OWN_S_W
      allocate (law%state_names(law%n_state))
      do i = 1, law%n_statv
         law%state_names(i) = 'statev_'//whole(i)
      end do
      law%state_names(:size(names)) = names(:)(:NAME_LENGTH)
      law%state_names(law%n_statv + 1:) = [character(NAME_LENGTH) :: 'strain_11', 'strain_22', 'strain_33', &
                                           'strain_12', 'strain_13', 'strain_23', 'updates', 'kept_void_ratio', &
                                           'kept_saturation']
      call load(k%group%file, law, fault)
      if (fault%code /= 0) fault%text = at_line(k%group%file, line_of(k%group, 'library'))//fault%text
   contains
      subroutine check_place(key, first, room)
         character(*), intent(in) :: key
         integer, intent(in) :: first, room   !< Places from the first on; 0: none.

         if (first > 0 .and. first + room - 1 > law%n_statv) call refuse(key, '= '//whole(first)//' needs '// &
            whole(first + room - 1)//' STATEV, nstatv is '//whole(law%n_statv)//'.')
      end subroutine check_place

      subroutine refuse(key, why)
         character(*), intent(in) :: key, why

         if (fault%code == 0) call raise(fault, EXIT_INPUT, at_line(k%group%file, line_of(k%group, key))// &
                                           key//' '//why)
      end subroutine refuse
   end subroutine fill_umat

   !> Looks beside the file that names the library, and if it is not there, where the system keeps libraries.
   subroutine load(file, law, fault)
      character(*), intent(in) :: file
      type(umat_t), intent(inout) :: law
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: path
      logical :: there

      path = trim(law%library)
      if (path(1:1) /= '/') then
         path = folder_of(file)//'/'//path
         inquire (file=path, exist=there)
         if (.not. there) path = trim(law%library)
      end if
      call load_umat(path, trim(law%symbol), law%umat, fault)
   end subroutine load

   !> STATEV are zeros but for the void ratio; then the UMAT sees an increment of zero strain, in which it may fill them
   !> and lift the stress.
   subroutine initial_state(self, stress, suction, void_ratio, state, text)
      class(umat_t), intent(in) :: self
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(in) :: suction, void_ratio
      real(wp), intent(inout) :: state(:)
      character(*), intent(out) :: text
      type(response_t) :: response
      type(batch_report_t) :: report
      type(saturation_t) :: sat
      real(wp) :: after(self%n_state, 1)

      text = ''
      sat = self%retention(suction, void_ratio)
      call begin_point(self, stress, suction, void_ratio, sat%s, response, after, report)
      if (report%code /= 0) then
         call self%message(report, text)
         return
      end if
      if (self%saturation_at > 0 .and. abs(response%s_w(1) - sat%s) > SAME_S_W) then
         text = trim(self%symbol)//' begins this point with S_w = '//short(response%s_w(1))//' (saturation_at); at '// &
                'an isotropic stress, for weights at the start, S_w = '//short(sat%s)//' (1 also where it refuses '// &
                'that). At the start S_w must follow from suction and void ratio alone: correct saturation_at, '// &
                'or leave it out and give a retention curve.'
         return
      end if
      state = after(:, 1)
      stress = response%stress(:, 1)
   end subroutine initial_state

   !> S_w of the curve, or that with which a UMAT that keeps its own begins a point: it knows no stress, so that any
   !> tells it. Where the UMAT refuses that point the result is full saturation and has no meaning.
   function retention(self, p_c, e) result(sat)
      class(umat_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat
      type(response_t) :: response
      type(batch_report_t) :: report
      real(wp) :: stress(6), state(self%n_state, 1)

      sat = retention_by_curve(self, p_c, e)
      if (self%saturation_at == 0) return
      stress = 0.0_wp
      stress(1:3) = -max(p_c, 1.0_wp)
      call begin_point(self, stress, p_c, e, sat%s, response, state, report)
      if (report%code == 0) sat = saturation_t(response%s_w(1), response%dsw_dpc(1), response%dsw_dev(1)/(1 + e))
   end function retention

   !> The first call of the UMAT for a point, with zero strain.
   subroutine begin_point(self, stress, suction, void_ratio, s_w, response, state, report)
      class(umat_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), suction, void_ratio, s_w
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous :: state(:, :)   !< (n_state, 1)
      type(batch_report_t), intent(out) :: report
      real(wp) :: before(self%n_state, 1), at_rest(6, 1)

      before = 0.0_wp
      if (self%void_ratio_at > 0) before(self%void_ratio_at, 1) = void_ratio
      before(self%place_e, 1) = void_ratio
      before(self%place_s_w, 1) = s_w
      at_rest = 0.0_wp
      call self%update(1, reshape(stress, [6, 1]), before, at_rest, [suction], [0.0_wp], .true., response, state, &
                       report)
   end subroutine begin_point

   subroutine update(self, n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                     report)
      class(umat_t), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in), contiguous :: stress(:, :), state(:, :), strain(:, :), suction(:), d_suction(:)
      logical, intent(in) :: with_tangent
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous :: new_state(:, :)
      type(batch_report_t), intent(out) :: report
      integer :: g

      do g = 1, n
         new_state(:self%n_state, g) = state(:self%n_state, g)
         call update_point(self, stress(:, g), strain(:, g), suction(g), d_suction(g), with_tangent, g, response, &
                           new_state(:, g), report)
         if (report%code == 0) cycle
         report%point = g
         return
      end do
   end subroutine update

   !> One point; `state` goes in as that before the increment and comes out as that behind it.
   subroutine update_point(self, stress, strain, suction, d_suction, with_tangent, g, response, state, report)
      class(umat_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), strain(6), suction, d_suction
      logical, intent(in) :: with_tangent
      integer, intent(in) :: g
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous, target :: state(:)
      type(batch_report_t), intent(inout) :: report
      real(wp) :: stress_(6), ddsdde(self%components, self%components), strain0(6), d_strain(6), pnewdt, e, p_c, shift
      real(wp) :: sse, spd, scd, rpl, ddsddt(6), drplde(6), drpldt, time(2), none(3)
      integer(c_int) :: kstep(4), kinc
      type(saturation_t) :: sat
      integer :: own, c, i, j

      own = self%n_statv
      c = self%components
      shift = 0.0_wp
      if (self%total) shift = self%saturation(state)*suction
      strain0 = state(own + OWN_STRAIN + 1:own + OWN_STRAIN + 6)
      do i = 1, 6
         stress_(i) = stress(self%order(i)) + merge(shift, 0.0_wp, i <= 3)
         d_strain(i) = strain(self%order(i))
      end do
      strain0 = strain0(self%order)
      time = state(own + OWN_COUNT)
      kstep = [1, 0, 0, 0]
      kinc = 1 + nint(time(1), c_int)
      ddsdde = 0.0_wp
      sse = 0.0_wp
      spd = 0.0_wp
      scd = 0.0_wp
      rpl = 0.0_wp
      ddsddt = 0.0_wp
      drplde = 0.0_wp
      drpldt = 0.0_wp
      none = 0.0_wp
      pnewdt = 1.0_wp
      call self%umat(stress_, state, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, strain0, d_strain, time, &
                     STEP, 0.0_wp, 0.0_wp, [suction], [d_suction], self%title, 3_c_int, int(c - 3, c_int), &
                     int(c, c_int), int(self%n_statv, c_int), self%props, size(self%props, kind=c_int), none, UNIT, &
                     pnewdt, 1.0_wp, UNIT, UNIT, 1_c_int, 1_c_int, 1_c_int, 1_c_int, kstep, kinc, &
                     int(CMNAME_LENGTH, c_size_t))
      if (pnewdt < 1.0_wp) then
         call fail(UMAT_REFUSES, max(pnewdt, SMALLEST_FACTOR), scd)
         return
      else if (.not. (all(ieee_is_finite(stress_(:c))) .and. all(ieee_is_finite(ddsdde)))) then
         call fail(UMAT_NOT_FINITE, HALF, 0.0_wp)
         return
      end if

      p_c = suction + d_suction
      e = swollen(state(self%place_e), sum(strain(1:3)))
      if (self%void_ratio_at > 0) e = state(self%void_ratio_at)
      if (self%saturation_at > 0) then
         sat%s = state(self%saturation_at)
         if (self%saturation_slopes_at > 0) then
            sat%ds_dpc = state(self%saturation_slopes_at)
            sat%ds_de = state(self%saturation_slopes_at + 1)/(1.0_wp + e)
         end if
      else
         sat = self%retention(p_c, e)
      end if
      state(own + OWN_STRAIN + 1:own + OWN_STRAIN + 6) = state(own + OWN_STRAIN + 1:own + OWN_STRAIN + 6) + strain
      state(own + OWN_COUNT) = time(1) + STEP
      state(self%place_e) = e
      state(self%place_s_w) = sat%s
      response%void_ratio(g) = e
      response%s_w(g) = sat%s
      shift = 0.0_wp
      if (self%total) shift = sat%s*p_c
      response%stress(:, g) = stress
      do i = 1, c
         response%stress(self%order(i), g) = stress_(i) - merge(shift, 0.0_wp, i <= 3)
      end do
      report%n_rate = report%n_rate + 1
      if (.not. with_tangent) return

      response%dsw_dpc(g) = sat%ds_dpc
      response%dsw_dev(g) = sat%ds_de*(1.0_wp + e)
      if (self%saturation_slopes_at > 0) response%dsw_dev(g) = state(self%saturation_slopes_at + 1)
      response%dsig_deps(:, :, g) = 0.0_wp
      response%dsig_dpc(:, g) = 0.0_wp
      do j = 1, c
         do i = 1, c
            response%dsig_deps(self%order(i), self%order(j), g) = ddsdde(i, j)
         end do
         if (self%suction_slope_at > 0) response%dsig_dpc(self%order(j), g) = state(self%suction_slope_at + j - 1)
      end do
      if (.not. self%total) return
      response%dsig_deps(1:3, 1:3, g) = response%dsig_deps(1:3, 1:3, g) - p_c*response%dsw_dev(g)
      response%dsig_dpc(1:3, g) = response%dsig_dpc(1:3, g) - sat%s - p_c*sat%ds_dpc
   contains
      subroutine fail(code, factor, value)
         integer, intent(in) :: code
         real(wp), intent(in) :: factor, value

         report%code = code
         report%factor = factor
         report%value = value
         report%reached = 0.0_wp
      end subroutine fail
   end subroutine update_point

   subroutine message(self, report, text)
      class(umat_t), intent(in) :: self
      type(batch_report_t), intent(in) :: report
      character(*), intent(out) :: text

      text = trim(self%symbol)//' of '//trim(self%library)
      if (report%code == UMAT_REFUSES) then
         text = trim(text)//' refuses the increment: PNEWDT '//short(report%factor)
         if (abs(report%value) > 0.0_wp) text = trim(text)//', SCD '//short(report%value)
         text = trim(text)//'.'
      else
         text = trim(text)//' returns a stress or a DDSDDE that is not finite.'
      end if
   end subroutine message

   !> Any entry of PROPS: what it means is known to the UMAT and the user.
   subroutine find_varying(self, name, place, text)
      class(umat_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(out) :: place
      character(*), intent(out) :: text
      integer :: i

      text = ''
      place = findloc([('props('//whole(i)//')' == name, i=1, size(self%props))], .true., dim=1)
      if (place == 0) text = 'of a &umat one of props(1) to props('//whole(size(self%props))//') may change'
   end subroutine find_varying

   !> The UMAT is called with the PROPS of the end of the step.
   subroutine change_over_step(self, places, before, after, text)
      class(umat_t), intent(inout) :: self
      integer, intent(in) :: places(:)
      real(wp), intent(in) :: before(:), after(:)
      character(*), intent(out) :: text

      text = ''
      self%props(places) = after*self%props(places)
   end subroutine change_over_step

   subroutine remarks(self, list)
      class(umat_t), intent(in) :: self
      type(remark_t), allocatable, intent(out) :: list(:)
      character(:), allocatable :: values
      integer :: i

      values = ''
      do i = 1, size(self%props)
         values = values//short(self%props(i))//' '
      end do
      list = [remark_t('law', 'UMAT '//trim(self%symbol)//' of '//trim(self%library)), remark_t('props', values)]
   end subroutine remarks
end module material_umat
