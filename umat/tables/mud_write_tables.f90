! SPDX-License-Identifier: MIT
!> Writes the tables that a linker sees, as C: names and units of PROPS and STATEV for mud.h, and what describes both
!> behaviours for the generic interface of MFront. Run by the build: mud_write_tables VERSION > mud_tables.c
program mud_write_tables
   use, intrinsic :: iso_fortran_env, only: output_unit
   use mud_registry, only: NPROPS, NPROPS_BASE, NSTATV, NSTATV_BASE, &
      PROPERTIES, VARIABLES, statev_name, &
      statev_variable
   implicit none (type, external)
   integer, parameter :: LONG = 64
   !> Prefix of the names of state variables: hosts have a `saturation` and a `void_ratio` of their own.
   character(*), parameter :: PREFIX = 'mud_'
   character(*), parameter :: HYPOTHESES(5) = [character(36) :: 'Tridimensional', 'PlaneStrain', 'Axisymmetrical', &
      'GeneralisedPlaneStrain', 'AxisymmetricalGeneralisedPlaneStrain']
   integer, parameter :: COMPONENTS(size(HYPOTHESES)) = [6, 4, 4, 4, 3]   !< Numbers of a tensor.
   !> Numbers of MGIS for the types of a variable.
   integer, parameter :: SCALAR = 0, SYMMETRIC_TENSOR = 1
   integer, parameter :: GENERAL_BEHAVIOUR = 0, STRAIN_BASED_BEHAVIOUR = 1, NO_KINEMATIC = 0, SMALL_STRAIN = 1

   character(LONG) :: props(NPROPS), statev(NSTATV), units(NSTATV), version
   integer :: i

   call get_command_argument(1, version)
   props = PROPERTIES%name
   do i = 1, NSTATV
      statev(i) = statev_name(i)
      units(i) = VARIABLES(statev_variable(i))%unit
   end do
   write (output_unit, '(a)') '/* Written by mud_write_tables from the registry of the library: change it there. */', &
      '#include "mud.h"', 'extern int mud_behaviour(void *view, int components, int unsaturated);'
   write (output_unit, '(a, i0, ";")') 'const int mud_props_count = ', NPROPS, 'const int mud_statev_count = ', NSTATV
   call texts('mud_props_names', props)
   call texts('mud_props_units', [character(LONG) :: PROPERTIES%unit])
   call texts('mud_statev_names', statev)
   call texts('mud_statev_units', units)

   call behaviour('MUD', 'effective stress against strain at constant suction', STRAIN_BASED_BEHAVIOUR, SMALL_STRAIN, &
                  [character(LONG) :: 'Strain'], [character(LONG) :: 'Stress'], [SYMMETRIC_TENSOR], &
                  [character(LONG) :: 'Stress', 'Strain'])
   call behaviour('MUD_StressSaturation', 'total stress and saturation against strain and liquid pressure', &
                  GENERAL_BEHAVIOUR, NO_KINEMATIC, [character(LONG) :: 'Strain', 'LiquidPressure'], &
                  [character(LONG) :: 'Stress', 'Saturation'], [SYMMETRIC_TENSOR, SCALAR], &
                  [character(LONG) :: 'Stress', 'Strain', 'Stress', 'LiquidPressure', 'Saturation', 'Strain', &
                   'Saturation', 'LiquidPressure'])
