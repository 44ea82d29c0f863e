! SPDX-License-Identifier: MIT
!> The error of an iteration, and whether it may end. The error of a field is |R_f| over the largest of |sum of the
!> magnitudes of the elements' contributions|, 1e-6 of its largest value in a step so far, and a floor, over the free
!> unknowns; a rigid body counts by itself too. Measured by change, what counts of the contributions to a displacement
!> is what the step changes: a weight that rests hides nothing. The floor of a volume balance is 1e-4 of the strain
!> rates and of the parts of the fluxes in it, that of momentum 1e-4 of the weight: where nothing flows, or a body
!> falls freely, the balance of every element is nothing but rounding.
!> docs/theory/host.md section 5.1.
module convergence
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use equation_assembly, only: assembly_t
   use prescribed_values, only: constraint_t
   use solution, only: solution_t, control_t, log_t, BY_FORCES, BY_RESIDUAL, BY_CORRECTION, BY_CHANGE, BY_STAGE
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_U_Z, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: measure, is_free, good_enough, field_scales, water_of, water_scale, body_scale, is_body, rounding_in
   public :: note_stagnation, measure_in, linear_tolerance, MOST_IN_VAIN, RATE_SHARE

   real(wp), parameter :: HISTORY_SHARE = 1.0e-6_wp   !< Share of the largest scale so far that still counts.
   !> Share of all forces that their sums leave, some hundred roundings. No tolerance of a change asks for less.
   real(wp), parameter :: ROUNDING_OF_SUMS = 1.0e-13_wp
   !> Share of all forces that their sums leave with inertia: accelerations are differences of displacements over dt**2,
   !> so that rounding leaves 4/(omega dt)**2 epsilon of a motion; this has room for three thousand steps a period.
   real(wp), parameter :: ROUNDING_OF_INERTIA = 1.0e-10_wp
   !> Share of Newton's tolerance that is left to the linear solution. What it leaves is noise in the strains: a
   !> material without an elastic domain takes noise for reversals and becomes stiffer (docs/theory/host.md section 6).
   real(wp), parameter :: LINEAR_SHARE = 1.0e-5_wp
   integer, parameter :: PATIENCE = 6          !< Iterations without progress after which the error stagnates.
   !> Iterations without progress after which no further one helps; measures that are not of the fields do not tell.
   integer, parameter :: MOST_IN_VAIN = 20
   real(wp), parameter :: PROGRESS = 0.5_wp    !< Share of the smallest error so far: more is no progress.
   real(wp), parameter :: MOST_KEPT = 0.9_wp   !< Share of a correction that the next one keeps: slower ones are not
                                               !< trusted.
   real(wp), parameter :: MOST_ROUGH = 1.0e-3_wp   !< Error above which no roughness is blamed for it.
   real(wp), parameter :: RATE_SHARE = 1.0e-4_wp      !< Share of strain rates and parts of fluxes that is a floor, see
                                                      !< above.
   real(wp), parameter :: NO_FORCE = 1.0e-150_wp   !< [kN] or [m3/s]: nothing is divided by zero.

