! SPDX-License-Identifier: MIT
!> Stages of a test: the quantity that leads them (it is prescribed and its target ends the stage), and the six linear
!> constraints that each named control stands for.
!>
!> A constraint reads strain_row . (change of strain) + stress_row . (change of stress) = its share of a change; stress
!> is net (sigma' - S_w p_c on the normal components), total (net stress and air pressure) where no air leaves, or
!> effective. The last one belongs to what leads.
module triax_stage
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use texts, only: joined
   implicit none (type, external)
   private
   public :: test_stage_t, set_constraints, quantity_rows, leads_of, lead_keys, controls_by, keeps_volume, &
             shear_control, general_control
   public :: CONTROL_NAMES, QUANTITIES, LINEAR
   public :: BY_EPS_A, BY_EPS_V, BY_GAMMA, BY_SIGMA_A, BY_P, BY_Q, BY_TAU, BY_SUCTION, BY_D_EPS, BY_D_SIGMA, BY_CHANGES
   public :: PER_PRESSURE, ROWS

   integer, parameter :: ROWS = 6          !< Constraints of a stage beside the one on suction.

   !> Quantities that can lead a stage.
   integer, parameter :: BY_EPS_A = 1, BY_EPS_V = 2, BY_GAMMA = 3, BY_SIGMA_A = 4, BY_P = 5, BY_Q = 6, BY_TAU = 7, &
                         BY_SUCTION = 8, BY_D_EPS = 9, BY_D_SIGMA = 10, BY_CHANGES = 11
   integer, parameter :: PER_STRAIN = 1, PER_PRESSURE = 2, PER_SHARE = 3   !< Unit of increments: [-], stress, of 1.

   !> Rows by which a constraint, or a quantity, is made of strain or of stress: factors of 11, 22, 33, 12, 13, 23
   !> (engineering shear), compression positive. Numbers up to 6 are single components.
   integer, parameter :: AXIAL = 3, SHEAR = 5, ACROSS = 7, VOLUME = 8, MEAN = 9, DEVIATOR = 10
   real(wp), parameter :: FACTORS(6, 7:10) = reshape([ &
      1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &            ! ACROSS: the radial ones are equal
      1.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &             ! VOLUME
      1.0_wp/3, 1.0_wp/3, 1.0_wp/3, 0.0_wp, 0.0_wp, 0.0_wp, &       ! MEAN
      -0.5_wp, -0.5_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp], [6, 4])    ! DEVIATOR

   type :: quantity_t
      character(16) :: key       !< Key that gives its value at the end.
      character(8) :: name       !< For `cycle_by`.
      integer :: unit            !< PER_*
      integer :: strain, stress  !< Numbers of the rows that it is made of, 0: none.
   end type quantity_t

   type(quantity_t), parameter :: QUANTITIES(*) = [ &
      quantity_t('eps_a_end', 'eps_a', PER_STRAIN, AXIAL, 0), quantity_t('eps_v_end', 'eps_v', PER_STRAIN, VOLUME, 0), &
      quantity_t('gamma_end', 'gamma', PER_STRAIN, SHEAR, 0), &
      quantity_t('sigma_a_end', 'sigma_a', PER_PRESSURE, 0, AXIAL), quantity_t('p_end', 'p', PER_PRESSURE, 0, MEAN), &
      quantity_t('q_end', 'q', PER_PRESSURE, 0, DEVIATOR), quantity_t('tau_end', 'tau', PER_PRESSURE, 0, SHEAR), &
      quantity_t('suction_end', 'suction', PER_PRESSURE, 0, 0), quantity_t('d_eps', '', PER_STRAIN, 6, 0), &
      quantity_t('d_sigma', '', PER_PRESSURE, 0, 6), quantity_t('change_1', '', PER_SHARE, 0, 0)]

   !> A named control.
   type :: control_t
      character(28) :: name
      integer :: leads(3)       !< BY_* of what may lead it, 0: none; where cycles can run, the strain first.
      integer :: strain(5), stress(5)   !< Rows of the constraints before the one of what leads, 0: none.
   end type control_t

   integer, parameter :: UNDRAINED = 2, SHEAR_DRAINED = 8, SHEAR_CONSTANT_VOLUME = 9, CONSTANT_NET_STRESS = 10, &
                         STRAIN_PATH = 11, LINEAR = 13
   integer, parameter :: NONE(5) = 0, ALL(5) = [1, 2, 3, 4, 5]
   type(control_t), parameter :: CONTROLS(13) = [ &
      control_t('drained', [BY_EPS_A, BY_Q, 0], [4, 5, 6, 0, 0], [0, 0, 0, 1, 2]), &
      control_t('undrained', [BY_EPS_A, BY_Q, 0], [4, 5, 6, ACROSS, VOLUME], NONE), &
      control_t('isotropic', [BY_EPS_V, BY_P, 0], [4, 5, 6, ACROSS, DEVIATOR], NONE), &
      control_t('oedometer', [BY_EPS_V, BY_SIGMA_A, BY_P], [4, 5, 6, 1, 2], NONE), &
      control_t('k0', [BY_EPS_V, BY_SIGMA_A, BY_P], [4, 5, 6, 1, 2], NONE), &
      control_t('constant_p', [BY_EPS_A, BY_Q, 0], [4, 5, 6, 0, 0], [0, 0, 0, ACROSS, MEAN]), &
      control_t('constant_q', [BY_P, BY_EPS_V, 0], [4, 5, 6, 0, 0], [0, 0, 0, ACROSS, DEVIATOR]), &
      control_t('simple_shear_drained', [BY_GAMMA, BY_TAU, 0], [1, 2, 0, 4, 6], [0, 0, AXIAL, 0, 0]), &
      control_t('simple_shear_constant_volume', [BY_GAMMA, BY_TAU, 0], [1, 2, 3, 4, 6], NONE), &
      control_t('constant_net_stress', [BY_SUCTION, 0, 0], NONE, ALL), &
      control_t('strain_path', [BY_D_EPS, 0, 0], ALL, NONE), &
      control_t('stress_path', [BY_D_SIGMA, 0, 0], NONE, ALL), &
      control_t('linear', [BY_CHANGES, 0, 0], NONE, NONE)]
   character(28), parameter :: CONTROL_NAMES(*) = CONTROLS%name

   !> One stage of a test.
   type :: test_stage_t
      integer :: control = 0
      integer :: line = 0
      integer :: lead = 0                    !< BY_*
      real(wp) :: target = 0.0_wp            !< Value of what leads at the end; 1 where changes are given.
      real(wp) :: strain_rows(6, ROWS) = 0.0_wp, stress_rows(6, ROWS) = 0.0_wp   !< Column i: constraint i.
      real(wp) :: changes(ROWS) = 0.0_wp     !< Right sides; that of a lead by its value is set when the stage begins.
      logical :: effective = .false.         !< Stress rows prescribe effective stress, not net stress.
      logical :: moves_suction = .false.
      logical :: by_change = .false.         !< The suction moves by suction_change, not to suction_end.
      logical :: keeps_water = .false.       !< Water content S_w e is held, suction follows.
      logical :: keeps_air = .false.         !< Nor does air leave; total stress is prescribed in place of net stress.
      real(wp) :: suction_end = 0.0_wp, suction_change = 0.0_wp   !< [unit of stress]
      real(wp) :: increment = 0.0_wp         !< In the unit of what leads.
      logical :: given_increment = .false.   !< By hand: an accuracy does not change it.
      real(wp) :: suction_increment = 0.0_wp, suction_interval = 0.0_wp   !< Where suction alone moves [stress].
      integer :: parts = 1                   !< Increments are divided into so many, for an accuracy.
      real(wp) :: interval = 0.0_wp          !< Between rows of the output, in the same unit.
      logical :: given_interval = .false.    !< By hand.
      integer :: cycles = 0                  !< 0: one way
      integer :: cycle_by = 0                !< BY_*
      real(wp) :: amplitude = 0.0_wp, centre = 0.0_wp
      logical :: has_centre = .false.        !< Otherwise cycles are about where the stage begins.
      real(wp) :: stop_r_u = 0.0_wp          !< Pore pressure ratio that ends the stage, 0: none.
      real(wp) :: stop_double_amplitude = 0.0_wp   !< Strain between two reversals that ends it, 0: none.
   end type test_stage_t

contains
   !> Quantities that may lead a control. BY_*; where cycles can run, the strain first.
   pure function leads_of(control) result(leads)
      integer, intent(in) :: control   !< Place in CONTROL_NAMES.
      integer, allocatable :: leads(:)

      leads = pack(CONTROLS(control)%leads, CONTROLS(control)%leads > 0)
   end function leads_of

   !> "eps_a_end or q_end"
   pure function lead_keys(control) result(text)
      integer, intent(in) :: control   !< Place in CONTROL_NAMES.
      character(:), allocatable :: text

      text = joined(QUANTITIES(leads_of(control))%key, ' or ')
      if (control == CONSTANT_NET_STRESS) text = text//' or d_suction'
      if (control == LINEAR) text = 'strain_i, stress_i and change_i of six constraints'
   end function lead_keys

   !> 'control=drained|undrained', the controls that one of some quantities may lead: a condition of key_t.
   pure function controls_by(quantities) result(condition)
      integer, intent(in) :: quantities(:)   !< BY_*
      character(:), allocatable :: condition
      integer :: control, i

      condition = ''
      do control = 1, size(CONTROL_NAMES)
         if (any([(any(leads_of(control) == quantities(i)), i=1, size(quantities))])) &
            condition = condition//'|'//trim(CONTROL_NAMES(control))
      end do
      condition = 'control='//condition(2:)
   end function controls_by

   !> True if the control holds the volume: a saturated sample then is undrained.
   pure logical function keeps_volume(control)
      integer, intent(in) :: control   !< Place in CONTROL_NAMES.

      keeps_volume = control == UNDRAINED .or. control == SHEAR_CONSTANT_VOLUME
   end function keeps_volume

   !> True for simple shear, led by the components 13.
   pure logical function shear_control(control)
      integer, intent(in) :: control   !< Place in CONTROL_NAMES.

      shear_control = control == SHEAR_DRAINED .or. control == SHEAR_CONSTANT_VOLUME
   end function shear_control

   !> True where axial, radial and volumetric values are not sufficient: tables then have the six components.
   elemental logical function general_control(control)
      integer, intent(in) :: control   !< Place in CONTROL_NAMES.

      general_control = control >= STRAIN_PATH .or. control == SHEAR_DRAINED .or. control == SHEAR_CONSTANT_VOLUME
   end function general_control

   !> Rows by which a quantity is made of strain and stress.
   pure subroutine quantity_rows(lead, strain_row, stress_row)
      integer, intent(in) :: lead   !< BY_*; rows of suction and of the changes of `linear` are 0.
      real(wp), intent(out) :: strain_row(6), stress_row(6)   !< Factors of 11, 22, 33, 12, 13, 23.

      strain_row = row_of(QUANTITIES(lead)%strain)
      stress_row = row_of(QUANTITIES(lead)%stress)
   end subroutine quantity_rows

   !> The row of a number, 0: none.
   pure function row_of(number) result(row)
      integer, intent(in) :: number
      real(wp) :: row(6)

      row = 0.0_wp
      if (number > 6) row = FACTORS(:, number)
      if (number > 0 .and. number <= 6) row(number) = 1.0_wp
   end function row_of

   !> Fills the constraints of a named control; those of `linear`, and given changes, stand already.
   subroutine set_constraints(stage, lead)
      type(test_stage_t), intent(inout) :: stage
      integer, intent(in) :: lead   !< BY_*, what leads; for stress cycles the strain that is driven.
      integer :: i

      if (stage%control == LINEAR) return
      do i = 1, 5
         stage%strain_rows(:, i) = row_of(CONTROLS(stage%control)%strain(i))
         stage%stress_rows(:, i) = row_of(CONTROLS(stage%control)%stress(i))
      end do
      call quantity_rows(lead, stage%strain_rows(:, 6), stage%stress_rows(:, 6))
      ! suction has no row: the last stress stays too
      if (stage%control == CONSTANT_NET_STRESS) stage%stress_rows(6, 6) = 1.0_wp
   end subroutine set_constraints
end module triax_stage
