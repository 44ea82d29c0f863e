! SPDX-License-Identifier: MIT
!> Asks a scene which effects it calls for: pilots of it with every effect and without each, and what each changes in
!> the answers. docs/theory/host.md section 11.
module effect_pilots
   use, intrinsic :: iso_fortran_env, only: output_unit
   use kinds, only: wp
   use effect_monitor, only: is_watched
   use effect_switches, only: list_effects, settle_open_keys, switch, switch_by_hand
   use effect_types, only: effect_t, indicator_place, OF_P_C, OF_SEEPAGE, OF_FLOW
   use faults, only: fault_t, raise, EXIT_INPUT
   use pilot_differences, only: difference_t, difference, influence_t
   use pilot_runs, only: pilot_t, run_pilot
   use pilot_scenes, only: make_cheap, can_coarsen
   use scene_types, only: scene_t, scene_stage_t, WITH_P_C
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: ask_effects, settle_scene, apply_effects, pilots_account_t

   !> An influence is taken so many times as large, for the coarseness of the pilot.
   real(wp), parameter :: PILOT_FACTOR = 2.0_wp
   !> An indicator of the run may be so many times that of the pilot, besides the ratio of their steps.
   real(wp), parameter :: SURPRISE = 2.0_wp
   !> The steps of pilots are halved until that changes no answer by a larger share of its range; the first ones are
   !> 2**LEVELS times as long as those of the scene.
   real(wp), parameter :: GOOD_PILOT = 0.25_wp
   integer, parameter :: LEVELS = 5
   !> Above so many elements cells are twice, three and four times as long.
   integer, parameter :: MANY_ELEMENTS(3) = [60, 1000, 4000]

   !> The pilots as a whole.
   type :: pilots_account_t
      integer :: runs = 0
      integer :: cells = 1, steps = 1      !< How much longer cells and steps were.
      real(wp) :: seconds = 0.0_wp
      real(wp) :: work = 0.0_wp            !< Elements times steps of all.
      real(wp) :: run_work = 0.0_wp        !< The same of the run, estimated from the base of the pilots.
      real(wp) :: planned = 0.0_wp         !< Work of the pilots that would be needed.
      logical :: too_dear = .false.        !< They would cost a larger share of the run than they may: none was tried.
      type(difference_t) :: own_error      !< Against pilots with steps, or cells, twice as long.
      logical :: own_error_known = .false.
      type(influence_t), allocatable :: influences(:)   !< Of every effect that was tried on every answer.
   end type pilots_account_t
