! SPDX-License-Identifier: MIT
!> MUD through its public interface, its parameters checked and prepared once.
module material_mud
   use, intrinsic :: ieee_exceptions, only: ieee_usual, ieee_get_halting_mode, ieee_set_flag, ieee_set_halting_mode
   use, intrinsic :: iso_c_binding, only: c_int, c_loc, c_null_char
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_table, only: key_table_t
   use library_tables, only: property_count, property_index, property_name, property_range, range_for, statev_index, &
                             statev_name
   use material_point, only: range_t, material_t, response_t, batch_report_t, remark_t, MOST_POINTS, NAME_LENGTH, &
                             NO_PRESET
   use retention_curves, only: saturation_t
   use mud_interface, only: mud_report, mud_blocks, mud_points, mud_prepared_size, mud_prepared_statev, &
                            mud_prepared_lanes, mud_prepare, mud_init, mud_update, mud_update_points, mud_saturation, &
                            mud_save_increment, mud_message, &
                            MUD_TANGENT_NONE, MUD_TANGENT_ELASTIC, MUD_TANGENT_CONSISTENT, MUD_LANES, MUD_NOT_PREPARED
   use namelists, only: group_t
   use parameter_groups, only: read_parameters
   use stress_units, only: unit_of_atmosphere, KILOPASCAL
   use texts, only: from_c, short, whole, LENGTH
   implicit none (type, external)
   private
   public :: mud_t, new_mud

   integer, parameter :: BUFFER = 1000
   real(wp), parameter :: ROUNDING = 1.0e-6_wp   !< A default said in another unit is rounded.
   character(*), parameter :: STRENGTH = 'M_c'   !< Parameter that may change during a run.
   character(*), parameter :: GUARDS(10) = [character(NAME_LENGTH) :: 'floor', 'contraction cap', 'softening cap', &
      'hysteresis', 'isotropic kept off', 'no direction', 'minimum step', 'cut-off', 'tensile', &
      'turning points forgotten']

   !> Parameters that act with suction alone; those of bonding only where the air that S_max leaves does not bond, too.
   character(*), parameter :: SUCTION_KEYS(*) = [character(NAME_LENGTH) :: 'P_a', 'Omega', 'n_x', 'm_x', 'S_min', &
      'hysteresis', 'P_aw', 'n_w', 'm_w', 'b_d', 'b_w'], BONDING_KEYS(*) = [character(NAME_LENGTH) :: 'b_1', 'b_2']

   type, extends(material_t) :: mud_t
      real(wp), allocatable :: props(:)      !< PROPS as the registry of the library has them.
      real(wp), allocatable :: prepared(:)   !< PROPS, checked, in the library's own form.
      integer(c_int) :: given_tangent = 0               !< Kind of tangent in PROPS; 0: none.
      integer(c_int) :: tangent = MUD_TANGENT_ELASTIC   !< Kind that updates return where one is asked for.
      real(wp) :: fade = 1.0_wp               !< Stress ratios at the start of an update are multiplied by it [-].
      logical, allocatable :: is_ratio(:)     !< Whether a state variable is a stress ratio. (n_state)
   contains
      procedure :: initial_state
      procedure :: update
      procedure :: message
      procedure :: retention
      procedure :: preset_saturation
      procedure :: save_update
      procedure :: elastic_tangent
      procedure :: remarks
      procedure :: integrate_to
      procedure :: find_varying
      procedure :: change_over_step
   end type mud_t
