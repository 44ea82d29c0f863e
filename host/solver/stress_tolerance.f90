! SPDX-License-Identifier: MIT
!> Newton's method and the stress integration ask each other for accuracy: an error of Newton's method below the
!> tolerance of the stresses cannot be reached, since the substeps of a point change with its strain.
!> docs/theory/host.md section 5.1.
module stress_tolerance
   use kinds, only: wp
   use porous_domain, only: region_t
   implicit none (type, external)
   private
   public :: follow_newton, roughness, is_tight

   integer, parameter :: SCHEME_STAYS = 0
   real(wp), parameter :: LEAST = 1.0e-10_wp   !< No stress is integrated to less [-].
contains
   !> Stresses are integrated to the tolerance of the material or to that of Newton's method, whichever
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

   !> Whether stresses are integrated to less than the material has. docs/theory/host.md section 5.1.
   pure logical function is_tight(regions)
      type(region_t), intent(in) :: regions(:)
      integer :: i

      is_tight = .false.
      do i = 1, size(regions)
         is_tight = is_tight .or. regions(i)%law%tolerance < 0.5_wp*regions(i)%stress_tolerance
      end do
   end function is_tight
end module stress_tolerance
