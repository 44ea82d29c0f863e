!> Retention curves from their groups.
module retention_groups
   use kinds, only: wp
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: key_t, number_of, numbers_of, text_of, NONE, UNBOUNDED
   use material_point, only: material_t
   use namelists, only: group_t
   use retention_curves, only: retention_t, bilogarithmic_t, power_t, table_t, saturated_t
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: new_retention, give_retention, RETENTION_KEYS

   real(wp), parameter :: SMALLEST = 1.0e-30_wp
   type(key_t), parameter :: RETENTION_KEYS(*) = [ &
      key_t('retention', 'law', 'w', 'bilogarithmic', 0, 0, 'see README', 'bilogarithmic|power|table|saturated'), &
      key_t('retention', 'p_a', 'n', '5.0', SMALLEST, UNBOUNDED, 'air entry of the bilogarithmic law [kPa]'), &
      key_t('retention', 'n', 'n', '2.0', 0.01_wp, 100, 'exponent n of the bilogarithmic law [-]'), &
      key_t('retention', 'm', 'n', '1.0', 0.001_wp, 100, 'exponent m of the bilogarithmic law [-]'), &
      key_t('retention', 'omega', 'n', '2.0', 0, 100, 'exponent of the void ratio in the bilogarithmic law [-]'), &
      key_t('retention', 's_max', 'n', '1.0', 0, 1, 'largest degree of saturation [-]'), &
      key_t('retention', 's_min', 'n', '0.0', 0, 1, 'least degree of saturation [-]'), &
      key_t('retention', 'a', 'n', '0.0', 0, UNBOUNDED, 'factor of the power law S = 1 - a p_c**b'), &
      key_t('retention', 'b', 'n', '1.0', 1, 100, 'exponent b of the power law [-]'), &
      key_t('retention', 'suction', 'N', NONE, -UNBOUNDED, UNBOUNDED, 'table: suctions [kPa], ascending'), &
      key_t('retention', 'saturation', 'N', NONE, 0, 1, 'table: degrees of saturation [-]')]
contains
   !> Reads a curve and puts it beside a law that has none of its own.
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

   subroutine new_retention(group, curve, fault)
      type(group_t), intent(in) :: group   !< Checked against RETENTION_KEYS.
      class(retention_t), allocatable, intent(out) :: curve
      type(fault_t), intent(inout) :: fault
      type(table_t) :: table

      select case (lower_case(text_of(RETENTION_KEYS, group, 'law')))
      case ('bilogarithmic')
         allocate (curve, source=bilogarithmic_t(number('p_a'), number('n'), number('m'), number('omega'), &
                                                 number('s_max'), number('s_min')))
      case ('power')
         allocate (curve, source=power_t(number('a'), number('b'), number('s_min')))
      case ('table')
         table%p_c = numbers_of(group, 'suction')
         table%s = numbers_of(group, 'saturation')
         if (size(table%p_c) < 2 .or. size(table%p_c) /= size(table%s)) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a table needs as many saturations as '// &
                       'suctions, at least two.')
         else if (any(table%p_c(2:) <= table%p_c(:size(table%p_c) - 1))) then
            call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the suctions of a table must ascend.')
         end if
         allocate (curve, source=table)
      case default
         allocate (curve, source=saturated_t())
      end select
   contains
      real(wp) function number(name)
         character(*), intent(in) :: name

         number = number_of(RETENTION_KEYS, group, name)
      end function number
   end subroutine new_retention
end module retention_groups
