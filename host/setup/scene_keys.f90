! SPDX-License-Identifier: MIT
!> Every key of a scene, once: its name, the value that it sets, range or words, meaning, and when it has an effect. The
!> statements read a group; with a group that gives nothing they list the keys, from which checks, the template and the
!> warnings about keys without effect come. Defaults are those of scene_types.
module scene_keys
   use kinds, only: wp
   use effect_names, only: EFFECT_WORDS
   use history_shapes, only: pairs_of_shape, SHAPE_WORDS, TABLE
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: key_t, REQUIRED, UNBOUNDED, check_group, given, line_of
   use key_table, only: key_table_t, listing
   use material_registry, only: is_law, law_names, law_keys
   use namelists, only: group_t, MAX_VALUES
   use texts, only: LENGTH
   use number_pairs, only: read_pairs
   use permeability_laws, only: permeability_t
   use retention_curves, only: retention_t
   use retention_groups, only: new_retention
   use scene_tolerances, only: ask_steps, ask_stress
   use scene_parts, only: scene_item_t, amplitude_t, stage_t, place_of, LOAD_FORCE_Z, LOAD_OF_BODY, &
                          PRESCRIBED_OF_BODY, initial_values_t, named_point_t
   use scene_types, only: scene_t, scene_law_t, scene_region_t, scene_fix_t, scene_load_t, scene_plate_t, &
                          scene_contact_t, scene_tie_t, item_of
   use spelling, only: nearest_name
   use term_registry, only: with_own_groups, declare_keys
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: check_keys, keys_of_scenes, make_lists, take_group, print_template

   real(wp), parameter :: BIG = UNBOUNDED, TINY_ = 1.0e-30_wp, ZERO = 0.0_wp, ONE = 1.0_wp
   integer, parameter :: MANY = 1000000
   character(12), parameter :: GROUPS(*) = [character(12) :: 'scene', 'mesh', 'fluids', 'retention', 'permeability', &
      'region', 'initial', 'history', 'stage', 'fix', 'load', 'tie', 'plate', 'contact', &
      'point']
   character(*), parameter :: LAW_NAME = 'name, for the key material of &region'
   character(*), parameter :: STAGES = 'names of stages; default: all'
