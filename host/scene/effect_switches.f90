! SPDX-License-Identifier: MIT
!> Effects that the key `without` takes out of a scene, each by the keys that say it: the scene that results is one
!> that a user could have written. docs/theory/host.md section 11.
module effect_switches
   use kinds, only: wp
   use effect_names, only: EFFECTS, OF_INERTIA, OF_SEEPAGE, OF_P_W, OF_P_C, OF_GRAVITY, OF_CONTACT, OF_DAMPING, &
      OF_LIMITS, OF_VOID_RATIO, OF_HYSTERESIS, OF_ELASTIC_DOMAIN, term_switch_t, TERM_SWITCHES
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: get_text, given
   use library_tables, only: property_index
   use namelists, only: set_entry
   use parameter_groups, only: read_parameters
   use scene_parts, only: NAME_LENGTH, PRESCRIBED_P_A, LOAD_WATER, LOAD_RAIN, LOAD_AIR
   use scene_types, only: scene_t, WITH_U, WITH_P_W, WITH_P_C
   use texts, only: lower_case, read_number, LENGTH
   use generalised_alpha, only: QUASI_STATIC, has_inertia
   use unknown_fields, only: AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: remove_effects

   real(wp), parameter :: ROUNDING = 1.0e-12_wp
   !> Switches of the material, in the order of their effects: 0 is off (of memory_rule: classic).
   character(11), parameter :: SWITCHES(OF_HYSTERESIS:OF_ELASTIC_DOMAIN) = [character(11) :: 'hysteresis', 'bonding', &
      'fabric', 'isotropic', 'lode', 'memory_rule', 'rho_e']
contains
   logical function is_present(scene, effect) result(present)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: effect   !< One of OF_...
      integer :: i

      present = any([(is_said(scene, TERM_SWITCHES(i)), i=1, size(TERM_SWITCHES))] .and. TERM_SWITCHES%effect == effect)
      select case (effect)
      case (OF_INERTIA)
         present = any(has_inertia(scene%stages%kind))
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
         present = present .or. any(scene%regions%damping > 0.0_wp .or. scene%regions%stiffness_damping > 0.0_wp)
      case (OF_LIMITS)
         present = scene%fields /= WITH_U .and. (any(scene%fixes%limits) .or. any(scene%loads%kind == LOAD_RAIN))
      case (OF_VOID_RATIO)
         if (scene%fields == WITH_P_C) &
            present = any([(parameter_of(scene, i, 'Omega') > 0.0_wp, i=1, size(scene%materials))])
      case (OF_HYSTERESIS:OF_ELASTIC_DOMAIN)
         present = any([(parameter_of(scene, i, trim(SWITCHES(effect))) > 0.0_wp, i=1, size(scene%materials))])
      end select
   end function is_present

   !> Takes the effects of the key `without` out. Those that the scene does not have become its list `absent`. Fault
   !> EXIT_INPUT: one of them cannot be.
   subroutine remove_effects(scene, fault)
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      logical :: here(size(scene%without))
      character(200) :: why
      integer :: i

      here = [(is_present(scene, findloc(EFFECTS, scene%without(i), dim=1)), i=1, size(here))]
      scene%absent = pack(scene%without, .not. here)
      do i = 1, size(here)
         call remove(scene, findloc(EFFECTS, scene%without(i), dim=1), why)
         if (why /= '') call raise(fault, EXIT_INPUT, trim(scene%file)//': without = '//trim(scene%without(i))// &
                                   ': '//trim(why)//'.')
      end do
   end subroutine remove_effects

   !> Takes an effect out of a scene.
   subroutine remove(scene, effect, why)
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: effect        !< One of OF_...
      character(*), intent(out) :: why     !< Why it cannot be; empty if it could.
      integer :: i

      why = ''
      do i = 1, size(TERM_SWITCHES)
         if (TERM_SWITCHES(i)%effect == effect .or. (TERM_SWITCHES(i)%wet .and. effect == OF_P_W)) &
            call unsay(scene, TERM_SWITCHES(i))
      end do
      select case (effect)
      case (OF_INERTIA)
         where (has_inertia(scene%stages%kind)) scene%stages%kind = QUASI_STATIC
         scene%seepage_inertia = .false.
      case (OF_SEEPAGE)
         scene%seepage_inertia = .false.
      case (OF_P_W)
         call drop_field(scene, AT_P_W, LOAD_WATER)
         scene%fields = WITH_U
         scene%seepage_inertia = .false.
         if (size(scene%ties) > 0) scene%ties%pressures = .false.
      case (OF_P_C)
         why = water_given_by_others(scene)
         if (why /= '') return
         call drop_field(scene, AT_P_C, LOAD_AIR)
         scene%fields = min(scene%fields, WITH_P_W)
      case (OF_GRAVITY)
         if (any(scene%initials%geostatic) .or. any(scene%plates%heavy)) &
            why = 'the scene asks for weight: geostatic stress or a heavy plate'
         if (why == '') scene%gravity = 0.0_wp
      case (OF_CONTACT)
         scene%contacts = scene%contacts(:0)
      case (OF_DAMPING)
         scene%regions%damping = 0.0_wp
         scene%regions%stiffness_damping = 0.0_wp
      case (OF_LIMITS)
         ! The limit is prescribed, and all rain flows in.
         scene%fixes%limits = .false.
         where (scene%loads%kind == LOAD_RAIN) scene%loads%kind = LOAD_WATER
      case (OF_VOID_RATIO)
         call freeze_retention(scene, why)
      case (OF_HYSTERESIS:OF_ELASTIC_DOMAIN)
         call switch_off(scene, trim(SWITCHES(effect)))
      end select
   end subroutine remove

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

   !> Whether the scene asks for a term by a group or key: a key says something else than that there is none.
   logical function is_said(scene, switch)
      type(scene_t), intent(in) :: scene
      type(term_switch_t), intent(in) :: switch
      character(LENGTH) :: value
      real(wp) :: number
      logical :: good
      integer :: i

      is_said = .false.
      do i = 1, size(scene%groups)
         if (scene%groups(i)%name /= switch%group) cycle
         value = switch%none
         call get_text(scene%groups(i), switch%key, value)
         call read_number(value, number, good)
         is_said = is_said .or. switch%key == '' .or. &
                   merge(abs(number) > 0.0_wp, lower_case(value) /= switch%none, good)
      end do
   end function is_said

   !> Takes the groups of a term out, or lets their key say that there is none.
   subroutine unsay(scene, switch)
      type(scene_t), intent(inout) :: scene
      type(term_switch_t), intent(in) :: switch
      integer :: i

      do i = 1, size(scene%groups)
         if (scene%groups(i)%name /= switch%group) cycle
         if (switch%key == '') scene%kept(i) = .false.
         if (given(scene%groups(i), switch%key)) call set_entry(scene%groups(i), switch%key, trim(switch%none))
      end do
   end subroutine unsay

   !> A switch of the material is 0.
   subroutine switch_off(scene, name)
      type(scene_t), intent(inout) :: scene
      character(*), intent(in) :: name
      integer :: i

      do i = 1, size(scene%materials)
         if (scene%materials(i)%group%name == 'mud') call set_number(scene, i, name, 0.0_wp)
      end do
   end subroutine switch_off

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
