! SPDX-License-Identifier: MIT
!> Warnings of a run whose pore water pressures alternate from node to node (docs/theory/host.md section 3.1), in which
!> the pore water is under a tension that no soil holds (section 9.2), or in which a material made for compression has
!> lost its mean effective stress and has no guard that would have kept it.
module pressure_alarm
   use warnings, only: print_warning, is_told
   use kinds, only: wp
   use material_point, only: lost_pressure, PRESSURE_LOST
   use model_types, only: now_in
   use porous_domain, only: is_present, COUPLED
   use run_state, only: run_t
   use texts, only: place_text, short
   use triangle_mesh, only: sides_of
   use unknown_fields, only: AT_P_W
   implicit none (type, external)
   private
   public :: warn_of_pressures, lines_t, find_lines, find_alternation

   !> Least amplitude of an alternation that is told, share of the range of all pressures: a field that the mesh follows
   !> bends one way at neighbouring nodes and leaves none [-].
   real(wp), parameter :: ALARMING_SHARE = 0.1_wp
   real(wp), parameter :: STRAIGHT = -0.8_wp        !< Cosine of the angle between two sides that go on from each other.
   real(wp), parameter :: SMALLEST_RANGE = 0.1_wp   !< [kPa] Of pressures that anybody looks at.
   real(wp), parameter :: OVEN_DRY = 1.0e6_wp       !< [kPa] Suction of soil from the oven: none holds water beyond it.

   character(*), parameter :: OSCILLATION = 'oscillation of pressures', NO_PRESSURE = 'lost mean stress', &
                              DRY_GROUND = 'dry ground'

   !> Lines of five nodes of a mesh: two sides that go on from each other at a corner.
   type :: lines_t
      integer, allocatable :: nodes(:, :)   !< (5, lines) end, middle, corner, middle, end
      real(wp), allocatable :: share(:)     !< (lines) Weight of the first middle in the mean at the corner [-].
   end type lines_t
