! SPDX-License-Identifier: MIT
!> What a scanning curve that moves between the main curves of retention adds to the changes of a rate: it moves S_w,
!> and with it the factor f of bonding and its slopes; docs/theory/integration.md section 5.3. A step of its own, since
!> only increments in which the modified suction has turned need it.
module mud_offset_changes
   use mud_kinds, only: wp
   use mud_bonding, only: bonding_with_offset
   use mud_linearise, only: linearised_t
   use mud_params, only: params_t
   use mud_point_changes, only: lanes_t
   use mud_rates, only: rate_t
   use mud_tensor, only: LANES
   implicit none (type, external)
   private
   public :: add_offset
contains
   !> Adds the changes of state parameter, bounding ratio and isotropic mechanism to x, for changes of q ln offset [-].
   !> Units of x as those of the rate w, lin is that of w. docs/theory/material.md sections 2.1.1, 3.2, 3.3, 4.4.
   pure subroutine add_offset(par, w, lin, offset, x)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: offset(LANES)
      type(lanes_t), intent(inout) :: x
      real(wp) :: f(3), psi, m_b, k_e, b

      f = bonding_with_offset(par, w%bond, lin%p_c, lin%e)
      psi = -lin%e_c*lin%per_f*f(1)
      m_b = merge(-par%n_b*w%m_b, 0.0_wp, w%psi < 0.0_wp)*psi
      x%psi = x%psi + psi*offset
      x%m_b = x%m_b + m_b*offset
      if (.not. w%iso_active) return
      call change_of_mechanism(par, w, lin, f, m_b, k_e, b)
      x%k_e = x%k_e + k_e*offset
      x%b = x%b + b*offset
      x%volumetric = x%volumetric + ((lin%d_v - w%b_rate)*k_e - w%k_e*b)*offset
   end subroutine add_offset

   !> Changes of K_e and of B where the isotropic mechanism acts, for those of f, df/dp_c, df/de and M^b: the part of
   !> mud_point_changes that bonding has, at a void ratio, a suction and a stress that rest.
   pure subroutine change_of_mechanism(par, w, lin, f, m_b, k_e, b)
      type(params_t), intent(in) :: par
      type(rate_t), intent(in) :: w
      type(linearised_t), intent(in) :: lin
      real(wp), intent(in) :: f(3), m_b
      real(wp), intent(out) :: k_e, b
      real(wp) :: weight, f_bond, approach, f_line, coupling, share, a, k_a

      weight = 2.0_wp*(1.0_wp - w%iso%weight)*m_b/w%m_b
      f_bond = lin%per_f*f(1)
      approach = -w%iso%approach*f_bond/par%lambda
      f_line = -w%iso%f_slope*(1.0_wp + 3.0_wp*(lin%r_norm/par%m_c)**2)*approach
      coupling = -lin%e*lin%per_f*(lin%bond%df_de*(f_line - w%iso%f*f_bond) + w%iso%f*f(3))
      share = w%iso%share/w%iso%weight*weight
      if (.not. w%iso%floored) share = share - w%iso%share/(1.0_wp + w%iso%c)*coupling
      a = w%iso%a/w%iso%share*share + w%iso%share*((par%lambda - lin%kappa)*f_line - lin%kappa*coupling)
      k_a = w%k*lin%per_p
      k_e = -w%k_e*k_a*a/(1.0_wp + k_a*w%iso%a)
      b = -lin%d_pc*lin%per_f*(w%iso%f*lin%bond%df_dpc*share &
                               + w%iso%share*(lin%bond%df_dpc*(f_line - w%iso%f*f_bond) + w%iso%f*f(2)))
   end subroutine change_of_mechanism
end module mud_offset_changes