contains
   !> The law of a group: `file`, and parameters of the library by name. title becomes the name of the material;
   !> stresses in the unit of p_atm. A fault (EXIT_INPUT) where the file or a value is wrong; the law is then of no use.
   subroutine new_mud(k, law, title, fault)
      type(key_table_t), intent(inout) :: k
      class(material_t), allocatable, intent(out) :: law
      character(*), intent(inout) :: title
      type(fault_t), intent(inout) :: fault
      character(LENGTH) :: file
      type(mud_t) :: mud

      file = ''
      call k%text('file', file, 'material file; every parameter of the library is a key too')
      if (k%lists) return
      call fill_mud(k%group, mud, title, fault)
      allocate (law, source=mud)
   end subroutine new_mud

   subroutine fill_mud(group, law, title, fault)
      type(group_t), intent(in) :: group
      type(mud_t), intent(out) :: law
      character(*), intent(inout) :: title   !< Name of the material.
      type(fault_t), intent(inout) :: fault
      character(BUFFER) :: text
      real(wp) :: tested(4)
      integer :: i

      tested = [law%tested_e%least, law%tested_e%most, law%tested_p%least, law%tested_p%most]
      call read_parameters(group, law%props, title, law%doubt, fault, tested)
      law%cohesionless = .true.
      law%tested_e = range_t(tested(1), tested(2))
      law%tested_p = range_t(tested(3), tested(4))
      if (fault%code /= 0) return
      law%unit = unit_of_atmosphere(law%props(property_index('p_atm')))
      allocate (law%prepared(mud_prepared_size()), source=0.0_wp)
      text = c_null_char
      if (mud_prepare(law%props, size(law%props), law%prepared, size(law%prepared), text, BUFFER) /= 0) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//from_c(text))
         return
      end if
      law%given_tangent = nint(law%props(property_index('tangent')), c_int)
      law%tangent = max(law%given_tangent, MUD_TANGENT_ELASTIC)
      law%has_retention = .true.
      law%saturation_is_state = nint(law%props(property_index('hysteresis'))) == 1
      law%exact_tangent = law%tangent == MUD_TANGENT_CONSISTENT
      law%tolerance = law%props(property_index('tolerance'))
      law%given_tolerance = not_the_default('tolerance', law%tolerance)
      law%given_scheme = not_the_default('scheme', law%props(property_index('scheme')))
      law%unguarded = nint(law%props(property_index('cutoff'))) == 0
      law%overcounts_cycles = .true.
      law%e_0 = law%props(property_index('e_0'))
      law%suction_keys = SUCTION_KEYS
      if (.not. law%props(property_index('S_max')) < 1.0_wp) law%suction_keys = [law%suction_keys, BONDING_KEYS]
      law%n_guards = size(GUARDS)
      law%guard_names(:size(GUARDS)) = GUARDS
      law%n_state = mud_prepared_statev(law%prepared)
      law%has_lanes = mud_prepared_lanes(law%prepared) == 1
      allocate (law%state_names(law%n_state))
      do i = 1, law%n_state
         law%state_names(i) = statev_name(i)
      end do
      law%is_ratio = [(index(law%state_names(i), 'memory') == 1 .or. index(law%state_names(i), 'target') == 1, &
                       i=1, law%n_state)]
      law%place_e = statev_index('void_ratio')
      law%place_s_w = statev_index('saturation')
      if (min(law%place_e, law%place_s_w) < 1) call raise(fault, EXIT_INPUT, &
         'The library keeps no void_ratio or no saturation; program and library do not match.')
   end subroutine fill_mud

   logical function not_the_default(name, value)
      character(*), intent(in) :: name
      real(wp), intent(in) :: value
      real(wp) :: lower, upper, preset

      call property_range(property_index(name), lower, upper, preset)
      not_the_default = abs(value - preset) > epsilon(1.0_wp)*abs(preset)
   end function not_the_default

   !> Another tolerance and scheme of the stress integration, both in their ranges; scheme 0 leaves it.
   subroutine integrate_to(self, tolerance, scheme)
      class(mud_t), intent(inout) :: self
      real(wp), intent(in) :: tolerance   !< Relative.
      integer, intent(in) :: scheme
      character(BUFFER) :: text
      real(wp) :: props(size(self%props)), prepared(size(self%prepared))

      props = self%props
      props(property_index('tolerance')) = tolerance
      if (.not. self%given_scheme .and. scheme > 0) props(property_index('scheme')) = real(scheme, wp)
      text = c_null_char
      if (mud_prepare(props, size(props), prepared, size(prepared), text, BUFFER) /= 0) return
      self%props = props
      self%prepared = prepared
      self%tolerance = tolerance
   end subroutine integrate_to

   subroutine find_varying(self, name, place, text)
      class(mud_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(out) :: place
      character(*), intent(out) :: text

      text = ''
      place = 0
      if (name == STRENGTH) place = property_index(STRENGTH)
      if (place == 0) text = 'of &mud '//STRENGTH//' may change, which every strength of the model is in proportion to'
   end subroutine find_varying

   !> Sets the strength over a step. Where it falls, stress ratios keep their shares of it: the state before an update
   !> is faded. docs/theory/host.md section 15.
   subroutine change_over_step(self, places, before, after, text)
      class(mud_t), intent(inout) :: self
      integer, intent(in) :: places(:)
      real(wp), intent(in) :: before(:), after(:)
      character(*), intent(out) :: text
      character(BUFFER) :: raw

      text = ''
      self%props(places) = after*self%props(places)
      self%fade = min(1.0_wp, product(after/before))
      raw = c_null_char
      if (mud_prepare(self%props, size(self%props), self%prepared, size(self%prepared), raw, BUFFER) /= 0) &
         text = from_c(raw)
   end subroutine change_over_step

   !> A state at the start of an update, whose stress ratios have become smaller by the factor of the law.
   pure subroutine faded(self, stress, state, stress_, state_)
      class(mud_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), state(:)
      real(wp), intent(out) :: stress_(6), state_(:)   !< Stress and state with their stress ratios faded.
      real(wp) :: mean

      mean = sum(stress(1:3))/3
      stress_(1:3) = mean + self%fade*(stress(1:3) - mean)
      stress_(4:6) = self%fade*stress(4:6)
      state_ = state
      where (self%is_ratio) state_(:self%n_state) = self%fade*state(:self%n_state)
   end subroutine faded

   subroutine preset_saturation(self, s_w, state, text)
      class(mud_t), intent(in) :: self
      real(wp), intent(in) :: s_w
      real(wp), intent(inout) :: state(:)
      character(*), intent(out) :: text

      text = ''
      if (self%saturation_is_state) then
         state(self%place_s_w) = s_w
      else
         text = NO_PRESET
      end if
   end subroutine preset_saturation

   subroutine initial_state(self, stress, suction, void_ratio, state, text)
      class(mud_t), intent(in) :: self
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(in) :: suction, void_ratio
      real(wp), intent(inout) :: state(:)
      character(*), intent(out) :: text
      character(BUFFER) :: raw
      real(wp) :: preset

      text = ''
      raw = c_null_char
      preset = 0.0_wp
      if (self%saturation_is_state) preset = state(self%place_s_w)
      state = 0.0_wp
      if (mud_init(self%prepared, stress, suction, void_ratio, preset, state, self%n_state, raw, BUFFER) == 0) return
      text = from_c(raw)
      if (preset > 0.0_wp) text = 'saturation of &initial must lie between the main curves at this suction: '//text
   end subroutine initial_state

   !> Point by point, or side by side: the library's batch is on the caller's thread, for programs have threads of their
   !> own.
   subroutine update(self, n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                     report)
      class(mud_t), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in), contiguous :: stress(:, :), state(:, :), strain(:, :), suction(:), d_suction(:)
      logical, intent(in) :: with_tangent
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous :: new_state(:, :)
      type(batch_report_t), intent(out) :: report
      type(mud_report) :: of_point
      type(mud_blocks) :: blocks
      real(wp) :: stress_(6), ends(MOST_POINTS)
      real(wp), allocatable :: state_(:)   !< With fading alone.
      integer(c_int) :: code, kind
      integer :: g

      kind = MUD_TANGENT_NONE
      if (with_tangent) kind = self%tangent
      ends(:n) = suction(:n) + d_suction(:n)
      if (self%lanes) then
         call update_side_by_side(self, n, stress, state, strain, ends, kind, response, new_state, report)
         return
      end if
      if (self%fade < 1.0_wp) allocate (state_(size(state, 1)))
      do g = 1, n
         if (self%fade < 1.0_wp) then
            call faded(self, stress(:, g), state(:, g), stress_, state_)
            code = mud_update(self%prepared, stress_, state_, self%n_state, strain(:, g), ends(g), kind, &
                              response%stress(:, g), new_state(:, g), blocks, of_point)
         else
            code = mud_update(self%prepared, stress(:, g), state(:, g), self%n_state, strain(:, g), ends(g), kind, &
                              response%stress(:, g), new_state(:, g), blocks, of_point)
         end if
         call take_point(self, g, code, of_point, new_state(:, g), response, report)
         if (code /= 0) return
         if (with_tangent) then
            response%dsig_deps(:, :, g) = blocks%dsig_deps
            response%dsig_dpc(:, g) = blocks%dsig_dpc
            response%dsw_dev(g) = blocks%dsw_deps(1)   ! the normal components are equal, those of shear are zero
            response%dsw_dpc(g) = blocks%dsw_dpc
         end if
      end do
   end subroutine update

   !> The updates of a batch by the library's own; a point that fails leaves the others alone.
   subroutine update_side_by_side(self, n, stress, state, strain, suction, kind, response, new_state, report)
      class(mud_t), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in), contiguous, target :: stress(:, :), state(:, :), strain(:, :), suction(:)
      integer(c_int), intent(in) :: kind
      type(response_t), intent(inout), target :: response
      real(wp), intent(inout), contiguous, target :: new_state(:, :)
      type(batch_report_t), intent(inout) :: report
      type(mud_report), target :: reports(MOST_POINTS)
      type(mud_points) :: points
      real(wp), target :: stress_(6, MOST_POINTS), slopes(6, MOST_POINTS)
      real(wp), allocatable, target :: state_(:, :)   !< With fading alone.
      logical :: halting(size(ieee_usual))
      integer :: g

      points = mud_points(n=n, nstatev=size(state, 1), tangent=kind + MUD_LANES, threads=1, stress0=c_loc(stress), &
                          statev0=c_loc(state), dstrain=c_loc(strain), suction=c_loc(suction), &
                          stress1=c_loc(response%stress), statev1=c_loc(new_state), &
                          dsig_deps=c_loc(response%dsig_deps), dsig_dpc=c_loc(response%dsig_dpc), &
                          dsw_deps=c_loc(slopes), dsw_dpc=c_loc(response%dsw_dpc), reports=c_loc(reports))
      if (self%fade < 1.0_wp) then
         allocate (state_(size(state, 1), n))
         do g = 1, n
            call faded(self, stress(:, g), state(:, g), stress_(:, g), state_(:, g))
         end do
         points%stress0 = c_loc(stress_)
         points%statev0 = c_loc(state_)
      end if
      ! Vectors compute what masks then leave out: builds that stop at exceptions shall not stop there.
      call ieee_get_halting_mode(ieee_usual, halting)
      call ieee_set_halting_mode(ieee_usual, .false.)
      if (mud_update_points(self%prepared, 1, points) < 0) reports%status = MUD_NOT_PREPARED
      call ieee_set_flag(ieee_usual, .false.)
      call ieee_set_halting_mode(ieee_usual, halting)
      response%dsw_dev(:n) = slopes(1, :n)   ! the normal components are equal, those of shear are zero
      do g = 1, n
         call take_point(self, g, reports(g)%status, reports(g), new_state(:, g), response, report)
         if (report%code /= 0) return
      end do
   end subroutine update_side_by_side

   !> Void ratio and saturation of a point, and its work added; what a failure is about is that of the last one.
   pure subroutine take_point(self, point, code, report, state, response, sums)
      class(mud_t), intent(in) :: self
      integer, intent(in) :: point
      integer(c_int), intent(in) :: code   !< Status that its update returned.
      type(mud_report), intent(in) :: report
      real(wp), intent(in) :: state(:)
      type(response_t), intent(inout) :: response
      type(batch_report_t), intent(inout) :: sums

      sums%n_rate = sums%n_rate + report%n_rate
      sums%n_substep = sums%n_substep + report%n_substep
      sums%n_reject = sums%n_reject + report%n_reject
      sums%guards(:size(GUARDS)) = sums%guards(:size(GUARDS)) + [report%n_floor, report%n_cap_d, report%n_cap_h, &
         report%n_hysteresis, report%n_iso_kept, report%n_no_root, report%n_min_step, report%n_open, report%n_tensile, &
         report%n_turns_cleared]
      sums%factor = report%pnewdt
      sums%subject = report%subject
      sums%entry = report%index
      sums%value = report%value
      sums%lower = report%lower
      sums%upper = report%upper
      sums%reached = report%reached
      if (code /= 0) then
         sums%code = code
         sums%point = point
         return
      end if
      response%void_ratio(point) = state(self%place_e)
      response%s_w(point) = state(self%place_s_w)
   end subroutine take_point

   subroutine message(self, report, text)
      class(mud_t), intent(in) :: self
      type(batch_report_t), intent(in) :: report
      character(*), intent(out) :: text
      type(mud_report) :: of_library
      character(BUFFER) :: raw

      of_library = mud_report(status=report%code, subject=report%subject, index=report%entry, value=report%value, &
                              lower=report%lower, upper=report%upper, reached=report%reached)
      raw = c_null_char
      if (mud_message(of_library, raw, BUFFER) < 0) raw = 'Status '//whole(report%code)//'.'//c_null_char
      text = from_c(raw)
   end subroutine message

   !> Degree of saturation by the library's own curve; for an invalid void ratio the result is full saturation and has
   !> no meaning.
   function retention(self, p_c, e) result(sat)
      class(mud_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat

      sat = saturation_t()
      if (mud_saturation(self%prepared, p_c, e, sat%s, sat%ds_dpc, sat%ds_de) /= 0) sat = saturation_t()
   end function retention

   subroutine elastic_tangent(self, stress, state, suction, tangent)
      class(mud_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), state(:), suction
      real(wp), intent(out) :: tangent(6, 6)
      real(wp) :: no_strain(6), stress1(6), state1(self%n_state)
      type(mud_blocks) :: blocks

      no_strain = 0.0_wp
      tangent = 0.0_wp
      if (mud_update(self%prepared, stress, state(:self%n_state), self%n_state, no_strain, suction, &
                     MUD_TANGENT_ELASTIC, stress1, state1, blocks) == 0) tangent = blocks%dsig_deps
   end subroutine elastic_tangent

   subroutine save_update(self, path, origin, stress, state, strain, suction, d_suction, text)
      class(mud_t), intent(in) :: self
      character(*), intent(in) :: path, origin
      real(wp), intent(in) :: stress(6), state(:), strain(6), suction, d_suction
      character(*), intent(out) :: text
      character(BUFFER) :: raw
      real(wp) :: stress_(6), state_(size(state))

      raw = c_null_char
      text = ''
      call faded(self, stress, state, stress_, state_)
      if (mud_save_increment(trim(path)//c_null_char, origin//c_null_char, self%prepared, stress_, state_, &
                             self%n_state, strain, suction + d_suction, self%tangent, raw, BUFFER) /= 0) &
         text = from_c(raw)
   end subroutine save_update

   !> Parameters that are not the default.
   subroutine remarks(self, list)
      class(mud_t), intent(in) :: self
      type(remark_t), allocatable, intent(out) :: list(:)
      real(wp) :: lower, upper, preset
      integer :: i

      allocate (list(0))
      do i = 1, property_count()
         ! an atmosphere of 100 kPa leaves the defaults in kPa as they are
         if (self%unit%name == KILOPASCAL%name) then
            call property_range(i, lower, upper, preset)
         else
            call range_for(self%props, i, lower, upper, preset)
         end if
         if (abs(self%props(i) - preset) <= ROUNDING*abs(preset)) cycle
         list = [list, remark_t('not the default: '//property_name(i), &
                                short(self%props(i))//' (default '//short(preset)//')')]
      end do
   end subroutine remarks
end module material_mud
