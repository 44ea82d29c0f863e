! SPDX-License-Identifier: MIT
!> Precision and constants of the programs.
module kinds
   use, intrinsic :: iso_fortran_env, only: wp => real64
   implicit none (type, external)
   private
   public :: wp, PI

   real(wp), parameter :: PI = 3.14159265358979323846_wp
end module kinds
