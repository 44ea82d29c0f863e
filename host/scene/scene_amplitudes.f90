! SPDX-License-Identifier: MIT
!> Amplitudes of loads and supports (&history of a scene): times and factors from its keys, or from a file
!> of its own with two numbers a line.
module scene_amplitudes
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use namelists, only: group_t
   use number_pairs, only: read_pairs
   use scene_keys, only: text_of
   use key_schema, only: numbers_of, given
   use scene_types, only: scene_amplitude_t
   implicit none (type, external)
   private
   public :: read_amplitude
contains
   !> Reads an &history; a fault where times and factors do not match or times do not ascend. Times [s], factors [-].
   !> Fault EXIT_INPUT, also where its file cannot be read.
   subroutine read_amplitude(group, amplitude, fault)
      type(group_t), intent(in) :: group
      type(scene_amplitude_t), intent(out) :: amplitude
      type(fault_t), intent(inout) :: fault

      amplitude%name = text_of(group, 'name')
      if (given(group, 'file')) then
         call read_pairs(text_of(group, 'file'), trim(group%file), group%line, 'a time and a factor', &
                         amplitude%times, amplitude%values, fault)
      else
         amplitude%times = numbers_of(group, 'times')
         amplitude%values = numbers_of(group, 'values')
      end if
      if (fault%code /= 0) return
      if (size(amplitude%times) == 0 .or. size(amplitude%times) /= size(amplitude%values)) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'history '//trim(amplitude%name)// &
                    ' needs as many values as times.')
      else if (any(amplitude%times(2:) <= amplitude%times(:size(amplitude%times) - 1))) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the times of history '// &
                    trim(amplitude%name)//' must ascend.')
      end if
   end subroutine read_amplitude
end module scene_amplitudes
