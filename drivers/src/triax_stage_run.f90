! SPDX-License-Identifier: MIT
!> Runs a stage: one way, or the ways between the reversals of its cycles, and what ends it early. Strain cycles reverse
!> at given strains. Stress cycles drive the strain until the stress is reached, which is found within the increment: a
!> liquefied sample has no stiffness to solve with, but a strain can always be driven.
module triax_stage_run
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use faults, only: fault_t, raise, EXIT_RUN
   use texts, only: short, whole
   use triax_stage, only: test_stage_t, keeps_volume, shear_control, QUANTITIES, LINEAR, PER_PRESSURE
   use triax_control, only: plan_t, tally_t, plan_path, advance, lead, quantity
   use triax_point, only: soil_t, point_t, AXIAL, RADIAL
   implicit none (type, external)
   private
   public :: stage_run_t, begin_stage, next_increment, share_done

   !> A reversal stress is met to this share of the amplitude; the library's own tolerance is 1e-5 of the stress.
   real(wp), parameter :: REVERSAL_TOLERANCE = 1.0e-7_wp
   real(wp), parameter :: ROUNDING = 1.0e-12_wp            !< Share of a change of suction.
   integer, parameter :: MAX_SEARCH = 50                   !< Bisection alone would come to 1e-15 of an increment.
   real(wp), parameter :: MAX_WAY = 0.5_wp                 !< Strain between two reversals of a stress cycle [-].
   real(wp), parameter :: ON_GRID = 1.0e-6_wp              !< Share of an output interval that counts as none: rounding.

   !> State of a stage that runs.
   type :: stage_run_t
      type(plan_t) :: plan
      logical :: finished = .false.
      logical :: row = .false.             !< The last increment calls for a row of the output.
      integer :: k = 0                     !< Increments of the present way.
      integer :: way = 0, ways = 1         !< Present way, number of ways.
      integer :: cycle = 0                 !< Cycle of the last increment, from 1; 0: none.
      logical :: open = .false.            !< The way ends where a stress is reached.
      real(wp) :: centre = 0.0_wp, goal = 0.0_wp, direction = 1.0_wp
      logical :: sealed = .false.          !< Undrained and saturated: pore pressure is what changes.
      real(wp) :: confining = 0.0_wp       !< Effective stress where the total one is constant, at the start [stress].
      real(wp) :: pressure = 0.0_wp        !< Excess pore pressure [unit of stress].
      real(wp) :: pressure_start = 0.0_wp
      real(wp) :: p_w_start = 0.0_wp       !< Water pressure where the stage begins [unit of stress].
      real(wp) :: r_u = 0.0_wp             !< Pore pressure that has built up in this stage over `confining` [-].
      character(200) :: note = ''          !< Sentence on its end, where that is not plain.
   end type stage_run_t

