! SPDX-License-Identifier: MIT
!> Settings of a scene, &scene and &fluids, and its points, &point.
module settings_builder
   use effect_switches, only: EFFECT_WORDS
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use model_types, only: model_t, point_t
   use name_search, only: history_named
   use named_points, only: find_point
   use shape_functions, only: RULES
   use texts, only: whole, LENGTH
   implicit none (type, external)
   private
   public :: build_settings, build_fluids, build_point

   real(wp), parameter :: BIG = UNBOUNDED, TINY_ = 1.0e-30_wp, ZERO = 0.0_wp, ONE = 1.0_wp
   integer, parameter :: MANY = 1000000
   integer, parameter :: WITH_U = 1, WITH_P_W = 2, WITH_P_C = 3   !< Words of the key fields.
contains
   !> Reads &scene, once the histories are known. Fault EXIT_GROUP: a history that is not defined; EXIT_INPUT: no
   !> quadrature rule of so many points.
   subroutine build_settings(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      character(LENGTH), allocatable :: without(:), goals(:)   !< Read by effect_switches, and by mud_study.
      character(LENGTH) :: gravity_history
      logical :: linear_pressures
      integer :: fields

      fields = WITH_U
      linear_pressures = .true.
      gravity_history = ''
      model%domain%threads = 0
      associate (domain => model%domain, output => model%output)
         call k%text('name', model%origin%name, 'name of the scene', REQUIRED)
         call k%flag('geometry', domain%axisymmetric, 'axisymmetric|plane_strain', 'axisymmetric', &
                     'axisymmetric in r, z or plane strain in x, y')
         call k%word('fields', fields, 'u|u-p_w|u-p_w-p_c', 'unknowns; absent ones cost nothing')
         call k%flag('pressures', linear_pressures, 'quadratic|linear', 'linear', &
                     'interpolation; linear (Taylor-Hood) is stable where water cannot drain yet', ':p_w')
         call k%whole('quadrature', domain%rule, 3, 12, 'points of an element: 3, 6, 7 or 12')
         call k%number('gravity', domain%gravity, ZERO, 1000*ONE, 'acceleration towards -z [m/s2]')
         call k%text('gravity_history', gravity_history, 'name of a &history: factor on gravity', '+gravity', &
                     refers='history')
         call k%texts('without', without, 'effects that are taken out by hand', words=EFFECT_WORDS)
         call k%flag('seepage_inertia', domain%seepage_inertia, 'no|yes', 'yes', &
                     'acceleration of the skeleton in Darcy''s law', ':p_w :dynamic')
         call k%flag('saturation_rate', domain%full_rate, 'full|suction', 'full', &
                     'rate of saturation by void ratio and suction, or by suction alone', ':p_c :time')
         call k%flag('initial_flow', model%subtract_flow, 'drain|subtract', 'subtract', &
                     'subtract: the initial flow is maintained', ':p_w :time :flow')
         call k%number('step_tolerance', model%step_tolerance, 1.0e-8_wp, 0.5_wp, &
                       'local tolerance of controlled steps [-], see host/SCENE.md')
         call k%texts('goals', goals, 'answers that mud_study measures, as ''top.u_z''; default: all')
         call k%whole('threads', domain%threads, 0, 1024, 'threads over elements; 0: by size, at most OMP_NUM_THREADS')
         call k%flag('lanes', model%lanes, 'no|yes', 'yes', &
                     'points of &mud eight at a time: less time, and numbers that differ by rounding', ':lanes')
         call k%flag('factors', model%reuse_factors, 'reuse|fresh', 'reuse', &
                     'factors of the matrix: reused while they serve, or new in every iteration')
         call k%whole('checkpoint_steps', output%checkpoint_steps, 0, 1000*MANY, &
                      'checkpoint.h5 after every so many steps; 0: none')
         call k%number('checkpoint_seconds', output%checkpoint_seconds, ZERO, BIG, &
                       'checkpoint.h5 after so much wall time [s]; 0: none')
         if (k%lists) return
         domain%with_c = fields == WITH_P_C
         domain%with_w = domain%with_c .or. fields == WITH_P_W
         domain%n_p = merge(3, 6, linear_pressures)
         model%gravity_amplitude = history_named(gravity_history, model%amplitudes%name, trim(k%group%file)// &
                                                 ': gravity_history of &scene: ', fault)
         if (.not. any(RULES == domain%rule)) call raise(fault, EXIT_INPUT, trim(k%group%file)//': quadrature = '// &
            whole(domain%rule)//': there are rules of 3, 6, 7 and 12 points.')
      end associate
   end subroutine build_settings

   !> Reads &fluids.
   subroutine build_fluids(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault

      associate (f => model%domain%fluids)
         call k%number('k_w', f%k_w, TINY_, BIG, 'bulk modulus of water [kPa]', ':p_w :time')
         call k%number('rho_w', f%rho_w, ZERO, 1000*ONE, 'density of water [Mg/m3]', ':p_w')
         call k%number('eta_w', f%eta_w, TINY_, BIG, 'viscosity of water [kPa s]', ':p_w :time :flow')
         call k%flag('gas', f%ideal_gas, 'constant|ideal', 'ideal', 'ideal: K_a = p_ref + p_a, density as well', ':p_c')
         call k%number('k_a', f%k_a, TINY_, BIG, 'bulk modulus of a constant gas [kPa]', &
                       'gas=constant :p_c :time')
         call k%number('rho_a', f%rho_a, ZERO, 1000*ONE, 'density of air (ideal: at p_ref) [Mg/m3]', ':p_c')
         call k%number('eta_a', f%eta_a, TINY_, BIG, 'viscosity of air [kPa s]', ':p_c :time :flow')
         call k%number('p_ref', f%p_ref, TINY_, BIG, 'absolute pressure where p_a = 0 [kPa]', &
                       'gas=ideal :p_c')
         call k%number('henry', f%henry, ZERO, 0.5_wp, &
                       'volume of air that a volume of water dissolves [-]; 0.02 at 20 C', ':p_c :time')
      end associate
   end subroutine build_fluids

   !> Builds a &point, in a domain that is prepared. Fault EXIT_GROUP: it lies outside the mesh.
   subroutine build_point(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(point_t) :: point

      call k%text('name', point%name, 'name in histories.csv', REQUIRED)
      call k%number('r', point%x(1), -BIG, BIG, 'place of the point, in the mesh [m]', REQUIRED)
      call k%number('z', point%x(2), -BIG, BIG, 'place of the point, in the mesh [m]', REQUIRED)
      if (k%lists) return
      call find_point(model%domain, point, fault)
      model%output%points = [model%output%points, point]
   end subroutine build_point
end module settings_builder
