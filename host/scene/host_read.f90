!> Reads a scene: groups in any order, names resolved, everything checked before anything is computed.
module host_read
   use exit_codes, only: EXIT_GROUP, EXIT_MESH
   use kinds, only: wp
   use scene_fingerprint, only: fingerprint_of
   use scene_keys, only: check_keys, number_of, numbers_of, text_of, texts_of, word_is, given
   use host_laws, only: read_mud, read_elastic, read_retention, read_permeability, retention_of_mud
   use scene_names, only: check_names
   use model_types, only: model_t, stage_t, fix_t, load_t, rigid_t, history_t, initial_t, point_t, plate_t, &
                          touching_t, &
                         acts_in, P_A, LOAD_KINDS
   use contact_types, only: NODAL_GAP, POINTWISE_GAP, PRESSURE_WORK, ENERGY_SLOPE
   use porous_domain, only: region_t, prepare_domain
   use fe_mud, only: mud_t
   use permeability_laws, only: permeability_t
   use shape_functions, only: RULES
   use gmsh_reader, only: read_gmsh
   use graded_rectangle, only: graded_mesh
   use triangle_mesh, only: find_group, add_group
   use newton_step, only: MEASURES
   use generalised_alpha, only: STATIC, QUASI_STATIC, DYNAMIC
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use namelists, only: group_t, read_groups
   use texts, only: lower_case, short, whole, read_number
   implicit none (type, external)
   private
   public :: read_scene