contains
   !> Finds the measure of a stage: what BY_STAGE stands for. docs/theory/host.md section 5.1.
   pure integer function measure_in(given, inertia, touching) result(measure)
      integer, intent(in) :: given      !< BY_...
      logical, intent(in) :: inertia    !< The stage has accelerations.
      logical, intent(in) :: touching   !< Whether it has contacts.

      measure = given
      if (given == BY_STAGE) measure = merge(BY_FORCES, BY_CHANGE, inertia .and. touching)
   end function measure_in

   !> Below this share of all forces no tolerance of a change asks for more. [-] docs/theory/host.md section 5.1.
   pure real(wp) function rounding_in(inertia) result(share)
      logical, intent(in) :: inertia   !< The step has accelerations.

      share = merge(ROUNDING_OF_INERTIA, ROUNDING_OF_SUMS, inertia)
   end function rounding_in

   !> Errors of the fields that the linear solution may leave; 0 where another measure counts: as little as it can. [-]
   !> docs/theory/host.md section 6.
   pure real(wp) function linear_tolerance(control)
      type(control_t), intent(in) :: control

      linear_tolerance = 0.0_wp
      if (any(control%measure == [BY_FORCES, BY_CHANGE])) linear_tolerance = LINEAR_SHARE*control%tolerance
   end function linear_tolerance

   !> Whether the iteration may end. By the measure of the control: docs/theory/host.md section 5.1.
   pure logical function good_enough(control, log)
      type(control_t), intent(in) :: control
      type(log_t), intent(in) :: log

      select case (control%measure)
      case (BY_RESIDUAL)
         good_enough = log%reduction < control%tolerance .or. log%balanced
      case (BY_CORRECTION)
         good_enough = log%correction < control%tolerance .or. log%balanced
      case default
         good_enough = all(log%error < control%tolerance .or. hidden(control, log))
      end select
   end function good_enough

   !> Whether what further corrections would change of a pressure is hidden by the errors of the steps, as integrators
   !> of differential equations judge their iterations (Hairer & Wanner 1996, section IV.8): corrections that fall by a
   !> share s each add up to s/(1 - s) of the last one. Where air vanishes from pores, or comes back, the balance of air
   !> has a double root: corrections halve, and its forces vanish with it, so that the residual is never small beside
   !> them. It has to be small beside the water's: in dry soil large pressures hide changes that move much water.
   !> docs/theory/host.md section 5.1.
   pure function hidden(control, log)
      type(control_t), intent(in) :: control
      type(log_t), intent(in) :: log
      logical :: hidden(FIELDS)
      real(wp) :: share(FIELDS)

      hidden = control%negligible > 0.0_wp .and. log%before > 0.0_wp
      share = MOST_KEPT
      where (hidden) share = min(MOST_KEPT, log%changed/log%before)
      hidden = hidden .and. log%changed < log%before .and. log%changed*share/(1 - share) < control%negligible
      ! The balance of water has a scale of its own.
      hidden = hidden .and. log%water < control%tolerance
      hidden = hidden .and. log%error*log%scales < control%tolerance*maxval(log%scales(DISPLACEMENTS + 1:))
   end function hidden

   !> Whether the error has ceased to fall above the tolerance and below the roughness of the stress integration: the
   !> substeps of a point change with its strain, so that its stress is known to that tolerance and no better. Where a
   !> step changes little of the forces, that is much of the change.
   !> Updates the log. docs/theory/host.md section 5.1.
   pure subroutine note_stagnation(control, log)
      type(control_t), intent(in) :: control
      type(log_t), intent(inout) :: log
      real(wp) :: error

      if (all(control%measure /= [BY_FORCES, BY_CHANGE])) return
      error = maxval(log%error)
      log%since_best = log%since_best + 1
      if (error < PROGRESS*log%best_error) then
         log%best_error = error
         log%since_best = 0
      end if
      log%stagnated = log%since_best >= PATIENCE .and. &
                      error <= min(MOST_ROUGH, control%roughness*max(1.0_wp, log%forces_over_scale))
   end subroutine note_stagnation

   !> Finds the scales that the residuals of the fields are small against; rows of prescribed unknowns do not count.
   !> docs/theory/host.md section 5.1. Those of displacements are in [kN], of pressures in [m3/s].
   pure function field_scales(s, largest) result(scales)
      class(solution_t), intent(in) :: s
      real(wp), intent(in) :: largest(FIELDS)   !< Largest scale of every field so far.
      real(wp) :: scales(FIELDS)
      integer :: floor_of(s%dofs%n), i

      ! The rows of p_c hold the floor of the water.
      floor_of = [(merge(s%dofs%of(AT_P_W, s%dofs%node(i)), i, s%dofs%field(i) == AT_P_C), i=1, s%dofs%n)]
      scales = max(norms_of(s, measured_by(s%assembly)), max(HISTORY_SHARE, s%assembly%rounding_share)*largest, &
                   norms_of(s, RATE_SHARE*s%assembly%floor(floor_of)), NO_FORCE)
      scales(:DISPLACEMENTS) = max(scales(:DISPLACEMENTS), s%assembly%unresolved)
   end function field_scales

   !> Magnitudes that a step is measured by: those of its changes, or of all forces. (unknowns) [kN, m3/s]
   pure function measured_by(assembly) result(magnitudes)
      type(assembly_t), intent(in) :: assembly
      real(wp) :: magnitudes(size(assembly%scale))

      magnitudes = assembly%scale
      if (assembly%with_change) magnitudes = assembly%change
   end function measured_by

   !> Takes the water's part of volume balances, in rows of p_w: these less those of p_c, unless they are it.
   pure function water_of(dofs, air, rows) result(water)
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: air(:)       !< (nodes) The air pressure is prescribed.
      real(wp), intent(in) :: rows(:)     !< (unknowns) [m3/s]
      real(wp) :: water(size(rows))
      integer :: i, c

      water = 0.0_wp
      do i = 1, dofs%n
         if (dofs%field(i) /= AT_P_W) cycle
         c = dofs%of(AT_P_C, dofs%node(i))
         water(i) = rows(i)
         if (c > 0 .and. .not. air(dofs%node(i))) water(i) = rows(i) - rows(c)
      end do
   end function water_of

   !> Rows of p_w in which a balance of water is solved: where suction is prescribed the flow of air is not known.
   pure function has_water(s) result(has)
      class(solution_t), intent(in) :: s
      logical :: has(s%dofs%n)
      integer :: i, c

      has = s%dofs%field == AT_P_W .and. .not. s%constraint%fixed
      do i = 1, s%dofs%n
         if (.not. has(i) .or. s%constraint%air(s%dofs%node(i))) cycle
         c = s%dofs%of(AT_P_C, s%dofs%node(i))
         if (c > 0) has(i) = .not. s%constraint%fixed(c)
      end do
   end function has_water

   !> Finds the magnitude that the residual of the water is small against [m3/s]. A flow of air that is much larger has
   !> no part in it. docs/theory/host.md section 5.1.
   pure real(wp) function water_scale(s, largest) result(scale)
      class(solution_t), intent(in) :: s
      real(wp), intent(in) :: largest(FIELDS)   !< As of field_scales.
      real(wp) :: water, floor
      integer :: i, c

      water = 0.0_wp
      floor = 0.0_wp
      do i = 1, s%dofs%n
         if (s%dofs%field(i) /= AT_P_W .or. s%constraint%fixed(i)) cycle
         water = water + s%assembly%water(i)**2
         c = s%dofs%of(AT_P_C, s%dofs%node(i))
         floor = floor + (RATE_SHARE*s%assembly%floor(merge(c, i, c > 0)))**2
      end do
      scale = max(sqrt(water), sqrt(floor), HISTORY_SHARE*largest(AT_P_W), NO_FORCE)
   end function water_scale

   !> A rigid body that moves is measured by the forces on it: in the sum of its field it would be lost. i: an unknown.
   pure logical function is_body(constraint, i)
      type(constraint_t), intent(in) :: constraint
      integer, intent(in) :: i

      is_body = constraint%mass(i) > 0.0_wp .and. .not. constraint%fixed(i)
   end function is_body

   !> Finds the force [kN] that the residual of rigid body i is small against. docs/theory/host.md section 5.1. The
   !> unknowns of a body are measured by the largest force of them: their units are one, and what does not load one of
   !> them is in balance with what loads the others.
   pure real(wp) function body_scale(s, largest, i)
      class(solution_t), intent(in) :: s
      real(wp), intent(in) :: largest(FIELDS)   !< Largest scale of every field so far, as of field_scales.
      integer, intent(in) :: i

      associate (assembly => s%assembly, body => s%constraint%body)
         body_scale = max(maxval(measured_by(assembly), mask=body == body(i)), &
                          max(HISTORY_SHARE, assembly%rounding_share)*largest(AT_U_Z), NO_FORCE, assembly%unresolved)
      end associate
   end function body_scale

   !> Unknowns whose balance is solved: what holds a prescribed value, or air pressure, is no residual.
   pure function is_free(s) result(free)
      class(solution_t), intent(in) :: s
      logical :: free(s%dofs%n)

      associate (dofs => s%dofs, constraint => s%constraint)
         free = .not. (constraint%fixed .or. (dofs%field == AT_P_C .and. constraint%air(dofs%node)))
      end associate
   end function is_free

   !> Norms over the unknowns that are free, displacements together: a component without forces is no measure of its
   !> own.
   pure function norms_of(s, values) result(norms)
      class(solution_t), intent(in) :: s
      real(wp), intent(in) :: values(:)   !< (unknowns)
      real(wp) :: norms(FIELDS)
      logical :: free(s%dofs%n)
      integer :: i, f

      norms = 0.0_wp
      free = is_free(s)
      do i = 1, s%dofs%n
         f = s%dofs%field(i)
         if (free(i)) norms(f) = norms(f) + values(i)**2
      end do
      norms(:DISPLACEMENTS) = sum(norms(:DISPLACEMENTS))
      norms = sqrt(norms)
   end function norms_of

   !> Measures the errors of the fields: docs/theory/host.md section 5.1. The log gets them [-], the worst field and its
   !> worst unknown, and the forces.
   pure subroutine measure(s, rhs)
      class(solution_t), intent(inout) :: s
      real(wp), intent(in) :: rhs(:)   !< (unknowns) Residual [kN, m3/s].
      real(wp) :: most(FIELDS)
      integer :: i

      associate (log => s%log, rounding => s%system%rounding)
         ! Always the forces themselves: their rounding is the floor of what changes.
         log%forces = norms_of(s, s%assembly%scale)
         most = max(s%system%largest, log%forces)
         log%scales = max(field_scales(s, most), rounding)
         log%error = norms_of(s, rhs)/log%scales
         if (allocated(s%assembly%water)) then
            log%water = norm2(pack(water_of(s%dofs, s%constraint%air, rhs), has_water(s))) &
                        /max(water_scale(s, most), maxval(rounding(AT_P_W:)))
            log%error(AT_P_W) = max(log%error(AT_P_W), log%water)
         end if
         do i = 1, s%dofs%n
            if (is_body(s%constraint, i)) &
               log%error(AT_U_Z) = max(log%error(AT_U_Z), abs(rhs(i))/body_scale(s, most, i))
         end do
         log%worst_field = maxloc(log%error, 1)
         log%forces_over_scale = log%forces(log%worst_field)/log%scales(log%worst_field)
         log%worst_unknown = maxloc(abs(rhs), 1, s%dofs%field == log%worst_field .and. .not. s%constraint%fixed)
      end associate
   end subroutine measure
end module convergence
