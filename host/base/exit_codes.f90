! SPDX-License-Identifier: MIT
!> Exit codes of mud_host in addition to those of `faults`.
module exit_codes
   implicit none (type, external)
   private
   public :: EXIT_MESH, EXIT_GROUP, EXIT_ELEMENT, EXIT_FREE_BODY, EXIT_CONVERGENCE, EXIT_MATERIAL, EXIT_SOLVER, &
             EXIT_ENERGY

   integer, parameter :: EXIT_MESH = 10         !< A mesh that cannot be read or built.
   integer, parameter :: EXIT_GROUP = 11        !< A group, material, history or stage that nobody defines.
   integer, parameter :: EXIT_ELEMENT = 12      !< An inverted element.
   integer, parameter :: EXIT_FREE_BODY = 13    !< A singular system: a body or a pressure that nothing holds.
   integer, parameter :: EXIT_CONVERGENCE = 14  !< No convergence with the smallest step.
   integer, parameter :: EXIT_MATERIAL = 15     !< The material refuses the smallest step.
   integer, parameter :: EXIT_SOLVER = 16       !< The linear solver ran out of memory.
   integer, parameter :: EXIT_ENERGY = 18       !< The run created energy (17 is EXIT_RESTART of `faults`).
end module exit_codes
