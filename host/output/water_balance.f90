! SPDX-License-Identifier: MIT
!> Observer that compares the water that is stored in the pores with what goes through the boundaries. What a stage has
!> lost or made is told at its end, whatever the cause: neither the residuals of Newton's method nor the rates of the
!> scheme count here. docs/theory/host.md section 9.2.
module water_balance
   use archive, only: archive_t
   use convergence, only: RATE_SHARE
   use springs, only: water_through_dashpots
   use faults, only: fault_t
   use kinds, only: wp
   use porous_domain, only: means_t, means_over, strain_of, is_present, COUPLED, UNDRAINED, OUTFLOWS
   use run_observer, only: observer_t, STEP, STAGE_ENDS
   use run_state, only: run_t
   use step_balance, only: mean_outflow
   use texts, only: short
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: water_alarm_t

   real(wp), parameter :: ALARMING_SHARE = 0.02_wp   !< Share of the water that has come and gone from which it is told.
   !> Share of the water that has moved in the pores below which a difference is what Newton's tolerance may leave.
   real(wp), parameter :: INSIDE_SHARE = 0.002_wp
   real(wp), parameter :: ROUNDING = 1.0e-12_wp   !< Share of the water of a point: where all is at rest nothing moves.

   !> Sums of the stage under way.
   type :: water_t
      real(wp) :: gained = 0.0_wp     !< Water that the pores took up by their volume, saturation and pressure [m3].
      real(wp) :: turned = 0.0_wp     !< Sum with all parts by magnitude [m3].
      real(wp) :: received = 0.0_wp   !< Water through loads, less what dashpots let out [m3].
      real(wp) :: left = 0.0_wp       !< Water through prescribed pressures, less the rain [m3].
      real(wp) :: moved = 0.0_wp      !< Water through boundaries, in and out [m3].
      real(wp) :: hidden = 0.0_wp     !< Water that Newton's method may lose where nothing flows [m3].
   end type water_t

   type, extends(observer_t) :: water_alarm_t
      type(water_t) :: water
   contains
      procedure :: exchange
      procedure :: hear
   end type water_alarm_t
