! SPDX-License-Identifier: MIT
!> Water that the balances of a stage leave unaccounted for. Where air is an unknown, Newton's method solves the sum of
!> the balances of both fluids: a flow of air that is much larger hides what is left of the water.
!> docs/theory/host.md section 5.1.
module water_balance
   use archive, only: archive_t
   use faults, only: fault_t
   use model_types, only: model_t
   use run_observer, only: observer_t, accepted_step_t
   use run_state, only: run_t
   use warnings, only: print_warning
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use generalised_alpha, only: scheme_t
   use prescribed_values, only: constraint_t
   use scene_types, only: stage_t
   use texts, only: short
   use unknown_fields, only: AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: water_alarm_t

   !> Share of the water that has come and gone from which on it is told [-].
   real(wp), parameter :: ALARMING_SHARE = 0.02_wp

   !> Of a stage so far.
   type :: water_t
      real(wp) :: missing = 0.0_wp   !< What the balances of its free unknowns leave, with its sign [m3].
      real(wp) :: moved = 0.0_wp     !< Through boundaries, in and out [m3].
   end type water_t

   type, extends(observer_t) :: water_alarm_t
      type(water_t) :: water
   contains
      procedure :: exchange
      procedure :: step
      procedure :: stage_ends
   end type water_alarm_t
contains
   !> Exchanges the water of the stage so far.
   subroutine exchange(self, archive)
      class(water_alarm_t), intent(inout) :: self
      type(archive_t), intent(inout) :: archive

      call archive%exchange('water_missing', self%water%missing, 'm3', 'what the balances of water leave in the stage')
      call archive%exchange('water_moved', self%water%moved, 'm3', 'water through boundaries in the stage')
   end subroutine exchange

   !> Books the water of a step.
   subroutine step(self, model, run, done, fault)
      class(water_alarm_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(accepted_step_t), intent(inout) :: done
      type(fault_t), intent(inout) :: fault

      associate (never => fault)
      end associate
      call book_water(model%dofs, done%scheme, run%constraint, run%system%reaction, self%water)
   end subroutine step

   !> Warns of the water that is missing at the end of a stage.
   subroutine stage_ends(self, model, run, complete, fault)
      class(water_alarm_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      logical, intent(in) :: complete
      type(fault_t), intent(inout) :: fault

      associate (unused => complete, never => fault)
      end associate
      call warn_of_missing_water(model%stages(run%at%stage), self%water)
      self%water = water_t()
   end subroutine stage_ends

   !> After an accepted step. reaction: residual with the constrained rows kept, of the sum of both fluids where air is
   !> an unknown and of water where its pressure is prescribed [m3/s]. (unknowns)
   pure subroutine book_water(dofs, scheme, constraint, reaction, water)
      type(dofs_t), intent(in) :: dofs
      type(scheme_t), intent(in) :: scheme
      type(constraint_t), intent(in) :: constraint
      real(wp), intent(in) :: reaction(:)
      type(water_t), intent(inout) :: water
      real(wp) :: left, inflow
      integer :: node, w, c

      if (.not. scheme%has_rates) return
      do node = 1, size(constraint%air)
         w = dofs%of(AT_P_W, node)
         c = dofs%of(AT_P_C, node)
         if (w == 0 .or. c == 0) cycle
         left = reaction(w)
         ! Where suction is prescribed the flow of air is unknown: only its sum with the water is known.
         if (.not. constraint%air(node)) then
            if (constraint%fixed(c)) cycle
            left = left - reaction(c)
         end if
         inflow = constraint%load_0(w) - constraint%load_0(c) + scheme%l_f*(constraint%load_1(w) &
                  - constraint%load_0(w) - constraint%load_1(c) + constraint%load_0(c))
         water%moved = water%moved + scheme%dt*abs(inflow)
         if (constraint%fixed(w)) then
            water%moved = water%moved + scheme%dt*abs(left)
         else
            water%missing = water%missing + scheme%dt*left
         end if
      end do
   end subroutine book_water

   !> At the end of a stage, on standard error, also where the run is quiet. Raises no fault.
   subroutine warn_of_missing_water(stage, water)
      type(stage_t), intent(in) :: stage
      type(water_t), intent(in) :: water

      if (abs(water%missing) <= ALARMING_SHARE*water%moved) return
      if (.not. water%moved > 0.0_wp) return
      call print_warning('stage '//trim(stage%name)//': the balances of water leave '//short(abs(water%missing))// &
         ' m3, '//short(100*abs(water%missing)/water%moved)//' % of the water that has come and gone: air flows so '// &
         'much more that Newton''s method does not see it. Set a smaller tolerance in &stage, now '// &
         short(stage%tolerance)//'.')
   end subroutine warn_of_missing_water
end module water_balance
