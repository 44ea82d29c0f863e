! SPDX-License-Identifier: MIT
!> What acts on the mesh: &plate, &initial, &fix, &load, &contact and &tie of a scene, with the groups of the mesh that
!> they name.
module boundary_builder
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use exit_codes, only: EXIT_GROUP
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use model_types, only: model_t, acting_t, gravity_at, initial_t, fix_t, load_t, plate_t, coordinate_t, &
                          contact_pair_t, tie_t
   use name_search, only: mesh_group, history_named, read_stages
   use scene_parts, only: place_of, LOAD_PRESSURE, LOAD_WATER, LOAD_RAIN, LOAD_AIR, LOAD_FORCE_R, &
                          LOAD_FORCE_Z, LOAD_OF_BODY, PRESCRIBED_WORDS, PRESCRIBED_OF_BODY
   use scene_types, only: item_of
   use texts, only: short, whole, LENGTH
   use triangle_mesh, only: find_group, add_group
   use unknown_fields, only: AT_U_Z, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: build_plate, build_initial, build_fix, build_load, build_contact, build_tie, add_body

   real(wp), parameter :: BIG = UNBOUNDED, TINY_ = 1.0e-30_wp, ZERO = 0.0_wp, ONE = 1.0_wp
contains
   !> Builds a &plate before what acts on it: one with a face of its own becomes a node of the mesh, each becomes a
   !> group of it. docs/theory/host.md section 7.3. Fault EXIT_INPUT: keys that contradict each other. EXIT_GROUP: the
   !> name is that of a group of the mesh, its boundary or history does not exist, or its boundary shares a node with
   !> another.
   subroutine build_plate(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(plate_t) :: plate
      character(LENGTH) :: joined_name, history
      real(wp), allocatable :: r(:), outline(:)
      real(wp) :: z
      logical :: up, good
      integer :: s

      joined_name = ''
      history = ''
      z = 0.0_wp
      up = .false.
      call k%text('name', plate%name, 'rigid plate or foundation; also a group for &fix and &load', REQUIRED)
      call k%numbers('r', r, -BIG, BIG, 'begin and end of its own flat face [m]; or outline, or group')
      call k%text('group', joined_name, 'boundary of the mesh that moves with the plate; or r, or outline')
      call k%number('z', z, -BIG, BIG, 'height of the plate''s own face at the start [m]', '+r')
      call k%flag('face', up, 'down|up', 'up', 'direction of the plate''s own face', '+r')
      call k%numbers('outline', outline, -BIG, BIG, &
                     'corners r, z, r, z, ... of its own face, the plate on the left; or r [m]', 'motion=plane')
      call k%number('mass', plate%mass, TINY_, BIG, 'mass of the plate [Mg]', REQUIRED)
      call k%flag('weight', plate%heavy, 'no|yes', 'yes', &
                  'the weight acts, and the plate starts in balance on its contact', ':gravity')
      call k%number('force', plate%force, -BIG, BIG, 'force on the plate, upwards [kN]')
      call k%text('history', history, 'factor on the forces', '+force|force_r|moment', refers='history')
      if (k%lists) return
      plate%scene_item_t = item_of(k%group)
      plate%what = '&plate'
      plate%bears = .true.
      plate%in_stage = [(.true., s=1, size(model%stages))]
      if (count([k%given('group'), k%given('r'), k%given('outline')]) /= 1) then
         call raise(fault, EXIT_INPUT, place_of(plate)//'a plate has a face of its own, r = begin, end (in the '// &
                    'plane also outline), or it is joined to a boundary, group = name: give one of the two.')
      else if (k%given('outline') .and. (size(outline) < 4 .or. mod(size(outline), 2) == 1)) then
         call raise(fault, EXIT_INPUT, place_of(plate)//'outline = r, z, r, z, ... are two corners or more.')
      else if (k%given('r')) then
         if (size(r) == 2) plate%corners = reshape([r(1), z, r(2), z], [2, 2])
         good = allocated(plate%corners)
         if (good) good = r(2) > r(1) .and. .not. (model%domain%axisymmetric .and. r(1) < ZERO)
         if (good .and. up) plate%corners = plate%corners(:, [2, 1])
         if (.not. good) call raise(fault, EXIT_INPUT, place_of(plate)//'a plate needs r = begin, end, ascending '// &
                                    'and, in axial symmetry, not negative.')
      else if (k%given('outline')) then
         plate%corners = reshape(outline, [2, size(outline)/2])
      end if
      if (fault%code /= 0) return
      plate%amplitude = history_named(history, model%amplitudes%name, place_of(plate), fault)
      if (fault%code /= 0) return
      associate (mesh => model%domain%mesh)
         if (find_group(mesh, trim(plate%name)) > 0) then
            call raise(fault, EXIT_GROUP, place_of(plate)//'the mesh has a group '''//trim(plate%name)// &
                       ''' already; give the plate another name.')
            return
         end if
         if (joined_name /= '') plate%group = mesh_group(mesh, joined_name, place_of(plate), fault)
         if (fault%code /= 0) return
         if (plate%group == 0) then
            call add_body(model, plate%corners(:, 1), plate%node, trim(plate%name))
         else
            plate%node = mesh%groups(plate%group)%nodes(1)
            call add_group(mesh, trim(plate%name), nodes=mesh%groups(plate%group)%nodes)
         end if
      end associate
      allocate (plate%motion)
      plate%coordinates = [coordinate_t(node=plate%node, mass=plate%mass, load=plate%force)]
      call check_apart(model, plate, fault)
      model%plates = [model%plates, plate]
      model%actions = [model%actions, plate%action_t]
   end subroutine build_plate

   !> Joined plates that share a node would be one body, which has one mass. Fault EXIT_GROUP: a plate shares a node
   !> with one of the model.
   subroutine check_apart(model, plate, fault)
      type(model_t), intent(in) :: model
      type(plate_t), intent(in) :: plate
      type(fault_t), intent(inout) :: fault
      integer :: i, k, n

      if (plate%group == 0) return
      do i = 1, size(model%plates)
         if (model%plates(i)%group == 0) cycle
         associate (other => model%domain%mesh%groups(model%plates(i)%group)%nodes, &
                    own => model%domain%mesh%groups(plate%group))
            k = findloc([(any(other == own%nodes(n)), n=1, size(own%nodes))], .true., dim=1)
            if (k == 0) cycle
            call raise(fault, EXIT_GROUP, place_of(plate)//'its boundary '''//trim(own%name)//''' shares node '// &
                       whole(own%nodes(k))//' with that of the plate '''//trim(model%plates(i)%name)//''': they '// &
                       'would be one body; give one plate, on a group that has both.')
            return
         end associate
      end do
   end subroutine check_apart

   !> Adds a node for a body, and a group of it, if it is to have a name.
   subroutine add_body(model, x, node, name)
      type(model_t), intent(inout) :: model
      real(wp), intent(in) :: x(2)   !< [m]
      integer, intent(out) :: node
      character(*), intent(in), optional :: name

      associate (mesh => model%domain%mesh)
         mesh%x = reshape([mesh%x, x], [2, size(mesh%x, 2) + 1])
         node = size(mesh%x, 2)
         if (present(name)) call add_group(mesh, name, nodes=[node])
      end associate
      model%domain%bodies = [model%domain%bodies, node]
   end subroutine add_body

   !> Builds an &initial. Fault EXIT_INPUT: keys that contradict each other; EXIT_GROUP: its group does not exist.
   subroutine build_initial(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(initial_t) :: initial
      real(wp), allocatable :: sigma(:)
      integer :: stress

      call k%text('group', initial%group_name, 'group of elements or nodes')
      call k%number('p_w', initial%p_w, -BIG, BIG, 'pore water pressure at the datum [kPa]', ':p_w')
      call k%number('p_w_slope', initial%p_w_slope, -BIG, BIG, 'change of p_w with z [kPa/m]', ':p_w')
      call k%number('p_c', initial%p_c, -BIG, BIG, 'suction at the datum [kPa]', ':p_c')
      call k%number('p_c_slope', initial%p_c_slope, -BIG, BIG, 'change of p_c with z [kPa/m]', ':p_c')
      call k%number('water_table', initial%water_table, -BIG, BIG, &
                    'instead of these: z of the water table; p_w of water at rest, p_c = -p_w [m]', ':p_w')
      call k%number('largest_suction', initial%largest_suction, TINY_, BIG, &
                    'above a water table p_c grows no further [kPa]', '+water_table')
      call k%number('saturation', initial%saturation, 1.0e-6_wp, ONE, &
                    'S_w between the main curves, with hysteresis [-]; default: on the main drying curve', ':p_c')
      call k%number('datum', initial%datum, -BIG, BIG, 'z of the datum [m]', &
                    '+p_w_slope|p_c_slope|wave')
      call k%number('v_z', initial%v_z, -BIG, BIG, 'vertical velocity at the start [m/s]', ':moving')
      call k%number('wave', initial%wave, -BIG, BIG, 'v_z = wave sin(wave_number (z - datum)) at the start [m/s]', &
                    '+wave_number :moving')
      call k%number('wave_number', initial%wave_number, ZERO, BIG, 'see wave [1/m]', '+wave')
      stress = 1
      call k%word('stress', stress, 'none|uniform|geostatic', 'effective stress at the start')
      call k%numbers('sigma', sigma, -BIG, BIG, 'uniform: rr, zz, tt, tension positive [kPa]', 'stress=uniform')
      call k%number('surface', initial%surface, -BIG, BIG, 'geostatic: z of the surface [m]', &
                    'stress=geostatic column=surface')
      call k%flag('column', initial%follows, 'surface|ground', 'ground', &
                  'geostatic: it ends at surface, or at the top of the ground above each point (slopes)', &
                  'stress=geostatic')
      call k%number('surcharge', initial%surcharge, ZERO, BIG, 'geostatic: pressure on it [kPa]', 'stress=geostatic')
      call k%number('k_0', initial%k_0, ZERO, 10*ONE, 'geostatic: horizontal over vertical stress', 'stress=geostatic')
      call k%flag('k_0_of', initial%net, 'net|effective', 'net', 'stress that K_0 acts on where p_c > 0', &
                  'stress=geostatic :p_c')
      if (k%lists) return
      initial%scene_item_t = item_of(k%group)
      initial%with_table = k%given('water_table')
      if (initial%with_table .and. k%given('p_w|p_w_slope|p_c|p_c_slope|datum')) then
         call raise(fault, EXIT_INPUT, place_of(initial)//'water_table gives p_w and p_c of water at rest; leave '// &
                    'out p_w, p_w_slope, p_c, p_c_slope and datum, or water_table.')
         return
      else if (initial%with_table .and. .not. model%domain%gravity > 0.0_wp) then
         call raise(fault, EXIT_INPUT, place_of(initial)//'water_table needs gravity in &scene: without it the '// &
                    'water has no weight, and no pressure that changes with z; give gravity = 9.81, or p_w and p_c.')
         return
      end if
      initial%uniform = stress == 2
      initial%geostatic = stress == 3
      if (initial%uniform .and. size(sigma) /= 3) then
         call raise(fault, EXIT_INPUT, place_of(initial)//'a uniform stress needs sigma = rr, zz, tt.')
      else if (initial%uniform) then
         initial%sigma = sigma
      end if
      if (fault%code == 0) initial%group = mesh_group(model%domain%mesh, initial%group_name, place_of(initial), fault)
      if (initial%with_table) initial%water_weight = model%domain%fluids%rho_w*gravity_at(model, 0.0_wp)
      model%initials = [model%initials, initial]
   end subroutine build_initial

   !> Builds a &fix. Fault EXIT_GROUP: its group or history does not exist. EXIT_INPUT: an acceleration of a pressure,
   !> or one that has no history or is held; a field that the scene lacks; an interval of time that is empty.
   subroutine build_fix(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(fix_t) :: fix
      character(LENGTH) :: history

      history = ''
      call k%text('group', fix%group_name, 'boundary, region or node group', REQUIRED)
      call k%word('field', fix%field, 'u_r|u_z|p_w|p_c|p_a|rotation', &
                  'what is prescribed; the rotation [-] of a &plate that moves in the plane', REQUIRED)
      fix%of_body = fix%field == PRESCRIBED_OF_BODY
      if (fix%of_body) fix%field = AT_U_Z
      call k%flag('kind', fix%limits, 'value|seepage', 'seepage', &
                  'seepage: p_w is at most the value; water may leave there, none enters', 'field=p_w')
      call k%number('value', fix%value, -BIG, BIG, 'prescribed value, at the datum [m, kPa]', 'hold=no')
      call k%number('value_slope', fix%value_slope, -BIG, BIG, 'change of the value with z [-, kPa/m]', 'hold=no')
      call k%number('datum', fix%datum, -BIG, BIG, 'z of the datum [m]', '+value_slope')
      call k%text('history', history, 'factor on the value', 'hold=no +value|value_slope', refers='history')
      call k%flag('hold', fix%hold, 'no|yes', 'yes', 'yes: held at its value at the start of the stage')
      call k%flag('motion', fix%acceleration, 'value|acceleration', 'acceleration', &
                  'what the value of u_r, u_z is: displacement, or acceleration [m/s2]')
      call read_stages(k, model, fix%in_stage)
      call k%number('from', fix%from, -BIG, BIG, 'acts after this time [s]')
      call k%number('until', fix%until, -BIG, BIG, 'acts up to this time [s]')
      if (k%lists) return
      call find_places(fix, k, history, model, fault)
      if (fault%code /= 0) return
      if (fix%acceleration .and. (fix%field >= AT_P_W .or. fix%hold .or. fix%amplitude == 0)) then
         call raise(fault, EXIT_INPUT, place_of(fix)//'motion = ''acceleration'' needs a displacement (u_r, '// &
                    'u_z), a history, and not hold = ''yes''.')
      else if ((fix%field == AT_P_W .and. .not. model%domain%with_w) .or. &
               (fix%field >= AT_P_C .and. .not. model%domain%with_c)) then
         call raise(fault, EXIT_INPUT, place_of(fix)//'the scene has no field '//PRESCRIBED_WORDS(fix%field)// &
                    '; see fields in &scene.')
      else if (.not. fix%until > fix%from) then
         call raise(fault, EXIT_INPUT, place_of(fix)//'from = '//short(fix%from)//' s and until = '// &
                    short(fix%until)//' s leave this &fix no time to act.')
      end if
      fix%what = '&fix'
      fix%supports = .true.
      if (fix%hold) fix%amplitude = 0
      model%fixes = [model%fixes, fix]
      model%actions = [model%actions, fix%action_t]
   end subroutine build_fix

   !> Builds a &load. Fault EXIT_GROUP: its group or history does not exist, or the group lacks edges. EXIT_INPUT: an
   !> inflow of a fluid that the scene lacks.
   subroutine build_load(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(load_t) :: load
      character(LENGTH) :: history

      history = ''
      call k%text('group', load%group_name, 'boundary (for force: node group)', REQUIRED)
      call k%word('kind', load%kind, 'pressure|shear_r|shear_z|water|rain|air|force_r|force_z|moment', &
                  'kind of load, see host/SCENE.md', REQUIRED)
      load%of_body = load%kind == LOAD_OF_BODY
      if (load%of_body) load%kind = LOAD_FORCE_Z
      load%falls = load%kind == LOAD_RAIN
      load%limits = load%falls
      if (load%falls) load%kind = LOAD_WATER
      load%flows = any(load%kind == [LOAD_WATER, LOAD_AIR])
      call k%number('value', load%value, -BIG, BIG, 'value of the load, at the datum [kPa, m/s, kN, kN m]', &
                    REQUIRED)
      call k%number('value_slope', load%value_slope, -BIG, BIG, 'change of the value with z [kPa/m, 1/s, kN/m]')
      call k%number('datum', load%datum, -BIG, BIG, 'z of the datum [m]', '+value_slope')
      call k%text('history', history, 'factor on the value', refers='history')
      call read_stages(k, model, load%in_stage)
      if (k%lists) return
      call find_places(load, k, history, model, fault)
      if (fault%code /= 0) return
      if (load%kind < LOAD_FORCE_R .and. size(model%domain%mesh%groups(load%group)%edges, 2) == 0) then
         call raise(fault, EXIT_GROUP, place_of(load)//'group '''//trim(load%group_name)//''' has no edges to load.')
      else if ((load%kind == LOAD_WATER .and. .not. model%domain%with_w) .or. &
               (load%kind == LOAD_AIR .and. .not. model%domain%with_c)) then
         call raise(fault, EXIT_INPUT, place_of(load)//'the scene has no field for such an inflow; see '// &
                    'fields in &scene.')
      end if
      load%what = '&load'
      load%along_normal = load%kind == LOAD_PRESSURE .or. load%falls
      load%bears = load%kind == LOAD_PRESSURE
      model%loads = [model%loads, load]
      model%actions = [model%actions, load%action_t]
   end subroutine build_load

   !> Where something stands, and the group of the mesh and the history that it names. Fault EXIT_GROUP: there is none.
   subroutine find_places(one, k, history, model, fault)
      class(acting_t), intent(inout) :: one
      type(key_table_t), intent(in) :: k
      character(*), intent(in) :: history   !< Its name; empty: none.
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault

      one%scene_item_t = item_of(k%group)
      one%group = mesh_group(model%domain%mesh, one%group_name, place_of(one), fault)
      if (fault%code == 0) one%amplitude = history_named(history, model%amplitudes%name, place_of(one), fault)
   end subroutine find_places

   !> Builds a &contact. Fault EXIT_GROUP: its boundaries do not exist, are one, or have no edges. EXIT_INPUT: it acts
   !> in a stage that zeroes displacements.
   subroutine build_contact(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(contact_pair_t) :: contact
      character(LENGTH) :: slave, master
      integer :: i

      slave = ''
      master = ''
      call k%text('name', contact%name, 'name in contact.csv', REQUIRED)
      call k%text('slave', slave, 'boundary that is integrated over: the softer or finer one', REQUIRED)
      call k%text('master', master, 'boundary opposite, or name of a &plate', REQUIRED)
      call k%number('penalty', contact%options%penalty, TINY_, BIG, 'pressure of a unit of penetration [kN/m3]')
      call k%word('gap', contact%options%gap, 'nodal|pointwise|combined', 'gap that is penalised, see CONTACT.md')
      call k%number('search_radius', contact%options%search_radius, ZERO, BIG, &
                    'edges farther apart are not paired [m]; 0: length of the slave edge')
      call read_stages(k, model, contact%in_stage)
      if (k%lists) return
      contact%scene_item_t = item_of(k%group)
      contact%options%axisymmetric = model%domain%axisymmetric
      contact%slave = mesh_group(model%domain%mesh, slave, place_of(contact), fault)
      if (fault%code == 0) contact%master = mesh_group(model%domain%mesh, master, place_of(contact), fault)
      if (fault%code /= 0) return
      do i = 1, size(model%plates)
         if (model%plates(i)%name /= master) cycle
         ! A plate that is joined to a boundary has no other surface than this.
         if (model%plates(i)%group == 0) contact%plate = i
         if (model%plates(i)%group > 0) contact%master = model%plates(i)%group
      end do
      associate (groups => model%domain%mesh%groups)
         if (contact%slave == contact%master) then
            call raise(fault, EXIT_GROUP, place_of(contact)//'slave and master are one boundary, '''// &
                       trim(slave)//'''; name the two that meet.')
            return
         else if (size(groups(contact%slave)%edges, 2) == 0 .or. &
                  (contact%plate == 0 .and. size(groups(contact%master)%edges, 2) == 0)) then
            call raise(fault, EXIT_GROUP, place_of(contact)//'slave and master need edges: a boundary of the mesh '// &
                       '(the master may be a plate).')
            return
         end if
      end associate
      i = findloc(contact%in_stage .and. model%stages%zero_displacements, .true., dim=1)
      if (i > 0) then
         call raise(fault, EXIT_INPUT, place_of(contact)//'stage '''//trim(model%stages(i)%name)// &
                    ''' zeroes its displacements, which would undo the contact; name the stages of the contact.')
         return
      end if
      contact%what = '&contact'
      contact%along_normal = .true.
      contact%group = contact%slave
      contact%bears = .true.
      model%contacts = [model%contacts, contact]
      model%actions = [model%actions, contact%action_t]
      if (contact%plate > 0) return
      contact%group = contact%master
      contact%bears = .false.
      model%actions = [model%actions, contact%action_t]
   end subroutine build_contact

   !> Builds a &tie, pairs of nodes at equal heights. Fault EXIT_GROUP: a boundary does not exist, or the nodes of both
   !> are not at the same heights.
   subroutine build_tie(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(tie_t) :: tie
      character(LENGTH) :: first_name, second_name
      character(:), allocatable :: place
      integer :: first, second, i, n
      real(wp), parameter :: SAME_HEIGHT = 1.0e-6_wp   !< Share of the height of the boundary.
      real(wp) :: near

      first_name = ''
      second_name = ''
      call k%text('first', first_name, 'first boundary: nodes at equal heights move together', REQUIRED)
      call k%text('second', second_name, 'second boundary, with nodes at the same heights', REQUIRED)
      call k%flag('pressures', tie%pressures, 'no|yes', 'yes', 'pore pressures of the nodes are equal as well', &
                  ':p_w')
      if (k%lists) return
      place = at_line(k%group%file, k%group%line)
      second = 0
      first = mesh_group(model%domain%mesh, first_name, place, fault)
      if (fault%code == 0) second = mesh_group(model%domain%mesh, second_name, place, fault)
      if (fault%code /= 0) return
      associate (a => model%domain%mesh%groups(first)%nodes, b => model%domain%mesh%groups(second)%nodes, &
                 z => model%domain%mesh%x(2, :))
         if (first == second .or. size(a) /= size(b)) then
            call raise(fault, EXIT_GROUP, place//'''' //trim(first_name)//''' has '//whole(size(a))// &
                       ' nodes and '''//trim(second_name)//''' '//whole(size(b))//'; a tie needs two '// &
                       'boundaries with as many nodes, at the same heights.')
            return
         end if
         near = SAME_HEIGHT*(maxval(z(a)) - minval(z(a)))
         allocate (tie%pairs(2, size(a)))
         do i = 1, size(a)
            n = minloc(abs(z(b) - z(a(i))), dim=1)
            if (abs(z(b(n)) - z(a(i))) > near .or. any(tie%pairs(2, :i - 1) == b(n))) then
               call raise(fault, EXIT_GROUP, place//'no node of '''//trim(second_name)//''' lies '// &
                          'at the height '//short(z(a(i)))//' m of '''//trim(first_name)//'''.')
               return
            end if
            tie%pairs(:, i) = [a(i), b(n)]
         end do
      end associate
      model%ties = [model%ties, tie]
   end subroutine build_tie
end module boundary_builder
