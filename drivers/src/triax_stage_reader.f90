! SPDX-License-Identifier: MIT
!> Stages of a case from their groups.
module triax_stage_reader
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: joined, lower_case, short, whole, LENGTH
   use namelists, only: group_t
   use spelling, only: nearest_name
   use key_schema, only: get_text, line_of, given, refuse_idle_keys
   use key_table, only: key_table_t
   use stress_units, only: KILOPASCAL
   use triax_stage, only: test_stage_t, set_constraints, leads_of, lead_keys, controls_by, keeps_volume, &
                          CONTROL_NAMES, QUANTITIES, LINEAR, BY_EPS_A, BY_EPS_V, BY_GAMMA, BY_SIGMA_A, BY_P, BY_Q, &
                          BY_TAU, BY_SUCTION, BY_D_EPS, BY_D_SIGMA, BY_CHANGES, PER_PRESSURE, ROWS
   implicit none (type, external)
   private
   public :: read_stage

   !> Defaults by the unit of what leads (PER_*), suction apart; stresses in kPa, converted to the unit of the material.
   real(wp), parameter :: INCREMENTS(3) = [1.0e-4_wp, 1.0_wp, 1.0e-3_wp]
   real(wp), parameter :: INTERVALS(3) = [1.0e-3_wp, 10.0_wp, 1.0e-2_wp]
   real(wp), parameter :: SUCTION_INCREMENT = 0.1_wp, SUCTION_INTERVAL = 1.0_wp   ! [kPa]
   real(wp), parameter :: MAX_INCREMENTS = 1.0e8_wp
   real(wp), parameter :: LARGEST = 1.0e7_wp   !< Stress in a stage [kPa].
   real(wp), parameter :: FACTOR = 1.0e6_wp    !< In a constraint, and for steps.
   integer, parameter :: NORMAL = 3            !< Components up to this are normal ones.
   character(*), parameter :: KPA = KILOPASCAL%name
