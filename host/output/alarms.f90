! SPDX-License-Identifier: MIT
!> Observer of what makes the answers of a step doubtful: it looks at contacts, pressures, strains and the convergence
!> of Newton's method, and warns on standard error, also where the run is quiet. A warning is given once a run, or once
!> a stage or contact where its name says so.
module alarms
   use acting_places, only: ground_of
   use contact_alarm, only: warn_of_overlaps, warn_of_penetration, warn_of_rounding
   use faults, only: fault_t
   use kinds, only: wp
   use model_types, only: now_in
   use porous_domain, only: strain_of
   use pressure_alarm, only: lines_t, warn_of_pressures
   use run_observer, only: observer_t, STAGE_BEGINS, STEP
   use run_state, only: run_t
   use texts, only: place_text, short
   use unknown_fields, only: DISPLACEMENTS
   use warnings, only: print_warning, is_told
   implicit none (type, external)
   private
   public :: alarms_t

   type, extends(observer_t) :: alarms_t
      type(lines_t) :: lines   !< Lines of the mesh; found when they are asked for first.
   contains
      procedure :: hear
   end type alarms_t

   !> Principal strain whose square is a hundredth, with some room for the rounding of one that is prescribed.
   real(wp), parameter :: LARGE = 0.1_wp*(1 + 1.0e-6_wp)
contains
   !> Looks at contacts where they begin to act, and at everything after a step.
   subroutine hear(self, event, run, fault)
      class(alarms_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      select case (event)
      case (STAGE_BEGINS)
         call warn_of_overlaps(run)
      case (STEP)
         call warn_of_convergence(run)
         call warn_of_penetration(run)
         call warn_of_pressures(run, self%lines)
         if (run%last) call warn_of_strain(run)
         if (run%last) call warn_of_rounding(run)
      end select
   end subroutine hear

   !> Warns of loads that act at once and are applied evenly, and of an error that stays above the tolerance: the step
   !> is accepted in another way than the scene says. docs/theory/host.md sections 4.4 and 5.1.
   subroutine warn_of_convergence(run)
      type(run_t), intent(in) :: run

      if (run%at%step == 1 .and. allocated(run%at%sudden)) &
         call print_warning('stage '//trim(run%stage%name)//': its loads act at once and the '// &
            'first step did not converge: they are applied evenly over the stage. A material with a '// &
            'memory may answer otherwise than at once; give the loads a &history to say how they grow.')
      if (run%log%stagnated) call print_warning(now_in(run)//'Newton''s method stays at an error of '// &
         short(maxval(run%log%error))//' and cannot reach its tolerance of '//short(run%newton%tolerance)// &
         ', because stresses are integrated to '//short(run%newton%roughness)//'. The step is accepted. Give &stage'// &
         ' a tolerance above the error reached, or the material a smaller one.', &
         once='stagnation in stage '//trim(run%stage%name))
   end subroutine warn_of_convergence

   !> Warns of strains that are not small: equations stand on the geometry of the start. docs/theory/host.md section
   !> 2.1.
   subroutine warn_of_strain(run)
      type(run_t), intent(in) :: run
      real(wp) :: strain, largest, at(2)
      integer :: e, g, s, first
      logical :: stays(size(run%domain%region_of))

      if (is_told('strain')) return
      largest = LARGE
      associate (domain => run%domain, new => run%next, model => run%model)
         first = 1 + findloc(model%stages(:run%at%stage - 1)%zero_displacements, .true., 1, back=.true.)
         ! Ground that has joined since then has strains that its displacements do not tell.
         stays = .true.
         do s = first, run%at%stage
            stays = stays .and. ground_of(model, s)
         end do
         do e = 1, size(domain%region_of)
            if (.not. stays(e)) cycle
            do g = 1, domain%rule
               strain = principal(strain_of(domain%gauss(g, e), new%x(:DISPLACEMENTS, domain%mesh%t6(:, e))))
               if (strain <= largest) cycle
               largest = strain
               at = domain%gauss(g, e)%x
            end do
         end do
      end associate
      if (largest > LARGE) call print_warning(now_in(run)//'the ground is strained by up to '//short(100*largest)// &
         ' %, most at '//place_text(at)//'. Strains are taken as small and the geometry as that of the start: '// &
         'volumes, weights and stresses there err by about as much.', once='strain')
   end subroutine warn_of_strain

   !> Finds the largest magnitude of the principal strains.
   pure real(wp) function principal(strain)
      real(wp), intent(in) :: strain(4)   !< rr, zz, tt, engineering shear.
      real(wp) :: mean, radius

      mean = 0.5_wp*(strain(1) + strain(2))
      radius = 0.5_wp*hypot(strain(1) - strain(2), strain(4))
      principal = max(abs(mean) + radius, abs(strain(3)))
   end function principal
end module alarms
