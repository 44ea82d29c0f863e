! SPDX-License-Identifier: MIT
!> Regions whose pressures are given, or in which every element has pressures of its own, drainage of &region: what
!> their pressures begin with, the nodes where an unknown meets them, and what is shown there.
!> docs/theory/host.md section 3.5.
module drained_regions
   use kinds, only: wp
   use faults, only: fault_t
   use given_pressures, only: pressures_at_start, set_middles
   use model_types, only: model_t, problem_t
   use porous_domain, only: domain_t, is_present, DRAINED, UNDRAINED
   use scene_term, only: scene_term_t
   use triangle_mesh, only: nodes_of
   use unknown_fields, only: AT_P_W, AT_P_C, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: drained_regions_t

   type, extends(scene_term_t) :: drained_regions_t
   contains
      procedure :: build, prescribe, complete
   end type drained_regions_t
contains
   !> Its key is one of regions, which are built before. Raises no fault.
   subroutine build(self, model, fault)
      class(drained_regions_t), intent(inout) :: self
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault

      self%wanted = any(model%domain%regions%drainage == DRAINED .or. model%domain%regions%drainage == UNDRAINED)
      if (self%wanted) call give_pressures(model)
   end subroutine build

   !> Pressures that are no unknowns. docs/theory/host.md section 3.5. Sets `given` of the domain [kPa].
   subroutine give_pressures(model)
      type(model_t), intent(inout) :: model
      real(wp) :: p(2, size(model%domain%mesh%x, 2), DRAINED:UNDRAINED)
      integer :: e, i

      associate (domain => model%domain)
         do i = DRAINED, UNDRAINED
            p(:, :, i) = pressures_at_start(model, domain%regions(domain%region_of)%drainage == i)
            call set_middles(domain, p(:, :, i))
         end do
         do e = 1, size(domain%region_of)
            if (domain%center(e) == 0) cycle
            ! The mean of a quadratic field over a triangle is that of the middles of its sides.
            p(:, domain%center(e), UNDRAINED) = sum(p(:, domain%mesh%t6(4:6, e), UNDRAINED), dim=2)/3
         end do
         allocate (domain%given(2, size(p, 2), DRAINED:UNDRAINED), source=p)
      end associate
   end subroutine give_pressures

   !> Where drained ground begins that is there, pressures are its own, but for those of a &fix. The suction of an
   !> undrained element without air stays: no balance of air says what it is.
   subroutine prescribe(self, time, problem)
      class(drained_regions_t), intent(in) :: self
      real(wp), intent(in) :: time
      type(problem_t), intent(inout) :: problem
      integer :: e, i, k, at

      associate (domain => problem%domain, c => problem%constraint)
         do e = 1, size(domain%region_of)
            if (domain%regions(domain%region_of(e))%drainage /= DRAINED) cycle
            if (.not. is_present(problem%state, e)) cycle
            do k = 1, domain%n_p
               associate (node => domain%mesh%t6(k, e))
                  do i = AT_P_W, AT_P_C
                     at = problem%dofs%of(i, node)
                     if (at == 0) cycle
                     if (c%fixed(at)) cycle
                     c%fixed(at) = .true.
                     c%target(at) = domain%given(i - DISPLACEMENTS, node, DRAINED)
                  end do
               end associate
            end do
         end do
         if (domain%fluids%henry > 0.0_wp) return
         do e = 1, size(domain%center)
            if (domain%center(e) == 0) cycle
            at = problem%dofs%of(AT_P_C, domain%center(e))
            if (at == 0) cycle
            if (any(problem%state%s((e - 1)*domain%rule + 1:e*domain%rule) < 1.0_wp)) cycle
            c%fixed(at) = .true.
            c%target(at) = problem%state%x(AT_P_C, domain%center(e))
         end do
      end associate
   end subroutine prescribe

   subroutine complete(self, problem)
      class(drained_regions_t), intent(in) :: self
      type(problem_t), intent(inout) :: problem

      call follow_undrained(problem%domain, problem%dofs%of, problem%next%x)
   end subroutine complete

   !> Pressures of nodes that lie in undrained elements alone, for histories and fields: the mean of what these have
   !> there. No element looks at them. docs/theory/host.md section 3.5.
   subroutine follow_undrained(domain, of, x)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: of(:, :)           !< (FIELDS, nodes) Unknowns, 0: none.
      real(wp), intent(inout) :: x(:, :)        !< (FIELDS, nodes) [m, kPa]
      real(wp) :: total(2, size(x, 2))
      logical :: given(size(x, 2))
      integer :: users(size(x, 2)), e, k

      if (.not. any(domain%center > 0)) return
      total = 0.0_wp
      users = 0
      given = nodes_of(domain%mesh, domain%regions(domain%region_of)%drainage == DRAINED)
      do e = 1, size(domain%center)
         associate (center => domain%center(e))
            if (center == 0) cycle
            do k = 1, domain%n_p
               associate (node => domain%mesh%t6(k, e))
                  total(:, node) = total(:, node) + x(AT_P_W:AT_P_C, center) + domain%given(:, node, UNDRAINED) &
                                   - domain%given(:, center, UNDRAINED)
                  users(node) = users(node) + 1
               end associate
            end do
         end associate
      end do
      ! An unknown, or a given value, stays.
      do k = 1, size(x, 2)
         if (users(k) == 0 .or. given(k) .or. of(AT_P_W, k) > 0) cycle
         x(AT_P_W:AT_P_C, k) = total(:, k)/users(k)
      end do
   end subroutine follow_undrained
end module drained_regions
