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
   use texts, only: LENGTH, shell_word
   implicit none (type, external)
   private
   public :: build_group, check_keys, check_counts, keys_of_scenes, print_template

   abstract interface
      !> Declares the keys of a group, and builds its part of a model unless the table only lists.
      subroutine build_i(k, model, fault)
         import :: key_table_t, model_t, fault_t
         type(key_table_t), intent(inout) :: k
         type(model_t), intent(inout) :: model
         type(fault_t), intent(inout) :: fault
      end subroutine build_i
   end interface

   type :: builder_t
      character(12) :: group
      procedure(build_i), pointer, nopass :: build => null()
      logical :: once = .false.     !< A scene has no two.
      logical :: needed = .false.   !< Without it there is nothing to do.
   end type builder_t
contains
   !> Lists all builders but those of terms, in the order of the template.
   subroutine list_builders(list)
      type(builder_t), allocatable, intent(out) :: list(:)

      allocate (list(0))
      call add('scene', build_settings, once=.true., needed=.true.)
      call add('mesh', build_mesh, once=.true., needed=.true.)
      call add('fluids', build_fluids, once=.true.)
      call add('retention', build_retention)
      call add('permeability', build_permeability)
      call add('region', build_region, needed=.true.)
      call add('initial', build_initial)
      call add('history', build_history)
      call add('stage', build_stage, needed=.true.)
      call add('fix', build_fix)
      call add('load', build_load)
      call add('tie', build_tie)
      call add('plate', build_plate)
      call add('contact', build_contact)
      call add('point', build_point)
   contains
      subroutine add(group, build, once, needed)
         character(*), intent(in) :: group
         procedure(build_i) :: build
         logical, intent(in), optional :: once, needed
         type(builder_t) :: one

         one%group = group
         one%build => build
         if (present(once)) one%once = once
         if (present(needed)) one%needed = needed
         list = [list, one]
      end subroutine add
   end subroutine list_builders

   !> Builds the part of a model that the group of a table says, or lists its keys. Faults: those of its builder. Groups
   !> of terms are built by these.
   subroutine build_group(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(builder_t), allocatable :: list(:)
      integer :: i

      call list_builders(list)
      i = findloc(list%group, k%group%name, dim=1)
      if (i > 0) call list(i)%build(k, model, fault)
   end subroutine build_group

   !> Lists the keys of all groups in the order of the template, of laws of materials the one that is none of their own.
   function keys_of_scenes() result(keys)
      type(key_t), allocatable :: keys(:)
      type(key_table_t) :: table
      type(builder_t), allocatable :: list(:)
      type(model_t) :: nothing
      type(fault_t) :: fault
      character(12), allocatable :: names(:), laws(:)
      character(LENGTH) :: name
      integer :: g

      call list_builders(list)
      allocate (names, source=with_own_groups(list%group))
      allocate (laws, source=law_names())
      table = listing('')
      name = ''
      do g = 1, size(names)
         table%group%name = names(g)
         ! What a group lacks is no fault of a list.
         fault = fault_t()
         call build_group(table, nothing, fault)
         call declare_keys(table, nothing, fault)
      end do
      do g = 1, size(laws)
         table%group%name = laws(g)
         call table%text('name', name, 'name, for the key material of &region', REQUIRED)
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

      allocate (keys, source=keys_of_scenes())
      do g = 1, size(groups)
         if (groups(g)%name == 'scene') call refuse_old_keys(groups(g), fault)
         if (fault%code == 0) call check_group(keys, groups(g), is_law(groups(g)%name), fault)
         if (fault%code /= 0) return
      end do
   end subroutine check_keys

   !> Refuses keys of other programs or of older scenes, to which the nearest name would mislead. Fault EXIT_INPUT.
   subroutine refuse_old_keys(group, fault)
      type(group_t), intent(in) :: group   !< &scene.
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: EFFECTS(4) = [character(19) :: 'effects', 'effects_tolerance', 'effects_pilot_share', &
                                               'effects_on_warning']
      integer :: i

      call refuse('accuracy', 'the local tolerance of the steps is now step_tolerance; '//measures())
      call refuse('mesh', 'leave it out; '//measures())
      call refuse('budget', 'leave it out; '//measures())
      call refuse('ordering', 'leave it out; the equations are ordered by AMD, beyond 10,000 unknowns by METIS.')
      do i = 1, size(EFFECTS)
         call refuse(trim(EFFECTS(i)), 'leave it out, and give analysis, fields and gravity; "mud_study effects '// &
                     shell_word(group%file)//'" measures what each effect changes and writes the scene without '// &
                     'those that do not matter.')
      end do
   contains
      function measures() result(text)
         character(:), allocatable :: text

         text = '"mud_study accuracy '//shell_word(group%file)//' --accuracy A" measures the errors of the answers'// &
                ', and refines steps and mesh until they are below A.'
      end function measures

      subroutine refuse(key, instead)
         character(*), intent(in) :: key, instead

         if (given(group, key) .and. fault%code == 0) call raise(fault, EXIT_INPUT, &
            at_line(group%file, line_of(group, key))//key//' is no key of &scene any more: '//instead)
      end subroutine refuse
   end subroutine refuse_old_keys

   !> Groups that occur once, and those without which there is nothing to do. Fault EXIT_INPUT.
   subroutine check_counts(file, groups, fault)
      character(*), intent(in) :: file
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      type(fault_t), intent(inout) :: fault
      type(builder_t), allocatable :: list(:)
      integer :: i, n

      call list_builders(list)
      do i = 1, size(list)
         n = count(groups%name == list(i)%group)
         if (list(i)%once .and. n > 1) call raise(fault, EXIT_INPUT, trim(file)//': &'//trim(list(i)%group)// &
                                                  ' is given more than once; keep one.')
         if (list(i)%needed .and. n == 0) call raise(fault, EXIT_INPUT, trim(file)//': the group &'// &
            trim(list(i)%group)//' is missing; mud_host --template prints every group.')
      end do
   end subroutine check_counts

   !> Writes every key with its default and meaning, as a scene to start from.
   subroutine print_template(unit)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(key_t), allocatable :: all_keys(:)
      character(12), allocatable :: laws(:)
      integer :: g, k

      allocate (all_keys, source=keys_of_scenes())
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
