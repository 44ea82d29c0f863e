! SPDX-License-Identifier: MIT
!> A record of the substeps that an update tried, to find out why it failed.
module mud_trace
   use, intrinsic :: iso_c_binding, only: c_int, c_double
   implicit none (type, external)
   private
   public :: substep_t, trace_t, SUBSTEP_REJECTED, SUBSTEP_ACCEPTED, SUBSTEP_FAILED

   integer, parameter :: SUBSTEP_REJECTED = 0, SUBSTEP_ACCEPTED = 1
   integer, parameter :: SUBSTEP_FAILED = 2   !< The update ended here.

   !> struct mud_substep of mud.h; here the stress is compression positive.
   type, bind(c) :: substep_t
      integer(c_int) :: outcome, mode, jump, landed, n_rate, n_reset, n_guard, n_no_root
      real(c_double) :: time, size, error, void_ratio, saturation, suction, stress(6)
   end type substep_t

   !> The substeps from number `first` on, as many as there are rows; rows are the caller's.
   type :: trace_t
      integer :: first = 1
      integer :: attempts = 0   !< Substeps tried, recorded or not.
      type(substep_t), pointer :: rows(:) => null()
   end type trace_t
end module mud_trace
