! SPDX-License-Identifier: MIT
!> Residual, its scale and its tangent for the whole mesh. Elements are computed in parallel and summed in their order.
module equation_assembly
   use wall_clock, only: clock
   use kinds, only: wp
   use carried_slopes, only: slopes_t, new_slopes, BY_MATERIAL, BY_SLOPES
   use degrees_of_freedom, only: dofs_t
   use element_equations, only: element_t, element_block_t, points_t, update_block, add_element, element_size
   use element_sums, only: LAST_U
   use tangent_fallback, only: NO_FALLBACK
   use material_point, only: batch_report_t, MOST_ELEMENTS
   use porous_domain, only: domain_t, model_state_t, is_present, keep_element_state, COUPLED
   use sparsity_pattern, only: pattern_t
   use generalised_alpha, only: scheme_t
   implicit none (type, external)
   private
   integer, parameter :: WORTH_THREADS = 64   !< Elements below which waking threads costs more than it saves.
   public :: assembly_t, make_assembly, assemble, follow_slopes_first

   type :: assembly_t
      real(wp), allocatable :: r(:, :)               !< Residuals of the elements.
      real(wp), allocatable :: k(:)                  !< Matrices of the elements, one behind the other, see pattern_t.
      real(wp), allocatable :: stretch(:, :)         !< See element_t.
      real(wp), allocatable :: floor(:)              !< Assembled floor: what a volume balance is small against.
      !> Sum of the magnitudes of the elements' balances of water, in the rows of p_w, where air is an unknown.
      real(wp), allocatable :: water(:)
      real(wp) :: unresolved = 0.0_wp   !< Force of which the tolerance is what rounding leaves of displacements [kN].
      logical :: with_change = .false.               !< Whether a step is measured against what it changes.
      real(wp) :: rounding_share = 0.0_wp            !< Then what changes counts as at least this share of all forces.
      real(wp), allocatable :: d_r(:, :)             !< With it: change of every element's r, see element_t.
      real(wp), allocatable :: change(:)             !< With it: sum of the magnitudes of d_r.
      real(wp), allocatable :: residual(:)
      real(wp), allocatable :: scale(:)              !< Sum of the magnitudes of the elements' contributions.
      real(wp), allocatable :: values(:)             !< The matrix, in the order of the pattern.
      integer :: source = BY_MATERIAL                !< Source of the response of the points in the next pass.
      type(slopes_t) :: slopes                       !< Slopes that are kept between passes.
      integer :: fallback = NO_FALLBACK              !< Kind of replacement of soft tangents, see tangent_fallback.
      integer :: replaced = 0                        !< Points whose tangent was replaced in the last matrix.
      integer, allocatable :: soft(:)                !< Such points of every element.
      logical, allocatable :: air(:)                 !< Nodes whose air pressure is prescribed.
      ! Outcome.
      integer :: bad_element = 0, bad_point = 0
      type(batch_report_t) :: bad
      integer :: rate_evaluations = 0
      real(wp) :: material = 0.0_wp                  !< Share of the material in the time of the last pass.
   end type assembly_t
