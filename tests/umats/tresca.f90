! SPDX-License-Identifier: MIT
!> A UMAT as others write it: Tresca, perfectly plastic, associated, for axisymmetry and plane strain (NTENS 4), with the
!> tangent of its own return. PROPS: Young's modulus, Poisson's ratio, undrained strength (half the largest difference of
!> principal stresses).
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
                dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
                dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
   implicit none
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i, j
   character(len=80) :: cmname
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), &
                       drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(*), &
                       dpred(*), props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
   double precision :: shear, lame, trial(3), s(3), d(3, 3), turn(4, 4), local(4, 4), half, radius, c2, s2

   shear = props(1)/(2.0d0*(1.0d0 + props(2)))
   lame = 2.0d0*shear*props(2)/(1.0d0 - 2.0d0*props(2))
   ddsdde = 0.0d0
   ddsdde(1:3, 1:3) = lame
   do i = 1, 3
      ddsdde(i, i) = lame + 2.0d0*shear
   end do
   ddsdde(4, 4) = shear
   stress = stress + matmul(ddsdde, dstran)

   ! Principal stresses in the plane (1, 2) and across it (3); 2 theta is the angle of the first.
   half = 0.5d0*(stress(1) - stress(2))
   radius = sqrt(half**2 + stress(4)**2)
   trial = [0.5d0*(stress(1) + stress(2)) + radius, 0.5d0*(stress(1) + stress(2)) - radius, stress(3)]
   if (maxval(trial) - minval(trial) <= 2.0d0*props(3)) return
   c2 = 1.0d0
   s2 = 0.0d0
   if (radius > 0.0d0) c2 = half/radius
   if (radius > 0.0d0) s2 = stress(4)/radius
   call return_to_surface(trial, s, d)
   stress(1) = 0.5d0*(s(1) + s(2)) + 0.5d0*(s(1) - s(2))*c2
   stress(2) = 0.5d0*(s(1) + s(2)) - 0.5d0*(s(1) - s(2))*c2
   stress(3) = s(3)
   stress(4) = 0.5d0*(s(1) - s(2))*s2

   ! In the principal axes; the shear between those of the plane by their rotation.
   local = 0.0d0
   local(1:3, 1:3) = d
   local(4, 4) = shear
   if (radius > 1.0d-12*props(3)) local(4, 4) = shear*(s(1) - s(2))/(2.0d0*radius)
   turn(1, :) = [0.5d0*(1.0d0 + c2), 0.5d0*(1.0d0 - c2), 0.0d0, 0.5d0*s2]
   turn(2, :) = [0.5d0*(1.0d0 - c2), 0.5d0*(1.0d0 + c2), 0.0d0, -0.5d0*s2]
   turn(3, :) = [0.0d0, 0.0d0, 1.0d0, 0.0d0]
   turn(4, :) = [-s2, s2, 0.0d0, c2]
   ddsdde = matmul(transpose(turn), matmul(local, turn))
contains
   !> To the plane, or to the edge where two meet; d is the derivative.
   subroutine return_to_surface(trial, s, d)
      double precision, intent(in) :: trial(3)
      double precision, intent(out) :: s(3), d(3, 3)
      double precision :: normal(3), other(3)
      integer :: high, low, middle

      high = maxloc(trial, 1)
      low = minloc(trial, 1)
      middle = 6 - high - low
      normal = 0.0d0
      normal(high) = 1.0d0
      normal(low) = -1.0d0
      call on_planes(trial, reshape(normal, [3, 1]), s, d)
      other = 0.0d0
      if (s(middle) > s(high)) then
         other(middle) = 1.0d0
         other(low) = -1.0d0
      else if (s(middle) < s(low)) then
         other(high) = 1.0d0
         other(middle) = -1.0d0
      else
         return
      end if
      call on_planes(trial, reshape([normal, other], [3, 2]), s, d)
   end subroutine return_to_surface

   subroutine on_planes(trial, normals, s, d)
      double precision, intent(in) :: trial(3), normals(:, :)
      double precision, intent(out) :: s(3), d(3, 3)
      double precision :: matrix(2, 2), inverse(2, 2), sizes(2), elastic(3, 3)
      integer :: n

      n = size(normals, 2)
      elastic = lame
      do i = 1, 3
         elastic(i, i) = lame + 2.0d0*shear
      end do
      ! The normals have no volume: the elastic stiffness along them is 2 G.
      matrix(:n, :n) = 2.0d0*shear*matmul(transpose(normals), normals)
      inverse(1, 1) = 1.0d0/matrix(1, 1)
      if (n == 2) inverse = reshape([matrix(2, 2), -matrix(2, 1), -matrix(1, 2), matrix(1, 1)], [2, 2]) &
                            /(matrix(1, 1)*matrix(2, 2) - matrix(1, 2)*matrix(2, 1))
      sizes(:n) = matmul(inverse(:n, :n), matmul(transpose(normals), trial) - 2.0d0*props(3))
      s = trial - 2.0d0*shear*matmul(normals, sizes(:n))
      d = elastic - (2.0d0*shear)**2*matmul(normals, matmul(inverse(:n, :n), transpose(normals)))
   end subroutine on_planes
end subroutine umat
