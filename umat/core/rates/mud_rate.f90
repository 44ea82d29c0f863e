! SPDX-License-Identifier: MIT
!> Results of one rate: the state as it sees it, the direction with the moduli there, and the rates.
module mud_rate
   use mud_bonding, only: bonding_t
   use mud_hardening, only: isotropic_t
   use mud_kinds, only: wp
   use mud_options, only: of_options_t
   use mud_vector, only: N_OPTIONS
   implicit none (type, external)
   private
   public :: moduli_t, rate_t

   !> The direction equation in one direction: what a search for its root tries, and a rate keeps of the root.
   type :: moduli_t
      real(wp) :: r_n, x, z_n      !< r:n, (r - r_in):n without its floor, z:n [-]
      real(wp) :: lode             !< g [-]
      real(wp) :: r_b, r_d         !< |r| on the bounding and dilatancy surfaces in the direction of n [-]
      real(wp) :: a_d, d           !< A_d, D [-]
      real(wp) :: h_b              !< 1/h [-]
      real(wp) :: bent, bend_slope !< factor on D of an option that bends, its slope; not set without [-]
      real(wp) :: beta, gamma      !< coefficients [kPa]
      logical :: floored, capped_d, capped_h   !< guards that act
   end type moduli_t

   !> One rate and what its derivatives need. Per unit of the pseudo-time of d_strain, d_pc.
   type, extends(moduli_t) :: rate_t
      ! the point
      real(wp) :: p                !< p' >= p_min [kPa]
      real(wp) :: r(6), r_norm     !< stress ratio and its norm [-]
      real(wp) :: r_moved(6)       !< r - r_in [-]
      real(wp) :: z(6)             !< fabric [-]
      real(wp) :: k, g             !< elastic moduli K, G [kPa]
      type(bonding_t) :: bond      !< bonding, none where saturated
      real(wp) :: psi              !< state parameter [-]
      real(wp) :: m_b, m_d         !< M^b, M^d in triaxial compression [-]
      real(wp) :: a_0, b_0         !< A_0 and h x, softened by options [-]
      type(of_options_t) :: own    !< effects of the options
      type(isotropic_t) :: iso     !< isotropic mechanism
      ! the direction
      logical :: loading           !< L >= 0 was solved for; false: elastic
      real(wp) :: iso_drive        !< A dp'/p' + B of a rate without the isotropic mechanism: above 0 it acts [-]
      real(wp) :: swell            !< L <-D> without the mechanism; set where it has a memory [-]
      logical :: iso_active        !< the isotropic mechanism acts
      real(wp) :: k_e              !< K, or K/(1 + K A/p') [kPa]
      real(wp) :: b_rate           !< B [-]
      real(wp) :: t(6), t_norm     !< t [kPa]
      real(wp) :: n(6)             !< loading direction [-]
      real(wp) :: y                !< 1/(L h) [-]
      real(wp) :: l                !< loading index L [-]
      logical :: iso_kept, no_root, several   !< several: the arc was scanned for roots
      ! the result
      real(wp) :: d_p              !< rate of p' [kPa]
      real(wp) :: d_sigma(6)       !< [kPa]
      real(wp) :: d_z(6)           !< [-]
      real(wp) :: d_eps_q          !< plastic shear, sqrt(2/3) L [-]
      real(wp) :: d_own(N_OPTIONS) !< rates of the numbers of options; 0 where they are off [-]
   end type rate_t
end module mud_rate
