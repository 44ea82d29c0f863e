! SPDX-License-Identifier: MIT
!> Absorbing boundaries (Lysmer & Kuhlemeyer 1969), &absorbing: dashpots of the impedances rho c_p and rho c_s of the
!> ground behind the boundary, for pore pressures the outflow of a wave that goes on (its gradient is -1/c_p times its
!> rate), and the force of a wave that comes in. Without keys of their own the impedances are those of the elements at
!> the boundary where it begins to act, undrained. The forces that it held before stay, so that only what departs from
!> that state leaves as a wave. docs/theory/host.md section 7.4.
module absorbing
   use acting_places, only: facing_edges, acting_stages, are_in, given_in, share_an_edge
   use archive, only: archive_t
   use boundary_conditions, only: prescribing_fixes
   use equation_assembly, only: assemble
   use exit_codes, only: EXIT_GROUP, EXIT_MATERIAL
   use faults, only: fault_t, raise, EXIT_INPUT
   use generalised_alpha, only: make_scheme, STATIC
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use material_point, only: material_t, response_t, batch_report_t
   use model_types, only: model_t, problem_t, action_t, factor_at
   use name_search, only: mesh_group, history_named, read_stages
   use permeability_laws, only: relative_t, relative_permeability
   use porous_domain, only: domain_t, edge_point_t, copy_state, mixture_density, points_of_edge, pressures_at, law_of, &
                            PER_EDGE, COUPLED, UNDRAINED
   use prescribed_values, only: linear_forces_t
   use scene_parts, only: place_of
   use scene_term, only: scene_term_t
   use scene_types, only: item_of
   use texts, only: short, whole, LENGTH
   use triangle_mesh, only: triangles_beside
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   use warnings, only: print_warning
   implicit none (type, external)
   private
   public :: absorbing_t

   character(*), parameter :: NAME = 'absorbing'
   real(wp), parameter :: LEAST = 1/UNBOUNDED

   !> A boundary through which waves leave, and may come in.
   type, extends(action_t) :: side_t
      real(wp) :: rho = 0.0_wp, c_p = 0.0_wp, c_s = 0.0_wp   !< Of the ground behind; 0: those of the soil.
      real(wp) :: velocity(2) = 0.0_wp           !< Of the incoming wave at a factor of 1 [m/s].
      logical :: repeats = .false.               !< An earlier one has its dashpots: it brings another wave alone.
      integer :: dashpots = 0                    !< Place of its dashpots in the constraint.
      integer, allocatable :: edges(:, :)        !< (3, edges) Nodes.
      integer, allocatable :: elements(:)        !< (edges) Those on their left: what lies right may be no ground.
      !> Of the ground behind the edges, 0 before the boundary has acted: impedances rho c_p, rho c_s [kPa s/m], outflow
      !> of water and air over the rate of the pressure, k/(eta c_p) [m/kPa]. (4, edges)
      real(wp), allocatable :: behind(:, :)
      logical, allocatable :: held(:)            !< (unknowns) Displacements of the boundary.
      real(wp), allocatable :: carried(:)        !< (unknowns) Force that it holds [kN]; 0 where it does not act.
      real(wp), allocatable :: incoming(:)       !< (unknowns) Force of the incoming wave [kN] at a factor of 1.
   end type side_t

   type, extends(scene_term_t) :: absorbing_t
      type(side_t), allocatable :: sides(:)
      logical :: at_start = .false.              !< Of a stage: what the sides held is not known yet.
   contains
      procedure :: build_group, build, begin_run, begin_stage, before_step, exchange
   end type absorbing_t

   integer, parameter :: AT_NORMAL = 1, AT_SHEAR = 2, AT_WATER = 3, AT_AIR = 4   !< Places in `behind`.
