! SPDX-License-Identifier: MIT
!> The checksum of the first bytes of an HDF5 file in the format of 1.8. HDF5 1.10 clears a flag there when it copies an
!> open file from memory and leaves the checksum as it was, so that nobody can open the copy.
!> Layout: HDF5 File Format Specification, II.A, version 2; the checksum is lookup3 by Bob Jenkins (public domain).
module hdf5_superblock
   use, intrinsic :: iso_c_binding, only: c_int8_t
   use, intrinsic :: iso_fortran_env, only: int64
   implicit none (type, external)
   private
   public :: seal_superblock, lookup3

   integer, parameter :: COVERED = 44   !< Bytes before the checksum of four.
   integer(int64), parameter :: MASK = 4294967295_int64
contains
   !> Puts the checksum into an image whose superblock has version 2; leaves others alone. image(:) is the whole file,
   !> byte by byte; one that is too short is left alone. HDF5 File Format Specification, II.A.
   pure subroutine seal_superblock(image)
      integer(c_int8_t), intent(inout) :: image(:)
      integer(int64) :: sum_of
      integer :: i

      if (size(image) < COVERED + 4) return
      if (image(9) /= 2) return
      sum_of = lookup3(image(:COVERED))
      do i = 1, 4
         image(COVERED + i) = byte(ibits(sum_of, 8*(i - 1), 8))
      end do
   end subroutine seal_superblock

   pure integer(c_int8_t) function byte(value)
      integer(int64), intent(in) :: value   !< 0 to 255.

      byte = int(merge(value - 256, value, value > 127), c_int8_t)
   end function byte

   !> Hash of some bytes, 0 to 2**32 - 1; arithmetic modulo 2**32. bytes(:) of any size above 0. Bob Jenkins, lookup3.c,
   !> hashlittle with the initial value 0.
   pure integer(int64) function lookup3(bytes) result(hash)
      integer(c_int8_t), intent(in) :: bytes(:)
      integer(int64) :: a, b, c
      integer :: at

      a = iand(3735928559_int64 + size(bytes), MASK)   ! hexadecimal deadbeef
      b = a
      c = a
      at = 0
      do
         a = iand(a + word(at), MASK)
         b = iand(b + word(at + 4), MASK)
         c = iand(c + word(at + 8), MASK)
         at = at + 12
         if (at >= size(bytes)) exit
         call mix(a, c, b, 4)
         call mix(b, a, c, 6)
         call mix(c, b, a, 8)
         call mix(a, c, b, 16)
         call mix(b, a, c, 19)
         call mix(c, b, a, 4)
      end do
      call last(c, b, 14)
      call last(a, c, 11)
      call last(b, a, 25)
      call last(c, b, 16)
      call last(a, c, 4)
      call last(b, a, 14)
      call last(c, b, 24)
      hash = c
   contains
      !> Four bytes, the lowest first; those beyond the end are 0.
      pure integer(int64) function word(from)
         integer, intent(in) :: from
         integer :: i

         word = 0
         do i = from + 1, min(from + 4, size(bytes))
            word = ior(word, shiftl(iand(int(bytes(i), int64), 255_int64), 8*(i - from - 1)))
         end do
      end function word
   end function lookup3

   pure subroutine mix(x, y, z, turns)
      integer(int64), intent(inout) :: x, y
      integer(int64), intent(in) :: z
      integer, intent(in) :: turns

      x = ieor(iand(x - y, MASK), turned(y, turns))
      y = iand(y + z, MASK)
   end subroutine mix

   pure subroutine last(x, y, turns)
      integer(int64), intent(inout) :: x
      integer(int64), intent(in) :: y
      integer, intent(in) :: turns

      x = iand(ieor(x, y) - turned(y, turns), MASK)
   end subroutine last

   pure integer(int64) function turned(x, turns)
      integer(int64), intent(in) :: x
      integer, intent(in) :: turns

      turned = iand(ior(shiftl(x, turns), shiftr(x, 32 - turns)), MASK)
   end function turned
end module hdf5_superblock
