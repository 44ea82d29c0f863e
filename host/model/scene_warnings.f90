! SPDX-License-Identifier: MIT
!> Warnings about values of a scene that are allowed but usually mistakes: printed at the start and by --check, never
!> refused.
module scene_warnings
   use kinds, only: wp
   use faults, only: at_line
   use given_pressures, only: nodes_with_flow, edges_with_flow
   use idle_keys, only: list_idle_keys, add_warning, WARNING_LENGTH
   use initial_conditions, only: tension_t
   use key_schema, only: line_of
   use material_elastic, only: elastic_t
   use model_types, only: model_t, fix_t, PRESCRIBED_P_A
   use scene_types, only: scene_t, acts_in, place_of, LOAD_WATER, LOAD_AIR
   use stress_units, only: KILOPASCAL
   use texts, only: short, whole
   use triangle_mesh, only: mesh_t
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, FIELD_NAMES
   implicit none (type, external)
   private
   public :: list_warnings, WARNING_LENGTH

   real(wp), parameter :: SAME_PLACE = 1.0e-6_wp      !< Share of the mesh below which a point is a node.
   real(wp), parameter :: LARGE_MESH = 1.0e3_wp, SMALL_MESH = 1.0e-3_wp   !< [m]
   real(wp), parameter :: PERMEABLE = 1.0e-8_wp       !< [m2] Coarse gravel; above it a conductivity [m/s] is likely.
   real(wp), parameter :: ATMOSPHERE = 101.325_wp     !< [kPa]
   real(wp), parameter :: STIFF = 1.0e9_wp            !< [kPa] Five times steel; above it a modulus in Pa is likely.
   character(3), parameter :: WORDS(*) = [FIELD_NAMES, 'p_a']
