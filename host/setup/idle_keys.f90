! SPDX-License-Identifier: MIT
!> Keys of a scene that change nothing because another key says so, and definitions that nobody uses.
module idle_keys
   use faults, only: at_line
   use kinds, only: wp
   use key_schema, only: key_t, idle_reason, get_text, given, line_of, place_of
   use material_registry, only: is_law
   use model_types, only: model_t
   use namelists, only: group_t
   use porous_domain, only: COUPLED
   use scene_keys, only: keys_of_scenes
   use scene_types, only: scene_t
   use texts, only: LENGTH
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: warn_of_idle_keys
contains
   !> Warns of every key and every definition of a scene that has no effect.
   subroutine warn_of_idle_keys(scene, model)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(key_t), allocatable :: keys(:)
      integer :: g, i, k

      allocate (keys, source=keys_of_scenes())
      do i = 1, size(scene%absent)
         call print_warning(trim(scene%origin%file)//': without = '''//trim(scene%absent(i))// &
                            ''' of &scene has no effect: the scene does not have it.')
      end do
      do g = 1, size(scene%as_read)
         if (is_law(scene%as_read(g)%name)) then
            call judge_law(scene, model, scene%as_read(g))
            cycle
         end if
         do i = 1, scene%as_read(g)%count
            k = place_of(keys, scene%as_read(g)%name, scene%as_read(g)%entries(i)%key)
            if (k > 0) call judge(keys, keys(k), model, scene%as_read(g))
         end do
      end do
      call warn_of_unused_definitions(keys, scene)
   end subroutine warn_of_idle_keys

   !> Looks at the conditions of a key that a group gives.
   subroutine judge(keys, key, model, group)
      type(key_t), intent(in) :: keys(:), key
      type(model_t), intent(in) :: model
      type(group_t), intent(in) :: group
      character(:), allocatable :: why
      logical :: controlled
      integer :: i

      controlled = any(model%stages%controlled .and. model%stages%name == name_of(group))
      why = idle_reason(keys, key, group)
      if (why /= '') then
         ! Its own group says why.
      else if (index(key%acts, ':time') > 0 .and. .not. any(model%stages%has_rates)) then
         why = ': every stage is static and has no time; analysis = ''quasi_static'' of &stage has'
      else if (index(key%acts, ':dynamic') > 0 .and. .not. any(model%stages%has_inertia)) then
         why = ': no stage is dynamic'
      else if (index(key%acts, ':moving') > 0 .and. .not. model%stages(1)%has_inertia) then
         why = ': the run begins with stage '//trim(model%stages(1)%name)//', which has no inertia and leaves it '// &
               'at rest; begin with a dynamic stage, and give the stress of the start by stress of &initial'
      else if (index(key%acts, ':gravity') > 0 .and. .not. model%domain%gravity > 0.0_wp) then
         why = ' without gravity of &scene'
      else if (index(key%acts, ':controlled') > 0 .and. .not. controlled) then
         why = ' on steps that are given; leave out dt, or give steps = ''controlled'''
      else if (index(key%acts, ':given') > 0 .and. controlled) then
         why = ' on controlled steps; give dt and steps = ''given'''
      else if (index(key%acts, ':grows') > 0 .and. .not. (controlled .or. given(group, 'dt_growth'))) then
         why = ' on steps that are given without dt_growth'
      else if (index(key%acts, ':lanes') > 0 .and. &
               .not. any([(model%domain%regions(i)%law%has_lanes, i=1, size(model%domain%regions))])) then
         why = ': this processor is older than x86-64-v3, the library was built without lanes, or no region is of '// &
               '&mud with its guards and isotropic mechanism and without hysteresis, preloading and fluidity'
      else if (index(key%acts, ':p_w') > 0 .and. .not. model%domain%with_w) then
         why = ': the scene has no field p_w'
      else if (index(key%acts, ':p_c') > 0 .and. .not. model%domain%with_c) then
         why = ': the scene has no field p_c'
      else if (index(key%acts, ':flow') > 0 .and. .not. any(model%domain%regions%drainage == COUPLED)) then
         why = ': no &region has drainage = ''coupled'''
      end if
      if (why /= '') call tell(group, trim(key%name), why)
   end subroutine judge

   subroutine tell(group, key, why)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key, why   !< Why: the end of the sentence.

      if (given(group, key)) call print_warning(at_line(group%file, line_of(group, key))//key//' of &'// &
                                                trim(group%name)//' has no effect'//why//'.')
   end subroutine tell

   !> Keys of a law that act with suction, in a scene without it, and a void ratio that every region replaces.
   subroutine judge_law(scene, model, group)
      type(scene_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(group_t), intent(in) :: group
      integer :: m, i

      m = findloc(model%materials%name == name_of(group), .true., dim=1)
      if (m == 0) return
      associate (law => model%materials(m)%law)
         if (.not. model%domain%with_c .and. allocated(law%suction_keys)) then
            do i = 1, size(law%suction_keys)
               call tell(group, trim(law%suction_keys(i)), ': the scene has no field p_c')
            end do
         end if
         if (law%e_0 > 0.0_wp .and. replaced_everywhere()) &
            call tell(group, 'e_0', ': every &region of the material gives void_ratio')
      end associate
   contains
      logical function replaced_everywhere() result(everywhere)
         character(LENGTH) :: material
         integer :: i

         everywhere = .false.
         do i = 1, size(scene%as_read)
            if (scene%as_read(i)%name /= 'region') cycle
            material = ''
            call get_text(scene%as_read(i), 'material', material)
            if (material /= name_of(group)) cycle
            everywhere = given(scene%as_read(i), 'void_ratio')
            if (.not. everywhere) return
         end do
      end function replaced_everywhere
   end subroutine judge_law

   !> Warns of definitions, of a kind that keys refer to, that no key of the scene names.
   subroutine warn_of_unused_definitions(keys, scene)
      type(key_t), intent(in) :: keys(:)
      type(scene_t), intent(in) :: scene
      character(12) :: kind
      integer :: g

      do g = 1, size(scene%as_read)
         associate (group => scene%as_read(g))
            kind = group%name(:12)
            if (is_law(group%name)) kind = 'material'
            if (.not. any(keys%refers == kind)) cycle
            if (.not. is_referred_to(keys, scene%as_read, kind, name_of(group))) call print_warning( &
               at_line(group%file, group%line)//'&'//trim(group%name)//' '''//name_of(group)// &
               ''' has no effect: no group names it as its '//trim(kind)//'.')
         end associate
      end do
   end subroutine warn_of_unused_definitions

   !> Whether a group gives the name of a definition by a key that refers to its kind.
   logical function is_referred_to(keys, groups, kind, name)
      type(key_t), intent(in) :: keys(:)
      type(group_t), intent(in) :: groups(:)
      character(*), intent(in) :: kind, name
      character(LENGTH) :: text
      integer :: g, k

      is_referred_to = .false.
      do g = 1, size(groups)
         do k = 1, size(keys)
            if (keys(k)%group /= groups(g)%name .or. keys(k)%refers /= kind) cycle
            text = ''
            call get_text(groups(g), keys(k)%name, text)
            is_referred_to = is_referred_to .or. (given(groups(g), keys(k)%name) .and. text == name)
         end do
      end do
   end function is_referred_to

   !> Finds the name of a group, of laws as well.
   pure function name_of(group) result(name)
      type(group_t), intent(in) :: group
      character(:), allocatable :: name
      character(LENGTH) :: text

      text = ''
      call get_text(group, 'name', text)
      name = trim(text)
   end function name_of
end module idle_keys
