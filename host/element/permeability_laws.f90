! SPDX-License-Identifier: MIT
!> Relative permeabilities to water and air as functions of the degree of saturation, with floors so that no balance
!> equation vanishes.
!> docs/theory/host.md section 2.6.
module permeability_laws
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: permeability_t, relative_t, relative_permeability, &
             LAW_CONSTANT, LAW_COREY, LAW_MUALEM, LAW_POWER

   integer, parameter :: LAW_CONSTANT = 4   !< k_rw and k_ra as given.
   integer, parameter :: LAW_COREY = 1      !< k_rw = S_e**b, k_ra = (1 - S_e)**2 (1 - S_e**c)
   integer, parameter :: LAW_MUALEM = 2     !< Mualem-van Genuchten with exponent m.
   integer, parameter :: LAW_POWER = 3      !< k_rw = 1 - a (1 - S_w)**b, k_ra as Corey.
   !> Mualem's slopes are infinite at S_e = 0 and 1: S_e is kept this far from both.
   real(wp), parameter :: MARGIN = 1.0e-9_wp
   real(wp), parameter :: MOST_FACTORS = 16.0_wp   !< Whole exponents up to it are multiplied out.

   type :: permeability_t
      character(64) :: name = ''
      integer :: law = LAW_COREY
      real(wp) :: intrinsic = 0.0_wp               !< k [m2]
      real(wp) :: s_min = 0.0_wp, s_max = 1.0_wp   !< S_e = (S_w - s_min)/(s_max - s_min)
      real(wp) :: a = 0.0_wp, b = 3.0_wp, c = 2.0_wp, m = 0.5_wp
      real(wp) :: k_rw = 1.0_wp, k_ra = 1.0_wp     !< Relative permeabilities of LAW_CONSTANT.
      real(wp) :: floor = 1.0e-4_wp
   end type permeability_t

   type :: relative_t
      real(wp) :: w, a     !< k_rw, k_ra [-]
      real(wp) :: dw, da   !< Slopes of k_rw, k_ra against S_w [-].
   end type relative_t
contains
   !> Finds relative permeabilities of water and air and their slopes at a degree of saturation [-]. docs/theory/host.md
   !> section 2.6; LAW_MUALEM is by Mualem (1976) and van Genuchten (1980). Where a limit of S_e or the floor holds the
   !> slope is 0.
   pure function relative_permeability(law, s_w) result(k)
      type(permeability_t), intent(in) :: law
      real(wp), intent(in) :: s_w
      type(relative_t) :: k
      real(wp) :: s, t, slope

      slope = 1.0_wp/(law%s_max - law%s_min)
      s = (s_w - law%s_min)*slope
      if (s < 0.0_wp .or. s > 1.0_wp) slope = 0.0_wp
      s = min(max(s, 0.0_wp), 1.0_wp)
      k = relative_t(law%k_rw, law%k_ra, 0.0_wp, 0.0_wp)
      if (law%law == LAW_CONSTANT) return
      select case (law%law)
      case (LAW_COREY, LAW_POWER)
         t = power(s, law%c)
         k%a = (1 - s)**2*(1 - t)
         k%da = -slope*(1 - s)*(2*(1 - t) + (1 - s)*law%c*power(s, law%c - 1))
         if (law%law == LAW_COREY) then
            k%w = power(s, law%b)
            k%dw = slope*law%b*power(s, law%b - 1)
         else
            t = min(max(1 - s_w, 0.0_wp), 1.0_wp)
            k%w = 1 - law%a*power(t, law%b)
            k%dw = 0.0_wp
            if (t > 0.0_wp) k%dw = law%a*law%b*power(t, law%b - 1)
         end if
      case (LAW_MUALEM)
         if (s < MARGIN .or. s > 1 - MARGIN) slope = 0.0_wp
         s = min(max(s, MARGIN), 1 - MARGIN)
         t = 1 - s**(1/law%m)
         k%w = sqrt(s)*(1 - t**law%m)**2
         k%dw = slope*(1 - t**law%m)*(0.5_wp/sqrt(s)*(1 - t**law%m) &
                                      + 2*sqrt(s)*t**(law%m - 1)*s**(1/law%m - 1))
         k%a = sqrt(1 - s)*t**(2*law%m)
         k%da = slope*(-0.5_wp/sqrt(1 - s)*t**(2*law%m) - 2*sqrt(1 - s)*t**(2*law%m - 1)*s**(1/law%m - 1))
      end select
      call keep_above(law%floor, k%w, k%dw)
      call keep_above(law%floor, k%a, k%da)
   end function relative_permeability

   !> Raises x to a power, by multiplications where the exponent is a small whole number, as those of the defaults are.
   pure real(wp) function power(x, exponent)
      real(wp), intent(in) :: x, exponent
      integer :: n

      n = 0
      if (exponent > 0.0_wp .and. exponent <= MOST_FACTORS) n = int(exponent)
      if (n > 0 .and. abs(exponent - n) <= 0.0_wp) then
         power = x**n
      else
         power = x**exponent
      end if
   end function power

   pure subroutine keep_above(lowest, value, slope)
      real(wp), intent(in) :: lowest
      real(wp), intent(inout) :: value, slope

      if (value > lowest) return
      value = lowest
      slope = 0.0_wp
   end subroutine keep_above
end module permeability_laws
