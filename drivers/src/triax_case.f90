! SPDX-License-Identifier: MIT
!> Case files: what a test is, read and checked before anything runs.
module triax_case
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: lower_case, short, whole
   use namelists, only: group_t, read_groups, groups_of_text, set_entry, LENGTH
   use spelling, only: nearest_name
   use key_schema, only: check_entries, describe_key, get_text, get_number, get_numbers, line_of, given, word_is
   use triax_keys, only: CASE_KEYS
   use triax_control, only: CONTROL_TOLERANCE
   use triax_stage, only: stage_t, set_constraints, leads_of, sealed_control, CONTROL_NAMES, QUANTITIES, LINEAR, &
                          BY_EPS_A, BY_GAMMA, BY_SUCTION, BY_D_EPS, BY_D_SIGMA, BY_CHANGES, PER_PRESSURE, ROWS
   use material_point, only: material_t
   use material_registry, only: new_material
   use retention_groups, only: give_retention, RETENTION_KEYS
   use triax_point, only: soil_t, point_t, make_soil, start_point, mean_stress, AXIAL, RADIAL
   implicit none (type, external)
   private
   public :: case_t, read_case, make_case

   !> A test.
   type :: case_t
      character(LENGTH) :: file = '', name = '', title = '', material = ''
      type(soil_t) :: soil
      type(point_t) :: start
      type(stage_t), allocatable :: stages(:)
      real(wp) :: control_tolerance = CONTROL_TOLERANCE   !< Of what is held, relative.
      real(wp) :: accuracy = 0.0_wp      !< Relative error wanted in the histories; 0: none asked for.
      integer :: max_updates = huge(0)   !< The test stops after so many updates of the material.
   end type case_t

   !> Defaults by the unit of what leads (PER_*), suction apart.
   real(wp), parameter :: INCREMENTS(3) = [1.0e-4_wp, 1.0_wp, 1.0e-3_wp]
   real(wp), parameter :: INTERVALS(3) = [1.0e-3_wp, 10.0_wp, 1.0e-2_wp]
   real(wp), parameter :: SUCTION_INCREMENT = 0.1_wp, SUCTION_INTERVAL = 1.0_wp   ! [kPa]
   real(wp), parameter :: LIFTED = 1.0e-12_wp   !< Far above rounding: the library has raised the stress to p_min.
   real(wp), parameter :: MAX_INCREMENTS = 1.0e8_wp

