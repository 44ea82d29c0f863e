! SPDX-License-Identifier: MIT
!> Increments of a few points of one material side by side, of a file compiled for newer processors.
module mud_lane_kernel
   use, intrinsic :: iso_c_binding, only: c_int, c_ptr, c_f_pointer
   use mud_blocks, only: blocks_t
   use mud_integration, only: integration_t
   use mud_kernel, only: report_t, output_t, start_t, read_state, write_output, report_of, from_umat_strain
   use mud_kinds, only: wp
   use mud_lanes, only: fits_lanes, update_side_by_side
   use mud_params, only: params_t
   use mud_registry, only: S_SUCTION
   use mud_status, only: MUD_OK, MUD_BAD_STATE
   use mud_vector, only: WIDTH
   implicit none (type, external)
   private
   public :: mud_points_of_level
contains
   !> See mud_side_by_side. A failed increment has its status in its report alone.
   recursive integer(c_int) function mud_points_of_level(material, increments, n, tangent, outputs, reports) &
      bind(c)
      type(c_ptr), value :: material, increments, outputs, reports
      integer(c_int), value :: n, tangent
      type(params_t), pointer :: par
      type(start_t), pointer :: start(:)
      type(output_t), pointer :: output(:)
      type(report_t), pointer :: report(:)
      type(integration_t) :: it(WIDTH)
      type(blocks_t) :: blocks(WIDTH)
      real(wp) :: strain(6, WIDTH), d_suction(WIDTH)
      integer :: j

      call c_f_pointer(material, par)
      mud_points_of_level = 0
      if (.not. fits_lanes(par)) return
      mud_points_of_level = 1
      call c_f_pointer(increments, start, [n])
      call c_f_pointer(outputs, output, [n])
      call c_f_pointer(reports, report, [n])
      do j = 1, n
         it(j)%status%code = MUD_BAD_STATE
         if (.not. associated(start(j)%statev)) cycle
         strain(:, j) = from_umat_strain(start(j)%d_strain)
         d_suction(j) = start(j)%d_suction
         associate (statev => start(j)%statev)
            call read_state(par, start(j)%stress, statev, statev(S_SUCTION), it(j)%state, output(j)%statev, it(j)%status)
         end associate
      end do
      call update_side_by_side(par, int(n), strain, d_suction, int(tangent), it, blocks)
      do j = 1, n
         if (it(j)%status%code == MUD_OK) call write_output(par%options_t, it(j)%state, blocks(j), it(j)%counters, &
                                                            tangent > 0, output(j), it(j)%status)
         report(j) = report_of(it(j)%status, it(j)%counters, it(j)%reached)
      end do
   end function mud_points_of_level
end module mud_lane_kernel