contains
   !> The keys of all groups but those of laws of materials, in the order of the template.
   function keys_of_scenes() result(keys)
      type(key_t), allocatable :: keys(:)
      type(key_table_t) :: table
      type(scene_t) :: nothing
      type(fault_t) :: fault
      character(12), allocatable :: names(:)
      integer :: g

      allocate (names, source=with_own_groups(GROUPS))
      table = listing('')
      call make_lists(nothing)
      do g = 1, size(names)
         table%group%name = names(g)
         ! What a group lacks is no fault of a list.
         fault = fault_t()
         call take_group(table, nothing, fault)
         call declare_keys(table)
      end do
      call move_alloc(table%keys, keys)
   end function keys_of_scenes

   !> Empty lists of groups.
   subroutine make_lists(scene)
      type(scene_t), intent(inout) :: scene

      allocate (scene%materials(0), scene%retentions(0), scene%permeabilities(0), scene%regions(0), &
                scene%initials(0), scene%amplitudes(0), scene%stages(0), scene%fixes(0), &
                scene%loads(0), scene%plates(0), scene%contacts(0), scene%ties(0), scene%points(0))
   end subroutine make_lists

   !> Reads the group of a table into a scene, &scene before others. Fault EXIT_INPUT: values contradict each other.
   subroutine take_group(k, scene, fault)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault

      select case (k%group%name)
      case ('scene')
         call take_scene(k, scene)
      case ('mesh')
         call take_mesh(k, scene)
      case ('fluids')
         call take_fluids(k, scene)
      case ('retention')
         call take_retention(k, scene)
      case ('permeability')
         call take_permeability(k, scene, fault)
      case ('region')
         call take_region(k, scene)
      case ('initial')
         call take_initial(k, scene, fault)
      case ('history')
         call take_history(k, scene, fault)
      case ('stage')
         call take_stage(k, scene, fault)
      case ('fix')
         call take_fix(k, scene)
      case ('load')
         call take_load(k, scene)
      case ('tie')
         call take_tie(k, scene)
      case ('plate')
         call take_plate(k, scene, fault)
      case ('contact')
         call take_contact(k, scene)
      case ('point')
         call take_point(k, scene)
      case default
         ! Groups of terms are read where these are built.
         if (is_law(k%group%name)) call take_material(k, scene)
      end select
   end subroutine take_group

   subroutine take_scene(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene

      call k%text('name', scene%name, 'name of the scene', REQUIRED)
      call k%flag('geometry', scene%axisymmetric, 'axisymmetric|plane_strain', 'axisymmetric', &
                  'axisymmetric in r, z or plane strain in x, y')
      call k%word('fields', scene%fields, 'u|u-p_w|u-p_w-p_c', 'unknowns; absent ones cost nothing')
      call k%flag('pressures', scene%linear_pressures, 'quadratic|linear', 'linear', &
                  'interpolation; linear (Taylor-Hood) is stable where water cannot drain yet', ':p_w')
      call k%whole('quadrature', scene%quadrature, 3, 12, 'points of an element: 3, 6, 7 or 12')
      call k%number('gravity', scene%gravity, ZERO, 1000*ONE, 'acceleration towards -z [m/s2]')
      call k%text('gravity_history', scene%gravity_history, 'name of a &history: factor on gravity', '+gravity', &
                  refers='history')
      call k%texts('without', scene%without, 'effects that are taken out by hand', words=EFFECT_WORDS)
      call k%flag('seepage_inertia', scene%seepage_inertia, 'no|yes', 'yes', &
                  'acceleration of the skeleton in Darcy''s law', ':p_w')
      call k%flag('saturation_rate', scene%full_saturation_rate, 'full|suction', 'full', &
                  'rate of saturation by void ratio and suction, or by suction alone', ':p_c')
      call k%flag('initial_flow', scene%subtract_flow, 'drain|subtract', 'subtract', &
                  'subtract: the initial flow is maintained', ':p_w')
      call k%number('step_tolerance', scene%step_tolerance, 1.0e-8_wp, 0.5_wp, &
                    'local tolerance of controlled steps [-], see host/SCENE.md')
      call k%texts('goals', scene%goals, 'answers that mud_study measures, as ''top.u_z''; default: all')
      call k%whole('threads', scene%threads, 0, 1024, 'threads over elements; 0: by size, at most OMP_NUM_THREADS')
      call k%flag('factors', scene%reuse_factors, 'reuse|fresh', 'reuse', &
                  'factors of the matrix: reused while they serve, or new in every iteration')
      call k%word('ordering', scene%ordering, 'auto|amd|metis|best', &
                  'ordering of the unknowns; auto: amd, beyond 10,000 unknowns metis; best tries several')
      call k%whole('checkpoint_steps', scene%checkpoint_steps, 0, 1000*MANY, &
                   'checkpoint.h5 after every so many steps; 0: none')
      call k%number('checkpoint_seconds', scene%checkpoint_seconds, ZERO, BIG, &
                    'checkpoint.h5 after so much wall time [s]; 0: none')
   end subroutine take_scene

   subroutine take_mesh(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      character(*), parameter :: RATIO = 'size of a cell over that of the previous one; default 1'

      associate (mesh => scene%mesh)
         mesh%scene_item_t = item_of(k%group)
         call k%text('file', mesh%mesh_file, 'Gmsh 4.1 text mesh, relative to the scene; or r and z:')
         call k%number('scale', mesh%scale, 1.0e-9_wp, 1.0e9_wp, &
                       'factor on the coordinates of the file; 1e-3: they are in mm', '+file')
         call k%numbers('r', mesh%r, -BIG, BIG, 'breaks along r [m], ascending', '-file')
         call k%wholes('r_cells', mesh%r_cells, 1, 100000, 'cells between two breaks of r', '-file')
         call k%numbers('r_ratio', mesh%r_ratio, 0.01_wp, 100*ONE, RATIO, '-file')
         call k%numbers('z', mesh%z, -BIG, BIG, 'breaks along z [m], ascending', '-file')
         call k%wholes('z_cells', mesh%z_cells, 1, 100000, 'cells between two breaks of z', '-file')
         call k%numbers('z_ratio', mesh%z_ratio, 0.01_wp, 100*ONE, RATIO, '-file')
         call k%number('fineness', mesh%fineness, 0.01_wp, 64*ONE, 'times as many cells along each axis; of a file '// &
                       '1, 2, 4, 8')
         mesh%scale_given = k%given('scale')
         ! A path is relative to the file of the scene.
         if (k%given('file') .and. index(mesh%mesh_file, '/') /= 1) &
            mesh%mesh_file = k%group%file(:index(k%group%file, '/', back=.true.))//mesh%mesh_file
         if (size(mesh%r_ratio) == 0) mesh%r_ratio = spread(ONE, 1, size(mesh%r_cells))
         if (size(mesh%z_ratio) == 0) mesh%z_ratio = spread(ONE, 1, size(mesh%z_cells))
      end associate
   end subroutine take_mesh

   subroutine take_fluids(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene

      associate (f => scene%fluids)
         call k%number('k_w', f%k_w, TINY_, BIG, 'bulk modulus of water [kPa]', ':p_w')
         call k%number('rho_w', f%rho_w, ZERO, 1000*ONE, 'density of water [Mg/m3]', ':p_w')
         call k%number('eta_w', f%eta_w, TINY_, BIG, 'viscosity of water [kPa s]', ':p_w')
         call k%flag('gas', f%ideal_gas, 'constant|ideal', 'ideal', 'ideal: K_a = p_ref + p_a, density as well', ':p_c')
         call k%number('k_a', f%k_a, TINY_, BIG, 'bulk modulus of a constant gas [kPa]', 'gas=constant :p_c')
         call k%number('rho_a', f%rho_a, ZERO, 1000*ONE, 'density of air (ideal: at p_ref) [Mg/m3]', ':p_c')
         call k%number('eta_a', f%eta_a, TINY_, BIG, 'viscosity of air [kPa s]', ':p_c')
         call k%number('p_ref', f%p_ref, TINY_, BIG, 'absolute pressure where p_a = 0 [kPa]', ':p_c')
         call k%number('henry', f%henry, ZERO, 0.5_wp, &
                       'volume of air that a volume of water dissolves [-]; 0.02 at 20 C', ':p_c')
      end associate
   end subroutine take_fluids

   subroutine take_retention(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(scene_law_t) :: law
      class(retention_t), allocatable :: unused
      type(fault_t) :: none

      call k%text('name', law%name, 'name, for the key of &region', REQUIRED)
      ! The curve is made where a region asks for it.
      if (k%lists) call new_retention(k, unused, none)
      law%group = k%group
      scene%retentions = [scene%retentions, law]
   end subroutine take_retention

   subroutine take_material(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(scene_law_t) :: law

      call k%text('name', law%name, LAW_NAME, REQUIRED)
      law%group = k%group
      call ask_stress(scene%step_tolerance, law%group)
      scene%materials = [scene%materials, law]
   end subroutine take_material

   subroutine take_permeability(k, scene, fault)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      type(permeability_t) :: law

      call k%text('name', law%name, 'name, for the key of &region', REQUIRED)
      call k%number('intrinsic', law%intrinsic, TINY_, ONE, 'intrinsic permeability [m2]', REQUIRED)
      call k%word('law', law%law, 'corey|mualem|power|constant', 'relative permeabilities')
      call k%number('s_min', law%s_min, ZERO, 0.999_wp, 'S_w at which S_e = 0 [-]', 'law=corey|mualem|power')
      call k%number('s_max', law%s_max, 0.001_wp, ONE, 'S_w at which S_e = 1 [-]', 'law=corey|mualem|power')
      call k%number('a', law%a, ZERO, BIG, 'power: k_rw = 1 - a (1 - S_w)**b', 'law=power')
      call k%number('b', law%b, ONE, 100*ONE, 'corey: k_rw = S_e**b; power: see a', 'law=corey|power')
      call k%number('c', law%c, ONE, 100*ONE, 'corey, power: k_ra = (1 - S_e)**2 (1 - S_e**c)', 'law=corey|power')
      call k%number('m', law%m, 0.01_wp, 0.99_wp, 'exponent of Mualem-van Genuchten [-]', 'law=mualem')
      call k%number('k_rw', law%k_rw, ZERO, ONE, 'constant: relative permeability to water [-]', 'law=constant')
      call k%number('k_ra', law%k_ra, ZERO, ONE, 'constant: relative permeability to air [-]', 'law=constant')
      call k%number('floor', law%floor, ZERO, ONE, 'least relative permeability [-]')
      if (law%s_max <= law%s_min) call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)// &
                                             's_max must be larger than s_min.')
      scene%permeabilities = [scene%permeabilities, law]
   end subroutine take_permeability

   subroutine take_region(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(scene_region_t) :: region

      region%scene_item_t = item_of(k%group)
      call k%text('group', region%group_name, 'group of elements; without it those that no other region names')
      call k%text('material', region%material_name, 'name of a material, as &mud or &elastic', REQUIRED, &
                  refers='material')
      call k%text('retention', region%retention_name, 'name of a &retention, or "material": its own', &
                  'drainage=coupled|drained|undrained :p_c', refers='retention')
      call k%text('permeability', region%permeability_name, 'name of a &permeability', 'drainage=coupled :p_w', &
                  refers='permeability')
      call k%word('drainage', region%drainage, 'coupled|drained|undrained|dry', &
                  'fluids flow, stay at given pressures, stay in every element, or are absent', ':p_w')
      call k%number('rho_s', region%rho_s, ZERO, 1000*ONE, 'density of the grains [Mg/m3]')
      call k%number('void_ratio', region%void_ratio, ZERO, 10*ONE, 'initial void ratio [-]; default: the material''s')
      call k%number('damping', region%damping, ZERO, BIG, 'force against the velocity over mass, dynamic stages [1/s]')
      call k%number('stiffness_damping', region%stiffness_damping, ZERO, BIG, &
                    'stress of the skeleton from its rate, dynamic stages [s]')
      region%rest = .not. k%given('group')
      scene%regions = [scene%regions, region]
   end subroutine take_region

   subroutine take_initial(k, scene, fault)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      type(initial_values_t) :: initial
      character(*), parameter :: BY_HAND(*) = [character(9) :: 'p_w', 'p_w_slope', 'p_c', 'p_c_slope', 'datum']
      real(wp), allocatable :: sigma(:)
      integer :: stress, i

      initial%scene_item_t = item_of(k%group)
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
      call k%number('datum', initial%datum, -BIG, BIG, 'z of the datum [m]')
      call k%number('v_z', initial%v_z, -BIG, BIG, 'vertical velocity at the start [m/s]')
      call k%number('wave', initial%wave, -BIG, BIG, 'v_z = wave sin(wave_number (z - datum)) at the start [m/s]')
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
                  'stress=geostatic')
      initial%with_table = k%given('water_table')
      if (initial%with_table .and. any([(k%given(trim(BY_HAND(i))), i=1, size(BY_HAND))])) then
         call raise(fault, EXIT_INPUT, place_of(initial)//'water_table gives p_w and p_c of water at rest; leave '// &
                    'out p_w, p_w_slope, p_c, p_c_slope and datum, or water_table.')
         return
      else if (initial%with_table .and. .not. scene%gravity > 0.0_wp) then
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
      scene%initials = [scene%initials, initial]
   end subroutine take_initial

   !> Times and factors from the keys, from a file with two numbers a line, or of a known shape.
   subroutine take_history(k, scene, fault)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: OF_TABLES(*) = [character(6) :: 'times', 'values', 'file'], &
                                 OF_SHAPES(*) = [character(7) :: 'start', 'period', 'repeats']
      type(amplitude_t) :: amplitude
      character(LENGTH) :: file
      real(wp) :: start, period
      integer :: shape, repeats, i

      amplitude%scene_item_t = item_of(k%group)
      call k%text('name', amplitude%name, 'name, for the key history of loads', REQUIRED)
      shape = TABLE
      call k%word('kind', shape, SHAPE_WORDS, 'pairs of a table, a wave, or a pulse between 0 and 1')
      call k%numbers('times', amplitude%times, -BIG, BIG, 'ascending [s]; straight lines between, constant outside', &
                     '-file')
      call k%numbers('values', amplitude%values, -BIG, BIG, 'factors at these times [-]', '-file')
      file = ''
      call k%text('file', file, 'instead: text file, a time and a factor in every line')
      start = 0.0_wp
      period = 0.0_wp
      repeats = 1
      call k%number('start', start, -BIG, BIG, 'when a wave or pulse begins [s]; 0 before')
      call k%number('period', period, TINY_, BIG, 'period of a sine, length of a pulse [s]')
      call k%whole('repeats', repeats, 1, 10000, 'waves or pulses, one after the other; 0 after them')
      call k%texts('stages', amplitude%stages, &
                   'times count from the start of each of these stages; default: of the run')
      allocate (amplitude%arcs(0))
      if (shape /= TABLE) then
         if (any([(k%given(trim(OF_TABLES(i))), i=1, size(OF_TABLES))]) .or. .not. k%given('period')) then
            call raise(fault, EXIT_INPUT, place_of(amplitude)//'history '//trim(amplitude%name)//' has a kind that '// &
                       'needs its period [s], and neither times and values nor a file.')
            return
         end if
         call pairs_of_shape(shape, start, period, repeats, amplitude%times, amplitude%values, amplitude%arcs)
      else if (any([(k%given(trim(OF_SHAPES(i))), i=1, size(OF_SHAPES))])) then
         call raise(fault, EXIT_INPUT, place_of(amplitude)//'start, period and repeats are those of a sine or a '// &
                    'pulse, and history '//trim(amplitude%name)//' is a table; give kind = ''sine'', '// &
                    '''half_sine'', ''haversine'' or ''triangle''.')
         return
      end if
      if (k%given('file')) call read_pairs(trim(file), trim(k%group%file), k%group%line, 'a time and a factor', &
                                           amplitude%times, amplitude%values, fault)
      if (fault%code /= 0) return
      if (size(amplitude%times) == 0 .or. size(amplitude%times) /= size(amplitude%values)) then
         call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)//'history '//trim(amplitude%name)// &
                    ' needs as many values as times.')
      else if (any(amplitude%times(2:) <= amplitude%times(:size(amplitude%times) - 1))) then
         call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)//'the times of history '// &
                    trim(amplitude%name)//' must ascend.')
      end if
      scene%amplitudes = [scene%amplitudes, amplitude]
   end subroutine take_history

   subroutine take_stage(k, scene, fault)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      type(stage_t) :: stage
      character(LENGTH) :: ends
      real(wp), allocatable :: lengths(:)
      integer :: steps

      call k%text('name', stage%name, 'name of the stage', REQUIRED)
      call k%word('analysis', stage%kind, 'static|quasi_static|dynamic', 'kind of the stage', REQUIRED)
      call k%number('duration', stage%duration, TINY_, BIG, 'duration [s]', REQUIRED)
      call k%number('dt', stage%dt, TINY_, BIG, 'time step [s]; where steps are controlled the first one')
      steps = 0
      call k%word('steps', steps, 'given|controlled', &
                  'given: dt; controlled: by their error, default with step_tolerance or without dt')
      ends = ''
      call k%text('step_ends', ends, 'given steps: file with the end of every step since the start of the stage '// &
                  'and its length [s]', 'steps=given')
      call k%number('output_dt', stage%output_dt, TINY_, BIG, &
                    'controlled steps end at multiples of it, with fields [s]')
      call k%number('dt_growth', stage%dt_growth, ONE, 10*ONE, 'factor on the step after every accepted one')
      call k%number('dt_max', stage%dt_max, TINY_, BIG, 'largest step with dt_growth [s]', '+dt_growth')
      call k%whole('cuts', stage%cuts, 0, 40, 'how often a step may be halved')
      call k%number('rho_inf', stage%rho_inf, ZERO, ONE, &
                    'spectral radius of generalised-alpha [-]; default 0.8, dynamic with contact 0', &
                    'analysis=quasi_static|dynamic')
      call k%number('created_energy', stage%created_energy, TINY_, BIG, &
                    'energy created out of nothing that ends the run, share of the largest work [-]')
      call k%number('tolerance', stage%tolerance, 1.0e-14_wp, 0.1_wp, 'Newton: error that ends the iteration [-]')
      call k%word('measure', stage%measure, 'forces|residual|correction|change|auto', &
                  'measure of the error that ends the iteration, see host/SCENE.md')
      call k%whole('max_iterations', stage%max_iterations, 1, 1000, 'Newton: linear solves before the step is cut')
      call k%flag('predictor', stage%no_predictor, 'rates|none', 'none', 'start of the iteration')
      call k%flag('start', stage%solve_start, 'solve|zero', 'solve', 'accelerations at the start of a dynamic stage', &
                  'analysis=dynamic')
      call k%flag('zero_displacements', stage%zero_displacements, 'no|yes', 'yes', &
                  'displacements are set to zero at the end of the stage')
      call k%whole('every', stage%every, 1, MANY, 'histories are written every so many steps')
      call k%whole('fields', stage%fields, 0, MANY, &
                   'fields are written every so many steps; 0: at the end; without: controlled steps at 50 times')
      stage%film = .not. (k%given('fields') .or. k%given('output_dt'))
      call ask_steps(k%group, scene%step_tolerance, steps == 2, stage, fault)
      if (k%given('step_ends')) call read_pairs(trim(ends), trim(k%group%file), k%group%line, &
                                                'the end of a step and its length [s]', stage%ends, lengths, fault)
      if (fault%code == 0 .and. k%given('step_ends')) then
         if (stage%controlled .or. size(stage%ends) == 0 .or. any(stage%ends(2:) <= &
             stage%ends(:size(stage%ends) - 1))) call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)// &
            'step_ends of &stage '//trim(stage%name)//' needs steps = ''given'', and times in '//trim(ends)// &
            ' that ascend [s].')
      end if
      scene%stages = [scene%stages, stage]
   end subroutine take_stage

   subroutine take_fix(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(scene_fix_t) :: fix

      fix%scene_item_t = item_of(k%group)
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
      call k%text('history', fix%amplitude_name, 'factor on the value', 'hold=no', refers='history')
      call k%flag('hold', fix%hold, 'no|yes', 'yes', 'yes: held at its value at the start of the stage')
      call k%flag('motion', fix%acceleration, 'value|acceleration', 'acceleration', &
                  'what the value of u_r, u_z is: displacement, or acceleration [m/s2]')
      call k%texts('stages', fix%stages, STAGES)
      call k%number('from', fix%from, -BIG, BIG, 'acts after this time [s]')
      call k%number('until', fix%until, -BIG, BIG, 'acts up to this time [s]')
      scene%fixes = [scene%fixes, fix]
   end subroutine take_fix

   subroutine take_load(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(scene_load_t) :: load

      load%scene_item_t = item_of(k%group)
      call k%text('group', load%group_name, 'boundary (for force: node group)', REQUIRED)
      call k%word('kind', load%kind, 'pressure|shear_r|shear_z|water|rain|air|force_r|force_z|moment', &
                  'kind of load, see host/SCENE.md', REQUIRED)
      load%of_body = load%kind == LOAD_OF_BODY
      if (load%of_body) load%kind = LOAD_FORCE_Z
      call k%number('value', load%value, -BIG, BIG, 'value of the load, at the datum [kPa, m/s, kN, kN m]', &
                    REQUIRED)
      call k%number('value_slope', load%value_slope, -BIG, BIG, 'change of the value with z [kPa/m, 1/s, kN/m]')
      call k%number('datum', load%datum, -BIG, BIG, 'z of the datum [m]', '+value_slope')
      call k%text('history', load%amplitude_name, 'factor on the value', refers='history')
      call k%texts('stages', load%stages, STAGES)
      scene%loads = [scene%loads, load]
   end subroutine take_load

   subroutine take_tie(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(scene_tie_t) :: tie

      tie%scene_item_t = item_of(k%group)
      call k%text('first', tie%first_name, 'first boundary: nodes at equal heights move together', REQUIRED)
      call k%text('second', tie%second_name, 'second boundary, with nodes at the same heights', REQUIRED)
      call k%flag('pressures', tie%pressures, 'no|yes', 'yes', 'pore pressures of the nodes are equal as well')
      scene%ties = [scene%ties, tie]
   end subroutine take_tie

   subroutine take_plate(k, scene, fault)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      type(scene_plate_t) :: plate
      real(wp), allocatable :: r(:), outline(:)
      real(wp) :: z
      logical :: up

      plate%scene_item_t = item_of(k%group)
      z = 0.0_wp
      up = .false.
      call k%text('name', plate%name, 'rigid plate or foundation; also a group for &fix and &load', REQUIRED)
      call k%numbers('r', r, -BIG, BIG, 'begin and end of its own flat face [m]; or outline, or group')
      call k%text('group', plate%joined_name, 'boundary of the mesh that moves with the plate; or r, or outline')
      call k%number('z', z, -BIG, BIG, 'height of the plate''s own face at the start [m]', '+r')
      call k%flag('face', up, 'down|up', 'up', 'direction of the plate''s own face', '+r')
      call k%numbers('outline', outline, -BIG, BIG, &
                     'corners r, z, r, z, ... of its own face, the plate on the left; or r [m]', 'motion=plane')
      call k%number('mass', plate%mass, TINY_, BIG, 'mass of the plate [Mg]', REQUIRED)
      call k%flag('weight', plate%heavy, 'no|yes', 'yes', &
                  'the weight acts, and the plate starts in balance on its contact')
      call k%number('force', plate%force, -BIG, BIG, 'force on the plate, upwards [kN]')
      call k%text('history', plate%amplitude_name, 'factor on the forces', refers='history')
      if (count([k%given('group'), k%given('r'), k%given('outline')]) /= 1) then
         call raise(fault, EXIT_INPUT, place_of(plate)//'a plate has a face of its own, r = begin, end (in the '// &
                    'plane also outline), or it is joined to a boundary, group = name: give one of the two.')
      else if (k%given('outline') .and. (size(outline) < 4 .or. mod(size(outline), 2) == 1)) then
         call raise(fault, EXIT_INPUT, place_of(plate)//'outline = r, z, r, z, ... are two corners or more.')
      else if (k%given('r') .and. size(r) /= 2) then
         call raise(fault, EXIT_INPUT, place_of(plate)//'a plate needs r = begin, end, ascending.')
      else if (k%given('r')) then
         plate%corners = reshape([r(1), z, r(2), z], [2, 2])
         if (up) plate%corners = plate%corners(:, [2, 1])
         if (.not. r(2) > r(1) .or. (scene%axisymmetric .and. r(1) < ZERO)) call raise(fault, &
            EXIT_INPUT, place_of(plate)//'a plate needs r = begin, end, ascending and, in axial symmetry, not '// &
            'negative.')
      else if (k%given('outline')) then
         plate%corners = reshape(outline, [2, size(outline)/2])
      end if
      scene%plates = [scene%plates, plate]
   end subroutine take_plate

   subroutine take_contact(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(scene_contact_t) :: contact

      contact%scene_item_t = item_of(k%group)
      call k%text('name', contact%name, 'name in contact.csv', REQUIRED)
      call k%text('slave', contact%slave_name, 'boundary that is integrated over: the softer or finer one', REQUIRED)
      call k%text('master', contact%master_name, 'boundary opposite, or name of a &plate', REQUIRED)
      call k%number('penalty', contact%options%penalty, TINY_, BIG, 'pressure of a unit of penetration [kN/m3]')
      call k%word('gap', contact%options%gap, 'nodal|pointwise|combined', 'gap that is penalised, see CONTACT.md')
      call k%number('search_radius', contact%options%search_radius, ZERO, BIG, &
                    'edges farther apart are not paired [m]; 0: length of the slave edge')
      call k%texts('stages', contact%stages, STAGES)
      contact%options%axisymmetric = scene%axisymmetric
      scene%contacts = [scene%contacts, contact]
   end subroutine take_contact

   subroutine take_point(k, scene)
      type(key_table_t), intent(inout) :: k
      type(scene_t), intent(inout) :: scene
      type(named_point_t) :: point

      call k%text('name', point%name, 'name in histories.csv', REQUIRED)
      call k%number('r', point%x(1), -BIG, BIG, 'place of the point, in the mesh [m]', REQUIRED)
      call k%number('z', point%x(2), -BIG, BIG, 'place of the point, in the mesh [m]', REQUIRED)
      scene%points = [scene%points, point]
   end subroutine take_point

   !> Refuses unknown groups and keys, missing ones, and values of the wrong kind or outside their range. Fault
   !> EXIT_INPUT, at the first. Keys of laws are checked where they are built.
   subroutine check_keys(groups, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      type(fault_t), intent(inout) :: fault
      type(key_t), allocatable :: keys(:)
      character(12), allocatable :: names(:)
      integer :: g

      allocate (keys, source=keys_of_scenes())
      do g = 1, size(groups)
         if (groups(g)%name == 'scene') call refuse_old_keys(groups(g), fault)
         if (fault%code /= 0) return
         if (is_law(groups(g)%name)) then
            ! The law checks its own keys when it is built.
            if (.not. given(groups(g), 'name')) call raise(fault, EXIT_INPUT, at_line(groups(g)%file, &
               groups(g)%line)//'&'//trim(groups(g)%name)//' needs name ('//LAW_NAME//').')
         else if (.not. any(keys%group == groups(g)%name)) then
            names = [keys%group, law_names()]
            call raise(fault, EXIT_INPUT, at_line(groups(g)%file, groups(g)%line)//'there is no group &'// &
                       trim(groups(g)%name)//'; the nearest is &'// &
                       trim(names(nearest_name(groups(g)%name, names)))//'.')
         else
            call check_group(keys, groups(g), .false., fault)
         end if
         if (fault%code /= 0) return
      end do
   end subroutine check_keys

   !> Fault EXIT_INPUT: a key that older scenes have, with what says it today.
   subroutine refuse_old_keys(group, fault)
      type(group_t), intent(in) :: group   !< &scene.
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: OLD(7) = [character(20) :: 'accuracy', 'mesh', 'budget', 'effects', &
         'effects_tolerance', 'effects_pilot_share', 'effects_on_warning']
      character(*), parameter :: MEASURES = ' --accuracy A" measures the errors of the answers, and refines steps '// &
         'and mesh until they are below A.'
      character(:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(OLD)
         if (.not. given(group, trim(OLD(i))) .or. fault%code /= 0) cycle
         if (i == 1) then
            text = 'the local tolerance of the steps is now step_tolerance; "mud_study accuracy '//trim(group%file)// &
                   MEASURES
         else if (i <= 3) then
            text = 'leave it out; "mud_study accuracy '//trim(group%file)//MEASURES
         else
            text = 'leave it out, and give analysis, fields and gravity; "mud_study effects '//trim(group%file)// &
                   '" measures what each effect changes and writes the scene without those that do not matter.'
         end if
         call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, trim(OLD(i))))//trim(OLD(i))// &
                    ' is no key of &scene any more: '//text)
      end do
   end subroutine refuse_old_keys

   !> Every key with its default and meaning, as a scene to start from.
   subroutine print_template(unit)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(key_t), allocatable :: all_keys(:)
      character(12), allocatable :: laws(:)
      integer :: g, k

      allocate (all_keys, source=keys_of_scenes())
      allocate (laws, source=law_names())
      do g = 1, size(laws)
         all_keys = [all_keys, key_t(laws(g), 'name', 't', REQUIRED, 0, 0, LAW_NAME), &
                     law_keys(laws(g), laws(g))]
      end do
      write (unit, '(a)') '! Every group and key of a scene. Lines that begin with "!" may be left out.'
      write (unit, '(a,i0,a)') '! Groups but &scene, &mesh and &fluids may occur several times; lists hold up to ', &
         MAX_VALUES, ' values.'
      do g = 1, size(all_keys)
         if (any(all_keys(:g - 1)%group == all_keys(g)%group)) cycle
         write (unit, '(2a)') '&', trim(all_keys(g)%group)
         do k = g, size(all_keys)
            if (all_keys(k)%group == all_keys(g)%group) call print_key(all_keys(k))
         end do
         write (unit, '(a)') '/'
      end do
   contains
      subroutine print_key(key)
         type(key_t), intent(in) :: key
         character(:), allocatable :: value, meaning

         value = trim(key%preset)
         if (value == REQUIRED) value = '?'
         if (index('twT', key%kind) > 0) value = ''''//value//''''
         meaning = trim(key%meaning)
         if (key%words /= '') meaning = trim(key%words)//': '//meaning
         write (unit, '(a,a,a)') merge('     ', '   ! ', key%preset == REQUIRED), &
            padded(trim(key%name)//' = '//value, 34), '! '//meaning
      end subroutine print_key

      pure function padded(text, width) result(wide)
         character(*), intent(in) :: text
         integer, intent(in) :: width
         character(:), allocatable :: wide

         wide = text//repeat(' ', max(1, width - len(text)))
      end function padded
   end subroutine print_template
end module scene_keys
