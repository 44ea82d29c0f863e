! SPDX-License-Identifier: MIT
!> Keys of case files.
module triax_keys
   use kinds, only: wp
   use key_schema, only: key_t, check_entries, described, NONE, UNBOUNDED
   use faults, only: fault_t
   use namelists, only: group_t
   use stress_units, only: stress_unit_t, KILOPASCAL
   implicit none (type, external)
   private
   public :: CASE_KEYS, keys_in, check_keys, print_keys

   character, parameter :: DIGITS(6) = ['1', '2', '3', '4', '5', '6']
   !> [kPa] Stress of a start: grains of sand crush long before.
   real(wp), parameter :: MOST = 5.0e4_wp
   integer, private :: i   ! of the implied loops below
   type(key_t), parameter :: CASE_KEYS(*) = [ &
      key_t('case', 'name', 't', NONE, 0, 0, 'name of the case and of its output; default: name of the file'), &
      key_t('case', 'title', 't', NONE, 0, 0, 'a line about the case'), &
      key_t('case', 'control_tolerance', 'n', NONE, 1.0e-12_wp, 1.0e-3_wp, &
            'error allowed in prescribed stresses over the effective stress; default 1e-10'), &
      key_t('case', 'accuracy', 'n', NONE, 1.0e-8_wp, 0.5_wp, &
            'relative error wanted in the histories; chooses increments and stress tolerance that are not given'), &
      key_t('case', 'max_updates', 'i', NONE, 1.0_wp, 1.0e9_wp, &
            'most updates of the material; then the test stops (for fits); default: no limit'), &
      key_t('initial', 'p_eff', 'n', NONE, 1.0e-6_wp, MOST, &
            'mean effective stress of an isotropic start', unit='kPa'), &
      key_t('initial', 'sigma_a', 'n', NONE, 1.0e-6_wp, MOST, &
            'axial effective stress, with sigma_r, instead of p_eff', unit='kPa'), &
      key_t('initial', 'sigma_r', 'n', NONE, 1.0e-6_wp, MOST, &
            'radial effective stress, with sigma_a', unit='kPa'), &
      key_t('initial', 'p_net', 'n', NONE, 0.0_wp, MOST, &
            'mean net stress of an isotropic start, instead of p_eff: p'' is p_net + S_w suction', unit='kPa'), &
      key_t('initial', 'sigma_a_net', 'n', NONE, 0.0_wp, MOST, &
            'axial net stress, with sigma_r_net, instead of p_eff', unit='kPa'), &
      key_t('initial', 'sigma_r_net', 'n', NONE, 0.0_wp, MOST, 'radial net stress, with sigma_a_net', unit='kPa'), &
      key_t('initial', 'stress', 'N', NONE, -1.0e7_wp, 1.0e7_wp, &
            'effective stresses 11, 22, 33, 12, 13, 23, instead of p_eff', unit='kPa', values=6), &
      key_t('initial', 'void_ratio', 'n', NONE, 0.01_wp, 5.0_wp, 'void ratio'), &
      key_t('initial', 'suction', 'n', NONE, 0.0_wp, 1.0e6_wp, 'p_a - p_w; default 0, saturated', unit='kPa'), &
      key_t('initial', 'saturation', 'n', NONE, 1.0e-6_wp, 1.0_wp, &
            'degree of saturation between the main curves, with hysteresis = 1; default: on the main drying curve'), &
      key_t('initial', 'air_pressure', 'n', NONE, -100.0_wp, 1.0e5_wp, &
            'air pressure above the atmosphere: back pressure; default 0', unit='kPa'), &
      key_t('initial', 'henry', 'n', NONE, 0.0_wp, 0.5_wp, &
            'volume of air that a volume of water dissolves, with air = ''constant''; 0.02 at 20 C; default 0'), &
      key_t('initial', 'k_w', 'n', NONE, 0.0_wp, 1.0e9_wp, &
            'bulk modulus of the water, with air = ''constant''; 2.2e6 kPa; default 0: incompressible', unit='kPa'), &
      key_t('initial', 'state_variables', 'N', NONE, -UNBOUNDED, UNBOUNDED, &
            'all state variables of the law in their order, with stress, instead of void_ratio'), &
      key_t('stage', 'control', 't', NONE, 0, 0, 'see the list of controls'), &
      key_t('stage', 'stress', 'w', 'net', 0, 0, &
            'stress that is prescribed, default net (total with air = ''constant''); the same without suction', &
            'net|effective'), &
      key_t('stage', 'eps_a_end', 'n', NONE, -1.0_wp, 1.0_wp, 'axial strain at the end, from the start of the test'), &
      key_t('stage', 'eps_v_end', 'n', NONE, -1.0_wp, 1.0_wp, &
            'volumetric strain at the end, from the start of the test'), &
      key_t('stage', 'gamma_end', 'n', NONE, -2.0_wp, 2.0_wp, &
            'engineering shear strain 13 at the end, from the start of the test'), &
      key_t('stage', 'sigma_a_end', 'n', NONE, -1.0e7_wp, 1.0e7_wp, 'axial stress at the end', unit='kPa'), &
      key_t('stage', 'p_end', 'n', NONE, -1.0e7_wp, 1.0e7_wp, 'mean stress at the end', unit='kPa'), &
      key_t('stage', 'q_end', 'n', NONE, -1.0e7_wp, 1.0e7_wp, 'sigma_a - sigma_r at the end', unit='kPa'), &
      key_t('stage', 'tau_end', 'n', NONE, -1.0e7_wp, 1.0e7_wp, 'shear stress 13 at the end', unit='kPa'), &
      key_t('stage', 'd_eps', 'N', NONE, -1.0_wp, 1.0_wp, &
            'change of the strains 11, 22, 33, 12, 13, 23, shear as engineering strain (strain_path)', values=6), &
      key_t('stage', 'd_sigma', 'N', NONE, -1.0e7_wp, 1.0e7_wp, &
            'change of the stresses 11, 22, 33, 12, 13, 23 (stress_path)', unit='kPa', values=6), &
      [(key_t('stage', 'strain_'//DIGITS(i), 'N', NONE, -1.0e6_wp, 1.0e6_wp, &
              'factors of the six strains in constraint '//DIGITS(i)//', default 0 (linear)', values=6), i=1, 6)], &
      [(key_t('stage', 'stress_'//DIGITS(i), 'N', NONE, -1.0e6_wp, 1.0e6_wp, &
              'factors of the six stresses in constraint '//DIGITS(i)//', default 0 (linear)', values=6), i=1, 6)], &
      [(key_t('stage', 'change_'//DIGITS(i), 'n', NONE, -1.0e7_wp, 1.0e7_wp, &
              'change of the sum of constraint '//DIGITS(i)//' over the stage, default 0 (linear)'), i=1, 6)], &
      key_t('stage', 'suction_end', 'n', NONE, 0.0_wp, 1.0e6_wp, &
            'suction at the end, reached in equal parts; default: suction is constant', unit='kPa'), &
      key_t('stage', 'd_suction', 'n', NONE, -1.0e6_wp, 1.0e6_wp, &
            'change of the suction over the stage, instead of suction_end', unit='kPa'), &
      key_t('stage', 'water', 'w', 'free', 0, 0, &
            'constant: the water content S_w e is constant and suction changes; default free', 'free|constant'), &
      key_t('stage', 'air', 'w', 'free', 0, 0, &
            'constant: the air keeps its mass and its pressure changes, with water = ''constant''; default free', &
            'free|constant'), &
      key_t('stage', 'cycle_by', 't', NONE, 0, 0, &
            'eps_a or gamma (strain is reversed), q or tau (strain is driven until the stress is reached)'), &
      key_t('stage', 'amplitude', 'n', NONE, -1.0e7_wp, 1.0e7_wp, &
            'amplitude of the cycles, in the unit of cycle_by; negative: the first half cycle is backwards'), &
      key_t('stage', 'centre', 'n', NONE, -1.0e7_wp, 1.0e7_wp, &
            'centre of the cycles; default: the value where the stage begins'), &
      key_t('stage', 'cycles', 'i', NONE, 1.0_wp, 1.0e6_wp, 'number of cycles'), &
      key_t('stage', 'stop_r_u', 'n', NONE, 1.0e-3_wp, 1.0_wp, &
            'pore pressure ratio that ends the stage (undrained, simple_shear_constant_volume; saturated)'), &
      key_t('stage', 'stop_double_amplitude', 'n', NONE, 1.0e-6_wp, 1.0_wp, &
            'strain eps_a or gamma between two reversals that ends the stage (cycles)'), &
      key_t('stage', 'increment', 'n', NONE, 1.0e-12_wp, 1.0e6_wp, &
            'largest step of the key that ends the stage: strain, default 1e-4; stress, 1 kPa; suction, 0.1 kPa; '// &
            'linear, 1e-3 of 1'), &
      key_t('stage', 'output_interval', 'n', NONE, 1.0e-12_wp, 1.0e6_wp, &
            'a row at each multiple of it: strain, default 1e-3; stress [kPa], 10; suction [kPa], 1; linear: 1e-2')]

   !> Keys of stages whose value may be a stress or a strain.
   character(15), parameter :: EITHER(*) = [character(15) :: 'amplitude', 'centre', 'increment', 'output_interval', &
      [('change_'//DIGITS(i), i=1, 6)]]
contains
   !> The keys with their limits in another unit of stress.
   pure function keys_in(unit) result(keys)
      type(stress_unit_t), intent(in) :: unit
      type(key_t) :: keys(size(CASE_KEYS))
      integer :: k

      keys = CASE_KEYS
      do k = 1, size(keys)
         if (keys(k)%unit == KILOPASCAL%name) then
            keys(k)%lower = keys(k)%lower*unit%factor
            keys(k)%upper = keys(k)%upper*unit%factor
            keys(k)%unit = unit%name
         else if (any(EITHER == keys(k)%name)) then
            keys(k)%lower = min(keys(k)%lower, keys(k)%lower*unit%factor)
            keys(k)%upper = max(keys(k)%upper, keys(k)%upper*unit%factor)
         end if
      end do
   end function keys_in

   !> Refuses unknown keys and values outside their range, which for stresses is in the unit of the material. Fault
   !> EXIT_INPUT, at the first.
   subroutine check_keys(groups, unit, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the case)
      type(stress_unit_t), intent(in) :: unit
      type(fault_t), intent(inout) :: fault
      type(key_t) :: keys(size(CASE_KEYS))
      integer :: i

      keys = keys_in(unit)
      do i = 1, size(groups)
         if (any(keys%group == groups(i)%name)) call check_entries(keys, groups(i), .false., fault)
         if (fault%code /= 0) return
      end do
   end subroutine check_keys

   !> A list of keys for the help text, under the heads of their groups.
   subroutine print_keys(unit, keys, remark)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(key_t), intent(in) :: keys(:)   !< (keys to print)
      character(*), intent(in) :: remark   !< Behind the head.
      integer :: k

      do k = 1, size(keys)
         if (.not. any(keys(:k - 1)%group == keys(k)%group)) write (unit, '(3a)') '   &', trim(keys(k)%group), remark
         write (unit, '(4a)') '      ', keys(k)%name, ' ', described(keys(k))
      end do
   end subroutine print_keys
end module triax_keys
