! SPDX-License-Identifier: MIT
!> Every key of a scene: kind, default, range or words, meaning. Checks, the template and the tables of the manual all
!> come from this list.
module scene_keys
   use kinds, only: wp
   use effect_types, only: EFFECT_WORDS
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: key_t, REQUIRED, NONE, UNBOUNDED, check_group, given, line_of, words_of, place_of, &
                         schema_number_of => number_of, schema_text_of => text_of, schema_word_is => word_is
   use material_registry, only: is_law, law_names, law_keys
   use namelists, only: group_t, MAX_VALUES
   use retention_groups, only: RETENTION_KEYS
   use spelling, only: nearest_name
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: check_keys, number_of, text_of, word_is, word_number, print_template

   real(wp), parameter :: BIG = UNBOUNDED, TINY_ = 1.0e-30_wp

   !> Keys of a scene's own groups. Laws of materials and retention curves list theirs themselves.
   type(key_t), parameter :: OWN_KEYS(*) = [ &
      key_t('scene', 'name', 't', REQUIRED, 0, 0, 'name of the scene'), &
      key_t('scene', 'geometry', 'w', 'axisymmetric', 0, 0, &
            'axisymmetric in r, z or plane strain in x, y', 'axisymmetric|plane_strain'), &
      key_t('scene', 'fields', 'w', 'u', 0, 0, 'unknowns; absent ones cost nothing', 'u|u-p_w|u-p_w-p_c'), &
      key_t('scene', 'pressures', 'w', 'quadratic', 0, 0, 'interpolation (linear: Taylor-Hood)', 'quadratic|linear'), &
      key_t('scene', 'quadrature', 'i', '6', 3, 12, 'points of an element: 3, 6, 7 or 12'), &
      key_t('scene', 'gravity', 'n', '0', 0, 1000, 'acceleration towards -z [m/s2]'), &
      key_t('scene', 'gravity_history', 't', NONE, 0, 0, 'name of a &history: factor on gravity'), &
      key_t('scene', 'effects', 'w', 'given', 0, 0, &
            'auto: pilots determine what the keys leave open, see host/README.md', 'given|auto'), &
      key_t('scene', 'effects_tolerance', 'n', '0.01', 1.0e-6_wp, 1, &
            'largest influence of an effect that is left out [-]'), &
      key_t('scene', 'effects_pilot_share', 'n', '0.1', 0, BIG, &
            'pilots of effects = ''auto'' may cost this share of the run [-]; else nothing is left out'), &
      key_t('scene', 'effects_on_warning', 'w', 'warn', 0, 0, &
            'action if an effect that pilots removed matters in the run', 'warn|stop'), &
      key_t('scene', 'without', 'W', NONE, 0, 0, 'effects that are taken out by hand', EFFECT_WORDS), &
      key_t('scene', 'seepage_inertia', 'w', 'no', 0, 0, 'acceleration of the skeleton in Darcy''s law', 'no|yes'), &
      key_t('scene', 'saturation_rate', 'w', 'full', 0, 0, &
            'rate of saturation by void ratio and suction, or by suction alone', 'full|suction'), &
      key_t('scene', 'initial_flow', 'w', 'drain', 0, 0, &
            'subtract: the initial flow is maintained', 'drain|subtract'), &
      key_t('scene', 'accuracy', 'n', NONE, 1.0e-8_wp, 0.5_wp, &
            'relative error wanted in the histories of the points [-], see host/README.md'), &
      key_t('scene', 'threads', 'i', '0', 0, 1024, 'threads over elements; 0: by size, at most OMP_NUM_THREADS'), &
      key_t('scene', 'factors', 'w', 'reuse', 0, 0, &
            'factors of the matrix: reused while they serve, or new in every iteration', 'reuse|fresh'), &
      key_t('scene', 'ordering', 'w', 'amd', 0, 0, 'ordering of the unknowns; best tries several', 'amd|metis|best'), &
      key_t('scene', 'checkpoint_steps', 'i', '0', 0, 1000000000, 'checkpoint.h5 after every so many steps; 0: none'), &
      key_t('scene', 'checkpoint_seconds', 'n', '0', 0, BIG, 'checkpoint.h5 after so much wall time [s]; 0: none'), &
      key_t('scene', 'checkpoint_end', 'w', 'no', 0, 0, 'checkpoint.h5 when the last stage ends', 'no|yes'), &
      key_t('mesh', 'file', 't', NONE, 0, 0, 'Gmsh 4.1 text mesh, relative to the scene; or r and z:'), &
      key_t('mesh', 'scale', 'n', '1', 1.0e-9_wp, 1.0e9_wp, &
            'factor on the coordinates of the file; 1e-3: they are in mm'), &
      key_t('mesh', 'r', 'N', NONE, -BIG, BIG, 'breaks along r [m], ascending'), &
      key_t('mesh', 'r_cells', 'I', NONE, 1, 100000, 'cells between two breaks of r'), &
      key_t('mesh', 'r_ratio', 'N', NONE, 0.01_wp, 100, 'size of a cell over that of the previous one; default 1'), &
      key_t('mesh', 'z', 'N', NONE, -BIG, BIG, 'breaks along z [m], ascending'), &
      key_t('mesh', 'z_cells', 'I', NONE, 1, 100000, 'cells between two breaks of z'), &
      key_t('mesh', 'z_ratio', 'N', NONE, 0.01_wp, 100, 'size of a cell over that of the previous one; default 1'), &
      key_t('fluids', 'k_w', 'n', '2.2e6', TINY_, BIG, 'bulk modulus of water [kPa]'), &
      key_t('fluids', 'rho_w', 'n', '1.0', 0, 1000, 'density of water [Mg/m3]'), &
      key_t('fluids', 'eta_w', 'n', '1.0e-6', TINY_, BIG, 'viscosity of water [kPa s]'), &
      key_t('fluids', 'gas', 'w', 'constant', 0, 0, 'ideal: K_a = p_ref + p_a, density as well', 'constant|ideal'), &
      key_t('fluids', 'k_a', 'n', '101.325', TINY_, BIG, 'bulk modulus of a constant gas [kPa]'), &
      key_t('fluids', 'rho_a', 'n', '1.2e-3', 0, 1000, 'density of air (ideal: at p_ref) [Mg/m3]'), &
      key_t('fluids', 'eta_a', 'n', '1.8e-8', TINY_, BIG, 'viscosity of air [kPa s]'), &
      key_t('fluids', 'p_ref', 'n', '101.325', TINY_, BIG, 'absolute pressure where p_a = 0 [kPa]'), &
      key_t('retention', 'name', 't', REQUIRED, 0, 0, 'name, for the key of &region'), &
      key_t('permeability', 'name', 't', REQUIRED, 0, 0, 'name, for the key of &region'), &
      key_t('permeability', 'intrinsic', 'n', REQUIRED, TINY_, 1, 'intrinsic permeability [m2]'), &
      key_t('permeability', 'law', 'w', 'corey', 0, 0, 'relative permeabilities', 'corey|mualem|power|constant'), &
      key_t('permeability', 's_min', 'n', '0.0', 0, 0.999_wp, 'S_w at which S_e = 0 [-]'), &
      key_t('permeability', 's_max', 'n', '1.0', 0.001_wp, 1, 'S_w at which S_e = 1 [-]'), &
      key_t('permeability', 'a', 'n', '0.0', 0, BIG, 'power: k_rw = 1 - a (1 - S_w)**b'), &
      key_t('permeability', 'b', 'n', '3.0', 1, 100, 'corey: k_rw = S_e**b; power: see a'), &
      key_t('permeability', 'c', 'n', '2.0', 1, 100, 'corey, power: k_ra = (1 - S_e)**2 (1 - S_e**c)'), &
      key_t('permeability', 'm', 'n', '0.5', 0.01_wp, 0.99_wp, 'exponent of Mualem-van Genuchten [-]'), &
      key_t('permeability', 'k_rw', 'n', '1.0', 0, 1, 'constant: relative permeability to water [-]'), &
      key_t('permeability', 'k_ra', 'n', '1.0', 0, 1, 'constant: relative permeability to air [-]'), &
      key_t('permeability', 'floor', 'n', '1.0e-4', 0, 1, 'least relative permeability [-]'), &
      key_t('region', 'group', 't', 'all', 0, 0, 'group of elements; without it those that no other region names'), &
      key_t('region', 'material', 't', REQUIRED, 0, 0, 'name of a material, as &mud or &elastic'), &
      key_t('region', 'retention', 't', NONE, 0, 0, 'name of a &retention, or "material": its own'), &
      key_t('region', 'permeability', 't', NONE, 0, 0, 'name of a &permeability'), &
      key_t('region', 'drainage', 'w', 'coupled', 0, 0, &
            'fluids flow, stay at given pressures, stay in every element, or are absent', &
            'coupled|drained|undrained|dry'), &
      key_t('region', 'rho_s', 'n', '2.65', 0, 1000, 'density of the grains [Mg/m3]'), &
      key_t('region', 'void_ratio', 'n', NONE, 0, 10, 'initial void ratio [-]; default: the material''s'), &
      key_t('region', 'damping', 'n', '0', 0, BIG, 'force against the velocity over mass, dynamic stages [1/s]'), &
      key_t('region', 'stiffness_damping', 'n', '0', 0, BIG, &
            'stress of the skeleton from its rate, dynamic stages [s]'), &
      key_t('initial', 'group', 't', 'all', 0, 0, 'group of elements or nodes'), &
      key_t('initial', 'p_w', 'n', '0', -BIG, BIG, 'pore water pressure at the datum [kPa]'), &
      key_t('initial', 'p_w_slope', 'n', '0', -BIG, BIG, 'change of p_w with z [kPa/m]'), &
      key_t('initial', 'p_c', 'n', '0', -BIG, BIG, 'suction at the datum [kPa]'), &
      key_t('initial', 'p_c_slope', 'n', '0', -BIG, BIG, 'change of p_c with z [kPa/m]'), &
      key_t('initial', 'saturation', 'n', NONE, 1.0e-6_wp, 1, &
            'S_w between the main curves, with hysteresis [-]; default: on the main drying curve'), &
      key_t('initial', 'datum', 'n', '0', -BIG, BIG, 'z of the datum [m]'), &
      key_t('initial', 'v_z', 'n', '0', -BIG, BIG, 'vertical velocity at the start [m/s]'), &
      key_t('initial', 'wave', 'n', '0', -BIG, BIG, 'v_z = wave sin(wave_number (z - datum)) at the start [m/s]'), &
      key_t('initial', 'wave_number', 'n', '0', 0, BIG, 'see wave [1/m]'), &
      key_t('initial', 'stress', 'w', 'none', 0, 0, 'effective stress at the start', 'none|uniform|geostatic'), &
      key_t('initial', 'sigma', 'N', NONE, -BIG, BIG, 'uniform: rr, zz, tt, tension positive [kPa]'), &
      key_t('initial', 'surface', 'n', '0', -BIG, BIG, 'geostatic: z of the surface [m]'), &
      key_t('initial', 'surcharge', 'n', '0', 0, BIG, 'geostatic: pressure on it [kPa]'), &
      key_t('initial', 'k_0', 'n', '0.5', 0, 10, 'geostatic: horizontal over vertical stress'), &
      key_t('initial', 'k_0_of', 'w', 'net', 0, 0, 'stress that K_0 acts on where p_c > 0', 'net|effective'), &
      key_t('history', 'name', 't', REQUIRED, 0, 0, 'name, for the key history of loads'), &
      key_t('history', 'times', 'N', NONE, -BIG, BIG, 'ascending [s]; straight lines between, constant outside'), &
      key_t('history', 'values', 'N', NONE, -BIG, BIG, 'factors at these times [-]'), &
      key_t('history', 'file', 't', NONE, 0, 0, 'instead: text file, a time and a factor in every line'), &
      key_t('stage', 'name', 't', REQUIRED, 0, 0, 'name of the stage'), &
      key_t('stage', 'analysis', 'w', NONE, 0, 0, &
            'kind of the stage; needed unless effects = ''auto''', 'static|quasi_static|dynamic'), &
      key_t('stage', 'duration', 'n', REQUIRED, TINY_, BIG, 'duration [s]'), &
      key_t('stage', 'dt', 'n', NONE, TINY_, BIG, 'time step [s]; where steps are controlled the first one'), &
      key_t('stage', 'steps', 'w', NONE, 0, 0, &
            'given: dt; controlled: by their error, default with accuracy or without dt', 'given|controlled'), &
      key_t('stage', 'output_dt', 'n', NONE, TINY_, BIG, 'controlled steps end at multiples of it, with fields [s]'), &
      key_t('stage', 'dt_growth', 'n', '1', 1, 10, 'factor on the step after every accepted one'), &
      key_t('stage', 'dt_max', 'n', NONE, TINY_, BIG, 'largest step with dt_growth [s]'), &
      key_t('stage', 'cuts', 'i', '10', 0, 40, 'how often a step may be halved'), &
      key_t('stage', 'rho_inf', 'n', NONE, 0, 1, &
            'spectral radius of generalised-alpha [-]; default 0.8, dynamic with contact 0'), &
      key_t('stage', 'created_energy', 'n', '0.01', TINY_, BIG, &
            'energy created out of nothing that ends the run, share of the largest work [-]'), &
      key_t('stage', 'tolerance', 'n', '1.0e-3', 1.0e-14_wp, 0.1_wp, 'Newton: error that ends the iteration [-]'), &
      key_t('stage', 'measure', 'w', 'auto', 0, 0, &
            'measure of the error that ends the iteration, see host/README.md', &
            'forces|residual|correction|change|auto'), &
      key_t('stage', 'max_iterations', 'i', '12', 1, 1000, 'Newton: linear solves before the step is cut'), &
      key_t('stage', 'predictor', 'w', 'rates', 0, 0, 'start of the iteration', 'rates|none'), &
      key_t('stage', 'start', 'w', 'solve', 0, 0, 'accelerations at the start of a dynamic stage', 'solve|zero'), &
      key_t('stage', 'zero_displacements', 'w', 'no', 0, 0, &
            'displacements are set to zero at the end of the stage', 'no|yes'), &
      key_t('stage', 'every', 'i', '1', 1, 1000000, 'histories are written every so many steps'), &
      key_t('stage', 'fields', 'i', '0', 0, 1000000, &
            'fields are written every so many steps; 0: at the end; without: controlled steps at 50 times'), &
      key_t('fix', 'group', 't', REQUIRED, 0, 0, 'boundary, region or node group'), &
      key_t('fix', 'field', 'w', REQUIRED, 0, 0, 'what is prescribed', 'u_r|u_z|p_w|p_c|p_a'), &
      key_t('fix', 'value', 'n', '0', -BIG, BIG, 'prescribed value, at the datum [m, kPa]'), &
      key_t('fix', 'value_slope', 'n', '0', -BIG, BIG, 'change of the value with z [-, kPa/m]'), &
      key_t('fix', 'datum', 'n', '0', -BIG, BIG, 'z of the datum [m]'), &
      key_t('fix', 'history', 't', NONE, 0, 0, 'factor on the value'), &
      key_t('fix', 'hold', 'w', 'no', 0, 0, 'yes: held at its value at the start of the stage', 'no|yes'), &
      key_t('fix', 'motion', 'w', 'value', 0, 0, &
            'what the value of u_r, u_z is: displacement, or acceleration [m/s2]', 'value|acceleration'), &
      key_t('fix', 'stages', 'T', NONE, 0, 0, 'names of stages; default: all'), &
      key_t('fix', 'from', 'n', NONE, -BIG, BIG, 'acts after this time [s]'), &
      key_t('fix', 'until', 'n', NONE, -BIG, BIG, 'acts up to this time [s]'), &
      key_t('load', 'group', 't', REQUIRED, 0, 0, 'boundary (for force: node group)'), &
      key_t('load', 'kind', 'w', REQUIRED, 0, 0, &
            'kind of load, see host/README.md', 'pressure|shear_r|shear_z|water|air|force_r|force_z'), &
      key_t('load', 'value', 'n', REQUIRED, -BIG, BIG, 'value of the load, at the datum [kPa, m/s, kN]'), &
      key_t('load', 'value_slope', 'n', '0', -BIG, BIG, 'change of the value with z [kPa/m, 1/s, kN/m]'), &
      key_t('load', 'datum', 'n', '0', -BIG, BIG, 'z of the datum [m]'), &
      key_t('load', 'history', 't', NONE, 0, 0, 'factor on the value'), &
      key_t('load', 'stages', 'T', NONE, 0, 0, 'names of stages; default: all'), &
      key_t('absorbing', 'group', 't', REQUIRED, 0, 0, 'boundary that lets waves out, in dynamic stages'), &
      key_t('absorbing', 'rho', 'n', NONE, TINY_, 1000, &
            'density of the ground behind the boundary [Mg/m3]; default: the soil'), &
      key_t('absorbing', 'c_p', 'n', NONE, TINY_, BIG, &
            'speed of pressure waves behind the boundary [m/s]; default: the soil''s'), &
      key_t('absorbing', 'c_s', 'n', NONE, TINY_, BIG, &
            'speed of shear waves behind the boundary [m/s]; default: the soil''s'), &
      key_t('absorbing', 'v_r', 'n', '0', -BIG, BIG, 'velocity along r of the incoming wave [m/s]'), &
      key_t('absorbing', 'v_z', 'n', '0', -BIG, BIG, 'velocity along z of the incoming wave [m/s]'), &
      key_t('absorbing', 'history', 't', NONE, 0, 0, 'factor on v_r and v_z'), &
      key_t('absorbing', 'stages', 'T', NONE, 0, 0, 'names of stages; default: all'), &
      key_t('tie', 'first', 't', REQUIRED, 0, 0, 'first boundary: nodes at equal heights move together'), &
      key_t('tie', 'second', 't', REQUIRED, 0, 0, 'second boundary, with nodes at the same heights'), &
      key_t('tie', 'pressures', 'w', 'no', 0, 0, 'pore pressures of the nodes are equal as well', 'no|yes'), &
      key_t('plate', 'name', 't', REQUIRED, 0, 0, 'rigid plate, vertical; also a group for &fix and &load'), &
      key_t('plate', 'r', 'N', NONE, -BIG, BIG, 'begin and end of the plate''s own flat face [m]; or give group'), &
      key_t('plate', 'group', 't', NONE, 0, 0, 'boundary of the mesh that moves with the plate; or give r'), &
      key_t('plate', 'z', 'n', '0', -BIG, BIG, 'height of the plate''s own face at the start [m]'), &
      key_t('plate', 'face', 'w', 'down', 0, 0, 'direction of the plate''s own face', 'down|up'), &
      key_t('plate', 'mass', 'n', REQUIRED, TINY_, BIG, 'mass of the plate [Mg]'), &
      key_t('plate', 'weight', 'w', 'no', 0, 0, &
            'the weight acts, and the plate starts in balance on its contact', 'no|yes'), &
      key_t('plate', 'force', 'n', '0', -BIG, BIG, 'force on the plate, upwards [kN]'), &
      key_t('plate', 'history', 't', NONE, 0, 0, 'factor on the force'), &
      key_t('contact', 'name', 't', REQUIRED, 0, 0, 'name in contact.csv'), &
      key_t('contact', 'slave', 't', REQUIRED, 0, 0, 'boundary that is integrated over: the softer or finer one'), &
      key_t('contact', 'master', 't', REQUIRED, 0, 0, 'boundary opposite, or name of a &plate'), &
      key_t('contact', 'penalty', 'n', '1.0e8', TINY_, BIG, 'pressure of a unit of penetration [kN/m3]'), &
      key_t('contact', 'gap', 'w', 'combined', 0, 0, 'gap that is penalised, see CONTACT.md', &
            'nodal|pointwise|combined'), &
      key_t('contact', 'search_radius', 'n', '0', 0, BIG, &
            'edges farther apart are not paired [m]; 0: length of the slave edge'), &
      key_t('contact', 'drainage', 'w', 'fixed', 0, 0, &
            'state: nodes in contact are released from &fix of pressures', 'fixed|state'), &
      key_t('contact', 'stages', 'T', NONE, 0, 0, 'names of stages; default: all'), &
      key_t('point', 'name', 't', REQUIRED, 0, 0, 'name in histories.csv'), &
      key_t('point', 'r', 'n', REQUIRED, -BIG, BIG, 'the nearest node is taken [m]'), &
      key_t('point', 'z', 'n', REQUIRED, -BIG, BIG, 'the nearest node is taken [m]')]
   character(*), parameter :: LAW_NAME = 'name, for the key material of &region'
   type(key_t), parameter :: KEYS(*) = [key_t :: OWN_KEYS, RETENTION_KEYS]
