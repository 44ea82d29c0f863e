! SPDX-License-Identifier: MIT
!> Derivatives of a substep inside the elastic domain, in closed form; derivative of docs/theory/memory-rules.md
!> section 4.3.
module mud_inside_changes
   use mud_driving, only: driving_t, change_of_place
   use mud_elastic, only: bulk_modulus, pressure_root, changed_centre_modulus, compressed
   use mud_increment, only: increment_t, void_ratio_at, volume_from_centre
   use mud_kinds, only: wp
   use mud_options, only: changes_of_moved
   use mud_params, only: params_t
   use mud_rates, only: stress_ratio, p_follows
   use mud_tensor, only: DIRECTIONS, deviator
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: changes_inside
contains
   !> Derivatives of that vector, y0 where it begins: its start moves by `shift` in pseudo-time, its size changes by dh.
   !> The void ratio of the centre does not change. Derivative of docs/theory/memory-rules.md section 4.3.
   pure subroutine changes_inside(par, inc, y0, time, h, shift, dh, driving, y)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: y0(NY), time, h, shift(DIRECTIONS), dh(DIRECTIONS)
      type(driving_t), intent(in) :: driving
      real(wp), intent(inout) :: y(DIRECTIONS, NY)
      real(wp), dimension(DIRECTIONS) :: de, de_end, dp_c, share, mean, dg, dp
      real(wp) :: p, r(6), e, e_end, p_end, k, root, g, slopes(3), d_e(6), per_e
      integer :: i

      call stress_ratio(par, y0(1:6), p, r)
      e = void_ratio_at(inc, time)
      e_end = void_ratio_at(inc, time + h)
      k = bulk_modulus(par%elastic, e, p)
      root = pressure_root(par%elastic, e, k)
      p_end = compressed(par%elastic, root, log(e/e_end))
      call change_of_place(inc, time, e, shift, driving, de, dp_c)
      call change_of_place(inc, time + h, e_end, shift + dh, driving, de_end, dp_c)
      mean = (y(:, 1) + y(:, 2) + y(:, 3))/3.0_wp
      share = 0.0_wp
      if (p_follows(par, y0(1:6))) share = mean/p
      call changed_centre_modulus(par%elastic, e, k, volume_from_centre(inc, time), g, slopes)
      dg = 2.0_wp*h*(slopes(1)*share + (slopes(2) - slopes(3)/(1.0_wp + e))*de) + 2.0_wp*g*dh
      per_e = bulk_modulus(par%elastic, e_end, abs(p_end))*e_end/(1.0_wp + e_end)
      dp = per_e*(share*(root/par%elastic%k_0) + de/e - de_end/e_end)
      d_e = deviator(inc%d_strain)
      do i = 1, 6
         y(:, i) = y(:, i) + d_e(i)*dg + (2.0_wp*g*h)*driving%d_strain%of(:, i)
         if (i <= 3) y(:, i) = y(:, i) + (dp - mean - (2.0_wp/3.0_wp*g*h)*driving%d_v)
      end do
      call changes_of_moved(par, inc%d_v, h, y0, dh, driving%d_v, y)
   end subroutine changes_inside
end module mud_inside_changes
