! SPDX-License-Identifier: MIT
!> Warnings about values of a scene that are allowed but usually mistakes: printed at the start and by --check, never
!> refused.
module scene_warnings
   use kinds, only: wp
   use faults, only: at_line
   use boundary_warnings, only: warn_of_boundaries
   use idle_keys, only: warn_of_idle_keys
   use warnings, only: print_warning
   use start_findings, only: tension_t, balance_t
   use key_schema, only: given, line_of, get_number
   use material_point, only: untested
   use model_types, only: model_t
   use namelists, only: group_t
   use porous_domain, only: UNDRAINED
   use scene_parts, only: place_of
   use scene_types, only: scene_t, groups_named, item_of
   use start_look, only: warn_of_start
   use stress_units, only: KILOPASCAL
   use texts, only: place_text, short, whole
   use triangle_mesh, only: mesh_t, sides_of, triangles_beside
   implicit none (type, external)
   private
   public :: warn_of_scene

   real(wp), parameter :: SAME_PLACE = 1.0e-6_wp      !< Share of the mesh: nearer points are at one place.
   real(wp), parameter :: LARGE_MESH = 1.0e3_wp, SMALL_MESH = 1.0e-3_wp   !< [m]
   real(wp), parameter :: LARGE_FILE = 100.0_wp       !< [m] Of a mesh from a file, which may well be drawn in mm.
   real(wp), parameter :: ATMOSPHERE = 101.325_wp     !< [kPa]
   real(wp), parameter :: FEW = 0.1_wp                !< Share of the points of a region.

   !> Values of keys that suggest another unit: below `lower`, or above `upper` and below `beyond`.
   type :: usual_t
      character(9) :: key
      real(wp) :: lower, upper, beyond
      character(100) :: say
   end type usual_t

   real(wp), parameter :: FAR = huge(1.0_wp)
   real(wp), parameter :: RIGID = 1.0e11_wp   !< [kPa] So stiff a water is meant to be incompressible.
   ! Densities may be a third of mercury's, those of grains more than lead's; viscosities hundreds of times that of
   ! water, as in a centrifuge; moduli five times that of steel.
   type(usual_t), parameter :: USUAL(*) = [ &
      usual_t('k_w', 10.0_wp, 1.0e7_wp, RIGID, 'a bulk modulus in kPa (water 2.2e6)'), &
      usual_t('rho_w', 0.0_wp, 5.0_wp, FAR, 'a density in Mg/m3 (water 1)'), &
      usual_t('eta_w', 0.0_wp, 5.0e-4_wp, FAR, 'a viscosity in kPa s (water 1e-6)'), &
      usual_t('k_a', 10.0_wp, 1.0e4_wp, RIGID, 'a bulk modulus in kPa (air 101.325)'), &
      usual_t('rho_a', 0.0_wp, 0.1_wp, FAR, 'a density in Mg/m3 (air 1.2e-3)'), &
      usual_t('eta_a', 0.0_wp, 1.0e-6_wp, FAR, 'a viscosity in kPa s (air 1.8e-8)'), &
      usual_t('p_ref', 10.0_wp, 1.0e4_wp, FAR, 'an absolute pressure in kPa (101.325)'), &
      usual_t('rho_s', 0.0_wp, 20.0_wp, FAR, 'a density in Mg/m3 (quartz 2.65)'), &
      usual_t('young', 0.0_wp, 1.0e9_wp, FAR, 'a modulus in kPa (steel 2.1e8)'), &
      usual_t('intrinsic', 0.0_wp, 1.0e-8_wp, FAR, 'a permeability k in m2 (coarse gravel 1e-8); a '// &
              'conductivity [m/s] is k rho_w g/eta_w, about 1e7 k')]
