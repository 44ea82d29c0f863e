! SPDX-License-Identifier: MIT
!> Units of stress: which one a material has is told by its p_atm, which is about an atmosphere in any of them.
module stress_units
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: stress_unit_t, unit_of_atmosphere, unit_named, in_unit, KILOPASCAL, UNIT_NAMES

   !> A unit of stress.
   type :: stress_unit_t
      character(5) :: name = 'kPa'
      real(wp) :: factor = 1.0_wp   !< Number of this unit that makes a kPa.
   end type stress_unit_t

   type(stress_unit_t), parameter :: KILOPASCAL = stress_unit_t()
   type(stress_unit_t), parameter :: UNITS(*) = [KILOPASCAL, stress_unit_t('Pa', 1000.0_wp), &
      stress_unit_t('MPa', 1.0e-3_wp), stress_unit_t('psi', 0.1450377377302092_wp), stress_unit_t('bar', 0.01_wp)]
   character(5), parameter :: UNIT_NAMES(*) = UNITS%name
   real(wp), parameter :: ATMOSPHERE = 101.325_wp   !< [kPa]
   !> A p_atm this close to an atmosphere is one, so that 100 kPa is kPa.
   real(wp), parameter :: NEAR = 0.05_wp
contains
   !> The unit in which an atmosphere is p_atm; one without a name where it is none of the known. Within 5 % of 101.325
   !> kPa; otherwise the name is 'units' and the factor p_atm/101.325. p_atm > 0 is not checked.
   pure type(stress_unit_t) function unit_of_atmosphere(p_atm) result(unit)
      real(wp), intent(in) :: p_atm
      integer :: i

      do i = 1, size(UNITS)
         unit = UNITS(i)
         if (abs(p_atm/(ATMOSPHERE*unit%factor) - 1.0_wp) <= NEAR) return
      end do
      unit = stress_unit_t('units', p_atm/ATMOSPHERE)
   end function unit_of_atmosphere

   !> The unit of a name of UNIT_NAMES; a factor of 0 where there is none. Case counts.
   pure type(stress_unit_t) function unit_named(name) result(unit)
      character(*), intent(in) :: name
      integer :: i

      do i = 1, size(UNITS)
         unit = UNITS(i)
         if (unit%name == name) return
      end do
      unit = stress_unit_t('', 0.0_wp)
   end function unit_named

   !> A text that says kPa, said in the unit. The first kPa alone; a text without one stays. No number is converted.
   pure function in_unit(text, unit) result(said)
      character(*), intent(in) :: text
      type(stress_unit_t), intent(in) :: unit
      character(:), allocatable :: said
      integer :: k

      said = text
      k = index(said, trim(KILOPASCAL%name))
      if (k > 0) said = said(:k - 1)//trim(unit%name)//said(k + len_trim(KILOPASCAL%name):)
   end function in_unit
end module stress_units
