! SPDX-License-Identifier: MIT
!> Continuum tangent: exact derivative of the rate with respect to the strain rate and the suction rate;
!> docs/theory/integration.md section 5.2.
module mud_tangent
   use mud_kinds, only: wp, SQRT_2_3
   use mud_params, only: params_t
   use mud_rates, only: rate_t
   use mud_tensor, only: IDENTITY, ddot, deviator, square, outer_add
   implicit none (type, external)
   private
   public :: continuum_tangent, elastic_tangent, gradients, inverse_of
contains
   !> Elastic stiffness [kPa] at moduli K, G [kPa], a map from engineering strain. Isotropic law of Hooke;
   !> docs/theory/material.md section 4.5.
   pure function elastic_tangent(k, g) result(c)
      real(wp), intent(in) :: k, g
      real(wp) :: c(6, 6)
      integer :: i

      c = 0.0_wp
      c(1:3, 1:3) = k - 2.0_wp/3.0_wp*g
      do i = 1, 3
         c(i, i) = c(i, i) + 2.0_wp*g
         c(i + 3, i + 3) = g
      end do
   end function elastic_tangent

   !> d sigma'/d eps [kPa] (engineering strain) and d sigma'/d p_c [-] of one rate.
   !>
   !> From gamma n = t y + beta r: gamma dn = y dt + t dy - n a + r b with a = gamma_n:dn, b = beta_n:dn, n:dn = 0,
   !> three scalar equations for dy, a, b. Everything is then n (x) something + r (x) something + a multiple of dt.
   !> Compression positive; w is a rate of rate_at. docs/theory/integration.md section 5.2.
   pure subroutine continuum_tangent(par, w, c, c_pc)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp), intent(out) :: c(6, 6), c_pc(6)
      real(wp), dimension(6) :: h_n, d_n, beta_n, gamma_n, f_y, f_a, f_b, f_l, f_d, along_n, along_r, on_p
      real(wp) :: m(3, 3), inverse(3, 3), drag, on_p_pc, b_pc

      b_pc = 0.0_wp
      if (w%iso_active) b_pc = w%iso%b
      c = 0.0_wp
      c_pc = 0.0_wp
      on_p = w%k_e*IDENTITY
      on_p_pc = -w%k_e*b_pc
      drag = 0.0_wp
      if (w%loading) then
         call gradients(par, w, h_n, d_n, gamma_n)
         beta_n = w%k_e*(w%d*h_n + w%h_b*d_n)
         m(1, :) = [ddot(w%t, w%n), -1.0_wp, w%r_n]
         m(2, :) = [ddot(gamma_n, w%t), -w%gamma, ddot(gamma_n, w%r)]
         m(3, :) = [ddot(beta_n, w%t), 0.0_wp, ddot(beta_n, w%r) - w%gamma]
         inverse = -w%y*inverse_of(m)
         f_y = inverse(1, 1)*w%n + inverse(1, 2)*gamma_n + inverse(1, 3)*beta_n
         f_a = inverse(2, 1)*w%n + inverse(2, 2)*gamma_n + inverse(2, 3)*beta_n
         f_b = inverse(3, 1)*w%n + inverse(3, 2)*gamma_n + inverse(3, 3)*beta_n
         f_l = along_direction(h_n)/w%y - (w%l/w%y)*f_y
         f_d = along_direction(d_n)
         drag = w%h_b/w%gamma
         along_n = -2.0_wp*w%g*(f_l + (w%l/w%y)*f_y - (w%l/w%gamma)*f_a)
         along_r = -2.0_wp*w%g*(w%l/w%gamma)*(f_b - (w%beta/w%y)*f_y)
         ! r also carries d p' through dt = 2G d e_dev - r K_e (d eps_v - dB)
         call outer_add(w%n, on_strain(along_n), c)
         call outer_add(w%r, on_strain(along_r) + (2.0_wp*w%g*drag*w%k_e)*IDENTITY, c)
         c_pc = w%n*on_suction(along_n) + w%r*(on_suction(along_r) - 2.0_wp*w%g*drag*w%k_e*b_pc)
         f_l = -w%k_e*(w%d*f_l + w%l*f_d)
         on_p = on_p + on_strain(f_l)
         on_p_pc = on_p_pc + on_suction(f_l)
      end if
      c = c + elastic_tangent(0.0_wp, w%g*(1.0_wp - 2.0_wp*w%g*drag))
      call outer_add(IDENTITY, on_p, c)
      c_pc = c_pc + IDENTITY*on_p_pc
   contains
      !> gradient:dn as a functional of dt.
      pure function along_direction(gradient) result(f)
         real(wp), intent(in) :: gradient(6)
         real(wp) :: f(6)

         f = (w%y*gradient + ddot(gradient, w%t)*f_y + ddot(gradient, w%r)*f_b)/w%gamma
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

   !> Derivatives of 1/h, D and gamma with respect to n, their parts along n removed since n:dn = 0; that of beta is K_e
   !> (D h_n + d_n/h). Units [-, -, kPa]; w is a rate that loads. Guards of docs/theory/material.md section 5 included.
   pure subroutine gradients(par, w, h_n, d_n, gamma_n)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      real(wp), dimension(6), intent(out) :: h_n, d_n, gamma_n
      real(wp) :: g_n(6), r_b_n(6), r(6), stiffness

      r = normal(w%r)
      g_n = 0.0_wp
      if (par%lode) g_n = normal(deviator((3.0_wp*w%lode_slope)*square(w%n)))
      r_b_n = (SQRT_2_3*w%m_b)*g_n
      if (w%capped_d) then
         d_n = -(w%d/w%r_n)*r
      else
         d_n = w%a_d*(SQRT_2_3*w%m_d*g_n - r)
         if (par%fabric .and. w%z_n > 0.0_wp) d_n = d_n + (par%a_0*w%d/w%a_d)*normal(w%z)
      end if
      if (w%capped_h) then
         stiffness = 2.0_wp*w%g - w%k_e*w%d*w%r_n
         h_n = (2.0_wp/3.0_wp*w%p/((1.0_wp - par%cap_h)*stiffness))*(r - r_b_n) &
               + (w%h_b/stiffness*w%k_e)*(w%r_n*d_n + w%d*r)
      else if (w%floored) then
         h_n = 0.0_wp
      else
         h_n = normal(w%r_moved)/w%b_0
      end if
      gamma_n = (2.0_wp/3.0_wp*w%p)*r_b_n + (2.0_wp*w%g)*h_n
   contains
      pure function normal(a) result(b)
         real(wp), intent(in) :: a(6)
         real(wp) :: b(6)

         b = a - ddot(a, w%n)*w%n
      end function normal
   end subroutine gradients

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
end module mud_tangent
