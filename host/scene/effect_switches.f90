! SPDX-License-Identifier: MIT
!> Effects of a scene taken out or put in, each by the keys that say it: the scene that results is one that a user
!> could have written. docs/theory/host.md section 11.
module effect_switches
   use kinds, only: wp
   use effect_types, only: effect_t, EFFECT_NAMES, EFFECTS, OF_INERTIA, OF_SEEPAGE, OF_P_W, OF_P_C, OF_GRAVITY, &
      OF_CONTACT, OF_DAMPING, OF_ABSORBING, OF_DRAINAGE, OF_LIMITS, OF_FRICTION, OF_STRENGTH, OF_VOID_RATIO, &
      OF_HYSTERESIS, OF_BONDING, OF_ELASTIC_DOMAIN, OF_FLOW
   use faults, only: fault_t
   use key_schema, only: given
   use library_tables, only: property_index, property_range
   use namelists, only: set_entry
   use parameter_groups, only: read_parameters
   use scene_types, only: scene_t, NAME_LENGTH, WITH_U, WITH_P_W, WITH_P_C, PRESCRIBED_P_A, LOAD_WATER, LOAD_RAIN, &
                          LOAD_AIR, acts_in
   use generalised_alpha, only: STATIC, QUASI_STATIC, DYNAMIC
   use unknown_fields, only: AT_P_W, AT_P_C
   use porous_domain, only: COUPLED, DRAINED, UNDRAINED, DRY
   implicit none (type, external)
   private
   public :: list_effects, set_open_keys, switch, switch_by_hand

   real(wp), parameter :: EARTH = 9.81_wp             !< [m/s2] Where gravity is put in.
   real(wp), parameter :: ROUNDING = 1.0e-12_wp
   !> Switches of the material, in the order of their effects: 0 is off (of memory_rule: classic), the library's default
   !> on; of hysteresis, whose default is off, SWITCHED_ON.
   character(11), parameter :: SWITCHES(OF_HYSTERESIS:OF_ELASTIC_DOMAIN) = [character(11) :: 'hysteresis', 'bonding', &
      'fabric', 'isotropic', 'lode', 'memory_rule', 'rho_e']
   real(wp), parameter :: SWITCHED_ON = 1.0_wp
