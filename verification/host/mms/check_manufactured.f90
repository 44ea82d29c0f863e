! SPDX-License-Identifier: MIT
!> Compares the module `manufactured` with samples.csv: prints the largest difference, stops with 1 above 1e-11.
!> gfortran -std=f2018 manufactured.f90 check_manufactured.f90 && ./a.out samples.csv
program check_manufactured
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use manufactured, only: manufactured_t, manufactured_point_t, evaluate
   implicit none (type, external)
   integer, parameter :: VALUES = 25
   type(manufactured_t) :: par
   type(manufactured_point_t) :: p
   integer :: unit, io, number, flags(5), rows, worst_case, worst_column, j
   real(wp) :: density, x(3), expected(VALUES), found(VALUES), scale(VALUES), difference, worst
   character(200) :: name
   character(2000) :: line

   call get_command_argument(1, name)
   open (newunit=unit, file=trim(name), status='old', action='read')
   rows = 0
   worst = 0
   worst_case = 0
   worst_column = 0
   do
      read (unit, '(a)', iostat=io) line
      if (io /= 0) exit
      if (line(1:1) == '#') cycle
      read (line, *) number, flags, density, x, expected
      par = manufactured_t(fields=flags(2), axisymmetric=flags(1) == 1, seepage_inertia=flags(3) == 1, &
         void_ratio_rate=flags(4) == 1, fixed_density=density)
      if (flags(5) == 1) then
         par%u_over_r%swing = 0
         par%u_z%swing = 0
         par%p_w%swing = 0
         par%p_c%swing = 0
      end if
      if (number == 12) then
         par%omega = 1.5_wp
         par%n_x = 1.8_wp
         par%m_x = 0.9_wp
         par%poisson = 0.2_wp
         par%s_max = 0.98_wp
      end if
      p = evaluate(par, x(1), x(2), x(3))
      found = [p%u, p%velocity, p%acceleration, p%p_w, p%p_c, p%p_w_rate, p%p_c_rate, p%void_ratio, p%s_w, p%rho, &
         p%body, p%source_w, p%source_a, p%total, p%q_w, p%q_a]
      ! Each quantity has the scale of the terms it consists of: a value near zero is not asked for more.
      scale = [1e-2_wp, 1e-2_wp, 0.5_wp, 0.5_wp, 20.0_wp, 20.0_wp, 10.0_wp, 10.0_wp, 200.0_wp, 200.0_wp, 1.0_wp, &
         1.0_wp, 1.0_wp, 100.0_wp, 100.0_wp, 1.0_wp, 1.0_wp, 100.0_wp, 100.0_wp, 100.0_wp, 100.0_wp, 1e-3_wp, &
         1e-3_wp, 1e-2_wp, 1e-2_wp]
      do j = 1, VALUES
         difference = abs(found(j) - expected(j))/max(abs(expected(j)), scale(j))
         if (.not. difference <= worst) then
            worst = difference
            worst_case = number
            worst_column = 10 + j
         end if
      end do
      rows = rows + 1
   end do
   print '(a, i0, a, es9.2, a, i0, a, i0)', 'rows ', rows, ', largest difference ', worst, ' in case ', worst_case, &
      ', column ', worst_column
   if (.not. worst < 1e-11_wp .or. rows == 0) error stop 1
end program check_manufactured
