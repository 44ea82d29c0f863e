! SPDX-License-Identifier: MIT
!> Effects that the key `without` takes out of a scene, each by the keys that say it: the scene that results is one
!> that a user could have written. docs/theory/host.md section 11.
module effect_switches
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: get_text, get_number, given, texts_of
   use library_tables, only: property_index
   use namelists, only: group_t, set_entry
   use parameter_groups, only: read_parameters
   use scene_types, only: scene_t, groups_named
   use texts, only: lower_case, read_number, LENGTH
   implicit none (type, external)
   private
   public :: remove_effects, EFFECT_WORDS

   !> Words of the key.
   character(*), parameter :: EFFECT_WORDS = 'inertia|relative_acceleration|p_w|p_c|gravity|contact|damping|'// &
      'absorbing|contact_drainage|seepage_face|friction|strength|void_ratio_in_retention|hysteresis|bonding|fabric|'// &
      'isotropic|lode|memory_rule|elastic_domain'

   character(*), parameter :: SOIL = 'mud'   !< Its parameters may come from a file or be defaults.

   !> A key that says an effect.
   type :: switch_t
      character(23) :: effect
      character(9) :: group
      character(17) :: key         !< Empty: a group of the name says it.
      character(14) :: with        !< Words that say it; empty: any value but `without`, of the soil one above 0.
      character(12) :: without     !< Value of the key without the effect; empty: the group is left out.
      logical :: makes = .true.    !< Else it goes with the effect, and does not make one.
   end type switch_t

   type(switch_t), parameter :: SWITCHES(*) = [ &
      switch_t('inertia', 'stage', 'analysis', 'dynamic', 'quasi_static'), &
      switch_t('inertia', 'scene', 'seepage_inertia', 'yes', 'no', makes=.false.), &
      switch_t('relative_acceleration', 'scene', 'seepage_inertia', 'yes', 'no'), &
      switch_t('p_w', 'scene', 'fields', '', 'u'), &
      switch_t('p_w', 'scene', 'seepage_inertia', 'yes', 'no', makes=.false.), &
      switch_t('p_w', 'fix', 'field', 'p_w|p_c|p_a', '', makes=.false.), &
      switch_t('p_w', 'load', 'kind', 'water|rain|air', '', makes=.false.), &
      switch_t('p_w', 'tie', 'pressures', 'yes', 'no', makes=.false.), &
      switch_t('p_w', 'contact', 'drainage', 'state', 'fixed', makes=.false.), &
      switch_t('p_c', 'scene', 'fields', 'u-p_w-p_c', 'u-p_w'), &
      switch_t('p_c', 'fix', 'field', 'p_c|p_a', '', makes=.false.), &
      switch_t('p_c', 'load', 'kind', 'air', '', makes=.false.), &
      switch_t('gravity', 'scene', 'gravity', '', '0'), &
      switch_t('contact', 'contact', '', '', ''), &
      switch_t('damping', 'region', 'damping', '', '0'), &
      switch_t('damping', 'region', 'stiffness_damping', '', '0'), &
      switch_t('damping', 'region', 'viscosity', '', '0'), &
      switch_t('absorbing', 'absorbing', '', '', ''), &
      switch_t('contact_drainage', 'contact', 'drainage', 'state', 'fixed'), &
      switch_t('seepage_face', 'fix', 'kind', 'seepage', 'value'), &   ! The limit is prescribed,
      switch_t('seepage_face', 'load', 'kind', 'rain', 'water'), &     ! and all rain flows in.
      switch_t('friction', 'contact', 'friction', '', '0'), &
      switch_t('friction', 'contact', 'cohesion', '', '0'), &
      switch_t('strength', 'strength', '', '', ''), &
      switch_t('hysteresis', SOIL, 'hysteresis', '', '0'), &
      switch_t('bonding', SOIL, 'bonding', '', '0'), &
      switch_t('fabric', SOIL, 'fabric', '', '0'), &
      switch_t('isotropic', SOIL, 'isotropic', '', '0'), &
      switch_t('lode', SOIL, 'lode', '', '0'), &
      switch_t('memory_rule', SOIL, 'memory_rule', '', '0'), &
      switch_t('elastic_domain', SOIL, 'rho_e', '', '0'), &
      switch_t('void_ratio_in_retention', SOIL, 'Omega', '', '0')]
   real(wp), parameter :: ROUNDING = 1.0e-12_wp