contains
   !> Refuses unknown groups and keys, missing ones, and values of the wrong kind or outside their range. Fault
   !> EXIT_INPUT, at the first. Keys of laws are checked where they are built.
   subroutine check_keys(groups, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      type(fault_t), intent(inout) :: fault
      character(12), allocatable :: names(:)
      integer :: g

      do g = 1, size(groups)
         if (is_law(groups(g)%name)) then
            ! The law checks its own keys when it is built.
            if (.not. given(groups(g), 'name')) call raise(fault, EXIT_INPUT, at_line(groups(g)%file, &
               groups(g)%line)//'&'//trim(groups(g)%name)//' needs name ('//LAW_NAME//').')
         else if (.not. any(KEYS%group == groups(g)%name)) then
            names = [KEYS%group, law_names()]
            call raise(fault, EXIT_INPUT, at_line(groups(g)%file, groups(g)%line)//'there is no group &'// &
                       trim(groups(g)%name)//'; the nearest is &'// &
                       trim(names(nearest_name(groups(g)%name, names)))//'.')
         else
            call check_group(KEYS, groups(g), .false., fault)
         end if
         if (fault%code /= 0) return
      end do
   end subroutine check_keys

   !> Number of a word among the words of its key, from 1; 0 where the key has no value.
   integer function word_number(group, name) result(number)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name

      number = findloc(words_of(KEYS(place_of(KEYS, group%name, name))), lower_case(text_of(group, name)), dim=1)
   end function word_number

   !> Value of a number, or its default (0 if it has none). In the unit of the key.
   real(wp) function number_of(group, name)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name

      number_of = schema_number_of(KEYS, group, name)
   end function number_of

   !> A text, or its default.
   function text_of(group, name) result(text)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      character(:), allocatable :: text

      text = schema_text_of(KEYS, group, name)
   end function text_of

   !> Whether the value of a key (its default where it is not given) is this word; case is ignored.
   logical function word_is(group, name, word)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name, word

      word_is = schema_word_is(KEYS, group, name, word)
   end function word_is

   !> Every key with its default and meaning, as a scene to start from.
   subroutine print_template(unit)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(key_t), allocatable :: all_keys(:)
      character(12), allocatable :: laws(:)
      integer :: g, k

      allocate (all_keys, source=KEYS)
      laws = law_names()
      do g = 1, size(laws)
         all_keys = [all_keys, key_t(laws(g), 'name', 't', REQUIRED, 0, 0, LAW_NAME), law_keys(laws(g))]
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
