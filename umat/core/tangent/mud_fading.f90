! SPDX-License-Identifier: MIT
!> Derivatives of the parts of the rates that fade where the elastic domain turns; derivative of
!> docs/theory/integration.md section 2.2.
module mud_fading
   use mud_kinds, only: wp
   use mud_tensor, only: DIRECTIONS
   use mud_transient, only: transient_t, split
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: fading_t, NO_FADING, begin_fading, change_of_left, add_changes_of_faded

   !> Changes of the parts that fade, along the directions of a derivative.
   type :: fading_t
      real(wp) :: parts(DIRECTIONS, NY, 2), speed(DIRECTIONS), since(DIRECTIONS)
   end type fading_t
   type(fading_t), parameter :: NO_FADING = fading_t(0.0_wp, 0.0_wp, 0.0_wp)

   !> k t beyond which the parts are below rounding [-].
   real(wp), parameter :: GONE = 40.0_wp
contains
   !> Changes of the parts from those of the three rates, half that of two terms; k changes by speed, the time from
   !> which they fade by since. Derivative of docs/theory/integration.md section 2.2.
   pure subroutine begin_fading(now, far, speed, since, fading, half)
      real(wp), intent(in), dimension(DIRECTIONS, NY) :: now, far
      real(wp), intent(in), dimension(DIRECTIONS) :: speed, since
      type(fading_t), intent(inout) :: fading
      real(wp), intent(in), optional :: half(DIRECTIONS, NY)

      if (present(half)) then
         call split(now, far, half, fading%parts(:, :, 1), fading%parts(:, :, 2))
      else
         fading%parts(:, :, 1) = now - far
         fading%parts(:, :, 2) = 0.0_wp
      end if
      fading%speed = speed
      fading%since = since
   end subroutine begin_fading

   !> Changes of a vector: what fades is taken of the rates that lead to it, and added as it is. `weights` are those of
   !> the rates, h the size of the substep; left and d_left belong to them, then to where the vector stands: at the
   !> start of the substep, at its stages, there. y as the integrated vector, its first columns. Derivative of
   !> docs/theory/integration.md section 2.2.
   pure subroutine add_changes_of_faded(transient, fading, n, h, weights, left, d_left, live, y)
      type(transient_t), intent(in) :: transient
      type(fading_t), intent(in) :: fading
      integer, intent(in) :: n, live   !< live: numbers that may change
      real(wp), intent(in) :: h, weights(n), left(n + 1), d_left(DIRECTIONS, n + 1)
      real(wp), intent(inout) :: y(DIRECTIONS, live)
      real(wp) :: factors(2), along(DIRECTIONS, 2), weight
      integer :: i

      if (left(1) <= 0.0_wp) return
      associate (before => left(1), after => left(n + 1))
         factors(1) = (before - after)/transient%speed
         factors(2) = 0.5_wp*(before + after)*factors(1)
         if (transient%terms == 0) then
            factors(1) = factors(1) - h*dot_product(weights, left(1:n))
            do i = 1, live
               y(:, i) = y(:, i) + factors(1)*fading%parts(:, i, 1)
            end do
            return
         end if
         along(:, 1) = (d_left(:, 1) - d_left(:, n + 1) - factors(1)*fading%speed)/transient%speed
         along(:, 2) = (before*d_left(:, 1) - after*d_left(:, n + 1) - factors(2)*fading%speed)/transient%speed
      end associate
      ! the compiler is to take two directions at once, not two of the loops around them
      !GCC$ NOVECTOR
      do i = 1, n
         weight = h*weights(i)
         factors = factors - weight*[left(i), left(i)**2]
         along(:, 1) = along(:, 1) - weight*d_left(:, i)
         along(:, 2) = along(:, 2) - (2.0_wp*weight*left(i))*d_left(:, i)
      end do
      if (transient%terms == 1) then
         !GCC$ NOVECTOR
         do i = 1, live
            y(:, i) = y(:, i) + factors(1)*fading%parts(:, i, 1) + along(:, 1)*transient%parts(i, 1)
         end do
         return
      end if
      do i = 1, live
         y(:, i) = y(:, i) + factors(1)*fading%parts(:, i, 1) + factors(2)*fading%parts(:, i, 2) &
                   + along(:, 1)*transient%parts(i, 1) + along(:, 2)*transient%parts(i, 2)
      end do
   end subroutine add_changes_of_faded

   !> Share that is left of the first part at a pseudo-time that changes by dt, and the change of this share [-]; zeros
   !> where it is below rounding. Derivative of docs/theory/integration.md section 2.2.
   pure subroutine change_of_left(transient, fading, time, dt, left, change)
      type(transient_t), intent(in) :: transient
      type(fading_t), intent(in) :: fading
      real(wp), intent(in) :: time, dt(DIRECTIONS)
      real(wp), intent(out) :: left, change(DIRECTIONS)

      left = 0.0_wp
      change = 0.0_wp
      if (transient%speed*(time - transient%since) > GONE) return
      left = exp(-transient%speed*(time - transient%since))
      change = -left*((time - transient%since)*fading%speed + transient%speed*(dt - fading%since))
   end subroutine change_of_left
end module mud_fading
