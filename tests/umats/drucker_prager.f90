! SPDX-License-Identifier: MIT
!> A UMAT as others write it: Drucker-Prager with a hardening modulus that falls in proportion to the plastic shear,
!> down to a least k. Yield: root of J2 plus friction times the mean stress (tension positive) equals k; plastic volume is
!> dilatancy times plastic shear. PROPS: Young's modulus, Poisson's ratio, friction, dilatancy, k at the start,
!> hardening modulus at the start, plastic shear at which it is zero, least k, and 1 where DDSDDE is the tangent of the
!> step, 0 that of the rate equations. STATEV(1): plastic shear.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
                dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
                dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
   implicit none
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i, j, n
   character(len=80) :: cmname
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), &
                       drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(*), &
                       dpred(*), props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
   double precision :: shear, bulk, s(6), p(6), q(6), mean, tau, slip, open, k, h, turn

   shear = props(1)/(2.0d0*(1.0d0 + props(2)))
   bulk = props(1)/(3.0d0*(1.0d0 - 2.0d0*props(2)))
   ddsdde = 0.0d0
   ddsdde(1:3, 1:3) = bulk - 2.0d0*shear/3.0d0
   do i = 1, ntens
      ddsdde(i, i) = ddsdde(i, i) + merge(2.0d0*shear, shear, i <= 3)
   end do
   stress = stress + matmul(ddsdde, dstran)
   mean = sum(stress(1:3))/3.0d0
   s = 0.0d0
   s(:ntens) = stress
   s(1:3) = s(1:3) - mean
   tau = sqrt(0.5d0*sum(s(1:3)**2) + sum(s(4:6)**2))
   call strength(statev(1), k, h)
   if (tau + props(3)*mean <= k) return
   slip = 0.0d0
   do n = 1, 50
      call strength(statev(1) + slip, k, h)
      open = tau - shear*slip + props(3)*(mean - bulk*props(4)*slip) - k
      if (abs(open) <= 1.0d-13*tau) exit
      slip = slip + open/(shear + bulk*props(3)*props(4) + h)
   end do
   s = s/tau
   mean = mean - bulk*props(4)*slip
   turn = props(9)*shear*slip/tau
   tau = tau - shear*slip
   if (tau <= 0.0d0 .or. n > 50) then   ! beyond the apex: this law has none
      pnewdt = 0.5d0
      return
   end if
   stress = tau*s(:ntens)
   stress(1:3) = stress(1:3) + mean
   statev(1) = statev(1) + slip
   p = shear*s
   q = p
   p(1:3) = p(1:3) + bulk*props(4)
   q(1:3) = q(1:3) + bulk*props(3)
   ! The deviator turns towards that of the trial stress.
   ddsdde(1:3, 1:3) = ddsdde(1:3, 1:3) + turn*2.0d0*shear/3.0d0
   do j = 1, ntens
      ddsdde(j, j) = ddsdde(j, j) - turn*merge(2.0d0*shear, shear, j <= 3)
      ddsdde(:, j) = ddsdde(:, j) + turn*shear*s(:ntens)*s(j)
   end do
   do j = 1, ntens
      ddsdde(:, j) = ddsdde(:, j) - p(:ntens)*q(j)/(shear + bulk*props(3)*props(4) + h)
   end do
contains
   !> k and its slope.
   subroutine strength(slipped, k, h)
      double precision, intent(in) :: slipped
      double precision, intent(out) :: k, h

      h = props(6)*(1.0d0 - slipped/props(7))
      k = props(5) + props(6)*slipped*(1.0d0 - 0.5d0*slipped/props(7))
      if (slipped < props(7) .or. k > props(8)) return
      k = props(8)
      h = 0.0d0
   end subroutine strength
end subroutine umat
