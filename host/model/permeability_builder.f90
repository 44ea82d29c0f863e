! SPDX-License-Identifier: MIT
!> Relative permeabilities of a scene.
module permeability_builder
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use permeability_laws, only: permeability_t, LAW_CONSTANT, LAW_COREY, LAW_MUALEM, LAW_POWER
   use scene_keys, only: number_of, text_of
   use scene_types, only: scene_law_t
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: new_permeability
contains
   !> Relative permeability of a group whose keys were checked; a fault where values contradict each other.
   !> docs/theory/host.md section 2.6. Fault EXIT_INPUT: s_max is not above s_min.
   subroutine new_permeability(given, law, fault)
      type(scene_law_t), intent(in) :: given
      type(permeability_t), intent(out) :: law
      type(fault_t), intent(inout) :: fault

      law%name = given%name
      associate (group => given%group)
         law%intrinsic = number_of(group, 'intrinsic')
         law%s_min = number_of(group, 's_min')
         law%s_max = number_of(group, 's_max')
         law%a = number_of(group, 'a')
         law%b = number_of(group, 'b')
         law%c = number_of(group, 'c')
         law%m = number_of(group, 'm')
         law%k_rw = number_of(group, 'k_rw')
         law%k_ra = number_of(group, 'k_ra')
         law%floor = number_of(group, 'floor')
         select case (lower_case(text_of(group, 'law')))
         case ('constant')
            law%law = LAW_CONSTANT
         case ('mualem')
            law%law = LAW_MUALEM
         case ('power')
            law%law = LAW_POWER
         case default
            law%law = LAW_COREY
         end select
         if (law%s_max <= law%s_min) call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
                                                's_max must be larger than s_min.')
      end associate
   end subroutine new_permeability
end module permeability_builder