contains
   !> The scene with its open keys settled as the general case, and without what `without` names. Fault EXIT_INPUT: an
   !> effect of `without` cannot be taken out.
   subroutine settle_scene(scene, fault)
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault
      character(200) :: why

      call settle_open_keys(scene)
      call switch_by_hand(scene, why)
      if (why /= '') call raise(fault, EXIT_INPUT, trim(scene%file)//': without = '//trim(why)//'.')
   end subroutine settle_scene

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
   !> may cost `share` of the estimated work of the run [-], else no effect is tried and all stay as they are. The
   !> table's `on` says what the run should have; only what no key says may differ from the scene. docs/theory/host.md
   !> section 11. Fault EXIT_INPUT: as of settle_scene, or the pilot with every effect fails; a failure of another pilot
   !> stands in its row.
   subroutine ask_effects(scene, whole_scene, share, quiet, table, account, fault)
      type(scene_t), intent(in) :: scene
      logical, intent(in) :: whole_scene, quiet
      real(wp), intent(in) :: share
      type(effect_t), allocatable, intent(out) :: table(:)   !< (rows) As of list_effects.
      type(pilots_account_t), intent(out) :: account
      type(fault_t), intent(inout) :: fault
      type(scene_t) :: settled, cheap
      type(pilot_t) :: base
      logical, allocatable :: tried(:), dispensable(:)
      integer :: i

      table = list_effects(scene)
      ! What the scene does not have, and a key says so, is tried with the whole scene alone.
      tried = table%present .or. whole_scene .or. .not. table%by_hand
      dispensable = table%by_hand .or. table%kind == OF_FLOW
      settled = scene
      call settle_scene(settled, fault)
      if (fault%code /= 0) return
      allocate (account%influences(0))
      account%cells = 1
      if (.not. whole_scene) account%cells = cells_of(settled)
      if (.not. whole_scene) call look_ahead(settled, count(tried .and. .not. dispensable), share, account)
      if (.not. account%too_dear) call find_base()
      if (fault%code /= 0) return
      if (account%too_dear) then
         table%why = merge('not tried: by hand                              ', &
                           'not tried: pilots would cost too much of the run', table%by_hand)
         table%on = table%present
         return
      end if
      call prescribe_steps(base, cheap)
      do i = 1, size(table)
         if (.not. tried(i)) cycle
         call try_effect(cheap, base, i, table(i), account)
         if (.not. quiet) write (output_unit, '(a)') '   pilot '//whole(account%runs)//', '// &
            trim(merge('without', 'with   ', table(i)%present))//' '//trim(table(i)%name)//': '// &
            told(table(i))
      end do
      call decide(cheap, base, scene%effects_tolerance, share, quiet, table, account)
      call set_limits(base, real(account%steps, wp), scene%effects_tolerance, table)
   contains
      !> The pilot with every effect. Its steps are halved until that changes the answers little.
      subroutine find_base()
         type(pilot_t) :: finer
         type(scene_t) :: finer_scene
         type(difference_t) :: apart
         logical :: good
         integer :: k

         do k = merge(LEVELS, 0, .not. whole_scene), 0, -1
            finer_scene = settled
            if (.not. whole_scene) call make_cheap(account%cells, 2**k, finer_scene)
            call run_pilot(finer_scene, 0, finer)
            call book(finer, account)
            if (.not. finer%done) cycle
            if (base%done) call difference(finer, base, apart)
            account%own_error_known = base%done
            account%own_error = apart
            base = finer
            cheap = finer_scene
            account%steps = 2**k
            good = account%own_error_known .and. apart%share <= GOOD_PILOT
            call estimate(settled, cheap, base, account)
            call keep_to(share, merge(1, 2, good), dispensable, tried, base, account)
            if (good .or. account%too_dear) exit
         end do
         if (.not. base%done) then
            call raise(fault, EXIT_INPUT, trim(scene%file)//': the pilot with every effect fails, so that nothing '// &
                       'can be said of any: '//trim(finer%why))
            return
         end if
         if (.not. quiet) write (output_unit, '(a)') 'Pilots: '//whole(base%elements)//' elements, '// &
            whole(base%unknowns)//' unknowns, '//whole(base%steps)//' steps; with every effect '// &
            short(base%processor)//' s of processor time.'
         if (account%too_dear .or. whole_scene .or. size(settled%points) == 0 .or. .not. can_coarsen(cheap)) return
         finer_scene = settled
         call make_cheap(2*account%cells, account%steps, finer_scene)
         call run_pilot(finer_scene, 0, finer)
         call book(finer, account)
         if (.not. finer%done) return
         call difference(base, finer, apart)
         account%own_error_known = .true.
         if (apart%share > account%own_error%share) account%own_error = apart
      end subroutine find_base
   end subroutine ask_effects

   !> How much longer the cells of pilots are, so that few tens of elements are left of a small scene and some
   !> hundreds of a large one.
   pure integer function cells_of(scene) result(times)
      type(scene_t), intent(in) :: scene

      times = 1
      if (.not. can_coarsen(scene)) return
      times = 1 + count(2*sum(scene%mesh%r_cells)*sum(scene%mesh%z_cells) > MANY_ELEMENTS)
   end function cells_of

   !> All pilots take the steps of the first, so that they differ by nothing else than the effect.
   subroutine prescribe_steps(base, scene)
      type(pilot_t), intent(in) :: base
      type(scene_t), intent(inout) :: scene
      integer :: i

      do i = 1, size(scene%stages)
         if (.not. scene%stages(i)%controlled .or. size(base%ends(i)%times) == 0) cycle
         scene%stages(i)%controlled = .false.
         scene%stages(i)%ends = base%ends(i)%times
         scene%stages(i)%dt = base%ends(i)%times(1)
         scene%stages(i)%dt_growth = 1.0_wp
         ! The default depends on who chooses the steps.
         scene%stages(i)%rho_inf = base%rho_inf(i)
      end do
   end subroutine prescribe_steps

   pure subroutine book(pilot, account)
      type(pilot_t), intent(in) :: pilot
      type(pilots_account_t), intent(inout) :: account

      account%runs = account%runs + 1
      account%seconds = account%seconds + pilot%seconds
      account%work = account%work + work_of(pilot)
   end subroutine book

   pure real(wp) function work_of(pilot)
      type(pilot_t), intent(in) :: pilot

      work_of = real(pilot%elements, wp)*pilot%steps
   end function work_of

   !> Whether the keys alone say that pilots are too dear: the first ones, two of them, and one for each open effect, at
   !> the most that cells and steps of any stage can be longer.
   pure subroutine look_ahead(scene, open, share, account)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: open   !< Effects to be tried.
      real(wp), intent(in) :: share
      type(pilots_account_t), intent(inout) :: account
      type(scene_t) :: cheap
      integer :: i

      cheap = scene
      call make_cheap(account%cells, 2**LEVELS, cheap)
      account%run_work = 0.0_wp
      do i = 1, size(scene%stages)
         account%run_work = max(account%run_work, longer_steps(scene%stages(i), cheap%stages(i)))
      end do
      if (can_coarsen(scene)) account%run_work = account%run_work*elements_of(scene)/elements_of(cheap)
      account%planned = real(1 + 2*(open + 3), wp)
      account%too_dear = .not. fits(account%planned, share, account)
   end subroutine look_ahead

   pure real(wp) function elements_of(scene)
      type(scene_t), intent(in) :: scene

      elements_of = 2.0_wp*sum(scene%mesh%r_cells)*sum(scene%mesh%z_cells)
   end function elements_of

   !> How many times as long the steps of a pilot's stage are; of controlled ones the square root of their accuracies,
   !> for their error is of second order.
   pure real(wp) function longer_steps(stage, of_pilot)
      type(scene_stage_t), intent(in) :: stage, of_pilot

      if (stage%controlled) then
         longer_steps = sqrt(of_pilot%accuracy/stage%accuracy)
      else
         longer_steps = of_pilot%dt/stage%dt
      end if
   end function longer_steps

   !> Work of the run, from that of a pilot: elements and steps by the keys. A direct solver makes large runs dearer.
   pure subroutine estimate(scene, cheap, pilot, account)
      type(scene_t), intent(in) :: scene, cheap
      type(pilot_t), intent(in) :: pilot
      type(pilots_account_t), intent(inout) :: account
      real(wp) :: elements, steps
      integer :: i

      elements = pilot%elements
      if (can_coarsen(scene)) elements = elements_of(scene)
      steps = 0.0_wp
      do i = 1, size(scene%stages)
         steps = steps + size(pilot%ends(i)%times)*longer_steps(scene%stages(i), cheap%stages(i))
      end do
      account%run_work = elements*steps
   end subroutine estimate

   !> Whether some work is at most a share of the run's, which may be as large as a number can be.
   pure logical function fits(work, share, account)
      real(wp), intent(in) :: work, share   !< As work_of has it; [-]
      type(pilots_account_t), intent(in) :: account

      fits = work/max(account%run_work, 1.0_wp) <= share
   end function fits

   !> Whether what is left to do fits into the share: one pilot for each effect that is tried, one with cells twice as
   !> long and one without all that is to go, `dearer` times as dear as this one, beside it where it is not the base
   !> itself. Effects that are set by hand, and the flow in single regions, are tried where there is room for them.
   pure subroutine keep_to(share, dearer, dispensable, tried, pilot, account)
      real(wp), intent(in) :: share
      integer, intent(in) :: dearer
      logical, intent(in) :: dispensable(:)
      logical, intent(inout) :: tried(:)
      type(pilot_t), intent(in) :: pilot
      type(pilots_account_t), intent(inout) :: account

      account%planned = to_do()
      if (fits(account%planned, share, account)) return
      tried = tried .and. .not. dispensable
      account%planned = to_do()
      account%too_dear = .not. fits(account%planned, share, account)
   contains
      pure real(wp) function to_do()
         to_do = account%work + dearer*work_of(pilot)*(count(tried) + 1 + dearer)
      end function to_do
   end subroutine keep_to

   !> One pilot without (with) an effect.
   subroutine try_effect(cheap, base, row, effect, account)
      type(scene_t), intent(in) :: cheap
      type(pilot_t), intent(in) :: base
      integer, intent(in) :: row   !< Of the effect.
      type(effect_t), intent(inout) :: effect
      type(pilots_account_t), intent(inout) :: account
      type(influence_t), allocatable :: influences(:)
      type(scene_t) :: other
      type(pilot_t) :: pilot
      type(difference_t) :: apart
      character(200) :: why

      other = cheap
      call switch(other, effect, .not. effect%present, why)
      if (why == '') then
         call run_pilot(other, base%steps, pilot)
         call book(pilot, account)
         why = pilot%why
      end if
      if (why /= '') then
         effect%why = trim(merge('cannot be left out: ', 'cannot be put in:   ', effect%present))//' '//trim(why)
         return
      end if
      call difference(base, pilot, apart, influences)
      if (size(influences) == 0) then
         effect%why = 'no point and no force of a moving support changes: nothing to judge by'
         return
      end if
      influences%effect = row
      account%influences = [account%influences, influences]
      effect%influence = apart%share
      effect%change = apart%change
      effect%answer = apart%answer
      effect%unknowns = base%unknowns - pilot%unknowns
      effect%seconds = pilot%processor/max(base%processor, tiny(1.0_wp))
      if (effect%present .and. is_watched(effect%kind)) &
         effect%limit = maxval(pilot%indicators(indicator_place(effect), :))
   end subroutine try_effect

   !> What no key says goes or stays; what is to go together is tried together.
   subroutine decide(cheap, base, tolerance, share, quiet, table, account)
      type(scene_t), intent(in) :: cheap
      type(pilot_t), intent(in) :: base
      real(wp), intent(in) :: tolerance, share
      logical, intent(in) :: quiet
      type(effect_t), intent(inout) :: table(:)
      type(pilots_account_t), intent(inout) :: account
      type(scene_t) :: other
      type(pilot_t) :: pilot
      type(difference_t) :: apart
      logical :: going(size(table))
      integer :: i

      do i = 1, size(table)
         associate (t => table(i))
            if (t%influence < 0.0_wp .and. t%why == '') then
               t%why = merge('not tried: by hand                              ', &
                             'not tried: pilots would cost too much of the run', t%by_hand)
            else if (t%by_hand) then
               t%why = trim(t%why)//trim(merge('; by hand', 'by hand  ', t%why /= ''))
            else if (t%influence < 0.0_wp) then
               t%on = t%present
            else
               t%on = PILOT_FACTOR*t%influence > tolerance
               ! Relative acceleration makes waves grow in unsaturated soil.
               if (t%kind == OF_SEEPAGE .and. t%on .and. cheap%fields == WITH_P_C) then
                  t%on = .false.
                  t%why = 'unstable in unsaturated soil: it stays off'
               end if
            end if
         end associate
      end do
      do
         going = table%present .and. .not. table%on
         if (count(going) < 2) exit
         if (.not. fits(account%work + work_of(base), share, account)) then
            where (going) table%on = .true.
            where (going) table%why = 'weak alone; a pilot without all that are to go would cost too much of the run'
            exit
         end if
         other = cheap
         call apply_effects(table, other)
         call run_pilot(other, base%steps, pilot)
         call book(pilot, account)
         if (pilot%done) then
            call difference(base, pilot, apart)
            if (.not. quiet) write (output_unit, '(a)') '   pilot '//whole(account%runs)//', without all that is '// &
               'to go: '//short(100*apart%share)//' % of '//trim(apart%answer)
            if (apart%share <= tolerance) exit
         end if
         ! Weak ones that are strong together come back, the strongest first.
         i = maxloc(table%influence, dim=1, mask=going)
         table(i)%on = .true.
         table(i)%why = 'weak alone, but not together with the others that are to go'
      end do
   end subroutine decide

   !> What the run may show of the effects that are gone.
   pure subroutine set_limits(base, step_ratio, tolerance, table)
      type(pilot_t), intent(in) :: base
      real(wp), intent(in) :: step_ratio, tolerance
      type(effect_t), intent(inout) :: table(:)
      integer :: i

      do i = 1, size(table)
         associate (t => table(i))
            if (t%on .or. .not. t%present .or. t%by_hand) t%limit = -1.0_wp
            if (t%limit < 0.0_wp) cycle
            t%limit = SURPRISE*step_ratio*t%limit
            if (t%kind == OF_P_C) t%limit = max(t%limit, tolerance*base%stress)
         end associate
      end do
   end subroutine set_limits

   !> A row in a few words, while the pilots run.
   function told(effect) result(text)
      type(effect_t), intent(in) :: effect
      character(:), allocatable :: text

      if (effect%influence < 0.0_wp) then
         text = trim(effect%why)
      else if (effect%answer == '') then
         text = 'nothing changes'
      else
         text = short(100*effect%influence)//' % of '//trim(effect%answer)
      end if
   end function told
end module effect_pilots