contains
   !> Prints all warnings about a scene, in the order of their kinds.
   subroutine warn_of_scene(scene, model, tension, balance)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(tension_t), intent(in) :: tension   !< Of the initial state.
      type(balance_t), intent(in) :: balance   !< Likewise.

      call look_at_sizes(scene, model)
      call look_at_slits(model)
      call look_at_units(scene)
      call look_at_regions(model, tension)
      call look_at_initials(model, tension)
      call look_at_doubled_contacts(model)
      call warn_of_start(model, balance)
      call warn_of_boundaries(model)
      call warn_of_idle_keys(scene, model)
   end subroutine warn_of_scene

   !> Warns of sizes that suggest another unit of length.
   subroutine look_at_sizes(scene, model)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(*), parameter :: REMEDY = ' scale = 1e-3 of &mesh reads millimetres, scale = 1 metres.'
      type(group_t), allocatable :: groups(:)
      real(wp) :: size_of

      allocate (groups, source=groups_named(scene, 'mesh'))
      size_of = extent(model%domain%mesh)
      associate (from_file => given(groups(1), 'file'))
         if (size_of < SMALL_MESH .or. size_of > merge(LARGE_FILE, LARGE_MESH, from_file .and. &
             .not. given(groups(1), 'scale'))) call print_warning(place_of(item_of(groups(1)))//'the mesh is '// &
            short(size_of)//' m large; lengths are in m.'//REMEDY(:merge(len(REMEDY), 0, from_file)))
      end associate
   end subroutine look_at_sizes

   !> Keys that seem to have another unit.
   subroutine look_at_units(scene)
      type(scene_t), intent(in) :: scene
      real(wp) :: value
      logical :: found
      integer :: g, k

      do g = 1, size(scene%as_read)
         associate (group => scene%as_read(g))
            if (all(group%name /= [character(12) :: 'fluids', 'region', 'elastic', 'permeability'])) cycle
            do k = 1, size(USUAL)
               call get_number(group, trim(USUAL(k)%key), value, found)
               if (.not. found) cycle
               if (value >= USUAL(k)%lower .and. (value <= USUAL(k)%upper .or. value >= USUAL(k)%beyond)) cycle
               call print_warning(at_line(group%file, line_of(group, trim(USUAL(k)%key)))//trim(USUAL(k)%key)//' = '// &
                  short(value)//' of &'//trim(group%name)//' is unusual for '//trim(USUAL(k)%say)//'; scenes are '// &
                  'in m, s, kPa and Mg.')
            end do
         end associate
      end do
   end subroutine look_at_units

   !> Regions without an element, or whose law is used outside the tests behind it, where a few points at low
   !> stress, as below a surface, are none. What laws say of their parameters, and laws in another unit of stress: each
   !> material once.
   subroutine look_at_regions(model, tension)
      type(model_t), intent(in) :: model
      type(tension_t), intent(in) :: tension
      character(:), allocatable :: place
      integer :: i

      do i = 1, size(model%regions)
         associate (given => model%regions(i), law => model%domain%regions(i)%law, used => tension%uses(i))
            place = place_of(given)//'material '''//trim(given%material_name)//''''
            if (.not. any(model%domain%region_of == i)) call print_warning(place_of(given)//'the region '''// &
               trim(given%group_name)//''' has no element'//trim(merge(': other regions name them all.', &
                                                                       '.                             ', given%rest)))
            if (used%outside_e > 0 .or. used%outside_p > FEW*used%points) call print_warning(place//' begins '// &
               'outside what it was fitted to at '//whole(max(used%outside_e, used%outside_p))//' of '// &
               whole(used%points)//' points: '//untested(law, used%e, used%p)//'.')
            if (model%domain%regions(i)%drainage == UNDRAINED .and. .not. any(model%stages%has_rates)) &
               call print_warning(place_of(given)//'the region '''//trim(given%group_name)//''' keeps its fluids '// &
                                  '(drainage = ''undrained''), but every stage is static, where pressures stay: it '// &
                                  'answers as drained ground; analysis = ''quasi_static'' of &stage lets them rise.')
            if (any(model%regions(:i - 1)%material_name == given%material_name)) cycle
            if (law%doubt /= '') call print_warning(trim(law%doubt))
            if (law%unit%name /= KILOPASCAL%name) call print_warning(place//' has a p_atm of '// &
               short(ATMOSPHERE*law%unit%factor)//'; scenes are in kPa, in which it is about '//short(ATMOSPHERE)//'.')
         end associate
      end do
   end subroutine look_at_regions

   !> Measures the largest side of the box around the elements [m].
   pure real(wp) function extent(mesh)
      type(mesh_t), intent(in) :: mesh

      associate (x => mesh%x(:, [mesh%t6]))
         extent = maxval(maxval(x, dim=2) - minval(x, dim=2))
      end associate
   end function extent

   subroutine look_at_initials(model, tension)
      type(model_t), intent(in) :: model
      type(tension_t), intent(in) :: tension
      real(wp) :: top
      integer :: i

      call look_at_replaced_initials(model)
      if (tension%points > 0) call print_warning('The initial effective stress is tensile at '// &
         whole(tension%points)//' points of MUD, most at z = '//short(tension%z)//' m ('//short(tension%largest)// &
         ' kPa): sand carries none, and the material starts from what it can carry, without balance; correct '// &
         'p_w, surface or k_0 of &initial, or add a surcharge.')
      if (tension%bare > 0) call print_warning(whole(tension%bare)//' points of MUD begin without effective '// &
         'stress: sand has no stiffness there, and what the first step finds is arbitrary; give '// &
         'stress = ''geostatic'' or ''uniform'' in &initial.')
      do i = 1, size(model%initials)
         associate (one => model%initials(i), group => model%domain%mesh%groups(model%initials(i)%group))
            if (.not. one%geostatic .or. one%follows .or. size(group%nodes) == 0) cycle
            top = maxval(model%domain%mesh%x(2, group%nodes))
            if (one%surface < top - SAME_PLACE*extent(model%domain%mesh)) call print_warning(place_of(one)// &
               'surface = '//short(one%surface)//' m lies below the top of group '''//trim(one%group_name)// &
               ''' at '//short(top)//' m: above it the weight is negative.')
         end associate
      end do
   end subroutine look_at_initials

   !> Warns of an &initial of whose nodes and elements later ones have every one: keys of two do not add up.
   subroutine look_at_replaced_initials(model)
      type(model_t), intent(in) :: model
      logical :: nodes(size(model%domain%mesh%x, 2)), elements(size(model%domain%region_of))
      integer :: i

      nodes = .false.
      elements = .false.
      do i = size(model%initials), 1, -1
         associate (one => model%initials(i), group => model%domain%mesh%groups(model%initials(i)%group))
            if (all(nodes(group%nodes)) .and. all(elements(group%elements))) call print_warning(place_of(one)// &
               'this &initial of group '''//trim(one%group_name)//''' has no effect: later ones have all of it, '// &
               'and of several the last one gives pressures, stress and velocity. Write them in one.')
            nodes(group%nodes) = .true.
            elements(group%elements) = .true.
         end associate
      end do
   end subroutine look_at_replaced_initials

   !> Warns of two contacts of the same two boundaries in one stage, in either order.
   subroutine look_at_doubled_contacts(model)
      type(model_t), intent(in) :: model
      integer :: i, k

      do i = 2, size(model%contacts)
         associate (one => model%contacts(i))
            do k = 1, i - 1
               associate (other => model%contacts(k))
                  if (.not. any(one%in_stage .and. other%in_stage)) cycle
                  if (min(one%slave, one%master) /= min(other%slave, other%master)) cycle
                  if (max(one%slave, one%master) /= max(other%slave, other%master)) cycle
                  call print_warning(place_of(one)//'the contact '''//trim(one%name)//''' has the two boundaries '// &
                     'of '''//trim(other%name)//''' in line '//whole(other%line)//': where both act their '// &
                     'penalties add. One is enough, unless each has stages of its own.')
               end associate
            end do
         end associate
      end do
   end subroutine look_at_doubled_contacts

   !> Warns of boundary nodes at one place that no contact, tie or plate joins.
   subroutine look_at_slits(model)
      type(model_t), intent(in) :: model
      integer :: sides(3, 3*size(model%domain%mesh%t6, 2))
      logical :: outside(size(model%domain%mesh%x, 2))
      integer, allocatable :: outer(:)
      real(wp) :: near
      integer :: i, k, pairs, first

      ! Nodes on sides that one triangle alone has.
      sides = sides_of(model%domain%mesh%t6)
      outside = .false.
      outside(pack(sides, spread(any(triangles_beside(model%domain%mesh%t6, sides) == 0, dim=1), 1, 3))) = .true.
      outer = pack([(i, i=1, size(outside))], outside)
      pairs = 0
      first = 0
      associate (x => model%domain%mesh%x)
         near = SAME_PLACE*maxval([(maxval(x(i, outer)) - minval(x(i, outer)), i=1, 2)])
         do i = 2, size(outer)
            do k = 1, i - 1
               if (abs(x(1, outer(i)) - x(1, outer(k))) > near) cycle
               if (abs(x(2, outer(i)) - x(2, outer(k))) > near) cycle
               if (are_joined(model, outer(i), outer(k))) cycle
               if (first == 0) first = outer(i)
               pairs = pairs + 1
            end do
         end do
         if (pairs > 0) call print_warning('The mesh has '//whole(pairs)//' pairs of boundary nodes at one place '// &
            'that nothing joins, the first at '//place_text(x(:, first))//': the ground '// &
            'is slit there. Merge them (Coherence in Gmsh, or gmsh.model.mesh.removeDuplicateNodes()), or give a '// &
            '&contact or &tie between the two sides.')
      end associate
   end subroutine look_at_slits

   pure logical function are_joined(model, a, b)
      type(model_t), intent(in) :: model
      integer, intent(in) :: a, b   !< Nodes.
      integer :: i

      are_joined = .true.
      associate (groups => model%domain%mesh%groups)
         do i = 1, size(model%contacts)
            associate (slave => groups(model%contacts(i)%slave)%nodes, master => groups(model%contacts(i)%master)%nodes)
               if (any(slave == a) .and. any(master == b)) return
               if (any(slave == b) .and. any(master == a)) return
            end associate
         end do
         do i = 1, size(model%ties)
            associate (one => model%ties(i)%pairs(1, :), other => model%ties(i)%pairs(2, :))
               if (any((one == a .and. other == b) .or. (one == b .and. other == a))) return
            end associate
         end do
         do i = 1, size(model%plates)
            if (model%plates(i)%group == 0) cycle
            associate (nodes => groups(model%plates(i)%group)%nodes)
               if (any(nodes == a) .and. any(nodes == b)) return
            end associate
         end do
      end associate
      are_joined = .false.
   end function are_joined
end module scene_warnings
