! SPDX-License-Identifier: MIT
!> Mixed control: six linear constraints on strain and stress and one on suction, solved increment by increment with the
!> library's tangent blocks. An increment that fails is cut and retried.
module triax_control
   use, intrinsic :: iso_fortran_env, only: wp => real64, output_unit
   use faults, only: fault_t, raise, EXIT_RUN, EXIT_OUTPUT
   use texts, only: short, whole
   use dense, only: solve, outer
   use triax_air, only: closed_air_t, air_now_t, closing, air_of
   use triax_stage, only: test_stage_t, quantity_rows, CONTROL_NAMES, ROWS, BY_SUCTION, BY_D_EPS, BY_D_SIGMA, BY_CHANGES
   use material_point, only: MOST_GUARDS, batch_report_t
   use triax_point, only: soil_t, point_t, tangent_t, update_point, save_update, update_sentence, void_ratio, &
                          saturation, volumetric_strain, mean_stress, deviator_stress, AXIAL
   implicit none (type, external)
   private
   public :: plan_t, tally_t, plan_path, advance, lead, quantity, CONTROL_TOLERANCE

   !> Constraints are met to this unless a case says otherwise, relative to the effective stress they prescribe: a
   !> hundred thousand times below the library's own default tolerance, and far above rounding (1e-16 times the ratio
   !> of stiffness to stress, about 1e3).
   real(wp), parameter :: CONTROL_TOLERANCE = 1.0e-10_wp
   !> A quasi-Newton step gains a digit or more, 10 are usual; Newton steps with the consistent tangent need 2 to 4.
   integer, parameter :: MAX_ITERATIONS = 40
   integer, parameter :: MAX_CUTS = 20         !< An increment is halved at most so often: a millionth.
   !> A strain itself is rounded: an increment below this share of it cannot be met to the tolerance.
   real(wp), parameter :: ROUNDING = 10.0_wp*epsilon(1.0_wp)/CONTROL_TOLERANCE
   integer, parameter :: REFUSAL_LENGTH = 1000
   real(wp), parameter :: STAYS = 1.0e-6_wp    !< Share of an increment: less is no motion of what leads.
   integer, parameter :: SUCTION = 7           !< Place of suction among the unknowns, after the six strains.
   integer, parameter :: NORMAL = 3            !< Components up to this are normal ones.
   real(wp), parameter :: IDENTITY(6) = [1.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]

   !> One path segment: from the present state of the sample to the target of the constraints, in equal increments.
   type :: plan_t
      type(test_stage_t) :: stage                 !< The last of its changes is that of what leads.
      integer :: increments = 0                   !< An open way has 1, and goes on beyond it.
      real(wp) :: lead_start = 0.0_wp, lead_change = 0.0_wp
      real(wp) :: interval = 0.0_wp               !< Interval of the rows, in the unit of what leads.
      logical :: by_suction = .false.             !< The suction moves alone and makes the increments.
      type(closed_air_t) :: closed                !< Where the air is kept.
      real(wp) :: strain_start(6) = 0.0_wp, stress_start(6) = 0.0_wp, suction_start = 0.0_wp, water_start = 0.0_wp
      logical :: given(7) = .false.               !< Strains, and suction, that the constraints give directly.
      real(wp) :: given_change(7) = 0.0_wp
      real(wp) :: rate(7) = 0.0_wp                !< Unknowns of the last increment, per increment.
   end type plan_t

   !> Cost of a run, with what limits and keeps it.
   type :: tally_t
      integer :: updates = 0                 !< Calls of the library.
      integer :: max_updates = huge(0)       !< The test stops after so many.
      integer :: increments = 0              !< Number of increments of all stages.
      integer :: reversals = 0               !< Most turns of an effective stress while the volume is free.
      integer :: solved = 0                  !< Increments that needed a solution.
      integer :: cuts = 0                    !< Increments cut and retried.
      real(wp) :: tolerance = CONTROL_TOLERANCE   !< Tolerance of what is held, relative.
      logical :: residuals = .false.         !< Print the error of every iteration.
      character(256) :: save_to = ''         !< File for the first update that the library refuses; blank: none.
      logical :: saved = .false.
      character(REFUSAL_LENGTH) :: refusal = ''   !< Message of the law about the first update that it refused.
      real(wp) :: least_pressure = huge(1.0_wp)   !< Smallest p' after an increment, of the unit of the law.
      integer :: guards(MOST_GUARDS) = 0     !< Number of times that each guard of the law acted.
      real(wp) :: error = 0.0_wp             !< Largest error of a constraint since the caller set it to 0, relative.
      real(wp) :: worst = 0.0_wp             !< Largest error of a constraint in the whole run, relative.
   end type tally_t

