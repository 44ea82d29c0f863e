!> Case files: what a test is, read and checked before anything runs.
module triax_case
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use triax_fault, only: fault_t, raise, at_line, EXIT_INPUT
   use triax_text, only: lower_case, distance, short, whole, read_number
   use triax_namelist, only: group_t, entry_t, read_groups, find_entry, LENGTH
   use triax_material, only: read_material
   use triax_point, only: soil_t, point_t, start_point, mean_stress, AXIAL, RADIAL
   implicit none (type, external)
   private
   public :: case_t, stage_t, read_case, print_keys
   public :: DRAINED, UNDRAINED, ISOTROPIC, OEDOMETER, CONSTANT_NET_STRESS, STRAIN_PATH, CONTROL_NAMES

   integer, parameter :: LENGTH_OF_KEY = 16
   integer, parameter :: DRAINED = 1               !< Axial strain given, net radial stress held.
   integer, parameter :: UNDRAINED = 2             !< Axial strain given, volume held.
   integer, parameter :: ISOTROPIC = 3             !< Volumetric strain given, equal in all directions.
   integer, parameter :: OEDOMETER = 4             !< Volumetric strain given, radial strain zero.
   integer, parameter :: CONSTANT_NET_STRESS = 5   !< Suction given, net stress held.
   integer, parameter :: STRAIN_PATH = 6           !< All six strains given.
   character(19), parameter :: CONTROL_NAMES(6) = [character(19) :: 'drained', 'undrained', 'isotropic', 'oedometer', &
                                                   'constant_net_stress', 'strain_path']

   !> The key that each of them needs.
   character(LENGTH_OF_KEY), parameter :: LEADS(6) = [character(LENGTH_OF_KEY) :: 'eps_a_end', 'eps_a_end', &
                                                      'eps_v_end', 'eps_v_end', 'suction_end', 'd_eps']

   !> One stage of a test.
   type :: stage_t
      integer :: control = 0
      integer :: line = 0
      real(wp) :: target = 0.0_wp            !< eps_a_end, eps_v_end or suction_end; 1 on a strain path.
      real(wp) :: strain_change(6) = 0.0_wp  !< d_eps of a strain path [-].
      logical :: moves_suction = .false.
      real(wp) :: suction_end = 0.0_wp       !< [kPa]
      real(wp) :: increment = 0.0_wp         !< [-]; [kPa] where suction leads.
      real(wp) :: interval = 0.0_wp          !< Between rows of the output, in the unit of the increment.
   end type stage_t

   !> A test.
   type :: case_t
      character(LENGTH) :: file = '', name = '', title = '', material = ''
      type(soil_t) :: soil
      type(point_t) :: start
      type(stage_t), allocatable :: stages(:)
   end type case_t

   !> A key of a case file; `size` is 0 for a text, otherwise how many numbers it takes.
   type :: key_t
      character(8) :: group
      character(LENGTH_OF_KEY) :: name
      integer :: size
      real(wp) :: lower, upper
      character(8) :: unit
      character(100) :: meaning
   end type key_t

   real(wp), parameter :: DEFAULT_INCREMENT = 1.0e-4_wp, DEFAULT_INTERVAL = 1.0e-3_wp        ! [-]
   real(wp), parameter :: DEFAULT_SUCTION_INCREMENT = 0.1_wp, DEFAULT_SUCTION_INTERVAL = 1.0_wp  ! [kPa]
   real(wp), parameter :: LIFTED = 1.0e-12_wp   !< Far above rounding: the library has raised the stress to p_min.
   real(wp), parameter :: MAX_INCREMENTS = 1.0e8_wp

   type(key_t), parameter :: KEYS(*) = [ &
      key_t('case', 'name', 0, 0.0_wp, 0.0_wp, '', 'name of the case and of its output; default: name of the file'), &
      key_t('case', 'title', 0, 0.0_wp, 0.0_wp, '', 'a line about the case'), &
      key_t('initial', 'p_eff', 1, 1.0e-6_wp, 1.0e7_wp, 'kPa', 'mean effective stress of an isotropic start'), &
      key_t('initial', 'sigma_a', 1, 1.0e-6_wp, 1.0e7_wp, 'kPa', &
            'axial effective stress, with sigma_r, instead of p_eff'), &
      key_t('initial', 'sigma_r', 1, 1.0e-6_wp, 1.0e7_wp, 'kPa', 'radial effective stress, with sigma_a'), &
      key_t('initial', 'void_ratio', 1, 0.01_wp, 5.0_wp, '-', 'void ratio'), &
      key_t('initial', 'suction', 1, 0.0_wp, 1.0e6_wp, 'kPa', 'p_a - p_w; default 0, saturated'), &
      key_t('stage', 'control', 0, 0.0_wp, 0.0_wp, '', &
            'drained, undrained, isotropic, oedometer, constant_net_stress or strain_path'), &
      key_t('stage', 'eps_a_end', 1, -1.0_wp, 1.0_wp, '-', &
            'axial strain at the end, from the start of the test (drained, undrained)'), &
      key_t('stage', 'eps_v_end', 1, -1.0_wp, 1.0_wp, '-', &
            'volumetric strain at the end, from the start of the test (isotropic, oedometer)'), &
      key_t('stage', 'd_eps', 6, -1.0_wp, 1.0_wp, '-', &
            'change of the strains 11, 22, 33, 12, 13, 23, shear as engineering strain (strain_path)'), &
      key_t('stage', 'suction_end', 1, 0.0_wp, 1.0e6_wp, 'kPa', &
            'suction at the end, reached in equal parts; without it suction stays'), &
      key_t('stage', 'increment', 1, 1.0e-12_wp, 1.0e6_wp, '-', &
            'largest strain of an increment, default 1e-4; constant_net_stress: suction [kPa], default 0.1'), &
      key_t('stage', 'output_interval', 1, 1.0e-12_wp, 1.0e6_wp, '-', &
            'a row at each multiple of this, default 1e-3; constant_net_stress: suction [kPa], default 1')]

