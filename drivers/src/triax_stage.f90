! SPDX-License-Identifier: MIT
!> Stages of a test: the quantity that leads them (it is prescribed and its target ends the stage), and the six linear
!> constraints that each named control stands for.
!>
!> A constraint reads strain_row . (change of strain) + stress_row . (change of stress) = its share of a change; stress
!> is net (sigma' - S_w p_c on the normal components), total (net stress and air pressure) where no air leaves, or
!> effective. The last one belongs to what leads.
module triax_stage
   use, intrinsic :: iso_fortran_env, only: wp => real64
   implicit none (type, external)
   private
   public :: test_stage_t, quantity_t, set_constraints, quantity_rows, leads_of, controls_by, keeps_volume, &
             shear_control, general_control
   public :: CONTROL_NAMES, QUANTITIES, STRAIN_PATH, STRESS_PATH, LINEAR, CONSTANT_NET_STRESS
   public :: BY_EPS_A, BY_EPS_V, BY_GAMMA, BY_SIGMA_A, BY_P, BY_Q, BY_TAU, BY_SUCTION, BY_D_EPS, BY_D_SIGMA, BY_CHANGES
   public :: PER_STRAIN, PER_PRESSURE, PER_SHARE, ROWS

   integer, parameter :: ROWS = 6          !< Constraints of a stage beside the one on suction.

   !> Quantities that can lead a stage.
   integer, parameter :: BY_EPS_A = 1, BY_EPS_V = 2, BY_GAMMA = 3, BY_SIGMA_A = 4, BY_P = 5, BY_Q = 6, BY_TAU = 7, &
                         BY_SUCTION = 8, BY_D_EPS = 9, BY_D_SIGMA = 10, BY_CHANGES = 11
   integer, parameter :: PER_STRAIN = 1, PER_PRESSURE = 2, PER_SHARE = 3   !< Unit of increments: [-], stress, of 1.

   type :: quantity_t
      character(16) :: key       !< Key that gives its value at the end.
      character(8) :: name       !< For `cycle_by`.
      integer :: unit            !< PER_*
   end type quantity_t

   type(quantity_t), parameter :: QUANTITIES(*) = [ &
      quantity_t('eps_a_end', 'eps_a', PER_STRAIN), quantity_t('eps_v_end', 'eps_v', PER_STRAIN), &
      quantity_t('gamma_end', 'gamma', PER_STRAIN), quantity_t('sigma_a_end', 'sigma_a', PER_PRESSURE), &
      quantity_t('p_end', 'p', PER_PRESSURE), quantity_t('q_end', 'q', PER_PRESSURE), &
      quantity_t('tau_end', 'tau', PER_PRESSURE), quantity_t('suction_end', 'suction', PER_PRESSURE), &
      quantity_t('d_eps', '', PER_STRAIN), quantity_t('d_sigma', '', PER_PRESSURE), &
      quantity_t('change_1', '', PER_SHARE)]

   !> Controls by name.
   integer, parameter :: DRAINED = 1, UNDRAINED = 2, ISOTROPIC = 3, OEDOMETER = 4, K0 = 5, CONSTANT_P = 6, &
                         CONSTANT_Q = 7, SHEAR_DRAINED = 8, SHEAR_CONSTANT_VOLUME = 9, CONSTANT_NET_STRESS = 10, &
                         STRAIN_PATH = 11, STRESS_PATH = 12, LINEAR = 13
   character(28), parameter :: CONTROL_NAMES(13) = [character(28) :: 'drained', 'undrained', 'isotropic', &
      'oedometer', 'k0', 'constant_p', 'constant_q', 'simple_shear_drained', 'simple_shear_constant_volume', &
      'constant_net_stress', 'strain_path', 'stress_path', 'linear']

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

   real(wp), parameter :: NOTHING(6) = 0.0_wp
   real(wp), parameter :: AXIAL_ROW(6) = [0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   real(wp), parameter :: ACROSS_ROW(6) = [1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]   !< Radial ones are equal.
   real(wp), parameter :: VOLUME_ROW(6) = [1.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   real(wp), parameter :: DEVIATOR_ROW(6) = [-0.5_wp, -0.5_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   real(wp), parameter :: SHEAR_ROW(6) = [0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp]     !< 13: the axis is 3.
contains
   !> Quantities that may lead a control. BY_*; where cycles can run, the strain first.
   pure function leads_of(control) result(leads)
      integer, intent(in) :: control   !< Place in CONTROL_NAMES.
      integer, allocatable :: leads(:)

      select case (control)
      case (DRAINED, UNDRAINED)
         leads = [BY_EPS_A, BY_Q]
      case (ISOTROPIC)
         leads = [BY_EPS_V, BY_P]
      case (OEDOMETER, K0)
         leads = [BY_EPS_V, BY_SIGMA_A, BY_P]
      case (CONSTANT_P)
         leads = [BY_EPS_A, BY_Q]
      case (CONSTANT_Q)
         leads = [BY_P, BY_EPS_V]
      case (SHEAR_DRAINED, SHEAR_CONSTANT_VOLUME)
         leads = [BY_GAMMA, BY_TAU]
      case (CONSTANT_NET_STRESS)
         leads = [BY_SUCTION]
      case (STRAIN_PATH)
         leads = [BY_D_EPS]
      case (STRESS_PATH)
         leads = [BY_D_SIGMA]
      case default
         leads = [BY_CHANGES]
      end select
   end function leads_of

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
      integer, intent(in) :: lead   !< BY_*; rows of suction and of changes are 0.
      real(wp), intent(out) :: strain_row(6), stress_row(6)   !< Factors of 11, 22, 33, 12, 13, 23.

      strain_row = 0.0_wp
      stress_row = 0.0_wp
      select case (lead)
      case (BY_EPS_A)
         strain_row = AXIAL_ROW
      case (BY_EPS_V)
         strain_row = VOLUME_ROW
      case (BY_GAMMA)
         strain_row = SHEAR_ROW
      case (BY_SIGMA_A)
         stress_row = AXIAL_ROW
      case (BY_P)
         stress_row = VOLUME_ROW/3.0_wp
      case (BY_Q)
         stress_row = DEVIATOR_ROW
      case (BY_TAU)
         stress_row = SHEAR_ROW
      end select
   end subroutine quantity_rows

   !> Fills the constraints of a named control; those of `linear`, and given changes, stand already. Factors of 11, 22,
   !> 33, 12, 13, 23 (engineering shear), compression positive.
   subroutine set_constraints(stage, lead)
      type(test_stage_t), intent(inout) :: stage
      integer, intent(in) :: lead   !< BY_*, what leads; for stress cycles the strain that is driven.
      integer :: i

      if (stage%control == LINEAR) return
      stage%strain_rows = 0.0_wp
      stage%stress_rows = 0.0_wp
      do i = 1, 6
         if (any(stage%control == [STRESS_PATH, CONSTANT_NET_STRESS])) then
            stage%stress_rows(i, i) = 1.0_wp
         else
            stage%strain_rows(i, i) = 1.0_wp   ! what no case below frees: no strain
         end if
      end do
      call quantity_rows(lead, stage%strain_rows(:, 6), stage%stress_rows(:, 6))
      select case (stage%control)
      case (DRAINED)
         call no_shear()
         call constraint(4, NOTHING, [1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp])
         call constraint(5, NOTHING, [0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp])
      case (UNDRAINED)
         call no_shear()
         call constraint(4, ACROSS_ROW, NOTHING)
         call constraint(5, VOLUME_ROW, NOTHING)
      case (ISOTROPIC)
         call no_shear()
         call constraint(4, ACROSS_ROW, NOTHING)
         call constraint(5, DEVIATOR_ROW, NOTHING)
      case (OEDOMETER, K0)
         call no_shear()
         call constraint(4, [1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp], NOTHING)
         call constraint(5, [0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp], NOTHING)
      case (CONSTANT_P)
         call no_shear()
         call constraint(4, NOTHING, ACROSS_ROW)
         call constraint(5, NOTHING, VOLUME_ROW/3.0_wp)
      case (CONSTANT_Q)
         call no_shear()
         call constraint(4, NOTHING, ACROSS_ROW)
         call constraint(5, NOTHING, DEVIATOR_ROW)
      case (SHEAR_DRAINED, SHEAR_CONSTANT_VOLUME)
         call constraint(4, [0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp], NOTHING)
         call constraint(5, [0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], NOTHING)
         if (stage%control == SHEAR_DRAINED) call constraint(3, NOTHING, AXIAL_ROW)
      case (CONSTANT_NET_STRESS, STRESS_PATH)
         call constraint(6, NOTHING, [0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp])
      case (STRAIN_PATH)
         call constraint(6, [0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], NOTHING)
      end select
   contains
      subroutine constraint(place, strain_row, stress_row)
         integer, intent(in) :: place
         real(wp), intent(in) :: strain_row(6), stress_row(6)

         stage%strain_rows(:, place) = strain_row
         stage%stress_rows(:, place) = stress_row
      end subroutine constraint

      !> Constraints 1 to 3: no shear strain.
      subroutine no_shear()
         integer :: j

         stage%strain_rows(:, 1:3) = 0.0_wp
         do j = 1, 3
            stage%strain_rows(j + 3, j) = 1.0_wp
         end do
      end subroutine no_shear
   end subroutine set_constraints
end module triax_stage
