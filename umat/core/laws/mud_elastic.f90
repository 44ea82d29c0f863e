! SPDX-License-Identifier: MIT
!> Elastic moduli; docs/theory/material.md section 3.1.
module mud_elastic
   use mud_kinds, only: wp
   use mud_params, only: params_t
   implicit none (type, external)
   private
   public :: bulk_modulus, bulk_slope, shear_modulus, shear_slope, swelling_slope, elastic_tangent, add_elastic, &
             BULK_EXPONENT, SHEAR_EXPONENT, STIFF_ABOVE

   real(wp), parameter :: BULK_EXPONENT = 2.0_wp/3.0_wp, SHEAR_EXPONENT = 0.5_wp   !< Exponents of p' in K and in G [-].
   !> Void ratio of eq. (3) at which G vanishes: its square grows again beyond, where it means nothing [-].
   real(wp), parameter :: STIFF_ABOVE = 2.97_wp
contains
   !> Bulk modulus K [kPa] at a void ratio [-] and a mean effective stress [kPa], paper eq. (2). Neither e > 0 nor p > 0
   !> is checked.
   pure real(wp) function bulk_modulus(par, e, p) result(k)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, p

      k = par%k_0*par%p_atm*(1.0_wp + e)/e*(p/par%p_atm)**BULK_EXPONENT
   end function bulk_modulus

   !> d ln K/de [-].
   pure real(wp) function bulk_slope(e) result(slope)
      real(wp), intent(in) :: e

      slope = 1.0_wp/(1.0_wp + e) - 1.0_wp/e
   end function bulk_slope

   !> Shear modulus G [kPa], paper eq. (3). At a void ratio [-] and a mean effective stress [kPa]; p >= 0 is not
   !> checked.
   pure real(wp) function shear_modulus(par, e, p) result(g)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: e, p

      g = par%g_0*par%p_atm*(STIFF_ABOVE - e)**2/(1.0_wp + e)*sqrt(p/par%p_atm)
   end function shear_modulus

   !> d ln G/de [-]. At e = 2.97 modulus and slope are zero: the part that has no limit is left out.
   pure real(wp) function shear_slope(e) result(slope)
      real(wp), intent(in) :: e

      slope = -1.0_wp/(1.0_wp + e)
      if (abs(STIFF_ABOVE - e) > epsilon(e)) slope = slope - 2.0_wp/(STIFF_ABOVE - e)
   end function shear_slope

   !> Slope kappa [-] of elastic swelling in ln e - ln p', from K; text below paper eq. (5). K [kPa], e [-], p' [kPa],
   !> all above 0, which is not checked.
   pure real(wp) function swelling_slope(k, e, p) result(kappa)
      real(wp), intent(in) :: k, e, p

      kappa = p/k*(1.0_wp + e)/e
   end function swelling_slope

   !> Elastic stiffness [kPa] at moduli K, G [kPa], a map from engineering strain. Isotropic law of Hooke;
   !> docs/theory/material.md section 4.5.
   pure function elastic_tangent(k, g) result(c)
      real(wp), intent(in) :: k, g
      real(wp) :: c(6, 6)

      c = 0.0_wp
      call add_elastic(k, g, c)
   end function elastic_tangent

   !> Adds the elastic stiffness of the moduli k, g to c [kPa].
   pure subroutine add_elastic(k, g, c)
      real(wp), intent(in) :: k, g
      real(wp), intent(inout) :: c(6, 6)
      real(wp) :: normal(3, 3)
      integer :: i

      normal = k - 2.0_wp/3.0_wp*g
      do i = 1, 3
         normal(i, i) = normal(i, i) + 2.0_wp*g
         c(i + 3, i + 3) = c(i + 3, i + 3) + g
      end do
      c(1:3, 1:3) = c(1:3, 1:3) + normal
   end subroutine add_elastic
end module mud_elastic
