! SPDX-License-Identifier: MIT
!> The discrete problem: mesh, geometry at the quadrature points, laws of every region, and what a state consists of.
module porous_domain
   use archive, only: archive_t
   use exit_codes, only: EXIT_ELEMENT
   use unknown_fields, only: FIELDS
   use kinds, only: wp, PI
   use shape_functions, only: quadratic, linear, edge_quadratic, triangle_rule, edge_rule
   use material_point, only: material_t, material_slot_t
   use permeability_laws, only: permeability_t
   use triangle_mesh, only: mesh_t
   use faults, only: fault_t, raise
   use texts, only: place_text, short, whole
   implicit none (type, external)
   private
   public :: domain_t, region_t, gauss_t, model_state_t, prepare_domain, new_state_of, copy_state, mixture_density, &
             given_pressures_at, pressures_at, is_present, gravity_on, strain_of, keep_element_state, exchange_state, &
             law_of, means_t, means_over
   public :: edge_point_t, points_of_edge, PER_EDGE
   public :: COUPLED, DRAINED, UNDRAINED, DRY, OUTFLOWS

   integer, parameter :: OUTFLOWS = 2    !< Flows out of the ground: of both fluids, of air.
   ! What the fluids in the pores of a region do, in the order of the words of &region drainage.
   integer, parameter :: COUPLED = 1     !< Pressures are unknowns of the nodes, fluids flow.
   integer, parameter :: DRAINED = 2     !< Pressures stay as they are given at the start.
   integer, parameter :: UNDRAINED = 3   !< Every element keeps its fluids and has one p_w and one p_c.
   integer, parameter :: DRY = 4         !< There are no fluids.

   !> Pore fluids.
   type :: fluids_t
      real(wp) :: k_w = 2.2e6_wp, rho_w = 1.0_wp, eta_w = 1.0e-6_wp        !< [kPa, Mg/m3, kPa s]
      real(wp) :: k_a = 101.325_wp, rho_a = 1.2e-3_wp, eta_a = 1.8e-8_wp   !< Properties of air [kPa, Mg/m3, kPa s]
      logical :: ideal_gas = .false.    !< K_a = absolute pressure, rho_a in proportion to it.
      real(wp) :: p_ref = 101.325_wp    !< Absolute pressure where p_a = 0 [kPa].
      real(wp) :: henry = 0.0_wp        !< Volume of air that a volume of water dissolves, at its pressure [-].
   contains
      procedure :: air_density
   end type fluids_t

   !> Material, fluids and damping of a region.
   type :: region_t
      class(material_t), allocatable :: law   !< Skeleton and retention: stress, void ratio, degree of saturation.
      real(wp) :: stress_tolerance = 0.0_wp   !< Tolerance of its stress integration as the scene has it [-].
      integer :: permeability = 0       !< Place in the list, 0: none.
      real(wp) :: rho_s = 0.0_wp        !< Density of the grains [Mg/m3]
      real(wp) :: void_ratio = 0.0_wp   !< Initially [-].
      real(wp) :: damping = 0.0_wp      !< Force against the velocity over mass, in dynamic stages [1/s].
      real(wp) :: stiffness_damping = 0.0_wp  !< Stress of the skeleton over its rate, in dynamic stages [s].
      !> Stress beside the skeleton over the rate of strain, in stages with time [kPa s]; not allocated: none. (4, 4)
      real(wp), allocatable :: against_rate(:, :)
      integer :: drainage = COUPLED
      logical :: with_w = .false., with_c = .false.   !< Whether its pores hold water, and air at another pressure.
   end type region_t

   !> Geometry at a quadrature point. Pressures use the first n_p of the shape functions m; where nodes carry any, the
   !> others are 0. Nodes side by side, so that the compiler takes several at once.
   type :: gauss_t
      real(wp) :: x(2)
      real(wp) :: weight            !< Volume: 2 pi r dA, or dA [m3]
      real(wp) :: n(6), dn(6, 2)    !< Shape functions of the displacements.
      real(wp) :: m(6), dm(6, 2)    !< Shape functions of the pressures.
      real(wp) :: n_over_r(6)       !< Hoop strain; 0 in plane strain.
   end type gauss_t

   integer, parameter :: PER_EDGE = 3   !< Integration points of an edge.

   !> Geometry at an integration point of an edge of the mesh, for everything that acts on a boundary.
   type :: edge_point_t
      real(wp) :: n(3) = 0.0_wp, m(3) = 0.0_wp   !< Shape functions of displacements and of pressures [-].
      real(wp) :: x(2) = 0.0_wp                  !< Place [m].
      real(wp) :: tangent(2) = 0.0_wp            !< dx/ds; turned right it is the outward normal times its length [m].
      real(wp) :: ring = 0.0_wp                  !< Weight of the rule, times 2 pi r in axisymmetry [- or m].
      real(wp) :: area = 0.0_wp                  !< ring |tangent| [m or m2]
   end type edge_point_t

   abstract interface
      !> Body force [kN/m3] in the momentum balance, and volume supplied in the sum of the balances and in that of the
      !> air [1/s], at a place and time: for manufactured solutions.
      pure function source_i(x, t) result(value)
         import :: wp
         real(wp), intent(in) :: x(2), t   !< [m], [s]
         real(wp) :: value(4)   !< Force r, z; sum of the balances; air.
      end function source_i
   end interface

   type :: domain_t
      type(mesh_t) :: mesh
      logical :: axisymmetric = .true.
      logical :: with_w = .false., with_c = .false.   !< Fields besides the displacements.
      integer :: n_p = 6                              !< Pressure nodes of an element: 6, or 3 (Taylor-Hood).
      integer :: rule = 6                             !< Quadrature points of an element.
      real(wp) :: gravity = 0.0_wp                    !< Towards -z, where its history is 1 [m/s2].
      logical :: seepage_inertia = .false.
      logical :: full_rate = .true.                   !< dS_w/de takes part in the rate of saturation.
      type(fluids_t) :: fluids
      type(permeability_t), allocatable :: permeabilities(:)
      type(region_t), allocatable :: regions(:)
      integer, allocatable :: region_of(:)            !< Regions of the elements.
      ! Where the pressures of an element are: the first n_carriers of its carriers, with the shape functions m.
      integer, allocatable :: n_carriers(:)           !< n_p where coupled with water, 1 where undrained, else 0.
      integer, allocatable :: carriers(:, :)          !< (6, elements) Nodes.
      integer, allocatable :: center(:)               !< Node of an undrained element, in no other; else 0.
      real(wp), allocatable :: given(:, :, :)         !< (2, nodes, DRAINED:UNDRAINED) p_w, p_c at the start in ground
                                                      !< of these kinds; of centers the mean over the element.
      integer, allocatable :: before_state(:)         !< (elements + 1) State variables before those of an element.
      type(gauss_t), allocatable :: gauss(:, :)       !< (rule, elements)
      integer :: threads = 1
      integer, allocatable :: bodies(:)               !< Nodes of rigid plates: the last ones, in no element, with u_z.
      integer, allocatable :: bodies_along_r(:)       !< Nodes of rigid plates that have u_r as well.
      procedure(source_i), pointer, nopass :: source => null()
   end type domain_t

   !> Everything that one time step carries to the next.
   type :: model_state_t
      real(wp) :: time = 0.0_wp
      real(wp) :: gravity = 0.0_wp            !< At this time, towards -z [m/s2].
      real(wp), allocatable :: x(:, :)        !< (FIELDS, nodes) unknowns
      real(wp), allocatable :: v(:, :)        !< rates of the unknowns
      real(wp), allocatable :: a(:, :)        !< (2, nodes) accelerations
      real(wp), allocatable :: stress(:, :)   !< (6, points) effective, tension positive [kPa]
      real(wp), allocatable :: state(:)       !< State variables, element by element, see before_state.
      real(wp), allocatable :: e(:)           !< void ratio
      real(wp), allocatable :: s(:)           !< degree of saturation
      real(wp), allocatable :: s_rate(:)      !< rate of the degree of saturation [1/s]
      !> Flows out through prescribed pressures and seepage faces, less the rain: both fluids, air [m3/s]. They
      !> follow the scheme as the storage of points does.
      real(wp) :: outflow(OUTFLOWS) = 0.0_wp
      ! Where parts of the ground join or leave, else not allocated. docs/theory/host.md section 14.
      logical, allocatable :: present(:)      !< Parts of the ground in this stage. (elements)
      logical, allocatable :: joins(:)        !< Parts that join with this stage. (elements)
      real(wp) :: growth = 1.0_wp             !< Share of their weight that acts on those that join, at this time [-].
      !> Laws of the regions in the step that ends with this state, where laws change with time, else not
      !> allocated: made for every step, docs/theory/host.md section 15. (regions)
      type(material_slot_t), allocatable :: laws(:)
   end type model_state_t

   !> A quadrature point over a step, means of both ends: the works and flows of the step are those of means.
   type :: means_t
      real(wp) :: stress(4)   !< Effective stress rr, zz, tt, rz, tension positive [kPa].
      real(wp) :: n, s        !< Porosity, degree of saturation [-].
   end type means_t
