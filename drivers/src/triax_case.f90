! SPDX-License-Identifier: MIT
!> Case files: what a test is, read and checked before anything runs.
module triax_case
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: short, whole, LENGTH, PATH_LENGTH
   use namelists, only: group_t, read_groups, groups_of_text, set_entry
   use key_schema, only: key_t, check_group, refuse_idle_keys, place_of, get_text, line_of, UNBOUNDED
   use key_table, only: key_table_t, listing, reading
   use triax_control, only: CONTROL_TOLERANCE
   use triax_stage, only: test_stage_t
   use stress_units, only: stress_unit_t, KILOPASCAL
   use triax_stage_reader, only: read_stage
   use material_point, only: material_t
   use material_registry, only: new_material
   use parameter_groups, only: group_of_file
   use retention_curves, only: retention_t
   use retention_groups, only: new_retention, give_retention
   use triax_point, only: soil_t, point_t, start_point, restore_point, mean_stress, saturation, &
                          AXIAL, RADIAL
   implicit none (type, external)
   private
   public :: case_t, read_case, make_case, case_keys

   !> A test.
   type :: case_t
      character(PATH_LENGTH) :: file = ''
      character(LENGTH) :: name = '', title = '', material = ''
      type(soil_t) :: soil
      type(point_t) :: start
      type(test_stage_t), allocatable :: stages(:)
      real(wp) :: control_tolerance = CONTROL_TOLERANCE   !< Tolerance of what is held, relative.
      real(wp) :: accuracy = 0.0_wp      !< Relative error wanted in the histories; 0: none asked for.
      integer :: max_updates = huge(0)   !< The test stops after so many updates of the material.
   end type case_t

   !> Values of &initial as the group gives them.
   type :: initial_t
      real(wp) :: p = 0.0_wp, sigma_a = 0.0_wp, sigma_r = 0.0_wp   !< Effective or net stress [unit of the law].
      real(wp) :: suction = 0.0_wp                                 !< [unit of stress of the law]
      real(wp) :: void_ratio = 0.0_wp, s_w = 0.0_wp
      real(wp), allocatable :: six(:), state(:)   !< All stresses, or all state variables. (none or all)
   end type initial_t

   real(wp), parameter :: ATMOSPHERE = 101.325_wp   !< [kPa]
   real(wp), parameter :: SOFTEST_WATER = 1.0e4_wp  !< [kPa] A smaller bulk modulus is one in GPa or MPa.
   !> [kPa] Stress of a start: grains of sand crush long before.
   real(wp), parameter :: LEAST = 1.0e-6_wp, MOST = 5.0e4_wp
   real(wp), parameter :: ZERO = 0.0_wp, ONE = 1.0_wp
   character(*), parameter :: KPA = KILOPASCAL%name
   character(9), parameter :: GROUPS_OF_CASE(5) = [character(9) :: 'case', 'material', 'retention', 'initial', 'stage']
   character(*), parameter :: OF_AIR = ':air'   !< Condition of keys: a stage keeps the air.
   real(wp), parameter :: LIFTED = 1.0e-12_wp   !< Far above rounding: the library has raised the stress to p_min.
   real(wp), parameter :: ROUNDED = 1.0e-9_wp   !< Share of a stress by which a net stress may fall below zero.