contains
   !> All warnings about a scene, in the order of their kinds; empty if there are none. Raises no fault.
   subroutine list_warnings(scene, model, tension, warnings)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(tension_t), intent(in) :: tension   !< Of the initial state.
      character(WARNING_LENGTH), allocatable, intent(out) :: warnings(:)   !< (warnings)

      allocate (warnings(0))
      call look_at_sizes(scene, model, warnings)
      call look_at_materials(scene, model, warnings)
      call look_at_points(model, warnings)
      call look_at_initials(model, tension, warnings)
      call look_at_fixes(model, warnings)
      call look_at_retentions(scene, model, warnings)
      call look_at_places(model, warnings)
      call list_idle_keys(scene, warnings)
   end subroutine list_warnings

   !> Units of length, permeability and stiffness.
   subroutine look_at_sizes(scene, model, warnings)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      real(wp) :: size_of
      integer :: i

      size_of = extent(model%domain%mesh)
      if (size_of > LARGE_MESH .or. size_of < SMALL_MESH) call add_warning(place_of(scene%mesh)//'the mesh is '// &
         short(size_of)//' m large; lengths are in m.', warnings)
      do i = 1, size(scene%permeabilities)
         associate (group => scene%permeabilities(i)%group, k => model%domain%permeabilities(i)%intrinsic)
            if (k > PERMEABLE) call add_warning(at_line(group%file, line_of(group, 'intrinsic'))//'intrinsic = '// &
               short(k)//' m2 is more than coarse gravel has; a conductivity [m/s] is k rho_w g/eta_w, about 1e7 '// &
               'times the permeability k [m2].', warnings)
         end associate
      end do
      do i = 1, size(model%domain%regions)
         select type (law => model%domain%regions(i)%law)
         type is (elastic_t)
            if (law%young > STIFF) call add_warning(place_of(scene%regions(i))//'material '''// &
               trim(scene%regions(i)%material_name)//''' has young = '//short(law%young)//' kPa, more than any '// &
               'soil or metal; moduli are in kPa.', warnings)
         end select
      end do
   end subroutine look_at_sizes

   !> What laws say of their parameters, and laws in another unit of stress: each material once.
   subroutine look_at_materials(scene, model, warnings)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      integer :: i

      do i = 1, size(model%domain%regions)
         associate (given => scene%regions(i), law => model%domain%regions(i)%law)
            if (any(scene%regions(:i - 1)%material_name == given%material_name)) cycle
            if (law%doubt /= '') call add_warning(trim(law%doubt), warnings)
            if (law%unit%name /= KILOPASCAL%name) call add_warning(place_of(given)//'material '''// &
               trim(given%material_name)//''' has a p_atm of '//short(ATMOSPHERE*law%unit%factor)//'; scenes are '// &
               'in kPa, in which it is about '//short(ATMOSPHERE)//'.', warnings)
         end associate
      end do
   end subroutine look_at_materials

   !> Largest side of the box around the elements [m].
   pure real(wp) function extent(mesh)
      type(mesh_t), intent(in) :: mesh
      integer :: i

      extent = 0.0_wp
      do i = 1, 2
         associate (x => mesh%x(i, reshape(mesh%t6, [size(mesh%t6)])))
            extent = max(extent, maxval(x) - minval(x))
         end associate
      end do
   end function extent

   !> Points that are no nodes.
   subroutine look_at_points(model, warnings)
      type(model_t), intent(in) :: model
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      real(wp) :: near
      integer :: i

      near = SAME_PLACE*extent(model%domain%mesh)
      do i = 1, size(model%points)
         associate (point => model%points(i), node => model%domain%mesh%x(:, model%points(i)%node))
            if (norm2(point%x - node) <= near) cycle
            call add_warning('&point '//trim(point%name)//': '//at(point%x)//trim(merge('lies outside the mesh; ', &
               'is no node of the mesh;', .not. inside(model%domain%mesh, point%x)))//' its columns are those of '// &
               'the node at '//at(node)//'and of the quadrature point nearest to the point.', warnings)
         end associate
      end do
   contains
      pure function at(x) result(text)
         real(wp), intent(in) :: x(2)
         character(:), allocatable :: text

         text = '('//short(x(1))//', '//short(x(2))//') m '
      end function at
   end subroutine look_at_points

   !> Whether a place lies in an element, sides taken as straight.
   pure logical function inside(mesh, x)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: x(2)
      real(wp), parameter :: ON_THE_LINE = 1.0e-9_wp
      real(wp) :: corner(2, 3), area(3)
      integer :: e, k

      inside = .true.
      do e = 1, size(mesh%t6, 2)
         corner = mesh%x(:, mesh%t6(:3, e))
         do k = 1, 3
            area(k) = cross(corner(:, mod(k, 3) + 1) - corner(:, k), x - corner(:, k))
         end do
         if (all(area >= -ON_THE_LINE*sum(abs(area)))) return
      end do
      inside = .false.
   contains
      pure real(wp) function cross(a, b)
         real(wp), intent(in) :: a(2), b(2)

         cross = a(1)*b(2) - a(2)*b(1)
      end function cross
   end function inside

   subroutine look_at_initials(model, tension, warnings)
      type(model_t), intent(in) :: model
      type(tension_t), intent(in) :: tension
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      real(wp) :: top
      integer :: i

      if (tension%points > 0) call add_warning('The initial effective stress is tensile at '// &
         whole(tension%points)//' points of MUD, most at z = '//short(tension%z)//' m ('//short(tension%largest)// &
         ' kPa): sand carries none, and the material starts from what it can carry, without balance; correct '// &
         'p_w, surface or k_0 of &initial, or add a surcharge.', warnings)
      do i = 1, size(model%initials)
         associate (one => model%initials(i), group => model%domain%mesh%groups(model%initials(i)%group))
            if (.not. one%geostatic .or. size(group%nodes) == 0) cycle
            top = maxval(model%domain%mesh%x(2, group%nodes))
            if (one%surface < top - SAME_PLACE*extent(model%domain%mesh)) call add_warning(place_of(one)// &
               'surface = '//short(one%surface)//' m lies below the top of group '''//trim(one%group_name)// &
               ''' at '//short(top)//' m: above it the weight is negative.', warnings)
         end associate
      end do
   end subroutine look_at_initials

   !> Two that prescribe an unknown of a stage differently: the later one applies; and p_w, p_c and p_a all at once.
   subroutine look_at_fixes(model, warnings)
      type(model_t), intent(in) :: model
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      integer, allocatable :: by(:, :)
      integer :: i, j, s, n, node

      allocate (by(PRESCRIBED_P_A, size(model%domain%mesh%x, 2)))
      do i = 2, size(model%fixes)
         associate (one => model%fixes(i))
            before: do j = 1, i - 1
               if (model%fixes(j)%field /= one%field .or. .not. differ(model%fixes(j), one)) cycle
               if (model%fixes(j)%from >= one%until .or. one%from >= model%fixes(j)%until) cycle
               do s = 1, size(model%stages)
                  if (.not. (acts_in(one%stages, model%stages(s)%name) .and. &
                             acts_in(model%fixes(j)%stages, model%stages(s)%name))) cycle
                  associate (nodes => model%domain%mesh%groups(model%fixes(j)%group)%nodes)
                     n = findloc([(any(model%domain%mesh%groups(one%group)%nodes == nodes(node)), &
                                   node=1, size(nodes))], .true., dim=1)
                     if (n == 0) cycle before
                     call add_warning(place_of(one)//WORDS(one%field)//' of the node at ('// &
                        short(model%domain%mesh%x(1, nodes(n)))//', '//short(model%domain%mesh%x(2, nodes(n)))// &
                        ') m has two &fix in stage '//trim(model%stages(s)%name)//', of the groups '''// &
                        trim(model%fixes(j)%group_name)//''' and '''//trim(one%group_name)//''', with different '// &
                        'values; the later one counts.', warnings)
                  end associate
                  cycle before
               end do
            end do before
         end associate
      end do
      do s = 1, size(model%stages)
         by = 0
         do i = 1, size(model%fixes)
            if (model%fixes(i)%field > DISPLACEMENTS .and. acts_in(model%fixes(i)%stages, model%stages(s)%name)) &
               by(model%fixes(i)%field, model%domain%mesh%groups(model%fixes(i)%group)%nodes) = i
         end do
         node = findloc(all(by(AT_P_W:, :) > 0, dim=1), .true., dim=1)
         if (node > 0) call add_warning(place_of(model%fixes(maxval(by(:, node))))//'p_w, p_c and p_a of a node '// &
            'are all prescribed in stage '//trim(model%stages(s)%name)//'; p_a = p_w + p_c, so give two of them.', &
            warnings)
      end do
   contains
      pure logical function differ(a, b)
         type(fix_t), intent(in) :: a, b

         differ = (a%hold .neqv. b%hold) .or. a%amplitude /= b%amplitude .or. abs(a%value - b%value) > 0.0_wp .or. &
                  abs(a%value_slope - b%value_slope) > 0.0_wp .or. &
                  (abs(a%value_slope) > 0.0_wp .and. abs(a%datum - b%datum) > 0.0_wp)
         if (a%hold .and. b%hold) differ = .false.
      end function differ
   end subroutine look_at_fixes

   !> Supports of pressures and inflows that act on a part of their group alone.
   subroutine look_at_places(model, warnings)
      type(model_t), intent(in) :: model
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      logical :: flows(size(model%domain%mesh%x, 2))
      integer :: i

      flows = nodes_with_flow(model%domain)
      do i = 1, size(model%fixes)
         associate (one => model%fixes(i), nodes => model%domain%mesh%groups(model%fixes(i)%group)%nodes)
            if (one%field > DISPLACEMENTS .and. .not. all(flows(nodes))) call add_warning(place_of(one)// &
               trim(WORDS(one%field))//' is prescribed on '//whole(count(flows(nodes)))//' of the '// &
               whole(size(nodes))//' nodes of '''//trim(one%group_name)//''': the others lie in no region with '// &
               'drainage = ''coupled''.', warnings)
         end associate
      end do
      do i = 1, size(model%loads)
         associate (one => model%loads(i))
            if (one%kind /= LOAD_WATER .and. one%kind /= LOAD_AIR) cycle
            associate (edges => edges_with_flow(model%domain, one%group))
               if (.not. all(edges)) call add_warning(place_of(one)//'fluid flows in through '//whole(count(edges))// &
                  ' of the '//whole(size(edges))//' edges of '''//trim(one%group_name)//''': the others belong to '// &
                  'no region with drainage = ''coupled''.', warnings)
            end associate
         end associate
      end do
   end subroutine look_at_places

   !> Names of curves that are not looked up because the scene has no suction.
   subroutine look_at_retentions(scene, model, warnings)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(WARNING_LENGTH), allocatable, intent(inout) :: warnings(:)
      integer :: i

      if (model%domain%with_c) return
      do i = 1, size(scene%regions)
         associate (region => scene%regions(i))
            if (any([character(8) :: '', 'material', 'mud'] == region%retention_name)) cycle
            if (any(scene%retentions%name == region%retention_name)) cycle
            call add_warning(place_of(region)//'no &retention is named '''//trim(region%retention_name)//'''; the '// &
                             'scene has no suction, which would refuse it.', warnings)
         end associate
      end do
   end subroutine look_at_retentions
end module scene_warnings