contains
   !> Exchanges the water of the stage so far.
   subroutine exchange(self, archive)
      class(water_alarm_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      associate (w => self%water)
         call archive%exchange('water_gained', w%gained, 'm3', 'water that the pores took up in the stage')
         call archive%exchange('water_turned', w%turned, 'm3', 'the same with all parts by magnitude')
         call archive%exchange('water_received', w%received, 'm3', 'water through loads in the stage')
         call archive%exchange('water_left', w%left, 'm3', 'water through prescribed pressures in the stage')
         call archive%exchange('water_moved', w%moved, 'm3', 'water through boundaries in the stage')
         call archive%exchange('water_hidden', w%hidden, 'm3', 'what Newton''s method may leave where nothing flows')
      end associate
   end subroutine exchange

   !> Books every step, and looks at what a stage has lost or made at its end.
   subroutine hear(self, event, run, fault)
      class(water_alarm_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      if (event == STEP) call book(self, run)
      if (event == STAGE_ENDS) call look_at_missing(self, run)
   end subroutine hear

   !> Books the water of a step.
   subroutine book(self, run)
      class(water_alarm_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      integer :: e

      if (.not. run%scheme%has_rates .or. .not. run%domain%with_w) return
      call book_boundaries(run, self%water)
      do e = 1, size(run%domain%region_of)
         if (is_present(run%state, e) .and. any(run%domain%regions(run%domain%region_of(e))%drainage == &
                                                [COUPLED, UNDRAINED])) &
            call book_storage(e, run, self%water)
      end do
   end subroutine book

   !> Warns at the end of a stage of the water that is missing or made; not where the scene leaves a part of the rate of
   !> saturation out.
   subroutine look_at_missing(self, run)
      class(water_alarm_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      character(:), allocatable :: of_what
      real(wp) :: missing

      associate (water => self%water, stage => run%stage)
         missing = water%received - water%left - water%gained
         if (run%domain%full_rate .and. abs(missing) > max(ALARMING_SHARE*water%moved, INSIDE_SHARE*water%turned, &
                                                              water%hidden)) then
            of_what = short(100*abs(missing)/water%turned)//' % of what has moved in its pores'
            if (water%moved > 0.0_wp) of_what = short(100*abs(missing)/water%moved)//' % of what has come and gone'
            call print_warning('stage '//trim(stage%name)//': '//short(abs(missing))//' m3 of water are '// &
               trim(merge('missing', 'made   ', missing > 0.0_wp))//' in the ground, '//of_what//'. Set a smaller '// &
               'tolerance in &stage, now '//short(stage%tolerance)//', and shorter steps.')
         end if
      end associate
      self%water = water_t()
   end subroutine look_at_missing

   !> Adds what the pores of an element take up in a step: by their volume, their saturation and the pressure of the
   !> water.
   pure subroutine book_storage(e, run, water)
      integer, intent(in) :: e
      type(run_t), intent(in) :: run
      type(water_t), intent(inout) :: water
      type(means_t) :: mean
      real(wp) :: du(DISPLACEMENTS, 6), rise(6), strain(4), parts(3)
      integer :: g, at, n_p

      associate (node => run%domain%mesh%t6(:, e), carriers => run%domain%carriers(:run%domain%n_carriers(e), e), &
                 old => run%state, new => run%next)
         du = new%x(:DISPLACEMENTS, node) - old%x(:DISPLACEMENTS, node)
         n_p = size(carriers)
         rise(:n_p) = new%x(AT_P_W, carriers) - old%x(AT_P_W, carriers)   ! what is given of a pressure stays
      end associate
      do g = 1, run%domain%rule
         at = (e - 1)*run%domain%rule + g
         associate (gp => run%domain%gauss(g, e), old => run%state, new => run%next)
            mean = means_over(old, new, at)
            strain = strain_of(gp, du)
            parts(1) = mean%s*sum(strain(:3))
            parts(2) = mean%n*(new%s(at) - old%s(at))
            parts(3) = mean%n*mean%s*dot_product(gp%m(:n_p), rise(:n_p))/run%domain%fluids%k_w
            water%gained = water%gained + gp%weight*sum(parts)
            water%turned = water%turned + gp%weight*(sum(abs(parts)) + ROUNDING*mean%n*mean%s)
         end associate
      end do
   end subroutine book_storage

   !> Adds what has come through loads and dashpots, what has left through prescribed pressures, and the
   !> magnitude of all that. What is offered to a limit counts as water that did not leave.
   pure subroutine book_boundaries(run, water)
      type(run_t), intent(in) :: run
      type(water_t), intent(inout) :: water
      real(wp) :: inflow, outflow, mean(OUTFLOWS)
      integer :: node, w, c

      ! The residual is that of the sum of both fluids where air is an unknown, of water where air is prescribed.
      associate (scheme => run%scheme, constraint => run%constraint, reaction => run%system%reaction)
         do w = 1, run%dofs%n
            if (run%dofs%field(w) /= AT_P_W) cycle
            node = run%dofs%node(w)
            c = run%dofs%of(AT_P_C, node)
            water%hidden = water%hidden + scheme%dt*run%newton%tolerance*RATE_SHARE &
                                          *run%assembly%floor(merge(c, w, c > 0))
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
         mean = mean_outflow(run)
         water%left = water%left + scheme%dt*(mean(1) - mean(2))
         water%received = water%received - water_through_dashpots(run)
      end associate
   contains
      !> Finds the mean inflow over the step [m3/s].
      pure real(wp) function inflow_at(i)
         integer, intent(in) :: i

         associate (c => run%constraint)
            inflow_at = 0.5_wp*(c%load_0(i) + c%load_1(i) - c%offered_0(i) - c%offered_1(i)) - c%offset(i)
         end associate
      end function inflow_at
   end subroutine book_boundaries
end module water_balance
