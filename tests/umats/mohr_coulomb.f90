! SPDX-License-Identifier: MIT
!> A UMAT as others write it: Mohr-Coulomb, perfectly plastic, with a return to the plane, an edge or the apex in
!> principal stresses. PROPS: Young's modulus, Poisson's ratio, cohesion, friction angle and dilation angle in degrees.
!> DDSDDE is the elastic one.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
                dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
                dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
   implicit none
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i, j, info
   character(len=80) :: cmname
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), &
                       drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(*), &
                       dpred(*), props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
   double precision, parameter :: DEGREE = 3.14159265358979323846d0/180.0d0
   double precision :: shear, lame, axes(3, 3), s(3), back(3, 3), work(32), n_phi, n_psi, limit, d(3, 3)

   shear = props(1)/(2.0d0*(1.0d0 + props(2)))
   lame = 2.0d0*shear*props(2)/(1.0d0 - 2.0d0*props(2))
   ddsdde = 0.0d0
   ddsdde(1:3, 1:3) = lame
   do i = 1, ntens
      ddsdde(i, i) = ddsdde(i, i) + merge(2.0d0*shear, shear, i <= 3)
   end do
   stress = stress + matmul(ddsdde, dstran)

   ! Compression positive, so that dsyev's ascending values are sigma_3, sigma_2, sigma_1.
   axes = 0.0d0
   do i = 1, 3
      axes(i, i) = -stress(i)
   end do
   axes(1, 2) = -stress(4)
   if (ntens == 6) axes(1, 3) = -stress(5)
   if (ntens == 6) axes(2, 3) = -stress(6)
   call dsyev('V', 'U', 3, axes, 3, s, work, 32, info)
   n_phi = (1.0d0 + sin(props(4)*DEGREE))/(1.0d0 - sin(props(4)*DEGREE))
   n_psi = (1.0d0 + sin(props(5)*DEGREE))/(1.0d0 - sin(props(5)*DEGREE))
   limit = 2.0d0*props(3)*sqrt(n_phi)
   if (info /= 0 .or. s(3) - n_phi*s(1) <= limit) return
   d = lame
   do i = 1, 3
      d(i, i) = lame + 2.0d0*shear
   end do
   call return_to_surface(s)
   back = 0.0d0
   do i = 1, 3
      do j = 1, 3
         back(:, i) = back(:, i) - s(j)*axes(:, j)*axes(i, j)
      end do
   end do
   do i = 1, 3
      stress(i) = back(i, i)
   end do
   stress(4) = back(1, 2)
   if (ntens == 6) stress(5) = back(1, 3)
   if (ntens == 6) stress(6) = back(2, 3)
contains
   subroutine return_to_surface(s)
      double precision, intent(inout) :: s(3)   !< Ascending, trial.
      double precision :: trial(3)

      trial = s
      s = on_planes(trial, reshape([-n_phi, 0.0d0, 1.0d0], [3, 1]), reshape([-n_psi, 0.0d0, 1.0d0], [3, 1]))
      if (s(1) > s(2)) then        ! beyond the edge of triaxial compression
         s = on_planes(trial, reshape([-n_phi, 0.0d0, 1.0d0, 0.0d0, -n_phi, 1.0d0], [3, 2]), &
                       reshape([-n_psi, 0.0d0, 1.0d0, 0.0d0, -n_psi, 1.0d0], [3, 2]))
      else if (s(2) > s(3)) then   ! beyond that of triaxial extension
         s = on_planes(trial, reshape([-n_phi, 0.0d0, 1.0d0, -n_phi, 1.0d0, 0.0d0], [3, 2]), &
                       reshape([-n_psi, 0.0d0, 1.0d0, -n_psi, 1.0d0, 0.0d0], [3, 2]))
      end if
      if (s(3) < s(1)) s = -limit/(n_phi - 1.0d0)   ! beyond the apex
   end subroutine return_to_surface

   !> Elastic predictor less D times the plastic strains, whose sizes bring it on all the planes.
   function on_planes(trial, normals, flows) result(s)
      double precision, intent(in) :: trial(3), normals(:, :), flows(:, :)
      double precision :: s(3), matrix(size(normals, 2), size(normals, 2)), sizes(size(normals, 2), 1)
      integer :: pivots(size(normals, 2)), n

      n = size(normals, 2)
      matrix = matmul(transpose(normals), matmul(d, flows))
      sizes(:, 1) = matmul(transpose(normals), trial) - limit
      call dgesv(n, 1, matrix, n, pivots, sizes, n, info)
      s = trial - matmul(d, matmul(flows, sizes(:, 1)))
   end function on_planes
end subroutine umat
