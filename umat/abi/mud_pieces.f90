! SPDX-License-Identifier: MIT
!> An increment for hosts that cannot cut it: a hard one is taken in equal pieces.
module mud_pieces
   use mud_kernel, only: report_t, output_t, kernel_point
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_registry, only: NSTATV
   use mud_status, only: MUD_OK
   implicit none (type, external)
   private
   public :: update_in_pieces

   integer, parameter :: HALVINGS = 8   !< 256 pieces at most.
contains
   !> The whole increment, then two halves, four quarters ... until all pieces pass; the report of a failure is that of
   !> the last try. A tangent is that of the last piece. The caller's mistakes (negative codes) are not tried again.
   !> Arguments, units and codes as in kernel_point.
   pure subroutine update_in_pieces(par, stress, statev, d_strain, suction, d_suction, tangent, output, report)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: stress(6), d_strain(6), suction, d_suction
      real(wp), intent(in), contiguous :: statev(:)
      integer, intent(in) :: tangent
      type(output_t), intent(inout) :: output
      type(report_t), intent(out) :: report
      real(wp) :: stress0(6), statev0(NSTATV), share
      integer :: halving, piece, pieces, n

      n = size(statev)
      call kernel_point(par, stress, statev, d_strain, suction, d_suction, tangent, output, report)
      do halving = 1, HALVINGS
         if (report%status <= MUD_OK) return
         pieces = 2**halving
         share = 1.0_wp/real(pieces, wp)
         stress0 = stress
         statev0(:n) = statev
         do piece = 1, pieces
            call kernel_point(par, stress0, statev0(:n), share*d_strain, &
                              suction + share*real(piece - 1, wp)*d_suction, share*d_suction, tangent, output, report)
            if (report%status /= MUD_OK) exit
            stress0 = output%stress
            statev0(:output%n_statev) = output%statev(:output%n_statev)
         end do
      end do
   end subroutine update_in_pieces
end module mud_pieces
