! SPDX-License-Identifier: MIT
!> Stages of a case from their groups.
module triax_stage_reader
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: lower_case, short, whole, LENGTH
   use namelists, only: group_t
   use stress_units, only: stress_unit_t
   use spelling, only: nearest_name
   use key_schema, only: describe_key, get_text, get_number, get_numbers, line_of, given, word_is
   use triax_keys, only: CASE_KEYS, keys_in
   use triax_stage, only: test_stage_t, set_constraints, leads_of, keeps_volume, CONTROL_NAMES, QUANTITIES, LINEAR, &
                          BY_EPS_A, BY_GAMMA, BY_SUCTION, BY_D_EPS, BY_D_SIGMA, BY_CHANGES, PER_PRESSURE, ROWS
   implicit none (type, external)
   private
   public :: read_stage

   !> Defaults by the unit of what leads (PER_*), suction apart; stresses in kPa, converted to the unit of the material.
   real(wp), parameter :: INCREMENTS(3) = [1.0e-4_wp, 1.0_wp, 1.0e-3_wp]
   real(wp), parameter :: INTERVALS(3) = [1.0e-3_wp, 10.0_wp, 1.0e-2_wp]
   real(wp), parameter :: SUCTION_INCREMENT = 0.1_wp, SUCTION_INTERVAL = 1.0_wp   ! [kPa]
   real(wp), parameter :: MAX_INCREMENTS = 1.0e8_wp
