! SPDX-License-Identifier: MIT
!> What of a scene has had its effect by a moment: a run may go on with a scene that says the same about the past and
!> something else about the future: a longer stage, further stages, supports and loads of these alone, histories that
!> go on. Everything else of a scene belongs to the past.
module scene_past
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   use namelists, only: group_t, LENGTH
   use scene_fingerprint, only: hash_t, add_text, text_of_hash, is_free
   use scene_types, only: amplitude_t, amplitude_at
   use texts, only: lower_case, whole
   implicit none (type, external)
   private
   public :: past_of_scene, first_difference

   character(*), parameter :: END_OF_LINE = new_line('a')
contains
   !> The first stages of a scene, the last of them up to a time, one key a line, as "&fix 3 (top): value = -0.1".
   function past_of_scene(groups, amplitudes, stages, time) result(text)
      type(group_t), intent(in) :: groups(:)       !< Of the scene, sealed. (groups)
      type(amplitude_t), intent(in) :: amplitudes(:)   !< All of the scene. (histories)
      integer, intent(in) :: stages                !< That have begun.
      real(wp), intent(in) :: time                 !< [s]
      character(:), allocatable :: text
      character(LENGTH) :: begun(stages)
      integer :: g, i, k, n

      n = 0
      begun = ''
      do g = 1, size(groups)
         if (groups(g)%name /= 'stage' .or. n == stages) cycle
         n = n + 1
         begun(n) = value_of(groups(g), 'name')
      end do
      text = ''
      do g = 1, size(groups)
         associate (group => groups(g))
            if (.not. has_begun(g)) cycle
            n = count([(groups(i)%name == group%name .and. has_begun(i), i=1, g)])
            do i = 1, group%count
               associate (item => group%entries(i))
                  if (is_free(item%key)) cycle
                  if (group%name == 'stage' .and. n == stages .and. lower_case(item%key) == 'duration') cycle
                  text = text//'&'//trim(group%name)//' '//whole(n)//called(group)//': '//lower_case(trim(item%key))// &
                         ' ='
                  do k = 1, item%count
                     if (lower_case(item%key) == 'stages') then
                        if (.not. any(begun == item%values(k))) cycle
                     end if
                     text = text//' '//trim(item%values(k))
                     if (index(lower_case(item%key), 'history') > 0) text = text//values_of(item%values(k))
                  end do
                  text = text//END_OF_LINE
               end associate
            end do
         end associate
      end do
   contains
      !> Whether a group takes part in what has begun. A history does where it is used.
      logical function has_begun(g)
         integer, intent(in) :: g
         integer :: j, v

         has_begun = groups(g)%name /= 'history'
         if (groups(g)%name == 'stage') has_begun = any(begun == value_of(groups(g), 'name'))
         if (groups(g)%name /= 'fix' .and. groups(g)%name /= 'load') return
         do j = 1, groups(g)%count
            if (lower_case(groups(g)%entries(j)%key) /= 'stages') cycle
            has_begun = any([(any(begun == groups(g)%entries(j)%values(v)), v=1, groups(g)%entries(j)%count)])
         end do
      end function has_begun

      !> Fingerprint of the pairs up to the moment, and of the factor at it: what follows may change.
      function values_of(name) result(part)
         character(*), intent(in) :: name
         character(:), allocatable :: part
         type(hash_t) :: hash
         integer :: a, j

         part = ''
         a = findloc(amplitudes%name == name, .true., dim=1)
         if (a == 0) return
         do j = 1, size(amplitudes(a)%times)
            if (amplitudes(a)%times(j) > time) exit
            call add_number(amplitudes(a)%times(j), hash)
            call add_number(amplitudes(a)%values(j), hash)
         end do
         call add_number(amplitude_at(amplitudes(a), time), hash)
         part = ' (its values so far: '//text_of_hash(hash)//')'
      end function values_of

      subroutine add_number(value, hash)
         real(wp), intent(in) :: value
         type(hash_t), intent(inout) :: hash
         character(16) :: digits

         write (digits, '(z16.16)') transfer(value, 0_int64)
         call add_text(digits, hash)
      end subroutine add_number
   end function past_of_scene

   !> Name of a group, or the group of the mesh that it is about, in parentheses.
   pure function called(group) result(text)
      type(group_t), intent(in) :: group
      character(:), allocatable :: text

      text = trim(value_of(group, 'name'))
      if (text == '') text = trim(value_of(group, 'group'))
      if (text /= '') text = ' ('//text//')'
   end function called

   !> The first key in which two pasts differ, as a sentence; empty where they are the same.
   function first_difference(here, there) result(text)
      character(*), intent(in) :: here, there   !< Of the scene, and of the checkpoint.
      character(:), allocatable :: text, mine, theirs, key
      integer :: at, at_there

      text = ''
      if (here == there .and. len(here) == len(there)) return
      at = 1
      at_there = 1
      do
         mine = line_at(here, at)
         theirs = line_at(there, at_there)
         if (mine /= theirs .or. mine == '') exit
         at = at + len(mine) + 1
         at_there = at_there + len(theirs) + 1
      end do
      key = mine(:index(mine, ' =') - 1)
      if (mine /= '' .and. index(theirs, key//' =') == 1) then
         text = key//' is '//short_value(mine)//' here, and '//short_value(theirs)//' in the checkpoint'
      else if (mine /= '' .and. index(END_OF_LINE//there, END_OF_LINE//mine//END_OF_LINE) == 0) then
         text = 'the checkpoint has no '//key//' = '//short_value(mine)
      else
         text = 'here is no '//theirs(:index(theirs, ' =') - 1)//' = '//short_value(theirs)
      end if
   contains
      pure function line_at(lines, first) result(line)
         character(*), intent(in) :: lines
         integer, intent(in) :: first
         character(:), allocatable :: line

         line = ''
         if (first <= len(lines)) line = lines(first:first + index(lines(first:), END_OF_LINE) - 2)
      end function line_at

      pure function short_value(line) result(value)
         character(*), intent(in) :: line
         character(:), allocatable :: value
         integer, parameter :: LONGEST = 60

         value = line(index(line, ' =') + 3:)
         if (len(value) > LONGEST) value = value(:LONGEST)//' ...'
      end function short_value
   end function first_difference

   pure function value_of(group, key) result(value)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: key
      character(LENGTH) :: value
      integer :: i

      value = ''
      do i = 1, group%count
         if (lower_case(group%entries(i)%key) == key) value = group%entries(i)%values(1)
      end do
   end function value_of
end module scene_past