contains
   !> One behaviour: what describes it, and a function a hypothesis, which calls that of mud_mfront.f90.
   subroutine behaviour(name, description, kind, kinematic, gradients, forces, types, blocks)
      character(*), intent(in) :: name, description, gradients(:), forces(:), blocks(:)
      integer, intent(in) :: kind, kinematic, types(:)   !< Types of the gradients, and of the forces.
      character(LONG) :: none(0)
      integer :: no(0), k

      call text(name//'_mfront_ept', name)
      call text(name//'_mfront_interface', 'Generic')
      call text(name//'_tfel_version', '')
      call text(name//'_unit_system', '')
      call text(name//'_src', 'MUD '//trim(version))
      call text(name//'_author', 'MUD')
      call text(name//'_date', '')
      call text(name//'_validator', '')
      call text(name//'_build_id', trim(version))
      call text(name//'_description', 'bounding-surface model for unsaturated soil: '//description)
      call flag(name//'_mfront_mkt', 1)          ! a behaviour, no material property
      call flag(name//'_api_version', 1)
      call flag(name//'_BehaviourType', kind)
      call flag(name//'_BehaviourKinematic', kinematic)
      call flag(name//'_SymmetryType', 0)        ! no axes of the material that a host would have to rotate
      call flag(name//'_ElasticSymmetryType', 0)
      call flag(name//'_TemperatureRemovedFromExternalStateVariables', 1)
      call flag(name//'_UsableInPurelyImplicitResolution', 1)
      call flag(name//'_requiresStiffnessTensor', 0)
      call flag(name//'_requiresThermalExpansionCoefficientTensor', 0)
      call flag(name//'_ComputesInternalEnergy', 0)
      call flag(name//'_ComputesDissipatedEnergy', 0)
      call flag(name//'_nMainVariables', size(gradients))
      call list(name//'_', 'ModellingHypotheses', [character(LONG) :: HYPOTHESES])
      call list(name//'_', 'Gradients', gradients)
      call numbers('const int '//name//'_GradientsTypes', types)
      call list(name//'_', 'ThermodynamicForces', forces)
      call numbers('const int '//name//'_ThermodynamicForcesTypes', types)
      call list(name//'_', 'TangentOperatorBlocks', blocks)
      call list(name//'_', 'MaterialProperties', props(:NPROPS_BASE))
      call list(name//'_', 'InternalStateVariables', PREFIX//statev(:NSTATV_BASE))
      call numbers('const int '//name//'_InternalStateVariablesTypes', [(SCALAR, k=1, NSTATV_BASE)])
      call list(name//'_', 'ExternalStateVariables', none)
      call numbers('const int '//name//'_ExternalStateVariablesTypes', no)
      call list(name//'_', 'Parameters', none)
      call numbers('const int '//name//'_ParametersTypes', no)
      call list(name//'_', 'InitializeFunctions', none)
      call list(name//'_', 'PostProcessings', none)
      do k = 1, size(HYPOTHESES)
         write (output_unit, '(5a, 2(i0, a))') 'int ', name, '_', trim(HYPOTHESES(k)), &
            '(void *view) { return mud_behaviour(view, ', COMPONENTS(k), ', ', size(gradients) - 1, '); }'
      end do
   end subroutine behaviour

   !> A list and how long it is.
   subroutine list(prefix_, name, words)
      character(*), intent(in) :: prefix_, name, words(:)

      call flag(prefix_//'n'//name, size(words))
      call texts(prefix_//name, words)
   end subroutine list

   subroutine text(name, word)
      character(*), intent(in) :: name, word

      write (output_unit, '(5a)') 'const char *const ', name, ' = "', word, '";'
   end subroutine text

   subroutine flag(name, value)
      character(*), intent(in) :: name
      integer, intent(in) :: value

      write (output_unit, '(3a, i0, a)') 'const unsigned short ', name, ' = ', value, ';'
   end subroutine flag

   !> An array of words; C has no empty ones.
   subroutine texts(name, words)
      character(*), intent(in) :: name, words(:)
      integer :: k

      write (output_unit, '(3a)') 'const char *const ', name, '[] = {'
      write (output_unit, '(3x, 3a)') ('"', trim(words(k)), '",', k=1, size(words))
      if (size(words) == 0) write (output_unit, '(a)') '   0'
      write (output_unit, '(a)') '};'
   end subroutine texts

   !> An array of numbers.
   subroutine numbers(declaration, values)
      character(*), intent(in) :: declaration
      integer, intent(in) :: values(:)
      integer :: k

      write (output_unit, '(2a)') declaration, '[] = {'
      write (output_unit, '(3x, 20(i0, ", "))') (values(k), k=1, size(values))
      if (size(values) == 0) write (output_unit, '(a)') '   0'
      write (output_unit, '(a)') '};'
   end subroutine numbers
end program mud_write_tables
