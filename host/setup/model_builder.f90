! SPDX-License-Identifier: MIT
!> Builds the model of a scene: mesh, materials, supports, loads and contacts with every name resolved, the
!> unknowns numbered.
module model_builder
   use acting_places, only: check_actions
   use kinds, only: wp
   use faults, only: fault_t, raise
   use degrees_of_freedom, only: number_unknowns
   use exit_codes, only: EXIT_GROUP
   use free_bodies, only: check_bodies
   use given_pressures, only: add_centers, check_places
   use key_table, only: key_table_t
   use load_shapes, only: integrate_loads, ties_of
   use material_registry, only: is_law
   use model_types, only: model_t
   use namelists, only: group_t
   use porous_domain, only: domain_t, prepare_domain
   use region_builder, only: build_material
   use scene_keys, only: build_group
   use scene_types, only: scene_t, groups_named
   use stage_builder, only: place_histories, choose_schemes
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
   !> Builds a model group by group, each once what it names is known. Faults: those of the builders of groups and
   !> terms, and of the checks; EXIT_GROUP: an element of no region; EXIT_ELEMENT: see prepare_domain.
   subroutine build_model(scene, model, fault)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(out) :: model
      type(fault_t), intent(inout) :: fault

      call begin_model(scene, model)
      call build('history')
      call build('scene')
      call build('fluids')
      call build('stage')
      if (fault%code == 0) call place_histories(model, fault)
      call build('mesh')
      call build('permeability')
      call build('retention')
      call build_materials()
      call build_regions()
      ! Before plates become nodes: those are the last ones.
      if (fault%code == 0) call add_centers(model%domain)
      call build('plate')
      if (fault%code == 0) call choose_threads(model%domain%threads, model%domain)
      call build('initial')
      call build('fix')
      call build('load')
      call build('contact')
      call build('tie')
      if (fault%code == 0) call build_terms(scene, model, fault)
      if (fault%code == 0) call check_actions(model, fault)
      if (fault%code == 0) call check_places(model, fault)
      if (fault%code == 0) call prepare_domain(model%domain, fault)
      call build('point')
      if (fault%code /= 0) return
      call choose_schemes(model)
      call number_unknowns(model%domain, ties_of(model), model%dofs)
      call integrate_loads(model)
      call check_bodies(model, fault)
   contains
      subroutine build(name)
         character(*), intent(in) :: name
         type(group_t), allocatable :: groups(:)
         type(key_table_t) :: table
         integer :: i

         allocate (groups, source=groups_named(scene, name))
         do i = 1, size(groups)
            table%group = groups(i)
            if (fault%code == 0) call build_group(table, model, fault)
         end do
      end subroutine build

      subroutine build_materials()
         type(group_t) :: group
         integer :: i

         do i = 1, size(scene%groups)
            if (.not. is_law(scene%groups(i)%name)) cycle
            group = scene%groups(i)
            if (fault%code == 0) call build_material(group, model, fault)
         end do
      end subroutine build_materials

      subroutine build_regions()
         if (fault%code /= 0) return
         allocate (model%domain%region_of(size(model%domain%mesh%t6, 2)), source=0)
         call build('region')
         if (any(model%domain%region_of == 0) .and. fault%code == 0) call raise(fault, EXIT_GROUP, &
            trim(scene%origin%file)//': element '//whole(findloc(model%domain%region_of, 0, dim=1))//' belongs to '// &
            'no &region; add one with its group, or with group = ''all''.')
      end subroutine build_regions
   end subroutine build_model

   !> Notes which scene a model is of; its lists are empty.
   subroutine begin_model(scene, model)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(inout) :: model

      model%origin = scene%origin
      associate (domain => model%domain)
         allocate (domain%permeabilities(0), domain%regions(0), domain%bodies(0), domain%bodies_along_r(0))
      end associate
      allocate (model%materials(0), model%curves(0), model%regions(0), model%amplitudes(0), model%stages(0), &
                model%initials(0), model%fixes(0), model%loads(0), model%plates(0), model%contacts(0), model%ties(0), &
                model%actions(0), model%output%points(0))
   end subroutine begin_model

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
end module model_builder