contains
   !> Reads and checks a case with its material, and brings the sample to its start.
   subroutine read_case(file, material, accuracy, test, fault)
      character(*), intent(in) :: file
      character(*), intent(in) :: material   !< File of a material that replaces that of the case; blank: none.
      character(*), intent(in) :: accuracy   !< In place of that of the case; blank: none.
      type(case_t), intent(out) :: test
      type(fault_t), intent(inout) :: fault
      type(group_t), allocatable :: groups(:)

      call read_groups(file, groups, fault)
      if (fault%code == 0 .and. material /= '') call replace_material(material, groups, fault)
      if (fault%code == 0 .and. accuracy /= '') call ask_accuracy(accuracy, groups)
      if (fault%code == 0) call make_case(groups, file, test, fault)
   end subroutine read_case

   !> The accuracy of the command line, as if the case said it.
   subroutine ask_accuracy(accuracy, groups)
      character(*), intent(in) :: accuracy
      type(group_t), allocatable, intent(inout) :: groups(:)
      type(group_t), allocatable :: own(:)
      type(fault_t) :: none
      integer :: place

      place = findloc(groups%name, 'case', dim=1)
      if (place == 0) then
         call groups_of_text('&case /', '--accuracy', own, none)
         groups = [groups, own]
         place = size(groups)
      end if
      call set_entry(groups(place), 'accuracy', accuracy)
   end subroutine ask_accuracy

   !> The first &material of a case becomes a file; a case without one gets it.
   subroutine replace_material(material, groups, fault)
      character(*), intent(in) :: material   !< Path from the present folder, not from that of the case.
      type(group_t), allocatable, intent(inout) :: groups(:)
      type(fault_t), intent(inout) :: fault
      type(group_t), allocatable :: own(:)
      integer :: place

      call groups_of_text('&material file = "'//trim(material)//'" /', '', own, fault)
      if (fault%code /= 0) return
      own(1)%file = ''
      place = findloc(groups%name, 'material', dim=1)
      if (place > 0) groups(place) = own(1)
      if (place == 0) groups = [groups, own]
   end subroutine replace_material

   !> Checks the groups of a case with its material, and brings the sample to its start.
   subroutine make_case(groups, file, test, fault)
      type(group_t), intent(in) :: groups(:)
      character(*), intent(in) :: file
      type(case_t), intent(out) :: test
      type(fault_t), intent(inout) :: fault
      class(material_t), allocatable :: law
      character(LENGTH) :: word
      integer :: i, of_case, of_material, of_retention, of_initial, n_stages
      real(wp) :: number
      logical :: found

      test%file = file
      of_case = 0
      of_material = 0
      of_retention = 0
      of_initial = 0
      n_stages = 0
      do i = 1, size(groups)
         select case (groups(i)%name)
         case ('case')
            call only_once(file, groups, i, of_case, fault)
         case ('material')
            call only_once(file, groups, i, of_material, fault)
         case ('retention')
            call only_once(file, groups, i, of_retention, fault)
            if (fault%code == 0) call check_entries(RETENTION_KEYS, groups(i), .false., fault)
         case ('initial')
            call only_once(file, groups, i, of_initial, fault)
         case ('stage')
            n_stages = n_stages + 1
         case default
            call raise(fault, EXIT_INPUT, at_line(file, groups(i)%line)//'there is no group &'//trim(groups(i)%name)// &
                       '; a case has &case, &material, &initial and one &stage or more, and may have &retention.')
         end select
         if (fault%code == 0 .and. any(CASE_KEYS%group == groups(i)%name)) &
            call check_entries(CASE_KEYS, groups(i), .false., fault)
         if (fault%code /= 0) return
      end do
      if (of_material == 0) then
         call raise(fault, EXIT_INPUT, trim(file)//': there is no &material; add one with file = ''...''.')
      else if (of_initial == 0) then
         call raise(fault, EXIT_INPUT, trim(file)//': there is no &initial; add one with p_eff and void_ratio.')
      else if (n_stages == 0) then
         call raise(fault, EXIT_INPUT, trim(file)//': there is no &stage; add one with control = ''...''.')
      end if
      if (fault%code /= 0) return

      test%name = file(index(file, '/', back=.true.) + 1:)
      i = index(test%name, '.', back=.true.)
      if (i > 1) test%name = test%name(:i - 1)
      if (of_case > 0) then
         call get_text(groups(of_case), 'name', test%name)
         call get_text(groups(of_case), 'title', test%title)
         call get_number(groups(of_case), 'control_tolerance', test%control_tolerance, found)
         call get_number(groups(of_case), 'accuracy', test%accuracy, found)
         number = 0.0_wp
         call get_number(groups(of_case), 'max_updates', number, found)
         if (found) test%max_updates = nint(number)
      end if

      word = 'mud'
      call get_text(groups(of_material), 'law', word)
      call new_material(trim(word), groups(of_material), law, test%material, fault)
      if (fault%code == 0 .and. of_retention > 0) call give_retention(groups(of_retention), law, fault)
      if (fault%code /= 0) return
      call make_soil(law, test%soil)
      call read_initial(groups(of_initial), test%soil, test%start, fault)
      if (fault%code /= 0) return
      allocate (test%stages(n_stages))
      n_stages = 0
      do i = 1, size(groups)
         if (groups(i)%name /= 'stage') cycle
         n_stages = n_stages + 1
         call read_stage(groups(i), test%stages(n_stages), fault)
         if (fault%code /= 0) return
      end do
   end subroutine make_case

   subroutine only_once(file, groups, i, place, fault)
      character(*), intent(in) :: file
      type(group_t), intent(in) :: groups(:)
      integer, intent(in) :: i
      integer, intent(inout) :: place
      type(fault_t), intent(inout) :: fault

      if (place > 0) then
         call raise(fault, EXIT_INPUT, at_line(file, groups(i)%line)//'&'//trim(groups(i)%name)// &
                    ' is given twice, first in line '//whole(groups(place)%line)//'; keep one of them.')
      end if
      place = i
   end subroutine only_once

   subroutine read_initial(group, soil, start, fault)
      type(group_t), intent(in) :: group
      type(soil_t), intent(in) :: soil
      type(point_t), intent(out) :: start
      type(fault_t), intent(inout) :: fault
      real(wp) :: p_eff, sigma_a, sigma_r, ratio, suction, stress(6)
      logical :: has_p, has_a, has_r, found

      p_eff = 0.0_wp
      sigma_a = 0.0_wp
      sigma_r = 0.0_wp
      suction = 0.0_wp
      ratio = 0.0_wp
      call get_number(group, 'p_eff', p_eff, has_p)
      call get_number(group, 'sigma_a', sigma_a, has_a)
      call get_number(group, 'sigma_r', sigma_r, has_r)
      call get_number(group, 'suction', suction, found)
      call get_number(group, 'void_ratio', ratio, found)
      if (.not. found) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&initial lacks void_ratio ('// &
                    describe_key(CASE_KEYS, 'initial', 'void_ratio')//').')
      else if (has_p .eqv. (has_a .or. has_r)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
                    '&initial needs the stress once: either p_eff, or sigma_a and sigma_r.')
      else if (has_a .neqv. has_r) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&initial needs sigma_a and sigma_r together.')
      end if
      if (fault%code /= 0) return

      stress = 0.0_wp
      stress(AXIAL) = merge(p_eff, sigma_a, has_p)
      stress(RADIAL) = merge(p_eff, sigma_r, has_p)
      call start_point(soil, stress, suction, ratio, start, fault)
      if (fault%code /= 0) then
         fault%text = at_line(group%file, group%line)//fault%text
      else if (mean_stress(start) > (1.0_wp + LIFTED)*sum(stress(1:3))/3.0_wp) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the mean effective stress is '// &
                    short(sum(stress(1:3))/3.0_wp)//' kPa, below p_min of the material, '//short(mean_stress(start))// &
                    ' kPa; raise the one or lower the other.')
      end if
   end subroutine read_initial

   subroutine read_stage(group, stage, fault)
      type(group_t), intent(in) :: group
      type(stage_t), intent(out) :: stage
      type(fault_t), intent(inout) :: fault
      logical :: found

      stage%line = group%line
      call read_control(group, stage, fault)
      if (fault%code == 0) call read_cycles(group, stage, fault)
      if (fault%code == 0) call read_lead(group, stage, fault)
      if (fault%code == 0) call read_water(group, stage, fault)
      if (fault%code /= 0) return

      if (stage%lead == BY_SUCTION) then
         stage%increment = SUCTION_INCREMENT
         stage%interval = SUCTION_INTERVAL
      else
         stage%increment = INCREMENTS(QUANTITIES(stage%lead)%unit)
         stage%interval = INTERVALS(QUANTITIES(stage%lead)%unit)
      end if
      call get_number(group, 'increment', stage%increment, stage%given_increment)
      call get_number(group, 'output_interval', stage%interval, found)
      call get_number(group, 'stop_r_u', stage%stop_r_u, found)
      if (found .and. .not. sealed_control(stage%control)) then
         call refuse(group, 'stop_r_u', 'means nothing in a stage of control '//name_of(stage%control)// &
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
      type(stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault

      call read_word(group, 'control', CONTROL_NAMES, stage%control, fault)
      stage%effective = word_is(CASE_KEYS, group, 'stress', 'effective')
   end subroutine read_control

   !> Cycles: by what, how many, how far. The stage is then led by the strain that is driven.
   subroutine read_cycles(group, stage, fault)
      type(group_t), intent(in) :: group
      type(stage_t), intent(inout) :: stage
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
         call refuse(group, 'cycle_by', 'means nothing in a stage of control '//name_of(stage%control)// &
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

   !> What leads a stage of one way, and where to.
   subroutine read_lead(group, stage, fault)
      type(group_t), intent(in) :: group
      type(stage_t), intent(inout) :: stage
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
               call refuse(group, key, 'cannot go with cycles, which begin where the stage before ends; remove it.', &
                           fault)
            else if (.not. any(leads == i)) then
               call refuse(group, key, 'means nothing in a stage of control '//name_of(stage%control)// &
                           ', which is led by '//choice//'; remove it.', fault)
            else if (stage%lead > 0) then
               call refuse(group, key, 'leads the stage together with '//trim(QUANTITIES(stage%lead)%key)// &
                           '; keep one of them.', fault)
            end if
            if (fault%code /= 0) return
            stage%lead = i
         end associate
      end do
      if (stage%control == LINEAR) stage%lead = BY_CHANGES
      if (stage%lead == 0) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a stage of control '// &
                    name_of(stage%control)//' needs '//choice//': '// &
                    describe_key(CASE_KEYS, 'stage', QUANTITIES(leads(1))%key)//'.')
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
      type(stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault

      stage%keeps_water = word_is(CASE_KEYS, group, 'water', 'constant')
      call get_number(group, 'suction_end', stage%suction_end, stage%moves_suction)
      if (stage%moves_suction .and. stage%keeps_water) then
         call refuse(group, 'suction_end', 'cannot go with a constant water content; remove one of them.', fault)
      else if (stage%moves_suction .and. stage%cycles > 0) then
         call refuse(group, 'suction_end', 'cannot go with cycles; move suction in a stage of its own.', fault)
      end if
   end subroutine read_water
end module triax_case
