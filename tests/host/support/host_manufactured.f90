!> A manufactured solution of the three balances: fields in closed form, and the sources that make them a solution,
!> from sixth-order differences of the fluxes and densities as the theory writes them, without the element's code.
module host_manufactured
   use host_kinds, only: wp
   use fe_model, only: model_t
   use fe_permeability, only: relative_t, relative_permeability
   use fe_retention, only: saturation_t
   implicit none (type, external)
   private
   public :: set_problem, fields, fields_rate, fields_accel, sources, pores

   real(wp), parameter :: H = 2.0e-3_wp      !< Step of the differences [m]; their error is H**6.
   real(wp), parameter :: H_T = 2.0e-3_wp    !< The same in time, as a share of the time scale.
   real(wp), parameter :: LAME = 6.0e3_wp, SHEAR = 4.0e3_wp   !< E = 10400 kPa, nu = 0.3
   real(wp), parameter :: AMPLITUDE = 1.0e-3_wp

   type(model_t), save :: model
   logical :: polynomial = .false.   !< Fields that quadratic elements hold exactly, for the order in time.
   real(wp) :: time_scale = 1.0_wp
contains
   subroutine set_problem(of_model, is_polynomial, scale)
      type(model_t), intent(in) :: of_model
      logical, intent(in) :: is_polynomial
      real(wp), intent(in) :: scale

      model = of_model
      model%source => null()
      polynomial = is_polynomial
      time_scale = scale
   end subroutine set_problem

   !> u_r, u_z, p_w, p_c.
   pure function fields(x, t) result(f)
      real(wp), intent(in) :: x(2), t
      real(wp) :: f(4), s

      s = t/time_scale
      associate (r => x(1), z => x(2))
         if (polynomial) then
            f = [AMPLITUDE*r*(0.5_wp + z)*sin(s), AMPLITUDE*(1 + r*r - z*z)*sin(1.3_wp*s), &
                 20 + (5*r*r + 3*z)*sin(s), 30 + (4*z*z - 3*r*r)*sin(0.8_wp*s)]
         else
            f = [AMPLITUDE*sin(2*r)*cos(1.3_wp*z)*s, AMPLITUDE*cos(2.1_wp*r)*sin(2.7_wp*z + 0.3_wp)*s, &
                 20 + 10*cos(2.5_wp*r)*sin(2.2_wp*z)*(1 + 1.0e-3_wp*s), &
                 30 + 8*cos(2.2_wp*r)*cos(2.4_wp*z)*(1 + 1.0e-3_wp*s)]
         end if
      end associate
   end function fields

   pure function fields_rate(x, t) result(f)
      real(wp), intent(in) :: x(2), t
      real(wp) :: f(4)
      integer :: k

      f = 0.0_wp
      do k = -3, 3
         f = f + weight(k)*fields(x, t + k*H_T*time_scale)/(H_T*time_scale)
      end do
   end function fields_rate

   pure function fields_accel(x, t) result(f)
      real(wp), intent(in) :: x(2), t
      real(wp) :: f(4)
      integer :: k

      f = 0.0_wp
      do k = -3, 3
         f = f + weight(k)*fields_rate(x, t + k*H_T*time_scale)/(H_T*time_scale)
      end do
   end function fields_accel

   !> Sixth-order first difference.
   pure real(wp) function weight(k)
      integer, intent(in) :: k
      real(wp), parameter :: W(3) = [0.75_wp, -0.15_wp, 1.0_wp/60]

      weight = 0.0_wp
      if (k /= 0) weight = W(abs(k))*sign(1, k)
   end function weight

   !> Gradients: (field, direction).
   pure function gradients(x, t) result(g)
      real(wp), intent(in) :: x(2), t
      real(wp) :: g(4, 2)
      integer :: k

      g = 0.0_wp
      do k = -3, 3
         g(:, 1) = g(:, 1) + weight(k)*fields([x(1) + k*H, x(2)], t)/H
         g(:, 2) = g(:, 2) + weight(k)*fields([x(1), x(2) + k*H], t)/H
      end do
   end function gradients

   !> Volume strain, void ratio, S_w.
   pure function pores(x, t) result(p)
      real(wp), intent(in) :: x(2), t
      real(wp) :: p(3), g(4, 2), f(4)
      type(saturation_t) :: sat

      g = gradients(x, t)
      f = fields(x, t)
      p(1) = g(1, 1) + g(2, 2)
      if (model%axisymmetric) p(1) = p(1) + f(1)/x(1)
      p(2) = (1 + model%regions(1)%void_ratio)*exp(p(1)) - 1
      sat = model%retentions(model%regions(1)%retention)%law%at(f(4), p(2))
      p(3) = sat%s
   end function pores

   !> Total stress rr, zz, tt, rz, flux of both fluids, flux of air: everything whose divergence is taken.
   pure function fluxes(x, t) result(q)
      real(wp), intent(in) :: x(2), t
      real(wp) :: q(8), g(4, 2), f(4), p(3), hoop, k
      type(relative_t) :: rel

      g = gradients(x, t)
      f = fields(x, t)
      p = pores(x, t)
      hoop = 0.0_wp
      if (model%axisymmetric) hoop = f(1)/x(1)
      q(1:3) = LAME*p(1) + 2*SHEAR*[g(1, 1), g(2, 2), hoop] - (f(3) + (1 - p(3))*f(4))
      q(4) = SHEAR*(g(1, 2) + g(2, 1))
      rel = relative_permeability(model%permeabilities(1), p(3))
      k = model%permeabilities(1)%intrinsic
      q(7:8) = -k*rel%a/model%fluids%eta_a*(g(3, :) + g(4, :) + [0.0_wp, model%fluids%rho_a*model%gravity])
      q(5:6) = q(7:8) - k*rel%w/model%fluids%eta_w*(g(3, :) + [0.0_wp, model%fluids%rho_w*model%gravity])
   end function fluxes

   pure function sources(x, t) result(s)
      real(wp), intent(in) :: x(2), t
      real(wp) :: s(4), dr(8), dz(8), q(8), p(3), rate(3), v(4), a(4), n, rho, curve
      integer :: k

      dr = 0.0_wp
      dz = 0.0_wp
      rate = 0.0_wp
      do k = -3, 3
         if (k == 0) cycle
         dr = dr + weight(k)*fluxes([x(1) + k*H, x(2)], t)/H
         dz = dz + weight(k)*fluxes([x(1), x(2) + k*H], t)/H
         rate = rate + weight(k)*pores(x, t + k*H_T*time_scale)/(H_T*time_scale)
      end do
      q = fluxes(x, t)
      p = pores(x, t)
      v = fields_rate(x, t)
      a = fields_accel(x, t)
      n = p(2)/(1 + p(2))
      rho = (1 - n)*model%regions(1)%rho_s + n*p(3)*model%fluids%rho_w + n*(1 - p(3))*model%fluids%rho_a
      curve = 0.0_wp
      if (model%axisymmetric) curve = 1/x(1)
      s(1) = rho*a(1) - (dr(1) + dz(4) + (q(1) - q(3))*curve)
      s(2) = rho*(a(2) + model%gravity) - (dr(4) + dz(2) + q(4)*curve)
      associate (f => model%fluids)
         s(4) = n*(1 - p(3))/f%k_a*(v(3) + v(4)) + dr(7) + dz(8) + q(7)*curve
         s(3) = s(4) + n*p(3)/f%k_w*v(3) + rate(1) + (dr(5) - dr(7)) + (dz(6) - dz(8)) + (q(5) - q(7))*curve
         s(4) = s(4) - n*rate(3) + (1 - p(3))*rate(1)
      end associate
   end function sources
end module host_manufactured