contains
   !> Plans a path segment of a stage from the present state of the sample. Constraints: see triax_stage.
   subroutine plan_path(soil, stage, target, point, plan)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      real(wp), intent(in) :: target   !< Value of what leads, at the end. [-] or [unit of stress of the law].
      type(point_t), intent(in) :: point
      type(plan_t), intent(out) :: plan
      real(wp) :: strain(6)
      integer :: i
      logical :: good

      plan%stage = stage
      if (stage%keeps_air) plan%closed = closing(soil%air, void_ratio(soil, point), saturation(soil, point), &
                                                 point%p_a, point%suction)
      plan%strain_start = point%strain
      plan%suction_start = point%suction
      plan%stress_start = controlled_stress(soil, stage, point)
      plan%water_start = water(soil, point)
      if (stage%moves_suction) plan%given_change(SUCTION) = stage%suction_end - point%suction
      if (stage%by_change) plan%given_change(SUCTION) = stage%suction_change
      select case (stage%lead)
      case (BY_SUCTION)
         plan%lead_start = point%suction
         plan%lead_change = plan%given_change(SUCTION)
      case (BY_D_EPS, BY_D_SIGMA)
         plan%lead_change = maxval(abs(stage%changes))
      case (BY_CHANGES)
         plan%lead_change = 1.0_wp
      case default
         plan%lead_start = quantity(soil, stage, stage%lead, point)
         plan%lead_change = target - plan%lead_start
         plan%stage%changes(ROWS) = plan%lead_change
      end select
      plan%increments = stage%parts*equal_parts(plan%lead_change, stage%increment)
      plan%interval = stage%interval

      plan%given(SUCTION) = .not. stage%keeps_water
      ! Wetting under a constant load: what leads stays, or moves by less than a default increment, and suction decides.
      if (abs(plan%given_change(SUCTION)) > 0.0_wp .and. (abs(plan%lead_change) <= STAYS*stage%increment .or. &
          plan%increments <= stage%parts .and. .not. stage%given_increment)) then
         plan%by_suction = .true.
         plan%lead_start = point%suction
         plan%lead_change = plan%given_change(SUCTION)
         plan%increments = max(plan%increments, &
                               stage%parts*equal_parts(plan%lead_change, stage%suction_increment))
         plan%interval = stage%suction_interval
      end if
      ! A constraint on one strain gives it, and six on strains alone give all.
      do i = 1, ROWS
         if (any(abs(stage%stress_rows(:, i)) > 0.0_wp) .or. count(abs(stage%strain_rows(:, i)) > 0.0_wp) /= 1) cycle
         where (abs(stage%strain_rows(:, i)) > 0.0_wp)
            plan%given(:6) = .true.
            plan%given_change(:6) = plan%stage%changes(i)/stage%strain_rows(:, i)
         end where
      end do
      if (all(abs(stage%stress_rows) <= 0.0_wp)) then
         call solve(transpose(stage%strain_rows), plan%stage%changes, strain, good)
         if (good) plan%given(:6) = .true.
         if (good) plan%given_change(:6) = strain
      end if
   end subroutine plan_path

   !> Equal parts of a change, none larger than an increment but for rounding.
   pure integer function equal_parts(change, increment)
      real(wp), intent(in) :: change, increment   !< In one unit; the increment > 0.

      equal_parts = ceiling(abs(change)/increment*(1.0_wp - 1.0e-9_wp))
   end function equal_parts

   !> The variable that leads a stage, after increment k: by value, or the share of a change. [-] or [unit of stress of
   !> the law].
   pure real(wp) function lead(plan, k)
      type(plan_t), intent(in) :: plan
      integer, intent(in) :: k   !< Number of the increment.

      lead = plan%lead_start + plan%lead_change*real(k, wp)/real(max(plan%increments, 1), wp)
   end function lead

   !> Present value of a quantity that can lead a stage, stress as the stage means it. [-] or [unit of stress of the
   !> law], compression positive.
   pure real(wp) function quantity(soil, stage, which, point)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      integer, intent(in) :: which   !< BY_*
      type(point_t), intent(in) :: point
      real(wp) :: strain_row(6), stress_row(6)

      call quantity_rows(which, strain_row, stress_row)
      quantity = dot_product(strain_row, point%strain) + dot_product(stress_row, controlled_stress(soil, stage, point))
   end function quantity

   !> Increment k of a way, or the part of it up to `upto`. A part that fails is halved and retried, and the next ones
   !> grow again. By Newton iterations, where the law has no exact tangent by those of Broyden (1965). Fault EXIT_RUN:
   !> max_updates are done, or a part was halved MAX_CUTS times, with what the law or the control says of it;
   !> EXIT_OUTPUT: the update that was refused cannot be saved.
   subroutine advance(soil, plan, k, upto, point, tally, fault)
      type(soil_t), intent(in) :: soil
      type(plan_t), intent(inout) :: plan
      integer, intent(in) :: k
      real(wp), intent(in) :: upto   !< 1: the whole increment.
      type(point_t), intent(inout) :: point
      type(tally_t), intent(inout) :: tally
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: trouble
      character(:), allocatable :: name
      real(wp) :: done, share

      done = 0.0_wp
      share = upto
      do while (done < upto)
         if (tally%updates >= tally%max_updates) then
            call raise(fault, EXIT_RUN, trim(CONTROL_NAMES(plan%stage%control))//' stage, at eps_a '// &
                       short(point%strain(AXIAL))//': '//whole(tally%updates)// &
                       ' updates of the material are done, and max_updates of &case allows '// &
                       whole(tally%max_updates)//'.')
            return
         end if
         trouble = fault_t()
         call solve_part(soil, plan, k, done, share, point, tally, trouble)
         if (trouble%code == 0) then
            done = done + share
            share = min(2.0_wp*share, upto - done)
         else if (trouble%code == EXIT_OUTPUT) then
            fault = trouble
            return
         else
            plan%rate = 0.0_wp
            tally%cuts = tally%cuts + 1
            share = 0.5_wp*share
            if (share < upto*0.5_wp**MAX_CUTS) then
               name = ' '//trim(soil%law%unit%name)
               call raise(fault, EXIT_RUN, trim(CONTROL_NAMES(plan%stage%control))//' stage, increment '//whole(k)// &
                          ' of '//whole(plan%increments)//', at eps_a '//short(point%strain(AXIAL))//', eps_v '// &
                          short(volumetric_strain(point))//', p'' '//short(mean_stress(point))//name//', q '// &
                          short(deviator_stress(point))//name//', suction '//short(point%suction)//name// &
                          '; the increment was halved '//whole(MAX_CUTS)//' times. '//trim(trouble%text))
               return
            end if
         end if
      end do
   end subroutine advance

   !> The part from `done` to `done + share` of increment k.
   subroutine solve_part(soil, plan, k, done, share, point, tally, fault)
      type(soil_t), intent(in) :: soil
      type(plan_t), intent(inout) :: plan
      integer, intent(in) :: k
      real(wp), intent(in) :: done, share
      type(point_t), intent(inout) :: point
      type(tally_t), intent(inout) :: tally
      type(fault_t), intent(inout) :: fault
      type(point_t) :: after
      type(tangent_t) :: tangent
      type(batch_report_t) :: report
      real(wp) :: progress, x(7), residual(7), last_residual(7), slope(7, 7), step(7), error, stiffness
      integer :: iteration
      logical :: good

      progress = (real(k - 1, wp) + done + share)/real(plan%increments, wp)
      if (done + share >= 1.0_wp) progress = real(k, wp)/real(plan%increments, wp)
      x = plan%rate*share
      where (plan%given(:6)) x(:6) = plan%strain_start + plan%given_change(:6)*progress - point%strain
      ! In this order the first increment of a saved update has every bit of its change.
      if (plan%given(SUCTION)) x(SUCTION) = plan%given_change(SUCTION)*progress - (point%suction - plan%suction_start)
      slope = 0.0_wp
      last_residual = 0.0_wp
      step = 0.0_wp
      stiffness = 1.0_wp

      do iteration = 1, MAX_ITERATIONS
         call update_point(soil, point, x(:6), x(SUCTION), after, tangent, report)
         tally%updates = tally%updates + 1
         if (report%code /= 0) then
            call raise(fault, EXIT_RUN, update_sentence(soil, report))
            if (tally%refusal == '') tally%refusal = fault%text
            if (len_trim(tally%save_to) > 0 .and. .not. tally%saved) then
               tally%saved = .true.
               call save_update(tally%save_to, 'mud_triax, '//trim(CONTROL_NAMES(plan%stage%control))// &
                                ' stage, increment '//whole(k)//' of '//whole(plan%increments), soil, point, x(:6), &
                                x(SUCTION), fault)
            end if
            return
         end if
         if (plan%stage%keeps_air) call close_air(soil, plan, after, fault)
         if (fault%code /= 0) return
         if (all(plan%given)) exit
         call find_residual(soil, plan, progress, x, point, after, residual, error)
         if (tally%residuals) write (output_unit, '(i0, a, i0, a, es10.3)') k, ',', iteration, ',', error
         if (error <= tally%tolerance) exit
         ! In the slope suction is counted in strains: a stress over a stiffness.
         if (iteration == 1 .or. soil%law%exact_tangent) then
            stiffness = max(maxval(abs(tangent%dsig_deps)), tiny(stiffness)**0.5_wp)
            slope = slope_of(soil, plan, tangent, after)
            slope(:, SUCTION) = slope(:, SUCTION)*stiffness
         else
            slope = slope + outer(residual - last_residual - matmul(slope, step), step)/dot_product(step, step)
         end if
         call solve(slope, -residual, step, good)
         if (.not. good) then
            call raise(fault, EXIT_RUN, 'The stiffness for the prescribed stresses is singular: the sample cannot '// &
                       'carry them'//trim(merge(', perhaps because it became saturated at constant water content.', &
                                                '.                                                               ', &
                                                plan%stage%keeps_water)))
            return
         end if
         last_residual = residual
         x(:6) = x(:6) + step(:6)
         x(SUCTION) = x(SUCTION) + step(SUCTION)*stiffness
      end do

      if (.not. all(plan%given)) then
         if (iteration > MAX_ITERATIONS) then
            call raise(fault, EXIT_RUN, 'The prescribed stresses are missed by '//short(error)//' of their value '// &
                       'after '//whole(MAX_ITERATIONS)//' iterations; allowed is '//short(tally%tolerance)// &
                       '. A smaller increment may help, unless the sample cannot carry these stresses any more.')
            return
         end if
         tally%solved = tally%solved + 1
         tally%error = max(tally%error, error)
         tally%worst = max(tally%worst, error)
         plan%rate = x/share
      end if
      ! Given strains and suction land on their values exactly instead of adding up roundings.
      where (plan%given(:6)) after%strain = plan%strain_start + plan%given_change(:6)*progress
      if (plan%given(SUCTION)) after%suction = plan%suction_start + plan%given_change(SUCTION)*progress
      point = after
      tally%least_pressure = min(tally%least_pressure, mean_stress(point))
      tally%guards = tally%guards + report%guards
   end subroutine solve_part

   !> Residuals of the constraints, and the largest one relative to the quantity that its constraint prescribes.
   subroutine find_residual(soil, plan, progress, x, before, after, residual, error)
      type(soil_t), intent(in) :: soil
      type(plan_t), intent(in) :: plan
      real(wp), intent(in) :: progress, x(7)
      type(point_t), intent(in) :: before, after
      real(wp), intent(out) :: residual(7), error
      real(wp) :: stress_moved(6), size_of(6), strain_left, scale
      integer :: i

      stress_moved = controlled_stress(soil, plan%stage, after) - plan%stress_start
      size_of = maxval(abs(after%stress(:NORMAL)))
      size_of(:NORMAL) = abs(after%stress(:NORMAL))
      error = 0.0_wp
      do i = 1, ROWS
         ! What strain still has to do is counted from the increment: a difference of large strains would round.
         strain_left = dot_product(plan%stage%strain_rows(:, i), x(:6) - (plan%strain_start - before%strain))
         residual(i) = strain_left + dot_product(plan%stage%stress_rows(:, i), stress_moved) &
                       - plan%stage%changes(i)*progress
         scale = sum(abs(plan%stage%stress_rows(:, i))*size_of) + sum(abs(plan%stage%strain_rows(:, i)))* &
                 max(maxval(abs(x(:6))), ROUNDING*maxval(abs(after%strain)))
         error = max(error, abs(residual(i))/max(scale, tiny(scale)))
      end do
      if (plan%stage%keeps_water) then
         residual(SUCTION) = water(soil, after) - water_kept(soil, plan, after)
         error = max(error, abs(residual(SUCTION))/plan%water_start)
      else
         residual(SUCTION) = 0.0_wp
      end if
   end subroutine find_residual

   !> Derivatives of the constraints by the six strains and suction; row i: constraint i.
   function slope_of(soil, plan, tangent, point) result(slope)
      type(soil_t), intent(in) :: soil
      type(plan_t), intent(in) :: plan
      type(tangent_t), intent(in) :: tangent
      type(point_t), intent(in) :: point
      real(wp) :: slope(7, 7)
      real(wp) :: by_strain(6, 6), by_suction(6), e, s_w
      type(air_now_t) :: air

      e = void_ratio(soil, point)
      s_w = saturation(soil, point)
      by_strain = tangent%dsig_deps
      by_suction = tangent%dsig_dpc
      if (.not. plan%stage%effective) then
         by_strain = by_strain - point%suction*outer(IDENTITY, tangent%dsw_deps)
         by_suction = by_suction - (s_w + point%suction*tangent%dsw_dpc)*IDENTITY
      end if
      air = air_now_t(0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp)
      if (plan%stage%keeps_air) air = air_of(plan%closed, e, point%suction)
      if (plan%stage%keeps_air .and. .not. plan%stage%effective) then
         by_strain = by_strain - air%by_e*(1.0_wp + e)*outer(IDENTITY, IDENTITY)
         by_suction = by_suction + air%by_suction*IDENTITY
      end if
      slope(:6, :6) = transpose(plan%stage%strain_rows) + matmul(transpose(plan%stage%stress_rows), by_strain)
      slope(:6, SUCTION) = matmul(transpose(plan%stage%stress_rows), by_suction)
      slope(SUCTION, :) = 0.0_wp
      slope(SUCTION, SUCTION) = 1.0_wp
      if (plan%stage%keeps_water) then
         ! de = -(1+e) d eps_v
         slope(SUCTION, :6) = e*tangent%dsw_deps - (s_w - air%water_by_e)*(1.0_wp + e)*IDENTITY
         slope(SUCTION, SUCTION) = e*tangent%dsw_dpc - air%water_by_suction
      end if
   end function slope_of

   !> The pressure of the air of a sample that keeps it. Fault EXIT_RUN: all of it is dissolved, or there is no room.
   subroutine close_air(soil, plan, point, fault)
      type(soil_t), intent(in) :: soil
      type(plan_t), intent(in) :: plan
      type(point_t), intent(inout) :: point
      type(fault_t), intent(inout) :: fault
      type(air_now_t) :: air
      real(wp) :: e

      e = void_ratio(soil, point)
      air = air_of(plan%closed, e, point%suction)
      point%p_a = air%p_a
      if (point%p_a > -soil%air%atmosphere .and. e > air%water) return
      call raise(fault, EXIT_RUN, 'At a void ratio of '//short(e)//' the water, '//short(air%water)// &
                 ' times the solids, fills the pores: no air is left as bubbles. Go on with a '// &
                 'saturated sample (suction 0, control undrained).')
   end subroutine close_air

   !> The water that a sample keeps, per volume of solids: less under pressure, where it is compressible [-].
   pure real(wp) function water_kept(soil, plan, point) result(w)
      type(soil_t), intent(in) :: soil
      type(plan_t), intent(in) :: plan
      type(point_t), intent(in) :: point
      type(air_now_t) :: air

      w = plan%water_start
      if (.not. plan%stage%keeps_air) return
      air = air_of(plan%closed, void_ratio(soil, point), point%suction)
      w = air%water
   end function water_kept

   !> The stress that a stage prescribes: net, sigma' - S_w p_c on the normal components, total where the air is kept,
   !> or effective [unit of stress].
   pure function controlled_stress(soil, stage, point) result(stress)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stage
      type(point_t), intent(in) :: point
      real(wp) :: stress(6)

      stress = point%stress
      if (stage%effective) return
      stress = stress - saturation(soil, point)*point%suction*IDENTITY
      if (stage%keeps_air) stress = stress + point%p_a*IDENTITY
   end function controlled_stress

   !> Volume of water per volume of solids, S_w e [-].
   pure real(wp) function water(soil, point)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point

      water = saturation(soil, point)*void_ratio(soil, point)
   end function water
end module triax_control
