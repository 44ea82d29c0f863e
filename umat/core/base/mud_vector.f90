! SPDX-License-Identifier: MIT
!> Places in the vector that is integrated; docs/theory/integration.md section 1.
module mud_vector
   implicit none (type, external)
   private
   public :: NY, Y_Z, Y_Z_END, Y_SHEAR, Y_OPTIONS, N_OPTIONS, WIDTH

   ! sigma' [kPa] stands first, 1 to 6.
   integer, parameter :: Y_Z = 7, Y_Z_END = 12   !< fabric [-]
   integer, parameter :: Y_SHEAR = 13            !< plastic shear since the substep began [-]
   integer, parameter :: N_OPTIONS = 3           !< Numbers of options; each has its places in its own file.
   integer, parameter :: Y_OPTIONS = Y_SHEAR + 1   !< the first of them
   integer, parameter :: NY = Y_SHEAR + N_OPTIONS
   integer, parameter :: WIDTH = 8               !< Points that umat/lanes integrates side by side.
end module mud_vector