contains
   !> A stage from its group, whose entries were checked. Fault EXIT_INPUT: a control or word is unknown, or keys are
   !> missing, contradict each other or have no effect.
   subroutine read_stage(group, unit, stage, fault)
      type(group_t), intent(in) :: group
      type(stress_unit_t), intent(in) :: unit   !< Unit of stress of the material.
      type(test_stage_t), intent(out) :: stage
      type(fault_t), intent(inout) :: fault
      logical :: found

      stage%line = group%line
      call read_control(group, stage, fault)
      if (fault%code == 0) call read_cycles(group, stage, fault)
      if (fault%code == 0) call read_lead(group, unit, stage, fault)
      if (fault%code == 0) call read_water(group, stage, fault)
      if (fault%code /= 0) return

      if (stage%lead == BY_SUCTION) then
         stage%increment = SUCTION_INCREMENT
         stage%interval = SUCTION_INTERVAL
      else
         stage%increment = INCREMENTS(QUANTITIES(stage%lead)%unit)
         stage%interval = INTERVALS(QUANTITIES(stage%lead)%unit)
      end if
      if (QUANTITIES(stage%lead)%unit == PER_PRESSURE) then
         stage%increment = stage%increment*unit%factor
         stage%interval = stage%interval*unit%factor
      end if
      stage%suction_increment = SUCTION_INCREMENT*unit%factor
      stage%suction_interval = SUCTION_INTERVAL*unit%factor
      call get_number(group, 'increment', stage%increment, stage%given_increment)
      if (stage%given_increment .and. QUANTITIES(stage%lead)%unit == PER_PRESSURE) &
         stage%suction_increment = stage%increment
      call get_number(group, 'output_interval', stage%interval, found)
      if (found .and. QUANTITIES(stage%lead)%unit == PER_PRESSURE) stage%suction_interval = stage%interval
      call get_number(group, 'stop_r_u', stage%stop_r_u, found)
      if (found .and. .not. (keeps_volume(stage%control) .or. stage%keeps_air)) then
         call refuse(group, 'stop_r_u', 'has no effect with control '//name_of(stage%control)// &
                     ', in which no pore pressure builds up; remove it.', fault)
      else if (2.0_wp/stage%increment > MAX_INCREMENTS .and. QUANTITIES(stage%lead)%unit /= PER_PRESSURE) then
         call refuse(group, 'increment', '= '//short(stage%increment)//' could make more than '// &
                     short(MAX_INCREMENTS)//' increments; use '//short(2.0_wp/MAX_INCREMENTS)//' or more.', fault)
      end if
   end subroutine read_stage

   !> "file:line: key sentence", where the key is given or its group begins.
   subroutine refuse(group, key, sentence, fault)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key, sentence
      type(fault_t), intent(inout) :: fault

      call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, key))//trim(key)//' '//sentence)
   end subroutine refuse

   function name_of(control) result(name)
      integer, intent(in) :: control
      character(:), allocatable :: name

      name = trim(CONTROL_NAMES(control))
   end function name_of

   !> Place of the word that a key gives in a list; the key must be there.
   subroutine read_word(group, key, words, place, fault)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key, words(:)
      integer, intent(out) :: place
      type(fault_t), intent(inout) :: fault
      character(LENGTH) :: word
      character(:), allocatable :: list
      integer :: i

      list = trim(words(1))
      do i = 2, size(words)
         list = list//', '//trim(words(i))
      end do
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

   subroutine read_control(group, stage, fault)
      type(group_t), intent(in) :: group
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault

      call read_word(group, 'control', CONTROL_NAMES, stage%control, fault)
      stage%effective = word_is(CASE_KEYS, group, 'stress', 'effective')
   end subroutine read_control

   !> Cycles: by what, how many, how far. The stage is then led by the strain that is driven.
   subroutine read_cycles(group, stage, fault)
      type(group_t), intent(in) :: group
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: OF_CYCLES(4) = [character(21) :: 'cycles', 'amplitude', 'centre', &
                                                 'stop_double_amplitude']
      integer, allocatable :: leads(:)
      real(wp) :: cycles
      integer :: kind, i
      logical :: has_cycles, has_amplitude, found

      if (.not. given(group, 'cycle_by')) then
         do i = 1, size(OF_CYCLES)
            if (given(group, trim(OF_CYCLES(i)))) then
               call refuse(group, OF_CYCLES(i), 'needs cycle_by: '// &
                           describe_key(CASE_KEYS, 'stage', 'cycle_by')//'.', fault)
            end if
         end do
         return
      end if
      allocate (leads(0))   ! or gfortran believes the assignment to read it
      leads = leads_of(stage%control)
      if (.not. any(leads == BY_EPS_A .or. leads == BY_GAMMA)) then
         call refuse(group, 'cycle_by', 'has no effect with control '//name_of(stage%control)// &
                     '; cycles run in drained, undrained, constant_p and in simple shear.', fault)
         return
      end if
      call read_word(group, 'cycle_by', QUANTITIES(leads)%name, kind, fault)
      if (fault%code /= 0) return
      stage%cycle_by = leads(kind)
      stage%lead = leads(1)
      cycles = 0.0_wp
      call get_number(group, 'cycles', cycles, has_cycles)
      call get_number(group, 'amplitude', stage%amplitude, has_amplitude)
      call get_number(group, 'centre', stage%centre, stage%has_centre)
      call get_number(group, 'stop_double_amplitude', stage%stop_double_amplitude, found)
      stage%cycles = nint(cycles)
      if (.not. has_cycles) then
         call refuse(group, 'cycle_by', 'needs cycles: '//describe_key(CASE_KEYS, 'stage', 'cycles')//'.', fault)
      else if (.not. has_amplitude) then
         call refuse(group, 'cycle_by', 'needs amplitude: '//describe_key(CASE_KEYS, 'stage', 'amplitude')//'.', fault)
      else if (abs(stage%amplitude) <= 0.0_wp) then
         call refuse(group, 'amplitude', '= 0: there is nothing to do.', fault)
      end if
   end subroutine read_cycles

   !> Reads the quantity that leads a stage of one way, and its value at the end.
   subroutine read_lead(group, unit, stage, fault)
      type(group_t), intent(in) :: group
      type(stress_unit_t), intent(in) :: unit
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: leads(:)
      character(:), allocatable :: choice
      integer :: i
      logical :: found

      allocate (leads(0))   ! or gfortran believes the assignment to read it
      leads = leads_of(stage%control)
      choice = trim(QUANTITIES(leads(1))%key)
      do i = 2, size(leads)
         choice = choice//' or '//trim(QUANTITIES(leads(i))%key)
      end do
      do i = 1, size(QUANTITIES)
         associate (key => QUANTITIES(i)%key)
            if (.not. given(group, key) .or. (i == BY_SUCTION .and. .not. any(leads == i))) cycle
            if (stage%cycles > 0) then
               call refuse(group, key, 'cannot be combined with cycles, which begin at the present state; remove it.', &
                           fault)
            else if (.not. any(leads == i)) then
               call refuse(group, key, 'has no effect with control '//name_of(stage%control)// &
                           ', which takes '//choice//'; remove it.', fault)
            else if (stage%lead > 0) then
               call refuse(group, key, 'cannot be combined with '//trim(QUANTITIES(stage%lead)%key)// &
                           ': one of them ends the stage; remove the other.', fault)
            end if
            if (fault%code /= 0) return
            stage%lead = i
         end associate
      end do
      if (stage%control == LINEAR) stage%lead = BY_CHANGES
      if (stage%lead == 0) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a stage of control '// &
                    name_of(stage%control)//' needs '//choice//': '// &
                    describe_key(keys_in(unit), 'stage', QUANTITIES(leads(1))%key)//'.')
         return
      end if

      call set_constraints(stage, stage%lead)
      stage%target = 1.0_wp
      select case (stage%lead)
      case (BY_D_EPS)
         call get_numbers(group, 'd_eps', stage%changes)
      case (BY_D_SIGMA)
         call get_numbers(group, 'd_sigma', stage%changes)
      case (BY_CHANGES)
         do i = 1, ROWS
            call get_numbers(group, 'strain_'//whole(i), stage%strain_rows(:, i))
            call get_numbers(group, 'stress_'//whole(i), stage%stress_rows(:, i))
            call get_number(group, 'change_'//whole(i), stage%changes(i), found)
            if (all(abs([stage%strain_rows(:, i), stage%stress_rows(:, i)]) <= 0.0_wp)) then
               call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'constraint '//whole(i)// &
                          ' of a linear stage is empty; give strain_'//whole(i)//' or stress_'//whole(i)// &
                          ', six factors.')
               return
            end if
         end do
      case default
         call get_number(group, QUANTITIES(stage%lead)%key, stage%target, found)
      end select
      if (any(stage%lead == [BY_D_EPS, BY_D_SIGMA]) .and. all(abs(stage%changes) <= 0.0_wp)) then
         call refuse(group, QUANTITIES(stage%lead)%key, 'has six zeros; give what changes.', fault)
      end if
   end subroutine read_lead

   !> The path of suction.
   subroutine read_water(group, stage, fault)
      type(group_t), intent(in) :: group
      type(test_stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: key

      stage%keeps_water = word_is(CASE_KEYS, group, 'water', 'constant')
      stage%keeps_air = word_is(CASE_KEYS, group, 'air', 'constant')
      if (stage%keeps_air .and. .not. stage%keeps_water) then
         call refuse(group, 'air', '= constant needs water = ''constant'': water that leaves would take dissolved '// &
                     'air with it, and what closes the sample to air closes it to water.', fault)
         return
      end if
      call get_number(group, 'suction_end', stage%suction_end, stage%moves_suction)
      call get_number(group, 'd_suction', stage%suction_change, stage%by_change)
      if (stage%moves_suction .and. stage%by_change) then
         call refuse(group, 'd_suction', 'cannot be combined with suction_end; remove one of them.', fault)
         return
      else if (stage%by_change .and. stage%lead == BY_SUCTION) then
         call refuse(group, 'd_suction', 'has no effect with control '//name_of(stage%control)// &
                     ', which takes suction_end; remove it.', fault)
         return
      end if
      stage%moves_suction = stage%moves_suction .or. stage%by_change
      key = trim(merge('d_suction  ', 'suction_end', stage%by_change))
      if (stage%moves_suction .and. stage%keeps_water) then
         call refuse(group, key, 'cannot be combined with a constant water content; remove one of them.', &
                     fault)
      else if (stage%moves_suction .and. stage%cycles > 0) then
         call refuse(group, key, 'cannot be combined with cycles; change the suction in a separate stage.', &
                     fault)
      end if
   end subroutine read_water
end module triax_stage_reader
