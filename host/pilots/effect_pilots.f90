! SPDX-License-Identifier: MIT
!> Asks a scene which effects it calls for: pilots of its cheapest reading, with what no key says added, then without
!> each effect, and what each changes in the answers. docs/theory/host.md section 11.
module effect_pilots
   use, intrinsic :: iso_fortran_env, only: output_unit
   use kinds, only: wp
   use effect_monitor, only: is_watched
   use effect_switches, only: list_effects, set_open_keys, switch, switch_by_hand
   use effect_types, only: effect_t, indicator_place, OF_P_C, OF_SEEPAGE, OF_FLOW, OF_INERTIA, OF_GRAVITY
   use faults, only: fault_t, raise, EXIT_INPUT
   use pilot_budget, only: pilots_account_t, book, left, estimate, estimate_run, NO_LIMIT
   use pilot_differences, only: difference_t, difference, influence_t
   use pilot_runs, only: pilot_t, run_pilot
   use pilot_scenes, only: coarsen_scene, can_coarsen
   use scene_types, only: scene_t, WITH_P_C
   use texts, only: short, whole
   use generalised_alpha, only: DYNAMIC
   implicit none (type, external)
   private
   public :: ask_effects, reduce_scene, apply_effects

   !> An influence is taken so many times as large, for the coarseness of the pilot.
   real(wp), parameter :: PILOT_FACTOR = 2.0_wp
   !> An indicator of the run may be so many times that of the pilot, besides the ratio of their steps.
   real(wp), parameter :: SURPRISE = 2.0_wp
   !> The steps of pilots are halved until that changes no answer by a larger share of its range; the first ones are
   !> 2**LEVELS times as long as those of the scene.
   real(wp), parameter :: GOOD_PILOT = 0.25_wp
   integer, parameter :: LEVELS = 5
   !> A pilot without an effect may cost so many times that with it.
   real(wp), parameter :: MOST_TIMES_THE_BASE = 5.0_wp
   !> Work that pilots with inertia may take where nothing else limits them: so much [s], or so many times that of the
   !> pilot without it.
   real(wp), parameter :: LONGEST = 60.0_wp, MOST_TIMES_STILL = 1000.0_wp
   !> Above so many elements cells are twice, three and four times as long.
   integer, parameter :: MANY_ELEMENTS(3) = [60, 1000, 4000]
   character(*), parameter :: OVER_SHARE = 'not tried: pilots would cost too much'

   !> A reading of the scene, its pilot, and the scene of that pilot with its steps prescribed: what others are compared
   !> with.
   type :: base_t
      type(scene_t) :: scene
      type(pilot_t) :: pilot
      integer :: steps = 1               !< How many times as long as those of the scene.
      logical :: good = .false.          !< Steps half as long change the answers little.
      type(difference_t) :: own_error    !< Against pilots with steps, or cells, twice as long.
      logical :: own_error_known = .false.
   end type base_t