contains
   !> Reads and checks a case with its material, and brings the sample to its start.
   subroutine read_case(file, test, fault)
      character(*), intent(in) :: file
      type(case_t), intent(out) :: test
      type(fault_t), intent(inout) :: fault
      type(group_t), allocatable :: groups(:)
      integer :: i, of_case, of_material, of_initial, n_stages

      test%file = file
      call read_groups(file, groups, fault)
      if (fault%code /= 0) return
      of_case = 0
      of_material = 0
      of_initial = 0
      n_stages = 0
      do i = 1, size(groups)
         select case (groups(i)%name)
         case ('case')
            call only_once(file, groups, i, of_case, fault)
         case ('material')
            call only_once(file, groups, i, of_material, fault)
         case ('initial')
            call only_once(file, groups, i, of_initial, fault)
         case ('stage')
            n_stages = n_stages + 1
         case default
            call raise(fault, EXIT_INPUT, at_line(file, groups(i)%line)//'there is no group &'//trim(groups(i)%name)// &
                       '; a case has &case, &material, &initial and one &stage or more.')
         end select
         if (fault%code == 0 .and. groups(i)%name /= 'material') call check_keys(groups(i), fault)
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
      end if

      call read_material(groups(of_material), test%soil, test%material, fault)
      if (fault%code /= 0) return
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
   end subroutine read_case

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
                    described(find_key('initial', 'void_ratio'))//').')
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
      character(LENGTH) :: word
      character(LENGTH_OF_KEY) :: lead
      integer :: i
      logical :: found

      stage%line = group%line
      word = ''
      call get_text(group, 'control', word)
      do i = 1, size(CONTROL_NAMES)
         if (lower_case(word) == CONTROL_NAMES(i)) stage%control = i
      end do
      if (stage%control == 0) then
         if (len_trim(word) == 0) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&stage lacks control: '// &
                       described(find_key('stage', 'control'))//'.')
         else
            call raise(fault, EXIT_INPUT, at_line(group%file, group%entries(find_entry(group, 'control'))%line)// &
                       'control = '//trim(word)//' is unknown; the nearest is '// &
                       trim(CONTROL_NAMES(nearest_name(word, CONTROL_NAMES)))//' (one of '// &
                       described(find_key('stage', 'control'))//').')
         end if
         return
      end if

      lead = LEADS(stage%control)
      if (find_entry(group, lead) == 0) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a stage of control '//trim(word)//' needs '// &
                    trim(lead)//': '//described(find_key('stage', lead))//'.')
         return
      end if
      do i = 1, size(LEADS)
         if (LEADS(i) == lead .or. LEADS(i) == 'suction_end') cycle
         if (find_entry(group, LEADS(i)) > 0) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%entries(find_entry(group, LEADS(i)))%line)// &
                       trim(LEADS(i))//' means nothing in a stage of control '//trim(word)//', which is led by '// &
                       trim(lead)//'; remove it.')
            return
         end if
      end do

      stage%increment = merge(DEFAULT_SUCTION_INCREMENT, DEFAULT_INCREMENT, stage%control == CONSTANT_NET_STRESS)
      stage%interval = merge(DEFAULT_SUCTION_INTERVAL, DEFAULT_INTERVAL, stage%control == CONSTANT_NET_STRESS)
      call get_number(group, 'increment', stage%increment, found)
      call get_number(group, 'output_interval', stage%interval, found)
      call get_number(group, 'suction_end', stage%suction_end, stage%moves_suction)
      if (stage%control == STRAIN_PATH) then
         stage%target = 1.0_wp
         call get_numbers(group, 'd_eps', stage%strain_change)
         if (all(abs(stage%strain_change) <= 0.0_wp)) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%entries(find_entry(group, lead))%line)// &
                       'all six entries of d_eps are zero; give the strain to apply.')
         end if
      else
         call get_number(group, lead, stage%target, found)
      end if
      if (2.0_wp/stage%increment > MAX_INCREMENTS .and. stage%control /= CONSTANT_NET_STRESS) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'increment = '//short(stage%increment)// &
                    ' could make more than '//short(MAX_INCREMENTS)//' increments; use '// &
                       short(2.0_wp/MAX_INCREMENTS)// &
                    ' or more.')
      end if
   end subroutine read_stage

   !> Every key of a group is known, has as many values as it takes, and these are in range.
   subroutine check_keys(group, fault)
      type(group_t), intent(in) :: group
      type(fault_t), intent(inout) :: fault
      integer :: i, near

      do i = 1, group%count
         associate (item => group%entries(i))
            if (find_key(group%name, item%key) == 0) then
               near = nearest_key(group%name, item%key)
               call raise(fault, EXIT_INPUT, at_line(group%file, item%line)//'&'//trim(group%name)//' has no '// &
                          trim(item%key)//'; the nearest is '//trim(KEYS(near)%name)//' ('//described(near)//').')
            else
               call check_values(group%file, item, KEYS(find_key(group%name, item%key)), fault)
            end if
         end associate
         if (fault%code /= 0) return
      end do
   end subroutine check_keys

   subroutine check_values(file, item, key, fault)
      character(*), intent(in) :: file
      type(entry_t), intent(in) :: item
      type(key_t), intent(in) :: key
      type(fault_t), intent(inout) :: fault
      real(wp) :: value
      integer :: i
      logical :: good

      if (item%count /= max(key%size, 1)) then
         call raise(fault, EXIT_INPUT, at_line(file, item%line)//trim(key%name)//' takes '//whole(max(key%size, 1))// &
                    merge(' value ', ' values', key%size <= 1)//', '//whole(item%count)//' given ('// &
                    described(find_key(key%group, key%name))//').')
         return
      end if
      if (key%size == 0) return
      do i = 1, item%count
         call read_number(item%values(i), value, good)
         if (.not. good) then
            call raise(fault, EXIT_INPUT, at_line(file, item%line)//trim(key%name)//' = '//trim(item%values(i))// &
                       ' is not a number ('//described(find_key(key%group, key%name))//').')
         else if (value < key%lower .or. value > key%upper) then
            call raise(fault, EXIT_INPUT, at_line(file, item%line)//trim(key%name)//' = '//trim(item%values(i))// &
                       ' is outside its range ('//described(find_key(key%group, key%name))//').')
         end if
         if (fault%code /= 0) return
      end do
   end subroutine check_values

   !> The keys of case files, for the help text.
   subroutine print_keys(unit)
      integer, intent(in) :: unit
      character(8) :: previous
      integer :: i

      previous = ''
      do i = 1, size(KEYS)
         if (KEYS(i)%group /= previous) write (unit, '(2a)') '   &', trim(KEYS(i)%group)
         previous = KEYS(i)%group
         write (unit, '(3a)') '      ', KEYS(i)%name, described(i)
      end do
   end subroutine print_keys

   !> "from 0.01 to 5: void ratio"
   pure function described(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = ''
      if (KEYS(place)%size > 0) text = 'from '//short(KEYS(place)%lower)//' to '//short(KEYS(place)%upper)
      if (KEYS(place)%size > 0 .and. KEYS(place)%unit /= '-') text = text//' '//trim(KEYS(place)%unit)
      if (KEYS(place)%size > 0) text = text//': '
      text = text//trim(KEYS(place)%meaning)
   end function described

   pure integer function find_key(group, name) result(place)
      character(*), intent(in) :: group, name

      do place = 1, size(KEYS)
         if (KEYS(place)%group == group .and. KEYS(place)%name == lower_case(name)) return
      end do
      place = 0
   end function find_key

   pure integer function nearest_key(group, word) result(best)
      character(*), intent(in) :: group, word
      integer :: i

      best = 0
      do i = 1, size(KEYS)
         if (KEYS(i)%group /= group) cycle
         if (best == 0) best = i
         if (distance(word, KEYS(i)%name) < distance(word, KEYS(best)%name)) best = i
      end do
   end function nearest_key

   pure integer function nearest_name(word, names) result(best)
      character(*), intent(in) :: word, names(:)
      integer :: i

      best = 1
      do i = 2, size(names)
         if (distance(word, names(i)) < distance(word, names(best))) best = i
      end do
   end function nearest_name

   !> A text that check_keys has passed; `value` stays where the group has none.
   subroutine get_text(group, key, value)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key
      character(LENGTH), intent(inout) :: value
      integer :: place

      place = find_entry(group, key)
      if (place > 0) value = group%entries(place)%values(1)
   end subroutine get_text

   !> A number that check_keys has passed; `value` stays where the group has none.
   subroutine get_number(group, key, value, found)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key
      real(wp), intent(inout) :: value
      logical, intent(out) :: found
      integer :: place

      place = find_entry(group, key)
      found = place > 0
      if (found) call read_number(group%entries(place)%values(1), value, found)
   end subroutine get_number

   subroutine get_numbers(group, key, values)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key
      real(wp), intent(inout) :: values(:)
      integer :: place, i
      logical :: good

      place = find_entry(group, key)
      if (place == 0) return
      do i = 1, size(values)
         call read_number(group%entries(place)%values(i), values(i), good)
      end do
   end subroutine get_numbers
end module triax_case
