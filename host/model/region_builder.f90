! SPDX-License-Identifier: MIT
!> Materials, &retention, &permeability and &region of a scene: the laws, and which of them every element has.
module region_builder
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use exit_codes, only: EXIT_GROUP
   use key_schema, only: line_of, get_text, given, REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use material_mud, only: mud_t
   use material_point, only: material_t, material_slot_t
   use material_registry, only: new_material
   use model_types, only: model_t, given_region_t, curve_t
   use name_search, only: mesh_group, defined_name
   use namelists, only: group_t, set_entry
   use permeability_laws, only: permeability_t
   use porous_domain, only: region_t, COUPLED, DRY
   use retention_groups, only: new_retention
   use scene_parts, only: place_of
   use scene_types, only: item_of
   use texts, only: whole, LENGTH
   implicit none (type, external)
   private
   public :: build_retention, build_permeability, build_material, build_region

   real(wp), parameter :: BIG = UNBOUNDED, TINY_ = 1.0e-30_wp, ZERO = 0.0_wp, ONE = 1.0_wp
   real(wp), parameter :: STRESS_SHARE = 0.1_wp   !< Tolerance of MUD's stress integration as a share of the steps'.
   real(wp), parameter :: STRESS_LEAST = 1.0e-10_wp, STRESS_LARGEST = 1.0e-3_wp   !< Its bounds.
   real(wp), parameter :: TIGHT = 1.0e-3_wp       !< Below it the scheme of order 3 costs less.
   !> Names of no curve: the material has a retention of its own. The second is that of older scenes.
   character(8), parameter :: OF_THE_MATERIAL(2) = [character(8) :: 'material', 'mud']
   !> Units of stress in which nobody gives a reference pressure in kPa: 100 MPa, or a tenth of a kPa.
   character(3), parameter :: FOREIGN_UNITS(2) = [character(3) :: 'Pa', 'MPa']
