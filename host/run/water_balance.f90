! SPDX-License-Identifier: MIT
!> Water that is stored in the pores against what goes through the boundaries. What a stage has lost or made is told at
!> its end, whatever the cause: neither the residuals of Newton's method nor the rates of the scheme count here.
!> docs/theory/host.md section 9.2.
module water_balance
   use warnings, only: print_warning
   use kinds, only: wp
   use dashpots, only: water_through_dashpots
   use degrees_of_freedom, only: dofs_t
   use generalised_alpha, only: scheme_t, STATIC
   use porous_domain, only: state_t
   use prescribed_values, only: constraint_t
   use scene_types, only: stage_t
   use texts, only: short
   use unknown_fields, only: AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: water_t, book_storage, book_water, begin_water, warn_of_missing_water

   real(wp), parameter :: ALARMING_SHARE = 0.02_wp   !< Of the water that has come and gone: from here on it is told.
   !> Of what has moved in the pores: what Newton's tolerance may leave of that is none.
   real(wp), parameter :: INSIDE_SHARE = 0.002_wp
   real(wp), parameter :: ROUNDING = 1.0e-12_wp   !< Of the water of a point: where all is at rest nothing else moves.

   !> Sums of a run; `turned` and `moved` are those of the stage under way.
   type :: water_t
      real(wp) :: gained = 0.0_wp     !< By the pores: by their volume, saturation and pressure [m3].
      real(wp) :: turned = 0.0_wp     !< The same with all parts by magnitude [m3].
      real(wp) :: received = 0.0_wp   !< Through loads, less what absorbing boundaries let out [m3].
      real(wp) :: moved = 0.0_wp      !< Through boundaries, in and out [m3].
      real(wp) :: open_0 = 0.0_wp     !< What the balance left open where the present stage began [m3].
   end type water_t
contains
   !> What the pores of a quadrature point take up in a step.
   pure subroutine book_storage(weight, volume, n, s, d_s, compression, water)
      real(wp), intent(in) :: weight        !< Volume of the point [m3].
      real(wp), intent(in) :: volume        !< Increment of the volume strain [-].
      real(wp), intent(in) :: n, s          !< Means of porosity and degree of saturation [-].
      real(wp), intent(in) :: d_s           !< Increment of the degree of saturation [-].
      real(wp), intent(in) :: compression   !< Of the water: increment of p_w over its bulk modulus [-].
      type(water_t), intent(inout) :: water
      real(wp) :: parts(3)

      parts = weight*[s*volume, n*d_s, n*s*compression]
      water%gained = water%gained + sum(parts)
      water%turned = water%turned + sum(abs(parts)) + ROUNDING*weight*n*s
   end subroutine book_storage

   !> After an accepted step: what has come through loads and absorbing boundaries, and the magnitude of all that went
   !> through boundaries. reaction: residual with the constrained rows kept, of the sum of both fluids where air is an
   !> unknown and of water where its pressure is prescribed [m3/s]. (unknowns) Rain counts as outflow of the ledger.
   pure subroutine book_water(dofs, scheme, constraint, reaction, old, new, water)
      type(dofs_t), intent(in) :: dofs
      type(scheme_t), intent(in) :: scheme
      type(constraint_t), intent(in) :: constraint
      real(wp), intent(in) :: reaction(:)
      type(state_t), intent(in) :: old, new
      type(water_t), intent(inout) :: water
      real(wp) :: inflow, outflow
      integer :: node, w, c

      if (scheme%kind == STATIC) return
      do node = 1, size(constraint%air)
         w = dofs%of(AT_P_W, node)
         if (w == 0) cycle
         c = dofs%of(AT_P_C, node)
         inflow = inflow_at(w)
         outflow = 0.0_wp
         if (constraint%fixed(w)) outflow = reaction(w)
         if (c > 0) then
            inflow = inflow - inflow_at(c)
            ! Where suction is prescribed what leaves is known by the air that comes in its place.
            if (constraint%fixed(c) .and. .not. constraint%air(node)) outflow = outflow - reaction(c)
         end if
         water%received = water%received + scheme%dt*inflow
         water%moved = water%moved + scheme%dt*(abs(inflow) + abs(outflow))
      end do
      if (allocated(constraint%dashpots)) water%received = water%received &
         - water_through_dashpots(constraint%dashpots, dofs, constraint%air, new%x - old%x)
   contains
      !> Mean over the step [m3/s].
      pure real(wp) function inflow_at(i)
         integer, intent(in) :: i

         inflow_at = 0.5_wp*(constraint%load_0(i) + constraint%load_1(i) - constraint%rain_0(i) &
                             - constraint%rain_1(i)) - constraint%offset(i)
      end function inflow_at
   end subroutine book_water

   !> What the balance leaves open [m3]. outflow: of water, through prescribed pressures, less the rain.
   pure real(wp) function open_water(water, outflow)
      type(water_t), intent(in) :: water
      real(wp), intent(in) :: outflow   !< [m3]

      open_water = water%received - outflow - water%gained
   end function open_water

   !> A stage begins an account of its own.
   pure subroutine begin_water(outflow, water)
      real(wp), intent(in) :: outflow   !< As of open_water.
      type(water_t), intent(inout) :: water

      water%open_0 = open_water(water, outflow)
      water%turned = 0.0_wp
      water%moved = 0.0_wp
   end subroutine begin_water

   !> At the end of a stage, on standard error, also where the run is quiet. Raises no fault.
   subroutine warn_of_missing_water(stage, water, outflow)
      type(stage_t), intent(in) :: stage
      type(water_t), intent(in) :: water
      real(wp), intent(in) :: outflow   !< As of open_water.
      character(:), allocatable :: of_what
      real(wp) :: missing

      missing = open_water(water, outflow) - water%open_0
      if (abs(missing) <= max(ALARMING_SHARE*water%moved, INSIDE_SHARE*water%turned)) return
      of_what = short(100*abs(missing)/water%turned)//' % of what has moved in its pores'
      if (water%moved > 0.0_wp) of_what = short(100*abs(missing)/water%moved)//' % of what has come and gone'
      call print_warning('stage '//trim(stage%name)//': '//short(abs(missing))//' m3 of water are '// &
         trim(merge('missing', 'made   ', missing > 0.0_wp))//' in the ground, '//of_what//'. Set a smaller '// &
         'tolerance in &stage, now '//short(stage%tolerance)//', and shorter steps.')
   end subroutine warn_of_missing_water
end module water_balance