contains
   !> Finds the density of air at a pressure [Mg/m3].
   pure real(wp) function air_density(self, p_a) result(rho)
      class(fluids_t), intent(in) :: self
      real(wp), intent(in) :: p_a   !< [kPa]

      rho = self%rho_a
      if (self%ideal_gas) rho = rho*(1 + p_a/self%p_ref)
   end function air_density

   !> Computes the geometry of every quadrature point; the regions must be known. docs/theory/host.md section 3.1. Fault
   !> EXIT_ELEMENT: an element is inverted, or an axisymmetric mesh has a point at r <= 0.
   subroutine prepare_domain(domain, fault)
      type(domain_t), intent(inout) :: domain
      type(fault_t), intent(inout) :: fault
      real(wp) :: points(2, domain%rule), weights(domain%rule), jacobian(2, 2), inverse(2, 2), det, x(2, 6), d(2, 6)
      real(wp) :: n3(3), d3(2, 3)
      integer :: e, g

      call place_pressures(domain)
      call triangle_rule(domain%rule, points, weights)
      allocate (domain%gauss(domain%rule, size(domain%mesh%t6, 2)))
      do e = 1, size(domain%mesh%t6, 2)
         x = domain%mesh%x(:, domain%mesh%t6(:, e))
         do g = 1, domain%rule
            associate (point => domain%gauss(g, e))
               call quadratic(points(1, g), points(2, g), point%n, d)
               jacobian = matmul(d, transpose(x))
               det = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
               if (.not. det > 0.0_wp) then
                  call raise(fault, EXIT_ELEMENT, 'Element '//whole(e)//' near '//place_text(sum(x, dim=2)/6)// &
                             ' is inverted: its Jacobian is '//short(det)// &
                             '; move its mid-side nodes or number its corners counter-clockwise.')
                  return
               end if
               inverse = reshape([jacobian(2, 2), -jacobian(2, 1), -jacobian(1, 2), jacobian(1, 1)], [2, 2])/det
               point%dn = transpose(matmul(inverse, d))
               point%x = matmul(x, point%n)
               point%weight = weights(g)*det
               point%n_over_r = 0.0_wp
               if (domain%axisymmetric) then
                  if (.not. point%x(1) > 0.0_wp) then
                     call raise(fault, EXIT_ELEMENT, 'Element '//whole(e)//' reaches to r = '//short(point%x(1))// &
                                ' m; an axisymmetric mesh needs r >= 0 everywhere.')
                     return
                  end if
                  point%weight = point%weight*2*PI*point%x(1)
                  point%n_over_r = point%n/point%x(1)
               end if
               point%m = point%n
               point%dm = point%dn
               if (domain%n_p == 3) then
                  call linear(points(1, g), points(2, g), n3, d3)
                  point%m = [n3, 0.0_wp, 0.0_wp, 0.0_wp]
                  point%dm(1:3, :) = transpose(matmul(inverse, d3))
                  point%dm(4:6, :) = 0.0_wp
               end if
               if (domain%center(e) > 0) then
                  point%m = [1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
                  point%dm = 0.0_wp
               end if
            end associate
         end do
      end do
      allocate (domain%before_state(size(domain%mesh%t6, 2) + 1), source=0)
      do e = 1, size(domain%mesh%t6, 2)
         domain%before_state(e + 1) = domain%before_state(e) &
            + domain%rule*domain%regions(domain%region_of(e))%law%n_state
      end do
   end subroutine prepare_domain

   !> Makes the integration points of an edge, which has the body on its left. docs/theory/host.md section 3.1.
   pure function points_of_edge(domain, edge) result(points)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: edge(3)   !< Nodes: start, end, middle.
      type(edge_point_t) :: points(PER_EDGE)
      real(wp) :: s(PER_EDGE), weights(PER_EDGE), dn(3)
      integer :: g

      call edge_rule(s, weights)
      do g = 1, PER_EDGE
         associate (p => points(g))
            call edge_quadratic(s(g), p%n, dn)
            p%m = p%n
            if (domain%n_p == 3) p%m = [0.5_wp*(1 - s(g)), 0.5_wp*(1 + s(g)), 0.0_wp]
            p%x = matmul(domain%mesh%x(:, edge), p%n)
            p%tangent = matmul(domain%mesh%x(:, edge), dn)
            p%ring = weights(g)
            if (domain%axisymmetric) p%ring = p%ring*2*PI*p%x(1)
            p%area = p%ring*norm2(p%tangent)
         end associate
      end do
   end function points_of_edge

   !> Finds the nodes that carry the pressures of every element. The centers of undrained elements must be nodes
   !> already.
   subroutine place_pressures(domain)
      type(domain_t), intent(inout) :: domain
      integer :: e

      domain%carriers = domain%mesh%t6
      allocate (domain%n_carriers(size(domain%mesh%t6, 2)), source=domain%n_p)
      do e = 1, size(domain%mesh%t6, 2)
         associate (region => domain%regions(domain%region_of(e)))
            if (region%with_w .and. region%drainage == COUPLED) cycle
         end associate
         domain%n_carriers(e) = merge(1, 0, domain%center(e) > 0)
         domain%carriers(1, e) = max(1, domain%center(e))
      end do
   end subroutine place_pressures

   !> Finds p_w and p_c at a quadrature point [kPa]. docs/theory/host.md section 3.5.
   pure function pressures_at(domain, element, point, carried) result(p)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element, point   !< Numbers; the point within its element.
      real(wp), intent(in) :: carried(:, :)   !< (2, n_carriers) p_w, p_c of its carriers.
      real(wp) :: p(2)
      integer :: f

      associate (n_p => domain%n_carriers(element), gp => domain%gauss(point, element))
         do f = 1, 2
            p(f) = dot_product(gp%m(:n_p), carried(f, :n_p))
         end do
      end associate
      if (domain%regions(domain%region_of(element))%drainage /= COUPLED) &
         p = p + given_pressures_at(domain, element, point)
   end function pressures_at

   !> Finds the part of p_w and p_c at a point that is given: all of it where drained, in undrained elements what
   !> differs from their mean, else nothing [kPa]. docs/theory/host.md section 3.5.
   pure function given_pressures_at(domain, element, point) result(p)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element, point   !< Numbers; the point within its element.
      real(wp) :: p(2)

      p = 0.0_wp
      associate (drainage => domain%regions(domain%region_of(element))%drainage)
         if (drainage /= DRAINED .and. drainage /= UNDRAINED) return
         p = matmul(domain%given(:, domain%mesh%t6(:, element), drainage), domain%gauss(point, element)%n)
         if (drainage == UNDRAINED) p = p - domain%given(:, domain%center(element), drainage)
      end associate
   end function given_pressures_at

   !> Makes a state of the right size, where everything is zero and saturated. Void ratios are those of the regions.
   function new_state_of(domain) result(state)
      type(domain_t), intent(in) :: domain
      type(model_state_t) :: state
      integer :: nodes, points, e

      nodes = size(domain%mesh%x, 2)
      points = domain%rule*size(domain%mesh%t6, 2)
      state%gravity = domain%gravity
      allocate (state%x(FIELDS, nodes), state%v(FIELDS, nodes), state%a(2, nodes), source=0.0_wp)
      allocate (state%stress(6, points), state%e(points), state%s_rate(points), source=0.0_wp)
      allocate (state%state(domain%before_state(size(domain%before_state))), source=0.0_wp)
      allocate (state%s(points), source=1.0_wp)
      do e = 1, size(domain%mesh%t6, 2)
         state%e((e - 1)*domain%rule + 1:e*domain%rule) = domain%regions(domain%region_of(e))%void_ratio
      end do
   end function new_state_of

   !> Finds the density of soil with its fluids at a porosity and a degree of saturation [Mg/m3]. docs/theory/host.md
   !> section 2.1; the density of the air is that of the fluids, whatever its pressure.
   pure real(wp) function mixture_density(domain, region, n, s)
      type(domain_t), intent(in) :: domain
      type(region_t), intent(in) :: region
      real(wp), intent(in) :: n, s   !< Porosity, degree of saturation [-].

      mixture_density = (1 - n)*region%rho_s
      if (.not. region%with_w) return
      mixture_density = mixture_density + n*s*domain%fluids%rho_w
      if (region%with_c) mixture_density = mixture_density + n*(1 - s)*domain%fluids%rho_a
   end function mixture_density

   !> Finds the strain of displacements of nodes, or its rate from velocities: rr, zz, tt and engineering shear rz.
   pure function strain_of(gp, u) result(strain)
      type(gauss_t), intent(in) :: gp
      real(wp), intent(in) :: u(2, 6)   !< [m] or [m/s]
      real(wp) :: strain(4)

      strain = [dot_product(gp%dn(:, 1), u(1, :)), dot_product(gp%dn(:, 2), u(2, :)), &
                dot_product(gp%n_over_r, u(1, :)), &
                dot_product(gp%dn(:, 2), u(1, :)) + dot_product(gp%dn(:, 1), u(2, :))]
   end function strain_of

   !> Means of a point over the step between two states.
   pure function means_over(old, new, point) result(mean)
      type(model_state_t), intent(in) :: old, new
      integer, intent(in) :: point   !< Number of the point.
      type(means_t) :: mean

      mean%stress = 0.5_wp*(old%stress(1:4, point) + new%stress(1:4, point))
      mean%n = 0.5_wp*(old%e(point)/(1 + old%e(point)) + new%e(point)/(1 + new%e(point)))
      mean%s = 0.5_wp*(old%s(point) + new%s(point))
   end function means_over

   !> Whether an element is part of the ground.
   pure logical function is_present(state, element)
      type(model_state_t), intent(in) :: state
      integer, intent(in) :: element

      is_present = .true.
      if (allocated(state%present)) is_present = state%present(element)
   end function is_present

   !> Finds the law of a region in the step that ends with a state: that of the step where laws change with time.
   function law_of(domain, state, region) result(law)
      type(domain_t), intent(in), target :: domain
      type(model_state_t), intent(in), target :: state
      integer, intent(in) :: region   !< Number of the region.
      class(material_t), pointer :: law

      law => domain%regions(region)%law
      if (allocated(state%laws)) law => state%laws(region)%law
   end function law_of

   !> Finds the gravity on an element, towards -z: that of new ground grows over its first stage [m/s2].
   pure real(wp) function gravity_on(state, element) result(gravity)
      type(model_state_t), intent(in) :: state
      integer, intent(in) :: element

      gravity = state%gravity
      if (.not. allocated(state%joins)) return
      if (state%joins(element)) gravity = state%growth*state%gravity
   end function gravity_on

   !> Copies the old state of the points of an element that is not part of the ground into the new state.
   subroutine keep_element_state(domain, element, old, new)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: element
      type(model_state_t), intent(in) :: old
      type(model_state_t), intent(inout) :: new
      integer :: first, last

      first = (element - 1)*domain%rule + 1
      last = element*domain%rule
      new%stress(:, first:last) = old%stress(:, first:last)
      new%e(first:last) = old%e(first:last)
      new%s(first:last) = old%s(first:last)
      new%s_rate(first:last) = 0.0_wp
      associate (from => domain%before_state(element) + 1, to => domain%before_state(element + 1))
         new%state(from:to) = old%state(from:to)
      end associate
   end subroutine keep_element_state

   !> Copies a state. Each keeps its own laws of a step, which are put aside meanwhile.
   subroutine copy_state(from, to)
      type(model_state_t), intent(inout) :: from   !< It stays as it is.
      type(model_state_t), intent(inout) :: to
      type(material_slot_t), allocatable :: laws(:), laws_of_from(:)

      call move_alloc(from%laws, laws_of_from)
      call move_alloc(to%laws, laws)
      to = from
      call move_alloc(laws, to%laws)
      call move_alloc(laws_of_from, from%laws)
   end subroutine copy_state

   !> Exchanges a state with an archive. Gravity, parts of the ground and laws follow from the scene and the time.
   subroutine exchange_state(domain, state, archive)
      type(domain_t), intent(in) :: domain
      type(model_state_t), intent(inout) :: state
      class(archive_t), intent(inout) :: archive
      real(wp), allocatable :: table(:, :)
      integer :: variables(size(domain%regions)), i, rows

      call archive%exchange('time', state%time, 's', 'time')
      call archive%exchange('x', state%x, 'm, kPa', 'unknowns u_r, u_z, p_w, p_c of every node')
      call archive%exchange('v', state%v, 'm/s, kPa/s', 'their rates')
      call archive%exchange('a', state%a, 'm/s2', 'accelerations')
      call archive%exchange('stress', state%stress, 'kPa', &
                            'effective stress of every quadrature point, tension positive')
      ! State variables of a point where all have as many, else 1.
      variables = [(domain%regions(i)%law%n_state, i=1, size(variables))]
      rows = variables(domain%region_of(1))
      if (any(variables(domain%region_of) /= rows)) rows = 1
      table = reshape(state%state, [rows, size(state%state)/max(1, rows)])
      call archive%exchange('state', table, 'of the material', &
                            'state variables of every quadrature point; one list where laws differ')
      state%state = reshape(table, [size(table)])
      call archive%exchange('e', state%e, '-', 'void ratio')
      call archive%exchange('s', state%s, '-', 'degree of saturation')
      call archive%exchange('s_rate', state%s_rate, '1/s', 'its rate')
      call archive%exchange('outflow', state%outflow, 'm3/s', 'flows out of the ground: of both fluids, of air')
   end subroutine exchange_state
end module porous_domain