contains
   !> A boundary. Fault EXIT_GROUP: a boundary or history that is not defined, or a group without edges.
   subroutine build_group(self, k, number, model, fault)
      class(absorbing_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(side_t) :: side
      character(LENGTH) :: boundary, history

      boundary = ''
      history = ''
      call k%text('group', boundary, 'boundary that lets waves out, in dynamic stages', REQUIRED)
      call k%number('rho', side%rho, LEAST, 1000.0_wp, &
                    'density of the ground behind the boundary [Mg/m3]; default: the soil')
      call k%number('c_p', side%c_p, LEAST, UNBOUNDED, &
                    'speed of pressure waves behind the boundary [m/s]; default: the soil''s')
      call k%number('c_s', side%c_s, LEAST, UNBOUNDED, &
                    'speed of shear waves behind the boundary [m/s]; default: the soil''s')
      call k%number('v_r', side%velocity(1), -UNBOUNDED, UNBOUNDED, 'velocity along r of the incoming wave [m/s]')
      call k%number('v_z', side%velocity(2), -UNBOUNDED, UNBOUNDED, 'velocity along z of the incoming wave [m/s]')
      call k%text('history', history, 'factor on v_r and v_z', '+v_r|v_z', refers='history')
      call read_stages(k, model, side%in_stage)
      if (k%lists) return
      side%scene_item_t = item_of(k%group)
      ! Poisson's ratio is -1 at least: c_p**2 is 4/3 of c_s**2 or more.
      if (k%given('c_p') .and. 3*side%c_p**2 < 4*side%c_s**2) call print_warning(place_of(side)//'c_p = '// &
         short(side%c_p)//' m/s beside c_s = '//short(side%c_s)//' m/s: in no solid are waves of pressure so slow; '// &
         'are the two keys exchanged?')
      side%what = '&'//NAME
      side%along_normal = .true.
      side%bears = .true.
      side%damps = .true.
      side%group = mesh_group(model%domain%mesh, boundary, place_of(side), fault)
      if (fault%code == 0) side%amplitude = history_named(history, model%amplitudes%name, place_of(side), fault)
      if (fault%code /= 0) return
      if (size(model%domain%mesh%groups(side%group)%edges, 2) == 0) call raise(fault, EXIT_GROUP, place_of(side)// &
         'group '''//trim(boundary)//''' has no edges that waves could leave through.')
      side%edges = facing_edges(model, side%group, acting_stages(model, side%action_t))
      associate (beside => triangles_beside(model%domain%mesh%t6, side%edges))
         side%elements = beside(1, :)
      end associate
      allocate (side%behind(4, size(side%edges, 2)), source=0.0_wp)
      model%actions = [model%actions, side%action_t]
      if (.not. allocated(self%sides)) allocate (self%sides(0))
      self%sides = [self%sides, side]
      self%wanted = .true.
   end subroutine build_group

   !> Finds boundaries that bring another wave through the dashpots of an earlier one. Fault EXIT_INPUT: two that share
   !> edges are not alike. Warns of motions that a &fix prescribes, so that waves neither leave nor come in.
   subroutine build(self, model, fault)
      class(absorbing_t), intent(inout) :: self
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i, k

      if (.not. self%wanted) return
      do i = 1, size(self%sides)
         do k = 1, i - 1
            if (.not. any(acting_stages(model, self%sides(i)%action_t) .and. &
                          acting_stages(model, self%sides(k)%action_t))) cycle
            if (.not. share_an_edge(model, self%sides(i)%group, self%sides(k)%group)) cycle
            self%sides(i)%repeats = are_alike(self%sides(i), self%sides(k))
            if (self%sides(i)%repeats) cycle
            call raise(fault, EXIT_INPUT, place_of(self%sides(i))//'this &absorbing has edges of that of line '// &
                       whole(self%sides(k)%line)//', and their dashpots would count twice there. Another wave '// &
                       'through the same ones needs the same group, stages, rho, c_p and c_s (a &history ends it); '// &
                       'else give every edge to one.')
            return
         end do
         call look_at_supports(model, self%sides(i))
      end do
   contains
      pure logical function are_alike(a, b)
         type(side_t), intent(in) :: a, b
         integer :: s

         are_alike = a%group == b%group .and. &
                     maxval(abs([a%rho - b%rho, a%c_p - b%c_p, a%c_s - b%c_s])) <= 0.0_wp .and. &
                     all([(acts(a, model, s) .eqv. acts(b, model, s), s=1, size(model%stages))])
      end function are_alike
   end subroutine build

   !> Warns of a boundary whose motion along its normal is prescribed, and that brings no wave along the other axis; or
   !> along whose wave the motion is.
   subroutine look_at_supports(model, side)
      type(model_t), intent(in) :: model
      type(side_t), intent(in) :: side
      logical, allocatable :: held(:, :)
      character(*), parameter :: WORDS(DISPLACEMENTS) = ['u_r', 'u_z']
      real(wp) :: extent(DISPLACEMENTS)
      integer :: s, f

      associate (nodes => model%domain%mesh%groups(side%group)%nodes, x => model%domain%mesh%x, &
                 t6 => model%domain%mesh%t6)
         extent = [(maxval(x(f, nodes)) - minval(x(f, nodes)), f=1, DISPLACEMENTS)]
         do s = 1, size(model%stages)
            if (.not. acts(side, model, s)) cycle
            held = given_in(model, s, throughout=.true.)
            do f = 1, DISPLACEMENTS
               ! Ground that is held throughout has no motion along this axis.
               if (.not. all(held(f, nodes)) .or. all(held(f, [t6]))) cycle
               if (.not. abs(side%velocity(f)) > 0.0_wp .and. &
                   (extent(f) > extent(3 - f) .or. abs(side%velocity(3 - f)) > 0.0_wp)) cycle
               call print_warning(place_of(side)//WORDS(f)//' of every node of this &absorbing is prescribed by a '// &
                  '&fix in stage '//trim(model%stages(s)%name)//': along '//WORDS(f)(3:)//' no wave leaves there '// &
                  'or comes in. Limit the &fix to other stages.')
               return
            end do
         end do
      end associate
   end subroutine look_at_supports

   !> Makes room for the dashpots of the boundaries, and the unknowns that they hold.
   subroutine begin_run(self, problem, fault)
      class(absorbing_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      type(linear_forces_t) :: none
      integer :: i

      if (fault%code /= 0) return
      allocate (none%row(0), none%column(0), none%value(0))
      do i = 1, size(self%sides)
         associate (side => self%sides(i))
            problem%constraint%linear = [problem%constraint%linear, none]
            side%dashpots = size(problem%constraint%linear)
            allocate (side%held(problem%dofs%n), source=.false.)
            allocate (side%incoming(problem%dofs%n), side%carried(problem%dofs%n), source=0.0_wp)
            if (side%repeats) cycle
            associate (unknowns => problem%dofs%of(:DISPLACEMENTS, [side%edges]))
               side%held(pack(unknowns, unknowns > 0)) = .true.
            end associate
         end associate
      end do
   end subroutine begin_run

   !> Makes dashpots of a boundary from the ground behind it. docs/theory/host.md section 7.4.
   subroutine make_dashpots(model, side, dashpots)
      type(model_t), intent(in) :: model
      type(side_t), intent(inout) :: side
      type(linear_forces_t), intent(inout) :: dashpots
      integer :: e, k, f

      deallocate (dashpots%row, dashpots%column, dashpots%value)
      allocate (dashpots%row(0), dashpots%column(0), dashpots%value(0))
      do e = 1, size(side%edges, 2)
         call add_edge(model, side%edges(:, e), side%behind(:, e), dashpots)
      end do
      side%incoming = 0.0_wp
      do k = 1, size(dashpots%row)
         f = model%dofs%field(dashpots%column(k))
         ! The wave that comes in doubles at a rigid wall: its force is twice its impedance.
         if (f <= DISPLACEMENTS) side%incoming(dashpots%row(k)) = side%incoming(dashpots%row(k)) &
                                                                  + 2*dashpots%value(k)*side%velocity(f)
      end do
   end subroutine make_dashpots

   !> Finds the impedances: those of the scene, or of the element that the edge belongs to, mean of its points. Fault
   !> EXIT_MATERIAL: the ground has no stiffness, or its material refuses its own state.
   subroutine ground_behind(problem, side, e, ground, fault)
      type(problem_t), intent(in), target :: problem
      type(side_t), intent(in) :: side
      integer, intent(in) :: e   !< The element.
      real(wp), intent(out) :: ground(4)
      type(fault_t), intent(inout) :: fault
      class(material_t), pointer :: law
      type(response_t) :: response
      type(batch_report_t) :: report
      type(relative_t) :: rel
      real(wp), dimension(problem%domain%rule) :: suction, s, n
      real(wp) :: strain(6, problem%domain%rule), p(2), p_a, rho, c_p, c_s, modulus, shear, slope
      real(wp), allocatable :: before(:, :), after(:, :)
      integer :: g, first, last

      ground = 0.0_wp
      associate (m => problem%domain, state => problem%state, region => &
                 problem%domain%regions(problem%domain%region_of(e)))
         first = (e - 1)*m%rule + 1
         last = e*m%rule
         law => law_of(m, problem%next, m%region_of(e))
         strain = 0.0_wp
         p_a = 0.0_wp
         do g = 1, m%rule
            p = pressures_at(m, e, g, state%x(AT_P_W:, m%carriers(:m%n_carriers(e), e)))
            suction(g) = p(2)
            p_a = p_a + sum(p)/m%rule
         end do
         before = reshape(state%state(m%before_state(e) + 1:m%before_state(e + 1)), [law%n_state, m%rule])
         after = before
         call law%update(m%rule, state%stress(:, first:last), before, strain, suction, 0*suction, .true., response, &
                         after, report)
         if (report%code /= 0) then
            call raise(fault, EXIT_MATERIAL, 'The material of element '//whole(e)//' at an absorbing boundary '// &
                       'refuses its own state.')
            return
         end if
         s = state%s(first:last)
         n = state%e(first:last)/(1 + state%e(first:last))
         rho = sum([(mixture_density(m, region, n(g), s(g))/m%rule, g=1, m%rule)])
         if (side%rho > 0.0_wp) rho = side%rho
         modulus = sum(response%dsig_deps(1, 1, :m%rule) + response%dsig_deps(2, 2, :m%rule))/(2*m%rule)
         shear = sum(response%dsig_deps(4, 4, :m%rule))/m%rule
         slope = 0.0_wp
         if (region%with_c) slope = sum(response%dsw_dpc(:m%rule))/m%rule
         if (region%with_w .and. (region%drainage == COUPLED .or. region%drainage == UNDRAINED)) modulus = modulus &
            + pore_stiffness(m, n(1), sum(s)/m%rule, slope, p_a)
         c_p = side%c_p
         c_s = side%c_s
         if (.not. (max(c_p, modulus) > 0.0_wp .and. max(c_s, shear) > 0.0_wp)) then
            call raise(fault, EXIT_MATERIAL, place_of(side)//'element '//whole(e)//' at the boundary has no '// &
                       'stiffness where it begins to act (shear modulus '//short(shear)//' kPa); give c_p and c_s.')
            return
         end if
         if (.not. c_p > 0.0_wp) c_p = sqrt(modulus/rho)
         if (.not. c_s > 0.0_wp) c_s = sqrt(shear/rho)
         ground(AT_NORMAL) = rho*c_p
         ground(AT_SHEAR) = rho*c_s
         if (.not. region%with_w .or. region%drainage /= COUPLED) return
         associate (permeability => m%permeabilities(region%permeability))
            rel = relative_permeability(permeability, sum(s)/m%rule)
            ground(AT_WATER) = permeability%intrinsic*rel%w/(m%fluids%eta_w*c_p)
            if (m%with_c) ground(AT_AIR) = permeability%intrinsic*rel%a/(m%fluids%eta_a*c_p)
         end associate
      end associate
   end subroutine ground_behind

   !> Finds what fluids that cannot leave add to the constrained modulus [kPa].
   pure real(wp) function pore_stiffness(domain, n, s, slope, p_a) result(stiffness)
      type(domain_t), intent(in) :: domain
      real(wp), intent(in) :: n, s, slope   !< Porosity, saturation, its change with suction [1/kPa].
      real(wp), intent(in) :: p_a           !< Air pressure [kPa].
      real(wp) :: c(2, 2), room, det, k_a

      associate (fluids => domain%fluids, h => domain%fluids%henry)
         room = 0.0_wp
         if (domain%with_c) room = 1 - (1 - h)*s
         k_a = fluids%k_a
         if (fluids%ideal_gas) k_a = fluids%p_ref + p_a
         ! Sum of the balances, and air, against p_w and p_c: docs/theory/host.md sections 2.2 and 2.3.
         c(2, 1) = n*room/k_a
         c(1, 1) = n*s/fluids%k_w + c(2, 1)
         stiffness = 1/c(1, 1)
         if (.not. domain%with_c) return
         c(1, 2) = c(2, 1) + h*n*slope
         c(2, 2) = c(2, 1) - (1 - h)*n*slope
         det = c(1, 1)*c(2, 2) - c(1, 2)*c(2, 1)
         if (c(2, 2) > 0.0_wp .and. det > 0.0_wp) &
            stiffness = ((c(2, 2) - (1 - s)*c(2, 1))*(1 + h*s) + ((1 - s)*c(1, 1) - c(1, 2))*room)/det
      end associate
   end function pore_stiffness

   !> Adds the dashpots of an edge: integrals of N_i N_j with the impedances along its normal and tangent.
   subroutine add_edge(model, edge, ground, one)
      type(model_t), intent(in) :: model
      integer, intent(in) :: edge(3)
      real(wp), intent(in) :: ground(4)   !< As `behind`.
      type(linear_forces_t), intent(inout) :: one
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
                  block(a, b) = (ground(AT_NORMAL) - ground(AT_SHEAR))*normal(a)*normal(b) &
                                + merge(ground(AT_SHEAR), 0.0_wp, a == b)
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
               call add(of(AT_P_W, edge(i)), of(AT_P_W, edge(j)), (ground(AT_WATER) + ground(AT_AIR))*h(i, j))
               call add(of(AT_P_W, edge(i)), of(AT_P_C, edge(j)), ground(AT_AIR)*h(i, j))
               call add(of(AT_P_C, edge(i)), of(AT_P_W, edge(j)), ground(AT_AIR)*h(i, j))
               call add(of(AT_P_C, edge(i)), of(AT_P_C, edge(j)), ground(AT_AIR)*h(i, j))
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

   !> Dashpots of what has acted, also before a restart. What a side held that acts no longer is freed.
   subroutine begin_stage(self, begins, problem, fault)
      class(absorbing_t), intent(inout) :: self
      logical, intent(in) :: begins
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (fault%code /= 0) return
      do i = 1, size(self%sides)
         call make_dashpots(problem%model, self%sides(i), problem%constraint%linear(self%sides(i)%dashpots))
      end do
      self%at_start = begins
      if (.not. begins) return
      do i = 1, size(self%sides)
         associate (side => self%sides(i))
            if (acts(side, problem%model, problem%at%stage)) cycle
            problem%constraint%offset = problem%constraint%offset - side%carried
            side%carried = 0.0_wp
         end associate
      end do
   end subroutine begin_stage

   !> Sets which sides act, and the forces of the waves that come in. Where a stage begins those that have not acted
   !> before hold what the ground behind them has held so far.
   subroutine before_step(self, dt, problem, fault)
      class(absorbing_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (self%at_start) call hold_ground(self, dt, problem, fault)
      self%at_start = .false.
      associate (c => problem%constraint, now => problem%state%time)
         do i = 1, size(self%sides)
            associate (side => self%sides(i))
               c%linear(side%dashpots)%acts = acts(side, problem%model, problem%at%stage) .and. .not. side%repeats
               if (.not. acts(side, problem%model, problem%at%stage)) cycle
               c%load_0 = c%load_0 + factor_at(problem%model, side%amplitude, now)*side%incoming
               c%load_1 = c%load_1 + factor_at(problem%model, side%amplitude, now + dt)*side%incoming
            end associate
         end do
      end associate
   end subroutine before_step

   !> Whether a side acts in a stage; before the first one it does not.
   pure logical function acts(side, model, number)
      type(side_t), intent(in) :: side
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical :: acting(size(model%stages))

      acts = .false.
      acting = acting_stages(model, side%action_t)
      if (number > 0) acts = acting(number)
   end function acts

   !> Sets the dashpots of sides that act in a stage and did not in the one before, and the forces on them.
   !> docs/theory/host.md section 7.4. Fault EXIT_MATERIAL: the ground has no stiffness, or its material refuses its own
   !> state at rest.
   subroutine hold_ground(self, dt, problem, fault)
      class(absorbing_t), intent(inout) :: self
      real(wp), intent(in) :: dt   !< Of the first step.
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      logical :: begin_to_act(size(self%sides))
      integer :: i, e

      associate (number => problem%at%stage)
         begin_to_act = [(acts(self%sides(i), problem%model, number) .and. &
                          .not. acts(self%sides(i), problem%model, number - 1), i=1, size(begin_to_act))]
         if (.not. any(begin_to_act)) return
         do i = 1, size(self%sides)
            if (.not. begin_to_act(i)) cycle
            associate (side => self%sides(i))
               do e = 1, size(side%edges, 2)
                  call ground_behind(problem, side, side%elements(e), side%behind(:, e), fault)
                  if (fault%code /= 0) return
               end do
               call make_dashpots(problem%model, side, problem%constraint%linear(side%dashpots))
            end associate
         end do
         call copy_state(problem%state, problem%next)
         problem%next%v = 0.0_wp
         problem%next%a = 0.0_wp
         problem%assembly%air = .false.
         call assemble(problem%domain, problem%dofs, problem%pattern, make_scheme(STATIC, 1.0_wp, 1.0_wp), &
                       problem%state, problem%next, .false., problem%assembly)
         if (problem%assembly%bad_element > 0) then
            call raise(fault, EXIT_MATERIAL, 'Stage '//trim(problem%stage%name)//': the material of element '// &
                       whole(problem%assembly%bad_element)//' refuses its own state at rest.')
            return
         end if
      end associate
      call share_forces(self%sides, begin_to_act .and. .not. self%sides%repeats, dt, problem)
      call copy_state(problem%state, problem%next)
   end subroutine hold_ground

   !> What the balance at rest lacks is held by the sides that begin. Where two of them meet each has the tractions on
   !> its own edges, so that it can end alone, and a share of what these leave in proportion to them; at the corner with
   !> a &fix of other ground it has these alone.
   subroutine share_forces(sides, begin_to_act, dt, problem)
      type(side_t), intent(inout) :: sides(:)
      logical, intent(in) :: begin_to_act(:)      !< Those whose dashpots do.
      real(wp), intent(in) :: dt                  !< Of the first step.
      type(problem_t), intent(inout) :: problem   !< After the assembly at rest.
      real(wp), dimension(problem%dofs%n) :: missing, left, weight, share
      logical :: elsewhere_held(problem%dofs%n)
      integer :: holders(problem%dofs%n), by(problem%dofs%n), air_by(size(problem%domain%mesh%x, 2)), i, f

      call prescribing_fixes(problem, problem%state%time + dt, by, air_by)
      elsewhere_held = by > 0
      do i = 1, size(sides)
         if (.not. begin_to_act(i)) cycle
         do f = 1, size(problem%model%fixes)
            associate (in_fix => are_in(problem%model, problem%model%fixes(f)%group))
               if (.not. all(in_fix(problem%domain%mesh%groups(sides(i)%group)%nodes))) cycle
            end associate
            where (sides(i)%held .and. by == f) elsewhere_held = .false.   ! the &fix holds the whole side
         end do
      end do
      associate (c => problem%constraint)
         missing = c%load_0 - problem%assembly%residual - c%offset
         holders = 0
         left = missing
         weight = 0.0_wp
         do i = 1, size(sides)
            if (.not. begin_to_act(i)) cycle
            sides(i)%carried = tractions(problem, sides(i))
            where (sides(i)%held) holders = holders + 1
            left = left - sides(i)%carried
            weight = weight + abs(sides(i)%carried)
         end do
         where (elsewhere_held) left = 0.0_wp
         do i = 1, size(sides)
            if (.not. begin_to_act(i)) cycle
            associate (side => sides(i))
               share = 1.0_wp/max(holders, 1)
               where (weight > 0.0_wp) share = abs(side%carried)/weight
               where (.not. side%held)
                  side%carried = 0.0_wp
               elsewhere (holders == 1 .and. .not. elsewhere_held)
                  side%carried = missing
               elsewhere
                  side%carried = side%carried + share*left
               end where
               c%offset = c%offset + side%carried
            end associate
         end do
      end associate
   end subroutine share_forces

   !> Sums the forces of the total stress of the elements behind a side, mean of their points, on its edges [kN].
   !> (unknowns)
   function tractions(problem, side) result(force)
      type(problem_t), intent(in) :: problem
      type(side_t), intent(in) :: side
      real(wp) :: force(problem%dofs%n)
      type(edge_point_t) :: points(PER_EDGE)
      real(wp) :: stress(3), p(2), traction(2)   !< rr, zz, rz [kPa]; p_w, p_c [kPa]; [kPa m]
      integer :: k, e, g, i, f, unknown

      force = 0.0_wp
      associate (m => problem%domain, state => problem%state)
         do k = 1, size(side%edges, 2)
            e = side%elements(k)
            stress = 0.0_wp
            do g = 1, m%rule
               p = pressures_at(m, e, g, state%x(AT_P_W:, m%carriers(:m%n_carriers(e), e)))
               associate (point => (e - 1)*m%rule + g)
                  stress = stress + state%stress([1, 2, 4], point)/m%rule
                  stress(:2) = stress(:2) - (p(1) + (1 - state%s(point))*p(2))/m%rule
               end associate
            end do
            points = points_of_edge(m, side%edges(:, k))
            do g = 1, PER_EDGE
               associate (t => points(g)%tangent)
                  traction = [stress(1)*t(2) - stress(3)*t(1), stress(3)*t(2) - stress(2)*t(1)]
               end associate
               do i = 1, size(points(g)%n)
                  do f = 1, DISPLACEMENTS
                     unknown = problem%dofs%of(f, side%edges(i, k))
                     ! The residual holds against the traction.
                     if (unknown > 0) force(unknown) = force(unknown) - points(g)%ring*points(g)%n(i)*traction(f)
                  end do
               end do
            end do
         end do
      end associate
   end function tractions

   subroutine exchange(self, problem, archive)
      class(absorbing_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      class(archive_t), intent(inout) :: archive
      integer :: i

      call archive%exchange('offset', problem%constraint%offset, 'kN, m3/s', &
                            'flow that is subtracted, forces that hold the ground')
      do i = 1, size(self%sides)
         call archive%exchange('carried_'//whole(i), self%sides(i)%carried, 'kN', &
                               'force that an absorbing boundary holds')
         call archive%exchange('behind_'//whole(i), self%sides(i)%behind, 'kPa s/m, m/kPa', &
                               'impedances of the ground behind an absorbing boundary, outflow over rate of pressure')
      end do
   end subroutine exchange
end module absorbing
