! SPDX-License-Identifier: MIT
!> Findings about the state at the start of a run, for warnings and for what is said of a step that fails.
module start_findings
   use kinds, only: wp
   use material_point, only: range_t
   implicit none (type, external)
   private
   public :: tension_t, balance_t, use_t

   !> Where the points of a region begin, beside the tests behind their law.
   type :: use_t
      integer :: points = 0, outside_e = 0, outside_p = 0   !< Points; outside in void ratio, in mean effective stress.
      type(range_t) :: e = range_t(huge(1.0_wp), -huge(1.0_wp)), p = range_t(huge(1.0_wp), -huge(1.0_wp))
   end type use_t

   !> Points of MUD with a tensile component of the effective stress that the scene prescribes, or with no stress.
   type :: tension_t
      integer :: points = 0
      integer :: bare = 0            !< Points without effective stress: sand has no stiffness there.
      real(wp) :: largest = 0.0_wp   !< [kPa]
      real(wp) :: z = 0.0_wp         !< Where it is [m].
      type(use_t), allocatable :: uses(:)   !< (regions)
   end type tension_t

   !> The largest stress that nothing balances at the start (start_balance).
   type :: balance_t
      logical :: known = .false., matters = .false.   !< Found; more than a share of what is there.
      real(wp) :: stress = 0.0_wp, there = 0.0_wp     !< Without balance; largest total normal stress there [kPa].
      real(wp) :: x(2) = 0.0_wp                       !< Where it is [m].
   end type balance_t
end module start_findings
