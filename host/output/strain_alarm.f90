! SPDX-License-Identifier: MIT
!> Warning of strains that are not small: equations stand on the geometry of the start. docs/theory/host.md section 2.1.
module strain_alarm
   use kinds, only: wp
   use faults, only: fault_t
   use porous_domain, only: is_present, strain_of
   use run_observer, only: observer_t, STEP
   use run_state, only: run_t, now_in
   use texts, only: short
   use unknown_fields, only: DISPLACEMENTS
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: strain_alarm_t

   type, extends(observer_t) :: strain_alarm_t
      logical :: told = .false.
   contains
      procedure :: hear
   end type strain_alarm_t

   !> Principal strain whose square is a hundredth, with some room for the rounding of one that is prescribed.
   real(wp), parameter :: LARGE = 0.1_wp*(1 + 1.0e-6_wp)
contains
   !> Tells once, at the end of a stage, on standard error, also where the run is quiet.
   subroutine hear(self, event, run, fault)
      class(strain_alarm_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      real(wp) :: strain, largest, at(2)
      integer :: e, g, first

      if (event /= STEP .or. self%told .or. .not. run%last) return
      largest = LARGE
      associate (domain => run%domain, new => run%next, model => run%model)
         first = 1 + findloc(model%stages(:run%at%stage - 1)%zero_displacements, .true., 1, back=.true.)
         do e = 1, size(domain%region_of)
            if (.not. is_present(new, e)) cycle
            ! ground that has joined since then has strains that its displacements do not tell
            if (allocated(model%ground)) then
               if (.not. all(model%ground(e, first:run%at%stage))) cycle
            end if
            do g = 1, domain%rule
               strain = principal(strain_of(domain%gauss(g, e), new%x(:DISPLACEMENTS, domain%mesh%t6(:, e))))
               if (strain <= largest) cycle
               largest = strain
               at = domain%gauss(g, e)%x
               self%told = .true.
            end do
         end do
      end associate
      if (self%told) call print_warning(now_in(run)//'the ground is strained by up to '//short(100*largest)// &
         ' %, most at ('//short(at(1))//', '//short(at(2))//') m. Strains are taken as small and the geometry as '// &
         'that of the start: volumes, weights and stresses there err by about as much.')
   end subroutine hear

   !> Largest magnitude of the principal strains.
   pure real(wp) function principal(strain)
      real(wp), intent(in) :: strain(4)   !< rr, zz, tt, engineering shear.
      real(wp) :: mean, radius

      mean = 0.5_wp*(strain(1) + strain(2))
      radius = 0.5_wp*hypot(strain(1) - strain(2), strain(4))
      principal = max(abs(mean) + radius, abs(strain(3)))
   end function principal
end module strain_alarm
