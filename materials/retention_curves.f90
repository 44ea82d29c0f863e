! SPDX-License-Identifier: MIT
!> Water retention: degree of saturation at a suction and a void ratio, with its slopes.
module retention_curves
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: retention_t, saturation_t, saturated_t, bilogarithmic_t, van_genuchten_t, power_t, table_t

   type :: saturation_t
      real(wp) :: s = 1.0_wp        !< S_w [-]
      real(wp) :: ds_dpc = 0.0_wp   !< at constant void ratio [1/kPa]
      real(wp) :: ds_de = 0.0_wp    !< at constant suction [-]
   end type saturation_t

   type, abstract :: retention_t
   contains
      procedure(at_i), deferred :: at
   end type retention_t

   abstract interface
      !> Degree of saturation and its slopes, units as in saturation_t. Nothing is refused, e > 0 is not checked; the
      !> source of each formula stands with its type.
      pure function at_i(self, p_c, e) result(sat)
         import :: retention_t, saturation_t, wp
         class(retention_t), intent(in) :: self
         real(wp), intent(in) :: p_c   !< [kPa]
         real(wp), intent(in) :: e     !< [-]
         type(saturation_t) :: sat
      end function at_i
   end interface

   !> Always saturated.
   type, extends(retention_t) :: saturated_t
   contains
      procedure :: at => saturated_at
   end type saturated_t

   !> Paper eqs (23), (24): S = S_min + (S_max - S_min) ln(exp(1) + (p_c e**Omega/P_a)**n)**(-m).
   type, extends(retention_t) :: bilogarithmic_t
      real(wp) :: p_a = 5.0_wp, n = 2.0_wp, m = 1.0_wp, omega = 2.0_wp, s_max = 1.0_wp, s_min = 0.0_wp
   contains
      procedure :: at => bilogarithmic_at
   end type bilogarithmic_t

   !> S = S_min + (S_max - S_min) (1 + (alpha p_c)**n)**(-m) (van Genuchten 1980; his constraint is m = 1 - 1/n).
   type, extends(retention_t) :: van_genuchten_t
      real(wp) :: alpha = 0.1_wp   !< [1/kPa]
      real(wp) :: n = 2.0_wp       !< > 1, for a slope at the air entry
      real(wp) :: m = 0.5_wp, s_max = 1.0_wp, s_min = 0.0_wp
   contains
      procedure :: at => van_genuchten_at
   end type van_genuchten_t

   !> S = 1 - a p_c**b, not below s_min.
   type, extends(retention_t) :: power_t
      real(wp) :: a = 0.0_wp, b = 1.0_wp, s_min = 0.0_wp
   contains
      procedure :: at => power_at
   end type power_t

   !> Straight lines between given pairs; constant outside.
   type, extends(retention_t) :: table_t
      real(wp), allocatable :: p_c(:), s(:)
   contains
      procedure :: at => table_at
   end type table_t
contains
   pure function saturated_at(self, p_c, e) result(sat)
      class(saturated_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat

      sat = saturation_t()
   end function saturated_at

   pure function bilogarithmic_at(self, p_c, e) result(sat)
      class(bilogarithmic_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat
      real(wp), parameter :: EULER = 2.7182818284590452_wp, LOG_LARGE = 200.0_wp
      real(wp) :: log_a, a, share, log_sum, s_e, slope

      sat%s = self%s_max
      if (p_c <= 0.0_wp) return
      log_a = self%n*(log(p_c/self%p_a) + self%omega*log(e))
      if (log_a < -LOG_LARGE) return
      ! Beyond it exp(1) is lost in the sum, and the power might overflow.
      if (log_a > LOG_LARGE) then
         log_sum = log_a
         share = 1.0_wp
      else
         a = exp(log_a)
         log_sum = log(EULER + a)
         share = a/(EULER + a)
      end if
      s_e = (self%s_max - self%s_min)*log_sum**(-self%m)
      sat%s = self%s_min + s_e
      slope = -self%m*s_e/log_sum*share*self%n
      sat%ds_dpc = slope/p_c
      sat%ds_de = slope*self%omega/e
   end function bilogarithmic_at

   pure function van_genuchten_at(self, p_c, e) result(sat)
      class(van_genuchten_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat
      real(wp), parameter :: LOG_LARGE = 200.0_wp
      real(wp) :: log_a, share, log_sum, s_e

      sat%s = self%s_max
      if (p_c <= 0.0_wp) return
      log_a = self%n*log(self%alpha*p_c)
      if (log_a < -LOG_LARGE) return
      ! Beyond it the 1 is lost in the sum, and the power might overflow.
      if (log_a > LOG_LARGE) then
         log_sum = log_a
         share = 1.0_wp
      else
         log_sum = log(1.0_wp + exp(log_a))
         share = exp(log_a - log_sum)
      end if
      s_e = (self%s_max - self%s_min)*exp(-self%m*log_sum)
      sat%s = self%s_min + s_e
      sat%ds_dpc = -self%m*self%n*s_e*share/p_c
   end function van_genuchten_at

   pure function power_at(self, p_c, e) result(sat)
      class(power_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat

      if (p_c <= 0.0_wp) return
      sat%s = 1.0_wp - self%a*p_c**self%b
      sat%ds_dpc = -self%a*self%b*p_c**(self%b - 1.0_wp)
      if (sat%s > self%s_min) return
      sat%s = self%s_min
      sat%ds_dpc = 0.0_wp
   end function power_at

   pure function table_at(self, p_c, e) result(sat)
      class(table_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat
      integer :: i, n, low, high

      n = size(self%s)
      sat%s = self%s(1)
      if (p_c <= self%p_c(1)) return
      sat%s = self%s(n)
      if (p_c > self%p_c(n)) return
      ! The pair that the suction lies between, by halves: a measured curve may have thousands.
      low = 1
      high = n
      do while (high - low > 1)
         i = (low + high)/2
         if (p_c > self%p_c(i)) then
            low = i
         else
            high = i
         end if
      end do
      sat%ds_dpc = (self%s(high) - self%s(low))/(self%p_c(high) - self%p_c(low))
      sat%s = self%s(low) + sat%ds_dpc*(p_c - self%p_c(low))
   end function table_at
end module retention_curves
