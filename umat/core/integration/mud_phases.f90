! SPDX-License-Identifier: MIT
!> An increment as a list of phases. Where suction turns, passes zero or a kink of S_w, and where the strain leaves the
!> elastic domain, follows from strain, void ratio and suction alone: the list is made beforehand.
module mud_phases
   use mud_increment, only: increment_t, suction_at
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_retention, only: course_t, list_kinks, MAX_KINKS
   use mud_way, only: SHORTEST_PHASE
   implicit none (type, external)
   private
   public :: cut_t, list_cuts, MAX_CUTS, CUT_TURN, CUT_NO_SUCTION, CUT_EXIT, CUT_KINK

   integer, parameter :: CUT_END = 0, CUT_TURN = 1, CUT_NO_SUCTION = 2, CUT_EXIT = 3, CUT_KINK = 4
   integer, parameter :: MAX_CUTS = 4 + MAX_KINKS

   !> End of a phase.
   type :: cut_t
      integer :: kind    !< CUT_*: what moves it.
      real(wp) :: time   !< Pseudo-time [-].
      logical :: turns   !< x turns there.
   end type cut_t
contains
   !> The cuts of an increment in their order, its end the last. A phase that would be very short is joined to the next.
   !> Cuts at one place move with the one at which rates change most: it is inserted first.
   !> docs/theory/integration.md section 1.
   pure subroutine list_cuts(par, inc, course, cuts, n)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(course_t), intent(in) :: course
      type(cut_t), intent(out) :: cuts(MAX_CUTS)   !< Entries beyond n have no meaning.
      integer, intent(out) :: n
      real(wp) :: times(MAX_KINKS)
      integer :: i, k

      n = 1
      cuts(1) = cut_t(CUT_END, 1.0_wp, turns=.false.)
      if (inc%rho > 0.0_wp) call insert(cut_t(CUT_EXIT, inc%exit, turns=.false.), cuts, n)
      if (passes_zero(par, inc)) call insert(cut_t(CUT_NO_SUCTION, -inc%p_c0/inc%d_pc, turns=.false.), cuts, n)
      if (course%turn < 1.0_wp) call insert(cut_t(CUT_TURN, course%turn, turns=.true.), cuts, n)
      call list_kinks(inc%way_t, course, times, k)
      do i = 1, k
         call insert(cut_t(CUT_KINK, times(i), turns=.false.), cuts, n)
      end do
   end subroutine list_cuts

   !> A cut at its place among others; where it would leave a very short phase the one that is there does for both.
   pure subroutine insert(cut, cuts, n)
      type(cut_t), intent(in) :: cut
      type(cut_t), intent(inout) :: cuts(MAX_CUTS)
      integer, intent(inout) :: n
      integer :: i

      if (cut%time < SHORTEST_PHASE) return
      i = findloc(abs(cuts(1:n)%time - cut%time) < SHORTEST_PHASE, .true., dim=1)
      if (i > 0) then
         cuts(i)%turns = cuts(i)%turns .or. cut%turns
         return
      end if
      do i = n, 1, -1
         if (cuts(i)%time < cut%time) exit
         cuts(i + 1) = cuts(i)
      end do
      cuts(i + 1) = cut
      n = n + 1
   end subroutine insert

   !> True where suction passes zero and bonding begins or ends there.
   pure logical function passes_zero(par, inc)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc

      passes_zero = par%suction%bonds .and. abs(inc%p_c0) > 0.0_wp
      if (passes_zero) passes_zero = (inc%p_c0 > 0.0_wp) .neqv. (suction_at(inc, 1.0_wp) >= 0.0_wp)
   end function passes_zero
end module mud_phases
