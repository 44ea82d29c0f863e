! SPDX-License-Identifier: MIT
!> What pilots cost and may cost, counted in work and not by the clock, so that a scene is decided alike everywhere.
!> docs/theory/host.md section 11.
module pilot_budget
   use kinds, only: wp
   use pilot_differences, only: difference_t, influence_t
   use pilot_runs, only: pilot_t
   use pilot_scenes, only: can_coarsen
   use scene_types, only: scene_t, stage_t
   implicit none (type, external)
   private
   public :: pilots_account_t, book, left, estimate, estimate_run, NO_LIMIT

   real(wp), parameter :: NO_LIMIT = huge(1.0_wp)
   real(wp), parameter :: ALWAYS = 10.0_wp       !< Work that pilots may take of any scene [s].
   real(wp), parameter :: ALL_SHARES = 1.0e6_wp  !< A share from which on nothing is counted [-].
   real(wp), parameter :: SECOND_ORDER = sqrt(2.0_wp), MOST_MORE = 2.0_wp   !< More steps at half the accuracy [-].

   !> The pilots as a whole. Work is the time that a usual processor takes [s].
   type :: pilots_account_t
      integer :: runs = 0
      integer :: cells = 1, steps = 1      !< How much longer cells and steps were.
      real(wp) :: seconds = 0.0_wp         !< By the clock.
      real(wp) :: share = 0.0_wp           !< Of the run's work that they may take [-].
      real(wp) :: work = 0.0_wp            !< Of all so far [s].
      real(wp) :: run_work = 0.0_wp        !< Expected of the run [s].
      real(wp) :: noise = 0.0_wp           !< How far two pilots of one scene lie apart [-].
      logical :: over_share = .false.        !< The first ones would have cost more than they may: nothing was tried.
      type(difference_t) :: own_error      !< Against pilots with steps, or cells, twice as long.
      logical :: own_error_known = .false.
      type(influence_t), allocatable :: influences(:)   !< Of every effect that was tried on every answer.
   end type pilots_account_t
contains
   !> A pilot that was run.
   pure subroutine book(pilot, account)
      type(pilot_t), intent(in) :: pilot
      type(pilots_account_t), intent(inout) :: account

      account%runs = account%runs + 1
      account%seconds = account%seconds + pilot%seconds
      account%work = account%work + pilot%work
   end subroutine book

   !> Work that pilots may still take: the larger of a share of the expected run and ALWAYS, less what they took [s].
   pure real(wp) function left(account)
      type(pilots_account_t), intent(in) :: account

      left = NO_LIMIT
      if (account%share >= ALL_SHARES) return
      left = max(ALWAYS, account%share*account%run_work) - account%work
   end function left

   !> Before the first pilot of a reading: where all steps are given, keys say what the run costs, in pilots like this
   !> one; where it is many times as dear as that, the pilot may take what it takes.
   pure subroutine estimate_run(scene, cheap, known, account)
      type(scene_t), intent(in) :: scene, cheap
      logical, intent(in) :: known   !< A pilot has told it.
      type(pilots_account_t), intent(inout) :: account
      real(wp), parameter :: LEAST = 1.0_wp/30   !< Of its share that a pilot may take at once.
      real(wp) :: times
      integer :: i

      if (known .or. any(scene%stages%controlled)) return
      times = huge(1.0_wp)
      do i = 1, size(scene%stages)
         times = min(times, cheap%stages(i)%dt/scene%stages(i)%dt)
      end do
      if (can_coarsen(scene)) times = times*elements_of(scene)/elements_of(cheap)
      ! A pilot that costs less than LEAST of its share of the run cannot be too dear.
      if (account%share*times*LEAST >= 1.0_wp) account%run_work = 0.5_wp*NO_LIMIT/max(1.0_wp, account%share)
   end subroutine estimate_run

   pure real(wp) function elements_of(scene)
      type(scene_t), intent(in) :: scene

      elements_of = 2.0_wp*sum(scene%mesh%r_cells)*sum(scene%mesh%z_cells)
   end function elements_of

   !> Work of the run, from that of a pilot: elements and given steps by the keys; controlled steps by how many more the
   !> pilot took than one before it of lower accuracy (as many as an error of second order asks for, if there is none).
   !> A direct solver makes large runs dearer.
   pure subroutine estimate(scene, cheap, pilot, before_scene, before, account)
      type(scene_t), intent(in) :: scene, cheap
      type(pilot_t), intent(in) :: pilot
      type(scene_t), intent(in) :: before_scene   !< Of the pilot before, if one is done.
      type(pilot_t), intent(in) :: before
      type(pilots_account_t), intent(inout) :: account
      real(wp) :: steps
      integer :: i

      steps = 0.0_wp
      do i = 1, size(scene%stages)
         steps = steps + size(pilot%ends(i)%times)*more_steps(i)
      end do
      account%run_work = pilot%work*steps/max(1, pilot%steps)
      if (can_coarsen(scene)) account%run_work = account%run_work*elements_of(scene)/pilot%elements
   contains
      !> How many times as many steps the run takes in a stage.
      pure real(wp) function more_steps(stage) result(more)
         integer, intent(in) :: stage
         real(wp) :: halvings, of_one

         associate (wanted => scene%stages(stage), had => cheap%stages(stage))
            if (.not. wanted%controlled) then
               more = had%dt/wanted%dt
               return
            end if
            of_one = SECOND_ORDER
            if (before%done) then
               halvings = log(before_scene%stages(stage)%accuracy/had%accuracy)/log(2.0_wp)
               if (halvings > 0.1_wp .and. size(before%ends(stage)%times) > 0) of_one = &
                  (real(size(pilot%ends(stage)%times), wp)/size(before%ends(stage)%times))**(1/halvings)
               of_one = max(1.0_wp, min(MOST_MORE, of_one))
            end if
            more = of_one**(log(had%accuracy/wanted%accuracy)/log(2.0_wp))
         end associate
      end function more_steps
   end subroutine estimate
end module pilot_budget
