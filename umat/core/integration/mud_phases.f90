! SPDX-License-Identifier: MIT
!> An increment as a list of phases. Where suction turns, passes zero or a kink of S_w, and where the strain leaves the
!> elastic domain, follows from strain, void ratio and suction alone: the list is made beforehand.
module mud_phases
   use mud_consistent, only: begin_stretch
   use mud_branches, only: course_t, list_kinks, take_branch, turn_around, MAX_KINKS
   use mud_driving, only: change_of_zero_suction, change_of_turn, change_of_passing, DIRECTIONS
   use mud_increment, only: increment_t, take_phase, suction_at, end_in_domain, SHORTEST_PHASE
   use mud_integration, only: integration_t
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_status, only: MUD_OK
   use mud_substepping, only: integrate_phase
   implicit none (type, external)
   private
   public :: integrate_phases

   integer, parameter :: CUT_END = 0, CUT_TURN = 1, CUT_NO_SUCTION = 2, CUT_EXIT = 3, CUT_KINK = 4
   integer, parameter :: MAX_CUTS = 4 + MAX_KINKS

   !> End of a phase.
   type :: cut_t
      integer :: kind    !< CUT_*: what moves it.
      real(wp) :: time   !< Pseudo-time [-].
      logical :: turns   !< x turns there.
   end type cut_t
contains
   !> Integrates an increment that is not zero. On return it%inc is in the phase that ended it. Errors are those of
   !> integrate_phase; the state is then that of the last accepted substep. docs/theory/integration.md section 1.
   pure subroutine integrate_phases(par, course, it)
      type(params_t), intent(in) :: par
      type(course_t), intent(inout) :: course   !< With hysteresis; otherwise without meaning.
      type(integration_t), intent(inout) :: it
      type(cut_t) :: cuts(MAX_CUTS)
      real(wp) :: from, end_shift(DIRECTIONS)
      integer :: i, n

      call list_cuts(par, it%inc, course, cuts, n)
      it%trial%divides = .false.
      from = 0.0_wp
      do i = 1, n
         call take_phase(par, from, cuts(i)%time, it%inc)
         if (par%hysteresis) call take_branch(from, cuts(i)%time, course, it)
         if (it%consistent) then
            end_shift = change_of_cut(par, it, cuts(i))
            call begin_stretch(it%inc, end_shift, it%sens)
         end if
         call integrate_phase(par, end_shift, it)
         if (it%status%code /= MUD_OK) return
         if (cuts(i)%turns) call turn_around(course, it)
         from = cuts(i)%time
      end do
      if (it%inc%rho > 0.0_wp) it%state%from_centre = end_in_domain(it%inc)
   end subroutine integrate_phases

   !> The cuts of an increment in their order, its end the last. A phase that would be very short is joined to the next.
   !> Cuts at one place move with the one at which rates change most: it is inserted first.
   pure subroutine list_cuts(par, inc, course, cuts, n)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      type(course_t), intent(in) :: course
      type(cut_t), intent(out) :: cuts(MAX_CUTS)
      integer, intent(out) :: n
      real(wp) :: times(MAX_KINKS)
      integer :: i, k

      n = 1
      cuts(1) = cut_t(CUT_END, 1.0_wp, turns=.false.)
      if (inc%rho > 0.0_wp) call insert(cut_t(CUT_EXIT, inc%exit, turns=.false.), cuts, n)
      if (passes_zero(par, inc)) call insert(cut_t(CUT_NO_SUCTION, -inc%p_c0/inc%d_pc, turns=.false.), cuts, n)
      if (.not. par%hysteresis) return
      if (course%turn < 1.0_wp) call insert(cut_t(CUT_TURN, course%turn, turns=.true.), cuts, n)
      call list_kinks(inc, course, times, k)
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

   !> Derivatives of the pseudo-time of a cut [-].
   pure function change_of_cut(par, it, cut) result(change)
      type(params_t), intent(in) :: par
      type(integration_t), intent(in) :: it
      type(cut_t), intent(in) :: cut
      real(wp) :: change(DIRECTIONS)

      select case (cut%kind)
      case (CUT_TURN)
         change = change_of_turn(it%inc, cut%time, par%suction%omega, it%sens%driving)
      case (CUT_KINK)
         change = change_of_passing(it%inc, cut%time, par%suction%omega, it%sens%driving)
      case (CUT_NO_SUCTION)
         change = change_of_zero_suction(it%inc, cut%time, it%sens%driving)
      case (CUT_EXIT)
         change = it%sens%driving%exit
      case default
         change = 0.0_wp
      end select
   end function change_of_cut
end module mud_phases
