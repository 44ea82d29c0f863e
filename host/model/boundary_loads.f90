! SPDX-License-Identifier: MIT
!> Load vectors at a moment, of the loads and plates of a stage.
module boundary_loads
   use kinds, only: wp
   use model_types, only: model_t, factor_at, gravity_at, load_t, plate_t
   use scene_parts, only: acts_in, stage_t
   use unknown_fields, only: AT_U_Z
   use degrees_of_freedom, only: dofs_t, unknowns_of_body
   implicit none (type, external)
   private
   public :: load_at, force_of, plate_loads
contains
   !> Loads of a stage at a time. (unknowns) Forces of loads and plates [kN], inflows [m3/s]: docs/theory/host.md
   !> sections 7.2 and 7.3.
   function load_at(model, stage, dofs, time) result(load)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: time   !< [s]
      real(wp), allocatable :: load(:)
      real(wp) :: loads(3)
      integer :: i

      allocate (load(dofs%n), source=0.0_wp)
      do i = 1, size(model%loads)
         associate (one => model%loads(i))
            if (acts_in(one%stages, stage%name)) load = load + force_of(one, factor_at(model, one%amplitude, time))
         end associate
      end do
      do i = 1, size(model%plates)
         associate (one => model%plates(i))
            loads = plate_loads(model, one, time)
            if (one%turns) then
               associate (at => unknowns_of_body(dofs, one%node, one%turn_node))
                  load(at) = load(at) + [loads(:2), loads(3)/one%lever]
               end associate
            else
               associate (at => dofs%of(AT_U_Z, one%node))
                  load(at) = load(at) + loads(2)
               end associate
            end if
         end associate
      end do
   end function load_at

   !> Forces [kN] or inflows [m3/s] of a load at a factor of its history. (unknowns)
   pure function force_of(load, factor) result(force)
      type(load_t), intent(in) :: load
      real(wp), intent(in) :: factor   !< [-]
      real(wp), allocatable :: force(:)

      force = factor*load%value*load%shape
      if (allocated(load%rise)) force = force + factor*load%value_slope*load%rise
   end function force_of

   !> Forces on a plate along r and upwards, its weight among them [kN], and the moment from r to z [kN m].
   !> docs/theory/host.md section 7.3.
   pure function plate_loads(model, plate, time) result(loads)
      type(model_t), intent(in) :: model
      type(plate_t), intent(in) :: plate
      real(wp), intent(in) :: time   !< [s]
      real(wp) :: loads(3)

      loads = factor_at(model, plate%amplitude, time)*[plate%force_r, plate%force, plate%moment]
      if (plate%heavy) loads(2) = loads(2) - plate%mass*gravity_at(model, time)
   end function plate_loads
end module boundary_loads
