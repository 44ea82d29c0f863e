! SPDX-License-Identifier: MIT
!> Absorbing boundaries (Lysmer & Kuhlemeyer 1969) as dashpots: impedances rho c_p and rho c_s of the ground behind the
!> boundary, for pore pressures the outflow of a wave that goes on (its gradient is -1/c_p times its rate), and the
!> force of a wave that comes in. Without keys of their own the impedances are those of the elements at the boundary in
!> the initial state, undrained. docs/theory/host.md section 7.4.
module absorbing_boundaries
   use dashpots, only: dashpots_t
   use edge_points, only: edge_point_t, points_of_edge, PER_EDGE
   use exit_codes, only: EXIT_MATERIAL
   use faults, only: fault_t, raise
   use generalised_alpha, only: DYNAMIC
   use kinds, only: wp
   use material_point, only: response_t, report_t
   use model_types, only: model_t, factor_at
   use permeability_laws, only: relative_t, relative_permeability
   use porous_domain, only: state_t, mixture_density, pressures_at, COUPLED, UNDRAINED
   use scene_types, only: place_of, acts_in, stage_t, absorber_t
   use staged_ground, only: facing_edges, dynamic_stages
   use texts, only: short, whole
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: prepare_absorbers, add_incoming, absorber_acts, switch_absorbers

   !> The ground behind an edge.
   type :: ground_t
      real(wp) :: normal = 0.0_wp, shear = 0.0_wp   !< Impedances rho c_p, rho c_s [kPa s/m].
      real(wp) :: water = 0.0_wp, air = 0.0_wp      !< Outflow over the rate of the pressure, k/(eta c_p) [m/(kPa)].
   end type ground_t
