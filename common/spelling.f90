! SPDX-License-Identifier: MIT
!> The nearest name to a misspelt one.
module spelling
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: nearest_name
contains
   !> Finds the place of the name that looks most like a word, the first of equals; 0 if there are no names. The
   !> distance is Levenshtein's, case ignored; letters that look alike count half. names(:) and among(:) have one size.
   pure integer function nearest_name(word, names, among) result(best)
      character(*), intent(in) :: word, names(:)
      logical, intent(in), optional :: among(:)   !< Names that count; default: all.
      integer :: least, here, i

      best = 0
      least = huge(least)
      do i = 1, size(names)
         if (present(among)) then
            if (.not. among(i)) cycle
         end if
         here = distance(word, names(i))
         if (here >= least) cycle
         least = here
         best = i
      end do
   end function nearest_name

   !> Counts the edit distance between two names, case ignored: 2 for each letter to insert, delete or replace, 1 where
   !> the two letters look alike (O and 0, l and 1).
   pure integer function distance(first, second)
      character(*), intent(in) :: first, second
      character(len_trim(first)) :: a
      character(len_trim(second)) :: b
      integer :: row(0:len_trim(second)), diagonal, above, i, j

      a = lower_case(first(:len(a)))
      b = lower_case(second(:len(b)))
      row = [(2*j, j=0, len(b))]
      do i = 1, len(a)
         diagonal = row(0)
         row(0) = 2*i
         do j = 1, len(b)
            above = row(j)
            row(j) = min(above + 2, row(j - 1) + 2, diagonal + replacement(a(i:i), b(j:j)))
            diagonal = above
         end do
      end do
      distance = row(len(b))
   end function distance

   pure integer function replacement(a, b)
      character, intent(in) :: a, b

      if (a == b) then
         replacement = 0
      else if (index('o0 0o l1 1l', a//b) > 0) then
         replacement = 1
      else
         replacement = 2
      end if
   end function replacement
end module spelling
