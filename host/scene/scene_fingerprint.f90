! SPDX-License-Identifier: MIT
!> Fingerprint of a scene: its groups, keys and values in their order, and the contents of the files that it names.
!> Comments, spaces and what changes no result take no part.
module scene_fingerprint
   use, intrinsic :: iso_fortran_env, only: int64
   use namelists, only: group_t
   use scene_types, only: FINGERPRINT_LENGTH
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: fingerprint_of, hash_t, add_text, text_of_hash, with_fingerprints, is_free

   integer, parameter :: BLOCK = 65536
   ! Two polynomial hashes modulo primes below 2**31: products stay below 2**63.
   integer(int64), parameter :: PRIMES(2) = [2147483647_int64, 2147483629_int64], BASES(2) = [65599_int64, 31337_int64]
   character(*), parameter :: FREE(*) = [character(18) :: 'threads', 'checkpoint_steps', 'checkpoint_seconds', &
                                    'checkpoint_end', 'goals']

   type :: hash_t
      integer(int64) :: parts(2) = 1
   end type hash_t
contains
   !> Fingerprint of groups as 16 hexadecimal digits. A file that cannot be read counts by its name alone.
   function fingerprint_of(groups) result(text)
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      character(FINGERPRINT_LENGTH) :: text
      type(hash_t) :: hash
      integer :: g, i, k

      do g = 1, size(groups)
         call add_text('&'//trim(groups(g)%name), hash)
         do i = 1, groups(g)%count
            associate (item => groups(g)%entries(i))
               if (is_free(item%key)) cycle
               call add_text(' '//lower_case(trim(item%key)), hash)
               do k = 1, item%count
                  call add_text('='//trim(item%values(k)), hash)
               end do
               if (lower_case(item%key) == 'file') call add_file(trim(groups(g)%file), trim(item%values(1)), hash)
            end associate
         end do
      end do
      text = text_of_hash(hash)
   end function fingerprint_of

   !> Whether a key changes no result.
   pure logical function is_free(key)
      character(*), intent(in) :: key

      is_free = any(FREE == lower_case(key))
   end function is_free

   !> A hash as 16 hexadecimal digits.
   pure function text_of_hash(hash) result(text)
      type(hash_t), intent(in) :: hash
      character(FINGERPRINT_LENGTH) :: text

      write (text, '(2z8.8)') hash%parts
   end function text_of_hash

   !> Groups with a fingerprint of the files that they name in place of the names, so that nothing has to be read again.
   function with_fingerprints(groups) result(copies)
      type(group_t), intent(in) :: groups(:)   !< (groups of the scene)
      type(group_t), allocatable :: copies(:)
      type(hash_t) :: hash
      integer :: g, i

      copies = groups
      do g = 1, size(groups)
         do i = 1, groups(g)%count
            associate (item => groups(g)%entries(i))
               if (lower_case(item%key) /= 'file') cycle
               hash = hash_t()
               call add_text(trim(item%values(1)), hash)
               call add_file(trim(groups(g)%file), trim(item%values(1)), hash)
               copies(g)%entries(i)%values(1) = text_of_hash(hash)
            end associate
         end do
      end do
   end function with_fingerprints

   !> Continues a hash by the characters of a text.
   pure subroutine add_text(text, hash)
      character(*), intent(in) :: text
      type(hash_t), intent(inout) :: hash
      integer :: i

      do i = 1, len(text)
         hash%parts = mod(hash%parts*BASES + iachar(text(i:i)) + 1, PRIMES)
      end do
   end subroutine add_text

   !> Contents of a file, its path seen from the scene. One that cannot be read is refused elsewhere.
   subroutine add_file(scene, path, hash)
      character(*), intent(in) :: scene, path
      type(hash_t), intent(inout) :: hash
      character(:), allocatable :: whole_path
      character(BLOCK) :: block_of
      integer :: unit, status, length, left

      whole_path = path
      if (path(1:1) /= '/') whole_path = scene(:index(scene, '/', back=.true.))//path
      open (newunit=unit, file=whole_path, access='stream', form='unformatted', status='old', action='read', &
            iostat=status)
      if (status /= 0) return
      inquire (unit=unit, size=length)
      left = length
      do while (left > 0 .and. status == 0)
         read (unit, iostat=status) block_of(:min(left, BLOCK))
         if (status == 0) call add_text(block_of(:min(left, BLOCK)), hash)
         left = left - BLOCK
      end do
      close (unit)
   end subroutine add_file
end module scene_fingerprint