contains
   !> Dashpots of all absorbing boundaries; a fault where the ground has no stiffness or its material refuses.
   !> docs/theory/host.md section 7.4. Not allocated without such boundaries. Fault EXIT_MATERIAL.
   subroutine prepare_absorbers(model, state, list, fault)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state   !< The initial one.
      type(dashpots_t), allocatable, intent(out) :: list(:)   !< (absorbing boundaries)
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (size(model%absorbers) == 0) return
      allocate (list(size(model%absorbers)))
      do i = 1, size(list)
         if (fault%code == 0) call prepare_one(model, model%absorbers(i), state, list(i), fault)
      end do
   end subroutine prepare_absorbers

   subroutine prepare_one(model, absorber, state, one, fault)
      type(model_t), intent(in) :: model
      type(absorber_t), intent(in) :: absorber
      type(state_t), intent(in) :: state
      type(dashpots_t), intent(out) :: one
      type(fault_t), intent(inout) :: fault
      type(ground_t) :: ground
      integer, allocatable :: edges(:, :)
      integer :: e, k, f

      allocate (one%row(0), one%column(0), one%value(0))
      allocate (one%held(model%dofs%n), source=.false.)
      allocate (one%incoming(model%dofs%n), source=0.0_wp)
      one%amplitude = absorber%amplitude
      edges = facing_edges(model, absorber%group, dynamic_stages(model, absorber%stages))
      do e = 1, size(edges, 2)
         call ground_behind(model, absorber, edges(:, e), state, ground, fault)
         if (fault%code /= 0) return
         call add_edge(model, edges(:, e), ground, one)
      end do
      do k = 1, size(one%row)
         f = model%dofs%field(one%column(k))
         if (f > DISPLACEMENTS) cycle
         one%held(one%row(k)) = .true.
         ! The wave that comes in doubles at a rigid wall: its force is twice its impedance.
         one%incoming(one%row(k)) = one%incoming(one%row(k)) + 2*one%value(k)*absorber%incoming(f)
      end do
   end subroutine prepare_one

   !> Impedances: those of the scene, or of the element that the edge belongs to, mean of its points.
   subroutine ground_behind(model, absorber, edge, state, ground, fault)
      type(model_t), intent(in) :: model
      type(absorber_t), intent(in) :: absorber
      integer, intent(in) :: edge(3)
      type(state_t), intent(in) :: state
      type(ground_t), intent(out) :: ground
      type(fault_t), intent(inout) :: fault
      real(wp) :: rho, c_p, c_s, modulus, shear, s, slope
      type(relative_t) :: rel
      logical :: with_pores, with_flow
      integer :: e, i

      ! The triangle on its left: of two that share it the other may be no ground.
      e = findloc([(any(model%domain%mesh%t6(4:6, i) == edge(3) .and. model%domain%mesh%t6(1:3, i) == edge(1)), &
                    i=1, size(model%domain%mesh%t6, 2))], .true., dim=1)
      call look_at_element(model, e, state, modulus, shear, s, slope, rho, fault)
      if (fault%code /= 0) return
      if (absorber%rho > 0.0_wp) rho = absorber%rho
      associate (region => model%domain%regions(model%domain%region_of(e)))
         with_pores = region%with_w .and. (region%drainage == COUPLED .or. region%drainage == UNDRAINED)
         with_flow = region%with_w .and. region%drainage == COUPLED
      end associate
      if (with_pores) modulus = modulus + pore_stiffness(model, e, state, s, slope)
      c_p = absorber%c_p
      c_s = absorber%c_s
      if ((.not. c_p > 0.0_wp .and. .not. modulus > 0.0_wp) .or. (.not. c_s > 0.0_wp .and. .not. shear > 0.0_wp)) then
         call raise(fault, EXIT_MATERIAL, place_of(absorber)//'element '//whole(e)//' at the boundary has no '// &
                    'stiffness in the initial state (shear modulus '//short(shear)//' kPa); give c_p and c_s.')
         return
      end if
      if (.not. c_p > 0.0_wp) c_p = sqrt(modulus/rho)
      if (.not. c_s > 0.0_wp) c_s = sqrt(shear/rho)
      ground%normal = rho*c_p
      ground%shear = rho*c_s
      if (.not. with_flow) return
      associate (law => model%domain%permeabilities(model%domain%regions(model%domain%region_of(e))%permeability), &
                 f => model%domain%fluids)
         rel = relative_permeability(law, s)
         ground%water = law%intrinsic*rel%w/(f%eta_w*c_p)
         if (model%domain%with_c) ground%air = law%intrinsic*rel%a/(f%eta_a*c_p)
      end associate
   end subroutine ground_behind

   !> Means over the points of an element: constrained and shear modulus of the skeleton for a small strain [kPa],
   !> saturation and its slope against suction, density.
   subroutine look_at_element(model, e, state, modulus, shear, s, slope, rho, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: e
      type(state_t), intent(in) :: state
      real(wp), intent(out) :: modulus, shear, s, slope, rho
      type(fault_t), intent(inout) :: fault
      type(response_t) :: response
      type(report_t) :: report
      real(wp) :: strain(6, model%domain%rule), suction(model%domain%rule), pressures(2), n
      real(wp), allocatable :: before(:, :), after(:, :)
      integer :: g, p, first, last

      associate (m => model%domain, region => model%domain%regions(model%domain%region_of(e)))
         first = (e - 1)*m%rule + 1
         last = e*m%rule
         strain = 0.0_wp
         do g = 1, m%rule
            pressures = pressures_at(m, e, g, state%x(AT_P_W:, m%carriers(:m%n_carriers(e), e)))
            suction(g) = pressures(2)
         end do
         before = reshape(state%state(m%before_state(e) + 1:m%before_state(e + 1)), [region%law%n_state, m%rule])
         after = before
         call region%law%update(m%rule, state%stress(:, first:last), before, strain, suction, &
                                0*suction, .true., response, after, report)
         if (report%code /= 0) then
            call raise(fault, EXIT_MATERIAL, 'The material of element '//whole(e)//' at an absorbing boundary '// &
                       'refuses the initial state.')
            modulus = 0.0_wp
            shear = 0.0_wp
            s = 1.0_wp
            slope = 0.0_wp
            rho = 0.0_wp
            return
         end if
         modulus = sum(response%dsig_deps(1, 1, :m%rule) + response%dsig_deps(2, 2, :m%rule))/(2*m%rule)
         shear = sum(response%dsig_deps(4, 4, :m%rule))/m%rule
         s = sum(state%s(first:last))/m%rule
         slope = 0.0_wp
         if (region%with_c) slope = sum(response%dsw_dpc(:m%rule))/m%rule
         rho = 0.0_wp
         do p = first, last
            n = state%e(p)/(1 + state%e(p))
            rho = rho + mixture_density(m, region, n, state%s(p))/m%rule
         end do
      end associate
   end subroutine look_at_element

   !> What fluids that cannot leave add to the constrained modulus [kPa].
   real(wp) function pore_stiffness(model, e, state, s, slope) result(stiffness)
      type(model_t), intent(in) :: model
      integer, intent(in) :: e
      type(state_t), intent(in) :: state
      real(wp), intent(in) :: s, slope   !< Saturation, its change with suction [1/kPa].
      real(wp) :: n, c(2, 2), room, det

      associate (m => model%domain, p => (e - 1)*model%domain%rule + 1, h => model%domain%fluids%henry)
         n = state%e(p)/(1 + state%e(p))
         room = 0.0_wp
         if (m%with_c) room = 1 - (1 - h)*s
         ! Sum of the balances, and air, against p_w and p_c: docs/theory/host.md sections 2.2 and 2.3.
         c(2, 1) = n*room/m%fluids%k_a
         c(1, 1) = n*s/m%fluids%k_w + c(2, 1)
         c(1, 2) = c(2, 1) + h*n*slope
         c(2, 2) = c(2, 1) - (1 - h)*n*slope
         stiffness = 1/c(1, 1)
         det = c(1, 1)*c(2, 2) - c(1, 2)*c(2, 1)
         if (m%with_c .and. c(2, 2) > 0.0_wp .and. det > 0.0_wp) &
            stiffness = ((c(2, 2) - (1 - s)*c(2, 1))*(1 + h*s) + ((1 - s)*c(1, 1) - c(1, 2))*room)/det
      end associate
   end function pore_stiffness

   !> Dashpots of an edge: integrals of N_i N_j with the impedances along its normal and tangent.
   subroutine add_edge(model, edge, ground, one)
      type(model_t), intent(in) :: model
      integer, intent(in) :: edge(3)
      type(ground_t), intent(in) :: ground
      type(dashpots_t), intent(inout) :: one
      type(edge_point_t) :: points(PER_EDGE)
      real(wp) :: normal(2), block(2, 2), c(2, 2, 3, 3), h(3, 3)
      integer :: g, i, j, a, b

      c = 0.0_wp
      h = 0.0_wp
      points = points_of_edge(model%domain, edge)
      do g = 1, PER_EDGE
         associate (n => points(g)%n, m => points(g)%m, tangent => points(g)%tangent, area => points(g)%area)
            normal = [tangent(2), -tangent(1)]/norm2(tangent)
            do b = 1, 2
               do a = 1, 2
                  block(a, b) = (ground%normal - ground%shear)*normal(a)*normal(b) + merge(ground%shear, 0.0_wp, a == b)
               end do
            end do
            do j = 1, 3
               do i = 1, 3
                  c(:, :, i, j) = c(:, :, i, j) + area*n(i)*n(j)*block
                  h(i, j) = h(i, j) + area*m(i)*m(j)
               end do
            end do
         end associate
      end do
      associate (of => model%dofs%of)
         do j = 1, 3
            do i = 1, 3
               do b = 1, 2
                  do a = 1, 2
                     call add(of(a, edge(i)), of(b, edge(j)), c(a, b, i, j))
                  end do
               end do
               call add(of(AT_P_W, edge(i)), of(AT_P_W, edge(j)), (ground%water + ground%air)*h(i, j))
               call add(of(AT_P_W, edge(i)), of(AT_P_C, edge(j)), ground%air*h(i, j))
               call add(of(AT_P_C, edge(i)), of(AT_P_W, edge(j)), ground%air*h(i, j))
               call add(of(AT_P_C, edge(i)), of(AT_P_C, edge(j)), ground%air*h(i, j))
            end do
         end do
      end associate
   contains
      subroutine add(row, column, value)
         integer, intent(in) :: row, column
         real(wp), intent(in) :: value

         if (row == 0 .or. column == 0 .or. .not. abs(value) > 0.0_wp) return
         one%row = [one%row, row]
         one%column = [one%column, column]
         one%value = [one%value, value]
      end subroutine add
   end subroutine add_edge

   !> Adds the forces of the waves that come in at a time. Lysmer & Kuhlemeyer (1969): docs/theory/host.md section 7.4.
   subroutine add_incoming(model, stage, list, time, load)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(dashpots_t), intent(in) :: list(:)   !< (absorbing boundaries)
      real(wp), intent(in) :: time   !< [s]
      real(wp), intent(inout) :: load(:)   !< (unknowns) [kN]
      integer :: i

      do i = 1, size(list)
         if (absorber_acts(model%absorbers(i), stage)) &
            load = load + factor_at(model, list(i)%amplitude, time)*list(i)%incoming
      end do
   end subroutine add_incoming

   !> Whether an absorbing boundary acts in a stage: in dynamic ones that its `stages` name (all if it names none).
   pure logical function absorber_acts(absorber, stage)
      type(absorber_t), intent(in) :: absorber
      type(stage_t), intent(in) :: stage

      absorber_acts = stage%kind == DYNAMIC .and. acts_in(absorber%stages, stage%name)
   end function absorber_acts

   !> Switches the dashpots of the boundaries that act in a stage on, the others off.
   subroutine switch_absorbers(model, stage, list)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(dashpots_t), intent(inout) :: list(:)   !< (absorbing boundaries)
      integer :: i

      do i = 1, size(list)
         list(i)%acts = absorber_acts(model%absorbers(i), stage)
      end do
   end subroutine switch_absorbers
end module absorbing_boundaries
