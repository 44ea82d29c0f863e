! SPDX-License-Identifier: MIT
!> Observer of shear work that is done where the tangent of the skeleton has lost ellipticity: its share tells a run
!> whose displacements depend on the cells. It is booked from the slopes that the last pass of a step has kept; nothing
!> is asked of the material. docs/theory/host.md section 16.1.
module localisation
   use acoustic_tensor, only: determinant_of, least_determinant, loses_ellipticity
   use archive, only: archive_t
   use faults, only: fault_t
   use kinds, only: wp, PI
   use model_types, only: now_in
   use porous_domain, only: means_t, means_over, is_present, strain_of
   use run_observer, only: observer_t, BEGINS, STEP, STAGE_ENDS
   use run_state, only: run_t
   use texts, only: place_text, short, whole
   use unknown_fields, only: DISPLACEMENTS
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: localisation_observer_t

   !> Share of the shear work that is told: docs/theory/host.md section 16.1 says what it rests on.
   real(wp), parameter :: TOLD_SHARE = 0.05_wp
   integer, parameter :: WORTH_THREADS = 64   !< Elements, as in equation_assembly.

   !> Works since displacements began to count.
   type, extends(observer_t) :: localisation_observer_t
      real(wp) :: shear = 0.0_wp          !< Positive work of the points on deviators [kJ].
      real(wp) :: localised = 0.0_wp      !< Part of it by points whose tangent had lost ellipticity [kJ].
      real(wp) :: share = 0.0_wp          !< Part over whole, after a step [-].
      real(wp), allocatable :: work(:)    !< (points) Such work of every point [kJ].
      real(wp) :: since = 0.0_wp          !< When the share first was above TOLD_SHARE [s].
      logical :: is_above = .false.       !< The share has been above it.
      real(wp) :: normal = 0.0_wp         !< Angle of the normal where most of that work is done, from r towards z.
   contains
      procedure :: exchange
      procedure :: hear
   end type localisation_observer_t
contains
   !> Exchanges what is booked.
   subroutine exchange(self, archive)
      class(localisation_observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call archive%enter('localisation')
      call archive%exchange('shear', self%shear, 'kJ', 'shear work')
      call archive%exchange('localised', self%localised, 'kJ', 'shear work done without ellipticity')
      call archive%exchange_allocatable('work', self%work, 'kJ', 'shear work that a point has done without ellipticity')
      call archive%exchange('is_above', self%is_above, 'whether the share has been above what is told')
      call archive%exchange('since', self%since, 's', 'when it first was')
      call archive%exchange('normal', self%normal, 'rad', 'normal of the band, from r towards z')
      call archive%leave('localisation')
   end subroutine exchange

   !> Books every step, and forgets all where displacements begin to count anew.
   subroutine hear(self, event, run, fault)
      class(localisation_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      select case (event)
      case (BEGINS)
         if (run%steps == 0) allocate (self%work(size(run%state%e)), source=0.0_wp)
      case (STEP)
         call book(self, run)
      case (STAGE_ENDS)
         if (.not. (run%complete .and. run%stage%zero_displacements)) return
         self%shear = 0.0_wp
         self%localised = 0.0_wp
         self%work = 0.0_wp
         self%is_above = .false.
      end select
   end subroutine hear

   !> Books a step, and tells a share above TOLD_SHARE, once, on standard error. Points are looked at in parallel, and
   !> added up in their order.
   subroutine book(self, run)
      class(localisation_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      real(wp), allocatable :: work(:)
      logical, allocatable :: lost(:)
      real(wp) :: least
      integer :: e, p, worst

      allocate (work(size(self%work)), lost(size(self%work)))
      associate (m => run%domain)
         !$omp parallel do num_threads(merge(m%threads, 1, size(m%region_of) >= WORTH_THREADS)) schedule(static) &
         !$omp default(shared) private(e)
         do e = 1, size(m%region_of)
            call look_at_element(run, e, work((e - 1)*m%rule + 1:e*m%rule), lost((e - 1)*m%rule + 1:e*m%rule))
         end do
         !$omp end parallel do
      end associate
      do p = 1, size(work)
         self%shear = self%shear + work(p)
         if (.not. lost(p)) cycle
         self%localised = self%localised + work(p)
         self%work(p) = self%work(p) + work(p)
      end do
      worst = maxloc(self%work, dim=1)
      if (lost(worst)) call least_determinant(determinant_of(run%assembly%slopes%strain(:, :, worst)), least, &
                                              self%normal)
      self%share = self%localised/max(self%shear, tiny(1.0_wp))
      if (self%is_above .or. .not. self%share > TOLD_SHARE) return
      self%is_above = .true.
      self%since = run%next%time
      call tell(self, run, worst)
   end subroutine book

   !> Looks at the points of an element: positive shear work of the step, and whether the tangent lost ellipticity.
   pure subroutine look_at_element(run, e, work, lost)
      type(run_t), intent(in) :: run
      integer, intent(in) :: e
      real(wp), intent(out) :: work(:)   !< [kJ]
      logical, intent(out) :: lost(:)
      type(means_t) :: mean
      real(wp) :: du(DISPLACEMENTS, 6), strain(4), stress(4)
      integer :: g, p

      work = 0.0_wp
      lost = .false.
      associate (domain => run%domain, old => run%state, new => run%next)
         if (.not. is_present(new, e)) return
         du = new%x(:DISPLACEMENTS, domain%mesh%t6(:, e)) - old%x(:DISPLACEMENTS, domain%mesh%t6(:, e))
         do g = 1, domain%rule
            p = (e - 1)*domain%rule + g
            strain = strain_of(domain%gauss(g, e), du)
            mean = means_over(old, new, p)
            stress = mean%stress
            stress(:3) = stress(:3) - sum(stress(:3))/3
            work(g) = max(0.0_wp, domain%gauss(g, e)%weight*dot_product(stress, strain))
            if (domain%regions(domain%region_of(e))%law%has_energy .or. .not. work(g) > 0.0_wp) cycle
            lost(g) = loses_ellipticity(determinant_of(run%assembly%slopes%strain(:, :, p)))
         end do
      end associate
   end subroutine look_at_element

   !> Prints the sentence; the end of the run repeats it.
   subroutine tell(self, run, worst)
      type(localisation_observer_t), intent(in) :: self
      type(run_t), intent(in) :: run
      integer, intent(in) :: worst   !< Point with the most work.
      real(wp) :: x(2)

      associate (n => run%domain%rule)
         x = run%domain%gauss(mod(worst - 1, n) + 1, (worst - 1)/n + 1)%x
      end associate
      call print_warning(now_in(run)//'shear localises. '//short(0.1_wp*nint(1000*self%share))// &
         ' % of the shear work so far is done where the tangent of the soil has lost ellipticity (column localised '// &
         'of ledger.csv; above '//short(100*TOLD_SHARE)//' % since '//short(self%since)//' s), most of it at '// &
         place_text(x)//' in a band with its normal at '//whole(nint(self%normal*180/PI))// &
         ' degrees from r towards z. Displacements depend on the cell there and have no limit: state the cell with '// &
         'them, or give the &region a viscosity.')
   end subroutine tell
end module localisation
