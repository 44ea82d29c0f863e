! SPDX-License-Identifier: MIT
!> Load vectors at a moment, of the loads and plates of a stage.
module boundary_loads
   use kinds, only: wp
   use model_types, only: model_t, factor_at, gravity_at, load_t, plate_t, unknowns_of
   implicit none (type, external)
   private
   public :: load_at, force_of, plate_loads
contains
   !> Loads of a stage at a time. (unknowns) Forces of loads and plates [kN], inflows [m3/s]: docs/theory/host.md
   !> sections 7.2 and 7.3.
   function load_at(model, stage, time) result(load)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Number of the stage.
      real(wp), intent(in) :: time   !< [s]
      real(wp), allocatable :: load(:)
      integer :: i

      allocate (load(model%dofs%n), source=0.0_wp)
      do i = 1, size(model%loads)
         associate (one => model%loads(i))
            if (one%in_stage(stage)) load = load + force_of(one, factor_at(model, one%amplitude, time))
         end associate
      end do
      do i = 1, size(model%plates)
         associate (one => model%plates(i))
            associate (at => unknowns_of(one, model%dofs))
               load(at) = load(at) + plate_loads(model, one, time)/one%coordinates%unit
            end associate
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

   !> Loads on the coordinates of a plate, its weight among them: first the force upwards [kN]. docs/theory/host.md
   !> section 7.3.
   pure function plate_loads(model, plate, time) result(loads)
      type(model_t), intent(in) :: model
      type(plate_t), intent(in) :: plate
      real(wp), intent(in) :: time   !< [s]
      real(wp) :: loads(size(plate%coordinates))

      loads = factor_at(model, plate%amplitude, time)*plate%coordinates%load
      if (plate%heavy) loads(1) = loads(1) - plate%mass*gravity_at(model, time)
   end function plate_loads
end module boundary_loads