contains
   !> Plans a stage from the present state of the sample. Fault EXIT_RUN: stop_r_u, or a constant water content, does
   !> not fit the suction of the sample, d_suction leads below 0, or steps are given of what does not move.
   subroutine begin_stage(soil, stage, point, pressure, run, fault)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      type(point_t), intent(in) :: point
      real(wp), intent(in) :: pressure   !< Excess pore pressure so far [unit of stress of the law].
      type(stage_run_t), intent(out) :: run
      type(fault_t), intent(inout) :: fault

      run%pressure = pressure
      run%pressure_start = pressure
      run%confining = confining_stress(stage, point)
      run%sealed = keeps_volume(stage%control) .and. point%suction <= 0.0_wp .and. &
                   .not. (stage%moves_suction .and. max(stage%suction_end, stage%suction_change) > 0.0_wp)
      run%p_w_start = point%p_a - point%suction
      if (stage%stop_r_u > 0.0_wp .and. .not. (run%sealed .or. stage%keeps_air)) then
         call raise(fault, EXIT_RUN, 'stop_r_u needs a saturated sample; the suction is '//short(point%suction)// &
                    ' '//trim(soil%law%unit%name)//'.')
      else if (stage%keeps_water .and. point%suction <= 0.0_wp) then
         call raise(fault, EXIT_RUN, 'water = ''constant'' needs a suction to follow; the sample is saturated. '// &
                    'A saturated sample keeps its water where its volume is held (undrained).')
      else if (stage%by_change .and. stage%control /= LINEAR .and. &   ! by LINEAR the increment of a host is repeated
               point%suction + stage%suction_change < -ROUNDING*abs(stage%suction_change)) then
         call raise(fault, EXIT_RUN, 'd_suction = '//short(stage%suction_change)//' is outside its range (from '// &
                    short(0.0_wp - point%suction)//' '//trim(soil%law%unit%name)//': the stage begins at a suction '// &
                    'of '//short(point%suction)//', and suction_end is 0 or more).')
      end if
      if (stage%cycles > 0) then
         run%centre = quantity(soil, stage, stage%cycle_by, point)
         if (stage%has_centre) run%centre = stage%centre
         run%ways = 2*stage%cycles + 1
         run%open = stage%cycle_by /= stage%lead
      end if
      call next_way(soil, stage, point, run)
      if (run%plan%by_suction .and. QUANTITIES(stage%lead)%unit /= PER_PRESSURE .and. &
          (stage%given_increment .or. stage%given_interval)) &
         call raise(fault, EXIT_RUN, trim(merge('increment      ', 'output_interval', stage%given_increment))// &
                    ' has no effect: what '//trim(QUANTITIES(stage%lead)%key)//' prescribes stays, or moves by '// &
                    'less than an increment; the steps are those of the suction, '// &
                    short(stage%suction_increment)//' '//trim(soil%law%unit%name)//'; remove it.')
   end subroutine begin_stage

   !> Makes one increment; at its end the run of the stage says whether it calls for a row and whether the stage is
   !> over. Faults: those of advance; EXIT_RUN: the stress of a cycle is not reached within a strain of MAX_WAY.
   subroutine next_increment(soil, stage, run, point, tally, fault)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      type(stage_run_t), intent(inout) :: run
      type(point_t), intent(inout) :: point
      type(tally_t), intent(inout) :: tally
      type(fault_t), intent(inout) :: fault
      type(point_t) :: before
      logical :: arrived

      run%k = run%k + 1
      run%cycle = cycle_of(stage, run%way)
      if (run%open) then
         before = point
         call advance(soil, run%plan, run%k, 1.0_wp, point, tally, fault)
         if (fault%code /= 0) return
         arrived = missing(soil, stage, run, point) <= 0.0_wp
         if (arrived) call find_goal(soil, stage, run, before, point, tally, fault)
         if (fault%code /= 0) return
         if (.not. arrived .and. run%k*stage%increment/stage%parts >= MAX_WAY) then
            call raise(fault, EXIT_RUN, trim(QUANTITIES(stage%cycle_by)%name)//' does not reach '// &
                       short(run%goal)//' '//trim(soil%law%unit%name)//' in cycle '//whole(run%cycle)// &
                       ': after a strain of '//short(MAX_WAY)//' it is '// &
                       short(quantity(soil, stage, stage%cycle_by, point))// &
                       ' '//trim(soil%law%unit%name)//'. Lower the amplitude, or end the stage '// &
                       'with stop_r_u or stop_double_amplitude.')
            return
         end if
      else
         call advance(soil, run%plan, run%k, 1.0_wp, point, tally, fault)
         if (fault%code /= 0) return
         arrived = run%k >= run%plan%increments
      end if
      run%row = arrived .or. passes(lead(run%plan, run%k - 1), lead(run%plan, run%k), run%plan%interval)
      if (run%sealed) then
         run%pressure = run%pressure_start + run%confining - confining_stress(stage, point)
         run%r_u = (run%pressure - run%pressure_start)/run%confining
      end if
      if (stage%keeps_air) then
         run%pressure = run%pressure_start + point%p_a - point%suction - run%p_w_start
         run%r_u = (run%pressure - run%pressure_start)/run%confining
      end if
      if (arrived) call next_way(soil, stage, point, run)
      if ((run%sealed .or. stage%keeps_air) .and. stage%stop_r_u > 0.0_wp .and. run%r_u >= stage%stop_r_u) then
         call stop_early('pore pressure ratio '//short(stage%stop_r_u))
      else if (stage%stop_double_amplitude > 0.0_wp .and. .not. arrived .and. &
               abs(quantity(soil, stage, stage%lead, point) - run%plan%lead_start) >= &
               stage%stop_double_amplitude) then
         call stop_early('double amplitude '//short(stage%stop_double_amplitude))
      else if (run%finished .and. stage%stop_r_u + stage%stop_double_amplitude > 0.0_wp) then
         run%note = 'went to its end without being stopped'
      end if
   contains
      subroutine stop_early(what)
         character(*), intent(in) :: what

         run%finished = .true.
         run%row = .true.
         run%note = what//' reached'
         if (run%cycle > 0) run%note = what//' reached in cycle '//whole(run%cycle)
      end subroutine stop_early
   end subroutine next_increment

   !> The cycle that a way belongs to: ways 2n - 1 and 2n make cycle n; the return to the centre belongs to the last.
   !> 0: the stage has no cycles.
   pure integer function cycle_of(stage, way)
      type(test_stage_t), intent(in) :: stage
      integer, intent(in) :: way

      cycle_of = min((way + 1)/2, stage%cycles)
   end function cycle_of

   !> Begins the next way that has a length, or finishes the stage after the last one.
   recursive subroutine next_way(soil, stage, point, run)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      type(point_t), intent(in) :: point
      type(stage_run_t), intent(inout) :: run

      if (run%way == run%ways) then
         run%finished = .true.
         return
      end if
      run%way = run%way + 1
      run%k = 0
      run%goal = stage%target
      if (stage%cycles > 0) then
         ! Ways 1, 2, 3, ...: to +A, -A, +A, ...; the last one to the centre.
         run%goal = run%centre + merge(stage%amplitude, -stage%amplitude, mod(run%way, 2) == 1)
         if (run%way == run%ways) run%goal = run%centre
      end if
      if (run%open) then
         run%direction = sign(1.0_wp, run%goal - quantity(soil, stage, stage%cycle_by, point))
         call plan_path(soil, stage, &
                        quantity(soil, stage, stage%lead, point) + run%direction*stage%increment/stage%parts, &
                        point, run%plan)
         run%plan%increments = 1
      else
         call plan_path(soil, stage, run%goal, point, run%plan)
         if (run%plan%increments == 0) call next_way(soil, stage, point, run)
      end if
   end subroutine next_way

   !> Finds the distance of the stress of a cycle from its reversal [unit of stress of the law].
   pure real(wp) function missing(soil, stage, run, point)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      type(stage_run_t), intent(in) :: run
      type(point_t), intent(in) :: point

      missing = run%direction*(run%goal - quantity(soil, stage, stage%cycle_by, point))
   end function missing

   !> Finds after which part of an increment the stress of a cycle is reached: regula falsi with bisection (Illinois).
   subroutine find_goal(soil, stage, run, before, point, tally, fault)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      type(stage_run_t), intent(inout) :: run
      type(point_t), intent(in) :: before
      type(point_t), intent(inout) :: point
      type(tally_t), intent(inout) :: tally
      type(fault_t), intent(inout) :: fault
      real(wp) :: low, high, at_low, at_high, here, share
      integer :: i, last

      low = 0.0_wp
      at_low = missing(soil, stage, run, before)
      high = 1.0_wp
      at_high = missing(soil, stage, run, point)
      last = 0
      if (abs(at_high) <= REVERSAL_TOLERANCE*abs(stage%amplitude)) return
      do i = 1, MAX_SEARCH
         share = low + (high - low)*at_low/max(at_low - at_high, tiny(at_low))
         if (.not. (share > low .and. share < high)) share = 0.5_wp*(low + high)
         point = before
         call advance(soil, run%plan, run%k, share, point, tally, fault)
         if (fault%code /= 0) return
         here = missing(soil, stage, run, point)
         if (abs(here) <= REVERSAL_TOLERANCE*abs(stage%amplitude)) exit
         if (here > 0.0_wp) then
            low = share
            at_low = here
            if (last == -1) at_high = 0.5_wp*at_high
            last = -1
         else
            high = share
            at_high = here
            if (last == 1) at_low = 0.5_wp*at_low
            last = 1
         end if
      end do
   end subroutine find_goal

   !> Effective stress whose total is constant in an undrained test: radial, vertical in simple shear [unit of stress].
   pure real(wp) function confining_stress(stage, point)
      type(test_stage_t), intent(in) :: stage
      type(point_t), intent(in) :: point

      confining_stress = 0.5_wp*sum(point%stress(RADIAL))
      if (shear_control(stage%control)) confining_stress = point%stress(AXIAL)
   end function confining_stress

   !> Finds the share of the stage that is done, for the progress report. [-]
   pure real(wp) function share_done(run)
      type(stage_run_t), intent(in) :: run

      share_done = real(run%way - 1, wp)
      if (.not. run%open) share_done = share_done + real(run%k, wp)/real(max(run%plan%increments, 1), wp)
      share_done = min(share_done/real(run%ways, wp), 1.0_wp)
   end function share_done

   !> True if a multiple of the interval lies after `before` and not after `now`, whichever way the lead goes.
   pure logical function passes(before, now, interval)
      real(wp), intent(in) :: before, now, interval
      real(wp) :: way

      way = sign(1.0_wp, now - before)
      passes = floored(way*now/interval + ON_GRID) > floored(way*before/interval + ON_GRID)
   contains
      !> The largest integer not above x, as a real: a count of tiny intervals has more digits than an integer.
      pure real(wp) function floored(x)
         real(wp), intent(in) :: x

         floored = x - modulo(x, 1.0_wp)
      end function floored
   end function passes
end module triax_stage_run