contains
   !> Makes the groups of a scene of those that were read, without the effects of its key `without`. Those that the
   !> scene does not have become its list `absent`. Fault EXIT_INPUT: one of them cannot be taken out.
   subroutine remove_effects(scene, fault)
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      character(LENGTH), allocatable :: without(:)
      character(:), allocatable :: why
      integer :: i

      scene%groups = scene%as_read
      i = findloc(scene%groups%name == 'scene', .true., dim=1)
      without = lower_case(texts_of(scene%groups(i), 'without'))
      scene%absent = pack(without, [(.not. is_present(scene%groups, trim(without(i))), i=1, size(without))])
      do i = 1, size(without)
         call remove(scene, trim(without(i)), why)
         if (why /= '') call raise(fault, EXIT_INPUT, trim(scene%origin%file)//': without = '//trim(without(i))// &
                                   ': '//why//'.')
      end do
   end subroutine remove_effects

   logical function is_present(groups, effect) result(present)
      type(group_t), intent(in) :: groups(:)
      character(*), intent(in) :: effect
      integer :: i, k

      present = .false.
      do i = 1, size(groups)
         do k = 1, size(SWITCHES)
            if (SWITCHES(k)%effect /= effect .or. .not. SWITCHES(k)%makes) cycle
            present = says(groups(i), SWITCHES(k))
            if (present) return
         end do
      end do
   end function is_present

   !> Whether a group says an effect by a key.
   logical function says(group, switch)
      type(group_t), intent(in) :: group
      type(switch_t), intent(in) :: switch
      character(LENGTH) :: value
      real(wp) :: number
      logical :: good

      says = group%name == switch%group
      if (.not. says .or. switch%key == '') return
      if (group%name == SOIL) then
         says = parameter_of(group, trim(switch%key)) > 0.0_wp
         return
      end if
      says = given(group, trim(switch%key))
      if (.not. says) return
      call get_text(group, trim(switch%key), value)
      value = lower_case(value)
      call read_number(value, number, good)
      says = merge(abs(number) > 0.0_wp, value /= switch%without, good)
      if (switch%with /= '') says = index('|'//trim(switch%with)//'|', '|'//trim(value)//'|') > 0
   end function says

   !> Takes an effect out of the groups of a scene.
   subroutine remove(scene, effect, why)
      type(scene_t), intent(inout) :: scene
      character(*), intent(in) :: effect
      character(:), allocatable, intent(out) :: why   !< Why it cannot be; empty if it could.
      logical :: kept(size(scene%groups))
      integer :: i, k

      why = ''
      select case (effect)
      case ('gravity')
         if (any([(asks_for_weight(scene%groups(i)), i=1, size(kept))])) &
            why = 'the scene asks for weight: geostatic stress, a water table or a heavy plate'
      case ('p_c')
         why = water_given_by_others(groups_named(scene, 'fix'))
      case ('void_ratio_in_retention')
         why = freeze_retention(scene)
      end select
      if (why /= '') return
      kept = .true.
      do i = 1, size(kept)
         associate (group => scene%groups(i))
            do k = 1, size(SWITCHES)
               if (SWITCHES(k)%effect /= effect) cycle
               if (.not. says(group, SWITCHES(k))) cycle
               kept(i) = kept(i) .and. SWITCHES(k)%without /= ''
               if (kept(i)) call set_entry(group, trim(SWITCHES(k)%key), trim(SWITCHES(k)%without))
            end do
         end associate
      end do
      scene%groups = pack(scene%groups, kept)
   end subroutine remove

   logical function asks_for_weight(group) result(asks)
      type(group_t), intent(in) :: group

      asks = any([says(group, switch_t('', 'initial', 'stress', 'geostatic', '')), &
                  says(group, switch_t('', 'plate', 'weight', 'yes', '')), &
                  group%name == 'initial' .and. given(group, 'water_table')])
   end function asks_for_weight

   !> Where p_a and p_c are prescribed, p_w is as well: without these two its boundary would be closed. Empty: nowhere.
   function water_given_by_others(fixes) result(why)
      type(group_t), intent(in) :: fixes(:)
      character(:), allocatable :: why
      character(LENGTH) :: at(size(fixes)), field(size(fixes))
      integer :: i

      why = ''
      do i = 1, size(fixes)
         call get_text(fixes(i), 'group', at(i))
         call get_text(fixes(i), 'field', field(i))
      end do
      field = lower_case(field)
      do i = 1, size(fixes)
         if (field(i) /= 'p_a' .or. .not. any(at == at(i) .and. field == 'p_c') .or. &
             any(at == at(i) .and. field == 'p_w')) cycle
         why = 'p_a and p_c of '''//trim(at(i))//''' prescribe p_w: give p_w and one of these'
      end do
   end function water_given_by_others

   !> Gives every soil the retention curve that holds at the initial void ratio, whatever happens to it; why not, where
   !> it has several.
   function freeze_retention(scene) result(why)
      type(scene_t), intent(inout) :: scene
      character(:), allocatable :: why
      type(group_t), allocatable :: regions(:)
      character(LENGTH) :: name, material
      character(26) :: text
      real(wp) :: e, e_other, omega
      integer :: i, k
      logical :: found

      why = ''
      allocate (regions, source=groups_named(scene, 'region'))
      do i = 1, size(scene%groups)
         associate (soil_group => scene%groups(i))
            omega = parameter_of(soil_group, 'Omega')
            if (.not. omega > 0.0_wp) cycle
            call get_text(soil_group, 'name', name)
            e = 0.0_wp
            do k = 1, size(regions)
               call get_text(regions(k), 'material', material)
               if (material /= name) cycle
               call get_number(regions(k), 'void_ratio', e_other, found)
               if (.not. found) e_other = parameter_of(soil_group, 'e_0')
               if (e > 0.0_wp .and. abs(e - e_other) > ROUNDING) &
                  why = 'material '//trim(name)//' has regions of several void ratios'
               e = e_other
            end do
            if (why /= '') return
            if (.not. e > 0.0_wp) cycle
            write (text, '(es24.16)') parameter_of(soil_group, 'P_a')*e**(-omega)
            call set_entry(soil_group, 'P_a', trim(adjustl(text)))
         end associate
      end do
   end function freeze_retention

   !> Finds the value of a parameter of MUD, from the group, its file or the library; 0 of other groups, and where the
   !> group is refused, which is told where the model is built.
   real(wp) function parameter_of(group, name) result(value)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      real(wp), allocatable :: props(:)
      character(256) :: title
      character(600) :: doubt
      type(fault_t) :: fault

      value = 0.0_wp
      if (group%name /= SOIL) return
      call read_parameters(group, props, title, doubt, fault)
      if (fault%code == 0) value = props(property_index(name))
   end function parameter_of
end module effect_switches
