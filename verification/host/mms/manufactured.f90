! SPDX-License-Identifier: MIT
!> Manufactured solutions of the coupled equations for u, p_w, p_c: axisymmetric, with the axis, or plane strain.
!> Made by make_mms.py from manufactured.f90.in: the lines between "derived" marks are written by its computer algebra.
!>
!> Pressures and stress are compression positive, suction p_c = p_a - p_w, displacement and fluxes are vectors of (r, z)
!> (in plane strain (x, z)), gravity acts along -z. The loads are to be added on the right of
!>    rho u'' = - div(sigma) - rho g e_z + body,   sigma = sigma' + [p_w + (1-S_w) p_c] I, sigma' = - D : strain(u)
!>    n S_w/K_w p_w' + n S_w' + S_w div u' + div q_w = source_w
!>    n (1-S_w)/K_a p_a' - n S_w' + (1-S_w) div u' + div q_a = source_a
!>    q_w = -(k k_rw/eta_w)(grad p_w + rho_w (g e_z + i u'')), q_a likewise with p_a, k_ra, eta_a, rho_a
!> i = 1 with seepage inertia. Summed form: the equation weighted by p_w has the source source_w + source_a.
module manufactured
   use, intrinsic :: iso_fortran_env, only: wp => real64
   implicit none (type, external)
   private
   public :: manufactured_t, manufactured_point_t, product_t, evaluate
   public :: SOLID, WATER, WATER_AND_AIR

   !> Fields of the scene: u; u and p_w (then S_w = 1, p_c = 0); u, p_w and p_c.
   integer, parameter :: SOLID = 1, WATER = 2, WATER_AND_AIR = 3

   !> One field: base + amplitude T(t) exp(-(r/length)^2) cos(wave z + shift),
   !> T = 1 + rate t + swing sin(omega t + phase). With swing = 0 it is linear in time, which
   !> generalised-alpha follows without error.
   type :: product_t
      real(wp) :: base, amplitude, length, wave, shift, rate, swing, omega, phase
   end type product_t

   !> The solution and its material; kPa, m, s, Mg. u_r = r times the field u_over_r.
   type :: manufactured_t
      integer :: fields = WATER_AND_AIR
      logical :: axisymmetric = .true.
      logical :: seepage_inertia = .false.
      logical :: void_ratio_rate = .true.       !< dS_w/de e' in S_w'.
      real(wp) :: fixed_density = 0.0_wp        !< If positive, rho itself, instead of that of the current n, S_w.
      real(wp) :: young = 5000.0_wp    !< Young's modulus [kPa].
      real(wp) :: poisson = 0.3_wp     !< Poisson's ratio [-].
      real(wp) :: e_0 = 0.8_wp         !< Void ratio where u = 0 [-].
      real(wp) :: rho_s = 2.7_wp       !< Density of the grains [Mg/m3].
      real(wp) :: rho_w = 1.0_wp       !< Density of the water [Mg/m3].
      real(wp) :: rho_a = 0.1_wp       !< Density of the air, exaggerated [Mg/m3].
      real(wp) :: bulk_w = 20000.0_wp  !< K_w [kPa].
      real(wp) :: bulk_a = 101.0_wp    !< K_a [kPa].
      real(wp) :: k = 5e-10_wp         !< Intrinsic permeability [m2].
      real(wp) :: eta_w = 1e-06_wp     !< Viscosity of the water [kPa s].
      real(wp) :: eta_a = 1e-07_wp     !< Viscosity of the air, exaggerated [kPa s].
      real(wp) :: gravity = 9.81_wp    !< Along -z [m/s2].
      real(wp) :: s_min = 0.05_wp      !< S_min of the retention curve [-].
      real(wp) :: s_max = 1.0_wp       !< S_max of the retention curve [-].
      real(wp) :: p_entry = 5.0_wp     !< P_a of the retention curve [kPa].
      real(wp) :: n_x = 2.0_wp         !< Exponent n_x [-].
      real(wp) :: m_x = 1.0_wp         !< Exponent m_x [-].
      real(wp) :: omega = 2.0_wp       !< Exponent Omega of the void ratio [-].
      !> u_r/r [-].
      type(product_t) :: u_over_r = product_t(0.0_wp, 0.01_wp, 1.2_wp, 2.0_wp, 0.3_wp, 0.5_wp, 0.8_wp, 40.0_wp, 0.2_wp)
      !> u_z [m].
      type(product_t) :: u_z = product_t(0.0_wp, 0.015_wp, 1.1_wp, 1.7_wp, -0.9_wp, 0.4_wp, 0.7_wp, 40.0_wp, 0.7_wp)
      !> p_w [kPa].
      type(product_t) :: p_w = product_t(-15.0_wp, 6.0_wp, 0.9_wp, 2.3_wp, 0.5_wp, 0.6_wp, 0.5_wp, 40.0_wp, 1.1_wp)
      !> p_c [kPa].
      type(product_t) :: p_c = product_t(18.0_wp, 5.0_wp, 1.0_wp, 1.9_wp, -0.4_wp, -0.5_wp, 0.6_wp, 40.0_wp, 0.4_wp)
   end type manufactured_t

   !> Everything at one point and instant. Stress in the order rr, zz, tt, rz.
   type :: manufactured_point_t
      real(wp) :: u(2), velocity(2), acceleration(2)
      real(wp) :: grad_u(2, 2)                  !< (i, j): derivative of u_i in direction j.
      real(wp) :: p_w, p_c, p_w_rate, p_c_rate, grad_p_w(2), grad_p_c(2)
      real(wp) :: void_ratio, s_w, rho
      real(wp) :: effective(4), total(4)        !< Compression positive.
      real(wp) :: q_w(2), q_a(2)
      real(wp) :: body(2), source_w, source_a   !< The loads.
   end type manufactured_point_t

   !> A product field with its derivatives; over_r: divided by r, regular on the axis.
   type :: derivatives_t
      real(wp) :: f, z, zz, r_over_r, rz_over_r, rr
   end type derivatives_t
