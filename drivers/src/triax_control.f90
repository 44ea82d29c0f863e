!> Mixed control of a stage: given strains and held stresses, solved with the library's tangent blocks.
module triax_control
   use, intrinsic :: iso_fortran_env, only: wp => real64, output_unit
   use triax_fault, only: fault_t, raise, EXIT_RUN, EXIT_OUTPUT
   use triax_text, only: short, whole
   use triax_case, only: stage_t, CONTROL_NAMES, DRAINED, UNDRAINED, ISOTROPIC, OEDOMETER, CONSTANT_NET_STRESS, &
                         STRAIN_PATH
   use triax_point, only: soil_t, point_t, tangent_t, mud_report, update_point, save_update, update_sentence, &
      state_value, &
      slope_is_exact, &
                          axial_strain, volumetric_strain, radial_stress, mean_stress, deviator_stress, AXIAL, RADIAL
   implicit none (type, external)
   private
   public :: plan_t, tally_t, plan_stage, advance, lead, excess_pressure, CONTROL_TOLERANCE

   !> Held stresses are met to this, relative to the effective stress held: a hundred thousand times below the
   !> library's own default tolerance, and far above rounding (1e-16 times the ratio of stiffness to stress, about 1e3).
   real(wp), parameter :: CONTROL_TOLERANCE = 1.0e-10_wp
   !> A quasi-Newton step gains a digit or more, 10 are usual; Newton steps with the consistent tangent need 2 to 4.
   integer, parameter :: MAX_ITERATIONS = 40
   integer, parameter :: MAX_CUTS = 20         !< An increment is halved at most so often: a millionth.

   !> A stage that is being run.
   type :: plan_t
      integer :: control = 0
      integer :: increments = 0
      real(wp) :: lead_start = 0.0_wp, lead_change = 0.0_wp
      real(wp) :: strain_start(6) = 0.0_wp, strain_change(6) = 0.0_wp
      real(wp) :: suction_start = 0.0_wp, suction_change = 0.0_wp
      logical :: held(6) = .false.           !< Net stress is held, strain is free.
      real(wp) :: net_stress(6) = 0.0_wp     !< What is held [kPa].
      real(wp) :: rate(6) = 0.0_wp           !< Free strains of the last increment, per increment.
      real(wp) :: radial_start = 0.0_wp      !< Effective radial stress at the start [kPa].
      real(wp) :: pressure_start = 0.0_wp    !< Excess pore pressure at the start [kPa].
      logical :: sealed = .false.            !< Undrained and saturated: pore pressure is what changes.
   end type plan_t

   !> What a run cost.
   type :: tally_t
      integer :: updates = 0                 !< Calls of the library.
      integer :: solved = 0                  !< Increments with a held stress.
      integer :: cuts = 0                    !< Increments cut and retried.
      logical :: residuals = .false.         !< Print the error of every iteration.
      character(256) :: save_to = ''         !< File for the first update that the library refuses; blank: none.
      logical :: saved = .false.
      integer :: n_floor = 0, n_cap_d = 0, n_cap_h = 0, n_hysteresis = 0, n_iso_kept = 0, n_no_root = 0, &
                 n_min_step = 0, n_open = 0, n_tensile = 0
      real(wp) :: error = 0.0_wp             !< Largest error of a held stress since the caller set it to 0, relative.
      real(wp) :: worst = 0.0_wp             !< The same, of the whole run.
   end type tally_t

