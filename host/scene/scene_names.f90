! SPDX-License-Identifier: MIT
!> Names of a scene: a name that other groups refer to is unique, a name that becomes a file or a column is valid for
!> that, and the stages that groups name are there.
module scene_names
   use scene_parts, only: NAME_LENGTH
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use material_registry, only: is_law
   use namelists, only: group_t, entry_t, find_entry
   use texts, only: whole
   implicit none (type, external)
   private
   public :: check_names

   !> Groups with names; those of one list share them.
   character(12), parameter :: NAMED(7) = [character(12) :: 'retention', 'permeability', 'history', 'stage', 'point', &
      'plate', 'contact']
   integer, parameter :: OF_MATERIALS = size(NAMED) + 1   !< All laws share one list.
   character(12), parameter :: WRITTEN(4) = [character(12) :: 'stage', 'point', 'plate', 'contact']
   character(*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   character(*), parameter :: FIT = LETTERS//'0123456789_-.'
contains
   !> Of groups whose keys are those of the list. Fault EXIT_INPUT: a name is empty, too long, given twice, or holds
   !> what no file name should. Fault EXIT_GROUP: a stage that nobody defines.
   subroutine check_names(groups, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: name, place
      integer :: g, i, of

      do g = 1, size(groups)
         of = list_of(groups(g))
         if (of == 0) cycle
         associate (item => groups(g)%entries(find_entry(groups(g), 'name')))
            name = trim(item%values(1))
            place = at_line(groups(g)%file, item%line)//'name = '''//name//''''
         end associate
         if (name == '' .or. len(name) > NAME_LENGTH) then
            call raise(fault, EXIT_INPUT, place//': a name has 1 to '//whole(NAME_LENGTH)//' characters.')
         else if (any(WRITTEN == groups(g)%name) .and. verify(name, FIT) > 0) then
            call raise(fault, EXIT_INPUT, place//' becomes a file or a column: use letters, digits, "_", "-" and '// &
                       '"." alone.')
         end if
         do i = 1, g - 1
            if (list_of(groups(i)) /= of .or. fault%code /= 0) cycle
            associate (item => groups(i)%entries(find_entry(groups(i), 'name')))
               if (item%values(1) == name) call raise(fault, EXIT_INPUT, place//' is given twice, first in line '// &
                                                      whole(item%line)//'; names must differ.')
            end associate
         end do
         if (fault%code /= 0) return
      end do
      do g = 1, size(groups)
         i = find_entry(groups(g), 'stages')
         if (i > 0) call check_stages(groups, groups(g)%file, groups(g)%entries(i), fault)
      end do
   end subroutine check_names

   subroutine check_stages(groups, file, item, fault)
      type(group_t), intent(in) :: groups(:)
      character(*), intent(in) :: file
      type(entry_t), intent(in) :: item
      type(fault_t), intent(inout) :: fault
      integer :: g, k

      each: do k = 1, item%count
         do g = 1, size(groups)
            if (groups(g)%name /= 'stage') cycle
            if (groups(g)%entries(find_entry(groups(g), 'name'))%values(1) == item%values(k)) cycle each
         end do
         call raise(fault, EXIT_GROUP, at_line(file, item%line)//'there is no stage '''//trim(item%values(k))//'''.')
      end do each
   end subroutine check_stages

   !> Number of the list that a group's name belongs to, 0 if it has none.
   integer function list_of(group) result(number)
      type(group_t), intent(in) :: group

      number = findloc(NAMED, group%name, dim=1)
      if (is_law(group%name)) number = OF_MATERIALS
   end function list_of
end module scene_names
