! SPDX-License-Identifier: MIT
!> Warning of a run in which the load or the ground turns many times, on ground that accumulates more strain in cycles
!> than tests do.
!> docs/theory/host.md section 17.
module cycles_alarm
   use archive, only: archive_t
   use faults, only: fault_t
   use kinds, only: wp
   use material_point, only: CYCLES_UNTRUSTED, MANY_REVERSALS
   use model_types, only: now_in
   use run_observer, only: observer_t, BEGINS, STAGE_BEGINS, STEP
   use run_state, only: run_t
   use scene_parts, only: amplitude_at
   use texts, only: place_text, whole
   use turns, only: follow
   use unknown_fields, only: DISPLACEMENTS
   use warnings, only: print_warning, is_told
   implicit none (type, external)
   private
   public :: cycles_alarm_t

   character(*), parameter :: CYCLES = 'many cycles'
   real(wp), parameter :: LEAST_SWING = 0.1_wp   !< A history turns where it comes back by this share of its range [-].
   !> A displacement turns where it comes back by this share of the largest of the ground. A free vibration that loses
   !> a fifth with every period does so twenty times at most: docs/theory/host.md section 17 [-].
   real(wp), parameter :: LEAST_SHARE = 0.25_wp

   type, extends(observer_t) :: cycles_alarm_t
      !> (histories, then displacements u_r, u_z of the nodes) What each came to since it turned last [-, m].
      real(wp), allocatable :: farthest(:)
      integer, allocatable :: sense(:)       !< Way that each goes, 1 or -1; 0: it has not moved.
      integer, allocatable :: turns(:)       !< Number of turns; see follow_ground for displacements.
      real(wp) :: largest = 0.0_wp           !< Largest displacement when turns of the ground began to count [m].
      !> (2, nodes) Displacements from which those of the ground are counted: a settlement hides no swings after it [m].
      real(wp), allocatable :: origin(:, :)
      logical, allocatable :: counts(:)      !< (nodes) On ground whose strain of many cycles is too large.
   contains
      procedure :: exchange
      procedure :: hear
   end type cycles_alarm_t
contains
   !> Exchanges what is counted.
   subroutine exchange(self, archive)
      class(cycles_alarm_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call archive%enter('cycles')
      call archive%exchange_allocatable('farthest', self%farthest, '1', 'what came how far')
      call archive%exchange_allocatable('sense', self%sense, '1', 'ways that they go')
      call archive%exchange_allocatable('turns', self%turns, '1', 'turns so far')
      call archive%exchange('largest', self%largest, 'm', 'largest displacement that was doubled last')
      call archive%exchange_allocatable('origin', self%origin, 'm', 'displacements from which swings are counted')
      call archive%leave('cycles')
   end subroutine exchange

   !> Counts from the start of the run, step by step.
   subroutine hear(self, event, run, fault)
      class(cycles_alarm_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      if (event == BEGINS) call begin_to_count(self, run)
      if (event == STAGE_BEGINS) call leave_settlement(self, run)
      if (event == STEP) call count_turns(self, run)
   end subroutine hear

   !> Makes room for the histories and the displacements, which start where the run does.
   subroutine begin_to_count(self, run)
      class(cycles_alarm_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      integer :: i

      associate (nodes => run%domain%mesh%t6, of => run%domain%region_of)
         allocate (self%counts(size(run%state%x, 2)), source=.false.)
         do i = 1, size(of)
            if (run%domain%regions(of(i))%law%overcounts_cycles) self%counts(nodes(:, i)) = .true.
         end do
      end associate
      if (run%steps > 0) return
      self%origin = run%state%x(:DISPLACEMENTS, :)
      self%farthest = [(amplitude_at(run%model%amplitudes(i), run%state%time), i=1, size(run%model%amplitudes)), &
                       0*self%origin]
      allocate (self%sense(size(self%farthest)), self%turns(size(self%farthest)), source=0)
   end subroutine begin_to_count

   !> Where motion begins after stages without inertia the ground is counted anew, from where they left it.
   subroutine leave_settlement(self, run)
      class(cycles_alarm_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      integer :: n

      if (run%at%stage == 1 .or. .not. run%stage%has_inertia) return
      if (run%model%stages(run%at%stage - 1)%has_inertia) return
      n = size(run%model%amplitudes)
      self%origin = run%state%x(:DISPLACEMENTS, :)
      self%largest = 0.0_wp
      self%farthest(n + 1:) = 0.0_wp
      self%sense(n + 1:) = 0
      self%turns(n + 1:) = 0
   end subroutine leave_settlement

   !> Counts the turns of the histories that act in the stage and of the displacements of the ground, and tells when one
   !> has many, once, on standard error.
   subroutine count_turns(self, run)
      class(cycles_alarm_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      real(wp) :: factor, least
      integer :: i, n, at

      n = size(run%model%amplitudes)
      do i = 1, n
         factor = amplitude_at(run%model%amplitudes(i), run%next%time)
         if (.not. acts(run, i)) then
            self%farthest(i) = factor
            self%sense(i) = 0
            cycle
         end if
         associate (values => run%model%amplitudes(i)%values)
            least = LEAST_SWING*(maxval(values) - minval(values))
         end associate
         call follow(factor, least, self%farthest(i), self%sense(i), self%turns(i))
      end do
      if (.not. any(self%counts)) return
      call follow_ground(self, merge(run%next%x(:DISPLACEMENTS, :) - self%origin, 0.0_wp, &
                                     spread(self%counts, 1, DISPLACEMENTS)), n)
      if (is_told(CYCLES) .or. maxval(self%turns) <= MANY_REVERSALS) return
      at = maxloc(self%turns, 1)
      call print_warning(now_in(run)//what_turned()//' has turned '//whole(self%turns(at))//' times: '// &
                         CYCLES_UNTRUSTED, once=CYCLES)
   contains
      function what_turned() result(text)
         character(:), allocatable :: text

         if (at <= n) then
            text = 'history '''//trim(run%model%amplitudes(at)%name)//''''
         else
            text = 'the ground at '//place_text(run%domain%mesh%x(:, (at - n + 1)/2))
         end if
      end function what_turned
   end subroutine count_turns

   !> Counts the turns of displacements. When the largest one has doubled, turns before it are small and count no more.
   subroutine follow_ground(self, u, n)
      class(cycles_alarm_t), intent(inout) :: self
      real(wp), intent(in) :: u(:, :)   !< (2, nodes) From the origin, 0 on ground that does not count [m].
      integer, intent(in) :: n          !< Histories before them.

      if (maxval(abs(u)) > 2.0_wp*self%largest) then
         self%largest = maxval(abs(u))
         self%turns(n + 1:) = 0
      end if
      call follow([u], LEAST_SHARE*max(maxval(abs(u)), self%largest), self%farthest(n + 1:), self%sense(n + 1:), &
                  self%turns(n + 1:))
   end subroutine follow_ground

   !> Whether a history acts in the stage under way; one that no action names, as that of gravity or of a wave, does in
   !> all.
   pure logical function acts(run, amplitude)
      type(run_t), intent(in) :: run
      integer, intent(in) :: amplitude
      integer :: i

      associate (list => run%model%actions, stage => run%at%stage)
         acts = .not. any(list%amplitude == amplitude) .or. &
                any([(list(i)%amplitude == amplitude .and. list(i)%in_stage(stage), i=1, size(list))])
      end associate
   end function acts
end module cycles_alarm
