! SPDX-License-Identifier: MIT
!> Continuum tangent: exact derivative of the rate with respect to the strain rate and the suction rate;
!> docs/theory/integration.md section 5.2. The state rests: as a sum of dyads it costs half of what the derivative of
!> mud_sensitivity would.
module mud_tangent
   use mud_elastic, only: add_elastic
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_tensor, only: IDENTITY, ddot, outer_sum
   use mud_turn, only: turn_t, find_turn
   implicit none (type, external)
   private
   public :: continuum_tangent
contains
   !> d sigma'/d eps [kPa] (engineering strain) and d sigma'/d p_c [-] of one rate.
   !>
   !> gamma dn = y dt + t dy - n a + r b of find_turn: all is n (x) something + r (x) something + a multiple of dt.
   !> Compression positive; w is a rate of rate_at. docs/theory/integration.md section 5.2.
   pure subroutine continuum_tangent(par, w, c, c_pc)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp), intent(out) :: c(6, 6), c_pc(6)
      real(wp), dimension(6) :: beta_n, f_y, f_a, f_b, f_l, f_d, along_n, along_r, on_p
      real(wp) :: m(3, 3), drag, on_p_pc, b_pc
      type(turn_t) :: turn
      integer :: j

      b_pc = 0.0_wp
      if (w%iso_active) b_pc = w%iso%b
      c_pc = 0.0_wp
      on_p = w%k_e*IDENTITY
      on_p_pc = -w%k_e*b_pc
      drag = 0.0_wp
      if (w%loading) then
         call find_turn(par, w, turn)
         beta_n = w%k_e*(w%d*turn%h_n + w%h_b*turn%d_n)
         m = -w%y*turn%inverse
         f_y = m(1, 1)*w%n + m(1, 2)*turn%gamma_n + m(1, 3)*beta_n
         f_a = m(2, 1)*w%n + m(2, 2)*turn%gamma_n + m(2, 3)*beta_n
         f_b = m(3, 1)*w%n + m(3, 2)*turn%gamma_n + m(3, 3)*beta_n
         f_l = along_direction(turn%h_n, 2)/w%y - (w%l/w%y)*f_y
         f_d = along_direction(turn%d_n, 3)
         drag = w%h_b/w%gamma
         along_n = -2.0_wp*w%g*(f_l + (w%l/w%y)*f_y - (w%l/w%gamma)*f_a)
         along_r = -2.0_wp*w%g*(w%l/w%gamma)*(f_b - (w%beta/w%y)*f_y)
         ! r also carries d p' through dt = 2G d e_dev - r K_e (d eps_v - dB)
         call outer_sum(w%n, on_strain(along_n), w%r, on_strain(along_r) + (2.0_wp*w%g*drag*w%k_e)*IDENTITY, c)
         c_pc = w%n*on_suction(along_n) + w%r*(on_suction(along_r) - 2.0_wp*w%g*drag*w%k_e*b_pc)
         f_l = -w%k_e*(w%d*f_l + w%l*f_d)
         on_p = on_p + on_strain(f_l)
         on_p_pc = on_p_pc + on_suction(f_l)
      else
         c = 0.0_wp
      end if
      call add_elastic(0.0_wp, w%g*(1.0_wp - 2.0_wp*w%g*drag), c)
      do j = 1, 6
         c(1:3, j) = c(1:3, j) + on_p(j)
      end do
      c_pc = c_pc + IDENTITY*on_p_pc
   contains
      !> gradient:dn as a functional of dt; its place among the contractions of turn.
      pure function along_direction(gradient, place) result(f)
         real(wp), intent(in) :: gradient(6)
         integer, intent(in) :: place
         real(wp) :: f(6)

         f = (w%y*gradient + turn%on_t(place)*f_y + turn%on_r(place)*f_b)/w%gamma
      end function along_direction

      !> A functional of dt as one of the strain.
      pure function on_strain(f) result(on_eps)
         real(wp), intent(in) :: f(6)
         real(wp) :: on_eps(6)

         on_eps = 2.0_wp*w%g*f - w%k_e*ddot(f, w%r)*IDENTITY
      end function on_strain

      !> A functional of dt as one of the suction.
      pure real(wp) function on_suction(f)
         real(wp), intent(in) :: f(6)

         on_suction = w%k_e*ddot(f, w%r)*b_pc
      end function on_suction
   end subroutine continuum_tangent
end module mud_tangent
