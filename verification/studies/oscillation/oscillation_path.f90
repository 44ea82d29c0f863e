! SPDX-License-Identifier: MIT
!> Strain paths and the noise on them.
module oscillation_path
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: strain_at, direction_at, random_t, uniform, noise_steps, MAX_STEPS

   integer, parameter :: MAX_STEPS = 64   !< Of one event.
   real(wp), parameter :: PI = 3.14159265358979324_wp
   real(wp), parameter :: TRIAXIAL(6) = [1.0_wp, -0.5_wp, -0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp]   !< of axial strain 1
   real(wp), parameter :: SHEAR(6) = [0.0_wp, 0.0_wp, 0.0_wp, sqrt(0.75_wp), 0.0_wp, 0.0_wp] !< of the same length

   !> Park & Miller's minimal generator: the same numbers everywhere.
   type :: random_t
      integer(int64) :: seed = 1
   end type random_t
contains
   !> Strain at a path length s (axial strain where the path is straight).
   !> straight: triaxial compression; turning: it turns into simple shear at the end; unloading: back from s = top.
   pure function strain_at(path, s, top) result(strain)
      character(*), intent(in) :: path
      real(wp), intent(in) :: s, top
      real(wp) :: strain(6), rate

      select case (path)
      case ('turning')
         rate = 0.5_wp*PI/top
         strain = TRIAXIAL*(sin(rate*s)/rate) + SHEAR*((1.0_wp - cos(rate*s))/rate)
      case ('unloading')
         strain = TRIAXIAL*(top - abs(top - s))
      case default
         strain = TRIAXIAL*s
      end select
   end function strain_at

   !> Its rate.
   pure function direction_at(path, s, top) result(rate)
      character(*), intent(in) :: path
      real(wp), intent(in) :: s, top
      real(wp) :: rate(6)

      select case (path)
      case ('turning')
         rate = TRIAXIAL*cos(0.5_wp*PI*s/top) + SHEAR*sin(0.5_wp*PI*s/top)
      case ('unloading')
         rate = sign(1.0_wp, top - s)*TRIAXIAL
      case default
         rate = TRIAXIAL
      end select
   end function direction_at

   !> Strain steps of one event of a size; they add up to nothing.
   subroutine noise_steps(noise, size, along, random, steps, n)
      character(*), intent(in) :: noise
      real(wp), intent(in) :: size, along(6)       !< along: the path's direction
      type(random_t), intent(inout) :: random
      real(wp), intent(out) :: steps(6, MAX_STEPS)
      integer, intent(out) :: n
      real(wp) :: any(6)
      integer :: i

      steps = 0.0_wp
      n = 2
      select case (noise)
      case ('back')
         steps(:, 1) = -size*along
      case ('shear')
         steps(5, 1) = size*SHEAR(4)
      case ('six')
         do i = 1, 6
            any(i) = uniform(random) - 0.5_wp
         end do
         steps(:, 1) = size*any/sqrt(sum(any(1:3)**2) + 2.0_wp*sum(any(4:6)**2))
      case ('nested')
         ! back; half forward and back again, twice, the second time half as far
         n = 6
         steps(:, 1) = -size*along
         steps(:, 2) = 0.5_wp*size*along
         steps(:, 3) = -0.5_wp*size*along
         steps(:, 4) = 0.25_wp*size*along
         steps(:, 5) = -0.25_wp*size*along
      case ('inner')
         ! back; thirty times a quarter forward and back again
         n = 62
         steps(:, 1) = -size*along
         do i = 2, n - 1
            steps(:, i) = (-1)**i*0.25_wp*size*along
         end do
      case default
         error stop 'oscillation_path: no such noise'
      end select
      steps(:, n) = -sum(steps(:, 1:n - 1), 2)
   end subroutine noise_steps

   real(wp) function uniform(random)
      type(random_t), intent(inout) :: random
      integer(int64), parameter :: FACTOR = 16807_int64, MODULUS = 2147483647_int64

      random%seed = mod(FACTOR*random%seed, MODULUS)
      uniform = real(random%seed, wp)/real(MODULUS, wp)
   end function uniform
end module oscillation_path
