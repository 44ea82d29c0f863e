! SPDX-License-Identifier: MIT
!> The unknown fields and their places in arrays over the nodes, as in x(AT_P_W, node).
module unknown_fields
   implicit none (type, external)
   private
   public :: FIELDS, FIELD_NAMES, AT_U_R, AT_U_Z, AT_P_W, AT_P_C, DISPLACEMENTS

   integer, parameter :: FIELDS = 4
   character(3), parameter :: FIELD_NAMES(FIELDS) = ['u_r', 'u_z', 'p_w', 'p_c']
   integer, parameter :: AT_U_R = 1, AT_U_Z = 2   !< Displacements [m]
   integer, parameter :: AT_P_W = 3            !< Pore water pressure [kPa]
   integer, parameter :: AT_P_C = 4            !< Suction [kPa]
   integer, parameter :: DISPLACEMENTS = 2  !< Number of fields that are displacements; they come first.
end module unknown_fields
