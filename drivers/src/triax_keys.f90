!> Keys of case files: their groups, sizes, ranges and meanings, and the check of a group against them.
module triax_keys
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use texts, only: lower_case, short, whole, read_number
   use spelling, only: nearest_name
   use namelists, only: group_t, entry_t, find_entry, LENGTH
   implicit none (type, external)
   private
   public :: check_keys, print_keys, describe_key, get_text, get_number, get_numbers, line_of, has_key

   integer, parameter :: LENGTH_OF_KEY = 21

   !> A key of a case file; `size` is 0 for a text, otherwise how many numbers it takes.
   type :: key_t
      character(8) :: group
      character(LENGTH_OF_KEY) :: name
      integer :: size
      real(wp) :: lower, upper
      character(8) :: unit
      character(120) :: meaning
   end type key_t

   character, parameter :: DIGITS(6) = ['1', '2', '3', '4', '5', '6']
   integer, private :: i   ! of the lists below
   type(key_t), parameter :: KEYS(*) = [ &
      key_t('case', 'name', 0, 0.0_wp, 0.0_wp, '', 'name of the case and of its output; default: name of the file'), &
      key_t('case', 'title', 0, 0.0_wp, 0.0_wp, '', 'a line about the case'), &
      key_t('initial', 'p_eff', 1, 1.0e-6_wp, 1.0e7_wp, 'kPa', 'mean effective stress of an isotropic start'), &
      key_t('initial', 'sigma_a', 1, 1.0e-6_wp, 1.0e7_wp, 'kPa', &
            'axial effective stress, with sigma_r, instead of p_eff'), &
      key_t('initial', 'sigma_r', 1, 1.0e-6_wp, 1.0e7_wp, 'kPa', 'radial effective stress, with sigma_a'), &
      key_t('initial', 'void_ratio', 1, 0.01_wp, 5.0_wp, '-', 'void ratio'), &
      key_t('initial', 'suction', 1, 0.0_wp, 1.0e6_wp, 'kPa', 'p_a - p_w; default 0, saturated'), &
      key_t('stage', 'control', 0, 0.0_wp, 0.0_wp, '', 'see the list of controls'), &
      key_t('stage', 'stress', 0, 0.0_wp, 0.0_wp, '', &
            'net or effective: which stress is held or led; default net, the same where there is no suction'), &
      key_t('stage', 'eps_a_end', 1, -1.0_wp, 1.0_wp, '-', 'axial strain at the end, from the start of the test'), &
      key_t('stage', 'eps_v_end', 1, -1.0_wp, 1.0_wp, '-', &
            'volumetric strain at the end, from the start of the test'), &
      key_t('stage', 'gamma_end', 1, -2.0_wp, 2.0_wp, '-', &
            'engineering shear strain 13 at the end, from the start of the test'), &
      key_t('stage', 'sigma_a_end', 1, -1.0e7_wp, 1.0e7_wp, 'kPa', 'axial stress at the end'), &
      key_t('stage', 'p_end', 1, -1.0e7_wp, 1.0e7_wp, 'kPa', 'mean stress at the end'), &
      key_t('stage', 'q_end', 1, -1.0e7_wp, 1.0e7_wp, 'kPa', 'sigma_a - sigma_r at the end'), &
      key_t('stage', 'tau_end', 1, -1.0e7_wp, 1.0e7_wp, 'kPa', 'shear stress 13 at the end'), &
      key_t('stage', 'd_eps', 6, -1.0_wp, 1.0_wp, '-', &
            'change of the strains 11, 22, 33, 12, 13, 23, shear as engineering strain (strain_path)'), &
      key_t('stage', 'd_sigma', 6, -1.0e7_wp, 1.0e7_wp, 'kPa', &
            'change of the stresses 11, 22, 33, 12, 13, 23 (stress_path)'), &
      [(key_t('stage', 'strain_'//DIGITS(i), 6, -1.0e6_wp, 1.0e6_wp, '-', &
              'factors of the six strains in constraint '//DIGITS(i)//', default 0 (linear)'), i=1, 6)], &
      [(key_t('stage', 'stress_'//DIGITS(i), 6, -1.0e6_wp, 1.0e6_wp, '-', &
              'factors of the six stresses in constraint '//DIGITS(i)//', default 0 (linear)'), i=1, 6)], &
      [(key_t('stage', 'change_'//DIGITS(i), 1, -1.0e7_wp, 1.0e7_wp, '-', &
              'change of the sum of constraint '//DIGITS(i)//' over the stage, default 0 (linear)'), i=1, 6)], &
      key_t('stage', 'suction_end', 1, 0.0_wp, 1.0e6_wp, 'kPa', &
            'suction at the end, reached in equal parts; without it suction stays'), &
      key_t('stage', 'water', 0, 0.0_wp, 0.0_wp, '', &
            'free or constant: constant holds the water content S_w e, and suction follows; default free'), &
      key_t('stage', 'cycle_by', 0, 0.0_wp, 0.0_wp, '', &
            'eps_a or gamma (strain is reversed), q or tau (strain is driven until the stress is reached)'), &
      key_t('stage', 'amplitude', 1, -1.0e7_wp, 1.0e7_wp, '-', &
            'of the cycles, in the unit of cycle_by; negative: the first way is backwards'), &
      key_t('stage', 'centre', 1, -1.0e7_wp, 1.0e7_wp, '-', &
            'of the cycles; default: the value where the stage begins'), &
      key_t('stage', 'cycles', 1, 1.0_wp, 1.0e6_wp, '-', 'number of cycles, whole'), &
      key_t('stage', 'stop_r_u', 1, 1.0e-3_wp, 1.0_wp, '-', &
            'pore pressure ratio that ends the stage (undrained, simple_shear_constant_volume; saturated)'), &
      key_t('stage', 'stop_double_amplitude', 1, 1.0e-6_wp, 1.0_wp, '-', &
            'strain eps_a or gamma between two reversals that ends the stage (cycles)'), &
      key_t('stage', 'increment', 1, 1.0e-12_wp, 1.0e6_wp, '-', &
            'largest step of what leads: strain, default 1e-4; stress, 1 kPa; suction, 0.1 kPa; linear, 1e-3 of 1'), &
      key_t('stage', 'output_interval', 1, 1.0e-12_wp, 1.0e6_wp, '-', &
            'a row at each multiple of it: strain, default 1e-3; stress [kPa], 10; suction [kPa], 1; linear: 1e-2')]

contains
   !> Every key of a group is known, has as many values as it takes, and these are in range.
   subroutine check_keys(group, fault)
      type(group_t), intent(in) :: group
      type(fault_t), intent(inout) :: fault
      integer :: i, near

      do i = 1, group%count
         associate (item => group%entries(i))
            if (find_key(group%name, item%key) == 0) then
               near = nearest_name(item%key, KEYS%name, KEYS%group == group%name)
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

   !> Range and meaning of a key, by its name.
   pure function describe_key(group, name) result(text)
      character(*), intent(in) :: group, name
      character(:), allocatable :: text

      text = described(find_key(group, name))
   end function describe_key

   !> True if a group gives a key.
   pure logical function has_key(group, key)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key

      has_key = find_entry(group, key) > 0
   end function has_key

   !> Line of a key, or of its group where the key is not given.
   pure integer function line_of(group, key) result(line)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key

      line = group%line
      if (has_key(group, key)) line = group%entries(find_entry(group, key))%line
   end function line_of

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
end module triax_keys
