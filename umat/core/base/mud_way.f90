! SPDX-License-Identifier: MIT
!> Void ratio and suction along an increment: both are known beforehand at every pseudo-time.
module mud_way
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: way_t, void_ratio_on, suction_on, SHORTEST_PHASE

   real(wp), parameter :: SHORTEST_PHASE = 1.0e-9_wp   !< A shorter phase of an increment is left out [-].

   !> Pseudo-time runs from 0 to 1 over the whole increment.
   type :: way_t
      real(wp) :: p_c0, d_pc   !< Suction at the start, and its change [kPa].
      real(wp) :: e0, d_v      !< Void ratio at the start, and the volumetric strain, compression positive [-].
   end type way_t
contains
   !> Void ratio at a pseudo-time: 1 + e falls as exp(-eps_v), exactly [-]. docs/theory/material.md section 1.2.
   pure real(wp) function void_ratio_on(way, time) result(e)
      type(way_t), intent(in) :: way
      real(wp), intent(in) :: time

      e = way%e0
      if (abs(way%d_v) > 0.0_wp) e = (1.0_wp + e)*exp(-way%d_v*time) - 1.0_wp
   end function void_ratio_on

   !> Suction at a pseudo-time [kPa].
   pure real(wp) function suction_on(way, time) result(p_c)
      type(way_t), intent(in) :: way
      real(wp), intent(in) :: time

      p_c = way%p_c0 + time*way%d_pc
   end function suction_on
end module mud_way
