! SPDX-License-Identifier: MIT
!> Fingerprint of a scene: its groups, keys and values in their order, and the contents of the files that it names.
!> Comments, spaces and what changes no result take no part.
module scene_fingerprint
   use, intrinsic :: iso_fortran_env, only: int64
   use files, only: beside, read_whole
   use namelists, only: group_t
   use scene_parts, only: origin_t
   use texts, only: lower_case, whole
   implicit none (type, external)
   private
   public :: origin_of

   ! Two polynomial hashes modulo primes below 2**31: products stay below 2**63.
   integer(int64), parameter :: PRIMES(2) = [2147483647_int64, 2147483629_int64], BASES(2) = [65599_int64, 31337_int64]
   !> Keys that change no result.
   character(*), parameter :: FREE(*) = [character(18) :: 'threads', 'checkpoint_steps', 'checkpoint_seconds', 'goals']

contains
   !> Makes what tells a scene from others: the fingerprint of its groups, as 16 hexadecimal digits, and two numbers for
   !> every group, which differ where the group does. A file that cannot be read counts by its name alone. The name of
   !> the scene is that of a key, which is not read here.
   type(origin_t) function origin_of(file, groups) result(origin)
      character(*), intent(in) :: file
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      integer :: g

      origin%file = file
      write (origin%fingerprint, '(2z8.8)') hash_of(groups)
      allocate (origin%hashes(2*size(groups)), origin%groups(size(groups)))
      do g = 1, size(groups)
         origin%hashes(2*g - 1:2*g) = int(hash_of(groups(g:g)))
         origin%groups(g) = '&'//trim(groups(g)%name)//' in line '//whole(groups(g)%line)
      end do
   end function origin_of

   function hash_of(groups) result(hash)
      type(group_t), intent(in) :: groups(:)
      integer(int64) :: hash(2)
      integer :: g, i, k

      hash = 1
      do g = 1, size(groups)
         call add_text('&'//trim(groups(g)%name), hash)
         do i = 1, groups(g)%count
            associate (item => groups(g)%entries(i))
               if (any(FREE == lower_case(item%key))) cycle
               call add_text(' '//lower_case(trim(item%key)), hash)
               do k = 1, item%count
                  call add_text('='//trim(item%values(k)), hash)
               end do
               if (lower_case(item%key) == 'file') call add_file(trim(groups(g)%file), trim(item%values(1)), hash)
            end associate
         end do
      end do
   end function hash_of

   !> Adds the characters of a text to a hash.
   pure subroutine add_text(text, hash)
      character(*), intent(in) :: text
      integer(int64), intent(inout) :: hash(2)
      integer :: i

      do i = 1, len(text)
         hash = mod(hash*BASES + iachar(text(i:i)) + 1, PRIMES)
      end do
   end subroutine add_text

   !> Adds the contents of a file, whose path is seen from the scene. One that cannot be read is refused elsewhere.
   subroutine add_file(scene, path, hash)
      character(*), intent(in) :: scene, path
      integer(int64), intent(inout) :: hash(2)
      character(:), allocatable :: contents
      logical :: good

      call read_whole(beside(scene, path), contents, good)
      if (good) call add_text(contents, hash)
   end subroutine add_file
end module scene_fingerprint
