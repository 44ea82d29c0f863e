! SPDX-License-Identifier: MIT
!> Tension cut-off: a point whose mean stress has fallen to p_min is held there.
!>
!> p', fabric, memory and plastic shear rest. The stress ratio follows the strain elastically, but not beyond the
!> bounding surface, along which it slides. Were it frozen, an undrained path that gets here on its contractive side
!> could never leave, in whatever direction it is sheared.
module mud_cutoff
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_bounding, only: psi_of, change_of_psi, excess, change_of_excess, limited, &
      change_of_limited
   use mud_elastic, only: shear_modulus, shear_slope
   use mud_increment, only: increment_t, void_ratio_at, suction_at
   use mud_tensor, only: trace, deviator, norm
   implicit none (type, external)
   private
   public :: slide, change_of_slide, slides, held_rate

   real(wp), parameter :: ON_SURFACE = 1.0e-12_wp   !< r this close (relative) to the bounding surface is on it [-].
contains
   !> Stress ratio of a held point after a step h that begins at r0 at a pseudo-time. r0, r, time and h [-], the last
   !> two shares of inc. docs/theory/material.md section 6.2.
   pure function slide(par, inc, r0, time, h) result(r)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: r0(6), time, h
      real(wp) :: r(6), e

      e = void_ratio_at(inc, time + h)
      r = r0 + deviator((2.0_wp*shear_modulus(par, e, par%p_min)/par%p_min*h)*inc%d_strain)
      r = limited(par, psi_of(par, inc%bonded, e, suction_at(inc, time + h), par%p_min), r)
   end function slide

   !> Change of that stress ratio with r0, with the increment's strain, with void ratio and suction at the end and with
   !> a scanning curve, of q ln offset. All [-] but dp_c [kPa]; time and h are shares of inc. Derivative of
   !> docs/theory/material.md section 6.2.
   pure function change_of_slide(par, inc, r0, time, h, dr0, d_strain, de, dp_c, d_offset) result(change)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: r0(6), time, h, dr0(6), d_strain(6), de, dp_c, d_offset
      real(wp) :: change(6), r(6), e, p_c, stiffness, psi, dpsi

      e = void_ratio_at(inc, time + h)
      p_c = suction_at(inc, time + h)
      stiffness = 2.0_wp*shear_modulus(par, e, par%p_min)/par%p_min*h
      r = r0 + deviator(stiffness*inc%d_strain)
      change = dr0 + deviator(stiffness*d_strain) + deviator((stiffness*shear_slope(e)*de)*inc%d_strain)
      psi = psi_of(par, inc%bonded, e, p_c, par%p_min)
      if (norm(r) <= 0.0_wp) return
      if (excess(par, psi, r) <= 0.0_wp) return
      dpsi = change_of_psi(par, inc%bonded, e, p_c, par%p_min, de, dp_c, 0.0_wp, d_offset)
      change = change_of_limited(par, psi, r, dpsi, change)
   end function change_of_slide

   !> True where the stress ratio of a held point is on the bounding surface and an elastic rate would leave it.
   !> docs/theory/material.md section 6.2, to 1e-12 of the surface.
   pure logical function slides(par, bonded, e, p_c, r, d_strain, d_pc)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded
      real(wp), intent(in) :: e, p_c, r(6), d_strain(6), d_pc   !< [-, kPa, -, -, kPa]
      real(wp) :: psi, dpsi

      slides = .false.
      if (norm(r) <= 0.0_wp) return
      psi = psi_of(par, bonded, e, p_c, par%p_min)
      if (excess(par, psi, r) < -ON_SURFACE) return
      dpsi = change_of_psi(par, bonded, e, p_c, par%p_min, -(1.0_wp + e)*trace(d_strain), d_pc, 0.0_wp)
      slides = change_of_excess(par, psi, r, dpsi, held_rate(par, bonded, e, p_c, r, .false., d_strain, d_pc)) > 0.0_wp
   end function slides

   !> Rate of the stress ratio of a held point for a strain rate and a suction rate, linear in both: elastic, or along
   !> the bounding surface. [-], per unit of pseudo-time. docs/theory/material.md section 6.2,
   !> docs/theory/integration.md section 5.4.
   pure function held_rate(par, bonded, e, p_c, r, sliding, d_strain, d_pc) result(rate)
      type(params_t), intent(in) :: par
      logical, intent(in) :: bonded, sliding
      real(wp), intent(in) :: e, p_c, r(6), d_strain(6), d_pc   !< [-, kPa, -, -, kPa]
      real(wp) :: rate(6), psi, dpsi

      rate = deviator((2.0_wp*shear_modulus(par, e, par%p_min)/par%p_min)*d_strain)
      if (.not. sliding) return
      psi = psi_of(par, bonded, e, p_c, par%p_min)
      dpsi = change_of_psi(par, bonded, e, p_c, par%p_min, -(1.0_wp + e)*trace(d_strain), d_pc, 0.0_wp)
      rate = change_of_limited(par, psi, r, dpsi, rate)
   end function held_rate
end module mud_cutoff
