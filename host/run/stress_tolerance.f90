! SPDX-License-Identifier: MIT
!> Newton's method and the stress integration ask each other for accuracy: an error of Newton's method below the
!> tolerance of the stresses cannot be reached, since the substeps of a point change with its strain.
!> docs/theory/host.md section 5.1.
module stress_tolerance
   use warnings, only: print_warning
   use kinds, only: wp
   use convergence, only: control_t, log_t
   use porous_domain, only: region_t
   use texts, only: short
   use scene_types, only: stage_t
   implicit none (type, external)
   private
   public :: follow_newton, roughness, warn_stagnation

   integer, parameter :: SCHEME_STAYS = 0
   real(wp), parameter :: LEAST = 1.0e-10_wp   !< No stress is integrated to less [-].
contains
   !> Before a step: stresses are integrated to the tolerance of the material or to that of Newton's method, whichever
   !> is smaller. docs/theory/host.md section 5.1.
   subroutine follow_newton(tolerance, regions)
      real(wp), intent(in) :: tolerance   !< Newton's [-].
      type(region_t), intent(inout) :: regions(:)
      real(wp) :: wanted
      integer :: i

      do i = 1, size(regions)
         associate (law => regions(i)%law)
            if (.not. law%tolerance > 0.0_wp) cycle
            wanted = min(regions(i)%stress_tolerance, max(tolerance, LEAST))
            if (abs(wanted - law%tolerance) > epsilon(1.0_wp)*wanted) call law%integrate_to(wanted, SCHEME_STAYS)
         end associate
      end do
   end subroutine follow_newton

   !> Largest tolerance of the stress integration; 0 without one. [-] docs/theory/host.md section 5.1.
   pure real(wp) function roughness(regions)
      type(region_t), intent(in) :: regions(:)
      integer :: i

      roughness = 0.0_wp
      do i = 1, size(regions)
         roughness = max(roughness, regions(i)%law%tolerance)
      end do
   end function roughness

   !> After an accepted step whose error stagnated: once a stage, on standard error, also where the run is quiet.
   !> docs/theory/host.md section 5.1. Raises no fault.
   subroutine warn_stagnation(stage, control, time, log, told)
      type(stage_t), intent(in) :: stage
      type(control_t), intent(in) :: control
      real(wp), intent(in) :: time   !< [s]
      type(log_t), intent(in) :: log
      logical, intent(inout) :: told

      if (told .or. .not. log%stagnated) return
      told = .true.
      call print_warning('stage '//trim(stage%name)//', time '//short(time)// &
         ' s: Newton''s method stays at an error of '//short(maxval(log%error))//' and cannot reach its tolerance '// &
         'of '//short(control%tolerance)//', because stresses are integrated to '//short(control%roughness)// &
         '. The step is accepted. Give &stage a tolerance above the error reached, or the material a smaller one.')
   end subroutine warn_stagnation
end module stress_tolerance
