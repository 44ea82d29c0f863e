! SPDX-License-Identifier: MIT
!> Reproducible random states and increments for tests: the same on every machine and compiler.
module random_states
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_kinds, only: wp
   use mud_tensor, only: deviator, norm
   implicit none (type, external)
   private
   public :: random_t, uniform, log_uniform, random_tensor, random_deviator

   !> A generator of its own, since random_number differs between compilers (Park & Miller's minimal standard).
   type :: random_t
      integer(int64) :: seed = 20211_int64
   end type random_t
contains
   !> Uniform between lower and upper.
   real(wp) function uniform(random, lower, upper)
      type(random_t), intent(inout) :: random
      real(wp), intent(in) :: lower, upper

      random%seed = mod(48271_int64*random%seed, 2147483647_int64)
      uniform = lower + (upper - lower)*real(random%seed, wp)/2147483647.0_wp
   end function uniform

   !> Uniform in the logarithm.
   real(wp) function log_uniform(random, lower, upper)
      type(random_t), intent(inout) :: random
      real(wp), intent(in) :: lower, upper

      log_uniform = exp(uniform(random, log(lower), log(upper)))
   end function log_uniform

   !> A symmetric tensor of unit norm.
   function random_tensor(random) result(a)
      type(random_t), intent(inout) :: random
      real(wp) :: a(6)
      integer :: i

      do i = 1, 6
         a(i) = uniform(random, -1.0_wp, 1.0_wp)
      end do
      a = a/norm(a)
   end function random_tensor

   !> A deviator of unit norm.
   function random_deviator(random) result(a)
      type(random_t), intent(inout) :: random
      real(wp) :: a(6)

      a = deviator(random_tensor(random))
      a = a/norm(a)
   end function random_deviator
end module random_states