contains
   !> Lays out a stage from where the sample is.
   subroutine plan_stage(soil, stage, point, pressure, plan)
      type(soil_t), intent(in) :: soil
      type(stage_t), intent(in) :: stage
      type(point_t), intent(in) :: point
      real(wp), intent(in) :: pressure   !< Excess pore pressure so far [kPa].
      type(plan_t), intent(out) :: plan

      plan%control = stage%control
      plan%strain_start = point%strain
      plan%suction_start = point%suction
      if (stage%moves_suction) plan%suction_change = stage%suction_end - point%suction
      plan%radial_start = radial_stress(point)
      plan%pressure_start = pressure
      select case (stage%control)
      case (DRAINED)
         plan%held(RADIAL) = .true.
         call lead_from(axial_strain(point))
         plan%strain_change(AXIAL) = plan%lead_change
      case (UNDRAINED)
         call lead_from(axial_strain(point))
         plan%strain_change(AXIAL) = plan%lead_change
         plan%strain_change(RADIAL) = -0.5_wp*plan%lead_change
         plan%sealed = max(point%suction, point%suction + plan%suction_change) <= 0.0_wp
      case (ISOTROPIC)
         call lead_from(volumetric_strain(point))
         plan%strain_change(1:3) = plan%lead_change/3.0_wp
      case (OEDOMETER)
         call lead_from(volumetric_strain(point))
         plan%strain_change(AXIAL) = plan%lead_change
      case (CONSTANT_NET_STRESS)
         plan%held = .true.
         call lead_from(point%suction)
      case (STRAIN_PATH)
         plan%strain_change = stage%strain_change
         plan%lead_change = maxval(abs(stage%strain_change))
      end select
      plan%net_stress = point%stress - bishop(soil, point)
      plan%increments = ceiling(abs(plan%lead_change)/stage%increment*(1.0_wp - 1.0e-9_wp))
   contains
      subroutine lead_from(start)
         real(wp), intent(in) :: start

         plan%lead_start = start
         plan%lead_change = stage%target - start
      end subroutine lead_from
   end subroutine plan_stage

   !> The variable that leads a stage, after increment k: axial strain, volumetric strain, suction, largest strain.
   pure real(wp) function lead(plan, k)
      type(plan_t), intent(in) :: plan
      integer, intent(in) :: k

      lead = plan%lead_start + plan%lead_change*real(k, wp)/real(max(plan%increments, 1), wp)
   end function lead

   !> Excess pore pressure under constant total radial stress [kPa]; it stays where a stage is not sealed.
   pure real(wp) function excess_pressure(plan, point)
      type(plan_t), intent(in) :: plan
      type(point_t), intent(in) :: point

      excess_pressure = plan%pressure_start
      if (plan%sealed) excess_pressure = plan%pressure_start + plan%radial_start - radial_stress(point)
   end function excess_pressure

   !> Increment k of a stage. A part that fails is halved and retried, and the next ones grow again.
   subroutine advance(soil, plan, k, point, tally, fault)
      type(soil_t), intent(in) :: soil
      type(plan_t), intent(inout) :: plan
      integer, intent(in) :: k
      type(point_t), intent(inout) :: point
      type(tally_t), intent(inout) :: tally
      type(fault_t), intent(inout) :: fault
      type(fault_t) :: trouble
      real(wp) :: done, share

      done = 0.0_wp
      share = 1.0_wp
      do while (done < 1.0_wp)
         trouble = fault_t()
         call solve_part(soil, plan, k, done, share, point, tally, trouble)
         if (trouble%code == 0) then
            done = done + share
            share = min(2.0_wp*share, 1.0_wp - done)
         else if (trouble%code == EXIT_OUTPUT) then
            fault = trouble
            return
         else
            tally%cuts = tally%cuts + 1
            share = 0.5_wp*share
            if (share < 0.5_wp**MAX_CUTS) then
               call raise(fault, EXIT_RUN, trim(CONTROL_NAMES(plan%control))//' stage, increment '//whole(k)//' of '// &
                          whole(plan%increments)//', at eps_a '//short(axial_strain(point))//', eps_v '// &
                          short(volumetric_strain(point))//', p'' '//short(mean_stress(point))//' kPa, q '// &
                          short(deviator_stress(point))//' kPa, suction '//short(point%suction)// &
                          ' kPa; the increment was halved '//whole(MAX_CUTS)//' times. '//trim(trouble%text))
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
      type(mud_report) :: report
      real(wp) :: progress, strain(6), suction, residual(6), last_residual(6), slope(6, 6), step(6), error, scale
      integer :: iteration
      logical :: good

      progress = (real(k - 1, wp) + done + share)/real(plan%increments, wp)
      if (done + share >= 1.0_wp) progress = real(k, wp)/real(plan%increments, wp)
      strain = plan%strain_start + plan%strain_change*progress - point%strain
      suction = plan%suction_start + plan%suction_change*progress - point%suction
      where (plan%held) strain = plan%rate*share
      slope = 0.0_wp
      last_residual = 0.0_wp
      step = 0.0_wp

      do iteration = 1, MAX_ITERATIONS
         call update_point(soil, point, strain, suction, after, tangent, report)
         tally%updates = tally%updates + 1
         if (report%status /= 0) then
            call raise(fault, EXIT_RUN, update_sentence(report))
            if (len_trim(tally%save_to) > 0 .and. .not. tally%saved) then
               tally%saved = .true.
               call save_update(tally%save_to, 'mud_triax, '//trim(CONTROL_NAMES(plan%control))// &
                                ' stage, increment '//whole(k)//' of '//whole(plan%increments), soil, point, strain, &
                                suction, fault)
            end if
            plan%rate = 0.0_wp
            return
         end if
         if (.not. any(plan%held)) exit
         residual = merge(after%stress - plan%net_stress - bishop(soil, after), 0.0_wp, plan%held)
         scale = max(maxval(abs(after%stress), mask=plan%held .and. [1, 2, 3, 4, 5, 6] <= 3), tiny(scale))
         error = maxval(abs(residual))/scale
         if (tally%residuals) write (output_unit, '(i0, a, i0, a, es10.3)') k, ',', iteration, ',', error
         if (error <= CONTROL_TOLERANCE) exit
         if (iteration == 1 .or. slope_is_exact(soil)) then
            slope = held_slope(plan, tangent, after%suction)
         else
            slope = slope + outer(residual - last_residual - matmul(slope, step), step)/dot_product(step, step)
         end if
         call solve(slope, -residual, step, good)
         if (.not. good) then
            call raise(fault, EXIT_RUN, 'The slope of the held stresses is singular; the sample cannot be held.')
            plan%rate = 0.0_wp
            return
         end if
         last_residual = residual
         strain = strain + step
      end do

      if (any(plan%held)) then
         if (iteration > MAX_ITERATIONS) then
            call raise(fault, EXIT_RUN, 'The held stress is off by '//short(error)//' of its value after '// &
                       whole(MAX_ITERATIONS)//' iterations; allowed is '//short(CONTROL_TOLERANCE)// &
                       '. A smaller increment may help, unless the sample cannot carry what is held any more.')
            plan%rate = 0.0_wp
            return
         end if
         tally%solved = tally%solved + 1
         tally%error = max(tally%error, error)
         tally%worst = max(tally%worst, error)
         plan%rate = merge(strain/share, 0.0_wp, plan%held)
      end if
      ! Given strains and suction land on their values exactly instead of adding up roundings.
      where (.not. plan%held) after%strain = plan%strain_start + plan%strain_change*progress
      after%suction = plan%suction_start + plan%suction_change*progress
      point = after
      call count_guards(report, tally)
   end subroutine solve_part

   !> Share of suction in the effective stress, S_w p_c on the normal components.
   pure function bishop(soil, point) result(stress)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      real(wp) :: stress(6)

      stress = 0.0_wp
      stress(1:3) = state_value(point, soil%i_saturation)*point%suction
   end function bishop

   !> Slope of the net stresses that are held by the strains that are free; an identity elsewhere.
   pure function held_slope(plan, tangent, suction) result(slope)
      type(plan_t), intent(in) :: plan
      type(tangent_t), intent(in) :: tangent
      real(wp), intent(in) :: suction
      real(wp) :: slope(6, 6)
      integer :: i, j

      slope = 0.0_wp
      do j = 1, 6
         do i = 1, 6
            if (plan%held(i) .and. plan%held(j)) then
               slope(i, j) = tangent%dsig_deps(i, j)
               if (i <= 3) slope(i, j) = slope(i, j) - suction*tangent%dsw_deps(j)
            else if (i == j) then
               slope(i, j) = 1.0_wp
            end if
         end do
      end do
   end function held_slope

   pure function outer(a, b) result(product)
      real(wp), intent(in) :: a(6), b(6)
      real(wp) :: product(6, 6)
      integer :: j

      do j = 1, 6
         product(:, j) = a*b(j)
      end do
   end function outer

   !> Gauss elimination with column pivots; `good` is false for a singular matrix.
   pure subroutine solve(matrix, right, x, good)
      real(wp), intent(in) :: matrix(6, 6), right(6)
      real(wp), intent(out) :: x(6)
      logical, intent(out) :: good
      real(wp) :: a(6, 7), row(7)
      integer :: i, j, pivot

      a(:, :6) = matrix
      a(:, 7) = right
      x = 0.0_wp
      do j = 1, 6
         pivot = j - 1 + maxloc(abs(a(j:, j)), dim=1)
         good = abs(a(pivot, j)) > epsilon(1.0_wp)*maxval(abs(matrix))
         if (.not. good) return
         row = a(pivot, :)
         a(pivot, :) = a(j, :)
         a(j, :) = row/row(j)
         do i = j + 1, 6
            a(i, :) = a(i, :) - a(i, j)*a(j, :)
         end do
      end do
      do i = 6, 1, -1
         x(i) = a(i, 7) - dot_product(a(i, i + 1:6), x(i + 1:))
      end do
   end subroutine solve

   subroutine count_guards(report, tally)
      type(mud_report), intent(in) :: report
      type(tally_t), intent(inout) :: tally

      tally%n_floor = tally%n_floor + report%n_floor
      tally%n_cap_d = tally%n_cap_d + report%n_cap_d
      tally%n_cap_h = tally%n_cap_h + report%n_cap_h
      tally%n_hysteresis = tally%n_hysteresis + report%n_hysteresis
      tally%n_iso_kept = tally%n_iso_kept + report%n_iso_kept
      tally%n_no_root = tally%n_no_root + report%n_no_root
      tally%n_min_step = tally%n_min_step + report%n_min_step
      tally%n_open = tally%n_open + report%n_open
      tally%n_tensile = tally%n_tensile + report%n_tensile
   end subroutine count_guards
end module triax_control
