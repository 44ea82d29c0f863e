! SPDX-License-Identifier: MIT
!> Builds the model of a scene: mesh, materials, supports, loads and contacts with every name resolved, the
!> unknowns numbered.
module model_builder
   use acting_places, only: check_ground, check_sides
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use boundary_builder, only: build_plates, build_boundaries
   use degrees_of_freedom, only: number_unknowns
   use free_bodies, only: check_bodies
   use given_pressures, only: add_centers, check_places
   use load_shapes, only: shape_loads, ties_of
   use mesh_builder, only: build_mesh
   use mesh_look, only: check_carried
   use model_types, only: model_t, solver_t
   use named_points, only: find_point
   use porous_domain, only: domain_t, prepare_domain
   use region_builder, only: build_regions
   use scene_types, only: scene_t, WITH_P_W, WITH_P_C
   use stage_builder, only: choose_schemes
   use shape_functions, only: RULES
   use term_registry, only: build_terms
   use texts, only: whole
   !$ use omp_lib, only: omp_get_max_threads
   implicit none (type, external)
   private
   public :: build_model

   ! A pass over an element of three fields and six points [s]: measured, rounded.
   real(wp), parameter :: OF_ELASTIC = 7.0e-6_wp, OF_PLASTIC = 5.0e-5_wp
   real(wp), parameter :: WORTH_A_THREAD = 4.0e-3_wp   !< A slice of Linux' scheduler [s].
contains
   !> Mesh, regions, boundaries, unknowns and unit loads of a scene. Faults: those of its parts, of check_bodies and
   !> find_point; EXIT_INPUT: no quadrature rule of so many points; EXIT_ELEMENT: see prepare_domain.
   subroutine build_model(scene, model, fault)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(out) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      call take_settings(scene, model)
      call build_domain(scene, model, fault)
      if (fault%code == 0) call build_regions(scene, model%domain, fault)
      ! Before plates become nodes: those are the last ones.
      if (fault%code == 0) call add_centers(model%domain)
      if (fault%code == 0) call build_plates(scene, model, fault)
      if (fault%code == 0) call choose_threads(scene%threads, model%domain)
      if (fault%code == 0) call build_boundaries(scene, model, fault)
      if (fault%code == 0) call build_terms(scene, model, fault)
      if (fault%code == 0) call check_carried(model, fault)
      if (fault%code == 0) call check_places(model, fault)
      if (fault%code == 0) call check_ground(model, fault)
      if (fault%code == 0) call check_sides(model, fault)
      if (fault%code == 0) call check_bodies(model, fault)
      if (fault%code == 0) call prepare_domain(model%domain, fault)
      associate (points => model%output%points)
         do i = 1, size(points)
            if (fault%code == 0) call find_point(model%domain, points(i), fault)
         end do
      end associate
      if (fault%code /= 0) return
      call choose_schemes(model)
      call number_unknowns(model%domain, ties_of(model), model%dofs)
      call shape_loads(model, model%dofs)
   end subroutine build_model

   !> What holds as the scene says it.
   subroutine take_settings(scene, model)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      integer :: i

      associate (origin => model%origin, output => model%output)
         origin%file = scene%file
         origin%name = scene%name
         origin%fingerprint = scene%fingerprint
         origin%hashes = scene%hashes
         allocate (origin%groups(size(scene%groups)))
         do i = 1, size(scene%groups)
            origin%groups(i) = '&'//trim(scene%groups(i)%name)//' in line '//whole(scene%groups(i)%line)
         end do
         output%checkpoint_steps = scene%checkpoint_steps
         output%checkpoint_seconds = scene%checkpoint_seconds
         allocate (output%points(size(scene%points)))
         do i = 1, size(scene%points)
            output%points(i)%named_point_t = scene%points(i)
         end do
      end associate
      model%amplitudes = scene%amplitudes
      model%stages = scene%stages
      model%subtract_flow = scene%subtract_flow
      model%solver = solver_t(scene%reuse_factors, scene%ordering)
   end subroutine take_settings

   !> Threads of the element loop: those asked for, or as many as have work enough, within OMP_NUM_THREADS. A thread
   !> that is woken for less than a slice of the scheduler costs more than it gives where other programs run.
   subroutine choose_threads(asked, domain)
      integer, intent(in) :: asked   !< 0: not asked for.
      type(domain_t), intent(inout) :: domain
      integer :: e, most
      real(wp) :: work

      domain%threads = asked
      if (asked > 0) return
      work = 0.0_wp
      do e = 1, size(domain%region_of)
         work = work + merge(OF_ELASTIC, OF_PLASTIC, domain%regions(domain%region_of(e))%law%has_energy)
      end do
      most = 1
      !$ most = omp_get_max_threads()
      domain%threads = max(1, min(most, int(work/WORTH_A_THREAD)))
   end subroutine choose_threads

   !> Options of the domain, its mesh and its fluids.
   subroutine build_domain(scene, model, fault)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault

      associate (domain => model%domain)
         domain%axisymmetric = scene%axisymmetric
         domain%with_c = scene%fields == WITH_P_C
         domain%with_w = domain%with_c .or. scene%fields == WITH_P_W
         domain%n_p = merge(3, 6, scene%linear_pressures)
         domain%rule = scene%quadrature
         domain%gravity = scene%gravity
         domain%seepage_inertia = scene%seepage_inertia
         domain%full_rate = scene%full_saturation_rate
         domain%fluids = scene%fluids
         domain%permeabilities = scene%permeabilities
         if (.not. any(RULES == domain%rule)) call raise(fault, EXIT_INPUT, trim(scene%file)//': quadrature = '// &
            whole(domain%rule)//': there are rules of 3, 6, 7 and 12 points.')
         if (fault%code == 0) call build_mesh(scene%mesh, domain%mesh, fault)
      end associate
   end subroutine build_domain

end module model_builder
