! SPDX-License-Identifier: MIT
!> Retention curves from their groups.
module retention_groups
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: key_t, number_of, numbers_of, text_of, given, line_of, NONE, UNBOUNDED
   use material_point, only: material_t
   use namelists, only: group_t
   use number_pairs, only: read_pairs
   use retention_curves, only: retention_t, bilogarithmic_t, van_genuchten_t, power_t, table_t, &
                               saturated_t
   use texts, only: lower_case, short, whole
   implicit none (type, external)
   private
   public :: new_retention, give_retention, RETENTION_KEYS

   real(wp), parameter :: SMALLEST = 1.0e-30_wp
   type(key_t), parameter :: RETENTION_KEYS(*) = [ &
      key_t('retention', 'law', 'w', 'bilogarithmic', 0, 0, 'see host/SCENE.md', &
            'bilogarithmic|van_genuchten|power|table|saturated'), &
      key_t('retention', 'p_a', 'n', '5.0', SMALLEST, UNBOUNDED, 'air entry of the bilogarithmic law [kPa]', &
            acts='law=bilogarithmic'), &
      key_t('retention', 'alpha', 'n', NONE, SMALLEST, UNBOUNDED, 'van Genuchten''s alpha [1/kPa]', &
            acts='law=van_genuchten'), &
      key_t('retention', 'n', 'n', '2.0', 0.01_wp, 100, 'exponent n, of van Genuchten above 1 [-]', &
            acts='law=bilogarithmic|van_genuchten'), &
      key_t('retention', 'm', 'n', '1.0', 0.001_wp, 100, 'exponent m; of van Genuchten by default 1 - 1/n [-]', &
            acts='law=bilogarithmic|van_genuchten'), &
      key_t('retention', 'omega', 'n', '2.0', 0, 100, 'exponent of the void ratio in the bilogarithmic law [-]', &
            acts='law=bilogarithmic'), &
      key_t('retention', 's_max', 'n', '1.0', 0, 1, 'largest degree of saturation [-]', &
            acts='law=bilogarithmic|van_genuchten'), &
      key_t('retention', 's_min', 'n', '0.0', 0, 1, 'least degree of saturation [-]', &
            acts='law=bilogarithmic|van_genuchten|power'), &
      key_t('retention', 'a', 'n', '0.0', 0, UNBOUNDED, 'factor of the power law S = 1 - a p_c**b', acts='law=power'), &
      key_t('retention', 'b', 'n', '1.0', 1, 100, 'exponent b of the power law [-]', acts='law=power'), &
      key_t('retention', 'suction', 'N', NONE, -UNBOUNDED, UNBOUNDED, 'table: suctions [kPa], ascending', &
            acts='law=table -file'), &
      key_t('retention', 'saturation', 'N', NONE, 0, 1, 'table: degrees of saturation [-]', acts='law=table -file'), &
      key_t('retention', 'file', 't', NONE, 0, 0, 'table: text file with a suction and a saturation a line', &
            acts='law=table')]
contains
   !> Reads a curve and gives it to a law that has no retention curve of its own. Suctions [kPa]. A fault (EXIT_INPUT)
   !> where the law has its own, or the values contradict each other.
   subroutine give_retention(group, law, fault)
      type(group_t), intent(in) :: group   !< Checked against RETENTION_KEYS.
      class(material_t), intent(inout) :: law
      type(fault_t), intent(inout) :: fault

      if (law%has_retention) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'&'//trim(group%name)//' goes with a law '// &
                    'that has no retention of its own; remove it: a point has one saturation.')
         return
      end if
      call new_retention(group, law%curve, fault)
   end subroutine give_retention

   !> Makes the curve of a group; a fault where its values contradict each other. Suctions [kPa]; the fault is
   !> EXIT_INPUT with file and line. Laws of retention_curves.
   subroutine new_retention(group, curve, fault)
      type(group_t), intent(in) :: group   !< Checked against RETENTION_KEYS.
      class(retention_t), allocatable, intent(out) :: curve
      type(fault_t), intent(inout) :: fault

      select case (lower_case(text_of(RETENTION_KEYS, group, 'law')))
      case ('bilogarithmic')
         allocate (curve, source=bilogarithmic_t(number('p_a'), number('n'), number('m'), number('omega'), &
                                                 number('s_max'), number('s_min')))
      case ('van_genuchten')
         call new_van_genuchten(group, curve, fault)
      case ('power')
         allocate (curve, source=power_t(number('a'), number('b'), number('s_min')))
      case ('table')
         call new_table(group, curve, fault)
      case default
         allocate (curve, source=saturated_t())
      end select
   contains
      real(wp) function number(name)
         character(*), intent(in) :: name

         number = number_of(RETENTION_KEYS, group, name)
      end function number
   end subroutine new_retention

   subroutine new_van_genuchten(group, curve, fault)
      type(group_t), intent(in) :: group
      class(retention_t), allocatable, intent(out) :: curve
      type(fault_t), intent(inout) :: fault
      type(van_genuchten_t) :: law

      law%alpha = number_of(RETENTION_KEYS, group, 'alpha')
      law%n = number_of(RETENTION_KEYS, group, 'n')
      law%m = 1.0_wp - 1.0_wp/law%n
      if (given(group, 'm')) law%m = number_of(RETENTION_KEYS, group, 'm')
      law%s_max = number_of(RETENTION_KEYS, group, 's_max')
      law%s_min = number_of(RETENTION_KEYS, group, 's_min')
      if (.not. given(group, 'alpha')) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'law = ''van_genuchten'' needs alpha '// &
                    '[1/kPa], about one over the air entry.')
      else if (.not. law%n > 1.0_wp) then
         call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, 'n'))//'n = '//short(law%n)//' of van '// &
                    'Genuchten''s curve must lie above 1: below it the slope at zero suction is not finite.')
      else if (.not. law%s_max > law%s_min) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'s_max must be larger than s_min.')
      end if
      allocate (curve, source=law)
   end subroutine new_van_genuchten

   !> Pairs from the keys, or from a file: as many as there are.
   subroutine new_table(group, curve, fault)
      type(group_t), intent(in) :: group
      class(retention_t), allocatable, intent(out) :: curve
      type(fault_t), intent(inout) :: fault
      type(table_t) :: table
      character(:), allocatable :: place

      place = at_line(group%file, group%line)
      if (given(group, 'file')) then
         call read_pairs(text_of(RETENTION_KEYS, group, 'file'), trim(group%file), line_of(group, 'file'), &
                         'a suction and a saturation', table%p_c, table%s, fault)
         place = at_line(group%file, line_of(group, 'file'))//trim(text_of(RETENTION_KEYS, group, 'file'))//': '
      else
         table%p_c = numbers_of(group, 'suction')
         table%s = numbers_of(group, 'saturation')
      end if
      if (fault%code == 0) call check_table(table, place, fault)
      allocate (curve, source=table)
   end subroutine new_table

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
      end if
   end subroutine check_table
end module retention_groups
