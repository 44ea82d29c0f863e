! SPDX-License-Identifier: MIT
!> Regions of a scene: which material, with which retention curve, and which relative permeability every element has.
module region_builder
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use exit_codes, only: EXIT_GROUP
   use key_schema, only: line_of
   use key_table, only: key_table_t, reading
   use material_mud, only: mud_t
   use material_point, only: material_t, material_slot_t
   use material_registry, only: new_material
   use name_search, only: mesh_group, defined_name
   use porous_domain, only: domain_t, COUPLED, DRY
   use retention_groups, only: new_retention
   use scene_parts, only: place_of
   use scene_types, only: scene_t, scene_region_t
   use texts, only: whole, LENGTH
   implicit none (type, external)
   private
   public :: build_regions

   !> Names of no curve: the material has a retention of its own. The second is that of older scenes.
   character(8), parameter :: OF_THE_MATERIAL(2) = [character(8) :: 'material', 'mud']
contains
   !> Materials, retention and permeability of every element; a fault names elements without a region and unknown names.
   !> Fault EXIT_GROUP: an element of no region or of two, or a name that is not defined. Fault EXIT_INPUT: no void
   !> ratio where there are fluids, two retentions or none, saturation_rate = "suction" with a saturation that is a
   !> state, tangent = 0; and what the laws refuse.
   subroutine build_regions(scene, domain, fault)
      type(scene_t), intent(in) :: scene
      type(domain_t), intent(inout) :: domain
      type(fault_t), intent(inout) :: fault
      type(material_slot_t) :: materials(size(scene%materials))
      character(LENGTH) :: title
      integer :: i

      do i = 1, size(scene%materials)
         associate (given => scene%materials(i))
            materials(i)%name = given%name
            call new_material(trim(given%group%name), given%group, materials(i)%law, title, fault)
            if (fault%code == 0) call check_tangent(materials(i), at_line(given%group%file, &
                                                                          line_of(given%group, 'tangent')), fault)
         end associate
         if (fault%code /= 0) return
      end do
      allocate (domain%regions(size(scene%regions)))
      allocate (domain%region_of(size(domain%mesh%t6, 2)), source=0)
      do i = 1, size(scene%regions)
         call build_region(scene, scene%regions(i), i, materials, domain, fault)
         if (fault%code /= 0) return
      end do
      if (any(domain%region_of == 0)) call raise(fault, EXIT_GROUP, trim(scene%file)//': element '// &
         whole(findloc(domain%region_of, 0, dim=1))//' belongs to no &region; add one with its group, or with '// &
         'group = ''all''.')
   end subroutine build_regions

   !> Newton's method needs slopes.
   subroutine check_tangent(material, place, fault)
      type(material_slot_t), intent(in) :: material
      character(*), intent(in) :: place
      type(fault_t), intent(inout) :: fault

      select type (law => material%law)
      type is (mud_t)
         if (law%given_tangent == 0) call raise(fault, EXIT_INPUT, place// &
            'tangent = 0 gives no slopes; Newton needs 1, 2 or 3 (3: consistent).')
      end select
   end subroutine check_tangent

   subroutine build_region(scene, given, number, materials, domain, fault)
      type(scene_t), intent(in) :: scene
      type(scene_region_t), intent(in) :: given
      integer, intent(in) :: number      !< Of the region.
      type(material_slot_t), intent(in) :: materials(:)
      type(domain_t), intent(inout) :: domain
      type(fault_t), intent(inout) :: fault
      integer :: group, k

      group = mesh_group(domain%mesh, given%group_name, place_of(given), fault)
      if (fault%code /= 0) return
      k = defined_name('material', given%material_name, materials%name, place_of(given), fault)
      if (fault%code /= 0) return
      associate (region => domain%regions(number))
         allocate (region%law, source=materials(k)%law)
         region%stress_tolerance = region%law%tolerance
         region%rho_s = given%rho_s
         region%damping = given%damping
         region%stiffness_damping = given%stiffness_damping
         region%void_ratio = given%void_ratio
         ! Without fluids in the scene there is no difference.
         region%drainage = merge(given%drainage, COUPLED, domain%with_w)
         region%with_w = domain%with_w .and. region%drainage /= DRY
         region%with_c = domain%with_c .and. region%drainage /= DRY
         if (given%void_ratio < 0.0_wp) region%void_ratio = region%law%default_void_ratio()
         if (region%with_w .and. .not. region%void_ratio > 0.0_wp) call raise(fault, EXIT_INPUT, place_of(given)// &
            'the region needs a void_ratio: its pores hold the fluids.')
         if (region%with_w .and. region%drainage == COUPLED .and. fault%code == 0) region%permeability = &
            defined_name('permeability', given%permeability_name, domain%permeabilities%name, place_of(given), fault)
         call take_elements(scene, number, domain%mesh%groups(group)%elements, domain%region_of, fault)
         if (region%with_c .and. fault%code == 0) call give_retention(scene, given, region%law, fault)
      end associate
   end subroutine build_region

   !> The elements of a region. One without a group has those that no other region names, wherever it stands; elements
   !> that two groups name are refused, for nothing says which region they belong to.
   subroutine take_elements(scene, number, elements, region_of, fault)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: number, elements(:)
      integer, intent(inout) :: region_of(:)
      type(fault_t), intent(inout) :: fault
      logical :: both(size(elements))
      integer :: i

      if (fault%code /= 0) return
      associate (regions => scene%regions)
         both = region_of(elements) > 0
         do i = 1, size(elements)
            if (both(i)) both(i) = regions(region_of(elements(i)))%rest .eqv. regions(number)%rest
         end do
         if (any(both)) then
            i = findloc(both, .true., dim=1)
            associate (other => regions(region_of(elements(i))))
               call raise(fault, EXIT_GROUP, place_of(regions(number))//'the groups '''// &
                  trim(regions(number)%group_name)//''' and '''//trim(other%group_name)//''' of two &region (lines '// &
                  whole(other%line)//' and '//whole(regions(number)%line)//') have '//whole(count(both))// &
                  ' elements in common, the first is '//whole(elements(i))//'; a &region without group has the '// &
                  'elements that no other region names.')
            end associate
            return
         end if
      end associate
      do i = 1, size(elements)
         if (region_of(elements(i)) == 0 .or. .not. scene%regions(number)%rest) region_of(elements(i)) = number
      end do
   end subroutine take_elements

   !> A law has a retention of its own, or the curve that the region names: never two. A rate of saturation by suction
   !> alone needs a curve.
   subroutine give_retention(scene, given, law, fault)
      type(scene_t), intent(in) :: scene
      type(scene_region_t), intent(in) :: given
      class(material_t), intent(inout) :: law
      type(fault_t), intent(inout) :: fault
      type(key_table_t) :: table
      logical :: asked
      integer :: k

      asked = any(given%retention_name == OF_THE_MATERIAL)
      if (law%has_retention .and. .not. asked) then
         call raise(fault, EXIT_INPUT, place_of(given)//'material '''//trim(given%material_name)//''' has a '// &
                    'retention of its own: say retention = ''material'', and give its parameters there (of &mud: '// &
                    'P_a, Omega, n_x, m_x, S_max, S_min).')
      else if (law%saturation_is_state .and. .not. scene%full_saturation_rate) then
         call raise(fault, EXIT_INPUT, place_of(given)//'saturation_rate = ''suction'' of &scene takes the rate of '// &
                    'saturation from a retention curve, but the saturation of material '''// &
                    trim(given%material_name)//''' is a state variable (hysteresis = 1 of &mud, saturation_at of '// &
                    '&umat): set saturation_rate = ''full''.')
      else if (asked .and. .not. law%has_retention) then
         call raise(fault, EXIT_INPUT, place_of(given)//'material '''//trim(given%material_name)//''' has no '// &
                    'retention of its own; name a &retention.')
      else if (.not. law%has_retention) then
         k = defined_name('retention', given%retention_name, scene%retentions%name, place_of(given), fault)
         if (fault%code /= 0) return
         table = reading(scene%retentions(k)%group)
         call new_retention(table, law%curve, fault)
      end if
   end subroutine give_retention
end module region_builder
