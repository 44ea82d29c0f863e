! SPDX-License-Identifier: MIT
!> Isotropic memory: how far compression is from where it was before; docs/theory/material.md section 4.10.
module mud_margin
   use mud_bonding, only: bonding_t
   use mud_elastic, only: swelling_slope
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: margin_t, measure_t, measure, change_of_stiffness, shear_share, DEPTH

   real(wp), parameter :: DEPTH = 0.1_wp   !< u_0, over which contraction by shear ceases to count [-].

   !> Y, whose rate the drive of the isotropic mechanism is proportional to while the soil strains elastically.
   type :: measure_t
      real(wp) :: value                !< ln(p'/p_atm) - 3 kappa/lambda - ln(f)/lambda [-]
      real(wp) :: by_p, by_e, by_pc    !< slopes by p', e, p_c [1/kPa, -, 1/kPa]
      real(wp) :: kappa                !< [-]
   end type measure_t

   !> Parameters of the measure, as in mud_registry.
   type :: margin_t
      real(wp) :: lambda, p_atm
   end type margin_t
contains
   !> The measure at a bonding, a void ratio [-], a mean effective stress [kPa] and the bulk modulus there [kPa].
   pure function measure(par, bond, e, p, k) result(m)
      type(margin_t), intent(in) :: par
      type(bonding_t), intent(in) :: bond
      real(wp), intent(in) :: e, p, k
      type(measure_t) :: m
      real(wp) :: per_f

      m%kappa = swelling_slope(k, e, p)
      per_f = 1.0_wp/(par%lambda*bond%f)
      m%value = log(p/par%p_atm) - 3.0_wp*m%kappa/par%lambda - log(bond%f)/par%lambda
      m%by_p = (1.0_wp - m%kappa/par%lambda)/p
      m%by_e = -per_f*bond%df_de
      m%by_pc = -per_f*bond%df_dpc
   end function measure

   !> d by_p/dp' [1/kPa2]; kappa grows as the cubic root of p'.
   pure real(wp) function change_of_stiffness(par, m, p) result(slope)
      type(margin_t), intent(in) :: par
      type(measure_t), intent(in) :: m
      real(wp), intent(in) :: p

      slope = -(m%by_p + m%kappa/(3.0_wp*par%lambda*p))/p
   end function change_of_stiffness

   !> exp(u/u_0): what contraction by shear counts at a margin u [-].
   pure real(wp) function shear_share(u)
      real(wp), intent(in) :: u

      shear_share = exp(min(u, 0.0_wp)/DEPTH)
   end function shear_share
end module mud_margin
