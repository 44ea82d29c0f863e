! SPDX-License-Identifier: MIT
!> Plastic flow: dilatancy and fabric; docs/theory/material.md sections 4.2 and 4.3.
module mud_flow
   use mud_branchless, only: positive, smaller
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: flow_t, dilatancy_factor, dilatancy, fabric_rate

   !> Parameters of dilatancy and fabric, as in mud_registry.
   type :: flow_t
      real(wp) :: a_0, c_z, z_max
      real(wp) :: fabric   !< 1, or 0: fabric does not count [-].
   end type flow_t
contains
   !> A_d = A_0 (1 + <z:n>) [-]. Dafalias & Manzari (2004). a_0 without fabric; docs/theory/material.md section 4.2.
   pure real(wp) function dilatancy_factor(par, a_0, z_n) result(a_d)
      type(flow_t), intent(in) :: par
      real(wp), intent(in) :: a_0   !< A_0 of the rate [-]
      real(wp), intent(in) :: z_n   !< z:n [-]

      a_d = a_0*(1.0_wp + par%fabric*positive(z_n))
   end function dilatancy_factor

   !> D [-] of d eps^p = L (n + D/3 I): in triaxial compression exactly paper eq. (9). docs/theory/material.md section
   !> 4.2.
   pure real(wp) function dilatancy(a_d, r_d, r_n) result(d)
      real(wp), intent(in) :: a_d   !< dilatancy factor [-]
      real(wp), intent(in) :: r_d   !< sqrt(2/3) g M^d: |r| of the dilatancy surface in the direction n [-]
      real(wp), intent(in) :: r_n   !< r:n [-]

      d = a_d*(r_d - r_n)
   end function dilatancy

   !> dz = -c_z <-L D> (z_max n + z), Dafalias & Manzari (2004); grows in dilation only. All [-], L of the rate >= 0; 0
   !> without fabric and in contraction; docs/theory/material.md section 4.3.
   pure function fabric_rate(par, loading, d, n, z) result(dz)
      type(flow_t), intent(in) :: par
      real(wp), intent(in) :: loading, d   !< L and D
      real(wp), intent(in) :: n(6), z(6)
      real(wp) :: dz(6)

      dz = (par%fabric*par%c_z*loading*smaller(d, 0.0_wp))*(par%z_max*n + z)
   end function fabric_rate
end module mud_flow