contains
   !> Warns of each once a run, on standard error, also where the run is quiet.
   subroutine warn_of_pressures(run, lines)
      type(run_t), intent(in) :: run            !< After a step.
      type(lines_t), intent(inout) :: lines     !< Lines of the mesh; found when they are asked for first.

      if (.not. is_told(OSCILLATION)) call warn_of_oscillation(run, lines)
      if (.not. is_told(NO_PRESSURE)) call warn_lost_pressure(run)
      if (.not. is_told(DRY_GROUND)) call warn_of_dry_ground(run)
   end subroutine warn_of_pressures

   !> Warns of pressures that alternate; not in static stages, nor of linear pressures. docs/theory/host.md section 3.1.
   subroutine warn_of_oscillation(run, lines)
      type(run_t), intent(in) :: run
      type(lines_t), intent(inout) :: lines   !< Lines of the mesh; found when they are asked for first.
      real(wp) :: share
      logical :: counts(size(run%domain%mesh%x, 2))
      integer :: node, e

      associate (domain => run%domain, mesh => run%domain%mesh, x => run%next%x)
         ! Linear pressures are those of the corners alone.
         if (.not. run%stage%has_rates .or. domain%n_p < 6) return
         ! Pressures that are no unknowns of the ground do not count.
         counts = .false.
         do e = 1, size(mesh%t6, 2)
            if (domain%regions(domain%region_of(e))%drainage == COUPLED .and. is_present(run%next, e)) &
               counts(mesh%t6(:, e)) = .true.
         end do
         if (.not. allocated(lines%nodes)) lines = find_lines(mesh%x, mesh%t6)
         call find_alternation(lines, x(AT_P_W, :size(counts)), counts, share, node)
         if (share <= ALARMING_SHARE) return
         call print_warning(now_in(run)//'the pore water pressure at '//place_text(mesh%x(:, node))//', '// &
            short(x(AT_P_W, node))//' kPa, lies to the other side of the mean of its neighbours than they do of '// &
            'theirs, by '//short(100*share)//' % of the range of all pressures. Pressures that alternate from node '// &
            'to node are wrong: set pressures = ''linear'' in &scene, which is stable where water cannot drain.', &
            once=OSCILLATION)
      end associate
   end subroutine warn_of_oscillation

   !> Warns of a material that has lost its mean effective stress. docs/theory/memory-rules.md section 2.2.
   subroutine warn_lost_pressure(run)
      type(run_t), intent(in) :: run
      integer :: e, g

      do e = 1, size(run%domain%region_of)
         associate (m => run%domain, law => run%domain%regions(run%domain%region_of(e))%law)
            if (.not. law%unguarded .or. .not. is_present(run%next, e)) cycle
            do g = 1, m%rule
               associate (stress => run%next%stress(:, (e - 1)*m%rule + g), x => m%gauss(g, e)%x)
                  if (.not. lost_pressure(law, stress)) cycle
                  call print_warning('time '//short(run%next%time)//' s: the mean effective stress p'' at '// &
                     place_text(x)//' is '//short(-sum(stress(:3))/3)//' kPa: '//PRESSURE_LOST, once=NO_PRESSURE)
                  return
               end associate
            end do
         end associate
      end do
   end subroutine warn_lost_pressure

   !> Warns of pore water under more tension than any soil holds: more is drawn than the ground has, or lets through,
   !> and water that expands makes up for it. docs/theory/host.md section 9.2.
   subroutine warn_of_dry_ground(run)
      type(run_t), intent(in) :: run
      integer :: node

      if (.not. run%domain%with_w) return
      associate (x => run%domain%mesh%x, p_w => run%next%x(AT_P_W, :))
         node = minloc(p_w(:size(x, 2)), dim=1)
         if (p_w(node) > -OVEN_DRY) return
         call print_warning(now_in(run)//'the pore water at '//place_text(x(:, node))// &
            ' is under a tension of '//short(-p_w(node))//' kPa. Soil is oven-dry at '//short(OVEN_DRY)//' kPa: '// &
            'more is drawn than the ground holds or lets through, and the rest comes out of water that expands. '// &
            'Let a &fix of p_w, or a &history, limit what is drawn.', once=DRY_GROUND)
      end associate
   end subroutine warn_of_dry_ground

   !> Finds the lines of a mesh: at every corner the pairs of sides that go on from each other.
   pure function find_lines(x, t6) result(lines)
      real(wp), intent(in) :: x(:, :)     !< (2, nodes) [m]
      integer, intent(in) :: t6(:, :)     !< (6, elements)
      type(lines_t) :: lines
      integer :: sides(3, 6*size(t6, 2))   !< From both their ends: node, end, middle.
      integer :: first(size(x, 2)), next(6*size(t6, 2))   !< First side of a node, the next one there; 0: there is none.
      integer :: sides_at(size(x, 2)), c, i, j, n
      logical :: known(size(x, 2))
      real(wp) :: one(2), other(2)

      n = 3*size(t6, 2)
      sides(:, :n) = sides_of(t6)
      sides(:, n + 1:) = sides([2, 1, 3], :n)
      first = 0
      known = .false.
      sides_at = 0
      ! Each side once: a middle belongs to one side.
      do i = n, 1, -1
         if (known(sides(3, i))) cycle
         known(sides(3, i)) = .true.
         do j = i, i + n, n
            next(j) = first(sides(1, j))
            first(sides(1, j)) = j
            sides_at(sides(1, j)) = sides_at(sides(1, j)) + 1
         end do
      end do
      allocate (lines%nodes(5, sum(sides_at*(sides_at - 1))/2), lines%share(sum(sides_at*(sides_at - 1))/2))
      n = 0
      do c = 1, size(x, 2)
         i = first(c)
         do while (i > 0)
            one = x(:, sides(3, i)) - x(:, c)
            j = next(i)
            do while (j > 0)
               other = x(:, sides(3, j)) - x(:, c)
               if (dot_product(one, other) <= STRAIGHT*norm2(one)*norm2(other)) then
                  n = n + 1
                  lines%nodes(:, n) = [sides(2:3, i), c, sides(3:2:-1, j)]
                  lines%share(n) = norm2(other)/(norm2(one) + norm2(other))
               end if
               j = next(j)
            end do
            i = next(i)
         end do
      end do
      lines%nodes = lines%nodes(:, :n)
      lines%share = lines%share(:n)
   end function find_lines

   !> Finds the corner at which pressures alternate most, and the least distance of it and of both middles beside it
   !> from the mean of their neighbours where these alternate, share of the range of all pressures; 0 where none do or
   !> the range is too small to matter. docs/theory/host.md section 3.1.
   pure subroutine find_alternation(lines, p, counts, share, node)
      type(lines_t), intent(in) :: lines
      real(wp), intent(in) :: p(:)         !< (nodes) [kPa]
      logical, intent(in) :: counts(:)     !< (nodes) The pressure is one of the ground.
      real(wp), intent(out) :: share       !< [-]
      integer, intent(out) :: node
      real(wp) :: span, corner, beside(2)
      integer :: i

      share = 0.0_wp
      node = 1
      if (.not. any(counts)) return
      span = maxval(p, mask=counts) - minval(p, mask=counts)
      if (span < SMALLEST_RANGE) return
      do i = 1, size(lines%share)
         associate (at => lines%nodes(:, i), part => lines%share(i))
            if (.not. all(counts(at))) cycle
            corner = p(at(3)) - part*p(at(2)) - (1 - part)*p(at(4))
            beside = p(at([2, 4])) - 0.5_wp*(p(at(3)) + p(at([1, 5])))
            if (any(beside*corner >= 0.0_wp)) cycle
            if (min(abs(corner), minval(abs(beside))) <= share*span) cycle
            share = min(abs(corner), minval(abs(beside)))/span
            node = at(3)
         end associate
      end do
   end subroutine find_alternation
end module pressure_alarm
