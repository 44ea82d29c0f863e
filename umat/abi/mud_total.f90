! SPDX-License-Identifier: MIT
!> Bishop's effective stress and total stress, and what becomes of the slopes. Tension positive; chi = S_w:
!> sigma' = sigma + p_a I - S_w p_c I, docs/theory/material.md section 1.1.
module mud_total
   use mud_kinds, only: wp
   use mud_tensor, only: IDENTITY
   implicit none (type, external)
   private
   public :: effective_stress, total_stress, total_blocks

contains
   !> Effective stress of a total one less air pressure [kPa]. Tension positive, S_w [-], suction in the unit of the
   !> stress. docs/theory/material.md section 1.1.
   pure function effective_stress(total, s_w, suction) result(effective)
      real(wp), intent(in) :: total(6), s_w, suction
      real(wp) :: effective(6)

      effective = total - s_w*suction*IDENTITY
   end function effective_stress

   !> Total stress less air pressure of an effective one [kPa], likewise. docs/theory/material.md section 1.1.
   pure function total_stress(effective, s_w, suction) result(total)
      real(wp), intent(in) :: effective(6), s_w, suction
      real(wp) :: total(6)

      total = effective + s_w*suction*IDENTITY
   end function total_stress

   !> Slopes of effective stress become those of total stress at constant air pressure:
   !> d sigma/d eps = d sigma'/d eps + p_c I (x) dS_w/d eps, d sigma/d p_c = d sigma'/d p_c + (S_w + p_c dS_w/d p_c) I.
   !> Tension positive, engineering shear; dsw_deps [-], dsw_dpc [1/kPa]. Derivative of docs/theory/material.md section
   !> 1.1.
   pure subroutine total_blocks(s_w, suction, dsw_deps, dsw_dpc, dsig_deps, dsig_dpc)
      real(wp), intent(in) :: s_w, suction, dsw_deps(6), dsw_dpc
      real(wp), intent(inout) :: dsig_deps(6, 6)   !< [kPa]
      real(wp), intent(inout) :: dsig_dpc(6)       !< [-]
      integer :: j

      do j = 1, 6
         dsig_deps(:, j) = dsig_deps(:, j) + suction*dsw_deps(j)*IDENTITY
      end do
      dsig_dpc = dsig_dpc + (s_w + suction*dsw_dpc)*IDENTITY
   end subroutine total_blocks
end module mud_total
