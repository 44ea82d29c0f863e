! SPDX-License-Identifier: MIT
!> Names of a scene: a name that other groups refer to is unique, a name that becomes a file or a column is valid for
!> that, and the stages that groups name are there.
module scene_names
   use scene_parts, only: NAME_LENGTH
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: given
   use material_registry, only: is_law
   use namelists, only: group_t, find_entry
   use texts, only: whole, LENGTH
   implicit none (type, external)
   private
   public :: check_names

   !> Groups whose names become files or columns.
   character(12), parameter :: WRITTEN(4) = [character(12) :: 'stage', 'point', 'plate', 'contact']
   character(*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   character(*), parameter :: FIT = LETTERS//'0123456789_-.'
contains
   !> Checks the names in groups whose keys are those of the list. Fault EXIT_INPUT: a name is empty, too long, given
   !> twice, or holds what no file name should. Fault EXIT_GROUP: a stage that nobody defines.
   subroutine check_names(groups, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: place
      character(LENGTH) :: names(size(groups))
      character(12) :: kinds(size(groups))   !< Groups of one kind have no name in common.
      integer :: g, i, k

      names = ''
      do g = 1, size(groups)
         kinds(g) = groups(g)%name(:12)
         if (is_law(groups(g)%name)) kinds(g) = 'material'
         if (groups(g)%name == 'scene' .or. .not. given(groups(g), 'name')) cycle
         associate (item => groups(g)%entries(find_entry(groups(g), 'name')))
            names(g) = item%values(1)
            place = at_line(groups(g)%file, item%line)//'name = '''//trim(names(g))//''''
         end associate
         i = findloc(kinds(:g - 1) == kinds(g) .and. names(:g - 1) == names(g), .true., dim=1)
         if (names(g) == '' .or. len_trim(names(g)) > NAME_LENGTH) then
            call raise(fault, EXIT_INPUT, place//': a name has 1 to '//whole(NAME_LENGTH)//' characters.')
         else if (any(WRITTEN == groups(g)%name) .and. verify(trim(names(g)), FIT) > 0) then
            call raise(fault, EXIT_INPUT, place//' becomes a file or a column: use letters, digits, "_", "-" and '// &
                       '"." alone.')
         else if (i > 0) then
            call raise(fault, EXIT_INPUT, place//' is given twice, first in line '// &
                       whole(groups(i)%entries(find_entry(groups(i), 'name'))%line)//'; names must differ.')
         end if
         if (fault%code /= 0) return
      end do
      do g = 1, size(groups)
         i = find_entry(groups(g), 'stages')
         if (i == 0) cycle
         associate (item => groups(g)%entries(i))
            do k = 1, item%count
               if (.not. any(names == item%values(k) .and. groups%name == 'stage')) call raise(fault, EXIT_GROUP, &
                  at_line(groups(g)%file, item%line)//'there is no stage '''//trim(item%values(k))//'''.')
            end do
         end associate
      end do
   end subroutine check_names
end module scene_names
