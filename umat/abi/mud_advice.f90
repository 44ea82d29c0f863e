! SPDX-License-Identifier: MIT
!> Values of PROPS that are allowed but doubtful: a warning, never a refusal.
module mud_advice
   use mud_kinds, only: wp
   use mud_messages, only: number
   use mud_registry, only: NPROPS, PROPERTIES
   use mud_units, only: doubt_t, unit_doubts, NDOUBTS
   implicit none (type, external)
   private
   public :: advice_on, ADVICE_LENGTH

   integer, parameter :: ADVICE_LENGTH = 640
contains
   !> Names the entries of allowed PROPS that suggest another unit of stress than p_atm does; empty if there are none.
   !> Stresses in the unit of p_atm; PROPS must have passed read_params. Usual ranges of mud_units.
   pure function advice_on(props) result(text)
      real(wp), intent(in) :: props(NPROPS)
      character(ADVICE_LENGTH) :: text
      type(doubt_t) :: doubts(NDOUBTS)
      integer :: i

      text = ''
      doubts = unit_doubts(props)
      do i = 1, NDOUBTS
         if (.not. doubts(i)%raised) cycle
         if (text == '') then
            text = 'warning: do all PROPS have the unit of stress of p_atm?'
         else
            text = trim(text)//';'
         end if
         text = trim(text)//' '//trim(PROPERTIES(doubts(i)%index)%name)//' '//trim(number(props(doubts(i)%index)))// &
                merge(' gives e = ', ' is        ', doubts(i)%void_ratio)
         text = trim(text)//' '//trim(number(doubts(i)%value))//merge(' at p'' = p_atm', ' p_atm        ', &
                                                                        doubts(i)%void_ratio)
         text = trim(text)//' (usual '//trim(number(doubts(i)%usual(1)))//' to '//trim(number(doubts(i)%usual(2)))//')'
      end do
   end function advice_on
end module mud_advice
