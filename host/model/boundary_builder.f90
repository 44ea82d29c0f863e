! SPDX-License-Identifier: MIT
!> Supports, loads, initial conditions, plates and contacts of a scene, with the groups of the mesh that they name.
module boundary_builder
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use exit_codes, only: EXIT_GROUP
   use model_types, only: model_t, action_t, gravity_at, initial_t, fix_t, load_t, plate_t, &
                          coordinate_t, contact_pair_t, tie_t
   use name_search, only: mesh_group, defined_name
   use scene_parts, only: initial_values_t, acts_in, place_of, LOAD_PRESSURE, LOAD_WATER, LOAD_RAIN, LOAD_AIR, &
                          LOAD_FORCE_R
   use scene_types, only: scene_t, scene_fix_t, scene_load_t, scene_plate_t, scene_contact_t, scene_tie_t
   use texts, only: short, whole
   use triangle_mesh, only: find_group, add_group
   use unknown_fields, only: FIELD_NAMES, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: build_plates, build_boundaries, add_body

   character(3), parameter :: WORD_OF(*) = [FIELD_NAMES, 'p_a']
contains
   !> Plates come first: those with a face of their own become nodes of the mesh, and all become groups of it.
   !> docs/theory/host.md section 7.3. Fault EXIT_GROUP: the name is that of a group of the mesh, the boundary or
   !> history of a plate does not exist, or two boundaries share a node.
   subroutine build_plates(scene, model, fault)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      allocate (model%domain%bodies(0), model%domain%bodies_along_r(0))
      allocate (model%plates(size(scene%plates)))
      do i = 1, size(scene%plates)
         call build_plate(scene%plates(i), model, model%plates(i), fault)
         if (fault%code == 0) call check_apart(model, i, fault)
         if (fault%code /= 0) return
      end do
   end subroutine build_plates

   !> Joined plates that share a node would be one body, which has one mass. Fault EXIT_GROUP: a plate shares a node
   !> with one before it.
   subroutine check_apart(model, last, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: last   !< Of the plates, the first ones are built.
      type(fault_t), intent(inout) :: fault
      integer :: i, k

      if (model%plates(last)%group == 0) return
      associate (groups => model%domain%mesh%groups, plate => model%plates(last))
         do i = 1, last - 1
            if (model%plates(i)%group == 0) cycle
            associate (other => groups(model%plates(i)%group), own => groups(plate%group))
               do k = 1, size(own%nodes)
                  if (.not. any(other%nodes == own%nodes(k))) cycle
                  call raise(fault, EXIT_GROUP, place_of(plate)//'its boundary '''//trim(own%name)// &
                             ''' shares node '//whole(own%nodes(k))//' with that of the plate '''// &
                             trim(model%plates(i)%name)//''': they would be one body; give one plate, on a group '// &
                             'that has both.')
                  return
               end do
            end associate
         end do
      end associate
   end subroutine check_apart

   !> Fault EXIT_GROUP: see build_plates.
   subroutine build_plate(given, model, plate, fault)
      type(scene_plate_t), intent(in) :: given
      type(model_t), intent(inout) :: model
      type(plate_t), intent(inout) :: plate
      type(fault_t), intent(inout) :: fault
      integer :: none(3, 0)

      plate%plate_values_t = given%plate_values_t
      plate%amplitude = amplitude_of(given%amplitude_name, place_of(plate), model, fault)
      if (fault%code /= 0) return
      associate (mesh => model%domain%mesh)
         if (find_group(mesh, trim(plate%name)) > 0) then
            call raise(fault, EXIT_GROUP, place_of(plate)//'the mesh has a group '''//trim(plate%name)// &
                       ''' already; give the plate another name.')
            return
         end if
         if (given%joined_name /= '') plate%group = mesh_group(mesh, given%joined_name, place_of(plate), fault)
         if (fault%code /= 0) return
         if (plate%group == 0) then
            call add_body(model, plate%corners(:, 1), plate%node, trim(plate%name))
         else
            plate%node = mesh%groups(plate%group)%nodes(1)
            call add_group(mesh, trim(plate%name), [integer ::], none, mesh%groups(plate%group)%nodes)
         end if
      end associate
      allocate (plate%motion)
      plate%coordinates = [coordinate_t(node=plate%node, mass=plate%mass, load=plate%force)]
   end subroutine build_plate

   !> A node of its own, and a group of it, if it is to have a name.
   subroutine add_body(model, x, node, name)
      type(model_t), intent(inout) :: model
      real(wp), intent(in) :: x(2)   !< [m]
      integer, intent(out) :: node
      character(*), intent(in), optional :: name
      integer :: none(3, 0)

      associate (mesh => model%domain%mesh)
         mesh%x = reshape([mesh%x, x], [2, size(mesh%x, 2) + 1])
         node = size(mesh%x, 2)
         if (present(name)) call add_group(mesh, name, [integer ::], none, [node])
      end associate
      model%domain%bodies = [model%domain%bodies, node]
   end subroutine add_body

   !> Initial conditions, supports, loads, contacts and ties of a scene; a fault names what cannot
   !> be resolved. Fault EXIT_GROUP: a group or history does not exist, or a group lacks the edges or nodes that are
   !> needed. Fault EXIT_INPUT: a field that the scene lacks, or keys that contradict each other.
   subroutine build_boundaries(scene, model, fault)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      model%gravity_amplitude = amplitude_of(scene%gravity_history, trim(scene%file)//': gravity_history of &scene: ', &
                                             model, fault)
      allocate (model%initials(size(scene%initials)), model%fixes(size(scene%fixes)), model%loads(size(scene%loads)), &
                model%contacts(size(scene%contacts)), model%ties(size(scene%ties)))
      do i = 1, size(scene%initials)
         if (fault%code == 0) call build_initial(scene%initials(i), model, model%initials(i), fault)
      end do
      do i = 1, size(scene%fixes)
         if (fault%code == 0) call build_fix(scene%fixes(i), model, model%fixes(i), fault)
      end do
      do i = 1, size(scene%loads)
         if (fault%code == 0) call build_load(scene%loads(i), model, model%loads(i), fault)
      end do
      do i = 1, size(scene%contacts)
         if (fault%code == 0) call build_contact(scene%contacts(i), model, model%contacts(i), fault)
      end do
      do i = 1, size(scene%ties)
         if (fault%code == 0) call build_tie(scene%ties(i), model, model%ties(i), fault)
      end do
      call list_actions(model)
   end subroutine build_boundaries

   !> What acts on groups of the mesh, for those who ask no more of it; terms add theirs.
   subroutine list_actions(model)
      type(model_t), intent(inout) :: model
      type(action_t) :: action   !< The one that is added: in an array constructor its own constructor would leak.
      integer :: i

      allocate (model%actions(0))
      do i = 1, size(model%loads)
         associate (one => model%loads(i))
            action = action_t(one%file, one%line, '&load', one%group, one%amplitude, one%stages, &
               along_normal=any(one%kind == [LOAD_PRESSURE, LOAD_RAIN]), bears=one%kind == LOAD_PRESSURE)
            model%actions = [model%actions, action]
         end associate
      end do
      do i = 1, size(model%fixes)
         associate (one => model%fixes(i))
            action = action_t(one%file, one%line, '&fix', one%group, merge(0, one%amplitude, one%hold), one%stages, &
                              one%from, supports=.true.)
            model%actions = [model%actions, action]
         end associate
      end do
      do i = 1, size(model%contacts)
         associate (one => model%contacts(i))
            action = action_t(one%file, one%line, '&contact', one%slave, 0, one%stages, along_normal=.true., &
                              bears=.true.)
            model%actions = [model%actions, action]
            if (one%plate > 0) cycle
            action = action_t(one%file, one%line, '&contact', one%master, 0, one%stages, along_normal=.true.)
            model%actions = [model%actions, action]
         end associate
      end do
      do i = 1, size(model%plates)
         associate (one => model%plates(i))
            action = action_t(one%file, one%line, '&plate', one%group, one%amplitude, bears=.true.)
            allocate (action%stages(0))
            model%actions = [model%actions, action]
         end associate
      end do
   end subroutine list_actions

   !> Place of an amplitude, 0 where none is named.
   integer function amplitude_of(name, place, model, fault) result(amplitude)
      character(*), intent(in) :: name, place
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault

      amplitude = 0
      if (name /= '') amplitude = defined_name('history', name, model%amplitudes%name, place, fault)
   end function amplitude_of

   subroutine build_initial(given, model, initial, fault)
      type(initial_values_t), intent(in) :: given
      type(model_t), intent(in) :: model
      type(initial_t), intent(inout) :: initial
      type(fault_t), intent(inout) :: fault

      initial%initial_values_t = given
      initial%group = mesh_group(model%domain%mesh, initial%group_name, place_of(initial), fault)
      if (initial%with_table) initial%water_weight = model%domain%fluids%rho_w*gravity_at(model, 0.0_wp)
   end subroutine build_initial

   subroutine build_fix(given, model, fix, fault)
      type(scene_fix_t), intent(in) :: given
      type(model_t), intent(in) :: model
      type(fix_t), intent(inout) :: fix
      type(fault_t), intent(inout) :: fault

      fix%fix_values_t = given%fix_values_t
      fix%group = mesh_group(model%domain%mesh, fix%group_name, place_of(fix), fault)
      if (fault%code == 0) fix%amplitude = amplitude_of(given%amplitude_name, place_of(fix), model, fault)
      if (fault%code /= 0) return
      if (fix%acceleration .and. (fix%field >= AT_P_W .or. fix%hold .or. fix%amplitude == 0)) then
         call raise(fault, EXIT_INPUT, place_of(fix)//'motion = ''acceleration'' needs a displacement (u_r, '// &
                    'u_z), a history, and not hold = ''yes''.')
         return
      end if
      if ((fix%field == AT_P_W .and. .not. model%domain%with_w) .or. &
          (fix%field >= AT_P_C .and. .not. model%domain%with_c)) call raise(fault, EXIT_INPUT, &
         place_of(fix)//'the scene has no field '//WORD_OF(fix%field)//'; see fields in &scene.')
   end subroutine build_fix

   subroutine build_load(given, model, load, fault)
      type(scene_load_t), intent(in) :: given
      type(model_t), intent(in) :: model
      type(load_t), intent(inout) :: load
      type(fault_t), intent(inout) :: fault

      load%load_values_t = given%load_values_t
      load%group = mesh_group(model%domain%mesh, load%group_name, place_of(load), fault)
      if (fault%code == 0) load%amplitude = amplitude_of(given%amplitude_name, place_of(load), model, fault)
      if (fault%code /= 0) return
      if (load%kind < LOAD_FORCE_R .and. size(model%domain%mesh%groups(load%group)%edges, 2) == 0) then
         call raise(fault, EXIT_GROUP, place_of(load)//'group '''//trim(load%group_name)//''' has no edges to load.')
      else if ((any(load%kind == [LOAD_WATER, LOAD_RAIN]) .and. .not. model%domain%with_w) .or. &
               (load%kind == LOAD_AIR .and. .not. model%domain%with_c)) then
         call raise(fault, EXIT_INPUT, place_of(load)//'the scene has no field for such an inflow; see '// &
                    'fields in &scene.')
      end if
   end subroutine build_load

   subroutine build_contact(given, model, contact, fault)
      type(scene_contact_t), intent(in) :: given
      type(model_t), intent(in) :: model
      type(contact_pair_t), intent(inout) :: contact
      type(fault_t), intent(inout) :: fault
      integer :: i

      contact%contact_values_t = given%contact_values_t
      contact%slave = mesh_group(model%domain%mesh, given%slave_name, place_of(contact), fault)
      if (fault%code == 0) contact%master = mesh_group(model%domain%mesh, given%master_name, place_of(contact), fault)
      if (fault%code /= 0) return
      do i = 1, size(model%plates)
         if (model%plates(i)%name /= given%master_name) cycle
         ! A plate that is joined to a boundary has no other surface than this.
         if (model%plates(i)%group == 0) contact%plate = i
         if (model%plates(i)%group > 0) contact%master = model%plates(i)%group
      end do
      associate (groups => model%domain%mesh%groups)
         if (contact%slave == contact%master) then
            call raise(fault, EXIT_GROUP, place_of(contact)//'slave and master are one boundary, '''// &
                       trim(given%slave_name)//'''; name the two that meet.')
            return
         else if (size(groups(contact%slave)%edges, 2) == 0 .or. &
                  (contact%plate == 0 .and. size(groups(contact%master)%edges, 2) == 0)) then
            call raise(fault, EXIT_GROUP, place_of(contact)//'slave and master need edges: a boundary of the mesh '// &
                       '(the master may be a plate).')
            return
         end if
      end associate
      do i = 1, size(model%stages)
         if (model%stages(i)%zero_displacements .and. acts_in(contact%stages, model%stages(i)%name)) then
            call raise(fault, EXIT_INPUT, place_of(contact)//'stage '''//trim(model%stages(i)%name)// &
                       ''' zeroes its displacements, which would undo the contact; name the stages of the contact.')
            return
         end if
      end do
   end subroutine build_contact

   !> Pairs of nodes at equal heights.
   subroutine build_tie(given, model, tie, fault)
      type(scene_tie_t), intent(in) :: given
      type(model_t), intent(in) :: model
      type(tie_t), intent(inout) :: tie
      type(fault_t), intent(inout) :: fault
      integer :: first, second, i, k
      real(wp), parameter :: SAME_HEIGHT = 1.0e-6_wp   !< Share of the height of the boundary.
      real(wp) :: near

      tie%pressures = given%pressures
      second = 0
      first = mesh_group(model%domain%mesh, given%first_name, place_of(given), fault)
      if (fault%code == 0) second = mesh_group(model%domain%mesh, given%second_name, place_of(given), fault)
      if (fault%code /= 0) return
      associate (a => model%domain%mesh%groups(first)%nodes, b => model%domain%mesh%groups(second)%nodes, &
                 z => model%domain%mesh%x(2, :))
         if (first == second .or. size(a) /= size(b)) then
            call raise(fault, EXIT_GROUP, place_of(given)//'''' //trim(given%first_name)//''' has '//whole(size(a))// &
                       ' nodes and '''//trim(given%second_name)//''' '//whole(size(b))//'; a tie needs two '// &
                       'boundaries with as many nodes, at the same heights.')
            return
         end if
         near = SAME_HEIGHT*(maxval(z(a)) - minval(z(a)))
         allocate (tie%pairs(2, size(a)))
         do i = 1, size(a)
            k = minloc(abs(z(b) - z(a(i))), dim=1)
            if (abs(z(b(k)) - z(a(i))) > near .or. any(tie%pairs(2, :i - 1) == b(k))) then
               call raise(fault, EXIT_GROUP, place_of(given)//'no node of '''//trim(given%second_name)//''' lies '// &
                          'at the height '//short(z(a(i)))//' m of '''//trim(given%first_name)//'''.')
               return
            end if
            tie%pairs(:, i) = [a(i), b(k)]
         end do
      end associate
   end subroutine build_tie
end module boundary_builder