contains
   !> The scene in its cheapest reading, and without what `without` names. Fault EXIT_INPUT: an effect of `without`
   !> cannot be taken out.
   subroutine reduce_scene(scene, fault)
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      character(200) :: why

      call set_open_keys(scene)
      call switch_by_hand(scene, why)
      if (why /= '') call raise(fault, EXIT_INPUT, trim(scene%file)//': without = '//trim(why)//'.')
   end subroutine reduce_scene

   !> A settled scene with the effects as a table says. An effect that cannot be switched stays as it is.
   subroutine apply_effects(table, scene)
      type(effect_t), intent(in) :: table(:)   !< (rows) As of list_effects.
      type(scene_t), intent(inout) :: scene
      character(200) :: why
      integer :: i

      do i = 1, size(table)
         if (table(i)%on .neqv. table(i)%present) call switch(scene, table(i), table(i)%on, why)
      end do
   end subroutine apply_effects

   !> Pilots of a scene as it was read. `whole_scene`: the pilots are the scene itself, neither coarser nor faster; they
   !> may cost `share` of the expected run [-], or some seconds if that is more (pilot_budget). What is not tried is as
   !> the scene says it. The table's `on` says what the run should have; only what no key says may differ from the
   !> scene. docs/theory/host.md section 11. Fault EXIT_INPUT: as of reduce_scene, or the pilot of the scene fails; a
   !> failure of another pilot stands in its row.
   subroutine ask_effects(scene, whole_scene, share, quiet, table, account, fault)
      type(scene_t), intent(in) :: scene
      logical, intent(in) :: whole_scene, quiet
      real(wp), intent(in) :: share
      type(effect_t), allocatable, intent(out) :: table(:)   !< (rows) As of list_effects.
      type(pilots_account_t), intent(out) :: account
      type(fault_t), intent(inout) :: fault
      type(scene_t) :: settled
      type(base_t) :: base
      logical, allocatable :: tried(:)

      table = list_effects(scene)
      settled = scene
      call reduce_scene(settled, fault)
      if (fault%code /= 0) return
      allocate (account%influences(0))
      account%share = merge(NO_LIMIT, share, whole_scene)
      if (.not. whole_scene) account%cells = cells_of(settled)
      table%tried_in = table%present
      call find_base(settled, whole_scene, quiet, account, base)
      if (.not. whole_scene) call add_inertia(settled, quiet, table, account, base)
      if (.not. base%pilot%done .and. .not. account%over_share) call raise(fault, EXIT_INPUT, trim(scene%file)// &
         ': the pilot of the scene fails, so that nothing can be said of any effect: '//trim(base%pilot%why))
      if (fault%code /= 0) return
      if (.not. account%over_share) then
         ! What the scene does not have, and a key says so, is tried with the whole scene alone.
         tried = (table%present .or. whole_scene .or. .not. table%by_hand) .and. table%influence < 0.0_wp .and. &
                 table%why == ''
         if (.not. whole_scene) tried = tried .and. .not. (is_added(table%kind) .and. .not. table%present)
         if (.not. any(base%scene%stages%kind == DYNAMIC)) then
            where (tried .and. table%kind == OF_SEEPAGE) table%why = 'not tried: no stage has inertia'
            tried = tried .and. table%kind /= OF_SEEPAGE
         end if
         call keep_to_budget(base%pilot, table%by_hand .or. table%kind == OF_FLOW, account, tried)
         call try_effects(base, tried, quiet, table, account)
         if (.not. whole_scene) call coarser_cells(settled, account, base)
      end if
      call decide(base, scene%effects_tolerance, quiet, whole_scene, table, account)
      account%steps = base%steps
      account%own_error = base%own_error
      account%own_error_known = base%own_error_known
   end subroutine ask_effects

   !> Whether an effect is one that is judged before all others, by what it adds to the cheapest reading.
   elemental logical function is_added(kind)
      integer, intent(in) :: kind

      is_added = kind == OF_INERTIA .or. kind == OF_GRAVITY
   end function is_added

   !> How much longer the cells of pilots are, so that few tens of elements are left of a small scene and some
   !> hundreds of a large one.
   pure integer function cells_of(scene) result(times)
      type(scene_t), intent(in) :: scene

      times = 1
      if (.not. can_coarsen(scene)) return
      times = 1 + count(2*sum(scene%mesh%r_cells)*sum(scene%mesh%z_cells) > MANY_ELEMENTS)
   end function cells_of

   !> The pilot of a reading. Its steps are halved until that changes the answers little. All pilots that follow take
   !> the steps of the last one, which is run once more with its steps prescribed: what differs then differs by the
   !> effect, and not by how steps are chosen and begun.
   subroutine find_base(reading, whole_scene, quiet, account, base, most)
      type(scene_t), intent(in) :: reading
      logical, intent(in) :: whole_scene, quiet
      type(pilots_account_t), intent(inout) :: account
      type(base_t), intent(out) :: base
      real(wp), intent(in), optional :: most   !< Work until one is done, or of all without a limit; default: any [s].
      type(pilot_t) :: finer
      type(scene_t) :: finer_scene
      type(difference_t) :: apart
      real(wp) :: before, run_before
      integer :: k

      before = account%work
      run_before = account%run_work
      do k = merge(LEVELS, 0, .not. whole_scene), 0, -1
         finer_scene = reading
         if (.not. whole_scene) call coarsen_scene(account%cells, 2**k, finer_scene)
         call estimate_run(reading, finer_scene, base%pilot%done, account)
         ! The next pilot, and that with its steps prescribed.
         if (base%pilot%done) account%over_share = 4*base%pilot%work > rest()
         if (account%over_share) exit
         call run_pilot(finer_scene, rest(), finer)
         call book(finer, account)
         if (finer%cut_off) then
            if (.not. base%pilot%done) base%pilot = finer
            account%over_share = .true.
            exit
         else if (.not. finer%done) then
            if (.not. base%pilot%done) base%pilot = finer
            cycle
         end if
         call estimate(reading, finer_scene, finer, base%scene, base%pilot, account)
         if (base%pilot%done) call difference(finer, base%pilot, apart)
         base%own_error_known = base%pilot%done
         base%own_error = apart
         base%pilot = finer
         base%scene = finer_scene
         base%steps = 2**k
         base%good = base%own_error_known .and. apart%share <= GOOD_PILOT
         if (base%good) exit
      end do
      if (.not. base%pilot%done) account%run_work = run_before
      if (base%pilot%done) call prescribe_steps(account, base)
      if (quiet .or. .not. base%pilot%done) return
      write (output_unit, '(a)') 'Pilots: '//whole(base%pilot%elements)//' elements, '// &
         whole(base%pilot%unknowns)//' unknowns, '//whole(base%pilot%steps)//' steps'// &
         trim(merge(' with inertia', '             ', any(base%scene%stages%kind == DYNAMIC)))//'; '// &
         short(base%pilot%processor)//' s of processor time.'
   contains
      real(wp) function rest()
         rest = left(account)
         if (.not. present(most)) return
         if (.not. base%pilot%done .or. rest >= NO_LIMIT) rest = min(rest, most - (account%work - before))
      end function rest
   end subroutine find_base

   !> The base with the steps that it chose, all of them given.
   subroutine prescribe_steps(account, base)
      type(pilots_account_t), intent(inout) :: account
      type(base_t), intent(inout) :: base
      type(pilot_t) :: again
      type(difference_t) :: apart
      integer :: i
      logical :: any_controlled

      any_controlled = .false.
      do i = 1, size(base%scene%stages)
         associate (stage => base%scene%stages(i), ends => base%pilot%ends(i)%times)
            if (.not. stage%controlled .or. size(ends) == 0) cycle
            any_controlled = .true.
            stage%controlled = .false.
            stage%ends = ends
            stage%dt = ends(1)
            stage%dt_growth = 1.0_wp
            ! The default depends on who chooses the steps.
            stage%rho_inf = base%pilot%rho_inf(i)
         end associate
      end do
      if (.not. any_controlled) return
      call run_pilot(base%scene, MOST_TIMES_THE_BASE*base%pilot%work, again)
      call book(again, account)
      if (.not. again%done) return
      call difference(base%pilot, again, apart)
      account%noise = max(account%noise, apart%share)
      base%pilot = again
   end subroutine prescribe_steps

   !> What the scene leaves open and does not have in its cheapest reading: weight, in steps without inertia, and
   !> inertia, with steps of its own and without the weight that a key does not ask for. Base: with what matters of
   !> them, for all other effects.
   subroutine add_inertia(settled, quiet, table, account, base)
      type(scene_t), intent(in) :: settled
      logical, intent(in) :: quiet
      type(effect_t), intent(inout) :: table(:)
      type(pilots_account_t), intent(inout) :: account
      type(base_t), intent(inout) :: base
      type(scene_t) :: moving
      type(base_t) :: dynamic
      type(pilot_t) :: pilot
      real(wp) :: tolerance
      logical :: open(size(table)), dear
      character(200) :: why
      integer :: g, i

      tolerance = settled%effects_tolerance
      open = table%kind == OF_INERTIA .and. .not. table%by_hand .and. .not. table%present
      g = findloc(table%kind == OF_GRAVITY .and. .not. table%by_hand .and. .not. table%present, .true., dim=1)
      dear = account%over_share
      if (base%pilot%done .and. .not. dear .and. g > 0) then
         call try_effect(base, g, table(g), account, pilot)
         call tell(table(g), .not. quiet, account)
         table(g)%on = matters(table(g), tolerance)
      end if
      if (any(open) .and. .not. dear) then
         moving = settled
         do i = 1, size(table)
            if (open(i)) call switch(moving, table(i), .true., why)
         end do
         ! Pilots of the other effects come after it, and have to be paid too.
         call find_base(moving, .false., quiet, account, dynamic, &
                        most=min(left(account) - 2*(size(table) + 2)*base%pilot%work, &
                                 max(LONGEST, MOST_TIMES_STILL*base%pilot%work)))
         account%over_share = .false.
         if (dynamic%pilot%cut_off) then
            where (open) table%why = 'its pilot came to '//short(dynamic%pilot%time(size(dynamic%pilot%time)))// &
               ' s within what pilots may cost: as the scene says'
            if (base%pilot%done) then
               ! The first step of a flow goes with the square of the accuracy.
               where (open) table%limit = SURPRISE*base%steps**2*maxval(base%pilot%indicators(OF_INERTIA, :))
            end if
         else if (.not. dynamic%pilot%done) then
            where (open) table%why = 'cannot be put in: '//trim(dynamic%pilot%why)
         end if
      end if
      call judge_inertia()
      call choose_base()
   contains
      !> Each stage without its inertia, at the steps that resolve it; and all that would go at once.
      subroutine judge_inertia()
         type(difference_t) :: apart
         type(scene_t) :: other
         type(pilot_t) :: still
         logical :: going(size(table))
         integer :: k

         if (.not. dynamic%pilot%done .or. any(open .and. table%why /= '')) return
         where (open) table%tried_in = .true.
         do k = 1, size(table)
            if (.not. open(k)) cycle
            call try_effect(dynamic, k, table(k), account, still)
            call tell(table(k), .not. quiet, account)
            table(k)%on = matters(table(k), tolerance)
         end do
         where (open) table%tried_in = .false.
         if (.not. base%pilot%done) return
         ! Weak alone: the weight is put into the pilot with inertia, all is taken out of the other.
         going = open .and. .not. table%on
         if (g > 0) going(g) = table(g)%influence >= 0.0_wp .and. .not. table(g)%on
         if (count(going) < 2) return
         other = dynamic%scene
         pilot = dynamic%pilot
         if (g > 0) then
            if (going(g)) call switch(other, table(g), .true., why)
            if (going(g)) call run_pilot(other, left(account), pilot)
            if (going(g)) call book(pilot, account)
         end if
         other = dynamic%scene
         do k = 1, size(table)
            if (going(k) .and. open(k)) call switch(other, table(k), .false., why)
         end do
         call run_pilot(other, left(account), still)
         call book(still, account)
         if (.not. (pilot%done .and. still%done)) return
         call difference(pilot, still, apart)
         if (apart%share <= tolerance) return
         k = maxloc(table%influence, dim=1, mask=going)
         table(k)%on = .true.
         table(k)%why = 'weak alone, but not together with the others that are to go'
      end subroutine judge_inertia

      !> With weight and inertia as they are decided: what is left is compared with that.
      subroutine choose_base()
         type(scene_t), allocatable :: before
         logical :: moves

         moves = any(open .and. table%on)
         ! A body that nothing holds needs its inertia; what its base says of that stands in the row.
         if (.not. base%pilot%done .and. (dynamic%pilot%done .or. dynamic%pilot%cut_off)) then
            where (open) table%on = .true.
            where (open) table%why = 'cannot be left out: '//trim(base%pilot%why)
            moves = .true.
            account%over_share = dynamic%pilot%cut_off
         end if
         if (moves) base = dynamic
         if (.not. base%pilot%done) return
         allocate (before, source=base%scene)
         do i = 1, size(table)
            if (moves .and. open(i) .and. .not. table(i)%on) call switch(base%scene, table(i), .false., why)
            if (i == g .and. table(i)%on) call switch(base%scene, table(i), .true., why)
         end do
         where (open) table%tried_in = table%on
         if (g > 0) then
            table(g)%tried_in = table(g)%on
            ! The speed at which added weight acts at once is as large as steps are short: no reason for a warning.
            where (open .and. table(g)%on) table%limit = -1.0_wp
         end if
         if (.not. (any(open .and. .not. table%on) .and. moves) .and. .not. any(table%tried_in .and. &
             table%kind == OF_GRAVITY .and. .not. table%present)) return
         call run_pilot(base%scene, MOST_TIMES_THE_BASE*base%pilot%work, pilot)
         call book(pilot, account)
         if (pilot%done) then
            base%pilot = pilot
         else
            base%scene = before
            where (open) table%tried_in = moves
            if (g > 0) table(g)%tried_in = .false.
         end if
      end subroutine choose_base
   end subroutine add_inertia

   !> Whether what is left to do fits: one pilot for each effect that is tried and one without all that is to go.
   !> Effects that are set by hand, and the flow in single regions, are tried where there is room for them.
   pure subroutine keep_to_budget(pilot, dispensable, account, tried)
      type(pilot_t), intent(in) :: pilot
      logical, intent(in) :: dispensable(:)
      type(pilots_account_t), intent(in) :: account
      logical, intent(inout) :: tried(:)

      if (pilot%work*(count(tried) + 1) <= left(account)) return
      tried = tried .and. .not. dispensable
      if (pilot%work*(count(tried) + 1) > left(account)) tried = .false.
   end subroutine keep_to_budget

   subroutine try_effects(base, tried, quiet, table, account)
      type(base_t), intent(in) :: base
      logical, intent(in) :: tried(:), quiet
      type(effect_t), intent(inout) :: table(:)
      type(pilots_account_t), intent(inout) :: account
      type(pilot_t) :: pilot
      integer :: i

      do i = 1, size(table)
         if (.not. tried(i)) cycle
         call try_effect(base, i, table(i), account, pilot)
         call tell(table(i), .not. quiet, account)
      end do
   end subroutine try_effects

   !> One pilot without (with) an effect.
   subroutine try_effect(base, row, effect, account, pilot)
      type(base_t), intent(in) :: base
      integer, intent(in) :: row   !< Of the effect.
      type(effect_t), intent(inout) :: effect
      type(pilots_account_t), intent(inout) :: account
      type(pilot_t), intent(out) :: pilot
      type(influence_t), allocatable :: influences(:)
      type(scene_t) :: other
      type(difference_t) :: apart
      character(200) :: why

      other = base%scene
      call switch(other, effect, .not. effect%tried_in, why)
      if (why == '') then
         call run_pilot(other, MOST_TIMES_THE_BASE*base%pilot%work, pilot)
         call book(pilot, account)
         why = pilot%why
      end if
      if (why /= '') then
         effect%why = trim(merge('cannot be left out: ', 'cannot be put in:   ', effect%tried_in))//' '//trim(why)
         effect%on = effect%tried_in
         return
      end if
      call difference(base%pilot, pilot, apart, influences)
      if (size(influences) == 0) then
         effect%why = 'no point and no force of a moving support changes: nothing to judge by'
         return
      end if
      influences%effect = row
      account%influences = [account%influences, influences]
      effect%influence = apart%share
      effect%change = apart%change
      effect%answer = apart%answer
      effect%unknowns = base%pilot%unknowns - pilot%unknowns
      effect%seconds = pilot%processor/max(base%pilot%processor, tiny(1.0_wp))
      if (.not. is_watched(effect%kind)) return
      ! Of the run without it.
      associate (without => indicator_place(effect))
         if (effect%tried_in) effect%limit = maxval(pilot%indicators(without, :))
         if (.not. effect%tried_in .and. effect%kind /= OF_SEEPAGE) &
            effect%limit = maxval(base%pilot%indicators(without, :))
      end associate
      effect%limit = SURPRISE*base%steps*effect%limit
      if (effect%kind == OF_P_C) effect%limit = max(effect%limit, base%scene%effects_tolerance*base%pilot%stress)
   end subroutine try_effect

   !> Whether an effect that was tried changes an answer by more than the tolerance.
   pure logical function matters(effect, tolerance)
      type(effect_t), intent(in) :: effect
      real(wp), intent(in) :: tolerance

      matters = effect%on
      if (effect%influence >= 0.0_wp) matters = PILOT_FACTOR*effect%influence > tolerance
   end function matters

   !> What no key says goes or stays; what is to go together is tried together.
   subroutine decide(base, tolerance, quiet, whole_scene, table, account)
      type(base_t), intent(in) :: base
      real(wp), intent(in) :: tolerance
      logical, intent(in) :: quiet, whole_scene
      type(effect_t), intent(inout) :: table(:)
      type(pilots_account_t), intent(inout) :: account
      type(scene_t) :: other
      type(pilot_t) :: pilot
      type(difference_t) :: apart
      logical :: going(size(table))
      character(200) :: why
      integer :: i

      do i = 1, size(table)
         associate (t => table(i))
            if (t%by_hand) then
               if (t%influence < 0.0_wp .and. t%why == '') t%why = 'not tried: by hand'
               if (index(t%why, 'not tried') == 0) t%why = trim(t%why)//trim(merge('; by hand', 'by hand  ', &
                                                                                   t%why /= ''))
            else if (t%influence < 0.0_wp) then
               if (t%why == '') t%why = OVER_SHARE
            else if (whole_scene .or. t%present .or. .not. is_added(t%kind)) then
               t%on = matters(t, tolerance)
               ! Relative acceleration makes waves grow in unsaturated soil.
               if (t%kind == OF_SEEPAGE .and. t%on .and. base%scene%fields == WITH_P_C) then
                  t%on = .false.
                  t%why = 'unstable in unsaturated soil: it stays off'
               end if
            end if
            if (t%influence > 0.0_wp .and. t%influence <= account%noise) t%why = trim(t%why)//trim(merge('; ', '  ', &
               t%why /= ''))//' within the noise of the pilots'
            t%why = adjustl(t%why)
         end associate
      end do
      do
         going = table%tried_in .and. .not. table%on .and. table%influence >= 0.0_wp
         if (count(going) < 2) exit
         if (base%pilot%work > left(account)) then
            where (going) table%on = .true.
            where (going) table%why = 'weak alone; a pilot without all that are to go would cost too much'
            exit
         end if
         other = base%scene
         do i = 1, size(table)
            if (going(i)) call switch(other, table(i), .false., why)
         end do
         call run_pilot(other, MOST_TIMES_THE_BASE*base%pilot%work, pilot)
         call book(pilot, account)
         if (pilot%done) then
            call difference(base%pilot, pilot, apart)
            if (.not. quiet) write (output_unit, '(a)') '   pilot '//whole(account%runs)//', without all that is '// &
               'to go: '//short(100*apart%share)//' % of '//trim(apart%answer)
            if (apart%share <= tolerance) exit
         end if
         ! Weak ones that are strong together come back, the strongest first.
         i = maxloc(table%influence, dim=1, mask=going)
         table(i)%on = .true.
         table(i)%why = 'weak alone, but not together with the others that are to go'
      end do
      do i = 1, size(table)
         associate (t => table(i))
            ! What the run watches is what it leaves out and no key says.
            if (t%on .or. t%by_hand) t%limit = -1.0_wp
            t%added = t%on .and. .not. t%present
         end associate
      end do
   end subroutine decide

   !> The error of the mesh of the pilots, where there is room for another one.
   subroutine coarser_cells(settled, account, base)
      type(scene_t), intent(in) :: settled
      type(pilots_account_t), intent(inout) :: account
      type(base_t), intent(inout) :: base
      type(scene_t) :: coarser
      type(pilot_t) :: pilot
      type(difference_t) :: apart

      if (size(settled%points) == 0 .or. .not. can_coarsen(base%scene) .or. base%pilot%work > left(account)) return
      coarser = base%scene
      call coarsen_scene(2, 1, coarser)
      call run_pilot(coarser, MOST_TIMES_THE_BASE*base%pilot%work, pilot)
      call book(pilot, account)
      if (.not. pilot%done) return
      call difference(pilot, base%pilot, apart)
      if (apart%share > base%own_error%share .or. .not. base%own_error_known) base%own_error = apart
      base%own_error_known = .true.
   end subroutine coarser_cells

   !> A row in a few words, while the pilots run.
   subroutine tell(effect, aloud, account)
      type(effect_t), intent(in) :: effect
      logical, intent(in) :: aloud
      type(pilots_account_t), intent(in) :: account
      character(:), allocatable :: text

      if (.not. aloud) return
      if (effect%influence < 0.0_wp) then
         text = trim(effect%why)
      else if (effect%answer == '') then
         text = 'nothing changes'
      else
         text = short(100*effect%influence)//' % of '//trim(effect%answer)
      end if
      write (output_unit, '(a)') '   pilot '//whole(account%runs)//', '//trim(merge('without', 'with   ', &
         effect%tried_in))//' '//trim(effect%name)//': '//text
   end subroutine tell
end module effect_pilots
