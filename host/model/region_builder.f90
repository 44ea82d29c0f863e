!> Regions of a scene: which material, retention curve and relative permeability every element has.
module region_builder
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use exit_codes, only: EXIT_GROUP
   use fe_mud, only: mud_t
   use law_builder, only: build_material, build_retention, build_permeability, retention_of_mud
   use name_search, only: mesh_group, defined_name
   use porous_domain, only: domain_t, region_t
   use scene_types, only: scene_t, place_of, scene_region_t
   use texts, only: whole
   implicit none (type, external)
   private
   public :: build_regions
contains
   subroutine build_regions(scene, domain, fault)
      type(scene_t), intent(in) :: scene
      type(domain_t), intent(inout) :: domain
      type(fault_t), intent(inout) :: fault
      integer :: curves, i

      curves = size(scene%retentions)
      ! Room for the curve of a material in every region: lists of different laws cannot grow.
      allocate (domain%materials(size(scene%materials)), domain%retentions(curves + size(scene%regions)), &
                domain%permeabilities(size(scene%permeabilities)), domain%regions(size(scene%regions)))
      do i = 1, size(scene%materials)
         if (fault%code == 0) call build_material(scene%materials(i), domain%materials(i), fault)
      end do
      do i = 1, curves
         if (fault%code == 0) call build_retention(scene%retentions(i), domain%retentions(i), fault)
      end do
      do i = 1, size(scene%permeabilities)
         if (fault%code == 0) call build_permeability(scene%permeabilities(i), domain%permeabilities(i), fault)
      end do
      allocate (domain%region_of(size(domain%mesh%t6, 2)), source=0)
      do i = 1, size(scene%regions)
         if (fault%code == 0) call build_region(scene%regions(i), i, curves + i, domain, fault)
      end do
      if (fault%code /= 0 .or. all(domain%region_of > 0)) return
      call raise(fault, EXIT_GROUP, trim(scene%file)//': element '//whole(findloc(domain%region_of, 0, dim=1))// &
                 ' belongs to no &region; add one with its group, or with group = ''all''.')
   end subroutine build_regions

   subroutine build_region(given, number, own_curve, domain, fault)
      type(scene_region_t), intent(in) :: given
      integer, intent(in) :: number      !< Of the region.
      integer, intent(in) :: own_curve   !< Place for the retention curve of its material.
      type(domain_t), intent(inout) :: domain
      type(fault_t), intent(inout) :: fault
      type(region_t) :: region
      integer :: group

      group = mesh_group(domain%mesh, given%group_name, place_of(given), fault)
      if (fault%code == 0) region%material = defined_name('material', given%material_name, domain%materials%name, &
                                                          place_of(given), fault)
      if (fault%code /= 0) return
      region%rho_s = given%rho_s
      region%damping = given%damping
      region%void_ratio = given%void_ratio
      if (given%void_ratio < 0.0_wp) region%void_ratio = domain%materials(region%material)%law%initial_void_ratio()
      if (domain%with_w .and. .not. region%void_ratio > 0.0_wp) call raise(fault, EXIT_INPUT, place_of(given)// &
         'the region needs a void_ratio: its pores hold the fluids.')
      if (domain%with_w .and. fault%code == 0) region%permeability = defined_name('permeability', &
         given%permeability_name, domain%permeabilities%name, place_of(given), fault)
      if (domain%with_c .and. fault%code == 0) then
         if (given%retention_name == 'mud') then
            region%retention = own_curve
            select type (law => domain%materials(region%material)%law)
            type is (mud_t)
               call retention_of_mud(law, domain%retentions(own_curve))
            class default
               call raise(fault, EXIT_INPUT, place_of(given)//'retention = ''mud'' needs a &mud material.')
            end select
         else
            region%retention = defined_name('retention', given%retention_name, &
                                            domain%retentions(:own_curve - number)%name, place_of(given), fault)
         end if
      end if
      if (fault%code /= 0) return
      domain%regions(number) = region
      domain%region_of(domain%mesh%groups(group)%elements) = number
   end subroutine build_region
end module region_builder
