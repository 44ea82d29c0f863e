! SPDX-License-Identifier: MIT
!> What of a scene has had its effect by a moment: a run may go on with a scene that says the same about the past and
!> something else about the future: a longer stage, further stages, supports and loads of these alone, histories that
!> go on. Everything else of a scene belongs to the past.
module scene_past
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   use namelists, only: group_t, LENGTH
   use scene_fingerprint, only: hash_t, add_text, text_of_hash, is_free
   use scene_types, only: scene_amplitude_t, amplitude_at, FINGERPRINT_LENGTH
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: past_fingerprint
contains
   !> Fingerprint of the first stages of a scene, the last of them up to a time.
   function past_fingerprint(groups, amplitudes, stages, time) result(text)
      type(group_t), intent(in) :: groups(:)       !< Of the scene, sealed. (groups)
      type(scene_amplitude_t), intent(in) :: amplitudes(:)   !< All of the scene. (histories)
      integer, intent(in) :: stages                !< That have begun.
      real(wp), intent(in) :: time                 !< [s]
      character(FINGERPRINT_LENGTH) :: text
      type(hash_t) :: hash
      character(LENGTH) :: begun(stages)
      integer :: g, i, k, n

      n = 0
      begun = ''
      do g = 1, size(groups)
         if (groups(g)%name /= 'stage' .or. n == stages) cycle
         n = n + 1
         begun(n) = value_of(groups(g), 'name')
      end do
      n = 0
      do g = 1, size(groups)
         associate (group => groups(g))
            if (group%name == 'history') cycle   ! where it is used
            if (group%name == 'stage') n = n + 1
            if (group%name == 'stage' .and. n > stages) cycle
            if ((group%name == 'fix' .or. group%name == 'load') .and. .not. has_begun(group)) cycle
            call add_text('&'//trim(group%name), hash)
            do i = 1, group%count
               associate (item => group%entries(i))
                  if (is_free(item%key)) cycle
                  if (group%name == 'stage' .and. n == stages .and. lower_case(item%key) == 'duration') cycle
                  call add_text(' '//lower_case(trim(item%key)), hash)
                  do k = 1, item%count
                     if (lower_case(item%key) == 'stages') then
                        if (.not. any(begun == item%values(k))) cycle
                     end if
                     call add_text('='//trim(item%values(k)), hash)
                     if (lower_case(item%key) == 'history') call add_amplitude(item%values(k))
                  end do
               end associate
            end do
         end associate
      end do
      text = text_of_hash(hash)
   contains
      !> Whether a group that may be limited to stages takes part in one that has begun.
      logical function has_begun(group)
         type(group_t), intent(in) :: group
         integer :: i, k

         has_begun = .true.
         do i = 1, group%count
            if (lower_case(group%entries(i)%key) /= 'stages') cycle
            has_begun = any([(any(begun == group%entries(i)%values(k)), k=1, group%entries(i)%count)])
         end do
      end function has_begun

      !> Pairs up to the moment, and the factor at it: what follows may change.
      subroutine add_amplitude(name)
         character(*), intent(in) :: name
         integer :: a, j

         a = findloc(amplitudes%name == name, .true., dim=1)
         if (a == 0) return
         do j = 1, size(amplitudes(a)%times)
            if (amplitudes(a)%times(j) > time) exit
            call add_number(amplitudes(a)%times(j))
            call add_number(amplitudes(a)%values(j))
         end do
         call add_number(amplitude_at(amplitudes(a), time))
      end subroutine add_amplitude

      subroutine add_number(value)
         real(wp), intent(in) :: value
         character(16) :: digits

         write (digits, '(z16.16)') transfer(value, 0_int64)
         call add_text(digits, hash)
      end subroutine add_number
   end function past_fingerprint

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
