! SPDX-License-Identifier: MIT
!> A library without lanes, for processors and compilers other than those of cmake/MudLanes.cmake.
module mud_no_lanes
   use, intrinsic :: iso_c_binding, only: c_associated, c_int, c_ptr
   implicit none (type, external)
   private
   public :: mud_lane_points, mud_fetch
contains
   !> See mud_side_by_side: nothing is done.
   integer(c_int) function mud_lane_points(material, increments, n, tangent, outputs, reports) &
      bind(c, name='mud_lane_points')
      type(c_ptr), value :: material, increments, outputs, reports
      integer(c_int), value :: n, tangent

      mud_lane_points = 0
      if (.not. (c_associated(material) .and. c_associated(increments) .and. c_associated(outputs) .and. &
                 c_associated(reports) .and. n >= 0 .and. tangent >= 0)) mud_lane_points = 0   ! all are read
   end function mud_lane_points

   !> See mud_batch: nothing is done.
   subroutine mud_fetch(first, bytes) bind(c, name='mud_fetch')
      type(c_ptr), value :: first
      integer(c_int), value :: bytes

      if (c_associated(first)) bytes = 0   ! both are read
   end subroutine mud_fetch
end module mud_no_lanes
