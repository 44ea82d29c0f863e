! SPDX-License-Identifier: MIT
!> Retention curves from their groups.
module retention_groups
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: check_group, line_of, UNBOUNDED
   use key_table, only: key_table_t, listing, reading
   use material_point, only: material_t
   use namelists, only: group_t
   use number_pairs, only: read_pairs
   use retention_curves, only: retention_t, bilogarithmic_t, van_genuchten_t, power_t, table_t, &
                               saturated_t
   use texts, only: short, whole, LENGTH
   implicit none (type, external)
   private
   public :: new_retention, give_retention

   real(wp), parameter :: SMALLEST = 1.0e-30_wp, ZERO = 0.0_wp, ONE = 1.0_wp, LARGE = 100.0_wp
   !> Laws, in the order of their words.
   integer, parameter :: BILOGARITHMIC = 1, VAN_GENUCHTEN = 2, POWER = 3, OF_TABLE = 4
contains
   !> Checks a group, reads its curve and gives it to a law that has no retention curve of its own. Suctions [kPa]. A
   !> fault (EXIT_INPUT) where the law has its own, or what check_group and new_retention refuse.
   subroutine give_retention(group, law, fault)
      type(group_t), intent(in) :: group
      class(material_t), intent(inout) :: law
      type(fault_t), intent(inout) :: fault
      type(key_table_t) :: table

      table = listing(trim(group%name))
      call new_retention(table, law%curve, fault)
      call check_group(table%keys, group, .false., fault)
      if (fault%code /= 0) return
      if (law%has_retention) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&'//trim(group%name)//' goes with a law '// &
                    'that has no retention of its own; remove it: a point has one saturation.')
         return
      end if
      table = reading(group)
      call new_retention(table, law%curve, fault)
   end subroutine give_retention

   !> Declares the keys of a curve and makes it of a group that was checked; a fault where its values contradict each
   !> other. Suctions [kPa]; the fault is EXIT_INPUT with file and line. Laws of retention_curves.
   subroutine new_retention(k, curve, fault)
      type(key_table_t), intent(inout) :: k
      class(retention_t), allocatable, intent(out) :: curve
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: SHAPED = 'law=bilogarithmic|van_genuchten'
      type(bilogarithmic_t) :: own
      type(van_genuchten_t) :: other
      type(power_t) :: falling
      type(table_t) :: table
      character(LENGTH) :: file
      integer :: law

      law = BILOGARITHMIC
      other%alpha = ZERO   ! has no default
      file = ''
      call k%word('law', law, 'bilogarithmic|van_genuchten|power|table|saturated', 'see host/SCENE.md')
      call k%number('p_a', own%p_a, SMALLEST, UNBOUNDED, 'air entry of the bilogarithmic law [kPa]', &
                    'law=bilogarithmic', shown='5.0')
      call k%number('alpha', other%alpha, SMALLEST, UNBOUNDED, 'van Genuchten''s alpha [1/kPa]', 'law=van_genuchten')
      call k%number('n', own%n, 0.01_wp, LARGE, 'exponent n, of van Genuchten above 1 [-]', SHAPED, shown='2.0')
      call k%number('m', own%m, 0.001_wp, LARGE, 'exponent m; of van Genuchten by default 1 - 1/n [-]', &
                    SHAPED, shown='1.0')
      call k%number('omega', own%omega, ZERO, LARGE, 'exponent of the void ratio in the bilogarithmic law [-]', &
                    'law=bilogarithmic', shown='2.0')
      call k%number('s_max', own%s_max, ZERO, ONE, 'largest degree of saturation [-]', SHAPED, shown='1.0')
      call k%number('s_min', own%s_min, ZERO, ONE, 'least degree of saturation [-]', SHAPED//'|power', shown='0.0')
      call k%number('a', falling%a, ZERO, UNBOUNDED, 'factor of the power law S = 1 - a p_c**b', &
                    'law=power', shown='0.0')
      call k%number('b', falling%b, ONE, LARGE, 'exponent b of the power law [-]', 'law=power', shown='1.0')
      call k%numbers('suction', table%p_c, -UNBOUNDED, UNBOUNDED, 'table: suctions [kPa], ascending', &
                     'law=table -file')
      call k%numbers('saturation', table%s, ZERO, ONE, 'table: degrees of saturation [-]', 'law=table -file')
      call k%text('file', file, 'table: text file with a suction and a saturation a line', 'law=table')
      if (k%lists) return
      select case (law)
      case (BILOGARITHMIC)
         allocate (curve, source=own)
      case (VAN_GENUCHTEN)
         other%n = own%n
         other%m = merge(own%m, ONE - ONE/own%n, k%given('m'))
         other%s_max = own%s_max
         other%s_min = own%s_min
         call check_van_genuchten(k, other, fault)
         allocate (curve, source=other)
      case (POWER)
         falling%s_min = own%s_min
         allocate (curve, source=falling)
      case (OF_TABLE)
         call fill_table(k, trim(file), table, fault)
         allocate (curve, source=table)
      case default
         allocate (curve, source=saturated_t())
      end select
   end subroutine new_retention

   subroutine check_van_genuchten(k, law, fault)
      type(key_table_t), intent(in) :: k
      type(van_genuchten_t), intent(in) :: law
      type(fault_t), intent(inout) :: fault

      associate (group => k%group)
         if (.not. k%given('alpha')) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'law = ''van_genuchten'' needs alpha '// &
                       '[1/kPa], about one over the air entry.')
         else if (.not. law%n > ONE) then
            call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, 'n'))//'n = '//short(law%n)//' of '// &
                       'van Genuchten''s curve must lie above 1: below it the slope at zero suction is not finite.')
         else if (.not. law%s_max > law%s_min) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'s_max must be larger than s_min.')
         end if
      end associate
   end subroutine check_van_genuchten

   !> Pairs from the keys, or from a file: as many as there are.
   subroutine fill_table(k, file, table, fault)
      type(key_table_t), intent(in) :: k
      character(*), intent(in) :: file
      type(table_t), intent(inout) :: table
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: place

      place = at_line(k%group%file, k%group%line)
      if (k%given('file')) then
         call read_pairs(file, trim(k%group%file), line_of(k%group, 'file'), 'a suction and a saturation', table%p_c, &
                         table%s, fault)
         place = at_line(k%group%file, line_of(k%group, 'file'))//file//': '
      end if
      if (fault%code == 0) call check_table(table, place, fault)
   end subroutine fill_table

   subroutine check_table(table, place, fault)
      type(table_t), intent(in) :: table
      character(*), intent(in) :: place
      type(fault_t), intent(inout) :: fault
      integer :: bad

      bad = findloc(table%s < 0.0_wp .or. table%s > 1.0_wp, .true., dim=1)
      if (size(table%p_c) < 2 .or. size(table%p_c) /= size(table%s)) then
         call raise(fault, EXIT_INPUT, place//'a table needs as many saturations as suctions, at least two.')
      else if (any(table%p_c(2:) <= table%p_c(:size(table%p_c) - 1))) then
         call raise(fault, EXIT_INPUT, place//'the suctions of a table must ascend.')
      else if (bad > 0) then
         call raise(fault, EXIT_INPUT, place//'pair '//whole(bad)//' has the saturation '//short(table%s(bad))// &
                    '; allowed is 0 to 1.')
      else if (any(table%s(2:) > table%s(:size(table%s) - 1))) then
         call raise(fault, EXIT_INPUT, place//'the saturations of a table must not rise with the suction.')
      end if
   end subroutine check_table
end module retention_groups
