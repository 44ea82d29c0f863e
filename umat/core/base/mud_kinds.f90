! SPDX-License-Identifier: MIT
!> Working precision and the few numbers that several modules share.
!> In comments of the core [kPa] stands for the unit of stress of p_atm, whichever it is.
module mud_kinds
   use, intrinsic :: iso_c_binding, only: c_double
   implicit none (type, external)
   private
   public :: wp, SQRT_2_3, SQRT_6, NOTHING

   integer, parameter :: wp = c_double                               !< Working precision, that of the C interface.
   real(wp), parameter :: SQRT_2_3 = 0.81649658092772603_wp          !< Square root of 2/3 [-].
   real(wp), parameter :: SQRT_6 = 2.4494897427831781_wp             !< Square root of 6 [-].
   !> A magnitude below it counts as 0: far below any physical number and any rounding, while the square and the cube of
   !> what is above are numbers by which can be divided.
   real(wp), parameter :: NOTHING = 1.0e-100_wp
end module mud_kinds
