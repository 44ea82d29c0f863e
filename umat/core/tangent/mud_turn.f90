! SPDX-License-Identifier: MIT
!> Turn of the direction of a rate with everything it depends on, by the implicit function theorem;
!> docs/theory/integration.md section 5.2.
module mud_turn
   use mud_critical_state, only: lode_slope
   use mud_direction_equation, only: slopes_t, slopes_at
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_tensor, only: ddot, deviator, square
   implicit none (type, external)
   private
   public :: turn_t, find_turn

   !> Turn of the direction n of a rate: the equation's slopes there, and what a change of its terms is divided by.
   type :: turn_t
      type(slopes_t) :: slopes
      real(wp), dimension(6) :: h_n, d_n, gamma_n   !< Derivatives of 1/h, D, gamma by n, [-, -, kPa].
      real(wp), dimension(4) :: on_t, on_r          !< n, h_n, d_n, gamma_n on t and r.
      real(wp) :: inverse(3, 3)
   end type turn_t
contains
   !> The turn of the direction of a rate that loads, by the implicit function theorem: gamma n = t y + beta r gives
   !> gamma dn = y dt + beta dr + t dy - n (dgamma + a) + r (dbeta + b), a = gamma_n:dn, b = beta_n:dn and n:dn = 0,
   !> three scalar equations for dy, a, b. beta_n = K_e (D h_n + d_n/h). docs/theory/integration.md section 5.2.
   pure subroutine find_turn(par, w, turn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(turn_t), intent(inout) :: turn
      real(wp) :: m(3, 3)

      call slopes_at(par, w, w%moduli_t, turn%slopes)
      call find_gradients(par, w, turn)
      associate (on_t => turn%on_t, on_r => turn%on_r)
         on_t = [ddot(w%n, w%t), ddot(turn%h_n, w%t), ddot(turn%d_n, w%t), ddot(turn%gamma_n, w%t)]
         on_r = [w%r_n, ddot(turn%h_n, w%r), ddot(turn%d_n, w%r), ddot(turn%gamma_n, w%r)]
         m(1, :) = [on_t(1), -1.0_wp, on_r(1)]
         m(2, :) = [on_t(4), -w%gamma, on_r(4)]
         m(3, :) = [w%k_e*(w%d*on_t(2) + w%h_b*on_t(3)), 0.0_wp, w%k_e*(w%d*on_r(2) + w%h_b*on_r(3)) - w%gamma]
      end associate
      turn%inverse = inverse_of(m)
   end subroutine find_turn

   !> Derivatives of 1/h, D and gamma with respect to n, their parts along n removed since n:dn = 0.
   pure subroutine find_gradients(par, w, turn)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(turn_t), intent(inout) :: turn   !< with its slopes
      real(wp) :: h_n(6), d_n(6), g_n(6)

      associate (s => turn%slopes)
         g_n = (3.0_wp*lode_slope(par%critical, w%lode)*SQRT_2_3)*deviator(square(w%n))
         d_n = s%d_r*w%r
         if (w%own%bends) d_n = d_n + s%d_x*w%r_moved
         d_n = d_n + s%d_z*w%z + (s%d_r_d*w%m_d)*g_n
         h_n = s%h_r*w%r + s%h_x*w%r_moved + s%h_z*w%z + (s%h_r_d*w%m_d + s%h_r_b*w%m_b)*g_n
      end associate
      turn%d_n = d_n - ddot(d_n, w%n)*w%n
      turn%h_n = h_n - ddot(h_n, w%n)*w%n
      turn%gamma_n = (2.0_wp/3.0_wp*w%p*w%m_b)*(g_n - ddot(g_n, w%n)*w%n) + (2.0_wp*w%g)*turn%h_n
   end subroutine find_gradients

   !> Inverse of a 3 x 3 matrix by cofactors. That m is regular is not checked.
   pure function inverse_of(m) result(inverse)
      real(wp), intent(in) :: m(3, 3)
      real(wp) :: inverse(3, 3)

      inverse(1, 1) = m(2, 2)*m(3, 3) - m(2, 3)*m(3, 2)
      inverse(1, 2) = m(1, 3)*m(3, 2) - m(1, 2)*m(3, 3)
      inverse(1, 3) = m(1, 2)*m(2, 3) - m(1, 3)*m(2, 2)
      inverse(2, 1) = m(2, 3)*m(3, 1) - m(2, 1)*m(3, 3)
      inverse(2, 2) = m(1, 1)*m(3, 3) - m(1, 3)*m(3, 1)
      inverse(2, 3) = m(1, 3)*m(2, 1) - m(1, 1)*m(2, 3)
      inverse(3, 1) = m(2, 1)*m(3, 2) - m(2, 2)*m(3, 1)
      inverse(3, 2) = m(1, 2)*m(3, 1) - m(1, 1)*m(3, 2)
      inverse(3, 3) = m(1, 1)*m(2, 2) - m(1, 2)*m(2, 1)
      inverse = inverse/(m(1, 1)*inverse(1, 1) + m(1, 2)*inverse(2, 1) + m(1, 3)*inverse(3, 1))
   end function inverse_of
end module mud_turn
