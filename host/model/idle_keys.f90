! SPDX-License-Identifier: MIT
!> Keys of a scene that change nothing because another key says so, and definitions that nobody uses.
module idle_keys
   use effect_types, only: OF_P_W, OF_P_C
   use faults, only: at_line
   use key_schema, only: given, line_of
   use material_registry, only: is_law
   use namelists, only: group_t
   use scene_keys, only: text_of
   use scene_types, only: scene_t, WITH_U, WITH_P_W, WITH_P_C
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: list_idle_keys, add_warning, WARNING_LENGTH

   integer, parameter :: WARNING_LENGTH = 500

   !> A key that acts only where another one of its group has one of some words.
   type :: rule_t
      character(12) :: group
      character(20) :: key
      character(12) :: decides
      character(40) :: words     !< divided and enclosed by |
   end type rule_t

   type(rule_t), parameter :: RULES(*) = [ &
      rule_t('permeability', 'a', 'law', '|power|'), rule_t('permeability', 'b', 'law', '|corey|power|'), &
      rule_t('permeability', 'c', 'law', '|corey|power|'), rule_t('permeability', 'm', 'law', '|mualem|'), &
      rule_t('permeability', 'k_rw', 'law', '|constant|'), rule_t('permeability', 'k_ra', 'law', '|constant|'), &
      rule_t('permeability', 's_min', 'law', '|corey|mualem|power|'), &
      rule_t('permeability', 's_max', 'law', '|corey|mualem|power|'), &
      rule_t('retention', 'p_a', 'law', '|bilogarithmic|'), rule_t('retention', 'omega', 'law', '|bilogarithmic|'), &
      rule_t('retention', 'alpha', 'law', '|van_genuchten|'), &
      rule_t('retention', 'n', 'law', '|bilogarithmic|van_genuchten|'), &
      rule_t('retention', 'm', 'law', '|bilogarithmic|van_genuchten|'), &
      rule_t('retention', 's_max', 'law', '|bilogarithmic|van_genuchten|'), &
      rule_t('retention', 's_min', 'law', '|bilogarithmic|van_genuchten|power|'), &
      rule_t('retention', 'a', 'law', '|power|'), rule_t('retention', 'b', 'law', '|power|'), &
      rule_t('retention', 'suction', 'law', '|table|'), rule_t('retention', 'saturation', 'law', '|table|'), &
      rule_t('retention', 'file', 'law', '|table|'), &
      rule_t('initial', 'sigma', 'stress', '|uniform|'), rule_t('initial', 'surface', 'stress', '|geostatic|'), &
      rule_t('initial', 'surcharge', 'stress', '|geostatic|'), rule_t('initial', 'k_0', 'stress', '|geostatic|'), &
      rule_t('initial', 'k_0_of', 'stress', '|geostatic|'), &
      rule_t('fluids', 'k_a', 'gas', '|constant|'), rule_t('scene', 'effects_tolerance', 'effects', '|auto|'), &
      rule_t('scene', 'effects_pilot_share', 'effects', '|auto|'), &
      rule_t('scene', 'effects_on_warning', 'effects', '|auto|'), &
      rule_t('stage', 'rho_inf', 'analysis', '||quasi_static|dynamic|'), &
      rule_t('stage', 'start', 'analysis', '||dynamic|'), &
      rule_t('region', 'permeability', 'drainage', '|coupled|'), &
      rule_t('region', 'retention', 'drainage', '|coupled|drained|undrained|'), &
      rule_t('fix', 'value', 'hold', '|no|'), rule_t('fix', 'value_slope', 'hold', '|no|'), &
      rule_t('fix', 'history', 'hold', '|no|')]

   !> A key that acts only where another one is given (or, with `without`, is not).
   type :: partner_t
      character(12) :: group
      character(15) :: key
      character(12) :: partner
      logical :: without = .false.
   end type partner_t

   type(partner_t), parameter :: PARTNERS(*) = [ &
      partner_t('fix', 'datum', 'value_slope'), partner_t('load', 'datum', 'value_slope'), &
      partner_t('stage', 'dt_max', 'dt_growth'), partner_t('initial', 'wave_number', 'wave'), &
      partner_t('scene', 'gravity_history', 'gravity'), &
      partner_t('plate', 'z', 'r'), partner_t('plate', 'face', 'r'), partner_t('mesh', 'scale', 'file'), &
      partner_t('mesh', 'r', 'file', .true.), &
      partner_t('mesh', 'z', 'file', .true.), partner_t('mesh', 'r_cells', 'file', .true.), &
      partner_t('mesh', 'z_cells', 'file', .true.), partner_t('mesh', 'r_ratio', 'file', .true.), &
      partner_t('mesh', 'z_ratio', 'file', .true.), partner_t('history', 'times', 'file', .true.), &
      partner_t('history', 'values', 'file', .true.), partner_t('retention', 'suction', 'file', .true.), &
      partner_t('retention', 'saturation', 'file', .true.)]

   !> Keys that need the field p_w, and those that need p_c.
   character(*), parameter :: NEED_P_W(*) = [character(22) :: 'scene pressures', 'scene seepage_inertia', &
      'scene initial_flow', 'region permeability', 'region drainage', 'fluids k_w', 'fluids rho_w', 'fluids eta_w', &
      'initial p_w', 'initial p_w_slope']
   character(*), parameter :: NEED_P_C(*) = [character(22) :: 'scene saturation_rate', 'region retention', &
      'fluids k_a', 'fluids rho_a', 'fluids eta_a', 'fluids gas', 'fluids p_ref', 'initial p_c', 'initial p_c_slope', &
      'initial saturation']
