! SPDX-License-Identifier: MIT
!> Whether the ground of a scene begins in balance: the forces that nothing balances at time 0, as a stress.
!> docs/theory/host.md section 8.
module start_balance
   use kinds, only: wp
   use acting_places, only: given_in
   use boundary_conditions, only: plate_loads
   use start_findings, only: balance_t
   use model_types, only: model_t, factor_at, value_at, load_t, unknowns_of
   use newton_step, only: unbalanced_forces
   use porous_domain, only: pressures_at, is_present
   use run_state, only: run_t, enter_stage
   use scene_parts, only: LOAD_PRESSURE
   use unknown_fields, only: DISPLACEMENTS, AT_P_W
   implicit none (type, external)
   private
   public :: find_imbalance

   real(wp), parameter :: NOTABLE = 0.1_wp    !< Share of the stress around a node that is an imbalance.
   real(wp), parameter :: ROUNDING = 1.0e-9_wp   !< Share of the forces of the elements at a node.
   real(wp), parameter :: SMALL = 0.01_wp     !< Share of the largest stress of the ground that is none.
contains
   !> Finds the largest unbalanced stress of a prepared run; not known where a material or contact refuses the start. Of
   !> the loads of the first stage those count that the ground carries already: what is more acts at once, on purpose.
   subroutine find_imbalance(run, balance)
      type(run_t), intent(in) :: run
      type(balance_t), intent(out) :: balance
      type(run_t) :: trial
      real(wp), allocatable :: forces(:), touched(:)
      real(wp) :: areas(2*DISPLACEMENTS, run%dofs%n), least, standing
      real(wp), dimension(run%dofs%n) :: stress, unbalanced
      integer :: i

      trial = run
      trial%state%v = 0.0_wp
      trial%state%a = 0.0_wp
      trial%next = trial%state
      if (allocated(trial%system%contacts)) call trial%system%contacts%act(spread(.false., 1, size(run%model%contacts)))
      if (.not. unbalanced_forces(trial%solution_t, forces)) return
      where (abs(forces) < ROUNDING*trial%assembly%scale) forces = 0.0_wp
      touched = 0*forces
      if (allocated(trial%system%contacts)) then
         call enter_stage(trial, 1)
         if (.not. unbalanced_forces(trial%solution_t, touched)) return
         touched = touched - forces
      end if
      call add_weight_of_water(run, forces, standing)
      call let_go_of_held(run%model, forces)
      call add_carried_loads(run, touched, forces)
      call look_around(run, standing, areas, stress)
      unbalanced = 0.0_wp
      do i = 1, size(forces)
         if (abs(forces(i)) > 0.0_wp .and. any(areas(:, i) > 0.0_wp)) unbalanced(i) = abs(forces(i))/maxval(areas(:, i))
      end do
      balance%known = .true.
      ! Total stresses may cancel to rounding of effective ones and pressures.
      least = max(SMALL*maxval(stress), ROUNDING*maxval(abs(run%state%stress)), &
                  ROUNDING*maxval(abs(run%state%x(AT_P_W:, :))))
      balance%matters = any(unbalanced > NOTABLE*stress .and. unbalanced > least)
      i = maxloc(unbalanced, dim=1)
      if (balance%matters) i = maxloc(unbalanced, dim=1, mask=unbalanced > NOTABLE*stress)
      balance%stress = unbalanced(i)
      balance%there = stress(i)
      balance%x = run%domain%mesh%x(:, run%dofs%node(i))
   end subroutine find_imbalance

   !> Adds the pressures at time 0 that are those of the water at their edges: water that stands there did so before.
   subroutine add_weight_of_water(run, forces, most)
      type(run_t), intent(in) :: run
      real(wp), intent(inout) :: forces(:)   !< (unknowns) [kN]
      real(wp), intent(out) :: most          !< The largest of them [kPa].
      real(wp) :: water
      integer :: i

      most = 0.0_wp
      do i = 1, size(run%model%loads)
         associate (one => run%model%loads(i))
            water = water_in(run, one)
            if (water > 0.0_wp) forces = forces + factor_at(run%model, one%amplitude, 0.0_wp)*one%vector
            most = max(most, water)
         end associate
      end do
   end subroutine add_weight_of_water

   !> Finds the largest pressure of a load of the first stage that is at time 0 that of the pore water wherever it acts,
   !> else 0 [kPa].
   real(wp) function water_in(run, load) result(most)
      type(run_t), intent(in) :: run
      type(load_t), intent(in) :: load
      real(wp) :: given, p_w
      integer :: k, i

      most = 0.0_wp
      if (load%kind /= LOAD_PRESSURE .or. .not. load%in_stage(1)) return
      associate (x => run%domain%mesh%x, edges => run%domain%mesh%groups(load%group)%edges)
         do k = 1, size(edges, 2)
            do i = 1, 2
               given = factor_at(run%model, load%amplitude, 0.0_wp)*value_at(load, x(2, edges(i, k)))
               p_w = run%state%x(AT_P_W, edges(i, k))
               if (abs(given - p_w) > SMALL*max(given, p_w)) then
                  most = 0.0_wp
                  return
               end if
               most = max(most, p_w)
            end do
         end do
      end associate
   end function water_in

   !> Supports and dashpots of the first stage hold what they have, rigid bodies stand on their contacts.
   subroutine let_go_of_held(model, forces)
      type(model_t), intent(in) :: model
      real(wp), intent(inout) :: forces(:)   !< (unknowns) [kN]
      logical, allocatable :: held(:, :)
      integer :: i, f

      allocate (held, source=given_in(model, 1))
      do i = 1, size(model%actions)
         associate (one => model%actions(i))
            if (one%damps .and. one%in_stage(1) .and. model%stages(1)%has_inertia) &
               held(:, model%domain%mesh%groups(one%group)%nodes) = .true.
         end associate
      end do
      held(:, model%domain%bodies) = .true.
      ! Nodes that are tied share their unknowns: one that is held holds them for all.
      do f = 1, DISPLACEMENTS
         associate (at => pack(model%dofs%of(f, :), held(f, :)))
            forces(pack(at, at > 0)) = 0.0_wp
         end associate
      end do
   end subroutine let_go_of_held

   !> Adds what contacts press with, and every load at time 0, that leaves less without balance.
   subroutine add_carried_loads(run, touched, forces)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: touched(:)     !< (unknowns) Of contacts [kN].
      real(wp), intent(inout) :: forces(:)   !< (unknowns) [kN]
      real(wp) :: load(size(forces))
      integer :: i

      call carry(touched)
      do i = 1, size(run%model%loads)
         associate (one => run%model%loads(i))
            if (.not. one%in_stage(1) .or. water_in(run, one) > 0.0_wp) cycle
            call carry(factor_at(run%model, one%amplitude, 0.0_wp)*one%vector)
         end associate
      end do
      do i = 1, size(run%model%plates)
         associate (one => run%model%plates(i))
            if (one%penalty > 0.0_wp .or. one%group == 0) cycle
            load = 0.0_wp
            load(unknowns_of(one, run%dofs)) = plate_loads(run%model, one, 0.0_wp)
            call carry(load)
         end associate
      end do
   contains
      subroutine carry(what)
         real(wp), intent(in) :: what(:)
         real(wp) :: free(size(what))

         free = merge(what, 0.0_wp, abs(forces) > 0.0_wp)
         if (norm2(forces + free) < norm2(forces)) forces = forces + free
      end subroutine carry
   end subroutine add_carried_loads

   !> Finds for every displacement the area that a stress on one side of its nodes acts on with it, along r and z, from
   !> either side; and the largest total normal stress around it, less that of water on the ground; 0 without effective
   !> stress [kPa].
   subroutine look_around(run, standing, areas, stress)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: standing                  !< Pressure of the water on the ground [kPa].
      real(wp), intent(out) :: areas(:, :), stress(:)   !< (4, unknowns) [m2], (unknowns)
      real(wp) :: part(2*DISPLACEMENTS), pressures(2), total
      integer :: e, g, k, f, p, at

      areas = 0.0_wp
      stress = 0.0_wp
      associate (m => run%domain)
         do e = 1, size(m%mesh%t6, 2)
            if (.not. is_present(run%state, e)) cycle
            do g = 1, m%rule
               p = (e - 1)*m%rule + g
               pressures = pressures_at(m, e, g, run%state%x(AT_P_W:, m%carriers(:m%n_carriers(e), e)))
               ! Below a lake the total stress is large anywhere, and water alone bears nothing.
               total = maxval(abs(run%state%stress(1:3, p) - pressures(1) - (1 - run%state%s(p))*pressures(2) &
                                  + standing))
               if (.not. any(abs(run%state%stress(1:3, p)) > 0.0_wp)) total = 0.0_wp
               do k = 1, 6
                  associate (gp => m%gauss(g, e))
                     part = gp%weight*[max(0.0_wp, gp%dn(k, :)), max(0.0_wp, -gp%dn(k, :))]
                  end associate
                  do f = 1, DISPLACEMENTS
                     at = run%dofs%of(f, m%mesh%t6(k, e))
                     if (at == 0) cycle
                     areas(:, at) = areas(:, at) + part
                     stress(at) = max(stress(at), total)
                  end do
               end do
            end do
         end do
      end associate
   end subroutine look_around
end module start_balance