contains
   !> Makes room for residual, tangent and scales of a domain; the pattern must be that of its elements.
   subroutine make_assembly(domain, dofs, pattern, assembly)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(assembly_t), intent(out) :: assembly
      integer :: m

      m = size(dofs%element, 1)
      allocate (assembly%r(m, size(dofs%element, 2)), assembly%k(pattern%before(size(pattern%before))), source=0.0_wp)
      allocate (assembly%stretch(m, size(dofs%element, 2)), source=0.0_wp)
      allocate (assembly%residual(dofs%n), assembly%scale(dofs%n), assembly%floor(dofs%n), source=0.0_wp)
      allocate (assembly%values(size(pattern%col)), source=0.0_wp)
      if (domain%with_c) allocate (assembly%water(dofs%n), source=0.0_wp)
      allocate (assembly%air(size(domain%mesh%x, 2)), source=.false.)
      assembly%slopes = new_slopes(size(domain%mesh%t6, 2)*domain%rule)
   end subroutine make_assembly

   !> Decides before the first pass of a step whether it follows the slopes of the step before, where they are known.
   !> From here on the slopes are those of this step's passes. docs/theory/host.md section 5.4.
   pure subroutine follow_slopes_first(assembly)
      type(assembly_t), intent(inout) :: assembly

      assembly%source = merge(BY_SLOPES, BY_MATERIAL, assembly%slopes%known)
      assembly%slopes%known = .false.
   end subroutine follow_slopes_first

   !> Sums the internal forces of the state `new`; loads are not in it. The next pass asks the material, whatever this
   !> one did. docs/theory/host.md sections 3.3 and 3.4. Residual, scale, floor: [kN, m3/s]. Where a point fails,
   !> bad_element > 0 with bad_point and the report `bad` of the first; the sums are then those of the pass before.
   subroutine assemble(domain, dofs, pattern, scheme, old, new, with_tangent, assembly)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      type(scheme_t), intent(in) :: scheme
      type(model_state_t), intent(in) :: old
      type(model_state_t), intent(inout) :: new
      logical, intent(in) :: with_tangent
      type(assembly_t), intent(inout) :: assembly
      real(wp) :: seconds, t0
      type(element_block_t) :: block
      type(element_block_t) :: failed   !< The first block that failed.
      type(element_t) :: out
      integer :: e, ne, rates, threads

      ne = size(dofs%element, 2)
      seconds = 0.0_wp
      rates = 0
      failed%first = ne + 1
      t0 = clock()
      block%source = merge(BY_MATERIAL, assembly%source, assembly%fallback /= NO_FALLBACK)
      block%fallback = assembly%fallback
      out%with_change = assembly%with_change
      assembly%source = BY_MATERIAL
      threads = merge(domain%threads, 1, ne >= WORTH_THREADS)
      if (assembly%fallback /= NO_FALLBACK .and. .not. allocated(assembly%soft)) allocate (assembly%soft(ne))
      if (assembly%with_change .and. .not. allocated(assembly%d_r)) allocate (assembly%d_r(size(dofs%element, 1), ne))
      !$omp parallel do num_threads(threads) schedule(dynamic, 1) default(shared) private(e) &
      !$omp firstprivate(block, out) reduction(+:seconds, rates)
      do e = 1, ne, MOST_ELEMENTS
         call compute_elements(e, min(e + MOST_ELEMENTS - 1, ne), block, out, seconds, rates)
      end do
      !$omp end parallel do
      assembly%rate_evaluations = rates
      assembly%bad_element = 0
      if (failed%first <= ne) then
         call find_failed_point(failed)
         return
      end if
      if (with_tangent) then
         assembly%replaced = 0
         if (assembly%fallback /= NO_FALLBACK) assembly%replaced = sum(assembly%soft)
      end if
      call add_up(domain, dofs, pattern, with_tangent, assembly)
      ! The threads share the loop evenly.
      assembly%material = min(1.0_wp, seconds/threads/max(clock() - t0, tiny(1.0_wp)))
   contains
      !> Computes the elements from .. to, those of one region together.
      subroutine compute_elements(from, to, block, out, seconds, rates)
         integer, intent(in) :: from, to
         type(element_block_t), intent(inout) :: block
         type(element_t), intent(inout) :: out
         real(wp), intent(inout) :: seconds
         integer, intent(inout) :: rates
         type(points_t) :: points
         integer :: e

         block%last = from - 1
         do while (block%last < to)
            block%first = block%last + 1
            block%last = block%first
            if (.not. is_present(old, block%first)) then
               call keep_element_state(domain, block%first, old, new)
               call leave_out(block%first)
               cycle
            end if
            do e = block%first + 1, to
               if (.not. is_present(old, e) .or. domain%region_of(e) /= domain%region_of(block%first)) exit
               block%last = e
            end do
            call update_block(domain, scheme, old, new, with_tangent, assembly%slopes, block, points)
            seconds = seconds + block%seconds
            rates = rates + block%report%n_rate
            if (block%report%code /= 0) then
               !$omp critical
               if (block%first < failed%first) failed = block
               !$omp end critical
               cycle
            end if
            do e = block%first, block%last
               call add_element(domain, e, scheme, block, points, old, new, with_tangent, out)
               call give(e, out)
               if (with_tangent .and. block%fallback /= NO_FALLBACK) assembly%soft(e) = count( &
                  block%soft((e - block%first)*domain%rule + 1:(e - block%first + 1)*domain%rule))
            end do
         end do
      end subroutine compute_elements

      !> Finds the first point of a block that failed: its elements are updated once more one by one, so that which is
      !> first does not depend on the threads.
      subroutine find_failed_point(failed)
         type(element_block_t), intent(in) :: failed
         type(element_block_t) :: block
         type(points_t) :: points
         integer :: e

         block = failed
         do e = failed%first, failed%last
            block%first = e
            block%last = e
            call update_block(domain, scheme, old, new, with_tangent, assembly%slopes, block, points)
            if (block%report%code /= 0) exit
         end do
         ! A law that remembers its calls may refuse none of them now: then its answer of before counts.
         if (block%report%code == 0) then
            e = failed%first + (failed%report%point - 1)/domain%rule
            block%report = failed%report
            block%report%point = failed%report%point - (e - failed%first)*domain%rule
         end if
         assembly%bad_element = e
         assembly%bad_point = block%report%point
         assembly%bad = block%report
      end subroutine find_failed_point

      !> Gives an element to its places in the sums.
      subroutine give(e, out)
         integer, intent(in) :: e
         type(element_t), intent(inout) :: out
         integer :: i, m, n

         m = size(assembly%r, 1)
         n = element_size(domain, e)
         if (domain%with_c) call balance_of_water(domain, dofs, assembly%air, e, n, with_tangent, out)
         assembly%r(:, e) = out%r(:m)
         assembly%stretch(:, e) = out%stretch(:m)
         if (assembly%with_change) assembly%d_r(:, e) = out%change(:m)
         if (.not. with_tangent) return
         do i = 1, n
            assembly%k(pattern%before(e) + (i - 1)*n + 1:pattern%before(e) + i*n) = out%k(:n, i)
         end do
      end subroutine give

      !> An element that is not part of the ground has no share in the sums.
      subroutine leave_out(element)
         integer, intent(in) :: element

         assembly%r(:, element) = 0.0_wp
         assembly%stretch(:, element) = 0.0_wp
         if (assembly%fallback /= NO_FALLBACK) assembly%soft(element) = 0
         if (assembly%with_change) assembly%d_r(:, element) = 0.0_wp
         if (with_tangent) assembly%k(pattern%before(element) + 1:pattern%before(element + 1)) = 0.0_wp
      end subroutine leave_out
   end subroutine assemble

   !> Replaces the sum of the balances by its difference from that of the air, the balance of water, where the air
   !> pressure is prescribed and the flow of air unknown.
   pure subroutine balance_of_water(domain, dofs, air, e, m, with_tangent, out)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      logical, intent(in) :: air(:)
      integer, intent(in) :: e, m
      logical, intent(in) :: with_tangent
      type(element_t), intent(inout) :: out
      integer :: i, w, c

      if (domain%regions(domain%region_of(e))%drainage /= COUPLED) return
      do i = 1, domain%n_p
         w = LAST_U + i
         if (.not. air(dofs%node(dofs%element(w, e)))) cycle
         c = w + domain%n_p
         out%r(w) = out%r(w) - out%r(c)
         if (with_tangent) out%k(w, :m) = out%k(w, :m) - out%k(c, :m)
      end do
   end subroutine balance_of_water

   !> Adds up the elements in their order, so that the sums do not depend on the number of threads.
   pure subroutine add_up(domain, dofs, pattern, with_tangent, assembly)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      type(pattern_t), intent(in) :: pattern
      logical, intent(in) :: with_tangent
      type(assembly_t), intent(inout) :: assembly
      real(wp) :: water
      integer :: a, e, i, j

      assembly%residual = 0.0_wp
      assembly%scale = 0.0_wp
      assembly%floor = 0.0_wp
      do e = 1, size(dofs%element, 2)
         do a = 1, size(dofs%element, 1)
            i = dofs%element(a, e)
            if (i == 0) cycle
            assembly%residual(i) = assembly%residual(i) + assembly%r(a, e)
            assembly%scale(i) = assembly%scale(i) + abs(assembly%r(a, e))
            assembly%floor(i) = assembly%floor(i) + assembly%stretch(a, e)
         end do
      end do
      if (assembly%with_change) then
         if (.not. allocated(assembly%change)) allocate (assembly%change(pattern%n))
         assembly%change = 0.0_wp
         do e = 1, size(dofs%element, 2)
            do a = 1, LAST_U
               associate (change => assembly%change(dofs%element(a, e)))
                  change = change + abs(assembly%d_r(a, e))
               end associate
            end do
         end do
      end if
      if (allocated(assembly%water)) then
         assembly%water = 0.0_wp
         do e = 1, size(dofs%element, 2)
            do a = LAST_U + 1, LAST_U + domain%n_carriers(e)
               i = dofs%element(a, e)
               if (i == 0) cycle
               ! The rows of p_w less those of p_c, unless they are the balance of the water already.
               water = assembly%r(a, e)
               if (.not. assembly%air(dofs%node(i))) water = water - assembly%r(a + domain%n_carriers(e), e)
               assembly%water(i) = assembly%water(i) + abs(water)
            end do
         end do
      end if
      if (.not. with_tangent) return
      assembly%values = 0.0_wp
      do j = 1, size(pattern%place)
         assembly%values(pattern%place(j)) = assembly%values(pattern%place(j)) + assembly%k(j)
      end do
   end subroutine add_up
end module equation_assembly