contains
   !> Adds a warning for every key and every definition of a scene that has no effect.
   subroutine list_idle_keys(scene, warnings)
      type(scene_t), intent(in) :: scene
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)   !< They grow. (warnings)
      integer :: g, i

      if (allocated(scene%absent)) then
         do i = 1, size(scene%absent)
            call add_warning(trim(scene%file)//': without = '''//trim(scene%absent(i))// &
                             ''' of &scene has no effect: the scene does not have it.', warnings)
         end do
      end if
      do g = 1, size(scene%groups)
         if (is_law(scene%groups(g)%name)) cycle
         call look_at_rules(scene%groups(g), warnings)
         call look_at_fields(fields_of(scene), scene%groups(g), warnings)
      end do
      call look_for_users(scene, warnings)
   end subroutine list_idle_keys

   subroutine look_at_rules(group, warnings)
      type(group_t), intent(in) :: group
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      character(:), allocatable :: word
      integer :: k

      do k = 1, size(RULES)
         if (RULES(k)%group /= group%name .or. .not. given(group, RULES(k)%key)) cycle
         word = lower_case(text_of(group, trim(RULES(k)%decides)))
         if (index(RULES(k)%words, '|'//word//'|') == 0) call add_warning(place(RULES(k)%key)//'has no effect with '// &
            trim(RULES(k)%decides)//' = '''//word//'''.', warnings)
      end do
      do k = 1, size(PARTNERS)
         if (PARTNERS(k)%group /= group%name .or. .not. given(group, PARTNERS(k)%key)) cycle
         if (given(group, PARTNERS(k)%partner) .neqv. PARTNERS(k)%without) cycle
         call add_warning(place(PARTNERS(k)%key)//'has no effect '//trim(merge('beside ', 'without', &
            PARTNERS(k)%without))//' '//trim(PARTNERS(k)%partner)//'.', warnings)
      end do
   contains
      function place(key) result(text)
         character(*), intent(in) :: key
         character(:), allocatable :: text

         text = at_line(group%file, line_of(group, key))//trim(key)//' of &'//trim(group%name)//' '
      end function place
   end subroutine look_at_rules

   !> Fields of a scene, with those that pilots have removed: what these need was not in vain.
   pure integer function fields_of(scene) result(fields)
      type(scene_t), intent(in) :: scene

      fields = scene%fields
      if (.not. allocated(scene%effects)) return
      if (any(scene%effects%kind == OF_P_W .and. scene%effects%present)) fields = max(fields, WITH_P_W)
      if (any(scene%effects%kind == OF_P_C .and. scene%effects%present)) fields = WITH_P_C
   end function fields_of

   subroutine look_at_fields(fields, group, warnings)
      integer, intent(in) :: fields
      type(group_t), intent(in) :: group
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)

      if (fields == WITH_U) call look(NEED_P_W, 'p_w')
      if (fields < WITH_P_C) call look(NEED_P_C, 'p_c')
   contains
      subroutine look(keys, field)
         character(*), intent(in) :: keys(:), field
         integer :: k, blank

         do k = 1, size(keys)
            blank = index(keys(k), ' ')
            if (keys(k)(:blank) /= group%name .or. .not. given(group, trim(keys(k)(blank + 1:)))) cycle
            call add_warning(at_line(group%file, line_of(group, trim(keys(k)(blank + 1:))))// &
                             trim(keys(k)(blank + 1:))//' of &'//trim(group%name)//' has no effect: the scene has '// &
                             'no field '//field//'.', warnings)
         end do
      end subroutine look
   end subroutine look_at_fields

   !> Materials, curves, permeabilities and histories that no group names.
   subroutine look_for_users(scene, warnings)
      type(scene_t), intent(in) :: scene
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      character(12) :: key
      integer :: g, k
      logical :: used

      do g = 1, size(scene%groups)
         associate (group => scene%groups(g))
            key = group%name(:12)
            if (is_law(group%name)) key = 'material'
            if (.not. any([character(12) :: 'material', 'retention', 'permeability', 'history'] == key)) cycle
            used = .false.
            do k = 1, size(scene%groups)
               if (key == 'history' .and. given(scene%groups(k), 'gravity_history')) &
                  used = used .or. text_of(scene%groups(k), 'gravity_history') == name_of(group)
               if (k == g .or. .not. given(scene%groups(k), trim(key))) cycle
               if (is_law(scene%groups(k)%name)) cycle
               used = used .or. text_of(scene%groups(k), trim(key)) == name_of(group)
            end do
            if (.not. used) call add_warning(at_line(group%file, group%line)//'&'//trim(group%name)//' '''// &
               name_of(group)//''' has no effect: no group names it as its '//trim(key)//'.', warnings)
         end associate
      end do
   end subroutine look_for_users

   !> Name of a group, of laws as well.
   pure function name_of(group) result(name)
      type(group_t), intent(in) :: group
      character(:), allocatable :: name
      integer :: i

      name = ''
      do i = 1, group%count
         if (lower_case(group%entries(i)%key) == 'name') name = trim(group%entries(i)%values(1))
      end do
   end function name_of

   !> Adds a text to the warnings.
   subroutine add_warning(text, warnings)
      character(*), intent(in) :: text
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)   !< They grow by one. (warnings)
      character(WARNING_LENGTH), allocatable :: more(:)
      integer :: n

      n = 0
      if (allocated(warnings)) n = size(warnings)
      allocate (more(n + 1))
      if (n > 0) more(:n) = warnings
      more(n + 1) = text
      call move_alloc(more, warnings)
   end subroutine add_warning
end module idle_keys