contains
   !> The cheapest reading of what the scene leaves open: the fields that its regions have laws for, no weight, and no
   !> inertia where no key needs it. docs/theory/host.md section 11.
   pure subroutine set_open_keys(scene)
      type(scene_t), intent(inout) :: scene
      integer :: i

      if (.not. scene%fields_by_hand) then
         scene%fields = WITH_U
         if (holds_water(scene)) scene%fields = WITH_P_W
         if (any(scene%regions%retention_name /= '')) scene%fields = WITH_P_C
      end if
      do i = 1, size(scene%stages)
         if (scene%stages(i)%kind == 0) scene%stages(i)%kind = merge(DYNAMIC, QUASI_STATIC, needs_inertia(scene, i))
      end do
   end subroutine set_open_keys

   !> Whether a stage has keys that act with inertia alone: waves that leave or come in, an acceleration, a velocity at
   !> the start, damping.
   pure logical function needs_inertia(scene, stage) result(needed)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: stage
      integer :: i

      needed = any(scene%regions%damping > 0.0_wp .or. scene%regions%stiffness_damping > 0.0_wp)
      if (stage == 1) needed = needed .or. any(abs(scene%initials%v_z) > 0.0_wp .or. abs(scene%initials%wave) > 0.0_wp)
      do i = 1, size(scene%absorbers)
         needed = needed .or. acts_in(scene%absorbers(i)%stages, scene%stages(stage)%name)
      end do
      do i = 1, size(scene%fixes)
         needed = needed .or. (scene%fixes(i)%acceleration .and. &
                               acts_in(scene%fixes(i)%stages, scene%stages(stage)%name))
      end do
   end function needs_inertia

   !> Whether the keys of a region ask for water: where it flows, or is kept.
   pure logical function holds_water(scene)
      type(scene_t), intent(in) :: scene

      holds_water = any(scene%regions%permeability_name /= '' .or. scene%regions%drainage == DRAINED .or. &
                        scene%regions%drainage == UNDRAINED)
   end function holds_water

   !> The effects of a scene, in the order of the list: present or not, said by a key or left open. Inertia has a row a
   !> stage. What has no meaning for the scene has no row. To be called before the open keys are settled.
   !> docs/theory/host.md section 11.
   function list_effects(scene) result(list)
      type(scene_t), intent(in) :: scene
      type(effect_t), allocatable :: list(:)
      type(scene_t) :: settled
      type(effect_t) :: row
      integer :: kind, stage

      settled = scene
      call set_open_keys(settled)
      allocate (list(0))
      do kind = 1, EFFECTS
         do stage = 1, merge(size(scene%stages), 1, kind == OF_INERTIA)
            row = effect_t(kind=kind, name=EFFECT_NAMES(kind))
            if (kind == OF_INERTIA) then
               row%stage = stage
               row%name = trim(row%name)//' in '//scene%stages(stage)%name
            end if
            if (.not. has_meaning(settled, kind, any(settled%stages%kind == DYNAMIC .or. &
                                                     scene%stages%kind == 0))) cycle
            ! A static stage is a way to equilibrium, which has no time.
            if (kind == OF_INERTIA .and. settled%stages(stage)%kind == STATIC) cycle
            row%present = is_present(settled, kind, stage)
            row%by_hand = .not. is_open(scene, kind, stage)
            row%on = row%present
            list = [list, row]
         end do
      end do
      list = [list, flows_of(settled)]
   end function list_effects

   !> A row for every region whose fluids may flow or not, where there are others: alone it is p_w that may go.
   function flows_of(scene) result(list)
      type(scene_t), intent(in) :: scene
      type(effect_t), allocatable :: list(:)
      integer :: i, region

      allocate (list(0))
      if (.not. scene%derive_effects .or. scene%fields == WITH_U .or. size(scene%regions) < 2) return
      region = 0
      do i = 1, size(scene%groups)
         if (scene%groups(i)%name /= 'region') cycle
         region = region + 1   ! in their order
         if (.not. given(scene%groups(i), 'drainage')) &
            list = [list, effect_t(kind=OF_FLOW, region=region, present=.true., on=.true., by_hand=.false., &
                                   name='flow in '//scene%regions(region)%group_name)]
      end do
   end function flows_of

   !> Whether a row of the table would say anything.
   logical function has_meaning(scene, kind, may_move)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: kind
      logical, intent(in) :: may_move   !< A stage has inertia, or leaves it open.

      select case (kind)
      case (OF_SEEPAGE)
         has_meaning = scene%fields /= WITH_U .and. may_move
      case (OF_P_W)
         has_meaning = holds_water(scene)
      case (OF_P_C)
         has_meaning = any(scene%regions%retention_name /= '')
      case (OF_CONTACT)
         has_meaning = size(scene%contacts) > 0
      case (OF_DRAINAGE)
         has_meaning = size(scene%contacts) > 0 .and. scene%fields /= WITH_U
      case (OF_DAMPING)
         has_meaning = is_present(scene, kind, 1)
      case (OF_ABSORBING)
         has_meaning = size(scene%absorbers) > 0
      case (OF_LIMITS, OF_FRICTION, OF_STRENGTH)
         has_meaning = is_present(scene, kind, 1)
      case (OF_VOID_RATIO)
         has_meaning = is_present(scene, kind, 1)
      case (OF_HYSTERESIS)
         ! The library's own curve alone has main curves.
         has_meaning = any_mud(scene) .and. scene%fields == WITH_P_C
      case (OF_BONDING:)
         has_meaning = any_mud(scene)
         ! Bonding is by suction.
         if (kind == OF_BONDING) has_meaning = has_meaning .and. scene%fields == WITH_P_C
      case default
         has_meaning = .true.
      end select
   end function has_meaning

   logical function is_present(scene, kind, stage) result(present)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: kind, stage
      integer :: i

      present = .false.
      select case (kind)
      case (OF_INERTIA)
         present = scene%stages(stage)%kind == DYNAMIC
      case (OF_SEEPAGE)
         present = scene%seepage_inertia
      case (OF_P_W)
         present = scene%fields /= WITH_U
      case (OF_P_C)
         present = scene%fields == WITH_P_C
      case (OF_GRAVITY)
         present = scene%gravity > 0.0_wp
      case (OF_CONTACT)
         present = size(scene%contacts) > 0
      case (OF_DAMPING)
         present = any(scene%regions%damping > 0.0_wp .or. scene%regions%stiffness_damping > 0.0_wp)
      case (OF_ABSORBING)
         present = size(scene%absorbers) > 0
      case (OF_DRAINAGE)
         present = any(scene%contacts%drains_by_state)
      case (OF_LIMITS)
         present = scene%fields /= WITH_U .and. (any(scene%fixes%limits) .or. any(scene%loads%kind == LOAD_RAIN))
      case (OF_FRICTION)
         present = any(scene%contacts%options%friction > 0.0_wp .or. scene%contacts%options%cohesion > 0.0_wp)
      case (OF_STRENGTH)
         present = size(scene%strengths) > 0
      case (OF_VOID_RATIO)
         if (scene%fields == WITH_P_C) &
            present = any([(parameter_of(scene, i, 'Omega') > 0.0_wp, i=1, size(scene%materials))])
      case default
         present = any([(parameter_of(scene, i, trim(SWITCHES(kind))) > 0.0_wp, i=1, size(scene%materials))])
      end select
   end function is_present

   !> Whether no key says it.
   logical function is_open(scene, kind, stage) result(open)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: kind, stage
      integer :: i

      open = .false.
      if (any(scene%without == EFFECT_NAMES(kind))) return
      select case (kind)
      case (OF_INERTIA)
         open = scene%stages(stage)%kind == 0
      case (OF_SEEPAGE)
         open = .not. scene%seepage_by_hand
      case (OF_P_W, OF_P_C)
         open = .not. scene%fields_by_hand
      case (OF_GRAVITY)
         open = .not. scene%gravity_by_hand
      case (OF_BONDING:)
         open = scene%derive_effects .and. .not. any([(given(scene%materials(i)%group, trim(SWITCHES(kind))), &
                                                       i=1, size(scene%materials))])
      case default
         ! The scene holds it because somebody wrote it down.
      end select
   end function is_open

   !> The effects that the key `without` takes out. Those that the scene does not have become its list `absent`.
   subroutine switch_by_hand(scene, why)
      type(scene_t), intent(inout) :: scene
      character(*), intent(out) :: why   !< Why one of them cannot be; empty if all could.
      logical :: here(size(scene%without))
      integer :: i, k, stage

      why = ''
      do i = 1, size(scene%without)
         k = findloc(EFFECT_NAMES, scene%without(i), dim=1)
         here(i) = any([(is_present(scene, k, stage), stage=1, size(scene%stages))])
      end do
      scene%absent = pack(scene%without, .not. here)
      do i = 1, size(scene%without)
         k = findloc(EFFECT_NAMES, scene%without(i), dim=1)
         do stage = 1, merge(size(scene%stages), 1, k == OF_INERTIA)
            if (why == '') call switch(scene, effect_t(kind=k, stage=stage), .false., why)
         end do
         if (why /= '') then
            why = trim(scene%without(i))//': '//trim(why)
            return
         end if
      end do
   end subroutine switch_by_hand

   !> Takes an effect out of a scene whose keys are settled, or puts it in.
   subroutine switch(scene, effect, on, why)
      type(scene_t), intent(inout) :: scene
      type(effect_t), intent(in) :: effect
      logical, intent(in) :: on
      character(*), intent(out) :: why   !< Why it cannot be; empty if it could.

      why = ''
      select case (effect%kind)
      case (OF_INERTIA)
         scene%stages(effect%stage)%kind = merge(DYNAMIC, QUASI_STATIC, on)
         if (.not. on .and. .not. any(scene%stages%kind == DYNAMIC)) scene%seepage_inertia = .false.
      case (OF_SEEPAGE)
         scene%seepage_inertia = on
      case (OF_P_W)
         if (on) then
            if (any(scene%regions%permeability_name == '' .and. scene%regions%drainage == COUPLED)) &
               why = 'a region has no permeability'
            if (why == '' .and. scene%fields == WITH_U) scene%fields = WITH_P_W
         else
            call drop_field(scene, AT_P_W, LOAD_WATER)
            scene%fields = WITH_U
            scene%seepage_inertia = .false.
            if (size(scene%contacts) > 0) scene%contacts%drains_by_state = .false.
            if (size(scene%ties) > 0) scene%ties%pressures = .false.
         end if
      case (OF_P_C)
         if (on) then
            if (any(scene%regions%retention_name == '' .and. scene%regions%drainage /= DRY)) &
               why = 'a region has no retention'
            if (scene%fields == WITH_U) why = 'it needs p_w'
            if (why == '') scene%fields = WITH_P_C
         else
            why = water_given_by_others(scene)
            if (why /= '') return
            call drop_field(scene, AT_P_C, LOAD_AIR)
            scene%fields = min(scene%fields, WITH_P_W)
         end if
      case (OF_GRAVITY)
         if (.not. on .and. (any(scene%initials%geostatic) .or. any(scene%plates%heavy))) &
            why = 'the scene asks for weight: geostatic stress or a heavy plate'
         if (why == '') scene%gravity = merge(EARTH, 0.0_wp, on)
      case (OF_CONTACT)
         if (.not. on) scene%contacts = scene%contacts(:0)
      case (OF_DAMPING)
         scene%regions%damping = 0.0_wp
         scene%regions%stiffness_damping = 0.0_wp
      case (OF_ABSORBING)
         scene%absorbers = scene%absorbers(:0)
      case (OF_DRAINAGE)
         scene%contacts%drains_by_state = on
      case (OF_LIMITS)
         ! The limit is prescribed, and all rain flows in.
         if (.not. on) then
            scene%fixes%limits = .false.
            where (scene%loads%kind == LOAD_RAIN) scene%loads%kind = LOAD_WATER
         end if
      case (OF_FRICTION)
         if (.not. on) then
            scene%contacts%options%friction = 0.0_wp
            scene%contacts%options%cohesion = 0.0_wp
         end if
      case (OF_STRENGTH)
         if (.not. on) scene%strengths = scene%strengths(:0)
      case (OF_VOID_RATIO)
         call freeze_retention(scene, why)
      case (OF_FLOW)
         scene%regions(effect%region)%drainage = merge(COUPLED, DRAINED, on)
      case default
         call set_switch(scene, effect%kind, on)
      end select
   end subroutine switch

   !> Where p_a and p_c are prescribed, p_w is as well: without these two its boundary would be closed. Empty: nowhere.
   pure function water_given_by_others(scene) result(why)
      type(scene_t), intent(in) :: scene
      character(200) :: why
      integer :: i

      why = ''
      do i = 1, size(scene%fixes)
         associate (here => scene%fixes%group_name == scene%fixes(i)%group_name, field => scene%fixes%field)
            if (field(i) /= PRESCRIBED_P_A .or. .not. any(here .and. field == AT_P_C) .or. &
                any(here .and. field == AT_P_W)) cycle
            why = 'p_a and p_c of '''//trim(scene%fixes(i)%group_name)//''' prescribe p_w: give p_w and one of these'
         end associate
      end do
   end function water_given_by_others

   !> Without the fixed values and the inflows of a field, and of those that need it.
   pure subroutine drop_field(scene, first_field, first_load)
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: first_field, first_load

      scene%fixes = pack(scene%fixes, scene%fixes%field < first_field)
      scene%loads = pack(scene%loads, scene%loads%kind < first_load .or. scene%loads%kind > LOAD_AIR)
   end subroutine drop_field

   subroutine set_switch(scene, kind, on)
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: kind
      logical, intent(in) :: on
      real(wp) :: value, lower, upper
      integer :: i

      call property_range(property_index(trim(SWITCHES(kind))), lower, upper, value)
      if (kind == OF_HYSTERESIS) value = SWITCHED_ON
      if (.not. on) value = 0.0_wp
      do i = 1, size(scene%materials)
         if (scene%materials(i)%group%name == 'mud') call set_number(scene, i, trim(SWITCHES(kind)), value)
      end do
   end subroutine set_switch

   !> The retention curve that holds at the initial void ratio, whatever happens to it.
   subroutine freeze_retention(scene, why)
      type(scene_t), intent(inout) :: scene
      character(*), intent(out) :: why
      real(wp) :: e, e_other, omega, p_a
      integer :: i, k

      why = ''
      do i = 1, size(scene%materials)
         omega = parameter_of(scene, i, 'Omega')
         if (.not. omega > 0.0_wp) cycle
         e = 0.0_wp
         do k = 1, size(scene%regions)
            if (scene%regions(k)%material_name(:NAME_LENGTH) /= scene%materials(i)%name) cycle
            e_other = scene%regions(k)%void_ratio
            if (e_other < 0.0_wp) e_other = parameter_of(scene, i, 'e_0')
            if (e > 0.0_wp .and. abs(e - e_other) > ROUNDING) &
               why = 'material '//trim(scene%materials(i)%name)//' has regions of several void ratios'
            e = e_other
         end do
         if (why /= '') return
         if (.not. e > 0.0_wp) cycle
         p_a = parameter_of(scene, i, 'P_a')*e**(-omega)
         call set_number(scene, i, 'Omega', 0.0_wp)
         call set_number(scene, i, 'P_a', p_a)
      end do
   end subroutine freeze_retention

   subroutine set_number(scene, material, name, value)
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: material
      character(*), intent(in) :: name
      real(wp), intent(in) :: value
      character(26) :: text

      write (text, '(es24.16)') value
      call set_entry(scene%materials(material)%group, name, trim(adjustl(text)))
   end subroutine set_number

   logical function any_mud(scene)
      type(scene_t), intent(in) :: scene
      integer :: i

      any_mud = any([(scene%materials(i)%group%name == 'mud', i=1, size(scene%materials))])
   end function any_mud

   !> Value of a parameter of MUD, from the group, its file or the library; 0 of other laws, and where the group is
   !> refused, which is told where the model is built.
   real(wp) function parameter_of(scene, material, name) result(value)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: material
      character(*), intent(in) :: name
      real(wp), allocatable :: props(:)
      character(256) :: title
      character(600) :: doubt
      type(fault_t) :: fault

      value = 0.0_wp
      if (scene%materials(material)%group%name /= 'mud') return
      call read_parameters(scene%materials(material)%group, props, title, doubt, fault)
      if (fault%code == 0) value = props(property_index(name))
   end function parameter_of
end module effect_switches
