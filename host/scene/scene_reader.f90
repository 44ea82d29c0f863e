! SPDX-License-Identifier: MIT
!> Reads a scene: groups in any order, every key checked against the list of keys, before anything is built.
module scene_reader
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use material_registry, only: is_law
   use namelists, only: group_t, read_groups, LENGTH
   use exit_codes, only: EXIT_GROUP
   use scene_fingerprint, only: fingerprint_of, sealed
   use scene_accuracy, only: ask_accuracy, ask_steps, ask_stress
   use scene_amplitudes, only: read_amplitude
   use key_schema, only: get_text, numbers_of, texts_of, given
   use scene_keys, only: check_keys, number_of, text_of, word_is, word_number
   use scene_names, only: check_names
   use texts, only: lower_case
   use scene_types, only: scene_t, scene_item_t, scene_law_t, scene_amplitude_t, scene_region_t, scene_initial_t, &
                          scene_stage_t, scene_fix_t, scene_load_t, scene_plate_t, scene_contact_t, scene_point_t, &
                          scene_absorber_t, scene_tie_t, place_of
   implicit none (type, external)
   private
   public :: read_scene
contains
   !> Reads and checks a scene; a fault names file, line, value, range and the nearest name. Fault EXIT_INPUT: the file
   !> cannot be read, or a group, key or value is refused; EXIT_GROUP: a stage that nobody defines.
   subroutine read_scene(file, scene, fault, accuracy)
      character(*), intent(in) :: file
      type(scene_t), intent(out) :: scene
      type(fault_t), intent(inout) :: fault
      character(*), intent(in), optional :: accuracy   !< In place of that of the scene; empty: none.
      type(group_t), allocatable :: groups(:)
      type(scene_amplitude_t) :: amplitude
      integer :: i

      call read_groups(file, groups, fault)
      if (present(accuracy) .and. fault%code == 0) call ask_accuracy(accuracy, groups)
      if (fault%code == 0) call check_keys(groups, fault)
      if (fault%code == 0) call check_names(groups, fault)
      if (fault%code == 0) call check_counts(file, groups, fault)
      if (fault%code /= 0) return
      scene%file = file
      scene%fingerprint = fingerprint_of(groups)
      scene%groups = sealed(groups)
      allocate (scene%materials(0), scene%retentions(0), scene%permeabilities(0), scene%regions(0), &
                scene%initials(0), scene%amplitudes(0), scene%stages(0), scene%fixes(0), scene%loads(0), &
                scene%plates(0), scene%contacts(0), scene%absorbers(0), scene%ties(0), scene%points(0))
      do i = 1, size(groups)
         if (groups(i)%name == 'scene') call take_scene(groups(i), scene)
      end do
      do i = 1, size(groups)
         if (fault%code /= 0) return
         associate (group => groups(i))
            select case (group%name)
            case ('mesh')
               call take_mesh(group, scene)
            case ('fluids')
               call take_fluids(group, scene)
            case ('retention')
               call take_law(group, scene%retentions)
            case ('permeability')
               call take_law(group, scene%permeabilities)
            case ('history')
               call read_amplitude(group, amplitude, fault)
               scene%amplitudes = [scene%amplitudes, amplitude]
            case ('stage')
               call take_stage(group, scene, fault)
            case ('region')
               call take_region(group, scene)
            case ('initial')
               call take_initial(group, scene, fault)
            case ('fix')
               call take_fix(group, scene)
            case ('load')
               call take_load(group, scene)
            case ('plate')
               call take_plate(group, scene, fault)
            case ('contact')
               call take_contact(group, scene)
            case ('absorbing')
               call take_absorber(group, scene)
            case ('tie')
               call take_tie(group, scene)
            case ('point')
               call take_point(group, scene)
            case default
               if (is_law(group%name)) then
                  call take_law(group, scene%materials)
                  call ask_stress(scene%accuracy, scene%materials(size(scene%materials))%group)
               end if
            end select
         end associate
      end do
      if (fault%code == 0) call check_stages(scene, fault)
   end subroutine read_scene

   !> Groups that occur once, and those without which there is nothing to do.
   subroutine check_counts(file, groups, fault)
      character(*), intent(in) :: file
      type(group_t), intent(in) :: groups(:)
      type(fault_t), intent(inout) :: fault
      character(6), parameter :: ONCE(3) = ['scene ', 'mesh  ', 'fluids'], NEEDED(4) = ['scene ', 'mesh  ', 'region', &
                                                                                        'stage ']
      integer :: i, k

      do k = 1, size(ONCE)
         if (count([(groups(i)%name == ONCE(k), i=1, size(groups))]) > 1) call raise(fault, EXIT_INPUT, trim(file)// &
            ': &'//trim(ONCE(k))//' is given more than once; keep one.')
      end do
      do k = 1, size(NEEDED)
         if (.not. any([(groups(i)%name == NEEDED(k), i=1, size(groups))])) call raise(fault, EXIT_INPUT, trim(file)// &
            ': the group &'//trim(NEEDED(k))//' is missing; mud_host --template prints every group.')
      end do
   end subroutine check_counts

   !> Names of stages that nobody defines.
   subroutine check_stages(scene, fault)
      type(scene_t), intent(in) :: scene
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(scene%fixes)
         call check(scene%fixes(i)%scene_item_t, scene%fixes(i)%stages)
      end do
      do i = 1, size(scene%loads)
         call check(scene%loads(i)%scene_item_t, scene%loads(i)%stages)
      end do
      do i = 1, size(scene%absorbers)
         call check(scene%absorbers(i)%scene_item_t, scene%absorbers(i)%stages)
      end do
      do i = 1, size(scene%contacts)
         call check(scene%contacts(i)%scene_item_t, scene%contacts(i)%stages)
      end do
   contains
      subroutine check(item, names)
         type(scene_item_t), intent(in) :: item
         character(*), intent(in) :: names(:)
         integer :: k

         do k = 1, size(names)
            if (any(scene%stages%name == names(k)) .or. fault%code /= 0) cycle
            call raise(fault, EXIT_GROUP, place_of(item)//'there is no stage '''//trim(names(k))//'''.')
         end do
      end subroutine check
   end subroutine check_stages

   subroutine take_law(group, laws)
      type(group_t), intent(in) :: group
      type(scene_law_t), allocatable, intent(inout) :: laws(:)
      type(scene_law_t) :: law
      character(LENGTH) :: name

      name = ''
      call get_text(group, 'name', name)
      law%name = name(:len(law%name))   ! scene_names has checked its length
      law%group = group
      laws = [laws, law]
   end subroutine take_law

   pure function item_of(group) result(item)
      type(group_t), intent(in) :: group
      type(scene_item_t) :: item

      item = scene_item_t(group%file, group%line)
   end function item_of

   subroutine take_scene(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene

      scene%name = text_of(group, 'name')
      scene%axisymmetric = word_is(group, 'geometry', 'axisymmetric')
      scene%fields = word_number(group, 'fields')
      scene%linear_pressures = word_is(group, 'pressures', 'linear')
      scene%quadrature = nint(number_of(group, 'quadrature'))
      scene%gravity = number_of(group, 'gravity')
      scene%gravity_history = text_of(group, 'gravity_history')
      scene%seepage_inertia = word_is(group, 'seepage_inertia', 'yes')
      scene%full_saturation_rate = word_is(group, 'saturation_rate', 'full')
      scene%subtract_flow = word_is(group, 'initial_flow', 'subtract')
      scene%threads = nint(number_of(group, 'threads'))
      scene%reuse_factors = word_is(group, 'factors', 'reuse')
      scene%ordering = word_number(group, 'ordering')
      if (given(group, 'accuracy')) scene%accuracy = number_of(group, 'accuracy')
      scene%checkpoint_steps = nint(number_of(group, 'checkpoint_steps'))
      scene%checkpoint_seconds = number_of(group, 'checkpoint_seconds')
      scene%checkpoint_end = word_is(group, 'checkpoint_end', 'yes')
      scene%derive_effects = word_is(group, 'effects', 'auto')
      scene%effects_tolerance = number_of(group, 'effects_tolerance')
      scene%effects_pilot_share = number_of(group, 'effects_pilot_share')
      scene%stop_on_warning = word_is(group, 'effects_on_warning', 'stop')
      scene%without = lower_case(texts_of(group, 'without'))
      scene%fields_by_hand = given(group, 'fields') .or. .not. scene%derive_effects
      scene%gravity_by_hand = given(group, 'gravity') .or. scene%gravity_history /= '' .or. .not. scene%derive_effects
      scene%seepage_by_hand = given(group, 'seepage_inertia') .or. .not. scene%derive_effects
   end subroutine take_scene

   subroutine take_mesh(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene

      associate (mesh => scene%mesh)
         mesh%scene_item_t = item_of(group)
         if (given(group, 'file')) mesh%mesh_file = beside(group, text_of(group, 'file'))
         mesh%scale = number_of(group, 'scale')
         mesh%scale_given = given(group, 'scale')
         mesh%r = numbers_of(group, 'r')
         mesh%z = numbers_of(group, 'z')
         mesh%r_cells = nint(numbers_of(group, 'r_cells'))
         mesh%z_cells = nint(numbers_of(group, 'z_cells'))
         mesh%r_ratio = numbers_of(group, 'r_ratio')
         mesh%z_ratio = numbers_of(group, 'z_ratio')
         if (size(mesh%r_ratio) == 0) mesh%r_ratio = spread(1.0_wp, 1, size(mesh%r_cells))
         if (size(mesh%z_ratio) == 0) mesh%z_ratio = spread(1.0_wp, 1, size(mesh%z_cells))
      end associate
   end subroutine take_mesh

   !> A path that is relative to the file of the scene.
   pure function beside(group, name) result(path)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      character(:), allocatable :: path

      path = name
      if (index(name, '/') /= 1) path = group%file(:index(group%file, '/', back=.true.))//name
   end function beside

   subroutine take_fluids(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene

      associate (f => scene%fluids)
         f%k_w = number_of(group, 'k_w')
         f%rho_w = number_of(group, 'rho_w')
         f%eta_w = number_of(group, 'eta_w')
         f%k_a = number_of(group, 'k_a')
         f%rho_a = number_of(group, 'rho_a')
         f%eta_a = number_of(group, 'eta_a')
         f%p_ref = number_of(group, 'p_ref')
         f%ideal_gas = word_is(group, 'gas', 'ideal')
      end associate
   end subroutine take_fluids

   subroutine take_stage(group, scene, fault)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      type(scene_stage_t) :: stage

      stage%name = text_of(group, 'name')
      stage%analysis = word_number(group, 'analysis')
      if (stage%analysis == 0 .and. .not. scene%derive_effects) call raise(fault, EXIT_INPUT, &
         at_line(group%file, group%line)//'&stage needs analysis (static, quasi_static or dynamic); '// &
         'effects = ''auto'' in &scene would find it out.')
      stage%duration = number_of(group, 'duration')
      stage%dt_growth = number_of(group, 'dt_growth')
      if (given(group, 'dt_max')) stage%dt_max = number_of(group, 'dt_max')
      stage%cuts = nint(number_of(group, 'cuts'))
      if (given(group, 'rho_inf')) stage%rho_inf = number_of(group, 'rho_inf')
      stage%created_energy = number_of(group, 'created_energy')
      stage%tolerance = number_of(group, 'tolerance')
      call ask_steps(group, scene%accuracy, stage, fault)
      stage%measure_number = word_number(group, 'measure')
      stage%max_iterations = nint(number_of(group, 'max_iterations'))
      stage%every = nint(number_of(group, 'every'))
      stage%fields = nint(number_of(group, 'fields'))
      stage%film = .not. (given(group, 'fields') .or. given(group, 'output_dt'))
      stage%no_predictor = word_is(group, 'predictor', 'none')
      stage%solve_start = word_is(group, 'start', 'solve')
      stage%zero_displacements = word_is(group, 'zero_displacements', 'yes')
      scene%stages = [scene%stages, stage]
   end subroutine take_stage

   subroutine take_region(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(scene_region_t) :: region

      region%scene_item_t = item_of(group)
      region%group_name = text_of(group, 'group')
      region%rest = .not. given(group, 'group')
      region%material_name = text_of(group, 'material')
      region%retention_name = text_of(group, 'retention')
      region%permeability_name = text_of(group, 'permeability')
      region%drainage = word_number(group, 'drainage')
      region%rho_s = number_of(group, 'rho_s')
      region%damping = number_of(group, 'damping')
      region%stiffness_damping = number_of(group, 'stiffness_damping')
      if (given(group, 'void_ratio')) region%void_ratio = number_of(group, 'void_ratio')
      scene%regions = [scene%regions, region]
   end subroutine take_region

   subroutine take_initial(group, scene, fault)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      type(scene_initial_t) :: initial

      initial%scene_item_t = item_of(group)
      initial%group_name = text_of(group, 'group')
      initial%p_w = number_of(group, 'p_w')
      initial%p_w_slope = number_of(group, 'p_w_slope')
      initial%p_c = number_of(group, 'p_c')
      initial%p_c_slope = number_of(group, 'p_c_slope')
      initial%saturation = number_of(group, 'saturation')
      initial%datum = number_of(group, 'datum')
      initial%v_z = number_of(group, 'v_z')
      initial%wave = number_of(group, 'wave')
      initial%wave_number = number_of(group, 'wave_number')
      initial%uniform = word_is(group, 'stress', 'uniform')
      initial%geostatic = word_is(group, 'stress', 'geostatic')
      associate (sigma => numbers_of(group, 'sigma'))
         if (initial%uniform .and. size(sigma) /= 3) then
            call raise(fault, EXIT_INPUT, place_of(initial)//'a uniform stress needs sigma = rr, zz, tt.')
         else if (initial%uniform) then
            initial%sigma = sigma
         end if
      end associate
      initial%surface = number_of(group, 'surface')
      initial%surcharge = number_of(group, 'surcharge')
      initial%k_0 = number_of(group, 'k_0')
      initial%net = word_is(group, 'k_0_of', 'net')
      scene%initials = [scene%initials, initial]
   end subroutine take_initial

   subroutine take_fix(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(scene_fix_t) :: fix

      fix%scene_item_t = item_of(group)
      fix%group_name = text_of(group, 'group')
      fix%amplitude_name = text_of(group, 'history')
      fix%field_number = word_number(group, 'field')
      fix%value = number_of(group, 'value')
      fix%value_slope = number_of(group, 'value_slope')
      fix%datum = number_of(group, 'datum')
      fix%hold = word_is(group, 'hold', 'yes')
      fix%acceleration = word_is(group, 'motion', 'acceleration')
      fix%stages = texts_of(group, 'stages')
      if (given(group, 'from')) fix%from = number_of(group, 'from')
      if (given(group, 'until')) fix%until = number_of(group, 'until')
      scene%fixes = [scene%fixes, fix]
   end subroutine take_fix

   subroutine take_load(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(scene_load_t) :: load

      load%scene_item_t = item_of(group)
      load%group_name = text_of(group, 'group')
      load%amplitude_name = text_of(group, 'history')
      load%kind = word_number(group, 'kind')
      load%value = number_of(group, 'value')
      load%value_slope = number_of(group, 'value_slope')
      load%datum = number_of(group, 'datum')
      load%stages = texts_of(group, 'stages')
      scene%loads = [scene%loads, load]
   end subroutine take_load

   subroutine take_plate(group, scene, fault)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      type(scene_plate_t) :: plate

      plate%scene_item_t = item_of(group)
      plate%name = text_of(group, 'name')
      plate%amplitude_name = text_of(group, 'history')
      plate%joined_name = text_of(group, 'group')
      associate (r => numbers_of(group, 'r'))
         if (given(group, 'group') .eqv. given(group, 'r')) then
            call raise(fault, EXIT_INPUT, place_of(plate)//'a plate has a face of its own, r = begin, end, or '// &
                       'it is joined to a boundary, group = name: give one of the two.')
         else if (given(group, 'r') .and. size(r) /= 2) then
            call raise(fault, EXIT_INPUT, place_of(plate)//'a plate needs r = begin, end, ascending.')
         else if (given(group, 'r')) then
            plate%r = r
            if (.not. plate%r(2) > plate%r(1) .or. (scene%axisymmetric .and. plate%r(1) < 0.0_wp)) call raise( &
               fault, EXIT_INPUT, place_of(plate)//'a plate needs r = begin, end, ascending and, in axial '// &
               'symmetry, not negative.')
         end if
      end associate
      plate%z = number_of(group, 'z')
      plate%up = word_is(group, 'face', 'up')
      plate%mass = number_of(group, 'mass')
      plate%heavy = word_is(group, 'weight', 'yes')
      plate%force = number_of(group, 'force')
      scene%plates = [scene%plates, plate]
   end subroutine take_plate

   subroutine take_contact(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(scene_contact_t) :: contact

      contact%scene_item_t = item_of(group)
      contact%name = text_of(group, 'name')
      contact%slave_name = text_of(group, 'slave')
      contact%master_name = text_of(group, 'master')
      contact%penalty = number_of(group, 'penalty')
      contact%search_radius = number_of(group, 'search_radius')
      contact%gap_number = word_number(group, 'gap')
      contact%drains_by_state = word_is(group, 'drainage', 'state')
      contact%stages = texts_of(group, 'stages')
      scene%contacts = [scene%contacts, contact]
   end subroutine take_contact

   subroutine take_absorber(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(scene_absorber_t) :: absorber

      absorber%scene_item_t = item_of(group)
      absorber%group_name = text_of(group, 'group')
      absorber%amplitude_name = text_of(group, 'history')
      absorber%rho = number_of(group, 'rho')
      absorber%c_p = number_of(group, 'c_p')
      absorber%c_s = number_of(group, 'c_s')
      absorber%incoming = [number_of(group, 'v_r'), number_of(group, 'v_z')]
      absorber%stages = texts_of(group, 'stages')
      scene%absorbers = [scene%absorbers, absorber]
   end subroutine take_absorber

   subroutine take_tie(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(scene_tie_t) :: tie

      tie%scene_item_t = item_of(group)
      tie%first_name = text_of(group, 'first')
      tie%second_name = text_of(group, 'second')
      tie%pressures = word_is(group, 'pressures', 'yes')
      scene%ties = [scene%ties, tie]
   end subroutine take_tie

   subroutine take_point(group, scene)
      type(group_t), intent(in) :: group
      type(scene_t), intent(inout) :: scene
      type(scene_point_t) :: point

      point%name = text_of(group, 'name')
      point%x = [number_of(group, 'r'), number_of(group, 'z')]
      scene%points = [scene%points, point]
   end subroutine take_point
end module scene_reader
