! SPDX-License-Identifier: MIT
!> Errors and times of estimates as text: no more digits than are known.
module error_words
   use kinds, only: wp
   use texts, only: short
   implicit none (type, external)
   private
   public :: percent, rounded
contains
   !> A share in per cent, two digits.
   function percent(share) result(text)
      real(wp), intent(in) :: share
      character(:), allocatable :: text

      text = rounded(100*share)//' %'
   end function percent

   !> Two significant digits.
   function rounded(value) result(text)
      real(wp), intent(in) :: value
      character(:), allocatable :: text
      real(wp) :: unit

      text = '0'
      if (.not. value > 0.0_wp) return
      unit = 10.0_wp**(floor(log10(value)) - 1)
      text = short(anint(value/unit)*unit)
   end function rounded
end module error_words
