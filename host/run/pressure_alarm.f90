! SPDX-License-Identifier: MIT
!> Warnings of a run whose pore water pressures oscillate from node to node (docs/theory/host.md section 3.1), in which
!> a node of a seepage face lets water in (section 7.7), or in which a material made for compression has lost its mean
!> effective stress and has no guard that would have kept it.
module pressure_alarm
   use warnings, only: print_warning
   use kinds, only: wp
   use generalised_alpha, only: STATIC
   use material_point, only: lost_pressure, PRESSURE_LOST
   use model_types, only: model_t
   use porous_domain, only: state_t, is_present, COUPLED
   use texts, only: short
   use unknown_fields, only: AT_P_W
   use scene_types, only: stage_t
   implicit none (type, external)
   private
   public :: warn_of_oscillation, warn_lost_pressure, warn_of_inflow, outstanding_corner

   !> By how much a corner may differ from all sides around it, share of the range of all pressures: linear and
   !> parabolic fields leave nothing, a field that the mesh follows little [-].
   real(wp), parameter :: ALARMING_SHARE = 0.25_wp
   real(wp), parameter :: SMALLEST_RANGE = 0.1_wp   !< [kPa] Of pressures that anybody looks at.
contains
   !> After an accepted step; once a run, on standard error, also where the run is quiet. Not in static stages, nor of
   !> linear pressures. docs/theory/host.md section 3.1. Raises no fault.
   subroutine warn_of_oscillation(model, stage, state, told)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(state_t), intent(in) :: state
      logical, intent(inout) :: told
      real(wp) :: share, p(size(model%domain%mesh%x, 2))
      logical :: counts(size(p))
      integer :: node, e

      ! Linear pressures are those of the corners alone.
      if (told .or. stage%kind == STATIC .or. model%domain%n_p < 6) return
      p = state%x(AT_P_W, :size(p))
      associate (mesh => model%domain%mesh, flows => [(model%domain%regions(model%domain%region_of(e))%drainage == &
                 COUPLED .and. is_present(state, e), e=1, size(model%domain%region_of))])
         if (.not. any(flows)) return
         ! Pressures that are no unknowns of the ground do not count.
         counts = .false.
         do e = 1, size(flows)
            if (flows(e)) counts(mesh%t6(:, e)) = .true.
         end do
         where (.not. counts) p = p(mesh%t6(1, findloc(flows, .true., dim=1)))
         call outstanding_corner(mesh%t6(:, pack([(e, e=1, size(flows))], flows)), p, share, node)
         if (share <= ALARMING_SHARE) return
         told = .true.
         call print_warning('stage '//trim(stage%name)//', time '//short(state%time)// &
            ' s: the pore water pressure at ('//short(mesh%x(1, node))//', '//short(mesh%x(2, node))//') m, '// &
            short(p(node))//' kPa, differs from those around it by '//short(100*share)// &
            ' % of the range of all pressures. Pressures that oscillate from node to node are wrong: refine the '// &
            'mesh there, take longer steps or, where hardly any water drains, set pressures = ''linear'' in &scene.')
      end associate
   end subroutine warn_of_oscillation

   !> After an accepted step; once a run, on standard error, also where the run is quiet. docs/theory/memory-rules.md
   !> section 2.2. Raises no fault.
   subroutine warn_lost_pressure(model, state, told)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      logical, intent(inout) :: told
      integer :: e, g, p

      if (told) return
      do e = 1, size(model%domain%region_of)
         associate (law => model%domain%regions(model%domain%region_of(e))%law, stress => state%stress)
            if (.not. law%unguarded .or. .not. is_present(state, e)) cycle
            do g = 1, model%domain%rule
               p = (e - 1)*model%domain%rule + g
               if (.not. lost_pressure(law, stress(:, p))) cycle
               told = .true.
               call print_warning('time '//short(state%time)// &
                  ' s: the mean effective stress p'' at ('//short(model%domain%gauss(g, e)%x(1))//', '// &
                  short(model%domain%gauss(g, e)%x(2))//') m is '//short(-sum(stress(:3, p))/3)//' kPa: '// &
                  PRESSURE_LOST)
               return
            end do
         end associate
      end do
   end subroutine warn_lost_pressure

   !> After an accepted step; once a run, on standard error, also where the run is quiet. docs/theory/host.md
   !> section 7.7. Raises no fault.
   subroutine warn_of_inflow(model, stage, time, drinks, told)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      real(wp), intent(in) :: time      !< [s]
      integer, intent(in) :: drinks     !< Unknown that keeps its limit although water enters there, 0: none.
      logical, intent(inout) :: told

      if (told .or. drinks == 0) return
      told = .true.
      associate (x => model%domain%mesh%x(:, model%dofs%node(drinks)))
         call print_warning('stage '//trim(stage%name)//', time '//short(time)// &
            ' s: the node at ('//short(x(1))//', '//short(x(2))//') m of a seepage face, or under rain, left its '// &
            'limit three times within the step, and keeps it although water enters there. Shorten the steps or '// &
            'refine the mesh there.')
      end associate
   end subroutine warn_of_inflow

   !> The corner of the mesh that stands out most, and by which share of the range of all pressures; 0 where no corner
   !> does or the range is too small to matter. A corner stands out by what it is above, or below, the middles of all
   !> sides around it beyond what these differ from the other ends of their sides. docs/theory/host.md section 3.1.
   pure subroutine outstanding_corner(t6, p, share, node)
      integer, intent(in) :: t6(:, :)   !< (6, elements)
      real(wp), intent(in) :: p(:)       !< At the nodes [kPa]. (nodes)
      real(wp), intent(out) :: share   !< [-]
      integer, intent(out) :: node
      real(wp), allocatable :: lowest(:), highest(:)
      integer :: e, k

      share = 0.0_wp
      node = 1
      if (maxval(p) - minval(p) < SMALLEST_RANGE) return
      allocate (lowest(size(p)), source=huge(1.0_wp))
      allocate (highest(size(p)), source=-huge(1.0_wp))
      do e = 1, size(t6, 2)
         do k = 1, 3
            associate (corner => t6(k, e), middles => p(t6([k + 3, mod(k + 1, 3) + 4], e)), &
                       ends => p(t6([mod(k, 3) + 1, mod(k + 1, 3) + 1], e)))
               lowest(corner) = min(lowest(corner), minval(middles - abs(middles - ends)))
               highest(corner) = max(highest(corner), maxval(middles + abs(middles - ends)))
            end associate
         end do
      end do
      lowest = max(lowest - p, p - highest)
      where (highest < -0.5_wp*huge(1.0_wp)) lowest = 0.0_wp   ! no corner
      node = maxloc(lowest, 1)
      share = max(0.0_wp, lowest(node)/(maxval(p) - minval(p)))
   end subroutine outstanding_corner
end module pressure_alarm