contains
   !> Makes a stage from its group, whose entries were checked. Fault EXIT_INPUT: a control or word is unknown, or keys
   !> are missing, contradict each other or have no effect.
   subroutine read_stage(k, stage, fault)
      type(key_table_t), intent(inout) :: k
      type(test_stage_t), intent(out) :: stage
      type(fault_t), intent(inout) :: fault
      real(wp) :: ends(BY_CHANGES + ROWS - 1)

      ends = 0.0_wp
      call declare_ends(k, stage, ends)
      call declare_course(k, stage)
      if (k%lists) return
      stage%line = k%group%line
      call read_word(k%group, 'control', CONTROL_NAMES, stage%control, fault)
      if (fault%code == 0) call refuse_idle_keys(k%keys, k%group, fault)
      if (fault%code == 0) call read_cycles(k, stage, fault)
      if (fault%code == 0) call read_lead(k, ends, stage, fault)
      if (fault%code == 0) call read_water(k, stage, fault)
      if (fault%code == 0) call read_steps(k, stage, fault)
   end subroutine read_stage

   !> Declares what a stage does, and the values at its end.
   subroutine declare_ends(k, stage, ends)
      type(key_table_t), intent(inout) :: k
      type(test_stage_t), intent(inout) :: stage
      real(wp), intent(inout) :: ends(:)   !< By BY_*; the change of constraint i at BY_CHANGES + i - 1.
      real(wp), allocatable :: six(:)
      character(LENGTH) :: word
      integer :: i

      word = ''
      call k%text('control', word, 'see the list of controls')
      call k%flag('stress', stage%effective, 'net|effective', 'effective', &
                  'stress that is prescribed, default net (total with air = ''constant''); the same without suction')
      call k%number('eps_a_end', ends(BY_EPS_A), -1.0_wp, 1.0_wp, &
                    'axial strain at the end, from the start of the test', controls_by([BY_EPS_A]))
      call k%number('eps_v_end', ends(BY_EPS_V), -1.0_wp, 1.0_wp, &
                    'volumetric strain at the end, from the start of the test', controls_by([BY_EPS_V]))
      call k%number('gamma_end', ends(BY_GAMMA), -2.0_wp, 2.0_wp, &
                    'engineering shear strain 13 at the end, from the start of the test', controls_by([BY_GAMMA]))
      call k%number('sigma_a_end', ends(BY_SIGMA_A), -LARGEST, LARGEST, &
                    'axial stress at the end', controls_by([BY_SIGMA_A]), unit=KPA)
      call k%number('p_end', ends(BY_P), -LARGEST, LARGEST, 'mean stress at the end', controls_by([BY_P]), unit=KPA)
      call k%number('q_end', ends(BY_Q), -LARGEST, LARGEST, &
                    'sigma_a - sigma_r at the end', controls_by([BY_Q]), unit=KPA)
      call k%number('tau_end', ends(BY_TAU), -LARGEST, LARGEST, &
                    'shear stress 13 at the end', controls_by([BY_TAU]), unit=KPA)
      call k%numbers('d_eps', six, -1.0_wp, 1.0_wp, 'change of the strains 11, 22, 33, 12, 13, 23, shear as '// &
                     'engineering strain (strain_path)', controls_by([BY_D_EPS]), count=ROWS)
      if (size(six) == ROWS) stage%changes = six
      call k%numbers('d_sigma', six, -LARGEST, LARGEST, 'change of the stresses 11, 22, 33, 12, 13, 23 (stress_path)', &
                     controls_by([BY_D_SIGMA]), unit=KPA, count=ROWS)
      if (size(six) == ROWS) stage%changes = six
      call declare_factors(k, 'strain', 'strains', stage%strain_rows)
      call declare_factors(k, 'stress', 'stresses', stage%stress_rows)
      do i = 1, ROWS
         call k%number('change_'//whole(i), ends(BY_CHANGES + i - 1), -either(k, LARGEST), either(k, LARGEST), &
                       'change of the sum of constraint '//whole(i)//' over the stage, default 0 (linear)', &
                       controls_by([BY_CHANGES]))
      end do
      call k%number('suction_end', stage%suction_end, 0.0_wp, 1.0e6_wp, &
                    'suction at the end, reached in equal parts; default: suction is constant', unit=KPA)
   end subroutine declare_ends

   !> Declares the factors of six components in each constraint.
   subroutine declare_factors(k, name, components, factors)
      type(key_table_t), intent(inout) :: k
      character(*), intent(in) :: name, components   !< Beginning of the keys; components in words.
      real(wp), intent(inout) :: factors(:, :)       !< They stay where a key is not given. (6, constraints)
      real(wp), allocatable :: six(:)
      integer :: i

      do i = 1, size(factors, 2)
         call k%numbers(name//'_'//whole(i), six, -FACTOR, FACTOR, 'factors of the six '//components// &
                        ' in constraint '//whole(i)//', default 0 (linear)', controls_by([BY_CHANGES]), &
                        count=6)
         if (size(six) == 6) factors(:, i) = six
      end do
   end subroutine declare_factors

   !> Declares how a stage goes on: water and air, cycles, and steps.
   subroutine declare_course(k, stage)
      type(key_table_t), intent(inout) :: k
      type(test_stage_t), intent(inout) :: stage
      character(LENGTH) :: word

      word = ''
      call k%number('d_suction', stage%suction_change, -1.0e6_wp, 1.0e6_wp, &
                    'change of the suction over the stage, instead of suction_end', unit=KPA)
      call k%flag('water', stage%keeps_water, 'free|constant', 'constant', &
                  'constant: the water content S_w e is constant and suction changes; default free')
      call k%flag('air', stage%keeps_air, 'free|constant', 'constant', 'constant: the air keeps its mass and its '// &
                  'pressure changes, with water = ''constant''; default free')
      call k%text('cycle_by', word, &
                  'eps_a or gamma (strain is reversed), q or tau (strain is driven until the stress is reached)', &
                  controls_by([BY_EPS_A, BY_GAMMA]))
      call k%number('amplitude', stage%amplitude, -either(k, LARGEST), either(k, LARGEST), &
                    'amplitude of the cycles, in the unit of cycle_by; negative: the first half cycle is backwards', &
                    '+cycle_by')
      call k%number('centre', stage%centre, -either(k, LARGEST), either(k, LARGEST), &
                    'centre of the cycles; default: the value where the stage begins', '+cycle_by')
      call k%whole('cycles', stage%cycles, 1, 1000000, 'number of cycles', '+cycle_by')
      call k%number('stop_r_u', stage%stop_r_u, 1.0e-3_wp, 1.0_wp, &
                    'pore pressure ratio that ends the stage (undrained, simple_shear_constant_volume; saturated)')
      call k%number('stop_double_amplitude', stage%stop_double_amplitude, 1.0e-6_wp, 1.0_wp, &
                    'strain eps_a or gamma between two reversals that ends the stage (cycles)', '+cycle_by')
      call k%number('increment', stage%increment, 1.0e-12_wp*min(1.0_wp, k%per_kpa), either(k, FACTOR), 'largest '// &
                    'step of the key that ends the stage: strain, default 1e-4; stress, 1 kPa; suction, 0.1 kPa; '// &
                    'linear, 1e-3 of 1')
      call k%number('output_interval', stage%interval, 1.0e-12_wp*min(1.0_wp, k%per_kpa), either(k, FACTOR), &
                    'a row at each multiple of it: strain, default 1e-3; stress [kPa], 10; suction [kPa], 1; '// &
                    'linear: 1e-2')
   end subroutine declare_course

   !> Limit of a value that is a stress [kPa] or a strain, as what it is comes from another key.
   pure real(wp) function either(k, limit)
      type(key_table_t), intent(in) :: k
      real(wp), intent(in) :: limit

      either = limit*max(1.0_wp, k%per_kpa)
   end function either

   !> Reads increments, rows of the output, and what ends the stage before its time.
   subroutine read_steps(k, stage, fault)
      type(key_table_t), intent(in) :: k
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault
      real(wp) :: increment, interval
      logical :: is_stress

      increment = SUCTION_INCREMENT
      interval = SUCTION_INTERVAL
      if (stage%lead /= BY_SUCTION) then
         increment = INCREMENTS(QUANTITIES(stage%lead)%unit)
         interval = INTERVALS(QUANTITIES(stage%lead)%unit)
      end if
      is_stress = QUANTITIES(stage%lead)%unit == PER_PRESSURE
      if (is_stress) then
         increment = increment*k%per_kpa
         interval = interval*k%per_kpa
      end if
      stage%suction_increment = SUCTION_INCREMENT*k%per_kpa
      stage%suction_interval = SUCTION_INTERVAL*k%per_kpa
      stage%given_increment = k%given('increment')
      stage%given_interval = k%given('output_interval')
      if (.not. stage%given_increment) stage%increment = increment
      if (.not. stage%given_interval) stage%interval = interval
      if (is_stress .and. stage%given_increment) stage%suction_increment = stage%increment
      if (is_stress .and. stage%given_interval) stage%suction_interval = stage%interval
      if (k%given('stress') .and. all(abs(sum(stage%stress_rows(:NORMAL, :), dim=1)) <= 0.0_wp)) then
         call refuse(k%group, 'stress', 'has no effect in a stage that prescribes no mean stress, in which net and '// &
                     'effective stress differ (here control '//trim(CONTROL_NAMES(stage%control))//', led by '// &
                     trim(QUANTITIES(stage%lead)%key)//'); remove it.', fault)
      else if (k%given('stop_r_u') .and. .not. (keeps_volume(stage%control) .or. stage%keeps_air)) then
         call refuse(k%group, 'stop_r_u', 'has no effect with control '//trim(CONTROL_NAMES(stage%control))// &
                     ', in which no pore pressure builds up; remove it.', fault)
      else if (2.0_wp/stage%increment > MAX_INCREMENTS .and. .not. is_stress) then
         call refuse(k%group, 'increment', '= '//short(stage%increment)//' could make more than '// &
                     short(MAX_INCREMENTS)//' increments; use '//short(2.0_wp/MAX_INCREMENTS)//' or more.', fault)
      end if
   end subroutine read_steps

   !> "file:line: key sentence", where the key is given or its group begins.
   subroutine refuse(group, key, sentence, fault)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key, sentence
      type(fault_t), intent(inout) :: fault

      call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, key))//trim(key)//' '//sentence)
   end subroutine refuse

   !> Place of the word that a key gives in a list; the key must be there.
   subroutine read_word(group, key, words, place, fault)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key, words(:)
      integer, intent(out) :: place
      type(fault_t), intent(inout) :: fault
      character(LENGTH) :: word
      character(:), allocatable :: list

      list = joined(words, ', ')
      place = 0
      if (.not. given(group, key)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&'//trim(group%name)//' lacks '//key// &
                    ': one of '//list//'.')
         return
      end if
      word = ''
      call get_text(group, key, word)
      do place = 1, size(words)
         if (lower_case(word) == words(place)) return
      end do
      place = 0
      call refuse(group, key, '= '//trim(word)//' is unknown; the nearest is '// &
                  trim(words(nearest_name(word, words)))//' (one of '//list//').', fault)
   end subroutine read_word

   !> Reads cycles: by what, how many, how far. The stage is then led by the strain that is driven.
   subroutine read_cycles(k, stage, fault)
      type(key_table_t), intent(in) :: k
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: leads(:)
      integer :: kind

      if (.not. k%given('cycle_by')) return
      allocate (leads(0))   ! or gfortran believes the assignment to read it
      leads = leads_of(stage%control)
      call read_word(k%group, 'cycle_by', QUANTITIES(leads)%name, kind, fault)
      if (fault%code /= 0) return
      stage%cycle_by = leads(kind)
      stage%lead = leads(1)
      stage%has_centre = k%given('centre')
      if (.not. k%given('cycles')) then
         call refuse(k%group, 'cycle_by', 'needs cycles: '//k%about('cycles')//'.', fault)
      else if (.not. k%given('amplitude')) then
         call refuse(k%group, 'cycle_by', 'needs amplitude: '//k%about('amplitude')//'.', fault)
      else if (abs(stage%amplitude) <= 0.0_wp) then
         call refuse(k%group, 'amplitude', '= 0: there is nothing to do.', fault)
      end if
   end subroutine read_cycles

   !> Reads the quantity that leads a stage of one way, and its value at the end.
   subroutine read_lead(k, ends, stage, fault)
      type(key_table_t), intent(in) :: k
      real(wp), intent(in) :: ends(:)
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: leads(:)
      integer :: i

      allocate (leads(0))   ! or gfortran believes the assignment to read it
      leads = leads_of(stage%control)
      do i = 1, size(QUANTITIES)
         associate (key => QUANTITIES(i)%key)
            if (.not. k%given(trim(key)) .or. (i == BY_SUCTION .and. .not. any(leads == i))) cycle
            if (stage%cycles > 0) then
               call refuse(k%group, key, 'cannot be combined with cycles, which begin at the present state; remove '// &
                           'it.', fault)
            else if (stage%lead > 0) then
               call refuse(k%group, key, 'cannot be combined with '//trim(QUANTITIES(stage%lead)%key)// &
                           ': one of them ends the stage; remove the other.', fault)
            end if
            if (fault%code /= 0) return
            stage%lead = i
         end associate
      end do
      if (stage%control == LINEAR) stage%lead = BY_CHANGES
      if (any(leads == BY_SUCTION) .and. k%given('d_suction')) stage%lead = BY_SUCTION
      if (stage%lead == 0) then
         call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)//'a stage of control '// &
                    trim(CONTROL_NAMES(stage%control))//' needs '//lead_keys(stage%control)//': '// &
                    k%about(QUANTITIES(leads(1))%key)//'.')
         return
      end if

      call set_constraints(stage, stage%lead)
      stage%target = 1.0_wp
      if (stage%lead < BY_SUCTION) stage%target = ends(stage%lead)
      if (stage%lead == BY_CHANGES) then
         stage%changes = ends(BY_CHANGES:)
         do i = 1, ROWS
            if (any(abs([stage%strain_rows(:, i), stage%stress_rows(:, i)]) > 0.0_wp)) cycle
            call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)//'constraint '//whole(i)// &
                       ' of a linear stage is empty; give strain_'//whole(i)//' or stress_'//whole(i)//', six factors.')
            return
         end do
      end if
      if (any(stage%lead == [BY_D_EPS, BY_D_SIGMA]) .and. all(abs(stage%changes) <= 0.0_wp)) then
         call refuse(k%group, QUANTITIES(stage%lead)%key, 'has six zeros; give what changes.', fault)
      end if
   end subroutine read_lead

   !> Reads the path of suction.
   subroutine read_water(k, stage, fault)
      type(key_table_t), intent(in) :: k
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: key

      if (stage%keeps_air .and. .not. stage%keeps_water) then
         call refuse(k%group, 'air', '= constant needs water = ''constant'': water that leaves would take '// &
                     'dissolved air with it, and what closes the sample to air closes it to water.', fault)
         return
      end if
      stage%moves_suction = k%given('suction_end')
      stage%by_change = k%given('d_suction')
      if (stage%moves_suction .and. stage%by_change) then
         call refuse(k%group, 'd_suction', 'cannot be combined with suction_end; remove one of them.', fault)
         return
      end if
      stage%moves_suction = stage%moves_suction .or. stage%by_change
      key = trim(merge('d_suction  ', 'suction_end', stage%by_change))
      if (stage%moves_suction .and. stage%keeps_water) then
         call refuse(k%group, key, 'cannot be combined with a constant water content; remove one of them.', &
                     fault)
      else if (stage%moves_suction .and. stage%cycles > 0) then
         call refuse(k%group, key, 'cannot be combined with cycles; change the suction in a separate stage.', &
                     fault)
      end if
   end subroutine read_water
end module triax_stage_reader
