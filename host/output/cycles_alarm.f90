! SPDX-License-Identifier: MIT
!> Warning of a run whose load turns many times on ground that accumulates more strain in cycles than tests do.
!> docs/theory/host.md section 17.
module cycles_alarm
   use archive, only: archive_t
   use faults, only: fault_t
   use kinds, only: wp
   use material_point, only: CYCLES_UNTRUSTED, MANY_REVERSALS
   use model_types, only: model_t
   use run_observer, only: observer_t
   use run_state, only: run_t
   use scene_parts, only: amplitude_at, acts_in
   use texts, only: short, whole
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: cycles_alarm_t

   real(wp), parameter :: LEAST_SWING = 0.1_wp   !< A history turns where it comes back by this share of its range [-].

   type, extends(observer_t) :: cycles_alarm_t
      real(wp), allocatable :: farthest(:)   !< (histories) Factor that each came to since it turned last [-].
      integer, allocatable :: sense(:)       !< (histories) Way that it goes, 1 or -1; 0: it has not moved.
      integer, allocatable :: turns(:)       !< (histories)
      logical :: told = .false.
   contains
      procedure :: exchange
      procedure :: begins
      procedure :: step
   end type cycles_alarm_t
contains
   !> Exchanges what is counted; a run that is taken up tells it again.
   subroutine exchange(self, archive)
      class(cycles_alarm_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call archive%enter('cycles')
      call archive%exchange_allocatable('farthest', self%farthest, '1', 'factors that histories came to')
      call archive%exchange_allocatable('sense', self%sense, '1', 'ways that they go')
      call archive%exchange_allocatable('turns', self%turns, '1', 'turns so far')
      call archive%leave('cycles')
   end subroutine exchange

   !> Makes room for the histories, which start where the run does.
   subroutine begins(self, model, run, fault)
      class(cycles_alarm_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (run%steps > 0) return
      self%farthest = [(amplitude_at(model%amplitudes(i), run%state%time), i=1, size(model%amplitudes))]
      allocate (self%sense(size(self%farthest)), self%turns(size(self%farthest)), source=0)
   end subroutine begins

   !> Counts the turns of the histories that act in the stage, and tells when one has many, once, on standard error.
   subroutine step(self, model, run, fault)
      class(cycles_alarm_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      real(wp) :: factor, least
      integer :: i

      do i = 1, size(self%turns)
         factor = amplitude_at(model%amplitudes(i), run%next%time)
         if (.not. acts(model, i, model%stages(run%at%stage)%name)) then
            self%farthest(i) = factor
            self%sense(i) = 0
            cycle
         end if
         associate (values => model%amplitudes(i)%values)
            least = LEAST_SWING*(maxval(values) - minval(values))
         end associate
         call follow(factor, least, self%farthest(i), self%sense(i), self%turns(i))
         if (self%told .or. self%turns(i) <= MANY_REVERSALS .or. .not. any_counts(model)) cycle
         self%told = .true.
         call print_warning('stage '//trim(model%stages(run%at%stage)%name)//', time '//short(run%next%time)// &
            ' s: history '''//trim(model%amplitudes(i)%name)//''' has turned '//whole(self%turns(i))//' times: '// &
            CYCLES_UNTRUSTED)
      end do
   end subroutine step

   !> A turn is one where a factor has come back by the least swing from the farthest that it came.
   pure subroutine follow(factor, least, farthest, sense, turns)
      real(wp), intent(in) :: factor, least
      real(wp), intent(inout) :: farthest
      integer, intent(inout) :: sense, turns

      if (sense == 0) then
         if (abs(factor - farthest) <= least) return
         sense = merge(1, -1, factor > farthest)
      else if (sense*(factor - farthest) < 0.0_wp) then
         if (abs(factor - farthest) <= least) return
         sense = -sense
         turns = turns + 1
      end if
      farthest = factor
   end subroutine follow

   !> Whether a history acts in a stage; one that no action names, as that of gravity or of a wave, does in all.
   pure logical function acts(model, amplitude, stage)
      type(model_t), intent(in) :: model
      integer, intent(in) :: amplitude
      character(*), intent(in) :: stage
      integer :: i

      acts = .not. any(model%actions%amplitude == amplitude)
      do i = 1, size(model%actions)
         if (model%actions(i)%amplitude == amplitude) acts = acts .or. acts_in(model%actions(i)%stages, stage)
      end do
   end function acts

   !> Whether there is ground whose strain of many cycles is too large.
   pure logical function any_counts(model)
      type(model_t), intent(in) :: model
      integer :: i

      any_counts = .false.
      do i = 1, size(model%domain%regions)
         any_counts = any_counts .or. model%domain%regions(i)%law%overcounts_cycles
      end do
   end function any_counts
end module cycles_alarm
