! SPDX-License-Identifier: MIT
!> Columns of the results: what they are called, what they mean, and their values at a point.
module triax_columns
   use kinds, only: wp
   use material_point, only: state_index
   use triax_stage, only: test_stage_t, general_control
   use triax_stage_run, only: stage_run_t
   use triax_point, only: soil_t, point_t, void_ratio, saturation, state_value, mean_stress, deviator_stress, &
                          radial_stress, volumetric_strain, AXIAL, RADIAL
   implicit none (type, external)
   private
   public :: column_t, COLUMNS, columns_shown, values_of

   !> A column of the results.
   type :: column_t
      character(16) :: name
      character(8) :: unit
      character(120) :: meaning
      logical :: whole = .false.   !< Counts.
   end type column_t

   integer, parameter :: PLAIN = 22   !< Columns of every table; the others are components of tensors.
   type(column_t), parameter :: COLUMNS(*) = [ &
      column_t('eps_a', '1', 'axial strain, natural'), &
      column_t('eps_v', '1', 'volumetric strain, natural'), &
      column_t('p_eff', 'kPa', 'mean effective stress'), &
      column_t('q', 'kPa', 'sigma_a - sigma_r, negative in extension'), &
      column_t('e', '1', 'void ratio'), &
      column_t('s_w', '1', 'degree of saturation'), &
      column_t('n_substep', '1', 'accepted substeps since the start', .true.), &
      column_t('n_reset', '1', 'resets of the memory since the start', .true.), &
      column_t('sigma_a', 'kPa', 'axial effective stress'), &
      column_t('sigma_r', 'kPa', 'radial effective stress'), &
      column_t('eps_r', '1', 'radial strain, natural'), &
      column_t('suction', 'kPa', 'p_a - p_w'), &
      column_t('u', 'kPa', &
               'excess pore pressure: constant volume and saturated, total radial stress held, or air = constant'), &
      column_t('psi', '1', 'state parameter'), &
      column_t('n_rate', '1', 'rate evaluations since the start', .true.), &
      column_t('n_reject', '1', 'rejected substeps since the start', .true.), &
      column_t('n_guard', '1', 'rates in which a guard acted, since the start', .true.), &
      column_t('control_error', '1', 'largest relative error of prescribed stresses since the row before'), &
      column_t('stage', '1', 'stage, 0 is the start', .true.), &
      column_t('cycle', '1', 'cycle of the stage; a reversal belongs to the cycle that it ends; 0: none', .true.), &
      column_t('r_u', '1', 'pore pressure of the stage over the effective confining stress at its start'), &
      column_t('p_a', 'kPa', 'air pressure above the atmosphere'), &
      column_t('sig_11', 'kPa', 'effective stress'), column_t('sig_22', 'kPa', 'effective stress'), &
      column_t('sig_33', 'kPa', 'effective stress'), column_t('sig_12', 'kPa', 'effective stress'), &
      column_t('sig_13', 'kPa', 'effective stress'), column_t('sig_23', 'kPa', 'effective stress'), &
      column_t('eps_11', '1', 'strain, natural'), column_t('eps_22', '1', 'strain, natural'), &
      column_t('eps_33', '1', 'strain, natural'), column_t('gamma_12', '1', 'engineering shear strain'), &
      column_t('gamma_13', '1', 'engineering shear strain'), column_t('gamma_23', '1', 'engineering shear strain')]
contains
   !> Numbers of the columns of a test: those of components only where they are wanted, those of state variables only
   !> where the law has them.
   function columns_shown(soil, stages) result(shown)
      type(soil_t), intent(in) :: soil
      type(test_stage_t), intent(in) :: stages(:)   !< General controls want the components of tensors.
      integer, allocatable :: shown(:)
      integer :: i

      allocate (shown(0))
      do i = 1, merge(size(COLUMNS), PLAIN, any(general_control(stages%control)))
         select case (COLUMNS(i)%name)
         case ('n_substep', 'n_reset', 'n_rate', 'n_reject', 'n_guard')
            if (state_index(soil%law, trim(COLUMNS(i)%name)) == 0) cycle
         case ('psi')
            if (state_index(soil%law, 'state_parameter') == 0) cycle
         case ('p_a')
            if (.not. any(stages%keeps_air)) cycle
         end select
         shown = [shown, i]
      end do
   end function columns_shown

   !> Finds the values of all columns. In the order of COLUMNS; stresses in the unit of the law, compression positive.
   pure function values_of(soil, point, run, error, stage) result(values)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      type(stage_run_t), intent(in) :: run
      real(wp), intent(in) :: error      !< Largest of what is held since the row before, relative.
      integer, intent(in) :: stage   !< Number of the stage; 0: the start.
      real(wp) :: values(size(COLUMNS))

      values = [point%strain(AXIAL), volumetric_strain(point), mean_stress(point), deviator_stress(point), &
                void_ratio(soil, point), saturation(soil, point), &
                state_value(soil, point, 'n_substep'), state_value(soil, point, 'n_reset'), point%stress(AXIAL), &
                radial_stress(point), 0.5_wp*sum(point%strain(RADIAL)), point%suction, run%pressure, &
                state_value(soil, point, 'state_parameter'), state_value(soil, point, 'n_rate'), &
                state_value(soil, point, 'n_reject'), state_value(soil, point, 'n_guard'), error, real(stage, wp), &
                real(run%cycle, wp), run%r_u, point%p_a, point%stress, point%strain]
   end function values_of
end module triax_columns