contains
   !> Builds a &retention. The fault of its curve is told where a region asks for it.
   subroutine build_retention(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(curve_t) :: curve

      call k%text('name', curve%name, 'name, for the key of &region', REQUIRED)
      call new_retention(k, curve%curve, curve%fault)
      if (.not. k%lists) model%curves = [model%curves, curve]
   end subroutine build_retention

   !> Builds a &permeability. Fault EXIT_INPUT: an empty range of saturation.
   subroutine build_permeability(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(permeability_t) :: law

      call k%text('name', law%name, 'name, for the key of &region', REQUIRED)
      call k%number('intrinsic', law%intrinsic, TINY_, ONE, 'intrinsic permeability [m2]', REQUIRED)
      call k%word('law', law%law, 'corey|mualem|power|constant', 'relative permeabilities')
      call k%number('s_min', law%s_min, ZERO, 0.999_wp, 'S_w at which S_e = 0 [-]', 'law=corey|mualem|power :p_c :time')
      call k%number('s_max', law%s_max, 0.001_wp, ONE, 'S_w at which S_e = 1 [-]', 'law=corey|mualem|power :p_c :time')
      call k%number('a', law%a, ZERO, BIG, 'power: k_rw = 1 - a (1 - S_w)**b', 'law=power :p_c :time')
      call k%number('b', law%b, ONE, 100*ONE, 'corey: k_rw = S_e**b; power: see a', 'law=corey|power :p_c :time')
      call k%number('c', law%c, ONE, 100*ONE, 'corey, power: k_ra = (1 - S_e)**2 (1 - S_e**c)', &
                    'law=corey|power :p_c :time')
      call k%number('m', law%m, 0.01_wp, 0.99_wp, 'exponent of Mualem-van Genuchten [-]', 'law=mualem :p_c :time')
      call k%number('k_rw', law%k_rw, ZERO, ONE, 'constant: relative permeability to water [-]', &
                    'law=constant :p_w :time')
      call k%number('k_ra', law%k_ra, ZERO, ONE, 'constant: relative permeability to air [-]', &
                    'law=constant :p_c :time')
      call k%number('floor', law%floor, ZERO, ONE, 'least relative permeability of a curve [-]', &
                    'law=corey|mualem|power :p_c :time')
      if (k%lists) return
      if (law%s_max <= law%s_min) call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)// &
                                             's_max must be larger than s_min.')
      model%domain%permeabilities = [model%domain%permeabilities, law]
   end subroutine build_permeability

   !> Builds the group of a material, whose law checks its own keys. Faults: those of new_material; EXIT_INPUT: tangent
   !> = 0, or a law in Pa or MPa.
   subroutine build_material(group, model, fault)
      type(group_t), intent(inout) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(material_slot_t) :: material
      character(LENGTH) :: name, title

      call get_text(group, 'name', name)
      material%name = name(:len(material%name))
      call ask_stress(model%step_tolerance, group)
      call new_material(trim(group%name), group, material%law, title, fault)
      if (fault%code /= 0) return
      if (any(material%law%unit%name == FOREIGN_UNITS)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'material '''//trim(name)//''' is in '// &
                    trim(material%law%unit%name)//', as its p_atm tells; scenes are in kPa. Give its parameters in '// &
                    'kPa (mud_describe udsm FILE --unit kPa lists those of a file).')
         return
      end if
      select type (law => material%law)
      type is (mud_t)
         if (law%given_tangent == 0) call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, 'tangent'))// &
            'tangent = 0 gives no slopes; Newton needs 1, 2 or 3 (3: consistent).')
      end select
      if (fault%code == 0) model%materials = [model%materials, material]
   end subroutine build_material

   !> Sets what the tolerance of the steps asks of the keys that a material leaves out: tolerance and scheme of MUD;
   !> nothing of other laws. docs/theory/host.md section 4.5.
   subroutine ask_stress(tolerance, group)
      real(wp), intent(in) :: tolerance   !< Of the scene [-]; 0: nothing.
      type(group_t), intent(inout) :: group
      character(16) :: text

      if (.not. tolerance > 0.0_wp .or. group%name /= 'mud') return
      if (.not. given(group, 'tolerance')) then
         write (text, '(es10.3)') min(STRESS_LARGEST, max(STRESS_LEAST, STRESS_SHARE*tolerance))
         call set_entry(group, 'tolerance', trim(adjustl(text)))
      end if
      if (.not. given(group, 'scheme') .and. tolerance < TIGHT) call set_entry(group, 'scheme', '2')
   end subroutine ask_stress

   !> Builds a &region, once mesh, laws and curves are known: its part of the domain. Fault EXIT_GROUP: a group or name
   !> that is not defined, or an element of two regions. EXIT_INPUT: no void ratio where there are fluids, two
   !> retentions or none, saturation_rate = "suction" with a saturation that is a state; and what the curve refuses.
   subroutine build_region(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(region_t) :: region
      type(given_region_t) :: given
      character(LENGTH) :: permeability_name
      integer :: group, m

      permeability_name = ''
      region%rho_s = 2.65_wp
      region%void_ratio = -1.0_wp
      call k%text('group', given%group_name, 'group of elements; without it those that no other region names')
      call k%text('material', given%material_name, 'name of a material, as &mud or &elastic', REQUIRED, &
                  refers='material')
      call k%text('retention', given%retention_name, 'name of a &retention, or "material": its own', &
                  'drainage=coupled|drained|undrained :p_c', refers='retention')
      call k%text('permeability', permeability_name, 'name of a &permeability', 'drainage=coupled :p_w', &
                  refers='permeability')
      call k%word('drainage', region%drainage, 'coupled|drained|undrained|dry', &
                  'fluids flow, stay at given pressures, stay in every element, or are absent', ':p_w')
      call k%number('rho_s', region%rho_s, ZERO, 1000*ONE, 'density of the grains [Mg/m3]')
      call k%number('void_ratio', region%void_ratio, ZERO, 10*ONE, 'initial void ratio [-]; default: the material''s')
      call k%number('damping', region%damping, ZERO, BIG, &
                    'force against the velocity over mass, dynamic stages [1/s]', ':dynamic')
      call k%number('stiffness_damping', region%stiffness_damping, ZERO, BIG, &
                    'stress of the skeleton from its rate, dynamic stages [s]', ':dynamic')
      if (k%lists) return
      given%scene_item_t = item_of(k%group)
      given%rest = .not. k%given('group')
      model%regions = [model%regions, given]
      group = mesh_group(model%domain%mesh, given%group_name, place_of(given), fault)
      if (fault%code /= 0) return
      m = defined_name('material', given%material_name, model%materials%name, place_of(given), fault)
      if (fault%code /= 0) return
      allocate (region%law, source=model%materials(m)%law)
      associate (domain => model%domain)
         region%stress_tolerance = region%law%tolerance
         region%law%lanes = model%lanes .and. region%law%has_lanes
         ! Without fluids in the scene there is no difference.
         if (.not. domain%with_w) region%drainage = COUPLED
         region%with_w = domain%with_w .and. region%drainage /= DRY
         region%with_c = domain%with_c .and. region%drainage /= DRY
         if (region%void_ratio < 0.0_wp) region%void_ratio = region%law%e_0
         if (region%with_w .and. .not. region%void_ratio > 0.0_wp) call raise(fault, EXIT_INPUT, place_of(given)// &
            'the region needs a void_ratio: its pores hold the fluids.')
         if (region%with_w .and. region%drainage == COUPLED .and. fault%code == 0) region%permeability = &
            defined_name('permeability', permeability_name, domain%permeabilities%name, place_of(given), fault)
         call take_elements(model%regions, domain%mesh%groups(group)%elements, domain%region_of, fault)
         if (region%with_c .and. fault%code == 0) call give_retention(model, given, region%law, fault)
         domain%regions = [domain%regions, region]
      end associate
   end subroutine build_region

   !> Takes the elements of the last region. One without a group has those that no other region names, wherever it is;
   !> elements that two groups name are refused, for nothing says which region they belong to.
   subroutine take_elements(regions, elements, region_of, fault)
      type(given_region_t), intent(in) :: regions(:)
      integer, intent(in) :: elements(:)
      integer, intent(inout) :: region_of(:)
      type(fault_t), intent(inout) :: fault
      logical :: both(size(elements))
      integer :: i

      if (fault%code /= 0) return
      associate (last => regions(size(regions)))
         both = region_of(elements) > 0
         do i = 1, size(elements)
            if (both(i)) both(i) = regions(region_of(elements(i)))%rest .eqv. last%rest
         end do
         i = findloc(both, .true., dim=1)
         if (i > 0) then
            associate (other => regions(region_of(elements(i))))
               call raise(fault, EXIT_GROUP, place_of(last)//'the groups '''//trim(last%group_name)//''' and '''// &
                  trim(other%group_name)//''' of two &region (lines '//whole(other%line)//' and '//whole(last%line)// &
                  ') have '//whole(count(both))//' elements in common, the first is '//whole(elements(i))// &
                  '; a &region without group has the elements that no other region names.')
            end associate
            return
         end if
         do i = 1, size(elements)
            if (region_of(elements(i)) == 0 .or. .not. last%rest) region_of(elements(i)) = size(regions)
         end do
      end associate
   end subroutine take_elements

   !> A law has a retention of its own, or the curve that the region names: never two. A rate of saturation by suction
   !> alone needs a curve.
   subroutine give_retention(model, given, law, fault)
      type(model_t), intent(in) :: model
      type(given_region_t), intent(in) :: given
      class(material_t), intent(inout) :: law
      type(fault_t), intent(inout) :: fault
      logical :: asked
      integer :: k

      asked = any(given%retention_name == OF_THE_MATERIAL)
      if (law%has_retention .and. .not. asked) then
         call raise(fault, EXIT_INPUT, place_of(given)//'material '''//trim(given%material_name)//''' has a '// &
                    'retention of its own: say retention = ''material'', and give its parameters there (of &mud: '// &
                    'P_a, Omega, n_x, m_x, S_max, S_min).')
      else if (law%saturation_is_state .and. .not. model%domain%full_rate) then
         call raise(fault, EXIT_INPUT, place_of(given)//'saturation_rate = ''suction'' of &scene takes the rate of '// &
                    'saturation from a retention curve, but the saturation of material '''// &
                    trim(given%material_name)//''' is a state variable (hysteresis = 1 of &mud, saturation_at of '// &
                    '&umat): set saturation_rate = ''full''.')
      else if (asked .and. .not. law%has_retention) then
         call raise(fault, EXIT_INPUT, place_of(given)//'material '''//trim(given%material_name)//''' has no '// &
                    'retention of its own; name a &retention.')
      else if (.not. law%has_retention) then
         k = defined_name('retention', given%retention_name, model%curves%name, place_of(given), fault)
         if (fault%code /= 0) return
         fault = model%curves(k)%fault
         if (fault%code == 0) law%curve = model%curves(k)%curve
      end if
   end subroutine give_retention
end module region_builder
