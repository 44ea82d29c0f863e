! SPDX-License-Identifier: MIT
!> The groups of a scene, and who builds the model of each. A builder declares the keys of its group, each by one
!> statement: name, the value that it sets, range or words, meaning, and when it has an effect. With a table that only
!> lists it ends there: so checks, the template and the warnings about keys without effect have their keys.
module scene_keys
   use boundary_builder, only: build_plate, build_initial, build_fix, build_load, build_contact, build_tie
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: key_t, REQUIRED, check_group, given, line_of
   use key_table, only: key_table_t, listing
   use material_registry, only: is_law, law_names, law_keys
   use mesh_builder, only: build_mesh
   use model_types, only: model_t
   use namelists, only: group_t, MAX_VALUES
   use region_builder, only: build_retention, build_permeability, build_region
   use settings_builder, only: build_settings, build_fluids, build_point
   use stage_builder, only: build_history, build_stage
   use term_registry, only: with_own_groups, declare_keys
   implicit none (type, external)
   private
   public :: build_group, check_keys, keys_of_scenes, print_template

   character(12), parameter :: GROUPS(*) = [character(12) :: 'scene', 'mesh', 'fluids', 'retention', 'permeability', &
      'region', 'initial', 'history', 'stage', 'fix', 'load', 'tie', 'plate', 'contact', 'point']
contains
   !> Builds the part of a model that the group of a table says, or lists its keys. Faults: those of its builder. Groups
   !> of terms are built by these.
   subroutine build_group(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault

      select case (k%group%name)
      case ('scene')
         call build_settings(k, model, fault)
      case ('mesh')
         call build_mesh(k, model, fault)
      case ('fluids')
         call build_fluids(k, model)
      case ('retention')
         call build_retention(k, model)
      case ('permeability')
         call build_permeability(k, model, fault)
      case ('region')
         call build_region(k, model, fault)
      case ('initial')
         call build_initial(k, model, fault)
      case ('history')
         call build_history(k, model, fault)
      case ('stage')
         call build_stage(k, model, fault)
      case ('fix')
         call build_fix(k, model, fault)
      case ('load')
         call build_load(k, model, fault)
      case ('tie')
         call build_tie(k, model, fault)
      case ('plate')
         call build_plate(k, model, fault)
      case ('contact')
         call build_contact(k, model, fault)
      case ('point')
         call build_point(k, model, fault)
      end select
   end subroutine build_group

   !> The keys of all groups but those of laws of materials, in the order of the template.
   function keys_of_scenes() result(keys)
      type(key_t), allocatable :: keys(:)
      type(key_table_t) :: table
      type(model_t) :: nothing
      type(fault_t) :: fault
      character(12), allocatable :: names(:)
      integer :: g

      allocate (names, source=with_own_groups(GROUPS))
      table = listing('')
      do g = 1, size(names)
         table%group%name = names(g)
         ! What a group lacks is no fault of a list.
         fault = fault_t()
         call build_group(table, nothing, fault)
         call declare_keys(table, nothing, fault)
      end do
      call move_alloc(table%keys, keys)
   end function keys_of_scenes

   !> Refuses unknown groups and keys, missing ones, and values of the wrong kind or outside their range. Fault
   !> EXIT_INPUT, at the first. Keys of laws are checked where they are built.
   subroutine check_keys(groups, fault)
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      type(fault_t), intent(inout) :: fault
      type(key_t), allocatable :: keys(:)
      integer :: g

      allocate (keys, source=[keys_of_scenes(), names_of_laws()])
      do g = 1, size(groups)
         if (groups(g)%name == 'scene') call refuse_old_keys(groups(g), fault)
         if (fault%code == 0) call check_group(keys, groups(g), is_law(groups(g)%name), fault)
         if (fault%code /= 0) return
      end do
   end subroutine check_keys

   !> The key of laws of materials that is none of their own.
   function names_of_laws() result(keys)
      type(key_t), allocatable :: keys(:)
      character(12), allocatable :: laws(:)
      integer :: g

      allocate (laws, source=law_names())
      keys = [(key_t(laws(g), 'name', 't', REQUIRED, 0, 0, 'name, for the key material of &region'), g=1, size(laws))]
   end function names_of_laws

   !> Fault EXIT_INPUT: a key that older scenes have, with what says it today.
   subroutine refuse_old_keys(group, fault)
      type(group_t), intent(in) :: group   !< &scene.
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: OLD(8) = [character(20) :: 'accuracy', 'mesh', 'budget', 'ordering', 'effects', &
         'effects_tolerance', 'effects_pilot_share', 'effects_on_warning']
      character(*), parameter :: MEASURES = ' --accuracy A" measures the errors of the answers, and refines steps '// &
         'and mesh until they are below A.'
      character(:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(OLD)
         if (.not. given(group, trim(OLD(i))) .or. fault%code /= 0) cycle
         if (i == 1) then
            text = 'the local tolerance of the steps is now step_tolerance; "mud_study accuracy '//trim(group%file)// &
                   MEASURES
         else if (i <= 3) then
            text = 'leave it out; "mud_study accuracy '//trim(group%file)//MEASURES
         else if (i == 4) then
            text = 'leave it out; the equations are ordered by AMD, beyond 10,000 unknowns by METIS.'
         else
            text = 'leave it out, and give analysis, fields and gravity; "mud_study effects '//trim(group%file)// &
                   '" measures what each effect changes and writes the scene without those that do not matter.'
         end if
         call raise(fault, EXIT_INPUT, at_line(group%file, line_of(group, trim(OLD(i))))//trim(OLD(i))// &
                    ' is no key of &scene any more: '//text)
      end do
   end subroutine refuse_old_keys

   !> Every key with its default and meaning, as a scene to start from.
   subroutine print_template(unit)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(key_t), allocatable :: all_keys(:)
      character(12), allocatable :: laws(:)
      integer :: g, k

      allocate (all_keys, source=[keys_of_scenes(), names_of_laws()])
      allocate (laws, source=law_names())
      do g = 1, size(laws)
         all_keys = [all_keys, law_keys(laws(g), laws(g))]
      end do
      write (unit, '(a)') '! Every group and key of a scene. Lines that begin with "!" may be left out.'
      write (unit, '(a,i0,a)') '! Groups but &scene, &mesh and &fluids may occur several times; lists hold up to ', &
         MAX_VALUES, ' values.'
      do g = 1, size(all_keys)
         if (any(all_keys(:g - 1)%group == all_keys(g)%group)) cycle
         write (unit, '(2a)') '&', trim(all_keys(g)%group)
         do k = g, size(all_keys)
            if (all_keys(k)%group == all_keys(g)%group) call print_key(all_keys(k))
         end do
         write (unit, '(a)') '/'
      end do
   contains
      subroutine print_key(key)
         type(key_t), intent(in) :: key
         character(:), allocatable :: value, meaning

         value = trim(key%preset)
         if (value == REQUIRED) value = '?'
         if (index('twT', key%kind) > 0) value = ''''//value//''''
         meaning = trim(key%meaning)
         if (key%words /= '') meaning = trim(key%words)//': '//meaning
         value = trim(key%name)//' = '//value
         write (unit, '(4a)') merge('     ', '   ! ', key%preset == REQUIRED), value, &
            repeat(' ', max(1, 34 - len(value))), '! '//meaning
      end subroutine print_key
   end subroutine print_template
end module scene_keys
