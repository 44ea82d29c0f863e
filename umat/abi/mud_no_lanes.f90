! SPDX-License-Identifier: MIT
!> A library without lanes, for processors and compilers other than those of cmake/MudLanes.cmake.
module mud_no_lanes
   use, intrinsic :: iso_c_binding, only: c_int, c_ptr
   implicit none (type, external)
   private
   public :: mud_lane_points
contains
   !> See mud_side_by_side: nothing is done.
   pure integer(c_int) function mud_lane_points(material, increments, n, tangent, outputs, reports) bind(c, name='mud_lane_points')
      type(c_ptr), value :: material, increments, outputs, reports
      integer(c_int), value :: n, tangent

      mud_lane_points = 0
   end function mud_lane_points
end module mud_no_lanes
