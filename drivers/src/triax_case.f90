! SPDX-License-Identifier: MIT
!> Case files: what a test is, read and checked before anything runs.
module triax_case
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: short, whole, LENGTH
   use namelists, only: group_t, read_groups, groups_of_text, set_entry, find_entry
   use key_schema, only: check_entries, describe_key, get_text, get_number, get_numbers, given, line_of
   use triax_keys, only: CASE_KEYS, check_keys
   use triax_control, only: CONTROL_TOLERANCE
   use triax_stage, only: test_stage_t
   use triax_stage_reader, only: read_stage
   use material_point, only: material_t
   use material_registry, only: new_material
   use retention_groups, only: give_retention, RETENTION_KEYS
   use triax_point, only: soil_t, point_t, make_soil, start_point, restore_point, mean_stress, saturation, &
                          AXIAL, RADIAL
   implicit none (type, external)
   private
   public :: case_t, read_case, make_case

   !> A test.
   type :: case_t
      character(LENGTH) :: file = '', name = '', title = '', material = ''
      type(soil_t) :: soil
      type(point_t) :: start
      type(test_stage_t), allocatable :: stages(:)
      real(wp) :: control_tolerance = CONTROL_TOLERANCE   !< Tolerance of what is held, relative.
      real(wp) :: accuracy = 0.0_wp      !< Relative error wanted in the histories; 0: none asked for.
      integer :: max_updates = huge(0)   !< The test stops after so many updates of the material.
   end type case_t

   real(wp), parameter :: ATMOSPHERE = 101.325_wp   !< [kPa]
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
      type(group_t), allocatable :: own(:)
      integer :: place

      call groups_of_text('&material file = "'//trim(material)//'" /', '', own, fault)
      if (fault%code /= 0) return
      own(1)%file = ''
      place = findloc(groups%name, 'material', dim=1)
      if (place > 0) groups(place) = own(1)
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
      call read_material(groups(of_material), of_retention, groups, test, fault)
      if (fault%code == 0) call check_keys(groups, test%soil%law%unit, fault)
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

      call read_initial(groups(of_initial), test%soil, test%start, fault)
      if (fault%code == 0) call read_air(groups(of_initial), test%soil, test%start%p_a, fault)
      if (fault%code /= 0) return
      allocate (test%stages(n_stages))
      n_stages = 0
      do i = 1, size(groups)
         if (groups(i)%name /= 'stage') cycle
         n_stages = n_stages + 1
         call read_stage(groups(i), test%soil%law%unit, test%stages(n_stages), fault)
         if (fault%code /= 0) return
      end do
   end subroutine make_case

   !> The law of a case, with its retention curve.
   subroutine read_material(group, of_retention, groups, test, fault)
      type(group_t), intent(in) :: group
      integer, intent(in) :: of_retention   !< Among the groups; 0: none.
      type(group_t), intent(in) :: groups(:)
      type(case_t), intent(inout) :: test
      type(fault_t), intent(inout) :: fault
      class(material_t), allocatable :: law
      character(LENGTH) :: word

      word = 'mud'
      call get_text(group, 'law', word)
      call new_material(trim(word), group, law, test%material, fault)
      if (fault%code == 0 .and. of_retention > 0) call give_retention(groups(of_retention), law, fault)
      if (fault%code == 0) call make_soil(law, test%soil)
   end subroutine read_material

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
      real(wp) :: p_eff, sigma_a, sigma_r, ratio, suction, s_w, stress(6)
      real(wp), allocatable :: state(:)
      character(:), allocatable :: name
      logical :: has_p, has_a, has_r, has_net, has_six, has_state, found

      p_eff = 0.0_wp
      sigma_a = 0.0_wp
      sigma_r = 0.0_wp
      suction = 0.0_wp
      s_w = 0.0_wp
      ratio = 0.0_wp
      call get_number(group, 'p_eff', p_eff, has_p)
      call get_number(group, 'sigma_a', sigma_a, has_a)
      call get_number(group, 'sigma_r', sigma_r, has_r)
      call get_number(group, 'suction', suction, found)
      call get_number(group, 'saturation', s_w, found)
      has_net = given(group, 'p_net') .or. given(group, 'sigma_a_net') .or. given(group, 'sigma_r_net')
      if (has_net) then
         if (has_p .or. has_a .or. has_r) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&initial takes the effective stress '// &
                       'or the net stress, not both.')
            return
         end if
         call get_number(group, 'p_net', p_eff, has_p)
         call get_number(group, 'sigma_a_net', sigma_a, has_a)
         call get_number(group, 'sigma_r_net', sigma_r, has_r)
      end if
      has_six = given(group, 'stress')
      has_state = given(group, 'state_variables')
      call get_number(group, 'void_ratio', ratio, found)
      if (.not. (found .or. has_state)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&initial lacks void_ratio ('// &
                    describe_key(CASE_KEYS, 'initial', 'void_ratio')//').')
      else if (has_state .and. (found .or. s_w > 0.0_wp .or. .not. has_six)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, 'state_variables'))//'state_variables '// &
                    'needs stress, and takes the place of void_ratio and saturation; give these two alone.')
      else if (count([has_p, has_a .or. has_r, has_six]) /= 1) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
                    '&initial needs the stress once: either p_eff, or sigma_a and sigma_r, or stress (six values), '// &
                    'or p_net, or sigma_a_net and sigma_r_net.')
      else if (has_a .neqv. has_r) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
                    '&initial needs the axial and the radial stress together.')
      end if
      if (fault%code /= 0) return

      name = ' '//trim(soil%law%unit%name)
      stress = 0.0_wp
      stress(AXIAL) = merge(p_eff, sigma_a, has_p)
      stress(RADIAL) = merge(p_eff, sigma_r, has_p)
      if (has_six) call get_numbers(group, 'stress', stress)
      if (has_state) then
         allocate (state(group%entries(find_entry(group, 'state_variables'))%count))
         call get_numbers(group, 'state_variables', state)
         call restore_point(soil, stress, suction, state, start, fault)
      else
         if (has_net) then
            ! S_w knows no stress: a sample at any stress tells it.
            call start_point(soil, suction_stress(stress, suction), suction, ratio, s_w, start, fault)
            if (fault%code == 0) stress = suction_stress(stress, saturation(soil, start)*suction)
         end if
         if (fault%code == 0) call start_point(soil, stress, suction, ratio, s_w, start, fault)
      end if
      if (fault%code /= 0) then
         fault%text = at_line(group%file, group%line)//fault%text
      else if (has_state) then
         return   ! what its history left, whatever that is
      else if (mean_stress(start) > (1.0_wp + LIFTED)*sum(stress(1:3))/3.0_wp) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the mean effective stress is '// &
                    short(sum(stress(1:3))/3.0_wp)//name//', below p_min of the material, '// &
                    short(mean_stress(start))//name//'; raise the one or lower the other.')
      else if (.not. has_six) then
         call refuse_tension(group, soil, start, fault)
      end if
   end subroutine read_initial

   !> Reads the properties of air and water of the sample, and the air pressure of the start. Fault EXIT_INPUT: below
   !> vacuum.
   subroutine read_air(group, soil, p_a, fault)
      type(group_t), intent(in) :: group
      type(soil_t), intent(inout) :: soil
      real(wp), intent(inout) :: p_a   !< [unit of stress of the law]
      type(fault_t), intent(inout) :: fault
      logical :: found

      soil%air%atmosphere = ATMOSPHERE*soil%law%unit%factor
      call get_number(group, 'henry', soil%air%henry, found)
      call get_number(group, 'k_w', soil%air%stiffness, found)
      call get_number(group, 'air_pressure', p_a, found)
      if (soil%air%atmosphere + p_a > 0.0_wp) return
      call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, 'air_pressure'))//'air_pressure = '// &
                 short(p_a)//' is below vacuum: it counts from the atmosphere, and must exceed '// &
                 short(-soil%air%atmosphere)//' '//trim(soil%law%unit%name)//'.')
   end subroutine read_air

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
