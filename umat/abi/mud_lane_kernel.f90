! SPDX-License-Identifier: MIT
!> Increments of a few points of one material side by side, of a file compiled for newer processors.
module mud_lane_kernel
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_ptr, c_f_pointer
   use mud_blocks, only: blocks_t
   use mud_integration, only: integration_t
   use mud_kernel, only: report_t, output_t, read_state, write_output, report_of, from_umat_strain
   use mud_kinds, only: wp
   use mud_lanes, only: WIDTH, fits_lanes, update_side_by_side
   use mud_params, only: params_t
   use mud_status, only: MUD_OK
   implicit none (type, external)
   private
   public :: mud_lane_points
contains
   !> As kernel_point for each of n points; a failed one has its status in its report alone.
   subroutine mud_lane_points(material, n, n_statev, stress, statev, d_strain, suction, d_suction, kind, results, reports) &
      bind(c, name='mud_lane_points')
      type(c_ptr), value :: material, results
      integer(c_int), value :: n, n_statev, kind
      real(c_double), intent(in) :: stress(6, WIDTH), statev(n_statev, WIDTH), d_strain(6, WIDTH), suction(WIDTH), &
                                    d_suction(WIDTH)
      type(report_t), intent(out) :: reports(WIDTH)
      type(params_t), pointer :: par
      type(output_t), pointer :: output(:)
      type(integration_t) :: it(WIDTH)
      type(blocks_t) :: blocks(WIDTH)
      real(wp) :: strain(6, WIDTH)
      integer :: j

      call c_f_pointer(material, par)
      call c_f_pointer(results, output, [WIDTH])
      do j = 1, n
         strain(:, j) = from_umat_strain(d_strain(:, j))
         call read_state(par, stress(:, j), statev(:, j), suction(j), it(j)%state, output(j)%statev, it(j)%status)
      end do
      call update_side_by_side(par, int(n), strain, d_suction, int(kind), it, blocks)
      do j = 1, n
         if (it(j)%status%code == MUD_OK) call write_output(par%options_t, it(j)%state, blocks(j), it(j)%counters, &
                                                            kind > 0, output(j), it(j)%status)
         reports(j) = report_of(it(j)%status, it(j)%counters, it(j)%reached)
      end do
   end subroutine mud_lane_points
end module mud_lane_kernel