contains
   subroutine read_scene(file, model, fault)
      character(*), intent(in) :: file
      type(model_t), intent(out) :: model
      type(fault_t), intent(inout) :: fault
      type(group_t), allocatable :: groups(:)
      integer :: i

      call read_groups(file, groups, fault)
      if (fault%code == 0) call check_keys(groups, fault)
      if (fault%code == 0) call check_names(groups, fault)
      if (fault%code == 0) call check_single(file, groups, fault)
      if (fault%code == 0) model%fingerprint = fingerprint_of(groups)
      do i = 1, size(groups)
         if (groups(i)%name == 'scene') model%effects%auto = word_is(groups(i), 'effects', 'auto')
      end do
      allocate (model%histories(0), model%initials(0), model%stages(0), model%fixes(0), model%loads(0), &
                model%rigids(0), model%points(0), model%plates(0), model%contacts(0))
      ! Lists of different laws get their size at once: they cannot grow by array constructors.
      allocate (model%domain%materials(count([(groups(i)%name == 'mud' .or. groups(i)%name == 'elastic', &
                                              i=1, size(groups))])))
      allocate (model%domain%retentions(count([(groups(i)%name == 'retention' .or. groups(i)%name == 'region', &
                                               i=1, size(groups))])))
      allocate (model%domain%permeabilities(0), model%domain%regions(0))
      ! What others name comes first.
      do i = 1, size(groups)
         if (fault%code /= 0) return
         select case (groups(i)%name)
         case ('scene')
            call take_scene(groups(i), groups, model, fault)
         case ('mesh')
            call take_mesh(groups(i), model, fault)
         case ('fluids')
            call take_fluids(groups(i), model)
         case ('mud', 'elastic', 'retention', 'permeability')
            call take_law(groups(i), model, fault)
         case ('history')
            call take_history(groups(i), model, fault)
         case ('stage')
            call take_stage(groups(i), model, fault)
         end select
      end do
      if (fault%code /= 0) return
      allocate (model%domain%bodies(0))
      do i = 1, size(groups)
         if (groups(i)%name == 'plate' .and. fault%code == 0) call take_plate(groups(i), model, fault)
      end do
      if (fault%code /= 0) return
      allocate (model%domain%region_of(size(model%domain%mesh%t6, 2)), source=0)
      do i = 1, size(groups)
         if (fault%code /= 0) return
         select case (groups(i)%name)
         case ('region')
            call take_region(groups(i), model, fault)
         case ('initial')
            call take_initial(groups(i), model, fault)
         case ('fix')
            call take_fix(groups(i), model, fault)
         case ('load')
            call take_load(groups(i), model, fault)
         case ('rigid')
            call take_rigid(groups(i), model, fault)
         case ('contact')
            call take_contact(groups(i), model, fault)
         end select
      end do
      if (fault%code /= 0) return
      if (any(model%domain%region_of == 0)) then
         call raise(fault, EXIT_GROUP, trim(file)//': element '//whole(findloc(model%domain%region_of, 0, dim=1))// &
                    ' belongs to no &region; add one with its group, or with group = ''all''.')
         return
      end if
      call prepare_domain(model%domain, fault)
      if (fault%code /= 0) return
      do i = 1, size(groups)
         if (groups(i)%name == 'point') call take_point(groups(i), model)
      end do
   end subroutine read_scene

   !> Groups that occur once, and those without which there is nothing to do.
   subroutine check_single(file, groups, fault)
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
            ': there is no &'//trim(NEEDED(k))//'; mud_host --template prints every group.')
      end do
   end subroutine check_single

   subroutine take_scene(group, groups, model, fault)
      type(group_t), intent(in) :: group, groups(:)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      real(wp), parameter :: EARTH = 9.81_wp   !< [m/s2] Where gravity is to be derived.

      model%name = text_of(group, 'name')
      associate (m => model%domain)
         m%axisymmetric = word_is(group, 'geometry', 'axisymmetric')
         m%with_c = word_is(group, 'fields', 'u-p_w-p_c')
         m%with_w = m%with_c .or. word_is(group, 'fields', 'u-p_w')
         associate (effects => model%effects)
            effects%tolerance = number_of(group, 'effects_tolerance')
            effects%fields_by_hand = given(group, 'fields') .or. .not. effects%auto
            effects%gravity_by_hand = given(group, 'gravity') .or. .not. effects%auto
            effects%seepage_by_hand = given(group, 'seepage_inertia') .or. .not. effects%auto
            ! All that the regions have laws for; what of it matters is derived later.
            if (.not. effects%fields_by_hand) then
               m%with_c = any_region(groups, 'retention')
               m%with_w = m%with_c .or. any_region(groups, 'permeability')
            end if
         end associate
         m%n_p = merge(6, 3, word_is(group, 'pressures', 'quadratic'))
         m%rule = nint(number_of(group, 'quadrature'))
         m%gravity = number_of(group, 'gravity')
         if (.not. model%effects%gravity_by_hand) m%gravity = EARTH
         m%seepage_inertia = word_is(group, 'seepage_inertia', 'yes')
         m%full_rate = word_is(group, 'saturation_rate', 'full')
         m%threads = nint(number_of(group, 'threads'))
         model%reuse_factors = word_is(group, 'factors', 'reuse')
         model%ordering = findloc([character(5) :: 'amd', 'metis', 'best'], lower_case(text_of(group, 'ordering')), 1)
         model%checkpoint_steps = nint(number_of(group, 'checkpoint_steps'))
         model%checkpoint_seconds = number_of(group, 'checkpoint_seconds')
         model%subtract_flow = word_is(group, 'initial_flow', 'subtract')
         if (.not. any(RULES == m%rule)) call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
            'quadrature = '//whole(m%rule)//': there are rules of 3, 6, 7 and 12 points.')
      end associate
   end subroutine take_scene

   logical function any_region(groups, key)
      type(group_t), intent(in) :: groups(:)
      character(*), intent(in) :: key
      integer :: i

      any_region = any([(groups(i)%name == 'region' .and. given(groups(i), key), i=1, size(groups))])
   end function any_region

   subroutine take_mesh(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      real(wp), parameter :: MOST_ELEMENTS = 5.0e6_wp   !< Of a built-in mesh: entries of the matrix stay countable.
      character(:), allocatable :: path
      real(wp), allocatable :: r(:), z(:), r_ratio(:), z_ratio(:)
      integer, allocatable :: r_cells(:), z_cells(:)

      if (given(group, 'file')) then
         path = text_of(group, 'file')
         if (path(1:1) /= '/') path = group%file(:index(group%file, '/', back=.true.))//path
         call read_gmsh(path, model%domain%mesh, fault)
         return
      end if
      r = numbers_of(group, 'r')
      z = numbers_of(group, 'z')
      r_cells = nint(numbers_of(group, 'r_cells'))
      z_cells = nint(numbers_of(group, 'z_cells'))
      r_ratio = numbers_of(group, 'r_ratio')
      z_ratio = numbers_of(group, 'z_ratio')
      if (size(r_ratio) == 0) r_ratio = spread(1.0_wp, 1, size(r_cells))
      if (size(z_ratio) == 0) z_ratio = spread(1.0_wp, 1, size(z_cells))
      if (size(r) < 2 .or. size(z) < 2) then
         call raise(fault, EXIT_MESH, at_line(group%file, group%line)//'&mesh needs a file, or r and z with '// &
                    'at least two breaks each.')
      else if (size(r_cells) /= size(r) - 1 .or. size(z_cells) /= size(z) - 1 .or. size(r_ratio) /= size(r) - 1 .or. &
               size(z_ratio) /= size(z) - 1) then
         call raise(fault, EXIT_MESH, at_line(group%file, group%line)//'between n breaks there are n - 1 pieces: '// &
                    'give r_cells, z_cells (and ratios) one value a piece.')
      else if (any(r(2:) <= r(:size(r) - 1)) .or. any(z(2:) <= z(:size(z) - 1))) then
         call raise(fault, EXIT_MESH, at_line(group%file, group%line)//'breaks of r and z must ascend.')
      else if (2*sum(real(r_cells, wp))*sum(real(z_cells, wp)) > MOST_ELEMENTS) then
         call raise(fault, EXIT_MESH, at_line(group%file, group%line)//'r_cells, z_cells: '// &
                    short(2*sum(real(r_cells, wp))*sum(real(z_cells, wp)))//' elements; at most '// &
                    short(MOST_ELEMENTS)//'.')
      else
         call graded_mesh(r, r_cells, r_ratio, z, z_cells, z_ratio, model%domain%mesh)
      end if
   end subroutine take_mesh

   subroutine take_fluids(group, model)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model

      associate (f => model%domain%fluids)
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

   subroutine take_law(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(permeability_t) :: law
      integer :: i

      select case (group%name)
      case ('mud', 'elastic')
         do i = 1, size(model%domain%materials)
            if (.not. allocated(model%domain%materials(i)%law)) exit
         end do
         if (group%name == 'mud') then
            call read_mud(group, model%domain%materials(i), fault)
         else
            call read_elastic(group, model%domain%materials(i))
         end if
      case ('retention')
         call read_retention(group, model%domain%retentions(free_curve(model)), fault)
      case default
         call read_permeability(group, law, fault)
         model%domain%permeabilities = [model%domain%permeabilities, law]
      end select
   end subroutine take_law

   !> First unused place for a retention curve.
   pure integer function free_curve(model) result(place)
      type(model_t), intent(in) :: model

      do place = 1, size(model%domain%retentions)
         if (.not. allocated(model%domain%retentions(place)%law)) return
      end do
   end function free_curve

   subroutine take_history(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(history_t) :: history

      history%name = text_of(group, 'name')
      if (given(group, 'file')) then
         call read_table(group, history, fault)
      else
         history%times = numbers_of(group, 'times')
         history%values = numbers_of(group, 'values')
      end if
      if (fault%code /= 0) return
      if (size(history%times) == 0 .or. size(history%times) /= size(history%values)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'history '//trim(history%name)// &
                    ' needs as many values as times.')
      else if (any(history%times(2:) <= history%times(:size(history%times) - 1))) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the times of history '//trim(history%name)// &
                    ' must ascend.')
      end if
      model%histories = [model%histories, history]
   end subroutine take_history

   !> A file of times and factors, two a line; comments as in a scene.
   subroutine read_table(group, history, fault)
      type(group_t), intent(in) :: group
      type(history_t), intent(inout) :: history
      type(fault_t), intent(inout) :: fault
      integer, parameter :: LINE_LENGTH = 1024
      character(:), allocatable :: path
      character(LINE_LENGTH) :: line
      real(wp) :: pair(2)
      logical :: good(2)
      integer :: unit, status, n, last

      path = text_of(group, 'file')
      if (path(1:1) /= '/') path = group%file(:index(group%file, '/', back=.true.))//path
      history%times = [real(wp) ::]
      history%values = [real(wp) ::]
      open (newunit=unit, file=path, status='old', action='read', iostat=status)
      if (status /= 0) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//path//' cannot be read.')
         return
      end if
      n = 0
      do
         read (unit, '(a)', iostat=status) line
         if (is_iostat_end(status)) exit
         n = n + 1
         if (status /= 0) then
            call raise(fault, EXIT_INPUT, at_line(path, n)//'cannot be read.')
            exit
         else if (len_trim(line) == LINE_LENGTH) then
            call raise(fault, EXIT_INPUT, at_line(path, n)//'the line is longer than '//whole(LINE_LENGTH - 1)// &
                       ' characters.')
            exit
         end if
         line = adjustl(blank(line(:scan(line//'!', '!#') - 1)))
         if (line == '') cycle
         last = index(line, ' ')
         call read_number(line(:last), pair(1), good(1))
         call read_number(adjustl(line(last:)), pair(2), good(2))
         if (.not. all(good)) then
            call raise(fault, EXIT_INPUT, at_line(path, n)//'"'//trim(line(:min(60, len(line))))// &
                       '" is not a time and a factor, two finite numbers.')
            exit
         end if
         history%times = [history%times, pair(1)]
         history%values = [history%values, pair(2)]
      end do
      close (unit)
   contains
      !> Commas, tabs and returns divide as blanks do.
      pure function blank(text)
         character(*), intent(in) :: text
         character(len(text)) :: blank
         integer :: i

         blank = text
         do i = 1, len(text)
            if (scan(text(i:i), ','//achar(9)//achar(13)) > 0) blank(i:i) = ' '
         end do
      end function blank
   end subroutine read_table

   subroutine take_stage(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(stage_t) :: stage

      stage%name = text_of(group, 'name')
      stage%derived = .not. given(group, 'analysis')
      if (stage%derived .and. .not. model%effects%auto) call raise(fault, EXIT_INPUT, &
         at_line(group%file, group%line)//'&stage needs analysis (static, quasi_static or dynamic); '// &
         'effects = ''auto'' in &scene would derive it.')
      select case (lower_case(text_of(group, 'analysis')))
      case ('static')
         stage%kind = STATIC
      case ('quasi_static')
         stage%kind = QUASI_STATIC
      case default
         stage%kind = DYNAMIC
      end select
      stage%duration = number_of(group, 'duration')
      stage%dt = number_of(group, 'dt')
      stage%dt_growth = number_of(group, 'dt_growth')
      stage%dt_max = huge(1.0_wp)
      if (given(group, 'dt_max')) stage%dt_max = number_of(group, 'dt_max')
      stage%cuts = nint(number_of(group, 'cuts'))
      stage%rho_inf = number_of(group, 'rho_inf')
      stage%tolerance = number_of(group, 'tolerance')
      stage%measure = findloc(MEASURES, lower_case(text_of(group, 'measure')), 1)
      stage%max_iterations = nint(number_of(group, 'max_iterations'))
      stage%every = nint(number_of(group, 'every'))
      stage%fields = nint(number_of(group, 'fields'))
      stage%still = word_is(group, 'predictor', 'none')
      stage%solve_start = word_is(group, 'start', 'solve')
      stage%zero_displacements = word_is(group, 'zero_displacements', 'yes')
      model%stages = [model%stages, stage]
   end subroutine take_stage

   subroutine take_region(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(region_t) :: region
      integer :: place, i

      place = group_named(group, model, fault)
      if (fault%code /= 0) return
      associate (m => model%domain)
         region%material = named(group, 'material', [(m%materials(i)%name, i=1, size(m%materials))], fault)
         if (fault%code /= 0) return
         region%rho_s = number_of(group, 'rho_s')
         region%damping = number_of(group, 'damping')
         region%void_ratio = m%materials(region%material)%law%initial_void_ratio()
         if (given(group, 'void_ratio')) region%void_ratio = number_of(group, 'void_ratio')
         if (m%with_w .and. .not. region%void_ratio > 0.0_wp) call raise(fault, EXIT_INPUT, &
            at_line(group%file, group%line)//'the region needs a void_ratio: its pores hold the fluids.')
         if (m%with_w .and. fault%code == 0) region%permeability = named(group, 'permeability', &
            [(m%permeabilities(i)%name, i=1, size(m%permeabilities))], fault)
         if (m%with_c .and. fault%code == 0) then
            if (text_of(group, 'retention') == 'mud') then
               select type (law => m%materials(region%material)%law)
               type is (mud_t)
                  region%retention = free_curve(model)
                  call retention_of_mud(law, m%retentions(region%retention))
               class default
                  call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
                             'retention = ''mud'' needs a &mud material.')
               end select
            else
               region%retention = named(group, 'retention', [(m%retentions(i)%name, i=1, size(m%retentions))], fault)
            end if
         end if
         if (fault%code /= 0) return
         m%regions = [m%regions, region]
         m%region_of(m%mesh%groups(place)%elements) = size(m%regions)
      end associate
   end subroutine take_region

   !> Place of the group of the mesh that a group of the scene names, under `group` or another key.
   integer function group_named(group, model, fault, key) result(place)
      type(group_t), intent(in) :: group
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      character(*), intent(in), optional :: key
      character(:), allocatable :: list, name
      integer :: i

      if (present(key)) then
         name = text_of(group, key)
      else
         name = text_of(group, 'group')
      end if
      place = find_group(model%domain%mesh, name)
      if (place > 0) return
      list = ''
      do i = 1, size(model%domain%mesh%groups)
         list = list//' '//trim(model%domain%mesh%groups(i)%name)
      end do
      call raise(fault, EXIT_GROUP, at_line(group%file, group%line)//'the mesh has no group '''// &
                 name//'''; it has'//list//'.')
   end function group_named

   !> Place of a name in a list of definitions.
   integer function named(group, key, names, fault) result(place)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key, names(:)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: list
      integer :: i

      place = findloc(names == text_of(group, key), .true., dim=1)
      if (place > 0) return
      list = ''
      do i = 1, size(names)
         list = list//' '//trim(names(i))
      end do
      if (list == '') list = ' nothing'
      call raise(fault, EXIT_GROUP, at_line(group%file, group%line)//key//' = '''//text_of(group, key)// &
                 ''' is defined nowhere; there is'//list//'.')
   end function named

   integer function history_named(group, model, fault) result(place)
      type(group_t), intent(in) :: group
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      place = 0
      if (given(group, 'history')) place = named(group, 'history', &
         [(model%histories(i)%name, i=1, size(model%histories))], fault)
   end function history_named

   subroutine check_stages(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i, k

      associate (names => texts_of(group, 'stages'))
         do i = 1, size(names)
            if (any([(model%stages(k)%name == names(i), k=1, size(model%stages))])) cycle
            call raise(fault, EXIT_GROUP, at_line(group%file, group%line)//'there is no stage '''// &
                       trim(names(i))//'''.')
         end do
      end associate
   end subroutine check_stages

   subroutine take_initial(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(initial_t) :: initial
      real(wp), allocatable :: sigma(:)

      initial%group = group_named(group, model, fault)
      if (fault%code /= 0) return
      initial%p_w = number_of(group, 'p_w')
      initial%p_w_slope = number_of(group, 'p_w_slope')
      initial%p_c = number_of(group, 'p_c')
      initial%p_c_slope = number_of(group, 'p_c_slope')
      initial%datum = number_of(group, 'datum')
      initial%v_z = number_of(group, 'v_z')
      initial%wave = number_of(group, 'wave')
      initial%wave_number = number_of(group, 'wave_number')
      initial%uniform = word_is(group, 'stress', 'uniform')
      initial%geostatic = word_is(group, 'stress', 'geostatic')
      sigma = numbers_of(group, 'sigma')
      if (initial%uniform .and. size(sigma) /= 3) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a uniform stress needs sigma = rr, zz, tt.')
         return
      end if
      if (initial%uniform) initial%sigma = sigma
      initial%surface = number_of(group, 'surface')
      initial%surcharge = number_of(group, 'surcharge')
      initial%k_0 = number_of(group, 'k_0')
      initial%net = word_is(group, 'k_0_of', 'net')
      model%initials = [model%initials, initial]
   end subroutine take_initial

   subroutine take_fix(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      character(3), parameter :: WORDS(5) = ['u_r', 'u_z', 'p_w', 'p_c', 'p_a']
      type(fix_t) :: fix

      fix%group = group_named(group, model, fault)
      if (fault%code == 0) fix%history = history_named(group, model, fault)
      if (fault%code == 0) call check_stages(group, model, fault)
      if (fault%code /= 0) return
      fix%field = findloc(WORDS, lower_case(text_of(group, 'field')), dim=1)
      if ((fix%field == 3 .and. .not. model%domain%with_w) .or. (fix%field >= 4 .and. .not. model%domain%with_c)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the scene has no field '// &
                    text_of(group, 'field')//'; see fields in &scene.')
         return
      end if
      fix%value = number_of(group, 'value')
      fix%hold = word_is(group, 'hold', 'yes')
      fix%stages = texts_of(group, 'stages')
      if (given(group, 'from')) fix%from = number_of(group, 'from')
      if (given(group, 'until')) fix%until = number_of(group, 'until')
      model%fixes = [model%fixes, fix]
   end subroutine take_fix

   subroutine take_load(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(load_t) :: load

      load%group = group_named(group, model, fault)
      if (fault%code == 0) load%history = history_named(group, model, fault)
      if (fault%code == 0) call check_stages(group, model, fault)
      if (fault%code /= 0) return
      load%kind = findloc(LOAD_KINDS, lower_case(text_of(group, 'kind')), dim=1)
      load%value = number_of(group, 'value')
      load%stages = texts_of(group, 'stages')
      if (load%kind <= 5 .and. size(model%domain%mesh%groups(load%group)%edges, 2) == 0) call raise(fault, EXIT_GROUP, &
         at_line(group%file, group%line)//'group '''//text_of(group, 'group')//''' has no edges to load.')
      if ((load%kind == 4 .and. .not. model%domain%with_w) .or. (load%kind == 5 .and. .not. model%domain%with_c)) &
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the scene has no field for a load of '// &
                    text_of(group, 'kind')//'; see fields in &scene.')
      model%loads = [model%loads, load]
   end subroutine take_load

   subroutine take_rigid(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(rigid_t) :: rigid

      rigid%group = group_named(group, model, fault)
      if (fault%code == 0) rigid%history = history_named(group, model, fault)
      if (fault%code /= 0) return
      rigid%mass = number_of(group, 'mass')
      rigid%force = number_of(group, 'force')
      model%rigids = [model%rigids, rigid]
   end subroutine take_rigid

   !> A plate becomes a node of the mesh, and a group of that one node.
   subroutine take_plate(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(plate_t) :: plate
      real(wp), allocatable :: r(:)
      integer :: none(3, 0)

      plate%name = text_of(group, 'name')
      plate%history = history_named(group, model, fault)
      if (fault%code /= 0) return
      r = numbers_of(group, 'r')
      associate (mesh => model%domain%mesh)
         if (find_group(mesh, trim(plate%name)) > 0) then
            call raise(fault, EXIT_GROUP, at_line(group%file, group%line)//'the mesh has a group '''// &
                       trim(plate%name)//''' already; give the plate another name.')
            return
         end if
         if (size(r) /= 2) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a plate needs r = begin, end, ascending.')
            return
         end if
         plate%r = r
         plate%z = number_of(group, 'z')
         if (.not. plate%r(2) > plate%r(1) .or. (model%domain%axisymmetric .and. plate%r(1) < 0.0_wp)) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a plate needs r = begin, end, ascending'// &
                       ' and, in axial symmetry, not negative.')
            return
         end if
         mesh%x = reshape([mesh%x, plate%r(1), plate%z], [2, size(mesh%x, 2) + 1])
         plate%node = size(mesh%x, 2)
         call add_group(mesh, trim(plate%name), [integer ::], none, [plate%node])
      end associate
      plate%up = word_is(group, 'face', 'up')
      plate%mass = number_of(group, 'mass')
      plate%heavy = word_is(group, 'weight', 'yes')
      plate%force = number_of(group, 'force')
      model%plates = [model%plates, plate]
      model%domain%bodies = [model%domain%bodies, plate%node]
   end subroutine take_plate

   subroutine take_contact(group, model, fault)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(touching_t) :: contact
      integer :: i

      contact%name = text_of(group, 'name')
      contact%slave = group_named(group, model, fault, 'slave')
      if (fault%code == 0) contact%master = group_named(group, model, fault, 'master')
      if (fault%code == 0) call check_stages(group, model, fault)
      if (fault%code /= 0) return
      do i = 1, size(model%plates)
         if (model%plates(i)%name == text_of(group, 'master')) contact%plate = i
      end do
      if (contact%slave == contact%master) then
         call raise(fault, EXIT_GROUP, at_line(group%file, group%line)//'slave and master are one boundary, '''// &
                    text_of(group, 'slave')//'''; name the two that meet.')
         return
      end if
      associate (groups => model%domain%mesh%groups)
         if (size(groups(contact%slave)%edges, 2) == 0 .or. &
             (contact%plate == 0 .and. size(groups(contact%master)%edges, 2) == 0)) then
            call raise(fault, EXIT_GROUP, at_line(group%file, group%line)//'slave and master need edges: a '// &
                       'boundary of the mesh (the master may be a plate).')
            return
         end if
      end associate
      contact%stages = texts_of(group, 'stages')
      do i = 1, size(model%stages)
         if (model%stages(i)%zero_displacements .and. acts_in(contact%stages, model%stages(i)%name)) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'stage '''//trim(model%stages(i)%name)// &
                       ''' zeroes its displacements, which would undo the contact; name the stages of the contact.')
            return
         end if
      end do
      contact%drains_by_state = word_is(group, 'drainage', 'state')
      if (contact%drains_by_state .and. .not. model%domain%with_w) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'drainage = ''state'' needs pressures; see '// &
                    'fields in &scene.')
         return
      end if
      contact%options%penalty = number_of(group, 'penalty')
      contact%options%reach = number_of(group, 'reach')
      contact%options%axisymmetric = model%domain%axisymmetric
      contact%options%gap = merge(NODAL_GAP, POINTWISE_GAP, word_is(group, 'gap', 'nodal'))
      contact%options%variation = merge(PRESSURE_WORK, ENERGY_SLOPE, word_is(group, 'variation', 'pressure'))
      model%contacts = [model%contacts, contact]
   end subroutine take_contact

   subroutine take_point(group, model)
      type(group_t), intent(in) :: group
      type(model_t), intent(inout) :: model
      type(point_t) :: point
      logical, allocatable :: vertex(:)
      real(wp) :: x(2)
      integer :: e, g, i

      x = [number_of(group, 'r'), number_of(group, 'z')]
      point%name = text_of(group, 'name')
      associate (m => model%domain)
         ! Where pressures are linear only vertices have them.
         allocate (vertex(size(m%mesh%x, 2)), source=.false.)
         do e = 1, size(m%mesh%t6, 2)
            vertex(m%mesh%t6(1:m%n_p, e)) = .true.
         end do
         point%node = minloc([(norm2(m%mesh%x(:, i) - x), i=1, size(m%mesh%x, 2))], 1, mask=vertex)
         point%gauss = minloc([((norm2(m%gauss(g, e)%x - x), g=1, m%rule), e=1, size(m%mesh%t6, 2))], 1)
      end associate
      model%points = [model%points, point]
   end subroutine take_point
end module host_read
