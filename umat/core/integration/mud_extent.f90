! SPDX-License-Identifier: MIT
!> Size of an increment beside the stiffness of a point.
module mud_extent
   use mud_kinds, only: wp
   use mud_cutoff, only: soil_void_ratio
   use mud_elastic, only: bulk_modulus
   use mud_increment, only: increment_t
   use mud_params, only: params_t
   use mud_rates, only: stress_ratio
   use mud_state, only: state_t
   implicit none (type, external)
   private
   public :: extent_of
contains
   !> Size of an increment in units of strain [-]: suction counts with the bulk modulus. docs/theory/integration.md
   !> section 3.
   pure real(wp) function extent_of(par, inc, state) result(size)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(state_t), intent(in) :: state
      real(wp) :: p, r(6)

      size = inc%length
      if (abs(inc%d_pc) <= 0.0_wp) return
      call stress_ratio(par, state%sigma, p, r)
      size = size + abs(inc%d_pc)/bulk_modulus(par%elastic, soil_void_ratio(state), p)
   end function extent_of
end module mud_extent