contains
   !> Reads and checks a case with its material, and brings the sample to its start. Fault EXIT_INPUT: a file cannot be
   !> read; and as of make_case.
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
      type(group_t) :: own
      integer :: place

      call group_of_file(material, own, fault)
      if (fault%code /= 0) return
      place = findloc(groups%name, 'material', dim=1)
      if (place > 0) groups(place) = own
      if (place == 0) groups = [groups, own]
   end subroutine replace_material

   !> Checks the groups of a case with its material, and brings the sample to its start. Stresses are in the unit of the
   !> material. Fault EXIT_INPUT: a group is unknown, missing or given twice, a key or value is refused, or the law
   !> refuses the start.
   subroutine make_case(groups, file, test, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the case)
      character(*), intent(in) :: file   !< For messages, and for the name of the test.
      type(case_t), intent(out) :: test
      type(fault_t), intent(inout) :: fault
      type(key_table_t) :: table
      integer :: i, earlier, of_case, of_material, of_initial, n_stages

      test%file = file
      do i = 1, size(groups)
         earlier = findloc(groups(:i - 1)%name, groups(i)%name, dim=1)
         if (.not. any(groups(i)%name == GROUPS_OF_CASE)) then
            call raise(fault, EXIT_INPUT, at_line(file, groups(i)%line)//'there is no group &'//trim(groups(i)%name)// &
                       '; a case has &case, &material, &initial and one &stage or more, and may have &retention.')
         else if (earlier > 0 .and. groups(i)%name /= 'stage') then
            call raise(fault, EXIT_INPUT, at_line(file, groups(i)%line)//'&'//trim(groups(i)%name)// &
                       ' is given twice, first in line '//whole(groups(earlier)%line)//'; keep one of them.')
         end if
         if (fault%code /= 0) return
      end do
      of_case = findloc(groups%name, 'case', dim=1)
      of_material = findloc(groups%name, 'material', dim=1)
      of_initial = findloc(groups%name, 'initial', dim=1)
      n_stages = count(groups%name == 'stage')
      if (of_material == 0) then
         call raise(fault, EXIT_INPUT, trim(file)//': there is no &material; add one with file = ''...''.')
      else if (of_initial == 0) then
         call raise(fault, EXIT_INPUT, trim(file)//': there is no &initial; add one with p_eff and void_ratio.')
      else if (n_stages == 0) then
         call raise(fault, EXIT_INPUT, trim(file)//': there is no &stage; add one with control = ''...''.')
      end if
      if (fault%code /= 0) return
      call read_material(groups(of_material), findloc(groups%name, 'retention', dim=1), groups, test, fault)
      if (fault%code == 0) call check_keys(groups, test%soil%law%unit, fault)
      if (fault%code /= 0) return

      test%name = file(index(file, '/', back=.true.) + 1:)
      i = index(test%name, '.', back=.true.)
      if (i > 1) test%name = test%name(:i - 1)
      if (of_case > 0) then
         table = of_unit(reading(groups(of_case)), test%soil%law%unit)
         call read_settings(table, test)
      end if
      table = of_unit(reading(groups(of_initial)), test%soil%law%unit)
      call read_initial(table, test%soil, test%start, fault)
      if (fault%code /= 0) return
      allocate (test%stages(n_stages))
      n_stages = 0
      do i = 1, size(groups)
         if (groups(i)%name /= 'stage') cycle
         n_stages = n_stages + 1
         table = of_unit(reading(groups(i)), test%soil%law%unit)
         call read_stage(table, test%stages(n_stages), fault)
         if (fault%code /= 0) return
      end do
      if (.not. any(test%stages%keeps_air)) call refuse_keys_of_air(groups(of_initial), fault)
   end subroutine make_case

   !> Refuses what describes air that is kept, in a test whose air is free.
   subroutine refuse_keys_of_air(group, fault)
      type(group_t), intent(in) :: group   !< &initial
      type(fault_t), intent(inout) :: fault
      type(key_t), allocatable :: keys(:)
      integer :: i

      allocate (keys, source=case_keys(KILOPASCAL))
      do i = 1, group%count
         associate (key => keys(place_of(keys, group%name, group%entries(i)%key)))
            if (key%acts == OF_AIR) call raise(fault, EXIT_INPUT, at_line(group%file, group%entries(i)%line)// &
               trim(key%name)//' has no effect where no stage has air = ''constant'': the air is free; remove it.')
         end associate
      end do
   end subroutine refuse_keys_of_air

   !> The keys of a case but for those of materials and curves, with limits in a unit of stress.
   function case_keys(unit) result(keys)
      type(stress_unit_t), intent(in) :: unit
      type(key_t), allocatable :: keys(:)
      type(key_table_t) :: tables(3)
      type(case_t) :: nothing
      type(test_stage_t) :: no_stage
      type(fault_t) :: none

      ! one by one: gfortran 12 does not free what functions in an array constructor allocate
      tables(1) = of_unit(listing('case'), unit)
      tables(2) = of_unit(listing('initial'), unit)
      tables(3) = of_unit(listing('stage'), unit)
      call read_settings(tables(1), nothing)
      call read_initial(tables(2), nothing%soil, nothing%start, none)
      call read_stage(tables(3), no_stage, none)
      allocate (keys, source=[tables(1)%keys, tables(2)%keys, tables(3)%keys])
   end function case_keys

   !> A table whose group gives stresses in a unit.
   pure type(key_table_t) function of_unit(k, unit) result(table)
      type(key_table_t), intent(in) :: k
      type(stress_unit_t), intent(in) :: unit

      table = k
      table%stress = unit%name
      table%per_kpa = unit%factor
   end function of_unit

   !> Refuses unknown keys and values outside their range, which for stresses is in the unit of the material. Fault
   !> EXIT_INPUT, at the first.
   subroutine check_keys(groups, unit, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the case)
      type(stress_unit_t), intent(in) :: unit
      type(fault_t), intent(inout) :: fault
      type(key_t), allocatable :: keys(:)
      integer :: i

      allocate (keys, source=case_keys(unit))
      do i = 1, size(groups)
         if (any(keys%group == groups(i)%name)) call check_group(keys, groups(i), .false., fault)
      end do
   end subroutine check_keys

   subroutine read_settings(k, test)
      type(key_table_t), intent(inout) :: k
      type(case_t), intent(inout) :: test

      call k%text('name', test%name, 'name of the case and of its output; default: name of the file')
      call k%text('title', test%title, 'a line about the case')
      call k%number('control_tolerance', test%control_tolerance, 1.0e-12_wp, 1.0e-3_wp, &
                    'error allowed in prescribed stresses over the effective stress; default 1e-10')
      call k%number('accuracy', test%accuracy, 1.0e-8_wp, 0.5_wp, &
                    'relative error wanted in the histories; chooses increments and stress tolerance that are not '// &
                    'given')
      call k%whole('max_updates', test%max_updates, 1, 1000000000, &
                   'most updates of the material; then the test stops (for fits); default: no limit')
   end subroutine read_settings

   !> Makes the law of a case, with its retention curve.
   subroutine read_material(group, of_retention, groups, test, fault)
      type(group_t), intent(in) :: group
      integer, intent(in) :: of_retention   !< Among the groups; 0: none.
      type(group_t), intent(in) :: groups(:)
      type(case_t), intent(inout) :: test
      type(fault_t), intent(inout) :: fault
      class(material_t), allocatable :: law
      type(key_table_t) :: table
      class(retention_t), allocatable :: unused
      character(LENGTH) :: word

      word = 'mud'
      call get_text(group, 'law', word)
      call new_material(trim(word), group, law, test%material, fault)
      if (fault%code == 0 .and. of_retention > 0) then
         call give_retention(groups(of_retention), law, fault)
         table = listing('retention')
         call new_retention(table, unused, fault)
         if (fault%code == 0) call refuse_idle_keys(table%keys, groups(of_retention), fault)
      end if
      if (fault%code == 0) call move_alloc(law, test%soil%law)
   end subroutine read_material

   !> Makes the sample where a test begins, and its air and water. Fault EXIT_INPUT: keys contradict each other, the air
   !> pressure is below vacuum, or the law refuses the start.
   subroutine read_initial(k, soil, start, fault)
      type(key_table_t), intent(inout) :: k
      type(soil_t), intent(inout) :: soil
      type(point_t), intent(inout) :: start
      type(fault_t), intent(inout) :: fault
      type(initial_t) :: initial
      real(wp) :: p_a

      p_a = ZERO
      call k%number('p_eff', initial%p, LEAST, MOST, 'mean effective stress of an isotropic start', unit=KPA)
      call k%number('sigma_a', initial%sigma_a, LEAST, MOST, 'axial effective stress, with sigma_r, instead of p_eff', &
                    unit=KPA)
      call k%number('sigma_r', initial%sigma_r, LEAST, MOST, 'radial effective stress, with sigma_a', unit=KPA)
      call k%number('p_net', initial%p, ZERO, MOST, &
                    'mean net stress of an isotropic start, instead of p_eff: p'' is p_net + S_w suction', unit=KPA)
      call k%number('sigma_a_net', initial%sigma_a, ZERO, MOST, &
                    'axial net stress, with sigma_r_net, instead of p_eff', unit=KPA)
      call k%number('sigma_r_net', initial%sigma_r, ZERO, MOST, 'radial net stress, with sigma_a_net', unit=KPA)
      call k%numbers('stress', initial%six, -1.0e7_wp, 1.0e7_wp, &
                     'effective stresses 11, 22, 33, 12, 13, 23, instead of p_eff', unit=KPA, count=6)
      call k%number('void_ratio', initial%void_ratio, 0.01_wp, 5*ONE, 'void ratio')
      call k%number('suction', initial%suction, ZERO, 1.0e6_wp, 'p_a - p_w; default 0, saturated', unit=KPA)
      call k%number('saturation', initial%s_w, 1.0e-6_wp, ONE, 'degree of saturation between the main curves, with '// &
                    'hysteresis = 1; default: on the main drying curve')
      call k%number('air_pressure', p_a, -100*ONE, 1.0e5_wp, &
                    'air pressure above the atmosphere: back pressure; default 0', OF_AIR, unit=KPA)
      call k%number('henry', soil%air%henry, ZERO, 0.5_wp, 'volume of air that a volume of water dissolves, with '// &
                    'air = ''constant''; 0.02 at 20 C; default 0', OF_AIR)
      call k%number('k_w', soil%air%stiffness, ZERO, 1.0e9_wp, 'bulk modulus of the water, with '// &
                    'air = ''constant''; 2.2e6 kPa; default 0: incompressible', OF_AIR, unit=KPA)
      call k%numbers('state_variables', initial%state, -UNBOUNDED, UNBOUNDED, &
                     'all state variables of the law in their order, with stress, instead of void_ratio')
      if (k%lists) return
      call check_initial(k, initial%s_w, fault)
      if (fault%code == 0) call start_sample(k, initial, soil, start, fault)
      start%p_a = p_a
      soil%air%atmosphere = ATMOSPHERE*k%per_kpa
      if (soil%air%stiffness > ZERO .and. soil%air%stiffness < SOFTEST_WATER*k%per_kpa) call raise(fault, EXIT_INPUT, &
         at_line(k%group%file, line_of(k%group, 'k_w'))//'k_w = '//short(soil%air%stiffness)//' '//trim(k%stress)// &
         ' is no bulk modulus of water, which is '//short(2.2e6_wp*k%per_kpa)//' '//trim(k%stress)// &
         '; 0 is incompressible.')
      if (.not. soil%air%atmosphere + p_a > 0.0_wp) call raise(fault, EXIT_INPUT, at_line(k%group%file, &
         line_of(k%group, 'air_pressure'))//'air_pressure = '//short(p_a)//' is below vacuum: it counts from the '// &
         'atmosphere, and must exceed '//short(-soil%air%atmosphere)//' '//trim(k%stress)//'.')
   end subroutine read_initial

   !> Refuses a stress that is missing or given in two ways, and a state that is. Fault EXIT_INPUT.
   subroutine check_initial(k, s_w, fault)
      type(key_table_t), intent(in) :: k
      real(wp), intent(in) :: s_w
      type(fault_t), intent(inout) :: fault
      logical :: effective, net, axial, radial, restored
      character(:), allocatable :: place

      place = at_line(k%group%file, k%group%line)
      effective = k%given('p_eff') .or. k%given('sigma_a') .or. k%given('sigma_r')
      net = k%given('p_net') .or. k%given('sigma_a_net') .or. k%given('sigma_r_net')
      axial = k%given('sigma_a') .or. k%given('sigma_a_net')
      radial = k%given('sigma_r') .or. k%given('sigma_r_net')
      restored = k%given('state_variables')
      if (net .and. effective) then
         call raise(fault, EXIT_INPUT, place//'&initial takes the effective stress or the net stress, not both.')
      else if (.not. (k%given('void_ratio') .or. restored)) then
         call raise(fault, EXIT_INPUT, place//'&initial lacks void_ratio ('//k%about('void_ratio')//').')
      else if (restored .and. (k%given('void_ratio') .or. s_w > 0.0_wp .or. .not. k%given('stress'))) then
         call raise(fault, EXIT_INPUT, at_line(k%group%file, line_of(k%group, 'state_variables'))// &
                    'state_variables needs stress, and takes the place of void_ratio and saturation; give these '// &
                    'two alone.')
      else if (count([k%given('p_eff') .or. k%given('p_net'), axial .or. radial, k%given('stress')]) /= 1) then
         call raise(fault, EXIT_INPUT, place//'&initial needs the stress once: either p_eff, or sigma_a and '// &
                    'sigma_r, or stress (six values), or p_net, or sigma_a_net and sigma_r_net.')
      else if (axial .neqv. radial) then
         call raise(fault, EXIT_INPUT, place//'&initial needs the axial and the radial stress together.')
      end if
   end subroutine check_initial

   !> Makes the sample under its stress. Fault EXIT_INPUT: the law refuses the start, or no laboratory can make it.
   subroutine start_sample(k, initial, soil, start, fault)
      type(key_table_t), intent(in) :: k
      type(initial_t), intent(in) :: initial
      type(soil_t), intent(in) :: soil
      type(point_t), intent(out) :: start
      type(fault_t), intent(inout) :: fault
      real(wp) :: stress(6), mean
      character(:), allocatable :: place, name
      logical :: isotropic

      place = at_line(k%group%file, k%group%line)
      isotropic = k%given('p_eff') .or. k%given('p_net')
      stress = 0.0_wp
      stress(AXIAL) = merge(initial%p, initial%sigma_a, isotropic)
      stress(RADIAL) = merge(initial%p, initial%sigma_r, isotropic)
      if (k%given('stress')) stress = initial%six
      if (k%given('state_variables')) then
         call restore_point(soil, stress, initial%suction, initial%state, start, fault)
         if (fault%code /= 0) fault%text = place//fault%text
         return   ! what its history left, whatever that is
      end if
      if (k%given('p_net') .or. k%given('sigma_a_net')) then
         ! S_w knows no stress: a sample at any stress tells it.
         call start_point(soil, suction_stress(stress, initial%suction), initial%suction, initial%void_ratio, &
                          initial%s_w, start, fault)
         if (fault%code == 0) stress = suction_stress(stress, saturation(soil, start)*initial%suction)
      end if
      if (fault%code == 0) call start_point(soil, stress, initial%suction, initial%void_ratio, initial%s_w, start, &
                                            fault)
      mean = sum(stress(1:3))/3.0_wp
      name = ' '//trim(k%stress)
      if (fault%code /= 0) then
         fault%text = place//fault%text
      else if (mean_stress(start) > (1.0_wp + LIFTED)*mean) then
         call raise(fault, EXIT_INPUT, place//'the mean effective stress is '//short(mean)//name//', below p_min '// &
                    'of the material, '//short(mean_stress(start))//name//'; raise the one or lower the other.')
      else if (.not. k%given('stress')) then
         call refuse_tension(k%group, soil, start, fault)
      end if
   end subroutine start_sample

   !> Stress with a pressure added to its normal components. [unit of stress]
   pure function suction_stress(stress, pressure) result(total)
      real(wp), intent(in) :: stress(6), pressure
      real(wp) :: total(6)

      total = stress
      total(1:3) = stress(1:3) + pressure
   end function suction_stress

   !> A start that no laboratory can make: tension in the net stress. What the law cannot begin with it refuses itself.
   subroutine refuse_tension(group, soil, start, fault)
      type(group_t), intent(in) :: group
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: start
      type(fault_t), intent(inout) :: fault
      real(wp) :: least, most, bound

      least = minval(start%stress(1:3))
      most = maxval(start%stress(1:3))
      bound = saturation(soil, start)*start%suction
      if (least - bound < -ROUNDED*most) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the net stress sigma'' - S_w p_c is '// &
                    short(least - bound)//' '//trim(soil%law%unit%name)//', tension: at S_w '// &
                    short(saturation(soil, start))//' the suction alone makes an effective stress of '// &
                    short(bound)//'; give at least that, or the net stress (p_net).')
      end if
   end subroutine refuse_tension
end module triax_case
