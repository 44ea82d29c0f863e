! SPDX-License-Identifier: MIT
!> Names that a scene uses for what is defined elsewhere in it, or in its mesh.
module name_search
   use faults, only: fault_t, raise
   use exit_codes, only: EXIT_GROUP
   use key_table, only: key_table_t
   use model_types, only: model_t
   use texts, only: joined, LENGTH
   use triangle_mesh, only: mesh_t, find_group
   implicit none (type, external)
   private
   public :: mesh_group, defined_name, history_named, read_stages
contains
   !> Finds a group of the mesh that is to be used; a fault names those that there are. Fault EXIT_GROUP: there is none,
   !> one without entities, or two of them; 0 then.
   integer function mesh_group(mesh, name, place, fault) result(group)
      type(mesh_t), intent(in) :: mesh
      character(*), intent(in) :: name, place   !< Place: where the scene says it.
      type(fault_t), intent(inout) :: fault

      group = find_group(mesh, trim(name))
      if (group == 0) call raise(fault, EXIT_GROUP, place//'the mesh has no group '''//trim(name)//'''; it has'// &
                                 listed(mesh%groups%name)//'.')
      if (group == 0) return
      if (size(mesh%groups(group)%nodes) == 0) then
         call raise(fault, EXIT_GROUP, place//'the group '''//trim(name)//''' of the mesh is empty: no element, '// &
                    'edge or point has its physical number; assign it again in Gmsh.')
      else if (count(mesh%groups%name == name) > 1) then
         call raise(fault, EXIT_GROUP, place//'the mesh has groups '''//trim(name)//''' of several dimensions '// &
                    '(points, curves, surfaces), and this could mean each of them; give them names of their own.')
      else
         return
      end if
      group = 0
   end function mesh_group

   !> Finds a name among definitions. Fault EXIT_GROUP: it is not among them; 0 then.
   integer function defined_name(key, name, names, place, fault) result(found)
      character(*), intent(in) :: key, name, names(:), place   !< For the fault: key, place. names: (definitions).
      type(fault_t), intent(inout) :: fault

      found = findloc(names == name, .true., dim=1)
      if (found == 0 .and. name == '') then
         call raise(fault, EXIT_GROUP, place//key//' is missing: name one; there is'//listed(names)//'.')
      else if (found == 0) then
         call raise(fault, EXIT_GROUP, place//key//' = '''//trim(name)//''' is defined nowhere; there is'// &
                    listed(names)//'.')
      end if
   end function defined_name

   !> Finds a history, 0 where none is named. Fault EXIT_GROUP: it is not defined.
   integer function history_named(name, names, place, fault) result(found)
      character(*), intent(in) :: name, names(:), place   !< As of defined_name.
      type(fault_t), intent(inout) :: fault

      found = 0
      if (name /= '') found = defined_name('history', name, names, place, fault)
   end function history_named

   !> Reads the key `stages` of a group, once the stages are known: in which of them it acts, in all without the key.
   !> That there are stages of these names is known (scene_names).
   subroutine read_stages(k, model, in_stage, meaning)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(in) :: model
      logical, allocatable, intent(out) :: in_stage(:)   !< (stages)
      character(*), intent(in), optional :: meaning      !< Of the key, where it is another one.
      character(LENGTH), allocatable :: names(:)
      integer :: s

      if (present(meaning)) call k%texts('stages', names, meaning)
      if (.not. present(meaning)) call k%texts('stages', names, 'names of stages; default: all')
      if (k%lists) return
      in_stage = [(size(names) == 0 .or. any(names == model%stages(s)%name), s=1, size(model%stages))]
   end subroutine read_stages

   pure function listed(names) result(list)
      character(*), intent(in) :: names(:)
      character(:), allocatable :: list

      list = ' nothing'
      if (size(names) > 0) list = ' '//joined(names, ' ')
   end function listed
end module name_search
