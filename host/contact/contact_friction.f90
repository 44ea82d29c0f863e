! SPDX-License-Identifier: MIT
!> Coulomb friction of a pair of edges: the slip of the slave nodes since the start of a step, with derivatives, and the
!> law of a node: stick on a penalty, slip at the limit.
!> docs/theory/contact.md section 9.
module contact_friction
   use contact_mortar, only: mortar_point_t, hat_sums_t, add_under_hats, add_unit_forces, forces_on_nodes
   use contact_types, only: contact_options_t
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: friction_state_t, traction_t, pair_slips, traction_at
   public :: tangential_stiffness, touching_share

   real(wp), parameter :: TANGENTIAL_SHARE = 0.1_wp   !< Share of the penalty, where nothing else is given [-].

   !> State of friction from which a step starts.
   type :: friction_state_t
      real(wp), allocatable :: slave_dx(:, :), master_dx(:, :)   !< (2, nodes) Way since the start of the step [m].
      real(wp), allocatable :: traction(:)   !< (slave nodes) At the start, along the slave's tangent [kPa].
      real(wp), allocatable :: gap(:)        !< (slave nodes) At the start, open > 0 [m].
      integer, allocatable :: side(:)        !< (slave nodes) Way of sliding at the iterate before: -1, 1; 0: none.
   end type friction_state_t

   !> Traction of a node and its slopes.
   type :: traction_t
      real(wp) :: value = 0.0_wp     !< [kPa]
      real(wp) :: by_slip = 0.0_wp   !< d value/d slip [kN/m3]
      real(wp) :: by_gap = 0.0_wp    !< d value/d gap [kN/m3]
      integer :: side = 0            !< Way of sliding: -1, 1; 0: it sticks.
      logical :: turns = .false.     !< Held from turning at once from one way to the other.
   end type traction_t
contains
   !> eps_T, by default a tenth of the penalty of the pressure [kN/m3]. docs/theory/contact.md section 9.
   pure real(wp) function tangential_stiffness(options) result(stiffness)
      type(contact_options_t), intent(in) :: options

      stiffness = options%tangential_penalty
      if (.not. stiffness > 0.0_wp) stiffness = TANGENTIAL_SHARE*options%penalty
   end function tangential_stiffness

   !> Finds the share of a step that a node touches: all of it, or from where a gap closes that was open. [-]
   pure real(wp) function touching_share(gap_before, gap) result(share)
      real(wp), intent(in) :: gap_before, gap   !< Mean gaps, open > 0; the second is closed [m].

      share = 1.0_wp
      if (gap_before > 0.0_wp) share = -gap/(gap_before - gap)
   end function touching_share

   !> Maps the traction of a node back: t = t_n + e_T slip, at most mu p + c in magnitude. A node that was open at the
   !> start of the step slips from where it touches. docs/theory/contact.md section 9. A node that slid one way at the
   !> iterate before sticks before it slides the other way.
   pure function traction_at(options, before, gap_before, gap, slip, side) result(t)
      type(contact_options_t), intent(in) :: options
      real(wp), intent(in) :: before            !< Traction at the start of the step [kPa].
      real(wp), intent(in) :: gap_before, gap   !< Mean gaps, open > 0 [m].
      real(wp), intent(in) :: slip              !< Since the start of the step [m].
      integer, intent(in) :: side               !< Way of sliding at the iterate before: -1, 1; 0: none.
      type(traction_t) :: t
      real(wp) :: limit, share, share_slope, stiffness

      if (gap >= 0.0_wp) return
      share = touching_share(gap_before, gap)
      share_slope = 0.0_wp
      if (gap_before > 0.0_wp) share_slope = -gap_before/(gap_before - gap)**2
      stiffness = tangential_stiffness(options)
      limit = options%cohesion - options%friction*options%penalty*gap
      t%value = stiffness*share*slip
      if (.not. gap_before > 0.0_wp) t%value = t%value + before
      t%by_slip = stiffness*share
      t%by_gap = stiffness*share_slope*slip
      if (.not. abs(t%value) > limit) return
      t%turns = side*t%value < 0.0_wp
      if (t%turns) return
      t%side = nint(sign(1.0_wp, t%value))
      t%by_slip = 0.0_wp
      t%by_gap = -sign(options%friction*options%penalty, t%value)
      t%value = sign(limit, t%value)
   end function traction_at

   !> Sums weights times slips of a pair at the three slave nodes, and drag(:, A) = int M_A (t N_s, -t N_m) 2 pi r ds,
   !> the nodal forces of a unit traction at node A; weight times slip is drag times the way of the nodes.
   !> docs/theory/contact.md section 9.
   pure subroutine pair_slips(points, dx, slip, drag)
      type(mortar_point_t), intent(in) :: points(:)
      real(wp), intent(in) :: dx(2, 6)   !< Way of the nodes since the start of the step [m].
      type(hat_sums_t), intent(out) :: slip
      real(wp), intent(out) :: drag(12, 3)
      real(wp) :: of_point(12), d_way(12), way(2), bend(2, 2)
      integer :: k

      drag = 0.0_wp
      do k = 1, size(points)
         associate (p => points(k))
            way = matmul(dx(:, 1:3), p%ns) - matmul(dx(:, 4:6), p%nm)
            bend(:, 1) = matmul(dx(:, 1:3), p%dns)
            bend(:, 2) = -matmul(dx(:, 4:6), p%dnm)
            d_way = matmul(way, p%d_t) + dot_product(p%t, bend(:, 1))*p%d_s + dot_product(p%t, bend(:, 2))*p%d_m
            of_point = forces_on_nodes(p, p%t)
            call add_under_hats(p, dot_product(p%t, way), of_point + d_way, slip)
            call add_unit_forces(p, of_point, drag)
         end associate
      end do
   end subroutine pair_slips
end module contact_friction
