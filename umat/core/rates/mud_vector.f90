! SPDX-License-Identifier: MIT
!> Places in the vector that is integrated; docs/theory/integration.md section 1.
module mud_vector
   implicit none (type, external)
   private
   public :: NY, Y_Z, Y_Z_END, Y_SHEAR, Y_LOG_CHI, Y_CONTRACTION, Y_FLUIDITY

   ! sigma' [kPa] stands first, 1 to 6. Numbers of effects that may be off stand last.
   integer, parameter :: Y_Z = 7, Y_Z_END = 12   !< fabric [-]
   integer, parameter :: Y_SHEAR = 13         !< plastic shear since the substep began [-]
   integer, parameter :: Y_LOG_CHI = 14       !< cyclic preloading: ln of the contraction that other processes left [-]
   integer, parameter :: Y_CONTRACTION = 15   !< cyclic preloading: contraction since the substep began [-]
   integer, parameter :: Y_FLUIDITY = 16      !< fluidity [-]
   integer, parameter :: NY = 16
end module mud_vector
