! SPDX-License-Identifier: MIT
!> Names of a scene: a name that other groups refer to is unique, a name that becomes a file or a column is valid for
!> that, and the stages that groups name are there.
module scene_names
   use scene_parts, only: NAME_LENGTH
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use material_registry, only: is_law
   use namelists, only: group_t, find_entry
   use texts, only: whole, LENGTH
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
      character(:), allocatable :: place
      character(LENGTH) :: names(size(groups))
      integer :: lists(size(groups)), g, i, k

      names = ''
      do g = 1, size(groups)
         lists(g) = list_of(groups(g))
         if (lists(g) == 0) cycle
         associate (item => groups(g)%entries(find_entry(groups(g), 'name')))
            names(g) = item%values(1)
            place = at_line(groups(g)%file, item%line)//'name = '''//trim(names(g))//''''
         end associate
         i = findloc(lists(:g - 1) == lists(g) .and. names(:g - 1) == names(g), .true., dim=1)
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

   !> Number of the list that a group's name belongs to, 0 if it has none.
   integer function list_of(group) result(number)
      type(group_t), intent(in) :: group

      number = findloc(NAMED, group%name, dim=1)
      if (is_law(group%name)) number = OF_MATERIALS
   end function list_of
end module scene_names
