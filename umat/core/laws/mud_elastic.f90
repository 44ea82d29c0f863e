! SPDX-License-Identifier: MIT
!> Elastic moduli; docs/theory/material.md section 3.1.
module mud_elastic
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: elastic_t, bulk_modulus, bulk_slope, shear_modulus, shear_slope, swelling_slope, elastic_tangent, &
             add_elastic, pressure_root, compressed, centre_modulus, elastic_moduli, changed_centre_modulus, &
             BULK_EXPONENT, SHEAR_EXPONENT, STIFF_ABOVE

   real(wp), parameter :: BULK_EXPONENT = 2.0_wp/3.0_wp, SHEAR_EXPONENT = 0.5_wp   !< Exponents of p' in K and in G [-].
   !> Void ratio of eq. (3) at which G vanishes: its square grows again beyond, where it means nothing [-].
   real(wp), parameter :: STIFF_ABOVE = 2.97_wp

   !> Parameters of the moduli, as in mud_registry.
   type :: elastic_t
      real(wp) :: k_0, g_0, p_atm, p_min
   end type elastic_t
contains
   !> Bulk modulus K [kPa] at a void ratio [-] and a mean effective stress [kPa], paper eq. (2). Neither e > 0 nor p > 0
   !> is checked.
   pure real(wp) function bulk_modulus(par, e, p) result(k)
      type(elastic_t), intent(in) :: par
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
      type(elastic_t), intent(in) :: par
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

   !> Cubic root of p'/p_atm at a void ratio [-] from K there [kPa]: eq. (2) without a power.
   pure real(wp) function pressure_root(par, e, k)
      type(elastic_t), intent(in) :: par
      real(wp), intent(in) :: e, k

      pressure_root = sqrt(k*e/((1.0_wp + e)*par%k_0*par%p_atm))
   end function pressure_root

   !> Mean effective stress [kPa] after an elastic change of the void ratio, ln(e before/e after) [-]: with eq. (2)
   !> (p'/p_atm)^(1/3) + K_0/3 ln e does not change. `root` is that of pressure_root before; the stress is negative
   !> where the root falls below 0. docs/theory/memory-rules.md section 4.3.
   pure real(wp) function compressed(par, root, log_ratio)
      type(elastic_t), intent(in) :: par
      real(wp), intent(in) :: root, log_ratio

      compressed = par%p_atm*(root + par%k_0/3.0_wp*log_ratio)**3
   end function compressed

   !> Void ratio of the centre of the elastic domain, a volumetric strain v behind a void ratio e, and ln(e/e_centre),
   !> by rational functions that cost less than exp and log. All [-]; |v| is below 0.0174 because rho_e is at most 0.01,
   !> and what is left out below 1e-10 for e above 0.3. docs/theory/memory-rules.md section 4.3.
   pure subroutine find_centre(e, v, e_centre, log_ratio)
      real(wp), intent(in) :: e, v
      real(wp), intent(out) :: e_centre, log_ratio
      real(wp) :: even, z

      even = 1.0_wp + v*v/12.0_wp
      e_centre = (1.0_wp + e)*(even + 0.5_wp*v)/(even - 0.5_wp*v) - 1.0_wp
      z = (e - e_centre)/(e + e_centre)
      log_ratio = 2.0_wp*z*(1.0_wp + z*z*(1.0_wp/3.0_wp + 0.2_wp*z*z))
   end subroutine find_centre

   !> Shear modulus [kPa] at the centre of the elastic domain, which is a volumetric strain v [-] behind a point of void
   !> ratio e [-] and bulk modulus K [kPa]. docs/theory/memory-rules.md section 4.3.
   pure real(wp) function centre_modulus(par, e, k, v) result(g)
      type(elastic_t), intent(in) :: par
      real(wp), intent(in) :: e, k, v
      real(wp) :: e_centre, log_ratio

      call find_centre(e, v, e_centre, log_ratio)
      g = shear_modulus(par, e_centre, max(compressed(par, pressure_root(par, e, k), log_ratio), par%p_min))
   end function centre_modulus

   !> Moduli K, G [kPa] of an elastic strain at a void ratio [-] and a mean effective stress [kPa], a volumetric strain
   !> v [-] from the centre of the elastic domain. docs/theory/material.md section 3.1, docs/theory/memory-rules.md
   !> section 4.3.
   pure subroutine elastic_moduli(par, e, p, v, k, g)
      type(elastic_t), intent(in) :: par
      real(wp), intent(in) :: e, p, v
      real(wp), intent(out) :: k, g

      k = bulk_modulus(par, e, p)
      g = centre_modulus(par, e, k, v)
   end subroutine elastic_moduli

   !> Modulus at the centre and its slopes by ln p', e and v [kPa]; derivative of docs/theory/memory-rules.md 4.3.
   pure subroutine changed_centre_modulus(par, e, k, v, g, slopes)
      type(elastic_t), intent(in) :: par
      real(wp), intent(in) :: e, k, v
      real(wp), intent(out) :: g, slopes(3)
      real(wp) :: e_centre, log_ratio, p_centre, root, per_root, by_e_centre

      call find_centre(e, v, e_centre, log_ratio)
      root = pressure_root(par, e, k)
      p_centre = compressed(par, root, log_ratio)
      g = shear_modulus(par, e_centre, max(p_centre, par%p_min))
      by_e_centre = shear_slope(e_centre)
      slopes = 0.0_wp
      if (p_centre > par%p_min) then
         per_root = 3.0_wp*SHEAR_EXPONENT/(root + par%k_0/3.0_wp*log_ratio)
         slopes(1) = per_root*root/3.0_wp
         slopes(2) = per_root*par%k_0/(3.0_wp*e)
         by_e_centre = by_e_centre - per_root*par%k_0/(3.0_wp*e_centre)
      end if
      slopes(2) = slopes(2) + by_e_centre*(1.0_wp + e_centre)/(1.0_wp + e)
      slopes(3) = by_e_centre*(1.0_wp + e_centre)
      slopes = g*slopes
   end subroutine changed_centre_modulus

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
