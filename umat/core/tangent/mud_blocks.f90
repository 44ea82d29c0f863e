! SPDX-License-Identifier: MIT
!> Tangent blocks of an update that are not carried through its substeps: elastic, and continuum by the last rate.
module mud_blocks
   use mud_kinds, only: wp
   use mud_cutoff, only: soil_void_ratio, MODE_HELD
   use mud_elastic, only: centre_modulus, elastic_moduli, elastic_tangent
   use mud_held, only: held_tangent
   use mud_increment, only: increment_t, has_elastic_part, direction_at, end_in_domain
   use mud_params, only: params_t
   use mud_rate, only: rate_t
   use mud_rates, only: stress_ratio, MODE_ELASTIC
   use mud_state, only: state_t
   use mud_tangent, only: continuum_tangent
   use mud_tensor, only: SHEAR_WEIGHT, outer_add, trace
   use mud_trial, only: trial_t
   implicit none (type, external)
   private
   public :: blocks_t, elastic_blocks, blocks_of_moduli, continuum_blocks

   !> Tangent blocks, compression positive, with engineering shear strain.
   type :: blocks_t
      real(wp) :: dsig_deps(6, 6)   !< d sigma'/d eps [kPa]
      real(wp) :: dsig_dpc(6)       !< d sigma'/d p_c [-]
      real(wp) :: dsw_dev           !< d S_w/d eps_v [-]
      real(wp) :: dsw_dpc           !< d S_w/d p_c [1/kPa]
   end type blocks_t

contains
   !> Blocks of an elastic response at a state. Units as in blocks_t; those of S_w stay as they are. Stress does not
   !> follow suction. docs/theory/material.md section 3.1, docs/theory/memory-rules.md section 4.3.
   pure subroutine elastic_blocks(par, state, blocks)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state
      type(blocks_t), intent(inout) :: blocks
      real(wp) :: p, r(6), k, g, from_centre

      call stress_ratio(par, state%sigma, p, r)
      from_centre = 0.0_wp
      if (par%rho_e > 0.0_wp) from_centre = trace(state%from_centre)
      call elastic_moduli(par%elastic, soil_void_ratio(state), p, from_centre, k, g)
      call blocks_of_moduli(k, g, blocks)
   end subroutine elastic_blocks

   !> elastic_blocks of the moduli there [kPa].
   pure subroutine blocks_of_moduli(k, g, blocks)
      real(wp), intent(in) :: k, g
      type(blocks_t), intent(inout) :: blocks

      blocks%dsig_deps = elastic_tangent(k, g)
      blocks%dsig_dpc = 0.0_wp
   end subroutine blocks_of_moduli

   !> Blocks of the last rate of an increment. Units as in blocks_t; those of S_w stay as they are.
   !> docs/theory/integration.md sections 5.2 and 5.4.
   pure subroutine continuum_blocks(par, inc, trial, state, blocks)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc       !< the phase that ended the increment
      type(trial_t), intent(in) :: trial         !< last substep of the increment
      type(state_t), intent(in) :: state         !< at its end
      type(blocks_t), intent(inout) :: blocks

      if (trial%mode == MODE_HELD) then
         call held_tangent(par, inc, state, blocks%dsig_deps, blocks%dsig_dpc)
         return
      else if (trial%closed) then
         call elastic_blocks(par, state, blocks)
         return
      end if
      call continuum_tangent(par, trial%w(inc%scheme%stages), blocks%dsig_deps, blocks%dsig_dpc)
      if (has_elastic_part(inc, trial%mode)) &
         call project(par, inc, trial%mode, trial%w(inc%scheme%stages), state, blocks%dsig_deps)
   end subroutine continuum_blocks

   !> Tangent of a rate of which only the strain along nu loads (inside the domain none), the rest being elastic.
   pure subroutine project(par, inc, mode, w, state, c)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      type(rate_t), intent(in) :: w
      type(state_t), intent(in) :: state   !< at the end of the increment
      real(wp), intent(inout) :: c(6, 6)
      real(wp) :: nu(6), along(6), elastic(6, 6)

      elastic = elastic_tangent(w%k, centre_modulus(par%elastic, state%e, w%k, trace(end_in_domain(inc))))
      along = 0.0_wp
      nu = 0.0_wp
      if (mode /= MODE_ELASTIC) then
         nu = direction_at(inc, 1.0_wp)
         along = matmul(c - elastic, SHEAR_WEIGHT*nu)
      end if
      c = elastic
      call outer_add(along, nu, c)
   end subroutine project
end module mud_blocks