contains
   !> The solution and its loads at (r, z) [m] and t [s].
   pure function evaluate(par, r, z, t) result(p)
      type(manufactured_t), intent(in) :: par
      real(wp), intent(in) :: r, z, t
      type(manufactured_point_t) :: p
      type(derivatives_t) :: f, g, w, c
      real(wp) :: time(3), hoop, mu, lambda, n, s_a, eff_s, ds_dc, ds_de, s_rate, air_rate, e_rate
      real(wp) :: dilation, dilation_rate, dilation_acc, grad_dilation(2), grad_dilation_acc(2), twist(2)
      real(wp) :: grad_s(2), grad_pore(2), grad_p_a(2), k_w, k_a, dk_w, dk_a, head_w(2), head_a(2), inertia

      hoop = merge(1.0_wp, 0.0_wp, par%axisymmetric)
      inertia = merge(1.0_wp, 0.0_wp, par%seepage_inertia)
      mu = 0.5_wp*par%young/(1 + par%poisson)
      lambda = 2*mu*par%poisson/(1 - 2*par%poisson)

      ! Displacement: f = u_r/r, g = u_z, each with its time factor and the rates of that factor.
      f = shape_in_space(par%u_over_r, r, z)
      g = shape_in_space(par%u_z, r, z)
      time = factors(par%u_over_r, t)
      p%u(1) = r*(par%u_over_r%base + time(1)*f%f)
      p%velocity(1) = r*time(2)*f%f
      p%acceleration(1) = r*time(3)*f%f
      dilation_rate = time(2)*((1 + hoop)*f%f + r**2*f%r_over_r)
      dilation_acc = time(3)*((1 + hoop)*f%f + r**2*f%r_over_r)
      grad_dilation_acc = time(3)*[r*((2 + hoop)*f%r_over_r + f%rr), (1 + hoop)*f%z + r**2*f%rz_over_r]
      f = scaled(f, time(1), par%u_over_r%base)
      time = factors(par%u_z, t)
      p%u(2) = par%u_z%base + time(1)*g%f
      p%velocity(2) = time(2)*g%f
      p%acceleration(2) = time(3)*g%f
      dilation_rate = dilation_rate + time(2)*g%z
      dilation_acc = dilation_acc + time(3)*g%z
      grad_dilation_acc = grad_dilation_acc + time(3)*[r*g%rz_over_r, g%zz]
      g = scaled(g, time(1), par%u_z%base)
      p%grad_u(1, :) = [f%f + r**2*f%r_over_r, r*f%z]
      p%grad_u(2, :) = [r*g%r_over_r, g%z]
      dilation = p%grad_u(1, 1) + hoop*f%f + g%z
      grad_dilation = [r*((2 + hoop)*f%r_over_r + f%rr + g%rz_over_r), (1 + hoop)*f%z + r**2*f%rz_over_r + g%zz]
      ! -curl curl u, so that div(D : strain) = (lambda + 2 mu) grad div u - mu curl curl u.
      twist = [r*(f%zz - g%rz_over_r), -((1 + hoop)*f%z + r**2*f%rz_over_r - g%rr - hoop*g%r_over_r)]

      ! Pressures; fields that the scene does not have are zero.
      w = shape_in_space(par%p_w, r, z)
      time = factors(par%p_w, t)
      p%p_w_rate = time(2)*w%f
      w = scaled(w, time(1), par%p_w%base)
      c = shape_in_space(par%p_c, r, z)
      time = factors(par%p_c, t)
      p%p_c_rate = time(2)*c%f
      c = scaled(c, time(1), par%p_c%base)
      if (par%fields < WATER) then
         w = scaled(w, 0.0_wp, 0.0_wp)
         p%p_w_rate = 0
      end if
      if (par%fields < WATER_AND_AIR) then
         c = scaled(c, 0.0_wp, 0.0_wp)
         p%p_c_rate = 0
      end if
      p%p_w = w%f
      p%p_c = c%f
      p%grad_p_w = [r*w%r_over_r, w%z]
      p%grad_p_c = [r*c%r_over_r, c%z]

      ! Saturation and relative permeabilities with their slopes.
      p%void_ratio = (1 + par%e_0)*exp(dilation) - 1     ! de = (1+e) d(div u)
      n = p%void_ratio/(1 + p%void_ratio)
      e_rate = (1 + p%void_ratio)*dilation_rate
      if (par%fields == WATER_AND_AIR) then
         call retention(par, p%p_c, p%void_ratio, p%s_w, ds_dc, ds_de)
         eff_s = (p%s_w - par%s_min)/(par%s_max - par%s_min)
      else
         p%s_w = 1
         ds_dc = 0
         ds_de = 0
         eff_s = 1
      end if
      s_a = 1 - p%s_w
      grad_s = ds_dc*p%grad_p_c + ds_de*(1 + p%void_ratio)*grad_dilation
      s_rate = ds_dc*p%p_c_rate + merge(ds_de*e_rate, 0.0_wp, par%void_ratio_rate)
      call corey(eff_s, k_w, k_a, dk_w, dk_a)
      k_w = k_w*par%k/par%eta_w
      k_a = k_a*par%k/par%eta_a
      dk_w = dk_w*par%k/par%eta_w/(par%s_max - par%s_min)
      dk_a = dk_a*par%k/par%eta_a/(par%s_max - par%s_min)

      ! Momentum.
      p%rho = (1 - n)*par%rho_s + n*p%s_w*par%rho_w + n*s_a*par%rho_a
      if (par%fields == SOLID) p%rho = (1 - n)*par%rho_s
      if (par%fixed_density > 0.0_wp) p%rho = par%fixed_density
      p%effective = -lambda*[dilation, dilation, dilation, 0.0_wp] &
         - 2*mu*[p%grad_u(1, 1), p%grad_u(2, 2), hoop*f%f, 0.5_wp*(p%grad_u(1, 2) + p%grad_u(2, 1))]
      p%total = p%effective + (p%p_w + s_a*p%p_c)*[1.0_wp, 1.0_wp, 1.0_wp, 0.0_wp]
      grad_pore = p%grad_p_w + s_a*p%grad_p_c - p%p_c*grad_s
      p%body = p%rho*(p%acceleration + [0.0_wp, par%gravity]) + grad_pore &
         - (lambda + 2*mu)*grad_dilation - mu*twist

      ! Water and air.
      p%source_w = 0
      p%source_a = 0
      p%q_w = 0
      p%q_a = 0
      if (par%fields == SOLID) return
      head_w = p%grad_p_w + par%rho_w*([0.0_wp, par%gravity] + inertia*p%acceleration)
      p%q_w = -k_w*head_w
      p%source_w = n*p%s_w/par%bulk_w*p%p_w_rate + n*s_rate + p%s_w*dilation_rate - dk_w*dot_product(grad_s, head_w) &
         - k_w*(laplacian(w, hoop) + par%rho_w*inertia*dilation_acc)
      if (par%fields == WATER) return
      air_rate = p%p_w_rate + p%p_c_rate
      grad_p_a = p%grad_p_w + p%grad_p_c
      head_a = grad_p_a + par%rho_a*([0.0_wp, par%gravity] + inertia*p%acceleration)
      p%q_a = -k_a*head_a
      p%source_a = n*s_a/par%bulk_a*air_rate - n*s_rate + s_a*dilation_rate - dk_a*dot_product(grad_s, head_a) &
         - k_a*(laplacian(w, hoop) + laplacian(c, hoop) + par%rho_a*inertia*dilation_acc)
   end function evaluate

   !> The part of a field that depends on r and z, without base.
   pure function shape_in_space(field, r, z) result(d)
      type(product_t), intent(in) :: field
      real(wp), intent(in) :: r, z
      type(derivatives_t) :: d
      real(wp) :: amplitude, length, wave, shift

      amplitude = field%amplitude
      length = field%length
      wave = field%wave
      shift = field%shift
      ! derived
      d%f = amplitude*exp(-r**2/length**2)*cos(shift + wave*z)
      d%z = -amplitude*wave*exp(-r**2/length**2)*sin(shift + wave*z)
      d%zz = -amplitude*wave**2*exp(-r**2/length**2)*cos(shift + wave*z)
      d%r_over_r = -2*amplitude*exp(-r**2/length**2)*cos(shift + wave*z)/length**2
      d%rz_over_r = 2*amplitude*wave*exp(-r**2/length**2)*sin(shift + wave*z)/length**2
      d%rr = 2*amplitude*(-length**2 + 2*r**2)*exp(-r**2/length**2)*cos(shift + wave* z)/length**4
      ! end derived
   end function shape_in_space

   !> base + factor times a field.
   pure function scaled(field, factor, base) result(d)
      type(derivatives_t), intent(in) :: field
      real(wp), intent(in) :: factor, base
      type(derivatives_t) :: d

      d = derivatives_t(base + factor*field%f, factor*field%z, factor*field%zz, factor*field%r_over_r, &
         factor*field%rz_over_r, factor*field%rr)
   end function scaled

   !> The time factor of a field and its first two derivatives.
   pure function factors(field, t) result(time)
      type(product_t), intent(in) :: field
      real(wp), intent(in) :: t
      real(wp) :: time(3), rate, swing, omega, phase

      rate = field%rate
      swing = field%swing
      omega = field%omega
      phase = field%phase
      ! derived
      time(1) = rate*t + swing*sin(omega*t + phase) + 1
      time(2) = omega*swing*cos(omega*t + phase) + rate
      time(3) = -omega**2*swing*sin(omega*t + phase)
      ! end derived
   end function factors

   !> Laplacian of a scalar.
   pure function laplacian(d, hoop) result(value)
      type(derivatives_t), intent(in) :: d
      real(wp), intent(in) :: hoop
      real(wp) :: value

      value = d%rr + hoop*d%r_over_r + d%zz
   end function laplacian

   !> Saturation, eq. (24) of the paper, and its slopes; p_c > 0 throughout.
   pure subroutine retention(par, p_c, e, s_w, ds_dc, ds_de)
      type(manufactured_t), intent(in) :: par
      real(wp), intent(in) :: p_c, e
      real(wp), intent(out) :: s_w, ds_dc, ds_de
      real(wp) :: s_min, s_max, p_entry, n_x, m_x, omega, a, slope

      s_min = par%s_min
      s_max = par%s_max
      p_entry = par%p_entry
      n_x = par%n_x
      m_x = par%m_x
      omega = par%omega
      ! derived
      a = (e**omega*p_c/p_entry)**n_x
      s_w = s_min + (s_max - s_min)*log(a + 2.718281828459045_wp)**(-m_x)
      slope = -a*m_x*(s_max - s_min)*log(a + 2.718281828459045_wp)**(-m_x - 1)/(a + exp(1.0_wp))
      ds_dc = n_x*slope/p_c
      ds_de = n_x*omega*slope/e
      ! end derived
   end subroutine retention

   !> Corey's relative permeabilities and their slopes against the effective saturation. No floor: they stay above it.
   pure subroutine corey(s, k_w, k_a, dk_w, dk_a)
      real(wp), intent(in) :: s
      real(wp), intent(out) :: k_w, k_a, dk_w, dk_a

      ! derived
      k_w = s**3
      k_a = (1 - s**2)*(s - 1)**2
      dk_w = 3*s**2
      dk_a = -4*s**3 + 6*s**2 - 2
      ! end derived
   end subroutine corey
end module manufactured
