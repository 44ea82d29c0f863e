! SPDX-License-Identifier: MIT
!> Surfaces for the tests of the contact kernels, and what every such test asks of an answer.
module contact_scenes
   use, intrinsic :: iso_fortran_env, only: int64
   use contact_geometry, only: contact_geometry_t, contact_prepare
   use contact_friction, only: friction_state_t
   use contact_penalty, only: contact_workspace_t, contact_result_t, new_workspace, new_result, contact_evaluate
   use contact_types, only: TWO_PI, NODAL_GAP, POINTWISE_GAP, COMBINED_GAP, contact_options_t, contact_status_t
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: random_t, uniform, surface_t, straight, curve, rough, flat_pair, contact_form, crossing_chains
   public :: scene_t, new_scene, positions, evaluate, evaluate_at, dense_tangent, balance, differences, edge_loads

   !> Penalty [kN/m3] of a contact_form: deep penetration, all terms count.
   real(wp), parameter, public :: SOFT_PENALTY = 1.0e3_wp
   !> Each gap, in plane strain and axisymmetric.
   integer, parameter, public :: FORMS = 6

   !> A generator of its own, the same on every machine (Park & Miller's minimal standard).
   type :: random_t
      integer(int64) :: seed = 20211_int64
   end type random_t

   !> A chain of quadratic edges.
   type :: surface_t
      real(wp), allocatable :: x(:, :)
      integer, allocatable :: edges(:, :)
   end type surface_t

   !> A contact with room for its evaluations.
   type :: kernel_t
      type(contact_geometry_t) :: geometry
      type(contact_workspace_t) :: work
      type(contact_result_t) :: result
      type(friction_state_t), allocatable :: friction     !< Where it has friction.
      real(wp), allocatable :: slave_0(:, :), master_0(:, :)   !< Coordinates at the start of its step.
   end type kernel_t

   !> Two surfaces with a contact between them.
   type :: scene_t
      type(surface_t) :: slave, master
      type(kernel_t) :: contact
      type(contact_status_t) :: status
   end type scene_t
contains
   !> Uniform between lower and upper.
   real(wp) function uniform(random, lower, upper)
      type(random_t), intent(inout) :: random
      real(wp), intent(in) :: lower, upper

      random%seed = mod(48271_int64*random%seed, 2147483647_int64)
      uniform = lower + (upper - lower)*real(random%seed, wp)/2147483647.0_wp
   end function uniform

   !> Chain through the given vertices, straight, middle nodes in the middle.
   pure function straight(vertices) result(surface)
      real(wp), intent(in) :: vertices(:, :)
      type(surface_t) :: surface
      integer :: i, n

      n = size(vertices, 2)
      allocate (surface%x(2, 2*n - 1), surface%edges(3, n - 1))
      surface%x(:, 1::2) = vertices
      do i = 1, n - 1
         surface%x(:, 2*i) = 0.5_wp*(vertices(:, i) + vertices(:, i + 1))
         surface%edges(:, i) = [2*i - 1, 2*i + 1, 2*i]
      end do
   end function straight

   !> Chain through all the given points: vertex, middle, vertex, ...
   pure function curve(points) result(surface)
      real(wp), intent(in) :: points(:, :)
      type(surface_t) :: surface
      integer :: i

      allocate (surface%x, source=points)
      allocate (surface%edges(3, size(points, 2)/2))
      do i = 1, size(surface%edges, 2)
         surface%edges(:, i) = [2*i - 1, 2*i + 1, 2*i]
      end do
   end function curve

   function new_scene(slave, master, options) result(scene)
      type(surface_t), intent(in) :: slave, master
      type(contact_options_t), intent(in) :: options
      type(scene_t) :: scene

      scene%slave = slave
      scene%master = master
      call contact_prepare(scene%contact%geometry, size(slave%x, 2), slave%edges, size(master%x, 2), master%edges, &
                           options, scene%status)
      scene%contact%work = new_workspace(scene%contact%geometry)
      scene%contact%result = new_result(scene%contact%geometry)
   end function new_scene

   !> All coordinates as one list, in the order of the contact's unknowns.
   pure function positions(scene) result(x)
      type(scene_t), intent(in) :: scene
      real(wp) :: x(2*(size(scene%slave%x, 2) + size(scene%master%x, 2)))

      x = [scene%slave%x, scene%master%x]
   end function positions

   subroutine evaluate_at(contact, slave_x, master_x, with_tangent, status)
      type(kernel_t), intent(inout) :: contact
      real(wp), intent(in) :: slave_x(:, :), master_x(:, :)
      logical, intent(in) :: with_tangent
      type(contact_status_t), intent(out) :: status

      if (allocated(contact%friction)) then
         contact%friction%slave_dx = slave_x - contact%slave_0
         contact%friction%master_dx = master_x - contact%master_0
      end if
      ! An argument that is not allocated is absent.
      call contact_evaluate(contact%geometry, slave_x, master_x, with_tangent, contact%work, contact%result, status, &
                            contact%friction)
   end subroutine evaluate_at

   !> Evaluates at the scene's own coordinates, or at those given.
   subroutine evaluate(scene, x, with_tangent)
      type(scene_t), intent(inout) :: scene
      real(wp), intent(in), optional :: x(:)
      logical, intent(in), optional :: with_tangent
      logical :: tangent_too
      integer :: n

      tangent_too = .true.
      if (present(with_tangent)) tangent_too = with_tangent
      n = size(scene%slave%x)
      if (present(x)) then
         call evaluate_at(scene%contact, reshape(x(:n), shape(scene%slave%x)), &
                          reshape(x(n + 1:), shape(scene%master%x)), tangent_too, scene%status)
      else
         call evaluate_at(scene%contact, scene%slave%x, scene%master%x, tangent_too, scene%status)
      end if
   end subroutine evaluate

   pure function dense_tangent(scene) result(k)
      type(scene_t), intent(in) :: scene
      real(wp) :: k(size(scene%contact%result%force), size(scene%contact%result%force))
      integer :: i

      k = 0.0_wp
      do i = 1, scene%contact%result%triplets
         associate (a => scene%contact%result%row(i), b => scene%contact%result%column(i))
            k(a, b) = k(a, b) + scene%contact%result%value(i)
         end associate
      end do
   end function dense_tangent

   !> Sums of the forces in both directions and of their moments about the origin.
   pure function balance(force, x) result(sums)
      real(wp), intent(in) :: force(:), x(:)
      real(wp) :: sums(3)

      sums(1) = sum(force(1::2))
      sums(2) = sum(force(2::2))
      sums(3) = sum(x(1::2)*force(2::2) - x(2::2)*force(1::2))
   end function balance

   !> A slave on z = 0 through slave_r, laid from the largest radius inwards, and a master on z = gap through master_r.
   pure subroutine flat_pair(slave_r, master_r, gap, slave, master)
      real(wp), intent(in) :: slave_r(:), master_r(:), gap   !< Both radii ascending.
      type(surface_t), intent(out) :: slave, master
      real(wp) :: s(2, size(slave_r)), m(2, size(master_r))

      s(1, :) = slave_r(size(slave_r):1:-1)
      s(2, :) = 0.0_wp
      m(1, :) = master_r
      m(2, :) = gap
      slave = straight(s)
      master = straight(m)
   end subroutine flat_pair

   !> Differences of force and energy by every coordinate: central (side 0), or forward or backward of second order.
   subroutine differences(scene, x, step, side, d_force, d_energy)
      type(scene_t), intent(inout) :: scene
      real(wp), intent(in) :: x(:), step
      integer, intent(in) :: side
      real(wp), intent(out) :: d_force(:, :), d_energy(:)
      real(wp) :: moved(size(x)), force(size(x), 3), energy(3), at(3), by(3)
      integer :: i, k

      at = [-1.0_wp, 0.0_wp, 1.0_wp]
      by = [-0.5_wp, 0.0_wp, 0.5_wp]
      if (side /= 0) then
         at = side*[0.0_wp, 1.0_wp, 2.0_wp]
         by = side*[-1.5_wp, 2.0_wp, -0.5_wp]
      end if
      do i = 1, size(x)
         do k = 1, 3
            moved = x
            moved(i) = x(i) + at(k)*step
            call evaluate(scene, moved, .false.)
            force(:, k) = scene%contact%result%force
            energy(k) = scene%contact%result%energy
         end do
         d_force(:, i) = matmul(force, by)/step
         d_energy(i) = dot_product(energy, by)/step
      end do
   end subroutine differences

   !> int N_i 2 pi r dr (or int N_i dr) over the part from a to b of a flat chain, as vertical forces of a unit
   !> pressure, by Simpson's rule of the exact degree on pieces: N_i r is a cubic.
   pure function edge_loads(surface, a, b, axisymmetric) result(load)
      type(surface_t), intent(in) :: surface
      real(wp), intent(in) :: a, b
      logical, intent(in) :: axisymmetric
      real(wp) :: load(size(surface%x, 2)), ends(2), r(3), share(3), s, ring
      integer :: e, k

      load = 0.0_wp
      do e = 1, size(surface%edges, 2)
         associate (nodes => surface%edges(:, e))
            associate (first => surface%x(1, nodes(1)), last => surface%x(1, nodes(2)))
               ends = [max(min(first, last), a), min(max(first, last), b)]
               if (ends(2) <= ends(1)) cycle
               r = [ends(1), 0.5_wp*sum(ends), ends(2)]
               share = (ends(2) - ends(1))*[1.0_wp, 4.0_wp, 1.0_wp]/6.0_wp
               do k = 1, 3
                  s = (2.0_wp*r(k) - first - last)/(last - first)
                  ring = merge(TWO_PI*r(k), 1.0_wp, axisymmetric)
                  load(nodes) = load(nodes) &
                                + share(k)*ring*[-0.5_wp*s*(1.0_wp - s), 0.5_wp*s*(1.0_wp + s), 1.0_wp - s*s]
               end do
            end associate
         end associate
      end do
   end function edge_loads

   !> Moves every coordinate by at most `most`; a radius is never made negative.
   subroutine rough(surface, random, most)
      type(surface_t), intent(inout) :: surface
      type(random_t), intent(inout) :: random
      real(wp), intent(in) :: most
      integer :: i, c

      do i = 1, size(surface%x, 2)
         do c = 1, 2
            surface%x(c, i) = surface%x(c, i) + uniform(random, -most, most)
         end do
         surface%x(1, i) = max(surface%x(1, i), 0.0_wp)
      end do
   end subroutine rough

   !> The six forms of a contact.
   pure function contact_form(form) result(options)
      integer, intent(in) :: form   !< 1 to FORMS; those of the second half are axisymmetric.
      type(contact_options_t) :: options
      integer, parameter :: GAPS(3) = [NODAL_GAP, POINTWISE_GAP, COMBINED_GAP]

      options%penalty = SOFT_PENALTY
      options%gap = GAPS(mod(form - 1, 3) + 1)
      options%axisymmetric = form > FORMS/2
   end function contact_form

   !> Curved chains of three edges that cross each other; the master's ends lie inside slave edges.
   subroutine crossing_chains(random, options, scene)
      type(random_t), intent(inout) :: random
      type(contact_options_t), intent(in) :: options
      type(scene_t), intent(out) :: scene
      type(surface_t) :: slave, master
      real(wp) :: offset

      offset = uniform(random, 0.15_wp, 0.35_wp)
      call flat_pair([0.1_wp, 0.4_wp, 0.7_wp, 1.0_wp], &
                     offset + [0.0_wp, 0.15_wp, 0.35_wp, 0.6_wp], -0.03_wp, slave, master)
      call rough(slave, random, 0.03_wp)
      call rough(master, random, 0.02_wp)
      scene = new_scene(slave, master, options)
   end subroutine crossing_chains
end module contact_scenes
