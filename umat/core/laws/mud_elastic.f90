! SPDX-License-Identifier: MIT
!> Elastic moduli; docs/theory/material.md section 3.1.
module mud_elastic
   use mud_kinds, only: wp
   use mud_params, only: params_t
   implicit none (type, external)
   private
   public :: bulk_modulus, shear_modulus, swelling_slope
contains
   !> Bulk modulus K [kPa] at a void ratio [-] and a mean effective stress [kPa], paper eq. (2). Neither e > 0 nor p > 0
   !> is checked.
   pure real(wp) function bulk_modulus(par, e, p) result(k)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, p

      k = par%k_0*par%p_atm*(1.0_wp + e)/e*(p/par%p_atm)**(2.0_wp/3.0_wp)
   end function bulk_modulus

   !> Shear modulus G [kPa], paper eq. (3). At a void ratio [-] and a mean effective stress [kPa]; p >= 0 is not
   !> checked.
   pure real(wp) function shear_modulus(par, e, p) result(g)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, p

      g = par%g_0*par%p_atm*(2.97_wp - e)**2/(1.0_wp + e)*sqrt(p/par%p_atm)
   end function shear_modulus

   !> Slope kappa [-] of elastic swelling in ln e - ln p', from K; text below paper eq. (5). K [kPa], e [-], p' [kPa],
   !> all above 0, which is not checked.
   pure real(wp) function swelling_slope(k, e, p) result(kappa)
      real(wp), intent(in) :: k, e, p

      kappa = p/k*(1.0_wp + e)/e
   end function swelling_slope
end module mud_elastic
