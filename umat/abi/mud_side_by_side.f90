! SPDX-License-Identifier: MIT
!> A few points of one material side by side (MUD_LANES of mud.h): what the lanes are given, and what they could not do.
module mud_side_by_side
   use, intrinsic :: iso_c_binding, only: c_int, c_loc, c_null_ptr, c_ptr
   use mud_host_increment, only: host_stress, make_total, never_began, suction_change, kind_of, is_total
   use mud_kernel, only: report_t, output_t, start_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_prepared, only: prepared_t, find_prepared
   use mud_registry, only: S_SUCTION
   use mud_status, only: mud_status_t, MUD_OK
   use mud_vector, only: WIDTH
   implicit none (type, external)
   private
   public :: given_t, update_side_by_side, c_prepared_lanes

   !> An increment as a host asks for it: stress as its options say, suction at the end.
   type :: given_t
      real(wp) :: stress(6), d_strain(6), suction
      real(wp), pointer, contiguous :: statev(:)
   end type given_t

   interface
      !> kernel_point for n increments, start_t, of a material, params_t, with their results, output_t, and reports; one
      !> without STATEV is left out. 0: nothing was done, for this processor, or this material, has no lanes.
      integer(c_int) function mud_lane_points(material, increments, n, tangent, outputs, reports) &
         bind(c, name='mud_lane_points')
         import :: c_int, c_ptr
         type(c_ptr), value :: material, increments, outputs, reports
         integer(c_int), value :: n, tangent
      end function mud_lane_points
   end interface
contains
   !> 1 where points of a prepared material go side by side on this processor, else 0. MUD_NULL_ARGUMENT,
   !> MUD_NOT_PREPARED.
   integer(c_int) function c_prepared_lanes(storage) bind(c, name='mud_prepared_lanes')
      type(c_ptr), value :: storage
      type(prepared_t), pointer :: material
      type(mud_status_t) :: status

      call find_prepared(storage, material, status)
      c_prepared_lanes = status%code
      if (status%code == MUD_OK) c_prepared_lanes = mud_lane_points(c_loc(material%par), c_null_ptr, 0, 0, c_null_ptr, &
                                                                    c_null_ptr)
   end function c_prepared_lanes

   !> host_increment for each of the points, where the lanes can and it does not fail; done tells which. The answer of a
   !> point does not depend on the points beside it.
   subroutine update_side_by_side(par, given, options, outputs, reports, done)
      type(params_t), intent(in), target :: par
      type(given_t), intent(in), contiguous :: given(:)   !< WIDTH at most
      integer, intent(in) :: options
      type(output_t), intent(inout), contiguous, target :: outputs(:)
      type(report_t), intent(inout), contiguous, target :: reports(:)
      logical, intent(out) :: done(:)
      type(start_t), target :: starts(WIDTH)
      integer :: i

      do i = 1, size(given)
         nullify (starts(i)%statev)
         if (never_began(given(i)%statev)) cycle
         starts(i)%statev => given(i)%statev
         starts(i)%stress = host_stress(given(i)%stress, given(i)%statev, options)
         starts(i)%d_strain = given(i)%d_strain
         starts(i)%d_suction = suction_change(given(i)%statev(S_SUCTION), given(i)%suction)
      end do
      done = mud_lane_points(c_loc(par), c_loc(starts), size(given), kind_of(options), c_loc(outputs), &
                             c_loc(reports)) /= 0
      done = done .and. reports%status == MUD_OK
      if (.not. is_total(options)) return
      do i = 1, size(given)
         if (done(i)) call make_total(outputs(i))
      end do
   end subroutine update_side_by_side
end module mud_side_by_side
